//! Text of others, made harmless for a terminal.

use std::borrow::Cow;

/// Returns the text on one line, with each character that a terminal obeys, or that cannot be seen, as an escape such as
/// `\u{1b}`.
///
/// These are control characters (C0 with the ends of lines and tabs, DEL, C1), with which all escape sequences begin;
/// characters that set the direction of text; ends of lines and paragraphs; and characters without a width that are no
/// marks on a letter.
///
/// # Examples
/// ```
/// use clatter_product::visible;
/// assert_eq!(visible("camera\u{1b}[2J\n"), "camera\\u{1b}[2J\\u{a}");
/// ```
#[must_use]
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(obeyed) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if obeyed(c) { shown.extend(c.escape_unicode()) } else { shown.push(c) }
    }
    Cow::Owned(shown)
}

/// Returns the same of several lines, which stay lines; a tab is four blanks.
#[must_use]
pub fn visible_lines(text: &str) -> Cow<'_, str> {
    if !text.contains(|c| c != '\n' && obeyed(c)) {
        return Cow::Borrowed(text);
    }
    let lines = text.split('\n').map(|line| visible(line.strip_suffix('\r').unwrap_or(line)).replace("\\u{9}", "    "));
    Cow::Owned(lines.collect::<Vec<_>>().join("\n"))
}

/// Returns whether a character is obeyed rather than shown, or cannot be seen.
fn obeyed(c: char) -> bool {
    let set = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let end = matches!(c, '\u{2028}' | '\u{2029}');
    let unseen = matches!(c, '\u{ad}' | '\u{180e}' | '\u{200b}'..='\u{200d}' | '\u{2060}'..='\u{2065}')
        || matches!(c, '\u{206a}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}');
    c.is_control() || set || end || unseen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_shown() {
        for (text, said) in [
            ("camera, 画面, קטן, e\u{301}, \u{1f4f7}", "camera, 画面, קטן, e\u{301}, \u{1f4f7}"),
            ("\0\u{7}\t\n\r\u{1b}\u{7f}", "\\u{0}\\u{7}\\u{9}\\u{a}\\u{d}\\u{1b}\\u{7f}"),
            ("\u{85}\u{9b}2J\u{9d}", "\\u{85}\\u{9b}2J\\u{9d}"),
            ("a\u{202e}b\u{2066}c\u{200f}\u{61c}", "a\\u{202e}b\\u{2066}c\\u{200f}\\u{61c}"),
            ("a\u{200b}\u{200d}\u{feff}\u{2060}\u{ad}", "a\\u{200b}\\u{200d}\\u{feff}\\u{2060}\\u{ad}"),
            ("\u{2028}\u{2029}\u{e0041}", "\\u{2028}\\u{2029}\\u{e0041}"),
        ] {
            assert_eq!(visible(text), said);
        }
    }

    #[test]
    fn lines_stay_lines() {
        let text = "one\r\ntwo\tx\n\u{1b}[31mthree\rfour\n";
        assert_eq!(visible_lines(text), "one\ntwo    x\n\\u{1b}[31mthree\\u{d}four\n");
        assert_eq!(visible_lines("one\ntwo\n"), "one\ntwo\n");
    }
}
