//! `clatter explain`, and the tolerance and model of `clatter assess`.

use clatter_cli::Exit;
use serde_json::Value;

use crate::assess::example;
use crate::{answer, clatter};

/// The six models, from the least physics.
const MODELS: [&str; 6] = ["net-change", "largest-shock", "map", "ballistic", "finite-tilt", "compliant"];

#[test]
fn every_limit_gets_its_models_and_a_reason() {
    let path = example("bar-phone.toml");
    let json = answer(["explain", path.as_str()]);
    assert_eq!((&json["tolerance"], &json["left_out"]), (&0.01.into(), &Value::Array(Vec::new())));
    let assessed: Value = serde_json::from_str(&clatter(["assess", path.as_str(), "--format=json"]).stdout).unwrap();
    let all = assessed["components"].as_array().unwrap().iter().flat_map(|c| c["limits"].as_array().unwrap());
    let limits = json["limits"].as_array().unwrap();
    assert_eq!(limits.len(), 3);
    for (limit, assessed) in limits.iter().zip(all) {
        assert_eq!((&limit["limit"], &limit["worst_case"]), (&assessed["limit"], &assessed["worst_case"]));
        let reference = &limit["reference"];
        assert_eq!(reference["model"], "compliant", "all that the file allows");
        let (truth, demand) = (reference["value"].as_f64().unwrap(), assessed["demand"].as_f64().unwrap());
        assert!((truth / demand - 1.0).abs() < 0.01, "{truth}, not {demand}");
        let models = limit["models"].as_array().unwrap();
        let known = |model: &Value| MODELS.iter().position(|name| model["model"] == *name).unwrap();
        assert!(models.windows(2).all(|pair| known(&pair[0]) < known(&pair[1])), "from the least physics: {limit}");
        for model in models {
            let error = (model["value"].as_f64().unwrap() / truth - 1.0).abs();
            assert!((error - model["error"].as_f64().unwrap()).abs() < 1e-12, "{model}");
        }
        let cheapest = models.iter().find(|model| model["model"] == limit["cheapest"]).unwrap();
        assert!(cheapest["error"].as_f64().unwrap() <= 0.01, "{limit}");
        assert!(limit["reason"].as_str().unwrap().len() > 10 && limit["groups"]["gravity"].is_number(), "{limit}");
    }
}

#[test]
fn less_is_enough_where_less_is_asked() {
    let path = example("bar-phone.toml");
    let cheapest = |tolerance: &str| {
        let json = answer(["explain", path.as_str(), tolerance]);
        let of = |limit: &Value| MODELS.iter().position(|name| limit["cheapest"] == *name).unwrap();
        json["limits"].as_array().unwrap().iter().map(of).sum::<usize>()
    };
    assert!(cheapest("--tolerance=50%") < cheapest("--tolerance=0.01%"), "cheaper models do for half");
}

#[test]
fn people_are_told_what_decides() {
    let table = clatter(["explain", &example("bar-phone.toml")]);
    assert_eq!((table.exit, table.stderr.as_str()), (Exit::Done, ""));
    for said in [
        "Phone: the cheapest model within 1 % of the one with the most physics",
        "main board, acceleration\n  worst drop ",
        "  compliant ",
        "off by",
        "cheapest within the tolerance",
        "because",
        "groups     g h0/v0² = ",
    ] {
        assert!(table.stdout.contains(said), "{said}: {}", table.stdout);
    }
    assert_eq!(table.stdout.matches("cheapest within the tolerance").count(), 3, "{}", table.stdout);
    let laptop = clatter(["explain", &example("bar-laptop.toml")]);
    assert!(!laptop.stdout.contains("compliant") && !laptop.stdout.contains("τ/Δt"), "{}", laptop.stdout);
}

#[test]
fn a_tolerance_and_a_model_can_be_asked_for() {
    let path = example("bar-laptop.toml");
    let demand = |json: &Value| json["components"][1]["limits"][0]["demand"].as_f64().unwrap();
    let json = |option: &str| -> Value {
        serde_json::from_str(&clatter(["assess", path.as_str(), option, "--format=json"]).stdout).unwrap()
    };
    let (close, coarse) = (json("--tolerance=0.1%"), json("--tolerance=0.05"));
    assert!((demand(&coarse) / demand(&close) - 1.0).abs() < 0.05, "{} {}", demand(&coarse), demand(&close));
    let map = json("--model=map");
    for limit in map["components"].as_array().unwrap().iter().flat_map(|c| c["limits"].as_array().unwrap()) {
        assert_eq!(limit["model"]["bar"], "map", "{limit}");
    }
    for (option, said) in [
        ("--tolerance=0", "allowed: a share in [1e-4, 0.5]"),
        ("--tolerance=many", "is not a share such as 0.01 or 1%"),
        ("--model=magic", "finite-tilt"),
        // The laptop has no contact time.
        ("--model=compliant", "needs the contact time"),
        // A model that follows nothing is none to follow drops by.
        ("--model=net-change", "map, ballistic, finite-tilt, compliant"),
    ] {
        let outcome = clatter(["assess", path.as_str(), option]);
        assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{option}");
        assert!(outcome.stderr.contains(said), "{option}: {}", outcome.stderr);
    }
}

/// Of a box: what each of its drops does, what its tolerance leaves open, and what the plate of a face would say.
#[test]
fn the_drops_of_a_box_are_told_one_by_one() {
    let path = example("handheld-transit.toml");
    let json = answer(["explain", path.as_str(), "--tolerance=5%"]);
    let landings = json["landings"].as_array().unwrap();
    assert_eq!(landings.len(), 26);
    let bottom = landings.iter().find(|landing| landing["landing"] == "face bottom").unwrap();
    // The diagonal of 220 mm × 85 mm, 2 degrees, from 1.22 m.
    let latest = 0.22_f64.hypot(0.085) * 2_f64.to_radians().sin() / (2.0 * 9.80665 * 1.22_f64).sqrt();
    let last = bottom["last_corner_s"][1].as_f64().unwrap();
    assert!(
        (last / latest - 1.0).abs() < 1e-9 && bottom["contact_time_s"] == serde_json::json!([1e-3, 1e-3]),
        "{bottom}"
    );
    assert!(
        bottom["as_one_to_deg"].as_f64().is_some_and(|degrees| degrees < 2.0) && bottom["corners"] == 4,
        "{bottom}"
    );
    let limits = json["limits"].as_array().unwrap();
    assert_eq!(limits.len(), 3);
    for limit in limits {
        let names: Vec<_> = limit["models"].as_array().unwrap().iter().map(|m| m["model"].as_str().unwrap()).collect();
        // The camera is shaken along any axis, which no plate does.
        let known = if limit["component"] == "camera" { vec!["box"] } else { vec!["bar", "plate", "box"] };
        assert_eq!(names, known, "{limit}");
    }
    let table = clatter(["explain", path.as_str(), "--tolerance=5%"]).stdout;
    for told in ["last corner", "one corner", "0 to 1.68", "drops may clatter", "face bottom"] {
        assert!(table.contains(told), "{told}: {table}");
    }
}
