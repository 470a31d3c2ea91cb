//! Two contact laws, both linear in pieces, fitted to a restitution and to the time that a lone contact takes.

use clatter::{Error, Restitution};
use serde::{Deserialize, Serialize};

use crate::scene::within;

/// The force of the ground on a point that presses into it by a depth d.
///
/// Both have the restitution e at any speed and the stated contact time τ for a lone contact without gravity. With ω₁ and
/// μ = 1 + (lever arm/radius of gyration)² at the moment of touch, forces are per mass of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactLaw {
    /// Loading along F = k₁ d; unloading and reloading along F = k₂ (d − d₀) with k₂ = k₁/e² and d₀ = d_max (1 − e²),
    /// never pulling; back at d_max the point is on the first line again (after Walton and Braun). After parting below
    /// the ground, the next press begins there as new, d₀ lower, until the point has been above the ground. With ω₁ =
    /// (π/2)(1 + e)/τ and k₁ = ω₁²/μ the pulse is a quarter sine of τ/(1 + e) and a quarter cosine of τ e/(1 + e): its
    /// largest force is that of the half-sine with the same length and velocity change, which shock tables and
    /// standards mean.
    #[default]
    Hysteretic,
    /// A spring and a dashpot, F = κ (d + θ d′), never pulling. The force jumps as the point touches, and is largest
    /// there below e ≈ 0.3; some rubber behaves so.
    Dashpot,
}

impl ContactLaw {
    /// All laws.
    pub const ALL: [Self; 2] = [Self::Hysteretic, Self::Dashpot];
    /// Names of the laws, in that order.
    pub const NAMES: [&'static str; Self::ALL.len()] = ["hysteretic", "dashpot"];
    /// Returns `hysteretic` or `dashpot`.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
    /// Returns the law in running text.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Hysteretic => "hysteretic, with the largest force of a half-sine",
            Self::Dashpot => "spring and dashpot",
        }
    }
    /// Returns the law of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|law| law.name() == name)
    }
    /// Returns whether the law takes energy by unloading along a stiffer line than that of loading, and so leaves a
    /// dent; else it takes it by a dashpot.
    #[must_use]
    pub const fn leaves_a_dent(self) -> bool {
        match self {
            Self::Hysteretic => true,
            Self::Dashpot => false,
        }
    }
    /// Returns the other law.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Hysteretic => Self::Dashpot,
            Self::Dashpot => Self::Hysteretic,
        }
    }
}

/// A contact law fitted to a lone contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    law: ContactLaw,
    e: f64,
    time_s: f64,
    frequency: f64,
    damping: f64,
}

/// The restitution below which a hysteretic contact does not rebound at all: the error is 1e-4 of a shock.
const PLASTIC: f64 = 1e-4;
/// The restitution of a dashpot below that value: its damping has no limit at e = 0.
const LEAST_OF_DASHPOT: f64 = 1e-3;
/// The most steps of Newton's method in the fit: eight are enough.
const NEWTON: usize = 12;

