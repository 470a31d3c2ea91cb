//! What every rung gets wrong in a scene, estimated before anything is simulated.

use clatter::flight::Scene;

use super::lane::Ends;
use super::pulse::Pulse;
use super::swing::{Motion, Swing};
use super::trail::Trail;
use super::{BarRung, ComponentRung, Estimate, Pair, Quantity, Setup};

/// Strikes followed at most.
pub const STRIKES: usize = 8;
/// Strikes followed at most by a second look.
pub const MANY_STRIKES: usize = 96;

/// What later strikes can do must stay below this share of the peak for the following to stop: pulses flatten both, not alike.
const CLEAR: f64 = 0.9;

/// Later strikes that could add more than this share of the peak are not foreseen from the earlier ones.
const ROOM: f64 = 0.5;

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
    /// Errors of the bar rungs up to finite tilt, as a share of the peak; the compliant one has none.
    bar: [f64; 4],
    /// By how much the strikes that were not followed may pass the peak, with the error of finite tilt.
    pub(super) doubt: f64,
    /// What is wrong with one net change, one largest shock, impulses.
    component: [f64; 3],
    /// Share of the error of finite tilt that overlap makes.
    pub(super) overlaps: bool,
    pub(super) contact_known: bool,
    /// Whether the compliant rung takes the scene.
    pub(super) compliant: bool,
    /// Shortest time between the strikes followed.
    pub(super) shortest_gap_s: f64,
    /// Largest contact time at which impulses are within a share of 1, by the error's square root or itself.
    pub(super) impulse_phase: [f64; 2],
    pub(super) omega: f64,
    /// Strikes of impacts and of contacts until `until_s`, about.
    strikes: f64,
    contacts: f64,
    /// The groups.
    pub groups: Groups,
    /// No strike after this time since the first touch raises the quantity: models need not be followed further. Infinite where
    /// that is not known.
    pub until_s: f64,
    /// What the peak is, about.
    pub peak: f64,
}

/// One interval between strikes, as the lane with all physics has it.
#[derive(Debug, Clone, Copy, Default)]
struct Interval {
    /// When it begins.
    from_s: f64,
    /// Largest value, and the phase at which it stands.
    value: f64,
    phase: f64,
    /// Rate of the value by the phase there: below 0 where a shock begins the interval, above 0 where the next one ends it.
    slope: f64,
    /// Bound on how far the map, the parabolas and real tilt are off it.
    off: [f64; 3],
}

/// How far the contacts of one strike and of the next act on each other.
#[derive(Debug, Clone, Copy)]
struct Coupling {
    pulse: Pulse,
    e: f64,
    /// Contact time; 0 where it is not known.
    time: f64,
    velocity_shock: bool,
    /// Share of the speed that both ends together rebound with.
    rebound: f64,
}

/// A strike as its contact has it: its shocks of both ends, and its age.
#[derive(Debug, Clone, Copy)]
struct Pressing {
    delta_v: [f64; 2],
    age_s: f64,
}

impl Coupling {
    fn new(ends: &Ends, pulse: Pulse, time: f64, quantity: Quantity) -> Self {
        let q = ends.ratio(0, 1.0).abs().max(ends.ratio(1, 1.0).abs());
        // Both contacts at once swing with √(1 ∓ q) of the lone frequency and damping; 1.3 for partings that are not at once.
        let rebound = (1.3 * libm::pow(ends.e, (1.0 - q).max(0.0).sqrt())).min(1.0);
        Self { pulse, e: ends.e, time, velocity_shock: quantity == Quantity::VelocityShock, rebound }
    }
    /// What end i may have been given more or less of, in m/s, where the other one strikes with `kick` for end i while the contact of end i,
    /// which does `had` in all, is as old as `age`.
    ///
    /// A linear contact struck by a velocity δ in the share x of its time gives `(1 + e)(1 − r(1 − x)) δ` more, with r the share that is to
    /// come after a time. Upward it parts early, and loses what is to come at most; downward the train of impacts has
    /// a strike of its own there, which differs by e of the contact and by what no longer has time to come back.
    fn pushed(&self, age: f64, kick: f64, had: f64) -> f64 {
        let (x, rise) = (age / self.time, self.pulse.delay());
        if x.is_nan() || x >= 1.0 + rise {
            return 0.0;
        }
        // Fitted: an end that has parted is still below the ground, and comes up with what it rebounds with.
        let dent = if kick < 0.0 { -kick * (DENT * (1.0 + rise - x) / rise).min(DENT) } else { 0.0 };
        if x >= 1.0 {
            return dent;
        }
        let back = self.pulse.remaining(1.0 - x);
        let whole = (1.0 + self.e) * (1.0 - back) * kick.abs();
        if kick > 0.0 {
            whole.min(self.pulse.remaining(x) * had)
        } else {
            whole.min(self.e * had + (1.0 + self.e) * back * -kick).max(dent)
        }
    }
    /// The same of the end that strikes, for which the other contact had `kick`: what of that is to come acts while it presses.
    fn held(&self, age: f64, kick: f64) -> f64 {
        if age >= self.time {
            return 0.0;
        }
        (1.0 + self.e) * self.pulse.remaining(age / self.time).powi(2) * kick.abs()
    }
    /// By how much a window of one contact time may hold more than one of two shocks, or less.
    fn windows(&self, gap: f64, [earlier, later]: [f64; 2]) -> f64 {
        if gap >= self.time {
            return 0.0;
        }
        let x = gap / self.time;
        let tail = self.pulse.remaining(x) * earlier.abs();
        let head = (1.0 - self.pulse.remaining(1.0 - x)) * later.abs();
        if earlier * later > 0.0 { tail + head } else { tail }
    }
}

