//! This module follows one drop of a plate in time: by instant impacts, without gravity or with it, or with contacts that take time.

use clatter::{Corner, PlateStart};
use clatter_flight::{Model as Physics, PlateMotion, PlateScene, Stop};
use serde::{Serialize, Serializer};

use super::{ContactAnswer, Question, is_cut};
use crate::{Error, Json, neat, on_plate};

/// A drop of a plate in time.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// The model of the drop.
    pub model: &'static str,
    /// The length from edge to edge.
    pub length_m: Json,
    /// The width from edge to edge.
    pub width_m: Json,
    /// Radii of gyration along the length and along the width.
    pub gyration_m: [Json; 2],
    /// The position of the center of mass, in half-lengths and half-widths from the middle.
    pub center_of_mass: [Json; 2],
    /// Coefficient of restitution.
    pub e: Json,
    /// The height from which it fell, where that was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_m: Option<Json>,
    /// The speed at the first touch.
    pub speed_m_s: Json,
    /// The steepest slope.
    pub tilt_deg: Json,
    /// The direction of the tilt; none of a plate that falls level.
    pub direction_deg: Option<Json>,
    /// Rates of the slopes along length and width at the first touch; left out where it does not turn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin_rad_s: Option<[Json; 2]>,
    /// Heights of b and d as a touches.
    pub gaps_m: [Json; 2],
    /// The acceleration of gravity.
    pub gravity_m_s2: Json,
    /// The contacts, where they take time.
    #[serde(flatten)]
    pub contact: Option<ContactAnswer>,
    /// The time until which the drop was followed, where that was limited.
    pub time_limit_s: Option<Json>,
    /// The largest number of strikes followed.
    pub impact_limit: usize,
    /// The requested places.
    pub at: Vec<[Json; 2]>,
    /// Largest velocity shocks of corners a, b, c and d, in all strikes.
    pub largest_delta_v_m_s: [Json; 4],
    /// The same at the requested places.
    pub largest_delta_v_at_m_s: Vec<Json>,
    /// The strikes.
    pub impacts: Impacts,
    /// The reason why the motion ends.
    #[serde(serialize_with = "super::stop")]
    pub stop: Stop,
}

/// One strike of a plate.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Impact {
    /// The number of the strike, from 1.
    pub number: usize,
    /// The corner that strikes.
    pub corner: char,
    /// The time since the first touch.
    pub time_s: Json,
    /// Velocity of the corner just before.
    pub approach_m_s: Json,
    /// Velocity shocks of corners a, b, c and d; none, as those at places, where the contact is unfinished.
    pub delta_v_m_s: [Option<Json>; 4],
    /// Velocity shocks at the requested places.
    pub delta_v_at_m_s: Vec<Option<Json>>,
    /// The end of the contact, where contacts take time; infinite where the corner stays down.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub until_s: Option<Json>,
    /// True where a limit has cut off the contact.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub unfinished: bool,
}

impl Impact {
    /// Returns the largest shock of a corner, 0 where it is not known.
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
    /// True where a limit has ended the motion.
    cut: bool,
}

/// A strike of a corner, by any model.
#[derive(Debug, Clone, Copy)]
struct Strike {
    corner: usize,
    time_s: f64,
    approach_m_s: f64,
    delta_v_m_s: [f64; 4],
    /// The end of the contact, where it takes time.
    until_s: Option<f64>,
}

impl Strike {
    /// Returns the shock at a place in half-sides: the plate stays plane.
    fn delta_v_at(&self, [x, y]: [f64; 2]) -> f64 {
        let [a, b, c, d] = self.delta_v_m_s;
        0.25 * ((1.0 - y) * ((1.0 - x) * a + (1.0 + x) * b) + (1.0 + y) * ((1.0 - x) * d + (1.0 + x) * c))
    }
}

impl Impacts {
    /// Returns the number of strikes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.strikes.len()
    }
    /// Returns the strikes from the first on.
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

/// The followed motion of a drop.
struct Followed {
    strikes: Vec<Strike>,
    stop: Stop,
    contact: Option<ContactAnswer>,
}

/// The number of strikes that are followed without gravity unless more are requested.
const OF_MAP: usize = 1000;

/// Follows one drop of a plate.
pub(super) fn answer(question: &Question, scene: PlateScene, physics: Physics) -> Result<Answer, Error> {
    let Question { drop, at, height_m, .. } = question;
    on_plate(at)?;
    if physics == Physics::Map && scene.plate().product_of_inertia_m2() != 0.0 {
        let how = "masses that lie askew are followed with gravity alone: by ballistic or compliant";
        return Err(Error::input("product_of_inertia_m2", how));
    }
    let least = (physics == Physics::Map).then_some(OF_MAP);
    let scene = question.impact_limit.or(least).map_or(scene, |limit| scene.with_impact_limit(limit));
    let scene = question.time_limit_s.map_or(Ok(scene), |limit_s| scene.with_time_limit_s(limit_s))?;
    let ([left, right, front, back], [length, width]) = (scene.plate().edges_m(), scene.plate().sides_m());
    let center_of_mass = [(left - right) / length, (front - back) / width];
    let Followed { strikes, stop, contact } = match physics {
        Physics::Map => by_map(&scene, center_of_mass, drop.restitution)?,
        Physics::Ballistic => followed(&scene.impacts_until(drop.restitution, |_| false)?),
        Physics::Contacts(contact) => followed(&scene.contacts_until(&contact, 1e-4, |_| false)?),
        Physics::FiniteTilt => {
            let how =
                "finite-tilt follows bars: a plate is followed by map, without gravity, by ballistic or by compliant";
            return Err(Error::input("model", how));
        }
    };
    let impacts = Impacts { strikes, at: at.clone(), cut: is_cut(&stop) };
    let (limit_s, is_tilted) = (scene.time_limit_s(), scene.gaps_m().iter().any(|gap| *gap > 0.0));
    // The direction is that in which the plate rises from its lowest corner, which is a.
    let (sin, cos) = libm::sincos(drop.direction_rad);
    let direction_deg = neat(libm::atan2(sin.abs(), cos.abs()).to_degrees());
    Ok(Answer {
        model: question.model.name(),
        length_m: Json(neat(length)),
        width_m: Json(neat(width)),
        gyration_m: scene.plate().gyration_m().map(Json),
        center_of_mass: center_of_mass.map(Json),
        e: Json(drop.restitution),
        height_m: height_m.map(Json),
        speed_m_s: Json(scene.speed_m_s()),
        tilt_deg: Json(neat(drop.tilt_rad.to_degrees())),
        direction_deg: is_tilted.then_some(Json(direction_deg)),
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

/// Follows the drop without gravity: straight lines and impulses.
fn by_map(scene: &PlateScene, center_of_mass: [f64; 2], e: f64) -> Result<Followed, clatter::Error> {
    let ([kx, ky], [length, width]) = (scene.plate().gyration_m(), scene.plate().sides_m());
    let plate = clatter::Plate::off_center([kx / (0.5 * length), ky / (0.5 * width)], center_of_mass, e)?;
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
