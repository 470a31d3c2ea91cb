//! A part with stops against an integrator of small steps that knows the law of the stop alone: z, z′ and the force of the
//! stop, in classical Runge–Kutta steps, with bisection for the moments at which the law changes.

use clatter::{Section, Sine};
use clatter_shock::{DampingRatio, Hit, Peaked, Pulses, Stop, Suspension};
use proptest::prelude::*;

/// A section that owns its sinusoids.
#[derive(Debug, Clone)]
pub(crate) struct Own {
    pub(crate) length: f64,
    pub(crate) delta_v: f64,
    pub(crate) acceleration: [f64; 2],
    pub(crate) sines: Vec<Sine>,
}

impl Own {
    fn at(&self, t: f64) -> f64 {
        let [from, to] = self.acceleration;
        let line = from + (to - from) * t / self.length;
        line + self.sines.iter().map(|s| s.amplitude * (s.phase + s.rate * t).sin()).sum::<f64>()
    }
}

pub(crate) fn history(list: &[Own]) -> Pulses {
    let mut from = 0.0;
    let sections = list.iter().map(|own| {
        let section = Section {
            length: own.length,
            acceleration: own.acceleration,
            sines: &own.sines,
            ..Section::shock(from, 0.0, own.delta_v)
        };
        from += own.length;
        section
    });
    Pulses::of_sections(sections).expect("sections")
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Line {
    Off,
    First,
    Back { deepest: f64 },
}

/// The part in small steps.
struct Steps {
    omega: f64,
    zeta: f64,
    gap: f64,
    k1: f64,
    e: f64,
    line: Line,
    side: f64,
    dent: f64,
    z: f64,
    v: f64,
    hits: Vec<Hit>,
    /// Largest and smallest z, v, A.
    range: [[f64; 2]; 3],
}

impl Steps {
    fn new(part: &Suspension) -> Self {
        let stop = part.stop().expect("a stop");
        let (e, tau) = (stop.restitution().max(0.01), stop.contact_time());
        let omega1 = 0.5 * std::f64::consts::PI * (1.0 + e) / tau;
        Self {
            omega: part.omega(),
            zeta: part.damping().get(),
            gap: stop.gap(),
            k1: omega1 * omega1,
            e,
            line: Line::Off,
            side: 1.0,
            dent: 0.0,
            z: 0.0,
            v: 0.0,
            hits: Vec::new(),
            range: [[0.0; 2]; 3],
        }
    }
    fn depth(&self, z: f64) -> f64 {
        self.side * z - self.gap - self.dent
    }
    /// Returns the force of the stop toward rest, and its stiffness.
    fn force(&self, z: f64) -> (f64, f64) {
        let d = self.depth(z);
        match self.line {
            Line::Off => (0.0, 0.0),
            Line::First => (self.side * self.k1 * d, self.k1),
            Line::Back { deepest } => {
                let k2 = self.k1 / (self.e * self.e);
                (self.side * k2 * (d - deepest * (1.0 - self.e * self.e)), k2)
            }
        }
    }
    fn felt(&self, z: f64, v: f64) -> f64 {
        -(2.0 * self.zeta * self.omega * v + self.omega * self.omega * z + self.force(z).0)
    }
    fn step(&self, base: &dyn Fn(f64) -> f64, t: f64, h: f64) -> (f64, f64) {
        let slope = |t: f64, z: f64, v: f64| (v, self.felt(z, v) - base(t));
        let (z, v) = (self.z, self.v);
        let (a, b) = slope(t, z, v);
        let (c, d) = slope(t + 0.5 * h, z + 0.5 * h * a, v + 0.5 * h * b);
        let (e, f) = slope(t + 0.5 * h, z + 0.5 * h * c, v + 0.5 * h * d);
        let (g, k) = slope(t + h, z + h * e, v + h * f);
        (z + h / 6.0 * (a + 2.0 * (c + e) + g), v + h / 6.0 * (b + 2.0 * (d + f) + k))
    }
    /// Returns whether the law no longer holds at a state.
    fn is_over(&self, z: f64, v: f64) -> bool {
        let d = self.depth(z);
        match self.line {
            Line::Off if self.dent > 0.0 => d > 0.0 || self.side * z < self.gap,
            Line::Off => z.abs() > self.gap,
            Line::First => self.side * v < 0.0,
            Line::Back { deepest } => d > deepest || d < deepest * (1.0 - self.e * self.e),
        }
    }
    /// Goes over to the next law.
    fn turn(&mut self, time: f64) {
        let d = self.depth(self.z);
        self.line = match self.line {
            Line::Off if self.dent > 0.0 && self.side * self.z < 0.5 * (2.0 * self.gap + self.dent) => {
                self.dent = 0.0;
                Line::Off
            }
            Line::Off => {
                if self.dent == 0.0 {
                    self.side = self.z.signum();
                }
                self.hits.push(Hit { time, speed: self.v.abs(), side: if self.side > 0.0 { 1 } else { -1 } });
                Line::First
            }
            Line::First => Line::Back { deepest: d.max(0.0) },
            Line::Back { deepest } if d > 0.5 * deepest * (2.0 - self.e * self.e) => Line::First,
            Line::Back { deepest } => {
                self.dent += deepest * (1.0 - self.e * self.e);
                Line::Off
            }
        };
    }
    /// Notes the largest values of the cubics of values and slopes over one step.
    fn note(&mut self, base: &dyn Fn(f64) -> f64, [t, h]: [f64; 2], (z, v): (f64, f64)) {
        let of = |t: f64, z: f64, v: f64| {
            let felt = self.felt(z, v);
            let a = felt - base(t);
            let jerk = -(2.0 * self.zeta * self.omega * a + (self.omega * self.omega + self.force(z).1) * v);
            ([z, v, felt], [v, a, jerk])
        };
        let ((from, out), (to, into)) = (of(t, self.z, self.v), of(t + h, z, v));
        for k in 0..3 {
            let (a, b, m, n) = (from[k], to[k], h * out[k], h * into[k]);
            let (third, second) = (m + n - 2.0 * (b - a), 3.0 * (b - a) - 2.0 * m - n);
            let mut values = vec![a, b];
            if m * n < 0.0 {
                let mut s = m / (m - n);
                for _ in 0..4 {
                    s -= (m + s * (2.0 * second + 3.0 * s * third)) / (2.0 * second + 6.0 * s * third);
                }
                let s = s.clamp(0.0, 1.0);
                values.push(a + s * (m + s * (second + s * third)));
            }
            for value in values {
                self.range[k] = [self.range[k][0].min(value), self.range[k][1].max(value)];
            }
        }
    }
    fn run(&mut self, list: &[Own]) {
        let mut start = 0.0;
        for own in list {
            self.v -= own.delta_v;
            if self.line == Line::First && self.side * self.v < 0.0 {
                self.turn(start);
            }
            let felt = self.felt(self.z, self.v);
            for (k, value) in [self.z, self.v, felt].into_iter().enumerate() {
                self.range[k] = [self.range[k][0].min(value), self.range[k][1].max(value)];
            }
            let base = |t: f64| own.at(t);
            let rate = own.sines.iter().map(|s| s.rate).fold(0.0, f64::max);
            let mut t = 0.0;
            while t < own.length {
                let omega = (self.omega * self.omega + self.force(self.z).1).sqrt();
                // Steps in rad of the fastest, and of the decay beyond critical damping.
                let h = (STEP / (omega.max(rate) * (1.0 + self.zeta))).min(own.length - t);
                let (z, v) = self.step(&base, t, h);
                if !self.is_over(z, v) || self.is_over(self.z, self.v) && self.closer(z, v) {
                    self.note(&base, [t, h], (z, v));
                    (self.z, self.v) = (z, v);
                    t = if h < own.length - t { t + h } else { own.length };
                    continue;
                }
                // Bisection of the length of the step.
                let (mut low, mut high) = (0.0, h);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    let (z, v) = self.step(&base, t, middle);
                    if self.is_over(z, v) { high = middle } else { low = middle }
                }
                let (z, v) = self.step(&base, t, high);
                self.note(&base, [t, high], (z, v));
                (self.z, self.v) = (z, v);
                t += high;
                self.turn(start + t);
            }
            start += own.length;
        }
    }
    /// Returns whether a state is on the way back to where the law holds: after a change it may be a rounding outside.
    fn closer(&self, z: f64, v: f64) -> bool {
        let excess = |z: f64, v: f64| match self.line {
            Line::Off => {
                (self.depth(z)).max(if self.dent > 0.0 { self.gap - self.side * z } else { -self.side * z - self.gap })
            }
            Line::First => -self.side * v,
            Line::Back { deepest } => (self.depth(z) - deepest).max(deepest * (1.0 - self.e * self.e) - self.depth(z)),
        };
        excess(z, v) < excess(self.z, self.v)
    }
}

