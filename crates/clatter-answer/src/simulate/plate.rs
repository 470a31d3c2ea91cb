//! One drop of a plate in time: by instant impacts, without gravity or with it, or with contacts that take time.
//!
//! ```
//! use clatter_answer::simulate::plate;
//! use clatter_flight::{Plate, PlateScene};
//! // Mass spread evenly over 150 by 70 mm, with b 2 mm and d 1 mm higher as a touches.
//! let phone = Plate::new([0.075, 0.075, 0.035, 0.035], [0.0433, 0.0202])?;
//! let scene = PlateScene::new(phone, 4.43, [2e-3, 1e-3], 9.806_65)?;
//! let answer = plate::answer(&plate::Question::new(scene, plate::Model::Map { e: 0.3 }))?;
//! let first = answer.impacts.iter().next().expect("an impact");
//! assert_eq!((first.corner, first.approach_m_s.0), ('a', -4.43));
//! # Ok::<(), clatter_flight::Error>(())
//! ```

use clatter::{Corner, PlateStart};
use clatter_flight::{Contact, Error, PlateMotion, PlateScene, Stop};
use serde::{Serialize, Serializer};

use super::{ContactAnswer, is_cut};
use crate::{Json, on_plate};

/// The physics that is kept of a drop of a plate: at small tilt both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Model {
    /// Instant impacts with a restitution, no gravity. The scene's gravity is not used.
    Map {
        /// Coefficient of restitution.
        e: f64,
    },
    /// Instant impacts with a restitution, and gravity.
    Ballistic {
        /// Coefficient of restitution.
        e: f64,
    },
    /// Gravity, and contacts that take time.
    Contacts(Contact),
}

impl Model {
    /// Coefficient of restitution.
    #[must_use]
    pub fn e(&self) -> f64 {
        match self {
            Self::Map { e } | Self::Ballistic { e } => *e,
            Self::Contacts(contact) => contact.restitution(),
        }
    }
    /// `map`, `ballistic` or `compliant`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Map { .. } => "map",
            Self::Ballistic { .. } => "ballistic",
            Self::Contacts(_) => "compliant",
        }
    }
}

/// A drop of a plate, corner a first, and the physics that is kept of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The drop.
    pub scene: PlateScene,
    /// What is kept of it.
    pub model: Model,
    /// Places whose velocity shocks are asked for, in half-lengths and half-widths from the middle.
    pub at: Vec<[f64; 2]>,
    /// Center of mass in half-lengths and half-widths, as it is told and as the map takes it.
    pub center_of_mass: [f64; 2],
    /// The steepest slope at the first touch in degrees, as it is told.
    pub tilt_deg: f64,
    /// Where it rises from corner a, from 0° along the length to 90°, as it is told; none of a level plate.
    pub direction_deg: Option<f64>,
    /// Height from which it fell, where that was given.
    pub height_m: Option<f64>,
}

impl Question {
    /// All told as the scene has it, without a place but the corners.
    #[must_use]
    pub fn new(scene: PlateScene, model: Model) -> Self {
        let (center_of_mass, tilt_deg, direction_deg) = told(&scene);
        Self { scene, model, at: Vec::new(), center_of_mass, tilt_deg, direction_deg, height_m: None }
    }
}

/// Center of mass in half-sides, the steepest slope, and in degrees where the plate rises to, which a level one does not.
pub(crate) fn told(scene: &PlateScene) -> ([f64; 2], f64, Option<f64>) {
    let (plate, [hx, hy]) = (scene.plate(), scene.gaps_m());
    let ([left, right, front, back], [length, width]) = (plate.edges_m(), plate.sides_m());
    let slopes = [hx / length, hy / width];
    let tilt = libm::hypot(slopes[0], slopes[1]);
    let direction_deg = (tilt > 0.0).then(|| libm::atan2(slopes[1], slopes[0]).to_degrees());
    ([(left - right) / length, (front - back) / width], libm::asin(tilt).to_degrees(), direction_deg)
}

