//! The clatter in closed form: constant time for a train of any length.
//!
//! Let a_n < 0 be the velocity of the end about to make strike n + 1, b_n the companion solution:
//!
//! ```text
//! a_{n+1} = T a_n − e a_{n−1},  T = q(1 + e),  a_0 = −α,  a_1 = −(αT + β)      (α = −v_a > 0, β = −v_b)
//! b_{n+1} = T b_n − e b_{n−1},                 b_0 = 0,   b_1 = 1
//! time of strike n+1 = h0 b_n/|a_n|,           N = first n ≥ 1 with a_n ≥ 0
//! ```
//!
//! With D = 4e − T² and S = √|D| the solution is one of three:
//!
//! * D > 0, a **wave**: |a_n| = e^{n/2} A sin(δ_n)/S with A = hypot(αT + 2β, αS), δ_n = ψ − nθ,
//!   θ = atan2(S, T), ψ = atan2(αS, −(αT + 2β)). It ends: N = ⌈ψ/θ⌉.
//! * D < 0, a **decay**: |a_n| = (σ λ₊ⁿ − τ λ₋ⁿ)/S with λ± = (T ± S)/2, σ = αλ₊ + β, τ = αλ₋ + β. Endless iff
//!   σ ≥ 0; else N = ⌈ln(τ/σ)/ln(λ₊/λ₋)⌉.
//! * D = 0, the **edge** between them, where c = T/(2√e) = 1: only (1, 1) among floats, more where q is a quotient.
//!
//! The terms that decide are formed in double-double, or in integers where even those digits cancel: D, S, αT + 2β and
//! σ τ = αβT + β² + α²e. Then f64 suffices, until a quotient lies within its error of an integer.

use crate::accuracy::{self, DURATION_LONG, FINAL, SHORT};
use crate::dd::{self, Dd, ldexp, power_of_two, two_prod, two_sum};
use crate::exact::{Dyadic, Recurrence, clamp};
use crate::symmetric::{Ratio, Symmetric};
use crate::{Count, PeakImpact, Start};
use libm::{exp, expm1, hypot, log, log1p, sin, sincos};
use std::cmp::Ordering;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, LN_2, PI};

mod four;
pub(crate) use four::{Fours, Sweep, Then};

/// Roundings (units of 2⁻⁵³, relative) that a quotient of two f64 angles or logarithms may be off: two library
/// functions of at most 2 each, their arguments of at most 4, a quotient, and a margin of 2.
const QUOTIENT: f64 = 24.0 * UNIT;
const UNIT: f64 = 0.5 * f64::EPSILON;
/// The share of an approach velocity that the error of an angle may cost, over the larger of it and the first: a
/// twentieth of the allowed error. The rest is for the steps that follow from there.
const ANGLE: f64 = 0.05 * accuracy::APPROACH.error;
/// 2⁶⁵, beyond which a count is a float.
const BEYOND_NUMBERS: f64 = power_of_two(65);
/// The least size of a term of a plain step, far above the subnormal floats.
pub(crate) const NORMAL: f64 = 1e-280;

/// The recurrence with its starting values, scaled by 2^m a step where T and e are so small that T² would underflow:
/// a_n stands for 2^{mn−u} a_n, b_n for 2^{m(n−1)} b_n. The unit 2^u of velocities differs from 1 where squares
/// of velocities would leave the range of floats.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drive {
    pub(crate) bar: Symmetric,
    pub(crate) start: Start,
    pub(crate) m: i32,
    unit: i32,
    t: f64,
    pub(crate) e: f64,
    pub(crate) alpha: f64,
    pub(crate) beta: f64,
    pub(crate) kind: Kind,
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    /// D > 0.
    Wave(Wave),
    /// D < 0.
    Decay(Decay),
    /// D = 0.
    Edge,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Wave {
    /// Bound on the relative error of D.
    d_error: f64,
    /// √D.
    pub(crate) s: f64,
    /// αT + 2β.
    x: f64,
    pub(crate) theta: f64,
    psi: f64,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Decay {
    /// √−D.
    pub(crate) s: f64,
    /// Larger and smaller root.
    pub(crate) plus: f64,
    /// αλ₊ + β, αλ₋ + β.
    pub(crate) sigma: f64,
    pub(crate) tau: f64,
}

/// Above this e, D is formed about the corner (1, 1).
const CORNER: f64 = 0.17;

/// The required precision of D = 4e − T².
#[derive(Debug, Clone, Copy)]
pub(crate) struct Digits {
    /// Relative error that is always good enough.
    all: f64,
    /// Error that is good enough when multiplied by the number of strikes of a half turn.
    strike: f64,
}

impl Digits {
    /// Digits for a count: more digits are a last resort, needed once in some hundred trains.
    pub(crate) const COUNT: Self = Self { all: power_of_two(-44), strike: power_of_two(-10) };
    /// Digits for the end of a train: a hundredth of the allowed error, of the angle from one strike to the next. The
    /// last strike stands at a random share of that angle.
    pub(crate) const ENDING: Self = Self { all: power_of_two(-44), strike: 0.01 * FINAL.error };
    /// Digits for peaks and strikes.
    pub(crate) const ALL: Self = Self { all: power_of_two(-50), strike: 0.0 };
    /// Digits for angles beyond f64.
    const ANGLES: Self = Self { all: power_of_two(-80), strike: 0.0 };

    /// Returns whether a relative error is small enough, where D is a difference of terms larger by the factor
    /// `cancels`.
    fn allow(self, error: f64, cancels: f64) -> bool {
        // N ≈ π/θ with θ² ≈ D/T².
        error <= self.all || error * error * cancels * 10.0 <= self.strike * self.strike
    }
}

/// The number of steps until a sign changes: below 2¹²⁰ for every bar and start that is let in.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Steps {
    Exactly(u128),
    Endless,
}