pub(crate) fn any_section() -> impl Strategy<Value = Own> {
    let sine = (-1.0..1.0_f64, -0.5..1.5_f64, -4.0..4.0_f64).prop_map(|(amplitude, decade, phase)| Sine {
        amplitude: 2.0 * amplitude,
        rate: 10f64.powf(decade),
        phase,
    });
    let length = prop_oneof![Just(0.0), 1e-2..1.0_f64, 1.0..5.0_f64];
    (
        length,
        prop_oneof![Just(0.0), -1.0..1.0_f64],
        prop_oneof![Just([0.0; 2]), [-1.0..1.0_f64, -1.0..1.0_f64]],
        prop::collection::vec(sine, 0..3),
    )
        .prop_map(|(length, delta_v, acceleration, sines)| Own { length, delta_v, acceleration, sines })
}

/// Parts of any damping, with stops from softer than their spring to 60 times as stiff as it is slow.
pub(crate) fn any_part() -> impl Strategy<Value = Suspension> {
    (
        -0.7..0.8_f64,
        prop_oneof![Just(0.0), 0.0..0.2_f64, 0.2..2.0_f64],
        -2.0..-0.1_f64,
        -1.7..1.0_f64,
        prop_oneof![Just(0.0), Just(1.0), 0.05..1.0_f64],
    )
        .prop_map(|(omega, zeta, gap, contact, e)| {
            let part = Suspension::new(10f64.powf(omega), DampingRatio::new(zeta).expect("damping")).expect("a part");
            part.with_stop(Stop::new(10f64.powf(gap), 10f64.powf(contact), e).expect("a stop"))
        })
}

