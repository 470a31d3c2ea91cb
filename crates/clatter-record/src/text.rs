//! Records as text: whatever loggers and programs write.

mod block;
mod cells;
mod cut;
mod digits;
mod encoding;
mod head;
mod header;
mod labview;
mod layout;
mod list;
mod records;
mod rows;
mod sensors;
mod series;

use std::borrow::Cow;
use std::io::Read;

use crate::error::Bad;
use crate::heading::Heading;
use crate::roles::{Preview, Roles};
use crate::{At, Error, Options};
use encoding::Letters;
use layout::Layout;
pub use list::{Cell, names_columns, read_list};
pub(crate) use rows::Rows;
use rows::Shape;

/// Bytes that are read at a time, and before it is known what a file holds.
const BLOCK: usize = 1 << 20;
/// Lines, and bytes of them, that may be above the numbers.
const HEAD: (usize, usize) = (2000, 1 << 18);
/// A line has no more bytes.
const LONGEST: usize = 1 << 18;
/// Rows that show what columns without names are.
pub(crate) const SHOWN: usize = 8;

/// How the bytes of a text become others.
type Decode = fn(&[u8]) -> Vec<u8>;

/// Returns what makes a text one of UTF-8, or of any other bytes with ASCII below 128, whose lines end with a line feed.
pub(crate) fn decoded(first: &[u8]) -> Option<Decode> {
    fn little(bytes: &[u8]) -> Vec<u8> {
        utf16(bytes, u16::from_le_bytes)
    }
    fn big(bytes: &[u8]) -> Vec<u8> {
        utf16(bytes, u16::from_be_bytes)
    }
    fn returns(bytes: &[u8]) -> Vec<u8> {
        bytes.iter().map(|byte| if *byte == b'\r' { b'\n' } else { *byte }).collect()
    }
    let zeros = |odd: usize| first.iter().skip(odd).step_by(2).take(32).filter(|byte| **byte == 0).count();
    match first {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => None,
        [0xff, 0xfe, ..] => Some(little),
        [0xfe, 0xff, ..] => Some(big),
        _ if zeros(1) > 24 && zeros(0) == 0 => Some(little),
        _ if zeros(0) > 24 && zeros(1) == 0 => Some(big),
        _ if first.contains(&b'\r') && !first.contains(&b'\n') => Some(returns),
        _ => None,
    }
}

fn utf16(bytes: &[u8], word: fn([u8; 2]) -> u16) -> Vec<u8> {
    let words = bytes.chunks_exact(2).map(|pair| word([pair[0], pair[1]]));
    let text: String = char::decode_utf16(words).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    text.replace("\r\n", "\n").replace('\r', "\n").into_bytes()
}

/// Returns what a message shows of a text from outside: its beginning, without what a terminal would act on.
fn visible(text: &str) -> String {
    const SHOWN: usize = 40;
    let plain = |c: char| if c.is_control() { '□' } else { c };
    let shown: String = text.chars().take(SHOWN).map(plain).collect();
    if text.chars().count() > SHOWN { format!("{shown}…") } else { shown }
}

/// Reads a text whose beginning is there already, handing on how many bytes are read: its channels by their times.
pub(crate) fn read(
    begin: Vec<u8>,
    rest: &mut dyn Read,
    options: &Options,
    progress: &mut dyn FnMut(u64),
) -> Result<Vec<(Rows, Roles)>, Error> {
    if matches!(begin[..], [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..]) {
        return Err(Error::File("this is a text in UTF-32: save it as UTF-8".to_owned()));
    }
    let mut begin = match begin.strip_prefix("\u{feff}".as_bytes()) {
        Some(text) => text.to_vec(),
        None => begin,
    };
    let letters = Letters::of(&begin[..begin.len().min(HEAD.1)]);
    if labview::is_labview(&begin) {
        to_end(&mut begin, rest, options)?;
        progress(begin.len() as u64);
        return labview::read(&begin, letters, options);
    }
    let mut hidden = 0;
    if let Some(number) = options.record {
        to_end(&mut begin, rest, options)?;
        (begin, hidden) = records::only(&begin, number)?;
    }
    let lines = first_lines(&begin, letters)?;
    if let Some(series) = series::of(&lines) {
        to_end(&mut begin, rest, options)?;
        progress(begin.len() as u64);
        return Ok(vec![series.read(&begin, options)?]);
    }
    let lines = head::join_quotes(lines);
    let layout = Layout::of(&lines)?;
    let first = layout.begin;
    let (shape, parts) = shape(layout, &lines, letters, options)?;
    few_times(parts.len())?;
    let mut parts: Vec<(Rows, Roles)> =
        parts.into_iter().map(|roles| (Rows::new(shape.clone(), &roles, options), roles)).collect();
    for (rows, _) in &mut parts {
        rows.skip_heading(&lines[..first]);
    }
    let at = begin.split_inclusive(|byte| *byte == b'\n').take(first).map(<[u8]>::len).sum::<usize>();
    take_all(&mut parts, begin, at, rest, progress)?;
    for (rows, _) in &mut parts {
        rows.of_other_records(hidden);
        rows.close()?;
    }
    Ok(parts)
}

