//! The motion of a bar, of a plate or of a box, as what follows a drop needs it.

use clatter::{Excitation, Section};
use clatter_flight::{BlockDrop, Contact, Error, Motion, PlateMotion, Stop};

/// What became of a drop.
#[derive(Debug, Clone)]
pub(crate) enum Course {
    Bar(Motion),
    Plate(PlateMotion),
    Block(BlockMotion),
}

/// The same of a bar and of a plate, and of a box.
macro_rules! of_each {
    ($course:expr, $motion:ident => $what:expr, $block:ident => $other:expr) => {
        match $course {
            Course::Bar($motion) => $what,
            Course::Plate($motion) => $what,
            Course::Block($block) => $other,
        }
    };
}

/// A motion of a box, followed to a time, as places in it feel it across its length and width.
#[derive(Debug, Clone)]
pub(crate) struct BlockMotion {
    contact: Contact,
    gravity_m_s2: f64,
    stop: Stop,
    presses: Vec<(usize, [f64; 2])>,
    largest_m_s: f64,
    times_s: Vec<f64>,
    /// What the center of mass feels, and what a meter along x and along y adds.
    felt: [Vec<f64>; 3],
}

/// Straight lines in a step of a box, which is a small part of a contact.
const LINES: u32 = 4;

impl BlockMotion {
    pub(crate) fn new(drop: &BlockDrop, contact: &Contact) -> Result<Self, Error> {
        let (mut times_s, mut felt) = (Vec::new(), [const { Vec::new() }; 3]);
        let places = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let flight = drop.contacts(contact, |step| {
            for k in 0..=LINES {
                let share = f64::from(k) / f64::from(LINES);
                times_s.push(step.from_s + share * step.length_s);
                let [center, x, y] = places.map(|place| step.felt_m_s2(place, share)[2]);
                for (values, value) in felt.iter_mut().zip([center, x - center, y - center]) {
                    values.push(value);
                }
            }
        })?;
        let largest_m_s = flight.strikes.iter().flat_map(|s| s.delta_v_m_s).fold(0.0_f64, |most, v| most.max(v.abs()));
        let presses = flight.strikes.iter().map(|s| (s.corner, [s.time_s, s.until_s])).collect();
        let (stop, gravity_m_s2) = (flight.stop, drop.gravity_m_s2());
        Ok(Self { contact: *contact, gravity_m_s2, stop, presses, largest_m_s, times_s, felt })
    }

    /// What a sum of these shares of center, x and y feels.
    fn felt_by(&self, shares: [f64; 3]) -> Excitation {
        let at = |k: usize| (0..3).map(|i| shares[i] * self.felt[i][k]).sum::<f64>();
        let mut all = Excitation::with_capacity(self.times_s.len());
        for (k, times) in self.times_s.windows(2).enumerate().filter(|(_, times)| times[0] < times[1]) {
            let section = Section::shock(times[0], times[1] - times[0], 0.0);
            all.push(Section { acceleration: [at(k), at(k + 1)], ..section });
        }
        all
    }
    /// What a place feels, x, y in m from the center of mass.
    pub(crate) fn felt(&self, [x, y]: [f64; 2]) -> Excitation {
        self.felt_by([1.0, x, y])
    }
}

/// Directions along a plate, between which the change of its angular velocity is at most half a percent more than along one of them.
const DIRECTIONS: u32 = 16;

/// Directions all over half a turn.
fn directions() -> impl Iterator<Item = [f64; 2]> {
    (0..DIRECTIONS).map(|k| {
        let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(k) / f64::from(DIRECTIONS));
        [cos, sin]
    })
}

impl Course {
    pub(crate) fn contact(&self) -> Option<Contact> {
        of_each!(self, motion => motion.contact(), block => Some(block.contact))
    }
    pub(crate) fn stop(&self) -> Stop {
        of_each!(self, motion => motion.stop, block => block.stop)
    }
    pub(crate) fn later_m_s(&self) -> f64 {
        of_each!(self, motion => motion.later_m_s, _block => 0.0)
    }
    pub(crate) fn largest_m_s(&self) -> f64 {
        of_each!(self, motion => motion.largest_m_s(), block => block.largest_m_s)
    }
    pub(crate) fn gravity_m_s2(&self) -> f64 {
        of_each!(self, motion => motion.gravity_m_s2(), block => block.gravity_m_s2)
    }
    pub(crate) fn parted_s(&self) -> f64 {
        of_each!(self, motion => motion.parted_s(), block => block.presses.iter().fold(0.0, |last, press| last.max(press.1[1])))
    }
    /// When strikes begin, in order.
    pub(crate) fn struck_s(&self) -> Vec<f64> {
        of_each!(
            self,
            motion => motion.strikes.iter().map(|strike| strike.time_s).collect(),
            block => block.presses.iter().map(|press| press.1[0]).collect()
        )
    }
    /// Of each strike of contacts that take time, the point, and when it touches and parts.
    pub(crate) fn presses(&self) -> Vec<(usize, [f64; 2])> {
        of_each!(self, motion => {
            let pressed = motion.strikes.iter().zip(&motion.presses);
            pressed.map(|(strike, press)| (strike.point, [press.from_s, press.until_s])).collect()
        }, block => block.presses.clone())
    }
    /// The angular acceleration, in rad where what a place feels has m: of a plate about several axes.
    pub(crate) fn turned(&self) -> Vec<Excitation> {
        match self {
            Self::Bar(motion) => vec![motion.turned()],
            Self::Plate(motion) => directions().map(|along| motion.turned(along)).collect(),
            Self::Block(motion) => directions().map(|[x, y]| motion.felt_by([0.0, x, y])).collect(),
        }
    }
}
