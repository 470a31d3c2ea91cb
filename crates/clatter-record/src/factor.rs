//! Factors that stand beside a unit: `[g] x1000`, `×10³ [g]`, `[m/s²]/9.81`.

use crate::heading::is_factor_word;
use crate::unit::power_of_ten;

/// A text beside a unit: the name without a factor, the factor, or what is neither.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Prefixed<'a> {
    pub(crate) name: &'a str,
    pub(crate) factor: f64,
    /// A part that says something of the unit, and it is not clear what.
    pub(crate) refused: Option<&'a str>,
}

impl<'a> Prefixed<'a> {
    /// A name and no factor.
    pub(crate) fn name(text: &'a str) -> Self {
        Self { name: text.trim(), factor: 1.0, refused: None }
    }
}

/// Signs of a product.
const SIGNS: [char; 6] = ['x', 'X', '×', '*', '·', '⋅'];
/// Divided by these, m/s² are g.
const GRAVITY: std::ops::RangeInclusive<f64> = 9.8..=9.82;

/// A factor in brackets of its own: `x1000`, `E-03`.
pub(crate) fn in_brackets(text: &str) -> Option<f64> {
    let power = text.trim().strip_prefix(['e', 'E']).filter(|power| power.starts_with(['-', '+']));
    let of = |power: &str| format!("1e{power}").parse().ok().filter(|factor: &f64| *factor > 0.0 && factor.is_finite());
    power.map_or_else(|| alone(text), of)
}

/// A factor that is all of a text: `x1000`, `×10³`, `* 1e-3`; a number alone is none.
pub(crate) fn alone(text: &str) -> Option<f64> {
    let text = text.trim();
    let marked = text.strip_prefix(SIGNS)?.trim();
    number(marked)
}

/// Returns whether a word of a name is a factor for sure: `x1000`, and not `x2`, which may be a channel.
pub(crate) fn is_marked(word: &str) -> bool {
    let digits = word.strip_prefix('x').unwrap_or_default();
    digits.len() >= 3 && digits.bytes().all(|c| c.is_ascii_digit())
}

/// Returns what a name in small letters has of a factor or an offset: `gain 10`, `scale=0.1`, `/9.81`, `2x acc`, `e3`, `-1`, `50 %`. A number
/// alone is that of a channel.
pub(crate) fn beside(name: &str) -> Option<String> {
    let between = |c: char| c.is_whitespace() || matches!(c, '(' | ')' | '[' | ']' | ',' | ';' | ':' | '=' | '@');
    let words: Vec<&str> = name.split(between).filter(|word| !word.is_empty()).collect();
    let is_number = |word: &str| {
        word.starts_with(|c: char| c.is_ascii_digit() || c == '.') && word.replace(',', ".").parse::<f64>().is_ok()
    };
    let is_sign = |word: &str| word.chars().all(|c| SIGNS.contains(&c) || matches!(c, '/' | '÷' | '+'));
    for (i, word) in words.iter().enumerate() {
        let (before, next) = (i.checked_sub(1).map(|before| words[before]), words.get(i + 1).copied());
        let signed = word.strip_prefix(['-', '−', '+', '*', '×', '·', '⋅', '/', '÷', '^']).is_some_and(is_number);
        let power = word.strip_prefix('e').is_some_and(|power| {
            let digits = power.trim_start_matches(['-', '+']);
            !digits.is_empty() && digits.len() < 3 && digits.bytes().all(|c| c.is_ascii_digit())
        });
        let led = word.trim_start_matches(|c: char| c.is_alphabetic());
        let glued = led.len() < word.len() && is_number(led) && is_factor_word(&word[..word.len() - led.len()]);
        let times = word.strip_suffix(SIGNS).is_some_and(is_number) && i == 0 && next.is_some();
        let percent = word.trim_end_matches(['%', '‰']);
        let is_percent = percent.len() < word.len() && (is_number(percent) || percent.is_empty());
        let marked = word.strip_prefix('x').is_some_and(is_number) && before.is_some_and(is_factor_word);
        let leads = i == 0 && word.contains('.') && is_number(word) && next.is_some();
        let is_sensitivity = word.ends_with("v/g") || word.ends_with("c/g");
        let found = is_percent
            || marked
            || leads
            || is_sensitivity
            || before.is_some() && (signed || power)
            || glued
            || times
            || is_inside(word)
            || is_number(word) && before.is_some_and(|before| is_factor_word(before) || i > 1 && is_sign(before))
            || is_number(word) && next.is_some_and(is_sign) && words.len() > i + 2;
        if found {
            let led_by = before.filter(|before| is_factor_word(before) || is_sign(before));
            return Some(led_by.map_or_else(|| (*word).to_owned(), |before| format!("{before} {word}")));
        }
    }
    None
}

/// Returns whether a sign of arithmetic stands beside a number within a word: `10*acc`, `acc*10`, `a+1g`, `acc/9.81`, and not `run/3`.
fn is_inside(word: &str) -> bool {
    let behind = word.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    let over = behind.strip_prefix('/').is_some_and(|name| name.starts_with(char::is_alphabetic));
    if behind.len() < word.len() && (over || behind.starts_with(['*', '×', '·', '⋅'])) {
        return true;
    }
    word.char_indices().skip(1).any(|(at, c)| {
        let digits: String =
            word[at + c.len_utf8()..].chars().take_while(|c| c.is_ascii_digit() || matches!(c, '.' | ',')).collect();
        let (number, plain) = (digits.starts_with(|c: char| c.is_ascii_digit()), digits.trim_end_matches(['.', ',']));
        let round = plain.strip_prefix('1').is_some_and(|zeros| !zeros.is_empty() && zeros.bytes().all(|c| c == b'0'));
        match c {
            '*' | '×' | '·' | '⋅' | '÷' | '+' | '^' => number,
            '/' => number && (plain.contains(['.', ',']) || round || word.starts_with("acc")),
            _ => false,
        }
    })
}

