//! This module is `clatter report`: it writes the printed reports.

use std::path::PathBuf;

use clap::{ValueEnum, ValueHint};
use clatter_studies::Report;
use serde::Serialize;

use crate::inputs::Format;
use crate::progress::Counted;
use crate::text::visible;
use crate::{Failure, Streams};

/// Make the printed reports: figures, tables and the PDF
#[derive(Debug, clap::Args)]
#[command(long_about = LONG_ABOUT, after_help = "\
Examples:
  clatter report                   all reports, into ./report
  clatter report paper -o out")]
pub(crate) struct Args {
    /// Which report
    #[arg(value_enum, default_value_t = Which::All)]
    which: Which,
    /// Directory to write into; made if need be
    #[arg(value_parser = directory, short, long, value_name = "DIR", default_value = "report", value_hint = ValueHint::DirPath)]
    output: PathBuf,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

const LONG_ABOUT: &str = "\
Make the printed reports: figures, tables and the PDF

The PDF needs typst; figures, tables and JSON come out without it. typst is found by the variable CLATTER_TYPST, \
then on the PATH, then in the project's own cache. If it is nowhere, it is put there once: fetched with python3 and pip, \
some 10 seconds, or, where that cannot be done, built with cargo, 7 to 12 minutes. CLATTER_NO_INSTALL=1 forbids both.";

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Which {
    /// The paper's figures, its table and its claims, computed anew
    Paper,
    /// What a plate that lands on its corners does beyond a bar
    Plate,
    /// What the clatter does to a suspended part
    Shock,
    /// How exact all of it is, at every extreme
    Accuracy,
    /// Every report there is
    All,
}

impl Which {
    fn reports(self) -> &'static [Report] {
        match self {
            Self::Paper => &[Report::Paper],
            Self::Plate => &[Report::Plate],
            Self::Shock => &[Report::Shock],
            Self::Accuracy => &[Report::Accuracy],
            Self::All => &[Report::Paper, Report::Plate, Report::Shock, Report::Accuracy],
        }
    }
}

#[derive(Serialize)]
struct Answer {
    files: Vec<String>,
    warnings: Vec<String>,
}

fn directory(text: &str) -> Result<PathBuf, &'static str> {
    if text == "-" { Err("reports are several files: give a directory, not standard output") } else { Ok(text.into()) }
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let mut answer = Answer { files: Vec::new(), warnings: Vec::new() };
        for &report in self.which.reports() {
            let making = Counted::begin("making the report", 0);
            let mut progress = |step: &str| {
                making.step(step);
                if streams.interactive {
                    streams.note("clatter", step);
                }
            };
            let written = clatter_studies::write(report, &self.output, &mut progress)?;
            for warning in &written.warnings {
                streams.note("warning", warning);
            }
            answer.files.extend(written.files.iter().map(|file| file.display().to_string()));
            answer.warnings.extend(written.warnings);
        }
        match self.format {
            Format::Table => {
                let mut files = answer.files.iter();
                files.try_for_each(|file| writeln!(streams.out, "{}", visible(file))).map_err(Failure::Answer)
            }
            Format::Json => streams.json(&answer),
        }
    }
}
