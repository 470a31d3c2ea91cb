//! The numbers of the accuracy page, as they are printed.

use clatter::accuracy::{APPROACH, Allowance, DURATION, DURATION_LONG, FINAL, JUMP, NEAR_ENDLESS, PEAK, TABLE, TIME};
use clatter_shock::accuracy::{FREE, PULSE, RECORD, TRAIN};
use serde_json::{Value, json};

use super::digits::inputs;
use super::display::{count, counted, error_cell, pair, power, start, upper, written};
use super::{Data, STRIKES, flight, part};
use crate::files::decimals;
use part::Cell;

impl Data {
    /// Returns each allowance, and the extreme that comes nearest to it.
    fn allowances(&self) -> Vec<Value> {
        let shown = |a: Allowance, worst: Option<(f64, String)>| {
            let (error, at) = worst.unwrap_or((f64::NAN, String::new()));
            json!({
                "quantity": a.quantity, "scale": a.scale, "range": a.range,
                "allowed": power(a.error), "measured": upper(error), "at": at,
            })
        };
        let larger = |a: (f64, String), b: (f64, String)| if b.0 > a.0 { b } else { a };
        let of_train = |a: Allowance| {
            let compared = self.trains.iter().flat_map(|row| row.ours.compared.iter().map(move |j| (row, j)));
            let errors = compared.filter(|(_, j)| j.allowed == Some(a));
            errors.filter_map(|(row, j)| Some((j.error?, row.case.name.to_owned()))).reduce(larger)
        };
        // An allowance that is larger at one extreme is divided out.
        let of_part = |a: Allowance, axis: &str, at: &[&str], lines: &[part::Line]| {
            let cells = lines.iter().flat_map(|line| {
                line.cells.iter().zip(at).filter_map(move |(cell, at)| Some((line.zeta, cell.as_ref()?, at)))
            });
            let shown = |(zeta, cell, at): (&str, &Cell, &&str)| {
                (cell.ours * a.error / cell.allowed, format!("ζ = {zeta}, {axis} = {at}"))
            };
            cells.map(shown).reduce(larger)
        };
        let part = &self.part;
        let clatters = (part.clatters.ours, format!("{} parts", part.parts));
        TABLE
            .into_iter()
            .map(|a| shown(a, of_train(a)))
            .chain([
                shown(FREE, of_part(FREE, "ωt", &part::FREE_AT.map(|at| at.0), &part.free)),
                shown(PULSE, of_part(PULSE, "ωD", &part::PULSE_AT.map(|at| at.0), &part.pulse)),
                shown(TRAIN, Some(clatters)),
                shown(RECORD, of_part(RECORD, "f/fₛ", &part::RECORD_AT.map(|at| at.0), &part.record)),
            ])
            .collect()
    }

    /// Returns every number on the page.
    pub(super) fn numbers(&self) -> Value {
        let allowances = self.allowances();
        let orders = self.flights.orders.iter().map(|o| {
            let (last, difference) = o.steps.last().copied().unwrap_or((f64::NAN, f64::NAN));
            json!({
                "model": o.model, "limit": o.limit, "parameter": o.parameter, "compared": o.compared,
                "expected": decimals(o.expected, 0), "measured": decimals(o.measured(), 4),
                "at": power(last), "difference": power(difference),
            })
        });
        let residues = self.flights.residues.iter();
        let residues = residues
            .map(|r| json!({ "compared": r.compared, "allowed": power(r.allowed), "measured": upper(r.value) }));
        let flights = self.flights.models.iter().map(|(model, flight)| {
            let strikes = flight.strikes.iter().take(STRIKES).map(|s| {
                let end = if s.point == 0 { "a" } else { "b" };
                json!([end, decimals(s.time_s / self.flights.unit_s, 4)])
            });
            json!({ "model": model, "strikes": strikes.collect::<Vec<_>>() })
        });
        let steps = self.flights.steps.iter().map(|step| {
            let errors = [step.time, step.approach, step.shock].map(upper);
            json!({ "law": step.law, "precision": step.precision, "errors": errors, "phases": step.phases })
        });
        let trains = self.trains.iter().map(|row| {
            let ways = [("ours", &row.ours), ("recurrence", &row.recurrence), ("closed form", &row.closed)];
            let ways = ways.map(|(name, way)| {
                let cells = way.compared.iter().map(error_cell);
                let cells: Vec<_> = std::iter::once(counted(row.exact, way)).chain(cells).collect();
                json!({ "way": name, "cells": cells })
            });
            json!({
                "name": row.case.name, "at": inputs(&row.case), "start": start(&row.case),
                "count": count(row.exact), "ways": ways,
            })
        });
        let part = |lines: &[part::Line], at: &[&str]| {
            let lines = lines.iter().map(|line| {
                let cells = line.cells.iter().map(|cell| cell.as_ref().map(pair));
                json!({ "zeta": line.zeta, "cells": cells.collect::<Vec<_>>() })
            });
            json!({ "at": at, "lines": lines.collect::<Vec<_>>() })
        };
        let lines = self.lines.iter().map(|line| {
            json!({
                "what": line.what, "at": line.at, "formula": line.formula,
                "exact": written(&line.exact, &line.exact), "ours": written(&line.exact, &line.ours),
                "plain": written(&line.exact, &line.plain),
            })
        });
        let allowed = [PEAK, APPROACH, JUMP, TIME, FINAL, DURATION].map(|a| power(a.error));
        json!({
            "allowances": allowances,
            "orders": orders.collect::<Vec<_>>(),
            "residues": residues.collect::<Vec<_>>(),
            "flights": flights.collect::<Vec<_>>(),
            "contact": power(self.flights.contact_s / self.flights.unit_s),
            "precision": json!({
                "steps": steps.collect::<Vec<_>>(), "strikes": flight::COMPARED, "tilt": decimals(flight::STEEP_DEG, 0),
                "contact_ms": decimals(1e3 * flight::LONG_CONTACT_S, 1),
            }),
            "allowed": allowed,
            "allowed_long": power(DURATION_LONG.error),
            "allowed_edge": power(NEAR_ENDLESS.error),
            "trains": trains.collect::<Vec<_>>(),
            "free": part(&self.part.free, &part::FREE_AT.map(|at| at.0)),
            "free_allowed": upper(FREE.error),
            "pulse": part(&self.part.pulse, &part::PULSE_AT.map(|at| at.0)),
            "pulse_allowed": power(PULSE.error),
            "record": part(&self.part.record, &part::RECORD_AT.map(|at| at.0)),
            "record_allowed": power(RECORD.error),
            "clatters": json!({
                "parts": self.part.parts, "allowed": power(self.part.clatters.allowed), "measured": upper(self.part.clatters.ours),
            }),
            "lines": lines.collect::<Vec<_>>(),
        })
    }
}
