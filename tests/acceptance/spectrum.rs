//! `clatter spectrum`: pulses, velocity shocks and records.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use clatter_cli::Exit;
use insta::assert_snapshot;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::{answer, clatter};

fn numbers(values: &Value) -> Vec<f64> {
    values.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

fn close(got: f64, want: f64, share: f64) -> bool {
    (got - want).abs() <= share * want.abs()
}

/// The JSON of a limit that is exceeded.
fn exceeded<const N: usize>(arguments: [&str; N]) -> Value {
    let outcome = clatter(arguments.into_iter().chain(["--format=json"]));
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Unsafe, ""));
    serde_json::from_str(&outcome.stdout).unwrap()
}

#[derive(Deserialize)]
struct Case {
    pulses: Vec<Half>,
    damping: f64,
    frequency_hz: Vec<f64>,
    maximax_acceleration: Vec<f64>,
}

#[derive(Deserialize)]
struct Half {
    amplitude_m_s2: f64,
    duration_s: f64,
    start_s: f64,
}

/// 16 trains of half-sines, integrated at tight tolerance: good to 1e-6.
#[test]
fn spectra_are_those_of_an_integrator() {
    #[derive(Deserialize)]
    struct Oracle {
        cases: Vec<Case>,
    }
    let oracle: Oracle =
        serde_json::from_str(include_str!("../../crates/clatter-shock/tests/data/spectrum.json")).unwrap();
    assert_eq!(oracle.cases.len(), 16);
    for (i, c) in oracle.cases.iter().enumerate() {
        let mut arguments = vec!["spectrum".to_owned(), format!("--damping={:?}", c.damping)];
        let pulse = |p: &Half| format!("--pulse=half-sine,{:?},{:?},{:?}", p.amplitude_m_s2, p.duration_s, p.start_s);
        arguments.extend(c.pulses.iter().map(pulse));
        let hz: Vec<_> = c.frequency_hz.iter().map(|hz| format!("{hz:?}")).collect();
        arguments.push(format!("--frequency={}", hz.join(",")));
        for (got, want) in numbers(&answer(arguments)["maximax"]).into_iter().zip(&c.maximax_acceleration) {
            assert!(close(got, *want, 1e-6), "case {i}: {got:?}, not {want:?}");
        }
    }
}

/// A part of 60 Hz that reaches its stop: pulses, a record of the same straight lines and `respond` say the same. A stiff part does not
/// reach it.
#[test]
fn parts_with_stops_have_spectra() {
    let dir = tempfile::tempdir().unwrap();
    let record = dir.path().join("triangle.csv");
    let mut text = String::from("time_s,acceleration_m_s2\n");
    for k in 0..=20 {
        let up = if k <= 10 { f64::from(k) } else { f64::from(20 - k) };
        let _ = writeln!(text, "{:?},{:?}", 1e-4 * f64::from(k), 500.0 * up);
    }
    fs::write(&record, text).unwrap();
    let pulses = dir.path().join("pulses.csv");
    fs::write(&pulses, "shape,amplitude_m_s2,duration_s,start_s\ntriangle,5000,0.002,0\n").unwrap();
    let (record, pulses) = (record.to_str().unwrap(), pulses.to_str().unwrap());
    let stop = "--stop=1mm,0.5ms,0.4";
    let of = |first: &str, with: Option<&str>| {
        let all = ["spectrum", first, "--frequency=60,900", "--damping=0.1"].into_iter().chain(with);
        numbers(&answer(all)["maximax"])
    };
    let pulse = "--pulse=triangle,5000,0.002";
    let (free, stopped, measured) = (of(pulse, None), of(pulse, Some(stop)), of(record, Some(stop)));
    assert!(stopped[0] > 5.0 * free[0] && close(stopped[1], free[1], 1e-12), "{stopped:?}, {free:?}");
    assert!(stopped.iter().zip(&measured).all(|(a, b)| close(*a, *b, 1e-9)), "{stopped:?}, {measured:?}");
    let omega = std::f64::consts::TAU * 60.0;
    let file = format!("--pulses-file={pulses}");
    let part = answer(["respond", &file, &format!("--omega={omega:?}"), "--damping=0.1", stop]);
    assert!(
        close(part["peak_absolute_acceleration_over_omega"].as_f64().unwrap() * omega, stopped[0], 1e-12),
        "{part}"
    );
    // It arrives as the pulse is at its crest, with a little more than half of the 5 m/s that the pulse brings, and twice more after that.
    let hits = part["at_stop"]["hits"].as_array().unwrap();
    let hardest = part["at_stop"]["largest_hit_m_s"].as_f64().unwrap();
    assert!(hits.len() == 3 && (2.5..3.0).contains(&hardest), "{part}");
    let table = clatter(["spectrum", pulse, "--frequency=60", stop]).stdout;
    assert!(table.contains("stops at 1.00000 mm with contacts of 0.500000 ms, e = 0.4"), "{table}");
}

