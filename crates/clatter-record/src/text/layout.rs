//! Where the numbers of a text begin, how they are separated, and what the lines above them say.

use std::borrow::Cow;

use super::cells::Form;
use crate::Error;
use crate::heading::{Heading, Named, unbracketed};
use crate::unit::{Kind, Unit};

/// What the beginning of a text tells.
#[derive(Debug)]
pub(super) struct Layout {
    pub(super) form: Form,
    /// Number of the first line of numbers, from 0.
    pub(super) begin: usize,
    /// One for each column.
    pub(super) headings: Vec<Heading>,
    pub(super) named: bool,
    /// Time of the first sample and between samples, where lines above tell it and there is no column of times.
    pub(super) sampled_s: Option<[f64; 2]>,
}

/// Lines that begin so are comments.
const COMMENTS: [&str; 4] = ["#", "%", "//", "!"];
/// Lines that tell what columns there are.
const LAST: usize = 20;
/// Lines above the numbers that are read for headings.
const ABOVE: usize = 8;

/// A line without the mark of a comment, and whether it had one.
pub(super) fn uncommented(line: &str) -> (&str, bool) {
    let line = line.trim();
    match COMMENTS.iter().find(|mark| line.starts_with(**mark)) {
        Some(mark) => (line.trim_start_matches(mark.chars().next().unwrap_or('#')).trim_start(), true),
        None => (line, false),
    }
}

impl Layout {
    /// Of the first lines of a text.
    pub(super) fn of(lines: &[String]) -> Result<Self, Error> {
        let forced = lines.iter().find_map(|line| separator_line(line));
        let forms: Vec<Form> = match forced {
            Some(separator) => [b'.', b',']
                .map(|point| Form { separator: Some(separator), point })
                .into_iter()
                .filter(|f| f.separator != Some(f.point))
                .collect(),
            None => [
                (Some(b'\t'), b'.'),
                (Some(b'\t'), b','),
                (Some(b';'), b'.'),
                (Some(b';'), b','),
                (Some(b','), b'.'),
                (Some(b'|'), b'.'),
                (None, b'.'),
                (None, b','),
            ]
            .map(|(separator, point)| Form { separator, point })
            .to_vec(),
        };
        // Several columns before one: a separator that is not in the numbers makes one column of every line. Of several the one that
        // leaves the fewest cells that are no numbers.
        let found: Vec<_> =
            forms.into_iter().filter_map(|form| begin(lines, form).map(|found| (form, found))).collect();
        let rank = |found: &Numbers| (usize::from(found.columns.len() > 1), found.share);
        let best = found.iter().reduce(|best, other| if rank(&other.1) > rank(&best.1) { other } else { best });
        let Some((form, found)) = best else {
            return Err(Error::File(format!("no line of numbers is found in the first {} lines", lines.len())));
        };
        let (form, begin, columns) = (*form, found.begin, found.count);
        let mut layout = Self { form, begin, headings: Vec::new(), named: false, sampled_s: None };
        layout.read_above(lines, columns)?;
        for (column, heading) in layout.headings.iter_mut().enumerate() {
            heading.is_text = !found.columns.contains(&column);
        }
        Ok(layout)
    }

