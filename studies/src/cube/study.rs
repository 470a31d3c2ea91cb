//! The tosses, the cube and settings by the training half, and the predictions of each model for the other half.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::Value;

use super::body::Cube;
use super::compare::{Errors, FITTED, Quartiles, quartiles, score_m, touchdowns};
use super::flight::Flight;
use super::median;
use super::path::{Case, Pose};
use super::rigid::Rigid;
use super::strike::{Strike, gyration_m};
use super::tosses::Toss;
use crate::Error;

/// Returns whether a toss trains: every second one does.
fn trains(index: usize) -> bool {
    index.is_multiple_of(2)
}

pub(super) struct Study {
    pub(super) tosses: Vec<Toss>,
    /// The cube: its size, its inertia and gravity by the training half.
    pub(super) cube: Cube,
    /// Isolated first strikes, and whether they train.
    pub(super) strikes: Vec<(bool, Strike)>,
    pub(super) cases: Vec<Case>,
}

impl Study {
    pub(super) fn new(tosses: Vec<Toss>, published: &Cube) -> Self {
        let training: Vec<&Toss> = tosses.iter().step_by(2).collect();
        let mut cube = published.measured(&training);
        let trained: Vec<_> = training.iter().filter_map(|toss| Strike::first(toss, &cube)).collect();
        cube.gyration_m = gyration_m(&trained);
        let first = |(i, toss): (usize, &Toss)| Some((trains(i), Strike::first(toss, &cube)?));
        let strikes = tosses.iter().enumerate().filter_map(first).collect();
        let cases = tosses.iter().enumerate().filter_map(|(i, toss)| Case::new(toss, trains(i), &cube)).collect();
        Self { tosses, cube, strikes, cases }
    }

    pub(super) fn half(&self, training: bool) -> Vec<&Case> {
        self.cases.iter().filter(|case| case.training == training).collect()
    }

    /// Returns the settings with the least error on the training half.
    fn fitted<S: Copy + Send + Sync>(
        &self,
        settings: &[S],
        path: impl Fn(&Case, S) -> Result<Vec<Pose>, Error> + Sync,
    ) -> Result<S, Error> {
        let cases: Vec<Case> = self.half(true).into_iter().map(|case| case.first(FITTED)).collect();
        let score = |setting: &S| {
            let paths = cases.par_iter().map(|case| path(case, *setting)).collect::<Result<Vec<_>, _>>()?;
            Ok((*setting, score_m(cases.iter().zip(paths), &self.cube)))
        };
        let scores = settings.iter().map(score).collect::<Result<Vec<_>, Error>>()?;
        let best = scores.into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
        best.map(|(setting, _)| setting).ok_or_else(|| Error::Data("no settings".into()))
    }

    /// Returns the model of the box of the product, without friction and with it: restitution and contact time, then
    /// restitution and friction at this time.
    pub(super) fn boxes(&self) -> Result<[Model; 2], Error> {
        let path = |case: &Case, (rigid, contact_s): (Rigid, f64)| case.box_path(rigid, contact_s, &self.cube);
        let times = &self.cube.contacts_s;
        let settings: Vec<_> =
            rigids(false).into_iter().flat_map(|rigid| times.iter().map(move |time| (rigid, *time))).collect();
        let smooth @ (_, contact_s) = self.fitted(&settings, path)?;
        let settings: Vec<_> = rigids(true).into_iter().map(|rigid| (rigid, contact_s)).collect();
        let rough = self.fitted(&settings, path)?;
        let model = |best: (Rigid, f64)| {
            let setting = format!("{}, contacts of {} ms", best.0.words(), 1e3 * best.1);
            self.model("clatter, box", best.0.friction > 0.0, setting, |case| path(case, best))
        };
        Ok([model(smooth)?, model(rough)?])
    }

    /// Returns the model of the rigid cube of this study, with friction or without.
    pub(super) fn rigid(&self, friction: bool) -> Result<Model, Error> {
        let path = |case: &Case, rigid: Rigid| Ok(rigid.path(case, &self.cube));
        let best = self.fitted(&rigids(friction), path)?;
        self.model("rigid impacts", friction, best.words(), |case| path(case, best))
    }

    /// Returns MuJoCo and Drake, as `peers/cube.py` last ran them.
    pub(super) fn peers(&self) -> Result<Vec<Model>, Error> {
        Run::read()?.rows.iter().map(|row| self.peer(row)).collect()
    }

