//! This crate is the Python package `clatter`: it gives the answers of the command over dicts and arrays.
//!
//! The modules of `python/clatter` name and document the arguments, and hand them on as `locals()`. Here they are read by their names and
//! become the typed questions of `clatter-answer`, and each answer becomes the JSON that the command prints, with the way to draw it.
//! Functions over arrays call the core for each row. There is no second way to an answer.

#![expect(clippy::needless_pass_by_value, reason = "as Python hands them over")]

mod answered;
mod arrays;
mod bodies;
mod drops;
mod given;
mod maps;
mod measured;
mod products;
mod records;
mod shocks;
mod single;
mod studies;
mod work;

use std::fmt::Display;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Makes the error of a refused question, in the words of the command.
fn refused(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Returns the words of an error.
fn words(error: impl Display) -> String {
    error.to_string()
}

#[pymodule(gil_used = true)]
mod _clatter {
    #[pymodule_export]
    use crate::answered::Drawing;
    #[pymodule_export]
    use crate::arrays::{bars, boxes, plates, shocks, trains, zones};
    #[pymodule_export]
    use crate::drops::simulate;
    #[pymodule_export]
    use crate::maps::map;
    #[pymodule_export]
    use crate::products::{ProductText, assess, design, example, explain, fit, scatter, schema, text, tradeoff};
    #[pymodule_export]
    use crate::records::{Record, spectra, spectrum};
    #[pymodule_export]
    use crate::shocks::{Pulse, respond};
    #[pymodule_export]
    use crate::single::{atlas, impacts, zone};
    #[pymodule_export]
    use crate::studies::{merge, study};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("MOST", crate::arrays::MOST)?;
        module.add("LISTED", crate::single::LISTED)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
