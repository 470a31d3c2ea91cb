//! `clatter simulate`: the same drop in every format, and what is refused.

use std::fs;
use std::path::Path;

use clatter_cli::Exit;
use insta::assert_snapshot;
use serde_json::{Value, json};

use crate::bad_input::are_refused;
use crate::{answer, clatter};

/// A uniform body at 5 degrees, as arguments.
const DROP: [&str; 6] =
    ["--length-m=0.14", "--gyration-m=0.04", "--e=0.3", "--speed-m-s=4.43", "--tilt-deg=5", "--gravity-m-s2=9.81"];

/// `clatter simulate --model=MODEL` of this drop, with other arguments in place of or after those that it has.
fn arguments(model: &str, others: &[&str]) -> Vec<String> {
    let name = |argument: &str| argument.split('=').next().unwrap_or_default().to_owned();
    let drop = DROP.iter().filter(|has| !others.iter().any(|other| name(other) == name(has)));
    let mut all = vec!["simulate".to_owned(), format!("--model={model}")];
    all.extend(drop.chain(others).filter(|argument| argument.contains('=')).map(|&argument| argument.to_owned()));
    all
}

/// Each row: the model, arguments in place of those of [`DROP`] (alone: left out), and what the message has to say.
#[rustfmt::skip]
const REFUSED: &[(&str, &[&str], &[&str])] = &[
    ("bounce", &[], &["--model", "bounce", "map, ballistic, finite-tilt, compliant"]),
    ("map", &["--length-m"], &["give --length=LENGTH", "--product=FILE"]),
    ("map", &["--speed-m-s"], &["give --speed=SPEED or --height=LENGTH"]),
    ("map", &["--length-m=-0.14"], &["--length-m", "-0.14", "[1e-30, 1e30]"]),
    ("map", &["--length-m=0"], &["--length-m", "0.0", "[1e-30, 1e30]"]),
    ("map", &["--length-m=nan"], &["--length-m", "NaN", "[1e-30, 1e30]"]),
    ("map", &["--length-m=14cm"], &["--length-m", "'14cm' is not a number"]),
    ("map", &["--gyration-m=-0.04"], &["--gyration-m", "-0.04", "0 or between 1e-12 and 1e6 times the length"]),
    ("map", &["--gyration-m=inf"], &["--gyration-m", "inf", "0 or between 1e-12 and 1e6 times the length"]),
    ("map", &["--gyration-m=NaN"], &["--gyration-m", "NaN", "0 or between 1e-12 and 1e6 times the length"]),
    ("finite-tilt", &["--thickness-m=-0.01"], &["--thickness-m", "-0.01", "between 1e-12 and 1 times the length"]),
    ("finite-tilt", &["--thickness-m=0.2"], &["--thickness-m", "0.2", "between 1e-12 and 1 times the length"]),
    ("finite-tilt", &["--thickness-m=nan"], &["--thickness-m", "NaN", "between 1e-12 and 1 times the length"]),
    ("compliant", &["--contact-time-s=1e-3", "--thickness-m=0.01"], &["--thickness-m", "0.01", "compliant"]),
    ("map", &["--center-of-mass=1"], &["--center-of-mass", "1.0", "(-1, 1)"]),
    ("map", &["--center-of-mass=nan"], &["--center-of-mass", "NaN", "(-1, 1)"]),
    ("map", &["--center-of-mass=0.9999999"], &["--center-of-mass", "ratio of the arms", "[1e-6, 1e6]"]),
    ("map", &["--e=1.1"], &["--e", "1.1", "[0, 1]"]),
    ("map", &["--tilt-deg=90"], &["--tilt-deg", "90.0", "[1e-60, 90)"]),
    ("map", &["--tilt-deg=-5"], &["--tilt-deg", "-5.0", "[1e-60, 90)"]),
    ("map", &["--speed-m-s=0"], &["--speed-m-s", "0.0", "[1e-30, 1e30]"]),
    ("map", &["--speed-m-s", "--height-m=-1"], &["--height-m", "-1.0", "[1e-30, 1e30]"]),
    ("map", &["--speed-m-s", "--height-m=1", "--gravity-m-s2=0"], &["--height-m", "gravity above 0"]),
    ("map", &["--height-m=1"], &["--speed-m-s", "--height-m", "cannot be used with"]),
    ("map", &["--gravity-m-s2=-9.81"], &["--gravity-m-s2", "-9.81", "[1e-60, 1e30]"]),
    ("map", &["--time-limit-s=0"], &["--time-limit-s", "0.0", "positive"]),
    ("map", &["--time-limit-s=nan"], &["--time-limit-s", "NaN", "positive"]),
    ("map", &["--impact-limit=0"], &["--impact-limit", "0", "1 ..= 100000000"]),
    ("map", &["--impact-limit=1000000000"], &["--impact-limit", "1000000000", "1 ..= 100000000"]),
    ("map", &["--spin-rad-s=-1000"], &["--spin-rad-s", "-1000", "above -speed/arm"]),
    ("map", &["--spin-rad-s=inf"], &["--spin-rad-s", "inf", "at most 1e30/length"]),
    ("map", &["--at=1.5"], &["--at", "1.5", "[-1, 1]"]),
    ("map", &["--output=motion.npy"], &["--output", ".csv, .json or .svg"]),
    ("map", &["--contact-time-s=1e-3"], &["--contact-time-s", "--model=compliant alone"]),
    ("compliant", &[], &["give --contact-time=TIME"]),
    ("compliant", &["--contact-time-s=0"], &["--contact-time-s", "0.0", "[1e-12, 1000]"]),
    ("compliant", &["--contact-time-s=1e-13"], &["--contact-time-s", "1e-13", "[1e-12, 1000]"]),
    ("compliant", &["--contact-time-s=0.1"], &["--contact-time-s", "0.1", "at most 11.9 ms here, a tenth of sqrt(length/gravity)"]),
    ("compliant", &["--contact-time-s=1e-3", "--e=1.001"], &["--e", "1.001", "[0, 1]"]),
    ("compliant", &["--contact-time-s=1e-3", "--contact-law=glue"], &["--contact-law", "glue", "hysteretic, dashpot"]),
    ("compliant", &["--contact-law=dashpot"], &["give --contact-time=TIME"]),
    ("map", &["--contact-law=dashpot"], &["--contact-law", "--model=compliant alone"]),
    ("map", &["--contact-time-s=1e-3", "--contact-law=dashpot"], &["--contact-law", "--model=compliant alone"]),
    ("compliant", &["--contact-time-s=1e-4", "--gyration-m=0.001"], &["--gyration-m", "0.001", "at least 7 mm here, 0.05 of the length"]),
];

