//! Drops over all tilts, each followed once for all parts: curves and safe places are taken from them.

use std::sync::OnceLock;

use clatter_shock::{DampingRatio, Suspension};

use crate::engine::PlaceHistory;
use crate::model::follow;
use crate::search::Ranges;
use crate::{Part, WorstCase};
use clatter_flight::{Drop, Followed, Place, Until};
use clatter_product::{Component, Input, Limit, Model, Mount, Row, searched};

/// Steps of the tilt over its range; they are twice as close at its low end as at its high end.
const STEPS: u32 = 40;

/// A tilt in rad, and whether places count with it: of the tilts of a range every second one, and of one stated tilt, whose
/// neighbors the curves show as well, itself.
pub(super) type Tilt = (f64, bool);

/// Drops, each followed when it is first requested.
pub(super) struct Drops {
    model: Model,
    tolerance: f64,
    until: Until,
    all: Vec<Kept>,
}

struct Kept {
    drop: Drop,
    /// The number of the drop in the file.
    listed: usize,
    /// True where the drop of a symmetric product stands for the one that is turned around as well.
    turns: bool,
    tilt: Tilt,
    followed: OnceLock<Option<Followed>>,
}

/// One drop of them, or the same turned around.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct View {
    index: usize,
    turned: bool,
}

impl Drops {
    /// Returns drops at these tilts with either end first, of each of these inputs, by the contact law of the ranges.
    pub(super) fn new(ranges: &Ranges<'_>, tilts: &[Tilt], inputs: &[Drop], until: Until) -> Self {
        let Ranges { model, tolerance, .. } = *ranges;
        let mut drops = Self { model, tolerance: tolerance.max(0.02), until, all: Vec::new() };
        drops.extend(0, ranges, tilts, inputs);
        drops
    }

    /// Returns the same of all drops of a file, at the ends of their ranges.
    pub(super) fn of_all<'r>(
        ranges: impl Iterator<Item = Ranges<'r>>,
        tilts: &[Vec<Tilt>],
        until: Until,
    ) -> Option<Self> {
        let mut each = ranges.zip(tilts).enumerate();
        let (_, (first, of_first)) = each.next()?;
        let mut drops = Self::new(&first, of_first, &corners(&first), until);
        each.for_each(|(listed, (ranges, tilts))| drops.extend(listed, &ranges, tilts, &corners(&ranges)));
        Some(drops)
    }

    fn extend(&mut self, listed: usize, ranges: &Ranges<'_>, tilts: &[Tilt], inputs: &[Drop]) {
        let turns = ranges.turns();
        for &first in ranges.firsts() {
            for &tilt in tilts {
                for inputs in inputs {
                    let drop = Drop { direction_rad: Drop::towards(first), tilt_rad: tilt.0, ..*inputs };
                    let drop = Drop { is_flat: drop.lands_as_one(ranges.merge_s), ..drop };
                    self.all.push(Kept { drop, listed, turns, tilt, followed: OnceLock::new() });
                }
            }
        }
    }

    /// Returns all views.
    pub(super) fn views(&self) -> Vec<View> {
        let of = |(index, kept): (usize, &Kept)| {
            let turned: &[bool] = if kept.turns { &[false, true] } else { &[false] };
            turned.iter().map(move |&turned| View { index, turned })
        };
        self.all.iter().enumerate().flat_map(of).collect()
    }

    /// Returns the views that places count with.
    pub(super) fn counted(&self) -> Vec<View> {
        self.views().into_iter().filter(|view| self.tilt(*view).1).collect()
    }

    pub(super) fn length_m(&self) -> f64 {
        self.all.first().map_or(0.0, |kept| kept.drop.sides_m()[0])
    }

    pub(super) fn tilt(&self, view: View) -> Tilt {
        self.all[view.index].tilt
    }

    /// Returns which drop of the file it is.
    pub(super) fn listed(&self, view: View) -> usize {
        self.all[view.index].listed
    }

    pub(super) fn drop(&self, view: View) -> Drop {
        let drop = self.all[view.index].drop;
        let first = if view.turned { drop.first().other() } else { drop.first() };
        Drop { direction_rad: Drop::towards(first), ..drop }
    }

    /// Returns the history at a place in a drop, for parts up to a natural frequency; none where the drop is not answered.
    fn felt(&self, view: View, position_m: f64, fastest_rad_s: f64) -> Option<PlaceHistory<'_>> {
        let kept = &self.all[view.index];
        let follow = || follow(&kept.drop, self.model, self.tolerance, self.until).ok();
        let followed = kept.followed.get_or_init(follow).as_ref()?;
        let position_m = if view.turned { -position_m } else { position_m };
        PlaceHistory::rough(followed, Place::flat([position_m, 0.0]), fastest_rad_s).ok()
    }
}

