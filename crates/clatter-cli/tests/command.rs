//! What needs a process of its own: closed pipes, full disks, exit codes.

#![cfg(test)]

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

fn clatter() -> Command {
    Command::new(env!("CARGO_BIN_EXE_clatter"))
}

#[test]
fn exit_codes_are_those_of_the_contract() {
    let code = |arguments: &[&str]| clatter().args(arguments).output().unwrap().status.code();
    assert_eq!(code(&["impacts", "--q=0.5", "--e=0.3"]), Some(0));
    assert_eq!(code(&["--help"]), Some(0));
    assert_eq!(code(&["impacts", "--q=0.5", "--e=3"]), Some(2));
    assert_eq!(code(&[]), Some(2));
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    for format in ["table", "json", "csv"] {
        let mut child = clatter()
            .args(["impacts", "--q=0.9", "--e=0.3", "--limit=18446744073709551615", "--format", format])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut reader = BufReader::new(child.stdout.take().unwrap());
        if format == "json" {
            reader.read_until(b'}', &mut Vec::new()).unwrap();
        } else {
            reader.read_line(&mut String::new()).unwrap();
        }
        drop(reader);
        let done = child.wait_with_output().unwrap();
        assert_eq!((done.status.code(), String::from_utf8(done.stderr).unwrap()), (Some(0), String::new()), "{format}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_cannot_be_written_is_an_error_even_if_it_is_short() {
    for arguments in [&["impacts", "--q=0.5", "--e=0.3"][..], &["--version"], &["completions", "bash"]] {
        let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
        let done = clatter().args(arguments).stdout(full).output().unwrap();
        let stderr = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(2), "{stderr}");
        assert!(stderr.starts_with("error: cannot write the answer: No space left on device"), "{stderr}");
        assert_eq!(stderr.lines().count(), 1);
    }
}

/// Callers that want no answer open the null device to write, or to read and write. The second cannot be told from a
/// standard output that was closed, in whose place Rust opens the same: that answer is lost without an error.
#[cfg(unix)]
#[test]
fn an_answer_that_nobody_wants_is_no_error() {
    for nowhere in ["> /dev/null", "1<> /dev/null"] {
        let done = Command::new("sh")
            .args(["-c", &format!("exec \"$@\" {nowhere}"), "sh", env!("CARGO_BIN_EXE_clatter")])
            .args(["impacts", "--q=0.5", "--e=0.3"])
            .output()
            .unwrap();
        assert_eq!((done.status.code(), done.stderr), (Some(0), vec![]), "{nowhere}");
    }
}

/// The system tells of a standard output that is not open for writing.
#[cfg(unix)]
#[test]
fn an_answer_that_has_nowhere_to_go_is_an_error() {
    for arguments in [&["impacts", "--q=0.5", "--e=0.3"][..], &["--version"], &["init", "-"]] {
        let done = Command::new("sh")
            .args(["-c", "exec \"$@\" 1< /dev/null", "sh", env!("CARGO_BIN_EXE_clatter")])
            .args(arguments)
            .output()
            .unwrap();
        let stderr = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(2), "{stderr}");
        assert!(stderr.starts_with("error: cannot write the answer: "), "{stderr}");
    }
}

/// A limit on the size of files stands in for a full disk; the shell's `trap` decides whether reaching it is an error
/// or kills the process on the spot.
#[cfg(target_os = "linux")]
fn map_on_a_full_disk(reaching_it: &str, file: &std::path::Path) -> std::process::Output {
    Command::new("sh")
        .args([
            "-c",
            &format!("{reaching_it} ulimit -c 0; ulimit -f 8; exec \"$@\""),
            "sh",
            env!("CARGO_BIN_EXE_clatter"),
        ])
        .args(["map", "peak-end", "--q=0:0.5:100", "--e=0:0.1:100", "-o"])
        .arg(file)
        .output()
        .unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_and_leaves_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    for ending in ["csv", "json", "npy"] {
        let file = folder.path().join(format!("map.{ending}"));
        std::fs::write(&file, "older").unwrap();
        let done = map_on_a_full_disk("trap '' XFSZ;", &file);
        let stderr = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(2), "{stderr}");
        assert!(stderr.starts_with(&format!("error: cannot write {}: ", file.display())), "{stderr}");
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "older");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3, "nothing is left beside the files");
}

