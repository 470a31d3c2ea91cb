//! The command that repeats a worst drop as data, run by a shell: it says the demand again.

#![cfg(test)]
#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

const BINARY: &str = env!("CARGO_BIN_EXE_clatter");

/// What the shell makes of a command line; `clatter` is the one built here.
fn shell(command: &str) -> Value {
    let path = std::env::var("PATH").unwrap_or_default();
    let own = Path::new(BINARY).parent().unwrap().display();
    let done = Command::new("sh").args(["-c", command]).env("PATH", format!("{own}:{path}")).output().unwrap();
    let (out, err) = (String::from_utf8(done.stdout).unwrap(), String::from_utf8(done.stderr).unwrap());
    // Of a steep plate it is told how it is followed.
    assert!(err.lines().all(|line| line.starts_with("warning: a plate is followed")), "{command}: {err}");
    serde_json::from_str(&out).unwrap_or_else(|error| panic!("{error}: {command}: {out}"))
}

/// The demand in the answer to a repeated drop.
fn demand(limit: &Value, again: &Value) -> f64 {
    let of = |key: &str| again[key].as_f64().unwrap_or_else(|| panic!("{key} of {again}"));
    match (limit["limit"].as_str().unwrap(), limit["unit"].as_str().unwrap(), again.get("omega").is_some()) {
        ("acceleration", _, true) => of("omega") * of("peak_absolute_acceleration_over_omega"),
        ("rattle-space", ..) => of("omega_peak_relative_displacement") / of("omega"),
        ("angular-velocity-change", ..) => of("angular_velocity_change_rad_s"),
        ("acceleration" | "damage-boundary", "m/s2", _) => of("acceleration_m_s2"),
        ("velocity-change" | "damage-boundary", "m/s", _) => of("velocity_change_m_s"),
        other => panic!("{other:?} is not repeated"),
    }
}

/// A part that is mounted rigidly, by a limit that instant impacts have too; one on a suspension follows it.
const BAR: &str = "[product]\nname = \"Hard\"\nlength = \"140 mm\"\nradius_of_gyration = \"40 mm\"\ncenter_of_mass = \"6 mm\"\n\
    restitution = [0.1, 0.3]\ncontact_time = [\"0.3 ms\", \"0.5 ms\"]\n[drop]\nheight = \"1 m\"\ntilt = [\"3 deg\", \"8 deg\"]\n\
    [[component]]\nname = \"crystal\"\nposition = \"-40 mm\"\nmount = \"hard\"\nacceleration_limit = \"5000 gn\"\n\
    damage_boundary = { velocity_change = \"0.5 m/s\", acceleration = \"5000 gn\" }\n";

/// A bar, a plate or a box, with two parts that move along an axis of a box.
fn product(body: &str, drops: &str, [hard, suspended]: [&str; 2]) -> String {
    let axis = |axis: &str| if axis.is_empty() { String::new() } else { format!("axis = \"{axis}\"\n") };
    format!(
        "[product]\nname = \"Product\"\nlength = \"90 mm\"\nrestitution = [0.2, 0.3]\ncontact_time = \"0.5 ms\"\n\
         contact_law = \"hysteretic\"\n{body}\n{drops}\n\
         [[component]]\nname = \"hard\"\nposition = [\"20 mm\", \"12 mm\"]\n{}mount = \"hard\"\nacceleration_limit = \"2000 gn\"\n\
         velocity_change_limit = \"6 m/s\"\nangular_velocity_change_limit = \"200 rad/s\"\n\
         [[component]]\nname = \"suspended\"\nposition = [\"-30 mm\", \"5 mm\"]\n{}natural_frequency = [\"150 Hz\", \"180 Hz\"]\n\
         damping_ratio = 0.05\nacceleration_limit = \"900 gn\"\nrattle_space = \"9 mm\"\n",
        axis(hard),
        axis(suspended)
    )
}

