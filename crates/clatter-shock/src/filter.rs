//! Spectra of evenly sampled records: the ramp-invariant recursive filter of ISO 18431-4, many frequencies at a time.
//!
//! Between samples the acceleration is taken to be linear, and for such a history the filter is exact. It carries the
//! wanted quantity and one more coordinate, u and v, less the immediate effect of the newest sample:
//!
//! ```text
//! (u, v)ₖ₊₁ = (u, v)ₖ + N (u, v)ₖ + c aₖ,    qₖ₊₁ = uₖ₊₁ + d aₖ₊₁
//! ```
//!
//! The entries of N and c come from series where the step is short, and the sum is kept as an increment, so that
//! nothing cancels at frequencies far below the sampling rate. Samples are taken a block at a time. Where a bound on
//! the motion says that a block can hold no new extreme, one matrix and one weighted sum carry the filter across it.
//! Where a bound says that a peak between samples may pass the largest sample, the steps are gone through one by one
//! and the peak is found exactly.

use crate::eight::{Many, WIDTH};
use crate::forced::Segment;
use crate::integrals::Integrals;
use crate::peaks::Range;
use crate::suspension::{Modes, Motion, Phase};
use crate::{DampingRatio, Error, Frequencies, Quantity, Spectrum};
use std::f64::consts::TAU;

/// Samples between two bounds.
const BLOCK: usize = 32;
/// The number of samples in a block as a float.
const STEPS: f64 = 32.0;
/// Samples gone through for one group of frequencies before the next: they stay in the nearest cache.
const CHUNK: usize = 4096;
/// The number of samples from which on it pays to prepare for whole blocks at once.
const WORTH: usize = 4 * BLOCK;
/// Smaller numbers would slow the machine down; they are far below one rounding of anything that is compared.
const TINY: f64 = 1e-280;
/// Smaller extremes are not compared by their squares.
const SMALLEST: f64 = 1e-140;

/// A shock response spectrum in progress. Samples come in pieces of any size; memory does not grow.
#[derive(Debug, Clone)]
pub struct SpectrumFilter {
    frequencies: Frequencies,
    damping: DampingRatio,
    quantity: Quantity,
    modes: Modes,
    groups: Vec<Group>,
    previous: Option<f64>,
    /// Time of the first sample, and the number of steps since.
    start_s: f64,
    steps: usize,
    /// Integrals of the record, kept as long as the softest oscillator may need them.
    integrals: Option<Integrals>,
}

/// Oscillators of eight natural frequencies, each field whole in lines of the cache.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
struct Group {
    /// N row by row, c, d of each oscillator.
    n: [Many; 4],
    c: [Many; 2],
    d: Many,
    u: Many,
    v: Many,
    /// Factors of u, v and the newest sample in x and in y.
    back: [[Many; 3]; 2],
    /// Extremes so far, at least those of the samples; infinite where there is no oscillator.
    high: Many,
    low: Many,
    reach: Reach,
    oscillators: Vec<Oscillator>,
}

/// Bounds on the change of a quantity within a block.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
struct Reach {
    /// Bound on its change within a block over √(x² + y²), and bound on itself over that.
    drift: Many,
    most: f64,
    /// Factors of x and y in it.
    of: [f64; 2],
    /// Change by a unit jump of velocity.
    push: f64,
    /// Time between samples.
    dt: f64,
}

impl Reach {
    fn new(zeta: f64, row: usize, dt: f64) -> Self {
        let damp = 2.0 * zeta;
        let (of, slope) = match row {
            Modes::DISPLACEMENT => ([1.0, 0.0], 1.0),
            Modes::VELOCITY => ([0.0, 1.0], 1.0 + damp),
            _ => ([-1.0, -damp], 1.0 + damp + damp * damp),
        };
        Self { of, most: libm::hypot(of[0], of[1]), drift: [slope * STEPS; WIDTH], push: of[1].abs(), dt }
    }
}

/// The recursion of one frequency: N row by row, c and d.
#[derive(Debug, Clone, Copy)]
struct Recursion {
    n: [f64; 4],
    c: [f64; 2],
    d: f64,
}

