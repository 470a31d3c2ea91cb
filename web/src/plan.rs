//! This module finds the places of the parts and masses of a product, and changes the text of its file where one of them is moved.

use std::ops::Range;

use clatter_product::{
    Component,
    units::{LENGTH, Unit},
};
use serde::{Deserialize, Serialize};
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::{Reply, products, text};

/// A part or a mass, by its place in the file.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Item {
    Component(usize),
    Mass(usize),
}

/// The data of the plan that is drawn.
#[derive(Debug, Serialize)]
struct Plan {
    product: String,
    length_m: f64,
    /// The width; none of a bar.
    width_m: Option<f64>,
    center_m: [f64; 2],
    /// The inertia ratio of the symmetric bar with the same clatter, for the middle of the range of the restitution.
    q: Option<f64>,
    e: f64,
    /// True where there is a quicker answer than the one that the file requests.
    quick: bool,
    components: Vec<Place>,
    masses: Vec<Place>,
}

/// A rectangle, from where to where along and across; of a bar nothing is across.
#[derive(Debug, Serialize)]
struct Place {
    name: String,
    along_m: [f64; 2],
    across_m: Option<[f64; 2]>,
}

/// Makes the plan of a product, with the oddities of its file.
pub(crate) fn plan(name: &str, given: &str) -> Result<Reply, String> {
    let (file, warnings) = products::read(name, given)?;
    let body = &file.product.body;
    let [a, b] = body.arms_m();
    let (width, sides_m) = (file.product.body.width, file.product.sides_m());
    let e = file.product.restitution.at(0.5);
    let bar = clatter::Bar::from_arms([a, b], body.gyration_m(), e);
    let plan = Plan {
        product: file.product.name.clone(),
        length_m: sides_m[0],
        width_m: width.map(|_| sides_m[1]),
        center_m: [0.5 * (a - b), width.map_or(0.0, |width| width.center_m())],
        q: bar.ok().map(|bar| bar.q()),
        e,
        quick: file.product.contact_time_s.is_some(),
        components: file.components.iter().map(|part| component(part, width.is_some())).collect(),
        masses: masses(given, width.is_some()),
    };
    Ok(Reply { warnings, ..Reply::shown(plan)? })
}

fn component(part: &Component, has_width: bool) -> Place {
    let along_m = reach([part.position_m.lo(), part.position_m.hi()], part.extent_m);
    let across_m = has_width.then(|| reach([part.across_m.lo(), part.across_m.hi()], part.extent_across_m));
    Place { name: part.name.clone(), along_m, across_m }
}

fn reach([low, high]: [f64; 2], extent: f64) -> [f64; 2] {
    [low - 0.5 * extent, high + 0.5 * extent]
}

/// Returns the masses as the file lists them; of a falling body only their combined effect is known.
fn masses(given: &str, has_width: bool) -> Vec<Place> {
    let Ok(table) = DeTable::parse(given) else { return Vec::new() };
    let Some(list) = listed(table.get_ref(), Item::Mass(0)) else { return Vec::new() };
    let place = |mass: &Spanned<DeValue<'_>>| {
        let mass = mass.get_ref().as_table()?;
        let of = |key: &str| mass.get(key).map(|value| lengths(value).iter().map(|place| place.si).collect::<Vec<_>>());
        let (from, to) = of("position").map(|at| (at.clone(), at)).or_else(|| of("from").zip(of("to")))?;
        let side = |n: usize| Some([*from.get(n)?, *to.get(n)?]);
        let name = mass.get("name").and_then(|name| name.get_ref().as_str()).unwrap_or("mass").to_owned();
        Some(Place { name, along_m: side(0)?, across_m: if has_width { side(1) } else { None } })
    };
    // The file was read: each mass has its place.
    list.iter().filter_map(place).collect()
}

/// Returns the text with a part or a mass moved along and across, in m: each length of its place in its own unit, all else as it stood.
///
/// # Errors
/// A file that cannot be read, or without such a part.
pub(crate) fn moved(given: &str, item: Item, by: [f64; 2]) -> Result<String, String> {
    let table = DeTable::parse(given).map_err(text)?;
    let number = match item {
        Item::Component(number) | Item::Mass(number) => number,
    };
    let found = listed(table.get_ref(), item).and_then(|list| list.get(number));
    let found = found.and_then(|found| found.get_ref().as_table()).ok_or("the file has no such part")?;
    let has_width = table.get_ref().get("product").and_then(|of| of.get_ref().as_table());
    let has_width = has_width.is_some_and(|of| of.contains_key("width"));
    let mut edits = Vec::new();
    for value in ["position", "from", "to"].iter().filter_map(|key| found.get(*key)) {
        match (value.get_ref(), has_width) {
            (DeValue::Array(sides), true) => {
                sides.iter().zip(by).for_each(|(side, by)| edits.extend(shifted(side, by)));
            }
            _ => edits.extend(shifted(value, by[0])),
        }
    }
    edits.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    let mut text = given.to_owned();
    for (span, value) in edits {
        text.replace_range(span, &value);
    }
    Ok(text)
}

