//! Bad product files: every fault is told, with the value, its place and what is allowed, all at once.

use clatter_product::{Faults, LimitKind, ProductFile};

/// A bar.
const EXAMPLE: &str = include_str!("../../../tests/cases/bar-handheld.toml");

fn faults(text: &str) -> Faults {
    ProductFile::read(text, "product.toml").expect_err("a bad file")
}

/// The example with one line replaced by others.
fn with(line: &str, other: &str) -> String {
    assert_eq!(EXAMPLE.matches(line).count(), 1, "{line:?} once in the example");
    EXAMPLE.replace(line, other)
}

/// Each row: a line of the example, what stands there instead, the column of the fault and what has to be said.
#[rustfmt::skip]
const WRONG: &[(&str, &str, usize, &[&str])] = &[
    ("length = \"140 mm\"", "length = \"140 kg\"", 10, &["\"kg\" is no unit of length", "m, mm, cm", "from 1 mm to 100 m"]),
    ("length = \"140 mm\"", "length = \"140\"", 10, &["\"140\" has no unit"]),
    ("length = \"140 mm\"", "length = 140", 10, &["`length` = 140 has no unit", "\"70 mm\""]),
    ("length = \"140 mm\"", "length = true", 10, &["`length` cannot be this boolean", "a length such as \"70 mm\""]),
    ("length = \"140 mm\"", "length = \"0.1 mm\"", 10, &["\"0.1 mm\" is out of its range", "from 1 mm to 100 m"]),
    ("length = \"140 mm\"", "lenght = \"140 mm\"", 1, &["has no key `lenght`", "did you mean `length`?"]),
    ("length = \"140 mm\"", "length = \"140 mm\"\nfriction = 0.3", 1, &["`friction` is followed of boxes alone", "leave it out"]),
    ("radius_of_gyration = \"38 mm\"", "radius_of_gyration = \"nan mm\"", 22, &["does not begin with a number"]),
    ("radius_of_gyration = \"38 mm\"", "radius_of_gyration = \"500 mm\"", 22, &["500 mm", "from 7 to 70 mm"]),
    ("radius_of_gyration = \"38 mm\"", "moment_of_inertia = \"2 kg cm2\"", 21, &["needs the `mass`"]),
    ("restitution = [0.25, 0.4]", "restitution = [0.25, 1.5]", 22, &["1.5", "from 0 to 1"]),
    ("restitution = [0.25, 0.4]", "restitution = [0.4, 0.25]", 15, &["begins above its end"]),
    ("restitution = [0.25, 0.4]", "restitution = \"0.3\"", 15, &["`restitution` cannot be \"0.3\"", "a number such as 0.3"]),
    ("restitution = [0.25, 0.4]", "restitution = nan", 15, &["does not begin with a number", "from 0 to 1"]),
    ("restitution = [0.25, 0.4]", "restitution = { normal = [0.3, 0.1] }", 15, &["no `range`"]),
    ("restitution = [0.25, 0.4]", "restitution = { normal = [0.3, 0], range = [0, 1] }", 15, &["a deviation is positive"]),
    ("restitution = [0.25, 0.4]", "restitution = { gamma = [0.3, 0.1] }", 17, &["`gamma` is no part of one", "triangular"]),
    ("height = \"1.2 m\"", "height = \"1.2 m\"\nspeed = \"5 m/s\"", 1, &["more than one of `height`, `speed`"]),
    ("height = \"1.2 m\"", "gravity = \"0 gn\"\nheight = \"1.2 m\"", 10, &["nothing falls", "`speed`"]),
    ("height = \"1.2 m\"", "gravity = \"1 lb\"\nspeed = \"1 m/s\"", 11, &["\"lb\" is no unit of acceleration", "m/s2, gn, g, G", "expected an acceleration such as \"400 gn\""]),
    ("tilt = [\"1 deg\", \"10 deg\"]", "tilt = [\"1 deg\", \"40 deg\"]", 8, &["`tilt` = 40 deg is out", "from 0 deg to 30 deg"]),
    ("tilt = [\"1 deg\", \"10 deg\"]", "tilt = [\"1 deg\"]", 8, &["a list of 2", "\"5 deg\""]),
    ("first = \"either\"", "first = \"c\"", 9, &["\"c\"", "\"a\", \"b\", \"either\""]),
    ("position = \"10 mm\"", "position = \"50 mm\"", 12, &["90 mm from the middle", "up to 70 mm"]),
    ("quality_factor = 12", "", 1, &["none of `damping_ratio`, `quality_factor`"]),
    ("quality_factor = 12", "quality_factor = 12\ndamping_ratio = 0.1", 1, &["more than one"]),
    ("quality_factor = 12", "quality_factor = 1e308", 18, &["`quality_factor` = 1e308 is out of its range"]),
    ("quality_factor = 12", "quality_factor = 0", 18, &["`quality_factor` = 0 is out of its range", "from 0.005"]),
    ("quality_factor = 12", "quality_factor = 12\nstop = { gap = \"0 mm\", contact_time = \"1 ms\", restitution = 0.4 }", 16, &["\"0 mm\" is out of its range", "from 1e-3 um"]),
    ("quality_factor = 12", "quality_factor = 12\nstop = { gap = \"9 mm\", contact_time = \"1 ms\", restitution = 0.4 }", 8, &["`gap` of the stop is 9 mm", "up to 8 mm, the `rattle_space`"]),
    ("quality_factor = 12", "quality_factor = 12\nstop = { gap = \"1 mm\", contact_time = \"0 ms\", restitution = 0.4 }", 39, &["\"0 ms\" is out of its range", "from 1 us"]),
    ("quality_factor = 12", "quality_factor = 12\nstop = { gap = \"1 mm\", contact_time = \"5 ms\", restitution = 0.4 }", 8, &["lasts 5 ms", "up to 4.545 ms, the period"]),
    ("quality_factor = 12", "quality_factor = 12\nstop = { gap = \"1 mm\", contact_time = \"1 ms\" }", 8, &["`restitution`"]),
    ("quality_factor = 12", "quality_factor = 12\nstop = { gap = \"1 mm\", contact_time = \"1 ms\", restitution = nan }", 61, &["does not begin with a number", "from 0 to 1"]),
    ("quality_factor = 12", "quality_factor = 12\nstop_speed_limit = \"1 m/s\"", 20, &["without a `stop` has no `stop_speed_limit`"]),
    ("mount = \"hard\"", "mount = \"hard\"\nstop = { gap = \"1 mm\", contact_time = \"1 ms\", restitution = 0.4 }", 1, &["a hard-mounted part has no `stop`"]),
    ("mount = \"hard\"", "mount = \"hard\"\nrattle_space = \"1 mm\"", 1, &["a hard-mounted part has no `rattle_space`"]),
    ("mount = \"hard\"", "", 1, &["no `natural_frequency`", "mount = \"hard\""]),
    ("name = \"crystal\"", "name = \"\"", 8, &["`name` is empty"]),
    ("acceleration_limit = \"1600 gn\"\nrattle_space = \"8 mm\"", "", 1, &["has no limit", "at least one of"]),
    ("contact_time = \"0.4 ms\"", "contact_time = \"400 gn\"", 16, &["\"gn\" is no unit of time", "s, ms"]),
    ("[drop]", "[verdict]\nreliability = 0\n[drop]", 15, &["`reliability` = 0 is out of its range", "from 1 % to 99.999 %"]),
    ("[drop]", "[verdict]\nreliability = 99\n[drop]", 15, &["`reliability` = 99 is out of its range", "from 1 % to 99.999 %"]),
    ("[drop]", "[verdict]\nreliability = \"100 %\"\n[drop]", 15, &["\"100 %\" is out of its range", "from 1 % to 99.999 %"]),
    ("[drop]", "[verdict]\nreliability = \"99\"\n[drop]", 15, &["`reliability` cannot be \"99\"", "a share below 1 such as 0.99"]),
    ("[drop]", "[verdict]\nreliability = nan\n[drop]", 15, &["does not begin with a number", "from 1 % to 99.999 %"]),
    ("[drop]", "[verdict]\nreliability = 0.9\nconfidence = 1\n[drop]", 14, &["`confidence` = 1 is out of its range"]),
    ("[drop]", "[verdict]\nconfidence = 0.9\n[drop]", 1, &["[verdict] has no `reliability`"]),
    ("[drop]", "[drop", 6, &["invalid TOML"]),
    ("mount = \"hard\"", "mount = \"hard\"\nacceleration_limit = \"-3 gn\"", 22, &["\"-3 gn\" is out of its range", "1e-3 gn"]),
];

