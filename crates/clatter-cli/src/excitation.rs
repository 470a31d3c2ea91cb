//! This module reads the arguments of a command for the shocks on a component, and for its limits.

use clatter_product::units::{ACCELERATION, Dimension, FREQUENCY, LENGTH, Quantity, SPEED, TIME, Unit};
use clatter_shock::{
    Error, Frequencies, LimitCurve, Pulse, Pulses, STANDARD_GRAVITY_M_S2, Shape, ShockTable, VelocityShock,
};

use crate::inputs::{number, parts, share};
use crate::numbers::given;
use crate::quantities::{neat, plain_or_typed};
use crate::text::visible;

/// The length of a ramp of a trapezoid without given ramps, over the length of the trapezoid.
const RAMP: f64 = 0.1;

/// One `--pulse`: a shape, and when it comes.
#[derive(Debug, Clone)]
pub(crate) struct PulseArg {
    pub(crate) pulses: Vec<Pulse>,
    /// The unit of the amplitude, where one was typed.
    pub(crate) unit: Option<&'static Unit>,
}

/// The range of pulses and frequencies, in their units: far beyond any real value, and well within floating-point numbers.
const RANGE: std::ops::RangeInclusive<f64> = 1e-12..=1e12;

/// Returns `value` if it is in [`RANGE`].
fn within(name: &str, value: f64) -> Result<f64, String> {
    // A value that no quantity can have (no number, infinite, or not above 0) is refused by the type that it becomes.
    if RANGE.contains(&value) || value.is_nan() || value <= 0.0 || value.is_infinite() {
        return Ok(value);
    }
    Err(format!("{name} = {value:?} is not in [1e-12, 1e12]"))
}

fn message(error: &Error) -> String {
    match error {
        Error::ZeroDuration => "a pulse of zero duration is a velocity shock: give its velocity change as \
                                --shock=DELTA_V_M_S,TIME_S, or a duration > 0"
            .to_owned(),
        // A list of one: the flag says where it stands.
        Error::Entry { name, value, allowed, .. } => format!("{name} = {value:?} is not {allowed}"),
        error => error.to_string(),
    }
}

pub(crate) fn shape(text: &str) -> Result<Shape, String> {
    // "Half sine" is half-sine.
    let spelled = text.trim().to_lowercase().replace([' ', '_'], "-");
    match (spelled.as_str(), spelled.split_once(':')) {
        ("half-sine" | "halfsine", _) => Ok(Shape::HalfSine),
        ("haversine", _) => Ok(Shape::Haversine),
        ("triangle", _) => Ok(Shape::Triangle),
        ("initial-peak-sawtooth", _) => Ok(Shape::InitialPeakSawtooth),
        ("terminal-peak-sawtooth", _) => Ok(Shape::TerminalPeakSawtooth),
        ("rectangle", _) => Ok(Shape::Rectangle),
        ("trapezoid", _) => Ok(Shape::Trapezoid { ramp: RAMP }),
        (_, Some(("trapezoid", ramp))) => Ok(Shape::Trapezoid { ramp: share(ramp)? }),
        _ => Err(format!(
            "'{}' is no shape; there are half-sine, haversine, triangle, initial-peak-sawtooth, \
             terminal-peak-sawtooth, rectangle, trapezoid and trapezoid:RAMP",
            visible(text)
        )),
    }
}

/// Reads a pulse by the keyword of a standard, or by shape, amplitude, duration and starts.
pub(crate) fn pulse(text: &str) -> Result<PulseArg, String> {
    if let Some(standard) = clatter_shock::standard_pulse(text) {
        return Ok(PulseArg { pulses: vec![standard.pulse()], unit: plain_or_typed(&ACCELERATION, "1gn")?.unit });
    }
    let [name, amplitude, duration, starts @ ..] = &parts(text, ',')[..] else {
        let known: Vec<_> = clatter_shock::STANDARD_PULSES.iter().map(|pulse| pulse.keyword).collect();
        return Err(format!(
            "a pulse is SHAPE,AMPLITUDE,DURATION,START, such as half-sine,1500gn,0.5ms,0s; numbers without a unit are in \
             SI: SHAPE,AMPLITUDE_M_S2,DURATION_S,START_S. Levels that are built in: {}; those of other standards, IEC 60068-2-27 among \
             them, are given so",
            known.join(", ")
        ));
    };
    let (shape, amplitude, duration) =
        (shape(name)?, plain_or_typed(&ACCELERATION, amplitude)?, plain_or_typed(&TIME, duration)?);
    let mut starts =
        starts.iter().map(|start| Ok(plain_or_typed(&TIME, start)?.si)).collect::<Result<Vec<_>, String>>()?;
    if starts.is_empty() {
        starts.push(0.0);
    }
    let pulses = starts.into_iter().map(|start| Pulse { shape, amplitude: amplitude.si, duration: duration.si, start });
    let pulses = pulses.map(checked).collect::<Result<_, _>>()?;
    Ok(PulseArg { pulses, unit: amplitude.unit })
}

