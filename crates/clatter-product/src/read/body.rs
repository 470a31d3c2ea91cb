//! This module reads the product that falls: a bar or a plate, and its masses.

use std::ops::Range;

use clatter::Mass;
use clatter_flight::{Body, ContactLaw, Feet, OwnContact, OwnContacts, PLACES, Side};

use super::{At, Reader, Section};
use crate::check::{self, body_of, width_of};
use crate::fault::Fault;
use crate::{DataFault, Product, Spread};

impl Reader {
    pub(super) fn product(&mut self, section: &Section<'_>) -> Option<Product> {
        let name = self.name(section);
        let length = self.quantity(section, "length");
        let width = self.quantity(section, "width");
        let thickness = self.quantity(section, "thickness");
        if let (Some(thickness), false) = (&thickness, self.is_plate) {
            self.data(thickness.span.clone(), &DataFault::OfBar { field: "thickness" }, "this");
        }
        let [length_m, width_m, thickness_m] =
            [&length, &width, &thickness].map(|side| side.as_ref().map(|side| side.value));
        let feet = self.feet(section, [length_m, width_m])?;
        let mass = self.quantity(section, "mass");
        let restitution = self.spread(section, "restitution");
        let contact_time = self.spread(section, "contact_time");
        let contact_law = self.choice(section, "contact_law");
        let friction = self.spread(section, "friction");
        let own_contacts = self.own_contacts(section)?;
        let gyration = self.spread_of_sides(section, "radius_of_gyration");
        let moment = self.quantity_of_sides(section, "moment_of_inertia");
        let center = self.quantity_of_sides(section, "center_of_mass");
        let masses = self.masses(section, [length_m, width_m, thickness_m]);
        self.exactly_one(section, &["radius_of_gyration", "moment_of_inertia", "masses"], true);
        self.exactly_one(section, &["masses", "center_of_mass"], false);
        self.exactly_one(section, &["masses", "mass"], false);
        let needs_time = [("width", DataFault::PlateWithoutContactTime), ("contact_law", DataFault::LawWithoutTime)];
        for (name, fault) in needs_time.into_iter().filter(|_| !section.table.contains_key("contact_time")) {
            if let Some((key, _)) = section.table.get_key_value(name) {
                self.data(key.span(), &fault, "beside this");
            }
        }
        let (mut products_m2, mut depth) = ([0.0; 3], None);
        let (center_m, gyration) = if let Some(moment) = &moment {
            let Some(mass) = &mass else {
                if !section.table.contains_key("mass") {
                    self.fault(moment.span.clone(), "`moment_of_inertia` needs the `mass`", "", "add mass = \"190 g\"");
                }
                return None;
            };
            let radii = moment.value.map(|moment| (moment / mass.value).sqrt());
            (center.clone(), of_values(radii, moment.span.clone())?)
        } else if let Some(masses) = &masses {
            let sides = [0, 1, 2].map(|side| center_and_gyration(&masses.value.iter().map(|piece| piece[side])));
            let product = |one, other| product_of_inertia(&masses.value, [one, other], [sides[one].0, sides[other].0]);
            products_m2[0] = product(0, 1);
            // Where no mass has a height, all are spread evenly.
            if masses.value.iter().any(|[.., height]| matches!(height, Mass::Point { .. })) {
                depth = Some(sides[2]);
                products_m2 = [products_m2[0], product(0, 2), product(1, 2)];
            }
            let center = At { value: [sides[0].0, sides[1].0], span: masses.span.clone() };
            (Some(center), of_values([sides[0].1, sides[1].1], masses.span.clone())?)
        } else {
            (center.clone(), gyration?)
        };
        let inset_m = feet.map_or([0.0; 2], |feet| feet.inset_m);
        let length_m = length?.value - 2.0 * inset_m[0];
        let total = masses.as_ref().map(|m| m.value.iter().map(|[piece, ..]| mass_of(piece)).sum());
        if let (Some(total), Some(masses)) = (total, &masses)
            && let Err(fault) = check::mass(total)
        {
            self.data(masses.span.clone(), &fault, "these together");
        }
        let [along, across] = gyration.value;
        let span = gyration.span;
        let center_along = center_m.clone().map(|At { value: [x, _], span }| At { value: x, span });
        let ends = [along.lo(), along.hi()];
        for end in &ends[..if along.is_value() { 0 } else { 2 }] {
            self.body(length_m, inset_m[0], center_along.clone(), &At { value: *end, span: span.clone() })?;
        }
        let middle = At { value: along.at(0.5), span: span.clone() };
        let body = self.body(length_m, inset_m[0], center_along, &middle)?;
        let width = match width {
            Some(width) => {
                let center_across = center_m.map(|At { value: [_, y], span }| At { value: y, span });
                let width_m = width.value - 2.0 * inset_m[1];
                Some(self.width(width_m, inset_m[1], center_across, &At { value: across, span: span.clone() })?)
            }
            None if self.is_plate => return None,
            None => None,
        };
        let thickness = width.and(thickness_m).map(|thickness_m| {
            let half_m = 0.5 * thickness_m;
            let side = |(center_m, gyration_m)| Side { ends_m: [half_m + center_m, half_m - center_m], gyration_m };
            depth.map_or(Side::even(thickness_m), side)
        });
        let body = Body { width, thickness, products_m2, feet, ..body };
        let product = Product {
            name: name?,
            body,
            own_contacts,
            gyration_m: along,
            mass_kg: mass.map(|m| m.value).or(total),
            restitution: restitution?.value,
            contact_time_s: contact_time.map(|t| t.value),
            contact_law: contact_law.and_then(|law| ContactLaw::from_name(law.value)),
            friction: friction.map(|friction| friction.value),
            is_friction_assumed: false,
        };
        if let Err(fault @ (DataFault::ProductOfInertia { .. } | DataFault::CenterOfMass { .. })) = product.check() {
            self.data(span, &fault, "these together");
        }
        Some(product)
    }