/// The data of the oscillator of one frequency, apart from those of the filter.
#[derive(Debug, Clone)]
struct Oscillator {
    theta: f64,
    row: usize,
    recursion: Recursion,
    /// Matrix from (u, v) back to (x, w).
    back: [[f64; 2]; 2],
    /// Immediate effect of the newest sample on (x, w).
    newest: Motion,
    /// The same effect on (u, v).
    at_once: [f64; 2],
    /// 1/ω and 1/(ωθ).
    inverse: [f64; 2],
    /// Share of the bend, see [`share_of_bend`].
    share: f64,
    range: Range,
}

/// Samples that are processed at a time, the one before them, and bounds on each block of them and on all.
struct Chunk<'a> {
    previous: f64,
    samples: &'a [f64],
    inputs: &'a [Input],
    total: Input,
}

/// Bounds on the acceleration over some samples and the one before them: sum and largest of absolute values, and the
/// largest jump.
#[derive(Debug, Clone, Copy)]
struct Input {
    before: f64,
    sum: f64,
    peak: f64,
    jump: f64,
}

/// State at the begin of a block, and its largest and smallest sample, that before it included, of each oscillator.
#[derive(Clone, Copy)]
struct Block {
    /// Its number, from 0.
    index: usize,
    u: Many,
    v: Many,
    high: Many,
    low: Many,
}

impl Input {
    fn new(mut before: f64, samples: &[f64]) -> Self {
        let mut input = Self { before, sum: before.abs(), peak: before.abs(), jump: 0.0 };
        for &a in samples {
            input.sum += a.abs();
            input.peak = input.peak.max(a.abs());
            input.jump = input.jump.max((a - before).abs());
            before = a;
        }
        input
    }
}

impl Input {
    /// Returns the bounds for all blocks together.
    fn all(blocks: &[Self]) -> Self {
        blocks.iter().fold(Self { before: 0.0, sum: 0.0, peak: 0.0, jump: 0.0 }, |all, b| Self {
            before: 0.0,
            sum: all.sum + b.sum,
            peak: all.peak.max(b.peak),
            jump: all.jump.max(b.jump),
        })
    }
}

