//! The whole report beside typst alone on the same input, in turns: `cargo bench -p clatter-studies --bench report`.
//!
//! The time may be twice that of typst. The bench looks for typst as the report does, but builds none: run the report
//! once before.
#![expect(clippy::print_stdout, reason = "the times are what is wanted")]

use clatter_studies::{Report, write};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

const ROUNDS: usize = 11;

fn main() {
    let (report, input) = (tempfile::tempdir().expect("a directory"), tempfile::tempdir().expect("a directory"));
    let written = write(Report::Paper, report.path(), &mut |_| {}).expect("the report");
    for file in &written.files {
        std::fs::copy(file, input.path().join(file.file_name().expect("a name"))).expect("a copy");
    }
    let pages = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reports");
    for page in ["paper.typ", "style.typ"] {
        std::fs::copy(pages.join(page), input.path().join(page)).expect("a copy");
    }
    std::fs::write(input.path().join("page.json"), r#"{"version":"0"}"#).expect("a file");

    let named = std::env::var_os("CLATTER_TYPST").map(Into::into);
    let cached = || {
        let cache = std::env::var_os("XDG_CACHE_HOME").map(Into::into);
        let home = || std::env::home_dir().expect("a home").join(".cache");
        cache.unwrap_or_else(home).join("clatter/typst-0.15.1/bin/typst")
    };
    let path = std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default())
        .map(|dir| dir.join("typst"))
        .find(|file| file.is_file());
    let typst = named.or(path).unwrap_or_else(cached);

    let time = |work: &dyn Fn()| {
        let start = Instant::now();
        work();
        start.elapsed()
    };
    let whole = || {
        write(Report::Paper, report.path(), &mut |_| {}).expect("the report");
    };
    let alone = || {
        let arguments = ["compile", "--ignore-system-fonts", "--pdf-standard", "ua-1", "--root", ".", "paper.typ"];
        let done = Command::new(&typst).args(arguments).current_dir(input.path()).status().expect("typst");
        assert!(done.success(), "typst failed");
    };
    let mut rounds: Vec<(Duration, Duration)> = (0..ROUNDS).map(|_| (time(&whole), time(&alone))).collect();
    rounds.sort_by(|a, b| (a.0.as_secs_f64() / a.1.as_secs_f64()).total_cmp(&(b.0.as_secs_f64() / b.1.as_secs_f64())));
    let (whole, alone) = rounds[ROUNDS / 2];
    let ratio = whole.as_secs_f64() / alone.as_secs_f64();
    println!("report {whole:.0?}, typst alone {alone:.0?}: {ratio:.2} times (median of {ROUNDS}; allowed 2)");
}
