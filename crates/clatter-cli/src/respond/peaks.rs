//! This module writes the common rows of every table of `clatter respond`: single shocks next to the peaks, the equivalent pulse.

use std::io::{self, Write};

use clatter_answer::respond::{AtStop, Equivalent, Factors, HalfSine, LargestValues, NOTHING_FELT, ServiceCondition};

use crate::numbers::figures;
use crate::quantities::Show;

/// Writes the equivalent pulse for people.
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

/// Writes the hits of the stops.
pub(super) fn at_stop(hits: Option<&AtStop>, speed: Show, time: Show, out: &mut dyn Write) -> io::Result<()> {
    let Some(AtStop { largest_hit_m_s, hits, .. }) = hits else { return Ok(()) };
    let Some(hardest) = hits.iter().max_by(|a, b| a.speed_m_s.0.total_cmp(&b.speed_m_s.0)) else {
        return writeln!(out, "  it reaches no stop");
    };
    let count = if hits.len() == 1 { "once".to_owned() } else { format!("{} times", hits.len()) };
    let (name, size, at) = ("speed at the stop", speed.said(largest_hit_m_s.0), time.figures(hardest.time_s.0));
    writeln!(out, "  {name:<32}{size:>12} {at:>13}  it is reached {count}")
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

/// Writes the least service condition that covers a drop.
fn covered(of: &ServiceCondition, out: &mut dyn Write) -> io::Result<()> {
    let ServiceCondition { pulse, acceleration_g, duration_s, acceleration_ratio, displacement_ratio, .. } = of;
    let [g, ms, a, z] = [acceleration_g.0, 1e3 * duration_s.0, acceleration_ratio.0, displacement_ratio.0].map(figures);
    writeln!(
        out,
        "Shock test: {pulse} ({g} gn, {ms} ms) is the least service condition that covers it, with {a} times the\n\
         acceleration and {z} times the relative displacement"
    )
}

/// Single shocks at the position, each with the response of the component.
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
    /// Writes the rows without clatter and as standards assume, where these are known.
    pub(super) fn at_once(&mut self, flat: Option<&Factors>, standard: Option<&Factors>) -> io::Result<()> {
        for (name, factors) in [("without clatter, (1 + e) v0", flat), ("as standards assume, 2 v0", standard)] {
            factors.map_or(Ok(()), |factors| self.row(name, factors.shock, Some(factors)))?;
        }
        Ok(())
    }
}

/// A possible error is reported where it exceeds this many tolerances.
const TOLD: f64 = 10.0;

/// Writes how far the values may be off, as strikes multiply the errors of earlier ones.
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
