//! Edges that lie beyond feet, which must stay off the ground.

use std::f64::consts::PI;

use clatter_flight::Stop;

use super::Followed;
use crate::course::Course;
use crate::{Error, Feet, Spread};

/// Steps of a press or a flight in which the edges are looked at: of a half-sine each misses the lowest by 1/200 of its depth.
const STEPS: u32 = 16;

/// From when to when, and whether no foot presses.
struct Stretch {
    span_s: [f64; 2],
    flies: bool,
}

impl Feet {
    /// How far below its foot the lowest edge lies of a product with these slopes along the length and along the width.
    fn below_m(&self, [along, across]: [f64; 2]) -> f64 {
        let [x, y] = self.inset_m;
        x * along.abs() + y * across.abs()
    }
    /// The steepest tilt at which a foot touches before the edge beyond it, in all of these directions; of a plate any, unless given.
    pub(crate) fn steepest_rad(&self, direction_rad: Option<&Spread>) -> f64 {
        let [x, y] = self.inset_m;
        let farthest_m = libm::hypot(x, y);
        let overhang_m = direction_rad.map_or(farthest_m, |given| {
            let within = |direction: f64| (given.lo()..=given.hi()).contains(&direction);
            let corner = libm::atan2(y, x);
            let at = |direction: f64| self.below_m([libm::cos(direction), libm::sin(direction)]);
            let over_a_corner = [corner, PI - corner, PI + corner, 2.0 * PI - corner].into_iter().any(within);
            if over_a_corner { farthest_m } else { at(given.lo()).max(at(given.hi())) }
        });
        libm::atan2(self.height_m, overhang_m)
    }
    /// Height of the lower edge of a bar, from those of its feet so far apart.
    fn of_bar(&self, [a, b]: [f64; 2], apart_m: f64) -> f64 {
        let slope = (b - a) / apart_m;
        let up = self.height_m * (1.0 - slope * slope).max(0.0).sqrt();
        a.min(b) - self.below_m([slope, 0.0]) + up
    }
    /// The same of the lowest corner of a plate, whose feet are so far apart along and across it.
    fn of_plate(&self, heights_m: [f64; 4], [along_m, across_m]: [f64; 2]) -> f64 {
        let [a, b, _, d] = heights_m;
        let [x, y] = [(b - a) / along_m, (d - a) / across_m];
        let up = self.height_m * (1.0 - x * x - y * y).max(0.0).sqrt();
        heights_m.into_iter().fold(f64::INFINITY, f64::min) - self.below_m([x, y]) + up
    }
}

