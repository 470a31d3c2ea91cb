//! The strikes for people, and as rows.

use std::io::{self, Write};

use clatter::flight::{Model, Stop};

use super::{Drop, ModelName, Motion};
use crate::inputs::letter;
use crate::numbers::{digits, figures, given};

impl Drop<'_> {
    /// What the model keeps.
    pub(super) fn physics(&self) -> String {
        let gravity = given(self.args.drop.gravity_m_s2);
        match self.motion {
            Motion::Instant(Model::Map, _) => "Small tilt, no gravity, instant impacts".to_owned(),
            Motion::Instant(Model::Ballistic, _) => format!("Small tilt, gravity {gravity} m/s², instant impacts"),
            Motion::Instant(Model::FiniteTilt, _) => format!("Any tilt, gravity {gravity} m/s², instant impacts"),
            Motion::Compliant(time, _) => format!("Any tilt, gravity {gravity} m/s², contacts of {} s", given(time)),
        }
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let (args, scene, flight) = (self.args, &self.scene, self.motion.flight());
        writeln!(out, "{}", self.physics())?;
        let [qa, qb] = scene.body().inertia_ratios().map(figures);
        let mass = match self.center_of_mass {
            0.0 => format!("q = {qa}"),
            s => format!("center of mass at {}: q = {qa} for strikes at end a, {qb} at end b", figures(s)),
        };
        let (length, gyration) = (given(args.drop.length_m()), figures(scene.body().gyration_m()));
        let thickness = match args.drop.thickness_m {
            0.0 => String::new(),
            thickness => format!(" by {}", given(thickness)),
        };
        let e = given(args.e);
        writeln!(out, "Body of {length}{thickness} m, radius of gyration {gyration} m, {mass}; e = {e}")?;
        let (speed, tilt, gap) =
            (figures(scene.speed_m_s()), given(args.drop.tilt_deg()), figures(scene.height_gap_m()));
        let spin = match scene.spin_rad_s() {
            0.0 => String::new(),
            spin => format!(", turning at {} rad/s", given(spin)),
        };
        writeln!(out, "End a touches at {speed} m/s, tilt {tilt} degrees{spin}; end b is {gap} m higher\n")?;

        writeln!(out, "{:<22}{:>14}", "Impacts", flight.strikes.len())?;
        let end = match flight.stop {
            Stop::AtRest { .. } => "At rest at",
            Stop::BouncedClear { .. } => "Bounced clear at",
            Stop::TurnedOver { .. } => "Turned over at",
            Stop::ImpactLimit { .. } => "Stopped by limit at",
            _ => "Left at",
        };
        let proven = match flight.stop {
            Stop::AtRest { time_bound_s, shock_bound_m_s, .. } if time_bound_s + shock_bound_m_s > 0.0 => {
                let (time, shock) = (figures(time_bound_s), figures(shock_bound_m_s));
                format!("      within {time} s; no shock left out exceeds {shock} m/s")
            }
            _ => String::new(),
        };
        writeln!(out, "{end:<22}{:>14} s{proven}", figures(flight.stop.time_s()))?;
        let [a, b] = self.largest();
        writeln!(out, "{:<22}{:>14} m/s", "Largest shock, end a", figures(a))?;
        writeln!(out, "{:<22}{:>14} m/s", "               end b", figures(b))?;
        for (s, shock) in args.at.iter().zip(self.largest_at()) {
            writeln!(out, "{:<22}{:>14} m/s", format!("               at {}", given(*s)), figures(shock))?;
        }
        let compliant = args.model == ModelName::Compliant;
        let until = if compliant { format!(" {:>13}", "until") } else { String::new() };
        let head = format!(
            "{:>9}  end {:>13}{until} {:>13} {:>13} {:>13}",
            "impact", "time", "approach", "shock at a", "shock at b"
        );
        write!(out, "\n{head}")?;
        for s in &args.at {
            write!(out, " {:>13}", format!("shock at {}", given(*s)))?;
        }
        let until = if compliant { format!(" {:>13}", "s") } else { String::new() };
        write!(out, "\n{:>9}      {:>13}{until} {:>13} {:>13} {:>13}", "", "s", "m/s", "m/s", "m/s")?;
        for _ in &args.at {
            write!(out, " {:>13}", "m/s")?;
        }
        writeln!(out)?;
        for (i, strike) in flight.strikes.iter().enumerate() {
            let [a, b] = strike.delta_v_m_s;
            let until = self.motion.pulses().get(i).map(|pulse| pulse.until_s);
            write!(out, "{:>9}  {:<3}", strike.number, letter(strike.end))?;
            let numbers = [strike.time_s].into_iter().chain(until).chain([strike.approach_m_s, a, b]);
            for x in numbers.chain(self.shocks(strike)) {
                write!(out, " {:>13}", figures(x))?;
            }
            writeln!(out)?;
        }
        Ok(())
    }

    pub(super) fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let until = if self.args.model == ModelName::Compliant { ",until_s" } else { "" };
        write!(out, "number,end,time_s{until},approach_m_s,delta_v_a_m_s,delta_v_b_m_s")?;
        for s in &self.args.at {
            write!(out, ",delta_v_at_{}_m_s", digits(*s))?;
        }
        writeln!(out)?;
        for (i, strike) in self.motion.flight().strikes.iter().enumerate() {
            let [a, b] = strike.delta_v_m_s;
            let until = self.motion.pulses().get(i).map(|pulse| pulse.until_s);
            write!(out, "{},{}", strike.number, letter(strike.end))?;
            let numbers = [strike.time_s].into_iter().chain(until).chain([strike.approach_m_s, a, b]);
            for x in numbers.chain(self.shocks(strike)) {
                write!(out, ",{}", digits(x))?;
            }
            writeln!(out)?;
        }
        Ok(())
    }
}
