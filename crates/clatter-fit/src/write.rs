//! Ranges found, written into the text of a product file.

use toml::de::{DeTable, DeValue};

use super::{Estimate, Fit, Quantity};
use clatter_product::{LEAST_GYRATION, ProductFile, most_gyration_m};

/// Tilts that a product file takes, in degrees.
const MOST_TILT_DEG: f64 = 30.0;

/// A product file with what a fit found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The text of the file; all that the fit does not tell stands as it was.
    pub text: String,
    /// The results that are not in it, and why.
    pub notes: Vec<String>,
}

/// Writes the ranges of a fit into the text of a product file: restitution, contact time, tilt, height or speed as ranges of 95 %, and the
/// radius of gyration within what a file takes. All else stays as it is, comments and order too.
///
/// # Errors
/// Returns the fault of the text, or the reason why it cannot take the results.
///
/// # Examples
/// ```
/// use clatter_fit::{bounces, written};
/// use clatter_product::EXAMPLE;
/// let found = bounces(&[1.0, 1.4, 1.6, 1.7], 9.81, Some(1e-3))?;
/// let written = written(EXAMPLE, &found)?;
/// assert!(written.text.contains("restitution = [0.49"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn written(text: &str, fit: &Fit) -> Result<Written, String> {
    let table = DeTable::parse(text).map_err(|error| error.to_string())?;
    let section = |name: &str| match table.get_ref().get(name).map(toml::Spanned::get_ref) {
        Some(DeValue::Table(section)) => Ok(section),
        _ => Err(format!("the file has no table {name}")),
    };
    let (product, drop) = (section("product")?, section("drop")?);
    let mut edits: Vec<(std::ops::Range<usize>, String)> = Vec::new();
    let mut notes = Vec::new();
    let mut set = |section: &DeTable<'_>, key: &str, value: String| match section.get(key) {
        Some(old) => {
            edits.push((old.span(), value));
            true
        }
        None => false,
    };
    let of = |quantity: Quantity| fit.estimates.iter().find(|estimate| estimate.quantity == quantity);
    if let Some(range) = restitution(fit) {
        set(product, "restitution", plain(range));
    }
    if let Some(found) = of(Quantity::RadiusOfGyration) {
        let of = ProductFile::read(text, "the file").map_err(|faults| faults.to_string())?.product;
        // Rounded outward to four digits it is within what a file takes.
        let [least, most] = [LEAST_GYRATION * of.body.length_m(), most_gyration_m(&of)].map(|m| 1e3 * m);
        let radius = quantity(range(found).map(|m| (1e3 * m).clamp(least * 1.001, most * 0.999)), "mm");
        if !set(product, "radius_of_gyration", radius) {
            notes.push(format!(
                "the radius of gyration, {} mm, is not written: the file gives the inertia in another way",
                four(1e3 * found.value, Round::Nearest)
            ));
        }
    }
    if let Some(found) = of(Quantity::Tilt) {
        let [lo, hi] = range(found).map(f64::to_degrees);
        if hi <= MOST_TILT_DEG {
            set(drop, "tilt", quantity([lo, hi], "deg"));
        } else {
            notes.push(format!("the tilt is not written: a product file takes no more than {MOST_TILT_DEG} deg"));
        }
    }
    if let Some(found) = of(Quantity::DropHeight) {
        set(drop, "height", quantity(range(found).map(|m| 1e3 * m), "mm"));
    }
    if let Some(found) = of(Quantity::Speed) {
        set(drop, "speed", quantity(range(found), "m/s"));
    }
    let contact = of(Quantity::ContactTime).map(|found| quantity(range(found).map(|s| 1e3 * s), "ms"));
    if let Some(contact) = contact
        && !set(product, "contact_time", contact.clone())
        && let Some(restitution) = product.get("restitution")
    {
        let end = restitution.span().end;
        let line = text[end..].find('\n').map_or(text.len(), |k| end + k);
        edits.push((line..line, format!("\ncontact_time = {contact}")));
    }
    edits.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    let mut text = text.to_owned();
    for (span, value) in edits {
        text.replace_range(span, &value);
    }
    ProductFile::read(&text, "the fitted file").map_err(|faults| faults.to_string())?;
    Ok(Written { text, notes })
}

/// Returns the restitution of the end, or of both.
fn restitution(fit: &Fit) -> Option<[f64; 2]> {
    let is_one = |estimate: &&Estimate| {
        matches!(estimate.quantity, Quantity::Restitution | Quantity::RestitutionA | Quantity::RestitutionB)
    };
    fit.estimates.iter().filter(is_one).map(range).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
}

fn range(estimate: &Estimate) -> [f64; 2] {
    estimate.interval.unwrap_or([estimate.value; 2])
}

/// Writes a range outward to four digits, without a unit.
fn plain([lo, hi]: [f64; 2]) -> String {
    let (lo, hi) = (four(lo, Round::Down), four(hi, Round::Up));
    if lo == hi { lo } else { format!("[{lo}, {hi}]") }
}

/// Writes the same with a unit.
fn quantity([lo, hi]: [f64; 2], unit: &str) -> String {
    let (lo, hi) = (four(lo, Round::Down), four(hi, Round::Up));
    if lo == hi { format!("\"{lo} {unit}\"") } else { format!("[\"{lo} {unit}\", \"{hi} {unit}\"]") }
}

#[derive(Clone, Copy)]
enum Round {
    Down,
    Up,
    Nearest,
}

/// Writes four significant digits of a number that is not negative.
fn four(x: f64, round: Round) -> String {
    if x <= 0.0 {
        return "0".to_owned();
    }
    #[expect(clippy::cast_possible_truncation, reason = "the exponent of a float")]
    let place = 3 - libm::floor(libm::log10(x)) as i32;
    let (scale, digits) = (10f64.powi(place), usize::try_from(place).unwrap_or(0));
    // A value that is a whole number but for roundings counts as one.
    let near = (x * scale).round();
    let whole = if (x * scale - near).abs() < 1e-6 {
        near
    } else {
        match round {
            Round::Down => (x * scale).floor(),
            Round::Up => (x * scale).ceil(),
            Round::Nearest => near,
        }
    };
    let text = format!("{:.digits$}", whole / scale);
    if digits > 0 { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_rounded_outward() {
        let values = [0.123_456, 0.3, 38.004_9, 1234.4, 0.0, 0.000_012_341, 56_789.0];
        assert_eq!(values.map(|x| four(x, Round::Down)), ["0.1234", "0.3", "38", "1234", "0", "0.00001234", "56780"]);
        assert_eq!(values.map(|x| four(x, Round::Up)), ["0.1235", "0.3", "38.01", "1235", "0", "0.00001235", "56790"]);
    }

    /// Ends of two restitutions are written as one range that holds both.
    #[test]
    fn both_restitutions_are_within_what_is_written() {
        let mut fit = crate::bounces(&[0.0, 0.1, 0.15, 0.175], 9.81, None).unwrap();
        let of = |quantity, [lo, hi]: [f64; 2]| Estimate {
            quantity,
            value: 0.5 * (lo + hi),
            interval: Some([lo, hi]),
            note: None,
        };
        fit.estimates = vec![of(Quantity::RestitutionA, [0.2, 0.25]), of(Quantity::RestitutionB, [0.3, 0.35])];
        assert_eq!(restitution(&fit), Some([0.2, 0.35]));
    }
}