/// The histories at places in the drops, each made when it is first requested.
pub(super) struct Places<'d> {
    pub(super) drops: &'d Drops,
    pub(super) positions_m: Vec<f64>,
    fastest_rad_s: f64,
    cells: Vec<OnceLock<Option<PlaceHistory<'d>>>>,
}

impl<'d> Places<'d> {
    /// Returns the histories of these places, for parts up to a natural frequency.
    pub(super) fn new(drops: &'d Drops, positions_m: Vec<f64>, fastest_rad_s: f64) -> Self {
        let count = 2 * drops.all.len() * positions_m.len();
        let cells = std::iter::repeat_with(OnceLock::new).take(count).collect();
        Self { drops, positions_m, fastest_rad_s, cells }
    }

    /// Returns the demand of one drop for a limit at place number `at`, as a share of the allowed value, where that passes `above`: the
    /// most of these parts, and which of them.
    pub(super) fn share(
        &self,
        view: View,
        at: usize,
        limit: &Limit,
        parts: &[Option<Suspension>],
        above: f64,
    ) -> Option<(f64, Part)> {
        let cell = (2 * view.index + usize::from(view.turned)) * self.positions_m.len() + at;
        let position_m = self.positions_m[at];
        let felt = self.cells[cell].get_or_init(|| self.drops.felt(view, position_m, self.fastest_rad_s)).as_ref()?;
        let mut most: Option<(f64, Part)> = None;
        for &suspension in parts {
            let above = most.map_or(above, |most| most.0);
            let answer = felt.answer(limit, suspension.as_ref(), above).ok().flatten();
            most = answer.map(|answer| (answer.utilization(), Part::new(position_m, suspension))).or(most);
        }
        most
    }

    /// Returns the largest demand of these drops at some of the places.
    pub(super) fn most(&self, views: &[View], at: &[usize], limit: &Limit, parts: &[Option<Suspension>]) -> f64 {
        let mut most = 0.0;
        for &view in views {
            for &at in at {
                most = self.share(view, at, limit, parts, most).map_or(most, |found| found.0);
            }
        }
        most
    }

    /// Returns whether the demand of one of these drops is more than a share at some of the places. That drop comes to the front: it is
    /// likely to do so again.
    pub(super) fn exceeds(
        &self,
        views: &mut [View],
        at: &[usize],
        limit: &Limit,
        parts: &[Option<Suspension>],
        share: f64,
    ) -> bool {
        let one = |view: &View| at.iter().any(|&at| self.share(*view, at, limit, parts, share).is_some());
        let found = views.iter().position(one);
        if let Some(found) = found {
            views[..=found].rotate_right(1);
        }
        found.is_some()
    }
}

