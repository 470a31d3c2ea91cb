//! The clatter in closed form: constant time for a train of any length.
//!
//! Let `a_n` < 0 be the velocity of the end about to make strike n + 1, `b_n` the companion solution:
//!
//! ```text
//! a_{n+1} = T a_n − e a_{n−1},  T = q(1 + e),  a_0 = −α,  a_1 = −(αT + β)      (α = −v_a > 0, β = −v_b)
//! b_{n+1} = T b_n − e b_{n−1},                 b_0 = 0,   b_1 = 1
//! time of strike n+1 = h0 b_n/|a_n|,           N = first n ≥ 1 with a_n ≥ 0
//! ```
//!
//! With D = 4e − T² and S = √|D| the solution is one of three:
//!
//! * D > 0, a **wave**: |`a_n`| = e^{n/2} A `sin(δ_n)/S` with A = hypot(αT + 2β, αS), `δ_n` = ψ − nθ,
//!   θ = atan2(S, T), ψ = atan2(αS, −(αT + 2β)). It ends: N = ⌈ψ/θ⌉.
//! * D < 0, a **decay**: |`a_n`| = (σ λ₊ⁿ − τ λ₋ⁿ)/S with λ± = (T ± S)/2, σ = αλ₊ + β, τ = αλ₋ + β. Endless iff
//!   σ ≥ 0; else N = ⌈ln(τ/σ)/ln(λ₊/λ₋)⌉.
//! * D = 0, the **edge** between them, where c = T/(2√e) = 1: only (1, 1) among floats.
//!
//! What decides is formed in double-double, or in integers where even those digits cancel: D, S, αT + 2β and
//! σ τ = αβT + β² + α²e. Then f64 suffices, until a quotient lies within its error of an integer.

use crate::bar::WideQ;
use crate::dd::{self, Dd, ldexp, two_prod, two_sum};
use crate::exact::{Dyadic, Recurrence};
use crate::{Bar, Start};
use libm::{atan2, exp, expm1, log, log1p, sin, sincos};
use std::cmp::Ordering;
use std::f64::consts::LN_2;

/// Roundings (units of 2⁻⁵³, relative) that a quotient of two f64 angles or logarithms may be off: two library
/// functions of at most 2 each, their arguments of at most 4, a quotient, and a margin of 2.
const QUOTIENT: f64 = 24.0 * UNIT;
const UNIT: f64 = 0.5 * f64::EPSILON;

/// The recurrence with its starting values, scaled by 2^m a step where T and e are so small that T² would underflow:
/// `a_n` stands for 2^{mn} `a_n`, `b_n` for 2^{m(n−1)} `b_n`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drive {
    pub(crate) bar: Bar,
    pub(crate) start: Start,
    pub(crate) m: i32,
    pub(crate) t: Dd,
    pub(crate) e: f64,
    pub(crate) alpha: f64,
    pub(crate) beta: f64,
    /// ln e of the true e.
    ln_e: f64,
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
    d: Dd,
    d_error: f64,
    /// √D.
    pub(crate) s: f64,
    /// αT + 2β.
    x: Dd,
    /// hypot(αT + 2β, αS).
    pub(crate) amplitude: f64,
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
    /// ln(λ₊/λ₋).
    pub(crate) rate: f64,
    /// ln λ₊ of the true λ₊.
    pub(crate) ln_plus: f64,
}

/// How many impacts, before it is put into a public type.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Steps {
    Exactly(u128),
    About(f64),
    Endless,
}

/// a_{N−1}, `a_N` and the time of the last strike.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Last {
    pub(crate) a: f64,
    pub(crate) next: f64,
    pub(crate) time: f64,
}

/// Which solution of the recurrence: that of the velocities, or that of their differences a_{n+1} − `a_n`, whose
/// first sign change is where |`a_n`| is largest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Series {
    Velocity,
    Difference,
}

