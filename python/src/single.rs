//! This module answers one drop of a bar or a plate without gravity.

use clatter_answer::{atlas as atlas_of, impacts as impacts_of, zone as zone_of};
use pyo3::prelude::*;

use crate::answered::{Answered, json, without_picture};
use crate::bodies::{Body, Fall, Places};
use crate::given::Given;
use crate::{refused, words};

/// The largest number of things that an answer lists, and of a list that is given: as objects they take a kilobyte each.
pub(crate) const LISTED: usize = 1_000_000;

#[pyfunction]
pub(crate) fn impacts(py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
    let (body, fall, at) = (Body::read(&given)?, Fall::read(&given)?, given.read::<Places>("at")?);
    let limit = given.whole("limit", 0..=LISTED as u64)?;
    given.done()?;
    match body {
        Body::Bar(bar) => {
            let mut question = impacts_of::Question::new(bar, fall.of_bar()?);
            (question.at, question.limit) = (at.of_bar()?, limit);
            listed(question.at.len(), limit)?;
            without_picture(py, move |_| json(&impacts_of::answer(&question).map_err(words)?))
        }
        Body::Plate(plate) => {
            let mut question = impacts_of::plate::Question::new(plate, fall.of_plate()?);
            (question.at, question.limit) = (at.of_plate()?, limit);
            listed(question.at.len(), limit)?;
            without_picture(py, move |_| json(&impacts_of::plate::answer(&question).map_err(words)?))
        }
    }
}

/// Refuses more shocks at positions than an answer lists.
fn listed(positions: usize, impacts: usize) -> PyResult<()> {
    let shocks = positions.saturating_mul(impacts);
    if shocks > LISTED {
        return Err(refused(format!("{shocks} shocks at positions in one call; it takes {LISTED}: ask in pieces")));
    }
    Ok(())
}

#[pyfunction]
pub(crate) fn zone(py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
    let (body, threshold) = (Body::read(&given)?, given.read("threshold")?);
    let (first, height_gap) = (given.read("first")?, given.read::<Option<_>>("height_gap")?);
    given.done()?;
    match body {
        Body::Bar(_) if height_gap.is_some() => {
            Err(refused("height_gap is that of a plate: gyration_ratio takes two values"))
        }
        Body::Bar(bar) => {
            let mut question = zone_of::Question::new(bar, threshold);
            question.first = first;
            without_picture(py, move |_| json(&zone_of::answer(&question).map_err(words)?))
        }
        Body::Plate(_) if first.is_some() => Err(refused("first is that of a bar; gyration_ratio has two values here")),
        Body::Plate(plate) => {
            let mut question = zone_of::plate::Question::new(plate, threshold);
            question.height_gap = height_gap;
            without_picture(py, move |_| json(&zone_of::plate::answer(&question).map_err(words)?))
        }
    }
}

#[pyfunction]
pub(crate) fn atlas(py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
    let (body, limit) = (Body::read(&given)?, given.whole("limit", 1..=100)?);
    given.done()?;
    let Body::Plate(plate) = body else {
        return Err(refused("an atlas is that of a plate: gyration_ratio takes two values"));
    };
    let mut question = atlas_of::Question::new(plate);
    question.limit = limit;
    without_picture(py, move |_| json(&atlas_of::answer(&question).map_err(words)?))
}
