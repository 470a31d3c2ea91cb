//! The plan of a study: a product file, how many drops of it are drawn, and which of its quantities vary over a grid.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{LARGEST_FILE, Reader, Section, shown};
use crate::fault::Faults;
use crate::keys::{self, Kind};
use crate::{ProductFile, units};

/// Products of a grid at most: each is read before anything is drawn.
const MOST_MEMBERS: u64 = 10_000;

/// A plan as its file states it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// The product file, from where the plan is.
    pub product: String,
    /// Drops of each product; 0 of a search.
    pub samples: u64,
    /// Another seed, other drops.
    pub seed: u64,
    /// True where the worst drop of each product is searched, and none are drawn.
    pub search: bool,
    /// The quantities that vary, in the order of the file; the last one runs fastest.
    pub grid: Vec<Axis>,
    text: String,
    origin: String,
}

/// A quantity of the product file that varies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Axis {
    /// Its table and key, the part by its name: `component`, `display`, `natural_frequency`.
    pub path: Vec<String>,
    /// Its values, as a product file has them.
    pub values: Vec<String>,
    span: Range<usize>,
}

impl Axis {
    /// Returns table and key with dots between.
    #[must_use]
    pub fn name(&self) -> String {
        self.path.join(".")
    }
}

impl Plan {
    /// Reads the text of a plan; `origin` is its name in messages.
    ///
    /// # Errors
    /// All that is wrong, each where it stands.
    ///
    /// # Examples
    /// ```
    /// use clatter_product::{EXAMPLE, Plan};
    /// let plan = "product = \"example.toml\"\nsamples = 1e5\n[grid]\nproduct.restitution = [0.2, [0.3, 0.4]]\ndrop.tilt = \"1 deg:3 deg:5\"";
    /// let plan = Plan::read(plan, "plan.toml")?;
    /// assert_eq!((plan.samples, plan.grid[1].values[2].as_str()), (100_000, "\"2 deg\""));
    /// let family = plan.family(EXAMPLE, "example.toml")?;
    /// assert_eq!(family.members(), 10);
    /// assert_eq!(family.values(7), ["[0.3, 0.4]", "\"2 deg\""]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn read(text: &str, origin: &str) -> Result<Self, Faults> {
        let mut reader = Reader::default();
        let plan = reader.parsed(text).and_then(|root| reader.plan(&root, text, origin));
        match plan {
            Some(plan) if reader.faults.is_empty() => Ok(plan),
            _ => Err(Faults::new(origin, text, reader.faults, Vec::new())),
        }
    }

    /// Returns the text that was read.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the products of the plan, of the text of its product file; `origin` is the name of that in messages.
    ///
    /// # Errors
    /// Returns the faults of the product file, of the grid, or of the first of the products of the grid.
    pub fn family(&self, product: &str, origin: &str) -> Result<Family, Faults> {
        ProductFile::read(product, origin)?;
        let root = DeTable::parse_recoverable(product).0;
        let mut reader = Reader::default();
        let places: Vec<_> = self.grid.iter().filter_map(|axis| reader.place(axis, root.get_ref())).collect();
        if !reader.faults.is_empty() {
            return Err(Faults::new(&self.origin, &self.text, reader.faults, Vec::new()));
        }
        let axes = self.grid.iter().cloned().zip(places).collect();
        let family = Family { product: product.to_owned(), origin: origin.to_owned(), axes };
        for i in 0..family.members() {
            family.member(i)?;
        }
        Ok(family)
    }
}

/// The products of a plan: that of its product file, or one for each point of the grid.
#[derive(Debug, Clone)]
pub struct Family {
    product: String,
    origin: String,
    /// The axes, and the places of their values in the product file.
    axes: Vec<(Axis, Range<usize>)>,
}

impl Family {
    /// Returns the number of products.
    #[must_use]
    pub fn members(&self) -> u64 {
        self.axes.iter().map(|(axis, _)| axis.values.len() as u64).product()
    }

    /// Returns the text of the product file.
    #[must_use]
    pub fn product(&self) -> &str {
        &self.product
    }

    /// Returns the values of the grid for product `i`, counted from 0; the last one runs fastest.
    #[must_use]
    pub fn values(&self, i: u64) -> Vec<&str> {
        let mut rest = i;
        let mut values: Vec<&str> = Vec::with_capacity(self.axes.len());
        for (axis, _) in self.axes.iter().rev() {
            let count = axis.values.len() as u64;
            values.push(&axis.values[usize::try_from(rest % count).unwrap_or_default()]);
            rest /= count;
        }
        values.reverse();
        values
    }