impl Drive {
    /// For T > 0 and e > 0.
    pub(crate) fn new(bar: &Bar, start: &Start) -> Self {
        let [va, vb] = start.velocity();
        let (alpha, beta) = (-va, -vb);
        let e = bar.e;
        let small = bar.q().max(e.sqrt());
        let m = if small < 1e-60 { -exponent(small) } else { 0 };
        let wide = bar.wide_q();
        let (q, scaled_e) = if m == 0 { (wide.q, e) } else { (wide.q.scale(m), ldexp(e, 2 * m)) };
        let t = q * two_sum(1.0, e);
        let beta = if m == 0 { beta } else { ldexp(beta, m) };
        let ln_e = if e > 0.5 { log1p(e - 1.0) } else { log(e) };
        let mut drive = Self { bar: *bar, start: *start, m, t, e: scaled_e, alpha, beta, ln_e, kind: Kind::Edge };
        let (d, d_error) = drive.discriminant(&wide);
        drive.kind = if d.hi > 0.0 {
            let x = drive.slope(d);
            let s = d.hi.sqrt();
            let (y, x_hi) = (alpha * s, x.hi);
            let theta = atan2(s, t.hi);
            // Squares leave the range only where a scale has been brought in.
            let amplitude = if m == 0 { (x_hi * x_hi + y * y).sqrt() } else { x_hi.hypot(y) };
            Kind::Wave(Wave { d, d_error, s, x, amplitude, theta, psi: atan2(y, -x_hi) })
        } else if d.hi < 0.0 {
            Kind::Decay(drive.decay(d))
        } else {
            Kind::Edge
        };
        drive
    }

    /// D = 4e − T² to a relative 2⁻⁸⁰ at the very worst, and that bound; its sign is certain. A last strike at a
    /// relative 10⁻¹⁰ takes D at a relative 10⁻¹⁰/N and better, hence so many digits.
    fn discriminant(&self, wide: &WideQ) -> (Dd, f64) {
        let e = self.bar.e;
        // Of two equal forms the one with the smaller terms.
        let (first, second) = if e > 0.17 {
            (wide.less * wide.more * two_sum(1.0, e).sqr(), two_sum(1.0, -e).sqr())
        } else {
            (Dd::from(4.0 * self.e), self.t.sqr())
        };
        let d = first - second;
        let error = 2f64.powi(-100) * (first.hi / d.hi).abs();
        if error < 2f64.powi(-80) {
            return (d, error);
        }
        // 4e − q²(1 + 2e + e²), every product as the floats that make it up.
        if wide.q.lo == 0.0 {
            let q = wide.q.scale(self.m).hi;
            let Dd { hi: h, lo: l } = two_prod(q, q);
            let Dd { hi: g, lo: k } = two_prod(e, e);
            let [a, b, c, d, f] =
                [two_prod(-2.0 * e, h), two_prod(-2.0 * e, l), two_prod(-g, h), two_prod(-g, l), two_prod(-k, h)];
            let tail = -k * l;
            let d = dd::sum([tail, f.lo, d.lo, f.hi, d.hi, c.lo, b.lo, c.hi, b.hi, a.lo, -l, a.hi, -h, 4.0 * self.e]);
            let error = 2f64.powi(-100) + 2f64.powi(-200) * (self.e / d.hi).abs();
            if error < 2f64.powi(-80) {
                return (d, error);
            }
        }
        let exact = self.exact(Series::Velocity);
        let nu = self.bar.exact_q().1;
        (to_dd(&exact.discriminant(), &nu, &nu, 2 * self.m), 2f64.powi(-100))
    }

    /// αT + 2β, to a relative 2⁻⁹⁰ of the amplitude at the very least.
    fn slope(&self, d: Dd) -> Dd {
        let at = self.t * self.alpha;
        let x = at + Dd::from(2.0 * self.beta);
        let size = x.hi.abs().max(self.alpha * d.hi.abs().sqrt());
        if size > at.hi * 2f64.powi(-10) {
            return x;
        }
        let exact = self.exact(Series::Velocity);
        let x = Dyadic::from(-2.0).mul(&exact.w).sub(&exact.p.mul(&exact.v));
        to_dd(&x, &self.bar.exact_q().1, &Dyadic::from(1.0), self.m)
    }

