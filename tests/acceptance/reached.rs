//! `clatter spectrum` beside what a test was to reach, and what is made of a record besides.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use clatter_cli::Exit;
use serde_json::Value;

use crate::clatter;

/// What a pulse of 1000 m/s², 1 ms asks of a part of 600 Hz without damping: 1768.458 m/s² (the peak of its spectrum is at 0.81/D);
/// here from a rectangle, which doubles all parts that are stiff enough.
const RECTANGLE: [&str; 4] = ["spectrum", "--pulse=rectangle,1000,0.01", "--damping=0", "--frequency=100,200,400"];

fn run(more: &[&str]) -> (Exit, Value, String) {
    let outcome = clatter(RECTANGLE.iter().chain(more).copied().chain(["--format=json"]));
    (outcome.exit, serde_json::from_str(&outcome.stdout).unwrap_or_default(), outcome.stderr)
}

#[test]
fn a_required_spectrum_is_reached_or_not_within_its_tolerance() {
    // 2000 m/s² at every frequency: 20 log10(2000/2500) = -1.938 dB, 20 log10(2000/1600) = 1.938 dB.
    for (required, tolerance, reached, below, above) in [
        ("2000", None, true, 0, 0),
        ("1000", None, true, 0, 0),
        ("2500", None, false, 3, 0),
        ("2500", Some("2"), true, 0, 0),
        ("2500", Some("-1.9,6"), false, 3, 0),
        ("1600", Some("-3,1.9"), false, 0, 3),
        ("1600", Some("2dB"), true, 0, 0),
        ("1600", Some("-3"), true, 0, 0),
        ("100:2500,200:1600,400:1600", Some("1.95"), true, 0, 0),
        ("100:2600,200:2000,400:1600", Some("1.95"), false, 1, 0),
    ] {
        let mut more = vec![format!("--required={required}")];
        more.extend(tolerance.map(|db| format!("--tolerance={db}")));
        let more: Vec<&str> = more.iter().map(String::as_str).collect();
        let (exit, told, _) = run(&more);
        let told = &told["required"];
        assert_eq!(exit, if reached { Exit::Done } else { Exit::Unsafe }, "{more:?}");
        assert_eq!(told["reached"], reached, "{more:?}");
        let counts = ["frequencies", "below", "above"].map(|key| told[key].as_u64().unwrap());
        assert_eq!(counts, [3, below, above], "{more:?}");
    }
    let (_, told, _) = run(&["--required=2500"]);
    let off = told["required"]["deviation_db"][1].as_f64().unwrap();
    assert!((off - 20.0 * 0.8_f64.log10()).abs() < 1e-9, "{off}");
    assert_eq!(told["required"]["lowest"]["level"], 2500.0);
    let table = clatter(RECTANGLE.iter().chain(&["--required=2500", "--tolerance=-1.5,6"]));
    assert!(
        table.stdout.contains("The required spectrum is not reached at 3 of 3 frequencies: from -1.93820 dB at"),
        "{}",
        table.stdout
    );
    assert!(table.stdout.contains("deviation"), "{}", table.stdout);
    let csv = clatter(RECTANGLE.iter().chain(&["--required=2500", "--limit=1e4", "--format=csv"])).stdout;
    assert!(csv.lines().next().unwrap().contains(",margin_db,deviation_db,"), "{csv}");
}

/// A spectrum that ends before the required one has not been seen to reach it there.
#[test]
fn what_is_not_judged_is_told() {
    let (exit, told, stderr) = run(&["--required=10:2000,200:2000"]);
    assert_eq!((exit, &told["required"]["frequencies"]), (Exit::Unsafe, &Value::from(2)), "{stderr}");
    assert_eq!(told["required"]["reached"], Value::Null, "{told}");
    let table = clatter(RECTANGLE.iter().chain(&["--required=10:2000,200:2000"])).stdout;
    assert!(table.contains("is reached where it is judged, and not judged all over its range"), "{table}");
    assert!(told["required"]["level"][2].is_null(), "{told}");
    assert!(
        stderr.contains("goes from 10.0000 to 200.000 Hz, and is judged from 100.000 to 400.000 Hz alone"),
        "{stderr}"
    );
    // Where nothing is judged, nothing is reached.
    let (exit, told, _) = run(&["--required=1000:1,2000:1"]);
    assert_eq!((exit, &told["required"]["reached"]), (Exit::Unsafe, &Value::Null));
    let (exit, _, stderr) = run(&["--tolerance=3"]);
    assert!(exit == Exit::BadInput && stderr.contains("--tolerance goes with --required"), "{stderr}");
    let (exit, _, stderr) = run(&["--required=3m/s"]);
    assert!(exit == Exit::BadInput && stderr.contains("--required in m/s is a velocity"), "{stderr}");
}

