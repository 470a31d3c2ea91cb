//! `data/clatter.json`: 212 bars computed in exact rational arithmetic.
//!
//! Velocities are in v0, times in h0/v0. Every input is the exact value of its f64; results carry 24 digits and are
//! rounded to f64 here, which costs 1e-16 of each, a thousandth of the tightest allowed error.

use clatter::accuracy::SHORT;
use serde::Deserialize;
use serde_json::Value;

#[derive(Deserialize)]
pub(crate) struct Case {
    #[serde(rename = "case")]
    pub(crate) name: String,
    pub(crate) q: Option<f64>,
    pub(crate) k: Option<f64>,
    pub(crate) e: f64,
    pub(crate) va: f64,
    pub(crate) vb: f64,
    impacts: Impacts,
    pub(crate) approach: Vec<String>,
    pub(crate) times: Vec<String>,
    pub(crate) peak_end_dv: String,
    /// Number of the impact of the peak, from 1, or a word where it is a limit.
    pub(crate) peak_index: Value,
    pub(crate) duration: String,
    #[serde(rename = "final")]
    last: Final,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Impacts {
    Finite(u64),
    Infinite(String),
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Final {
    Settled([String; 2]),
    Unsettled(String),
}

impl Case {
    /// Returns the number of impacts, `None` if they never end.
    pub(crate) fn count(&self) -> Option<u64> {
        match &self.impacts {
            Impacts::Finite(n) => Some(*n),
            Impacts::Infinite(word) => {
                assert_eq!(word, "infinite", "{}", self.name);
                None
            }
        }
    }

    /// Returns whether the case is held to the errors that are promised up to 10⁴ impacts.
    pub(crate) fn is_short(&self) -> bool {
        self.count().is_none_or(|n| n <= SHORT)
    }

    /// Returns whether the start is within 1e−9 of the edge of endless.
    pub(crate) fn is_at_the_edge(&self) -> bool {
        self.name.starts_with("spun-out")
    }

    /// Returns the final velocities of both ends, `None` where they do not settle.
    pub(crate) fn last(&self) -> Option<[f64; 2]> {
        match &self.last {
            Final::Settled([a, b]) => Some([decimal(a), decimal(b)]),
            Final::Unsettled(why) => {
                assert_eq!(why, "none: the velocities do not settle", "{}", self.name);
                None
            }
        }
    }
}

/// Returns all of them.
pub(crate) fn cases() -> Vec<Case> {
    #[derive(Deserialize)]
    struct Oracle {
        cases: Vec<Case>,
    }
    let Oracle { cases } = serde_json::from_str(include_str!("../data/clatter.json")).expect("cases");
    assert_eq!(cases.len(), 212, "the oracle is whole");
    cases
}

/// Reads the nearest float; out of range becomes 0 or infinite.
pub(crate) fn decimal(text: &str) -> f64 {
    text.parse().expect("a decimal number")
}