#[test]
fn unphysical_drops_are_refused() {
    are_refused(REFUSED.iter().map(|(model, others, said)| (arguments(model, others), *said)));
}

/// The reference drops of the models in `crates/clatter-flight/tests/data/flight.json`: a fine numerical integration.
#[test]
fn every_reference_drop_comes_out() {
    let oracle: Value =
        serde_json::from_str(include_str!("../../crates/clatter-flight/tests/data/flight.json")).unwrap();
    let cases = oracle["cases"].as_array().unwrap();
    for case in cases {
        let model = case["model"].as_str().unwrap();
        let names = ["length-m", "gyration-m", "e", "speed-m-s", "tilt-deg", "gravity-m-s2"];
        let flags: Vec<_> = names.iter().map(|name| format!("--{name}={}", case[name.replace('-', "_")])).collect();
        let flags: Vec<_> = flags.iter().map(String::as_str).collect();
        let got = answer(arguments(model, &flags));
        for (i, want) in case["impacts"].as_array().unwrap().iter().enumerate() {
            let impact = &got["impacts"][i];
            assert_eq!(impact["end"], want["end"], "{case}");
            let near = |got: &Value, want: &Value, scale: f64| {
                let (got, want) = (got.as_f64().unwrap(), want.as_f64().unwrap());
                // What the integration behind the reference is good for.
                assert!((got - want).abs() <= 1e-7 * scale, "{got} not {want}, impact {i} of {case}");
            };
            let speed = case["speed_m_s"].as_f64().unwrap();
            near(&impact["time_s"], &want["time_s"], want["time_s"].as_f64().unwrap().max(1e-4));
            for end in 0..2 {
                near(&impact["delta_v_m_s"][end], &want["delta_v_m_s"][end], speed);
            }
        }
    }
    assert_eq!(cases.len(), 40);
}

