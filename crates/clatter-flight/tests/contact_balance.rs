//! What no contact may break: energy never grows, momentum adds up, and what a place feels is its motion.

use clatter_flight::{Contact, ContactLaw, Error, Model, Motion, Profile, Scene, Stop, Strike};
use proptest::prelude::*;

const TIME: f64 = 1e-3;

/// A body of length 1 with contacts of 1 ms, so long in units of √(length/g) and of length/v0.
fn drop(q: f64, off: f64, e: f64, tilt: f64, by_gravity: f64, by_speed: f64) -> Scene {
    let (a, b) = (0.5 * (1.0 + off), 0.5 * (1.0 - off));
    let body = Profile::off_center(a, b, 0.5 * ((1.0 - q) / (1.0 + q)).sqrt()).expect("a bar");
    let (g, speed) = ((by_gravity / TIME).powi(2), by_speed / TIME);
    Scene::new(body, e, speed, tilt, g).and_then(|scene| scene.with_impact_limit(100)).expect("a drop")
}

/// Up to the longest contacts and the highest gravity that are taken, and up to 85°.
fn any_drop() -> impl Strategy<Value = (Scene, Contact)> {
    let law = prop::sample::select(&ContactLaw::ALL[..]);
    let e = prop_oneof![Just(0.0), 0.0..=1.0_f64, 0.0..0.1_f64, 0.99..=1.0_f64];
    let by_gravity = prop_oneof![Just(0.0999), Just(0.0), 0.001..0.1_f64];
    let by_speed = prop_oneof![Just(0.3), 0.001..0.1_f64, 0.1..0.5_f64];
    (
        law,
        -0.5..0.98_f64,
        prop_oneof![Just(0.0), -0.3..0.3_f64],
        e,
        prop_oneof![0.0..85.0_f64, 0.0..2.0_f64],
        by_gravity,
        by_speed,
    )
        .prop_map(|(law, q, off, e, tilt, by_gravity, by_speed)| {
            (drop(q, off, e, tilt, by_gravity, by_speed), Contact::new(law, e, TIME).expect("a contact"))
        })
}

/// The flight; none of a body that is refused because it would be pressed through the ground.
fn flown(flight: Result<Motion, Error>) -> Option<Motion> {
    match flight {
        Err(Error::Bound { name: "contact time", reason, .. }) if reason.contains("half of the length") => None,
        flight => Some(flight.expect("a flight")),
    }
}

fn center(scene: &Scene, of: [f64; 2]) -> f64 {
    let [a, b] = scene.body().arms_m();
    (b * of[0] + a * of[1]) / (a + b)
}

/// ½ v² + ½ ρ² ω² + g y, without what springs hold.
fn energy(scene: &Scene, flight: &Motion, time_s: f64) -> f64 {
    let now = flight.sample(time_s).expect("contacts");
    let turning = scene.body().gyration_m() * now.spin_rad_s;
    0.5 * (center(scene, now.velocity_m_s).powi(2) + turning * turning)
        + scene.gravity_m_s2() * center(scene, now.height_m)
}

/// What the springs of dashpots hold below the ground, also of a point that has parted there: it may press again, and get that back.
fn held_by_springs(scene: &Scene, contact: &Contact, flight: &Motion, time_s: f64) -> f64 {
    if contact.law() == ContactLaw::Hysteretic {
        return 0.0;
    }
    let heights = flight.sample(time_s).expect("contacts").height_m;
    let one = |strike: &Strike| {
        let [x, _] = scene.body().points_m()[strike.point];
        let lever = x * strike.tilt_rad.cos() / scene.body().gyration_m();
        let stiffness = contact.frequency_rad_s().powi(2) / (1.0 + lever * lever);
        0.5 * stiffness * heights[strike.point].min(0.0).powi(2)
    };
    let last = |i: usize| flight.strikes.iter().rev().find(|s| s.point == i && s.time_s <= time_s);
    (0..2).filter_map(last).map(one).sum()
}

