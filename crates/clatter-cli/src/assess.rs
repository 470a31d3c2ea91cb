//! This module is `clatter assess`: it finds which part of a product fails, in which drop, and by how much.

mod measured;
mod table;

use std::io::{self, IsTerminal, Read};
use std::path::{Path, PathBuf};

use clap::ValueHint;
use clatter_answer::assess::{self, Answer};
use clatter_assess::{Accuracy, ComponentAssessment, Verdict};
use clatter_product::{Component, LARGEST_FILE, Model, ProductFile, Reliability, units::Quantity};
use clatter_report::Pages;
use serde::Serialize;

use crate::input::is_standard;
use crate::inputs::{self, Format};
use crate::output::Files;
use crate::progress::Counted;
use crate::text::visible;
use crate::{Exit, Failure, Streams, budget, input, output, quantities, text};

/// Assess the parts of a product: which one fails, in which drop, by how much
///
/// For every limit of every part the worst drop over all stated ranges is searched, by the model with the most physics
/// that the file allows: contacts that take time where it gives their time, else instant impacts at real tilt with
/// gravity. The demand is what that drop asks for, and the command below it answers it once more.
///
/// A limit is UNSAFE where a drop was found that exceeds it; safe where energy allows no drop to exceed it, or where the
/// worst drop found leaves room for what the search may miss and its answer be off by ('good to'); else undecided, with
/// the reason and what would decide it. 'clatter init' writes a product file.
///
/// With --reliability, products are drawn for each limit that is undecided, as 'clatter scatter' draws them, each through all of its
/// drops. Where so many in a row hold that the share is sure, 299 for 99% at 95%, the limit is reliable; it is never called safe. A drop
/// that exceeds it makes it UNSAFE.
///
/// A file without `width` is answered as a bar, and the first line says so: what is wider than a quarter of its length is a plate, which
/// asks for up to 30 % more.
///
/// Where the product file names records of measured drops, the computed drop nearest to each is found as by 'clatter fit', and what it
/// tells of the product stands beside what the file states; a warning says where they differ.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter init handheld.toml && clatter assess handheld.toml
  clatter assess handheld.toml -o handheld.pdf   the printed report beside the table
  clatter assess before.toml after.toml          verdicts side by side
  clatter assess handheld.toml --tolerance=0.1%  each drop answered more exactly
  clatter assess bar.toml --model=map            of a bar: every drop by a model with less physics
  clatter assess handheld.toml --reliability=99% what is undecided is drawn: 299 products in a row
  clatter assess handheld.toml --format=json     an object; with several files, a list of them

