//! Scales that the driver left for the reader to apply.
//!
//! Source: the properties `NI_Scale[…]`, as npTDMS reads them.

use std::collections::BTreeMap;

use super::{Properties, Property};
use crate::container::refuse;
use crate::{Error, Values};

/// The raw values, as source of a scale; scales have numbers below.
const RAW: usize = u32::MAX as usize;
/// More scales on scales are none of a driver.
const MOST: usize = 100;

/// The values by the scales of the first of these that has any: channel, group, file. Raw data of DAQmx come as their scalers.
pub(super) fn scaled(
    values: Option<Values>,
    scalers: &BTreeMap<u32, Values>,
    sources: &[Option<&Properties>],
    channel: &str,
) -> Result<Values, Error> {
    let raw = |values: Option<Values>| match (values, scalers.len()) {
        (Some(values), _) => Ok(values),
        (None, 1) => Ok(scalers.values().next().cloned().unwrap_or(Values::Float(Vec::new()))),
        (None, count) => Err(refuse(format!(
            "TDMS file: {channel:?} has raw data of DAQmx from {count} sources and no scale that joins them; convert the file \
             with LabVIEW or DIAdem"
        ))),
    };
    let found = sources.iter().flatten().find_map(|properties| Some((*properties, count(properties)?)));
    let Some((properties, count)) = found else { return raw(values) };
    let is_scaled = matches!(properties.get("NI_Scaling_Status"), Some(Property::Text(status)) if status == "scaled");
    if is_scaled || count == 0 {
        return raw(values);
    }
    if count > MOST {
        return Err(refuse(format!("TDMS file: {channel:?} has {count} scales; {MOST} are the most that are read")));
    }
    let scales = Scales { properties, values: values.as_ref(), scalers, channel };
    let mut done = vec![None; count];
    for index in 0..count {
        // A scale takes those before it.
        if scales.is_needed(index, count) {
            done[index] = Some(scales.values(index, &done)?);
        }
    }
    Ok(Values::Float(done.pop().flatten().unwrap_or_default()))
}

/// How many scales there are.
fn count(properties: &Properties) -> Option<usize> {
    if let Some(Property::Number(count)) = properties.get("NI_Number_Of_Scales") {
        return whole(*count);
    }
    let last = |name: &String| {
        let (number, rest) = name.strip_prefix("NI_Scale[")?.split_once(']')?;
        (rest == "_Scale_Type").then(|| number.parse::<usize>().ok()).flatten()
    };
    properties.keys().filter_map(last).max().map(|last| last.saturating_add(1))
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within 0 and 2^32")]
fn whole(number: f64) -> Option<usize> {
    (0.0..=f64::from(u32::MAX)).contains(&number).then_some(number as usize)
}

/// The scales of one channel.
#[derive(Debug)]
struct Scales<'a> {
    properties: &'a Properties,
    values: Option<&'a Values>,
    scalers: &'a BTreeMap<u32, Values>,
    channel: &'a str,
}

fn floats(values: &Values) -> Option<Vec<f64>> {
    if let Values::Float(values) = values { Some(values.clone()) } else { None }
}

