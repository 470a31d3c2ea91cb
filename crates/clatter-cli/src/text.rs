//! Text of others, such as names, in a table: of any length, in any script.

use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// A name as it can be printed: at most `width` columns, control and direction characters escaped, text that runs from
/// right to left kept to itself.
pub(crate) fn shown(name: &str, width: usize) -> String {
    let mut text = String::new();
    let mut used = 0;
    for c in name.chars() {
        let piece = if c.is_control() || directs(c) { c.escape_unicode().to_string() } else { c.to_string() };
        let more = if piece.len() > c.len_utf8() { piece.len() } else { c.width().unwrap_or(0) };
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

/// The text filled up with blanks, and the columns it takes by itself.
pub(crate) fn column(text: &str, width: usize) -> (String, usize) {
    let own = text.width();
    (format!("{text}{}", " ".repeat(width.saturating_sub(own))), own)
}

/// Characters that change the direction of what follows, and ends of lines and paragraphs.
fn directs(c: char) -> bool {
    matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Letters of scripts written from right to left.
fn runs_left(c: char) -> bool {
    matches!(c, '\u{590}'..='\u{8ff}' | '\u{fb1d}'..='\u{fdff}' | '\u{fe70}'..='\u{feff}' | '\u{10800}'..='\u{10fff}' | '\u{1e800}'..='\u{1efff}')
}

/// A field of a csv file: quoted where it has to be (RFC 4180).
pub(crate) fn field(text: &str) -> String {
    if text.contains(['"', ',', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
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
}
