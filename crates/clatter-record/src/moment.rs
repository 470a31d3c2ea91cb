//! Times of day and dates as numbers of seconds.

use std::borrow::Cow;

use crate::decimal::Decimal;

/// Significant digits of a time of day: it has none that say how exact it is.
pub(crate) const CLOCK: i32 = -1;
/// The same of one with its date, which does not go round at midnight.
pub(crate) const DATED: i32 = -2;
/// Seconds of a day.
pub(crate) const DAY_S: f64 = 86_400.0;

/// The order of dates such as 5/4/2023.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Order {
    Day,
    Month,
}

/// A time of day, `12:34:56.7`, or a date and a time, `2023-01-02T03:04:05.6Z`, in seconds since midnight or since 1970: exact,
/// with the digits that were printed. A date alone is its midnight. Where the order of day and month is not known the date does not
/// count.
pub(crate) fn seconds(text: &str, order: Option<Order>) -> Option<Decimal> {
    let text = text.trim();
    // Most cells are refused at once.
    if !text.contains([':', '-', '/', '.']) || text.len() > LONGEST {
        return None;
    }
    // As data frames write durations: `0 days 00:00:00.0001`, `-1 days +23:59:59.9`.
    if let Some((days, clock)) = text.split_once(" days ").or_else(|| text.split_once(" day ")) {
        let days: i64 = days.parse().ok().filter(|days: &i64| days.abs() < 1_000_000)?;
        return of_clock(clock.strip_prefix('+').unwrap_or(clock), days, DATED);
    }
    let Some((date, clock)) = dated(text) else { return of_clock(text, 0, CLOCK) };
    let (day, digits) = match date.days(order)? {
        Days::Known(day) => (day, DATED),
        Days::Open => (0, CLOCK),
    };
    if clock.is_empty() {
        return Some(Decimal { digits, ..whole(day * 86_400) });
    }
    of_clock(clock, day, digits)
}

/// No moment is longer.
const LONGEST: usize = 48;

/// A time of day of some day.
fn of_clock(clock: &str, day: i64, digits: i32) -> Option<Decimal> {
    let (clock, half) = half_of_day(clock);
    let (clock, east_s) = zone(clock)?;
    let dated = digits == DATED;
    let mut parts = [""; 5];
    let mut found = 0;
    for part in clock.split(':') {
        *parts.get_mut(found)? = part;
        found += 1;
    }
    let count = |text: &str, most: usize| {
        let digits = !text.is_empty() && text.len() <= most && text.bytes().all(|c| c.is_ascii_digit());
        digits.then(|| text.parse::<i64>().ok()).flatten()
    };
    // Days before the hours, or digits of the second behind a colon, as many as milliseconds take at least: two are frames.
    let (days, hour, minute, second) = match parts[..found] {
        // Behind a date the hour comes first.
        [hour, minute] if dated && !minute.contains(['.', ',']) => {
            (0, count(hour, 2)?, count(minute, 2)?, Cow::Borrowed("0"))
        }
        [minute, second] => (0, 0, count(minute, 2)?, Cow::Borrowed(second)),
        [hour, minute, second] => {
            (0, count(hour, if dated { 2 } else { 4 })?, count(minute, 2)?, Cow::Borrowed(second))
        }
        [days, hour, minute, second] if second.contains(['.', ',']) && !dated => {
            (count(days, 3)?, count(hour, 2)?, count(minute, 2)?, Cow::Borrowed(second))
        }
        [hour, minute, second, part] if (3..=9).contains(&part.len()) => {
            let second = count(second, 2).filter(|_| second.len() == 2)?;
            (0, count(hour, 2)?, count(minute, 2)?, Cow::Owned(format!("{second}.{}", count(part, 9).map(|_| part)?)))
        }
        // 10.00.00.000, behind a date.
        [points] if dated => {
            let mut points = points.splitn(3, '.');
            (0, count(points.next()?, 2)?, count(points.next()?, 2)?, Cow::Borrowed(points.next()?))
        }
        _ => return None,
    };
    let hour = match half {
        None => hour,
        Some(half) if (1..=12).contains(&hour) => hour % 12 + 12 * i64::from(half),
        Some(_) => return None,
    };
    let second = if second.contains(',') { Cow::Owned(second.replace(',', ".")) } else { second };
    let (second, length) = Decimal::scan(second.as_bytes(), b'.').filter(|(_, length)| *length == second.len())?;
    debug_assert!(length > 0, "a number has a digit");
    if second.negative || second.float() >= 61.0 || minute > 59 || hour > 24 && dated {
        return None;
    }
    // Whole minutes in the unit of the last digit of the seconds.
    let places = u32::try_from(-second.exponent.min(0)).ok().filter(|places| *places <= 9)?;
    let minutes = (day + days) * 86_400 + hour * 3600 + minute * 60 - east_s;
    let unit = 10_i64.pow(places);
    let second = i64::try_from(second.mantissa).ok()?;
    let total = minutes.checked_mul(unit)?.checked_add(second)?;
    let exponent = -i32::try_from(places).ok()?;
    Some(Decimal { exponent, digits, ..whole(total) })
}

