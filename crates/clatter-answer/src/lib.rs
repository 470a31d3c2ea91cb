//! This crate answers the questions of the commands: it takes typed questions and returns answers that serialize to the output of
//! `--format json`.
//!
//! The crate reads no arguments, prints nothing and opens no files. It has one module for each question:
//!
//! - If you have a bar and how it falls, call [`impacts::answer`] for its impacts; of a plate [`impacts::plate::answer`].
//! - If you have a bar and what velocity shock a part survives, call [`zone::answer`]; of a plate [`zone::plate::answer`].
//! - If you want one quantity over all bars, call [`map::answer`].
//! - If you have a drop in m and m/s, [`DropInputs`] makes it from numbers: call [`simulate::answer`] for its strikes in time, and
//!   [`respond::drop::answer`] for its effect on a part.
//! - If you have a part and the source of its shocks (a bar, shocks or pulses), call [`respond::answer`].
//! - If you have a product file, call [`assess::answer`] for verdicts, [`scatter::answer`] for how likely its parts survive,
//!   [`design::answer`] for the changes that make them safe; with records of a measured drop [`fit::answer`].
//! - If you have a record of accelerations, call [`record::answer`] for its content, [`spectrum::answer`] for the response of parts to it.
//! - If you have models that were measured on worst drops, [`explain::Answer`] shows them without their times.
//! - If you have a plate and want the result of every direction of tilt, call [`atlas::answer`].
//!
//! ```
//! use clatter_answer::assess;
//! use clatter_assess::Accuracy;
//! use clatter_product::{EXAMPLE, ProductFile};
//! let file = ProductFile::read(EXAMPLE, "example.toml")?;
//! let answer = serde_json::to_value(assess::answer(&file, &Accuracy::default())?)?;
//! assert_eq!(answer["components"][0]["name"], file.components[0].name.as_str());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Every answer is written as [`Versioned`]: with the version of the program that made it.
//!
//! Where names have no units, velocities are in v0, the drop speed; times in h0/v0, where h0 is the height of end b when end a
//! touches; positions in half-lengths from the middle. Numbers are [`Json`], which writes every digit and has a word for infinity.

pub mod assess;
pub mod atlas;
pub mod design;
mod drop_inputs;
mod error;
pub mod explain;
pub mod fit;
pub mod impacts;
pub mod map;
mod numbers;
pub mod record;
pub mod respond;
pub mod scatter;
pub mod simulate;
pub mod spectrum;
pub mod study;
mod versioned;
mod words;
pub mod zone;

use clatter::End;
use clatter_product::visible;
use clatter_shock::Shape;
pub use drop_inputs::DropInputs;
pub use error::Error;
pub use numbers::{Json, JsonCount, JsonWhole, figures, neat, significant, whole};
pub use versioned::{VERSION, Versioned};
pub use words::drop_in_words;

/// Returns the letter of an end.
#[must_use]
pub fn letter(end: End) -> &'static str {
    match end {
        End::A => "a",
        End::B => "b",
    }
}

/// Names a pulse shape as it is typed.
#[must_use]
pub fn shape_name(shape: Shape) -> String {
    let name = match shape {
        Shape::HalfSine => "half-sine",
        Shape::Haversine => "haversine",
        Shape::Triangle => "triangle",
        Shape::InitialPeakSawtooth => "initial-peak-sawtooth",
        Shape::TerminalPeakSawtooth => "terminal-peak-sawtooth",
        Shape::Rectangle => "rectangle",
        Shape::Trapezoid { ramp } => return format!("trapezoid:{ramp:?}"),
    };
    name.to_owned()
}

/// Checks that all positions lie on the body.
fn on_body(positions: impl IntoIterator<Item = f64>) -> Result<(), clatter::Error> {
    match positions.into_iter().find(|s| !(-1.0..=1.0).contains(s)) {
        Some(value) => Err(clatter::Error::Quantity { name: "position", value, allowed: "in [-1, 1]" }),
        None => Ok(()),
    }
}

/// Checks that all thresholds are in the bounds of velocities, so that no safe zone overflows.
fn in_bounds(thresholds: &[f64]) -> Result<(), clatter::Error> {
    match thresholds.iter().find(|x| !(1e-150..=1e150).contains(*x)) {
        Some(value) => {
            Err(clatter::Error::Quantity { name: "threshold", value: *value, allowed: "in [1e-150, 1e150], in v0" })
        }
        None => Ok(()),
    }
}
