//! A rigid body and the points with which it touches the ground.

use clatter::Error;

use crate::scene::within;

/// A rigid body, seen from the side, that touches the ground with N points; a bar has two.
///
/// Points are given about the center of mass in the body's own axes: x along the body, z away from the ground where it
/// lies. At the tilt φ a point has the lever arm and the height over the center of mass
///
/// ```text
/// x cos φ − z sin φ,      x sin φ + z cos φ
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Profile<const N: usize = 2> {
    points: [[f64; 2]; N],
    gyration: f64,
}

impl<const N: usize> Profile<N> {
    /// A body with these contact points, \[x, z\] in m from the center of mass, and this radius of gyration about it.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless every coordinate is within 10³⁰ m, no two points are closer than 10⁻⁶ of their
    /// largest distance from the center of mass, and the radius of gyration is 0 or between 10⁻¹² and 10⁶ times that.
    ///
    /// # Examples
    /// A block of 2 m × 1 m that can land on each of its four corners:
    /// ```
    /// use clatter_flight::Profile;
    /// let block = Profile::of_points([[-1.0, -0.5], [1.0, -0.5], [1.0, 0.5], [-1.0, 0.5]], 0.6)?;
    /// assert_eq!(block.points_m().len(), 4);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn of_points(points_m: [[f64; 2]; N], gyration_m: f64) -> Result<Self, Error> {
        for x in points_m.into_iter().flatten() {
            within("coordinate of a contact point in m", x, -1e30, 1e30, "in [-1e30, 1e30]")?;
        }
        let reach = points_m.iter().fold(0.0_f64, |most, [x, z]| most.max(libm::hypot(*x, *z)));
        for (i, [x, z]) in points_m.iter().enumerate() {
            for [x2, z2] in &points_m[..i] {
                let apart = libm::hypot(x - x2, z - z2);
                within(
                    "distance of two contact points in m",
                    apart,
                    1e-6 * reach,
                    f64::MAX,
                    "at least 1e-6 of the size",
                )?;
            }
        }
        if gyration_m != 0.0 {
            let allowed = "0 or between 1e-12 and 1e6 times the size";
            within("radius of gyration in m", gyration_m, 1e-12 * reach, 1e6 * reach, allowed)?;
        }
        Ok(Self { points: points_m, gyration: gyration_m + 0.0 })
    }
    /// The contact points, \[x, z\] from the center of mass.
    #[must_use]
    pub fn points_m(&self) -> [[f64; 2]; N] {
        self.points
    }
    /// Radius of gyration about the center of mass.
    #[must_use]
    pub fn gyration_m(&self) -> f64 {
        self.gyration
    }
    /// The largest distance of two contact points along the body.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        let (lo, hi) = self.points.iter().fold((0.0_f64, 0.0_f64), |(lo, hi), [x, _]| (lo.min(*x), hi.max(*x)));
        hi - lo
    }
    /// Returns its thickness as far as it is known: from the lowest to the highest point, or twice what a single face is below the center of
    /// mass; 0 of a bar.
    pub(crate) fn height_m(&self) -> f64 {
        let heights = || self.points.iter().map(|[_, z]| *z);
        let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
        if high > low { high - low } else { (-2.0 * low).max(0.0) }
    }
    /// Lever arms of the points with sign, and their heights over the center of mass, at the angle with this sine and
    /// cosine.
    pub(crate) fn levers(&self, sin: f64, cos: f64) -> ([f64; N], [f64; N]) {
        (self.points.map(|[x, z]| x * cos - z * sin), self.points.map(|[x, z]| x * sin + z * cos))
    }
    /// Distance of a point from the center of mass.
    pub(crate) fn radius(&self, point: usize) -> f64 {
        let [x, z] = self.points[point];
        libm::hypot(x, z)
    }
    /// The largest of those distances.
    pub(crate) fn reach(&self) -> f64 {
        (0..N).fold(0.0, |most, i| self.radius(i).max(most))
    }
    /// Height of the center of mass over two points that lie, positive where it is on the left of the way from one to the other.
    pub(crate) fn height_over(&self, [i, j]: [usize; 2]) -> f64 {
        let ([x1, z1], [x2, z2]) = (self.points[i], self.points[j]);
        (x1 * (z2 - z1) - z1 * (x2 - x1)) / libm::hypot(x2 - x1, z2 - z1)
    }
    /// The same as the body lies, the lowest where it may lie on several sides.
    pub(crate) fn lowest_m(&self) -> f64 {
        let mut lowest = f64::INFINITY;
        for (i, [x1, z1]) in self.points.iter().enumerate() {
            for (j, [x2, z2]) in self.points.iter().enumerate().skip(i + 1) {
                let center = self.height_over([i, j]);
                let length = libm::hypot(x2 - x1, z2 - z1);
                let off = |x: f64, z: f64| ((x2 - x1) * (z - z1) - (z2 - z1) * (x - x1)) / length;
                let beyond = |[x, z]: &[f64; 2]| off(*x, *z) * center.signum() < -1e-12 * length;
                if !self.points.iter().any(beyond) {
                    lowest = lowest.min(center.abs());
                }
            }
        }
        if lowest.is_finite() { lowest } else { 0.0 }
    }
    /// x² + ρ²: the inertia about a point at lever arm x.
    pub(crate) fn inertia(&self, x: f64) -> f64 {
        x * x + self.gyration * self.gyration
    }
}

