//! Common functions for evenly sampled accelerations: the check at the door, sums, the peak.

use crate::Error;

/// The largest acceleration (m/s²) that is accepted: far beyond any real one, and squares of it add up far within the
/// range of floats.
pub const LARGEST: f64 = 1e100;
/// Times between samples (s) that are accepted, far beyond those of any recorder; displacements stay far within the
/// range of floats.
const STEPS: std::ops::RangeInclusive<f64> = 1e-15..=1e9;

/// Refuses invalid histories: a time between samples out of range, too few samples, a sample that is not finite. `what`
/// names the analysis, such as "a fit", which takes `needed` samples.
///
/// # Errors
///
/// [`Error::Quantity`] for a time between samples outside [1e-15, 1e9] s; [`Error::Short`]; [`Error::Sample`] for one beyond
/// [`LARGEST`].
pub fn check(acceleration: &[f64], step_s: f64, what: &'static str, needed: usize) -> Result<(), Error> {
    if !STEPS.contains(&step_s) {
        return Err(Error::Quantity { name: "time between samples (s)", value: step_s, allowed: "in [1e-15, 1e9]" });
    }
    if acceleration.len() < needed {
        return Err(Error::Short { what, samples: acceleration.len(), needed });
    }
    // NaN is in no range.
    match acceleration.iter().position(|a| !(-LARGEST..=LARGEST).contains(a)) {
        Some(i) => Err(Error::Sample { sample: i + 1, value: acceleration[i] }),
        None => Ok(()),
    }
}

/// Returns a count of samples as a number.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "no history has 2^53 samples")]
pub fn float(count: usize) -> f64 {
    count as f64
}

/// Returns the index of the first sample of largest size.
#[must_use]
pub fn peak(acceleration: &[f64]) -> usize {
    let mut best = 0;
    for (i, a) in acceleration.iter().enumerate() {
        if a.abs() > acceleration[best].abs() {
            best = i;
        }
    }
    best
}

/// A sum that keeps its rounding errors (Neumaier 1974): its error is that of one rounding of the result and ε² of the
/// sum of sizes for each term.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sum {
    total: f64,
    rest: f64,
}

impl Sum {
    /// Adds a term.
    #[inline]
    pub fn add(&mut self, term: f64) {
        // Knuth's two-sum, without a branch on which one is larger.
        let total = self.total + term;
        let added = total - self.total;
        self.rest += (self.total - (total - added)) + (term - added);
        self.total = total;
    }
    /// Returns both parts of the sum.
    #[inline]
    #[must_use]
    pub fn parts(self) -> [f64; 2] {
        [self.total, self.rest]
    }
    /// Returns the sum.
    #[inline]
    #[must_use]
    pub fn value(self) -> f64 {
        self.total + self.rest
    }
}

/// Returns the sum of terms.
pub fn sum(terms: impl IntoIterator<Item = f64>) -> f64 {
    let mut sum = Sum::default();
    for term in terms {
        sum.add(term);
    }
    sum.value()
}
