//! What a page shows of a part beside its verdict: its response in the worst drop, its demand over the tilt, its safe
//! places, what would make it safe.

use clatter::End;
use clatter_shock::{State, Suspension};
use rayon::prelude::*;

use crate::design::{Bounds, Remedies};
use crate::drop::{Followed, Motion};
use crate::engine::Felt;
use crate::search::{Ranges, Task};
use crate::shock::Shock;
use crate::{
    Accuracy, Assessment, Component, Drop, Error, Law, Limit, LimitAssessment, LimitKind, ProductFile, Spread, Unit,
    Verdict,
};

/// Points (x, y) of a line.
pub type Curve = Vec<(f64, f64)>;

/// A part to be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Portrait {
    /// Time (s) and value (SI) of what the tightest limit is on, in its worst drop. A velocity change is a spike.
    pub history: Curve,
    /// When the ends strike in that drop, in s.
    pub impacts_s: Vec<f64>,
    /// Tilt (rad) and the most that the tightest limit is asked there, a curve for each end that may touch first.
    pub over_tilt: Vec<(End, Curve)>,
    /// Where the middle of the part could be, and every limit hold in every drop, in m from the middle of the product.
    pub zone_m: Option<[f64; 2]>,
    /// The smallest changes that make it safe with a margin of 10 %, within [`Bounds::default`]; none for a part that is safe.
    pub remedies: Option<Remedies>,
}

/// Points of a history between two strikes and after the last, at least; in a period of the part, as far as there are
/// not too many.
const POINTS: f64 = 600.0;
const IN_A_PERIOD: f64 = 16.0;
const MOST_POINTS: f64 = 12_000.0;
/// Margin that changes are to leave.
const MARGIN: f64 = 0.1;
/// Steps of a curve over the tilt.
const EVEN_TILTS: u32 = 40;
/// Places along the product that are assessed for the zone.
const PLACES: u32 = 33;

impl ProductFile {
    /// Portraits of all components of an assessment of this file.
    ///
    /// The curves over the tilt take the largest over the ends of the ranges of restitution and contact time, at the
    /// highest speed, and over those of the worst case. Zones are
    /// interpolated between 33 places: the demand is convex along the bar (a largest absolute value of functions linear
    /// in the place), so that the zone shown lies within the true one.
    ///
    /// # Errors
    /// As [`ProductFile::assess`].
    pub fn portraits(&self, assessment: &Assessment) -> Result<Vec<Portrait>, Error> {
        let zones = self.zones(&assessment.accuracy)?;
        let mut remedies = vec![None; self.components.len()];
        for part in self.remedies(assessment, &Bounds::default(), MARGIN)? {
            // Parts that are safe with less stay as they are.
            if assessment.components[part.component].verdict != Verdict::Safe {
                let component = part.component;
                remedies[component] = Some(part);
            }
        }
        let shown = self.shown()?;
        let ranges = Ranges { drop: &shown, ..self.ranges(&assessment.accuracy) };
        let each = self.components.par_iter().zip(&assessment.components).zip(zones).zip(remedies);
        each.map(|(((component, assessed), zone_m), remedies)| {
            let tightest = assessed.tightest();
            let (history, impacts_s) = self.history(tightest, &ranges).unwrap_or_default();
            let over_tilt = Self::over_tilt(&ranges, component, tightest);
            Ok(Portrait { history, impacts_s, over_tilt, zone_m, remedies })
        })
        .collect()
    }

    fn history(&self, limit: &LimitAssessment, ranges: &Ranges<'_>) -> Result<(Curve, Vec<f64>), Error> {
        let Some(worst) = &limit.worst_case else { return Ok(Default::default()) };
        let (drop, part) = self.worst_drop(worst)?;
        let followed = Followed::new(&drop, ranges.model, ranges.tolerance)?;
        let felt = Felt::new(&followed, worst.position_m)?;
        let impacts: Vec<f64> = followed.flight().strikes.iter().map(|s| s.time_s).collect();
        let period = part.suspension.map_or(0.0, |s| std::f64::consts::TAU / s.omega());
        // to the peak and a little on; what comes long after it is far weaker
        let second = impacts.get(1).copied().unwrap_or(0.0);
        let clatter = drop.contact_time_s.map_or(second, |contact| 12.0 * contact);
        let late = worst.time_s.max(0.25 * clatter);
        let strikes = impacts.iter().copied().filter(|t| *t <= 4.0 * late).fold(late, f64::max);
        let end = (1.25 * strikes).max(worst.time_s + 2.5 * period).max(1e-9);
        let history = match (limit.limit, part.suspension) {
            (LimitKind::Acceleration | LimitKind::RattleSpace, Some(suspension)) => {
                let acceleration = limit.limit == LimitKind::Acceleration;
                let slices = felt.slices((end / POINTS).min(period / 64.0), end);
                respond(&suspension, &slices, end, |state| {
                    if acceleration { suspension.absolute_acceleration(state) } else { state.displacement }
                })
            }
            (LimitKind::AngularVelocityChange, _) => spikes(&followed.turns(), 1.0, end),
            (LimitKind::VelocityChange, _) => spikes(&felt.shocks(), 1.0, end),
            (LimitKind::DamageBoundary, _) if limit.unit == Unit::MeterPerSecond => spikes(&felt.shocks(), 1.0, end),
            _ if matches!(followed.motion, Motion::Impacts(..)) => {
                let factor = std::f64::consts::FRAC_PI_2 / drop.contact_time_s.ok_or(Error::Contact)?;
                spikes(&felt.shocks(), factor, end)
            }
            _ => within(felt.acceleration(), end),
        };
        Ok((history, impacts.into_iter().filter(|t| *t <= end).collect()))
    }

