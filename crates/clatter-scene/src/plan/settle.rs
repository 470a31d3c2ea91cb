//! How far strikes and contacts are followed: until nothing that can come raises the quantity.

use clatter::End;
use clatter::flight::{CompliantFlight, Flight, Model, Scene, Stop, Strike};

use super::bounds::{largest_pile, later_response, later_shock, pile, pile_until_rest, weight};
use super::ends::Ends;
use super::pulse::Pulse;
use super::swing::{Motion, Swing};
use super::{Quantity, STRIKES, Setup};
use crate::Error;

/// Looked at anew after every strike; after many, once a sixth of them has come again.
const AGAIN: usize = 6;
/// Strikes without contacts cost less than looks, and a forecast has seen as many.
const LOOK: usize = STRIKES;

/// What can come must stay below this share of the peak, as pulses flatten both, not alike; where an error is allowed,
/// by so many times the square of that more. Of 1.4·10⁵ random answers none was off by more than 1e-5 for the strikes
/// left out; with 5 % allowed, of 59 000 of the highest pair, 5 by more than 1e-4 and none by 4 %; with 10 %, 720 by more
/// than 1e-4, 99 by more than 10 %, and none by 21 %.
const CLEAR: f64 = 0.75;
const ALLOWED: f64 = 45.0;
/// No larger error counts: with this one, what can come passes the peak by 20 % at most, twice the error allowed. That
/// is seldom reached, and few long trains take most of the time.
const ONLY: f64 = 0.1;
/// Phase of the fastest mode of a component in one contact from which on that is no impulse.
const PULSE: f64 = 0.5;
/// Contact times beyond which a contact is no shock.
const LONG: f64 = 4.0;

impl Setup {
    /// A flight with contacts, and the time after which no strike of it raises the quantity by more than a tolerance lets
    /// it ([`CLEAR`]): by the bound of [`Forecast::until_s`] on the flight itself, which is followed further until it
    /// holds, or to its end.
    ///
    /// [`Forecast::until_s`]: super::Forecast::until_s
    pub(super) fn settled_flight(
        &self,
        quantity: Quantity,
        contact_s: f64,
        tolerance: f64,
    ) -> Result<(CompliantFlight, f64), Error> {
        let (mut settled_s, mut look, mut looks) = (f64::INFINITY, 1, Looks::new(self, quantity, tolerance));
        let flight = self.scene.simulate_compliant_until(contact_s, |flight| {
            let n = flight.flight.strikes.len();
            if n < look {
                return false;
            }
            look = n + 1 + n / AGAIN;
            settled_s = self.settled_s(flight, contact_s, 0.0, &mut looks);
            settled_s < f64::INFINITY
        })?;
        if settled_s == f64::INFINITY {
            settled_s = self.settled_s(&flight, contact_s, 0.0, &mut looks);
        }
        Ok((flight, settled_s))
    }

    /// A flight of impacts, each of which acts for a time, as far as any strike of it raises the quantity by more than a
    /// tolerance lets it, by the same bound.
    pub(super) fn settled_strikes(
        &self,
        scene: &Scene,
        model: Model,
        quantity: Quantity,
        lasts_s: f64,
        tolerance: f64,
    ) -> Flight {
        let (mut look, mut looks) = (LOOK, Looks::new(self, quantity, tolerance));
        scene.simulate_until(model, |flight| {
            let n = flight.strikes.len();
            if n < look {
                return false;
            }
            look = n + 1 + n / AGAIN;
            let so_far = self.so_far_by_impacts(flight, lasts_s);
            self.settled(&so_far, lasts_s, 0.0, &mut looks) < f64::INFINITY
        })
    }

    /// When nothing later in this flight raises the quantity, or passes what counts at `least`, both as velocities;
    /// infinite where that is not known. `looks` are those before, at its beginning.
    pub(crate) fn settled_s(&self, flight: &CompliantFlight, contact_s: f64, least: f64, looks: &mut Looks) -> f64 {
        self.settled(&self.so_far(flight), contact_s, least, looks)
    }

