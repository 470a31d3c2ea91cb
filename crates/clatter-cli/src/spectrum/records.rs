//! Spectra of measured records: a channel each, and those made of several.

use std::path::{Path, PathBuf};

use clatter_record::{Channel, Record};
use clatter_shock::{DampingRatio, Frequencies, Search, Spectrum, Summary, find_shocks};

use super::Args;
use crate::numbers::figures;
use crate::progress::Counted;
use crate::{Failure, text};

/// A record that was read, and made ready.
pub(super) struct Measured {
    pub(super) path: PathBuf,
    pub(super) record: Record,
    /// Which of its shocks, where they are told apart.
    pub(super) shock: Option<String>,
}

/// Shocks of one record that have spectra at most.
const MOST: usize = 100;

/// A record as its shocks, as `clatter record --find` finds them on the channel with the largest one: of all channels, from half the
/// quiet time before a shock to the next one.
fn apart(search: &Search, Measured { path, record, .. }: &Measured) -> Result<Vec<Measured>, Failure> {
    let bad = |reason| Failure::Record { path: path.clone(), reason };
    let Some(channel) = record.channels().iter().max_by(|a, b| largest(a).total_cmp(&largest(b))) else {
        return Ok(Vec::new());
    };
    let times = channel.times();
    let step_s = times.even("a search for shocks").map_err(bad)?;
    let found = find_shocks(&channel.values, step_s, search).map_err(|error| bad(error.into()))?;
    let count = found.shocks.len() + found.omitted;
    if count == 0 || count > MOST {
        let beyond = figures(found.threshold_m_s2);
        let path = text::path(path);
        return Err(Failure::Wrong(format!(
            "{path}: {count} shocks beyond {beyond} m/s2; spectra are made of 1 to {MOST}: see --threshold and --quiet"
        )));
    }
    let starts: Vec<f64> =
        found.shocks.iter().map(|shock| times.start_s() + shock.start_s - 0.5 * search.quiet_s).collect();
    let ends = starts.iter().copied().skip(1).chain([f64::INFINITY]);
    let one = |(n, (from_s, to_s)): (usize, (f64, f64))| {
        let at = figures(times.start_s() + found.shocks[n].peak_time_s);
        let shock = Some(format!("shock {} at {at} s", n + 1));
        Ok(Measured { path: path.clone(), record: record.clone().window(from_s, to_s).map_err(bad)?, shock })
    };
    starts.iter().copied().zip(ends).enumerate().map(one).collect()
}

/// What is made of several spectra.
#[derive(Debug, Clone, Copy, Default, clap::Args)]
#[command(next_help_heading = "Of several channels or records")]
pub(crate) struct Several {
    /// Also the resultant of the channels of each record: the root of the sum of their squares, which the length of the response
    /// vector does not exceed
    #[arg(long)]
    resultant: bool,
    /// Also the envelope: the largest of all channels of all records
    #[arg(long)]
    envelope: bool,
    /// Also the mean of all channels of all records and 3 dB
    #[arg(long)]
    mean_3db: bool,
}

impl Several {
    /// The flag that was given.
    pub(super) fn given(self) -> Option<&'static str> {
        let given = [(self.resultant, "--resultant"), (self.envelope, "--envelope"), (self.mean_3db, "--mean-3db")];
        given.into_iter().find(|(given, _)| *given).map(|(_, flag)| flag)
    }
}

pub(super) fn read(args: &Args) -> Result<Vec<Measured>, Failure> {
    let one = |path: &PathBuf| {
        let record = args.condition.apply(args.reading.read(path)?, path)?;
        let whole = Measured { path: path.clone(), record, shock: None };
        match args.finding.search() {
            Some(search) => apart(&search, &whole),
            None => Ok(vec![whole]),
        }
    };
    let records: Vec<Vec<Measured>> = args.excitation.records.iter().map(one).collect::<Result<_, _>>()?;
    Ok(records.into_iter().flatten().collect())
}

/// A spectrum for each channel and damping ratio, then those made of several.
pub(super) fn spectra(
    args: &Args,
    records: &[Measured],
    list: &Frequencies,
    dampings: &[DampingRatio],
) -> Result<Vec<(Option<String>, Spectrum)>, Failure> {
    if args.several.resultant {
        for Measured { path, record, .. } in records {
            record.one_time("a resultant").map_err(|reason| Failure::Record { path: path.clone(), reason })?;
        }
    }
    let count: usize = records.iter().map(|measured| measured.record.channels().len()).sum();
    let all: usize =
        records.iter().flat_map(|measured| measured.record.channels()).map(|channel| channel.values.len()).sum();
    let filtering = Counted::begin("filtering", (all * dampings.len()) as u64);
    let mut done = 0;
    let mut found = Vec::new();
    for damping in dampings {
        let mut of_channels: Vec<Spectrum> = Vec::with_capacity(count);
        let mut resultants = Vec::new();
        let mut names = Vec::new();
        for Measured { path, record, shock } in records {
            let first = of_channels.len();
            // A record by its file where there are several of them, and a shock by its number.
            let file = (args.excitation.records.len() > 1).then(|| called(path));
            let within = |name: &str| {
                let named = record.channels().len() > 1 || name == RESULTANT || file.is_none() && shock.is_none();
                let parts = [file.clone(), named.then(|| name.to_owned())];
                let name = parts.into_iter().flatten().collect::<Vec<_>>().join(": ");
                let shock = shock.clone().into_iter();
                Some(name).filter(|name| !name.is_empty()).into_iter().chain(shock).collect::<Vec<_>>().join(", ")
            };
            for channel in record.channels() {
                let quantity = args.quantity.quantity();
                let progress = |samples| filtering.at(done + samples);
                let spectrum = channel.spectrum(list, *damping, quantity, args.interpolation.into(), progress);
                of_channels.push(spectrum.map_err(|reason| Failure::Record { path: path.clone(), reason })?);
                done += channel.values.len() as u64;
                names.push((count > 1).then(|| within(&text::visible(&channel.name))));
            }
            let axes: Vec<&Spectrum> = of_channels[first..].iter().collect();
            if args.several.resultant {
                resultants.extend(
                    Spectrum::summary(&axes, Summary::RootSumSquare)
                        .map(|spectrum| (Some(within(RESULTANT)), spectrum)),
                );
            }
        }
        let every: Vec<&Spectrum> = of_channels.iter().collect();
        let summaries = [
            (args.several.envelope, Summary::Envelope, "envelope"),
            (args.several.mean_3db, Summary::MeanPlus3Db, "mean + 3 dB"),
        ];
        let summaries: Vec<_> = summaries
            .into_iter()
            .filter(|(asked, ..)| *asked)
            .filter_map(|(_, summary, name)| Some((Some(name.to_owned()), Spectrum::summary(&every, summary)?)))
            .collect();
        found.extend(names.into_iter().zip(of_channels));
        found.extend(resultants);
        found.extend(summaries);
    }
    Ok(found)
}

/// A record by the name of its file, without its folders.
fn called(path: &Path) -> String {
    path.file_name().map_or_else(|| text::path(path), |name| text::path(Path::new(name)))
}

const RESULTANT: &str = "resultant";

pub(super) fn largest(channel: &Channel) -> f64 {
    channel.values.iter().fold(0.0_f64, |most, a| most.max(a.abs()))
}
