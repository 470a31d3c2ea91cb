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
            "--sensitivity" => options.sensitivity_v_s2_m = clatter_record::sensitivity(value).ok(),
            "--record" => options.record = value.parse().ok(),
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
    assert!(count > 110, "{count} files");
    assert!(faults.is_empty(), "of {count} files:\n{faults}");
}

/// What a file says and the numbers do not is told, by a word that names it, or refuses the file.
#[test]
fn what_does_not_go_together_is_told() {
    let of = |name: &str, arguments: &[&str]| {
        let bytes = fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/field").join(name)).expect(name);
        Record::read(&bytes[..], &options(&serde_json::json!(arguments)), |_| ())
    };
    for (name, arguments, word) in [
        ("dyna.asc", &["--sample-rate=200"][..], "line 6 tells 10000 Hz, and the rate that is given is 200 Hz"),
        ("total600.csv", &[], "line 1 tells of 600 samples, and there are 300"),
        ("unit_conflict.csv", &[], "acc is in m/s2 by its heading, and in g by line 1"),
        ("scale_head.csv", &[], "line 1 tells 'Scale factor: 9.80665', and the numbers are taken as they are"),
        ("calib_head.csv", &[], "the numbers are taken times 0.01, plus 0, as line 3 tells"),
        ("unit_first.csv", &[], "Frame"),
        ("sent_m99999.csv", &[], "it may stand for no value"),
        ("sent_1e20.csv", &[], "it may stand for no value"),
        ("gaps.csv", &[], "samples are missing"),
    ] {
        let record = of(name, arguments).unwrap_or_else(|error| panic!("{name}: {error}"));
        let findings: Vec<String> = record.findings(10.0).iter().map(ToString::to_string).collect();
        assert!(findings.iter().any(|finding| finding.contains(word)), "{name}: {findings:?}");
    }
    for (name, arguments, word) in [
        ("excel_serial.csv", &["--units=s,g"][..], "days, as spreadsheets count them"),
        ("en_rate_dot.csv", &[], "10.000 Hz"),
        ("keyed.txt", &["--units=us,g"], "'x=0.0000'"),
        ("row125.csv", &["--units=s,mg"], "hardly"),
    ] {
        let error = of(name, arguments).expect_err(name).to_string();
        assert!(error.contains(word), "{name}: {error}");
    }
    let names =
        |name: &str| of(name, &[]).expect(name).channels().iter().map(|one| one.name.clone()).collect::<Vec<_>>();
    assert_eq!(names("labchart.txt"), ["Deck", "Rim"]);
    assert_eq!(names("start.001"), ["Rim acceleration X"]);
    let start_s = of("start.001", &[]).expect("a record").channels()[0].times().start_s();
    assert!((start_s + 0.002).abs() < 1e-15, "{start_s}");
    let halves = of("xy_half.csv", &["--units=s,g"]).expect("a record");
    let steps: Vec<f64> = halves.channels().iter().filter_map(|one| one.times().step_s()).collect();
    assert!(matches!(steps[..], [a, b] if (a - 1e-4).abs() < 1e-12 && (b - 5e-5).abs() < 1e-12), "{steps:?}");
    let summed = of("resultant1.csv", &[]).expect("a record");
    assert!(summed.channels().iter().all(|one| one.name != "Vector sum" || one.is_resultant()));
}

/// A heading that comes again joins what is below it by its times; without times it begins another record.
#[test]
fn a_heading_that_comes_again_begins_another_record_where_times_do_not_go_on() {
    let rows = |from: i32| {
        let mut text = String::new();
        (from..from + 12).for_each(|k| writeln!(text, "0.{k:03},{}", k % 5).expect("text"));
        text
    };
    let read = |text: &str, options: &Options| Record::read(text.as_bytes(), options, |_| ());
    let one = read(&format!("t [s],a [g]\n{}t [s],a [g]\n{}", rows(100), rows(112)), &Options::default()).expect("one");
    assert_eq!(one.channels()[0].values.len(), 24);
    let back = read(&format!("t [s],a [g]\n{}t [s],a [g]\n{}", rows(100), rows(100)), &Options::default());
    assert!(back.expect_err("two").to_string().contains("begins another record"));
    let values = "a [g],b [g]\n1,2\n2,1\n3,4\n4,5\n";
    let rated = Options { sample_rate_hz: Some(1e3), ..Options::default() };
    assert!(read(&values.repeat(2), &rated).expect_err("two").to_string().contains("line 6 begins another record"));
}

/// Whole seconds and what seems their fraction, which goes on beyond a second, are two times.
#[test]
fn a_fraction_of_a_second_is_below_one() {
    let mut text = "sec [s],part [ms],a [g]\n".to_owned();
    (0..30).for_each(|k| writeln!(text, "{},{},{}", k / 10, 100 * k, k % 3).expect("text"));
    let error = Record::read(text.as_bytes(), &Options::default(), |_| ()).expect_err("no fraction").to_string();
    assert!(error.starts_with("line 12: '1000' in column 2 (time) is no fraction of a second"), "{error}");
}

/// Two sensors of one direction beside one that is still are no directions and their resultant; the file may say so.
#[test]
fn one_direction_alone_has_a_resultant_by_its_name() {
    let text = |name: &str| format!("t [ms],x [g],y [g],{name} [g]\n0,0,0,0\n1,3,0,3\n2,1,0,1\n3,0,0,0\n");
    let of = |name: &str| Record::read(text(name).as_bytes(), &Options::default(), |_| ()).expect("a record");
    assert!(!of("top").channels().iter().any(clatter_record::Channel::is_resultant));
    assert!(of("Vector sum").channels()[2].is_resultant());
}

/// A rate that is given is held against the times of a table, and against the rate that the file tells of a column.
#[test]
fn a_rate_that_is_given_is_held_against_a_table() {
    use clatter_record::{Column, Table, Values};
    let column = |name: &str, sampled_s: Option<[f64; 2]>, values: Vec<f64>| Column {
        name: name.to_owned(),
        group: String::new(),
        unit: None,
        sampled_s,
        values: Values::Float(values),
    };
    let values = |count: usize| (0..count).map(|k| if k == 20 { 100.0 } else { 0.0 }).collect::<Vec<_>>();
    let times = |kept: fn(&i32) -> bool| (0..60).filter(kept).map(|k| 1e-3 * f64::from(k)).collect::<Vec<_>>();
    let found = |columns: Vec<Column>, hz: f64| {
        let options = Options { sample_rate_hz: Some(hz), ..Options::default() };
        let record = Record::of_table(Table { columns, ..Table::default() }, &options);
        record.map(|record| record.findings(100.0).iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
    };
    let timed = |times: Vec<f64>| vec![column("a [g]", None, values(times.len())), column("time [s]", None, times)];
    let told = |columns, hz, word: &str| {
        let found = found(columns, hz).unwrap_or_else(|error| error.to_string());
        assert!(found.contains(word), "{word}: {found}");
    };
    assert!(!found(timed(times(|_| true)), 1e3).expect("a record").contains("rate"));
    told(timed(times(|_| true)), 2e3, "the rate that is given, 2000 Hz, is not that of the times, 1000 Hz");
    told(timed(times(|k| *k != 30)), 1e3, "samples are missing");
    let sampled = || vec![column("a [g]", Some([0.0, 1e-3]), values(60))];
    told(sampled(), 2e3, "the file tells 1000 Hz of a, and the rate that is given is 2000 Hz");
    assert!(!found(sampled(), 1e3).expect("a record").contains("rate"));
}
