//! `clatter respond`: one component, driven by one clatter.

use std::fs;

use clatter_cli::Exit;
use insta::assert_snapshot;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::{answer, clatter};

#[derive(Deserialize)]
struct Case {
    #[serde(rename = "case")]
    name: String,
    q: f64,
    e: f64,
    position: f64,
    omega: f64,
    damping: f64,
    omega_peak_relative_displacement: String,
    peak_absolute_acceleration_over_omega: String,
}

/// 75 components computed with 30 digits; endless trains there are cut after 300 impacts, when they are over.
#[test]
fn peaks_are_those_of_30_digit_arithmetic() {
    #[derive(Deserialize)]
    struct Oracle {
        cases: Vec<Case>,
    }
    let oracle: Oracle =
        serde_json::from_str(include_str!("../../crates/clatter-shock/tests/data/response.json")).unwrap();
    assert_eq!(oracle.cases.len(), 75);
    for c in oracle.cases {
        let got = answer([
            "respond".to_owned(),
            format!("--q={:?}", c.q),
            format!("--e={:?}", c.e),
            format!("--at={:?}", c.position),
            format!("--omega={:?}", c.omega),
            format!("--damping={:?}", c.damping),
        ]);
        for (name, want) in [
            ("omega_peak_relative_displacement", c.omega_peak_relative_displacement),
            ("peak_absolute_acceleration_over_omega", c.peak_absolute_acceleration_over_omega),
        ] {
            let (got, want) = (got[name].as_f64().unwrap(), want.parse::<f64>().unwrap());
            assert!((got - want).abs() <= 1e-12 * want.abs(), "{}: {name} {got:?}, not {want:?}", c.name);
        }
    }
}