#[test]
fn the_answer_has_the_fields_of_the_contract() {
    let got = answer(arguments("finite-tilt", &["--at=0"]));
    assert_eq!(got["model"], "finite-tilt");
    let first = &got["impacts"][0];
    assert_eq!((&first["number"], &first["end"], &first["time_s"]), (&json!(1), &json!("a"), &json!(0.0)));
    assert_eq!(first["approach_m_s"], json!(-4.43));
    let [a, b] = [0, 1].map(|end| first["delta_v_m_s"][end].as_f64().unwrap());
    assert_eq!(first["delta_v_at_m_s"], json!([0.5 * (a + b)]));
    assert_eq!(got["stop"]["reason"], "at-rest");
    assert!(got["stop"]["time_bound_s"].as_f64().unwrap() <= f64::EPSILON * got["stop"]["time_s"].as_f64().unwrap());
    // Contacts that take time die away: nothing bounds how long that takes.
    let soft = clatter(arguments("compliant", &["--contact-time-s=3e-4", "--format=json"]));
    let soft: Value = serde_json::from_str(&soft.stdout).unwrap();
    assert_eq!((&soft["stop"]["reason"], &soft["stop"]["time_bound_s"]), (&json!("at-rest"), &Value::Null));
    assert!(
        soft["stop"]["shock_bound_m_s"].is_number() && soft["stop"].as_object().unwrap().contains_key("time_bound_s")
    );
    let clear = answer(arguments("map", &[]));
    assert_eq!(clear["stop"]["reason"], "bounced-clear");
    assert_eq!(clear["stop"]["time_s"], clear["impacts"][3]["time_s"]);
}

#[test]
fn limits_stop_what_would_run_for_ever_and_say_so() {
    let endless = clatter(arguments("ballistic", &["--e=1", "--impact-limit=50", "--format=csv"]));
    assert_eq!((endless.exit, endless.stdout.lines().count()), (Exit::Done, 51));
    assert_eq!(endless.stderr, "warning: stopped after 50 impacts, more would follow; --impact-limit=N follows more\n");
    let short = answer(arguments("ballistic", &["--e=1", "--time-limit-s=0.5"]));
    assert_eq!(short["stop"], json!({"reason": "time-limit", "time_s": 0.5}));
    assert!(short["impacts"].as_array().unwrap().iter().all(|impact| impact["time_s"].as_f64().unwrap() <= 0.5));
}

#[test]
fn a_height_is_the_speed_that_it_gives() {
    let dropped = answer(arguments("ballistic", &["--speed-m-s", "--height-m=0.5", "--gravity-m-s2=9"]));
    let thrown = answer(arguments("ballistic", &["--speed-m-s=3", "--gravity-m-s2=9"]));
    assert_eq!(dropped["impacts"], thrown["impacts"]);
}

#[test]
fn a_thick_body_stands_on_its_corners_and_may_turn_over() {
    // Length 2, thickness 1 and radius of gyration 1 at 45 degrees: the free end gets 5/9 of the jump of the struck
    // one.
    let square = ["--length-m=2", "--gyration-m=1", "--thickness-m=1", "--tilt-deg=45", "--speed-m-s=1", "--e=0.5"];
    let got = answer(arguments("finite-tilt", &square));
    let [a, b] = [0, 1].map(|end| got["impacts"][0]["delta_v_m_s"][end].as_f64().unwrap());
    assert!((a - 1.5).abs() < 1e-14 && (b / a - 5.0 / 9.0).abs() < 1e-14, "{a} {b}");
    let over = clatter(arguments("finite-tilt", &["--thickness-m=0.05", "--spin-rad-s=60", "--tilt-deg=60"]));
    assert_eq!(over.exit, Exit::Done);
    assert!(
        over.stdout.contains("\nBody of 0.14 m by 0.05 m") && over.stdout.contains("\nTurned over at"),
        "{}",
        over.stdout
    );
}

