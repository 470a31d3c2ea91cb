//! An answer as Python gets it: the JSON of the command, and what draws it.

use clatter_answer::Versioned;
use clatter_figures::FigureError;
use pyo3::prelude::*;
use serde::Serialize;

use crate::refused;

/// What draws an answer: the picture that the command writes.
#[pyclass(frozen, module = "clatter._clatter")]
pub(crate) struct Drawing(Box<dyn Fn() -> Result<String, FigureError> + Send + Sync>);

impl Drawing {
    pub(crate) fn new(draw: impl Fn() -> Result<String, FigureError> + Send + Sync + 'static) -> Self {
        Self(Box::new(draw))
    }
}

#[pymethods]
impl Drawing {
    /// The picture as SVG.
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| (self.0)()).map_err(refused)
    }
}

/// The JSON of an answer, and its picture where it has one.
pub(crate) type Answered = (String, Option<Drawing>);

/// As `--format json` prints it.
pub(crate) fn json(answer: &impl Serialize) -> Result<String, String> {
    serde_json::to_string(&Versioned::new(answer)).map_err(|error| error.to_string())
}
