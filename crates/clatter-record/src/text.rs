//! Records as text: whatever loggers and programs write.

mod cells;
mod cut;
mod labview;
mod layout;
mod rows;

use std::io::Read;

use crate::error::Bad;
use crate::heading::Heading;
use crate::roles::{Roles, Seen};
use crate::{At, Error, Options};
pub(crate) use labview::{is_labview, read as read_labview};
use layout::Layout;
pub(crate) use rows::Rows;

/// Bytes that are read at a time, and before it is known what a file holds.
pub(crate) const BLOCK: usize = 1 << 20;
/// Lines, and bytes of them, that may be above the numbers.
const HEAD: (usize, usize) = (2000, 1 << 18);
/// A line has no more bytes.
const LONGEST: usize = 1 << 18;
/// Rows that show what columns without names are.
pub(crate) const SHOWN: usize = 8;

/// How the bytes of a text become others.
type Decode = fn(&[u8]) -> Vec<u8>;

/// What makes a text one of UTF-8, or of any other bytes with ASCII below 128, whose lines end with a line feed.
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

/// Bytes as text: UTF-8, or else Latin-1, of which µ and ² are in headings.
fn text_of(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}

/// Reads a text whose beginning is there already, handing on how many bytes are read: its channels by their times.
pub(crate) fn read(
    begin: Vec<u8>,
    rest: &mut dyn Read,
    options: &Options,
    progress: &mut dyn FnMut(u64),
) -> Result<Vec<(Rows, Roles)>, Error> {
    let begin = match begin.strip_prefix("\u{feff}".as_bytes()) {
        Some(text) => text.to_vec(),
        None => begin,
    };
    let lines: Vec<String> =
        begin[..begin.len().min(HEAD.1)].split(|byte| *byte == b'\n').take(HEAD.0).map(text_of).collect();
    let lines = match begin.len() > HEAD.1 && lines.len() < HEAD.0 {
        // The last one may be cut.
        true if lines.len() == 1 => {
            return Err(Error::File(format!(
                "the first line is longer than {} bytes: this is no text of columns",
                HEAD.1
            )));
        }
        true => lines[..lines.len() - 1].to_vec(),
        false => lines,
    };
    let mut layout = Layout::of(&lines)?;
    let form = layout.form;
    let data: Vec<Vec<_>> = lines[layout.begin..]
        .iter()
        .filter(|line| !line.trim().is_empty())
        .take(SHOWN)
        .map(|line| form.cells(line))
        .collect();
    // Times of day are in seconds, whatever their heading says.
    for (column, heading) in layout.headings.iter_mut().enumerate() {
        if data.first().and_then(|row| row.get(column)).is_some_and(|cell| crate::moment::seconds(cell).is_some()) {
            *heading = heading.clone().with_unit("s");
        }
    }
    let number = |cell: &std::borrow::Cow<'_, str>| form.number(cell).map_or(f64::NAN, crate::decimal::Decimal::float);
    let seen = Seen {
        headings: layout.headings,
        named: layout.named,
        sampled: layout.sampled_s.is_some(),
        rows: data.iter().map(|row| row.iter().map(number).collect()).collect(),
    };
    let parts = seen.by_time(options)?;
    few_times(parts.len())?;
    let mut parts: Vec<(Rows, Roles)> = parts
        .into_iter()
        .map(|roles| {
            let mut rows = Rows::new(form, &roles, options, seen.headings.len(), layout.sampled_s);
            rows.skip_lines(layout.begin);
            if roles.beside_others {
                rows.may_end_early();
            }
            (rows, roles)
        })
        .collect();
    let mut at = begin.split_inclusive(|byte| *byte == b'\n').take(layout.begin).map(<[u8]>::len).sum::<usize>();
    let (mut buffer, mut bytes) = (begin, 0_u64);
    bytes += buffer.len() as u64;
    let mut last = Vec::new();
    loop {
        let begin = at;
        for (rows, _) in &mut parts {
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
        let kept = buffer.len();
        buffer.resize(kept + BLOCK, 0);
        let read = fill(rest, &mut buffer[kept..])?;
        buffer.truncate(kept + read);
        bytes += read as u64;
        if read == 0 {
            break;
        }
    }
    let cut = cut::within(&last, &buffer, form);
    for (rows, _) in &mut parts {
        match &cut {
            Some(cut) => rows.refuse(cut),
            None if buffer.is_empty() => {}
            None => {
                rows.take(&[&buffer[..], b"\n"].concat())?;
            }
        }
    }
    Ok(parts)
}

/// Refuses more times than a text may have: each is one more look at every line.
fn few_times(count: usize) -> Result<(), Error> {
    const MOST: usize = 100;
    if count <= MOST {
        return Ok(());
    }
    Err(Error::Columns(format!("the channels have more than {MOST} times of their own: take some of the channels")))
}

/// Reads until a buffer is full or the input ends.
pub(crate) fn fill(input: &mut dyn Read, buffer: &mut [u8]) -> Result<usize, Error> {
    let mut filled = 0;
    while filled < buffer.len() {
        match input.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(read) => filled += read,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(Error::Read(error.to_string())),
        }
    }
    Ok(filled)
}

/// All of a small text: its headings, and its rows of numbers.
pub(crate) fn table(input: impl Read, most: usize) -> Result<(Vec<Heading>, Vec<Vec<f64>>), Error> {
    let mut bytes = Vec::new();
    input.take(HEAD.1 as u64).read_to_end(&mut bytes).map_err(|error| Error::Read(error.to_string()))?;
    let text = match decoded(&bytes) {
        Some(decode) => text_of(&decode(&bytes)),
        None => text_of(&bytes),
    };
    let lines: Vec<String> = text.trim_start_matches('\u{feff}').lines().map(str::to_owned).collect();
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
