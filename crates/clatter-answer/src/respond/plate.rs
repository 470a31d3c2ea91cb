//! A part on a plate in one drop, with contacts that take time, answered as an assessment answers it.
//!
//! ```
//! use clatter_answer::respond::plate;
//! use clatter_flight::{Contact, ContactLaw, Plate, PlateScene};
//! // The middle of a phone of 150 by 70 mm that falls at 4.43 m/s, with b 2 mm and d 1 mm higher as a touches.
//! let phone = Plate::new([0.075, 0.075, 0.035, 0.035], [0.0433, 0.0202])?;
//! let scene = PlateScene::new(phone, 4.43, [2e-3, 1e-3], 9.806_65)?;
//! let contact = Contact::new(ContactLaw::Hysteretic, 0.3, 4e-4)?;
//! let answer = plate::answer(&plate::Question::new(scene, contact, [0.0, 0.0]))?;
//! assert!(answer.velocity_change_m_s.0 > 0.0 && answer.acceleration_m_s2.0 > 0.0);
//! # Ok::<(), clatter_answer::Error>(())
//! ```

use clatter::Corner;
use clatter_assess::{Body, Drop, Feet, LimitKind, Model, OwnContacts, Part, Place};
use clatter_flight::{Contact, PlateScene};
use clatter_shock::{ShockTable, Suspension};
use serde::Serialize;

use super::limits::{OneDrop, unlimited, value};
use super::{ContactAt, Equivalent, Factors, LargestValues, Limit, Peaks, Position, contacts, swings};
use crate::simulate::plate::told;
use crate::{Error, Json, on_body_beyond};

/// A drop of a plate and a part of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The drop, corner a first.
    pub scene: PlateScene,
    /// What the ground does to a corner.
    pub contact: Contact,
    /// Feet that it lands on, which are its corners here: places may lie beyond them.
    pub feet: Option<Feet>,
    /// Ends or corners with a contact of their own, as the scene has them.
    pub own_contacts: OwnContacts,
    /// Whether length and width of the product run the other way than those of the scene, so that another corner of it is a there.
    pub mirrored: [bool; 2],
    /// Where on the product the part may be, in half-lengths and half-widths from the middle: of several the place is answered that asks
    /// most of a limit, else the first.
    pub at: Vec<[f64; 2]>,
    /// The part; none that is mounted rigidly.
    pub suspension: Option<Suspension>,
    /// Limits of the part that are held against the drop.
    pub limits: Option<Vec<clatter_assess::Limit>>,
    /// How exact the answer is for the model, as a share of it.
    pub tolerance: f64,
    /// A table whose half-sine is to do the same to the part.
    pub shock_table: Option<ShockTable>,
    /// Center of mass of the scene in half-lengths and half-widths, as it is told.
    pub center_of_mass: [f64; 2],
    /// The steepest slope at the first touch in degrees, as it is told.
    pub tilt_deg: f64,
    /// Where the product rises to from its lowest corner, from 0° along its length to 90° along its width, as it is told; none of a level
    /// plate.
    pub direction_deg: Option<f64>,
}

impl Question {
    /// Of a place on which a part is mounted rigidly, to 1 %; all told as the scene has it.
    #[must_use]
    pub fn new(scene: PlateScene, contact: Contact, at: [f64; 2]) -> Self {
        let (center_of_mass, tilt_deg, direction_deg) = told(&scene);
        Self {
            scene,
            contact,
            feet: None,
            own_contacts: OwnContacts::NONE,
            mirrored: [false; 2],
            at: vec![at],
            suspension: None,
            limits: None,
            tolerance: 0.01,
            shock_table: None,
            center_of_mass,
            tilt_deg,
            direction_deg,
        }
    }

    /// The corner of the product that touches first.
    fn first(&self) -> Corner {
        match self.mirrored {
            [false, false] => Corner::A,
            [true, false] => Corner::B,
            [true, true] => Corner::C,
            [false, true] => Corner::D,
        }
    }
}

