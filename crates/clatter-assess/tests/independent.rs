//! Answers of contacts that take time against an integration that shares nothing with them: body and part together, step by
//! step, from the contact laws and the exact geometry alone (the plain integration of the flights' tests).
//!
//! A part feels the vertical acceleration of its place above free fall, 1 g where the body lies still. Of a body that turns by more than a right angle in one flight it does
//! not feel that turn, by convention; such drops are left out here.

#![expect(clippy::print_stdout, reason = "how far off the answers are, with --nocapture")]

#[path = "../../clatter-flight/tests/plain/mod.rs"]
mod plain;

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::random::Random;
use clatter::End;
use clatter_assess::{Answer, Part, answer};
use clatter_flight::Body;
use clatter_product::{ContactLaw, Drop, Error, Limit, LimitKind, Model};
use clatter_shock::{DampingRatio, Suspension};
use plain::Plain;
use rayon::prelude::*;

const G: f64 = 9.80665;

/// A bar of 60 to 400 mm, its center of mass in the middle or up to 0.15 of the half-length off it; tilts up to `tilt_deg`;
/// contacts of 0.1 to 1.5 ms, where that is no longer than the flight takes. Of e between 0 and 0.03 (a dashpot: from 0 on) the
/// plain integration would take steps too many.
fn any_drop(r: &mut Random, tilt_deg: f64) -> Drop {
    let (half, q) = (0.5 * r.decades(0.06, 0.4), r.even(-0.2, 0.85));
    let off = if r.unit() < 0.5 { 0.0 } else { r.even(-0.15, 0.15) };
    let body = Body::off_center(half * (1.0 + off), half * (1.0 - off), half * ((1.0 - q) / (1.0 + q)).sqrt());
    let (contact_law, restitution) = match r.unit() {
        x if x < 0.15 => (ContactLaw::Hysteretic, 0.0),
        x if x < 0.6 => (ContactLaw::Hysteretic, r.even(0.03, 0.95)),
        _ => (ContactLaw::Dashpot, r.even(0.05, 0.95)),
    };
    let speed_m_s = r.decades(0.7, 6.0);
    let first = if r.unit() < 0.5 { End::A } else { End::B };
    let tilt_rad = r.even(0.0, tilt_deg).to_radians();
    Drop {
        direction_rad: Drop::towards(first),
        gravity_m_s2: G,
        contact_time_s: Some(r.decades(1e-4, 1.5e-3).min(0.09 * 2.0 * half / speed_m_s)),
        contact_law,
        ..Drop::new(body.expect("a body"), speed_m_s, tilt_rad, restitution)
    }
}

/// The same on soft contacts, half of them without gravity: as long as the drop takes for a twentieth to half of the length, at tilts from 0.5
/// to 40°. The center of mass is in the middle or up to 0.3 of the half-length off it.
fn soft_drop(r: &mut Random) -> Drop {
    let drop = any_drop(r, 1.0);
    let (half, off) = (0.5 * drop.body.length_m(), if r.unit() < 0.5 { 0.0 } else { r.even(-0.3, 0.3) });
    let body = Body::off_center(half * (1.0 + off), half * (1.0 - off), drop.body.gyration_m()).expect("a body");
    let (speed_m_s, gravity_m_s2) = (r.decades(1.0, 10.0), if r.unit() < 0.5 { 0.0 } else { G });
    // Where there is gravity, no longer than what it lets.
    let most_s = 0.1 * (2.0 * half / gravity_m_s2).sqrt();
    let contact_time_s = Some((r.even(0.05, 0.5) * 2.0 * half / speed_m_s).min(most_s));
    let soft =
        Drop { body, speed_m_s, gravity_m_s2, contact_time_s, tilt_rad: r.decades(0.5, 40.0).to_radians(), ..drop };
    // Ends that would sink in by more than half of the length are refused, with the longest contact that is answered.
    match answer(&soft, &Part::new(0.0, None), &Limit::new(LimitKind::VelocityChange, 1.0), Model::Compliant, 1e-3) {
        Err(Error::Flight(clatter_flight::Error::Bound { bound, .. })) => {
            Drop { contact_time_s: Some(0.9 * bound), ..soft }
        }
        _ => soft,
    }
}