    /// Contacts of its ends or corners; none where they are at fault.
    fn own_contacts(&mut self, section: &Section<'_>) -> Option<OwnContacts> {
        let mut own = OwnContacts::NONE;
        let Some((key, value)) = section.table.get_key_value("contacts") else { return Some(own) };
        let faults = self.faults.len();
        let mut known: [Option<Range<usize>>; 4] = std::array::from_fn(|_| None);
        for contact in self.tables(section, "contacts") {
            let at = self.choice(&contact, "at");
            let [restitution, contact_time] =
                ["restitution", "contact_time"].map(|name| self.quantity(&contact, name).map(|value| value.value));
            if !["restitution", "contact_time"].into_iter().any(|name| contact.table.contains_key(name)) {
                self.data(contact.span.clone(), &DataFault::ContactAsAll, "this one");
            }
            let Some(At { value: at, span }) = at else { continue };
            let Some(k) = PLACES.into_iter().position(|place| place == at) else { continue };
            if !self.is_plate && k > 1 {
                self.data(span.clone(), &DataFault::CornerOfBar(PLACES[k]), "this place");
            }
            if let Some(first) = &known[k] {
                let [message, help] = DataFault::SameContact(at.to_owned()).told();
                let (label, also) = ("the second".to_owned(), Some((first.clone(), "the first".to_owned())));
                self.faults.push(Fault { span: span.clone(), message, label, help, also });
            }
            known[k] = Some(span);
            own.0[k] = OwnContact { restitution, contact_time_s: contact_time };
        }
        if !section.table.contains_key("contact_time") && !section.table.contains_key("width") {
            self.data(key.span(), &DataFault::OwnContactsWithoutTime, "here");
        }
        let law = section.table.get("contact_law").map(|law| law.get_ref().as_str());
        if law != Some(Some("hysteretic")) && law.is_none_or(|law| law == Some("dashpot")) {
            let span = section.table.get("contact_law").map_or_else(|| value.span(), toml::Spanned::span);
            self.data(span, &DataFault::OwnContactsLaw, "here");
        }
        (self.faults.len() == faults).then_some(own)
    }