#[test]
fn spectrum_explains_itself() {
    // An undamped component swings for ever with what a shock gave it: 2 m/s, against a limit of twice that.
    let shown = clatter([
        "spectrum",
        "--shock=2,0",
        "--frequency=10,20",
        "--damping=0",
        "--limit=4",
        "--quantity=pseudo-velocity",
    ]);
    assert_eq!((shown.exit, shown.stderr.as_str()), (Exit::Done, ""));
    assert_snapshot!(shown.stdout, @"
    Shock response spectrum: pseudo velocity in m/s, damping ratio 0 (Q = infinite)
    The limit holds: least margin 6.02060 dB at 10.0000 Hz

     frequency     primary    residual     maximax    positive    negative  time of peak      margin
            Hz         m/s         m/s         m/s         m/s         m/s             s          dB
       10.0000           0     2.00000     2.00000     2.00000     2.00000     0.0250000     6.02060
       20.0000           0     2.00000     2.00000     2.00000     2.00000     0.0125000     6.02060
    ");
}

#[test]
fn the_five_quantities_of_one_shock_are_known() {
    let of = |quantity: &str| {
        let got = answer(["spectrum", "--shock=-3,1", "--frequency=0.5", "--damping=0", "--quantity", quantity]);
        ["primary", "residual", "maximax", "positive", "negative"].map(|name| got[name][0].as_f64().unwrap())
    };
    let omega = std::f64::consts::PI;
    for (quantity, size) in [
        ("acceleration", 3.0 * omega),
        ("relative-displacement", 3.0 / omega),
        ("relative-velocity", 3.0),
        ("pseudo-velocity", 3.0),
        ("equivalent-static-acceleration", 3.0 * omega),
    ] {
        let [primary, rest @ ..] = of(quantity);
        assert!(rest.iter().all(|x| close(*x, size, 1e-15)), "{quantity}: {rest:?}, not {size}");
        // While the shock lasts, in no time, only the velocity jumps.
        assert!(close(primary, if quantity == "relative-velocity" { 3.0 } else { 0.0 }, 0.0), "{quantity}: {primary}");
    }
}

/// One shock without damping swings from the shock on: first against it, half a period later with it.
#[test]
fn signs_of_both_parts_and_the_time_of_the_peak_are_told() {
    let got = answer(["spectrum", "--shock=3,1", "--frequency=0.5", "--damping=0", "--quantity=relative-velocity"]);
    let of = |name: &str| got[name][0].as_f64().unwrap();
    assert_eq!((of("primary_positive"), of("primary_negative")), (0.0, 3.0), "{got}");
    assert_eq!((of("residual_positive"), of("residual_negative"), of("time_of_peak_s")), (3.0, 3.0, 1.0), "{got}");
    // Positive is ω² times positive of the displacement, and so is negative: of a shock on a damped part.
    let of = |quantity: &str, name: &str| {
        let got = answer(["spectrum", "--shock=3,1", "--frequency=0.5", "--damping=0.1", "--quantity", quantity]);
        got[name][0].as_f64().unwrap()
    };
    for name in ["positive", "negative", "residual_positive", "residual_negative"] {
        let (a, z) = (of("equivalent-static-acceleration", name), of("relative-displacement", name));
        assert!(close(a, std::f64::consts::PI.powi(2) * z, 1e-14), "{name}: {a} and {z}");
    }
}

#[test]
fn accelerations_come_in_the_units_asked_for() {
    let base = ["spectrum", "--pulse=rectangle,9.80665,1", "--frequency=100", "--damping=0", "--limit=3g"];
    let with = |more: &[&str]| clatter(base.iter().copied().chain(more.iter().copied()));
    let json = |more: &[&str]| -> Value {
        let more: Vec<_> = more.iter().copied().chain(["--format=json"]).collect();
        serde_json::from_str(&with(&more).stdout).unwrap()
    };
    // A step doubles 1 g.
    for (more, unit, size) in [
        (&[][..], "m/s2", 9.806_65),
        (&["--output-units=si"], "m/s2", 9.806_65),
        (&["--output-units=gn"], "gn", 1.0),
        (&["--output-units=g"], "gn", 1.0),
    ] {
        let got = json(more);
        assert_eq!(got["unit"], json!(unit), "{more:?}");
        for name in ["maximax", "positive", "primary_positive"] {
            assert!(close(got[name][0].as_f64().unwrap(), 2.0 * size, 1e-12), "{more:?}, {name}: {got}");
        }
        assert!(close(got["limit"]["allowed"][0].as_f64().unwrap(), 3.0 * size, 1e-12), "{got}");
        assert!(close(got["limit"]["margin_db"][0].as_f64().unwrap(), 20.0 * 1.5_f64.log10(), 1e-12), "{got}");
        let more: Vec<_> = more.iter().copied().chain(["--format=csv"]).collect();
        let csv = with(&more).stdout;
        let row: Vec<f64> = csv.lines().nth(1).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!(close(row[0], 100.0, 0.0) && close(row[3], 2.0 * size, 1e-12), "{csv}");
    }
    // The table as the limit is, unless told otherwise.
    assert!(with(&[]).stdout.starts_with("Shock response spectrum: acceleration in gn,"));
    assert!(with(&["--output-units=si"]).stdout.starts_with("Shock response spectrum: acceleration in m/s2,"));
    let refused = clatter(["spectrum", "--shock=1,0", "--quantity=pseudo-velocity", "--output-units=g"]);
    assert_eq!(refused.exit, Exit::BadInput);
    assert!(refused.stderr.contains("--output-units=gn goes with the quantities acceleration"), "{}", refused.stderr);
}

#[test]
fn several_quality_factors_give_a_spectrum_each() {
    let folder = tempfile::tempdir().unwrap();
    let file = record(folder.path(), &triangle());
    let of = |q: &str| answer(["spectrum", file.to_str().unwrap(), "--frequency=20,50", "--limit=600", q]);
    let (mut all, singles) =
        (of("--q-factor=5,10,inf"), [of("--q-factor=5"), of("--q-factor=10"), of("--q-factor=inf")]);
    let spectra = all.as_object_mut().unwrap().remove("spectra").unwrap();
    assert_eq!(all, singles[0], "above stands the first");
    assert_eq!(spectra.as_array().unwrap().len(), 3);
    for (one, single) in spectra.as_array().unwrap().iter().zip(&singles) {
        for (name, value) in one.as_object().unwrap() {
            assert_eq!(value, &single[name], "{name}");
        }
        assert!(one["time_of_peak_s"].is_array() && one["limit"]["worst"].is_object(), "{one}");
    }
    assert_eq!(singles[0]["spectra"], Value::Null, "one is no list");
    let shown = |more: &[&str]| {
        let base = ["spectrum", file.to_str().unwrap(), "--frequency=20,50", "--q-factor=5,10,inf"];
        clatter(base.iter().chain(more)).stdout
    };
    let csv = shown(&["--format=csv"]);
    let cells: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!((cells[0][0], cells[0][1], cells.len()), ("q_factor", "frequency_hz", 7), "{csv}");
    assert_eq!(cells[1..].iter().map(|row| row[0]).collect::<Vec<_>>(), ["5.0", "5.0", "10.0", "10.0", "inf", "inf"]);
    assert_eq!(shown(&[]).matches("Shock response spectrum").count(), 3);
    let svg = folder.path().join("all.svg");
    shown(&["-o", svg.to_str().unwrap()]);
    let svg = fs::read_to_string(svg).unwrap();
    assert!(["Q = 5.00000", "Q = 10.0000", "Q = infinite"].iter().all(|name| svg.contains(name)), "{svg}");
    let outcome = clatter(["spectrum", "--shock=1,0", "--q-factor=5,0"]);
    assert!(outcome.exit == Exit::BadInput && outcome.stderr.contains("quality factor 0.0"), "{}", outcome.stderr);
}

#[test]
fn frequencies_come_as_asked() {
    let of = |text: &str| numbers(&answer(["spectrum", "--shock=1,0", "--frequency", text])["frequency_hz"]);
    assert_eq!(of("180,20"), [180.0, 20.0], "in the order of the list");
    let octaves = of("10:80:1");
    assert!(octaves.iter().zip([10.0, 20.0, 40.0, 80.0]).all(|(got, want)| close(*got, want, 1e-15)), "{octaves:?}");
    let usual = numbers(&answer(["spectrum", "--shock=1,0"])["frequency_hz"]);
    assert_eq!((usual.len(), usual[0], usual[120]), (121, 10.0, 10_000.0), "10 Hz to 10 kHz, 12 an octave or more");
}

#[test]
fn the_margin_is_that_of_the_worst_frequency() {
    let got = exceeded([
        "spectrum",
        "--shock=1,0",
        "--damping=0",
        "--frequency=5,10,100,1000",
        "--quantity=pseudo-velocity",
        "--limit=10:2,1000:0.5",
    ]);
    let limit = &got["limit"];
    // 1 m/s everywhere, against 2, 1 and ½ m/s on a straight line of log-log paper that begins at 10 Hz.
    assert_eq!(limit["margin_db"][0], Value::Null, "no limit below 10 Hz");
    for (i, db) in [(1, 6.020_599_913_279_624), (3, -6.020_599_913_279_624)] {
        assert!(close(limit["margin_db"][i].as_f64().unwrap(), db, 1e-14), "{limit}");
    }
    assert!(limit["margin_db"][2].as_f64().unwrap().abs() < 1e-14, "{limit}");
    assert_eq!((&limit["worst"]["frequency_hz"], &limit["worst"]["safe"]), (&json!(1000.0), &json!(false)));
}

/// The same words and the same exit status, whatever the format.
#[test]
fn a_limit_that_is_exceeded_is_told_by_word_and_exit_status() {
    // 2 m/s at any frequency without damping: ω times that, against 100 m/s², is exceeded from 8 Hz on.
    let of = |limit: &str, format: &str| {
        clatter(["spectrum", "--shock=2,0", "--frequency=5,20", "--damping=0", limit, &format!("--format={format}")])
    };
    for format in ["table", "json", "csv"] {
        assert_eq!(of("--limit=100", format).exit, Exit::Unsafe, "{format}");
        assert_eq!(of("--limit=300", format).exit, Exit::Done, "{format}");
        // The only frequency that is exceeded is outside of the curve.
        assert_eq!(of("--limit=1:100,10:100", format).exit, Exit::Done, "{format}");
    }
    let margin = 20.0 * (100.0 / (80.0 * std::f64::consts::PI)).log10();
    let line = format!("The limit is exceeded: least margin {margin:.5} dB at 20.0000 Hz\n");
    let shown = of("--limit=100", "table").stdout;
    assert!(shown.contains(&line), "{line}{shown}");
    let json: Value = serde_json::from_str(&of("--limit=100", "json").stdout).unwrap();
    assert_eq!(json["limit"]["worst"]["safe"], json!(false), "{json}");
    // One of several damping ratios is enough: 126 m/s² without damping, 102 with Q = 2.
    let several = ["spectrum", "--shock=2,0", "--frequency=10", "--limit=115"];
    let of = |q: &str| clatter(several.iter().copied().chain([q])).exit;
    assert_eq!((of("--q-factor=2"), of("--q-factor=2,inf")), (Exit::Done, Exit::Unsafe));
}

#[test]
fn the_damage_boundary_of_a_rectangle_is_that_of_the_standard() {
    let got = exceeded([
        "spectrum",
        "--pulse=rectangle,200,0.01,0",
        "--frequency=50",
        "--damping=0",
        "--limit=300",
        "--damage-boundary",
    ]);
    let b = &got["damage_boundary"];
    let of = |name: &str| b[name].as_f64().unwrap();
    let critical = 300.0 / (100.0 * std::f64::consts::PI);
    assert!(close(of("critical_velocity_change_m_s"), critical, 1e-14), "{b}");
    assert!(close(of("critical_acceleration_m_s2"), 150.0, 1e-14), "{b}");
    // ASTM D3332 rounds it to 1.57.
    assert!(close(of("knee_velocity_change_m_s"), std::f64::consts::FRAC_PI_2 * critical, 1e-14), "{b}");
    // Half a period doubles the 200 m/s².
    assert!(close(of("margin"), 300.0 / 400.0 - 1.0, 1e-14) && b["safe"] == json!(false), "{b}");
    assert_eq!(of("velocity_change_m_s").to_string(), "2");
}

/// A million pulses, a period apart, on a component without damping: each adds to the swing.
#[test]
fn a_million_pulses_are_answered() {
    let mut argument = String::from("--pulse=rectangle,1,5e-4");
    for k in 0..1_000_000_u32 {
        write!(argument, ",{:?}", f64::from(k) * 1e-3).unwrap();
    }
    let one = answer(["spectrum", "--pulse=rectangle,1,5e-4,0", "--frequency=1000", "--damping=0"]);
    let all = answer(["spectrum", argument.as_str(), "--frequency=1000", "--damping=0"]);
    let of = |got: &Value| got["residual"][0].as_f64().unwrap();
    // Starts late in time are rounded to 1e-13 s: 1e-9 of a period.
    assert!(close(of(&all), 1e6 * of(&one), 1e-6), "{} and {}", of(&all), of(&one));
}

/// Half-sines of 3000 lengths, all at once: refused before memory runs out.
#[test]
fn pulses_that_overlap_beyond_reason_are_refused() {
    let pulse = |k: u32| format!("--pulse=half-sine,1,{:?},{:?}", 1000.0 + f64::from(k), f64::from(k) * 1e-3);
    let arguments = ["spectrum", "--frequency=1"].map(str::to_owned).into_iter().chain((0..3000).map(pulse));
    let outcome = clatter(arguments);
    assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""));
    assert!(outcome.stderr.starts_with("error: the pulses overlap in "), "{}", outcome.stderr);
}

