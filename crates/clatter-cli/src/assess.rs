//! `clatter assess`: which part of a product fails, in which drop, and by how much.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use clap::ValueHint;
use clatter_scene::{
    Accuracy, Assessment, ComponentAssessment, LARGEST_FILE, LimitAssessment, ProductFile, Unit, Verdict,
};

use crate::inputs::{self, Format};
use crate::numbers::figures;
use crate::text::{column, shown};
use crate::{Exit, Failure, Streams};

/// Assess the parts of a product: which one fails, in which drop, by how much
///
/// For every limit of every component the worst drop over all stated ranges is found. Without gravity, for small tilt
/// and for parts to which an impact is a velocity shock, the demand is proven: no drop of the ranges passes it. Where
/// more physics counts, the ranges are searched, each drop by the cheapest models within the tolerance ('clatter
/// explain' tells which and why), and the table says so. 'clatter init' writes a product file.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter init handheld.toml && clatter assess handheld.toml
  clatter assess handheld.toml -o handheld.pdf   the printed report beside the table
  clatter assess before.toml after.toml          verdicts side by side
  clatter assess handheld.toml --tolerance=0.1%  by closer models
  clatter assess handheld.toml --model=compliant every drop by the model with most physics
  clatter assess handheld.toml --format=json     an object; with several files, a list of them

Exit status: 0 all safe, 1 a component is unsafe, 2 bad input.")]
pub(crate) struct Args {
    /// Product files; 'clatter schema' describes them for editors
    #[arg(required = true, value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath)]
    products: Vec<PathBuf>,
    /// Write the assessment as a printed report: verdict first, then each part; of one product
    #[arg(short, long, value_name = "REPORT.pdf", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// What models may get wrong in drops that are searched, as a share of the demand: 0.01 or 1%
    #[arg(long, value_name = "SHARE", default_value = "1%", allow_hyphen_values = true, value_parser = inputs::tolerance)]
    tolerance: f64,
    /// Follow every drop that is searched by this model of the bar, rather than by the cheapest within the tolerance;
    /// what is proven without gravity stands beside it. A warning says how far off it may be in the drop that it finds
    /// worst; in others it may be further off
    #[arg(long, value_enum)]
    model: Option<inputs::BarName>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        if self.output.is_some() && self.products.len() > 1 {
            return Err(Failure::Usage("'--output' takes one product file: a report is about one product"));
        }
        let mut files = Vec::with_capacity(self.products.len());
        let mut faults = Vec::new();
        for path in &self.products {
            match read(path) {
                Ok(file) => files.push(file),
                Err(Failure::Product(fault)) => faults.push(fault),
                Err(failure) => return Err(failure),
            }
        }
        if !faults.is_empty() {
            return Err(Failure::Product(faults.join("\n\n")));
        }
        let accuracy = Accuracy { tolerance: self.tolerance, model: self.model.map(Into::into) };
        let assessments = files
            .iter()
            .zip(&self.products)
            .map(|(file, path)| {
                file.assess_to(&accuracy)
                    .map_err(|error| Failure::Product(format!("error: {}: {error}", path.display())))
            })
            .collect::<Result<Vec<_>, _>>()?;
        if let (Some(pdf), [file], [assessment]) = (&self.output, &files[..], &assessments[..]) {
            print(file, assessment, pdf, streams)?;
        }
        match (self.format, &assessments[..]) {
            (Format::Json, [one]) => streams.json(one)?,
            (Format::Json, all) => streams.json(&all)?,
            (Format::Table, [one]) => table(one, streams.out).map_err(Failure::Answer)?,
            (Format::Table, all) => side_by_side(all, streams.out).map_err(Failure::Answer)?,
        }
        let safe = assessments.iter().all(|a| a.verdict == Verdict::Safe);
        Ok(if safe { Exit::Done } else { Exit::Unsafe })
    }
}

/// The printed report.
fn print(file: &ProductFile, assessment: &Assessment, pdf: &Path, streams: &mut Streams<'_>) -> Result<(), Failure> {
    let portraits = file.portraits(assessment).map_err(|error| Failure::Product(format!("error: {error}")))?;
    let mut progress = |step: &str| {
        if streams.interactive {
            streams.note("clatter", step);
        }
    };
    if let Some(warning) = clatter_report::write_assessment(file, assessment, &portraits, pdf, &mut progress)? {
        streams.note("warning", warning);
    }
    Ok(())
}

/// A product file, of a size that product files have.
pub(crate) fn read(path: &Path) -> Result<ProductFile, Failure> {
    let unreadable = |reason: io::Error| Failure::Unreadable { path: path.to_owned(), reason };
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    file.take(LARGEST_FILE as u64 + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    let text = String::from_utf8(bytes)
        .map_err(|_| unreadable(io::Error::new(io::ErrorKind::InvalidData, "it is not text in UTF-8")))?;
    ProductFile::read(&text, &path.display().to_string()).map_err(|faults| Failure::Product(faults.to_string()))
}

/// A value in the unit that people use for it.
pub(crate) fn in_words(unit: Unit, value: f64) -> String {
    let (factor, name) = match unit {
        Unit::MeterPerSecondSquared => (1.0 / clatter_scene::STANDARD_GRAVITY_M_S2, "gn"),
        Unit::Meter => (1e3, "mm"),
        Unit::MeterPerSecond => (1.0, "m/s"),
        Unit::RadianPerSecond => (1.0, "rad/s"),
    };
    format!("{} {name}", four(factor * value))
}

/// Four significant digits: more no drop is known to.
pub(crate) fn four(x: f64) -> String {
    let digits = figures(x);
    match digits.split_once('.') {
        Some((whole, _)) if !digits.contains('e') && x.is_finite() => {
            let places = 4_usize.saturating_sub(whole.trim_start_matches(['-', '0']).len());
            format!("{x:.places$}")
        }
        _ => digits,
    }
}

fn percent(margin: f64) -> String {
    if margin.is_infinite() { "infinite".to_owned() } else { format!("{:+.1} %", 100.0 * margin) }
}

/// Demands of search are not proven.
fn proof(limit: &LimitAssessment) -> String {
    format!("{}, {}", limit.model.bar.name(), if limit.guaranteed { "proven" } else { "searched" })
}

fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Safe => "safe",
        Verdict::Unsafe => "UNSAFE",
    }
}

