//! This module follows one drop of any body in time: its impacts, how hard they are, and how it comes to rest.
//!
//! ```
//! use clatter_answer::simulate;
//! use clatter_product::{Body, Drop, Model};
//! // Mass spread evenly over 140 mm, at 4.43 m/s and a tilt of 5°.
//! let drop = Drop::new(Body::new(0.14, 0.0404)?, 4.43, 5_f64.to_radians(), 0.3);
//! let answer = simulate::answer(&simulate::Question::new(drop, Model::FiniteTilt))?;
//! let first = answer.impacts.iter().next().expect("an impact");
//! assert_eq!((first.end, first.approach_m_s.0, answer.stop.reason()), (Some("a"), -4.43, "at-rest"));
//! # Ok::<(), clatter_answer::Error>(())
//! ```

mod history;

use clatter_flight::{Model as Physics, Pivot, Stop, Train};
use clatter_product::{Drop, Model};
use serde::{Serialize, Serializer};

use crate::{Error, Json, on_body};

pub use history::WithHistory;

/// A drop, and the physics that is kept of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The drop.
    pub drop: Drop,
    /// The model, which decides the physics that are kept.
    pub model: Model,
    /// Places whose velocity shocks are requested, in half-sides from the middle along length, width and thickness, which count from what
    /// touches first: end a or corner a. The width of a bar and the thickness of a bar or a plate are not looked at.
    pub at: Vec<[f64; 3]>,
    /// The time until which the drop is followed, where that is limited.
    pub time_limit_s: Option<f64>,
    /// The largest number of impacts that are followed: 100 000 unless given, of a plate without gravity 1000.
    pub impact_limit: Option<usize>,
}

impl Question {
    /// Makes a question that follows the drop until it rests, without a place but the ends or corners.
    #[must_use]
    pub fn new(drop: Drop, model: Model) -> Self {
        Self { drop, model, at: Vec::new(), time_limit_s: None, impact_limit: None }
    }
}

/// A drop in time.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// The model of the drop.
    pub model: &'static str,
    /// The drop as data, as seen from what touches first: end a or corner a.
    pub drop: Drop,
    /// The inertia ratios for strikes at end a and end b of a bar.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia_ratios: Option<[Json; 2]>,
    /// The numerical error of the energy of the body over its energy at the first touch, where contacts take time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_error: Option<Json>,
    /// The time until which the drop was followed, where that was limited.
    pub time_limit_s: Option<Json>,
    /// The largest number of impacts followed.
    pub impact_limit: usize,
    /// The requested places.
    pub at: Vec<[Json; 3]>,
    /// Largest velocity shock of each end or corner, in its own impacts and those of the others.
    pub largest_delta_v_m_s: Vec<Json>,
    /// The same at the requested places.
    pub largest_delta_v_at_m_s: Vec<Json>,
    /// The impacts.
    pub impacts: Impacts,
    /// Times in which one end of a bar lay on the ground and the body turned about it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pivots: Option<Vec<PivotAnswer>>,
    /// How a box moves where it ends.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end: Option<EndAnswer>,
    /// The reason why the motion ends.
    #[serde(serialize_with = "stop")]
    pub stop: Stop,
}

/// The motion of a box at the end of a drop.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct EndAnswer {
    /// The time since the first touch.
    pub time_s: Json,
    /// Velocity of the center of mass, along the axes of the world.
    pub velocity_m_s: [Json; 3],
    /// Spin, about the axes of the box.
    pub spin_rad_s: [Json; 3],
}

/// A time in which one end lay on the ground.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct PivotAnswer {
    /// The end, `"a"` or `"b"`.
    pub end: &'static str,
    /// The beginning, from the first touch on.
    pub from_s: Json,
    /// The end, from the first touch on.
    pub until_s: Json,
}

