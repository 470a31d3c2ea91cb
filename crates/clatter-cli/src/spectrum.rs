//! This module is `clatter spectrum`: it computes shock response spectra of records, pulses and velocity shocks.

mod boundary;
mod history;
mod records;
mod table;

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{ValueEnum, ValueHint};
use clatter_answer::Error;
use clatter_answer::spectrum::{self, Answer, Excitation, Measured, Part, Question, beyond};
use clatter_figures::{Against, Critical, FigureError};
use clatter_product::units::{ACCELERATION, Dimension, LENGTH, SPEED, Unit};
use clatter_record::{BAND, Between};
use clatter_shock::{Quantity, RequiredSpectrum, Shape, VelocityShock, VelocityShocks};
use serde::Serialize;

use crate::condition_args::ConditionArgs;
use crate::excitation::{self, FrequencyArg, LimitArg, PulseArg, Tolerance};
use crate::find_args::FindArgs;
use crate::inputs::{DampingListArgs, RowFormat, StopArgs};
use crate::numbers::figures;
use crate::output::{Files, Kind, Target, buffered};
use crate::progress::Counted;
use crate::quantities::Show;
use crate::record_args::RecordArgs;
use crate::{Exit, Failure, Streams, lists, output, text};
use records::Several;

/// Compute a shock response spectrum: the peak of a component over its natural frequency
///
/// What shakes the base of the component is a measured record, or pulses, or velocity shocks:
///
///   RECORD      a file of measured accelerations, of any kind that `clatter record` reads; a spectrum for
///               each channel. Between even samples it is taken as band-limited, which holds to 0.1 % up to
///               0.4 of the sampling rate; --interpolation=linear has straight lines, and is exact for them.
///               Uneven samples have straight lines always. What is odd is told as warnings
///   --pulse     a pulse of a shape or a standard; may be given several times, and pulses may overlap
///   --shock     a change of velocity in no time, for pulses much shorter than a period
///   --pulses-file, --shocks-file
///               either of these from a table, of any number, in any notation of records: its first line
///               names the columns, shape,amplitude_m_s2,duration_s,start_s or time_s,delta_v_m_s, or the
///               same in other units, such as `delta v [mm/s]`, among others or not
///
/// For each frequency: `primary`, the largest absolute value from the first start to the last end;
/// `residual`, after it, the ring-down complete; `maximax` over both, and when it is reached; and
/// over both the largest `positive` and `negative` value. CSV and JSON have these of either part, too.
///
/// With --limit the margin 20 log10(limit/maximax) is given in decibel; below 0 the limit is exceeded,
/// and the exit status is 1.
///
/// With --required the spectrum that a test was to reach is held beside each channel: at every frequency the maximax is at least
/// that, and within --tolerance of it where one is given, or the exit status is 1. How far it is off is told in decibel.
///
/// `-o FILE` writes the rows as .csv, the whole answer as .json, or a picture as .svg: log-log, the
/// pseudo-velocity on four-coordinate paper. With --damage-boundary the picture is the damage
/// boundary with the pulse on it.
///
/// A damage boundary comes from one frequency and a limit, or with --tests from shock tests: a
/// table with the columns test (velocity-change, in m/s, or acceleration, in m/s2), level and damaged
/// (yes or no). Critical is the highest level of either below all damage, as in ASTM D3332; between
/// them the boundary is that of an undamped component, for rectangles.
#[derive(Debug, clap::Args)]
#[command(
    verbatim_doc_comment,
    after_help = "\
Examples:
  clatter spectrum drop.csv                                     Q = 10, 10 Hz to 10 kHz
  clatter spectrum drop.csv --units=ms,g --quantity=pseudo-velocity -o drop.svg
  clatter spectrum --pulse=half-sine,500gn,0.5ms --frequency=10Hz:10kHz:12 --damping=5%
  clatter spectrum --pulse=half-sine,5000,0.0005,0,0.002 --frequency=100,180 --limit=4000
  clatter spectrum --shock=2.5m/s,0s --shock=-1m/s,4ms --frequency=180Hz --quantity=pseudo-velocity
  clatter spectrum --pulse=half-sine,1000gn,1ms --frequency=100Hz --limit=200gn \\
      --damage-boundary -o boundary.svg
  clatter spectrum --pulse=rectangle,600,0.004 --damage-boundary --tests=tests.csv
  clatter spectrum --shocks-file=shocks.csv --frequency=180Hz
  clatter spectrum drop.csv --find --envelope --enveloping-pulse=half-sine
  clatter spectrum drop.csv --frequency=180Hz --history=felt.csv
  clatter spectrum drop.csv --required=10:9gn,80:75gn,2000:75gn --tolerance=-1.5,6
  clatter spectrum drop.csv --q-factor=5,10,25 --output-units=gn --format=csv

