//! Products with a width: plates that land on any corner.

use clatter_assess::{LimitAssessment, Note, Part, PlatePortrait, Verdict, answer};
use clatter_product::{Limit, LimitKind, Place, ProductFile};

/// A handheld terminal with a display, a board and a battery.
const HANDHELD: &str = r#"
[product]
name = "handheld"
length = "150 mm"
width = "70 mm"
radius_of_gyration = ["43 mm", "20 mm"]
center_of_mass = ["0 mm", "0 mm"]
restitution = 0.4
contact_time = "0.4 ms"
contact_law = "hysteretic"

[drop]
speed = "3 m/s"
tilt = ["0.5 deg", "4 deg"]

[[component]]
name = "display"
position = ["10 mm", "5 mm"]
extent = ["20 mm", "10 mm"]
mount = "hard"
acceleration_limit = "2000 gn"

[[component]]
name = "board"
position = ["-40 mm", "-20 mm"]
natural_frequency = "120 Hz"
damping_ratio = 0.1
rattle_space = "9 mm"
"#;

pub(crate) fn file(text: &str) -> ProductFile {
    ProductFile::read(text, "plate.toml").unwrap_or_else(|faults| panic!("{faults}"))
}

fn limits(text: &str) -> Vec<LimitAssessment> {
    let assessment = clatter_assess::assess(&file(text)).expect("an assessment");
    assessment.components.into_iter().flat_map(|component| component.limits).collect()
}

fn demands(text: &str) -> Vec<f64> {
    limits(text).into_iter().map(|limit| limit.demand.expect("an answer")).collect()
}

/// What two searches of one worst case may differ by: each may miss 2 %.
const SEARCHES: f64 = 0.02;

fn are_close(one: &[f64], other: &[f64], share: f64) {
    assert_eq!(one.len(), other.len());
    for (a, b) in one.iter().zip(other) {
        assert!((a / b - 1.0).abs() < share, "{one:?} beside {other:?}");
    }
}

/// Where β = 1 + α, two corners of an edge at once yield as the end of a bar does: μ = 1 + α + β is twice 1 + α. So the plate that
/// rises along its length alone is that bar, but for cos φ of lever arms, below 1e-5 at a quarter of a degree.
#[test]
fn a_plate_that_lands_on_its_edge_is_a_bar() {
    let (length, gyration, half_width) = (0.15_f64, 0.043_f64, 0.035_f64);
    let alpha = (0.5 * length / gyration).powi(2);
    let across = half_width / (1.0 + alpha).sqrt();
    let drop = "[drop]\nspeed = \"3 m/s\"\ntilt = \"0.25 deg\"\n";
    let parts = |place: &str, other: &str| {
        format!(
            "[[component]]\nname = \"hard\"\nposition = {place}\nmount = \"hard\"\nacceleration_limit = \"2000 gn\"\n\
             velocity_change_limit = \"5 m/s\"\nangular_velocity_change_limit = \"50 rad/s\"\n\
             [[component]]\nname = \"soft\"\nposition = {other}\nnatural_frequency = \"300 Hz\"\ndamping_ratio = 0.05\n\
             acceleration_limit = \"2000 gn\"\nrattle_space = \"9 mm\"\n"
        )
    };
    let common = "name = \"one\"\nlength = \"150 mm\"\nrestitution = 0.4\ncontact_time = \"0.4 ms\"\n";
    let plate = format!(
        "[product]\n{common}width = \"70 mm\"\nradius_of_gyration = [\"43 mm\", \"{} mm\"]\n{drop}direction = \"0 deg\"\n{}",
        1e3 * across,
        parts("[\"60 mm\", \"0 mm\"]", "[\"-20 mm\", \"10 mm\"]")
    );
    let bar = format!(
        "[product]\n{common}radius_of_gyration = \"43 mm\"\n{drop}first = \"a\"\n{}",
        parts("\"60 mm\"", "\"-20 mm\"")
    );
    are_close(&demands(&plate), &demands(&bar), 1e-4);
}