fn any_part(r: &mut Random, drop: &Drop) -> (Part, LimitKind) {
    let position_m = r.even(-0.5, 0.5) * drop.body.length_m();
    let damping = DampingRatio::new(r.decades(3e-3, 10.0)).expect("a ratio");
    let suspension = Some(Suspension::from_hz(r.decades(20.0, 2000.0), damping).expect("a suspension"));
    let (suspension, kind) = match r.unit() {
        x if x < 0.3 => (suspension, LimitKind::Acceleration),
        x if x < 0.6 => (suspension, LimitKind::RattleSpace),
        x if x < 0.75 => (None, LimitKind::Acceleration),
        x if x < 0.9 => (None, LimitKind::VelocityChange),
        _ => (None, LimitKind::AngularVelocityChange),
    };
    (Part::new(position_m, suspension), kind)
}

/// Steps of the plain integration at most: the few drops that take more are left out.
const STEPS: u32 = 300_000;

/// A drop by the plain integration.
struct Run {
    plain: Plain,
    place: [f64; 2],
    /// How long a press takes with both ends pressing, by the slower of their two motions.
    longest_s: f64,
    /// Time, velocity of the place and spin after each step, and their rates, gravity apart.
    history: Vec<[f64; 5]>,
    acceleration: f64,
}

impl Run {
    /// Seen from the other side where end b is first; a little faster or already turning.
    fn new(drop: &Drop, part: &Part, [faster, spin]: [f64; 2]) -> Self {
        let (arms, rho) = (drop.body.arms_m(), drop.body.gyration_m());
        let from_center = part.place.at_m[0] + 0.5 * (arms[1] - arms[0]);
        let ([a, b], x) = if drop.first() == End::A { (arms, from_center) } else { ([arms[1], arms[0]], -from_center) };
        let time_s = drop.contact_time_s.expect("a contact time");
        let law = (drop.contact_law, drop.restitution, time_s);
        let plain = Plain::new(&[[-a, 0.0], [b, 0.0]], rho, drop.gravity_m_s2, law);
        let mut plain = plain.start(drop.speed_m_s * (1.0 + faster), drop.tilt_rad, spin * drop.speed_m_s / a);
        if part.suspension.is_none() {
            // Where a shock ends is known to a step.
            plain.fine = 400.0;
        }
        plain.part = part.suspension.map(|part| plain::Part {
            place: [x, 0.0],
            omega: part.omega(),
            zeta: part.damping().get(),
            z: 0.0,
            v: 0.0,
            peaks: [0.0; 2],
        });
        let coupling = (rho * rho - a * b) / ((rho * rho + a * a) * (rho * rho + b * b)).sqrt();
        let longest_s = time_s / (1.0 - coupling.abs()).sqrt();
        Self { plain, place: [x, 0.0], longest_s, history: Vec::new(), acceleration: 0.0 }
    }

    /// The drop until a time; none where that takes too many steps.
    fn until(mut self, until_s: f64) -> Option<Self> {
        for _ in 0..STEPS {
            self.note();
            if self.plain.time >= until_s {
                return Some(self);
            }
            self.plain.run(usize::MAX, until_s, 1);
        }
        None
    }

    fn note(&mut self) {
        let plain = &self.plain;
        self.acceleration = self.acceleration.max(plain.felt(&plain.state, self.place).abs());
        // In free flight nothing is felt.
        let presses = f64::from(u8::from(plain.presses()));
        let turning = plain.rates(&plain.state, &plain.forces(&plain.state))[3];
        let felt = plain.felt(&plain.state, self.place);
        let rates = [presses * felt, presses * turning];
        self.history.push([plain.time, plain.velocity_of(self.place), plain.state[3], rates[0], rates[1]]);
    }

    /// Largest change of the velocity or the spin in one shock. Shocks are taken from the largest peak down; each reaches as long as
    /// the sign is kept and a tenth of its peak is exceeded, and from there as long as it goes on falling, never into an earlier one.
    fn change(&self, n: usize) -> f64 {
        let rate = |k: usize| self.history[k][n + 2];
        let mut free = vec![true; self.history.len()];
        let (mut most, mut highest) = (0.0_f64, 0.0_f64);
        loop {
            let open = (0..free.len()).filter(|&k| free[k]);
            let Some(peak) = open.max_by(|&j, &k| rate(j).abs().total_cmp(&rate(k).abs())) else { return most };
            highest = highest.max(rate(peak).abs());
            if rate(peak).abs() <= 0.01 * highest {
                return most;
            }
            let reach = |step: isize| {
                let mut at = peak;
                while let Some(k) = at.checked_add_signed(step).filter(|&k| k < free.len() && free[k]) {
                    let (here, there) = (rate(at).abs(), rate(k).abs());
                    let tenth = 0.1 * rate(peak).abs();
                    let ends = rate(k) * rate(peak) <= 0.0;
                    let goes_on = here >= tenth && there >= tenth || there < here;
                    if !(ends || goes_on) {
                        break;
                    }
                    // A rate is noted just after what happens: the step until then is of the shock.
                    at = k;
                    if ends {
                        break;
                    }
                }
                at
            };
            let (first, last) = (reach(-1), reach(1));
            free[first..=last].fill(false);
            most = most.max((self.history[last][n] - self.history[first][n]).abs());
        }
    }

