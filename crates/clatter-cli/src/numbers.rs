//! Numbers as they are shown: to people with six significant digits, to machines with all of them.

pub(crate) use clatter_answer::Json;

/// Six significant digits, so that a column tells at a glance how exact it is; −0 is 0.
///
/// From 10⁻³ to 10⁶ without an exponent. A digit more or less is never a matter of the row: each value is
/// rounded by itself.
pub(crate) fn figures(x: f64) -> String {
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

/// An input as somebody would have written it: every digit, and no `.0`.
pub(crate) fn given(x: f64) -> String {
    let text = digits(x);
    text.strip_suffix(".0").map_or_else(|| text.clone(), str::to_owned)
}

/// The shortest digits that read back as the same f64, for csv: `inf` is what readers of tables expect.
pub(crate) fn digits(x: f64) -> String {
    format!("{:?}", x + 0.0)
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
    fn machines_get_every_digit() {
        for (x, written) in [
            (1.0, "1.0"),
            (-0.0, "0.0"),
            (0.1 + 0.2, "0.30000000000000004"),
            (1e20, "1e+20"),
            (5e-324, "5e-324"),
            (f64::INFINITY, "\"infinite\""),
        ] {
            assert_eq!(serde_json::to_string(&Json(x)).unwrap(), written);
        }
        assert_eq!(digits(f64::INFINITY), "inf");
        assert_eq!(digits(-0.0), "0.0");
        assert_eq!([-1.0, 0.5, 1e-300, -0.0].map(given), ["-1", "0.5", "1e-300", "0"]);
    }
}
