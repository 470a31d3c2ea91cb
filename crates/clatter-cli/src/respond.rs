//! `clatter respond`: what one clatter does to one component.

mod drop;
mod peaks;
mod rule;
mod train;

use std::path::PathBuf;

use clap::ValueHint;
use clatter::{Bar, Mass};
use clatter_shock::{ShockTable, Suspension};

use crate::drop_args::DropArgs;
use crate::inputs::{self, DampingArgs, Format, ModelName};
use crate::output::{Files, Kind, Target};
use crate::{Failure, Streams, excitation};

/// Tell what a clatter does to a component on its suspension
///
/// The component sits at position S of the bar and swings with the natural angular frequency W. Every
/// impact is a velocity shock there; the peaks that follow are exact, from turning points and never
/// from samples, and the ring-down is complete. Only W h0/v0 and the damping matter:
///
///   W h0/v0 small   the component is slower than the whole clatter and sees the net change of
///                   velocity
///   W h0/v0 large   it has calmed down before the next impact, and the largest shock decides;
///                   without damping it never does, and the shocks add up by phase
///   between         the impacts can fall into step with it: resonance
///
/// Peaks are given as velocities: W z, of the displacement z relative to the bar, and A/W, of the
/// absolute acceleration A. A single velocity shock of 1 makes both 1 if there is no damping.
///
/// `-o FILE` writes this rule as a curve over W h0/v0: .csv, .json, or .svg for a picture.
///
/// What shakes the component is the clatter of the paper's bar, from --q and --e. Or it is
///
///   --model         a drop in SI units by any of the models of `clatter simulate`: with gravity,
///                   real tilt, an off-center mass, contacts that take time; W is then in rad/s. It is
///                   answered as `clatter assess` answers it, to the --tolerance, and followed until
///                   nothing later counts: a spin and limits of time and number are options of
///                   `clatter simulate` alone. Without --omega the part is mounted rigidly, and the
///                   answer is what its place goes through
///   --shocks-file   velocity shocks from a file in SI units, of any number, with the columns time_s
///                   and delta_v_m_s
///   --pulses-file   pulses, with the columns shape, amplitude_m_s2, duration_s and start_s; shapes
///                   as in `clatter spectrum --help`; they may overlap
///
/// --equivalent-pulse names the half-sine of a shock table that does the same to the component, in
/// acceleration and in relative displacement to 1 %, or says that there is none. For that everything
/// has to be in SI units, --velocity and --height-gap too.
#[derive(Debug, clap::Args)]
#[command(
    verbatim_doc_comment,
    after_help = "\
Examples:
  clatter respond --q=0.73 --e=0.2 --at=1 --omega=3               a part at the end that strikes second
  clatter respond --q=0.73 --e=0.2 --at=0 --omega=3 --damping=0   in the middle, without damping
  clatter respond --q=0.5 --e=0.3 --at=1 --omega=1131 --velocity=-4.85,-4.85 --height-gap=0.005
                                    a board mode of 180 Hz in a phone dropped from 1.2 m, all in SI
  clatter respond --q=0.73 --e=0.2 --at=1 --omega=3 -o rule.svg   the three-way rule, drawn
  clatter respond --model=finite-tilt --length-m=0.14 --gyration-m=0.04 --e=0.3 --height-m=1.2 \\
      --tilt-deg=5 --at=1 --omega=1131 --equivalent-pulse         the same board, with gravity
  clatter respond --model=compliant --contact-time-s=4e-4 --length-m=0.14 --gyration-m=0.04 \\
      --e=0.3 --height-m=1.2 --tilt-deg=5 --at=0.5                a part that is mounted rigidly
  clatter respond --shocks-file=shocks.csv --omega=1131

'clatter --help' tells what q, e and the units are."
)]
pub(crate) struct Args {
    #[command(flatten)]
    inertia: Inertia,
    /// Coefficient of restitution, in [0, 1]: rebound speed of an end over its approach speed
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = inputs::restitution, required_unless_present_any = FILES, requires = "inertia")]
    e: Option<f64>,
    /// Position of the component, in [-1, 1]: -1 is end a, which strikes first, 0 the middle, 1 end b
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::worked_out_position, required_unless_present_any = FILES)]
    at: Option<f64>,
    /// Natural angular frequency of the component (2π times its frequency), in v0/h0; in rad/s with --model or a file;
    /// with --model alone it may be left out
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = inputs::omega, required_unless_present = "model")]
    omega: Option<f64>,
    #[command(flatten)]
    damping: DampingArgs,
    /// Velocities of ends a and b at first contact, upward positive; VA is negative: end a strikes
    #[arg(long, value_name = "VA,VB", default_value = "-1,-1", allow_hyphen_values = true, value_parser = inputs::velocity, conflicts_with = "model")]
    velocity: [f64; 2],
    /// Height of end b when end a first touches; 0 for a flat drop, whose impacts come all at once
    #[arg(long, value_name = "H0", default_value = "1", allow_hyphen_values = true, value_parser = inputs::height_gap, conflicts_with = "model")]
    height_gap: f64,
    /// Follow a drop in SI units by this model
    #[arg(long, value_enum, requires = "fall")]
    model: Option<ModelName>,
    #[command(flatten)]
    drop: DropArgs,
    /// With --model: how exact the answer is for the model, as a share of it: 0.01 or 1%
    #[arg(long, value_name = "SHARE", default_value = "1%", allow_hyphen_values = true, value_parser = inputs::tolerance, requires = "model")]
    tolerance: f64,
    /// Velocity shocks instead of a clatter: a CSV file with the columns time_s and delta_v_m_s, in order of time
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = CLATTER)]
    shocks_file: Option<PathBuf>,
    /// Pulses instead of a clatter: a CSV file with the columns shape, amplitude_m_s2, duration_s and start_s
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = CLATTER, conflicts_with = "shocks_file")]
    pulses_file: Option<PathBuf>,
    /// Also give the half-sine of a shock table that does the same to the component, or that there is none; in SI units
    /// alone
    #[arg(long, requires = "omega")]
    equivalent_pulse: bool,
    /// What the shock table can do: its shortest and longest half-sine in ms, its highest acceleration in g, its
    /// largest velocity change in m/s
    #[arg(long, value_name = "MS:MS,G,M_S", default_value = "0.2:20,5000,20", allow_hyphen_values = true, value_parser = excitation::shock_table, requires = "equivalent_pulse")]
    shock_table: ShockTable,
    /// Also write the rule over W h0/v0 to this file, ending in .csv, .json or .svg
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target, conflicts_with_all = ["model", "shocks_file", "pulses_file"])]
    output: Option<Target>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

