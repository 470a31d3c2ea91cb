//! Boxes that land on a face, an edge or a corner, by hand or as a standard lists them.

#![expect(clippy::print_stdout, reason = "a long run tells what it found")]

use std::f64::consts::TAU;

use crate::plates::file;
use crate::random::Random;
use clatter_assess::{
    Across, Attitude, Limit, Model, Mount, Note, Part, Posture, ProductFile, SingleDrop, Verdict, answer,
};
use clatter_shock::{DampingRatio, Suspension};
use rayon::prelude::*;

/// A handheld terminal as MIL-STD-810H drops it in transit.
pub(crate) const HANDHELD: &str = r#"
[product]
name = "handheld"
length = "150 mm"
width = "70 mm"
thickness = "14 mm"
mass = "300 g"
radius_of_gyration = ["43 mm", "20 mm"]
restitution = 0.4
contact_time = "0.4 ms"
contact_law = "hysteretic"

[drop]
standard = "MIL-STD-810H/516.8-IV"

[[component]]
name = "display"
position = ["10 mm", "5 mm"]
extent = ["20 mm", "10 mm"]
mount = "hard"
acceleration_limit = "5000 gn"

[[component]]
name = "battery"
position = ["-30 mm", "0 mm"]
height = "2 mm"
axis = "x"
natural_frequency = "120 Hz"
damping_ratio = 0.1
rattle_space = "9 mm"
"#;

/// The same landing on one face, edge or corner.
pub(crate) fn on(key: &str, faces: &str) -> String {
    HANDHELD.replace(
        "standard = \"MIL-STD-810H/516.8-IV\"",
        &format!(
            "height = \"1.22 m\"\n{key} = \"{faces}\"\nattitude_tolerance = \"{} deg\"",
            if key == "face" { 2 } else { 5 }
        ),
    )
}

#[test]
fn a_standard_is_its_drops_one_by_one() {
    let assessment = file(HANDHELD).assess().expect("an assessment");
    assert_eq!(assessment.landings.len(), 26);
    assert!(assessment.landings.iter().all(|landing| landing.source.is_some_and(|said| said.contains("516.8-IX"))));
    // By hand, each alone, says the same.
    for (key, faces) in [("face", "bottom"), ("edge", "front end-b"), ("corner", "top back end-a")] {
        let attitude = Attitude::on(faces).expect("an attitude");
        let listed = assessment.landings.iter().find(|landing| landing.landing == attitude).expect("a landing");
        let alone = file(&on(key, faces)).assess().expect("an assessment");
        let limits = alone.components.iter().flat_map(|component| &component.limits);
        for (limit, listed) in limits.zip(&listed.limits) {
            assert_eq!((limit.demand, limit.verdict), (listed.demand, listed.verdict), "{faces}");
        }
    }
    // The limit of a part is told for the drop that leaves it least room.
    for (n, component) in assessment.components.iter().enumerate() {
        let most = assessment.landings.iter().filter_map(|landing| landing.limits[n].demand).fold(0.0, f64::max);
        let limit = &component.limits[0];
        assert_eq!(limit.demand, Some(most), "{}", component.name);
        let governs = limit.worst_case.and_then(|worst| worst.landing).expect("a landing");
        let landing = assessment.landings.iter().find(|landing| landing.landing == governs).expect("a landing");
        assert_eq!(landing.limits[n].demand, limit.demand);
    }
}

/// Drops are listed by hand as well, and all of a kind by a word.
#[test]
fn a_list_of_drops_is_each_of_them() {
    let listed = on("face", "bottom").replace("\"bottom\"", "[\"bottom\", \"end-b\"]\ncorner = \"top back end-a\"");
    let landings = file(&listed).assess().expect("an assessment").landings;
    let names: Vec<String> = landings.iter().map(|landing| landing.landing.to_string()).collect();
    assert_eq!(names, ["face bottom", "face end-b", "corner top back end-a"]);
    let alone = file(&on("face", "end-b")).assess().expect("an assessment");
    let demands = alone.components.iter().flat_map(|component| &component.limits).map(|limit| limit.demand);
    let demands: Vec<_> = demands.collect();
    assert_eq!(demands, landings[1].limits.iter().map(|limit| limit.demand).collect::<Vec<_>>());
    for (key, count) in [("face", 6), ("edge", 12), ("corner", 8)] {
        assert_eq!(file(&on(key, "all")).landings.len(), count);
    }
}

