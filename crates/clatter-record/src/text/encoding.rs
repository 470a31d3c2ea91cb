//! In which letters a text is written that is no UTF-8.

use encoding_rs::{BIG5, EUC_JP, EUC_KR, Encoding, GB18030, SHIFT_JIS, WINDOWS_1251, WINDOWS_1252};

use crate::heading::{Heading, Named};

/// Letters that files are written in; the first of those that tell as much counts.
const LETTERS: [&Encoding; 7] = [WINDOWS_1252, SHIFT_JIS, GB18030, WINDOWS_1251, EUC_KR, EUC_JP, BIG5];
/// Lines that are looked at.
const LINES: usize = 60;

/// The letters of a text by its beginning: those in which its headings say most of times and accelerations.
pub(super) fn of(begin: &[u8]) -> &'static Encoding {
    let lines: Vec<&[u8]> = begin.split(|byte| *byte == b'\n').take(LINES).filter(|line| !line.is_ascii()).collect();
    if lines.iter().all(|line| std::str::from_utf8(line).is_ok()) {
        return WINDOWS_1252;
    }
    let told = |letters: &'static Encoding| -> Option<usize> {
        let mut count = 0;
        for line in &lines {
            let text = letters.decode_without_bom_handling_and_without_replacement(line)?;
            let heading = |cell: &str| Heading::of(cell);
            let telling = |heading: Heading| {
                heading.unit.is_some() || matches!(heading.named(), Named::Time | Named::Acceleration)
            };
            count += text.split([',', ';', '\t']).filter(|cell| telling(heading(cell))).count();
        }
        Some(count)
    };
    let counts = LETTERS.iter().map(|letters| told(letters));
    let (mut best, mut most) = (WINDOWS_1252, 0);
    for (letters, count) in LETTERS.iter().zip(counts) {
        if let Some(count) = count.filter(|count| *count > most) {
            (best, most) = (*letters, count);
        }
    }
    best
}

/// Bytes as text: UTF-8, or else in other letters.
pub(super) fn text(bytes: &[u8], letters: &'static Encoding) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => letters.decode_without_bom_handling(bytes).0.into_owned(),
    }
}
