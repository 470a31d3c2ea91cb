//! A CSV file (RFC 4180) row by row, in little memory however long the file or a line of it is.
//!
//! Beyond RFC 4180, empty lines and lines that begin with `#` are skipped, and blanks around a cell are left out.

use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use csv_core::{ReadRecordResult, Terminator};

use crate::{Failure, input};

/// Bytes of a row at most, with the ends of its lines. `csv` itself would read a row of any length, which is why rows
/// are collected here and only their cells are told apart by its parser.
const LONGEST: usize = 1 << 16;

/// Rows of a file, one at a time.
struct Rows<R> {
    input: R,
    /// The row, complete.
    row: Vec<u8>,
    /// Where the row begins, and how many lines are read.
    line: usize,
    lines: usize,
    parser: csv_core::Reader,
    /// The cells of the row, one after the other, and where each ends.
    cells: Vec<u8>,
    ends: Vec<usize>,
}

/// Why there is no row.
enum Bad {
    Input(io::Error),
    Row(String),
}

impl<R: BufRead> Rows<R> {
    fn new(input: R) -> Self {
        let parser = csv_core::ReaderBuilder::new().terminator(Terminator::Any(b'\n')).build();
        // No row has more cells than bytes.
        Self { input, row: Vec::new(), line: 0, lines: 0, parser, cells: vec![0; LONGEST], ends: vec![0; LONGEST] }
    }

    /// Goes to the next row, and gives the number of its cells; none at the end of the file.
    fn advance(&mut self) -> Result<Option<usize>, Bad> {
        if !self.collect()? {
            return Ok(None);
        }
        let bad = |what: &str| Err(Bad::Row(what.to_owned()));
        let Ok(text) = std::str::from_utf8(&self.row) else { return bad("not text (UTF-8)") };
        let row = bare(text).as_bytes();
        self.parser.reset();
        // At the end of its input the parser asks for more; none is the end of the row.
        let (_, used, written, n) = self.parser.read_record(row, &mut self.cells, &mut self.ends);
        // To the parser a quote within such a cell is a letter, so that its row ends before this one.
        if used < row.len() {
            return bad(
                "a quote stands within a cell that does not begin with one: write it twice, in a cell in quotes",
            );
        }
        let (cells, ends) = (&mut self.cells[written..], &mut self.ends[n..]);
        match self.parser.read_record(&[], cells, ends) {
            (ReadRecordResult::Record, _, _, last) => Ok(Some(n + last)),
            _ => bad("no row of cells"),
        }
    }

    /// Reads the lines of the next row: more than one where a quote is open at the end of a line.
    fn collect(&mut self) -> Result<bool, Bad> {
        self.row.clear();
        let mut quoted = false;
        loop {
            let begin = self.row.len();
            let room = (LONGEST + 1 - begin) as u64;
            let n = (&mut self.input).take(room).read_until(b'\n', &mut self.row).map_err(Bad::Input)?;
            let line = &self.row[begin..];
            if begin == 0 {
                self.line = self.lines + usize::from(n > 0);
            }
            self.lines += usize::from(n > 0);
            quoted = line.iter().fold(quoted, |open, byte| open ^ (*byte == b'"'));
            match (n, quoted) {
                (0, true) => return Err(Bad::Row("a quote is opened and not closed".to_owned())),
                (0, false) => return Ok(false),
                (_, true) if self.row.len() > LONGEST => {
                    return Err(Bad::Row(format!("a quote is opened and not closed within {LONGEST} bytes")));
                }
                (_, false) if self.row.len() > LONGEST => {
                    return Err(Bad::Row(format!("longer than {LONGEST} bytes")));
                }
                _ => {}
            }
            if begin == 0 {
                let text = std::str::from_utf8(line).map(bare);
                if text.is_ok_and(|text| text.is_empty() || text.starts_with('#')) {
                    quoted = false;
                    self.row.clear();
                    continue;
                }
            }
            if !quoted {
                return Ok(true);
            }
        }
    }

