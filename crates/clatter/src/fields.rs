//! Fields of the types that are checked on construction, as serde writes and reads them. Reading checks them again.
//!
//! Formats without infinities, such as JSON, do not read back values that may be infinite (the duration of a train
//! without end).

use serde::{Deserialize, Serialize};

use crate::{Error, Restitution, Start};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StartFields {
    velocity: [f64; 2],
    height_gap: f64,
}

impl From<Start> for StartFields {
    fn from(start: Start) -> Self {
        Self { velocity: start.velocity(), height_gap: start.height_gap() }
    }
}

impl TryFrom<StartFields> for Start {
    type Error = Error;
    fn try_from(StartFields { velocity, height_gap }: StartFields) -> Result<Self, Error> {
        Self::new(velocity, height_gap)
    }
}

impl From<Restitution> for f64 {
    fn from(e: Restitution) -> Self {
        e.get()
    }
}

impl TryFrom<f64> for Restitution {
    type Error = Error;
    fn try_from(e: f64) -> Result<Self, Error> {
        Self::new(e)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bar, Impact, Summary};

    #[test]
    fn answers_read_back_the_same() {
        let start = Start::new([-2.0, -1.5], 0.01).unwrap();
        let bar = Bar::new(0.73, 0.2).unwrap();
        let (summary, impacts) = (bar.summary(&start), bar.train(&start).collect::<Vec<_>>());
        let text = serde_json::to_string(&(start, &summary, &impacts)).unwrap();
        let back: (Start, Summary, Vec<Impact>) = serde_json::from_str(&text).unwrap();
        assert_eq!(back, (start, summary, impacts));
    }

    #[test]
    fn what_is_refused_when_built_is_refused_when_read() {
        let start = serde_json::from_str::<Start>(r#"{"velocity":[1.0,-1.0],"height_gap":1.0}"#).unwrap_err();
        assert!(
            start.to_string().starts_with("starting velocities [1.0, -1.0]: end a must approach the ground"),
            "{start}"
        );
        let e = serde_json::from_str::<Restitution>("1.5").unwrap_err();
        assert!(e.to_string().contains("1.5"), "{e}");
    }
}
