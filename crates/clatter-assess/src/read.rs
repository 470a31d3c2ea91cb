//! From the text of a product file to the product, or to everything that is wrong with it.

mod parts;
mod quantities;

use std::collections::HashMap;
use std::ops::Range;

use clatter::{End, Mass};
use clatter_flight::{Body, ContactLaw};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::check::{self, body_of, named, told_apart, width_of};
use crate::fault::{Fault, Faults};
use crate::keys::{self, Key, Kind, MOST_COMPONENTS};
use crate::slip;
use crate::standard;
use crate::units;
use crate::{Attitude, DataFault, Drop, Fall, First, Landing, Product, ProductFile, Spread, Width};
use quantities::written;

/// A file of more bytes is refused unread.
pub const LARGEST_FILE: usize = 1 << 20;

/// A value and where it stands.
#[derive(Debug, Clone)]
struct At<T> {
    value: T,
    span: Range<usize>,
}

impl ProductFile {
    /// Reads the text of a product file; `origin` is its name in messages.
    ///
    /// # Errors
    /// All that is wrong: syntax, unknown keys, wrong units, impossible values, keys that are missing or exclude each
    /// other.
    ///
    /// # Examples
    /// ```
    /// use clatter_assess::{EXAMPLE, ProductFile};
    /// assert!(ProductFile::read(EXAMPLE, "example.toml").is_ok());
    /// let faults = ProductFile::read(&EXAMPLE.replace("length", "lenght"), "example.toml").unwrap_err();
    /// assert!(faults.to_string().contains("did you mean `length`?"));
    /// ```
    pub fn read(text: &str, origin: &str) -> Result<Self, Faults> {
        Self::read_warned(text, origin).map(|(file, _)| file)
    }

    /// The same, with warnings of what is allowed and is likely a slip: a phone of 150 m, a mass outside of the body.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_warned(text: &str, origin: &str) -> Result<(Self, Faults), Faults> {
        let mut reader = Reader::default();
        if text.len() > LARGEST_FILE {
            let message = format!("the file has {} bytes", text.len());
            reader.fault(0..0, message, "", format!("at most {LARGEST_FILE}"));
            return Err(Faults::new(origin, "", reader.faults, Vec::new()));
        }
        let (root, errors) = DeTable::parse_recoverable(text);
        for error in errors {
            // Keys repeat where a header before them was not understood.
            if !reader.faults.is_empty() && error.message() == "duplicate key" {
                continue;
            }
            let span = error.span().unwrap_or(0..0);
            reader.fault(span, format!("invalid TOML: {}", error.message()), "", "");
        }
        let syntax = !reader.faults.is_empty();
        let section =
            Section { keys: keys::FILE, table: root.get_ref(), span: root.span(), title: "the file".to_owned() };
        let file = reader.file(&section);
        // Faults that the reader has no place for.
        if let (Some(Err(error)), true) = (file.as_ref().map(ProductFile::check), reader.faults.is_empty()) {
            reader.fault(0..0, error.to_string(), "", "");
        }
        if syntax {
            // What the parser made up to go on is not to be told of.
            reader.faults.retain(|fault| fault.message.starts_with("invalid TOML"));
            reader.warnings.clear();
        }
        match file {
            Some(file) if reader.faults.is_empty() => {
                Ok((file, Faults::new(origin, text, Vec::new(), reader.warnings)))
            }
            _ => Err(Faults::new(origin, text, reader.faults, reader.warnings)),
        }
    }
}

/// A table of the file, and the keys it may have.
struct Section<'a> {
    keys: &'static [Key],
    table: &'a DeTable<'a>,
    span: Range<usize>,
    /// How messages call it.
    title: String,
}

#[derive(Debug, Default)]
struct Reader {
    /// Whether the product has a width.
    is_plate: bool,
    /// Whether it lands as a box, on faces, edges or corners.
    is_box: bool,
    faults: Vec<Fault>,
    warnings: Vec<Fault>,
}

impl Reader {
    fn fault(
        &mut self,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.faults.push(Fault { span, message: message.into(), label: label.into(), help: help.into(), also: None });
    }

