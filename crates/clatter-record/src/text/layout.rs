//! Where the numbers of a text begin, how they are separated, and what the lines above them say.

use std::borrow::Cow;

use super::block::{Numbers, begin};
use super::cells::{ARROW, Form};
use super::head;
use super::header::{self, Header};
use crate::Error;
use crate::heading::{Heading, Named, unbracketed};
use crate::unit::{Kind, Unit};

/// The layout of a text, as its beginning tells it.
#[derive(Debug, Default)]
pub(super) struct Layout {
    pub(super) form: Form,
    /// Number of the first line of numbers, from 0.
    pub(super) begin: usize,
    /// One for each column.
    pub(super) headings: Vec<Heading>,
    pub(super) named: bool,
    /// Time of the first sample and between samples, where lines above tell it and there is no column of times.
    pub(super) sampled_s: Option<[f64; 2]>,
    /// Time between samples that a line above tells, and the number of the line, from 1.
    pub(super) told_s: Option<(f64, usize)>,
    /// What else lines above tell of all numbers.
    pub(super) header: Header,
    /// A line whose rate may be read in two ways.
    pub(super) unclear: Option<usize>,
    /// How many samples there are by a line above, from 1, that is one number.
    pub(super) count: Option<(usize, usize)>,
    /// Columns in which the unit stands behind each number.
    pub(super) measured: Vec<bool>,
}

