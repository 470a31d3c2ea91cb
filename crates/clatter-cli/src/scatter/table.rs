//! This module writes the result of all samples, as a table for people and as rows.

use std::io::{self, Write};

use clatter_answer::scatter::Answer;
use clatter_assess::scatter::{
    ComponentScatter, Driver, LandingComponent, PlateAs, Probability, Scatter, Settings, Varied,
};
use clatter_product::{Input, ProductFile};

use super::name_of;
use crate::columns::{Table, sentence};
use crate::numbers::{digits, figures, given};
use crate::text::{field, shown};

/// Inputs that explain less than this share are not named.
const NAMED: f64 = 0.01;
/// The standard deviation, by chance alone, of the share of an input without influence, times the number of samples.
const NOISE: f64 = 7.9;

/// Returns the name of an input in a table; an input that a part alone has is called the part's own.
fn called(input: &Varied) -> &'static str {
    match input {
        Varied::Drop(input, _) => input.row().words,
        Varied::Frequency(_) => "own frequency",
        Varied::Damping(_) => "own damping",
        Varied::Position(_) => "own place",
        Varied::Across(_) => "own place across",
        Varied::Limit(..) => "own limit",
        Varied::CriticalAcceleration(_) => "own critical acceleration",
        other => other.name(),
    }
}

/// Returns the name of an input, with the drop that it belongs to where there are several.
fn of_drop(file: &ProductFile, input: &Varied) -> String {
    let name = called(input);
    input.landing().map_or_else(|| name.to_owned(), |n| format!("{name} {}", file.drop_names()[n].there()))
}

/// Returns the direction of an input's effect, where the trend accounts for at least half of the effect.
fn way(driver: &Driver) -> &'static str {
    let share = driver.share;
    match (&driver.input, share.trend * share.trend >= 0.5 * share.variance, share.trend > 0.0) {
        // Two values have no way in between.
        (Varied::Drop(Input::First, _), _, true) => " (b)",
        (Varied::Drop(Input::First, _), _, false) => " (a)",
        (_, false, _) => "~",
        (_, true, true) => "+",
        (_, true, false) => "-",
    }
}

/// Writes an estimate; "-" where there is no answer.
pub(crate) fn estimated(survival: &Probability) -> String {
    survival.estimate.map_or_else(|| "-".to_owned(), hundredths)
}

/// Writes a probability as a percentage.
pub(crate) fn hundredths(p: f64) -> String {
    if p >= 1.0 { "100".to_owned() } else { figures(100.0 * p) }
}

pub(crate) fn table(answer: &Answer<'_>, out: &mut dyn Write) -> io::Result<()> {
    let Answer { file, scatter, target, .. } = answer;
    let Settings { samples, seed, confidence, .. } = scatter.settings;
    let (product, sure) = (shown(&file.product.name, 60), given(100.0 * confidence));
    let has_list = !scatter.landings.is_empty();
    if has_list {
        let drops = match scatter.landings.len() {
            1 => "its drop".to_owned(),
            n => format!("its {n} drops, one after the other"),
        };
        writeln!(out, "{product}: {samples} products drawn with seed {seed}; each goes through {drops}")?;
    } else {
        writeln!(out, "{product}: {samples} drops drawn with seed {seed}")?;
    }
    sentence(out, "", &model(scatter))?;
    let Probability { estimate, lo, at_least, .. } = scatter.survival;
    let what = if has_list { "products" } else { "drops" };
    match estimate {
        Some(estimate) => writeln!(
            out,
            "All parts survive in {} % of them; in at least {} % of all {what} ({sure} % confidence)",
            hundredths(estimate),
            hundredths(at_least)
        )?,
        None => writeln!(out, "Whether all parts survive is not known of any")?,
    }
    if let Some(target) = target {
        let word = if answer.is_met() { "met" } else { "MISSED" };
        let (wanted, low) = (given(100.0 * target), hundredths(lo));
        writeln!(out, "Target of {wanted} % {word}: the {sure} % interval begins at {low} %")?;
    }
    if let Some(reason) = &scatter.reason {
        let unanswered = scatter.unanswered;
        writeln!(out, "{unanswered} {what} are not answered, failures but for the upper ends of intervals: {reason}")?;
    }
    let is_box = has_list || matches!(scatter.plate, Some(PlateAs::Box { .. }));
    if is_box && scatter.open > 0 {
        let text = format!(
            "{} {what} are open: how they come down again, by the energy left, or friction of \
             the ground up to 0.6 may decide. They count by what was followed, as failures \
             for the lower ends of intervals and for what is at least, as none for the upper ends",
            scatter.open
        );
        sentence(out, "", &text)?;
    }
    if !scatter.assumed_even.is_empty() {
        let mut names: Vec<String> = Vec::new();
        for name in scatter.assumed_even.iter().map(|input| in_full(file, input)) {
            // An input of several drops is named once.
            if !names.contains(&name) {
                names.push(name);
            }
        }
        writeln!(out, "Taken as equally likely all over the range: {}", names.join(", "))?;
    }
    writeln!(out)?;
    parts(file, scatter, &sure, out)?;
    if has_list { landings(file, scatter, &sure, out) } else { Ok(()) }
}