    /// What one of the rules of the product says, where it stands.
    fn data(&mut self, span: Range<usize>, fault: &DataFault, label: &str) {
        let [message, help] = fault.told();
        self.fault(span, message, label, help);
    }

    fn warn(&mut self, span: Range<usize>, message: String, label: String) {
        self.warnings.push(Fault { span, message, label, help: String::new(), also: None });
    }

    /// Faults for keys that are unknown or missing.
    fn check(&mut self, section: &Section<'_>) {
        let mut meant = Vec::new();
        for name in section.table.keys() {
            if keys::find(section.keys, name.get_ref()).is_some() {
                continue;
            }
            let names: Vec<_> = section.keys.iter().map(|key| key.name).collect();
            let likely = names
                .iter()
                .map(|known| (strsim::jaro_winkler(known, &shortened(name.get_ref())), known))
                .filter(|(likeness, _)| *likeness > 0.8)
                .max_by(|a, b| a.0.total_cmp(&b.0));
            let label = likely.map_or("unknown".to_owned(), |(_, known)| format!("did you mean `{known}`?"));
            meant.extend(likely.map(|(_, known)| *known));
            let message = format!("{} has no key `{}`", section.title, shown(name.get_ref()));
            self.fault(name.span(), message, label, format!("its keys are {}", names.join(", ")));
        }
        for key in section.keys.iter().filter(|key| key.required) {
            if !section.table.contains_key(key.name) && !meant.contains(&key.name) {
                let message = format!("{} has no `{}`", section.title, key.name);
                let how = match *key.kind.of_side() {
                    Kind::Table(_) => format!("[{}]", key.name),
                    Kind::Tables(_) => format!("[[{}]]", key.name),
                    Kind::Text => format!("{} = \"…\"", key.name),
                    Kind::Choice(words) => format!("{} = {:?}", key.name, words[0]),
                    Kind::Quantity(d, _) | Kind::Spread(d, _) => format!("{} = {}", key.name, written(d)),
                    Kind::Sides(_) => unreachable!("of one side"),
                };
                self.fault(section.span.clone(), message, "in this table", format!("add {how}: {}", key.doc));
            }
        }
    }