fn whole(number: i64) -> Decimal {
    Decimal { negative: number < 0, mantissa: number.unsigned_abs(), exponent: 0, digits: CLOCK }
}

/// A time without AM or PM, and which of both.
fn half_of_day(clock: &str) -> (&str, Option<bool>) {
    let marks = [("am", false), ("a.m.", false), ("pm", true), ("p.m.", true)];
    for (mark, half) in marks {
        let Some(at) = clock.len().checked_sub(mark.len()).filter(|at| clock.is_char_boundary(*at)) else { continue };
        if clock[at..].eq_ignore_ascii_case(mark) {
            return (clock[..at].trim_end(), Some(half));
        }
    }
    (clock, None)
}

/// Days since 1970, if they are known.
#[derive(Debug, Clone, Copy)]
enum Days {
    Known(i64),
    Open,
}

/// A date as it is written.
#[derive(Debug, Clone, Copy)]
enum Date {
    /// Year, month, day.
    Sure(i64, i64, i64),
    /// Year, and day and month in the one or the other order.
    Either(i64, i64, i64),
}

impl Date {
    /// Days since 1970; not known where the order of day and month matters and is not known.
    fn days(self, order: Option<Order>) -> Option<Days> {
        let (year, month, day) = match self {
            Self::Sure(year, month, day) => (year, month, day),
            Self::Either(year, a, b) => match self.order().or(order) {
                Some(Order::Day) => (year, b, a),
                Some(Order::Month) => (year, a, b),
                None if a == b => (year, a, b),
                None => return (a > 0 && b > 0).then_some(Days::Open),
            },
        };
        days(year, month, day).map(Days::Known)
    }
    /// The order that is the only possible one.
    fn order(self) -> Option<Order> {
        match self {
            Self::Either(_, a, b) if a > 12 && b <= 12 => Some(Order::Day),
            Self::Either(_, a, b) if b > 12 && a <= 12 => Some(Order::Month),
            _ => None,
        }
    }
}

/// Returns what a cell tells of the order of day and month.
pub(crate) fn order(cell: &str) -> Option<Order> {
    dated(cell.trim())?.0.order()
}

/// The date of a cell, as text, if its day and month may be either.
pub(crate) fn either(cell: &str) -> Option<&str> {
    let text = cell.trim();
    let (date, clock) = dated(text)?;
    let is_open = matches!(date, Date::Either(_, a, b) if a != b) && date.order().is_none();
    is_open.then(|| text[..text.len() - clock.len()].trim_end())
}

/// The date that a text begins with, and the rest of it.
fn dated(text: &str) -> Option<(Date, &str)> {
    // 20230102T100000.5
    if text.is_char_boundary(9)
        && let (date, Some(clock)) = (text.get(..8)?, text.get(9..))
        && date.bytes().all(|c| c.is_ascii_digit())
        && text[8..].starts_with(['T', 't'])
        && clock.contains(':')
    {
        let number = |text: &str| text.parse::<i64>().ok();
        return Some((Date::Sure(number(&date[..4])?, number(&date[4..6])?, number(&date[6..])?), clock));
    }
    let separator = text.find(['-', '/', '.', ' ', ':'])?;
    let mark = text[separator..].chars().next()?;
    let (first, rest) = (&text[..separator], &text[separator + 1..]);
    let middle = rest.find(mark).filter(|middle| (1..=9).contains(middle))?;
    let (second, rest) = (&rest[..middle], &rest[middle + 1..]);
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let (third, clock) = rest.split_at(end);
    let number = |text: &str| {
        let is_number = (1..=4).contains(&text.len()) && text.bytes().all(|c| c.is_ascii_digit());
        is_number.then(|| text.parse::<i64>().ok()).flatten()
    };
    let year = |text: &str| match text.len() {
        4 => number(text),
        2 => Some(2000 + number(text)?),
        _ => None,
    };
    let short = |text: &str| number(text).filter(|_| text.len() <= 2);
    let after = |clock: &'_ str| {
        let sign = clock.starts_with(['T', 't', ' ', '_', '/', ',']);
        clock.is_empty() || sign
    };
    if !after(clock) {
        return None;
    }
    let (sign, clock) = (clock.trim(), clock.trim_start_matches(['T', 't', ' ', '_', '/', ',']));
    if clock.is_empty() && !sign.is_empty() {
        return None;
    }
    // Jan 2 2023, Jan-2-2023
    if let Some(month) = month(first) {
        return Some((Date::Sure(year(third)?, month, short(second.trim_end_matches(','))?), clock));
    }
    // 12:34:56 is a time; 2023:01:02 is a date.
    let date = if first.len() == 4 && mark != ' ' {
        Date::Sure(number(first)?, month(second).or_else(|| short(second))?, short(third)?)
    } else if let Some(month) = month(second) {
        Date::Sure(year(third)?, month, short(first)?)
    } else {
        match mark {
            '.' if third.len() == 4 || third.len() == 2 && !clock.is_empty() => {
                Date::Sure(year(third)?, short(second)?, short(first)?)
            }
            '/' => Date::Either(year(third)?, short(first)?, short(second)?),
            '-' if third.len() == 4 => Date::Either(number(third)?, short(first)?, short(second)?),
            _ => return None,
        }
    };
    Some((date, clock))
}

