//! One channel that goes on from line to line, several values each, as strong-motion files have it.

use std::borrow::Cow;

use clatter_shock::samples::float;

use super::cells::Form;
use super::encoding::Letters;
use super::head;
use super::rows::{Rows, Shape};
use crate::decimal::Decimal;
use crate::heading::Heading;
use crate::roles::{Preview, Roles};
use crate::{Error, Options};

/// Lines of a head that are looked at.
const HEAD: usize = 60;

/// One channel in lines of several values, by its head.
#[derive(Debug)]
pub(super) struct Series {
    /// The first line of values, from 0.
    begin: usize,
    count: usize,
    step_s: f64,
    unit: Option<String>,
}

/// Of a head that says how many values there are, as NPTS, and the time between them, as DT.
pub(super) fn of(lines: &[String]) -> Option<Series> {
    let (at, count, step_s) = lines.iter().take(HEAD).enumerate().find_map(|(i, line)| {
        let line = line.to_uppercase();
        let value = |key: &str| {
            let rest = &line[line.find(key)? + key.len()..];
            let rest = rest.trim_start_matches([' ', '=', ':']);
            let (number, _) = Decimal::scan(rest.as_bytes(), b'.')?;
            Some(number.float())
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is whole and in this range")]
        let count = value("NPTS")
            .filter(|count| count.fract() == 0.0 && (1.0..1e9).contains(count))
            .map(|count| count as usize);
        Some((i, count?, value("DT=").or_else(|| value("DT ")).filter(|step_s| *step_s > 0.0)?))
    })?;
    let begin = (at + 1..lines.len()).find(|i| head::numbers(&apart(&lines[*i])) > 0)?;
    let unit = lines[..begin].iter().find_map(|line| {
        let line = line.to_uppercase();
        let at = line.find("UNITS OF ")?;
        Some(line[at + "UNITS OF ".len()..].split([',', ';']).next().unwrap_or_default().trim().to_owned())
    });
    Some(Series { begin, count, step_s, unit })
}

/// A line in which numbers of fixed width may touch, parted before each sign that is none of a power.
fn apart(line: &str) -> String {
    let mut text = String::with_capacity(line.len() + 8);
    let mut before = ' ';
    for c in line.chars() {
        if matches!(c, '-' | '+') && (before.is_ascii_digit() || before == '.') {
            text.push(' ');
        }
        text.push(c);
        before = c;
    }
    text
}

impl Series {
    /// The values of the channel.
    pub(super) fn read(self, text: &[u8], options: &Options) -> Result<(Rows, Roles), Error> {
        let heading = Heading::named_alone("acceleration").with_unit(self.unit.as_deref().unwrap_or_default());
        let seen = Preview { headings: vec![heading], named: true, sampled: true, ..Preview::default() };
        let roles = seen.roles(options)?;
        let shape = Shape { sampled_s: Some([0.0, self.step_s]), columns: 1, ..Shape::default() };
        let mut rows = Rows::new(shape, &roles, options);
        let lines: Vec<String> = text.split(|byte| *byte == b'\n').map(|line| Letters::default().text(line)).collect();
        rows.skip_heading(&lines[..self.begin]);
        for line in &lines[self.begin..] {
            rows.values(&apart(line))?;
        }
        let found = rows.channels[0].len();
        if found != self.count {
            return Err(Error::File(format!(
                "the head says NPTS = {}, and there are {found} values below it",
                self.count
            )));
        }
        rows.close()?;
        Ok((rows, roles))
    }
}

/// Refuses lines without names whose numbers go on from line to line as one channel does: the step over the end of a line is like
/// those within it, and far below those from line to line.
pub(super) fn refuse_lines(rows: &[Vec<f64>], all: &[Vec<Cow<'_, str>>], form: Form) -> Result<(), Error> {
    let count = rows.first().map_or(0, Vec::len);
    let first_rises = rows.windows(2).all(|pair| pair[0].first() < pair[1].first());
    if count < 2 || first_rises && rows.len() > 2 {
        return Ok(());
    }
    let number = |cell: &Cow<'_, str>| form.number(cell).map(Decimal::float);
    // The last line may be short.
    let full = all.iter().filter(|row| row.len() == count);
    let rows: Vec<Vec<f64>> = full.filter_map(|row| row.iter().map(number).collect()).collect();
    if rows.len() < 4 || rows.len() + 1 < all.len() {
        return Ok(());
    }
    let mean = |steps: &[f64]| steps.iter().sum::<f64>() / float(steps.len().max(1));
    let within: Vec<f64> = rows.iter().flat_map(|row| row.windows(2).map(|pair| (pair[1] - pair[0]).abs())).collect();
    let over: Vec<f64> = rows.windows(2).map(|pair| (pair[1][0] - pair[0][count - 1]).abs()).collect();
    let down: Vec<f64> =
        rows.windows(2).flat_map(|pair| (0..count).map(|column| (pair[1][column] - pair[0][column]).abs())).collect();
    let (within, over, down) = (mean(&within), mean(&over), mean(&down));
    if over > 0.0 && over <= 2.0 * within && within < 0.6 * down {
        return Err(Error::Columns(format!(
            "the {count} numbers of each line look like one channel that goes on from line to line: write one value a line, or, \
             where they are channels, name them in a line above"
        )));
    }
    Ok(())
}
