//! The numbers and the figure of the page on the tosses.

use clatter_report::File;
use serde_json::{Value, json};

use super::body::{CUBE, Cube, SQUARE};
use super::compare::{Middle, Quartiles, quartiles};
use super::rigid::Rigid;
use super::strike::Strike;
use super::study::{Model, SLIDES_M_S, Study};
use super::{SQUARES, TOSSES, tosses};
use crate::Error;
use crate::figures::{OverTime, tosses as figure};
use crate::files::{decimals, pretty};

/// Number of samples before the first touch at which the flight that predicts it ends: 34 ms of the cube.
const EARLIER: usize = 5;

/// Returns `cube.json` and `cube.svg`.
pub(crate) fn files() -> Result<Vec<File>, Error> {
    let cube = Page::new(TOSSES, &CUBE, true)?;
    let square = Page::new(SQUARES, &SQUARE, false)?;
    let numbers = json!({ "cube": cube.numbers(&CUBE), "square": square.numbers(&SQUARE) });
    Ok(vec![("cube.json", pretty(&numbers)?), ("cube.svg", cube.figure()?)])
}

/// Returns every number of the section on tosses, as it is printed: the file `cube.json`.
///
/// # Errors
/// [`Error::Data`] if the tosses or the results of other tools are torn; others if a model or the figure fails.
pub fn numbers() -> Result<String, Error> {
    let numbers = files()?.into_iter().find(|(name, _)| *name == "cube.json");
    Ok(numbers.map(|(_, text)| text).unwrap_or_default())
}

/// Tosses, and the models for them, each with friction and without: the box, rigid impacts, other tools.
struct Page {
    study: Study,
    models: Vec<Model>,
}

impl Page {
    fn new(text: &str, published: &Cube, peers: bool) -> Result<Self, Error> {
        let study = Study::new(tosses::read(text)?, published);
        let [smooth, rough] = study.boxes()?;
        let mut models = vec![rough, smooth, study.rigid(true)?, study.rigid(false)?];
        if peers {
            models.extend(study.peers()?);
        }
        Ok(Self { study, models })
    }

    fn numbers(&self, published: &Cube) -> Value {
        let Self { study, .. } = self;
        let cube = &study.cube;
        let others = study.half(false);
        let misfits = study.tosses.iter().map(|toss| 1e3 * toss.first_flight(cube).misfit_m);
        let predicted = study.predicted(EARLIER);
        let late: Vec<f64> = predicted.iter().map(|(_, late)| 1e3 * late.abs()).collect();
        json!({
            "tosses": study.tosses.len(), "followed": study.cases.len(), "others": others.len(),
            "flown": others.iter().filter(|case| case.middle.is_some()).count(),
            "half_mm": [decimals(1e3 * published.half_m, 1), decimals(1e3 * cube.half_m, 1)],
            "gyration_mm": [decimals(1e3 * published.gyration_m, 1), decimals(1e3 * cube.gyration_m, 1)],
            "gravity_m_s2": decimals(cube.gravity_m_s2, 2), "rate_hz": decimals(cube.rate_hz, 0),
            "misfit_mm": spread(quartiles(&misfits.collect::<Vec<_>>()), 2),
            "first_touch": {
                "of": predicted.len(), "right": predicted.iter().filter(|(right, _)| *right).count(),
                "late_ms": spread(quartiles(&late), 2),
                "earlier_ms": decimals(1e3 * cube.time_s(EARLIER), 0),
            },
            "strikes": self.strikes(),
            "models": self.models.iter().map(row).collect::<Vec<_>>(),
            "decided": self.decided(),
        })
    }

