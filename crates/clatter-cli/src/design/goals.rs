//! Goals in the plane of q and e: where they are met, and the front of the largest zone.

use std::io::{self, Write};

use clatter::contour::Point;
use clatter::design::{DESIGNS, Front, FrontPoint, Goal, front, region};
use clatter::{Bar, Start};
use clatter_figures::{DesignBorder, DesignFronts, DesignPlane};
use serde::Serialize;

use super::{Args, write};
use crate::inputs::RowFormat;
use crate::numbers::{Json, digits, figures, given};
use crate::{Failure, Streams};

/// The paper's example (section 6), threshold and zone: the second, “substantially most of the bar”, is met by all
/// designs that it suggests.
const PAPER: [[f64; 2]; 2] = [[0.5, 0.1], [2.0, 0.85]];
/// Restitutions whose fronts are given.
const RESTITUTIONS: [f64; 7] = [0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3];
/// Points of a front for a unit of q.
const STEPS: u32 = 200;
/// How far the border may lie off its chords.
const FLATNESS: f64 = 2e-4;

impl Args {
    pub(super) fn of_goals(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let zones = if self.zone.is_empty() && self.turn.is_none() {
            PAPER.iter().map(|[x, s]| Goal::zone(*x, *s)).collect::<Result<_, _>>()?
        } else {
            self.zone.clone()
        };
        let Some((&Goal::Zone { threshold, s }, others)) = zones.split_first() else {
            return Err(Failure::Usage("a goal of turning needs a safe zone beside it: --zone=X:S"));
        };
        let others: Vec<Goal> = others.iter().chain(&self.turn).copied().collect();
        let goals: Vec<Goal> = zones.iter().chain(&self.turn).copied().collect();
        let answer = Goals::solve(threshold, s, others, goals)?;
        if let Some(path) = &self.output {
            let border = || DesignBorder::Exact(answer.region.clone());
            let plane = || DesignPlane {
                borders: vec![("the goals".to_owned(), border())],
                reach: Some([self.q, self.e]),
                designs: answer.designs.iter().map(|d| (d.name(), Point { q: d.q, e: d.e })).collect(),
                ..DesignPlane::default()
            };
            write(
                path,
                || clatter_figures::design_plane(&plane()),
                |out| {
                    writeln!(out, "piece,q,e")?;
                    points_csv("", &answer.region, out)
                },
            )?;
        }
        if let Some(path) = &self.front {
            write(path, || clatter_figures::fronts(&answer.drawing()), |out| answer.fronts_csv(out))?;
        }
        match self.format {
            RowFormat::Table => answer.table(streams.out).map_err(Failure::Answer),
            RowFormat::Csv => answer.csv(streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&answer.json()),
        }
    }
}

/// What goals come to.
struct Goals {
    threshold: f64,
    wanted: f64,
    /// The other goals.
    others: Vec<Goal>,
    /// All goals.
    all: Vec<Goal>,
    region: Vec<Vec<Point>>,
    fronts: Vec<AtRestitution>,
    designs: Vec<Design>,
}

/// At one restitution.
struct AtRestitution {
    /// Among designs that meet the other goals, and among all.
    fronts: [Front; 2],
    /// The smallest q that meets all goals.
    smallest_q: Option<f64>,
}

/// A design of Table 1.
struct Design {
    q: f64,
    e: f64,
    s: f64,
    met: Vec<bool>,
    /// The largest zone at its restitution that leaves the other goals met.
    largest: Option<FrontPoint>,
}

impl Design {
    fn name(&self) -> String {
        format!("({}, {})", given(self.q), given(self.e))
    }
}

impl Goals {
    fn solve(threshold: f64, wanted: f64, others: Vec<Goal>, all: Vec<Goal>) -> Result<Self, clatter::Error> {
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
        Ok(Self { threshold, wanted, region: region(&all, FLATNESS), others, all, fronts, designs })
    }