impl Scales<'_> {
    fn fault(&self, index: usize, fault: &str) -> Error {
        refuse(format!(
            "TDMS file: scale {index} of {:?} {fault}; convert the file with LabVIEW or DIAdem",
            self.channel
        ))
    }
    fn number(&self, index: usize, name: &str) -> Option<f64> {
        let property = self.properties.get(&format!("NI_Scale[{index}]_{name}"));
        if let Some(Property::Number(number)) = property { Some(*number) } else { None }
    }
    fn coefficient(&self, index: usize, name: &str) -> Result<f64, Error> {
        self.number(index, name).ok_or_else(|| self.fault(index, &format!("has no {name}")))
    }
    fn list(&self, index: usize, name: &str, count: usize) -> Result<Vec<f64>, Error> {
        (0..count).map(|i| self.coefficient(index, &format!("{name}[{i}]"))).collect()
    }
    fn kind(&self, index: usize) -> Option<&str> {
        match self.properties.get(&format!("NI_Scale[{index}]_Scale_Type")) {
            Some(Property::Text(kind)) => Some(kind),
            _ => None,
        }
    }
    /// The sources of a scale.
    fn sources(&self, index: usize) -> Vec<usize> {
        let source = |name: &str| self.number(index, name).and_then(whole).unwrap_or(RAW);
        match self.kind(index) {
            None => Vec::new(),
            Some(kind @ ("Add" | "Subtract")) => {
                ["Left", "Right"].map(|side| source(&format!("{kind}_{side}_Operand_Input_Source"))).into()
            }
            Some(kind) => vec![source(&format!("{kind}_Input_Source"))],
        }
    }
    /// Returns whether the last of the scales takes it, by way of others.
    fn is_needed(&self, index: usize, count: usize) -> bool {
        let mut needed = vec![false; count];
        needed[count - 1] = true;
        for later in (index + 1..count).rev() {
            if needed[later] {
                for source in self.sources(later).into_iter().filter(|source| *source < later) {
                    needed[source] = true;
                }
            }
        }
        needed[index]
    }
    /// Returns the values that a scale takes.
    fn source(&self, index: usize, source: usize, done: &[Option<Vec<f64>>]) -> Result<Vec<f64>, Error> {
        if source == RAW {
            let raw = self.values.ok_or_else(|| self.fault(index, "takes raw data, of which DAQmx has several"))?;
            return floats(raw).ok_or_else(|| self.fault(index, "takes integers beyond 2^53"));
        }
        let before = done.get(source).filter(|_| source < index).and_then(Option::as_ref);
        before.cloned().ok_or_else(|| self.fault(index, &format!("takes scale {source}, which is not before it")))
    }

    /// The values behind a scale.
    fn values(&self, index: usize, done: &[Option<Vec<f64>>]) -> Result<Vec<f64>, Error> {
        let Some(kind) = self.kind(index) else {
            // Scalers of DAQmx have no properties, but for one whose type is not known.
            let scaler = u32::try_from(index).ok().and_then(|id| self.scalers.get(&id));
            let scaler = scaler.ok_or_else(|| self.fault(index, "has no type, and no source of that number"))?;
            return floats(scaler).ok_or_else(|| self.fault(index, "takes integers beyond 2^53"));
        };
        let sources = self.sources(index).into_iter().map(|source| self.source(index, source, done));
        let mut sources = sources.collect::<Result<Vec<_>, _>>()?;
        let mut values = sources.swap_remove(0);
        let scale: Box<dyn Fn(f64) -> f64> = match (kind, sources.pop()) {
            ("Add" | "Subtract", Some(right)) => {
                // The left one is taken off the right one, as programs of NI do.
                let joined = |left: f64, right: f64| if kind == "Add" { left + right } else { right - left };
                values.iter_mut().zip(right).for_each(|(left, right)| *left = joined(*left, right));
                return Ok(values);
            }
            ("AdvancedAPI", _) => return Ok(values),
            ("Linear", _) => {
                let offset = self.coefficient(index, "Linear_Y_Intercept")?;
                let slope = self.coefficient(index, "Linear_Slope")?;
                Box::new(move |value| value * slope + offset)
            }
            ("Polynomial", _) => {
                let count = self.number(index, "Polynomial_Coefficients_Size").map_or(Some(4), whole);
                let count = count.ok_or_else(|| self.fault(index, "has no number of coefficients"))?;
                let coefficients = self.list(index, "Polynomial_Coefficients", count)?;
                Box::new(move |x| coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient))
            }
            ("Table", _) => {
                let table = self.table(index)?;
                Box::new(move |value| between(&table, value))
            }
            (other, _) => {
                let fault = format!("is of the kind {other:?}; Linear, Polynomial, Table, Add and Subtract are read");
                return Err(self.fault(index, &fault));
            }
        };
        Ok(values.into_iter().map(scale).collect())
    }

    /// The points of a table in the order of what it is entered with.
    fn table(&self, index: usize) -> Result<Vec<(f64, f64)>, Error> {
        let size = |name: &str| self.number(index, name).and_then(whole);
        let sizes = [size("Table_Pre_Scaled_Values_Size"), size("Table_Scaled_Values_Size")];
        let [Some(count), Some(other)] = sizes else {
            return Err(self.fault(index, "has no size of its table"));
        };
        if count != other || count == 0 {
            return Err(self.fault(index, &format!("has a table of {count} and {other} values")));
        }
        let from = self.list(index, "Table_Pre_Scaled_Values", count)?;
        let to = self.list(index, "Table_Scaled_Values", count)?;
        let mut table: Vec<(f64, f64)> = from.into_iter().zip(to).collect();
        let rises = |table: &[(f64, f64)]| table.windows(2).all(|pair| pair[0].0 < pair[1].0);
        if !rises(&table) {
            table.reverse();
        }
        if rises(&table) { Ok(table) } else { Err(self.fault(index, "has a table that neither rises nor falls")) }
    }
}

/// By straight lines between the points, and the last one beyond them.
fn between(table: &[(f64, f64)], x: f64) -> f64 {
    let after = table.partition_point(|(from, _)| *from <= x);
    match (after.checked_sub(1).map(|before| table[before]), table.get(after)) {
        (Some((x0, y0)), Some((x1, y1))) => y0 + (y1 - y0) * (x - x0) / (x1 - x0),
        (Some((_, y)), None) | (None, Some(&(_, y))) => y,
        (None, None) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    /// Straight lines between its values; beyond its ends those of the ends.
    #[test]
    fn a_table_holds_its_ends() {
        let table = [(0.0, 10.0), (2.0, 20.0), (4.0, 10.0)];
        for (x, value) in
            [(-1.0, 10.0), (0.0, 10.0), (1.0, 15.0), (2.0, 20.0), (3.5, 12.5), (4.0, 10.0), (9.0, 10.0_f64)]
        {
            assert_eq!(super::between(&table, x).to_bits(), value.to_bits(), "{x}");
        }
    }
}
