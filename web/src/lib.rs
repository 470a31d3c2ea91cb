//! This crate answers the questions of the page: it takes a question as JSON and returns the answer of the command.
//!
//! Answers are the text that the command prints with `--format json`, to the last byte, and with each comes the command line that
//! repeats it. The page itself, in `page/`, draws and computes nothing of the physics.

mod bars;
mod plan;
mod products;
mod records;
#[cfg(target_arch = "wasm32")]
#[allow(unsafe_code, reason = "a name that JavaScript can call counts as unsafe")]
mod wasm;

use std::fmt::Display;

use clatter_answer::Versioned;
use serde::{Deserialize, Serialize};

/// The callback that receives the progress: the amount done and the whole amount.
pub type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// The questions that the page can ask; the page gives the name that a file is saved by, for messages and command lines.
#[derive(Debug, Deserialize)]
#[serde(tag = "ask", rename_all = "kebab-case", deny_unknown_fields)]
enum Question {
    /// The impacts of a bar.
    Impacts { q: f64, e: f64, limit: usize },
    /// The safe zone of the bar.
    Zone { q: f64, e: f64, threshold: f64 },
    /// The largest shocks at the ends over the plane of q and e.
    Plane,
    /// The places of the parts and masses of a product.
    Plan { name: String, text: String },
    /// The text of a product with one of them moved by so much, in m; what is dragged `stops` at the edge.
    Move { text: String, item: plan::Item, by: [f64; 2], stops: bool },
    /// The verdicts; `quick` by instant impacts, which take some milliseconds, of a plate or a box by the first drops of the search.
    Assess { name: String, text: String, quick: bool },
    /// The pictures of an assessment.
    Figures { name: String, text: String },
    /// The content of a file of measured accelerations; the page passes its bytes separately.
    Record(records::Source),
    /// The shock response spectrum of such a file.
    Spectrum(records::Source),
    /// Names and texts of the worked products.
    Products,
}

/// An answer, and the data that go with it.
#[derive(Debug, Default, Serialize)]
struct Reply {
    /// The text that the command prints.
    #[serde(skip_serializing_if = "Option::is_none")]
    answer: Option<String>,
    /// The command.
    #[serde(skip_serializing_if = "Option::is_none")]
    command: Option<String>,
    /// The warnings of the command.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    warnings: Vec<String>,
    /// Pictures as SVG, each with its name.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    figures: Vec<(String, String)>,
    /// Further data that the page draws or shows.
    #[serde(skip_serializing_if = "serde_json::Value::is_null")]
    shown: serde_json::Value,
}

impl Reply {
    fn shown(value: impl Serialize) -> Result<Self, String> {
        Ok(Self { shown: serde_json::to_value(value).map_err(text)?, ..Self::default() })
    }
}

/// Answers a question: returns JSON with the answer, or with the `error` in the words of the command. `file` is a file that goes with the
/// question.
#[must_use]
pub fn answer(question: &str, file: &[u8], progress: Progress<'_>) -> String {
    let told = serde_json::from_str(question).map_err(text).and_then(|question| told(question, file, progress));
    match told.and_then(|told| serde_json::to_string(&told).map_err(text)) {
        Ok(told) => told,
        Err(error) => serde_json::json!({ "error": error }).to_string(),
    }
}

fn told(question: Question, file: &[u8], progress: Progress<'_>) -> Result<Reply, String> {
    match question {
        Question::Impacts { q, e, limit } => bars::impacts(q, e, limit),
        Question::Zone { q, e, threshold } => bars::zone(q, e, threshold),
        Question::Plane => bars::plane(),
        Question::Plan { name, text } => plan::plan(&name, &text),
        Question::Move { text, item, by, stops } => {
            let by = if stops { plan::within(&text, item, by) } else { by };
            Reply::shown(plan::moved(&text, item, by)?)
        }
        Question::Assess { name, text, quick } => products::assess(&name, &text, quick, progress),
        Question::Figures { name, text } => products::figures(&name, &text, progress),
        Question::Record(source) => records::record(&source, file),
        Question::Spectrum(source) => records::spectrum(&source, file),
        Question::Products => Reply::shown(products::WORKED),
    }
}

