//! This module writes the answer of a study, for people and as rows.

use std::io::{self, Write};

use clatter_answer::scatter;
use clatter_answer::study::{Answer, Member, Outcome, SearchedLimit};
use clatter_assess::{Verdict, scatter::ComponentScatter};
use clatter_product::GridAxis;

use crate::columns::{Table, sentence};
use crate::numbers::{digits, figures, given};
use crate::scatter::table::{self as of_one, estimated, hundredths};
use crate::text::{field, shown};
use crate::words;

/// The number of columns of a table that a name of the grid or one of its values may take.
const WIDEST: usize = 24;

pub(super) fn table(answer: &Answer<'_>, out: &mut dyn Write) -> io::Result<()> {
    let plan = answer.study.plan();
    let Some(first) = answer.members.first() else { return Ok(()) };
    let product = shown(&first.file.product.name, 60);
    match &first.outcome {
        Outcome::Drawn(scatter) if plan.grid.is_empty() => {
            let mut one = scatter::Answer::new(&first.file, (**scatter).clone());
            one.target = answer.target;
            return of_one::table(&one, out);
        }
        Outcome::Drawn(scatter) => {
            let (count, samples, seed) = (answer.members.len(), plan.samples, plan.seed);
            writeln!(out, "{product}: {count} products, of each {samples} drops drawn with seed {seed}")?;
            let plate = |member: &Member| if let Outcome::Drawn(of) = &member.outcome { of.plate } else { None };
            if answer.members.iter().all(|member| plate(member) == scatter.plate) {
                sentence(out, "", &of_one::model(scatter))?;
            } else {
                let model = scatter.model.name();
                writeln!(
                    out,
                    "Each is answered by the model {model}, as a box with full rotation, of its own thickness"
                )?;
            }
        }
        Outcome::Searched(_) => {
            writeln!(out, "{product}: the worst drop of each of {} products", answer.members.len())?;
        }
    }
    if let Some(target) = answer.target.filter(|_| !plan.search) {
        let missed = answer.members.iter().filter(|member| !member.holds(answer.target)).count();
        let word = if missed == 0 { "met by all".to_owned() } else { format!("MISSED by {missed}") };
        writeln!(out, "Target of {} % {word}", given(100.0 * target))?;
    }
    writeln!(out)?;
    let sure = format!("{} % from", given(100.0 * answer.confidence));
    let (names, units) = if plan.search {
        (["part", "limit", "verdict", "demand", "margin", ""], [""; 6])
    } else {
        (["part", "survives", "at least", &sure, "to", "largest"], ["", "%", "%", "%", "%", "utilization"])
    };
    // The key of a quantity stands below its table.
    let axis = |axis: &GridAxis| axis.path.split_last().map(|(key, table)| [table.join("."), key.clone()]);
    let heads = plan
        .grid
        .iter()
        .filter_map(axis)
        .chain(std::iter::zip(names, units).map(|(name, unit)| [name, unit].map(str::to_owned)));
    let heads: Vec<[String; 2]> = heads.collect();
    let mut rows: Vec<Vec<String>> = [0, 1].map(|k| heads.iter().map(|head| shown(&head[k], WIDEST)).collect()).into();
    let keys = plan.grid.len() + 1;
    for member in &answer.members {
        let values = member.values.iter().map(|value| shown(value, WIDEST));
        for cells in cells(member) {
            rows.push(values.clone().chain(cells).collect());
        }
    }
    let texts = if plan.search { keys + 2 } else { keys };
    Table { keys, headings: 2, texts, last_is_text: false, least: 8, rows }.write(out)
}

/// Returns a row for each part, or for each limit of a search.
fn cells(member: &Member) -> Vec<Vec<String>> {
    match &member.outcome {
        Outcome::Drawn(scatter) => scatter.components.iter().map(survival).collect(),
        Outcome::Searched(limits) => limits.iter().map(|limit| verdict(member, limit)).collect(),
    }
}

fn survival(component: &ComponentScatter) -> Vec<String> {
    let survival = component.survival;
    let of = |used: f64| if component.worst_sample.is_some() { figures(used) } else { "-".to_owned() };
    let bounds = [survival.at_least, survival.lo, survival.hi].map(hundredths);
    let told = [shown(&component.name, WIDEST), estimated(&survival)];
    told.into_iter().chain(bounds).chain([of(component.largest_utilization)]).collect()
}

fn verdict(member: &Member, limit: &SearchedLimit) -> Vec<String> {
    let component = &member.file.components[limit.component];
    let unit = limit.limit.unit();
    let value = |value: Option<f64>| {
        let written = component.limits.unit(limit.limit, unit);
        value.map_or_else(|| "-".to_owned(), |value| words::in_words(unit, written, value))
    };
    vec![
        shown(&component.name, WIDEST),
        limit.limit.name().to_owned(),
        if limit.verdict == Verdict::Unsafe { "UNSAFE" } else { limit.verdict.name() }.to_owned(),
        value(limit.demand),
        limit.margin.map_or_else(|| "-".to_owned(), words::margin),
    ]
}

pub(super) fn csv(answer: &Answer<'_>, out: &mut dyn Write) -> io::Result<()> {
    let plan = answer.study.plan();
    let several = plan.search || !plan.grid.is_empty();
    let mut heads = String::new();
    if several {
        heads.push_str("member,");
        heads.extend(plan.grid.iter().map(|axis| format!("{},", field(&axis.name()))));
    }
    let own = if plan.search { "name,limit,unit,allowed,demand,bound,margin,verdict" } else { of_one::HEADS };
    writeln!(out, "{heads}{own}")?;
    for (i, member) in answer.members.iter().enumerate() {
        let mut begin = String::new();
        if several {
            begin.extend([i.to_string().as_str(), ","]);
            begin.extend(member.values.iter().map(|value| format!("{},", field(value))));
        }
        match &member.outcome {
            Outcome::Drawn(scatter) => of_one::rows(scatter, &begin, out)?,
            Outcome::Searched(limits) => {
                for limit in limits {
                    let name = field(&member.file.components[limit.component].name);
                    let number = |value: Option<f64>| value.map_or_else(String::new, digits);
                    let numbers = [limit.allowed, limit.demand, limit.bound, limit.margin].map(number).join(",");
                    let (kind, unit) = (limit.limit.name(), limit.limit.unit().name());
                    writeln!(out, "{begin}{name},{kind},{unit},{numbers},{}", limit.verdict.name())?;
                }
            }
        }
    }
    Ok(())
}