/// Small products of every kind: boxes with parts along every axis, contacts of their own, feet, spin, several drops.
fn small() -> Vec<String> {
    let plate =
        "width = \"50 mm\"\nradius_of_gyration = [\"26 mm\", \"15 mm\"]\ncenter_of_mass = [\"3 mm\", \"-2 mm\"]";
    let block = format!("{plate}\nthickness = \"22 mm\"");
    let own = "contacts = [{ at = \"b\", restitution = 0.1, contact_time = \"0.8 ms\" }]";
    let feet = "feet_inset = [\"8 mm\", \"6 mm\"]\nfeet_height = \"12 mm\"";
    let tilted = "[drop]\nheight = \"0.7 m\"\ntilt = [\"2 deg\", \"6 deg\"]\n";
    let face = |face: &str| format!("[drop]\nheight = \"0.7 m\"\nface = \"{face}\"\nattitude_tolerance = \"1 deg\"\n");
    let spin = "spin = [\"-3 rad/s\", \"8 rad/s\"]\n";
    let two = format!(
        "[{}[[drop]]\nheight = \"0.5 m\"\nedge = \"end-a bottom\"\nattitude_tolerance = \"2 deg\"\n",
        face("end-b").replace("[drop]", "[drop]]")
    );
    vec![
        product(&format!("{plate}\n{own}"), tilted, [""; 2]),
        product(&format!("{plate}\n{feet}"), tilted, [""; 2]),
        product(plate, &format!("{tilted}direction = [\"20 deg\", \"60 deg\"]\n{spin}"), [""; 2]),
        product(&block, &face("bottom"), ["any", "z"]),
        product(&format!("{block}\n{own}"), &face("end-a"), ["x", "y"]),
        product(&block, &format!("{}{spin}", face("front")), ["y", "x"]),
        product(&block, &two, ["z", "x"]),
    ]
}

/// Of every worked product and of small ones each worst drop asks once more for what was told.
#[test]
fn the_printed_command_repeats_the_demand() {
    let dir = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let written = root.join("tests/cases/bar-handheld.toml");
    let hard = dir.path().join("hard.toml");
    std::fs::write(&hard, BAR).unwrap();
    let worked = std::fs::read_dir(root.join("reports/examples")).unwrap();
    let mut cases: Vec<(PathBuf, &str)> = worked.map(|file| (file.unwrap().path(), "")).collect();
    assert!(cases.len() >= 4, "{cases:?}");
    cases.extend(
        ["bar-phone.toml", "bar-terminal.toml", "bar-laptop.toml"]
            .map(|name| (root.join("tests/cases").join(name), "")),
    );
    cases.extend([(written, " --model=finite-tilt"), (hard.clone(), " --model=finite-tilt"), (hard, "")]);
    for (k, text) in small().into_iter().enumerate() {
        let path = dir.path().join(format!("small-{k}.toml"));
        std::fs::write(&path, text).unwrap();
        cases.push((path, ""));
    }
    let (mut count, mut rigid, mut boxes) = (0, 0, 0);
    for (path, model) in cases {
        let name = path.display();
        let assessment = shell(&format!("clatter assess '{name}'{model} --format=json"));
        for limit in assessment["components"].as_array().unwrap().iter().flat_map(|c| c["limits"].as_array().unwrap()) {
            let command = limit["worst_case"]["command"].as_str().unwrap_or_else(|| panic!("{name}: {limit}"));
            let again = demand(limit, &shell(&format!("{command} --format=json")));
            let told = limit["demand"].as_f64().unwrap();
            assert!((again / told - 1.0).abs() < 1e-9, "{name}{model}: {again}, not {limit}");
            count += 1;
            boxes += usize::from(command.contains("\"is_level\":false"));
            rigid += usize::from(
                !model.is_empty() && limit["unit"] == "m/s2" && again > 0.0 && command.contains("\"swings\":null"),
            );
        }
    }
    assert!(
        count >= 60 && boxes >= 23 && rigid >= 3,
        "{count} limits, {boxes} of boxes, {rigid} of them accelerations of rigid parts by instant impacts"
    );
}

