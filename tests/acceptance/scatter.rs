//! `clatter scatter`: probabilities, seeds, samples.

use clatter_cli::Exit;

use crate::{answer, clatter};

const HANDHELD: &str = r#"
[product]
name = "Handheld"
length = "140 mm"
radius_of_gyration = "38 mm"
restitution = [0.25, 0.4]
[drop]
height = { normal = ["1.2 m", "0.2 m"], range = ["0.6 m", "1.8 m"] }
tilt = { triangular = ["0.5 deg", "2 deg", "10 deg"] }
first = "either"
[[component]]
name = "camera, front"
position = "55 mm"
natural_frequency = { uniform = ["80 Hz", "120 Hz"] }
damping_ratio = 0.1
acceleration_limit = "500 gn"
[[component]]
name = "sensor"
position = "0 mm"
mount = "hard"
velocity_change_limit = "100 m/s"
"#;

fn file(dir: &tempfile::TempDir) -> String {
    let path = dir.path().join("handheld.toml");
    std::fs::write(&path, HANDHELD).unwrap();
    path.display().to_string()
}

#[test]
fn a_part_that_never_fails_has_a_one_sided_bound() {
    let dir = tempfile::tempdir().unwrap();
    let found = answer(["scatter", file(&dir).as_str(), "--samples=2e3", "--confidence=0.99"]);
    assert_eq!((found["samples"].as_u64(), found["seed"].as_u64()), (Some(2000), Some(1)));
    let sensor = &found["components"][1];
    assert_eq!((sensor["failed"].as_u64(), sensor["survival"]["probability"].as_f64()), (Some(0), Some(1.0)));
    let at_least = sensor["survival"]["at_least"].as_f64().unwrap();
    assert!((at_least - 0.01f64.powf(1.0 / 2000.0)).abs() < 1e-12, "{at_least}");
    let camera = &found["components"][0];
    let drivers = camera["drivers"].as_array().unwrap();
    assert_eq!(drivers.len(), 5, "{camera}");
    let shares: Vec<_> = drivers.iter().map(|driver| driver["variance_share"].as_f64().unwrap()).collect();
    assert!(shares.windows(2).all(|w| w[0] >= w[1]) && shares.iter().sum::<f64>() < 1.1, "{shares:?}");
    let assumed: Vec<_> = found["inputs"].as_array().unwrap().iter().filter(|i| i["assumed_uniform"] == true).collect();
    assert_eq!(assumed.len(), 1, "the restitution alone has no distribution");
}

#[test]
fn a_seed_gives_the_same_answer_and_another_seed_another() {
    let dir = tempfile::tempdir().unwrap();
    let path = file(&dir);
    let run = |seed: &str| clatter(["scatter", path.as_str(), "--samples=5000", seed]).stdout;
    assert_eq!(run("--seed=7"), run("--seed=7"));
    assert_ne!(run("--seed=7"), run("--seed=8"));
}

#[test]
fn samples_in_a_file_add_up_to_the_answer() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("samples.csv");
    let outcome = clatter(["scatter", &file(&dir), "--samples=5000", "--format=json", "-o", target.to_str().unwrap()]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""), "progress is for those who watch");
    let found: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    let csv = std::fs::read_to_string(&target).unwrap();
    let mut lines = csv.lines();
    let titles = lines.next().unwrap();
    assert!(
        titles.starts_with("sample,first,speed_m_s,tilt_deg,restitution,\"frequency_hz of camera, front\""),
        "{titles}"
    );
    let used: Vec<f64> = lines.map(|line| line.rsplit(',').nth(1).unwrap().parse().unwrap()).collect();
    assert_eq!(used.len(), 5000);
    let failed = used.iter().filter(|used| **used > 1.0).count() as u64;
    assert_eq!(found["components"][0]["failed"].as_u64(), Some(failed));
    let largest = found["components"][0]["utilization"]["largest_sample"].as_u64().unwrap();
    let most = used.iter().copied().fold(0.0, f64::max);
    let at_worst = used[usize::try_from(largest).unwrap()];
    assert!((at_worst - most).abs() < 1e-15, "sample {largest} has {at_worst}, the largest is {most}");
}