/// a_{N−1}, `a_N` and the time of strike N.
#[derive(Debug, Clone, Copy)]
struct Last {
    a: f64,
    next: f64,
    time: f64,
}

/// The end of a train.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ending {
    pub(crate) count: Count,
    /// Time of the last strike, or the limit.
    pub(crate) time: f64,
    pub(crate) velocity: Option<[f64; 2]>,
}

/// The impact with the largest |a_n|, and that value.
pub(crate) type Largest = (PeakImpact, f64);

/// The solution of the recurrence: that of the velocities, or that of their differences a_{n+1} − a_n, whose first sign
/// change is where |a_n| is largest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Series {
    Velocity,
    Difference,
}

#[expect(clippy::inline_always, reason = "a count in one piece, in registers, takes two thirds of the time")]
impl Drive {
    /// Creates the recurrence of a bar and a start, for T > 0 and e > 0.
    #[inline(always)]
    pub(crate) fn new(bar: &Symmetric, start: &Start, digits: Digits) -> Self {
        let [va, vb] = start.velocity();
        let e = bar.e;
        let small = bar.q.max(e.sqrt());
        let m = if small < 1e-60 { -exponent(small) } else { 0 };
        let (t, scaled_e) = if m == 0 { (bar.t, e) } else { (ldexp(bar.t, m), ldexp(e, 2 * m)) };
        let unit = if m == 0 && (1e-60..1e60).contains(&vb.abs().max(-va)) {
            0
        } else if vb == 0.0 {
            exponent(va)
        } else {
            exponent(va).max(exponent(vb) + m)
        };
        let (alpha, beta) = if unit == 0 && m == 0 { (-va, -vb) } else { (ldexp(-va, -unit), ldexp(-vb, m - unit)) };
        // The kind comes last: a struct that is written and copied at once makes the processor wait.
        let drive = Self { bar: *bar, start: *start, m, unit, t, e: scaled_e, alpha, beta, kind: Kind::Edge };
        let (d, d_error) = drive.discriminant(digits);
        let kind = if d.hi > 0.0 {
            let s = d.hi.sqrt();
            let x = if beta >= 0.0 { alpha * t + 2.0 * beta } else { drive.slope(drive.wide_t(), d.hi).hi };
            Kind::Wave(Wave { d_error, s, x, theta: angle(s, t), psi: angle(alpha * s, -x) })
        } else if d.hi < 0.0 {
            Kind::Decay(drive.decay(d, d_error))
        } else {
            Kind::Edge
        };
        Self { kind, ..drive }
    }

    /// Returns D = 4e − T² and a bound on its relative error; its sign is certain.
    #[inline(always)]
    fn discriminant(&self, digits: Digits) -> (Dd, f64) {
        let Symmetric { e, less, more, .. } = self.bar;
        // Of two equal forms the one with the smaller terms, (1 − q²)(1 + e)² − (1 − e)² for all but small e.
        let (first, second) = if e > CORNER {
            (less * more * ((1.0 + e) * (1.0 + e)), (1.0 - e) * (1.0 - e))
        } else {
            (4.0 * self.e, self.t * self.t)
        };
        let d = first - second;
        let cancels = first.max(second) / d.abs();
        let error = 8.0 * UNIT * cancels;
        if digits.allow(error, cancels) && error < 0.5 {
            return (Dd::from(d), error);
        }
        if digits.all >= Digits::ALL.all {
            let q = self.bar.wide_q();
            let d = compensated(if self.m == 0 { q } else { q.scale(self.m) }, self.bar.e, self.e);
            let cancels = (4.0 * self.e / d).abs() + 1.0;
            let error = 4.0 * UNIT + power_of_two(-99) * cancels;
            if digits.allow(error, cancels) && error < 0.5 {
                return (Dd::from(d), error);
            }
        }
        self.wide_discriminant(digits)
    }

    /// Returns the same as [`discriminant`](Self::discriminant), with more digits.
    #[cold]
    fn wide_discriminant(&self, digits: Digits) -> (Dd, f64) {
        let (e, q) = (self.bar.e, self.bar.wide_q());
        let good = |d: Dd, cancels: f64, forgotten: f64| {
            let error = power_of_two(-100) + forgotten * cancels;
            (digits.allow(error, cancels) && error < 0.5).then_some((d, error))
        };
        let known = if q.lo == 0.0 {
            let d = expanded(q.scale(self.m).hi, e, self.e);
            good(d, (4.0 * self.e / d.hi).abs() + 1.0, power_of_two(-155))
        } else {
            let (first, second) = if e > CORNER {
                (self.bar.wide_less_more() * two_sum(1.0, e).sqr(), two_sum(1.0, -e).sqr())
            } else {
                (Dd::from(4.0 * self.e), self.wide_t().sqr())
            };
            let d = first - second;
            good(d, first.hi.max(second.hi) / d.hi.abs(), power_of_two(-99))
        };
        if let Some(known) = known {
            return known;
        }
        let exact = self.exact(Series::Velocity);
        (self.bar.exact_q().over_square(&exact.discriminant(), 2 * self.m), power_of_two(-100))
    }