#[test]
fn a_required_spectrum_from_a_file_is_drawn_with_its_band() {
    let folder = tempfile::tempdir().unwrap();
    let (curve, svg) = (folder.path().join("required.csv"), folder.path().join("a.svg"));
    fs::write(&curve, "frequency [Hz],level [g]\n100,200\n400,200\n").unwrap();
    let more = [
        format!("--required-file={}", curve.display()),
        "--tolerance=-1.5,6".to_owned(),
        format!("--output={}", svg.display()),
    ];
    let outcome = clatter(RECTANGLE.iter().map(|&a| a.to_owned()).chain(more));
    assert_eq!(outcome.exit, Exit::Done, "{}{}", outcome.stdout, outcome.stderr);
    let svg = fs::read_to_string(svg).unwrap();
    assert!(svg.contains(">required<") && svg.contains(">tolerance<"), "{svg}");
}

#[test]
fn the_half_sine_that_envelopes_a_half_sine_is_that_half_sine() {
    let outcome = clatter([
        "spectrum",
        "--pulse=half-sine,500g,2ms",
        "--frequency=10:2000:6",
        "--enveloping-pulse=half-sine",
        "--format=json",
    ]);
    let told: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let of = |key: &str| told["enveloping_pulse"][key].as_f64().unwrap();
    assert!((of("duration_s") / 2e-3 - 1.0).abs() < 2e-3, "{told}");
    assert!((of("amplitude_m_s2") / 4903.325 - 1.0).abs() < 2e-3, "{told}");
    assert!(of("most_db") < 0.03 && of("mean_db") >= 0.0, "{told}");
    let table =
        clatter(["spectrum", "--pulse=half-sine,500g,2ms", "--frequency=10:2000:6", "--enveloping-pulse=half-sine"]);
    assert!(table.stdout.contains("Enveloped by a half-sine of "), "{}", table.stdout);
}

fn write(folder: &Path, name: &str, rows: impl Iterator<Item = (f64, f64)>) -> PathBuf {
    let mut text = String::from("time_s,z [m/s2],y [m/s2]\n");
    for (t, a) in rows {
        writeln!(text, "{t:.6},{a:.9},{:.9}", 0.5 * a).unwrap();
    }
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

/// A constant acceleration from rest on: an undamped part feels a (1 − cos ωt), and swings on after it.
#[test]
fn one_component_is_told_over_time() {
    let folder = tempfile::tempdir().unwrap();
    let record = write(folder.path(), "step.csv", (0..=100).map(|i| (f64::from(i) * 1e-4, 100.0)));
    let file = folder.path().join("felt.csv");
    let arguments = [
        "spectrum".to_owned(),
        record.display().to_string(),
        "--acceleration=z".to_owned(),
        "--interpolation=linear".to_owned(),
        "--damping=0".to_owned(),
        "--frequency=50".to_owned(),
        format!("--history={}", file.display()),
    ];
    let outcome = clatter(arguments.clone());
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    let text = fs::read_to_string(&file).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("record,channel,q_factor,time_s,base_acceleration_m_s2,acceleration_m_s2"));
    let rows: Vec<[f64; 3]> = lines
        .map(|line| {
            let cells: Vec<f64> = line.split(',').skip(3).map(|cell| cell.parse().unwrap()).collect();
            [cells[0], cells[1], cells[2]]
        })
        .collect();
    for [t, base, felt] in &rows[..=100] {
        let want = 100.0 * (1.0 - (std::f64::consts::TAU * 50.0 * t).cos());
        assert!((felt - want).abs() < 1e-9 && (base - 100.0).abs() < 1e-9, "{t}: {felt}, not {want}");
    }
    // It is left at the top of its swing, 200 m/s² with the base at rest: 200 cos ωt from then on, for five periods.
    let end = rows.last().unwrap();
    assert!((end[0] - 0.11).abs() < 1e-9 && end[1].abs() < 1e-12 && (end[2] - 200.0).abs() < 1e-6, "{end:?}");
    let two = clatter(arguments.iter().map(|a| if a == "--frequency=50" { "--frequency=50,60" } else { a }));
    assert!(two.exit == Exit::BadInput && two.stderr.contains("give one --frequency"), "{}", two.stderr);
    let none = clatter(["spectrum", "--pulse=half-sine,1,1", "--frequency=50", "--history=x.csv"]);
    assert!(none.exit == Exit::BadInput && none.stderr.contains("goes with records alone"), "{}", none.stderr);
}

