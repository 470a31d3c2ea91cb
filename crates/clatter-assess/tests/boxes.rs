//! Boxes that land on a face, an edge or a corner, by hand or as a standard lists them.

#![expect(clippy::print_stdout, reason = "a long run tells what it found")]

use std::f64::consts::TAU;

use crate::plates::file;
use crate::random::Random;
use clatter_assess::{LimitAssessment, Note, Part, Verdict, WorstCase, answer};
use clatter_product::{
    Attitude, Axis, Body, Drop, DropName, Fall, Limit, LimitKind, Model, Mount, Place, ProductFile, Side,
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
friction = 0
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
axis = "z"
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

/// One drop alone is looked at more closely than in a list: there it asks for no more but for what a search may miss, and for no less than
/// what others may ask leaves.
fn holds(listed: Option<f64>, alone: &LimitAssessment, name: &str) {
    let (told, found) = (listed.expect("an answer"), alone.demand.expect("an answer"));
    assert!(told <= 1.1 * found && found <= told * (1.0 + alone.uncertainty), "{name}: {told} and {found}");
}

#[test]
fn a_standard_is_its_drops_one_by_one() {
    let assessment = clatter_assess::assess(&file(HANDHELD)).expect("an assessment");
    assert_eq!(assessment.landings.len(), 26);
    assert!(assessment.landings.iter().all(|landing| landing.source.is_some_and(|said| said.contains("516.8-IX"))));
    // By hand, each alone.
    for (key, faces) in [("face", "bottom"), ("edge", "front end-b"), ("corner", "top back end-a")] {
        let attitude = Attitude::on(faces).expect("an attitude");
        let listed =
            assessment.landings.iter().find(|landing| landing.landing == DropName::On(attitude)).expect("a landing");
        let alone = clatter_assess::assess(&file(&on(key, faces))).expect("an assessment");
        let limits = alone.components.iter().flat_map(|component| &component.limits);
        for (limit, listed) in limits.zip(&listed.limits) {
            holds(listed.demand, limit, faces);
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
    let landings = clatter_assess::assess(&file(&listed)).expect("an assessment").landings;
    let names: Vec<String> = landings.iter().map(|landing| landing.landing.to_string()).collect();
    assert_eq!(names, ["face bottom", "face end-b", "corner top back end-a"]);
    let alone = clatter_assess::assess(&file(&on("face", "end-b"))).expect("an assessment");
    let limits = alone.components.iter().flat_map(|component| &component.limits);
    limits.zip(&landings[1].limits).for_each(|(alone, listed)| holds(listed.demand, alone, "face end-b"));
    for (key, count) in [("face", 6), ("edge", 12), ("corner", 8)] {
        assert_eq!(file(&on(key, "all")).landings.len(), count);
    }
}

/// Each drop with a height of its own: a corner from 2 m, a face at 1 m/s, and a tilt by hand, which at a right angle is the face there.
#[test]
fn drops_of_a_file_have_their_own_heights() {
    let of = |drops: &str| {
        HANDHELD.replace("[drop]\nstandard = \"MIL-STD-810H/516.8-IV\"\n", drops).replace("0.4\n", "0.25\n")
    };
    let corner = "[[drop]]\nheight = \"2 m\"\ncorner = \"top back end-a\"\n";
    let slow = "[[drop]]\nspeed = \"1 m/s\"\nface = \"end-a\"\n";
    let tilted =
        "[[drop]]\nheight = \"1.22 m\"\ntilt = \"90 deg\"\ndirection = \"0 deg\"\nattitude_tolerance = \"2 deg\"\n";
    let demands = |text: &str| {
        let assessment = clatter_assess::assess(&file(text)).expect("an assessment");
        let of = |limits: &[clatter_assess::LandingLimit]| limits.iter().map(|l| l.demand).collect::<Vec<_>>();
        assessment.landings.iter().map(|landing| (landing.landing.to_string(), of(&landing.limits))).collect::<Vec<_>>()
    };
    let all = demands(&of(&format!("{corner}{slow}{tilted}")));
    for (drop, listed) in [corner, slow, tilted].into_iter().zip(&all) {
        let alone = clatter_assess::assess(&file(&of(drop))).expect("an assessment");
        assert_eq!(alone.landings[0].landing.to_string(), listed.0);
        let limits = alone.components.iter().flat_map(|component| &component.limits);
        limits.zip(&listed.1).for_each(|(alone, listed)| holds(*listed, alone, drop));
    }
    assert_eq!(all[2].0, "tilt 90 deg towards 0 deg");
    let [standing, tilted] = [on("face", "end-a").replace("0.4\n", "0.25\n"), of(tilted)].map(|text| demands(&text));
    assert_eq!((&tilted[0].1, standing.len()), (&standing[0].1, 1));
    // The same from another height is another drop.
    let twice = file(&of(&format!("{corner}{}", corner.replace("2 m", "1 m"))));
    let governs = clatter_assess::assess(&twice).expect("an assessment").components[0].limits[0].demand;
    assert_eq!(governs, all[0].1[0]);
}

/// On its bottom, 45° towards the front: the edge there lands, and shakes what moves upward and outward alike.
#[test]
fn a_tilted_box_lands_on_what_is_lowest() {
    let drop = "height = \"1.22 m\"\ntilt = \"45 deg\"\ndirection = \"90 deg\"\nattitude_tolerance = \"0 deg\"\n";
    let text = HANDHELD.replace("standard = \"MIL-STD-810H/516.8-IV\"\n", drop);
    let part = "position = [\"0 mm\", \"0 mm\"]\nmount = \"hard\"\nvelocity_change_limit = \"99 m/s\"\n";
    let parts =
        ["y", "z"].map(|axis| format!("\n[[component]]\nname = \"{axis}\"\naxis = \"{axis}\"\n{part}")).concat();
    let assessment = clatter_assess::assess(&file(&format!("{text}{parts}"))).expect("an assessment");
    let [y, z] = [2, 3].map(|n: usize| assessment.components[n].limits[0].demand.expect("an answer"));
    // The edge alone turns the box about the length, ρ² = 20² + 14²/12 mm²: its arm is (35 − 7)/√2 mm, its share 1/(1 + arm²/ρ²).
    let v = (2.0 * 9.806_65 * 1.22_f64).sqrt();
    let struck = 1.4 * v / (1.0 + (28.0_f64.powi(2) / 2.0) / (20.0_f64.powi(2) + 14.0_f64.powi(2) / 12.0));
    for felt in [y, z] {
        // Later landings may ask for more.
        assert!(felt > 0.97 * struck / 2.0_f64.sqrt(), "{felt} beside {struck}");
    }
}

/// A box comes down on any side: what is mounted rigidly in it is struck along the blow, what swings does so along the thickness.
#[test]
fn parts_are_struck_along_the_blow_unless_an_axis_is_named() {
    let text = on("face", "end-a").replace("axis = \"z\"\n", "").replace("axis = \"x\"\n", "");
    let axes = |text: &str| file(text).components.iter().map(|component| component.inside.axis).collect::<Vec<_>>();
    assert_eq!(axes(&text), [Axis::Any, Axis::Z]);
    let plate = "tilt = [\"0 deg\", \"2 deg\"]";
    let plate = text.replace("face = \"end-a\"\nattitude_tolerance = \"2 deg\"", plate).replace("friction = 0\n", "");
    assert_eq!(axes(&plate.replace("height = \"2 mm\"\n", "")), [Axis::Z; 2]);
    let display = |axis: &str| {
        let text = text.replace("mount = \"hard\"", &format!("{axis}mount = \"hard\""));
        let limit = clatter_assess::assess(&file(&text)).expect("an assessment").components[0].limits[0].clone();
        let worst = limit.worst_case.expect("a drop");
        (limit.demand.expect("an answer"), worst.axis())
    };
    let [blow, any, x, z] = ["", "axis = \"any\"\n", "axis = \"x\"\n", "axis = \"z\"\n"].map(display);
    assert_eq!(blow, any);
    assert_eq!([any.1, x.1, z.1], [Some(Axis::Any), Some(Axis::X), Some(Axis::Z)]);
    // It stands on its end: the blow is along its length, and hardly any of it along its thickness.
    assert!(blow.0 >= x.0 * 0.999 && z.0 < 0.5 * x.0, "{blow:?}, {x:?}, {z:?}");
}

/// Within 2 degrees of its bottom a box is the plate of the same masses, but for real tilt; also where these lie askew.
#[test]
fn a_box_on_its_bottom_is_a_plate() {
    let given = "mass = \"300 g\"\nradius_of_gyration = [\"43 mm\", \"20 mm\"]";
    let masses = r#"masses = [
    { mass = "200 g", from = ["-75 mm", "-35 mm"], to = ["75 mm", "35 mm"] },
    { mass = "60 g", position = ["45 mm", "20 mm"] },
    { mass = "40 g", position = ["-45 mm", "-15 mm"] },
]"#;
    for text in [HANDHELD, &HANDHELD.replace(given, masses)] {
        let on_bottom = "height = \"1.22 m\"\nface = \"bottom\"\nattitude_tolerance = \"2 deg\"";
        let slides = text.replace("friction = 0\n", "");
        let of_plate = "height = \"1.22 m\"\ntilt = [\"0 deg\", \"2 deg\"]";
        let [plate, lying] = [(slides.as_str(), of_plate), (text, on_bottom)].map(|(text, drop)| {
            let text = text.replace("standard = \"MIL-STD-810H/516.8-IV\"", drop);
            let assessment = clatter_assess::assess(&file(&text.replace("height = \"2 mm\"\naxis = \"x\"\n", "")))
                .expect("an assessment");
            let limits = assessment.components.iter().map(|component| &component.limits[0]);
            limits.map(|limit| limit.demand.expect("an answer")).collect::<Vec<_>>()
        });
        for (a, b) in plate.iter().zip(&lying) {
            // Two searches, each of which may miss 2 %, and real tilt.
            assert!((a / b - 1.0).abs() < 0.03, "{plate:?} beside {lying:?}");
        }
    }
}

/// Masses at heights of their own: center of mass, radius of gyration along the thickness and products of inertia by hand; the others are
/// spread evenly over it. Upside down is the mirror image.
#[test]
fn masses_have_heights_in_a_box() {
    let given = "mass = \"300 g\"\nradius_of_gyration = [\"43 mm\", \"20 mm\"]";
    let masses = r#"masses = [
    { mass = "200 g", from = ["-75 mm", "-35 mm"], to = ["75 mm", "35 mm"] },
    { mass = "60 g", position = ["40 mm", "20 mm"], height = "-5 mm" },
    { mass = "40 g", position = ["-45 mm", "0 mm"], height = "3 mm" },
]"#;
    let text = on("face", "bottom").replace(given, masses);
    let (t, x, z) = (14e-3_f64, (0.06 * 0.04 - 0.04 * 0.045) / 0.3, (0.04 * 0.003 - 0.06 * 0.005) / 0.3);
    let y = 0.06 * 0.02 / 0.3;
    let body = file(&text).product.body;
    let thickness = body.thickness.expect("a thickness");
    let zz = (0.2 * t * t / 12.0 + 0.06 * 25e-6 + 0.04 * 9e-6) / 0.3 - z * z;
    let [xz, yz] = [-0.06 * 0.04 * 0.005 - 0.04 * 0.045 * 0.003, -0.06 * 0.02 * 0.005];
    let found = [thickness.center_m(), thickness.gyration_m, body.products_m2[1], body.products_m2[2]];
    for (found, want) in found.into_iter().zip([z, zz.sqrt(), xz / 0.3 - x * z, yz / 0.3 - y * z]) {
        assert!((found / want - 1.0).abs() < 1e-9, "{found}, not {want}");
    }
    let demands = |text: &str| {
        let assessment = clatter_assess::assess(&file(text)).expect("an assessment");
        let limits = assessment.components.iter().map(|component| &component.limits[0]);
        limits.map(|limit| limit.demand.expect("an answer")).collect::<Vec<_>>()
    };
    // A place below the middle, or a tenth of a millimeter from it, is none that is likely a slip.
    let near = text.replace("height = \"3 mm\"", "height = \"0.1 mm\"");
    assert!(ProductFile::read_warned(&near, "box.toml").expect("a product").1.warnings().is_empty());
    // One drop each: searches of a range of attitudes would differ by what they miss.
    for (key, down, mirrored) in [("face", "bottom", "top"), ("edge", "bottom end-a", "top end-a")] {
        let drop = on(key, down).replace("2 deg", "0 deg").replace("5 deg", "0 deg").replace(given, masses);
        let turned = drop.replace(down, mirrored).replace("\"-5 mm\"", "\"5 mm\"").replace("\"3 mm\"", "\"-3 mm\"");
        let turned = turned.replace("height = \"2 mm\"", "height = \"-2 mm\"");
        for (own, other) in demands(&drop).into_iter().zip(demands(&turned)) {
            assert!((own / other - 1.0).abs() < 1e-6, "{own} beside {other}");
        }
    }
    let high = text.replace("\"-5 mm\"", "\"8 mm\"");
    let said = ProductFile::read(&high, "box.toml").unwrap_err().to_string();
    assert!(said.contains("the mass reaches 8 mm from the middle along the thickness"), "{said}");
    let said = ProductFile::read(&text.replace("thickness = \"14 mm\"\n", ""), "box.toml").unwrap_err().to_string();
    assert!(said.contains("in a product with a thickness alone"), "{said}");
    // All of it in a skin on top: no box stands on its center of mass.
    let skin = text.replace("[\"75 mm\", \"35 mm\"] }", "[\"75 mm\", \"35 mm\"], height = \"7 mm\" }");
    let skin = skin.replace("\"-5 mm\"", "\"7 mm\"").replace("\"3 mm\"", "\"7 mm\"");
    let said = ProductFile::read(&skin, "box.toml").unwrap_err().to_string();
    assert!(said.contains("the center of mass is 7 mm from the middle of a thickness of 14 mm"), "{said}");
}

/// On its end a box that is struck once feels along its length what a lone mass does: (1 + e) v in the half-sine of four corners.
#[test]
fn a_box_that_lands_flat_on_its_end_is_one_mass() {
    let text = on("face", "end-a").replace("5 deg", "0 deg").replace("2 deg", "0 deg");
    let assessment = clatter_assess::assess(&file(&text)).expect("an assessment");
    let battery = assessment.components[1].limits[0].demand.expect("an answer");
    // Slow beside the contact, it swings by (1 + e) v e^(−ζφ/tan φ)/ω, tan φ = √(1 − ζ²)/ζ.
    let (omega, zeta, v) = (TAU * 120.0, 0.1_f64, (2.0 * 9.806_65 * 1.22_f64).sqrt());
    let phase = ((1.0 - zeta * zeta).sqrt() / zeta).atan();
    let swings = 1.4 * v / omega * (-zeta * phase / (1.0 - zeta * zeta).sqrt()).exp();
    // Half of the contact counts: (ωτ)²/24 and less, below 1 %.
    assert!((battery / swings - 1.0).abs() < 0.01, "{battery}, not {swings}");
}

/// Single drops of the ranges of a file, this vertical turned off by no more than its tolerance: how many limits there are, and how many of
/// them are exceeded by 2 %.
fn hunted(file: &ProductFile, base: [f64; 3], name: &str, singles: u32, r: &mut Random) -> [u32; 2] {
    let assessment = clatter_assess::assess(file).expect("an assessment");
    let landing = file.landings[0];
    let (mut limits, mut passed) = (0, 0);
    for (component, assessed) in file.components.iter().zip(&assessment.components) {
        let (limit, told) = (Limit::of(component)[0], &assessed.limits[0]);
        let shares: Vec<[f64; 5]> = (0..singles).map(|_| std::array::from_fn(|_| r.unit())).collect();
        let single = |x: &[f64; 5]| {
            let drop = Drop {
                is_level: false,
                base,
                direction_rad: TAU * x[0],
                gravity_m_s2: file.drop.gravity_m_s2,
                contact_time_s: file.product.contact_time_s.map(|time| time.at(x[3])),
                contact_law: file.product.law(),
                ..Drop::new(
                    file.product.body,
                    file.drop.speeds_m_s()[1],
                    landing.tolerance_rad() * x[1].sqrt(),
                    file.product.restitution.at(if x[2] < 0.5 { 1.0 } else { x[4] }),
                )
            };
            let places = component.ends_m();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                clippy::cast_precision_loss,
                reason = "few"
            )]
            let at_m = places[(x[4] * places.len() as f64) as usize % places.len()];
            let suspension = match component.mount {
                Mount::Suspended { frequency_hz, damping } => {
                    let ratio = DampingRatio::new(damping.ratios()[0]).expect("a ratio");
                    Some(Suspension::from_hz(frequency_hz.lo(), ratio).expect("a part"))
                }
                Mount::Hard => None,
            };
            let part = Part::at(component.inside.place(at_m), suspension);
            answer(&drop, &part, &limit, Model::Compliant, 0.02).map_or(0.0, |answer| answer.utilization())
        };
        let most = shares.par_iter().map(single).reduce(|| 0.0, f64::max);
        let over = most / (told.demand.expect("an answer") / told.allowed) - 1.0;
        println!("{name}, {}: {over:.3} over, told {:.3}", component.name, told.uncertainty);
        assert!(over <= told.uncertainty, "{name}, {}: {over} over, told {}", component.name, told.uncertainty);
        limits += 1;
        passed += u32::from(over > 0.02);
    }
    [limits, passed]
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
        let down: Vec<f64> = ["end-a end-b", "front back", "bottom top"]
            .iter()
            .zip(file.product.body.faces_m().expect("a box"))
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
        let base = [-down[0] / size, -down[1] / size, -down[2] / size];
        let [of_one, passed_of_one] = hunted(&file, base, &name, singles, &mut r);
        (limits, passed) = (limits + of_one, passed + passed_of_one);
    }
    assert!(passed * 4 <= limits, "{passed} of {limits} passed by more than 2 %");
}

