//! What people see: tables and help.

use clatter_cli::Exit;
use insta::assert_snapshot;

use crate::clatter;

fn shown<const N: usize>(arguments: [&str; N]) -> String {
    let outcome = clatter(arguments);
    assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""));
    outcome.stdout
}

#[test]
fn impacts_explains_itself() {
    // The reference bar of the paper's Table 1: 4 impacts, 2.145 v0 at the ends, 1.609 v0/L, 1.115 v0 in all.
    assert_snapshot!(shown(["impacts", "--q=0.5", "--e=0.3", "--at=0"]), @"
    Bar with q = 0.5, e = 0.3; radius of gyration 0.577350 of the half-length
    End a strikes first, at -1 v0; end b comes with -1 v0 from 1 h0

    Impacts                            4
    Last impact at               17.1930 h0/v0
    Largest shock, ends          2.14500 v0      at impact 2
                   center       0.536250 v0
                   turning       1.60875 v0/L
    Net change,    end a         1.22712 v0      leaving with 0.227119 v0
                   end b         1.00214 v0      leaving with 0.00213750 v0
                   center        1.11463 v0
                   turning     -0.112491 v0/L
    Without clatter              1.30000 v0      everywhere: the flat impact that standards assume

       impact  end          time      approach    shock at a    shock at b    shock at 0
                           h0/v0            v0            v0            v0            v0
            1  a               0      -1.00000       1.30000     -0.650000      0.325000
            2  b        0.606061      -1.65000      -1.07250       2.14500      0.536250
            3  a        0.841424     -0.772500       1.00425     -0.502125      0.251063
            4  b         17.1930   -0.00712500   -0.00463125    0.00926250    0.00231563
    ");
}

#[test]
fn impacts_without_end_are_told_as_such() {
    // λ = (0.88 + √0.3744)/2, so all is over at 1/(1 + λ); the second impact is the hardest, 1.1 (0.88 + 1).
    assert_snapshot!(shown(["impacts", "--q=0.8", "--e=0.1", "--limit=0"]), @"
    Bar with q = 0.8, e = 0.1; radius of gyration 0.333333 of the half-length
    End a strikes first, at -1 v0; end b comes with -1 v0 from 1 h0

    Impacts                      endless
    Impacts tend to             0.572757 h0/v0
    Largest shock, ends          2.06800 v0      at impact 2
                   center       0.206800 v0
                   turning       1.86120 v0/L
    Net change,    end a         1.00000 v0      leaving with 0 v0
                   end b         1.00000 v0      leaving with 0 v0
                   center        1.00000 v0
                   turning             0 v0/L
    Without clatter              1.10000 v0      everywhere: the flat impact that standards assume
    ");
}

#[test]
fn zone_explains_itself() {
    // The second bar of Table 1: 10.1 %, 35.7 %, 87.1 %.
    let thresholds = ["zone", "--q=0.73", "--e=0.2", "--threshold=0.5", "--threshold=1", "--threshold=2"];
    assert_snapshot!(shown(thresholds), @"
    Safe zones of a bar with q = 0.73, e = 0.2; its ends see up to 2.25120 v0

       threshold    safe zone s
              v0   half-lengths
        0.500000       0.100698   the middle 10.1 % of the bar
         1.00000       0.357465   the middle 35.7 % of the bar
         2.00000       0.871000   the middle 87.1 % of the bar
    ");
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
    for said in
        ["coefficient of restitution", "inertia ratio (L² - ρ²)/(L² + ρ²)", "h0/v0", "One time unit", "Exit status"]
    {
        assert!(help.contains(said), "{said}:\n{help}");
    }
}

#[test]
fn help_of_every_command_has_an_example_that_runs() {
    for command in ["impacts", "zone", "map", "respond", "spectrum", "simulate", "study", "report", "completions"] {
        for flag in ["-h", "--help"] {
            let help = shown([command, flag]);
            assert!(help.contains("Example"), "{help}");
        }
    }
    let dir = tempfile::tempdir().unwrap();
    let files = [
        ("shocks.csv", "time_s,delta_v_m_s\n0,2.5\n0.004,-1\n"),
        (
            "tests.csv",
            "test,level,damaged\nvelocity-change,2,no\nvelocity-change,3,yes\nacceleration,700,no\nacceleration,900,yes\n",
        ),
    ];
    for (name, text) in files {
        std::fs::write(dir.path().join(name), text).unwrap();
    }
    for command in ["impacts", "zone", "respond", "spectrum", "simulate"] {
        let help = shown([command, "--help"]).replace("\\\n      ", "");
        let examples = help.lines().filter_map(|line| line.trim().strip_prefix("clatter "));
        // those that read or write a file are tested with files of their own
        let examples = examples.filter(|line| !line.contains("drop.csv") && !line.contains(" -o "));
        let arguments = examples.map(|line| {
            let words = line.split("   ").next().unwrap_or(line).split_whitespace();
            let beside = |word: &str| match word.split_once('=') {
                Some((flag, name)) if files.iter().any(|(file, _)| *file == name) => {
                    format!("{flag}={}", dir.path().join(name).display())
                }
                _ => word.to_owned(),
            };
            words.map(beside).collect::<Vec<_>>()
        });
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
        for flag in ["gyration-ratio", "contact-time-s"] {
            assert!(script.stdout.contains(flag), "{shell}: {flag}");
        }
    }
}

#[test]
fn the_version_is_told() {
    assert_eq!(shown(["--version"]), concat!("clatter ", env!("CARGO_PKG_VERSION"), "\n"));
}
