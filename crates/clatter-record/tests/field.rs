//! One shock in notations of the field, each file with what is right: `expected.json`.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use clatter_record::{Options, Record};
use serde_json::Value;

fn options(arguments: &Value) -> Options {
    let mut options = Options::default();
    for argument in arguments.as_array().expect("a list") {
        let argument = argument.as_str().expect("text");
        let (key, value) = argument.split_once('=').unwrap_or((argument, ""));
        match key {
            "--units" => options.units = Some(value.parse().expect(value)),
            "--sample-rate" => options.sample_rate_hz = Some(value.parse().expect(value)),
            "--time" => options.time = value.parse().ok(),
            "--acceleration" => options.accelerations.push(value.parse().expect(value)),
            "--skip-bad" => options.skip_bad = true,
            _ => panic!("{key}"),
        }
    }
    options
}

/// Returns whether a record is the one that is right; nothing stands for one that is to be refused.
fn is_right(record: &Record, right: &Value) -> bool {
    let all = || record.channels().iter().flat_map(|channel| channel.values.iter().copied());
    let close = |got: f64, name: &str| (got / right[name].as_f64().expect(name) - 1.0).abs() < 1e-4;
    !right.is_null()
        && right["ch"] == record.channels().len()
        && record.channels().iter().all(|channel| right["n"] == channel.values.len())
        && close(all().fold(0.0, f64::max), "hi")
        && close(all().fold(0.0, f64::min), "lo")
        && record.step_s().is_some_and(|step_s| close(step_s, "step"))
}

/// Files that are read as they are, and not refused, as what is odd of them is told: samples that are missing.
const TOLD: [&str; 2] = ["drop10.csv", "gap_days.csv"];

#[test]
fn files_of_the_field() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/field");
    let expected: Value =
        serde_json::from_slice(&fs::read(folder.join("expected.json")).expect("a file")).expect("JSON");
    let (mut faults, mut count) = (String::new(), 0);
    for (name, tries) in expected.as_object().expect("an object") {
        let Ok(bytes) = fs::read(folder.join(name)) else { continue };
        count += 1;
        let tries = tries.as_array().expect("a list");
        for (nth, one) in tries.iter().enumerate() {
            let same = || tries.iter().filter(|other| other["args"] == one["args"]).map(|other| &other["right"]);
            let fault = match Record::read(&bytes[..], &options(&one["args"]), |_| ()) {
                Err(_) if same().any(Value::is_null) => continue,
                // A file that is read as it is needs no more.
                Err(_) if nth > 0 => continue,
                Err(error) => format!("refused: {error}"),
                Ok(record) if same().any(|right| is_right(&record, right)) => continue,
                Ok(record) if TOLD.contains(&name.as_str()) && !record.findings(10.0).is_empty() => continue,
                Ok(record) => {
                    let names: Vec<_> = record.channels().iter().map(|channel| channel.name.as_str()).collect();
                    let times: Vec<_> = record.times().iter().map(ToString::to_string).collect();
                    format!("read as {names:?}: {times:?}")
                }
            };
            let _ = writeln!(faults, "{name} {}: {fault}", one["args"]);
        }
    }
    assert!(count > 60, "{count} files");
    assert!(faults.is_empty(), "of {count} files:\n{faults}");
}
