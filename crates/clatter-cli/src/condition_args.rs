//! This module prepares a record before it is used.

use std::path::Path;

use clap::ValueEnum;
use clatter_product::units::{FREQUENCY, TIME};
use clatter_record::{Baseline, PRE_SHOCK_SHARE, Pass, Record};

use crate::Failure;
use crate::inputs::parts;
use crate::quantities::plain_or_typed;

/// What is done with a record, in this order: a window, the baseline, filters.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Before a record is used")]
pub(crate) struct ConditionArgs {
    /// Keep the samples between two times of the record alone, in s without a unit
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true, value_parser = window)]
    window: Option<[f64; 2]>,
    /// Take out an offset: the mean, a straight line (least squares), or the mean before the shock
    #[arg(long, value_enum, value_name = "BASELINE")]
    detrend: Option<BaselineName>,
    /// Take out what is below this frequency, in Hz without a unit: Butterworth, four poles forward and backward, without phase,
    /// −3 dB there
    #[arg(long, value_name = "HZ", value_parser = frequency)]
    high_pass: Option<f64>,
    /// Take out what is above this frequency, likewise: 1650 Hz is CFC 1000 of SAE J211
    #[arg(long, value_name = "HZ", value_parser = frequency)]
    low_pass: Option<f64>,
}

/// Which offset is taken out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum BaselineName {
    /// The mean of the whole record
    Mean,
    /// The straight line through it, by least squares
    Linear,
    /// The mean of the samples before the shock
    PreShock,
}

/// The number of poles of one pass; forward and backward they are four.
const POLES: u32 = 2;

fn window(text: &str) -> Result<[f64; 2], String> {
    let [from, to] = parts(text, ':')[..] else {
        return Err("a window is FROM:TO, such as 0.1:0.2 or 100ms:200ms".to_owned());
    };
    let [from, to] = [plain_or_typed(&TIME, from)?.si, plain_or_typed(&TIME, to)?.si];
    if from < to { Ok([from, to]) } else { Err(format!("a window from {from:?} s to {to:?} s is empty")) }
}

fn frequency(text: &str) -> Result<f64, String> {
    let hz = plain_or_typed(&FREQUENCY, text)?.si;
    if hz > 0.0 && hz.is_finite() { Ok(hz) } else { Err(format!("{hz:?} is not finite and > 0")) }
}

impl ConditionArgs {
    /// Returns the flag of an option that was given, for where there is no record that it could apply to.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let given = [
            (self.window.is_some(), "--window"),
            (self.detrend.is_some(), "--detrend"),
            (self.high_pass.is_some(), "--high-pass"),
            (self.low_pass.is_some(), "--low-pass"),
        ];
        given.into_iter().find(|(given, _)| *given).map(|(_, flag)| flag)
    }

    /// Does it.
    pub(crate) fn apply(&self, record: Record, path: &Path) -> Result<Record, Failure> {
        let bad = |reason| Failure::Record { path: path.to_owned(), reason };
        let mut record = match self.window {
            Some([from_s, to_s]) => record.window(from_s, to_s).map_err(bad)?,
            None => record,
        };
        let baseline = self.detrend.map(|name| match name {
            BaselineName::Mean => Baseline::Mean,
            BaselineName::Linear => Baseline::Linear,
            BaselineName::PreShock => Baseline::PreShock { share: PRE_SHOCK_SHARE },
        });
        if let Some(baseline) = baseline {
            record.without_baseline(baseline).map_err(bad)?;
        }
        for (pass, hz) in [(Pass::High, self.high_pass), (Pass::Low, self.low_pass)] {
            if let Some(hz) = hz {
                record.filter(pass, hz, POLES).map_err(bad)?;
            }
        }
        Ok(record)
    }
}
