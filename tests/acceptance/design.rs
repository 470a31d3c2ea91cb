//! `clatter design`: goals, the paper's example, and products.

use clatter_cli::Exit;
use serde_json::Value;

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
acceleration_limit = "100 gn"
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

/// The file with the value of a remedy in place of the one that it has.
fn with(remedy: &Value, position: &str, frequency: &str) -> Option<String> {
    let to = [0, 1].map(|i| remedy["to"][i].as_f64().unwrap());
    Some(match remedy["lever"].as_str().unwrap() {
        "inertia-ratio" => {
            let radius = remedy["radius_of_gyration_m"].as_f64().unwrap();
            LAPTOP.replacen("\"90 mm\"", &format!("\"{radius:?} m\""), 1)
        }
        "restitution" => LAPTOP.replacen("[0.25, 0.4]", &format!("[{:?}, {:?}]", to[0], to[1]), 1),
        "position" => LAPTOP.replacen(position, &format!("position = \"{:?} m\"", to[0]), 1),
        "natural-frequency" => LAPTOP.replacen(frequency, &format!("natural_frequency = \"{:?} Hz\"", to[0]), 1),
        "damping-ratio" => LAPTOP.replacen("damping_ratio = 0.1", &format!("damping_ratio = {:?}", to[0]), 1),
        "velocity-change-limit" => LAPTOP.replacen("\"3.2 m/s\"", &format!("\"{:?} m/s\"", to[0]), 1),
        "acceleration-limit" => LAPTOP.replacen("\"100 gn\"", &format!("\"{:?} m/s2\"", to[0]), 1),
        _ => return None,
    })
}

/// Each change that is told, written into the file as it stands: the part is then safe with the margin.
#[test]
fn a_failing_part_gets_the_smallest_change_of_each_kind() {
    let dir = tempfile::tempdir().unwrap();
    let path = file(&dir, "laptop.toml", LAPTOP);
    for (option, margin) in [("--margin=10%", 0.1), ("--margin=0.25", 0.25)] {
        let found = answer(["design", path.as_str(), option]);
        assert_eq!((&found["verdict"], &found["margin"]), (&"unsafe".into(), &margin.into()));
        let mut changed = 0;
        for (i, part) in found["components"].as_array().unwrap().iter().enumerate() {
            let enough = part["verdict"] == "safe" && part["margin"].as_f64().unwrap() >= margin;
            let remedies = part["remedies"].as_array().unwrap();
            assert_eq!(remedies.len(), if enough { 0 } else { 6 }, "{part}");
            for remedy in remedies.iter().filter(|remedy| remedy["outcome"] == "change") {
                let after = remedy["margin_after"].as_f64().unwrap();
                assert!(after >= margin, "{remedy}");
                let place = ["position = \"20 mm\"", "position = \"60 mm\""][i];
                let text = with(remedy, place, "natural_frequency = \"40 Hz\"").unwrap();
                let outcome = clatter(["assess", &file(&dir, "changed.toml", &text), "--format=json"]);
                let assessed: Value = serde_json::from_str(&outcome.stdout).unwrap();
                let then = &assessed["components"][i];
                assert_eq!(then["verdict"], "safe", "{remedy}: {then}");
                let left = then["limits"][0]["margin"].as_f64().unwrap();
                assert!(left >= margin && (left - after).abs() < 0.02 * (1.0 + after), "{left}, not {after}: {remedy}");
                changed += 1;
            }
        }
        assert!(changed >= if margin < 0.2 { 3 } else { 1 }, "{found}");
    }
}