/// Tilts over the range that is shown, which is around one stated tilt; where both ends begin to land as one, on both sides.
pub(super) fn tilts(ranges: &Ranges<'_>) -> Vec<Tilt> {
    let stated = &ranges.drop.tilt_rad;
    let [lo, hi] = if stated.is_value() {
        [0.2 * stated.lo(), (2.0 * stated.hi()).clamp(1f64.to_radians(), 30f64.to_radians())]
    } else {
        [stated.lo(), stated.hi()]
    };
    let at = |k: u32| {
        let share = f64::from(k) / f64::from(STEPS);
        lo + (hi - lo) * share * (2.0 + share) / 3.0
    };
    let mut tilts: Vec<f64> = (0..=STEPS).map(at).collect();
    tilts.push(stated.lo());
    if ranges.product.contact_time_s.is_none() {
        let [_, fast] = ranges.drop.speeds_m_s();
        let edge = libm::asin((ranges.merge_s * fast / ranges.product.body.length_m()).min(1.0));
        let sides = [-1.0, 1.0].map(|side| edge * (1.0 + side * 1e-9));
        tilts.extend(sides.into_iter().filter(|tilt| (lo..=hi).contains(tilt)));
    }
    tilts.sort_by(f64::total_cmp);
    tilts.dedup_by(|a, b| a.to_bits() == b.to_bits());
    let counts =
        |i: usize, tilt: f64| (stated.lo()..=stated.hi()).contains(&tilt) && (stated.is_value() || i.is_multiple_of(2));
    tilts.into_iter().enumerate().map(|(i, tilt)| (tilt, counts(i, tilt))).collect()
}

/// Returns the places of a part along a bar.
pub(super) fn along(component: &Component) -> Vec<f64> {
    component.places_m().into_iter().map(|[x, _]| x).collect()
}

/// Returns a drop of the ranges with these inputs, lying, of the product's own body.
pub(super) fn with(ranges: &Ranges<'_>, inputs: impl IntoIterator<Item = (&'static Row, f64)>) -> Drop {
    let mut drop = Drop { contact_law: ranges.law, ..ranges.product.unset(ranges.drop, None) };
    for (row, value) in inputs {
        if let Some(set) = row.set {
            set(&mut drop, value);
        }
    }
    drop
}

/// Inputs that curves hold, besides the tilt.
pub(super) fn held() -> impl Iterator<Item = &'static Row> {
    searched().map(|(row, _)| row).filter(|row| !matches!(row.input, Input::Tilt | Input::Gyration))
}

/// Returns the highest speed with the ends of the ranges of all that lines of drops go through.
pub(super) fn corners(ranges: &Ranges<'_>) -> Vec<Drop> {
    let [_, fast] = ranges.drop.speeds_m_s();
    let mut all = vec![vec![(Input::Speed.row(), fast)]];
    for row in held().filter(|row| row.input != Input::Speed) {
        let Some([lo, hi]) = row.input.range(ranges.product, ranges.drop) else { continue };
        let ends = if lo < hi { vec![hi, lo] } else { vec![lo] };
        let with = |one: &Vec<(&'static Row, f64)>| {
            let one = one.clone();
            ends.clone().into_iter().map(move |end| one.iter().copied().chain([(row, end)]).collect())
        };
        all = all.iter().flat_map(with).collect();
    }
    all.into_iter().map(|inputs| with(ranges, inputs)).collect()
}

/// Returns the parts for which a limit is answered: of a response those at the ends of the range of natural frequencies with the least
/// damping, and that of the worst case.
pub(super) fn parts(component: &Component, limit: &Limit, worst: Option<&WorstCase>) -> Vec<Option<Suspension>> {
    let Mount::Suspended { frequency_hz, damping } = component.mount else { return vec![None] };
    if !limit.is_response() {
        return vec![None];
    }
    let [least, _] = damping.ratios();
    let mut all = vec![(frequency_hz.lo(), least), (frequency_hz.hi(), least)];
    all.extend(worst.and_then(|worst| worst.frequency_hz().zip(worst.damping_ratio())));
    all.dedup();
    let stop = component.stops.as_ref().and_then(|stops| stops.hardest().ok());
    let part = |&(hz, ratio): &(f64, f64)| {
        let free = Suspension::from_hz(hz, DampingRatio::new(ratio).ok()?).ok()?;
        Some(stop.map_or(free, |stop| free.with_stop(stop)))
    };
    let own = worst.map(|worst| worst.part.suspension).filter(|_| stop.is_some());
    all.iter().filter_map(part).map(Some).chain(own).collect()
}