fn record(folder: &Path, text: &str) -> PathBuf {
    let file = folder.join("record.csv");
    fs::write(&file, text).unwrap();
    file
}

/// A triangle of 50 m/s² and 40 samples, even in time.
fn triangle() -> String {
    let mut text = String::from("time [s],acceleration [m/s2]\n");
    for i in 0..=40_u32 {
        let a = 50.0 * (1.0 - (f64::from(i) - 20.0).abs() / 20.0);
        writeln!(text, "{},{a}", f64::from(i) / 4096.0).unwrap();
    }
    text
}

#[test]
fn a_record_gives_the_spectrum_of_the_pulse_it_samples() {
    let folder = tempfile::tempdir().unwrap();
    let frequencies = "--frequency=1:4000:6";
    let pulse = answer(["spectrum", "--pulse=triangle,50,0.009765625,0", frequencies]);
    let corners = format!("0;0\n{};25\n{};50\n{};0\n", 10.0 / 4096.0, 20.0 / 4096.0, 40.0 / 4096.0);
    for (text, units, even) in [(triangle(), None, true), (corners, Some("--units=s,m/s2"), false)] {
        let file = record(folder.path(), &text);
        let arguments = ["spectrum", file.to_str().unwrap(), frequencies, "--interpolation=linear"];
        let got = answer(arguments.into_iter().chain(units));
        assert_eq!(got["record"]["step_s"].is_null(), !even, "{}", got["record"]);
        for name in ["primary", "residual", "maximax", "positive", "negative"] {
            for (got, want) in numbers(&got[name]).into_iter().zip(numbers(&pulse[name])) {
                // The same history but for rounding of the samples; residuals nearly vanish at some frequencies.
                assert!(close(got, want, 1e-11) || (got - want).abs() < 1e-11 * 50.0, "{name}: {got} and {want}");
            }
        }
    }
}

