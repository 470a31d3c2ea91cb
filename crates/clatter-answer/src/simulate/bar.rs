//! This module follows one drop of a bar in time: its strikes, how hard they are, and how it comes to rest.

use clatter::End;
use clatter_flight::{Model as Physics, Motion, Stop, Strike};
use serde::{Serialize, Serializer};

use super::{ContactAnswer, Question, is_cut, stop};
use crate::{Error, Json, letter, neat, on_body};

/// A drop of a bar in time.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// The model of the drop.
    pub model: &'static str,
    /// The length from end to end.
    pub length_m: Json,
    /// Radius of gyration about the center of mass.
    pub gyration_m: Json,
    /// The position of the center of mass, in [−1, 1].
    pub center_of_mass: Json,
    /// The thickness of the body.
    pub thickness_m: Json,
    /// The inertia ratios for strikes at end a and end b.
    pub inertia_ratios: [Json; 2],
    /// Coefficient of restitution.
    pub e: Json,
    /// The height from which it fell, where that was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_m: Option<Json>,
    /// The speed at the first touch.
    pub speed_m_s: Json,
    /// The tilt at the first touch.
    pub tilt_deg: Json,
    /// The height of end b as a touches.
    pub height_gap_m: Json,
    /// The acceleration of gravity.
    pub gravity_m_s2: Json,
    /// The angular velocity at the first touch, end b upward.
    pub spin_rad_s: Json,
    /// The contacts, where they take time.
    #[serde(flatten)]
    pub contact: Option<ContactAnswer>,
    /// The time until which the drop was followed, where that was limited.
    pub time_limit_s: Option<Json>,
    /// The largest number of strikes followed.
    pub impact_limit: usize,
    /// The requested positions.
    pub at: Vec<Json>,
    /// Largest velocity shock of each end, in its own strikes and those of the other.
    pub largest_delta_v_m_s: [Json; 2],
    /// The same at the requested positions.
    pub largest_delta_v_at_m_s: Vec<Json>,
    /// The strikes.
    pub impacts: Impacts,
    /// Times in which one end lay on the ground and the body turned about it.
    pub pivots: Vec<PivotAnswer>,
    /// The reason why the motion ends.
    #[serde(serialize_with = "stop")]
    pub stop: Stop,
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

/// One strike of a bar.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Impact {
    /// The number of the strike, from 1.
    pub number: u64,
    /// The end that strikes, `"a"` or `"b"`.
    pub end: &'static str,
    /// The time since the first touch.
    pub time_s: Json,
    /// Velocity of the end just before.
    pub approach_m_s: Json,
    /// Velocity shocks of both ends; none, as those at positions, where the contact is unfinished.
    pub delta_v_m_s: [Option<Json>; 2],
    /// Velocity shocks at the requested positions.
    pub delta_v_at_m_s: Vec<Option<Json>>,
    /// The end of the contact, where contacts take time; infinite where the end of the bar stays down.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub until_s: Option<Json>,
    /// True where a limit has cut off the contact.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub unfinished: bool,
}

impl Impact {
    /// Returns the larger shock of the ends, 0 where it is not known.
    #[must_use]
    pub fn largest_m_s(&self) -> f64 {
        self.delta_v_m_s.into_iter().flatten().fold(0.0, |most: f64, v| most.max(v.0.abs()))
    }
}

/// The strikes of a motion, made while they are read.
#[derive(Debug, Clone)]
pub struct Impacts {
    at: Vec<f64>,
    motion: Motion,
}

impl Impacts {
    /// Returns the motion whose strikes they are.
    #[must_use]
    pub fn motion(&self) -> &Motion {
        &self.motion
    }
    /// Returns the strikes from the first on.
    pub fn iter(&self) -> impl Iterator<Item = Impact> + '_ {
        (0..self.motion.strikes.len()).map(|i| self.get(i))
    }
    /// Returns how many strikes begin while the other end still presses, and the number of the first of them.
    #[must_use]
    pub fn overlaps(&self) -> Option<(usize, u64)> {
        let (mut parted_s, mut found) = (f64::NEG_INFINITY, None);
        for (press, strike) in self.motion.presses.iter().zip(&self.motion.strikes) {
            if press.from_s < parted_s {
                found = Some(found.map_or((1, strike.number), |(count, first)| (count + 1, first)));
            }
            parted_s = parted_s.max(press.until_s);
        }
        found
    }
    fn get(&self, i: usize) -> Impact {
        let strike = &self.motion.strikes[i];
        let until_s = self.motion.presses.get(i).map(|press| press.until_s);
        let unfinished = is_cut(&self.motion.stop) && until_s.is_some_and(f64::is_infinite);
        let shock = |x: f64| (!unfinished).then_some(Json(x));
        Impact {
            number: strike.number,
            end: letter(if strike.point == 0 { End::A } else { End::B }),
            time_s: Json(strike.time_s),
            approach_m_s: Json(strike.approach_m_s),
            delta_v_m_s: strike.delta_v_m_s.map(shock),
            delta_v_at_m_s: self.at.iter().map(|&s| shock(strike.delta_v_at(s))).collect(),
            until_s: until_s.map(Json),
            unfinished,
        }
    }
    fn largest_m_s(&self, s: f64) -> Json {
        let shock = |strike: &Strike| strike.delta_v_at(s).abs();
        Json(self.motion.strikes.iter().map(shock).fold(0.0, f64::max))
    }
}