    fn peer(&self, row: &Row) -> Result<Model, Error> {
        let path = |case: &Case| {
            let wrong = || Error::Data(format!("peers/cube.json: no path of toss {} by {}", case.number, row.tool));
            let toss = row.paths.iter().find(|toss| toss.toss == case.number).ok_or_else(wrong)?;
            let pose = |[height, x, y, z]: &[f64; 4]| Pose {
                height_m: 1e-5 * height,
                upward: 1e-4 * Vector3::new(*x, *y, *z),
            };
            if toss.poses.len() == case.times_s.len() {
                Ok(toss.poses.iter().map(pose).collect())
            } else {
                Err(wrong())
            }
        };
        let friction = row.setting.get("friction").and_then(Value::as_f64).unwrap_or(0.0) > 0.0;
        let name = format!("{} {}", row.tool, row.version);
        self.model(&name, friction, row.words(), path)
    }

    fn model(
        &self,
        name: &str,
        friction: bool,
        setting: String,
        path: impl Fn(&Case) -> Result<Vec<Pose>, Error>,
    ) -> Result<Model, Error> {
        let cases = self.half(false);
        let paths = cases.iter().map(|case| path(case)).collect::<Result<Vec<_>, _>>()?;
        let pairs: Vec<_> = cases.into_iter().zip(paths).collect();
        let errors = Errors::of(&pairs, &self.cube);
        let touchdowns = pairs.iter().map(|(case, path)| touchdowns(case, path, &self.cube)).collect();
        let paths = pairs.into_iter().map(|(_, path)| path).collect();
        Ok(Model { name: name.to_owned(), friction, setting, errors, paths, touchdowns })
    }

    /// Returns the predictions of the first touch from flights that end some samples before it: whether the corner is
    /// right, and its delay.
    pub(super) fn predicted(&self, earlier: usize) -> Vec<(bool, f64)> {
        let cube = &self.cube;
        let one = |toss: &Toss| {
            let first = toss.first_flight(cube);
            let end = first.until.checked_sub(earlier).filter(|end| end - first.from.min(*end) >= LEAST)?;
            let early = Flight::fit(&toss.poses, first.from, end, cube);
            let (from, until) = (cube.time_s(first.until) - 0.04, cube.time_s(first.until) + 0.04);
            let [early_s, last_s] = [early, first].map(|flight| flight.touch_s(from, until, cube));
            let corner = |flight: &Flight, time| cube.lowest(&flight.at(time, cube)).0;
            Some((corner(&early, early_s?) == corner(&first, last_s?), early_s? - last_s?))
        };
        self.tosses.iter().filter_map(one).collect()
    }

    /// Returns the first strikes of the other half by an impact at one point: the errors of the vertical velocity of
    /// the center and of the spin after it, and the change of that velocity over the measured one.
    pub(super) fn one_point(&self, rigid: Rigid) -> [Quartiles; 3] {
        let others = self.strikes.iter().filter(|(trained, _)| !trained);
        let off = others.map(|(_, strike)| {
            let predicted = rigid.strike(&strike.before, strike.arm, &self.cube);
            let [change, measured] =
                [&predicted, &strike.after].map(|after| after.velocity.z - strike.before.velocity.z);
            [(change - measured).abs(), (predicted.spin - strike.after.spin).norm(), change / measured]
        });
        let off: Vec<[f64; 3]> = off.collect();
        [0, 1, 2].map(|which| quartiles(&off.iter().map(|errors| errors[which]).collect::<Vec<_>>()))
    }

    /// Returns the median restitution and friction of the strikes that train; friction of those that slide on.
    pub(super) fn trained(&self) -> Rigid {
        let trained = || self.strikes.iter().filter(|(trained, _)| *trained).map(|(_, strike)| strike);
        Rigid {
            e: median(trained().map(Strike::restitution)),
            friction: median(trained().filter(|strike| strike.slides_on_m_s() > SLIDES_M_S).map(Strike::friction)),
        }
    }
}

/// The least speed after the strike of a corner that slides on.
pub(super) const SLIDES_M_S: f64 = 0.2;
/// Number of samples of a flight that predicts a touch.
const LEAST: usize = 4;
/// Settings that the fits try.
const RESTITUTIONS: [f64; 13] = [0.1, 0.15, 0.2, 0.225, 0.25, 0.275, 0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7];
const FRICTIONS: [f64; 7] = [0.05, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2];