#[test]
fn units_may_come_from_the_header_or_from_the_caller() {
    let folder = tempfile::tempdir().unwrap();
    let of = |text: &str, more: &[&str]| {
        let file = record(folder.path(), text);
        let arguments = ["spectrum", file.to_str().unwrap(), "--frequency=100"];
        answer(arguments.iter().chain(more))["maximax"][0].as_f64().unwrap()
    };
    let rows = "0,0\n1,1\n2,0\n3,0\n";
    let in_g = of(&format!("time [ms],acceleration [g]\n{rows}"), &[]);
    assert_eq!(of(rows, &["--units=ms,g"]).to_bits(), in_g.to_bits(), "the same units");
    assert!(close(of(rows, &["--units=ms,m/s2"]) * 9.806_65, in_g, 1e-14), "{in_g}");
}

#[test]
fn bad_records_are_told_by_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    for (text, said) in [
        ("", "the file is empty"),
        ("0,1\n", "a record needs 2 samples at least; the record has 1"),
        ("0,0\n1e-3,NaN\n", "line 2: NaN in column 2 (column 2) is no finite number\n--skip-bad goes on without them"),
        ("0,0\n1e-3,0\n2e-3,\n", "line 3: nothing stands in column 2 (column 2)\n--skip-bad goes on without them"),
        (
            "0,0\n2e-3,1\n1e-3,1\n",
            "line 3: time 0.001 s does not come after 0.002 s, that of the sample before\n--skip-bad goes on without them",
        ),
        (
            "0,0\ntime,acceleration\n1,1\n",
            "line 2 names columns, below numbers from line 1 on that none is named of: --record=1 reads the first lines, --record=2 \
             those below the names",
        ),
    ] {
        let file = record(folder.path(), text);
        let outcome = clatter(["spectrum", file.to_str().unwrap(), "--units=s,m/s2"]);
        assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{text:?}");
        assert_eq!(outcome.stderr, format!("error: {}: {said}\n", file.display()));
    }
    let file = record(folder.path(), "time,acceleration\n0,0\n1,0\n");
    let outcome = clatter(["spectrum", file.to_str().unwrap()]);
    assert!(outcome.stderr.contains("the unit of column 1 (time), the time, is not named"), "{}", outcome.stderr);
}

