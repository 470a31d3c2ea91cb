//! `clatter respond`: one component, driven by one clatter.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use clatter_cli::Exit;
use insta::assert_snapshot;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::typed::alike;
use crate::{answer, clatter};

#[derive(Deserialize)]
struct Case {
    #[serde(rename = "case")]
    name: String,
    q: f64,
    e: f64,
    position: f64,
    omega: f64,
    damping: f64,
    omega_peak_relative_displacement: String,
    peak_absolute_acceleration_over_omega: String,
}

/// 75 components computed with 30 digits; endless trains there are cut after 300 impacts, when they are over.
#[test]
fn peaks_are_those_of_30_digit_arithmetic() {
    #[derive(Deserialize)]
    struct Oracle {
        cases: Vec<Case>,
    }
    let oracle: Oracle =
        serde_json::from_str(include_str!("../../crates/clatter-shock/tests/data/response.json")).unwrap();
    assert_eq!(oracle.cases.len(), 75);
    for c in oracle.cases {
        let got = answer([
            "respond".to_owned(),
            format!("--q={:?}", c.q),
            format!("--e={:?}", c.e),
            format!("--at={:?}", c.position),
            format!("--omega={:?}", c.omega),
            format!("--damping={:?}", c.damping),
        ]);
        for (name, want) in [
            ("omega_peak_relative_displacement", c.omega_peak_relative_displacement),
            ("peak_absolute_acceleration_over_omega", c.peak_absolute_acceleration_over_omega),
        ] {
            let (got, want) = (got[name].as_f64().unwrap(), want.parse::<f64>().unwrap());
            assert!((got - want).abs() <= 1e-12 * want.abs(), "{}: {name} {got:?}, not {want:?}", c.name);
        }
    }
}

#[test]
fn respond_explains_itself() {
    let shown = clatter(["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=3", "--damping=0"]);
    assert_eq!((shown.exit, shown.stderr.as_str()), (Exit::Done, ""));
    // Without damping an impulse gives back its own size; 2.145 is the largest shock of the paper's first bar.
    assert_snapshot!(shown.stdout, @"
    Component at 1 of a bar with q = 0.5, e = 0.3; W = 3 v0/h0, damping ratio 0
    End a strikes first, at -1 v0; end b comes with -1 v0 from 1 h0

    Peak                                        v0   when, h0/v0
      relative displacement, W z           1.95337       17.9362  after impact 4, the last
      relative velocity                    2.38880      0.695054  after impact 2
      absolute acceleration, A/W           1.95337       17.9362  after impact 4, the last

    A shock at this position             shock, v0       W z, v0       A/W, v0
      of the net change, W h0/v0 -> 0      1.00214       1.00214       1.00214
      the largest, W h0/v0 -> infinity     2.14500             -             -
      without clatter, (1 + e) v0          1.30000       1.30000       1.30000
      as standards assume, 2 v0            2.00000       2.00000       2.00000

    W h0/v0 = 3.00000; acceleration over that of the standards' shock: 0.976683
    ");
}

#[test]
fn the_fields_are_those_of_the_contract() {
    let got = answer(["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=1e-6", "--damping=0"]);
    let net = &answer(["impacts", "--q=0.5", "--e=0.3"])["net"]["b"];
    // Slow and undamped: the net change at end b, to the square of the phase.
    for field in ["omega_peak_relative_displacement", "peak_absolute_acceleration_over_omega"] {
        assert!((got[field].as_f64().unwrap() - net.as_f64().unwrap()).abs() < 1e-9, "{field}: {got}");
    }
    assert_eq!(got["stiff"], Value::Null, "no such limit without damping");
    assert_eq!(got["peaks"]["absolute_acceleration_over_omega"]["positive"]["after_impact"], json!(4));
    assert_eq!(got["time_of_peak"], got["peaks"]["absolute_acceleration_over_omega"]["positive"]["time"]);
    assert_eq!(got["shocks"]["count"], json!(4));
}

#[test]
fn only_the_ratio_of_frequency_to_drop_matters() {
    let unit = answer(["respond", "--q=0.73", "--e=0.2", "--at=-0.5", "--omega=8"]);
    let si =
        answer(["respond", "--q=0.73", "--e=0.2", "--at=-0.5", "--omega=64", "--velocity=-2,-2", "--height-gap=0.25"]);
    let of = |got: &Value, name: &str| got[name].as_f64().unwrap();
    // Powers of two scale without rounding.
    for name in ["omega_peak_relative_displacement", "peak_absolute_acceleration_over_omega"] {
        assert_eq!(json!(2.0 * of(&unit, name)), si[name], "{name}");
    }
    assert_eq!(json!(0.125 * of(&unit, "time_of_peak")), si["time_of_peak"]);
    assert_eq!(unit["gain"], si["gain"]);
}

/// One shock, whose peaks as velocities do not depend on the frequency: also where z or A itself is beyond the floats.
#[test]
fn frequencies_at_the_ends_of_the_floats_have_answers() {
    let drop = [
        "respond",
        "--gyration-ratio=0.49",
        "--e=0",
        "--velocity=-1,0.25",
        "--height-gap=0",
        "--at=0",
        "--damping=1.75",
    ];
    let of = |omega: &str| answer(drop.iter().copied().chain([omega]));
    let unit = of("--omega=1");
    assert!(unit["omega_peak_relative_displacement"].as_f64().unwrap() > 0.09, "{unit}");
    for omega in ["--omega=5e-324", "--omega=1e-310", "--omega=1e308"] {
        for name in ["omega_peak_relative_displacement", "peak_absolute_acceleration_over_omega", "gain", "stiff"] {
            assert_eq!(of(omega)[name], unit[name], "{name} at {omega}");
        }
    }
}

#[test]
fn quality_factor_and_damping_ratio_are_one_thing() {
    let part = ["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=3"];
    let with = |more: &[&str]| answer(part.iter().chain(more));
    assert_eq!(with(&["--q-factor=10"]), with(&["--damping=0.05"]));
    assert_eq!(with(&[]), with(&["--q-factor=10"]), "Q = 10 unless told otherwise");
    assert_eq!(with(&["--q-factor=inf"]), with(&["--damping=0"]));
}

#[test]
fn a_flat_drop_is_its_net_change_and_the_way_there() {
    let got = answer(["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=3", "--damping=0", "--height-gap=0"]);
    let net = answer(["impacts", "--q=0.5", "--e=0.3"])["net"]["b"].as_f64().unwrap();
    // All at one instant: the displacement knows the sum alone.
    let got = got["omega_peak_relative_displacement"].as_f64().unwrap();
    assert!((got - net).abs() < 1e-15, "{got} and {net}");
}

#[test]
fn endless_trains_have_a_bound_on_what_is_left_out() {
    let got = answer(["respond", "--q=0.9", "--e=0.2", "--at=1", "--omega=5"]);
    let omitted = got["shocks"]["omitted"].as_f64().unwrap();
    assert!(0.0 < omitted && omitted < 1e-15, "{omitted:e}");
    let still = answer(["respond", "--q=1", "--e=0.2", "--at=0", "--omega=5"]);
    assert_eq!(still["peak_absolute_acceleration_over_omega"], json!(0.0), "nothing moves the center");
    assert_eq!(still["shocks"]["omitted"], json!(0.0), "of nothing, nothing is left out");
    let table = clatter(["respond", "--q=1", "--e=0.2", "--at=0", "--omega=5", "--damping=0.05"]).stdout;
    assert!(
        table.contains("absolute acceleration, A/W                 0             0  no impact is felt here\n"),
        "{table}"
    );
    assert!(!table.contains("infinite"), "{table}");
}

#[test]
fn the_rule_can_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let part = ["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=3", "-o"];
    let write = |name: &str| {
        let file = folder.path().join(name);
        let outcome = clatter(part.iter().copied().chain([file.to_str().unwrap()]));
        assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
        fs::read_to_string(file).unwrap()
    };
    let csv = write("rule.csv");
    assert!(csv.starts_with("omega,displacement,acceleration,gain\n0.01,"), "{}", &csv[..60]);
    let json: Value = serde_json::from_str(&write("rule.json")).unwrap();
    let row: Vec<f64> = csv.lines().nth(201).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    let got = ["omega", "displacement", "acceleration", "gain"].map(|name| json[name][200].as_f64().unwrap());
    assert_eq!(row, got);
    assert_eq!(json["omega"].as_array().unwrap().len(), csv.lines().count() - 1);
    let svg = write("rule.svg");
    for word in ["largest shock alone", "net change alone", "this component"] {
        assert!(svg.contains(word), "{word}");
    }
}