Exit status: 0 all safe or reliable, 1 a part is unsafe or undecided, 2 bad input, 3 typst is missing or failed: no printed report.")]
pub(crate) struct Args {
    /// Product files, - for standard input; 'clatter schema' describes them for editors
    #[arg(required = true, value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath)]
    products: Vec<PathBuf>,
    /// Write the assessment as a printed report: verdict first, then each part; of one product; - writes it to standard
    /// output in place of the table. It is set by typst, see 'clatter report --help'
    #[arg(short, long, value_name = "REPORT.pdf", value_hint = ValueHint::FilePath, value_parser = output::ending("pdf"))]
    output: Option<PathBuf>,
    /// The day that the report is to tell, YYYY-MM-DD; without one it is the same from day to day
    #[arg(long, value_name = "DATE", requires = "output", value_parser = date)]
    date: Option<String>,
    /// How exact the answer to each drop is for its model, as a share of it: 0.01 or 1%
    #[arg(long, value_name = "SHARE", default_value = "1%", allow_hyphen_values = true, value_parser = inputs::tolerance)]
    tolerance: f64,
    /// Follow every drop by this model rather than by the one with the most physics; a note says what that one makes of
    /// the worst drop found
    #[arg(long, value_parser = inputs::model())]
    model: Option<Model>,
    /// Instant impacts closer than this are one: where the contact time is not known and the ranges hold a tilt that
    /// leaves less between the ends, landing flat is one of the drops
    #[arg(long, value_name = "TIME", default_value = "1ms", allow_hyphen_values = true, value_parser = quantities::contact_time)]
    merge: Quantity,
    /// Draw products for each limit that the search leaves undecided, until so many hold in a row that this share of all survives:
    /// 0.99 or 99%, from 1% to 99.999%; in place of `[verdict] reliability` of the file
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, value_parser = sure)]
    reliability: Option<f64>,
    /// How sure that is to be, likewise [default: 95%]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, value_parser = sure)]
    confidence: Option<f64>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files {
            reads: self.products.iter().map(AsRef::as_ref).collect(),
            writes: self.output.iter().map(AsRef::as_ref).collect(),
        }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        if self.output.is_some() && self.products.len() > 1 {
            return Err(Failure::Usage("'--output' takes one product file: a report is about one product"));
        }
        output::in_place_of_answer(self.output.as_deref(), matches!(self.format, Format::Table))?;
        if self.output.as_deref().is_some_and(is_standard) && io::stdout().is_terminal() {
            return Err(Failure::Usage(
                "a PDF is not written to a terminal: send it to a program or a file, as in -o - | lpr",
            ));
        }
        let mut files = Vec::with_capacity(self.products.len());
        let mut faults = Vec::new();
        for path in &self.products {
            match read(path, &self.files(), streams) {
                Ok(file) => files.push(file),
                Err(Failure::Product(fault)) => faults.push(fault),
                Err(failure) => return Err(failure),
            }
        }
        if !faults.is_empty() {
            return Err(Failure::Product(faults.join("\n\n")));
        }
        let drops = files.iter().zip(&self.products).map(|(file, path)| crate::measured::drops(file, path));
        let drops = drops.collect::<Result<Vec<_>, _>>()?;
        let accuracy = Accuracy { tolerance: self.tolerance, model: self.model, merge_s: self.merge.si };
        let assessed = |(file, path): (_, &PathBuf)| {
            watched(file, &accuracy).map_err(|error| Failure::Product(format!("error: {}: {error}", text::path(path))))
        };
        let asked =
            files.iter().map(|file| file.asked(self.reliability, self.confidence)).collect::<Result<Vec<_>, _>>()?;
        let mut answers = files.iter().zip(&self.products).map(assessed).collect::<Result<Vec<_>, _>>()?;
        for ((answer, asked), path) in answers.iter_mut().zip(asked).zip(&self.products) {
            let Some(asked) = asked else { continue };
            let drawing = Counted::heard("drawing products");
            let drawn = answer.draw(asked, &|done, all| {
                drawing.of(done, all);
                budget::go_on()
            });
            drawn.map_err(|error| Failure::Product(format!("error: {}: {error}", text::path(path))))?;
        }
        // The fits come after the assessments: whatever the records are, the verdicts come in their time.
        for (answer, drops) in answers.iter_mut().zip(drops) {
            answer.measured = drops.into_iter().map(|drop| drop.fitted(answer.file)).collect::<Result<_, _>>()?;
        }
        let shown = match (self.format, &answers[..]) {
            // The report is the answer.
            _ if self.output.as_deref().is_some_and(is_standard) => Ok(()),
            (Format::Json, [one]) => streams.json(one),
            (Format::Json, all) => {
                let named = self.products.iter().zip(all).map(|(file, answer)| Named { file, answer });
                streams.json_list(&named.collect::<Vec<_>>())
            }
            (Format::Table, [one]) => table::of_one(self.products[0].to_str().unwrap_or("-"), one, streams.out)
                .and_then(|()| measured::table(one, streams.out))
                .map_err(Failure::Answer),
            (Format::Table, all) => table::side_by_side(&self.products, all, streams.out).map_err(Failure::Answer),
        };
        for answer in &answers {
            measured::warn(answer, streams);
        }
        // The answer does not wait for its print, which may take long or fail, nor the print for a reader of the answer.
        let holds = answers.iter().all(|answer| answer.assessment.verdict <= Verdict::Reliable);
        let mut exit = if holds { Exit::Done } else { Exit::Unsafe };
        if let (Some(pdf), [answer]) = (&self.output, &answers[..]) {
            let flushed = streams.out.flush(); // whoever writes next sees the same failure, and tells
            let unwritten = format!("{} is not written", text::path(pdf));
            if !is_standard(pdf) && !budget::go_on() {
                streams.note("warning", format_args!("--time-limit is over: {unwritten}"));
                exit = Exit::Unprinted;
            } else {
                if shown.is_ok() && flushed.is_ok() && !is_standard(pdf) {
                    budget::is_told(unwritten);
                }
                self.print(answer, pdf, streams)?;
            }
        }
        shown?;
        Ok(exit)
    }

    /// Writes the printed report.
    fn print(&self, answer: &Answer<'_>, pdf: &Path, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let Answer { file, assessment, measured, .. } = answer;
        let drawing = Counted::begin("drawing", 0);
        let portraits = clatter_assess::portraits(file, assessment);
        drop(drawing);
        let remedies = {
            let changes = Counted::begin("changing", 0);
            clatter_answer::design::of_pages(file, assessment, &|done, all| {
                changes.of(done, all);
                budget::go_on()
            })?
        };
        let name = self.products[0].file_name().map_or(&*self.products[0], Path::new);
        let path = text::path(name);
        let date = self.date.as_deref();
        let pages = Pages { file, assessment, portraits: &portraits, remedies: &remedies, measured, path: &path, date };
        let printing = Counted::begin("making the printed report", 0);
        let mut progress = |step: &str| {
            printing.step(step);
            if streams.interactive {
                streams.note("clatter", step);
            }
        };
        let warnings = if is_standard(pdf) {
            let (bytes, warnings) = clatter_report::assessment_pdf(&pages, &mut progress)?;
            streams.out.write_all(&bytes).map_err(Failure::Answer)?;
            warnings
        } else {
            clatter_report::write_assessment(&pages, pdf, &mut progress)?
        };
        for warning in warnings {
            streams.note("warning", &warning);
        }
        Ok(())
    }
}

