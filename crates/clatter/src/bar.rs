//! The bar: how its mass lies and how its ends rebound.

use crate::Error;

/// Coefficient of restitution of an end, in [0, 1]: departure speed over approach speed.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Restitution(f64);

impl Restitution {
    /// # Errors
    /// [`Error::Restitution`] unless 0 ≤ e ≤ 1; −0 counts as 0.
    pub fn new(e: f64) -> Result<Self, Error> {
        if (0.0..=1.0).contains(&e) { Ok(Self(e + 0.0)) } else { Err(Error::Restitution(e)) }
    }
    /// The value.
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }
}

/// A rigid bar with symmetric mass that strikes the ground at its ends only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    q: f64,
    e: Restitution,
}

impl Bar {
    /// From inertia ratio q and restitution e.
    /// # Errors
    /// [`Error::InertiaRatio`] unless −1 < q ≤ 1, [`Error::Restitution`] unless 0 ≤ e ≤ 1.
    pub fn new(q: f64, e: f64) -> Result<Self, Error> {
        if !(q > -1.0 && q <= 1.0) {
            return Err(Error::InertiaRatio(q));
        }
        Ok(Self { q: q + 0.0, e: Restitution::new(e)? })
    }
    /// From k = ρ/L, the radius of gyration over the half-length; exact near q = 1.
    /// # Errors
    /// [`Error::Quantity`] unless 0 ≤ k ≤ 1e150, [`Error::Restitution`] unless 0 ≤ e ≤ 1.
    pub fn from_gyration_ratio(k: f64, e: f64) -> Result<Self, Error> {
        Self::new((1.0 - k * k) / (1.0 + k * k), e)
    }
    /// Inertia ratio `q = (L² − ρ²)/(L² + ρ²)`.
    #[must_use]
    pub fn q(&self) -> f64 {
        self.q
    }
    /// Restitution.
    #[must_use]
    pub fn e(&self) -> f64 {
        self.e.get()
    }
    /// ρ/L, the radius of gyration over the half-length: `√((1 − q)/(1 + q))`.
    #[must_use]
    pub fn gyration_ratio(&self) -> f64 {
        ((1.0 - self.q) / (1.0 + self.q)).sqrt()
    }
}
