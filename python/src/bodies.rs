//! This module makes bars, plates and their starts from the arguments of Python.

use clatter::{Bar, End, Mass, Plate, PlateStart, Start};
use clatter_product::{ContactLaw, Model, Stops};
use clatter_shock::{DampingRatio, Stop};
use pyo3::prelude::*;

use crate::given::{Given, Value, is_text, numbers, one_of, rows, several};
use crate::refused;

/// One number of a bar, two of a plate.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Ratio {
    Bar(f64),
    Plate([f64; 2]),
}

impl Value for Ratio {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let values = numbers(name, value, &[1, 2])?;
        Ok(<[f64; 2]>::try_from(&values[..]).map_or_else(|_| Self::Bar(values[0]), Self::Plate))
    }
}

impl Value for Vec<Mass> {
    /// Reads masses at a position, or spread evenly between two, in half-lengths.
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        rows(name, value, |name, row| {
            Ok(match numbers(name, row, &[2, 3])?[..] {
                [mass_kg, from_m, to_m] => Mass::Slab { mass_kg, from_m, to_m },
                ref point => Mass::Point { mass_kg: point[0], position_m: point[1] },
            })
        })
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
    /// Makes the body of e and of q, gyration_ratio with center_of_mass, or masses.
    pub(crate) fn read(given: &Given<'_>) -> PyResult<Self> {
        let (e, q) = (given.read("e")?, given.read("q")?);
        let (gyration_ratio, center_of_mass) = (given.read("gyration_ratio")?, given.read("center_of_mass")?);
        let body = match (q, gyration_ratio, given.read::<Option<Vec<Mass>>>("masses")?, center_of_mass) {
            (Some(q), None, None, None) => Bar::new(q, e).map(Self::Bar),
            (None, None, Some(masses), None) => Bar::from_masses(2.0, &masses, e).map(Self::Bar),
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
}

/// The velocities and the height gap at the first touch, as they are given.
pub(crate) struct Fall {
    velocity: Option<Vec<f64>>,
    height_gap: Option<Ratio>,
}

impl Fall {
    pub(crate) fn read(given: &Given<'_>) -> PyResult<Self> {
        Ok(Self { velocity: given.read("velocity")?, height_gap: given.read("height_gap")? })
    }

    /// Makes the start of a bar: without spin and at one h0 unless given.
    pub(crate) fn of_bar(self) -> PyResult<Start> {
        let gap = match self.height_gap {
            Some(Ratio::Plate(_)) => return Err(refused("height_gap takes one value for a bar")),
            Some(Ratio::Bar(gap)) => gap,
            None => 1.0,
        };
        Start::new(self.velocities("a bar")?, gap).map_err(refused)
    }

    /// Makes the start of a plate.
    pub(crate) fn of_plate(self) -> PyResult<PlateStart> {
        let Some(Ratio::Plate(gaps)) = self.height_gap else {
            return Err(refused("height_gap takes two values for a plate, the heights of corners b and d"));
        };
        PlateStart::new(self.velocities("a plate")?, gaps).map_err(refused)
    }

    fn velocities<const N: usize>(self, body: &str) -> PyResult<[f64; N]> {
        let Some(given) = self.velocity else { return Ok([-1.0; N]) };
        let count = given.len();
        given.try_into().map_err(|_| refused(format!("velocity takes {N} values for {body}, not {count}")))
    }
}

/// Positions in [−1, 1] of a bar, places of a plate.
#[derive(Debug, Clone)]
pub(crate) enum Places {
    Bar(Vec<f64>),
    Plate(Vec<[f64; 2]>),
}

impl Value for Places {
    /// Reads positions or places; None is no place.
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if value.is_none() {
            return Ok(Self::Bar(Vec::new()));
        }
        let all = several(name, value, &[])?;
        if all.is_empty() || !all.iter().all(|one| one.len().is_ok() && !is_text(one)) {
            return all.iter().map(|one| f64::read(name, one)).collect::<PyResult<_>>().map(Self::Bar);
        }
        let place = |(i, one)| Value::read(&format!("{name}[{i}]"), one);
        all.iter().enumerate().map(place).collect::<PyResult<_>>().map(Self::Plate)
    }
}

impl Places {
    pub(crate) fn of_bar(self) -> PyResult<Vec<f64>> {
        match self {
            Self::Bar(at) => Ok(at),
            Self::Plate(_) => Err(refused("at takes positions in [-1, 1] for a bar")),
        }
    }
    pub(crate) fn of_plate(self) -> PyResult<Vec<[f64; 2]>> {
        match self {
            Self::Plate(at) => Ok(at),
            Self::Bar(at) if at.is_empty() => Ok(Vec::new()),
            Self::Bar(_) => Err(refused("at takes places (x, y) for a plate")),
        }
    }
    /// Returns places of either body: those of a bar are in the middle of its width.
    pub(crate) fn of_any(self) -> Vec<[f64; 2]> {
        match self {
            Self::Bar(at) => at.into_iter().map(|s| [s, 0.0]).collect(),
            Self::Plate(at) => at,
        }
    }
}

impl Value for ContactLaw {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        one_of(name, value, &Self::ALL.map(|law| (law.name(), law)), " or ")
    }
}

impl Value for Model {
    /// Reads a model that follows drops.
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        one_of(name, value, &Self::FOLLOWED.map(|model| (model.name(), model)), ", ")
    }
}

impl Value for End {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        match String::read(name, value)?.as_str() {
            "a" => Ok(Self::A),
            "b" => Ok(Self::B),
            other => Err(refused(format!("first = '{other}' is not an end, 'a' or 'b'"))),
        }
    }
}

/// Returns the stops of the part.
pub(crate) fn stop(given: &Given<'_>) -> PyResult<Option<Stop>> {
    given.read::<Option<[f64; 3]>>("stop")?.map(Stops::of).transpose().map_err(refused)
}

/// Returns the damping of a part; Q = 10, as is usual in the field, where none is given.
pub(crate) fn damping(ratio: Option<f64>, q_factor: Option<f64>) -> PyResult<DampingRatio> {
    match (ratio, q_factor) {
        (Some(_), Some(_)) => Err(refused("damping or q_factor, not both: q_factor = 1/(2 damping)")),
        (Some(ratio), None) => DampingRatio::new(ratio).map_err(refused),
        (None, q_factor) => DampingRatio::from_quality_factor(q_factor.unwrap_or(10.0)).map_err(refused),
    }
}
