//! What README and the pages of docs/ say is what the tests hold.

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

/// Runs every command that a page shows, in a directory with the product files of the page, and looks whether its answer is the one
/// shown, if any is; three dots stand for lines left out.
fn holds(page: &str, text: &str, dir: &std::path::Path) -> usize {
    let mut commands = 0;
    for block in text.split("```").skip(1).step_by(2) {
        if let Some(file) = block.strip_prefix("toml\n# ") {
            let (name, content) = file.split_once('\n').expect("a name and a file");
            std::fs::write(dir.join(name), content).unwrap();
        }
        let Some(shown) = block.strip_prefix("text\n$ ") else { continue };
        for example in shown.split("\n$ ") {
            let (command, shown) = example.split_once('\n').unwrap_or((example.trim_end(), ""));
            let said = crate::clatter(words(command, dir)).stdout.replace(&format!("{}/", dir.display()), "");
            let mut rest = said.as_str();
            for (number, piece) in shown.split("...\n").enumerate() {
                let at = if number == 0 { rest.starts_with(piece).then_some(0) } else { rest.find(piece) };
                let at = at.unwrap_or_else(|| panic!("{page} shows after {command}\n{piece}\nnot\n{said}"));
                rest = &rest[at + piece.len()..];
            }
            assert!(
                shown.is_empty() || rest.is_empty() || shown.ends_with("...\n"),
                "{page} does not show the end of {command}:\n{rest}"
            );
            commands += 1;
        }
    }
    commands
}

/// The arguments of a command, with `'…'` around spaces; files are those of the directory.
fn words(command: &str, dir: &std::path::Path) -> Vec<String> {
    let pieces = command.strip_prefix("clatter ").expect("a command of clatter").split('\'').enumerate();
    let kept = pieces.map(|(n, piece)| if n % 2 == 0 { piece.replace(' ', "\n") } else { piece.to_owned() });
    let in_dir = |word: &str| {
        let (option, file) = word.rsplit_once('=').map_or(("", word), |(option, file)| (option, file));
        let equals = if option.is_empty() { "" } else { "=" };
        let is_file = std::path::Path::new(file).extension().is_some_and(|ending| ending == "toml" || ending == "csv");
        if is_file { format!("{option}{equals}{}", dir.join(file).display()) } else { word.to_owned() }
    };
    kept.collect::<String>().split('\n').map(in_dir).collect()
}

#[test]
fn the_examples_of_readme_are_what_the_command_says() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(holds("README", include_str!("../../README.md"), dir.path()), 3);
}

#[test]
fn the_examples_of_the_tutorials_are_what_the_command_says() {
    let (root, dir) = (std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(".."), tempfile::tempdir().unwrap());
    for file in ["docs/remote.toml", "docs/drop.csv"] {
        let file = root.join(file);
        std::fs::copy(&file, dir.path().join(file.file_name().unwrap())).unwrap();
    }
    let read = |page: &str| std::fs::read_to_string(root.join("docs").join(page)).unwrap();
    let index = read("README.md");
    let pages: Vec<&str> = index.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert_eq!(pages.len(), 6);
    for page in pages {
        assert_eq!(holds(page, &read(page), dir.path()) > 0, page != "theory.md", "{page}");
    }
}