/// Writes a row for each of several drops: how many survive it alone, and the part that the fewest do.
fn landings(file: &ProductFile, scatter: &Scatter, sure: &str, out: &mut dyn Write) -> io::Result<()> {
    let row = |cells: [&str; 7]| cells.map(str::to_owned).to_vec();
    let interval = format!("{sure} % interval");
    let mut rows = vec![
        row(["each drop alone", "survive", &interval, "", "least", "survives", "largest"]),
        row(["", "%", "from, %", "to, %", "", "%", "utilization"]),
    ];
    for of in &scatter.landings {
        let parts = file.components.iter().zip(&of.components);
        // A survival that is not known comes last.
        let order = |of: &LandingComponent| {
            (of.survival.estimate.unwrap_or(f64::INFINITY), -of.largest_utilization.unwrap_or(0.0))
        };
        let least = parts.min_by(|(_, a), (_, b)| {
            let ((a, most), (b, other)) = (order(a), order(b));
            a.total_cmp(&b).then(most.total_cmp(&other))
        });
        let Some((component, least)) = least else { continue };
        rows.push(vec![
            of.landing.to_string(),
            estimated(&of.survival),
            hundredths(of.survival.lo),
            hundredths(of.survival.hi),
            shown(&component.name, 24),
            estimated(&least.survival),
            least.largest_utilization.map_or_else(|| "-".to_owned(), figures),
        ]);
    }
    writeln!(out)?;
    Table { keys: 1, headings: 2, texts: 1, last_is_text: false, least: 8, rows }.write(out)
}

/// Describes the model, and how a plate is followed.
pub(crate) fn model(scatter: &Scatter) -> String {
    let how = match scatter.plate {
        None => String::new(),
        Some(PlateAs::Box { thickness_m, assumed }) => {
            let taken = if assumed { ", a twentieth of its length: the file tells no thickness" } else { "" };
            format!(", as a box of {} mm with full rotation{taken}", given((1e6 * thickness_m).round() / 1e3))
        }
        Some(PlateAs::Level) => {
            ", as a plate of small tilt: one on feet is not followed as a box, and what real tilt does is left out"
                .to_owned()
        }
    };
    format!("Each is answered by the model {}{how}", scatter.model.name())
}

/// Returns the name of an input with the part that it belongs to.
fn in_full(file: &ProductFile, input: &Varied) -> String {
    let name = input.name().replace('-', " ");
    match input.component() {
        _ if file.is_box() && matches!(input, Varied::Drop(Input::Tilt, Some(_))) => {
            "attitude within its tolerance".to_owned()
        }
        Some(i) => format!("{name} of {}", shown(name_of(file, i), 24)),
        None => name,
    }
}

/// Writes a row for each part.
fn parts(file: &ProductFile, scatter: &Scatter, sure: &str, out: &mut dyn Write) -> io::Result<()> {
    let row = |cells: [&str; 8]| cells.map(str::to_owned).to_vec();
    let interval = format!("{sure} % interval");
    let mut rows = vec![
        row(["part", "survives", "at least", &interval, "", "utilization", "largest", "driven by"]),
        row(["", "%", "%", "from, %", "to, %", "mean", "", ""]),
    ];
    // Among many inputs some stand out by chance.
    #[expect(clippy::cast_precision_loss, reason = "a share")]
    let by_chance = if scatter.landings.is_empty() { 0.0 } else { 3.0 * NOISE / scatter.settings.samples as f64 };
    let least = NAMED.max(by_chance);
    for component in &scatter.components {
        let Probability { lo, hi, at_least, .. } = component.survival;
        let named = component.drivers.iter().filter(|driver| driver.share.variance >= least).take(4);
        let driver = |d: &Driver| format!("{}{} {:.0} %", of_drop(file, &d.input), way(d), 100.0 * d.share.variance);
        let drivers: Vec<String> = named.map(driver).collect();
        let answered = component.worst_sample.is_some();
        let of = |utilization: f64| if answered { figures(utilization) } else { "-".to_owned() };
        rows.push(vec![
            shown(&component.name, 24),
            estimated(&component.survival),
            hundredths(at_least),
            hundredths(lo),
            hundredths(hi),
            of(component.mean_utilization),
            of(component.largest_utilization),
            drivers.join(", "),
        ]);
    }
    Table { keys: 1, headings: 2, texts: 1, last_is_text: true, least: 8, rows }.write(out)
}

pub(super) fn csv(scatter: &Scatter, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{HEADS}")?;
    rows(scatter, "", out)
}

/// Heads of the rows of CSV.
pub(crate) const HEADS: &str = "name,samples,failed,survival,interval_lo,interval_hi,at_least,mean_utilization,\
                                largest_utilization,open,unanswered";

/// Writes a row of CSV for each part, each behind the same beginning.
pub(crate) fn rows(scatter: &Scatter, begin: &str, out: &mut dyn Write) -> io::Result<()> {
    let samples = scatter.settings.samples;
    for component in &scatter.components {
        let ComponentScatter { name, failures, survival, open, unanswered, .. } = component;
        let bounds = [survival.lo, survival.hi, survival.at_least].map(digits).join(",");
        let numbers = format!("{},{bounds}", survival.estimate.map_or_else(String::new, digits));
        let used = match component.worst_sample {
            Some(_) => format!("{},{}", digits(component.mean_utilization), digits(component.largest_utilization)),
            None => ",".to_owned(),
        };
        writeln!(out, "{begin}{},{samples},{failures},{numbers},{used},{open},{unanswered}", field(name))?;
    }
    Ok(())
}
