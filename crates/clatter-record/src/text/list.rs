//! Lists: rows below a line that names the columns, of which some may be of words.

use std::io::Read;

use super::cells::Form;
use super::digits::Digits;
use super::encoding::Letters;
use super::layout::uncommented;
use super::{BLOCK, LONGEST, decoded, first_lines, head, read_block, to_end};
use crate::error::Bad;
use crate::heading::{Heading, Named, unbracketed};
use crate::unit::Unit;
use crate::{At, Error, Options};

/// Lines above the one that names the columns, at most.
const ABOVE: usize = 60;

/// A cell of a list.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell<'a> {
    /// As it stands in the file.
    pub text: &'a str,
    /// Its number, in the unit that the name of the column was asked for in, if it is one.
    pub number: Option<f64>,
}

/// Reads a list in any notation that records may have: the cells of these columns are handed to `each` row by row, and other columns
/// are left out. A column is found by its name, `delta_v_m_s`, or by the same name in any unit of the kind, `delta v [mm/s]`; a time
/// by any name that times have, `t [ms]`.
///
/// ```
/// let (text, mut times_s) = ("time [ms];end\n0,5;a\n2;b\n", Vec::new());
/// clatter_record::read_list(text.as_bytes(), ["end", "time_s"], |[_, time]| {
///     times_s.extend(time.number);
///     Ok(())
/// })?;
/// assert_eq!(times_s, [0.5e-3, 2e-3]);
/// # Ok::<(), clatter_record::Error>(())
/// ```
///
/// # Errors
/// [`Error::Lines`] with the first row that is not like the others, or that `each` does not take, and where the columns are not there.
pub fn read_list<const N: usize>(
    mut input: impl Read,
    names: [&str; N],
    mut each: impl FnMut([Cell<'_>; N]) -> Result<(), String>,
) -> Result<(), Error> {
    let mut buffer = Vec::new();
    read_block(&mut input, &mut buffer)?;
    if let Some(decode) = decoded(&buffer) {
        to_end(&mut buffer, &mut input, &Options::default())?;
        buffer = decode(&buffer);
    }
    let mut list = List::of(&buffer, names)?;
    let (mut line, mut rows) = (0, 0_usize);
    loop {
        let mut at = 0;
        while let Some(length) = length_of_row(&buffer[at..]) {
            let row = &buffer[at..at + length];
            rows += usize::from(list.take(row, line, &mut each)?);
            line += count(row, b'\n');
            at += length;
        }
        buffer.drain(..at);
        if buffer.len() > LONGEST {
            return Err(told(line + 1, format!("longer than {LONGEST} bytes, or a quote is opened and not closed")));
        }
        if read_block(&mut input, &mut buffer)? == 0 {
            break;
        }
    }
    if !buffer.is_empty() {
        rows += usize::from(list.take(&buffer, line, &mut each)?);
        line += 1;
    }
    if rows == 0 {
        return Err(no_rows(line, names));
    }
    list.close()
}

/// Returns whether a text begins with a line that names all of these columns, as [`read_list`] finds them.
#[must_use]
pub fn names_columns<const N: usize>(begin: &[u8], names: [&str; N]) -> bool {
    let begin = decoded(begin).map_or_else(|| begin.to_vec(), |decode| decode(begin));
    List::of(&begin, names).is_ok()
}

/// A list, as the lines above its rows tell it.
#[derive(Debug)]
struct List<const N: usize> {
    form: Form,
    /// Tells whether a number has shown what its decimal mark is.
    is_sure: bool,
    letters: Letters,
    /// Lines down to the names or the units.
    above: usize,
    columns: usize,
    places: [usize; N],
    sizes: [f64; N],
    digits: [Digits; N],
}

/// A column that is asked for: `delta_v_m_s` is `delta v` in a unit of velocity.
struct Wanted {
    stem: String,
    unit: Option<Unit>,
}

impl Wanted {
    fn of(name: &str) -> Self {
        let parted = name.match_indices('_').find_map(|(at, _)| Some((&name[..at], Unit::of(&name[at + 1..])?)));
        let (stem, unit) = parted.map_or((name, None), |(stem, unit)| (stem, Some(unit)));
        Self { stem: plain(stem), unit }
    }

    /// The size of the unit of a column, if it is the one that is asked for. A unit may stand in a line below.
    fn size(&self, cell: &str, below: Option<&str>) -> Option<f64> {
        let heading = Heading::of(cell);
        let own = heading.unit.or_else(|| Unit::of(unbracketed(below?)).filter(|_| heading.spelled.is_none()));
        // A time has many names: t, Zeit, seconds.
        let is_time = self.stem == "time" && heading.named() == Named::Time;
        match (self.unit, own) {
            _ if plain(&heading.name) != self.stem && !is_time => None,
            (Some(wanted), Some(own)) => (own.kind == wanted.kind).then(|| own.size / wanted.size),
            (None, None) if heading.spelled.is_none() => Some(1.0),
            _ => None,
        }
    }
}

/// A name without what writers do differently.
fn plain(name: &str) -> String {
    name.to_lowercase().replace('_', " ")
}

impl<const N: usize> List<N> {
    /// Of the beginning of a text.
    fn of(begin: &[u8], names: [&str; N]) -> Result<Self, Error> {
        let begin = begin.strip_prefix("\u{feff}".as_bytes()).unwrap_or(begin);
        let letters = Letters::of(&begin[..begin.len().min(BLOCK)]);
        let lines = first_lines(begin, letters)?;
        let mut filled = lines.iter().enumerate().filter(|(_, line)| is_row(line)).take(ABOVE).peekable();
        let mut missing: Option<(usize, usize, String)> = None;
        while let Some((i, line)) = filled.next() {
            let below = filled.peek().map(|(below, line)| (*below, line.as_str()));
            match Self::named(line, below, names) {
                Ok(found) => {
                    let list = Self { letters, ..found };
                    return Ok(Self { above: if list.above == 0 { i + 1 } else { list.above }, ..list });
                }
                Err((found, what)) if missing.as_ref().is_none_or(|(most, ..)| found > *most) => {
                    missing = Some((found, i + 1, what));
                }
                Err(_) => {}
            }
            if head::numbers(line) > 0 {
                break;
            }
        }
        let (_, line, what) = missing.ok_or_else(|| no_rows(lines.len().saturating_sub(1), names))?;
        Err(told(line, what))
    }

    /// By a line of names and the one below, which may be of units; else how many names are there, and the first that is not.
    fn named(line: &str, below: Option<(usize, &str)>, names: [&str; N]) -> Result<Self, (usize, String)> {
        let mut best: Option<(usize, String)> = None;
        for separator in [Some(b','), Some(b';'), Some(b'\t'), Some(b'|'), None] {
            let form = Form::new(separator, b'.');
            let cells = form.cells(line);
            let units = below.map(|(_, line)| form.cells(line)).filter(|units| units.len() == cells.len());
            let unit = |column: usize| units.as_ref().map(|units| &*units[column]);
            let (mut places, mut sizes, mut found, mut missing, mut is_below) = ([0; N], [1.0; N], 0, None, false);
            for (k, name) in names.iter().enumerate() {
                let wanted = Wanted::of(name);
                let is_same = |column: &usize| cells[*column] == *name;
                let exact = (0..cells.len()).any(|column| is_same(&column));
                let size = |column: &usize| {
                    if exact { is_same(column).then_some(1.0) } else { wanted.size(&cells[*column], unit(*column)) }
                };
                let mut all = (0..cells.len()).filter(|column| size(column).is_some());
                let Some(column) = all.next() else {
                    missing = missing.or(Some(format!(
                        "no column {name}; the first line names the columns, {} among them",
                        names.join(",")
                    )));
                    continue;
                };
                if let Some(other) = all.next() {
                    return Err((N, format!("columns {} and {} are both named {name}", column + 1, other + 1)));
                }
                is_below |= !exact && wanted.size(&cells[column], None).is_none();
                (places[k], sizes[k], found) = (column, size(&column).unwrap_or(1.0), found + 1);
            }
            match missing {
                None => {
                    let above = below.filter(|_| is_below).map_or(0, |(below, _)| below + 1);
                    let digits = std::array::from_fn(|_| Digits::default());
                    let letters = Letters::default();
                    return Ok(Self {
                        form,
                        is_sure: separator == Some(b','),
                        letters,
                        above,
                        columns: cells.len(),
                        places,
                        sizes,
                        digits,
                    });
                }
                Some(what) if best.as_ref().is_none_or(|(most, _)| found > *most) => best = Some((found, what)),
                Some(_) => {}
            }
        }
        Err(best.unwrap_or_default())
    }

    /// Takes in a row that begins below so many lines; whether it is one.
    fn take(
        &mut self,
        row: &[u8],
        line: usize,
        each: &mut impl FnMut([Cell<'_>; N]) -> Result<(), String>,
    ) -> Result<bool, Error> {
        let text = self.letters.text(row);
        let text = text.trim_end_matches(['\r', '\n']).trim_start_matches('\u{feff}');
        if line < self.above || !is_row(text) {
            return Ok(false);
        }
        if !count(text.as_bytes(), b'"').is_multiple_of(2) {
            return Err(told(line + 1, "a quote is opened and not closed".to_owned()));
        }
        let cells = self.form.cells(text);
        if cells.len() != self.columns {
            let told_cells = |n: usize| if n == 1 { "1 cell".to_owned() } else { format!("{n} cells") };
            return Err(told(
                line + 1,
                format!(
                    "{}, and the header has {}: each row must have as many, a cell with a comma in quotes",
                    told_cells(cells.len()),
                    told_cells(self.columns)
                ),
            ));
        }
        let cells = std::array::from_fn(|k| {
            let text = &*cells[self.places[k]];
            Cell { text, number: self.number(text, k) }
        });
        each(cells).map_err(|what| told(line + 1, what))?;
        Ok(true)
    }

    /// The number of a cell. Where no comma stands between cells the first number with a mark tells the decimal mark.
    fn number(&mut self, cell: &str, k: usize) -> Option<f64> {
        if let Some(mark) = cell.rfind(['.', ',']).filter(|_| !self.is_sure) {
            let form = Form { point: cell.as_bytes()[mark], ..self.form };
            form.number(cell)?;
            (self.form, self.is_sure) = (form, true);
        }
        let number = self.form.number(cell)?;
        if self.form.is_grouped(cell) {
            // With both marks it is clear which is which.
            if !(cell.contains('.') && cell.contains(',')) {
                self.digits[k].note_grouped(cell);
            }
        } else if self.form.separator != Some(b',') {
            self.digits[k].note(number, 0);
        }
        Some(number.float() * self.sizes[k]).filter(|number| number.is_finite())
    }

    fn close(&self) -> Result<(), Error> {
        let has_point = self.digits.iter().any(Digits::has_point);
        let all = self.digits.iter().try_for_each(|digits| digits.close(has_point, None));
        all.map_err(Error::Columns)
    }
}

/// Bytes of the next row with its end: more than one line where a quote is open at the end of one.
fn length_of_row(text: &[u8]) -> Option<usize> {
    let end = text.iter().position(|byte| *byte == b'\n')?;
    let is_open = |quotes: usize| !quotes.is_multiple_of(2);
    let mut quotes = count(&text[..end], b'"');
    if !is_open(quotes) || !is_row(&String::from_utf8_lossy(&text[..end])) {
        return Some(end + 1);
    }
    let more = text[end + 1..].iter().position(|byte| {
        quotes += usize::from(*byte == b'"');
        *byte == b'\n' && !is_open(quotes)
    })?;
    Some(end + 1 + more + 1)
}

fn count(text: &[u8], byte: u8) -> usize {
    text.split(|other| *other == byte).count() - 1
}

/// Returns whether a line is one of names or a row.
fn is_row(line: &str) -> bool {
    let (text, commented) = uncommented(line.trim_start_matches('\u{feff}'));
    !text.is_empty() && !commented
}

fn no_rows<const N: usize>(line: usize, names: [&str; N]) -> Error {
    told(line.max(1), format!("no rows; the first line is {}, a row for each follows", names.join(",")))
}

/// An error of one line, from 1.
fn told(line: usize, what: String) -> Error {
    let mut bad = Bad::default();
    bad.add(At::Line(line), || what);
    Error::Lines(bad)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The columns `time_s` and `end` of a text.
    fn of(text: impl AsRef<[u8]>) -> Result<Vec<(Option<f64>, String)>, String> {
        let mut list = Vec::new();
        let done = read_list(text.as_ref(), ["time_s", "end"], |[time, end]| {
            list.push((time.number, end.text.to_owned()));
            Ok(())
        });
        done.map(|()| list).map_err(|error| error.to_string())
    }

    #[test]
    fn lists_in_any_notation() {
        let expected = Ok(vec![(Some(0.5), "a".to_owned()), (Some(1.25), "b, c".to_owned())]);
        let utf16: Vec<u8> =
            "\u{feff}end;time_s\r\na;0,5\r\nb, c;1,25\r\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(of(utf16), expected);
        for text in [
            "time_s,end\n0.5,a\n1.25,\"b, c\"\n",
            "\u{feff}# an \"open\" quote: \"\n\n end , n, time_s \na,1,0.5\n\n# more\n\"b, c\",2,\"1.25\"",
            "time [ms];end\r\n500;a\r\n1250;b, c\r\n",
            "Time [s];end;note\n0,5;a;\n1,25;b, c;\"two\nlines\"\n",
            "drop 5, at 23 degrees\ntime\tend\nms\t\n500\ta\n1.250,0\tb, c\n",
            "time_s|end\r0.5|a\r1.25|b, c\r",
            "t [ms];end\n500;a\n1250;b, c\n",
            "end;Zeit in s\na;0,5\nb, c;1,25\n",
        ] {
            assert_eq!(of(text), expected, "{text:?}");
        }
    }

    /// Names in other units, above a line of units or with them.
    #[test]
    fn columns_are_found_by_their_names_and_units() {
        let of = |text: &str| {
            let mut list = Vec::new();
            read_list(text.as_bytes(), ["time_s", "delta_v_m_s", "height_a_m"], |cells| {
                list.push(cells.map(|cell| cell.number));
                Ok(())
            })
            .map(|()| list)
        };
        let expected = Ok(vec![[Some(0.5), Some(-2.0), Some(0.25)]]);
        assert_eq!(of("time_s,delta_v_m_s,height_a_m\n0.5,-2,0.25\n"), expected);
        assert_eq!(of("drop 5\nheight a [mm];Time [ms];delta v [mm/s];n\n250;500;-2000;1\n"), expected);
        assert_eq!(
            of("delta_v_mm_s,height_a_m,time_ms,time_s\n-2000,0.25,1,0.5\n"),
            expected,
            "the name itself counts"
        );
        assert_eq!(of("time\tdelta v\theight a\ns\tm/s\tcm\n0,5\t-2\t25\n"), expected);
        let error = of("drop 5\ntime [ms];delta v [g];height a [mm]\n500;1;2\n").expect_err("no velocity").to_string();
        assert!(error.starts_with("line 2: no column delta_v_m_s"), "{error}");
    }

    #[test]
    fn what_is_no_list_is_told_by_its_line() {
        let long = format!("time_s,end\n1,\"{}\n", "x\n".repeat(LONGEST + BLOCK));
        for (text, said) in [
            ("time_s,end\n1\n", "line 2: 1 cell, and the header has 2 cells: each row must"),
            ("time_s,end\n\n1,2,3\n", "line 3: 3 cells, and the header has 2 cells: each row must"),
            ("time_s,end\n1,\"2\n\"\n1,2,\n", "line 4: 3 cells, and the header has 2 cells: each row must"),
            ("time_s,end\n1,\"2\n3,4\n", "line 2: a quote is opened and not closed"),
            (&long, "line 2: longer than 262144 bytes, or a quote is opened and not closed"),
            ("", "line 1: no rows"),
            ("# nothing\n\n", "line 2: no rows"),
            ("time_s,end\n# nothing\n", "line 2: no rows"),
            ("time_s,end,time_s\n1,2,3\n", "line 1: columns 1 and 3 are both named time_s"),
            ("time_s,\n1,2\n", "line 1: no column end; the first line names the columns, time_s,end among them"),
            ("0,1\ntime_s,end\n1,a\n", "line 1: no column time_s"),
            ("time [m],end\n1,a\n", "line 1: no column time_s"),
            ("time_s;end\n0;a\n1,391;b\n", "a mark with three digits behind it"),
        ] {
            let got = of(text).unwrap_err();
            assert!(got.starts_with(said), "{got}, not {said}");
        }
        assert_eq!(
            of("time_s;end\n0.5;a\n1,5;b\n"),
            Ok(vec![(Some(0.5), "a".to_owned()), (None, "b".to_owned())]),
            "two marks"
        );
        let names = |text: &str| names_columns(text.as_bytes(), ["time_s", "end"]);
        assert!(names("end\ttime [ms]\n") && !names("time [s],acceleration [g]\n0,1\n"));
    }
}
