//! A box that falls in any orientation, with spin, on contacts that take time at its eight corners.
//!
//! Forces are vertical, as the ground has no friction: neither the place of the box over the ground nor its turn about the vertical
//! does anything. So its state is the height z of the center of mass, the direction n of the vertical in axes of the box, and the
//! spin ω in these axes. With the corners r_i from the center of mass, the moments of inertia J and forces F_i, both over the mass:
//!
//! ```text
//! z″ = Σ F_i − g,    n′ = n × ω,    J ω′ = Σ F_i r_i × n − ω × J ω
//! height and velocity of a place p:  z + n·p,  z′ + n·(ω × p)
//! ```
//!
//! Motions are integrated by the embedded Runge–Kutta method of Dormand and Prince, 5(4), whose steps end where a corner
//! touches, is at its lowest or parts: rotations of a body with three moments of inertia have no closed form that is worth its price.

mod dormand_prince;
mod drop;
mod run;
pub(crate) mod system;

pub use drop::BlockDrop;
pub use run::{BlockFlight, BlockStep, BlockStrike, LEAST_OF_BLOCKS};

use clatter::Error;

use crate::contact::eigen;
use crate::scene::within;

type Matrix = [[f64; 3]; 3];

fn diagonal(of: [f64; 3]) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { of[i] } else { 0.0 }))
}

fn times(matrix: &Matrix, vector: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| system::dot(row, vector))
}

/// A rectangular box: its corners, center of mass and moments of inertia, all along its own axes x, y, z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    half: [f64; 3],
    center: [f64; 3],
    gyration: [f64; 3],
    /// Moments of inertia over the mass about the center of mass, and their inverse.
    inertia: Matrix,
    inverse: Matrix,
    /// The smallest radius of gyration about any axis.
    least: f64,
}

impl Block {
    /// A box of this size (from face to face), with its center of mass so far from its middle and these radii of gyration about axes
    /// through the center of mass: k_x² = ∫(y² + z²) dm/m.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless sizes are in [1e−6, 1e6] m and in ratios up to 1000, the center of mass is within the box, and the
    /// radii are those of a body: each at least a hundredth of the size, and the square of none more than the sum of the other
    /// two squares.
    ///
    /// # Examples
    /// Evenly spread mass of 120 mm × 60 mm × 20 mm:
    /// ```
    /// use clatter_flight::Block;
    /// let [a, b, c] = [0.12_f64, 0.06, 0.02];
    /// let gyration = [b.hypot(c), a.hypot(c), a.hypot(b)].map(|diagonal| diagonal / 12_f64.sqrt());
    /// let block = Block::new([a, b, c], [0.0; 3], gyration)?;
    /// assert_eq!(block.corners_m()[0], [-0.06, -0.03, -0.01]);
    /// assert_eq!(Block::CORNERS[0], "---");
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn new(size_m: [f64; 3], center_of_mass_m: [f64; 3], gyration_m: [f64; 3]) -> Result<Self, Error> {
        let largest = size_m.iter().fold(0.0_f64, |most, size| most.max(*size));
        for size in size_m {
            within("size of the box in m", size, 1e-6, 1e6, "in [1e-6, 1e6]")?;
            within("size of the box in m", size, 1e-3 * largest, largest, "at least a thousandth of the largest")?;
        }
        let half = size_m.map(|size| 0.5 * size);
        for (center, half) in center_of_mass_m.into_iter().zip(half) {
            within("center of mass in m from the middle", center, -half, half, "within the box")?;
        }
        for radius in gyration_m {
            let allowed = "between 0.01 and 100 times the largest size";
            within("radius of gyration in m", radius, 0.01 * largest, 100.0 * largest, allowed)?;
        }
        let [x, y, z] = gyration_m.map(|radius| radius * radius);
        for (own, others) in [(x, y + z), (y, z + x), (z, x + y)] {
            let allowed = "such that no square is more than the sum of the other two: no body has such moments";
            within("radius of gyration in m", own.sqrt(), 0.0, (others * (1.0 + 1e-9)).sqrt(), allowed)?;
        }
        let (inertia, inverse) = (diagonal([x, y, z]), diagonal([x, y, z].map(f64::recip)));
        let least = gyration_m.into_iter().fold(f64::INFINITY, f64::min);
        Ok(Self { half, center: center_of_mass_m, gyration: gyration_m, inertia, inverse, least })
    }

