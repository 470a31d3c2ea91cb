//! Products that land on feet inside their edges.

use clatter_assess::{
    Accuracy, Assessment, Verdict, answer,
    scatter::{Sampler, Settings},
};
use clatter_product::{Limit, Model, ProductFile};

/// A laptop of 300 mm × 210 mm on four feet 30 mm and 20 mm inside its edges; without its width a bar on two.
const LAPTOP: &str = r#"
[product]
name = "laptop"
length = "300 mm"
width = "210 mm"
feet_inset = ["30 mm", "20 mm"]
feet_height = "6 mm"
radius_of_gyration = ["85 mm", "60 mm"]
center_of_mass = ["10 mm", "-5 mm"]
restitution = [0.2, 0.3]
contact_time = "1 ms"
contact_law = "hysteretic"

[drop]
height = "0.5 m"
tilt = ["1 deg", "8 deg"]

[[component]]
name = "drive"
position = ["-100 mm", "70 mm"]
natural_frequency = "90 Hz"
damping_ratio = 0.15
acceleration_limit = "900 gn"

[[component]]
name = "board"
position = ["20 mm", "0 mm"]
extent = ["60 mm", "40 mm"]
mount = "hard"
velocity_change_limit = "6 m/s"
"#;

fn bar(text: &str) -> String {
    text.replace("width = \"210 mm\"\n", "")
        .replace("[\"30 mm\", \"20 mm\"]", "\"30 mm\"")
        .replace("[\"85 mm\", \"60 mm\"]", "\"85 mm\"")
        .replace("[\"10 mm\", \"-5 mm\"]", "\"10 mm\"")
        .replace("[\"-100 mm\", \"70 mm\"]", "\"-100 mm\"")
        .replace("[\"20 mm\", \"0 mm\"]", "\"20 mm\"")
        .replace("[\"60 mm\", \"40 mm\"]", "\"60 mm\"")
}

fn read(text: &str) -> ProductFile {
    ProductFile::read(text, "laptop.toml").unwrap_or_else(|faults| panic!("{faults}"))
}

fn assess(text: &str) -> Assessment {
    clatter_assess::assess(&read(text)).expect("an assessment")
}

fn demands(assessment: &Assessment) -> Vec<f64> {
    assessment.components.iter().map(|part| part.limits[0].demand.expect("an answer")).collect()
}

/// Parts between feet so high that no edge touches feel what those of a product feel that ends at its feet, with the same inertia.
#[test]
fn feet_are_the_ends_of_a_shorter_product() {
    let plate = LAPTOP.replace("\"6 mm\"", "\"20 mm\"");
    let shorter = plate
        .replace("feet_inset = [\"30 mm\", \"20 mm\"]\nfeet_height = \"20 mm\"\n", "")
        .replace("\"300 mm\"", "\"240 mm\"")
        .replace("\"210 mm\"", "\"170 mm\"");
    let bars = [bar(&plate), bar(&shorter.replace("170 mm", "210 mm"))];
    for [on_feet, on_ends] in [[plate, shorter], bars] {
        assert!(on_feet.contains("feet_inset") && !on_ends.contains("feet"), "{on_ends}");
        let [on_feet, on_ends] = [on_feet, on_ends].map(|text| demands(&assess(&text)));
        // 300 mm less twice 30 mm is 240 mm but for roundings.
        let alike = on_feet.iter().zip(&on_ends).all(|(a, b)| (a / b - 1.0).abs() < 1e-9);
        assert!(alike, "{on_feet:?}, not {on_ends:?}");
    }
}

