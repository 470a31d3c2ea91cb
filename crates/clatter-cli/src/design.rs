//! `clatter design`: which inertia ratios and restitutions meet the limits, and what would make each failing part safe.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use clap::ValueHint;
use clatter::contour::Point;
use clatter::design::{Front, FrontPoint, Goal, front, region};
use clatter::paper::DESIGNS;
use clatter::{Bar, Start};
use clatter_report::{DesignBorder, DesignFronts, DesignPlane};
use clatter_scene::design::{Border, Bounds, Lever, Outcome, Plane, Remedies, Remedy};
use clatter_scene::{Assessment, ComponentAssessment, ProductFile, Verdict};
use serde::Serialize;

use crate::inputs::{self, RowFormat};
use crate::numbers::{Json, digits, figures, given};
use crate::text::{field, shown};
use crate::{Failure, Streams, assess, output};

/// Tell which q and e meet the limits, and what would make each failing part safe
///
/// Of a product file: every component that 'clatter assess' finds unsafe, and for each thing that can be changed alone
/// (the mass layout q, the restitution e, the part's place, its natural frequency, its damping) the smallest change
/// that makes it safe, assessed again with it, or that none does within the bounds. Of goals (safe zones, in v0): where
/// in the plane of q and e they are met, and the front of the largest zone against q for each e. Without either, the
/// goals are the paper's example: v0/2 in the middle tenth of the bar, 2 v0 in nearly all of it; the designs of its
/// Table 1 stand beside the front.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter design                                                 the paper's example
  clatter design --zone=0.5:0.1 --zone=2:0.85 --front=front.svg
  clatter design handheld.toml -o plane.svg
  clatter design handheld.toml --q=0.3:0.7 --e=0.2:0.5 --format=json

'clatter --help' tells what q, e and the units are.")]
pub(crate) struct Args {
    /// Product file
    #[arg(value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath)]
    product: Option<PathBuf>,
    /// Goal: shocks up to X v0 within S of the bar, its middle part in [0, 1]; may be given several times, and the
    /// first is the one whose zone the front enlarges
    #[arg(long, value_name = "X:S", allow_hyphen_values = true, value_parser = zone, conflicts_with = "product")]
    zone: Vec<Goal>,
    /// Goal: changes of the angular velocity up to W, in v0/L
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = turn, conflicts_with = "product")]
    turn: Option<Goal>,
    /// Inertia ratios that can be built, in [0, 1]
    #[arg(long, value_name = "LO:HI", default_value = "0:0.9", allow_hyphen_values = true, value_parser = unit_range)]
    q: [f64; 2],
    /// Coefficients of restitution that can be had, in [0, 1]
    #[arg(long, value_name = "LO:HI", default_value = "0.05:0.9", allow_hyphen_values = true, value_parser = unit_range)]
    e: [f64; 2],
    /// Largest factor on a natural frequency, up or down, above 1
    #[arg(long, value_name = "F", default_value = "4", allow_hyphen_values = true, value_parser = factor)]
    frequency_factor: f64,
    /// Damping ratios that can be had, in [0, 10]
    #[arg(long, value_name = "LO:HI", default_value = "0:0.5", allow_hyphen_values = true, value_parser = damping_range)]
    damping: [f64; 2],
    /// Write the plane of q and e to this file: .svg a picture, .csv its borders; of a product without gravity, at
    /// small tilt and by instant impacts; takes seconds
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target)]
    output: Option<PathBuf>,
    /// Write the fronts of the largest zone to this file: .svg a picture, .csv their points
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target, conflicts_with = "product")]
    front: Option<PathBuf>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

fn zone(text: &str) -> Result<Goal, String> {
    let (x, s) =
        text.split_once(':').ok_or("a goal is X:S, a velocity shock in v0 and the part of the bar, such as 0.5:0.1")?;
    Goal::zone(inputs::number(x)?, inputs::number(s)?).map_err(|error| error.to_string())
}

fn turn(text: &str) -> Result<Goal, String> {
    Goal::turn(inputs::number(text)?).map_err(|error| error.to_string())
}

