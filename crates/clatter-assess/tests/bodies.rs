//! Bodies: all mass and every part lies within the faces, in a file and in code.

use clatter_assess::Note;
use clatter_product::{ContactLaw, DataFault, Error, Law, ProductFile, Side, Spread};

use crate::random::Random;

/// A bar.
const BAR: &str = r#"
[product]
name = "bar"
length = "160 mm"
radius_of_gyration = "45 mm"
center_of_mass = "0 mm"
restitution = 0.3
contact_time = "0.4 ms"
contact_law = "hysteretic"

[drop]
height = "1 m"
tilt = ["1 deg", "5 deg"]

[[component]]
name = "part"
position = "10 mm"
extent = "20 mm"
mount = "hard"
velocity_change_limit = "9 m/s"
"#;

/// A plate.
const PLATE: &str = r#"
[product]
name = "plate"
length = "160 mm"
width = "80 mm"
thickness = "25 mm"
radius_of_gyration = ["45 mm", "22 mm"]
center_of_mass = ["0 mm", "0 mm"]
restitution = 0.3
contact_time = "0.4 ms"

[drop]
height = "1 m"
tilt = ["1 deg", "5 deg"]

[[component]]
name = "part"
position = ["10 mm", "5 mm"]
extent = ["20 mm", "10 mm"]
mount = "hard"
acceleration_limit = "2000 gn"
"#;

/// The plate as a box.
fn a_box() -> String {
    PLATE
        .replace("tilt = [\"1 deg\", \"5 deg\"]", "face = \"bottom\"\nattitude_tolerance = \"2 deg\"")
        .replace("extent = [\"20 mm\", \"10 mm\"]", "height = \"3 mm\"")
}

fn read(text: &str) -> Result<ProductFile, String> {
    ProductFile::read(text, "body.toml").map_err(|faults| faults.to_string())
}

