//! Records whose channels have times of their own, through the command line: every kind of file that is written reads back.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

/// 60 samples at 10 kHz, and 30 at 5 kHz from 1 ms on.
fn pairs() -> String {
    (0..60).fold("time [s],ax [g],time 2 [s],ay's [g]\n".to_owned(), |text, i| {
        let i = f64::from(i);
        let second = if i < 30.0 { format!("{},{}", 0.001 + i * 2e-4, (0.7 * i).sin()) } else { ",".to_owned() };
        format!("{text}{},{},{second}\n", i * 1e-4, (0.3 * i).sin())
    })
}

fn clatter(dir: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let done = Command::new(env!("CARGO_BIN_EXE_clatter")).current_dir(dir).args(arguments).output().expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (done.status.code(), text(done.stdout), text(done.stderr))
}

fn channels(dir: &Path, file: &str) -> Vec<Value> {
    let (code, out, error) = clatter(dir, &["record", file, "--format=json"]);
    assert_eq!(code, Some(0), "{error}");
    let answer: Value = serde_json::from_str(&out).expect("JSON");
    assert!(answer["samples"].is_null() && answer["step_s"].is_null(), "{answer}");
    answer["channels"].as_array().expect("channels").clone()
}

#[test]
fn every_output_reads_back_with_its_units_and_times() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("r.csv"), pairs()).unwrap();
    let (code, _, error) =
        clatter(dir.path(), &["record", "r.csv", "-o", "o.csv", "-o", "o.npy", "-o", "o.parquet", "-o", "o.svg"]);
    assert_eq!(code, Some(0), "{error}");
    let told = |channels: &[Value]| {
        let keys = ["samples", "start_s", "step_s", "largest_m_s2", "largest_time_s", "smallest_m_s2"];
        channels.iter().map(|channel| keys.map(|key| channel[key].to_string())).collect::<Vec<_>>()
    };
    let original = channels(dir.path(), "r.csv");
    assert_eq!([&original[0]["samples"], &original[1]["samples"]], [60, 30]);
    assert_eq!([&original[1]["start_s"], &original[1]["step_s"]], [0.001, 2e-4]);
    for file in ["o.csv", "o.npy", "o.parquet"] {
        let again = channels(dir.path(), file);
        assert_eq!(told(&again), told(&original), "{file}");
        assert!(again.iter().all(|channel| channel["unit"] == "m/s2"), "{file}");
    }
}

#[test]
fn spectra_are_of_each_channel_and_a_resultant_is_of_one_time() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("r.csv"), pairs()).unwrap();
    let spectrum = ["spectrum", "r.csv", "--frequency=500", "--format=json"];
    let (code, out, error) = clatter(dir.path(), &spectrum);
    assert_eq!(code, Some(0), "{error}");
    let both: Value = serde_json::from_str(&out).expect("JSON");
    // Alone each has the spectrum that it has beside the other.
    for (k, channel) in ["2", "4"].iter().enumerate() {
        let pick = format!("--acceleration={channel}");
        let (_, out, _) = clatter(dir.path(), &[&spectrum[..], &[&pick]].concat());
        let one: Value = serde_json::from_str(&out).expect("JSON");
        assert_eq!(one["maximax"], both["spectra"][k]["maximax"], "{channel}");
    }
    let (code, _, error) = clatter(dir.path(), &[&spectrum[..], &["--resultant"]].concat());
    assert_eq!(code, Some(2), "{error}");
    assert!(
        error.contains("a resultant needs channels of one time: ax has 60 samples from 0 s on, every 0.0001 s;"),
        "{error}"
    );
}
