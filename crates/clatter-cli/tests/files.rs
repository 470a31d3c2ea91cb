//! What a command does to the files of its user, also when it is stopped.

#![cfg(all(test, unix))]

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

fn clatter() -> Command {
    Command::new(env!("CARGO_BIN_EXE_clatter"))
}

fn says(command: &mut Command) -> (Option<i32>, String) {
    let done = command.output().expect("it runs");
    (done.status.code(), String::from_utf8(done.stderr).expect("text"))
}

fn names(dir: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(dir)
        .expect("a directory")
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("text"))
        .collect();
    names.sort();
    names
}

fn product(dir: &Path) -> std::path::PathBuf {
    let product = dir.join("p.toml");
    assert_eq!(says(clatter().arg("init").arg(&product)), (Some(0), String::new()), "init");
    product
}

#[test]
fn no_output_replaces_an_input() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let product = product(dir.path());
    fs::write(at("rec.csv"), "t_s,a_m_s2\n0,0\n0.001,100\n0.002,0\n0.003,0\n").unwrap();
    fs::write(at("shocks.csv"), "time_s,delta_v_m_s\n0,1\n").unwrap();
    fs::copy(&product, at("p.pdf")).unwrap();
    symlink(&product, at("link.pdf")).unwrap();
    fs::hard_link(at("rec.csv"), at("hard.csv")).unwrap();
    let all: [&[&str]; 6] = [
        &["assess", "p.pdf", "-o", "p.pdf"],
        &["assess", "p.toml", "-o", "link.pdf"],
        &["assess", "./p.pdf", "-o", "p.pdf"],
        &["spectrum", "rec.csv", "-o", "rec.csv"],
        &["spectrum", "rec.csv", "-o", "hard.csv"],
        &["spectrum", "--shocks-file=shocks.csv", "-o", "shocks.csv"],
    ];
    for arguments in all {
        let all = ["p.toml", "p.pdf", "rec.csv", "shocks.csv"];
        let before: Vec<_> = all.map(|name| fs::read(at(name)).unwrap()).into();
        let (code, stderr) = says(clatter().args(arguments).current_dir(dir.path()));
        assert_eq!(code, Some(2), "{arguments:?}: {stderr}");
        assert!(stderr.contains("is read by this command and would be lost"), "{arguments:?}: {stderr}");
        let after: Vec<_> = all.map(|name| fs::read(at(name)).unwrap()).into();
        assert!(before == after, "{arguments:?}");
    }
    let (code, stderr) =
        says(clatter().args(["spectrum", "rec.csv", "-o", "rec.csv", "--force"]).current_dir(dir.path()));
    assert_eq!((code, stderr.as_str()), (Some(0), ""));
    assert!(fs::read_to_string(at("rec.csv")).unwrap().starts_with("frequency"), "the spectrum");
    let (code, stderr) = says(clatter().args(["design", "-o", "d.svg", "--front=d.svg"]).current_dir(dir.path()));
    assert!(code == Some(2) && stderr.contains("written twice"), "{stderr}");
}

#[test]
fn a_file_keeps_its_mode_and_a_link_leads_on() {
    let dir = tempfile::tempdir().unwrap();
    let secret = dir.path().join("secret.csv");
    fs::write(&secret, "old").unwrap();
    fs::set_permissions(&secret, fs::Permissions::from_mode(0o600)).unwrap();
    // A link to nothing yet, by way of another.
    symlink("second.csv", dir.path().join("first.csv")).unwrap();
    symlink("third.csv", dir.path().join("second.csv")).unwrap();
    for name in ["secret.csv", "first.csv"] {
        let map = ["map", "peak-end", "--q=0:1:2", "--e=0:1:2", "-o", name];
        assert_eq!(says(clatter().args(map).current_dir(dir.path())), (Some(0), String::new()));
    }
    assert_eq!(fs::metadata(&secret).unwrap().permissions().mode() & 0o777, 0o600);
    assert!(fs::read_to_string(dir.path().join("third.csv")).unwrap().starts_with("q,"));
    assert!(fs::symlink_metadata(dir.path().join("first.csv")).unwrap().is_symlink());
    assert_eq!(names(dir.path()), ["first.csv", "second.csv", "secret.csv", "third.csv"]);
}

