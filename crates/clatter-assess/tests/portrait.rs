//! What a page draws is what was followed: points of curves are drops that can be answered again, places agree with an assessment of them.

#![cfg(test)]

use clatter_assess::{
    Accuracy, Assessment, Portrait, Verdict, answer,
    design::{Bounds, Lever, Outcome},
};
use clatter_product::{Component, Limit, LimitKind, Model, ProductFile, Spread};

const EXAMPLES: [&str; 4] = [
    include_str!("../../../tests/cases/bar-phone.toml"),
    include_str!("../../../tests/cases/bar-laptop.toml"),
    include_str!("../../../tests/cases/bar-terminal.toml"),
    include_str!("../../../tests/cases/bar-handheld.toml"),
];

fn drawn() -> impl Iterator<Item = (ProductFile, Assessment, Vec<Portrait>)> {
    EXAMPLES.into_iter().map(|text| {
        let file = ProductFile::read(text, "example.toml").unwrap();
        let assessment = clatter_assess::assess(&file).unwrap();
        let portraits = clatter_assess::portraits(&file, &assessment);
        (file, assessment, portraits)
    })
}

/// The map of every limit of a part of a plate is that of the part with this limit alone, around its own worst drop.
#[test]
fn each_limit_has_its_own_map() {
    let text = r#"
product = { name = "tablet", length = "240 mm", width = "170 mm", radius_of_gyration = ["69 mm", "49 mm"], restitution = 0.3, contact_time = "0.6 ms", contact_law = "hysteretic" }
drop = { height = "1 m", tilt = "4 deg", direction = ["20 deg", "80 deg"] }
component = [{ name = "board", position = ["-60 mm", "30 mm"], natural_frequency = "90 Hz", damping_ratio = 0.1, acceleration_limit = "500 gn", rattle_space = "9 mm", angular_velocity_change_limit = "80 rad/s" }]
"#;
    let of = |text: &str| {
        let file = ProductFile::read(text, "plate.toml").unwrap();
        let assessment = clatter_assess::assess(&file).unwrap();
        (
            assessment.components[0].tightest().limit,
            clatter_assess::portraits(&file, &assessment).remove(0).plate.unwrap(),
        )
    };
    let alone = |keep: &str| {
        let [acceleration, rattle, turn] = [
            ", acceleration_limit = \"500 gn\"",
            ", rattle_space = \"9 mm\"",
            ", angular_velocity_change_limit = \"80 rad/s\"",
        ];
        let left = [acceleration, rattle, turn].into_iter().filter(|limit| !limit.contains(keep));
        of(&left.fold(text.to_owned(), |text, limit| text.replace(limit, "")))
    };
    let (tightest, all) = of(text);
    assert_eq!(tightest, LimitKind::AngularVelocityChange, "which asks the same everywhere");
    assert_eq!(all.maps.len(), 2);
    for (keep, map) in ["rattle", "acceleration"].into_iter().zip(&all.maps) {
        let (own, one) = alone(keep);
        assert!(own == map.0 && one.maps == [map.clone()], "{own:?}");
    }
    // With room to turn as well.
    let (tightest, turning) = of(&text.replace("80 rad/s", "800 rad/s"));
    assert_eq!(tightest, LimitKind::RattleSpace);
    assert_eq!(turning.maps, all.maps);
}

