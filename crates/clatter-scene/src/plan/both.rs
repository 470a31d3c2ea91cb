//! One end lies on the ground, the other lands: what both contacts, which then act on each other, or all impacts of
//! that instant do together.
//!
//! Without gravity this depends on the inertia ratio and on restitution alone. Of a bar whose ends differ, `y = h √r`,
//! with r the inertia ratio of a strike at that end, moves as the ends of an even bar do whose ratio is the geometric
//! mean.

use std::sync::OnceLock;

use clatter::flight::{Body, Scene};
use clatter::{Bar, Start};

use super::ends::Ends;
use super::floats::greater;
use super::quick::ln;

/// Both ends after it, the one that lands first, for an approach velocity of −1 and a contact time of 1.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Both {
    /// With which they part from the ground.
    pub(super) velocity: [f64; 2],
    /// Where a flight with these velocities would have begun.
    pub(super) set_back: [f64; 2],
    /// When the last one parts.
    pub(super) lasts: f64,
}

/// Cells of the table over √(1 − q), from 1 to 0.15, and over −ln e, from e = 0.99 to 0.01: contacts take ends no
/// lighter than that (0.05 of the length as radius of gyration) and no less restitution, and without loss some never
/// part.
const CELLS: usize = 32;
const LEAST_ROOT: f64 = 0.15;
/// −ln 0.99, −ln 0.01
const LOSS: [f64; 2] = [0.010_050_335_853_501_442, 4.605_170_185_988_091];

/// Filled where it is read: a flight takes some 10 µs.
static TABLE: [[OnceLock<Both>; CELLS + 1]; CELLS + 1] = [const { [const { OnceLock::new() }; CELLS + 1] }; CELLS + 1];

#[expect(clippy::cast_precision_loss, reason = "a few cells")]
fn share(k: usize) -> f64 {
    k as f64 / CELLS as f64
}

/// The cell of a share in [0, 1], and where in it that is.
fn cell(x: f64) -> (usize, f64) {
    let x = x.clamp(0.0, 1.0) * share(CELLS * CELLS);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within 0 and CELLS")]
    let k = (x as usize).min(CELLS - 1);
    (k, x - share(k * CELLS))
}

