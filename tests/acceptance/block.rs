//! `clatter simulate` and `clatter respond` of a box.

use clatter_cli::Exit;
use serde_json::Value;

use crate::simulate::simulated;
use crate::{answer, clatter};

const BOX: [&str; 8] = [
    "--model=compliant",
    "--length-m=0.12",
    "--width-m=0.06",
    "--thickness-m=0.02",
    "--gyration-m=0.018257,0.035119,0.038730",
    "--e=0.5",
    "--contact-time-s=4e-4",
    "--speed-m-s=3",
];

fn with<'a>(command: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    std::iter::once(command).chain(BOX).chain(more.iter().copied()).collect()
}

/// Four corners touch at once, and the middle gets (1 + e) v, from four presses of the same force.
#[test]
fn a_box_that_lands_flat_presses_all_four_corners() {
    let found = answer(with("simulate", &["--tilt-deg=0", "--time-limit-s=0.01"]));
    let impacts = found["impacts"].as_array().unwrap();
    let corners: Vec<&str> = impacts.iter().map(|impact| impact["corner"].as_str().unwrap()).collect();
    assert_eq!(corners, ["---", "+--", "-+-", "++-"]);
    let sum: f64 = impacts.iter().map(|impact| impact["delta_v_m_s"][7].as_f64().unwrap()).sum();
    assert!((sum - 4.5).abs() < 0.01, "{sum}");
    assert_eq!(found["stop"]["reason"], "time-limit");
    // A rigid part: the half of a sine of 4/μ of the stiffness, about (π/2)(1 + e) v/τ √(4/μ) at most.
    let felt = answer(with("respond", &["--tilt-deg=0", "--at-m=0,0,0"]));
    let own = 1.0 + (0.03_f64 / 0.018_257).powi(2) + (0.06_f64 / 0.035_119).powi(2);
    let peak = std::f64::consts::FRAC_PI_2 * 1.5 * 3.0 / 4e-4 * (4.0 / own).sqrt();
    let value = felt["acceleration_m_s2"].as_f64().unwrap();
    assert!((value / peak - 1.0).abs() < 5e-3, "{value}, not {peak}");
}

/// A part that is far slower than all of it gets the change of velocity, one that is far stiffer the acceleration of its place.
#[test]
fn soft_and_stiff_parts_are_those_of_the_limits() {
    let of = |omega: &str| {
        let flat = ["--orientation=1,0,0,0", "--gravity-m-s2=0", "--at-m=0,0,0", "--damping=0", omega];
        answer(with("respond", &flat))
    };
    let soft = of("--omega=60");
    let value = soft["omega_peak_relative_displacement"].as_f64().unwrap();
    assert!((value / 4.5 - 1.0).abs() < 0.01, "{value}");
    let stiff = of("--omega=500000");
    let felt = stiff["acceleration_m_s2"].as_f64().unwrap();
    let value = 5e5 * stiff["peak_absolute_acceleration_over_omega"].as_f64().unwrap();
    assert!((value / felt - 1.0).abs() < 0.01, "{value} {felt}");
}

/// A quarter turn about the long axis: what was felt along z is felt along y.
#[test]
fn a_part_moves_along_its_axis() {
    let root = "0.7071067811865476";
    let turned = format!("--orientation={root},{root},0,0");
    let of = |axis| {
        let found = answer(with("respond", &[&turned, "--at-m=0,0,0", axis]));
        found["acceleration_m_s2"].as_f64().unwrap()
    };
    let [x, y, z, any] = ["--axis=x", "--axis=y", "--axis=z", "--axis=any"].map(of);
    assert!(y > 1e3 && x < 1e-6 * y, "{x} {y}");
    assert!((any / y - 1.0).abs() < 1e-3 && z < 0.5 * y, "{any} {y} {z}");
}

