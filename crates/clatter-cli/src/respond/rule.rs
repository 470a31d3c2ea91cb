//! The rule: peaks over W h0/v0, as a file.

use std::io::{self, Write};

use clatter::{Bar, Start};
use clatter_shock::{Rule, RulePoint, Suspension, three_way_rule};
use serde::Serialize;

use super::peaks::FactorsJson;
use crate::Failure;
use crate::numbers::{Json, digits};
use crate::output::{self, Kind, Target, buffered};

/// The least and the largest W h0/v0 that the rule is drawn over, unless the component lies beyond.
const DRAWN: [f64; 2] = [1e-2, 1e3];
/// Points of the rule to a decade, and in all.
const POINTS: [f64; 2] = [100.0, 4000.0];

/// Writes the rule at a position of a bar; `component` is W h0/v0 of the component and its peak acceleration A/(W v0).
pub(super) fn write(
    target: &Target,
    (bar, start): (&Bar, &Start),
    position: f64,
    suspension: &Suspension,
    component: [f64; 2],
) -> Result<(), Failure> {
    let [ratio, _] = component;
    if ratio == 0.0 {
        return Err(Failure::Usage("a flat drop has no rule over W h0/v0; give a --height-gap above 0"));
    }
    let rule = three_way_rule(bar, start, position, suspension.damping(), &omegas(ratio))?;
    output::replace(&target.path, |file| match target.kind {
        Kind::Csv => buffered(file, |out| csv(&rule, out)),
        Kind::Svg => file.write_all(clatter_figures::rule(&rule, component)?.as_bytes()),
        _ => buffered(file, |out| Ok(serde_json::to_writer(out, &RuleJson::new(&rule))?)),
    })
}

/// W h0/v0 of the points.
fn omegas(ratio: f64) -> Vec<f64> {
    let (low, high) = (DRAWN[0].min(0.1 * ratio).max(1e-300), DRAWN[1].max(10.0 * ratio).min(1e300));
    let steps = (POINTS[0] * libm::log10(high / low)).ceil().min(POINTS[1]);
    let mut omegas = Vec::new();
    let mut i = 0.0;
    while i <= steps {
        omegas.push(low * libm::pow(high / low, i / steps));
        i += 1.0;
    }
    omegas
}

fn csv(rule: &Rule, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "omega,displacement,acceleration,gain")?;
    rule.points.iter().try_for_each(|p| {
        let [w, z, a, gain] = [p.omega, p.displacement, p.acceleration, p.gain].map(digits);
        writeln!(out, "{w},{z},{a},{gain}")
    })
}

#[derive(Serialize)]
struct RuleJson {
    omega: Vec<Json>,
    displacement: Vec<Json>,
    acceleration: Vec<Json>,
    gain: Vec<Json>,
    soft: FactorsJson,
    stiff: Option<FactorsJson>,
    standard: FactorsJson,
}

impl RuleJson {
    fn new(rule: &Rule) -> Self {
        let all = |of: fn(&RulePoint) -> f64| rule.points.iter().map(|p| Json(of(p))).collect();
        Self {
            omega: all(|p| p.omega),
            displacement: all(|p| p.displacement),
            acceleration: all(|p| p.acceleration),
            gain: all(|p| p.gain),
            soft: rule.soft.into(),
            stiff: rule.stiff.map(Into::into),
            standard: rule.standard.into(),
        }
    }
}
