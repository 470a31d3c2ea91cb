//! Verdicts on a product, changes, probabilities, and the drop that was measured.

use std::convert::Infallible;

use clatter::End;
use clatter::design::Goal;
use clatter_answer::{
    assess as assess_of, design as design_of, explain as explain_of, fit as fit_of, scatter as scatter_of,
};
use clatter_assess::design::Bounds;
use clatter_assess::fit::{Measured, MeasuredHeights, MeasuredStrike};
use clatter_assess::scatter::{Sampler, Settings};
use clatter_assess::{Accuracy, EXAMPLE, ProductFile};
use pyo3::prelude::*;

use crate::answered::{Answered, Drawing, json};
use crate::records::Record;
use crate::work::{self, Wanted};
use crate::{bodies, refused, single};

/// The product, and what is odd in its file.
#[pyclass(frozen, module = "clatter._clatter")]
#[derive(Debug)]
pub(crate) struct ProductText {
    file: ProductFile,
    text: String,
    #[pyo3(get)]
    warnings: String,
    /// Whether it names records of measured drops.
    #[pyo3(get)]
    names_records: bool,
}

#[pymethods]
impl ProductText {
    #[new]
    fn new(text: String, origin: &str) -> PyResult<Self> {
        let (file, odd) = ProductFile::read_warned(&text, origin).map_err(refused)?;
        let warnings = if odd.warnings().is_empty() { String::new() } else { odd.to_string() };
        Ok(Self { names_records: !file.records.is_empty(), file, text, warnings })
    }
}

#[pyfunction]
pub(crate) fn example() -> &'static str {
    EXAMPLE
}

#[pyfunction]
pub(crate) fn schema() -> String {
    clatter_assess::schema().to_string()
}

fn accuracy(tolerance: f64, model: Option<&str>, merge_s: f64) -> PyResult<Accuracy> {
    Ok(Accuracy { tolerance, model: model.map(bodies::model).transpose()?, merge_s })
}

/// An answer that takes its time.
fn long(py: Python<'_>, answer: impl FnOnce(&Wanted) -> Result<String, String> + Send + 'static) -> PyResult<Answered> {
    Ok((work::done(py, answer)?.map_err(refused)?, None))
}

#[pyfunction]
pub(crate) fn assess(
    py: Python<'_>,
    product: &ProductText,
    tolerance: f64,
    model: Option<&str>,
    merge_s: f64,
) -> PyResult<Answered> {
    let (file, accuracy) = (product.file.clone(), accuracy(tolerance, model, merge_s)?);
    long(py, move |wanted| {
        let answer = assess_of::watched(&file, &accuracy, &|_, _| wanted.still());
        json(&answer.map_err(|error| error.to_string())?)
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
            let remedies = file.remedies_watched(&answer.assessment, &bounds, margin, &watch)?;
            Ok(design_of::Answer::new(&file, answer.assessment, remedies, margin))
        });
        json(&found.map_err(|error| error.to_string())?)
    })
}

/// What goals in the plane of q and e come to; the paper's example where there are none.
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
    long(py, move |wanted| {
        let ladders = assess_of::watched(&file, &Accuracy::default(), &|_, _| wanted.still()).and_then(|answer| {
            wanted.or_leave();
            file.ladders(&answer.assessment, tolerance)
        });
        json(&explain_of::Answer(&ladders.map_err(|error| error.to_string())?))
    })
}

/// The JSON of the nearest drop, its picture, and the product file with what was found, and notes on that.
type Fitted = (String, Option<Drawing>, Option<String>, Vec<String>);

#[pyfunction]
pub(crate) fn fit(
    py: Python<'_>,
    product: &ProductText,
    strikes: Option<Vec<(f64, Option<String>)>>,
    heights: Option<Vec<[f64; 3]>>,
    bounces: Option<Vec<f64>>,
    accelerations: Vec<(Py<Record>, f64)>,
    timing_s: Option<f64>,
    known_gyration: bool,
) -> PyResult<Fitted> {
    let mut records = Vec::new();
    let mut add = |name: &str, data| records.push(fit_of::Record { name: name.to_owned(), data });
    if let Some(list) = strikes {
        let strike = |(time_s, end): (f64, Option<String>)| {
            let end: Option<End> = end.map(|name| single::end(&name)).transpose()?;
            Ok(MeasuredStrike { time_s, end })
        };
        let strikes = list.into_iter().map(strike).collect::<PyResult<_>>()?;
        add("strikes", fit_of::Data::Measured(Measured::Strikes { strikes, deviation_s: timing_s }));
    }
    if let Some(list) = heights {
        let samples = list.into_iter().map(|[time_s, a, b]| MeasuredHeights { time_s, height_m: [a, b] }).collect();
        add("heights", fit_of::Data::Measured(Measured::Heights { samples, deviation_m: None }));
    }
    if let Some(list) = bounces {
        add("bounces", fit_of::Data::Bounces(list));
    }
    for (record, position_m) in &accelerations {
        let record = record.get();
        add(record.file(), fit_of::Data::acceleration(record.inner(), *position_m).map_err(refused)?);
    }
    let (file, text) = (product.file.clone(), product.text.clone());
    let found = work::done(py, move |_| {
        let mut question = fit_of::Question::new(&file, records);
        (question.timing_s, question.gyration_known) = (timing_s, known_gyration);
        let answer = fit_of::answer(&question).map_err(|error| error.to_string())?;
        // A text that cannot take what was found is no reason to lose it.
        let (copy, notes) = match answer.written(&text) {
            Ok(copy) => (Some(copy.text), copy.notes),
            Err(error) => (None, vec![error]),
        };
        Ok::<_, String>((json(&answer)?, answer.fit, copy, notes))
    });
    let (told, fit, copy, notes) = found?.map_err(refused)?;
    Ok((told, Some(Drawing::new(move || clatter_figures::fit(&fit))), copy, notes))
}
