//! This module answers about a product: verdicts, changes, probabilities, and the drop that was measured.

use std::convert::Infallible;
use std::path::{Path, PathBuf};

use clatter::design::Goal;
use clatter_answer::fit::DropRecords;
use clatter_answer::{
    assess as assess_of, design as design_of, explain as explain_of, fit as fit_of, scatter as scatter_of,
};
use clatter_assess::{
    Accuracy,
    design::Bounds,
    ladder::ProductLadder,
    scatter::{Sampler, Settings},
};
use clatter_product::{EXAMPLE, ProductFile, visible};
use clatter_report::{Pages, ReportError};
use pyo3::prelude::*;

use crate::answered::{Answered, Drawing, json};
use crate::measured::{self, Given, Refused};
use crate::work::{self, Wanted};
use crate::{bodies, refused};

/// The product, and the oddities of its file.
#[pyclass(frozen, module = "clatter._clatter")]
#[derive(Debug)]
pub(crate) struct ProductText {
    file: ProductFile,
    text: String,
    /// The name of its file, as a report has it.
    name: String,
    #[pyo3(get)]
    warnings: String,
}

#[pymethods]
impl ProductText {
    #[new]
    fn new(text: String, origin: &str) -> PyResult<Self> {
        let (file, odd) = ProductFile::read_warned(&text, origin).map_err(refused)?;
        let warnings = if odd.warnings().is_empty() { String::new() } else { odd.to_string() };
        let name = Path::new(origin).file_name().map_or(origin.into(), |name| name.to_string_lossy()).into_owned();
        Ok(Self { file, text, name, warnings })
    }
}

#[pyfunction]
pub(crate) fn example() -> &'static str {
    EXAMPLE
}

#[pyfunction]
pub(crate) fn schema() -> String {
    clatter_product::schema().to_string()
}

fn accuracy(tolerance: f64, model: Option<&str>, merge_s: f64) -> PyResult<Accuracy> {
    Ok(Accuracy { tolerance, model: model.map(bodies::model).transpose()?, merge_s })
}

/// Makes an answer that takes its time.
fn long(py: Python<'_>, answer: impl FnOnce(&Wanted) -> Result<String, String> + Send + 'static) -> PyResult<Answered> {
    Ok((work::done(py, answer)?.map_err(refused)?, None))
}

/// The measurements of a drop, its name, and the standard deviation of its times.
type NamedDrop = (String, Given, Option<f64>);

/// Assesses the product. Measured drops stand next to the verdicts: those whose records the product names, from `folder`, and those
/// given. Returns the answer with its warnings.
#[pyfunction]
pub(crate) fn assess(
    py: Python<'_>,
    product: &ProductText,
    tolerance: f64,
    model: Option<&str>,
    merge_s: f64,
    folder: PathBuf,
    drops: Vec<NamedDrop>,
    report: Option<(PathBuf, Option<String>)>,
) -> PyResult<(Answered, Vec<String>)> {
    let (file, accuracy) = (product.file.clone(), accuracy(tolerance, model, merge_s)?);
    let name = product.name.clone();
    let given = |(name, given, timing_s): NamedDrop| {
        Ok(DropRecords { name, records: measured::records(given, timing_s)?, timing_s })
    };
    let given = drops.into_iter().map(given).collect::<PyResult<Vec<_>>>()?;
    let done = work::done(py, move |wanted| {
        let mut drops = measured::named(&file, &folder, wanted)?;
        drops.extend(given);
        let answer = assess_of::watched(&file, &accuracy, &|_, _| wanted.still());
        let mut answer = answer.map_err(|error| error.to_string())?;
        answer.measured = measured::fitted(drops, &file, wanted)?;
        let told = answer.warnings().into_iter().map(|(drop, told)| format!("{drop}: {told}"));
        let mut warnings: Vec<String> = told.collect();
        if let Some((pdf, date)) = &report {
            warnings.extend(print(&answer, &name, pdf, date.as_deref(), wanted)?);
        }
        let (text, assessment) = (json(&answer)?, answer.assessment);
        Ok::<_, Refused>((text, warnings, (file, assessment)))
    });
    let (text, warnings, (file, assessment)) = done??;
    let draw = move || {
        // The portraits of a plate take long, and its picture shows none of them.
        let portraits =
            if file.product.body.is_wide() { Vec::new() } else { clatter_assess::portraits(&file, &assessment) };
        clatter_figures::assessed(&file, &assessment, &portraits)
    };
    Ok(((text, Some(Drawing::new(draw))), warnings))
}

/// Writes the printed report. What typst says is of an outside program.
fn print(
    answer: &assess_of::Answer<'_>,
    path: &str,
    pdf: &Path,
    date: Option<&str>,
    wanted: &Wanted,
) -> Result<Vec<String>, Refused> {
    if clatter_report::is_protected(pdf) {
        return Err(Refused::Words(format!(
            "{} is write-protected: choose another name",
            visible(&pdf.to_string_lossy())
        )));
    }
    let portraits = clatter_assess::portraits(answer.file, &answer.assessment);
    wanted.or_leave();
    let remedies = clatter_answer::design::of_pages(answer.file, &answer.assessment, &|_, _| wanted.still());
    let remedies = remedies.map_err(|error| Refused::Words(error.to_string()))?;
    let assess_of::Answer { file, assessment, measured, .. } = answer;
    let pages = Pages { file, assessment, portraits: &portraits, remedies: &remedies, measured, path, date };
    clatter_report::write_assessment(&pages, pdf, &mut |_| wanted.or_leave()).map_err(|error| match error {
        ReportError::Io { path, source } => Refused::System(path, source),
        ReportError::Typst(said) => Refused::Outside(said),
        error => Refused::Words(error.to_string()),
    })
}