/// Each with what stands at fault and what is said of it.
#[test]
fn impossible_bodies_are_refused_where_they_stand() {
    let box_of = a_box();
    let masses = |masses: &str| format!("masses = [{masses}]");
    let (radius, radii) = (
        "radius_of_gyration = \"45 mm\"\ncenter_of_mass = \"0 mm\"",
        "radius_of_gyration = [\"45 mm\", \"22 mm\"]\ncenter_of_mass = [\"0 mm\", \"0 mm\"]",
    );
    let case = "{ mass = \"100 g\", from = \"-80 mm\", to = \"80 mm\" }";
    let lid = "{ mass = \"100 g\", from = [\"-80 mm\", \"-40 mm\"], to = [\"80 mm\", \"40 mm\"] }";
    #[rustfmt::skip]
    let cases: &[(&str, &str, String, &str, &[&str])] = &[
        (BAR, "\"45 mm\"", "\"200 mm\"".to_owned(), "\"200 mm\"", &["radius of gyration of the mass along the length is 200 mm", "from 8 to 80 mm"]),
        // The least value of a range is possible, the largest is not.
        (BAR, "\"45 mm\"", "[\"70 mm\", \"81 mm\"]".to_owned(), "[\"70 mm\", \"81 mm\"]", &["is 81 mm", "from 8 to 80 mm"]),
        // √(110 · 50) mm = 74.162 mm.
        (BAR, "\"45 mm\"\ncenter_of_mass = \"0 mm\"", "\"75 mm\"\ncenter_of_mass = \"30 mm\"".to_owned(), "\"75 mm\"", &["is 75 mm", "from 8 to 74.162 mm"]),
        (BAR, radius, "mass = \"100 g\"\nmoment_of_inertia = \"0.00065 kg m2\"".to_owned(), "\"0.00065 kg m2\"", &["is 80.623 mm", "from 8 to 80 mm"]),
        (BAR, radius, masses(&format!("{case}, {{ mass = \"10 g\", position = \"81 mm\" }}")), "\"81 mm\"", &["the mass reaches 81 mm from the middle along the length", "up to 80 mm", "within the body"]),
        (BAR, radius, masses(&case.replace("\"-80", "\"-90")), "\"-90 mm\"", &["the mass reaches 90 mm", "up to 80 mm"]),
        (BAR, "\"10 mm\"", "[\"10 mm\", \"71 mm\"]".to_owned(), "[\"10 mm\", \"71 mm\"]", &["with its extent reaches 81 mm from the middle along the length", "up to 80 mm"]),
        (BAR, "contact_time = \"0.4 ms\"\n", String::new(), "contact_law", &["`contact_law` needs the `contact_time`"]),
        (PLATE, "\"22 mm\"]", "\"41 mm\"]".to_owned(), "[\"45 mm\", \"41 mm\"]", &["along the width is 41 mm", "from 4 to 40 mm"]),
        (PLATE, radii, masses(&format!("{lid}, {{ mass = \"10 g\", position = [\"10 mm\", \"-41 mm\"] }}")), "[\"10 mm\", \"-41 mm\"]", &["the mass reaches 41 mm from the middle along the width", "up to 40 mm"]),
        (PLATE, radii, masses(&lid.replace("\"40 mm\"]", "\"50 mm\"]")), "[\"80 mm\", \"50 mm\"]", &["the mass reaches 50 mm", "along the width"]),
        (PLATE, "[\"10 mm\", \"5 mm\"]", "[\"10 mm\", \"36 mm\"]".to_owned(), "[\"10 mm\", \"36 mm\"]", &["reaches 41 mm from the middle along the width", "up to 40 mm"]),
        (&box_of, radii, masses(&lid.replace(" }", ", height = \"13 mm\" }")), "\"13 mm\"", &["the mass reaches 13 mm from the middle along the thickness", "up to 12.5 mm"]),
        (&box_of, "height = \"3 mm\"", "height = \"200 mm\"".to_owned(), "\"200 mm\"", &["reaches 200 mm from the middle along the thickness", "up to 12.5 mm", "within the body"]),
        (&box_of, "\"45 mm\"", "\"81 mm\"".to_owned(), "[\"81 mm\", \"22 mm\"]", &["is 81 mm", "from 8 to 80 mm"]),
    ];
    for (text, from, to, stands, said) in cases {
        assert_eq!(text.matches(from).count(), 1, "{from}");
        let text = text.replace(from, to);
        let faults = ProductFile::read(&text, "body.toml").expect_err(to);
        let [fault] = faults.list() else { panic!("{to}: {faults}") };
        assert_eq!(&text[fault.span.clone()], *stands, "{faults}");
        let told = format!("{}; {}", fault.message, fault.help);
        assert!(said.iter().all(|part| told.contains(part)), "{to}: {told}");
    }
}

