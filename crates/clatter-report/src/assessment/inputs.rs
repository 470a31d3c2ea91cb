//! This module describes the inputs of an assessment in words: the product, its drop, how a part is held.

use clatter_assess::Assessment;
use clatter_figures::{model_words as model, three};
use clatter_product::{
    Axis, Component, Damping, DropRanges, Fall, First, Mount, OwnContact, ProductFile, Side, Spread, optional_inputs,
};

use crate::Pages;
use crate::words::{end, millimeters, place, range, span, sure_name};

/// Returns a row for each given input: its name and its value.
pub(super) fn rows(file: &ProductFile, assessment: &Assessment) -> Vec<[String; 2]> {
    let product = &file.product;
    let mut rows = Vec::new();
    let mut add = |what: &str, value: String| rows.push([what.to_owned(), value]);
    match &product.body.width {
        None => add("Body", body(file)),
        Some(width) => {
            add("Body", sides(file));
            add("Mass", inertia(file, width));
        }
    }
    add("Restitution", range(&product.restitution, 1.0, ""));
    match product.contact_time_s {
        Some(time) => {
            let who = match (&product.body.feet, &product.body.width) {
                (Some(_), _) => "a foot",
                (None, Some(_)) => "a corner",
                (None, None) => "an end",
            };
            let law = product.law();
            let (own, other) = (law.words(), law.other().words());
            let as_well = match product.contact_law {
                Some(_) => String::new(),
                None => format!("; the file names no law, and a limit has to hold by the other one, {other}, as well"),
            };
            add("Contact", format!("{who} touches for {}; {own}{as_well}", range(&time, 1e-3, "ms")));
        }
        None => add("Contact", "no contact time is given: impacts are instants".to_owned()),
    }
    if let Some(friction) = &product.friction {
        let assumed = if product.is_friction_assumed { ", assumed" } else { "" };
        add("Friction", format!("{}{assumed}", range(friction, 1.0, "")));
    }
    if !product.own_contacts.is_none() {
        add("Own contacts", own_contacts(file));
    }
    add("Drop", drop(file));
    if file.landings.is_empty() {
        add("Tilt", tilt(&file.drop, product.body.is_wide()));
    } else if !file.is_box() {
        add("Drops", format!("{}, each told below", file.landings.len()));
    } else {
        let source = file.landings.iter().find_map(|landing| landing.source);
        let drops = match &file.drop_names()[..] {
            [one] => one.to_string(),
            all => format!("{} of them", all.len()),
        };
        let listed = file.landings.iter().filter(|landing| landing.source.is_some()).count();
        let of = if listed < file.landings.len() { format!(", {listed} of them of") } else { ":".to_owned() };
        add("Lands on", source.map_or(drops.clone(), |source| format!("{drops}{of} {source}")));
    }
    for (row, optional) in optional_inputs() {
        let given = |drop: &DropRanges| row.input.given(product, drop).filter(|_| row.input.is_there(product, drop));
        let name = format!("{}{}", row.words[..1].to_uppercase(), &row.words[1..]);
        if let (true, Some(own)) = (file.landings.is_empty(), given(&file.drop)) {
            add(&name, format!("{} {}", range(&own, 1.0, row.unit), optional.report));
        }
        let each = file.drop_names().into_iter().zip(&file.landings);
        let mut there = each.filter_map(|(name, landing)| Some((name, given(&landing.drop)?)));
        if let Some((drop, first)) = there.next() {
            let alike = file.landings.iter().all(|other| given(&other.drop) == Some(first));
            let of = if alike { String::new() } else { format!(" {}; others otherwise", drop.there()) };
            add(&name, format!("{} at the first touch{of}", range(&first, 1.0, row.unit)));
        }
    }
    let gravity = file.drop.gravity_m_s2;
    add(
        "Gravity",
        if gravity > 0.0 { format!("{} m/s²", three(gravity)) } else { "none after the first touch".to_owned() },
    );
    // It is the same for all limits.
    if let Some(limit) = assessment.components.iter().flat_map(|c| &c.limits).next() {
        let tilt = match (&product.body.width, file.is_box()) {
            (None, _) => "",
            (Some(_), false) => ", lever arms of a level plate",
            (Some(_), true) => ", a box with full rotation",
        };
        rows.push(["Model".to_owned(), format!("{}{tilt}", model(limit.model.bar))]);
    }
    rows
}