    fn value(&self, kind: LimitKind) -> f64 {
        match (kind, self.plain.part) {
            (LimitKind::Acceleration, Some(part)) => part.omega * part.peaks[1],
            (LimitKind::RattleSpace, Some(part)) => part.peaks[0] / part.omega,
            (LimitKind::VelocityChange, None) => self.change(1),
            (LimitKind::AngularVelocityChange, None) => self.change(2),
            (LimitKind::Acceleration, None) => self.acceleration,
            (kind, _) => unreachable!("{kind:?} is not drawn"),
        }
    }

    /// By how much the touches until a time and the value differ from those of another drop.
    fn differs(&self, other: &Self, kind: LimitKind, speed_m_s: f64, until_s: f64) -> f64 {
        let touches =
            self.plain.touches.iter().zip(&other.plain.touches).take_while(|(touch, _)| touch.time <= until_s);
        let one = |(touch, other): (&plain::Touch, &plain::Touch)| {
            let late = (touch.time - other.time).abs() / touch.time.max(self.longest_s);
            let fast = (touch.approach - other.approach).abs() / speed_m_s;
            if touch.point == other.point { late.max(fast) } else { f64::INFINITY }
        };
        touches.map(one).fold((other.value(kind) / self.value(kind) - 1.0).abs(), f64::max)
    }
}

/// How far an answer is off, what it tells, and by how much a change of the drop is multiplied.
#[derive(Debug)]
struct Compared {
    off: f64,
    told: f64,
    times: f64,
}

/// A change of the drop by which its sensitivity is measured.
const SHAKEN: f64 = 1e-5;

fn off(drop: &Drop, part: &Part, kind: LimitKind, tolerance: f64) -> Option<(Compared, Answer)> {
    let limit = Limit::new(kind, 1.0);
    let asked = answer(drop, part, &limit, Model::Compliant, tolerance).unwrap_or_else(|e| panic!("{e}: {drop:?}"));
    // To the peak, and all through the clatter: a period of the part longer.
    let clatter_s = drop.body.length_m() * drop.tilt_rad.sin() / drop.speed_m_s + drop.contact_time_s?;
    let period_s = part.suspension.map_or(0.0, |part| TAU / part.omega());
    let until_s = (1.2 * asked.time_s).max(4.0 * clatter_s) + period_s;
    let run = |shaken| Run::new(drop, part, shaken).until(until_s);
    let laws = run([0.0; 2])?;
    if laws.plain.turned > 0.99 * FRAC_PI_2 {
        return None;
    }
    let changed = |shaken| Some(laws.differs(&run(shaken)?, kind, drop.speed_m_s, asked.time_s) / SHAKEN);
    let times = changed([SHAKEN, 0.0])?.max(changed([0.0, SHAKEN])?).max(1.0);
    // Where it is hundredfold the body all but misses the ground, or comes back from far above.
    (times < 100.0)
        .then(|| (Compared { off: (asked.value / laws.value(kind) - 1.0).abs(), told: asked.error(), times }, asked))
}

/// Checks that an answer is as exact as it tells, and as was asked: where a change of the drop is multiplied, by so much. Returns how far it
/// is off, and what it tells.
fn checked(seed: u64, drop: &Drop, part: &Part, kind: LimitKind) -> Option<(LimitKind, f64, f64)> {
    let tolerance = 1e-3;
    let (Compared { off, told, times }, answer) = off(drop, part, kind, tolerance)?;
    // The plain integration itself looks at steps of 0.02 of a radian, which miss a crest by 5e-5.
    let exact = tolerance * times + 5e-5;
    // In its dents a body may sink for ever by the law, where an answer says that it lies: that is told.
    let allowed = if answer.impact > 2 { exact.max(told) } else { exact };
    assert!(off <= allowed, "seed {seed}: {off:e}, {told:e} told, {times}-fold: {kind:?} {drop:?} {part:?} {answer:?}");
    Some((kind, off / times, told))
}

