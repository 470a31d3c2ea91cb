//! This module reads the arguments that several commands share.
//!
//! Every value is checked by the type that it becomes, so a range is written down once, in the model.

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clatter::{Axis, Bar, End, Error, Mass, Plate, PlateStart, Start};
pub(crate) use clatter_answer::letter;
use clatter_assess::Accuracy;
use clatter_flight::{Contact, ContactLaw, Profile, Scene};
use clatter_product::{
    Model, OwnContact, Slip, Stops,
    units::{Quantity, SHARE},
};
use clatter_shock::{DampingRatio, Stop};

use crate::Failure;
use crate::drop_args::IN_SI;
use crate::numbers::given;
use crate::quantities::{self, Piece, plain_or_typed};
use crate::text::visible;

/// The meaning of the numbers: part of the long help of the command and of each of its models.
pub(crate) const PRIMER: &str = "\
The bar. Seen from the side, a flat body is a rigid bar with ends a and b that
strike the ground; end a strikes first. Positions on it run from -1 (end a)
through 0 (the center) to 1 (end b). Two numbers decide everything:

  e  coefficient of restitution: the speed at which an end leaves the ground
     over the speed at which it came, from 0 (dead) to 1 (fully elastic)
  q  inertia ratio (L² - ρ²)/(L² + ρ²) of half-length L and radius of gyration
     ρ: 1 all mass at the center, 0.5 evenly spread, 0 all mass at the ends,
     below 0 mass beyond the ends

The plate. Two values of --gyration-ratio, radii of gyration along x and y over
half the length and half the width, make it a plate, with 'impacts', 'zone' and
'atlas'; --width with 'simulate' and 'respond'. Positions X,Y run from -1 to 1 along both; corner a (-1,-1) strikes
first, b (1,-1) is across its length, c (1,1) opposite, d (-1,1) across its
width. An evenly spread mass has --gyration-ratio=0.577350269,0.577350269.

Where the center of mass is not the middle, --center-of-mass with
--gyration-ratio, or a list of --mass, says how the mass lies; q is then that
of the symmetric bar with the same clatter, and the ends differ.

Units. Velocities are in v0, the drop speed, and upward positive; changes of
angular velocity are in v0/L; times are in h0/v0, where h0 is the height of
end b when end a first touches. One time unit is what end b would still need
to the ground if the bar did not turn: 0.5 ms for h0 = 2 mm at v0 = 4 m/s.

Quantities are numbers with their unit: 150mm, 0.4 ms, 4.85 m/s, 180Hz, 5deg,
1500gn or 15 m/s^2, 5 %. For accelerations gn, g and G are standard gravity,
9.80665 m/s². A contact time is that of a lone contact of one end, from touch
to parting; 'clatter init -' tells what is known of it, and of e. A file named
- is standard input.

Exit status: 0 done; 1 'assess' found a component unsafe or could not decide,
'scatter' missed its target, or 'spectrum' found its limit exceeded; 2 bad
input, or an output that cannot be written; 3 typst, which prints the reports,
is missing or failed; 4 the answer is whole, and the file of '-o' is not made,
as --time-limit is over.";

/// How the mass lies, and how the ends rebound.
#[derive(Debug, clap::Args)]
pub(crate) struct BarArgs {
    #[command(flatten)]
    inertia: Inertia,
    /// Coefficient of restitution, in [0, 1]: rebound speed of an end over its approach speed, such as 0.3 or 30%
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = restitution)]
    e: f64,
}

#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct Inertia {
    /// Inertia ratio (L² - ρ²)/(L² + ρ²), in (-1, 1]: 0.5 for evenly spread mass, 1 for all mass at the center
    #[arg(long, value_name = "Q", allow_hyphen_values = true, value_parser = inertia_ratio)]
    q: Option<f64>,
    /// Instead of q: ρ/L, radius of gyration over half-length, exact also where q is within rounding of 1; two values KX,KY,
    /// over half the length and half the width, make a plate
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = gyration_ratios)]
    gyration_ratio: Option<Values<1, 2>>,
    /// Instead of q: a mass M in any unit at position S, or spread evenly from S to T, in half-lengths from the middle;
    /// given once for each piece, like --mass=2@-1:1 --mass=1@0.5
    #[arg(long, value_name = "M@S[:T]", allow_hyphen_values = true, value_parser = quantities::mass)]
    mass: Vec<Piece>,
}

