//! This module defines the levers that a designer can change, the bounds of a change, and its effect.

use crate::ComponentAssessment;
use clatter_product::{Component, Error, LimitKind, Mount, Product, Stops, units};

/// One thing that a designer can change while all else stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lever {
    /// The product's inertia ratio q, by moving mass.
    InertiaRatio,
    /// Its coefficient of restitution e, by the casing; a range moves as a whole, cut at the bounds.
    Restitution,
    /// The place of the part.
    Position,
    /// The place of the part across a plate.
    Across,
    /// The part's natural frequency; a range is multiplied as a whole.
    Frequency,
    /// The part's damping ratio.
    Damping,
    /// The time of a lone contact of an end, by a bumper; a range is multiplied as a whole.
    ContactTime,
    /// The gap of the part's stops; a range is multiplied as a whole.
    StopGap,
    /// The time of a contact of the part with its stops, by softer ones; a range is multiplied as a whole.
    StopTime,
    /// The allowed value of a limit, by a stronger part or more room; a range is multiplied as a whole, of a damage boundary its critical
    /// velocity change.
    Limit(LimitKind),
}

impl Lever {
    /// Returns the levers of a part: the inertia ratio of a bar, the place across a plate, the contact time where the file gives one, its
    /// stops where it has some, and each of its limits.
    #[must_use]
    pub fn of(product: &Product, component: &Component) -> Vec<Self> {
        let mut levers = if product.body.is_wide() {
            vec![Self::Restitution, Self::Position, Self::Across]
        } else {
            vec![Self::InertiaRatio, Self::Restitution, Self::Position]
        };
        levers.extend([Self::Frequency, Self::Damping]);
        levers.extend(product.contact_time_s.map(|_| Self::ContactTime));
        levers.extend(component.stops.iter().flat_map(|_| [Self::StopGap, Self::StopTime]));
        levers.extend(component.limits.kinds().into_iter().map(Self::Limit));
        levers
    }

    /// Returns its name: `inertia-ratio`, `restitution`, `position`, `position-across`, `natural-frequency`, `damping-ratio`,
    /// `contact-time`, `stop-gap`, `stop-contact-time`; of a limit `acceleration-limit`, `rattle-space`, …
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::InertiaRatio => "inertia-ratio",
            Self::Restitution => "restitution",
            Self::Position => "position",
            Self::Across => "position-across",
            Self::Frequency => "natural-frequency",
            Self::Damping => "damping-ratio",
            Self::ContactTime => "contact-time",
            Self::StopGap => Stops::INPUTS[0].name,
            Self::StopTime => Stops::INPUTS[1].name,
            Self::Limit(kind) => kind.lever(),
        }
    }
    /// Returns its name in tables and pages.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::InertiaRatio => "radius of gyration",
            Self::Restitution => "restitution e",
            Self::Position => "place",
            Self::Across => "place across",
            Self::Frequency => "natural frequency",
            Self::Damping => "damping ratio",
            Self::ContactTime => "contact time",
            Self::StopGap => Stops::INPUTS[0].words,
            Self::StopTime => Stops::INPUTS[1].words,
            Self::Limit(kind) => kind.allowed(),
        }
    }
    /// Returns the SI unit of its values: empty, `m`, `Hz`, `s` or that of the limit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::InertiaRatio | Self::Restitution | Self::Damping => "",
            Self::Position | Self::Across | Self::StopGap => "m",
            Self::Frequency => "Hz",
            Self::ContactTime | Self::StopTime => "s",
            Self::Limit(kind) => kind.unit().name(),
        }
    }
    /// Returns the unit in which the file writes it, where it has one and is known.
    #[must_use]
    pub fn written_in(self, product: &Product, component: &Component) -> Option<&'static units::Unit> {
        match (self, &component.mount) {
            (Self::Position, _) => component.position_m.unit(),
            (Self::Across, _) => component.across_m.unit(),
            (Self::Frequency, Mount::Suspended { frequency_hz, .. }) => frequency_hz.unit(),
            (Self::ContactTime, _) => product.contact_time_s.and_then(|time| time.unit()),
            (Self::StopGap, _) => component.stops.and_then(|stops| stops.gap_m.unit()),
            (Self::StopTime, _) => component.stops.and_then(|stops| stops.contact_time_s.unit()),
            (Self::Limit(kind), _) => component.limits.unit(kind, kind.unit()),
            _ => None,
        }
    }
}

