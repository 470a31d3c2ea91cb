//! The bar of the paper: its impacts, its safe zone, the plane of q and e.

use clatter::{Axis, Bar, Quantity, Start};
use clatter_answer::{impacts as impacts_of, map as map_of, zone as zone_of};

use crate::{Told, json, text};

/// Values of q and of e of the map, and how many.
const Q: [f64; 2] = [0.0, 1.0];
const E: [f64; 2] = [0.0, 1.0];
const POINTS: usize = 61;

pub(crate) fn impacts(q: f64, e: f64, limit: usize) -> Result<Told, String> {
    let mut question = impacts_of::Question::new(Bar::new(q, e).map_err(text)?, Start::default());
    question.limit = limit;
    let answer = json(&impacts_of::answer(&question).map_err(text)?)?;
    let command = format!("clatter impacts --q={q:?} --e={e:?} --limit={limit} --format=json");
    Ok(Told { answer: Some(answer), command: Some(command), ..Told::default() })
}

pub(crate) fn zone(q: f64, e: f64, threshold: f64) -> Result<Told, String> {
    let question = zone_of::Question::new(Bar::new(q, e).map_err(text)?, vec![threshold]);
    let answer = json(&zone_of::answer(&question).map_err(text)?)?;
    let command = format!("clatter zone --q={q:?} --e={e:?} --threshold={threshold:?} --format=json");
    Ok(Told { answer: Some(answer), command: Some(command), ..Told::default() })
}

/// The largest shock at the ends over the plane.
pub(crate) fn map() -> Result<Told, String> {
    let axis = |of: fn(f64, f64, usize) -> Result<Axis, clatter::Error>, [low, high]: [f64; 2]| {
        of(low, high, POINTS).map_err(text)
    };
    let question = map_of::Question::new(Quantity::PeakEnd, axis(Axis::q, Q)?, axis(Axis::e, E)?);
    let answer = json(&map_of::answer(&question).map_err(text)?)?;
    let ([q, to_q], [e, to_e]) = (Q, E);
    let command = format!("clatter map peak-end --q={q}:{to_q}:{POINTS} --e={e}:{to_e}:{POINTS} -o map.json");
    Ok(Told { answer: Some(answer), command: Some(command), ..Told::default() })
}
