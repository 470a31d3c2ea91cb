//! Plates: `impacts`, `zone` and `atlas` with two gyration ratios.

use clatter::{Plate, PlateStart};
use clatter_cli::Exit;
use serde_json::{Value, json};

use crate::{answer, clatter};

/// 1/√3 in all its digits: an evenly spread mass.
const UNIFORM: &str = "--gyration-ratio=0.5773502691896257,0.5773502691896257";

fn names(object: &Value) -> String {
    let mut names: Vec<_> = object.as_object().unwrap().keys().map(String::as_str).collect();
    names.sort_unstable();
    names.join(" ")
}

fn word(answer: &Value) -> String {
    answer["impacts"].as_array().unwrap().iter().map(|impact| impact["corner"].as_str().unwrap()).collect()
}

#[test]
fn impacts_of_a_plate_are_told_as_those_of_a_bar() {
    let got = answer(["impacts", UNIFORM, "--e=0.3", "--height-gap=2,1", "--at=0,0", "--at=1,-1"]);
    let fields = "at center_of_mass count count_exact duration e final gyration_ratio height_gap impacts peak velocity";
    assert_eq!(names(&got), fields);
    assert_eq!(names(&got["peak"]), "center corner impact later struck");
    assert_eq!(names(&got["impacts"][0]), "approach corner delta_v delta_v_at number tie time");
    let plate = Plate::uniform(0.3).unwrap();
    let impacts: Vec<_> = plate.train(&PlateStart::level([2.0, 1.0]).unwrap()).collect();
    assert_eq!(got["count"], json!(impacts.len()));
    assert_eq!(word(&got), impacts.iter().map(|impact| impact.corner.letter()).collect::<String>());
    for (shown, impact) in got["impacts"].as_array().unwrap().iter().zip(&impacts) {
        assert_eq!(shown["time"], json!(impact.time));
        assert_eq!(shown["delta_v"], json!(impact.delta_v));
        assert_eq!(shown["delta_v_at"], json!([impact.delta_v_at([0.0, 0.0]), impact.delta_v_at([1.0, -1.0])]));
    }
    // All but the first strike come as they do whatever the defaults are.
    assert_eq!(
        got,
        answer(["impacts", UNIFORM, "--e=0.3", "--velocity=-1,-1,-1", "--height-gap=2,1", "--at=0,0", "--at=1,-1"])
    );
}

#[test]
fn one_gyration_ratio_is_a_bar_and_two_are_a_plate() {
    let bar = answer(["impacts", "--gyration-ratio=0.5", "--e=0.3"]);
    assert_eq!(bar["impacts"][0]["end"], "a");
    let plate = answer(["impacts", "--gyration-ratio=0.5,1e9", "--e=0.3", "--height-gap=1,0"]);
    assert_eq!(plate["count"], bar["count"], "the bar is the plate of large inertia across");
    assert_eq!(plate["peak"]["impact"], bar["peak"]["impact"]);
}

#[test]
fn ties_and_what_is_endless_are_told() {
    let edge = answer(["impacts", UNIFORM, "--e=0.5", "--height-gap=1,0"]);
    assert_eq!(edge["impacts"][0]["tie"], json!(true));
    assert!(edge["impacts"][0]["order"].as_str().unwrap().contains("corner d"), "{edge}");
    assert_eq!(edge["impacts"][1]["tie"], json!(false));
    let flat = answer(["impacts", UNIFORM, "--e=0.5", "--height-gap=0,0"]);
    assert_eq!((&flat["duration"], &flat["impacts"][0]["tie"]), (&json!(0.0), &json!(true)));
    let endless = answer(["impacts", UNIFORM, "--e=0.1", "--limit=5"]);
    assert_eq!((&endless["count"], &endless["count_exact"]), (&json!("endless"), &json!(true)));
    assert_eq!(endless["final"], json!([0.0, 0.0, 0.0, 0.0]));
    assert_eq!(word(&endless), "acaca");
    // e = 0: all at one instant, and no proof that it never ends.
    let dead = answer(["impacts", UNIFORM, "--e=0", "--limit=5", "--height-gap=1,0.3"]);
    assert_eq!(dead["count_exact"], json!(dead["count"] == json!("endless")), "{dead}");
}

