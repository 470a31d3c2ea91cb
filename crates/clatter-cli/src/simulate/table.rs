//! The strikes for people, and as rows.

use std::io::{self, Write};

use clatter_flight::{Model, Stop, Strike};

use super::answer::end;
use super::{Drop, ModelName, Motion};
use crate::inputs::law_name;
use crate::numbers::{digits, figures, given};

impl Drop<'_> {
    /// What the model keeps.
    pub(super) fn physics(&self) -> String {
        let gravity = given(self.args.drop.gravity_m_s2);
        match &self.motion {
            Motion::Instant(Model::Map, _) => "Small tilt, no gravity, instant impacts".to_owned(),
            Motion::Instant(Model::Ballistic, _) => format!("Small tilt, gravity {gravity} m/s², instant impacts"),
            Motion::Instant(Model::FiniteTilt, _) => format!("Any tilt, gravity {gravity} m/s², instant impacts"),
            Motion::Contacts(contact, _) => {
                let (law, time) = (law_name(contact.law()), given(contact.time_s()));
                format!("Any tilt, gravity {gravity} m/s², {law} contacts of {time} s")
            }
        }
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        self.totals(out)?;
        let compliant = self.args.model == ModelName::Compliant;
        let column = |name: &str| if compliant { format!(" {name:>13}") } else { String::new() };
        let until = column("until");
        write!(
            out,
            "\n{:>9}  end {:>13}{until} {:>13} {:>13} {:>13}",
            "impact", "time", "approach", "shock at a", "shock at b"
        )?;
        for s in &self.args.at {
            write!(out, " {:>13}", format!("shock at {}", given(*s)))?;
        }
        let until = column("s");
        write!(out, "\n{:>9}      {:>13}{until} {:>13} {:>13} {:>13}", "", "s", "m/s", "m/s", "m/s")?;
        for _ in &self.args.at {
            write!(out, " {:>13}", "m/s")?;
        }
        writeln!(out)?;
        for (i, strike) in self.motion.flight().strikes.iter().enumerate() {
            write!(out, "{:>9}  {:<3}", strike.number, end(strike.point))?;
            for cell in self.cells(i, strike, figures) {
                write!(out, " {cell:>13}")?;
            }
            writeln!(out)?;
        }
        Ok(())
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (args, scene) = (self.args, &self.scene);
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
        writeln!(out, "End a touches at {speed} m/s, tilt {tilt} degrees{spin}; end b is {gap} m higher\n")
    }

    fn totals(&self, out: &mut dyn Write) -> io::Result<()> {
        let flight = self.motion.flight();
        writeln!(out, "{:<22}{:>14}", "Impacts", flight.strikes.len())?;
        let stop = match flight.stop {
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
        writeln!(out, "{stop:<22}{:>14} s{proven}", figures(flight.stop.time_s()))?;
        let [a, b] = self.largest();
        writeln!(out, "{:<22}{:>14} m/s", "Largest shock, end a", figures(a))?;
        writeln!(out, "{:<22}{:>14} m/s", "               end b", figures(b))?;
        for (s, shock) in self.args.at.iter().zip(self.largest_at()) {
            writeln!(out, "{:<22}{:>14} m/s", format!("               at {}", given(*s)), figures(shock))?;
        }
        Ok(())
    }

    /// Time, end of the contact where it takes time, approach and shocks of a strike.
    fn cells(&self, i: usize, strike: &Strike, show: fn(f64) -> String) -> Vec<String> {
        let shock = |x: f64| if self.is_unfinished(i) { UNFINISHED.to_owned() } else { show(x) };
        let mut cells = vec![show(strike.time_s)];
        cells.extend(self.until_s(i).map(shock));
        cells.push(show(strike.approach_m_s));
        cells.extend(strike.delta_v_m_s.map(shock));
        cells.extend(self.shocks(strike).map(shock));
        cells
    }

    pub(super) fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let until = if self.args.model == ModelName::Compliant { ",until_s" } else { "" };
        write!(out, "number,end,time_s{until},approach_m_s,delta_v_a_m_s,delta_v_b_m_s")?;
        for s in &self.args.at {
            write!(out, ",delta_v_at_{}_m_s", digits(*s))?;
        }
        writeln!(out)?;
        for (i, strike) in self.motion.flight().strikes.iter().enumerate() {
            let cells = self.cells(i, strike, digits).join(",");
            writeln!(out, "{},{},{cells}", strike.number, end(strike.point))?;
        }
        Ok(())
    }
}

/// What stands for a shock that a limit has cut off.
const UNFINISHED: &str = "unfinished";
