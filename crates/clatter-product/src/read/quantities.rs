//! Quantities of a product file: values, ranges and distributions.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{At, Reader, Section, shown};
use crate::data_fault::out_of_range;
use crate::keys::{self, Key, Kind};
use crate::slip::slip;
use crate::units::{Dimension, Quantity};
use crate::{Law, Spread};

impl Reader {
    pub(super) fn quantity(&mut self, section: &Section<'_>, name: &str) -> Option<At<f64>> {
        let (key, value) = Self::get(section, name)?;
        self.quantity_in(value, key)
    }

    fn quantity_in(&mut self, value: &Spanned<DeValue<'_>>, key: &Key) -> Option<At<f64>> {
        let Kind::Quantity(dimension, bounds) = key.kind.of_side() else { return None };
        let quantity = self.number(value, key.name, dimension, *bounds)?;
        // A single height is a place in a box, and not what the product falls.
        if key.name != "height" {
            self.usual(key.name, &quantity, value);
        }
        Some(At { value: quantity.si, span: value.span() })
    }

    /// Reads, of a plate, the quantities along its length and across it; of a bar none across.
    pub(super) fn quantity_of_sides(&mut self, section: &Section<'_>, name: &str) -> Option<At<[f64; 2]>> {
        self.sides(section, name, Self::quantity_in, 0.0)
    }

    /// Reads the same of ranges and distributions.
    pub(super) fn spread_of_sides(&mut self, section: &Section<'_>, name: &str) -> Option<At<[Spread; 2]>> {
        self.sides(section, name, Self::spread_in, Spread::finite(0.0))
    }

