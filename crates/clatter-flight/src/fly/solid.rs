//! The motion of a box as places in it feel it.

use crate::{Axis, BlockDrop, BlockFlight, Contact, Error, Stop};
use clatter::{Excitation, Section};

/// A motion of a box, followed to a time, as places in it feel it.
#[derive(Debug, Clone)]
pub(crate) struct BlockMotion {
    pub(super) contacts: [Contact; 8],
    pub(super) gravity_m_s2: f64,
    pub(super) flight: BlockFlight,
    pub(super) stop: Stop,
    /// What later strikes may change the velocity of the center of mass by: all of the energy that is left is given back there.
    pub(crate) center_m_s: f64,
    /// How far it has leaned at most from the face that it landed over: 1 balanced over an edge, more where it has fallen over.
    pub(super) lean: f64,
    times_s: Vec<f64>,
    /// Along each axis of the box, what the center of mass feels, and what a meter along x, y and z adds.
    felt: Vec<[[f64; 4]; 3]>,
    /// The vertical in axes of the box.
    upward: Vec<[f64; 3]>,
    /// Whether a corner is pressed from a sample to the next.
    pressed: Vec<bool>,
}

/// Straight lines in a step of a box, which is a small part of a contact.
const LINES: u32 = 4;

impl BlockMotion {
    pub(crate) fn new(drop: &BlockDrop, contacts: &[Contact; 8]) -> Result<Self, Error> {
        let (mut times_s, mut felt, mut upward, mut pressed) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let (block, from, mut lean) = (drop.block(), drop.upward(), 0.0_f64);
        let flight = drop.own_contacts(contacts, |step| {
            lean = lean.max(block.lean(step.upward(1.0), from));
            for k in 0..=LINES {
                let share = f64::from(k) / f64::from(LINES);
                times_s.push(step.from_s + share * step.length_s);
                felt.push(step.felt_everywhere(share));
                upward.push(step.upward(share));
                pressed.push(step.presses());
            }
        })?;
        let most_e = contacts.iter().fold(0.0_f64, |most, contact| most.max(contact.restitution()));
        let of_left = (1.0 + most_e) * flight.left_m_s;
        let (center_m_s, stop) = match flight.stop {
            Stop::AtRest { shock_bound_m_s, .. } => (shock_bound_m_s, flight.stop),
            Stop::TimeLimit { time_s } | Stop::ImpactLimit { time_s } | Stop::Enough { time_s } => {
                (of_left, Stop::Enough { time_s })
            }
            stop => (if matches!(stop, Stop::BouncedClear { .. }) { 0.0 } else { f64::INFINITY }, stop),
        };
        let gravity_m_s2 = drop.gravity_m_s2();
        Ok(Self { contacts: *contacts, gravity_m_s2, flight, stop, center_m_s, lean, times_s, felt, upward, pressed })
    }

    /// The samples between which the motion goes on, each with the next.
    fn steps(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        (1..self.times_s.len()).map(|k| [k - 1, k]).filter(|[j, k]| self.times_s[*j] < self.times_s[*k])
    }
    /// A value of every sample as straight lines.
    fn lines(&self, of: impl Fn(usize) -> f64) -> Excitation {
        let values: Vec<f64> = (0..self.felt.len()).map(of).collect();
        let mut all = Excitation::with_capacity(values.len());
        for [j, k] in self.steps() {
            let section = Section::shock(self.times_s[j], self.times_s[k] - self.times_s[j], 0.0);
            all.push(Section { acceleration: [values[j], values[k]], free: !self.pressed[j], ..section });
        }
        all
    }
    /// What a place from the center of mass feels along an axis of the box at a sample.
    fn felt_at(&self, [x, y, z]: [f64; 3], sample: usize, axis: usize) -> f64 {
        let of = &self.felt[sample][axis];
        of[0] + x * of[1] + y * of[2] + z * of[3]
    }
    /// What a place feels along an axis, from the center of mass.
    pub(crate) fn felt(&self, place: [f64; 3], axis: Axis) -> Excitation {
        match axis {
            Axis::X | Axis::Y | Axis::Z => self.lines(|k| self.felt_at(place, k, axis as usize)),
            Axis::Any => self.lines(|k| {
                let [x, y, z] = [0, 1, 2].map(|i| self.felt_at(place, k, i));
                libm::hypot(libm::hypot(x, y), z)
            }),
        }
    }
    /// The acceleration of a place from the center of mass along an axis, of any along all three: what it feels but for the share of
    /// gravity there, which follows the attitude.
    pub(crate) fn moved(&self, place: [f64; 3], axis: Axis) -> Vec<Excitation> {
        let along =
            |axis: usize| self.lines(|k| self.felt_at(place, k, axis) - self.gravity_m_s2 * self.upward[k][axis]);
        match axis {
            Axis::X | Axis::Y | Axis::Z => vec![along(axis as usize)],
            Axis::Any => (0..3).map(along).collect(),
        }
    }
    /// What a place from the center of mass feels along an axis once the box lies as it does at the end.
    pub(crate) fn carried_m_s2(&self, place: [f64; 3], axis: Axis) -> f64 {
        let [x, y, z] = self.flight.at_rest_m_s2(place, self.gravity_m_s2);
        match axis {
            Axis::X => x,
            Axis::Y => y,
            Axis::Z => z,
            Axis::Any => libm::hypot(libm::hypot(x, y), z),
        }
    }
    /// How far a corner has sunk in at most.
    pub(crate) fn deepest_m(&self) -> f64 {
        self.flight.deepest_m
    }
    /// When corners touch and part.
    pub(crate) fn presses(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        self.flight.strikes.iter().map(|strike| (strike.corner, [strike.time_s, strike.until_s]))
    }
    /// When the last contact parted.
    pub(crate) fn parted_s(&self) -> f64 {
        self.presses().fold(0.0, |last, press| last.max(press.1[1]))
    }
    /// The angular acceleration about an axis.
    pub(crate) fn turned_about(&self, about: [f64; 3]) -> Excitation {
        self.lines(|k| angular_acceleration(&self.felt[k]).iter().zip(about).map(|(a, b)| a * b).sum())
    }
    /// The most that the angular velocity about each axis changes by while it keeps on growing or falling under the presses, which no
    /// shock about it exceeds: the most first, with the axis.
    pub(crate) fn swings(&self) -> Vec<(f64, [f64; 3])> {
        let turned: Vec<[f64; 3]> = self.felt.iter().map(angular_acceleration).collect();
        let of = |about: [f64; 3]| {
            let along = |turned: &[f64; 3]| turned.iter().zip(about).map(|(a, b)| a * b).sum::<f64>();
            let (mut swing, mut most) = (0.0_f64, 0.0_f64);
            let mut goes_on = |change: f64| {
                swing = if swing * change > 0.0 { swing + change } else { change };
                most = most.max(swing.abs());
            };
            for [j, k] in self.steps() {
                let (length, [a, b]) = (self.times_s[k] - self.times_s[j], [&turned[j], &turned[k]].map(along));
                if !self.pressed[j] {
                    goes_on(0.0);
                } else if a * b < 0.0 {
                    // It turns around on the way.
                    goes_on(0.5 * length * a * a / (a - b));
                    goes_on(-0.5 * length * b * b / (a - b));
                } else {
                    goes_on(0.5 * length * (a + b));
                }
            }
            (most, about)
        };
        let mut all: Vec<_> = axes().map(of).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all
    }
}