/// Takes in all lines of an input, of which the beginning is there already, from a place in it on.
fn take_all(
    parts: &mut [(Rows, Roles)],
    begin: Vec<u8>,
    mut at: usize,
    rest: &mut dyn Read,
    progress: &mut dyn FnMut(u64),
) -> Result<(), Error> {
    let mut bytes = begin.len() as u64;
    let (mut buffer, mut last) = (begin, Vec::new());
    loop {
        let begin = at;
        for (rows, _) in &mut *parts {
            at = begin + rows.take(&buffer[begin..])?;
        }
        progress(bytes);
        last = cut::last_lines(&buffer[begin..at]).map_or(last, <[u8]>::to_vec);
        buffer.drain(..at);
        at = 0;
        if buffer.len() > LONGEST {
            return Err(Error::File(format!(
                "line {} is longer than {LONGEST} bytes: this is no text of columns",
                parts[0].0.line() + 1
            )));
        }
        let read = read_block(rest, &mut buffer)?;
        bytes += read as u64;
        if read == 0 {
            break;
        }
    }
    for (rows, _) in &mut *parts {
        rows.take_end(&last, &buffer)?;
    }
    Ok(())
}

/// Refuses more times than a text may have: each is one more look at every line.
fn few_times(count: usize) -> Result<(), Error> {
    const MOST: usize = 100;
    if count <= MOST {
        return Ok(());
    }
    Err(Error::Columns(format!("the channels have more than {MOST} times of their own: take some of the channels")))
}

/// Returns the form of the lines of numbers, and what their columns are, by the first of them: each time with its channels.
fn shape(
    mut layout: Layout,
    lines: &[String],
    letters: Letters,
    options: &Options,
) -> Result<(Shape, Vec<Roles>), Error> {
    let all: Vec<Vec<Cow<'_, str>>> = lines[layout.begin..]
        .iter()
        .filter(|line| !line.trim().is_empty() && !layout::uncommented(line).1)
        .map(|line| layout.form.cells(line))
        .collect();
    layout.form.order = all.iter().flatten().find_map(|cell| crate::moment::order(cell));
    let form = layout.form;
    let words = sensors::words(&layout, &all, options)?;
    let is_of = |row: &&Vec<Cow<'_, str>>| {
        words.iter().all(|word| !word.tells || row.get(word.column).is_some_and(|cell| **cell == *word.expected))
    };
    let data: Vec<&Vec<Cow<'_, str>>> = all.iter().filter(is_of).take(SHOWN).collect();
    // Times of day are in seconds, whatever their heading says.
    for (column, heading) in layout.headings.iter_mut().enumerate() {
        if data
            .first()
            .and_then(|row| row.get(column))
            .is_some_and(|cell| crate::moment::seconds(cell, form.order).is_some())
        {
            // By a heading such as [hh:mm] they are minutes and no seconds.
            let cell = heading.cell.to_lowercase();
            let in_minutes = (cell.contains(":mm") || cell.contains(":min")) && !cell.contains(":ss");
            let pairs = data.iter().all(|row| row.get(column).is_some_and(|cell| cell.matches(':').count() == 1));
            *heading = heading.clone().with_unit(if in_minutes && pairs { "min" } else { "s" });
        }
    }
    sensors::units_beside(&mut layout, &words);
    let number = |cell: &Cow<'_, str>| {
        form.number(cell).or_else(|| Some(form.measured(cell)?.0)).map_or(f64::NAN, crate::decimal::Decimal::float)
    };
    // A rate that is told stands for times that are not there.
    let told_s = layout.told_s.map(|(step_s, _)| [layout.header.start_s.map_or(0.0, |(start_s, _)| start_s), step_s]);
    let named = layout.named.then(|| lines[..layout.begin].iter().rev().find(|line| !line.trim().is_empty())).flatten();
    let mut seen = Preview {
        headings: layout.headings,
        named: layout.named,
        sampled: layout.sampled_s.is_some() || told_s.is_some(),
        rows: data.iter().map(|row| row.iter().map(number).collect()).collect(),
        cells: data.first().map_or(Vec::new(), |row| row.iter().map(|cell| (**cell).to_owned()).collect()),
    };
    if let Some((step_s, _)) = layout.told_s {
        seen.take_unit_of_time(step_s);
    }
    if !seen.named {
        series::refuse_lines(&seen.rows, &all, form)?;
    }
    let mut parts = seen.by_time(options).map_err(|error| match (layout.unclear, &error) {
        (Some(line), Error::Columns(_)) => Error::Columns(format!(
            "line {} tells '{}', whose point may be one of thousands: give the sample rate; {error}",
            line + 1,
            visible(lines[line].trim())
        )),
        _ => error,
    })?;
    let fraction = if options.time.is_none() { seen.fraction() } else { None };
    let is_one = |whole: usize| matches!(&parts[..], [roles] if roles.time == Some((whole, 1.0)));
    let fraction = fraction.filter(|(whole, ..)| is_one(*whole));
    if let Some((_, column, _)) = fraction {
        let called = seen.called(column);
        for roles in &mut parts {
            roles.left_out.retain(|other| *other != called);
            "time".clone_into(&mut roles.columns[column].1);
        }
    }
    let date = parts.iter().find_map(|roles| sensors::date(&seen, roles, form));
    let beside = words
        .iter()
        .map(|word| (word.column, if word.tells { "sensor" } else { "unit" }))
        .chain(date.map(|date| (date, "date")));
    for (column, what) in beside {
        let called = seen.called(column);
        for roles in &mut parts {
            roles.left_out.retain(|other| *other != called);
            what.clone_into(&mut roles.columns[column].1);
        }
    }
    let shape = Shape {
        form,
        letters,
        columns: seen.headings.len(),
        sampled_s: layout.sampled_s.or(told_s),
        told: layout.told_s,
        header: layout.header,
        heading: named.map(|line| line.trim().to_owned()),
        fraction: fraction.map(|(_, column, size)| (column, size)),
        by_other: !options.accelerations.is_empty(),
        count: layout.count,
        measured: layout.measured,
        date,
        words,
    };
    Ok((shape, parts))
}