#[test]
fn overlapping_contacts_are_told() {
    let overlap = clatter(arguments("compliant", &["--contact-time-s=3e-3", "--tilt-deg=3"]));
    assert_eq!(overlap.exit, Exit::Done);
    assert!(overlap.stderr.starts_with("warning: "), "{}", overlap.stderr);
    assert!(overlap.stderr.contains("while the other end still presses, the first is number 2"), "{}", overlap.stderr);
    let apart = clatter(arguments("compliant", &["--contact-time-s=3e-4", "--impact-limit=3"]));
    assert!(!apart.stderr.contains("presses"), "{}", apart.stderr);
}

/// The answer, whatever is told beside it.
pub(crate) fn simulated(arguments: impl IntoIterator<Item = impl Into<String>>) -> Value {
    let outcome = clatter(arguments.into_iter().map(Into::into).chain(["--format=json".to_owned()]));
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    serde_json::from_str(&outcome.stdout).unwrap()
}

/// The largest force over the mass of a file of rows.
fn largest_force(rows: &[Vec<f64>], column: usize) -> f64 {
    rows.iter().map(|row| row[column]).fold(0.0, f64::max)
}

/// One contact of 2e-4 s, alone: its largest acceleration is that of the half-sine of its area and length, by the default
/// law; a dashpot's jumps at the touch.
#[test]
fn a_contact_law_can_be_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("motion.csv");
    let output = format!("--output={}", file.display());
    // At 20° end b is far from the ground meanwhile.
    let lone = ["--contact-time-s=2e-4", "--gravity-m-s2=0", "--impact-limit=1", "--tilt-deg=20", "--at=-1"];
    let run = |law: &[&str], e: &str| {
        let got = simulated(arguments("compliant", &[&lone[..], law, &[e, "--time-limit-s=3e-4", &output]].concat()));
        let (heading, rows) = history(&file);
        let column = heading.iter().position(|name| name == "force_per_mass_a_m_s2").unwrap();
        (got, largest_force(&rows, column), rows)
    };
    let (got, force, _) = run(&[], "--e=0.2");
    assert_eq!((&got["drop"]["contact_law"], &got["drop"]["contact_time_s"]), (&"hysteretic".into(), &2e-4.into()));
    // The force on end a gives the center of mass its change of velocity.
    let center = {
        let [a, b] = [0, 1].map(|end| got["impacts"][0]["delta_v_m_s"][end].as_f64().unwrap());
        0.5 * (a + b)
    };
    let half_sine = std::f64::consts::FRAC_PI_2 * center / 2e-4;
    assert!((force / half_sine - 1.0).abs() < 2e-3, "{force}, not {half_sine}");
    let (same, again, _) = run(&["--contact-law=hysteretic"], "--e=0.2");
    assert_eq!((same, again.to_bits()), (got, force.to_bits()));
    let (dashpot, harder, _) = run(&["--contact-law=dashpot"], "--e=0.2");
    assert_eq!(dashpot["drop"]["contact_law"], "dashpot");
    assert!(harder > 1.2 * half_sine, "{harder}: below e = 0.3 it is largest as it touches");
    for e in ["--e=0", "--e=1"] {
        let (got, ..) = run(&[], e);
        let e: f64 = e[4..].parse().unwrap();
        let a = got["impacts"][0]["delta_v_m_s"][0].as_f64().unwrap();
        assert!((a / ((1.0 + e) * 4.43) - 1.0).abs() < 2e-3, "{a} at e = {e}");
    }
    let whole = simulated(arguments("compliant", &["--contact-time-s=2e-4"]));
    assert!(whole["energy_error"].as_f64().unwrap() < 1e-3, "{}", whole["energy_error"]);
}

