//! Files of the user: no command writes over one that it needs, that another output takes, or that is protected.

#![cfg(unix)]

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::process::Command;

use clatter_cli::Exit;

use crate::{Outcome, clatter};

const STRIKES: &str = "time_s,end\n0,a\n0.0050,b\n0.0081,a\n";
const SHOCK: &str = "time [s],acceleration [m/s2]\n0,0\n0.001,5\n0.002,5\n0.003,0\n";

/// A product file that names these records.
fn product(records: &[&str]) -> String {
    let named: Vec<_> = records.iter().map(|file| format!("[[record]]\nfile = \"{file}\"\n")).collect();
    format!("{}\n{}", include_str!("../cases/bar-handheld.toml"), named.concat())
}

/// The folder of a test: product, record, and what else is read.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        folder.write("p.toml", &product(&["rec.csv", "sub/../rec.pdf", "gone.csv", "rec.svg", "rec.toml"]));
        for record in ["rec.csv", "rec.pdf", "rec.svg", "rec.toml"] {
            folder.write(record, STRIKES);
        }
        for (name, text) in [
            ("shock.csv", SHOCK),
            ("shocks.csv", "time_s,delta_v_m_s\n0,1\n"),
            ("tests.csv", "test,level,damaged\nacceleration,1,yes\n"),
            ("limit.csv", "frequency [Hz],acceleration [m/s2]\n10,100\n1000,1000\n"),
        ] {
            folder.write(name, text);
        }
        fs::create_dir(folder.0.path().join("sub")).unwrap();
        folder
    }
    fn at(&self, name: &str) -> String {
        self.0.path().join(name).to_str().unwrap().to_owned()
    }
    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.path().join(name), text).unwrap();
    }
    /// Every file, with what is in it.
    fn all(&self) -> Vec<(String, Vec<u8>)> {
        let files = fs::read_dir(self.0.path()).unwrap().map(|entry| entry.unwrap().path());
        let regular = files.filter(|path| fs::metadata(path).is_ok_and(|file| file.is_file()));
        let mut all: Vec<_> =
            regular.map(|path| (path.display().to_string(), fs::read(&path).unwrap_or_default())).collect();
        all.sort();
        all
    }
    /// A refusal that says so, and leaves every file as it was.
    fn refused(&self, arguments: &[String], says: &str) {
        let before = self.all();
        let Outcome { exit, stdout, stderr } = clatter(arguments);
        assert_eq!((exit, stdout.as_str()), (Exit::BadInput, ""), "{arguments:?}: {stderr}");
        assert!(stderr.contains(says) && stderr.lines().count() == 1, "{arguments:?}: {stderr}");
        assert!(before == self.all(), "{arguments:?}");
    }
}

/// Every command that reads a product and writes: its arguments up to the output, and how that ends.
fn writers(folder: &Folder) -> Vec<(Vec<String>, &'static str)> {
    let (p, of) = (folder.at("p.toml"), format!("--product={}", folder.at("p.toml")));
    let words = |words: &[&str]| words.iter().map(|&word| word.to_owned()).collect::<Vec<_>>();
    vec![
        (words(&["assess", &p, "-o"]), "pdf"),
        (words(&["scatter", &p, "--samples=10", "-o"]), "csv"),
        (words(&["design", &p, "-o"]), "csv"),
        (words(&["design", &p, "-o"]), "svg"),
        (words(&["tradeoff", &p, "-o"]), "svg"),
        (words(&["simulate", &of, "-o"]), "csv"),
        (words(&["fit", &folder.at("rec.csv"), &of, "-o"]), "svg"),
        (words(&["fit", &folder.at("shocks.csv"), &of, "-o"]), "toml"),
    ]
}

#[test]
fn no_command_writes_over_a_record_that_its_product_names() {
    let folder = Folder::new();
    for ending in ["csv", "pdf", "svg", "toml"] {
        symlink(folder.at("rec.csv"), folder.at(&format!("link.{ending}"))).unwrap();
        symlink(format!("link.{ending}"), folder.at(&format!("far.{ending}"))).unwrap();
        fs::hard_link(folder.at(&format!("rec.{ending}")), folder.at(&format!("hard.{ending}"))).unwrap();
    }
    for (arguments, ending) in writers(&folder) {
        for name in ["rec", "./rec", "sub/../rec", "sub/.././rec", "link", "far", "hard"] {
            let output = folder.at(&format!("{name}.{ending}"));
            let says = match (name, ending) {
                // What a fit reads is told as such.
                ("link" | "far", "svg") if arguments[0] == "fit" => "is read by this command and would be lost",
                _ => "is a record that",
            };
            folder.refused(&[&arguments[..], &[output]].concat(), says);
        }
    }
    // Not there yet, and named all the same; a record is not written over for the asking either.
    let gone = ["scatter", &folder.at("p.toml"), "--samples=10", "-o", &folder.at("./gone.csv")].map(str::to_owned);
    folder.refused(&gone, "is a record that");
    let forced = ["scatter", &folder.at("p.toml"), "--force", "-o", &folder.at("rec.csv")].map(str::to_owned);
    folder.refused(&forced, "is a record that");
    // Any other name is taken.
    let outcome = clatter(["scatter", &folder.at("p.toml"), "--samples=10", "-o", &folder.at("other.csv")]);
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
}

