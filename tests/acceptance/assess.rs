//! `clatter assess`, `init` and `schema`: exit codes, answers, and what is never written over.

use std::fs;
use std::path::{Path, PathBuf};

use clatter_cli::Exit;
use serde_json::Value;

use crate::{answer, clatter};

/// A worked product, or one of the bars that tests are about.
pub(crate) fn example(name: &str) -> String {
    let folder = if name.starts_with("bar-") { "cases" } else { "../reports/examples" };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder).join(name);
    path.to_str().unwrap().to_owned()
}

/// A directory with a product file made from that of a bar.
pub(crate) fn changed(change: impl Fn(String) -> String) -> (tempfile::TempDir, String) {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("product.toml");
    fs::write(&path, change(fs::read_to_string(example("bar-handheld.toml")).unwrap())).unwrap();
    (dir, path.to_str().unwrap().to_owned())
}

/// The limit of the display, the first of the file.
fn display_limit(text: &str, limit: &str) -> String {
    let (before, rest) = text.split_once("acceleration_limit = \"").unwrap();
    let (_, after) = rest.split_once('"').unwrap();
    format!("{before}acceleration_limit = \"{limit}\"{after}")
}

#[test]
fn what_init_writes_is_safe_as_it_stands_and_never_written_over() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("product.toml").to_str().unwrap().to_owned();
    assert_eq!(clatter(["init", path.as_str()]).exit, Exit::Done);
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
    let path = example("bar-terminal.toml");
    let outcome = clatter(["assess", path.as_str(), "--format=json"]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Unsafe, ""));
    let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(json["product"], "Handheld terminal");
    assert_eq!(json["verdict"], "unsafe");
    let components = json["components"].as_array().unwrap();
    for component in components {
        let mut worst = "safe";
        for limit in component["limits"].as_array().unwrap() {
            let number = |key: &str| limit[key].as_f64().unwrap();
            let margin = number("allowed") / number("demand") - 1.0;
            assert!((margin - number("margin")).abs() <= 1e-12, "margin = allowed/demand - 1: {limit}");
            worst = match (worst, limit["verdict"].as_str().unwrap()) {
                ("unsafe", _) | (_, "unsafe") => "unsafe",
                ("undecided", _) | (_, "undecided") => "undecided",
                _ => "safe",
            };
            assert!(limit["verdict"] != "safe" || margin >= 0.0, "{limit}");
            assert!(limit["verdict"] != "unsafe" || margin < 0.0, "{limit}");
            assert_eq!(limit["undecided"].is_string(), limit["verdict"] == "undecided", "{limit}");
            assert!(limit["bound"].as_f64().is_none_or(|bound| number("demand") <= bound), "{limit}");
            for key in ["limit", "unit", "uncertainty", "clatter_free", "other_law", "notes", "worst_case", "model"] {
                assert!(limit.get(key).is_some(), "{key}: {limit}");
            }
        }
        assert_eq!(component["verdict"], worst);
        for key in ["first", "tilt_deg", "speed_m_s", "restitution", "position_m", "impact", "time_s", "command"] {
            assert!(!component["worst_case"][key].is_null(), "{key}");
        }
        for key in ["bar", "component", "reason"] {
            assert!(component["model"][key].is_string(), "{key}");
        }
    }
    assert_eq!(components[2]["name"], "gyroscope");
    assert_eq!(components[2]["verdict"], "safe");
}

/// A part that exceeds its rattle space hits its stop, which no suspension knows.
#[test]
fn what_is_undecided_exits_with_1_and_says_why() {
    let (_dir, path) = changed(|text| text.replace("rattle_space = \"8 mm\"", "rattle_space = \"0.5 mm\""));
    let outcome = clatter(["assess", &path, "--format=json"]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Unsafe, ""));
    let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let [acceleration, rattle] = [0, 1].map(|i| &json["components"][0]["limits"][i]);
    assert_eq!((&acceleration["verdict"], &rattle["verdict"]), (&"undecided".into(), &"unsafe".into()));
    assert!(acceleration["undecided"].as_str().unwrap().contains("hits its stop"), "{acceleration}");
    // Nothing is answered: the weight alone would let the ends sink in.
    let (_dir, path) = changed(|text| text.replace("0.4 ms", "40 ms"));
    let outcome = clatter(["assess", &path]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Unsafe, ""));
    assert!(outcome.stdout.starts_with("Handheld is undecided: 3 of 3 components, as a bar; "), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("display, acceleration: no drop is answered\n  undecided: "), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("contact time 40 ms: at most 11.9 ms here"), "{}", outcome.stdout);
    let json: Value = serde_json::from_str(&clatter(["assess", &path, "--format=json"]).stdout).unwrap();
    assert_eq!(json["verdict"], "undecided");
}

