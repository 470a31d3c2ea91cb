//! What comes late in a drop: rebounds that go on for long, and the weight of what lies.

use std::f64::consts::TAU;

use clatter_assess::{Answer, Part, answer};
use clatter_flight::{Body, Contact, Scene};
use clatter_product::{ContactLaw, Drop, Limit, LimitKind, Model};
use clatter_shock::{DampingRatio, Suspension};

use crate::safe::{G, close, limits, speed};

fn soft(frequency_hz: f64, ratio: f64) -> Suspension {
    Suspension::from_hz(frequency_hz, DampingRatio::new(ratio).expect("a ratio")).expect("a part")
}

/// What one drop asks of the rattle space of a part in the middle.
fn displaced(drop: &Drop, suspension: Suspension, model: Model) -> Answer {
    let part = Part::new(0.0, Some(suspension));
    answer(drop, &part, &Limit::new(LimitKind::RattleSpace, 1.0), model, 0.01).expect("an answer")
}

/// A drop of a centered bar of 200 mm with a radius of gyration of 98 mm, |q| = 0.02.
fn drop(restitution: f64, tilt_deg: f64, speed_m_s: f64) -> Drop {
    Drop {
        gravity_m_s2: G,
        ..Drop::new(Body::new(0.2, 0.098).expect("a body"), speed_m_s, tilt_deg.to_radians(), restitution)
    }
}

/// A part that is left to itself in a flight: displacement and velocity after it, and the largest displacement on the way.
fn ring([z, v]: [f64; 2], part: &Suspension, time_s: f64) -> ([f64; 2], f64) {
    let (omega, zeta) = (part.omega(), part.damping().get());
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let at = |t: f64| {
        let (sin, cos) = (damped * t).sin_cos();
        let decay = (-zeta * omega * t).exp();
        let turned = (v + zeta * omega * z) / damped;
        [decay * (z * cos + turned * sin), decay * (v * cos - (omega * z + zeta * v) * omega / damped * sin)]
    };
    let longest = time_s.min(TAU / damped);
    let most = (0..=100).map(|k| at(longest * f64::from(k) / 100.0)[0].abs()).fold(0.0, f64::max);
    (at(time_s), most)
}

/// An elastic product bounces beyond any number of strikes that is followed, and the error holds what comes then. Landing flat it gives
/// a part (1 + e) eⁿ v₀ after flights of 2 eⁿ v₀/g, in which the part swings so many times at first.
#[test]
fn what_is_left_of_a_long_motion_is_bounded() {
    let v0 = 0.5;
    let parts = [(0.1, 0.01), (0.9, 0.01), (1.3, 0.02), (1.7, 0.05), (1.9, 0.02), (2.5, 0.005), (6.3, 0.05)];
    for (e, (swings, ratio)) in [0.999_f64, 0.9995, 0.9999].into_iter().flat_map(|e| parts.map(|part| (e, part))) {
        let part = soft(swings * G / (2.0 * v0), ratio);
        let (mut state, mut most, mut approach) = ([0.0, 0.0], 0.0_f64, v0);
        for _ in 0..20_000 {
            state[1] += (1.0 + e) * approach;
            approach *= e;
            let (after, peak) = ring(state, &part, 2.0 * approach / G);
            (state, most) = (after, most.max(peak));
        }
        let asked = displaced(&Drop { is_flat: true, ..drop(e, 0.0, v0) }, part, Model::FiniteTilt);
        assert!(asked.value <= most * 1.01 && most <= asked.value + asked.off_by.max(1e-3 * most), "{asked:?}, {most}");
    }
}

/// The same of end after end, by contacts of either law. The largest peak is an early one, and that of instant impacts.
#[test]
fn elastic_products_are_answered() {
    for e in [0.8, 0.9, 0.995, 0.999] {
        let part = soft(60.0, 0.05);
        let instant = displaced(&drop(e, 1.0, 2.0), part, Model::FiniteTilt);
        for contact_law in ContactLaw::ALL {
            let drop = Drop { contact_law, contact_time_s: Some(4e-4), ..drop(e, 1.0, 2.0) };
            let asked = displaced(&drop, part, Model::Compliant);
            close(asked.value, instant.value, 2e-3);
            // What is cut short may do more, and not without end.
            assert!(if e > 0.998 { asked.off_by > 0.1 * asked.value } else { asked.off_by > 0.0 }, "{asked:?}");
            assert!(asked.off_by < 2.0 * asked.value, "{asked:?}");
        }
    }
}