    /// Returns αT + 2β, to a relative 2⁻⁹⁰ of the amplitude at the very least.
    fn slope(&self, t: Dd, d: f64) -> Dd {
        let at = t * self.alpha;
        let x = at + self.wide_beta() * 2.0;
        let size = x.hi.abs().max(self.alpha * d.abs().sqrt());
        if size > at.hi * power_of_two(-10) {
            return x;
        }
        let exact = self.exact(Series::Velocity);
        let x = Dyadic::from(-2.0).mul(&exact.w).sub(&exact.p.mul(&exact.v));
        self.bar.exact_q().over_nu(&x, self.m - self.unit)
    }

    /// Returns σ τ = αβT + β² + α²e, to a relative 2⁻⁵² at the very least, its sign for certain.
    fn product(&self) -> f64 {
        let (alpha, beta) = (self.alpha, self.wide_beta());
        let terms = [beta * alpha * self.wide_t(), beta.sqr(), two_prod(alpha, alpha) * self.e];
        let sum = terms[0] + terms[1] + terms[2];
        // Below 1e−250 the low parts would be subnormal.
        if sum.hi.abs() > terms.iter().fold(1e-250, |most: f64, t| most.max(t.hi.abs())) * power_of_two(-40) {
            return sum.hi;
        }
        self.bar.exact_q().over_square(&self.exact(Series::Velocity).form(), 2 * (self.m - self.unit)).hi
    }

    fn decay(&self, d: Dd, d_error: f64) -> Decay {
        let (alpha, beta) = (self.alpha, self.beta);
        if beta >= 0.0 {
            // All terms of these sums are positive or 0.
            let (s, product) = ((-d.hi).sqrt(), alpha * beta * self.t + beta * beta + alpha * alpha * self.e);
            let sigma = 0.5 * (alpha * (self.t + s)) + beta;
            return Decay { s, plus: 0.5 * (self.t + s), sigma, tau: product / sigma };
        }
        let d = if Digits::ANGLES.allow(d_error, 1.0) { d } else { self.discriminant(Digits::ANGLES).0 };
        let (s, t) = ((-d).sqrt(), self.wide_t());
        let plus = 0.5 * (t + s).hi;
        let s = s.hi;
        // σ and τ are (αT + 2β ± αS)/2: the larger by adding, the other from their product.
        let (x, y, product) = (self.slope(t, d.hi).hi, alpha * s, self.product());
        let (sigma, tau) = if x >= 0.0 {
            let sigma = 0.5 * (x + y);
            (sigma, product / sigma)
        } else {
            let tau = 0.5 * (x - y);
            (product / tau, tau)
        };
        Decay { s, plus, sigma, tau }
    }

    /// Returns ln(λ₊/λ₋) of a decay, and ln λ₊ of the true λ₊.
    fn rates(&self, &Decay { s, plus, .. }: &Decay) -> [f64; 2] {
        let shift = f64::from(self.m) * LN_2;
        let rate = if s < 0.5 * plus { -log1p(-s / plus) } else { 2.0 * (log(plus) - shift) - self.ln_e() };
        let ln_plus = if plus > 0.5 && self.m == 0 {
            let (u, w) = self.corner();
            log1p(-2.0 * w / (u + w + s)) // 1 − λ₊ = (1 − q)(1 + e)/(1 − λ₋)
        } else {
            log(plus) - shift
        };
        [rate, ln_plus]
    }

    /// Returns T to about 2⁻¹⁰⁰.
    fn wide_t(&self) -> Dd {
        let q = self.bar.wide_q();
        (if self.m == 0 { q } else { q.scale(self.m) }) * two_sum(1.0, self.bar.e)
    }

    /// Returns β to about 2⁻¹⁰⁰.
    fn wide_beta(&self) -> Dd {
        let beta = -self.start.wide_b();
        if self.unit == 0 && self.m == 0 { beta } else { beta.scale(self.m - self.unit) }
    }

    /// Returns ln e of the true e.
    fn ln_e(&self) -> f64 {
        let e = self.bar.e;
        if e > 0.5 { log1p(e - 1.0) } else { log(e) }
    }

    /// Returns hypot(αT + 2β, αS) of a wave.
    fn amplitude(&self, wave: &Wave) -> f64 {
        let (x, y) = (wave.x, self.alpha * wave.s);
        // Squares leave the range only where a scale has been brought in.
        if self.m == 0 { (x * x + y * y).sqrt() } else { hypot(x, y) }
    }

    /// Returns 1 − e and (1 − q)(1 + e), without cancellation: u + w = 2 − T, u − w = T − 2e, w = 1 − T + e.
    fn corner(&self) -> (f64, f64) {
        (1.0 - self.bar.e, self.bar.less * (1.0 + self.bar.e))
    }

    /// Returns the number of impacts.
    #[inline(always)]
    pub(crate) fn count(&self) -> Count {
        if let Kind::Wave(Wave { theta, psi, .. }) = self.kind
            && psi / theta > BEYOND_NUMBERS
        {
            // The nearest float is enough: the last impact need not be known by integers.
            let (theta, psi, _) = self.angles(false);
            return Count::Huge((psi / theta).hi);
        }
        match self.steps() {
            Steps::Exactly(n) => u64::try_from(n).map_or(Count::Huge(to_f64(n)), Count::Finite),
            Steps::Endless => Count::Endless,
        }
    }