    /// The drops with one end first over the tilts that are shown; one stated tilt is shown among its neighbors.
    fn shown(&self) -> Result<Drop, Error> {
        let tilt = &self.drop.tilt_rad;
        if !tilt.is_value() {
            return Ok(self.drop);
        }
        let [lo, hi] = [0.2 * tilt.lo(), (2.0 * tilt.hi()).clamp(1f64.to_radians(), 30f64.to_radians())];
        Ok(Drop { tilt_rad: Spread::new(lo, hi, Law::Range)?, ..self.drop })
    }

    fn over_tilt(ranges: &Ranges<'_>, component: &Component, limit: &LimitAssessment) -> Vec<(End, Curve)> {
        let Some(asked) = Limit::of(component).into_iter().find(|l| l.kind == limit.limit) else { return Vec::new() };
        let Some(worst) = &limit.worst_case else { return Vec::new() };
        let task = Task { component, limit: asked };
        let [lo, hi] = [ranges.drop.tilt_rad.lo(), ranges.drop.tilt_rad.hi()];
        let mut tilts: Vec<f64> =
            (0..=EVEN_TILTS).map(|i| lo + f64::from(i) / f64::from(EVEN_TILTS) * (hi - lo)).collect();
        tilts.push(worst.tilt_deg.to_radians());
        tilts.sort_by(f64::total_cmp);
        let most = |first: End, tilt: f64| (tilt, limit.allowed * ranges.most_at_tilt(&task, worst, first, tilt));
        let curve = |first| tilts.par_iter().map(|&tilt| most(first, tilt)).collect();
        ranges.drop.first_ends().iter().map(|&first| (first, curve(first))).collect()
    }

    /// The safe places of every component, as far as it is within the product.
    fn zones(&self, accuracy: &Accuracy) -> Result<Vec<Option<[f64; 2]>>, Error> {
        let length = self.product.body.length_m();
        let place =
            |c: &Component, i: u32| (length - c.extent_m).max(0.0) * (f64::from(i) / f64::from(PLACES - 1) - 0.5);
        let moved = |c: &Component| {
            let c = c.clone();
            let at = move |i| Spread::value(place(&c, i)).map(|position_m| Component { position_m, ..c.clone() });
            (0..PLACES).map(at)
        };
        let components = self.components.iter().flat_map(moved).collect::<Result<Vec<_>, _>>()?;
        let all = Self { components, ..self.clone() };
        let assessed = all.assess_to(accuracy)?;
        let zone = |(component, places): (&Component, &[crate::ComponentAssessment])| {
            // An undecided place is none to recommend.
            let used = |c: &crate::ComponentAssessment| match c.verdict {
                Verdict::Undecided => (1.0 / (1.0 + c.tightest().room()) - 1.0).max(1e-3),
                _ => 1.0 / (1.0 + c.tightest().room()) - 1.0,
            };
            let margins: Vec<f64> = places.iter().map(used).collect();
            let safe = |m: &f64| *m <= 0.0;
            let (first, last) = (margins.iter().position(safe)?, margins.iter().rposition(safe)?);
            let at = |i: usize| place(component, u32::try_from(i).unwrap_or(PLACES));
            let cross = |inner: usize, outer: usize| {
                let (m, n) = (margins[inner], margins[outer]);
                at(inner) + (at(outer) - at(inner)) * (-m / (n - m))
            };
            let lo = if first == 0 { at(0) } else { cross(first, first - 1) };
            let hi = if last + 1 == margins.len() { at(last) } else { cross(last, last + 1) };
            Some([lo, hi])
        };
        Ok(self.components.iter().zip(assessed.components.chunks(PLACES as usize)).map(zone).collect())
    }
}

/// The motion of a part that is driven by small velocity shocks, sampled and right at every shock.
fn respond(suspension: &Suspension, slices: &[(f64, f64)], end: f64, value: impl Fn(State) -> f64) -> Vec<(f64, f64)> {
    let period = std::f64::consts::TAU / suspension.omega();
    let step = (end / POINTS).min(period / IN_A_PERIOD).max(end / MOST_POINTS);
    let (mut state, mut now) = (State::default(), 0.0);
    let mut points = vec![(0.0, value(state))];
    let mut coast = |points: &mut Vec<(f64, f64)>, state: &mut State, until: f64| {
        let mut t = step;
        while t < until - now {
            points.push((now + t, value(suspension.free(*state, t))));
            t += step;
        }
        *state = suspension.free(*state, until - now);
        now = until;
        points.push((now, value(*state)));
    };
    for &(time, delta_v) in slices.iter().take_while(|s| s.0 < end) {
        if time > points.last().map_or(0.0, |p| p.0) {
            coast(&mut points, &mut state, time);
        }
        state.velocity -= delta_v;
        points.push((time, value(state)));
    }
    coast(&mut points, &mut state, end);
    points
}

/// A history up to `end`, at rest from its last point on.
fn within(mut history: Vec<(f64, f64)>, end: f64) -> Vec<(f64, f64)> {
    history.retain(|p| p.0 <= end);
    history.push((end, 0.0));
    history
}

/// Shocks as spikes from zero.
fn spikes(shocks: &[Shock], factor: f64, end: f64) -> Vec<(f64, f64)> {
    let mut points = vec![(0.0, 0.0)];
    let spike = |shock: &Shock| [0.0, factor * shock.change, 0.0].map(|value| (shock.time_s, value));
    points.extend(shocks.iter().take_while(|shock| shock.time_s <= end).flat_map(spike));
    points.push((end, 0.0));
    points
}
