//! The tosses as they were measured: poses at even times.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::Error;

/// Unit of the file; that of lengths in m.
const UNIT: f64 = 1e-5;
/// Number of columns of the file.
const COLUMNS: usize = 9;

/// A pose of the cube.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pose {
    /// Rotation from axes of the cube into those of the world, z upward.
    pub(super) turned: UnitQuaternion<f64>,
    /// Place of its center, in m.
    pub(super) place: Vector3<f64>,
}

/// One toss.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Toss {
    pub(super) number: u32,
    /// Poses one after the other, from the first on.
    pub(super) poses: Vec<Pose>,
    /// Pose at rest in the end.
    pub(super) rest: Pose,
}

/// Reads `toss,sample,qw,qx,qy,qz,x,y,z`: whole numbers in units of 1e−5 (lengths in m). Samples of a toss count from 0; its last one, after a
/// gap or not, is the cube at rest.
///
/// # Errors
/// [`Error::Data`] with the line that is no pose, or for a toss with fewer than two.
pub(super) fn read(text: &str) -> Result<Vec<Toss>, Error> {
    let mut tosses: Vec<(u32, Vec<(u32, Pose)>)> = Vec::new();
    for (line, row) in text.lines().enumerate().skip(1) {
        let wrong = || Error::Data(format!("cube.csv, line {}: no pose: {row}", line + 1));
        let cells: Vec<i32> = row.split(',').map(str::parse).collect::<Result<_, _>>().map_err(|_| wrong())?;
        let [toss, sample, qw, qx, qy, qz, x, y, z] = <[i32; COLUMNS]>::try_from(cells).map_err(|_| wrong())?;
        let [w, i, j, k, x, y, z] = [qw, qx, qy, qz, x, y, z].map(|cell| UNIT * f64::from(cell));
        let turned = UnitQuaternion::try_new(Quaternion::new(w, i, j, k), 0.9).ok_or_else(wrong)?;
        let pose = Pose { turned, place: Vector3::new(x, y, z) };
        let toss = u32::try_from(toss).map_err(|_| wrong())?;
        let sample = u32::try_from(sample).map_err(|_| wrong())?;
        match tosses.last_mut().filter(|(number, _)| *number == toss) {
            Some((_, poses)) => poses.push((sample, pose)),
            None => tosses.push((toss, vec![(sample, pose)])),
        }
    }
    tosses.into_iter().map(|(number, poses)| Toss::new(number, poses)).collect()
}

impl Toss {
    fn new(number: u32, mut poses: Vec<(u32, Pose)>) -> Result<Self, Error> {
        let gap = || Error::Data(format!("cube.csv, toss {number}: samples do not follow one another from 0"));
        let (_, rest) = poses.pop().ok_or_else(gap)?;
        if poses.is_empty() || poses.iter().zip(0..).any(|((sample, _), expected)| *sample != expected) {
            return Err(gap());
        }
        Ok(Self { number, poses: poses.into_iter().map(|(_, pose)| pose).collect(), rest })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "toss,sample,qw,qx,qy,qz,x,y,z\n";

    #[test]
    fn poses_are_read_with_their_units() {
        let rows = "5,0,100000,0,0,0,1,-2,30000\n5,1,0,0,100000,0,2,-2,29000\n5,90,100000,0,0,0,9,-2,5240\n";
        let tosses = read(&(HEAD.to_owned() + rows)).unwrap();
        assert_eq!((tosses.len(), tosses[0].number, tosses[0].poses.len()), (1, 5, 2));
        assert_eq!(tosses[0].poses[0].place, Vector3::new(1e-5, -2e-5, 1e-5 * 30000.0));
        assert_eq!(tosses[0].poses[1].turned * Vector3::z(), -Vector3::z());
        assert_eq!(tosses[0].rest.place, Vector3::new(9e-5, -2e-5, 1e-5 * 5240.0));
    }

    #[test]
    fn a_torn_line_is_named() {
        for (rows, told) in [
            ("0,0,100000,0,0,0,0,0\n", "line 2"),
            ("0,0,100000,0,0,0,0,0,1\n0,1,1e5,0,0,0,0,0,1\n", "line 3"),
            ("0,0,5,0,0,0,0,0,1\n", "line 2"),
            ("7,0,100000,0,0,0,0,0,1\n7,2,100000,0,0,0,0,0,1\n7,3,100000,0,0,0,0,0,1\n", "toss 7"),
            ("7,0,100000,0,0,0,0,0,1\n", "toss 7"),
        ] {
            let error = read(&(HEAD.to_owned() + rows)).unwrap_err().to_string();
            assert!(error.contains(told), "{rows} gave {error}");
        }
    }

    #[test]
    fn the_file_holds_109_tosses_of_unit_quaternions_that_end_on_a_face() {
        let tosses = read(super::super::TOSSES).unwrap();
        assert_eq!(tosses.len(), 109);
        for toss in &tosses {
            let upward = toss.rest.turned.inverse() * Vector3::z();
            assert!(upward.abs().max() > 0.998, "toss {} does not lie on a face: {upward}", toss.number);
        }
    }
}