/// A month by its name, or the beginning of it.
fn month(name: &str) -> Option<i64> {
    const MONTHS: [&[&str]; 12] = [
        &["jan"],
        &["feb"],
        &["mar", "mär", "mrz"],
        &["apr"],
        &["may", "mai"],
        &["jun"],
        &["jul"],
        &["aug"],
        &["sep"],
        &["oct", "okt"],
        &["nov"],
        &["dec", "dez"],
    ];
    // Numbers are none, at once.
    if !name.starts_with(char::is_alphabetic) {
        return None;
    }
    let name = name.to_lowercase();
    let month = MONTHS
        .iter()
        .position(|names| names.iter().any(|begin| name.starts_with(begin)))
        .filter(|_| name.chars().all(char::is_alphabetic))?;
    i64::try_from(month + 1).ok()
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

/// Days since 1970 of a date, by the Gregorian calendar.
fn days(year: i64, month: i64, day: i64) -> Option<i64> {
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
    fn day_and_month_in_the_one_order_that_is_possible() {
        assert_eq!(
            (order("13/5/2023"), order("5/13/2023 12:00:00"), order("5/4/2023")),
            (Some(Order::Day), Some(Order::Month), None)
        );
        assert_eq!(
            (either("5/4/2023 12:00:00"), either("5/5/2023"), either("13/5/2023")),
            (Some("5/4/2023"), None, None)
        );
        let of = |order| seconds("2/1/1970", Some(order)).expect("a date").float();
        assert_eq!((of(Order::Day).to_bits(), of(Order::Month).to_bits()), (DAY_S.to_bits(), (31.0 * DAY_S).to_bits()));
    }

    #[test]
    fn dates_and_clocks_are_seconds() {
        for (text, seconds_s) in [
            ("00:00:01.5", 1.5),
            ("12:34:56.0001", 45_296.000_1),
            ("0 days 00:00:00.0001", 1e-4),
            ("1 days 00:00:01", 86_401.0),
            ("1970-01-02T08:01", 115_260.0),
            ("-1 days +23:59:59.75", -0.25),
            ("12:34:56,25", 45_296.25),
            ("2:05", 125.0),
            ("1970-01-01T00:00:00Z", 0.0),
            ("1970-01-02", DAY_S),
            ("2000-03-01 00:00:00", 951_868_800.0),
            ("2023-01-02T03:04:05.5Z", 1_672_628_645.5),
            ("2023-01-02T04:04:05.5+01:00", 1_672_628_645.5),
            ("2023/01/02 03:04:05", 1_672_628_645.0),
            ("1969-12-31T23:59:59.5Z", -0.5),
            ("12:00:01 PM", 43_201.0),
            ("12:00:01.5am", 1.5),
            ("1:00:00 p.m.", 46_800.0),
            ("12:34:56:250", 45_296.25),
            ("124:00:00.5", 446_400.5),
            ("001:00:00:00.5", 86_400.5),
            ("01.03.2000 00:00:01,5", 951_868_801.5),
            ("13/01/1970 00:00:00", 12.0 * DAY_S),
            ("1/13/1970 12:00:00 AM", 12.0 * DAY_S),
            ("02-Jan-1970 00:00:01", DAY_S + 1.0),
            ("1970:1:2/00:00:01", DAY_S + 1.0),
            ("1970-01-02T00.00.01.500", DAY_S + 1.5),
            ("Jan 2, 1970 00:00:01", DAY_S + 1.0),
            ("19700102T00:00:01", DAY_S + 1.0),
            // The order is not known, and the date does not count.
            ("5/4/2023 00:00:02", 2.0),
        ] {
            assert_eq!(seconds(text, None).expect(text).float().to_bits(), f64::to_bits(seconds_s), "{text}");
        }
        let none = " | 12 | 12: | :12 | 12:61:00 | 2023-13-01 | 2023-01-02T | ab:cd | 12:34:56x | 1.5 | 12:34:5e3 | \
                    13:00:00 PM | 12:00:01:12 | 1.5.2 | 99/99/2023";
        for none in none.split(" | ") {
            assert_eq!(seconds(none, None), None, "{none}");
        }
    }
}
