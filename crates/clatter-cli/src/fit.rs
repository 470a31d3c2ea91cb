//! This module is `clatter fit`: it finds the data of a product from a measured drop.

mod table;

use std::fs::File;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use clap::{ArgAction, ValueHint};
use clatter_answer::Error;
use clatter_answer::fit::{self, Answer, Question};
use clatter_product::{LARGEST_FILE, ProductFile, units::Quantity};

use crate::inputs::Format;
use crate::measured;
use crate::numbers::given;
use crate::output::{Files, no_kind};
use crate::progress::Counted;
use crate::quantities::{self, Place, neat};
use crate::record_args::RecordArgs;
use crate::{Failure, Streams, assess, input, output, text};

/// Fit the data of a product to a measured drop: restitution, radius of gyration, contact time, how it fell
///
/// Finds the drop of the product that is nearest to what was measured, how far each value may be off (95 %), and what the data
/// cannot tell. Each file is a record of the same drop; its first line says which kind:
///
///   time_s,end                       times of strikes; end a or b, or nothing where it is not known
///   time_s,height_a_m,height_b_m     heights of both ends over the ground, from a video
///   bounce_s                         times at which a flat product, or one point of it, bounces; alone
///   interval_s                       the same by the times between bounces
///   time and acceleration, with units, as 'clatter record' reads them: the acceleration at --position
///
/// Each may be in any notation of records and in other units: `time [ms];end`, `t [s],y a [mm],y b [mm]`.
///
/// The time axis of each file begins anywhere. Every strike is taken for one of the drop and none for missing, as long as that
/// explains the data; else two may be missing before the last one, or one time may be wrong. The answer says so, and where several of
/// these are about as good it has them all, in its intervals too. Contacts take time in the fit where the product file gives their
/// time or an acceleration was measured; else strikes are instant, at real tilt and with gravity.
///
/// A speed, a restitution or a contact time that the data do not tell is taken from the range of the product file; one value counts
/// as exact. What is found beyond those ranges is told. Times that scatter more than --timing explains are no fit.
///
/// Intervals know of the noise of the record alone: from drop to drop a real product scatters more. Fit several, and take the range
/// of all.
///
/// What the data cannot tell is held at the value of the product file. -o writes what was found into a copy of it (.toml), or draws
/// measured beside computed (.svg).
#[derive(Debug, clap::Args)]
#[command(
    verbatim_doc_comment,
    after_help = "\
Examples:
  clatter fit strikes.csv --product=bar.toml
  clatter fit strikes.csv --product=bar.toml --timing=10us -o fitted.toml -o fitted.svg
  clatter fit video.csv --product=bar.toml --format=json
  clatter fit sensor.csv --position=30mm --product=bar.toml

Exit status: 0 done, 2 bad input, or no drop that comes near what was measured."
)]
pub(crate) struct Args {
    /// Records of one drop, - for standard input
    #[arg(required = true, value_name = "RECORD.csv", value_hint = ValueHint::FilePath)]
    records: Vec<PathBuf>,
    /// Product file: length, center of mass, gravity, and where the search begins
    #[arg(long, value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath)]
    product: PathBuf,
    /// Where an acceleration was measured: a length from the middle towards end b, or a position in [-1, 1]; once for each record of an
    /// acceleration, in their order
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = quantities::place_of_bar)]
    position: Vec<Place>,
    #[command(flatten)]
    reading: RecordArgs,
    /// Standard deviation of the times of strikes and bounces, such as 10us; unless given, their scatter about the fit tells it
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = quantities::contact_time)]
    timing: Option<Quantity>,
    /// Take the radius of gyration of the product file as known: strike times then tell the restitution several times better
    #[arg(long)]
    known_gyration: bool,
    /// Write the ranges into a copy of the product file (.toml), or draw measured beside computed (.svg); may be given twice
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target, action = ArgAction::Append)]
    output: Vec<Target>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

/// A file to write.
#[derive(Debug, Clone)]
struct Target {
    path: PathBuf,
    is_picture: bool,
}

fn target(text: &str) -> Result<Target, String> {
    let path = PathBuf::from(text);
    if input::is_standard(&path) {
        return Err(no_kind(&[".toml", ".svg"]));
    }
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("toml") => Ok(Target { path, is_picture: false }),
        Some("svg") => Ok(Target { path, is_picture: true }),
        _ => Err("the file must end in .toml or .svg".to_owned()),
    }
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        let reads = self.records.iter().chain([&self.product]).map(AsRef::as_ref).collect();
        Files { reads, writes: self.output.iter().map(|target| target.path.as_path()).collect() }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let wants_copy = self.output.iter().any(|target| !target.is_picture);
        if wants_copy && input::is_standard(&self.product) {
            return Err(Failure::Usage("a copy of the product file needs it as a file: give its name with --product"));
        }
        let file = assess::read(&self.product, &self.files(), streams)?;
        let question = self.question(&file)?;
        let answer = {
            let _fitting = Counted::begin("fitting", 0);
            fit::answer(&question).map_err(|error| self.refused(error))?
        };
        for target in &self.output {
            if target.is_picture {
                let picture = clatter_figures::fit(&answer.fit)?;
                output::replace(&target.path, |out| out.write_all(picture.as_bytes()))?;
            } else {
                self.copy(&answer, &target.path, streams)?;
            }
        }
        match self.format {
            Format::Table => table::table(&answer, streams.out).map_err(Failure::Answer),
            Format::Json => streams.json(&answer),
        }
    }

    fn question<'a>(&self, file: &'a ProductFile) -> Result<Question<'a>, Failure> {
        let mut places = self.position.iter();
        let half_m = 0.5 * file.product.body.length_m();
        let beyond_m = file.product.body.feet.map_or(0.0, |feet| feet.inset_m[0]);
        let timing_s = self.timing.map(|timing| timing.si);
        let read = |path: &PathBuf| {
            let position = || {
                let Some(place) = places.next() else { return Ok(None) };
                Ok(Some(half_m * quantities::position(*place, "--position", half_m, beyond_m)?))
            };
            measured::read(path, position, timing_s, &self.reading)
        };
        let mut question = Question::new(file, self.records.iter().map(read).collect::<Result<_, _>>()?);
        if places.next().is_some() {
            return Err(Failure::Usage(
                "--position goes with a record of an acceleration, one each: there are more of them",
            ));
        }
        question.timing_s = timing_s;
        question.gyration_known = self.known_gyration;
        Ok(question)
    }

    fn refused(&self, error: Error) -> Failure {
        match error {
            Error::GyrationRange(range) => {
                let [lo, hi] = range.map(|m| given(neat(1e3 * m)));
                Failure::Wrong(format!(
                    "--known-gyration takes the radius of gyration of the file as known, and it gives a range, {lo} to {hi} mm"
                ))
            }
            error => measured::why(error, &self.records),
        }
    }

    /// Writes the copy of the product file with the results of the fit.
    fn copy(&self, answer: &Answer<'_>, path: &Path, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let source = &self.product;
        let unreadable = |reason| Failure::Unreadable { path: source.clone(), reason };
        let mut text = String::new();
        let file = File::open(source).map_err(unreadable)?;
        file.take(LARGEST_FILE as u64).read_to_string(&mut text).map_err(unreadable)?;
        let written = answer
            .written(&text)
            .map_err(|error| Failure::Wrong(format!("{} cannot take what was found: {error}", text::path(source))))?;
        output::replace(path, |out| out.write_all(written.text.as_bytes()))?;
        for note in written.notes {
            streams.note("note", note);
        }
        Ok(())
    }
}
