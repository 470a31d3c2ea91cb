//! What people type: quantities with their units, drops of product files, slips of the unit.

use std::fs;

use clatter_cli::Exit;
use serde_json::Value;

use crate::assess::changed;
use crate::{answer, clatter};

/// One drop with units, and as plain numbers in SI.
const TYPED: [&str; 8] = [
    "--model=compliant",
    "--length=140 mm",
    "--gyration=40mm",
    "--e=30 %",
    "--speed=300 cm/s",
    "--tilt=4deg",
    "--gravity=1 g",
    "--contact-time=400us",
];
const PLAIN: [&str; 8] = [
    "--model=compliant",
    "--length-m=0.14",
    "--gyration-m=0.04",
    "--e=0.3",
    "--speed-m-s=3",
    "--tilt-deg=4",
    "--gravity-m-s2=9.80665",
    "--contact-time-s=4e-4",
];

/// Every number of both is the same to roundings, and every word.
pub(crate) fn alike(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
            (a - b).abs() <= 1e-9 * a.abs().max(b.abs()) + 1e-15
        }
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| alike(a, b)),
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len() && a.iter().all(|(key, a)| b.get(key).is_some_and(|b| alike(a, b)))
        }
        (a, b) => a == b,
    }
}

#[test]
fn quantities_with_units_are_the_plain_numbers_in_si() {
    let part = [["--at=35 mm", "--frequency=0.18 kHz"], ["--at=0.5", "--omega=1130.9733552923256"]];
    for (command, typed, plain) in [
        (
            "simulate",
            &["--at=35mm", "--spin=60rpm", "--until=7ms"][..],
            &["--at=0.5", "--spin-rad-s=6.283185307179586", "--time-limit-s=0.007"][..],
        ),
        ("respond", &part[0], &part[1]),
        (
            "respond",
            &["--at=1.4 cm", "--frequency=900Hz", "--damping=5 %"],
            &["--at=0.2", "--omega=5654.866776461628", "--damping=0.05"],
        ),
    ] {
        let [typed, plain] = [(TYPED, typed), (PLAIN, plain)]
            .map(|(drop, more)| answer(std::iter::once(&command).chain(&drop).chain(more)));
        assert!(alike(&typed, &plain), "{command}\n{typed}\n{plain}");
    }
    let masses = |mass: [&str; 2]| {
        answer(
            ["simulate", "--model=map", "--length=200mm", "--e=0.3", "--speed=4m/s", "--tilt=5deg"].iter().chain(&mass),
        )
    };
    let (typed, plain) =
        (masses(["--mass=200g@-1:1", "--mass=100 g@50mm"]), masses(["--mass=2@-100 mm:10cm", "--mass=1@0.5"]));
    assert!(alike(&typed, &plain), "{typed}\n{plain}");
    let thick = |more: [&str; 2]| {
        let drop = ["simulate", "--model=finite-tilt", "--length=140mm", "--gyration=40mm", "--e=0", "--tilt=0.1rad"];
        answer(drop.iter().chain(&more))
    };
    let (typed, plain) = (thick(["--thickness=1cm", "--height=1.2m"]), thick(["--thickness-m=0.01", "--height-m=1.2"]));
    assert!(alike(&typed, &plain), "{typed}\n{plain}");
}

