//! The command that an assessment prints below each worst drop, run by a shell: it says the demand again.

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
    assert_eq!(err, "", "{command}");
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

#[test]
fn the_printed_command_repeats_the_demand() {
    let dir = tempfile::tempdir().unwrap();
    let example = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/cases").join(name);
    let written = example("bar-handheld.toml");
    let hard = dir.path().join("hard.toml");
    let stiff = "[product]\nname = \"Hard\"\nlength = \"140 mm\"\nradius_of_gyration = \"40 mm\"\ncenter_of_mass = \"6 mm\"\n\
        restitution = [0.1, 0.3]\ncontact_time = [\"0.3 ms\", \"0.5 ms\"]\n[drop]\nheight = \"1 m\"\ntilt = [\"3 deg\", \"8 deg\"]\n\
        [[component]]\nname = \"crystal\"\nposition = \"-40 mm\"\nmount = \"hard\"\nacceleration_limit = \"5000 gn\"\n\
        damage_boundary = { velocity_change = \"0.5 m/s\", acceleration = \"5000 gn\" }\n";
    std::fs::write(&hard, stiff).unwrap();
    let mut cases: Vec<(PathBuf, &str)> =
        ["bar-phone.toml", "bar-terminal.toml", "bar-laptop.toml"].map(|name| (example(name), "")).into();
    cases.extend([(written, " --model=finite-tilt"), (hard.clone(), " --model=finite-tilt"), (hard, "")]);
    let (mut count, mut rigid) = (0, 0);
    for (path, model) in cases {
        let name = path.display();
        let assessment = shell(&format!("clatter assess '{name}'{model} --format=json"));
        for limit in assessment["components"].as_array().unwrap().iter().flat_map(|c| c["limits"].as_array().unwrap()) {
            let command = limit["worst_case"]["command"].as_str().unwrap();
            let again = demand(limit, &shell(&format!("{command} --format=json")));
            let told = limit["demand"].as_f64().unwrap();
            assert!((again / told - 1.0).abs() < 1e-9, "{name}{model}: {again}, not {limit}");
            count += 1;
            rigid += usize::from(
                !model.is_empty() && limit["unit"] == "m/s2" && again > 0.0 && !command.contains("--omega"),
            );
        }
    }
    assert!(
        count >= 18 && rigid >= 3,
        "{count} limits, {rigid} of them accelerations of rigid parts by instant impacts"
    );
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
