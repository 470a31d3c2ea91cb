//! Numbers as the columnar files store them: rows without a value, and points in time.

use super::number::Number;
use super::refuse;
use crate::{Error, Values};

/// How the numbers of a column are stored.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stored {
    Number(Number),
    /// Times in ticks of so many nanoseconds, which are integers of 4 or 8 bytes.
    Time(Number, i64),
    /// Nanoseconds of the day and the day, as old programs write times.
    Int96,
}

impl Stored {
    /// Bytes of one.
    pub(super) fn width(self) -> usize {
        match self {
            Self::Number(number) | Self::Time(number, _) => number.size(),
            Self::Int96 => 12,
        }
    }
    /// Its unit, which times have.
    pub(super) fn unit(self) -> Option<String> {
        if let Self::Number(_) = self { None } else { Some("ns".to_owned()) }
    }
    /// The values of all rows.
    pub(super) fn values(
        self,
        bytes: &[u8],
        big_endian: bool,
        is_valid: impl Fn(usize) -> bool,
        name: &str,
    ) -> Result<Values, Error> {
        match self {
            Self::Number(number) => marked(number.values(bytes, big_endian), is_valid, name),
            Self::Time(number, tick) => times(number.values(bytes, big_endian), tick, is_valid, name),
            Self::Int96 => {
                let beyond = || refuse(format!("column {name:?}: a time is beyond the year 2262"));
                let stamps = bytes.as_chunks::<12>().0;
                let found = stamps.iter().enumerate().map(|(row, stamp)| {
                    // A row without a time is told below.
                    if is_valid(row) { day_and_time(*stamp).ok_or_else(beyond) } else { Ok(0) }
                });
                times(Values::Integer(found.collect::<Result<_, _>>()?), 1, is_valid, name)
            }
        }
    }
}

/// A row without a value becomes NaN, which integers beyond 2⁵³ cannot be.
fn marked(values: Values, is_valid: impl Fn(usize) -> bool, name: &str) -> Result<Values, Error> {
    match values {
        Values::Float(mut values) => {
            values.iter_mut().enumerate().filter(|(row, _)| !is_valid(*row)).for_each(|(_, value)| *value = f64::NAN);
            Ok(Values::Float(values))
        }
        Values::Integer(values) => match (0..values.len()).find(|row| !is_valid(*row)) {
            None => Ok(Values::Integer(values)),
            Some(row) => Err(missing(name, row)),
        },
    }
}

/// The numbers of a dictionary at these places, which are those of rows that have one.
pub(super) fn looked_up(
    dictionary: &Values,
    places: Values,
    is_valid: impl Fn(usize) -> bool,
    name: &str,
) -> Result<Values, Error> {
    let places = places.into_integers();
    let place = |row: usize| {
        let place = usize::try_from(places[row]).ok().filter(|place| *place < dictionary.len());
        place.ok_or_else(|| refuse(format!("column {name:?}, row {}: its place is beyond the dictionary", row + 1)))
    };
    let rows = 0..places.len();
    Ok(match dictionary {
        Values::Float(numbers) => {
            let number = |row| if is_valid(row) { place(row).map(|place| numbers[place]) } else { Ok(f64::NAN) };
            Values::Float(rows.map(number).collect::<Result<_, _>>()?)
        }
        Values::Integer(numbers) => {
            let number =
                |row| if is_valid(row) { place(row).map(|place| numbers[place]) } else { Err(missing(name, row)) };
            Values::Integer(rows.map(number).collect::<Result<_, _>>()?)
        }
    })
}

/// Nanoseconds from times in ticks of so many.
fn times(values: Values, tick_ns: i64, is_valid: impl Fn(usize) -> bool, name: &str) -> Result<Values, Error> {
    let mut times = values.into_integers();
    for (row, time) in times.iter_mut().enumerate() {
        if !is_valid(row) {
            return Err(missing(name, row));
        }
        *time = time
            .checked_mul(tick_ns)
            .ok_or_else(|| refuse(format!("column {name:?}, row {}: the time is beyond the year 2262", row + 1)))?;
    }
    Ok(Values::Integer(times))
}

fn missing(name: &str, row: usize) -> Error {
    refuse(format!("column {name:?}, row {}: there is no value; fill the gap or leave the row out", row + 1))
}

/// Nanoseconds since 1970 from nanoseconds of a day and the number of the day since 4713 BC.
fn day_and_time([a, b, c, d, e, f, g, h, day @ ..]: [u8; 12]) -> Option<i64> {
    const DAY_OF_1970: i64 = 2_440_588;
    let time = i64::from_le_bytes([a, b, c, d, e, f, g, h]);
    (i64::from(u32::from_le_bytes(day)) - DAY_OF_1970).checked_mul(86_400_000_000_000)?.checked_add(time)
}
