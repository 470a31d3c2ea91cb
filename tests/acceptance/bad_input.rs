//! Bad input: one message that names the flag, the value and what is allowed, exit 2, and nothing on stdout.

use clatter_cli::Exit;

use crate::clatter;

/// Each row: arguments, and what the message has to say.
#[rustfmt::skip]
const REFUSED: &[(&[&str], &[&str])] = &[
    // Inertia: exactly one way, within its range.
    (&["impacts", "--q=1.0000000000000002", "--e=0"], &["--q", "1.0000000000000002", "(-1, 1]"]),
    (&["impacts", "--q=-1", "--e=0"], &["--q", "-1", "(-1, 1]"]),
    (&["impacts", "--q=nan", "--e=0"], &["--q", "nan", "(-1, 1]"]),
    (&["impacts", "--q=-inf", "--e=0"], &["--q", "-inf", "(-1, 1]"]),
    (&["impacts", "--q=1e308", "--e=0"], &["--q", "1e308", "(-1, 1]"]),
    (&["impacts", "--q=0,5", "--e=0"], &["--q", "'0,5' is not a number such as 0.5"]),
    (&["impacts", "--q=", "--e=0"], &["--q", "'' is not a number"]),
    (&["impacts", "--q= 0.5", "--e=0"], &["--q", "' 0.5' is not a number"]),
    (&["impacts", "--e=0"], &["--q <Q>|--gyration-ratio <K>"]),
    (&["impacts", "--q=0.5", "--gyration-ratio=1", "--e=0"], &["--q", "--gyration-ratio", "cannot be used with"]),
    (&["impacts", "--q=0.5", "--q=0.5", "--e=0"], &["--q", "multiple times"]),
    (&["impacts", "--gyration-ratio=-0.1", "--e=0"], &["--gyration-ratio", "-0.1"]),
    (&["impacts", "--gyration-ratio=1e308", "--e=0"], &["--gyration-ratio", "1e308"]),
    (&["impacts", "--gyration-ratio=NaN", "--e=0"], &["--gyration-ratio", "NaN"]),
    // Restitution.
    (&["impacts", "--q=0.5"], &["--e <E>"]),
    (&["impacts", "--q=0.5", "--e=1.0000000000000002"], &["--e", "1.0000000000000002", "[0, 1]"]),
    (&["impacts", "--q=0.5", "--e=-5e-324"], &["--e", "-5e-324", "[0, 1]"]),
    (&["impacts", "--q=0.5", "--e=inf"], &["--e", "inf", "[0, 1]"]),
    (&["impacts", "--q=0.5", "--e=30%"], &["--e", "'30%' is not a number"]),
    // Start: end a has to come down, at a speed that leaves room for the results.
    (&["impacts", "--q=0.5", "--e=0", "--velocity=1"], &["--velocity", "'1'", "VA,VB"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=,"], &["--velocity", "','", "'' is not a number"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=-1,-1,-1"], &["--velocity", "-1,-1,-1"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=0,-1"], &["--velocity", "0,-1", "v_a in [-1e150, -1e-150]"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=-5e-324,-1"], &["--velocity", "-5e-324", "-1e-150"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=-1,nan"], &["--velocity", "-1,nan", "v_b"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=-1,1e308"], &["--velocity", "1e308", "1e150"]),
    (&["impacts", "--q=0.5", "--e=0", "--height-gap=-1"], &["--height-gap", "-1", "[1e-150, 1e150]"]),
    (&["impacts", "--q=0.5", "--e=0", "--height-gap=inf"], &["--height-gap", "inf", "[1e-150, 1e150]"]),
    (&["impacts", "--q=0.5", "--e=0", "--at=2"], &["--at", "2", "[-1, 1]"]),
    (&["impacts", "--q=0.5", "--e=0", "--at=0", "--at=nan"], &["--at", "nan", "[-1, 1]"]),
    (&["impacts", "--q=0.5", "--e=0", "--limit=-1"], &["--limit", "-1", "whole number"]),
    (&["impacts", "--q=0.5", "--e=0", "--limit=1e3"], &["--limit", "1e3", "whole number"]),
    (&["impacts", "--q=0.5", "--e=0", "--format=xml"], &["--format", "xml", "table, json, csv"]),
    // Zones.
    (&["zone", "--q=0.5", "--e=0"], &["--threshold <X>"]),
    (&["zone", "--q=0.5", "--e=0", "--threshold=0"], &["--threshold", "0", "[1e-150, 1e150]"]),
    (&["zone", "--q=0.5", "--e=0", "--threshold=-1"], &["--threshold", "-1", "[1e-150, 1e150]"]),
    (&["zone", "--q=0.5", "--e=0", "--threshold=nan"], &["--threshold", "nan", "[1e-150, 1e150]"]),
    (&["zone", "--q=0.5", "--e=0", "--threshold=inf"], &["--threshold", "inf", "[1e-150, 1e150]"]),
    (&["zone", "--q=0.5", "--e=0", "--threshold=1", "--first=c"], &["--first", "c", "a, b"]),
    // Maps: nothing is computed, let alone written, before everything is right.
    (&["map", "duration", "--q=0:1:2", "--e=0:1:2"], &["--output <FILE>"]),
    (&["map", "duration", "--q=0:1:2", "--e=0:1:2", "-o", "x.txt"], &["x.txt", ".csv, .json, .npy or .svg"]),
    (&["map", "duration", "--q=0:1:2", "--e=0:1:2", "-o", "csv"], &["csv", ".csv, .json, .npy or .svg"]),
    (&["map", "duration", "--q=0:1:2", "--e=0:1:2", "-o", ""], &["--output", ".csv, .json, .npy or .svg"]),
    (&["map", "speed", "--q=0:1:2", "--e=0:1:2", "-o", "x.csv"], &["speed", "peak-end", "net-center"]),
    (&["map", "zone", "--q=0:1:2", "--e=0:1:2", "-o", "x.csv"], &["--threshold <X>"]),
    (&["map", "impacts", "--threshold=1", "--q=0:1:2", "--e=0:1:2", "-o", "x.csv"], &["--threshold", "zone alone"]),
    (&["map", "impacts", "--q=0:1", "--e=0:1:2", "-o", "x.csv"], &["--q", "0:1", "LO:HI:N"]),
    (&["map", "impacts", "--q=0.5", "--e=0:1:2", "-o", "x.csv"], &["--q", "0.5", "LO:HI:N"]),
    (&["map", "impacts", "--q=0:1:2", "--e=::", "-o", "x.csv"], &["--e", "'::'", "''"]),
    (&["map", "impacts", "--q=0:1:2", "--e=0:1:1e3", "-o", "x.csv"], &["--e", "'1e3' is not a number of values"]),
    (&["map", "impacts", "--q=0:1:-2", "--e=0:1:2", "-o", "x.csv"], &["--q", "'-2' is not a number of values"]),
    (&["map", "impacts", "--q=1:0:2", "--e=0:1:2", "-o", "x.csv"], &["--q", "1.0:0.0:2"]),
    (&["map", "impacts", "--q=0:1:0", "--e=0:1:2", "-o", "x.csv"], &["--q", "0.0:1.0:0"]),
    (&["map", "impacts", "--q=0:1:1", "--e=0:1:2", "-o", "x.csv"], &["--q", "0.0:1.0:1"]),
    (&["map", "impacts", "--q=-1:1:2", "--e=0:1:2", "-o", "x.csv"], &["--q", "-1.0:1.0:2"]),
    (&["map", "impacts", "--q=0:1:2", "--e=0:2:2", "-o", "x.csv"], &["--e", "0.0:2.0:2"]),
    (&["map", "impacts", "--q=0:1:2", "--e=nan:1:2", "-o", "x.csv"], &["--e", "NaN:1.0:2"]),
    // 8·10¹⁸ bytes, and more than a usize counts.
    (&["map", "impacts", "--q=0:1:1000000000", "--e=0:1:1000000000", "-o", "x.csv"], &["1000000000000000000 points", "memory"]),
    (&["map", "impacts", "--q=0:1:18446744073709551615", "--e=0:1:18446744073709551615", "-o", "x.csv"], &["memory"]),
    // The command itself.
    (&["report", "novel"], &["novel", "paper, all"]),
    (&["completions", "tcsh"], &["tcsh", "bash"]),
    (&["bounce"], &["bounce"]),
    (&["impacts", "--q=0.5", "--e=0", "--mass=1"], &["--mass"]),
];

#[test]
fn is_refused_with_one_message_that_says_what_is_allowed() {
    let mut wrong = Vec::new();
    for (arguments, said) in REFUSED {
        let outcome = clatter(*arguments);
        let clean = outcome.exit == Exit::BadInput
            && outcome.stdout.is_empty()
            && outcome.stderr.starts_with("error: ")
            && outcome.stderr.matches("error: ").count() == 1
            && said.iter().all(|part| outcome.stderr.contains(part));
        if !clean {
            wrong.push(format!("clatter {arguments:?} ({:?})\n{}{}", outcome.exit, outcome.stdout, outcome.stderr));
        }
    }
    assert!(wrong.is_empty(), "{} of {} are not as they should be:\n{}", wrong.len(), REFUSED.len(), wrong.join("\n"));
}

#[test]
fn no_command_at_all_shows_the_help_and_fails() {
    let outcome = clatter::<&str>([]);
    assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""));
    assert!(outcome.stderr.contains("Usage: clatter <COMMAND>"), "{}", outcome.stderr);
}
