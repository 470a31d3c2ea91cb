//! This module finds the inputs that drive a result: how much of its variance each input explains alone.
//!
//! The first-order index of Sobol, S = Var(E[y | input])/Var(y), estimated from the very samples that were drawn: each
//! input's values are sorted into equally likely bins by their rank, which is the uniform number they came from, and
//! the means of the bins are compared. Unlike a rank correlation it sees what rises and falls again, as a resonance
//! does; unlike Saltelli's scheme it needs no further samples; and it takes constant memory.
//!
//! Source: E. Plischke, “An effective algorithm for computing global sensitivity indices (EASI)”, Reliability
//! Engineering and System Safety 95 (2010), and the correlation ratio ε² of T. L. Kelley (1935), which is without bias
//! where the input does nothing.

/// Equally likely bins of an input. The variance within a bin is lost to the index: 1/32² of it where y is linear.
const BINS: usize = 32;

/// The effect of one input on a result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// Share of the variance that the input explains alone, 0 to 1; noise of about √(2·31)/samples.
    pub variance: f64,
    /// Correlation of the result with the rank of the input, −1 to 1: which way it goes.
    pub trend: f64,
}

/// Sums over samples of one result, for a number of inputs.
///
/// y is counted from a fixed value near it, so that the variance does not cancel; sums of sums are exact to a rounding
/// each and always made in the same order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sums {
    from: f64,
    count: f64,
    sum: f64,
    square: f64,
    inputs: Vec<InputSums>,
}

#[derive(Debug, Clone, PartialEq)]
struct InputSums {
    rank: f64,
    with_rank: f64,
    count: [f64; BINS],
    sum: [f64; BINS],
}

impl Sums {
    pub(super) fn new(from: f64, inputs: usize) -> Self {
        let none = InputSums { rank: 0.0, with_rank: 0.0, count: [0.0; BINS], sum: [0.0; BINS] };
        Self { from, count: 0.0, sum: 0.0, square: 0.0, inputs: vec![none; inputs] }
    }

    /// Takes in a result and the ranks in (0, 1) of its inputs.
    pub(super) fn add(&mut self, y: f64, ranks: impl IntoIterator<Item = f64>) {
        let y = y - self.from;
        self.count += 1.0;
        self.sum += y;
        self.square += y * y;
        for (input, rank) in self.inputs.iter_mut().zip(ranks) {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in 0 .. BINS")]
            #[expect(clippy::cast_precision_loss, reason = "a small count")]
            let bin = ((rank * BINS as f64) as usize).min(BINS - 1);
            input.count[bin] += 1.0;
            input.sum[bin] += y;
            input.rank += rank - 0.5;
            input.with_rank += y * (rank - 0.5);
        }
    }

    /// Takes in the sums of later samples.
    pub(super) fn merge(&mut self, later: &Self) {
        self.count += later.count;
        self.sum += later.sum;
        self.square += later.square;
        for (input, later) in self.inputs.iter_mut().zip(&later.inputs) {
            input.rank += later.rank;
            input.with_rank += later.with_rank;
            for bin in 0..BINS {
                input.count[bin] += later.count[bin];
                input.sum[bin] += later.sum[bin];
            }
        }
    }

    pub(super) fn mean(&self) -> f64 {
        self.from + self.sum / self.count
    }

    /// Returns the standard deviation.
    pub(super) fn deviation(&self) -> f64 {
        (self.spread() / self.count).max(0.0).sqrt()
    }

    /// Returns the sum of squares about the mean.
    fn spread(&self) -> f64 {
        self.square - self.sum * self.sum / self.count
    }

