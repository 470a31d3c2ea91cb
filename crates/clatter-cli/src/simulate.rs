//! `clatter simulate`: one drop in time, by a model of the user's choice.

mod answer;
mod file;
mod table;

use clap::{ValueEnum, ValueHint};
use clatter::Mass;
use clatter::flight::{Body, CompliantFlight, Contact, Flight, Model, Pulse, Scene, Stop};

use crate::inputs::{self, RowFormat};
use crate::numbers::figures;
use crate::output::{Kind, Target};
use crate::{Failure, Streams};

/// Follow one drop in time: its strikes, how hard they are, and how it comes to rest
///
/// Four models of the same drop, each the cheapest that keeps its physics; run two to see what it matters:
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
///          also the forces on the ends over the mass, and accelerations. Each strike is two rows, just
///          before and just after, and straight lines through all rows follow the motion
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
    #[arg(long, value_enum)]
    model: ModelName,
    /// Length of the body from end to end, 2L, in m
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = inputs::length_m)]
    length_m: f64,
    #[command(flatten)]
    inertia: Inertia,
    /// Where the center of mass lies, between -1 (end a) and 1 (end b); goes with --gyration-m
    #[arg(long, value_name = "S", default_value = "0", allow_hyphen_values = true, value_parser = inputs::center_of_mass, conflicts_with = "mass")]
    center_of_mass: f64,
    /// Thickness of the body, in m, at most its length: at a tilt it stands on a corner, half of it below the line through the
    /// center of mass; for finite-tilt, small tilts do not feel it
    #[arg(long, value_name = "M", default_value = "0", allow_hyphen_values = true, value_parser = inputs::number)]
    thickness_m: f64,
    /// Coefficient of restitution, in [0, 1]: rebound speed of an end over its approach speed
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = inputs::restitution)]
    e: f64,
    #[command(flatten)]
    fall: Fall,
    /// Tilt when end a touches, in degrees, below 90; 0 for a flat drop, in which end a counts as the first
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = inputs::tilt_deg)]
    tilt_deg: f64,
    /// Acceleration of gravity, in m/s²; the model map leaves it out
    #[arg(long, value_name = "G", default_value = "9.80665", allow_hyphen_values = true, value_parser = inputs::gravity_m_s2)]
    gravity_m_s2: f64,
    /// Angular velocity when end a touches, in rad/s; positive turns end b upward
    #[arg(long, value_name = "W", default_value = "0", allow_hyphen_values = true, value_parser = inputs::number)]
    spin_rad_s: f64,
    /// For compliant: how long a lone contact presses, in s
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::contact_time_s, required_if_eq("model", "compliant"))]
    contact_time_s: Option<f64>,
    /// Follow the motion until this time after the first touch, in s
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::time_limit_s)]
    time_limit_s: Option<f64>,
    /// Follow the motion for at most so many strikes
    #[arg(long, value_name = "N", default_value = "100000", allow_hyphen_values = true, value_parser = inputs::impact_limit)]
    impact_limit: usize,
    /// Also give the velocity shocks at this position, in [-1, 1]; may be given several times
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::position)]
    at: Vec<f64>,
    /// Also write the whole motion to a file, ending in .csv, .json or .svg; what was there is replaced once the new file is
    /// whole
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
    /// Radius of gyration about the center of mass, in m: length/√12 for evenly spread mass; it may exceed the half-length
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = inputs::number)]
    gyration_m: Option<f64>,
    /// Instead of it: a mass M in any unit at position S, or spread evenly from S to T, in half-lengths from the middle;
    /// given once for each piece, like --mass=2@-1:1 --mass=1@0.5
    #[arg(long, value_name = "M@S[:T]", allow_hyphen_values = true, value_parser = inputs::mass)]
    mass: Vec<Mass>,
}

/// How fast it comes down.
#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct Fall {
    /// Speed of the center of mass when end a touches, in m/s
    #[arg(long, value_name = "V", allow_hyphen_values = true, value_parser = inputs::speed_m_s)]
    speed_m_s: Option<f64>,
    /// Instead of the speed: height of the lower end before it is let go, in m; needs gravity
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = inputs::height_m)]
    height_m: Option<f64>,
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Json, Kind::Svg])
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ModelName {
    /// Small tilt, no gravity, instant impacts
    Map,
    /// Small tilt, gravity, instant impacts
    Ballistic,
    /// Any tilt, gravity, instant impacts
    FiniteTilt,
    /// Any tilt, gravity, contacts that take time
    Compliant,
}

