//! `clatter tradeoff`: what every pair of models gets wrong for a part, and what it costs.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::ValueHint;
use clatter_scene::Unit;
use clatter_scene::plan::{BarRung, ComponentRung, Quantity};
use clatter_scene::tradeoff::{Choice, Kept, Measured, PartTradeoff, ProductTradeoff, TOLERANCES};

use crate::assess::{self, four, in_words};
use crate::inputs::{self, RowFormat};
use crate::numbers::digits;
use crate::text::{field, shown};
use crate::{Failure, Streams, output};

/// Measure speed against accuracy: what every model gets wrong for each part of a product, and what it costs
///
/// Two ladders of models: how the product moves (closed form, map, ballistic, finite tilt, compliant contact) and how a
/// part answers (to the net change of velocity, the largest shock, a train of impulses, a train of pulses). Every pair
/// that says something of a limit is run on one drop, the one that 'clatter assess' finds worst for the part's tightest
/// limit, and held against the highest pair, computed finer. Times are of this machine; errors are the same everywhere.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter init handheld.toml && clatter tradeoff handheld.toml
  clatter tradeoff handheld.toml -o trade.svg      error over cost, a panel for each limit
  clatter tradeoff handheld.toml --format=csv      a row for each pair, every digit

How to read the table:
  error      what the pair gets wrong here, as a share of the demand by the reference
  estimate   what the plan thinks that it gets wrong, before anything is run; - where it has none
  front      no other pair is both cheaper and closer
  plan       the tolerances at which the plan takes this pair by itself
Below it stands how many strikes of the train are worth following for each tolerance.")]
pub(crate) struct Args {
    /// Product file; 'clatter init' writes one
    #[arg(value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath)]
    product: PathBuf,
    /// Write error over cost as a figure, log-log
    #[arg(short, long, value_name = "FILE.svg", value_hint = ValueHint::FilePath, value_parser = picture)]
    output: Option<PathBuf>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

fn picture(text: &str) -> Result<PathBuf, &'static str> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("svg") => Ok(path),
        _ => Err("the file must end in .svg"),
    }
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let answer = measure(&self.product)?;
        if let Some(path) = &self.output {
            let svg = clatter_report::product_tradeoff_svg(&answer);
            output::replace(path, |file| file.write_all(svg.as_bytes()))?;
        }
        match self.format {
            RowFormat::Table => table(&answer, streams.out).map_err(Failure::Answer),
            RowFormat::Csv => csv(&answer, streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&answer),
        }
    }
}

fn measure(path: &Path) -> Result<ProductTradeoff, Failure> {
    let file = assess::read(path)?;
    let answer = file.assess().and_then(|assessment| file.tradeoff(&assessment));
    answer.map_err(|error| Failure::Product(format!("error: {}: {error}", path.display())))
}

/// SI unit of what is asked.
fn unit(quantity: Quantity) -> Unit {
    match quantity {
        Quantity::PeakAcceleration => Unit::MeterPerSecondSquared,
        Quantity::RattleSpace => Unit::Meter,
        Quantity::VelocityShock => Unit::MeterPerSecond,
    }
}

/// A share of a hundred to two digits, which is what errors are good for.
fn percent(share: f64) -> String {
    match 100.0 * share {
        p if p.is_infinite() => "infinite".to_owned(),
        0.0 => "0 %".to_owned(),
        p if p < 1e-3 => format!("{p:.0e} %"),
        p => {
            // From the rounded number, so that 9.96 is 10.
            let exponent = format!("{p:.1e}").rsplit('e').next().and_then(|e| e.parse::<i32>().ok()).unwrap_or(0);
            format!("{p:.*} %", usize::try_from(1 - exponent).unwrap_or(0))
        }
    }
}

/// A time to three digits.
fn time(seconds: f64) -> String {
    let (factor, name) = match seconds {
        s if s < 0.999_5e-6 => (1e9, "ns"),
        s if s < 0.999_5e-3 => (1e6, "µs"),
        _ => (1e3, "ms"),
    };
    let x = factor * seconds;
    let places = if x < 9.995 { 2 } else { usize::from(x < 99.95) };
    format!("{x:.places$} {name}")
}

fn pair(bar: BarRung, component: ComponentRung) -> String {
    format!("{:<12} {:<13}", bar.name(), component.name())
}

/// Tolerances, `10 %, 1 %`.
fn tolerances(shares: &[f64]) -> String {
    shares.iter().map(|share| format!("{} %", 100.0 * share)).collect::<Vec<_>>().join(", ")
}

fn table(answer: &ProductTradeoff, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{}: speed for accuracy, part by part", shown(&answer.product, 60))?;
    let machine = &answer.machine;
    let slow = if machine.optimized { "" } else { "; built without optimization, times say nothing" };
    writeln!(
        out,
        "Times of one run on one of {} processors, {} ({}){slow}",
        machine.processors, machine.processor, machine.system
    )?;
    for part in &answer.trades {
        of_part(part, out)?;
    }
    if !answer.left_out.is_empty() {
        writeln!(out)?;
    }
    for left in &answer.left_out {
        writeln!(
            out,
            "{}, {}: no pair of these models is asked, {}.",
            shown(&left.component, 24),
            left.limit.name(),
            left.reason
        )?;
    }
    Ok(())
}

