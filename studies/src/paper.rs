//! The results that the paper prints, compared with those of clatter: Table 1 and every statement about the results.
//!
//! Source: "Safe zones for shock-protection of fragile components during impact-induced clatter".

pub(crate) mod claims;
mod page;
pub(crate) mod table;

pub use claims::{Claim, Kind, Measured, Verdict, claims};
pub(crate) use page::Data;

use clatter::design::DESIGNS;
use clatter::{Bar, Count, Error, Start, Summary};

/// A row of Table 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RowKind {
    /// Safe zone of a threshold in v0, in per cent of the bar, not clipped.
    SafeZone(f64),
    /// Largest velocity shock at the ends, in v0.
    PeakEnd,
    /// Largest change of angular velocity, in v0/L.
    PeakAngular,
    /// Net change of velocity at the center, in v0.
    NetCenter,
    /// Number of impacts.
    Impacts,
}

/// The agreement of a printed number with the computed one. It is computed; see [`Agreement::of`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Agreement {
    /// Every printed digit is right, rounded to nearest.
    Rounded,
    /// The further digits were cut off where rounding gives another last digit.
    Truncated,
    /// The value lies outside 0 to 100 % and was printed as the nearer bound.
    Clipped,
    /// None of these.
    Disagrees,
}

impl Agreement {
    /// Compares `printed`, a decimal number with or without a per cent sign, with `value` in the same unit.
    ///
    /// ```
    /// use clatter_studies::paper::Agreement;
    /// assert_eq!(Agreement::of("28.8%", 28.8267), Agreement::Rounded);
    /// assert_eq!(Agreement::of("90.9%", 90.9868), Agreement::Truncated);
    /// assert_eq!(Agreement::of("100%", 114.97), Agreement::Clipped);
    /// assert_eq!(Agreement::of("1.8", 1.7), Agreement::Disagrees);
    /// ```
    #[must_use]
    pub fn of(printed: &str, value: f64) -> Self {
        let number = printed.trim_end_matches('%');
        let decimals = number.split_once('.').map_or(0, |(_, after)| after.len());
        let exact = format!("{value:.60}"); // longer than the digits that decide
        let kept = exact.find('.').map_or(exact.len(), |dot| if decimals == 0 { dot } else { dot + 1 + decimals });
        if format!("{value:.decimals$}") == number {
            Self::Rounded
        } else if printed.ends_with('%')
            && !(0.0..=100.0).contains(&value)
            && format!("{:.decimals$}", value.clamp(0.0, 100.0)) == number
        {
            Self::Clipped
        } else if exact.get(..kept) == Some(number) {
            Self::Truncated
        } else {
            Self::Disagrees
        }
    }
}

/// One number of Table 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Value as printed.
    pub printed: &'static str,
    /// Value as computed, in the printed unit.
    pub value: f64,
    /// Agreement of the two.
    pub agreement: Agreement,
}

/// One row of Table 1, a cell for each of [`DESIGNS`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Quantity of the row.
    pub kind: RowKind,
    /// The four designs.
    pub cells: [Cell; 4],
}

/// Returns Table 1: the printed values, the computed values, and their agreement.
///
/// ```
/// use clatter_studies::paper::{Agreement, RowKind, table1};
/// let table = table1()?;
/// let zone = table.iter().find(|row| row.kind == RowKind::SafeZone(2.0)).unwrap().cells[0];
/// assert_eq!((zone.printed, zone.agreement), ("90.9%", Agreement::Truncated)); // 2 · 2/2.145 − 0.5 over 1.5 is 0.90987
/// # Ok::<(), clatter::Error>(())
/// ```
///
/// # Errors
/// None in practice: the designs are valid.
pub fn table1() -> Result<[Row; 7], Error> {
    let rows = [
        (RowKind::SafeZone(0.5), ["0%", "10.1%", "9.6%", "8.2%"]),
        (RowKind::SafeZone(1.0), ["28.8%", "35.7%", "39.1%", "43.8%"]),
        (RowKind::SafeZone(2.0), ["90.9%", "87.1%", "97.9%", "100%"]),
        (RowKind::PeakEnd, ["2.145", "2.251", "2.036", "1.790"]),
        (RowKind::PeakAngular, ["1.609", "1.947", "1.7", "1.405"]),
        (RowKind::NetCenter, ["1.115", "1.0", "1.0", "1.0"]),
        (RowKind::Impacts, ["4", "16", "31", "24"]),
    ];
    let designs = DESIGNS.map(|[q, e]| Bar::new(q, e).map(|bar| (bar, bar.summary(&Start::default()))));
    let [a, b, c, d] = designs;
    let designs = [a?, b?, c?, d?];
    Ok(rows.map(|(kind, printed)| Row {
        kind,
        cells: std::array::from_fn(|i| {
            let value = cell(kind, &designs[i].0, &designs[i].1);
            Cell { printed: printed[i], value, agreement: Agreement::of(printed[i], value) }
        }),
    }))
}

/// Returns the value of one cell, in the printed unit.
#[expect(clippy::cast_precision_loss, reason = "the table's counts are below 100")]
fn cell(kind: RowKind, bar: &Bar, summary: &Summary) -> f64 {
    match kind {
        RowKind::SafeZone(threshold) => 100.0 * bar.shocks_either(&Start::default()).safe_zone(threshold).s,
        RowKind::PeakEnd => summary.peak.end,
        RowKind::PeakAngular => summary.peak.angular,
        RowKind::NetCenter => summary.net.map_or(f64::NAN, |net| net.center),
        RowKind::Impacts => match summary.count {
            Count::Finite(n) => n as f64,
            Count::Huge(n) => n,
            Count::Endless => f64::INFINITY,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agreement_is_told_apart_at_the_last_digit() {
        for (printed, value, want) in [
            ("1.7", 1.749, Agreement::Rounded),
            ("1.7", 1.751, Agreement::Truncated),
            ("1.7", 1.651, Agreement::Rounded),
            ("1.7", 1.649, Agreement::Disagrees),
            ("0%", -2.25, Agreement::Clipped),
            ("0%", 0.3, Agreement::Rounded),
            ("0", -0.7, Agreement::Disagrees),
            ("100%", 100.4, Agreement::Rounded),
            ("16", 16.0, Agreement::Rounded),
            ("16", f64::INFINITY, Agreement::Disagrees),
            ("16", f64::NAN, Agreement::Disagrees),
        ] {
            assert_eq!(Agreement::of(printed, value), want, "{printed} and {value}");
        }
    }

    #[test]
    fn only_one_cell_is_truncated_and_two_are_clipped() {
        let cells: Vec<_> = table1().unwrap().iter().flat_map(|row| row.cells).collect();
        let printed = |kind| cells.iter().filter(|c| c.agreement == kind).map(|c| c.printed).collect::<Vec<_>>();
        assert_eq!(printed(Agreement::Truncated), ["90.9%"]);
        assert_eq!(printed(Agreement::Clipped), ["0%", "100%"]);
        assert_eq!(printed(Agreement::Disagrees), Vec::<&str>::new());
    }
}
