//! `clatter simulate`: one drop in time, by a model of the user's choice.

mod answer;
mod file;
mod table;

use clap::ValueHint;
use clatter::Mass;
use clatter::flight::{Pulse, Scene, Stop};

use crate::drop_args::{DropArgs, ModelName, Motion};
use crate::inputs::{self, RowFormat};
use crate::numbers::figures;
use crate::output::{Kind, Target};
use crate::{Failure, Streams};

/// Follow one drop in time: its strikes, how hard they are, and how it comes to rest
///
/// Four models of the same drop, each the cheapest that keeps its physics; run two to see what it
/// matters:
///
///   map          small tilt, no gravity, instant impacts: the paper's bar
///   ballistic    with gravity: what bounced clear comes back, until it lies still
///   finite-tilt  with gravity and the exact geometry of any tilt
///   compliant    as finite-tilt, and every contact takes time: pulses, that may overlap
///
/// A body of length 2L falls with its end a lower, which touches at time 0; end b is 2L sin(tilt)
/// higher then. Everything is in SI units; heights and velocities are vertical, upward positive, and
/// positions run from -1 (end a) to 1 (end b).
///
/// A file written with -o holds the whole motion; its ending decides how:
///
///   .csv   rows over time: heights and velocities of both ends and velocities at --at; for compliant
///          also the forces on the ends over the mass, and accelerations. Each strike is two rows,
///          just before and just after, and straight lines through all rows follow the motion
///   .json  the answer of --format=json with these rows as "history"
///   .svg   a picture: heights over time with the strikes marked, the velocity shocks below, and for
///          compliant the pulses
#[derive(Debug, clap::Args)]
#[command(
    verbatim_doc_comment,
    after_help = "\
Examples:
  clatter simulate --model=finite-tilt --length-m=0.14 --gyration-m=0.04 --e=0.3 \\
      --height-m=1 --tilt-deg=5
  clatter simulate --model=compliant --contact-time-s=5e-4 --length-m=0.2 --mass=2@-1:1 \\
      --mass=1@0.5 --e=0.3 --speed-m-s=4 --tilt-deg=5

Add --at=0 -o drop.svg for a picture, with the shocks of the middle.

The motion ends at rest (proven, with bounds on what is left), bounced clear (without gravity, where
nothing brings the body back), at a limit, or, of a body of thickness, where it has turned over."
)]
pub(crate) struct Args {
    /// Which physics to keep
    #[arg(long, value_enum, requires = "fall")]
    model: ModelName,
    #[command(flatten)]
    inertia: Inertia,
    /// Coefficient of restitution, in [0, 1]: rebound speed of an end over its approach speed
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = inputs::restitution)]
    e: f64,
    #[command(flatten)]
    drop: DropArgs,
    /// Also give the velocity shocks at this position, in [-1, 1]: -1 is end a, 0 the middle, 1 end b; may be given
    /// several times
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::position)]
    at: Vec<f64>,
    /// Also write the whole motion to a file, ending in .csv, .json or .svg; what was there is replaced once the new
    /// file is whole
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target)]
    output: Option<Target>,
    /// How to show the strikes
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

/// How its mass lies.
#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct Inertia {
    /// Radius of gyration about the center of mass, in m: length/√12 for evenly spread mass; it may exceed the
    /// half-length
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = inputs::number)]
    gyration_m: Option<f64>,
    /// Instead of it: a mass M in any unit at position S, or spread evenly from S to T, in half-lengths from the
    /// middle; given once for each piece, like --mass=2@-1:1 --mass=1@0.5
    #[arg(long, value_name = "M@S[:T]", allow_hyphen_values = true, value_parser = inputs::mass)]
    mass: Vec<Mass>,
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Json, Kind::Svg])
}

/// A drop and what came of it.
struct Drop<'a> {
    args: &'a Args,
    /// Position of the center of mass on the body.
    center_of_mass: f64,
    scene: Scene,
    motion: Motion,
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let (center_of_mass, body) = self.drop.body(self.inertia.gyration_m, &self.inertia.mass, self.e)?;
        let scene = self.drop.scene(body, self.e)?;
        let motion = self.drop.motion(self.model, &scene)?;
        let drop = Drop { args: self, center_of_mass, scene, motion };
        if let Some(target) = &self.output {
            drop.write(target)?;
        }
        match self.format {
            RowFormat::Table => drop.table(streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => drop.csv(streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.json(&drop.answer())?,
        }
        for warning in drop.warnings() {
            streams.note("warning", warning);
        }
        Ok(())
    }
}

impl Drop<'_> {
    /// Velocity shocks at the positions asked for, of each strike.
    fn shocks(&self, strike: &clatter::flight::Strike) -> impl Iterator<Item = f64> {
        self.args.at.iter().map(|&s| strike.delta_v_at(s))
    }

    /// Largest velocity shock of each end, in its own strikes and those of the other.
    fn largest(&self) -> [f64; 2] {
        [-1.0, 1.0].map(|s| self.largest_of(s))
    }

    fn largest_at(&self) -> impl Iterator<Item = f64> {
        self.args.at.iter().map(|&s| self.largest_of(s))
    }

    fn largest_of(&self, s: f64) -> f64 {
        self.motion.flight().strikes.iter().map(|strike| strike.delta_v_at(s).abs()).fold(0.0, f64::max)
    }

    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let (flight, pulses) = (self.motion.flight(), self.motion.pulses());
        let overlap = |&(i, pulse): &(usize, &Pulse)| pulses[..i].iter().any(|before| pulse.from_s < before.until_s);
        let overlaps = pulses.iter().enumerate().filter(overlap);
        if let Some((_, first)) = overlaps.clone().next() {
            let n = overlaps.count();
            let (number, touches) = (first.strike, if n == 1 { "strike begins" } else { "strikes begin" });
            warnings.push(format!(
                "{n} {touches} while the other end still presses, the first is number {number}: \
                 the impulses of such strikes depend on the contact time"
            ));
        }
        match flight.stop {
            Stop::ImpactLimit { .. } => {
                let n = flight.strikes.len();
                warnings.push(format!("stopped after {n} impacts, more would follow; --impact-limit=N follows more"));
            }
            Stop::TimeLimit { time_s } if self.args.drop.time_limit_s.is_none_or(|limit| time_s < limit) => {
                let time = figures(time_s);
                warnings.push(format!("left at {time} s, where the body neither rests nor strikes again in sight"));
            }
            _ => {}
        }
        warnings
    }
}