/// One impact.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Impact {
    /// The number of the impact, from 1.
    pub number: usize,
    /// The end of a bar that strikes, `"a"` or `"b"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end: Option<&'static str>,
    /// The corner that strikes: `"a"` to `"d"` of a plate, the signs of x, y and z of a box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corner: Option<&'static str>,
    /// The time since the first touch.
    pub time_s: Json,
    /// Vertical velocity of the end or corner just before.
    pub approach_m_s: Json,
    /// Vertical velocity shocks of all ends or corners; none, as those at places, where the contact is unfinished.
    pub delta_v_m_s: Vec<Option<Json>>,
    /// Velocity shocks at the requested places.
    pub delta_v_at_m_s: Vec<Option<Json>>,
    /// The end of the contact, where contacts take time; infinite where the end or corner stays down.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub until_s: Option<Json>,
    /// True where a limit has cut off the contact.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub unfinished: bool,
}

impl Impact {
    /// Returns the name of the end or corner that strikes.
    #[must_use]
    pub fn point(&self) -> &'static str {
        self.end.or(self.corner).unwrap_or_default()
    }
    /// Returns the largest shock of an end or corner, 0 where it is not known.
    #[must_use]
    pub fn largest_m_s(&self) -> f64 {
        self.delta_v_m_s.iter().flatten().fold(0.0, |most: f64, v| most.max(v.0.abs()))
    }
}

/// The impacts of a drop, made while they are read.
#[derive(Debug, Clone)]
pub struct Impacts {
    drop: Drop,
    at: Vec<[f64; 3]>,
    train: Train,
}

impl Impacts {
    /// Returns the followed drop whose impacts they are.
    #[must_use]
    pub fn train(&self) -> &Train {
        &self.train
    }
    /// Returns the impacts from the first on.
    pub fn iter(&self) -> impl Iterator<Item = Impact> + '_ {
        let (points, is_end) = (self.drop.points(), !self.drop.body.is_wide());
        let is_cut = !matches!(self.train.stop, Stop::AtRest { .. } | Stop::BouncedClear { .. });
        self.train.impacts().enumerate().map(move |(k, impact)| {
            let unfinished = is_cut && impact.until_s.is_some_and(f64::is_infinite);
            let (point, shock) = (points[impact.point], |x: f64| (!unfinished).then_some(Json(x)));
            Impact {
                number: k + 1,
                end: is_end.then_some(point),
                corner: (!is_end).then_some(point),
                time_s: Json(impact.time_s),
                approach_m_s: Json(impact.approach_m_s),
                delta_v_m_s: impact.delta_v_m_s.iter().copied().map(shock).collect(),
                delta_v_at_m_s: self.at.iter().map(|at| shock(impact.delta_v_at(*at))).collect(),
                until_s: impact.until_s.map(Json),
                unfinished,
            }
        })
    }
    /// Returns how many impacts of a bar begin while the other end still presses, and the number of the first of them.
    #[must_use]
    pub fn overlaps(&self) -> Option<(usize, usize)> {
        let (mut parted_s, mut found) = (f64::NEG_INFINITY, None);
        for (k, press) in self.train.motion()?.presses.iter().enumerate() {
            if press.from_s < parted_s {
                found = Some(found.map_or((1, k + 1), |(count, first)| (count + 1, first)));
            }
            parted_s = parted_s.max(press.until_s);
        }
        found
    }
    fn largest(&self, of: impl Fn(clatter_flight::Impact<'_>) -> f64) -> Json {
        Json(self.train.impacts().map(|impact| of(impact).abs()).fold(0.0, f64::max))
    }
}

impl Serialize for Impacts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

