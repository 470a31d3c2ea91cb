//! What every rung gets wrong in a scene, estimated before anything is simulated.

use clatter::flight::Scene;

use super::ends::Ends;
use super::lag::{Lag, Part};
use super::pulse::Pulse;
use super::swing::{Peak, Swing};
use super::trail::{Course, Strikes, Trail};
use super::walk::{Stop, Walk, Walker};
use super::{BarRung, ComponentRung, Estimate, Pair, Plan, Quantity, Setup};

/// Strikes followed at most.
pub const STRIKES: usize = 8;
/// Strikes followed at most by the first look of a plan.
pub const FIRST_STRIKES: usize = 3;
/// Strikes followed at most by a longer look.
pub const MANY_STRIKES: usize = 48;

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
        self.look::<STRIKES>(quantity, f64::INFINITY)
    }

    /// The plan of a first look, from no more of [`FIRST_STRIKES`] than it hangs on: where real tilt is beyond the
    /// tolerance by the strikes so far, it is the highest pair, and neither further strikes nor lanes that know less
    /// are followed. Later strikes may mend that by a higher peak: fewer than one in a hundred plans of random scenes are
    /// the highest pair where a longer look has a cheaper one. Errors, groups and the peak are then those of the strikes so far, and
    /// what the lanes left out get wrong is told as what real tilt does; [`Forecast::at_most`] and `until_s`, where
    /// they are not known, are infinite.
    ///
    /// Where these few strikes leave open what later ones do, it is the highest pair as well, and [`Plan::refined`]
    /// looks longer. Without contacts, which then could decide all that is left open, it is the plan of
    /// [`Setup::forecast`].
    ///
    /// # Cost
    /// Half to one microsecond on the average, by the tolerance, which the study measures beside bench `plan`; two to
    /// three without contacts.
    #[must_use]
    pub fn plan(&self, quantity: Quantity, tolerance: f64) -> Plan {
        let look = if self.is_compliant() { Self::look::<FIRST_STRIKES> } else { Self::look::<STRIKES> };
        look(self, quantity, tolerance).plan(tolerance)
    }

    /// The same from strikes of its scene that may have been followed before.
    pub(crate) fn forecast_along(&self, trail: &mut Trail, quantity: Quantity) -> Forecast {
        self.follow::<STRIKES>(quantity, &Ends::new(&self.scene, self.position), trail, f64::INFINITY)
    }

    /// The same from a longer look, of [`MANY_STRIKES`]: worth it before contacts are followed, where the first few
    /// strikes leave open what later ones do.
    ///
    /// # Cost
    /// Four to seven microseconds on the average, some twenty at most.
    #[must_use]
    pub fn forecast_far(&self, quantity: Quantity) -> Forecast {
        self.look::<MANY_STRIKES>(quantity, f64::INFINITY)
    }

    /// The same from a longer look, and no more of it than a plan follows.
    pub(super) fn plan_far(&self, quantity: Quantity, tolerance: f64) -> Plan {
        self.look::<MANY_STRIKES>(quantity, tolerance).plan(tolerance)
    }

    /// Whether the model of contacts takes it.
    fn is_compliant(&self) -> bool {
        self.contact_time_s.is_some_and(|time| takes(&self.scene, time))
    }

    fn look<const N: usize>(&self, quantity: Quantity, tolerance: f64) -> Forecast {
        let ends = Ends::new(&self.scene, self.position);
        self.follow::<N>(quantity, &ends, &mut Course::new(ends, &self.scene, self.contact_time_s), tolerance)
    }

    fn follow<const N: usize>(
        &self,
        quantity: Quantity,
        ends: &Ends,
        trail: &mut impl Strikes,
        tolerance: f64,
    ) -> Forecast {
        let (zeta, omega) = (self.suspension.damping().get(), self.suspension.omega());
        let response = quantity != Quantity::VelocityShock;
        let swing = if response { trail.swing(zeta, quantity == Quantity::PeakAcceleration) } else { Swing::BAR };
        let pulse = trail.course().pulse;
        let time = self.contact_time_s.unwrap_or(0.0);
        let gravity = self.scene.gravity_m_s2();
        let part = Part { ends, swing: &swing, omega, shocks: !response, time };
        let mut walker = Walker::<N>::new(part, trail.course(), gravity);
        let compliant = self.is_compliant();
        let tolerance = if compliant { tolerance } else { f64::INFINITY };
        walker.follow(trail, tolerance);
        let walk = &walker.walk;
        let peak = walk.peak();
        // As if impulses, then as pulses: a peak that pulses flatten leaves more room to every error.
        let (smooth, impulse_phase) =
            if response { smoothing(&pulse, omega * time, &peak, zeta) } else { (0.0, [0.0; 2]) };
        let top = (1.0 - smooth.min(0.8)) * peak.value;
        let number = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
        let of_top = |walk: &Walk<N>, lag: &Lag<N>| walk.errors(lag, top).map(|error| number(error / top));
        let [followed, tilted] = of_top(walk, &walk.tilted);
        let contact_known = self.contact_time_s.is_some();
        // Without a contact time it is finite tilt that the others are held against: what it makes of later strikes is
        // the answer.
        let doubt = if walk.stop == Stop::Off { f64::INFINITY } else { tilted };
        let tilted = if contact_known { tilted } else { followed };
        // What real tilt is not sure of, parabolas and the map know by luck alone: where it does not serve, they are
        // not looked at.
        let (mut bar, [mut net, mut largest]) = ([tilted; 2], [f64::INFINITY; 2]);
        if walk.stop != Stop::Off && (tilted <= tolerance || tolerance == f64::INFINITY) {
            let lags = walker.coarse(trail);
            let [map, ballistic] = lags.map(|lag| of_top(&walker.walk, &lag)[1]);
            bar[1] = ballistic.max(tilted);
            bar[0] = map.max(bar[1]);
            if response {
                [net, largest] = walker.train(trail);
            }
        }
        let ([map, ballistic], walk) = (bar, &walker.walk);
        let of_peak = |shock: f64| (swing.factor * shock.abs() / peak.value - 1.0).abs();
        let [net, largest, impulses] = if response {
            [of_peak(net) + smooth, of_peak(largest) + smooth, smooth + (walk.jumps / peak.value - 1.0).max(0.0)]
        } else {
            [f64::INFINITY, 0.0, f64::INFINITY]
        };
        let (v0, gap_m) = (self.scene.speed_m_s(), trail.course().gap_m);
        Forecast {
            quantity,
            bar: [map, map, ballistic, tilted, if compliant { 0.0 } else { f64::INFINITY }],
            doubt,
            later: if walk.stop == Stop::Off { f64::INFINITY } else { number(walk.late / peak.value) },
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
            peak: peak.value
                * match quantity {
                    Quantity::PeakAcceleration => omega,
                    Quantity::RattleSpace => 1.0 / omega,
                    Quantity::VelocityShock => 1.0,
                },
        }
    }
}