fn of_part(part: &PartTradeoff, out: &mut dyn Write) -> io::Result<()> {
    let (trade, scene, reference) = (&part.trade, &part.trade.scene, &part.trade.reference);
    let unit = unit(trade.quantity);
    writeln!(out, "\n{}, {} ({})", shown(&part.component, 24), part.limit.name(), trade.quantity.name())?;
    let suspension = match (scene.frequency_hz, scene.damping_ratio) {
        (Some(hz), Some(zeta)) => format!("; {} Hz, damping ratio {}", four(hz), four(zeta)),
        _ => String::new(),
    };
    writeln!(
        out,
        "  drop       {} first, {} deg, {} m/s, e {}; at {} mm{suspension}",
        inputs::letter(part.first),
        four(scene.tilt_deg),
        four(scene.speed_m_s),
        four(scene.restitution),
        four(1e3 * part.position_m),
    )?;
    writeln!(
        out,
        "  reference  {}, {}: {}, good to {}; {}, {}{} strikes",
        reference.bar.name(),
        reference.component.name(),
        in_words(unit, reference.value),
        percent(reference.within),
        time(reference.seconds),
        if reference.cut { "the first " } else { "" },
        reference.strikes,
    )?;
    if let Some(lacks) = &reference.lacks {
        writeln!(out, "             not the highest rung: {lacks}")?;
    }
    let head =
        format!("{:>12} {:>9} {:>9} {:>9} {:>7} {:>7}", "demand", "error", "estimate", "time", "strikes", "pieces");
    writeln!(out, "\n  {} {head}  front  plan", format_args!("{:<12} {:<13}", "bar", "part"))?;
    for row in &trade.pairs {
        let estimate = if row.estimate.is_infinite() { "-".to_owned() } else { percent(row.estimate) };
        let line = format!(
            "  {} {:>12} {:>9} {estimate:>9} {:>9} {:>7} {:>7}  {:<5}  {}",
            pair(row.bar, row.component),
            in_words(unit, row.value),
            percent(row.error),
            time(row.seconds),
            row.strikes,
            row.pieces,
            if row.front { "front" } else { "" },
            tolerances(&row.chosen_at),
        );
        writeln!(out, "{}", line.trim_end())?;
    }
    writeln!(out)?;
    trade.choices.iter().try_for_each(|chosen| choice(chosen, out))?;
    writeln!(out, "\n  strikes worth keeping for {}, without gravity and with it:", tolerances(&TOLERANCES))?;
    for kept in &trade.kept {
        writeln!(out, "    {}", worth(kept))?;
    }
    Ok(())
}

/// A choice: what it is, and why.
fn choice(choice: &Choice, out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "  {:<14} {}, {}: off by {}, in {} and {} to choose",
        format!("plan at {} %", 100.0 * choice.tolerance),
        choice.bar.name(),
        choice.component.name(),
        percent(choice.error),
        time(choice.seconds),
        time(choice.plan_seconds),
    )?;
    writeln!(out, "{:17}{}", "", choice.reason)?;
    choice.warning.iter().try_for_each(|warning| writeln!(out, "{:17}warning: {warning}", ""))
}

fn worth(kept: &Kept) -> String {
    let least: Vec<String> = kept
        .least
        .iter()
        .map(|n| n.map_or_else(|| format!("more than {}", kept.errors.len()), |n| n.to_string()))
        .collect();
    let ends = match kept.stop {
        "at-rest" => "until rest",
        "bounced-clear" => "in all",
        _ => "followed",
    };
    format!("{:<12} {} of {} strikes {ends}", kept.bar.name(), least.join(", "), kept.strikes)
}

fn csv(answer: &ProductTradeoff, out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "component,limit,quantity,bar,part,value,error,estimate,seconds,strikes,pieces,front,plan_tolerances"
    )?;
    let row = |part: &PartTradeoff, row: &Measured, out: &mut dyn Write| {
        let chosen: Vec<String> = row.chosen_at.iter().map(|tolerance| digits(*tolerance)).collect();
        writeln!(
            out,
            "{},{},{},{},{},{},{},{},{},{},{},{},{}",
            field(&part.component),
            part.limit.name(),
            part.trade.quantity.name(),
            row.bar.name(),
            row.component.name(),
            digits(row.value),
            digits(row.error),
            digits(row.estimate),
            digits(row.seconds),
            row.strikes,
            row.pieces,
            row.front,
            chosen.join(" "),
        )
    };
    answer.trades.iter().try_for_each(|part| part.trade.pairs.iter().try_for_each(|pair| row(part, pair, out)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_and_times_have_as_many_digits_as_they_are_good_for() {
        let shares = [f64::INFINITY, 0.0, 1e-9, 0.000_05, 0.012_34, 0.099_6, 0.37, 12.0];
        let said = ["infinite", "0 %", "1e-7 %", "0.0050 %", "1.2 %", "10 %", "37 %", "1200 %"];
        assert_eq!(shares.map(percent), said);
        let times = [2.5e-7, 0.999_6e-6, 3.456e-5, 1.5e-3, 2.0];
        assert_eq!(times.map(time), ["250 ns", "1.00 µs", "34.6 µs", "1.50 ms", "2000 ms"]);
    }
}