/// A plate seen from above or from below, with the ends exchanged, and with length and width exchanged, is the same plate.
#[test]
fn a_plate_is_the_same_from_all_sides() {
    let text = HANDHELD
        .replace("[\"0 mm\", \"0 mm\"]", "[\"8 mm\", \"-3 mm\"]")
        .replace("tilt = [\"0.5 deg\", \"4 deg\"]", "tilt = \"2 deg\"\ndirection = [\"20 deg\", \"70 deg\"]");
    let own = demands(&text);
    let mirrored = text
        .replace("[\"8 mm\", \"-3 mm\"]", "[\"-8 mm\", \"-3 mm\"]")
        .replace("[\"10 mm\", \"5 mm\"]", "[\"-10 mm\", \"5 mm\"]")
        .replace("[\"-40 mm\", \"-20 mm\"]", "[\"40 mm\", \"-20 mm\"]")
        .replace("[\"20 deg\", \"70 deg\"]", "[\"110 deg\", \"160 deg\"]");
    are_close(&demands(&mirrored), &own, SEARCHES);
    let turned = text
        .replace("length = \"150 mm\"\nwidth = \"70 mm\"", "length = \"70 mm\"\nwidth = \"150 mm\"")
        .replace("[\"43 mm\", \"20 mm\"]", "[\"20 mm\", \"43 mm\"]")
        .replace("[\"8 mm\", \"-3 mm\"]", "[\"-3 mm\", \"8 mm\"]")
        .replace("[\"10 mm\", \"5 mm\"]", "[\"5 mm\", \"10 mm\"]")
        .replace("[\"20 mm\", \"10 mm\"]", "[\"10 mm\", \"20 mm\"]")
        .replace("[\"-40 mm\", \"-20 mm\"]", "[\"-20 mm\", \"-40 mm\"]");
    are_close(&demands(&turned), &own, SEARCHES);
}

/// A center of mass off both axes is followed over all directions, one in the middle over a quarter of them for all.
#[test]
fn a_symmetric_plate_is_followed_for_its_mirror_images() {
    // With masses askew its sides are even, and no mirror image is it again.
    let askew = "masses = [{ mass = \"90 g\", from = [\"-75 mm\", \"-35 mm\"], to = [\"75 mm\", \"35 mm\"] }, \
                 { mass = \"50 g\", position = [\"45 mm\", \"25 mm\"] }, { mass = \"50 g\", position = [\"-45 mm\", \"-25 mm\"] }]";
    let even = "radius_of_gyration = [\"43 mm\", \"20 mm\"]\ncenter_of_mass = [\"0 mm\", \"0 mm\"]";
    let centers = ["[\"0 mm\", \"0 mm\"]", "[\"0 mm\", \"-6 mm\"]", "[\"9 mm\", \"0 mm\"]"];
    let texts = centers.map(|center| HANDHELD.replace("[\"0 mm\", \"0 mm\"]", center));
    for text in texts.into_iter().chain([HANDHELD.replace(even, askew)]) {
        let all = text.replace("tilt = [", "direction = [\"0 deg\", \"360 deg\"]\ntilt = [");
        are_close(&demands(&text), &demands(&all), SEARCHES);
    }
    let worst = limits(HANDHELD)[0].worst_case.expect("a drop");
    assert!(worst.direction_deg().is_some_and(|direction| (0.0..360.0).contains(&direction)));
}

/// Masses that lie askew turn the plate about both axes at once.
#[test]
fn masses_that_lie_askew_have_a_product_of_inertia() {
    let masses = r#"masses = [
    { mass = "100 g", from = ["-75 mm", "-35 mm"], to = ["75 mm", "35 mm"] },
    { mass = "60 g", position = ["40 mm", "20 mm"] },
    { mass = "60 g", position = ["-40 mm", "-20 mm"] },
]"#;
    let text =
        HANDHELD.replace("radius_of_gyration = [\"43 mm\", \"20 mm\"]\ncenter_of_mass = [\"0 mm\", \"0 mm\"]", masses);
    let body = file(&text).product.body;
    let width = body.width.expect("a width");
    // 2 · 60 g · 40 mm · 20 mm over 220 g; the slab has none of its own.
    assert!((body.products_m2[0] - 0.12 * 0.04 * 0.02 / 0.22).abs() < 1e-12);
    let [x, y] = [0.1 * 0.15 * 0.15 / 12.0 + 0.12 * 0.04 * 0.04, 0.1 * 0.07 * 0.07 / 12.0 + 0.12 * 0.02 * 0.02];
    assert!((file(&text).product.gyration_m.lo() - (x / 0.22_f64).sqrt()).abs() < 1e-12);
    assert!((width.gyration_m - (y / 0.22_f64).sqrt()).abs() < 1e-12);
    // The diagonal with the masses is heavy, the other one light: its mirror image is another plate.
    let mirrored = text
        .replace("[\"40 mm\", \"20 mm\"]", "[\"40 mm\", \"-20 mm\"]")
        .replace("[\"-40 mm\", \"-20 mm\"] },", "[\"-40 mm\", \"20 mm\"] },");
    let differ = demands(&text).iter().zip(demands(&mirrored)).any(|(a, b)| (a / b - 1.0).abs() > 0.05);
    assert!(differ, "{:?} beside {:?}", demands(&text), demands(&mirrored));
}

