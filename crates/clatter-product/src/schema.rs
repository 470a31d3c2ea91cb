//! The JSON Schema of product files, from the table of their keys.

use serde_json::{Map, Value, json};

use crate::keys::{FILE, Key, Kind};
use crate::units::{self, Dimension};

/// Returns the JSON Schema (draft 2020-12) of a product file, with which editors complete and check it.
///
/// It knows keys, types, units and which numbers are required; bounds and keys that exclude each other are reported by
/// [`ProductFile::read`](crate::ProductFile::read).
///
/// ```
/// let schema = clatter_product::schema();
/// assert_eq!(schema["properties"]["product"]["properties"]["length"]["examples"][0], "70 mm");
/// ```
#[must_use]
pub fn schema() -> Value {
    let mut schema = table(FILE);
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    schema["title"] = "A product for clatter assess".into();
    schema
}

fn table(keys: &[Key]) -> Value {
    let properties: Map<String, Value> = keys
        .iter()
        .map(|key| {
            let mut value = kind(&key.kind);
            value["description"] = key.doc.into();
            (key.name.to_owned(), value)
        })
        .collect();
    let required: Vec<_> = keys.iter().filter(|key| key.required).map(|key| key.name).collect();
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

fn kind(of: &Kind) -> Value {
    match of {
        Kind::Text => json!({ "type": "string" }),
        Kind::Texts => {
            let one = json!({ "type": "string" });
            json!({ "anyOf": [one, { "type": "array", "items": one, "minItems": 1 }] })
        }
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Choice(words) => json!({ "enum": words }),
        Kind::Quantity(dimension, bounds) => with_examples(quantity(dimension, *bounds), dimension),
        Kind::Spread(dimension, bounds) => {
            let one = quantity(dimension, *bounds);
            let list = |n: usize| json!({ "type": "array", "items": one, "minItems": n, "maxItems": n });
            let law = |name: &str, n: usize, others: &[&str]| {
                let mut properties = Map::from_iter([(name.to_owned(), list(n))]);
                properties.extend(others.iter().map(|other| ((*other).to_owned(), list(2))));
                let required: Vec<_> = properties.keys().cloned().collect();
                json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
            };
            let ways =
                [one.clone(), list(2), law("uniform", 2, &[]), law("triangular", 3, &[]), law("normal", 2, &["range"])];
            with_examples(json!({ "oneOf": ways }), dimension)
        }
        Kind::Sides(side) => {
            let one = kind(side);
            let both = json!({ "type": "array", "items": one, "minItems": 2, "maxItems": 2 });
            json!({ "anyOf": [one, both] })
        }
        Kind::Table(keys) => table(keys),
        Kind::OneOrMore(keys) => json!({ "anyOf": [table(keys), kind(&Kind::Tables(keys))] }),
        Kind::Tables(keys) => json!({ "type": "array", "items": table(keys), "minItems": 1 }),
    }
}

/// Returns one number with its unit; bounds as far as plain numbers have them.
fn quantity(dimension: &Dimension, bounds: [&str; 2]) -> Value {
    let units: Vec<_> = dimension.units.iter().map(units::pattern).collect();
    let number = r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?";
    let text = json!({ "type": "string", "pattern": format!(r"^\s*{number}\s*({})\s*$", units.join("|")) });
    if !dimension.plain {
        return text;
    }
    let [lo, hi] = bounds.map(|bound| dimension.value(bound));
    let plain = json!({ "type": "number", "minimum": lo, "maximum": hi });
    if dimension.units.is_empty() { plain } else { json!({ "anyOf": [plain, text] }) }
}

fn with_examples(mut value: Value, dimension: &Dimension) -> Value {
    let plain = dimension.example.parse().ok().filter(|_: &f64| dimension.plain);
    let example = plain.map_or_else(|| dimension.example.into(), Value::from);
    value["examples"] = json!([example]);
    value
}
