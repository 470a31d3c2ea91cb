//! Limit curves from text: two columns, frequency and level.

use crate::Error;
use crate::heading::Heading;
use crate::text::table;
use crate::unit::{FREQUENCY, Kind, LENGTH, Unit, VELOCITY};

/// A limit over frequency, as a file has it.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitPoints {
    /// Frequency in Hz and level, in SI where the file names its unit.
    pub points: Vec<(f64, f64)>,
    /// The quantity of the unit: "acceleration", "velocity" or "length"; none where the file names none.
    pub of: Option<&'static str>,
    /// The unit of the level as the file spells it.
    pub unit: Option<String>,
}

/// Points that a curve has at most.
const MOST: usize = 10_000;

/// Reads a limit curve from text of two columns, in any notation that records may have; the units of frequency and level stand in
/// the heading, and where there is none they are Hz and SI.
///
/// ```
/// let curve = clatter_record::read_limit("frequency [Hz],limit [g]\n10,5\n100,50\n".as_bytes())?;
/// assert_eq!(curve.points[1], (100.0, 50.0 * 9.80665));
/// assert_eq!(curve.of, Some("acceleration"));
/// # Ok::<(), clatter_record::Error>(())
/// ```
///
/// # Errors
/// [`Error::Lines`] for lines that are not two numbers, [`Error::Units`] for units of something else, [`Error::Many`].
pub fn read_limit(input: impl std::io::Read) -> Result<LimitPoints, Error> {
    let (headings, rows) = table(input, MOST)?;
    if headings.len() != 2 {
        let count = headings.len();
        return Err(Error::Columns(format!(
            "a limit curve has two columns, frequency and level, and this file has {count}"
        )));
    }
    let [frequency, level] = [&headings[0], &headings[1]];
    let hertz = match (frequency.unit, &frequency.spelled) {
        (Some(Unit { kind: FREQUENCY, size }), _) => size,
        (None, None) => 1.0,
        _ => return Err(wrong(frequency, "a frequency")),
    };
    let (of, size) = match (level.unit.map(|unit| (unit.kind, unit.size)), &level.spelled) {
        (Some((Kind::Acceleration, size)), _) => (Some("acceleration"), size),
        (Some((VELOCITY, size)), _) => (Some("velocity"), size),
        (Some((LENGTH, size)), _) => (Some("length"), size),
        (None, None) => (None, 1.0),
        _ => return Err(wrong(level, "an acceleration, a velocity or a length")),
    };
    let points = rows.iter().map(|row| (row[0] * hertz, row[1] * size)).collect();
    Ok(LimitPoints { points, of, unit: level.spelled.clone() })
}

fn wrong(heading: &Heading, what: &str) -> Error {
    let unit = heading.spelled.as_deref().unwrap_or_default();
    Error::Units(format!("the unit of column '{}', {unit}, is not that of {what}", heading.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_come_with_their_units_or_without() {
        let of = |text: &str| read_limit(text.as_bytes());
        let plain = of("10;5,5\n100;50\n").expect("a curve");
        assert_eq!((plain.points, plain.of), (vec![(10.0, 5.5), (100.0, 50.0)], None));
        let typed = of("# limit\nfrequency (kHz)\tpseudo-velocity (in/s)\n0.01\t50\n1\t100\n").expect("a curve");
        assert_eq!((typed.points[0], typed.of), ((10.0, 50.0 * 0.0254), Some("velocity")));
        for (text, said) in [
            ("frequency [Hz],mass [kg]\n1,2\n3,4\n", "the unit of column 'mass', kg, is not that of an acceleration"),
            ("time [s],limit [g]\n1,2\n3,4\n", "the unit of column 'time', s, is not that of a frequency"),
            ("1,2,3\n3,4,5\n", "two columns"),
            ("f [Hz],a [g]\n1,2\n3,x\n4,5\n", "line 3: 'x' in column 2 is not a number"),
        ] {
            let error = of(text).expect_err(text).to_string();
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
