//! Scales that the driver left for the reader to apply.

use super::{Properties, Property};
use crate::container::refuse;
use crate::{Error, Values};

/// The raw values, as source of a scale; scales have numbers below.
const RAW: f64 = u32::MAX as f64;

/// The values by the scales of the first of these that has any: channel, group, file.
///
/// Source: the properties `NI_Scale[…]`, as npTDMS reads them.
pub(super) fn scaled(values: Values, sources: &[Option<&Properties>], channel: &str) -> Result<Values, Error> {
    let Some(properties) = sources.iter().flatten().find(|properties| properties.contains_key("NI_Number_Of_Scales"))
    else {
        return Ok(values);
    };
    let status = properties.get("NI_Scaling_Status");
    let unscaled = match status {
        Some(Property::Text(status)) => status != "scaled",
        _ => true,
    };
    let Some(Property::Number(count)) = properties.get("NI_Number_Of_Scales") else { return Ok(values) };
    let (true, true) = (unscaled, *count >= 1.0) else { return Ok(values) };
    let mut polynomials = Vec::new();
    // From the last scale back to the raw values.
    let mut index = *count - 1.0;
    while index < RAW {
        let scale = Scale { properties, index, channel };
        let (coefficients, source) = scale.read()?;
        polynomials.push(coefficients);
        if source < RAW && source >= index {
            return Err(scale.fault(&format!("takes scale {source}, which is not before it")));
        }
        index = source;
    }
    let mut values = match values {
        Values::Float(values) => values,
        Values::Integer(_) => {
            return Err(refuse(format!("TDMS file: {channel:?} has a scale, but integers beyond 2^53")));
        }
    };
    for value in &mut values {
        *value = polynomials.iter().rev().fold(*value, |value, coefficients| {
            coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * value + coefficient)
        });
    }
    Ok(Values::Float(values))
}

/// One of the scales.
#[derive(Debug)]
struct Scale<'a> {
    properties: &'a Properties,
    index: f64,
    channel: &'a str,
}

impl Scale<'_> {
    fn fault(&self, fault: &str) -> Error {
        refuse(format!(
            "TDMS file: scale {} of {:?} {fault}; convert the file with LabVIEW or DIAdem",
            self.index, self.channel
        ))
    }
    fn property(&self, name: &str) -> Option<&Property> {
        self.properties.get(&format!("NI_Scale[{}]_{name}", self.index))
    }
    fn number(&self, name: &str) -> Option<f64> {
        if let Some(Property::Number(number)) = self.property(name) { Some(*number) } else { None }
    }
    fn coefficient(&self, name: &str) -> Result<f64, Error> {
        self.number(name).ok_or_else(|| self.fault(&format!("has no {name}")))
    }
    /// Its polynomial, from the constant on, and the index of the scale it takes.
    fn read(&self) -> Result<(Vec<f64>, f64), Error> {
        let Some(Property::Text(kind)) = self.property("Scale_Type") else {
            return Err(self.fault("has no type"));
        };
        let coefficients = match kind.as_str() {
            "Linear" => vec![self.coefficient("Linear_Y_Intercept")?, self.coefficient("Linear_Slope")?],
            "Polynomial" => {
                let count = self.number("Polynomial_Coefficients_Size").unwrap_or(4.0);
                let mut coefficients = Vec::new();
                let mut left = count;
                while left > 0.0 {
                    coefficients.push(self.coefficient(&format!("Polynomial_Coefficients[{}]", coefficients.len()))?);
                    left -= 1.0;
                }
                coefficients
            }
            other => return Err(self.fault(&format!("is of the kind {other:?}, not Linear or Polynomial"))),
        };
        Ok((coefficients, self.number(&format!("{kind}_Input_Source")).unwrap_or(RAW)))
    }
}
