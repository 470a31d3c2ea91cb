//! Plates against exact rational arithmetic: 84 drops (`data/plate.json`) and 24 atlases (`data/atlas.json`), 25 digits.
//!
//! Lengths there are those of the plate, so that gyration ratios and centers of mass are rounded here: errors of 1e−12
//! are of the input.

use clatter::{Corner, Plate, PlateCount, PlateStart};
use serde::Deserialize;
use serde::de::DeserializeOwned;

#[derive(Deserialize)]
struct Cases<T> {
    cases: Vec<T>,
}

fn cases<T: DeserializeOwned>(text: &str) -> Vec<T> {
    serde_json::from_str::<Cases<T>>(text).expect("cases in JSON").cases
}

#[derive(Deserialize)]
struct Drop {
    kind: String,
    reach: [f64; 4],
    gyration: [f64; 2],
    e: f64,
    heights: [f64; 4],
    velocities: [f64; 4],
    stop: String,
    count: u64,
    order: String,
    times: Vec<String>,
    approach: Vec<String>,
    delta_v: Vec<[String; 4]>,
    #[serde(rename = "final")]
    last: Option<[String; 4]>,
    peaks: Vec<Peak>,
    safe: std::collections::BTreeMap<String, String>,
}

#[derive(Deserialize)]
struct Peak {
    at: [f64; 2],
    value: String,
}

#[derive(Deserialize)]
struct AtlasCase {
    alpha: f64,
    beta: f64,
    e: f64,
    limit: usize,
    words: Vec<WordCase>,
}

#[derive(Deserialize)]
struct WordCase {
    lo: String,
    hi: String,
    word: String,
    peak_corner: String,
    peak_center: String,
    ended: bool,
}

fn decimal(text: &str) -> f64 {
    text.parse().expect("a decimal number")
}

fn letters(corners: impl Iterator<Item = Corner>) -> String {
    corners.map(Corner::letter).collect()
}

#[track_caller]
fn hold(what: &str, got: f64, want: &str, allowed: f64) {
    let want = decimal(want);
    assert!((got - want).abs() <= allowed, "{what}: {got:e}, not {want:e}, allowed {allowed:e}");
}

#[test]
fn drops_are_those_of_exact_arithmetic() {
    for (n, c) in cases::<Drop>(include_str!("data/plate.json")).iter().enumerate() {
        let ([a1, a2, b1, b2], [kx, ky]) = (c.reach, c.gyration);
        let center = [(a1 - a2) / (a1 + a2), (b1 - b2) / (b1 + b2)];
        let plate = Plate::off_center([2.0 * kx / (a1 + a2), 2.0 * ky / (b1 + b2)], center, c.e).unwrap();
        let [va, vb, _, vd] = c.velocities;
        let start = PlateStart::new([va, vb, vd], [c.heights[1], c.heights[3]]).unwrap();
        let name = format!("case {n}, {}", c.kind);
        let impacts: Vec<_> = plate.train(&start).take(c.order.len()).collect();
        assert_eq!(letters(impacts.iter().map(|impact| impact.corner)), c.order, "{name}: order");
        for (impact, (time, (approach, delta_v))) in
            impacts.iter().zip(c.times.iter().zip(c.approach.iter().zip(&c.delta_v)))
        {
            let name = format!("{name}, impact {}", impact.number);
            hold(&format!("{name}: time"), impact.time, time, 1e-10 * decimal(time).max(1.0));
            hold(&format!("{name}: approach"), impact.approach, approach, 1e-11);
            for (got, want) in impact.delta_v.iter().zip(delta_v) {
                hold(&format!("{name}: jump"), *got, want, 1e-11);
            }
        }
        let summary = plate.summary(&start, c.count + 1);
        if c.stop == "bounced-clear" {
            assert_eq!(summary.count, PlateCount::Finite(c.count), "{name}");
            for (got, want) in summary.final_velocity.unwrap().iter().zip(c.last.as_ref().unwrap()) {
                hold(&format!("{name}: final"), *got, want, 1e-11);
            }
        } else {
            assert!(!matches!(summary.count, PlateCount::Finite(_)), "{name}: {summary:?}");
        }
        let shocks = plate.shocks(&start, c.count);
        for Peak { at: [x, y], value } in &c.peaks {
            // From the center of mass, in the unit of the reach.
            let place = [(2.0 * x + a1 - a2) / (a1 + a2), (2.0 * y + b1 - b2) / (b1 + b2)];
            hold(&format!("{name}: peak at ({x}, {y})"), shocks.at(place), value, 1e-11);
        }
        for (threshold, share) in &c.safe {
            let threshold_value = if threshold == "1/2" { 0.5 } else { decimal(threshold) };
            hold(&format!("{name}: safe within {threshold}"), shocks.safe_zone(threshold_value).share, share, 1e-10);
        }
    }
}

/// Checks every word, also those of intervals that are too short for floats.
#[test]
fn atlases_are_those_of_exact_arithmetic() {
    for c in cases::<AtlasCase>(include_str!("data/atlas.json")) {
        let name = format!("alpha = {}, beta = {}, e = {}", c.alpha, c.beta, c.e);
        let plate = Plate::new([1.0 / c.alpha.sqrt(), 1.0 / c.beta.sqrt()], c.e).unwrap();
        let atlas = plate.atlas(c.limit).unwrap();
        let words: Vec<_> = atlas.words().iter().map(|word| letters(word.corners.iter().copied())).collect();
        assert_eq!(words, c.words.iter().map(|word| word.word.as_str()).collect::<Vec<_>>(), "{name}");
        for (word, want) in atlas.words().iter().zip(&c.words) {
            let name = format!("{name}: {}", want.word);
            hold(&format!("{name}: from"), word.from, &want.lo, 1e-13);
            hold(&format!("{name}: to"), word.to, &want.hi, 1e-13);
            hold(&format!("{name}: corner"), word.peak(), &want.peak_corner, 1e-12);
            hold(&format!("{name}: center"), word.center, &want.peak_center, 1e-12);
            assert_eq!(word.ended, want.ended, "{name}: ended");
            assert_eq!(word.later > 0.0, !want.ended, "{name}: what is left");
        }
    }
}
