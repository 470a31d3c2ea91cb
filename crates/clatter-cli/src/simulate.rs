//! This module is `clatter simulate`: it follows one drop in time, by a model of the user's choice.

mod file;
mod table;

use clap::ValueHint;
use clatter_answer::simulate::{self, Answer, Question};
use clatter_flight::Stop;
use clatter_product::{Model, units::Quantity};

use crate::drop_args::{DropArgs, ExtraArgs, IN_SI, Setup};
use crate::inputs::{self, RowFormat};
use crate::one_drop::PartSetup;
use crate::output::{Files, Kind, Target};
use crate::quantities::{self, PerAxis, Piece, Place};
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
/// higher then. Quantities are numbers with their unit; heights and velocities are vertical, upward
/// positive, and positions run from -1 (end a) to 1 (end b).
///
/// With --width the body is a plate, followed by map, ballistic or compliant at small tilt: corner a touches
/// first, b is the one along its length, d along its width, c opposite. Its mass, center and places take two values,
/// along the length and along the width. A product file with a width is such a plate.
///
/// The table lists the strikes that matter, whose largest shock is at least 1 % of the largest of all,
/// and sums up the others; --all lists every one, as JSON and CSV do.
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
    group = clap::ArgGroup::new("followed").multiple(true),
    after_help = "\
Examples:
  clatter simulate --model=finite-tilt --length=140mm --gyration=40mm --e=0.3 --height=1m \\
      --tilt=5deg
  clatter simulate --model=compliant --contact-time=0.5ms --length=200mm --mass=200g@-1:1 \\
      --mass=100g@50mm --e=30% --speed=4m/s --tilt=5deg
  clatter simulate --model=compliant --contact-time=0.5ms --length=150mm --width=70mm \\
      --gyration=43mm,20mm --e=30% --height=1m --tilt=2deg --direction=30deg --at=0,0

Add --at=0 -o drop.svg for a picture, with the shocks of the middle. 'clatter simulate
--product=phone.toml --component=camera' takes the drop and the part from a product file.

Units: m, mm, cm, um, in, ft; s, ms, us; m/s, mm/s, cm/s, km/h, in/s, ft/s; m/s2 or m/s^2, gn; deg,
rad; Hz, kHz; kg, g, mg, lb, oz. The answer is given in the units that are typed, JSON and CSV in SI.

The motion ends at rest (proven, with bounds on what is left), bounced clear (without gravity, where
nothing brings the body back), at a limit, or, of a body of thickness, where it has turned over.
A contact that a limit cuts off is told as unfinished: what it does in all is not known."
)]
pub(crate) struct Args {
    /// Which physics to keep
    #[arg(long, value_parser = inputs::model(), required_unless_present = "product", group = "followed")]
    model: Option<Model>,
    #[command(flatten)]
    inertia: Inertia,
    /// Coefficient of restitution, in [0, 1]: rebound speed of an end over its approach speed, such as 0.3 or 30%
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = inputs::restitution)]
    e: Option<f64>,
    #[command(flatten)]
    drop: DropArgs,
    /// Angular velocity when end a touches; positive turns end b upward, so that the tilt grows [default: 0rad/s]
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = quantities::spin, conflicts_with = "spin_rad_s")]
    spin: Option<Quantity>,
    /// Follow the motion until this time after the first touch
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = quantities::until, conflicts_with = "time_limit_s")]
    until: Option<Quantity>,
    /// --spin in rad/s; of a plate WX,WY along its length and its width, corners b and d upward where positive; of a box WX,WY,WZ
    /// about its axes
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = quantities::numbers, help_heading = IN_SI, hide_short_help = true)]
    spin_rad_s: Option<PerAxis<f64>>,
    /// --until in s
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = inputs::time_limit_s, help_heading = IN_SI, hide_short_help = true)]
    time_limit_s: Option<f64>,
    /// Follow the motion for at most so many strikes [default: 100000, of a plate by map 1000]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = inputs::impact_limit)]
    impact_limit: Option<usize>,
    /// Also give the velocity shocks at this position, in [-1, 1]: -1 is end a, 0 the middle, 1 end b; or a length from
    /// the middle; X,Y on a plate, X,Y,Z in a box; may be given several times
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = quantities::place)]
    at: Vec<PerAxis<Place>>,
    /// List every strike in the table
    #[arg(long)]
    all: bool,
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
#[group(multiple = false)]
struct Inertia {
    /// Radius of gyration about the center of mass: length/√12 for evenly spread mass; it may exceed the half-length
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = quantities::gyration)]
    gyration: Option<PerAxis<Quantity>>,
    /// Instead of it: a mass M at position S, or spread evenly from S to T, in half-lengths from the middle or as
    /// lengths; given once for each piece, like --mass=200g@-1:1 --mass=100g@35mm
    #[arg(long, value_name = "M@S[:T]", allow_hyphen_values = true, value_parser = quantities::mass)]
    mass: Vec<Piece>,
    /// --gyration in m
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = quantities::gyration_m, help_heading = IN_SI, hide_short_help = true)]
    gyration_m: Option<PerAxis<Quantity>>,
}

impl Inertia {
    fn given(&self) -> Option<PerAxis<Quantity>> {
        self.gyration.or(self.gyration_m)
    }
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Json, Kind::Svg])
}

