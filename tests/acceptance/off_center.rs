//! A center of mass off the middle, in every command that takes one.

use clatter_cli::Exit;
use insta::assert_snapshot;
use serde_json::{Value, json};

use crate::bad_input::are_refused;
use crate::{answer, clatter};

#[rustfmt::skip]
const REFUSED: &[(&[&str], &[&str])] = &[
    (&["impacts", "--e=0"], &["--q <Q>|--gyration-ratio <K>|--mass <M@S[:T]>"]),
    (&["impacts", "--q=0.5", "--mass=1@0", "--e=0"], &["--q", "--mass", "cannot be used with"]),
    (&["impacts", "--q=0.5", "--center-of-mass=0.1", "--e=0"], &["--q", "--center-of-mass", "cannot be used with"]),
    (&["zone", "--mass=1@0", "--center-of-mass=0.1", "--e=0", "--threshold=1"], &["--mass", "--center-of-mass", "cannot be used with"]),
    (&["impacts", "--gyration-ratio=0.5", "--center-of-mass=-1", "--e=0"], &["--center-of-mass", "-1.0", "(-1, 1)"]),
    (&["impacts", "--gyration-ratio=0.5", "--center-of-mass=0.9999999", "--e=0"], &["--center-of-mass", "ratio of the arms", "[1e-6, 1e6]"]),
    (&["impacts", "--gyration-ratio=1e-20", "--center-of-mass=0.5", "--e=0"], &["--gyration-ratio", "1e-20", "[1e-12, 1e6]"]),
    (&["impacts", "--mass=1", "--e=0"], &["--mass", "'1'", "M@S at position S, or M@S:T"]),
    (&["impacts", "--mass=@0", "--e=0"], &["--mass", "'' is not a number"]),
    (&["impacts", "--mass=1@", "--e=0"], &["--mass", "'' is not a number"]),
    (&["impacts", "--mass=1@0:", "--e=0"], &["--mass", "'' is not a number"]),
    (&["impacts", "--mass=-1@0", "--e=0"], &["--mass", "-1.0", "[1e-25, 1e25]"]),
    (&["impacts", "--mass=0@0", "--e=0"], &["--mass", "0.0", "[1e-25, 1e25]"]),
    (&["impacts", "--mass=nan@0", "--e=0"], &["--mass", "NaN", "[1e-25, 1e25]"]),
    (&["impacts", "--mass=1@inf", "--e=0"], &["--mass", "inf", "[-1e25, 1e25]"]),
    (&["impacts", "--mass=1@0.5:-0.5", "--e=0"], &["--mass", "-0.5", "beyond where the slab begins"]),
    (&["impacts", "--mass=1@1", "--e=0"], &["--mass", "center of mass = 1.0", "(-1, 1), between the ends"]),
    (&["zone", "--mass=1@-3", "--e=0", "--threshold=1"], &["--mass", "center of mass = -3.0", "(-1, 1), between the ends"]),
    (&["simulate", "--model=map", "--length-m=1", "--mass=1@1", "--e=0", "--speed-m-s=1", "--tilt-deg=1"], &["--mass", "center of mass = 1.0"]),
    (&["simulate", "--model=map", "--length-m=1", "--gyration-m=1", "--mass=1@0", "--e=0", "--speed-m-s=1", "--tilt-deg=1"], &["--gyration-m", "--mass", "cannot be used with"]),
    (&["simulate", "--model=map", "--length-m=1", "--center-of-mass=0.1", "--mass=1@0", "--e=0", "--speed-m-s=1", "--tilt-deg=1"], &["--center-of-mass", "--mass", "cannot be used with"]),
    (&["simulate", "--model=map", "--length-m=1", "--e=0", "--speed-m-s=1", "--tilt-deg=1"], &["give --gyration=LENGTH or --mass=M@S"]),
    // What needs a symmetric bar says so.
    (&["respond", "--mass=1@0.5", "--e=0", "--at=0", "--omega=1"], &["0.5 of a half-length off the middle", "symmetric"]),
];

#[test]
fn what_is_no_body_is_refused() {
    are_refused(REFUSED.iter().map(|(arguments, said)| (arguments.iter().map(|&a| a.to_owned()).collect(), *said)));
}