impl Oscillator {
    fn new(modes: &Modes, omega: f64, dt: f64, row: usize) -> Self {
        let phase = Phase::product(omega, dt);
        let theta = phase.hi;
        let (step, ramp) = modes.driven(phase);
        // The forcing is −a/ω; in a step, the newer sample drives `newest`, the older one the rest of the constant.
        let scale = -omega.recip();
        let newest = Motion { x: scale * (ramp.x1 / theta), w: scale * (ramp.w1 / theta) };
        let older = Motion { x: scale * ramp.x0 - newest.x, w: scale * ramp.w0 - newest.w };
        // The free motion less the identity, without cancellation: 1 − c − ζs is the response to a constant.
        let (c, k) = if modes.kappa == 0.0 {
            let less = -ramp.x0 - modes.zeta * step.s;
            (less, less)
        } else {
            (libm::expm1(-modes.sigma * theta), libm::expm1(-modes.rho * theta))
        };
        let free = [[c, step.s], [-modes.p * step.s, k]];
        let [r0, r1] = modes.rows[row];
        // Second coordinate: x where the quantity is mostly w, else w.
        let (to, back) = if r1.abs() >= r0.abs() {
            ([[r0, r1], [1.0, 0.0]], [[0.0, 1.0], [1.0 / r1, -r0 / r1]])
        } else {
            ([[r0, r1], [0.0, 1.0]], [[1.0 / r0, -r1 / r0], [0.0, 1.0]])
        };
        let product = |a: [[f64; 2]; 2], b: [[f64; 2]; 2]| {
            let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
            [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
        };
        let n = product(product(to, free), back);
        let apply = |a: [[f64; 2]; 2], m: Motion| [a[0][0] * m.x + a[0][1] * m.w, a[1][0] * m.x + a[1][1] * m.w];
        // One input: c a with c = (1 + Φ − 1) newest + older.
        let moved = apply(free, newest);
        let input = apply(to, Motion { x: newest.x + moved[0] + older.x, w: newest.w + moved[1] + older.w });
        let at_once = apply(to, newest);
        let share = share_of_bend(theta);
        let inverse = [omega.recip(), (omega * theta).recip()];
        let recursion = Recursion { n: [n[0][0], n[0][1], n[1][0], n[1][1]], c: input, d: at_once[0] };
        Self { theta, row, recursion, back, newest, at_once, inverse, share, range: Range::default() }
    }
    /// Returns the motion at a sample, from the filter's coordinates and that sample.
    fn motion(&self, u: f64, v: f64, a: f64) -> Motion {
        let [x, w] = self.back;
        Motion { x: x[0] * u + x[1] * v + self.newest.x * a, w: w[0] * u + w[1] * v + self.newest.w * a }
    }
    /// Returns a bound on the rise of the quantity between samples, above all of them, where it reaches `q` at samples
    /// and the motion begins with `m`: θ²/8 of the largest bend, which q″ = −q − 2ζq′ + (input) bounds.
    #[inline]
    fn bump(&self, modes: &Modes, q: f64, m: Motion, input: &Input) -> f64 {
        let y = m.w - modes.sigma * m.x;
        // |x| and |y| stay within v: √(x² + y²) grows by no more than |f|.
        let v = m.x.abs() + y.abs() + self.theta * input.sum * self.inverse[0];
        let (f, slope) = (input.peak * self.inverse[0], input.jump * self.inverse[1]);
        self.share * (q + modes.bend_bound(self.row, v, f, slope))
    }
    /// Returns the bound on the rise of a block between its samples, if that may pass the largest value so far; `l` is
    /// the index of the oscillator.
    fn may_rise(&self, modes: &Modes, l: usize, b: &Block, input: &Input) -> Option<f64> {
        let m = self.motion(b.u[l], b.v[l], input.before);
        let q = modes.quantity(self.row, m).abs().max(b.high[l]).max(-b.low[l]);
        let bump = self.bump(modes, q, m, input);
        (b.high[l] + bump > self.range.high.value || b.low[l] - bump < self.range.low.value).then_some(bump)
    }
    /// Visits the steps of a block one by one; none of them rises by more than `most` between its samples. The block
    /// begins with step number `block`.
    fn refine(&mut self, segment: &mut Segment, l: usize, most: f64, (block, steps): (usize, &Steps), samples: &[f64]) {
        let modes = segment.modes();
        let (mut high, mut low) = (self.range.high.value - most, self.range.low.value + most);
        let mut from = steps.before;
        let mut q = steps.q[0][l];
        for (k, &to) in samples.iter().enumerate() {
            let q_next = steps.q[k + 1][l];
            let (top, bottom) = if q > q_next { (q, q_next) } else { (q_next, q) };
            if top > high || bottom < low {
                self.range.place(block, block + k, q);
                self.range.place(block, block + k + 1, q_next);
                let m = self.motion(steps.u[k][l], steps.v[k][l], from);
                let bump = self.bump(modes, top.max(-bottom), m, &Input::new(from, &[to]));
                if top + bump > self.range.high.value || bottom - bump < self.range.low.value {
                    let (f0, slope) = (-from * self.inverse[0], (from - to) * self.inverse[1]);
                    segment.begin(m, f0, slope, self.theta);
                    let m_next = self.motion(steps.u[k + 1][l], steps.v[k + 1][l], to);
                    let end = segment.sample_known(self.theta, m_next);
                    segment.extremes(self.row, &end, block + k, &mut self.range);
                    (high, low) = (self.range.high.value - most, self.range.low.value + most);
                }
            }
            (q, from) = (q_next, to);
        }
    }
}

impl Group {
    fn new(modes: &Modes, omegas: &[f64], dt: f64, row: usize) -> Self {
        let zero = [0.0; WIDTH];
        let mut group = Self {
            n: [zero; 4],
            c: [zero; 2],
            d: zero,
            u: zero,
            v: zero,
            back: [[zero; 3]; 2],
            high: [f64::INFINITY; WIDTH],
            low: [f64::NEG_INFINITY; WIDTH],
            oscillators: Vec::with_capacity(WIDTH),
            reach: Reach::new(modes.zeta, row, dt),
        };
        for (l, &omega) in omegas.iter().enumerate() {
            let oscillator = Oscillator::new(modes, omega, dt, row);
            let Recursion { n, c, d } = oscillator.recursion;
            for (to, from) in group.n.iter_mut().zip(n) {
                to[l] = from;
            }
            (group.c[0][l], group.c[1][l], group.d[l]) = (c[0], c[1], d);
            // Until the first sample, its immediate effect is subtracted (for a sample of 1; the first sample scales
            // it).
            (group.u[l], group.v[l]) = (-oscillator.at_once[0], -oscillator.at_once[1]);
            for (i, x) in [[1.0, 0.0], [-modes.sigma, 1.0]].into_iter().enumerate() {
                let of = |m: [f64; 2]| x[0] * m[0] + x[1] * m[1];
                let [to_x, to_w] = oscillator.back;
                group.back[i][0][l] = of([to_x[0], to_w[0]]);
                group.back[i][1][l] = of([to_x[1], to_w[1]]);
                group.back[i][2][l] = of([oscillator.newest.x, oscillator.newest.w]);
            }
            (group.high[l], group.low[l]) = (0.0, 0.0);
            group.reach.drift[l] *= oscillator.theta;
            group.oscillators.push(oscillator);
        }
        group
    }
    /// Processes some samples, the first of which ends step number `first`.
    fn run(&mut self, modes: &Modes, first: usize, chunk: &Chunk<'_>) {
        let start = [self.u, self.v];
        let &Chunk { previous, samples, inputs, .. } = chunk;
        let arch = pulp::Arch::new();
        let scanned = arch.dispatch(Scan { group: self, previous, samples, inputs });
        let blocks = &scanned.blocks;
        if blocks.is_empty() {
            return;
        }
        let mut segment = Segment::new(modes);
        let mut steps = Steps::new();
        let number = |b: &Block| first + b.index * BLOCK;
        // Oscillators side by side have their peaks in the same blocks.
        let retrace = |group: &Self, b: &Block, steps: &mut Steps| {
            if steps.index != Some(b.index) {
                (steps.index, steps.before) = (Some(b.index), inputs[b.index].before);
                arch.dispatch(Retrace { group, block: b, samples: block_of(samples, b.index), steps });
            }
        };
        let mut search = |group: &mut Self, l: usize, b: &Block| {
            if let Some(most) = group.oscillators[l].may_rise(modes, l, b, &inputs[b.index]) {
                retrace(group, b, &mut steps);
                let samples = block_of(samples, b.index);
                group.oscillators[l].refine(&mut segment, l, most, (number(b), &steps), samples);
            }
            if group.oscillators[l].range.is_unplaced(number(b)) {
                retrace(group, b, &mut steps);
                for (k, q) in steps.q.iter().take(block_of(samples, b.index).len() + 1).enumerate() {
                    group.oscillators[l].range.place(number(b), number(b) + k, q[l]);
                }
            }
        };
        // Blocks beyond these values may hold a new extreme; empty places have none.
        let (mut high, mut low) = ([f64::INFINITY; WIDTH], [f64::NEG_INFINITY; WIDTH]);
        for (l, oscillator) in self.oscillators.iter_mut().enumerate() {
            let (highest, lowest) = (&blocks[scanned.highest[l]], &blocks[scanned.lowest[l]]);
            oscillator.range.note_block(number(highest), highest.high[l]);
            oscillator.range.note_block(number(lowest), lowest.low[l]);
            let m = oscillator.motion(start[0][l], start[1][l], previous);
            let q = oscillator
                .range
                .high
                .value
                .max(-oscillator.range.low.value)
                .max(modes.quantity(oscillator.row, m).abs());
            let most = oscillator.bump(modes, q, m, &chunk.total);
            (high[l], low[l]) = (-most, most);
        }
        // The peak is likely in the blocks of the largest samples, and rules out most of the others.
        for likely in [&scanned.highest, &scanned.lowest] {
            for l in 0..self.oscillators.len() {
                search(self, l, &blocks[likely[l]]);
            }
        }
        for (l, oscillator) in self.oscillators.iter().enumerate() {
            (high[l], low[l]) = (high[l] + oscillator.range.high.value, low[l] + oscillator.range.low.value);
        }
        for b in blocks {
            let mut beyond = [0; WIDTH];
            for l in 0..WIDTH {
                beyond[l] = u64::from(b.high[l] > high[l]) | u64::from(b.low[l] < low[l]);
            }
            if !beyond.contains(&1) {
                continue;
            }
            for l in (0..self.oscillators.len()).filter(|l| beyond[*l] == 1) {
                let before = self.oscillators[l].range;
                search(self, l, b);
                let after = self.oscillators[l].range;
                high[l] += after.high.value - before.high.value;
                low[l] += after.low.value - before.low.value;
            }
        }
        for (l, oscillator) in self.oscillators.iter().enumerate() {
            (self.high[l], self.low[l]) = (oscillator.range.high.value, oscillator.range.low.value);
        }
    }
    /// Returns whether no oscillator can reach a new extreme within a block, also between samples.
    ///
    /// √(x² + y²) grows by no more than the velocity that the acceleration adds; q stays below a multiple of it, and
    /// within reach of where it begins.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn stays(&self, input: &Input, high: &Many, low: &Many) -> bool {
        let Reach { of, most, drift, push, dt } = &self.reach;
        let added = dt * input.sum;
        // These are numbers, so that no oscillator waits for another.
        let mut stays = [0; WIDTH];
        for l in 0..WIDTH {
            let coordinate =
                |[u, v, a]: &[Many; 3]| u[l].mul_add(self.u[l], v[l].mul_add(self.v[l], a[l] * input.before));
            let (x, y) = (coordinate(&self.back[0]), coordinate(&self.back[1]));
            let size = x.mul_add(x, y * y).sqrt() + added;
            let (q, far) = (of[0] * x + of[1] * y, most * size);
            let near = drift[l].mul_add(size, push * added);
            let up = if q + near < far { q + near } else { far };
            let down = if q - near > -far { q - near } else { -far };
            stays[l] = u64::from(size > SMALLEST) & u64::from(up <= high[l]) & u64::from(down >= low[l]);
        }
        !stays.contains(&0)
    }
    /// Crosses one block by the recursion without its values.
    #[inline(always)]
    fn leap<S: pulp::Simd>(&mut self, simd: S, leap: &Leap, before: f64, samples: &[f64]) {
        /// Number of sums side by side, so that none waits for another.
        const SUMS: usize = 4;
        let (across, (u, _), (v, _)) =
            (WIDTH / S::F64_LANES, S::as_mut_simd_f64s(&mut self.u), S::as_mut_simd_f64s(&mut self.v));
        let n = leap.n.each_ref().map(|n| S::as_simd_f64s(n).0);
        let (zero, tiny) = (simd.splat_f64s(0.0), simd.splat_f64s(TINY));
        // The vectors of the machine are named: the compiler alone splits these sums among scalars.
        for i in 0..across {
            let mut sums = [[zero; 2]; SUMS];
            for (k, w) in leap.w.as_chunks::<SUMS>().0.iter().enumerate() {
                for (j, (w, sum)) in w.iter().zip(&mut sums).enumerate() {
                    let a = if k + j == 0 { before } else { samples[SUMS * k + j - 1] };
                    let (w, a) = (S::as_simd_f64s(w).0, simd.splat_f64s(a));
                    *sum = [simd.mul_add_f64s(w[i], a, sum[0]), simd.mul_add_f64s(w[across + i], a, sum[1])];
                }
            }
            let add = |a, b| simd.add_f64s(a, b);
            let [sum_u, sum_v] = [0, 1].map(|h| add(add(sums[0][h], sums[1][h]), add(sums[2][h], sums[3][h])));
            let by = |a, b, c, d| simd.mul_add_f64s(a, b, simd.mul_f64s(c, d));
            let next_u = add(u[i], add(by(n[0][i], u[i], n[1][i], v[i]), sum_u));
            let next_v = add(v[i], add(by(n[3][i], v[i], n[2][i], u[i]), sum_v));
            let flush = |a| simd.select_f64s(simd.less_than_f64s(simd.abs_f64s(a), tiny), zero, a);
            (u[i], v[i]) = (flush(next_u), flush(next_v));
        }
    }
    /// Sets numbers too small for full speed to 0.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn flush(&mut self) {
        for l in 0..WIDTH {
            self.u[l] = if self.u[l].abs() < TINY { 0.0 } else { self.u[l] };
            self.v[l] = if self.v[l].abs() < TINY { 0.0 } else { self.v[l] };
        }
    }
    /// Runs the recursion over one block.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn scan(&mut self, index: usize, before: f64, samples: &[f64]) -> Block {
        let (u, v) = (self.u, self.v);
        let mut block = Block { index, u, v, high: [f64::NEG_INFINITY; WIDTH], low: [f64::INFINITY; WIDTH] };
        (self.u, self.v) = self.step_through([u, v], before, samples, |_, _, _, q| {
            for (l, &q) in q.iter().enumerate() {
                block.high[l] = if q > block.high[l] { q } else { block.high[l] };
                block.low[l] = if q < block.low[l] { q } else { block.low[l] };
            }
        });
        self.flush();
        block
    }
    /// Runs the recursion sample by sample, from (u, v): `each` gets the number of the sample and u, v and the quantity
    /// there, at number 0 those at the sample before.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn step_through(
        &self,
        [mut u, mut v]: [Many; 2],
        mut before: f64,
        samples: &[f64],
        mut each: impl FnMut(usize, &Many, &Many, &Many),
    ) -> (Many, Many) {
        let [n00, n01, n10, n11] = self.n;
        let ([c0, c1], d) = (self.c, self.d);
        let mut q: Many = std::array::from_fn(|l| d[l].mul_add(before, u[l]));
        each(0, &u, &v, &q);
        for (k, &a) in samples.iter().enumerate() {
            for l in 0..WIDTH {
                // Grouped for the shortest chain from one sample to the next.
                let from_v = n01[l].mul_add(v[l], c0[l] * before);
                let from_u = n10[l].mul_add(u[l], c1[l] * before);
                u[l] = n00[l].mul_add(u[l], u[l]) + from_v;
                v[l] = n11[l].mul_add(v[l], v[l]) + from_u;
                q[l] = d[l].mul_add(a, u[l]);
            }
            each(k + 1, &u, &v, &q);
            before = a;
        }
        (u, v)
    }
}