#[test]
fn pulses_limits_and_lists_take_units_blanks_and_any_case() {
    let spectrum = |more: &[&str]| answer(["spectrum"].iter().chain(more));
    let plain = spectrum(&[
        "--pulse=half-sine,14709.975,0.0005,0,0.002",
        "--frequency=100,1800",
        "--limit=29419.95",
        "--damping=0.05",
    ]);
    for (shape, start) in
        [("half sine", "0 s, 2 ms"), ("Half-Sine", "0,2000us"), ("half-sine", "0s,2e-3s"), ("HALF_SINE", "0,0.002")]
    {
        for amplitude in ["1500g", "1500 G", "14709.975 m/s^2", "14709.975"] {
            let pulse = format!("--pulse={shape}, {amplitude}, 0.5 ms, {start}");
            for limit in ["--limit=3000g", "--limit=29419.95", "--limit=10 Hz:3000 G, 10kHz : 3000 gn"] {
                let mut got = spectrum(&[&pulse, "--frequency=0.1kHz, 1800 Hz", limit, "--damping=5%"]);
                got["limit"]["worst"]["safe"].take();
                let mut plain = plain.clone();
                plain["limit"]["worst"]["safe"].take();
                assert!(alike(&got, &plain), "{pulse} {limit}\n{got}\n{plain}");
            }
        }
    }
    let octaves = [["--frequency=10Hz:10kHz:12", "--shock=2.5 m/s, 0s"], ["--frequency=10:10000:12", "--shock=2.5,0"]];
    let [typed, plain] = octaves.map(|more| spectrum(&more));
    assert!(alike(&typed, &plain));
    let impacts = [" -1, -1", "-1,-1"]
        .map(|velocity| answer(["impacts", "--q=0.5", "--e=0.3", &format!("--velocity={velocity}")]));
    assert_eq!(impacts[0], impacts[1]);
    let table = |table: &str| {
        answer(["respond"].iter().chain(&PLAIN).chain(&[
            "--at=1",
            "--omega=1131",
            "--equivalent-pulse",
            &format!("--shock-table={table}"),
        ]))
    };
    assert!(alike(&table("0.2ms : 20ms, 5000g, 20 m/s"), &table("0.2:20,5000,20")));
}

#[test]
fn tables_are_in_the_units_that_were_typed() {
    let simulated = clatter(["simulate"].iter().chain(&TYPED).chain(&["--at=35mm"])).stdout;
    for said in [
        "Any tilt, gravity 1 gn, hysteretic contacts of 400 us\n",
        "Body of 140 mm, radius of gyration 40.0000 mm, q = 0.507692; e = 0.3\n",
        "End a touches at 300.000 cm/s, tilt 4 degrees; end b is 9.76591 mm higher\n",
        " us\n",
        " cm/s\n",
        "shock at 35 mm\n",
    ] {
        assert!(simulated.contains(said), "{said}:\n{simulated}");
    }
    assert!(!simulated.contains(" m/s\n") && !simulated.contains(" m,"), "{simulated}");
    let responded = clatter(["respond"].iter().chain(&TYPED).chain(&["--at=35mm", "--frequency=180Hz"])).stdout;
    for said in [
        "Component at 35 mm of a body of 140 mm, e = 0.3; 180 Hz, damping ratio 0.05\n",
        "when, us\n",
        "change of velocity, cm/s",
        "acceleration, gn ",
        "shock, cm/s",
    ] {
        assert!(responded.contains(said), "{said}:\n{responded}");
    }
    let spectrum = ["spectrum", "--pulse=half-sine,1000g,1ms", "--frequency=0.1kHz", "--limit=200g"];
    let spectrum = clatter(spectrum.iter().chain(&["--damage-boundary"])).stdout;
    for said in
        ["acceleration in gn,", "kHz          gn", " 0.100000 ", "acceleration         1000.00 gn\n", "at 0.100000 kHz"]
    {
        assert!(spectrum.contains(said), "{said}:\n{spectrum}");
    }
    // JSON and CSV stay in SI.
    assert_eq!(answer(["respond", "--at=0"].iter().chain(&TYPED))["drop"]["drop"]["speed_m_s"], 3.0);
    // Limits of a product are told as its file has them.
    let (_dir, path) = changed(|text| text.replace("1600 gn", "15690.64 m/s^2").replace("\"8 mm\"", "\"0.3 in\""));
    let table = clatter(["assess", &path]).stdout;
    let row = |name: &str| table.lines().find(|line| line.contains(name)).unwrap_or_default().to_owned();
    // Allowed and demand, then flat drop and other law in the columns that follow below.
    assert!(table.matches(" m/s2").count() == 4 && row("display ").contains("15691 m/s2"), "{table}");
    assert!(row("rattle-space ").matches(" in").count() >= 2 && row("rattle-space ").contains("0.3000 in"), "{table}");
}

