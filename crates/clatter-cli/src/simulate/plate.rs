//! One drop of a plate in time: with contacts that take time, or by the map, without gravity.

use std::io::{self, Write};

use clatter::{Corner, PlateStart};
use clatter_assess::Model;
use clatter_flight::{PlateMotion, Stop};
use serde::Serialize;

use super::answer::StopJson;
use super::{Args, IMPACTS};
use crate::drop_args::PlateSetup;
use crate::inputs::RowFormat;
use crate::numbers::{Json, digits, given};
use crate::{Failure, Streams, columns};

/// A drop of a plate and what came of it.
struct Drop<'a> {
    args: &'a Args,
    setup: PlateSetup,
    /// Places asked for, in half-sides.
    at: Vec<[f64; 2]>,
    strikes: Vec<Strike>,
    stop: Stop,
    /// Of contacts that take time.
    energy_error: Option<f64>,
}

/// A strike of a corner, by any model.
struct Strike {
    corner: usize,
    time_s: f64,
    approach_m_s: f64,
    delta_v_m_s: [f64; 4],
    /// Where the contact takes time.
    until_s: Option<f64>,
}

/// Strikes whose largest shock is below this share of the largest of all are summed up.
const MATTERS: f64 = 0.01;
/// Strikes of the map that are followed unless more are asked for.
const OF_MAP: usize = 1000;

impl Args {
    pub(super) fn run_plate(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let drop = self.plate()?;
        match self.format {
            RowFormat::Table => drop.table(streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => drop.csv(streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.json(&drop.answer())?,
        }
        for (kind, note) in &drop.setup.notes {
            streams.note(kind, note);
        }
        if let Some(warning) = drop.cut_short() {
            streams.note("warning", warning);
        }
        Ok(())
    }

    fn plate(&self) -> Result<Drop<'_>, Failure> {
        if !self.inertia.mass.is_empty() {
            return Err(Failure::Usage(
                "--mass is that of a bar: a plate takes --gyration=KX,KY and --center-of-mass=SX,SY",
            ));
        }
        if self.spin.is_some() || self.spin_rad_s.is_some() {
            return Err(Failure::Usage("--spin is that of a bar: a plate touches without turning"));
        }
        if self.output.is_some() {
            return Err(Failure::Usage("-o writes the motion of a bar; the strikes of a plate go to standard output"));
        }
        let (inertia, flag) = (self.inertia.given(), self.inertia.flag());
        let setup = self.drop.plate_setup(self.model, self.e, inertia, flag)?;
        let at = setup.places(&self.at)?;
        let (strikes, stop, energy_error) = if setup.model == Model::Map {
            let (strikes, stop) = self.by_map(&setup)?;
            (strikes, stop, None)
        } else {
            let motion = self.by_contacts(&setup)?;
            (of_contacts(&motion), motion.stop, Some(motion.energy_error))
        };
        Ok(Drop { args: self, setup, at, strikes, stop, energy_error })
    }

    fn by_contacts(&self, setup: &PlateSetup) -> Result<PlateMotion, Failure> {
        let mut scene = setup.scene.with_impact_limit(self.impact_limit);
        if let Some(limit) = self.time_limit_s() {
            scene = scene.with_time_limit_s(limit)?;
        }
        // That there is a contact time was checked before.
        let Some(contact) = &setup.contact else {
            return Err(Failure::Usage("--model=compliant needs a --contact-time"));
        };
        scene
            .contacts_until(contact, 1e-4, |_| false)
            .map_err(|error| self.drop.named_plate(error, self.inertia.flag()))
    }

    /// Without gravity: straight lines and impulses.
    fn by_map(&self, setup: &PlateSetup) -> Result<(Vec<Strike>, Stop), Failure> {
        let (scene, halves) = (&setup.scene, setup.halves_m());
        let [kx, ky] = scene.plate().gyration_m();
        let ratios = [kx / halves[0], ky / halves[1]];
        let plate = clatter::Plate::off_center(ratios, setup.center_of_mass, setup.e)
            .map_err(Failure::flag(self.inertia.flag()))?;
        let start = PlateStart::new([-scene.speed_m_s(); 3], scene.gaps_m())?;
        let most = if self.impact_limit == IMPACTS { OF_MAP } else { self.impact_limit };
        let until_s = self.time_limit_s().unwrap_or(f64::INFINITY);
        let mut strikes: Vec<Strike> = Vec::new();
        for impact in plate.train(&start) {
            let last = strikes.last().map_or(0.0, |last| last.time_s);
            if impact.time > until_s {
                return Ok((strikes, Stop::TimeLimit { time_s: until_s }));
            }
            if strikes.len() == most {
                return Ok((strikes, Stop::ImpactLimit { time_s: last }));
            }
            strikes.push(Strike {
                corner: impact.corner as usize,
                time_s: impact.time,
                approach_m_s: impact.approach,
                delta_v_m_s: impact.delta_v,
                until_s: None,
            });
        }
        let time_s = strikes.last().map_or(0.0, |last| last.time_s);
        Ok((strikes, Stop::BouncedClear { time_s }))
    }
}

fn of_contacts(motion: &PlateMotion) -> Vec<Strike> {
    let pressed = motion.strikes.iter().zip(&motion.presses);
    let one = pressed.map(|(strike, press)| Strike {
        corner: strike.point,
        time_s: strike.time_s,
        approach_m_s: strike.approach_m_s,
        delta_v_m_s: strike.delta_v_m_s,
        until_s: Some(press.until_s),
    });
    one.collect()
}

impl Strike {
    fn letter(&self) -> char {
        Corner::ALL[self.corner].letter()
    }
    fn largest(&self) -> f64 {
        self.delta_v_m_s.into_iter().fold(0.0, |most, v| most.max(v.abs()))
    }
    /// At a place in half-sides: the plate stays plane.
    fn delta_v_at(&self, [x, y]: [f64; 2]) -> f64 {
        let [a, b, c, d] = self.delta_v_m_s;
        0.25 * ((1.0 - y) * ((1.0 - x) * a + (1.0 + x) * b) + (1.0 + y) * ((1.0 - x) * d + (1.0 + x) * c))
    }
}

impl Drop<'_> {
    /// Whether a limit has cut off the contact of a strike, so that its shock is not known.
    fn is_unfinished(&self, strike: &Strike) -> bool {
        let cut = !matches!(self.stop, Stop::AtRest { .. } | Stop::BouncedClear { .. });
        cut && strike.until_s.is_some_and(f64::is_infinite)
    }

