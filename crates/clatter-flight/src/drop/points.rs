//! What of a body touches the ground, and its sides.

use super::{Drop, Engine};
use crate::block::Block;
use crate::body::Side;

impl Drop {
    /// Returns the names of the points that touch the ground: the ends of a bar, the corners of a plate as seen from above, of a box the
    /// signs of x, y and z of its corners.
    #[must_use]
    pub fn points(&self) -> &'static [&'static str] {
        match self.engine() {
            Engine::Planar => &["a", "b"],
            Engine::Level => &["a", "b", "c", "d"],
            Engine::Solid => &Block::CORNERS,
        }
    }
    /// Returns what a point is called: `"end"` of a bar, else `"corner"`.
    #[must_use]
    pub fn point(&self) -> &'static str {
        if self.body.is_wide() { "corner" } else { "end" }
    }
    /// Returns the name of the point that touches first.
    #[must_use]
    pub fn lowest(&self) -> &'static str {
        self.points()[self.lowest_point()]
    }
    fn lowest_point(&self) -> usize {
        if self.is_solid() {
            let rises = self.up().map(|up| usize::from(up < 0.0));
            return rises[0] + 2 * rises[1] + 4 * rises[2];
        }
        match self.signs().map(|sign| sign < 0.0) {
            [false, false] => 0,
            [true, false] => 1,
            [true, true] => 2,
            [false, true] => 3,
        }
    }
    /// Returns the points next to the lowest one, along each side of the body, and how much higher they are as that one touches.
    #[must_use]
    pub fn neighbors_m(&self) -> Vec<(&'static str, f64)> {
        let (points, lowest) = (self.points(), self.lowest_point());
        if self.is_solid() {
            let rises = self.sides().into_iter().zip(self.up()).map(|(side, up)| side.m() * up.abs());
            return rises.enumerate().map(|(axis, rise)| (points[lowest ^ (1 << axis)], rise)).collect();
        }
        let next = [lowest ^ 1, 3 - lowest].into_iter().zip(self.gaps_m());
        next.take(self.sides().len()).map(|(point, rise)| (points[point], rise)).collect()
    }
    /// Returns the sides along which a place lies: the length of a bar, length and width of a plate, all three of a box.
    #[must_use]
    pub fn sides(&self) -> Vec<Side> {
        let thickness = self.body.thickness.filter(|_| self.is_solid());
        [Some(self.body.length), self.body.width, thickness].into_iter().flatten().collect()
    }
    /// Returns the radii of gyration about the center of mass: along the sides of a bar or a plate, about the axes of a box.
    #[must_use]
    pub fn gyration_m(&self) -> Vec<f64> {
        let along: Vec<f64> = self.sides().iter().map(|side| side.gyration_m).collect();
        if let [x, y, z] = along[..] { vec![libm::hypot(y, z), libm::hypot(x, z), libm::hypot(x, y)] } else { along }
    }
    /// Returns −1 along the sides that are exchanged where the drop is seen from what touches first, else 1; a box is seen as it is.
    #[must_use]
    pub fn exchanged(&self) -> [f64; 3] {
        let [x, y] = if self.is_solid() { [1.0; 2] } else { self.signs() };
        [x, y, 1.0]
    }
    /// Returns the same drop of a bar or a plate as seen from what touches first, which is end a or corner a then.
    ///
    /// # Examples
    /// ```
    /// use clatter::End;
    /// use clatter_flight::{Body, Drop};
    /// let bar = Drop::new(Body::off_center(0.08, 0.06, 0.04)?, 4.0, 0.1, 0.3);
    /// let onto_b = Drop { direction_rad: Drop::towards(End::B), ..bar };
    /// let seen = onto_b.from_first();
    /// assert_eq!((onto_b.lowest(), seen.lowest(), seen.body.arms_m()), ("b", "a", [0.06, 0.08]));
    /// assert_eq!(seen.scene()?, onto_b.scene()?);
    /// # Ok::<(), clatter_flight::Error>(())
    /// ```
    #[must_use]
    pub fn from_first(&self) -> Self {
        let (mut seen, [x, y, _]) = (*self, self.exchanged());
        let sides = [x, y].map(|sign| sign < 0.0);
        if sides == [false; 2] {
            return seen;
        }
        if sides[0] {
            seen.body.length.ends_m.reverse();
        }
        if let Some(width) = seen.body.width.as_mut().filter(|_| sides[1]) {
            width.ends_m.reverse();
        }
        let [xy, xz, yz] = self.body.products_m2;
        seen.body.products_m2 = [x * y * xy, x * xz, y * yz];
        seen.own_contacts = self.own_contacts.mirrored(sides);
        let [cos, sin] = self.rises().map(f64::abs);
        seen.direction_rad = libm::atan2(sin, cos);
        // An axis of turning changes its sign where one side is exchanged.
        seen.spin_axis = self.spin_axis.map(|[about_x, about_y, about_z]| [y * about_x, x * about_y, x * y * about_z]);
        seen
    }
}