#[test]
fn a_target_that_is_not_sure_exits_with_1_and_says_so() {
    let dir = tempfile::tempdir().unwrap();
    let path = file(&dir);
    let run = |target: &str| clatter(["scatter", path.as_str(), "--samples=2000", target]);
    let low = answer(["scatter", path.as_str(), "--samples=2000"])["survival"]["interval"][0].as_f64().unwrap();
    assert!((0.9..0.999).contains(&low), "{low}");
    let missed = run("--target=99.99%");
    assert_eq!((missed.exit, missed.stderr.as_str()), (Exit::Unsafe, ""));
    assert!(missed.stdout.contains("Target of 99.99 % MISSED: the 95 % interval begins at "), "{}", missed.stdout);
    // The interval decides, not the estimate: just above and just below where it begins.
    let [above, below] = [1e-6, -1e-6].map(|off| run(&format!("--target={:?}", low + off)));
    assert_eq!((above.exit, below.exit), (Exit::Unsafe, Exit::Done));
    assert!(below.stdout.contains(" met: the 95 % interval begins at "), "{}", below.stdout);
    let json = clatter(["scatter", path.as_str(), "--samples=2000", "--target=0.9999", "--format=json"]);
    let found: serde_json::Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!(json.exit, Exit::Unsafe);
    assert_eq!(found["target"], serde_json::json!({"survival": 0.9999, "met": false}));
}

/// All that may vary: what is drawn, and which part has it.
#[test]
fn contact_time_damping_place_and_limits_may_vary() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("all.toml");
    let all = HANDHELD
        .replace("restitution = [0.25, 0.4]", "restitution = 0.3\ncontact_time = [\"0.3 ms\", \"0.5 ms\"]")
        .replace("damping_ratio = 0.1", "damping_ratio = { uniform = [0.05, 0.2] }")
        .replace("\"55 mm\"", "{ normal = [\"55 mm\", \"1 mm\"], range = [\"50 mm\", \"60 mm\"] }")
        .replace("\"500 gn\"", "{ uniform = [\"400 gn\", \"600 gn\"] }");
    std::fs::write(&path, all).unwrap();
    let target = dir.path().join("samples.csv");
    let flags = ["--samples=500", "--format=json", "-o", target.to_str().unwrap()];
    let outcome = clatter(["scatter", path.to_str().unwrap()].iter().chain(&flags));
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    let found: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    let names: Vec<_> = found["inputs"].as_array().unwrap().iter().map(|i| i["input"].as_str().unwrap()).collect();
    for name in ["contact-time", "natural-frequency", "damping", "position", "limit"] {
        assert!(names.contains(&name), "{name}: {names:?}");
    }
    let limit = found["inputs"].as_array().unwrap().iter().find(|input| input["input"] == "limit").unwrap();
    assert_eq!((&limit["component"], &limit["limit"]), (&0.into(), &"acceleration".into()));
    assert_eq!(found["model"]["bar"], "compliant");
    assert_eq!(found["unanswered"], 0);
    let csv = std::fs::read_to_string(&target).unwrap();
    let titles = csv.lines().next().unwrap();
    for title in ["contact_time_s", "damping_ratio of camera", "position_m of camera", "acceleration limit of camera"] {
        assert!(titles.contains(title), "{title}: {titles}");
    }
    assert_eq!(csv.lines().count(), 501);
    let columns = titles.replace("camera, front", "camera").matches(',').count();
    assert!(csv.lines().skip(1).all(|line| line.matches(',').count() == columns && !line.contains("NaN")), "{titles}");
}

const PLATE: &str = "[product]\nname = \"Plate\"\nlength = \"150 mm\"\nwidth = \"70 mm\"\nthickness = \"12 mm\"\n\
    radius_of_gyration = [\"43 mm\", \"20 mm\"]\nrestitution = 0.4\ncontact_time = \"0.4 ms\"\ncontact_law = \"hysteretic\"\n[drop]\n\
    speed = \"3 m/s\"\ntilt = [\"5 deg\", \"25 deg\"]\n[[component]]\nname = \"board\"\nposition = [\"-20 mm\", \"5 mm\"]\n\
    natural_frequency = \"120 Hz\"\ndamping_ratio = 0.1\nrattle_space = \"3 mm\"\n";