/// Within 2 degrees of its bottom a box is the plate of the same masses, but for real tilt.
#[test]
fn a_box_on_its_bottom_is_a_plate() {
    let plate = HANDHELD
        .replace("standard = \"MIL-STD-810H/516.8-IV\"", "height = \"1.22 m\"\ntilt = [\"0 deg\", \"2 deg\"]")
        .replace("height = \"2 mm\"\naxis = \"x\"\n", "");
    let lying = on("face", "bottom").replace("height = \"2 mm\"\naxis = \"x\"\n", "");
    let [plate, lying] = [plate, lying].map(|text| {
        let assessment = file(&text).assess().expect("an assessment");
        assessment.components.iter().map(|component| component.limits[0].demand.expect("an answer")).collect::<Vec<_>>()
    });
    for (a, b) in plate.iter().zip(&lying) {
        // Two searches, each of which may miss 2 %, and real tilt.
        assert!((a / b - 1.0).abs() < 0.03, "{plate:?} beside {lying:?}");
    }
}

/// On its end a box that is struck once feels along its length what a lone mass does: (1 + e) v in the half-sine of four corners.
#[test]
fn a_box_that_lands_flat_on_its_end_is_one_mass() {
    let text = on("face", "end-a").replace("5 deg", "0 deg").replace("2 deg", "0 deg");
    let assessment = file(&text).assess().expect("an assessment");
    let battery = assessment.components[1].limits[0].demand.expect("an answer");
    // Slow beside the contact, it swings by (1 + e) v e^(−ζφ/tan φ)/ω, tan φ = √(1 − ζ²)/ζ.
    let (omega, zeta, v) = (TAU * 120.0, 0.1_f64, (2.0 * 9.806_65 * 1.22_f64).sqrt());
    let phase = ((1.0 - zeta * zeta).sqrt() / zeta).atan();
    let swings = 1.4 * v / omega * (-zeta * phase / (1.0 - zeta * zeta).sqrt()).exp();
    // Half of the contact counts: (ωτ)²/24 and less, below 1 %.
    assert!((battery / swings - 1.0).abs() < 0.01, "{battery}, not {swings}");
}

/// Drops anywhere in the ranges ask for no more than what is told.
#[test]
fn no_single_drop_of_a_box_is_worse() {
    let setting = |name: &str, default: u32| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(default);
    let (boxes, singles, seed) = (setting("BOXES", 4), setting("SINGLES", 120), setting("SEED", 1));
    let (mut limits, mut passed) = (0, 0);
    for n in 0..boxes {
        let mut r = Random((u64::from(seed) << 32) + u64::from(n));
        let kinds: Vec<Attitude> = [1, 2, 3].into_iter().flat_map(Attitude::all).collect();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 26")]
        let attitude = kinds[(r.unit() * 25.99) as usize];
        let name = attitude.to_string();
        let (key, faces) = name.split_once(' ').expect("two words");
        let e = r.even(0.03, 0.5) * if n % 2 == 0 { 1.0 } else { 0.3 };
        let text = on(key, faces)
            .replace("restitution = 0.4", &format!("restitution = [{e:.6}, {:.6}]", e + 0.1))
            .replace("\"0.4 ms\"", "[\"0.3 ms\", \"0.5 ms\"]")
            .replace("\"14 mm\"", &format!("\"{:.6} mm\"", r.even(10.0, 50.0)));
        let file = file(&text);
        let assessment = file.assess().expect("an assessment");
        let (width, thickness_m) =
            (file.product.width.expect("a width"), file.product.width.and_then(|w| w.thickness_m));
        let thickness_m = thickness_m.expect("a thickness");
        let landing = file.landings[0];
        let [a, b] = file.product.body.arms_m();
        let down: Vec<f64> = ["end-a end-b", "front back", "bottom top"]
            .iter()
            .zip([[a, b], width.edges_m, [0.5 * thickness_m; 2]])
            .map(|(names, sides)| {
                let (low, high) = names.split_once(' ').expect("two names");
                if faces.contains(low) {
                    -sides[0]
                } else if faces.contains(high) {
                    sides[1]
                } else {
                    0.0
                }
            })
            .collect();
        let size = down.iter().map(|x| x * x).sum::<f64>().sqrt();
        let posture = Posture { upward: [-down[0] / size, -down[1] / size, -down[2] / size], thickness_m };
        for (component, assessed) in file.components.iter().zip(&assessment.components) {
            let (limit, told) = (Limit::of(component)[0], &assessed.limits[0]);
            let shares: Vec<[f64; 5]> = (0..singles).map(|_| std::array::from_fn(|_| r.unit())).collect();
            let single = |x: &[f64; 5]| {
                let drop = SingleDrop {
                    body: file.product.body,
                    across: Some(Across { width, direction_rad: TAU * x[0], posture: Some(posture) }),
                    first: clatter::End::A,
                    tilt_rad: landing.tolerance_rad * x[1].sqrt(),
                    flat: false,
                    speed_m_s: file.drop.speeds_m_s()[1],
                    restitution: file.product.restitution.at(if x[2] < 0.5 { 1.0 } else { x[4] }),
                    gravity_m_s2: file.drop.gravity_m_s2,
                    contact_time_s: file.product.contact_time_s.map(|time| time.at(x[3])),
                    contact_law: file.product.law(),
                };
                let places = component.ends_m();
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    clippy::cast_precision_loss,
                    reason = "few"
                )]
                let [position_m, across_m] = places[(x[4] * places.len() as f64) as usize % places.len()];
                let suspension = match component.mount {
                    Mount::Suspended { frequency_hz, damping } => {
                        let ratio = DampingRatio::new(damping.ratios()[0]).expect("a ratio");
                        Some(Suspension::from_hz(frequency_hz.lo(), ratio).expect("a part"))
                    }
                    Mount::Hard => None,
                };
                let part = Part { across_m, inside: component.inside, ..Part::new(position_m, suspension) };
                answer(&drop, &part, &limit, Model::Compliant, 0.02).map_or(0.0, |answer| answer.utilization())
            };
            let most = shares.par_iter().map(single).reduce(|| 0.0, f64::max);
            let over = most / (told.demand.expect("an answer") / told.allowed) - 1.0;
            println!("{name}, {}: {over:.3} over, told {:.3}", component.name, told.uncertainty);
            assert!(over <= told.uncertainty, "{name}, {}: {over} over, told {}", component.name, told.uncertainty);
            limits += 1;
            passed += usize::from(over > 0.02);
        }
    }
    assert!(passed * 4 <= limits, "{passed} of {limits} passed by more than 2 %");
}

