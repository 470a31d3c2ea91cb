//! This module is `clatter study merge`: it makes the answer of all parts of a study.

use std::fs::File;
use std::path::{Path, PathBuf};

use clap::ValueHint;
use clatter_answer::study::{Answer, Merge, Parts, Study};
use clatter_product::Plan;
use clatter_record::RowGroups;

use super::table;
use crate::inputs::RowFormat;
use crate::output::Files;
use crate::progress::Counted;
use crate::{Exit, Failure, Streams, scatter, text};

/// Tell what the parts of a study say together
///
/// All parts are needed, each once, of one plan and of this version; their order is of no account. Of each part some rows are drawn again
/// and held against it. The answer is that of 'clatter
/// scatter' where it follows each drop by the model with the most physics, for each product of the grid: how likely its parts survive,
/// with the interval of Clopper and Pearson. Of a search it is the verdict on each limit.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter study merge part*.parquet
  clatter study merge parts/                          all in a folder
  clatter study merge part*.parquet --target=99.9%    exit status 1 where that is not sure
  clatter study merge part*.parquet --format=csv      a row for each product and part

Exit status: 0 done, 1 the target is missed, or of a search a part is unsafe or undecided, 2 bad input.")]
pub(super) struct Args {
    /// Files of 'clatter study', all parts of one plan, or folders of them
    #[arg(required = true, value_name = "PART.parquet", value_hint = ValueHint::AnyPath)]
    parts: Vec<PathBuf>,
    /// How sure the intervals are, between 0 and 1
    #[arg(long, value_name = "P", default_value = "0.95", allow_hyphen_values = true, value_parser = scatter::confidence)]
    confidence: f64,
    /// Survival of all parts of each product that is to be sure, as a share: 0.999 or 99.9%
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, value_parser = scatter::target)]
    target: Option<f64>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

impl Args {
    pub(super) fn files(&self) -> Files<'_> {
        Files { reads: self.parts.iter().map(AsRef::as_ref).collect(), writes: Vec::new() }
    }

    pub(super) fn run(&self, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        let paths = all_of(&self.parts)?;
        let mut parts = Parts::default();
        for path in &paths {
            let part = open(path)?;
            parts.add(&text::path(path), |name| part.note(name))?;
        }
        let (plan, product) = parts.plan_and_product().unwrap_or_default();
        let first = text::path(&paths[0]);
        let plan =
            Plan::read(plan, &format!("the plan in {first}")).map_err(|faults| Failure::Product(faults.to_string()))?;
        let study = Study::new(plan, product, &format!("the product in {first}"))?;
        if self.target.is_some() && study.plan().search {
            return Err(Failure::Usage("'--target' is of drops that are drawn, and the plan is a search"));
        }
        let mut answer = self.merged(&paths, &parts, &study)?;
        answer.target = self.target;
        let out = &mut *streams.out;
        match self.format {
            RowFormat::Table => table::table(&answer, out).map_err(Failure::Answer)?,
            RowFormat::Csv => table::csv(&answer, out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.json(&answer)?,
        }
        Ok(if answer.holds() { Exit::Done } else { Exit::Unsafe })
    }

    fn merged<'a>(&self, paths: &[PathBuf], parts: &Parts, study: &'a Study) -> Result<Answer<'a>, Failure> {
        let fields: Vec<String> = study.fields().into_iter().map(|field| field.name).collect();
        let columns = study.counted();
        let counted = Counted::begin("merging", study.rows());
        let mut merge = Merge::new(study, self.confidence)?;
        for (i, rows) in parts.in_order(study)? {
            let path = &paths[i];
            let mut part = open(path)?;
            let all: u64 = part.rows().iter().map(|rows| *rows as u64).sum();
            if part.names() != fields || all != rows.end - rows.start {
                return Err(damaged(path, "its columns or rows are not those of its plan"));
            }
            let (mut first, again) = (rows.start, study.again(&rows));
            for group in 0..part.rows().len() {
                let next = first + part.rows()[group] as u64;
                for row in again.iter().filter(|row| (first..next).contains(row)) {
                    let of_row =
                        |column: usize| Ok(part.read(group, column)?[usize::try_from(row - first).unwrap_or(0)]);
                    let told: Result<Vec<f64>, _> = (0..fields.len()).map(of_row).collect();
                    let told = told.map_err(|reason| torn(path, reason))?;
                    study.check(*row, &told).map_err(|error| damaged(path, &error.to_string()))?;
                }
                first = next;
                let read = columns.iter().map(|column| part.read(group, *column));
                let read = read.collect::<Result<Vec<_>, _>>().map_err(|reason| torn(path, reason))?;
                let slices: Vec<&[f64]> = read.iter().map(Vec::as_slice).collect();
                merge.take(&slices).map_err(|error| damaged(path, &error.to_string()))?;
                counted.at(merge.taken());
            }
        }
        Ok(merge.finish()?)
    }
}

/// Returns the files, in place of each folder those in it that end in .parquet, by name.
fn all_of(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut all = Vec::new();
    for path in paths {
        if !path.is_dir() {
            all.push(path.clone());
            continue;
        }
        let unreadable = |reason| Failure::Unreadable { path: path.clone(), reason };
        let entries = std::fs::read_dir(path).and_then(Iterator::collect::<Result<Vec<_>, _>>).map_err(unreadable)?;
        let is_part = |path: &PathBuf| path.extension().is_some_and(|end| end == "parquet") && path.is_file();
        let mut found: Vec<PathBuf> = entries.into_iter().map(|entry| entry.path()).filter(is_part).collect();
        if found.is_empty() {
            return Err(Failure::Wrong(format!("no file in {} ends in .parquet", text::path(path))));
        }
        found.sort();
        all.extend(found);
    }
    Ok(all)
}

fn open(path: &Path) -> Result<RowGroups<File>, Failure> {
    let file = File::open(path).map_err(|reason| Failure::Unreadable { path: path.to_owned(), reason })?;
    RowGroups::new(file).map_err(|reason| torn(path, reason))
}

fn torn(path: &Path, reason: clatter_record::Error) -> Failure {
    Failure::Record { path: path.to_owned(), reason }
}

fn damaged(path: &Path, what: &str) -> Failure {
    Failure::Wrong(format!("{} is damaged: {what}", text::path(path)))
}