/// Whether the body turns by more than a right angle in one flight.
fn tumbles(flight: &Motion) -> bool {
    let end_s = flight.stop.time_s();
    let times: Vec<f64> = flight.phases_s().chain([end_s]).collect();
    times.windows(2).any(|pair| {
        let middle = flight.sample(0.5 * (pair[0] + pair[1])).expect("contacts");
        let flies = middle.force_per_mass_m_s2.iter().all(|force| *force == 0.0);
        flies && middle.spin_rad_s.abs() * (pair[1] - pair[0]) > 0.5 * std::f64::consts::PI
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() })]

    /// Whenever nothing presses, there is no more energy than before, that of springs included, but for what the flight says; and
    /// that is little.
    #[test]
    fn energy_never_grows((scene, contact) in any_drop(), precision in prop_oneof![Just(1e-3), Just(1e-4), Just(1e-5)]) {
        let Some(flight) = flown(scene.contacts_until(&contact, precision, |_| false)) else { return Ok(()) };
        // Some of the precision for each press, over the energy of the drop and not that of a faster turn; and 1 % whatever their number.
        let pressed = f64::from(u32::try_from(flight.presses.len()).expect("presses"));
        let most = (4.0 * pressed * precision).min(0.02);
        prop_assert!(flight.energy_error < most, "{:e} at {precision:e}", flight.energy_error);
        let first = energy(&scene, &flight, 0.0);
        let end = flight.stop.time_s();
        let mut held = first;
        let mut free: Vec<f64> = flight.presses.iter().map(|press| press.until_s).filter(|t| *t < end).collect();
        free.sort_by(f64::total_cmp);
        for t in free {
            let t = t * (1.0 + 4.0 * f64::EPSILON);
            if flight.sample(t).expect("contacts").force_per_mass_m_s2.iter().any(|force| *force > 0.0) {
                continue;
            }
            let now = energy(&scene, &flight, t);
            let allowed = first * (flight.energy_error + 1e-12);
            prop_assert!(now <= held + allowed, "{now} after {held}, {allowed:e} allowed of {first}");
            held = held.min(now + held_by_springs(&scene, &contact, &flight, t));
        }
    }
    /// The shocks of all strikes together stop the center of mass, and what gravity gives it until then.
    #[test]
    fn all_shocks_together_stop_the_drop((scene, contact) in any_drop()) {
        let Some(flight) = flown(scene.fly(Model::Contacts(contact))) else { return Ok(()) };
        let Stop::AtRest { time_s, .. } = flight.stop else { return Ok(()) };
        let stopped: f64 = flight.strikes.iter().map(|strike| center(&scene, strike.delta_v_m_s)).sum();
        let fallen = scene.speed_m_s() + scene.gravity_m_s2() * time_s;
        prop_assert!((stopped / fallen - 1.0).abs() < 1e-9, "{stopped} {fallen}");
        // The last strike to touch may have parted before; without gravity one point lies alone.
        let mut pressing = flight.presses.iter().zip(&flight.strikes).filter(|(press, _)| press.until_s == f64::INFINITY).peekable();
        prop_assert!(pressing.peek().is_some() || scene.gravity_m_s2() == 0.0);
        for (_, strike) in pressing {
            prop_assert_eq!((strike.velocity_m_s, strike.spin_rad_s), ([0.0; 2], 0.0));
        }
    }
    /// What a place feels is how its velocity changes, gravity apart, all in all and moment by moment; of bodies that turn by
    /// less than a right angle in one flight.
    #[test]
    fn what_is_felt_adds_up((scene, contact) in any_drop(), s in -1.2..1.2_f64, thickness in prop_oneof![Just(0.0), 0.0..0.3_f64], share in 0.0..1.0_f64) {
        let body = scene.body().with_thickness(thickness).expect("a bar");
        let thick = Scene::new(body, scene.e(), scene.speed_m_s(), scene.tilt_rad().to_degrees(), scene.gravity_m_s2());
        let scene = thick.and_then(|scene| scene.with_time_limit_s(0.3)).expect("a drop");
        let precision = 1e-3;
        let Some(flight) = flown(scene.contacts_until(&contact, precision, |_| false)) else { return Ok(()) };
        if tumbles(&flight) {
            return Ok(());
        }
        let [x, _] = scene.body().place(s);
        let felt = flight.felt(s);
        let sum: f64 = felt.sections().map(|section| section.velocity_after(section.length)).sum();
        let end_s = flight.stop.time_s();
        let velocity = |t: f64| {
            let now = flight.sample(t).expect("contacts");
            center(&scene, now.velocity_m_s) + x * now.tilt_rad.cos() * now.spin_rad_s
        };
        let changed = velocity(end_s) - velocity(0.0) + scene.gravity_m_s2() * end_s;
        let size = scene.speed_m_s() + scene.gravity_m_s2() * end_s;
        prop_assert!((sum - changed).abs() < 1e-9 * size, "{sum} felt, {changed} moved");
        for (k, section) in felt.sections().enumerate() {
            let next = felt.sections().nth(k + 1).map_or(end_s, |next| next.from);
            prop_assert!((section.from + section.length - next).abs() <= 1e-12 * end_s, "{section:?} until {next}");
        }
        // An end feels the acceleration that the samples have, and what is spread evenly over a phase; straight lines of a dashpot
        // miss it by their share.
        for (end, place) in [(0, -1.0), (1, 1.0)] {
            let felt = flight.felt(place);
            let largest = felt.sections().fold(0.0_f64, |most, section| most.max(section.acceleration_at(0.0).abs()));
            for section in felt.sections().filter(|section| section.length > 1e-9 * end_s).step_by(7) {
                let off = |share: f64| {
                    let after = share * section.length;
                    let had = flight.sample(section.from + after).expect("contacts").acceleration_m_s2[end] + scene.gravity_m_s2();
                    (section.acceleration_at(after) - had, had.abs())
                };
                let ((one, had), (other, _)) = (off(share), off(1.0 - share));
                let lines = if contact.law() == ContactLaw::Dashpot { 2.0 * precision } else { 1e-9 };
                prop_assert!((one - other).abs() <= lines * largest.max(had) + 1e-9 * largest, "{one} {other} of {had}");
            }
        }
    }
}
