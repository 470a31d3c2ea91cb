//! This module writes tables and sentences that are no wider than the terminal.

use std::io::{self, IsTerminal, Write};
use std::ops::Range;
use std::sync::OnceLock;

use unicode_width::UnicodeWidthStr;

/// The number of columns where there is no terminal, and the least number that tables are made for.
const WIDTH: usize = 100;
const LEAST_WIDTH: usize = 60;
/// The least width of a column of numbers.
const LEAST: usize = 13;

/// The width of the terminal that the process of the command writes to.
static TERMINAL: OnceLock<usize> = OnceLock::new();

/// Notes that the process is the command's own: its terminal is that of the tables.
pub(crate) fn own_process() {
    let stdout = io::stdout();
    let size = Some(&stdout).filter(|out| out.is_terminal()).and_then(terminal_size::terminal_size_of);
    if let Some((terminal_size::Width(width), _)) = size {
        let _ = TERMINAL.set(usize::from(width).max(LEAST_WIDTH));
    }
}

/// Returns the number of columns of the terminal.
pub(crate) fn width() -> usize {
    TERMINAL.get().copied().unwrap_or(WIDTH)
}

/// Rows of cells, of which the first are headings. Columns that are too many for the terminal follow below, next to the first ones again.
pub(crate) struct Table {
    /// The number of columns that stand in each part of the table.
    pub(crate) keys: usize,
    /// The number of rows that are headings.
    pub(crate) headings: usize,
    /// The number of columns that are text, set to the left; all others are set to the right.
    pub(crate) texts: usize,
    /// True where the last column is text as well.
    pub(crate) last_is_text: bool,
    /// The least width of a column.
    pub(crate) least: usize,
    pub(crate) rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        self.within(width(), out)
    }

    fn within(&self, width: usize, out: &mut dyn Write) -> io::Result<()> {
        let count = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let last_text = |i: usize| self.last_is_text && i + 1 == count;
        let own = |i: usize| self.rows.iter().filter_map(|row| row.get(i)).map(|cell| cell.width()).max().unwrap_or(0);
        let of = |i: usize| if i < self.texts || last_text(i) { own(i) } else { own(i).max(self.least) };
        let widths: Vec<usize> = (0..count).map(of).collect();
        for (n, block) in blocks(&widths, self.keys, width).into_iter().enumerate() {
            if n > 0 {
                writeln!(out)?;
            }
            for (k, row) in self.rows.iter().enumerate() {
                // A part of the table in which a row has no cells goes without the row.
                let cell = |i: usize| row.get(i).map_or("", String::as_str);
                if k >= self.headings && n > 0 && block.clone().all(|i| cell(i).is_empty()) {
                    continue;
                }
                let mut line = String::new();
                for i in (0..self.keys).chain(block.clone()) {
                    let gap = if line.is_empty() { "" } else { "  " };
                    let fill = " ".repeat(widths[i] - cell(i).width());
                    let parts =
                        if i < self.texts || last_text(i) { [cell(i), &fill] } else { [fill.as_str(), cell(i)] };
                    line.extend([gap, parts[0], parts[1]]);
                }
                writeln!(out, "{}", line.trim_end())?;
            }
        }
        Ok(())
    }
}

/// Returns the columns after the first `keys`, in as many blocks as are needed, each next to the first ones once more; one column at least.
fn blocks(widths: &[usize], keys: usize, width: usize) -> Vec<Range<usize>> {
    let first: usize = widths.iter().take(keys).map(|w| w + 2).sum();
    let (mut blocks, mut used) = (Vec::from([Range { start: keys, end: keys }]), first);
    for (i, wide) in widths.iter().enumerate().skip(keys) {
        let last = blocks.len() - 1;
        // Between columns are two blanks.
        if used + wide > width && !blocks[last].is_empty() {
            blocks.push(i..i);
            used = first;
        }
        used += wide + 2;
        if let Some(block) = blocks.last_mut() {
            block.end = i + 1;
        }
    }
    blocks
}