/// Refuses a pulse that is not valid.
pub(crate) fn checked(pulse: Pulse) -> Result<Pulse, String> {
    within("duration", pulse.duration)?;
    within("amplitude", pulse.amplitude.abs())?;
    within("start", pulse.start.abs())?;
    Pulses::new(&[pulse]).map(|_| pulse).map_err(|error| message(&error))
}

pub(crate) fn shock(text: &str) -> Result<VelocityShock, String> {
    let [delta_v, time] = parts(text, ',')[..] else {
        return Err(
            "a velocity shock is DELTA_V,TIME, such as 2.5m/s,0s, or DELTA_V_M_S,TIME_S, such as 2.5,0".to_owned()
        );
    };
    let shock = VelocityShock { delta_v: plain_or_typed(&SPEED, delta_v)?.si, time: plain_or_typed(&TIME, time)?.si };
    clatter_shock::VelocityShocks::new(vec![shock]).map_err(|error| message(&error))?;
    Ok(shock)
}

/// Natural frequencies, and the unit that they were typed in.
#[derive(Debug, Clone)]
pub(crate) struct FrequencyArg {
    pub(crate) list: Frequencies,
    pub(crate) unit: Option<&'static Unit>,
}

pub(crate) fn frequencies(text: &str) -> Result<FrequencyArg, String> {
    let typed = |text: &str| {
        let hz = plain_or_typed(&FREQUENCY, text)?;
        within("frequency", hz.si)?;
        Ok::<_, String>(hz)
    };
    let (list, unit) = if text.contains(':') {
        let [low, high, per_octave] = parts(text, ':')[..] else {
            return Err("frequencies are HZ,HZ,… or LO:HI:PER_OCTAVE, such as 10:10000:12 or 10Hz:10kHz:12".to_owned());
        };
        let (low, high) = (typed(low)?, typed(high)?);
        (Frequencies::per_octave(low.si, high.si, number(per_octave)?), low.unit)
    } else {
        let all = parts(text, ',').into_iter().map(typed).collect::<Result<Vec<_>, _>>()?;
        (Frequencies::list(all.iter().map(|hz| hz.si).collect()), all.first().and_then(|hz| hz.unit))
    };
    let list = list.map_err(|error| error.to_string())?;
    Ok(FrequencyArg { list, unit })
}

/// A limit, and the one value that it has if it is level.
#[derive(Debug, Clone)]
pub(crate) struct LimitArg {
    pub(crate) curve: LimitCurve,
    pub(crate) level: Option<f64>,
    /// The limited quantity and its unit, where a unit was typed.
    pub(crate) typed: Option<Typed>,
}

/// A kind of quantity and one of its units.
pub(crate) type Typed = (&'static Dimension, &'static Unit);

/// The quantities of a response that a limit may be given for.
const LIMITED: [&Dimension; 3] = [&ACCELERATION, &LENGTH, &SPEED];

/// Reads a value of any kind that can be limited.
fn allowed(text: &str) -> Result<(f64, Option<Typed>), String> {
    let read = |dimension: &'static Dimension| {
        let Quantity { si, unit } = plain_or_typed(dimension, text).ok()?;
        Some((si, unit.map(|unit| (dimension, unit))))
    };
    LIMITED.into_iter().find_map(read).ok_or_else(|| {
        let units: Vec<_> = LIMITED.iter().map(|dimension| dimension.names()).collect();
        format!(
            "'{}' is not a number such as 4000, in the unit of the quantity, or one with its unit such as 1500gn: {}",
            visible(text),
            units.join(", ")
        )
    })
}

pub(crate) fn limit(text: &str) -> Result<LimitArg, String> {
    if let Some(standard) = clatter_shock::standard_curve(text) {
        let curve = standard.limit_curve().map_err(|error| error.to_string())?;
        let unit = ACCELERATION.unit(standard.unit);
        return Ok(LimitArg { curve, level: None, typed: unit.map(|unit| (&ACCELERATION, unit)) });
    }
    if !text.contains(':') {
        let (level, typed) = allowed(text)?;
        let curve = LimitCurve::constant(level).map_err(|error| error.to_string())?;
        return Ok(LimitArg { curve, level: Some(level), typed });
    }
    let mut units = Vec::new();
    let mut point = |pair: &str| {
        let (hz, value) = pair.split_once(':').ok_or("a limit is one value, or points HZ:VALUE,HZ:VALUE,…")?;
        let (value, typed) = allowed(value)?;
        units.push(typed);
        Ok::<_, String>((plain_or_typed(&FREQUENCY, hz)?.si, value))
    };
    let points = parts(text, ',').into_iter().map(&mut point).collect::<Result<Vec<_>, _>>()?;
    let curve = LimitCurve::new(points).map_err(|error| error.to_string())?;
    let typed = units.first().copied().flatten();
    if units.iter().any(|unit| unit.map(|(dimension, _)| dimension.name) != typed.map(|(dimension, _)| dimension.name))
    {
        return Err("the points of a limit are of one kind: all with a unit of it, or none".to_owned());
    }
    Ok(LimitArg { curve, level: None, typed })
}

