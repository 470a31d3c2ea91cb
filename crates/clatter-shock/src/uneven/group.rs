//! The response of eight parts side by side to the steps of an uneven record.

use super::BLOCK;
use super::steps::{Block, Leap, Series, Step, TERMS};
use crate::eight::{LARGEST_ANGLE, Many, WIDTH};
use crate::filter::share_of_bend;
use crate::forced::{Ramps, Segment};
use crate::peaks::{Peaks, Range};
use crate::side_by_side::Step as Free;
use crate::suspension::{Modes, Motion};

/// Lengths s = (1 + 2ζ)τ up to which the error of a series of so many terms is less than half a rounding, sⁿ/(n + 1)!.
const SHORT: [(f64, usize); 6] = [(2.4e-4, 4), (0.02, 7), (0.13, 10), (0.5, 14), (1.0, 18), (SHORTEST_LONG, TERMS)];
/// The length from which on closed forms lose nothing to their differences.
const SHORTEST_LONG: f64 = 2.0;
/// Smaller numbers would slow the machine down; they are far below one rounding of anything that is compared.
const TINY: f64 = 1e-280;
/// Smaller motions are not bounded by their squares.
const SMALLEST: f64 = 1e-140;

/// Constants that all groups share.
#[derive(Debug, Clone, Copy)]
pub(super) struct Constants<'a> {
    pub(super) modes: &'a Modes,
    pub(super) series: &'a Series,
}

