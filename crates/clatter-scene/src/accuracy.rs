//! How well an assessment is to be worked out.

use crate::{BarModel, Error};

/// How well, and by which model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// By how much the models may let the truth pass each demand, as a share of it; in [1e-4, 0.5].
    pub tolerance: f64,
    /// How the bar moves in every drop that is searched; the cheapest within the tolerance, drop by drop, if none is
    /// named.
    pub model: Option<BarModel>,
}

impl Default for Accuracy {
    /// 1 %, by the cheapest models.
    fn default() -> Self {
        Self { tolerance: 0.01, model: None }
    }
}

impl Accuracy {
    /// The same as a share of the truth, which estimates are of: a demand that lacks ε of it is passed by ε/(1 − ε).
    pub(crate) fn of_truth(&self) -> f64 {
        self.tolerance / (1.0 + self.tolerance)
    }
    /// Checks that the tolerance is in range.
    ///
    /// # Errors
    /// [`Error::Tolerance`] for one outside [1e-4, 0.5].
    ///
    /// ```
    /// use clatter_scene::Accuracy;
    /// assert!(Accuracy::default().check().is_ok());
    /// assert!(Accuracy { tolerance: 0.0, model: None }.check().is_err());
    /// ```
    pub fn check(&self) -> Result<(), Error> {
        if (1e-4..=0.5).contains(&self.tolerance) { Ok(()) } else { Err(Error::Tolerance(self.tolerance)) }
    }
}