    /// Returns the share of each input; `None` where the result does not vary, is infinite, or there are too few samples to
    /// tell.
    pub(super) fn shares(&self) -> Option<Vec<Share>> {
        let total = self.spread();
        // The remainder of a constant is rounding.
        let varies = total > 1e-20 * self.count * self.from * self.from && total.is_finite();
        #[expect(clippy::cast_precision_loss, reason = "a small count")]
        let enough = self.count > 10.0 * BINS as f64;
        let of = |input: &InputSums| {
            let filled = input.count.iter().filter(|count| **count > 0.0).count();
            let means: f64 =
                input.count.iter().zip(&input.sum).filter(|(n, _)| **n > 0.0).map(|(n, s)| s * s / n).sum();
            let between = means - self.sum * self.sum / self.count;
            #[expect(clippy::cast_precision_loss, reason = "a small count")]
            let groups = filled as f64;
            let within = (total - between) / (self.count - groups);
            let variance = ((between - (groups - 1.0) * within) / total).clamp(0.0, 1.0);
            // the ranks are uniform: variance 1/12
            let together = input.with_rank - input.rank * self.sum / self.count;
            let trend = (together / (total * self.count / 12.0).sqrt()).clamp(-1.0, 1.0);
            Share { variance, trend }
        };
        (varies && enough).then(|| self.inputs.iter().map(of).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scatter::philox::Stream;

    fn sums(samples: u64, inputs: usize, y: impl Fn(&[f64]) -> f64) -> Sums {
        let draw = |k| (0..4).map(|i| Stream::new(1, k).at(i)).take(inputs).collect::<Vec<f64>>();
        let near = y(&draw(0));
        let mut sums = Sums::new(if near.is_finite() { near } else { 0.0 }, inputs);
        for k in 0..samples {
            let u = draw(k);
            sums.add(y(&u), u);
        }
        sums
    }

    /// T. Ishigami, T. Homma (1990): y = sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁, whose indices are known in closed form.
    #[test]
    fn ishigami_s_function_has_its_known_indices() {
        let pi = std::f64::consts::PI;
        let y = |u: &[f64]| {
            let x: Vec<f64> = u.iter().map(|u| pi * (2.0 * u - 1.0)).collect();
            x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin()
        };
        let found = sums(200_000, 3, y);
        let shares = found.shares().unwrap();
        let (a, b) = (7.0_f64, 0.1);
        let [first, second] = [0.5 * (1.0 + b * pi.powi(4) / 5.0).powi(2), a * a / 8.0];
        let total = a * a / 8.0 + b * pi.powi(4) / 5.0 + b * b * pi.powi(8) / 18.0 + 0.5;
        for (share, known) in shares.iter().zip([first / total, second / total, 0.0]) {
            // Bins of 1/32 lose up to (2π/32)²/12·(its curvature) of an index, below 1 %; noise is 0.003.
            assert!((share.variance - known).abs() < 0.012, "{share:?}, not {known}");
        }
        assert!((found.deviation().powi(2) - total).abs() < 0.02 * total, "variance {}", found.deviation().powi(2));
        assert!((found.mean() - 3.5).abs() < 0.03, "mean {}", found.mean());
        assert!(shares[1].trend.abs() < 0.01, "what rises and falls has an index and no trend");
    }

    #[test]
    fn a_sum_has_shares_in_the_ratio_of_its_variances() {
        let shares = sums(100_000, 4, |u| 1e6 + 3.0 * u[0] - 2.0 * u[1] + u[2]).shares().unwrap();
        for (share, (known, sign)) in shares.iter().zip([(9.0, 1.0), (4.0, -1.0), (1.0, 1.0), (0.0, 0.0)]) {
            assert!((share.variance - known / 14.0).abs() < 0.01, "{share:?}");
            assert!((share.trend - sign * (known / 14.0_f64).sqrt()).abs() < 0.01, "{share:?}");
        }
    }

    #[test]
    fn nothing_is_told_of_a_constant_of_too_few_samples_or_of_infinity() {
        assert_eq!(sums(10_000, 2, |_| 3.0).shares(), None);
        assert_eq!(sums(100, 2, |u| u[0]).shares(), None);
        assert_eq!(sums(10_000, 2, |u| if u[0] < 0.1 { f64::INFINITY } else { 1.0 }).shares(), None);
    }

    #[test]
    fn sums_of_parts_are_the_sum() {
        let y = |u: &[f64]| u[0] * u[1];
        let whole = sums(2000, 2, y);
        let mut first = sums(1000, 2, y);
        let mut later = Sums::new(first.from, 2);
        for k in 1000..2000 {
            let u = [0, 1].map(|i| Stream::new(1, k).at(i));
            later.add(y(&u), u);
        }
        first.merge(&later);
        assert!((first.mean() - whole.mean()).abs() < 1e-14 && (first.deviation() - whole.deviation()).abs() < 1e-14);
        assert_eq!(first.inputs[1].count.map(f64::to_bits), whole.inputs[1].count.map(f64::to_bits));
    }

    /// An input that does nothing has no share, in few samples as in many: means of bins scatter by 31 of 400 parts of the variance.
    #[test]
    fn chance_is_no_driver() {
        let draws = 60;
        let share = |n: u64| {
            let mut sums = Sums::new(0.0, 1);
            for k in 0..400 {
                let stream = Stream::new(2, 400 * n + k);
                sums.add(stream.at(0), [stream.at(1)]);
            }
            sums.shares().unwrap()[0].variance
        };
        #[expect(clippy::cast_precision_loss, reason = "a small count")]
        let mean = (0..draws).map(share).sum::<f64>() / draws as f64;
        // Of what scatters by √(2 · 31)/400 = 0.02 about 0 the half below is cut: 0.008 remains, and a fifth of that by chance.
        assert!(mean < 0.016, "{mean}");
    }
}