/// What a drop of a plate does to a part and at its place.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// What was kept of the drop: contacts that take time.
    pub model: &'static str,
    /// The corner that touches first.
    pub first: char,
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
    /// Rates of the slopes along length and width at the first touch; left out where it does not turn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin_rad_s: Option<[Json; 2]>,
    /// Heights of the corners next to the first one as it touches, along the length and along the width.
    pub gaps_m: [Json; 2],
    /// Of gravity.
    pub gravity_m_s2: Json,
    /// Of a lone contact.
    pub contact_time_s: Json,
    /// What the ground does meanwhile.
    pub contact_law: &'static str,
    /// Corners with a contact of their own.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<ContactAt>,
    /// OneDrop for.
    pub tolerance: Json,
    /// The place that is answered.
    pub at: [Json; 2],
    /// The limits that were given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limits: Option<Vec<Limit>>,
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
/// No place or one off the plate; a part too slow or too fast; those of [`Drop::of_plate`] and of [`clatter_assess::answer`].
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { scene, contact, at, suspension, tolerance, .. } = question;
    for (side, length_m) in scene.plate().sides_m().into_iter().enumerate() {
        let inset_m = question.feet.map(|feet| feet.inset_m[side]);
        on_body_beyond(at.iter().map(|place| place[side]), length_m, inset_m)?;
    }
    let Some(&at_first) = at.first() else { return Err(clatter_shock::Error::Empty("the list of places").into()) };
    let drop = Drop::of_plate(scene, contact)?;
    let body = Body { feet: question.feet, ..drop.body };
    let drop = Drop { body, own_contacts: question.own_contacts, ..drop };
    let asked = OneDrop { drop, model: Model::Compliant, tolerance: *tolerance };
    let (plate, signs) = (scene.plate(), question.mirrored.map(|is| if is { -1.0 } else { 1.0 }));
    let [length, width] = plate.sides_m();
    // The corner that touches first feels every drop: where not even that is answered, none is.
    let corner = Part::at(Place::flat([-0.5 * length, -0.5 * width]), None);
    asked.answer(&unlimited(LimitKind::VelocityChange), &corner)?;
    swings(suspension.as_ref())?;
    let on_product = |[x, y]: [f64; 2]| [0.5 * length * x, 0.5 * width * y];
    let in_scene = |at: [f64; 2]| {
        let [x, y] = on_product(at);
        [signs[0] * x, signs[1] * y]
    };
    let part = |at: [f64; 2]| Part::at(Place::flat(at), None);
    let place = |at: &[f64; 2]| (part(in_scene(*at)), Position::Both(on_product(*at).map(Json)));
    let places: Vec<_> = at.iter().map(place).collect();
    let limits = question.limits.as_ref().map(|limits| asked.limits(limits, &places, *suspension)).transpose()?;
    let tightest = limits.as_ref().and_then(|limits| Limit::tightest(limits));
    let at = tightest.map_or(at_first, |limit| at[limit.place]);
    let there = part(in_scene(at));
    let largest = |kind, part| asked.largest(kind, &there, part);
    let answers = LargestValues {
        velocity_change: largest(LimitKind::VelocityChange, None)?,
        acceleration: largest(LimitKind::Acceleration, None)?,
        angular_velocity_change: largest(LimitKind::AngularVelocityChange, None)?,
        part_acceleration: suspension.map_or(Ok(None), |_| largest(LimitKind::Acceleration, *suspension))?,
        part_displacement: suspension.map_or(Ok(None), |_| largest(LimitKind::RattleSpace, *suspension))?,
    };
    let response = |part| clatter_assess::respond(&asked.drop, &there, &part, Model::Compliant, *tolerance);
    let response = suspension.map(response).transpose()?;
    let part = suspension.as_ref().zip(response.as_ref());
    let equivalent = part.zip(question.shock_table);
    let equivalent = equivalent.map(|((part, response), table)| Equivalent::new(&table, part, response));
    let at_once = suspension.map(|part| Factors::at_once(part.damping(), contact.restitution(), scene.speed_m_s()));
    let [cx, cy] = question.center_of_mass;
    Ok(Answer {
        model: Model::Compliant.name(),
        first: question.first().letter(),
        length_m: Json(length),
        width_m: Json(width),
        gyration_m: plate.gyration_m().map(Json),
        center_of_mass: [signs[0] * cx, signs[1] * cy].map(|center| Json(center + 0.0)),
        e: Json(contact.restitution()),
        speed_m_s: Json(scene.speed_m_s()),
        tilt_deg: Json(question.tilt_deg),
        direction_deg: question.direction_deg.map(Json),
        spin_rad_s: Some(scene.spin_rad_s())
            .filter(|spin| spin.iter().any(|rate| *rate != 0.0))
            .map(|spin| spin.map(Json)),
        gaps_m: scene.gaps_m().map(Json),
        gravity_m_s2: Json(scene.gravity_m_s2()),
        contact_time_s: Json(contact.time_s()),
        contact_law: contact.law().name(),
        contacts: contacts(
            &question.own_contacts.mirrored(question.mirrored),
            contact.restitution(),
            Some(contact.time_s()),
        ),
        tolerance: Json(*tolerance),
        at: at.map(Json),
        limits,
        part: part.map(|(part, response)| Peaks::new(part, response, |_| None)),
        velocity_change_m_s: value(answers.velocity_change),
        acceleration_m_s2: value(answers.acceleration),
        angular_velocity_change_rad_s: value(answers.angular_velocity_change),
        answers,
        clatter_free: at_once.map(|[flat, _]| flat),
        standard: at_once.map(|[_, standard]| standard),
        equivalent: equivalent.transpose()?,
    })
}