/// A box that loses much lands on its end, stands, and topples: the slap of its broad face is what a part near the other end is asked for.
#[test]
fn a_box_that_stands_topples() {
    let text = on("face", "end-b")
        .replace("restitution = 0.4", "restitution = 0.12")
        .replace("position = [\"10 mm\", \"5 mm\"]", "position = [\"-60 mm\", \"5 mm\"]");
    let file = file(&text);
    let display = clatter_assess::assess(&file).expect("an assessment").components.remove(0);
    let limit = &display.limits[0];
    let (demand, worst) = (limit.demand.expect("an answer"), limit.worst_case.expect("a drop"));
    // Falling takes it some √(L/g), 0.1 s.
    assert!(worst.time_s > 0.1, "{worst:?}");
    let mut r = Random(7);
    let part = Part::at(file.components[0].inside.place(worst.part.place.plan_m()), worst.part.suspension);
    let turned: Vec<[f64; 2]> = (0..64).map(|_| [r.unit(), r.unit()]).collect();
    let asked = |[turn, tilt]: &[f64; 2]| {
        let tilt_rad = file.landings[0].tolerance_rad() * tilt.sqrt();
        let drop = Drop { base: [-1.0, 0.0, 0.0], direction_rad: TAU * turn, tilt_rad, ..worst.drop };
        answer(&drop, &part, &Limit::of(&file.components[0])[0], Model::Compliant, 0.02).expect("an answer").value
    };
    let most = turned.par_iter().map(asked).reduce(|| 0.0, f64::max);
    // Sensitive to every input: sixty drops of it spread by as much.
    assert!((0.6..1.1).contains(&(most / demand)), "{most} of {demand}");
}

