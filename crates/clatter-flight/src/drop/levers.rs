//! Lever arms: what a push at a point does to a place.

use super::{Drop, Engine};
use crate::{Axis, Place};

/// Lever arms of a place in a box.
#[derive(Debug, Clone, Copy)]
pub struct Levers {
    /// From the center of mass to the farthest corner.
    pub farthest_m: f64,
    /// From there to the place.
    pub place_m: f64,
    /// The most that a push at a corner across the vertical does to the place along the axis of the part, over what it does to the center of
    /// mass.
    pub across: f64,
}

impl Drop {
    /// Points that touch the ground and a place, from the center of mass, in units in which an impulse of 1 over the mass at p does
    /// 1 + p·q to q: x/ρ of a bar. Of a box these are bounds that hold however it lies: impulses at a corner q do no more than
    /// `√(1 + q²) √(1 + p²)` to the place along the axis of the part.
    #[must_use]
    pub fn in_radii(&self, place: &Place) -> (Vec<[f64; 2]>, [f64; 2]) {
        let (body, [x, y, _]) = (&self.body, self.body.from_center(place.at_m));
        let ([a, b], rho) = (body.arms_m(), body.gyration_m());
        let beyond = body.feet.map(|feet| feet.inset_m);
        let Some(width) = &body.width else {
            let mut ends = vec![[-a / rho, 0.0], [b / rho, 0.0]];
            ends.extend(beyond.into_iter().flat_map(|[x, _]| [[-(a + x) / rho, 0.0], [(b + x) / rho, 0.0]]));
            return (ends, [x / rho, 0.0]);
        };
        if self.is_solid() {
            return self.in_radii_of_box(place);
        }
        let lean = body.products_m2[0] / (rho * rho);
        let across = (width.gyration_m * width.gyration_m - lean * lean * rho * rho).sqrt();
        let of = |[x, y]: [f64; 2]| [x / rho, (y - lean * x) / across];
        let [front, back] = width.ends_m;
        let corners =
            |[x, y]: [f64; 2]| [[-a - x, -front - y], [b + x, -front - y], [b + x, back + y], [-a - x, back + y]];
        let all = std::iter::once([0.0; 2]).chain(beyond).flat_map(corners);
        (all.map(of).collect(), of([x, y]))
    }
    /// The same of a box, with p the lever arm of the axis over the radii of gyration.
    fn in_radii_of_box(&self, place: &Place) -> (Vec<[f64; 2]>, [f64; 2]) {
        // A box that is not followed has no bound.
        let Some(block) = self.as_box() else { return (vec![[f64::INFINITY, 0.0]; 4], [f64::INFINITY, 0.0]) };
        let (at, least) = (self.body.from_center(place.at_m), block.least_gyration_m());
        let far = |place: [f64; 3]| dot(place, place).sqrt() / least;
        // What turning adds to a blow with this arm about the center of mass: √(a J⁻¹ a).
        let turned = |arm: [f64; 3]| dot(arm, block.turned_by(arm)).sqrt();
        let here = arm(at, place.axis).map_or_else(|| far(at), turned);
        let farthest = block.corners_m().into_iter().map(far).fold(0.0, f64::max);
        (vec![[farthest, 0.0]; 4], [here, 0.0])
    }
    /// The lever arms that bound a push across at a corner of a box; none of other bodies.
    #[must_use]
    pub fn levers(&self, place: &Place) -> Option<Levers> {
        let block = self.as_box()?;
        let at = self.body.from_center(place.at_m);
        let farthest_m = block.corners_m().into_iter().map(size).fold(0.0, f64::max);
        // The spin that a push of 1 over the mass at the place along the axis gives.
        let spins = arm(at, place.axis)
            .map_or_else(|| size(at) / block.least_gyration_m().powi(2), |arm| size(block.turned_by(arm)));
        Some(Levers { farthest_m, place_m: size(at), across: 1.0 + spins * farthest_m })
    }
    /// The smallest radius of gyration; 0 of a box that no body is.
    #[must_use]
    pub fn least_gyration_m(&self) -> f64 {
        match self.engine() {
            Engine::Planar | Engine::Level => self.body.gyrations_in_plane_m()[0],
            Engine::Solid => self.as_box().map_or(0.0, |block| block.least_gyration_m()),
        }
    }
    /// Position s, −1 the end that touches first and 1 the other, of a place in m from the middle; beyond them where the product goes on
    /// beyond its feet.
    #[must_use]
    pub fn relative(&self, position_m: f64) -> f64 {
        let most = self.sides_m()[0] / self.body.length_m();
        let s = (2.0 * position_m / self.body.length_m()).clamp(-most, most);
        self.signs()[0] * s
    }
    /// A place of a plate from its middle, as its scene has it: from the center of mass.
    pub(crate) fn in_scene(&self, place: &Place) -> [f64; 2] {
        let ([sx, sy], [x, y, _]) = (self.signs(), self.body.from_center(place.at_m));
        [sx * x, sy * y]
    }
}

