//! This module writes numbers, limits and names in running text.

use clatter::End;
use clatter_product::{Model, Spread, Unit};

use clatter_figures::three;

/// The length of the longest name in a running text; the figures cut theirs to the available room.
const LONGEST_NAME: usize = 60;

/// Writes a value in the unit that engineers use for it.
pub(crate) fn shown(unit: Unit, value: f64) -> String {
    let unit = unit.customary();
    if value.is_finite() { format!("{} {}", three(unit.of_si(value)), unit.name) } else { "∞".to_owned() }
}

/// Writes a share as a percentage.
pub(crate) fn hundredths(share: f64) -> String {
    format!("{}\u{a0}%", three(100.0 * share))
}

/// Writes a share as a signed percentage.
pub(crate) fn percent(share: f64) -> String {
    if share.is_infinite() {
        return "–".to_owned();
    }
    let whole = 100.0 * share;
    let text = if whole.abs() < 9.95 { format!("{whole:+.1}\u{a0}%") } else { format!("{whole:+.0}\u{a0}%") };
    text.replace('-', "−")
}

/// Writes a sentence with minus signs as long as a plus, where hyphens stand before numbers.
pub(crate) fn minus(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let is_minus = |i: usize| {
        letters[i] == '-'
            && letters.get(i + 1).is_some_and(char::is_ascii_digit)
            && i.checked_sub(1).is_none_or(|before| matches!(letters[before], ' ' | '(' | '['))
    };
    (0..letters.len()).map(|i| if is_minus(i) { '−' } else { letters[i] }).collect()
}

/// Writes a reason of the ladder, its numbers without powers of ten and its models without hyphens.
///
/// ```
/// let told = clatter_report::words::reason("contacts overlap: τ/Δt = 2.60e0; finite-tilt");
/// assert_eq!(told, "contacts overlap: τ/Δt = 2.6; finite tilt");
/// ```
#[must_use]
pub fn reason(text: &str) -> String {
    let word = |word: &str| {
        let bare = word.trim_end_matches([';', ',']);
        let tidy = match bare.parse::<f64>() {
            Ok(number) if number.is_infinite() => "∞".to_owned(),
            Ok(number) if bare.contains('e') => three(number),
            _ if Model::ALL.iter().any(|model| model.name() == bare) => bare.replace('-', " "),
            _ => bare.to_owned(),
        };
        tidy + &word[bare.len()..]
    };
    text.split(' ').map(word).collect::<Vec<_>>().join(" ").replace("h0/v0²", "h₀/v₀²")
}

pub(crate) fn millimeters(m: f64) -> String {
    format!("{} mm", three(1e3 * m)).replace('-', "−")
}

/// Writes a place of a plate, along and across it from the middle.
pub(crate) fn place(m: [f64; 2]) -> String {
    let [x, y] = m.map(|m| three(1e3 * m + 0.0).replace('-', "−"));
    format!("{x}, {y} mm")
}

/// Writes a name for running text: cut where it is endless, with a box for every character that the pages' typefaces lack.
pub(crate) fn name(text: &str) -> String {
    let printable = |c: char| {
        let known = matches!(u32::from(c), 0x20..=0x7e | 0xa0..=0x24f | 0x370..=0x3ff | 0x400..=0x4ff | 0x5d0..=0x5ea
            | 0x2010..=0x2027 | 0x2030..=0x203a | 0x20ac | 0x2122 | 0x2190..=0x2193 | 0x2200..=0x22ff);
        let defined =
            !matches!(u32::from(c), 0x378 | 0x379 | 0x380..=0x383 | 0x38b | 0x38d | 0x3a2 | 0x3cf..=0x3ff | 0xad);
        if c.is_whitespace() {
            ' '
        } else if known && defined {
            c
        } else {
            '□'
        }
    };
    let mut cut: String = text.chars().take(LONGEST_NAME).map(printable).collect();
    if text.chars().nth(LONGEST_NAME).is_some() {
        cut.push('…');
    }
    cut
}

/// Returns a name with a box in place of every character but those that the pages' serif can set next to any other: letters of
/// Latin, Greek and Cyrillic without combining marks.
pub(crate) fn sure_name(text: &str) -> String {
    name(text).chars().map(|c| if is_sure(c) { c } else { '□' }).collect()
}

/// Returns whether the typefaces of the pages have a character.
pub(crate) fn is_sure(c: char) -> bool {
    matches!(u32::from(c), 0x20..=0x7e | 0xa0..=0x17f | 0x370..=0x482 | 0x48a..=0x4ff | 0x25a1)
}

pub(crate) fn end(end: End) -> &'static str {
    match end {
        End::A => "a",
        End::B => "b",
    }
}

/// Writes a range such as "0.9 to 1.2 m", or one value.
pub(crate) fn range(spread: &Spread, factor: f64, unit: &str) -> String {
    span([spread.lo(), spread.hi()], factor, unit)
}

/// Writes a range from its low and high end in the same way.
pub(crate) fn span([lo, hi]: [f64; 2], factor: f64, unit: &str) -> String {
    let [lo, hi] = [lo, hi].map(|v| three(v / factor).replace('-', "−"));
    let text = if lo == hi { format!("{lo} {unit}") } else { format!("{lo} to {hi} {unit}") };
    text.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn margins_are_signed() {
        assert_eq!([0.0, -0.031, 0.5, f64::INFINITY].map(percent), ["+0.0\u{a0}%", "−3.1\u{a0}%", "+50\u{a0}%", "–"]);
    }

    #[test]
    fn hyphens_of_words_stay() {
        assert_eq!(minus("-2 %, finite-tilt (-15.7 %), 1e-3, a -b"), "−2 %, finite-tilt (−15.7 %), 1e-3, a -b");
    }

    #[test]
    fn reasons_read_as_words() {
        let told = reason("gravity counts: g h0/v0² = 2.58e-2; finite-tilt is off by 1.95 %");
        assert_eq!(told, "gravity counts: g h₀/v₀² = 0.0258; finite tilt is off by 1.95 %");
        assert_eq!(reason("contacts overlap: τ/Δt = 2.60e0; map"), "contacts overlap: τ/Δt = 2.6; map");
        assert_eq!(reason("one shock decides: ζωΔt = inf"), "one shock decides: ζωΔt = ∞");
    }

    #[test]
    fn sure_names_hold_letters_and_boxes_alone() {
        assert_eq!(sure_name("C\u{485}é Ωή Жщ ∰ ῥ\t漢–…"), "C□é Ωή Жщ □ □ □□□");
        assert_eq!(sure_name(&"∰".repeat(100)), "□".repeat(61), "cut as any name");
    }

    #[test]
    fn ranges_of_no_length_are_values() {
        let tilt = Spread::new(0.0, 0.1, clatter_product::Law::Range).unwrap();
        assert_eq!(range(&tilt, 1e-3, "mrad"), "0 to 100 mrad");
        assert_eq!(range(&Spread::value(-0.02).unwrap(), 1e-3, "mm"), "−20 mm");
        assert_eq!(span([0.3, 0.4], 1.0, ""), "0.3 to 0.4");
    }
}
