//! Boxes that land on faces, edges and corners: what the plate and the bar of a face would say, and what the tolerance leaves open.

use serde::Serialize;

use super::plate::{BEYOND_PEAK, BLOCK, along_length, measured, reason};
use super::{Groups, Ladder, Reference, Rung, cheapest, with};
use crate::engine::{Part, answer};
use crate::model::follow;
use crate::{Assessment, LandingLimit};
use clatter_flight::{Axis, Body, Drop, Place, Side, Until};
use clatter_product::{DropName, Error, Limit, Listed, Model, ProductFile};

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

/// Returns the same drop as one of the plate that the face of a box is, with its part; none of an edge, of a corner, of a part that does
/// not move across the face, and of a spin about another axis than that of the tilt.
fn as_plate(drop: &Drop, part: &Part) -> Option<(Drop, Part)> {
    let [length, width, thickness] = [Some(drop.body.length), drop.body.width, drop.body.thickness];
    let sides = [length?, width?, thickness?];
    let normal = part.place.axis as usize;
    if part.place.axis == Axis::Any || (0..3).any(|axis| axis != normal && drop.base[axis] != 0.0) {
        return None;
    }
    let [x, y] = [[1, 2], [0, 2], [0, 1]][normal];
    let [xy, xz, yz] = drop.body.products_m2;
    let (up, turns) = (drop.up(), rising(drop.up(), drop.spin()));
    let ([up, aside], [rise, beside]) = ([up[x], up[y]], [turns[x], turns[y]]);
    // Level and turning, it rises from then on.
    let is_level = up == 0.0 && aside == 0.0 && drop.spin_rad_s != 0.0;
    if (rise * aside - beside * up).abs() > 1e-9 * libm::hypot(up, aside) * drop.spin_rad_s.abs() {
        return None;
    }
    let tilt_rad = libm::asin(libm::hypot(up, aside).min(1.0));
    let spins = libm::hypot(rise, beside);
    let spin_rad_s = if is_level { spins } else { spins.copysign(rise * up + beside * aside) } + 0.0;
    let [up, aside] = if is_level { [rise, beside] } else { [up, aside] };
    let [a, b] = sides[x].ends_m;
    let mut body = Body::off_center(a, b, sides[x].gyration_m).ok()?.with_width(sides[y]);
    body.products_m2[0] = [yz, xz, xy][normal];
    // The thickness across the face, with the mass spread evenly over it.
    let body = body.with_thickness(Side::even(sides[normal].m()));
    let (base, direction_rad) = ([0.0, 0.0, 1.0], libm::atan2(aside, up));
    let plate = Drop { body, is_level: true, base, tilt_rad, direction_rad, spin_rad_s, spin_axis: None, ..*drop };
    let at_m = part.place.at_m;
    Some((plate, Part::at(Place::flat([at_m[x], at_m[y]]), part.suspension)))
}

/// Returns how fast the vertical moves in axes of a box that turns: n × ω.
fn rising([x, y, z]: [f64; 3], [a, b, c]: [f64; 3]) -> [f64; 3] {
    [y * c - z * b, z * a - x * c, x * b - y * a]
}

/// Returns the effect that the plate of a box face lacks: turned off it, the center of mass leaves the middle of the face by its height.
fn leans(plate: &Drop) -> String {
    let [height_m, half_m] =
        [plate.body.thickness().m(), plate.body.width_m().min(plate.body.length_m())].map(|m| 0.5 * m);
    with("its height over the face counts", "φ h/b", Some(plate.tilt_rad * height_m / half_m))
}

impl Ladder {
    /// Compares, of a box, the box itself, and where it lands on a face the plate that this is and the bar along it.
    pub(super) fn of_box(drop: &Drop, part: &Part, limit: &Limit, tolerance: f64) -> Result<Self, Error> {
        let exact = answer(drop, part, limit, Model::Compliant, tolerance)?;
        let until_s = (BEYOND_PEAK * exact.time_s).max(drop.clatter_s());
        let until = |drop: &Drop| follow(drop, Model::Compliant, tolerance, Until::Past(until_s));
        let plate = as_plate(drop, part);
        let mut models = Vec::new();
        if let Some((plate, part)) = &plate {
            let bar = (plate.along_length(), along_length(part));
            // A body that refuses the drop is left out.
            models.extend(measured(Rung::Bar, &|| until(&bar.0), &bar.1, limit, &exact));
            models.extend(measured(Rung::Plate, &|| until(plate), part, limit, &exact));
        }
        models.push(measured(Rung::Block, &|| until(drop), part, limit, &exact)?);
        let groups = plate.as_ref().map_or_else(|| Groups::of(drop, part), |(plate, part)| Groups::of(plate, part))?;
        let cheapest = cheapest(&models, tolerance).unwrap_or(Rung::Block);
        let reason = match &plate {
            Some((plate, _)) => reason(&models, cheapest, tolerance, &groups, leans(plate)),
            None => "no bar and no plate lands so, or moves the part along this axis".to_owned(),
        };
        let reference = Reference { model: Rung::Block, value: exact.value, tolerance: BLOCK };
        Ok(Self { unit: exact.unit, reference, models, cheapest, reason, groups })
    }
}