/// Real tilt, by a box with full rotation and another integration, is told beside each demand: little up to 4 degrees.
#[test]
fn a_box_at_real_tilt_says_nearly_the_same() {
    let mut most = 0.0_f64;
    let masses = r#"masses = [
    { mass = "100 g", from = ["-75 mm", "-35 mm"], to = ["75 mm", "35 mm"] },
    { mass = "40 g", position = ["40 mm", "20 mm"] },
]"#;
    let even = "radius_of_gyration = [\"43 mm\", \"20 mm\"]\ncenter_of_mass = [\"0 mm\", \"0 mm\"]";
    let askew = HANDHELD.replace(even, masses);
    let cases = [(HANDHELD, "[\"0.5 deg\", \"4 deg\"]", 0.03), (HANDHELD, "[\"6 deg\", \"10 deg\"]", 0.15)];
    for (text, tilts, nearly) in cases.into_iter().chain([(&askew[..], "[\"0.5 deg\", \"3 deg\"]", 0.03)]) {
        for limit in limits(&text.replace("[\"0.5 deg\", \"4 deg\"]", tilts)) {
            let tilt =
                limit.notes.iter().find_map(|note| if let Note::Tilt { off, .. } = note { Some(*off) } else { None });
            let off = tilt.expect("a box beside it");
            assert!(off.abs() < nearly, "{:?}: {off}", limit.limit);
            // What it asks for beyond the plate is among what drops may ask.
            assert!(limit.uncertainty >= SEARCHES + off.max(0.0) - 1e-12, "{:?}: {off}", limit.limit);
            most = most.max(off);
        }
    }
    assert!(most > 1e-3, "no box asks for more than its plate: {most}");
}

#[test]
fn what_allows_more_is_safe() {
    let text = HANDHELD.replace("2000 gn", "9000 gn").replace("9 mm\"", "60 mm\"");
    let assessment = clatter_assess::assess(&file(&text)).expect("an assessment");
    assert_eq!(assessment.verdict, Verdict::Safe);
    let unsafe_one = clatter_assess::assess(&file(&text.replace("9000 gn", "1000 gn"))).expect("an assessment");
    assert_eq!(unsafe_one.verdict, Verdict::Unsafe);
    for limit in assessment.components.iter().flat_map(|component| &component.limits) {
        assert!(limit.bound.zip(limit.demand).is_none_or(|(bound, demand)| demand <= bound));
    }
}