#[pyfunction]
pub(crate) fn scatter(
    py: Python<'_>,
    product: &ProductText,
    samples: Option<u64>,
    seed: u64,
    confidence: f64,
    merge_s: f64,
    target: Option<f64>,
) -> PyResult<Answered> {
    if target.is_some_and(|share| !(share > 0.0 && share < 1.0)) {
        return Err(refused(format!("target {:?} is not between 0 and 1", target.unwrap_or(f64::NAN))));
    }
    let file = product.file.clone();
    long(py, move |wanted| {
        let samples = samples.unwrap_or_else(|| Settings::samples_of(&file));
        let sampler = Sampler::new(&file, Settings { samples, seed, confidence, merge_s });
        let sampler = sampler.map_err(|error| error.to_string())?;
        let Ok(drawn) = sampler.run(false, &|| wanted.still(), |_| Ok::<_, Infallible>(()));
        let mut answer = scatter_of::Answer::new(&file, drawn);
        answer.target = target;
        json(&answer)
    })
}

#[pyfunction]
pub(crate) fn design(
    py: Python<'_>,
    product: &ProductText,
    margin: f64,
    q: [f64; 2],
    e: [f64; 2],
    frequency_factor: f64,
    damping: [f64; 2],
    contact_time_s: [f64; 2],
    limit_factor: f64,
) -> PyResult<Answered> {
    let file = product.file.clone();
    let bounds = Bounds { q, e, frequency_factor, damping, contact_time_s, limit_factor };
    long(py, move |wanted| {
        let watch = |_, _| wanted.still();
        let found = assess_of::watched(&file, &Accuracy::default(), &watch).and_then(|answer| {
            let remedies = clatter_assess::remedies_watched(&file, &answer.assessment, &bounds, margin, &watch)?;
            Ok(design_of::Answer::new(&file, answer.assessment, remedies, margin))
        });
        json(&found.map_err(|error| error.to_string())?)
    })
}

/// Finds the designs in the plane of q and e that meet all goals; the goals are those of the paper's example where none are given.
#[pyfunction]
pub(crate) fn goals(py: Python<'_>, zones: Vec<(f64, f64)>, turn: Option<f64>) -> PyResult<Answered> {
    let zones = if zones.is_empty() && turn.is_none() {
        design_of::goals::paper()
    } else {
        zones.into_iter().map(|(threshold, s)| Goal::zone(threshold, s)).collect()
    };
    let mut all = zones.map_err(refused)?;
    all.extend(turn.map(Goal::turn).transpose().map_err(refused)?);
    long(py, move |_| json(&design_of::goals::answer(&all).map_err(|error| error.to_string())?))
}

#[pyfunction]
pub(crate) fn explain(py: Python<'_>, product: &ProductText, tolerance: f64) -> PyResult<Answered> {
    let file = product.file.clone();
    long(py, move |wanted| json(&explain_of::Answer(&ladders(&file, tolerance, wanted)?)))
}

/// Measures every model on the worst drop of each limit: error and cost.
#[pyfunction]
pub(crate) fn tradeoff(py: Python<'_>, product: &ProductText, tolerance: f64) -> PyResult<Answered> {
    let file = product.file.clone();
    let told = work::done(py, move |wanted| {
        let ladders = ladders(&file, tolerance, wanted)?;
        Ok::<_, String>((json(&ladders)?, ladders))
    });
    let (text, ladders) = told?.map_err(refused)?;
    Ok((text, Some(Drawing::new(move || clatter_report::ladder_svg(&ladders)))))
}

fn ladders(file: &ProductFile, tolerance: f64, wanted: &Wanted) -> Result<ProductLadder, String> {
    let answer = assess_of::watched(file, &Accuracy::default(), &|_, _| wanted.still());
    let ladders = answer.and_then(|answer| {
        wanted.or_leave();
        clatter_assess::ladders(file, &answer.assessment, tolerance)
    });
    ladders.map_err(|error| error.to_string())
}

/// The JSON of the nearest drop, its picture, and the product file with what was found, and notes on that.
type Fitted = (String, Option<Drawing>, Option<String>, Vec<String>);

#[pyfunction]
pub(crate) fn fit(
    py: Python<'_>,
    product: &ProductText,
    given: Given,
    timing_s: Option<f64>,
    known_gyration: bool,
) -> PyResult<Fitted> {
    let records = measured::records(given, timing_s)?;
    let (file, text) = (product.file.clone(), product.text.clone());
    let found = work::done(py, move |_| {
        let mut question = fit_of::Question::new(&file, records);
        (question.timing_s, question.gyration_known) = (timing_s, known_gyration);
        let answer = fit_of::answer(&question).map_err(|error| error.to_string())?;
        // A text that cannot take the results is no reason to lose them.
        let (copy, notes) = match answer.written(&text) {
            Ok(copy) => (Some(copy.text), copy.notes),
            Err(error) => (None, vec![error]),
        };
        Ok::<_, String>((json(&answer)?, answer.fit, copy, notes))
    });
    let (told, fit, copy, notes) = found?.map_err(refused)?;
    Ok((told, Some(Drawing::new(move || clatter_figures::fit(&fit))), copy, notes))
}
