//! A quantity that is not known to the last digit: a value, a range, or a distribution over a range.

use crate::Error;
use crate::units::Unit;

/// A range [lo, hi] of a quantity in SI, and how it is spread over it.
///
/// The worst case is looked for over the whole range, whatever the distribution; the distribution counts where scatter
/// is drawn.
///
/// ```
/// use clatter_product::{Law, Spread};
/// let tilt = Spread::new(0.0, 0.26, Law::Normal { mean: 0.09, deviation: 0.04 })?;
/// assert_eq!((tilt.lo(), tilt.hi()), (0.0, 0.26));
/// assert!(Spread::new(0.3, 0.2, Law::Range).is_err());
/// # Ok::<(), clatter_product::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    lo: f64,
    hi: f64,
    law: Law,
    unit: Option<&'static Unit>,
}

/// The distribution of a quantity over its range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// One value.
    Value,
    /// Anywhere in the range; nothing more is known.
    Range,
    /// With equal density over the range.
    Uniform,
    /// Normal, cut to the range.
    Normal {
        /// Mean before the cut.
        mean: f64,
        /// Standard deviation before the cut, positive.
        deviation: f64,
    },
    /// Rising from the low end of the range to the mode, falling to the high end.
    Triangular {
        /// The most frequent value, within the range.
        mode: f64,
    },
}

impl Spread {
    /// Returns one value.
    ///
    /// # Errors
    /// [`Error::Number`] unless finite.
    pub fn value(value: f64) -> Result<Self, Error> {
        Self::new(value, value, Law::Value)
    }

    /// Returns one value that is known to be finite.
    #[must_use]
    pub fn finite(value: f64) -> Self {
        Self { lo: value, hi: value, law: Law::Value, unit: None }
    }

    /// Returns a range with its law; one of no length is a value.
    ///
    /// # Errors
    /// [`Error::Number`] unless all numbers are finite, [`Error::Range`] where the range runs backwards, [`Error::Law`]
    /// for a deviation that is not positive, a mode outside the range, or [`Law::Value`] of a range.
    pub fn new(lo: f64, hi: f64, law: Law) -> Result<Self, Error> {
        let (own, allowed) = match law {
            Law::Normal { mean, deviation } => ([mean, deviation], deviation > 0.0),
            Law::Triangular { mode } => ([mode, mode], lo <= mode && mode <= hi),
            Law::Value => ([lo, hi], lo >= hi),
            Law::Range | Law::Uniform => ([lo, hi], true),
        };
        if let Some(&value) = [lo, hi, own[0], own[1]].iter().find(|v| !v.is_finite()) {
            return Err(Error::Number(value));
        }
        if lo > hi {
            return Err(Error::Range { lo, hi });
        }
        if !allowed {
            return Err(Error::Law(law));
        }
        Ok(Self { lo, hi, law: if lo < hi { law } else { Law::Value }, unit: None })
    }

    /// Returns the same, known to be written in this unit.
    #[must_use]
    pub fn written_in(self, unit: Option<&'static Unit>) -> Self {
        Self { unit, ..self }
    }
    /// Returns the unit that it was written in, where it is known: answers about it may be given in the same.
    #[must_use]
    pub fn unit(&self) -> Option<&'static Unit> {
        self.unit
    }
    /// Returns the least value.
    #[must_use]
    pub fn lo(&self) -> f64 {
        self.lo
    }
    /// Returns the largest value.
    #[must_use]
    pub fn hi(&self) -> f64 {
        self.hi
    }
    /// Returns how it is spread.
    #[must_use]
    pub fn law(&self) -> Law {
        self.law
    }
    /// Returns whether it is one value.
    #[must_use]
    pub fn is_value(&self) -> bool {
        self.law == Law::Value
    }
    /// Returns the value at `share` in [0, 1] of the way from the low to the high end.
    #[must_use]
    pub fn at(&self, share: f64) -> f64 {
        (self.lo + share * (self.hi - self.lo)).clamp(self.lo, self.hi)
    }
}
