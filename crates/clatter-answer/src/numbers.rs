//! This module writes numbers as programs read them: every digit, a word for infinity, whole numbers without a fraction.

use clatter::Count;
use serde::{Serialize, Serializer};

/// An f64 in JSON: the shortest digits that read back the same, `"infinite"` for what JSON has no number for.
#[derive(Debug, Clone, Copy)]
pub struct Json(pub f64);

impl Serialize for Json {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            // serde_json would write null, and a reader would take it for "does not apply".
            x if x.is_nan() => Err(serde::ser::Error::custom("a value came out as not a number; please report this")),
            x if x.is_infinite() => serializer.serialize_str(if x > 0.0 { "infinite" } else { "-infinite" }),
            x => serializer.serialize_f64(x + 0.0),
        }
    }
}

/// Writes a number with six significant digits, so that a column shows at a glance how exact it is; −0 is 0.
///
/// From 10⁻³ to 10⁶ without an exponent. A digit more or less is never a matter of the row: each value is
/// rounded by itself.
#[must_use]
pub fn figures(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if x.is_infinite() {
        return if x > 0.0 { "infinite" } else { "-infinite" }.to_owned();
    }
    let scientific = format!("{x:.5e}");
    match scientific.rsplit('e').next().and_then(|exponent| exponent.parse::<i32>().ok()) {
        Some(exponent @ -3..=5) => format!("{x:.*}", usize::try_from(5 - exponent).unwrap_or(0)),
        _ => scientific,
    }
}

/// Writes a number with so many significant digits, without an exponent where [`figures`] has none.
#[must_use]
pub fn significant(x: f64, digits: i32) -> String {
    let shown = figures(x);
    if shown.contains('e') || !x.is_finite() || x == 0.0 {
        return shown;
    }
    // The exponent is that of the rounded number, so that 9.9996 is 10.00.
    let rounded = format!("{x:.*e}", usize::try_from(digits - 1).unwrap_or(0));
    let exponent = rounded.rsplit('e').next().and_then(|e| e.parse::<i32>().ok()).unwrap_or(0);
    format!("{x:.*}", usize::try_from(digits - 1 - exponent).unwrap_or(0))
}

/// Rounds a number to remove the digits that a conversion adds.
#[must_use]
pub fn neat(x: f64) -> f64 {
    format!("{x:.13e}").parse().unwrap_or(x)
}

/// Writes a count that is kept as a float, for csv: without a fraction as long as every whole number has its own float.
#[must_use]
pub fn whole(x: f64) -> String {
    if x.abs() < TWO_TO_53 { format!("{x:.0}") } else { format!("{:?}", x + 0.0) }
}

const TWO_TO_53: f64 = 9_007_199_254_740_992.0;

/// A count that is kept as a float, in JSON: an integer as long as every whole number has its own float.
#[derive(Debug, Clone, Copy)]
pub struct JsonWhole(pub f64);

impl Serialize for JsonWhole {
    #[expect(clippy::cast_possible_truncation, reason = "whole and below 2^53")]
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.abs() < TWO_TO_53 {
            serializer.serialize_i64(self.0 as i64)
        } else {
            Json(self.0).serialize(serializer)
        }
    }
}

/// A count in JSON: an integer up to 2⁶⁴, a float beyond, `"endless"`.
#[derive(Debug, Clone, Copy)]
pub struct JsonCount(pub Count);

impl Serialize for JsonCount {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Count::Finite(n) => serializer.serialize_u64(n),
            Count::Huge(n) => serializer.serialize_f64(n),
            Count::Endless => serializer.serialize_str("endless"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_get_six_digits_whatever_the_size() {
        for (x, shown) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1.00000"),
            (-0.65, "-0.650000"),
            (17.192_982_456_140_317, "17.1930"),
            (999_999.4, "999999"),
            (999_999.5, "1.00000e6"),
            (0.001, "0.00100000"),
            (0.000_999_999_6, "0.00100000"),
            (0.000_999_99, "9.99990e-4"),
            (-5e-324, "-4.94066e-324"),
            (1e308, "1.00000e308"),
            (f64::INFINITY, "infinite"),
            (f64::NEG_INFINITY, "-infinite"),
        ] {
            assert_eq!(figures(x), shown, "{x:?}");
        }
    }

    #[test]
    fn not_a_number_never_reaches_json() {
        assert!(serde_json::to_string(&Json(f64::NAN)).unwrap_err().to_string().contains("not a number"));
    }

    #[test]
    fn counts_are_integers_as_long_as_they_are_exact() {
        let json = |count| serde_json::to_string(&JsonCount(count)).unwrap();
        assert_eq!(json(Count::Finite(u64::MAX)), "18446744073709551615");
        assert_eq!(json(Count::Huge(2.0_f64.powi(65))), "3.6893488147419103e+19");
        assert_eq!(json(Count::Endless), "\"endless\"");
        for (x, text, in_json) in [
            (4.0, "4", "4"),
            (9_007_199_254_740_991.0, "9007199254740991", "9007199254740991"),
            (9_007_199_254_740_992.0, "9007199254740992.0", "9007199254740992.0"),
            (f64::INFINITY, "inf", "\"infinite\""),
        ] {
            assert_eq!((whole(x).as_str(), serde_json::to_string(&JsonWhole(x)).unwrap().as_str()), (text, in_json));
        }
    }
}