    /// Its feet, if it has any; none where they are at fault.
    #[expect(clippy::option_option, reason = "as what else of a product is at fault")]
    fn feet(&mut self, section: &Section<'_>, sides_m: [Option<f64>; 2]) -> Option<Option<Feet>> {
        let inset = self.quantity_of_sides(section, "feet_inset");
        let height = self.quantity(section, "feet_height");
        for [one, other] in [["feet_inset", "feet_height"], ["feet_height", "feet_inset"]] {
            if let (Some((key, _)), false) = (section.table.get_key_value(one), section.table.contains_key(other)) {
                let help = format!("add {other} = \"2 mm\" or whatever it is");
                self.fault(key.span(), format!("`{one}` needs `{other}`"), "this", help);
            }
        }
        if !section.table.contains_key("feet_inset") {
            return Some(None);
        }
        let (inset, height) = (inset?, height?);
        for (inset_m, side_m) in inset.value.into_iter().zip(sides_m) {
            if let Some(side_m) = side_m.filter(|side_m| inset_m > check::FEET_INSIDE * side_m) {
                self.data(inset.span.clone(), &DataFault::FeetApart { inset_m, side_m }, "this");
                return None;
            }
        }
        Some(Some(Feet { inset_m: inset.value, height_m: height.value }))
    }

    /// Returns the side across; faults of its data are reported in the terms of the file.
    fn width(&mut self, width_m: f64, inset_m: f64, center: Option<At<f64>>, gyration: &At<Spread>) -> Option<Side> {
        if !gyration.value.is_value() {
            let message = "the radius of gyration of the mass along the width has a range";
            self.fault(
                gyration.span.clone(),
                message,
                "the second",
                "give one value; that of the mass along the length may have a range",
            );
            return None;
        }
        let center_m = center.as_ref().map_or(0.0, |c| c.value);
        width_of(width_m, inset_m, center_m, gyration.value.lo())
            .map_err(|fault| match fault {
                DataFault::CenterOfMass { .. } => self.data(center.map_or(0..0, |c| c.span), &fault, "this place"),
                _ => self.data(gyration.span.clone(), &fault, "from this"),
            })
            .ok()
    }

    /// Returns the body; faults of its center of mass and radius of gyration are reported in the terms of the file.
    fn body(&mut self, length_m: f64, inset_m: f64, center: Option<At<f64>>, gyration: &At<f64>) -> Option<Body> {
        let center_m = center.as_ref().map_or(0.0, |c| c.value);
        body_of(length_m, inset_m, center_m, gyration.value)
            .map_err(|fault| match fault {
                DataFault::CenterOfMass { .. } => self.data(center.map_or(0..0, |c| c.span), &fault, "this place"),
                _ => self.data(gyration.span.clone(), &fault, "from this"),
            })
            .ok()
    }

    fn masses(&mut self, section: &Section<'_>, sides_m: [Option<f64>; 3]) -> Option<At<Vec<[Mass; 3]>>> {
        let span = section.table.get("masses")?.span();
        let sections = self.tables(section, "masses");
        let mut masses = Vec::with_capacity(sections.len());
        let count = sections.len();
        let mut names: Vec<String> = Vec::new();
        for piece in sections {
            if let Some(name) = piece.table.get("name").and_then(|name| name.get_ref().as_str()) {
                if names.iter().any(|other| other == name) {
                    let message = format!("two masses are named {name:?}");
                    self.fault(piece.span.clone(), message, "the second", "give each mass a name of its own");
                }
                names.push(name.to_owned());
            }
            masses.extend(self.mass(&piece, sides_m));
        }
        (count > 0 && masses.len() == count).then_some(At { value: masses, span })
    }