/// Lines that begin so are comments.
const COMMENTS: [&str; 4] = ["#", "%", "//", "!"];
/// Lines that tell what columns there are.
pub(super) const LAST: usize = 20;
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
                .map(|point| Form::new(Some(separator), point))
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
                // Between quotes.
                (Some(b','), b','),
            ]
            .map(|(separator, point)| Form::new(separator, point))
            .to_vec(),
        };
        if let Some(scope) = head::tektronix(lines) {
            return Ok(Self::beside(&scope));
        }
        let arrow =
            lines.iter().rev().filter(|line| !line.trim().is_empty()).take(LAST).all(|line| line.contains(ARROW));
        let forms: Vec<Form> = forms.into_iter().map(|form| Form { arrow, ..form }).collect();
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
        let mut layout = Self {
            form,
            begin,
            told_s: head::step(&lines[..begin]),
            header: header::of(&lines[..begin], form),
            unclear: lines[..begin].iter().position(|line| head::in_groups(line)),
            measured: found.measured.clone(),
            ..Self::default()
        };
        layout.count = layout.refuse_numbers(lines, columns)?;
        layout.read_above(lines, columns, found.counts, !found.columns.contains(&0))?;
        layout.refuse_heading_below(lines)?;
        for (column, heading) in layout.headings.iter_mut().enumerate() {
            heading.is_text = !found.columns.contains(&column);
        }
        // Numbers that have a unit of their own have been calibrated.
        if layout.header.unit.is_none()
            || layout.headings.iter().any(|heading| heading.kind() == Some(Kind::Acceleration))
        {
            layout.header.slope = None;
        }
        layout.take_names(found.counts);
        layout.read_scope(lines);
        let first: Vec<Cow<'_, str>> = form.cells(&lines[begin]);
        for (column, heading) in layout.headings.iter_mut().enumerate() {
            // Where the heading names a unit as well it has to be the same.
            layout.measured[column] &= heading.spelled.is_none();
            let cell = first.get(column).filter(|_| layout.measured[column]);
            let unit = cell.and_then(|cell| form.measured(cell)).map(|(_, unit)| unit);
            if let Some(unit) = unit.filter(|_| heading.spelled.is_none()) {
                *heading = heading.clone().with_unit(unit);
            }
        }
        Ok(layout)
    }

    /// Takes names and units from the lines that tell them, for columns that have none, or for those behind the time, which may stand
    /// behind the number of the row.
    fn take_names(&mut self, counts: bool) {
        let Header { names, units, .. } = &self.header;
        let count = self.headings.len();
        let first = count.saturating_sub(names.len());
        if !self.named && !names.is_empty() && (first < 2 || first == 2 && counts) {
            if let Some(time) = first.checked_sub(1) {
                self.headings[time] = Heading { is_text: self.headings[time].is_text, ..Heading::of("time") };
            }
            for (heading, name) in self.headings[first..].iter_mut().zip(names) {
                let told = Heading::of(name);
                *heading = Heading {
                    unit: told.unit.or(heading.unit),
                    is_text: heading.is_text,
                    spelled: told.spelled.or(heading.spelled.take()),
                    ..told
                };
            }
            self.named = true;
        }
        // One unit is that of all channels, by `read_scope`.
        let first = count.saturating_sub(units.len());
        if units.len() > 1 && first < 2 {
            for (heading, unit) in
                self.headings[first..].iter_mut().zip(units).filter(|(heading, _)| heading.spelled.is_none())
            {
                *heading = heading.clone().with_unit(unit);
            }
        }
    }

    /// Of a file whose settings stand beside the numbers.
    fn beside(scope: &head::Scope) -> Self {
        let heading = |(name, unit): (&String, &String)| Heading {
            is_text: unit.is_empty(),
            ..Heading::named_alone(name).with_unit(unit)
        };
        let headings: Vec<Heading> = scope.names.iter().zip(&scope.units).map(heading).collect();
        Self {
            form: Form::new(Some(b','), b'.'),
            measured: vec![false; headings.len()],
            headings,
            named: true,
            ..Self::default()
        }
    }

    /// Takes in what oscilloscopes tell of units and times.
    fn read_scope(&mut self, lines: &[String]) {
        let above = &lines[..self.begin];
        if let Some(scope) = head::rigol(above) {
            self.headings.truncate(scope.units.len());
            self.measured.truncate(scope.units.len());
            self.named = true;
            self.sampled_s = scope.sampled_s;
            for (heading, (name, unit)) in self.headings.iter_mut().zip(scope.names.iter().zip(&scope.units)) {
                let name = if unit.is_empty() { "Sequence" } else { name };
                *heading = Heading::named_alone(name).with_unit(unit);
            }
        } else if let Some([time, value]) = head::axes(above).or_else(|| head::units(above)) {
            let open = |heading: &&mut Heading| {
                heading.spelled.is_none() && !heading.is_text && !matches!(heading.named(), Named::Other | Named::Index)
            };
            for heading in self.headings.iter_mut().filter(open) {
                let unit = if heading.named() == Named::Time { &time } else { &value };
                *heading = heading.clone().with_unit(unit);
            }
        }
    }

    /// Refuses lines of numbers without names above a line of names: they are another record, or no record.
    fn refuse_heading_below(&self, lines: &[String]) -> Result<(), Error> {
        if self.named {
            return Ok(());
        }
        let is_number = |cell: &Cow<'_, str>| self.form.number(cell).is_some();
        let is_heading = |line: &String| {
            line.contains(char::is_alphabetic)
                && other_names(self.form, line).is_some()
                && !self.form.cells(line).iter().any(is_number)
        };
        let below = lines[self.begin..].iter().position(is_heading);
        match below {
            None => Ok(()),
            Some(below) => Err(Error::Records(format!(
                "line {} names columns, below numbers from line {} on that none is named of: --record=1 reads the first lines, \
                 --record=2 those below the names",
                self.begin + below + 1,
                self.begin + 1
            ))),
        }
    }

    /// Refuses lines of numbers above those that are read, but for one number apart from them, which may be their count.
    fn refuse_numbers(&self, lines: &[String], columns: usize) -> Result<Option<(usize, usize)>, Error> {
        let mut single = None;
        let mut apart = false;
        for (i, line) in lines[..self.begin].iter().enumerate().rev() {
            if line.trim().is_empty() {
                continue;
            }
            let count = if uncommented(line).1 { 0 } else { head::numbers(line) };
            // A line of numbers as names of columns stands below no other ones.
            if count == 0 {
                apart = true;
                continue;
            }
            if count > 1 || columns == 1 || !apart || single.is_some() {
                return Err(Error::File(format!(
                    "line {} is one of numbers ({}) above those that begin with line {}, and does not fit them: one record a file, \
                     or a # before what is none of it",
                    i + 1,
                    super::visible(line.trim()),
                    self.begin + 1
                )));
            }
            single = Some((line.trim().parse().unwrap_or(0), i + 1));
        }
        Ok(single)
    }

    /// Names and units of the columns, from the lines above the numbers, the nearest first.
    ///
    /// `counts` is whether the first column counts the rows, or has a word for each, as `words` tells: rows may be named, and their
    /// names have no name. Numbers that are names stand between quotes.
    fn read_above(&mut self, lines: &[String], columns: usize, counts: bool, words: bool) -> Result<(), Error> {
        let (mut names, mut units) = (None, None);
        let above = lines[..self.begin].iter().enumerate().rev().filter(|(_, line)| !line.trim().is_empty());
        for (nearest, (number, line)) in above.take(ABOVE).enumerate() {
            let (text, commented) = uncommented(line);
            if separator_line(text).is_some() {
                continue;
            }
            // Names one a line: the time, and below it a channel.
            let other = |line: &String| Heading::of(uncommented(line).0);
            if columns == 2
                && names.is_none()
                && self.form.separator.is_none()
                && let Some(above) = number.checked_sub(1).map(|above| other(&lines[above]))
                && above.is_time()
                && above.name.to_lowercase().starts_with("time")
            {
                names = Some(vec![above, other(line)]);
                break;
            }
            let listed = text.split_once(':').filter(|(word, _)| {
                ["unit", "units", "einheit", "einheiten"].contains(&word.trim().to_lowercase().as_str())
            });
            let listed_text = listed.map_or(text, |(_, list)| list.trim());
            let of = |columns: usize| heading_cells(self.form, listed_text, commented, columns);
            let quoted = lines[self.begin].trim_start().starts_with('"');
            let row_names = || {
                let cells = of(columns - 1).filter(|_| counts && columns > 2 && (quoted || words))?;
                Some(std::iter::once(String::new()).chain(cells).collect::<Vec<_>>())
            };
            let Some(cells) = of(columns).or_else(row_names) else {
                let count = other_names(self.form, text);
                if let Some(count) = count.filter(|_| nearest == 0 && !commented) {
                    let line = number + 1;
                    return Err(Error::Columns(format!(
                        "line {line} names {count} columns, and the lines of numbers below have {columns}"
                    )));
                }
                continue;
            };
            let next = || {
                let above = lines[..number].iter().rev().find(|line| !line.trim().is_empty())?;
                let cells = heading_cells(self.form, uncommented(above).0, false, columns)?;
                Some(!self.is_setting(&cells) && cells.iter().all(|cell| self.form.number(cell).is_none()))
            };
            if units.is_none()
                && (listed.is_some() || all_units(&cells) || self.some_units(&cells) && next() == Some(true))
            {
                units = Some(cells);
                continue;
            }
            // A setting of columns is no name: `Min,-20`, `10000 Hz`, `Float64`.
            if names.is_none() && self.is_setting(&cells) {
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
        // Names without numbers below them, as `Comment`, are none of a column.
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

impl Layout {
    /// Returns whether cells are settings of columns, and no names.
    fn is_setting(&self, cells: &[String]) -> bool {
        let types = ["float64", "float32", "double", "single", "int16", "int32", "real", "float", "f64", "smp", "avg"];
        let is_type = |cell: &String| types.contains(&cell.to_lowercase().as_str());
        let is_number = |cell: &String| self.form.number(cell).is_some() || self.form.measured(cell).is_some();
        // One cell of a key and its value names no column; of several it may be `Chart: a`.
        let alone = cells.len() == 1;
        let is_labelled = |cell: &String| {
            let told = cell.split_once([':', '=']).map(|(_, told)| told.trim()).filter(|told| !told.is_empty());
            told.is_some_and(|told| {
                alone && !Heading::of(cell).is_telling()
                    || self.form.number(told).is_some()
                    || self.form.measured(told).is_some()
            })
        };
        let is_rule = |cell: &String| cell.len() > 1 && cell.chars().all(|c| matches!(c, '-' | '+' | '=' | '_' | ':'));
        let filled = || cells.iter().filter(|cell| !cell.is_empty());
        let numbers = filled().filter(|cell| is_number(cell)).count();
        // `Range=` and what stands behind it.
        let is_key = cells.len() > 1 && cells[0].len() > 1 && cells[0].ends_with(['=', ':']);
        is_key
            || filled().all(|cell| is_type(cell) || is_labelled(cell) || is_rule(cell))
            || numbers > 0 && !filled().any(|cell| !is_number(cell) && Heading::of(cell).is_telling())
    }
}

/// How many columns a line names that says something of time or acceleration.
fn other_names(form: Form, line: &str) -> Option<usize> {
    form.separator?;
    let cells = form.cells(line);
    let telling =
        |cell: &Cow<'_, str>| !cell.starts_with(|c: char| c.is_ascii_digit()) && Heading::of(cell).is_telling();
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

/// Returns whether every cell is a unit or empty, and one is a unit.
fn all_units(cells: &[String]) -> bool {
    let unit = |cell: &String| Unit::of(unbracketed(cell)).is_some();
    // `t,a` are names, though `a` is a unit of current.
    let telling = |cell: &String| Unit::of(unbracketed(cell)).is_some_and(|unit| unit.kind.is_recorded());
    cells.iter().all(|cell| cell.is_empty() || cell == "-" || unit(cell)) && cells.iter().any(telling)
}

impl Layout {
    /// Returns whether some cells are units, and no other one is a number, or a name that says something.
    fn some_units(&self, cells: &[String]) -> bool {
        let is_unit = |cell: &&String| Unit::of(unbracketed(cell)).is_some_and(|unit| unit.kind.is_recorded());
        let telling = |cell: &String| {
            let heading = Heading::of(cell);
            heading.spelled.as_ref().is_some_and(|unit| *unit != heading.name) || heading.names_time_or_acceleration()
        };
        let said = |cell: &&String| self.form.number(cell).is_some() || !is_unit(cell) && telling(cell);
        cells.iter().any(|cell| is_unit(&cell)) && !cells.iter().any(|cell| said(&cell))
    }
}
