//! Spectra of measured records: a channel each, and those made of several.

use std::path::{Path, PathBuf};

use clatter_record::{Channel, Record};
use clatter_shock::{DampingRatio, Frequencies, Spectrum, Summary};

use super::Args;
use crate::progress::Counted;
use crate::{Failure, text};

/// A record that was read, and made ready.
pub(super) struct Measured {
    pub(super) path: PathBuf,
    pub(super) record: Record,
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
        Ok(Measured { path: path.clone(), record })
    };
    args.excitation.record.iter().map(one).collect()
}

/// A spectrum for each channel and damping ratio, then those made of several.
pub(super) fn spectra(
    args: &Args,
    records: &[Measured],
    list: &Frequencies,
    dampings: &[DampingRatio],
) -> Result<Vec<(Option<String>, Spectrum)>, Failure> {
    if args.several.resultant {
        for Measured { path, record } in records {
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
        for Measured { path, record } in records {
            let first = of_channels.len();
            // A record by its file where there are several of them.
            let file = (records.len() > 1).then(|| called(path));
            let within = |name: &str| match &file {
                Some(file) if record.channels().len() > 1 || name == RESULTANT => format!("{file}: {name}"),
                Some(file) => file.clone(),
                None => name.to_owned(),
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