/// Follows one drop.
///
/// # Errors
/// A place off the body, contacts of their own, and a model that does not follow the body; those of its flight.
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { drop, model, ref at, time_limit_s, impact_limit } = *question;
    on_body(at.iter().flatten().copied())?;
    if !drop.own_contacts.is_none() {
        return Err(Error::input("contacts", "a drop is followed strike by strike with contacts that are alike"));
    }
    let (drop, physics) = (drop.from_first(), model.physics(&drop)?);
    is_followed(&drop, physics)?;
    let train = Train::new(&drop, physics, time_limit_s, impact_limit)?;
    let (stop, time_limit_s, impact_limit) = (train.stop, train.time_limit_s.map(Json), train.impact_limit);
    let (points, motion) = (drop.points(), train.motion());
    let pivot = |pivot: &Pivot| PivotAnswer {
        end: points[pivot.point],
        from_s: Json(pivot.from_s),
        until_s: Json(pivot.until_s),
    };
    let pivots = motion.map(|motion| motion.pivots.iter().map(pivot).collect());
    let inertia_ratios = motion.map(|_| drop.body.inertia_ratios().map(Json));
    let energy_error = train.energy_error.map(Json);
    let end = train.end().map(|end| EndAnswer {
        time_s: Json(end.time_s),
        velocity_m_s: end.velocity_m_s.map(Json),
        spin_rad_s: end.spin_rad_s.map(Json),
    });
    let impacts = Impacts { drop, at: at.clone(), train };
    Ok(Answer {
        model: model.name(),
        drop,
        inertia_ratios,
        energy_error,
        time_limit_s,
        impact_limit,
        at: at.iter().map(|place| place.map(Json)).collect(),
        largest_delta_v_m_s: (0..points.len()).map(|i| impacts.largest(|impact| impact.delta_v_m_s[i])).collect(),
        largest_delta_v_at_m_s: at.iter().map(|at| impacts.largest(|impact| impact.delta_v_at(*at))).collect(),
        impacts,
        pivots,
        end,
        stop,
    })
}

/// Refuses a model that does not follow the body.
fn is_followed(drop: &Drop, physics: Physics) -> Result<(), Error> {
    let takes_time = matches!(physics, Physics::Contacts(_));
    let (name, how) = if drop.is_solid() && !takes_time {
        ("model", "a box is followed with contacts that take time alone: compliant, with a short contact time")
    } else if drop.body.is_wide() && physics == Physics::FiniteTilt {
        let how = "finite-tilt follows bars: a plate is followed by map, without gravity, by ballistic or by compliant";
        ("model", how)
    } else if drop.body.products_m2[0] != 0.0 && physics == Physics::Map {
        ("product_of_inertia_m2", "masses that lie askew are followed with gravity alone: by ballistic or compliant")
    } else {
        return Ok(());
    };
    Err(Error::input(name, how))
}

/// Describes the physics that a model keeps of a drop, with its gravity and its contact time written so.
#[must_use]
pub fn physics_in_words(
    drop: &Drop,
    model: Model,
    gravity: impl Fn(f64) -> String,
    time: impl Fn(f64) -> String,
) -> String {
    let is_small = matches!(model, Model::Map | Model::Ballistic) || drop.body.is_wide() && drop.is_level;
    let tilt = if is_small { "Small" } else { "Any" };
    let contacts = match drop.contact_time_s.filter(|_| model == Model::Compliant) {
        Some(time_s) => format!("{} contacts of {}", drop.contact_law.name(), time(time_s)),
        None => "instant impacts".to_owned(),
    };
    let friction = if drop.is_solid() { format!(", friction {}", drop.friction) } else { String::new() };
    let gravity =
        if model == Model::Map { "no gravity".to_owned() } else { format!("gravity {}", gravity(drop.gravity_m_s2)) };
    format!("{tilt} tilt, {gravity}, {contacts}{friction}")
}

#[derive(Serialize)]
struct StopJson {
    reason: &'static str,
    time_s: Json,
    #[serde(flatten)]
    rest: Option<RestJson>,
}

/// The bounds on the rest of the motion: its time, null where nothing bounds it, and its largest shock.
#[derive(Serialize)]
struct RestJson {
    time_bound_s: Option<Json>,
    shock_bound_m_s: Json,
}

fn stop<S: Serializer>(stop: &Stop, serializer: S) -> Result<S::Ok, S::Error> {
    let rest = match *stop {
        Stop::AtRest { time_bound_s, shock_bound_m_s, .. } => {
            let time_bound_s = time_bound_s.is_finite().then_some(Json(time_bound_s));
            Some(RestJson { time_bound_s, shock_bound_m_s: Json(shock_bound_m_s) })
        }
        _ => None,
    };
    StopJson { reason: stop.reason(), time_s: Json(stop.time_s()), rest }.serialize(serializer)
}