/// All four corners of a plate that lands flat press on its center along one line, and one corner turns a slender plate about its long
/// axis: energy allows both.
#[test]
fn energy_allows_what_flat_and_slender_plates_do() {
    let flat = HANDHELD.replace("tilt = [\"0.5 deg\", \"4 deg\"]", "tilt = \"0 deg\"");
    let flat = flat
        .replace("[\"10 mm\", \"5 mm\"]", "[\"0 mm\", \"0 mm\"]")
        .replace("[\"20 mm\", \"10 mm\"]", "[\"0 mm\", \"0 mm\"]");
    let display = &limits(&flat)[0];
    let mu = 1.0 + (75.0_f64 / 43.0).powi(2) + (35.0_f64 / 20.0).powi(2);
    let four = 3.0 * std::f64::consts::FRAC_PI_2 * 1.4 / 4e-4 * (4.0 / mu).sqrt();
    // Gravity works during the contact, by a thousandth.
    assert!((display.demand.expect("an answer") / four - 1.0).abs() < 3e-3, "{display:?}, not {four}");
    assert!(display.bound.expect("a bound") >= four, "{display:?}");
    // The force of a dashpot jumps at the touch: nothing bounds it by the energy.
    let jumps = &limits(&flat.replace("\"hysteretic\"", "\"dashpot\""))[0];
    assert_eq!(jumps.bound, None);
    let slender = HANDHELD
        .replace("length = \"150 mm\"\nwidth = \"70 mm\"", "length = \"300 mm\"\nwidth = \"40 mm\"")
        .replace("[\"43 mm\", \"20 mm\"]", "[\"90 mm\", \"15 mm\"]")
        .replace("tilt = [", "direction = \"90 deg\"\ntilt = [")
        .replace("acceleration_limit = \"2000 gn\"", "angular_velocity_change_limit = \"2000 rad/s\"")
        .replace("\"-20 mm\"]", "\"0 mm\"]");
    let turn = &limits(&slender)[0];
    // (1 + e) v y/(k_y² + y²) of the long edge that lands first.
    let first = 1.4 * 3.0 * 0.02 / (0.015_f64.powi(2) + 0.02_f64.powi(2));
    assert!(turn.demand.expect("an answer") > 0.99 * first && turn.bound >= turn.demand, "{turn:?} beside {first}");
}

/// However soft its contacts, the box beside a plate tells what real tilt adds.
#[test]
fn a_plate_has_its_box_beside_it() {
    let tilt = |limit: &LimitAssessment| limit.notes.iter().any(|note| matches!(note, Note::Tilt { .. }));
    let soft = HANDHELD.replace("9 mm\"", "90 mm\"").replace("2000 gn", "9000 gn");
    for time in ["0.4 ms", "7 ms"] {
        let battery = &limits(&soft.replace("0.4 ms", time))[1];
        assert!(tilt(battery) && battery.verdict == Verdict::Safe, "{battery:?}");
    }
}

#[test]
fn faults_of_plates_are_told() {
    let cases = [
        ("contact_time = \"0.4 ms\"\n", "", "needs the `contact_time`"),
        ("[\"10 mm\", \"5 mm\"]", "\"10 mm\"", "along the length and along the width"),
        ("[\"10 mm\", \"5 mm\"]", "[\"10 mm\", \"31 mm\"]", "reaches 36 mm from the middle along the width"),
        ("[\"43 mm\", \"20 mm\"]", "[\"43 mm\", \"2 mm\"]", "of the mass along the width is 2 mm"),
        ("[\"43 mm\", \"20 mm\"]", "[\"43 mm\", [\"19 mm\", \"20 mm\"]]", "of the mass along the width has a range"),
        ("[\"0 mm\", \"0 mm\"]", "[\"0 mm\", \"34 mm\"]", "34 mm from the middle of a width of 70 mm"),
        ("tilt = [", "first = \"a\"\ntilt = [", "a product with a `width` has no `first`"),
        ("width = \"70 mm\"", "width = \"0 mm\"", "`width` = \"0 mm\" is out of its range"),
        ("tilt = [", "direction = \"400 deg\"\ntilt = [", "`direction` = \"400 deg\" is out of its range"),
    ];
    for (from, to, told) in cases {
        assert!(HANDHELD.contains(from), "{from}");
        let said = ProductFile::read(&HANDHELD.replacen(from, to, 1), "plate.toml").expect_err(told).to_string();
        assert!(said.contains(told), "{said}");
    }
    let bar = "product = { name = \"bar\", length = \"150 mm\", radius_of_gyration = \"43 mm\", restitution = 0.4 }\n\
               drop = { height = \"1 m\", tilt = \"1 deg\", direction = \"10 deg\" }\n\
               component = [{ name = \"p\", position = \"0 mm\", mount = \"hard\", velocity_change_limit = \"9 m/s\" }]\n";
    let said = ProductFile::read(bar, "bar.toml").expect_err("a direction").to_string();
    assert!(said.contains("a product without `width` has no `direction`"), "{said}");
}

const EXAMPLE: &str = include_str!("../../../reports/examples/handheld-terminal.toml");

