//! Text of others that is out to harm: names, files, lists and values, through every command that prints them.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use clatter_cli::Exit;

use crate::{Outcome, clatter};

/// What a spreadsheet would compute, at the head of a cell.
const COMPUTED: [&str; 6] = ["=", "+", "-", "@", "\t", "\r"];
/// What a terminal would obey, or nobody can see. A file can be named so.
const OBEYED: [&str; 12] = [
    "\u{1b}[2J",
    "\u{1b}]0;title\u{7}",
    "\n",
    "\t",
    "\r",
    "\u{7f}",
    "\u{9b}31m",
    "\u{85}",
    "\u{202e}",
    "\u{2066}\u{200f}",
    "\u{200b}\u{feff}",
    "\u{2028}\u{2029}",
];

/// Nothing but lines of text that shows what it is.
fn is_harmless(text: &str) -> bool {
    text.chars().all(|c| {
        c == '\n'
            || !(c.is_control()
                || matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}'))
    })
}

/// Calls the command, which must print nothing harmful.
fn harmless<'a>(arguments: impl IntoIterator<Item = &'a str>) -> Outcome {
    let arguments: Vec<&str> = arguments.into_iter().collect();
    let outcome = clatter(&arguments);
    for text in [&outcome.stdout, &outcome.stderr] {
        assert!(is_harmless(text), "{arguments:?}: {text:?}");
    }
    outcome
}

/// A refusal on one line that shows the escape.
fn refused<'a>(arguments: impl IntoIterator<Item = &'a str>, escape: &str) {
    let outcome = harmless(arguments);
    assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{}", outcome.stderr);
    assert!(outcome.stderr.contains(escape), "{escape}: {}", outcome.stderr);
}

/// The escape of each character that is not plain, as it is shown.
fn escaped(text: &str) -> String {
    text.chars()
        .map(|c| if (' '..='~').contains(&c) { c.to_string() } else { c.escape_unicode().to_string() })
        .collect()
}

/// A TOML string of any characters.
fn toml(text: &str) -> String {
    text.chars().fold(String::new(), |mut all, c| {
        write!(all, "\\U{:08X}", u32::from(c)).unwrap();
        all
    })
}

