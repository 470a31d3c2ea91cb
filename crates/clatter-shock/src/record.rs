//! Measured records: time and acceleration, line by line.

mod survey;

pub use survey::{Finding, Survey};

use crate::{DampingRatio, Error, Frequencies, Pulses, Quantity, Spectrum, SpectrumFilter, UnevenFilter};
use std::io::{BufRead, ErrorKind, Read};

/// Standard acceleration of free fall, 9.80665 m/s² exactly (3rd CGPM, 1901).
pub const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// Larger accelerations (m/s²) are refused: far beyond any that there are, and far within the floats.
const LARGEST: f64 = 1e100;

/// Units of the two columns, as factors to seconds and m/s².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    time: f64,
    acceleration: f64,
}

const TIME_UNITS: [(&str, f64); 5] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("µs", 1e-6), ("μs", 1e-6)];
const ACCELERATION_UNITS: [(&str, f64); 8] = [
    ("m/s2", 1.0),
    ("m/s^2", 1.0),
    ("m/s²", 1.0),
    ("m_s2", 1.0),
    ("m s-2", 1.0),
    ("g", STANDARD_GRAVITY_M_S2),
    ("gn", STANDARD_GRAVITY_M_S2),
    ("G", STANDARD_GRAVITY_M_S2),
];

impl Units {
    /// Seconds and m/s².
    pub const SI: Self = Self { time: 1.0, acceleration: 1.0 };

    /// By name: "s", "ms" or "us", and "m/s2" or "g".
    ///
    /// # Errors
    /// [`Error::Unit`] for a name that is none of these.
    pub fn named(time: &str, acceleration: &str) -> Result<Self, Error> {
        let find = |list: &[(&str, f64)], name: &str| {
            list.iter().find(|(n, _)| *n == name.trim()).map(|u| u.1).ok_or_else(|| Error::Unit(name.trim().to_owned()))
        };
        Ok(Self { time: find(&TIME_UNITS, time)?, acceleration: find(&ACCELERATION_UNITS, acceleration)? })
    }
    /// From a header such as `time [s], acceleration (g)` or `time_ms,acceleration_m_s2`.
    fn from_header(columns: [&str; 2]) -> Option<Self> {
        let unit = |column: &str, list: &[(&str, f64)]| {
            let column = column.trim().trim_matches('"').trim_end_matches([']', ')']);
            list.iter()
                .filter(|(name, _)| {
                    column.strip_suffix(name).is_some_and(|rest| rest.ends_with(['[', '(', '_', ' ', '/', ',']))
                })
                .max_by_key(|(name, _)| name.len())
                .map(|u| u.1)
        };
        Some(Self { time: unit(columns[0], &TIME_UNITS)?, acceleration: unit(columns[1], &ACCELERATION_UNITS)? })
    }
}

/// Bytes of a line at most: what is longer is no record, and would not fit in memory in the end.
const LONGEST: u64 = 1 << 16;
/// Reads a record line by line: two columns, time and acceleration, separated by semicolon, comma, tab or blanks; lines
/// that begin with `#` and empty ones are skipped; the first line may be a header, which may name the units. Further
/// columns are left out, which a [`Finding`] tells.
#[derive(Debug)]
pub struct Lines<R> {
    input: R,
    units: Option<Units>,
    text: String,
    line: usize,
    bytes: u64,
    previous: Option<f64>,
    /// Names of columns by the header, and what is told of those that nobody reads.
    names: Vec<String>,
    more_columns: Option<Finding>,
}

/// How a time is printed.
#[derive(Debug, Clone, Copy)]
struct Stamp {
    /// Power of ten of the last digit.
    place: i32,
    /// Significant digits.
    digits: i32,
    /// Unit of the time, in seconds.
    unit: f64,
}

impl Stamp {
    /// Of the number that a line begins with.
    fn of(line: &str, unit: f64) -> Self {
        let (mut place, mut digits, mut fraction) = (0, 0, false);
        let line = line.trim_start_matches('\u{feff}').trim_start();
        for (i, c) in line.bytes().enumerate() {
            match c {
                b'0'..=b'9' => {
                    digits += i32::from(digits > 0 || c != b'0');
                    place -= i32::from(fraction);
                }
                b'.' => fraction = true,
                b'+' | b'-' => {}
                b'e' | b'E' => {
                    let exponent = line[i + 1..].split([',', ';', ' ', '\t']).next().unwrap_or_default();
                    place += exponent.parse().unwrap_or(0_i32).clamp(-400, 400);
                    break;
                }
                _ => break,
            }
        }
        Self { place, digits, unit }
    }
}

/// One sample of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Its line in the file, from 1.
    pub line: usize,
    /// Seconds.
    pub time: f64,
    /// m/s².
    pub acceleration: f64,
}