/// Each part with its tightest limit, as it is asked, and its portrait.
fn portraits(text: &str) -> Vec<(LimitAssessment, Limit, PlatePortrait)> {
    let file = file(text);
    let assessment = clatter_assess::assess(&file).expect("an assessment");
    let portraits = clatter_assess::portraits(&file, &assessment).into_iter();
    let drawn =
        portraits.zip(file.components.iter().zip(&assessment.components)).map(|(portrait, (part, assessed))| {
            let tightest = assessed.tightest().clone();
            let limit =
                Limit::of(part).into_iter().find(|limit| limit.kind == tightest.limit).expect("a limit of the part");
            assert!(portrait.over_tilt.is_empty() && portrait.zone_m.is_none());
            (tightest, limit, portrait.plate.expect("a plate"))
        });
    drawn.collect()
}

/// The first strike is that of the lowest corner. The curve holds the worst case, and each of its points is what the one engine says.
#[test]
fn a_plate_is_drawn_as_it_was_followed() {
    let mut count = 0;
    for (tightest, limit, drawn) in [HANDHELD, EXAMPLE].into_iter().flat_map(portraits) {
        let worst = tightest.worst_case.expect("a drop");
        let direction = worst.direction_deg().expect("a plate");
        let strike = drawn.strikes[0];
        let (sin, cos) = direction.to_radians().sin_cos();
        // Of corners a to d those at end a, and those at the front.
        let (at_a, front) = ([0, 3].contains(&strike.corner), strike.corner < 2);
        assert!(at_a == (cos > 0.0) || cos.abs() < 1e-9, "{strike:?} rising to {direction}");
        assert!(front == (sin > 0.0) || sin.abs() < 1e-9, "{strike:?} rising to {direction}");
        assert!(drawn.strikes.windows(2).all(|pair| pair[0].time_s <= pair[1].time_s) && strike.time_s == 0.0);
        let demand = tightest.demand.expect("an answer") / tightest.allowed;
        assert!(drawn.over_direction.iter().any(|point| point.share.to_bits() == demand.to_bits()));
        assert!(drawn.over_direction.len() > 70);
        for point in drawn.over_direction.iter().step_by(9) {
            let again = answer(&point.drop, &point.part, &limit, worst.model, 0.01).expect("an answer");
            // 2 % of rough histories, and what the answer may be off by itself.
            let allowed_for = 0.02 + again.error().min(0.1);
            assert!((point.share / again.utilization() - 1.0).abs() < allowed_for, "{point:?}: {again:?}");
            count += 1;
        }
    }
    assert!(count > 40, "{count} points");
}

/// A map holds what the one engine says: of the worst drop alone to the last digit, of several drops as well as rough histories do; at
/// the part's own place and at others.
#[test]
fn a_map_over_the_plate_is_what_drops_ask() {
    let alone = HANDHELD.replace("tilt = [\"0.5 deg\", \"4 deg\"]", "tilt = \"3 deg\"\ndirection = \"291 deg\"");
    let mut own_places = 0;
    for text in [alone.as_str(), HANDHELD, EXAMPLE] {
        for (tightest, limit, drawn) in portraits(text) {
            let worst = tightest.worst_case.expect("a drop");
            let Some((_, map)) = drawn.maps.iter().find(|(kind, _)| *kind == tightest.limit) else {
                assert_eq!(tightest.limit, LimitKind::AngularVelocityChange);
                continue;
            };
            let others = drawn.over_direction.iter().map(|point| point.drop).filter(|drop| {
                let degrees = drop.direction_rad.to_degrees();
                let third = (degrees / 15.0 - (degrees / 15.0).round()).abs() < 1e-9 && degrees < 359.0;
                third && drawn.is_given(degrees.to_radians())
            });
            let mut drops = vec![worst.drop];
            drops.extend(others.filter(|drop| drop.direction_rad.to_bits() != worst.drop.direction_rad.to_bits()));
            assert!(map.drops == 25 || map.drops == 1 && text == alone, "{} drops", map.drops);
            let allowed_for = if map.drops == 1 { 1e-12 } else { 0.03 };
            for (row, &across_m) in map.across_m.iter().enumerate() {
                for (column, &position_m) in map.along_m.iter().enumerate() {
                    let part = Part::at(Place::flat([position_m, across_m]), worst.part.suspension);
                    let is_own = part == worst.part;
                    own_places += usize::from(is_own);
                    if !is_own && !(row + 7 * column).is_multiple_of(20) {
                        continue;
                    }
                    let asked = drops.iter().map(|drop| answer(drop, &part, &limit, worst.model, worst.tolerance));
                    let most = asked.map(|answer| answer.expect("an answer").utilization()).fold(0.0, f64::max);
                    let share = map.share(column, row);
                    assert!((share / most - 1.0).abs() < allowed_for, "{position_m}, {across_m}: {share}, not {most}");
                    let demand = tightest.demand.expect("an answer") / tightest.allowed;
                    assert!(!is_own || share >= demand, "{share} beside {demand}");
                }
            }
        }
    }
    assert_eq!(own_places, 6, "each map has a column and a row through the worst place of its part");
}