/// The same of boxes that are tilted by hand, also where their tolerance holds a face or an edge.
#[test]
fn no_single_drop_of_a_tilted_box_is_worse() {
    let setting = |name: &str, default: u32| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(default);
    let (boxes, singles, seed) = (setting("BOXES", 4), setting("SINGLES", 120), setting("SEED", 1));
    let mut limits = 0;
    for n in 0..boxes {
        let mut r = Random((u64::from(seed) << 32) + 1000 + u64::from(n));
        let near = |r: &mut Random, at: f64| (at + r.even(-4.0, 4.0)).abs();
        let tilt = if n % 4 == 0 { near(&mut r, 0.0) } else { r.even(1.0, 89.0) };
        let direction = if n % 4 == 1 { near(&mut r, 90.0) } else { r.even(0.0, 360.0) };
        let tolerance = r.even(2.0, 5.0);
        let e = r.even(0.03, 0.4);
        let drop = format!(
            "height = \"1.22 m\"\ntilt = \"{tilt} deg\"\ndirection = \"{direction} deg\"\nattitude_tolerance = \"{tolerance} deg\""
        );
        let text = HANDHELD
            .replace("standard = \"MIL-STD-810H/516.8-IV\"", &drop)
            .replace("restitution = 0.4", &format!("restitution = [{e:.6}, {:.6}]", e + 0.1))
            .replace("\"14 mm\"", &format!("\"{:.6} mm\"", r.even(10.0, 50.0)));
        let file = file(&text);
        let ((sin, cos), (across, along)) = (tilt.to_radians().sin_cos(), direction.to_radians().sin_cos());
        let name = format!("tilt {tilt:.2} to {direction:.2} within {tolerance:.2}");
        let [of_one, _] = hunted(&file, [sin * along, sin * across, cos], &name, singles, &mut r);
        limits += of_one;
    }
    assert_eq!(limits, 2 * boxes);
}