/// A drop of a plate in time.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// What was kept of the drop.
    pub model: &'static str,
    /// From edge to edge.
    pub length_m: Json,
    /// From edge to edge.
    pub width_m: Json,
    /// Radii of gyration along the length and along the width.
    pub gyration_m: [Json; 2],
    /// In half-lengths and half-widths from the middle.
    pub center_of_mass: [Json; 2],
    /// Coefficient of restitution.
    pub e: Json,
    /// From which it fell, where that was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_m: Option<Json>,
    /// At the first touch.
    pub speed_m_s: Json,
    /// The steepest slope.
    pub tilt_deg: Json,
    /// None of a plate that falls level.
    pub direction_deg: Option<Json>,
    /// Rates of the slopes along length and width at the first touch; left out where it does not turn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin_rad_s: Option<[Json; 2]>,
    /// Heights of b and d as a touches.
    pub gaps_m: [Json; 2],
    /// Of gravity.
    pub gravity_m_s2: Json,
    /// Where contacts take time.
    #[serde(flatten)]
    pub contact: Option<ContactAnswer>,
    /// Until which it was followed, where that was limited.
    pub time_limit_s: Option<Json>,
    /// Strikes followed at most.
    pub impact_limit: usize,
    /// The places asked for.
    pub at: Vec<[Json; 2]>,
    /// Largest velocity shocks of corners a, b, c and d, in all strikes.
    pub largest_delta_v_m_s: [Json; 4],
    /// The same at the places asked for.
    pub largest_delta_v_at_m_s: Vec<Json>,
    /// The strikes.
    pub impacts: Impacts,
    /// Why the motion ends.
    #[serde(serialize_with = "super::stop")]
    pub stop: Stop,
}

/// One strike of a plate.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Impact {
    /// From 1.
    pub number: usize,
    /// The corner that strikes.
    pub corner: char,
    /// Since the first touch.
    pub time_s: Json,
    /// Velocity of the corner just before.
    pub approach_m_s: Json,
    /// Velocity shocks of corners a, b, c and d; none, as those at places, where the contact is unfinished.
    pub delta_v_m_s: [Option<Json>; 4],
    /// Velocity shocks at the places asked for.
    pub delta_v_at_m_s: Vec<Option<Json>>,
    /// Where contacts take time: when this one ends, infinite where the corner stays down.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub until_s: Option<Json>,
    /// Whether a limit has cut off the contact.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub unfinished: bool,
}

impl Impact {
    /// The largest shock of a corner, 0 where it is not known.
    #[must_use]
    pub fn largest_m_s(&self) -> f64 {
        self.delta_v_m_s.into_iter().flatten().fold(0.0, |most: f64, v| most.max(v.0.abs()))
    }
}

/// The strikes of a motion, made while they are read.
#[derive(Debug, Clone)]
pub struct Impacts {
    strikes: Vec<Strike>,
    at: Vec<[f64; 2]>,
    /// Whether a limit has ended the motion.
    cut: bool,
}

/// A strike of a corner, by any model.
#[derive(Debug, Clone, Copy)]
struct Strike {
    corner: usize,
    time_s: f64,
    approach_m_s: f64,
    delta_v_m_s: [f64; 4],
    /// Where the contact takes time.
    until_s: Option<f64>,
}

impl Strike {
    /// At a place in half-sides: the plate stays plane.
    fn delta_v_at(&self, [x, y]: [f64; 2]) -> f64 {
        let [a, b, c, d] = self.delta_v_m_s;
        0.25 * ((1.0 - y) * ((1.0 - x) * a + (1.0 + x) * b) + (1.0 + y) * ((1.0 - x) * d + (1.0 + x) * c))
    }
}

impl Impacts {
    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.strikes.len()
    }
    /// From the first strike on.
    pub fn iter(&self) -> impl Iterator<Item = Impact> + '_ {
        self.strikes.iter().enumerate().map(|(i, strike)| {
            let unfinished = self.cut && strike.until_s.is_some_and(f64::is_infinite);
            let shock = |x: f64| (!unfinished).then_some(Json(x));
            Impact {
                number: i + 1,
                corner: Corner::ALL[strike.corner].letter(),
                time_s: Json(strike.time_s),
                approach_m_s: Json(strike.approach_m_s),
                delta_v_m_s: strike.delta_v_m_s.map(shock),
                delta_v_at_m_s: self.at.iter().map(|place| shock(strike.delta_v_at(*place))).collect(),
                until_s: strike.until_s.map(Json),
                unfinished,
            }
        })
    }
    fn largest(&self, of: impl Fn(&Strike) -> f64) -> Json {
        Json(self.strikes.iter().map(|strike| of(strike).abs()).fold(0.0, f64::max))
    }
}

