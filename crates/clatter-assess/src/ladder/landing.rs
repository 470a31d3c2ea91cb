//! Boxes that land on faces, edges and corners: how late their last corner may come.

use serde::Serialize;

use crate::{Assessment, LandingLimit};
use clatter_product::{DropName, Listed, ProductFile};

/// One drop of a box: how late its last corner may come, compared with a contact, and the limit with least room.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LandingLadder {
    /// The name of the drop, by the face, edge or corner on which the box lands.
    pub landing: DropName,
    /// The number of corners of that face, edge or corner.
    pub corners: usize,
    /// The angle by which it may be turned off that.
    pub tolerance_deg: f64,
    /// The time by which the last of these corners comes down later than the first, if the first did nothing, at least and at most over the
    /// tolerance, the speeds and the spins: the gap over the speed of that corner.
    pub last_corner_s: [f64; 2],
    /// The time of a lone contact of any corner, at least and at most.
    pub contact_time_s: [f64; 2],
    /// The angle by which it may be turned off, whatever the direction, so that the last corner comes within the shortest contact; none
    /// where the tolerance allows no more, so that it always lands as one.
    pub as_one_to_deg: Option<f64>,
    /// The limit with the smallest margin.
    pub tightest: Option<LandingLimit>,
}

impl LandingLadder {
    /// Returns whether the last of its corners may come when the contact of the first is over, so that the box clatters.
    #[must_use]
    pub fn may_clatter(&self) -> bool {
        self.as_one_to_deg.is_some()
    }
}

/// Returns the range of motions that the tolerance leaves open for each drop of a box.
pub(super) fn landing_ladders(file: &ProductFile, assessment: &Assessment) -> Vec<LandingLadder> {
    let Some((faces_m, [shortest, longest])) = file.product.body.faces_m().zip(file.product.contact_times_s()) else {
        return Vec::new();
    };
    let sides = faces_m.map(|[low, high]| low + high);
    let listed = file.listed();
    let attitudes = file.landings.iter().filter_map(|landing| landing.attitude);
    let each = attitudes.zip(&listed).zip(&assessment.landings);
    each.map(|((attitude, Listed { drop, .. }), assessed)| {
        // Corners that are landed on lie along the sides that are level.
        let level = attitude.level(faces_m);
        let reach_m = level.iter().fold(0.0, |all, axis| libm::hypot(all, sides[*axis]));
        let [slow, _] = drop.speeds_m_s();
        // So slowly its farthest corner comes down, turned up as fast as it may be.
        let far_m = faces_m.iter().fold(0.0, |all, [low, high]| libm::hypot(all, low.max(*high)));
        let slow = slow - drop.fastest_rad_s() * far_m;
        let tolerance = drop.tilt_rad.hi();
        let as_one = libm::asin((shortest * slow / reach_m).min(1.0));
        LandingLadder {
            landing: assessed.landing,
            corners: 1 << level.len(),
            tolerance_deg: tolerance.to_degrees(),
            last_corner_s: [0.0, reach_m * libm::sin(tolerance) / slow],
            contact_time_s: [shortest, longest],
            as_one_to_deg: (as_one < tolerance).then(|| as_one.to_degrees()),
            tightest: assessed.tightest().cloned(),
        }
    })
    .collect()
}