#[test]
fn what_allows_far_more_is_safe() {
    let text = on("face", "bottom").replace("5000 gn", "30000 gn").replace("9 mm\"", "60 mm\"");
    let assessment = clatter_assess::assess(&file(&text)).expect("an assessment");
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
        (
            face.replace("\"bottom\"", &format!("[{}]", "\"top\",".repeat(101))),
            "two drops are the same: face top, from as high",
        ),
        (face.replace("face = \"bottom\"", "tilt = \"1 deg\""), "[drop] has no `direction`"),
        (
            face.replace("face = \"bottom\"", "tilt = [\"1 deg\", \"50 deg\"]\ndirection = \"0 deg\""),
            "a box lands at one tilt to one direction",
        ),
        (
            face.replace("face = \"bottom\"\nattitude_tolerance = \"2 deg\"", "tilt = \"50 deg\""),
            "`tilt` = 50 deg is out of its range",
        ),
        (
            face.replace("face = \"bottom\"", "face = \"bottom\"\ndirection = \"9 deg\""),
            "`direction` is that of a `tilt`",
        ),
        (face.replace("face = \"bottom\"\n", ""), "none of `face`, `edge`, `corner`, `tilt`, `standard`"),
        (
            face.replace("[drop]\n", "[[drop]]\nheight = \"1 m\"\nface = \"top\"\ngravity = \"0.5 gn\"\n[[drop]]\n"),
            "gravity differs from drop to drop",
        ),
        (face.replace("face = \"bottom\"", "tilt = \"1 deg\"\nface = \"bottom\""), "more than one of `tilt`, `face`"),
        (face.replace("face = \"bottom\"\nattitude_tolerance = \"2 deg\"", ""), "[drop] has no `tilt`"),
        (HANDHELD.replace("MIL-STD-810H/516.8-IV", "ISTA 3A"), "the drops of \"ISTA 3A\" are not built in"),
        (HANDHELD.replace("mass = \"300 g\"\n", ""), "goes by the mass of the product"),
        (HANDHELD.replace("\"300 g\"", "\"95 kg\""), "the product has 95 kg"),
        (HANDHELD.replace("axis = \"x\"", "axis = \"any\""), "`axis` = \"any\" is not that of this part"),
        (HANDHELD.replace("516.8-IV\"", "516.8-IV\"\nheight = \"1 m\""), "more than one of `standard`, `height`"),
    ];
    // One fault is told once.
    let twice = HANDHELD.replace("516.8-IV\"", "516.8-IV\"\ntilt = \"1 deg\"");
    let said = ProductFile::read(&twice, "box.toml").unwrap_err().to_string();
    assert_eq!(said.matches("more than one of").count(), 1, "{said}");
    for (text, told) in cases {
        let said = match ProductFile::read(&text, "box.toml") {
            Err(faults) => faults.to_string(),
            Ok(_) => panic!("not refused: {told}"),
        };
        assert!(said.contains(told), "{said}");
    }
}