    fn settled(&self, so_far: &SoFar<'_>, contact_s: f64, least: f64, looks: &mut Looks) -> f64 {
        let (omega, g) = (self.suspension.omega(), self.scene.gravity_m_s2());
        let Looks { quantity, ends, swing, pulse, .. } = *looks;
        let velocity_shock = quantity == Quantity::VelocityShock;
        let SoFar { shocks, strikes, whole, twice_energy } = so_far;
        if shocks.is_empty() {
            return f64::INFINITY;
        }
        // What may come after the last of them.
        let speed = ends.reach(*twice_energy);
        let beyond = if *whole && !velocity_shock {
            weight(&swing, g / omega)
        } else {
            self.later(&ends, &swing, quantity, speed, contact_s, false)
        };
        let over_factor = swing.over_factor();
        let unit = over_factor * swing.factor;
        looks.see(&shocks[..shocks.len() - usize::from(*whole)], |shock, before| {
            if velocity_shock {
                let times = ((shock.parted_s - shock.from_s) / contact_s).max(1.0).ceil();
                return Seen { peak: before.peak.max(shock.net.abs() / times), ..before };
            }
            let phase = omega * (shock.next_s - shock.from_s);
            let turn = swing.turn(phase);
            let Seen { mut motion, mut loose, mut peak, .. } = before;
            let long = shock.parted_s - shock.from_s;
            let (certain, doubt) = if omega * swing.fastest() * long < PULSE && long <= LONG * contact_s {
                motion.w -= shock.net;
                (motion, loose)
            } else {
                // No impulse: what rang before may be with it or against it. Pulses flatten all of it about alike; what
                // comes later is taken as if no contacts overlapped.
                let rang = swing.bound(motion) + loose;
                loose += swing.factor * shock.gross;
                let first = || alone(&strikes[shock.first], &ends);
                (Motion { x: 0.0, w: shock.crest(&pulse, contact_s, first) }, rang)
            };
            if swing.bound(certain) > peak + doubt {
                peak = peak.max(swing.peak(certain, phase).value - doubt);
            }
            peak = peak.max(swing.quantity(swing.after(&turn, certain)).abs() - doubt);
            motion = swing.after(&turn, motion);
            // Of a contact that lasts, the end may be what shocks: what is loose fades from its parting on.
            loose *= swing.fade(omega * (shock.next_s - shock.parted_s));
            let rings = [swing.bound(motion) + loose, swing.envelope(motion) + loose * over_factor];
            Seen { motion, loose, peak, rings, fade: turn.fade }
        });
        let Looks { clear, seen, hopeless, .. } = looks;
        for (k, (_, now)) in seen.iter().enumerate().skip(*hopeless) {
            // All later shocks that are known, as if in phase, then all others.
            let ([mut at_most, mut later], most) = (now.rings, least.max(*clear * now.peak));
            let low = shocks[k + 1..].iter().enumerate().all(|(i, next)| {
                if velocity_shock {
                    return next.gross < most;
                }
                at_most += swing.factor * next.gross;
                later += unit * next.gross;
                let low = at_most.min(later) < most;
                later *= seen.get(k + 1 + i).map_or(1.0, |(_, next)| next.fade);
                low
            });
            if !low && k == *hopeless {
                *hopeless = k + 1;
            }
            if low && (if velocity_shock { beyond } else { at_most.min(later) + beyond }) < most {
                return 0.5 * (shocks[k].parted_s + shocks[k].next_s);
            }
        }
        f64::INFINITY
    }

    /// What is left at a time of a flight with contacts; `None` where they were not followed until then.
    pub(crate) fn left_at(&self, time_s: f64, flight: &CompliantFlight) -> Option<Left> {
        let so_far = self.so_far(flight);
        let last = so_far.shocks.iter().rev().find(|shock| shock.from_s <= time_s)?;
        let comes = last.next_s < f64::INFINITY;
        Some(if comes {
            Left { twice_energy: self.energy_after(flight, last), waits_s: last.next_s - last.parted_s }
        } else {
            Left::NOTHING
        })
    }

    /// Whether what is left lets later strikes, whenever they come, pass `least`, a shock or response as a velocity
    /// that none passes before.
    pub(crate) fn may_pass(&self, left: &Left, quantity: Quantity, contact_s: f64, least: f64) -> bool {
        if left.waits_s == f64::INFINITY {
            return false;
        }
        let ends = Ends::new(&self.scene, self.position);
        let swing = Swing::new(self.suspension.damping().get(), quantity == Quantity::PeakAcceleration);
        let speed = ends.reach(left.twice_energy);
        let mut later = self.later(&ends, &swing, quantity, speed, contact_s, true);
        if quantity != Quantity::VelocityShock {
            // What rings passes it no more: the envelope of a shock with that peak, faded.
            let fade = swing.fade(self.suspension.omega() * left.waits_s);
            later += least * (swing.over_factor() * fade).min(1.0);
        }
        later > least
    }

