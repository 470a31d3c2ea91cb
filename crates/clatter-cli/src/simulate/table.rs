//! This module writes the strikes for people, and as rows.

use std::io::{self, Write};

use clatter_answer::simulate::bar::Impact;
use clatter_flight::{Model as Physics, Stop};
use clatter_product::Model;

use super::Drop;
use crate::columns;
use crate::numbers::{Json, digits, figures, given};

/// Strikes whose largest shock is below this share of the largest of all are summed up.
const MATTERS: f64 = 0.01;

impl Drop<'_> {
    /// Describes the physics that the model keeps.
    pub(super) fn physics(&self) -> String {
        let shown = &self.setup.shown;
        let gravity = shown.acceleration.given(self.scene.gravity_m_s2());
        match self.answer.impacts.motion().model() {
            Physics::Map => "Small tilt, no gravity, instant impacts".to_owned(),
            Physics::Ballistic => format!("Small tilt, gravity {gravity}, instant impacts"),
            Physics::FiniteTilt => format!("Any tilt, gravity {gravity}, instant impacts"),
            Physics::Contacts(contact) => {
                let (law, time) = (contact.law().name(), shown.time.given(contact.time_s()));
                format!("Any tilt, gravity {gravity}, {law} contacts of {time}")
            }
        }
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        self.totals(out)?;
        let (time, speed) = (self.setup.shown.time, self.setup.shown.speed);
        let mut heads = vec![("time".to_owned(), time.name())];
        heads.extend((self.setup.model == Model::Compliant).then(|| ("until".to_owned(), time.name())));
        heads.extend(["approach", "shock at a", "shock at b"].map(|name| (name.to_owned(), speed.name())));
        heads.extend(self.called.iter().map(|place| (format!("shock at {place}"), speed.name())));
        writeln!(out)?;
        let most = MATTERS * self.largest().fold(0.0, f64::max);
        let matters = |impact: &Impact| self.args.all || impact.unfinished || impact.largest_m_s() >= most;
        for (n, part) in columns::parts(14, &heads).into_iter().enumerate() {
            if n > 0 {
                writeln!(out)?;
            }
            let heads = &heads[part.clone()];
            columns::line(out, "   impact  end", heads, heads.iter().map(|(name, _)| name.as_str()))?;
            columns::line(out, "              ", heads, heads.iter().map(|(_, unit)| *unit))?;
            for impact in self.answer.impacts.iter().filter(matters) {
                let cells = cells(&impact, |x| time.figures(x), |x| speed.figures(x));
                let first = format!("{:>9}  {:<3}", impact.number, impact.end);
                columns::line(out, &first, heads, cells[part.start..].iter())?;
            }
        }
        let left: Vec<_> = self.answer.impacts.iter().filter(|impact| !matters(impact)).collect();
        let Some(last) = left.last() else { return Ok(()) };
        let most = left.iter().map(Impact::largest_m_s).fold(0.0, f64::max);
        let (count, until, most) = (left.len(), time.said(last.time_s.0), speed.said(most));
        let strikes = if count == 1 { "strike" } else { "strikes" };
        writeln!(
            out,
            "{count} more {strikes} below 1 % of the largest shock, until {until}, the largest of them {most};\n--all lists every one"
        )
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (scene, shown) = (&self.scene, &self.setup.shown);
        writeln!(out, "{}", self.physics())?;
        let [qa, qb] = scene.body().inertia_ratios().map(figures);
        let mass = match self.answer.center_of_mass.0 {
            0.0 => format!("q = {qa}"),
            s => format!("center of mass at {}: q = {qa} for strikes at end a, {qb} at end b", figures(s)),
        };
        let (length, gyration) =
            (shown.length.given(self.answer.length_m.0), shown.length.said(scene.body().gyration_m()));
        let thickness = match self.answer.thickness_m.0 {
            0.0 => String::new(),
            thickness => format!(" by {}", shown.length.given(thickness)),
        };
        let e = given(scene.e());
        writeln!(out, "Body of {length}{thickness}, radius of gyration {gyration}, {mass}; e = {e}")?;
        let (speed, tilt, gap) = (
            shown.speed.said(scene.speed_m_s()),
            shown.tilt(self.answer.tilt_deg.0),
            shown.length.said(scene.height_gap_m()),
        );
        let spin = match scene.spin_rad_s() {
            0.0 => String::new(),
            spin => format!(", turning at {}", shown.spin.given(spin)),
        };
        writeln!(out, "End a touches at {speed}, tilt {tilt}{spin}; end b is {gap} higher\n")
    }

    fn totals(&self, out: &mut dyn Write) -> io::Result<()> {
        let (motion, time, speed) = (self.answer.impacts.motion(), self.setup.shown.time, self.setup.shown.speed);
        let stop = match motion.stop {
            Stop::AtRest { .. } => "At rest at",
            Stop::BouncedClear { .. } => "Bounced clear at",
            Stop::TurnedOver { .. } => "Turned over at",
            Stop::ImpactLimit { .. } => "Stopped by limit at",
            _ => "Left at",
        };
        let bounds = match motion.stop {
            Stop::AtRest { time_bound_s, shock_bound_m_s, .. } if time_bound_s + shock_bound_m_s > 0.0 => {
                let within = if time_bound_s.is_finite() {
                    format!("within {}; ", time.said(time_bound_s))
                } else {
                    String::new()
                };
                format!("      {within}no shock left out exceeds {}", speed.said(shock_bound_m_s))
            }
            _ => String::new(),
        };
        let ends = ["Largest shock, end a".to_owned(), "               end b".to_owned()];
        let names: Vec<_> =
            ends.into_iter().chain(self.called.iter().map(|place| format!("               at {place}"))).collect();
        let wide = names.iter().map(String::len).max().unwrap_or(0).max(22);
        writeln!(out, "{:<wide$}{:>14}", "Impacts", motion.strikes.len())?;
        writeln!(out, "{stop:<wide$}{:>14} {}{bounds}", time.figures(motion.stop.time_s()), time.name())?;
        for (name, shock) in names.iter().zip(self.largest().chain(self.largest_at())) {
            writeln!(out, "{name:<wide$}{:>14} {}", speed.figures(shock), speed.name())?;
        }
        Ok(())
    }

    /// Returns the largest velocity shock of each end.
    fn largest(&self) -> impl Iterator<Item = f64> {
        self.answer.largest_delta_v_m_s.iter().map(|shock| shock.0)
    }

    fn largest_at(&self) -> impl Iterator<Item = f64> {
        self.answer.largest_delta_v_at_m_s.iter().map(|shock| shock.0)
    }

    pub(super) fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let until = if self.setup.model == Model::Compliant { ",until_s" } else { "" };
        write!(out, "number,end,time_s{until},approach_m_s,delta_v_a_m_s,delta_v_b_m_s")?;
        for s in &self.at {
            write!(out, ",delta_v_at_{}_m_s", digits(*s))?;
        }
        writeln!(out)?;
        for impact in self.answer.impacts.iter() {
            let cells = cells(&impact, digits, digits).join(",");
            writeln!(out, "{},{},{cells}", impact.number, impact.end)?;
        }
        Ok(())
    }
}