/// A product without width is a bar, which the first line and the JSON say; a plate is what its file says. The law is named or not.
#[test]
fn what_the_file_does_not_state_is_told() {
    let told = "as a bar; if it is wider than a quarter of its length, give `width`: up to 30 % more";
    let said = |path: &str| {
        let table = clatter(["assess", path]).stdout;
        let first = table.split("\n\n").next().unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
        let json: Value = serde_json::from_str(&clatter(["assess", path, "--format=json"]).stdout).unwrap();
        let inputs: Vec<String> =
            json["assumed"].as_array().unwrap().iter().map(|one| one["input"].as_str().unwrap().to_owned()).collect();
        (first, inputs, json)
    };
    let (_dir, bar) = changed(|text| text);
    let (first, inputs, json) = said(&bar);
    assert_eq!(first, format!("Handheld is safe: every limit holds in the worst drop, {told}"));
    assert_eq!(inputs, ["body", "law"]);
    assert_eq!(json["assumed"][0]["taken"], "bar");
    assert_eq!(format!("as a bar; {}", json["assumed"][0]["why"].as_str().unwrap()), told);
    let (_dir, named) = changed(|text| text.replace("# contact_law", "contact_law"));
    assert_eq!(said(&named).1, ["body"]);
    let (first, inputs, _) = said(&example("handheld-terminal.toml"));
    assert_eq!((first.contains("as a bar"), inputs), (false, vec!["law".to_owned()]));
    // Beside one another each says it for itself.
    let both = clatter(["assess", &bar, &example("handheld-terminal.toml")]).stdout;
    let both = both.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(both.matches("as a bar").count(), 1, "{both}");
    assert!(both.contains(&format!("Handheld: {told}")), "{both}");
    // By instant impacts there is no law.
    let json: Value = serde_json::from_str(&clatter(["assess", &bar, "--model=map", "--format=json"]).stdout).unwrap();
    assert_eq!(json["assumed"].as_array().unwrap().len(), 1, "{}", json["assumed"]);
}

/// No worked product is left to be taken as a bar.
#[test]
fn every_worked_product_has_a_width() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reports/examples");
    for file in fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        let product =
            clatter_product::ProductFile::read(&fs::read_to_string(&path).unwrap(), "worked").unwrap().product;
        assert!(product.body.is_wide(), "{}", path.display());
    }
    let init = clatter_product::ProductFile::read(clatter_product::EXAMPLE, "init").unwrap();
    assert!(init.product.body.is_wide());
}

/// The words of a command as a shell takes them apart, without its name.
fn words(command: &str) -> Vec<&str> {
    command.split_whitespace().skip(1).collect()
}

/// What the drop of a worst case says once more, as data, changed where it is to be.
fn again(worst: &Value, change: impl FnOnce(&mut Value)) -> Value {
    let (dir, mut data) = (tempfile::tempdir().unwrap(), worst["drop"].clone());
    change(&mut data["drop"]);
    let path = dir.path().join("drop.json");
    fs::write(&path, data.to_string()).unwrap();
    answer(["respond", &format!("--drop={}", path.display())])
}

/// What a drop that repeats a worst one says of the limit.
pub(crate) fn repeated(limit: &Value) -> f64 {
    let got = again(&limit["worst_case"], |_| ());
    let of = |key: &str| got[key].as_f64().unwrap_or_else(|| panic!("{key} of {got}"));
    match (limit["limit"].as_str().unwrap(), limit["unit"].as_str().unwrap(), got.get("omega").is_some()) {
        ("acceleration", _, true) => of("omega") * of("peak_absolute_acceleration_over_omega"),
        ("rattle-space", _, true) => of("omega_peak_relative_displacement") / of("omega"),
        ("angular-velocity-change", ..) => of("angular_velocity_change_rad_s"),
        ("acceleration" | "damage-boundary", "m/s2", _) => of("acceleration_m_s2"),
        ("velocity-change" | "damage-boundary", "m/s", _) => of("velocity_change_m_s"),
        other => panic!("{other:?} is not repeated"),
    }
}

/// Of a bar and a plate on feet, with parts beyond them, all feet alike or one with a contact of its own.
#[test]
fn the_command_below_a_worst_drop_on_feet_says_the_same() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("feet.toml").display().to_string();
    let bar = r#"
