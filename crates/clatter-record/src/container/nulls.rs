//! Rows without a value, and points in time, as the columnar files have them.

use super::refuse;
use crate::{Error, Values};

/// A row without a value becomes NaN, which integers beyond 2⁵³ cannot be.
pub(super) fn marked(values: Values, is_valid: impl Fn(usize) -> bool, name: &str) -> Result<Values, Error> {
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

/// Nanoseconds from times in ticks of so many.
pub(super) fn times(
    values: Values,
    tick_ns: i64,
    is_valid: impl Fn(usize) -> bool,
    name: &str,
) -> Result<Vec<i64>, Error> {
    let mut times = super::whole(values);
    for (row, time) in times.iter_mut().enumerate() {
        if !is_valid(row) {
            return Err(missing(name, row));
        }
        *time = time
            .checked_mul(tick_ns)
            .ok_or_else(|| refuse(format!("column {name:?}, row {}: the time is beyond the year 2262", row + 1)))?;
    }
    Ok(times)
}

fn missing(name: &str, row: usize) -> Error {
    refuse(format!("column {name:?}, row {}: there is no value; fill the gap or leave the row out", row + 1))
}
