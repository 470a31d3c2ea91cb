//! What a page draws is what was followed: points of curves are drops that can be answered again, places and changes agree with an
//! assessment of them.

#![cfg(test)]

use clatter_assess::design::Lever;
use clatter_assess::{
    Accuracy, Assessment, Component, Damping, Law, Limit, LimitKind, Model, Mount, Portrait, ProductFile, Spread,
    Verdict, answer,
};

const EXAMPLES: [&str; 4] = [
    include_str!("../../../tests/cases/bar-phone.toml"),
    include_str!("../../../tests/cases/bar-laptop.toml"),
    include_str!("../../../tests/cases/bar-terminal.toml"),
    include_str!("../../../tests/cases/bar-handheld.toml"),
];

fn drawn() -> impl Iterator<Item = (ProductFile, Assessment, Vec<Portrait>)> {
    EXAMPLES.into_iter().map(|text| {
        let file = ProductFile::read(text, "example.toml").unwrap();
        let assessment = file.assess().unwrap();
        let portraits = file.portraits(&assessment);
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
        let assessment = file.assess().unwrap();
        (assessment.components[0].tightest().limit, file.portraits(&assessment).remove(0).plate.unwrap())
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
                    assert_eq!(point.drop.first, *first);
                    assert!(point.drop.flat || point.drop.tilt_rad.to_bits() == point.tilt_rad.to_bits());
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
    let found = file.assess_to(&Accuracy::default()).unwrap();
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
                    let verdict = at(beyond).assess().unwrap().verdict;
                    assert_ne!(verdict, Verdict::Safe, "{} at {beyond} m", found.name);
                    edges += 1;
                }
            }
        }
    }
    assert!(edges >= 2, "{edges} ends within a product");
}

fn spread([lo, hi]: [f64; 2]) -> Spread {
    Spread::new(lo, hi, if lo < hi { Law::Range } else { Law::Value }).unwrap()
}

/// The file with a change.
fn changed(file: &ProductFile, component: &Component, lever: Lever, to: [f64; 2]) -> Option<ProductFile> {
    let (mut part, mut product) = (component.clone(), file.product.clone());
    match lever {
        Lever::InertiaRatio => product = product.with_inertia_ratio(to[0]).unwrap(),
        Lever::Restitution => product.restitution = spread(to),
        Lever::ContactTime => product.contact_time_s = Some(spread(to)),
        Lever::Position => part.position_m = spread(to),
        Lever::Across => part.across_m = spread(to),
        Lever::Frequency => {
            let Mount::Suspended { frequency_hz, .. } = &mut part.mount else { return None };
            *frequency_hz = spread(to);
        }
        Lever::Damping => {
            let Mount::Suspended { damping, .. } = &mut part.mount else { return None };
            *damping = Damping::Ratio(spread(to));
        }
        // What is asked stays as it is.
        Lever::Limit(_) => return None,
    }
    Some(ProductFile { product, ..alone(file, part) })
}

/// The changes that a page tells leave the margin that it says, but for what the drops of the pictures miss of the worst ones.
#[test]
fn changes_that_are_told_do_what_is_said_of_them() {
    let (mut count, mut limits) = (0, 0);
    for (file, assessment, portraits) in drawn() {
        for ((component, found), portrait) in file.components.iter().zip(&assessment.components).zip(&portraits) {
            assert_eq!(portrait.changes.is_none(), found.verdict == Verdict::Safe, "{}", found.name);
            for change in portrait.changes.iter().flat_map(|changes| &changes.enough) {
                let Some(file) = changed(&file, component, change.lever, change.to) else {
                    limits += 1;
                    continue;
                };
                let asked = most_asked(&file);
                assert!(asked <= 0.96, "{}, {change:?}: {asked} of the limit", found.name);
                count += 1;
            }
        }
    }
    assert!(count >= 6 && limits >= 2, "{count} changes, {limits} limits");
}

/// Where two limits are exceeded, to raise one of them is no change that does.
#[test]
fn one_limit_of_two_is_no_change() {
    let text = r#"
product = { name = "bar", length = "150 mm", radius_of_gyration = "43 mm", restitution = 0.3, contact_time = "0.4 ms", contact_law = "hysteretic" }
drop = { speed = "4 m/s", tilt = ["1 deg", "5 deg"] }
component = [{ name = "part", position = "30 mm", mount = "hard", LIMITS }]
"#;
    let raised = |limits: &str| {
        let file = ProductFile::read(&text.replace("LIMITS", limits), "bar.toml").unwrap_or_else(|e| panic!("{e}"));
        let portrait = file.portraits(&file.assess().unwrap()).remove(0);
        let changes = portrait.changes.expect("it fails");
        changes.enough.iter().filter(|change| matches!(change.lever, Lever::Limit(_))).count()
    };
    let (change, acceleration) = ("velocity_change_limit = \"3 m/s\"", "acceleration_limit = \"400 gn\"");
    assert_eq!(raised(change), 1);
    assert_eq!(raised(&format!("{change}, {acceleration}")), 0);
}