    /// The shocks, or what they do to the response, of a bar whose speed at the component stays below `speed`, about at
    /// most. With `doubt`, contacts that overlap may throw back all of the speed, and nothing is said of when the bar
    /// rests.
    fn later(&self, ends: &Ends, swing: &Swing, quantity: Quantity, speed: f64, contact_s: f64, doubt: bool) -> f64 {
        let (omega, g) = (self.suspension.omega(), self.scene.gravity_m_s2());
        let e = if doubt { 1.0 } else { ends.e };
        if quantity == Quantity::VelocityShock {
            return later_shock(speed, e, g, contact_s);
        }
        let [a, b] = [ends.at((1.0, -ends.flat[0])), ends.at((-ends.flat[1], 1.0))];
        let pile = if doubt { pile } else { pile_until_rest };
        let fall = g / omega;
        let times = pile(largest_pile(ends), swing, speed, fall, a * b >= 0.0);
        later_response(swing, speed, e, times, fall)
    }

    /// Twice the energy of the body as the last of a few contacts parts.
    fn energy_after(&self, flight: &CompliantFlight, shock: &LoneShock) -> f64 {
        twice_energy(&self.scene, &flight.flight.strikes[shock.last], flight.sample(shock.parted_s).height_m)
    }

    /// What contacts that do not overlap others do to the component's place.
    fn so_far<'a>(&self, flight: &'a CompliantFlight) -> SoFar<'a> {
        let so_far = self.lone_shocks(&flight.flight, |k| flight.pulses[k].until_s);
        let last = so_far.shocks.last().filter(|_| !so_far.whole);
        SoFar { twice_energy: last.map_or(0.0, |last| self.energy_after(flight, last)), ..so_far }
    }

    /// The same of impacts, each of which acts for a time.
    fn so_far_by_impacts<'a>(&self, flight: &'a Flight, lasts_s: f64) -> SoFar<'a> {
        let so_far = self.lone_shocks(flight, |k| flight.strikes[k].time_s + lasts_s);
        let last = so_far.shocks.last().filter(|_| !so_far.whole).map(|last| &flight.strikes[last.last]);
        SoFar { twice_energy: last.map_or(0.0, |last| twice_energy(&self.scene, last, last.height_m)), ..so_far }
    }

    /// Strikes that are over at `until_s` of their number, from 0, grouped where they overlap. Of a flight cut short,
    /// the last group is left out.
    fn lone_shocks<'a>(&self, flight: &'a Flight, until_s: impl Fn(usize) -> f64) -> SoFar<'a> {
        let strikes = &flight.strikes;
        let mut shocks: Vec<LoneShock> = Vec::with_capacity(strikes.len());
        let mut shock = LoneShock::default();
        for (k, strike) in strikes.iter().enumerate() {
            let (delta_v, until_s) = (strike.delta_v_at(self.position), until_s(k));
            if shock.strikes == 0 {
                shock.first = k;
            }
            shock.strikes += 1;
            shock.net += delta_v;
            shock.gross += delta_v.abs();
            if until_s >= shock.parted_s {
                (shock.parted_s, shock.last) = (until_s, k);
            }
            let Some(next) = strikes.get(k + 1) else { break };
            if shock.parted_s < next.time_s {
                shocks.push(LoneShock { next_s: next.time_s, ..shock });
                shock = LoneShock { from_s: next.time_s, ..LoneShock::default() };
            }
        }
        let whole = !matches!(flight.stop, Stop::ImpactLimit { .. });
        if whole {
            shocks.push(LoneShock { next_s: f64::INFINITY, ..shock });
        }
        SoFar { shocks, strikes, whole, twice_energy: 0.0 }
    }
}

/// Twice the energy after a strike with the ends at these heights, by the spin: upright, the ends do not show how fast
/// the body turns.
pub(crate) fn twice_energy(scene: &Scene, strike: &Strike, height_m: [f64; 2]) -> f64 {
    let body = scene.body();
    let [a, b] = body.arms_m();
    let center = |[of_a, of_b]: [f64; 2]| (b * of_a + a * of_b) / (a + b);
    let speed = center(strike.velocity_m_s);
    speed * speed
        + (body.gyration_m() * strike.spin_rad_s).powi(2)
        + 2.0 * scene.gravity_m_s2() * center(height_m).max(0.0)
}

