//! This module finds where goals in the plane of q and e are met, and the front of the largest zone.
//!
//! ```
//! use clatter::design::Goal;
//! use clatter_answer::design::goals;
//! // The paper's example: v0/2 in the middle tenth of the bar, 2 v0 in nearly all of it.
//! let answer = goals::answer(&goals::paper()?)?;
//! assert!(answer.fronts.iter().any(|at| at.smallest_q.is_some()));
//! # Ok::<(), clatter_answer::Error>(())
//! ```

use clatter::contour::Point;
use clatter::design::{DESIGNS, Front, FrontPoint, Goal, front, region};
use clatter::{Bar, Start};
use serde::{Serialize, Serializer};

use crate::{Error, Json};

/// The paper's example (section 6), threshold and zone: the second, “substantially most of the bar”, is met by all
/// designs that it suggests.
const PAPER: [[f64; 2]; 2] = [[0.5, 0.1], [2.0, 0.85]];
/// Restitutions whose fronts are given.
const RESTITUTIONS: [f64; 7] = [0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3];
/// The number of points of a front for a unit of q.
const STEPS: u32 = 200;
/// The largest distance of the border from its chords.
const FLATNESS: f64 = 2e-4;

/// Returns the goals of the paper's example.
///
/// # Errors
/// None: they are goals.
pub fn paper() -> Result<Vec<Goal>, clatter::Error> {
    PAPER.iter().map(|[x, s]| Goal::zone(*x, *s)).collect()
}

/// The region of designs that meets all goals.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer {
    /// The threshold of the first goal, in v0.
    pub threshold: f64,
    /// The part of the bar that the first goal demands to be safe.
    pub wanted: f64,
    /// The other goals.
    pub others: Vec<Goal>,
    /// All goals.
    pub all: Vec<Goal>,
    /// Pieces of the border e(q) below which all goals are met.
    pub region: Vec<Vec<Point>>,
    /// Fronts of the largest zone of the first goal.
    pub fronts: Vec<AtRestitution>,
    /// The designs of the paper's Table 1.
    pub designs: Vec<Design>,
}

/// Fronts at one restitution.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct AtRestitution {
    /// The fronts among designs that meet the other goals, and among all.
    pub fronts: [Front; 2],
    /// The smallest q that meets all goals.
    pub smallest_q: Option<f64>,
}

/// A design of Table 1.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Design {
    /// Inertia ratio.
    pub q: f64,
    /// Coefficient of restitution.
    pub e: f64,
    /// Its zone within the first goal.
    pub s: f64,
    /// True for each goal that the design meets.
    pub met: Vec<bool>,
    /// The largest zone at its restitution that leaves the other goals met.
    pub largest: Option<FrontPoint>,
}

/// Finds where the goals are met: the first is the safe zone that fronts enlarge, with all others met.
///
/// # Errors
/// [`Error::NoZone`].
pub fn answer(goals: &[Goal]) -> Result<Answer, Error> {
    let Some((&Goal::Zone { threshold, s: wanted }, others)) = goals.split_first() else {
        return Err(Error::NoZone);
    };
    let (others, all) = (others.to_vec(), goals.to_vec());
    let at = |e| {
        let within = front(threshold, &others, e, STEPS)?;
        let meeting = front(threshold, &all, e, 1)?;
        let smallest_q = meeting.pieces.first().and_then(|piece| piece.first()).map(|p| p.q);
        Ok(AtRestitution { fronts: [within, front(threshold, &[], e, STEPS)?], smallest_q })
    };
    let fronts = RESTITUTIONS.into_iter().map(at).collect::<Result<_, clatter::Error>>()?;
    let design = |[q, e]: [f64; 2]| {
        let bar = Bar::new(q, e)?;
        Ok(Design {
            q,
            e,
            s: bar.shocks_either(&Start::default()).safe_zone(threshold).s,
            met: all.iter().map(|goal| goal.margin(q, e) >= 0.0).collect(),
            largest: front(threshold, &others, e, STEPS)?.largest(),
        })
    };
    let designs = DESIGNS.into_iter().map(design).collect::<Result<_, clatter::Error>>()?;
    Ok(Answer { threshold, wanted, region: region(&all, FLATNESS), others, all, fronts, designs })
}

impl Serialize for Answer {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let place = |p: FrontPoint| PlaceJson { q: Json(p.q), s: Json(p.s) };
        let goal = |goal: &Goal| match *goal {
            Goal::Zone { threshold, s } => GoalJson { threshold: Some(Json(threshold)), s: Some(Json(s)), turn: None },
            Goal::Turn { limit } => GoalJson { threshold: None, s: None, turn: Some(Json(limit)) },
        };
        let fronts = self.fronts.iter().map(|AtRestitution { fronts: [within, free], smallest_q }| FrontJson {
            e: Json(within.e),
            smallest_q: smallest_q.map(Json),
            largest: within.largest().map(place),
            largest_without_other_goals: free.largest().map(place),
            front: within.pieces.iter().map(|piece| piece.iter().map(|p| [Json(p.q), Json(p.s)]).collect()).collect(),
        });
        let designs = self.designs.iter().map(|d| DesignJson {
            q: Json(d.q),
            e: Json(d.e),
            s: Json(d.s),
            goals_met: d.met.clone(),
            largest_at_this_e: d.largest.map(place),
        });
        GoalsJson {
            goals: self.all.iter().map(goal).collect(),
            region: pieces_json(&self.region),
            fronts: fronts.collect(),
            designs: designs.collect(),
        }
        .serialize(serializer)
    }
}

fn pieces_json(pieces: &[Vec<Point>]) -> Vec<Vec<[Json; 2]>> {
    pieces.iter().map(|piece| piece.iter().map(|p| [Json(p.q), Json(p.e)]).collect()).collect()
}

#[derive(Serialize)]
struct GoalsJson {
    goals: Vec<GoalJson>,
    /// Pieces of the border e(q), [q, e] each; below it all goals are met.
    region: Vec<Vec<[Json; 2]>>,
    fronts: Vec<FrontJson>,
    designs: Vec<DesignJson>,
}

#[derive(Serialize)]
struct GoalJson {
    #[serde(skip_serializing_if = "Option::is_none")]
    threshold: Option<Json>,
    #[serde(skip_serializing_if = "Option::is_none")]
    s: Option<Json>,
    #[serde(skip_serializing_if = "Option::is_none")]
    turn: Option<Json>,
}

#[derive(Serialize)]
struct PlaceJson {
    q: Json,
    s: Json,
}

#[derive(Serialize)]
struct FrontJson {
    e: Json,
    smallest_q: Option<Json>,
    largest: Option<PlaceJson>,
    largest_without_other_goals: Option<PlaceJson>,
    front: Vec<Vec<[Json; 2]>>,
}

#[derive(Serialize)]
struct DesignJson {
    q: Json,
    e: Json,
    s: Json,
    goals_met: Vec<bool>,
    largest_at_this_e: Option<PlaceJson>,
}