    /// Returns count, time and final velocities.
    pub(crate) fn ending(&self) -> Ending {
        match self.steps() {
            Steps::Exactly(n) => {
                // Half of what is allowed.
                let allowed = if n <= u128::from(SHORT) { FINAL.error } else { DURATION_LONG.error };
                let Last { a, next, time } = self.last(n, 0.5 * allowed);
                let count = u64::try_from(n).map_or(Count::Huge(to_f64(n)), Count::Finite);
                // At one instant no time passes, also where velocities fade below the floats.
                let time = if self.start.height_gap() == 0.0 { 0.0 } else { time };
                Ending { count, time, velocity: Some(rebound(&self.bar, n % 2 == 1, a, next)) }
            }
            Steps::Endless => {
                let (count, velocity) = (Count::Endless, rest(&self.bar, &self.start));
                Ending { count, time: self.limit(), velocity }
            }
        }
    }

    #[inline(always)]
    fn steps(&self) -> Steps {
        match self.kind {
            Kind::Wave(wave) => {
                let quotient = wave.psi / wave.theta;
                self.settle(Series::Velocity, quotient, (QUOTIENT + wave.d_error) * quotient)
            }
            Kind::Decay(Decay { sigma, .. }) if sigma >= 0.0 => Steps::Endless,
            Kind::Decay(decay) => {
                let quotient = self.span(&decay) / self.rates(&decay)[0];
                // A logarithm beyond ln 2 is off by roundings of its argument, which are no more than twice its own.
                self.settle(Series::Velocity, quotient, 3.0 * QUOTIENT * quotient)
            }
            Kind::Edge => {
                let exact = self.exact(Series::Velocity);
                if exact.endless() {
                    return Steps::Endless;
                }
                let x = self.slope(self.wide_t(), 0.0).hi;
                let quotient = self.alpha * self.t / -x;
                self.settle(Series::Velocity, quotient, QUOTIENT * quotient)
            }
        }
    }

    /// Returns ln(τ/σ), with τ − σ = −αS, for σ < 0.
    fn span(&self, &Decay { s, sigma, tau, .. }: &Decay) -> f64 {
        let gap = self.alpha * s / -sigma;
        if gap < 1.0 { log1p(gap) } else { log(tau / sigma) }
    }

