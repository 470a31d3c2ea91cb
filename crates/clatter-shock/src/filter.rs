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
    range: Range,
}

/// Where a block begins, and its largest and smallest sample, lane by lane.
#[derive(Clone, Copy)]
struct Block {
    u: [f64; LANES],
    v: [f64; LANES],
    high: [f64; LANES],
    low: [f64; LANES],
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
        let lane = Self { omega, theta, row, back, newest, step, older, range: Range::default() };
        (lane, [n[0][0], n[0][1], n[1][0], n[1][1]], input, at_once[0], at_once)
    }
    /// The motion at a sample, from the filter's coordinates and that sample.
    fn motion(&self, u: f64, v: f64, a: f64) -> Motion {
        let [x, w] = self.back;
        Motion { x: x[0] * u + x[1] * v + self.newest.x * a, w: w[0] * u + w[1] * v + self.newest.w * a }
    }
    /// Goes through the steps of a block one by one; `samples` begins with the one before the block.
    fn refine(&mut self, modes: &Modes, segment: &mut Segment, mut m: Motion, samples: &[f64]) {
        for pair in samples.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let moved = self.step.apply(modes.p, m);
            let next = Motion {
                x: moved.x + self.older.x * from + self.newest.x * to,
                w: moved.w + self.older.w * from + self.newest.w * to,
            };
            let (f0, f1) = (-from / self.omega, -to / self.omega);
            segment.begin(m, f0, (f1 - f0) / self.theta, self.theta);
            if segment.may_pass(self.row, next, self.theta, &self.range) {
                let end = segment.sample_known(self.theta, next);
                segment.extremes(self.row, &end, 0, &mut self.range);
            } else {
                self.range.note(0, 0.0, modes.quantity(self.row, next));
            }
            m = next;
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
    fn run(&mut self, modes: &Modes, previous: f64, samples: &[f64]) {
        let mut blocks: Vec<Block> = Vec::with_capacity(samples.len().div_ceil(BLOCK));
        pulp::Arch::new().dispatch(|| {
            let mut before = previous;
            for block in samples.chunks(BLOCK) {
                blocks.push(self.scan(before, block));
                before = block[block.len() - 1];
            }
        });
        let mut segment = Segment::new(modes);
        for (l, lane) in self.lanes.iter_mut().enumerate() {
            for b in &blocks {
                lane.range.note(0, 0.0, b.high[l]);
                lane.range.note(0, 0.0, b.low[l]);
            }
            let mut before = previous;
            for (b, block) in blocks.iter().zip(samples.chunks(BLOCK)) {
                let m = lane.motion(b.u[l], b.v[l], before);
                let sum: f64 = block.iter().fold(before.abs(), |s, a| s + a.abs());
                let bump = segment.bump(lane.row, m, lane.theta, sum / lane.omega);
                if b.high[l] + bump > lane.range.high.value || b.low[l] - bump < lane.range.low.value {
                    let mut samples = [0.0; BLOCK + 1];
                    samples[0] = before;
                    samples[1..=block.len()].copy_from_slice(block);
                    lane.refine(modes, &mut segment, m, &samples[..=block.len()]);
                }
                before = block[block.len() - 1];
            }
        }
    }
    /// The recursion over one block.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn scan(&mut self, mut before: f64, samples: &[f64]) -> Block {
        let [n00, n01, n10, n11] = self.n;
        let ([c0, c1], d) = (self.c, self.d);
        let (mut u, mut v) = (self.u, self.v);
        let mut block = Block { u, v, high: [f64::NEG_INFINITY; LANES], low: [f64::INFINITY; LANES] };
        for &a in samples {
            for l in 0..LANES {
                let du = n00[l] * u[l] + n01[l] * v[l] + c0[l] * before;
                let dv = n10[l] * u[l] + n11[l] * v[l] + c1[l] * before;
                u[l] += du;
                v[l] += dv;
                let q = u[l] + d[l] * a;
                block.high[l] = if q > block.high[l] { q } else { block.high[l] };
                block.low[l] = if q < block.low[l] { q } else { block.low[l] };
            }
            before = a;
        }
        (self.u, self.v) = (u, v);
        block
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
            for group in &mut self.groups {
                group.run(&self.modes, previous, chunk);
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