impl<R: BufRead> Lines<R> {
    /// `units` stand above those of a header.
    pub fn new(input: R, units: Option<Units>) -> Self {
        Self {
            input,
            units,
            text: String::new(),
            line: 0,
            bytes: 0,
            previous: None,
            names: Vec::new(),
            more_columns: None,
        }
    }
    /// Bytes read so far: for a progress bar.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
    /// How the time of the last sample was printed.
    fn stamp(&self) -> Stamp {
        Stamp::of(&self.text, self.units.map_or(1.0, |units| units.time))
    }
    /// The next sample, or `None` at the end.
    ///
    /// # Errors
    /// [`Error::Line`] for a line that is not two finite numbers, an acceleration beyond 1e100 m/s², or a time that does
    /// not follow the one above; [`Error::NoUnits`] if neither caller nor header named the units; [`Error::Read`].
    pub fn sample(&mut self) -> Result<Option<Sample>, Error> {
        loop {
            self.text.clear();
            self.line += 1;
            let read = (&mut self.input).take(LONGEST).read_line(&mut self.text);
            let n = read.map_err(|error| match error.kind() {
                ErrorKind::InvalidData => Error::Line { line: self.line, what: "not text (UTF-8)".to_owned() },
                _ => Error::Read(error.to_string()),
            })? as u64;
            if n == 0 {
                return Ok(None);
            }
            if n == LONGEST && !self.text.ends_with('\n') {
                let what = format!("longer than {LONGEST} bytes, where two columns should be");
                return Err(Error::Line { line: self.line, what });
            }
            self.bytes += n;
            let text = self.text.trim().trim_start_matches('\u{feff}');
            if text.is_empty() || text.starts_with('#') {
                continue;
            }
            // A comma beside a semicolon is a decimal comma.
            let separator = [';', ',', '\t'].into_iter().find(|&c| text.contains(c));
            let columns = match separator {
                Some(c) => text.split(c).map(str::trim).collect::<Vec<_>>(),
                None => text.split_whitespace().collect(),
            };
            let bad = |what: String| Error::Line { line: self.line, what };
            let [first, second, more @ ..] = &columns[..] else {
                return Err(bad(format!("{text:?} is not two columns, time and acceleration")));
            };
            let numbers = [first, second].map(|text| text.parse::<f64>());
            let [Ok(time), Ok(acceleration)] = numbers else {
                if self.previous.is_none() && numbers.iter().all(Result::is_err) && decimal_comma(text).is_none() {
                    // A header, once: its units count unless the caller named some.
                    if self.units.is_none() {
                        self.units = Units::from_header([first, second]);
                        if self.units.is_none() {
                            return Err(Error::NoUnits);
                        }
                    }
                    self.names = columns.into_iter().map(|name| name.trim_matches('"').to_owned()).collect();
                    self.previous = Some(f64::NEG_INFINITY);
                    continue;
                }
                if let Some(number) = decimal_comma(text) {
                    let point = number.replace(',', ".");
                    return Err(bad(format!(
                        "{number:?} has a decimal comma; write {point}, with a point, in all lines"
                    )));
                }
                let wrong = if numbers[0].is_err() { first } else { second };
                return Err(bad(format!("{wrong:?} is not a number; a header may only be the first line")));
            };
            if self.more_columns.is_none() && more.iter().any(|column| !column.is_empty()) {
                let names = (0..columns.len()).map(|i| match self.names.get(i) {
                    Some(name) => format!("{} ({name})", i + 1),
                    None => (i + 1).to_string(),
                });
                self.more_columns = Some(Finding::Columns { line: self.line, names: names.collect() });
            }
            let units = self.units.ok_or(Error::NoUnits)?;
            for (name, text, value, unit) in
                [("time", *first, time, units.time), ("acceleration", *second, acceleration, units.acceleration)]
            {
                let what = if value.is_finite() { "is beyond the numbers in SI" } else { "is not finite" };
                if !(value * unit).is_finite() {
                    return Err(bad(format!("{name} {text} {what}")));
                }
            }
            let (time, acceleration) = (time * units.time, acceleration * units.acceleration);
            if acceleration.abs() > LARGEST {
                return Err(bad(format!("acceleration {second} is beyond {LARGEST:e} m/s²")));
            }
            if let Some(previous) = self.previous
                && time <= previous
            {
                return Err(bad(format!("time {time:?} s does not come after {previous:?} s, the line above")));
            }
            self.previous = Some(time);
            return Ok(Some(Sample { line: self.line, time, acceleration }));
        }
    }
}

/// The first number of a line that has decimal commas, if all its columns are numbers with them read as points.
fn decimal_comma(line: &str) -> Option<&str> {
    let separated = |c: char| c == ';' || c.is_whitespace();
    let columns = || line.split(separated).filter(|column| !column.is_empty());
    let number = |column: &str| column.matches(',').count() <= 1 && column.replace(',', ".").parse::<f64>().is_ok();
    (columns().count() > 1 && columns().all(number)).then(|| columns().find(|column| column.contains(','))).flatten()
}