/// The velocity of a place changes along a straight line from foot to foot and beyond: of instant impacts the edge gets
/// ((1 − s) Δv_a + (1 + s) Δv_b)/2 at s = 150/120 of each strike.
#[test]
fn a_part_may_lie_beyond_the_feet() {
    let at_edge = bar(LAPTOP).replace("position = \"20 mm\"\nextent = \"60 mm\"", "position = \"150 mm\"");
    let assessment =
        clatter_assess::assess(&read(&at_edge.replace("contact_time = \"1 ms\"\ncontact_law = \"hysteretic\"\n", "")))
            .expect("an assessment");
    let limit = &assessment.components[1].limits[0];
    let (worst, demand) = (limit.worst_case.as_ref().unwrap(), limit.demand.unwrap());
    let [a, b] = worst.drop.body.arms_m();
    let (a, b, side) = if worst.drop.first() == clatter::End::A { (a, b, 1.0) } else { (b, a, -1.0) };
    let body = clatter_flight::Profile::off_center(a, b, worst.drop.body.gyration_m()).unwrap();
    let drop = &worst.drop;
    let scene = clatter_flight::Scene::new(
        body,
        drop.restitution,
        drop.speed_m_s,
        drop.tilt_rad.to_degrees(),
        drop.gravity_m_s2,
    );
    let motion = scene.unwrap().fly(clatter_flight::Model::FiniteTilt).unwrap();
    let s = side * 1.25;
    let beyond = |[a, b]: [f64; 2]| (0.5 * ((1.0 - s) * a + (1.0 + s) * b)).abs();
    let most = motion.strikes.iter().map(|strike| beyond(strike.delta_v_m_s)).fold(0.0, f64::max);
    assert!((demand / most - 1.0).abs() < 1e-9, "{demand}, not {most}");
    assert_eq!(worst.model, Model::FiniteTilt);
}

/// Landing flat both feet of a centered bar sink by v/(ω₁ √(1 − q)), ω₁ = (π/2)(1 + e)/τ, but for the weight, which adds 0.4 % here. With
/// feet a little lower than that the edges press too, with a little higher ones nothing depends on them.
#[test]
fn edges_press_where_feet_sink_in() {
    let flat = bar(LAPTOP)
        .replace("tilt = [\"1 deg\", \"8 deg\"]", "tilt = \"0 deg\"")
        .replace("center_of_mass = \"10 mm\"\n", "")
        .replace("[0.2, 0.3]", "0.25");
    let speed = (2.0 * clatter_shock::STANDARD_GRAVITY_M_S2 * 0.5_f64).sqrt();
    let q = (0.12_f64.powi(2) - 0.085 * 0.085) / (0.12_f64.powi(2) + 0.085 * 0.085);
    let sinks_m = speed / (std::f64::consts::FRAC_PI_2 * 1.25 / 1e-3 * (1.0 - q).sqrt());
    let of = |share: f64| {
        let height = format!("feet_height = \"{} mm\"", 1e3 * share * sinks_m);
        demands(&assess(&flat.replace("feet_height = \"6 mm\"", &height)))
    };
    let alike = |one: &[f64], other: &[f64]| one.iter().zip(other).all(|(a, b)| (a / b - 1.0).abs() < 1e-9);
    let high = of(3.0);
    assert!(alike(&of(1.015), &high), "{:?}, not {high:?}", of(1.015));
    for share in [0.99, 0.7] {
        assert!(!alike(&of(share), &high), "{share}: {high:?}");
    }
}

/// Feet so low that the edges come down in the clatter: those are points like the feet, and what they ask is answered.
#[test]
fn edges_that_press_in_the_clatter_are_answered() {
    let low = LAPTOP.replace("\"6 mm\"", "\"1.5 mm\"").replace("[\"1 deg\", \"8 deg\"]", "[\"1 deg\", \"2 deg\"]");
    for text in [low.clone(), bar(&low)] {
        let [low, high] = [text.clone(), text.replace("\"1.5 mm\"", "\"6 mm\"")].map(|text| demands(&assess(&text)));
        // A hundredth of an answer is no difference.
        assert!(low.iter().zip(&high).any(|(low, high)| (low / high - 1.0).abs() > 0.02), "{low:?} beside {high:?}");
    }
}