    /// The same with mass that lies askew of its sides: ∫x y dm/m, ∫x z dm/m and ∫y z dm/m about the center of mass, 0 unless given.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless a body has them: each is within 0.99 of the product of the radii of gyration of the mass along both
    /// axes, √(∫x² dm/m) and so on, and the radius of gyration about no axis is below a hundredth of the largest size.
    pub fn with_products_of_inertia(self, products_m2: [f64; 3]) -> Result<Self, Error> {
        let squares = self.gyration.map(|radius| radius * radius);
        let all = 0.5 * squares.iter().sum::<f64>();
        let along = squares.map(|about| (all - about).max(0.0).sqrt());
        let name = "product of inertia over the mass in m²";
        for (product, [i, j]) in products_m2.into_iter().zip([[0, 1], [0, 2], [1, 2]]) {
            let most = 0.99 * along[i] * along[j];
            within(name, product, -most, most, "within 0.99 of both radii of gyration of the mass")?;
        }
        let ([xy, xz, yz], [x, y, z]) = (products_m2, squares);
        let inertia = [[x, -xy, -xz], [-xy, y, -yz], [-xz, -yz, z]];
        let (principal, axes) = eigen(inertia);
        let largest = self.half.iter().fold(0.0_f64, |most, half| most.max(2.0 * half));
        let least = principal.into_iter().fold(f64::INFINITY, f64::min).max(0.0).sqrt();
        let half = 0.5 * principal.iter().sum::<f64>();
        // No mass along an axis is less than none.
        if least < 0.01 * largest || principal.iter().any(|about| *about > half * (1.0 + 1e-9)) {
            let worst = products_m2.into_iter().fold(0.0, |most: f64, p| if p.abs() > most.abs() { p } else { most });
            return Err(Error::Quantity { name, value: worst, allowed: "such that a body has them" });
        }
        let inverse = std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..3).map(|k| axes[i][k] * axes[j][k] / principal[k]).sum())
        });
        Ok(Self { inertia, inverse, least, ..self })
    }

    /// Corners from the center of mass: `---`, `+--`, `-+-`, `++-`, `--+` and so on, x first.
    #[must_use]
    pub fn corners_m(&self) -> [[f64; 3]; 8] {
        std::array::from_fn(|corner| {
            std::array::from_fn(|axis| {
                let side = if corner >> axis & 1 == 1 { self.half[axis] } else { -self.half[axis] };
                side - self.center[axis]
            })
        })
    }

    /// Signs of x, y and z of its corners.
    pub const CORNERS: [&str; 8] = ["---", "+--", "-+-", "++-", "--+", "+-+", "-++", "+++"];

    /// Where a place is from the center of mass that is so far from the middle of the box.
    #[must_use]
    pub fn place(&self, from_middle_m: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| from_middle_m[axis] - self.center[axis])
    }

    /// Radii of gyration about the center of mass.
    #[must_use]
    pub fn gyration_m(&self) -> [f64; 3] {
        self.gyration
    }

    /// ∫x y dm/m, ∫x z dm/m and ∫y z dm/m about the center of mass.
    #[must_use]
    pub fn products_of_inertia_m2(&self) -> [f64; 3] {
        [[0, 1], [0, 2], [1, 2]].map(|[i, j]| 0.0 - self.inertia[i][j])
    }

    /// The smallest radius of gyration about any axis through the center of mass.
    #[must_use]
    pub fn least_gyration_m(&self) -> f64 {
        self.least
    }

    /// What a moment of 1 over the mass does to the spin.
    #[must_use]
    pub fn turned_by(&self, moment: [f64; 3]) -> [f64; 3] {
        times(&self.inverse, moment)
    }

    /// Moment of inertia over the mass about an axis through the center of mass.
    #[must_use]
    pub fn inertia_about(&self, axis: [f64; 3]) -> f64 {
        system::dot(axis, times(&self.inertia, axis))
    }

    /// Size from face to face.
    #[must_use]
    pub fn size_m(&self) -> [f64; 3] {
        self.half.map(|half| 2.0 * half)
    }

    /// The center of mass from the middle.
    #[must_use]
    pub fn center_of_mass_m(&self) -> [f64; 3] {
        self.center
    }

    /// Distance of the center of mass from a face, the one on the side −1 or +1 of an axis.
    fn face_at(&self, axis: usize, side: f64) -> f64 {
        self.half[axis] - side * self.center[axis]
    }

    /// The axis across the face on which a box whose vertical is `n` comes to lie, and the heights of the center of mass over that face
    /// and over the lowest of its edges. It is the face that a plumb line from the center of mass goes through.
    fn lies_on(&self, n: [f64; 3]) -> (usize, f64, f64) {
        let side = |axis: usize| -1.0_f64.copysign(n[axis]);
        let along = |axis: usize| {
            if n[axis] == 0.0 { f64::INFINITY } else { self.face_at(axis, side(axis)) / n[axis].abs() }
        };
        let face = (0..3).min_by(|&a, &b| along(a).total_cmp(&along(b))).unwrap_or(2);
        let over = self.face_at(face, side(face));
        let others = (0..3).filter(|axis| *axis != face);
        let aside = others.flat_map(|axis| [-1.0, 1.0].map(|side| self.face_at(axis, side)));
        (face, over, libm::hypot(over, aside.fold(f64::INFINITY, f64::min)))
    }

    /// How far a box leans whose vertical is `upward` from the face that it is over where its vertical is `from`: 0 level, 1 balanced over an
    /// edge of that face, infinite from where it lies on its side. 0 where it lies nowhere lower than on that face.
    #[must_use]
    pub fn lean(&self, upward: [f64; 3], from: [f64; 3]) -> f64 {
        let (face, over, _) = self.lies_on(from);
        if (0..3).all(|axis| over <= self.face_at(axis, 1.0).min(self.face_at(axis, -1.0))) {
            return 0.0;
        }
        let rises = upward[face] * 1.0_f64.copysign(from[face]);
        let others = (0..3).filter(|axis| *axis != face);
        let aside = |axis: usize| upward[axis].abs() / self.face_at(axis, -1.0_f64.copysign(upward[axis]));
        if rises > 0.0 { others.map(aside).fold(0.0, f64::max) * over / rises } else { f64::INFINITY }
    }

    /// The energy over the mass that no motion gets rid of: of a body that lies and turns about the vertical, with this angular momentum
    /// over the mass, which nothing changes. `energy` is what it has: where that does not lift it over an edge, it stays on its face.
    /// Corners stand on `ground`, at 0 or in their dents below it.
    fn kept(&self, n: [f64; 3], energy: f64, gravity: f64, momentum: f64, ground: [f64; 8]) -> f64 {
        let turning = |axis: usize| 0.5 * (momentum / self.gyration[axis]).powi(2);
        let (face, over, ridge) = self.lies_on(n);
        let least = (0..3).map(turning).fold(f64::INFINITY, f64::min);
        if energy < gravity * ridge + least {
            return gravity * (over + self.height_on(face, n, ground)) + turning(face);
        }
        let deepest = ground.into_iter().fold(0.0, f64::min);
        let on = |axis: usize| {
            let height = self.face_at(axis, 1.0).min(self.face_at(axis, -1.0));
            gravity * (height + deepest) + turning(axis)
        };
        (0..3).map(on).fold(f64::INFINITY, f64::min)
    }

    /// How high the center of mass lies over a face that stands on uneven ground, less what it does on even ground at 0: on three
    /// corners around the plumb line, those that hold it highest. The vertical is `n`.
    fn height_on(&self, face: usize, n: [f64; 3], ground: [f64; 8]) -> f64 {
        let (across, along) = ((face + 1) % 3, (face + 2) % 3);
        let lower = usize::from(n[face] < 0.0) << face;
        let at = |u: usize, v: usize| ground[lower | u << across | v << along];
        let share = |axis: usize| self.face_at(axis, -1.0) / (2.0 * self.half[axis]);
        let (u, v) = (share(across), share(along));
        let one = if u >= v { (u - v) * at(1, 0) } else { (v - u) * at(0, 1) };
        let one = one + u.min(v) * at(1, 1) + (1.0 - u.max(v)) * at(0, 0);
        let rest = u + v - 1.0;
        let other = if rest <= 0.0 {
            u * at(1, 0) + v * at(0, 1) - rest * at(0, 0)
        } else {
            (1.0 - v) * at(1, 0) + (1.0 - u) * at(0, 1) + rest * at(1, 1)
        };
        one.max(other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box stands on its end, its center of mass 0.15 m over the ground, and rolls over its nearest edge, 0.158 m from there, where its
    /// energy lets it: then it may come to lie 0.05 m over the ground, or in the deepest dent of all.
    #[test]
    fn a_box_keeps_no_energy_that_it_can_roll_off_with() {
        let (block, g) = (Block::new([0.2, 0.1, 0.3], [0.0; 3], [0.09, 0.1, 0.07]).unwrap(), 9.81);
        let kept = |height: f64, dent: f64| {
            let mut ground = [0.0; 8];
            ground[6] = -dent;
            block.kept([0.0, 0.0, 1.0], g * height, g, 0.0, ground) / g
        };
        assert!((kept(0.157, 0.0) - 0.15).abs() < 1e-12, "{}", kept(0.157, 0.0));
        for height in [0.159, 0.179, 0.3] {
            assert!((kept(height, 0.0) - 0.05).abs() < 1e-12, "{height}: {}", kept(height, 0.0));
            assert!((kept(height, 0.002) - 0.048).abs() < 1e-12, "{height}: {}", kept(height, 0.002));
        }
    }

    /// A box of 200 × 100 × 300 mm on its end is balanced over its nearer edge at atan(50/150), 18.4°, and over the other one at 33.7°; flat
    /// on its broad side it leans nowhere.
    #[test]
    fn a_box_leans_by_the_edges_of_its_face() {
        let block = Block::new([0.2, 0.1, 0.3], [0.0; 3], [0.09, 0.1, 0.07]).unwrap();
        let (up, near, far) = ([0.0, 0.0, 1.0], (1.0_f64 / 3.0).atan(), (2.0_f64 / 3.0).atan());
        for side in [-1.0, 1.0] {
            let over_y = |tilt: f64| block.lean([0.0, side * tilt.sin(), tilt.cos()], up);
            let over_x = |tilt: f64| block.lean([side * tilt.sin(), 0.0, tilt.cos()], up);
            assert!((over_y(near) - 1.0).abs() < 1e-12 && (over_x(far) - 1.0).abs() < 1e-12);
            assert!(over_y(0.9 * near) < 1.0 && over_y(1.1 * near) > 1.0 && over_y(2.0) == f64::INFINITY);
        }
        assert_eq!((block.lean(up, up), block.lean([0.0, 0.9, 0.1], [0.0, 1.0, 0.0])), (0.0, 0.0));
    }

    /// On a ground of three heights a face stands on the three corners around its center of mass: of a square on the diagonal that is higher,
    /// and off the middle of it on the corner beside that too.
    #[test]
    fn a_face_stands_on_the_corners_that_hold_it_highest() {
        let ground = |on: [f64; 4]| std::array::from_fn(|corner| on[corner & 3]);
        let over = |center: [f64; 3], on: [f64; 4]| {
            let block = Block::new([0.2, 0.2, 0.1], center, [0.07, 0.07, 0.08]).unwrap();
            block.height_on(2, [0.0, 0.0, 1.0], ground(on))
        };
        let near = |got: f64, want: f64| assert!((got - want).abs() < 1e-15, "{got}, not {want}");
        // Corners −−, +−, −+ and ++.
        near(over([0.0; 3], [-0.002, 0.0, 0.0, -0.004]), 0.0);
        near(over([0.0; 3], [0.0, -0.002, -0.004, -0.001]), -0.0005);
        // A quarter of the side towards +x: half of the weight is on the diagonal, half on the side +x alone.
        near(over([0.05, 0.0, 0.0], [0.0, -0.002, -0.004, -0.001]), -0.001);
    }
}