    /// The value behind a key, if it is there.
    fn get<'a>(section: &Section<'a>, name: &str) -> Option<(&'static Key, &'a Spanned<DeValue<'a>>)> {
        let key = keys::find(section.keys, name)?;
        section.table.get(name).map(|value| (key, value))
    }

    fn text(&mut self, section: &Section<'_>, name: &str) -> Option<At<String>> {
        let (_, value) = Self::get(section, name)?;
        let Some(text) = value.get_ref().as_str() else {
            self.wrong_type(value, name, "text in quotes");
            return None;
        };
        Some(At { value: text.to_owned(), span: value.span() })
    }

    /// A word among those of the key.
    fn choice(&mut self, section: &Section<'_>, name: &str) -> Option<At<&'static str>> {
        let (Key { kind: Kind::Choice(words), .. }, value) = Self::get(section, name)? else { return None };
        let found = value.get_ref().as_str().and_then(|text| words.iter().find(|word| **word == text));
        if found.is_none() {
            self.wrong_type(value, name, &format!("one of \"{}\"", words.join("\", \"")));
        }
        found.map(|word| At { value: *word, span: value.span() })
    }

    fn wrong_type(&mut self, value: &Spanned<DeValue<'_>>, name: &str, allowed: &str) {
        let what = match value.get_ref() {
            DeValue::String(text) => format!("{:?}", shown(text)),
            other => format!("this {}", other.type_str()),
        };
        self.fault(value.span(), format!("`{name}` cannot be {what}"), format!("expected {allowed}"), "");
    }

    fn table<'a>(&mut self, section: &Section<'a>, name: &str) -> Option<Section<'a>> {
        let (Key { kind: Kind::Table(keys), .. }, value) = Self::get(section, name)? else { return None };
        let DeValue::Table(table) = value.get_ref() else {
            self.wrong_type(value, name, &format!("a table [{name}]"));
            return None;
        };
        let section = Section { keys, table, span: value.span(), title: format!("[{name}]") };
        self.check(&section);
        Some(section)
    }

    fn tables<'a>(&mut self, section: &Section<'a>, name: &str) -> Vec<Section<'a>> {
        let Some((Key { kind: Kind::Tables(keys), .. }, value)) = Self::get(section, name) else { return Vec::new() };
        let DeValue::Array(items) = value.get_ref() else {
            self.wrong_type(value, name, &format!("one table [[{name}]] each"));
            return Vec::new();
        };
        if items.is_empty() || items.len() > MOST_COMPONENTS {
            let message = format!("`{name}` has {} entries", items.len());
            self.fault(value.span(), message, format!("expected 1 to {MOST_COMPONENTS}"), "");
            return Vec::new();
        }
        let mut sections = Vec::with_capacity(items.len());
        for (i, item) in items.iter().enumerate() {
            let DeValue::Table(table) = item.get_ref() else {
                self.wrong_type(item, name, &format!("a table [[{name}]]"));
                continue;
            };
            let title = format!("[[{name}]] {}", i + 1);
            let section = Section { keys, table, span: item.span(), title };
            self.check(&section);
            sections.push(section);
        }
        sections
    }

    /// One of two keys that exclude each other; a fault where both or, if `needed`, none are given.
    fn exactly_one(&mut self, section: &Section<'_>, names: &[&str], needed: bool) {
        let given: Vec<_> = names.iter().filter_map(|name| section.table.get_key_value(*name)).collect();
        let choice = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        if given.is_empty() && needed {
            let message = format!("{} has none of {choice}", section.title);
            self.fault(section.span.clone(), message, "in this table", "give one of them");
        }
        for (key, _) in given.iter().skip(1) {
            let message = format!("{} has more than one of {choice}", section.title);
            self.fault(key.span(), message, format!("beside `{}`", given[0].0.get_ref()), "give one of them");
        }
    }

    fn file(&mut self, root: &Section<'_>) -> Option<ProductFile> {
        self.check(root);
        let product = self.table(root, "product");
        self.is_plate = product.as_ref().is_some_and(|section| section.table.contains_key("width"));
        if let (true, Some((key, _))) = (self.is_plate, root.table.get_key_value("record")) {
            self.data(key.span(), &DataFault::OfPlate { field: "record" }, "here");
        }
        let product = product.and_then(|section| self.product(&section));
        let drop = self.table(root, "drop");
        self.is_box = drop.as_ref().is_some_and(|drop| LANDS_ON.iter().any(|key| drop.table.contains_key(*key)));
        let is_standard = drop.as_ref().is_some_and(|drop| drop.table.contains_key("standard"));
        let mut landings = drop.as_ref().map(|section| self.landings(section, product.as_ref())).unwrap_or_default();
        let mut drop = drop.and_then(|section| self.drop(&section));
        if let (Some(drop), [first, ..]) = (&mut drop, &mut landings[..]) {
            // A standard has its own height; else the one that it lands on falls as the drop says.
            if is_standard { drop.fall = first.fall } else { first.fall = drop.fall }
        }
        let mut components = Vec::new();
        let sections = self.tables(root, "component");
        self.distinct(&sections);
        for section in sections {
            components.extend(self.component(&section, product.as_ref()));
        }
        let records = self.tables(root, "record");
        let records = records.iter().filter_map(|section| self.record(section, product.as_ref())).collect();
        Some(ProductFile { product: product?, drop: drop?, landings, components, records })
    }

    /// Refuses components of one name: answers could not be told apart.
    fn distinct(&mut self, sections: &[Section<'_>]) {
        let mut known: HashMap<&str, Range<usize>> = HashMap::new();
        for section in sections {
            let Some(value) = section.table.get("name") else { continue };
            let Some(name) = value.get_ref().as_str().map(told_apart) else { continue };
            if let Some(first) = known.get(name) {
                let [message, help] = DataFault::SameName(shown(name)).told();
                self.faults.push(Fault {
                    span: value.span(),
                    message,
                    label: "the second".to_owned(),
                    help,
                    also: Some((first.clone(), "the first".to_owned())),
                });
            } else {
                known.insert(name, value.span());
            }
        }
    }

    fn product(&mut self, section: &Section<'_>) -> Option<Product> {
        let name = self.name(section);
        let length = self.quantity(section, "length");
        let width = self.quantity(section, "width");
        let thickness = self.quantity(section, "thickness");
        if let (Some(thickness), false) = (&thickness, self.is_plate) {
            self.data(thickness.span.clone(), &DataFault::OfBar { field: "thickness" }, "this");
        }
        let mass = self.quantity(section, "mass");
        let restitution = self.spread(section, "restitution");
        let contact_time = self.spread(section, "contact_time");
        let contact_law = self.choice(section, "contact_law");
        let gyration = self.spread_of_sides(section, "radius_of_gyration");
        let moment = self.quantity_of_sides(section, "moment_of_inertia");
        let center = self.quantity_of_sides(section, "center_of_mass");
        let masses = self.masses(section);
        self.exactly_one(section, &["radius_of_gyration", "moment_of_inertia", "masses"], true);
        self.exactly_one(section, &["masses", "center_of_mass"], false);
        self.exactly_one(section, &["masses", "mass"], false);
        if let (true, Some((key, _))) = (
            contact_time.is_none() && !section.table.contains_key("contact_time"),
            section.table.get_key_value("width"),
        ) {
            self.data(key.span(), &DataFault::PlateWithoutContactTime, "beside this");
        }
        let mut product_of_inertia_m2 = 0.0;
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
            let sides = [0, 1].map(|side| center_and_gyration(&masses.value.iter().map(|piece| piece[side])));
            product_of_inertia_m2 = product_of_inertia(&masses.value, sides.map(|(center, _)| center));
            let center = At { value: sides.map(|(center, _)| center), span: masses.span.clone() };
            (Some(center), of_values(sides.map(|(_, gyration)| gyration), masses.span.clone())?)
        } else {
            (center.clone(), gyration?)
        };
        let length_m = length?.value;
        if masses.is_some() {
            self.outside(section, [Some(length_m), width.as_ref().map(|width| width.value)]);
        }
        let total = masses.as_ref().map(|m| m.value.iter().map(|[piece, _]| mass_of(piece)).sum());
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
            self.body(length_m, center_along.clone(), &At { value: *end, span: span.clone() })?;
        }
        let middle = At { value: along.at(0.5), span: span.clone() };
        let body = self.body(length_m, center_along, &middle)?;
        let width = match width {
            Some(width) => {
                let center_across = center_m.map(|At { value: [_, y], span }| At { value: y, span });
                let width = self.width(width.value, center_across, &At { value: across, span: span.clone() })?;
                let width = Width { product_of_inertia_m2, thickness_m: thickness.map(|t| t.value), ..width };
                Some(width)
            }
            None if self.is_plate => return None,
            None => None,
        };
        let product = Product {
            name: name?,
            body,
            width,
            gyration_m: along,
            mass_kg: mass.map(|m| m.value).or(total),
            restitution: restitution?.value,
            contact_time_s: contact_time.map(|t| t.value),
            contact_law: contact_law.and_then(|law| ContactLaw::from_name(law.value)),
        };
        if let Err(fault @ DataFault::ProductOfInertia { .. }) = product.check() {
            self.data(span, &fault, "these together");
        }
        Some(product)
    }

    /// The side across, with what it asks told in the file's terms.
    fn width(&mut self, width_m: f64, center: Option<At<f64>>, gyration: &At<Spread>) -> Option<Width> {
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
        width_of(width_m, center_m, gyration.value.lo())
            .map_err(|fault| match fault {
                DataFault::CenterAcross { .. } => self.data(center.map_or(0..0, |c| c.span), &fault, "this place"),
                _ => self.data(gyration.span.clone(), &fault, "from this"),
            })
            .ok()
    }

    /// Warns of masses far outside of the body.
    fn outside(&mut self, section: &Section<'_>, sides_m: [Option<f64>; 2]) {
        let items = section.table.get("masses").and_then(|masses| masses.get_ref().as_array());
        for piece in items.into_iter().flatten().filter_map(|piece| piece.get_ref().as_table()) {
            for name in ["position", "from", "to"] {
                let Some(value) = piece.get(name) else { continue };
                let places: Vec<_> = value.get_ref().as_array().map_or(vec![value], |pair| pair.iter().collect());
                for (value, side_m) in places.into_iter().zip(sides_m) {
                    let place = value.get_ref().as_str().and_then(|text| units::LENGTH.read(text).ok());
                    if let Some(slip) = place.zip(side_m).and_then(|(place, side_m)| slip::outside(&place, side_m)) {
                        self.warn(value.span(), slip.message, slip.hint);
                    }
                }
            }
        }
    }

    /// The body, with what it asks of center of mass and radius of gyration told in the file's terms.
    fn body(&mut self, length_m: f64, center: Option<At<f64>>, gyration: &At<f64>) -> Option<Body> {
        let center_m = center.as_ref().map_or(0.0, |c| c.value);
        body_of(length_m, center_m, gyration.value)
            .map_err(|fault| match fault {
                DataFault::CenterOfMass { .. } => self.data(center.map_or(0..0, |c| c.span), &fault, "this place"),
                _ => self.data(gyration.span.clone(), &fault, "from this"),
            })
            .ok()
    }

    fn name(&mut self, section: &Section<'_>) -> Option<String> {
        let name = self.text(section, "name")?;
        if let Err(fault) = named(&name.value) {
            let [message, expected] = fault.told();
            self.fault(name.span, message, expected, "");
            return None;
        }
        Some(name.value)
    }

    fn masses(&mut self, section: &Section<'_>) -> Option<At<Vec<[Mass; 2]>>> {
        let span = section.table.get("masses")?.span();
        let sections = self.tables(section, "masses");
        let mut masses = Vec::with_capacity(sections.len());
        let count = sections.len();
        for piece in sections {
            masses.extend(self.mass(&piece));
        }
        (count > 0 && masses.len() == count).then_some(At { value: masses, span })
    }

    /// A mass along the length and along the width.
    fn mass(&mut self, section: &Section<'_>) -> Option<[Mass; 2]> {
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
        let mass_kg = mass?.value;
        if let Some(position) = position {
            return Some(position.value.map(|position_m| Mass::Point { mass_kg, position_m }));
        }
        let (from, to) = (from?, to?);
        if (0..2).any(|side| from.value[side] > to.value[side]) {
            self.fault(to.span, format!("{} ends before it begins", section.title), "`to` is below `from`", help);
            return None;
        }
        Some([0, 1].map(|side| Mass::Slab { mass_kg, from_m: from.value[side], to_m: to.value[side] }))
    }

    /// What a box lands on; none where a fault was told.
    fn landings(&mut self, section: &Section<'_>, product: Option<&Product>) -> Vec<Landing> {
        let tolerance = self.quantity(section, "attitude_tolerance");
        if let (Some(tolerance), false) = (&tolerance, self.is_box) {
            let message = "`attitude_tolerance` is that of a box that lands on a face, edge or corner";
            self.fault(tolerance.span.clone(), message, "here", "add `face`, `edge`, `corner` or `standard`");
        }
        let mut landings = Vec::new();
        for (faces, name) in (1..).zip(&LANDS_ON[..3]) {
            let Some(text) = self.text(section, name) else { continue };
            match Attitude::on(&text.value).filter(|attitude| attitude.faces() == faces) {
                Some(attitude) => landings.push((attitude, 1.0, None)),
                None => self.data(text.span, &DataFault::Attitude { field: name, value: shown(&text.value) }, "this"),
            }
        }
        if let (Some(keyword), Some(product)) = (self.text(section, "standard"), product) {
            let sides = [Some(product.body.length_m()), product.width.map(|width| width.m())];
            let largest_m = sides.into_iter().flatten().fold(0.0, f64::max);
            match standard::drops(&keyword.value, standard::Item { mass_kg: product.mass_kg, largest_m }) {
                Ok((drops, source)) => {
                    landings.extend(drops.into_iter().map(|(attitude, height_m)| (attitude, height_m, Some(source))));
                }
                Err(fault) => self.data(keyword.span, &fault, "this"),
            }
        }
        let landing = |(attitude, height_m, source)| Landing {
            attitude,
            source,
            tolerance_rad: tolerance.as_ref().map_or_else(|| standard::tolerance_rad(attitude), |given| given.value),
            fall: Fall::HeightM(Spread::finite(height_m)),
        };
        landings.into_iter().map(landing).collect()
    }

    fn drop(&mut self, section: &Section<'_>) -> Option<Drop> {
        let height = self.spread(section, "height");
        let speed = self.spread(section, "speed");
        let tilt = self.spread(section, "tilt");
        let first = self.choice(section, "first");
        let direction = self.spread(section, "direction");
        if !(self.is_box || section.table.contains_key("tilt")) {
            let key = keys::find(keys::DROP, "tilt").map_or("", |key| key.doc);
            let message = format!("{} has no `tilt`", section.title);
            self.fault(section.span.clone(), message, "in this table", format!("add tilt = \"5 deg\": {key}"));
        }
        let gravity = self.quantity(section, "gravity");
        self.exactly_one(section, &["height", "speed"], !section.table.contains_key("standard"));
        self.exactly_one(section, &["tilt", "face", "edge", "corner", "standard"], false);
        self.exactly_one(section, &["standard", "height"], false);
        self.exactly_one(section, &["standard", "speed"], false);
        let wrong =
            if self.is_plate { DataFault::OfPlate { field: "first" } } else { DataFault::OfBar { field: "direction" } };
        if let DataFault::OfPlate { field } | DataFault::OfBar { field } = wrong
            && let Some((key, _)) = section.table.get_key_value(field)
        {
            self.data(key.span(), &wrong, "here");
        }
        let gravity_m_s2 = gravity.as_ref().map_or(clatter_shock::STANDARD_GRAVITY_M_S2, |g| g.value);
        if let (Some(height), true) = (&height, gravity_m_s2 == 0.0) {
            self.data(height.span.clone(), &DataFault::NoGravity, "this height");
        }
        let first = match first.map(|f| f.value) {
            Some("a") => First::End(End::A),
            Some("b") => First::End(End::B),
            _ => First::Either,
        };
        let fall = match (height, speed) {
            (Some(height), _) => Fall::HeightM(height.value),
            // Each drop of a standard has its own.
            (None, None) if section.table.contains_key("standard") => Fall::HeightM(Spread::finite(1.0)),
            (None, speed) => Fall::SpeedMS(speed?.value),
        };
        let tilt_rad = if self.is_box { Spread::finite(0.0) } else { tilt?.value };
        Some(Drop { fall, tilt_rad, first, direction_rad: direction.map(|d| d.value), gravity_m_s2 })
    }
}