    /// Returns the isolated strikes: measurements of both halves, and an impact at one point compared with those of the
    /// other half.
    fn strikes(&self) -> Value {
        let strikes: Vec<Strike> = self.study.strikes.iter().map(|(_, strike)| *strike).collect();
        let sliding: Vec<Strike> =
            strikes.iter().copied().filter(|strike| strike.slides_on_m_s() > SLIDES_M_S).collect();
        let of = |strikes: &[Strike], value: &dyn Fn(&Strike) -> f64| {
            quartiles(&strikes.iter().map(value).collect::<Vec<_>>())
        };
        let trained = self.study.trained();
        let gyration = self.study.cube.gyration_m;
        let point = |rigid: Rigid| {
            let [speed, spin, change] = self.study.one_point(rigid);
            json!({ "speed_m_s": spread(speed, 3), "spin_rad_s": spread(spin, 1), "change": spread(change, 2) })
        };
        json!({
            "count": strikes.len(), "sliding": sliding.len(),
            "others": self.study.strikes.iter().filter(|(trained, _)| !trained).count(),
            "approach_m_s": spread(of(&strikes, &|strike| -strike.corner_m_s()[0].z), 2),
            "e": spread(of(&strikes, &Strike::restitution), 2),
            "friction": spread(of(&sliding, &Strike::friction), 2),
            "late_ms": spread(of(&strikes, &|strike| 1e3 * strike.late_s), 1),
            "lever_mm": spread(of(&strikes, &|strike| 1e3 * strike.lever_m(gyration)), 1),
            "trained": { "e": decimals(trained.e, 2), "friction": decimals(trained.friction, 2) },
            "without": point(Rigid { friction: 0.0, ..trained }), "with": point(trained),
        })
    }

    /// Returns the number of tosses whose next corner to come down is the same with friction and without, by rigid
    /// impacts, and for how many of these, and of the rest, the box has the measured one, with friction and without.
    fn decided(&self) -> Value {
        let next = |touchdowns: &[(usize, f64)]| touchdowns.first().map(|down| down.0);
        let [boxes, rigid] = [0, 2].map(|first| [first, first + 1].map(|i| &self.models[i].touchdowns));
        let (mut counts, mut right) = ([0; 2], [[0; 2]; 2]);
        for (i, case) in self.study.half(false).into_iter().enumerate() {
            let measured = next(&super::compare::touchdowns(case, &case.measured, &self.study.cube));
            let other = usize::from(next(&rigid[0][i]) != next(&rigid[1][i]));
            counts[other] += usize::from(measured.is_some());
            for (right, own) in right[other].iter_mut().zip(boxes) {
                *right += usize::from(measured.is_some() && next(&own[i]) == measured);
            }
        }
        let of = |other: usize| json!({ "of": counts[other], "with": right[other][0], "without": right[other][1] });
        json!({ "same": of(0), "other": of(1) })
    }

    fn figure(&self) -> Result<String, Error> {
        let models: Vec<_> = self.models.iter().map(over_time).collect();
        let velocities = |model: &Model| -> Vec<(f64, f64)> {
            let cases = self.study.half(false);
            let pairs = cases.into_iter().zip(&model.paths).filter_map(|(case, path)| {
                let [measured, predicted] =
                    [&case.measured, path].map(|path| Some(Middle::of(path, case.middle?, &self.study.cube).speed_m_s));
                measured.zip(predicted)
            });
            pairs.collect()
        };
        let [with, without] = [0, 1].map(|i| velocities(&self.models[i]));
        Ok(figure(&models, 1e3 / self.study.cube.rate_hz, [&with, &without])?)
    }
}

fn over_time(model: &Model) -> OverTime<'_> {
    let corners_mm = model.errors.samples_m.iter().map(|quartiles| quartiles.map(|error| 1e3 * error)).collect();
    OverTime { name: &model.name, friction: model.friction, corners_mm }
}