/// A fixed number of values for a bar, and another for a plate.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Values<const BAR: usize, const PLATE: usize> {
    Bar([f64; BAR]),
    Plate([f64; PLATE]),
}

impl<const BAR: usize, const PLATE: usize> Values<BAR, PLATE> {
    pub(crate) fn of_bar(self, flag: &str) -> Result<[f64; BAR], Failure> {
        match self {
            Self::Bar(values) => Ok(values),
            Self::Plate(values) => Err(Self::wrong(flag, &values, "bar", BAR)),
        }
    }
    pub(crate) fn of_plate(self, flag: &str) -> Result<[f64; PLATE], Failure> {
        match self {
            Self::Bar(values) => Err(Self::wrong(flag, &values, "plate", PLATE)),
            Self::Plate(values) => Ok(values),
        }
    }
    fn wrong(flag: &str, values: &[f64], body: &str, takes: usize) -> Failure {
        let values: Vec<_> = values.iter().map(|x| given(*x)).collect();
        Failure::Wrong(format!(
            "invalid value '{}' for '{flag}': a {body} takes {takes} of them, not {}; two values of --gyration-ratio make a \
             plate, one makes a bar",
            values.join(","),
            values.len(),
        ))
    }
}

/// Reads as many numbers as a bar takes by one function, as many as a plate takes by the other.
fn values<const BAR: usize, const PLATE: usize>(
    text: &str,
    bar: impl Fn(&str) -> Result<[f64; BAR], String>,
    plate: impl Fn([f64; PLATE]) -> Result<(), Error>,
) -> Result<Values<BAR, PLATE>, String> {
    let several = parts(text, ',');
    if several.len() != PLATE {
        return bar(text).map(Values::Bar);
    }
    let mut numbers = [0.0; PLATE];
    for (number_of, text) in numbers.iter_mut().zip(several) {
        *number_of = number(text)?;
    }
    plate(numbers).map(|()| Values::Plate(numbers)).map_err(|error| error.to_string())
}

/// How the mass lies, the center of mass anywhere between the ends, and how the ends rebound.
#[derive(Debug, clap::Args)]
pub(crate) struct OffCenterArgs {
    #[command(flatten)]
    bar: BarArgs,
    /// Where the center of mass lies, between -1 (end a) and 1 (end b); goes with --gyration-ratio, whose ρ is then
    /// about it; SX,SY for a plate
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = centers_of_mass, conflicts_with_all = ["q", "mass"])]
    center_of_mass: Option<Values<1, 2>>,
}

/// The body that falls.
pub(crate) enum FallingBody {
    Bar(Bar),
    Plate(Plate),
}

impl OffCenterArgs {
    pub(crate) fn body(&self) -> Result<FallingBody, Failure> {
        let BarArgs { inertia, e } = &self.bar;
        let (bar, center) = (FallingBody::Bar, "--center-of-mass");
        match (inertia.gyration_ratio, inertia.q) {
            (Some(Values::Plate(ratios)), _) => {
                let offset = self.center_of_mass.map_or(Ok([0.0; 2]), |offset| offset.of_plate(center))?;
                Ok(FallingBody::Plate(Plate::off_center(ratios, offset, *e)?))
            }
            (Some(Values::Bar([k])), _) => match self.center_of_mass.map(|offset| offset.of_bar(center)).transpose()? {
                Some([c]) => {
                    Bar::from_center_of_mass(c, 0.0, *e).map_err(Failure::flag(center))?;
                    Bar::from_center_of_mass(c, k, *e).map(bar).map_err(Failure::flag("--gyration-ratio"))
                }
                None => Ok(bar(Bar::from_gyration_ratio(k, *e)?)),
            },
            (None, Some(q)) => Ok(bar(Bar::new(q, *e)?)),
            // The group requires one of the three.
            (None, None) => bar_of(&quantities::masses(&inertia.mass, None)?, *e).map(bar),
        }
    }
}