/// The cell of a shock that a limit has cut off.
const UNFINISHED: &str = "unfinished";

/// Returns the cells of a strike: time, end of the contact where it takes time, approach and shocks.
fn cells(impact: &Impact, time: impl Fn(f64) -> String, speed: impl Fn(f64) -> String) -> Vec<String> {
    let Impact { time_s, until_s, approach_m_s, delta_v_m_s, delta_v_at_m_s, .. } = impact;
    let shocks = delta_v_m_s.iter().chain(delta_v_at_m_s);
    of_strike([*time_s, *approach_m_s], *until_s, shocks.copied(), time, speed)
}

/// Returns the cells of a strike of any body; a shock is none where the contact is unfinished.
pub(super) fn of_strike(
    [time_s, approach_m_s]: [Json; 2],
    until_s: Option<Json>,
    shocks: impl Iterator<Item = Option<Json>>,
    time: impl Fn(f64) -> String,
    speed: impl Fn(f64) -> String,
) -> Vec<String> {
    let mut shocks = shocks.map(|shock| shock.map_or_else(|| UNFINISHED.to_owned(), |shock| speed(shock.0))).peekable();
    let unfinished = shocks.peek().is_some_and(|shock| shock == UNFINISHED);
    let until = until_s.map(|until| if unfinished { UNFINISHED.to_owned() } else { time(until.0) });
    let mut cells = vec![time(time_s.0)];
    cells.extend(until);
    cells.push(speed(approach_m_s.0));
    cells.extend(shocks);
    cells
}
