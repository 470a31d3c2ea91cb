//! Spectra of evenly sampled records: the ramp-invariant recursive filter of ISO 18431-4, many frequencies at a time.
//!
//! Between samples the acceleration is taken to be linear, and for such a history the filter is exact. It carries the quantity
//! asked for and one more coordinate, u and v, less what the newest sample adds at once:
//!
//! ```text
//! (u, v)ₖ₊₁ = (u, v)ₖ + N (u, v)ₖ + c aₖ,    qₖ₊₁ = uₖ₊₁ + d aₖ₊₁
//! ```
//!
//! The entries of N and c come from series where the step is short, and the sum is kept as an increment, so that nothing
//! cancels at frequencies far below the sampling rate. Samples are scanned 64 at a time; where a bound says that a peak
//! between samples may pass the largest sample, the steps are gone through one by one and the peak is found exactly.

use crate::forced::Segment;
use crate::peaks::Range;
use crate::suspension::{Modes, Motion, Phase, Propagator};
use crate::{DampingRatio, Error, Frequencies, Quantity, Spectrum};
use std::f64::consts::TAU;

/// Frequencies run side by side.
const LANES: usize = 8;
/// Samples between two bounds.
const BLOCK: usize = 64;
/// Samples gone through for one group of frequencies before the next: they stay in the nearest cache.
const CHUNK: usize = 4096;

/// A shock response spectrum in the making: samples in, in pieces of any size; memory does not grow.
#[derive(Debug, Clone)]
pub struct SpectrumFilter {
    frequencies: Frequencies,
    damping: DampingRatio,
    quantity: Quantity,
    modes: Modes,
    groups: Vec<Group>,
    previous: Option<f64>,
}

#[derive(Debug, Clone)]
struct Group {
    /// N row by row, c, d of each lane.
    n: [[f64; LANES]; 4],
    c: [[f64; LANES]; 2],
    d: [f64; LANES],
    u: [f64; LANES],
    v: [f64; LANES],
    lanes: Vec<Lane>,
}