impl Both {
    /// Of impacts: the closed form of all that follow one another at that instant.
    pub(super) fn of_impacts(q: f64, e: f64) -> Self {
        let velocity = Bar::new(q, e).and_then(|bar| Ok(bar.summary(&Start::new([-1.0, 0.0], 0.0)?).final_velocity));
        Self { velocity: velocity.ok().flatten().unwrap_or_default(), ..Self::default() }
    }
    /// Of contacts, for q in [0, 0.977] and e in [0.01, 0.99], to 2 % of the approach up to e = 0.8 and 15 % above,
    /// where it changes which end parts last; beyond, those next to them.
    pub(super) fn of_contacts(q: f64, e: f64) -> Self {
        let (i, x) = cell((1.0 - (1.0 - q).sqrt()) / (1.0 - LEAST_ROOT));
        let (j, y) = cell((-ln(greater(e, f64::MIN_POSITIVE)) - LOSS[0]) / (LOSS[1] - LOSS[0]));
        let at = |i: usize, j: usize| *TABLE[i][j].get_or_init(|| Self::followed(i, j));
        let four = [
            (at(i, j), (1.0 - x) * (1.0 - y)),
            (at(i + 1, j), x * (1.0 - y)),
            (at(i, j + 1), (1.0 - x) * y),
            (at(i + 1, j + 1), x * y),
        ];
        let mix = |of: &dyn Fn(&Self) -> f64| four.iter().map(|(both, weight)| weight * of(both)).sum();
        Self {
            velocity: [mix(&|b| b.velocity[0]), mix(&|b| b.velocity[1])],
            set_back: [mix(&|b| b.set_back[0]), mix(&|b| b.set_back[1])],
            lasts: mix(&|b| b.lasts),
        }
    }
    fn followed(i: usize, j: usize) -> Self {
        let root = 1.0 - (1.0 - LEAST_ROOT) * share(i);
        let loss = LOSS[0] + (LOSS[1] - LOSS[0]) * share(j);
        // At q = 0 a rounding decides how long the end that lies is pressed.
        Self::flight((1.0 - root * root).max(1e-3), libm::exp(-loss).max(0.01))
    }
    /// By the model of contacts itself.
    fn flight(q: f64, e: f64) -> Self {
        const TIME: f64 = 1e-3;
        // End a lands with 1 m/s, end b lies: half of it, and a turn.
        let scene = Body::new(1.0, 0.5 * ((1.0 - q) / (1.0 + q)).sqrt())
            .and_then(|body| Scene::new(body, e, 0.5, 0.0, 0.0)?.with_spin(1.0));
        let Ok(flight) = scene.and_then(|scene| scene.simulate_compliant(TIME)) else {
            unreachable!("within what it takes")
        };
        let parted = flight.pulses.iter().map(|pulse| pulse.until_s).fold(0.0, f64::max);
        let after = flight.sample(parted + TIME);
        let back = |k: usize| (after.height_m[k] - after.velocity_m_s[k] * (parted + TIME)) / TIME;
        Self { velocity: after.velocity_m_s, set_back: [back(0), back(1)], lasts: parted / TIME }
    }
    /// The same of a bar whose end `landed` lands, for its ends a and b.
    pub(super) fn scaled(&self, ends: &Ends, landed: usize) -> Self {
        let scale = (ends.flat[landed] / ends.flat[1 - landed]).sqrt();
        let order = |[first, other]: [f64; 2]| {
            if landed == 0 { [first, other * scale] } else { [other * scale, first] }
        };
        Self { velocity: order(self.velocity), set_back: order(self.set_back), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_as_close_to_the_flight_as_stated() {
        for q in [0.013, 0.11, 0.34, 0.58, 0.77, 0.93] {
            for e in [0.0123, 0.046, 0.17, 0.41, 0.83, 0.97] {
                let (read, flown) = (Both::of_contacts(q, e), Both::flight(q, e));
                let stated = if e < 0.8 { 0.02 } else { 0.15 };
                for k in 0..2 {
                    let off = (read.velocity[k] - flown.velocity[k]).abs();
                    assert!(off < stated, "q {q} e {e}: velocity {} {}", read.velocity[k], flown.velocity[k]);
                    let off = (read.set_back[k] - flown.set_back[k]).abs() / flown.lasts;
                    assert!(off < stated, "q {q} e {e}: set back {} {}", read.set_back[k], flown.set_back[k]);
                }
            }
        }
    }

    /// No node is refused by the model of contacts, whatever a body is.
    #[test]
    fn every_node_can_be_followed() {
        for i in 0..=CELLS {
            for j in 0..=CELLS {
                let both = Both::followed(i, j);
                assert!(both.velocity.iter().all(|v| (0.0..1.0).contains(v)), "{i} {j}: {both:?}");
                assert!((0.999..20.0).contains(&both.lasts), "{i} {j}: {both:?}");
            }
        }
        for q in [0.97, 0.979, 0.99, 1.0] {
            assert!(Both::of_contacts(q, 0.0).lasts > 1.0, "q {q}");
        }
    }

    /// A bar whose center of mass is off the middle, against the flight of that very bar.
    #[test]
    fn an_uneven_bar_moves_as_an_even_one() {
        const TIME: f64 = 1e-3;
        for [a, b] in [[0.06, 0.09], [0.09, 0.06], [0.05, 0.051]] {
            // End a lands with 1 m/s, end b lies.
            let body = Body::off_center(a, b, 0.03).expect("as the test has it");
            let scene = Scene::new(body, 0.3, b / (a + b), 0.0, 0.0).expect("as the test has it");
            let scene = scene.with_spin(1.0 / (a + b)).expect("as the test has it");
            let flight = scene.simulate_compliant(TIME).expect("as the test has it");
            let parted = flight.pulses.iter().fold(0.0_f64, |m, pulse| m.max(pulse.until_s));
            let flown = flight.sample(parted + TIME).velocity_m_s;
            let ends = Ends::new(&scene, 0.0);
            let q = (ends.flat[0] * ends.flat[1]).sqrt();
            let scaled = Both::of_contacts(q, 0.3).scaled(&ends, 0).velocity;
            // As the table is read.
            assert!((0..2).all(|k| (scaled[k] - flown[k]).abs() < 0.01), "{a} {b}: {scaled:?} {flown:?}");
            // Impact by impact.
            let (ratio, mut velocity, mut end) = ([ends.flat[0], ends.flat[1]], [-1.0, 0.0], 0);
            while velocity[end] < 0.0 {
                let jump = -1.3 * velocity[end];
                velocity[end] += jump;
                velocity[1 - end] -= ratio[end] * jump;
                end = 1 - end;
            }
            let scaled = Both::of_impacts(q, 0.3).scaled(&ends, 0).velocity;
            assert!((0..2).all(|k| (scaled[k] - velocity[k]).abs() < 1e-12), "{a} {b}: {scaled:?} {velocity:?}");
            // The same bar turned around.
            let body = Body::off_center(b, a, 0.03).expect("as the test has it");
            let turned = Ends::new(&Scene::new(body, 0.3, 1.0, 0.0, 0.0).expect("as the test has it"), 0.0);
            let [of_b, of_a] = Both::of_impacts(q, 0.3).scaled(&turned, 1).velocity;
            assert!((of_a - scaled[0]).abs() + (of_b - scaled[1]).abs() < 1e-12, "{a} {b}: {of_a} {of_b}");
        }
    }
}