/// What impulses in place of pulses change at a peak, as a share of it, and the coefficients of the terms linear and
/// quadratic in the phase ωτ (for a peak inside the swing an approximation).
///
/// A pulse is an impulse at its centroid, spread by its variance: `½ σ² ω²` of a peak inside the swing, which bends by
/// itself. A peak that stands where the shock begins is reached when the pulse is over, `age` after the centroid, and
/// has fallen by then: `slope age + ½ (1 − 2ζ slope) age²`. One that the next shock cuts off is cut off within that
/// pulse.
fn smoothing(pulse: &Pulse, turned: f64, peak: &Peak, zeta: f64) -> (f64, [f64; 2]) {
    let age = 1.0 - pulse.centroid;
    let half = 0.5 * pulse.variance;
    let slope = if peak.value > 0.0 { -peak.slope / peak.value } else { 0.0 };
    if slope < 0.0 {
        let linear = -slope * age.max(pulse.centroid);
        return (linear * turned + half * turned * turned, [linear, half]);
    }
    let late = 0.5 * age * age;
    if peak.phase > 0.0 {
        let early = late * (turned - peak.phase / age).max(0.0).powi(2);
        // A peak as early as this is one that stands at the shock.
        return (half * turned * turned + early, [0.0, if peak.phase < 0.5 { half + late } else { half }]);
    }
    let (linear, square) = (slope * age, half + late * (1.0 - 2.0 * zeta * slope).max(0.0));
    (linear * turned + square * turned * turned, [linear, square])
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
        let (bar, component) = (self.bar[pair.bar as usize], self.component[pair.component as usize]);
        let is_bound = pair == Pair::HIGHEST;
        let merges = pair.bar == BarRung::Compliant && !is_bound;
        Estimate { error: if merges { f64::INFINITY } else { bar + component }, is_bound }
    }
    /// What the quantity is at most, by far more than the estimates are ever off: `peak` and [`DOUBT`] times what
    /// finite tilt and the strikes not followed leave open, or all that may come after those that were. For screening;
    /// a study of random scenes holds it.
    #[must_use]
    pub fn at_most(&self) -> f64 {
        self.peak * (1.0 + DOUBT * self.doubt).max(self.later)
    }
    /// Strikes until `until_s`, about, of models with impacts (until they have fallen by 10⁻¹⁵, both ends in turn) and
    /// with contacts (until both ends lie on their springs).
    fn until_rest(&self) -> (f64, f64) {
        #[expect(clippy::cast_precision_loss, reason = "a few strikes")]
        let followed = self.strikes as f64;
        if self.until_s < f64::INFINITY {
            return (followed, followed);
        }
        let loss = 0.05 - libm::log(self.e.max(1e-30));
        (followed + 240.0 / loss, 2.0 + 8.0 / loss)
    }
    /// What a pair costs in pulses of so many pieces, about, in ns on a 2.9 GHz core: a sum of constants measured once,
    /// by the study. Only ratios are good for anything, and on the average of many scenes: a single one may differ by a
    /// factor of 10.
    #[must_use]
    pub fn cost_ns(&self, pair: Pair, pieces: usize) -> f64 {
        let (n, contacts) = self.until_rest();
        #[expect(clippy::cast_precision_loss, reason = "a few hundred")]
        let fine = pieces as f64 / 34.0;
        let bar = match pair.bar {
            BarRung::ClosedForm => 300.0,
            BarRung::Map => 300.0 + 60.0 * n.min(20.0),
            BarRung::Ballistic => 300.0 + 50.0 * n,
            BarRung::FiniteTilt => 500.0 + 400.0 * n,
            BarRung::Compliant => 2e3 + 2e3 * contacts,
        };
        let component = match pair.component {
            ComponentRung::NetChange | ComponentRung::LargestShock => 150.0,
            ComponentRung::ImpulseTrain => 200.0 + 120.0 * if pair.bar == BarRung::Map { n.min(20.0) } else { n },
            ComponentRung::PulseTrain if pair.bar == BarRung::Compliant => 1e3 + (1e3 + 2e3 * fine) * contacts,
            // Pulses of small shocks have few corners.
            ComponentRung::PulseTrain => {
                1e3 + (1e3 + 4.5e3 * fine) * n.min(if pair.bar == BarRung::Map { 8.0 } else { 40.0 })
            }
        };
        bar + component
    }
}
