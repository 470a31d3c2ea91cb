//! What every rung gets wrong in a scene, estimated before anything is simulated.

use clatter::flight::Scene;

use super::ends::Ends;
use super::floats::{greater, lesser};
use super::lag::{Lag, Part};
use super::quick::ln;
use super::swing::Swing;
use super::trail::{Course, Strikes, Trail};
use super::walk::Walker;
use super::walked::{Lates, Stop, Top, Walk};
use super::{BarRung, ComponentRung, Estimate, Pair, Plan, Quantity, Setup};

/// Strikes followed at most.
pub const STRIKES: usize = 8;
/// Strikes followed at most by the first look of a plan.
pub const FIRST_STRIKES: usize = 2;

/// Safety factor on an estimate where a drop is passed over because of it.
pub const DOUBT: f64 = 2.0;

/// The dimensionless groups of a scene (v0 and h0 at the first touch).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Groups {
    /// G = g h0/v0²: what gravity adds to the speed before the second strike.
    pub gravity: f64,
    /// φ²: what the tilt takes from the lever arms.
    pub geometry: f64,
    /// τ/Δt: contact time over the shortest time between the strikes followed; 0 where it is not known.
    pub overlap: f64,
    /// ωτ: how far the component turns in one contact; 0 where it is not known.
    pub pulse: f64,
    /// ω t_N: how far it turns from the first strike followed to the last.
    pub train: f64,
    /// ζωΔt: by how much it dies down in the shortest time between strikes.
    pub damping: f64,
}

/// Estimates for every rung of both ladders, in one quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forecast {
    pub(super) quantity: Quantity,
    /// Errors of the bar rungs, as a share of the peak; the compliant one has none where it takes the scene.
    bar: [f64; 5],
    /// By how much the strikes that were not followed may pass the peak, with the error of finite tilt.
    pub(super) doubt: f64,
    /// Bound on what comes after the strikes that were followed, as a share of the peak.
    later: f64,
    /// What is wrong with one net change, one largest shock, impulses, and with pulses where there are none.
    component: [f64; 4],
    /// Whether contacts overlap among the strikes followed.
    pub(super) overlaps: bool,
    pub(super) contact_known: bool,
    /// Why the strikes followed end where they do.
    pub(super) stop: Stop,
    /// Shortest time between the strikes followed.
    pub(super) shortest_gap_s: f64,
    /// What impulses get wrong by the phase ωτ of a contact, as a share of the peak: the coefficients of the linear and
    /// the quadratic term.
    pub(super) impulse_phase: [f64; 2],
    pub(super) omega: f64,
    /// Strikes followed, and restitution.
    pub(super) strikes: usize,
    e: f64,
    /// The groups.
    pub groups: Groups,
    /// No strike after this time since the first touch raises the quantity: models need not be followed further.
    /// Infinite where that is not known.
    pub until_s: f64,
    /// What the peak is, about.
    pub peak: f64,
}

/// Whether [`Scene::simulate_compliant`] takes it: its own conditions, without the fit.
fn takes(scene: &Scene, time: f64) -> bool {
    let (body, v0) = (scene.body(), scene.speed_m_s());
    let length = body.length_m();
    let fastest = body.arms_m().iter().fold(v0, |m, arm| m.max(v0 + arm * scene.spin_rad_s().abs()));
    scene.e() >= 0.01
        && body.thickness_m() == 0.0
        && body.gyration_m() >= 0.05 * length
        && time * fastest <= 0.1 * length
        && time * time * scene.gravity_m_s2() <= 0.01 * length
}

impl Setup {
    /// What every rung gets wrong in this quantity, about.
    ///
    /// # Cost
    /// One to three microseconds; bench `plan` measures it.
    #[must_use]
    pub fn forecast(&self, quantity: Quantity) -> Forecast {
        self.look(quantity, f64::INFINITY, STRIKES)
    }

    /// The plan of a first look: [`plan_from`](Self::plan_from) the first [`FIRST_STRIKES`].
    ///
    /// # Cost
    /// 0.4 to 0.6 µs on the average, by the tolerance, and less than 1 µs for each of the random scenes of the study, which
    /// measures it beside bench `plan`.
    #[must_use]
    pub fn plan(&self, quantity: Quantity, tolerance: f64) -> Plan {
        self.plan_from(quantity, tolerance, FIRST_STRIKES)
    }

    /// The plan from no more strikes than it hangs on, and no more than `most` of the first [`STRIKES`].
    ///
    /// Where real tilt is beyond the tolerance by the strikes so far, it is the highest pair, and neither further
    /// strikes nor lanes that know less are followed. Later strikes may mend that by a higher peak: fewer than one in a
    /// hundred plans of random scenes are the highest pair where all strikes have a cheaper one. Errors, groups and the
    /// peak are then those of the strikes so far, and what the lanes left out get wrong is told as what real tilt does;
    /// [`Forecast::at_most`] and `until_s`, where they are not known, are infinite.
    ///
    /// Where the strikes leave open what later ones do it is mostly the highest pair as well, and [`Plan::is_open`] if
    /// more of them would be looked at.
    ///
    /// # Cost
    /// With all strikes 0.4 to 0.8 µs on the average, by the tolerance, five at most.
    #[must_use]
    pub fn plan_from(&self, quantity: Quantity, tolerance: f64, most: usize) -> Plan {
        self.look(quantity, tolerance, most).plan(tolerance)
    }