#[test]
fn masses_about_the_middle_are_the_symmetric_bar() {
    // All mass at the ends is k = 1, q = 0; the answers are the same, byte for byte.
    for command in [&["impacts"][..], &["zone", "--threshold=1", "--first=b"]] {
        for format in ["table", "json", "csv"] {
            let call = |inertia: &[&str]| {
                let format = format!("--format={format}");
                let all = [command, inertia, &["--e=0.3", &format]].concat();
                clatter(all).stdout
            };
            let given = call(&["--gyration-ratio=1"]);
            assert_eq!(call(&["--mass=0.7@-1", "--mass=0.7@1"]), given);
            assert_eq!(call(&["--gyration-ratio=1", "--center-of-mass=0"]), given);
            assert!(!given.is_empty());
        }
    }
}

#[test]
fn masses_off_the_middle_are_their_center_and_their_radius_of_gyration() {
    // 3 at −1 and 1 at 1: center −0.5, ρ² = 3/4.
    let radius = format!("--gyration-ratio={:?}", 0.75_f64.sqrt());
    let masses = answer(["impacts", "--mass=3@-1", "--mass=1@1", "--e=0.5"]);
    let given = answer(["impacts", &radius, "--center-of-mass=-0.5", "--e=0.5"]);
    assert_eq!(masses, given);
    assert_eq!(masses["center_of_mass"], json!(-0.5));
    // ρ² = L_a L_b: no strike moves the other end, but for roundings.
    assert!(masses["q"].as_f64().unwrap().abs() < 1e-15, "{}", masses["q"]);
}

#[test]
fn impacts_tell_both_ends_apart() {
    let got = answer(["impacts", "--gyration-ratio=0.5", "--center-of-mass=0.4", "--e=0.3", "--at=0.4"]);
    let [qa, qb] = [0, 1].map(|i| got["inertia_ratios"][i].as_f64().unwrap());
    // (1.4·0.6 − 0.25)/(1.96 + 0.25) and over (0.36 + 0.25).
    assert!((qa - 0.59 / 2.21).abs() < 1e-15 && (qb - 0.59 / 0.61).abs() < 1e-15, "{qa} {qb}");
    assert!((got["q"].as_f64().unwrap() - (qa * qb).sqrt()).abs() < 1e-15);
    let impacts = got["impacts"].as_array().unwrap();
    let shocks = |of: &dyn Fn(&Value) -> f64| impacts.iter().map(|i| of(i).abs()).fold(0.0, f64::max);
    for end in 0..2 {
        let largest = shocks(&|impact| impact["delta_v"][end].as_f64().unwrap());
        assert!((got["peak"]["ends"][end].as_f64().unwrap() - largest).abs() < 1e-12, "end {end}");
    }
    let center = shocks(&|impact| impact["delta_v_at"][0].as_f64().unwrap());
    assert!((got["peak"]["center"].as_f64().unwrap() - center).abs() < 1e-12);
}

/// A bar of masses next to the endless curve: its count hangs on the last digit of their center of mass. The same bar, given by
/// lengths, is what was given.
#[test]
fn a_count_of_masses_is_exact_unless_their_rounding_decides_it() {
    let masses = |e: &str| ["impacts", "--mass=2@-1:1", "--mass=1@0.5", e, "--limit=0"].map(str::to_owned);
    // T = q (1 + e) = 2 √e at this e, to the last digit.
    let (on_the_curve, apart) = (masses("--e=0.08987858053123303"), masses("--e=0.1"));
    let next = answer(&on_the_curve);
    assert_eq!(next["count_exact"], json!(false), "{next}");
    assert!(next["count"].as_u64().unwrap() > 1_000_000, "{next}");
    let table = clatter(&on_the_curve).stdout;
    assert!(table.contains("of the rounded masses"), "{table}");
    assert_eq!(answer(&apart)["count_exact"], json!(true));
    let [c, k] = ["center_of_mass", "gyration_ratio"].map(|key| next[key].as_f64().unwrap());
    let lengths = [format!("--center-of-mass={c:?}"), format!("--gyration-ratio={k:?}")];
    let given = answer(["impacts", "--e=0.08987858053123303", "--limit=0", &lengths[0], &lengths[1]]);
    assert_eq!((&given["count_exact"], &given["count"]), (&json!(true), &next["count"]));
}