product = { name = "laptop", length = "300 mm", radius_of_gyration = "85 mm", restitution = [0.2, 0.3], contact_time = "1 ms", feet_inset = "30 mm", feet_height = "20 mm" }
drop = { height = "0.5 m", tilt = ["1 deg", "8 deg"] }
component = [
    { name = "drive", position = "-140 mm", natural_frequency = "90 Hz", damping_ratio = 0.15, acceleration_limit = "900 gn" },
    { name = "hinge", position = "145 mm", extent = "10 mm", mount = "hard", velocity_change_limit = "20 m/s" },
]
"#;
    let plate = bar
        .replace("\"300 mm\"", "\"300 mm\", width = \"210 mm\"")
        .replace("\"85 mm\"", "[\"85 mm\", \"60 mm\"]")
        .replace("\"30 mm\"", "[\"30 mm\", \"20 mm\"]")
        .replace("\"-140 mm\"", "[\"-140 mm\", \"100 mm\"]")
        .replace("\"145 mm\"", "[\"145 mm\", \"0 mm\"]")
        .replace("\"10 mm\"", "[\"10 mm\", \"200 mm\"]");
    let soft = |text: &str, at: &str| {
        let own = format!("contacts = [{{ at = \"{at}\", restitution = 0.05, contact_time = \"2 ms\" }}]");
        text.replace("\"1 ms\"", &format!("\"1 ms\", contact_law = \"hysteretic\", {own}"))
    };
    for text in [bar, &plate, &soft(bar, "b"), &soft(&plate, "c")] {
        fs::write(&path, text).unwrap();
        let outcome = clatter(["assess", &path, "--format=json"]);
        let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
        for component in json["components"].as_array().unwrap() {
            let limit = &component["limits"][0];
            let (demand, again) = (limit["demand"].as_f64().unwrap(), repeated(limit));
            assert!((again / demand - 1.0).abs() < 1e-9, "{again}, not {limit}");
            let name = component["name"].as_str().unwrap();
            let short = format!("--component={name}");
            let product = format!("--product={path}");
            let short = clatter(["respond", &product, &short, "--worst", "--format=json"]);
            let short: Value = serde_json::from_str(&short.stdout).unwrap();
            let again = short["limits"][0]["value"].as_f64().unwrap();
            assert!((again / demand - 1.0).abs() < 1e-6, "{again}, not {limit}");
        }
        // Beyond the edge, and on feet so low that the edge touches.
        let beyond = clatter([
            "respond",
            &format!("--product={path}"),
            &format!("--at=151mm{}", if text.contains("width") { ",0mm" } else { "" }),
        ]);
        assert!(beyond.stderr.contains("beyond the ends: allowed is up to 150 mm"), "{}", beyond.stderr);
    }
    let pushed = |feet: &str| {
        let outcome = clatter([
            "respond",
            "--model=compliant",
            "--length=240mm",
            "--gyration=85mm",
            "--e=0.3",
            "--speed=3m/s",
            "--tilt=2deg",
            "--at=0mm",
            "--contact-time=1ms",
            "--format=json",
            feet,
        ]);
        let answer: Value = serde_json::from_str(&outcome.stdout).expect(&outcome.stderr);
        answer["acceleration_m_s2"].as_f64().unwrap()
    };
    // An end that comes down beyond low feet pushes too.
    let (low, high) = (pushed("--feet-m=0.03,0,0.0015"), pushed("--feet-m=0.03,0,0.02"));
    assert!(low > 1.1 * high, "{low}, {high}");
}

/// Of a plate whose masses lie askew.
#[test]
fn the_command_below_a_worst_drop_of_a_plate_says_the_same() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("plate.toml").display().to_string();
    // Beyond 10 degrees the command warns of the plate's small tilt.
    let text = fs::read_to_string(example("handheld-terminal.toml")).unwrap().replace("12 deg", "9 deg");
    fs::write(&path, text).unwrap();
    let outcome = clatter(["assess", &path, "--format=json"]);
    let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let components = json["components"].as_array().unwrap();
    assert_eq!(components[2]["position_m"], serde_json::json!([-0.02, -0.025]));
    let limits: Vec<&Value> = components.iter().flat_map(|c| c["limits"].as_array().unwrap()).collect();
    assert_eq!(limits.len(), 4);
    for limit in limits {
        let (demand, again) = (limit["demand"].as_f64().unwrap(), repeated(limit));
        assert!((again / demand - 1.0).abs() < 1e-9, "{again}, not {limit}");
        let worst = &limit["worst_case"];
        assert!(worst["drop"]["drop"]["body"]["products_m2"][0].as_f64().is_some_and(|of| of != 0.0), "{worst}");
        assert!((0.0..360.0).contains(&worst["direction_deg"].as_f64().unwrap()), "{worst}");
        assert!(worst["position_m"].as_array().is_some_and(|at| at.len() == 2), "{worst}");
        assert!(limit["notes"].to_string().contains("a box 25 mm thick with full rotation"), "{limit}");
    }
    // The short command below it searches the same drop, and tells its limit as the assessment does.
    let table = clatter(["assess", &path]).stdout;
    let short: Vec<&str> = table.lines().filter(|line| line.starts_with("  clatter respond --product=")).collect();
    assert_eq!(short.len(), 4, "{table}");
    for (limit, command) in components.iter().flat_map(|c| c["limits"].as_array().unwrap()).zip(short) {
        let command = command.replace("'scan engine'", "scan~engine");
        let words: Vec<_> = words(&command).into_iter().map(|word| word.replace('~', " ")).collect();
        let told = clatter(words.iter().map(String::as_str).chain(["--format=json"]));
        let got: Value = serde_json::from_str(&told.stdout).unwrap();
        assert!(told.stderr.contains("the worst drop of its ranges, for the"), "{}", told.stderr);
        let limits = got["limits"].as_array().unwrap();
        let again = limits.iter().find(|other| other["limit"] == limit["limit"]).unwrap();
        let off = again["value"].as_f64().unwrap() / limit["demand"].as_f64().unwrap() - 1.0;
        assert!(off.abs() < 1e-6, "{again}, not {limit}");
        // Of a turn every place says the same.
        if limit["limit"] != "angular-velocity-change" {
            let [of, told] =
                [again, &limit["worst_case"]].map(|of| [0, 1].map(|i| of["position_m"][i].as_f64().unwrap()));
            assert!((of[0] - told[0]).abs() + (of[1] - told[1]).abs() < 1e-9, "{again}, not {limit}");
        }
    }
    let wrong = clatter(["assess", &path, "--model=map"]);
    assert_eq!(wrong.exit, Exit::BadInput);
    assert!(wrong.stderr.contains("a plate is followed by the model compliant, not by map"), "{}", wrong.stderr);
}

