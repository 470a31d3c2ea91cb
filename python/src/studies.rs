//! This module draws studies in shards into files, and merges them.

use std::fs::File;
use std::io::{self, BufWriter, Read, Write};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use clatter_answer::study::{Answer, Merge, Parts, Shard, Study};
use clatter_product::{LARGEST_FILE, Plan, ProductFile, visible};
use clatter_record::{RowGroupWriter, RowGroups};
use pyo3::prelude::*;
use serde::Serialize;

use crate::answered::{Answered, Refused, json, without_picture};
use crate::given::{Given, parts, whole};
use crate::products::target;
use crate::words;
use crate::work::{self, Wanted};

/// The finished shard of a study, as the command reports it.
#[derive(Serialize)]
struct Done<'a> {
    part: &'a Path,
    shard: [u64; 2],
    rows: [u64; 2],
    of: u64,
    skipped: bool,
}

/// The bounds of the numbers of shards.
const SHARDS: RangeInclusive<u64> = 0..=(1 << 63) - 1;

/// Draws a shard of a plan into a file, and returns its JSON and the oddities of the product.
#[pyfunction]
pub(crate) fn study(py: Python<'_>, given: Given<'_>) -> PyResult<(String, String)> {
    let (plan, output) = (given.read::<PathBuf>("plan")?, given.read::<PathBuf>("output")?);
    let [index, of] = parts("shard", &given.value("shard")?, "(i, n)")?;
    let [index, of] = [whole("shard", &index, SHARDS)?, whole("shard", &of, SHARDS)?];
    let force = given.read("force")?;
    given.done()?;
    let (plan, text, origin) = work::read(py, move |_| planned(&plan))??;
    Ok(work::done(py, move |wanted| draw((plan, &text, &origin), Shard { index, of }, &output, force, wanted))??)
}

/// Reads a plan, and the text of its product with the name of that file.
fn planned(path: &Path) -> Result<(Plan, String, String), Refused> {
    let plan = Plan::read(&text_of(path)?, &path.to_string_lossy()).map_err(words)?;
    let product = path.parent().unwrap_or(Path::new("")).join(&plan.product);
    Ok((plan, text_of(&product)?, product.to_string_lossy().into_owned()))
}

fn draw(
    (plan, text, origin): (Plan, &str, &str),
    shard: Shard,
    output: &Path,
    force: bool,
    wanted: &Wanted,
) -> Result<(String, String), Refused> {
    let study = Study::new(plan, text, origin).map_err(words)?;
    let odd = ProductFile::read_warned(text, origin).map_err(words)?.1;
    let warnings = if odd.warnings().is_empty() { String::new() } else { odd.to_string() };
    let (rows, notes) = (study.rows_of(shard).map_err(words)?, study.notes(shard).map_err(words)?);
    let skipped = !force && is_there(output, &notes, rows.end - rows.start)?;
    if !skipped {
        let written = clatter_report::replace(output, |file| {
            let mut writer = RowGroupWriter::new(BufWriter::with_capacity(1 << 16, file), study.fields())?;
            study.write(rows.clone(), &|_| (), |group| {
                wanted.or_leave();
                writer.write(group)
            })?;
            let notes: Vec<_> = notes.iter().map(|(name, note)| (*name, note.as_str())).collect();
            writer.finish(&notes)?.flush()
        });
        written.map_err(|error| Refused::System(output.to_owned(), error))?;
    }
    let Shard { index, of } = shard;
    let done = Done { part: output, shard: [index, of], rows: [rows.start, rows.end], of: study.rows(), skipped };
    Ok((json(&done)?, warnings))
}

/// Returns whether a file holds this very part; refuses to write over any other file.
fn is_there(path: &Path, notes: &[(&str, String)], rows: u64) -> Result<bool, Refused> {
    if !path.exists() {
        return Ok(false);
    }
    let same = sought(path).ok().and_then(|file| RowGroups::new(file).ok()).is_some_and(|part| {
        let all: u64 = part.rows().iter().map(|rows| *rows as u64).sum();
        all == rows && notes.iter().all(|(name, note)| part.note(name) == Some(note))
    });
    let other = || {
        Refused::Words(format!(
            "{} is there already, and is not this shard: choose another name, or give force",
            name(path)
        ))
    };
    if same { Ok(true) } else { Err(other()) }
}

