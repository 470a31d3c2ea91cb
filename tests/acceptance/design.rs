//! `clatter design`: goals, the paper's example, and products.

use clatter_cli::Exit;

use crate::{answer, clatter};

const LAPTOP: &str = r#"
[product]
name = "Laptop, *bold* <b> \u202E"
length = "300 mm"
radius_of_gyration = "90 mm"
restitution = [0.25, 0.4]
[drop]
height = "0.8 m"
tilt = ["0.5 deg", "1.5 deg"]
first = "either"
[[component]]
name = "panel"
position = "20 mm"
extent = "20 mm"
mount = "hard"
velocity_change_limit = "3.2 m/s"
[[component]]
name = "drive, _left_ <1>"
position = "60 mm"
natural_frequency = "40 Hz"
damping_ratio = 0.1
acceleration_limit = "140 gn"
"#;

/// A file of the test's own directory.
fn file(dir: &tempfile::TempDir, name: &str, text: &str) -> String {
    let path = dir.path().join(name);
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

/// Section 6 of the paper: (0.73, 0.2) alone has the 10 % zone that is asked for; all its suggestions keep nearly all
/// of the bar within 2 v0, and the free optimum is all mass in the center of a dead casing.
#[test]
fn the_paper_s_example_is_the_default() {
    let found = answer(["design"]);
    assert_eq!(found["goals"].as_array().unwrap().len(), 2);
    let designs = found["designs"].as_array().unwrap();
    let met: Vec<_> = designs.iter().map(|d| d["goals_met"].to_string()).collect();
    assert_eq!(met, ["[false,true]", "[true,true]", "[false,true]", "[false,true]"]);
    for design in designs {
        let largest = design["largest_at_this_e"]["s"].as_f64().unwrap();
        assert!(design["s"].as_f64().unwrap() <= largest, "no design lies above its front: {design}");
    }
    let front = &found["fronts"][0];
    assert_eq!((front["e"].as_f64(), front["largest"]["q"].as_f64()), (Some(0.0), Some(1.0)));
    assert!((front["largest"]["s"].as_f64().unwrap() - 0.25).abs() < 1e-12);
    // 0.9 q² − 0.2 q − 0.1 = 0 at e = 0: 1/(1 + q) = 1.1 − 0.9 q
    let smallest = front["smallest_q"].as_f64().unwrap();
    assert!((0.9 * smallest * smallest - 0.2 * smallest - 0.1).abs() < 1e-12, "{smallest}");
    let table = clatter(["design"]);
    assert!(table.stdout.contains("They are met with e up to 0.2127"), "{}", table.stdout);
}

#[test]
fn goals_that_nothing_meets_are_told_as_such() {
    let outcome = clatter(["design", "--zone=0.2:0.5"]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    assert!(outcome.stdout.contains("No q and e meet all of them"), "{}", outcome.stdout);
    let found = answer(["design", "--zone=1:0", "--turn=1.5"]);
    assert!(!found["region"].as_array().unwrap().is_empty(), "{found}");
}

#[test]
fn a_failing_part_gets_the_smallest_change_of_each_kind() {
    let dir = tempfile::tempdir().unwrap();
    let path = file(&dir, "laptop.toml", LAPTOP);
    let found = answer(["design", path.as_str()]);
    assert_eq!(found["verdict"], "unsafe");
    let parts = found["components"].as_array().unwrap();
    let mut changed = 0;
    for part in parts {
        let remedies = part["remedies"].as_array().unwrap();
        assert_eq!(remedies.len(), if part["verdict"] == "unsafe" { 5 } else { 0 }, "{part}");
        for remedy in remedies.iter().filter(|remedy| remedy["outcome"] == "change") {
            assert!(remedy["margin_after"].as_f64().unwrap() >= 0.0, "{remedy}");
            changed += 1;
        }
    }
    assert!(changed >= 2, "{found}");
    // Apply one by hand: the assessment of the changed file agrees.
    let place = parts[0]["remedies"].as_array().unwrap().iter().find(|r| r["lever"] == "position").unwrap();
    let to = place["to"][0].as_f64().unwrap();
    let moved = LAPTOP.replacen("position = \"20 mm\"", &format!("position = \"{to:?} m\""), 1);
    let outcome = clatter(["assess", &file(&dir, "moved.toml", &moved), "--format=json"]);
    let assessed: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(assessed["components"][0]["verdict"], "safe", "{}", outcome.stdout);
}

#[test]
fn pictures_and_tables_of_the_plane_are_written_whole() {
    let dir = tempfile::tempdir().unwrap();
    let path = file(&dir, "laptop.toml", LAPTOP);
    let target = |name: &str| dir.path().join(name).display().to_string();
    let outcome = clatter(["design", &path, "-o", &target("plane.svg")]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""), "{}", outcome.stdout);
    let svg = std::fs::read_to_string(dir.path().join("plane.svg")).unwrap();
    assert!(svg.contains("drive, _left_ &lt;1&gt;") && svg.ends_with("</svg>\n"), "{svg}");
    assert!(!outcome.stdout.contains('\u{202E}'), "a name turns the line around");
    clatter(["design", &path, "-o", &target("plane.csv"), "--format=csv"]);
    let csv = std::fs::read_to_string(dir.path().join("plane.csv")).unwrap();
    assert_eq!(csv.lines().filter(|line| line.starts_with("\"drive, _left_ <1>\"")).count(), 41 * 41);
    assert!(csv.lines().any(|line| line.starts_with("panel,1,")), "an exact border");
    let outcome = clatter(["design", "-o", &target("goals.csv"), "--front", &target("front.svg")]);
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    assert!(std::fs::read_to_string(dir.path().join("front.svg")).unwrap().contains("cannot be built"));
}
