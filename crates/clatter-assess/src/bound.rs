//! This module finds the bound that no drop of the ranges exceeds, by the energy that the body has as it touches.
//!
//! Per mass that is `E = ½ v₀² + ½ ρ² ω₀² + g y`, y the height of the center of mass over where it lies. It bounds every speed from then
//! on, whatever the order of the strikes, the tilt and the model: of a place at distance x from the center of mass by
//! √(2E (1 + x²/ρ²)), of the turning by √(2E)/ρ. A suspended part has no such bound: it may add up shocks.

use clatter_flight::{Body, Contact, ContactLaw, Drop, Levers, Place};

use clatter_product::{Base, Component, DropRanges, Limit, Mount, Product, Source};

/// Returns the largest value of a limited quantity that the energy of the drops allows; none for the response of a suspended part and for
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
    drop: &DropRanges,
    base: Option<Base>,
    component: &Component,
    limit: &Limit,
    law: ContactLaw,
) -> Option<f64> {
    if product.body.is_wide() {
        return of_plate(product, drop, base, component, limit, law);
    }
    // Beyond feet an edge may touch, if not before the product lands again.
    let beyond = product.body.feet.map_or(0.0, |feet| feet.inset_m[0]);
    let [a, b] = product.body.arms_m().map(|arm| arm + beyond);
    // All that follows grows as the radius of gyration shrinks.
    let rho = product.gyration_m.lo();
    let [_, fastest] = drop.speeds_m_s();
    let height = a.max(b) * libm::sin(drop.tilt_rad.hi());
    // The share of the turning grows with the radius of gyration.
    let turns = drop.fastest_rad_s() * product.gyration_m.hi();
    let speed = (fastest * fastest + turns * turns + 2.0 * drop.gravity_m_s2 * height).sqrt(); // √(2E)
    let e = product.restitution.hi();
    // Places and ends from the center of mass.
    let middle = 0.5 * (b - a);
    let places: Vec<f64> = component.ends_m().iter().map(|[x, _]| x + middle).collect();
    let ends = [-a, b];
    // (1 + x l/ρ²)/√(1 + l²/ρ²) of a lever arm l from 0 to that of the level body: largest for l = x, or at its ends.
    let share = |place: f64, end: f64| {
        let (x, end) = (place / rho, end / rho);
        let arm = if x * end > 0.0 && x.abs() < end.abs() { x } else { end };
        ((1.0 + x * arm).abs() / (1.0 + arm * arm).sqrt()).max(1.0)
    };
    let over = |of: &dyn Fn(f64) -> f64| places.iter().map(|&x| of(x)).fold(0.0, f64::max);
    let contact_s = product.contact_times_s();
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
        // The force on edges beyond feet is not known.
        (Source::Response(peak), Some(_)) if peak.is_acceleration() && product.body.feet.is_none() => {
            let hard = component.mount == Mount::Hard && law.leaves_a_dent();
            let contacts = product.stiffest(law).filter(|_| hard)?;
            let most = contacts.iter().fold(0.0_f64, |most, contact| most.max(contact.frequency_rad_s()));
            // Both ends at once, each with its rate over the faster one.
            let of_end = |(&end, contact): (&f64, &Contact)| (end, contact.frequency_rad_s() / most);
            let rates: Vec<(f64, f64)> = ends.iter().zip(&contacts).map(of_end).collect();
            let one = |place: f64| rates.iter().map(|(end, rate)| rate * share(place, *end)).sum::<f64>();
            Some(speed * most * over(&one))
        }
        (Source::Response(_), _) => None,
    }
}

