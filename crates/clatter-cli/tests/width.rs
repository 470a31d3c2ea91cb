//! Tables are no wider than the terminal, and than 100 columns where there is none.

#![cfg(test)]

use std::path::{Path, PathBuf};

use clatter_cli::{Exit, Streams, run};
use unicode_width::UnicodeWidthStr;

const WIDEST: usize = 100;

/// What the command says.
fn said(args: &[&str]) -> String {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let mut streams = Streams { out: &mut out, err: &mut err, interactive: false };
    let exit = run(std::iter::once("clatter").chain(args.iter().copied()), &mut streams);
    assert!(matches!(exit, Exit::Done | Exit::Unsafe), "{args:?}: {}", String::from_utf8_lossy(&err));
    String::from_utf8(out).unwrap()
}

fn example(name: &str) -> String {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/cases").join(name);
    path.to_str().unwrap().to_owned()
}

/// A product with long names, every limit and wide numbers.
fn wide(dir: &Path) -> String {
    let part = |name: &str, rest: &str| format!("[[component]]\nname = \"{name}\"\nposition = \"-60 mm\"\n{rest}\n");
    let text = "[product]\nname = \"A product with a long name\"\nlength = \"150 mm\"\n\
        radius_of_gyration = \"41 mm\"\nrestitution = [0.3, 0.4]\ncontact_time = \"0.4 ms\"\n[drop]\nheight = \"1.2 m\"\n\
        tilt = [\"1 deg\", \"10 deg\"]\n"
        .to_owned()
        + &part("display with its backlight and frame", "natural_frequency = \"180 Hz\"\ndamping_ratio = 0.05\nacceleration_limit = \"900.5 gn\"\nrattle_space = \"2.125 mm\"")
        + &part("gyroscope on the flexible printed circuit", "mount = \"hard\"\nangular_velocity_change_limit = \"8000 deg/s\"\nvelocity_change_limit = \"1234.5 cm/s\"")
        + &part("漢字の部品は幅が二倍の文字である長い名前", "mount = \"hard\"\ndamage_boundary = { velocity_change = \"3 m/s\", acceleration = \"123456 m/s2\" }");
    let path = dir.join("wide.toml");
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn no_table_is_wider_than_a_hundred_columns() {
    let dir = tempfile::tempdir().unwrap();
    let wide = wide(dir.path());
    let [phone, laptop, terminal] = ["bar-phone.toml", "bar-laptop.toml", "bar-terminal.toml"].map(example);
    let product = format!("--product={wide}");
    let drop = ["--length=140mm", "--gyration=40mm", "--e=0.3", "--height=1m", "--tilt=5deg"];
    let places = ["--at=-1", "--at=-0.5", "--at=0", "--at=0.25", "--at=0.5", "--at=0.75", "--at=1"];
    let mut commands: Vec<Vec<&str>> = vec![
        vec!["assess", &wide],
        vec!["assess", &laptop],
        vec!["assess", &phone, &laptop, &terminal, &wide],
        vec!["scatter", &wide, "--samples=100"],
        vec!["explain", &wide],
        vec!["tradeoff", &wide],
        vec!["design", &laptop],
        vec!["respond", &product, "--component=display with its backlight and frame", "--worst"],
        vec!["spectrum", "--pulse=half-sine,5000,0.0005", "--frequency=100,180", "--limit=400"],
        vec!["zone", "--q=0.5", "--e=0.3", "--threshold=0.5"],
        vec!["help"],
    ];
    commands.push([&["impacts", "--q=0.5", "--e=0.3"][..], &places].concat());
    let simulated = ["simulate", "--model=compliant", "--contact-time=0.4ms"];
    commands.push([&simulated[..], &drop, &places].concat());
    let drop = ["--length=140mm", "--width=70mm", "--e=0.3", "--height=1m", "--tilt=5deg", "--direction=40deg"];
    let plate = ["--gyration=40mm,20mm", "--center-of-mass=0.123456,-0.03", "--at=0,0.5", "--spin-rad-s=1.2345,-2"];
    commands.push([&simulated[..], &drop, &plate].concat());
    let thick = ["--thickness=20mm", "--gyration=20.5mm,41mm,44mm", "--center-of-mass-m=0.01,-0.002,0.001"];
    commands.push([&simulated[..], &drop, &thick, &["--at=0,0.5,-1", "--spin-rad-s=1.2345,-2,0.3"]].concat());
    for command in commands {
        let text = said(&command);
        for line in text.lines().filter(|line| !line.starts_with("  clatter respond ")) {
            assert!(line.width() <= WIDEST, "{command:?}, {} columns: {line}", line.width());
        }
    }
}

/// Nothing is lost where columns follow below: each place has its head and, of each impact, its number.
#[test]
fn columns_that_follow_below_are_all_there() {
    let mut args = vec!["impacts", "--q=0.5", "--e=0.3"];
    let places: Vec<String> = (-9..=9).map(|k| format!("--at=0.{:02}", 10 + k)).collect();
    args.extend(places.iter().map(String::as_str));
    let text = said(&args);
    for place in &places {
        let place = place.trim_start_matches("--at=").trim_end_matches('0');
        assert!(text.contains(&format!("shock at {place}")), "{place}: {text}");
    }
    let blocks = text.matches("   impact  end").count();
    assert!(blocks > 2 && text.matches("\n        1  a").count() == blocks, "{blocks}: {text}");
}

/// The demand of 0 that a drop with both ends as one asks of a limit on turning is told in words.
#[test]
fn what_is_not_asked_for_is_told_in_words() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("flat.toml");
    let text = "[product]\nname = \"Flat\"\nlength = \"150 mm\"\nradius_of_gyration = \"41 mm\"\nrestitution = 0.3\n\
        contact_time = \"0.4 ms\"\n[drop]\nheight = \"1 m\"\ntilt = \"0 deg\"\n[[component]]\nname = \"gyroscope\"\n\
        position = \"0 mm\"\nmount = \"hard\"\nangular_velocity_change_limit = \"50 rad/s\"\n";
    std::fs::write(&path, text).unwrap();
    let text = said(&["assess", path.to_str().unwrap()]);
    let row = text.lines().find(|line| line.starts_with("gyroscope")).unwrap_or_else(|| panic!("{text}"));
    assert!(row.contains("none asked") && !text.contains("infinite"), "{text}");
}
