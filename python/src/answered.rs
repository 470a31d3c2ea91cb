//! This module makes answers for Python: the JSON of the command, and the drawing of it.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use clatter_answer::Versioned;
use clatter_figures::FigureError;
use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;
use serde::Serialize;

use crate::work::{self, Wanted};
use crate::{refused, words};

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

/// The reason why there is no answer: in the words of the command, or an error of the system or of an outside program.
pub(crate) enum Refused {
    Words(String),
    System(PathBuf, io::Error),
    Outside(String),
}

impl From<String> for Refused {
    fn from(words: String) -> Self {
        Self::Words(words)
    }
}

impl From<Refused> for PyErr {
    fn from(why: Refused) -> Self {
        match why {
            Refused::Words(words) => refused(words),
            Refused::System(path, error) => PyOSError::new_err((error.raw_os_error(), error.to_string(), path)),
            Refused::Outside(said) => PyRuntimeError::new_err(said),
        }
    }
}

/// Makes an answer without a picture on the threads of the process.
pub(crate) fn without_picture<E: Into<Refused> + Send + 'static>(
    py: Python<'_>,
    answer: impl FnOnce(&Wanted) -> Result<String, E> + Send + 'static,
) -> PyResult<Answered> {
    Ok((work::done(py, answer)?.map_err(Into::into)?, None))
}

/// Writes an answer as `--format json` prints it.
pub(crate) fn json(answer: &impl Serialize) -> Result<String, String> {
    serde_json::to_string(&Versioned::new(answer)).map_err(words)
}