#[test]
fn the_paper_s_bar_takes_units_for_all_of_its_numbers() {
    let bar = ["respond", "--q=0.5", "--e=0.3", "--at=1"];
    let typed = ["--frequency=180Hz", "--velocity=-485 cm/s, -4.85 m/s", "--height-gap=5mm"];
    let plain = ["--omega=1130.9733552923256", "--velocity=-4.85,-4.85", "--height-gap=0.005"];
    let [got, want] = [typed, plain].map(|more| answer(bar.iter().chain(&more)));
    assert!(alike(&got, &want), "{got}\n{want}");
    let table = clatter(bar.iter().chain(&typed)).stdout;
    for said in
        ["; 180 Hz, damping ratio", "at -485 cm/s; end b comes with -485 cm/s from 5 mm\n", "cm/s       when, s\n"]
    {
        assert!(table.contains(said), "{said}:\n{table}");
    }
    let mixed = clatter(bar.iter().chain(&["--omega=3", "--height-gap=5mm"]));
    assert_eq!(mixed.exit, Exit::BadInput);
    assert!(mixed.stderr.contains("go together with units or without"), "{}", mixed.stderr);
}

#[test]
fn numbers_stand_below_their_headings() {
    let product = changed(|text| text.replace("\"1600 gn\"", "\"1600.123 m/s2\""));
    for arguments in [
        &["impacts", "--q=0.5", "--e=0.3", "--at=0.123456789"][..],
        &[
            "simulate",
            "--model=map",
            "--length=140mm",
            "--gyration=40mm",
            "--e=0.3",
            "--speed=3m/s",
            "--tilt=4deg",
            "--at=12.3456789mm",
        ],
        &["assess", &product.1],
    ] {
        let table = clatter(arguments).stdout;
        let head = table
            .lines()
            .position(|line| line.starts_with("   impact  end") || line.starts_with("component "))
            .unwrap();
        let lines: Vec<_> = table.lines().skip(head).take_while(|line| !line.is_empty()).collect();
        let ends: Vec<_> = lines.iter().map(|line| line.chars().count()).collect();
        assert!(lines.len() > 3 && ends.iter().all(|end| *end == ends[0]), "{arguments:?}:\n{table}");
    }
    let respond = clatter(["respond", "--q=0.73", "--e=0.2", "--at=1", "--omega=3"]).stdout;
    let rows: Vec<_> = respond.lines().skip_while(|line| !line.starts_with("A shock ")).take(5).map(str::len).collect();
    assert_eq!(rows, [rows[0]; 5], "{respond}");
}