/// What one frequency needs beside the filter.
#[derive(Debug, Clone)]
struct Lane {
    omega: f64,
    theta: f64,
    row: usize,
    /// From (u, v) back to (x, w).
    back: [[f64; 2]; 2],
    /// What the newest sample adds to (x, w) at once.
    newest: Motion,
    step: Propagator,
    older: Motion,
    /// 1/ω and 1/(ωθ).
    inverse: [f64; 2],
    /// s/(1 − s) with s = θ²/8: share of the bend that a rise between samples can have; infinite for s ≥ ½.
    share: f64,
    range: Range,
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

/// Where a block begins, and its largest and smallest sample, that before it included, lane by lane.
#[derive(Clone, Copy)]
struct Block {
    u: [f64; LANES],
    v: [f64; LANES],
    high: [f64; LANES],
    low: [f64; LANES],
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
    /// Of all blocks together.
    fn all(blocks: &[Self]) -> Self {
        blocks.iter().fold(Self { before: 0.0, sum: 0.0, peak: 0.0, jump: 0.0 }, |all, b| Self {
            before: 0.0,
            sum: all.sum + b.sum,
            peak: all.peak.max(b.peak),
            jump: all.jump.max(b.jump),
        })
    }
}

impl Lane {
    fn new(modes: &Modes, omega: f64, dt: f64, row: usize) -> (Self, [f64; 4], [f64; 2], f64, [f64; 2]) {
        let phase = Phase::product(omega, dt);
        let theta = phase.hi;
        let step = modes.propagator(phase);
        let ramp = modes.ramp(theta, &step);
        // Forcing is −a/ω; of a step, the newer sample drives `newest`, the older one the rest of the constant.
        let scale = -omega.recip();
        let newest = Motion { x: scale * (ramp.x1 / theta), w: scale * (ramp.w1 / theta) };
        let older = Motion { x: scale * ramp.x0 - newest.x, w: scale * ramp.w0 - newest.w };
        // The free motion less the identity, without cancellation: 1 − c − ζs is the response to a constant.
        let (c, k) = if modes.kappa == 0.0 {
            let less = -ramp.x0 - modes.zeta * step.s;
            (less, less)
        } else {
            ((-modes.sigma * theta).exp_m1(), (-modes.rho * theta).exp_m1())
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
        let share = 0.125 * theta * theta;
        let share = if share < 0.5 { share / (1.0 - share) } else { f64::INFINITY };
        let inverse = [omega.recip(), (omega * theta).recip()];
        let lane = Self { omega, theta, row, back, newest, step, older, inverse, share, range: Range::default() };
        (lane, [n[0][0], n[0][1], n[1][0], n[1][1]], input, at_once[0], at_once)
    }
    /// The motion at a sample, from the filter's coordinates and that sample.
    fn motion(&self, u: f64, v: f64, a: f64) -> Motion {
        let [x, w] = self.back;
        Motion { x: x[0] * u + x[1] * v + self.newest.x * a, w: w[0] * u + w[1] * v + self.newest.w * a }
    }
    /// How far the quantity can rise between samples, above all of them, where it reaches `q` at samples and the motion
    /// begins with `m`: θ²/8 of the largest bend, which q″ = −q − 2ζq′ + (input) bounds.
    #[inline]
    fn bump(&self, modes: &Modes, q: f64, m: Motion, input: &Input) -> f64 {
        let damp = 2.0 * modes.zeta;
        let y = m.w - modes.sigma * m.x;
        // |x| and |y| stay within v: √(x² + y²) grows by no more than |f|.
        let v = m.x.abs() + y.abs() + self.theta * input.sum * self.inverse[0];
        let (f, slope) = (input.peak * self.inverse[0], input.jump * self.inverse[1]);
        let bend = match self.row {
            Modes::DISPLACEMENT => damp * v + f,
            Modes::VELOCITY => damp * ((1.0 + damp) * v + f) + slope,
            _ => damp * ((1.0 + damp + damp * damp) * v + damp * f + slope) + f,
        };
        self.share * (q + bend)
    }
    /// Goes through the steps of a block one by one, from the motion `m` at the sample `from`.
    /// No step rises by more than `most` between its samples.
    fn refine(
        &mut self,
        modes: &Modes,
        segment: &mut Segment,
        most: f64,
        mut m: Motion,
        mut from: f64,
        samples: &[f64],
    ) {
        let mut q = modes.quantity(self.row, m);
        for &to in samples {
            let moved = self.step.apply(modes.p, m);
            let next = Motion {
                x: moved.x + (self.older.x * from + self.newest.x * to),
                w: moved.w + (self.older.w * from + self.newest.w * to),
            };
            let q_next = modes.quantity(self.row, next);
            let (high, low) = (q.max(q_next), q.min(q_next));
            let passes = |bump: f64| high + bump > self.range.high.value || low - bump < self.range.low.value;
            if passes(most) && passes(self.bump(modes, high.max(-low), m, &Input::new(from, &[to]))) {
                let (f0, f1) = (-from / self.omega, -to / self.omega);
                segment.begin(m, f0, (f1 - f0) / self.theta, self.theta);
                let end = segment.sample_known(self.theta, next);
                segment.extremes(self.row, &end, 0, &mut self.range);
            }
            (m, q, from) = (next, q_next, to);
        }
    }
}

impl Group {
    fn new(modes: &Modes, omegas: &[f64], dt: f64, row: usize) -> Self {
        let mut group = Self {
            n: [[0.0; LANES]; 4],
            c: [[0.0; LANES]; 2],
            d: [0.0; LANES],
            u: [0.0; LANES],
            v: [0.0; LANES],
            lanes: Vec::with_capacity(LANES),
        };
        for (l, &omega) in omegas.iter().enumerate() {
            let (lane, n, c, d, at_once) = Lane::new(modes, omega, dt, row);
            for (to, from) in group.n.iter_mut().zip(n) {
                to[l] = from;
            }
            (group.c[0][l], group.c[1][l], group.d[l]) = (c[0], c[1], d);
            // Until the first sample: what it will add at once is taken off (times that sample).
            (group.u[l], group.v[l]) = (-at_once[0], -at_once[1]);
            group.lanes.push(lane);
        }
        group
    }
    fn run(&mut self, modes: &Modes, previous: f64, samples: &[f64], inputs: &[Input]) {
        let blocks = pulp::Arch::new().dispatch(Scan { group: self, previous, samples });
        let mut segment = Segment::new(modes);
        let total = Input::all(inputs);
        for (l, lane) in self.lanes.iter_mut().enumerate() {
            let (mut highest, mut lowest) = (0, 0);
            for (i, b) in blocks.iter().enumerate() {
                if b.high[l] > blocks[highest].high[l] {
                    highest = i;
                }
                if b.low[l] < blocks[lowest].low[l] {
                    lowest = i;
                }
            }
            lane.range.note(0, 0.0, blocks[highest].high[l]);
            lane.range.note(0, 0.0, blocks[lowest].low[l]);
            let first = lane.motion(blocks[0].u[l], blocks[0].v[l], inputs[0].before);
            let q = blocks[highest].high[l].max(-blocks[lowest].low[l]).max(modes.quantity(lane.row, first).abs());
            let most = lane.bump(modes, q, first, &total);
            let mut look = |i: usize| {
                let (b, input) = (&blocks[i], &inputs[i]);
                let m = lane.motion(b.u[l], b.v[l], input.before);
                let q = modes.quantity(lane.row, m).abs().max(b.high[l]).max(-b.low[l]);
                let bump = lane.bump(modes, q, m, input);
                if b.high[l] + bump > lane.range.high.value || b.low[l] - bump < lane.range.low.value {
                    let begin = i * BLOCK;
                    let block = &samples[begin..samples.len().min(begin + BLOCK)];
                    lane.refine(modes, &mut segment, bump, m, input.before, block);
                }
                lane.range
            };
            // Where the samples are largest the peak is likely, and rules out most of the rest.
            look(highest);
            let mut range = look(lowest);
            for (i, b) in blocks.iter().enumerate() {
                if b.high[l] + most > range.high.value || b.low[l] - most < range.low.value {
                    range = look(i);
                }
            }
        }
    }
    /// The recursion over one block, with fused multiply-adds where the machine has them.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn scan<const FUSED: bool>(&mut self, mut before: f64, samples: &[f64]) -> Block {
        let add = |a: f64, b: f64, c: f64| if FUSED { a.mul_add(b, c) } else { a * b + c };
        let [n00, n01, n10, n11] = self.n;
        let ([c0, c1], d) = (self.c, self.d);
        let (mut u, mut v) = (self.u, self.v);
        // The sample before the block counts: the first step begins with it.
        let first: [f64; LANES] = std::array::from_fn(|l| add(d[l], before, u[l]));
        let mut block = Block { u, v, high: first, low: first };
        for &a in samples {
            for l in 0..LANES {
                // Grouped for the shortest chain from one sample to the next.
                let from_v = add(n01[l], v[l], c0[l] * before);
                let from_u = add(n10[l], u[l], c1[l] * before);
                u[l] = add(n00[l], u[l], u[l]) + from_v;
                v[l] = add(n11[l], v[l], v[l]) + from_u;
                let q = add(d[l], a, u[l]);
                block.high[l] = if q > block.high[l] { q } else { block.high[l] };
                block.low[l] = if q < block.low[l] { q } else { block.low[l] };
            }
            before = a;
        }
        (self.u, self.v) = (u, v);
        block
    }
}

/// One group through some samples, block by block, on the widest instructions of the machine.
struct Scan<'a> {
    group: &'a mut Group,
    previous: f64,
    samples: &'a [f64],
}

