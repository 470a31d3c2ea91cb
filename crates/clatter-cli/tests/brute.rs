//! Random products of every kind beside a brute force that shares no formula with what it is held against; in earnest by
//! `clatter-brute compare`.

#![cfg(test)]

use std::path::Path;

use clatter_brute::{compare::compare, random, spatial};

/// Drops of each product before it climbs from the worst of them.
const DROPS: usize = 40;

/// Of none of these products is a limit called safe that a drop exceeds, and none asks for more than is told.
#[test]
fn no_drop_of_random_products_exceeds_what_is_told() {
    let (bars, in_space) = (random::KINDS.map(|kind| (kind, 1..=3)), spatial::KINDS.map(|kind| (kind, 1..=1)));
    let mut limits = 0;
    for (kind, seeds) in bars.into_iter().chain(in_space) {
        let mut said = Vec::new();
        compare(Path::new(env!("CARGO_BIN_EXE_clatter")), kind, seeds, DROPS, &mut said).unwrap();
        let said = String::from_utf8(said).unwrap();
        let counts = said.lines().find(|line| line.starts_with("==")).expect("counts");
        limits += counts.split(' ').nth(2).and_then(|count| count.parse::<usize>().ok()).expect(counts);
        for word in ["NOT SAFE", "ABOVE", "not told", "% beyond"] {
            assert!(!said.contains(word), "{said}");
        }
    }
    assert!(limits >= 80, "{limits} limits");
}
