//! `clatter tradeoff`: table, JSON, csv and figure, and what is refused.

use std::fs;

use clatter_cli::Exit;
use serde_json::Value;

use crate::assess::{changed, example};
use crate::bad_input::are_refused;
use crate::{answer, clatter};

#[test]
fn the_table_says_what_each_pair_gets_wrong_and_costs() {
    let (_dir, path) = changed(|text| text);
    let outcome = clatter(["tradeoff", path.as_str()]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""), "{}", outcome.stdout);
    let table = &outcome.stdout;
    for said in [
        "Handheld: speed for accuracy",
        "Times of one run on one of ",
        "display, acceleration (peak-acceleration)",
        "reference  compliant, pulse-train: ",
        "plan at 10 %",
        "plan at 0.1 %",
        "strikes worth keeping for 10 %, 1 %, 0.1 %",
        "camera, angular-velocity-change: no pair of these models is asked",
    ] {
        assert!(table.contains(said), "{said}:\n{table}");
    }
    // A row for each pair: 18 for each response, 6 for the velocity shock.
    let rungs = ["closed-form ", "map ", "ballistic ", "finite-tilt ", "compliant "];
    let is_row = |line: &&str| rungs.iter().any(|rung| line.trim_start().starts_with(rung)) && line.contains(" % ");
    let rows: Vec<&str> = table.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   ")).collect();
    assert_eq!(rows.into_iter().filter(is_row).count(), 3 * 18 + 6, "{table}");
    assert!(table.lines().all(|line| line == line.trim_end()), "{table}");
}

#[test]
fn the_json_has_every_pair_the_choices_and_the_strikes_worth_keeping() {
    let json = answer(["tradeoff", example("phone.toml").as_str()]);
    assert_eq!(json["product"], "Phone");
    assert!(json["machine"]["processor"].is_string() && json["machine"]["optimized"].is_boolean());
    assert_eq!(json["left_out"], Value::Array(Vec::new()));
    let trades = json["trades"].as_array().unwrap();
    assert_eq!(trades.len(), 3, "one for each limit");
    for trade in trades {
        for key in ["component", "limit", "first", "position_m", "quantity", "scene", "reference", "choices", "kept"] {
            assert!(!trade[key].is_null(), "{key}: {trade}");
        }
        assert_eq!((&trade["reference"]["bar"], &trade["reference"]["lacks"]), (&"compliant".into(), &Value::Null));
        let pairs = trade["pairs"].as_array().unwrap();
        let truth = trade["reference"]["value"].as_f64().unwrap();
        for pair in pairs {
            // Nothing is infinite in this product but estimates that there are none of.
            let number = |key: &str| pair[key].as_f64().unwrap();
            assert!((number("error") - (number("value") / truth - 1.0).abs()).abs() < 1e-15, "{pair}");
            assert!(pair["estimate"].is_number() || pair["estimate"] == "infinite", "{pair}");
            assert!(number("seconds") > 0.0 && pair["strikes"].is_u64() && pair["pieces"].is_u64(), "{pair}");
        }
        assert!(pairs.iter().any(|pair| pair["front"] == true), "{trade}");
        let chosen: Vec<&Value> = pairs.iter().flat_map(|pair| pair["chosen_at"].as_array().unwrap()).collect();
        assert_eq!(chosen.len(), 3, "each tolerance has its pair: {chosen:?}");
        for (choice, tolerance) in trade["choices"].as_array().unwrap().iter().zip([0.1, 0.01, 0.001]) {
            assert_eq!(choice["tolerance"], tolerance);
            assert!(choice["reason"].is_string() && choice["plan_seconds"].is_number(), "{choice}");
        }
        for (kept, bar) in trade["kept"].as_array().unwrap().iter().zip(["map", "finite-tilt"]) {
            assert_eq!((&kept["bar"], kept["least"].as_array().unwrap().len()), (&bar.into(), 3));
        }
    }
}

#[test]
fn without_contact_time_the_reference_says_what_it_is() {
    let path = example("laptop.toml");
    let outcome = clatter(["tradeoff", path.as_str()]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    for said in ["reference  finite-tilt, impulse-train", "not the highest rung: ", "contact time", "warning: "] {
        assert!(outcome.stdout.contains(said), "{said}:\n{}", outcome.stdout);
    }
    assert!(!outcome.stdout.contains("compliant "), "{}", outcome.stdout);
}

#[test]
fn rows_and_figure_are_whole() {
    let (dir, path) = changed(|text| text.replace("\"camera\"", "\"camera, <left> & *right*\""));
    let figure = dir.path().join("trade.svg");
    let outcome = clatter(["tradeoff", &path, "-o", figure.to_str().unwrap(), "--format=csv"]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    let mut lines = outcome.stdout.lines();
    let head = "component,limit,quantity,bar,part,value,error,estimate,seconds,strikes,pieces,front,plan_tolerances";
    assert_eq!(lines.next(), Some(head));
    let rows: Vec<&str> = lines.collect();
    assert_eq!(rows.len(), 3 * 18 + 6);
    assert!(rows.iter().any(|row| row.starts_with("\"camera, <left> & *right*\",acceleration,")), "{}", outcome.stdout);
    let commas = head.matches(',').count();
    assert!(rows.iter().all(|row| row.replace("camera, <", "camera <").matches(',').count() == commas));
    let svg = fs::read_to_string(&figure).unwrap();
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{svg}");
    for said in
        ["camera, &lt;left&gt; &amp;", "display: peak acceleration", "finite tilt, impulses", "front", "plan at"]
    {
        assert!(svg.contains(said), "{said}");
    }
    let names: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|f| f.unwrap().file_name()).collect();
    assert_eq!(names.len(), 2, "the product and the figure, nothing half-written: {names:?}");
}

#[test]
fn help_has_examples_and_says_how_to_read_the_table() {
    let help = clatter(["tradeoff", "--help"]);
    assert_eq!(help.exit, Exit::Done);
    for said in ["clatter tradeoff handheld.toml -o trade.svg", "front", "estimate", "no other pair is both cheaper"] {
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
        (arguments(&["tradeoff", &path]), &["\"kg\" is no unit of length", ":10:10"]),
        (arguments(&["tradeoff", &stiff]), &["[[component]] 1 needs the contact time of the product", "318 Hz"]),
    ];
    are_refused(rows);
}
