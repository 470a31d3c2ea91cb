//! The answer for programs.

use clatter::End;
use clatter_flight::{Motion, Stop};
use serde::{Serialize, Serializer};

use super::Drop;
use crate::inputs::letter;
use crate::numbers::Json;

impl Drop<'_> {
    pub(super) fn answer(&self) -> Answer<'_> {
        let (setup, scene) = (&self.setup, &self.setup.scene);
        let body = scene.body();
        let motion = &self.motion;
        let limit = scene.time_limit_s();
        let pivots = motion.pivots.iter();
        Answer {
            model: setup.model.name(),
            length_m: Json(setup.length_m),
            gyration_m: Json(body.gyration_m()),
            center_of_mass: Json(setup.center_of_mass),
            thickness_m: Json(body.thickness_m()),
            inertia_ratios: body.inertia_ratios().map(Json),
            e: Json(scene.e()),
            height_m: setup.height_m.map(Json),
            speed_m_s: Json(scene.speed_m_s()),
            tilt_deg: Json(setup.tilt_deg),
            height_gap_m: Json(scene.height_gap_m()),
            gravity_m_s2: Json(scene.gravity_m_s2()),
            spin_rad_s: Json(scene.spin_rad_s()),
            contact: ContactJson::new(motion),
            time_limit_s: limit.is_finite().then_some(Json(limit)),
            impact_limit: scene.impact_limit(),
            at: self.at.iter().copied().map(Json).collect(),
            largest_delta_v_m_s: self.largest().map(Json).to_vec(),
            largest_delta_v_at_m_s: self.largest_at().map(Json).collect(),
            impacts: Impacts(self),
            pivots: pivots
                .map(|p| PivotJson { end: end(p.point), from_s: Json(p.from_s), until_s: Json(p.until_s) })
                .collect(),
            stop: StopJson::new(&motion.stop),
        }
    }
}

#[derive(Serialize)]
pub(super) struct Answer<'a> {
    model: &'static str,
    length_m: Json,
    gyration_m: Json,
    center_of_mass: Json,
    thickness_m: Json,
    inertia_ratios: [Json; 2],
    e: Json,
    #[serde(skip_serializing_if = "Option::is_none")]
    height_m: Option<Json>,
    speed_m_s: Json,
    tilt_deg: Json,
    height_gap_m: Json,
    gravity_m_s2: Json,
    spin_rad_s: Json,
    #[serde(flatten)]
    contact: Option<ContactJson>,
    time_limit_s: Option<Json>,
    impact_limit: usize,
    at: Vec<Json>,
    largest_delta_v_m_s: Vec<Json>,
    largest_delta_v_at_m_s: Vec<Json>,
    impacts: Impacts<'a>,
    /// Times in which one end lay on the ground and the body turned about it.
    pivots: Vec<PivotJson>,
    stop: StopJson,
}

/// The end with this index.
pub(super) fn end(point: usize) -> &'static str {
    letter(if point == 0 { End::A } else { End::B })
}

/// Where contacts take time.
#[derive(Serialize)]
struct ContactJson {
    contact_time_s: Json,
    contact_law: &'static str,
    /// What the energy of the body changes by without reason, over that at the first touch.
    energy_error: Json,
}

impl ContactJson {
    fn new(motion: &Motion) -> Option<Self> {
        motion.contact().map(|contact| Self {
            contact_time_s: Json(contact.time_s()),
            contact_law: contact.law().name(),
            energy_error: Json(motion.energy_error),
        })
    }
}

#[derive(Serialize)]
struct PivotJson {
    end: &'static str,
    from_s: Json,
    until_s: Json,
}

#[derive(Serialize)]
pub(super) struct StopJson {
    reason: &'static str,
    time_s: Json,
    #[serde(flatten)]
    rest: Option<RestJson>,
}

/// What is left takes no longer, null where nothing bounds it, and no shock left out is larger.
#[derive(Serialize)]
struct RestJson {
    time_bound_s: Option<Json>,
    shock_bound_m_s: Json,
}

impl StopJson {
    pub(super) fn new(stop: &Stop) -> Self {
        let rest = match *stop {
            Stop::AtRest { time_bound_s, shock_bound_m_s, .. } => {
                let time_bound_s = time_bound_s.is_finite().then_some(Json(time_bound_s));
                Some(RestJson { time_bound_s, shock_bound_m_s: Json(shock_bound_m_s) })
            }
            _ => None,
        };
        Self { reason: stop.reason(), time_s: Json(stop.time_s()), rest }
    }
}

#[derive(Serialize)]
struct ImpactJson {
    number: u64,
    end: &'static str,
    time_s: Json,
    approach_m_s: Json,
    /// Null, as those at positions, where the contact is unfinished.
    delta_v_m_s: [Option<Json>; 2],
    delta_v_at_m_s: Vec<Option<Json>>,
    /// Compliant only: when the contact ends; `"infinite"` where the end stays down.
    #[serde(skip_serializing_if = "Option::is_none")]
    until_s: Option<Json>,
    /// Where a limit has cut off the contact.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    unfinished: bool,
}

/// The strikes, written as they come.
struct Impacts<'a>(&'a Drop<'a>);

impl Serialize for Impacts<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let drop = self.0;
        serializer.collect_seq(drop.motion.strikes.iter().enumerate().map(|(i, strike)| {
            let unfinished = drop.is_unfinished(i);
            let shock = |x: f64| (!unfinished).then_some(Json(x));
            ImpactJson {
                number: strike.number,
                end: end(strike.point),
                time_s: Json(strike.time_s),
                approach_m_s: Json(strike.approach_m_s),
                delta_v_m_s: strike.delta_v_m_s.map(shock),
                delta_v_at_m_s: drop.shocks(strike).map(shock).collect(),
                until_s: drop.until_s(i).map(Json),
                unfinished,
            }
        }))
    }
}