#[test]
fn what_allows_far_more_is_safe() {
    let text = on("face", "bottom").replace("5000 gn", "30000 gn").replace("9 mm\"", "60 mm\"");
    let assessment = file(&text).assess().expect("an assessment");
    assert_eq!(assessment.verdict, Verdict::Safe, "{assessment:?}");
    let notes = assessment.components.iter().flat_map(|component| &component.limits[0].notes);
    assert!(notes.into_iter().all(|note| !matches!(note, Note::Tilt { .. })), "a box is at real tilt");
}

#[test]
fn faults_of_boxes_are_told() {
    let face = on("face", "bottom");
    let cases = [
        (face.replace("thickness = \"14 mm\"\n", ""), "is that of a box"),
        (face.replace("\"bottom\"", "\"underside\""), "`face` cannot be \"underside\""),
        (face.replace("face = \"bottom\"", "edge = \"bottom top\""), "`edge` cannot be \"bottom top\""),
        (face.replace("face = \"bottom\"", "edge = \"bottom\""), "expected two faces that meet"),
        (face.replace("\"bottom\"", "[\"top\", \"under\"]"), "`face` cannot be \"under\""),
        (face.replace("\"bottom\"", "[\"top\", 2]"), "expected text in quotes, or a list of it"),
        (face.replace("\"bottom\"", "[]"), "expected text in quotes, or a list of it"),
        (face.replace("\"bottom\"", &format!("[{}]", "\"top\",".repeat(101))), "[drop] has 101 drops"),
        (face.replace("face = \"bottom\"", "tilt = \"1 deg\"\nface = \"bottom\""), "more than one of `tilt`, `face`"),
        (face.replace("face = \"bottom\"\nattitude_tolerance = \"2 deg\"", ""), "[drop] has no `tilt`"),
        (HANDHELD.replace("MIL-STD-810H/516.8-IV", "ISTA 3A"), "the drops of \"ISTA 3A\" are not built in"),
        (HANDHELD.replace("mass = \"300 g\"\n", ""), "goes by the mass of the product"),
        (HANDHELD.replace("\"300 g\"", "\"95 kg\""), "the product has 95 kg"),
        (HANDHELD.replace("axis = \"x\"", "axis = \"any\""), "`axis` = \"any\" is not that of this part"),
        (HANDHELD.replace("516.8-IV\"", "516.8-IV\"\nheight = \"1 m\""), "more than one of `standard`, `height`"),
    ];
    for (text, told) in cases {
        let said = match ProductFile::read(&text, "box.toml") {
            Err(faults) => faults.to_string(),
            Ok(_) => panic!("not refused: {told}"),
        };
        assert!(said.contains(told), "{said}");
    }
}