/// Where a change of velocity limits a part, places are answered between its ends as well: along both sides of a rectangle on a plate.
#[test]
fn places_between_the_ends_of_a_part_are_answered() {
    let sides = |places: &[[f64; 2]]| {
        [0, 1].map(|side| {
            let mut all: Vec<f64> = places.iter().map(|place| place[side]).collect();
            all.sort_by(f64::total_cmp);
            all.dedup();
            all
        })
    };
    let of = |text: &str| file(text).components[0].places_m();
    // 20 mm by 10 mm about (10 mm, 5 mm).
    assert_eq!(of(HANDHELD).len(), 4, "of an acceleration the largest is at an end");
    let change = HANDHELD.replace("acceleration_limit = \"2000 gn\"", "velocity_change_limit = \"5 m/s\"");
    let places = of(&change);
    let [x, y] = sides(&places);
    assert!(x.len() > 3 && y.len() > 3 && places.len() == x.len() * y.len(), "{places:?}");
    assert_eq!((x[0], x[x.len() - 1], y[0], y[y.len() - 1]), (0.0, 0.02, 0.0, 0.01));
    // A part that is a line, along either side.
    for (extent, along) in [("[\"20 mm\", \"0 mm\"]", 0), ("[\"0 mm\", \"10 mm\"]", 1)] {
        let sides = sides(&of(&change.replace("[\"20 mm\", \"10 mm\"]", extent)));
        assert!(sides[along].len() > 3 && sides[1 - along].len() == 1, "{sides:?}");
    }
}

/// A hair of askew masses changes nothing of what real tilt adds.
#[test]
fn what_real_tilt_adds_does_not_jump_where_masses_lie_askew() {
    let even = "radius_of_gyration = [\"43 mm\", \"20 mm\"]\ncenter_of_mass = [\"0 mm\", \"0 mm\"]";
    let masses = |y: &str| {
        format!(
            "masses = [{{ mass = \"100 g\", from = [\"-75 mm\", \"-35 mm\"], to = [\"75 mm\", \"35 mm\"] }}, \
             {{ mass = \"30 g\", position = [\"40 mm\", \"{y}\"] }}, {{ mass = \"30 g\", position = [\"-40 mm\", \"-{y}\"] }}]"
        )
    };
    let told = |y: &str| {
        let text = HANDHELD.replace(even, &masses(y)).replace("[\"0.5 deg\", \"4 deg\"]", "[\"13 deg\", \"14 deg\"]");
        let product = file(&text).product;
        let limits = limits(&text.replace("tilt = [", "direction = [\"20 deg\", \"30 deg\"]\ntilt = ["));
        let off =
            limits[0].notes.iter().find_map(|note| if let Note::Tilt { off, .. } = note { Some(*off) } else { None });
        (product.body.products_m2[0], off.expect("a box beside it"))
    };
    let ((none, straight), (hair, askew)) = (told("0 mm"), told("0.00001 mm"));
    assert!(none == 0.0 && hair != 0.0, "{none}, {hair}");
    assert!(straight.abs() > 0.01, "{straight}: nothing would be seen");
    // Both searches end within a tenth of that of one another.
    assert!((askew - straight).abs() < 0.1 * straight.abs(), "{askew}, not {straight}");
}