/// The steps of a block, computed once more: u, v and the quantity at each of its samples, and first at the one before.
struct Steps {
    /// Index of the block.
    index: Option<usize>,
    /// The sample before it.
    before: f64,
    u: [Many; BLOCK + 1],
    v: [Many; BLOCK + 1],
    q: [Many; BLOCK + 1],
}

impl Steps {
    fn new() -> Self {
        let none = [[0.0; WIDTH]; BLOCK + 1];
        Self { index: None, before: 0.0, u: none, v: none, q: none }
    }
}

/// Fills in the steps of a block, with the same numbers as the [`Scan`].
struct Retrace<'a> {
    group: &'a Group,
    block: &'a Block,
    samples: &'a [f64],
    steps: &'a mut Steps,
}

impl pulp::WithSimd for Retrace<'_> {
    type Output = ();
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.run();
    }
}

impl Retrace<'_> {
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn run(self) {
        let Self { group, block, samples, steps } = self;
        group.step_through([block.u, block.v], steps.before, samples, |k, u, v, q| {
            (steps.u[k], steps.v[k], steps.q[k]) = (*u, *v, *q);
        });
    }
}

/// Returns the samples of a block.
fn block_of(samples: &[f64], i: usize) -> &[f64] {
    &samples[i * BLOCK..samples.len().min((i + 1) * BLOCK)]
}

