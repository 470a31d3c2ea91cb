//! LabVIEW measurement files (.lvm): a heading, then segments, each with a heading of its own and rows of numbers.
//!
//! Source: "Specification for the LabVIEW Measurement File (.lvm)", National Instruments. `***End_of_Header***` says where data
//! begin; what the numbers are is told above, and nothing of it is guessed.

mod segment;

use std::collections::HashMap;

use clatter_shock::samples::float;

use super::Rows;
use super::cells::Form;
use super::encoding::Letters;
use crate::roles::Roles;
use crate::{Error, Options};

const BEGINS: &[u8] = b"LabVIEW Measurement";
const END: &str = "***End_of_Header***";
/// Times that follow on others are a step after them, to this share of a step.
const FOLLOWS: f64 = 0.01;

/// Returns whether a text is such a file.
pub(super) fn is_labview(begin: &[u8]) -> bool {
    begin.starts_with(BEGINS)
}

/// The channels of such a file, by their times.
///
/// # Errors
/// [`Error::File`] for a file without data, or with columns that its heading does not tell of, [`Error::Records`] where one of
/// several records has to be chosen.
pub(super) fn read(bytes: &[u8], letters: Letters, options: &Options) -> Result<Vec<(Rows, Roles)>, Error> {
    let lines: Vec<&[u8]> = bytes.split_inclusive(|byte| *byte == b'\n').collect();
    let file = File::of(&lines, letters)?;
    let mut records = file.records(&lines)?;
    let number = match options.record {
        Some(number) => number,
        None if records.len() > 1 => {
            let told: Vec<String> = records.iter().map(Segment::told).collect();
            return Err(Error::Records(format!(
                "the file holds {} records that do not follow one on another: {}; --record=1 reads the first",
                records.len(),
                told.join("; ")
            )));
        }
        None => 1,
    };
    if !(1..=records.len()).contains(&number) {
        return Err(Error::no_record(number, records.len()));
    }
    records.swap_remove(number - 1).read(&file, &lines, options)
}

/// The heading of the file, and its segments.
#[derive(Debug)]
struct File {
    form: Form,
    letters: Letters,
    columns: Columns,
    segments: Vec<Segment>,
}

/// Columns of times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Columns {
    /// None; the first column is empty.
    No,
    /// The first.
    One,
    /// One before each channel.
    Multi,
}

/// A segment, from its heading.
#[derive(Debug, Clone, PartialEq)]
struct Segment {
    /// Lines of numbers: from here on, and behind the last.
    lines: Vec<(usize, usize)>,
    names: Vec<String>,
    channels: Vec<Channel>,
}

/// A channel as its segment tells of it.
#[derive(Debug, Clone, PartialEq)]
struct Channel {
    samples: Option<usize>,
    unit: String,
    /// Tells whether its abscissa is a time.
    is_timed: bool,
    /// Date and time of day, in seconds.
    date_s: Option<f64>,
    x0: Option<f64>,
    delta: Option<f64>,
}

fn is_comment(name: &str) -> bool {
    name.eq_ignore_ascii_case("comment")
}

fn is_blank(line: &[u8]) -> bool {
    line.iter().all(u8::is_ascii_whitespace)
}

impl File {
    fn of(lines: &[&[u8]], letters: Letters) -> Result<Self, Error> {
        let end = lines.iter().position(|line| line.starts_with(END.as_bytes())).ok_or_else(|| {
            Error::File(format!("the heading of this LabVIEW measurement does not end: there is no line {END}"))
        })?;
        let value = |key: &str| {
            let line = lines[..end].iter().map(|line| letters.text(line)).find(|line| {
                line.strip_prefix(key).is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
            })?;
            Some(line[key.len()..].trim_matches(['\r', '\n', '\t', ' ']).to_owned())
        };
        let separator = match value("Separator").as_deref().map(|name| name.trim_matches([',', ';'])) {
            Some("Comma") => b',',
            Some("Semicolon") => b';',
            _ => b'\t',
        };
        let point = match value("Decimal_Separator").as_deref() {
            Some(",") => b',',
            _ => b'.',
        };
        let form = Form::new(Some(separator), point);
        let word = value("X_Columns").unwrap_or_default();
        let columns = match word.trim_matches([',', ';']).to_ascii_lowercase().as_str() {
            "no" => Columns::No,
            "multi" => Columns::Multi,
            "one" | "" => Columns::One,
            other => {
                return Err(Error::File(format!("X_Columns is '{other}' in the heading; No, One and Multi are known")));
            }
        };
        let mut file = Self { form, letters, columns, segments: Vec::new() };
        let mut at = end + 1;
        while let Some(segment) = file.segment(lines, &mut at)? {
            file.segments.push(segment);
        }
        if file.segments.is_empty() {
            return Err(Error::File("the file has a heading of LabVIEW, and no data below it".to_owned()));
        }
        Ok(file)
    }

