//! This module is `clatter respond`: it shows the effect of one clatter on one component.

mod drop;
mod limits;
mod peaks;
mod rule;
mod train;

use std::f64::consts::TAU;
use std::path::PathBuf;

use clap::ValueHint;
use clatter::Bar;
use clatter_assess::Accuracy;
use clatter_product::{Axis, Model, OwnContact, Slip, slip, units::Quantity};
use clatter_shock::{DampingRatio, ShockTable, Stop, Suspension};

use crate::drop_args::{DropArgs, IN_SI};
use crate::inputs::{self, DampingArgs, EndName, Format, StopArgs};
use crate::one_drop::Worst;
use crate::output::{Files, Kind, Target};
use crate::quantities::{self, PerAxis, Piece, Place};
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
///   --model         a drop by any of the models of `clatter simulate`: with gravity, real tilt, an
///                   off-center mass, contacts that take time; W is then in rad/s. It is
///                   answered as `clatter assess` answers it, to the --tolerance, and followed until
///                   nothing later counts: limits of time and number are options of
///                   `clatter simulate` alone. Without --omega the part is mounted rigidly, and the
///                   answer is what its place goes through. With --width, by compliant, the body is
///                   a plate: --gyration, --center-of-mass and --at take two values
///   --product       the drop and the --component of a product file, each range at one value, which is
///                   told; options given beside it count instead. What the drop asks of each limit of
///                   the part is told as `clatter assess` tells it, at the place of the part that asks
///                   most. With --worst the drop is that of all ranges that asks most
///   --shocks-file   velocity shocks from a file in SI units, of any number, with the columns time_s
///                   and delta_v_m_s
///   --pulses-file   pulses, with the columns shape, amplitude_m_s2, duration_s and start_s; shapes
///                   as in `clatter spectrum --help`; they may overlap
///
/// --equivalent-pulse names the half-sine of a shock table that does the same to the component, in
/// acceleration and in relative displacement to 1 %, or says that there is none; and the least service
/// condition of JESD22-B110 whose pulse covers the drop: no smaller acceleration and displacement of the
/// component. For that everything has to be in SI units, --velocity and --height-gap too.
#[derive(Debug, clap::Args)]
#[command(
    verbatim_doc_comment,
    group = clap::ArgGroup::new("followed").multiple(true),
    after_help = "\
Examples:
  clatter respond --q=0.73 --e=0.2 --at=1 --omega=3               a part at the end that strikes second
  clatter respond --q=0.73 --e=0.2 --at=0 --omega=3 --damping=0   in the middle, without damping
  clatter respond --q=0.5 --e=0.3 --at=1 --frequency=180Hz \\
      --velocity=-4.85m/s,-4.85m/s --height-gap=5mm
                                    a board mode of 180 Hz in a phone dropped from 1.2 m, all in SI
  clatter respond --q=0.73 --e=0.2 --at=1 --omega=3 -o rule.svg   the three-way rule, drawn
  clatter respond --model=finite-tilt --length=140mm --gyration=40mm --e=0.3 --height=1.2m \\
      --tilt=5deg --at=70mm --frequency=180Hz --equivalent-pulse   the same board, with gravity
  clatter respond --model=compliant --contact-time=0.4ms --length=140mm --gyration=40mm \\
      --e=30% --height=1.2m --tilt=5deg --at=35mm                  a part that is mounted rigidly
  clatter respond --model=compliant --contact-time=0.4ms --length=150mm --width=70mm \\
      --gyration=43mm,20mm --e=30% --height=1m --tilt=2deg --direction=30deg \\
      --at=35mm,0mm --frequency=180Hz                              a part on a plate
  clatter respond --shocks-file=shocks.csv --omega=1131

With a product file: clatter respond --product=phone.toml --component=camera --worst answers its worst
drop again, --worst=rattle-space that of one limit, --tilt=2deg --first=b in place of --worst one of the drops of a bar or a plate.