/// A number of a record beside the names of files.
#[test]
fn one_record_of_a_file_of_several_has_its_spectrum() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |a: f64| format!("time_s,z [m/s2]\n0,0\n0.001,{a}\n0.002,0\n0.003,0\n0.004,0\n");
    let file = folder.path().join("two.csv");
    fs::write(&file, format!("{}\n{}", rows(100.0), rows(300.0))).unwrap();
    let of = |number: &str| {
        let outcome = clatter(["spectrum", file.to_str().unwrap(), number, "--frequency=100", "--format=json"]);
        let told: Value = serde_json::from_str(&outcome.stdout).unwrap_or_else(|_| panic!("{}", outcome.stderr));
        told["maximax"][0].as_f64().unwrap()
    };
    assert!((of("--record=2") / of("--record=1") - 3.0).abs() < 1e-9);
}

/// Two half-sines of 2 ms, 100 ms apart, the second twice the first.
#[test]
fn the_shocks_of_a_record_have_a_spectrum_each() {
    let folder = tempfile::tempdir().unwrap();
    let at = |t: f64, from: f64, a: f64| {
        let u = (t - from) / 2e-3;
        if (0.0..=1.0).contains(&u) { a * (std::f64::consts::PI * u).sin() } else { 0.0 }
    };
    let rows = (0..4000).map(|i| f64::from(i) * 5e-5).map(|t| (t, at(t, 0.02, 400.0) + at(t, 0.12, 800.0)));
    let record = write(folder.path(), "two.csv", rows).display().to_string();
    let arguments = ["spectrum", &record, "--find", "--frequency=100,300", "--resultant"];
    let outcome = clatter(arguments.iter().copied().chain(["--format=json"]));
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    let told: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let of: Vec<(&str, f64)> = told["spectra"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| (s["of"].as_str().unwrap(), s["maximax"][1].as_f64().unwrap()))
        .collect();
    let names = [
        "z, shock 1 at 0.0210000 s",
        "y, shock 1 at 0.0210000 s",
        "z, shock 2 at 0.121000 s",
        "y, shock 2 at 0.121000 s",
        "resultant, shock 1 at 0.0210000 s",
        "resultant, shock 2 at 0.121000 s",
    ];
    assert_eq!(of.iter().map(|(name, _)| *name).collect::<Vec<_>>(), names);
    // Each as that pulse alone asks, to what its samples tell of it.
    let alone = |a: &str| {
        let pulse = format!("--pulse=half-sine,{a},0.002");
        let told = clatter(["spectrum", &pulse, "--frequency=100,300", "--format=json"]).stdout;
        serde_json::from_str::<Value>(&told).unwrap()["maximax"][1].as_f64().unwrap()
    };
    for (found, want) in [(of[0].1, alone("400")), (of[1].1, alone("200")), (of[2].1, alone("800"))] {
        assert!((found / want - 1.0).abs() < 2e-3, "{found}, not {want}");
    }
    assert!((of[5].1 / of[2].1 - 1.25_f64.sqrt()).abs() < 1e-9, "{of:?}");
    // One table of all, a column each.
    let table = clatter(arguments).stdout;
    assert!(table.lines().any(|line| line.contains("z, shock 1") && line.contains("z, shock 2")), "{table}");
    let few = clatter(["spectrum", &record, "--find", "--threshold=5000", "--frequency=100"]);
    assert!(few.exit == Exit::BadInput && few.stderr.contains("0 shocks beyond 5000.00 m/s2"), "{}", few.stderr);
}
