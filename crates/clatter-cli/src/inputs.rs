//! Arguments that several commands share, and how each is read.
//!
//! Every value is checked by the type that it becomes, so a range is written down once, in the model.

use clap::ValueEnum;
use clatter::{Axis, Bar, End, Error, Start};

/// What the numbers mean: part of the long help of the command and of each of its models.
pub(crate) const PRIMER: &str = "\
The bar. Seen from the side, a flat body is a rigid bar with ends a and b that
strike the ground; end a strikes first. Positions on it run from -1 (end a)
through 0 (the center) to 1 (end b). Two numbers decide everything:

  e  coefficient of restitution: the speed at which an end leaves the ground
     over the speed at which it came, from 0 (dead) to 1 (fully elastic)
  q  inertia ratio (L² - ρ²)/(L² + ρ²) of half-length L and radius of gyration
     ρ: 1 all mass at the center, 0.5 evenly spread, 0 all mass at the ends,
     below 0 mass beyond the ends

Units. Velocities are in v0, the drop speed, and upward positive; changes of
angular velocity are in v0/L; times are in h0/v0, where h0 is the height of
end b when end a first touches. One time unit is what end b would still need
to the ground if the bar did not turn: 0.5 ms for h0 = 2 mm at v0 = 4 m/s.

Exit status: 0 done; 2 bad input, or an output that cannot be written;
3 typst, which prints the reports, is missing or failed.";

/// How the mass lies, and how the ends rebound.
#[derive(Debug, clap::Args)]
pub(crate) struct BarArgs {
    #[command(flatten)]
    inertia: Inertia,
    /// Coefficient of restitution, in [0, 1]: rebound speed of an end over its approach speed
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = restitution)]
    e: f64,
}

#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct Inertia {
    /// Inertia ratio (L² - ρ²)/(L² + ρ²), in (-1, 1]: 0.5 for evenly spread mass, 1 for all mass at the center
    #[arg(long, value_name = "Q", allow_hyphen_values = true, value_parser = inertia_ratio)]
    q: Option<f64>,
    /// Instead of q: ρ/L, radius of gyration over half-length, exact also where q is within rounding of 1
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = gyration_ratio)]
    gyration_ratio: Option<f64>,
}

impl BarArgs {
    pub(crate) fn bar(&self) -> Result<Bar, Error> {
        match (self.inertia.q, self.inertia.gyration_ratio) {
            (_, Some(k)) => Bar::from_gyration_ratio(k, self.e),
            (q, None) => Bar::new(q.unwrap_or(f64::NAN), self.e), // the group requires one of the two
        }
    }
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

/// The letter of an end.
pub(crate) fn letter(end: End) -> &'static str {
    match end {
        End::A => "a",
        End::B => "b",
    }
}

fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("'{text}' is not a number such as 0.5"))
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

fn restitution(text: &str) -> Result<f64, String> {
    let e = number(text)?;
    Bar::new(0.0, e).map(|_| e).map_err(|error| error.to_string())
}

fn inertia_ratio(text: &str) -> Result<f64, String> {
    let q = number(text)?;
    Bar::new(q, 0.0).map(|_| q).map_err(|error| error.to_string())
}

fn gyration_ratio(text: &str) -> Result<f64, String> {
    let k = number(text)?;
    Bar::from_gyration_ratio(k, 0.0).map(|_| k).map_err(|error| error.to_string())
}

pub(crate) fn velocity(text: &str) -> Result<[f64; 2], String> {
    let (a, b) = text.split_once(',').ok_or("two velocities are needed, of ends a and b: VA,VB")?;
    let velocity = [number(a)?, number(b)?];
    Start::new(velocity, 1.0).map(|_| velocity).map_err(|error| error.to_string())
}

pub(crate) fn height_gap(text: &str) -> Result<f64, String> {
    let gap = number(text)?;
    Start::new([-1.0, -1.0], gap).map(|_| gap).map_err(|error| error.to_string())
}

pub(crate) fn limit(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| format!("not a whole number from 0 to {}", usize::MAX))
}

pub(crate) fn position(text: &str) -> Result<f64, String> {
    one_of_range("position s", text, |s| (-1.0..=1.0).contains(&s), "in [-1, 1]")
}

/// The bounds are those of velocities: no safe zone overflows.
pub(crate) fn threshold(text: &str) -> Result<f64, String> {
    one_of_range("threshold", text, |x| (1e-150..=1e150).contains(&x), "in [1e-150, 1e150], in v0")
}

pub(crate) fn q_axis(text: &str) -> Result<Axis, String> {
    axis(text, Axis::q)
}

pub(crate) fn e_axis(text: &str) -> Result<Axis, String> {
    axis(text, Axis::e)
}

fn axis(text: &str, make: fn(f64, f64, usize) -> Result<Axis, Error>) -> Result<Axis, String> {
    let [lo, hi, points] = text.split(':').collect::<Vec<_>>()[..] else {
        return Err("an axis is LO:HI:N, first value, last value and number of values".to_owned());
    };
    let points = points.parse().map_err(|_| format!("'{points}' is not a number of values N such as 201"))?;
    make(number(lo)?, number(hi)?, points).map_err(|error| error.to_string())
}