/// Signals that a child of the tests heeds. What starts them may have some ignored, as a script's background does for INT, and a
/// child ignores those as well.
fn heeded() -> Vec<(&'static str, i32)> {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    let heeds = |number: i32| ignored.is_none_or(|mask| mask >> (number - 1) & 1 == 0);
    [("INT", 2), ("TERM", 15), ("KILL", 9)].into_iter().filter(|(_, number)| heeds(*number)).collect()
}

/// Stopped at any moment, a run leaves the old file and nothing beside it.
#[test]
fn a_run_that_is_stopped_leaves_no_temporary() {
    let dir = tempfile::tempdir().unwrap();
    let product = product(dir.path());
    let samples = dir.path().join("samples.csv");
    let mut stopped = 0;
    for (n, (signal, number)) in heeded().into_iter().cycle().take(36).enumerate() {
        fs::write(&samples, "old").unwrap();
        let mut child = clatter()
            .args(["scatter", "--samples=1000000000"])
            .arg(&product)
            .arg("-o")
            .arg(&samples)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        sleep(Duration::from_millis(3 + 9 * n as u64));
        assert!(Command::new("kill").arg(format!("-{signal}")).arg(child.id().to_string()).status().unwrap().success());
        let status = child.wait().unwrap();
        assert_eq!(status.signal(), Some(number), "{status}");
        assert_eq!(names(dir.path()), ["p.toml", "samples.csv"], "after {signal}");
        assert_eq!(fs::read_to_string(&samples).unwrap(), "old");
        stopped += 1;
    }
    assert_eq!(stopped, 36);
}

/// A run that is stopped while it fetches typst ends what fetches, and leaves nothing of it.
#[test]
fn a_run_that_is_stopped_while_it_fetches_typst_leaves_nothing() {
    for (signal, number) in heeded().into_iter().filter(|(signal, _)| *signal != "KILL") {
        let dir = tempfile::tempdir().unwrap();
        let python = dir.path().join("python3");
        // It makes an environment out of itself, says so, and lives on for as long as it may.
        fs::write(
            &python,
            "#!/bin/sh\ncase $3 in venv) mkdir $4/bin; cp $0 $4/bin/python;; \
             *) touch fetched; touch $HERE/fetching; sleep 2; touch $HERE/alive; esac\n",
        )
        .unwrap();
        fs::set_permissions(&python, fs::Permissions::from_mode(0o755)).unwrap();
        fs::create_dir(dir.path().join("tmp")).unwrap();
        let mut child = clatter()
            .args(["report", "paper", "-o", "out"])
            .current_dir(dir.path())
            .env("HERE", dir.path())
            .env("TMPDIR", dir.path().join("tmp"))
            .env("XDG_CACHE_HOME", dir.path().join("cache"))
            .env("PATH", format!("{}:/bin", dir.path().display()))
            .env("CARGO", "/nowhere")
            .env_remove("CLATTER_TYPST")
            .env_remove("CLATTER_NO_INSTALL")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        while !dir.path().join("fetching").exists() {
            assert!(child.try_wait().unwrap().is_none(), "it fetches until it is stopped");
            sleep(Duration::from_millis(5));
        }
        let killed = Command::new("kill").arg(format!("-{signal}")).arg(child.id().to_string()).status();
        assert!(killed.unwrap().success());
        assert_eq!(child.wait().unwrap().signal(), Some(number));
        let cache = dir.path().join("cache/clatter");
        let [versioned] = &names(&cache)[..] else { panic!("{:?}", names(&cache)) };
        assert_eq!(names(&cache.join(versioned)), ["lock"], "after {signal}");
        assert_eq!(names(&dir.path().join("tmp")), [""; 0], "after {signal}");
        sleep(Duration::from_millis(2200));
        assert!(!dir.path().join("alive").exists(), "what fetches lived on");
    }
}

/// As it is for what a script starts in the background.
#[test]
fn a_signal_that_is_ignored_from_the_start_stays_so() {
    let dir = tempfile::tempdir().unwrap();
    let product = product(dir.path());
    let script = "trap '' INT; \"$0\" scatter \"$1\" --samples=3000 >out & sleep 0.05; kill -INT $!; wait $!";
    let status = Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_clatter")])
        .arg(&product)
        .current_dir(dir.path())
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(0));
    assert!(fs::read_to_string(dir.path().join("out")).unwrap().contains("survives"));
}