/// Returns the same of a plate or a box, whose contacts take time.
///
/// # Formula
/// Speeds at a place p are at most √(2E (1 + p²)), p in radii of gyration, and may turn around. A corner that holds E_i on its line of
/// first loading presses with √(2E_i) ω₁/√μ_i, μ_i = 1 + q_i² as it touched; all of them hold E at most. Of a plate a push J over the mass
/// at q gives p at most J (1 + |p||q|), with arms that real tilt shortens, so that all corners together do at most the root of the sum of
/// their squares. A box may land on any face: [`box_acceleration`].
fn of_plate(
    product: &Product,
    drop: &DropRanges,
    base: Option<Base>,
    component: &Component,
    limit: &Limit,
    law: ContactLaw,
) -> Option<f64> {
    let [shortest_s, longest_s] = product.contact_times_s()?;
    let [_, fastest] = drop.speeds_m_s();
    let one = Drop {
        body: product.body_at(0.0),
        speed_m_s: fastest,
        tilt_rad: drop.tilt_rad.hi(),
        restitution: product.restitution.hi(),
        contact_time_s: Some(shortest_s),
        contact_law: law,
        friction: product.friction.map_or(0.0, |friction| friction.hi()),
        ..product.unset(drop, base)
    };
    let norm = |[x, y]: [f64; 2]| libm::hypot(x, y);
    let places = || component.ends_m().into_iter().map(|at_m| component.inside.place(at_m));
    let corners = one.in_radii(&Place::default()).0;
    let farthest = places().map(|place| norm(one.in_radii(&place).1)).fold(0.0, f64::max);
    let ([a, b], [front, back]) = (product.body.arms_m(), product.body.width?.ends_m);
    let reach = libm::hypot(a.max(b), front.max(back));
    // A box may come to lie on another face.
    let height = if one.is_solid() {
        libm::hypot(reach, product.body.thickness().m())
    } else {
        reach * libm::sin(drop.tilt_rad.hi())
    };
    let turns = drop.fastest_rad_s() * most_gyration_m(product, one.is_solid());
    let squared = fastest * fastest + turns * turns;
    // Corners sink in by no more than the fastest of them goes while a contact lasts.
    let lever = corners.iter().fold(1.0_f64, |most, &q| most.max(libm::hypot(1.0, norm(q))));
    let sinks = (squared + 2.0 * drop.gravity_m_s2 * height).sqrt() * lever * longest_s;
    let speed = (squared + 2.0 * drop.gravity_m_s2 * (height + sinks)).sqrt(); // √(2E)
    match limit.kind.source() {
        Source::Shock | Source::Boundary => {
            // The axis of the part turns with a box while it is pushed.
            let turned = if one.is_solid() { speed * longest_s / one.least_gyration_m() } else { 0.0 };
            Some((2.0 + turned) * speed * libm::hypot(1.0, farthest) + drop.gravity_m_s2 * longest_s)
        }
        Source::Turn => Some(2.0 * speed / one.least_gyration_m()),
        Source::Response(peak)
            if peak.is_acceleration()
                && component.mount == Mount::Hard
                && law.leaves_a_dent()
                && product.body.feet.is_none() =>
        {
            let contacts = product.stiffest(law)?;
            let most = contacts.iter().fold(0.0_f64, |most, contact| most.max(contact.frequency_rad_s()));
            if one.is_solid() {
                let of = |place: Place| box_acceleration(&one, &place, speed, speed * most, longest_s);
                return Some(places().map(of).fold(0.0, f64::max));
            }
            // Each corner with its rate over the fastest.
            let rates = contacts.iter().map(|contact| contact.frequency_rad_s() / most);
            let pressed = corners.into_iter().zip(rates).fold(0.0, |all, (q, rate)| {
                let arm = farthest.min(norm(q));
                libm::hypot(all, rate * (1.0 + farthest * arm) / libm::hypot(1.0, arm))
            });
            Some(speed * most * pressed)
        }
        Source::Response(_) => None,
    }
}

/// Returns the largest acceleration that the ground gives a place of a box, whatever it lands on, with `speed` = √(2E) and a contact that
/// stops the center of mass alone from that speed with `stops_m_s2`.
///
/// # Formula
/// A force F over the mass at corner i gives the place, along the axis of its part, at most F √μ_i √(1 + p²). The corner is as stiff as
/// its arm was when it touched, and presses with at most √(2E_i) ω₁/√μ_i of that moment; while it presses √μ grows at most by
/// 1 + ω τ r/k, as the box turns by ω τ (r the distance of the farthest corner, k the least radius of gyration, ω = √(2E)/k). Four
/// corners of a face do at most √4 times as much as one that has all of the energy. A place of a turning box has an acceleration of ω² |p|
/// as well, and of a torque-free change of its axis of spin at most ω² |p|/√3. Friction of the ground pushes across by its
/// coefficient of each force.
pub(crate) fn box_acceleration(drop: &Drop, place: &Place, speed: f64, stops_m_s2: f64, longest_s: f64) -> f64 {
    let Some(Levers { farthest_m, place_m, across }) = drop.levers(place) else { return f64::INFINITY };
    let least = drop.least_gyration_m();
    let spins = speed / least;
    let grows = 1.0 + spins * longest_s * farthest_m / least;
    let [x, y] = drop.in_radii(place).1;
    let along = (1.0 + x * x + y * y).sqrt() * grows;
    2.0 * stops_m_s2 * (along + drop.friction * across) + (1.0 + 3_f64.sqrt().recip()) * spins * spins * place_m
}