impl pulp::WithSimd for Scan<'_> {
    type Output = Vec<Block>;
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Vec<Block> {
        let mut blocks = Vec::with_capacity(self.samples.len().div_ceil(BLOCK));
        let mut before = self.previous;
        for block in self.samples.chunks(BLOCK) {
            blocks.push(if S::IS_SCALAR {
                self.group.scan::<false>(before, block)
            } else {
                self.group.scan::<true>(before, block)
            });
            before = block[block.len() - 1];
        }
        blocks
    }
}

impl SpectrumFilter {
    /// A filter for samples `dt` seconds apart.
    ///
    /// # Accuracy
    ///
    /// Exact for a history that is linear between samples, but for rounding: from f·dt = 10⁻⁹ to 10, at any damping. The
    /// component is at rest before the first sample; after the last the acceleration is zero and the ring-down is complete.
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
            omegas.chunks(LANES).map(|chunk| Group::new(&modes, chunk, dt, quantity.row(chunk[0]).0)).collect();
        Ok(Self { frequencies, damping, quantity, modes, groups, previous: None })
    }
    /// Takes in more samples of base acceleration.
    pub fn push(&mut self, samples: &[f64]) {
        let mut rest = samples;
        if self.previous.is_none()
            && let Some((&first, others)) = samples.split_first()
        {
            for group in &mut self.groups {
                for l in 0..LANES {
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
            for group in &mut self.groups {
                group.run(&self.modes, previous, chunk, &inputs);
            }
            previous = chunk[chunk.len() - 1];
        }
        self.previous = Some(previous);
    }
    /// The spectrum, with the ring-down after the last sample.
    /// # Errors
    /// [`Error::Empty`] if no sample came.
    pub fn finish(self) -> Result<Spectrum, Error> {
        let last = self.previous.ok_or(Error::Empty("record"))?;
        Ok(Spectrum::collect(&self.frequencies, self.damping, self.quantity, |i, _, k| {
            let (group, l) = (&self.groups[i / LANES], i % LANES);
            let lane = &group.lanes[l];
            let mut after = Range::default();
            after.note_free(&self.modes, k, lane.motion(group.u[l], group.v[l], last), f64::INFINITY, 0);
            [lane.range, after]
        }))
    }
}