impl OffCenterArgs {
    /// Returns warnings about masses far outside of the body.
    pub(crate) fn slips(&self) -> impl Iterator<Item = Slip> {
        self.bar.inertia.mass.iter().flat_map(|piece| piece.slips(1.0))
    }
}

/// Makes the bar of masses whose positions are in half-lengths.
pub(crate) fn bar_of(masses: &[Mass], e: f64) -> Result<Bar, Failure> {
    Bar::from_masses(2.0, masses, e).map_err(Failure::flag("--mass"))
}

/// How fast a component comes to rest.
#[derive(Debug, clap::Args)]
#[group(multiple = false)]
pub(crate) struct DampingArgs {
    /// Damping ratio of the component, 0 or more, such as 0.05 or 5%: 0 never comes to rest, 1 is critical [default: 0.05]
    #[arg(long, value_name = "Z", allow_hyphen_values = true, value_parser = damping)]
    damping: Option<DampingRatio>,
    /// Instead of the damping ratio: quality factor Q = 1/(2 Z), `inf` for no damping [default: 10]
    #[arg(long, value_name = "Q", allow_hyphen_values = true, value_parser = quality_factor)]
    q_factor: Option<DampingRatio>,
}

impl DampingArgs {
    pub(crate) fn given(&self) -> Option<DampingRatio> {
        self.damping.or(self.q_factor)
    }
    pub(crate) fn is_given(&self) -> bool {
        self.given().is_some()
    }
    /// Returns a warning about a damping ratio that no part has.
    pub(crate) fn slip(&self) -> Option<Slip> {
        self.damping.and_then(|ratio| clatter_product::slip("damping_ratio", &Quantity::of_si(ratio.get())))
    }
    /// Returns the damping ratio; Q = 10 where none is given, as is usual in the field.
    pub(crate) fn ratio(&self) -> Result<DampingRatio, clatter_shock::Error> {
        self.damping.or(self.q_factor).map_or_else(|| DampingRatio::from_quality_factor(10.0), Ok)
    }
}

/// The stops on either side of a component.
#[derive(Debug, clap::Args)]
pub(crate) struct StopArgs {
    /// Stops on either side of the component: the gap to each, how long it presses one alone, and the restitution there, such as
    /// 1mm,0.5ms,0.4; without units in m and s. Records are then straight lines between their samples
    #[arg(long, value_name = "GAP,TIME,E", allow_hyphen_values = true, value_parser = quantities::stop, conflicts_with_all = ["stop_gap_m", "stop_contact_time_s", "stop_restitution"])]
    stop: Option<[f64; 3]>,
    /// Gap of --stop in m
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = number, requires_all = ["stop_contact_time_s", "stop_restitution"], help_heading = IN_SI, hide_short_help = true)]
    stop_gap_m: Option<f64>,
    /// Contact time of --stop in s
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = number, requires = "stop_gap_m", help_heading = IN_SI, hide_short_help = true)]
    stop_contact_time_s: Option<f64>,
    /// Restitution of --stop
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = restitution, requires = "stop_gap_m", help_heading = IN_SI, hide_short_help = true)]
    stop_restitution: Option<f64>,
}

impl StopArgs {
    /// Returns the stop that was given; none where none was.
    pub(crate) fn given(&self) -> Result<Option<Stop>, Failure> {
        let in_si = || Some([self.stop_gap_m?, self.stop_contact_time_s?, self.stop_restitution?]);
        let Some(numbers) = self.stop.or_else(in_si) else { return Ok(None) };
        let ranges = [("gap in m", 1e-12..=1e3), ("contact time in s", 1e-12..=1e3), ("restitution", 0.0..=1.0)];
        for (value, (name, range)) in numbers.into_iter().zip(ranges) {
            if !range.contains(&value) {
                let (least, most) = (range.start(), range.end());
                return Err(Failure::Wrong(format!("--stop: {name} = {value:?}; allowed: from {least:?} to {most:?}")));
            }
        }
        Ok(Some(Stops::of(numbers)?))
    }
}