/// Share of a shock that pushes an end which has just parted down once more.
const DENT: f64 = 0.3;

/// Bound on the shocks to come of a bar whose speed at the component stays below `speed`: from one side to the other, by one contact
/// or by both together.
pub(super) fn later_shock(speed: f64, gravity: f64, contact_s: f64) -> f64 {
    2.0 * speed + gravity * contact_s
}

/// What the same may add to the response, about: one such shock, and the weight that the ground carries in the end.
pub(super) fn later_response(swing: &Swing, speed: f64, gravity: f64, omega: f64) -> f64 {
    2.0 * swing.factor * speed + weight(swing, gravity / omega)
}

/// What the weight does to the response when the ground takes it up at once.
pub(super) fn weight(swing: &Swing, fall: f64) -> f64 {
    (1.0 + swing.factor) * fall
}

/// Whether [`Scene::simulate_compliant`] takes it: its own conditions, without the fit.
fn takes(scene: &Scene, time: f64) -> bool {
    let (body, v0) = (scene.body(), scene.speed_m_s());
    let length = body.length_m();
    let fastest = body.arms_m().iter().fold(v0, |m, arm| m.max(v0 + arm * scene.spin_rad_s().abs()));
    scene.e() >= 0.01
        && body.gyration_m() >= 0.05 * length
        && time * fastest <= 0.1 * length
        && time * time * scene.gravity_m_s2() <= 0.01 * length
}

/// Everything of a walk that outlives it.
#[derive(Debug, Clone, Copy)]
struct Walk<const N: usize> {
    intervals: [Interval; N],
    strikes: usize,
    /// Bound on the response, or shock, after the strikes followed; what of it is not there yet.
    late: f64,
    extra: f64,
    /// Whether nothing later can exceed the peak, and until when that needs following.
    until_s: f64,
    largest: f64,
    net: f64,
    last_s: f64,
    shortest_gap_s: f64,
    overlaps: bool,
    /// Lanes that have had the same strikes so far.
    alive: [bool; 3],
}

impl Setup {
    /// What every rung gets wrong in this quantity, about.
    ///
    /// # Cost
    /// Two to five microseconds; bench `plan` measures it.
    #[must_use]
    pub fn forecast(&self, quantity: Quantity) -> Forecast {
        self.follow::<STRIKES>(quantity, &mut Trail::new(&self.scene, self.contact_time_s))
    }

    /// The same from strikes of its scene that may have been followed before.
    pub(crate) fn forecast_along(&self, trail: &mut Trail, quantity: Quantity) -> Forecast {
        self.follow::<STRIKES>(quantity, trail)
    }

    /// The same from a longer look, of [`MANY_STRIKES`]: worth it before contacts are followed, where the first few strikes leave open what
    /// later ones do.
    ///
    /// # Cost
    /// Some ten times as much.
    #[must_use]
    pub fn forecast_far(&self, quantity: Quantity) -> Forecast {
        self.follow::<MANY_STRIKES>(quantity, &mut Trail::new(&self.scene, self.contact_time_s))
    }