    /// Names and units of the columns, from the lines above the numbers, the nearest first.
    fn read_above(&mut self, lines: &[String], columns: usize) -> Result<(), Error> {
        let (mut names, mut units) = (None, None);
        let above = lines[..self.begin].iter().enumerate().rev().filter(|(_, line)| !line.trim().is_empty());
        for (nearest, (number, line)) in above.take(ABOVE).enumerate() {
            let (text, commented) = uncommented(line);
            if separator_line(text).is_some() {
                continue;
            }
            let listed = text.split_once(':').filter(|(word, _)| {
                ["unit", "units", "einheit", "einheiten"].contains(&word.trim().to_lowercase().as_str())
            });
            let cells = heading_cells(self.form, listed.map_or(text, |(_, list)| list.trim()), commented, columns);
            let Some(cells) = cells else {
                let count = other_names(self.form, text);
                if let Some(count) = count.filter(|_| nearest == 0 && !commented) {
                    let line = number + 1;
                    return Err(Error::Columns(format!(
                        "line {line} names {count} columns, and the lines of numbers below have {columns}"
                    )));
                }
                continue;
            };
            if units.is_none() && (listed.is_some() || all_units(&cells)) {
                units = Some(cells);
                continue;
            }
            // A line of text with as many cells is one of names; in a comment it has to say something of time or acceleration.
            let headings: Vec<Heading> = cells.iter().map(|cell| Heading::of(cell)).collect();
            let telling = |heading: &Heading| heading.unit.is_some() || heading.named() != Named::Unknown;
            if !commented || headings.iter().filter(|heading| !heading.name.is_empty()).any(telling) {
                names = Some(headings);
                break;
            }
        }
        self.named = names.is_some();
        let unnamed = || vec![Heading::named_alone(""); columns];
        let mut headings = names.unwrap_or_else(unnamed);
        // Names without numbers below them, as LabVIEW's `Comment`, are none of a column.
        headings.truncate(columns);
        if let Some(units) = units {
            // A name alone, such as `g`, is no unit beside a line of units.
            for (heading, spelled) in headings.iter().zip(&units) {
                if let (Some(own), Some(unit)) = (heading.unit, Unit::of(unbracketed(spelled)))
                    && own.size.to_bits() != unit.size.to_bits()
                    && heading.spelled.as_ref() != Some(&heading.name)
                {
                    return Err(Error::Units(format!(
                        "{} is in {spelled} by the line of units, and in another unit by its name",
                        heading.shown()
                    )));
                }
            }
            headings = headings.into_iter().zip(units).map(|(heading, unit)| heading.with_unit(&unit)).collect();
        }
        self.headings = headings;
        Ok(())
    }
}

/// How many columns a line names that says something of time or acceleration.
fn other_names(form: Form, line: &str) -> Option<usize> {
    form.separator?;
    let cells = form.cells(line);
    let telling = |cell: &Cow<'_, str>| {
        let heading = Heading::of(cell);
        let is_number = cell.starts_with(|c: char| c.is_ascii_digit());
        !is_number && (heading.unit.is_some() || matches!(heading.named(), Named::Time | Named::Acceleration))
    };
    (cells.len() > 1 && cells.iter().any(telling)).then_some(cells.len())
}

/// `sep=;`, by which spreadsheets tell the separator.
fn separator_line(line: &str) -> Option<u8> {
    let rest = line.trim().trim_matches('"').strip_prefix("sep=").or_else(|| line.trim().strip_prefix("SEP="))?;
    match rest.as_bytes() {
        [separator] => Some(*separator),
        [] if line.contains("sep=\t") => Some(b'\t'),
        _ => None,
    }
}

/// Where numbers are, by one way to separate them.
struct Numbers {
    /// The line that they begin with.
    begin: usize,
    /// How many columns there are.
    count: usize,
    /// Those of numbers.
    columns: Vec<usize>,
    /// Cells that are numbers, in 1000 of the last lines.
    share: usize,
}