    /// A cell of the row, without the blanks around it.
    fn cell(&self, i: usize) -> &str {
        let begin = if i == 0 { 0 } else { self.ends[i - 1] };
        // The row is text, and so is each of its cells.
        let cell = std::str::from_utf8(&self.cells[begin..self.ends[i]]).unwrap_or_default().trim();
        // Quotes after a blank are not quotes to RFC 4180.
        cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).map_or(cell, str::trim)
    }
}

/// Without blanks around it and byte order marks before it, which begin files, and so parts of files put together.
fn bare(text: &str) -> &str {
    text.trim().trim_start_matches('\u{feff}')
}

/// Reads the rows of a file, the columns of these names handed to `each` in the order of the names.
///
/// The first row is the header. Columns of other names are left out.
pub(super) fn rows<const N: usize>(
    path: &Path,
    names: [&str; N],
    each: impl FnMut([&str; N]) -> Result<(), String>,
) -> Result<(), Failure> {
    let unreadable = |reason| Failure::Unreadable { path: path.to_owned(), reason };
    rows_of(path, BufReader::with_capacity(1 << 20, input::open(path).map_err(unreadable)?), names, each)
}

/// The same of a file that is open already.
pub(crate) fn rows_of<const N: usize>(
    path: &Path,
    input: impl BufRead,
    names: [&str; N],
    each: impl FnMut([&str; N]) -> Result<(), String>,
) -> Result<(), Failure> {
    let unreadable = |reason| Failure::Unreadable { path: path.to_owned(), reason };
    let mut rows = Rows::new(input);
    read(&mut rows, names, each).map_err(|bad| match bad {
        Bad::Input(reason) => unreadable(reason),
        Bad::Row(what) => Failure::Line { path: path.to_owned(), line: rows.line.max(1), what },
    })
}

fn read<R: BufRead, const N: usize>(
    rows: &mut Rows<R>,
    names: [&str; N],
    mut each: impl FnMut([&str; N]) -> Result<(), String>,
) -> Result<(), Bad> {
    let mut header: Option<(usize, [usize; N])> = None;
    let mut count = 0_usize;
    while let Some(n) = rows.advance()? {
        let Some((columns, places)) = header else {
            header = Some((n, places(rows, n, names).map_err(Bad::Row)?));
            continue;
        };
        if n != columns {
            let cells = |n: usize| if n == 1 { "1 cell".to_owned() } else { format!("{n} cells") };
            return Err(Bad::Row(format!(
                "{}, and the header has {}: each row must have as many, a cell with a comma in quotes",
                cells(n),
                cells(columns)
            )));
        }
        each(places.map(|place| rows.cell(place))).map_err(Bad::Row)?;
        count += 1;
    }
    if count == 0 {
        rows.line = rows.lines;
        return Err(Bad::Row(format!("no rows; the first line is {}, a row for each follows", names.join(","))));
    }
    Ok(())
}