#[cfg(target_os = "linux")]
#[test]
fn a_run_killed_while_it_writes_leaves_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("map.npy");
    std::fs::write(&file, "older").unwrap();
    let done = map_on_a_full_disk("", &file);
    assert_eq!(done.status.code(), None, "killed by the signal");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "older");
}

/// A stand-in for typst that tells its version and then runs a script.
#[cfg(unix)]
fn stand_in(folder: &std::path::Path, script: &str) -> std::path::PathBuf {
    scripted_typst(folder, &format!("[ \"$1\" = --version ] && echo typst 0.15.1 && exit\n{script}\n"))
}

/// A stand-in for typst that does this.
#[cfg(unix)]
fn scripted_typst(folder: &std::path::Path, script: &str) -> std::path::PathBuf {
    use std::os::unix::fs::PermissionsExt;
    let program = folder.join("typst");
    std::fs::write(&program, format!("#!/bin/sh\n{script}")).unwrap();
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    // A process that another test starts holds the file open for a moment: until then it cannot be run.
    while let Err(error) = Command::new(&program).arg("--version").output() {
        assert_eq!(error.kind(), std::io::ErrorKind::ExecutableFileBusy, "{error}");
    }
    program
}

/// One that only fails.
#[cfg(unix)]
fn broken_typst(folder: &std::path::Path) -> std::path::PathBuf {
    stand_in(folder, "echo 'error: out of ink' >&2; exit 1")
}

#[cfg(unix)]
#[test]
fn a_typst_that_fails_is_told_apart_and_leaves_no_pdf() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let typst = broken_typst(folder.path());
    let done = clatter().args(["report", "paper", "-o"]).arg(&out).env("CLATTER_TYPST", typst).output().unwrap();
    let stderr = String::from_utf8(done.stderr).unwrap();
    assert_eq!((done.status.code(), done.stdout), (Some(3), vec![]), "{stderr}");
    assert!(stderr.starts_with("error: ") && stderr.contains("typst"), "{stderr}");
    let endings: Vec<_> = std::fs::read_dir(&out).unwrap().map(|file| file.unwrap().path()).collect();
    assert!(endings.iter().all(|file| file.extension().is_none_or(|ending| ending != "pdf")), "{endings:?}");
    assert!(endings.iter().any(|file| file.extension().is_some_and(|ending| ending == "json")), "{endings:?}");
}

/// The print of an assessment is beside its answer.
#[cfg(unix)]
#[test]
fn an_assessment_that_cannot_be_printed_is_told_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let (product, pdf) = (folder.path().join("p.toml"), folder.path().join("p.pdf"));
    assert!(clatter().arg("init").arg(&product).output().unwrap().status.success());
    let broken = broken_typst(folder.path());
    for format in ["table", "json"] {
        let assess = || {
            let mut command = clatter();
            command.arg("assess").arg(&product).args(["--format", format]);
            command
        };
        let alone = assess().output().unwrap();
        assert_eq!(alone.status.code(), Some(0));
        for typst in [broken.as_path(), "/nowhere/typst".as_ref()] {
            let done = assess().arg("-o").arg(&pdf).env("CLATTER_TYPST", typst).output().unwrap();
            let stderr = String::from_utf8(done.stderr).unwrap();
            assert_eq!(done.status.code(), Some(3), "{stderr}");
            assert!(stderr.starts_with("error: ") && stderr.contains("typst"), "{stderr}");
            assert!(done.stdout == alone.stdout && !pdf.exists(), "{}", String::from_utf8_lossy(&done.stdout));
        }
    }
}

