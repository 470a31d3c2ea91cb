//! What may be taken as a velocity shock, and what needs the contact time.

use crate::{Component, Mount, Product};

/// The longest contact that is supposed where the file gives none: hard cases strike for 0.3 to 0.5 ms.
pub(crate) const SUPPOSED_CONTACT_S: f64 = 0.5e-3;
/// Up to this phase ωτ a part may be assessed without knowing the contact: a half-sine of ωτ = 1 does 2.3 % less to an
/// undamped part than an impulse of the same area, 1 − cos(ωτ/2)/(1 − (ωτ/π)²).
pub(crate) const SHORT_PULSE: f64 = 1.0;
/// Up to this phase ωτ a pulse of known length counts as a velocity shock: 0.2 % by the same formula.
pub(crate) const INSTANT_PULSE: f64 = 0.3;

/// Whether velocity shocks, for which bounds are proven, say enough of the response of a component.
pub(crate) fn feels_shocks(product: &Product, component: &Component) -> bool {
    product.contact_time_s.is_none_or(|time| match component.mount {
        Mount::Hard => false,
        Mount::Suspended { frequency_hz, .. } => std::f64::consts::TAU * frequency_hz.hi() * time <= INSTANT_PULSE,
    })
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