#[test]
fn what_is_odd_about_a_record_is_a_warning_and_in_the_answer() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = String::from("time [s],acceleration [m/s2]\n");
    for i in 0..2000_u32 {
        let t = f64::from(i) * 1e-4 + if i >= 1500 { 0.01 } else { 0.0 };
        writeln!(text, "{t:.4},{}", if i == 700 { 100.0 } else { 2.0 + f64::from(i) * 0.005 }).unwrap();
    }
    let file = record(folder.path(), &text);
    let outcome = clatter(["spectrum", file.to_str().unwrap(), "--frequency=100", "--format=json"]);
    assert_eq!(outcome.exit, Exit::Done);
    let warnings: Vec<_> = outcome.stderr.lines().collect();
    assert_eq!(warnings.len(), 3, "a gap, an end off zero, an offset: {warnings:?}");
    assert!(warnings[0].starts_with(&format!("warning: {}: samples are missing", file.display())), "{warnings:?}");
    assert!(warnings[0].ends_with("line 1502: 0.0101 s"), "{warnings:?}");
    let got: Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(got["record"]["findings"].as_array().unwrap().len(), 3, "{}", got["record"]);
}

#[test]
fn rows_and_pictures_can_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, more: &[&str]| {
        let file = folder.path().join(name);
        let arguments = ["spectrum", "--pulse=half-sine,9810,0.001,0", "-o", file.to_str().unwrap()];
        let outcome = clatter(arguments.iter().chain(more));
        let exit = if outcome.stdout.contains("The limit is exceeded") { Exit::Unsafe } else { Exit::Done };
        assert_eq!((outcome.exit, outcome.stderr.as_str()), (exit, ""));
        assert!(outcome.stdout.contains(&format!("{}: ", file.display())), "{}", outcome.stdout);
        fs::read_to_string(file).unwrap()
    };
    let three = ["--frequency=10,100,1000"];
    let (csv, json) = (write("s.csv", &three), write("s.json", &three));
    let header = "frequency_hz,primary,residual,maximax,positive,negative,primary_positive,primary_negative,\
                  residual_positive,residual_negative,time_of_peak_s";
    assert!(csv.starts_with(&format!("{header}\n10.0,")), "{csv}");
    let json: Value = serde_json::from_str(&json).unwrap();
    for (i, line) in csv.lines().skip(1).enumerate() {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let named: Vec<f64> = header.split(',').map(|name| json[name][i].as_f64().unwrap()).collect();
        assert_eq!(row, named, "row {i}");
    }
    let limited = write("l.csv", &["--frequency=10,100", "--limit=50:2000,500:2000"]);
    assert!(limited.starts_with(&header.replace("negative,primary", "negative,margin_db,primary")), "{limited}");
    assert_eq!(limited.lines().nth(1).unwrap().split(',').nth(6), Some(""), "no limit at 10 Hz: {limited}");
    for (name, more, words) in [
        ("a.svg", &["--limit=2000"][..], ["absolute acceleration, gn", "least margin"]),
        ("v.svg", &["--quantity=pseudo-velocity"], ["pseudo-velocity, m/s", "10 mm"]),
        (
            "b.svg",
            &["--frequency=100", "--limit=2000", "--damage-boundary"],
            ["velocity change of the base", "this shock"],
        ),
        ("one.svg", &["--frequency=100"], ["natural frequency, Hz", "maximax"]),
        ("wide.svg", &["--limit=1", "--frequency=1e-12,1e7"], ["maximax", "limit"]),
    ] {
        let svg = write(name, more);
        assert!(words.iter().all(|word| svg.contains(word)) && !svg.contains("NaN"), "{name}: {svg}");
    }
    let boundary = write("b.csv", &["--frequency=100", "--limit=2000", "--damage-boundary"]);
    assert!(boundary.starts_with("velocity_change_m_s,acceleration_m_s2\n"), "{boundary}");
}

