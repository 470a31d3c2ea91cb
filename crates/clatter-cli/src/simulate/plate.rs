//! This module shows one drop of a plate in time: by instant impacts, without gravity or with it, or with contacts that take time.

use std::io::{self, Write};

use clatter::Corner;
use clatter_answer::simulate::plate::{Answer, Impact};
use clatter_flight::{PlateScene, Stop};
use clatter_product::Model;

use super::Args;
use super::table::of_strike;
use crate::columns;
use crate::drop_args::Setup;
use crate::numbers::{digits, given};
use crate::quantities::Show;

/// A drop of a plate and what came of it.
pub(super) struct Drop<'a> {
    pub(super) args: &'a Args,
    pub(super) setup: Setup,
    /// The drop as its flight has it.
    pub(super) scene: PlateScene,
    /// Requested places, in half-sides.
    pub(super) at: Vec<[f64; 2]>,
    pub(super) answer: Answer,
}

/// Strikes whose largest shock is below this share of the largest of all are summed up.
const MATTERS: f64 = 0.01;

impl Drop<'_> {
    pub(super) fn warnings(&self) -> Vec<String> {
        let n = self.answer.impacts.count();
        match self.answer.stop {
            Stop::ImpactLimit { .. } => {
                vec![format!("stopped after {n} impacts, more would follow; --impact-limit=N follows more")]
            }
            Stop::TimeLimit { time_s } if self.args.time_limit_s().is_none_or(|limit| time_s < limit) => {
                let time = self.setup.shown.time.said(time_s);
                vec![format!("left at {time}, where the plate neither rests nor strikes again in sight")]
            }
            _ => Vec::new(),
        }
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (setup, scene, shown) = (&self.setup, &self.scene, &self.setup.shown);
        let gravity = shown.acceleration.given(scene.gravity_m_s2());
        match (setup.model, &self.answer.contact) {
            (Model::Map, _) => writeln!(out, "Small tilt, no gravity, instant impacts")?,
            (_, None) => writeln!(out, "Small tilt, gravity {gravity}, instant impacts")?,
            (_, Some(contact)) => {
                let (law, time) = (contact.contact_law, shown.time.given(contact.contact_time_s.0));
                writeln!(out, "Small tilt, gravity {gravity}, {law} contacts of {time}")?;
            }
        }
        let ([length, width], [kx, ky]) = (scene.plate().sides_m(), scene.plate().gyration_m());
        let [length, width] = [length, width].map(|side| shown.length.given(crate::quantities::neat(side)));
        let [kx, ky] = [kx, ky].map(|k| shown.length.said(k));
        let [sx, sy] = self.answer.center_of_mass.map(|s| s.0);
        let center = if sx.abs() + sy.abs() == 0.0 {
            String::new()
        } else {
            format!(", center of mass at {},{}", given(sx), given(sy))
        };
        writeln!(
            out,
            "Plate of {length} by {width}, radii of gyration {kx} and {ky}{center}; e = {}",
            given(setup.drop.restitution)
        )?;
        let ([hx, hy], speed) = (scene.gaps_m().map(|gap| shown.length.said(gap)), shown.speed.said(scene.speed_m_s()));
        let spin = turning(scene.spin_rad_s(), shown.spin);
        writeln!(out, "Corner a touches at {speed}{spin}; b is {hx} higher, d {hy}, c both together\n")
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        let (time, speed) = (self.setup.shown.time, self.setup.shown.speed);
        let stop = match self.answer.stop {
            Stop::AtRest { .. } => "At rest at",
            Stop::BouncedClear { .. } => "Bounced clear at",
            Stop::ImpactLimit { .. } => "Stopped by limit at",
            _ => "Left at",
        };
        writeln!(out, "{:<24}{:>12}", "Impacts", self.answer.impacts.count())?;
        writeln!(out, "{stop:<24}{:>12} {}", time.figures(self.answer.stop.time_s()), time.name())?;
        let corners = Corner::ALL.iter().map(|corner| format!("corner {}", corner.letter()));
        let places = self.at.iter().map(|[x, y]| format!("at {},{}", given(*x), given(*y)));
        let largest = self.answer.largest_delta_v_m_s.iter().chain(&self.answer.largest_delta_v_at_m_s);
        for (n, (name, shock)) in corners.chain(places).zip(largest).enumerate() {
            let name = if n == 0 { format!("Largest shock, {name}") } else { format!("               {name}") };
            writeln!(out, "{name:<24}{:>12} {}", speed.figures(shock.0), speed.name())?;
        }
        writeln!(out)?;
        let mut heads = vec![("time".to_owned(), time.name())];
        heads.extend(self.answer.contact.map(|_| ("until".to_owned(), time.name())));
        heads.extend(["approach", "shock at a", "at b", "at c", "at d"].map(|name| (name.to_owned(), speed.name())));
        heads.extend(self.at.iter().map(|[x, y]| (format!("at {},{}", given(*x), given(*y)), speed.name())));
        let most = MATTERS * self.answer.largest_delta_v_m_s.iter().fold(0.0, |most: f64, shock| most.max(shock.0));
        let matters = |impact: &Impact| self.args.all || impact.unfinished || impact.largest_m_s() >= most;
        for (n, part) in columns::parts(17, &heads).into_iter().enumerate() {
            if n > 0 {
                writeln!(out)?;
            }
            let heads = &heads[part.clone()];
            columns::line(out, "   impact  corner", heads, heads.iter().map(|(name, _)| name.as_str()))?;
            columns::line(out, "                 ", heads, heads.iter().map(|(_, unit)| *unit))?;
            for impact in self.answer.impacts.iter().filter(matters) {
                let cells = cells(&impact, |x| time.figures(x), |x| speed.figures(x));
                let first = format!("{:>9}  {:<6}", impact.number, impact.corner);
                columns::line(out, &first, heads, cells[part.start..].iter().take(heads.len()))?;
            }
        }
        let left = self.answer.impacts.iter().filter(|impact| !matters(impact)).count();
        if left > 0 {
            writeln!(out, "{left} more below 1 % of the largest shock; --all lists every one")?;
        }
        Ok(())
    }

    pub(super) fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let until = if self.answer.contact.is_some() { ",until_s" } else { "" };
        write!(
            out,
            "number,corner,time_s{until},approach_m_s,delta_v_a_m_s,delta_v_b_m_s,delta_v_c_m_s,delta_v_d_m_s"
        )?;
        for [x, y] in &self.at {
            write!(out, ",delta_v_at_{}_{}_m_s", digits(*x), digits(*y))?;
        }
        writeln!(out)?;
        for impact in self.answer.impacts.iter() {
            writeln!(out, "{},{},{}", impact.number, impact.corner, cells(&impact, digits, digits).join(","))?;
        }
        Ok(())
    }
}

/// Describes how fast a plate turns along its length and its width, where it does.
fn turning(spin: [f64; 2], show: Show) -> String {
    if spin.iter().all(|rate| *rate == 0.0) {
        return String::new();
    }
    let [x, y] = spin.map(|rate| show.given(rate));
    format!(", turning at {x} along its length and {y} along its width")
}

/// Returns the cells of a strike: time, end of the contact where it takes time, approach and shocks.
fn cells(impact: &Impact, time: impl Fn(f64) -> String, speed: impl Fn(f64) -> String) -> Vec<String> {
    let Impact { time_s, until_s, approach_m_s, delta_v_m_s, delta_v_at_m_s, .. } = impact;
    let shocks = delta_v_m_s.iter().chain(delta_v_at_m_s);
    of_strike([*time_s, *approach_m_s], *until_s, shocks.copied(), time, speed)
}
