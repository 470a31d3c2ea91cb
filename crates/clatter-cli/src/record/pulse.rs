//! This module shows the pulse that fits the largest shock of a record, and the tolerances of standards about it.

use std::io::{self, Write};

use clatter_answer::record::Fitted;
use clatter_record::Channel;
use clatter_shock::{EffectiveDuration, Pulse, PulseFit, Within, pulse_at};

use crate::numbers::figures;
use clatter_answer::shape_name;

pub(super) fn table(channel: &Channel, name: &str, fitted: &Fitted, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "\n{name}: pulses that fit, best first")?;
    let line = |out: &mut dyn Write, cells: [&str; 5]| {
        let [shape, cells @ ..] = cells;
        writeln!(out, "{shape:<24}{}", cells.map(|cell| format!("{cell:>14}")).concat())
    };
    line(out, ["", "amplitude", "duration", "start", "residual"])?;
    line(out, ["", "m/s2", "s", "s", ""])?;
    for PulseFit { pulse, residual } in &fitted.fits {
        let start = channel.times().start_s() + pulse.start;
        let [amplitude, duration, start, residual] = [pulse.amplitude, pulse.duration, start, *residual].map(figures);
        line(out, [&shape_name(pulse.shape), &amplitude, &duration, &start, &residual])?;
    }
    let EffectiveDuration { third_of_peak_s, tenth_of_rms_s, .. } = fitted.durations;
    let [third, tenth] = [third_of_peak_s, tenth_of_rms_s].map(figures);
    writeln!(
        out,
        "Above a third of the peak for {third} s (Te); above a tenth of the RMS for {tenth} s (T_E of MIL-STD-810)"
    )?;
    let Pulse { shape, amplitude, duration, .. } = fitted.nominal;
    let [amplitude, duration] = [amplitude, duration].map(figures);
    writeln!(out, "Held against a {} of {amplitude} m/s2 and {duration} s:", shape_name(shape))?;
    for (keyword, check) in &fitted.checks {
        let word = if check.holds() { "within" } else { "outside" };
        let mut said = vec![word.to_owned()];
        let mut say = |what: &str, within: Option<Within>, unit: &str| {
            if let Some(Within { measured, allowed: [least, most] }) = within {
                let [measured, least, most] = [measured, least, most].map(figures);
                said.push(format!("{what} {measured} {unit}, allowed {least} to {most}"));
            }
        };
        say("velocity change", check.velocity_change_m_s, "m/s");
        say("duration", check.duration_s, "s");
        say("largest difference", check.distortion.map(|distortion| distortion.largest_m_s2), "m/s2");
        if let Some(leaves_s) = check.distortion.and_then(|distortion| distortion.leaves_s) {
            said.push(format!("leaves the band at {} s", figures(channel.times().start_s() + leaves_s)));
        }
        writeln!(out, "  {keyword}: {}", said.join("; "))?;
    }
    Ok(())
}

/// Returns the nominal pulse as points, in seconds since the first sample and m/s², with quiet before and after.
pub(super) fn curve(fitted: &Fitted) -> Vec<(f64, f64)> {
    const POINTS: u32 = 200;
    let Pulse { duration, start, .. } = fitted.nominal;
    let inside = (0..=POINTS).map(|i| {
        let time_s = start + f64::from(i) / f64::from(POINTS) * duration;
        (time_s, pulse_at(&fitted.nominal, time_s))
    });
    let before = [(start - duration, 0.0), (start, 0.0)];
    let after = [(start + duration, 0.0), (start + 2.0 * duration, 0.0)];
    before.into_iter().chain(inside).chain(after).collect()
}
