//! Columns of words beside the numbers: names of sensors whose rows come in turns, units, dates.

use std::borrow::Cow;

use super::cells::Form;
use super::layout::Layout;
use super::visible;
use crate::moment::{self, CLOCK, DATED};
use crate::roles::{Preview, Roles};
use crate::unit::{Unit, lists};
use crate::{Error, Options};

/// A column in which one word has to stand in every line.
#[derive(Debug, Clone)]
pub(super) struct Word {
    pub(super) column: usize,
    pub(super) expected: String,
    /// Tells whether it tells sensors apart; else it is a unit.
    pub(super) tells: bool,
    /// Tells whether rows of other sensors are passed over, as one was asked for.
    pub(super) chosen: bool,
}

/// Names of columns that tell sensors apart.
const SENSORS: &str = "\
    sensor sensortype sensorname sensorid device deviceid source tag kanal channel channelid ch type id node nodeid \
    axis imu address addr mac name signal variable quantity parameter";
const UNITS: &str = "unit units einheit unité unidad uom";
/// Rows that show whether words come in turns.
const LEAST: usize = 6;

/// The columns in which one word has to stand in every line.
pub(super) fn words(layout: &Layout, rows: &[Vec<Cow<'_, str>>], options: &Options) -> Result<Vec<Word>, Error> {
    let mut words = Vec::new();
    let mut listed: Option<String> = None;
    for (column, heading) in layout.headings.iter().enumerate() {
        let cells: Vec<&str> = rows.iter().filter_map(|row| row.get(column)).map(|cell| &**cell).collect();
        let name: String = heading.name.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect();
        let Some(first) = cells.first().filter(|first| !first.is_empty()) else { continue };
        let word = |expected: &str, tells, chosen| Word { column, expected: expected.to_owned(), tells, chosen };
        if heading.is_text && lists(UNITS, &name) && Unit::of(first).is_some() {
            words.push(word(first, false, false));
            continue;
        }
        let is_named = lists(SENSORS, &name);
        let changes = cells.windows(2).filter(|pair| pair[0] != pair[1]).count();
        let mut all: Vec<&str> = Vec::new();
        for cell in &cells {
            if !all.contains(cell) && all.len() <= MOST {
                all.push(cell);
            }
        }
        let is_word = |cell: &&str| !cell.is_empty() && moment::seconds(cell, layout.form.order).is_none();
        let in_turns = cells.len() >= LEAST && all.len() > 1 && all.len() <= MOST && 4 * changes >= cells.len();
        let is_sensor =
            heading.is_text && (in_turns || is_named || !layout.named) || is_named && all.len() <= MOST && in_turns;
        if !is_sensor || !all.iter().all(is_word) {
            continue;
        }
        if let Some(asked) = &options.sensor {
            match all.iter().find(|name| name.eq_ignore_ascii_case(asked)) {
                Some(found) => words.push(word(found, true, true)),
                None => listed = Some(list(&all)),
            }
            continue;
        }
        let is_keyed = |cell: &&str| cell.split_once('=').is_some_and(|(_, value)| layout.form.number(value).is_some());
        if all.iter().all(is_keyed) {
            return Err(Error::Columns(format!(
                "the numbers of column {} stand behind their names, as in '{}': write them alone, below a line of the names",
                column + 1,
                visible(first)
            )));
        }
        if all.len() > 1 {
            let name = heading.shown();
            let called = if name.is_empty() { String::new() } else { format!(" ({name})") };
            return Err(Error::Columns(format!(
                "rows of several sensors come in turns, by column {}{called}: {}; --sensor=NAME reads those of one",
                column + 1,
                list(&all)
            )));
        }
        words.push(word(first, true, false));
    }
    if let Some(asked) = options.sensor.as_ref().filter(|_| !words.iter().any(|word| word.chosen)) {
        let there = listed.map_or("no column tells sensors apart".to_owned(), |all| format!("there are {all}"));
        return Err(Error::Columns(format!("there are no rows of a sensor '{}': {there}", visible(asked))));
    }
    Ok(words)
}

/// Sensors that a file has at most.
const MOST: usize = 16;

fn list(all: &[&str]) -> String {
    let shown: Vec<String> = all.iter().take(8).map(|name| visible(name)).collect();
    shown.join(", ")
}

/// Units that stand in a column of their own, behind the one that they are of.
pub(super) fn units_beside(layout: &mut Layout, words: &[Word]) {
    for word in words.iter().filter(|word| !word.tells) {
        let before = word.column.checked_sub(1).and_then(|before| layout.headings.get_mut(before));
        if let Some(heading) = before.filter(|heading| heading.spelled.is_none() && !heading.is_text) {
            *heading = heading.clone().with_unit(&word.expected);
        }
    }
}

/// The column of dates beside one of times of day.
pub(super) fn date(seen: &Preview, roles: &Roles, form: Form) -> Option<usize> {
    let digits =
        |column: usize| seen.cells.get(column).and_then(|cell| Some(moment::seconds(cell, form.order)?.digits));
    let (time, _) = roles.time?;
    if digits(time) != Some(CLOCK) || moment::either(&seen.cells[time]).is_some() {
        return None;
    }
    let is_date = |column: &usize| {
        let cell = &seen.cells[*column];
        !cell.contains(':') && (digits(*column) == Some(DATED) || moment::either(cell).is_some())
    };
    (0..seen.cells.len().min(seen.headings.len())).filter(|column| *column != time).find(is_date)
}
