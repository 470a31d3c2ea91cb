//! This module reads files of measured records as arguments of commands.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use clatter_answer::fit;
use clatter_product::{
    RecordFile,
    units::{ACCELERATION, FREQUENCY},
};
use clatter_record::{Options, Pick, Record, Units};

use crate::progress::Counted;
use crate::quantities::plain_or_typed;
use crate::{Failure, input};

/// What a record does not say of itself.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Reading a record")]
pub(crate) struct RecordArgs {
    /// Column of time, by its name or its number, where it is not found by itself
    #[arg(long, value_name = "COLUMN", value_parser = pick)]
    time: Option<Pick>,
    /// Column of acceleration, likewise; may be given several times [default: all that there are]
    #[arg(long, value_name = "COLUMN", value_parser = pick)]
    acceleration: Vec<Pick>,
    /// Units of a record that does not name them, such as ms,g or mm/s2
    #[arg(long, value_name = "TIME,ACCELERATION", value_parser = units)]
    units: Option<Units>,
    /// Samples a second, in Hz without a unit, in place of a column of time
    #[arg(long, value_name = "HZ", value_parser = rate)]
    sample_rate: Option<f64>,
    /// What full scale is, such as 50g, in a file that counts in shares of it
    #[arg(long, value_name = "ACCELERATION", value_parser = full_scale)]
    full_scale: Option<f64>,
    /// What the sensor gives for an acceleration, such as 100mV/g, for channels in volts
    #[arg(long, value_name = "VOLTAGE/ACCELERATION", value_parser = sensitivity)]
    sensitivity: Option<f64>,
    /// The sensor whose rows are read, where rows of several come in turns
    #[arg(long, value_name = "NAME")]
    sensor: Option<String>,
    /// Which record of a file is read, from 1, where it holds several
    #[arg(long, value_name = "NUMBER", value_parser = number)]
    record: Option<usize>,
    /// Leave out lines that cannot be used; each is told
    #[arg(long)]
    skip_bad: bool,
}

fn pick(text: &str) -> Result<Pick, std::convert::Infallible> {
    text.parse()
}

fn units(text: &str) -> Result<Units, String> {
    text.parse().map_err(|error: clatter_record::Error| error.to_string())
}

fn rate(text: &str) -> Result<f64, String> {
    positive(plain_or_typed(&FREQUENCY, text)?.si)
}

fn full_scale(text: &str) -> Result<f64, String> {
    positive(plain_or_typed(&ACCELERATION, text)?.si)
}

fn sensitivity(text: &str) -> Result<f64, String> {
    clatter_record::sensitivity(text).map_err(|error| error.to_string())
}

fn number(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|number| *number > 0).ok_or_else(|| format!("'{text}' is no whole number from 1 on"))
}

fn positive(value: f64) -> Result<f64, String> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(format!("{value:?} is not finite and > 0")) }
}

impl RecordArgs {
    /// Takes the settings for a record from a product file.
    pub(crate) fn of(record: &RecordFile, path: &Path) -> Result<Self, Failure> {
        let options = fit::options(record).map_err(|reason| Failure::Record { path: path.to_owned(), reason })?;
        let Options { accelerations: acceleration, units, sample_rate_hz: sample_rate, .. } = options;
        Ok(Self { acceleration, units, sample_rate, ..Self::default() })
    }

    /// Returns the flag of an option that was given, for where there is no record that it could apply to.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let given = [
            (self.time.is_some(), "--time"),
            (!self.acceleration.is_empty(), "--acceleration"),
            (self.units.is_some(), "--units"),
            (self.sample_rate.is_some(), "--sample-rate"),
            (self.full_scale.is_some(), "--full-scale"),
            (self.sensitivity.is_some(), "--sensitivity"),
            (self.sensor.is_some(), "--sensor"),
            (self.record.is_some(), "--record"),
            (self.skip_bad, "--skip-bad"),
        ];
        given.into_iter().find(|(given, _)| *given).map(|(_, flag)| flag)
    }

    /// Reads the record of a file, or of standard input.
    pub(crate) fn read(&self, path: &Path) -> Result<Record, Failure> {
        let unreadable = |error: io::Error| Failure::Record {
            path: path.to_owned(),
            reason: clatter_record::Error::Read(error.to_string()),
        };
        if input::is_standard(path) {
            return self.read_from(path, io::stdin().lock());
        }
        self.read_from(path, File::open(path).map_err(unreadable)?)
    }

    /// Reads the record from the content of a file.
    pub(crate) fn read_from(&self, path: &Path, from: impl Read) -> Result<Record, Failure> {
        let options = Options {
            time: self.time.clone(),
            accelerations: self.acceleration.clone(),
            units: self.units.clone(),
            sample_rate_hz: self.sample_rate,
            full_scale_m_s2: self.full_scale,
            sensitivity_v_s2_m: self.sensitivity,
            sensor: self.sensor.clone(),
            record: self.record,
            skip_bad: self.skip_bad,
            ..Options::default()
        };
        let bad = |reason| Failure::Record { path: path.to_owned(), reason };
        let size = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file).map_or(0, |metadata| metadata.len());
        let reading = Counted::begin("reading", size);
        Record::read(from, &options, |bytes| reading.at(bytes)).map_err(bad)
    }
}

/// Returns the advice to the user about an error.
pub(crate) fn remedy(error: &clatter_record::Error) -> &'static str {
    match error {
        clatter_record::Error::Lines(_) => "\n--skip-bad goes on without them",
        clatter_record::Error::Columns(_) => {
            " (--time=COLUMN, --acceleration=COLUMN by name or number; --sample-rate=HZ in place of times)"
        }
        clatter_record::Error::Times { .. } => " (--acceleration=COLUMN takes channels of one of them)",
        clatter_record::Error::Units(_) => " (--units=TIME,ACCELERATION such as ms,g; --full-scale)",
        _ => "",
    }
}