fn unit_range(text: &str) -> Result<[f64; 2], String> {
    range(text, 1.0)
}

fn damping_range(text: &str) -> Result<[f64; 2], String> {
    range(text, 10.0)
}

fn range(text: &str, most: f64) -> Result<[f64; 2], String> {
    let (lo, hi) = text.split_once(':').ok_or("a range is LO:HI, such as 0.1:0.6")?;
    let (lo, hi) = (inputs::number(lo)?, inputs::number(hi)?);
    if lo >= 0.0 && lo <= hi && hi <= most {
        Ok([lo, hi])
    } else {
        Err(format!("{lo:?}:{hi:?} is not a range LO:HI within [0, {most}]"))
    }
}

fn factor(text: &str) -> Result<f64, String> {
    let factor = inputs::number(text)?;
    let allowed = "above 1 and at most 1000";
    if factor > 1.0 && factor <= 1000.0 { Ok(factor) } else { Err(format!("factor {factor:?} is not {allowed}")) }
}

fn target(text: &str) -> Result<PathBuf, &'static str> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("svg" | "csv") => Ok(path),
        _ => Err("the file must end in .svg or .csv"),
    }
}

/// Whether a picture is wanted.
fn picture(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "svg")
}

fn write(
    path: &Path,
    svg: impl FnOnce() -> String,
    csv: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    output::replace(path, |file: &mut File| {
        let mut out = BufWriter::new(file);
        if picture(path) {
            out.write_all(svg().as_bytes())?;
        } else {
            csv(&mut out)?;
        }
        out.flush()
    })
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        match &self.product {
            Some(path) => self.of_product(&assess::read(path)?, streams),
            None => self.of_goals(streams),
        }
    }

    fn bounds(&self) -> Bounds {
        Bounds { q: self.q, e: self.e, frequency_factor: self.frequency_factor, damping: self.damping }
    }

    fn of_product(&self, file: &ProductFile, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let bounds = self.bounds();
        let assessment = file.assess()?;
        let remedies = file.remedies(&assessment, &bounds)?;
        if let Some(path) = &self.output {
            let plane = Plane::of(file, &bounds)?;
            write(path, || clatter_report::design_svg(&drawing(&plane)), |out| plane_csv(&plane, out))?;
        }
        match self.format {
            RowFormat::Table => product_table(file, &assessment, &remedies, streams.out).map_err(Failure::Answer),
            RowFormat::Csv => product_csv(&assessment, &remedies, streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&ProductJson::new(file, &assessment, &remedies)),
        }
    }

    fn of_goals(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
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
                product: None,
            };
            write(
                path,
                || clatter_report::design_svg(&plane()),
                |out| {
                    writeln!(out, "piece,q,e")?;
                    points_csv("", &answer.region, out)
                },
            )?;
        }
        if let Some(path) = &self.front {
            write(path, || clatter_report::fronts_svg(&answer.drawing()), |out| answer.fronts_csv(out))?;
        }
        match self.format {
            RowFormat::Table => answer.table(streams.out).map_err(Failure::Answer),
            RowFormat::Csv => answer.csv(streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&answer.json()),
        }
    }
}

/// The paper's example (section 6), threshold and zone: the second, “substantially most of the bar”, is met by all
/// designs that it suggests.
const PAPER: [[f64; 2]; 2] = [[0.5, 0.1], [2.0, 0.85]];
/// Restitutions whose fronts are given.
const RESTITUTIONS: [f64; 7] = [0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3];
/// Points of a front for a unit of q.
const STEPS: u32 = 200;
/// How far the border may lie off its chords.
const FLATNESS: f64 = 2e-4;

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
                s: bar.safe_zone(&Start::default(), threshold).s,
                met: all.iter().map(|goal| goal.margin(&bar) >= 0.0).collect(),
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
        writeln!(out, "{:>6}  {:>13}  {:>13}  {:>13}", "", "that meets all", "% of the bar", "")?;
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

