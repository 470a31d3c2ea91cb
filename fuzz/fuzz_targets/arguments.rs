//! A command line, its arguments line by line: commands that answer at once, and write no file.

#![no_main]

use clatter_cli::{Exit, Streams, run};
use libfuzzer_sys::fuzz_target;

const COMMANDS: [&str; 6] = ["zone", "impacts", "atlas", "respond", "simulate", "spectrum"];
/// What writes files, or asks for work without end.
const LEFT_OUT: [&str; 4] = ["-o", "--output", "--limit", "--impact-limit"];

fuzz_target!(|text: &str| {
    let arguments: Vec<&str> = text.lines().collect();
    let named = arguments.first().is_some_and(|first| COMMANDS.contains(first));
    // Standard input may have no end.
    let waits = arguments.iter().any(|argument| *argument == "-" || argument.ends_with("=-"));
    if !named || waits || arguments.iter().any(|argument| LEFT_OUT.iter().any(|option| argument.starts_with(option))) {
        return;
    }
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let mut streams = Streams { out: &mut out, err: &mut err, interactive: false };
    let exit = run(std::iter::once("clatter").chain(arguments), &mut streams);
    assert!(matches!(exit, Exit::Done | Exit::BadInput));
    let shown = String::from_utf8(err).expect("text");
    assert!(shown.chars().all(|c| c == '\n' || !c.is_control()), "{shown:?}");
});
