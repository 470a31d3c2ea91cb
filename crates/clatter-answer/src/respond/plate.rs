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
//! assert!(answer.place.velocity_change_m_s.0 > 0.0);
//! # Ok::<(), clatter_answer::Error>(())
//! ```

use clatter::Corner;
use clatter_assess::{Body, Drop, Feet, Model, OwnContacts, Part, Place};
use clatter_flight::{Contact, PlateScene};
use clatter_shock::{ShockTable, Suspension};
use serde::Serialize;

use super::limits::OneDrop;
use super::{AtPlace, ContactAt, Position, contacts};
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
    /// How exact the answer is for the model, as a share of it.
    pub tolerance: Json,
    /// The place that is answered.
    pub at: [Json; 2],
    /// The part and its place.
    #[serde(flatten)]
    pub place: AtPlace,
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
    let drop = Drop::of_plate(scene, contact)?;
    let body = Body { feet: question.feet, ..drop.body };
    let drop = Drop { body, own_contacts: question.own_contacts, ..drop };
    let (plate, signs) = (scene.plate(), question.mirrored.map(|is| if is { -1.0 } else { 1.0 }));
    let [length, width] = plate.sides_m();
    let place = |[x, y]: &[f64; 2]| {
        let [x, y] = [0.5 * length * x, 0.5 * width * y];
        (Part::at(Place::flat([signs[0] * x, signs[1] * y]), None), Position::Both([Json(x), Json(y)]))
    };
    let places: Vec<_> = at.iter().map(place).collect();
    let asked = OneDrop {
        drop,
        model: Model::Compliant,
        tolerance: *tolerance,
        suspension: *suspension,
        limits: question.limits.as_deref(),
        shock_table: question.shock_table,
    };
    // The corner that touches first feels every drop.
    let place = asked.at(&Part::at(Place::flat([-0.5 * length, -0.5 * width]), None), &places)?;
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
        at: at[place.index].map(Json),
        place,
    })
}