/// The digits of the table are those of the change: what people type in is what was assessed.
#[test]
fn values_are_printed_with_all_their_digits() {
    let dir = tempfile::tempdir().unwrap();
    let path = file(&dir, "laptop.toml", LAPTOP);
    let table = clatter(["design", &path]);
    assert_eq!((table.exit, table.stderr.as_str()), (Exit::Done, ""));
    assert!(table.stdout.contains("are not safe with a margin of 10 %"), "{}", table.stdout);
    let found = answer(["design", path.as_str()]);
    let remedies = found["components"].as_array().unwrap().iter().flat_map(|part| part["remedies"].as_array().unwrap());
    for remedy in remedies.filter(|remedy| remedy["outcome"] == "change") {
        let to = remedy["to"][0].as_f64().unwrap();
        let (name, value) = match remedy["lever"].as_str().unwrap() {
            "velocity-change-limit" => ("velocity change limit", format!("-> {} m/s", short(to))),
            "acceleration-limit" => ("acceleration limit", format!("-> {} gn", short(to / 9.806_65))),
            "position" => ("place", format!("-> {} mm", short(1e3 * to))),
            "natural-frequency" => ("natural frequency", format!("-> {} Hz", short(to))),
            "inertia-ratio" => {
                let radius = short(1e3 * remedy["radius_of_gyration_m"].as_f64().unwrap());
                ("radius of gyration", format!("90 mm -> {radius} mm, q "))
            }
            "restitution" => ("restitution e", format!("-> {} to ", short(to))),
            _ => ("damping ratio", format!("-> {}", short(to))),
        };
        let told = table.stdout.lines().any(|line| line.trim_start().starts_with(name) && line.contains(&value));
        assert!(told, "{name} {value}: {}", table.stdout);
    }
}

/// As short as they are written.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.3e}").parse().unwrap();
    format!("{rounded}")
}

#[test]
fn where_no_change_alone_is_enough_two_are_or_the_nearest_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let hard = LAPTOP.replacen("100 gn", "12 gn", 1);
    // A stronger part would be enough.
    let reach = "--limit-factor=1.01";
    let found = answer(["design", &file(&dir, "hard.toml", &hard), reach]);
    let part = &found["components"][1];
    assert!(part["remedies"].as_array().unwrap().iter().all(|r| r["outcome"] != "change"), "{part}");
    let together = if part["pair"].is_null() { &part["nearest"] } else { &part["pair"] };
    let changes = together["changes"].as_array().unwrap();
    assert!((1..=2).contains(&changes.len()), "{part}");
    let better = together["margin_after"].as_f64().unwrap();
    assert!(better > part["margin"].as_f64().unwrap(), "nearer than now: {part}");
    assert_eq!(part["pair"].is_null(), better < 0.1, "{part}");
    let table = clatter(["design", &file(&dir, "hard.toml", &hard), reach]).stdout;
    assert!(table.contains("these together are:") || table.contains("nearest come:"), "{table}");
    let csv = clatter(["design", &file(&dir, "hard.toml", &hard), reach, "--format=csv"]).stdout;
    let outcome = if part["pair"].is_null() { ",nearest," } else { ",pair," };
    let of_part = csv.lines().filter(|line| line.starts_with("\"drive") && line.contains(outcome));
    assert_eq!(of_part.count(), changes.len(), "{csv}");
    let columns = csv.lines().next().unwrap().matches(',').count();
    let plain = csv.replace("drive, _left_", "drive _left_");
    assert!(plain.lines().all(|line| line.matches(',').count() == columns), "{csv}");
}

