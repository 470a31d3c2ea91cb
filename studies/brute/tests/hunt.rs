//! Random products are read, and a search is repeated by its seed.
#![allow(clippy::unwrap_used, reason = "tests")]

use clatter_brute::hunt::hunt;
use clatter_brute::product::Product;
use clatter_brute::random::{KINDS, product};

#[test]
fn every_kind_is_read_and_searched_the_same_way_twice() {
    for kind in KINDS {
        let file = Product::read(&product(kind, 1).unwrap()).unwrap();
        let search = || hunt(&file, 60, 7).iter().map(ToString::to_string).collect::<Vec<_>>();
        let found = search();
        assert!(!found.is_empty(), "{kind}: limits");
        assert_eq!(found, search(), "{kind}");
    }
}

/// The part is in the middle of a bar that can only land flat: without a contact time its velocity changes by (1 + e)
/// v0 at once.
#[test]
fn a_flat_drop_without_a_contact_time_lands_at_once() {
    let text = "[product]\nname = \"flat\"\nlength = \"0.2 m\"\nradius_of_gyration = \"60 mm\"\nrestitution = 0.4\n\
                [drop]\nspeed = \"5 m/s\"\ntilt = \"0 deg\"\n\
                [[component]]\nname = \"part\"\nposition = \"90 mm\"\nmount = \"hard\"\nvelocity_change_limit = \"9 m/s\"\n\
                angular_velocity_change_limit = \"9 rad/s\"\n";
    let found = hunt(&Product::read(text).unwrap(), 2, 1);
    assert!((found[0].peak.value - 7.0).abs() < 1e-12, "{}", found[0]);
    assert!(found[0].flat, "{}", found[0]);
    assert!(found[1].peak.value.abs() < 1e-12, "a flat landing does not turn: {}", found[1]);
}
