//! This module describes how a box lands: on a face, an edge or a corner, or tilted by an angle.
//!
//! Axes x, y, z run along length, width and thickness. A face is named by its side of an axis: `end-a` −x, `end-b` +x, `front` −y,
//! `back` +y, `bottom` −z, `top` +z. An edge is where two faces meet, a corner where three do.

use std::f64::consts::{FRAC_PI_2, TAU};

use serde::{Serialize, Serializer};

/// The face, edge or corner on which a box lands, or the tilt at which it lands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attitude(Lands);

#[derive(Debug, Clone, Copy, PartialEq)]
enum Lands {
    /// The center of mass over the faces on these sides of the axes: −1, 0 or 1 of each, not all 0.
    On([i8; 3]),
    /// The bottom so far off level, rising to this direction from the length.
    Tilted { tilt_rad: f64, direction_rad: f64 },
}

/// Names of the faces, by axis and side.
const FACES: [[&str; 2]; 3] = [["end-a", "end-b"], ["front", "back"], ["bottom", "top"]];

impl Attitude {
    /// Returns the landing on the faces of these names together: on one of them flat, on the edge of two, on the corner of three; none of a
    /// name that is none, of faces that do not meet, and without any.
    ///
    /// ```
    /// use clatter_product::Attitude;
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
        (sides != [0; 3]).then_some(Self(Lands::On(sides)))
    }
    /// Its bottom off level by an angle, rising to a direction that turns from the length, towards end b, to the width: what of the box is
    /// lowest then lands. None unless the tilt is in [0, π/2] and the direction within a turn.
    ///
    /// ```
    /// use clatter_product::Attitude;
    /// let tilted = Attitude::tilted(45_f64.to_radians(), 30_f64.to_radians()).unwrap();
    /// assert_eq!(tilted.to_string(), "tilt 45 deg towards 30 deg");
    /// ```
    #[must_use]
    pub fn tilted(tilt_rad: f64, direction_rad: f64) -> Option<Self> {
        let given = (0.0..=FRAC_PI_2).contains(&tilt_rad) && (-TAU..=TAU).contains(&direction_rad);
        given.then_some(Self(Lands::Tilted { tilt_rad, direction_rad }))
    }
    /// Returns all of those on so many faces at once: the 6 faces, the 12 edges or the 8 corners.
    #[must_use]
    pub fn all(faces: usize) -> Vec<Self> {
        let side = |k: usize| [-1, 1, 0][k];
        let every = (0..27).map(|k| Self(Lands::On([side(k / 9), side(k / 3 % 3), side(k % 3)])));
        every.filter(|attitude| attitude.faces() == faces).collect()
    }
    /// Returns it as it is said in a sentence.
    ///
    /// ```
    /// use clatter_product::Attitude;
    /// assert_eq!(Attitude::on("bottom front").unwrap().in_a_sentence(), "on its bottom front edge");
    /// ```
    #[must_use]
    pub fn in_a_sentence(self) -> String {
        let name = self.to_string();
        match name.split_once(' ') {
            Some((kind @ ("face" | "edge" | "corner"), faces)) => format!("on its {faces} {kind}"),
            _ => format!("at a {name}"),
        }
    }
    /// Returns on how many faces at once it lands: 1 a face, 2 an edge, 3 a corner; 0 of one that is tilted by an angle.
    #[must_use]
    pub fn faces(self) -> usize {
        let Lands::On(sides) = self.0 else { return 0 };
        sides.iter().filter(|side| **side != 0).count()
    }
    /// Returns the axes of a box along which its lowest face, edge or corner lies level: two of a face, one of an edge, none of a corner.
    #[must_use]
    pub fn level(self, faces_m: [[f64; 2]; 3]) -> Vec<usize> {
        let upward = self.upward(faces_m);
        (0..3).filter(|axis| upward[*axis] == 0.0).collect()
    }
    /// Returns the axis of the box about which the tilt of one that is tilted grows; none of one that lands on faces.
    pub(crate) fn about(self) -> Option<[f64; 3]> {
        let Lands::Tilted { direction_rad, .. } = self.0 else { return None };
        let (across, along) = libm::sincos(direction_rad);
        Some([across, -along, 0.0])
    }
    /// Returns the vertical in axes of a box whose faces have these distances from the center of mass, −x, +x, −y and so on: the center of
    /// mass is over the face, or straight over the edge or corner.
    #[must_use]
    pub fn upward(self, faces_m: [[f64; 2]; 3]) -> [f64; 3] {
        let up = match self.0 {
            Lands::On(sides) => [0, 1, 2].map(|axis| match sides[axis] {
                -1 => faces_m[axis][0],
                1 => -faces_m[axis][1],
                _ => 0.0,
            }),
            Lands::Tilted { tilt_rad, direction_rad } => {
                let ((sin, cos), (across, along)) = (libm::sincos(tilt_rad), libm::sincos(direction_rad));
                // A right angle has roundings.
                [sin * along, sin * across, cos].map(|x| if x.abs() < 1e-15 { 0.0 } else { x })
            }
        };
        let size = libm::hypot(libm::hypot(up[0], up[1]), up[2]);
        up.map(|x| x / size + 0.0)
    }
}

impl std::fmt::Display for Attitude {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sides = match self.0 {
            Lands::On(sides) => sides,
            Lands::Tilted { tilt_rad, direction_rad } => {
                let [tilt, direction] = [tilt_rad, direction_rad].map(|angle| (1e6 * angle.to_degrees()).round() / 1e6);
                return write!(f, "tilt {tilt} deg towards {direction} deg");
            }
        };
        f.write_str(["", "face", "edge", "corner"][self.faces()])?;
        for axis in [2, 1, 0] {
            match sides[axis] {
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

/// The posture of a box as it lands, but for its tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Base {
    /// The vertical in its axes.
    pub up: [f64; 3],
    /// The axis about which it turns, of one that lands at a tilt: then the tilt grows. Else it turns off what it lands on.
    pub spin_axis: Option<[f64; 3]>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_flight::turned_off;

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

    /// Tilted by all of a right angle towards end b it stands on end a; towards the back at 45° on the edge in front.
    #[test]
    fn what_is_tilted_lands_on_what_is_lowest() {
        let faces = [[0.05, 0.1], [0.03, 0.04], [0.01, 0.02]];
        let of = |tilt: f64, direction: f64| Attitude::tilted(tilt.to_radians(), direction.to_radians()).unwrap();
        assert_eq!(of(90.0, 0.0).upward(faces).map(f64::to_bits), [1.0_f64, 0.0, 0.0].map(f64::to_bits));
        assert_eq!(of(90.0, 0.0).level(faces), [1, 2]);
        let edge = of(45.0, 90.0).upward(faces);
        assert!(edge[0] == 0.0 && (edge[1] - 0.5_f64.sqrt()).abs() < 1e-15 && (edge[2] - edge[1]).abs() < 1e-15);
        assert_eq!((of(45.0, 30.0).level(faces).len(), of(45.0, 30.0).faces()), (0, 0));
        assert!(Attitude::tilted(1.6, 0.0).is_none() && Attitude::tilted(f64::NAN, 0.0).is_none());
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