/// A plate that is set down on a corner, slowly and at a steep tilt, falls onto the others: energy allows what gravity gives it.
#[test]
fn energy_allows_what_falls_over() {
    let text = HANDHELD
        .replace("3 m/s", "0.1 m/s")
        .replace("[\"0.5 deg\", \"4 deg\"]", "[\"9 deg\", \"10 deg\"]")
        .replace("[\"10 mm\", \"5 mm\"]", "[\"60 mm\", \"25 mm\"]")
        .replace("[\"20 mm\", \"10 mm\"]", "[\"0 mm\", \"0 mm\"]")
        .replace("acceleration_limit = \"2000 gn\"", "velocity_change_limit = \"9 m/s\"");
    let display = &limits(&text)[0];
    let (demand, bound) = (display.demand.unwrap(), display.bound.unwrap());
    // The speed of the fall turned around, at the place: 2 v √(1 + (60/43)² + (25/20)²).
    let of_speed = 2.0 * 0.1 * (1.0 + (60.0_f64 / 43.0).powi(2) + (25.0_f64 / 20.0).powi(2)).sqrt();
    assert!(demand > 1.2 * of_speed && demand <= bound, "{demand} of {bound}, {of_speed} without gravity");
}

/// Its masses lie on one diagonal: turned about one side it is another plate, and what lands on that diagonal is not what lands on the
/// other.
#[test]
fn a_plate_with_its_masses_on_a_diagonal_is_searched_all_around() {
    let masses = r#"masses = [
    { mass = "60 g", from = ["-75 mm", "-35 mm"], to = ["75 mm", "35 mm"] },
    { mass = "40 g", position = ["60 mm", "28 mm"] },
    { mass = "40 g", position = ["-60 mm", "-28 mm"] },
]"#;
    let even = "radius_of_gyration = [\"43 mm\", \"20 mm\"]\ncenter_of_mass = [\"0 mm\", \"0 mm\"]";
    let text = HANDHELD.replace(even, masses).replace("[\"10 mm\", \"5 mm\"]", "[\"0 mm\", \"0 mm\"]");
    let of = |direction: &str| demands(&text.replace("tilt = ", &format!("{direction}tilt = ")))[0];
    let [heavy, light] = ["direction = [\"10 deg\", \"80 deg\"]\n", "direction = [\"100 deg\", \"170 deg\"]\n"].map(of);
    assert!((heavy / light - 1.0).abs() > 0.1, "{heavy}, {light}");
    let all = of("");
    assert!(all > (1.0 - SEARCHES) * heavy.max(light), "{all} beside {heavy}, {light}");
}

/// A plate of 5 mm on contacts of 2.5 ms: its corners sink in by more than it is thick, so that those of its top, which are not followed, would
/// touch as well.
#[test]
fn what_sinks_in_deeper_than_it_is_thick_is_undecided() {
    let of = |contact_ms: f64| {
        let text = format!(
            "[product]\nname = \"soft\"\nlength = \"107 mm\"\nwidth = \"88 mm\"\nthickness = \"5 mm\"\n\
             masses = [{{ mass = \"1 kg\", from = [\"-53.5 mm\", \"-44 mm\"], to = [\"53.5 mm\", \"44 mm\"] }}, {{ mass = \"0.78 kg\", \
             position = [\"7 mm\", \"-4 mm\"] }}]\nrestitution = 0.21\ncontact_time = \"{contact_ms} ms\"\n\
             contact_law = \"hysteretic\"\n[drop]\nheight = \"0.8 m\"\ntilt = \"2.8 deg\"\ndirection = \"91.4 deg\"\n\
             [[component]]\nname = \"part\"\nposition = [\"0 mm\", \"5 mm\"]\nnatural_frequency = \"347 Hz\"\n\
             damping_ratio = 0.2\nrattle_space = \"2 mm\"\n"
        );
        let file = ProductFile::read(&text, "soft.toml").unwrap_or_else(|faults| panic!("{faults}"));
        let assessment = clatter_assess::assess(&file).expect("an assessment");
        let limit = &assessment.components[0].limits[0];
        (limit.verdict, limit.undecided.iter().map(ToString::to_string).collect::<String>())
    };
    let (verdict, said) = of(2.5);
    assert!(
        verdict == Verdict::Undecided && said.contains("so that corners sink in by the thickness at most"),
        "{said}"
    );
    assert_eq!(of(1.0).0, Verdict::Safe);
}