/// A soft part swings in the flight until an edge comes down: the plate leaves the ground with a known velocity, and the part goes on by
/// that over ω, 16 times what it had as the feet parted.
#[test]
fn a_part_swings_until_an_edge_comes_down() {
    let file = read(include_str!("missed/feet-soft.toml"));
    let limit = &clatter_assess::assess(&file).expect("an assessment").components[0].limits[0];
    // An integration of its own has 0.056 m.
    assert!((limit.demand.expect("an answer") / 0.056 - 1.0).abs() < 0.02, "{limit:?}");
}

/// The foot of a product that rises to one direction is under the edge that it lands on.
#[test]
fn an_edge_may_not_touch_first() {
    let said =
        |text: &str| ProductFile::read(text, "laptop.toml").map_or_else(|faults| faults.to_string(), |_| String::new());
    // Over a corner 36 mm beyond its foot: atan(6/36.06).
    let steep = LAPTOP.replace("\"8 deg\"", "\"9.6 deg\"");
    assert!(said(&steep).contains("at a tilt of 9.6 deg an edge touches before the foot"), "{}", said(&steep));
    assert!(said(&steep).contains("up to 9.45 deg"), "{}", said(&steep));
    // Along the length 30 mm, from 45 degrees on over the corner no more.
    let toward = |from: &str, to: &str| {
        said(&steep.replace("tilt =", &format!("direction = [\"{from} deg\", \"{to} deg\"]\ntilt =")))
    };
    assert_eq!(toward("0", "10"), "");
    assert!(toward("0", "40").contains("an edge touches before the foot"));
    assert!(toward("300", "340").contains("an edge touches before the foot"));
    assert_eq!(said(&bar(&steep.replace("9.6 deg", "11.3 deg"))), "");
    assert!(said(&bar(&steep.replace("9.6 deg", "11.4 deg"))).contains("up to 11.31 deg"));
}

/// Feet need a height, a distance, and a side that lands.
#[test]
fn feet_that_cannot_be_are_refused() {
    let said = |from: &str, to: &str| {
        let text = LAPTOP.replace(from, to);
        assert_ne!(text, LAPTOP, "{from}");
        ProductFile::read(&text, "laptop.toml").expect_err("refused").to_string()
    };
    assert!(said("feet_height = \"6 mm\"\n", "").contains("`feet_inset` needs `feet_height`"));
    assert!(said("feet_inset = [\"30 mm\", \"20 mm\"]\n", "").contains("`feet_height` needs `feet_inset`"));
    let apart = said("[\"30 mm\", \"20 mm\"]", "[\"30 mm\", \"90 mm\"]");
    assert!(
        apart.contains("the feet are 90 mm inside the edges of a side of 210 mm") && apart.contains("up to 84 mm"),
        "{apart}"
    );
    let of_box = said("tilt = [\"1 deg\", \"8 deg\"]", "face = \"bottom\"");
    assert!(of_box.contains("feet are those of a bar or a plate; a box"), "{of_box}");
    assert!(
        said("\"-100 mm\", \"70 mm\"", "\"-160 mm\", \"70 mm\"").contains("up to 150 mm, half of the product's length")
    );
    // Built in code.
    let mut file = read(LAPTOP);
    file.product.body.feet.as_mut().unwrap().height_m = 2e-3;
    assert!(file.check().unwrap_err().to_string().contains("at a tilt of 8 deg an edge touches before the foot"));
}

/// An off-center bar that lands flat leaves its feet turning fast: 3.8 ms later, long before it lands on them again, its edge comes down.
/// With edges that press as feet do an integration of its own has the part at 103 to 114 gn; on feet alone it is asked for 78.
#[test]
fn an_edge_that_comes_down_after_the_clatter_presses() {
    let text = r#"
product = { name = "bar", length = "395.05 mm", radius_of_gyration = "37.04 mm", center_of_mass = "44.68 mm", restitution = 0.4436, contact_time = "0.4 ms", contact_law = "hysteretic", feet_inset = "110.98 mm", feet_height = "8.773 mm" }
drop = { speed = "4.3 m/s", tilt = "0 deg", first = "a" }
component = [
    { name = "soft", position = "127.5 mm", natural_frequency = "40 Hz", damping_ratio = 0.1, acceleration_limit = "101.8 gn" },
]
"#;
    let assessment = assess(text);
    let limit = &assessment.components[0].limits[0];
    let demand_gn = limit.demand.unwrap() / clatter_shock::STANDARD_GRAVITY_M_S2;
    assert!((103.0..114.0).contains(&demand_gn) && limit.verdict == Verdict::Unsafe, "{demand_gn}: {limit:?}");
    // So it is of many drops.
    let settings = Settings { samples: 20, seed: 1, confidence: 0.95, merge_s: 1e-3 };
    let sampler = Sampler::new(&read(text), settings).unwrap();
    let scatter = sampler.run(false, &|| true, |_| Ok::<_, ()>(())).unwrap();
    assert!(scatter.survival.hi < 1.0 && scatter.survival.lo < 0.01, "{:?}", scatter.survival);
}