#[test]
fn respond_explains_itself() {
    let shown = clatter(["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=3", "--damping=0"]);
    assert_eq!((shown.exit, shown.stderr.as_str()), (Exit::Done, ""));
    // Without damping an impulse gives back its own size; 2.145 is the largest shock of the paper's first bar.
    assert_snapshot!(shown.stdout, @"
    Component at 1 of a bar with q = 0.5, e = 0.3; W = 3 v0/h0, damping ratio 0
    End a strikes first, at -1 v0; end b comes with -1 v0 from 1 h0

    Peak                                        v0   when, h0/v0
      relative displacement, W z           1.95337       17.9362  after impact 4, the last
      relative velocity                    2.38880      0.695054  after impact 2
      absolute acceleration, A/W           1.95337       17.9362  after impact 4, the last

    A shock at this position             shock, v0       W z, v0       A/W, v0
      of the net change (W h0/v0 -> 0)     1.00214       1.00214       1.00214
      the largest (W h0/v0 -> infinity)     2.14500             -             -
      without clatter, (1 + e) v0          1.30000       1.30000       1.30000
      as standards assume, 2 v0            2.00000       2.00000       2.00000

    W h0/v0 = 3.00000; acceleration over that of the standards' shock: 0.976683
    ");
}

#[test]
fn the_fields_are_those_of_the_contract() {
    let got = answer(["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=1e-6", "--damping=0"]);
    let net = &answer(["impacts", "--q=0.5", "--e=0.3"])["net"]["b"];
    // Slow and undamped: the net change at end b, to the square of the phase.
    for field in ["omega_peak_relative_displacement", "peak_absolute_acceleration_over_omega"] {
        assert!((got[field].as_f64().unwrap() - net.as_f64().unwrap()).abs() < 1e-9, "{field}: {got}");
    }
    assert_eq!(got["stiff"], Value::Null, "no such limit without damping");
    assert_eq!(got["peaks"]["absolute_acceleration_over_omega"]["positive"]["after_impact"], json!(4));
    assert_eq!(got["time_of_peak"], got["peaks"]["absolute_acceleration_over_omega"]["positive"]["time"]);
    assert_eq!(got["shocks"]["count"], json!(4));
}

#[test]
fn only_the_ratio_of_frequency_to_drop_matters() {
    let unit = answer(["respond", "--q=0.73", "--e=0.2", "--at=-0.5", "--omega=8"]);
    let si =
        answer(["respond", "--q=0.73", "--e=0.2", "--at=-0.5", "--omega=64", "--velocity=-2,-2", "--height-gap=0.25"]);
    let of = |got: &Value, name: &str| got[name].as_f64().unwrap();
    // Powers of two scale without rounding.
    for name in ["omega_peak_relative_displacement", "peak_absolute_acceleration_over_omega"] {
        assert_eq!(json!(2.0 * of(&unit, name)), si[name], "{name}");
    }
    assert_eq!(json!(0.125 * of(&unit, "time_of_peak")), si["time_of_peak"]);
    assert_eq!(unit["gain"], si["gain"]);
}

/// One shock, whose peaks as velocities do not depend on the frequency: also where z or A itself is beyond the floats.
#[test]
fn frequencies_at_the_ends_of_the_floats_have_answers() {
    let drop = [
        "respond",
        "--gyration-ratio=0.49",
        "--e=0",
        "--velocity=-1,0.25",
        "--height-gap=0",
        "--at=0",
        "--damping=1.75",
    ];
    let of = |omega: &str| answer(drop.iter().copied().chain([omega]));
    let unit = of("--omega=1");
    assert!(unit["omega_peak_relative_displacement"].as_f64().unwrap() > 0.09, "{unit}");
    for omega in ["--omega=5e-324", "--omega=1e-310", "--omega=1e308"] {
        for name in ["omega_peak_relative_displacement", "peak_absolute_acceleration_over_omega", "gain", "stiff"] {
            assert_eq!(of(omega)[name], unit[name], "{name} at {omega}");
        }
    }
}

#[test]
fn quality_factor_and_damping_ratio_are_one_thing() {
    let part = ["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=3"];
    let with = |more: &[&str]| answer(part.iter().chain(more));
    assert_eq!(with(&["--q-factor=10"]), with(&["--damping=0.05"]));
    assert_eq!(with(&[]), with(&["--q-factor=10"]), "Q = 10 unless told otherwise");
    assert_eq!(with(&["--q-factor=inf"]), with(&["--damping=0"]));
}

#[test]
fn a_flat_drop_is_its_net_change_and_the_way_there() {
    let got = answer(["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=3", "--damping=0", "--height-gap=0"]);
    let net = answer(["impacts", "--q=0.5", "--e=0.3"])["net"]["b"].as_f64().unwrap();
    // All at one instant: the displacement knows the sum alone.
    let got = got["omega_peak_relative_displacement"].as_f64().unwrap();
    assert!((got - net).abs() < 1e-15, "{got} and {net}");
}

#[test]
fn endless_trains_have_a_bound_on_what_is_left_out() {
    let got = answer(["respond", "--q=0.9", "--e=0.2", "--at=1", "--omega=5"]);
    let omitted = got["shocks"]["omitted"].as_f64().unwrap();
    assert!(0.0 < omitted && omitted < 1e-15, "{omitted:e}");
    let still = answer(["respond", "--q=1", "--e=0.2", "--at=0", "--omega=5"]);
    assert_eq!(still["peak_absolute_acceleration_over_omega"], json!(0.0), "nothing moves the center");
    assert_eq!(still["shocks"]["omitted"], json!(0.0), "of nothing, nothing is left out");
    let table = clatter(["respond", "--q=1", "--e=0.2", "--at=0", "--omega=5", "--damping=0.05"]).stdout;
    assert!(
        table.contains("absolute acceleration, A/W                 0             0  no impact is felt here\n"),
        "{table}"
    );
    assert!(!table.contains("infinite"), "{table}");
}

#[test]
fn the_rule_can_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let part = ["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=3", "-o"];
    let write = |name: &str| {
        let file = folder.path().join(name);
        let outcome = clatter(part.iter().copied().chain([file.to_str().unwrap()]));
        assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
        fs::read_to_string(file).unwrap()
    };
    let csv = write("rule.csv");
    assert!(csv.starts_with("omega,displacement,acceleration,gain\n0.01,"), "{}", &csv[..60]);
    let json: Value = serde_json::from_str(&write("rule.json")).unwrap();
    let row: Vec<f64> = csv.lines().nth(201).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    let got = ["omega", "displacement", "acceleration", "gain"].map(|name| json[name][200].as_f64().unwrap());
    assert_eq!(row, got);
    assert_eq!(json["omega"].as_array().unwrap().len(), csv.lines().count() - 1);
    let svg = write("rule.svg");
    for word in ["largest shock alone", "net change alone", "this component"] {
        assert!(svg.contains(word), "{word}");
    }
}
