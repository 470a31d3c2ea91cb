//! This module says how many products in a row have to hold for a reliability at a confidence.

use std::fmt::{Display, Formatter};

use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

use crate::keys;
use crate::units::SURE;
use crate::{Error, ProductFile};

/// A share of all products that is to survive, and how sure that is to be.
///
/// # Examples
/// The usual one of industry takes 299 products without a failure:
/// ```
/// use clatter_product::Reliability;
/// let asked = Reliability::new(0.99, 0.95)?;
/// assert_eq!((asked.samples(), asked.to_string()), (299, "R99 C95".to_owned()));
/// assert!(Reliability::new(1.0, 0.95).is_err());
/// # Ok::<(), clatter_product::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reliability {
    reliability: f64,
    confidence: f64,
}

impl Reliability {
    /// The confidence where none is given.
    pub const CONFIDENCE: f64 = 0.95;

    /// Returns a reliability at a confidence, both as shares below 1.
    ///
    /// # Errors
    /// [`Error::Setting`] for a value that product files do not allow.
    pub fn new(reliability: f64, confidence: f64) -> Result<Self, Error> {
        for (name, value) in [("reliability", reliability), ("confidence", confidence)] {
            if !keys::within(&SURE, VERDICT_SHARES, value) {
                return Err(Error::Setting { name, value, allowed: "a share from 1 % to 99.999 %" });
            }
        }
        Ok(Self { reliability, confidence })
    }
    /// Returns the share of all products that is to survive.
    #[must_use]
    pub fn reliability(&self) -> f64 {
        self.reliability
    }
    /// Returns how sure that is to be.
    #[must_use]
    pub fn confidence(&self) -> f64 {
        self.confidence
    }
    /// Returns how many products in a row have to hold.
    ///
    /// # Formula
    /// n = ⌈ln(1 − C)/ln R⌉: where less than R of all products survive, n in a row do with a probability of less than Rⁿ ≤ 1 − C.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 1 to about a million")]
    pub fn samples(&self) -> u64 {
        let samples = libm::log1p(-self.confidence) / libm::log(self.reliability);
        // A whole number but for roundings is that number.
        (samples * (1.0 - 1e-12)).ceil().max(1.0) as u64
    }
}

impl ProductFile {
    /// Returns the reliability that is asked of the product: what its file says, with what is given in place of that.
    ///
    /// # Errors
    /// As [`Reliability::new`]; [`Error::Confidence`] for a confidence without a reliability.
    pub fn asked(&self, reliability: Option<f64>, confidence: Option<f64>) -> Result<Option<Reliability>, Error> {
        let own = self.reliability;
        match (reliability.or(own.map(|own| own.reliability)), confidence) {
            (None, None) => Ok(None),
            (None, Some(_)) => Err(Error::Confidence),
            (Some(share), given) => {
                let confidence = given.or(own.map(|own| own.confidence)).unwrap_or(Reliability::CONFIDENCE);
                Reliability::new(share, confidence).map(Some)
            }
        }
    }
}

/// The bounds of both: the largest number of samples is about a million.
pub(crate) const VERDICT_SHARES: [&str; 2] = ["1 %", "99.999 %"];

impl Display for Reliability {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let [reliability, confidence] = [self.reliability, self.confidence].map(|share| (1e8 * share).round() / 1e6);
        write!(f, "R{reliability} C{confidence}")
    }
}

impl Serialize for Reliability {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("Reliability", 3)?;
        fields.serialize_field("reliability", &self.reliability)?;
        fields.serialize_field("confidence", &self.confidence)?;
        fields.serialize_field("samples", &self.samples())?;
        fields.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The published numbers of tests without a failure; n is enough and one less is not.
    #[test]
    fn so_many_in_a_row_are_enough_and_no_fewer() {
        for (reliability, confidence, samples) in
            [(0.9, 0.9, 22), (0.99, 0.95, 299), (0.95, 0.95, 59), (0.5, 0.75, 2), (0.9, 0.99, 44), (0.01, 0.01, 1)]
        {
            assert_eq!(Reliability::new(reliability, confidence).unwrap().samples(), samples);
            let all_hold = |samples: u64| reliability.powi(i32::try_from(samples).unwrap());
            assert!(all_hold(samples) <= 1.0 - confidence + 1e-12);
            assert!(samples == 1 || all_hold(samples - 1) > 1.0 - confidence);
        }
    }

    #[test]
    fn what_is_no_share_below_1_is_refused() {
        for value in [0.0, 1.0, 99.0, -0.5, f64::NAN, f64::INFINITY] {
            for [reliability, confidence] in [[value, 0.95], [0.99, value]] {
                let error = Reliability::new(reliability, confidence).unwrap_err().to_string();
                assert!(error.contains("allowed: a share from 1 % to 99.999 %"), "{error}");
            }
        }
    }
}