    fn follow<const N: usize>(&self, quantity: Quantity, trail: &mut Trail) -> Forecast {
        let ends = Ends::new(&self.scene, self.position);
        let (zeta, omega) = (self.suspension.damping().get(), self.suspension.omega());
        let swing = Swing::new(zeta, quantity == Quantity::PeakAcceleration);
        let pulse = trail.pulse;
        let time = self.contact_time_s.unwrap_or(0.0);
        let coupling = Coupling::new(&ends, pulse, time, quantity);
        let walk = self.walk::<N>(&ends, &swing, &coupling, trail);
        let intervals = &walk.intervals[..walk.strikes];
        let peak = intervals.iter().fold(Interval::default(), |m, i| if i.value > m.value { *i } else { m });
        // As if impulses, then as pulses: a peak that pulses flatten leaves more room to every error.
        let (smooth, impulse_phase) = smoothing(&pulse, omega * time, &peak, zeta);
        let response = quantity != Quantity::VelocityShock;
        let left = if response { 1.0 - smooth.min(0.8) } else { 1.0 };
        let number = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
        // What pulses leave of the peak: another that comes up to it may be the higher one.
        let top = if response { left * peak.value } else { peak.value };
        let worst = |k: usize| {
            let mut error = peak.off[k];
            for i in intervals {
                error = error.max(i.off[k] + (i.value - top).min(0.0));
            }
            [error, error.max(walk.later(k, peak.value))].map(|error| error / (left * peak.value))
        };
        let [[_, map], [_, ballistic], [followed, tilted]] = [worst(0), worst(1), worst(2)];
        let contact_known = self.contact_time_s.is_some();
        // Without a contact time it is finite tilt that the others are held against: what it makes of later strikes is the answer.
        let doubt = number(tilted);
        let tilted = if contact_known { tilted } else { followed };
        // What real tilt is not sure of, parabolas and the map know by luck alone.
        let tilted = number(tilted);
        let ballistic = number(ballistic).max(tilted);
        let map = number(map).max(ballistic);
        let of_peak = |shock: f64| (swing.factor * shock.abs() / peak.value - 1.0).abs();
        let component = if response {
            [of_peak(walk.net) + smooth, of_peak(walk.largest) + smooth, smooth]
        } else {
            [f64::INFINITY, 0.0, f64::INFINITY]
        };
        let (strikes, contacts) = walk.about(ends.e);
        let (v0, gap) = (self.scene.speed_m_s(), self.scene.height_gap_m());
        Forecast {
            quantity,
            bar: [map, map, ballistic, tilted],
            doubt,
            component: component.map(number),
            overlaps: walk.overlaps,
            contact_known,
            compliant: self.contact_time_s.is_some_and(|time| takes(&self.scene, time)),
            shortest_gap_s: walk.shortest_gap_s,
            impulse_phase,
            omega,
            strikes,
            contacts,
            groups: Groups {
                gravity: self.scene.gravity_m_s2() * gap / (v0 * v0),
                geometry: self.scene.tilt_rad().powi(2),
                overlap: time / walk.shortest_gap_s,
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

    /// Follows the first strikes in four lanes.
    #[expect(
        clippy::too_many_lines,
        reason = "one loop; all that it carries from strike to strike is used by the next"
    )]
    fn walk<const N: usize>(&self, ends: &Ends, swing: &Swing, coupling: &Coupling, trail: &mut Trail) -> Walk<N> {
        let (g, omega, time) = (self.scene.gravity_m_s2(), self.suspension.omega(), coupling.time);
        let shocks = coupling.velocity_shock;
        let unit = if shocks { 1.0 } else { swing.factor };
        let mut walk = Walk {
            intervals: [Interval::default(); N],
            strikes: 0,
            late: 0.0,
            extra: 0.0,
            until_s: f64::INFINITY,
            largest: 0.0,
            net: 0.0,
            last_s: 0.0,
            shortest_gap_s: f64::INFINITY,
            overlaps: false,
            alive: [true; 3],
        };
        // Fitted: the mean bend of a large tilt mistimes strikes by a share of the time since the first.
        let blur = 0.25 * self.scene.tilt_rad().powi(2);
        let (mut motion, mut off) = (Motion::default(), [Motion::default(); 3]);
        // Shocks that a lane lacks, and shocks in doubt, faded.
        let (mut lacking, mut doubtful) = ([0.0_f64; 3], 0.0_f64);
        // How much higher the component may ring where strikes are mistimed.
        let mut adrift = 0.0_f64;
        // The last contacts of both ends, and how far the motion of the ends after them is in doubt.
        let (mut pressing, mut loose) = ([None::<Pressing>; 2], 0.0_f64);
        let mut peak = 0.0_f64;
        // Time since the strike before, whether an end lay on the ground or the bar tumbled, and the energy left.
        let (mut gap, mut rested, mut tumbles, mut twice_energy) = (0.0, false, false, trail.twice_energy);
        // Speed at the component before the last strike, and what overlapping contacts leave of it.
        let (mut before, mut floor) = (ends.reach(twice_energy), 0.0_f64);
        // Strikes of the map that belong to those followed.
        let mut mapped = 0;
        loop {
            let n = walk.strikes;
            if n > 0 {
                let interval = &mut walk.intervals[n - 1];
                if !shocks {
                    let turn = trail.turn(n - 1, swing, omega * gap);
                    if swing.bound(motion) > 0.5 * peak {
                        let top = swing.peak(motion, omega * gap);
                        (interval.value, interval.phase, interval.slope) = (top.value, top.phase, top.slope);
                    }
                    motion = swing.after(&turn, motion);
                    let (end, rate) = (swing.quantity(motion), swing.quantity(swing.rate(motion)));
                    if end.abs() > interval.value {
                        (interval.value, interval.phase) = (end.abs(), omega * gap);
                        interval.slope = (rate * end.signum()).max(0.0);
                    }
                    for (off, lacking) in off.iter_mut().zip(&mut lacking) {
                        *off = swing.after(&turn, *off);
                        *lacking *= turn.fade;
                    }
                    doubtful *= turn.fade;
                    adrift *= turn.fade;
                }
                peak = peak.max(interval.value);
                if rested && !shocks {
                    // The ground carried the weight, which no train of strikes has: as one push, or as a load.
                    let weight = g * gap.min(2.0 / omega);
                    doubtful += weight;
                    for off in &mut interval.off {
                        *off += unit * weight;
                    }
                }
                walk.shortest_gap_s = walk.shortest_gap_s.min(gap);
                walk.overlaps |= gap < time;
                let now = ends.reach(twice_energy);
                if gap < time {
                    floor = floor.max(coupling.rebound * before);
                }
                let speed = now.max(floor);
                before = now;
                (walk.late, walk.extra) = if shocks {
                    let shock = later_shock(speed, g, time);
                    (shock, shock)
                } else {
                    let extra = later_response(swing, speed, g, omega);
                    (swing.bound(motion) + adrift + extra, extra)
                };
                if walk.late < CLEAR * peak && gap >= time {
                    // Strikes of other models may be later than those of this one.
                    // A flat drop has all of it at the first touch, and a time limit is above 0.
                    walk.until_s = (1.25 * walk.last_s + 0.5 * (gap + time)).max(f64::MIN_POSITIVE);
                    break;
                }
                if n == N || tumbles {
                    break;
                }
            }
            let Some(step) = trail.step(n) else { break };
            let delta_v = ends.at(step.delta_v);
            walk.last_s += gap;
            // The ground also carries the weight while it pushes.
            doubtful += g * if n == 0 { time } else { time.min(gap) };
            let (j, i) = (step.end, 1 - step.end);
            // What the component gets of a velocity that a contact gives.
            let at = |given: f64, contact: &[f64; 2], end: usize| given * (ends.at(*contact) / contact[end]).abs();
            // Of a motion in doubt, the shock is as much.
            let strike = step.delta_v[j].abs();
            let astray = if strike > 0.0 { delta_v.abs() * (loose * (1.0 + ends.e) / strike).min(1.0) } else { 0.0 };
            for pressing in pressing.iter_mut().flatten() {
                pressing.age_s += gap;
            }
            // Where this end presses already, it is the same contact.
            let own = pressing[j].filter(|own| own.age_s < time);
            let mut doubt = if own.is_some() && shocks { delta_v.abs() } else { 0.0 };
            if let Some(other) = pressing[i] {
                let age = (other.age_s - blur * walk.last_s).max(0.0);
                let pushed = coupling.pushed(age, step.delta_v[i], other.delta_v[i].abs());
                let held = if own.is_none() { coupling.held(age, other.delta_v[j]) } else { 0.0 };
                loose += pushed + held;
                doubt += at(pushed, &other.delta_v, i) + if held > 0.0 { at(held, &step.delta_v, j) } else { 0.0 };
                if shocks {
                    doubt += coupling.windows(age, [ends.at(other.delta_v), delta_v]);
                }
            }
            if doubt > 0.0 {
                // All that a contact which is still there has a part in.
                for interval in walk.intervals[..n].iter_mut().rev() {
                    for off in &mut interval.off {
                        *off += unit * doubt;
                    }
                    if walk.last_s - interval.from_s >= time {
                        break;
                    }
                }
            }
            doubtful += doubt + astray;
            let contact = own.unwrap_or(Pressing { delta_v: [0.0; 2], age_s: 0.0 });
            pressing[j] = Some(Pressing {
                delta_v: [contact.delta_v[0] + step.delta_v[0], contact.delta_v[1] + step.delta_v[1]],
                ..contact
            });
            if rested {
                // The end that lies there is struck through the bar at the same instant.
                doubtful += 2.0 * delta_v.abs();
            }
            let last = delta_v.abs();
            adrift += swing.factor * last * (omega * blur * walk.last_s).min(2.0);
            if n > 0 && walk.intervals[n - 1].slope > 0.0 {
                // A value that the next shock cuts off is as high as that is late.
                let cut = &mut walk.intervals[n - 1];
                for (off, own) in cut.off.iter_mut().zip(step.own) {
                    *off += own.map_or(0.0, |(after, _)| cut.slope * (omega * (after - gap)).abs().min(2.0));
                }
            }
            let rate = swing.rate(motion);
            motion.w -= delta_v;
            let value = if shocks { last } else { 0.0 };
            let mut interval = Interval { from_s: walk.last_s, value, ..Interval::default() };
            for k in 0..3 {
                let mut shock_off = last;
                if let Some((after, own_delta_v)) = step.own[k] {
                    let own_delta_v = ends.at(own_delta_v);
                    if k == 0 {
                        mapped += 1;
                        walk.largest = walk.largest.max(own_delta_v.abs());
                        walk.net += own_delta_v;
                    }
                    shock_off = (own_delta_v - delta_v).abs();
                    // A later strike lets the motion turn further, to its opposite at most.
                    let turned = (omega * (after - gap)).clamp(-2.0, 2.0);
                    off[k].x += rate.x * turned;
                    off[k].w += rate.w * turned - (own_delta_v - delta_v);
                } else {
                    walk.alive[k] = false;
                    lacking[k] += last;
                }
                interval.off[k] = if shocks {
                    shock_off + doubtful
                } else {
                    swing.bound(off[k]) + swing.factor * (lacking[k] + doubtful)
                };
            }
            walk.intervals[n] = interval;
            walk.strikes += 1;
            let Some(follows) = step.follows else {
                // Nothing falls any more: the ring-down.
                let interval = &mut walk.intervals[n];
                if !shocks {
                    let top = swing.peak(motion, f64::INFINITY);
                    (interval.value, interval.phase, interval.slope) = (top.value, top.phase, top.slope);
                }
                walk.until_s = f64::INFINITY;
                (walk.late, walk.extra) = (0.0, 0.0);
                break;
            };
            let (later_by, delta_v) = step.rival;
            if later_by < blur * (walk.last_s + follows) {
                // Which end strikes first is not known: the other one may do so, and be thrown up only then.
                let shock = ends.at(delta_v).abs();
                for off in &mut walk.intervals[n].off {
                    *off += unit * shock;
                }
                doubtful += shock;
            }
            (gap, rested, tumbles, twice_energy) = (follows, step.rests, step.tumbles, step.twice_energy);
        }
        // The closed form has the whole train of the map.
        let mut left = N;
        while walk.net.is_finite()
            && let Some((.., delta_v)) = trail.of_map(mapped)
        {
            mapped += 1;
            let delta_v = ends.at(delta_v);
            walk.largest = walk.largest.max(delta_v.abs());
            walk.net = if left == 0 { f64::INFINITY } else { walk.net + delta_v };
            left = left.saturating_sub(1);
        }
        walk
    }
}

impl<const N: usize> Walk<N> {
    /// What lane k may get wrong after the strikes followed.
    fn later(&self, k: usize, peak: f64) -> f64 {
        let above = self.late - peak;
        let intervals = &self.intervals[..self.strikes];
        // The map has no later strikes; the others have them, about.
        if above <= 0.0 || k == 0 || self.extra >= ROOM * peak {
            return above;
        }
        let worst = intervals.iter().fold(0.0_f64, |m, i| m.max(i.off[k]));
        // Fitted: what later strikes add is off by 4 times what the earlier ones were.
        let share = if self.alive[k] { 4.0 * (worst / peak).min(1.0) } else { 4.0 };
        above.min(share * self.extra + intervals.last().map_or(0.0, |i| i.off[k]))
    }
    /// Strikes until `until_s`, about, of models with impacts (until they have fallen by 10⁻¹⁵, both ends in turn) and with contacts
    /// (until both ends lie on their springs).
    fn about(&self, e: f64) -> (f64, f64) {
        let loss = 0.05 - libm::log(e.max(1e-30));
        #[expect(clippy::cast_precision_loss, reason = "a few strikes")]
        let followed = self.strikes as f64;
        if self.until_s < f64::INFINITY { (followed, followed) } else { (followed + 240.0 / loss, 2.0 + 8.0 / loss) }
    }
}

/// What impulses in place of pulses change at a peak, and the phases ωτ at which a term linear and one quadratic in them would be 1.
///
/// A pulse is an impulse at its centroid, spread by its variance: `½ σ² ω²` of a peak inside the swing, which bends by itself. A peak that
/// stands where the shock begins is reached when the pulse is over, `age` after the centroid, and has fallen by then:
/// `slope age + ½ (1 − 2ζ slope) age²`. One that the next shock cuts off is cut off within that pulse.
fn smoothing(pulse: &Pulse, turned: f64, peak: &Interval, zeta: f64) -> (f64, [f64; 2]) {
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
        let error = match rung {
            BarRung::ClosedForm => self.bar[0],
            BarRung::Map => self.bar[1],
            BarRung::Ballistic => self.bar[2],
            BarRung::FiniteTilt => self.bar[3],
            BarRung::Compliant => return Estimate { error: self.compliant_error(), is_bound: true },
        };
        Estimate { error, is_bound: false }
    }
    fn compliant_error(&self) -> f64 {
        if self.compliant { 0.0 } else { f64::INFINITY }
    }
    /// What the component rung gets wrong, with the best bar model; infinite where it does not apply.
    #[must_use]
    pub fn component(&self, rung: ComponentRung) -> Estimate {
        let error = match rung {
            ComponentRung::NetChange => self.component[0],
            ComponentRung::LargestShock => self.component[1],
            ComponentRung::ImpulseTrain => self.component[2],
            // Without a contact time there are no pulses.
            ComponentRung::PulseTrain if self.contact_known => return Estimate { error: 0.0, is_bound: true },
            ComponentRung::PulseTrain => f64::INFINITY,
        };
        Estimate { error, is_bound: false }
    }
    /// What a pair gets wrong: the sum of both. The highest pair has no error by definition; other component models on the
    /// compliant bar are not estimated, since its contacts may merge into one.
    #[must_use]
    pub fn pair(&self, pair: Pair) -> Estimate {
        if pair == Pair::HIGHEST {
            return Estimate { error: self.compliant_error(), is_bound: true };
        }
        let error = if pair.bar == BarRung::Compliant {
            f64::INFINITY
        } else {
            self.bar(pair.bar).error + self.component(pair.component).error
        };
        Estimate { error, is_bound: false }
    }
    /// What the quantity is at most, by far more than the estimates are ever off: `peak` and [`DOUBT`] times what finite tilt and
    /// the strikes not followed leave open. For screening; a study of random scenes holds it.
    #[must_use]
    pub fn at_most(&self) -> f64 {
        self.peak * (1.0 + DOUBT * self.doubt)
    }
    /// What a pair costs, about, in ns on a 2.9 GHz core: a sum of constants measured once, by the study. Only ratios are good for
    /// anything, and on the average of many scenes: a single one may differ by a factor of 10.
    #[must_use]
    pub fn cost_ns(&self, pair: Pair) -> f64 {
        let (n, contacts) = (self.strikes, self.contacts);
        let bar = match pair.bar {
            BarRung::ClosedForm => 200.0,
            BarRung::Map => 300.0 + 60.0 * n.min(20.0),
            BarRung::Ballistic => 300.0 + 50.0 * n,
            BarRung::FiniteTilt => 500.0 + 300.0 * n,
            BarRung::Compliant => 3e3 + 5e3 * contacts,
        };
        let component = match pair.component {
            ComponentRung::NetChange | ComponentRung::LargestShock => 150.0,
            ComponentRung::ImpulseTrain => 200.0 + 120.0 * if pair.bar == BarRung::Map { n.min(20.0) } else { n },
            ComponentRung::PulseTrain if pair.bar == BarRung::Compliant => 5e3 + 12e3 * contacts,
            // Pulses of small shocks have few corners.
            ComponentRung::PulseTrain => 4e3 + 8e3 * n.min(if pair.bar == BarRung::Map { 8.0 } else { 40.0 }),
        };
        bar + component
    }
}
