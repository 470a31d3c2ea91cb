//! This module writes the rule, which is the peaks over W h0/v0, as a file.

use std::io::{self, Write};

use clatter_answer::respond::rule::Answer;
use clatter_shock::Rule;

use crate::Failure;
use crate::numbers::digits;
use crate::output::{self, Kind, Target, buffered};

/// Writes the rule; `component` is W h0/v0 of the component and its peak acceleration A/(W v0).
pub(super) fn write(target: &Target, answer: &Answer, component: [f64; 2]) -> Result<(), Failure> {
    output::replace(&target.path, |file| match target.kind {
        Kind::Csv => buffered(file, |out| csv(&answer.rule, out)),
        Kind::Svg => file.write_all(clatter_figures::rule(&answer.rule, component)?.as_bytes()),
        _ => output::json(file, answer),
    })
}

fn csv(rule: &Rule, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "omega,displacement,acceleration,gain")?;
    rule.points.iter().try_for_each(|p| {
        let [w, z, a, gain] = [p.omega, p.displacement, p.acceleration, p.gain].map(digits);
        writeln!(out, "{w},{z},{a},{gain}")
    })
}