/// Where in a header of `n` columns those of these names are.
fn places<R: BufRead, const N: usize>(rows: &Rows<R>, n: usize, names: [&str; N]) -> Result<[usize; N], String> {
    let mut found = [0; N];
    for (place, name) in found.iter_mut().zip(names) {
        let mut at = (0..n).filter(|i| rows.cell(*i) == name);
        *place = at.next().ok_or_else(|| {
            format!("no column {name}; the first line names the columns, {} among them", names.join(","))
        })?;
        if let Some(other) = at.next() {
            return Err(format!("columns {} and {} are both named {name}", *place + 1, other + 1));
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The columns a and b of a text, row by row.
    fn of(text: impl AsRef<[u8]>) -> Result<Vec<[String; 2]>, String> {
        let mut list = Vec::new();
        let mut rows = Rows::new(text.as_ref());
        let done = read(&mut rows, ["a", "b"], |cells| {
            list.push(cells.map(str::to_owned));
            Ok(())
        });
        match done {
            Ok(()) => Ok(list),
            Err(Bad::Row(what)) => Err(format!("line {}: {what}", rows.line)),
            Err(Bad::Input(error)) => panic!("{error}"),
        }
    }

    #[test]
    fn cells_are_those_of_rfc_4180() {
        for (text, rows) in [
            ("a,b\n1,2\n", &[["1", "2"]][..]),
            ("\u{feff}a,b\r\n1,2\r\n3,4", &[["1", "2"], ["3", "4"]]),
            ("a,note,b\n1,\"x, y\",2\n", &[["1", "2"]]),
            ("a,note,b\n1,\"two\nlines, a \"\"quote\"\"\r\n\",2\n3,,4\n", &[["1", "2"], ["3", "4"]]),
            ("a,note,b\n1,\"two\n# no comment\n\n\",2\n", &[["1", "2"]]),
            ("b,\"a, b\",a\n2,0,1\n", &[["1", "2"]]),
            ("a,b\n\"1,5\",\"say \"\"2\"\"\"\n", &[["1,5", "say \"2\""]]),
            // Blanks, comments and empty lines.
            ("# an \"open\" quote: \"\n\n \t\n  # more\n a , b \n\n 1 ,\t\"2\" \n#\n\u{a0}\n", &[["1", "2"]]),
            ("\"a\" , \"b\"\n\"1\" , \"2\"\n", &[["1", "2"]]),
            ("a,b,,\n1,2,,\n", &[["1", "2"]]),
            ("a,b\n,\n", &[["", ""]]),
            ("a,b\n1\r,2\r\r\n", &[["1", "2"]]),
        ] {
            let rows: Vec<_> = rows.iter().map(|row| row.map(str::to_owned)).collect();
            assert_eq!(of(text), Ok(rows), "{text:?}");
        }
    }

    #[test]
    fn rows_that_are_none_are_told_by_the_line_they_begin_in() {
        let many = format!("a,b\n1,\"{}\n", "x\n".repeat(LONGEST));
        let long = format!("a,b\n1,{}\n", "x".repeat(LONGEST));
        for (text, said) in [
            ("a,b\n1\n", "line 2: 1 cell, and the header has 2 cells: each row must"),
            ("a,b\n\n1,2,3\n", "line 3: 3 cells, and the header has 2 cells: each row must"),
            ("a,b\n1,\"2\n\"\n1,2,\n", "line 4: 3 cells, and the header has 2 cells: each row must"),
            ("a,b\n1,\"2\n3,4\n", "line 2: a quote is opened and not closed"),
            ("a,b\n5\",1\n2,3\"\n", "line 2: a quote stands within a cell that does not begin with one"),
            (&many, "line 2: a quote is opened and not closed within 65536 bytes"),
            (&long, "line 2: longer than 65536 bytes"),
            ("", "line 0: no rows"),
            ("# nothing\n\n", "line 2: no rows"),
            ("a,b\n# nothing\n", "line 2: no rows"),
            ("a,b,a\n1,2,3\n", "line 1: columns 1 and 3 are both named a"),
            ("a,\n1,2\n", "line 1: no column b"),
            ("a,b\r1,2\r", "line 1: no column b"),
        ] {
            let got = of(text).unwrap_err();
            assert!(got.starts_with(said), "{got}, not {said}");
        }
        assert_eq!(of(b"a,b\n1,\xff\n").unwrap_err(), "line 2: not text (UTF-8)");
    }

    /// A row ends at its longest however the bytes come: a file without an end is no matter.
    #[test]
    fn rows_without_an_end_are_cut_off() {
        for byte in [b'x', b'"', b'\n'] {
            let endless = io::Cursor::new(b"a,b\n1,\"").chain(io::repeat(byte).take(1 << 26));
            let mut rows = Rows::new(BufReader::with_capacity(1 << 12, endless));
            let done = read(&mut rows, ["a", "b"], |_| Ok(()));
            assert!(matches!(done, Err(Bad::Row(_))), "{byte}");
            assert!(rows.row.capacity() <= 4 * LONGEST, "{} bytes kept", rows.row.capacity());
        }
    }
}