fn of(got: &Value, name: &str) -> f64 {
    got[name].as_f64().unwrap_or_else(|| panic!("{name} of {got}"))
}

const PEAKS: [&str; 2] = ["omega_peak_relative_displacement", "peak_absolute_acceleration_over_omega"];

fn written(folder: &Path, name: &str, text: &str) -> String {
    let file = folder.join(name);
    fs::write(&file, text).unwrap();
    file.to_str().unwrap().to_owned()
}

/// The impacts of a bar, written as a file of shocks, do what the bar does.
#[test]
fn shocks_of_a_file_are_those_of_the_bar_that_made_them() {
    let folder = tempfile::tempdir().unwrap();
    let impacts = answer(["impacts", "--q=0.73", "--e=0.2", "--at=0.7"]);
    let mut text = String::from("number,delta_v_m_s,time_s\n");
    for impact in impacts["impacts"].as_array().unwrap() {
        writeln!(text, "{},{},{}", impact["number"], impact["delta_v_at"][0], impact["time"]).unwrap();
    }
    let file = format!("--shocks-file={}", written(folder.path(), "shocks.csv", &text));
    let got = answer(["respond", &file, "--omega=8"]);
    let bar = answer(["respond", "--q=0.73", "--e=0.2", "--at=0.7", "--omega=8"]);
    for name in PEAKS {
        assert!((of(&got, name) / of(&bar, name) - 1.0).abs() < 1e-12, "{name}: {got}");
    }
    assert_eq!(
        got["peaks"]["relative_velocity"]["positive"]["after_impact"],
        bar["peaks"]["relative_velocity"]["positive"]["after_impact"]
    );
    assert_eq!(got["shocks"]["count"], json!(16));
}

/// In step with an undamped component each of a million shocks adds to its swing, and each of a million half-sines.
#[test]
fn a_million_shocks_and_a_million_pulses_come_from_files() {
    let folder = tempfile::tempdir().unwrap();
    let (mut shocks, mut pulses) =
        (String::from("time_s,delta_v_m_s\n"), String::from("shape,amplitude_m_s2,duration_s,start_s\n"));
    let one = "rectangle,1,5e-4,0\n";
    for k in 0..1_000_000_u32 {
        let time = f64::from(k) * 1e-3;
        writeln!(shocks, "{time:?},0.25").unwrap();
        writeln!(pulses, "rectangle,1,5e-4,{time:?}").unwrap();
    }
    let omega = format!("--omega={:?}", 2e3 * std::f64::consts::PI);
    let respond = |name: &str, text: &str, flag: &str| {
        answer(["respond", &format!("--{flag}={}", written(folder.path(), name, text)), &omega, "--damping=0"])
    };
    let got = respond("shocks.csv", &shocks, "shocks-file");
    assert!((of(&got, PEAKS[0]) / 0.25e6 - 1.0).abs() < 1e-6, "{}", got[PEAKS[0]]);
    let single =
        respond("one.csv", &format!("{}{one}", pulses.lines().next().unwrap().to_owned() + "\n"), "pulses-file");
    let got = respond("pulses.csv", &pulses, "pulses-file");
    assert!((of(&got, PEAKS[0]) / (1e6 * of(&single, PEAKS[0])) - 1.0).abs() < 1e-6, "{}", got[PEAKS[0]]);
    assert_eq!(got["peaks"]["omega_relative_displacement"]["positive"]["after_impact"], json!(1_000_000));
}

