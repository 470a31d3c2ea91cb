//! `clatter spectrum`: shock response spectra of records, pulses and velocity shocks.

mod answer;

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::{ValueEnum, ValueHint};
use clatter_assess::units::{ACCELERATION, Dimension, LENGTH, SPEED};
use clatter_figures::FigureError;
use clatter_record::{Between, Record};
use clatter_shock::{
    DamageBoundary, Limit, LimitCurve, Margin, Pulse, Pulses, Quantity, Shape, Spectrum, Suspension, VelocityShock,
    VelocityShocks,
};

use crate::excitation::{self, FrequencyArg, LimitArg, PulseArg, shape_name};
use crate::inputs::{DampingArgs, RowFormat};
use crate::numbers::{digits, figures, given};
use crate::output::{Files, Kind, Target, buffered};
use crate::progress::Counted;
use crate::quantities::Show;
use crate::record_args::RecordArgs;
use crate::{Failure, Streams, lists, output, text};

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
/// `residual`, after it, the ring-down complete; `maximax` over both; and over both the largest
/// `positive` and `negative` value.
///
/// With --limit the margin 20 log10(limit/maximax) is given in decibel; below 0 the limit is passed.
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

Numbers without a unit are in SI. A limit in g, or where there is none a pulse in g, has the table in
g; JSON and CSV stay in SI."
)]
pub(crate) struct Args {
    #[command(flatten)]
    excitation: Excitation,
    #[command(flatten)]
    reading: RecordArgs,
    /// What the acceleration of a record is between its samples
    #[arg(long, value_enum, default_value_t = Interpolation::BandLimited)]
    interpolation: Interpolation,
    /// Natural frequencies, in Hz without a unit: a list, or from LO to HI with so many to the octave
    #[arg(long, value_name = "HZ,…|LO:HI:PER_OCTAVE", default_value = "10:10000:12", allow_hyphen_values = true, value_parser = excitation::frequencies)]
    frequency: FrequencyArg,
    #[command(flatten)]
    damping: DampingArgs,
    /// Which quantity of the component
    #[arg(long, value_enum, default_value_t = QuantityName::Acceleration)]
    quantity: QuantityName,
    /// What the component stands, with its unit or in SI: one value, such as 1500g, or points of a curve that is
    /// straight on log-log paper
    #[arg(long, value_name = "X|HZ:X,…", allow_hyphen_values = true, value_parser = excitation::limit)]
    limit: Option<LimitArg>,
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

/// What is between samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Interpolation {
    /// No content from half the sampling rate on; straight lines where samples are uneven
    BandLimited,
    /// Straight lines
    Linear,
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

/// A computed spectrum and all that goes with it.
struct Computed<'a> {
    args: &'a Args,
    spectrum: Spectrum,
    record: Option<Record>,
    margins: Option<Vec<Option<Margin>>>,
    boundary: Option<Boundary>,
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

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        if let (Some(flag), None) = (self.reading.given(), &self.excitation.record) {
            return Err(Failure::Wrong(format!("{flag} goes with a record alone")));
        }
        self.check_limit()?;
        let boundary = if self.damage_boundary { Some(self.boundary()?) } else { None };
        let (spectrum, record) = self.spectrum()?;
        let margins = self.limit.as_ref().map(|limit| limit.curve.margins(&spectrum));
        let computed = Computed { args: self, spectrum, record, margins, boundary };
        if let Some(target) = &self.output {
            computed.write(target)?;
        }
        let lowest_hz = self.frequency.list.hz().iter().fold(f64::INFINITY, |least, hz| least.min(*hz));
        for finding in computed.record.iter().flat_map(|record| record.findings(lowest_hz)) {
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
        }
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

    /// How the quantity is shown: in the unit of the limit, else of a pulse.
    fn show(&self) -> Show {
        let typed = self.limit.as_ref().and_then(|limit| limit.typed).map(|(_, unit)| unit);
        let pulse = self.excitation.pulse.iter().find_map(|pulse| pulse.unit);
        let pulse = pulse.filter(|_| self.quantity.dimension().name == ACCELERATION.name);
        Show { unit: typed.or(pulse), name: self.quantity.name()[1] }
    }

