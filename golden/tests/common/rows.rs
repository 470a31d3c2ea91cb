//! The numbers of a page, line by line.

use std::fmt::Write as _;

use serde_json::Value;

/// Writes one line for each number, or row of numbers, with the path to it.
pub(crate) fn rows(path: &str, value: &Value, text: &mut String) {
    let nested = |value: &Value| value.is_array() || value.is_object();
    let deep = |value: &Value| match value {
        Value::Object(map) => map.values().any(nested),
        Value::Array(list) => list.iter().any(nested),
        _ => false,
    };
    let _ = match value {
        Value::Object(map) if path.is_empty() || map.values().any(deep) => {
            map.iter().for_each(|(key, value)| rows(&format!("{path} {key}"), value, text));
            Ok(())
        }
        Value::Array(list) if list.iter().any(nested) => {
            list.iter().enumerate().for_each(|(i, value)| rows(&format!("{path} {}", i + 1), value, text));
            Ok(())
        }
        value => writeln!(text, "{}: {}", path.trim_start(), value.to_string().replace('"', "")),
    };
}
