//! This module shows where goals in the plane of q and e are met, and the front of the largest zone.

use std::io::{self, Write};

use clatter::contour::Point;
use clatter::design::{FrontPoint, Goal};
use clatter_answer::Error;
use clatter_answer::design::goals::{self, Answer, AtRestitution, Design};
use clatter_figures::{DesignBorder, DesignFronts, DesignPlane};

use super::{Args, write};
use crate::inputs::RowFormat;
use crate::numbers::{digits, figures, given};
use crate::{Failure, Streams};

impl Args {
    pub(super) fn of_goals(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let zones = if self.zone.is_empty() && self.turn.is_none() { goals::paper()? } else { self.zone.clone() };
        let all: Vec<Goal> = zones.iter().chain(&self.turn).copied().collect();
        let answer = goals::answer(&all).map_err(|error| match error {
            Error::NoZone => Failure::Usage("a goal of turning needs a safe zone beside it: --zone=X:S"),
            error => error.into(),
        })?;
        let shown = Shown(&answer);
        if let Some(path) = &self.output {
            let border = || DesignBorder::Exact(answer.region.clone());
            let plane = || DesignPlane {
                borders: vec![("the goals".to_owned(), border())],
                reach: Some([self.q, self.e]),
                designs: answer.designs.iter().map(|d| (name(d), Point { q: d.q, e: d.e })).collect(),
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
            write(path, || clatter_figures::fronts(&shown.drawing()), |out| shown.fronts_csv(out))?;
        }
        match self.format {
            RowFormat::Table => shown.table(streams.out).map_err(Failure::Answer),
            RowFormat::Csv => shown.csv(streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&answer),
        }
    }
}

fn name(design: &Design) -> String {
    format!("({}, {})", given(design.q), given(design.e))
}

/// The output of an answer about goals.
struct Shown<'a>(&'a Answer);

impl Shown<'_> {
    fn drawing(&self) -> DesignFronts {
        let others: Vec<String> = self.0.others.iter().map(|goal| said(goal, "*v*_0")).collect();
        DesignFronts {
            threshold: self.0.threshold,
            wanted: self.0.wanted,
            fronts: self.0.fronts.iter().map(|at| at.fronts.clone()).collect(),
            others: others.join(", "),
            designs: self.0.designs.iter().map(|d| (name(d), FrontPoint { q: d.q, s: d.s })).collect(),
        }
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let goals: Vec<String> = self.0.all.iter().map(|goal| said(goal, "v0")).collect();
        writeln!(out, "Goals: {}", goals.join("; "))?;
        if self.0.region.is_empty() {
            writeln!(out, "No q and e meet all of them")?;
        } else {
            let most = self.0.region.iter().flatten().map(|p| p.e).fold(0.0, f64::max);
            writeln!(out, "They are met with e up to {}", figures(most))?;
        }
        let zone = format!("zone within {} v0", given(self.0.threshold));
        writeln!(out, "\nFront of the largest {zone} against q, the other goals met")?;
        writeln!(out, "{:>6}  {:>13}  {:>13}  {:>13}", "e", "smallest q", "largest zone", "at q")?;
        writeln!(out, "{:>6}  {:>13}  {:>13}  {:>13}", "", "meeting all", "% of the bar", "")?;
        let cell = |x: Option<f64>| x.map_or("none".to_owned(), figures);
        for AtRestitution { fronts: [within, _], smallest_q, .. } in &self.0.fronts {
            let largest = within.largest();
            let (s, q) = (largest.map(|p| 100.0 * p.s), largest.map(|p| p.q));
            writeln!(out, "{:>6}  {:>13}  {:>13}  {:>13}", given(within.e), cell(*smallest_q), cell(s), cell(q))?;
        }
        writeln!(out, "All mass in the center of a dead casing (q = 1, e = 0), the free optimum, cannot be built.")?;
        writeln!(out, "\nDesigns of the paper's Table 1")?;
        writeln!(out, "{:>6} {:>6}  {:>13}  {:>13}  {:>13}   goals met", "q", "e", "zone", "largest at e", "at q")?;
        for design in &self.0.designs {
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
        for AtRestitution { fronts: [within, _], smallest_q, .. } in &self.0.fronts {
            let largest = within.largest();
            let cells = [*smallest_q, largest.map(|p| p.s), largest.map(|p| p.q)];
            let cells = cells.map(|cell| cell.map(digits).unwrap_or_default());
            writeln!(out, "{},{}", digits(within.e), cells.join(","))?;
        }
        Ok(())
    }

    fn fronts_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "e,other_goals_met,piece,q,s")?;
        for at in &self.0.fronts {
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
}

/// Describes a goal in words.
fn said(goal: &Goal, unit: &str) -> String {
    match *goal {
        Goal::Zone { threshold, s } => format!("{} {unit} within {} % of the bar", given(threshold), given(100.0 * s)),
        Goal::Turn { limit } => format!("turning by {} {unit}/L", given(limit)),
    }
}

fn points_csv(before: &str, pieces: &[Vec<Point>], out: &mut dyn Write) -> io::Result<()> {
    for (i, piece) in pieces.iter().enumerate() {
        for p in piece {
            writeln!(out, "{before}{},{},{}", i + 1, digits(p.q), digits(p.e))?;
        }
    }
    Ok(())
}