/// A standard goes by the largest side, whichever it is: 91 cm and longer falls from 76 cm.
#[test]
fn a_standard_goes_by_the_largest_side() {
    let sides = ["length = \"150 mm\"", "width = \"70 mm\"", "thickness = \"14 mm\""];
    for (side, height_m) in [(None, 1.22), (Some(0), 0.76), (Some(1), 0.76), (Some(2), 0.76)] {
        let large = sides.iter().enumerate().fold(HANDHELD.to_owned(), |text, (n, said)| {
            let (name, _) = said.split_once(' ').expect("a name");
            text.replace(said, &format!("{name} = \"{} mm\"", if side == Some(n) { 950 } else { 900 }))
        });
        let large = large.replace("[\"43 mm\", \"20 mm\"]", "[\"260 mm\", \"260 mm\"]");
        let landing = file(&large).landings[0];
        let Fall::HeightM(height) = landing.drop.fall else { panic!("{landing:?}") };
        assert!((height.lo() - height_m).abs() < 1e-12, "{side:?}: {landing:?}");
    }
}

/// A single drop of a box, turned off lying on its bottom.
fn one([length, width, thickness]: [f64; 3], [kx, ky]: [f64; 2], center: [f64; 2], base: [f64; 3]) -> Drop {
    let bar = Body::off_center(0.5 * length + center[0], 0.5 * length - center[0], kx).expect("a body");
    let width = Side { ends_m: [0.5 * width + center[1], 0.5 * width - center[1]], gyration_m: ky };
    let body = bar.with_width(width).with_thickness(Side::even(thickness));
    Drop { is_level: false, base, contact_time_s: Some(1e-4), ..Drop::new(body, 3.0, 0.0, 0.3) }
}