/// A plate is followed as the box that it is, which is told, and its samples are repeated by `respond` as those of the box.
#[test]
fn a_plate_is_followed_as_the_box_that_it_is() {
    let dir = tempfile::tempdir().unwrap();
    let (path, target) = (dir.path().join("plate.toml"), dir.path().join("samples.csv"));
    let run = |text: &str| {
        std::fs::write(&path, text).unwrap();
        let arguments = ["scatter", path.to_str().unwrap(), "--samples=20", "-o", target.to_str().unwrap()];
        let json: serde_json::Value =
            serde_json::from_str(&clatter(arguments.into_iter().chain(["--format=json"])).stdout).unwrap();
        (json["model"]["plate"].clone(), clatter(arguments).stdout)
    };
    let thin = PLATE.replace("thickness = \"12 mm\"\n", "");
    let (plate, table) = run(&thin);
    assert_eq!(plate, serde_json::json!({"as": "box", "thickness_m": 0.15 * 0.05, "assumed": true}));
    assert!(
        table.replace('\n', " ").contains("as a box of 7.5 mm with full rotation, a twentieth of its length"),
        "{table}"
    );
    let feet = "feet_inset = [\"10 mm\", \"8 mm\"]\nfeet_height = \"20 mm\"\nrestitution";
    let (plate, table) = run(&PLATE.replace("restitution", feet).replace("25 deg", "7 deg"));
    assert_eq!(plate, serde_json::json!({"as": "level-plate"}));
    assert!(table.replace('\n', " ").contains("one on feet is not followed as a box"), "{table}");
    let (plate, table) = run(PLATE);
    assert_eq!(plate, serde_json::json!({"as": "box", "thickness_m": 0.012, "assumed": false}));
    assert!(table.contains("by the model compliant, as a box of 12 mm with full rotation\n"), "{table}");
    let csv = std::fs::read_to_string(target).unwrap();
    assert!(
        csv.starts_with("sample,direction_deg,speed_m_s,tilt_deg,restitution,contact_time_s,frequency_hz of board,")
    );
    let (kz, omega) = (0.012 / 12_f64.sqrt(), std::f64::consts::TAU * 120.0);
    let axes = [0.02_f64.hypot(kz), 0.043_f64.hypot(kz), 0.043_f64.hypot(0.02)].map(|k| format!("{k:?}")).join(",");
    for row in csv.lines().skip(1) {
        let row: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        let (direction, tilt, used) = (row[1], row[3], row[7]);
        let arguments = format!(
            "respond --model=compliant --length-m=0.15 --width-m=0.07 --thickness-m=0.012 --gyration-m={axes} --e=0.4 --speed-m-s=3 \
             --tilt-deg={tilt:?} --direction-deg={direction:?} --gravity-m-s2=9.80665 --contact-time-s=4e-4 --contact-law=hysteretic \
             --at-m=-0.02,0.005,0 --axis=z --omega={omega:?} --damping=0.1"
        );
        let alone = answer(arguments.split_whitespace());
        let known = alone["omega_peak_relative_displacement"].as_f64().unwrap() / omega / 3e-3;
        // What is felt is joined by straight lines, four or eight in a step.
        assert!((used / known - 1.0).abs() < 1e-3, "{used}, not {known}: {row:?}");
    }
}