/// The same, with several quality factors.
#[derive(Debug, clap::Args)]
#[group(multiple = false)]
pub(crate) struct DampingListArgs {
    /// Damping ratio of the component, 0 or more, such as 0.05 or 5%: 0 never comes to rest, 1 is critical [default: 0.05]
    #[arg(long, value_name = "Z", allow_hyphen_values = true, value_parser = damping)]
    damping: Option<DampingRatio>,
    /// Instead of the damping ratio: quality factors Q = 1/(2 Z), a spectrum each, `inf` for no damping [default: 10]
    #[arg(long, value_name = "Q,…", allow_hyphen_values = true, value_delimiter = ',', value_parser = quality_factor)]
    q_factor: Vec<DampingRatio>,
}

impl DampingListArgs {
    /// Returns a warning about a damping ratio that no part has.
    pub(crate) fn slip(&self) -> Option<Slip> {
        self.damping.and_then(|ratio| clatter_product::slip("damping_ratio", &Quantity::of_si(ratio.get())))
    }
    /// Returns the given damping ratios, at least one: Q = 10 where none is given.
    pub(crate) fn ratios(&self) -> Result<Vec<DampingRatio>, clatter_shock::Error> {
        match (self.damping, &self.q_factor[..]) {
            (Some(damping), _) => Ok(vec![damping]),
            (None, []) => Ok(vec![DampingRatio::from_quality_factor(10.0)?]),
            (None, several) => Ok(several.to_vec()),
        }
    }
}

fn damping(text: &str) -> Result<DampingRatio, String> {
    DampingRatio::new(share(text)?).map_err(|error| error.to_string())
}

fn quality_factor(text: &str) -> Result<DampingRatio, String> {
    DampingRatio::from_quality_factor(number(text)?).map_err(|error| error.to_string())
}

/// How rows are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum RowFormat {
    /// For people: six significant digits, units in the headings
    Table,
    /// For programs: every digit, on one line
    Json,
    /// The rows alone, every digit
    Csv,
}

/// How an answer without rows is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// For people
    Table,
    /// For programs
    Json,
}

/// An end of the bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum EndName {
    /// At position -1
    A,
    /// At position 1
    B,
}

impl From<EndName> for End {
    fn from(end: EndName) -> Self {
        match end {
            EndName::A => Self::A,
            EndName::B => Self::B,
        }
    }
}

pub(crate) fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("'{}' is not a number such as 0.5", visible(text)))
}

/// Reads a list of `N` numbers.
fn list<const N: usize>(text: &str, what: &str) -> Result<[f64; N], String> {
    let found: Vec<f64> = parts(text, ',').into_iter().map(number).collect::<Result<_, _>>()?;
    let count = found.len();
    found.try_into().map_err(|_| format!("'{}' has {count} numbers, not {N}: {what}", visible(text)))
}

pub(crate) fn triple(text: &str) -> Result<[f64; 3], String> {
    list(text, "X,Y,Z")
}

/// Reads the products of inertia of a plate, or of a box.
pub(crate) fn products(text: &str) -> Result<[f64; 3], String> {
    if text.contains(',') { list(text, "XY,XZ,YZ") } else { Ok([number(text)?, 0.0, 0.0]) }
}

/// Reads feet: how far a product goes on beyond them along and across it, and how far they stand out.
pub(crate) fn feet(text: &str) -> Result<[f64; 3], String> {
    let feet @ [x, y, height] = list(text, "X,Y,HEIGHT in m")?;
    let within = [x, y].iter().all(|beyond| (0.0..=50.0).contains(beyond)) && (1e-5..=1.0).contains(&height);
    if within { Ok(feet) } else { Err("allowed: X and Y from 0 to 50 m, HEIGHT from 1e-5 to 1 m".to_owned()) }
}

