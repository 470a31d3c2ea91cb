//! How many strikes of a long train are worth keeping.

use clatter::flight::Model;
use clatter_shock::VelocityShocks;
use serde::Serialize;

use super::{TOLERANCES, off};
use crate::Error;
use crate::plan::{BarRung, Quantity, Setup};

/// What the first strikes of a train alone get wrong, with every shock as an impulse.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Kept {
    /// How the bar moves.
    pub bar: BarRung,
    /// Strikes of the whole train that are told apart: an endless one goes on below 10⁻¹⁵ of its largest shock.
    pub strikes: usize,
    /// Why the train ends; `at-rest` where it is endless.
    pub stop: &'static str,
    /// Error in the quantity with the first 1, 2, 3 … strikes, as a share of what the whole train does; until all that
    /// is left out can do no more than [`NEGLIGIBLE`], or the train ends.
    pub errors: Vec<f64>,
    /// How many strikes are enough, with any number beyond, at each of [`TOLERANCES`]; null where more than were tried.
    pub least: Vec<Option<usize>>,
}

/// Share of the quantity that what is left out can change it by at most, where the list ends.
pub const NEGLIGIBLE: f64 = 1e-6;

/// Strikes kept, at most.
const MOST: usize = 256;

impl Kept {
    pub(super) fn of(setup: &Setup, bar: BarRung, quantity: Quantity) -> Result<Self, Error> {
        let model = if bar == BarRung::Map { Model::Map } else { Model::FiniteTilt };
        let flight = setup.scene().simulate(model);
        let whole = setup.shocks(&flight)?;
        let truth = setup.of_impulses(&whole, quantity);
        let shocks = whole.as_slice();
        // The response is linear: what is left out changes it by no more than it would do alone.
        let mut left: f64 = shocks.iter().map(|shock| setup.of_one(shock.delta_v, quantity)).sum();
        let (mut errors, mut bound) = (Vec::new(), 1.0_f64);
        for (n, shock) in shocks.iter().enumerate().take(MOST) {
            left -= setup.of_one(shock.delta_v, quantity);
            bound = if n + 1 == shocks.len() { 0.0 } else { (left / truth).max(0.0) };
            let first = VelocityShocks::new(shocks[..=n].to_vec())?;
            errors.push(off(setup.of_impulses(&first, quantity), truth));
            if bound <= NEGLIGIBLE {
                break;
            }
        }
        let least = TOLERANCES.map(|tolerance| enough(&errors, bound, tolerance)).to_vec();
        Ok(Self { bar, strikes: shocks.len(), stop: flight.stop.reason(), errors, least })
    }
}

/// The least number of strikes from which on all errors are within the tolerance, `bound` being one on those not
/// listed.
fn enough(errors: &[f64], bound: f64, tolerance: f64) -> Option<usize> {
    let last = errors.iter().rposition(|error| *error > tolerance);
    (bound <= tolerance).then(|| last.map_or(1, |last| last + 2)).filter(|n| *n <= errors.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enough_is_from_where_on_it_stays_enough() {
        // The second strike is a stroke of luck.
        let errors = [0.5, 0.001, 0.2, 0.05, 0.001];
        assert_eq!(enough(&errors, 0.0, 0.1), Some(4));
        assert_eq!(enough(&errors, 0.0, 0.6), Some(1));
        assert_eq!(enough(&errors, 0.0, 0.01), Some(5));
        assert_eq!(enough(&errors, 0.2, 0.1), None, "what was not tried may do more");
        assert_eq!(enough(&errors, 0.0, 1e-9), None);
    }
}