#[test]
fn each_fault_is_told_where_it_stands() {
    let mut wrong = Vec::new();
    for (line, other, column, said) in WRONG {
        let faults = faults(&with(line, other));
        let text = faults.to_string();
        let [fault] = faults.list() else {
            wrong.push(format!("{other}: {} faults\n{text}\n", faults.list().len()));
            continue;
        };
        let place = faults.place(fault);
        let located = text.contains(&format!("product.toml:{}:{}", place.0, place.1));
        if place.1 != *column || !located || said.iter().any(|part| !text.contains(part)) {
            wrong.push(format!("{other}: at {place:?}\n{text}\n"));
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), WRONG.len(), wrong.join("\n"));
}

#[test]
fn units_are_read_as_people_write_them() {
    let read = |line: &str, other: &str| ProductFile::read(&with(line, other), "p").unwrap_or_else(|f| panic!("{f}"));
    let limit = |text: &str| {
        let file = read("acceleration_limit = \"1600 gn\"", &format!("acceleration_limit = \"{text}\""));
        *file.components[0].limits.get(LimitKind::Acceleration).unwrap()
    };
    for text in ["1600 g", "1600G", "1600 gn", "15690.64 m/s^2", "15690.64 m/s²", "15690.64 m/s2"] {
        assert!((limit(text).lo() / 15_690.64 - 1.0).abs() < 1e-12, "{text}");
    }
    let told = [limit("1600 G"), limit("15690.64 m/s2")].map(|limit| limit.unit().map(|unit| unit.name));
    assert_eq!(told, [Some("gn"), Some("m/s2")], "answers are given in the unit of the file, by its first spelling");
    let inertia = "mass = \"190 g\"\nmoment_of_inertia = \"274.36 kg*mm^2\"";
    let body = read("radius_of_gyration = \"38 mm\"", inertia).product.body;
    assert!((body.gyration_m() / 0.038 - 1.0).abs() < 1e-12, "{}", body.gyration_m());
    let e = read("restitution = [0.25, 0.4]", "restitution = [\"25 %\", \"40%\"]").product.restitution;
    assert_eq!((e.lo(), e.hi()), (0.25, 0.4));
}