/// Of products that turn as they land, a bar with end b first, a plate and a box: the long command and the short one answer the same drop.
#[test]
fn the_commands_below_a_worst_drop_that_turns_say_the_same() {
    let dir = tempfile::tempdir().unwrap();
    let hard = "mount = \"hard\", acceleration_limit = \"9e6 gn\"";
    for (name, product, drop, position) in [
        (
            "bar",
            "radius_of_gyration = \"40 mm\", center_of_mass = \"9 mm\"",
            "tilt = [\"1 deg\", \"8 deg\"], first = \"b\"",
            "\"20 mm\"",
        ),
        (
            "plate",
            "width = \"90 mm\", radius_of_gyration = [\"40 mm\", \"27 mm\"]",
            "tilt = [\"1 deg\", \"8 deg\"], direction = \"200 deg\"",
            "[\"20 mm\", \"9 mm\"]",
        ),
        (
            "box",
            "width = \"90 mm\", thickness = \"30 mm\", radius_of_gyration = [\"40 mm\", \"27 mm\"]",
            "edge = \"bottom front\"",
            "[\"20 mm\", \"9 mm\"]",
        ),
    ] {
        let path = dir.path().join(format!("{name}.toml")).display().to_string();
        let text = format!(
            "product = {{ name = \"{name}\", length = \"150 mm\", {product}, restitution = [0.2, 0.4], contact_time = \"0.5 ms\", contact_law = \"hysteretic\" }}\n\
             drop = {{ speed = \"3 m/s\", {drop}, spin = [\"-300 deg/s\", \"9 rad/s\"] }}\n\
             component = [{{ name = \"part\", position = {position}, {hard} }}]\n"
        );
        fs::write(&path, text).unwrap();
        let json: Value = serde_json::from_str(&clatter(["assess", &path, "--format=json"]).stdout).unwrap();
        let limit = &json["components"][0]["limits"][0];
        let (worst, demand) = (&limit["worst_case"], limit["demand"].as_f64().unwrap());
        let spin = worst["spin_rad_s"].as_f64().unwrap_or_else(|| panic!("{name}: no spin of {worst}"));
        assert!((-5.236..=9.0).contains(&spin), "{name}: {worst}");
        let again = again(worst, |_| ())["acceleration_m_s2"].as_f64().unwrap();
        assert!((again / demand - 1.0).abs() < 1e-9, "{name}: {again}, not {limit}");
        let table = clatter(["assess", &path]).stdout;
        assert!(table.contains(", turning at "), "{name}: {table}");
        let short = clatter(["respond", &format!("--product={path}"), "--component=part", "--worst", "--format=json"]);
        assert!(short.stderr.contains(", turning at "), "{name}: {}", short.stderr);
        let short: Value = serde_json::from_str(&short.stdout).unwrap();
        let value = short["limits"][0]["value"].as_f64().unwrap();
        assert!((value / demand - 1.0).abs() < 1e-6, "{name}: {short}, not {limit}");
    }
    // One drop of the ranges is taken with the middle of them, and told.
    let bar = format!("--product={}", dir.path().join("bar.toml").display());
    let one = clatter(["simulate", &bar, "--component=part"]);
    assert!(one.stderr.contains("spin = "), "{}", one.stderr);
    assert!(one.stdout.contains(", turning at "), "{}", one.stdout);
    // A fit finds how it turned by itself.
    let strikes = dir.path().join("strikes.csv").display().to_string();
    fs::write(&strikes, "time_s,end\n0,b\n0.002,a\n0.004,b\n0.005,a\n").unwrap();
    let fitted = clatter(["fit", &bar, &strikes]);
    assert!(fitted.stderr.contains("takes a drop without `spin`"), "{}", fitted.stderr);
}