    /// Returns product `i`, counted from 0: the product file with the values of the grid in their places.
    ///
    /// # Errors
    /// Returns the faults of that product file; a file that was read once is read again without any.
    pub fn member(&self, i: u64) -> Result<ProductFile, Faults> {
        let values = self.values(i);
        let mut places: Vec<_> = self.axes.iter().map(|(_, place)| place.clone()).zip(&values).collect();
        places.sort_by_key(|(place, _)| std::cmp::Reverse(place.start));
        let mut text = self.product.clone();
        for (place, value) in places {
            text.replace_range(place, value);
        }
        let named = self.axes.iter().zip(&values).map(|((axis, _), value)| format!("{} = {value}", axis.name()));
        let named = named.collect::<Vec<_>>().join(", ");
        let origin = if named.is_empty() { self.origin.clone() } else { format!("{} with {named}", self.origin) };
        ProductFile::read(&text, &origin)
    }
}

impl Reader {
    /// Returns the tables of a text; none, with the faults, where it is none.
    fn parsed<'a>(&mut self, text: &'a str) -> Option<Spanned<DeTable<'a>>> {
        if text.len() > LARGEST_FILE {
            let message = format!("the file has {} bytes", text.len());
            self.fault(0..0, message, "", format!("at most {LARGEST_FILE}"));
            return None;
        }
        let (root, errors) = DeTable::parse_recoverable(text);
        for error in &errors {
            self.fault(error.span().unwrap_or(0..0), format!("invalid TOML: {}", error.message()), "", "");
        }
        errors.is_empty().then_some(root)
    }

    fn plan(&mut self, root: &Spanned<DeTable<'_>>, text: &str, origin: &str) -> Option<Plan> {
        let title = "the plan".to_owned();
        let section = Section { keys: keys::PLAN, table: root.get_ref(), span: root.span(), title };
        self.check(&section);
        let product = self.text(&section, "product").map(|product| product.value);
        let search = match Self::get(&section, "search") {
            None => Some(false),
            Some((_, value)) => {
                let search = value.get_ref().as_bool();
                if search.is_none() {
                    self.wrong_type(value, "search", "true or false");
                }
                search
            }
        };
        let [samples, seed] = ["samples", "seed"].map(|name| self.whole(&section, name));
        match (search, section.table.get_key_value("samples")) {
            (Some(true), Some((key, _))) => {
                self.fault(key.span(), "a search draws no `samples`", "beside `search`", "leave one of them out");
            }
            (Some(false), None) => {
                let help = "add samples = 1e5: how many drops of each product";
                self.fault(section.span.clone(), "the plan has no `samples`", "in this table", help);
            }
            _ => {}
        }
        let mut grid = Vec::new();
        match Self::get(&section, "grid") {
            Some((_, value)) if value.get_ref().is_table() => self.axes(value, text, &mut Vec::new(), &mut grid),
            Some((_, value)) => self.wrong_type(value, "grid", "a table [grid]"),
            None => {}
        }
        grid.sort_by_key(|axis| axis.span.start);
        let members = grid.iter().try_fold(1_u64, |all, axis| all.checked_mul(axis.values.len() as u64));
        let too_many = members.is_none_or(|members| members > MOST_MEMBERS);
        if let (true, Some((key, _))) = (too_many, section.table.get_key_value("grid")) {
            let label = format!("expected {MOST_MEMBERS} at most");
            self.fault(key.span(), "the grid has too many products", label, "give fewer values");
        }
        let [samples, seed] = [samples.unwrap_or(0), seed.unwrap_or(1)];
        let search = search?;
        Some(Plan { product: product?, samples, seed, search, grid, text: text.to_owned(), origin: origin.to_owned() })
    }

    /// Reads a whole number.
    fn whole(&mut self, section: &Section<'_>, name: &str) -> Option<u64> {
        let number = self.quantity(section, name)?;
        if number.value.fract() != 0.0 {
            self.fault(
                number.span,
                format!("`{name}` = {} is no whole number", number.value),
                "expected a whole number",
                "",
            );
            return None;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and within its bounds")]
        let whole = number.value as u64;
        Some(whole)
    }

    /// Collects the quantities that vary in a table of the grid and in those within it.
    fn axes(&mut self, table: &Spanned<DeValue<'_>>, text: &str, path: &mut Vec<String>, axes: &mut Vec<Axis>) {
        for (key, value) in table.get_ref().as_table().into_iter().flatten() {
            path.push(key.get_ref().to_string());
            let values = match value.get_ref() {
                DeValue::Table(_) => {
                    self.axes(value, text, path, axes);
                    None
                }
                DeValue::Array(items) if !items.is_empty() => {
                    Some(items.iter().map(|item| text[item.span()].to_owned()).collect())
                }
                DeValue::String(steps) => {
                    let found = steps_of(steps);
                    if found.is_none() {
                        let message = format!("`{}` cannot be {:?}", path.join("."), shown(steps));
                        let label = "expected \"80 Hz:120 Hz:5\", 5 values from the first to the second, in one unit";
                        self.fault(value.span(), message, label, format!("2 to {MOST_MEMBERS} values"));
                    }
                    found
                }
                _ => {
                    let allowed = "a list of values, or \"80 Hz:120 Hz:5\", 5 values from the first to the second";
                    self.wrong_type(value, &path.join("."), allowed);
                    None
                }
            };
            axes.extend(values.map(|values| Axis { path: path.clone(), values, span: key.span() }));
            path.pop();
        }
    }

    /// Finds where the quantity of an axis stands in the product file.
    fn place(&mut self, axis: &Axis, root: &DeTable<'_>) -> Option<Range<usize>> {
        let name = axis.name();
        let (mut keys, mut table) = (keys::FILE, root);
        let mut path = axis.path.iter();
        while let Some(step) = path.next() {
            let Some(key) = keys::find(keys, step) else {
                let names: Vec<_> = keys.iter().map(|key| key.name).collect();
                let label = format!("no `{}` in it", shown(step));
                let message = format!("no quantity of a product file is `{}`", shown(&name));
                self.fault(axis.span.clone(), message, label, format!("keys there are {}", names.join(", ")));
                return None;
            };
            let Some(value) = table.get(step.as_str()) else {
                let message = format!("the product file has no `{}`", shown(&name));
                let help = "the grid varies what the product file gives: give it there";
                self.fault(axis.span.clone(), message, "not there", help);
                return None;
            };
            table = match (&key.kind, value.get_ref()) {
                (Kind::Table(below) | Kind::OneOrMore(below), DeValue::Table(inner)) => {
                    keys = below;
                    inner
                }
                (Kind::OneOrMore(_), DeValue::Array(items)) => {
                    let message =
                        format!("the product file has {} of `{step}`: `{}` is none of one", items.len(), shown(&name));
                    self.fault(
                        axis.span.clone(),
                        message,
                        "which of them?",
                        "vary what all of them share, or give one",
                    );
                    return None;
                }
                (Kind::Tables(below), DeValue::Array(items)) => {
                    keys = below;
                    let part = path.next().map(String::as_str);
                    let tables = || items.iter().filter_map(|item| item.get_ref().as_table());
                    let named = |table: &&DeTable<'_>| part.is_some() && name_in(table) == part;
                    let Some(found) = tables().find(named) else {
                        let names: Vec<_> = tables().filter_map(name_in).map(shown).collect();
                        let message = match part {
                            Some(part) => format!("the product file has no {step} named {:?}", shown(part)),
                            None => format!("`{}` is no quantity", shown(&name)),
                        };
                        let help = format!("there are \"{}\": {step}.NAME.KEY", names.join("\", \""));
                        self.fault(axis.span.clone(), message, "here", help);
                        return None;
                    };
                    found
                }
                (kind, _) if is_quantity(kind) && path.len() == 0 => return Some(value.span()),
                _ => break,
            };
        }
        let message = format!("`{}` is no quantity of a product file", shown(&name));
        self.fault(
            axis.span.clone(),
            message,
            "expected a table and a key",
            "such as drop.height or component.NAME.position",
        );
        None
    }
}