/// Writes an answer as `--format json` prints it.
fn json(answer: &impl Serialize) -> Result<String, String> {
    serde_json::to_string(&Versioned::new(answer)).map_err(text)
}

/// Returns the reason for which a question is refused, in the words of the command.
fn text(error: impl Display) -> String {
    error.to_string()
}

/// Writes a file name so that a shell takes it as one word, and no command takes it for an option.
fn quoted(name: &str) -> String {
    let name = if name.starts_with('-') { format!("./{name}") } else { name.to_owned() };
    let plain = |c: char| c.is_alphanumeric() || "._-/+,@%".contains(c);
    if !name.is_empty() && name.chars().all(plain) { name } else { format!("'{}'", name.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(question: &serde_json::Value, file: &str) -> serde_json::Value {
        serde_json::from_str(&answer(&question.to_string(), file.as_bytes(), &|_, _| ())).unwrap()
    }

    #[test]
    fn what_is_refused_is_told_in_the_words_of_the_command() {
        let error = |question, file| asked(&question, file)["error"].as_str().unwrap_or("none").to_owned();
        let bar = error(serde_json::json!({ "ask": "impacts", "q": 0.5, "e": 7.0, "limit": 9 }), "");
        assert_eq!(bar, clatter::Bar::new(0.5, 7.0).unwrap_err().to_string());
        let product =
            error(serde_json::json!({ "ask": "assess", "name": "x.toml", "text": "a = 1", "quick": false }), "");
        let faults = clatter_product::ProductFile::read("a = 1", "x.toml").unwrap_err().to_string();
        assert!(product == faults && product.contains("error: the file has no key `a`"), "{product}");
        let record = serde_json::json!({ "ask": "record", "name": "x.csv" });
        let said = error(record, "time [s],a [g]\n0,0\n0.001,1\n0.002,x\n");
        assert!(said.starts_with("x.csv: line 4: 'x' in column 2"), "{said}");
        for (field, given, said) in [
            ("sample_rate", "-3", "sampling rate: -3.0 is not finite and > 0"),
            ("full_scale", "0 gn", "full scale: 0.0 is not finite and > 0"),
            (
                "sensitivity",
                "2 V",
                "sensitivity: '2 V' is no voltage for an acceleration, such as 100mV/g or 10.2mV/(m/s2)",
            ),
        ] {
            let question = serde_json::json!({ "ask": "spectrum", "name": "x.csv", field: given });
            assert_eq!(error(question, ""), said);
        }
        assert!(error(serde_json::json!({ "ask": "nothing" }), "").contains("unknown variant"), "no question");
    }

    #[test]
    fn the_first_answer_is_by_instant_impacts() {
        let [name, text] = products::WORKED[0];
        let of = |quick| asked(&serde_json::json!({ "ask": "assess", "name": name, "text": text, "quick": quick }), "");
        assert_eq!(of(true)["command"], "clatter assess scanner-wand.toml --model=finite-tilt --format=json");
        assert_eq!(of(false)["command"], "clatter assess scanner-wand.toml --format=json");
        let model = |told: &serde_json::Value| {
            let answer: serde_json::Value = serde_json::from_str(told["answer"].as_str().unwrap()).unwrap();
            answer["components"][0]["model"]["bar"].clone()
        };
        assert_eq!([model(&of(true)), model(&of(false))], ["finite-tilt", "compliant"]);
    }

    #[test]
    fn names_are_quoted_for_a_shell() {
        let quoted = ["a.toml", "my phone.toml", "-x.toml", "it's.csv", ""].map(quoted);
        assert_eq!(quoted, ["a.toml", "'my phone.toml'", "./-x.toml", r"'it'\''s.csv'", "''"]);
    }
}
