//! What a strike costs in memory: its line in the list. (`benches/flight` has the time.)

use std::hint::black_box;

use allocation_counter::measure;
use clatter_flight::{Contact, ContactLaw, Model, Profile, Scene};

/// Elastic, so that it strikes for ever.
fn scene(strikes: usize) -> Scene {
    let body = Profile::new(0.14, 0.07 / 3.0_f64.sqrt()).expect("a uniform bar");
    Scene::new(body, 1.0, 4.43, 5.0, 9.81).and_then(|s| s.with_impact_limit(strikes)).expect("a drop")
}

const MODELS: [Model; 2] = [Model::Ballistic, Model::FiniteTilt];

/// A list that doubles when it is full is moved once for every doubling: 7 times between 10^3 and 10^5 strikes.
#[test]
fn a_strike_allocates_nothing_but_its_line_in_the_list() {
    for model in MODELS {
        let [few, many] = [1_000, 100_000].map(|strikes| {
            let scene = scene(strikes);
            let mut listed = 0;
            let count = measure(|| listed = black_box(scene.fly(model).expect("a motion")).strikes.len()).count_total;
            assert_eq!(listed, strikes, "{model:?}");
            count
        });
        assert!(few > 0 && many <= few + 7, "{model:?}: {few} allocations for 10^3 strikes, {many} for 10^5");
    }
    // Strikes, presses and phases are three such lists.
    for law in ContactLaw::ALL {
        let contact = Contact::new(law, 1.0, 1e-5).expect("a contact");
        let [few, many] = [10, 1_000].map(|strikes| {
            let scene = scene(strikes);
            measure(|| drop(black_box(scene.fly(Model::Contacts(contact))))).count_total
        });
        assert!(few > 0 && many <= few + 3 * 7, "{law:?}: {few} allocations for 10 strikes, {many} for 10^3");
    }
}