Numbers without a unit are in SI. A limit in gn, or where there is none a pulse in gn, has the table in
gn; JSON and CSV stay in SI. --output-units has all of them in one.

Exit status: 0 done, 1 the limit or the damage boundary is exceeded or the required spectrum not
seen to be reached all over its range, 2 bad input."
)]
pub(crate) struct Args {
    #[command(flatten)]
    excitation: Excited,
    #[command(flatten)]
    reading: RecordArgs,
    #[command(flatten)]
    condition: ConditionArgs,
    #[command(flatten)]
    several: Several,
    #[command(flatten)]
    finding: FindArgs,
    /// What the acceleration of a record is between its samples
    #[arg(long, value_enum, default_value_t = Interpolation::BandLimited)]
    interpolation: Interpolation,
    /// Natural frequencies, in Hz without a unit: a list, or from LO to HI with so many to the octave [default: 10:10000:12, of
    /// records up to a third of the sampling rate]
    #[arg(long, value_name = "HZ,…|LO:HI:PER_OCTAVE", allow_hyphen_values = true, value_parser = excitation::frequencies)]
    frequency: Option<FrequencyArg>,
    #[command(flatten)]
    damping: DampingListArgs,
    #[command(flatten)]
    stop: StopArgs,
    /// Which quantity of the component
    #[arg(long, value_enum, default_value_t = QuantityName::Acceleration)]
    quantity: QuantityName,
    /// What the component stands, with its unit or in SI: one value, such as 1500gn, or points of a curve that is
    /// straight on log-log paper
    #[arg(long, value_name = "X|HZ:X,…", allow_hyphen_values = true, value_parser = excitation::limit)]
    limit: Option<LimitArg>,
    /// What the component stands from a table: frequency and level, with units in its headings
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "limit")]
    limit_file: Option<PathBuf>,
    /// What the spectrum was to reach, as --limit has it: a value, points of a curve or the curve of a standard
    #[arg(long, value_name = "X|HZ:X,…", allow_hyphen_values = true, value_parser = excitation::limit)]
    required: Option<LimitArg>,
    /// The same from a CSV file, as --limit-file has it
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "required")]
    required_file: Option<PathBuf>,
    /// How far it may be off the required one, in dB: 3 is 3 dB on both sides, -1.5,6 is 1.5 dB below and 6 dB above, -1.5 has
    /// nothing above it [default: nothing below it, and anything above]
    #[arg(long, value_name = "DB|-BELOW,ABOVE", allow_hyphen_values = true, value_parser = excitation::tolerance)]
    tolerance: Option<Tolerance>,
    /// Also the pulse of this shape, such as half-sine, whose spectrum is nowhere below, and above by least on average
    #[arg(long, value_name = "SHAPE", value_parser = excitation::shape)]
    enveloping_pulse: Option<Shape>,
    /// Write to this CSV file what the component of one --frequency feels over time, of each channel of a record
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = history)]
    history: Option<Target>,
    /// Unit of accelerations in the answer: of the table, CSV and JSON [default: that of the limit or the pulse in the
    /// table, SI elsewhere]
    #[arg(long, value_enum)]
    output_units: Option<OutputUnits>,
    /// Also give the damage boundary of one pulse at one frequency, for a --limit of acceleration or relative
    /// displacement, or from --tests
    #[arg(long)]
    damage_boundary: bool,
    /// Take the damage boundary from these shock tests, for a pulse that is a rectangle: a table with the columns
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
struct Excited {
    /// Files of measured accelerations, as `clatter record` reads them
    #[arg(value_name = "RECORD", value_hint = ValueHint::FilePath)]
    records: Vec<PathBuf>,
    /// A pulse: half-sine, haversine, triangle, initial-peak-sawtooth, terminal-peak-sawtooth, rectangle, trapezoid or
    /// trapezoid:RAMP (ramps over length, 0.1 unless given); amplitude, duration and one or more starts with their units, or in
    /// m/s² and s; or the pulse of a standard, such as JESD22-B110/B
    #[arg(long, value_name = "SHAPE,AMPLITUDE,DURATION,START…", allow_hyphen_values = true, value_parser = excitation::pulse)]
    pulse: Vec<PulseArg>,
    /// A velocity shock: change of velocity and time with their units, or in m/s and s; in order of time
    #[arg(long, value_name = "DELTA_V,TIME", allow_hyphen_values = true, value_parser = excitation::shock)]
    shock: Vec<VelocityShock>,
    /// Pulses from a table with the columns shape, amplitude_m_s2, duration_s and start_s
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pulses_file: Option<PathBuf>,
    /// Velocity shocks from a table with the columns time_s and delta_v_m_s, in order of time
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

impl From<Interpolation> for Between {
    fn from(interpolation: Interpolation) -> Self {
        match interpolation {
            Interpolation::BandLimited => Self::BandLimited,
            Interpolation::Linear => Self::Linear,
        }
    }
}

/// In which unit accelerations are told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum OutputUnits {
    /// Standard gravity, 9.80665 m/s²
    #[value(name = "gn", alias = "g")]
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