/// Returns whether brackets hold what is done with the numbers, and not a remark: `(/1000)`, `(* gain)`.
pub(crate) fn is_operation(text: &str) -> bool {
    alone(text).is_none() && text.trim().starts_with(['/', '÷', '*', '×', '·', '⋅', '^'])
}

/// A power of ten, or a plain number above zero.
fn number(text: &str) -> Option<f64> {
    if let Some((power, "")) = power_of_ten(text) {
        return Some(power);
    }
    let is_number = text.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    text.replace(',', ".").parse().ok().filter(|number: &f64| is_number && *number > 0.0 && number.is_finite())
}

/// Reads what stands behind a unit in brackets.
pub(crate) fn after(text: &str) -> Prefixed<'_> {
    let text = text.trim();
    let refused = Prefixed { name: "", factor: 1.0, refused: Some(text) };
    if let Some(factor) = alone(text) {
        return Prefixed { name: "", factor, refused: None };
    }
    if let Some(divisor) = text.strip_prefix(['/', '÷', ':']) {
        // Of a column that was divided to be in g; what else is divided may be the unit or the numbers.
        return match number(divisor.trim()).filter(|divisor| GRAVITY.contains(divisor)) {
            Some(factor) => Prefixed { name: "", factor, refused: None },
            None => refused,
        };
    }
    let power = text.strip_prefix(['e', 'E']).is_some_and(|power| power.starts_with(['-', '+']));
    let begins = text.starts_with(['^', '²', '³', '*', '×', '·', '⋅', '%'])
        || text.starts_with(|c: char| c.is_ascii_digit())
        || power;
    if begins { refused } else { Prefixed::name(text) }
}

/// Reads what stands before a unit in brackets: a name, and a factor at its end.
pub(crate) fn before(text: &str) -> Prefixed<'_> {
    let text = text.trim();
    let Some(at) = text.rfind(SIGNS) else { return Prefixed::name(text) };
    let (name, end) = text.split_at(at);
    let Some(factor) = alone(end) else {
        return if end.starts_with(['×', '*', '·', '⋅']) {
            Prefixed { name, factor: 1.0, refused: Some(end) }
        } else {
            Prefixed::name(text)
        };
    };
    let beside = Prefixed { name: name.trim(), factor, refused: None };
    if name.ends_with(SIGNS) && !name.ends_with(['x', 'X']) {
        return Prefixed { name, factor: 1.0, refused: Some(end) };
    }
    if !end.starts_with(['x', 'X']) {
        return beside;
    }
    // `max2` and `x2` are names.
    let digits = end[1..].trim();
    let is_word = name.is_empty() || !name.ends_with(' ') || digits.len() == 1;
    match digits {
        _ if is_word => Prefixed::name(text),
        digits if digits.len() > 2 => beside,
        _ => Prefixed { name, factor: 1.0, refused: Some(end) },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_within_names() {
        for name in [
            "acc gain 10",
            "acc div 10",
            "acc (scale 0.1)",
            "acc scale=0.1",
            "1000 x acc",
            "2x acc",
            "acc e3",
            "acc/9.81",
            "acc -1",
            "a+1g",
            "acc*10",
            "10*acc",
            "acc 50%",
            "acc (50 %)",
            "acc times 10",
            "acc, gain: 10",
            "acc gain10",
            "acc offset -3",
            "acc ÷ 10",
            "acc by 10",
            "acc × 10",
            "acc/1000",
        ] {
            assert!(beside(name).is_some(), "{name}");
        }
        for name in [
            "acc",
            "acc 2",
            "ch 10",
            "acc_10",
            "x2",
            "2x",
            "drop 3 of 10",
            "run/3",
            "dev1/ai0",
            "acc-1",
            "az (raw)",
            "channel e",
            "5 mm off",
            "cfc 1000",
            "acc x",
            "2 x",
            "sensor 12.5 mm",
            "acc - 1",
        ] {
            assert_eq!(beside(name), None, "{name}");
        }
    }

    #[test]
    fn factors_beside_units() {
        let of = |found: Prefixed<'_>| {
            found.refused.map_or(Ok((found.name.to_owned(), found.factor)), |text| Err(text.to_owned()))
        };
        for (text, name, factor) in [
            ("", "", 1.0),
            (" x1000", "", 1000.0),
            (" *1000", "", 1000.0),
            (" × 10³", "", 1000.0),
            ("x 1e-3", "", 1e-3),
            ("/9.81", "", 9.81),
            (" / 9.80665", "", 9.80665),
            (" top", "top", 1.0),
            (" x", "x", 1.0),
        ] {
            assert_eq!(of(after(text)), Ok((name.to_owned(), factor)), "{text}");
        }
        for text in ["^2", "²", "/1000", "* foo", "1000", "1000x", "e-3"] {
            assert!(of(after(text)).is_err(), "{text}");
        }
        for (text, name, factor) in [
            ("acc", "acc", 1.0),
            ("acc ×10³ ", "acc", 1000.0),
            ("acc x1000", "acc", 1000.0),
            ("acc x2", "acc x2", 1.0),
            ("x10", "x10", 1.0),
            ("max", "max", 1.0),
            ("aux1000", "aux1000", 1.0),
        ] {
            assert_eq!(of(before(text)), Ok((name.to_owned(), factor)), "{text}");
        }
        assert!(of(before("acc x10")).is_err(), "a channel or a factor");
    }
}
