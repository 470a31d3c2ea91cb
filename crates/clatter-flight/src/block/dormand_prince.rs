//! One step of the method of Dormand and Prince, 5(4), with its continuous extension of order 4 (Hairer, Nørsett, Wanner, Solving
//! Ordinary Differential Equations I, II.5 and II.6).

/// Weights of the earlier slopes in each stage.
const STAGES: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Weights of the difference of the two orders.
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];
/// Weights of the fourth power of the continuous extension.
const DENSE: [f64; 7] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];

/// A step, and the state anywhere within it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step<const N: usize> {
    from: [f64; N],
    /// Coefficients of θ, θ(1−θ), θ²(1−θ) and θ²(1−θ)².
    powers: [[f64; N]; 4],
    /// Estimate of its error.
    pub(super) error: [f64; N],
}

fn combined<const N: usize>(from: &[f64; N], h: f64, weights: &[f64], slopes: &[[f64; N]]) -> [f64; N] {
    let mut sum = [0.0; N];
    for (weight, slope) in weights.iter().zip(slopes) {
        sum = std::array::from_fn(|i| sum[i] + weight * slope[i]);
    }
    std::array::from_fn(|i| from[i] + h * sum[i])
}

impl<const N: usize> Step<N> {
    pub(super) fn new(from: &[f64; N], h: f64, slope: impl Fn(&[f64; N]) -> [f64; N]) -> Self {
        let mut slopes = [[0.0; N]; 7];
        slopes[0] = slope(from);
        let mut to = *from;
        for (k, weights) in STAGES.iter().enumerate() {
            to = combined(from, h, weights, &slopes[..=k]);
            slopes[k + 1] = slope(&to);
        }
        let zero = [0.0; N];
        let change: [f64; N] = std::array::from_fn(|i| to[i] - from[i]);
        let begin: [f64; N] = std::array::from_fn(|i| h * slopes[0][i] - change[i]);
        let end: [f64; N] = std::array::from_fn(|i| change[i] - h * slopes[6][i] - begin[i]);
        let powers = [change, begin, end, combined(&zero, h, &DENSE, &slopes)];
        Self { from: *from, powers, error: combined(&zero, h, &ERROR, &slopes) }
    }

    /// Returns a bound on the change of each number within the step, from the largest values of those powers.
    pub(super) fn reach(&self) -> [f64; N] {
        let [p0, p1, p2, p3] = &self.powers;
        std::array::from_fn(|i| p0[i].abs() + 0.25 * p1[i].abs() + 0.15 * p2[i].abs() + 0.0625 * p3[i].abs())
    }

    /// Returns the state at a share of the step.
    pub(super) fn at(&self, share: f64) -> [f64; N] {
        let (now, rest) = (share, 1.0 - share);
        let [p0, p1, p2, p3] = &self.powers;
        std::array::from_fn(|i| self.from[i] + now * (p0[i] + rest * (p1[i] + now * (p2[i] + rest * p3[i]))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first two numbers obey x″ = −x; the order is 5 at the end and 4 within.
    #[test]
    fn halves_of_a_step_are_wrong_by_its_order_less() {
        let turn = |y: &[f64; 2]| [y[1], -y[0]];
        let from = [1.0, 0.0];
        let off = |h: f64, share: f64| (Step::new(&from, h, turn).at(share)[0] - libm::cos(share * h)).abs();
        // The local error is of one order more; cos is even, which gains one more at the end.
        let gain = |share: f64| (off(0.4, share) / off(0.2, share)).log2();
        assert!(gain(1.0) > 5.7 && gain(0.37) > 4.7, "{} {}", gain(1.0), gain(0.37));
        assert!(off(0.2, 1.0) < 1e-7, "{}", off(0.2, 1.0));
    }

    /// Under each power alone the state changes by the stated bound, or nearly: 4/27 of the third at two thirds.
    #[test]
    fn a_step_reaches_no_further_than_said() {
        let powers = std::array::from_fn(|k| std::array::from_fn(|i| if i == k { -3.0 } else { 0.0 }));
        let step = Step { from: [0.5; 4], powers, error: [0.0; 4] };
        for (i, reach) in step.reach().into_iter().enumerate() {
            let most = (0..=300).map(|k| (step.at(f64::from(k) / 300.0)[i] - 0.5).abs()).fold(0.0, f64::max);
            assert!(most <= reach && most > 0.98 * reach, "power {i}: {most} of {reach}");
        }
    }
}
