//! This module makes answers for Python: the JSON of the command, and the drawing of it.

use std::sync::Arc;

use clatter_answer::Versioned;
use clatter_figures::FigureError;
use pyo3::prelude::*;
use serde::Serialize;

use crate::{refused, work};

/// The drawing of an answer: it makes the picture that the command writes.
#[pyclass(frozen, module = "clatter._clatter")]
pub(crate) struct Drawing(Arc<dyn Fn() -> Result<String, FigureError> + Send + Sync>);

impl Drawing {
    pub(crate) fn new(draw: impl Fn() -> Result<String, FigureError> + Send + Sync + 'static) -> Self {
        Self(Arc::new(draw))
    }
}

#[pymethods]
impl Drawing {
    /// Draws the picture as SVG.
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        let draw = Arc::clone(&self.0);
        work::done(py, move |_| draw())?.map_err(refused)
    }
}

/// The JSON of an answer, and its picture where it has one.
pub(crate) type Answered = (String, Option<Drawing>);

/// Writes an answer as `--format json` prints it.
pub(crate) fn json(answer: &impl Serialize) -> Result<String, String> {
    serde_json::to_string(&Versioned::new(answer)).map_err(|error| error.to_string())
}
