//! Student's t: how far an estimate may be from the truth where the scatter is estimated from the same data.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Returns the value that |t| passes with probability `alpha`, for so many degrees of freedom; none: the scatter is known, and t
/// is normal.
pub(super) fn two_sided(alpha: f64, degrees: Option<f64>) -> f64 {
    let Some(degrees) = degrees else { return -Normal::standard().inverse_cdf(0.5 * alpha) };
    let t = StudentsT::new(0.0, 1.0, degrees);
    t.map_or(f64::INFINITY, |t| -t.inverse_cdf(0.5 * alpha))
}

#[cfg(test)]
mod tests {
    use super::two_sided;

    /// `scipy.stats.t.ppf(1 - alpha/2, n)` of scipy 1.17.
    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (alpha, degrees, known) in [
            (0.05, Some(1.0), 12.706_204_736_174_7),
            (0.05, Some(2.0), 4.302_652_729_749_46),
            (0.05, Some(7.0), 2.364_624_251_592_79),
            (0.05, Some(30.0), 2.042_272_456_301_24),
            (0.001, Some(5.0), 6.868_826_625_881_56),
            (0.05, Some(1000.0), 1.962_339_080_792_25),
            (0.05, None, 1.959_963_984_540_05),
        ] {
            let found = two_sided(alpha, degrees);
            assert!((found - known).abs() <= 1e-9 * known, "{alpha}, {degrees:?}: {found}, not {known}");
        }
    }
}
