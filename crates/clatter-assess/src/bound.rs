//! What no drop of the ranges exceeds, by the energy that the body has as it touches.
//!
//! Per mass that is `E = ½ v₀² + g y`, y the height of the center of mass over where it lies. It bounds every speed from then on, whatever
//! the order of the strikes, the tilt and the model: of a place at distance x from the center of mass by √(2E (1 + x²/ρ²)), of
//! the turning by √(2E)/ρ. A suspended part has no such bound: it may add up shocks.

use clatter_flight::{Contact, ContactLaw};

use crate::quantity::Source;
use crate::{Component, Drop, Limit, Product};

/// The largest value of a limited quantity that the energy of the drops allows; none for the response of a suspended part and for
/// contacts without a bound.
///
/// # Formula
/// One instant strike of point i approaches with at most √(2E μ_i), μ = 1 + x²/ρ², and gives the place
/// `(1 + e) u (1 + x_p x_i/ρ²)/μ_i`, largest where the lever arm of the end is that of the place, or that of the level body.
/// Where strikes may be one shock, as those of a flat drop at one instant and contacts that take time, a place may change its
/// velocity from one bound to the other, and gains gτ within the contact time τ. A hysteretic contact holds at most E on its line
/// of first loading: its force is at most √(2E) ω₁/√μ.
pub(crate) fn bound(
    product: &Product,
    drop: &Drop,
    component: &Component,
    limit: &Limit,
    law: ContactLaw,
) -> Option<f64> {
    let [a, b] = product.body.arms_m();
    // All that follows grows as the radius of gyration shrinks.
    let rho = product.gyration_m.lo();
    let [_, fastest] = drop.speeds_m_s();
    let height = a.max(b) * libm::sin(drop.tilt_rad.hi());
    let speed = (fastest * fastest + 2.0 * drop.gravity_m_s2 * height).sqrt(); // √(2E)
    let e = product.restitution.hi();
    // Places and ends from the center of mass.
    let middle = 0.5 * (b - a);
    let places: Vec<f64> = component.ends_m().iter().map(|x| x + middle).collect();
    let ends = [-a, b];
    // (1 + x l/ρ²)/√(1 + l²/ρ²) of a lever arm l from 0 to that of the level body: largest for l = x, or at its ends.
    let share = |place: f64, end: f64| {
        let (x, end) = (place / rho, end / rho);
        let arm = if x * end > 0.0 && x.abs() < end.abs() { x } else { end };
        ((1.0 + x * arm).abs() / (1.0 + arm * arm).sqrt()).max(1.0)
    };
    let over = |of: &dyn Fn(f64) -> f64| places.iter().map(|&x| of(x)).fold(0.0, f64::max);
    let contact_s = product.contact_time_s.as_ref().map(|time| [time.lo(), time.hi()]);
    let strikes_are_apart = contact_s.is_none() && drop.tilt_rad.lo() > 0.0;
    match (limit.kind.source(), contact_s) {
        (Source::Shock | Source::Boundary, _) if strikes_are_apart => {
            let one = |place: f64| ends.iter().map(|&end| share(place, end)).fold(0.0, f64::max);
            Some((1.0 + e) * speed * over(&one))
        }
        (Source::Shock | Source::Boundary, _) => {
            let fastest = over(&|x| (1.0 + (x / rho).powi(2)).sqrt());
            let longest = contact_s.map_or(0.0, |[_, longest]| longest);
            Some(2.0 * speed * fastest + drop.gravity_m_s2 * longest)
        }
        (Source::Turn, _) if strikes_are_apart => {
            let one = ends.iter().map(|end| end.abs() / (rho * (rho * rho + end * end).sqrt())).fold(0.0, f64::max);
            Some((1.0 + e) * speed * one)
        }
        (Source::Turn, _) => Some(2.0 * speed / rho),
        (Source::Response(peak), Some([shortest, _])) if peak.is_acceleration() => {
            let hard = matches!(component.mount, crate::Mount::Hard) && law.leaves_a_dent();
            let contact = Contact::new(law, e, shortest).ok().filter(|_| hard)?;
            // Both ends at once.
            let one = |place: f64| ends.iter().map(|&end| share(place, end)).sum::<f64>();
            Some(speed * contact.frequency_rad_s() * over(&one))
        }
        (Source::Response(_), _) => None,
    }
}
