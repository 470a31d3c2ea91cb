//! `clatter explain`, and the tolerance and model of `clatter assess`.

use std::path::Path;

use clatter_cli::Exit;
use serde_json::Value;

use crate::{answer, clatter};

fn example(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reports/examples").join(name);
    path.to_str().unwrap().to_owned()
}

#[test]
fn every_limit_gets_its_models_and_a_reason() {
    let path = example("phone.toml");
    let json = answer(["explain", path.as_str()]);
    assert_eq!(json["tolerance"], 0.01);
    let mut highest = 0;
    for limit in json["components"].as_array().unwrap().iter().flat_map(|c| c["limits"].as_array().unwrap()) {
        let shares = limit["shares"].as_array().unwrap();
        let whole: f64 = shares.iter().map(|pair| pair["share"].as_f64().unwrap()).sum();
        assert!((whole - 1.0).abs() < 1e-12, "{limit}");
        let plan = &limit["plan"];
        assert!(plan["reason"].as_str().unwrap().len() > 10, "{limit}");
        assert!(limit["warning"].is_string() || plan["error"].as_f64().unwrap() <= 0.01, "{limit}");
        highest += usize::from(plan["bar"] == "compliant");
    }
    assert!(highest > 0, "contacts of the phone overlap at its least tilt: {json}");
    // Cheaper models are enough for more drops where less is asked.
    let cheap = |json: &Value| -> f64 {
        let shares = json["components"][0]["limits"][0]["shares"].as_array().unwrap();
        shares.iter().filter(|p| p["bar"] != "compliant").map(|p| p["share"].as_f64().unwrap()).sum()
    };
    let coarse = answer(["explain", path.as_str(), "--tolerance=10%"]);
    assert!(cheap(&coarse) > cheap(&json), "{} {}", cheap(&coarse), cheap(&json));
    let table = clatter(["explain", path.as_str()]);
    assert_eq!((table.exit, table.stderr.as_str()), (Exit::Done, ""));
    for said in ["main board, acceleration", "over the ranges", "because", "error", "cost"] {
        assert!(table.stdout.contains(said), "{said}: {}", table.stdout);
    }
    let laptop = clatter(["explain", &example("laptop.toml")]);
    assert!(laptop.stdout.contains("no contact time is known"), "{}", laptop.stdout);
}

#[test]
fn a_tolerance_and_a_model_can_be_asked_for() {
    let path = example("laptop.toml");
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
    ] {
        let outcome = clatter(["assess", path.as_str(), option]);
        assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{option}");
        assert!(outcome.stderr.contains(said), "{option}: {}", outcome.stderr);
    }
}
