//! `clatter tradeoff`: table, JSON, csv and figure, and what is refused.

use std::fs;

use clatter_cli::Exit;
use serde_json::Value;

use crate::assess::{changed, example};
use crate::bad_input::are_refused;
use crate::{answer, clatter};

/// The six models, from the least physics.
const MODELS: [&str; 6] = ["net-change", "largest-shock", "map", "ballistic", "finite-tilt", "compliant"];

#[test]
fn the_table_says_what_each_model_gets_wrong_and_costs() {
    let (_dir, path) = changed(|text| text);
    let outcome = clatter(["tradeoff", path.as_str()]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""), "{}", outcome.stdout);
    let table = &outcome.stdout;
    for said in [
        "Handheld: speed for accuracy, to 1 %",
        "Times of one run on one of ",
        "display, acceleration\n  drop ",
        "reference  compliant: ",
        "worked out to 0.10 %",
        "  cheapest",
    ] {
        assert!(table.contains(said), "{said}:\n{table}");
    }
    let row = |line: &&str| MODELS.iter().any(|model| line.trim_start().starts_with(&format!("{model} ")));
    let rows = table.lines().filter(row).count();
    // Five limits: all six models of a response; what is no response has no net change.
    assert!((5 * 5..=5 * 6).contains(&rows), "{rows}: {table}");
    assert!(table.lines().all(|line| line == line.trim_end()), "{table}");
}

#[test]
fn the_json_has_every_model_with_its_error_and_its_time() {
    let json = answer(["tradeoff", example("bar-phone.toml").as_str(), "--tolerance=5%"]);
    assert_eq!((&json["product"], &json["tolerance"]), (&"Phone".into(), &0.05.into()));
    assert!(json["machine"]["processor"].is_string() && json["machine"]["optimized"].is_boolean());
    assert_eq!(json["left_out"], Value::Array(Vec::new()));
    let limits = json["limits"].as_array().unwrap();
    assert_eq!(limits.len(), 3, "one for each limit");
    for limit in limits {
        for key in ["component", "limit", "worst_case", "unit", "reference", "models", "cheapest", "reason", "groups"] {
            assert!(!limit[key].is_null(), "{key}: {limit}");
        }
        let truth = limit["reference"]["value"].as_f64().unwrap();
        for model in limit["models"].as_array().unwrap() {
            let number = |key: &str| model[key].as_f64().unwrap();
            assert!((number("error") - (number("value") / truth - 1.0).abs()).abs() < 1e-12, "{model}");
            assert!(number("seconds") > 0.0, "{model}");
            let closed = ["net-change", "largest-shock"].iter().any(|name| model["model"] == *name);
            assert_eq!(model["strikes"] == 0, closed, "{model}");
        }
        // No other model within the tolerance took less time.
        let good = limit["models"].as_array().unwrap().iter().filter(|m| m["error"].as_f64().unwrap() <= 0.05);
        let fastest = good.min_by(|a, b| a["seconds"].as_f64().unwrap().total_cmp(&b["seconds"].as_f64().unwrap()));
        assert_eq!(fastest.unwrap()["model"], limit["cheapest"], "{limit}");
    }
}

#[test]
fn without_contact_time_the_reference_is_real_tilt() {
    let path = example("bar-laptop.toml");
    let outcome = clatter(["tradeoff", path.as_str()]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    assert!(outcome.stdout.contains("reference  finite-tilt: "), "{}", outcome.stdout);
    assert!(!outcome.stdout.contains("compliant "), "{}", outcome.stdout);
}

#[test]
fn rows_and_figure_are_whole() {
    let (dir, path) = changed(|text| text.replace("\"camera\"", "\"camera, <left> & *right*\""));
    let figure = dir.path().join("trade.svg");
    let outcome = clatter(["tradeoff", &path, "-o", figure.to_str().unwrap(), "--format=csv"]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    let mut lines = outcome.stdout.lines();
    let head = "component,limit,model,value,unit,error,seconds,strikes,cheapest";
    assert_eq!(lines.next(), Some(head));
    let rows: Vec<&str> = lines.collect();
    assert!((5 * 5..=5 * 6).contains(&rows.len()), "{}", outcome.stdout);
    assert!(rows.iter().any(|row| row.starts_with("\"camera, <left> & *right*\",acceleration,")), "{}", outcome.stdout);
    assert_eq!(rows.iter().filter(|row| row.ends_with(",true")).count(), 5, "the cheapest of each limit");
    let commas = head.matches(',').count();
    assert!(rows.iter().all(|row| row.replace("camera, <", "camera <").matches(',').count() == commas));
    let svg = fs::read_to_string(&figure).unwrap();
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{svg}");
    assert!(svg.contains("camera, &lt;left&gt; &amp;"), "{svg}");
    let names: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|f| f.unwrap().file_name()).collect();
    assert_eq!(names.len(), 2, "the product and the figure, nothing half-written: {names:?}");
}

#[test]
fn help_has_examples_and_says_how_to_read_the_table() {
    let help = clatter(["tradeoff", "--help"]);
    assert_eq!(help.exit, Exit::Done);
    for said in
        ["clatter tradeoff handheld.toml -o trade.svg", "error", "strikes", "no other model within the tolerance"]
    {
        assert!(help.stdout.contains(said), "{said}:\n{}", help.stdout);
    }
}

#[test]
fn what_is_no_product_or_no_figure_is_refused() {
    let (_dir, path) = changed(|text| text.replace("140 mm", "140 kg"));
    let (_stiff, stiff) = changed(|text| text.replace("contact_time = \"0.4 ms\"", "").replace("220 Hz", "2.2 kHz"));
    let arguments = |all: &[&str]| all.iter().map(|&a| a.to_owned()).collect::<Vec<_>>();
    let rows: [(Vec<String>, &[&str]); 6] = [
        (arguments(&["tradeoff"]), &["<PRODUCT.toml>"]),
        (arguments(&["tradeoff", "nowhere.toml"]), &["cannot read nowhere.toml"]),
        (arguments(&["tradeoff", "x.toml", "-o", "x.png"]), &["x.png", "must end in .svg"]),
        (arguments(&["tradeoff", "x.toml", "--format=xml"]), &["--format", "table, json, csv"]),
        (arguments(&["tradeoff", &path]), &["\"kg\" is no unit of length", ":11:10"]),
        (arguments(&["tradeoff", &stiff]), &["needs the contact time of the product", "318 Hz"]),
    ];
    are_refused(rows);
}
