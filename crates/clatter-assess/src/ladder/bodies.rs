//! The same drop by bodies of less: the bar along the length, the plate of small tilt, the box with full rotation.

use super::{Compared, FINER, Reference, Rung, measured, with};
use crate::engine::{Part, answer, of_followed};
use crate::model::follow;
use clatter_flight::{Axis, Body, Drop, Followed, Place, Side, Until};
use clatter_product::{Error, Limit, Model};

/// The time until which bodies are followed, over the time of the peak.
const BEYOND_PEAK: f64 = 1.5;
/// A box is left where later presses do less than this share of the largest.
const BLOCK: f64 = 1e-3;

/// Compares bodies on a drop of a plate or a box.
pub(super) fn compared(drop: &Drop, part: &Part, limit: &Limit, tolerance: f64) -> Result<Compared, Error> {
    let by_contacts = |drop: &Drop, until| follow(drop, Model::Compliant, tolerance, until);
    let plate = if drop.is_solid() { as_plate(drop, part) } else { Some((*drop, *part)) };
    // All are followed as far, and once.
    let peak = if drop.is_solid() {
        answer(drop, part, limit, Model::Compliant, tolerance)?
    } else {
        of_followed(&by_contacts(drop, Until::Over)?, part, limit)?
    };
    let until_s = (BEYOND_PEAK * peak.time_s).max(drop.clatter_s());
    let until = |drop: &Drop| by_contacts(drop, Until::Past(until_s));
    let as_block = || if drop.is_solid() { until(drop) } else { Ok(Followed::as_block(drop, until_s)?) };
    let (model, exact, worked_out) = match as_block().and_then(|block| of_followed(&block, part, limit)) {
        _ if drop.is_solid() => (Rung::Block, peak, BLOCK),
        Ok(block) => (Rung::Block, block, BLOCK),
        Err(_) => {
            let finer = FINER * tolerance;
            (Rung::Plate, answer(drop, part, limit, Model::Compliant, finer)?, finer)
        }
    };
    let one = |rung, part: &Part, follow: &dyn Fn() -> Result<Followed, Error>| {
        let answer = || of_followed(&follow()?, part, limit);
        measured(rung, &exact, &answer, &|| Ok(follow()?.struck_s().len()))
    };
    let mut models = Vec::new();
    if let Some((plate, of_plate)) = &plate {
        // A body that refuses the drop is left out.
        let bar = (plate.along_length(), Part::new(of_plate.place.at_m[0], of_plate.suspension));
        models.extend(one(Rung::Bar, &bar.1, &|| until(&bar.0)));
        models.extend(one(Rung::Plate, of_plate, &|| until(plate)));
    }
    if model == Rung::Block {
        models.push(one(Rung::Block, part, &as_block)?);
    }
    let reference = Reference { model, value: exact.value, tolerance: worked_out };
    let (of_groups, of_part) = plate.unwrap_or((*drop, *part));
    let plate_lacks = lacks(&of_groups, drop.is_solid());
    Ok(Compared { unit: exact.unit, reference, models, drop: of_groups, part: of_part, plate_lacks })
}

/// Returns the effect that a plate lacks: real tilt; of the face of a box, off whose middle its center of mass leaves by its height.
fn lacks(plate: &Drop, is_face: bool) -> String {
    if !is_face {
        return with("real tilt counts", "φ²", Some(plate.tilt_rad.powi(2)));
    }
    let [height_m, half_m] =
        [plate.body.thickness().m(), plate.body.width_m().min(plate.body.length_m())].map(|m| 0.5 * m);
    with("its height over the face counts", "φ h/b", Some(plate.tilt_rad * height_m / half_m))
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
    let plate = Drop {
        body,
        is_level: true,
        base,
        tilt_rad,
        direction_rad,
        spin_rad_s,
        spin_axis: None,
        ..drop.without_friction()
    };
    let at_m = part.place.at_m;
    Some((plate, Part::at(Place::flat([at_m[x], at_m[y]]), part.suspension)))
}

/// Returns how fast the vertical moves in axes of a box that turns: n × ω.
fn rising([x, y, z]: [f64; 3], [a, b, c]: [f64; 3]) -> [f64; 3] {
    [y * c - z * b, z * a - x * c, x * b - y * a]
}
