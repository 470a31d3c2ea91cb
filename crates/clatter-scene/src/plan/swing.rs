//! Free motion of the component, for estimates: x = ωz, w = z′, over the phase θ = ωt.
//!
//! `x″ + 2ζ x′ + x = 0`; a quantity is Q = r₀ x + r₁ w, with r = (1, 0) for the relative displacement ωz and (1, 2ζ)
//! for the absolute acceleration over ω, sign aside. Next to ζ = 1 the damping is shifted by 5·10⁻⁷, far below what an
//! estimate is good for.

use super::floats::{greater, lesser};
use super::quick::{angle, decay, ln, sin_cos};

/// The component and the quantity asked of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Swing {
    zeta: f64,
    /// √|1 − ζ²|, and its reciprocal.
    beta: f64,
    over_beta: f64,
    swings: bool,
    row: [f64; 2],
    /// Peak of |Q| after a unit of w.
    pub(super) factor: f64,
    /// Where it stands, and how fast |Q| falls as it begins.
    turns: f64,
    falls: f64,
    /// All that Q goes up and down after a unit of w, over twice its peak, at most: of an oscillation
    /// `1/(1 − e^(−πζ/β))`. Where Q is the acceleration and falls from the start, what follows adds a little, 1/40 at ζ
    /// = 1.
    pub(super) pile: f64,
}

/// Motion relative to the base.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Motion {
    pub(super) x: f64,
    pub(super) w: f64,
}

/// What a phase does to a motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    c: f64,
    s: f64,
    /// What is left of the slowest mode.
    pub(super) fade: f64,
}

impl Turn {
    /// All has died down.
    pub(super) const NONE: Self = Self { c: 0.0, s: 0.0, fade: 0.0 };
}

/// A largest value, and the phase at which it stands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Peak {
    pub(super) value: f64,
    pub(super) phase: f64,
    /// Rate of the value by the phase, where it falls from the start.
    pub(super) slope: f64,
}

impl Swing {
    /// The bar itself: what a shock does to it is the shock.
    pub(super) const BAR: Self = Self {
        zeta: 0.0,
        beta: 1.0,
        over_beta: 1.0,
        swings: true,
        row: [1.0, 0.0],
        factor: 1.0,
        turns: 0.0,
        falls: 0.0,
        pile: f64::INFINITY,
    };

