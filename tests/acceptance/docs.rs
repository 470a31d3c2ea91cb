//! What README says is what the tests hold.

use clatter::accuracy::TABLE;

#[test]
fn readme_states_every_allowed_error() {
    let readme = include_str!("../../README.md");
    for allowance in TABLE {
        let error = format!("| {:e} |", allowance.error);
        // "time, final velocity" stands as "times and final velocities".
        let word = allowance.quantity.split([' ', ',']).next().unwrap_or_default();
        let stated = readme.lines().any(|line| line.starts_with('|') && line.contains(&error) && line.contains(word));
        assert!(stated, "{}: {error}", allowance.quantity);
    }
}

/// What README shows after a command, up to its three dots.
fn example(command: &str) -> &'static str {
    let shown = include_str!("../../README.md").split(&format!("$ {command}\n")).nth(1);
    let example = shown.and_then(|rest| rest.split("...").next()).unwrap_or_default();
    assert!(!example.is_empty(), "README shows {command}");
    example
}

#[test]
fn the_examples_of_readme_are_what_the_command_says() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("handheld.toml").display().to_string();
    assert_eq!(crate::clatter(["init", &file]).stderr, "");
    for (command, outcome) in [
        ("clatter impacts --q=0.5 --e=0.3", crate::clatter(["impacts", "--q=0.5", "--e=0.3"])),
        ("clatter assess handheld.toml", crate::clatter(["assess", &file])),
    ] {
        let (shown, said) = (example(command), outcome.stdout);
        assert!(said.starts_with(shown), "README shows\n{shown}\nnot\n{said}");
    }
}