/// Of a box whose masses lie askew, through the drops of a standard.
#[test]
fn the_command_below_a_worst_drop_of_a_box_says_the_same() {
    let outcome = clatter(["assess", &example("handheld-transit.toml"), "--format=json"]);
    let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(json["landings"].as_array().unwrap().len(), 26);
    for component in json["components"].as_array().unwrap() {
        let limit = &component["limits"][0];
        let (worst, demand) = (&limit["worst_case"], limit["demand"].as_f64().unwrap());
        assert!(worst["landing"].as_str().is_some_and(|on| on.contains(' ')), "{worst}");
        assert!(worst["drop"]["drop"]["body"]["products_m2"][0].as_f64().is_some_and(|of| of != 0.0), "{worst}");
        let again = again(worst, |_| ());
        let again = match again["omega_peak_relative_displacement"].as_f64() {
            Some(peak) => peak / again["omega"].as_f64().unwrap(),
            None => again["acceleration_m_s2"].as_f64().unwrap(),
        };
        assert!((again / demand - 1.0).abs() < 1e-9, "{again}, not {limit}");
        let governs = json["landings"].as_array().unwrap().iter().find(|on| on["landing"] == worst["landing"]).unwrap();
        let asked = governs["limits"].as_array().unwrap().iter().find(|l| l["component"] == component["name"]).unwrap();
        assert_eq!(asked["demand"], limit["demand"], "{governs}");
    }
    // The short command below it searches the same drop, and tells its limit as the assessment does.
    let table = clatter(["assess", &example("handheld-transit.toml")]).stdout;
    let battery = table.lines().find(|line| line.contains("--component=battery --worst=rattle-space")).expect(&table);
    let short = clatter(words(battery.trim_start()).into_iter().chain(["--format=json"]));
    let short: Value = serde_json::from_str(&short.stdout).unwrap();
    let (of, told) = (&json["components"][1]["limits"][0], &short["limits"][0]);
    assert_eq!((&told["limit"], &told["allowed"]), (&of["limit"], &of["allowed"]));
    let off = told["value"].as_f64().unwrap() / of["demand"].as_f64().unwrap() - 1.0;
    assert!(off.abs() < 1e-9 && told["position_m"] == of["worst_case"]["position_m"], "{told}, not {of}");
    let another =
        clatter(["respond", &format!("--product={}", example("handheld-transit.toml")), "--component=battery"]);
    assert!(another.stderr.contains("'clatter respond --worst' takes its worst drop"), "{}", another.stderr);
    let axes = [0, 1, 2].map(|k| json["components"][k]["worst_case"]["axis"].as_str().unwrap());
    assert_eq!(axes, ["z", "x", "any"]);
    let words = table.split_whitespace().collect::<Vec<_>>().join(" ");
    for said in ["95.00, 15.00 mm, along z, ", "-60.00, -10.00 mm, along x, ", "80.00, 25.00 mm, along the blow; "] {
        assert!(words.contains(said), "{said}: {table}");
    }
    for word in ["table 516.8-IX", "corner top back end-b", "off, deg"] {
        assert!(table.contains(word), "{word}: {table}");
    }
}

/// So it does of a box with a soft corner, and both say so.
#[test]
fn the_command_below_a_worst_drop_has_the_contacts_of_a_box() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("box.toml");
    let text = "product = { name = \"box\", length = \"150 mm\", width = \"70 mm\", thickness = \"14 mm\", \
                radius_of_gyration = [\"43 mm\", \"20 mm\"], restitution = 0.3, contact_time = \"0.4 ms\", \
                contact_law = \"hysteretic\", contacts = [{ at = \"b\", contact_time = \"1.2 ms\" }] }\n\
                drop = { height = \"1 m\", corner = \"bottom front end-b\" }\n\
                component = [{ name = \"chip\", position = [\"70 mm\", \"-30 mm\"], axis = \"any\", mount = \"hard\", \
                acceleration_limit = \"9000 gn\" }]\n";
    fs::write(&path, text).unwrap();
    let path = path.to_str().unwrap();
    let json: Value = serde_json::from_str(&clatter(["assess", path, "--format=json"]).stdout).unwrap();
    let limit = &json["components"][0]["limits"][0];
    let again = again(&limit["worst_case"], |_| ());
    let off = again["acceleration_m_s2"].as_f64().unwrap() / limit["demand"].as_f64().unwrap() - 1.0;
    assert!(off.abs() < 1e-9, "{again}, not {limit}");
    let own = &limit["worst_case"]["contacts"][0];
    assert_eq!((&own["at"], &own["contact_time_s"]), (&"b".into(), &1.2e-3.into()), "{limit}");
    let table = clatter(["respond", &format!("--product={path}"), "--component=chip", "--worst"]).stdout;
    assert!(table.contains("Contacts of 0.4 ms, hysteretic; at b e = 0.3 and 1.2 ms"), "{table}");
}

