//! Axes for plotters, logarithmic or linear, and numbers as short words.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

/// One axis.
#[derive(Debug, Clone, Copy)]
pub struct Axis<'a> {
    /// Its value at the low end.
    pub low: f64,
    /// Its value at the high end.
    pub high: f64,
    /// True for a logarithmic axis.
    pub log: bool,
    /// Title, in figure markup.
    pub title: &'a str,
    /// True for an axis without ticks and grid.
    pub bare: bool,
}

impl Ranged for Axis<'_> {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;
    #[expect(clippy::cast_possible_truncation, reason = "figures are small")]
    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        from + (self.unit(*value) * f64::from(to - from)).round() as i32
    }
    fn key_points<H: KeyPointHint>(&self, hint: H) -> Vec<f64> {
        let (labels, lines) = self.ticks();
        if hint.weight().allow_light_points() { lines } else { labels }
    }
    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Axis<'_> {
    fn format_ext(&self, value: &f64) -> String {
        tick(*value)
    }
}

impl<'a> Axis<'a> {
    /// Creates a logarithmic axis over exactly this range.
    #[must_use]
    pub fn log(low: f64, high: f64, title: &'a str) -> Self {
        Self { low, high, log: true, title, bare: false }
    }
    /// Creates a logarithmic axis, widened to 1, 2 or 5 times powers of ten; at most `decades` down from the largest
    /// value.
    #[must_use]
    pub fn log_over(values: impl Iterator<Item = f64>, decades: f64, title: &'a str) -> Self {
        let (low, high) = values
            .filter(|v| *v > 0.0 && v.is_finite())
            .fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
        if low > high {
            return Self::log(0.1, 10.0, title);
        }
        let low = low.max(high * 10f64.powf(-decades));
        let (low, high) = (step_down(low), step_up(high));
        let (low, high) = if high < 8.0 * low { (step_down(0.4 * low), step_up(2.5 * high)) } else { (low, high) };
        Self::log(low.max(1e-307), high.min(1e307), title)
    }
    /// Creates a linear axis over exactly this range.
    #[must_use]
    pub fn linear(low: f64, high: f64, title: &'a str) -> Self {
        Self { low, high, log: false, title, bare: false }
    }
    /// Returns the share of the way: 0 at the low end, 1 at the high one; not finite for a value that a logarithm
    /// cannot show.
    pub(crate) fn unit(&self, v: f64) -> f64 {
        if self.log {
            (v.ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
        } else {
            (v - self.low) / (self.high - self.low)
        }
    }
    /// Returns the value at a share of the way.
    pub(crate) fn value(&self, unit: f64) -> f64 {
        let between = |a: f64, b: f64| a + unit * (b - a);
        if self.log { between(self.low.ln(), self.high.ln()).exp() } else { between(self.low, self.high) }
    }
    fn decades(&self) -> f64 {
        self.high.log10() - self.low.log10()
    }
    /// Returns the values with a label, and the values with a grid line alone.
    pub(crate) fn ticks(&self) -> (Vec<f64>, Vec<f64>) {
        if self.bare {
            return (Vec::new(), Vec::new());
        }
        if !self.log {
            return (round_values(self.low, self.high), Vec::new());
        }
        let decades = self.decades();
        let inside = |v: &f64| (-1e-9..=1.0 + 1e-9).contains(&self.unit(*v));
        let every = (decades / 10.0).ceil().max(1.0);
        let (mut labels, mut lines) = (Vec::new(), Vec::new());
        let mut exponent = self.low.log10().floor();
        while exponent <= self.high.log10() + 1e-9 {
            let decade = 10f64.powf(exponent);
            for k in 1..=9u8 {
                let v = f64::from(k) * decade;
                let labelled = match k {
                    1 => (exponent / every).fract() == 0.0,
                    2 | 5 => decades < 2.7,
                    _ => false,
                };
                if labelled {
                    labels.push(v);
                } else if k == 1 || decades < 6.5 {
                    lines.push(v);
                }
            }
            exponent += 1.0;
        }
        labels.retain(inside);
        lines.retain(inside);
        (labels, lines)
    }
}

/// Returns multiples of 1, 2 or 5 times a power of ten from `low` to `high`, four to nine of them; one if both are the
/// same.
pub(crate) fn round_values(low: f64, high: f64) -> Vec<f64> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return vec![low];
    }
    let rough = span / 5.0;
    let decade = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|k| k * decade).find(|s| *s >= rough * 0.9).unwrap_or(rough);
    let first = (low / step - 1e-9).ceil();
    let all = (0..=12u8).map(|k| (first + f64::from(k)) * step);
    all.filter(|v| *v <= high + 1e-9 * span).collect()
}