/// What stands in place of a clatter, and what says a clatter.
const FILES: [&str; 2] = ["shocks_file", "pulses_file"];
const CLATTER: [&str; 9] = ["q", "gyration_ratio", "gyration_m", "mass", "e", "at", "velocity", "height_gap", "model"];

/// How the mass lies.
#[derive(Debug, clap::Args)]
#[group(id = "inertia", multiple = false)]
struct Inertia {
    /// Inertia ratio (L² - ρ²)/(L² + ρ²), in (-1, 1]: 0.5 for evenly spread mass, 1 for all mass at the center
    #[arg(long, value_name = "Q", allow_hyphen_values = true, value_parser = inputs::inertia_ratio, conflicts_with = "model")]
    q: Option<f64>,
    /// Instead of q: ρ/L, radius of gyration over half-length, exact also where q is within rounding of 1
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = inputs::gyration_ratio, conflicts_with = "model")]
    gyration_ratio: Option<f64>,
    /// Instead of q, with --model: radius of gyration about the center of mass, in m; length/√12 for evenly spread mass
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = inputs::number, requires = "model")]
    gyration_m: Option<f64>,
    /// Instead of q: a mass M in any unit at position S, or spread evenly from S to T, in half-lengths from the middle;
    /// given once for each piece, like --mass=2@-1:1 --mass=1@0.5; symmetric unless with --model
    #[arg(long, value_name = "M@S[:T]", allow_hyphen_values = true, value_parser = inputs::mass)]
    mass: Vec<Mass>,
}

impl Inertia {
    /// The paper's bar.
    fn bar(&self, e: f64) -> Result<Bar, clatter::Error> {
        match (self.q, self.gyration_ratio) {
            (_, Some(k)) => Bar::from_gyration_ratio(k, e),
            (Some(q), None) => Bar::new(q, e),
            // clap requires one of the three.
            (None, None) => Bar::from_masses(2.0, &self.mass, e),
        }
    }
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Json, Kind::Svg])
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files {
            reads: self.shocks_file.iter().chain(&self.pulses_file).map(AsRef::as_ref).collect(),
            writes: self.output.iter().map(|target| target.path.as_path()).collect(),
        }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        if let Some(model) = self.model {
            return self.run_drop(model, streams);
        }
        let train = self.train()?;
        if let Some(target) = &self.output {
            train.write_rule(target)?;
        }
        match self.format {
            Format::Table => train.table(streams.out).map_err(Failure::Answer),
            Format::Json => streams.json(&train.answer()),
        }
    }

    fn run_drop(&self, model: ModelName, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let drop = self.drop_by(model)?;
        match self.format {
            Format::Table => drop.table(streams.out).map_err(Failure::Answer),
            Format::Json => streams.json(&drop.answer()),
        }
    }

    /// What clap requires unless there is a file.
    fn e(&self) -> f64 {
        self.e.unwrap_or(f64::NAN)
    }
    fn position(&self) -> f64 {
        self.at.unwrap_or(f64::NAN)
    }

    /// The component; none that is mounted rigidly.
    fn suspension(&self) -> Result<Option<Suspension>, Failure> {
        match self.omega {
            // Beyond, no motion of a drop can be told from rounding, and to search it would take for ever.
            Some(omega) if self.model.is_some() && !(1e-12..=1e12).contains(&omega) => {
                let (name, allowed) = ("natural frequency in rad/s", "in [1e-12, 1e12]");
                let reason = clatter::Error::Quantity { name, value: omega, allowed };
                Err(Failure::Flag { flag: "--omega", reason })
            }
            Some(omega) => Ok(Some(Suspension::new(omega, self.damping.ratio()?)?)),
            None if self.damping.is_given() => Err(Failure::Usage(
                "--damping and --q-factor go with --omega: a part that is mounted rigidly has neither",
            )),
            None => Ok(None),
        }
    }
}
