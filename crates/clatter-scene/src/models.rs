//! Which models a scene needs: every choice between rungs of the two ladders is made here.
//!
//! Four groups decide. Gravity: G = g h0/v0² at the largest tilt and least speed. Geometry: φ² at the largest tilt. Contact: the
//! contact time over the time from the first strike to the second at the least tilt, where contacts come closest. Pulses: ωτ of
//! the part.

use crate::{BarModel, Component, ComponentModel, Drop, Mount, Product};

/// The longest contact that is supposed where the file gives none: hard cases strike for 0.3 to 0.5 ms.
pub(crate) const SUPPOSED_CONTACT_S: f64 = 0.5e-3;
/// Up to this phase ωτ a part may be assessed without knowing the contact: a half-sine of ωτ = 1 does 2.3 % less to an undamped
/// part than an impulse of the same area, 1 − cos(ωτ/2)/(1 − (ωτ/π)²).
pub(crate) const SHORT_PULSE: f64 = 1.0;
/// Up to this phase ωτ a pulse of known length counts as a velocity shock: 0.2 % by the same formula.
pub(crate) const INSTANT_PULSE: f64 = 0.3;
/// Gravity and geometry are left out up to this G and φ²: either changes early shocks by about as much.
const NEGLIGIBLE: f64 = 1e-3;

/// The models for one component.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Plan {
    /// Whether velocity shocks without gravity, for which bounds are proven, say enough of the component.
    pub(crate) shocks: bool,
    /// The rung that is searched beside or instead.
    pub(crate) searched: Option<BarModel>,
    /// How a suspended part answers in the search.
    pub(crate) component: ComponentModel,
    /// Which groups decided.
    pub(crate) reason: String,
}

/// The dimensionless groups of a scene, at their worst over its ranges.
#[derive(Debug, Clone, Copy)]
struct Groups {
    gravity: f64,
    geometry: f64,
    /// Contact time over the shortest time between the first two strikes; 0 where no contact time is given.
    contact: f64,
}

impl Groups {
    fn new(product: &Product, drop: &Drop) -> Self {
        let length = product.body.length_m();
        let [slowest, fastest] = drop.speeds_m_s();
        let (least, most) = (length * drop.tilt_rad.lo().sin(), length * drop.tilt_rad.hi().sin());
        // End b comes 1/(1 + T) h0/v0 after end a, the sooner the larger T = q(1 + e) is.
        let q = product.inertia_ratio();
        let second = least / fastest / (1.0 + (q * (1.0 + product.restitution.hi())).max(0.0));
        Self {
            gravity: drop.gravity_m_s2 * most / (slowest * slowest),
            geometry: drop.tilt_rad.hi().powi(2),
            contact: product.contact_time_s.map_or(0.0, |time| time / second),
        }
    }
}

/// The models that a component of this drop needs.
pub(crate) fn plan(product: &Product, drop: &Drop, component: &Component) -> Plan {
    let groups = Groups::new(product, drop);
    let phase = product.contact_time_s.map_or(0.0, |time| match component.mount {
        Mount::Hard => f64::INFINITY,
        Mount::Suspended { frequency_hz, .. } => std::f64::consts::TAU * frequency_hz.hi() * time,
    });
    let shocks = phase <= INSTANT_PULSE;
    let overlap = groups.contact > 1.0;
    let (searched, component_model, reason) = if overlap || !shocks {
        let contact = 1e3 * product.contact_time_s.unwrap_or(0.0);
        let why = match (overlap, component.mount) {
            (true, _) => format!("contacts of {contact:.3} ms overlap at the least tilt"),
            (false, Mount::Hard) => "a hard-mounted part goes through the pulses themselves".to_owned(),
            (false, Mount::Suspended { .. }) => {
                format!("pulses of {contact:.3} ms last {phase:.2} rad of the part's vibration")
            }
        };
        (Some(BarModel::Compliant), ComponentModel::PulseTrain, why)
    } else if groups.geometry > NEGLIGIBLE {
        let why = format!("real tilt counts (up to {:.1} deg)", drop.tilt_rad.hi().to_degrees());
        (Some(BarModel::FiniteTilt), ComponentModel::ImpulseTrain, why)
    } else if groups.gravity > NEGLIGIBLE {
        let why = format!("gravity counts (g h0/v0² up to {:.2e})", groups.gravity);
        (Some(BarModel::Ballistic), ComponentModel::ImpulseTrain, why)
    } else {
        let why = "gravity, real tilt and contact time change less than 0.1 %".to_owned();
        (None, ComponentModel::ImpulseTrain, why)
    };
    Plan { shocks, searched, component: component_model, reason }
}

/// Why a component cannot be assessed without the product's contact time; `None` where it can.
pub(crate) fn lacks_contact_time(product: &Product, component: &Component) -> Option<String> {
    let limits = &component.limits;
    if product.contact_time_s.is_some() || (limits.acceleration_m_s2.is_none() && limits.rattle_space_m.is_none()) {
        return None;
    }
    match component.mount {
        Mount::Hard => Some("the acceleration of a hard-mounted part is that of the impact itself".to_owned()),
        Mount::Suspended { frequency_hz, .. } => {
            let phase = std::f64::consts::TAU * frequency_hz.hi() * SUPPOSED_CONTACT_S;
            (phase > SHORT_PULSE).then(|| {
                let highest = SHORT_PULSE / (std::f64::consts::TAU * SUPPOSED_CONTACT_S);
                format!("above {highest:.0} Hz an impact may not be short beside the period")
            })
        }
    }
}