/// Where the numbers are.
///
/// What the columns are is told by the last lines: as many cells as most have, and those columns that are numbers in most. The
/// numbers begin with the first line that has as many cells and nothing else in those columns; a line right above with a number
/// in the first of them is one too, with a fault.
fn begin(lines: &[String], form: Form) -> Option<Numbers> {
    let mut rows: Vec<(usize, Vec<Cow<'_, str>>)> = lines
        .iter()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty() && !uncommented(line).1)
        .map(|(i, line)| (i, form.cells(line)))
        .collect();
    let full = |cells: &[Cow<'_, str>]| cells.iter().rposition(|cell| !cell.is_empty()).map_or(1, |last| last + 1);
    // A separator at the end of each line makes no column, unless the names above have one there.
    let is_text = |cells: &[Cow<'_, str>]| cells.iter().all(|cell| cell.is_empty() || !form.is_data(cell));
    let named = rows.iter().take_while(|(_, cells)| is_text(cells)).last().map_or(0, |(_, cells)| full(cells));
    for (_, cells) in &mut rows {
        cells.truncate(full(cells).max(named));
    }
    let last = &rows[rows.len().saturating_sub(LAST)..];
    let has = |columns: usize| last.iter().filter(|(_, cells)| cells.len() == columns).count();
    let columns = last.iter().map(|(_, cells)| cells.len()).max_by_key(|columns| (has(*columns), *columns))?;
    let is_number = |column: usize| {
        let filled = |rows: &'_ [(usize, Vec<Cow<'_, str>>)], is: &dyn Fn(&str) -> bool| {
            let cell =
                |cells: &Vec<Cow<'_, str>>| cells.len() == columns && !cells[column].is_empty() && is(&cells[column]);
            rows.iter().filter(|(_, cells)| cell(cells)).count()
        };
        // A channel with times of its own may end before the others.
        match filled(last, &|_| true) {
            0 => 2 * filled(&rows, &|cell| form.is_data(cell)) > filled(&rows, &|_| true),
            _ => 2 * filled(last, &|cell| form.is_data(cell)) >= has(columns),
        }
    };
    let numbers: Vec<usize> = (0..columns).filter(|column| is_number(*column)).collect();
    let first = *numbers.first()?;
    // LabVIEW leaves the column of times empty where it writes none.
    let is_empty = |column: &usize| {
        !is_number(*column) && last.iter().all(|(_, cells)| cells.get(*column).is_none_or(|cell| cell.is_empty()))
    };
    let empty: Vec<usize> = (0..columns).filter(is_empty).collect();
    let is_data = |cells: &[Cow<'_, str>]| {
        let cell = |column: usize| cells.get(column).map_or("", |cell| cell);
        // Cells at the end may be empty by a fault of one line.
        cells.len() <= columns
            && numbers.iter().all(|column| form.is_data(cell(*column)))
            && numbers.iter().any(|column| form.number(cell(*column)).is_some())
            && empty.iter().all(|column| cell(*column).is_empty())
            && cells.len() + 1 >= columns
    };
    let mut i = rows.iter().position(|(_, cells)| is_data(cells))?;
    let starts = |cells: &[Cow<'_, str>]| cells.len() == columns && columns > 1 && form.number(&cells[first]).is_some();
    while i.checked_sub(1).is_some_and(|above| starts(&rows[above].1)) {
        i -= 1;
    }
    let cells = || last.iter().flat_map(|(_, cells)| cells);
    // A slow channel leaves cells empty.
    let full = cells().filter(|cell| !cell.is_empty()).count().max(1);
    let share = 1000 * cells().filter(|cell| form.number(cell).is_some()).count() / full;
    Some(Numbers { begin: rows[i].0, count: columns, columns: numbers, share })
}

/// The cells of a line of names or units: as many as there are columns; those of blanks may have blanks in them.
fn heading_cells(form: Form, text: &str, commented: bool, columns: usize) -> Option<Vec<String>> {
    let owned = |cells: Vec<Cow<'_, str>>| cells.into_iter().map(Cow::into_owned).collect::<Vec<_>>();
    let mut cells = owned(form.cells(text));
    while cells.len() > columns && cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    if form.separator.is_some() {
        let beyond = |cell: &String| cell.eq_ignore_ascii_case("comment");
        let fits =
            cells.len() == columns || cells.len() == columns + 1 && columns > 1 && cells.last().is_some_and(beyond);
        if fits || !commented {
            return fits.then_some(cells);
        }
        // In comments, and above columns of blanks, names may be separated in another way.
    } else if cells.len() == columns {
        return Some(cells);
    }
    let by = |separator: &str| {
        text.split(separator).map(str::trim).filter(|cell| !cell.is_empty()).map(str::to_owned).collect::<Vec<_>>()
    };
    [by("  "), by("\t"), by(","), by(";"), joined(text)].into_iter().find(|cells| cells.len() == columns)
}

/// Words, with a unit in brackets joined to the name before it.
fn joined(text: &str) -> Vec<String> {
    let mut cells: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match cells.last_mut() {
            Some(last) if word.starts_with(['[', '(']) => {
                last.push(' ');
                last.push_str(word);
            }
            _ => cells.push(word.to_owned()),
        }
    }
    cells
}

/// Whether every cell is a unit or empty, and one is a unit.
fn all_units(cells: &[String]) -> bool {
    let unit = |cell: &String| Unit::of(unbracketed(cell)).is_some();
    // `t,a` are names, though `a` is a unit of current.
    let telling = |cell: &String| Unit::of(unbracketed(cell)).is_some_and(|unit| !matches!(unit.kind, Kind::Other(_)));
    cells.iter().all(|cell| cell.is_empty() || cell == "-" || unit(cell)) && cells.iter().any(telling)
}
