//! This module answers about a product: verdicts, changes, probabilities, and the drop that was measured.

use std::convert::Infallible;
use std::path::{Path, PathBuf};

use clatter::design::Goal;
use clatter_answer::{
    assess as assess_of, design as design_of, explain as explain_of, fit as fit_of, scatter as scatter_of,
};
use clatter_assess::{
    Accuracy,
    design::Bounds,
    ladder::ProductLadder,
    scatter::{Sampler, Settings},
};
use clatter_product::{EXAMPLE, ProductFile, Reliability, visible};
use clatter_report::{Pages, ReportError};
use pyo3::prelude::*;

use crate::answered::{Answered, Drawing, Refused, json, without_picture};
use crate::given::Given;
use crate::studies::text_of;
use crate::work::{self, Wanted};
use crate::{measured, refused, words};

/// The product, and the oddities of its file.
#[pyclass(frozen, module = "clatter._clatter")]
#[derive(Debug)]
pub(crate) struct ProductText {
    file: ProductFile,
    text: String,
    /// The name of its file, as a report has it.
    name: String,
    /// Where its records are.
    folder: PathBuf,
    #[pyo3(get)]
    warnings: String,
}

#[pymethods]
impl ProductText {
    #[new]
    fn new(text: String, origin: &str, folder: PathBuf) -> PyResult<Self> {
        let (file, odd) = ProductFile::read_warned(&text, origin).map_err(refused)?;
        let warnings = if odd.warnings().is_empty() { String::new() } else { odd.to_string() };
        let name = Path::new(origin).file_name().map_or(origin.into(), |name| name.to_string_lossy()).into_owned();
        Ok(Self { file, text, name, folder, warnings })
    }
}

/// Reads the text of a product file.
#[pyfunction]
pub(crate) fn text(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    Ok(work::read(py, move |_| text_of(&path))??)
}

#[pyfunction]
pub(crate) fn example() -> &'static str {
    EXAMPLE
}

#[pyfunction]
pub(crate) fn schema() -> String {
    clatter_product::schema().to_string()
}

/// Returns the product that is asked about.
fn product<'py>(given: &Given<'py>) -> PyResult<PyRef<'py, ProductText>> {
    Ok(given.value("product")?.extract()?)
}