    /// The same from strikes of its scene that may have been followed before.
    pub(crate) fn forecast_along(&self, trail: &mut Trail, quantity: Quantity) -> Forecast {
        self.follow(quantity, &Ends::new(&self.scene, self.position), trail, f64::INFINITY, STRIKES)
    }

    /// Whether the model of contacts takes it.
    fn is_compliant(&self) -> bool {
        self.contact_time_s.is_some_and(|time| takes(&self.scene, time))
    }

    fn look(&self, quantity: Quantity, tolerance: f64, most: usize) -> Forecast {
        let ends = Ends::new(&self.scene, self.position);
        self.follow(quantity, &ends, &mut Course::new(ends, &self.scene, self.contact_time_s), tolerance, most)
    }

    fn follow(
        &self,
        quantity: Quantity,
        ends: &Ends,
        trail: &mut impl Strikes,
        tolerance: f64,
        most: usize,
    ) -> Forecast {
        let (zeta, omega) = (self.suspension.damping().get(), self.suspension.omega());
        let response = quantity != Quantity::VelocityShock;
        let swing = if response { trail.swing(zeta, quantity == Quantity::PeakAcceleration) } else { Swing::BAR };
        let time = self.contact_time_s.unwrap_or(0.0);
        let gravity = self.scene.gravity_m_s2();
        let acts_s = trail.course().pulse.centroid * time;
        let part = Part { ends, swing: &swing, omega, shocks: !response, time, acts_s };
        let compliant = self.is_compliant();
        let mut walker = Walker::new(part, trail.course(), gravity, compliant);
        walker.follow(trail, tolerance, most);
        let walk = &walker.walk;
        let Top { peak, smooth, phase: impulse_phase, left: top } = walker.top();
        let number = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
        let of_top = |walk: &Walk, lag: &Lag, lates: &Lates| {
            let (followed, all) = walk.errors(lag, top, lates);
            (number(followed / top), number(all / top))
        };
        let (followed, tilted) = of_top(walk, &walk.tilted, &walk.lates());
        let contact_known = self.contact_time_s.is_some();
        // Without a contact time it is finite tilt that the others are held against: what it makes of later strikes is
        // the answer.
        let doubt = if walk.stop == Stop::Off { f64::INFINITY } else { tilted };
        let tilted = if contact_known { tilted } else { followed };
        // What real tilt is not sure of, parabolas and the map know by luck alone: where it does not serve, they are
        // not looked at.
        let (mut bar, [mut net, mut largest]) = ([tilted; 2], [f64::INFINITY; 2]);
        if walk.stop != Stop::Off && (!compliant || tilted <= tolerance || tolerance == f64::INFINITY) {
            let mut lags = [Lag::NONE; 2];
            walker.coarse(trail, &mut lags);
            // As parabolas something may come after all.
            let lates = walker.walk.lates();
            let [map, ballistic] = lags.each_ref().map(|lag| of_top(&walker.walk, lag, &lates).1);
            bar[1] = ballistic.max(tilted);
            bar[0] = map.max(bar[1]);
            if response {
                [net, largest] = walker.train(trail);
            }
        }
        let ([map, ballistic], walk) = (bar, &walker.walk);
        let of_peak = |shock: f64| (swing.factor * shock.abs() / peak - 1.0).abs();
        let [net, largest, impulses] = if response {
            [of_peak(net) + smooth, of_peak(largest) + smooth, smooth + (walk.jumps / peak - 1.0).max(0.0)]
        } else {
            [f64::INFINITY, 0.0, f64::INFINITY]
        };
        let (v0, gap_m) = (self.scene.speed_m_s(), trail.course().gap_m);
        Forecast {
            quantity,
            bar: [map, map, ballistic, tilted, if compliant { 0.0 } else { f64::INFINITY }],
            doubt,
            later: if walk.stop == Stop::Off { f64::INFINITY } else { number(walk.after_all() / peak) },
            component: [
                number(net),
                number(largest),
                number(impulses),
                if contact_known { 0.0 } else { f64::INFINITY },
            ],
            overlaps: walk.overlaps,
            contact_known,
            stop: walk.stop,
            shortest_gap_s: walk.shortest_gap_s,
            impulse_phase,
            omega,
            strikes: walk.strikes,
            e: ends.e,
            groups: Groups {
                gravity: gravity * gap_m / (v0 * v0),
                geometry: self.scene.tilt_rad().powi(2),
                overlap: if time > 0.0 { time / walk.shortest_gap_s } else { 0.0 },
                pulse: omega * time,
                train: omega * walk.last_s,
                damping: zeta * omega * walk.shortest_gap_s,
            },
            until_s: walk.until_s,
            peak: peak
                * match quantity {
                    Quantity::PeakAcceleration => omega,
                    Quantity::RattleSpace => 1.0 / omega,
                    Quantity::VelocityShock => 1.0,
                },
        }
    }
}