/// A drop as data that is none is refused by one message that names the place.
#[test]
fn a_drop_that_is_none_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("hard.toml");
    std::fs::write(&path, BAR).unwrap();
    let assessment = shell(&format!("clatter assess {} --format=json", path.display()));
    let drop = &assessment["components"][0]["limits"][0]["worst_case"]["drop"];
    let mut cases = vec![(String::new(), "EOF"), ("[1, 2]".to_owned(), "invalid type")];
    let mut with = |change: &dyn Fn(&mut Value), said: &'static str| {
        let mut changed = drop.clone();
        change(&mut changed);
        cases.push((changed.to_string(), said));
    };
    with(&|drop| drop["drop"]["speed"] = 3.0.into(), "unknown field `speed`");
    with(&|drop| drop["drop"]["speed_m_s"] = Value::Null, "invalid type: null");
    with(&|drop| drop["drop"]["speed_m_s"] = (-3.0).into(), "speed in m/s = -3.0");
    with(&|drop| drop["drop"]["restitution"] = 1.5.into(), "1.5 is not in [0, 1]");
    with(&|drop| drop["drop"]["contact_time_s"] = 0.0.into(), "contact time in s is 0.0");
    with(&|drop| drop["drop"]["body"]["length"]["ends_m"][0] = (-1.0).into(), "from the center of mass in m is -1.0");
    with(&|drop| drop["place"]["at_m"][0] = 9.0.into(), "position of the part in m is 9.0");
    with(&|drop| drop["tolerance"] = 7.0.into(), "the tolerance is 7.0");
    for (text, said) in cases {
        let path = dir.path().join("drop.json");
        std::fs::write(&path, &text).unwrap();
        let done = Command::new(BINARY).args(["respond", "--drop"]).arg(&path).output().unwrap();
        let error = String::from_utf8(done.stderr).unwrap();
        assert!(done.status.code() == Some(2) && error.contains(said), "{text}: {error}");
        assert!(done.stdout.is_empty() && error.lines().count() == 1, "{error}");
    }
}

/// The short command of the table, run by a shell, tells the demand of each limit once more.
#[test]
fn the_short_command_repeats_the_demand() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a product's file.toml");
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/cases/bar-terminal.toml"));
    std::fs::write(&path, text.unwrap()).unwrap();
    for options in ["", " --tolerance=0.003", " --model=finite-tilt"] {
        let quoted = format!("\"{}\"", path.display());
        let assessment = shell(&format!("clatter assess {quoted}{options} --format=json"));
        let table = {
            let args: Vec<&str> = options.split_whitespace().collect();
            let done = Command::new(BINARY).arg("assess").arg(&path).args(args).output().unwrap();
            String::from_utf8(done.stdout).unwrap()
        };
        let commands: Vec<&str> =
            table.lines().filter(|line| line.starts_with("  clatter respond --product=")).collect();
        let limits = assessment["components"].as_array().unwrap().iter().flat_map(|c| c["limits"].as_array().unwrap());
        let limits: Vec<&Value> = limits.collect();
        assert_eq!(commands.len(), limits.len(), "{table}");
        for (command, limit) in commands.into_iter().zip(limits) {
            // What of its ranges the drop takes is told beside the answer.
            let again = shell(&format!("{command} --format=json 2>/dev/null"));
            let of_limit = again["limits"].as_array().unwrap().iter().find(|of| of["limit"] == limit["limit"]).unwrap();
            let (got, told) = (of_limit["value"].as_f64().unwrap(), limit["demand"].as_f64().unwrap());
            assert!((got / told - 1.0).abs() < 1e-9, "{command}: {got}, not {limit}");
        }
    }
}
