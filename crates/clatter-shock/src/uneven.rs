//! Spectra of unevenly sampled records: the exact response to straight lines between samples, eight frequencies side by
//! side.
//!
//! Over a step in which the acceleration is linear, the motion obeys
//!
//! ```text
//! x ← x + (f₀ − x) X₀ + (w − σx) h + f₁ X₁
//! w ← w + (f₀ − ρw − px) h + (σf₀ + f₁ − w) X₀ + σf₁ X₁
//! ```
//!
//! with the forcing f₀ + f₁τ, the impulse response h and its first two integrals X₀ and X₁. X₀ and X₁ come from power
//! series where the step is short, which cost less than sine and exponential, and h is τ − 2ζX₀ − X₁: nothing cancels
//! at frequencies far below the sampling rate. Longer steps take the closed forms.
//!
//! Steps are taken a block at a time. Where bounds on the motion say that a block can hold no new extreme, its steps are
//! not searched.

use crate::eight::{LARGEST_ANGLE, Many, WIDTH};
use crate::filter::share_of_bend;
use crate::forced::{Ramps, Segment};
use crate::peaks::{Peak, Peaks, Range};
use crate::side_by_side::Step as Free;
use crate::suspension::{Modes, Motion};
use crate::{DampingRatio, Error, Frequencies, Quantity, Spectrum};
use std::f64::consts::TAU;

/// Steps between two bounds.
const BLOCK: usize = 32;
/// Steps gone through for one group of frequencies before the next: they stay in the nearest cache.
const CHUNK: usize = 16 * BLOCK;
/// Terms of the series at most.
const TERMS: usize = 24;
/// Lengths s = (1 + 2ζ)τ up to which a series of so many terms leaves out less than half a rounding of itself, sⁿ/(n + 1)!.
const SHORT: [(f64, usize); 5] = [(2.4e-4, 4), (0.02, 7), (0.13, 10), (0.5, 14), (SHORTEST_LONG, TERMS)];
/// From here on closed forms lose nothing to their differences.
const SHORTEST_LONG: f64 = 2.0;
/// Steps that are taken in one leap at most, and where that is too long.
const LEAPS: [usize; 2] = [BLOCK, BLOCK / 4];
/// Smaller numbers would slow the machine down; they are far below one rounding of anything that is compared.
const TINY: f64 = 1e-280;
/// Smaller motions are not bounded by their squares.
const SMALLEST: f64 = 1e-140;
/// Places and weights of eight points in (0, 1) whose weighted sum is the integral of any polynomial up to degree 15
/// (Gauss–Legendre).
const POINTS: Many = [
    0.019_855_071_751_231_884,
    0.101_666_761_293_186_63,
    0.237_233_795_041_835_5,
    0.408_282_678_752_175_1,
    0.591_717_321_247_824_9,
    0.762_766_204_958_164_5,
    0.898_333_238_706_813_4,
    0.980_144_928_248_768_1,
];
const WEIGHTS: Many = [
    0.050_614_268_145_188_13,
    0.111_190_517_226_687_24,
    0.156_853_322_938_943_64,
    0.181_341_891_689_180_99,
    0.181_341_891_689_180_99,
    0.156_853_322_938_943_64,
    0.111_190_517_226_687_24,
    0.050_614_268_145_188_13,
];

/// A shock response spectrum in the making from samples at any times: in pieces of any size; memory does not grow.
///
/// [`SpectrumFilter`](crate::SpectrumFilter) is faster for samples that are even in time.
#[derive(Debug, Clone)]
pub struct UnevenFilter {
    frequencies: Frequencies,
    damping: DampingRatio,
    quantity: Quantity,
    modes: Modes,
    series: Series,
    groups: Vec<Group>,
    /// The newest sample.
    last: Option<(f64, f64)>,
    /// How many samples there have been.
    count: usize,
}

/// One step: the times of its ends, and the acceleration there.
#[derive(Debug, Clone, Copy)]
struct Step {
    start: f64,
    end: f64,
    dt: f64,
    from: f64,
    to: f64,
    /// Change of acceleration over time.
    slope: f64,
}

/// Steps that follow one another, and bounds on what they do.
#[derive(Debug)]
struct Block<'a> {
    steps: &'a [Step],
    longest: f64,
    /// The integral of the absolute acceleration, at most.
    added: f64,
    peak: f64,
    steepest: f64,
    /// Of each length of [`LEAPS`], and the time that the longest takes.
    leaps: [(f64, Vec<Leap>); LEAPS.len()],
}

