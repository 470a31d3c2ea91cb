//! Universal files: data set 58, functions at nodal degrees of freedom, as text or (58b) with binary numbers.
//!
//! Source: Universal File Dataset 58, Structural Dynamics Research Laboratory, University of Cincinnati.

use super::number::Number;
use super::{COMPLEX, TableBuilder, column, refuse};
use crate::unit::{Kind, Unit};
use crate::{Column, Error, Values};
use std::borrow::Cow;

pub(super) fn read(bytes: &[u8], table: &mut TableBuilder) -> Result<(), Error> {
    let mut lines = Lines { bytes, at: 0, line: 0 };
    // Blocks of one recorder share their times, and lie in a group with them.
    let (mut last_times, mut groups) = (None, 0_usize);
    while let Some(line) = lines.next() {
        if line.trim() != "-1" {
            continue;
        }
        let Some(head) = lines.next() else { break };
        let (set, binary) = (head.get(..6).unwrap_or(&head).trim(), head.get(6..7) == Some("b"));
        if set == "58"
            && let Some((times, mut values)) = block(&mut lines, binary.then_some(&head), table)?
        {
            if values.name.is_empty() {
                values.name = format!("channel {}", table.table.columns.len() + 1);
            }
            let is_even = times.is_none();
            if let Some(times) = times.filter(|times| last_times.as_ref() != Some(times)) {
                groups += 1;
                last_times = Some(times.clone());
                table.extend(&groups.to_string(), [times]);
            }
            table.extend(&if is_even { String::new() } else { groups.to_string() }, [values]);
        }
        // Other data sets: to the line that ends them. Heads and units are beside records.
        if !matches!(set, "58" | "151" | "164" | "") {
            table.leave_out(&format!("data set {set}"), "of the universal file; 58 and 58b hold records");
        }
        while lines.next().is_some_and(|line| line.trim() != "-1") {}
    }
    if table.table.columns.is_empty() && table.left_out.is_empty() {
        return Err(refuse("universal file: it has no data set 58 or 58b, which holds records"));
    }
    Ok(())
}

/// Lines of a file that may hold binary parts.
#[derive(Debug)]
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl<'a> Lines<'a> {
    /// The next line, in UTF-8 or Latin-1.
    fn next(&mut self) -> Option<Cow<'a, str>> {
        let rest = &self.bytes[self.at..];
        if rest.is_empty() {
            return None;
        }
        let end = rest.iter().position(|byte| *byte == b'\n');
        self.at += end.map_or(rest.len(), |end| end + 1);
        self.line += 1;
        let line = &rest[..end.unwrap_or(rest.len())];
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        Some(std::str::from_utf8(line).map_or_else(|_| line.iter().copied().map(char::from).collect(), Cow::from))
    }
    fn expect(&mut self) -> Result<Cow<'a, str>, Error> {
        self.next()
            .ok_or_else(|| refuse(format!("universal file: it ends after line {}, within a data set 58", self.line)))
    }
    fn fault(&self, fault: &str) -> Error {
        refuse(format!("universal file, line {}: {fault}", self.line))
    }
    fn take(&mut self, count: usize) -> Result<&'a [u8], Error> {
        let rest = &self.bytes[self.at..];
        let taken = rest.get(..count).ok_or_else(|| {
            self.fault(&format!(
                "{count} bytes of numbers should follow, but only {} are left; the file is cut short",
                rest.len()
            ))
        })?;
        self.at += count;
        Ok(taken)
    }
}

/// The header of a data set 58.
#[derive(Debug)]
struct Head {
    double: bool,
    even: bool,
    count: usize,
    start: f64,
    step: f64,
    /// Where it was measured: entity, node and direction.
    place: String,
    time: Axis,
    value: Axis,
}

/// Kind, label and unit of an axis.
#[derive(Debug)]
struct Axis {
    kind: u32,
    label: String,
    unit: Option<String>,
}

const TIME: u32 = 17;

