//! Accuracy of the results: the data of the accuracy report, and its files.
//!
//! Everything is measured when the report is made, against the same equations in 512 binary digits.

mod big;
mod digits;
mod display;
mod flight;
mod numbers;
mod part;
mod plain;
mod train;

use crate::figures::{OrderPanel as Panel, orders as figure};
use clatter_report::File;
use digits::inputs;
use flight::Flights;
use part::Part;
use rayon::prelude::*;
use train::{Found, Row};

use crate::Error;
use crate::files::csv;
use crate::files::pretty;

/// All data of the report.
#[derive(Debug)]
pub(crate) struct Data {
    flights: Flights,
    trains: Vec<Row>,
    part: Part,
    lines: Vec<digits::Line>,
}

/// One error at one extreme, as the accuracy report prints it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Measured {
    /// The computed subject: a train, free motion, a pulse, a record, a model.
    pub subject: &'static str,
    /// The extreme.
    pub extreme: String,
    /// The quantity.
    pub quantity: &'static str,
    /// The allowed error, relative to the scale in `clatter::accuracy` and `clatter_shock::accuracy`; `None` where
    /// nothing is promised.
    pub allowed: Option<f64>,
    /// The error of this library; `None` where the quantity has no value.
    pub measured: Option<f64>,
    /// The errors of a plain recurrence in f64, and of a plain closed form: infinite where they give no result.
    pub plain: [Option<f64>; 2],
}

/// The quantities of a train, as heads of the columns.
const COLUMNS: [&str; 6] = ["peak", "approach", "jump", "time", "final", "duration"];
/// Number of strikes that are shown of the flights.
const STRIKES: usize = 5;

/// Returns every error of the accuracy report, measured anew.
///
/// ```
/// for row in clatter_studies::measured()? {
///     let (Some(allowed), Some(error)) = (row.allowed, row.measured) else { continue };
///     assert!(error <= allowed, "{row:?}");
/// }
/// # Ok::<(), clatter_studies::Error>(())
/// ```
///
/// # Errors
/// None in practice: all cases are valid.
pub fn measured() -> Result<Vec<Measured>, Error> {
    Ok(Data::compute()?.measured())
}

impl Data {
    /// Computes everything, in parallel.
    pub(crate) fn compute() -> Result<Self, Error> {
        let (flights, (trains, part)) = rayon::join(Flights::compute, || {
            let rows = || train::cases().par_iter().map(Row::new).collect::<Result<Vec<_>, _>>();
            rayon::join(rows, Part::compute)
        });
        let trains = trains?;
        let lines = digits::lines(&trains)?;
        Ok(Self { flights: flights?, trains, part: part?, lines })
    }

    /// Returns the figure as SVG, numbers as JSON, errors as CSV.
    pub(crate) fn files(&self) -> Result<Vec<File>, Error> {
        let of = |parameter: &str| {
            let chosen = self.flights.orders.iter().filter(|order| order.parameter.starts_with(parameter));
            chosen.map(|order| (order, format!("{} to {}", order.model, order.limit))).collect()
        };
        let panels = [
            Panel { title: "tilt *φ* in degrees", guide: "slope 2", curves: of("tilt") },
            Panel { title: "*G* = *gh*_0/*v*_0²", guide: "slope 1", curves: of("g h0") },
            Panel { title: "contact time over *h*_0/*v*_0", guide: "slope 1", curves: of("contact") },
        ];
        Ok(vec![
            ("accuracy-orders.svg", figure(&panels)?),
            ("accuracy.json", pretty(&self.numbers())?),
            ("accuracy.csv", table(&self.measured())),
        ])
    }