/// Oscillators of eight natural frequencies; the last group repeats its last one.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(super) struct Group {
    omega: Many,
    /// 1/ω and its square.
    inverse: Many,
    square_inverse: Many,
    pub(super) x: Many,
    pub(super) w: Many,
    high: Many,
    low: Many,
    row: usize,
    /// Number of wanted oscillators.
    count: usize,
    pub(super) peaks: [Peaks; WIDTH],
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
    pub(super) fn new(omegas: &[f64], row: usize) -> Self {
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
    /// Crosses short steps by `N` terms of the series.
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
        // The vectors of the machine are named: the compiler alone leaves these loops to scalars.
        for i in 0..WIDTH / S::F64_LANES {
            // Terms that depend on the steps alone come first, so that no step waits for the one before.
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
                let q = simd.mul_add_f64s(r0, x, simd.mul_f64s(r1, w));
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
    /// Crosses one step by closed forms, and returns x and w.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn long(&self, modes: &Modes, s: &Step) -> (Many, Many) {
        let (mut x, mut w, mut tau) = (self.x, self.w, [0.0; WIDTH]);
        let mut tame = true;
        for (tau, omega) in tau.iter_mut().zip(&self.omega) {
            *tau = omega * s.dt;
            tame &= *tau < LARGEST_ANGLE;
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
    /// Crosses one step at any frequencies, and returns x and w.
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
    /// Crosses steps of which some are long, each by the form for its length.
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
                let long = self.long(modes, s);
                for (l, short) in short.into_iter().enumerate() {
                    (next.0[l], next.1[l]) = if short { (next.0[l], next.1[l]) } else { (long.0[l], long.1[l]) };
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
    /// Returns h, X₀ and f₁X₁ of a short step for one vector of the machine.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn integrals<S: pulp::Simd, const N: usize>(&self, simd: S, c: &Constants<'_>, s: &Step, i: usize) -> [S::f64s; 3] {
        let (omega, square_inverse) = (S::as_simd_f64s(&self.omega).0[i], S::as_simd_f64s(&self.square_inverse).0[i]);
        let tau = simd.mul_f64s(omega, simd.splat_f64s(s.dt));
        let square = simd.mul_f64s(tau, tau);
        let x0 = series::<S, N>(simd, &c.series.x0, tau, square);
        let x1 = series::<S, N>(simd, &c.series.x1, tau, square);
        let (x0, x1) = (simd.mul_f64s(x0, square), simd.mul_f64s(x1, simd.mul_f64s(square, tau)));
        let h = simd.mul_add_f64s(simd.splat_f64s(-2.0 * c.modes.zeta), x0, simd.sub_f64s(tau, x1));
        let f1 = simd.mul_f64s(simd.splat_f64s(-s.slope), square_inverse);
        [h, x0, simd.mul_f64s(f1, x1)]
    }
    /// Returns x and w after one step.
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
        let y = simd.mul_add_f64s(minus, x, w);
        let pull = simd.mul_add_f64s(simd.splat_f64s(-p), x, f0);
        let pull = simd.mul_add_f64s(simd.splat_f64s(-rho), w, pull);
        let push = simd.mul_add_f64s(plus, f0, simd.sub_f64s(f1, w));
        let dx = simd.mul_add_f64s(x0, simd.sub_f64s(f0, x), simd.mul_add_f64s(h, y, ramp));
        let dw = simd.mul_add_f64s(x0, push, simd.mul_f64s(plus, ramp));
        (simd.add_f64s(x, dx), simd.add_f64s(w, simd.mul_add_f64s(h, pull, dw)))
    }
    /// Crosses all steps of a block, stores the state at the ends of each in `trace`, and returns the largest and
    /// smallest samples.
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
            Some(18) => self.short::<S, 18>(simd, c, block, trace),
            Some(_) => self.short::<S, TERMS>(simd, c, block, trace),
            None => self.any(simd, c, block, trace),
        }
    }
    /// Returns the number of terms of the series that a time needs at the highest frequency; `None` if the time is too
    /// long.
    fn terms(&self, modes: &Modes, time: f64) -> Option<usize> {
        let s = (1.0 + 2.0 * modes.zeta) * self.omega.iter().copied().fold(0.0, f64::max) * time;
        SHORT.iter().find(|(up_to, _)| s <= *up_to).map(|(_, terms)| *terms)
    }
    /// Returns whether no oscillator can reach a new extreme within a block, also between samples.
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
            _ => (libm::hypot(1.0, damp), 1.0 + damp + damp * damp, damp),
        };
        let span = block.span();
        let mut stays = [0_u64; WIDTH];
        for (l, stays) in stays.iter_mut().enumerate() {
            let y = self.w[l] - modes.sigma * self.x[l];
            let q = r0 * self.x[l] + r1 * self.w[l];
            let size = (self.x[l] * self.x[l] + y * y).sqrt() + block.added;
            let far = most * size;
            let near = slope * (self.omega[l] * span) * size + push * block.added;
            let up = if q + near < far { q + near } else { far };
            let down = if q - near > -far { q - near } else { -far };
            *stays = u64::from(size > SMALLEST) & u64::from(up <= self.high[l]) & u64::from(down >= self.low[l]);
        }
        !stays.contains(&0)
    }
    /// Crosses a block in one leap or in a few, and returns whether they are short enough.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn leap<S: pulp::Simd>(&mut self, simd: S, c: &Constants<'_>, block: &Block<'_>) -> bool {
        for (longest, leaps) in &block.leaps {
            match self.terms(c.modes, *longest) {
                Some(4 | 7) => self.across::<S, 7>(simd, c, leaps),
                Some(10 | 14) => self.across::<S, 14>(simd, c, leaps),
                Some(18) => self.across::<S, 18>(simd, c, leaps),
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
                let driven_x = powers::<S, N>(simd, &leap.x, tau, square);
                let driven_w = powers::<S, N>(simd, &leap.w, tau, square);
                let (x0, h) = (simd.mul_f64s(x0, square), simd.mul_f64s(h, tau));
                let (x, w) = (S::as_simd_f64s(&self.x).0[i], S::as_simd_f64s(&self.w).0[i]);
                let y = simd.mul_add_f64s(simd.splat_f64s(-sigma), x, w);
                let pull = simd.mul_add_f64s(simd.splat_f64s(rho), w, simd.mul_f64s(simd.splat_f64s(p), x));
                let less_x = simd.mul_add_f64s(x0, x, simd.mul_f64s(tau, driven_x));
                let dx = simd.sub_f64s(simd.mul_f64s(h, y), less_x);
                let less_w = simd.mul_add_f64s(h, pull, simd.mul_add_f64s(x0, w, driven_w));
                S::as_mut_simd_f64s(&mut self.x).0[i] = simd.add_f64s(x, dx);
                S::as_mut_simd_f64s(&mut self.w).0[i] = simd.sub_f64s(w, less_w);
            }
        }
    }
    /// Sets numbers too small for full speed to 0.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn flush(&mut self) {
        for l in 0..WIDTH {
            self.x[l] = if self.x[l].abs() < TINY { 0.0 } else { self.x[l] };
            self.w[l] = if self.w[l].abs() < TINY { 0.0 } else { self.w[l] };
        }
    }
    /// Returns bounds on the rise of each quantity between the samples of a block above the largest of them; `None`
    /// where it stays within its earlier range.
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
            bump[l] = share_of_bend(self.omega[l] * block.longest) * (q + modes.bend_bound(self.row, v, f, slope));
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
    /// Returns a bound on the rise of the quantity within one step that begins with `m`, above `q`, the larger of its
    /// values at the ends.
    fn bump(&self, modes: &Modes, l: usize, m: Motion, s: &Step, q: f64) -> f64 {
        let peak = s.from.abs().max(s.to.abs());
        let v = m.x.abs() + (m.w - modes.sigma * m.x).abs() + s.dt * peak;
        let (f, slope) = (peak * self.inverse[l], s.slope.abs() * self.square_inverse[l]);
        share_of_bend(self.omega[l] * s.dt) * (q + modes.bend_bound(self.row, v, f, slope))
    }
}

