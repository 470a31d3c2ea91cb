//! Boxes on ground with Coulomb friction, beside two programs with fixed small steps that share nothing with this one.

use clatter_flight::{Block, BlockDrop, BlockFlight, Contact, ContactLaw};
use serde_json::Value;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}
fn triple(value: &Value) -> [f64; 3] {
    std::array::from_fn(|k| number(&value[k]))
}

/// The drops of `data/friction.json`, until their end.
fn flights() -> impl Iterator<Item = (Value, BlockFlight)> {
    let all: Value = serde_json::from_str(include_str!("data/friction.json")).unwrap();
    let cases = all["cases"].as_array().unwrap().clone();
    cases.into_iter().map(|case| {
        let size = triple(&case["half_m"]).map(|half| 2.0 * half);
        let block = Block::new(size, triple(&case["center_of_mass_m"]), triple(&case["gyration_m"])).unwrap();
        let turned = std::array::from_fn(|k| number(&case["quaternion"][k]));
        let drop = BlockDrop::new(block, turned, number(&case["speed_m_s"]), number(&case["gravity_m_s2"])).unwrap();
        let drop = drop.with_spin(triple(&case["spin_rad_s"])).unwrap();
        let drop = drop.with_friction(number(&case["friction"])).unwrap();
        let drop = drop.with_time_limit_s(number(&case["until_s"])).unwrap();
        let contact = Contact::new(ContactLaw::Hysteretic, number(&case["e"]), number(&case["contact_time_s"]));
        let flight = drop.contacts(&contact.unwrap(), |_| ()).unwrap_or_else(|error| panic!("{case}: {error}"));
        (case, flight)
    })
}

/// Velocities and spins differ by no more than those programs did between two step sizes, or by 2e-4: so slowly the direction of a slipping
/// stretch turns where the force is small.
#[test]
fn boxes_slide_and_stick_as_independently_integrated() {
    let mut count = 0;
    for (case, flight) in flights() {
        let (speed, accuracy) = (number(&case["speed_m_s"]), number(&case["accuracy"]));
        let reach = triple(&case["half_m"])[..2].iter().copied().fold(f64::INFINITY, f64::min);
        let [x, y] = flight.along_m_s;
        let off = |got: [f64; 3], want: &Value| {
            got.iter().zip(triple(want)).map(|(got, want)| (got - want).abs()).fold(0.0, f64::max)
        };
        let of_velocity = off([x, y, flight.center_m_s], &case["velocity_of_center_m_s"]) / speed;
        let of_spin = off(flight.spin_rad_s, &case["spin_end_rad_s"]) * reach / speed;
        let allowed = accuracy.max(2e-4);
        assert!(of_velocity <= allowed && of_spin <= allowed, "{of_velocity}, {of_spin} of {accuracy}: {case}");
        assert!(flight.energy_error < 1e-5, "{}: {case}", flight.energy_error);
        count += 1;
    }
    assert_eq!(count, 24);
}

/// A handheld of 150 mm × 70 mm × 14 mm that lands tilted at 3 m/s.
fn handheld(friction: f64, law: ContactLaw) -> (BlockFlight, usize) {
    let block = Block::new([0.15, 0.07, 0.014], [0.0; 3], [0.022, 0.045, 0.048]).unwrap();
    let drop = BlockDrop::tilted(block, 1.0, 0.4, 3.0, 9.81).unwrap().with_friction(friction).unwrap();
    let (mut steps, drop) = (0, drop.with_time_limit_s(0.05).unwrap());
    let flight = drop.contacts(&Contact::new(law, 0.4, 3e-4).unwrap(), |_| steps += 1).unwrap();
    (flight, steps)
}

/// Friction that vanishes leaves the drop without: what it changes is in proportion. However slight, it takes no more than some times the
/// steps, and friction beyond all that sticks changes nothing any more.
#[test]
fn slight_and_endless_friction_are_followed_as_fast() {
    for law in [ContactLaw::Hysteretic, ContactLaw::Dashpot] {
        let (without, steps) = handheld(0.0, law);
        let change = |friction: f64| {
            let (with, more) = handheld(friction, law);
            assert!(more < 20 * steps, "{more} steps at {friction}, {steps} without");
            (0..3).map(|k| (with.spin_rad_s[k] - without.spin_rad_s[k]).abs()).fold(0.0, f64::max)
        };
        let [slight, tenth] = [1e-5, 1e-6].map(change);
        assert!((slight / tenth - 10.0).abs() < 0.3, "{slight}, {tenth}");
        let [endless, more] = [5.0, 10.0].map(|friction| handheld(friction, law).0.spin_rad_s[1]);
        // Of the 55 rad/s that it turns with: it always slips as a contact ends.
        assert!((endless - more).abs() < 0.1, "{endless}, {more}");
    }
}

#[test]
fn friction_is_no_number_below_0() {
    let block = Block::new([0.15, 0.07, 0.014], [0.0; 3], [0.022, 0.045, 0.048]).unwrap();
    let drop = BlockDrop::tilted(block, 0.1, 0.4, 3.0, 9.81).unwrap();
    for friction in [-1e-9, f64::NAN, f64::INFINITY, 10.1] {
        assert!(drop.with_friction(friction).is_err(), "{friction}");
    }
}