/// The times of a data set, where they are uneven, and its values; none where it is left out.
fn block(
    lines: &mut Lines<'_>,
    binary: Option<&str>,
    table: &mut TableBuilder,
) -> Result<Option<(Option<Column>, Column)>, Error> {
    let head = match Head::read(lines)? {
        Ok(head) => head,
        Err((line, reason)) => {
            table.leave_out(&format!("data set with line {line}"), reason);
            // Its binary part may hold anything, a line of -1 too.
            if let Some(binary) = binary {
                lines.take(Binary::read(binary, lines)?.bytes)?;
            }
            return Ok(None);
        }
    };
    table.take(&[head.count, if head.even { 1 } else { 2 }])?;
    let (times, values) = match binary {
        Some(binary) => head.binary(lines, &Binary::read(binary, lines)?)?,
        None => head.text(lines)?,
    };
    Ok(Some(head.columns(times, values)))
}

impl Head {
    /// The eleven lines before the numbers; within, why the data set is no record of times and left out.
    fn read(lines: &mut Lines<'_>) -> Result<Result<Self, (usize, String)>, Error> {
        for _ in 0..5 {
            lines.expect()?;
        }
        let line = lines.expect()?;
        let function: u32 = line.get(..5).and_then(|text| text.trim().parse().ok()).unwrap_or(0);
        let place = place(&line);
        let form = &lines.expect()?;
        let fields: Option<Vec<f64>> = fixed(form, &[10, 10, 10, 13, 13, 13]).or_else(|| blanks(form));
        let &[kind, count, even, start, step, ..] = fields.as_deref().unwrap_or_default() else {
            return Err(lines.fault("six numbers should stand here: kind of values, how many, spacing, first, step, z"));
        };
        if !matches!(kind, 2.0 | 4.0 | 5.0 | 6.0) {
            return Err(lines.fault(&format!("values of kind {kind} are not known; 2 and 4 are real, 5 and 6 complex")));
        }
        if !matches!(even, 0.0 | 1.0) {
            return Err(lines.fault(&format!("a spacing of {even} is not known; 0 is uneven, 1 even")));
        }
        let even = even > 0.5;
        if !(0.0..=1e15).contains(&count) || count.fract() != 0.0 {
            return Err(lines.fault(&format!("{count} is no number of values")));
        }
        if even && (step <= 0.0 || !start.is_finite()) {
            return Err(lines.fault(&format!("even values need a step above 0, not {step}")));
        }
        let at = lines.line;
        let time = Axis::read(&lines.expect()?);
        let value = Axis::read(&lines.expect()?);
        for _ in 0..2 {
            lines.expect()?;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and within 0 to 1e15")]
        let count = count as usize;
        let double = matches!(kind, 4.0 | 6.0);
        let told = |fault: &str| Ok(Err((at, fault.to_owned())));
        if matches!(kind, 5.0 | 6.0) {
            return told(COMPLEX);
        }
        if !matches!(time.kind, 0 | TIME) {
            return told(&format!(
                "the abscissa is of kind {}, which is no time (17): a spectrum is no record",
                time.kind
            ));
        }
        // Where the abscissa is not told, the kind of function is: general or a response over time.
        if time.kind == 0 && function > 1 {
            return told(&format!("functions of kind {function} are no responses over time: a spectrum is no record"));
        }
        let Some(factor) = (if even { time.seconds() } else { Some(1.0) }) else {
            return told(&format!(
                "the unit {:?} of the abscissa is none of time, such as s, ms or us",
                time.unit.unwrap_or_default()
            ));
        };
        let (start, step) = (start * factor, step * factor);
        Ok(Ok(Self { double, even, count, start, step, place, time, value }))
    }

    /// Times, where they are uneven, and values from lines of fixed fields.
    fn text(&self, lines: &mut Lines<'_>) -> Result<(Vec<f64>, Vec<f64>), Error> {
        let widths: &[usize] = match (self.double, self.even) {
            (false, _) => &[13; 6],
            (true, true) => &[20; 4],
            (true, false) => &[13, 20, 13, 20],
        };
        let (mut times, mut values) = (Vec::new(), Vec::new());
        while values.len() < self.count {
            let line = &lines.expect()?;
            let numbers = fixed(line, widths).or_else(|| blanks(line)).filter(|numbers| !numbers.is_empty());
            let Some(mut numbers) = numbers else {
                let missing = self.count - values.len();
                return Err(lines.fault(&format!("numbers should stand here, {missing} more, not {:?}", shown(line))));
            };
            numbers.truncate((self.count - values.len()) * if self.even { 1 } else { 2 });
            if self.even {
                values.extend(numbers);
            } else if numbers.len() % 2 == 0 {
                times.extend(numbers.iter().step_by(2));
                values.extend(numbers.iter().skip(1).step_by(2));
            } else {
                return Err(lines.fault("times and values should stand in pairs"));
            }
        }
        Ok((times, values))
    }

    /// The same from a binary part.
    fn binary(&self, lines: &mut Lines<'_>, binary: &Binary) -> Result<(Vec<f64>, Vec<f64>), Error> {
        if !binary.ieee {
            return Err(lines.fault("binary numbers of DEC or IBM machines are not read; IEEE 754 is"));
        }
        let number = if self.double { Number::F64 } else { Number::F32 };
        let size = number.size();
        let pairs = self.count.checked_mul(if self.even { size } else { 2 * size });
        // The data set has single times beside double values; some programs write both double.
        let mixed = self.count.checked_mul(4 + 8).filter(|_| self.double && !self.even);
        let told = Some(binary.bytes).filter(|bytes| *bytes > 0);
        let bytes = match (told, pairs) {
            (None, Some(pairs)) => mixed.unwrap_or(pairs),
            (Some(told), _) if Some(told) == pairs || Some(told) == mixed => told,
            (told, _) => {
                let told = told.unwrap_or_default();
                return Err(lines.fault(&format!("{told} bytes do not hold {} values of this kind", self.count)));
            }
        };
        let data = lines.take(bytes)?;
        let read =
            |number: Number, offset, stride| match number.placed(data, binary.big_endian, offset, stride, self.count) {
                Values::Float(values) => values,
                Values::Integer(_) => Vec::new(),
            };
        Ok(if self.even {
            (Vec::new(), read(number, 0, size))
        } else if Some(bytes) == mixed {
            (read(Number::F32, 0, 12), read(Number::F64, 4, 12))
        } else {
            (read(number, 0, 2 * size), read(number, size, 2 * size))
        })
    }

    fn columns(self, times: Vec<f64>, values: Vec<f64>) -> (Option<Column>, Column) {
        let name = joined([self.value.name(), &self.place], " ");
        let mut values = column(name, self.value.unit, Values::Float(values));
        if self.even {
            values.sampled_s = Some([self.start, self.step]);
            return (None, values);
        }
        // Its kind says that it is a time; in seconds unless a unit is told.
        let is_named = self.time.label.to_lowercase().contains("time");
        let name = if is_named { self.time.label } else { "time".to_owned() };
        (Some(column(name, self.time.unit.or_else(|| Some("s".to_owned())), Values::Float(times))), values)
    }
}

impl Axis {
    /// From a line of (I10,3I5,2(1X,20A1)).
    fn read(line: &str) -> Self {
        let word = |from: usize, to: usize| {
            let word: String = line.chars().skip(from).take(to - from).collect();
            if word.trim().eq_ignore_ascii_case("none") { String::new() } else { word.trim().to_owned() }
        };
        let unit = word(47, 67);
        Self { kind: word(0, 10).parse().unwrap_or(0), label: word(26, 46), unit: (!unit.is_empty()).then_some(unit) }
    }
    /// Its label, or what its kind is.
    fn name(&self) -> &str {
        match self.kind {
            _ if !self.label.is_empty() => self.label.as_str(),
            8 => "displacement",
            9 | 13 => "force",
            11 => "velocity",
            12 => "acceleration",
            _ => "",
        }
    }
    /// Seconds of its unit. Data sets are in SI where they do not say otherwise.
    fn seconds(&self) -> Option<f64> {
        let Some(unit) = &self.unit else { return Some(1.0) };
        Unit::of_kind(unit, Kind::Time).map(|unit| unit.size)
    }
}

/// The binary part of a data set 58b, by its first line.
#[derive(Debug)]
struct Binary {
    big_endian: bool,
    ieee: bool,
    bytes: usize,
}

impl Binary {
    /// From a line of (I6,1A1,I6,I6,I12,I12,…): byte order, kind of floats, lines of the header, bytes.
    fn read(line: &str, lines: &Lines<'_>) -> Result<Self, Error> {
        let fields: Vec<usize> = line.get(7..).map(blanks_of).unwrap_or_default();
        match *fields.as_slice() {
            [order @ (1 | 2), floats, _, bytes, ..] => Ok(Self { big_endian: order == 2, ieee: floats == 2, bytes }),
            _ => {
                Err(lines.fault("the head of the data set 58b should tell byte order, kind of floats, lines and bytes"))
            }
        }
    }
}

/// Entity, node and direction of the response, from a line of (2(I5,I10),2(1X,10A1,I10,I4)).
fn place(line: &str) -> String {
    let field = |from: usize, to: usize| line.get(from..to.min(line.len())).unwrap_or_default().trim();
    let entity = field(31, 41);
    let node = field(41, 51);
    let direction: i32 = field(51, 55).parse().unwrap_or(0);
    let axis = match direction.abs() {
        axis @ 1..=3 => ["X", "Y", "Z"][axis.unsigned_abs() as usize - 1],
        axis @ 4..=6 => ["RX", "RY", "RZ"][axis.unsigned_abs() as usize - 4],
        _ => "",
    };
    let sign = match (axis, direction) {
        ("", _) => "",
        (_, ..0) => "-",
        _ => "+",
    };
    let entity = if entity.eq_ignore_ascii_case("none") { "" } else { entity };
    let node = if node == "0" { "" } else { node };
    format!("{}{sign}{axis}", joined([entity, node], ":"))
}

/// Two parts of a name, of which one may be empty.
fn joined([one, other]: [&str; 2], between: &str) -> String {
    if one.is_empty() || other.is_empty() { format!("{one}{other}") } else { format!("{one}{between}{other}") }
}

/// Numbers of fields of these widths, to the end of the line; none where one of them is no number.
fn fixed(line: &str, widths: &[usize]) -> Option<Vec<f64>> {
    let mut rest = line.trim_end();
    let mut numbers = Vec::new();
    for width in widths {
        if rest.is_empty() {
            break;
        }
        let (field, after) = rest.split_at_checked((*width).min(rest.len()))?;
        // A blank within tells that the fields stand elsewhere.
        numbers.push(number(field.trim())?);
        rest = after;
    }
    rest.is_empty().then_some(numbers)
}

/// Numbers that blanks set apart.
fn blanks(line: &str) -> Option<Vec<f64>> {
    line.split_ascii_whitespace().map(number).collect()
}

fn blanks_of(line: &str) -> Vec<usize> {
    line.split_ascii_whitespace().map_while(|word| word.parse().ok()).collect()
}

/// A number of Fortran, which may have D for the exponent, or nothing before its sign: `1.5D+00`, `1.5-100`.
fn number(word: &str) -> Option<f64> {
    let number = word.parse().ok().or_else(|| {
        let mut plain = word.replace(['D', 'd'], "E");
        if !plain.contains(['E', 'e'])
            && let Some(sign) = plain.rfind(['+', '-']).filter(|place| *place > 0)
        {
            plain.insert(sign, 'E');
        }
        plain.parse().ok()
    });
    number.filter(|_| word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)))
}

/// The beginning of a line, for a message.
fn shown(line: &str) -> String {
    line.chars().take(40).collect()
}