/// Returns the sum of the first `N` terms of a series in powers of `t`, whose square is given: even and odd ones side
/// by side, so that fewer wait for another.
#[inline(always)]
#[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
fn series<S: pulp::Simd, const N: usize>(simd: S, terms: &[Many; TERMS], t: S::f64s, square: S::f64s) -> S::f64s {
    // This is a loop: closures of an iterator would not take on the instruction set.
    let mut sums = [S::as_simd_f64s(&terms[N - 1]).0[0], S::as_simd_f64s(&terms[N - 2]).0[0]];
    for k in (0..N - 2).rev() {
        let sum = &mut sums[(N - 1 - k) % 2];
        *sum = simd.mul_add_f64s(*sum, square, S::as_simd_f64s(&terms[k]).0[0]);
    }
    let [odd, even] = if N.is_multiple_of(2) { sums } else { [sums[1], sums[0]] };
    simd.mul_add_f64s(odd, t, even)
}

/// Returns the same sum for terms that are stored once.
#[inline(always)]
#[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
fn powers<S: pulp::Simd, const N: usize>(simd: S, terms: &[f64; TERMS], t: S::f64s, square: S::f64s) -> S::f64s {
    // This is a loop: closures of an iterator would not take on the instruction set.
    let mut sums = [simd.splat_f64s(terms[N - 1]), simd.splat_f64s(terms[N - 2])];
    for k in (0..N - 2).rev() {
        let sum = &mut sums[(N - 1 - k) % 2];
        *sum = simd.mul_add_f64s(*sum, square, simd.splat_f64s(terms[k]));
    }
    let [odd, even] = if N.is_multiple_of(2) { sums } else { [sums[1], sums[0]] };
    simd.mul_add_f64s(odd, t, even)
}

/// The run of one group through some blocks, on the widest instructions of the machine.
pub(super) struct Run<'a> {
    pub(super) group: &'a mut Group,
    pub(super) constants: Constants<'a>,
    pub(super) blocks: &'a [Block<'a>],
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
