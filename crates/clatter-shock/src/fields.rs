//! Fields of the types that are checked on construction, as serde writes and reads them. Reading checks them again.

use serde::{Deserialize, Serialize};

use crate::{DampingRatio, Error, Frequencies, Stop, Suspension};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SuspensionFields {
    omega: f64,
    damping: DampingRatio,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    stop: Option<Stop>,
}

impl From<Suspension> for SuspensionFields {
    fn from(part: Suspension) -> Self {
        Self { omega: part.omega(), damping: part.damping(), stop: part.stop() }
    }
}

impl TryFrom<SuspensionFields> for Suspension {
    type Error = Error;
    fn try_from(SuspensionFields { omega, damping, stop }: SuspensionFields) -> Result<Self, Error> {
        let part = Self::new(omega, damping)?;
        Ok(stop.map_or(part, |stop| part.with_stop(stop)))
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StopFields {
    gap: f64,
    contact_time: f64,
    restitution: f64,
}

impl From<Stop> for StopFields {
    fn from(stop: Stop) -> Self {
        Self { gap: stop.gap(), contact_time: stop.contact_time(), restitution: stop.restitution() }
    }
}

impl TryFrom<StopFields> for Stop {
    type Error = Error;
    fn try_from(StopFields { gap, contact_time, restitution }: StopFields) -> Result<Self, Error> {
        Self::new(gap, contact_time, restitution)
    }
}

impl From<DampingRatio> for f64 {
    fn from(zeta: DampingRatio) -> Self {
        zeta.get()
    }
}

impl TryFrom<f64> for DampingRatio {
    type Error = Error;
    fn try_from(zeta: f64) -> Result<Self, Error> {
        Self::new(zeta)
    }
}

impl From<Frequencies> for Vec<f64> {
    fn from(frequencies: Frequencies) -> Self {
        frequencies.hz().to_vec()
    }
}

impl TryFrom<Vec<f64>> for Frequencies {
    type Error = Error;
    fn try_from(hz: Vec<f64>) -> Result<Self, Error> {
        Self::list(hz)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Pulse, Shape};

    #[test]
    fn parts_and_pulses_read_back_the_same() {
        let part = Suspension::from_hz(180.0, DampingRatio::new(0.05).unwrap()).unwrap();
        let pulse = Pulse { shape: Shape::HalfSine, amplitude: 14_709.975, duration: 5e-4, start: 0.1 };
        let frequencies = Frequencies::per_octave(10.0, 1000.0, 6.0).unwrap();
        let text = serde_json::to_string(&(part, pulse, &frequencies)).unwrap();
        let back: (Suspension, Pulse, Frequencies) = serde_json::from_str(&text).unwrap();
        assert_eq!(back, (part, pulse, frequencies));
        let stopped = part.with_stop(Stop::new(1e-3, 5e-4, 0.4).unwrap());
        let text = serde_json::to_string(&stopped).unwrap();
        assert_eq!(serde_json::from_str::<Suspension>(&text).unwrap(), stopped);
    }

    #[test]
    fn no_stop_is_not_written() {
        let part = Suspension::new(2.0, DampingRatio::new(0.05).unwrap()).unwrap();
        let text = serde_json::to_string(&part).unwrap();
        assert_eq!(text, r#"{"omega":2.0,"damping":0.05}"#);
        let text = serde_json::to_string(&part.with_stop(Stop::new(1.0, 0.5, 0.25).unwrap())).unwrap();
        assert_eq!(text, r#"{"omega":2.0,"damping":0.05,"stop":{"gap":1.0,"contact_time":0.5,"restitution":0.25}}"#);
    }

    #[test]
    fn what_is_refused_when_built_is_refused_when_read() {
        for text in [
            r#"{"omega":-1.0,"damping":0.1}"#,
            r#"{"omega":1.0,"damping":-0.1}"#,
            r#"{"omega":1.0,"damping":0.1,"q":5}"#,
            r#"{"omega":1.0,"damping":0.1,"stop":{"gap":0.0,"contact_time":1.0,"restitution":0.5}}"#,
            r#"{"omega":1.0,"damping":0.1,"stop":{"gap":1.0,"contact_time":1.0,"restitution":1.5}}"#,
            r#"{"omega":1.0,"damping":0.1,"stop":{"gap":1.0,"contact_time":1.0}}"#,
        ] {
            assert!(serde_json::from_str::<Suspension>(text).is_err(), "{text}");
        }
        assert!(serde_json::from_str::<Frequencies>("[10.0, 0.0]").is_err());
    }
}