/// A stack that no machine has stands in for a limit on threads.
#[test]
fn where_no_thread_can_be_made_one_is_enough() {
    let dir = tempfile::tempdir().unwrap();
    let product = product(dir.path());
    let product = product.to_str().unwrap();
    for arguments in [
        &["map", "peak-end", "--q=0:1:64", "--e=0:1:64", "-o", "map.csv"][..],
        &["assess", product],
        &["scatter", product, "--samples=200", "--seed=1"],
        &["explain", product],
    ] {
        let with = clatter().args(arguments).current_dir(dir.path()).output().unwrap();
        let without = clatter()
            .args(arguments)
            .env("RUST_MIN_STACK", "1000000000000000")
            .current_dir(dir.path())
            .output()
            .unwrap();
        let stderr = String::from_utf8(without.stderr).unwrap();
        assert_eq!((without.status.code(), stderr.as_str()), (with.status.code(), ""), "{arguments:?}");
        assert!(with.stdout == without.stdout, "{arguments:?}");
    }
    let many = clatter().args(["assess", product]).env("RAYON_NUM_THREADS", "100000").output().unwrap();
    assert_eq!(many.status.code(), Some(0));
}

#[test]
fn a_budget_that_is_used_up_ends_the_command_with_nothing_left_behind() {
    let dir = tempfile::tempdir().unwrap();
    let endless = [
        "simulate",
        "--model=finite-tilt",
        "--length-m=0.2",
        "--gyration-m=0.05",
        "--e=1",
        "--speed-m-s=3",
        "--tilt-deg=3",
        "--impact-limit=10000000",
        "--memory=64MB",
    ];
    let timeless: Vec<&str> = endless[..8].iter().copied().chain(["--time-limit=300ms", "--memory=2GiB"]).collect();
    for (arguments, why) in [(&timeless[..], "--time-limit is over"), (&endless, "--memory=61 MiB is used up")] {
        let (code, stderr) = says(clatter().args(arguments).current_dir(dir.path()));
        assert_eq!(code, Some(2), "{arguments:?}: {stderr}");
        assert!(stderr.starts_with("error: stopped, ") && stderr.contains(why), "{stderr}");
        assert!(names(dir.path()).is_empty(), "{arguments:?}");
    }
    let map = ["map", "peak-end", "--q=0:1:16384", "--e=0:1:16384", "-o", "m.npy"];
    let (code, stderr) = says(clatter().args(map).current_dir(dir.path()));
    assert_eq!(code, Some(2));
    assert!(stderr.contains("allowed are 67108864 points"), "{stderr}");
    // Sixteen bytes a point: two million points are within 64 MB, five million are not.
    for (points, code) in [(1400, 0), (2300, 2)] {
        let axes = [format!("--q=0:1:{points}"), format!("--e=0:1:{points}")];
        let map = ["map", "peak-end", &axes[0], &axes[1], "--memory=64MB", "-o", "m.npy"];
        let (got, stderr) = says(clatter().args(map).current_dir(dir.path()));
        assert_eq!(got, Some(code), "{points}: {stderr}");
    }
}

/// Many stiff parts on an elastic product: some seconds of search.
fn long() -> String {
    let product = "[product]\nname = \"long\"\nlength = \"150 mm\"\nradius_of_gyration = \"41 mm\"\nrestitution = [0, 0.9]\n\
        contact_time = [\"0.02 ms\", \"0.4 ms\"]\n[drop]\nspeed = [\"2 m/s\", \"4 m/s\"]\ntilt = [\"0.5 deg\", \"30 deg\"]\n\
        first = \"either\"\n";
    let part = |k: u32| {
        format!(
            "[[component]]\nname = \"part {k}\"\nposition = \"{k} mm\"\nnatural_frequency = [\"{}00 Hz\", \"30 kHz\"]\n\
             damping_ratio = [0.01, 0.05]\nacceleration_limit = \"100000 gn\"\n",
            k + 2
        )
    };
    (0..70).map(part).fold(product.to_owned(), |text, part| text + &part)
}