#[test]
fn zones_reach_differently_far_from_the_safest_place() {
    let got =
        answer(["zone", "--gyration-ratio=0.5", "--center-of-mass=0.4", "--e=0.3", "--threshold=1", "--threshold=0.1"]);
    let [s, shock] = ["s", "shock"].map(|name| got["safest"][name].as_f64().unwrap());
    let [lo, hi] = [0, 1].map(|i| got["zones"][0]["zone"][i].as_f64().unwrap());
    assert!(lo < s && s < hi && shock < 1.0);
    assert!((0.5 * (lo + hi) - s).abs() > 0.005, "not its middle");
    assert!((got["zones"][0]["s"].as_f64().unwrap() - 0.5 * (hi - lo)).abs() < 1e-15, "inside the bar on both sides");
    assert_eq!((&got["zones"][1]["extent"], &got["zones"][1]["zone"]), (&json!("none"), &Value::Null));
    assert_eq!(got["center_of_mass"], json!(0.4));
    // The safest place sees what is said, in the trains of either first end, the second in the mirror.
    let worst = |center: f64, at: f64| {
        let flags = [format!("--center-of-mass={center}"), format!("--at={at:?}")];
        let list = answer(["impacts", "--gyration-ratio=0.5", "--e=0.3", &flags[0], &flags[1]]);
        let of = |impact: &Value| impact["delta_v_at"][0].as_f64().unwrap().abs();
        list["impacts"].as_array().unwrap().iter().map(of).fold(0.0, f64::max)
    };
    assert!((worst(0.4, s).max(worst(-0.4, -s)) - shock).abs() < 1e-12);
}

#[test]
fn a_simulation_of_the_map_is_the_impacts_in_si() {
    let masses = ["--mass=2@-1:1", "--mass=1@0.5"];
    let drop = ["simulate", "--model=map", "--length-m=0.2", "--speed-m-s=3", "--tilt-deg=2", "--e=0.4"];
    let flight = answer([&drop[..], &masses].concat());
    let train = answer([&["impacts", "--e=0.4"][..], &masses].concat());
    let ends = [0, 1].map(|end| flight["drop"]["body"]["length"]["ends_m"][end].as_f64().unwrap());
    assert!(((ends[0] - ends[1]) / 0.2 - 1.0 / 6.0).abs() < 1e-15);
    let unit = 0.2 * 2.0_f64.to_radians().sin() / 3.0;
    let (flight, train) = (flight["impacts"].as_array().unwrap(), train["impacts"].as_array().unwrap());
    assert_eq!(flight.len(), train.len());
    for (strike, impact) in flight.iter().zip(train) {
        let [t, time] = [&strike["time_s"], &impact["time"]].map(|x| x.as_f64().unwrap());
        assert!((t - unit * time).abs() < 1e-12 * (unit + t), "{strike} {impact}");
        for end in 0..2 {
            let [v, shock] = [&strike["delta_v_m_s"][end], &impact["delta_v"][end]].map(|x| x.as_f64().unwrap());
            assert!((v - 3.0 * shock).abs() < 1e-11, "{strike} {impact}");
        }
    }
}

#[test]
fn people_are_told_where_it_is_safest() {
    let shown = clatter([
        "zone",
        "--mass=2@-1:1",
        "--mass=1@0.5",
        "--e=0.3",
        "--threshold=0.5",
        "--threshold=1",
        "--threshold=9",
        "--first=a",
    ]);
    assert_eq!((shown.exit, shown.stderr.as_str()), (Exit::Done, ""));
    assert_snapshot!(shown.stdout, @"
    Safe zones of a bar with its center of mass at 0.166667, e = 0.3
    End a sees up to 2.50714 v0, end b up to 2.01610 v0
    The safest place is 0.123656, with up to 0.501703 v0

       threshold    safe zone s                                            safe interval if a strikes first
              v0   half-lengths
        0.500000    -9.69684e-4   none: even the safest place sees more    from -0.0691492 to 0.122671
         1.00000       0.283775   from -0.155542 to 0.412008               from -0.543060 to 0.412008
         9.00000        4.83969   the whole bar                            from -1.00000 to 1.00000
    ");
}