impl<'a> Block<'a> {
    fn new(series: &Series, steps: &'a [Step]) -> Self {
        let all = |of: fn(&Step) -> f64| steps.iter().map(of);
        let peak = |s: &Step| s.from.abs().max(s.to.abs());
        Self {
            steps,
            longest: all(|s| s.dt).fold(0.0, f64::max),
            added: steps.iter().map(|s| s.dt * peak(s)).sum(),
            peak: steps.iter().map(peak).fold(0.0, f64::max),
            steepest: all(|s| s.slope.abs()).fold(0.0, f64::max),
            leaps: LEAPS.map(|length| {
                let mut leaps = Vec::with_capacity(BLOCK / length);
                pulp::Arch::new().dispatch(Leaps { series, steps, length, leaps: &mut leaps });
                (leaps.iter().fold(0.0, |most, leap| leap.span.max(most)), leaps)
            }),
        }
    }
    fn span(&self) -> f64 {
        self.leaps[0].0
    }
}

/// What several steps do to a part at rest, for every frequency: powers of their phase.
#[derive(Debug, Clone, Copy)]
struct Leap {
    span: f64,
    /// −x over the phase, and −w.
    x: [f64; TERMS],
    w: [f64; TERMS],
}

impl Leap {
    /// The response −∫ a h dt by the series of h, each power integrated over the steps. Eight points a step leave out
    /// less than 10⁻¹⁷ of it.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn new(series: &Series, steps: &[Step]) -> Self {
        let span: f64 = steps.iter().map(|s| s.dt).sum();
        let mut sums = [[0.0; WIDTH]; TERMS + 1];
        let mut left = 0.0;
        for s in steps.iter().rev() {
            let (mut to_go, mut power): (Many, Many) = ([0.0; WIDTH], [0.0; WIDTH]);
            for l in 0..WIDTH {
                to_go[l] = (left + s.dt * POINTS[l]) / span;
                power[l] = WEIGHTS[l] * s.dt * (s.to + (s.from - s.to) * POINTS[l]);
            }
            for sum in &mut sums {
                for l in 0..WIDTH {
                    sum[l] += power[l];
                    power[l] *= to_go[l];
                }
            }
            left += s.dt;
        }
        let sum = |k: usize| sums[k].iter().sum::<f64>();
        Self {
            span,
            x: std::array::from_fn(|k| series.h[k] * sum(k + 1)),
            w: std::array::from_fn(|k| series.w[k] * sum(k)),
        }
    }
}

/// The leaps of one length over some steps, on the widest instructions of the machine.
struct Leaps<'a> {
    series: &'a Series,
    steps: &'a [Step],
    length: usize,
    leaps: &'a mut Vec<Leap>,
}

impl pulp::WithSimd for Leaps<'_> {
    type Output = ();
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        for steps in self.steps.chunks(self.length) {
            self.leaps.push(Leap::new(self.series, steps));
        }
    }
}

/// Responses from rest by powers of τ: X₀/τ², X₁/τ³, h/τ and w of an impulse.
#[derive(Debug, Clone)]
struct Series {
    x0: [f64; TERMS],
    x1: [f64; TERMS],
    h: [f64; TERMS],
    w: [f64; TERMS],
}

impl Series {
    /// X₁ = Σ aₖτᵏ solves X₁″ + 2ζX₁′ + X₁ = τ; X₀ is its derivative, h that of X₀, and w = h′ + σh.
    fn new(modes: &Modes) -> Self {
        let none = [0.0; TERMS];
        let mut series = Self { x0: none, x1: none, h: none, w: none };
        let (mut older, mut a, mut k, mut h) = (0.0, 1.0 / 6.0, 3.0, 0.0);
        for i in 0..TERMS {
            (series.x0[i], series.x1[i], series.h[i]) = (k * a, a, k * (k - 1.0) * a);
            series.w[i] = (k - 2.0) * series.h[i] + modes.sigma * h;
            h = series.h[i];
            let next = -(2.0 * modes.zeta * k * a + older) / (k * (k + 1.0));
            (older, a, k) = (a, next, k + 1.0);
        }
        series
    }
}

/// What all groups share.
#[derive(Debug, Clone, Copy)]
struct Constants<'a> {
    modes: &'a Modes,
    series: &'a Series,
}