/// The run of one group through some samples, block by block, on the widest instructions of the machine.
struct Scan<'a> {
    group: &'a mut Group,
    previous: f64,
    samples: &'a [f64],
    inputs: &'a [Input],
}

/// The blocks that were computed sample by sample, and the indices of those with the largest and the smallest sample of
/// each oscillator.
struct Scanned {
    blocks: Vec<Block>,
    highest: [usize; WIDTH],
    lowest: [usize; WIDTH],
}

impl pulp::WithSimd for Scan<'_> {
    type Output = Scanned;
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Scanned {
        self.run(simd)
    }
}

impl Scan<'_> {
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn run<S: pulp::Simd>(self, simd: S) -> Scanned {
        let mut blocks = Vec::with_capacity(self.samples.len().div_ceil(BLOCK));
        let (mut highest, mut lowest) = ([0; WIDTH], [0; WIDTH]);
        let (mut high, mut low) = (self.group.high, self.group.low);
        let leap = (self.samples.len() >= WORTH).then(|| Leap::new(self.group));
        let mut before = self.previous;
        for (i, block) in self.samples.chunks(BLOCK).enumerate() {
            match &leap {
                Some(leap) if block.len() == BLOCK && self.group.stays(&self.inputs[i], &high, &low) => {
                    self.group.leap(simd, leap, before, block);
                }
                _ => {
                    let b = self.group.scan(i, before, block);
                    for l in 0..WIDTH {
                        let (higher, lower) = (b.high[l] > high[l], b.low[l] < low[l]);
                        (high[l], highest[l]) = if higher { (b.high[l], blocks.len()) } else { (high[l], highest[l]) };
                        (low[l], lowest[l]) = if lower { (b.low[l], blocks.len()) } else { (low[l], lowest[l]) };
                    }
                    blocks.push(b);
                }
            }
            before = block[block.len() - 1];
        }
        (self.group.high, self.group.low) = (high, low);
        Scanned { blocks, highest, lowest }
    }
}

