//! Formats of errors, counts and digits on the page.

use clatter::accuracy::{DURATION_LONG, NEAR_ENDLESS};
use clatter_figures::raised;
use serde_json::{Value, json};

use super::big::Big;
use super::digits;
use super::miscount;
use super::part::Cell;
use super::train::{Case, Comparison, Found, Way};
use crate::files::decimals;

/// Returns a number with one digit and its power of ten, rounded by `round`.
fn one_digit(value: f64, round: impl Fn(f64) -> f64) -> String {
    let mut exponent = value.abs().log10().floor();
    // Read back from its decimals, so that 1e−10 is 1 and not 1.000…1.
    let digit = |exponent: f64| format!("{:.6}", value / 10f64.powf(exponent)).parse::<f64>().map_or(0.0, &round);
    let mut first = digit(exponent);
    if first >= 10.0 {
        exponent += 1.0;
        first = 1.0;
    }
    if (-2.0..=2.0).contains(&exponent) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0, 1 or 2")]
        return format!("{:.*}", (-exponent).max(0.0) as usize, first * 10f64.powf(exponent));
    }
    let power = format!("10{}", raised(&exponent.to_string()));
    if (first - 1.0).abs() < 0.5 { power } else { format!("{first}·{power}") }
}

/// Returns a number as one digit and a power of ten.
pub(super) fn power(value: f64) -> String {
    one_digit(value, f64::round)
}

/// Returns an upper bound of an error as text: `ε` for a rounding or less, else one digit and a power of ten.
pub(super) fn upper(error: f64) -> String {
    match error {
        x if !x.is_finite() => "∞".into(),
        x if x <= f64::EPSILON => "ε".into(),
        x => one_digit(x, f64::ceil),
    }
}

/// Returns the state of an error on the page: within the allowed one, or beyond; free where nothing is promised.
fn state(allowed: Option<f64>, error: f64) -> &'static str {
    match allowed {
        None => "free",
        Some(allowed) if error <= allowed => "within",
        Some(_) => "beyond",
    }
}

pub(super) fn error_cell(j: &Comparison) -> Value {
    let Some(error) = j.error else { return Value::Null };
    let mark = match j.allowed {
        Some(DURATION_LONG) => "long",
        Some(NEAR_ENDLESS) => "edge",
        _ => "",
    };
    json!({ "shown": upper(error), "state": state(j.allowed.map(|a| a.error), error), "mark": mark })
}

pub(super) fn counted(exact: Found, way: &Way) -> Value {
    match miscount(exact, way.found) {
        None => json!({ "shown": "open", "state": "free", "mark": "" }),
        Some(0.0) => json!({ "shown": "exact", "state": "within", "mark": "" }),
        Some(_) => json!({ "shown": count(way.found), "state": "beyond", "mark": "" }),
    }
}

pub(super) fn count(found: Found) -> String {
    match found {
        #[expect(clippy::cast_precision_loss, reason = "three digits of it are shown")]
        Found::Impacts(n) if n >= 10_000_000_000 => {
            let text = format!("{:.2e}", n as f64);
            let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
            format!("{digits}·10{}", raised(exponent))
        }
        Found::Impacts(n) => n.to_string(),
        Found::Endless => "∞".into(),
        Found::Open => "open".into(),
        Found::Nothing => "NaN".into(),
    }
}

/// Returns the start, unless it is pure translation from h0.
pub(super) fn start(case: &Case) -> String {
    let [va, vb] = case.velocity;
    #[expect(clippy::float_cmp, reason = "the default, to the bit")]
    let plain = va == -1.0 && vb == -1.0;
    match (plain, case.gap) {
        (true, 0.0) => "h₀ = 0".into(),
        (true, _) => String::new(),
        _ => format!("v = [{}, {}]", decimals(va, 3), decimals(vb, 3)),
    }
}

pub(super) fn pair(cell: &Cell) -> Value {
    let shown = |error: f64| json!({ "shown": upper(error), "state": state(Some(cell.allowed), error) });
    json!({ "ours": shown(cell.ours), "plain": cell.plain.map(shown) })
}

/// Number of digits that are shown of a number.
const DIGITS: u32 = 16;

/// Returns a value as its digits: those that it shares with the exact one, the others, the power of ten.
pub(super) fn written(exact: &digits::Value, value: &digits::Value) -> Value {
    let digits = |value: &digits::Value| match value {
        digits::Value::Number(x) => Ok(number(x)),
        digits::Value::Count(n) => Ok((n.to_string(), String::new())),
        digits::Value::Word(word) => Err(*word),
    };
    match (digits(exact), digits(value)) {
        (Ok((want, scale)), Ok((got, other))) => {
            let same = scale == other && want.len() == got.len();
            let shared = want.chars().zip(got.chars()).take_while(|(a, b)| same && a == b).count();
            let (good, bad): (String, String) =
                (got.chars().take(shared).collect(), got.chars().skip(shared).collect());
            json!({ "good": good, "bad": bad, "power": other })
        }
        (_, Ok((got, power))) => json!({ "good": "", "bad": got, "power": power }),
        (Err(want), Err(got)) if want == got => json!({ "good": got, "bad": "", "power": "" }),
        (_, Err(got)) => json!({ "good": "", "bad": got, "power": "" }),
    }
}

/// Returns the sign and digits with a point after the first, and the power of ten if it is not 0.
fn number(x: &Big) -> (String, String) {
    let (digits, power) = x.decimal(DIGITS);
    let (first, rest) = digits.split_at(1);
    let sign = if x.is_negative() { "−" } else { "" };
    let power = if power == 0 { String::new() } else { format!("·10{}", raised(&power.to_string())) };
    (format!("{sign}{first}.{rest}"), power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_told_from_above() {
        let shown = [0.0, 2.2e-16, 3.1e-16, 1e-10, 9.5e-13, 0.031, 0.95, 3.2, 4567.0, f64::NAN].map(upper);
        assert_eq!(shown, ["ε", "ε", "4·10⁻¹⁶", "10⁻¹⁰", "10⁻¹²", "0.04", "1", "4", "5·10³", "∞"]);
    }
}