    /// σ τ = αβT + β² + α²e, to a relative 2⁻⁵² at the very least, its sign for certain.
    fn product(&self) -> f64 {
        let (alpha, beta) = (self.alpha, self.beta);
        let terms = [two_prod(alpha, beta) * self.t, two_prod(beta, beta), two_prod(alpha, alpha) * self.e];
        let sum = terms[0] + terms[1] + terms[2];
        if sum.hi.abs() > terms.iter().fold(0.0, |most: f64, t| most.max(t.hi.abs())) * 2f64.powi(-40) {
            return sum.hi;
        }
        let nu = self.bar.exact_q().1;
        to_dd(&self.exact(Series::Velocity).form(), &nu, &nu, 2 * self.m).hi
    }

    fn decay(&self, d: Dd) -> Decay {
        let s = (-d).sqrt();
        let plus = (self.t + s).scale(-1).hi;
        let s = s.hi;
        // σ and τ are (αT + 2β ± αS)/2: the larger by adding, the other from their product.
        let (x, y, product) = (self.slope(d).hi, self.alpha * s, self.product());
        let (sigma, tau) = if x >= 0.0 {
            let sigma = 0.5 * (x + y);
            (sigma, product / sigma)
        } else {
            let tau = 0.5 * (x - y);
            (product / tau, tau)
        };
        let shift = f64::from(self.m) * LN_2;
        let rate = if s < 0.5 * plus { -log1p(-s / plus) } else { 2.0 * (log(plus) - shift) - self.ln_e };
        let ln_plus = if plus > 0.5 && self.m == 0 {
            let (u, w) = self.corner();
            log1p(-2.0 * w / (u + w + s)) // 1 − λ₊ = (1 − q)(1 + e)/(1 − λ₋)
        } else {
            log(plus) - shift
        };
        Decay { s, plus, sigma, tau, rate, ln_plus }
    }

    /// 1 − e and (1 − q)(1 + e), without cancellation: u + w = 2 − T, u − w = T − 2e, w = 1 − T + e.
    fn corner(&self) -> (f64, f64) {
        (1.0 - self.bar.e, self.bar.less * (1.0 + self.bar.e))
    }

    /// The number of impacts.
    pub(crate) fn count(&self) -> Steps {
        match self.kind {
            Kind::Wave(wave) => {
                let quotient = wave.psi / wave.theta;
                self.settle(Series::Velocity, quotient, QUOTIENT * quotient)
            }
            Kind::Decay(Decay { sigma, .. }) if sigma >= 0.0 => Steps::Endless,
            Kind::Decay(Decay { sigma, tau, rate, s, .. }) => {
                let quotient = self.span(s, sigma, tau) / rate;
                self.settle(Series::Velocity, quotient, QUOTIENT * (quotient + 1.0 / rate))
            }
            Kind::Edge => {
                let exact = self.exact(Series::Velocity);
                if exact.endless() {
                    return Steps::Endless;
                }
                let x = self.slope(Dd::ZERO).hi;
                let quotient = self.alpha * self.t.hi / -x;
                self.settle(Series::Velocity, quotient, QUOTIENT * quotient)
            }
        }
    }

    /// ln(τ/σ), with τ − σ = −αS, for σ < 0.
    fn span(&self, s: f64, sigma: f64, tau: f64) -> f64 {
        let gap = self.alpha * s / -sigma;
        if gap < 1.0 { log1p(gap) } else { log(tau / sigma) }
    }