/// One of Runge and Kutta's classical steps.
fn stepped(state: [f64; 2], h: f64, rate: impl Fn([f64; 2]) -> [f64; 2]) -> [f64; 2] {
    let after = |by: f64, k: [f64; 2]| [state[0] + by * h * k[0], state[1] + by * h * k[1]];
    let k1 = rate(state);
    let k2 = rate(after(0.5, k1));
    let k3 = rate(after(0.5, k2));
    let k4 = rate(after(1.0, k3));
    std::array::from_fn(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
}

/// The largest displacement of a part in a product that carries it from now on, by steps (Runge-Kutta) of a thousandth of a radian.
fn carried(velocity_m_s: f64, part: &Suspension) -> f64 {
    let (omega, zeta) = (part.omega(), part.damping().get());
    let rate = |[z, v]: [f64; 2]| [v, G - 2.0 * zeta * omega * v - omega * omega * z];
    let h = 1e-3 / omega;
    let (mut state, mut most) = ([0.0, velocity_m_s], 0.0_f64);
    for _ in 0..7000 {
        state = stepped(state, h, rate);
        most = most.max(state[0]);
    }
    most
}

/// From when it lies still the product carries the part: a step of g onto what it still rings by. Without restitution that is at once
/// where it lands flat.
#[test]
fn the_weight_is_on_at_rest() {
    let v0 = speed(0.01);
    for (frequency, ratio) in [(2.0, 0.05), (1.0, 0.3), (5.0, 0.01)] {
        let part = soft(frequency, ratio);
        let asked = displaced(&Drop { is_flat: true, ..drop(0.0, 0.0, v0) }, part, Model::FiniteTilt);
        close(asked.value, carried(v0, &part), 1e-5);
        assert!(asked.value > v0 / part.omega());
    }
}

/// Height in mm, restitution, natural frequency in Hz, and what `clatter-brute hunt` finds of these files: acceleration in m/s² and
/// displacement in m. The weight at rest is more than half of it.
const AT_REST: [([f64; 3], [f64; 2]); 2] =
    [([50.0, 0.2, 2.0], [24.397_13, 0.154_035_1]), ([80.0, 0.35, 2.8], [31.871_48, 0.102_617_6])];

/// The same of a tilted drop that comes to rest by contacts.
#[test]
fn the_weight_is_on_after_a_tilted_drop() {
    for ([height, e, frequency], brute) in AT_REST {
        let text = format!(
            r#"
product = {{ name = "Low", length = "200 mm", radius_of_gyration = "58 mm", restitution = {e}, contact_time = "1 ms" }}
drop = {{ height = "{height} mm", tilt = "3 deg", first = "a" }}
[[component]]
name = "part"
position = "30 mm"
natural_frequency = "{frequency} Hz"
damping_ratio = 0.05
acceleration_limit = "1e5 m/s2"
rattle_space = "500 mm"
"#
        );
        for (limit, brute) in limits(&text).iter().zip(brute) {
            close(limit.demand.expect("a demand"), brute, 2e-3);
        }
    }
}

/// The largest |z| of a part that every strike kicks and that carries its weight from when the product lies still, by steps
/// (Runge-Kutta) of a thousandth of a radian, or as long as the contacts of small rebounds where these come more often.
fn followed(drop: &Drop, part: &Suspension) -> f64 {
    let (omega, zeta) = (part.omega(), part.damping().get());
    let scene =
        Scene::new(drop.body.profile().unwrap(), drop.restitution, drop.speed_m_s, drop.tilt_rad.to_degrees(), G)
            .unwrap();
    let contact = Contact::new(drop.contact_law, drop.restitution, drop.contact_time_s.unwrap()).unwrap();
    let flight = scene.fly(clatter_flight::Model::Contacts(contact)).unwrap();
    let rest = flight.stop.time_s();
    let h = (1e-3 / omega).min(1e-4);
    let mut strikes = flight.strikes.iter().peekable();
    let (mut state, mut most, mut time) = ([0.0, 0.0], 0.0_f64, 0.0);
    while time < rest + 7.0 / omega {
        while let Some(strike) = strikes.next_if(|strike| strike.time_s <= time) {
            state[1] -= strike.delta_v_at(0.0);
        }
        let weight = if time >= rest { G } else { 0.0 };
        let rate = |[z, v]: [f64; 2]| [v, -weight - 2.0 * zeta * omega * v - omega * omega * z];
        state = stepped(state, h, rate);
        most = most.max(state[0].abs());
        time += h;
    }
    most
}

/// A part so soft that it hardly swings until the product lies still. A drop is left where nothing that is left counts; the weight
/// of the part does.
#[test]
fn the_weight_of_a_soft_part_counts_after_small_rebounds() {
    for e in [0.2, 0.5, 0.8] {
        let drop =
            Drop { body: Body::new(0.12, 0.035).expect("a body"), contact_time_s: Some(4e-4), ..drop(e, 10.0, 1.5) };
        for omega in [1.0, 3.0, 8.0, 15.0] {
            let part = soft(omega / TAU, 0.05);
            let (asked, most) = (displaced(&drop, part, Model::Compliant), followed(&drop, &part));
            // Strikes that come together are answered as one.
            let off = asked.off_by.max(0.01 * most);
            assert!((asked.value - most).abs() <= off, "e = {e}, {omega} rad/s: {asked:?}, {most}");
            assert!(asked.off_by < 0.1 * asked.value, "e = {e}, {omega} rad/s: {asked:?}");
        }
    }
}