/// The same of data that no file was read for: half of each body is what the rules are about.
#[test]
fn impossible_bodies_are_refused_in_code() {
    type Change = fn(&mut ProductFile);
    fn width(file: &mut ProductFile) -> &mut Side {
        file.product.body.width.as_mut().expect("a width")
    }
    fn set_depth(file: &mut ProductFile, center_m: f64, gyration_m: f64) {
        file.product.body.thickness = Some(Side { ends_m: [0.0125 + center_m, 0.0125 - center_m], gyration_m });
    }
    let boxes: &[(Change, &str)] = &[
        (|file| width(file).gyration_m = 0.0401, "along the width is 40.1 mm; allowed: from 4 to 40 mm"),
        (|file| width(file).gyration_m = f64::NAN, "along the width is NaN mm"),
        (|file| set_depth(file, 0.0, 0.0126), "along the thickness is 12.6 mm; allowed: from 0 to 12.5 mm"),
        // √(22.5 · 2.5) mm = 7.5 mm.
        (|file| set_depth(file, 0.010, 0.0076), "along the thickness is 7.6 mm; allowed: from 0 to 7.5 mm"),
        (|file| set_depth(file, 0.0, f64::NAN), "along the thickness is NaN mm"),
        (
            |file| file.product.body.products_m2[0] = 990e-6,
            "inertia xy over the mass is 990 mm2; allowed: from -980.1 to 980.1 mm2",
        ),
        (|file| file.product.body.products_m2[0] = f64::NAN, "inertia xy over the mass is NaN mm2"),
        (
            |file| {
                set_depth(file, 0.0, 0.01);
                file.product.body.products_m2[1] = -460e-6;
            },
            "inertia xz over the mass is -460 mm2; allowed: from -450 to 450",
        ),
        (
            |file| {
                set_depth(file, 0.0, 0.01);
                file.product.body.products_m2[2] = 230e-6;
            },
            "inertia yz over the mass is 230 mm2; allowed: from -220 to 220",
        ),
        // Both ends lean one way, the third the other: with ratios of 0.9, 0.9 and −0.9 no masses have them.
        (
            |file| {
                let (x, y, z) = (45e-3, 22e-3, 10e-3);
                set_depth(file, 0.0, z);
                file.product.body.products_m2 = [0.9 * x * y, 0.9 * x * z, -0.9 * y * z];
            },
            "the products of inertia over the mass are 891, 405 and -198 mm2: no masses have them together",
        ),
        (
            |file| file.components[0].inside.height_m = -0.2,
            "reaches 200 mm from the middle along the thickness; allowed: up to 12.5 mm",
        ),
        (|file| file.components[0].inside.height_m = f64::NAN, "reaches NaN mm from the middle along the thickness"),
        (
            |file| file.product.gyration_m = Spread::new(0.01, 0.0801, Law::Range).expect("a range"),
            "is 80.1 mm; allowed: from 8 to 80 mm",
        ),
    ];
    for (change, said) in boxes {
        let mut file = read(&a_box()).expect("a box");
        change(&mut file);
        let told = file.check().expect_err(said).to_string();
        assert!(told.contains(said), "{told}\n{said}");
        assert_eq!(clatter_assess::assess(&file).expect_err(said).to_string(), told);
    }
    // A center of mass and all of one side's mass next to one end: ∫x y dm is at most that of a corner.
    let mut file = read(&a_box()).expect("a box");
    file.product.body.length.ends_m = [0.14, 0.02];
    width(&mut file).ends_m = [0.02, 0.06];
    let told = |file: &ProductFile, product_m2: f64| {
        let mut file = file.clone();
        file.product.body.products_m2[0] = product_m2;
        file.check().map_err(|error| error.to_string())
    };
    // min(0.14 · 0.06, 0.02 · 0.02) on one side, min(0.14 · 0.02, 0.02 · 0.06) on the other, and 0.99 · 45 · 22 mm².
    assert_eq!([390e-6, -970e-6].map(|product_m2| told(&file, product_m2)), [Ok(()), Ok(())]);
    assert!(told(&file, 410e-6).expect_err("too large").contains("from -980.1 to 400 mm2"));
    let mut file = read(BAR).expect("a bar");
    file.product.contact_time_s = None;
    file.product.contact_law = Some(ContactLaw::Dashpot);
    assert_eq!(file.check(), Err(Error::from(DataFault::LawWithoutTime)));
    file.product.contact_law = None;
    assert_eq!(file.check(), Ok(()));
}

/// All mass at both ends is the most that a body has, but for values of six digits; more is none; also where feet are closer together than the masses.
#[test]
fn all_mass_at_both_ends_is_a_body() {
    for (center, radius) in [("0 mm", 80.0_f64), ("-30 mm", 5500_f64.sqrt())] {
        for (share, is_body) in [(1.0, true), (1.0 + 5e-6, true), (1.0 + 1e-4, false)] {
            let text = BAR.replace("center_of_mass = \"0 mm\"", &format!("center_of_mass = \"{center}\""));
            let text = text.replace("\"45 mm\"", &format!("\"{} mm\"", radius * share));
            assert_eq!(read(&text).is_ok(), is_body, "{text}");
            let feet = text.replace("restitution", "feet_inset = \"20 mm\"\nfeet_height = \"9 mm\"\nrestitution");
            assert_eq!(read(&feet).is_ok(), is_body, "{feet}");
        }
    }
    let both = "masses = [{ mass = \"50 g\", position = \"-80 mm\" }, { mass = \"50 g\", position = \"80 mm\" }]";
    let file = read(&BAR.replace("radius_of_gyration = \"45 mm\"\ncenter_of_mass = \"0 mm\"", both)).expect("a body");
    assert!((file.product.body.gyration_m() - 0.08).abs() < 1e-15);
    // A length of nine digits, and masses at its half.
    let rounded = both.replace("80 mm", "79.9999996 mm");
    let text = BAR
        .replace("160 mm", "159.999999 mm")
        .replace("radius_of_gyration = \"45 mm\"\ncenter_of_mass = \"0 mm\"", &rounded);
    read(&text).expect("a body");
}

