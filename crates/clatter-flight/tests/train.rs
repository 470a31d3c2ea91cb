//! One train for all bodies: what an impact does to a place, and how a drop is seen from what touches first.

use clatter_flight::{Block, BlockDrop, Body, Contact, ContactLaw, Drop, Model, Plate, PlateScene, Stop, Train};

type Vector = [f64; 3];

fn cross([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

fn bar() -> Drop {
    Drop::new(Body::off_center(0.08, 0.06, 0.041).unwrap(), 4.0, 0.2, 0.3)
}

fn plate() -> Drop {
    let plate = Plate::new([0.08, 0.07, 0.03, 0.04], [0.043, 0.02]).unwrap();
    let scene = PlateScene::new(plate, 4.0, [2e-3, 1e-3], 9.81).unwrap();
    Drop::of_plate(&scene, 0.3).unwrap()
}

fn handheld() -> Drop {
    let block = Block::new([0.15, 0.07, 0.015], [0.005, -0.005, 0.001], [0.0207, 0.0435, 0.0478]).unwrap();
    Drop::of_block(&BlockDrop::tilted(block, 0.7, 0.4, 4.0, 9.81).unwrap(), 0.3)
}

/// An impulse at p along the vertical n changes the vertical velocity at q by 1 + (p × n) J⁻¹ (q × n), with J over the mass.
#[test]
fn the_first_impact_moves_a_place_by_its_lever_arm() {
    // Contacts that short turn nothing.
    let contacts = Model::Contacts(Contact::new(ContactLaw::Dashpot, 0.3, 1e-6).unwrap());
    let tilted = bar().up();
    for (drop, model, upward, from, radii, near) in [
        (bar(), Model::FiniteTilt, tilted, [-0.08, 0.0, 0.0], [f64::INFINITY, 0.041, f64::INFINITY], 1e-12),
        (plate(), Model::Map, [0.0, 0.0, 1.0], [-0.08, -0.03, 0.0], [0.02, 0.043, 1.0], 1e-12),
        (plate(), Model::Ballistic, [0.0, 0.0, 1.0], [-0.08, -0.03, 0.0], [0.02, 0.043, 1.0], 1e-12),
        (handheld(), contacts, handheld().up(), [-0.08, -0.03, -0.0085], [0.0207, 0.0435, 0.0478], 1e-3),
    ] {
        let train = Train::new(&drop, model, None, Some(1)).unwrap();
        let (first, half_m) = (train.impacts().next().unwrap(), drop.sides());
        assert_eq!((drop.points()[first.point], first.time_s), (drop.lowest(), 0.0));
        let does = |q: Vector| {
            let [own, other] = [from, q].map(|place| cross(place, upward));
            1.0 + (0..3).map(|i| own[i] * other[i] / (radii[i] * radii[i])).sum::<f64>()
        };
        for at in [[-1.0, -1.0, -1.0], [0.3, -0.6, 0.8], [1.0, 0.2, -0.4]] {
            let mut place = [0.0; 3];
            for ((place, side), at) in place.iter_mut().zip(&half_m).zip(at) {
                *place = 0.5 * side.m() * at - side.center_m();
            }
            let (got, want) = (first.delta_v_at(at) / first.delta_v_m_s[first.point], does(place) / does(from));
            assert!((got - want).abs() < near, "{model:?} at {at:?}: {got}, not {want}");
        }
    }
}

/// What does not follow a body is refused, and a limit ends a train of any.
#[test]
fn a_train_ends_at_its_limits() {
    let contacts = Model::Contacts(Contact::new(ContactLaw::Hysteretic, 0.3, 4e-4).unwrap());
    for (drop, model) in [(plate(), Model::FiniteTilt), (handheld(), Model::Map), (handheld(), Model::FiniteTilt)] {
        assert_eq!(Train::new(&drop, model, None, None).unwrap_err(), clatter_flight::Error::Instant);
    }
    for (drop, model) in [
        (bar(), Model::Ballistic),
        (bar(), contacts),
        (plate(), Model::Map),
        (plate(), Model::Ballistic),
        (plate(), contacts),
        (handheld(), contacts),
    ] {
        let whole = Train::new(&drop, model, None, None).unwrap();
        let second_s = whole.impacts().nth(1).unwrap().time_s;
        let cut = Train::new(&drop, model, None, Some(2)).unwrap();
        assert!(matches!(cut.stop, Stop::ImpactLimit { .. }) && cut.count() == 2, "{model:?}: {:?}", cut.stop);
        let cut = Train::new(&drop, model, Some(0.5 * second_s), None).unwrap();
        let (stop, takes_time) = (Stop::TimeLimit { time_s: 0.5 * second_s }, model == contacts);
        assert_eq!((cut.stop, cut.count(), cut.energy_error.is_some()), (stop, 1, takes_time), "{model:?}");
    }
}

/// Seen from what touches first, a drop is followed as it is.
#[test]
fn a_drop_is_seen_from_what_touches_first() {
    let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
    for direction in [20.0_f64, 110.0, 200.0, 290.0] {
        let mut drop = Drop { direction_rad: direction.to_radians(), ..plate() };
        drop.body.products_m2 = [2e-4, 0.0, 0.0];
        for drop in [drop, drop.with_slope_rates([2.0, -1.0]), drop.with_slope_rates([3.0, 5.0])] {
            let seen = drop.from_first();
            let [own, same] = [drop, seen].map(|drop| drop.of_level().unwrap().unwrap());
            assert_eq!((seen.lowest(), own.plate()), ("a", same.plate()), "{direction}");
            assert!(near(&own.gaps_m(), &same.gaps_m()) && near(&own.spin_rad_s(), &same.spin_rad_s()), "{direction}");
            let turned: Vec<f64> = drop.up().into_iter().zip(drop.exchanged()).map(|(up, sign)| sign * up).collect();
            assert!(near(&turned, &seen.up()), "{direction}: {turned:?}");
        }
    }
}

/// Neighbors of the lowest point are as much higher as the body is turned.
#[test]
fn neighbors_are_higher_by_the_turn_of_the_body() {
    let drop = handheld();
    let (up, corners) = (drop.up(), drop.of_box().unwrap().unwrap().block().corners_m());
    let heights = corners.map(|corner| corner.iter().zip(up).map(|(x, up)| x * up).sum::<f64>());
    let lowest = heights.into_iter().fold(f64::INFINITY, f64::min);
    let neighbors = drop.neighbors_m();
    assert_eq!((drop.lowest(), neighbors.iter().map(|of| of.0).collect()), ("---", vec!["+--", "-+-", "--+"]));
    for (name, rise) in neighbors {
        let corner = drop.points().iter().position(|point| *point == name).unwrap();
        assert!((heights[corner] - lowest - rise).abs() < 1e-15, "{name}: {rise}");
    }
    let names = |drop: &Drop| drop.neighbors_m().iter().map(|of| of.0).collect::<Vec<_>>();
    let towards = |degrees: f64| names(&Drop { direction_rad: degrees.to_radians(), ..plate() });
    assert_eq!([20.0, 110.0, 200.0, 290.0].map(towards), [["b", "d"], ["a", "c"], ["d", "b"], ["c", "a"]]);
    assert_eq!((names(&bar()), bar().neighbors_m()[0].1), (vec!["b"], bar().gap_m()));
}
