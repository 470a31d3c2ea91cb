//! `clatter spectrum`: shock response spectra of records, pulses and velocity shocks.

mod answer;
mod table;

use std::fs::File;
use std::io::{self, BufReader, Write};
use std::path::{Path, PathBuf};

use clap::{ValueEnum, ValueHint};
use clatter_assess::units::{ACCELERATION, Dimension, LENGTH, SPEED, Unit};
use clatter_figures::FigureError;
use clatter_shock::{
    DamageBoundary, DampingRatio, Limit, LimitCurve, Lines, Margin, Pulse, Pulses, Quantity, Record, Shape, Spectrum,
    Survey, Suspension, Units, VelocityShock, VelocityShocks, stream,
};

use crate::excitation::{self, FrequencyArg, LimitArg, PulseArg};
use crate::inputs::{DampingListArgs, RowFormat};
use crate::numbers::figures;
use crate::output::{Files, Kind, Target, buffered};
use crate::progress::Counted;
use crate::quantities::Show;
use crate::{Exit, Failure, Streams, input, lists, output, text};

/// Compute a shock response spectrum: the peak of a component over its natural frequency
///
/// What shakes the base of the component is a measured record, or pulses, or velocity shocks:
///
///   RECORD.csv  two columns, time and acceleration, with a header that names the units, such as
///               `time [ms],acceleration [g]`; even in time, as far as its printed digits tell, or
///               not, of any length. Between samples the acceleration is taken as linear, and for
///               that the spectrum is exact. Missing samples, offset, drift and columns beyond the
///               two are told as warnings
///   --pulse     a pulse of a shape; may be given several times, and pulses may overlap
///   --shock     a change of velocity in no time, for pulses much shorter than a period
///   --pulses-file, --shocks-file
///               either of these from a CSV file, of any number: its first line names the columns,
///               shape,amplitude_m_s2,duration_s,start_s or time_s,delta_v_m_s, among others or not
///
/// For each frequency: `primary`, the largest absolute value from the first start to the last end;
/// `residual`, after it, the ring-down complete; `maximax` over both, and when it is reached; and
/// over both the largest `positive` and `negative` value. CSV and JSON have these of either part, too.
///
/// With --limit the margin 20 log10(limit/maximax) is given in decibel; below 0 the limit is exceeded,
/// and the exit status is 1.
///
/// `-o FILE` writes the rows as .csv, the whole answer as .json, or a picture as .svg: log-log, the
/// pseudo-velocity on four-coordinate paper. With --damage-boundary the picture is the damage
/// boundary with the pulse on it.
///
/// A damage boundary comes from one frequency and a limit, or with --tests from shock tests: a CSV
/// file with the columns test (velocity-change, in m/s, or acceleration, in m/s2), level and damaged
/// (yes or no). Critical is the highest level of either below all damage, as in ASTM D3332; between
/// them the boundary is that of an undamped component, for rectangles.
#[derive(Debug, clap::Args)]
#[command(
    verbatim_doc_comment,
    after_help = "\
Examples:
  clatter spectrum drop.csv                                     Q = 10, 10 Hz to 10 kHz
  clatter spectrum drop.csv --units=ms,g --quantity=pseudo-velocity -o drop.svg
  clatter spectrum --pulse=half-sine,500g,0.5ms --frequency=10Hz:10kHz:12 --damping=5%
  clatter spectrum --pulse=half-sine,5000,0.0005,0,0.002 --frequency=100,180 --limit=4000
  clatter spectrum --shock=2.5m/s,0s --shock=-1m/s,4ms --frequency=180Hz --quantity=pseudo-velocity
  clatter spectrum --pulse=half-sine,1000g,1ms --frequency=100Hz --limit=200g \\
      --damage-boundary -o boundary.svg
  clatter spectrum --pulse=rectangle,900,0.004 --damage-boundary --tests=tests.csv
  clatter spectrum --shocks-file=shocks.csv --frequency=180Hz
  clatter spectrum drop.csv --q-factor=5,10,25 --output-units=g --format=csv

