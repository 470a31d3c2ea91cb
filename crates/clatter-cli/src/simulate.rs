//! `clatter simulate`: one drop in time, by a model of the user's choice.

mod answer;
mod file;
mod table;

use clap::ValueHint;
use clatter::Mass;
use clatter_flight::{Contact, ContactFlight, Flight, Model, Press, Scene, Stop, Strike};

use crate::drop_args::DropArgs;
use crate::inputs::{self, ModelName, RowFormat};
use crate::numbers::figures;
use crate::output::{Files, Kind, Target};
use crate::{Failure, Streams};

/// Follow one drop in time: its strikes, how hard they are, and how it comes to rest
///
/// Four models of the same drop, each the cheapest that keeps its physics; run two to see what it
/// matters:
///
///   map          small tilt, no gravity, instant impacts: the paper's bar
///   ballistic    with gravity: what bounced clear comes back, until it lies still
///   finite-tilt  with gravity and the exact geometry of any tilt
///   compliant    as finite-tilt, and every contact takes time: pulses, that may overlap; --contact-law
///                says what the ground does meanwhile
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
nothing brings the body back), at a limit, or, of a body of thickness, where it has turned over.
A contact that a limit cuts off is told as unfinished: what it does in all is not known."
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
    /// Angular velocity when end a touches, in rad/s; positive turns end b upward
    #[arg(long, value_name = "W", default_value = "0", allow_hyphen_values = true, value_parser = inputs::number)]
    spin_rad_s: f64,
    /// Follow the motion until this time after the first touch, in s
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::time_limit_s)]
    time_limit_s: Option<f64>,
    /// Follow the motion for at most so many strikes
    #[arg(long, value_name = "N", default_value_t = IMPACTS, allow_hyphen_values = true, value_parser = inputs::impact_limit)]
    impact_limit: usize,
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

/// What a model says of a scene.
enum Motion {
    Instant(Model, Flight),
    Contacts(Contact, Box<ContactFlight>),
}

impl Motion {
    fn flight(&self) -> &Flight {
        match self {
            Self::Instant(_, flight) => flight,
            Self::Contacts(_, contacts) => &contacts.flight,
        }
    }
    /// How long each strike presses; of instant strikes nothing.
    fn presses(&self) -> &[Press] {
        match self {
            Self::Instant(..) => &[],
            Self::Contacts(_, contacts) => &contacts.presses,
        }
    }
}

/// A drop and what came of it.
struct Drop<'a> {
    args: &'a Args,
    /// Position of the center of mass on the body.
    center_of_mass: f64,
    scene: Scene,
    motion: Motion,
}

/// Impacts followed unless more are asked for.
const IMPACTS: usize = 100_000;

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files { reads: Vec::new(), writes: self.output.iter().map(|target| target.path.as_path()).collect() }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let drop = self.drop()?;
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

    fn drop(&self) -> Result<Drop<'_>, Failure> {
        self.drop.check(self.model)?;
        let (center_of_mass, body) = self.drop.body(self.inertia.gyration_m, &self.inertia.mass, self.e)?;
        let scene = self.drop.scene(body, self.e)?;
        let scene = scene.with_spin(self.spin_rad_s).map_err(Failure::flag("--spin-rad-s"))?;
        let scene = scene.with_impact_limit(self.impact_limit)?;
        let scene = self.time_limit_s.map_or(Ok(scene), |limit| scene.with_time_limit_s(limit))?;
        let motion = self.motion(&scene)?;
        Ok(Drop { args: self, center_of_mass, scene, motion })
    }

    fn motion(&self, scene: &Scene) -> Result<Motion, Failure> {
        let model = match (self.model, self.drop.contact_time_s) {
            (ModelName::Compliant, time) => {
                // clap requires the time
                let contact = Contact::new(self.drop.contact_law(), scene.e(), time.unwrap_or(f64::NAN))?;
                let contacts = scene.contacts(&contact).map_err(Failure::contacts)?;
                return Ok(Motion::Contacts(contact, Box::new(contacts)));
            }
            (_, Some(_)) => return Err(Failure::Usage("--contact-time-s goes with --model=compliant alone")),
            (ModelName::Map, None) => Model::Map,
            (ModelName::Ballistic, None) => Model::Ballistic,
            (ModelName::FiniteTilt, None) => Model::FiniteTilt,
        };
        Ok(Motion::Instant(model, scene.simulate(model)))
    }
}

impl Drop<'_> {
    /// Velocity shocks at the positions asked for, of each strike.
    fn shocks(&self, strike: &Strike) -> impl Iterator<Item = f64> {
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

    /// When the contact of a strike ends, where contacts take time; infinite where the end stays down.
    fn until_s(&self, strike: usize) -> Option<f64> {
        self.motion.presses().get(strike).map(|press| press.until_s)
    }

    /// Whether a limit has cut off the contact of a strike, so that its shock is not known.
    fn is_unfinished(&self, strike: usize) -> bool {
        let cut = !matches!(self.motion.flight().stop, Stop::AtRest { .. } | Stop::BouncedClear { .. });
        cut && self.until_s(strike).is_some_and(f64::is_infinite)
    }

    /// How many strikes begin while the other end still presses, and the number of the first of them.
    fn overlaps(&self) -> Option<(usize, u64)> {
        let (mut parted_s, mut found) = (f64::NEG_INFINITY, None);
        for (press, strike) in self.motion.presses().iter().zip(&self.motion.flight().strikes) {
            if press.from_s < parted_s {
                found = Some(found.map_or((1, strike.number), |(count, first)| (count + 1, first)));
            }
            parted_s = parted_s.max(press.until_s);
        }
        found
    }

    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if let Some((count, first)) = self.overlaps() {
            let touches = if count == 1 { "strike begins" } else { "strikes begin" };
            warnings.push(format!(
                "{count} {touches} while the other end still presses, the first is number {first}: \
                 the impulses of such strikes depend on the contact time"
            ));
        }
        let flight = self.motion.flight();
        match flight.stop {
            Stop::ImpactLimit { .. } => {
                let n = flight.strikes.len();
                warnings.push(format!("stopped after {n} impacts, more would follow; --impact-limit=N follows more"));
            }
            Stop::TimeLimit { time_s } if self.args.time_limit_s.is_none_or(|limit| time_s < limit) => {
                let time = figures(time_s);
                warnings.push(format!("left at {time} s, where the body neither rests nor strikes again in sight"));
            }
            _ => {}
        }
        let unfinished: Vec<_> = (0..flight.strikes.len()).filter(|&i| self.is_unfinished(i)).collect();
        if let [first, ..] = unfinished[..] {
            let (count, first) = (unfinished.len(), flight.strikes[first].number);
            let contacts = if count == 1 { "contact is" } else { "contacts are" };
            warnings.push(format!(
                "{count} {contacts} cut off there, the first is that of number {first}: what it does in all is not known"
            ));
        }
        warnings
    }
}