/// Reads a contact of its own: where, its restitution, and how long a lone one takes.
pub(crate) fn own_contact(text: &str) -> Result<(usize, OwnContact), String> {
    let (at, numbers) = text.split_once(',').ok_or("expected AT,E,TIME in s, such as b,0.1,1.5e-3")?;
    let at = ["a", "b", "c", "d"].into_iter().position(|place| place == at.trim());
    let at = at.ok_or("expected a or b, of a plate a, b, c or d, then E and TIME")?;
    let [e, time_s] = list(numbers, "AT,E,TIME in s")?;
    if (0.0..=1.0).contains(&e) && (1e-12..=1e3).contains(&time_s) {
        Ok((at, OwnContact { restitution: Some(e), contact_time_s: Some(time_s) }))
    } else {
        Err("allowed: E from 0 to 1, TIME from 1e-12 to 1000 s".to_owned())
    }
}

pub(crate) fn quaternion(text: &str) -> Result<[f64; 4], String> {
    list(text, "W,X,Y,Z, the unit quaternion of a rotation")
}

/// Reads a share, or a percentage with its sign.
pub(crate) fn share(text: &str) -> Result<f64, String> {
    let share =
        plain_or_typed(&SHARE, text).map_err(|_| format!("'{}' is not a share such as 0.01 or 1%", visible(text)))?;
    Ok(share.si)
}

/// Returns the parts of a list, without the blanks around them.
pub(crate) fn parts(text: &str, between: char) -> Vec<&str> {
    text.split(between).map(str::trim).collect()
}

pub(crate) fn tolerance(text: &str) -> Result<f64, String> {
    let share = share(text)?;
    Accuracy { tolerance: share, ..Accuracy::default() }.check().map_err(|error| error.to_string())?;
    Ok(share)
}

/// Reads an axis of a box.
pub(crate) fn axis_of_box() -> impl TypedValueParser<Value = clatter_product::Axis> {
    let names = ["x", "y", "z"].map(PossibleValue::new).into_iter();
    let any = PossibleValue::new("any").help("The magnitude, of a place on which a part is mounted rigidly");
    PossibleValuesParser::new(names.chain([any])).map(|name| clatter_product::Axis::of(&name).unwrap_or_default())
}

/// Reads the model by which a drop is followed; the models begin with the least physics.
pub(crate) fn model() -> impl TypedValueParser<Value = Model> {
    let help = |model| match model {
        Model::Ballistic => "Small tilt, gravity, instant impacts: what bounced clear comes back",
        Model::FiniteTilt => "Any tilt, gravity, instant impacts",
        Model::Compliant => "Any tilt, gravity, contacts that take time",
        _ => "Small tilt, no gravity, instant impacts: the paper's bar",
    };
    let names = Model::FOLLOWED.map(|model| PossibleValue::new(model.name()).help(help(model)));
    PossibleValuesParser::new(names)
        .try_map(|name| Model::FOLLOWED.into_iter().find(|model| model.name() == name).ok_or("no model"))
}

/// The law by which the ground acts on an end during a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Law(pub(crate) ContactLaw);

impl ValueEnum for Law {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [Law; ContactLaw::ALL.len()] = {
            let mut all = [Law(ContactLaw::ALL[0]); ContactLaw::ALL.len()];
            let mut k = 0;
            while k < all.len() {
                all[k] = Law(ContactLaw::ALL[k]);
                k += 1;
            }
            all
        };
        &ALL
    }
    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self.0 {
            ContactLaw::Hysteretic => "The force rises and falls like a half-sine, as in shock tables and standards",
            ContactLaw::Dashpot => "A spring and a dashpot: the force jumps at the touch; for some rubber",
        };
        Some(PossibleValue::new(self.0.name()).help(help))
    }
}

fn one_of_range(
    name: &'static str,
    text: &str,
    good: impl Fn(f64) -> bool,
    allowed: &'static str,
) -> Result<f64, String> {
    let value = number(text)?;
    if good(value) { Ok(value) } else { Err(Error::Quantity { name, value, allowed }.to_string()) }
}