Numbers without a unit are in SI. A limit in g, or where there is none a pulse in g, has the table in
g; JSON and CSV stay in SI. --output-units has all of them in one.

Exit status: 0 done, 1 the limit is exceeded, 2 bad input."
)]
pub(crate) struct Args {
    #[command(flatten)]
    excitation: Excitation,
    /// Units of a record whose header does not name them: s, ms or us, and m/s2 or g
    #[arg(long, value_name = "TIME,ACCELERATION", value_parser = excitation::units)]
    units: Option<Units>,
    /// Natural frequencies, in Hz without a unit: a list, or from LO to HI with so many to the octave
    #[arg(long, value_name = "HZ,…|LO:HI:PER_OCTAVE", default_value = "10:10000:12", allow_hyphen_values = true, value_parser = excitation::frequencies)]
    frequency: FrequencyArg,
    #[command(flatten)]
    damping: DampingListArgs,
    /// Which quantity of the component
    #[arg(long, value_enum, default_value_t = QuantityName::Acceleration)]
    quantity: QuantityName,
    /// What the component stands, with its unit or in SI: one value, such as 1500g, or points of a curve that is
    /// straight on log-log paper
    #[arg(long, value_name = "X|HZ:X,…", allow_hyphen_values = true, value_parser = excitation::limit)]
    limit: Option<LimitArg>,
    /// Unit of accelerations in the answer: of the table, CSV and JSON [default: that of the limit or the pulse in the
    /// table, SI elsewhere]
    #[arg(long, value_enum)]
    output_units: Option<OutputUnits>,
    /// Also give the damage boundary of one pulse at one frequency, for a --limit of acceleration or relative
    /// displacement, or from --tests
    #[arg(long)]
    damage_boundary: bool,
    /// Take the damage boundary from these shock tests, for a pulse that is a rectangle: a CSV file with the columns
    /// test, level and damaged
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, requires = "damage_boundary", conflicts_with = "limit")]
    tests: Option<PathBuf>,
    /// File to write, ending in .csv, .json or .svg; what was there is replaced once the new file is whole
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target)]
    output: Option<Target>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct Excitation {
    /// A record of time and acceleration, as text
    #[arg(value_name = "RECORD.csv", value_hint = ValueHint::FilePath)]
    record: Option<PathBuf>,
    /// A pulse: half-sine, haversine, triangle, initial-peak-sawtooth, terminal-peak-sawtooth, rectangle, trapezoid or
    /// trapezoid:RAMP (ramps over length, 0.1 unless given); amplitude, duration and one or more starts with their units, or in
    /// m/s² and s
    #[arg(long, value_name = "SHAPE,AMPLITUDE,DURATION,START…", allow_hyphen_values = true, value_parser = excitation::pulse)]
    pulse: Vec<PulseArg>,
    /// A velocity shock: change of velocity and time with their units, or in m/s and s; in order of time
    #[arg(long, value_name = "DELTA_V,TIME", allow_hyphen_values = true, value_parser = excitation::shock)]
    shock: Vec<VelocityShock>,
    /// Pulses from a CSV file with the columns shape, amplitude_m_s2, duration_s and start_s
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pulses_file: Option<PathBuf>,
    /// Velocity shocks from a CSV file with the columns time_s and delta_v_m_s, in order of time
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    shocks_file: Option<PathBuf>,
}

/// In which unit accelerations are told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum OutputUnits {
    /// Standard gravity, 9.80665 m/s²
    G,
    /// m/s²
    Si,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum QuantityName {
    /// Absolute acceleration, m/s²
    Acceleration,
    /// Displacement relative to the base, m
    RelativeDisplacement,
    /// Velocity relative to the base, m/s
    RelativeVelocity,
    /// Natural angular frequency times relative displacement, m/s
    PseudoVelocity,
    /// Its square times relative displacement, m/s²: the steady acceleration that bends the suspension as far
    EquivalentStaticAcceleration,
}