/// The recursion over a whole block at once: (u, v) ← (u, v) + N' (u, v) + Σ w aₖ.
#[repr(C, align(64))]
struct Leap {
    n: [Many; 4],
    /// Weights of u, then those of v.
    w: [[f64; 2 * WIDTH]; BLOCK],
}

impl Leap {
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn new(group: &Group) -> Self {
        let (mut n, mut w) = (group.n, [[0.0; 2 * WIDTH]; BLOCK]);
        let [mut u, mut v] = group.c;
        for w in w.iter_mut().rev() {
            w[..WIDTH].copy_from_slice(&u);
            w[WIDTH..].copy_from_slice(&v);
            for l in 0..WIDTH {
                (u[l], v[l]) =
                    (u[l] + n[0][l].mul_add(u[l], n[1][l] * v[l]), v[l] + n[3][l].mul_add(v[l], n[2][l] * u[l]));
            }
        }
        // (1 + N)² = 1 + 2N + N²
        let [a, b, c, d] = &mut n;
        for _ in 0..BLOCK.ilog2() {
            for l in 0..WIDTH {
                let (across, trace) = (b[l] * c[l], a[l] + d[l]);
                a[l] = 2.0 * a[l] + a[l].mul_add(a[l], across);
                d[l] = 2.0 * d[l] + d[l].mul_add(d[l], across);
                b[l] = 2.0 * b[l] + b[l] * trace;
                c[l] = 2.0 * c[l] + c[l] * trace;
            }
        }
        Self { n, w }
    }
}

