//! Values as people say them: in common units, with as many digits as they are good for.

use clatter_answer::significant;
use clatter_assess::{Axis, DropName, Unit, WorstCase, units};

use crate::inputs;

/// A value in the unit that it was written in, or else in the one that people use for it.
pub(crate) fn in_words(unit: Unit, written: Option<&units::Unit>, value: f64) -> String {
    let unit = written.unwrap_or(unit.customary());
    format!("{} {}", four(unit.of_si(value)), unit.name)
}

/// Four significant digits: more no drop is known to.
pub(crate) fn four(x: f64) -> String {
    significant(x, 4)
}

/// A margin, with its sign.
pub(crate) fn margin(margin: f64) -> String {
    if margin.is_infinite() { "none asked".to_owned() } else { format!("{:+.1} %", 100.0 * margin) }
}

/// A share of a hundred to two digits, which is what errors are good for.
pub(crate) fn percent(share: f64) -> String {
    match 100.0 * share {
        p if p.is_infinite() => "infinite".to_owned(),
        0.0 => "0 %".to_owned(),
        p if p < 1e-3 => format!("{p:.0e} %"),
        p => format!("{} %", significant(p, 2)),
    }
}

/// A time to three digits.
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

/// A worst drop: how it falls, and the part in it.
pub(crate) fn drop(worst: &WorstCase) -> String {
    let contact = worst.drop.contact_time_s.map_or(String::new(), |s| format!(", contacts of {} ms", four(1e3 * s)));
    let gyration = worst.gyration_m().map_or(String::new(), |m| format!(", radius of gyration {} mm", four(1e3 * m)));
    let part = worst.frequency_hz().zip(worst.damping_ratio());
    let part = part.map_or(String::new(), |(hz, ratio)| format!(", {} Hz, damping ratio {}", four(hz), four(ratio)));
    let lands = if worst.drop.is_flat {
        "flat".to_owned()
    } else {
        let attitude = worst.landing.and_then(DropName::attitude);
        let landing = attitude.map(|attitude| format!("{attitude}, {} deg off", four(worst.tilt_deg())));
        match worst.direction_deg() {
            _ if landing.is_some() => landing.unwrap_or_default(),
            Some(direction) => format!("{} deg, rising to {} deg", four(worst.tilt_deg()), four(direction)),
            None => format!("{} first, {} deg", inputs::letter(worst.drop.first()), four(worst.tilt_deg())),
        }
    };
    let place = if worst.drop.body.is_wide() {
        format!("{}, {}", four(1e3 * worst.part.place.at_m[0]), four(1e3 * worst.part.place.at_m[1]))
    } else {
        four(1e3 * worst.part.place.at_m[0])
    };
    let axis = worst.axis().map_or(String::new(), |axis| match axis {
        Axis::Any => ", along the blow".to_owned(),
        axis => format!(", along {}", axis.name()),
    });
    let optional = worst.optional().map(|(row, optional, x)| format!(", {} {} {}", optional.phrase, four(x), row.unit));
    let optional: String = optional.collect();
    let own = worst.drop.own_contacts.told(worst.drop.restitution, worst.drop.contact_time_s);
    let one = |(at, e, time_s): (&str, f64, Option<f64>)| {
        format!(", at {at} e {} and {} ms", four(e), four(1e3 * time_s.unwrap_or(0.0)))
    };
    let own: String = own.map(one).collect();
    let number = worst.landing.and_then(DropName::number).map_or(String::new(), |n| format!("drop {n}, "));
    format!(
        "{number}{lands}, {} m/s{optional}, e {}{contact}{own}{gyration}; at {place} mm{axis}{part}",
        four(worst.drop.speed_m_s),
        four(worst.drop.restitution),
    )
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