/// A product whose parts, a part for each name, all break.
fn product(folder: &Path, file: &str, name: &str, parts: &[String]) -> String {
    let mut text = format!(
        "[product]\nname = \"{}\"\nlength = \"140 mm\"\nradius_of_gyration = \"40 mm\"\nrestitution = [0.1, 0.3]\n\
         [drop]\nheight = \"1 m\"\ntilt = [\"3 deg\", \"4 deg\"]\n",
        toml(name)
    );
    for part in parts {
        write!(
            text,
            "[[component]]\nname = \"{}\"\nposition = \"55 mm\"\nnatural_frequency = [\"90 Hz\", \"91 Hz\"]\n\
             damping_ratio = 0.1\nacceleration_limit = \"100 gn\"\n",
            toml(part)
        )
        .unwrap();
    }
    let path = folder.join(file);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn names_of_products_and_parts_are_shown() {
    let folder = tempfile::tempdir().unwrap();
    let all = OBEYED.concat();
    let parts: Vec<_> = COMPUTED.iter().map(|first| format!("{first}{all}")).collect();
    let file = product(folder.path(), "product.toml", &all, &parts);
    let other = product(folder.path(), "other.toml", &format!("={all}"), &parts[..1]);
    for arguments in [
        &["assess", &file][..],
        &["assess", &file, &other],
        &["explain", &file],
        &["scatter", &file, "--samples=50"],
        &["tradeoff", &other],
        &["design", &other],
    ] {
        let outcome = harmless(arguments.iter().copied());
        assert!(outcome.exit != Exit::BadInput, "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stdout.contains("\\u{1b}[2J"), "{arguments:?}: {}", outcome.stdout);
    }
}

#[test]
fn cells_of_csv_are_not_computed() {
    let folder = tempfile::tempdir().unwrap();
    let all = OBEYED.concat();
    let parts: Vec<_> = COMPUTED.iter().map(|first| format!("{first}{all}")).collect();
    let file = product(folder.path(), "product.toml", "plain", &parts);
    for arguments in [
        &["design", &file, "--format=csv"][..],
        &["scatter", &file, "--samples=50", "--format=csv"],
        &["tradeoff", &file, "--format=csv"],
    ] {
        let outcome = harmless(arguments.iter().copied());
        assert!(outcome.exit != Exit::BadInput, "{arguments:?}: {}", outcome.stderr);
        for part in &parts {
            let cell = format!("\"'{}\",", escaped(part));
            assert!(outcome.stdout.lines().any(|line| line.starts_with(&cell)), "{cell}: {}", outcome.stdout);
        }
        assert!(outcome.stdout.lines().skip(1).all(|line| line.starts_with("\"'")), "{}", outcome.stdout);
    }
    let negative = clatter(["impacts", "--q=0.5", "--e=0.3", "--format=csv"]);
    assert!(negative.stdout.contains(",-"), "numbers stay as they are: {}", negative.stdout);
    let samples = folder.path().join("samples.csv");
    harmless(["scatter", &file, "--samples=50", "-o", samples.to_str().unwrap()]);
    let samples = fs::read_to_string(samples).unwrap();
    assert!(is_harmless(&samples) && samples.contains("\\u{1b}[2J"), "{samples}");
}

#[test]
fn what_a_product_file_says_wrongly_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("product.toml");
    let file = path.to_str().unwrap();
    let all = OBEYED.concat();
    let raw = "\u{9b}2J\u{85}\u{202e}\u{2066}\u{200b}\u{2028}";
    let name = |key: &str| format!("{}\n[product]\nname = \"x\"\n{key}\n", "#".repeat(3));
    for text in [
        name(&format!("\"{}\" = 1", toml(&all))),
        name(&format!("length = \"{}\"", toml(&all))),
        name(&format!("length = \"1 {raw}\" # {raw}")),
        name(&format!("\"{raw}\" = 1")),
        name(&format!("restitution = {{ \"{}\" = 1 }}", toml(&all))),
        name(&format!("contact_law = \"{}\"", toml(&all))),
        name(&format!("length = {all}")),
        name("length = \u{1b}[2J\u{7f}"),
        format!("[\"{}\"]\n", toml(&all)),
    ] {
        fs::write(&path, &text).unwrap();
        for command in ["assess", "explain", "tradeoff", "design", "scatter"] {
            let outcome = harmless([command, file]);
            assert_eq!(outcome.exit, Exit::BadInput, "{text:?}");
        }
    }
    fs::write(&path, name(&format!("\"{}\" = 1", toml("a\u{1b}\nb")))).unwrap();
    refused(["assess", file], "has no key `a\\u{1b}\\u{a}b`");
}

#[test]
fn values_of_the_command_line_are_shown() {
    for text in OBEYED {
        let [value, flag, seed] = [format!("--q=0.5{text}"), format!("--q{text}=1"), format!("--seed=1{text}")];
        let list = format!("--pulse=sine{text},1,1,0");
        for arguments in [
            &["impacts", "--e=0", &value][..],
            &["impacts", "--e=0", &flag],
            &["scatter", "x.toml", &seed],
            &["scatter", "x.toml", &format!("--samples={text}")],
            &["scatter", "x.toml", &format!("--confidence={text}")],
            &["assess", "x.toml", &format!("--tolerance={text}")],
            &["spectrum", &list],
            &["spectrum", "x.csv", &format!("--units={text},g")],
            &["map", "zone", "--e=0:1:2", &format!("--q=0:1:2{text}"), "-o", "x.csv"],
            &["impacts", "--q=1", "--e=0", &format!("--format={text}")],
            &[text],
            &["impacts", "--q=1", "--e=0", text],
        ] {
            let outcome = harmless(arguments.iter().copied());
            assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""), "{}", outcome.stderr);
        }
        refused(["impacts", "--e=0", &value], &escaped(text));
    }
    refused(["impacts", "--e=0", "--q=1\nerror: all is lost"], "1\\u{a}error: all is lost");
}