fn asked(drop: &Drop, at_m: [f64; 3], axis: Axis, kind: LimitKind) -> f64 {
    answer(drop, &Part::at(Place { at_m, axis }, None), &Limit::new(kind, 1.0), Model::Compliant, 0.01)
        .expect("an answer")
        .value
}

/// Off center and hardly tilted, a thin box does what a plate does, in every direction.
#[test]
fn a_drop_of_a_thin_box_is_that_of_a_plate() {
    for turn in [0.06, 0.31, 0.56, 0.81] {
        let mut lying = one([0.15, 0.07, 0.004], [0.043, 0.02], [0.008, -0.006], [0.0, 0.0, 1.0]);
        (lying.tilt_rad, lying.direction_rad) = (0.02, TAU * turn);
        let plate = Drop { is_level: true, ..lying };
        for kind in [LimitKind::Acceleration, LimitKind::VelocityChange, LimitKind::AngularVelocityChange] {
            let [one, other] = [&lying, &plate].map(|drop| asked(drop, [0.03, -0.02, 0.0], Axis::Z, kind));
            // One of the axes about which turns are looked at is within 3 % of any; thickness and tilt do some thousandths.
            let off = if kind == LimitKind::AngularVelocityChange { 0.04 } else { 0.02 };
            assert!((one / other - 1.0).abs() < off, "{kind:?}, {turn} of a turn: {one} and {other}");
        }
    }
}

/// The mirror image of a plate whose masses lie askew has its product of inertia with the other sign.
#[test]
fn a_mirrored_plate_does_the_same() {
    let drop = |side: f64, turn: f64| {
        let mut lying = one([0.15, 0.07, 0.004], [0.043, 0.02], [side * 0.008, -0.006], [0.0, 0.0, 1.0]);
        lying.body.products_m2[0] = side * 4e-4;
        let direction_rad = if side > 0.0 { TAU * turn } else { TAU * (0.5 - turn) };
        Drop { is_level: true, direction_rad, tilt_rad: 0.02, ..lying }
    };
    for turn in [0.06, 0.31, 0.56, 0.81] {
        for kind in [LimitKind::Acceleration, LimitKind::VelocityChange, LimitKind::AngularVelocityChange] {
            let [one, other] =
                [1.0, -1.0].map(|side| asked(&drop(side, turn), [side * 0.03, -0.02, 0.0], Axis::Z, kind));
            // Turns are looked at along sixteen directions, among which those of the mirror image are.
            assert!((one / other - 1.0).abs() < 1e-6, "{kind:?}, {turn} of a turn: {one} and {other}");
        }
    }
}