'clatter --help' tells what q, e and the units are."
)]
pub(crate) struct Args {
    #[command(flatten)]
    inertia: Inertia,
    /// Coefficient of restitution, in [0, 1]: rebound speed of an end over its approach speed, such as 0.3 or 30%
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = inputs::restitution, required_unless_present_any = GIVEN)]
    e: Option<f64>,
    /// Position of the component, in [-1, 1]: -1 is end a, which strikes first, 0 the middle, 1 end b; or with --model a
    /// length from the middle
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = quantities::place, required_unless_present_any = GIVEN)]
    at: Option<PerAxis<Place>>,
    /// Natural angular frequency of the component (2π times its frequency), in v0/h0; in rad/s with --model or a file;
    /// with --model alone it may be left out
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = inputs::omega, required_unless_present_any = ["model", "product", "frequency", "case"])]
    omega: Option<f64>,
    /// Instead of --omega, with --model or a file: natural frequency of the component, such as 180Hz
    #[arg(long, value_name = "FREQUENCY", allow_hyphen_values = true, value_parser = quantities::frequency, conflicts_with = "omega")]
    frequency: Option<Quantity>,
    /// Where the part of a box is, in m from the middle along its axes
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = inputs::triple, requires = "followed", conflicts_with = "at")]
    at_m: Option<[f64; 3]>,
    /// Along which axis of the box the part moves, or, mounted rigidly, is shaken: any is the magnitude [default: z]
    #[arg(long, value_parser = inputs::axis_of_box(), requires = "followed")]
    axis: Option<Axis>,
    /// Angular velocity at the first touch in rad/s, of a bar one value, positive where the tilt grows; of a plate WX,WY along its length
    /// and its width, corners b and d upward where positive, as they are tilted; of a box WX,WY,WZ about its axes
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = quantities::numbers, requires = "followed", help_heading = IN_SI, hide_short_help = true)]
    spin_rad_s: Option<PerAxis<f64>>,
    /// Feet which are the ends or corners of the body: how far the product goes on beyond them along its length and along its width, 0 of
    /// a bar, and how far they stand out; places beyond them are then allowed, and edges there press as the feet do without a contact of
    /// their own, but by instant impacts
    #[arg(long, value_name = "X,Y,HEIGHT", value_parser = inputs::feet, requires = "followed", help_heading = IN_SI, hide_short_help = true)]
    feet_m: Option<[f64; 3]>,
    /// A contact of its own at an end of a bar or a corner of a plate, of a box both corners that are seen there from above, of --model=compliant and --contact-law=hysteretic: a to d, its
    /// restitution and how long a lone one takes in s; once for each
    #[arg(long, value_name = "AT,E,TIME", value_parser = inputs::own_contact, requires = "followed", conflicts_with = "product", help_heading = IN_SI, hide_short_help = true)]
    contact: Vec<(usize, OwnContact)>,
    #[command(flatten)]
    damping: DampingArgs,
    #[command(flatten)]
    stop: StopArgs,
    /// Velocities of ends a and b at first contact, upward positive; VA is negative: end a strikes; in v0, or with their
    /// units, as the height gap is then
    #[arg(long, value_name = "VA,VB", default_value = "-1,-1", allow_hyphen_values = true, value_parser = quantities::velocity, conflicts_with = "followed")]
    velocity: [Quantity; 2],
    /// Height of end b when end a first touches; 0 for a flat drop, whose impacts come all at once
    #[arg(long, value_name = "H0", default_value = "1", allow_hyphen_values = true, value_parser = quantities::height_gap, conflicts_with = "followed")]
    height_gap: Quantity,
    /// Follow a drop by this model; with --product alone by the one with the most physics that the file allows
    #[arg(long, value_parser = inputs::model(), group = "followed")]
    model: Option<Model>,
    #[command(flatten)]
    drop: DropArgs,
    /// With --model: land flat, both ends as one, instant impacts that are closer than any contact lasts; in place of a tilt
    #[arg(long, requires = "followed", conflicts_with_all = ["tilt", "tilt_deg"])]
    flat: bool,
    /// With --product: of all its ranges the drop that asks most of the --component, found as by 'clatter assess'; of its
    /// tightest limit, or of this one
    #[arg(long, value_name = "LIMIT", value_enum, num_args = 0..=1, require_equals = true, default_missing_value = "tightest", requires = "product", conflicts_with_all = OF_ONE_DROP)]
    worst: Option<Worst>,
    /// The end that touches first [default: that of the product file, else a]
    #[arg(long, value_name = "END", value_enum, requires = "followed")]
    first: Option<EndName>,
    /// With --model: how exact the answer is for the model, as a share of it: 0.01 or 1%
    #[arg(long, value_name = "SHARE", default_value = "1%", allow_hyphen_values = true, value_parser = inputs::tolerance, requires = "followed")]
    tolerance: f64,
    /// One drop with its part as JSON, as `clatter assess` writes it (`worst_case.drop`): a file, or - for standard input
    #[arg(long = "drop", value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = CLATTER, conflicts_with_all = ["shocks_file", "pulses_file", "output", "omega", "frequency", "damping", "q_factor", "stop", "stop_gap_m", "equivalent_pulse", "product", "worst"])]
    case: Option<PathBuf>,
    /// Velocity shocks instead of a clatter: a table with the columns time_s and delta_v_m_s, in order of time
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = CLATTER)]
    shocks_file: Option<PathBuf>,
    /// Pulses instead of a clatter: a table with the columns shape, amplitude_m_s2, duration_s and start_s
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = CLATTER, conflicts_with = "shocks_file")]
    pulses_file: Option<PathBuf>,
    /// Also give the half-sine of a shock table that does the same to the component, or that there is none; in SI units
    /// alone
    #[arg(long)]
    equivalent_pulse: bool,
    /// What the shock table can do: its shortest and longest half-sine, its highest acceleration, its largest velocity
    /// change; in ms, gn and m/s where no unit is given
    #[arg(long, value_name = "TIME:TIME,ACCELERATION,VELOCITY", default_value = "0.2ms:20ms,5000gn,20m/s", allow_hyphen_values = true, value_parser = excitation::shock_table, requires = "equivalent_pulse")]
    shock_table: ShockTable,
    /// Also write the rule over W h0/v0 to this file, ending in .csv, .json or .svg
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target, conflicts_with_all = ["shocks_file", "pulses_file"])]
    output: Option<Target>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

