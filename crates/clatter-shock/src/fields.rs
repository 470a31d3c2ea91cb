//! Fields of the types that are checked on construction, as serde writes and reads them. Reading checks them again.

use serde::{Deserialize, Serialize};

use crate::{DampingRatio, Error, Frequencies, Suspension};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SuspensionFields {
    omega: f64,
    damping: DampingRatio,
}

impl From<Suspension> for SuspensionFields {
    fn from(part: Suspension) -> Self {
        Self { omega: part.omega(), damping: part.damping() }
    }
}

impl TryFrom<SuspensionFields> for Suspension {
    type Error = Error;
    fn try_from(SuspensionFields { omega, damping }: SuspensionFields) -> Result<Self, Error> {
        Self::new(omega, damping)
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
    }

    #[test]
    fn what_is_refused_when_built_is_refused_when_read() {
        for text in [
            r#"{"omega":-1.0,"damping":0.1}"#,
            r#"{"omega":1.0,"damping":-0.1}"#,
            r#"{"omega":1.0,"damping":0.1,"q":5}"#,
        ] {
            assert!(serde_json::from_str::<Suspension>(text).is_err(), "{text}");
        }
        assert!(serde_json::from_str::<Frequencies>("[10.0, 0.0]").is_err());
    }
}
