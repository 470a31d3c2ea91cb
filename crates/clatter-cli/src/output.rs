//! This module writes files as outputs.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};

use clatter_answer::Versioned;
use clatter_product::ProductFile;
use same_file::Handle;
use serde::Serialize;

use crate::input::is_standard;
use crate::{Failure, measured};

/// A file to write, and what its ending says it is.
#[derive(Debug, Clone)]
pub(crate) struct Target {
    pub(crate) path: PathBuf,
    pub(crate) kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Csv,
    Json,
    Npy,
    Parquet,
    Svg,
}

impl Kind {
    fn ending(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Json => "json",
            Self::Npy => "npy",
            Self::Parquet => "parquet",
            Self::Svg => "svg",
        }
    }
}

impl Target {
    /// Takes the kind of a file from its ending, which is one of those of `kinds`, of which there are two or more.
    pub(crate) fn of(text: &str, kinds: &[Kind]) -> Result<Self, String> {
        let path = PathBuf::from(text);
        if is_standard(&path) {
            return Err(no_kind(&kinds.iter().map(|kind| format!(".{}", kind.ending())).collect::<Vec<_>>()));
        }
        let ending = path.extension().and_then(|ending| ending.to_str());
        if let Some(&kind) = kinds.iter().find(|kind| Some(kind.ending()) == ending) {
            return Ok(Self { path, kind });
        }
        let names: Vec<_> = kinds.iter().map(|kind| format!(".{}", kind.ending())).collect();
        Err(format!(
            "the file must end in {}",
            match names.split_last() {
                Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
                _ => names.concat(),
            }
        ))
    }
}

/// Returns the reason why standard output is refused where the ending of a file decides the kind of output.
pub(crate) fn no_kind(endings: &[impl AsRef<str>]) -> String {
    let endings: Vec<_> = endings.iter().map(AsRef::as_ref).collect();
    format!(
        "- is standard output, which has no ending that says what to write: give a file ending in {}",
        endings.join(", ")
    )
}

/// Reads the name of a file that ends in this one way, or standard output.
pub(crate) fn ending(ending: &'static str) -> impl Fn(&str) -> Result<PathBuf, String> + Clone + Send + Sync {
    move |text| {
        let path = PathBuf::from(text);
        let good = is_standard(&path) || path.extension().is_some_and(|given| given == ending);
        if good { Ok(path) } else { Err(format!("the file must end in .{ending}")) }
    }
}

/// Refuses a format of the answer where something else is written to standard output in its place.
pub(crate) fn in_place_of_answer(output: Option<&Path>, is_table: bool) -> Result<(), Failure> {
    if output.is_some_and(is_standard) && !is_table {
        return Err(Failure::Usage("--format is that of the answer, and -o - takes its place: leave one of them out"));
    }
    Ok(())
}

/// Writes through a buffer, all of it.
pub(crate) fn buffered(
    file: &mut File,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, file);
    write(&mut out)?;
    out.flush()
}

/// Writes an answer as a file for programs.
pub(crate) fn json(file: &mut File, answer: &impl Serialize) -> io::Result<()> {
    buffered(file, |out| Ok(serde_json::to_writer(out, &Versioned::new(answer))?))
}

/// Replaces a file as [`clatter_report::replace`] does; the message names the file that could not be written.
pub(crate) fn replace(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> Result<(), Failure> {
    clatter_report::replace(path, write).map_err(|reason| Failure::File { path: path.to_owned(), reason })
}

/// Creates a file as [`clatter_report::create`] does, with the same message.
pub(crate) fn create(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> Result<(), Failure> {
    clatter_report::create(path, write).map_err(|reason| Failure::File { path: path.to_owned(), reason })
}

/// The files that a command reads and those that it writes.
#[derive(Debug, Default)]
pub(crate) struct Files<'a> {
    pub(crate) reads: Vec<&'a Path>,
    pub(crate) writes: Vec<&'a Path>,
}

impl Files<'_> {
    /// Refuses more than one use of standard input, which can be read once.
    pub(crate) fn check_input(&self) -> Result<(), Failure> {
        let count = self.reads.iter().filter(|input| is_standard(input)).count();
        if count < 2 {
            Ok(())
        } else {
            Err(Failure::Usage("- is standard input, which can be read once: name one file as -"))
        }
    }

    /// Checks before the work that its outputs can be written. Refuses an output that cannot be written, or that would be written over an
    /// input, another output or a write-protected file, by whatever name. An input and a protected file may be `forced`.
    pub(crate) fn check(&self, forced: bool) -> Result<(), Failure> {
        let mut places: Vec<PathBuf> = Vec::new();
        for output in self.writes.iter().filter(|output| !is_standard(output)) {
            let place = place_of(output)?;
            if !forced && self.reads.iter().any(|input| is_input(&place, input)) {
                return Err(Failure::Overwrites(output.to_path_buf()));
            }
            if places.iter().any(|other| is_same(&place, other)) {
                return Err(Failure::Twice(output.to_path_buf()));
            }
            if let Some(stream) = stream_to(&place) {
                return Err(Failure::Stream { path: output.to_path_buf(), stream });
            }
            if !forced && clatter_report::is_protected(&place) {
                return Err(Failure::Protected(output.to_path_buf()));
            }
            places.push(place);
        }
        Ok(())
    }

    /// Refuses an output that is a record which a product file names: what was measured is never written over.
    pub(crate) fn spare_records(&self, file: &ProductFile, product: &Path) -> Result<(), Failure> {
        for output in self.writes.iter().filter(|output| !is_standard(output)) {
            let place = place_of(output)?;
            let named = file.records.iter().map(|record| measured::path_of(&record.file, product));
            if named.into_iter().any(|record| is_input(&place, &record)) {
                return Err(Failure::NamedRecord { path: output.to_path_buf(), product: product.to_owned() });
            }
        }
        Ok(())
    }
}

/// Returns the place of an output, if the output can stand there.
fn place_of(output: &Path) -> Result<PathBuf, Failure> {
    let place = clatter_report::place_of(output).and_then(|place| {
        clatter_report::takes_files(clatter_report::directory_of(&place)?)?;
        Ok(place)
    });
    place.map_err(|reason| Failure::File { path: output.to_owned(), reason })
}

/// Returns whether an output is a file that is read. Pipes and devices are not, and are not opened: that would take data from them, or
/// wait.
fn is_input(place: &Path, input: &Path) -> bool {
    if is_standard(input) {
        // Standard input may be a file that has a name as well.
        return leads_to(place, Handle::stdin());
    }
    clatter_report::place_of(input).is_ok_and(|input| is_same(place, &input))
}

/// Returns whether two places, of existing files or not, are the same.
fn is_same(a: &Path, b: &Path) -> bool {
    a == b || same_file::is_same_file(a, b).unwrap_or(false) || clatter_report::differ_by_case_alone(a, b)
}

/// Returns the stream of the process that a file takes, if any.
fn stream_to(place: &Path) -> Option<&'static str> {
    let streams = [(Handle::stdout(), "standard output"), (Handle::stderr(), "standard error")];
    streams.into_iter().find_map(|(stream, name)| leads_to(place, stream).then_some(name))
}

fn leads_to(place: &Path, stream: io::Result<Handle>) -> bool {
    place.is_file() && Handle::from_path(place).ok().zip(stream.ok()).is_some_and(|(a, b)| a == b)
}
