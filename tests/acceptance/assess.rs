//! `clatter assess`, `init` and `schema`: exit codes, answers, and what is never written over.

use std::fs;
use std::path::{Path, PathBuf};

use clatter_cli::Exit;
use serde_json::Value;

use crate::{answer, clatter};

pub(crate) fn example(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reports/examples").join(name);
    path.to_str().unwrap().to_owned()
}

/// A directory with a product file made from the one of `clatter init`.
pub(crate) fn changed(change: impl Fn(String) -> String) -> (tempfile::TempDir, String) {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("product.toml");
    let written = clatter(["init", path.to_str().unwrap()]);
    assert_eq!(written.exit, Exit::Done, "{}", written.stderr);
    fs::write(&path, change(fs::read_to_string(&path).unwrap())).unwrap();
    (dir, path.to_str().unwrap().to_owned())
}

#[test]
fn what_init_writes_is_safe_as_it_stands_and_never_written_over() {
    let (dir, path) = changed(|text| text);
    let before = fs::read(&path).unwrap();
    let outcome = clatter(["assess", path.as_str()]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""), "{}", outcome.stdout);
    assert!(outcome.stdout.starts_with("Handheld is safe"), "{}", outcome.stdout);
    let again = clatter(["init", path.as_str()]);
    assert_eq!(again.exit, Exit::BadInput);
    assert!(again.stderr.contains("is there already"), "{}", again.stderr);
    assert_eq!(fs::read(&path).unwrap(), before, "untouched");
    let left: Vec<PathBuf> = fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(left, [PathBuf::from(path)], "nothing half-written is left");
}

#[test]
fn an_unsafe_component_exits_with_1_and_the_json_says_why() {
    let path = example("handheld-terminal.toml");
    let outcome = clatter(["assess", path.as_str(), "--format=json"]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Unsafe, ""));
    let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(json["product"], "Handheld terminal");
    assert_eq!(json["verdict"], "unsafe");
    let components = json["components"].as_array().unwrap();
    for component in components {
        let mut safe = true;
        for limit in component["limits"].as_array().unwrap() {
            let number = |key: &str| limit[key].as_f64().unwrap();
            let margin = number("allowed") / number("demand") - 1.0;
            assert!((margin - number("margin")).abs() <= 1e-12, "margin = allowed/demand - 1: {limit}");
            safe &= margin >= 0.0;
        }
        assert_eq!(component["verdict"], if safe { "safe" } else { "unsafe" });
        for key in ["first", "tilt_deg", "speed_m_s", "restitution", "position_m", "impact", "time_s"] {
            assert!(!component["worst_case"][key].is_null(), "{key}");
        }
        for key in ["bar", "component", "reason"] {
            assert!(component["model"][key].is_string(), "{key}");
        }
    }
    assert_eq!(components[2]["name"], "gyroscope");
    assert_eq!(components[2]["verdict"], "safe");
}

#[test]
fn two_products_stand_side_by_side() {
    let (_dir, path) = changed(|text| text.replace("1500 gn", "1400 gn").replace("\"Handheld\"", "\"Lighter\""));
    let (_other, before) = changed(|text| text);
    let outcome = clatter(["assess", before.as_str(), path.as_str()]);
    assert_eq!(outcome.exit, Exit::Unsafe, "one of both is");
    let lines: Vec<&str> = outcome.stdout.lines().collect();
    assert!(lines[0].contains("Handheld") && lines[0].ends_with("Lighter"), "{}", outcome.stdout);
    let verdicts: Vec<&str> = lines.last().unwrap().split_whitespace().collect();
    assert_eq!(verdicts, ["verdict", "safe", "UNSAFE"], "{}", outcome.stdout);
    let json: Value = serde_json::from_str(&clatter(["assess", &before, &path, "--format=json"]).stdout).unwrap();
    assert_eq!([&json[0]["verdict"], &json[1]["verdict"]], ["safe", "unsafe"]);
}

#[test]
fn bad_files_exit_with_2_and_all_their_faults_in_place() {
    let (_dir, path) = changed(|text| text.replace("140 mm", "140 kg").replace("\"either\"", "\"c\""));
    let outcome = clatter(["assess", path.as_str(), path.as_str()]);
    assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""));
    assert_eq!(outcome.stderr.matches("error: ").count(), 4, "two faults in each of two files: {}", outcome.stderr);
    for said in [format!("{path}:10:10"), format!("{path}:24:9"), "\"kg\" is no unit of length".into(), "^^^".into()] {
        assert!(outcome.stderr.contains(&said), "{said}: {}", outcome.stderr);
    }
    for unreadable in [&path.replace("product", "nothing"), Path::new(&path).parent().unwrap().to_str().unwrap()] {
        let outcome = clatter(["assess", unreadable]);
        assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""));
        assert!(outcome.stderr.starts_with("error: cannot read "), "{}", outcome.stderr);
    }
    let (_dir, binary) = changed(|text| text);
    fs::write(&binary, [0xff, 0xfe, 0x00]).unwrap();
    assert!(clatter(["assess", &binary]).stderr.contains("not text in UTF-8"), "binary");
    assert!(clatter(["assess"]).stderr.contains("PRODUCT.toml"), "no file at all");
}

#[test]
fn names_of_any_kind_keep_the_table_in_order() {
    let long = "x".repeat(100_000);
    for name in ["<b>#[*_$`", "קטן\u{202e}abc", "\\u001b[31mred", "两台相机", long.as_str()] {
        let (_dir, path) = changed(|text| text.replace("\"camera\"", &format!("\"{name}\"")));
        let outcome = clatter(["assess", path.as_str()]);
        assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
        assert!(outcome.stdout.len() < 5000, "{} bytes", outcome.stdout.len());
        assert!(!outcome.stdout.contains(['\u{1b}', '\u{202e}']), "{}", outcome.stdout);
        let json: Value = serde_json::from_str(&clatter(["assess", &path, "--format=json"]).stdout).unwrap();
        let expected = name.replace("\\u001b", "\u{1b}");
        assert_eq!(json["components"][1]["name"], expected.as_str(), "as it stands in the file");
    }
}

#[test]
fn the_schema_names_every_key_of_the_examples() {
    let schema: Value = answer_of_schema();
    for table in ["product", "drop"] {
        assert_eq!(schema["properties"][table]["additionalProperties"], false);
    }
    for name in ["phone.toml", "handheld-terminal.toml", "laptop.toml"] {
        let text = fs::read_to_string(example(name)).unwrap();
        for line in text.lines().filter(|line| !line.starts_with(['#', '[', ' ', ']']) && line.contains(" = ")) {
            let key = line.split(" = ").next().unwrap();
            let known = ["/properties/product", "/properties/drop", "/properties/component/items"]
                .iter()
                .any(|place| !schema.pointer(place).unwrap()["properties"][key].is_null());
            assert!(known, "{name}: {key}");
        }
    }
}

fn answer_of_schema() -> Value {
    let outcome = clatter(["schema"]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    serde_json::from_str(&outcome.stdout).unwrap()
}

/// The contract's own words, on a file without surprises.
#[test]
fn the_answer_is_one_object_for_one_file() {
    let (_dir, path) = changed(|text| text);
    let json = answer(["assess", path.as_str()]);
    assert_eq!(json["components"][0]["limits"][0]["limit"], "acceleration");
    assert!((json["components"][0]["position_m"].as_f64().unwrap() - 0.01).abs() < 1e-15, "SI");
}
