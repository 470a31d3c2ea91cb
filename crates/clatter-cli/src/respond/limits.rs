//! This module shows the demand of one drop on the limits of a part of a product file, in the form of an assessment.

use std::io::{self, Write};

use clatter_answer::Json;
use clatter_answer::respond::Limit;
use clatter_product::{LimitKind, Unit};

use crate::columns::Table;
use crate::one_drop::PartSetup;
use crate::quantities::Show;
use crate::text::shown;
use crate::words::in_words;

/// Writes the table; it shows `axes` coordinates of each place.
pub(super) fn table(
    part: &PartSetup,
    limits: &[Limit],
    axes: usize,
    time: Show,
    out: &mut dyn Write,
) -> io::Result<()> {
    let (title, when) = (format!("Limits of {}", shown(&part.name, 24)), format!("when, {}", time.name()));
    let mut rows = vec![[&title, "value", "allowed", "of limit", "at", &when, ""].map(str::to_owned).to_vec()];
    for row in limits {
        let name = format!("  {}", row.limit.name());
        let (Some(value), Some(share), Some(time_s), Some(impact)) = (row.value, row.share, row.time_s, row.impact)
        else {
            rows.push(vec![name, "-".to_owned()]);
            continue;
        };
        let words = |value: Json| in_words(row.unit, part.limits.unit(row.limit, row.unit), value.0);
        let place = if row.limit == LimitKind::AngularVelocityChange {
            "-".to_owned()
        } else {
            let along = |(axis, m): (usize, &Json)| in_words(Unit::Meter, part.units.get(axis).copied().flatten(), m.0);
            row.position_m[..axes].iter().enumerate().map(along).collect::<Vec<_>>().join(", ")
        };
        let over = if share.0 > 1.0 { ", EXCEEDED" } else { "" };
        let (at, impact) = (time.figures(time_s.0), format!("impact {impact}{over}"));
        let share = format!("{:.1} %", 100.0 * share.0);
        rows.push(vec![name, words(value), words(row.allowed), share, place, at, impact]);
    }
    writeln!(out)?;
    Table { keys: 1, headings: 1, texts: 1, last_is_text: true, least: 8, rows }.write(out)
}