/// A bar whose edges come down in its clatter by instant impacts, which know the feet alone.
const EDGED: &str = r#"
product = { name = "bar", length = "300 mm", feet_inset = "60 mm", feet_height = "4 mm", radius_of_gyration = "60 mm", center_of_mass = "30 mm", restitution = 0.5 }
drop = { height = "0.5 m", tilt = ["1 deg", "3 deg"] }
component = [
    { name = "drive", position = "-100 mm", natural_frequency = "90 Hz", damping_ratio = 0.15, acceleration_limit = "900 gn" },
    { name = "board", position = "20 mm", mount = "hard", velocity_change_limit = "40 m/s" },
]
"#;

/// They are not answered; asked of instant impacts where the contact time is known, what contacts ask counts.
#[test]
fn a_model_with_less_physics_is_no_way_around() {
    let timed =
        EDGED.replace("restitution = 0.5", "restitution = 0.5, contact_time = \"1 ms\", contact_law = \"hysteretic\"");
    for (text, model) in [(EDGED, None), (&timed, Some(Model::FiniteTilt))] {
        let assessment =
            clatter_assess::assess_to(&read(text), &Accuracy { model, ..Accuracy::default() }).expect("an assessment");
        let why = assessment.components[0].limits[0].why_undecided().expect("undecided");
        assert!(why.contains("an edge beyond the feet comes down"), "{why}");
    }
    assert!(assess(&timed).components.iter().all(|part| part.limits[0].why_undecided().is_none()));
    // At a degree the edges stay up by instant impacts, and by contacts they come down.
    let text = bar(LAPTOP).replace("\"6 mm\"", "\"1.5 mm\"").replace("[\"1 deg\", \"8 deg\"]", "\"1 deg\"");
    let accuracy = Accuracy { model: Some(Model::FiniteTilt), ..Accuracy::default() };
    let assessment = clatter_assess::assess_to(&read(&text), &accuracy).expect("an assessment");
    for part in &assessment.components {
        let limit = &part.limits[0];
        let worst = limit.worst_case.as_ref().expect("a drop");
        let of = Limit::of(&read(&text).components.into_iter().find(|of| of.name == part.name).expect("a part"))[0];
        let by_contacts = answer(&worst.drop, &worst.part, &of, Model::Compliant, 0.01).expect("an answer").value;
        let told = limit.demand.unwrap() * (1.0 + limit.uncertainty);
        assert!(by_contacts <= told * (1.0 + 1e-9), "{}: {by_contacts}, not {told}", part.name);
    }
}

/// By how much drops that are not answered may exceed the demand, energy says, and where it does not nothing does.
#[test]
fn what_is_not_answered_may_ask_for_all_that_energy_allows() {
    let assessment = assess(EDGED);
    let [drive, board] = [0, 1].map(|n| &assessment.components[n].limits[0]);
    let why = drive.why_undecided().expect("undecided");
    assert!(why.contains("are not answered") && drive.uncertainty.is_infinite(), "{why}: {}", drive.uncertainty);
    let most = board.demand.unwrap() * (1.0 + board.uncertainty);
    assert!((most / board.bound.unwrap() - 1.0).abs() < 1e-9 && board.verdict == Verdict::Safe, "{board:?}");
}