/// Returns the answer of all shards of a plan.
#[pyfunction]
pub(crate) fn merge(py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
    let (parts, confidence) = (given.value("parts")?.extract::<Vec<PathBuf>>()?, given.read("confidence")?);
    let target = target(&given)?;
    given.done()?;
    without_picture(py, move |wanted| {
        let mut told = Parts::default();
        for path in &parts {
            let part = open(path)?;
            told.add(&name(path), |key| part.note(key)).map_err(words)?;
        }
        let (plan, product) = told.plan_and_product().unwrap_or_default();
        let first = parts.first().map_or_else(String::new, |path| name(path));
        let plan = Plan::read(plan, &format!("the plan in {first}")).map_err(words)?;
        let study = Study::new(plan, product, &format!("the product in {first}")).map_err(words)?;
        if target.is_some() && study.plan().search {
            return Err("target is of drops that are drawn, and the plan is a search".to_owned().into());
        }
        let mut answer = merged(&parts, &told, &study, confidence, wanted)?;
        answer.target = target;
        Ok::<_, Refused>(json(&answer)?)
    })
}

fn merged<'a>(
    paths: &[PathBuf],
    parts: &Parts,
    study: &'a Study,
    confidence: f64,
    wanted: &Wanted,
) -> Result<Answer<'a>, Refused> {
    let fields: Vec<String> = study.fields().into_iter().map(|field| field.name).collect();
    let columns = study.counted();
    let mut merge = Merge::new(study, confidence).map_err(words)?;
    for (i, rows) in parts.in_order(study).map_err(words)? {
        let path = &paths[i];
        let damaged = |what: &dyn std::fmt::Display| Refused::Words(format!("{} is damaged: {what}", name(path)));
        let mut part = open(path)?;
        let all: u64 = part.rows().iter().map(|rows| *rows as u64).sum();
        if part.names() != fields || all != rows.end - rows.start {
            return Err(damaged(&"its columns or rows are not those of its plan"));
        }
        let (mut first, again) = (rows.start, study.again(&rows));
        for group in 0..part.rows().len() {
            wanted.or_leave();
            let next = first + part.rows()[group] as u64;
            for row in again.iter().filter(|row| (first..next).contains(row)) {
                let of_row = |column: usize| Ok(part.read(group, column)?[usize::try_from(row - first).unwrap_or(0)]);
                let told: Result<Vec<f64>, _> = (0..fields.len()).map(of_row).collect();
                let told = told.map_err(|error| torn(path, &error))?;
                study.check(*row, &told).map_err(|error| damaged(&error))?;
            }
            first = next;
            let read = columns.iter().map(|column| part.read(group, *column));
            let read = read.collect::<Result<Vec<_>, _>>().map_err(|error| torn(path, &error))?;
            merge.take(&read.iter().map(Vec::as_slice).collect::<Vec<_>>()).map_err(|error| damaged(&error))?;
        }
    }
    Ok(merge.finish().map_err(words)?)
}

fn open(path: &Path) -> Result<RowGroups<File>, Refused> {
    let file = sought(path).map_err(|error| Refused::System(path.to_owned(), error))?;
    RowGroups::new(file).map_err(|error| torn(path, &error))
}

/// Opens a file at whose end one may begin; to open a pipe would wait for who writes to it.
fn sought(path: &Path) -> io::Result<File> {
    if path.metadata()?.is_file() { File::open(path) } else { Err(io::Error::other("it is no file on a disk")) }
}

fn torn(path: &Path, error: &clatter_record::Error) -> Refused {
    Refused::Words(format!("{}: {error}", name(path)))
}

fn name(path: &Path) -> String {
    visible(&path.to_string_lossy()).into_owned()
}

/// Reads the text of a file, of a size that product files have.
pub(crate) fn text_of(path: &Path) -> Result<String, Refused> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(LARGEST_FILE as u64 + 1).read_to_end(&mut bytes));
    read.map_err(|error| Refused::System(path.to_owned(), error))?;
    let wrong = |what: &str| Refused::Words(format!("{}: {what}", name(path)));
    if bytes.len() > LARGEST_FILE {
        return Err(wrong(&format!("it is larger than a product file, of {LARGEST_FILE} bytes at most")));
    }
    String::from_utf8(bytes).map_err(|_| wrong("it is not text in UTF-8"))
}
