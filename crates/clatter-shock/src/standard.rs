//! Pulses and limit curves that standards state, as data with their sources.

use crate::{Error, LimitCurve, Pulse, Pulses, Quantity, Response, STANDARD_GRAVITY_M_S2, Shape, Suspension};

/// A limit curve of a standard: a shock response spectrum that a test has to reach.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct StandardCurve {
    /// Its name on the command line and in files.
    pub keyword: &'static str,
    /// Its use.
    pub title: &'static str,
    /// (Hz, level) in order of frequency; straight lines between them on log-log paper.
    pub points: &'static [(f64, f64)],
    /// Unit of the levels.
    pub unit: &'static str,
    /// Quantity of the levels.
    pub quantity: Quantity,
    /// Quality factor of the oscillators.
    pub quality_factor: f64,
    /// Its printed source.
    pub source: &'static str,
}

impl StandardCurve {
    /// Returns the curve in SI units, to hold a spectrum against.
    ///
    /// ```
    /// # use clatter_shock::standard_curve;
    /// let curve = standard_curve("MIL-STD-810/516/crash-ground").unwrap().limit_curve()?;
    /// assert!((curve.at(1000.0).unwrap() - 75.0 * 9.80665).abs() < 1e-9);
    /// assert!((curve.at(40.0).unwrap() - 37.5 * 9.80665).abs() < 1e-9); // 6 dB an octave
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// None for the curves of [`STANDARD_CURVES`].
    pub fn limit_curve(&self) -> Result<LimitCurve, Error> {
        LimitCurve::new(self.points.iter().map(|&(hz, level)| (hz, level * STANDARD_GRAVITY_M_S2)).collect())
    }
}

/// The common part of the curves of MIL-STD-810: from 10 Hz a rise of 6 dB an octave (as the frequency) to the
/// crossover frequency, then level to 2 kHz.
const MIL_STD_810: StandardCurve = StandardCurve {
    keyword: "",
    title: "",
    points: &[],
    unit: "gn",
    quantity: Quantity::AbsoluteAcceleration,
    quality_factor: 10.0,
    source: "MIL-STD-810F, method 516.5, table 516.5-I and figure 516.5-8 (table 516.8-III of MIL-STD-810H): for use if \
             measured data are not available",
};

/// The limit curves that are built in; levels in gn at Q = 10.
pub const STANDARD_CURVES: [StandardCurve; 4] = [
    StandardCurve {
        keyword: "MIL-STD-810/516/functional-flight",
        title: "functional shock, flight equipment",
        points: &[(10.0, 20.0 * 10.0 / 45.0), (45.0, 20.0), (2000.0, 20.0)],
        ..MIL_STD_810
    },
    StandardCurve {
        keyword: "MIL-STD-810/516/functional-ground",
        title: "functional shock, ground equipment",
        points: &[(10.0, 40.0 * 10.0 / 45.0), (45.0, 40.0), (2000.0, 40.0)],
        ..MIL_STD_810
    },
    StandardCurve {
        keyword: "MIL-STD-810/516/crash-flight",
        title: "crash hazard shock, flight equipment",
        points: &[(10.0, 40.0 * 10.0 / 45.0), (45.0, 40.0), (2000.0, 40.0)],
        ..MIL_STD_810
    },
    StandardCurve {
        keyword: "MIL-STD-810/516/crash-ground",
        title: "crash hazard shock, ground equipment",
        points: &[(10.0, 75.0 * 10.0 / 80.0), (80.0, 75.0), (2000.0, 75.0)],
        ..MIL_STD_810
    },
];

/// A test pulse of a standard.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct StandardPulse {
    /// Its name on the command line and in files.
    pub keyword: &'static str,
    /// Its shape.
    pub shape: Shape,
    /// Peak acceleration in standard gravities.
    pub peak_g: f64,
    /// Duration in milliseconds.
    pub duration_ms: f64,
    /// Its printed source.
    pub source: &'static str,
}

impl StandardPulse {
    /// Returns the pulse in SI units, from time zero.
    ///
    /// ```
    /// let pulse = clatter_shock::standard_pulse("JESD22-B110/B").unwrap().pulse();
    /// assert!((pulse.velocity_change() - 4.68).abs() < 0.005); // 468 cm/s in the table of the standard
    /// ```
    #[must_use]
    pub fn pulse(&self) -> Pulse {
        Pulse {
            shape: self.shape,
            amplitude: self.peak_g * STANDARD_GRAVITY_M_S2,
            duration: self.duration_ms * 1e-3,
            start: 0.0,
        }
    }
}