/// Assesses the product. Measured drops stand next to the verdicts: those whose records the product names, and those given. Returns the
/// answer with its warnings.
#[pyfunction]
pub(crate) fn assess(py: Python<'_>, given: Given<'_>) -> PyResult<(Answered, Vec<String>)> {
    let product = product(&given)?;
    let (file, name, folder) = (product.file.clone(), product.name.clone(), product.folder.clone());
    let (tolerance, merge_s) = (given.read("tolerance")?, given.read("merge_s")?);
    let accuracy = Accuracy { tolerance, model: given.read("model")?, merge_s };
    let asked = reliability(&given, &file)?;
    let (report, date) = (given.read::<Option<PathBuf>>("report")?, given.read::<Option<String>>("report_date")?);
    let measured = measured::given(&given.value("measured")?)?;
    given.done()?;
    let (file, mut drops) =
        work::read(py, move |wanted| measured::named(&file, &folder, wanted).map(|drops| (file, drops)))??;
    drops.extend(measured);
    let done = work::done(py, move |wanted| {
        let answer = assess_of::watched(&file, &accuracy, &|_, _| wanted.still());
        let mut answer = answer.map_err(words)?;
        if let Some(asked) = asked {
            answer.draw(asked, &|_, _| wanted.still()).map_err(words)?;
        }
        answer.measured = measured::fitted(drops, &file, wanted)?;
        let told = answer.warnings().into_iter().map(|(drop, told)| format!("{drop}: {told}"));
        let mut warnings: Vec<String> = told.collect();
        if let Some(pdf) = &report {
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

/// Returns the reliability that is asked of a product, by its file or in place of that.
fn reliability(given: &Given<'_>, file: &ProductFile) -> PyResult<Option<Reliability>> {
    let (share, confidence) = (given.read::<Option<f64>>("reliability")?, given.read::<Option<f64>>("confidence")?);
    file.asked(share, confidence).map_err(refused)
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
    let remedies = remedies.map_err(words)?;
    let assess_of::Answer { file, assessment, measured, .. } = answer;
    let pages = Pages { file, assessment, portraits: &portraits, remedies: &remedies, measured, path, date };
    clatter_report::write_assessment(&pages, pdf, &mut |_| wanted.or_leave()).map_err(|error| match error {
        ReportError::Io { path, source } => Refused::System(path, source),
        ReportError::Typst(said) => Refused::Outside(said),
        error => Refused::Words(error.to_string()),
    })
}

/// Returns the share of products that is to survive for sure, where one is given.
pub(crate) fn target(given: &Given<'_>) -> PyResult<Option<f64>> {
    match given.read("target")? {
        Some(share) if !(share > 0.0 && share < 1.0) => {
            Err(refused(format!("target {share:?} is not between 0 and 1")))
        }
        share => Ok(share),
    }
}

#[pyfunction]
pub(crate) fn scatter(py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
    let (file, target) = (product(&given)?.file.clone(), target(&given)?);
    let samples: Option<u64> = given.whole_if_given("samples", 1..=1_000_000_000_000)?;
    let samples = samples.unwrap_or_else(|| Settings::samples_of(&file));
    let (seed, confidence) = (given.whole("seed", 0..=u64::MAX)?, given.read("confidence")?);
    let settings = Settings { samples, seed, confidence, merge_s: given.read("merge_s")? };
    given.done()?;
    without_picture(py, move |wanted| {
        let sampler = Sampler::new(&file, settings).map_err(words)?;
        let Ok(drawn) = sampler.run(false, &|| wanted.still(), |_| Ok::<_, Infallible>(()));
        let mut answer = scatter_of::Answer::new(&file, drawn);
        answer.target = target;
        json(&answer)
    })
}

/// Finds the smallest changes of a product; without one, the designs in the plane of q and e that meet all goals.
#[pyfunction]
pub(crate) fn design(py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
    let (zones, turn) = (given.read::<Vec<[f64; 2]>>("zones")?, given.read("turn")?);
    let margin = given.read("margin")?;
    let bounds = Bounds {
        q: given.read("q")?,
        e: given.read("e")?,
        frequency_factor: given.read("frequency_factor")?,
        damping: given.read("damping")?,
        contact_time_s: given.read("contact_time_s")?,
        limit_factor: given.read("limit_factor")?,
    };
    let product = given.value("product")?.extract::<Option<PyRef<'_, ProductText>>>()?;
    given.done()?;
    let Some(product) = product else { return goals(py, &zones, turn) };
    if !zones.is_empty() || turn.is_some() {
        return Err(refused("zones and turn are goals without a product"));
    }
    let file = product.file.clone();
    without_picture(py, move |wanted| {
        let watch = |_, _| wanted.still();
        let found = assess_of::watched(&file, &Accuracy::default(), &watch).and_then(|answer| {
            let remedies = clatter_assess::remedies_watched(&file, &answer.assessment, &bounds, margin, &watch)?;
            Ok(design_of::Answer::new(&file, answer.assessment, remedies, margin))
        });
        json(&found.map_err(words)?)
    })
}

/// Finds the designs that meet all goals; they are those of the paper's example where none are given.
fn goals(py: Python<'_>, zones: &[[f64; 2]], turn: Option<f64>) -> PyResult<Answered> {
    let zones = if zones.is_empty() && turn.is_none() {
        design_of::goals::paper()
    } else {
        zones.iter().map(|[threshold, s]| Goal::zone(*threshold, *s)).collect()
    };
    let mut all = zones.map_err(refused)?;
    all.extend(turn.map(Goal::turn).transpose().map_err(refused)?);
    without_picture(py, move |_| json(&design_of::goals::answer(&all).map_err(words)?))
}

#[pyfunction]
pub(crate) fn explain(py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
    let (file, tolerance) = (product(&given)?.file.clone(), given.read("tolerance")?);
    given.done()?;
    without_picture(py, move |wanted| json(&explain_of::Answer(&ladders(&file, tolerance, wanted)?)))
}

/// Measures every model on the worst drop of each limit: error and cost.
#[pyfunction]
pub(crate) fn tradeoff(py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
    let (file, tolerance) = (product(&given)?.file.clone(), given.read("tolerance")?);
    given.done()?;
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
    ladders.map_err(words)
}

/// The JSON of the nearest drop, its picture, and the product file with what was found, and notes on that.
type Fitted = (String, Option<Drawing>, Option<String>, Vec<String>);

#[pyfunction]
pub(crate) fn fit(py: Python<'_>, given: Given<'_>) -> PyResult<Fitted> {
    let (records, timing_s) = measured::records(&given)?;
    let (known_gyration, product) = (given.read("known_gyration")?, product(&given)?);
    let (file, text) = (product.file.clone(), product.text.clone());
    given.done()?;
    let found = work::done(py, move |_| {
        let mut question = fit_of::Question::new(&file, records);
        (question.timing_s, question.gyration_known) = (timing_s, known_gyration);
        let answer = fit_of::answer(&question).map_err(words)?;
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
