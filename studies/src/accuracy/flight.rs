//! The flight models compared with one another, and the contact engine with itself at a finer precision.

use crate::{Order, Residue, orders, residues};
use clatter_flight::{Contact, ContactLaw, Model, Motion, Profile, Scene};

use crate::Error;

/// Drops of (½, 0.3), half-length 70 mm, 4.43 m/s: the flights at 5°, the steps in precision at 20°.
const HALF_M: f64 = 0.07;
const SPEED_M_S: f64 = 4.43;
const RESTITUTION: f64 = 0.3;
const TILT_DEG: f64 = 5.0;
const CONTACT_S: f64 = 5e-5;
pub(super) const STEEP_DEG: f64 = 20.0;
pub(super) const LONG_CONTACT_S: f64 = 4e-4;
/// The precisions, and the finest one that they are compared with.
const PRECISIONS: [(&str, f64); 4] = [("10⁻²", 1e-2), ("10⁻³", 1e-3), ("10⁻⁴", 1e-4), ("10⁻⁵", 1e-5)];
const FINEST: f64 = 1e-6;
/// Number of compared strikes.
pub(super) const COMPARED: usize = 4;

/// Both laws, with their names.
const LAWS: [(&str, &str, ContactLaw); 2] = [
    ("hysteretic", "compliant, hysteretic", ContactLaw::Hysteretic),
    ("dashpot", "compliant, dashpot", ContactLaw::Dashpot),
];

/// The errors of contacts at one precision: the largest over the compared strikes.
#[derive(Debug, Clone)]
pub(super) struct Step {
    pub(super) law: &'static str,
    pub(super) precision: &'static str,
    /// Error of the time of a strike, relative.
    pub(super) time: f64,
    /// Error of its approach speed, over the drop speed.
    pub(super) approach: f64,
    /// Error of its velocity shocks, over the drop speed.
    pub(super) shock: f64,
    /// Pieces in which all forces are linear in the motion.
    pub(super) phases: usize,
}

/// All data about flights.
#[derive(Debug)]
pub(super) struct Flights {
    pub(super) orders: Vec<Order>,
    pub(super) residues: Vec<Residue>,
    /// One drop by all models.
    pub(super) models: Vec<(&'static str, Motion)>,
    /// h0/v0 of that drop, in seconds, and its contact time.
    pub(super) unit_s: f64,
    pub(super) contact_s: f64,
    pub(super) steps: Vec<Step>,
}

fn scene(tilt_deg: f64) -> Result<Scene, Error> {
    let body = Profile::new(2.0 * HALF_M, HALF_M / 3f64.sqrt())?;
    Ok(Scene::new(body, RESTITUTION, SPEED_M_S, tilt_deg, 9.81)?)
}

impl Flights {
    pub(super) fn compute() -> Result<Self, Error> {
        let drop = scene(TILT_DEG)?;
        let mut models = vec![("map", Model::Map), ("ballistic", Model::Ballistic), ("finite tilt", Model::FiniteTilt)];
        for (_, name, law) in LAWS {
            models.push((name, Model::Contacts(Contact::new(law, RESTITUTION, CONTACT_S)?)));
        }
        let models = models.into_iter().map(|(name, model)| Ok((name, drop.fly(model)?)));
        let models = models.collect::<Result<_, Error>>()?;
        Ok(Self {
            orders: orders()?,
            residues: residues()?,
            models,
            unit_s: drop.height_gap_m() / SPEED_M_S,
            contact_s: CONTACT_S,
            steps: steps()?,
        })
    }
}

/// Returns the errors of both laws at each precision.
fn steps() -> Result<Vec<Step>, Error> {
    let drop = scene(STEEP_DEG)?;
    let mut steps = Vec::new();
    for (name, _, law) in LAWS {
        let model = Model::Contacts(Contact::new(law, RESTITUTION, LONG_CONTACT_S)?);
        let finest = drop.fly_until(model, FINEST, |_| false)?;
        for (precision, value) in PRECISIONS {
            let motion = drop.fly_until(model, value, |_| false)?;
            let [time, approach, shock] = off(&motion, &finest);
            steps.push(Step { law: name, precision, time, approach, shock, phases: motion.phases_s().count() });
        }
    }
    Ok(steps)
}

/// Returns the largest differences of times, approach speeds and velocity shocks; infinite where another point strikes,
/// or none.
fn off(flight: &Motion, finest: &Motion) -> [f64; 3] {
    let mut most = [0.0_f64; 3];
    for (k, want) in finest.strikes.iter().take(COMPARED).enumerate() {
        let Some(got) = flight.strikes.get(k).filter(|got| got.point == want.point) else { return [f64::INFINITY; 3] };
        let time = if want.time_s > 0.0 { (got.time_s / want.time_s - 1.0).abs() } else { got.time_s };
        let approach = (got.approach_m_s - want.approach_m_s).abs() / SPEED_M_S;
        let shocks = (0..2).map(|i| (got.delta_v_m_s[i] - want.delta_v_m_s[i]).abs() / SPEED_M_S);
        let found = [time, approach, shocks.fold(0.0, f64::max)];
        most = std::array::from_fn(|i| most[i].max(found[i]));
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error of a strike is about the precision at most, and falls with it.
    #[test]
    fn strikes_are_as_exact_as_asked() {
        let steps = steps().unwrap();
        for law in steps.chunks(PRECISIONS.len()) {
            assert!(law[0].approach < 1e-2 && law[0].shock < 1e-2, "{law:?}");
            let (first, last) = (&law[0], &law[PRECISIONS.len() - 1]);
            assert!(last.approach < 0.2 * first.approach && last.shock < 0.2 * first.shock, "{law:?}");
        }
    }

    #[test]
    fn another_order_of_strikes_is_no_small_error() {
        let drop = scene(TILT_DEG).unwrap();
        let flight = drop.fly(Model::Map).unwrap();
        let mut other = flight.clone();
        other.strikes.swap(0, 1);
        assert!(off(&other, &flight).iter().all(|error| error.is_infinite()), "{other:?}");
        assert!(off(&flight, &flight).iter().all(|error| *error <= 0.0), "{flight:?}");
    }
}
