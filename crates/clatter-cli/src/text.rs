//! This module makes foreign text safe in the output of the command: names from product files, names of files, cells of lists, values
//! of the command line, messages of other programs. Such text may be of any length, in any script, and meant to harm.
//!
//! All of it goes through here on its way to a terminal or into CSV. Control characters (C0, DEL, C1), and so all escape
//! sequences, characters that set the direction of text, ends of lines and paragraphs and characters without a width
//! are shown as escapes such as `\u{1b}`: by [`visible`] on a line, by [`visible_lines`] in text of several lines, by
//! [`shown`] in a table. Text that runs from right to left is kept to itself in tables by two marks of our own (U+2068,
//! U+2069).
//!
//! A cell of CSV is a [`field`]. One that begins with `=`, `+`, `-`, `@`, a tab or a carriage return, which a spreadsheet
//! would compute, gets an apostrophe before it and stands in quotes. Numbers are no such text: they are written as they
//! are. In JSON names stand as they are, escaped as JSON requires.

use std::path::Path;

pub(crate) use clatter_product::{visible, visible_lines};
use unicode_width::UnicodeWidthStr;

/// Returns the name of a file, or of standard input.
pub(crate) fn path(path: &Path) -> String {
    visible(&crate::input::name(path)).into_owned()
}

/// Returns a name as it can be printed: [`visible`], in at most `width` columns, with text that runs from right to left kept to
/// itself.
pub(crate) fn shown(name: &str, width: usize) -> String {
    let mut text = String::new();
    let mut used = 0;
    for c in name.chars() {
        let mut one = [0; 4];
        let piece = visible(c.encode_utf8(&mut one));
        let more = piece.width();
        // Marks without a width may pile up as well.
        if used + more > width || text.len() > 8 * width {
            text.push('…');
            break;
        }
        used += more;
        text.push_str(&piece);
    }
    if text.chars().any(runs_left) { format!("\u{2068}{text}\u{2069}") } else { text }
}

/// Returns the text filled up with blanks, and the columns it takes by itself.
pub(crate) fn column(text: &str, width: usize) -> (String, usize) {
    let own = text.width();
    (format!("{text}{}", " ".repeat(width.saturating_sub(own))), own)
}

/// Returns whether a letter is of a script that is written from right to left.
fn runs_left(c: char) -> bool {
    matches!(c, '\u{590}'..='\u{8ff}' | '\u{fb1d}'..='\u{fdff}' | '\u{fe70}'..='\u{feff}' | '\u{10800}'..='\u{10fff}' | '\u{1e800}'..='\u{1efff}')
}

/// Writes a cell of a CSV file that is text: [`visible`], in quotes where it has to be (RFC 4180), and never computed: a quantity such as
/// -40 mm stands as it is.
pub(crate) fn field(text: &str) -> String {
    let quantity = text.strip_prefix(['-', '+']).is_some_and(|rest| {
        let plain = |c: char| c.is_alphanumeric() || matches!(c, '.' | ' ' | '°' | '²' | '%' | '/');
        let begins = rest.starts_with(|c: char| c.is_ascii_digit() || c == '.');
        begins && rest.contains(char::is_alphabetic) && rest.chars().all(plain)
    });
    let computed = !quantity && text.starts_with(['=', '+', '-', '@', '\t', '\r']);
    let text = visible(text);
    if computed || text.contains(['"', ',']) {
        format!("\"{}{}\"", if computed { "'" } else { "" }, text.replace('"', "\"\""))
    } else {
        text.into_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_to_their_column() {
        for (name, printed, columns) in [
            ("camera", "camera", 6),
            ("a much longer name", "a much lon…", 11),
            ("\u{1b}[31m", "\\u{1b}[31m", 10),
            ("ab\u{202e}c", "ab\\u{202e}…", 11),
            ("画面", "画面", 4),
            ("画面画面画面", "画面画面画…", 11),
            ("קטן", "\u{2068}קטן\u{2069}", 3),
        ] {
            let text = shown(name, 10);
            assert_eq!(text, printed, "{name:?}");
            assert_eq!(column(&text, 12), (format!("{text}{}", " ".repeat(12 - columns)), columns), "{name:?}");
        }
        assert!(shown(&"e\u{301}".repeat(100_000), 10).len() < 100, "cut");
        assert!(shown(&"\u{301}".repeat(100_000), 10).len() < 100, "marks alone");
    }

    #[test]
    fn cells_are_text_and_nothing_else() {
        for (name, cell) in [
            ("camera", "camera"),
            ("camera, front", "\"camera, front\""),
            ("1\" disk", "\"1\"\" disk\""),
            ("=1+1", "\"'=1+1\""),
            ("+1", "\"'+1\""),
            ("-1", "\"'-1\""),
            ("-40 mm", "-40 mm"),
            ("-2+3 mm", "\"'-2+3 mm\""),
            ("@SUM(\"a\")", "\"'@SUM(\"\"a\"\")\""),
            ("\t=1", "\"'\\u{9}=1\""),
            ("\r=1", "\"'\\u{d}=1\""),
            ("two\nlines", "two\\u{a}lines"),
            ("", ""),
        ] {
            assert_eq!(field(name), cell, "{name:?}");
        }
    }
}