    fn spectrum(&self) -> Result<(Spectrum, Option<Record>), Failure> {
        let (damping, quantity) = (self.damping.ratio()?, self.quantity.quantity());
        if let Some(path) = &self.excitation.record {
            let (spectrum, record) = self.record(path)?;
            return Ok((spectrum, Some(record)));
        }
        let shocks = match &self.excitation.shocks_file {
            Some(path) => lists::shocks(path)?,
            None => self.excitation.shock.clone(),
        };
        if !shocks.is_empty() {
            return Ok((VelocityShocks::new(shocks)?.spectrum(&self.frequency.list, damping, quantity), None));
        }
        let pulses = self.pulses()?;
        excitation::check_periods(&pulses, &self.frequency.list).map_err(Failure::Wrong)?;
        let pulses = Pulses::new(&pulses)?;
        Ok((pulses.spectrum(&self.frequency.list, damping, quantity), None))
    }

    fn pulses(&self) -> Result<Vec<Pulse>, Failure> {
        match &self.excitation.pulses_file {
            Some(path) => lists::pulses(path),
            None => {
                Ok(self.excitation.pulse.iter().flat_map(|PulseArg { pulses, .. }| pulses.iter().copied()).collect())
            }
        }
    }

    fn record(&self, path: &Path) -> Result<(Spectrum, Record), Failure> {
        let (damping, quantity) = (self.damping.ratio()?, self.quantity.quantity());
        let record = self.reading.read(path)?;
        let [channel] = record.channels() else {
            return Err(Failure::Usage("the record has several channels: --acceleration picks one"));
        };
        let between = if self.interpolation == Interpolation::Linear { Between::Linear } else { Between::BandLimited };
        let filtering = Counted::begin("filtering", record.samples() as u64);
        let spectrum = record.spectrum(channel, &self.frequency.list, damping, quantity, between, |n| filtering.at(n));
        let spectrum = spectrum.map_err(|reason| Failure::Record { path: path.to_owned(), reason })?;
        Ok((spectrum, record))
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
            return Boundary::new(boundary.map_err(|reason| Failure::Tests { path: path.clone(), reason })?, pulse);
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
        let suspension = Suspension::from_hz(*hz, self.damping.ratio()?)?;
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
        match &self.boundary {
            Some(b) => {
                let at = [b.pulse.velocity_change().abs(), b.pulse.amplitude.abs()];
                clatter_figures::damage_boundary(&b.numbers, &b.curve, at)
            }
            None => clatter_figures::spectrum(&self.spectrum, self.limit()),
        }
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let ([name, _], show) = (self.args.quantity.name(), self.args.show());
        let (unit, hz) = (show.name(), Show { unit: self.args.frequency.unit, name: "Hz" });
        let zeta = self.spectrum.damping.get();
        let name = name.replace('-', " ");
        writeln!(
            out,
            "Shock response spectrum: {name} in {unit}, damping ratio {} (Q = {})",
            given(zeta),
            figures(0.5 / zeta)
        )?;
        if let Some(record) = &self.record {
            let steps =
                record.step_s().map_or("uneven in time".to_owned(), |step| format!("every {} s", figures(step)));
            let (start, end) = (record.start_s(), record.start_s() + record.duration_s());
            let (n, from, to) = (record.samples(), figures(start), figures(end));
            let largest = record.channels()[0].values.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
            writeln!(out, "{n} samples from {from} to {to} s, {steps}; largest {} m/s2", figures(largest))?;
        }
        if let Some(boundary) = &self.boundary {
            let acceleration = self.args.quantity.dimension().name == ACCELERATION.name;
            let pulse = self.args.excitation.pulse.iter().find_map(|pulse| pulse.unit);
            let unit = show.unit.filter(|_| acceleration).or(pulse);
            boundary.table(Show { unit, name: "m/s2" }, out)?;
        }
        if let Some(margins) = &self.margins {
            self.worst(margins, out)?;
        }
        if let Some(target) = &self.args.output {
            return writeln!(out, "{}: {} frequencies", text::path(&target.path), self.spectrum.frequency_hz.len());
        }
        let margin = if self.margins.is_some() { "margin" } else { "" };
        let head = ["frequency", "primary", "residual", "maximax", "positive", "negative", margin];
        let units = [hz.name(), unit, unit, unit, unit, unit, if margin.is_empty() { "" } else { "dB" }];
        writeln!(out)?;
        for cells in [head, units] {
            let line = cells.map(|cell| format!("{cell:>13}")).concat();
            writeln!(out, "{}", line.trim_end())?;
        }
        for i in 0..self.spectrum.frequency_hz.len() {
            let [frequency, values @ ..] = self.row(i);
            let cells = std::iter::once(hz.figures(frequency)).chain(values.map(|x| show.figures(x)));
            let row = cells.fold(String::new(), |row, cell| format!("{row}{cell:>13}"));
            let margin = self.margins.as_ref().map_or(String::new(), |margins| {
                format!("{:>13}", margins[i].map_or("-".to_owned(), |m| figures(m.decibel())))
            });
            writeln!(out, "{row}{margin}")?;
        }
        Ok(())
    }

