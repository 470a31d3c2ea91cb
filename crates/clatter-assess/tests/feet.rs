//! Products that land on feet inside their edges.

use clatter_assess::scatter::{Sampler, Settings};
use clatter_assess::{Accuracy, Assessment, Model, ProductFile, Verdict};

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
    read(text).assess().expect("an assessment")
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
    let assessment = read(&at_edge.replace("contact_time = \"1 ms\"\ncontact_law = \"hysteretic\"\n", ""))
        .assess()
        .expect("an assessment");
    let limit = &assessment.components[1].limits[0];
    let (worst, demand) = (limit.worst_case.as_ref().unwrap(), limit.demand.unwrap());
    let [a, b] = worst.drop.body.arms_m();
    let (a, b, side) = if worst.drop.first == clatter::End::A { (a, b, 1.0) } else { (b, a, -1.0) };
    let body = clatter_flight::Body::off_center(a, b, worst.drop.body.gyration_m()).unwrap();
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
/// feet a little lower than that the edges touch, with a little higher ones they do not.
#[test]
fn edges_touch_where_feet_sink_in() {
    let flat = bar(LAPTOP)
        .replace("tilt = [\"1 deg\", \"8 deg\"]", "tilt = \"0 deg\"")
        .replace("center_of_mass = \"10 mm\"\n", "")
        .replace("[0.2, 0.3]", "0.25");
    let speed = (2.0 * clatter_shock::STANDARD_GRAVITY_M_S2 * 0.5_f64).sqrt();
    let q = (0.12_f64.powi(2) - 0.085 * 0.085) / (0.12_f64.powi(2) + 0.085 * 0.085);
    let sinks_m = speed / (std::f64::consts::FRAC_PI_2 * 1.25 / 1e-3 * (1.0 - q).sqrt());
    for (share, touches) in [(0.99, true), (1.015, false)] {
        let height = format!("feet_height = \"{} mm\"", 1e3 * share * sinks_m);
        let assessment = assess(&flat.replace("feet_height = \"6 mm\"", &height));
        for part in &assessment.components {
            let limit = &part.limits[0];
            assert_eq!(limit.demand.is_none(), touches, "{share}: {limit:?}");
            let why = limit.why_undecided().unwrap_or_default();
            assert_eq!(why.contains("an edge beyond the feet comes down"), touches, "{why}");
        }
    }
}

/// What some of the drops may do to an edge is not known: no part of a plate is safe then, where by its feet alone all are.
#[test]
fn edges_that_touch_leave_parts_undecided() {
    let verdict = |text: &str| assess(text).components.into_iter().map(|part| part.verdict).collect::<Vec<_>>();
    let steady = LAPTOP.replace("[0.2, 0.3]", "0.1").replace("[\"1 deg\", \"8 deg\"]", "[\"1 deg\", \"2 deg\"]");
    assert_eq!(verdict(&steady), [Verdict::Safe; 2]);
    assert_eq!(verdict(&steady.replace("\"6 mm\"", "\"1.5 mm\"")), [Verdict::Undecided; 2]);
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
    file.product.feet.as_mut().unwrap().height_m = 2e-3;
    assert!(file.check().unwrap_err().to_string().contains("at a tilt of 8 deg an edge touches before the foot"));
}

/// An off-center bar that lands flat leaves its feet turning fast: 3.8 ms later, long before it lands on them again, its edge comes down.
/// With edges that press as feet do an integration of its own has the part at 103 to 114 gn; on feet alone it is asked for 78.
#[test]
fn an_edge_that_comes_down_after_the_clatter_is_bounded_by_energy() {
    let text = r#"
product = { name = "bar", length = "395.05 mm", radius_of_gyration = "37.04 mm", center_of_mass = "44.68 mm", restitution = 0.4436, contact_time = "0.4 ms", contact_law = "hysteretic", feet_inset = "110.98 mm", feet_height = "8.773 mm" }
drop = { speed = "4.3 m/s", tilt = "0 deg", first = "a" }
component = [
    { name = "soft", position = "127.5 mm", natural_frequency = "40 Hz", damping_ratio = 0.1, acceleration_limit = "101.8 gn" },
    { name = "hard", position = "0 mm", mount = "hard", acceleration_limit = "90000 gn", velocity_change_limit = "30 m/s" },
]
"#;
    let assessment = assess(text);
    let [soft, hard] = &assessment.components[..] else { panic!("two parts") };
    assert_eq!(soft.verdict, Verdict::Undecided);
    let limit = &soft.limits[0];
    assert!(
        limit.demand.unwrap() * (1.0 + limit.uncertainty) > 114.0 * clatter_shock::STANDARD_GRAVITY_M_S2,
        "{limit:?}"
    );
    // How hard the edge presses is not known; what it changes velocities by is bounded.
    let [acceleration, velocity] = &hard.limits[..] else { panic!("two limits") };
    assert_eq!((acceleration.verdict, velocity.verdict), (Verdict::Undecided, Verdict::Safe));
    let notes = acceleration.notes.iter().map(ToString::to_string).collect::<String>();
    assert!(notes.contains("edges beyond the feet may come down"), "{notes}");
    // So it is of many drops.
    let settings = Settings { samples: 20, seed: 1, confidence: 0.95, merge_s: 1e-3 };
    let sampler = Sampler::new(&read(text), settings).unwrap();
    let scatter = sampler.run(false, &|| true, |_| Ok::<_, ()>(())).unwrap();
    assert!(scatter.survival.lo < 0.01, "{:?}", scatter.survival);
}

/// A drop whose edge touches is not answered with contacts that take time; asked of instant impacts it is undecided, and why is told.
#[test]
fn a_model_with_less_physics_is_no_way_around() {
    let text = bar(LAPTOP).replace("\"6 mm\"", "\"1.5 mm\"").replace("[\"1 deg\", \"8 deg\"]", "\"1 deg\"");
    for model in [Model::Map, Model::FiniteTilt] {
        let accuracy = Accuracy { model: Some(model), ..Accuracy::default() };
        let assessment = read(&text).assess_to(&accuracy).expect("an assessment");
        for part in &assessment.components {
            let limit = &part.limits[0];
            let why = limit.why_undecided().expect("undecided");
            assert!(why.contains("an edge beyond the feet comes down"), "{why}");
        }
    }
}

/// By how much drops that are not answered may exceed the demand, energy says, and where it does not nothing does.
#[test]
fn what_is_not_answered_may_ask_for_all_that_energy_allows() {
    let assessment = assess(&LAPTOP.replace("\"6 m/s\"", "\"20 m/s\""));
    let [drive, board] = [0, 1].map(|n| &assessment.components[n].limits[0]);
    let why = drive.why_undecided().expect("undecided");
    assert!(why.contains("are not answered") && drive.uncertainty.is_infinite(), "{why}: {}", drive.uncertainty);
    let most = board.demand.unwrap() * (1.0 + board.uncertainty);
    assert!((most / board.bound.unwrap() - 1.0).abs() < 1e-9 && board.verdict == Verdict::Safe, "{board:?}");
}