/// Masses within a body are one, wherever they lie: of up to four points, often at faces and corners, where the rules are sharp, nothing is
/// refused but what has its center next to an end, hardly any extent along a side, or all of it on a line, which older rules tell.
#[test]
fn masses_within_a_body_are_possible() {
    let mut r = Random(58);
    let mut refused = 0;
    for n in 0..3000 {
        let mut at = |half: f64| {
            if r.unit() < 0.4 { half * if r.unit() < 0.5 { -1.0 } else { 1.0 } } else { r.even(-half, half) }
        };
        let points: Vec<[f64; 3]> = (0..2 + n % 3).map(|_| [at(80.0), at(40.0), at(12.5)]).collect();
        let rows: Vec<String> = points
            .iter()
            .map(|[x, y, z]| {
                let kg = r.decades(1e-3, 1.0);
                format!("{{ mass = \"{kg} kg\", position = [\"{x} mm\", \"{y} mm\"], height = \"{z} mm\" }}")
            })
            .collect();
        let text = a_box().replace(
            "radius_of_gyration = [\"45 mm\", \"22 mm\"]\ncenter_of_mass = [\"0 mm\", \"0 mm\"]",
            &format!("masses = [{}]", rows.join(", ")),
        );
        let Err(told) = read(&text) else { continue };
        refused += 1;
        let is_sharp = told.contains("the center of mass is")
            || told.contains("product of inertia xy")
            || told.contains("radius of gyration") && !told.contains("thickness");
        assert!(is_sharp && !told.contains("no masses have them together"), "{told}");
        if told.contains("radius of gyration") {
            let number =
                |after: &str| told.split(after).nth(1).and_then(|rest| rest.split(' ').next()?.parse::<f64>().ok());
            let (is, least) = (number(" is ").expect("a radius"), number("allowed: from ").expect("the least"));
            assert!(is <= least, "too small, never too large: {told}");
        }
    }
    assert!((1..2000).contains(&refused), "{refused} of 3000");
}

/// A bar is followed without friction: beside one that is tilted by more than 10° a box is followed with friction of 0 and 0.6, and what that
/// asks for more is among what drops may ask. Beside others there is none.
#[test]
fn a_steep_bar_has_a_box_with_friction_beside_it() {
    let of = |tilts: &str| {
        let text = BAR.replace("[\"1 deg\", \"5 deg\"]", tilts).replace("extent = \"20 mm\"\n", "");
        let file = ProductFile::read(&text, "bar.toml").unwrap_or_else(|faults| panic!("{faults}"));
        let assessment = clatter_assess::assess(&file).expect("an assessment");
        let limit = assessment.components[0].limits[0].clone();
        let tilt = |note: &Note| if let Note::Tilt { off, thickness_m: None } = note { Some(*off) } else { None };
        (limit.notes.iter().find_map(tilt), limit.uncertainty)
    };
    assert_eq!(of("[\"1 deg\", \"9.9 deg\"]").0, None);
    let mut most = 0.0_f64;
    for tilts in ["[\"12 deg\", \"20 deg\"]", "[\"20 deg\", \"25 deg\"]", "[\"25 deg\", \"30 deg\"]"] {
        let (off, uncertainty) = of(tilts);
        let off = off.unwrap_or_else(|| panic!("{tilts}: no box beside it"));
        assert!(uncertainty >= off.max(0.0), "{tilts}: {off}, {uncertainty}");
        most = most.max(off.abs());
    }
    assert!(most > 1e-3, "the box says nowhere anything else: {most}");
}