    /// The cells of a line.
    fn cells(&self, line: &[u8]) -> Vec<String> {
        let text = self.letters.text(line);
        self.form.cells(text.trim_end_matches(['\r', '\n'])).into_iter().map(std::borrow::Cow::into_owned).collect()
    }

    /// The next segment from a line on.
    fn segment(&self, lines: &[&[u8]], at: &mut usize) -> Result<Option<Segment>, Error> {
        while lines.get(*at).is_some_and(|line| is_blank(line)) {
            *at += 1;
        }
        let begin = *at;
        if begin == lines.len() {
            return Ok(None);
        }
        let end = (begin..lines.len()).find(|line| lines[*line].starts_with(END.as_bytes())).ok_or_else(|| {
            let line = self.letters.text(lines[begin]);
            Error::File(format!("line {}: '{}' begins no segment: no line {END} follows", begin + 1, line.trim()))
        })?;
        let names = lines.get(end + 1).map(|line| self.cells(line)).unwrap_or_default();
        let named = names.iter().any(|name| !name.is_empty()) && !names.iter().all(|name| self.form.is_data(name));
        let first = end + 1 + usize::from(named);
        let last = (first..lines.len()).find(|line| is_blank(lines[*line])).unwrap_or(lines.len());
        *at = last;
        let width =
            if named { names.len() } else { (first..last).map(|i| self.cells(lines[i]).len()).next().unwrap_or(0) };
        // Channels with times of their own take two columns.
        let each = if self.columns == Columns::Multi { 2 } else { 1 };
        let most = width / each;
        let told: HashMap<String, Vec<String>> = lines[begin..end]
            .iter()
            .map(|line| self.cells(line))
            .map(|mut cells| (std::mem::take(&mut cells[0]), cells.split_off(1)))
            .collect();
        let channels = told.get("Channels").and_then(|cells| cells.first()?.parse::<usize>().ok());
        let comments = usize::from(names.last().is_some_and(|name| is_comment(name)));
        let beside = if each == 2 { comments } else { 1 + comments };
        let count = channels.or(Some(width.saturating_sub(beside) / each).filter(|_| !told.contains_key("Channels")));
        let Some(count) = count.filter(|count| (1..=most.max(1)).contains(count)) else {
            return Err(Error::File(format!(
                "line {}: a segment of {} channels does not go with {width} columns below",
                begin + 1,
                count.map_or("unknown".to_owned(), |count| count.to_string())
            )));
        };
        // The settings of each channel stand in the column of the channel or, by some writers, side by side.
        let told: HashMap<String, Vec<String>> = told
            .into_iter()
            .map(|(name, mut cells)| {
                if each == 2 && cells.iter().filter(|cell| !cell.is_empty()).count() <= count {
                    cells.retain(|cell| !cell.is_empty());
                } else if each == 2 {
                    cells = cells.into_iter().step_by(2).collect();
                }
                (name, cells)
            })
            .collect();
        let value = |name: &str, channel: usize| {
            told.get(name).and_then(|cells| cells.get(channel)).filter(|cell| !cell.is_empty()).cloned()
        };
        let number = |name: &str, channel: usize| {
            let Some(text) = value(name, channel) else { return Ok(None) };
            let number =
                self.form.number(&text).map(crate::decimal::Decimal::float).filter(|number| number.is_finite());
            number.map(Some).ok_or_else(|| {
                Error::File(format!(
                    "{name} is '{text}' for channel {} in the segment at line {}",
                    channel + 1,
                    begin + 1
                ))
            })
        };
        let channel = |channel: usize| {
            let date_s =
                value("Date", channel).zip(value("Time", channel)).and_then(|(date, time)| date_s(&date, &time));
            Ok(Channel {
                samples: value("Samples", channel).and_then(|text| text.parse().ok()),
                unit: value("Y_Unit_Label", channel).unwrap_or_default(),
                is_timed: value("X_Dimension", channel).is_none_or(|dimension| dimension.eq_ignore_ascii_case("time")),
                date_s,
                x0: number("X0", channel)?,
                delta: number("Delta_X", channel)?,
            })
        };
        let channels = (0..count).map(channel).collect::<Result<_, Error>>()?;
        let names = if named { names } else { vec![String::new(); width] };
        Ok(Some(Segment { lines: vec![(first, last)], names, channels }))
    }