/// Returns the largest radius of gyration about an axis that a plate or a box turns about, as thick as it is taken where real tilt counts.
fn most_gyration_m(product: &Product, is_box: bool) -> f64 {
    let Some(width) = &product.body.width else { return product.gyration_m.hi() };
    let along = product.gyration_m.hi();
    // About no axis more than all of it.
    let in_plane = if is_box {
        libm::hypot(along, width.gyration_m)
    } else {
        Body { length: clatter_flight::Side { gyration_m: along, ..product.body.length }, ..product.body }
            .gyrations_in_plane_m()[1]
    };
    let deep = product.body.thickness().gyration_m;
    libm::hypot(in_plane, deep)
}

#[cfg(test)]
mod random;
#[cfg(test)]
mod tests {
    use super::*;
    use clatter_product::ProductFile;

    /// A box that is set on its end falls over: from 75 mm to 7 mm over the ground.
    #[test]
    fn a_box_that_stands_has_the_energy_to_fall_over() {
        let text = r#"
product = { name = "box", length = "150 mm", width = "70 mm", thickness = "14 mm", radius_of_gyration = ["43 mm", "20 mm"], restitution = 0.4, contact_time = "0.4 ms" }
drop = { speed = "0.1 m/s", face = "end-a" }
component = [{ name = "part", position = ["0 mm", "0 mm"], mount = "hard", velocity_change_limit = "9 m/s", angular_velocity_change_limit = "99 rad/s" }]
"#;
        let file = ProductFile::read(text, "box.toml").unwrap_or_else(|faults| panic!("{faults}"));
        let faces_m = file.product.body.faces_m().unwrap();
        let base = Base { up: file.landings[0].attitude.unwrap().upward(faces_m), spin_axis: None };
        let component = &file.components[0];
        let of = |limit: &Limit| bound(&file.product, &file.drop, Some(base), component, limit, file.product.law());
        let over_m_s = (0.1_f64.powi(2) + 2.0 * file.drop.gravity_m_s2 * (0.075 - 0.007)).sqrt();
        let limits = Limit::of(component);
        // Turned around by strikes that are one shock.
        assert!(of(&limits[0]).unwrap() >= 2.0 * over_m_s, "{:?}", of(&limits[0]));
        assert!(of(&limits[1]).unwrap() >= 2.0 * over_m_s / 0.0206, "{:?}", of(&limits[1]));
    }

    /// Off center, its heavy end 90 mm from the center of mass and up by 10°: contacts that overlap may turn its speed around.
    #[test]
    fn contacts_of_a_bar_may_turn_its_speed_around() {
        let text = r#"
product = { name = "bar", length = "150 mm", radius_of_gyration = "45 mm", center_of_mass = "15 mm", restitution = 0.3, contact_time = "0.4 ms" }
drop = { speed = "3 m/s", tilt = ["1 deg", "10 deg"] }
component = [
    { name = "middle", position = "0 mm", mount = "hard", velocity_change_limit = "9 m/s" },
    { name = "light side", position = "40 mm", mount = "hard", velocity_change_limit = "9 m/s" },
]
"#;
        let file = ProductFile::read(text, "bar.toml").unwrap_or_else(|faults| panic!("{faults}"));
        let g = file.drop.gravity_m_s2;
        let speed = (9.0 + 2.0 * g * 0.09 * 10.0_f64.to_radians().sin()).sqrt();
        // A third of a radius of gyration from the center of mass, and five ninths.
        for (component, far) in file.components.iter().zip([1.0 / 3.0, 5.0 / 9.0_f64]) {
            let told = bound(&file.product, &file.drop, None, component, &Limit::of(component)[0], file.product.law());
            let most = 2.0 * speed * (1.0 + far * far).sqrt() + g * 4e-4;
            assert!((told.unwrap() / most - 1.0).abs() < 1e-9, "{told:?}, not {most}");
        }
    }
}