#[test]
fn pictures_and_tables_of_the_plane_are_written_whole() {
    let dir = tempfile::tempdir().unwrap();
    let target = |name: &str| dir.path().join(name).display().to_string();
    // A product whose drops are followed: margins on a grid, within what can be built.
    let path = file(&dir, "laptop.toml", LAPTOP);
    let reach = ["--q=0.45:0.5", "--e=0.3:0.4"];
    let outcome = clatter([&["design", &path, "-o", &target("plane.svg")][..], &reach].concat());
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("Plane of q and e: by the model finite-tilt"), "{}", outcome.stdout);
    let svg = std::fs::read_to_string(dir.path().join("plane.svg")).unwrap();
    assert!(svg.contains("drive, _left_ &lt;1&gt;") && svg.ends_with("</svg>\n"), "{svg}");
    assert!(svg.contains("by the model finite-tilt") && svg.contains("no answer"), "{svg}");
    assert!(!outcome.stdout.contains('\u{202E}'), "a name turns the line around");
    let found = answer([&["design", &path, "-o", &target("plane.csv")][..], &reach].concat());
    assert_eq!((&found["plane"]["model"], &found["plane"]["side"]), (&"finite-tilt".into(), &41.into()));
    let csv = std::fs::read_to_string(dir.path().join("plane.csv")).unwrap();
    let drive: Vec<&str> = csv.lines().filter_map(|line| line.strip_prefix("\"drive, _left_ <1>\",,")).collect();
    assert_eq!((drive.len(), drive.iter().filter(|line| !line.ends_with(',')).count()), (41 * 41, 3 * 5));
    // Without gravity and tilt the closed form does: the border of a velocity shock is exact.
    let free = LAPTOP.replace("height = \"0.8 m\"", "speed = \"3.96 m/s\"\ngravity = \"0 gn\"");
    let free = free.replace("[\"0.5 deg\", \"1.5 deg\"]", "[\"0.05 deg\", \"0.1 deg\"]");
    let path = file(&dir, "free.toml", &free);
    let found = answer([&["design", &path, "-o", &target("free.csv")][..], &reach].concat());
    assert_eq!(found["plane"]["model"], "map", "{}", found["plane"]);
    let csv = std::fs::read_to_string(dir.path().join("free.csv")).unwrap();
    assert_eq!(csv.lines().filter(|line| line.starts_with("\"drive, _left_ <1>\"")).count(), 41 * 41);
    let border: Vec<[f64; 2]> = csv.lines().filter_map(|line| line.strip_prefix("panel,1,")).map(pair).collect();
    assert!(border.len() > 10, "an exact border: {csv}");
    for [q, e] in border.into_iter().filter(|[q, e]| *q < 1.0 && *e > 1e-9 && *e < 1.0) {
        let bar = clatter::Bar::new(q, e).unwrap();
        let peak = bar.shocks_either(&clatter::Start::default()).at(30.0 / 150.0) * 3.96;
        assert!((peak - 3.2).abs() < 1e-12, "{peak} at {q}, {e}");
    }
    let outcome = clatter(["design", "-o", &target("goals.csv"), "--front", &target("front.svg")]);
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    assert!(std::fs::read_to_string(dir.path().join("front.svg")).unwrap().contains("cannot be built"));
}

/// The first two numbers of a row.
fn pair(row: &str) -> [f64; 2] {
    let mut cells = row.split(',').map(|cell| cell.parse().unwrap());
    [cells.next().unwrap(), cells.next().unwrap()]
}

/// Each margin of the plane is that of the product with this q and e: the assessment, which looks closer, finds hardly worse.
#[test]
fn margins_of_the_plane_are_those_of_an_assessment() {
    let dir = tempfile::tempdir().unwrap();
    for (name, side, contact) in [("instant", 41.0, ""), ("contacts", 21.0, "contact_time = \"2 ms\"")] {
        let with = |radius: &str, e: &str| {
            let text = LAPTOP.replace("\"90 mm\"", radius).replace("[0.25, 0.4]", e);
            file(&dir, "one.toml", &text.replacen("[drop]", &format!("{contact}\n[drop]"), 1))
        };
        let path = with("\"90 mm\"", "[0.25, 0.4]");
        let target = dir.path().join("plane.csv").display().to_string();
        answer(["design", &path, "-o", &target, "--q=0.5:0.55", "--e=0.3:0.35"]);
        let csv = std::fs::read_to_string(&target).unwrap();
        let rows = csv.lines().filter_map(|line| line.strip_prefix("\"drive, _left_ <1>\",,"));
        let known: Vec<&str> = rows.filter(|row| !row.ends_with(',')).collect();
        assert_eq!(known.len(), if side > 40.0 { 9 } else { 4 }, "{name}: {csv}");
        let [q, e] = pair(known[0]);
        assert!((q * (side - 1.0)).fract() < 1e-9 || (q * (side - 1.0)).fract() > 1.0 - 1e-9, "{q}");
        let margin: f64 = known[0].rsplit(',').next().unwrap().parse().unwrap();
        // q = (L² − ρ²)/(L² + ρ²) with L = 150 mm.
        let radius = format!("\"{:?} mm\"", 150.0 * ((1.0 - q) / (1.0 + q)).sqrt());
        let outcome = clatter(["assess", &with(&radius, &format!("{e:?}")), "--format=json"]);
        let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
        let assessed = json["components"][1]["limits"][0]["margin"].as_f64().unwrap();
        let worse = (1.0 + margin) / (1.0 + assessed);
        assert!((0.98..1.03).contains(&worse), "{name}: {margin} in the plane, {assessed} assessed at {q}, {e}");
    }
}