/// Touches slower than this, of the fastest, are left out: whether a part grazes its stop hangs on the last digits.
const WEAK: f64 = 1e-3;
/// Length of a step in rad.
const STEP: f64 = 0.0025;
/// The most touches that are compared: each may multiply an error, so that thirty of them leave no digit.
const MOST: usize = 12;
/// Allowed error of the largest. Four times as long steps err by 3e-10 in nine of ten cases; a dozen touches then make it up
/// to 1e-6, in velocities on stiff stops, which change fast.
const CLOSE: f64 = 1e-6;

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, max_global_rejects: 4000, ..ProptestConfig::default() })]

    /// Peaks of z, z′ and A, every touch, and the state at the end.
    #[test]
    fn the_motion_is_that_of_small_steps(list in prop::collection::vec(any_section(), 1..6), part in any_part()) {
        let pulses = history(&list);
        let end: f64 = list.iter().map(|own| own.length).sum();
        prop_assume!(end > 0.0);
        let mut steps = Steps::new(&part);
        steps.run(&list);
        let hits: Vec<Hit> = pulses.hits(&part).expect("few hits").into_iter().filter(|hit| hit.time < end).collect();
        let speed = steps.range[1][1].max(-steps.range[1][0]);
        prop_assume!(hits.iter().chain(&steps.hits).all(|hit| hit.speed > WEAK * speed && hit.time < end - 1e-3));
        prop_assume!(steps.hits.len() <= MOST);
        prop_assert_eq!(hits.len(), steps.hits.len(), "{:?} {:?}", hits, steps.hits);
        for (ours, theirs) in hits.iter().zip(&steps.hits) {
            prop_assert!(ours.side == theirs.side && (ours.speed - theirs.speed).abs() <= CLOSE * speed, "{ours:?} {theirs:?}");
            prop_assert!((ours.time - theirs.time).abs() <= 1e-5, "{ours:?} {theirs:?}");
        }
        let got = pulses.respond_within(&part);
        for (k, got) in [got.relative_displacement, got.relative_velocity, got.absolute_acceleration].into_iter().enumerate() {
            let [low, high] = steps.range[k];
            let allowed = CLOSE * high.max(-low);
            prop_assert!((got.positive.value - high).abs() <= allowed, "{k}: {:?}, not {high}", got.positive);
            prop_assert!((got.negative.value - low).abs() <= allowed, "{k}: {:?}, not {low}", got.negative);
        }
        let state = pulses.state_at_end(&part);
        let size = steps.range[0][1].max(-steps.range[0][0]).max(speed / part.omega());
        prop_assert!((state.displacement - steps.z).abs() <= CLOSE * size, "{state:?}, not {}", steps.z);
        prop_assert!((state.velocity - steps.v).abs() <= CLOSE * speed, "{state:?}, not {}", steps.v);
        let hardest = pulses.peak_within(&part, Peaked::StopSpeed, 0.0);
        let most = hits.iter().map(|hit| hit.speed).fold(0.0, f64::max);
        prop_assert_eq!(hardest.map(|peak| peak.value), Some(most).filter(|&most| most > 0.0));
    }
}