/// Oscillators of eight natural frequencies; the last group repeats its last one.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
struct Group {
    omega: Many,
    /// 1/ω and its square.
    inverse: Many,
    square_inverse: Many,
    x: Many,
    w: Many,
    high: Many,
    low: Many,
    row: usize,
    /// Oscillators that are asked for.
    count: usize,
    peaks: [Peaks; WIDTH],
}

/// Motion and quantity at both ends of each step of a block.
#[derive(Debug)]
struct Trace {
    x: [Many; BLOCK + 1],
    w: [Many; BLOCK + 1],
    q: [Many; BLOCK + 1],
    /// h, X₀ and f₁X₁ of each step.
    integrals: [[Many; 3]; BLOCK],
}

impl Trace {
    fn new() -> Self {
        let none = [[0.0; WIDTH]; BLOCK + 1];
        Self { x: none, w: none, q: none, integrals: [[[0.0; WIDTH]; 3]; BLOCK] }
    }
}

impl Group {
    fn new(omegas: &[f64], row: usize) -> Self {
        let omega: Many = std::array::from_fn(|l| omegas[l.min(omegas.len() - 1)]);
        let zero = [0.0; WIDTH];
        Self {
            omega,
            inverse: omega.map(f64::recip),
            square_inverse: omega.map(|omega| (omega.recip() * omega.recip()).min(f64::MAX)),
            x: zero,
            w: zero,
            high: zero,
            low: zero,
            row,
            count: omegas.len(),
            peaks: [Peaks::default(); WIDTH],
        }
    }
    /// Short steps by `N` terms of the series.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn short<S: pulp::Simd, const N: usize>(
        &mut self,
        simd: S,
        c: &Constants<'_>,
        block: &Block<'_>,
        trace: &mut Trace,
    ) -> [Many; 2] {
        let [r0, r1] = c.modes.rows[self.row];
        let (r0, r1) = (simd.splat_f64s(r0), simd.splat_f64s(r1));
        let (mut high, mut low) = (trace.q[0], trace.q[0]);
        // In vectors of the machine by name: the compiler leaves these loops to scalars.
        for i in 0..WIDTH / S::F64_LANES {
            // First what depends on the steps alone, that no step waits for the one before.
            for (s, integrals) in block.steps.iter().zip(&mut trace.integrals) {
                let [h, x0, ramp] = self.integrals::<S, N>(simd, c, s, i);
                S::as_mut_simd_f64s(&mut integrals[0]).0[i] = h;
                S::as_mut_simd_f64s(&mut integrals[1]).0[i] = x0;
                S::as_mut_simd_f64s(&mut integrals[2]).0[i] = ramp;
            }
            let (mut x, mut w) = (S::as_simd_f64s(&self.x).0[i], S::as_simd_f64s(&self.w).0[i]);
            let (mut top, mut bottom) = (S::as_simd_f64s(&high).0[i], S::as_simd_f64s(&low).0[i]);
            for (k, s) in block.steps.iter().enumerate() {
                let [h, x0, ramp] = &trace.integrals[k];
                let (h, x0, ramp) = (S::as_simd_f64s(h).0[i], S::as_simd_f64s(x0).0[i], S::as_simd_f64s(ramp).0[i]);
                (x, w) = self.step(simd, c, s, i, [h, x0, ramp], (x, w));
                let q = simd.mul_add_e_f64s(r0, x, simd.mul_f64s(r1, w));
                (top, bottom) = (simd.max_f64s(top, q), simd.min_f64s(bottom, q));
                S::as_mut_simd_f64s(&mut trace.x[k + 1]).0[i] = x;
                S::as_mut_simd_f64s(&mut trace.w[k + 1]).0[i] = w;
                S::as_mut_simd_f64s(&mut trace.q[k + 1]).0[i] = q;
            }
            (S::as_mut_simd_f64s(&mut self.x).0[i], S::as_mut_simd_f64s(&mut self.w).0[i]) = (x, w);
            (S::as_mut_simd_f64s(&mut high).0[i], S::as_mut_simd_f64s(&mut low).0[i]) = (top, bottom);
        }
        [high, low]
    }
    /// One step by closed forms.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn long(&self, modes: &Modes, s: &Step) -> (Many, Many) {
        let (mut x, mut w, mut tau) = (self.x, self.w, [0.0; WIDTH]);
        let mut tame = true;
        for l in 0..WIDTH {
            tau[l] = self.omega[l] * s.dt;
            tame &= tau[l] < LARGEST_ANGLE;
        }
        if !tame {
            return self.one_by_one(modes, s);
        }
        let free = Free::new(modes, &self.omega, s.dt, 0.0);
        let ramps = Ramps::long(modes, &tau, &free);
        for l in 0..WIDTH {
            let (f0, f1) = (-s.from * self.inverse[l], -s.slope * self.square_inverse[l]);
            let driven = [f0 * ramps.x0[l] + f1 * ramps.x1[l], f0 * ramps.w0[l] + f1 * ramps.w1[l]];
            x[l] = free.c[l] * self.x[l] + free.s[l] * self.w[l] + driven[0];
            w[l] = free.k[l] * self.w[l] - modes.p * free.s[l] * self.x[l] + driven[1];
        }
        (x, w)
    }
    /// One step at any frequencies and on any machine.
    #[inline(never)]
    fn one_by_one(&self, modes: &Modes, s: &Step) -> (Many, Many) {
        let (mut x, mut w) = (self.x, self.w);
        let mut segment = Segment::new(modes);
        for l in 0..WIDTH {
            let span = segment.begin_line(Motion { x: x[l], w: w[l] }, self.omega[l], s.dt, s.from, s.to);
            let m = segment.sample(span).m;
            (x[l], w[l]) = (m.x, m.w);
        }
        (x, w)
    }
    /// Steps of which some are long, each as its length asks for.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn any<S: pulp::Simd>(&mut self, simd: S, c: &Constants<'_>, block: &Block<'_>, trace: &mut Trace) -> [Many; 2] {
        let modes = c.modes;
        let [r0, r1] = modes.rows[self.row];
        let (mut high, mut low) = (trace.q[0], trace.q[0]);
        for (k, s) in block.steps.iter().enumerate() {
            let short = self.omega.map(|omega| (1.0 + 2.0 * modes.zeta) * (omega * s.dt) <= SHORTEST_LONG);
            let mut next = (self.x, self.w);
            if short.contains(&true) {
                for i in 0..WIDTH / S::F64_LANES {
                    let integrals = self.integrals::<S, TERMS>(simd, c, s, i);
                    let (x, w) = (S::as_simd_f64s(&self.x).0[i], S::as_simd_f64s(&self.w).0[i]);
                    let (x, w) = self.step(simd, c, s, i, integrals, (x, w));
                    (S::as_mut_simd_f64s(&mut next.0).0[i], S::as_mut_simd_f64s(&mut next.1).0[i]) = (x, w);
                }
            }
            if short.contains(&false) {
                let long = if S::IS_SCALAR { self.one_by_one(modes, s) } else { self.long(modes, s) };
                for l in 0..WIDTH {
                    (next.0[l], next.1[l]) = if short[l] { (next.0[l], next.1[l]) } else { (long.0[l], long.1[l]) };
                }
            }
            (self.x, self.w) = next;
            let q: Many = std::array::from_fn(|l| r0 * self.x[l] + r1 * self.w[l]);
            (trace.x[k + 1], trace.w[k + 1], trace.q[k + 1]) = (self.x, self.w, q);
            for l in 0..WIDTH {
                high[l] = if q[l] > high[l] { q[l] } else { high[l] };
                low[l] = if q[l] < low[l] { q[l] } else { low[l] };
            }
        }
        [high, low]
    }
    /// h, X₀ and f₁X₁ of a short step for one vector of the machine.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn integrals<S: pulp::Simd, const N: usize>(&self, simd: S, c: &Constants<'_>, s: &Step, i: usize) -> [S::f64s; 3] {
        let (omega, square_inverse) = (S::as_simd_f64s(&self.omega).0[i], S::as_simd_f64s(&self.square_inverse).0[i]);
        let tau = simd.mul_f64s(omega, simd.splat_f64s(s.dt));
        let square = simd.mul_f64s(tau, tau);
        let x0 = series::<S, N>(simd, &c.series.x0, tau, square);
        let x1 = series::<S, N>(simd, &c.series.x1, tau, square);
        let (x0, x1) = (simd.mul_f64s(x0, square), simd.mul_f64s(x1, simd.mul_f64s(square, tau)));
        let h = simd.mul_add_e_f64s(simd.splat_f64s(-2.0 * c.modes.zeta), x0, simd.sub_f64s(tau, x1));
        let f1 = simd.mul_f64s(simd.splat_f64s(-s.slope), square_inverse);
        [h, x0, simd.mul_f64s(f1, x1)]
    }
    /// x and w after one step.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn step<S: pulp::Simd>(
        &self,
        simd: S,
        c: &Constants<'_>,
        s: &Step,
        i: usize,
        [h, x0, ramp]: [S::f64s; 3],
        (x, w): (S::f64s, S::f64s),
    ) -> (S::f64s, S::f64s) {
        let (inverse, square_inverse) =
            (S::as_simd_f64s(&self.inverse).0[i], S::as_simd_f64s(&self.square_inverse).0[i]);
        let Modes { sigma, rho, p, .. } = *c.modes;
        let (plus, minus) = (simd.splat_f64s(sigma), simd.splat_f64s(-sigma));
        let f0 = simd.mul_f64s(simd.splat_f64s(-s.from), inverse);
        let f1 = simd.mul_f64s(simd.splat_f64s(-s.slope), square_inverse);
        let y = simd.mul_add_e_f64s(minus, x, w);
        let pull = simd.mul_add_e_f64s(simd.splat_f64s(-p), x, f0);
        let pull = simd.mul_add_e_f64s(simd.splat_f64s(-rho), w, pull);
        let push = simd.mul_add_e_f64s(plus, f0, simd.sub_f64s(f1, w));
        let dx = simd.mul_add_e_f64s(x0, simd.sub_f64s(f0, x), simd.mul_add_e_f64s(h, y, ramp));
        let dw = simd.mul_add_e_f64s(x0, push, simd.mul_f64s(plus, ramp));
        (simd.add_f64s(x, dx), simd.add_f64s(w, simd.mul_add_e_f64s(h, pull, dw)))
    }
    /// All steps of a block; what there is at the ends of each goes into `trace`. The largest and smallest samples.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn through<S: pulp::Simd>(
        &mut self,
        simd: S,
        c: &Constants<'_>,
        block: &Block<'_>,
        trace: &mut Trace,
    ) -> [Many; 2] {
        let [r0, r1] = c.modes.rows[self.row];
        (trace.x[0], trace.w[0]) = (self.x, self.w);
        trace.q[0] = std::array::from_fn(|l| r0 * self.x[l] + r1 * self.w[l]);
        match self.terms(c.modes, block.longest) {
            Some(4) => self.short::<S, 4>(simd, c, block, trace),
            Some(7) => self.short::<S, 7>(simd, c, block, trace),
            Some(10) => self.short::<S, 10>(simd, c, block, trace),
            Some(14) => self.short::<S, 14>(simd, c, block, trace),
            Some(_) => self.short::<S, TERMS>(simd, c, block, trace),
            None => self.any(simd, c, block, trace),
        }
    }
    /// Terms of the series that a time needs at the highest frequency; `None` if it is too long.
    fn terms(&self, modes: &Modes, time: f64) -> Option<usize> {
        let s = (1.0 + 2.0 * modes.zeta) * self.omega.iter().copied().fold(0.0, f64::max) * time;
        SHORT.iter().find(|(up_to, _)| s <= *up_to).map(|(_, terms)| *terms)
    }
    /// Whether no oscillator can reach a new extreme within a block, also between samples.
    ///
    /// √(x² + y²) grows by no more than the velocity that the acceleration adds; q stays below a multiple of it, and
    /// within reach of where it begins.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn stays(&self, modes: &Modes, block: &Block<'_>) -> bool {
        let [r0, r1] = modes.rows[self.row];
        let damp = 2.0 * modes.zeta;
        let (most, slope, push) = match self.row {
            Modes::DISPLACEMENT => (1.0, 1.0, 0.0),
            Modes::VELOCITY => (1.0, 1.0 + damp, 1.0),
            _ => (1.0_f64.hypot(damp), 1.0 + damp + damp * damp, damp),
        };
        let span = block.span();
        let mut stays = [0_u64; WIDTH];
        for l in 0..WIDTH {
            let y = self.w[l] - modes.sigma * self.x[l];
            let q = r0 * self.x[l] + r1 * self.w[l];
            let size = (self.x[l] * self.x[l] + y * y).sqrt() + block.added;
            let far = most * size;
            let near = slope * (self.omega[l] * span) * size + push * block.added;
            let up = if q + near < far { q + near } else { far };
            let down = if q - near > -far { q - near } else { -far };
            stays[l] = u64::from(size > SMALLEST) & u64::from(up <= self.high[l]) & u64::from(down >= self.low[l]);
        }
        !stays.contains(&0)
    }
    /// Across a block in one leap or in a few, if they are short enough.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn leap<S: pulp::Simd>(&mut self, simd: S, c: &Constants<'_>, block: &Block<'_>) -> bool {
        for (longest, leaps) in &block.leaps {
            match self.terms(c.modes, *longest) {
                Some(4 | 7) => self.across::<S, 7>(simd, c, leaps),
                Some(10 | 14) => self.across::<S, 14>(simd, c, leaps),
                Some(_) => self.across::<S, TERMS>(simd, c, leaps),
                None => continue,
            }
            return true;
        }
        false
    }
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn across<S: pulp::Simd, const N: usize>(&mut self, simd: S, c: &Constants<'_>, leaps: &[Leap]) {
        let Modes { sigma, rho, p, .. } = *c.modes;
        for leap in leaps {
            for i in 0..WIDTH / S::F64_LANES {
                let tau = simd.mul_f64s(S::as_simd_f64s(&self.omega).0[i], simd.splat_f64s(leap.span));
                let square = simd.mul_f64s(tau, tau);
                let x0 = series::<S, N>(simd, &c.series.x0, tau, square);
                let h = series::<S, N>(simd, &c.series.h, tau, square);
                let driven_x = series::<S, N>(simd, &leap.x, tau, square);
                let driven_w = series::<S, N>(simd, &leap.w, tau, square);
                let (x0, h) = (simd.mul_f64s(x0, square), simd.mul_f64s(h, tau));
                let (x, w) = (S::as_simd_f64s(&self.x).0[i], S::as_simd_f64s(&self.w).0[i]);
                let y = simd.mul_add_e_f64s(simd.splat_f64s(-sigma), x, w);
                let pull = simd.mul_add_e_f64s(simd.splat_f64s(rho), w, simd.mul_f64s(simd.splat_f64s(p), x));
                let less_x = simd.mul_add_e_f64s(x0, x, simd.mul_f64s(tau, driven_x));
                let dx = simd.sub_f64s(simd.mul_f64s(h, y), less_x);
                let less_w = simd.mul_add_e_f64s(h, pull, simd.mul_add_e_f64s(x0, w, driven_w));
                S::as_mut_simd_f64s(&mut self.x).0[i] = simd.add_f64s(x, dx);
                S::as_mut_simd_f64s(&mut self.w).0[i] = simd.sub_f64s(w, less_w);
            }
        }
    }
    /// Numbers too small for full speed are nothing.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn flush(&mut self) {
        for l in 0..WIDTH {
            self.x[l] = if self.x[l].abs() < TINY { 0.0 } else { self.x[l] };
            self.w[l] = if self.w[l].abs() < TINY { 0.0 } else { self.w[l] };
        }
    }
    /// How far each quantity can rise between the samples of a block above the largest of them; nothing where it stays
    /// within what it has reached before.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn bumps(&self, modes: &Modes, block: &Block<'_>, trace: &Trace, [high, low]: &[Many; 2]) -> [Option<f64>; WIDTH] {
        let (x, w) = (&trace.x[0], &trace.w[0]);
        let [a, b] = modes.rows[self.row];
        let reach = a.abs() + b.abs() * modes.tilt;
        let (mut bump, mut may) = ([0.0; WIDTH], [0_u64; WIDTH]);
        for l in 0..WIDTH {
            let y = w[l] - modes.sigma * x[l];
            // |x| and |y| stay within v: √(x² + y²) grows by no more than |f|.
            let v = x[l].abs() + y.abs() + block.added;
            let (f, slope) = (block.peak * self.inverse[l], block.steepest * self.square_inverse[l]);
            let q = if high[l] > -low[l] { high[l] } else { -low[l] };
            bump[l] = share_of_bend(self.omega[l] * block.longest) * (q + modes.bend_beside(self.row, v, f, slope));
            let rises = u64::from(high[l] + bump[l] > self.high[l]) | u64::from(low[l] - bump[l] < self.low[l]);
            let far = u64::from(reach * v > self.high[l]) | u64::from(reach * v > -self.low[l]);
            may[l] = rises & far;
        }
        let mut found = [None; WIDTH];
        if may.contains(&1) {
            for l in (0..self.count).filter(|&l| may[l] == 1) {
                found[l] = Some(bump[l]);
            }
        }
        found
    }
    /// Searches the steps of a block for peaks of oscillator `l`; none rises by more than `most` between its samples.
    #[inline(never)]
    fn search(&mut self, segment: &mut Segment, block: &Block<'_>, trace: &Trace, l: usize, most: f64) {
        let modes = segment.modes();
        let (omega, steps) = (self.omega[l], block.steps);
        let mut range = Range::outside(self.low[l], self.high[l]);
        for (k, q) in trace.q[..=steps.len()].iter().enumerate() {
            range.note(k, 0.0, q[l]);
        }
        for (k, s) in steps.iter().enumerate() {
            let [q, q_next] = [trace.q[k][l], trace.q[k + 1][l]];
            let (top, bottom) = if q > q_next { (q, q_next) } else { (q_next, q) };
            if top + most <= range.high.value && bottom - most >= range.low.value {
                continue;
            }
            let m = Motion { x: trace.x[k][l], w: trace.w[k][l] };
            let bump = self.bump(modes, l, m, s, top.max(-bottom));
            if top + bump > range.high.value || bottom - bump < range.low.value {
                let span = segment.begin_line(m, omega, s.dt, s.from, s.to);
                let end = segment.sample_known(span.hi, Motion { x: trace.x[k + 1][l], w: trace.w[k + 1][l] });
                segment.extremes(self.row, &end, k, &mut range);
            }
        }
        let time = |k: usize| steps.get(k).map_or_else(|| steps[k - 1].end, |s| s.start);
        let Peaks { high, low } = range.peaks(omega, time);
        if high.value > self.high[l] {
            (self.high[l], self.peaks[l].high) = (high.value, high);
        }
        if low.value < self.low[l] {
            (self.low[l], self.peaks[l].low) = (low.value, low);
        }
    }
    /// How far the quantity can rise within one step that begins with `m`, above `q`, what it reaches at its ends.
    fn bump(&self, modes: &Modes, l: usize, m: Motion, s: &Step, q: f64) -> f64 {
        let peak = s.from.abs().max(s.to.abs());
        let v = m.x.abs() + (m.w - modes.sigma * m.x).abs() + s.dt * peak;
        let (f, slope) = (peak * self.inverse[l], s.slope.abs() * self.square_inverse[l]);
        share_of_bend(self.omega[l] * s.dt) * (q + modes.bend_beside(self.row, v, f, slope))
    }
}

