//! This module reads measured records, prepares them, and combines several of them.

use std::path::{Path, PathBuf};

use clatter_answer::Error;
use clatter_answer::spectrum::Measured;

use super::Args;
use crate::numbers::figures;
use crate::{Failure, text};

/// What is made of several spectra.
#[derive(Debug, Clone, Copy, Default, clap::Args)]
#[command(next_help_heading = "Of several channels or records")]
pub(crate) struct Several {
    /// Also the resultant of the channels of each record: the root of the sum of their squares, which the length of the response
    /// vector does not exceed; a channel that is the resultant of the others already is left out of it
    #[arg(long)]
    pub(super) resultant: bool,
    /// Also the envelope: the largest of all channels of all records
    #[arg(long)]
    pub(super) envelope: bool,
    /// Also the mean of all channels of all records and 3 dB
    #[arg(long)]
    pub(super) mean_3db: bool,
}

impl Several {
    /// Returns the flag that was given.
    pub(super) fn given(self) -> Option<&'static str> {
        let given = [(self.resultant, "--resultant"), (self.envelope, "--envelope"), (self.mean_3db, "--mean-3db")];
        given.into_iter().find(|(given, _)| *given).map(|(_, flag)| flag)
    }
}

pub(super) fn read(args: &Args) -> Result<Vec<Measured>, Failure> {
    let one = |path: &PathBuf| {
        let record = args.condition.apply(args.reading.read(path)?, path)?;
        // A record is named by its file where there are several of them.
        let name = (args.excitation.records.len() > 1).then(|| called(path));
        let whole = Measured { file: path.to_string_lossy().into_owned(), name, record, shock: None };
        match args.finding.search() {
            Some(search) => whole.apart(&search).map_err(|error| refused(path, error)),
            None => Ok(vec![whole]),
        }
    };
    let records: Vec<Vec<Measured>> = args.excitation.records.iter().map(one).collect::<Result<_, _>>()?;
    Ok(records.into_iter().flatten().collect())
}

fn refused(path: &Path, error: Error) -> Failure {
    match error {
        Error::Record(reason) => Failure::Record { path: path.to_owned(), reason },
        Error::Shocks { count, threshold_m_s2, most } => Failure::Wrong(format!(
            "{}: {count} shocks beyond {} m/s2; spectra are made of 1 to {most}: see --threshold and --quiet",
            text::path(path),
            figures(threshold_m_s2)
        )),
        error => error.into(),
    }
}

/// Names a record by its file, without the folders.
fn called(path: &Path) -> String {
    path.file_name().map_or_else(|| text::path(path), |name| text::path(Path::new(name)))
}