    /// Returns ⌈quotient⌉, at least 1, where the quotient is off by no more than `error`: with more digits if need be.
    #[inline(always)]
    fn settle(&self, series: Series, quotient: f64, error: f64) -> Steps {
        // Integers take fewer instructions than `round` and `ceil`.
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_precision_loss,
            reason = "no digit is lost where the quotient may decide: its error is above 1 from 2⁵⁰ on"
        )]
        let (below, rest) = (quotient as i64, quotient - (quotient as i64) as f64);
        if rest > error && 1.0 - rest > error {
            return Steps::Exactly(u128::from(below.unsigned_abs()) + 1);
        }
        self.settle_exactly(series, quotient, error)
    }

    /// Returns the same as [`settle`](Self::settle), with more digits.
    #[cold]
    fn settle_exactly(&self, series: Series, quotient: f64, error: f64) -> Steps {
        let (mut middle, mut error) = (Dd::from(quotient), error);
        if let (Kind::Wave(_), Series::Velocity) = (self.kind, series) {
            // A count of some thousand strikes needs no more digits.
            let (theta, psi, angle_error) = self.angles(quotient < 4096.0);
            middle = psi / theta;
            // αT + 2β as `slope` guarantees. A larger bound would let the search below leave the half turn.
            error = quotient * (angle_error + power_of_two(-86));
        }
        let whole = Dd::from(middle.hi.round());
        let whole = whole + Dd::from((middle - whole).hi.round());
        let rest = (middle - whole).hi;
        if rest.abs() > error {
            let n = integer(whole);
            return Steps::Exactly(if rest > 0.0 { n + 1 } else { n }.max(1));
        }
        // Integers: the first n in the bracket with a sign that is not negative.
        let exact = self.exact(series);
        let (mut low, mut high) = (integer(whole), integer(whole));
        let mut width = ceil_to_int(error);
        while low > 0 && exact.sign(low) != Ordering::Less {
            low = low.saturating_sub(width);
            width = width.saturating_mul(2);
        }
        while high <= low || exact.sign(high) == Ordering::Less {
            high = high.saturating_add(width);
            width = width.saturating_mul(2);
        }
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if exact.sign(middle) == Ordering::Less { low = middle } else { high = middle }
        }
        Steps::Exactly(high)
    }

    /// Returns θ and ψ of a wave in double-double, and a bound on the relative error that both share: 2⁻⁸¹ where that
    /// is `enough`, else 2⁻⁹⁵, plus that of D.
    fn angles(&self, enough: bool) -> (Dd, Dd, f64) {
        let (d, d_error) = self.discriminant(Digits::ANGLES);
        let (s, t) = (d.sqrt(), self.wide_t());
        let (theta, psi) = (dd::atan2(s, t, enough), dd::atan2(s * self.alpha, -self.slope(t, d.hi), enough));
        (theta, psi, d_error + power_of_two(if enough { -81 } else { -95 }))
    }

    /// Returns |δ_n| = |ψ − nθ| for each n, to a relative `error` or from double-double angles, and a bound on their
    /// error.
    fn remainders<const K: usize>(&self, wave: &Wave, n: [u128; K], error: f64) -> ([f64; K], f64) {
        let deltas = n.map(|n| (wave.psi - to_f64(n) * wave.theta).abs());
        let least = deltas.iter().fold(f64::INFINITY, |least, delta| delta.min(least));
        let bound = (8.0 * UNIT + wave.d_error) * wave.psi;
        if bound < error * least {
            return (deltas, bound);
        }
        let (theta, psi, angle_error) = self.angles(power_of_two(-78) * wave.psi < error * least);
        (n.map(|n| (psi - theta * wide(n)).abs().hi), 2.0 * angle_error * wave.psi)
    }

    /// Returns the approach velocity and time of strike n.
    pub(crate) fn strike(&self, n: u64) -> (f64, f64) {
        let n = u128::from(n);
        if let Kind::Decay(decay) = self.kind
            && decay.sigma >= 0.0
        {
            let (Decay { s, plus, sigma, .. }, [rate, ln_plus]) = (decay, self.rates(&decay));
            let count = to_f64(n - 1);
            let (p, g) = (exp(-count * rate), -expm1(-count * rate) * (plus / s));
            let sum = self.alpha * plus * p + sigma * g;
            let time = ldexp(self.start.height_gap() * (g / sum), self.m - self.unit);
            return (-self.power(count * ln_plus, sum / plus), time);
        }
        // The error of an f64 angle, spread by the amplitude, relative to |v_a|.
        let spread = match self.kind {
            Kind::Wave(wave) => {
                let amplitude = self.decayed(n, self.amplitude(&wave) / wave.s);
                (8.0 * UNIT + wave.d_error) * wave.psi * amplitude / -self.start.velocity()[0]
            }
            _ => 0.0,
        };
        let near = spread < ANGLE;
        let Last { a, time, .. } = self.last(n, if near { 1e-11 } else { 1e-13 });
        (a, time)
    }

    /// Returns a_{n−1}, a_n and the time of strike n, of a wave from angles to a relative `error`.
    fn last(&self, n: u128, error: f64) -> Last {
        if n == 1 {
            return Last { a: self.start.velocity()[0], next: self.first(), time: 0.0 };
        }
        let h0 = self.start.height_gap();
        match self.kind {
            Kind::Wave(wave) => {
                let ([delta, beyond], bound) = self.remainders(&wave, [n - 1, n], error);
                // Next to a tie, integers: a tenth of what is allowed of times.
                if bound <= error.max(0.1 * accuracy::TIME.error) * delta.min(beyond) {
                    let height = self.amplitude(&wave);
                    let amplitude = height / wave.s;
                    let (rise, run) = sincos(delta);
                    let root = self.bar.e.sqrt();
                    let [a, next] = self.powers(
                        0.5 * to_f64(n - 1) * self.ln_e(),
                        [-amplitude * rise, amplitude * (root * sin(beyond))],
                    );
                    let sum = self.alpha * wave.s * (run / rise) + wave.x;
                    let time = ldexp(h0 / height * (2.0 * sum / height), self.m - self.unit);
                    return Last { a, next, time };
                }
            }
            Kind::Decay(decay) => {
                let (Decay { s, sigma, .. }, [rate, ln_plus]) = (decay, self.rates(&decay));
                let count = to_f64(n - 1);
                let span = self.span(&decay);
                let delta = span - count * rate;
                if 8.0 * UNIT * (span + 1.0) < 1e-10 * delta.min(rate - delta) {
                    let over = expm1(delta);
                    let a = self.power(count * ln_plus, sigma / s * over);
                    let next = self.power((count + 1.0) * ln_plus, sigma / s * expm1(delta - rate));
                    let time = ldexp(h0 * (expm1(-count * rate) / (sigma * over)), self.m - self.unit);
                    return Last { a, next, time };
                }
            }
            // |a_n| = λⁿ⁻¹(αλ + nσ) with λ = T/2, σ = αλ + β, and b_n = nλⁿ⁻¹.
            Kind::Edge => {
                let (lambda, sigma) = (0.5 * self.t, 0.5 * self.slope(self.wide_t(), 0.0).hi);
                let [count, start] = [to_f64(n - 1), self.alpha * lambda];
                let sum = start + count * sigma;
                if 2.0 * UNIT * start < 1e-11 * sum {
                    let scale = exp(0.5 * (count - 1.0) * self.ln_e());
                    let time = ldexp(h0 * count / sum, self.m - self.unit);
                    let [a, next] = [-scale * sum, -scale * lambda * (sum + sigma)].map(|v| ldexp(v, self.unit));
                    return Last { a, next, time };
                }
            }
        }
        let exact = self.exact(Series::Velocity);
        let ((c, cx), (u, ux)) = exact.values(n - 1);
        let ((next, nx), _) = exact.values(n);
        // a_n = c_n/ν^n and b_n = U_n/ν^{n−1}, with q = μ/ν.
        let nu = self.bar.exact_q().nu;
        let above_one = nu.sub(&Dyadic::from(1.0)).to_float();
        let (nu, nu_x) = nu.to_float();
        let ln_nu =
            if nu_x == 0 { log1p(ldexp(above_one.0, clamp(above_one.1))) } else { log(nu) + as_f64(nu_x) * LN_2 };
        let power = |v: f64, x: i128, n: u128| {
            if ln_nu == 0.0 {
                ldexp(v, clamp(x))
            } else if v == 0.0 {
                0.0
            } else {
                v.signum() * exp(log(v.abs()) + as_f64(x) * LN_2 - to_f64(n) * ln_nu)
            }
        };
        let time = if h0 == 0.0 { 0.0 } else { ldexp(h0 * (u * nu / -c), clamp(ux + nu_x - cx)) };
        Last { a: power(c, cx, n - 1), next: power(next, nx, n), time }
    }

    /// Returns the time an endless train tends to: h0/σ.
    fn limit(&self) -> f64 {
        let h0 = self.start.height_gap();
        let sigma = match self.kind {
            Kind::Decay(decay) => decay.sigma,
            _ => 0.5 * self.slope(self.wide_t(), 0.0).hi,
        };
        if h0 == 0.0 { 0.0 } else { ldexp(h0 / sigma.abs(), self.m - self.unit) }
    }

    /// Returns e^{n/2} v, of true scale.
    fn decayed(&self, n: u128, v: f64) -> f64 {
        self.power(0.5 * to_f64(n) * self.ln_e(), v)
    }

    /// Returns whether the amplitude of a wave, formed for its first strikes, overflows although the strikes do not:
    /// next to e = 0 they are a small part of it.
    pub(crate) fn is_out_of_range(&self, wave: &Wave) -> bool {
        self.decayed(0, self.amplitude(wave) / wave.s) == f64::INFINITY
    }

    /// Returns exp(x) v, of true scale.
    fn power(&self, x: f64, v: f64) -> f64 {
        let [power] = self.powers(x, [v]);
        power
    }

    /// Returns exp(x) v for each v, of true scale.
    fn powers<const K: usize>(&self, x: f64, v: [f64; K]) -> [f64; K] {
        if self.unit == 0 && x > -600.0 {
            let factor = exp(x);
            return v.map(|v| factor * v);
        }
        // The product is formed by halves: a factor may leave the range of floats where the product does not.
        let half = exp(0.5 * x);
        v.map(|v| ldexp(half * v, self.unit) * half)
    }

    /// Returns −(αT + β), the next velocity after the first strike, true scale.
    fn first(&self) -> f64 {
        -after_first(&self.bar, &self.start)
    }

    /// Returns the impact of the largest |a_n|, the first if several tie, `Limit` where none attains it; and the value.
    pub(crate) fn peak(&self) -> Largest {
        let (steps, largest) = self.peak_steps();
        let impact = match steps {
            Steps::Exactly(n) => u64::try_from(n + 1).map_or(PeakImpact::Huge(to_f64(n)), PeakImpact::Number),
            Steps::Endless => PeakImpact::Limit,
        };
        (impact, largest)
    }

    /// Returns the index n and the value of the largest |a_n|, the first if several tie; `Endless` where it is a limit.
    fn peak_steps(&self) -> (Steps, f64) {
        if !rises(&self.bar, &self.start) {
            return (Steps::Exactly(0), -self.start.velocity()[0]);
        }
        // T < ½ and e < ¼: |a_{n+1}| < |a_n| from n = 1 on.
        if self.m != 0 || self.t < 0.5 && self.e < 0.25 {
            return (Steps::Exactly(1), -self.first());
        }
        let (alpha, beta) = (self.alpha, self.beta);
        let (u, w) = self.corner();
        match self.kind {
            Kind::Wave(wave) => {
                let x = alpha * wave.s * wave.s + alpha * (u - w) + beta * (u + w);
                let y = alpha * (1.0 - (u + w)) + beta;
                let quotient = angle(y.max(0.0) * wave.s, x) / wave.theta;
                // The cancellation in x and y is of terms no larger than 4(α + |β|)(u + w + S).
                let size = 4.0 * (alpha + beta.abs()) * (u + w + wave.s);
                let error = (QUOTIENT + wave.d_error) * (quotient + size / (x.abs() + y.abs() * wave.s) / wave.theta);
                let steps = self.settle(Series::Difference, quotient, error);
                (steps, self.magnitude(steps))
            }
            Kind::Decay(decay) => {
                let Decay { s, plus, sigma, tau } = decay;
                if w == 0.0 {
                    return (Steps::Endless, ldexp((self.wide_beta() + Dd::from(alpha)).hi / u, self.unit));
                }
                // (λ₊/λ₋)^n ≥ τ(1 − λ₋)/(σ(1 − λ₊)); it rises, hence σ > 0 and τ > 0.
                let (below, [rate, _]) = (0.5 * (u + w + s), self.rates(&decay));
                let quotient = log(tau / sigma * (below * below / w)) / rate;
                let error = QUOTIENT * (quotient.abs() + (1.0 + alpha * plus / tau.abs()) / rate);
                let steps = self.settle(Series::Difference, quotient.max(0.25), error);
                (steps, self.magnitude(steps))
            }
            // At (1, 1) |a_n| = α + n(α + β), which rises for ever or not at all.
            Kind::Edge if w == 0.0 => (Steps::Endless, f64::INFINITY),
            // |a_n| = λⁿ⁻¹(αλ + nσ) rises until nσ(1 − λ) ≥ λ(σ − α(1 − λ)), with σ > 0.
            Kind::Edge => {
                let (lambda, sigma) = (0.5 * self.t, 0.5 * self.slope(self.wide_t(), 0.0).hi);
                let (rise, below) = (lambda / (0.5 * (u + w)), alpha * lambda / sigma);
                let steps = self.settle(Series::Difference, (rise - below).max(0.25), QUOTIENT * (rise + below));
                (steps, self.magnitude(steps))
            }
        }
    }

    /// Returns |a_n|, of true scale, for n near the peak, where e^{n/2} is not small.
    fn magnitude(&self, n: Steps) -> f64 {
        let n = match n {
            Steps::Exactly(0) => return -self.start.velocity()[0],
            Steps::Exactly(1) => return -self.first(),
            Steps::Exactly(n) => to_f64(n),
            Steps::Endless => return f64::INFINITY,
        };
        match self.kind {
            Kind::Wave(wave) => {
                let phi = angle(self.alpha * wave.s, wave.x);
                self.power(0.5 * n * self.ln_e(), self.amplitude(&wave) * sin(n * wave.theta + phi) / wave.s)
            }
            // λ₊ⁿ (α ρⁿ + σ (1 − ρⁿ)/S) with ρ = λ₋/λ₊: no cancellation for σ ≥ 0.
            Kind::Decay(decay) => {
                let (Decay { s, sigma, .. }, [rate, ln_plus]) = (decay, self.rates(&decay));
                self.power(n * ln_plus, self.alpha * exp(-n * rate) - sigma * expm1(-n * rate) / s)
            }
            Kind::Edge => {
                let (lambda, sigma) = (0.5 * self.t, 0.5 * self.slope(self.wide_t(), 0.0).hi);
                self.power(0.5 * (n - 1.0) * self.ln_e(), self.alpha * lambda + n * sigma)
            }
        }
    }

    /// Returns the same recurrence in whole numbers.
    fn exact(&self, series: Series) -> Recurrence {
        let exact = exact(&self.bar, &self.start);
        match series {
            Series::Velocity => exact,
            Series::Difference => exact.differences(&self.bar),
        }
    }
}

