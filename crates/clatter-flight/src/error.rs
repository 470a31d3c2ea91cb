//! The one error type of the crate.

/// A drop that no flight answers.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value that describes no drop.
    #[error(transparent)]
    Given(#[from] clatter::Error),
    /// A contact time or a radius of gyration beyond what this body and this drop allow.
    #[error("{name} {}: {} here, {reason}", milli(*value, unit), within(*bound, *most, unit))]
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
    /// Contacts that take time, of a drop whose contact time is not known.
    #[error("this model needs the contact time, and none is known")]
    ContactTime,
    /// A plate or a box by instant impacts.
    #[error("a body with a width is followed with contacts that take time")]
    Instant,
    /// A box of a body without a width.
    #[error("a body without a width is no box")]
    NoBox,
    /// An edge beyond the feet that comes down to the ground in the clatter of instant impacts.
    #[error(
        "an edge beyond the feet comes down to {} mm below the ground, {} ms after the first touch, and instant impacts do not \
         follow it: a contact time, higher feet, or feet nearer to the edges",
        rounded(1e3 * depth_m),
        rounded(1e3 * time_s)
    )]
    Edge {
        /// When it is found there, since the first touch.
        time_s: f64,
        /// How far below it would be then.
        depth_m: f64,
    },
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

impl Error {
    /// Returns what is refused by its name, and what would be allowed: contact time, at most 1.1 ms.
    #[must_use]
    pub fn allowed(&self) -> Option<(&'static str, String)> {
        match *self {
            Self::Bound { name, bound, most, unit, .. } => Some((name, within(bound, most, unit))),
            _ => None,
        }
    }
}

fn within(bound: f64, most: bool, unit: &str) -> String {
    format!("{} {}", if most { "at most" } else { "at least" }, milli(towards(bound, most), unit))
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

/// To two decimals.
fn rounded(value: f64) -> f64 {
    (100.0 * value).round() / 100.0
}