pub(crate) fn restitution(text: &str) -> Result<f64, String> {
    let e = share(text)?;
    Bar::new(0.0, e).map(|_| e).map_err(|error| error.to_string())
}

pub(crate) fn inertia_ratio(text: &str) -> Result<f64, String> {
    let q = number(text)?;
    Bar::new(q, 0.0).map(|_| q).map_err(|error| error.to_string())
}

pub(crate) fn gyration_ratio(text: &str) -> Result<f64, String> {
    let k = number(text)?;
    Bar::from_gyration_ratio(k, 0.0).map(|_| k).map_err(|error| error.to_string())
}

fn gyration_ratios(text: &str) -> Result<Values<1, 2>, String> {
    let plate = |ratios: [f64; 2]| Plate::new(ratios, 0.0).map(|_| ());
    values(text, |text| gyration_ratio(text).map(|k| [k]), plate)
}

fn centers_of_mass(text: &str) -> Result<Values<1, 2>, String> {
    let plate = |center: [f64; 2]| Plate::off_center([1.0; 2], center, 0.0).map(|_| ());
    values(text, |text| center_of_mass(text).map(|c| [c]), plate)
}

/// Reads the velocities of the ends of a bar, or of corners a, b and d of a plate.
pub(crate) fn velocities(text: &str) -> Result<Values<2, 3>, String> {
    values(text, velocity, |velocity| PlateStart::new(velocity, [1.0; 2]).map(|_| ()))
}

/// Reads the height of end b of a bar, or the heights of corners b and d of a plate.
pub(crate) fn height_gaps(text: &str) -> Result<Values<1, 2>, String> {
    values(text, |text| height_gap(text).map(|gap| [gap]), |gaps| PlateStart::level(gaps).map(|_| ()))
}

/// Reads a position on a bar, or on a plate.
pub(crate) fn positions(text: &str) -> Result<Values<1, 2>, String> {
    let on_plate = |[x, y]: [f64; 2]| {
        let out = |name, value: f64| {
            if value.abs() <= 1.0 { Ok(()) } else { Err(Error::Quantity { name, value, allowed: "in [-1, 1]" }) }
        };
        out("position x", x).and(out("position y", y))
    };
    values(text, |text| position(text).map(|s| [s]), on_plate)
}

fn velocity(text: &str) -> Result<[f64; 2], String> {
    let (a, b) = text.split_once(',').ok_or("two velocities are needed, of ends a and b: VA,VB")?;
    let in_v0 =
        |text: &str| number(text.trim()).map_err(|error| format!("{error}; velocities are in v0, without a unit"));
    let velocity = [in_v0(a)?, in_v0(b)?];
    Start::new(velocity, 1.0).map(|_| velocity).map_err(|error| error.to_string())
}

fn height_gap(text: &str) -> Result<f64, String> {
    let gap = number(text)?;
    Start::new([-1.0, -1.0], gap).map(|_| gap).map_err(|error| error.to_string())
}

/// Reads ω of a component.
pub(crate) fn omega(text: &str) -> Result<f64, String> {
    let name = "natural angular frequency";
    one_of_range(name, text, |w| w > 0.0 && w.is_finite(), "finite and > 0")
}

pub(crate) fn limit(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| format!("not a whole number from 0 to {}", usize::MAX))
}

pub(crate) fn position(text: &str) -> Result<f64, String> {
    one_of_range("position s", text, |s| (-1.0..=1.0).contains(&s), "in [-1, 1]")
}

/// Reads a position that may be computed from lengths: one that misses an end by rounding is that end.
pub(crate) fn worked_out_position(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if value.abs() > 1.0 && value.abs() <= 1.0 + 8.0 * f64::EPSILON {
        Ok(value.clamp(-1.0, 1.0))
    } else {
        position(text)
    }
}

pub(crate) fn center_of_mass(text: &str) -> Result<f64, String> {
    one_of_range("center of mass", text, |s| s.abs() < 1.0, "in (-1, 1), between the ends")
}