#[test]
fn what_is_found_when_the_time_is_over_is_told_and_nothing_is_safe_by_it() {
    let dir = tempfile::tempdir().unwrap();
    let product = product(dir.path());
    fs::write(dir.path().join("long.toml"), long()).unwrap();
    let samples = ["scatter", product.to_str().unwrap(), "--samples=1000000000", "-o", "s.csv"];
    let (code, stderr) = says(clatter().args(samples).arg("--time-limit=3s").current_dir(dir.path()));
    assert_eq!(code, Some(0), "{stderr}");
    assert!(
        stderr.contains("warning: --time-limit is over: the answer is of what was done by then; fewer"),
        "{stderr}"
    );
    assert!(fs::read_to_string(dir.path().join("s.csv")).unwrap().ends_with('\n'), "whole rows");
    let assess = ["assess", "long.toml", "--time-limit=2s"];
    let done = clatter().args(assess).current_dir(dir.path()).output().unwrap();
    let (stdout, stderr) = (String::from_utf8(done.stdout).unwrap(), String::from_utf8(done.stderr).unwrap());
    assert_eq!(done.status.code(), Some(1), "{stderr}");
    assert!(stdout.contains("undecided") && stdout.contains("was stopped before its end"), "{stdout}");
    assert!(stderr.contains("--time-limit is over"), "{stderr}");
}

/// Where nobody can be told why, a command ends at its budget all the same.
#[cfg(target_os = "linux")]
#[test]
fn a_budget_ends_a_command_that_cannot_say_so() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("long.toml"), long()).unwrap();
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let mut child = clatter()
        .args(["explain", "long.toml", "--time-limit=300ms"])
        .current_dir(dir.path())
        .stdout(Stdio::null())
        .stderr(full)
        .spawn()
        .unwrap();
    for _ in 0..600 {
        if let Some(status) = child.try_wait().unwrap() {
            assert_eq!(status.code(), Some(2));
            return;
        }
        sleep(Duration::from_millis(100));
    }
    child.kill().unwrap();
    panic!("it goes on after its end");
}

/// Standard error is a terminal, standard output is none.
#[test]
fn progress_is_shown_to_those_who_watch_and_leaves_no_trace() {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("long.toml"), long()).unwrap();
    let terminal = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&terminal).unwrap();
    unlockpt(&terminal).unwrap();
    let other = ptsname(&terminal, Vec::new()).unwrap().into_string().unwrap();
    let mut shown = fs::File::from(terminal);
    let stderr = fs::File::options().read(true).write(true).open(other).unwrap();
    let mut child = clatter()
        .args(["assess", "long.toml", "--time-limit=2s"])
        .current_dir(dir.path())
        .stdout(Stdio::null())
        .stderr(stderr)
        .spawn()
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(1));
    let mut text = vec![0; 1 << 16];
    let length = std::io::Read::read(&mut shown, &mut text).unwrap();
    let text = String::from_utf8_lossy(&text[..length]);
    assert!(text.starts_with("\rsearching  [") && text.contains(" s left"), "{text:?}");
    let (bar, after) = text.trim_end().rsplit_once('\r').unwrap();
    assert!(bar.ends_with(&" ".repeat(70)), "the line is cleared: {text:?}");
    assert!(after.starts_with("warning: --time-limit"), "{text:?}");
}

#[test]
fn a_history_of_gigabytes_is_written_only_where_it_is_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    let drop = [
        "simulate",
        "--model=finite-tilt",
        "--length-m=0.2",
        "--gyration-m=0.05",
        "--e=1",
        "--speed-m-s=3",
        "--tilt-deg=3",
    ];
    for file in ["long.csv", "long.json", "long.svg"] {
        let (code, stderr) = says(clatter().args(drop).args(["-o", file]).current_dir(dir.path()));
        assert!(code == Some(2) && stderr.contains("more than 4 million rows"), "{stderr}");
        let asked = ["-o", file, "--impact-limit=1000"];
        assert_eq!(says(clatter().args(drop).args(asked).current_dir(dir.path())).0, Some(0));
    }
    assert_eq!(names(dir.path()), ["long.csv", "long.json", "long.svg"]);
}

/// Runs a command with this as its standard input.
fn piped(arguments: &[&str], input: &[u8], dir: &Path) -> std::process::Output {
    let mut child = clatter()
        .args(arguments)
        .current_dir(dir)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    // What is refused unread closes the pipe.
    let _ = std::io::Write::write_all(&mut child.stdin.take().expect("a pipe"), input);
    child.wait_with_output().expect("it ends")
}