/// The drop that does it.
fn drop(limit: &LimitAssessment) -> String {
    let worst = &limit.worst_case;
    let frequency = worst.frequency_hz.map_or(String::new(), |f| format!(", {} Hz", four(f)));
    format!(
        "{} first, {} deg, {} m/s, e {}{frequency}, impact {} at {} ms",
        inputs::letter(worst.first),
        four(worst.tilt_deg),
        four(worst.speed_m_s),
        four(worst.restitution),
        worst.impact,
        four(1e3 * worst.time_s),
    )
}

fn table(assessment: &Assessment, out: &mut dyn Write) -> io::Result<()> {
    let failing = assessment.components.iter().filter(|c| c.verdict == Verdict::Unsafe).count();
    let count = assessment.components.len();
    let name = shown(&assessment.product, 60);
    match failing {
        0 => writeln!(out, "{name} is safe: every limit holds in the worst drop")?,
        _ => writeln!(out, "{name} is UNSAFE: {failing} of {count} components")?,
    }
    writeln!(out)?;
    let name = |c: &ComponentAssessment| shown(&c.name, 24);
    let wide = assessment.components.iter().map(|c| column(&name(c), 0).1).max().unwrap_or(0).max(9);
    let head = format!(
        "{:<24} {:>12} {:>12} {:>9} {:>12}  {:<21}",
        "limit", "allowed", "demand", "margin", "flat drop", "model"
    );
    writeln!(out, "{} {:<7} {head} worst drop", column("component", wide).0, "verdict")?;
    for component in &assessment.components {
        for (i, limit) in component.limits.iter().enumerate() {
            let (first, said) =
                if i == 0 { (name(component), verdict(component.verdict)) } else { (String::new(), "") };
            writeln!(
                out,
                "{} {said:<7} {:<24} {:>12} {:>12} {:>9} {:>12}  {:<21} {}",
                column(&first, wide).0,
                limit.limit.name(),
                in_words(limit.unit, limit.allowed),
                in_words(limit.unit, limit.demand),
                percent(limit.margin),
                in_words(limit.unit, limit.clatter_free),
                proof(limit),
                drop(limit),
            )?;
        }
    }
    writeln!(out)?;
    writeln!(out, "Flat drop: one impact without clatter, (1 + e) v0 everywhere at once, as drop standards assume.")?;
    for component in &assessment.components {
        writeln!(out, "{}: {}.", name(component), component.model.reason)?;
        if let Some(warning) = &component.tightest().warning {
            writeln!(out, "{}: warning: {warning}.", name(component))?;
        }
    }
    Ok(())
}

/// Margins of several products, a column each.
fn side_by_side(assessments: &[Assessment], out: &mut dyn Write) -> io::Result<()> {
    let mut rows: Vec<(String, &'static str)> = Vec::new();
    for assessment in assessments {
        for component in &assessment.components {
            for limit in &component.limits {
                let row = (component.name.clone(), limit.limit.name());
                if !rows.contains(&row) {
                    rows.push(row);
                }
            }
        }
    }
    let wide = rows.iter().map(|(name, _)| column(&shown(name, 24), 0).1).max().unwrap_or(0).max(9);
    let heads: Vec<_> = assessments.iter().map(|a| shown(&a.product, 20)).collect();
    let widths: Vec<_> = heads.iter().map(|head| column(head, 0).1.max(10)).collect();
    let line = |first: &str, second: &str, cells: &[String]| {
        let mut line = format!("{} {second:<24}", column(first, wide).0);
        for (cell, width) in cells.iter().zip(&widths) {
            let padding = width.saturating_sub(column(cell, 0).1);
            line.extend(["  ", &" ".repeat(padding), cell.as_str()]);
        }
        line
    };
    writeln!(out, "{}", line("component", "margin of", &heads))?;
    for (name, limit) in &rows {
        let cell = |assessment: &Assessment| {
            let component = assessment.components.iter().find(|c| c.name == *name);
            let found = component.and_then(|c| c.limits.iter().find(|l| l.limit.name() == *limit));
            found.map_or("-".to_owned(), |l| percent(l.margin))
        };
        let cells: Vec<_> = assessments.iter().map(cell).collect();
        writeln!(out, "{}", line(&shown(name, 24), limit, &cells))?;
    }
    let verdicts: Vec<_> = assessments.iter().map(|a| verdict(a.verdict).to_owned()).collect();
    writeln!(out, "{}", line("", "verdict", &verdicts))
}