    /// Returns every error, one after the other.
    fn measured(&self) -> Vec<Measured> {
        let mut rows = Vec::new();
        for row in &self.trains {
            let extreme = format!("{}: {}", row.case.name, inputs(&row.case));
            let ways = [&row.ours, &row.recurrence, &row.closed];
            let [ours, recurrence, closed] = ways.map(|way| miscount(row.exact, way.found));
            rows.push(Measured {
                subject: "train",
                extreme: extreme.clone(),
                quantity: "count",
                allowed: Some(0.0),
                measured: ours,
                plain: [recurrence, closed],
            });
            for (k, quantity) in COLUMNS.into_iter().enumerate() {
                let [ours, recurrence, closed] = ways.map(|way| way.compared[k]);
                rows.push(Measured {
                    subject: "train",
                    extreme: extreme.clone(),
                    quantity,
                    allowed: ours.allowed.map(|a| a.error),
                    measured: ours.error,
                    plain: [recurrence.error, closed.error],
                });
            }
        }
        let mut cells = |[subject, quantity]: [&'static str; 2], axis: &str, at: &[&str], lines: &[part::Line]| {
            for line in lines {
                for (at, cell) in at.iter().zip(&line.cells) {
                    let Some(cell) = cell else { continue };
                    rows.push(Measured {
                        subject,
                        extreme: format!("ζ = {}, {axis} = {at}", line.zeta),
                        quantity,
                        allowed: Some(cell.allowed),
                        measured: Some(cell.ours),
                        plain: [None, cell.plain],
                    });
                }
            }
        };
        let part = &self.part;
        cells(["free motion", "ωz, z′"], "ωt", &part::FREE_AT.map(|at| at.0), &part.free);
        cells(["half-sine", "ωz, z′ at its end"], "ωD", &part::PULSE_AT.map(|at| at.0), &part.pulse);
        cells(["record", "primary acceleration"], "f/fs", &part::RECORD_AT.map(|at| at.0), &part.record);
        rows.push(Measured {
            subject: "part in a clatter",
            extreme: format!("{} parts", part.parts),
            quantity: "peak",
            allowed: Some(part.clatters.allowed),
            measured: Some(part.clatters.ours),
            plain: [None, None],
        });
        rows.extend(self.flights.residues.iter().map(|r| Measured {
            subject: "flight",
            extreme: r.compared.into(),
            quantity: "residue",
            allowed: Some(r.allowed),
            measured: Some(r.value),
            plain: [None, None],
        }));
        for step in &self.flights.steps {
            for (quantity, error) in [("time", step.time), ("approach", step.approach), ("shock", step.shock)] {
                rows.push(Measured {
                    subject: "contacts",
                    extreme: format!("{}, precision {}", step.law, step.precision),
                    quantity,
                    allowed: None,
                    measured: Some(error),
                    plain: [None, None],
                });
            }
        }
        rows
    }
}

/// Returns the error of a count: 0 if it is right, infinite if it is of another kind.
fn miscount(exact: Found, found: Found) -> Option<f64> {
    match (exact, found) {
        (_, Found::Open) => None,
        #[expect(clippy::cast_precision_loss, reason = "its size is what is told")]
        (Found::Impacts(n), Found::Impacts(m)) => Some(n.abs_diff(m) as f64 / n as f64),
        (exact, found) => Some(if exact == found { 0.0 } else { f64::INFINITY }),
    }
}

/// Returns the errors in full, one row each.
fn table(rows: &[Measured]) -> String {
    let head = ["subject", "extreme", "quantity", "allowed", "measured", "plain recurrence", "plain closed form"];
    let number = |v: Option<f64>| v.map_or(String::new(), |v| format!("{v:e}"));
    let line = |row: &Measured| {
        let [recurrence, closed] = row.plain.map(number);
        let words = [row.subject.to_owned(), row.extreme.clone(), row.quantity.to_owned()];
        words.into_iter().chain([number(row.allowed), number(row.measured), recurrence, closed]).collect()
    };
    csv(std::iter::once(head.map(String::from).to_vec()).chain(rows.iter().map(line)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_is_within_what_is_allowed() {
        let rows = measured().unwrap();
        assert!(rows.len() > 200, "{} rows", rows.len());
        for row in &rows {
            if let (Some(allowed), Some(error)) = (row.allowed, row.measured) {
                assert!(error <= allowed, "{row:?}");
            }
        }
    }

    #[test]
    fn figures_stay_within_their_frame() {
        let files = Data::compute().unwrap().files().unwrap();
        crate::frame::stay_within_their_frame(&files);
    }
}
