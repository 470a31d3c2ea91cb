//! This module follows every direction of tilt of a plate.
//!
//! ```
//! use clatter::Plate;
//! use clatter_answer::atlas;
//! let question = atlas::Question::new(Plate::uniform(0.3)?);
//! let answer = atlas::answer(&question)?;
//! // Directions from 0 to 1, without a gap.
//! assert_eq!((answer.words[0].from.0, answer.words.last().map(|word| word.to.0)), (0.0, Some(1.0)));
//! # Ok::<(), clatter::Error>(())
//! ```

use clatter::{Atlas, AtlasPeak, Error, Plate, Word};
use serde::Serialize;

use crate::Json;

/// A plate that falls without spin, corner a first, in every direction.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The plate.
    pub plate: Plate,
    /// The largest number of strikes followed in each direction, from 1 to 100.
    pub limit: usize,
}

impl Question {
    /// Makes a question with 40 strikes followed in each direction.
    #[must_use]
    pub fn new(plate: Plate) -> Self {
        Self { plate, limit: 40 }
    }
}

/// The words of a plate, and the largest shocks of all directions.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// Radii of gyration along x and y, over half the length and half the width.
    pub gyration_ratio: [Json; 2],
    /// Center of mass, in half-lengths and half-widths from the middle.
    pub center_of_mass: [Json; 2],
    /// Coefficient of restitution.
    pub e: Json,
    /// The largest number of strikes followed in each direction.
    pub limit: usize,
    /// The directions: one entry for each interval of them.
    pub words: Vec<Directions>,
    /// The largest shocks of all directions.
    pub peak: Peak,
}

/// An interval of directions with one order of corners. A direction is r = HY/(HX + HY), from heights HX of b and HY of d.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Directions {
    /// First direction, in [0, 1].
    pub from: Json,
    /// Last direction, in [0, 1].
    pub to: Json,
    /// The corners in the order of their strikes.
    pub word: String,
    /// True where the plate bounced clear within the limit.
    pub ended: bool,
    /// Largest shocks of these directions.
    pub peak: Peak,
}

/// Largest velocity shocks, in v0.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Peak {
    /// The largest shock at a corner.
    pub corner: Json,
    /// The largest shock at the center of mass.
    pub center: Json,
    /// The bound on the shock of a corner by any strike that was not followed.
    pub later: Json,
}

/// Follows every direction of tilt.
///
/// # Errors
/// A limit that is not from 1 to 100.
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { plate, limit } = question;
    Ok(Answer::of(plate, *limit, &plate.atlas(*limit)?))
}

impl Answer {
    /// Makes the answer from the atlas of a plate, of which at most `limit` strikes were followed.
    #[must_use]
    pub fn of(plate: &Plate, limit: usize, atlas: &Atlas) -> Self {
        let directions = |word: &Word| Directions {
            from: Json(word.from),
            to: Json(word.to),
            word: word.corners.iter().map(|corner| corner.letter()).collect(),
            ended: word.ended,
            peak: Peak { corner: Json(word.peak()), center: Json(word.center), later: Json(word.later) },
        };
        let AtlasPeak { corner, center, later, .. } = atlas.peak();
        Self {
            gyration_ratio: plate.gyration_ratios().map(Json),
            center_of_mass: plate.center_of_mass().map(Json),
            e: Json(plate.e()),
            limit,
            words: atlas.words().iter().map(directions).collect(),
            peak: Peak { corner: Json(corner), center: Json(center), later: Json(later) },
        }
    }
}