/// Returns the recurrence in whole numbers. With q = μ/ν: P = μ(1 + e), Q = eν², `c_0` = `v_a`, w = ν `v_b`. For an
/// off-center bar, whose `v_b` is κ times that of its end and κ = I_a/ν, w is I_a times the velocity of its end: whole
/// again.
pub(crate) fn exact(bar: &Symmetric, start: &Start) -> Recurrence {
    let (Ratio { mu, square, factor_b, .. }, e) = (bar.exact_q(), Dyadic::from(bar.e));
    Recurrence {
        p: mu.mul(&Dyadic::from(1.0).add(&e)),
        q: e.mul(&square),
        v: Dyadic::from(start.velocity()[0]),
        w: factor_b.mul(&Dyadic::from(start.own_b)),
    }
}

impl Recurrence {
    /// Returns the recurrence of the differences a_{n+1} − a_n, times ν^{n+1}: it is the same one, from (T − 1) `v_a` +
    /// `v_b` and −(`v_b` + e `v_a`). These are whole but for an off-center bar, whose ν is rounded.
    fn differences(&self, bar: &Symmetric) -> Self {
        let nu = bar.exact_q().nu;
        let v = self.p.sub(&nu).mul(&self.v).add(&self.w);
        let w = nu.mul(&self.w.add(&Dyadic::from(bar.e).mul(&nu).mul(&self.v))).neg();
        Self { v, w, ..self.clone() }
    }
}