#[test]
fn what_is_likely_a_slip_is_told_by_name() {
    for (arguments, said) in [
        (
            &["simulate", "--model=map", "--length=150m", "--gyration=40m", "--e=0.3", "--speed=3m/s", "--tilt=4deg"][..],
            "warning: a length of 150 m is none that products have, from 2 mm to 10 m: 150 mm?\n",
        ),
        (
            &[
                "simulate",
                "--model=map",
                "--length-m=150",
                "--gyration-m=4",
                "--e=0.3",
                "--speed-m-s=3",
                "--tilt-deg=4",
            ],
            "warning: a length of 150 m is none",
        ),
        (
            &["respond", "--q=0.5", "--e=0.3", "--at=0", "--omega=3", "--damping=10"],
            "warning: a damping ratio of 10 is none that products have, from 0 to 1.5: 10 %?\n",
        ),
        (
            &[
                "simulate",
                "--model=map",
                "--length=200mm",
                "--mass=2kg@-1:1",
                "--mass=10g@5m",
                "--e=0.3",
                "--speed=4m/s",
                "--tilt=5deg",
            ],
            "warning: a mass at 5 m is outside of the body, which reaches 100 mm from its middle: 5 mm?\n",
        ),
        (
            &["impacts", "--mass=2@-1:1", "--mass=0.1@3", "--e=0.3"],
            "warning: a mass at 3 is outside of the body, which reaches from -1 to 1",
        ),
    ] {
        let outcome = clatter(arguments);
        assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
        assert!(outcome.stderr.contains(said), "{arguments:?}: {}", outcome.stderr);
    }
    let (_dir, path) =
        changed(|text| text.replace("\"1.2 m\"", "\"120 m\"").replace("damping_ratio = 0.1", "damping_ratio = 10"));
    for command in [&["assess", &path][..], &["respond", "--product", &path, "--component=display", "--speed=3m/s"]] {
        let outcome = clatter(command);
        assert!(outcome.exit != Exit::BadInput, "{}", outcome.stderr);
        for said in ["warning: a height of 120 m is none", "120 mm?", "warning: a damping ratio of 10 is none", "10 %?"]
        {
            assert!(outcome.stderr.contains(said), "{said}: {}", outcome.stderr);
        }
        let text = fs::read_to_string(&path).unwrap();
        let line = 1 + text.lines().position(|line| line.starts_with("height = ")).unwrap();
        assert!(outcome.stderr.contains(&format!("{path}:{line}:10")), "{}", outcome.stderr);
    }
}

#[test]
fn a_drop_and_a_part_come_from_a_product_file() {
    let (_dir, path) = changed(|text| text);
    let product = format!("--product={path}");
    let json = |arguments: &[&str]| {
        let outcome = clatter(arguments.iter().chain(&["--format=json"]));
        assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
        (serde_json::from_str::<Value>(&outcome.stdout).unwrap(), outcome.stderr)
    };
    let (got, notes) = json(&["respond", &product, "--component=camera"]);
    let plain = [
        "respond",
        "--model=compliant",
        "--length=140mm",
        "--gyration=38mm",
        "--e=0.4",
        "--height=1.2m",
        "--tilt=5.5deg",
        "--contact-time=0.4ms",
        "--at=55mm",
        "--frequency=100Hz",
        "--damping=0.1",
    ];
    let without_limits = |mut answer: Value| {
        answer.as_object_mut().unwrap().remove("limits");
        answer
    };
    assert!(alike(&without_limits(got.clone()), &json(&plain).0), "{got}");
    for said in [
        "note: Handheld: either end may touch first: taken is end a\n",
        "note: Handheld: restitution = 0.4, the largest of 0.25 to 0.4\n",
        "note: Handheld: tilt = 5.5 deg, the middle of 1 to 10 deg\n",
        "note: Handheld: natural frequency = 100 Hz, the middle of 90 to 110 Hz\n",
    ] {
        assert!(notes.contains(said), "{said}: {notes}");
    }
    assert_eq!(notes.lines().count(), 4, "{notes}");
    // What stands beside the file counts, and is not told.
    let (got, notes) = json(&[
        "respond",
        &product,
        "--component=camera",
        "--e=0.1",
        "--tilt=2deg",
        "--frequency=95Hz",
        "--model=finite-tilt",
        "--speed=3m/s",
        "--at=1",
    ]);
    let of = &got["drop"]["drop"];
    assert_eq!(
        (&of["restitution"], &got["drop"]["model"], &of["speed_m_s"], &got["drop"]["place"]["at_m"][0]),
        (&0.1.into(), &"finite-tilt".into(), &3.0.into(), &0.07.into())
    );
    assert!((got["omega"].as_f64().unwrap() / (std::f64::consts::TAU * 95.0) - 1.0).abs() < 1e-12, "{got}");
    assert_eq!(
        notes.lines().filter(|line| line.contains("restitution") || line.contains("tilt = ")).count(),
        0,
        "{notes}"
    );
    // From the height of the file, with the gravity that is given.
    let (heavy, _) = json(&["respond", &product, "--component=camera", "--gravity=2gn"]);
    let speed_m_s = (2.0 * 2.0 * 9.806_65 * 1.2_f64).sqrt();
    assert!((heavy["drop"]["drop"]["speed_m_s"].as_f64().unwrap() / speed_m_s - 1.0).abs() < 1e-12, "{heavy}");
    // A part that is mounted rigidly, and the place of a part in a simulation.
    let (hard, _) = json(&["respond", &product, "--component=crystal"]);
    assert!(
        hard.get("omega").is_none() && (hard["drop"]["place"]["at_m"][0].as_f64().unwrap() + 0.02).abs() < 1e-12,
        "{hard}"
    );
    let (simulated, _) = json(&["simulate", &product, "--component=camera"]);
    assert!((simulated["at"][0][0].as_f64().unwrap() - 55.0 / 70.0).abs() < 1e-12, "{simulated}");
    assert_eq!(simulated["model"], "compliant");
    // Where end b touches first it is called a.
    let (_other, mirrored) = changed(|text| {
        text.replace("\"either\"", "\"b\"")
            .replace("radius_of_gyration", "center_of_mass = \"7 mm\"\nradius_of_gyration")
    });
    let (got, notes) = json(&["simulate", &format!("--product={mirrored}"), "--component=camera"]);
    assert!((got["at"][0][0].as_f64().unwrap() + 55.0 / 70.0).abs() < 1e-12, "{got}");
    let ends = [0, 1].map(|end| got["drop"]["body"]["length"]["ends_m"][end].as_f64().unwrap());
    assert!(((ends[0] - ends[1]) / (ends[0] + ends[1]) + 0.1).abs() < 1e-12, "{got}");
    assert!(notes.contains("end b touches first and is called a here: places are turned around"), "{notes}");
    // Typed places are of the product too.
    let (typed, _) = json(&["simulate", &format!("--product={mirrored}"), "--at=55mm"]);
    assert_eq!((&typed["at"], &typed["impacts"]), (&got["at"], &got["impacts"]));
    for (arguments, said) in [
        (&["respond", &product][..], "the place is missing: --at=S, or with --product the --component=NAME"),
        (
            &["respond", &product, "--component=lens"],
            "has no component \"lens\": its components are \"display\", \"camera\", \"crystal\"",
        ),
        (&["simulate", "--product=nothing.toml"], "cannot read nothing.toml"),
        // A bar of a file rises to no direction.
        (&["respond", &product, "--component=camera", "--direction=200deg"], "'--direction': it is that of a plate"),
    ] {
        let outcome = clatter(arguments);
        assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""));
        assert!(outcome.stderr.contains(said), "{said}: {}", outcome.stderr);
    }
}