/// Writes rows of numbers under heads, which are names and units, in blocks that fit the terminal, each next to the first cells once more.
pub(crate) fn rows<R: Iterator<Item = (String, Vec<String>)>>(
    out: &mut dyn Write,
    first: &str,
    heads: &[(String, &str)],
    rows: impl Fn() -> R,
) -> io::Result<()> {
    for (n, part) in parts(first.len(), heads).into_iter().enumerate() {
        if n > 0 {
            writeln!(out)?;
        }
        let heads = &heads[part.clone()];
        line(out, first, heads, heads.iter().map(|(name, _)| name.as_str()))?;
        line(out, &" ".repeat(first.len()), heads, heads.iter().map(|(_, unit)| *unit))?;
        for (first, cells) in rows() {
            line(out, &first, heads, cells[part.start..].iter())?;
        }
    }
    Ok(())
}

/// Returns the columns of numbers under these heads, which are names and units, in blocks that fit the terminal next to a first cell.
fn parts(first: usize, heads: &[(String, &str)]) -> Vec<Range<usize>> {
    let widths: Vec<usize> = heads.iter().map(of_head).collect();
    // A blank stands before each.
    let widths: Vec<usize> = std::iter::once(first).chain(widths.into_iter().map(|w| w.saturating_sub(1))).collect();
    blocks(&widths, 1, width()).into_iter().map(|block| block.start - 1..block.end - 1).collect()
}

fn of_head((name, unit): &(String, &str)) -> usize {
    name.chars().count().max(unit.chars().count()).max(LEAST)
}

/// Writes a line of a table: its first cell as it stands, the others below `heads`, which are names and units, to the right.
pub(crate) fn line<S: AsRef<str>>(
    out: &mut dyn Write,
    first: &str,
    heads: &[(String, &str)],
    cells: impl Iterator<Item = S>,
) -> io::Result<()> {
    write!(out, "{first}")?;
    for (cell, head) in cells.zip(heads) {
        let width = of_head(head);
        write!(out, " {:>width$}", cell.as_ref())?;
    }
    writeln!(out)
}

/// Writes a sentence after its first words, below which its further lines stand.
pub(crate) fn sentence(out: &mut dyn Write, first: &str, text: &str) -> io::Result<()> {
    let indent = " ".repeat(first.width().min(13));
    let mut line = first.to_owned();
    let mut empty = true;
    for word in text.split(' ') {
        if !empty && line.width() + 1 + word.width() > width() {
            writeln!(out, "{line}")?;
            (line, empty) = (indent.clone(), true);
        }
        if !empty {
            line.push(' ');
        }
        line.push_str(word);
        empty = false;
    }
    writeln!(out, "{line}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(width: usize) -> String {
        let row = |cells: [&str; 5]| cells.map(str::to_owned).to_vec();
        let rows =
            vec![row(["part", "limit", "allowed", "demand", "bound"]), row(["display", "rattle", "6 mm", "14 mm", ""])];
        let table = Table { keys: 2, headings: 1, texts: 2, last_is_text: false, least: 8, rows };
        let mut out = Vec::new();
        table.within(width, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn columns_that_do_not_fit_follow_below_beside_the_keys() {
        let whole = "part     limit    allowed    demand     bound\ndisplay  rattle      6 mm     14 mm\n";
        assert_eq!(table(45), whole);
        // The table has one column less: the last one stands below, without the rows that are empty there.
        let folded =
            "part     limit    allowed    demand\ndisplay  rattle      6 mm     14 mm\n\npart     limit      bound\n";
        assert_eq!(table(44), folded);
        assert_eq!(table(1).lines().filter(|line| line.contains("display")).count(), 2);
    }

    #[test]
    fn sentences_are_broken_between_words() {
        let mut out = Vec::new();
        sentence(&mut out, "  note: ", &"word ".repeat(60)).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(text.lines().all(|line| line.len() <= WIDTH) && text.lines().count() == 4, "{text}");
        assert!(text.lines().skip(1).all(|line| line.starts_with("        word") || line.trim().is_empty()), "{text}");
    }
}