/// Drops of a bar beside one another: each has its row, the worst its number and a command that says the same; one drop of a list is not asked for
/// without saying which.
#[test]
fn several_drops_of_a_bar_are_told_one_by_one() {
    let (_dir, path) = changed(|text| {
        text.replace("[drop]\n", "[[drop]]\nspeed = \"2 m/s\"\ntilt = \"3 deg\"\nfirst = \"b\"\n[[drop]]\n")
    });
    let json: Value = serde_json::from_str(&clatter(["assess", &path, "--format=json"]).stdout).unwrap();
    let landings = json["landings"].as_array().unwrap();
    let named: Vec<_> = landings.iter().map(|one| one["landing"].as_str().unwrap()).collect();
    assert_eq!(named, ["drop 1", "drop 2"]);
    for (one, tilts) in landings.iter().zip([[3.0, 3.0], [1.0, 10.0]]) {
        let off = |k: usize| (one["tilt_deg"][k].as_f64().unwrap() - tilts[k]).abs();
        assert!(off(0) < 1e-9 && off(1) < 1e-9 && one["tolerance_deg"].is_null(), "{one}");
    }
    let worst = &json["components"][0]["limits"][0];
    assert_eq!(worst["worst_case"]["landing"], "drop 2");
    assert!((repeated(worst) / worst["demand"].as_f64().unwrap() - 1.0).abs() < 1e-9, "{worst}");
    let table = clatter(["assess", &path]).stdout;
    for said in ["drop 1, 2.000 m/s", "1 to 10", "display, acceleration: drop 2, "] {
        assert!(table.contains(said), "{said}: {table}");
    }
    let one = clatter(["simulate", &format!("--product={path}")]);
    assert!(one.exit == Exit::BadInput && one.stderr.contains("lists several drops"), "{}", one.stderr);
}

#[test]
fn the_command_below_a_worst_drop_says_the_same() {
    let (_dir, path) = changed(|text| text);
    let examples = ["bar-phone.toml", "bar-terminal.toml", "bar-laptop.toml"].map(example);
    let mut count = 0;
    for path in examples.iter().chain([&path]) {
        for model in ["", "--model=map", "--model=ballistic", "--model=finite-tilt"] {
            let option = if model.is_empty() { "--tolerance=1%" } else { model };
            let outcome = clatter(["assess", path, option, "--format=json"]);
            let json: Value = serde_json::from_str(&outcome.stdout).unwrap();
            for limit in json["components"].as_array().unwrap().iter().flat_map(|c| c["limits"].as_array().unwrap()) {
                let (demand, again) = (limit["demand"].as_f64().unwrap(), repeated(limit));
                assert!((again / demand - 1.0).abs() < 1e-9, "{path} {model}: {again}, not {limit}");
                count += 1;
            }
        }
    }
    assert!(count > 50, "{count}");
    // A part that reaches to the very end, which roundings miss: 2 · (29.85 + 0.65) mm/61 mm.
    let to_the_end = |text: String| {
        let text = text.replace("\"140 mm\"", "\"61 mm\"").replace("\"38 mm\"", "\"17 mm\"");
        text.replace("\"10 mm\"", "\"29.85 mm\"").replace("\"80 mm\"", "\"1.3 mm\"").replace("\"55 mm\"", "\"25 mm\"")
    };
    let (_end, at_end) = changed(to_the_end);
    let json: Value = serde_json::from_str(&clatter(["assess", &at_end, "--format=json"]).stdout).unwrap();
    let limit = &json["components"][0]["limits"][0];
    let position_m = limit["worst_case"]["position_m"].as_f64().unwrap();
    assert!((position_m - 0.0305).abs() < 1e-15, "{limit}");
    assert!((repeated(limit) / limit["demand"].as_f64().unwrap() - 1.0).abs() < 1e-9, "{limit}");
    let table = clatter(["assess", &path]).stdout;
    assert_eq!(table.matches("\n  clatter respond --product=").count(), 5, "{table}");
}

/// A damage boundary whose acceleration leaves more room: what is told beside the demand has its unit.
#[test]
fn what_stands_beside_a_demand_has_its_unit() {
    let (_dir, path) = changed(|text| text);
    let json: Value = serde_json::from_str(&clatter(["assess", &path, "--format=json"]).stdout).unwrap();
    let limit = &json["components"][2]["limits"][0];
    let of = |key: &str| limit[key].as_f64().unwrap_or_else(|| panic!("{key} of {limit}"));
    assert_eq!((&limit["limit"], &limit["unit"]), (&"damage-boundary".into(), &"m/s2".into()));
    // Flat, both ends at once: the same drop without tilt.
    let flat = again(&limit["worst_case"], |drop| drop["tilt_rad"] = 0.0.into());
    let flat = flat["acceleration_m_s2"].as_f64().unwrap();
    assert!((of("clatter_free") / flat - 1.0).abs() < 1e-9, "{limit}");
    // By the other law what the worst drop of all asks, which is no less than that of this drop.
    for (component, key) in [(2, "acceleration_m_s2"), (1, "angular_velocity_change_rad_s")] {
        let limits = json["components"][component]["limits"].as_array().unwrap();
        let limit = limits.last().unwrap();
        let other = again(&limit["worst_case"], |drop| drop["contact_law"] = "dashpot".into());
        let other = other[key].as_f64().unwrap();
        assert!(limit["other_law"].as_f64().unwrap() > 0.99 * other, "{other}: {limit}");
    }
    let table = clatter(["assess", &path]).stdout;
    // Columns that the table has no room for follow below.
    let row: Vec<&str> = table.lines().filter(|line| line.starts_with("crystal ")).collect();
    let row = row.join(" ");
    assert!(row.matches(" gn").count() == 4 && !row.contains("m/s"), "{row}");
}

