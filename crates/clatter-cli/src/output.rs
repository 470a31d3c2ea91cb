//! Files as outputs.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};

use same_file::Handle;

use crate::Failure;
use crate::input::is_standard;

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
    /// By its ending, one of those of `kinds`, of which there are two or more.
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
        let (last, others) = names.split_last().map_or(("", &[][..]), |(last, others)| (last.as_str(), others));
        Err(format!("the file must end in {} or {last}", others.join(", ")))
    }
}

/// Why standard output is not taken where the ending of a file says what is written.
pub(crate) fn no_kind(endings: &[impl AsRef<str>]) -> String {
    let endings: Vec<_> = endings.iter().map(AsRef::as_ref).collect();
    format!(
        "- is standard output, which has no ending that says what to write: give a file ending in {}",
        endings.join(", ")
    )
}

/// A file that ends in this one way, or standard output.
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

/// [`clatter_report::replace`], with the file that could not be written in the message.
pub(crate) fn replace(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> Result<(), Failure> {
    clatter_report::replace(path, write).map_err(|reason| Failure::File { path: path.to_owned(), reason })
}

/// [`clatter_report::create`], likewise.
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
    /// Standard input can be read once.
    pub(crate) fn check_input(&self) -> Result<(), Failure> {
        let count = self.reads.iter().filter(|input| is_standard(input)).count();
        if count < 2 {
            Ok(())
        } else {
            Err(Failure::Usage("- is standard input, which can be read once: name one file as -"))
        }
    }

    /// What would go wrong after the work is told before it: a directory that is not there, and an output that would be written
    /// over an input or another output, by whatever name.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        for (n, output) in self.writes.iter().enumerate().filter(|(_, output)| !is_standard(output)) {
            let there = clatter_report::directory_of(output);
            there.map_err(|reason| Failure::File { path: output.to_path_buf(), reason })?;
            let same = |other: &&Path| same_file::is_same_file(output, other).unwrap_or(output == other);
            // Standard input may be a file that has a name as well.
            let is_input = || Handle::from_path(output).ok().zip(Handle::stdin().ok()).is_some_and(|(a, b)| a == b);
            if self.reads.iter().any(|input| if is_standard(input) { is_input() } else { same(input) }) {
                return Err(Failure::Overwrites(output.to_path_buf()));
            }
            if self.writes[..n].iter().filter(|other| !is_standard(other)).any(same) {
                return Err(Failure::Twice(output.to_path_buf()));
            }
        }
        Ok(())
    }
}