/// The moment about the center of mass of a push of 1 along an axis at a place; none along any.
fn arm([x, y, z]: [f64; 3], axis: Axis) -> Option<[f64; 3]> {
    match axis {
        Axis::X => Some([0.0, z, -y]),
        Axis::Y => Some([-z, 0.0, x]),
        Axis::Z => Some([y, -x, 0.0]),
        Axis::Any => None,
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn size(a: [f64; 3]) -> f64 {
    libm::hypot(libm::hypot(a[0], a[1]), a[2])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::{Body, Side};

    /// A box of these sides, with these radii of gyration along length and width, that rises steeply to its end b.
    fn dropped([length, width, thickness_m]: [f64; 3], [kx, ky]: [f64; 2], center: f64) -> Drop {
        let width = Side { ends_m: [0.5 * width + center, 0.5 * width - center], gyration_m: ky };
        let body = Body::new(length, kx).unwrap().with_width(width).with_thickness(Side::even(thickness_m));
        Drop {
            is_level: false,
            base: [0.6, 0.0, 0.8],
            direction_rad: 0.3,
            gravity_m_s2: 9.81,
            contact_time_s: Some(1e-4),
            ..Drop::new(body, 3.0, 0.05, 0.4)
        }
    }

    fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }

    /// A blow of 1 over the mass on a corner, along any line, does no more to a place than the arms of both allow.
    #[test]
    fn no_blow_on_a_corner_does_more_to_a_place_than_its_arms_allow() {
        // Mass near the middle of a broad box, and near the sides of a tower.
        let (broad, tower) = (([0.06, 0.15, 0.01], [0.03, 0.012]), ([0.05, 0.05, 0.2], [0.025, 0.025]));
        let mut tightest = 0.0_f64;
        for ((size, gyration), n) in [broad, tower].into_iter().flat_map(|of| (0..200).map(move |n| (of, n))) {
            let x = |k: u32| f64::from((n * k + 7) % 199) / 199.0 - 0.5;
            let mut drop = dropped(size, gyration, 0.1 * size[1] * x(3));
            drop.body.products_m2[0] = x(31) * gyration[0] * gyration[1];
            let (at_m, height_m) = ([size[0] * x(5), size[1] * x(11)], size[2] * x(17));
            let block = drop.block_drop().unwrap().block();
            let place = block.place([at_m[0], at_m[1], height_m]);
            let z = 2.0 * x(23);
            let (sin, cos) = (TAU * x(29)).sin_cos();
            let along = [(1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z];
            for (axis, index) in [(Axis::X, Some(0)), (Axis::Y, Some(1)), (Axis::Z, Some(2)), (Axis::Any, None)] {
                let (points, here) = drop.in_radii(&Place { at_m: [at_m[0], at_m[1], height_m], axis });
                let root = |[x, y]: [f64; 2]| (1.0 + x * x + y * y).sqrt();
                let most = points.iter().map(|point| root(*point) * root(here)).fold(0.0, f64::max);
                for corner in block.corners_m() {
                    let moment = cross(corner, along);
                    let turned = cross(block.turned_by(moment), place);
                    let change: [f64; 3] = std::array::from_fn(|i| along[i] + turned[i]);
                    let felt = index
                        .map_or_else(|| change.iter().map(|c| c * c).sum::<f64>().sqrt(), |i: usize| change[i].abs());
                    assert!(felt <= most * (1.0 + 1e-9), "{n}, {axis:?}: {felt} beyond {most}");
                    tightest = tightest.max(felt / most);
                }
            }
        }
        assert!(tightest > 0.7, "{tightest}: far from what is allowed, nothing would be seen");
    }

    /// In radii of gyration a blow at one place does 1 + p·q to another: with masses askew 1 + r C⁻¹ r′, C their second moments.
    #[test]
    fn a_blow_on_a_plate_does_what_its_second_moments_say() {
        let (kx, ky, c) = (0.043_f64, 0.02_f64, 5e-4);
        let mut drop = dropped([0.15, 0.07, 0.004], [kx, ky], 0.01);
        (drop.body.products_m2[0], drop.is_level) = (c, true);
        let (corners, here) = drop.in_radii(&Place::flat([0.05, 0.02]));
        let whole = kx * kx * ky * ky - c * c;
        // The center of mass is 10 mm off across: the edges lie 45 mm in front and 25 mm behind.
        let place = [0.05, 0.01];
        for (corner, [x, y]) in corners.iter().zip([[-0.075, -0.045], [0.075, -0.045], [0.075, 0.025], [-0.075, 0.025]])
        {
            let moments = ky * ky * x * place[0] + kx * kx * y * place[1] - c * (x * place[1] + y * place[0]);
            let [told, want] = [1.0 + corner[0] * here[0] + corner[1] * here[1], 1.0 + moments / whole];
            assert!((told - want).abs() < 1e-12, "{x}, {y}: {told}, not {want}");
        }
    }
}
