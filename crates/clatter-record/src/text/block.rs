//! Where the numbers of a text are, by one way to separate them.

use std::borrow::Cow;

use super::cells::{Form, is_missing};
use super::layout::{LAST, uncommented};

/// Where numbers are, by one way to separate them.
pub(super) struct Numbers {
    /// The line that they begin with.
    pub(super) begin: usize,
    /// How many columns there are.
    pub(super) count: usize,
    /// Those of numbers.
    pub(super) columns: Vec<usize>,
    /// Cells that are numbers, in 1000 of the last lines.
    pub(super) share: usize,
    /// Tells whether the unit stands behind each number of a column.
    pub(super) measured: Vec<bool>,
    /// Tells whether the first column counts the rows, or is of words none of which comes twice.
    pub(super) counts: bool,
}

/// Where the numbers are.
///
/// The last lines tell what the columns are: as many cells as most have, and those columns that are numbers in most. The
/// numbers begin with the first line that has as many cells and nothing else in those columns; a line right above with a number
/// in the first of them is one too, with a fault.
pub(super) fn begin(lines: &[String], form: Form) -> Option<Numbers> {
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
    let those = |rows: &[(usize, Vec<Cow<'_, str>>)], column: usize, is: &dyn Fn(&str) -> bool| {
        rows.iter().filter(|(_, cells)| cells.len() == columns && is(&cells[column])).count()
    };
    let share_of = |column: usize, is: &dyn Fn(&str) -> bool| 2 * those(last, column, is) >= has(columns);
    let measured: Vec<bool> =
        (0..columns).map(|column| share_of(column, &|cell| form.measured(cell).is_some())).collect();
    let is_data_of =
        |column: usize, cell: &str| form.is_data(cell) || measured[column] && form.measured(cell).is_some();
    let is_filled = |cell: &str| !cell.is_empty();
    let is_number = |column: usize| {
        let is = |cell: &str| is_filled(cell) && is_data_of(column, cell);
        // A channel with times of its own may end before the others.
        match those(last, column, &is_filled) {
            0 => 2 * those(&rows, column, &is) > those(&rows, column, &is_filled),
            _ => share_of(column, &is),
        }
    };
    let numbers: Vec<usize> = (0..columns).filter(|column| is_number(*column)).collect();
    let first = *numbers.first()?;
    let is_empty = |column: &usize| {
        !numbers.contains(column) && last.iter().all(|(_, cells)| cells.get(*column).is_none_or(|cell| cell.is_empty()))
    };
    let empty: Vec<usize> = (0..columns).filter(is_empty).collect();
    let is_data = |cells: &[Cow<'_, str>]| {
        let cell = |column: usize| cells.get(column).map_or("", |cell| cell);
        // Cells at the end may be empty by a fault of one line.
        cells.len() <= columns
            && numbers.iter().all(|column| is_data_of(*column, cell(*column)))
            && numbers.iter().any(|column| !cell(*column).is_empty() && !is_missing(cell(*column)))
            && empty.iter().all(|column| cell(*column).is_empty())
            && cells.len() + 1 >= columns
    };
    let mut i = rows.iter().position(|(_, cells)| is_data(cells))?;
    let starts = |cells: &[Cow<'_, str>]| cells.len() == columns && columns > 1 && form.number(&cells[first]).is_some();
    while i.checked_sub(1).is_some_and(|above| starts(&rows[above].1)) {
        i -= 1;
    }
    // One number apart is none of the lines below.
    let is_text_line = |(_, cells): &(usize, Vec<Cow<'_, str>>)| is_text(cells);
    while rows[i].1.len() < columns && rows.get(i + 1).is_some_and(is_text_line) {
        i = i + 1 + rows[i + 1..].iter().position(|(_, cells)| is_data(cells))?;
    }
    let cells = || last.iter().flat_map(|(_, cells)| cells);
    // A slow channel leaves cells empty.
    let full = cells().filter(|cell| !cell.is_empty()).count().max(1);
    let measured_cells = last.iter().flat_map(|(_, cells)| cells.iter().enumerate());
    let is_measured = |(column, cell): &(usize, &Cow<'_, str>)| {
        measured.get(*column) == Some(&true) && form.measured(cell).is_some() || form.number(cell).is_some()
    };
    let share = 1000 * measured_cells.filter(is_measured).count() / full;
    let names: Vec<&str> = last.iter().filter_map(|(_, cells)| cells.first()).map(|cell| &**cell).collect();
    let number = |name: &&str| form.number(name).map(crate::decimal::Decimal::float);
    let steps = names.windows(2).filter_map(|pair| Some(number(&pair[1])? - number(&pair[0])?));
    let counted = names.len() > 1 && names.iter().all(|name| number(name).is_some_and(|number| number.fract() == 0.0));
    let words = || {
        let distinct: std::collections::HashSet<_> = names.iter().collect();
        distinct.len() == names.len() && names.iter().all(|name| !name.is_empty())
    };
    let counts =
        if counted { steps.into_iter().all(|step| (step - 1.0).abs() < 0.5) } else { !numbers.contains(&0) && words() };
    Some(Numbers { begin: rows[i].0, count: columns, columns: numbers, share, measured, counts })
}