impl Serialize for Impacts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

/// What was followed of a drop.
struct Followed {
    strikes: Vec<Strike>,
    stop: Stop,
    contact: Option<ContactAnswer>,
}

/// Follows one drop.
///
/// # Errors
/// A place off the plate, or an e that is none; where contacts take time, those of [`PlateScene::contacts_until`].
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { scene, model, ref at, .. } = *question;
    on_plate(at)?;
    let Followed { strikes, stop, contact } = match model {
        Model::Map { e } => by_map(question, e)?,
        Model::Ballistic { e } => followed(&scene.impacts_until(e, |_| false)?),
        Model::Contacts(contact) => followed(&scene.contacts_until(&contact, 1e-4, |_| false)?),
    };
    let impacts = Impacts { strikes, at: at.clone(), cut: is_cut(&stop) };
    let ([length, width], limit_s) = (scene.plate().sides_m(), scene.time_limit_s());
    Ok(Answer {
        model: model.name(),
        length_m: Json(length),
        width_m: Json(width),
        gyration_m: scene.plate().gyration_m().map(Json),
        center_of_mass: question.center_of_mass.map(Json),
        e: Json(model.e()),
        height_m: question.height_m.map(Json),
        speed_m_s: Json(scene.speed_m_s()),
        tilt_deg: Json(question.tilt_deg),
        direction_deg: question.direction_deg.map(Json),
        spin_rad_s: Some(scene.spin_rad_s())
            .filter(|spin| spin.iter().any(|rate| *rate != 0.0))
            .map(|spin| spin.map(Json)),
        gaps_m: scene.gaps_m().map(Json),
        gravity_m_s2: Json(scene.gravity_m_s2()),
        contact,
        time_limit_s: limit_s.is_finite().then_some(Json(limit_s)),
        impact_limit: scene.impact_limit(),
        at: at.iter().map(|place| place.map(Json)).collect(),
        largest_delta_v_m_s: std::array::from_fn(|i| impacts.largest(|strike| strike.delta_v_m_s[i])),
        largest_delta_v_at_m_s: at.iter().map(|place| impacts.largest(|strike| strike.delta_v_at(*place))).collect(),
        impacts,
        stop,
    })
}

fn followed(motion: &PlateMotion) -> Followed {
    let strikes = motion.strikes.iter().enumerate().map(|(k, strike)| Strike {
        corner: strike.point,
        time_s: strike.time_s,
        approach_m_s: strike.approach_m_s,
        delta_v_m_s: strike.delta_v_m_s,
        until_s: motion.presses.get(k).map(|press| press.until_s),
    });
    let contact = motion.contact().map(|contact| ContactAnswer::new(&contact, motion.energy_error));
    Followed { strikes: strikes.collect(), stop: motion.stop, contact }
}

/// Without gravity: straight lines and impulses.
fn by_map(question: &Question, e: f64) -> Result<Followed, clatter::Error> {
    let (scene, plate) = (&question.scene, question.scene.plate());
    let ([kx, ky], [length, width]) = (plate.gyration_m(), plate.sides_m());
    let plate = clatter::Plate::off_center([kx / (0.5 * length), ky / (0.5 * width)], question.center_of_mass, e)?;
    let [a, b, _, d] = scene.corner_velocities();
    let start = PlateStart::new([a, b, d], scene.gaps_m())?;
    let mut strikes: Vec<Strike> = Vec::new();
    let mut train = plate.train(&start);
    let stop = loop {
        let time_s = strikes.last().map_or(0.0, |last| last.time_s);
        let Some(impact) = train.next() else { break Stop::BouncedClear { time_s } };
        if impact.time > scene.time_limit_s() {
            break Stop::TimeLimit { time_s: scene.time_limit_s() };
        }
        if strikes.len() == scene.impact_limit() {
            break Stop::ImpactLimit { time_s };
        }
        strikes.push(Strike {
            corner: impact.corner as usize,
            time_s: impact.time,
            approach_m_s: impact.approach,
            delta_v_m_s: impact.delta_v,
            until_s: None,
        });
    };
    Ok(Followed { strikes, stop, contact: None })
}
