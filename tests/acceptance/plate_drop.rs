//! Drops of plates in time: `simulate` and `respond` with a width.

use clatter::{Plate, PlateStart};
use clatter_cli::Exit;
use serde_json::{Value, json};

use crate::{answer, clatter};

const SIZE: [&str; 4] = ["--length-m=0.15", "--width-m=0.07", "--gyration-m=0.04,0.02", "--e=0.3"];
const GAPS: &str = "--gaps-m=0.004,0.002";
const CONTACTS: [&str; 2] = ["--model=compliant", "--contact-time-s=0.0005"];

fn with<'a>(command: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [command].iter().chain(&SIZE).chain(more).copied().collect()
}

fn names(object: &Value) -> String {
    let mut names: Vec<_> = object.as_object().unwrap().keys().map(String::as_str).collect();
    names.sort_unstable();
    names.join(" ")
}

fn number(of: &Value, name: &str) -> f64 {
    of[name].as_f64().unwrap_or_else(|| panic!("{name} of {of}"))
}

#[test]
fn strikes_of_a_plate_have_corners_and_four_shocks() {
    for law in ["hysteretic", "dashpot"] {
        let law = format!("--contact-law={law}");
        let more = [&CONTACTS[..], &[GAPS, "--speed-m-s=3", "--at=1,-1", "--at=0,0", &law]].concat();
        let got = answer(with("simulate", &more));
        assert_eq!(
            names(&got),
            "at drop energy_error impact_limit impacts largest_delta_v_at_m_s largest_delta_v_m_s model stop time_limit_s"
        );
        assert_eq!(got["stop"]["reason"], "at-rest");
        assert!(number(&got, "energy_error") < 1e-9, "{got}");
        let impacts = got["impacts"].as_array().unwrap();
        assert_eq!(names(&impacts[0]), "approach_m_s corner delta_v_at_m_s delta_v_m_s number time_s until_s");
        assert_eq!((&impacts[0]["corner"], &impacts[0]["approach_m_s"]), (&json!("a"), &json!(-3.0)));
        for impact in impacts {
            let dv: Vec<f64> = impact["delta_v_m_s"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
            assert!((dv[0] + dv[2] - dv[1] - dv[3]).abs() < 1e-12, "the plate stays plane: {impact}");
            assert!((impact["delta_v_at_m_s"][0].as_f64().unwrap() - dv[1]).abs() < 1e-12, "at corner b: {impact}");
            let middle = 0.25 * dv.iter().sum::<f64>();
            assert!((impact["delta_v_at_m_s"][1].as_f64().unwrap() - middle).abs() < 1e-12, "{impact}");
        }
    }
}

/// Tilt and direction say the same as the heights of b and d; lengths with units the same as in SI.
#[test]
fn a_drop_may_be_said_in_several_ways() {
    let more = [&CONTACTS[..], &["--speed-m-s=3", "--tilt-deg=2", "--direction-deg=30"]].concat();
    let by_tilt = answer(with("simulate", &more));
    let [tilt, direction] = [2.0_f64, 30.0].map(f64::to_radians);
    let gaps = [0.15 * tilt.sin() * direction.cos(), 0.07 * tilt.sin() * direction.sin()];
    let gaps_flag = format!("--gaps-m={:?},{:?}", gaps[0], gaps[1]);
    let more = [&CONTACTS[..], &["--speed-m-s=3", &gaps_flag]].concat();
    let by_gaps = answer(with("simulate", &more));
    assert!(crate::typed::alike(&by_tilt["impacts"], &by_gaps["impacts"]), "{by_tilt}, not {by_gaps}");
    for (angle, want) in [("tilt_rad", tilt), ("direction_rad", direction)] {
        assert!((number(&by_gaps["drop"], angle) - want).abs() < 1e-11, "{by_gaps}");
    }
    let typed = answer([
        "simulate",
        "--model=compliant",
        "--length=150mm",
        "--width=70mm",
        "--gyration=40mm,20mm",
        "--e=30%",
        "--speed=3m/s",
        "--contact-time=0.5ms",
        "--tilt=2deg",
        "--direction=30deg",
    ]);
    assert_eq!(typed["impacts"][1]["corner"], by_tilt["impacts"][1]["corner"]);
    let off = number(&typed["impacts"][1], "time_s") / number(&by_tilt["impacts"][1], "time_s") - 1.0;
    assert!(off.abs() < 1e-12, "{off:e}");
}

#[test]
fn short_contacts_without_gravity_are_the_map() {
    let common = ["--gravity-m-s2=0", "--speed-m-s=3", GAPS, "--center-of-mass=0.1,-0.2"];
    let map = answer(with("simulate", &[&["--model=map"], &common[..]].concat()));
    let short = answer(with("simulate", &[&["--model=compliant", "--contact-time-s=1e-7"], &common[..]].concat()));
    let plate = Plate::off_center([0.04 / 0.075, 0.02 / 0.035], [0.1, -0.2], 0.3).unwrap();
    let start = PlateStart::new([-3.0; 3], [0.004, 0.002]).unwrap();
    let train: Vec<_> = plate.train(&start).collect();
    let [map_impacts, impacts] = [&map, &short].map(|of| of["impacts"].as_array().unwrap());
    assert_eq!(map_impacts.len(), train.len());
    assert!(impacts.len() >= 3, "{short}");
    for (k, ((map, short), impact)) in map_impacts.iter().zip(impacts).zip(&train).enumerate().take(3) {
        assert_eq!(map["corner"], json!(impact.corner.letter()));
        assert_eq!(map["corner"], short["corner"], "impact {k}");
        for i in 0..4 {
            // Edges and center are worked out from one another.
            assert!((map["delta_v_m_s"][i].as_f64().unwrap() - impact.delta_v[i]).abs() < 1e-12, "{map} {impact:?}");
            let off = map["delta_v_m_s"][i].as_f64().unwrap() - short["delta_v_m_s"][i].as_f64().unwrap();
            assert!(off.abs() < 3e-3, "impact {k}, corner {i}: {off:e}");
        }
    }
    assert_eq!(map["stop"]["reason"], "bounced-clear");
}

/// With little gravity it begins as the map and comes back; with gravity it lies still in the end, having felt as many shocks as it has
/// strikes, with mass that lies askew or not.
#[test]
fn a_plate_falls_and_bounces_without_a_contact_time() {
    let drop = |model: &str, gravity: &str| {
        let gravity = format!("--gravity-m-s2={gravity}");
        answer(with("simulate", &[&format!("--model={model}"), &gravity, "--speed-m-s=3", GAPS, "--at=0,0"]))
    };
    let [map, low] = [drop("map", "9.8"), drop("ballistic", "1e-6")];
    let [train, impacts] = [&map, &low].map(|of| of["impacts"].as_array().unwrap());
    assert!(train.len() >= 3 && impacts.len() > train.len(), "{low}");
    for (one, two) in train.iter().zip(impacts) {
        assert_eq!(one["corner"], two["corner"]);
        // Over the time of the train gravity gives some 1e-8 m/s.
        assert!((number(one, "approach_m_s") - number(two, "approach_m_s")).abs() < 1e-7, "{one} {two}");
    }
    let got = drop("ballistic", "9.8");
    assert_eq!((names(&got), &got["model"]), (names(&map), &json!("ballistic")));
    assert_eq!((&got["stop"]["reason"], &got["stop"]["time_bound_s"]), (&json!("at-rest"), &Value::Null));
    assert!(number(&got["stop"], "shock_bound_m_s") < 1e-14, "{}", got["stop"]);
    // The ground gives the center of mass, in the middle, what the fall has brought, but for what it gives to corners that lie.
    let taken: f64 = got["impacts"].as_array().unwrap().iter().map(|s| s["delta_v_at_m_s"][0].as_f64().unwrap()).sum();
    let fallen = 3.0 + 9.8 * number(&got["stop"], "time_s");
    assert!(taken > 3.0 && taken < fallen, "{taken} of {fallen}");
    let more = ["--model=ballistic", "--product-of-inertia-m2=2e-4", "--speed-m-s=3", GAPS];
    let table = clatter(with("simulate", &more));
    assert_eq!((table.exit, table.stderr.as_str()), (Exit::Done, ""), "{}", table.stdout);
    for word in ["Small tilt, gravity 9.80665 m/s², instant impacts", "At rest at", "--all lists every one"] {
        assert!(table.stdout.contains(word), "{word}: {}", table.stdout);
    }
    let csv = clatter(with("simulate", &[&more[..], &["--format=csv"]].concat()));
    let heading = "number,corner,time_s,approach_m_s,delta_v_a_m_s,delta_v_b_m_s,delta_v_c_m_s,delta_v_d_m_s";
    assert_eq!(csv.stdout.lines().next(), Some(heading));
}

/// A place feels at a corner what its strike gives it, and a stiff part there the acceleration of the place.
#[test]
fn a_part_on_a_plate_is_answered() {
    let more = [&CONTACTS[..], &[GAPS, "--speed-m-s=3", "--gravity-m-s2=0", "--at=-1,-1"]].concat();
    let place = answer(with("respond", &more));
    let strikes = answer(with("simulate", &more));
    let at_a = strikes["impacts"].as_array().unwrap().iter().map(|s| s["delta_v_m_s"][0].as_f64().unwrap().abs());
    // The first strike presses alone; later ones overlap, and add up or take from one another.
    let change = number(&place, "velocity_change_m_s");
    assert!(change >= 1.3 * 3.0 * 0.999 && change <= at_a.sum(), "{place}");
    // A quarter sine and a quarter cosine: π/2 of the mean.
    let peak = number(&place, "acceleration_m_s2");
    assert!(peak >= std::f64::consts::FRAC_PI_2 * 1.3 * 3.0 / 5e-4 * 0.999, "{place}");
    assert!(place.get("omega").is_none());
    let stiff = answer(with("respond", &[&more[..], &["--omega=1e7", "--damping=0.3"]].concat()));
    assert_eq!(
        names(&stiff),
        "acceleration_m_s2 angular_velocity_change_rad_s answers clatter_free damping drop gain omega omega_peak_relative_displacement \
         peak_absolute_acceleration_over_omega peaks standard time_of_peak velocity_change_m_s"
    );
    let felt = number(&stiff, "peak_absolute_acceleration_over_omega") * 1e7;
    assert!((felt / peak - 1.0).abs() < 1e-3, "{felt} {peak}");
    let error = number(&stiff["answers"]["part_acceleration"], "error");
    assert!((0.0..0.1).contains(&error), "{stiff}");
}

/// The flat plate is no special case: one half-sine everywhere, no turn.
#[test]
fn a_flat_plate_does_not_turn() {
    let got = answer(with("respond", &[&CONTACTS[..], &["--tilt-deg=0", "--speed-m-s=3", "--at=0.3,0.4"]].concat()));
    // Roundings grow from bounce to bounce.
    assert!(number(&got, "angular_velocity_change_rad_s") < 1e-6 * 3.0 / 0.02, "{got}");
    assert!((number(&got, "velocity_change_m_s") / 3.9 - 1.0).abs() < 2e-3, "{got}");
    assert_eq!(got["drop"]["drop"]["tilt_rad"], 0.0);
}

#[test]
fn tables_and_rows_tell_the_same() {
    let more = [&CONTACTS[..], &["--speed-m-s=3", "--tilt-deg=2", "--direction-deg=45", "--at=0,0"]].concat();
    let table = clatter(with("simulate", &more));
    assert_eq!((table.exit, table.stderr.as_str()), (Exit::Done, ""), "{}", table.stdout);
    for word in ["Body of 0.15 m by 0.07 m", "corner c", "At rest at", "hysteretic contacts of 0.0005 s"] {
        assert!(table.stdout.contains(word), "{word}: {}", table.stdout);
    }
    assert!(table.stdout.lines().all(|line| line.chars().count() <= 100), "{}", table.stdout);
    let csv = clatter(with("simulate", &[&more[..], &["--format=csv"]].concat()));
    let json = answer(with("simulate", &more));
    let rows: Vec<&str> = csv.stdout.lines().collect();
    assert_eq!(
        rows[0],
        "number,corner,time_s,until_s,approach_m_s,delta_v_a_m_s,delta_v_b_m_s,delta_v_c_m_s,delta_v_d_m_s,delta_v_at_0.0_0.0_m_s"
    );
    assert_eq!(rows.len() - 1, json["impacts"].as_array().unwrap().len());
    assert!(rows[1].starts_with("1,a,0.0,"), "{}", rows[1]);
    let part = clatter(with("respond", &[&more[..], &["--frequency=180Hz"]].concat()));
    assert_eq!((part.exit, part.stderr.as_str()), (Exit::Done, ""), "{}", part.stdout);
    assert!(part.stdout.contains("Component at 0, 0 of a body of 0.15 m by 0.07 m"), "{}", part.stdout);
}

#[test]
fn a_steep_plate_is_told_of() {
    let steep = [&CONTACTS[..], &["--speed-m-s=3", "--tilt-deg=20", "--direction-deg=45"]].concat();
    let steep = clatter(with("simulate", &steep));
    let warned = "warning: a plate is followed as if almost level: at a tilt of 20 degrees";
    assert!(steep.stderr.contains(warned), "{}", steep.stderr);
}

/// Corners without restitution stay where they have loaded, until three of them hold the plate.
#[test]
fn a_dead_plate_comes_to_rest() {
    let dead =
        ["simulate", "--length-m=0.15", "--width-m=0.07", "--gyration-m=0.04,0.02", "--e=0", GAPS, "--speed-m-s=3"];
    let got = answer(dead.iter().chain(&CONTACTS));
    assert_eq!(got["stop"]["reason"], "at-rest");
    let impacts = got["impacts"].as_array().unwrap();
    assert!(impacts.iter().any(|impact| impact["until_s"] == "infinite"), "{got}");
    assert!((impacts[0]["delta_v_m_s"][0].as_f64().unwrap() - 3.0).abs() < 0.1, "{got}");
}

/// Each row: what is added to a drop of a plate, and what the message has to say.
#[test]
fn what_a_plate_has_not_is_refused() {
    let refused: &[(&str, &[&str], &[&str])] = &[
        ("simulate", &["--model=finite-tilt", GAPS], &["--model", "finite-tilt", "map", "ballistic", "compliant"]),
        ("simulate", &["--model=ballistic", "--contact-time-s=1e-3", GAPS], &["--contact-time", "compliant"]),
        ("simulate", &["--model=map", "--product-of-inertia-m2=1e-4", GAPS], &["--product-of-inertia-m2", "ballistic"]),
        ("respond", &["--model=ballistic", GAPS, "--at=0,0"], &["by the model compliant, not by ballistic"]),
        ("simulate", &["--model=compliant", GAPS], &["--contact-time=TIME"]),
        ("simulate", &["--model=map", "--contact-time-s=1e-3", GAPS], &["--contact-time", "compliant"]),
        ("simulate", &["--model=map"], &["--tilt=ANGLE and --direction=ANGLE, or --gaps=HX,HY"]),
        ("simulate", &["--model=map", "--tilt-deg=2"], &["--direction=ANGLE"]),
        ("simulate", &["--model=map", "--tilt-deg=2", "--direction-deg=91"], &["91", "[0, 90]"]),
        ("simulate", &["--model=map", "--tilt-deg=2", "--gaps-m=0,0"], &["--tilt-deg", "--gaps-m"]),
        ("simulate", &["--model=map", "--gaps-m=0.2,0"], &["--gaps", "0.2", "the side along which it rises"]),
        ("simulate", &["--model=map", "--gaps-m=-1e-3,0"], &["--gaps", "-0.001"]),
        ("simulate", &["--model=map", "--gaps-m=1e-3"], &["--gaps-m", "two values are needed"]),
        ("simulate", &["--model=map", GAPS, "--at=0"], &["--at", "two values for a plate"]),
        ("simulate", &["--model=map", GAPS, "--at=0,2"], &["--at", "2", "[-1, 1]"]),
        ("simulate", &["--model=map", GAPS, "--at=0,40mm"], &["--at", "40 mm", "beyond the ends"]),
        ("simulate", &["--model=map", GAPS, "--center-of-mass=0.1"], &["--center-of-mass", "two values for a plate"]),
        ("simulate", &["--model=map", GAPS, "--center-of-mass=0.1,1"], &["--center-of-mass", "1"]),
        ("simulate", &["--model=map", GAPS, "--spin-rad-s=1"], &["--spin", "plate"]),
        ("simulate", &["--model=map", GAPS, "--thickness-m=0.01"], &["three values for a box", "not two"]),
        ("simulate", &["--model=map", GAPS, "-o", "x.svg"], &["-o", "plate"]),
        ("respond", &["--model=map", GAPS, "--at=0,0"], &["by the model compliant, not by map"]),
        ("respond", &["--model=compliant", "--contact-time-s=1e-3", GAPS], &["--at=X,Y"]),
        (
            "respond",
            &["--model=compliant", "--contact-time-s=1e-3", GAPS, "--at=0,0", "--first=b"],
            &["--first", "plate"],
        ),
    ];
    for (command, more, words) in refused {
        let outcome = clatter(with(command, &[more, &["--speed-m-s=3"][..]].concat()));
        assert!(outcome.exit == Exit::BadInput && outcome.stdout.is_empty(), "{more:?}: {}", outcome.stdout);
        for word in *words {
            assert!(outcome.stderr.contains(word), "{more:?}: no '{word}' in {}", outcome.stderr);
        }
    }
    // A bar takes one value of each, and no gaps.
    for (more, word) in [
        (vec!["--gyration-m=0.04,0.02", "--tilt-deg=2"], "a width"),
        (vec!["--gyration-m=0.04", GAPS], "give its width"),
        (vec!["--gyration-m=0.04", "--tilt-deg=2", "--direction-deg=3"], "give its width"),
        (vec!["--gyration-m=0.04", "--tilt-deg=2", "--at=0,0"], "--width"),
    ] {
        let bar =
            ["simulate", "--model=map", "--length-m=0.15", "--e=0.3", "--speed-m-s=3"].into_iter().chain(more.clone());
        let outcome = clatter(bar);
        assert!(outcome.exit == Exit::BadInput && outcome.stderr.contains(word), "{more:?}: {}", outcome.stderr);
    }
    let thin =
        ["simulate", "--length-m=0.15", "--width-m=0.07", "--gyration-m=0.04,0.003", "--e=0.3", GAPS, "--speed-m-s=3"];
    let thin = clatter(thin.iter().chain(&CONTACTS));
    assert!(thin.stderr.contains("--gyration-m") && thin.stderr.contains("at least 3.5 mm"), "{}", thin.stderr);
}

/// The middle of the ranges of a product file with a width, and another direction, on whose lowest corner it lands: the same drop as arguments
/// say it, seen from that corner.
#[test]
fn a_product_file_of_a_plate_gives_its_drop() {
    let path = crate::assess::example("handheld-terminal.toml");
    let product = format!("--product={path}");
    // What was taken of each range is told beside the answer.
    let taken = |words: [&str; 5]| -> Value {
        let outcome = clatter(words.into_iter().chain(["--format=json"]));
        assert!(outcome.stderr.contains("restitution = 0.25, the largest of 0.15 to 0.25"), "{}", outcome.stderr);
        serde_json::from_str(&outcome.stdout).unwrap()
    };
    let got = taken(["respond", &product, "--component=gyroscope", "--tilt=3deg", "--direction=200deg"]);
    let (drop, body) = (&got["drop"]["drop"], &got["drop"]["drop"]["body"]);
    assert!((number(drop, "direction_rad").to_degrees() - 200.0).abs() < 1e-12, "{drop}");
    let limit = &got["limits"][0];
    assert_eq!((limit["limit"].as_str(), limit["unit"].as_str()), (Some("angular-velocity-change"), Some("rad/s")));
    let ends = |side: &str| [0, 1].map(|end| body[side]["ends_m"][end].as_f64().unwrap());
    let [length, width] = ["length", "width"].map(|side| ends(side).iter().sum::<f64>());
    let [cx, cy] = ["length", "width"].map(|side| (ends(side)[0] - ends(side)[1]) / (ends(side)[0] + ends(side)[1]));
    let [kx, ky] = ["length", "width"].map(|side| number(&body[side], "gyration_m"));
    // The masses of the file: battery and scan engine lie askew.
    let product_m2 = {
        let masses = [(0.28, 0.0, 0.0), (0.11, -0.06, -0.01), (0.03, 0.095, 0.015)];
        let all: f64 = masses.iter().map(|m| m.0).sum();
        let [mx, my] = [0.5 * cx * length, 0.5 * cy * width];
        masses.iter().map(|(m, x, y)| m / all * (x - mx) * (y - my)).sum::<f64>()
    };
    let same = answer([
        "respond",
        "--model=compliant",
        &format!("--length-m={length:?}"),
        &format!("--width-m={width:?}"),
        &format!("--gyration-m={kx:?},{ky:?}"),
        &format!("--center-of-mass={:?},{:?}", -cx, -cy),
        &format!("--product-of-inertia-m2={product_m2:?}"),
        "--e=0.25",
        "--contact-time=1ms",
        "--height=1.5m",
        "--tilt=3deg",
        "--direction=20deg",
        &format!("--at={:?},{:?}", 0.04 / length, 0.05 / width),
    ]);
    for value in ["velocity_change_m_s", "acceleration_m_s2", "angular_velocity_change_rad_s"] {
        assert!((number(&got, value) / number(&same, value) - 1.0).abs() < 1e-6, "{value}: {got} beside {same}");
    }
    // The same strikes in `simulate`, called from the lowest corner.
    let flight = taken(["simulate", &product, "--component=gyroscope", "--tilt=3deg", "--direction=200deg"]);
    assert_eq!(flight["impacts"][0]["corner"].as_str(), Some("a"));
    let at = [0, 1].map(|i| flight["at"][0][i].as_f64().unwrap());
    assert!((at[0] - 0.04 / length).abs() + (at[1] - 0.05 / width).abs() < 1e-9, "{at:?}");
    let wrong = clatter(["respond", &product, "--component=gyroscope", "--first=b"]);
    assert_eq!(wrong.exit, Exit::BadInput);
    assert!(wrong.stderr.contains("'--first': it is that of a bar"), "{}", wrong.stderr);
}
