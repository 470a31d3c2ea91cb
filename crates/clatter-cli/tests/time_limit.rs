//! What is told where the time is over: the part of the answer that there is, what was cut, and how it ends.

#![cfg(all(test, unix))]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

fn clatter(dir: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_clatter"));
    command.current_dir(dir).env_remove("CLATTER_TYPST").env_remove("CLATTER_NO_INSTALL");
    command
}

fn told(done: &Output) -> (Option<i32>, String, String) {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (done.status.code(), text(&done.stdout), text(&done.stderr))
}

fn script(path: &Path, text: &str) {
    fs::write(path, format!("#!/bin/sh\n{text}\n")).expect("a script");
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).expect("a script");
}

/// One part that one drop is asked of: nothing takes long but what is outside.
const SMALL: &str = "[product]\nname = \"small\"\nlength = \"140 mm\"\nradius_of_gyration = \"40 mm\"\nrestitution = 0.3\n\
    [drop]\nheight = \"0.5 m\"\ntilt = \"4 deg\"\nfirst = \"a\"\n\
    [[component]]\nname = \"part\"\nposition = \"0 mm\"\nmount = \"hard\"\nvelocity_change_limit = \"100 m/s\"\n";

/// Programs that would go on for ten minutes: the table is whole, and the report that is beside it is told to be none.
#[test]
fn a_report_that_is_cut_leaves_a_whole_answer() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fs::write(at("p.toml"), SMALL).unwrap();
    script(&at("typst"), "[ \"$1\" = --version ] && echo typst 0.15.1 && exit\nsleep 600; touch lived");
    fs::create_dir(at("bin")).unwrap();
    script(&at("bin/python3"), "sleep 600; touch lived");
    let alone = told(&clatter(dir.path()).args(["assess", "p.toml"]).output().unwrap());
    assert_eq!(alone.0, Some(0), "{}", alone.2);
    let path = format!("{}:/bin", at("bin").display());
    let setting = ("setting the pages", vec![("CLATTER_TYPST", at("typst").into_os_string())]);
    let fetching = ("fetching its wheel", vec![("PATH", path.into()), ("XDG_CACHE_HOME", at("cache").into())]);
    // All wait for their time at once.
    std::thread::scope(|scope| {
        for (step, set) in [setting, fetching] {
            let (alone, dir) = (&alone, dir.path());
            scope.spawn(move || {
                let mut command = clatter(dir);
                let name = if step.starts_with("setting") { "p.pdf" } else { "q.pdf" };
                command.args(["assess", "p.toml", "-o", name, "--time-limit=8s"]).envs(set);
                let (code, stdout, stderr) = told(&command.output().unwrap());
                assert_eq!((code, &stdout), (Some(4), &alone.1), "{stderr}");
                let cut = "warning: stopped, --time-limit is over: making the printed report was cut (";
                assert!(stderr.starts_with(cut) && stderr.contains(step) && stderr.lines().count() == 1, "{stderr}");
                assert!(stderr.ends_with(&format!("{name} is not written; the answer is whole\n")), "{stderr}");
                assert!(!dir.join(name).exists());
            });
        }
        // On standard output the report is the answer.
        let mut command = clatter(dir.path());
        command.args(["assess", "p.toml", "-o", "-", "--time-limit=8s"]).env("CLATTER_TYPST", at("typst"));
        let (code, stdout, stderr) = told(&command.output().unwrap());
        assert_eq!((code, stdout.as_str()), (Some(2), ""), "{stderr}");
        assert!(stderr.contains("the answer is not whole"), "{stderr}");
    });
}

/// Stiff parts that fail on an elastic product: minutes of changes.
fn long() -> String {
    let product = "[product]\nname = \"long\"\nlength = \"150 mm\"\nradius_of_gyration = \"41 mm\"\nrestitution = [0, 0.9]\n\
        contact_time = [\"0.02 ms\", \"0.4 ms\"]\n[drop]\nspeed = [\"2 m/s\", \"4 m/s\"]\ntilt = [\"0.5 deg\", \"30 deg\"]\n\
        first = \"either\"\n";
    let part = |k: u32| {
        format!(
            "[[component]]\nname = \"part {k}\"\nposition = \"{k} mm\"\nnatural_frequency = [\"{}00 Hz\", \"30 kHz\"]\n\
             damping_ratio = [0.01, 0.05]\nacceleration_limit = \"1000 gn\"\n",
            k + 2
        )
    };
    (0..40).map(part).fold(product.to_owned(), |text, part| text + &part)
}

#[test]
fn design_tells_the_part_of_its_answer_that_it_has() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("long.toml"), long()).unwrap();
    let design = ["design", "long.toml", "-o", "plane.svg", "--time-limit=4s"];
    let (code, stdout, stderr) = told(&clatter(dir.path()).args(design).output().unwrap());
    assert_eq!(code, Some(4), "{stderr}");
    assert!(stdout.contains("40 of 40 parts are not safe"), "{stdout}");
    assert!(stdout.contains("not known: the time was over before"), "{stdout}");
    assert!(stderr.contains("warning: --time-limit is over: plane.svg is not written\n"), "{stderr}");
    assert!(stderr.contains("the answer is of what was done by then"), "{stderr}");
    assert!(!dir.path().join("plane.svg").exists());
    let json = ["design", "long.toml", "--format=json", "--time-limit=4s"];
    let (_, stdout, _) = told(&clatter(dir.path()).args(json).output().unwrap());
    assert!(stdout.contains("\"outcome\":\"stopped\""), "{stdout}");
}

/// Samples of a product with many parts take long, and many are drawn at a time.
#[test]
fn scatter_tells_of_the_samples_that_were_drawn() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("long.toml"), long()).unwrap();
    let scatter = ["scatter", "long.toml", "--samples=100000000", "--format=json", "--time-limit=4s"];
    let (code, stdout, stderr) = told(&clatter(dir.path()).args(scatter).output().unwrap());
    assert_eq!(code, Some(0), "{stderr}");
    let drawn = stdout.split("\"samples\":").nth(1).and_then(|rest| rest.split(',').next()).unwrap();
    assert!((1..100_000_000).contains(&drawn.parse::<u64>().unwrap()), "{drawn}");
    assert!(stderr.contains("warning: --time-limit is over: the answer is of what was done by then"), "{stderr}");
}