impl QuantityName {
    fn quantity(self) -> Quantity {
        match self {
            Self::Acceleration => Quantity::AbsoluteAcceleration,
            Self::RelativeDisplacement => Quantity::RelativeDisplacement,
            Self::RelativeVelocity => Quantity::RelativeVelocity,
            Self::PseudoVelocity => Quantity::PseudoVelocity,
            Self::EquivalentStaticAcceleration => Quantity::EquivalentStaticAcceleration,
        }
    }

    fn dimension(self) -> &'static Dimension {
        match self {
            Self::Acceleration | Self::EquivalentStaticAcceleration => &ACCELERATION,
            Self::RelativeDisplacement => &LENGTH,
            Self::RelativeVelocity | Self::PseudoVelocity => &SPEED,
        }
    }

    /// The name, as it is given, and the unit.
    fn name(self) -> [&'static str; 2] {
        match self {
            Self::Acceleration => ["acceleration", "m/s2"],
            Self::RelativeDisplacement => ["relative-displacement", "m"],
            Self::RelativeVelocity => ["relative-velocity", "m/s"],
            Self::PseudoVelocity => ["pseudo-velocity", "m/s"],
            Self::EquivalentStaticAcceleration => ["equivalent-static-acceleration", "m/s2"],
        }
    }
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Json, Kind::Svg])
}

/// The spectra of one excitation and all that goes with them.
struct Computed<'a> {
    args: &'a Args,
    /// One for each damping ratio, at least one.
    parts: Vec<Part>,
    survey: Option<Survey>,
    boundary: Option<Boundary>,
}

/// A spectrum and its margins, if there is a limit.
struct Part {
    spectrum: Spectrum,
    margins: Option<Vec<Option<Margin>>>,
}

impl Part {
    fn exceeds(&self) -> bool {
        self.margins.iter().flatten().flatten().any(|margin| !margin.is_safe())
    }
}

/// The damage boundary, and where the pulse stands.
struct Boundary {
    numbers: DamageBoundary,
    curve: Vec<(f64, f64)>,
    pulse: Pulse,
    margin: Margin,
}

