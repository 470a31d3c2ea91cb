//! This module writes values as people say them: in common units, with as many digits as they are good for.

pub(crate) use clatter_answer::drop_in_words as drop;
use clatter_answer::significant;
use clatter_product::{Unit, units};

/// Writes a value in the unit that it was written in, or else in the customary one.
pub(crate) fn in_words(unit: Unit, written: Option<&units::Unit>, value: f64) -> String {
    let unit = written.unwrap_or(unit.customary());
    format!("{} {}", four(unit.of_si(value)), unit.name)
}

/// Writes a number with four significant digits: no drop is known to more.
pub(crate) fn four(x: f64) -> String {
    significant(x, 4)
}

/// Writes a margin with its sign.
pub(crate) fn margin(margin: f64) -> String {
    if margin.is_infinite() { "none asked".to_owned() } else { format!("{:+.1} %", 100.0 * margin) }
}

/// Writes a share as a percentage with two digits, which is the accuracy of errors.
pub(crate) fn percent(share: f64) -> String {
    match 100.0 * share {
        p if p.is_infinite() => "infinite".to_owned(),
        0.0 => "0 %".to_owned(),
        p if p < 1e-3 => format!("{p:.0e} %"),
        p => format!("{} %", significant(p, 2)),
    }
}

/// Writes a time to three digits.
pub(crate) fn time(seconds: f64) -> String {
    let (factor, name) = match seconds {
        s if s < 0.999_5e-6 => (1e9, "ns"),
        s if s < 0.999_5e-3 => (1e6, "µs"),
        _ => (1e3, "ms"),
    };
    let x = factor * seconds;
    let places = if x < 9.995 { 2 } else { usize::from(x < 99.95) };
    format!("{x:.places$} {name}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_four_digits() {
        let values = [0.041_666, 0.4, 9.999_6, 123.456, 12_345.6, 0.0, -0.012_344_9, f64::INFINITY];
        let said = ["0.04167", "0.4000", "10.00", "123.5", "12346", "0", "-0.01234", "infinite"];
        assert_eq!(values.map(four), said);
    }

    #[test]
    fn shares_and_times_have_as_many_digits_as_they_are_good_for() {
        let shares = [f64::INFINITY, 0.0, 1e-9, 0.000_05, 0.012_34, 0.099_6, 0.37, 12.0];
        let said = ["infinite", "0 %", "1e-7 %", "0.0050 %", "1.2 %", "10 %", "37 %", "1200 %"];
        assert_eq!(shares.map(percent), said);
        let times = [2.5e-7, 0.999_6e-6, 3.456e-5, 1.5e-3, 2.0];
        assert_eq!(times.map(time), ["250 ns", "1.00 µs", "34.6 µs", "1.50 ms", "2000 ms"]);
    }
}