/// Where nothing was answered there is no probability: null, and a dash.
#[test]
fn what_is_not_answered_has_no_probability() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("box.toml");
    let text = PLATE
        .replace("0.4 ms", "9 ms")
        .replace("[drop]", "[[drop]]")
        .replace("tilt = [\"5 deg\", \"25 deg\"]", "face = \"top\"\nattitude_tolerance = \"1 deg\"");
    std::fs::write(&path, text).unwrap();
    let arguments = ["scatter", path.to_str().unwrap(), "--samples=10"];
    let found = answer(arguments);
    let all = [&found, &found["components"][0], &found["landings"][0], &found["landings"][0]["components"][0]];
    for of in all {
        let survival = &of["survival"];
        assert_eq!(
            (&survival["probability"], &survival["interval"]),
            (&serde_json::Value::Null, &serde_json::json!([0.0, 1.0]))
        );
        assert_eq!(survival["at_least"], 0.0);
    }
    assert_eq!(found["landings"][0]["components"][0]["largest_utilization"], serde_json::Value::Null);
    assert!(found["unanswered"] == 10 && found["reason"].as_str().unwrap().contains("contact time 9 ms"), "{found}");
    let table = clatter(arguments).stdout;
    assert!(
        table.contains("10 products are not answered") && table.contains("Whether all parts survive is not known"),
        "{table}"
    );
    let row = |start: &str| {
        let line = table.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("{start}: {table}"));
        line.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(row("board"), ["board", "-", "0", "0", "100", "-", "-"]);
    assert_eq!(row("face top"), ["face", "top", "-", "0", "100", "board", "-", "-"]);
    let csv = clatter(arguments.into_iter().chain(["--format=csv"])).stdout;
    assert!(csv.ends_with("\nboard,10,0,,0.0,1.0,0.0,,,0,10\n"), "{csv}");
}

