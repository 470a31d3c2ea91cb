//! This module goes from the text of a product file to the product, or to everything that is wrong with it.

mod body;
mod drops;
mod parts;
mod plan;
mod quantities;

use std::collections::HashMap;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::check::{named, told_apart};
use crate::fault::{Fault, Faults};
use crate::keys::{self, Key, Kind, MOST_COMPONENTS};
use crate::{DataFault, ProductFile, Reliability};
use quantities::written;

pub use plan::{Axis as GridAxis, Family, Plan};

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
    /// use clatter_product::{EXAMPLE, ProductFile};
    /// assert!(ProductFile::read(EXAMPLE, "example.toml").is_ok());
    /// let faults = ProductFile::read(&EXAMPLE.replace("length", "lenght"), "example.toml").unwrap_err();
    /// assert!(faults.to_string().contains("did you mean `length`?"));
    /// ```
    pub fn read(text: &str, origin: &str) -> Result<Self, Faults> {
        Self::read_warned(text, origin).map(|(file, _)| file)
    }

    /// Reads the same, with warnings of values that are allowed and likely a slip: a phone of 150 m, a mass outside of the body.
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
            // The values that the parser made up to go on must not be reported.
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
    /// The words of messages for it.
    title: String,
}

#[derive(Debug, Default)]
struct Reader {
    /// True where the product has a width.
    is_plate: bool,
    /// True where it lands as a box, on faces, edges or corners.
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

    /// Reports a fault by one of the rules of the product, where it stands.
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
                    Kind::Table(_) | Kind::OneOrMore(_) => format!("[{}]", key.name),
                    Kind::Tables(_) => format!("[[{}]]", key.name),
                    Kind::Text | Kind::Texts => format!("{} = \"…\"", key.name),
                    Kind::Flag => format!("{} = true", key.name),
                    Kind::Choice(words) => format!("{} = {:?}", key.name, words[0]),
                    Kind::Quantity(d, _) | Kind::Spread(d, _) => format!("{} = {}", key.name, written(d)),
                    Kind::Sides(_) => unreachable!("of one side"),
                };
                self.fault(section.span.clone(), message, "in this table", format!("add {how}: {}", key.doc));
            }
        }
    }

    /// Returns the value behind a key, if it is there.
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

    /// Reads a text, or each text of a list.
    fn texts(&mut self, section: &Section<'_>, name: &str) -> Vec<At<String>> {
        let Some((_, value)) = Self::get(section, name) else { return Vec::new() };
        let list = value.get_ref().as_array().filter(|list| !list.is_empty());
        let mut texts = Vec::new();
        for value in list.map_or(vec![value], |list| list.iter().collect()) {
            match value.get_ref().as_str() {
                Some(text) => texts.push(At { value: text.to_owned(), span: value.span() }),
                None => self.wrong_type(value, name, "text in quotes, or a list of it"),
            }
        }
        texts
    }

    /// Reads a word among those of the key.
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
        let (Key { kind: Kind::Table(keys) | Kind::OneOrMore(keys), .. }, value) = Self::get(section, name)? else {
            return None;
        };
        let DeValue::Table(table) = value.get_ref() else {
            self.wrong_type(value, name, &format!("a table [{name}]"));
            return None;
        };
        let section = Section { keys, table, span: value.span(), title: format!("[{name}]") };
        self.check(&section);
        Some(section)
    }

    fn tables<'a>(&mut self, section: &Section<'a>, name: &str) -> Vec<Section<'a>> {
        let Some((Key { kind: kind @ (Kind::Tables(keys) | Kind::OneOrMore(keys)), .. }, value)) =
            Self::get(section, name)
        else {
            return Vec::new();
        };
        let most = if matches!(kind, Kind::Tables(_)) { MOST_COMPONENTS } else { drops::MOST_DROPS };
        // A list of the product stands within the table of the product.
        let of = section.title.strip_prefix('[').and_then(|title| title.strip_suffix(']'));
        let path = of.map_or(name.to_owned(), |of| format!("{of}.{name}"));
        let DeValue::Array(items) = value.get_ref() else {
            self.wrong_type(value, name, &format!("one table [[{path}]] each"));
            return Vec::new();
        };
        if items.is_empty() || items.len() > most {
            let message = format!("`{name}` has {} entries", items.len());
            self.fault(value.span(), message, format!("expected 1 to {most}"), "");
            return Vec::new();
        }
        let mut sections = Vec::with_capacity(items.len());
        for (i, item) in items.iter().enumerate() {
            let DeValue::Table(table) = item.get_ref() else {
                self.wrong_type(item, name, &format!("a table [[{path}]]"));
                continue;
            };
            let title = format!("[[{name}]] {}", i + 1);
            let section = Section { keys, table, span: item.span(), title };
            self.check(&section);
            sections.push(section);
        }
        sections
    }

    /// Checks that one of two keys that exclude each other is given: both or, if `needed`, none are a fault.
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
        let has_own = product.as_ref().is_some_and(|section| section.table.contains_key("contacts"));
        if let (true, Some((key, _))) = (has_own, root.table.get_key_value("record")) {
            self.data(key.span(), &DataFault::OwnContactsMeasured, "here");
        }
        let friction = product.as_ref().and_then(|section| section.table.get_key_value("friction"));
        let friction = friction.map(|(key, _)| key.span());
        let product = product.and_then(|section| self.product(&section));
        let (drop, landings) = self.drops(root, product.as_ref());
        if let (Some(key), false) = (friction, self.is_box) {
            self.data(key, &DataFault::FrictionOfLevel, "here");
        }
        if let (false, Some((key, _))) = (landings.is_empty(), root.table.get_key_value("record")) {
            self.data(key.span(), &DataFault::ListMeasured, "here");
        }
        let mut components = Vec::new();
        let sections = self.tables(root, "component");
        self.distinct(&sections);
        for section in sections {
            components.extend(self.component(&section, product.as_ref()));
        }
        let records = self.tables(root, "record");
        let records = records.iter().filter_map(|section| self.record(section, product.as_ref())).collect();
        let verdict = self.table(root, "verdict");
        let reliability = verdict.and_then(|section| {
            let confidence = self.quantity(&section, "confidence").map_or(Reliability::CONFIDENCE, |at| at.value);
            Reliability::new(self.quantity(&section, "reliability")?.value, confidence).ok()
        });
        let mut file = ProductFile { product: product?, drop: drop?, landings, components, records, reliability };
        file.assume_friction();
        Some(file)
    }

    /// Refuses components of one name: answers could not be distinguished.
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

    fn name(&mut self, section: &Section<'_>) -> Option<String> {
        let name = self.text(section, "name")?;
        if let Err(fault) = named(&name.value) {
            let [message, expected] = fault.told();
            self.fault(name.span, message, expected, "");
            return None;
        }
        Some(name.value)
    }
}

/// Returns the beginning of a text that may be of any length.
fn shown(text: &str) -> String {
    let short = shortened(text);
    if short.len() < text.len() { format!("{short}…") } else { short }
}

fn shortened(text: &str) -> String {
    text.chars().take(40).collect()
}