#[test]
fn one_output_under_two_names_is_refused() {
    let folder = Folder::new();
    symlink("sub", folder.at("alias")).unwrap();
    symlink(folder.at("d.svg"), folder.at("link.svg")).unwrap();
    for (one, other) in [
        ("d.svg", "d.svg"),
        ("d.svg", "./d.svg"),
        ("d.svg", "sub/../d.svg"),
        ("sub/d.svg", "alias/d.svg"),
        ("d.svg", "link.svg"),
    ] {
        let outputs = ["-o".to_owned(), folder.at(one), format!("--front={}", folder.at(other))];
        for force in [&[][..], &["--force".to_owned()]] {
            folder.refused(&[&["design".to_owned()][..], &outputs, force].concat(), "is to be written twice");
        }
        assert!(!Path::new(&folder.at("d.svg")).exists());
    }
    let outcome = clatter(["design", "-o", &folder.at("d.svg"), &format!("--front={}", folder.at("D.svg"))]);
    assert_eq!(outcome.exit, Exit::Done, "two names are two files here: {}", outcome.stderr);
}

#[test]
fn what_is_no_file_is_refused_before_it_is_opened() {
    let folder = Folder::new();
    assert!(Command::new("mkfifo").arg(folder.at("fifo.csv")).status().unwrap().success());
    symlink("fifo.csv", folder.at("link.csv")).unwrap();
    let _socket = UnixListener::bind(folder.at("socket.csv")).unwrap();
    symlink("/dev/full", folder.at("full.csv")).unwrap();
    fs::create_dir(folder.at("dir.csv")).unwrap();
    for (name, says) in [
        ("fifo.csv", "not a regular file"),
        ("link.csv", "not a regular file"),
        ("socket.csv", "not a regular file"),
        ("full.csv", "not a regular file"),
        ("dir.csv", "directory"),
        ("nowhere/x.csv", "there is no directory"),
    ] {
        for force in ["", "--force"] {
            for command in [
                &["scatter", &folder.at("p.toml"), "--samples=10", "-o", &folder.at(name)][..],
                &["spectrum", &folder.at("shock.csv"), "-o", &folder.at(name)],
                &["map", "duration", "--q=0:0.5:2", "--e=0:0.5:2", "-o", &folder.at(name)],
                &["design", "--front", &folder.at(name)],
            ] {
                let words = command.iter().chain([&force]).filter(|word| !word.is_empty());
                folder.refused(&words.map(|&word| word.to_owned()).collect::<Vec<_>>(), says);
            }
        }
    }
    let init = clatter(["init", &folder.at("fifo.csv")]);
    assert!(init.exit == Exit::BadInput && init.stderr.contains("is there already"), "{}", init.stderr);
}

#[test]
fn a_write_protected_output_needs_force() {
    let folder = Folder::new();
    let map = |name: &str| ["map", "duration", "--q=0:0.5:2", "--e=0:0.5:2", "-o", &folder.at(name)].map(str::to_owned);
    folder.write("old.csv", "old");
    fs::set_permissions(folder.at("old.csv"), fs::Permissions::from_mode(0o444)).unwrap();
    symlink("old.csv", folder.at("link.csv")).unwrap();
    for name in ["old.csv", "link.csv"] {
        folder.refused(&map(name), "is write-protected");
    }
    let outcome = clatter([&map("old.csv")[..], &["--force".to_owned()]].concat());
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    assert!(fs::read_to_string(folder.at("old.csv")).unwrap().starts_with("q,"));
    assert_eq!(fs::metadata(folder.at("old.csv")).unwrap().permissions().mode() & 0o777, 0o444, "as it was");
}

#[test]
fn what_lists_and_limits_are_read_from_is_spared() {
    let folder = Folder::new();
    let boundary = ["spectrum", "--pulse=rectangle,900,0.004", "--damage-boundary", "--frequency=1"];
    let all: [(&[&str], &str); 4] = [
        (&["spectrum", "--shocks-file=shocks.csv"], "shocks.csv"),
        (&[&boundary[..], &["--tests=tests.csv"]].concat(), "tests.csv"),
        (&["spectrum", "shock.csv", "--limit-file=limit.csv"], "limit.csv"),
        (&["record", "shock.csv"], "shock.csv"),
    ];
    for (arguments, read) in all {
        fs::hard_link(folder.at(read), folder.at(&format!("hard-{read}"))).unwrap_or_default();
        for output in [read.to_owned(), format!("sub/../{read}"), format!("hard-{read}")] {
            let placed = arguments.iter().map(|word| match word.split_once('=') {
                Some((flag, file)) if file.contains(".csv") => format!("{flag}={}", folder.at(file)),
                None if word.contains(".csv") => folder.at(word),
                _ => (*word).to_owned(),
            });
            let arguments: Vec<_> = placed.chain(["-o".to_owned(), folder.at(&output)]).collect();
            folder.refused(&arguments, "is read by this command and would be lost");
        }
    }
}
