//! In which letters a text is written that is no UTF-8.

use encoding_rs::{BIG5, EUC_JP, EUC_KR, Encoding, GB18030, SHIFT_JIS, WINDOWS_1251, WINDOWS_1252};

use crate::heading::Heading;

/// The letters of a text, where it is no UTF-8.
#[derive(Debug, Clone, Copy)]
pub(super) struct Letters(&'static Encoding);

impl Default for Letters {
    fn default() -> Self {
        Self(WINDOWS_1252)
    }
}

/// Letters that files are written in; the first of those that tell as much counts.
const LETTERS: [&Encoding; 7] = [WINDOWS_1252, SHIFT_JIS, GB18030, WINDOWS_1251, EUC_KR, EUC_JP, BIG5];
/// Lines that are looked at.
const LINES: usize = 60;

impl Letters {
    /// By the beginning of a text: those in which its headings say most of times and accelerations.
    pub(super) fn of(begin: &[u8]) -> Self {
        let lines = begin.split(|byte| *byte == b'\n').take(LINES).filter(|line| !line.is_ascii());
        let lines: Vec<&[u8]> = lines.collect();
        if lines.iter().all(|line| std::str::from_utf8(line).is_ok()) {
            return Self::default();
        }
        let told = |letters: &'static Encoding| -> Option<usize> {
            let mut count = 0;
            for line in &lines {
                let text = letters.decode_without_bom_handling_and_without_replacement(line)?;
                count += text.split([',', ';', '\t']).filter(|cell| Heading::of(cell).is_telling()).count();
            }
            Some(count)
        };
        let (mut best, mut most) = (WINDOWS_1252, 0);
        for letters in LETTERS {
            if let Some(count) = told(letters).filter(|count| *count > most) {
                (best, most) = (letters, count);
            }
        }
        Self(best)
    }

    /// Bytes as text: UTF-8, or else in these letters.
    pub(super) fn text(self, bytes: &[u8]) -> String {
        match std::str::from_utf8(bytes) {
            Ok(text) => text.to_owned(),
            Err(_) => self.0.decode_without_bom_handling(bytes).0.into_owned(),
        }
    }
}