const fn sawtooth(keyword: &'static str, peak_g: f64) -> StandardPulse {
    let source = "MIL-STD-810H, method 516.8, table 516.8-IV: terminal-peak sawtooth, procedure I";
    StandardPulse { keyword, shape: Shape::TerminalPeakSawtooth, peak_g, duration_ms: 11.0, source }
}

const fn half_sine(keyword: &'static str, peak_g: f64, duration_ms: f64) -> StandardPulse {
    let source = "JESD22-B110B, table 1: service conditions, free state";
    StandardPulse { keyword, shape: Shape::HalfSine, peak_g, duration_ms, source }
}

/// The pulses that are built in.
pub const STANDARD_PULSES: [StandardPulse; 12] = [
    sawtooth("MIL-STD-810H/516.8/functional-flight", 20.0),
    sawtooth("MIL-STD-810H/516.8/functional-captive-carry", 30.0),
    sawtooth("MIL-STD-810H/516.8/functional-ground", 40.0),
    half_sine("JESD22-B110/H", 2900.0, 0.3),
    half_sine("JESD22-B110/G", 2000.0, 0.4),
    half_sine("JESD22-B110/B", 1500.0, 0.5),
    half_sine("JESD22-B110/F", 900.0, 0.7),
    half_sine("JESD22-B110/A", 500.0, 1.0),
    half_sine("JESD22-B110/E", 340.0, 1.2),
    half_sine("JESD22-B110/D", 200.0, 1.5),
    half_sine("JESD22-B110/C", 100.0, 2.0),
    StandardPulse {
        source: "JESD22-B111A: the input pulse of the board-level drop test",
        ..half_sine("JESD22-B111A", 1500.0, 0.5)
    },
];

/// Returns a built-in curve by its keyword, in capital letters or not.
///
/// ```
/// assert_eq!(clatter_shock::standard_curve("mil-std-810/516/functional-flight").unwrap().points[1], (45.0, 20.0));
/// assert!(clatter_shock::standard_curve("MIL-STD-810").is_none());
/// ```
#[must_use]
pub fn standard_curve(keyword: &str) -> Option<&'static StandardCurve> {
    static CURVES: [StandardCurve; 4] = STANDARD_CURVES;
    CURVES.iter().find(|curve| curve.keyword.eq_ignore_ascii_case(keyword))
}

/// Returns a built-in pulse by its keyword, in capital letters or not.
///
/// ```
/// let pulse = clatter_shock::standard_pulse("jesd22-b111a").unwrap();
/// assert_eq!((pulse.peak_g, pulse.duration_ms), (1500.0, 0.5));
/// ```
#[must_use]
pub fn standard_pulse(keyword: &str) -> Option<&'static StandardPulse> {
    static PULSES: [StandardPulse; 12] = STANDARD_PULSES;
    PULSES.iter().find(|pulse| pulse.keyword.eq_ignore_ascii_case(keyword))
}

/// A service condition that covers the response of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServiceCondition {
    /// The pulse.
    pub pulse: &'static StandardPulse,
    /// The largest acceleration that the pulse gives the part over that of its response, at least 1.
    pub acceleration: f64,
    /// The largest relative displacement that the pulse gives the part over that of its response, at least 1.
    pub displacement: f64,
}