    /// Reads a mass along the length, the width and the thickness.
    fn mass(&mut self, section: &Section<'_>, sides_m: [Option<f64>; 3]) -> Option<[Mass; 3]> {
        self.text(section, "name");
        let mass = self.quantity(section, "mass");
        let position = self.quantity_of_sides(section, "position");
        let [from, to] = ["from", "to"].map(|name| self.quantity_of_sides(section, name));
        let has = |name| section.table.contains_key(name);
        let help = "a point mass has a `position`, a slab has `from` and `to`";
        if has("position") == (has("from") || has("to")) || has("from") != has("to") {
            let message = format!("{} is neither a point mass nor a slab", section.title);
            self.fault(section.span.clone(), message, "this one", help);
            return None;
        }
        let height = self.quantity(section, "height");
        let half_m = 0.5 * sides_m[2].unwrap_or(0.0);
        if let (Some(height), None) = (&height, sides_m[2]) {
            let help = "add the `thickness` to [product], or leave the height out";
            self.fault(height.span.clone(), "a mass has a `height` in a product with a thickness alone", "here", help);
        }
        let in_plane = [&position, &from, &to].into_iter().flatten();
        let in_plane = in_plane.flat_map(|place| (0..2).map(|k| (k, place.value[k], &place.span)));
        for (k, place_m, span) in in_plane.chain(height.iter().map(|height| (2, height.value, &height.span))) {
            let side = ["length", "width", "thickness"][k];
            if let Some(Err(fault)) =
                sides_m[k].map(|side_m| check::within("the mass", side, place_m.abs(), side_m, check::WRITTEN))
            {
                self.data(span.clone(), &fault, "this place");
                return None;
            }
        }
        let mass_kg = mass?.value;
        let depth = match height {
            Some(height) => Mass::Point { mass_kg, position_m: height.value },
            None => Mass::Slab { mass_kg, from_m: -half_m, to_m: half_m },
        };
        if let Some(position) = position {
            let [along, across] = position.value.map(|position_m| Mass::Point { mass_kg, position_m });
            return Some([along, across, depth]);
        }
        let (from, to) = (from?, to?);
        if (0..2).any(|side| from.value[side] > to.value[side]) {
            self.fault(to.span, format!("{} ends before it begins", section.title), "`to` is below `from`", help);
            return None;
        }
        let [along, across] = [0, 1].map(|side| Mass::Slab { mass_kg, from_m: from.value[side], to_m: to.value[side] });
        Some([along, across, depth])
    }
}

/// Returns radii of gyration that were worked out; none where one is no number, which is reported elsewhere.
fn of_values(values: [f64; 2], span: Range<usize>) -> Option<At<[Spread; 2]>> {
    let [along, across] = values.map(|value| Spread::value(value).ok());
    Some(At { value: [along?, across?], span })
}

fn mass_of(piece: &Mass) -> f64 {
    match *piece {
        Mass::Point { mass_kg, .. } | Mass::Slab { mass_kg, .. } => mass_kg,
    }
}

/// Returns the center of mass from the middle, and the radius of gyration about it.
///
/// A slab is a point mass at its middle plus its own moment m w²/12. A center of mass within roundings of the middle is
/// the middle.
fn center_and_gyration(masses: &(impl Iterator<Item = Mass> + Clone)) -> (f64, f64) {
    let places = masses.clone().map(|piece| match piece {
        Mass::Point { mass_kg, position_m } => (mass_kg, position_m, 0.0),
        Mass::Slab { mass_kg, from_m, to_m } => (mass_kg, 0.5 * (from_m + to_m), to_m - from_m),
    });
    let (total, count) = masses.clone().fold((0.0, 0.0), |(sum, n), piece| (sum + mass_of(&piece), n + 1.0));
    let (first, reach) =
        places.clone().fold((0.0, 0.0), |(first, reach), (m, x, w)| (first + m * x, reach + m * (x.abs() + w)));
    let center = if first.abs() <= 8.0 * f64::EPSILON * count * reach { 0.0 } else { first / total };
    let second: f64 = places.map(|(m, x, w)| m * ((x - center) * (x - center) + w * w / 12.0)).sum();
    (center, (second / total).sqrt())
}

/// Returns ∫x y dm over the mass along two sides, about the center of mass: slabs along the edges have none of their own. 0 where it is no
/// more than roundings.
fn product_of_inertia(masses: &[[Mass; 3]], sides: [usize; 2], center: [f64; 2]) -> f64 {
    let middle = |piece: &Mass| match *piece {
        Mass::Point { position_m, .. } => position_m,
        Mass::Slab { from_m, to_m, .. } => 0.5 * (from_m + to_m),
    };
    let (mut sum, mut size, mut total) = (0.0, 0.0, 0.0);
    for piece in masses {
        let [x, y] = [0, 1].map(|k| middle(&piece[sides[k]]) - center[k]);
        let mass_kg = mass_of(&piece[0]);
        (sum, size, total) = (sum + mass_kg * x * y, size + mass_kg * (x * y).abs(), total + mass_kg);
    }
    if sum.abs() <= ROUNDINGS * size { 0.0 } else { sum / total }
}

/// A product of inertia below this share of what its masses have each is none.
const ROUNDINGS: f64 = 1e-12;