    fn drawing(&self) -> DesignFronts {
        let others: Vec<String> = self.others.iter().map(|goal| said(goal, "*v*_0")).collect();
        DesignFronts {
            threshold: self.threshold,
            wanted: self.wanted,
            fronts: self.fronts.iter().map(|at| at.fronts.clone()).collect(),
            others: others.join(", "),
            designs: self.designs.iter().map(|d| (d.name(), FrontPoint { q: d.q, s: d.s })).collect(),
        }
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let goals: Vec<String> = self.all.iter().map(|goal| said(goal, "v0")).collect();
        writeln!(out, "Goals: {}", goals.join("; "))?;
        if self.region.is_empty() {
            writeln!(out, "No q and e meet all of them")?;
        } else {
            let most = self.region.iter().flatten().map(|p| p.e).fold(0.0, f64::max);
            writeln!(out, "They are met with e up to {}", figures(most))?;
        }
        let zone = format!("zone within {} v0", given(self.threshold));
        writeln!(out, "\nFront of the largest {zone} against q, the other goals met")?;
        writeln!(out, "{:>6}  {:>13}  {:>13}  {:>13}", "e", "smallest q", "largest zone", "at q")?;
        writeln!(out, "{:>6}  {:>13}  {:>13}  {:>13}", "", "meeting all", "% of the bar", "")?;
        let cell = |x: Option<f64>| x.map_or("none".to_owned(), figures);
        for AtRestitution { fronts: [within, _], smallest_q } in &self.fronts {
            let largest = within.largest();
            let (s, q) = (largest.map(|p| 100.0 * p.s), largest.map(|p| p.q));
            writeln!(out, "{:>6}  {:>13}  {:>13}  {:>13}", given(within.e), cell(*smallest_q), cell(s), cell(q))?;
        }
        writeln!(out, "All mass in the center of a dead casing (q = 1, e = 0), the free optimum, cannot be built.")?;
        writeln!(out, "\nDesigns of the paper's Table 1")?;
        writeln!(out, "{:>6} {:>6}  {:>13}  {:>13}  {:>13}   goals met", "q", "e", "zone", "largest at e", "at q")?;
        for design in &self.designs {
            let met: Vec<&str> = design.met.iter().map(|met| if *met { "yes" } else { "no" }).collect();
            let (s, q) = (design.largest.map(|p| 100.0 * p.s), design.largest.map(|p| p.q));
            let row = [figures(100.0 * design.s), cell(s), cell(q)];
            let (dq, de) = (given(design.q), given(design.e));
            writeln!(out, "{dq:>6} {de:>6}  {:>13}  {:>13}  {:>13}   {}", row[0], row[1], row[2], met.join(", "))?;
        }
        Ok(())
    }

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "e,smallest_q,largest_s,at_q")?;
        for AtRestitution { fronts: [within, _], smallest_q } in &self.fronts {
            let largest = within.largest();
            let cells = [*smallest_q, largest.map(|p| p.s), largest.map(|p| p.q)];
            let cells = cells.map(|cell| cell.map(digits).unwrap_or_default());
            writeln!(out, "{},{}", digits(within.e), cells.join(","))?;
        }
        Ok(())
    }

    fn fronts_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "e,other_goals_met,piece,q,s")?;
        for at in &self.fronts {
            for (front, met) in at.fronts.iter().zip([true, false]) {
                for (i, piece) in front.pieces.iter().enumerate() {
                    for p in piece {
                        writeln!(out, "{},{met},{},{},{}", digits(front.e), i + 1, digits(p.q), digits(p.s))?;
                    }
                }
            }
        }
        Ok(())
    }

    fn json(&self) -> GoalsJson {
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
    }
}

/// A goal in words.
fn said(goal: &Goal, unit: &str) -> String {
    match *goal {
        Goal::Zone { threshold, s } => format!("{} {unit} within {} % of the bar", given(threshold), given(100.0 * s)),
        Goal::Turn { limit } => format!("turning by {} {unit}/L", given(limit)),
    }
}

fn pieces_json(pieces: &[Vec<Point>]) -> Vec<Vec<[Json; 2]>> {
    pieces.iter().map(|piece| piece.iter().map(|p| [Json(p.q), Json(p.e)]).collect()).collect()
}

fn points_csv(before: &str, pieces: &[Vec<Point>], out: &mut dyn Write) -> io::Result<()> {
    for (i, piece) in pieces.iter().enumerate() {
        for p in piece {
            writeln!(out, "{before}{},{},{}", i + 1, digits(p.q), digits(p.e))?;
        }
    }
    Ok(())
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