/// The distance by which a spectrum may be below the required one, and above it if that is limited at all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tolerance {
    pub(crate) below_db: f64,
    pub(crate) above_db: Option<f64>,
}

/// Reads a tolerance: `3` is 3 dB on either side, `-1.5` is 1.5 dB below and anything above, `-1.5,6` has both.
pub(crate) fn tolerance(text: &str) -> Result<Tolerance, String> {
    let form =
        "a tolerance in dB is one number for both sides, such as 3, or -BELOW,ABOVE, such as -1.5,6, or -BELOW alone";
    let db = |text: &str| {
        let value = number(text.trim().strip_suffix("dB").unwrap_or(text).trim().trim_start_matches('+'))?;
        if value.abs() <= 60.0 { Ok(value) } else { Err(format!("{value:?} dB is not in [-60, 60]; {form}")) }
    };
    match parts(text, ',')[..] {
        [one] => match db(one)? {
            value if value < 0.0 => Ok(Tolerance { below_db: -value, above_db: None }),
            value => Ok(Tolerance { below_db: value, above_db: Some(value) }),
        },
        [below, above] => match (db(below)?, db(above)?) {
            (below, above) if below <= 0.0 && above >= 0.0 => Ok(Tolerance { below_db: -below, above_db: Some(above) }),
            _ => Err(form.to_owned()),
        },
        _ => Err(form.to_owned()),
    }
}

/// Reads the range of a shock table; in ms, gn and m/s where no unit is given.
pub(crate) fn shock_table(text: &str) -> Result<ShockTable, String> {
    let form = "a shock table is SHORTEST:LONGEST,ACCELERATION,VELOCITY_CHANGE in ms, gn and m/s, such as 0.2:20,5000,20 or \
                0.2ms:20ms,5000gn,20m/s";
    let [durations, acceleration, velocity_change] = parts(text, ',')[..] else {
        return Err(form.to_owned());
    };
    let [shortest, longest] = parts(durations, ':')[..] else {
        return Err(form.to_owned());
    };
    let positive = |name: &str, dimension: &'static Dimension, plain: f64, text: &str| {
        let Quantity { si, unit } = plain_or_typed(dimension, text)?;
        if si > 0.0 && si.is_finite() {
            Ok(if unit.is_some() { si } else { plain * si })
        } else {
            Err(format!("{name} = {si:?} is not finite and > 0"))
        }
    };
    let table = ShockTable {
        shortest: positive("shortest half-sine in ms", &TIME, 1e-3, shortest)?,
        longest: positive("longest half-sine in ms", &TIME, 1e-3, longest)?,
        acceleration: positive("acceleration in gn", &ACCELERATION, STANDARD_GRAVITY_M_S2, acceleration)?,
        velocity_change: positive("velocity change in m/s", &SPEED, 1.0, velocity_change)?,
    };
    if table.shortest > table.longest {
        let [shortest, longest] = [table.shortest, table.longest].map(|s| given(neat(1e3 * s)));
        return Err(format!("the shortest half-sine, {shortest} ms, is longer than the longest, {longest} ms"));
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pulse begins at 0 where no start is given, and once for each that is.
    #[test]
    fn a_pulse_begins_where_it_is_told() {
        let starts = |text| pulse(text).map(|of| of.pulses.iter().map(|pulse| pulse.start).collect::<Vec<_>>());
        assert_eq!(starts("half-sine,100,1ms"), Ok(vec![0.0]));
        assert_eq!(starts("half-sine,100,1ms,2ms,0.5s"), Ok(vec![2e-3, 0.5]));
    }

    #[test]
    fn tolerances_have_a_side_or_two() {
        let of = |text| tolerance(text).map(|Tolerance { below_db, above_db }| (below_db, above_db));
        assert_eq!(of("3"), Ok((3.0, Some(3.0))));
        assert_eq!(of("-1.5dB, +6 dB"), Ok((1.5, Some(6.0))));
        assert_eq!(of("-1.5"), Ok((1.5, None)));
        assert_eq!(of("0"), Ok((0.0, Some(0.0))));
        for bad in ["1,2", "-1,-2", "70", "", "a", "1,2,3", "nan"] {
            assert!(of(bad).is_err(), "{bad}");
        }
    }
}