fn drawing(plane: &Plane) -> DesignPlane {
    let border = |border: &Border| match border {
        Border::Exact(pieces) => DesignBorder::Exact(pieces.clone()),
        Border::Grid(margins) => DesignBorder::Grid { side: Plane::GRID, margins: margins.clone() },
    };
    DesignPlane {
        borders: plane.components.iter().map(|c| (c.name.clone(), border(&c.border))).collect(),
        product: Some((plane.q, plane.e)),
        reach: Some([plane.bounds.q, plane.bounds.e]),
        designs: Vec::new(),
    }
}

/// Exact borders as points of curves, searched ones as margins on their grid.
fn plane_csv(plane: &Plane, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "component,piece,q,e,margin")?;
    #[expect(clippy::cast_precision_loss, reason = "a small count")]
    let at = |i: usize| i as f64 / (Plane::GRID - 1) as f64;
    for component in &plane.components {
        let name = field(&component.name);
        match &component.border {
            Border::Exact(pieces) => {
                for (i, piece) in pieces.iter().enumerate() {
                    for p in piece {
                        writeln!(out, "{name},{},{},{},0.0", i + 1, digits(p.q), digits(p.e))?;
                    }
                }
            }
            Border::Grid(margins) => {
                for (k, margin) in margins.iter().enumerate() {
                    let (q, e) = (at(k / Plane::GRID), at(k % Plane::GRID));
                    writeln!(out, "{name},,{},{},{}", digits(q), digits(e), digits(*margin))?;
                }
            }
        }
    }
    Ok(())
}

/// The smallest margin of a component.
fn margin(component: &ComponentAssessment) -> f64 {
    component.limits.iter().map(|limit| limit.margin).fold(f64::INFINITY, f64::min)
}

/// A value of a lever in words: a range where it is one; lengths in mm.
fn value(lever: Lever, [lo, hi]: [f64; 2]) -> String {
    let (scale, unit) = match lever {
        Lever::Position => (1e3, " mm"),
        Lever::Frequency => (1.0, " Hz"),
        _ => (1.0, ""),
    };
    let (lo, hi) = (figures(scale * lo), figures(scale * hi));
    if lo == hi { format!("{lo}{unit}") } else { format!("{lo} to {hi}{unit}") }
}

/// What a lever is called.
fn lever_name(lever: Lever) -> &'static str {
    match lever {
        Lever::InertiaRatio => "inertia ratio q",
        Lever::Restitution => "restitution e",
        Lever::Position => "place",
        Lever::Frequency => "natural frequency",
        Lever::Damping => "damping ratio",
    }
}

fn product_table(
    file: &ProductFile,
    assessment: &Assessment,
    remedies: &[Remedies],
    out: &mut dyn Write,
) -> io::Result<()> {
    let restitution = &file.product.restitution;
    let e = value(Lever::Restitution, [restitution.lo(), restitution.hi()]);
    let q = figures(file.product.inertia_ratio());
    writeln!(out, "{}: q = {q}, e = {e}", shown(&file.product.name, 60))?;
    if remedies.is_empty() {
        return writeln!(out, "Every part is safe: nothing has to change");
    }
    let failing = remedies.len();
    writeln!(
        out,
        "{failing} of {} parts fail; what would make each safe, one change at a time:",
        assessment.components.len()
    )?;
    for part in remedies {
        let Some(component) = assessment.components.get(part.component) else { continue };
        writeln!(out, "\n{} (margin {} %)", shown(&component.name, 60), figures(100.0 * margin(component)))?;
        let mut warnings: Vec<(&String, Vec<&str>)> = Vec::new();
        for Remedy { lever, outcome } in &part.levers {
            let name = lever_name(*lever);
            match outcome {
                Outcome::Change { from, to, after } => {
                    let left = figures(100.0 * margin(after));
                    writeln!(
                        out,
                        "  {name:<18} {} -> {}   (margin then {left} %)",
                        value(*lever, *from),
                        value(*lever, *to)
                    )?;
                    if let Some(warning) = &after.tightest().warning {
                        match warnings.iter_mut().find(|(known, _)| *known == warning) {
                            Some((_, levers)) => levers.push(name),
                            None => warnings.push((warning, vec![name])),
                        }
                    }
                }
                Outcome::Nowhere { bounds: [lo, hi] } => {
                    let (lo, hi) = (value(*lever, [*lo; 2]), value(*lever, [*hi; 2]));
                    writeln!(out, "  {name:<18} no value from {lo} to {hi} is enough")?;
                }
                Outcome::NoEffect => writeln!(out, "  {name:<18} has no effect on its limits")?,
            }
        }
        for (warning, levers) in warnings {
            writeln!(out, "  warning ({}): {warning}", levers.join(", "))?;
        }
    }
    Ok(())
}

