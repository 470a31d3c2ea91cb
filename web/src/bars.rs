//! This module answers the bar of the paper: its impacts, its safe zone, the plane of q and e.

use clatter::{Bar, Start};
use clatter_answer::{impacts as impacts_of, zone as zone_of};

use crate::{Reply, json, text};

/// The number of values of q and of e, from 0 to 1.
const POINTS: u32 = 61;

pub(crate) fn impacts(q: f64, e: f64, limit: usize) -> Result<Reply, String> {
    let mut question = impacts_of::Question::new(Bar::new(q, e).map_err(text)?, Start::default());
    question.limit = limit;
    let answer = json(&impacts_of::answer(&question).map_err(text)?)?;
    let command = format!("clatter impacts --q={q:?} --e={e:?} --limit={limit} --format=json");
    Ok(Reply { answer: Some(answer), command: Some(command), ..Reply::default() })
}

pub(crate) fn zone(q: f64, e: f64, threshold: f64) -> Result<Reply, String> {
    let question = zone_of::Question::new(Bar::new(q, e).map_err(text)?, vec![threshold]);
    let answer = json(&zone_of::answer(&question).map_err(text)?)?;
    let command = format!("clatter zone --q={q:?} --e={e:?} --threshold={threshold:?} --format=json");
    Ok(Reply { answer: Some(answer), command: Some(command), ..Reply::default() })
}

/// Computes the largest shock at the ends over the plane, in v0: a row for each q. The page draws it behind a point; it is no answer.
pub(crate) fn plane() -> Result<Reply, String> {
    let points = || (0..POINTS).map(|i| f64::from(i) / f64::from(POINTS - 1));
    let shock = |q, e| Ok(Bar::new(q, e)?.summary(&Start::default()).peak.end);
    let row = |q| points().map(|e| shock(q, e)).collect::<Result<Vec<f64>, clatter::Error>>();
    Reply::shown(points().map(row).collect::<Result<Vec<_>, _>>().map_err(text)?)
}