#[test]
fn the_safe_zone_of_a_plate_is_a_rhombus_cut_by_its_edges() {
    for (ratios, alpha, beta) in [(UNIFORM, 3.0, 3.0), ("--gyration-ratio=0.5,0.8", 4.0, 1.5625)] {
        let got = answer(["zone", ratios, "--e=0.3", "--threshold=0.5", "--threshold=1", "--threshold=9"]);
        let peak = answer(["atlas", ratios, "--e=0.3"])["peak"]["corner"].as_f64().unwrap();
        let mu = 1.0 + alpha + beta;
        for zone in &got["zones"].as_array().unwrap()[..2] {
            let reach = mu * zone["threshold"].as_f64().unwrap() / peak - 1.0;
            assert_eq!(zone["extent"], "part", "{zone}");
            for corner in zone["polygon"].as_array().unwrap() {
                let [x, y] = [&corner[0], &corner[1]].map(|x| x.as_f64().unwrap().abs());
                assert!((alpha * x + beta * y - reach).abs() < 1e-12, "{zone}: ({x}, {y}) is not on {reach}");
            }
            // Both half-diagonals are on the plate.
            let share = 0.5 * reach * reach / alpha / beta;
            assert!(
                reach > alpha.max(beta) || (zone["share"].as_f64().unwrap() - share).abs() < 1e-12,
                "{zone}, not {share}"
            );
        }
        assert_eq!(
            got["zones"][2],
            json!({"threshold": 9.0, "extent": "whole", "share": 1.0,
            "polygon": [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]})
        );
        assert_eq!(got["proven"], json!(true));
    }
    let one = answer(["zone", UNIFORM, "--e=0.3", "--threshold=1", "--height-gap=2,1"]);
    let all = answer(["zone", UNIFORM, "--e=0.3", "--threshold=1"]);
    let share = |answer: &Value| answer["zones"][0]["share"].as_f64().unwrap();
    assert!(share(&one) > share(&all), "one drop leaves more room than all: {one} {all}");
}

/// A sector for each order of corners in each quarter; of a plate whose center of mass is not in the middle the one of corner a.
#[test]
fn an_atlas_is_drawn_as_a_ring() {
    let areas = |body: &[&str]| {
        let args = [&["atlas", "--e=0.3", "-o", "-"], body].concat();
        let svg = clatter(args).stdout;
        assert!(svg.starts_with("<svg") && svg.contains("Where the plate rises to"), "{svg:.200}");
        svg.matches("stroke=\"#ffffff\"").count()
    };
    let words = |body: &[&str]| answer([&["atlas", "--e=0.3"], body].concat())["words"].as_array().unwrap().len();
    assert_eq!(areas(&[UNIFORM]), 4 * words(&[UNIFORM]));
    let off = ["--gyration-ratio=0.5,0.6", "--center-of-mass=0.1,-0.2"];
    assert_eq!(areas(&off), words(&off));
    // Hundreds of orders of corners are too narrow to be seen.
    let svg = clatter(["atlas", UNIFORM, "--e=0.02", "-o", "-"]).stdout;
    assert!(svg.len() < 500_000, "{} bytes", svg.len());
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("ring.svg").display().to_string();
    let told = clatter(["atlas", UNIFORM, "--e=0.3", "-o", &path]);
    assert!(told.stdout.contains("acdabcd") && std::fs::read_to_string(&path).unwrap().contains("acdabcd"));
    let refused = clatter(["atlas", UNIFORM, "--e=0.3", "-o", "ring.png"]);
    assert!(refused.exit == Exit::BadInput && refused.stderr.contains(".svg"), "{}", refused.stderr);
}

#[test]
fn an_atlas_covers_all_directions() {
    let got = answer(["atlas", UNIFORM, "--e=0.3"]);
    assert_eq!(names(&got), "center_of_mass e gyration_ratio limit peak words");
    assert_eq!(names(&got["words"][0]), "ended from peak to word");
    let words = got["words"].as_array().unwrap();
    assert_eq!(words.len(), 11);
    assert_eq!((&words[0]["from"], &words[10]["to"]), (&json!(0.0), &json!(1.0)));
    assert!(words.windows(2).all(|w| w[0]["to"] == w[1]["from"]), "no gap");
    let csv = clatter(["atlas", UNIFORM, "--e=0.3", "--format=csv"]);
    assert_eq!(csv.stdout.lines().count(), 12);
    let table = clatter(["atlas", UNIFORM, "--e=0.1"]);
    assert_eq!((table.exit, table.stderr.as_str()), (Exit::Done, ""));
    assert!(table.stdout.contains("acac") && table.stdout.contains('…'), "{}", table.stdout);
}

/// Aspects, inertias and gaps beyond what products have: the right answer at once.
#[test]
fn extremes_are_answered() {
    for (i, ratios) in ["3.2e-5,3.2e4", "1e-5,1e-5", "1e5,1e5", "0.5,1e-5", "1e-9,1e9"].into_iter().enumerate() {
        for (k, gaps) in ["1,1e-12", "1e-12,1", "1,0", "0,0", "1e60,1e-60"].into_iter().enumerate() {
            // Where impacts are many, some of these take a second or two.
            for e in [["0", "0.3"], ["1e-300", "1"], ["0"; 2], ["1"; 2]][(i + k) % 4] {
                let ratios = format!("--gyration-ratio={ratios}");
                let got =
                    answer(["impacts", &ratios, &format!("--height-gap={gaps}"), &format!("--e={e}"), "--limit=3"]);
                let impacts = got["impacts"].as_array().unwrap();
                let sound = |impact: &Value| {
                    let [time, approach] = ["time", "approach"].map(|name| impact[name].as_f64().unwrap());
                    time >= 0.0 && approach < 0.0
                };
                assert!(!impacts.is_empty() && impacts.iter().all(sound), "{ratios} {gaps} {e}: {got}");
            }
        }
    }
}
