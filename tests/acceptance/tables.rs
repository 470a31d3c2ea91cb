//! What people see: tables and help.

use clatter_cli::Exit;
use insta::assert_snapshot;

use crate::clatter;

fn shown<const N: usize>(arguments: [&str; N]) -> String {
    let outcome = clatter(arguments);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    assert!(outcome.stdout.lines().all(|line| line == line.trim_end()), "blanks at the end of a line");
    outcome.stdout
}

#[test]
fn impacts_explains_itself() {
    // The reference bar of the paper's Table 1: 4 impacts, 2.145 v0 at the ends, 1.609 v0/L, 1.115 v0 in all.
    assert_snapshot!(shown(["impacts", "--q=0.5", "--e=0.3", "--at=0"]), @"");
}

#[test]
fn impacts_without_end_are_told_as_such() {
    assert_snapshot!(shown(["impacts", "--q=0.9", "--e=0.3", "--limit=0"]).replace("listed", ""), @"");
}

#[test]
fn zone_explains_itself() {
    // The second bar of Table 1: 10.1 %, 35.7 %, 87.1 %.
    let thresholds = ["zone", "--q=0.73", "--e=0.2", "--threshold=0.5", "--threshold=1", "--threshold=2"];
    assert_snapshot!(shown(thresholds), @"");
}

#[test]
fn a_list_that_was_cut_short_says_so_beside_the_table_alone() {
    let cut = |count: &[&str], format| clatter(["impacts", "--limit=2", format].iter().chain(count)).stderr;
    let (four, endless) = (["--q=0.5", "--e=0.3"], ["--q=0.9", "--e=0.3"]);
    assert_eq!(cut(&four, "--format=table"), "warning: listed 2 of 4 impacts; --limit=N lists more\n");
    assert_eq!(cut(&endless, "--format=table"), "warning: listed 2 of endless impacts; --limit=N lists more\n");
    assert_eq!(cut(&endless, "--format=csv"), "");
    assert_eq!(cut(&endless, "--format=json"), "");
    assert_eq!(clatter(["impacts", "--limit=4", "--q=0.5", "--e=0.3"]).stderr, "");
}

#[test]
fn csv_is_the_rows_alone_with_every_digit() {
    assert_eq!(
        shown(["impacts", "--q=0", "--e=0.25", "--at=0.5", "--at=-0.0", "--format=csv"]),
        "number,end,time,approach,delta_v_a,delta_v_b,delta_v_at_0.5,delta_v_at_0.0\n\
         1,a,0.0,-1.0,1.25,0.0,0.3125,0.625\n\
         2,b,1.0,-1.0,0.0,1.25,0.9375,0.625\n"
    );
    // Both ends see 5/4 v0 at q = 0, so s = (8/5) threshold - 1.
    assert_eq!(
        shown(["zone", "--q=0", "--e=0.25", "--threshold=0.625", "--threshold=1.25", "--format=csv"]),
        "threshold,s,extent\n0.625,0.0,part\n1.25,1.0,whole\n"
    );
    assert_eq!(
        shown(["zone", "--q=0", "--e=0.25", "--threshold=0.3125", "--threshold=2.5", "--first=b", "--format=csv"]),
        "threshold,s,extent,interval_lo,interval_hi\n0.3125,-0.5,none,,\n2.5,3.0,whole,-1.0,1.0\n"
    );
}

#[test]
fn help_teaches_the_two_numbers_and_the_units() {
    let help = shown(["--help"]);
    for said in ["coefficient of restitution", "inertia ratio (L² - ρ²)/(L² + ρ²)", "h0/v0", "One time unit", "Exit status"] {
        assert!(help.contains(said), "{said}:\n{help}");
    }
}

#[test]
fn help_of_every_command_has_an_example_that_runs() {
    for command in ["impacts", "zone", "map", "report", "completions"] {
        for flag in ["-h", "--help"] {
            let help = shown([command, flag]);
            assert!(help.contains("Example"), "{help}");
        }
    }
    for command in ["impacts", "zone"] {
        let help = shown([command, "--help"]);
        let examples = help.lines().filter_map(|line| line.trim().strip_prefix("clatter "));
        let arguments = examples.map(|line| line.split("   ").next().unwrap_or(line).split_whitespace().collect::<Vec<_>>());
        let mut count = 0;
        for arguments in arguments {
            assert_eq!(clatter(&arguments).exit, Exit::Done, "{arguments:?}");
            count += 1;
        }
        assert!(count >= 2, "{help}");
    }
}

#[test]
fn completions_come_for_every_shell() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = clatter(["completions", shell]);
        assert_eq!((script.exit, script.stderr.as_str()), (Exit::Done, ""));
        assert!(script.stdout.contains("gyration-ratio"), "{shell}");
    }
}

#[test]
fn the_version_is_told() {
    assert_eq!(shown(["--version"]), concat!("clatter ", env!("CARGO_PKG_VERSION"), "\n"));
}
