//! A part in one drop of a bar, answered as an assessment answers it.
//!
//! ```
//! use clatter_answer::respond::drop;
//! use clatter_assess::Model;
//! use clatter_flight::{Profile, Scene};
//! // A place at end b of a phone, 140 mm long, that falls at 4.43 m/s and a tilt of 5°.
//! let scene = Scene::new(Profile::new(0.14, 0.0404)?, 0.3, 4.43, 5.0, 9.806_65)?;
//! let answer = drop::answer(&drop::Question::new(scene, Model::FiniteTilt, 1.0))?;
//! // Without clatter it would be (1 + e) v, everywhere.
//! assert!(answer.place.velocity_change_m_s.0 > 1.3 * 4.43);
//! # Ok::<(), clatter_answer::Error>(())
//! ```

use clatter::End;
use clatter_assess::{Body, Drop, Feet, Model, OwnContacts, Part};
use clatter_flight::{ContactLaw, Scene};
use clatter_shock::{ShockTable, Suspension};
use serde::Serialize;

use super::limits::OneDrop;
use super::{AtPlace, ContactAt, Position, contacts};
use crate::{Error, Json, letter, on_body_beyond};

/// A drop of a bar and a part of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The drop, its end a first.
    pub scene: Scene,
    /// The physics that is kept of it.
    pub model: Model,
    /// The end of the product that is end a of the scene.
    pub first: End,
    /// Whether both ends land as one: instant impacts that are closer than any contact lasts.
    pub flat: bool,
    /// How long a lone contact takes: for the model with contacts, and for the acceleration of a place by the others.
    pub contact_time_s: Option<f64>,
    /// What the ground does meanwhile.
    pub contact_law: ContactLaw,
    /// Feet that it lands on, which are its ends here: places may lie beyond them.
    pub feet: Option<Feet>,
    /// Ends or corners with a contact of their own, as the scene has them.
    pub own_contacts: OwnContacts,
    /// Where on the product the part may be, in [−1, 1]: of several the place is answered that asks most of a limit, else the first.
    pub at: Vec<f64>,
    /// The part; none that is mounted rigidly.
    pub suspension: Option<Suspension>,
    /// Limits of the part that are held against the drop.
    pub limits: Option<Vec<clatter_assess::Limit>>,
    /// How exact the answer is for the model, as a share of it.
    pub tolerance: f64,
    /// A table whose half-sine is to do the same to the part.
    pub shock_table: Option<ShockTable>,
    /// Center of mass of the scene in [−1, 1], as it is told.
    pub center_of_mass: f64,
    /// Tilt at the first touch in degrees, as it is told.
    pub tilt_deg: f64,
}

impl Question {
    /// Of a place on which a part is mounted rigidly, to 1 %, without a contact time; all told as the scene has it.
    #[must_use]
    pub fn new(scene: Scene, model: Model, at: f64) -> Self {
        let [a, b] = scene.body().arms_m();
        Self {
            scene,
            model,
            first: End::A,
            flat: false,
            contact_time_s: None,
            contact_law: ContactLaw::default(),
            feet: None,
            own_contacts: OwnContacts::NONE,
            at: vec![at],
            suspension: None,
            limits: None,
            tolerance: 0.01,
            shock_table: None,
            center_of_mass: (a - b) / (a + b),
            tilt_deg: scene.tilt_rad().to_degrees(),
        }
    }

    fn drop(&self) -> Drop {
        Drop {
            is_flat: self.flat,
            spin_rad_s: self.scene.spin_rad_s(),
            gravity_m_s2: self.scene.gravity_m_s2(),
            contact_time_s: self.contact_time_s,
            contact_law: self.contact_law,
            own_contacts: self.own_contacts,
            ..Drop::new(
                Body { feet: self.feet, ..Body::from(self.scene.body()) },
                self.scene.speed_m_s(),
                self.scene.tilt_rad(),
                self.scene.e(),
            )
        }
    }
}

/// What a drop does to a part and at its place.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// What was kept of the drop.
    pub model: &'static str,
    /// The end that touches first.
    pub first: &'static str,
    /// From end to end.
    pub length_m: Json,
    /// Radius of gyration about the center of mass.
    pub gyration_m: Json,
    /// In [−1, 1].
    pub center_of_mass: Json,
    /// For strikes at end a and end b.
    pub inertia_ratios: [Json; 2],
    /// Coefficient of restitution.
    pub e: Json,
    /// At the first touch.
    pub speed_m_s: Json,
    /// At the first touch.
    pub tilt_deg: Json,
    /// At the first touch, positive where the tilt grows; left out where it does not turn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spin_rad_s: Option<Json>,
    /// Of the other end at the first touch.
    pub height_gap_m: Json,
    /// Of gravity.
    pub gravity_m_s2: Json,
    /// Of a lone contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_time_s: Option<Json>,
    /// Where contacts take time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_law: Option<&'static str>,
    /// Ends with a contact of their own.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<ContactAt>,
    /// How exact the answer is for the model, as a share of it.
    pub tolerance: Json,
    /// The place that is answered.
    pub at: Json,
    /// The part and its place.
    #[serde(flatten)]
    pub place: AtPlace,
}

/// Follows one drop until nothing later counts.
///
/// # Errors
/// No place or one off the body; a part too slow or too fast; a contact time that is none; those of [`clatter_assess::answer`].
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { scene, model, first, ref at, suspension, tolerance, .. } = *question;
    on_body_beyond(at.iter().copied(), scene.body().length_m(), question.feet.map(|feet| feet.inset_m[0]))?;
    let (body, side) = (scene.body(), if first == End::A { 1.0 } else { -1.0 });
    let half_m = 0.5 * body.length_m();
    let limits = question.limits.as_deref();
    let asked =
        OneDrop { drop: question.drop(), model, tolerance, suspension, limits, shock_table: question.shock_table };
    let place = |at: &f64| (Part::new(side * at * half_m, None), Position::Along(Json(at * half_m)));
    let places: Vec<_> = at.iter().map(place).collect();
    let place = asked.at(&Part::new(-half_m, None), &places)?;
    let inertia_ratios = body.inertia_ratios().map(Json);
    Ok(Answer {
        model: model.name(),
        first: letter(first),
        length_m: Json(body.length_m()),
        gyration_m: Json(body.gyration_m()),
        center_of_mass: Json(side * question.center_of_mass + 0.0),
        inertia_ratios: if first == End::A { inertia_ratios } else { [inertia_ratios[1], inertia_ratios[0]] },
        e: Json(scene.e()),
        speed_m_s: Json(scene.speed_m_s()),
        tilt_deg: Json(question.tilt_deg),
        spin_rad_s: Some(scene.spin_rad_s()).filter(|spin| *spin != 0.0).map(Json),
        height_gap_m: Json(scene.height_gap_m()),
        gravity_m_s2: Json(scene.gravity_m_s2()),
        contact_time_s: question.contact_time_s.map(Json),
        contact_law: question.contact_time_s.filter(|_| model == Model::Compliant).map(|_| question.contact_law.name()),
        contacts: contacts(
            &question.own_contacts.mirrored([first == End::B, false]),
            scene.e(),
            question.contact_time_s,
        ),
        tolerance: Json(tolerance),
        at: Json(at[place.index]),
        place,
    })
}
