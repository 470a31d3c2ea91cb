//! How a box lands: on a face, an edge or a corner.
//!
//! Axes x, y, z run along length, width and thickness. A face is named by its side of an axis: `end-a` −x, `end-b` +x, `front` −y,
//! `back` +y, `bottom` −z, `top` +z. An edge is where two faces meet, a corner where three do.

use serde::{Serialize, Serializer};

/// The sides of the axes on which a box lands: −1, 0 or 1 of each, not all 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Attitude([i8; 3]);

/// Names of the faces, by axis and side.
const FACES: [[&str; 2]; 3] = [["end-a", "end-b"], ["front", "back"], ["bottom", "top"]];

impl Attitude {
    /// Landing on the faces of these names together: on one of them flat, on the edge of two, on the corner of three; none of a name
    /// that is none, of faces that do not meet, and without any.
    ///
    /// ```
    /// use clatter_assess::Attitude;
    /// assert_eq!(Attitude::on("bottom front").unwrap().to_string(), "edge bottom front");
    /// assert!(Attitude::on("top bottom").is_none());
    /// ```
    #[must_use]
    pub fn on(faces: &str) -> Option<Self> {
        let mut sides = [0; 3];
        for name in faces.split_whitespace() {
            let axis = FACES.iter().position(|names| names.contains(&name)).filter(|axis| sides[*axis] == 0)?;
            sides[axis] = if FACES[axis][0] == name { -1 } else { 1 };
        }
        (sides != [0; 3]).then_some(Self(sides))
    }
    /// All of those on so many faces at once: the 6 faces, the 12 edges or the 8 corners.
    #[must_use]
    pub fn all(faces: usize) -> Vec<Self> {
        let side = |k: usize| [-1, 1, 0][k];
        let every = (0..27).map(|k| Self([side(k / 9), side(k / 3 % 3), side(k % 3)]));
        every.filter(|attitude| attitude.faces() == faces).collect()
    }
    /// On how many faces at once: 1 a face, 2 an edge, 3 a corner.
    #[must_use]
    pub fn faces(self) -> usize {
        self.0.iter().filter(|side| **side != 0).count()
    }
    /// The axes of a box along which what it lands on lies level: two of a face, one of an edge, none of a corner.
    pub(crate) fn level(self) -> Vec<usize> {
        (0..3).filter(|axis| self.0[*axis] == 0).collect()
    }
    /// The vertical in axes of a box whose faces have these distances from the center of mass, −x, +x, −y and so on: the center of mass
    /// is over the face, or straight over the edge or corner.
    pub(crate) fn upward(self, faces_m: [[f64; 2]; 3]) -> [f64; 3] {
        let down = [0, 1, 2].map(|axis| match self.0[axis] {
            -1 => -faces_m[axis][0],
            1 => faces_m[axis][1],
            _ => 0.0,
        });
        let size = libm::hypot(libm::hypot(down[0], down[1]), down[2]);
        down.map(|x| -x / size + 0.0)
    }
}

impl std::fmt::Display for Attitude {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(["", "face", "edge", "corner"][self.faces()])?;
        for axis in [2, 1, 0] {
            match self.0[axis] {
                -1 => write!(f, " {}", FACES[axis][0])?,
                1 => write!(f, " {}", FACES[axis][1])?,
                _ => {}
            }
        }
        Ok(())
    }
}

impl Serialize for Attitude {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// The vertical of a box that is turned off an attitude by an angle, towards a direction around it.
pub(crate) fn turned_off(upward: [f64; 3], angle_rad: f64, direction_rad: f64) -> [f64; 3] {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    // Two axes across the vertical: from the axis of the box that is farthest from it.
    let far = (0..3).min_by(|a, b| upward[*a].abs().total_cmp(&upward[*b].abs())).unwrap_or(0);
    let mut first = [0.0; 3];
    first[far] = 1.0;
    let along = dot(first, upward);
    let off: [f64; 3] = std::array::from_fn(|i| first[i] - along * upward[i]);
    let size = dot(off, off).sqrt();
    let first = off.map(|x| x / size);
    let second = [
        upward[1] * first[2] - upward[2] * first[1],
        upward[2] * first[0] - upward[0] * first[2],
        upward[0] * first[1] - upward[1] * first[0],
    ];
    let ((sin, cos), (s, c)) = (libm::sincos(angle_rad), libm::sincos(direction_rad));
    std::array::from_fn(|i| cos * upward[i] + sin * (c * first[i] + s * second[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_six_faces_twelve_edges_and_eight_corners() {
        assert_eq!([1, 2, 3].map(|faces| Attitude::all(faces).len()), [6, 12, 8]);
        for attitude in [1, 2, 3].into_iter().flat_map(Attitude::all) {
            let name = attitude.to_string();
            let (_, faces) = name.split_once(' ').unwrap();
            assert_eq!(Attitude::on(faces), Some(attitude), "{name}");
        }
        for wrong in ["", "bottom top", "side", "bottom bottom"] {
            assert_eq!(Attitude::on(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn the_center_of_mass_is_over_what_lands() {
        let faces = [[0.05, 0.1], [0.03, 0.04], [0.01, 0.02]];
        assert_eq!(Attitude::on("bottom").unwrap().upward(faces).map(f64::to_bits), [0.0, 0.0, 1.0].map(f64::to_bits));
        let corner = Attitude::on("bottom front end-b").unwrap().upward(faces);
        // Antiparallel to the way from the center of mass to the corner.
        let [x, y, z] = [0.1, -0.03, -0.01_f64];
        let size = (x * x + y * y + z * z).sqrt();
        for (upward, way) in corner.into_iter().zip([x, y, z]) {
            assert!((upward + way / size).abs() < 1e-15);
        }
    }

    #[test]
    fn what_is_turned_off_keeps_its_angle() {
        for attitude in [1, 2, 3].into_iter().flat_map(Attitude::all) {
            let upward = attitude.upward([[0.05, 0.1], [0.03, 0.04], [0.01, 0.02]]);
            for direction in [0.0, 1.0, 3.0, 5.5] {
                let off = turned_off(upward, 0.1, direction);
                let [of, size] = [upward, off].map(|b| (0..3).map(|i| off[i] * b[i]).sum::<f64>());
                assert!((of - 0.1_f64.cos()).abs() < 1e-14 && (size - 1.0).abs() < 1e-14);
            }
        }
    }
}