impl Contact {
    /// Creates the contact with restitution `e` whose lone contact lasts `time_s`.
    ///
    /// # Accuracy
    /// A lone contact without gravity has this restitution and this duration to 1e−9; a hysteretic one with e below 1e−4
    /// rebounds with 0, a dashpot with e below 1e−3 with 1e−3.
    ///
    /// # Errors
    /// [`Error::Restitution`] unless 0 ≤ e ≤ 1, [`Error::Quantity`] unless the time is in [1e−12, 1e3] s.
    ///
    /// # Examples
    /// ```
    /// use clatter_flight::{Contact, ContactLaw};
    /// let contact = Contact::new(ContactLaw::Hysteretic, 0.5, 1e-3)?;
    /// assert!((contact.frequency_rad_s() - 0.75e3 * std::f64::consts::PI).abs() < 1e-9);
    /// let rubber = Contact::new(ContactLaw::Dashpot, 0.451, 1e-3)?;
    /// assert!((rubber.damping_ratio() - 0.3).abs() < 1e-3);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn new(law: ContactLaw, e: f64, time_s: f64) -> Result<Self, Error> {
        let e = Restitution::new(e)?.get();
        within("contact time in s", time_s, 1e-12, 1e3, "in [1e-12, 1000]")?;
        let (frequency, damping) = match law {
            ContactLaw::Hysteretic => (std::f64::consts::FRAC_PI_2 * (1.0 + e) / time_s, 0.0),
            ContactLaw::Dashpot => {
                let (phase, damping) = dashpot(e.max(LEAST_OF_DASHPOT));
                (phase / time_s, damping)
            }
        };
        Ok(Self { law, e, time_s, frequency, damping })
    }
    /// Returns the same contact with another duration.
    pub(super) fn lasting(self, time_s: f64) -> Self {
        // Frequencies are angles over the time.
        Self { time_s, frequency: self.frequency * self.time_s / time_s, ..self }
    }
    /// Returns the contact of half of its stiffness and damping: two of them press as this one does.
    pub(crate) fn half(self) -> Self {
        let damping = self.damping / std::f64::consts::SQRT_2;
        Self { damping, ..self.lasting(std::f64::consts::SQRT_2 * self.time_s) }
    }
    /// Returns the law.
    #[must_use]
    pub fn law(&self) -> ContactLaw {
        self.law
    }
    /// Returns the restitution.
    #[must_use]
    pub fn restitution(&self) -> f64 {
        self.e
    }
    /// Returns the duration of a lone contact.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.time_s
    }
    /// Returns the natural angular frequency of a lone contact as it loads, ω₁ or the dashpot's ω.
    #[must_use]
    pub fn frequency_rad_s(&self) -> f64 {
        self.frequency
    }
    /// Returns the damping ratio of a lone contact: 0 for a hysteretic one.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        self.damping
    }
    /// Returns the largest acceleration of the contact point in a lone contact over the change of its velocity, in 1/s.
    ///
    /// # Formula
    /// Hysteretic: (π/2)/τ, that of a half-sine. Dashpot, which touches at v: 2ζω v at the touch and later less where ζ ≥ ½, else
    /// ω v exp(−ζ (3 arccos ζ − π)/√(1 − ζ²)) later on; over (1 + e) v.
    #[must_use]
    pub fn peak_per_change(&self) -> f64 {
        let zeta = self.damping;
        let per_speed = if zeta < 0.5 {
            let later = (3.0 * libm::acos(zeta) - std::f64::consts::PI) / (1.0 - zeta * zeta).sqrt();
            libm::exp(-zeta * later)
        } else {
            2.0 * zeta
        };
        self.frequency * per_speed / (1.0 + self.e)
    }
    /// Returns θ of F = κ (d + θ d′).
    pub(super) fn delay_s(&self) -> f64 {
        2.0 * self.damping / self.frequency
    }
    /// Returns whether a point stays at the largest depth of its first loading.
    pub(super) fn is_plastic(&self) -> bool {
        self.law.leaves_a_dent() && self.e < PLASTIC
    }
    /// Returns the share of a velocity that the line of unloading gives back, which lever arms must resolve: e, or 1
    /// where there is no such line.
    pub(super) fn springs_back(&self) -> f64 {
        if self.law.leaves_a_dent() && !self.is_plastic() { self.e } else { 1.0 }
    }
    /// Returns the stiffness of unloading over that of loading, for a law that leaves a dent.
    pub(super) fn unloading(&self) -> f64 {
        if self.is_plastic() { f64::INFINITY } else { self.e.powi(-2) }
    }
}

/// Returns ωτ and damping ratio of a spring and dashpot with restitution e.
///
/// A lone contact without gravity parts when d + θ d′ = 0. With ζ = cos β (or cosh β beyond critical damping)
///
/// ```text
/// ω τ = 2β/sin β   (2β/sinh β),   e = exp(−ζ ω τ) = exp(−2β cot β)   (exp(−2β coth β))
/// ```
///
/// which is solved for β² by Newton's steps to a few roundings.
fn dashpot(e: f64) -> (f64, f64) {
    /// Returns β, sin β and cos β of β² = x; sinh and cosh where x is negative.
    fn angle(x: f64) -> (f64, f64, f64) {
        let b = x.abs().sqrt();
        let (sine, cosine) = if x > 0.0 { libm::sincos(b) } else { (libm::sinh(b), libm::cosh(b)) };
        (b, sine, cosine)
    }
    let loss = -libm::log(e); // ζ ω τ
    // β cot β, and β coth β with x = −β², are one function of x = β², 1 − x/3 − …, which falls and is concave: Newton's
    // steps from where its tangent at 0 has the value stay on one side of x.
    let mut x = 3.0 - 1.5 * loss;
    for _ in 0..NEWTON {
        let (b, sine, cosine) = angle(x);
        let (value, slope) = if b < 1e-4 {
            (1.0 - x / 3.0, -1.0 / 3.0)
        } else {
            (b * cosine / sine, (sine * cosine - b).copysign(-1.0) / (2.0 * b * sine * sine))
        };
        let step = (0.5 * loss - value) / slope;
        x += step;
        if step.abs() <= 4.0 * f64::EPSILON * x.abs().max(1.0) {
            break;
        }
    }
    let (b, sine, cosine) = angle(x);
    let stretch = if b > 0.0 { b / sine } else { 1.0 };
    (2.0 * stretch, if loss > 0.0 { cosine } else { 0.0 })
}