/// Returns the least service condition of JESD22-B110 that covers a response: its half-sine gives the part no smaller
/// acceleration and no smaller relative displacement, by its spectra at the frequency and damping of the part. `None`
/// where no condition does.
///
/// From one condition to the next both the peak and the velocity change rise: C, D, E, A, F, B, G, H.
///
/// # Examples
/// A drop by 1 m that rebounds with e = 0.3 changes the velocity by 5.8 m/s, more than any condition: a part that is
/// slow relative to all pulses is not covered. A part that follows the pulse of 1 ms is covered, by a higher peak.
/// ```
/// use clatter_shock::{DampingRatio, Pulse, Pulses, Shape, Suspension, covering_condition};
/// let drop = Pulses::new(&[Pulse { shape: Shape::HalfSine, amplitude: 9046.0, duration: 1e-3, start: 0.0 }])?;
/// let part = |hz| Suspension::from_hz(hz, DampingRatio::new(0.05).unwrap()).unwrap();
/// let covers = |hz| covering_condition(&part(hz), &drop.respond(&part(hz))).map(|found| found.pulse.keyword);
/// assert_eq!([covers(50.0), covers(10_000.0)], [None, Some("JESD22-B110/B")]);
/// # Ok::<(), clatter_shock::Error>(())
/// ```
#[must_use]
pub fn covering_condition(suspension: &Suspension, response: &Response) -> Option<ServiceCondition> {
    static PULSES: [StandardPulse; 12] = STANDARD_PULSES;
    let conditions = PULSES.iter().rev().filter(|pulse| pulse.keyword.starts_with("JESD22-B110/"));
    let beside = |pulse: &'static StandardPulse| {
        let does = Pulses::new(&[pulse.pulse()]).ok()?.respond(suspension);
        Some(ServiceCondition {
            pulse,
            acceleration: does.absolute_acceleration.magnitude() / response.absolute_acceleration.magnitude(),
            displacement: does.relative_displacement.magnitude() / response.relative_displacement.magnitude(),
        })
    };
    conditions.filter_map(beside).find(|of| of.acceleration >= 1.0 && of.displacement >= 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_rise_by_six_decibels_an_octave_to_a_level() {
        // Level and crossover frequency as the table prints them.
        let table = [(20.0, 45.0), (40.0, 45.0), (40.0, 45.0), (75.0, 80.0)];
        for (curve, (level, crossover)) in STANDARD_CURVES.iter().zip(table) {
            assert_eq!((curve.unit, curve.quality_factor), ("gn", 10.0));
            let limit = curve.limit_curve().expect("a curve");
            let at = |hz| limit.at(hz).map(|a| a / STANDARD_GRAVITY_M_S2);
            for (hz, want) in [
                (10.0, level * 10.0 / crossover),
                (crossover / 2.0, level / 2.0),
                (crossover, level),
                (500.0, level),
                (2000.0, level),
            ] {
                let got = at(hz).expect("within the curve");
                assert!((got / want - 1.0).abs() < 1e-13, "{}, {hz} Hz: {got} g, not {want}", curve.keyword);
            }
            assert_eq!((at(9.99), at(2001.0)), (None, None), "{}", curve.keyword);
            assert_eq!(standard_curve(curve.keyword), Some(curve));
        }
    }

    /// Compares the velocity changes with those that the standard prints with peak and duration, in cm/s.
    #[test]
    fn pulses_have_the_velocity_change_of_their_tables() {
        let printed = [543.0, 499.0, 468.0, 393.0, 312.0, 255.0, 187.0, 125.0];
        let component = STANDARD_PULSES.iter().filter(|p| p.keyword.starts_with("JESD22-B110/"));
        for (pulse, printed) in component.clone().zip(printed) {
            let change = 100.0 * pulse.pulse().velocity_change();
            // Printed to three digits.
            assert!((change - printed).abs() < 0.7, "{}: {change} cm/s, not {printed}", pulse.keyword);
        }
        assert_eq!(component.count(), 8);
        // A sawtooth of 40 g and 11 ms: 40 · 9.80665 · 0.011/2.
        let ground = standard_pulse("MIL-STD-810H/516.8/functional-ground").expect("built in").pulse();
        assert!((ground.velocity_change() - 2.157_463).abs() < 1e-12, "{ground:?}");
        for (i, pulse) in STANDARD_PULSES.iter().enumerate() {
            let same = |other: &&StandardPulse| other.keyword.eq_ignore_ascii_case(pulse.keyword);
            assert_eq!(STANDARD_PULSES.iter().filter(same).count(), 1, "{i}");
        }
    }

    /// The returned condition covers the response, and the next lower one does not.
    #[test]
    fn the_least_condition_that_covers_is_told() {
        let damping = crate::DampingRatio::new(0.05).expect("a ratio");
        let order = ["C", "D", "E", "A", "F", "B", "G", "H"].map(|name| format!("JESD22-B110/{name}"));
        let mut told = Vec::new();
        for hz in [60.0, 200.0, 700.0, 3000.0, 20_000.0] {
            let part = Suspension::from_hz(hz, damping).expect("a part");
            let respond = |pulse: Pulse| Pulses::new(&[pulse]).expect("a pulse").respond(&part);
            let peaks = |response: &Response| {
                [response.absolute_acceleration.magnitude(), response.relative_displacement.magnitude()]
            };
            for (amplitude, duration) in
                [(300.0, 2e-3), (2000.0, 3e-3), (4000.0, 5e-4), (15_000.0, 2e-4), (9000.0, 1e-3)]
            {
                let drop = respond(Pulse { shape: Shape::HalfSine, amplitude, duration, start: 0.0 });
                let covers = |name: &String| {
                    let pulse = standard_pulse(name).expect("built in").pulse();
                    peaks(&respond(pulse)).into_iter().zip(peaks(&drop)).all(|(does, wanted)| does >= wanted)
                };
                let first = order.iter().find(|name| covers(name)).map(String::as_str);
                assert_eq!(
                    covering_condition(&part, &drop).map(|found| found.pulse.keyword),
                    first,
                    "{hz} Hz, {amplitude}"
                );
                told.push(first);
            }
        }
        assert!(
            told.contains(&None) && told.contains(&Some("JESD22-B110/C")) && told.contains(&Some("JESD22-B110/B")),
            "{told:?}"
        );
    }
}