/// A record in memory, in seconds and m/s².
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    survey: Survey,
    points: Vec<(f64, f64)>,
}

impl Record {
    /// Reads a record; `units` stand above those that a header names.
    ///
    /// # Examples
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Frequencies, Quantity, Record};
    /// let csv = "time [ms],acceleration [g]\n0,0\n1,100\n2,0\n3,0\n";
    /// let record = Record::read(csv.as_bytes(), None)?;
    /// assert_eq!(record.survey().samples, 4);
    /// let spectrum = record.spectrum(
    ///     &Frequencies::list(vec![100.0])?,
    ///     DampingRatio::from_quality_factor(10.0)?,
    ///     Quantity::AbsoluteAcceleration,
    /// );
    /// assert!(spectrum.maximax[0] > 500.0);
    ///
    /// let broken = Record::read("0,0\n1e-3,NaN\n".as_bytes(), Some(clatter_shock::Units::SI));
    /// assert_eq!(broken.unwrap_err().to_string(), "line 2: acceleration NaN is not finite");
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    /// # Errors
    /// As [`Lines::survey`].
    pub fn read(input: impl BufRead, units: Option<Units>) -> Result<Self, Error> {
        let mut points = Vec::new();
        let survey = Lines::new(input, units).survey(|s, _| points.push((s.time, s.acceleration)))?;
        Ok(Self { survey, points })
    }
    /// What was found.
    #[must_use]
    pub fn survey(&self) -> &Survey {
        &self.survey
    }
    /// Time (s) and acceleration (m/s²).
    #[must_use]
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }
    /// Shock response spectrum of the history that is linear between the samples: by the recursive filter where they
    /// are even, step by step where they are not.
    #[must_use]
    pub fn spectrum(&self, frequencies: &Frequencies, damping: DampingRatio, quantity: Quantity) -> Spectrum {
        let even = self.survey.step.and_then(|step| {
            let filter = SpectrumFilter::new(frequencies.clone(), damping, quantity, step).ok()?;
            let mut filter = filter.starting_at(self.survey.start).ok()?;
            let samples: Vec<f64> = self.points.iter().map(|p| p.1).collect();
            filter.push(&samples);
            filter.finish().ok()
        });
        even.or_else(|| {
            let (times, values): (Vec<f64>, Vec<f64>) = self.points.iter().copied().unzip();
            let mut filter = UnevenFilter::new(frequencies.clone(), damping, quantity);
            filter.push(&times, &values).ok()?;
            filter.finish().ok()
        })
        // What the filters refuse, no record has.
        .unwrap_or_else(|| Pulses::from_sorted(&self.points).spectrum(frequencies, damping, quantity))
    }
}

/// Spectrum of a record of any length in constant memory: a second pass after [`Lines::survey`] told whether it is
/// even.
///
/// Even records go through the recursive filter, others step by step, which takes a few times as long.
/// `progress` is told the bytes read so far, every few thousand samples.
///
/// # Errors
/// As [`Lines::sample`]; [`Error::Short`] for fewer than two samples.
pub fn stream<R: BufRead>(
    mut lines: Lines<R>,
    survey: &Survey,
    frequencies: &Frequencies,
    damping: DampingRatio,
    quantity: Quantity,
    mut progress: impl FnMut(u64),
) -> Result<Spectrum, Error> {
    let mut piece = Vec::with_capacity(PIECE);
    let mut pieces = |take: &mut dyn FnMut(&[Sample])| -> Result<(), Error> {
        loop {
            piece.clear();
            while piece.len() < PIECE
                && let Some(sample) = lines.sample()?
            {
                piece.push(sample);
            }
            take(&piece);
            progress(lines.bytes());
            if piece.len() < PIECE {
                return Ok(());
            }
        }
    };
    if let Some(step) = survey.step {
        let filter = SpectrumFilter::new(frequencies.clone(), damping, quantity, step)?;
        let mut filter = filter.starting_at(survey.start)?;
        let mut values = Vec::with_capacity(PIECE);
        pieces(&mut |piece| {
            values.clear();
            values.extend(piece.iter().map(|s| s.acceleration));
            filter.push(&values);
        })?;
        return filter.finish();
    }
    let mut filter = UnevenFilter::new(frequencies.clone(), damping, quantity);
    let (mut times, mut values, mut count) = (Vec::with_capacity(PIECE), Vec::with_capacity(PIECE), 0);
    let mut taken = Ok(());
    pieces(&mut |piece| {
        times.clear();
        values.clear();
        times.extend(piece.iter().map(|s| s.time));
        values.extend(piece.iter().map(|s| s.acceleration));
        count += piece.len();
        let result = filter.push(&times, &values);
        if taken.is_ok() {
            taken = result;
        }
    })?;
    taken?;
    if count < 2 {
        return Err(Error::Short(count));
    }
    filter.finish()
}

/// Samples read before they are filtered.
const PIECE: usize = 1 << 14;