/// Keys of what a box lands on: by so many faces at once, and by a standard.
const LANDS_ON: [&str; 4] = ["face", "edge", "corner", "standard"];

/// The beginning of a text that may be of any length.
fn shown(text: &str) -> String {
    let short = shortened(text);
    if short.len() < text.len() { format!("{short}…") } else { short }
}

fn shortened(text: &str) -> String {
    text.chars().take(40).collect()
}

/// Radii of gyration that were worked out; none where one is no number, which is told otherwise.
fn of_values(values: [f64; 2], span: Range<usize>) -> Option<At<[Spread; 2]>> {
    let [along, across] = values.map(|value| Spread::value(value).ok());
    Some(At { value: [along?, across?], span })
}

fn mass_of(piece: &Mass) -> f64 {
    match *piece {
        Mass::Point { mass_kg, .. } | Mass::Slab { mass_kg, .. } => mass_kg,
    }
}

/// Center of mass from the middle, and radius of gyration about it.
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

/// ∫x y dm over the mass, about the center of mass: slabs along the edges have none of their own. 0 where it is no more than roundings.
fn product_of_inertia(masses: &[[Mass; 2]], center: [f64; 2]) -> f64 {
    let middle = |piece: &Mass| match *piece {
        Mass::Point { position_m, .. } => position_m,
        Mass::Slab { from_m, to_m, .. } => 0.5 * (from_m + to_m),
    };
    let (mut sum, mut size, mut total) = (0.0, 0.0, 0.0);
    for piece in masses {
        let [x, y] = [0, 1].map(|side| middle(&piece[side]) - center[side]);
        let mass_kg = mass_of(&piece[0]);
        (sum, size, total) = (sum + mass_kg * x * y, size + mass_kg * (x * y).abs(), total + mass_kg);
    }
    if sum.abs() <= ROUNDINGS * size { 0.0 } else { sum / total }
}

/// A product of inertia below this share of what its masses have each is none.
const ROUNDINGS: f64 = 1e-12;
