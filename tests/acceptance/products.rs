//! Products that once were told the wrong thing: files with ranges of which a single drop exceeded the worst that was
//! told, or that contradicted themselves.

use std::path::Path;

use clatter_cli::Exit;
use serde_json::Value;

use crate::assess::{changed, repeated};
use crate::clatter;

/// The assessment of one of `tests/cases`, and how the command exits.
fn assessed(name: &str) -> (Exit, Value) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases").join(name).display().to_string();
    let outcome = clatter(["assess", &path, "--format=json"]);
    assert_eq!(outcome.stderr, "", "{name}");
    (outcome.exit, serde_json::from_str(&outcome.stdout).unwrap())
}

/// The first limit of the first part.
fn limit(assessment: &Value) -> &Value {
    &assessment["components"][0]["limits"][0]
}

fn number(of: &Value, key: &str) -> f64 {
    of[key].as_f64().unwrap_or_else(|| panic!("{key} of {of}"))
}

#[test]
fn a_boot_whose_contacts_overlap_is_unsafe() {
    let (exit, all) = assessed("f1.toml");
    let (_, one) = assessed("f1_one.toml");
    assert_eq!((exit, &all["verdict"], &one["verdict"]), (Exit::Unsafe, &"unsafe".into(), &"unsafe".into()));
    // The single drop is one of the ranges.
    assert!(number(limit(&all), "demand") > 0.98 * number(limit(&one), "demand"), "{all} {one}");
}

/// A dead edge on a dashpot shakes a stiff part harder than a half-sine does.
#[test]
fn the_worst_phase_of_a_stiff_part_is_found_among_all_tilts() {
    for law in ["", "_dashpot"] {
        let (_, all) = assessed(&format!("f2b{law}.toml"));
        let (_, one) = assessed(&format!("f2b_one{law}.toml"));
        assert!(number(limit(&all), "demand") > 0.98 * number(limit(&one), "demand"), "{all} {one}");
        let verdict = if law.is_empty() { "safe" } else { "unsafe" };
        assert_eq!((&all["verdict"], &one["verdict"]), (&verdict.into(), &verdict.into()));
        assert!(number(limit(&all), "other_law") > 0.0, "the law counts here: {all}");
    }
}

/// The limit is what a single drop of these ranges was found to ask for, by the law of half-sines.
#[test]
fn overlaps_of_a_dead_boot_are_found_between_the_tilts_of_a_grid() {
    let (exit, all) = assessed("f3.toml");
    let demand = number(limit(&all), "demand");
    let worst = [0.30, 0.33, 0.36, 0.40, 0.45, 0.50].map(|tilt| {
        let flag = format!("--tilt-deg={tilt}");
        let drop = ["--length-m=0.15", "--gyration-m=0.05", "--e=0.02", "--contact-time-s=1.5e-3", "--at=0"];
        let fall = ["respond", "--model=compliant", "--height-m=0.3", &flag];
        number(&crate::answer(fall.iter().chain(&drop)), "velocity_change_m_s")
    });
    let worst = worst.into_iter().fold(0.0, f64::max);
    assert!(demand > 0.98 * worst, "{demand} m/s told, and a drop of the ranges asks for {worst} m/s");
    assert_eq!(exit, if demand > 2.2 { Exit::Unsafe } else { Exit::Done });
}

/// Rebounds spin a tumbler faster and faster, and never beyond what its energy allows.
#[test]
fn no_turn_is_told_that_the_energy_does_not_allow() {
    let (_, all) = assessed("f4.toml");
    let (demand, bound) = (number(limit(&all), "demand"), number(limit(&all), "bound"));
    // √2E/ρ twice: from one bound to the other; v0 = 4.89 m/s, 2° and arms of 48.4 and 31.6 mm.
    let speed = (4.89_f64.powi(2) + 2.0 * 9.806_65 * 0.0484 * 2_f64.to_radians().sin()).sqrt();
    assert!((bound / (2.0 * speed / 0.0136) - 1.0).abs() < 1e-3, "{bound}");
    assert!(demand > 0.0 && demand <= bound, "{demand} of {bound}");
}

#[test]
fn a_lightly_damped_part_is_told_what_it_goes_through() {
    let (exit, all) = assessed("f6.toml");
    let demand = number(limit(&all), "demand");
    assert_eq!((exit, &all["verdict"]), (Exit::Done, &"safe".into()));
    assert!((demand / 1050.0 - 1.0).abs() < 0.02, "{demand} m/s²");
}

/// A part that is mounted rigidly has one acceleration, whichever limit asks for it.
#[test]
fn an_acceleration_limit_and_a_damage_boundary_agree() {
    let (_, all) = assessed("f10.toml");
    let limits = all["components"][0]["limits"].as_array().unwrap();
    assert_eq!((&limits[0]["limit"], &limits[1]["limit"]), (&"acceleration".into(), &"damage-boundary".into()));
    assert_eq!(limits[1]["unit"], "m/s2", "its velocity change is exceeded by any drop: {all}");
    let [a, b] = [0, 1].map(|i| number(&limits[i], "demand"));
    assert!((a / b - 1.0).abs() < 0.02, "{a} and {b}");
    assert_eq!(limits[0]["verdict"], limits[1]["verdict"]);
}

/// What is told of a drop is what that drop asks for: the part once had its damping left out.
#[test]
fn a_damped_part_is_never_told_more_than_its_drop_asks_for() {
    for damping in ["damping_ratio = 10", "damping_ratio = [0.1, 10]"] {
        let (_dir, path) = changed(|text| text.replacen("damping_ratio = 0.1", damping, 1));
        let outcome = clatter(["assess", &path, "--format=json"]);
        let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
        for limit in json["components"][1]["limits"].as_array().unwrap() {
            let (demand, again) = (number(limit, "demand"), repeated(limit));
            assert!(demand <= again * (1.0 + 1e-9), "{demand} told, and the drop asks for {again}: {limit}");
        }
    }
}
