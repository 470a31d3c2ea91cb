//! Acceptance tests: the command as users and their scripts see it.
//!
//! They run the command within the test process; what needs a process of its own (a closed pipe, a full disk) is
//! tested beside the binary, in `crates/clatter-cli/tests`.

#![cfg(test)]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

mod assess;
mod bad_input;
mod block;
#[path = "../../crates/clatter/tests/cases/mod.rs"]
mod cases;
mod design;
mod docs;
mod explain;
mod extremes;
mod fit;
mod hostile;
mod json;
mod map;
mod nothing_lost;
mod off_center;
mod oracle;
mod plate;
mod plate_drop;
mod products;
mod reached;
mod record;
mod respond;
mod scatter;
mod simulate;
mod spectrum;
mod study;
mod tables;
mod threads;
mod torn;
mod tradeoff;
mod typed;
mod verdicts;
mod versions;

use clatter_cli::{Exit, Streams, run};
use serde_json::Value;

/// What came of one call.
struct Outcome {
    exit: Exit,
    stdout: String,
    stderr: String,
}

/// Calls `clatter` with these arguments.
fn clatter<S: AsRef<str>>(arguments: impl IntoIterator<Item = S>) -> Outcome {
    let arguments: Vec<String> = arguments.into_iter().map(|argument| argument.as_ref().to_owned()).collect();
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let mut streams = Streams { out: &mut out, err: &mut err, interactive: false };
    let exit = run(std::iter::once("clatter".to_owned()).chain(arguments), &mut streams);
    Outcome { exit, stdout: String::from_utf8(out).unwrap(), stderr: String::from_utf8(err).unwrap() }
}

/// Whether nothing is told but warnings of values that no product has.
fn warns_of_slips_alone(stderr: &str) -> bool {
    let slip =
        |line: &str| line.contains(" is none that products have, ") || line.contains(" is outside of the body, ");
    stderr.lines().all(|line| line.starts_with("warning: ") && slip(line))
}

/// Calls `clatter` for an answer in JSON, which must come alone but for warnings of what no product has; its version is seen to, and left
/// out.
fn answer<S: AsRef<str>>(arguments: impl IntoIterator<Item = S>) -> Value {
    let arguments = arguments.into_iter().map(|argument| argument.as_ref().to_owned());
    let outcome = clatter(arguments.chain(["--format=json".to_owned()]));
    let sound = outcome.exit == Exit::Done && warns_of_slips_alone(&outcome.stderr);
    assert!(sound, "{:?}: {}{}", outcome.exit, outcome.stderr, outcome.stdout);
    let mut answer: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let version = answer.as_object_mut().expect("an object").remove("clatter");
    assert_eq!(version, Some(env!("CARGO_PKG_VERSION").into()), "every answer tells its version");
    answer
}