/// Returns so much of a move as keeps a part or a mass on the product, in whole thousandths of a millimeter, to which a text is written; of
/// a text that cannot be read, in which it may be beyond the edge already, all.
pub(crate) fn within(given: &str, item: Item, by: [f64; 2]) -> [f64; 2] {
    let Ok((file, _)) = products::read("", given) else { return by };
    let has_width = file.product.body.width.is_some();
    let place = match item {
        Item::Component(number) => file.components.get(number).map(|part| component(part, has_width)),
        Item::Mass(number) => masses(given, has_width).into_iter().nth(number),
    };
    let Some(Place { along_m, across_m, .. }) = place else { return by };
    let [length_m, width_m] = file.product.sides_m();
    // What roundings leave out of a whole one is none.
    let whole = |room_m: f64| 1e-6 * (1e6 * room_m + 1e-3).floor().max(0.0);
    let stopped =
        |by: f64, [low, high]: [f64; 2], side_m: f64| by.clamp(-whole(low + 0.5 * side_m), whole(0.5 * side_m - high));
    [stopped(by[0], along_m, length_m), across_m.map_or(by[1], |across_m| stopped(by[1], across_m, width_m))]
}

fn listed<'a>(table: &'a DeTable<'a>, item: Item) -> Option<&'a DeArray<'a>> {
    match item {
        Item::Component(_) => table.get("component")?.get_ref().as_array(),
        Item::Mass(_) => table.get("product")?.get_ref().as_table()?.get("masses")?.get_ref().as_array(),
    }
}

/// Returns the edits that move a length in the text: the range and the new text of each.
fn shifted(value: &Spanned<DeValue<'_>>, by_m: f64) -> Vec<(Range<usize>, String)> {
    let edit = |Length { si, unit, span }| {
        // The digits go to a thousandth of a millimeter.
        let digits = (0..9).find(|digits| unit.to_si(10f64.powi(-digits)) < 1.01e-6).unwrap_or(9);
        let digits = usize::try_from(digits).unwrap_or(0);
        let number = format!("{:.digits$}", unit.of_si(si + by_m));
        let number = if digits > 0 { number.trim_end_matches('0').trim_end_matches('.') } else { &number };
        let number = if number == "-0" { "0" } else { number };
        (span, format!("\"{number} {}\"", unit.name))
    };
    if by_m == 0.0 { Vec::new() } else { lengths(value).into_iter().map(edit).collect() }
}

/// A length and where it stands.
struct Length {
    si: f64,
    unit: &'static Unit,
    span: Range<usize>,
}