/// What is left of a drop after a strike, or contacts that overlap.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Left {
    /// Twice the energy over the mass.
    pub(crate) twice_energy: f64,
    /// How long it takes then to the next one; infinite where none comes.
    pub(crate) waits_s: f64,
}

impl Left {
    const NOTHING: Self = Self { twice_energy: 0.0, waits_s: f64::INFINITY };
}

/// A flight as far as it is known.
struct SoFar<'a> {
    shocks: Vec<LoneShock>,
    strikes: &'a [Strike],
    /// Whether nothing comes after.
    whole: bool,
    /// Of the body after the last shock, over its mass; 0 where nothing comes after.
    twice_energy: f64,
}

/// What looks at the beginning of a flight have found.
#[derive(Debug)]
pub(crate) struct Looks {
    /// What is looked for, of which bar and component.
    quantity: Quantity,
    ends: Ends,
    swing: Swing,
    pulse: Pulse,
    /// What can come must stay below this share of the peak.
    clear: f64,
    /// Each lone shock but the last: when it begins, has parted and the next one begins, to the bit, and what is then
    /// known.
    seen: Vec<([u64; 3], Seen)>,
    /// So many of them are followed by known shocks that are too large: no later look finds that they settle.
    hopeless: usize,
}

/// The component as the next shock begins.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    motion: Motion,
    /// What long contacts did, however it turned since.
    loose: f64,
    /// The peak so far, at least.
    peak: f64,
    /// What rings on: at most, and as an envelope, which fades.
    rings: [f64; 2],
    /// What is left of a motion since the shock began.
    fade: f64,
}

impl Looks {
    /// Of an answer that may be off by a tolerance.
    pub(crate) fn new(setup: &Setup, quantity: Quantity, tolerance: f64) -> Self {
        let ends = Ends::new(&setup.scene, setup.position);
        Self {
            quantity,
            ends,
            swing: Swing::new(setup.suspension.damping().get(), quantity == Quantity::PeakAcceleration),
            pulse: Pulse::new(ends.e),
            clear: CLEAR + ALLOWED * tolerance.min(ONLY).powi(2),
            seen: Vec::new(),
            hopeless: 0,
        }
    }

    /// Works out what each shock leaves, by what the one before has left, unless it is known: two that were apart may
    /// be one by now.
    fn see(&mut self, shocks: &[LoneShock], leaves: impl Fn(&LoneShock, Seen) -> Seen) {
        self.seen.truncate(shocks.len());
        for (k, shock) in shocks.iter().enumerate() {
            let times = [shock.from_s, shock.parted_s, shock.next_s].map(f64::to_bits);
            if self.seen.get(k).is_none_or(|(known, _)| *known != times) {
                self.seen.truncate(k);
                let before = self.seen.last().map_or(Seen::default(), |(_, before)| *before);
                self.seen.push((times, leaves(shock, before)));
            }
        }
    }
}

/// What the contact of a strike does to the component's place if no other overlaps it.
fn alone(strike: &Strike, ends: &Ends) -> f64 {
    let (end, sin) = (usize::from(strike.end == End::B), libm::sin(strike.tilt_rad));
    let mut jumps = [-ends.ratio(end, (1.0 - sin) * (1.0 + sin)); 2];
    jumps[end] = 1.0;
    -(1.0 + ends.e) * strike.approach_m_s * ends.at(jumps.into())
}

/// One contact, or several that overlap.
#[derive(Debug, Clone, Copy, Default)]
struct LoneShock {
    strikes: u32,
    from_s: f64,
    /// When all of them have parted, and the number, from 0, of the strike that does so last.
    parted_s: f64,
    last: usize,
    /// When the next begins.
    next_s: f64,
    /// Sum of the jumps at the component's place, and of their magnitudes.
    net: f64,
    gross: f64,
    /// The number, from 0, of the first of them.
    first: usize,
}

impl LoneShock {
    /// The shock of a lone contact that pushes no harder than this one at its hardest: of several, no less than they do
    /// on the mean, nor, where the dashpot pushes at once, than the first one does before the next begins.
    fn crest(&self, pulse: &Pulse, contact_s: f64, first: impl Fn() -> f64) -> f64 {
        if self.strikes == 1 {
            return self.net.abs();
        }
        let mean = self.net.abs() * (contact_s / (self.parted_s - self.from_s)) / pulse.crest();
        if pulse.begins_hardest() { mean.max(first().abs()) } else { mean }
    }
}
