//! This module writes numbers as they are shown: to people with six significant digits, to machines with all of them.

pub(crate) use clatter_answer::figures;

/// Writes an input as somebody would have written it: every digit, and no `.0`.
pub(crate) fn given(x: f64) -> String {
    let text = digits(x);
    text.strip_suffix(".0").map_or_else(|| text.clone(), str::to_owned)
}

/// Writes the shortest digits that read back as the same f64, for csv: `inf` is what readers of tables expect.
pub(crate) fn digits(x: f64) -> String {
    format!("{:?}", x + 0.0)
}

#[cfg(test)]
mod tests {
    use clatter_answer::Json;

    use super::*;

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