/// Shocks, pulses and tests in the notations of records: other separators, decimal commas, units in headings.
#[test]
fn lists_come_in_any_notation() {
    let folder = tempfile::tempdir().unwrap();
    let same = |command: &[&str], flag: &str, plain: &str, other: &str| {
        let of = |text: &str| {
            let file = format!("--{flag}={}", written(folder.path(), "list.csv", text));
            answer([command, &[&file]].concat())
        };
        assert_eq!(of(plain), of(other), "{other}");
    };
    same(
        &["respond", "--omega=100"],
        "shocks-file",
        "time_s,delta_v_m_s\n0,1.5\n0.25,-2\n",
        "drop 5\ntime [ms];delta v [mm/s];note\n0;1500;a\n250,0;-2000;b\n",
    );
    same(
        &["respond", "--omega=100"],
        "pulses-file",
        "shape,amplitude_m_s2,duration_s,start_s\nhalf-sine,500,0.0025,0.5\n",
        "shape\tstart [s]\tduration [ms]\tamplitude [m/s^2]\nhalf-sine\t0,5\t2,5\t500\n",
    );
    same(
        &["spectrum", "--pulse=rectangle,300,0.004", "--damage-boundary", "--frequency=100"],
        "tests",
        "test,level,damaged\nvelocity-change,2.5,no\nvelocity-change,3,yes\nacceleration,500,no\nacceleration,600,yes\n",
        "# tests\ntest;level;damaged\nvelocity-change;2,5;no\nvelocity-change;3;yes\nacceleration;500;no\nacceleration;600;yes\n",
    );
}

#[test]
fn lists_that_are_none_are_told_by_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let pulses = "shape,amplitude_m_s2,duration_s,start_s\n";
    for (flag, text, said) in [
        ("shocks-file", "", "line 1: no rows; the first line is time_s,delta_v_m_s, a row for each follows"),
        (
            "shocks-file",
            "time_s,delta_v_m_s\n",
            "line 1: no rows; the first line is time_s,delta_v_m_s, a row for each follows",
        ),
        (
            "shocks-file",
            "0,1\n",
            "line 1: no column time_s; the first line names the columns, time_s,delta_v_m_s among them",
        ),
        (
            "shocks-file",
            "time_s,delta_v_m_s\n0,1\n\n1\n",
            "line 4: 1 cell, and the header has 2 cells: each row must have as many, a cell with a comma in quotes",
        ),
        ("shocks-file", "time_s,delta_v_m_s\n0,NaN\n", "line 2: delta_v_m_s: 'NaN' is not a number such as 0.5"),
        ("shocks-file", "time_s,delta_v_m_s\n0,1 m/s\n", "line 2: delta_v_m_s: '1 m/s' is not a number such as 0.5"),
        (
            "shocks-file",
            "delta_v_m_s,time_s\n1,2\n1,1\n",
            "line 3: time_s 1.0 is before 2.0, the row above; sort by time",
        ),
        (
            "pulses-file",
            &format!("{pulses}half-sine,1,0,0\n"),
            "line 2: a pulse of zero duration is a velocity shock: give its velocity change in a file of shocks \
             (--shocks-file), or a duration > 0",
        ),
        (
            "pulses-file",
            &format!("{pulses}half-sine,1,1,0\nhalf-sine,1,-1,0\n"),
            "line 3: duration = -1.0 is not at least 2.3e-308",
        ),
        (
            "pulses-file",
            &format!("{pulses}half-sine,1e13,1,0\n"),
            "line 2: amplitude = 10000000000000.0 is not in [1e-12, 1e12]",
        ),
        (
            "pulses-file",
            "shape,amplitude_m_s2,start_s\n",
            "line 1: no column duration_s; the first line names the columns, shape,amplitude_m_s2,duration_s,start_s among them",
        ),
    ] {
        let file = written(folder.path(), "list.csv", text);
        let flag = format!("--{flag}={file}");
        for command in [&["respond", "--omega=1", &flag][..], &["spectrum", "--frequency=1", &flag]] {
            let outcome = clatter(command);
            assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{text:?}");
            assert_eq!(outcome.stderr, format!("error: {file}: {said}\n"));
        }
    }
    let shape = written(folder.path(), "list.csv", &format!("{pulses}sine,1,1,0\n"));
    let outcome = clatter(["respond", "--omega=1", &format!("--pulses-file={shape}")]);
    assert!(outcome.stderr.starts_with(&format!("error: {shape}: line 2: 'sine' is no shape")), "{}", outcome.stderr);
    let missing = clatter(["respond", "--omega=1", "--shocks-file=nowhere.csv"]);
    assert!(missing.stderr.starts_with("error: cannot read nowhere.csv: "), "{}", missing.stderr);
}