/// Finds the places within a value: itself, the ends of a range, or those of a distribution; a deviation is none.
fn lengths(value: &Spanned<DeValue<'_>>) -> Vec<Length> {
    match value.get_ref() {
        DeValue::String(text) => {
            let length = LENGTH.read(text).ok().and_then(|read| Some((read.si, read.unit?)));
            length.map(|(si, unit)| Length { si, unit, span: value.span() }).into_iter().collect()
        }
        DeValue::Array(items) => items.iter().flat_map(lengths).collect(),
        DeValue::Table(law) => {
            let of = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| {
                let mut found = lengths(value);
                if *key.get_ref() == "normal" {
                    found.truncate(1);
                }
                found
            };
            law.iter().flat_map(of).collect()
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::products::WORKED;

    /// Returns the lines that differ, in their new form.
    fn changed(before: &str, after: &str) -> Vec<String> {
        assert_eq!(before.lines().count(), after.lines().count(), "no line is added or lost");
        before.lines().zip(after.lines()).filter(|(old, new)| old != new).map(|(_, new)| new.to_owned()).collect()
    }

    fn worked(name: &str) -> &'static str {
        WORKED.iter().find(|[other, _]| *other == name).unwrap()[1]
    }

    #[test]
    fn a_part_and_a_mass_are_moved_and_all_else_stands() {
        let bar = worked("scanner-wand.toml");
        let part = moved(bar, Item::Component(0), [-0.0305, 0.0]).unwrap();
        assert_eq!(changed(bar, &part), [r#"position = "64.5 mm""#]);
        let mass = moved(bar, Item::Mass(1), [0.09, 0.5]).unwrap();
        assert_eq!(
            changed(bar, &mass),
            [r#"  { name = "battery", mass = "110 g", from = "0 mm", to = "60 mm" },"#],
            "both ends, and nothing is across"
        );
        let plate = worked("handheld-terminal.toml");
        let both = moved(plate, Item::Component(2), [0.001, -0.002]).unwrap();
        assert_eq!(changed(plate, &both), [r#"position = ["-19 mm", "-27 mm"]"#]);
        let mass = moved(plate, Item::Mass(1), [0.0, 0.01]).unwrap();
        assert!(mass.contains(r#"from = ["-90 mm", "-20 mm"], to = ["-30 mm", "20 mm"]"#), "{mass}");
        assert_eq!(moved(plate, Item::Mass(1), [0.0; 2]).unwrap(), plate);
    }

    #[test]
    fn places_keep_their_units_and_their_spread() {
        let part = |position: &str, by_m: f64| {
            let text = format!("[[component]]\nposition = {position}\n");
            moved(&text, Item::Component(0), [by_m, 0.0]).unwrap().lines().nth(1).unwrap().to_owned()
        };
        assert_eq!(part("'1 in'", 0.001), r#"position = "1.03937 in""#);
        assert_eq!(part(r#"["10 mm", "2 cm"]"#, -0.01), r#"position = ["0 mm", "1 cm"]"#);
        let normal = r#"{ normal = ["10 mm", "2 mm"], range = ["5 mm", "15 mm"] }"#;
        assert_eq!(part(normal, 0.001), r#"position = { normal = ["11 mm", "2 mm"], range = ["6 mm", "16 mm"] }"#);
        let triangular = r#"{ triangular = ["8 mm", "10 mm", "12 mm"] }"#;
        assert_eq!(part(triangular, 0.001), r#"position = { triangular = ["9 mm", "11 mm", "13 mm"] }"#);
    }

    #[test]
    fn what_is_dragged_stops_at_the_edge() {
        let dragged = |text: &str, item, by| moved(text, item, within(text, item, by)).unwrap();
        let bar = worked("scanner-wand.toml");
        // 220 mm long: a part of 20 mm at 95 mm, and a mass from -90 to -30 mm.
        let part = dragged(bar, Item::Component(0), [1.0, 0.0]);
        assert_eq!(changed(bar, &part), [r#"position = "100 mm""#]);
        assert_eq!(dragged(&part, Item::Component(0), [1e-3, 0.0]), part, "and goes no further");
        assert_eq!(changed(&part, &dragged(&part, Item::Component(0), [-1e-3, 0.0])), [r#"position = "99 mm""#]);
        let mass = dragged(bar, Item::Mass(1), [-1.0, 0.0]);
        assert!(mass.contains(r#"from = "-110 mm", to = "-50 mm""#), "{mass}");
        // Edges and parts of any size: the text can be read, at each of them.
        for [name, text] in WORKED {
            for item in (0..9).flat_map(|n| [Item::Component(n), Item::Mass(n)]) {
                for by in [[9.0, 9.0], [-9.0, -9.0], [0.3, -9.0], [-9.0, 0.01]] {
                    let Ok(text) = moved(text, item, within(text, item, by)) else { continue };
                    let beyond =
                        products::read(name, &text).err().filter(|said| said.contains("half of the product's"));
                    assert_eq!(beyond, None, "{name}: {item:?} by {by:?}");
                }
            }
        }
        // What is beyond an edge by its text is not held there.
        let beyond = bar.replace(r#"position = "30 mm""#, r#"position = "130 mm""#);
        assert!(dragged(&beyond, Item::Component(1), [-0.1, 0.0]).contains(r#"position = "30 mm""#), "back again");
    }

    #[test]
    fn what_is_not_there_is_refused() {
        let bar = worked("scanner-wand.toml");
        assert_eq!(moved(bar, Item::Component(3), [0.1, 0.0]).unwrap_err(), "the file has no such part");
        assert!(moved("[", Item::Mass(0), [0.1, 0.0]).is_err(), "no TOML");
    }

    #[test]
    fn the_plan_of_every_worked_product_holds_what_its_file_lists() {
        for [name, text] in WORKED {
            let told = plan(name, text).unwrap().shown;
            let count = |key: &str| told[key].as_array().map_or(0, Vec::len);
            assert_eq!(count("components"), text.matches("[[component]]").count(), "{name}");
            assert_eq!(count("masses"), text.matches(", mass = \"").count(), "{name}");
        }
        let told = plan("x.toml", worked("scanner-wand.toml")).unwrap().shown;
        // By hand: the center of mass −8.929 mm from the middle, so that the arms are 101.071 and 118.929 mm; ρ² = 4275.24 mm²;
        // q = (12020.27 − 4275.24)/√((10215.35 + 4275.24) (14144.11 + 4275.24)).
        assert!((told["q"].as_f64().unwrap() - 0.474_07).abs() < 5e-6, "{told}");
        assert!((told["center_m"][0].as_f64().unwrap() + 8.929e-3).abs() < 5e-7, "{told}");
        // The display is 200 mm long and 130 mm wide, about a place 10 mm along.
        let told = plan("x.toml", worked("tablet.toml")).unwrap().shown;
        let display = &told["components"][0];
        for (side, want) in [("along_m", [-0.09, 0.11]), ("across_m", [-0.065, 0.065])] {
            for (end, want) in want.into_iter().enumerate() {
                assert!((display[side][end].as_f64().unwrap() - want).abs() < 1e-12, "{side}: {display}");
            }
        }
    }
}