    /// Passes over lines up to one: headings, and rows of other records.
    fn pass_over(&self, rows: &mut Rows, lines: &[&[u8]], end: usize) {
        let mut at = rows.line();
        for (first, last) in self.segments.iter().flat_map(|segment| &segment.lines) {
            let [first, last] = [first, last].map(|line| (*line).clamp(at, end));
            rows.skip_heading(&lines[at..first]);
            rows.skip_rows(&lines[first..last]);
            at = last;
        }
        rows.skip_heading(&lines[at..end]);
    }

    /// The records: segments, joined where one follows on the other, or parts of one segment that follow without a heading.
    fn records(&self, lines: &[&[u8]]) -> Result<Vec<Segment>, Error> {
        let mut records: Vec<Segment> = Vec::new();
        for segment in &self.segments {
            for segment in self.parted(segment, lines)? {
                match records.last_mut().filter(|last| self.follows(last, &segment, lines)) {
                    Some(last) => last.append(&segment),
                    None => records.push(segment),
                }
            }
        }
        Ok(records)
    }

    /// A segment whose rows are some times what `Samples` says holds as many parts, of which only the first has a heading: one
    /// record where its rows have times.
    fn parted(&self, segment: &Segment, lines: &[&[u8]]) -> Result<Vec<Segment>, Error> {
        let (first, last) = segment.lines[0];
        let rows = last - first;
        let most = segment.channels.iter().filter_map(|channel| channel.samples).max();
        let Some(samples) = most.filter(|most| self.columns == Columns::No && *most < rows) else {
            return Ok(vec![segment.clone()]);
        };
        if samples == 0
            || !rows.is_multiple_of(samples)
            || lines[last - 1].last() != Some(&b'\n') && rows % samples != 0
        {
            return Err(Error::File(format!(
                "line {}: {rows} rows stand where Samples says {samples}: what the others are is not told",
                first + 1
            )));
        }
        let part = |begin: usize| Segment { lines: vec![(begin, begin + samples)], ..segment.clone() };
        let mut parts: Vec<Segment> = (first..last).step_by(samples).map(part).collect();
        // When they began is not told.
        for part in &mut parts[1..] {
            part.channels.iter_mut().for_each(|channel| channel.date_s = None);
        }
        Ok(parts)
    }

    /// Returns whether a segment goes on where another ends, with the same channels.
    fn follows(&self, before: &Segment, after: &Segment, lines: &[&[u8]]) -> bool {
        let rows = before.rows();
        let time = |line: usize, column: usize| {
            let cells = self.cells(lines[line]);
            cells.get(column).and_then(|cell| self.form.number(cell)).map(crate::decimal::Decimal::float)
        };
        let same = |(k, (one, other)): (usize, (&Channel, &Channel))| {
            let step = one.delta.filter(|step| *step > 0.0 && one.delta == other.delta)?;
            let gap = if self.columns == Columns::No {
                let begins = one.x0? + one.date_s.zip(other.date_s).map_or(f64::NAN, |(a, b)| a - b);
                other.x0? - begins - step * float(rows)
            } else {
                let column = if self.columns == Columns::Multi { 2 * k } else { 0 };
                let last = before.lines.last().map(|(_, last)| last - 1)?;
                time(after.lines[0].0, column)? - time(last, column)? - step
            };
            Some(one.unit == other.unit && gap.abs() <= FOLLOWS * step)
        };
        let channels = before.channels.iter().zip(&after.channels).enumerate();
        before.names == after.names
            && before.channels.len() == after.channels.len()
            && channels.map(same).all(|same| same == Some(true))
    }
}

/// Seconds of a date, `2023/01/02`, and a time of day with any mark of decimals and number of digits.
fn date_s(date: &str, time: &str) -> Option<f64> {
    let seconds = |text: &str| crate::moment::seconds(text, None).map(crate::decimal::Decimal::float);
    let (clock, fraction) = time.split_once([',', '.']).unwrap_or((time, "0"));
    let fraction: f64 = format!("0.{fraction}").parse().ok()?;
    Some(seconds(date)? + seconds(clock)? + fraction)
}