#[test]
fn the_table_names_bound_accuracy_and_the_other_law() {
    let outcome = clatter(["assess", &example("bar-phone.toml")]);
    let table = &outcome.stdout;
    for said in
        ["Phone is UNSAFE: 1 of 3 components", "bound by energy", "other law", "good to", "by the model compliant"]
    {
        assert!(table.contains(said), "{said}:\n{table}");
    }
    let outcome = clatter(["assess", &example("bar-phone.toml"), "--model=map"]);
    assert!(outcome.stdout.contains("note: map was asked for; compliant says "), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("by the model map"), "{}", outcome.stdout);
}

#[test]
fn two_products_stand_side_by_side() {
    let (_dir, path) = changed(|text| display_limit(&text, "1400 gn").replace("\"Handheld\"", "\"Lighter\""));
    let (_other, before) = changed(|text| display_limit(&text, "1700 gn"));
    let outcome = clatter(["assess", before.as_str(), path.as_str()]);
    assert_eq!(outcome.exit, Exit::Unsafe, "one of both is");
    let lines: Vec<&str> = outcome.stdout.lines().collect();
    assert!(lines[0].contains("Handheld") && lines[0].ends_with("Lighter"), "{}", outcome.stdout);
    let verdicts = lines.iter().find(|line| line.trim_start().starts_with("verdict")).unwrap();
    let verdicts: Vec<&str> = verdicts.split_whitespace().collect();
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
    for said in [format!("{path}:11:10"), format!("{path}:39:9"), "\"kg\" is no unit of length".into(), "^^^".into()] {
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
        let renamed = |text: String| text.replace("\"camera\"", &format!("\"{name}\""));
        let (_dir, path) = changed(|text| display_limit(&renamed(text), "1700 gn"));
        let outcome = clatter(["assess", path.as_str()]);
        assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
        assert!(outcome.stdout.len() < 6000, "{} bytes", outcome.stdout.len());
        assert!(!outcome.stdout.contains(['\u{1b}', '\u{202e}']), "{}", outcome.stdout);
        let json: Value = serde_json::from_str(&clatter(["assess", &path, "--format=json"]).stdout).unwrap();
        let expected = name.replace("\\u001b", "\u{1b}");
        assert_eq!(json["components"][1]["name"], expected.as_str(), "as it stands in the file");
    }
}

/// A bar whose limit leaves its worst drop so little room that no search decides it.
fn close_call() -> (tempfile::TempDir, String) {
    let text = |limit: &str| {
        format!(
            "[product]\nname = \"bar\"\nlength = \"150 mm\"\nradius_of_gyration = \"45 mm\"\nrestitution = 0.3\ncontact_time = \"0.5 ms\"\n\
             contact_law = \"hysteretic\"\n[drop]\nheight = \"1 m\"\ntilt = [\"1 deg\", \"6 deg\"]\n[[component]]\nname = \"part\"\n\
             position = \"40 mm\"\nnatural_frequency = \"90 Hz\"\ndamping_ratio = 0.05\nacceleration_limit = \"{limit}\"\n"
        )
    };
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("product.toml");
    fs::write(&path, text("9000 gn")).unwrap();
    let path_text = path.to_str().unwrap().to_owned();
    let json: Value = serde_json::from_str(&clatter(["assess", &path_text, "--format=json"]).stdout).unwrap();
    let demand = json["components"][0]["limits"][0]["demand"].as_f64().unwrap();
    fs::write(&path, text(&format!("{} m/s2", 1.005 * demand))).unwrap();
    (dir, path_text)
}