/// A cube on its corner under the center of mass does not turn: the force is along its diagonal, a third of its square along each side.
#[test]
fn along_any_axis_is_the_whole_of_it() {
    let third = 1.0 / 3.0_f64.sqrt();
    let side = 0.06 / 12.0_f64.sqrt();
    let cube = one([0.06; 3], [side; 2], [0.0; 2], [third; 3]);
    let along = |axis| asked(&cube, [0.0; 3], axis, LimitKind::Acceleration);
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        assert!((along(Axis::Any) * third / along(axis) - 1.0).abs() < 1e-6, "{axis:?}: {}", along(axis));
    }
}

/// A steep box lands on the edge of its end a: the blow J = (1 + e) v/μ along the vertical n changes the velocity at a height h over the
/// center, along the length, by J (n_x + h α), α = (r × n)_y/k_y² with r to the edge and μ = 1 + α (r × n)_y.
#[test]
fn a_blow_on_an_edge_is_felt_by_the_height() {
    let steep = [1.0_f64.sin(), 0.0, 1.0_f64.cos()];
    let drop = one([0.15, 0.07, 0.05], [0.043, 0.02], [0.0; 2], steep);
    let arm = 0.075 * steep[2] - 0.025 * steep[0];
    let turned = arm / (0.043_f64.powi(2) + 0.05_f64.powi(2) / 12.0);
    let blow = 1.3 * 3.0 / (1.0 + turned * arm);
    for height in [-0.02, 0.0, 0.02] {
        let felt = asked(&drop, [0.0, 0.0, height], Axis::X, LimitKind::VelocityChange);
        let told = blow * (steep[0] + height * turned);
        // It turns by 3 mrad during the blow.
        assert!((felt / told - 1.0).abs() < 0.01, "at {height}: {felt}, not {told}");
    }
}

const BOARD: &str = r#"
[[component]]
name = "board"
position = ["60 mm", "30 mm"]
axis = "z"
mount = "hard"
velocity_change_limit = "30 m/s"
angular_velocity_change_limit = "900 rad/s"
"#;

fn boards(text: &str) -> Vec<f64> {
    let (product, _) = text.split_once("[[component]]").expect("components");
    let assessment = clatter_assess::assess(&file(&format!("{product}{BOARD}"))).expect("an assessment");
    assessment.components[0].limits.iter().map(|limit| limit.demand.expect("an answer")).collect()
}

/// What the search of a box may miss: drops of a symmetric one are those of its mirror image, and a range holds its ends.
#[test]
fn a_box_is_searched_on_all_sides_and_over_all_ranges() {
    let text = on("face", "bottom").replace("\"2 deg\"", "\"5 deg\"");
    let own = boards(&text);
    // The part of the mirror image lies in front, and the box as it was.
    let mirrored = BOARD.replace("\"30 mm\"]", "\"-30 mm\"]");
    let (product, _) = text.split_once("[[component]]").expect("components");
    let other = clatter_assess::assess(&file(&format!("{product}{mirrored}"))).expect("an assessment");
    for (limit, own) in other.components[0].limits.iter().zip(&own) {
        assert!((limit.demand.expect("an answer") / own - 1.0).abs() < 0.05, "{limit:?} beside {own}");
    }
    let [short, long] = ["0.2 ms", "0.8 ms"].map(|time| boards(&text.replace("0.4 ms", time)));
    let slow = boards(&text.replace("1.22 m", "0.2 m").replace("0.4 ms", "0.2 ms"));
    let all = boards(
        &text.replace("\"1.22 m\"", "[\"0.2 m\", \"1.22 m\"]").replace("\"0.4 ms\"", "[\"0.2 ms\", \"0.8 ms\"]"),
    );
    for (n, all) in all.iter().enumerate() {
        let most = short[n].max(long[n]).max(slow[n]);
        assert!(*all > most / 1.05, "{all} of {most}: {short:?}, {long:?}, {slow:?}");
    }
}

/// A box that hardly loses energy asks for less as it lands again than at first, and a limit with room of 50 % is safe. What the search may
/// miss is told of all.
#[test]
fn rebounds_of_a_box_leave_limits_safe() {
    let text = on("face", "bottom").replace("5000 gn", "30000 gn");
    let (text, _) = text.split_once("[[component]]\nname = \"battery\"").expect("a second part");
    let display =
        |text: &str| clatter_assess::assess(&file(text)).expect("an assessment").components[0].limits[0].clone();
    for e in ["0.1", "0.85"] {
        let text = text.replace("restitution = 0.4", &format!("restitution = {e}"));
        let told = display(&text);
        assert!(told.uncertainty >= 0.1, "{told:?}");
        let allowed = 1.5 * told.demand.expect("an answer") / 9.806_65;
        let limit = display(&text.replace("30000 gn", &format!("{allowed} gn")));
        assert_eq!(limit.verdict, Verdict::Safe, "e = {e}: {limit:?}");
    }
}

