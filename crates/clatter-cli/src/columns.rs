//! Columns of numbers under their headings.

use std::io::{self, Write};

/// Columns are no narrower.
const LEAST: usize = 13;

/// A line of a table: its first cell as it stands, the others below `heads`, which are names and units, to the right.
pub(crate) fn line<S: AsRef<str>>(
    out: &mut dyn Write,
    first: &str,
    heads: &[(String, &str)],
    cells: impl Iterator<Item = S>,
) -> io::Result<()> {
    write!(out, "{first}")?;
    for (cell, (name, unit)) in cells.zip(heads) {
        let width = name.chars().count().max(unit.chars().count()).max(LEAST);
        write!(out, " {:>width$}", cell.as_ref())?;
    }
    writeln!(out)
}
