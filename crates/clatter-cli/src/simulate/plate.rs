//! One drop of a plate in time: by instant impacts, without gravity or with it, or with contacts that take time.

use std::io::{self, Write};

use clatter::Corner;
use clatter_answer::simulate::plate::{self, Answer, Impact, Question};
use clatter_flight::Stop;

use super::table::of_strike;
use super::{Args, IMPACTS};
use crate::drop_args::{BesidePlate, PlateSetup};
use crate::inputs::RowFormat;
use crate::numbers::{digits, given};
use crate::one_drop::OneDrop;
use crate::quantities::{PerAxis, Show};
use crate::{Failure, Streams, columns};

/// A drop of a plate and what came of it.
struct Drop<'a> {
    args: &'a Args,
    setup: PlateSetup,
    /// Places asked for, in half-sides.
    at: Vec<[f64; 2]>,
    answer: Answer,
}

/// Strikes whose largest shock is below this share of the largest of all are summed up.
const MATTERS: f64 = 0.01;
/// Strikes of the map that are followed unless more are asked for.
const OF_MAP: usize = 1000;

impl Args {
    pub(super) fn run_plate(&self, file: Option<OneDrop>, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let drop = self.plate(file)?;
        match self.format {
            RowFormat::Table => drop.table(streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => drop.csv(streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.json(&drop.answer)?,
        }
        for (kind, note) in &drop.setup.notes {
            streams.note(kind, note);
        }
        if drop.setup.mirrored != [false; 2] {
            let corner = drop.setup.first().letter();
            streams
                .note("note", format!("corner {corner} touches first and is called a here: places are turned around"));
        }
        if let Some(warning) = drop.cut_short() {
            streams.note("warning", warning);
        }
        Ok(())
    }

    fn plate(&self, file: Option<OneDrop>) -> Result<Drop<'_>, Failure> {
        if !self.inertia.mass.is_empty() {
            return Err(Failure::Usage(
                "--mass is that of a bar: a plate takes --gyration=KX,KY and --center-of-mass=SX,SY",
            ));
        }
        if self.spin.is_some() {
            return Err(Failure::Usage("--spin is that of a bar: of a plate it is --spin-rad-s=WX,WY"));
        }
        if self.output.is_some() {
            return Err(Failure::Usage("-o writes the motion of a bar; the strikes of a plate go to standard output"));
        }
        let (gyration, gyration_flag) = (self.inertia.given(), self.inertia.flag());
        let setup = self.drop.plate_setup(BesidePlate {
            model: self.model,
            e: self.e,
            gyration,
            gyration_flag,
            spin_rad_s: self.spin_rad_s,
            file,
        })?;
        let of_part = setup.part.iter().map(|part| PerAxis::Plate(part.place)).filter(|_| self.at.is_empty());
        let at: Vec<_> = self.at.iter().copied().chain(of_part).collect();
        let signs = setup.signs();
        let at: Vec<_> = setup.places(&at, [0.0; 2])?.into_iter().map(|[x, y]| [signs[0] * x, signs[1] * y]).collect();
        let e = setup.e;
        let instant = if setup.has_gravity { plate::Model::Ballistic { e } } else { plate::Model::Map { e } };
        let model = setup.contact.map_or(instant, plate::Model::Contacts);
        let by_map = !setup.has_gravity && self.impact_limit == IMPACTS;
        let mut scene = setup.scene.with_impact_limit(if by_map { OF_MAP } else { self.impact_limit });
        if let Some(limit) = self.time_limit_s() {
            scene = scene.with_time_limit_s(limit)?;
        }
        let mut question = Question::new(scene, model);
        question.at.clone_from(&at);
        let [cx, cy] = setup.center_of_mass;
        question.center_of_mass = [signs[0] * cx + 0.0, signs[1] * cy + 0.0];
        question.tilt_deg = setup.tilt_deg;
        question.direction_deg = setup.in_scene_deg();
        question.height_m = setup.height_m;
        let answer = plate::answer(&question).map_err(|error| self.drop.named_plate(error, self.inertia.flag()))?;
        Ok(Drop { args: self, setup, at, answer })
    }
}

impl Drop<'_> {
    fn cut_short(&self) -> Option<String> {
        let n = self.answer.impacts.count();
        match self.answer.stop {
            Stop::ImpactLimit { .. } => {
                Some(format!("stopped after {n} impacts, more would follow; --impact-limit=N follows more"))
            }
            Stop::TimeLimit { time_s } if self.args.time_limit_s().is_none_or(|limit| time_s < limit) => {
                let time = self.setup.shown.time.said(time_s);
                Some(format!("left at {time}, where the plate neither rests nor strikes again in sight"))
            }
            _ => None,
        }
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (setup, scene, shown) = (&self.setup, &self.setup.scene, &self.setup.shown);
        let gravity = shown.acceleration.given(scene.gravity_m_s2());
        match &setup.contact {
            None if setup.has_gravity => writeln!(out, "Small tilt, gravity {gravity}, instant impacts")?,
            None => writeln!(out, "Small tilt, no gravity, instant impacts")?,
            Some(contact) => {
                let (law, time) = (contact.law().name(), shown.time.given(contact.time_s()));
                writeln!(out, "Small tilt, gravity {gravity}, {law} contacts of {time}")?;
            }
        }
        let ([length, width], [kx, ky]) = (scene.plate().sides_m(), scene.plate().gyration_m());
        let [length, width] = [length, width].map(|side| shown.length.given(crate::quantities::neat(side)));
        let [kx, ky] = [kx, ky].map(|k| shown.length.said(k));
        let [sx, sy] = setup.center_of_mass;
        let center = if sx.abs() + sy.abs() == 0.0 {
            String::new()
        } else {
            format!(", center of mass at {},{}", given(sx), given(sy))
        };
        writeln!(out, "Plate of {length} by {width}, radii of gyration {kx} and {ky}{center}; e = {}", given(setup.e))?;
        let ([hx, hy], speed) = (scene.gaps_m().map(|gap| shown.length.said(gap)), shown.speed.said(scene.speed_m_s()));
        let spin = turning(scene.spin_rad_s(), shown.spin, |spin| spin);
        writeln!(out, "Corner a touches at {speed}{spin}; b is {hx} higher, d {hy}, c both together\n")
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
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
        heads.extend(self.setup.contact.map(|_| ("until".to_owned(), time.name())));
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

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let until = if self.setup.contact.is_some() { ",until_s" } else { "" };
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

/// Time, end of the contact where it takes time, approach and shocks of a strike.
/// How fast a plate turns along its length and its width, where it does.
pub(crate) fn turning(spin: [f64; 2], show: Show, short: impl Fn(f64) -> f64) -> String {
    if spin.iter().all(|rate| *rate == 0.0) {
        return String::new();
    }
    let [x, y] = spin.map(|rate| show.given(short(rate)));
    format!(", turning at {x} along its length and {y} along its width")
}

fn cells(impact: &Impact, time: impl Fn(f64) -> String, speed: impl Fn(f64) -> String) -> Vec<String> {
    let Impact { time_s, until_s, approach_m_s, delta_v_m_s, delta_v_at_m_s, .. } = impact;
    let shocks = delta_v_m_s.iter().chain(delta_v_at_m_s);
    of_strike([*time_s, *approach_m_s], *until_s, shocks.copied(), time, speed)
}