/// Returns a model as a row of the table.
fn row(model: &Model) -> Value {
    let errors = &model.errors;
    let mm = |quartiles: Quartiles, digits| spread(quartiles.map(|length| 1e3 * length), digits);
    json!({
        "name": model.name, "friction": model.friction, "setting": model.setting,
        "corners_mm": mm(errors.corners_m, 1), "speed_m_s": spread(errors.speed_m_s, 2), "turn_rad_s": spread(errors.turn_rad_s, 1),
        "rise_mm": mm(errors.rise_m, 1), "rise_bias_mm": decimals(1e3 * errors.rise_bias_m, 1),
        "next": errors.next, "next_two": errors.next_two,
    })
}

/// Returns a median with its quartiles.
fn spread([low, median, high]: Quartiles, digits: usize) -> String {
    let [low, median, high] = [low, median, high].map(|value| decimals(value, digits));
    format!("{median} ({low}–{high})")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_figure_stays_within_its_frame_and_shows_every_model() {
        let files = files().unwrap();
        crate::frame::stay_within_their_frame(&files);
        for name in ["clatter, box", "rigid impacts", "MuJoCo", "Drake"] {
            assert!(files[1].1.contains(name), "{name} is not drawn");
        }
    }

    /// Returns the text with one space where lines break.
    fn words(text: &str) -> String {
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn the_docs_tell_what_was_measured() {
        let all: Value = serde_json::from_str(&numbers().unwrap()).unwrap();
        let (cube, square) = (&all["cube"], &all["square"]);
        let [docs, readme] =
            [include_str!("../../../docs/how-sure-am-i.md"), include_str!("../../../README.md")].map(words);
        let holds = |text: &str, said: &str| assert!(text.contains(said), "the docs do not say: {said}");
        let (same, other) = (&cube["decided"]["same"], &cube["decided"]["other"]);
        holds(
            &docs,
            &format!(
                "next corner is right in {} of {} tosses where friction does not decide, and in {} of {} where it does; without \
                 friction in {} and {}.",
                same["with"], same["of"], other["with"], other["of"], same["without"], other["without"]
            ),
        );
        let model = |of: &Value, name: &str, friction: bool| {
            let models = of["models"].as_array().unwrap().iter();
            models.clone().find(|row| row["name"] == name && row["friction"] == friction).cloned()
        };
        let middle = |cell: &Value| cell.as_str().unwrap().split(' ').next().unwrap().to_owned();
        for (line, name, friction) in [
            ("the box with friction", "clatter, box", true),
            ("the box without", "clatter, box", false),
            ("rigid impacts with friction", "rigid impacts", true),
            ("MuJoCo 4.0.0 with friction", "MuJoCo 4.0.0", true),
            ("Drake 1.51.1 with friction", "Drake 1.51.1", true),
        ] {
            let cell = |of| model(of, name, friction).map_or(String::new(), |row| middle(&row["corners_mm"]) + " mm ");
            holds(&docs, &format!("| {line} | {}| {}|", cell(cube), cell(square)));
        }
        let rough = model(square, "clatter, box", true).unwrap();
        let e =
            rough["setting"].as_str().unwrap().strip_prefix("e = ").and_then(|words| words.split(',').next()).unwrap();
        let rises_mm: f64 = rough["rise_bias_mm"].as_str().unwrap().parse().unwrap();
        let struck = middle(&square["strikes"]["e"]);
        holds(
            &docs,
            &format!("its best e is {e}, where its strikes have {struck}, and it rises {rises_mm:.0} mm too high."),
        );
        let [rough, smooth] =
            [true, false].map(|friction| model(cube, "clatter, box", friction).unwrap()["next"].clone());
        holds(
            &readme,
            &format!(
                "| next corner of a measured toss | {} of {} right; without friction {} |",
                rough[0], rough[1], smooth[0]
            ),
        );
        let [low, high] = cube["strikes"]["e"]
            .as_str()
            .and_then(|e| e.split(['(', ')']).nth(1)?.split_once('–'))
            .map(<[_; 2]>::from)
            .unwrap();
        holds(&docs, &format!("rebounds with e from {low} to {high}."));
    }
}