/// Describes the tilt at which a bar or a plate lands, and which end, edge or corner lands first.
fn tilt(drop: &DropRanges, is_plate: bool) -> String {
    format!("{} at the first touch, {}", degrees(&drop.tilt_rad), first(drop, is_plate))
}

/// Names the end, edge or corner of a bar or a plate that lands first.
pub(super) fn first(drop: &DropRanges, is_plate: bool) -> String {
    match (drop.first, &drop.direction_rad) {
        (First::End(first), _) => format!("end {} first", end(first)),
        (First::Either, None) if is_plate => "rising to any direction".to_owned(),
        (First::Either, None) => "either end first".to_owned(),
        (First::Either, Some(given)) => format!("rising to {}", degrees(given)),
    }
}

fn degrees(of: &Spread) -> String {
    range(of, 1f64.to_radians(), "°").replace(" °", "°")
}

/// Describes how the assessment was made, for the foot of each page: from which file, how exactly, and on which day where that is printed.
pub(super) fn made(pages: &Pages<'_>) -> String {
    let share = three(100.0 * pages.assessment.accuracy.tolerance);
    let day = pages.date.map_or_else(String::new, |date| format!(" on {date}"));
    format!("assessed{day} from {}, each drop to {share} %,", sure_name(pages.path))
}

/// Describes length, inertia and center of mass.
fn body(file: &ProductFile) -> String {
    let body = &file.product.body;
    let [a, b] = body.arms_m();
    let center = 0.5 * (a - b);
    let off = if center.abs() > 1e-9 * (a + b) {
        format!(", center of mass {} from the middle", millimeters(center))
    } else {
        String::new()
    };
    let mass = file.product.mass_kg.map_or(String::new(), |kg| format!(", {} kg", three(kg)));
    format!(
        "length {}{}, radius of gyration {}{off}{mass}: inertia ratio q = {}",
        millimeters(file.product.sides_m()[0]),
        feet(file),
        range(&file.product.gyration_m, 1e-3, "mm"),
        ratio(file),
    )
}

/// Describes the feet that a product lands on, where it does not land on its ends or corners.
fn feet(file: &ProductFile) -> String {
    let Some(feet) = &file.product.body.feet else { return String::new() };
    let ([x, y], high) = (feet.inset_m.map(millimeters), millimeters(feet.height_m));
    let inside = if file.product.body.is_wide() { format!("{x} and {y}") } else { x };
    format!(", on feet {inside} inside the edges and {high} high")
}

/// Describes the contacts with values of their own.
fn own_contacts(file: &ProductFile) -> String {
    let place = if file.product.body.is_wide() { "corner" } else { "end" };
    let one = |(at, own): (&str, OwnContact)| {
        let e = own.restitution.map(|e| format!("restitution {}", three(e)));
        let time = own.contact_time_s.map(|time_s| format!("touches for {} ms", three(1e3 * time_s)));
        format!("{place} {at}: {}", e.into_iter().chain(time).collect::<Vec<_>>().join(", "))
    };
    file.product.own_contacts.given().map(one).collect::<Vec<_>>().join("; ")
}

/// Describes the sides of a plate.
fn sides(file: &ProductFile) -> String {
    let thick = file.product.body.thickness;
    let thick = thick.map_or(String::new(), |side| format!(", thickness {}", millimeters(side.m())));
    let [length, across] = file.product.sides_m().map(millimeters);
    format!("length {length}, width {across}{thick}{}", feet(file))
}

/// Describes the mass of a plate, and where it lies.
fn inertia(file: &ProductFile, width: &Side) -> String {
    let mut said: Vec<String> = file.product.mass_kg.iter().map(|kg| format!("{} kg", three(*kg))).collect();
    let along = range(&file.product.gyration_m, 1e-3, "mm");
    said.push(format!("radii of gyration {along} along the length, {} along the width", millimeters(width.gyration_m)));
    let body = &file.product.body;
    let center = [body.length.center_m(), width.center_m()];
    if center[0].abs() > 1e-9 * body.length_m() || center[1].abs() > 1e-9 * width.m() {
        said.push(format!("center of mass at {}", place(center)));
    }
    if body.products_m2[0] != 0.0 {
        let of = three(1e6 * body.products_m2[0]).replace('-', "−");
        said.push(format!("product of inertia over the mass {of} mm²"));
    }
    said.join(", ")
}