/// Points of the damage boundary between the critical velocity change and the knee.
const BOUNDARY_POINTS: usize = 200;

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        let Excitation { record, pulses_file, shocks_file, .. } = &self.excitation;
        let reads = [record, pulses_file, shocks_file, &self.tests];
        Files {
            reads: reads.into_iter().flatten().map(AsRef::as_ref).collect(),
            writes: self.output.iter().map(|target| target.path.as_path()).collect(),
        }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        if self.units.is_some() && self.excitation.record.is_none() {
            return Err(Failure::Usage("--units goes with a record alone"));
        }
        let is_acceleration = self.quantity.dimension().name == ACCELERATION.name;
        if self.output_units == Some(OutputUnits::G) && !is_acceleration {
            return Err(Failure::Usage(
                "--output-units=g goes with the quantities acceleration and equivalent-static-acceleration alone",
            ));
        }
        self.check_limit()?;
        let boundary = if self.damage_boundary { Some(self.boundary()?) } else { None };
        let (spectra, survey) = self.spectra(&self.damping.ratios()?)?;
        let margins = |spectrum: &Spectrum| self.limit.as_ref().map(|limit| limit.curve.margins(spectrum));
        let parts = spectra.into_iter().map(|spectrum| Part { margins: margins(&spectrum), spectrum }).collect();
        let computed = Computed { args: self, parts, survey, boundary };
        if let Some(target) = &self.output {
            computed.write(target)?;
        }
        for finding in computed.survey.iter().flat_map(|survey| &survey.findings) {
            let path = self.excitation.record.as_deref().unwrap_or(Path::new(""));
            streams.note("warning", format_args!("{}: {finding}", text::path(path)));
        }
        if let Some(slip) = self.damping.slip() {
            streams.note("warning", slip);
        }
        match self.format {
            RowFormat::Table => computed.table(streams.out).map_err(Failure::Answer),
            RowFormat::Csv => computed.csv(streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&computed.answer()),
        }?;
        Ok(if computed.parts.iter().any(Part::exceeds) { Exit::Unsafe } else { Exit::Done })
    }

    /// Refuses a limit in a unit of another quantity.
    fn check_limit(&self) -> Result<(), Failure> {
        let Some((dimension, unit)) = self.limit.as_ref().and_then(|limit| limit.typed) else { return Ok(()) };
        let ([name, _], own) = (self.quantity.name(), self.quantity.dimension());
        if dimension.name == own.name {
            return Ok(());
        }
        let (what, own) = (dimension.one(), own.names());
        Err(Failure::Wrong(format!("--limit in {} is {what}, and the quantity is {name}, in one of {own}", unit.name)))
    }

    /// How the quantity is shown: in the unit asked for, else of the limit, else of a pulse.
    fn show(&self) -> Show {
        if self.output_units.is_some() {
            return self.written();
        }
        let typed = self.limit.as_ref().and_then(|limit| limit.typed).map(|(_, unit)| unit);
        let pulse = self.excitation.pulse.iter().find_map(|pulse| pulse.unit);
        let pulse = pulse.filter(|_| self.quantity.dimension().name == ACCELERATION.name);
        Show { unit: typed.or(pulse), name: self.quantity.name()[1] }
    }

    /// How CSV and JSON have the quantity: in SI unless g is asked for.
    fn written(&self) -> Show {
        let in_g = self.output_units == Some(OutputUnits::G);
        let unit: Option<&'static Unit> = ACCELERATION.units.iter().find(|unit| in_g && unit.name == "g");
        Show { unit, name: self.quantity.name()[1] }
    }

    /// A spectrum for each damping ratio.
    fn spectra(&self, dampings: &[DampingRatio]) -> Result<(Vec<Spectrum>, Option<Survey>), Failure> {
        let (list, quantity) = (&self.frequency.list, self.quantity.quantity());
        if let Some(path) = &self.excitation.record {
            let (spectra, survey) = self.record(path, dampings)?;
            return Ok((spectra, Some(survey)));
        }
        let shocks = match &self.excitation.shocks_file {
            Some(path) => lists::shocks(path)?,
            None => self.excitation.shock.clone(),
        };
        if !shocks.is_empty() {
            let shocks = VelocityShocks::new(shocks)?;
            return Ok((dampings.iter().map(|damping| shocks.spectrum(list, *damping, quantity)).collect(), None));
        }
        let pulses = self.pulses()?;
        excitation::check_periods(&pulses, list).map_err(Failure::Wrong)?;
        let pulses = Pulses::new(&pulses)?;
        Ok((dampings.iter().map(|damping| pulses.spectrum(list, *damping, quantity)).collect(), None))
    }

    fn pulses(&self) -> Result<Vec<Pulse>, Failure> {
        match &self.excitation.pulses_file {
            Some(path) => lists::pulses(path),
            None => {
                Ok(self.excitation.pulse.iter().flat_map(|PulseArg { pulses, .. }| pulses.iter().copied()).collect())
            }
        }
    }

    /// In constant memory: a first pass, and one for each damping ratio; what can be read but once is kept.
    fn record(&self, path: &Path, dampings: &[DampingRatio]) -> Result<(Vec<Spectrum>, Survey), Failure> {
        let (list, quantity) = (&self.frequency.list, self.quantity.quantity());
        let bad = |reason| Failure::Record { path: path.to_owned(), reason };
        let open = || {
            let file = File::open(path).map_err(|error| bad(clatter_shock::Error::Read(error.to_string())))?;
            Ok::<_, Failure>((file.metadata().ok(), BufReader::with_capacity(1 << 20, file)))
        };
        let kept = |record: &Record| {
            let spectra = dampings.iter().map(|damping| record.spectrum(list, *damping, quantity)).collect();
            (spectra, record.survey().clone())
        };
        if input::is_standard(path) {
            return Ok(kept(&Record::read(io::stdin().lock(), self.units).map_err(bad)?));
        }
        let (metadata, input) = open()?;
        let Some(size) = metadata.filter(std::fs::Metadata::is_file).map(|metadata| metadata.len()) else {
            return Ok(kept(&Record::read(input, self.units).map_err(bad)?));
        };
        let checking = Counted::begin("checking", size);
        let survey = Lines::new(input, self.units).survey(|_, bytes| checking.at(bytes)).map_err(bad)?;
        drop(checking);
        let mut spectra = Vec::with_capacity(dampings.len());
        for damping in dampings {
            let filtering = Counted::begin("filtering", size);
            let lines = Lines::new(open()?.1, self.units);
            let one = stream(lines, &survey, list, *damping, quantity, |bytes| filtering.at(bytes)).map_err(bad)?;
            spectra.push(one);
        }
        Ok((spectra, survey))
    }

    fn boundary(&self) -> Result<Boundary, Failure> {
        if let Some(path) = &self.tests {
            let [pulse @ Pulse { shape: Shape::Rectangle, .. }] = self.pulses()?[..] else {
                return Err(Failure::Usage(
                    "--tests goes with one --pulse with one start, a rectangle, as the tests are",
                ));
            };
            let [velocity, acceleration] = lists::tests(path)?;
            let boundary = DamageBoundary::from_tests(&velocity, &acceleration);
            return Boundary::new(boundary.map_err(|reason| Failure::Record { path: path.clone(), reason })?, pulse);
        }
        let ([pulse], [hz]) = (&self.pulses()?[..], self.frequency.list.hz()) else {
            return Err(Failure::Usage(
                "--damage-boundary goes with one --pulse with one start, and with one --frequency or --tests",
            ));
        };
        let level = self.limit.as_ref().and_then(|limit| limit.level);
        let limit = match (self.quantity, level) {
            (_, None) => return Err(Failure::Usage("--damage-boundary needs a --limit of one value")),
            (QuantityName::Acceleration, Some(level)) => Limit::Acceleration(level),
            (QuantityName::RelativeDisplacement, Some(level)) => Limit::RattleSpace(level),
            _ => {
                return Err(Failure::Usage(
                    "--damage-boundary goes with the quantities acceleration and relative-displacement alone",
                ));
            }
        };
        let [damping] = self.damping.ratios()?[..] else {
            return Err(Failure::Usage("--damage-boundary goes with one --q-factor"));
        };
        let suspension = Suspension::from_hz(*hz, damping)?;
        Boundary::new(DamageBoundary::new(suspension, limit, pulse.shape)?, *pulse)
    }
}