/// Returns D = 4e − T² with T = q(1 + `restitution`) = t + τ, where τ is the rounding error of t: `((4e − s) − s') −
/// 2tτ` with s + s' = t² exactly. Where that cancels, 4e − s is exact; else its rounding is one of D. The error is 3
/// roundings of D and 2⁻¹⁰² of 4e.
#[inline]
fn compensated(q: Dd, restitution: f64, e: f64) -> f64 {
    let product = two_prod(q.hi, restitution);
    let t = two_sum(q.hi, product.hi);
    let rest = t.lo + (product.lo + q.lo * (1.0 + restitution));
    let square = two_prod(t.hi, t.hi);
    ((4.0 * e - square.hi) - square.lo) - 2.0 * t.hi * rest
}

/// Returns the same with T = t + τ + τ' exactly: the neglected terms are below 2⁻¹⁵⁵ of 4e.
fn expanded(q: f64, restitution: f64, e: f64) -> Dd {
    let product = two_prod(q, restitution);
    let t = two_sum(q, product.hi);
    let rest = two_sum(t.lo, product.lo);
    let (square, cross) = (two_prod(t.hi, t.hi), two_prod(2.0 * t.hi, rest.hi));
    let small = cross.lo + (2.0 * t.hi * rest.lo + rest.hi * rest.hi);
    two_sum(4.0 * e, -square.hi) - two_sum(square.lo, cross.hi) - Dd::from(small)
}

/// Returns the velocities of ends a and b after the last strike: the struck end is a for an odd count.
#[inline]
pub(crate) fn rebound(bar: &Symmetric, odd: bool, a: f64, next: f64) -> [f64; 2] {
    // The swap is by bits: a branch on the parity would be mispredicted every other time.
    let (next, struck) = (next.to_bits(), (-bar.e * a).to_bits());
    let swap = (next ^ struck) & u64::from(odd).wrapping_neg();
    [f64::from_bits(next ^ swap), f64::from_bits(struck ^ swap)]
}

/// Returns the velocities that an endless train tends to: rest, unless the ends have no mass (q = 1), where only a bar
/// that turns about a still center comes to rest.
pub(crate) fn rest(bar: &Symmetric, start: &Start) -> Option<[f64; 2]> {
    let still = || {
        let va = start.velocity()[0];
        let sum = (start.wide_b() + Dd::from(va)).hi;
        // Without mass at the ends μ = ν.
        let whole = || exact(bar, start).w.add(&bar.exact_q().mu.mul(&Dyadic::from(va)));
        sum.abs() < -va * power_of_two(-40) && whole().sign() == Ordering::Equal
    };
    (bar.less > 0.0 || (bar.e < 1.0 && still())).then_some([0.0, 0.0])
}

