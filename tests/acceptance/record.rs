//! `clatter record`, and spectra of records: what was understood, what is odd, what is made of it.

use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};

use clatter_cli::Exit;
use insta::assert_snapshot;
use serde_json::{Value, json};

use crate::{answer, clatter};

const G: f64 = 9.806_65;

/// A half-sine of 50 g and 2 ms from 5 ms on, ten samples a millisecond, by the text of each line.
fn half_sine(heading: &str, line: impl Fn(u32, f64) -> String) -> String {
    let value = |i: u32| if (50..=70).contains(&i) { 50.0 * (PI * f64::from(i - 50) / 20.0).sin() } else { 0.0 };
    (0..300).fold(format!("{heading}\n"), |text, i| text + &line(i, value(i)) + "\n")
}

fn plain() -> String {
    half_sine("time [s],acceleration [g]", |i, a| format!("{:.4},{a:.6}", f64::from(i) * 1e-4))
}

fn file(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

fn close(got: &Value, want: f64, share: f64) -> bool {
    got.as_f64().is_some_and(|got| (got - want).abs() <= share * want.abs())
}

#[test]
fn a_record_is_shown_as_it_was_understood() {
    let folder = tempfile::tempdir().unwrap();
    let path = file(folder.path(), "drop.csv", &plain());
    let shown = clatter(["record", path.to_str().unwrap(), "--find", "--integrate"]);
    assert_eq!((shown.exit, shown.stderr.as_str()), (Exit::Done, ""));
    assert_snapshot!(shown.stdout.replace(folder.path().to_str().unwrap(), ""), @"
    /drop.csv: 300 samples in 29.9000 ms from 0 s on, every 100.000 us: 10.0000 kHz

    channel                       unit       largest            at      smallest            at
                                                m/s2            ms          m/s2            ms
    acceleration                     g       490.332       6.00000             0             0

    acceleration: at the end 0.623027 m/s and 0.0148903 m, from rest

    acceleration: 1 shock beyond 4.90332 m/s2
               start            peak              at        duration velocity change
                   s            m/s2               s               s             m/s
          0.00506392         490.332      0.00600000      0.00187215        0.619892

    301 lines: 1 heading, 300 rows; columns 1 (time [s]): time, 2 (acceleration [g]): acceleration
    ");
    let got = answer(["record", path.to_str().unwrap(), "--find", "--fit-pulse"]);
    assert_eq!(
        (&got["samples"], &got["step_s"], &got["sample_rate_hz"]),
        (&json!(300), &json!(1e-4), &json!(10_000.0))
    );
    let channel = &got["channels"][0];
    assert_eq!((&channel["name"], &channel["unit"]), (&json!("acceleration"), &json!("g")));
    assert!(close(&channel["largest_m_s2"], 50.0 * G, 1e-9), "{channel}");
    // 2 A D/π, by straight lines 0.2 % less, and without the feet below 10 %.
    let whole = 2.0 * 50.0 * G * 2e-3 / PI;
    assert!(close(&channel["shocks"]["list"][0]["velocity_change_m_s"], whole, 0.01), "{channel}");
    let pulse = &channel["pulse"];
    assert_eq!(pulse["fits"][0]["shape"], "half-sine");
    assert!(close(&pulse["fits"][0]["duration_s"], 2e-3, 1e-6), "{pulse}");
    assert!(pulse["tolerances"].as_array().unwrap().iter().all(|one| one["within"] == true), "{pulse}");
    let large = answer(["record", path.to_str().unwrap(), "--fit-pulse", "--nominal=half-sine,80g,2ms"]);
    let tolerances = &large["channels"][0]["pulse"]["tolerances"];
    assert!(tolerances.as_array().unwrap().iter().any(|one| one["within"] == false), "{tolerances}");
}

/// Rows of one sensor, a voltage of known sensitivity, one of two records, and what every line and column was taken for.
#[test]
fn parts_of_a_file_are_picked() {
    let folder = tempfile::tempdir().unwrap();
    let sensors = half_sine("time [s],sensor,a [g]", |i, a| {
        let t = f64::from(i) * 1e-4;
        format!("{t:.4},top,{a:.6}\n{t:.4},floor,{:.6}", 2.0 * a)
    });
    let sensors = file(folder.path(), "sensors.csv", &sensors);
    let refused = clatter(["record", sensors.to_str().unwrap()]);
    assert_eq!(refused.exit, Exit::BadInput, "{}", refused.stderr);
    assert!(
        refused.stderr.contains("rows of several sensors come in turns, by column 2 (sensor): top, floor"),
        "{}",
        refused.stderr
    );
    let got = answer(["record", sensors.to_str().unwrap(), "--sensor=floor"]);
    assert!(close(&got["channels"][0]["largest_m_s2"], 100.0 * G, 1e-9), "{got}");
    assert_eq!(
        (&got["account"]["rows"], &got["account"]["not_asked_for"], &got["account"]["lines"]),
        (&json!(300), &json!(300), &json!(601))
    );
    assert_eq!(got["account"]["columns"][1], json!({"column": "2 (sensor)", "taken_for": "sensor"}));

    let volts = half_sine("time [s],CH1 [mV]", |i, a| format!("{:.4},{:.4}", f64::from(i) * 1e-4, 10.0 * a));
    let volts = file(folder.path(), "volts.csv", &volts);
    let refused = clatter(["record", volts.to_str().unwrap()]);
    assert!(refused.stderr.contains("--sensitivity such as 100mV/g"), "{}", refused.stderr);
    let got = answer(["record", volts.to_str().unwrap(), "--sensitivity=10mV/g"]);
    assert!(close(&got["channels"][0]["largest_m_s2"], 50.0 * G, 1e-6), "{got}");

    let two = plain() + "\n" + &plain().replace(",50.0", ",70.0");
    let two = file(folder.path(), "two.csv", &two);
    let refused = clatter(["record", two.to_str().unwrap()]);
    assert!(
        refused.stderr.contains("line 303 begins another record: --record=1 reads the first"),
        "{}",
        refused.stderr
    );
    let got = answer(["record", two.to_str().unwrap(), "--record=2"]);
    assert!(close(&got["channels"][0]["largest_m_s2"], 70.0 * G, 1e-9), "{got}");
    let account = &got["account"];
    assert_eq!((&account["rows"], &account["not_asked_for"], &account["empty"]), (&json!(300), &json!(300), &json!(1)));
    let none = clatter(["record", two.to_str().unwrap(), "--record=3"]);
    assert!(none.stderr.contains("there is no record 3 in the file: there are 2 records"), "{}", none.stderr);
}

/// What is written reads back as the same record.
#[test]
fn a_record_is_written_anew() {
    let folder = tempfile::tempdir().unwrap();
    let path = file(folder.path(), "drop.csv", &plain());
    for name in ["copy.csv", "copy.parquet", "copy.npy"] {
        let copy = folder.path().join(name);
        let outcome = clatter(["record", path.to_str().unwrap(), "-o", copy.to_str().unwrap()]);
        assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
        let units = if name == "copy.npy" { Some("--units=s,m/s2") } else { None };
        let of = |path: &Path, more: Option<&str>| {
            answer(["spectrum", path.to_str().unwrap(), "--frequency=200"].into_iter().chain(more))["maximax"].clone()
        };
        assert_eq!(of(&copy, units), of(&path, None), "{name}");
    }
    let picture = folder.path().join("drop.svg");
    clatter(["record", path.to_str().unwrap(), "--find", "-o", picture.to_str().unwrap()]);
    let picture = fs::read_to_string(picture).unwrap();
    assert!(["acceleration", "time, ms", "#a34a1c"].iter().all(|part| picture.contains(part)), "{picture}");
}

/// The history that `simulate` writes is a record: of the accelerations of both ends and of a place.
#[test]
fn our_own_histories_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drop.csv");
    let drop = [
        "simulate",
        "--model=compliant",
        "--length=140mm",
        "--gyration=40.4mm",
        "--e=0.3",
        "--speed=4.85m/s",
        "--tilt=2deg",
        "--contact-time=0.4ms",
        "--at=0.5",
        "--time-limit=10ms",
        "-o",
    ];
    let simulated = clatter(drop.iter().copied().chain([path.to_str().unwrap()]));
    assert_eq!(simulated.exit, Exit::Done, "{}", simulated.stderr);
    let shown = clatter(["record", path.to_str().unwrap(), "--format=json"]);
    let told: Vec<_> = shown.stderr.lines().filter(|line| !line.contains("nothing is made of column 2")).collect();
    assert!(matches!(told[..], [one] if one.contains("two samples at one time are a jump")), "{told:?}");
    let got: Value = serde_json::from_str(&shown.stdout).unwrap();
    let names: Vec<_> = got["channels"].as_array().unwrap().iter().map(|one| one["name"].clone()).collect();
    assert_eq!(names, ["acceleration_a", "acceleration_b", "acceleration_at_0.5"]);
    let spectrum = clatter(["spectrum", path.to_str().unwrap(), "--frequency=180", "--envelope", "--format=json"]);
    let spectrum: Value = serde_json::from_str(&spectrum.stdout).unwrap();
    assert_eq!(spectrum["spectra"].as_array().unwrap().len(), 4, "three channels and the envelope");
}

#[test]
fn channels_have_a_spectrum_each_and_together() {
    let folder = tempfile::tempdir().unwrap();
    let text =
        half_sine("t [s],ax [g],ay [g]", |i, a| format!("{:.4},{:.6},{:.6}", f64::from(i) * 1e-4, 0.6 * a, -0.8 * a));
    let path = file(folder.path(), "two.csv", &text);
    let all = ["--resultant", "--envelope", "--mean-3db"];
    let got = answer(["spectrum", path.to_str().unwrap(), "--frequency=200"].into_iter().chain(all));
    assert!(got["maximax"].is_null(), "of several channels none is the first: {got}");
    let of = |i: usize| {
        (got["spectra"][i]["of"].as_str().unwrap().to_owned(), got["spectra"][i]["maximax"][0].as_f64().unwrap())
    };
    let whole = file(folder.path(), "one.csv", &plain());
    let one = answer(["spectrum", whole.to_str().unwrap(), "--frequency=200"])["maximax"][0].as_f64().unwrap();
    let expected =
        [("ax", 0.6), ("ay", 0.8), ("resultant", 1.0), ("envelope", 0.8), ("mean + 3 dB", 0.7 * 10_f64.powf(0.15))];
    for (i, (name, share)) in expected.into_iter().enumerate() {
        let (of, maximax) = of(i);
        // Six decimals of a g are printed.
        assert!(of == name && (maximax / one - share).abs() < 1e-6, "{of}: {} of {one}", maximax / one);
    }
    let csv = clatter(["spectrum", path.to_str().unwrap(), "--frequency=200", "--format=csv"]).stdout;
    assert!(csv.starts_with("of,frequency_hz,") && csv.lines().nth(2).unwrap().starts_with("ay,200.0,"), "{csv}");
}

/// By straight lines a tone at five samples a cycle is 12 % low.
#[test]
fn between_samples_a_record_is_band_limited() {
    let folder = tempfile::tempdir().unwrap();
    let tone = |i: u32| {
        let t = f64::from(i) - 300.0;
        (-(t / 60.0).powi(2)).exp() * (PI * 0.4 * t).sin()
    };
    let text = (0..600).fold("t [s],a [m/s2]\n".to_owned(), |text, i| text + &format!("{i},{:.9}\n", tone(i)));
    let path = file(folder.path(), "tone.csv", &text);
    let of = |more: Option<&str>| {
        let arguments = ["spectrum", path.to_str().unwrap(), "--frequency=0.2"];
        answer(arguments.into_iter().chain(more))["maximax"][0].as_f64().unwrap()
    };
    let ratio = of(Some("--interpolation=linear")) / of(None);
    // sinc²(1/5)
    assert!((ratio - 0.8751).abs() < 1e-3, "{ratio}");
    let beyond = clatter(["spectrum", path.to_str().unwrap(), "--frequency=0.45"]);
    assert!(beyond.stderr.contains("above 0.400000 Hz, 0.4 of the sampling rate"), "{}", beyond.stderr);
    let usual = answer(["spectrum", path.to_str().unwrap()]);
    let hz = usual["frequency_hz"].as_array().unwrap();
    assert!(close(hz.last().unwrap(), 1.0 / 3.0, 1e-12), "a third of the sampling rate");
}

#[test]
fn records_are_made_ready() {
    let folder = tempfile::tempdir().unwrap();
    let text = half_sine("t [s],a [g]", |i, a| format!("{:.4},{:.6}", f64::from(i) * 1e-4, a + 0.5));
    let [offset, clean] =
        [("offset.csv", text), ("clean.csv", plain())].map(|(name, text)| file(folder.path(), name, &text));
    let of = |path: &Path, more: &[&str]| {
        let arguments = ["spectrum", path.to_str().unwrap(), "--frequency=20", "--format=json"];
        let shown = clatter(arguments.iter().chain(more));
        let got: Value = serde_json::from_str(&shown.stdout).unwrap();
        got["maximax"][0].as_f64().unwrap()
    };
    let want = of(&clean, &[]);
    // 0.5 g for 30 ms is a quarter of the velocity change.
    assert!((of(&offset, &[]) / want - 1.0).abs() > 0.1, "an offset counts");
    assert!((of(&offset, &["--detrend=pre-shock"]) / want - 1.0).abs() < 1e-6, "and can be taken out");
    assert!((of(&clean, &["--window=3ms:9ms"]) / want - 1.0).abs() < 1e-6, "what is before and after is nothing");
    assert!(of(&clean, &["--high-pass=500"]) < 0.2 * want, "low frequencies are gone");
    let told = clatter(["spectrum", offset.to_str().unwrap(), "--frequency=20"]).stderr;
    assert!(told.contains("4.9 m/s2 before the shock"), "{told}");
}

#[test]
fn limits_come_from_files_and_standards() {
    let folder = tempfile::tempdir().unwrap();
    let record = file(folder.path(), "drop.csv", &plain());
    let limit = file(folder.path(), "limit.csv", "frequency [Hz],limit [g]\n10,5\n100,50\n1000,50\n");
    let typed = clatter(["spectrum", record.to_str().unwrap(), "--frequency=50,500", "--limit=10:5g,100:50g,1000:50g"]);
    let filed =
        clatter(["spectrum", record.to_str().unwrap(), "--frequency=50,500", "--limit-file", limit.to_str().unwrap()]);
    assert_eq!((typed.exit, typed.stdout), (Exit::Unsafe, filed.stdout.clone()));
    assert!(filed.stdout.contains("The limit is exceeded: least margin -"), "{}", filed.stdout);
    let standard =
        clatter(["spectrum", record.to_str().unwrap(), "--frequency=50", "--limit=MIL-STD-810/516/crash-ground"]);
    // 75 g · 50/80 at 50 Hz.
    assert_eq!(standard.exit, Exit::Done, "{}", standard.stdout);
    let wrong = clatter([
        "spectrum",
        record.to_str().unwrap(),
        "--quantity=pseudo-velocity",
        "--limit-file",
        limit.to_str().unwrap(),
    ]);
    assert!(
        wrong.stderr.contains("the level is of acceleration, and the spectrum is one of velocity"),
        "{}",
        wrong.stderr
    );
}

/// The boundary of a record of a half-sine is that of the half-sine.
#[test]
fn the_damage_boundary_of_a_record_is_that_of_its_pulse() {
    let folder = tempfile::tempdir().unwrap();
    let record = file(folder.path(), "drop.csv", &plain());
    let of = |what: &str| {
        let arguments = ["spectrum", what, "--frequency=200", "--limit=30g", "--damage-boundary"];
        let outcome = clatter(arguments.into_iter().chain(["--format=json"]));
        assert_eq!(outcome.exit, Exit::Unsafe, "{}", outcome.stderr);
        serde_json::from_str::<Value>(&outcome.stdout).unwrap()["damage_boundary"].clone()
    };
    let (got, want) = (of(record.to_str().unwrap()), of("--pulse=half-sine,50g,2ms,5ms"));
    for name in ["critical_velocity_change_m_s", "critical_acceleration_m_s2", "velocity_change_m_s", "margin_db"] {
        // Between 20 samples of a half-sine, whose corners are above the band.
        assert!(close(&got[name], want[name].as_f64().unwrap(), 5e-3), "{name}: {} and {}", got[name], want[name]);
    }
}

#[test]
fn the_examples_of_the_help_run() {
    let folder = tempfile::tempdir().unwrap();
    let no_units = plain().replacen("time [s],acceleration [g]", "time,acceleration", 1);
    let three = half_sine("time [s],ax [g],az [g]", |i, a| format!("{:.4},{:.6},{a:.6}", f64::from(i) * 1e-4, 0.5 * a));
    let plain = plain();
    for (name, text) in [("drop.csv", &three), ("logger.txt", &no_units), ("day.csv", &plain), ("table.csv", &plain)] {
        file(folder.path(), name, text);
    }
    let help = clatter(["record", "--help"]).stdout;
    let examples: Vec<&str> = help.lines().filter(|line| line.trim().starts_with("clatter record ")).collect();
    assert_eq!(examples.len(), 5, "{help}");
    for example in examples {
        let in_folder = |word: &str| {
            let is_file = [".csv", ".txt", ".svg"].iter().any(|ending| word.ends_with(ending));
            if is_file { folder.path().join(word).display().to_string() } else { word.to_owned() }
        };
        // What one example writes another may read.
        let arguments = example.split_whitespace().skip(1).map(in_folder).chain(["--force".to_owned()]);
        let outcome = clatter(arguments);
        assert_eq!((outcome.exit, outcome.stdout.is_empty()), (Exit::Done, false), "{example}: {}", outcome.stderr);
    }
    for written in ["drop.svg", "pulse.svg"] {
        assert!(fs::read_to_string(folder.path().join(written)).unwrap().starts_with("<svg"), "{written}");
    }
}

/// Of pulses of one height the first is the largest; more than a thousand shocks are counted, though not listed.
#[test]
fn equal_peaks_and_many_shocks_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let value = |i: u32| match i % 20 {
        5 => 100.0,
        6 => -50.0,
        _ => 0.0,
    };
    let text = (0..24_000_u32).fold("time [s],acceleration [m/s2]\n".to_owned(), |text, i| {
        format!("{text}{:.3},{}\n", f64::from(i) * 1e-3, value(i))
    });
    let path = file(folder.path(), "many.csv", &text);
    let got = answer(["record", path.to_str().unwrap(), "--find", "--threshold=10", "--quiet=2ms"]);
    let channel = &got["channels"][0];
    assert!(close(&channel["largest_time_s"], 0.005, 1e-9) && close(&channel["smallest_time_s"], 0.006, 1e-9), "{got}");
    let (count, listed) = (&channel["shocks"]["count"], channel["shocks"]["list"].as_array().unwrap().len());
    assert_eq!((count, listed), (&json!(1200), 1000));
}

/// Times are those of the file: of a record that begins at 1 s the shock and its peak are later by that.
#[test]
fn times_of_shocks_are_those_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let of = |begins_s: f64| {
        let text =
            half_sine("time [s],acceleration [g]", |i, a| format!("{:.4},{a:.6}", begins_s + f64::from(i) * 1e-4));
        let got = answer(["record", file(folder.path(), "late.csv", &text).to_str().unwrap(), "--find"]);
        let shock = &got["channels"][0]["shocks"]["list"][0];
        ["start_s", "peak_time_s"].map(|key| shock[key].as_f64().unwrap_or_else(|| panic!("{got}")))
    };
    let ([start, peak], [late_start, late_peak]) = (of(0.0), of(1.0));
    assert!(
        (late_start - start - 1.0).abs() < 1e-9 && (late_peak - peak - 1.0).abs() < 1e-9,
        "{late_start}, {late_peak}"
    );
}