/// Checks that all but a few were compared, of every kind.
fn all_are_compared(all: &[(LimitKind, f64, f64)], least: usize) {
    let worst = all.iter().fold([0.0_f64; 2], |worst, (_, off, told)| [worst[0].max(*off), worst[1].max(*told)]);
    println!("{} drops: off by {:.1e} at most, {:.1e} told at most", all.len(), worst[0], worst[1]);
    assert!(all.len() >= least, "{} drops compared", all.len());
    // A damage boundary is of the same shocks and accelerations; none of these parts has a stop.
    let elsewhere = [LimitKind::DamageBoundary, LimitKind::StopSpeed];
    for kind in LimitKind::ALL.into_iter().filter(|kind| !elsewhere.contains(kind)) {
        assert!(all.iter().any(|(of, ..)| *of == kind), "{kind:?} is compared with nothing");
    }
}

#[test]
fn answers_are_those_of_the_laws() {
    let one = |seed: u64| {
        let mut r = Random(seed << 32);
        // Small tilts as often as any up to 15°.
        let tilt_deg = r.decades(0.1, 60.0).min(15.0);
        let drop = any_drop(&mut r, tilt_deg);
        let (part, kind) = any_part(&mut r, &drop);
        checked(seed, &drop, &part, kind)
    };
    all_are_compared(&(0..100).into_par_iter().filter_map(one).collect::<Vec<_>>(), 85);
}

/// Where ends sink in far, lever arms change all through a press.
#[test]
fn answers_on_soft_contacts_are_those_of_the_laws() {
    let one = |seed: u64| {
        let mut r = Random((seed << 32) + 11);
        let drop = soft_drop(&mut r);
        let (part, kind) = any_part(&mut r, &drop);
        checked(seed, &drop, &part, kind)
    };
    all_are_compared(&(0..100).into_par_iter().filter_map(one).collect::<Vec<_>>(), 75);
}

/// An answer at 1 % differs from one at 1e-5 by what both tell at most; contacts and instant impacts, half of the parts with a period
/// near to the time between rebounds, where later strikes may add up. Up to the second strike it differs by 1 % at most; then each
/// strike multiplies what those before it got wrong.
#[test]
fn what_is_left_out_is_told() {
    let one = |seed: u64| {
        let mut r = Random((seed << 32) + 7);
        let tilt_deg = r.decades(0.1, 60.0).min(15.0);
        let drop = any_drop(&mut r, tilt_deg);
        let (mut part, kind) = any_part(&mut r, &drop);
        let rebound_s = 2.0 * drop.restitution * drop.speed_m_s / G;
        if let Some(suspension) = part.suspension.filter(|_| seed.is_multiple_of(2) && rebound_s > 0.01) {
            let hz = f64::from([1, 2, 3][usize::try_from(seed % 3).expect("small")]) / rebound_s * r.even(0.9, 1.1);
            part.suspension = Some(Suspension::from_hz(hz, suspension.damping()).expect("a suspension"));
        }
        let model = if seed % 4 < 3 { Model::Compliant } else { Model::FiniteTilt };
        let limit = Limit::new(kind, 1.0);
        let at = |tolerance| answer(&drop, &part, &limit, model, tolerance);
        let (coarse, fine) = match (at(1e-2), at(1e-5)) {
            (Ok(coarse), Ok(fine)) => (coarse, fine),
            // More strikes than are followed.
            (_, Err(Error::Unfinished)) => return None,
            (coarse, fine) => panic!("{coarse:?} {fine:?} {drop:?}"),
        };
        let off = (coarse.value / fine.value - 1.0).abs();
        let multiplied = coarse.impact.max(fine.impact) > 2;
        let what = format!("seed {seed}, {model:?} {kind:?} {drop:?} {part:?} {coarse:?}");
        Some((off, coarse.error(), fine.error(), multiplied, what))
    };
    let all: Vec<_> = (0..300).into_par_iter().filter_map(one).collect();
    let (mut worst, mut many) = ([0.0_f64; 2], 0);
    for (off, told, finer, multiplied, what) in &all {
        let allowed = told + finer.max(1e-5);
        assert!(*off <= allowed, "{off:e}, {told:e} told: {what}");
        assert!(*multiplied || *off <= 1e-2, "{off:e}, {told:e} told: {what}");
        many += usize::from(*multiplied);
        worst = [worst[0].max(*off), worst[1].max(off / allowed)];
    }
    let count = all.len();
    println!(
        "{count} answers, {many} after the second strike, off by {:.1e} at most, {:.2} of what is told",
        worst[0], worst[1]
    );
    assert!(count - many >= 150 && many >= 50, "{many} of {count} peak after the second strike");
}