impl Forecast {
    /// What the bar rung gets wrong, with the best component model.
    #[must_use]
    pub fn bar(&self, rung: BarRung) -> Estimate {
        Estimate { error: self.bar[rung as usize], is_bound: rung == BarRung::Compliant }
    }
    /// What the component rung gets wrong, with the best bar model; infinite where it does not apply.
    #[must_use]
    pub fn component(&self, rung: ComponentRung) -> Estimate {
        let is_bound = rung == ComponentRung::PulseTrain && self.contact_known;
        Estimate { error: self.component[rung as usize], is_bound }
    }
    /// What a pair gets wrong: the sum of both. The highest pair, followed until rest, has no error by definition (what
    /// a tolerance lets [`Plan::run`](super::Plan::run) leave out of it is told there); other component models on the
    /// compliant bar are not estimated, since its contacts may merge into one.
    #[must_use]
    pub fn pair(&self, pair: Pair) -> Estimate {
        let is_bound = pair == Pair::HIGHEST;
        let merges = pair.bar == BarRung::Compliant && !is_bound;
        Estimate { error: if merges { f64::INFINITY } else { self.error(pair) }, is_bound }
    }
    /// What a planned pair gets wrong.
    pub(super) fn error(&self, pair: Pair) -> f64 {
        self.bar[pair.bar as usize] + self.component[pair.component as usize]
    }
    /// What the quantity is at most, by far more than the estimates are ever off: `peak` and [`DOUBT`] times what
    /// finite tilt and the strikes not followed leave open, or all that may come after those that were. For screening;
    /// a study of random scenes holds it.
    #[must_use]
    pub fn at_most(&self) -> f64 {
        self.peak * (1.0 + DOUBT * self.doubt).max(self.later)
    }
    /// What a pair costs in pulses of so many pieces, about, in ns on a 2.9 GHz core: a sum of constants measured once,
    /// by the study. Only ratios are good for anything, and on the average of many scenes: a single one may differ by a
    /// factor of 10.
    #[must_use]
    pub fn cost_ns(&self, pair: Pair, pieces: usize) -> f64 {
        self.prices().of(pair, pieces)
    }
    /// Whether models need to be followed for few strikes: until one that is known, or where a look was cut short because
    /// later ones do not count by more than a tolerance.
    pub(super) fn is_short(&self) -> bool {
        self.until_s < f64::INFINITY || self.stop == Stop::CutShort
    }
    /// What costs hang on. In line, it would be worked out for all.
    #[inline(never)]
    pub(super) fn prices(&self) -> Prices {
        #[expect(clippy::cast_precision_loss, reason = "a few strikes")]
        let followed = self.strikes as f64;
        if self.is_short() {
            return Prices { strikes: followed, contacts: followed };
        }
        let loss = 0.05 - ln(greater(self.e, 1e-30));
        Prices { strikes: followed + 240.0 / loss, contacts: 2.0 + 8.0 / loss }
    }
}

/// What costs hang on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prices {
    /// Strikes to follow, about, of models with impacts (until they have fallen by 10⁻¹⁵, both ends in turn) and with
    /// contacts (until both ends lie on their springs).
    strikes: f64,
    contacts: f64,
}

impl Prices {
    /// What a pair costs in pulses of so many pieces, in ns.
    pub(super) fn of(&self, pair: Pair, pieces: usize) -> f64 {
        let Self { strikes: n, contacts } = *self;
        #[expect(clippy::cast_precision_loss, reason = "a few hundred")]
        let fine = pieces as f64 / 34.0;
        let of_map = lesser(n, 20.0);
        let bar = match pair.bar {
            BarRung::ClosedForm => 300.0,
            BarRung::Map => 300.0 + 60.0 * of_map,
            BarRung::Ballistic => 300.0 + 50.0 * n,
            BarRung::FiniteTilt => 500.0 + 400.0 * n,
            BarRung::Compliant => 2e3 + 2e3 * contacts,
        };
        let component = match pair.component {
            ComponentRung::NetChange | ComponentRung::LargestShock => 150.0,
            ComponentRung::ImpulseTrain => 200.0 + 120.0 * if pair.bar == BarRung::Map { of_map } else { n },
            ComponentRung::PulseTrain if pair.bar == BarRung::Compliant => 1e3 + (1e3 + 2e3 * fine) * contacts,
            // Pulses of small shocks have few corners.
            ComponentRung::PulseTrain => {
                1e3 + (1e3 + 4.5e3 * fine) * lesser(n, if pair.bar == BarRung::Map { 8.0 } else { 40.0 })
            }
        };
        bar + component
    }
}