/// A box: the change that is printed holds in all of its drops.
#[test]
fn a_change_of_a_box_holds_in_its_drops() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("box.toml");
    let text = "[product]\nname = \"Box\"\nlength = \"150 mm\"\nwidth = \"70 mm\"\nthickness = \"40 mm\"\nmass = \"300 g\"\n\
                radius_of_gyration = [\"43 mm\", \"20 mm\"]\nrestitution = 0.2\ncontact_time = \"0.4 ms\"\n\
                contact_law = \"hysteretic\"\n[drop]\nheight = \"1 m\"\nface = \"bottom\"\n[[component]]\nname = \"battery\"\n\
                position = [\"30 mm\", \"10 mm\"]\nnatural_frequency = \"120 Hz\"\ndamping_ratio = 0.1\nrattle_space = \"6 mm\"\n";
    std::fs::write(&path, text).unwrap();
    let path = path.to_str().unwrap();
    let found = answer(["design", path, "--margin=5%"]);
    let remedies = found["components"][0]["remedies"].as_array().unwrap();
    let room = remedies.iter().find(|remedy| remedy["lever"] == "rattle-space").unwrap();
    assert_eq!(room["outcome"], "change", "{found}");
    let to = 1e3 * room["to"][0].as_f64().unwrap();
    std::fs::write(path, text.replace("6 mm\"", &format!("{to:.6} mm\""))).unwrap();
    let outcome = clatter(["assess", path, "--format=json"]);
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stdout);
    let after: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(after["components"][0]["limits"][0]["margin"], room["margin_after"], "{room}");
    assert!(clatter(["design", path]).stdout.starts_with("Box: a box, e = 0.2"));
}

/// How far an edge gives for a contact time τ, by the half-sine of the hysteretic law: 2 v τ/(π (1 + e)), most for the fastest drop and the
/// least restitution.
#[test]
fn a_longer_contact_is_told_as_an_edge_that_gives() {
    let dir = tempfile::tempdir().unwrap();
    let text = r#"
[product]
name = "bar"
length = "150 mm"
radius_of_gyration = "43 mm"
restitution = [0.1, 0.5]
contact_time = "0.3 ms"
contact_law = "hysteretic"
[drop]
height = ["0.2 m", "0.8 m"]
tilt = "3 deg"
[[component]]
name = "part"
position = "30 mm"
mount = "hard"
acceleration_limit = "1500 gn"
"#;
    let table = clatter(["design", &file(&dir, "bar.toml", text)]).stdout;
    let line =
        table.lines().find(|line| line.contains(", an edge that gives by ")).unwrap_or_else(|| panic!("{table}"));
    let (before, after) = line.split_once(" ms, an edge that gives by ").unwrap();
    let number = |text: &str| text.parse::<f64>().unwrap();
    let time_s = 1e-3 * number(before.rsplit(' ').next().unwrap());
    let gives_m = 1e-3 * number(after.split(' ').next().unwrap());
    let want = 2.0 * (2.0 * 9.806_65 * 0.8_f64).sqrt() * time_s / (std::f64::consts::PI * 1.1);
    // Told to two digits.
    assert!((gives_m / want - 1.0).abs() < 0.05, "{line}: {want}");
}
