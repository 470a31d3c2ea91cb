//! Times of day and dates as numbers of seconds.

use crate::decimal::Decimal;

/// Significant digits of a time of day: it has none that say how exact it is.
pub(crate) const CLOCK: i32 = -1;
/// Seconds of a day.
pub(crate) const DAY_S: f64 = 86_400.0;

/// A time of day, `12:34:56.7`, or a date and a time, `2023-01-02T03:04:05.6Z`, in seconds since midnight or since 1970: exact,
/// with the digits that were printed. A date alone is its midnight.
pub(crate) fn seconds(text: &str) -> Option<Decimal> {
    let text = text.trim();
    let (day, clock) = match text.as_bytes() {
        [y1, y2, y3, y4, b'-' | b'/' | b'.', ..] if [y1, y2, y3, y4].iter().all(|c| c.is_ascii_digit()) => {
            let (date, clock) = text.split_at_checked(10)?;
            (days(date)?, clock.trim_start_matches(['T', 't', ' ', '_']))
        }
        _ => (0, text),
    };
    if clock.is_empty() {
        return (text.len() == 10).then_some(whole(day * 86_400));
    }
    let (clock, east_s) = zone(clock)?;
    let (minutes, rest) = clock.rsplit_once(':')?;
    let (hour, minute) = minutes.split_once(':').unwrap_or(("0", minutes));
    let two = |text: &str| {
        let digits = !text.is_empty() && text.len() <= 2 && text.bytes().all(|c| c.is_ascii_digit());
        digits.then(|| text.parse::<i64>().ok()).flatten()
    };
    let (hour, minute) = (two(hour)?, two(minute)?);
    let rest = rest.replace(',', ".");
    let (second, length) = Decimal::scan(rest.as_bytes(), b'.')?;
    if length != rest.len() || second.negative || second.float() >= 61.0 || minute > 59 || hour > 24 {
        return None;
    }
    // Whole minutes in the unit of the last digit of the seconds.
    let places = u32::try_from(-second.exponent.min(0)).ok().filter(|places| *places <= 9)?;
    let minutes = day * 86_400 + hour * 3600 + minute * 60 - east_s;
    let unit = 10_i64.pow(places);
    let second = i64::try_from(second.mantissa).ok()?;
    let total = minutes.checked_mul(unit)?.checked_add(second)?;
    let exponent = -i32::try_from(places).ok()?;
    Some(Decimal { exponent, ..whole(total) })
}

fn whole(number: i64) -> Decimal {
    Decimal { negative: number < 0, mantissa: number.unsigned_abs(), exponent: 0, digits: CLOCK }
}

/// A time without its zone, and how far east that is: `Z`, `+01:00`, `-0500`.
fn zone(clock: &str) -> Option<(&str, i64)> {
    if let Some(clock) = clock.strip_suffix(['Z', 'z']) {
        return Some((clock.trim_end(), 0));
    }
    let Some(at) = clock.rfind(['+', '-']) else { return Some((clock, 0)) };
    let (clock, zone) = clock.split_at(at);
    let digits: String = zone[1..].chars().filter(|c| *c != ':').collect();
    let number: i64 = digits.parse().ok()?;
    let (hours, minutes) = if digits.len() <= 2 { (number, 0) } else { (number / 100, number % 100) };
    if hours > 24 || minutes > 59 {
        return None;
    }
    let east = 3600 * hours + 60 * minutes;
    Some((clock.trim_end(), if zone.starts_with('-') { -east } else { east }))
}

/// Days since 1970 of a date such as 2023-01-02, by the Gregorian calendar.
fn days(date: &str) -> Option<i64> {
    let parts: Vec<i64> = date.split(['-', '/', '.']).map(|part| part.parse().ok()).collect::<Option<_>>()?;
    let [year, month, day] = parts[..] else { return None };
    if !(1..=12).contains(&month) || !(1..=31).contains(&day) || !(1..=9999).contains(&year) {
        return None;
    }
    // Years that begin in March have their odd day last.
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let leap = year / 4 - year / 100 + year / 400;
    Some(365 * year + leap + (153 * month + 2) / 5 + day - 719_469)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_and_clocks_are_seconds() {
        for (text, seconds_s) in [
            ("00:00:01.5", 1.5),
            ("12:34:56.0001", 45_296.000_1),
            ("12:34:56,25", 45_296.25),
            ("2:05", 125.0),
            ("1970-01-01T00:00:00Z", 0.0),
            ("1970-01-02", DAY_S),
            ("2000-03-01 00:00:00", 951_868_800.0),
            ("2023-01-02T03:04:05.5Z", 1_672_628_645.5),
            ("2023-01-02T04:04:05.5+01:00", 1_672_628_645.5),
            ("2023/01/02 03:04:05", 1_672_628_645.0),
            ("1969-12-31T23:59:59.5Z", -0.5),
        ] {
            assert_eq!(seconds(text).expect(text).float().to_bits(), f64::to_bits(seconds_s), "{text}");
        }
        for none in
            ["", "12", "12:", ":12", "12:61:00", "2023-13-01", "2023-01-02T", "ab:cd", "12:34:56x", "1.5", "12:34:5e3"]
        {
            assert_eq!(seconds(none), None, "{none}");
        }
    }
}