/// The arguments that replace a clatter, and those that describe one.
const GIVEN: [&str; 4] = ["shocks_file", "pulses_file", "followed", "case"];
const CLATTER: [&str; 10] =
    ["q", "gyration_ratio", "gyration", "gyration_m", "mass", "e", "at", "velocity", "height_gap", "followed"];

/// The arguments that describe a drop, except those of a product file.
const OF_ONE_DROP: [&str; 41] = [
    "stop",
    "stop_gap_m",
    "stop_contact_time_s",
    "stop_restitution",
    "at_m",
    "axis",
    "feet_m",
    "flat",
    "orientation",
    "center_of_mass_m",
    "spin_rad_s",
    "first",
    "at",
    "e",
    "omega",
    "frequency",
    "damping",
    "q_factor",
    "gyration",
    "gyration_m",
    "mass",
    "length",
    "length_m",
    "center_of_mass",
    "thickness",
    "thickness_m",
    "speed",
    "speed_m_s",
    "height",
    "height_m",
    "tilt",
    "tilt_deg",
    "direction",
    "direction_deg",
    "product_of_inertia_m2",
    "gravity",
    "gravity_m_s2",
    "contact_time",
    "contact_time_s",
    "contact_law",
    "friction",
];

/// How the mass lies.
#[derive(Debug, clap::Args)]
#[group(id = "inertia", multiple = false)]
struct Inertia {
    /// Inertia ratio (L² - ρ²)/(L² + ρ²), in (-1, 1]: 0.5 for evenly spread mass, 1 for all mass at the center
    #[arg(long, value_name = "Q", allow_hyphen_values = true, value_parser = inputs::inertia_ratio, conflicts_with = "followed")]
    q: Option<f64>,
    /// Instead of q: ρ/L, radius of gyration over half-length, exact also where q is within rounding of 1
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = inputs::gyration_ratio, conflicts_with = "followed")]
    gyration_ratio: Option<f64>,
    /// Instead of q, with --model: radius of gyration about the center of mass; length/√12 for evenly spread mass
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = quantities::gyration, requires = "followed")]
    gyration: Option<PerAxis<Quantity>>,
    /// Instead of q: a mass M at position S, or spread evenly from S to T, in half-lengths from the middle, with --model
    /// also as lengths; given once for each piece, like --mass=2@-1:1 --mass=1@0.5; symmetric unless with --model
    #[arg(long, value_name = "M@S[:T]", allow_hyphen_values = true, value_parser = quantities::mass)]
    mass: Vec<Piece>,
    /// --gyration in m
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = quantities::gyration_m, requires = "followed", help_heading = IN_SI, hide_short_help = true)]
    gyration_m: Option<PerAxis<Quantity>>,
}

