//! The JSON that scripts hold on to: names, types, and what stands for infinity and for nothing.

use serde_json::{Value, json};

use crate::{answer, clatter};

/// The names of an object's fields, in the order of the alphabet.
fn names(object: &Value) -> Vec<&str> {
    let mut names: Vec<_> = object.as_object().unwrap().keys().map(String::as_str).collect();
    names.sort_unstable();
    names
}

#[test]
fn impacts_has_the_fields_of_the_contract() {
    let got = answer(["impacts", "--q=0.5", "--e=0.3", "--at=-1", "--at=0.5"]);
    let fields = "at count count_exact duration e final gyration_ratio height_gap impacts net peak q velocity";
    assert_eq!(names(&got).join(" "), fields);
    assert_eq!(names(&got["peak"]).join(" "), "angular center end impact");
    assert_eq!(names(&got["net"]).join(" "), "a angular b center");
    assert_eq!(names(&got["impacts"][0]).join(" "), "approach delta_v delta_v_at end number time");
    assert_eq!(got["q"], json!(0.5));
    assert_eq!(got["e"], json!(0.3));
    assert_eq!(got["velocity"], json!([-1.0, -1.0]));
    assert_eq!(got["height_gap"], json!(1.0));
    assert_eq!(got["at"], json!([-1.0, 0.5]));
    assert_eq!(got["count"], json!(4));
    assert_eq!(got["count_exact"], json!(true));
    assert_eq!(got["peak"]["impact"], json!(2));
    assert_eq!(got["impacts"].as_array().unwrap().len(), 4);
    // At end a itself, and three quarters of the way to end b, from the jumps 1.3 and -0.65 of the ends.
    assert_eq!(got["impacts"][0]["delta_v"], json!([1.3, -0.65]));
    assert_eq!(got["impacts"][0]["delta_v_at"][0], json!(1.3));
    let between = got["impacts"][0]["delta_v_at"][1].as_f64().unwrap();
    assert!((between + 0.1625).abs() < 1e-15, "{between} is off by more than the roundings of numbers about 1");
}

