//! This module lists the errors of a product that was not read from a file, and of an assessment.

use crate::{DataFault, Law};

/// A value that describes no product, and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Data that product files do not allow.
    #[error("{}{fault}", of(component.as_ref()))]
    Data {
        /// The component that has them, by name; none of what all share.
        component: Option<String>,
        /// The fault.
        fault: DataFault,
    },
    /// A time within which impacts are one that is negative or not finite.
    #[error("impacts within {0:?} s are one; allowed: a finite time, not below 0")]
    Merge(f64),
    /// A setting of a design or of a drop that cannot be.
    #[error("{name} is {value:?}; allowed: {allowed}")]
    Setting {
        /// Its name.
        name: &'static str,
        /// Its value, in SI.
        value: f64,
        /// The allowed values.
        allowed: &'static str,
    },
    /// A component that is none of the product, or an assessment of another one.
    #[error("{0:?} is no component of this product with these limits")]
    OtherProduct(String),
    /// An assessment of the same product in other drops.
    #[error("the assessment is that of other drops than those of the product")]
    OtherDrops,
    /// A number that is not finite.
    #[error("{0:?} is not a finite number")]
    Number(f64),
    /// A range that runs backwards.
    #[error("the range begins at {lo:?}, above its end {hi:?}")]
    Range {
        /// Its lower end.
        lo: f64,
        /// Its upper end.
        hi: f64,
    },
    /// An invalid distribution.
    #[error(
        "{0:?} is no distribution over its range: a deviation is positive, a mode within the range, one value has no range"
    )]
    Law(Law),
    /// A tolerance that no model could be held to, or that says nothing.
    #[error("the tolerance is {0:?}; allowed: a share in [1e-4, 0.5]")]
    Tolerance(f64),
    /// A confidence of nothing.
    #[error("a confidence is how sure a reliability is: give that too, or [verdict] in the file")]
    Confidence,
    /// The bar refuses a value.
    #[error(transparent)]
    Bar(#[from] clatter::Error),
    /// The component refuses a value.
    #[error(transparent)]
    Shock(#[from] clatter_shock::Error),
    /// A part for which the pulse is no velocity shock, in a product without contact time.
    #[error("component {component:?} needs the contact time of the product: {reason}")]
    ContactTime {
        /// Name of the component.
        component: String,
        /// The reason.
        reason: String,
    },
    /// A drop that a flight does not answer.
    #[error(transparent)]
    Flight(clatter_flight::Error),
    /// A motion that was given up while more was to come.
    #[error("the motion is left before it ends: after 1024 strikes or 150 000 phases, or where a thick bar turns over")]
    Unfinished,
    /// A search that was stopped by its caller.
    #[error("the search for the worst drop was stopped before")]
    Stopped,
    /// A model that does not follow plates.
    #[error("a plate is followed by the model compliant, not by {}", .0.name())]
    PlateModel(crate::Model),
    /// A model that does not follow contacts that differ.
    #[error("contacts of their own are followed by the model compliant, not by {}", .0.name())]
    OwnContacts(crate::Model),
    /// A method that takes only products whose contacts are alike.
    #[error("{0} takes a product whose contacts are alike, without `contacts` of their own")]
    AlikeContacts(&'static str),
    /// A method that takes only a product that falls once.
    #[error("{0} takes a file with one drop")]
    OneDrop(&'static str),
    /// A method that takes only a drop without this key, such as `spin`.
    #[error("{0} takes a drop without `{1}`")]
    Without(&'static str, &'static str),
    /// A fit of a plate.
    #[error(
        "a fit takes a bar: drop the product on one of its edges, so that it moves as one, and give it without `width`"
    )]
    FitOfPlate,
    /// A method that takes only bars.
    #[error("{0} takes a product without `width`")]
    OfBars(&'static str),
    /// A normal distribution whose range lies where it has no values.
    #[error(
        "{0}: less than 1 in 1e200 values of its normal distribution lie in its range: give a range around the mean"
    )]
    Tail(String),
    /// A model of the contact, in a product without contact time.
    #[error("this model needs the contact time, and none is known")]
    Contact,
}

impl Error {
    /// Returns, of edges that touch, the error of the one that does deeper, so that the report is enough; else the first.
    #[must_use]
    pub fn or_deeper(self, other: Self) -> Self {
        let depth_m = |error: &Self| match error {
            Self::Flight(clatter_flight::Error::Edge { depth_m, .. }) => Some(*depth_m),
            _ => None,
        };
        match (depth_m(&self), depth_m(&other)) {
            (Some(one), Some(two)) if two > one => other,
            _ => self,
        }
    }
}

impl From<clatter_flight::Error> for Error {
    fn from(error: clatter_flight::Error) -> Self {
        match error {
            clatter_flight::Error::ContactTime => Self::Contact,
            clatter_flight::Error::Given(given) => Self::Bar(given),
            error => Self::Flight(error),
        }
    }
}

impl From<DataFault> for Error {
    fn from(fault: DataFault) -> Self {
        Self::Data { component: None, fault }
    }
}

fn of(component: Option<&String>) -> String {
    component.map_or(String::new(), |name| format!("component {name:?}: "))
}
