//! Edges that lie beyond feet: at which tilt a foot touches first, and when one comes down by instant impacts, which know the feet alone.

use std::f64::consts::PI;

use super::{Course, Followed};
use crate::{Error, Feet, Stop};

/// Steps of a flight in which the edges are looked at.
const STEPS: u32 = 16;
/// Halvings of such a step to the touch.
const HALVINGS: u32 = 40;

impl Feet {
    /// How far below its foot the lowest edge lies of a product with these slopes along the length and along the width.
    fn below_m(&self, [along, across]: [f64; 2]) -> f64 {
        let [x, y] = self.inset_m;
        x * along.abs() + y * across.abs()
    }
    /// The steepest tilt at which a foot touches before the edge beyond it, in all of these directions; of a plate any, unless given.
    #[must_use]
    pub fn steepest_rad(&self, direction_rad: Option<[f64; 2]>) -> f64 {
        let [x, y] = self.inset_m;
        let farthest_m = libm::hypot(x, y);
        let overhang_m = direction_rad.map_or(farthest_m, |[lo, hi]| {
            let within = |direction: f64| (lo..=hi).contains(&direction);
            let corner = libm::atan2(y, x);
            let at = |direction: f64| self.below_m([libm::cos(direction), libm::sin(direction)]);
            let over_a_corner = [corner, PI - corner, PI + corner, 2.0 * PI - corner].into_iter().any(within);
            if over_a_corner { farthest_m } else { at(lo).max(at(hi)) }
        });
        libm::atan2(self.height_m, overhang_m)
    }
    /// Height of the lower edge of a bar, from those of its feet so far apart.
    fn of_bar(&self, [a, b]: [f64; 2], apart_m: f64) -> f64 {
        let slope = (b - a) / apart_m;
        let up = self.height_m * (1.0 - slope * slope).max(0.0).sqrt();
        a.min(b) - self.below_m([slope, 0.0]) + up
    }
}

impl Followed {
    /// Until when the edges of a bar by instant impacts are off the ground after its clatter; none where they stay there. From then on its
    /// energy bounds what they do.
    ///
    /// # Errors
    /// [`Error::Edge`] where one comes down in the clatter.
    pub(super) fn edge_comes_down_s(&self) -> Result<Option<f64>, Error> {
        let (Some(feet), Course::Bar(motion)) = (&self.drop.body.feet, &self.motion) else { return Ok(None) };
        let edge_m = |time_s: f64| feet.of_bar(motion.at(time_s).height_m, self.drop.body.length_m());
        // Clear of the ground for ever as it is without gravity, its edges may still come down; where that takes longer than the fall of
        // a length they are slow.
        let clear_s = self.drop.body.length_m() / self.drop.speed_m_s;
        let end_s = match motion.stop {
            Stop::BouncedClear { time_s } => time_s + clear_s,
            stop => stop.time_s(),
        };
        let (clatter_s, mut deepest) = (self.drop.clatter_s(), None);
        let (mut from_s, mut up_s) = (0.0, 0.0);
        for until_s in motion.strikes.iter().map(|strike| strike.time_s).chain([end_s]) {
            for time_s in (0..=STEPS).map(|k| from_s + (until_s - from_s) * f64::from(k) / f64::from(STEPS)) {
                let depth_m = -edge_m(time_s);
                if depth_m <= 0.0 {
                    up_s = time_s;
                } else if time_s > clatter_s && deepest.is_none() {
                    let halved = (0..HALVINGS).fold([up_s, time_s], |[up_s, down_s], _| {
                        let middle_s = 0.5 * (up_s + down_s);
                        if edge_m(middle_s) >= 0.0 { [middle_s, down_s] } else { [up_s, middle_s] }
                    });
                    return Ok(Some(halved[0]));
                } else if time_s <= clatter_s && deepest.is_none_or(|(_, most_m)| depth_m > most_m) {
                    deepest = Some((time_s, depth_m));
                }
            }
            from_s = until_s;
        }
        deepest.map_or(Ok(None), |(time_s, depth_m)| Err(Error::Edge { time_s, depth_m }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, Drop, Model, Until};

    /// The edges of a bar at a tilt, 6 mm over feet that are 30 mm inside them.
    #[test]
    fn edges_are_as_high_as_those_of_a_turned_bar() {
        let feet = Feet { inset_m: [0.03, 0.0], height_m: 6e-3 };
        for k in 1..24 {
            let tilt = 0.02 * f64::from(k);
            let [a, b] = [-0.12, 0.12].map(|x| tilt.sin() * x);
            let told = feet.of_bar([a, b], 0.24);
            assert!((told - (6e-3 * tilt.cos() - 0.15 * tilt.sin())).abs() < 1e-15, "{tilt}: {told}");
        }
    }

    /// As far as a drop by instant impacts is answered its edges stay off the ground; where they do not it is refused, or left where one
    /// comes down, with the energy that is left.
    #[test]
    fn a_drop_by_instant_impacts_is_left_where_an_edge_comes_down() {
        let (mut whole, mut left, mut refused) = (0, 0, 0);
        for n in 0..300_u32 {
            let x = |k: u32| f64::from((n * k + 11) % 97) / 97.0;
            let feet = Feet { inset_m: [0.01 + 0.05 * x(17), 0.0], height_m: 3e-3 + 0.01 * x(23) };
            let body = Body::off_center(0.05 + 0.03 * x(29), 0.06, 0.03 + 0.02 * x(31)).unwrap();
            let body = Body { feet: Some(feet), ..body };
            let tilt_rad = 0.9 * feet.steepest_rad(None) * x(37);
            let mut drop = Drop::new(body, 1.0 + 3.0 * x(41), tilt_rad, 0.6 * x(43));
            drop.gravity_m_s2 = 9.81;
            let follow = |drop: &Drop| Followed::new(drop, Model::FiniteTilt, 0.01, Until::Over);
            let alone = follow(&Drop { body: Body { feet: None, ..body }, ..drop }).unwrap();
            let lowest = |followed: &Followed| {
                let Course::Bar(motion) = &followed.motion else { panic!("a bar") };
                let at = |k: u32| motion.at(motion.stop.time_s() * f64::from(k) / 2000.0).height_m;
                (0..=2000).map(|k| feet.of_bar(at(k), drop.body.length_m())).fold(0.0, f64::min)
            };
            match follow(&drop) {
                Err(Error::Edge { depth_m, .. }) => {
                    assert!(depth_m > 0.0 && lowest(&alone) < 0.0, "{n}");
                    refused += 1;
                }
                Ok(followed) => {
                    // What lies between the steps in which edges are looked at.
                    assert!(lowest(&followed) > -2e-5, "{n}: {} in {drop:?}", lowest(&followed));
                    let is_left = matches!(followed.stop(), Stop::TimeLimit { .. });
                    assert!(is_left || followed.stop() == alone.stop(), "{n}");
                    if is_left {
                        let touches = feet.of_bar(
                            match &followed.motion {
                                Course::Bar(motion) => motion.at(motion.stop.time_s()).height_m,
                                _ => panic!("a bar"),
                            },
                            drop.body.length_m(),
                        );
                        assert!(followed.is_early() && touches.abs() < 1e-9, "{n}: {touches}");
                    }
                    (whole, left) = (whole + u32::from(!is_left), left + u32::from(is_left));
                }
                Err(error) => panic!("{n}: {error}"),
            }
        }
        assert!(whole > 50 && left > 20 && refused > 5, "{whole}, {left}, {refused}");
    }
}