impl Serialize for Impacts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

/// An answer with the rows of the whole motion after it, as `"history"`.
#[derive(Debug, Serialize)]
pub struct WithHistory<'a> {
    #[serde(flatten)]
    answer: &'a Answer,
    history: History<'a>,
}

impl Answer {
    /// Adds the rows of the motion: straight lines through them follow it.
    #[must_use]
    pub fn with_history(&self) -> WithHistory<'_> {
        WithHistory { answer: self, history: History(&self.impacts) }
    }
}

#[derive(Debug)]
struct History<'a>(&'a Impacts);

impl Serialize for History<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Impacts { at, motion } = self.0;
        serializer.collect_seq(motion.rows().map(|row| Row {
            time_s: Json(row.time_s),
            height_m: row.height_m.map(Json),
            velocity_m_s: row.velocity_m_s.map(Json),
            velocity_at_m_s: at.iter().map(|s| Json(row.velocity_at(*s))).collect(),
            forces: row.forces.map(|forces| Forces {
                force_per_mass_m_s2: forces.force_per_mass_m_s2.map(Json),
                acceleration_m_s2: forces.acceleration_m_s2.map(Json),
                acceleration_at_m_s2: at.iter().map(|s| Json(forces.acceleration_at(*s))).collect(),
            }),
        }))
    }
}

#[derive(Serialize)]
struct Row {
    time_s: Json,
    height_m: [Json; 2],
    velocity_m_s: [Json; 2],
    velocity_at_m_s: Vec<Json>,
    #[serde(flatten)]
    forces: Option<Forces>,
}

#[derive(Serialize)]
#[expect(clippy::struct_field_names, reason = "each name ends in its unit")]
struct Forces {
    force_per_mass_m_s2: [Json; 2],
    acceleration_m_s2: [Json; 2],
    acceleration_at_m_s2: Vec<Json>,
}

/// Follows one drop of a bar.
pub(super) fn answer(question: &Question, physics: Physics) -> Result<Answer, Error> {
    let at: Vec<f64> = question.at.iter().map(|[s, _]| *s).collect();
    on_body(at.iter().copied())?;
    let scene = question.drop.scene()?;
    let scene = question.impact_limit.map_or(Ok(scene), |limit| scene.with_impact_limit(limit))?;
    let scene = question.time_limit_s.map_or(Ok(scene), |limit_s| scene.with_time_limit_s(limit_s))?;
    let (body, limit_s) = (scene.body(), scene.time_limit_s());
    let [a, b] = body.arms_m();
    let impacts = Impacts { at: at.clone(), motion: scene.fly(physics)? };
    let motion = &impacts.motion;
    let pivot = |pivot: &clatter_flight::Pivot| PivotAnswer {
        end: letter(if pivot.point == 0 { End::A } else { End::B }),
        from_s: Json(pivot.from_s),
        until_s: Json(pivot.until_s),
    };
    Ok(Answer {
        model: question.model.name(),
        length_m: Json(neat(body.length_m())),
        gyration_m: Json(body.gyration_m()),
        center_of_mass: Json((a - b) / (a + b)),
        thickness_m: Json(body.thickness_m()),
        inertia_ratios: body.inertia_ratios().map(Json),
        e: Json(scene.e()),
        height_m: question.height_m.map(Json),
        speed_m_s: Json(scene.speed_m_s()),
        tilt_deg: Json(neat(scene.tilt_rad().to_degrees())),
        height_gap_m: Json(scene.height_gap_m()),
        gravity_m_s2: Json(scene.gravity_m_s2()),
        spin_rad_s: Json(scene.spin_rad_s()),
        contact: motion.contact().map(|contact| ContactAnswer::new(&contact, motion.energy_error)),
        time_limit_s: limit_s.is_finite().then_some(Json(limit_s)),
        impact_limit: scene.impact_limit(),
        at: at.iter().copied().map(Json).collect(),
        largest_delta_v_m_s: [-1.0, 1.0].map(|s| impacts.largest_m_s(s)),
        largest_delta_v_at_m_s: at.iter().map(|&s| impacts.largest_m_s(s)).collect(),
        pivots: motion.pivots.iter().map(pivot).collect(),
        stop: motion.stop,
        impacts,
    })
}
