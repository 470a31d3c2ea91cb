//! Student's t distribution: how far an estimate may be from the truth where the scatter is estimated from the same data.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

/// Beyond so many degrees of freedom the first term of the expansion about the normal distribution is good to 1e−5.
const MANY: usize = 200;

/// The value that |t| passes with probability `alpha`, for so many degrees of freedom; none: the scatter is known, and t is
/// normal.
///
/// # Formula
/// The finite sums of Abramowitz and Stegun 26.7.3 and 26.7.4, inverted by bisection; beyond 200 degrees of freedom
/// z + (z³ + z)/(4 ν) (26.7.5).
///
/// # Accuracy
/// 1e−9 up to 200 degrees of freedom, 1e−5 beyond, for alpha in [1e−12, 1).
pub(super) fn two_sided(alpha: f64, degrees: Option<usize>) -> f64 {
    let exceeds: Box<dyn Fn(f64) -> f64> = match degrees {
        Some(n) if n <= MANY => Box::new(move |t| beyond(t, n)),
        _ => Box::new(|z| libm::erfc(z / SQRT_2)),
    };
    // Bisection in the angle whose tangent is t, which is between 0 and a right angle however far t goes.
    let (mut lo, mut hi) = (0.0, FRAC_PI_2);
    for _ in 0..80 {
        let middle = 0.5 * (lo + hi);
        *(if exceeds(libm::tan(middle)) > alpha { &mut lo } else { &mut hi }) = middle;
    }
    let t = libm::tan(0.5 * (lo + hi));
    match degrees {
        #[expect(clippy::cast_precision_loss, reason = "a count of data")]
        Some(n) if n > MANY => t + (t * t * t + t) / (4.0 * n as f64),
        _ => t,
    }
}

/// Probability of |t| beyond a value, for so many degrees of freedom, at least 1.
fn beyond(t: f64, degrees: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "at most 200")]
    let (tangent, count) = (t / (degrees as f64).sqrt(), degrees as f64);
    let cos2 = 1.0 / (1.0 + tangent * tangent);
    let (sin, cos) = (tangent * cos2.sqrt(), cos2.sqrt());
    let mut term = if degrees % 2 == 1 { cos } else { 1.0 };
    let mut sum = if degrees == 1 { 0.0 } else { term };
    let mut k = if degrees % 2 == 1 { 1.0 } else { 0.0 };
    while k + 3.0 < count {
        term *= cos2 * (k + 1.0) / (k + 2.0);
        sum += term;
        k += 2.0;
    }
    let within = if degrees % 2 == 1 { (libm::atan(tangent) + sin * sum) * 2.0 / PI } else { sin * sum };
    1.0 - within
}

#[cfg(test)]
mod tests {
    use super::two_sided;

    /// `scipy.stats.t.ppf(1 - alpha/2, n)` of scipy 1.17.
    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (alpha, degrees, known, error) in [
            (0.05, Some(1), 12.706_204_736_174_7, 1e-9),
            (0.05, Some(2), 4.302_652_729_749_46, 1e-9),
            (0.05, Some(3), 3.182_446_305_283_71, 1e-9),
            (0.05, Some(4), 2.776_445_105_197_79, 1e-9),
            (0.05, Some(7), 2.364_624_251_592_79, 1e-9),
            (0.05, Some(30), 2.042_272_456_301_24, 1e-9),
            (0.001, Some(5), 6.868_826_625_881_56, 1e-9),
            (0.05, Some(1000), 1.962_339_080_792_25, 1e-5),
            (0.05, None, 1.959_963_984_540_05, 1e-9),
        ] {
            let found = two_sided(alpha, degrees);
            assert!((found - known).abs() <= error * known, "{alpha}, {degrees:?}: {found}, not {known}");
        }
    }
}