/// Reads a reliability or a confidence.
fn sure(text: &str) -> Result<f64, String> {
    let allowed = format!("'{}' is not a share from 1% to 99.999%, such as 99% or 0.99", visible(text));
    let share = inputs::share(text).map_err(|_| allowed.clone())?;
    Reliability::new(share, share).map(|_| share).map_err(|_| allowed)
}

/// Reads a day of the calendar, as ISO 8601 has it.
fn date(text: &str) -> Result<String, &'static str> {
    let parts: Vec<Option<u32>> = text.split('-').map(|part| part.parse().ok()).collect();
    let shape = text.len() == 10 && text.bytes().all(|b| b == b'-' || b.is_ascii_digit());
    let days = |year: u32, month: u32| match month {
        2 if year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400)) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    match parts[..] {
        [Some(year), Some(month @ 1..=12), Some(day)] if shape && (1..=days(year, month)).contains(&day) => {
            Ok(text.to_owned())
        }
        _ => Err("a date is written as 2026-03-31"),
    }
}

/// Makes the assessment and counts its progress; at the end of the time it returns the verdicts by then.
pub(crate) fn watched<'a>(file: &'a ProductFile, accuracy: &Accuracy) -> Result<Answer<'a>, clatter_product::Error> {
    let search = Counted::begin("searching", 0);
    assess::watched(file, accuracy, &|done, all| {
        search.of(done, all);
        budget::go_on()
    })
}

/// Does the same for one part alone.
pub(crate) fn watched_one(
    file: &ProductFile,
    component: &Component,
    accuracy: &Accuracy,
) -> Result<ComponentAssessment, clatter_product::Error> {
    let search = Counted::begin("searching", 0);
    clatter_assess::assess_one(file, component, accuracy, &|done, all| {
        search.of(done, all);
        budget::go_on()
    })
}

/// One of several answers, with its file, as products of one name are distinguished by their files.
#[derive(Serialize)]
struct Named<'a> {
    file: &'a PathBuf,
    #[serde(flatten)]
    answer: &'a Answer<'a>,
}

/// Reads the text of a file, up to the size that product files have.
pub(crate) fn text(path: &Path) -> Result<String, Failure> {
    let unreadable = |reason: io::Error| Failure::Unreadable { path: path.to_owned(), reason };
    let mut bytes = Vec::new();
    let file = input::open(path).map_err(unreadable)?;
    file.take(LARGEST_FILE as u64 + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    String::from_utf8(bytes)
        .map_err(|_| unreadable(io::Error::new(io::ErrorKind::InvalidData, "it is not text in UTF-8")))
}

/// Reads a product file, of a size that product files have, and reports its oddities. Refuses a record that it names as a file of the
/// command.
pub(crate) fn read(path: &Path, files: &Files<'_>, streams: &mut Streams<'_>) -> Result<ProductFile, Failure> {
    let text = text(path)?;
    let (file, odd) =
        ProductFile::read_warned(&text, &input::name(path)).map_err(|faults| Failure::Product(faults.to_string()))?;
    if !odd.warnings().is_empty() {
        streams.beside(&format!("{odd}\n"));
    }
    files.spare_records(&file, path)?;
    Ok(file)
}