const DROP: [&str; 6] =
    ["--length-m=0.14", "--gyration-m=0.045", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--omega=1131"];

/// At small tilt without gravity the drop in meters is the bar of h0 and v0.
#[test]
fn the_map_in_meters_is_the_bar() {
    let gap = 0.14 * 4_f64.to_radians().sin();
    let [k, gap] = [format!("--gyration-ratio={:?}", 0.045 / 0.07), format!("--height-gap={gap:?}")];
    for at in ["--at=-1", "--at=0.3", "--at=1"] {
        let got = answer(["respond", "--model=map", at].into_iter().chain(DROP));
        let bar = answer(["respond", &k, "--e=0.3", "--velocity=-3,-3", &gap, "--omega=1131", at]);
        for name in [PEAKS[0], PEAKS[1], "time_of_peak", "gain"] {
            assert!((of(&got, name) / of(&bar, name) - 1.0).abs() < 1e-9, "{name} {at}: {got}, not {bar}");
        }
        let (largest, shock) = (of(&bar["shocks"], "largest"), of(&got, "velocity_change_m_s"));
        assert!((shock / largest - 1.0).abs() < 1e-12, "{shock} m/s, not {largest}");
        for name in ["standard", "clatter_free"] {
            let [got, bar] = [&got, &bar].map(|answer| of(&answer[name], PEAKS[0]));
            assert!((got / bar - 1.0).abs() < 1e-12, "{name}");
        }
    }
}

/// Every model as an assessment answers it, the center of mass off the middle.
#[test]
fn drops_drive_components_as_in_an_assessment() {
    use clatter_assess::Part;
    use clatter_flight::Body;
    use clatter_product::{Drop, Model};
    use clatter_shock::{DampingRatio, Suspension};
    let contact_s = 4e-4;
    let drop = Drop {
        gravity_m_s2: 9.806_65,
        contact_time_s: Some(contact_s),
        ..Drop::new(Body::off_center(0.07 * 1.2, 0.07 * 0.8, 0.045).unwrap(), 3.0, 4_f64.to_radians(), 0.3)
    };
    let part = Suspension::new(1131.0, DampingRatio::new(0.05).unwrap()).unwrap();
    for model in Model::FOLLOWED {
        let contact = (model == Model::Compliant).then(|| format!("--contact-time-s={contact_s:?}"));
        for at in [-1.0, -0.4, 0.0, 1.0] {
            let (want, _) = clatter_assess::respond(&drop, &Part::new(0.07 * at, None), &part, model, 0.01).unwrap();
            let arguments = ["respond".to_owned(), format!("--model={}", model.name()), format!("--at={at:?}")];
            let more = DROP.map(str::to_owned).into_iter().chain(["--center-of-mass=0.2".to_owned()]);
            let got = answer(arguments.into_iter().chain(more).chain(contact.clone()));
            let want = [want.pseudo_velocity().magnitude(), want.acceleration_over_omega().magnitude()];
            for (peak, want) in PEAKS.iter().zip(want) {
                assert!((of(&got, peak) / want - 1.0).abs() < 1e-9, "{} at {at}: {got}, not {want}", model.name());
            }
        }
    }
}

/// A part that is mounted rigidly goes through what its place goes through: of instant impacts the shocks that a simulation
/// lists, and half-sines of them where a contact time is given.
#[test]
fn a_rigid_part_feels_its_place() {
    let body = &DROP[..5];
    for model in ["map", "ballistic", "finite-tilt"] {
        let name = format!("--model={model}");
        for s in [-1.0, 0.25, 1.0] {
            let at = format!("--at={s:?}");
            let got = answer(["respond", &name, &at].iter().chain(body));
            assert!(PEAKS.iter().all(|peak| got.get(peak).is_none()) && got.get("omega").is_none(), "{got}");
            assert_eq!(got["acceleration_m_s2"], Value::Null, "the contact time is not known");
            let flight = answer(["simulate", &name, &at].iter().chain(body));
            let impacts = flight["impacts"].as_array().unwrap();
            let most = |of: &dyn Fn(&Value) -> f64| impacts.iter().map(|i| of(i).abs()).fold(0.0, f64::max);
            let shock = most(&|impact| impact["delta_v_at_m_s"][0].as_f64().unwrap());
            assert!(
                (of(&got, "velocity_change_m_s") / shock - 1.0).abs() < 1e-12,
                "{model} at {s}: {got}, not {shock}"
            );
            let turn = |i: &Value| i["delta_v_m_s"][1].as_f64().unwrap() - i["delta_v_m_s"][0].as_f64().unwrap();
            // At 4° the ends' vertical velocities are those of the turn times a cosine of it, nearly.
            let (turn, told) = (most(&|impact| turn(impact) / 0.14), of(&got, "angular_velocity_change_rad_s"));
            let near = if model == "finite-tilt" { 5e-3 } else { 1e-9 };
            assert!((told / turn - 1.0).abs() < near, "{model}: {told}, not {turn}");
            let timed = answer(["respond", &name, &at, "--contact-time-s=5e-4"].iter().chain(body));
            let half_sine = std::f64::consts::FRAC_PI_2 * shock / 5e-4;
            assert!((of(&timed, "acceleration_m_s2") / half_sine - 1.0).abs() < 1e-12, "{timed}, not {half_sine}");
        }
    }
    // Beside a response they are the same.
    let rigid = answer(["respond", "--model=compliant", "--contact-time-s=4e-4", "--at=0.5"].iter().chain(body));
    let held = answer(["respond", "--model=compliant", "--contact-time-s=4e-4", "--at=0.5"].into_iter().chain(DROP));
    for name in ["velocity_change_m_s", "acceleration_m_s2", "angular_velocity_change_rad_s"] {
        assert_eq!(rigid[name], held[name], "{name}");
        assert!(of(&rigid, name) > 0.0, "{rigid}");
    }
}

/// Both ends at once: no turn. All mass in the center: that feels nothing.
#[test]
fn what_is_not_felt_is_none() {
    let flat = ["--length-m=0.14", "--gyration-m=0.045", "--e=0.3", "--speed-m-s=3", "--tilt-deg=0"];
    let got = answer(["respond", "--model=compliant", "--contact-time-s=4e-4", "--at=0.5"].iter().chain(&flat));
    assert_eq!(got["angular_velocity_change_rad_s"], json!(0.0), "{got}");
    // (1 + e) v0 in all; both ends together press longer than one alone, and what counts is a change within that time.
    let change = of(&got, "velocity_change_m_s");
    assert!((0.9..1.005).contains(&(change / 3.9)), "{change}");
    let point = ["--length-m=0.14", "--gyration-m=0", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--gravity-m-s2=0"];
    let outcome = clatter(["respond", "--model=map", "--at=0"].iter().chain(&point));
    assert!(outcome.exit == Exit::BadInput || outcome.stdout.contains("change of velocity, m/s"), "{}", outcome.stderr);
}

#[test]
fn a_contact_law_and_a_tolerance_can_be_asked_for() {
    let stiff = ["--length-m=0.14", "--gyration-m=0.045", "--e=0.05", "--speed-m-s=3", "--tilt-deg=4", "--omega=20000"];
    let with = |more: &[&str]| {
        let drop = ["respond", "--model=compliant", "--contact-time-s=4e-4", "--at=0.8"];
        answer(drop.iter().chain(&stiff).chain(more))
    };
    let (default, dashpot) = (with(&[]), with(&["--contact-law=dashpot"]));
    assert_eq!(default, with(&["--contact-law=hysteretic", "--tolerance=1%"]));
    let law = |answer: &Value| answer["drop"]["drop"]["contact_law"].clone();
    assert_eq!((law(&default), law(&dashpot)), (json!("hysteretic"), json!("dashpot")));
    assert!(of(&dashpot, PEAKS[1]) > 1.2 * of(&default, PEAKS[1]), "a dashpot's edge shakes a stiff part harder");
    let close = with(&["--tolerance=0.1%"]);
    assert!((of(&close, PEAKS[1]) / of(&default, PEAKS[1]) - 1.0).abs() < 0.01, "{close}, not {default}");
    assert_eq!(close["drop"]["tolerance"], json!(0.001));
}

/// Each end has the contact that is given for it, in whatever order.
#[test]
fn every_end_has_the_contact_that_is_given_for_it() {
    let with = |contacts: &[&str]| {
        let drop = ["respond", "--model=compliant", "--contact-time-s=4e-4", "--at=0.8"];
        of(&answer(drop.iter().chain(&DROP).chain(contacts)), PEAKS[1])
    };
    let (a, b) = ("--contact=a,0.1,8e-4", "--contact=b,0.6,3e-4");
    let [both, turned, first, second] = [with(&[a, b]), with(&[b, a]), with(&[a]), with(&[b])];
    assert_eq!(both.to_bits(), turned.to_bits());
    assert!((both / first - 1.0).abs() > 0.01 && (both / second - 1.0).abs() > 0.01, "{both}, {first}, {second}");
}

/// Contacts of a few microseconds are instants to a component of 180 Hz.
#[test]
fn short_contacts_are_velocity_shocks() {
    let instant = answer(["respond", "--model=finite-tilt", "--at=1"].into_iter().chain(DROP));
    let short = answer(["respond", "--model=compliant", "--contact-time-s=2e-6", "--at=1"].into_iter().chain(DROP));
    for name in PEAKS {
        assert!((of(&short, name) / of(&instant, name) - 1.0).abs() < 1e-2, "{name}: {short}, not {instant}");
    }
    assert_eq!((&short["stiff"], short["drop"]["model"].as_str()), (&Value::Null, Some("compliant")));
    let [a, b] = [&short, &instant].map(|answer| of(answer, "time_of_peak"));
    assert!((a - b).abs() < 1e-5, "{a}, not {b}");
}

/// The service condition of a shock test that is named does at least as much to the component, the next lower one less; of a hard drop none does.
#[test]
fn the_least_service_condition_covers_the_drop() {
    let drop = ["respond", "--model=ballistic", "--at=1", "--equivalent-pulse"];
    let got = answer(drop.into_iter().chain(DROP));
    let hz = format!("--frequency={:?}", 1131.0 / std::f64::consts::TAU);
    let [z, a] = PEAKS.map(|name| of(&got, name));
    let does = |pulse: &str| {
        let flag = format!("--pulse={pulse}");
        let maximax =
            |quantity: &str| answer(["spectrum", &flag, &hz, "--quantity", quantity])["maximax"][0].as_f64().unwrap();
        [maximax("acceleration") / (1131.0 * a), maximax("pseudo-velocity") / z]
    };
    let found = &got["service_condition"];
    let order = ["C", "D", "E", "A", "F", "B", "G", "H"].map(|name| format!("JESD22-B110/{name}"));
    let first = order.iter().find(|pulse| does(pulse).into_iter().all(|ratio| ratio >= 1.0));
    assert_eq!(found["pulse"].as_str(), first.map(String::as_str), "{found}");
    let shown = clatter(drop.into_iter().chain(DROP)).stdout;
    match first {
        Some(pulse) => {
            let [acceleration, displacement] = does(pulse);
            assert!((of(found, "acceleration_ratio") / acceleration - 1.0).abs() < 1e-9, "{found}");
            assert!((of(found, "displacement_ratio") / displacement - 1.0).abs() < 1e-9, "{found}");
            assert!(shown.contains(&format!("Shock test: {pulse} (")), "{shown}");
        }
        None => assert!(shown.contains("no service condition of JESD22-B110 does as much"), "{shown}"),
    }
    // Ten times as fast nothing covers it.
    let fast: Vec<_> =
        DROP.into_iter().map(|flag| if flag.starts_with("--speed") { "--speed-m-s=60" } else { flag }).collect();
    let none = answer(drop.into_iter().chain(fast.iter().copied()).chain(["--shock-table=0.2:20,50000,500"]));
    assert_eq!(none["service_condition"], Value::Null, "{none}");
}

/// The half-sine that is named gives the component the same acceleration, and within 1 % the same displacement.
#[test]
fn the_equivalent_pulse_does_the_same() {
    let drop = ["respond", "--model=ballistic", "--at=1", "--equivalent-pulse"];
    let got = answer(drop.into_iter().chain(DROP));
    let pulse = &got["equivalent_pulse"];
    let flag = format!("--pulse=half-sine,{},{}", pulse["acceleration_m_s2"], pulse["duration_s"]);
    let hz = format!("--frequency={:?}", 1131.0 / std::f64::consts::TAU);
    let maximax =
        |quantity: &str| answer(["spectrum", &flag, &hz, "--quantity", quantity])["maximax"][0].as_f64().unwrap();
    let [z, a] = PEAKS.map(|name| of(&got, name));
    assert!((maximax("acceleration") / (1131.0 * a) - 1.0).abs() < 1e-9, "{pulse}");
    let off = maximax("pseudo-velocity") / z - 1.0;
    assert!(off.abs() < 0.01 && (off - of(pulse, "displacement_mismatch")).abs() < 1e-9, "{pulse}: {off}");
    assert!((of(pulse, "acceleration_g") * 9.806_65 / of(pulse, "acceleration_m_s2") - 1.0).abs() < 1e-15, "{pulse}");
    // What a weaker table cannot do it says, and that is an answer.
    let weak = ["--shock-table=0.2:20,5,20"];
    let none = answer(drop.into_iter().chain(DROP).chain(weak));
    assert_eq!(none["equivalent_pulse"], Value::Null);
    let reason = none["no_equivalent_pulse"].as_str().unwrap();
    assert!(reason.starts_with("no half-sine of this shock table is equivalent: "), "{reason}");
    let shown = clatter(drop.into_iter().chain(DROP).chain(weak));
    assert!(shown.stdout.contains("\nShock table: no half-sine of this shock table is equivalent"), "{}", shown.stdout);
    let shown = clatter(drop.into_iter().chain(DROP));
    assert!(shown.stdout.contains("\nShock table: a half-sine of "), "{}", shown.stdout);
    assert_eq!(answer(["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=3"]).get("equivalent_pulse"), None);
}

#[test]
fn where_nothing_is_felt_no_pulse_is_equivalent() {
    let got = answer(["respond", "--q=1", "--e=0.3", "--at=0", "--omega=3", "--velocity=-3,-3", "--equivalent-pulse"]);
    assert_eq!(got["equivalent_pulse"], Value::Null);
    assert_eq!(got["no_equivalent_pulse"], "nothing is felt here, which no pulse does");
}

#[test]
fn columns_of_lists_are_read_once_and_quotes_taken_off() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("list.csv");
    let with = |text: &str, flag: &str, omega: &str| {
        fs::write(&path, text).unwrap();
        clatter(["respond", &format!("{flag}={}", path.display()), omega])
    };
    let twice = with("time_s,delta_v_m_s,time_s\n0,1,2\n", "--shocks-file", "--omega=10");
    assert!(twice.stderr.contains("line 1: columns 1 and 3 are both named time_s"), "{}", twice.stderr);
    let quoted = with("\"time_s\",\"delta_v_m_s\"\n\"0\",\"1\"\n", "--shocks-file", "--omega=10");
    assert_eq!((quoted.exit, quoted.stderr.as_str()), (Exit::Done, ""));
    let slow =
        with("shape,amplitude_m_s2,duration_s,start_s\nhalf-sine,10,1e-3,0\n", "--pulses-file", "--omega=1e-300");
    assert!(slow.stderr.contains("--omega 1e-300 rad/s is not in [1e-100, 1e100]"), "{}", slow.stderr);
}

#[test]
fn a_drop_explains_itself() {
    let free = ["respond", "--model=ballistic", "--at=1", "--damping=0", "--contact-time-s=2e-4"];
    let shown = clatter(free.into_iter().chain(DROP));
    assert_eq!((shown.exit, shown.stderr.as_str()), (Exit::Done, ""));
    assert_snapshot!(shown.stdout, @"
    Component at 1 of a body of 0.14 m, e = 0.3; W = 1131 rad/s, damping ratio 0
    Model ballistic, to 1 %: end a strikes first, at 3.00000 m/s, tilt 4 degrees

    Peak of the part                                     when, s
      acceleration                        805.0 gn    0.00353120  after impact 3
      relative displacement               6.172 mm    0.00353120  after impact 3
      relative displacement, W z       6.98025 m/s    0.00353120  after impact 3
      relative velocity                7.29512 m/s    0.00224462
      absolute acceleration, A/W       6.98025 m/s    0.00353120  after impact 3

    Largest at this position                             when, s
      change of velocity, m/s              6.03177    0.00210951  at impact 2
      acceleration, m/s²                   47373.4    0.00210951  at impact 2, taken for a half-sine of 0.0002 s
      change of angular velocity, rad/s    60.9709    0.00210951  at impact 2

    A shock at this position            shock, m/s      W z, m/s      A/W, m/s
      the largest of this drop             6.03177       6.03177       6.03177
      without clatter, (1 + e) v0          3.90000       3.90000       3.90000
      as standards assume, 2 v0            6.00000       6.00000       6.00000

    W h0/v0 = 3.68175; acceleration over that of the standards' shock: 1.16337
    ");
    let pressed = ["respond", "--model=compliant", "--at=0.5", "--contact-time-s=2e-4", "--tolerance=0.1%"];
    let rigid = clatter(pressed.iter().chain(&DROP[..5]));
    assert_eq!((rigid.exit, rigid.stderr.as_str()), (Exit::Done, ""));
    for said in [
        "Place 0.5 of a body of 0.14 m, e = 0.3; a part there is mounted rigidly\n",
        "Model compliant, to 0.1 %: end a strikes first, at 3.00000 m/s, tilt 4 degrees\nContacts of 0.0002 s, hysteretic\n",
        "\n  change of velocity, m/s ",
        "\n  acceleration, m/s² ",
        "\n  change of angular velocity, rad/s ",
        "\nWithout clatter, (1 + e) v0 everywhere at once: 3.90000 m/s\n",
    ] {
        assert!(rigid.stdout.contains(said), "{said}: {}", rigid.stdout);
    }
    assert!(!rigid.stdout.contains("W z"), "{}", rigid.stdout);
}

/// What is asked of an answer's own error goes to drops next to it: those of a product that stands nearly upright are not beyond.
#[test]
fn a_product_that_stands_nearly_upright_is_answered() {
    for tilt in ["89.7", "89.99"] {
        let arguments = [
            "respond",
            "--model=compliant",
            "--length-m=0.2",
            "--gyration-m=0.06",
            "--e=0.7",
            "--speed-m-s=3",
            &format!("--tilt-deg={tilt}"),
            "--contact-time-s=0.0004",
            "--at=-0.5",
            "--omega=50",
            "--damping=0.02",
        ];
        let answers = &answer(arguments)["answers"];
        assert!(answers["part_displacement"]["error"].as_f64().is_some_and(|error| error < 10.0), "{answers}");
    }
}

/// The answer about a drop of a product file, with notes beside it.
fn noted<S: AsRef<str>>(arguments: impl IntoIterator<Item = S>) -> Value {
    let arguments: Vec<String> = arguments.into_iter().map(|argument| argument.as_ref().to_owned()).collect();
    let outcome = clatter(arguments.iter().map(String::as_str).chain(["--format=json"]));
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    serde_json::from_str(&outcome.stdout).unwrap()
}

/// Ranges of everything, a part that extends, either end first, the center of mass off the middle.
const RANGES: &str = r#"
[product]
name = "Ranges"
length = "140 mm"
center_of_mass = "6 mm"
radius_of_gyration = "38 mm"
restitution = [0.25, 0.4]
contact_time = ["0.3 ms", "0.5 ms"]
contact_law = "hysteretic"
[drop]
height = ["0.9 m", "1.2 m"]
tilt = ["2 deg", "9 deg"]
[[component]]
name = "display"
position = "10 mm"
extent = "80 mm"
natural_frequency = ["200 Hz", "220 Hz"]
quality_factor = 12
acceleration_limit = "1600 gn"
rattle_space = "8 mm"
[[component]]
name = "gyroscope"
position = "-20 mm"
mount = "hard"
angular_velocity_change_limit = "180 rad/s"
damage_boundary = { velocity_change = "3 m/s", acceleration = "5000 gn" }
"#;

/// The worst drop is answered again with the numbers of the assessment, each limit in its unit and at the worst end.
#[test]
fn the_worst_drop_of_a_part_is_what_the_assessment_says() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(dir.path(), "ranges.toml", RANGES);
    let assessed: Value = serde_json::from_str(&clatter(["assess", &path, "--format=json"]).stdout).unwrap();
    for part in assessed["components"].as_array().unwrap() {
        let arguments = [
            "respond",
            &format!("--product={path}"),
            &format!("--component={}", part["name"].as_str().unwrap()),
            "--worst",
        ];
        let outcome = clatter(arguments.iter().chain(&["--format=json"]));
        assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
        let got: Value = serde_json::from_str(&outcome.stdout).unwrap();
        assert!(outcome.stderr.contains("note: Ranges: the worst drop of its ranges, for the "), "{}", outcome.stderr);
        let worst = &part["worst_case"];
        assert!(alike(&got["drop"], &worst["drop"]), "{got}, not {worst}");
        let tightest = |limits: &'_ Value| {
            let all = limits.as_array().unwrap().clone();
            let share = |limit: &Value| {
                let value = limit.get("demand").or(limit.get("value")).and_then(Value::as_f64);
                value.map_or(-1.0, |value| value / of(limit, "allowed"))
            };
            all.into_iter().max_by(|a, b| share(a).total_cmp(&share(b))).unwrap()
        };
        let (told, again) = (tightest(&part["limits"]), tightest(&got["limits"]));
        assert_eq!(
            (&again["limit"], &again["unit"], &again["allowed"]),
            (&told["limit"], &told["unit"], &told["allowed"])
        );
        assert!((of(&again, "value") / of(&told, "demand") - 1.0).abs() < 1e-9, "{again}, not {told}");
        assert!((of(&again, "share") - of(&told, "demand") / of(&told, "allowed")).abs() < 1e-9, "{again}");
        assert_eq!(again["impact"], told["worst_case"]["impact"]);
        assert!((of(&again, "time_s") - of(&told["worst_case"], "time_s")).abs() < 1e-12, "{again}, not {told}");
        if again["limit"] != "angular-velocity-change" {
            let at_m = again["position_m"][0].as_f64().unwrap();
            assert!((at_m - of(&told["worst_case"], "position_m")).abs() < 1e-12, "{again}");
        }
        // No limit asks for more in this drop than in its own worst one.
        for (here, there) in got["limits"].as_array().unwrap().iter().zip(part["limits"].as_array().unwrap()) {
            let most = of(there, "demand") * (1.0 + of(there, "uncertainty"));
            assert!(here["unit"] != there["unit"] || of(here, "value") <= most, "{here}, {there}");
        }
        let table = clatter(arguments).stdout;
        let (head, title) = (format!("end {} strikes first", worst["first"].as_str().unwrap()), "\nLimits of ");
        assert!(table.contains(&head) && table.contains(title), "{table}");
    }
    let table = clatter(["respond", &format!("--product={path}"), "--component=display", "--worst"]).stdout;
    assert!(table.contains(" gn") && table.contains("8.000 mm") && table.contains("1600 gn"), "{table}");
    let refused = clatter(["respond", &format!("--product={path}"), "--component=display", "--worst", "--tilt=2deg"]);
    assert!(
        refused.exit == Exit::BadInput && refused.stderr.contains("'--worst[=<LIMIT>]' cannot be used with"),
        "{}",
        refused.stderr
    );
    let nameless = clatter(["respond", &format!("--product={path}"), "--worst"]);
    assert!(nameless.exit == Exit::BadInput && nameless.stderr.contains("--component=NAME"), "{}", nameless.stderr);
}

