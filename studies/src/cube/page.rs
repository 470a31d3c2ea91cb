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

/// Tosses, and the models for them: the box, rigid impacts without and with friction, other tools.
struct Page {
    study: Study,
    models: Vec<Model>,
}

impl Page {
    fn new(text: &str, published: &Cube, peers: bool) -> Result<Self, Error> {
        let study = Study::new(tosses::read(text)?, published);
        let mut models = vec![study.box_model()?, study.rigid(true)?, study.rigid(false)?];
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
    /// impacts, and for how many of these, and of the rest, the box has the measured one.
    fn decided(&self) -> Value {
        let next = |touchdowns: &[(usize, f64)]| touchdowns.first().map(|down| down.0);
        let [own, with, without] = [0, 1, 2].map(|i| &self.models[i].touchdowns);
        let (mut counts, mut right) = ([0; 2], [0; 2]);
        for (i, case) in self.study.half(false).into_iter().enumerate() {
            let measured = next(&super::compare::touchdowns(case, &case.measured, &self.study.cube));
            let other = usize::from(next(&with[i]) != next(&without[i]));
            counts[other] += usize::from(measured.is_some());
            right[other] += usize::from(measured.is_some() && next(&own[i]) == measured);
        }
        json!({ "same": counts[0], "same_right": right[0], "other": counts[1], "other_right": right[1] })
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
        let mujoco = self.models.iter().find(|model| model.friction && model.name.starts_with("MuJoCo"));
        let with = mujoco.map(velocities).unwrap_or_default();
        Ok(figure(&models, 1e3 / self.study.cube.rate_hz, [&velocities(&self.models[0]), &with])?)
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
}
