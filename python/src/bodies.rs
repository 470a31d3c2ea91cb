//! This module makes bars, plates and their starts from the values of Python.

use clatter::{Bar, Error, Mass, Plate, PlateStart, Start};
use clatter_flight::ContactLaw;
use clatter_product::Model;
use clatter_shock::DampingRatio;
use pyo3::prelude::*;

use crate::refused;

/// One number of a bar, two of a plate.
#[derive(Debug, Clone, Copy, FromPyObject)]
pub(crate) enum Ratio {
    Bar(f64),
    Plate([f64; 2]),
}

/// A mass at a position, or spread evenly between two, in half-lengths.
#[derive(Debug, Clone, Copy, FromPyObject)]
pub(crate) enum Piece {
    Point(f64, f64),
    Slab(f64, f64, f64),
}

impl From<Piece> for Mass {
    fn from(piece: Piece) -> Self {
        match piece {
            Piece::Point(mass_kg, position_m) => Self::Point { mass_kg, position_m },
            Piece::Slab(mass_kg, from_m, to_m) => Self::Slab { mass_kg, from_m, to_m },
        }
    }
}

/// The body that falls.
#[derive(Debug, Clone)]
pub(crate) enum Body {
    Bar(Bar),
    Plate(Plate),
}

const ONE_OF: &str = "one of q, gyration_ratio and masses says how the mass lies";
const CENTER: &str = "center_of_mass goes with gyration_ratio: one number for a bar, two for a plate";

impl Body {
    pub(crate) fn new(
        e: f64,
        q: Option<f64>,
        gyration_ratio: Option<Ratio>,
        center_of_mass: Option<Ratio>,
        masses: Option<Vec<Piece>>,
    ) -> PyResult<Self> {
        let body = match (q, gyration_ratio, masses, center_of_mass) {
            (Some(q), None, None, None) => Bar::new(q, e).map(Self::Bar),
            (None, None, Some(masses), None) => {
                let masses: Vec<Mass> = masses.into_iter().map(Mass::from).collect();
                Bar::from_masses(2.0, &masses, e).map(Self::Bar)
            }
            (None, Some(Ratio::Bar(k)), None, None) => Bar::from_gyration_ratio(k, e).map(Self::Bar),
            (None, Some(Ratio::Bar(k)), None, Some(Ratio::Bar(c))) => Bar::from_center_of_mass(c, k, e).map(Self::Bar),
            (None, Some(Ratio::Plate(ratios)), None, None) => Plate::new(ratios, e).map(Self::Plate),
            (None, Some(Ratio::Plate(ratios)), None, Some(Ratio::Plate(center))) => {
                Plate::off_center(ratios, center, e).map(Self::Plate)
            }
            (_, _, _, Some(_)) => return Err(refused(CENTER)),
            _ => return Err(refused(ONE_OF)),
        };
        body.map_err(refused)
    }

    pub(crate) fn bar(self, what: &str) -> PyResult<Bar> {
        match self {
            Self::Bar(bar) => Ok(bar),
            Self::Plate(_) => Err(refused(format!("{what} is that of a bar; gyration_ratio has two values here"))),
        }
    }

    pub(crate) fn plate(self, what: &str) -> PyResult<Plate> {
        match self {
            Self::Plate(plate) => Ok(plate),
            Self::Bar(_) => Err(refused(format!("{what} is that of a plate: gyration_ratio takes two values"))),
        }
    }
}

/// Makes the start of a bar: without spin and at one h0 unless given.
pub(crate) fn start(velocity: Option<Vec<f64>>, height_gap: Option<Ratio>) -> PyResult<Start> {
    let velocity = numbers(velocity, [-1.0; 2], "velocity", "a bar")?;
    match height_gap {
        Some(Ratio::Plate(_)) => Err(refused("height_gap takes one value for a bar")),
        Some(Ratio::Bar(gap)) => Start::new(velocity, gap).map_err(refused),
        None => Start::new(velocity, 1.0).map_err(refused),
    }
}

/// Makes the start of a plate.
pub(crate) fn plate_start(velocity: Option<Vec<f64>>, height_gap: Option<Ratio>) -> PyResult<PlateStart> {
    let velocity = numbers(velocity, [-1.0; 3], "velocity", "a plate")?;
    match height_gap {
        Some(Ratio::Plate(gaps)) => PlateStart::new(velocity, gaps).map_err(refused),
        _ => Err(refused("height_gap takes two values for a plate, the heights of corners b and d")),
    }
}

fn numbers<const N: usize>(given: Option<Vec<f64>>, default: [f64; N], name: &str, body: &str) -> PyResult<[f64; N]> {
    let Some(given) = given else { return Ok(default) };
    let count = given.len();
    given.try_into().map_err(|_| refused(format!("{name} takes {N} values for {body}, not {count}")))
}

/// Positions in [−1, 1] of a bar, places of a plate.
#[derive(Debug, Clone, FromPyObject)]
pub(crate) enum Places {
    Bar(Vec<f64>),
    Plate(Vec<[f64; 2]>),
}

impl Places {
    pub(crate) fn of_bar(at: Option<Self>) -> PyResult<Vec<f64>> {
        match at {
            None => Ok(Vec::new()),
            Some(Self::Bar(at)) => Ok(at),
            Some(Self::Plate(at)) if at.is_empty() => Ok(Vec::new()),
            Some(Self::Plate(_)) => Err(refused("at takes positions in [-1, 1] for a bar")),
        }
    }
    pub(crate) fn of_plate(at: Option<Self>) -> PyResult<Vec<[f64; 2]>> {
        match at {
            None => Ok(Vec::new()),
            Some(Self::Plate(at)) => Ok(at),
            Some(Self::Bar(at)) if at.is_empty() => Ok(Vec::new()),
            Some(Self::Bar(_)) => Err(refused("at takes places (x, y) for a plate")),
        }
    }
}

/// Makes a bar from one row of arrays.
pub(crate) fn bar_of(q: Option<f64>, k: Option<f64>, c: Option<f64>, e: f64) -> Result<Bar, Error> {
    match (q, k, c) {
        (Some(q), _, _) => Bar::new(q, e),
        (None, Some(k), None) => Bar::from_gyration_ratio(k, e),
        (None, k, c) => Bar::from_center_of_mass(c.unwrap_or(0.0), k.unwrap_or(f64::NAN), e),
    }
}

/// Finds a contact law by its name.
pub(crate) fn law(name: &str) -> PyResult<ContactLaw> {
    let names = ContactLaw::NAMES.join(" or ");
    ContactLaw::from_name(name).ok_or_else(|| refused(format!("contact_law = '{name}' is none: {names}")))
}

/// Finds a model that follows drops by its name.
pub(crate) fn model(name: &str) -> PyResult<Model> {
    let names = || Model::FOLLOWED.map(Model::name).join(", ");
    let model = Model::FOLLOWED.into_iter().find(|model| model.name() == name);
    model.ok_or_else(|| refused(format!("model = '{name}' is none: {}", names())))
}

/// Returns the damping of a part; Q = 10, as is usual in the field, where none is given.
pub(crate) fn damping(ratio: Option<f64>, q_factor: Option<f64>) -> PyResult<DampingRatio> {
    match (ratio, q_factor) {
        (Some(_), Some(_)) => Err(refused("damping or q_factor, not both: q_factor = 1/(2 damping)")),
        (Some(ratio), None) => DampingRatio::new(ratio).map_err(refused),
        (None, q_factor) => DampingRatio::from_quality_factor(q_factor.unwrap_or(10.0)).map_err(refused),
    }
}