    fn sides<T>(
        &mut self,
        section: &Section<'_>,
        name: &str,
        read: fn(&mut Self, &Spanned<DeValue<'_>>, &Key) -> Option<At<T>>,
        nothing: T,
    ) -> Option<At<[T; 2]>> {
        let (key, value) = Self::get(section, name)?;
        let span = value.span();
        if !self.is_plate {
            return Some(At { value: [read(self, value, key)?.value, nothing], span });
        }
        let (Kind::Quantity(dimension, _) | Kind::Spread(dimension, _)) = key.kind.of_side() else { return None };
        let items = value.get_ref().as_array().filter(|items| items.len() == 2);
        let Some(items) = items else {
            let example = written(dimension);
            let allowed =
                format!("[{example}, {example}], along the length and along the width, as the product has a width");
            self.wrong_type(value, name, &allowed);
            return None;
        };
        let [along, across] = [&items[0], &items[1]].map(|item| read(self, item, key));
        Some(At { value: [along?.value, across?.value], span })
    }

    /// Reads one number with its unit, within bounds.
    fn number(
        &mut self,
        value: &Spanned<DeValue<'_>>,
        name: &str,
        dimension: &Dimension,
        bounds: [&str; 2],
    ) -> Option<Quantity> {
        let allowed = keys::allowed(bounds);
        let digits = match value.get_ref() {
            DeValue::Integer(i) if i.radix() == 10 => Some(i.as_str().replace('_', "")),
            DeValue::Float(f) => Some(f.as_str().replace('_', "")),
            _ => None,
        };
        let read = match (&digits, value.get_ref()) {
            (Some(digits), _) if dimension.plain => dimension.read(digits),
            (Some(digits), _) => Err(format!("`{name}` = {} has no unit", shown(digits))),
            // A value that needs no unit needs no quotes.
            (None, DeValue::String(text))
                if !(dimension.units.is_empty() || dimension.plain && text.parse::<f64>().is_ok()) =>
            {
                dimension.read(text)
            }
            (None, _) => {
                self.wrong_type(value, name, &one(dimension));
                return None;
            }
        };
        let quantity = match read {
            Ok(quantity) => quantity,
            Err(message) => {
                let units = if dimension.plain { String::new() } else { format!(", in {}", dimension.names()) };
                let (label, help) = (format!("expected {}", one(dimension)), format!("`{name}` is {allowed}{units}"));
                self.fault(value.span(), message, label, help);
                return None;
            }
        };
        if keys::within(dimension, bounds, quantity.si) {
            return Some(quantity);
        }
        let what = match value.get_ref() {
            DeValue::String(text) => format!("{:?}", shown(text)),
            DeValue::Float(text) => shown(text.as_str()),
            _ => quantity.si.to_string(),
        };
        self.fault(value.span(), out_of_range(name, what), format!("allowed: {allowed}"), "");
        None
    }

    /// Reads a value, `[lo, hi]`, or a table with a distribution.
    pub(super) fn spread(&mut self, section: &Section<'_>, name: &str) -> Option<At<Spread>> {
        let (key, value) = Self::get(section, name)?;
        self.spread_in(value, key)
    }

    fn spread_in(&mut self, value: &Spanned<DeValue<'_>>, key: &Key) -> Option<At<Spread>> {
        let Kind::Spread(dimension, bounds) = key.kind.of_side() else { return None };
        let (span, name) = (value.span(), key.name);
        let (spread, quantity) = match value.get_ref() {
            DeValue::Array(_) => {
                let [lo, hi] = self.numbers::<2>(value, name, dimension, *bounds)?;
                (self.checked(Spread::new(lo.si, hi.si, Law::Range), name, value)?, hi)
            }
            DeValue::Table(table) => self.distribution(table, value, name, dimension, *bounds)?,
            _ => {
                let quantity = self.number(value, name, dimension, *bounds)?;
                (self.checked(Spread::value(quantity.si), name, value)?, quantity)
            }
        };
        self.usual(name, &quantity, value);
        Some(At { value: spread.written_in(quantity.unit), span })
    }

    /// Warns where a value is one that no product has, and may be a slip.
    fn usual(&mut self, name: &str, quantity: &Quantity, value: &Spanned<DeValue<'_>>) {
        if let Some(slip) = slip(name, quantity) {
            self.warn(value.span(), slip.message, slip.hint);
        }
    }

    fn distribution(
        &mut self,
        table: &DeTable<'_>,
        value: &Spanned<DeValue<'_>>,
        name: &str,
        dimension: &Dimension,
        bounds: [&str; 2],
    ) -> Option<(Spread, Quantity)> {
        const KINDS: [&str; 3] = ["uniform", "normal", "triangular"];
        let one = written(dimension);
        let ways = format!(
            "{{ uniform = [lo, hi] }}, {{ triangular = [lo, most frequent, hi] }} or {{ normal = [mean, deviation], \
             range = [lo, hi] }}, each such as {one}"
        );
        let given: Vec<_> = KINDS.iter().filter(|kind| table.contains_key(**kind)).collect();
        let extra = table.keys().find(|key| {
            let key = key.get_ref().as_ref();
            !(KINDS.contains(&key) || key == "range" && given == [&"normal"])
        });
        if let Some(key) = extra {
            let message = format!("`{name}` is no distribution: `{}` is no part of one", shown(key.get_ref()));
            self.fault(key.span(), message, "unknown here", ways);
            return None;
        }
        let [kind] = given[..] else {
            let message = format!("`{name}` is not one distribution but {}", given.len());
            self.fault(value.span(), message, "expected one of uniform, normal, triangular", ways);
            return None;
        };
        let numbers = &table[*kind];
        let (spread, hi) = match *kind {
            "uniform" => {
                let [lo, hi] = self.numbers::<2>(numbers, name, dimension, bounds)?;
                (Spread::new(lo.si, hi.si, Law::Uniform), hi)
            }
            "triangular" => {
                let [lo, mode, hi] = self.numbers::<3>(numbers, name, dimension, bounds)?;
                (Spread::new(lo.si, hi.si, Law::Triangular { mode: mode.si }), hi)
            }
            _ => {
                let Some(range) = table.get("range") else {
                    let message = format!("the normal distribution of `{name}` has no `range` to be cut to");
                    self.fault(value.span(), message, "expected range = [lo, hi]", ways);
                    return None;
                };
                let [mean, deviation] = self.numbers::<2>(numbers, name, dimension, bounds)?;
                let [lo, hi] = self.numbers::<2>(range, name, dimension, bounds)?;
                (Spread::new(lo.si, hi.si, Law::Normal { mean: mean.si, deviation: deviation.si }), hi)
            }
        };
        Some((self.checked(spread, name, value)?, hi))
    }

    fn checked(
        &mut self,
        spread: Result<Spread, crate::Error>,
        name: &str,
        value: &Spanned<DeValue<'_>>,
    ) -> Option<Spread> {
        spread
            .map_err(|error| {
                let message = match error {
                    crate::Error::Range { .. } => format!("the range of `{name}` begins above its end"),
                    _ => format!("`{name}` is no distribution over its range"),
                };
                let help = "a range runs from its lower to its upper end, a deviation is positive, the most frequent value is \
                            within the range";
                self.fault(value.span(), message, "this range", help);
            })
            .ok()
    }

    /// Reads an array of so many numbers.
    fn numbers<const N: usize>(
        &mut self,
        value: &Spanned<DeValue<'_>>,
        name: &str,
        dimension: &Dimension,
        bounds: [&str; 2],
    ) -> Option<[Quantity; N]> {
        let items = value.get_ref().as_array().filter(|items| items.len() == N);
        let Some(items) = items else {
            self.wrong_type(value, name, &format!("a list of {N}, each such as {}", written(dimension)));
            return None;
        };
        let read: Vec<_> = items.iter().filter_map(|item| self.number(item, name, dimension, bounds)).collect();
        read.try_into().ok()
    }
}

/// Returns how a quantity is written in the file.
pub(super) fn written(dimension: &Dimension) -> String {
    if dimension.plain { dimension.example.to_owned() } else { format!("{:?}", dimension.example) }
}

/// Returns "a length such as …".
pub(super) fn one(dimension: &Dimension) -> String {
    format!("{} such as {}", dimension.one(), written(dimension))
}