#[test]
fn the_table_tells_what_drives_a_part() {
    let dir = tempfile::tempdir().unwrap();
    let outcome = clatter(["scatter", &file(&dir), "--samples=20000"]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    assert!(outcome.stdout.contains("Taken as equally likely all over the range: restitution"), "{}", outcome.stdout);
    // Columns that the table has no room for follow below.
    let line: String = outcome.stdout.lines().filter(|line| line.starts_with("camera")).collect();
    assert!(line.contains("height+") && line.contains('%'), "{line}");
}

/// A box that goes through some drops one after the other: what every sample asks of its battery is repeated by `respond`, which is told
/// the attitude, and of all products no more survive the sequence than any drop of it.
#[test]
fn a_box_is_a_sequence_of_drops() {
    let dir = tempfile::tempdir().unwrap();
    let (path, target) = (dir.path().join("box.toml"), dir.path().join("samples.csv"));
    let text = "[product]\nname = \"Box\"\nlength = \"150 mm\"\nwidth = \"70 mm\"\nthickness = \"14 mm\"\nmass = \"300 g\"\n\
                radius_of_gyration = [\"43 mm\", \"20 mm\"]\nrestitution = [0.3, 0.4]\ncontact_time = \"0.4 ms\"\n\
                contact_law = \"hysteretic\"\n[drop]\nstandard = \"MIL-STD-810H/516.8-IV\"\n[[component]]\nname = \"battery\"\n\
                position = [\"-30 mm\", \"0 mm\"]\nnatural_frequency = [\"110 Hz\", \"130 Hz\"]\ndamping_ratio = 0.1\n\
                rattle_space = \"7 mm\"\n";
    std::fs::write(&path, text).unwrap();
    let (path, target) = (path.to_str().unwrap(), target.to_str().unwrap());
    let outcome = clatter(["scatter", path, "--samples=20", "--format=json", "-o", target]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    let found: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert!(
        found["model"]["sequence"].as_str().unwrap().contains("one product that goes through all drops"),
        "{found}"
    );
    let landings = found["landings"].as_array().unwrap();
    let survival = |of: &serde_json::Value| of["survival"]["probability"].as_f64().unwrap();
    assert_eq!((landings.len(), landings[4]["landing"].as_str()), (26, Some("face bottom")));
    for landing in landings {
        assert!(
            survival(&found) <= survival(landing) && survival(landing) <= survival(&landing["components"][0]),
            "{landing}"
        );
    }
    assert!((0.05..0.95).contains(&survival(&found)), "{found}");
    let csv = std::fs::read_to_string(target).unwrap();
    let mut rows = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let titles = rows.next().unwrap();
    for row in rows.take(8) {
        let of = |title: &str| {
            let k = titles.iter().position(|t| *t == title).unwrap_or_else(|| panic!("{title} of {titles:?}"));
            row[k].parse::<f64>().unwrap()
        };
        let on = |what: &str| of(&format!("{what} on face bottom"));
        // Turned about an axis in the bottom, so that it rises towards the direction.
        let (half, direction) = (0.5 * on("tilt_deg").to_radians(), on("direction_deg").to_radians());
        let turned = [half.cos(), half.sin() * direction.sin(), -half.sin() * direction.cos(), 0.0];
        let axes =
            [0.02_f64.hypot(0.014 / 12_f64.sqrt()), 0.043_f64.hypot(0.014 / 12_f64.sqrt()), 0.043_f64.hypot(0.02)];
        let list = |of: &[f64]| of.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(",");
        let omega = std::f64::consts::TAU * of("frequency_hz of battery");
        let numbers = [
            ("gyration-m", list(&axes)),
            ("orientation", list(&turned)),
            ("e", list(&[of("restitution")])),
            ("friction", list(&[of("friction")])),
            ("speed-m-s", list(&[on("speed_m_s")])),
            ("omega", list(&[omega])),
        ];
        let mut arguments =
            "respond --model=compliant --length-m=0.15 --width-m=0.07 --thickness-m=0.014 --gravity-m-s2=9.80665 \
                             --at-m=-0.03,0,0 --axis=z --damping=0.1 --contact-time-s=4e-4 --contact-law=hysteretic"
                .split_whitespace()
                .map(str::to_owned)
                .collect::<Vec<_>>();
        arguments.extend(numbers.iter().map(|(name, value)| format!("--{name}={value}")));
        let alone = answer(arguments.iter().map(String::as_str));
        let used = alone["omega_peak_relative_displacement"].as_f64().unwrap() / omega / 7e-3;
        let drawn = of("utilization of battery on face bottom");
        // What is felt is joined by straight lines, four or eight in a step.
        assert!((used / drawn - 1.0).abs() < 1e-3, "{used}, not {drawn}");
        assert!(of("utilization of battery") >= drawn, "{row:?}");
    }
    let table = clatter(["scatter", path, "--samples=20"]).stdout;
    for told in [
        "Box: 20 products drawn with seed 1; each goes through its 26 drops, one after the other",
        "Taken as equally likely all over the range: attitude within its tolerance, restitution, friction, natural frequency of battery",
        "each drop alone",
        "corner top back end-b",
    ] {
        assert!(table.contains(told), "{told}: {table}");
    }
    // Any number of threads says the same; more than the one of a test runs of the process.
    assert_eq!(outcome.stdout, clatter(["scatter", path, "--samples=20", "--format=json"]).stdout);
}

/// Where all parts survive a drop, the one that it uses most of is named.
#[test]
fn the_part_that_a_drop_asks_most_of_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let box_of = |parts: [(&str, u32); 2]| {
        let text = "[product]\nname = \"Box\"\nlength = \"150 mm\"\nwidth = \"70 mm\"\nthickness = \"14 mm\"\n\
                    radius_of_gyration = [\"43 mm\", \"20 mm\"]\nrestitution = 0.3\ncontact_time = \"0.4 ms\"\n\
                    contact_law = \"hysteretic\"\n[drop]\nface = \"bottom\"\nheight = \"1 m\"\n";
        parts.into_iter().fold(text.to_owned(), |text, (name, limit)| {
            format!(
                "{text}[[component]]\nname = \"{name}\"\nposition = [\"0 mm\", \"0 mm\"]\nmount = \"hard\"\n\
                 velocity_change_limit = \"{limit} m/s\"\n"
            )
        })
    };
    for parts in [[("weak", 50), ("strong", 500)], [("strong", 500), ("weak", 50)]] {
        let path = dir.path().join("box.toml");
        std::fs::write(&path, box_of(parts)).unwrap();
        let table = clatter(["scatter", path.to_str().unwrap(), "--samples=10"]).stdout;
        let row = table.lines().find(|line| line.starts_with("face bottom")).unwrap_or_else(|| panic!("{table}"));
        assert!(row.contains(" weak ") && !row.contains("strong"), "{table}");
    }
}