/// With end b first the product is seen from behind, and its places stay those of the product: the same as the product turned around.
#[test]
fn a_drop_onto_end_b_is_the_product_turned_around() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(dir.path(), "ranges.toml", RANGES);
    let around =
        RANGES.replace("\"6 mm\"", "\"-6 mm\"").replace("\"10 mm\"", "\"-10 mm\"").replace("\"-20 mm\"", "\"20 mm\"");
    let around = written(dir.path(), "around.toml", &around);
    for (part, at) in [("display", None), ("gyroscope", None), ("display", Some(0.3))] {
        let ask = |path: &str, first: &str, at: Option<f64>| {
            let at = at.map(|at| format!("--at={at:?}"));
            let arguments = [
                "respond".to_owned(),
                format!("--product={path}"),
                format!("--component={part}"),
                format!("--first={first}"),
                "--tilt-deg=4".to_owned(),
            ];
            noted(arguments.into_iter().chain(at))
        };
        let (b, a) = (ask(&path, "b", at), ask(&around, "a", at.map(|at| -at)));
        let along = |got: &Value| got["drop"]["place"]["at_m"][0].as_f64().unwrap();
        let ends =
            |got: &Value| [0, 1].map(|end| got["drop"]["drop"]["body"]["length"]["ends_m"][end].as_f64().unwrap());
        assert_eq!(
            (of(&b["drop"]["drop"], "direction_rad"), of(&a["drop"]["drop"], "direction_rad")),
            (std::f64::consts::PI, 0.0)
        );
        assert!((along(&b) + along(&a)).abs() < 1e-12 && (ends(&b)[0] - ends(&a)[1]).abs() < 1e-12, "{b}, {a}");
        for name in ["velocity_change_m_s", "acceleration_m_s2", "angular_velocity_change_rad_s"] {
            assert!((of(&b, name) / of(&a, name) - 1.0).abs() < 1e-12, "{name}: {b}, not {a}");
        }
        for (b, a) in b["limits"].as_array().unwrap().iter().zip(a["limits"].as_array().unwrap()) {
            assert!(
                (of(b, "value") / of(a, "value") - 1.0).abs() < 1e-12 && b["impact"] == a["impact"],
                "{b}, not {a}"
            );
            let [b_m, a_m] = [b, a].map(|limit| limit["position_m"][0].as_f64().unwrap());
            assert!((b_m + a_m).abs() < 1e-12, "{b}, {a}");
        }
        // The other end first asks for something else.
        let ratio = of(&ask(&path, "a", at), "velocity_change_m_s") / of(&b, "velocity_change_m_s");
        assert!((ratio - 1.0).abs() > 1e-3, "{ratio}");
    }
}