/// What a search leaves undecided is reliable by products that are drawn, asked for by the command or by the file, in each way to be told.
#[test]
fn what_is_undecided_is_reliable_by_drawn_products() {
    let (_dir, path) = close_call();
    let outcome = clatter(["assess", &path]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Unsafe, ""));
    assert!(outcome.stdout.contains("\n  decided by: acceleration_limit = \""), "{}", outcome.stdout);
    let outcome = clatter(["assess", &path, "--reliability=99%"]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""), "{}", outcome.stdout);
    let first = "bar is reliable: 1 of 1 components, R99 C95, 299 products, none exceeded it, as a bar; ";
    assert!(outcome.stdout.starts_with(first), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("\n  reliable: R99 C95, 299 products, none exceeded it\n"), "{}", outcome.stdout);
    assert!(!outcome.stdout.contains("safe"), "it is never called so: {}", outcome.stdout);
    let by_option = clatter(["assess", &path, "--reliability=0.9", "--confidence=90%", "--format=json"]).stdout;
    let json: Value = serde_json::from_str(&by_option).unwrap();
    for of in [&json["components"][0], &json["components"][0]["limits"][0]] {
        assert_eq!([&of["verdict"], &json["verdict"]], ["reliable"; 2]);
        assert_eq!((&of["reliability"], &of["confidence"], &of["samples"]), (&0.9.into(), &0.9.into(), &22.into()));
    }
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, format!("{text}[verdict]\nreliability = \"90 %\"\nconfidence = 0.9\n")).unwrap();
    assert_eq!(clatter(["assess", &path, "--format=json"]).stdout, by_option, "the file asks for the same");
    let other = clatter(["assess", &path, "--confidence=95%", "--format=json"]).stdout;
    assert!(other.contains("\"samples\":29"), "in place of what the file says: {other}");
}

/// A reliability has a sign of percent or is a share below 1.
#[test]
fn what_is_no_reliability_is_refused() {
    let path = example("bar-handheld.toml");
    for value in ["0", "1", "100%", "99", "NaN", "-5%", "much"] {
        for option in ["--reliability", "--confidence"] {
            let outcome = clatter(["assess", &path, &format!("{option}={value}")]);
            assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{value}");
            let said = format!("'{value}' is not a share from 1% to 99.999%, such as 99% or 0.99");
            assert!(outcome.stderr.contains(&said) && outcome.stderr.contains(option), "{}", outcome.stderr);
        }
    }
    let outcome = clatter(["assess", &path, "--confidence=90%"]);
    assert_eq!(outcome.exit, Exit::BadInput);
    assert!(outcome.stderr.contains("a confidence is how sure a reliability is"), "{}", outcome.stderr);
}

#[test]
fn the_schema_names_every_key_of_the_examples() {
    let schema: Value = answer_of_schema();
    for table in ["/properties/product", "/properties/drop/anyOf/0", "/properties/drop/anyOf/1/items"] {
        assert_eq!(schema.pointer(table).unwrap()["additionalProperties"], false, "{table}");
    }
    for name in ["phone.toml", "handheld-terminal.toml", "laptop.toml", "bar-terminal.toml"] {
        let text = fs::read_to_string(example(name)).unwrap();
        for line in text.lines().filter(|line| !line.starts_with(['#', '[', ' ', ']']) && line.contains(" = ")) {
            let key = line.split(" = ").next().unwrap();
            let known = ["/properties/product", "/properties/drop/anyOf/0", "/properties/component/items"]
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
    let (_dir, path) = changed(|text| display_limit(&text, "1700 gn"));
    let json = answer(["assess", path.as_str()]);
    assert_eq!(json["components"][0]["limits"][0]["limit"], "acceleration");
    assert!((json["components"][0]["position_m"].as_f64().unwrap() - 0.01).abs() < 1e-15, "SI");
}

/// One part fails, one is within what the search may miss of its limit, and one is safe; the time of each worst drop is in ms.
#[test]
fn the_table_counts_parts_by_their_verdict() {
    let (_dir, path) = changed(|text| text);
    let camera = answer(["assess", &path])["components"][1]["limits"][0]["demand"].as_f64().unwrap();
    let near = format!("\"{:?} m/s2\"", 1.005 * camera);
    let (_dir, path) = changed(|text| display_limit(&text, "1200 gn").replace("\"1000 gn\"", &near));
    let json: Value = serde_json::from_str(&clatter(["assess", &path, "--format=json"]).stdout).unwrap();
    let verdicts = [0, 1, 2].map(|k| json["components"][k]["verdict"].as_str().unwrap());
    assert_eq!(verdicts, ["unsafe", "undecided", "safe"]);
    let table = clatter(["assess", &path]).stdout;
    assert!(table.starts_with("Handheld is UNSAFE: 1 of 3 components, 1 undecided, as a bar; "), "{table}");
    let time_s = json["components"][0]["limits"][0]["worst_case"]["time_s"].as_f64().unwrap();
    let words: Vec<&str> = table.split("display, acceleration: ").nth(1).unwrap().split_whitespace().collect();
    let at = words.windows(3).find(|w| w[0] == "at" && w[2].trim_end_matches('.') == "ms").unwrap()[1];
    assert!((at.parse::<f64>().unwrap() / (1e3 * time_s) - 1.0).abs() < 1e-3, "{at} ms, {time_s} s");
}
