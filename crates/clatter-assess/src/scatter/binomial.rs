//! This module bounds the share of all by the share of a sample: the exact interval of Clopper and Pearson.

/// A probability, the interval that holds it with the stated confidence, and one-sided bounds of the same confidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probability {
    /// Successes over samples; none where nothing is known of any.
    pub estimate: Option<f64>,
    /// Lower bound of the interval.
    pub lo: f64,
    /// Upper bound of the interval.
    pub hi: f64,
    /// The lower bound with all the doubt spent on this side.
    pub at_least: f64,
}

/// Returns the interval of Clopper and Pearson for the probability of an event seen `successes` times in `samples` draws.
///
/// # Formula
/// With α = 1 − confidence, `lo` is the p at which so many successes or more have probability α/2, `hi` that at which
/// so many or fewer have, and `at_least` the p at which so many or more have probability α. Where every draw was a
/// success these are (α/2)^(1/n), 1 and α^(1/n): at 95 % the event fails at most 3 times in n.
///
/// # Why this one
/// It holds the true probability at least as often as it says, for every probability and sample size (C. J. Clopper, E.
/// S. Pearson, Biometrika 26, 1934). Wilson's is shorter and right on average, but short of its confidence for
/// probabilities near 0 and 1 (L. D. Brown, T. T. Cai, A. DasGupta, Statistical Science 16, 2001), which is where parts
/// that hardly ever fail lie.
///
/// # Validity
/// 0 < samples, successes ≤ samples, 0 < confidence < 1.
///
/// # Accuracy
/// Bounds to 1e−10 of themselves and of 1 minus themselves, up to 10⁹ samples.
///
/// # Examples
/// No failure in 1000 drops: at 95 %, at least 997 in 1000 survive.
/// ```
/// let survival = clatter_assess::scatter::clopper_pearson(1000, 1000, 0.95);
/// assert_eq!((survival.estimate, survival.hi), (Some(1.0), 1.0));
/// assert!((survival.at_least - 0.05f64.powf(1e-3)).abs() < 1e-15 && survival.at_least > 0.997);
/// ```
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "beyond 2^53 samples a rounding changes no bound")]
pub fn clopper_pearson(successes: u64, samples: u64, confidence: f64) -> Probability {
    let (k, n, rest) = (successes as f64, samples as f64, samples.saturating_sub(successes) as f64);
    let alpha = 1.0 - confidence;
    // P(≥ k) = I_p(k, n − k + 1)
    let lower = |share: f64| match (successes, rest) {
        (0, _) => 0.0,
        (_, 0.0) => libm::exp(libm::log(share) / n),
        _ => beta_quantile(k, rest + 1.0, share)[0],
    };
    // P(≤ k) = I_{1−p}(n − k, k + 1)
    let hi = match (successes, rest) {
        (_, 0.0) => 1.0,
        (0, _) => -libm::expm1(libm::log(0.5 * alpha) / n),
        _ => beta_quantile(rest, k + 1.0, 0.5 * alpha)[1],
    };
    Probability { estimate: Some(k / n), lo: lower(0.5 * alpha), hi, at_least: lower(alpha) }
}

/// Returns x and 1 − x with I_x(a, b) = `share`, for whole a, b ≥ 1: bisection in ln(x/(1 − x)), which keeps the digits of
/// both.
fn beta_quantile(a: f64, b: f64, share: f64) -> [f64; 2] {
    let point = |t: f64| [1.0 / (1.0 + libm::exp(-t)), 1.0 / (1.0 + libm::exp(t))];
    let (mut lo, mut hi) = (-100.0, 100.0); // a share of 1e-43 is beyond any sample
    while hi - lo > 1e-12 {
        let middle = 0.5 * (lo + hi);
        let [x, y] = point(middle);
        *(if incomplete_beta(a, b, x, y) < share { &mut lo } else { &mut hi }) = middle;
    }
    point(0.5 * (lo + hi))
}

/// Returns the regularized incomplete beta function I_x(a, b) for whole a, b ≥ 1 and y = 1 − x.
///
/// The continued fraction (DLMF 8.17.22) by Lentz's method, on the side where it converges, about √(a + b) terms; its
/// factor x^a y^b/(a B(a, b)) is a binomial probability.
fn incomplete_beta(a: f64, b: f64, x: f64, y: f64) -> f64 {
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta_below(b, a, y, x);
    }
    incomplete_beta_below(a, b, x, y)
}

fn incomplete_beta_below(a: f64, b: f64, x: f64, y: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let sure = |v: f64| if v.abs() < TINY { TINY } else { v };
    let mut c = 1.0;
    let mut d = 1.0 / sure(1.0 - (a + b) * x / (a + 1.0));
    let mut sum = d;
    let mut m = 0.0;
    loop {
        m += 1.0;
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut step = 1.0;
        for term in [even, odd] {
            d = 1.0 / sure(1.0 + term * d);
            c = sure(1.0 + term / c);
            step = c * d;
            sum *= step;
        }
        // the terms end at m = b, where a whole b makes the fraction finite
        if (step - 1.0).abs() < 1e-15 || m > 1e7 {
            return binomial(a, a + b - 1.0, x, y) * y * sum;
        }
    }
}

