//! `clatter explain`: which models the drops of a product need, and why.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::ValueHint;
use clatter_scene::explain::{Explanation, GroupValues, LimitExplanation, PlanExplanation};

use crate::inputs::{self, Format};
use crate::numbers::figures;
use crate::text::shown;
use crate::{Failure, Streams, assess};

/// Tell which models the drops of a product need, and why
///
/// Two ladders of models, from the cheapest: how the bar moves (closed-form, map, ballistic, finite-tilt, compliant)
/// and how a part answers (net-change, largest-shock, impulse-train, pulse-train). For each limit of each part: the
/// cheapest pairs within the tolerance over the stated ranges, each with the share of the drops that it is enough for;
/// and in the worst drop the pair, what made cheaper ones too coarse, and what the pair gets wrong. 'clatter assess'
/// follows each drop by the pair told here.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter init handheld.toml && clatter explain handheld.toml
  clatter explain handheld.toml --tolerance=10%    what a quick look needs
  clatter explain handheld.toml --format=json

An error is against the compliant bar with the exact response to its pulses, until rest; of that pair
it is none. It is an estimate unless it says bound. Costs are of one drop on a 2.9 GHz core, about.")]
pub(crate) struct Args {
    /// Product file; 'clatter schema' describes it for editors
    #[arg(value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath)]
    product: PathBuf,
    /// What models may get wrong, as a share of the demand: 0.01 or 1%
    #[arg(long, value_name = "SHARE", default_value = "1%", allow_hyphen_values = true, value_parser = inputs::tolerance)]
    tolerance: f64,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let explanation = assess::read(&self.product)?.explain(self.tolerance)?;
        match self.format {
            Format::Json => streams.json(&explanation),
            Format::Table => table(&explanation, streams.out).map_err(Failure::Answer),
        }
    }
}

fn table(explanation: &Explanation, out: &mut dyn Write) -> io::Result<()> {
    let name = shown(&explanation.product, 60);
    writeln!(out, "{name}: the cheapest models within {} %", figures(100.0 * explanation.tolerance))?;
    for component in &explanation.components {
        for limit in &component.limits {
            writeln!(out, "\n{}, {}", shown(&component.name, 60), limit.limit.name())?;
            limit_table(limit, out)?;
        }
    }
    Ok(())
}

fn limit_table(limit: &LimitExplanation, out: &mut dyn Write) -> io::Result<()> {
    let worst = &limit.worst_case;
    for (i, pair) in limit.shares.iter().enumerate() {
        let head = if i == 0 { "over the ranges" } else { "" };
        writeln!(out, "  {head:<16} {:>5.1} %  {}, {}", 100.0 * pair.share, pair.bar, pair.component)?;
    }
    let frequency = worst.frequency_hz.map_or(String::new(), |f| format!(", {} Hz", figures(f)));
    writeln!(
        out,
        "  {:<16} {} first, {} deg, {} m/s, e {}{frequency}",
        "worst drop",
        inputs::letter(worst.first),
        figures(worst.tilt_deg),
        figures(worst.speed_m_s),
        figures(worst.restitution),
    )?;
    match &limit.plan {
        Some(plan) => plan_table(plan, out)?,
        None => writeln!(
            out,
            "  {:<16} by the velocity shocks of the bar: contacts are followed where they overlap",
            "models"
        )?,
    }
    if limit.guaranteed {
        writeln!(
            out,
            "  {:<16} without gravity, at small tilt and for velocity shocks; no drop asks for more",
            "proven"
        )?;
    }
    if let Some(warning) = &limit.warning {
        writeln!(out, "  {:<16} {warning}", "warning")?;
    }
    Ok(())
}

fn plan_table(plan: &PlanExplanation, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "  {:<16} {}, {}", "models", plan.bar, plan.component)?;
    writeln!(out, "  {:<16} {}", "because", plan.reason)?;
    let error = match (plan.error, plan.is_bound) {
        (0.0, _) => "none: the others are held against this pair".to_owned(),
        (error, true) => format!("at most {} % (bound)", figures(100.0 * error)),
        (error, false) => format!("about {} % (estimate)", figures(100.0 * error)),
    };
    writeln!(out, "  {:<16} {error}", "error")?;
    let GroupValues { gravity, geometry, overlap, pulse, train, damping } = plan.groups;
    let mut groups = vec![("g h0/v0²", gravity), ("φ²", geometry)];
    groups.extend((overlap > 0.0).then_some(("τ/Δt", overlap)));
    groups.extend(pulse.filter(|x| *x > 0.0).map(|x| ("ωτ", x)));
    groups.extend(train.map(|x| ("ω t_N", x)));
    groups.extend(damping.map(|x| ("ζωΔt", x)));
    let groups: Vec<_> = groups.into_iter().map(|(name, x)| format!("{name} = {}", figures(x))).collect();
    writeln!(out, "  {:<16} {}", "groups", groups.join(", "))?;
    writeln!(out, "  {:<16} {} µs a drop, about", "cost", figures(1e-3 * plan.cost_ns))
}