    fn largest(&self) -> [f64; 4] {
        std::array::from_fn(|i| self.strikes.iter().map(|s| s.delta_v_m_s[i].abs()).fold(0.0, f64::max))
    }

    fn largest_at(&self, place: [f64; 2]) -> f64 {
        self.strikes.iter().map(|strike| strike.delta_v_at(place).abs()).fold(0.0, f64::max)
    }

    fn cut_short(&self) -> Option<String> {
        let n = self.strikes.len();
        match self.stop {
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
        writeln!(out, "Corner a touches at {speed}; b is {hx} higher, d {hy}, c both together\n")
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        let (time, speed) = (self.setup.shown.time, self.setup.shown.speed);
        let stop = match self.stop {
            Stop::AtRest { .. } => "At rest at",
            Stop::BouncedClear { .. } => "Bounced clear at",
            Stop::ImpactLimit { .. } => "Stopped by limit at",
            _ => "Left at",
        };
        writeln!(out, "{:<24}{:>12}", "Impacts", self.strikes.len())?;
        writeln!(out, "{stop:<24}{:>12} {}", time.figures(self.stop.time_s()), time.name())?;
        let corners = Corner::ALL.iter().map(|corner| format!("corner {}", corner.letter()));
        let places = self.at.iter().map(|[x, y]| format!("at {},{}", given(*x), given(*y)));
        let largest = self.largest().into_iter().chain(self.at.iter().map(|place| self.largest_at(*place)));
        for (n, (name, shock)) in corners.chain(places).zip(largest).enumerate() {
            let name = if n == 0 { format!("Largest shock, {name}") } else { format!("               {name}") };
            writeln!(out, "{name:<24}{:>12} {}", speed.figures(shock), speed.name())?;
        }
        writeln!(out)?;
        let mut heads = vec![("time".to_owned(), time.name())];
        heads.extend(self.setup.contact.map(|_| ("until".to_owned(), time.name())));
        heads.extend(["approach", "shock at a", "at b", "at c", "at d"].map(|name| (name.to_owned(), speed.name())));
        heads.extend(self.at.iter().map(|[x, y]| (format!("at {},{}", given(*x), given(*y)), speed.name())));
        let most = self.largest().into_iter().fold(0.0, f64::max);
        let matters = |s: &&Strike| self.args.all || self.is_unfinished(s) || s.largest() >= MATTERS * most;
        for (n, part) in columns::parts(17, &heads).into_iter().enumerate() {
            if n > 0 {
                writeln!(out)?;
            }
            let heads = &heads[part.clone()];
            columns::line(out, "   impact  corner", heads, heads.iter().map(|(name, _)| name.as_str()))?;
            columns::line(out, "                 ", heads, heads.iter().map(|(_, unit)| *unit))?;
            for (i, strike) in self.strikes.iter().enumerate().filter(|(_, strike)| matters(strike)) {
                let cells = self.cells(strike, |x| time.figures(x), |x| speed.figures(x));
                let first = format!("{:>9}  {:<6}", i + 1, strike.letter());
                columns::line(out, &first, heads, cells[part.start..].iter().take(heads.len()))?;
            }
        }
        let left = self.strikes.iter().filter(|strike| !matters(strike)).count();
        if left > 0 {
            writeln!(out, "{left} more below 1 % of the largest shock; --all lists every one")?;
        }
        Ok(())
    }

    /// Time, end of the contact where it takes time, approach and shocks of a strike.
    fn cells(&self, strike: &Strike, time: impl Fn(f64) -> String, speed: impl Fn(f64) -> String) -> Vec<String> {
        let unfinished = self.is_unfinished(strike);
        let known = |shown: String| if unfinished { "unfinished".to_owned() } else { shown };
        let mut cells = vec![time(strike.time_s)];
        cells.extend(strike.until_s.map(|x| known(time(x))));
        cells.push(speed(strike.approach_m_s));
        let at = self.at.iter().map(|place| strike.delta_v_at(*place));
        cells.extend(strike.delta_v_m_s.into_iter().chain(at).map(|x| known(speed(x))));
        cells
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
        for (i, strike) in self.strikes.iter().enumerate() {
            writeln!(out, "{},{},{}", i + 1, strike.letter(), self.cells(strike, digits, digits).join(","))?;
        }
        Ok(())
    }

    fn answer(&self) -> Answer {
        let (setup, scene) = (&self.setup, &self.setup.scene);
        let [length, width] = scene.plate().sides_m();
        Answer {
            model: setup.model.name(),
            length_m: Json(length),
            width_m: Json(width),
            gyration_m: scene.plate().gyration_m().map(Json),
            center_of_mass: setup.center_of_mass.map(Json),
            e: Json(setup.e),
            height_m: setup.height_m.map(Json),
            speed_m_s: Json(scene.speed_m_s()),
            tilt_deg: Json(setup.tilt_deg),
            direction_deg: setup.direction_deg.map(Json),
            gaps_m: scene.gaps_m().map(Json),
            gravity_m_s2: Json(scene.gravity_m_s2()),
            contact_time_s: setup.contact.map(|contact| Json(contact.time_s())),
            contact_law: setup.contact.map(|contact| contact.law().name()),
            energy_error: self.energy_error.map(Json),
            time_limit_s: self.args.time_limit_s().map(Json),
            impact_limit: self.args.impact_limit,
            at: self.at.iter().map(|place| place.map(Json)).collect(),
            largest_delta_v_m_s: self.largest().map(Json),
            largest_delta_v_at_m_s: self.at.iter().map(|place| Json(self.largest_at(*place))).collect(),
            impacts: self.strikes.iter().enumerate().map(|(i, strike)| self.impact(i, strike)).collect(),
            stop: StopJson::new(&self.stop),
        }
    }

    fn impact(&self, i: usize, strike: &Strike) -> ImpactJson {
        let unfinished = self.is_unfinished(strike);
        let shock = |x: f64| (!unfinished).then_some(Json(x));
        ImpactJson {
            number: i + 1,
            corner: strike.letter(),
            time_s: Json(strike.time_s),
            approach_m_s: Json(strike.approach_m_s),
            delta_v_m_s: strike.delta_v_m_s.map(shock),
            delta_v_at_m_s: self.at.iter().map(|place| shock(strike.delta_v_at(*place))).collect(),
            until_s: strike.until_s.map(Json),
            unfinished,
        }
    }
}

#[derive(Serialize)]
struct Answer {
    model: &'static str,
    length_m: Json,
    width_m: Json,
    gyration_m: [Json; 2],
    center_of_mass: [Json; 2],
    e: Json,
    #[serde(skip_serializing_if = "Option::is_none")]
    height_m: Option<Json>,
    speed_m_s: Json,
    /// The steepest slope.
    tilt_deg: Json,
    /// Null of a plate that falls level.
    direction_deg: Option<Json>,
    /// Heights of b and d as a touches.
    gaps_m: [Json; 2],
    gravity_m_s2: Json,
    #[serde(skip_serializing_if = "Option::is_none")]
    contact_time_s: Option<Json>,
    #[serde(skip_serializing_if = "Option::is_none")]
    contact_law: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    energy_error: Option<Json>,
    time_limit_s: Option<Json>,
    impact_limit: usize,
    at: Vec<[Json; 2]>,
    largest_delta_v_m_s: [Json; 4],
    largest_delta_v_at_m_s: Vec<Json>,
    impacts: Vec<ImpactJson>,
    stop: StopJson,
}

#[derive(Serialize)]
struct ImpactJson {
    number: usize,
    corner: char,
    time_s: Json,
    approach_m_s: Json,
    /// Of corners a, b, c and d; null, as those at places, where the contact is unfinished.
    delta_v_m_s: [Option<Json>; 4],
    delta_v_at_m_s: Vec<Option<Json>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    until_s: Option<Json>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    unfinished: bool,
}
