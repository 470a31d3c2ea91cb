//! The steps of an uneven record, and their effect on every part.

use super::BLOCK;
use crate::eight::{Many, WIDTH};
use crate::suspension::Modes;

/// The most terms of the series.
pub(super) const TERMS: usize = 24;
/// Numbers of steps in one leap, the second where the first is too long.
const LEAPS: [usize; 2] = [BLOCK, BLOCK / 4];
/// Places and weights of eight points in (0, 1) whose weighted sum is the integral of any polynomial up to degree 15
/// (Gauss–Legendre).
const POINTS: Many = [
    0.019_855_071_751_231_884,
    0.101_666_761_293_186_64,
    0.237_233_795_041_835_5,
    0.408_282_678_752_175_1,
    0.591_717_321_247_825,
    0.762_766_204_958_164_5,
    0.898_333_238_706_813_4,
    0.980_144_928_248_768_1,
];
const WEIGHTS: Many = [
    0.050_614_268_145_188_13,
    0.111_190_517_226_687_24,
    0.156_853_322_938_943_63,
    0.181_341_891_689_181,
    0.181_341_891_689_181,
    0.156_853_322_938_943_63,
    0.111_190_517_226_687_24,
    0.050_614_268_145_188_13,
];

/// One step: the times of its ends, and the acceleration there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) dt: f64,
    pub(super) from: f64,
    pub(super) to: f64,
    /// Change of acceleration over time.
    pub(super) slope: f64,
}

/// Steps that follow one another, and bounds on their effect.
#[derive(Debug)]
pub(super) struct Block<'a> {
    pub(super) steps: &'a [Step],
    pub(super) longest: f64,
    /// Bound on the integral of the absolute acceleration.
    pub(super) added: f64,
    pub(super) peak: f64,
    pub(super) steepest: f64,
    /// Leaps of each length of [`LEAPS`], and the longest time of one.
    pub(super) leaps: [(f64, Vec<Leap>); LEAPS.len()],
}

impl<'a> Block<'a> {
    pub(super) fn new(series: &Series, steps: &'a [Step]) -> Self {
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
                pulp::Arch::new().dispatch(Leaps { series, steps, length, to: &mut leaps });
                (leaps.iter().fold(0.0, |most, leap| leap.span.max(most)), leaps)
            }),
        }
    }
    pub(super) fn span(&self) -> f64 {
        self.leaps[0].0
    }
}

/// The effect of several steps on a part at rest, for every frequency: powers of their phase.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leap {
    pub(super) span: f64,
    /// −x over the phase, and −w.
    pub(super) x: [f64; TERMS],
    pub(super) w: [f64; TERMS],
}

impl Leap {
    /// Returns the response −∫ a h dt by the series of h, each power integrated over the steps. The error of eight
    /// points a step is less than 10⁻¹⁷ of it.
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
            x: std::array::from_fn(|k| series.h[k][0] * sum(k + 1)),
            w: std::array::from_fn(|k| series.w[k][0] * sum(k)),
        }
    }
}

/// The leaps of one length over some steps, on the widest instructions of the machine.
struct Leaps<'a> {
    series: &'a Series,
    steps: &'a [Step],
    length: usize,
    to: &'a mut Vec<Leap>,
}

impl pulp::WithSimd for Leaps<'_> {
    type Output = ();
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        for steps in self.steps.chunks(self.length) {
            self.to.push(Leap::new(self.series, steps));
        }
    }
}

/// Responses from rest by powers of τ: X₀/τ², X₁/τ³, h/τ and w of an impulse. Each is stored eight times, for
/// instructions of eight numbers.
#[derive(Debug, Clone)]
pub(super) struct Series {
    pub(super) x0: [Many; TERMS],
    pub(super) x1: [Many; TERMS],
    pub(super) h: [Many; TERMS],
    pub(super) w: [Many; TERMS],
}

impl Series {
    /// Creates the series. X₁ = Σ aₖτᵏ solves X₁″ + 2ζX₁′ + X₁ = τ; X₀ is its derivative, h that of X₀, and w = h′ + σh.
    pub(super) fn new(modes: &Modes) -> Self {
        let none = [[0.0; WIDTH]; TERMS];
        let mut series = Self { x0: none, x1: none, h: none, w: none };
        let (mut older, mut a, mut k, mut h) = (0.0, 1.0 / 6.0, 3.0, 0.0);
        for i in 0..TERMS {
            let next_h = k * (k - 1.0) * a;
            (series.x0[i], series.x1[i], series.h[i]) = ([k * a; WIDTH], [a; WIDTH], [next_h; WIDTH]);
            series.w[i] = [(k - 2.0) * next_h + modes.sigma * h; WIDTH];
            h = next_h;
            let next = -(2.0 * modes.zeta * k * a + older) / (k * (k + 1.0));
            (older, a, k) = (a, next, k + 1.0);
        }
        series
    }
}