#[test]
fn a_contact_that_a_limit_cuts_off_is_unfinished() {
    let cut = ["--contact-time-s=4e-4", "--time-limit-s=1e-4", "--at=0"];
    let outcome = clatter(arguments("compliant", &[&cut[..], &["--format=json"]].concat()));
    assert_eq!(outcome.exit, Exit::Done);
    assert_eq!(
        outcome.stderr,
        "warning: 1 contact is cut off there, the first is that of number 1: what it does in all is not known\n"
    );
    let got: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let first = &got["impacts"][0];
    assert_eq!((&first["unfinished"], &first["until_s"]), (&json!(true), &json!("infinite")));
    assert_eq!((&first["delta_v_m_s"], &first["delta_v_at_m_s"]), (&json!([null, null]), &json!([null])));
    assert_eq!((&first["time_s"], &first["approach_m_s"]), (&json!(0.0), &json!(-4.43)));
    for format in ["table", "csv"] {
        let shown = clatter(arguments("compliant", &[&cut[..], &[&format!("--format={format}")]].concat())).stdout;
        assert_eq!(shown.lines().last().unwrap().matches("unfinished").count(), 4, "until and three shocks: {shown}");
    }
    // What a limit of number leaves pressing is unfinished as well, what has parted before is not.
    let list = clatter(arguments("compliant", &["--contact-time-s=4e-4", "--impact-limit=2", "--format=csv"])).stdout;
    let unfinished: Vec<bool> = list.lines().skip(1).map(|line| line.contains("unfinished")).collect();
    assert!(unfinished.len() == 2 && !unfinished[0], "{list}");
    let rest = simulated(arguments("compliant", &["--contact-time-s=4e-4"]));
    assert_eq!(rest["stop"]["reason"], "at-rest");
    for impact in rest["impacts"].as_array().unwrap() {
        assert!(impact.get("unfinished").is_none() && impact["delta_v_m_s"][0].is_number(), "{impact}");
    }
}

/// The rows go on until the last contact has parted: its force ends at 0, above the ground.
#[test]
fn a_motion_goes_on_until_the_last_contact_has_parted() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("motion.csv");
    let output = format!("--output={}", file.display());
    let got = simulated(arguments("compliant", &["--contact-time-s=4e-4", "--gravity-m-s2=0", &output]));
    assert_eq!(got["stop"]["reason"], "bounced-clear");
    let parted = got["impacts"].as_array().unwrap().iter().map(|i| i["until_s"].as_f64().unwrap()).fold(0.0, f64::max);
    let (heading, rows) = history(&file);
    let last = rows.last().unwrap();
    assert!(last[0] >= parted, "{} s, and the last contact parts at {parted} s", last[0]);
    for name in ["force_per_mass_a_m_s2", "force_per_mass_b_m_s2"] {
        let column = heading.iter().position(|has| has == name).unwrap();
        assert!(last[column].abs() < 1e-9, "{name} {last:?}");
    }
}

#[test]
fn every_strike_that_overlaps_another_is_counted() {
    let light = ["--contact-time-s=3e-3", "--tilt-deg=0.5", "--gyration-m=0.0125", "--format=json"];
    let overlap = clatter(arguments("compliant", &light));
    assert_eq!(overlap.exit, Exit::Done, "{}", overlap.stderr);
    let told: usize = overlap.stderr.split_whitespace().nth(1).unwrap().parse().unwrap();
    let got: Value = serde_json::from_str(&overlap.stdout).unwrap();
    let impacts = got["impacts"].as_array().unwrap();
    let until = |i: usize| impacts[i]["until_s"].as_f64().unwrap_or(f64::INFINITY);
    let from = |i: usize| impacts[i]["time_s"].as_f64().unwrap();
    let pressed = (0..impacts.len()).filter(|&i| (0..i).any(|before| from(i) < until(before))).count();
    assert!(told > 1 && told == pressed, "{told}, not {pressed}: {}", overlap.stderr);
}

/// A motion in a csv file: its headings and its rows.
fn history(file: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = fs::read_to_string(file).unwrap();
    let (heading, rows) = text.split_once('\n').unwrap();
    let row = |line: &str| line.split(',').map(|number| number.parse().unwrap()).collect();
    (heading.split(',').map(str::to_owned).collect(), rows.lines().map(row).collect())
}

