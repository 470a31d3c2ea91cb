//! This module answers one drop of a bar or a plate without gravity.

use clatter::End;
use clatter_answer::{atlas as atlas_of, impacts as impacts_of, zone as zone_of};
use pyo3::prelude::*;

use crate::answered::{Answered, json};
use crate::bodies::{Body, Piece, Places, Ratio, plate_start, start};
use crate::{refused, work};

#[pyfunction]
#[pyo3(signature = (e, q=None, gyration_ratio=None, center_of_mass=None, masses=None, velocity=None, height_gap=None, at=None, limit=1000))]
pub(crate) fn impacts(
    py: Python<'_>,
    e: f64,
    q: Option<f64>,
    gyration_ratio: Option<Ratio>,
    center_of_mass: Option<Ratio>,
    masses: Option<Vec<Piece>>,
    velocity: Option<Vec<f64>>,
    height_gap: Option<Ratio>,
    at: Option<Places>,
    limit: usize,
) -> PyResult<Answered> {
    let told = match Body::new(e, q, gyration_ratio, center_of_mass, masses)? {
        Body::Bar(bar) => {
            let mut question = impacts_of::Question::new(bar, start(velocity, height_gap)?);
            (question.at, question.limit) = (Places::of_bar(at)?, limit);
            work::done(py, move |_| {
                let answer = impacts_of::answer(&question).map_err(|error| error.to_string())?;
                json(&answer)
            })
        }
        Body::Plate(plate) => {
            let mut question = impacts_of::plate::Question::new(plate, plate_start(velocity, height_gap)?);
            (question.at, question.limit) = (Places::of_plate(at)?, limit);
            work::done(py, move |_| {
                let answer = impacts_of::plate::answer(&question).map_err(|error| error.to_string())?;
                json(&answer)
            })
        }
    };
    Ok((told?.map_err(refused)?, None))
}

#[pyfunction]
#[pyo3(signature = (e, threshold, q=None, gyration_ratio=None, center_of_mass=None, masses=None, first=None, height_gap=None))]
pub(crate) fn zone(
    py: Python<'_>,
    e: f64,
    threshold: Vec<f64>,
    q: Option<f64>,
    gyration_ratio: Option<Ratio>,
    center_of_mass: Option<Ratio>,
    masses: Option<Vec<Piece>>,
    first: Option<String>,
    height_gap: Option<[f64; 2]>,
) -> PyResult<Answered> {
    let told = match Body::new(e, q, gyration_ratio, center_of_mass, masses)? {
        Body::Bar(bar) => {
            if height_gap.is_some() {
                return Err(refused("height_gap is that of a plate: gyration_ratio takes two values"));
            }
            let mut question = zone_of::Question::new(bar, threshold);
            question.first = first.map(|name| end(&name)).transpose()?;
            let answer = zone_of::answer(&question).map_err(refused)?;
            json(&answer)
        }
        Body::Plate(plate) => {
            if first.is_some() {
                return Err(refused("first is that of a bar; gyration_ratio has two values here"));
            }
            let mut question = zone_of::plate::Question::new(plate, threshold);
            question.height_gap = height_gap;
            work::done(py, move |_| {
                let answer = zone_of::plate::answer(&question).map_err(|error| error.to_string())?;
                json(&answer)
            })?
        }
    };
    Ok((told.map_err(refused)?, None))
}

#[pyfunction]
#[pyo3(signature = (e, gyration_ratio, center_of_mass=None, limit=40))]
pub(crate) fn atlas(
    py: Python<'_>,
    e: f64,
    gyration_ratio: Ratio,
    center_of_mass: Option<Ratio>,
    limit: usize,
) -> PyResult<Answered> {
    let body = Body::new(e, None, Some(gyration_ratio), center_of_mass, None)?;
    let mut question = atlas_of::Question::new(body.plate("an atlas")?);
    question.limit = limit;
    let told = work::done(py, move |_| {
        let answer = atlas_of::answer(&question).map_err(|error| error.to_string())?;
        json(&answer)
    });
    Ok((told?.map_err(refused)?, None))
}

/// Finds an end by its letter.
pub(crate) fn end(name: &str) -> PyResult<End> {
    match name {
        "a" => Ok(End::A),
        "b" => Ok(End::B),
        _ => Err(refused(format!("first = '{name}' is not an end, 'a' or 'b'"))),
    }
}