#[test]
fn simulate_lists_what_matters() {
    let drop = [
        "simulate",
        "--model=ballistic",
        "--length=140mm",
        "--gyration=40mm",
        "--e=0.5",
        "--speed=3m/s",
        "--tilt=4deg",
    ];
    let [few, all] = [&[][..], &["--all"]].map(|more| clatter(drop.iter().chain(more)).stdout);
    let json = answer(drop);
    let impacts = json["impacts"].as_array().unwrap();
    let largest = |impact: &Value| {
        impact["delta_v_m_s"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap().abs()).fold(0.0, f64::max)
    };
    let most = impacts.iter().map(largest).fold(0.0, f64::max);
    let (kept, left): (Vec<_>, Vec<_>) = impacts.iter().partition(|impact| largest(impact) >= 0.01 * most);
    assert!(kept.len() > 3 && left.len() > 3, "{} and {}", kept.len(), left.len());
    let rows = |table: &str| {
        table
            .lines()
            .filter(|line| line.starts_with(' ') && line[9..].starts_with("  a ") | line[9..].starts_with("  b "))
            .count()
    };
    assert_eq!((rows(&few), rows(&all)), (kept.len(), impacts.len()), "{few}");
    let last = few.lines().rev().nth(1).unwrap();
    let begins = format!("{} more strikes below 1 % of the largest shock, until ", left.len());
    assert!(last.starts_with(&begins) && last.ends_with(" m/s;"), "{last}");
    assert!(few.ends_with("\n--all lists every one\n"), "{few}");
    assert!(!all.contains("--all"), "{all}");
}