/// The bar: point 0 is end a, point 1 is end b.
impl Profile<2> {
    /// A body with its center of mass in the middle: length from end to end and radius of gyration.
    ///
    /// # Errors
    /// As [`Profile::off_center`].
    pub fn new(length_m: f64, gyration_m: f64) -> Result<Self, Error> {
        within("length in m", length_m, 1e-30, 1e30, "in [1e-30, 1e30]")?;
        Self::off_center(0.5 * length_m, 0.5 * length_m, gyration_m)
    }
    /// A body with its center of mass at distances `a_m` and `b_m` from ends a and b.
    ///
    /// A radius of gyration of 0 is legal (q = 1, the ends are massless), so is one beyond the arms (q < 0).
    ///
    /// # Errors
    /// [`Error::Quantity`] unless both arms are in [1e−31, 1e30], the longer at most 10⁶ times the shorter, and the
    /// radius of gyration is 0 or between 10⁻¹² and 10⁶ times the length.
    pub fn off_center(a_m: f64, b_m: f64, gyration_m: f64) -> Result<Self, Error> {
        for (name, arm) in [("arm of end a in m", a_m), ("arm of end b in m", b_m)] {
            within(name, arm, 1e-31, 1e30, "in [1e-31, 1e30]")?;
        }
        within("ratio of the arms", a_m / b_m, 1e-6, 1e6, "in [1e-6, 1e6]")?;
        if gyration_m != 0.0 {
            let length = a_m + b_m;
            let allowed = "0 or between 1e-12 and 1e6 times the length";
            within("radius of gyration in m", gyration_m, 1e-12 * length, 1e6 * length, allowed)?;
        }
        Ok(Self { points: [[-a_m, 0.0], [b_m, 0.0]], gyration: gyration_m + 0.0 })
    }
    /// The same body with corners: seen from the side a rectangle, its center of mass on the line midway between the
    /// two long sides. At a tilt it stands on a corner of the lower side, which is half a thickness below that line:
    ///
    /// ```text
    ///            b        height of a corner below the center   σ L sin φ − (t/2) cos φ
    ///      ·  ·  /        its lever arm                         σ L cos φ + (t/2) sin φ
    ///   ·   · · /         (σ = −1 at a, +1 at b)
    ///  a · · ·
    ///  ‾‾‾‾‾‾‾‾‾‾
    /// ```
    ///
    /// So the lever arm of the end that is down is shorter by `(t/2) sin φ`, that of the other end longer. Everywhere
    /// in this crate "end a" and "end b" are then these two corners. [`Model::FiniteTilt`](crate::Model::FiniteTilt)
    /// knows corners, until the body has turned past its end and comes down on others
    /// ([`Stop::TurnedOver`](crate::Stop::TurnedOver)); at small tilt they make no difference.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the thickness is 0 or between 10⁻¹² and 1 times the length.
    ///
    /// ```
    /// use clatter_flight::{Profile, Model, Scene};
    /// // Length 2, thickness 1 and radius of gyration 1 at 45°: lever arms −½/√2 and 1½/√2. The free end gets
    /// // (1 + x_a x_b/ρ²)/(1 + x_a²/ρ²) = (1 − 3/8)/(1 + 1/8) = 5/9 of the jump of the struck one.
    /// let body = Profile::new(2.0, 1.0)?.with_thickness(1.0)?;
    /// let strike = Scene::new(body, 0.5, 1.0, 45.0, 0.0)?.fly(Model::FiniteTilt)?.strikes[0];
    /// assert!((strike.delta_v_m_s[0] - 1.5).abs() < 1e-15);
    /// assert!((strike.delta_v_m_s[1] / strike.delta_v_m_s[0] - 5.0 / 9.0).abs() < 1e-15);
    /// # Ok::<(), clatter_flight::Error>(())
    /// ```
    pub fn with_thickness(mut self, thickness_m: f64) -> Result<Self, Error> {
        if thickness_m != 0.0 {
            let length = self.length_m();
            let allowed = "0 or between 1e-12 and 1 times the length";
            within("thickness in m", thickness_m, 1e-12 * length, length, allowed)?;
        }
        self.points = self.points.map(|[x, _]| [x, -0.5 * thickness_m + 0.0]);
        Ok(self)
    }
    /// Distances of ends a and b from the center of mass, along the body.
    #[must_use]
    pub fn arms_m(&self) -> [f64; 2] {
        let [[a, _], [b, _]] = self.points;
        [-a, b]
    }
    /// Thickness, from corner to corner of an end.
    #[must_use]
    pub fn thickness_m(&self) -> f64 {
        -2.0 * self.points[0][1]
    }
    /// Where position `s` in [−1, 1] along the bar is (−1 is end a): x and z from the center of mass.
    #[must_use]
    pub fn place(&self, s: f64) -> [f64; 2] {
        let [[a, z], [b, _]] = self.points;
        [0.5 * ((1.0 - s) * a + (1.0 + s) * b), z]
    }
    /// Inertia ratios of a level body, `q_a = (L_a L_b − ρ²)/(L_a² + ρ²)` and `q_b` likewise: minus the jump of the
    /// other end over the jump of the striking end.
    #[must_use]
    pub fn inertia_ratios(&self) -> [f64; 2] {
        let product = self.product(1.0);
        self.arms_m().map(|arm| product / self.inertia(arm))
    }
    /// `x_a x_b − ρ²` for lever arms `x = L cos φ`, `cos2` = cos² φ.
    pub(crate) fn product(&self, cos2: f64) -> f64 {
        let [a, b] = self.arms_m();
        if a - b == 0.0 && cos2 - 1.0 == 0.0 {
            (a - self.gyration) * (a + self.gyration)
        } else {
            a * b * cos2 - self.gyration * self.gyration
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body lies lowest on the side nearest to its center of mass; lines through it are no sides.
    #[test]
    fn a_body_lies_lowest_on_its_nearest_side() {
        let of = |points: [[f64; 2]; 4]| Profile::of_points(points, 0.05).unwrap().lowest_m();
        let corners = [[-0.15, -0.03], [0.15, -0.03], [0.15, 0.05], [-0.15, 0.05]];
        assert!((of(corners) - 0.03).abs() < 1e-15, "{}", of(corners));
        // Its corners in another order, and stood on its end.
        let [a, b, c, d] = corners.map(|[x, z]| [z, x]);
        assert!((of([c, a, d, b]) - 0.03).abs() < 1e-15, "{}", of([c, a, d, b]));
    }
}
