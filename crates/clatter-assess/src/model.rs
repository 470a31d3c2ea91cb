//! Models of a drop, and the one way to follow it.

use std::f64::consts::FRAC_PI_2;

use clatter_flight::{Drop, Followed, Place, Until};
use clatter_product::{Error, Model};

/// Follows a drop by a model, to a tolerance.
///
/// # Errors
/// [`Error::Contact`] for contacts whose time is not known, [`Error::OwnContacts`] and [`Error::PlateModel`] for a model that does not
/// follow the body, [`Error::Flight`] and [`Error::Bar`] for a drop that the model does not take.
pub(crate) fn follow(drop: &Drop, model: Model, tolerance: f64, until: Until) -> Result<Followed, Error> {
    match Followed::new(drop, model.physics(drop)?, tolerance, until) {
        Err(clatter_flight::Error::Instant) => Err(Error::PlateModel(model)),
        followed => Ok(followed?),
    }
}

/// Checks what no model would refuse: the contact time, which instant impacts do not need, the spin of a flat drop, and the place of a
/// part.
///
/// # Errors
/// [`Error::Setting`].
pub(crate) fn check_drop(drop: &Drop, place: &Place) -> Result<(), Error> {
    let [position_m, across_m, height_m] = place.at_m;
    if let Some(value) = drop.contact_time_s.filter(|time| !(1e-12..=1e3).contains(time)) {
        return Err(Error::Setting { name: "contact time in s", value, allowed: "in [1e-12, 1000]" });
    }
    if drop.is_flat && drop.spin_rad_s != 0.0 {
        let (name, allowed) = ("spin in rad/s", "0 of a flat drop by instant impacts: its ends do not land as one");
        return Err(Error::Setting { name, value: drop.spin_rad_s, allowed });
    }
    if drop.spin_axis.is_some() && !drop.is_solid() {
        let (name, allowed) =
            ("spin across the tilt in rad/s", "0: turning along length and width as its corners rise");
        return Err(Error::Setting { name, value: drop.spin_rad_s, allowed });
    }
    let slides = drop.friction != 0.0 || drop.slide_m_s.iter().any(|along| *along != 0.0) || drop.along.is_some();
    if slides && !drop.is_solid() {
        let (name, allowed) = ("friction", "0, without a slide, of a bar and of a plate: boxes alone slide and stick");
        return Err(Error::Setting { name, value: drop.friction, allowed });
    }
    if !(0.0..=FRAC_PI_2).contains(&drop.tilt_rad) {
        return Err(Error::Setting { name: "tilt in rad", value: drop.tilt_rad, allowed: "in [0, pi/2]" });
    }
    let sides = [Some(drop.body.length), drop.body.width, drop.body.thickness].into_iter().flatten();
    for value in sides.flat_map(|side| side.ends_m) {
        if !(0.0..=1e30).contains(&value) {
            let (name, allowed) = ("distance of an end from the center of mass in m", "0 or more");
            return Err(Error::Setting { name, value, allowed });
        }
    }
    for (name, value) in drop.body.feet.iter().flat_map(|feet| {
        let [x, y] = feet.inset_m;
        [("inset of the feet in m", x), ("inset of the feet in m", y), ("height of the feet in m", feet.height_m)]
    }) {
        if !(0.0..=1e30).contains(&value) {
            return Err(Error::Setting { name, value, allowed: "0 or more" });
        }
    }
    // Places are rounded as they are converted.
    let [most, most_across] = drop.sides_m().map(|side_m| 0.5 * side_m * (1.0 + 1e-9));
    if position_m.is_nan() || position_m.abs() > most {
        let (name, allowed) = ("position of the part in m", "up to half of the length on both sides");
        return Err(Error::Setting { name, value: position_m, allowed });
    }
    if across_m.is_nan() || across_m.abs() > most_across {
        let (name, allowed) = ("place of the part across the product in m", "up to half of the width on both sides");
        return Err(Error::Setting { name, value: across_m, allowed });
    }
    let most_high = drop.body.faces_m().map_or(f64::INFINITY, |[.., [low, high]]| 0.5 * (low + high) * (1.0 + 1e-9));
    if height_m.is_nan() || height_m.abs() > most_high {
        let (name, allowed) = ("height of the part in m", "up to half of the thickness on both sides");
        return Err(Error::Setting { name, value: height_m, allowed });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use clatter_flight::{Axis, Body, Side, Stop};

    use super::*;
    use crate::shock::{largest, largest_turn, shocks_of_turning};

    /// Returns a box of these sides, with these radii of gyration along length and width, that rises steeply to its end b.
    fn dropped([length, width, thickness_m]: [f64; 3], [kx, ky]: [f64; 2], center: f64) -> Drop {
        let width = Side { ends_m: [0.5 * width + center, 0.5 * width - center], gyration_m: ky };
        let body = Body::new(length, kx).unwrap().with_width(width).with_thickness(Side::even(thickness_m));
        Drop {
            is_level: false,
            base: [0.6, 0.0, 0.8],
            direction_rad: 0.3,
            gravity_m_s2: 9.81,
            contact_time_s: Some(1e-4),
            ..Drop::new(body, 3.0, 0.05, 0.4)
        }
    }

    /// Set down on its narrow end it falls over, and lies: a place carries its weight along the axis that is up, and all of it along any.
    #[test]
    fn a_box_is_followed_until_it_lies() {
        let mut drop = dropped([0.15, 0.07, 0.02], [0.043, 0.02], 0.0);
        drop.base = [0.98, 0.0, 0.2];
        let followed = follow(&drop, Model::Compliant, 0.01, Until::Over).unwrap();
        assert!(matches!(followed.stop(), Stop::AtRest { .. }), "{:?}", followed.stop());
        let at = |axis| followed.carried_m_s2(&Place { at_m: [0.02, 0.01, 0.003], axis });
        let [x, y, z, any] = [Axis::X, Axis::Y, Axis::Z, Axis::Any].map(at);
        // It lies on its broad side, but for some that turns on about the vertical and dents.
        assert!((z.abs() - 9.81).abs() < 0.1 && x.abs() < 0.5 && y.abs() < 0.5, "{x}, {y}, {z}");
        assert!((any - (x * x + y * y + z * z).sqrt()).abs() < 1e-12 && followed.weight_to_come_m_s2() == 0.0);
        // Left in flight, it has its weight still to come.
        let left = follow(&drop, Model::Compliant, 0.01, Until::Lands).unwrap();
        let weights = [left.weight_to_come_m_s2(), left.carried_m_s2(&Place::flat([0.0; 2]))];
        assert_eq!(weights.map(f64::to_bits), [9.81_f64, 0.0].map(f64::to_bits));
    }

    /// It has bounced clear before it comes down again: after 2 e v/g.
    #[test]
    fn a_body_is_clear_in_its_first_flight() {
        let mut drop = dropped([0.15, 0.07, 0.004], [0.043, 0.02], 0.0);
        drop.body.width = None;
        drop.tilt_rad = 0.0;
        let flight_s = 2.0 * drop.restitution * drop.speed_m_s / drop.gravity_m_s2;
        assert!(drop.clear_s() > 2e-4 && drop.clear_s() < flight_s, "{} of {flight_s}", drop.clear_s());
    }

    /// Of plates that tumble over several corners too the largest turn is that of all directions.
    #[test]
    fn the_largest_turn_of_a_plate_is_that_of_all_directions() {
        let mut off = 0.0_f64;
        for n in 0..60_u32 {
            let x = |k: u32| f64::from((n * k + 7) % 61) / 61.0;
            let mut drop = dropped([0.15, 0.04 + 0.1 * x(11), 0.004], [0.043, 0.012 + 0.03 * x(11)], 0.01 * x(5));
            (drop.direction_rad, drop.is_level, drop.base) = (TAU * x(17), true, [0.0, 0.0, 1.0]);
            (drop.tilt_rad, drop.restitution) = (0.2 * x(23), 0.1 + 0.5 * x(29));
            let followed = follow(&drop, Model::Compliant, 0.01, Until::Lands).unwrap();
            let all = followed
                .turned()
                .map(|turned| largest(&shocks_of_turning(&followed, &turned)).change)
                .fold(0.0, f64::max);
            let most = largest_turn(&followed, 0.0).unwrap().change;
            off = off.max(1.0 - most / all);
            assert!(largest_turn(&followed, 1.001 * all).is_none() && most <= all, "{n}: {most} of {all}");
            assert!(largest_turn(&followed, 0.9 * all).is_some(), "{n}: {all}");
        }
        assert!(off < 1e-12, "{off} is missed");
    }

    /// The largest turn of a box is found wherever it is above the given threshold, and only there.
    #[test]
    fn the_largest_turn_of_a_box_is_not_passed_over() {
        for tilt_rad in [0.02, 0.1, 0.25] {
            let drop = Drop { tilt_rad, ..dropped([0.15, 0.07, 0.02], [0.043, 0.02], 0.0) };
            let followed = follow(&drop, Model::Compliant, 0.01, Until::Lands).unwrap();
            let most = largest_turn(&followed, 0.0).unwrap().change;
            // About each axis one by one.
            let each = followed.turned().map(|about| largest(&shocks_of_turning(&followed, &about)).change);
            assert_eq!(each.fold(0.0, f64::max).to_bits(), most.to_bits());
            assert!(most > 1.0 && largest_turn(&followed, 0.999 * most).is_some(), "{tilt_rad}: {most}");
            assert!(largest_turn(&followed, 1.001 * most).is_none(), "{tilt_rad}: {most}");
        }
    }
}