/// Returns the name that distinguishes a table from others; a contact has its place.
fn name_in<'a>(table: &'a DeTable<'_>) -> Option<&'a str> {
    table.get("name").or(table.get("at")).and_then(|name| name.get_ref().as_str())
}

fn is_quantity(kind: &Kind) -> bool {
    matches!(kind.of_side(), Kind::Quantity(..) | Kind::Spread(..))
}

/// Returns values from the first to the second, evenly, as a product file has them: of "80 Hz:120 Hz:5".
fn steps_of(text: &str) -> Option<Vec<String>> {
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let [lo, hi, count] = parts[..] else { return None };
    let count = count.parse::<u32>().ok().filter(|count| (2..=MOST_MEMBERS).contains(&u64::from(*count)))?;
    let ((lo, unit), (hi, other)) = (units::split(lo)?, units::split(hi)?);
    if unit != other || !(lo.is_finite() && hi.is_finite()) {
        return None;
    }
    let value = |i: u32| {
        let share = f64::from(i) / f64::from(count - 1);
        let value = lo * (1.0 - share) + hi * share;
        // A value that nobody wrote gets no digits of rounding.
        let value = format!("{value:.13e}").parse().unwrap_or(value);
        if unit.is_empty() { format!("{value:?}") } else { format!("\"{value} {unit}\"") }
    };
    Some((0..count).map(value).collect())
}