#[test]
fn components_of_one_name_are_refused_with_both_lines() {
    let faults = faults(&with("name = \"crystal\"", "name = \" display\""));
    let text = faults.to_string();
    assert_eq!(faults.list().len(), 1, "{text}");
    let lines: Vec<_> = text.lines().filter(|line| line.contains("name = \"")).collect();
    assert!(
        matches!(lines[..], [first, second] if first.contains("\"display\"") && second.contains("\" display\"")),
        "{text}"
    );
    assert!(text.contains("two components are named \"display\"") && text.contains("the first"), "{text}");
}

#[test]
fn what_is_likely_a_slip_is_a_warning_that_names_it() {
    let (_, none) = ProductFile::read_warned(EXAMPLE, "product.toml").unwrap();
    assert!(none.list().is_empty() && none.warnings().is_empty(), "{none}");
    for (line, other, said) in [
        (
            "height = \"1.2 m\"",
            "height = \"120 m\"",
            ["a height of 120 m is none that products have, from 1 mm to 50 m", "120 mm?"],
        ),
        (
            "damping_ratio = 0.1",
            "damping_ratio = 10",
            ["a damping ratio of 10 is none that products have, from 0 to 1.5", "10 %?"],
        ),
        ("contact_time = \"0.4 ms\"", "contact_time = [\"0.4 ms\", \"90 ms\"]", ["a contact time of 90 ms", "90 us?"]),
    ] {
        let (_, odd) = ProductFile::read_warned(&with(line, other), "product.toml").unwrap();
        let told = odd.to_string();
        assert!(told.starts_with("warning: ") && said.iter().all(|part| told.contains(part)), "{other}: {told}");
        assert!(told.contains("product.toml:") && odd.warnings().len() == 1, "{told}");
    }
}