/// A drop and what came of it.
struct Drop<'a> {
    args: &'a Args,
    setup: Setup,
    /// Names of the requested places.
    called: Vec<String>,
    answer: Answer,
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files {
            reads: self.drop.product.iter().map(AsRef::as_ref).collect(),
            writes: self.output.iter().map(|target| target.path.as_path()).collect(),
        }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let setup = self.setup(streams)?;
        let (at, called) = self.places(&setup)?.into_iter().unzip();
        let mut question = Question::new(setup.drop, setup.model);
        (question.at, question.time_limit_s, question.impact_limit) = (at, self.time_limit_s(), self.impact_limit);
        let answer = simulate::answer(&question).map_err(|error| self.drop.failure(error, self.inertia.given()))?;
        let drop = Drop { args: self, setup, called, answer };
        if let Some(target) = &self.output {
            drop.write(target)?;
        }
        match self.format {
            RowFormat::Table => drop.table(streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => drop.csv(streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.json(&drop.answer)?,
        }
        for (kind, note) in &drop.setup.notes {
            streams.note(kind, note);
        }
        for warning in drop.warnings() {
            streams.note("warning", warning);
        }
        Ok(())
    }

    fn setup(&self, streams: &mut Streams<'_>) -> Result<Setup, Failure> {
        let file = self.drop.file(None, None, &self.files(), streams)?;
        let spin_rad_s = self.spin_rad_s.or(self.spin.map(|spin| PerAxis::Bar(spin.si)));
        let mut setup = self.drop.setup(ExtraArgs {
            model: self.model,
            e: self.e,
            gyration: self.inertia.given(),
            masses: &self.inertia.mass,
            is_flat: false,
            instant_contacts: false,
            spin_rad_s,
            first: None,
            file,
        })?;
        setup.shown.spin.unit = self.spin.and_then(|spin| spin.unit);
        setup.shown.time.unit = setup.shown.time.unit.or(self.until.and_then(|until| until.unit));
        if !setup.drop.own_contacts.is_none() {
            return Err(Failure::Usage(
                "'clatter simulate' takes a product whose contacts are alike, without `contacts` of their own; 'clatter respond' takes them",
            ));
        }
        if setup.drop.body.feet.take().is_some() {
            let alone = "its ends here are its feet; edges beyond them are not looked at, as 'clatter respond' does";
            setup.notes.push(("note", alone.to_owned()));
        }
        if setup.drop.exchanged().iter().any(|sign| *sign < 0.0) {
            let (point, lowest) = (setup.drop.point(), setup.drop.lowest());
            let turned = "touches first and is called a here: places are turned around";
            setup.notes.push(("note", format!("{point} {lowest} {turned}")));
        }
        Ok(setup)
    }

    /// Returns the typed places, or that of the part, in half-sides as seen from what touches first, and their names.
    fn places(&self, setup: &Setup) -> Result<Vec<([f64; 3], String)>, Failure> {
        let of_part = |part: &PartSetup| {
            let along = part.middle.at_m.into_iter().zip(setup.drop.sides());
            let units = part.units.into_iter().chain([None]).map(|unit| unit.or(setup.shown.length.unit));
            let named = part.middle.at_m.into_iter().zip(units).map(|(si, unit)| Place::Length(Quantity { si, unit }));
            (along.map(|(at_m, side)| 2.0 * at_m / side.m()).collect(), named.collect())
        };
        let typed = self.at.iter().map(|at| Ok((setup.relative(*at, [0.0; 2])?, at.values())));
        let of_part = setup.part.iter().filter(|_| self.at.is_empty()).map(|part| Ok(of_part(part)));
        let seen = |(along, named): (Vec<f64>, Vec<Place>)| {
            let (mut at, signs) = ([0.0; 3], setup.drop.exchanged());
            let names = named.into_iter().take(along.len()).zip(signs).map(|(place, sign)| place.turned(sign).said());
            let names = names.collect::<Vec<_>>().join(",");
            for ((at, sign), s) in at.iter_mut().zip(signs).zip(along) {
                *at = sign * s;
            }
            (at, names)
        };
        typed.chain(of_part).map(|place| place.map(seen)).collect()
    }

    fn time_limit_s(&self) -> Option<f64> {
        self.time_limit_s.or(self.until.map(|until| until.si))
    }
}

impl Drop<'_> {
    fn warnings(&self) -> Vec<String> {
        let (mut warnings, impacts) = (Vec::new(), &self.answer.impacts);
        if let Some((count, first)) = impacts.overlaps() {
            let touches = if count == 1 { "strike begins" } else { "strikes begin" };
            warnings.push(format!(
                "{count} {touches} while the other end still presses, the first is number {first}: \
                 the impulses of such strikes depend on the contact time"
            ));
        }
        match self.answer.stop {
            Stop::ImpactLimit { .. } => {
                let n = impacts.train().count();
                warnings.push(format!("stopped after {n} impacts, more would follow; --impact-limit=N follows more"));
            }
            Stop::TimeLimit { time_s } if self.args.time_limit_s().is_none_or(|limit| time_s < limit) => {
                let time = self.setup.shown.time.said(time_s);
                warnings.push(format!("left at {time}, where the body neither rests nor strikes again in sight"));
            }
            Stop::EnergyLimit { .. } => {
                warnings.push("left where the energy of the body is not what it should be".to_owned());
            }
            _ => {}
        }
        let mut unfinished = impacts.iter().filter(|impact| impact.unfinished).map(|impact| impact.number);
        if let Some(first) = unfinished.next() {
            let count = 1 + unfinished.count();
            let contacts = if count == 1 { "contact is" } else { "contacts are" };
            warnings.push(format!(
                "{count} {contacts} cut off there, the first is that of number {first}: what it does in all is not known"
            ));
        }
        warnings
    }
}