/// Writes the inertia ratio, or its range for a range of radii of gyration.
fn ratio(file: &ProductFile) -> String {
    let [lo, hi] = [1.0, 0.0].map(|share| three(file.product.inertia_ratio_at(share)).replace('-', "−"));
    if lo == hi { lo } else { format!("{lo} to {hi}") }
}

/// Describes the fall.
fn drop(file: &ProductFile) -> String {
    if file.landings.iter().any(|landing| landing.drop.fall != file.drop.fall) {
        let speeds = file.landings.iter().map(|landing| landing.drop.speeds_m_s());
        let widest = speeds.reduce(|[lo, hi], [slow, fast]| [lo.min(slow), hi.max(fast)]).unwrap_or_default();
        let is_high = |landing: &clatter_product::Landing| matches!(landing.drop.fall, Fall::HeightM(_));
        let each = if file.landings.iter().all(is_high) { "each from its own height" } else { "each for itself" };
        return format!("{each}, at {}", span(widest, 1.0, "m/s"));
    }
    match file.drop.fall {
        Fall::HeightM(height) => {
            format!("from {}, which gives {}", range(&height, 1.0, "m"), span(file.drop.speeds_m_s(), 1.0, "m/s"))
        }
        Fall::SpeedMS(speed) => format!("at {}", range(&speed, 1.0, "m/s")),
    }
}

/// Describes where a part sits and how it is held, in a sentence.
pub(super) fn held(component: &Component, file: &ProductFile) -> String {
    if file.product.body.is_wide() {
        let along = match component.inside.axis {
            Axis::Z if file.is_box() => " It moves along the thickness.",
            Axis::Z => "",
            Axis::X => " It moves along the length.",
            Axis::Y => " It moves along the width.",
            Axis::Any => " The magnitude of what it feels counts.",
        };
        return format!("It sits {}. {}{along}", on_plate(component), mount(component));
    }
    let [lo, hi] = [component.position_m.lo(), component.position_m.hi()];
    let place = if lo < hi {
        format!("anywhere from {} to {} along the product", millimeters(lo), millimeters(hi))
    } else if lo == 0.0 {
        "in the middle".to_owned()
    } else {
        format!("{} from the middle, towards end {}", millimeters(lo.abs()), if lo < 0.0 { "a" } else { "b" })
    };
    let extent = if component.extent_m > 0.0 {
        format!(", and is {} long", millimeters(component.extent_m))
    } else {
        String::new()
    };
    format!("It sits {place}{extent}. {}", mount(component))
}

/// Describes where a part of a plate sits, from the middle of the plate.
fn on_plate(component: &Component) -> String {
    let middle = [component.position_m, component.across_m];
    let where_to = if middle.iter().all(Spread::is_value) {
        format!("at {}", place(middle.map(|side| side.lo())))
    } else {
        let [along, across] = middle.map(|side| range(&side, 1e-3, "mm"));
        format!("anywhere within {along} along the length and {across} along the width")
    };
    let extents = [component.extent_m, component.extent_across_m];
    if extents.iter().all(|extent| *extent == 0.0) {
        return where_to;
    }
    let [along, across] = extents.map(millimeters);
    format!("{where_to}, and is {along} by {across}")
}