/// Returns the largest 1, 2 or 5 times a power of ten at or below `v`.
fn step_down(v: f64) -> f64 {
    let decade = 10f64.powf(v.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|k| k * decade).find(|s| *s <= v * (1.0 + 1e-9)).unwrap_or(0.5 * decade)
}

/// Returns the smallest 1, 2 or 5 times a power of ten at or above `v`.
#[must_use]
pub fn step_up(v: f64) -> f64 {
    let decade = 10f64.powf(v.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|k| k * decade).find(|s| *s >= v * (1.0 - 1e-9)).unwrap_or(10.0 * decade)
}

/// Returns a round value as text: plain from 0.001 to below 100 000, else with a power of ten.
#[must_use]
pub fn tick(v: f64) -> String {
    if v == 0.0 || (1e-3 * 0.999..0.999e5).contains(&v.abs()) {
        let text = format!("{v:.4}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        return text.replace('-', "−");
    }
    let text = format!("{v:.0e}");
    let (digit, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let power = format!("10{}", raised(exponent));
    if digit == "1" { power } else { format!("{digit}·{power}") }
}

/// Returns an exponent in raised digits.
#[must_use]
pub fn raised(exponent: &str) -> String {
    let sign = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
    };
    exponent.chars().map(sign).collect()
}

/// Returns a value with three significant digits, short.
#[must_use]
pub fn three(v: f64) -> String {
    if v == 0.0 || !(1e-3..1e5).contains(&v.abs()) {
        return tick(v);
    }
    let decimals = (2.0 - v.abs().log10().floor()).max(0.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 5")]
    let text = format!("{v:.*}", decimals as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_short_words() {
        assert_eq!([0.0, 0.001, 0.2, 5000.0, -2.0].map(tick), ["0", "0.001", "0.2", "5000", "−2"]);
        assert_eq!([1e5, 2e-4, 5e12].map(tick), ["10⁵", "2·10⁻⁴", "5·10¹²"]);
    }

    #[test]
    fn an_axis_has_a_few_labels_whatever_its_span() {
        for (low, high) in [(1.0, 9.0), (0.3, 40.0), (10.0, 1e4), (1e-12, 1e12), (1e-300, 1e300)] {
            let n = Axis::log(low, high, "").ticks().0.len();
            assert!((2..=12).contains(&n), "{low:e} to {high:e}: {n} labels");
        }
        let axis = Axis::log_over([3.0, 700.0, 0.0, f64::INFINITY].into_iter(), 5.0, "");
        assert_eq!((axis.low, axis.high), (2.0, 1000.0));
        let flat = Axis::log_over([2.5].into_iter(), 5.0, "");
        assert!(flat.low < 2.5 && flat.high > 2.5, "{flat:?}");
    }

    #[test]
    fn a_value_is_where_its_share_of_the_axis_is() {
        // The axes are a decade of three, a decade and a half of them, and a quarter of a straight axis.
        let (log, linear) = (Axis::log(1.0, 1000.0, ""), Axis::linear(-2.0, 6.0, ""));
        for (axis, value, unit) in [
            (&log, 1.0, 0.0),
            (&log, 10.0, 1.0 / 3.0),
            (&log, 10.0 * 10_f64.sqrt(), 0.5),
            (&log, 1000.0, 1.0),
            (&linear, -2.0, 0.0),
            (&linear, 0.0, 0.25),
            (&linear, 6.0, 1.0),
        ] {
            assert!((axis.unit(value) - unit).abs() < 1e-12, "{axis:?}: {value} at {}", axis.unit(value));
            assert!((axis.value(unit) - value).abs() < 1e-12 * 1000.0, "{axis:?}: {} at {unit}", axis.value(unit));
        }
    }
}
