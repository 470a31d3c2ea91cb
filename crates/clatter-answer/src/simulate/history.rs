//! This module adds the whole motion of a bar to the answer about its drop.

use clatter_flight::Motion;
use serde::{Serialize, Serializer};

use super::Answer;
use crate::Json;

/// An answer with the rows of the whole motion after it, as `"history"`.
#[derive(Debug, Serialize)]
pub struct WithHistory<'a> {
    #[serde(flatten)]
    answer: &'a Answer,
    history: History<'a>,
}

impl Answer {
    /// Adds the rows of the motion of a bar: straight lines through them follow it. Returns none of other bodies.
    #[must_use]
    pub fn with_history(&self) -> Option<WithHistory<'_>> {
        let history = History { at: &self.at, motion: self.impacts.train().motion()? };
        Some(WithHistory { answer: self, history })
    }
}

#[derive(Debug)]
struct History<'a> {
    at: &'a [[Json; 3]],
    motion: &'a Motion,
}

impl Serialize for History<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.motion.rows().map(|row| {
            let at = |of: &dyn Fn(f64) -> f64| self.at.iter().map(|[s, ..]| Json(of(s.0))).collect();
            Row {
                time_s: Json(row.time_s),
                height_m: row.height_m.map(Json),
                velocity_m_s: row.velocity_m_s.map(Json),
                velocity_at_m_s: at(&|s| row.velocity_at(s)),
                forces: row.forces.map(|forces| Forces {
                    force_per_mass_m_s2: forces.force_per_mass_m_s2.map(Json),
                    acceleration_m_s2: forces.acceleration_m_s2.map(Json),
                    acceleration_at_m_s2: at(&|s| forces.acceleration_at(s)),
                }),
            }
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