/// All of an input, as far as it may hold what is read at most.
pub(crate) fn to_end(begin: &mut Vec<u8>, rest: &mut dyn Read, options: &Options) -> Result<(), Error> {
    // No number takes more bytes, in any text or container.
    let most = 64_u64.saturating_mul(options.most_values as u64);
    rest.take(most).read_to_end(begin).map(|_| ()).map_err(|error| Error::Read(error.to_string()))
}

/// The lines that a text begins with, as far as they may tell what it is.
fn first_lines(begin: &[u8], letters: Letters) -> Result<Vec<String>, Error> {
    let lines: Vec<String> = begin[..begin.len().min(HEAD.1)]
        .split(|byte| *byte == b'\n')
        .take(HEAD.0)
        .map(|line| letters.text(line))
        .collect();
    match begin.len() > HEAD.1 && lines.len() < HEAD.0 {
        // The last one may be cut.
        true if lines.len() == 1 => {
            Err(Error::File(format!("the first line is longer than {} bytes: this is no text of columns", HEAD.1)))
        }
        true => Ok(lines[..lines.len() - 1].to_vec()),
        false => Ok(lines),
    }
}

/// Reads a block behind what a buffer holds, or less where the input ends, and says how many bytes these are.
pub(crate) fn read_block(input: &mut dyn Read, buffer: &mut Vec<u8>) -> Result<usize, Error> {
    buffer.reserve(BLOCK);
    input.take(BLOCK as u64).read_to_end(buffer).map_err(|error| Error::Read(error.to_string()))
}

/// All of a small text: its headings, and its rows of numbers.
pub(crate) fn table(input: impl Read, most: usize) -> Result<(Vec<Heading>, Vec<Vec<f64>>), Error> {
    let mut bytes = Vec::new();
    input.take(HEAD.1 as u64).read_to_end(&mut bytes).map_err(|error| Error::Read(error.to_string()))?;
    let letters = Letters::of(&bytes);
    let text = match decoded(&bytes) {
        Some(decode) => letters.text(&decode(&bytes)),
        None => letters.text(&bytes),
    };
    let lines: Vec<String> = text.trim_start_matches('\u{feff}').lines().map(str::to_owned).collect();
    let lines = head::join_quotes(lines);
    if bytes.len() == HEAD.1 || lines.len() > most {
        return Err(Error::Many(most));
    }
    let Layout { form, begin, headings, .. } = Layout::of(&lines)?;
    let (mut rows, mut bad) = (Vec::new(), Bad::default());
    for (i, line) in lines.iter().enumerate().skip(begin) {
        if line.trim().is_empty() || layout::uncommented(line).1 {
            continue;
        }
        let cells = form.cells(line);
        let wrong = |column: usize| cells.get(column).is_none_or(|cell| form.number(cell).is_none());
        match (0..headings.len()).find(|column| wrong(*column)) {
            None => rows.push(cells.iter().filter_map(|cell| Some(form.number(cell)?.float())).collect()),
            Some(column) => {
                let cell = cells.get(column).map_or("", |cell| cell);
                bad.add(At::Line(i + 1), || format!("'{cell}' in column {} is not a number", column + 1));
            }
        }
    }
    if bad.count > 0 { Err(Error::Lines(bad)) } else { Ok((headings, rows)) }
}