/// Returns the probability of k successes in n draws, each with probability p = 1 − q, 0 < k ≤ n.
///
/// Source: C. Loader, “Fast and accurate computation of binomial probabilities” (2000): deviances, so that nothing
/// large cancels.
fn binomial(k: f64, n: f64, p: f64, q: f64) -> f64 {
    if k >= n {
        return libm::exp(n * libm::log(p));
    }
    let rest = n - k;
    let exponent =
        stirling_rest(n) - stirling_rest(k) - stirling_rest(rest) - deviance(k, n * p) - deviance(rest, n * q);
    libm::exp(exponent) * libm::sqrt(n / (std::f64::consts::TAU * k * rest))
}

/// Returns ln n! less Stirling's formula √(2πn) (n/e)ⁿ.
fn stirling_rest(n: f64) -> f64 {
    if n < 16.0 {
        let half_log_tau = 0.918_938_533_204_672_8;
        return libm::lgamma(n + 1.0) - (n + 0.5) * libm::log(n) + n - half_log_tau;
    }
    let r = 1.0 / (n * n);
    (1.0 / 12.0 - r * (1.0 / 360.0 - r * (1.0 / 1260.0 - r * (1.0 / 1680.0 - r / 1188.0)))) / n
}

/// Returns k ln(k/m) + m − k, which is small where k and m are close.
fn deviance(k: f64, m: f64) -> f64 {
    let v = (k - m) / (k + m);
    if v.abs() >= 0.1 {
        return k * libm::log(k / m) + m - k;
    }
    let mut sum = (k - m) * v;
    let mut power = 2.0 * k * v;
    let mut odd = 3.0;
    loop {
        power *= v * v;
        let term = power / odd;
        sum += term;
        if term.abs() <= 0.5 * f64::EPSILON * sum.abs() {
            return sum;
        }
        odd += 2.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Successes, samples, confidence and both bounds: mpmath 1.3 at 40 digits; the last three scipy 1.17,
    /// `scipy.stats.beta`.
    #[expect(clippy::excessive_precision, reason = "as computed")]
    const BOUNDS: &[(u64, u64, f64, f64, f64)] = &[
        (1, 10, 0.95, 0.002_528_578_544_461_786_8, 0.445_016_117_028_195_36),
        (5, 10, 0.95, 0.187_086_028_447_398_57, 0.812_913_971_552_601_43),
        (9, 10, 0.99, 0.455_712_943_100_313_2, 0.999_498_871_424_535_37),
        (3, 1000, 0.95, 0.000_619_099_931_649_571_48, 0.008_742_023_238_478_302_3),
        (500, 1000, 0.9, 0.473_517_731_235_691_2, 0.526_482_268_764_308_8),
        (1, 1_000_000, 0.95, 2.531_780_766_379_42e-8, 5.571_630_655_172_243_3e-6),
        (123_456, 1_000_000, 0.95, 0.122_811_841_629_629_73, 0.124_102_340_276_802_68),
        (17, 123_456_789, 0.99, 6.683_015_623_156_857e-8, 2.494_037_637_522_447e-7),
        (61_728_394, 123_456_789, 0.99, 0.499_884_079_582_605_3, 0.500_115_912_317_395),
    ];

    #[test]
    fn bounds_are_those_of_the_beta_distribution() {
        for &(k, n, confidence, lo, hi) in BOUNDS {
            let found = clopper_pearson(k, n, confidence);
            for (found, known) in [(found.lo, lo), (found.hi, hi)] {
                assert!((found - known).abs() <= 1e-10 * known.min(1.0 - known), "{k} of {n}: {found}, not {known}");
            }
        }
    }

    #[test]
    fn both_ends_mirror_each_other() {
        for (k, n) in [(0, 17), (3, 17), (1, 100_000), (49_999, 100_000)] {
            let (one, other) = (clopper_pearson(k, n, 0.9), clopper_pearson(n - k, n, 0.9));
            assert!(
                (one.lo - (1.0 - other.hi)).abs() < 1e-12 && (one.hi - (1.0 - other.lo)).abs() < 1e-12,
                "{k} of {n}"
            );
            let estimate = one.estimate.unwrap();
            assert!(one.lo <= one.at_least && one.at_least <= estimate && estimate <= one.hi, "{k} of {n}");
        }
    }

    /// The promise itself: summed over all outcomes, the interval holds the true probability at least as often as it
    /// says, and so does the one-sided bound.
    #[test]
    fn it_holds_the_truth_at_least_as_often_as_it_says() {
        for n in [1, 2, 5, 20, 60] {
            let intervals: Vec<_> = (0..=n).map(|k| clopper_pearson(k, n, 0.95)).collect();
            for i in 1..200_u32 {
                let p = f64::from(i) / 200.0;
                let mut weight = (1.0 - p).powi(i32::try_from(n).unwrap());
                let (mut two_sided, mut one_sided) = (0.0, 0.0);
                for (k, interval) in intervals.iter().enumerate() {
                    if interval.lo <= p && p <= interval.hi {
                        two_sided += weight;
                    }
                    if interval.at_least <= p {
                        one_sided += weight;
                    }
                    #[expect(clippy::cast_precision_loss, reason = "small counts")]
                    let (k, n) = (k as f64, n as f64);
                    weight *= (n - k) / (k + 1.0) * p / (1.0 - p);
                }
                let least = f64::min(two_sided, one_sided);
                assert!(least >= 0.95 - 1e-12, "{least} at p = {p}, n = {n}");
            }
        }
    }
}