fn mount(component: &Component) -> String {
    match &component.mount {
        Mount::Hard => "It is mounted rigidly.".to_owned(),
        Mount::Suspended { frequency_hz, damping } => {
            let damping = match damping {
                Damping::Ratio(ratio) => format!("a damping ratio of {}", range(ratio, 1.0, "")),
                Damping::Quality(quality) => format!("a quality factor of {}", range(quality, 1.0, "")),
            };
            let stops = component.stops.map_or(String::new(), |stops| {
                let [gap, time, e] = stops.ranges();
                format!(
                    " It has stops at {}, with contacts of {} and a restitution of {}.",
                    range(gap, 1e-3, "mm"),
                    range(time, 1e-3, "ms"),
                    range(e, 1.0, "")
                )
            });
            format!("Its natural frequency is {}, with {damping}.{stops}", range(frequency_hz, 1.0, "Hz"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXAMPLE: &str = include_str!("../../../../tests/cases/bar-handheld.toml");

    #[test]
    fn what_the_file_gives_is_told() {
        let file = ProductFile::read(EXAMPLE, "example.toml").unwrap();
        let assessment = clatter_assess::assess(&file).unwrap();
        let pages = Pages {
            file: &file,
            assessment: &assessment,
            portraits: &[],
            remedies: &[],
            measured: &[],
            path: "a\u{485}.toml",
            date: Some("2026-03-31"),
        };
        let told: Vec<String> =
            rows(&file, &assessment).into_iter().map(|[what, value]| format!("{what}: {value}")).collect();
        assert_eq!(
            told,
            [
                "Body: length 140 mm, radius of gyration 38 mm: inertia ratio q = 0.545",
                "Restitution: 0.25 to 0.4",
                "Contact: an end touches for 0.4 ms; hysteretic, with the largest force of a half-sine; the file names no law, and a \
                 limit has to hold by the other one, spring and dashpot, as well",
                "Drop: from 1.2 m, which gives 4.85 m/s",
                "Tilt: 1 to 10° at the first touch, either end first",
                "Gravity: 9.81 m/s²",
                "Model: compliant",
            ]
        );
        assert_eq!(made(&pages), "assessed on 2026-03-31 from a□.toml, each drop to 1 %,");
        assert_eq!(made(&Pages { date: None, ..pages }), "assessed from a□.toml, each drop to 1 %,");
        let parts: Vec<String> = file.components.iter().map(|component| held(component, &file)).collect();
        assert!(parts[0].ends_with("and is 80 mm long. Its natural frequency is 220 Hz, with a quality factor of 12."));
        assert_eq!(parts[2], "It sits 20 mm from the middle, towards end a. It is mounted rigidly.");
        let stop = "quality_factor = 12\nstop = { gap = \"1 mm\", contact_time = [\"0.3 ms\", \"0.8 ms\"], restitution = 0.4 }";
        let file = ProductFile::read(&EXAMPLE.replace("quality_factor = 12", stop), "stop.toml").unwrap();
        let told = held(&file.components[0], &file);
        assert!(
            told.ends_with("It has stops at 1 mm, with contacts of 0.3 to 0.8 ms and a restitution of 0.4."),
            "{told}"
        );
    }

    /// Four masses at the corners of 60 mm × 20 mm, three times as heavy on one diagonal: Σ m x y/Σ m = ½ · 30 mm · 10 mm. From 0.5 m and 1 m
    /// it comes down at √(2 g h).
    #[test]
    fn a_box_tells_its_masses_and_its_speeds() {
        let text = r#"
product = { name = "box", length = "80 mm", width = "40 mm", thickness = "20 mm", restitution = 0.4, contact_time = "0.4 ms", masses = [
    { mass = "30 g", position = ["30 mm", "10 mm"] }, { mass = "30 g", position = ["-30 mm", "-10 mm"] },
    { mass = "10 g", position = ["30 mm", "-10 mm"] }, { mass = "10 g", position = ["-30 mm", "10 mm"] },
] }
drop = [{ height = "1 m", face = "bottom" }, { height = "0.5 m", face = "top" }]
component = [{ name = "part", position = ["0 mm", "0 mm"], mount = "hard", velocity_change_limit = "9 m/s" }]
"#;
        let file = ProductFile::read(text, "box.toml").unwrap_or_else(|faults| panic!("{faults}"));
        let of = inertia(&file, &file.product.body.width.unwrap());
        assert!(of.contains("0.08 kg, radii of gyration 30 mm along the length, 10 mm along the width"), "{of}");
        assert!(of.ends_with("product of inertia over the mass 150 mm²"), "{of}");
        assert_eq!(drop(&file), "each from its own height, at 3.13 to 4.43 m/s");
    }
}