#[test]
fn what_is_no_drop_of_a_box_is_told() {
    for (arguments, said) in [
        (
            vec!["simulate", "--model=compliant", "--width=60mm", "--length=120mm", "--orientation=1,0,0,0"],
            "the drop is not whole: give --thickness",
        ),
        (with("simulate", &["--orientation=1,1,0,0"]), "unit quaternion"),
        (with("simulate", &["--orientation=1,0,0"]), "3 numbers, not 4"),
        (with("simulate", &["--tilt-deg=10", "--spin-rad-s=1"]), "three values for a box"),
        (with("simulate", &["--tilt-deg=10", "--center-of-mass-m=0.1,0,0"]), "within the box"),
        (with("simulate", &["--tilt-deg=10", "-o", "x.csv"]), "not written to a file"),
        (with("simulate", &["--tilt-deg=10", "--spin-rad-s=0,-1e4,0"]), "contact time"),
        (with("simulate", &["--tilt-deg=10", "--friction=-0.1"]), "'--friction': friction = -0.1 is not in [0, 10]"),
        (with("simulate", &["--tilt-deg=10", "--friction=NaN"]), "--friction"),
        (with("respond", &["--tilt-deg=10"]), "--at=X,Y,Z"),
        (with("respond", &["--tilt-deg=10", "--at-m=0,0.04,0"]), "across the product in m is 0.04"),
        (with("respond", &["--tilt-deg=10", "--at-m=0,0,0", "--axis=any", "--omega=100"]), "along one axis"),
        (
            vec![
                "simulate",
                "--model=map",
                "--length-m=1",
                "--gyration-m=1,1,1",
                "--e=0.5",
                "--speed=3m/s",
                "--tilt=2deg",
            ],
            "not three",
        ),
    ] {
        let outcome = clatter(&arguments);
        assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(said), "{}, not {said}", outcome.stderr);
    }
}

#[test]
fn tables_and_rows_have_every_press() {
    let table = clatter(with("simulate", &["--tilt-deg=35", "--direction-deg=60"]));
    assert_eq!(table.exit, Exit::Done, "{}", table.stderr);
    assert!(
        table.stdout.contains("Body of 0.12 m by 0.06 m by 0.02 m") && table.stdout.contains("At rest at"),
        "{}",
        table.stdout
    );
    let rows = clatter(with("simulate", &["--tilt-deg=35", "--direction-deg=60", "--format=csv"]));
    let found = answer(with("simulate", &["--tilt-deg=35", "--direction-deg=60"]));
    assert_eq!(rows.stdout.lines().count(), 1 + found["impacts"].as_array().unwrap().len());
    assert!(rows.stdout.starts_with("number,corner,time_s,until_s,approach_m_s,delta_v_---_m_s,"), "{}", rows.stdout);
}

/// One schema for all bodies: a place has the shock of the corner that it is, and the middle the mean of all.
#[test]
fn every_body_is_answered_with_the_same_fields() {
    let fall =
        ["simulate", "--model=compliant", "--length-m=0.12", "--contact-time-s=4e-4", "--e=0.5", "--speed-m-s=3"];
    let of = |more: &[&'static str]| simulated(fall.into_iter().chain(["--tilt-deg=5"]).chain(more.iter().copied()));
    let bar = of(&["--gyration-m=0.035", "--at=1", "--at=0"]);
    let width = ["--direction-deg=30", "--width-m=0.06"];
    let plate = of(&[&width[..], &["--gyration-m=0.035,0.018", "--at=1,-1", "--at=0,0"]].concat());
    let solid = ["--thickness-m=0.02", "--gyration-m=0.018257,0.035119,0.038730", "--at=1,-1,-1", "--at=0,0,0"];
    let solid = of(&[&width[..], &solid].concat());
    let names = |of: &Value| of.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    // How it moves at the end is told of a box alone.
    let of_solid: Vec<_> = names(&solid).into_iter().filter(|name| name != "end").collect();
    assert_eq!((names(&plate), names(&plate["drop"])), (of_solid, names(&solid["drop"])));
    let of_bar: Vec<_> =
        names(&bar).into_iter().filter(|name| !plate.as_object().unwrap().contains_key(name)).collect();
    assert_eq!(of_bar, ["inertia_ratios", "pivots"]);
    let of_impact =
        |of: &Value, point: &str| names(&of["impacts"][0]).into_iter().filter(|name| name != point).collect::<Vec<_>>();
    assert_eq!(of_impact(&plate, "corner"), of_impact(&solid, "corner"));
    assert_eq!(of_impact(&plate, "corner"), of_impact(&bar, "end"));
    for (of, at) in [(&bar, "[1.0,0.0,0.0]"), (&plate, "[1.0,-1.0,0.0]"), (&solid, "[1.0,-1.0,-1.0]")] {
        assert_eq!((of["at"][0].to_string(), of["stop"]["reason"].as_str()), (at.to_owned(), Some("at-rest")));
        for impact in of["impacts"].as_array().unwrap() {
            let shocks = |name: &str| impact[name].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
            let (points, places): (Vec<f64>, Vec<f64>) = (shocks("delta_v_m_s"), shocks("delta_v_at_m_s"));
            let mean = points.iter().sum::<f64>() / f64::from(u32::try_from(points.len()).unwrap());
            assert!((places[0] - points[1]).abs() < 1e-12 && (places[1] - mean).abs() < 1e-9, "{impact}");
        }
    }
}