/// Each point is answered again by the one engine, from the drop and the part that it names. The curves are followed to 2 %, and each
/// strike multiplies what those before got wrong.
#[test]
fn every_point_of_a_curve_is_a_drop_that_was_followed() {
    let mut count = 0;
    for (file, assessment, portraits) in drawn() {
        let model = if file.product.contact_time_s.is_some() { Model::Compliant } else { Model::FiniteTilt };
        for ((component, found), portrait) in file.components.iter().zip(&assessment.components).zip(&portraits) {
            let tightest = found.tightest();
            let limit = Limit::of(component).into_iter().find(|limit| limit.kind == tightest.limit).unwrap();
            let mut most = 0.0_f64;
            for (first, points) in &portrait.over_tilt {
                assert!(points.len() > 40, "{}: {} points", found.name, points.len());
                assert!(points.windows(2).all(|pair| pair[0].tilt_rad < pair[1].tilt_rad), "{}", found.name);
                for point in points {
                    assert_eq!(point.drop.first(), *first);
                    assert!(point.drop.is_flat || point.drop.tilt_rad.to_bits() == point.tilt_rad.to_bits());
                    most = most.max(point.share);
                }
                for point in points.iter().step_by(7) {
                    let again = answer(&point.drop, &point.part, &limit, model, 0.01).unwrap().utilization();
                    let off = point.share / again - 1.0;
                    assert!((-0.03..0.03).contains(&off), "{}, {point:?}: {again}", found.name);
                    count += 1;
                }
            }
            // The worst case is on the curve, and what other points exceed it by the assessment has allowed for.
            let demand = tightest.demand.unwrap() / tightest.allowed;
            let allowed_for = demand * (1.0 + tightest.uncertainty.max(0.02));
            assert!(most >= demand && most <= allowed_for, "{}: {most} beside {demand}", found.name);
        }
    }
    assert!(count > 100, "{count} points");
}

/// The file with one part alone, changed.
fn alone(file: &ProductFile, component: Component) -> ProductFile {
    ProductFile { components: vec![component], ..file.clone() }
}

fn most_asked(file: &ProductFile) -> f64 {
    let found = clatter_assess::assess_to(file, &Accuracy::default()).unwrap();
    let share = |limit: &clatter_assess::LimitAssessment| limit.demand.unwrap() / limit.allowed;
    found.components[0].limits.iter().map(share).fold(0.0, f64::max)
}

/// Just within a zone an assessment finds no limit exceeded by more than the search may miss; just beyond it, the part is not safe.
#[test]
fn zones_agree_with_an_assessment_of_their_ends() {
    let mut edges = 0;
    for (file, assessment, portraits) in drawn() {
        let length = file.product.body.length_m();
        for ((component, found), portrait) in file.components.iter().zip(&assessment.components).zip(&portraits) {
            let (here, half) = (component.position_m.at(0.5), 0.5 * component.extent_m);
            let inside = portrait.zone_m.is_some_and(|[lo, hi]| (lo..=hi).contains(&here));
            assert_eq!(inside, found.verdict == Verdict::Safe, "{}: {:?}", found.name, portrait.zone_m);
            let Some([lo, hi]) = portrait.zone_m else { continue };
            for (edge, out) in [(lo, -1.0), (hi, 1.0)] {
                let at =
                    |x: f64| alone(&file, Component { position_m: Spread::value(x).unwrap(), ..component.clone() });
                let asked = most_asked(&at(edge));
                assert!(asked <= 1.02, "{} at {edge} m: {asked}", found.name);
                let beyond = edge + out * 0.1 * length;
                if beyond.abs() + half <= 0.5 * length {
                    let verdict = clatter_assess::assess(&at(beyond)).unwrap().verdict;
                    assert_ne!(verdict, Verdict::Safe, "{} at {beyond} m", found.name);
                    edges += 1;
                }
            }
        }
    }
    assert!(edges >= 2, "{edges} ends within a product");
}

/// A place that is enough lies within the zone that is drawn.
#[test]
fn places_that_are_enough_are_within_the_zone() {
    let mut places = 0;
    for (file, assessment, portraits) in drawn() {
        for remedies in clatter_assess::remedies(&file, &assessment, &Bounds::default(), 0.1).unwrap() {
            let place = remedies.levers.iter().find(|remedy| remedy.lever == Lever::Position).unwrap();
            let Outcome::Change { change, .. } = &place.outcome else { continue };
            let zone = portraits[remedies.component].zone_m;
            let holds = zone.is_some_and(|[lo, hi]| change.to.iter().all(|x| (lo..=hi).contains(x)));
            assert!(holds, "{}: {change:?}, {zone:?}", file.components[remedies.component].name);
            places += 1;
        }
    }
    assert!(places >= 2, "{places}");
}