/// A reader of the table that goes away early still has the print.
#[cfg(unix)]
#[test]
fn an_assessment_without_a_reader_is_printed_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let (product, pdf) = (folder.path().join("p.toml"), folder.path().join("p.pdf"));
    assert!(clatter().arg("init").arg(&product).output().unwrap().status.success());
    let typst = stand_in(folder.path(), "printf '%%PDF-1.7\\n%%%%EOF\\n' > page.pdf");
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut command = clatter();
    command.arg("assess").arg(&product).arg("-o").arg(&pdf).env("CLATTER_TYPST", typst).stdout(writer);
    let done = command.output().unwrap();
    let stderr = String::from_utf8(done.stderr).unwrap();
    assert!(done.status.success() && stderr.is_empty() && pdf.exists(), "{:?}: {stderr}", done.status);
}

/// As version, where it is a warning, and as reason of a failure.
#[cfg(unix)]
#[test]
fn what_typst_says_is_not_obeyed_by_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let script = "[ \"$1\" = --version ] && { printf 'typst \\033[31m9\\n'; exit; }\n\
                  printf 'page.typ: \\033[2J\\302\\233\\342\\200\\256\\a\\nmore\\r\\n' >&2\nexit 1\n";
    let typst = scripted_typst(folder.path(), script);
    let done = clatter().args(["report", "paper", "-o"]).arg(&out).env("CLATTER_TYPST", typst).output().unwrap();
    let stderr = String::from_utf8(done.stderr).unwrap();
    assert_eq!((done.status.code(), done.stdout), (Some(3), vec![]), "{stderr}");
    assert!(stderr.contains("page.typ: \\u{1b}[2J\\u{9b}\\u{202e}\\u{7}\nmore"), "{stderr:?}");
    assert!(stderr.chars().all(|c| c == '\n' || !(c.is_control() || c == '\u{202e}')), "{stderr:?}");
}

#[cfg(unix)]
#[test]
fn a_report_that_has_nowhere_to_go_is_bad_input() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let typst = broken_typst(folder.path());
    let done = clatter().args(["report", "-o"]).arg(&file).env("CLATTER_TYPST", typst).output().unwrap();
    let stderr = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(2), "{stderr}");
    assert!(stderr.starts_with("error: ") && stderr.contains(file.to_str().unwrap()), "{stderr}");
}

#[cfg(unix)]
#[test]
fn what_is_no_pdf_is_a_failure_of_typst_and_leaves_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let pdf = folder.path().join("paper.pdf");
    std::fs::write(&pdf, "older").unwrap();
    for script in ["true", ": > page.pdf", "echo junk > page.pdf"] {
        let typst = stand_in(folder.path(), script);
        let mut command = clatter();
        let done = command.args(["report", "paper", "-o"]).arg(folder.path()).env("CLATTER_TYPST", typst).output();
        let done = done.unwrap();
        let stderr = String::from_utf8(done.stderr).unwrap();
        assert_eq!((done.status.code(), done.stdout), (Some(3), vec![]), "{script}: {stderr}");
        assert!(stderr.contains("still the one from before"), "{script}: {stderr}");
        assert_eq!(std::fs::read_to_string(&pdf).unwrap(), "older", "{script}");
    }
}

#[cfg(unix)]
#[test]
fn a_typst_is_found_from_where_the_command_runs() {
    let page = "printf '%%PDF-1.7\n%%%%EOF\n' > page.pdf";
    for (name, value) in [("CLATTER_TYPST", "./typst"), ("CLATTER_TYPST", "typst"), ("PATH", ".:/usr/bin:/bin")] {
        let folder = tempfile::tempdir().unwrap();
        stand_in(folder.path(), page);
        let mut command = clatter();
        command.args(["report", "paper", "-o", "out"]).env_remove("CLATTER_TYPST").current_dir(folder.path());
        let done = command.env(name, value).output().unwrap();
        assert_eq!(done.status.code(), Some(0), "{name}={value}: {}", String::from_utf8_lossy(&done.stderr));
        assert_eq!(std::fs::read(folder.path().join("out/paper.pdf")).unwrap(), b"%PDF-1.7\n%%EOF\n", "{name}={value}");
    }
}