/// Returns the share of the bend that a rise between samples a phase θ apart can have: s/(1 − s) with s = θ²/8,
/// infinite for s ≥ ½.
#[inline]
pub(crate) fn share_of_bend(theta: f64) -> f64 {
    let share = 0.125 * theta * theta;
    if share < 0.5 { share / (1.0 - share) } else { f64::INFINITY }
}

impl SpectrumFilter {
    /// Creates a filter for samples `dt` seconds apart.
    ///
    /// # Accuracy
    ///
    /// The spectrum is exact for a history that is linear between samples, but for rounding: from f·dt = 10⁻⁹ to 10, at
    /// any damping, for samples of up to 10¹⁰⁰ m/s². The component is at rest before the first sample; after the last
    /// the acceleration is zero and the ring-down is complete.
    ///
    /// # Examples
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Frequencies, Quantity, SpectrumFilter};
    /// let mut filter = SpectrumFilter::new(
    ///     Frequencies::list(vec![10.0])?,
    ///     DampingRatio::new(0.0)?,
    ///     Quantity::AbsoluteAcceleration,
    ///     0.05,
    /// )?;
    /// filter.push(&[1.0, 1.0]); // a rectangle of half a period doubles
    /// assert!((filter.finish()?.maximax[0] - 2.0).abs() < 1e-12);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    /// # Errors
    /// [`Error::Quantity`] unless `dt` is finite and positive.
    pub fn new(frequencies: Frequencies, damping: DampingRatio, quantity: Quantity, dt: f64) -> Result<Self, Error> {
        crate::error::positive("time between samples (s)", dt)?;
        let modes = Modes::new(damping);
        let omegas: Vec<f64> = frequencies.hz().iter().map(|f| TAU * f).collect();
        let groups =
            omegas.chunks(WIDTH).map(|chunk| Group::new(&modes, chunk, dt, quantity.row(chunk[0]).0)).collect();
        Ok(Self {
            frequencies,
            damping,
            quantity,
            modes,
            groups,
            previous: None,
            start_s: 0.0,
            steps: 0,
            integrals: Some(Integrals::default()),
        })
    }
    /// Returns the filter with the first sample at `start_s` in place of 0: times of peaks count from there.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless it is finite.
    pub fn starting_at(mut self, start_s: f64) -> Result<Self, Error> {
        if !start_s.is_finite() {
            return Err(Error::Quantity { name: "time of the first sample (s)", value: start_s, allowed: "finite" });
        }
        self.start_s = start_s;
        Ok(self)
    }
    /// Processes more samples of base acceleration.
    pub fn push(&mut self, samples: &[f64]) {
        let mut rest = samples;
        if self.previous.is_none()
            && let Some((&first, others)) = samples.split_first()
        {
            for group in &mut self.groups {
                for l in 0..WIDTH {
                    group.u[l] *= first;
                    group.v[l] *= first;
                }
            }
            (self.previous, rest) = (Some(first), others);
        }
        let Some(mut previous) = self.previous else { return };
        for chunk in rest.chunks(CHUNK) {
            let mut before = previous;
            let inputs: Vec<Input> = chunk
                .chunks(BLOCK)
                .map(|block| Input::new(std::mem::replace(&mut before, block[block.len() - 1]), block))
                .collect();
            let total = Input::all(&inputs);
            self.integrate(previous, chunk);
            let of = Chunk { previous, samples: chunk, inputs: &inputs, total };
            for group in &mut self.groups {
                group.run(&self.modes, self.steps, &of);
            }
            self.steps = self.steps.saturating_add(chunk.len());
            previous = chunk[chunk.len() - 1];
        }
        self.previous = Some(previous);
    }
    /// Adds samples to the integrals, as long as these may serve.
    fn integrate(&mut self, mut before: f64, samples: &[f64]) {
        let Some(integrals) = &mut self.integrals else { return };
        let softest = self
            .groups
            .iter()
            .flat_map(|group| &group.oscillators)
            .fold(f64::INFINITY, |m, oscillator| m.min(oscillator.theta));
        for &sample in samples {
            if !integrals.suit(self.modes.zeta, softest) {
                self.integrals = None;
                return;
            }
            integrals.step(before, sample);
            before = sample;
        }
    }
    /// Returns the spectrum, with the ring-down after the last sample.
    /// # Errors
    /// [`Error::Empty`] if no sample came.
    pub fn finish(self) -> Result<Spectrum, Error> {
        let last = self.previous.ok_or(Error::Empty("record"))?;
        let time = |dt: f64, step: usize| {
            #[expect(clippy::cast_precision_loss, reason = "samples are fewer than 2^53")]
            let steps = step as f64;
            self.start_s + steps * dt
        };
        Ok(Spectrum::collect(&self.frequencies, self.damping, self.quantity, |i, omega, k| {
            let (group, l) = (&self.groups[i / WIDTH], i % WIDTH);
            let oscillator = &group.oscillators[l];
            let soft = self.integrals.as_ref().filter(|integrals| integrals.suit(self.modes.zeta, oscillator.theta));
            let left = soft.map(|integrals| integrals.motion(&self.modes, oscillator.theta, group.reach.dt));
            // Integrals may overflow where the motion does not.
            let motion = match left.filter(|motion| (motion.x + motion.w).is_finite()) {
                Some(motion) => motion,
                None => oscillator.motion(group.u[l], group.v[l], last),
            };
            let mut after = Range::default();
            after.note_free(&self.modes, k, motion, f64::INFINITY, self.steps);
            [oscillator.range, after].map(|range| range.peaks(omega, |step| time(group.reach.dt, step)))
        }))
    }
}
