//! A part on a plate in one drop, with contacts that take time.
//!
//! ```
//! use clatter_answer::respond::plate;
//! use clatter_assess::PlateDrop;
//! use clatter_flight::{Contact, ContactLaw, Plate, PlateScene};
//! // The middle of a phone of 150 by 70 mm that falls at 4.43 m/s, with b 2 mm and d 1 mm higher as a touches.
//! let phone = Plate::new([0.075, 0.075, 0.035, 0.035], [0.0433, 0.0202])?;
//! let scene = PlateScene::new(phone, 4.43, [2e-3, 1e-3], 9.806_65)?;
//! let drop = PlateDrop { scene, contact: Contact::new(ContactLaw::Hysteretic, 0.3, 4e-4)? };
//! let answer = plate::answer(&plate::Question::new(drop, [0.0, 0.0]))?;
//! assert!(answer.velocity_change_m_s.0 > 0.0 && answer.acceleration_m_s2.0 > 0.0);
//! # Ok::<(), clatter_answer::Error>(())
//! ```

use clatter_assess::PlateDrop;
use clatter_shock::{ShockTable, Suspension};
use serde::Serialize;

use super::{Equivalent, Factors, LargestValues, Peaks, swings};
use crate::simulate::plate::told;
use crate::{Error, Json, on_plate};

/// A drop of a plate, corner a first, and a part of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The drop.
    pub drop: PlateDrop,
    /// Where the part is, in half-lengths and half-widths from the middle.
    pub at: [f64; 2],
    /// The part; none that is mounted rigidly.
    pub suspension: Option<Suspension>,
    /// How exact the answer is for the model, as a share of it.
    pub tolerance: f64,
    /// A table whose half-sine is to do the same to the part.
    pub shock_table: Option<ShockTable>,
    /// Center of mass in half-lengths and half-widths, as it is told.
    pub center_of_mass: [f64; 2],
    /// The steepest slope at the first touch in degrees, as it is told.
    pub tilt_deg: f64,
    /// Where it rises from corner a, from 0° along the length to 90°, as it is told; none of a level plate.
    pub direction_deg: Option<f64>,
}

impl Question {
    /// Of a place on which a part is mounted rigidly, to 1 %; all told as the scene has it.
    #[must_use]
    pub fn new(drop: PlateDrop, at: [f64; 2]) -> Self {
        let (center_of_mass, tilt_deg, direction_deg) = told(&drop.scene);
        Self { drop, at, suspension: None, tolerance: 0.01, shock_table: None, center_of_mass, tilt_deg, direction_deg }
    }
}

/// What a drop of a plate does to a part and at its place.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// What was kept of the drop: contacts that take time.
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
    /// At the first touch.
    pub speed_m_s: Json,
    /// The steepest slope.
    pub tilt_deg: Json,
    /// None of a plate that falls level.
    pub direction_deg: Option<Json>,
    /// Heights of b and d as a touches.
    pub gaps_m: [Json; 2],
    /// Of gravity.
    pub gravity_m_s2: Json,
    /// Of a lone contact.
    pub contact_time_s: Json,
    /// What the ground does meanwhile.
    pub contact_law: &'static str,
    /// Asked for.
    pub tolerance: Json,
    /// The place.
    pub at: [Json; 2],
    /// The part and its peaks.
    #[serde(flatten)]
    pub part: Option<Peaks>,
    /// Largest change of velocity of one shock at the place.
    pub velocity_change_m_s: Json,
    /// Largest felt there.
    pub acceleration_m_s2: Json,
    /// Largest of one shock, about any axis in the plane.
    pub angular_velocity_change_rad_s: Json,
    /// When the largest values come.
    pub answers: LargestValues,
    /// What (1 + e) v at once would do to the part, as without clatter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clatter_free: Option<Factors>,
    /// What 2 v would do, as standards assume.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standard: Option<Factors>,
    /// Where a shock table was given.
    #[serde(flatten)]
    pub equivalent: Option<Equivalent>,
}

/// Follows one drop until nothing later counts.
///
/// # Errors
/// A place off the plate; a part too slow or too fast; those of [`PlateDrop::answers`].
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { drop, at, suspension, tolerance, .. } = question;
    on_plate(&[*at])?;
    swings(suspension.as_ref())?;
    let (plate, scene, contact) = (drop.scene.plate(), &drop.scene, &drop.contact);
    let answers = drop.answers(plate.place(*at), suspension.as_ref(), *tolerance)?;
    let part = suspension.zip(answers.part.as_ref());
    let equivalent = part.zip(question.shock_table);
    let equivalent = equivalent.map(|((part, answer), table)| Equivalent::new(&table, &part, &answer.response));
    let at_once = suspension.map(|part| Factors::at_once(part.damping(), contact.restitution(), scene.speed_m_s()));
    let [length, width] = plate.sides_m();
    Ok(Answer {
        model: "compliant",
        length_m: Json(length),
        width_m: Json(width),
        gyration_m: plate.gyration_m().map(Json),
        center_of_mass: question.center_of_mass.map(Json),
        e: Json(contact.restitution()),
        speed_m_s: Json(scene.speed_m_s()),
        tilt_deg: Json(question.tilt_deg),
        direction_deg: question.direction_deg.map(Json),
        gaps_m: scene.gaps_m().map(Json),
        gravity_m_s2: Json(scene.gravity_m_s2()),
        contact_time_s: Json(contact.time_s()),
        contact_law: contact.law().name(),
        tolerance: Json(*tolerance),
        at: at.map(Json),
        part: part.map(|(part, answer)| Peaks::new(&part, &answer.response, |_| None)),
        velocity_change_m_s: Json(answers.velocity_change.value),
        acceleration_m_s2: Json(answers.acceleration.value),
        angular_velocity_change_rad_s: Json(answers.angular_velocity_change.value),
        answers: LargestValues {
            velocity_change: Some(answers.velocity_change.into()),
            acceleration: Some(answers.acceleration.into()),
            angular_velocity_change: Some(answers.angular_velocity_change.into()),
            part_acceleration: part.map(|(_, part)| part.acceleration.into()),
            part_displacement: part.map(|(_, part)| part.displacement.into()),
        },
        clatter_free: at_once.map(|[flat, _]| flat),
        standard: at_once.map(|[_, standard]| standard),
        equivalent: equivalent.transpose()?,
    })
}