impl Inertia {
    fn given(&self) -> Option<PerAxis<Quantity>> {
        self.gyration.or(self.gyration_m)
    }
    /// Makes the paper's bar.
    fn bar(&self, e: f64) -> Result<Bar, Failure> {
        Ok(match (self.q, self.gyration_ratio, &self.mass[..]) {
            (_, Some(k), _) => Bar::from_gyration_ratio(k, e)?,
            (Some(q), None, _) => Bar::new(q, e)?,
            (None, None, []) => {
                return Err(Failure::Usage(
                    "how the mass lies is missing: --q=Q, --gyration-ratio=K or --mass=M@S; or --model or --product for a drop with gravity",
                ));
            }
            (None, None, pieces) => *Bar::from_masses(2.0, &quantities::masses(pieces, None)?, e)?.symmetric()?,
        })
    }
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Json, Kind::Svg])
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files {
            reads: self
                .shocks_file
                .iter()
                .chain(&self.pulses_file)
                .chain(&self.case)
                .chain(&self.drop.product)
                .map(AsRef::as_ref)
                .collect(),
            writes: self.output.iter().map(|target| target.path.as_path()).collect(),
        }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        if self.output.is_some() && (self.model.is_some() || self.drop.product.is_some()) {
            return Err(Failure::Usage(
                "-o writes the rule over W h0/v0 of a bar from --q and --e: --output cannot be used with --model or --product",
            ));
        }
        if let Some(path) = &self.case {
            return self.run_case(path, streams);
        }
        let accuracy = Accuracy { tolerance: self.tolerance, model: self.model, ..Accuracy::default() };
        let worst = self.worst.map(|of| (of, accuracy));
        let file = self.drop.file(self.first.map(Into::into), worst, &self.files(), streams)?;
        if self.model.is_some() || file.is_some() {
            return self.run_drop(file, streams);
        }
        let train = self.train()?;
        if let Some(target) = &self.output {
            train.write_rule(target)?;
        }
        match self.format {
            Format::Table => train.table(streams.out).map_err(Failure::Answer),
            Format::Json => streams.json(&train.answer()),
        }?;
        let masses = self.inertia.mass.iter().flat_map(|piece| piece.slips(1.0));
        self.warn(masses, streams);
        Ok(())
    }

    /// Warns of values that no part has, and of these.
    fn warn(&self, others: impl Iterator<Item = Slip>, streams: &mut Streams<'_>) {
        let frequency = self.frequency.and_then(|frequency| slip("natural_frequency", &frequency));
        for slip in others.chain(self.damping.slip()).chain(frequency) {
            streams.note("warning", slip);
        }
    }

    /// Returns e, which clap requires unless there is a file.
    fn e(&self) -> f64 {
        self.e.unwrap_or(f64::NAN)
    }
    /// Returns the place on a bar.
    fn bar_at(&self) -> Result<Option<Place>, Failure> {
        self.at.map(|at| at.of_bar("--at")).transpose()
    }
    /// Returns the position on the paper's bar.
    fn position(&self) -> Result<Option<f64>, Failure> {
        self.bar_at()?.map(|at| at.relative("--at", None)).transpose()
    }
    /// Returns whether the numbers of the paper's bar have units; refuses them where only some have.
    fn has_units(&self) -> Result<bool, Failure> {
        let [a, b] = self.velocity;
        let typed = [a, b, self.height_gap].map(|quantity| quantity.unit.is_some());
        if typed == [true; 3] || typed == [false; 3] {
            return Ok(typed[0]);
        }
        Err(Failure::Usage(
            "--velocity and --height-gap go together with units or without: --velocity=-4m/s,-4m/s --height-gap=5mm",
        ))
    }
    /// Returns the natural angular frequency that was given.
    fn omega(&self) -> Option<f64> {
        self.omega.or(self.frequency.map(|frequency| TAU * frequency.si))
    }

    /// Makes the failure of a question without an answer; for a natural frequency with the option that gives it.
    fn of_omega(&self, error: clatter_answer::Error) -> Failure {
        match error {
            clatter_answer::Error::Quantity { name, value, allowed } => {
                let reason = clatter::Error::Quantity { name, value, allowed };
                Failure::Flag { flag: if self.frequency.is_some() { "--frequency" } else { "--omega" }, reason }
            }
            error => error.into(),
        }
    }

    /// Returns the suspension of the component in a drop, which replaces that of a product file; none where it is mounted rigidly.
    fn suspension(
        &self,
        of_file: Option<(Quantity, DampingRatio)>,
        stop_of_file: Option<Stop>,
    ) -> Result<Option<Suspension>, Failure> {
        let stop = self.stop.given()?;
        let damping =
            || self.damping.given().map_or_else(|| of_file.map_or_else(|| self.damping.ratio(), |(_, z)| Ok(z)), Ok);
        match self.omega().or(of_file.map(|(frequency, _)| TAU * frequency.si)) {
            Some(omega) => {
                let free = Suspension::new(omega, damping()?)?;
                Ok(Some(stop.or(stop_of_file).map_or(free, |stop| free.with_stop(stop))))
            }
            None if stop.is_some() => Err(Failure::Usage(
                "--stop goes with --omega or --frequency: a part that is mounted rigidly reaches none",
            )),
            None if self.damping.is_given() => Err(Failure::Usage(
                "--damping and --q-factor go with --omega or --frequency: a part that is mounted rigidly has neither",
            )),
            None if self.equivalent_pulse => Err(Failure::Usage(
                "--equivalent-pulse needs --omega <W> or --frequency: it is that of a part on a suspension",
            )),
            None => Ok(None),
        }
    }
}

/// Rounds a number to six digits.
fn six(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, Command};

    use super::*;

    /// The worst drop of a product has all of its inputs: none that is typed beside it would count.
    #[test]
    fn no_input_of_a_drop_goes_with_the_worst() {
        let mut command = Args::augment_args(Command::new("respond"));
        command.build();
        let of = |id: &str| command.get_arguments().find(|arg| arg.get_id() == id).expect("an argument");
        let refuses = |one: &str, other: &str| {
            let conflicts =
                |one, other| command.get_arg_conflicts_with(of(one)).iter().any(|arg| arg.get_id() == other);
            conflicts(one, other) || conflicts(other, one)
        };
        let beside =
            ["product", "component", "worst", "tolerance", "model", "format", "equivalent_pulse", "shock_table"];
        for id in command.get_arguments().map(|arg| arg.get_id().as_str()) {
            let is_refused = refuses(id, "worst") || refuses(id, "product");
            assert!(is_refused || beside.contains(&id) || ["help", "output"].contains(&id), "--worst takes --{id}");
        }
    }
}