impl Boundary {
    fn new(numbers: DamageBoundary, pulse: Pulse) -> Result<Self, Failure> {
        let margin = numbers.margin(pulse.amplitude, pulse.duration)?;
        Ok(Self { numbers, curve: numbers.curve(BOUNDARY_POINTS)?, pulse, margin })
    }
}

impl Computed<'_> {
    fn limit(&self) -> Option<&LimitCurve> {
        self.args.limit.as_ref().map(|limit| &limit.curve)
    }

    fn write(&self, target: &Target) -> Result<(), Failure> {
        output::replace(&target.path, |file| match target.kind {
            Kind::Csv => buffered(file, |out| self.csv(out)),
            Kind::Svg => file.write_all(self.svg()?.as_bytes()),
            Kind::Json | Kind::Npy => buffered(file, |out| Ok(serde_json::to_writer(out, &self.answer())?)),
        })
    }

    fn svg(&self) -> Result<String, FigureError> {
        if let Some(b) = &self.boundary {
            let at = [b.pulse.velocity_change().abs(), b.pulse.amplitude.abs()];
            return clatter_figures::damage_boundary(&b.numbers, &b.curve, at);
        }
        let [first, others @ ..] = &self.parts[..] else { return Ok(String::new()) };
        let name = |part: &Part| format!("maximax, Q = {}", figures(0.5 / part.spectrum.damping.get()));
        let names: Vec<String> = others.iter().map(name).collect();
        let others: Vec<(&Spectrum, &str)> =
            others.iter().zip(&names).map(|(part, name)| (&part.spectrum, name.as_str())).collect();
        clatter_figures::spectra(&first.spectrum, &others, self.limit())
    }
}