/// Half of what it does to places on both sides, by the curl of what they feel.
fn angular_acceleration([x, y, z]: &[[f64; 4]; 3]) -> [f64; 3] {
    [z[2] - y[3], x[3] - z[1], y[1] - x[2]].map(|twice| 0.5 * twice)
}

/// Axes about which the turning of a box is looked at, all over half of a sphere: one is within 14° of any, 3 %.
const AXES: u32 = 64;

pub(super) fn axes() -> impl Iterator<Item = [f64; 3]> {
    (0..AXES).map(|k| {
        let z = (f64::from(k) + 0.5) / f64::from(AXES);
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * (0.618_033_988_749_895 * f64::from(k)).fract());
        let across = (1.0 - z * z).sqrt();
        [across * cos, across * sin, z]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ContactLaw;

    /// A box that lands flat, with μ = 1 + (60/Ry)² + (40/Rx)² of a corner.
    fn flat() -> (BlockDrop, [Contact; 8], f64) {
        let (across, along, turning) = (0.04_f64, 0.059_f64, 0.07_f64);
        let block = crate::Block::new([0.12, 0.08, 0.02], [0.0; 3], [across, along, turning]).unwrap();
        let own = 1.0 + (0.06 / along).powi(2) + (0.04 / across).powi(2);
        let drop = BlockDrop::tilted(block, 0.0, 0.0, 2.0, 9.81).unwrap();
        (drop, [Contact::new(ContactLaw::Hysteretic, 0.6, 2e-4).unwrap(); 8], own)
    }

    /// It lands again with e times its speed, which changes the velocity of its center by (1 + e) e v.
    #[test]
    fn the_next_landing_is_within_what_is_told() {
        let (drop, contact, own) = flat();
        let motion = BlockMotion::new(&drop.with_time_limit_s(0.02).unwrap(), &contact).unwrap();
        // Gravity works during the contact, by a thousandth.
        assert!((motion.center_m_s / (1.6 * 0.6 * 2.0) - 1.0).abs() < 5e-3, "{}", motion.center_m_s);
        // Four springs at once, each of a lone contact at a corner.
        let lasts = 2e-4 * (own / 4.0).sqrt();
        assert!(
            (motion.parted_s() / lasts - 1.0).abs() < 5e-3
                && motion.presses().map(|press| press.1[0]).collect::<Vec<_>>() == [0.0; 4],
            "{}",
            motion.parted_s()
        );
    }

    /// After three of four corners all of its energy is left, but for what they have lost in the first hundredth of their contact.
    #[test]
    fn strikes_that_are_cut_off_leave_the_energy_of_the_drop() {
        let (drop, contact, _) = flat();
        let motion = BlockMotion::new(&drop.with_impact_limit(3), &contact).unwrap();
        assert!((motion.center_m_s / (1.6 * 2.0) - 1.0).abs() < 1e-3, "{}", motion.center_m_s);
    }

    /// Whatever a plate or a box turns about, one of the axes that are looked at is near it.
    #[test]
    fn axes_of_turning_lie_all_over() {
        for k in 0..720 {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 720.0).sin_cos();
            for z in [-0.9_f64, -0.5, 0.0, 0.3, 0.7, 1.0] {
                let across = (1.0 - z * z).sqrt();
                let about = axes().map(|[x, y, up]| (across * (cos * x + sin * y) + z * up).abs()).fold(0.0, f64::max);
                assert!(about > 0.97, "{k}, {z}: {about}");
            }
        }
    }
}