/// The first `N` terms of a series in powers of `t`, whose square is given: even and odd ones side by side, that fewer
/// wait for another.
#[inline(always)]
#[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
fn series<S: pulp::Simd, const N: usize>(simd: S, terms: &[f64; TERMS], t: S::f64s, square: S::f64s) -> S::f64s {
    // A loop, where closures of an iterator would not take on the instruction set.
    let mut sums = [simd.splat_f64s(terms[N - 1]), simd.splat_f64s(terms[N - 2])];
    for k in (0..N - 2).rev() {
        let sum = &mut sums[(N - 1 - k) % 2];
        *sum = simd.mul_add_e_f64s(*sum, square, simd.splat_f64s(terms[k]));
    }
    let [odd, even] = if N % 2 == 0 { sums } else { [sums[1], sums[0]] };
    simd.mul_add_e_f64s(odd, t, even)
}

/// One group through some blocks, on the widest instructions of the machine.
struct Run<'a> {
    group: &'a mut Group,
    constants: Constants<'a>,
    blocks: &'a [Block<'a>],
}

impl pulp::WithSimd for Run<'_> {
    type Output = ();
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { group, constants, blocks } = self;
        let modes = constants.modes;
        let (mut trace, mut segment) = (Trace::new(), Segment::new(modes));
        for block in blocks {
            group.flush();
            if group.stays(modes, block) && group.leap(simd, &constants, block) {
                continue;
            }
            let samples = group.through(simd, &constants, block, &mut trace);
            let bumps = group.bumps(modes, block, &trace, &samples);
            for (l, bump) in bumps.iter().enumerate() {
                if let Some(most) = bump {
                    group.search(&mut segment, block, &trace, l, *most);
                }
            }
        }
    }
}