    pub(super) fn new(zeta: f64, acceleration: bool) -> Self {
        let gap = 1.0 - zeta * zeta;
        let gap = if gap.abs() < 1e-6 { 1e-6 } else { gap };
        let row = if acceleration { [1.0, 2.0 * zeta] } else { [1.0, 0.0] };
        let beta = gap.abs().sqrt();
        let half_turn = if gap > 0.0 { decay(std::f64::consts::PI * zeta / beta) } else { 0.0 };
        let pile = 1.1 / (1.0 - half_turn);
        let unit = Motion { x: 0.0, w: 1.0 };
        let swing = Self {
            zeta,
            beta,
            over_beta: 1.0 / beta,
            swings: gap > 0.0,
            row,
            factor: 0.0,
            turns: 0.0,
            falls: 0.0,
            pile,
        };
        let falls = lesser(swing.quantity(swing.rate(unit)), 0.0);
        let peak = swing.peak(unit, f64::INFINITY);
        Self { factor: peak.value, turns: peak.phase, falls, ..swing }
    }
    pub(super) fn zeta(&self) -> f64 {
        self.zeta
    }
    /// Q.
    pub(super) fn quantity(&self, m: Motion) -> f64 {
        self.row[0] * m.x + self.row[1] * m.w
    }
    /// Derivative by the phase.
    pub(super) fn rate(&self, m: Motion) -> Motion {
        Motion { x: m.w, w: -m.x - 2.0 * self.zeta * m.w }
    }
    /// How fast the slowest mode fades.
    pub(super) fn decay(&self) -> f64 {
        if self.swings { self.zeta } else { 1.0 / (self.zeta + self.beta) }
    }
    /// How fast its fastest mode moves.
    pub(super) fn fastest(&self) -> f64 {
        if self.swings { 1.0 } else { self.zeta + self.beta }
    }
    /// What a phase leaves of the slowest mode.
    pub(super) fn fade(&self, theta: f64) -> f64 {
        decay(self.decay() * theta)
    }
    /// What a phase does.
    #[expect(clippy::inline_always, reason = "in memory, what is returned is waited for")]
    #[inline(always)]
    pub(super) fn turn(&self, theta: f64) -> Turn {
        let (z, b) = (self.zeta, self.beta);
        if self.swings {
            let fade = self.fade(theta);
            let (s, c) = sin_cos(b * theta);
            Turn { c: fade * c, s: fade * s * self.over_beta, fade }
        } else {
            let (fade, fast) = (self.fade(theta), decay((z + b) * theta));
            Turn { c: 0.5 * (fade + fast), s: 0.5 * (fade - fast) * self.over_beta, fade }
        }
    }
    pub(super) fn after(&self, turn: &Turn, m: Motion) -> Motion {
        let z = self.zeta;
        Motion { x: m.x * turn.c + (m.w + z * m.x) * turn.s, w: m.w * turn.c - (m.x + z * m.w) * turn.s }
    }
    /// Largest |Q| of the free motion from m before the phase `until`: its start or its first turning point.
    #[expect(clippy::inline_always, reason = "in memory, what is returned is waited for")]
    #[inline(always)]
    pub(super) fn peak(&self, m: Motion, until: f64) -> Peak {
        let (now, rate) = (self.quantity(m), self.rate(m));
        let (slope, bend) = (self.quantity(rate), self.quantity(self.rate(rate)));
        let start = Peak { value: now.abs(), phase: 0.0, slope: lesser(slope * now.signum(), 0.0) };
        let turn = if self.swings {
            let sine = (bend + self.zeta * slope) * self.over_beta;
            let phase = angle(slope.abs(), if slope < 0.0 { sine } else { -sine }) * self.over_beta;
            (phase > 0.0 && phase < until).then(|| Peak {
                value: self.amplitude(m) * decay(self.zeta * phase),
                phase,
                slope: 0.0,
            })
        } else {
            // slope = C e^(−(ζ−β)θ) + D e^(−(ζ+β)θ)
            let slow = 0.5 * self.over_beta * (bend + (self.zeta + self.beta) * slope);
            let ratio = 1.0 - slope / slow;
            let phase = if ratio > 1.0 { 0.5 * self.over_beta * ln(ratio) } else { f64::INFINITY };
            (phase < until).then(|| Peak {
                value: self.quantity(self.after(&self.turn(phase), m)).abs(),
                phase,
                slope: 0.0,
            })
        };
        turn.filter(|t| t.value > start.value).unwrap_or(start)
    }
    /// The same of what was at rest before a shock w.
    #[inline]
    pub(super) fn peak_of_shock(&self, w: f64, until: f64) -> Peak {
        let size = w.abs();
        if self.turns > 0.0 && self.turns < until {
            Peak { value: self.factor * size, phase: self.turns, slope: 0.0 }
        } else {
            Peak { value: self.row[1] * size, phase: 0.0, slope: self.falls * size }
        }
    }
    /// The same of a motion whose Q has the rate `last` then.
    #[inline]
    pub(super) fn peak_before(&self, m: Motion, until: f64, last: f64) -> Peak {
        let slope = self.quantity(self.rate(m));
        // Turning points are half a turn apart.
        if self.swings && self.beta * until < std::f64::consts::PI && slope * last > 0.0 {
            let now = self.quantity(m);
            Peak { value: now.abs(), phase: 0.0, slope: lesser(slope * now.signum(), 0.0) }
        } else {
            self.peak(m, until)
        }
    }
    /// √(w² + 2ζxw + x²): Q at its turning points is at most this, for ζ < 1.
    fn amplitude(&self, m: Motion) -> f64 {
        greater(m.w * m.w + 2.0 * self.zeta * m.x * m.w + m.x * m.x, 0.0).sqrt()
    }
    /// Bound on |Q| from here on over what fades meanwhile.
    pub(super) fn envelope(&self, m: Motion) -> f64 {
        if self.swings {
            // Q is largest on the ellipse of one amplitude by this.
            return self.amplitude(m) * self.over_beta;
        }
        let (x, w, over) = (m.x.abs(), m.w.abs(), 0.5 * self.over_beta);
        self.row[0] * (x + over * (w + self.zeta * x)) + self.row[1] * (w + over * (x + self.zeta * w))
    }
    /// The envelope of a shock over its peak.
    pub(super) fn over_factor(&self) -> f64 {
        self.envelope(Motion { x: 0.0, w: 1.0 }) / self.factor
    }
    /// The square of `bound`.
    #[inline]
    pub(super) fn square(&self, m: Motion) -> f64 {
        let now = self.quantity(m);
        if self.swings {
            greater(now * now, m.w * m.w + 2.0 * self.zeta * m.x * m.w + m.x * m.x)
        } else {
            let bound = self.bound(m);
            bound * bound
        }
    }
    /// Bound on |Q| from here on.
    pub(super) fn bound(&self, m: Motion) -> f64 {
        if self.swings {
            greater(self.quantity(m).abs(), self.amplitude(m))
        } else {
            m.x.abs() + self.factor * m.w.abs()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_shock::{DampingRatio, State, Suspension, VelocityShock, VelocityShocks};

    /// What a shock makes go up and down in all, by small steps: the bound holds, and is near.
    #[test]
    fn a_pile_is_what_goes_up_and_down() {
        for zeta in [0.02, 0.1, 0.4, 0.55, 0.8, 0.97, 1.0, 1.2, 2.0, 20.0] {
            for acceleration in [false, true] {
                let swing = Swing::new(zeta, acceleration);
                let step = swing.turn(0.002);
                let mut now = Motion { x: 0.0, w: 1.0 };
                let mut all = swing.quantity(now).abs();
                for _ in 0..200_000 {
                    let next = swing.after(&step, now);
                    all += (swing.quantity(next) - swing.quantity(now)).abs();
                    now = next;
                }
                let share = all / (2.0 * swing.factor * swing.pile);
                assert!((0.85..=1.0).contains(&share), "zeta {zeta}, {acceleration}: {share}");
            }
        }
    }

    /// What was at rest has its peak where any motion has it.
    #[test]
    fn a_shock_has_the_peak_of_its_motion() {
        for zeta in [0.0, 0.05, 0.3, 0.5, 0.7, 1.0, 1.5, 20.0] {
            for acceleration in [false, true] {
                let swing = Swing::new(zeta, acceleration);
                for until in [0.01, 0.3, 1.0, 1.7, 50.0, f64::INFINITY] {
                    let [scaled, peak] =
                        [swing.peak_of_shock(2.5, until), swing.peak(Motion { x: 0.0, w: 2.5 }, until)];
                    let near = |a: f64, b: f64| (a - b).abs() <= 1e-8 * (1.0 + b.abs());
                    let same = near(scaled.value, peak.value) && near(scaled.slope, peak.slope);
                    assert!(same && near(scaled.phase, peak.phase), "zeta {zeta} until {until}: {scaled:?} {peak:?}");
                }
            }
        }
    }

    /// Against the exact motion of the other crate.
    #[test]
    fn motion_and_peaks_are_those_of_the_suspension() {
        for zeta in [0.0, 0.05, 0.4, 0.7, 0.999, 1.0, 1.3, 2.0, 20.0] {
            let damping = DampingRatio::new(zeta).expect("as the test has it");
            let unit = Suspension::new(1.0, damping).expect("as the test has it");
            let factors = damping.impulse_factors();
            for (acceleration, factor) in [(true, factors.acceleration), (false, factors.displacement)] {
                let swing = Swing::new(zeta, acceleration);
                assert!((swing.factor / factor - 1.0).abs() < 2e-6, "zeta {zeta}: {} {factor}", swing.factor);
            }
            let swing = Swing::new(zeta, false);
            for (x, w) in [(0.3, -1.0), (-2.0, 0.1), (0.0, 1.0), (1.0, 0.0)] {
                for theta in [0.01, 0.5, 3.0, 40.0] {
                    let m = swing.after(&swing.turn(theta), Motion { x, w });
                    let exact = unit.free(State { displacement: x, velocity: w }, theta);
                    assert!((m.x - exact.displacement).abs() < 1e-4, "zeta {zeta} theta {theta}: {m:?} {exact:?}");
                    assert!((m.w - exact.velocity).abs() < 1e-4, "zeta {zeta} theta {theta}: {m:?} {exact:?}");
                    assert!(swing.bound(Motion { x, w }) >= m.x.abs(), "zeta {zeta} theta {theta}");
                    for swing in [swing, Swing::new(zeta, true)] {
                        let left = swing.envelope(Motion { x, w }) * swing.fade(theta);
                        assert!(left * (1.0 + 1e-9) >= swing.quantity(m).abs(), "zeta {zeta} theta {theta}: {left}");
                    }
                }
            }
            // Two shocks: the peak of the second interval starts from a motion that is not at rest.
            let train = VelocityShocks::new(vec![
                VelocityShock { time: 0.0, delta_v: -1.0 },
                VelocityShock { time: 0.8, delta_v: 0.4 },
            ])
            .expect("as the test has it");
            let exact = train.respond(&unit).absolute_acceleration.magnitude();
            let swing = Swing::new(zeta, true);
            let first = Motion { x: 0.0, w: 1.0 };
            let mut second = swing.after(&swing.turn(0.8), first);
            let end = swing.quantity(second).abs();
            second.w -= 0.4;
            let peak = swing.peak(first, 0.8).value.max(end).max(swing.peak(second, f64::INFINITY).value);
            assert!((peak / exact - 1.0).abs() < 1e-5, "zeta {zeta}: {peak} {exact}");
        }
    }
}
