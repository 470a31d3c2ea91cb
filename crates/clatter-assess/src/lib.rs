//! This crate goes from a product to verdicts: how a drop is answered, the worst drop, what each part stands.
//!
//! [`answer`] is the one way from a drop to a number. Inside, all quantities are SI.
//!
//! # If you have X, call Y
//! - A product file that was read: [`assess()`].
//! - An assessment with parts that are not safe: [`remedies`].
//! - Distributions in place of ranges: [`scatter::Sampler`].
//! - One drop and one part: [`answer`], or [`respond`] for all its peaks.
//!
//! # Examples
//! ```
//! use clatter_assess::assess;
//! use clatter_product::{EXAMPLE, ProductFile};
//! let file = ProductFile::read(EXAMPLE, "example.toml")?;
//! let assessment = assess(&file)?;
//! assert_eq!(assessment.components.len(), file.components.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")
)]

mod assess;
mod bound;
mod case;
mod decide;
pub mod design;
mod engine;
mod history;
pub mod ladder;
mod model;
mod portrait;
mod reason;
mod reliable;
mod repeat;
pub mod scatter;
mod search;
mod shock;
mod verdict;

pub use assess::{assess, assess_one, assess_to, assess_watched};
pub use case::{Case, CaseStop, Swings};
pub use design::{least_margin, remedies, remedies_watched};
pub use engine::{Answer, Part, answer, respond};
pub use ladder::ladders;
pub use portrait::{CornerStrike, Curve, PlaceMap, PlatePortrait, Point, Portrait, portraits};
pub use reason::{Contradiction, Doubt, Note, Reason};
pub use reliable::reliable;
pub use repeat::repeat;
pub use search::Watch;
pub use verdict::{
    Accuracy, Assessment, Assumed, AtStop, ComponentAssessment, LandingAssessment, LandingLimit, LimitAssessment,
    ModelChoice, Sides, Verdict, WorstCase,
};