impl UnevenFilter {
    /// A filter for samples at any times.
    ///
    /// # Accuracy
    ///
    /// Exact for a history that is linear between samples, but for rounding: for steps of 10⁻⁹ to 10 periods and beyond,
    /// at any damping, for samples of up to 10¹⁰⁰ m/s² ([`crate::accuracy::RECORD`]). The component is at rest before the
    /// first sample; after the last the acceleration is zero and the ring-down is complete.
    ///
    /// # Examples
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Frequencies, Quantity, UnevenFilter};
    /// let mut filter = UnevenFilter::new(
    ///     Frequencies::list(vec![10.0])?,
    ///     DampingRatio::new(0.0)?,
    ///     Quantity::AbsoluteAcceleration,
    /// );
    /// filter.push(&[2.0, 2.01, 2.05], &[1.0, 1.0, 1.0])?; // a rectangle of half a period doubles
    /// let spectrum = filter.finish()?;
    /// assert!((spectrum.maximax[0] - 2.0).abs() < 1e-12);
    /// assert!((spectrum.time_of_peak_s[0] - 2.05).abs() < 1e-8);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn new(frequencies: Frequencies, damping: DampingRatio, quantity: Quantity) -> Self {
        let omegas: Vec<f64> = frequencies.hz().iter().map(|f| TAU * f).collect();
        let groups = omegas.chunks(WIDTH).map(|chunk| Group::new(chunk, quantity.row(chunk[0]).0)).collect();
        let modes = Modes::new(damping);
        let series = Series::new(&modes);
        Self { frequencies, damping, quantity, modes, series, groups, last: None, count: 0 }
    }
    /// Takes in more samples: their times in seconds, in order, and the base acceleration there. Two samples at one time
    /// are a jump.
    ///
    /// # Errors
    /// [`Error::Entry`] for a value that is not finite, [`Error::TimeOrder`] where times run back, entries counted from
    /// the first sample of all; [`Error::Lengths`] unless there are as many times as accelerations. Nothing of the piece
    /// is then taken in.
    pub fn push(&mut self, times_s: &[f64], accelerations: &[f64]) -> Result<(), Error> {
        self.check(times_s, accelerations)?;
        self.count = self.count.saturating_add(times_s.len());
        let mut samples = times_s.iter().copied().zip(accelerations.iter().copied());
        if self.last.is_none() {
            self.last = samples.next();
            let start = self.last.map_or(0.0, |sample| sample.0);
            for group in &mut self.groups {
                let rest = Peak { value: 0.0, time: start };
                group.peaks = [Peaks { high: rest, low: rest }; WIDTH];
            }
        }
        let Some(mut last) = self.last else { return Ok(()) };
        let mut steps = Vec::with_capacity(CHUNK.min(times_s.len()));
        for (time, a) in samples {
            let dt = time - last.0;
            let slope = (a - last.1) / dt;
            // A step too short for a slope moves nothing.
            if dt > 0.0 && slope.is_finite() {
                steps.push(Step { start: last.0, end: time, dt, from: last.1, to: a, slope });
            }
            last = (time, a);
            if steps.len() == CHUNK {
                self.run(&steps);
                steps.clear();
            }
        }
        self.run(&steps);
        self.last = Some(last);
        Ok(())
    }
    fn check(&self, times_s: &[f64], accelerations: &[f64]) -> Result<(), Error> {
        if times_s.len() != accelerations.len() {
            return Err(Error::Lengths { times: times_s.len(), values: accelerations.len() });
        }
        let mut previous = self.last.map_or(f64::NEG_INFINITY, |sample| sample.0);
        for (i, (&time, &a)) in times_s.iter().zip(accelerations).enumerate() {
            let entry = self.count.saturating_add(i + 1);
            for (name, value) in [("time", time), ("acceleration", a)] {
                if !value.is_finite() {
                    return Err(Error::Entry { list: RECORD, entry, name, value, allowed: "finite" });
                }
            }
            if time < previous {
                return Err(Error::TimeOrder { list: RECORD, entry, time, previous });
            }
            previous = time;
        }
        Ok(())
    }
    fn run(&mut self, steps: &[Step]) {
        let blocks: Vec<Block<'_>> = steps.chunks(BLOCK).map(|steps| Block::new(&self.series, steps)).collect();
        let arch = pulp::Arch::new();
        let constants = Constants { modes: &self.modes, series: &self.series };
        for group in &mut self.groups {
            arch.dispatch(Run { group, constants, blocks: &blocks });
        }
    }
    /// The spectrum, with the ring-down after the last sample.
    /// # Errors
    /// [`Error::Empty`] if no sample came.
    pub fn finish(self) -> Result<Spectrum, Error> {
        let (end, _) = self.last.ok_or(Error::Empty(RECORD))?;
        Ok(Spectrum::collect(&self.frequencies, self.damping, self.quantity, |i, omega, k| {
            let (group, l) = (&self.groups[i / WIDTH], i % WIDTH);
            let mut after = Range::default();
            after.note_free(&self.modes, k, Motion { x: group.x[l], w: group.w[l] }, f64::INFINITY, 0);
            [group.peaks[l], after.peaks(omega, |_| end)]
        }))
    }
}

const RECORD: &str = "record";