/// Critical is the highest level below all damage, the knee that of a rectangle.
#[test]
fn a_damage_boundary_comes_from_tests() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("tests.csv");
    let rows = "test,level,damaged\nvelocity-change,2,no\nvelocity-change,2.5,no\nvelocity-change,3,yes\n\
                acceleration,300,no\nacceleration,400,yes\nacceleration,420,no\n";
    fs::write(&file, rows).unwrap();
    let tests = format!("--tests={}", file.display());
    let spectrum = |pulse: &str, more: &[&str]| {
        let arguments = ["spectrum", pulse, "--damage-boundary", &tests, "--frequency=100"];
        clatter(arguments.iter().chain(more))
    };
    let outcome = spectrum("--pulse=rectangle,900,0.004", &["--format=json"]);
    assert_eq!(outcome.exit, Exit::Unsafe, "beyond the boundary");
    let got: Value = serde_json::from_str(&outcome.stdout).unwrap();
    fs::write(&file, rows.replace("no", "No").replace("yes", "YES")).unwrap();
    assert_eq!(spectrum("--pulse=rectangle,900,0.004", &["--format=json"]).stdout, outcome.stdout, "in capitals");
    let of = |name: &str| got["damage_boundary"][name].as_f64().unwrap();
    assert!(close(of("critical_velocity_change_m_s"), 2.5, 1e-14), "{got}");
    assert!(close(of("critical_acceleration_m_s2"), 300.0, 1e-14), "{got}");
    assert!(close(of("knee_velocity_change_m_s"), 2.5 * std::f64::consts::FRAC_PI_2, 1e-14), "{got}");
    assert_eq!(got["damage_boundary"]["safe"], json!(false), "beyond both");
    for safe in ["--pulse=rectangle,5000,0.00049", "--pulse=rectangle,299,1"] {
        let outcome = spectrum(safe, &[]);
        assert!(outcome.stdout.contains("dB: no damage") && outcome.exit == Exit::Done, "{safe}");
    }
    let svg = folder.path().join("boundary.svg");
    let drawn = spectrum("--pulse=rectangle,900,0.004", &["-o", svg.to_str().unwrap()]);
    assert_eq!((drawn.exit, drawn.stderr.as_str()), (Exit::Unsafe, ""));
    assert!(fs::read_to_string(svg).unwrap().contains("velocity change of the base"));
    for (text, said) in [
        ("test,level,damaged\nvelocity-change,NaN,no\n", "line 2: level: 'NaN' is not a number such as 0.5"),
        ("test,level,damaged\nvelocity-change,-1,no\n", "line 2: level = -1.0 is not > 0"),
        ("test,level,damaged\nvelocity-change,1,maybe\n", "line 2: damaged 'maybe' is not yes or no"),
        (
            "test,level,damaged\nheight,1,no\n",
            "line 2: test 'height' is not velocity-change (in m/s) or acceleration (in m/s2)",
        ),
        (
            "test,damaged\nheight,no\n",
            "line 1: no column level; the first line names the columns, test,level,damaged among them",
        ),
        (
            "test,level,damaged\nvelocity-change,1,no\n",
            "the velocity change trials show no critical level: some level without damage must lie below the lowest with damage",
        ),
    ] {
        fs::write(&file, text).unwrap();
        let outcome = spectrum("--pulse=rectangle,900,0.004", &[]);
        assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{text}");
        assert_eq!(outcome.stderr, format!("error: {}: {said}\n", file.display()));
    }
    let outcome = spectrum("--pulse=half-sine,900,0.004", &[]);
    assert!(outcome.stderr.contains("--tests goes with one --pulse with one start, a rectangle"), "{}", outcome.stderr);
}

