//! This module decides which of several explanations of the same data counts: Akaike's information criterion.

use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor};

/// Explanations whose criterion is above the least one by no more are about as good: their likelihood is a twentieth of that of the
/// best one or more, 2 ln 20.
pub(super) const SIMILAR: f64 = 5.991_464_547_107_98;

/// Confidence of the intervals is one less this.
pub(super) const ALPHA: f64 = 0.05;

/// The data that an explanation leaves unexplained, and the price that it pays for its unknowns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Score {
    misfit: f64,
    paid: f64,
    /// True where there are data enough for the assumptions of the explanation.
    is_supported: bool,
}

/// The assumptions of an explanation next to its free unknowns.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Faults {
    /// Strikes that it drops or invents. Each pays as an unknown does.
    pub(super) count: usize,
    /// The number of ways in which that may be done, as a logarithm.
    pub(super) ln_ways: f64,
}

impl Faults {
    /// Returns the assumptions of two records together.
    pub(super) fn and(self, other: Self) -> Self {
        Self { count: self.count + other.count, ln_ways: self.ln_ways + other.ln_ways }
    }
}

impl Score {
    /// Returns the score of a sum of squares over so many data with so many free unknowns.
    ///
    /// Where the standard deviation of the data is `known`, it is χ² + 2 k (Akaike 1974); where it is one unknown more,
    /// n ln(χ²/n) + 2 k + 2 k (k + 1)/(n − k − 1) (Hurvich and Tsai 1989), with 1 for the last divisor at least. One of many
    /// ways pays 2 ln of their number for having been chosen among them (Foster and George 1994).
    #[expect(clippy::cast_precision_loss, reason = "counts of data")]
    pub(super) fn new(sum: f64, data: usize, free: usize, faults: Faults, known: bool) -> Self {
        let (n, k) = (data as f64, (free + faults.count + usize::from(!known)) as f64);
        let ways = 2.0 * faults.ln_ways;
        if known {
            return Self { misfit: sum, paid: 2.0 * k + ways, is_supported: true };
        }
        let spare = n - k - 1.0;
        let paid = 2.0 * k + 2.0 * k * (k + 1.0) / spare.max(1.0) + ways;
        Self { misfit: n * libm::log(sum / n), paid, is_supported: spare > 0.0 }
    }

    /// Returns how far it is above another.
    pub(super) fn above(&self, other: &Self) -> f64 {
        self.misfit + self.paid - (other.misfit + other.paid)
    }

    /// Returns whether there are data enough for its assumptions.
    pub(super) fn is_supported(&self) -> bool {
        self.is_supported
    }
}

/// Returns the value that the sum of squares of so many normal numbers exceeds with a probability.
pub(super) fn chi_square(alpha: f64, degrees: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a count of data")]
    let chi = ChiSquared::new(degrees as f64);
    chi.map_or(f64::INFINITY, |chi| chi.inverse_cdf(1.0 - alpha))
}

/// Returns the probability that of two variances of the same noise, by so many degrees of freedom each, the first is so many times the
/// second or more.
pub(super) fn variances_differ(ratio: f64, [first, second]: [f64; 2]) -> f64 {
    FisherSnedecor::new(first, second).map_or(1.0, |distribution| distribution.sf(ratio))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worked out by hand: 10 data, 3 free unknowns, one strike out of 20 dropped.
    #[test]
    fn a_strike_that_is_dropped_is_paid_for() {
        let dropped = Faults { count: 1, ln_ways: 20_f64.ln() };
        let [plain, with] = [Faults::default(), dropped].map(|faults| Score::new(15.0, 10, 3, faults, true));
        assert!((with.above(&plain) - (2.0 + 2.0 * 20_f64.ln())).abs() < 1e-12, "{with:?}");
        // k = 4 and 5 with the deviation: 8 + 40/5 and 10 + 60/4.
        let [plain, with] = [Faults::default(), dropped].map(|faults| Score::new(15.0, 10, 3, faults, false));
        assert!((with.above(&plain) - (25.0 - 16.0 + 2.0 * 20_f64.ln())).abs() < 1e-12, "{with:?}");
        // A tenth of the sum is 10 ln 10 less.
        let less = Score::new(1.5, 10, 3, Faults::default(), false);
        assert!((plain.above(&less) - 10.0 * 10_f64.ln()).abs() < 1e-12, "{less:?}");
        // Six data and four unknowns with the deviation leave one to spare; a fifth leaves none.
        assert!(Score::new(1.0, 6, 3, Faults::default(), false).is_supported());
        assert!(!Score::new(1.0, 6, 3, dropped, false).is_supported());
    }

    /// `scipy.stats.chi2.isf` of scipy 1.17; of two degrees it is −2 ln α.
    #[test]
    fn quantiles_are_those_of_the_tables() {
        assert!((chi_square(1e-4, 2) + 2.0 * 1e-4_f64.ln()).abs() < 1e-6);
        assert!((chi_square(0.05, 1) - 3.841_458_820_694_12).abs() < 1e-6);
        assert!((chi_square(0.05, 10) - 18.307_038_053_275_1).abs() < 1e-6);
    }
}