/// An extended part is answered at the end that asks most, each limit at its own.
#[test]
fn an_extended_part_is_answered_at_its_worst_end() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(dir.path(), "ranges.toml", RANGES);
    let ask = |more: &[&str]| {
        let arguments = ["respond", &format!("--product={path}"), "--component=display", "--first=a", "--tilt-deg=5"];
        noted(arguments.iter().chain(more))
    };
    let got = ask(&[]);
    let ends = [ask(&["--at=-30mm"]), ask(&["--at=50mm"])];
    for (k, limit) in got["limits"].as_array().unwrap().iter().enumerate() {
        let most = ends.iter().map(|end| of(&end["limits"][k], "value")).fold(0.0, f64::max);
        assert!((of(limit, "value") / most - 1.0).abs() < 1e-12, "{limit}, not {most}");
    }
    let at = |got: &Value| got["drop"]["place"]["at_m"][0].clone();
    let worst = ends.iter().max_by(|a, b| of(a, PEAKS[1]).total_cmp(&of(b, PEAKS[1]))).unwrap();
    assert_eq!((at(&got), of(&got, PEAKS[1])), (at(worst), of(worst, PEAKS[1])), "{got}");
    // The share is that of the value of the part itself.
    let limit = &got["limits"][0];
    let acceleration = of(&got, "omega") * of(&got, PEAKS[1]);
    assert!((of(limit, "share") / (acceleration / (1600.0 * 9.806_65)) - 1.0).abs() < 1e-9, "{limit}, {acceleration}");
}