#[test]
fn lists_are_shown() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("list.csv");
    let flags = ["--shocks-file", "--pulses-file"].map(|flag| format!("{flag}={}", path.display()));
    let tests = format!("--tests={}", path.display());
    for text in OBEYED {
        let cell = format!("\"x{text}x\"");
        for (flag, list) in [
            (&flags[0], format!("time_s,delta_v_m_s\n{cell},1\n")),
            (&flags[1], format!("shape,amplitude_m_s2,duration_s,start_s\n{cell},1,1,0\n")),
        ] {
            fs::write(&path, list).unwrap();
            refused(["respond", "--omega=1", flag], &escaped(text));
            refused(["spectrum", flag], &escaped(text));
        }
        for row in [format!("{cell},1,yes"), format!("acceleration,{cell},yes"), format!("acceleration,1,{cell}")] {
            fs::write(&path, format!("test,level,damaged\n{row}\n")).unwrap();
            refused(
                ["spectrum", "--pulse=rectangle,900,0.004", "--damage-boundary", "--frequency=1", &tests],
                &escaped(text),
            );
        }
        fs::write(&path, format!("{cell},delta_v_m_s\n0,1\n")).unwrap();
        refused(["respond", "--omega=1", &flags[0]], "no column time_s");
        // Records are read elsewhere.
        fs::write(&path, format!("time [s{text}],acceleration [m/s2]\n0,1\n")).unwrap();
        harmless(["spectrum", path.to_str().unwrap()]);
        fs::write(&path, format!("time [s],acceleration [m/s2]\n0,1\n1,{text}x\n")).unwrap();
        harmless(["spectrum", path.to_str().unwrap()]);
    }
}

/// Names of files may hold every character but one or two.
#[cfg(unix)]
#[test]
fn names_of_files_are_shown() {
    let folder = tempfile::tempdir().unwrap();
    let all = OBEYED.concat();
    let said = escaped(&all);
    let named = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    // Files that are not there, and that cannot be written.
    let (missing, nowhere) = (named(&format!("{all}.toml")), named(&format!("{all}/x")));
    for command in ["assess", "explain", "tradeoff", "design", "scatter"] {
        refused([command, &missing], &said);
    }
    refused(["spectrum", &missing], &said);
    refused(["respond", "--omega=1", &format!("--shocks-file={missing}")], &said);
    refused(["init", &format!("{nowhere}.toml")], &said);
    refused(["map", "duration", "--q=0:0.5:2", "--e=0:1:2", "-o", &format!("{nowhere}.csv")], &said);
    refused(["simulate", "-o", &format!("{nowhere}.csv{all}")], &said);
    // Files that are.
    let (list, map, record) =
        (named(&format!("={all}.csv")), named(&format!("{all}.csv")), named(&format!("record{all}.csv")));
    fs::write(&list, "time_s,delta_v_m_s\n0,1\n").unwrap();
    fs::write(&record, "time [s],acceleration [m/s2]\n0,0\n0.001,5\n0.002,5\n0.004,0\n").unwrap();
    let file = format!("--shocks-file={list}");
    for arguments in [
        &["respond", "--omega=1", &file][..],
        &["map", "duration", "--q=0:0.5:2", "--e=0:0.5:2", "-o", &map],
        &["spectrum", &file, "-o", &map],
        &["init", &missing],
    ] {
        let outcome = harmless(arguments.iter().copied());
        assert_eq!((outcome.exit, outcome.stderr.as_str()), (Exit::Done, ""), "{arguments:?}");
        assert!(outcome.stdout.contains(&said), "{}", outcome.stdout);
    }
    let outcome = harmless(["spectrum", &record]);
    assert_eq!(outcome.exit, Exit::Done, "{}", outcome.stderr);
    refused(["init", &missing], &said);
    fs::write(&missing, "[product]\nname = 1\n").unwrap();
    refused(["assess", &missing], &said);
    fs::write(&list, "time_s,delta_v_m_s\n0\n").unwrap();
    refused(["respond", "--omega=1", &file], &format!("{said}.csv: line 2: 1 cell"));
}