impl Followed {
    /// When the product last rose before an edge comes down to the ground after the clatter; none where none does. From then on its energy
    /// bounds what the edges do, wherever it is struck.
    ///
    /// # Errors
    /// [`Error::Edge`] where one comes down in the clatter, or where some foot has pressed ever since.
    pub(super) fn rises_before_edge_s(&self) -> Result<Option<f64>, Error> {
        let Some(feet) = &self.drop.feet else { return Ok(None) };
        let clatter_s = self.drop.clatter_s();
        let (mut lowest_m, mut at_s, mut rose_s) = (0.0, 0.0, None);
        for Stretch { span_s: [from_s, until_s], flies } in self.stretches() {
            if flies && from_s > 0.0 {
                rose_s = Some(from_s);
            }
            for time_s in (0..=STEPS).map(|k| from_s + (until_s - from_s) * f64::from(k) / f64::from(STEPS)) {
                let edge_m = self.lowest_edge_m(feet, time_s);
                if time_s > clatter_s && edge_m < 0.0 && lowest_m == 0.0 {
                    return rose_s.map(Some).ok_or(Error::Edge { time_s, depth_m: -edge_m });
                }
                if time_s <= clatter_s && edge_m < lowest_m {
                    (lowest_m, at_s) = (edge_m, time_s);
                }
            }
        }
        if lowest_m < 0.0 { Err(Error::Edge { time_s: at_s, depth_m: -lowest_m }) } else { Ok(None) }
    }
    /// The motion in stretches in which some foot presses or the product flies, in order.
    fn stretches(&self) -> Vec<Stretch> {
        // Clear of the ground for ever as it is without gravity, its edges may still come down; where that takes longer than the fall of
        // a length they are slow.
        let clear_s = self.drop.body.length_m() / self.drop.speed_m_s;
        let end_s = match self.motion.stop() {
            Stop::BouncedClear { time_s } => time_s + clear_s,
            stop => stop.time_s(),
        };
        let mut spans: Vec<[f64; 2]> = self.motion.presses().into_iter().map(|(_, press)| press).collect();
        spans.extend(self.motion.struck_s().into_iter().map(|time_s| [time_s; 2]));
        spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let (mut all, mut now_s) = (Vec::with_capacity(2 * spans.len() + 1), 0.0);
        for [from_s, until_s] in spans.into_iter().chain([[end_s; 2]]) {
            let until_s = until_s.min(end_s);
            if from_s > now_s {
                all.push(Stretch { span_s: [now_s, from_s], flies: true });
            }
            if until_s > from_s.max(now_s) {
                all.push(Stretch { span_s: [from_s.max(now_s), until_s], flies: false });
            }
            now_s = until_s.max(from_s).max(now_s);
        }
        all
    }
    fn lowest_edge_m(&self, feet: &Feet, time_s: f64) -> f64 {
        let along_m = self.drop.body.length_m();
        match (&self.motion, &self.drop.across) {
            (Course::Bar(motion), _) => feet.of_bar(motion.at(time_s).height_m, along_m),
            (Course::Plate(motion), Some(across)) => motion
                .sample(time_s)
                .map_or(f64::INFINITY, |sample| feet.of_plate(sample.height_m, [along_m, across.width.m()])),
            // Boxes have no feet.
            (Course::Plate(_) | Course::Block(_), _) => f64::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use clatter::End;
    use clatter_flight::{Body, ContactLaw};

    use super::*;
    use crate::Width;
    use crate::drop::{Across, SingleDrop};

    /// A plate turned any way: its third axis in the world tells how high its feet and its edges, 6 mm over them, are.
    #[test]
    fn edges_are_as_high_as_those_of_a_turned_plate() {
        let feet = Feet { inset_m: [0.03, 0.02], height_m: 6e-3 };
        for k in 0..24 {
            let (direction, tilt) = (f64::from(k) * PI / 12.0, 0.02 * f64::from(k + 1));
            let (sin, cos) = direction.sin_cos();
            let upward = [tilt.sin() * cos, tilt.sin() * sin, tilt.cos()];
            let height = |[x, y, z]: [f64; 3]| upward[0] * x + upward[1] * y + upward[2] * z + 0.01;
            let corners = |x: f64, y: f64, z: f64| [[-x, -y, z], [x, -y, z], [x, y, z], [-x, y, z]].map(height);
            let lowest = corners(0.15, 0.105, 6e-3).into_iter().fold(f64::INFINITY, f64::min);
            let told = feet.of_plate(corners(0.12, 0.085, 0.0), [0.24, 0.17]);
            assert!((told - lowest).abs() < 1e-15, "{direction}: {told}, not {lowest}");
            // Seen from the side.
            let [a, b] = [-0.12, 0.12].map(|x| tilt.sin() * x);
            let told = feet.of_bar([a, b], 0.24);
            assert!((told - (6e-3 * tilt.cos() - 0.15 * tilt.sin())).abs() < 1e-15, "{tilt}: {told}");
        }
    }

    /// As far as a drop is answered its edges stay off the ground, of bars and plates, with instant impacts and with contacts; where they
    /// do not it is refused, or left before, with the energy that is left.
    #[test]
    fn a_drop_that_is_answered_has_its_edges_off_the_ground() {
        let (mut whole, mut left, mut refused) = (0, 0, 0);
        for n in 0..300_u32 {
            let x = |k: u32| f64::from((n * k + 11) % 97) / 97.0;
            let edges_m = [0.04 + 0.02 * x(5), 0.05];
            let width = Width {
                edges_m,
                gyration_m: 0.02 + 0.01 * x(7),
                product_of_inertia_m2: 0.0,
                thickness_m: None,
                depth: None,
            };
            let (is_plate, contacts) = (n % 3 == 0, n % 3 != 1);
            let direction_rad = 2.0 * PI * x(13);
            let across = is_plate.then_some(Across { width, direction_rad, posture: None });
            let feet = Feet {
                inset_m: [0.01 + 0.05 * x(17), if is_plate { 0.02 * x(19) } else { 0.0 }],
                height_m: 3e-3 + 0.01 * x(23),
            };
            let drop = SingleDrop {
                body: Body::off_center(0.05 + 0.03 * x(29), 0.06, 0.03 + 0.02 * x(31)).unwrap(),
                across,
                first: across.map_or(End::A, |across| across.first()),
                tilt_rad: 0.9 * feet.steepest_rad(None) * x(37),
                flat: false,
                speed_m_s: 1.0 + 3.0 * x(41),
                spin_rad_s: 0.0,
                restitution: 0.6 * x(43),
                gravity_m_s2: 9.81,
                contact_time_s: contacts.then_some(4e-4),
                contact_law: ContactLaw::Hysteretic,
                feet: Some(feet),
                own_contacts: crate::OwnContacts::NONE,
            };
            let alone = Followed::new(&SingleDrop { feet: None, ..drop }, drop.fullest(), 0.01);
            match (Followed::new(&drop, drop.fullest(), 0.01), alone) {
                (Err(Error::Edge { depth_m, .. }), _) => {
                    assert!(depth_m > 0.0);
                    refused += 1;
                }
                (Ok(followed), Ok(alone)) => {
                    let lowest = |followed: &Followed| {
                        // Left before an edge comes down, it is followed until its last press.
                        let end_s = if followed.before_edge {
                            followed.motion.parted_s()
                        } else {
                            followed.motion.stop().time_s()
                        };
                        (0..2000)
                            .map(|k| followed.lowest_edge_m(&feet, end_s * f64::from(k) / 2000.0))
                            .fold(0.0, f64::min)
                    };
                    // What lies between the steps in which edges are looked at.
                    assert!(lowest(&followed) > -2e-5, "{n}: {} in {drop:?}", lowest(&followed));
                    let is_left = followed.before_edge;
                    assert!(is_left || followed.motion.stop() == alone.motion.stop(), "{n}");
                    assert!(!is_left || followed.is_early() && followed.quiet_s() <= 0.0, "{n}");
                    (whole, left) = (whole + u32::from(!is_left), left + u32::from(is_left));
                }
                (Err(_), Err(_)) => {}
                (followed, alone) => panic!("{n}: {followed:?} beside {alone:?}"),
            }
        }
        assert!(whole > 50 && left > 50 && refused > 5, "{whole}, {left}, {refused}");
    }
}
