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
fn the_table_tells_what_drives_a_part() {
    let dir = tempfile::tempdir().unwrap();
    let outcome = clatter(["scatter", &file(&dir), "--samples=20000"]);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    assert!(outcome.stdout.contains("Taken as equally likely all over the range: restitution"), "{}", outcome.stdout);
    let line = outcome.stdout.lines().find(|line| line.starts_with("camera")).unwrap();
    assert!(line.contains("height+") && line.contains('%'), "{line}");
}