/// Returns αT + β = −a_1, to a relative 4 ε unless it is subnormal; its sign is certain.
pub(crate) fn after_first(bar: &Symmetric, start: &Start) -> f64 {
    let at = bar.wide_q() * two_sum(1.0, bar.e) * -start.velocity()[0];
    let sum = at - start.wide_b();
    // A product below 1e−200 may have lost its low part, or all of it.
    if sum.hi.abs() > at.hi.abs() * power_of_two(-40) && (at.hi.abs() > 1e-200 || bar.q == 0.0) {
        return sum.hi;
    }
    let exact = exact(bar, start);
    let sum = exact.p.mul(&exact.v).add(&exact.w);
    let size = bar.exact_q().over_nu(&sum, 0).abs().hi;
    // Below the range of floats it is the smallest one, to keep the sign.
    match sum.sign() {
        Ordering::Less => size.max(f64::from_bits(1)),
        Ordering::Equal => 0.0,
        Ordering::Greater => -size.max(f64::from_bits(1)),
    }
}

/// Returns whether |a_1| > |a_0|, for certain: α(T − 1) + β > 0.
pub(crate) fn rises(bar: &Symmetric, start: &Start) -> bool {
    let [va, vb] = start.velocity();
    // T − 1 = e − (1 − q)(1 + e), the smaller of two ways to cancel.
    let (rise, size) = (-va * (bar.e - bar.less * (1.0 + bar.e)) - vb, -va * (1.0 + bar.less) + vb.abs());
    if rise.abs() > 16.0 * UNIT * size {
        return rise > 0.0;
    }
    exact(bar, start).differences(bar).sign(0) == Ordering::Less
}

/// Returns the angle of the point (x, y) for y ≥ 0, (x, y) ≠ 0, to a relative 2 ε. In the first octant it is the angle
/// of the nearest quarter, atan(j/4), and a rest of no more than 1/8 from its series: one division, and no branch to
/// mispredict.
#[inline]
fn angle(y: f64, x: f64) -> f64 {
    let ax = x.abs();
    if y <= 0.125 * ax {
        // This is the case of trains of some 25 impacts or more.
        let small = small_angle(y / ax);
        return if x < 0.0 { PI - small } else { small };
    }
    let steep = y > ax;
    let (n, d) = if steep { (ax, y) } else { (y, ax) };
    let j = [0.125, 0.375, 0.625, 0.875].map(|edge| usize::from(n > edge * d)).iter().sum::<usize>();
    let (quarter, base) = QUARTERS[j & 7];
    let first = base + small_angle((n - d * quarter) / (d + n * quarter));
    let acute = if steep { FRAC_PI_2 - first } else { first };
    if x < 0.0 { PI - acute } else { acute }
}

/// Returns the arc tangent for |t| ≤ 1/8.
#[inline]
fn small_angle(t: f64) -> f64 {
    let z = t * t;
    let zz = z * z;
    // The first term left out, z⁹/19, is below 2⁻⁵⁸.
    let low = (ODD[0] - z * ODD[1]) + zz * (ODD[2] - z * ODD[3]);
    let high = (ODD[4] - z * ODD[5]) + zz * (ODD[6] - z * ODD[7]);
    t - t * z * (low + zz * zz * high)
}

/// 1/3, 1/5, … 1/17: a product takes a third of the time of a quotient.
const ODD: [f64; 8] = [1.0 / 3.0, 1.0 / 5.0, 1.0 / 7.0, 1.0 / 9.0, 1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0];
/// j/4 and its arc tangent, for j = 0 … 4; filled up, so that an index of three bits needs no check.
const QUARTERS: [(f64, f64); 8] = {
    let [a, b, c, d] = [0.244_978_663_126_864_15, 0.463_647_609_000_806_1, 0.643_501_108_793_284_4, FRAC_PI_4];
    [(0.0, 0.0), (0.25, a), (0.5, b), (0.75, c), (1.0, d), (1.0, d), (1.0, d), (1.0, d)]
};

/// Returns the exponent of the leading bit.
fn exponent(x: f64) -> i32 {
    clamp(Dyadic::from(x).to_float().1)
}

#[expect(clippy::cast_precision_loss, reason = "rounds to nearest, as every f64 operation does")]
fn to_f64(n: u128) -> f64 {
    // The conversion from 64 bits with a sign is one instruction.
    i64::try_from(n).map_or_else(|_| n as f64, |n| n as f64)
}

#[expect(clippy::cast_precision_loss, reason = "an exponent; its products carry a relative error of one rounding")]
fn as_f64(x: i128) -> f64 {
    x as f64
}

/// Returns n as the sum of two floats, without error below 2¹⁰⁶.
fn wide(n: u128) -> Dd {
    let low = n & ((1 << 53) - 1);
    two_sum(to_f64(n - low), to_f64(low))
}

/// Returns ⌈x⌉, at least 1, for x < 2¹²⁷.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in range, and saturating beyond")]
fn ceil_to_int(x: f64) -> u128 {
    let x = x.ceil().max(1.0);
    if x < 1e18 { u128::from(x as u64) } else { x as u128 }
}

/// Returns an integral double-double in [0, 2¹²⁷) as an integer.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in range, and saturating beyond")]
fn integer(x: Dd) -> u128 {
    ((x.hi as i128) + (x.lo as i128)).max(0) as u128
}

#[cfg(test)]
mod tests;