#[test]
fn all_faults_of_a_file_are_told_at_once_in_its_order() {
    let rows: Vec<_> =
        WRONG.iter().filter(|row| ["length = 140", "restitution = nan", "first = \"c\""].contains(&row.1)).collect();
    let text = rows.iter().fold(EXAMPLE.to_owned(), |text, row| text.replace(row.0, row.1));
    let faults = faults(&text);
    let lines: Vec<_> = faults.list().iter().map(|fault| faults.place(fault).0).collect();
    assert_eq!(lines.len(), 3, "{faults}");
    assert!(lines.is_sorted(), "{lines:?}");
    assert_eq!(faults.to_string().matches("error: ").count(), 3, "{faults}");
}

#[test]
fn stiff_and_hard_mounted_parts_need_the_contact_time() {
    let without = with("contact_time = \"0.4 ms\"", "");
    // The display is at 220 Hz, the camera at most at 110 Hz, and of the crystal only shocks are asked: none is stiff.
    assert!(ProductFile::read(&without, "p").is_ok());
    let stiff = without.replace("220 Hz", "900 Hz");
    let hard = without.replace("mount = \"hard\"", "mount = \"hard\"\nacceleration_limit = \"9000 gn\"");
    for (text, name) in [(stiff, "natural_frequency = \"900 Hz\""), (hard, "mount = \"hard\"")] {
        let faults = faults(&text);
        let shown = faults.to_string();
        assert_eq!(faults.list().len(), 1, "{shown}");
        assert!(
            shown.contains("needs the contact time") && shown.contains("contact_time = ") && shown.contains(name),
            "{shown}"
        );
    }
}

#[test]
fn files_that_are_too_large_are_refused_unread() {
    let faults = faults(&"#".repeat(clatter_product::LARGEST_FILE + 1));
    assert!(faults.to_string().contains("1048577 bytes"), "{faults}");
}

#[test]
fn names_of_any_kind_and_length_are_accepted_as_they_are() {
    let long = "x".repeat(100_000);
    for name in ["<b>#[*_$`\\\\\\\"", "קטן\u{202e}abc", "\\u0000\\u001b[31m", long.as_str()] {
        let file = ProductFile::read(&with("\"Handheld\"", &format!("\"{name}\"")), "p").unwrap();
        assert!(!file.product.name.is_empty());
    }
    let faults = faults(&with("length = \"140 mm\"", &format!("{long} = \"{long}\"")));
    assert!(faults.to_string().len() < 20_000, "a long line is cut: {} bytes", faults.to_string().len());
}

/// A part lies within the product along each of its sides, with all of its extent.
#[test]
fn a_part_beyond_a_side_of_a_plate_is_told() {
    let part = |position: &str| {
        format!(
            "[product]\nname = \"Plate\"\nlength = \"150 mm\"\nwidth = \"70 mm\"\nradius_of_gyration = [\"43 mm\", \"20 mm\"]\n\
             restitution = 0.3\ncontact_time = \"0.4 ms\"\n[drop]\nheight = \"1 m\"\ntilt = \"3 deg\"\n[[component]]\n\
             name = \"part\"\nposition = [{position}]\nextent = [\"4 mm\", \"10 mm\"]\nmount = \"hard\"\n\
             acceleration_limit = \"900 gn\"\n"
        )
    };
    assert!(ProductFile::read(&part("\"73 mm\", \"30 mm\""), "plate.toml").is_ok());
    for (position, said) in [("\"73 mm\", \"31 mm\"", "up to 35 mm"), ("\"74 mm\", \"30 mm\"", "up to 75 mm")] {
        let told = faults(&part(position)).to_string();
        assert!(told.contains(said), "{position}: {told}");
    }
}