    /// ⌈quotient⌉, at least 1, where the quotient is off by no more than `error`: with more digits if need be.
    fn settle(&self, series: Series, quotient: f64, error: f64) -> Steps {
        if quotient >= 2f64.powi(120) {
            return Steps::About(quotient);
        }
        if (quotient - quotient.round()).abs() > error {
            return Steps::Exactly(ceil_to_int(quotient));
        }
        let (mut middle, mut error) = (Dd::from(quotient), error);
        if let (Kind::Wave(wave), true) = (self.kind, series == Series::Velocity) {
            let (theta, psi) = self.angles(&wave);
            middle = psi / theta;
            // Angles to 2⁻⁹⁹; D and αT + 2β as `discriminant` and `slope` guarantee.
            let slope = self.alpha * self.t.hi / wave.amplitude;
            error = quotient * (wave.d_error + 2f64.powi(-95) * (1.0 + slope));
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

    /// θ and ψ in double-double.
    fn angles(&self, wave: &Wave) -> (Dd, Dd) {
        let s = wave.d.sqrt();
        (dd::atan2(s, self.t), dd::atan2(s * self.alpha, -wave.x))
    }

    /// |`δ_n`| = |ψ − nθ| for each n, to a relative `error` or from double-double angles.
    fn remainders<const K: usize>(&self, wave: &Wave, n: [u128; K], error: f64) -> [f64; K] {
        let deltas = n.map(|n| (wave.psi - to_f64(n) * wave.theta).abs());
        if deltas.iter().all(|delta| 8.0 * UNIT * wave.psi < error * delta) {
            return deltas;
        }
        let (theta, psi) = self.angles(wave);
        n.map(|n| (psi - theta * wide(n)).abs().hi)
    }

    /// a_{N−1}, `a_N` and the time of the last strike; of an endless train, at rest, the time it tends to. NaN for a
    /// count beyond 2¹²⁰, whose remainder is unknown.
    pub(crate) fn last(&self, steps: Steps) -> Last {
        match steps {
            Steps::Exactly(1) => Last { a: -self.alpha, next: self.first(), time: 0.0 },
            Steps::Exactly(n) => self.last_of(n, 1e-11),
            Steps::Endless => Last { a: 0.0, next: 0.0, time: self.limit() },
            Steps::About(_) => Last { a: f64::NAN, next: f64::NAN, time: f64::NAN },
        }
    }

    /// Approach velocity and time of strike n.
    pub(crate) fn strike(&self, n: u128) -> (f64, f64) {
        if n == 1 {
            return (-self.alpha, 0.0);
        }
        if let Kind::Decay(Decay { s, plus, sigma, rate, ln_plus, .. }) = self.kind
            && sigma >= 0.0
        {
            let count = to_f64(n - 1);
            let (p, g) = (exp(-count * rate), -expm1(-count * rate) * (plus / s));
            let sum = self.alpha * plus * p + sigma * g;
            return (-exp(count * ln_plus) * sum / plus, ldexp(self.start.height_gap() * g / sum, self.m));
        }
        let Last { a, time, .. } = self.last_of(n, 1e-13);
        (a, time)
    }

    /// For n ≥ 2: a_{n−1}, `a_n` and the time of strike n, of a wave from angles to a relative `error`.
    fn last_of(&self, n: u128, error: f64) -> Last {
        let h0 = self.start.height_gap();
        match self.kind {
            Kind::Wave(wave) => {
                let [delta, beyond] = self.remainders(&wave, [n - 1, n], error);
                // Next to a tie, integers.
                if delta.min(beyond) > wave.psi * 2f64.powi(-60) {
                    let amplitude = wave.amplitude / wave.s;
                    let (rise, run) = sincos(delta);
                    let a = -self.decayed(n - 1) * amplitude * rise;
                    let next = self.decayed(n) * amplitude * sin(beyond);
                    let sum = self.alpha * wave.s * (run / rise) + wave.x.hi;
                    let time = ldexp(h0 / wave.amplitude * (2.0 * sum / wave.amplitude), self.m);
                    return Last { a, next, time };
                }
            }
            Kind::Decay(Decay { s, sigma, tau, rate, ln_plus, .. }) => {
                let count = to_f64(n - 1);
                let span = self.span(s, sigma, tau);
                let delta = span - count * rate;
                if 8.0 * UNIT * (span + 1.0) < 1e-10 * delta.min(rate - delta) {
                    let over = expm1(delta);
                    let a = sigma / s * exp(count * ln_plus) * over;
                    let next = sigma / s * exp((count + 1.0) * ln_plus) * expm1(delta - rate);
                    let time = ldexp(h0 * expm1(-count * rate) / (sigma * over), self.m);
                    return Last { a, next, time };
                }
            }
            // |a_n| = λⁿ⁻¹(αλ + nσ) with λ = T/2, σ = αλ + β, and b_n = nλⁿ⁻¹.
            Kind::Edge => {
                let (lambda, sigma) = (0.5 * self.t.hi, 0.5 * self.slope(Dd::ZERO).hi);
                let [count, start] = [to_f64(n - 1), self.alpha * lambda];
                let sum = start + count * sigma;
                if 2.0 * UNIT * start < 1e-11 * sum {
                    let scale = exp((count - 1.0) * log(lambda));
                    let time = ldexp(h0 * count / sum, self.m);
                    return Last { a: -scale * sum, next: -scale * lambda * (sum + sigma), time };
                }
            }
        }
        let exact = self.exact(Series::Velocity);
        let ((c, cx), (u, ux)) = exact.values(n - 1);
        let ((next, nx), _) = exact.values(n);
        // a_n = c_n/ν^n and b_n = U_n/ν^{n−1}, with q = μ/ν.
        let nu = self.bar.exact_q().1;
        let above_one = nu.sub(&Dyadic::from(1.0)).to_float();
        let (nu, nu_x) = nu.to_float();
        let ln_nu =
            if nu_x == 0 { log1p(ldexp(above_one.0, clamp(above_one.1))) } else { log(nu) + as_f64(nu_x) * LN_2 };
        let power = |v: f64, x: i128, n: u128| {
            if v == 0.0 { 0.0 } else { v.signum() * exp(log(v.abs()) + as_f64(x) * LN_2 - to_f64(n) * ln_nu) }
        };
        let time = if h0 == 0.0 { 0.0 } else { h0 * ldexp(u * nu / -c, clamp(ux + nu_x - cx)) };
        Last { a: power(c, cx, n - 1), next: power(next, nx, n), time }
    }

    /// The time an endless train tends to: h0/σ.
    fn limit(&self) -> f64 {
        let h0 = self.start.height_gap();
        let sigma = match self.kind {
            Kind::Decay(decay) => decay.sigma,
            _ => 0.5 * self.slope(Dd::ZERO).hi,
        };
        if h0 == 0.0 { 0.0 } else { ldexp(h0 / sigma.abs(), self.m) }
    }

    /// e^{n/2}.
    fn decayed(&self, n: u128) -> f64 {
        exp(0.5 * to_f64(n) * self.ln_e)
    }

    /// −(αT + β), the next velocity after the first strike, true scale.
    fn first(&self) -> f64 {
        -after_first(&self.bar, &self.start)
    }

    /// Index n and value of the largest |`a_n`|, the first if several tie; `Endless` where it is a limit.
    pub(crate) fn peak(&self) -> (Steps, f64) {
        if !rises(&self.bar, &self.start) {
            return (Steps::Exactly(0), self.alpha);
        }
        // T < ½ and e < ¼: |a_{n+1}| < |a_n| from n = 1 on.
        if self.m != 0 || self.t.hi < 0.5 && self.e < 0.25 {
            return (Steps::Exactly(1), -self.first());
        }
        let (alpha, beta) = (self.alpha, self.beta);
        let (u, w) = self.corner();
        match self.kind {
            Kind::Wave(wave) => {
                let x = alpha * wave.d.hi + alpha * (u - w) + beta * (u + w);
                let y = alpha * (1.0 - (u + w)) + beta;
                let quotient = atan2(y.max(0.0) * wave.s, x) / wave.theta;
                // The cancellation in x and y is of terms no larger than 4(α + |β|)(u + w + S).
                let size = 4.0 * (alpha + beta.abs()) * (u + w + wave.s);
                let error = QUOTIENT * (quotient + size / (x.abs() + y.abs() * wave.s) / wave.theta);
                let steps = self.settle(Series::Difference, quotient, error);
                (steps, self.magnitude(steps))
            }
            Kind::Decay(Decay { s, plus, sigma, tau, rate, .. }) => {
                if w == 0.0 {
                    return (Steps::Endless, two_sum(alpha, beta).hi / u);
                }
                // (λ₊/λ₋)^n ≥ τ(1 − λ₋)/(σ(1 − λ₊)); it rises, hence σ > 0 and τ > 0.
                let below = 0.5 * (u + w + s);
                let quotient = log(tau / sigma * (below * below / w)) / rate;
                let error = QUOTIENT * (quotient.abs() + (1.0 + alpha * plus / tau.abs()) / rate);
                let steps = self.settle(Series::Difference, quotient.max(0.25), error);
                (steps, self.magnitude(steps))
            }
            // (1, 1): |a_n| = α + n(α + β), which rises for ever or not at all.
            Kind::Edge => (Steps::Endless, f64::INFINITY),
        }
    }

    /// |`a_n`|, of true scale. Meant for n near the peak, where e^{n/2} is not small.
    fn magnitude(&self, n: Steps) -> f64 {
        let n = match n {
            Steps::Exactly(0) => return self.alpha,
            Steps::Exactly(1) => return -self.first(),
            Steps::Exactly(n) => to_f64(n),
            Steps::About(n) => n,
            Steps::Endless => return f64::INFINITY,
        };
        match self.kind {
            Kind::Wave(wave) => {
                let phi = atan2(self.alpha * wave.s, wave.x.hi);
                exp(0.5 * n * self.ln_e) * wave.amplitude * sin(n * wave.theta + phi) / wave.s
            }
            // λ₊ⁿ (α ρⁿ + σ (1 − ρⁿ)/S) with ρ = λ₋/λ₊: no cancellation for σ ≥ 0.
            Kind::Decay(Decay { s, sigma, rate, ln_plus, .. }) => {
                exp(n * ln_plus) * (self.alpha * exp(-n * rate) - sigma * expm1(-n * rate) / s)
            }
            Kind::Edge => self.alpha + n * (self.alpha + self.beta),
        }
    }

    /// The same recurrence with whole numbers.
    fn exact(&self, series: Series) -> Recurrence {
        let exact = exact(&self.bar, &self.start);
        match series {
            Series::Velocity => exact,
            Series::Difference => exact.differences(&self.bar),
        }
    }
}

/// Neighboring strikes that are carried on together.
pub(crate) const LANES: usize = 4;
/// Strikes from one anchor in the closed form to the next: 64 steps of the four lanes, which add some 64 roundings.
const BLOCK: u128 = 256;

/// Approach velocity and time of four neighboring strikes, ready to be carried on to the next four.
///
/// For a wave, x = sin `δ_n` and y = sin nθ turn by 4θ a step in the form `d ← d − κx, x ← x + d` with κ = 4 sin² 2θ
/// (Reinsch), whose errors stay relative where `δ_n` or nθ are small; |`a_n`| = gx, time = cy/x. For an endless decay,
/// x = ρⁿ and y = (1 − ρⁿ)/(1 − ρ) with ρ = λ₋/λ₊ add up positive terms; |`a_n`| = g(αλ₊x + σy), time = h0 y over that.
#[derive(Debug, Clone)]
pub(crate) struct Lanes {
    /// Index n of the first lane.
    n: u128,
    x: [f64; LANES],
    dx: [f64; LANES],
    y: [f64; LANES],
    dy: [f64; LANES],
    g: [f64; LANES],
    kappa: f64,
    /// What g is multiplied by a step.
    decay: f64,
    /// 2 h0/A, or h0.
    time: f64,
    approach: [f64; LANES],
    times: [f64; LANES],
}

impl Lanes {
    /// With index `n` in the first lane.
    pub(crate) fn new(drive: &Drive, n: u128) -> Self {
        let zero = [0.0; LANES];
        let mut lanes = Self {
            n,
            x: zero,
            dx: zero,
            y: zero,
            dy: zero,
            g: zero,
            kappa: 0.0,
            decay: 0.0,
            time: 0.0,
            approach: zero,
            times: zero,
        };
        lanes.anchor(drive);
        lanes
    }

    /// Approach velocity and time of the strike of index `n`, which is asked for in order.
    #[inline]
    pub(crate) fn strike(&mut self, drive: &Drive, n: u128) -> (f64, f64) {
        let lane = (n - self.n) as usize;
        if lane < LANES {
            return (self.approach[lane], self.times[lane]);
        }
        self.n = n;
        if n % BLOCK < LANES as u128 {
            self.anchor(drive);
        } else {
            self.step(drive);
        }
        (self.approach[0], self.times[0])
    }

    /// Carries all lanes on.
    #[inline]
    fn step(&mut self, drive: &Drive) {
        for i in 0..LANES {
            self.g[i] *= self.decay;
        }
        if let Kind::Wave(_) = drive.kind {
            for i in 0..LANES {
                self.x[i] += self.dx[i];
                self.y[i] += self.dy[i];
                self.dx[i] -= self.kappa * self.x[i];
                self.dy[i] -= self.kappa * self.y[i];
            }
        } else {
            for i in 0..LANES {
                self.y[i] += self.dy[0] * self.x[i];
                self.x[i] *= self.kappa;
            }
        }
        self.output(drive);
    }

    #[inline]
    fn output(&mut self, drive: &Drive) {
        match drive.kind {
            Kind::Decay(Decay { plus, sigma, .. }) => {
                let start = drive.alpha * plus;
                for i in 0..LANES {
                    let sum = start * self.x[i] + sigma * self.y[i];
                    self.approach[i] = -self.g[i] * sum;
                    self.times[i] = self.time * (self.y[i] / sum);
                }
            }
            _ => {
                for i in 0..LANES {
                    self.approach[i] = -self.g[i] * self.x[i];
                    self.times[i] = self.time * (self.y[i] / self.x[i]);
                }
            }
        }
    }

    /// All lanes from the closed form.
    fn anchor(&mut self, drive: &Drive) {
        let h0 = drive.start.height_gap();
        match drive.kind {
            Kind::Wave(wave) => {
                let theta = wave.theta;
                let (sin, cos) = sincos(2.0 * theta);
                let phi = atan2(drive.alpha * wave.s, wave.x.hi);
                // The angle at index n seen from the near end of its half turn; a turn by 2θ away from it first,
                // so that one sine and cosine give both value and difference.
                let lane = |angle: f64, sign: f64| {
                    let (s, c) = sincos(angle + sign * 2.0 * theta);
                    (s * cos - sign * c * sin, 2.0 * sign * c * sin)
                };
                let n = [0, 1, 2, 3].map(|i| self.n + i);
                let deltas = drive.remainders(&wave, n, 1e-13);
                for (i, (n, delta)) in n.into_iter().zip(deltas).enumerate() {
                    let turned = to_f64(n) * theta;
                    let lead = phi + turned;
                    (self.x[i], self.dx[i]) = if lead < 1.0 { lane(lead, 1.0) } else { lane(delta, -1.0) };
                    (self.y[i], self.dy[i]) = if turned < 1.0 { lane(turned, 1.0) } else { lane(phi + delta, -1.0) };
                    self.g[i] = drive.decayed(n) * (wave.amplitude / wave.s);
                }
                self.kappa = 4.0 * sin * sin;
                self.decay = drive.bar.e * drive.bar.e;
                self.time = ldexp(2.0 * h0 / wave.amplitude, drive.m);
            }
            Kind::Decay(Decay { s, plus, rate, ln_plus, .. }) => {
                for i in 0..LANES {
                    let n = to_f64(self.n + i as u128);
                    self.x[i] = exp(-n * rate);
                    self.y[i] = -expm1(-n * rate) * (plus / s);
                    self.g[i] = exp(n * ln_plus) / plus;
                }
                self.kappa = exp(-4.0 * rate);
                self.dy[0] = -expm1(-4.0 * rate) * (plus / s);
                self.decay = exp(4.0 * ln_plus);
                self.time = ldexp(h0, drive.m);
            }
            Kind::Edge => {}
        }
        self.output(drive);
    }
}

/// With q = μ/ν: P = μ(1 + e), Q = eν², `c_0` = `v_a`, w = ν `v_b`.
pub(crate) fn exact(bar: &Bar, start: &Start) -> Recurrence {
    let [va, vb] = start.velocity();
    let (mu, nu) = bar.exact_q();
    let e = Dyadic::from(bar.e);
    Recurrence {
        p: mu.mul(&Dyadic::from(1.0).add(&e)),
        q: e.mul(&nu.mul(&nu)),
        v: Dyadic::from(va),
        w: nu.mul(&Dyadic::from(vb)),
    }
}

impl Recurrence {
    /// The differences a_{n+1} − `a_n`, times ν^{n+1}: they obey the same recurrence, from
    /// (T − `1)v_a` + `v_b` and −(`v_b` + e `v_a`).
    fn differences(&self, bar: &Bar) -> Self {
        let nu = bar.exact_q().1;
        let v = self.p.sub(&nu).mul(&self.v).add(&self.w);
        let w = nu.mul(&self.w.add(&Dyadic::from(bar.e).mul(&nu).mul(&self.v))).neg();
        Self { v, w, ..self.clone() }
    }
}

/// αT + β = −`a_1`, to a relative 4 ε, its sign for certain.
pub(crate) fn after_first(bar: &Bar, start: &Start) -> f64 {
    let [va, vb] = start.velocity();
    let at = bar.wide_q().q * two_sum(1.0, bar.e) * -va;
    let sum = at + Dd::from(-vb);
    if sum.hi.abs() > at.hi.abs() * 2f64.powi(-40) && (at.hi.abs() > 1e-200 || at.hi == 0.0) {
        return sum.hi;
    }
    let exact = exact(bar, start);
    let (sum, nu) = (exact.p.mul(&exact.v).add(&exact.w), bar.exact_q().1);
    -to_dd(&sum, &nu, &Dyadic::from(1.0), 0).hi
}

/// Whether |`a_1`| > |`a_0`|, for certain: α(T − 1) + β > 0.
pub(crate) fn rises(bar: &Bar, start: &Start) -> bool {
    let [va, vb] = start.velocity();
    // T − 1 = e − (1 − q)(1 + e), the smaller of two ways to cancel.
    let (rise, size) = (-va * (bar.e - bar.less * (1.0 + bar.e)) - vb, -va * (1.0 + bar.less) + vb.abs());
    if rise.abs() > 16.0 * UNIT * size {
        return rise > 0.0;
    }
    exact(bar, start).differences(bar).sign(0) == Ordering::Less
}

/// `2^shift x/(d1 d2)` as a double-double.
fn to_dd(x: &Dyadic, d1: &Dyadic, d2: &Dyadic, shift: i32) -> Dd {
    let (hi, exponent) = x.to_float();
    if hi == 0.0 {
        return Dd::ZERO;
    }
    let normal = x.mul(&Dyadic::power_of_two(-exponent));
    let value = |d: &Dyadic| {
        let (hi, exponent) = d.to_float();
        let lo = d.mul(&Dyadic::power_of_two(-exponent)).sub(&Dyadic::from(hi)).to_float();
        (two_sum(hi, ldexp(lo.0, clamp(lo.1))), exponent)
    };
    let ((n, _), (a, ax), (b, bx)) = (value(&normal), value(d1), value(d2));
    (n / a / b).scale(clamp(exponent - ax - bx + i128::from(shift)))
}

/// The exponent of the leading bit.
fn exponent(x: f64) -> i32 {
    clamp(Dyadic::from(x).to_float().1)
}

fn clamp(x: i128) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "clamped to far beyond the exponents of floats")]
    let small = x.clamp(-20_000, 20_000) as i32;
    small
}

#[expect(clippy::cast_precision_loss, reason = "rounds to nearest, as every f64 operation does")]
fn to_f64(n: u128) -> f64 {
    n as f64
}

#[expect(clippy::cast_precision_loss, reason = "an exponent; its products carry a relative error of one rounding")]
fn as_f64(x: i128) -> f64 {
    x as f64
}

/// n as the sum of two floats, without error below 2¹⁰⁶.
fn wide(n: u128) -> Dd {
    let low = n & ((1 << 53) - 1);
    two_sum(to_f64(n - low), to_f64(low))
}

/// ⌈x⌉, at least 1, for x < 2¹²⁷.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in range, and saturating beyond")]
fn ceil_to_int(x: f64) -> u128 {
    x.ceil().max(1.0) as u128
}

/// An integral double-double in [0, 2¹²⁷).
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in range, and saturating beyond")]
fn integer(x: Dd) -> u128 {
    ((x.hi as i128) + (x.lo as i128)).max(0) as u128
}

const _: fn(f64, f64) -> Dd = two_prod;

#[cfg(test)]
mod tests;