/// Beyond its long edges a product has no place for a part.
#[test]
fn a_part_lies_within_the_width() {
    let drop = one([0.15, 0.07, 0.014], [0.043, 0.02], [0.0, 0.0], [0.0, 0.0, 1.0]);
    for (across_m, is_there) in [(0.035, true), (-0.035, true), (0.036, false), (-0.05, false)] {
        let part = Part::at(Place::flat([0.0, across_m]), None);
        let found = answer(&drop, &part, &Limit::new(LimitKind::VelocityChange, 1.0), Model::Compliant, 0.01);
        assert_eq!(found.is_ok(), is_there, "{across_m}: {found:?}");
    }
}

/// Where it rises to is told from 0 to 360 degrees, whichever way round it was followed.
#[test]
fn directions_are_told_as_compasses_have_them() {
    let drop = one([0.15, 0.07, 0.014], [0.043, 0.02], [0.0, 0.0], [0.0, 0.0, 1.0]);
    for (turn, told) in [(-0.25, 270.0), (0.25, 90.0), (1.125, 45.0), (0.0, 0.0)] {
        let worst = WorstCase {
            drawn: false,
            drop: Drop { direction_rad: TAU * turn, ..drop },
            part: Part::new(0.0, None),
            landing: None,
            listed: 0,
            gyration_varies: false,
            impact: 1,
            time_s: 0.0,
            model: Model::Compliant,
            tolerance: 0.01,
        };
        let degrees = worst.direction_deg().expect("it has a width");
        assert!((degrees - told).abs() < 1e-9, "{turn} of a turn: {degrees}, not {told}");
    }
}

/// A box that lands on a narrow face, topples over its edge and slaps down on a broad one, as a brute force found it: what is told covers
/// that second landing.
#[test]
fn a_box_that_slaps_down_as_it_topples_is_covered() {
    let text = r#"
product = { name = "box", length = "102 mm", width = "96.7 mm", thickness = "17.9 mm", radius_of_gyration = ["31.9 mm", "21.9 mm"], center_of_mass = ["-6 mm", "-2.17 mm"], restitution = [0.227, 0.289], contact_time = "0.373 ms", contact_law = "hysteretic", friction = 0 }
drop = [{ height = "0.58 m", face = "back", attitude_tolerance = "2.42 deg" }]
component = [{ name = "part", position = ["10.1 mm", "-28.7 mm"], height = "5.64 mm", axis = "z", mount = "hard", acceleration_limit = "9e6 gn", velocity_change_limit = "900 m/s" }]
"#;
    let file = ProductFile::read(text, "box.toml").unwrap_or_else(|faults| panic!("{faults}"));
    let limits = clatter_assess::assess(&file).unwrap().components.remove(0).limits;
    // m/s² and m/s of a drop that is turned by 2.42 degrees towards its top.
    for (limit, found) in limits.iter().zip([12_853.8, 2.870]) {
        let told = limit.demand.unwrap() * (1.0 + limit.uncertainty);
        assert!(told >= found && told < 1.6 * found, "{told} for {found}: {limit:?}");
    }
}

/// A box lands on its end, turns a little as it bounces, and slaps flat onto its front 0.28 s later. Friction, direction and tilt that bring it
/// down so are hard to meet: of 400 random drops one asks for 2632 gn and 4.09 m/s, where the first landing asks for 2014 gn and 3.40 m/s.
#[test]
fn a_box_that_topples_flat_onto_its_side_is_not_safe() {
    let text = r#"
product = { name = "box on its end", length = "191 mm", width = "64 mm", thickness = "44.7 mm", masses = [
    { mass = "1 kg", from = ["-95.5 mm", "-32 mm"], to = ["95.5 mm", "32 mm"] },
    { mass = "146 g", position = ["47 mm", "22.1 mm"] },
    { mass = "218 g", position = ["25.9 mm", "-14.6 mm"] },
], restitution = 0.398, contact_time = "0.321 ms", contact_law = "hysteretic", friction = [0, 0.958], contacts = [{ at = "b", restitution = 0.402 }] }
drop = { height = "1.05 m", face = "end-b", attitude_tolerance = "0.7 deg" }
component = [{ name = "part", position = ["-48.1 mm", "3 mm"], height = "-2.92 mm", axis = "y", mount = "hard", acceleration_limit = "2476 gn", velocity_change_limit = "3.785 m/s" }]
"#;
    let file = ProductFile::read(text, "box.toml").unwrap_or_else(|faults| panic!("{faults}"));
    let assessment = clatter_assess::assess(&file).expect("an assessment");
    for limit in &assessment.components[0].limits {
        let most = limit.demand.expect("a demand") * (1.0 + limit.uncertainty);
        let asked = if limit.limit == LimitKind::Acceleration { 2632.0 * 9.80665 } else { 4.088 };
        assert!(limit.verdict != Verdict::Safe && most >= asked, "{:?}: {most} of {asked}", limit.limit);
    }
}