/// A product of these values, and what a drop of it asks of its part.
fn drop_of([restitution, contact, speed, tilt, hz, damping]: [&str; 6], more: &str, flags: &[&str]) -> Value {
    let text = format!(
        "[product]\nname = \"bar\"\nlength = \"150 mm\"\nradius_of_gyration = \"43 mm\"\nrestitution = {restitution}\n\
         contact_time = {contact}\n{more}[drop]\nspeed = {speed}\ntilt = {tilt}\n[[component]]\nname = \"part\"\n\
         position = \"20 mm\"\nnatural_frequency = {hz}\ndamping_ratio = {damping}\nrattle_space = \"9 mm\"\n"
    );
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("bar.toml");
    fs::write(&path, text).unwrap();
    let product = format!("--product={}", path.display());
    let asked = ["respond", &product, "--component=part", "--format=json"];
    let outcome = clatter(asked.iter().chain(flags));
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    serde_json::from_str(&outcome.stdout).unwrap()
}

const VALUES: [&str; 6] = ["0.4", "\"0.3 ms\"", "\"4 m/s\"", "\"4 deg\"", "\"100 Hz\"", "0.02"];

/// Of a range is taken what harms most as a rule: the shortest contact, the least damping, the most bounce and speed; else the middle.
#[test]
fn of_ranges_the_values_are_taken_that_harm_most() {
    let ranges = [
        "[0.2, 0.4]",
        "[\"0.3 ms\", \"0.5 ms\"]",
        "[\"2 m/s\", \"4 m/s\"]",
        "[\"2 deg\", \"6 deg\"]",
        "[\"80 Hz\", \"120 Hz\"]",
        "[0.02, 0.1]",
    ];
    assert_eq!(drop_of(ranges, "", &["--first=a"]), drop_of(VALUES, "", &["--first=a"]));
    for (n, other) in ["0.3", "\"0.4 ms\"", "\"3 m/s\"", "\"5 deg\"", "\"90 Hz\"", "0.05"].into_iter().enumerate() {
        let mut values = VALUES;
        values[n] = other;
        assert_ne!(drop_of(values, "", &["--first=a"]), drop_of(VALUES, "", &["--first=a"]), "{other} changes nothing");
    }
}

/// With end b first the product is seen from behind, and so is a center of mass that is given beside its file: the same but for roundings.
#[test]
fn a_center_of_mass_beside_a_product_is_turned_with_it() {
    for first in ["--first=a", "--first=b"] {
        let of_file = drop_of(VALUES, "center_of_mass = \"6 mm\"\n", &[first]);
        let beside = drop_of(VALUES, "", &[first, "--center-of-mass=6mm"]);
        assert!(alike(&of_file, &beside), "{first}: {of_file} and {beside}");
    }
}
