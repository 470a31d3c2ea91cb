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

#[test]
fn the_example_of_readme_is_what_the_command_says() {
    let readme = include_str!("../../README.md");
    let outcome = crate::clatter(["impacts", "--q=0.5", "--e=0.3"]);
    let example = readme.split("$ clatter impacts --q=0.5 --e=0.3\n").nth(1).and_then(|rest| rest.split("...").next());
    let example = example.unwrap_or_default();
    assert!(
        !example.is_empty() && outcome.stdout.starts_with(example),
        "README shows\n{example}\nnot\n{}",
        outcome.stdout
    );
}