#[test]
fn a_motion_in_csv_steps_at_every_strike_by_its_shock() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("motion.csv");
    let output = format!("--output={}", file.display());
    for model in ["map", "ballistic", "finite-tilt"] {
        let got = answer(arguments(model, &["--center-of-mass=0.2", "--at=0.5", &output]));
        let (heading, rows) = history(&file);
        let names = "time_s height_a_m height_b_m velocity_a_m_s velocity_b_m_s velocity_at_0.5_m_s";
        assert_eq!(heading.join(" "), names);
        for impact in got["impacts"].as_array().unwrap() {
            let time = impact["time_s"].as_f64().unwrap().to_bits();
            let at = |rows: &&[Vec<f64>]| rows.iter().all(|row| row[0].to_bits() == time);
            let shock = impact["delta_v_at_m_s"][0].as_f64().unwrap();
            let steps = rows.windows(2).filter(at).map(|pair| pair[1][5] - pair[0][5]);
            // One of the steps of this instant; velocities about 4 m/s round.
            let nearest = steps.map(|step| (step - shock).abs()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-14, "{model}: {impact}, {nearest}");
        }
        assert!(rows.iter().all(|row| row[1] >= 0.0 && row[2] >= 0.0), "{model}: nothing below the ground");
    }
}

#[test]
fn a_motion_in_json_is_the_answer_with_its_rows() {
    let folder = tempfile::tempdir().unwrap();
    let [json_file, csv_file] = ["motion.json", "motion.csv"].map(|name| folder.path().join(name));
    let call = |file: &Path| {
        let output = format!("--output={}", file.display());
        answer(arguments("compliant", &["--contact-time-s=1e-4", "--time-limit-s=0.01", "--at=0", &output]))
    };
    let (got, again) = (call(&json_file), call(&csv_file));
    assert_eq!(got, again);
    let mut whole: Value = serde_json::from_str(&fs::read_to_string(&json_file).unwrap()).unwrap();
    let fields = whole.as_object_mut().unwrap();
    let (rows, _) = (fields.remove("history").unwrap(), fields.remove("clatter"));
    assert_eq!(whole, got);
    let (heading, lines) = history(&csv_file);
    let column = |name: &str| heading.iter().position(|has| has == name).unwrap();
    assert_eq!(rows.as_array().unwrap().len(), lines.len());
    for (row, line) in rows.as_array().unwrap().iter().zip(&lines) {
        assert_eq!(row["time_s"], json!(line[column("time_s")]));
        assert_eq!(row["force_per_mass_m_s2"][1], json!(line[column("force_per_mass_b_m_s2")]));
        assert_eq!(row["acceleration_at_m_s2"][0], json!(line[column("acceleration_at_0.0_m_s2")]));
    }
}

#[test]
fn a_picture_marks_every_strike_that_can_be_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("drop.svg");
    let output = format!("--output={}", file.display());
    assert_eq!(clatter(arguments("map", &["--gyration-m=0.0404145", &output])).exit, Exit::Done);
    let svg = fs::read_to_string(&file).unwrap();
    assert!(svg.contains("4 impacts, bounced clear at 47"), "{svg}");
    // Four strikes on the ground of the whole and three of them magnified.
    let marks = svg.matches("a1.9 1.9 0 1 0 3.8").count();
    let tips = 2 * (3 + 3); // the fourth shock is too small to be seen
    assert_eq!(marks, 4 + 3 + tips);
    assert!(!svg.contains("NaN"), "{svg}");
    let outcome = clatter(arguments("compliant", &["--contact-time-s=5e-4", "--at=0", &output]));
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    assert!(fs::read_to_string(&file).unwrap().contains("acceleration, gn"));
}

#[test]
fn people_see_what_happens() {
    let shown = clatter(arguments("map", &["--at=0"]));
    assert_eq!((shown.exit, shown.stderr.as_str()), (Exit::Done, ""));
    assert_snapshot!(shown.stdout, @"
    Small tilt, no gravity, instant impacts
    Body of 0.14 m, radius of gyration 0.0400000 m, q = 0.507692; e = 0.3
    End a touches at 4.43000 m/s, tilt 5 degrees; end b is 0.0122018 m higher

    Impacts                            4
    Bounced clear at           0.0137840 s
    Largest shock, end a         5.75900 m/s
                   end b         9.55994 m/s
                   at 0          2.35322 m/s

       impact  end          time      approach    shock at a    shock at b    shock at 0
                               s           m/s           m/s           m/s           m/s
            1  a               0      -4.43000       5.75900      -2.92380       1.41760
            2  b      0.00165925      -7.35380      -4.85351       9.55994       2.35322
            3  a      0.00228491      -3.52451       4.58186      -2.32618       1.12784
            4  b       0.0137840     -0.120035    -0.0792233      0.156046     0.0384113
    ");
}
