//! This module writes the help of the command itself: its subcommands by task.

use clap::Subcommand as _;

use crate::{Command, columns};

/// Tasks, each with the subcommands for it.
const TASKS: [(&str, &[&str]); 4] = [
    ("Assess a product", &["assess", "design", "scatter", "study", "explain", "tradeoff", "init", "schema"]),
    ("Follow one drop", &["simulate", "respond", "impacts", "zone", "atlas", "map"]),
    ("Use what was measured", &["record", "spectrum", "fit"]),
    ("Print, and help", &["report", "completions", "help"]),
];

/// The number of columns before the description of a subcommand.
const INDENT: usize = 15;

/// Returns the help of the command, its subcommands by task.
pub(crate) fn template() -> String {
    let mut text = "{before-help}{about-with-newline}\n{usage-heading} {usage}\n\n".to_owned();
    for (task, names) in TASKS {
        text.extend([task, ":\n"]);
        for name in names {
            text.extend([&said(name), "\n"]);
        }
        text.push('\n');
    }
    text + "Options:\n{options}{after-help}"
}

/// Describes a subcommand on lines that the terminal holds.
fn said(name: &str) -> String {
    let all = Command::augment_subcommands(clap::Command::new("clatter"));
    let own = all.find_subcommand(name).and_then(|command| command.get_about()).map(ToString::to_string);
    let about = own.unwrap_or_else(|| "Print this message or the help of a subcommand".to_owned());
    let mut lines = vec![format!("  {name:<width$}", width = INDENT - 2)];
    for word in about.split(' ') {
        let last = lines.len() - 1;
        if lines[last].len() + word.len() > columns::width().min(100) {
            lines.push(" ".repeat(INDENT));
        }
        let last = lines.len() - 1;
        lines[last].extend([word, " "]);
    }
    lines.iter().map(|line| line.trim_end()).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_subcommand_has_one_task_and_the_first_is_assess() {
        let all = Command::augment_subcommands(clap::Command::new("clatter"));
        let mut named: Vec<&str> = TASKS.iter().flat_map(|(_, names)| names.iter().copied()).collect();
        assert_eq!(named[0], "assess");
        let mut known: Vec<&str> = all.get_subcommands().map(clap::Command::get_name).chain(["help"]).collect();
        named.sort_unstable();
        known.sort_unstable();
        assert_eq!(named, known);
    }

    #[test]
    fn the_help_has_the_tasks_in_their_order_and_is_no_wider_than_a_terminal() {
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let mut streams = crate::Streams { out: &mut out, err: &mut err, interactive: false };
        crate::run(["clatter", "help"], &mut streams);
        let text = String::from_utf8(out).unwrap();
        let at = |what: &str| text.find(what).unwrap_or_else(|| panic!("{what}: {text}"));
        let order = [
            "Usage: clatter",
            "Assess a product:\n  assess",
            "\n  scatter",
            "Follow one drop:\n  simulate",
            "\n  fit",
            "Options:",
            "--force",
            "The bar.",
        ];
        assert!(order.windows(2).all(|pair| at(pair[0]) < at(pair[1])), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    }
}