    fn worst(&self, margins: &[Option<Margin>], out: &mut dyn Write) -> io::Result<()> {
        let Some((i, margin)) = LimitCurve::worst(margins).and_then(|i| Some((i, margins[i]?))) else {
            return writeln!(out, "The limit covers none of these frequencies");
        };
        let hz = Show { unit: self.args.frequency.unit, name: "Hz" }.said(self.spectrum.frequency_hz[i]);
        let word = if margin.is_safe() { "holds" } else { "is passed" };
        writeln!(out, "The limit {word}: least margin {} dB at {hz}", figures(margin.decibel()))
    }

    fn row(&self, i: usize) -> [f64; 6] {
        let s = &self.spectrum;
        [s.frequency_hz[i], s.primary[i], s.residual[i], s.maximax[i], s.positive[i], s.negative[i]]
    }

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        if let Some(boundary) = &self.boundary {
            writeln!(out, "velocity_change_m_s,acceleration_m_s2")?;
            return boundary.curve.iter().try_for_each(|(v, a)| writeln!(out, "{},{}", digits(*v), digits(*a)));
        }
        let margin = if self.margins.is_some() { ",margin_db" } else { "" };
        writeln!(out, "frequency_hz,primary,residual,maximax,positive,negative{margin}")?;
        for i in 0..self.spectrum.frequency_hz.len() {
            write!(out, "{}", self.row(i).map(digits).join(","))?;
            match self.margins.as_ref().map(|margins| margins[i]) {
                Some(Some(margin)) => writeln!(out, ",{}", digits(margin.decibel()))?,
                Some(None) => writeln!(out, ",")?,
                None => writeln!(out)?,
            }
        }
        Ok(())
    }
}

impl Boundary {
    fn table(&self, acceleration: Show, out: &mut dyn Write) -> io::Result<()> {
        let (b, p) = (&self.numbers, &self.pulse);
        let line = |out: &mut dyn Write, name: &str, value: f64, unit: &str| {
            writeln!(out, "{name:<28}{:>12} {unit}", figures(value))
        };
        writeln!(out, "\nDamage boundary for a {} pulse", shape_name(p.shape))?;
        line(out, "Critical velocity change", b.critical_velocity_change(), "m/s")?;
        line(out, "Critical acceleration", acceleration.value(b.critical_acceleration()), acceleration.name())?;
        line(out, "Knee at a velocity change of", b.knee_velocity_change(), "m/s")?;
        line(out, "This pulse, velocity change", p.velocity_change().abs(), "m/s")?;
        line(out, "            acceleration", acceleration.value(p.amplitude.abs()), acceleration.name())?;
        let word = if self.margin.is_safe() { "dB: no damage" } else { "dB: damage" };
        line(out, "            margin", self.margin.decibel(), word)?;
        writeln!(out)
    }
}