/// Reads a number that is valid for its use where everything else is.
pub(crate) fn part_of<T>(value: f64, whole: impl Fn(f64) -> Result<T, Error>) -> Result<f64, String> {
    whole(value).map(|_| value + 0.0).map_err(|error| error.to_string())
}

fn drop_of(speed: f64, tilt: f64, gravity: f64) -> Result<Scene, Error> {
    Scene::new(Profile::new(1.0, 0.0)?, 0.0, speed, tilt, gravity)
}

pub(crate) fn length_of(length: f64) -> Result<Profile, Error> {
    Profile::new(length, 0.0)
}

pub(crate) fn speed_of(speed: f64) -> Result<Scene, Error> {
    drop_of(speed, 0.0, 0.0)
}

pub(crate) fn height_of(height: f64) -> Result<Scene, Error> {
    Scene::from_height(Profile::new(1.0, 0.0)?, 0.0, height, 0.0, 1.0)
}

/// Makes the scene of a tilt in degrees.
pub(crate) fn tilt_of(tilt: f64) -> Result<Scene, Error> {
    drop_of(1.0, tilt, 0.0)
}

pub(crate) fn gravity_of(gravity: f64) -> Result<Scene, Error> {
    drop_of(1.0, 0.0, gravity)
}

pub(crate) fn contact_of(time: f64) -> Result<Contact, Error> {
    Contact::new(ContactLaw::Hysteretic, 1.0, time)
}

pub(crate) fn until_of(time: f64) -> Result<Scene, Error> {
    drop_of(1.0, 0.0, 0.0)?.with_time_limit_s(time)
}

pub(crate) fn length_m(text: &str) -> Result<f64, String> {
    part_of(number(text)?, length_of)
}

pub(crate) fn speed_m_s(text: &str) -> Result<f64, String> {
    part_of(number(text)?, speed_of)
}

pub(crate) fn height_m(text: &str) -> Result<f64, String> {
    part_of(number(text)?, height_of)
}

pub(crate) fn tilt_deg(text: &str) -> Result<f64, String> {
    part_of(number(text)?, tilt_of)
}

pub(crate) fn gravity_m_s2(text: &str) -> Result<f64, String> {
    part_of(number(text)?, gravity_of)
}

pub(crate) fn contact_time_s(text: &str) -> Result<f64, String> {
    part_of(number(text)?, contact_of)
}

pub(crate) fn time_limit_s(text: &str) -> Result<f64, String> {
    part_of(number(text)?, until_of)
}

pub(crate) fn impact_limit(text: &str) -> Result<usize, String> {
    let impacts = limit(text)?;
    let set = drop_of(1.0, 0.0, 0.0).and_then(|scene| scene.with_impact_limit(impacts));
    set.map(|_| impacts).map_err(|error| error.to_string())
}

/// Reads a threshold within the bounds of velocities, so that no safe zone overflows.
pub(crate) fn threshold(text: &str) -> Result<f64, String> {
    one_of_range("threshold", text, |x| (1e-150..=1e150).contains(&x), "in [1e-150, 1e150], in v0")
}

pub(crate) fn q_axis(text: &str) -> Result<Axis, String> {
    axis(text, Axis::q)
}

pub(crate) fn gyration_axis(text: &str) -> Result<Axis, String> {
    axis(text, Axis::gyration_ratio)
}

pub(crate) fn e_axis(text: &str) -> Result<Axis, String> {
    axis(text, Axis::e)
}

fn axis(text: &str, make: fn(f64, f64, usize) -> Result<Axis, Error>) -> Result<Axis, String> {
    let [lo, hi, points] = parts(text, ':')[..] else {
        return Err("an axis is LO:HI:N, first value, last value and number of values".to_owned());
    };
    let points =
        points.parse().map_err(|_| format!("'{}' is not a number of values N such as 201", visible(points)))?;
    make(number(lo)?, number(hi)?, points).map_err(|error| error.to_string())
}
