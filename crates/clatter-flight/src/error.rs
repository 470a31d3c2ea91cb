//! The one error type of the crate.

/// A drop that no flight answers.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value that describes no drop.
    #[error(transparent)]
    Given(#[from] clatter::Error),
    /// A contact time or a radius of gyration beyond what this body and this drop allow.
    #[error("{name} {}: {} {} here, {reason}", milli(*value, unit), if *most { "at most" } else { "at least" }, milli(towards(*bound, *most), unit))]
    Bound {
        /// What the value stands for.
        name: &'static str,
        /// The value, in SI.
        value: f64,
        /// The largest or smallest value that is allowed here, in SI.
        bound: f64,
        /// Whether it is the largest.
        most: bool,
        /// Its SI unit.
        unit: &'static str,
        /// Where the bound comes from.
        reason: &'static str,
    },
    /// A contact whose restitution is not that of the drop.
    #[error("the restitution of the contact is {contact:?}, that of the drop {scene:?}; allowed: the same for both")]
    Restitution {
        /// That of the contact.
        contact: f64,
        /// That of the drop.
        scene: f64,
    },
    /// Contacts that differ from point to point by another law than the hysteretic one.
    #[error(
        "contacts that differ are hysteretic: dashpots that differ couple the vibrations of a body, which is no sum of modes then"
    )]
    Laws,
    /// A motion that does not keep its energy.
    #[error(
        "the motion changes its energy by {:.2} % without reason: it is no answer (contacts so long that they turn the body far, or so short that roundings of heights count)",
        100.0 * share
    )]
    Energy {
        /// What was made and lost, without regard to sign, over the energy at the first touch.
        share: f64,
    },
}

/// In thousandths of the unit.
fn milli(x: f64, unit: &str) -> String {
    let thousandths: f64 = format!("{:.12e}", 1e3 * x).parse().unwrap_or(x);
    if (1e-3..1e6).contains(&thousandths) {
        format!("{thousandths} m{unit}")
    } else {
        format!("{thousandths:e} m{unit}")
    }
}

/// Three digits of a bound, on the side that is allowed.
fn towards(bound: f64, most: bool) -> f64 {
    let digit = libm::pow(10.0, libm::log10(bound.abs()).floor() - 2.0);
    let digits = bound / digit;
    digit * if most { (digits + 1e-9).floor() } else { (digits - 1e-9).ceil() }
}