    /// Returns the name, as it is given, and the unit.
    fn name(self) -> [&'static str; 2] {
        spectrum::name(self.quantity())
    }
}

fn history(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv])
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Json, Kind::Svg])
}

/// The spectra of one excitation and how they are shown.
struct Computed<'a> {
    args: &'a Args,
    answer: Answer<'a>,
    /// The unit that frequencies were typed in.
    unit: Option<&'static Unit>,
    limit: Option<LimitArg>,
}

/// The answer for programs, before the file that it is written to.
#[derive(Serialize)]
struct WithFile<'a> {
    #[serde(flatten)]
    answer: &'a Answer<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<&'a Path>,
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        let Excited { records, pulses_file, shocks_file, .. } = &self.excitation;
        let reads = [pulses_file, shocks_file, &self.tests, &self.limit_file, &self.required_file];
        Files {
            reads: records.iter().chain(reads.into_iter().flatten()).map(AsRef::as_ref).collect(),
            writes: self.output.iter().chain(&self.history).map(|target| target.path.as_path()).collect(),
        }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        if self.excitation.records.is_empty()
            && let Some(flag) = self
                .reading
                .given()
                .or_else(|| self.condition.given())
                .or_else(|| self.several.given())
                .or_else(|| self.finding.search().map(|_| "--find"))
        {
            return Err(Failure::Wrong(format!("{flag} goes with records alone")));
        }
        let is_acceleration = self.quantity.dimension().name == ACCELERATION.name;
        if self.output_units == Some(OutputUnits::G) && !is_acceleration {
            return Err(Failure::Usage(
                "--output-units=gn goes with the quantities acceleration and equivalent-static-acceleration alone",
            ));
        }
        if self.history.is_some() && self.excitation.records.is_empty() {
            return Err(Failure::Usage("--history goes with records alone"));
        }
        let limit = self.curve("--limit", self.limit.as_ref(), self.limit_file.as_deref())?;
        let required = self.curve("--required", self.required.as_ref(), self.required_file.as_deref())?;
        let required = self.required_within(required)?;
        let mut question = Question::new(self.excitation()?, self.damping.ratios()?[0]);
        question.dampings = self.damping.ratios()?;
        question.stop = self.stop.given()?;
        if question.stop.is_some() && (self.damage_boundary || self.history.is_some()) {
            return Err(Failure::Usage("--stop goes with spectra alone: not with --damage-boundary or --history"));
        }
        question.frequencies = self.frequency.as_ref().map(|frequency| frequency.list.clone());
        question.quantity = self.quantity.quantity();
        question.between = self.interpolation.into();
        question.limit = limit.as_ref().map(|limit| limit.curve.clone());
        question.required = required;
        question.enveloping = self.enveloping_pulse;
        let Several { resultant, envelope, mean_3db } = self.several;
        (question.resultant, question.envelope, question.mean_3db) = (resultant, envelope, mean_3db);
        question.unit = self.written().unit;
        let frequencies = question.frequencies()?;
        let boundary =
            if self.damage_boundary { Some(self.boundary(&question.excitation, &frequencies)?) } else { None };
        if boundary.as_ref().is_some_and(|boundary| boundary.critical_velocity_change.is_none())
            && self.output.as_ref().is_some_and(|target| target.kind == Kind::Svg)
        {
            return Err(Failure::Usage("both directions of the record cancel: there is no damage boundary to draw"));
        }
        let mut answer = counted(&question)?;
        answer.boundary = boundary;
        if let Some(target) = &self.history {
            self.write_history(question.records(), &frequencies, target)?;
        }
        let unit = self.frequency.as_ref().and_then(|frequency| frequency.unit);
        let computed = Computed { args: self, answer, unit, limit };
        if let Some(target) = &self.output {
            computed.write(target)?;
        }
        for warning in computed.warnings() {
            streams.note("warning", warning);
        }
        if let Some(slip) = self.damping.slip() {
            streams.note("warning", slip);
        }
        match self.format {
            RowFormat::Table => computed.table(streams.out).map_err(Failure::Answer),
            RowFormat::Csv => computed.csv(streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&computed.json()),
        }?;
        let Answer { parts, boundary, .. } = &computed.answer;
        let damages = boundary.as_ref().is_some_and(|boundary| !boundary.margin.is_safe());
        let reaches = |part: &Part| question.required.as_ref().is_none_or(|of| part.reaches(of) == Some(true));
        let wants = |part: &Part| part.exceeds() || !reaches(part);
        Ok(if damages || parts.iter().any(wants) { Exit::Unsafe } else { Exit::Done })
    }

    /// Returns a curve as it was typed or from its file; refuses it in a unit of another quantity.
    fn curve(&self, flag: &str, typed: Option<&LimitArg>, file: Option<&Path>) -> Result<Option<LimitArg>, Failure> {
        let own = self.quantity.dimension();
        let curve = match file {
            Some(path) => Some(lists::limit(path, own)?),
            None => typed.cloned(),
        };
        let unit = curve.as_ref().and_then(|curve| curve.typed).filter(|(dimension, _)| dimension.name != own.name);
        let Some((dimension, unit)) = unit else { return Ok(curve) };
        let ([name, _], what, own) = (self.quantity.name(), dimension.one(), own.names());
        Err(Failure::Wrong(format!("{flag} in {} is {what}, and the quantity is {name}, in one of {own}", unit.name)))
    }

    /// Returns the required curve with its tolerance.
    fn required_within(&self, curve: Option<LimitArg>) -> Result<Option<RequiredSpectrum>, Failure> {
        let Some(LimitArg { curve, .. }) = curve else {
            return match self.tolerance {
                Some(_) => Err(Failure::Usage("--tolerance goes with --required or --required-file")),
                None => Ok(None),
            };
        };
        let Tolerance { below_db, above_db } = self.tolerance.unwrap_or(Tolerance { below_db: 0.0, above_db: None });
        Ok(Some(RequiredSpectrum::new(curve, below_db, above_db)?))
    }

    /// Returns how the quantity is shown: in the requested unit, else in that of the limit, else in that of a pulse.
    fn show(&self, limit: Option<&LimitArg>) -> Show {
        if self.output_units.is_some() {
            return self.written();
        }
        let typed = limit.and_then(|limit| limit.typed).map(|(_, unit)| unit);
        let pulse = self.excitation.pulse.iter().find_map(|pulse| pulse.unit);
        let pulse = pulse.filter(|_| self.quantity.dimension().name == ACCELERATION.name);
        Show { unit: typed.or(pulse), name: self.quantity.name()[1] }
    }

    /// Returns how CSV and JSON have the quantity: in SI unless gn is requested.
    fn written(&self) -> Show {
        let in_g = self.output_units == Some(OutputUnits::G);
        let unit = if in_g { ACCELERATION.unit("gn") } else { None };
        Show { unit, name: self.quantity.name()[1] }
    }

    fn excitation(&self) -> Result<Excitation, Failure> {
        let Excited { records, pulse, shock, pulses_file, shocks_file } = &self.excitation;
        Ok(match (shocks_file, pulses_file) {
            _ if !records.is_empty() => Excitation::Records(records::read(self)?),
            (Some(path), _) => Excitation::Shocks(VelocityShocks::new(lists::shocks(path)?)?),
            (None, Some(path)) => Excitation::Pulses(lists::pulses(path)?),
            (None, None) if !shock.is_empty() => Excitation::Shocks(VelocityShocks::new(shock.clone())?),
            (None, None) => {
                Excitation::Pulses(pulse.iter().flat_map(|PulseArg { pulses, .. }| pulses.clone()).collect())
            }
        })
    }
}

