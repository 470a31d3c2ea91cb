//! This module writes the impacts for people, and as rows.

use std::io::{self, Write};

use clatter_answer::simulate::{Impact, physics_in_words};
use clatter_flight::Stop;

use super::Drop;
use crate::columns;
use crate::numbers::{digits, figures, given};
use crate::quantities::neat;

/// Impacts whose largest shock is below this share of the largest of all are summed up.
const MATTERS: f64 = 0.01;

impl Drop<'_> {
    /// Describes the physics that the model keeps.
    pub(super) fn physics(&self) -> String {
        let (shown, drop) = (&self.setup.shown, &self.answer.drop);
        physics_in_words(drop, self.setup.model, |g| shown.acceleration.given(g), |time_s| shown.time.given(time_s))
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        self.totals(out)?;
        let (time, speed, point) = (self.setup.shown.time, self.setup.shown.speed, self.answer.drop.point());
        let mut heads = vec![("time".to_owned(), time.name())];
        heads.extend(self.answer.energy_error.map(|_| ("until".to_owned(), time.name())));
        heads.push(("approach".to_owned(), speed.name()));
        heads.extend(self.places().map(|place| (format!("shock at {place}"), speed.name())));
        writeln!(out)?;
        let most = MATTERS * self.answer.largest_delta_v_m_s.iter().fold(0.0, |most: f64, shock| most.max(shock.0));
        let matters = |impact: &Impact| self.args.all || impact.unfinished || impact.largest_m_s() >= most;
        let row = |impact: Impact| {
            let first = format!("{:>9}  {:<width$}", impact.number, impact.point(), width = point.len());
            (first, cells(&impact, |x| time.figures(x), |x| speed.figures(x)))
        };
        columns::rows(out, &format!("   impact  {point}"), &heads, || {
            self.answer.impacts.iter().filter(matters).map(row)
        })?;
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

    /// Names the points that touch the ground, and the requested places.
    fn places(&self) -> impl Iterator<Item = &str> {
        let points = self.answer.drop.points().iter().copied();
        points.chain(self.called.iter().map(String::as_str))
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (drop, shown) = (&self.answer.drop, &self.setup.shown);
        writeln!(out, "{}", self.physics())?;
        let body = [Some(drop.body.length), drop.body.width, drop.body.thickness];
        let sides = body.into_iter().flatten().map(|side| shown.length.given(neat(side.m())));
        let radii: Vec<_> = drop.gyration_m().into_iter().map(|radius| shown.length.said(radius)).collect();
        let radius = if radii.len() == 1 { "radius" } else { "radii" };
        let centers: Vec<_> = drop.sides().iter().map(|side| 2.0 * side.center_m() / side.m()).collect();
        let is_off = centers.iter().any(|s| *s != 0.0);
        let center = centers.into_iter().map(figures).collect::<Vec<_>>().join(", ");
        let center = if is_off { format!(", center of mass at {center}") } else { String::new() };
        let ratios = self.answer.inertia_ratios.map(|ratios| ratios.map(|q| figures(q.0)));
        let ratios = match ratios {
            Some([a, b]) if is_off => format!(": q = {a} for strikes at end a, {b} at end b"),
            Some([q, _]) => format!(", q = {q}"),
            None => String::new(),
        };
        let (sides, radii) = (sides.collect::<Vec<_>>().join(" by "), radii.join(", "));
        let e = given(drop.restitution);
        let body = format!("Body of {sides}, {radius} of gyration {radii}{center}{ratios}; e = {e}");
        columns::sentence(out, "", &body)?;
        let tilt = format!(", tilt {}", shown.tilt(neat(drop.tilt_rad.to_degrees())));
        let tilt = if drop.is_level { tilt } else { String::new() };
        let optional = shown.optional(drop, |si| si);
        let (point, lowest, speed) = (drop.point(), drop.lowest(), shown.speed.said(drop.speed_m_s));
        let higher = |(k, (name, rise)): (usize, (&str, f64))| {
            let rise = shown.length.said(rise);
            if k == 0 { format!("{point} {name} is {rise} higher") } else { format!("{name} {rise}") }
        };
        let neighbors = drop.neighbors_m().into_iter().enumerate().map(higher).collect::<Vec<_>>().join(", ");
        let (initial, rest) = point.split_at(1);
        let touches = format!("{}{rest} {lowest} touches at {speed}{tilt}{optional}", initial.to_uppercase());
        columns::sentence(out, "", &format!("{touches}; {neighbors}"))?;
        writeln!(out)
    }

    fn totals(&self, out: &mut dyn Write) -> io::Result<()> {
        let (answer, time, speed) = (&self.answer, self.setup.shown.time, self.setup.shown.speed);
        let stop = match answer.stop {
            Stop::AtRest { .. } => "At rest at",
            Stop::BouncedClear { .. } => "Bounced clear at",
            Stop::TurnedOver { .. } => "Turned over at",
            Stop::ImpactLimit { .. } => "Stopped by limit at",
            _ => "Left at",
        };
        let bounds = match answer.stop {
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
        let points = answer.drop.points().iter().map(|name| format!("{} {name}", answer.drop.point()));
        let places = points.chain(self.called.iter().map(|place| format!("at {place}"))).enumerate();
        let begins = |n: usize| if n == 0 { "Largest shock," } else { "" };
        let names: Vec<_> = places.map(|(n, place)| format!("{:<14} {place}", begins(n))).collect();
        let wide = names.iter().map(String::len).max().unwrap_or(0).max(22);
        writeln!(out, "{:<wide$}{:>14}", "Impacts", answer.impacts.train().count())?;
        writeln!(out, "{stop:<wide$}{:>14} {}{bounds}", time.figures(answer.stop.time_s()), time.name())?;
        let largest = answer.largest_delta_v_m_s.iter().chain(&answer.largest_delta_v_at_m_s);
        for (name, shock) in names.iter().zip(largest) {
            writeln!(out, "{name:<wide$}{:>14} {}", speed.figures(shock.0), speed.name())?;
        }
        Ok(())
    }

    pub(super) fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let (drop, until) = (&self.answer.drop, if self.answer.energy_error.is_some() { ",until_s" } else { "" });
        write!(out, "number,{},time_s{until},approach_m_s", drop.point())?;
        drop.points().iter().try_for_each(|point| write!(out, ",delta_v_{point}_m_s"))?;
        for at in &self.answer.at {
            let at: Vec<_> = at.iter().take(drop.sides().len()).map(|s| digits(s.0)).collect();
            write!(out, ",delta_v_at_{}_m_s", at.join("_"))?;
        }
        writeln!(out)?;
        for impact in self.answer.impacts.iter() {
            writeln!(out, "{},{},{}", impact.number, impact.point(), cells(&impact, digits, digits).join(","))?;
        }
        Ok(())
    }
}

/// The cell of a shock that a limit has cut off.
const UNFINISHED: &str = "unfinished";

/// Returns the cells of an impact: time, end of the contact where it takes time, approach and shocks.
fn cells(impact: &Impact, time: impl Fn(f64) -> String, speed: impl Fn(f64) -> String) -> Vec<String> {
    let Impact { time_s, until_s, approach_m_s, delta_v_m_s, delta_v_at_m_s, unfinished, .. } = impact;
    let mut cells = vec![time(time_s.0)];
    cells.extend(until_s.map(|until| if *unfinished { UNFINISHED.to_owned() } else { time(until.0) }));
    cells.push(speed(approach_m_s.0));
    let shocks = delta_v_m_s.iter().chain(delta_v_at_m_s);
    cells.extend(shocks.map(|shock| shock.map_or_else(|| UNFINISHED.to_owned(), |shock| speed(shock.0))));
    cells
}