/// A file may be the input without its name.
#[test]
fn standard_input_is_not_written_over() {
    let dir = tempfile::tempdir().unwrap();
    let record = "time [ms],acceleration [g]\n0,0\n1,100\n2,0\n3,0\n";
    fs::write(dir.path().join("record.csv"), record).unwrap();
    symlink("record.csv", dir.path().join("link.csv")).unwrap();
    for name in ["record.csv", "link.csv"] {
        let input = fs::File::open(dir.path().join("record.csv")).unwrap();
        let spectrum = ["spectrum", "-", "--frequency=100Hz", "-o", name];
        let (code, stderr) = says(clatter().args(spectrum).current_dir(dir.path()).stdin(input));
        assert!(code == Some(2) && stderr.contains("is read by this command and would be lost"), "{stderr}");
        assert_eq!(fs::read_to_string(dir.path().join("record.csv")).unwrap(), record);
    }
}

#[test]
fn a_dash_is_standard_input() {
    let dir = tempfile::tempdir().unwrap();
    product(dir.path());
    let shocks = "time_s,delta_v_m_s\n0,2.5\n0.004,-1\n";
    let pulses = "shape,amplitude_m_s2,duration_s,start_s\nHalf sine,5000,0.0005,0\n";
    let record = "time [ms],acceleration [G]\n0,0\n1,100\n2,0\n3,0\n";
    let tests =
        "test,level,damaged\nvelocity-change,2,no\nvelocity-change,3,yes\nacceleration,700,no\nacceleration,900,yes\n";
    for (name, text) in [("shocks.csv", shocks), ("pulses.csv", pulses), ("record.csv", record), ("tests.csv", tests)] {
        fs::write(dir.path().join(name), text).unwrap();
    }
    for (name, arguments) in [
        ("p.toml", &["assess", "p.toml", "--format=json"][..]),
        ("p.toml", &["scatter", "p.toml", "--samples=50", "--format=json"]),
        ("p.toml", &["explain", "p.toml", "--format=json"]),
        ("p.toml", &["design", "p.toml", "--format=json"]),
        ("p.toml", &["simulate", "--product=p.toml", "--format=csv"]),
        ("p.toml", &["respond", "--product=p.toml", "--component=display"]),
        ("shocks.csv", &["respond", "--omega=100", "--shocks-file=shocks.csv", "--format=json"]),
        ("pulses.csv", &["spectrum", "--pulses-file=pulses.csv", "--format=csv"]),
        ("record.csv", &["spectrum", "record.csv", "--format=csv"]),
        ("tests.csv", &["spectrum", "--pulse=rectangle,900,0.004", "--damage-boundary", "--tests=tests.csv"]),
    ] {
        let dashed: Vec<_> = arguments.iter().map(|argument| argument.replace(name, "-")).collect();
        let dashed: Vec<_> = dashed.iter().map(String::as_str).collect();
        let input = fs::read(dir.path().join(name)).unwrap();
        let (from_file, from_input) = (piped(arguments, b"", dir.path()), piped(&dashed, &input, dir.path()));
        let stderr = String::from_utf8_lossy(&from_input.stderr);
        assert_eq!(from_input.status.code(), from_file.status.code(), "{dashed:?}: {stderr}");
        assert_ne!(from_input.status.code(), Some(2), "{dashed:?}: {stderr}");
        let plain = String::from_utf8(from_file.stdout).unwrap().replace(name, "-");
        assert_eq!(String::from_utf8(from_input.stdout).unwrap(), plain, "{dashed:?}");
    }
    for (arguments, input, said) in [
        (&["assess", "-"][..], "[product]\nname = 1\n", "--> standard input:2:8"),
        (
            &["respond", "--omega=1", "--shocks-file=-"],
            "time_s,delta_v_m_s\n0\n",
            "error: standard input: line 2: 1 cell",
        ),
        (&["spectrum", "-"], "no numbers\n", "error: standard input: "),
        (&["assess", "-"], "\u{0}", "invalid TOML"),
    ] {
        let done = piped(arguments, input.as_bytes(), dir.path());
        let stderr = String::from_utf8(done.stderr).unwrap();
        assert!(done.status.code() == Some(2) && stderr.contains(said), "{arguments:?}: {stderr}");
    }
    assert!(!dir.path().join("-").exists(), "no file of that name");
}