#[test]
fn products_of_one_name_are_told_apart_and_parts_are_refused() {
    let (dir, path) = changed(|text| text);
    let other = dir.path().join("after.toml").display().to_string();
    fs::write(&other, fs::read_to_string(&path).unwrap().replace("1600 gn", "1000 g")).unwrap();
    let outcome = clatter(["assess", &path, &other]);
    let head = outcome.stdout.lines().next().unwrap();
    assert!(head.contains(&path) && head.ends_with(&other) && !head.contains("Handheld"), "{head}");
    let table = outcome.stdout.split("\n\n").next().unwrap();
    let ends: Vec<_> = table.lines().map(|line| line.chars().count()).collect();
    assert!(ends.iter().all(|end| *end == ends[0]), "columns end alike: {}", outcome.stdout);
    let json: Value = serde_json::from_str(&clatter(["assess", &path, &other, "--format=json"]).stdout).unwrap();
    assert_eq!([&json[0]["file"], &json[1]["file"]], [path.as_str(), other.as_str()]);
    let (_dir, twice) = changed(|text| text.replace("\"crystal\"", "\"camera\""));
    let outcome = clatter(["assess", &twice]);
    assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""));
    assert!(outcome.stderr.starts_with("error: two components are named \"camera\"\n"), "{}", outcome.stderr);
    assert_eq!(outcome.stderr.matches("name = \"camera\"").count(), 2, "{}", outcome.stderr);
}

#[test]
fn what_one_kind_alone_may_be_goes_to_standard_output() {
    let (_dir, path) = changed(|text| text);
    let samples = clatter(["scatter", &path, "--samples=20", "-o", "-"]);
    assert_eq!((samples.exit, samples.stderr.as_str()), (Exit::Done, ""));
    assert!(samples.stdout.starts_with("sample,first,") && samples.stdout.lines().count() == 21, "{}", samples.stdout);
    let picture = clatter(["tradeoff", &path, "-o", "-"]).stdout;
    assert!(picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"), "{picture}");
    let template = clatter(["init", "-"]);
    assert_eq!((template.stdout.as_str(), template.stderr.as_str()), (clatter_product::EXAMPLE, ""));
}

#[test]
fn what_would_be_taken_two_ways_is_refused() {
    let body = ["--length=140mm", "--e=0.3", "--speed=4m/s", "--tilt=5deg", "--model=finite-tilt"];
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("p.toml");
    fs::write(&file, clatter_product::EXAMPLE).unwrap();
    let file = file.to_str().unwrap();
    for (arguments, says) in [
        (
            [&["simulate", "--mass=200@-1:1", "--mass=100g@0.5"], &body[..]].concat(),
            "give all of them with their units",
        ),
        (vec!["impacts", "--e=.3", "--mass=200g@-1:1", "--mass=1@0.5"], "give all of them with their units"),
        (
            vec!["respond", "--q=0.5", "--e=.3", "--at=1", "--frequency=180Hz", "--height-gap=0.5"],
            "--frequency needs SI units",
        ),
        (vec!["assess", file, "-o", "x.pdf", "--date=2026-02-29"], "a date is written as 2026-03-31"),
        (vec!["scatter", file, "-o", "-", "--format=json"], "-o - takes its place"),
        (vec!["tradeoff", file, "-o", "-", "--format=csv"], "-o - takes its place"),
        (vec!["simulate", "--product", file, "--component=c\u{1b}[31m"], "its components are \"display\", "),
    ] {
        let outcome = clatter(&arguments);
        assert_eq!(outcome.exit, Exit::BadInput, "{arguments:?}");
        assert!(outcome.stderr.contains(says), "{arguments:?}: {}", outcome.stderr);
    }
}
