//! Factors that stand beside a unit: `[g] x1000`, `×10³ [g]`, `[m/s²]/9.81`.

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