impl ModelName {
    fn name(self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::Ballistic => "ballistic",
            Self::FiniteTilt => "finite-tilt",
            Self::Compliant => "compliant",
        }
    }
}

/// What a model says of a scene.
enum Motion {
    Instant(Model, Flight),
    /// With the time that a lone contact takes, in s.
    Compliant(f64, Box<CompliantFlight>),
}

impl Motion {
    fn flight(&self) -> &Flight {
        match self {
            Self::Instant(_, flight) => flight,
            Self::Compliant(_, compliant) => &compliant.flight,
        }
    }
    fn pulses(&self) -> &[Pulse] {
        match self {
            Self::Instant(..) => &[],
            Self::Compliant(_, compliant) => &compliant.pulses,
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

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let (center_of_mass, body) = self.body()?;
        let scene = self.scene(body)?;
        let motion = self.motion(&scene)?;
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

    /// The body, and where its center of mass lies.
    fn body(&self) -> Result<(f64, Body), Failure> {
        let half = 0.5 * self.length_m;
        let [(center, center_flag), (gyration, gyration_flag)] = if let Some(gyration) = self.inertia.gyration_m {
            [(self.center_of_mass, "--center-of-mass"), (gyration, "--gyration-m")]
        } else {
            let bar = inputs::bar_of(&self.inertia.mass, self.e)?;
            [bar.center_of_mass(), half * bar.gyration_ratio()].map(|x| (x, "--mass"))
        };
        let (a, b) = (half * (1.0 + center), half * (1.0 - center));
        Body::off_center(a, b, 0.0).map_err(Failure::flag(center_flag))?;
        let body = Body::off_center(a, b, gyration).map_err(Failure::flag(gyration_flag))?;
        let body = body.with_thickness(self.thickness_m).map_err(Failure::flag("--thickness-m"))?;
        Ok((center, body))
    }

    fn scene(&self, body: Body) -> Result<Scene, Failure> {
        let (e, tilt, gravity) = (self.e, self.tilt_deg, self.gravity_m_s2);
        let scene = match (self.fall.speed_m_s, self.fall.height_m) {
            (Some(speed), _) => Scene::new(body, e, speed, tilt, gravity)?,
            (None, Some(_)) if gravity == 0.0 => {
                return Err(Failure::Usage("--height-m needs gravity: give --speed-m-s, or a --gravity-m-s2 above 0"));
            }
            // The group requires one of the two.
            (None, height) => Scene::from_height(body, e, height.unwrap_or(f64::NAN), tilt, gravity)
                .map_err(Failure::flag("--height-m"))?,
        };
        let scene = scene.with_spin(self.spin_rad_s).map_err(Failure::flag("--spin-rad-s"))?;
        let scene = scene.with_impact_limit(self.impact_limit)?;
        Ok(self.time_limit_s.map_or(Ok(scene), |limit| scene.with_time_limit_s(limit))?)
    }

    fn motion(&self, scene: &Scene) -> Result<Motion, Failure> {
        let model = match (self.model, self.contact_time_s) {
            (ModelName::Compliant, contact_time) => {
                let time = contact_time.unwrap_or(f64::NAN); // clap requires it
                Contact::new(self.e, time).map_err(Failure::flag("--e"))?;
                let body = scene.body();
                let flag = match () {
                    () if body.thickness_m() > 0.0 => "--thickness-m",
                    () if body.gyration_m() < 0.05 * body.length_m() => "--gyration-m",
                    () => "--contact-time-s",
                };
                let compliant = scene.simulate_compliant(time).map_err(Failure::flag(flag))?;
                return Ok(Motion::Compliant(time, Box::new(compliant)));
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
            Stop::TimeLimit { time_s } if self.args.time_limit_s.is_none_or(|limit| time_s < limit) => {
                let time = figures(time_s);
                warnings.push(format!("left at {time} s, where the body neither rests nor strikes again in sight"));
            }
            _ => {}
        }
        warnings
    }
}