/// The bounds of what a designer can change. A place is bounded by the product itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Inertia ratios that can be built; below 0 the mass would be outside of the body.
    pub q: [f64; 2],
    /// Coefficients of restitution that can be had.
    pub e: [f64; 2],
    /// Largest factor on the natural frequency, up or down.
    pub frequency_factor: f64,
    /// Damping ratios that can be had.
    pub damping: [f64; 2],
    /// Contact times that can be had, in s; of a stop from the least of them to the period of the part.
    pub contact_time_s: [f64; 2],
    /// Largest factor on a limit, up, and on the gap of a stop, up or down.
    pub limit_factor: f64,
}

impl Default for Bounds {
    /// Takes 0 ≤ q ≤ 0.9 and 0.05 ≤ e ≤ 0.9 (neither all mass in the center nor very dead or very bouncy casings can be
    /// built: section 6 of the paper), frequencies a factor of 4 either way, damping ratios up to 0.5, contacts of 0.2 ms to 2 ms (at
    /// 5 m/s an edge then gives by some 5 mm), limits up to 4 times as high.
    fn default() -> Self {
        Self {
            q: [0.0, 0.9],
            e: [0.05, 0.9],
            frequency_factor: 4.0,
            damping: [0.0, 0.5],
            contact_time_s: [0.2e-3, 2e-3],
            limit_factor: 4.0,
        }
    }
}

impl Bounds {
    /// Checks that every bound can be had and every range runs upward.
    ///
    /// # Errors
    /// [`Error::Setting`] unless q is within [−1, 1], e within [0, 1], damping ratios within [0, 100] and contact times within
    /// [1e−12, 1000] s, each from its lower end, and both factors are in [1, 1000].
    pub fn check(&self) -> Result<(), Error> {
        let ranges = [
            ("the bound of q", self.q, [-1.0, 1.0], "within [-1, 1], from the lower end"),
            ("the bound of e", self.e, [0.0, 1.0], "within [0, 1], from the lower end"),
            ("the bound of the damping ratio", self.damping, [0.0, 100.0], "within [0, 100], from the lower end"),
            (
                "the bound of the contact time in s",
                self.contact_time_s,
                [1e-12, 1e3],
                "within [1e-12, 1000], from the lower end",
            ),
            ("the factor on a frequency", [self.frequency_factor; 2], [1.0, 1e3], "in [1, 1000]"),
            ("the factor on a limit", [self.limit_factor; 2], [1.0, 1e3], "in [1, 1000]"),
        ];
        for (name, [lo, hi], [least, most], allowed) in ranges {
            for (value, within) in [(lo, least..=most), (hi, lo..=most)] {
                if !within.contains(&value) {
                    return Err(Error::Setting { name, value, allowed });
                }
            }
        }
        Ok(())
    }
}

/// A change of one lever: low and high end of its value before and after, the same where it is one value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// The lever that is changed.
    pub lever: Lever,
    /// Before.
    pub from: [f64; 2],
    /// After, as it can be specified: to two significant digits in the unit of the file, ranges outward; places and the radius of
    /// gyration behind an inertia ratio to a hundredth of the decade of the side along them, such as 1 mm of 140 mm.
    pub to: [f64; 2],
}

/// The effect of one lever on one part.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// The smallest change that makes it safe with the margin, and what the assessment of the file with these very values says.
    Change {
        /// The change.
        change: Change,
        /// The part, assessed again with the change.
        after: Box<ComponentAssessment>,
    },
    /// No value between these, tried in steps of their distance over [`STEPS`](super::STEPS), makes it safe.
    Nowhere {
        /// The bounds.
        bounds: [f64; 2],
    },
    /// No limit of the part depends on it.
    NoEffect,
    /// It was not tried to its end: the time was over.
    Stopped,
}

/// One lever and what it can do.
#[derive(Debug, Clone, PartialEq)]
pub struct Remedy {
    /// The lever.
    pub lever: Lever,
    /// The effect of the lever.
    pub outcome: Outcome,
}

/// Changes together, and what the assessment then says.
#[derive(Debug, Clone, PartialEq)]
pub struct Together {
    /// One or two changes.
    pub changes: Vec<Change>,
    /// The part, assessed again with them.
    pub after: Box<ComponentAssessment>,
}

/// The remedies that would make one failing part safe.
#[derive(Debug, Clone, PartialEq)]
pub struct Remedies {
    /// Index of the component in the file.
    pub component: usize,
    /// Each lever alone, in the order of [`Lever::of`].
    pub levers: Vec<Remedy>,
    /// The two levers that are enough with the smallest changes, where no lever alone is.
    pub pair: Option<Together>,
    /// The nearest result, where no two levers are enough either.
    pub nearest: Option<Together>,
}
