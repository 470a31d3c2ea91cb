//! Every file that is written tells the version that wrote it, where its kind has a place for that.

use std::fs;

use clatter_cli::Exit;
use serde_json::Value;

use crate::clatter;

const VERSION: &str = env!("CARGO_PKG_VERSION");
const RECORD: &str = "time [s],a [g]\n0,0\n0.001,5\n0.002,20\n0.003,5\n0.004,0\n0.005,0\n";
const BOUNCES: &str = "bounce_s\n0\n0.5\n0.7\n0.78\n0.812\n";
const DROP: [&str; 6] = ["simulate", "--model=map", "--length=140mm", "--gyration=40mm", "--e=0.3", "--speed=4m/s"];

/// Runs each command with `-o` and a file of each ending; `{}` stands for the folder.
#[test]
fn files_tell_the_version_that_wrote_them() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().display().to_string();
    for (name, text) in [("p.toml", include_str!("../cases/bar-handheld.toml")), ("r.csv", RECORD), ("b.csv", BOUNCES)]
    {
        fs::write(dir.path().join(name), text).unwrap();
    }
    let map = ["map", "peak-end", "--q=0:1:3", "--e=0:1:3"];
    let drop = [&DROP[..], &["--tilt=2deg"]].concat();
    let spectrum = ["spectrum", "{}/r.csv", "--frequency=100,180"];
    let rule = ["respond", "--q=0.73", "--e=0.2", "--at=1", "--omega=3"];
    let record = ["record", "{}/r.csv"];
    let fit = ["fit", "{}/b.csv", "--product={}/p.toml"];
    let cases: [(&[&str], &[&str]); 6] = [
        (&map, &["json", "svg"]),
        (&drop, &["json", "svg"]),
        (&spectrum, &["json", "svg"]),
        (&rule, &["json", "svg"]),
        (&record, &["svg", "parquet"]),
        (&fit, &["svg", "toml"]),
    ];
    for (command, endings) in cases {
        for ending in endings {
            let file = dir.path().join(format!("{}.{ending}", command[0]));
            let arguments = command.iter().map(|argument| argument.replace("{}", &folder));
            let outcome = clatter(arguments.chain([format!("-o{}", file.display())]));
            assert_eq!(outcome.exit, Exit::Done, "{command:?} {ending}: {}", outcome.stderr);
            let bytes = fs::read(&file).unwrap();
            let text = String::from_utf8_lossy(&bytes);
            let told = match *ending {
                "json" => format!("{{\"clatter\":\"{VERSION}\","),
                "svg" => format!("\n<metadata>clatter {VERSION}</metadata>\n"),
                "toml" => format!("# Fitted by clatter {VERSION}\n"),
                _ => format!("clatter version {VERSION}"),
            };
            let at = text.find(&told).unwrap_or_else(|| panic!("{command:?} {ending} does not tell {told:?}"));
            assert!(at == 0 || matches!(*ending, "svg" | "parquet"), "{command:?} {ending} begins with it");
            assert_eq!(text.matches(&told).count(), 1, "{command:?} {ending} tells it once");
        }
    }
    // A file that is fitted once more tells it once.
    let [bounces, fitted, again] = ["b.csv", "fit.toml", "again.toml"].map(|name| format!("{folder}/{name}"));
    let outcome = clatter(["fit", &bounces, &format!("--product={fitted}"), &format!("-o{again}")]);
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    let [fitted, again] = [fitted, again].map(|file| fs::read_to_string(file).unwrap());
    assert_eq!(fitted.lines().count(), again.lines().count());
    assert_eq!(again.matches("# Fitted by").count(), 1, "{again}");
}

#[test]
fn several_answers_tell_it_each() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/bar-phone.toml");
    let path = path.display().to_string();
    let outcome = clatter(["assess", &path, &path, "--format=json", "--model=map"]);
    let answers: Vec<Value> = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(answers.iter().map(|answer| &answer["clatter"]).collect::<Vec<_>>(), [VERSION, VERSION]);
}
