//! What every table of `clatter respond` has in common: single shocks beside the peaks, the equivalent pulse.

use std::io::{self, Write};

use clatter_answer::respond::{
    AtPlace, Equivalent, Factors, HalfSine, Largest, LargestValues, NOTHING_FELT, ServiceCondition,
};

use crate::numbers::{figures, given};
use crate::quantities::{Show, neat};
use crate::words::in_words;

/// The equivalent pulse for people.
pub(super) fn equivalent_table(equivalent: Option<&Equivalent>, out: &mut dyn Write) -> io::Result<()> {
    let Some(Equivalent { equivalent_pulse, no_equivalent_pulse, service_condition, .. }) = equivalent else {
        return Ok(());
    };
    match equivalent_pulse {
        Some(pulse) => half_sine(pulse, out)?,
        None => writeln!(out, "\nShock table: {}", no_equivalent_pulse.as_deref().unwrap_or_default())?,
    }
    match service_condition {
        Some(of) => covered(of, out),
        None if no_equivalent_pulse.as_deref() == Some(NOTHING_FELT) => Ok(()),
        None => writeln!(out, "Shock test: no service condition of JESD22-B110 does as much to the component"),
    }
}

fn half_sine(pulse: &HalfSine, out: &mut dyn Write) -> io::Result<()> {
    let HalfSine { acceleration_g, duration_s, velocity_change_m_s, displacement_mismatch, .. } = pulse;
    let (g, ms) = (figures(acceleration_g.0), figures(1e3 * duration_s.0));
    let velocity = figures(velocity_change_m_s.0);
    let off = figures(100.0 * displacement_mismatch.0);
    writeln!(
        out,
        "\nShock table: a half-sine of {g} gn and {ms} ms (velocity change {velocity} m/s) gives the component the\n\
         same acceleration, and a relative displacement that differs by {off} %"
    )
}

/// The least service condition that covers a drop.
fn covered(of: &ServiceCondition, out: &mut dyn Write) -> io::Result<()> {
    let ServiceCondition { pulse, acceleration_g, duration_s, acceleration_ratio, displacement_ratio, .. } = of;
    let [g, ms, a, z] = [acceleration_g.0, 1e3 * duration_s.0, acceleration_ratio.0, displacement_ratio.0].map(figures);
    writeln!(
        out,
        "Shock test: {pulse} ({g} gn, {ms} ms) is the least service condition that covers it, with {a} times the\n\
         acceleration and {z} times the relative displacement"
    )
}

/// Single shocks at the position, each with what it does to the component.
pub(super) struct Shocks<'a> {
    pub(super) show: Show,
    pub(super) out: &'a mut dyn Write,
}

impl Shocks<'_> {
    pub(super) fn head(&mut self) -> io::Result<()> {
        let Self { show, out } = self;
        let unit = show.name();
        let (shock, wz, aw) = (format!("shock, {unit}"), format!("W z, {unit}"), format!("A/W, {unit}"));
        writeln!(out, "\n{:<34}{shock:>12} {wz:>13} {aw:>13}", "A shock at this position")
    }
    pub(super) fn row(&mut self, name: &str, shock: f64, peaks: Option<&Factors>) -> io::Result<()> {
        let show = |x: Option<f64>| x.map_or("-".to_owned(), |x| self.show.figures(x));
        let z = show(peaks.map(|p| p.omega_peak_relative_displacement.0));
        let a = show(peaks.map(|p| p.peak_absolute_acceleration_over_omega.0));
        writeln!(self.out, "  {name:<32}{:>12} {z:>13} {a:>13}", self.show.figures(shock))
    }
    /// Without clatter and as standards assume, where these are known.
    pub(super) fn at_once(&mut self, flat: Option<&Factors>, standard: Option<&Factors>) -> io::Result<()> {
        for (name, factors) in [("without clatter, (1 + e) v0", flat), ("as standards assume, 2 v0", standard)] {
            factors.map_or(Ok(()), |factors| self.row(name, factors.shock, Some(factors)))?;
        }
        Ok(())
    }
}

/// What is left open is told where it could raise an answer by more than so many tolerances.
const TOLD: f64 = 10.0;

/// What later strikes could still do.
pub(super) fn doubts(tolerance: f64, of: &LargestValues, out: &mut dyn Write) -> io::Result<()> {
    for (name, largest) in [
        ("W z", of.part_displacement),
        ("A/W", of.part_acceleration),
        ("the change of velocity", of.velocity_change),
        ("the change of angular velocity", of.angular_velocity_change),
    ] {
        let error = largest.map_or(0.0, |largest| largest.error.0);
        if error > TOLD * tolerance {
            let share = if error.is_infinite() { "?".to_owned() } else { figures(100.0 * error) };
            writeln!(out, "Off by {share} % at most: {name}; strikes multiply what those before got wrong")?;
        }
    }
    Ok(())
}

/// Where a part of a body is, and along which axis it is shaken.
pub(super) fn place(at_m: [f64; 3], axis: &str, out: &mut dyn Write) -> io::Result<()> {
    let [x, y, z] = at_m.map(|at| given(neat(1e3 * at)));
    let axis = if axis == "any" { "in magnitude".to_owned() } else { format!("along {axis}") };
    writeln!(out, "Place at {x}, {y}, {z} mm from the middle, {axis}")
}

/// The largest values at a place and of a part there, and how far off they may be.
pub(super) fn largest_values(place: &AtPlace, tolerance: f64, out: &mut dyn Write) -> io::Result<()> {
    let row = |out: &mut dyn Write, name: &str, largest: Option<Largest>| {
        let Some(Largest { value, unit, time_s, impact, .. }) = largest else { return Ok(()) };
        let (value, when) = (in_words(unit, None, value.0), figures(1e3 * time_s.0));
        writeln!(out, "  {name:<26}{value:>18}{when:>13}  at impact {impact}")
    };
    let of = &place.answers;
    writeln!(out, "\nLargest at this place                             when, ms")?;
    row(out, "change of velocity", of.velocity_change)?;
    row(out, "acceleration", of.acceleration)?;
    row(out, "change of angular velocity", of.angular_velocity_change)?;
    if let Some(part) = &place.part {
        let [omega, damping] = [part.omega, part.damping].map(|of| given(super::six(of.0)));
        writeln!(out, "\nPeak of the part, W = {omega} rad/s, damping ratio {damping}")?;
        row(out, "acceleration", of.part_acceleration)?;
        row(out, "relative displacement", of.part_displacement)?;
    }
    doubts(tolerance, of, out)
}