#[test]
fn lists_of_files_are_those_of_flags() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let file = folder.path().join(name);
        fs::write(&file, text).unwrap();
        file.display().to_string()
    };
    let shocks = write("shocks.csv", "time_s,delta_v_m_s\n0,2.5\n0.004,-1\n");
    // In any order, with a column more.
    let pulses = write(
        "pulses.csv",
        "# two\nstart_s,shape,note,duration_s,amplitude_m_s2\n0.002,trapezoid:0.2,late,5e-4,-300\n0,half-sine,,1e-3,500\n",
    );
    for (file, flags) in [
        (format!("--shocks-file={shocks}"), ["--shock=2.5,0", "--shock=-1,0.004"]),
        (format!("--pulses-file={pulses}"), ["--pulse=half-sine,500,1e-3,0", "--pulse=trapezoid:0.2,-300,5e-4,0.002"]),
    ] {
        assert_eq!(answer(["spectrum", &file]), answer(["spectrum"].into_iter().chain(flags)), "{file}");
    }
}

/// Service condition B of JESD22-B110 is a half-sine of 1500 g and 0.5 ms.
#[test]
fn the_pulse_of_a_standard_is_that_of_its_numbers() {
    let of = |pulse: &str| answer(["spectrum", &format!("--pulse={pulse}"), "--frequency=100,1000"]);
    let [by_name, by_numbers] = ["jesd22-b110/b", "half-sine,1500g,0.5ms"].map(of);
    assert_eq!(by_name["maximax"], by_numbers["maximax"]);
    assert!(by_name["maximax"][1].as_f64().unwrap() > 1e4, "{by_name}");
}