fn counted(question: &Question) -> Result<Answer<'_>, Failure> {
    let channels = question.records().iter().flat_map(|measured| measured.record.channels());
    let all: usize = channels.map(|channel| channel.values.len()).sum();
    let filtering = Counted::begin("filtering", (all * question.dampings.len()) as u64);
    spectrum::counted(question, |samples| filtering.at(samples)).map_err(|error| match error {
        Error::OfRecord { file, reason } => Failure::Record { path: file.into(), reason },
        error => error.into(),
    })
}

impl Computed<'_> {
    fn against(&self) -> Against<'_> {
        let Question { limit, required, .. } = self.answer.question;
        Against { limit: limit.as_ref(), required: required.as_ref() }
    }

    /// Returns the warnings: oddities of the records, and frequencies that the records do not cover.
    fn warnings(&self) -> Vec<String> {
        let hz = self.answer.frequencies.hz();
        let (low, high) = hz.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), hz| (low.min(*hz), high.max(*hz)));
        let mut warnings = Vec::new();
        if let Some(ranges) = self.answer.question.required.as_ref().and_then(|required| beyond(required, hz)) {
            let [from, to, low, high] = ranges.map(figures);
            warnings.push(format!(
                "the required spectrum goes from {from} to {to} Hz, and is judged from {low} to {high} Hz alone: --frequency says where"
            ));
        }
        for Measured { file, record, .. } in self.answer.question.records() {
            let path = text::path(file.as_ref());
            warnings.extend(record.findings(low).iter().map(|finding| format!("{path}: {finding}")));
            let slowest_s = record.times().iter().filter_map(|times| times.step_s()).fold(0.0, f64::max);
            let band_hz = BAND / slowest_s;
            if high > band_hz && self.args.interpolation == Interpolation::BandLimited {
                let (band, of) = (figures(band_hz), if record.times().len() > 1 { "lowest " } else { "" });
                warnings.push(format!(
                    "{path}: natural frequencies above {band} Hz, 0.4 of the {of}sampling rate, are beyond what the samples tell for sure"
                ));
            }
        }
        warnings
    }

    fn json(&self) -> WithFile<'_> {
        WithFile { answer: &self.answer, file: self.args.output.as_ref().map(|target| target.path.as_path()) }
    }

    fn write(&self, target: &Target) -> Result<(), Failure> {
        output::replace(&target.path, |file| match target.kind {
            Kind::Csv => buffered(file, |out| self.csv(out)),
            Kind::Svg => file.write_all(self.svg()?.as_bytes()),
            _ => output::json(file, &self.json()),
        })
    }

    fn svg(&self) -> Result<String, FigureError> {
        if let Some(b) = &self.answer.boundary {
            let critical = Critical {
                velocity_change: b.critical_velocity_change.unwrap_or(f64::INFINITY),
                acceleration: b.critical_acceleration,
                knee: b.knee_velocity_change.unwrap_or(f64::INFINITY),
            };
            return clatter_figures::damage_boundary(critical, &b.curve, [b.velocity_change, b.acceleration]);
        }
        if let [part] = &self.answer.parts[..] {
            return clatter_figures::spectrum(&part.spectrum, self.against());
        }
        let names: Vec<String> = self.answer.parts.iter().map(|part| self.name(part)).collect();
        let all: Vec<_> =
            self.answer.parts.iter().zip(&names).map(|(part, name)| (&part.spectrum, name.as_str())).collect();
        clatter_figures::spectra(&all, self.against())
    }

    /// Names the channel and the quality factor of a part, as far as there are several.
    fn name(&self, part: &Part) -> String {
        let several = self.answer.parts.iter().any(|other| other.spectrum.damping != part.spectrum.damping);
        let q = several.then(|| format!("Q = {}", figures(0.5 / part.spectrum.damping.get())));
        let names: Vec<_> = part.name.clone().into_iter().chain(q).collect();
        names.join(", ")
    }
}
