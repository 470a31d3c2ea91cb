//! This module is `clatter study`: it draws a plan that is larger than one machine, one shard at a time, and answers from all shards.

mod merge;
mod table;

use std::fs::File;
use std::io::{self, BufWriter, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use clap::ValueHint;
use clatter_answer::study::{Shard, Study};
use clatter_product::{LARGEST_FILE, Plan, ProductFile};
use clatter_record::{RowGroupWriter, RowGroups};
use serde::Serialize;

use crate::inputs::Format;
use crate::output::{self, Files, Kind, Target};
use crate::progress::Counted;
use crate::{Exit, Failure, Streams, input, text};

/// Draw a part of a study that is larger than one machine, and merge all parts
///
/// A plan names a product file and how many drops of it are drawn as by 'clatter scatter', each answered by the model with the most
/// physics; with a grid, of each of the products that have other values there. With search = true in place of samples, the worst drop of
/// each product is searched as by 'clatter assess'.
///
/// A drop depends on the plan and its number alone: --shard=I/N draws the I-th of N parts, on any machine and in any order. Its rows go to
/// a Parquet file, in SI, with plan, product, seed and version in it. The file is there once it is whole; a run that was killed is run
/// again, and a part that is there already is left as it is unless --force is given. 'clatter study merge' takes all parts and gives the
/// same answer to the last bit, whatever N is.
#[derive(Debug, clap::Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    disable_help_subcommand = true,
    after_help = "\
A plan:
  product = \"handheld.toml\"
  samples = 1e6
  seed = 7
  [grid]
  product.restitution = [0.2, [0.3, 0.4]]
  component.camera.natural_frequency = \"80 Hz:120 Hz:5\"

Examples:
  clatter study plan.toml -o whole.parquet
  clatter study plan.toml --shard=2/7 -o part2.parquet   on any machine
  clatter study merge part*.parquet                      the answer of all seven

Exit status: 0 done, 2 bad input. Of merge also 1: the target is missed, or of a search a part is unsafe or undecided."
)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Option<Command>,
    /// Plan of the study
    #[arg(required = true, value_name = "PLAN.toml", value_hint = ValueHint::FilePath)]
    plan: Option<PathBuf>,
    /// Which part: the I-th of N, from 1/N to N/N
    #[arg(long, value_name = "I/N", default_value = "1/1", allow_hyphen_values = true)]
    shard: Shard,
    /// File of its rows, ending in .parquet
    #[arg(short, long, required = true, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = parquet)]
    output: Option<PathBuf>,
    /// How to show what was done
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    Merge(merge::Args),
}

fn parquet(text: &str) -> Result<PathBuf, String> {
    Target::of(text, &[Kind::Parquet]).map(|target| target.path)
}

/// The finished shard of a study.
#[derive(Serialize)]
struct Done<'a> {
    part: &'a Path,
    shard: [u64; 2],
    /// The first row, and the one after the last.
    rows: [u64; 2],
    of: u64,
    /// True where the file was there already.
    skipped: bool,
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        match &self.command {
            Some(Command::Merge(merge)) => merge.files(),
            None => Files {
                reads: self.plan.iter().map(AsRef::as_ref).collect(),
                writes: self.output.iter().map(AsRef::as_ref).collect(),
            },
        }
    }

    pub(crate) fn run(&self, force: bool, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        match (&self.command, &self.plan, &self.output) {
            (Some(Command::Merge(merge)), ..) => merge.run(streams),
            (None, Some(plan), Some(output)) => self.part(plan, output, force, streams),
            _ => unreachable!("required without a subcommand"),
        }
    }

    fn part(&self, plan: &Path, output: &Path, force: bool, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        let study = read(plan, output, force, streams)?;
        let rows = study.rows_of(self.shard)?;
        let notes = study.notes(self.shard)?;
        let skipped = !force && is_there(output, &notes, rows.end - rows.start)?;
        if !skipped {
            let counted = Counted::begin("drawing", rows.end - rows.start);
            let done = AtomicU64::new(0);
            let count = |more| counted.at(done.fetch_add(more, Ordering::Relaxed) + more);
            output::replace(output, |file| {
                let mut writer = RowGroupWriter::new(BufWriter::with_capacity(1 << 16, file), study.fields())?;
                study.write(rows.clone(), &count, |group| writer.write(group))?;
                let notes: Vec<_> = notes.iter().map(|(name, note)| (*name, note.as_str())).collect();
                writer.finish(&notes)?.flush()
            })?;
        }
        let Shard { index, of } = self.shard;
        let done = Done { part: output, shard: [index, of], rows: [rows.start, rows.end], of: study.rows(), skipped };
        match self.format {
            Format::Json => streams.json(&done)?,
            Format::Table => {
                let (name, last, all) = (text::path(output), rows.end - 1, study.rows());
                let what = if skipped { "is there already, with" } else { "has" };
                let again = if skipped { "; --force makes it again" } else { "" };
                writeln!(
                    streams.out,
                    "{name} {what} rows {} to {last} of {all}, shard {}{again}",
                    rows.start, self.shard
                )
                .map_err(Failure::Answer)?;
            }
        }
        Ok(Exit::Done)
    }
}

/// Reads a plan and its product, whose path in the plan is relative to the plan.
fn read(path: &Path, output: &Path, force: bool, streams: &mut Streams<'_>) -> Result<Study, Failure> {
    let plan =
        Plan::read(&text_of(path)?, &input::name(path)).map_err(|faults| Failure::Product(faults.to_string()))?;
    let product = path.parent().unwrap_or(Path::new("")).join(&plan.product);
    Files { reads: vec![path, &product], writes: vec![output] }.check(force)?;
    let (text, origin) = (text_of(&product)?, input::name(&product));
    let study = Study::new(plan, &text, &origin)?;
    let odd = ProductFile::read_warned(&text, &origin).map_err(|faults| Failure::Product(faults.to_string()))?.1;
    if !odd.warnings().is_empty() {
        streams.beside(&format!("{odd}\n"));
    }
    Ok(study)
}

/// Reads the text of a file, of a size that product files have.
fn text_of(path: &Path) -> Result<String, Failure> {
    let unreadable = |reason: io::Error| Failure::Unreadable { path: path.to_owned(), reason };
    let mut text = String::new();
    input::open(path)
        .and_then(|file| file.take(LARGEST_FILE as u64 + 1).read_to_string(&mut text))
        .map_err(unreadable)?;
    Ok(text)
}

/// Returns whether a file holds this very part; refuses to write over any other file.
fn is_there(path: &Path, notes: &[(&str, String)], rows: u64) -> Result<bool, Failure> {
    let Ok(file) = File::open(path) else { return Ok(false) };
    let part = RowGroups::new(file).map_err(|reason| {
        Failure::Wrong(format!(
            "{} is there already, and no part that can be read: --force makes it anew ({reason})",
            text::path(path)
        ))
    })?;
    let all: u64 = part.rows().iter().map(|rows| *rows as u64).sum();
    let same = all == rows && notes.iter().all(|(name, note)| part.note(name) == Some(note));
    if same { Ok(true) } else { Err(Failure::OtherPart(path.to_owned())) }
}