fn product_csv(assessment: &Assessment, remedies: &[Remedies], out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "component,margin,lever,unit,outcome,from_lo,from_hi,to_lo,to_hi,margin_after")?;
    for part in remedies {
        let Some(component) = assessment.components.get(part.component) else { continue };
        let (name, before) = (field(&component.name), digits(margin(component)));
        for Remedy { lever, outcome } in &part.levers {
            let rest = match outcome {
                Outcome::Change { from, to, after } => {
                    let cells = [from[0], from[1], to[0], to[1], margin(after)].map(digits);
                    format!("change,{}", cells.join(","))
                }
                Outcome::Nowhere { .. } => "nowhere,,,,,".to_owned(),
                Outcome::NoEffect => "no-effect,,,,,".to_owned(),
            };
            writeln!(out, "{name},{before},{},{},{rest}", lever.name(), lever.unit())?;
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

#[derive(Serialize)]
struct ProductJson<'a> {
    product: &'a str,
    q: Json,
    restitution: [Json; 2],
    verdict: Verdict,
    components: Vec<PartJson<'a>>,
}

#[derive(Serialize)]
struct PartJson<'a> {
    name: &'a str,
    verdict: Verdict,
    margin: Json,
    remedies: Vec<RemedyJson>,
}

#[derive(Serialize)]
struct RemedyJson {
    lever: &'static str,
    unit: &'static str,
    outcome: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<[Json; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    to: Option<[Json; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    margin_after: Option<Json>,
    #[serde(skip_serializing_if = "Option::is_none")]
    warning: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bounds: Option<[Json; 2]>,
}

impl RemedyJson {
    fn new(Remedy { lever, outcome }: &Remedy) -> Self {
        let (lever, unit) = (lever.name(), lever.unit());
        let (from, to, margin_after, warning, bounds) = (None, None, None, None, None);
        let none = Self { lever, unit, outcome: "no-effect", from, to, margin_after, warning, bounds };
        match outcome {
            Outcome::Change { from, to, after } => Self {
                outcome: "change",
                from: Some(from.map(Json)),
                to: Some(to.map(Json)),
                margin_after: Some(Json(margin(after))),
                warning: after.tightest().warning.clone(),
                ..none
            },
            Outcome::Nowhere { bounds } => Self { outcome: "nowhere", bounds: Some(bounds.map(Json)), ..none },
            Outcome::NoEffect => none,
        }
    }
}

impl<'a> ProductJson<'a> {
    fn new(file: &'a ProductFile, assessment: &'a Assessment, remedies: &[Remedies]) -> Self {
        let levers = |i: usize| remedies.iter().find(|part| part.component == i).map_or(&[][..], |part| &part.levers);
        let part = |(i, component): (usize, &'a ComponentAssessment)| PartJson {
            name: &component.name,
            verdict: component.verdict,
            margin: Json(margin(component)),
            remedies: levers(i).iter().map(RemedyJson::new).collect(),
        };
        Self {
            product: &file.product.name,
            q: Json(file.product.inertia_ratio()),
            restitution: [Json(file.product.restitution.lo()), Json(file.product.restitution.hi())],
            verdict: assessment.verdict,
            components: assessment.components.iter().enumerate().map(part).collect(),
        }
    }
}