/// Returns every restitution, with every friction or with none.
fn rigids(friction: bool) -> Vec<Rigid> {
    let frictions: &[f64] = if friction { &FRICTIONS } else { &[0.0] };
    RESTITUTIONS.iter().flat_map(|&e| frictions.iter().map(move |&friction| Rigid { e, friction })).collect()
}

/// A model with its settings and its predictions for the other half.
#[derive(Debug)]
pub(super) struct Model {
    pub(super) name: String,
    pub(super) friction: bool,
    pub(super) setting: String,
    pub(super) errors: Errors,
    pub(super) paths: Vec<Vec<Pose>>,
    /// Corners that come down, toss by toss.
    pub(super) touchdowns: Vec<Vec<(usize, f64)>>,
}

/// The last run of `peers/cube.py`.
const PEERS: &str = include_str!("../../../peers/cube.json");

#[derive(Debug, Deserialize)]
struct Run {
    /// The input of the tools.
    #[cfg_attr(not(test), expect(dead_code, reason = "a test holds it against the cube of today"))]
    cube: BTreeMap<String, f64>,
    rows: Vec<Row>,
}

impl Run {
    fn read() -> Result<Self, Error> {
        serde_json::from_str(PEERS).map_err(|error| Error::Data(format!("peers/cube.json: {error}")))
    }
}

#[derive(Debug, Deserialize)]
struct Row {
    tool: String,
    version: String,
    setting: BTreeMap<String, Value>,
    paths: Vec<Path>,
}

#[derive(Debug, Deserialize)]
struct Path {
    toss: u32,
    poses: Vec<[f64; 4]>,
}

impl Row {
    fn words(&self) -> String {
        let word = |(name, value): (&String, &Value)| match value {
            Value::String(text) => text.clone(),
            value => format!("{name} {}", value.as_f64().unwrap_or_default()),
        };
        self.setting.iter().map(word).collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cube::TOSSES;
    use crate::cube::body::CUBE;
    use crate::cube::synthetic::numbers;
    use crate::cube::tosses::read;

    /// The tosses begin as the measured ones and go on as boxes of known settings, with the noise of the measured ones.
    #[test]
    fn the_settings_of_known_boxes_are_found_again() {
        for (which, (friction, words)) in [(0.0, "e = 0.35"), (0.14, "e = 0.35, μ = 0.14")].into_iter().enumerate() {
            let mut study = Study::new(read(TOSSES).unwrap(), &CUBE);
            let mut next = numbers(7);
            let mut noise = |size: f64| size * next();
            for case in &mut study.cases {
                case.measured = case.box_path(Rigid { e: 0.35, friction }, 3e-3, &study.cube).unwrap();
                for pose in &mut case.measured {
                    pose.height_m += noise(5e-5);
                    pose.upward += Vector3::from_fn(|_, _| noise(5e-4));
                }
            }
            let model = &study.boxes().unwrap()[which];
            assert_eq!(model.setting, format!("{words}, contacts of 3 ms"));
            // The bound is the noise itself.
            assert!(model.errors.corners_m[2] < 1e-4, "{:?}", model.errors.corners_m);
            // A corner that turns just at the limit may count with this noise and not with that.
            let [right, of] = model.errors.next;
            assert!(right + 1 >= of && of > 40, "{right} of {of}");
            assert!(model.errors.rise_bias_m.abs() < 1e-4, "{}", model.errors.rise_bias_m);
        }
    }

    #[test]
    fn other_tools_are_there_with_friction_and_without() {
        let study = Study::new(read(TOSSES).unwrap(), &CUBE);
        let cube = study.cube;
        let given = Run::read().unwrap().cube;
        for (name, value) in
            [("half_m", cube.half_m), ("gravity_m_s2", cube.gravity_m_s2), ("gyration_m", cube.gyration_m)]
        {
            // Another machine rounds otherwise.
            assert!((given[name] / value - 1.0).abs() < 1e-9, "{name}: run peers/cube.py again");
        }
        let models = study.peers().unwrap();
        let names: Vec<_> = models.iter().map(|model| (&model.name[..5], model.friction)).collect();
        assert_eq!(names, [("MuJoC", true), ("MuJoC", false), ("Drake", true), ("Drake", false)]);
        for model in models {
            // They had the same first touch: until the first sample after it a corner moves by some mm.
            assert!(model.errors.samples_m[0][2] < 3e-3, "{}: {:?}", model.name, model.errors.samples_m[0]);
        }
    }
}