#[test]
fn the_answer_is_one_line_and_floats_look_like_floats() {
    let outcome = clatter(["impacts", "--q=0.5", "--e=0.3", "--limit=1", "--format=json"]);
    assert_eq!(outcome.stdout.lines().count(), 1);
    assert!(outcome.stdout.contains(r#""velocity":[-1.0,-1.0],"height_gap":1.0,"#), "{}", outcome.stdout);
    assert!(outcome.stdout.contains(r#"{"number":1,"end":"a","time":0.0,"approach":-1.0,"delta_v":[1.3,-0.65]"#));
}

#[test]
fn negative_zero_is_taken_for_zero() {
    let got = answer(["impacts", "--q=-0.0", "--e=-0.0", "--velocity=-1,-0.0", "--height-gap=-0.0", "--at=-0.0"]);
    let text = got.to_string();
    assert!(!text.contains("-0.0"), "{text}");
    assert_eq!(got["q"], json!(0.0));
}

#[test]
fn a_negative_value_may_stand_apart_from_its_flag() {
    let got = answer(["impacts", "--q", "-0.5", "--e", "0.3", "--velocity", "-2,-1", "--at", "-1"]);
    assert_eq!((&got["q"], &got["velocity"], &got["at"]), (&json!(-0.5), &json!([-2.0, -1.0]), &json!([-1.0])));
}

#[test]
fn velocities_that_never_settle_are_null_except_at_the_center() {
    // All mass at the center: nothing slows it, and the ends strike until half a time unit has passed.
    let got = answer(["impacts", "--q=1", "--e=0.5", "--limit=0"]);
    assert_eq!(got["count"], json!("endless"));
    assert_eq!(got["duration"], json!(0.5));
    assert_eq!(got["peak"], json!({"end": 6.0, "impact": "limit", "center": 0.0, "angular": 6.0}));
    assert_eq!(got["net"], json!({"a": null, "b": null, "center": 0.0, "angular": null}));
    assert_eq!(got["final"], Value::Null);
    assert_eq!(got["impacts"], json!([]));
}

#[test]
fn a_peak_without_bound_is_the_word_infinite() {
    let got = answer(["impacts", "--q=1", "--e=1", "--limit=3"]);
    assert_eq!(got["count"], json!("endless"));
    assert_eq!(got["peak"], json!({"end": "infinite", "impact": "limit", "center": 0.0, "angular": "infinite"}));
    let approach: Vec<_> = got["impacts"].as_array().unwrap().iter().map(|impact| &impact["approach"]).collect();
    assert_eq!(approach, [&json!(-1.0), &json!(-3.0), &json!(-5.0)]);
}

#[test]
fn an_endless_train_ends_at_rest_exactly() {
    let got = answer(["impacts", "--q=0.9", "--e=0.3", "--limit=2"]);
    assert_eq!(got["count"], json!("endless"));
    assert_eq!(got["count_exact"], json!(true));
    assert_eq!(got["final"], json!([0.0, 0.0]));
    assert_eq!(got["net"], json!({"a": 1.0, "b": 1.0, "center": 1.0, "angular": 0.0}));
    assert_eq!(got["impacts"].as_array().unwrap().len(), 2);
}

#[test]
fn a_flat_drop_keeps_its_order_at_one_instant() {
    let got = answer(["impacts", "--q=0.5", "--e=0.3", "--height-gap=0"]);
    assert_eq!(got["duration"], json!(0.0));
    let ends: Vec<_> =
        got["impacts"].as_array().unwrap().iter().map(|impact| (&impact["end"], &impact["time"])).collect();
    assert_eq!(
        ends,
        [
            (&json!("a"), &json!(0.0)),
            (&json!("b"), &json!(0.0)),
            (&json!("a"), &json!(0.0)),
            (&json!("b"), &json!(0.0))
        ]
    );
}

#[test]
fn a_drop_scales_with_its_speed_and_its_height() {
    let unit = answer(["impacts", "--q=0.5", "--e=0.3"]);
    let scaled = answer(["impacts", "--q=0.5", "--e=0.3", "--velocity=-4,-4", "--height-gap=0.5"]);
    // Powers of two scale without rounding.
    let scale = |value: &Value, by: f64| json!(value.as_f64().unwrap() * by);
    assert_eq!(scaled["duration"], scale(&unit["duration"], 0.125));
    assert_eq!(scaled["peak"]["end"], scale(&unit["peak"]["end"], 4.0));
    assert_eq!(scaled["final"][0], scale(&unit["final"][0], 4.0));
}

#[test]
fn the_gyration_ratio_may_stand_for_q_in_impacts_and_zone() {
    // ρ/L = 1/2 is q = (1 - 1/4)/(1 + 1/4) = 0.6.
    let (by_k, by_q) = ("--gyration-ratio=0.5", "--q=0.6");
    assert_eq!(answer(["impacts", by_k, "--e=0.1"])["count"], answer(["impacts", by_q, "--e=0.1"])["count"]);
    let s = |inertia| answer(["zone", inertia, "--e=0.1", "--threshold=1"])["zones"][0]["s"].as_f64().unwrap();
    // Some roundings of numbers about 1.
    assert!((s(by_k) - s(by_q)).abs() < 1e-15);
    assert_eq!(answer(["zone", by_k, "--e=0.1", "--threshold=1"])["gyration_ratio"], json!(0.5));
}

#[test]
fn zone_has_the_fields_of_the_contract() {
    let got = answer(["zone", "--q=0.5", "--e=0", "--threshold=0.5", "--threshold=0.125", "--threshold=8"]);
    assert_eq!(names(&got).join(" "), "e gyration_ratio q zones");
    // The ends see 3/2 of v0 at most, so s = (4/3 threshold - 1/2)/(3/2).
    assert_eq!(got["zones"][0]["extent"], json!("part"));
    assert_eq!(got["zones"][1]["extent"], json!("none"));
    assert_eq!(got["zones"][2]["extent"], json!("whole"));
    for (zone, s) in got["zones"].as_array().unwrap().iter().zip([1.0 / 9.0, -2.0 / 9.0, 61.0 / 9.0]) {
        assert_eq!(names(zone).join(" "), "extent s threshold");
        // A few roundings of numbers up to 10.
        assert!((zone["s"].as_f64().unwrap() - s).abs() < 1e-14, "{zone}");
    }
}

#[test]
fn one_first_end_gives_an_interval_or_null() {
    let zone = |threshold: &str, first: &str| {
        answer(["zone", "--q=0.5", "--e=0", &format!("--threshold={threshold}"), &format!("--first={first}")])
    };
    // e = 0 and q = 1/2: jumps (1, -1/2), (-3/4, 3/2) and then these times the powers of 1/2, ends in turn.
    // Nothing exceeds 2; at 1 the second impact decides, (3/8)(1 + 3 s) = ±1; 0.2 leaves no place.
    assert_eq!(zone("2", "a")["zones"][0]["interval"], json!([-1.0, 1.0]));
    assert_eq!(zone("2", "a")["first"], json!("a"));
    assert_eq!(zone("0.2", "a")["zones"][0]["interval"], Value::Null);
    let bounds = |first| {
        let zones = zone("1", first);
        [0, 1].map(|i| zones["zones"][0]["interval"][i].as_f64().unwrap())
    };
    // A few roundings of numbers about 1.
    let close = |got: [f64; 2], want: [f64; 2]| got.iter().zip(want).all(|(g, w)| (g - w).abs() < 1e-14);
    assert!(close(bounds("a"), [-1.0, 5.0 / 9.0]), "{:?}", bounds("a"));
    assert!(close(bounds("b"), [-5.0 / 9.0, 1.0]), "{:?}", bounds("b"));
}

#[test]
fn a_long_list_is_cut_at_its_limit() {
    let got = answer(["impacts", "--q=0.9", "--e=0.3"]);
    assert_eq!(got["impacts"].as_array().unwrap().len(), 1000);
    let got = answer(["impacts", "--q=0.9", "--e=0.3", "--limit=1500"]);
    assert_eq!(got["impacts"][1499]["number"], json!(1500));
}
