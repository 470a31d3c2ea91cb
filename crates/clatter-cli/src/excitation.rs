//! What shakes a component, and what it stands, as arguments of a command say it.

use clatter_shock::{
    Error, Frequencies, LimitCurve, Pulse, Pulses, STANDARD_GRAVITY_M_S2, Shape, ShockTable, Units, VelocityShock,
};

use crate::inputs::number;
use crate::text::visible;

/// Ramps of a trapezoid whose ramps nobody gave, over its length.
const RAMP: f64 = 0.1;

/// One `--pulse`: a shape, and when it comes.
#[derive(Debug, Clone)]
pub(crate) struct PulseArg(pub(crate) Vec<Pulse>);

/// What a pulse and a frequency may be, in their units: far beyond any that there are, and far within the floats.
const RANGE: std::ops::RangeInclusive<f64> = 1e-12..=1e12;
/// Periods that a pulse may last: each of its turning points is found.
const MOST_PERIODS: f64 = 1e5;

/// `value` if it is in [`RANGE`].
fn within(name: &str, value: f64) -> Result<f64, String> {
    // What is none at all is told by the type that it becomes.
    if RANGE.contains(&value) || value.is_nan() || value <= 0.0 || value.is_infinite() {
        return Ok(value);
    }
    Err(format!("{name} = {value:?} is not in [1e-12, 1e12]"))
}

/// Refuses pulses that last too many periods of a component.
pub(crate) fn check_periods(pulses: &[Pulse], frequencies: &Frequencies) -> Result<(), String> {
    let longest = pulses.iter().fold(0.0_f64, |m, p| m.max(p.duration));
    let highest = frequencies.hz().iter().fold(0.0_f64, |m, hz| m.max(*hz));
    if longest * highest <= MOST_PERIODS {
        return Ok(());
    }
    Err(format!("a pulse of {longest:?} s lasts more than 100000 periods of a component of {highest:?} Hz"))
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
    match (text, text.split_once(':')) {
        ("half-sine", _) => Ok(Shape::HalfSine),
        ("haversine", _) => Ok(Shape::Haversine),
        ("triangle", _) => Ok(Shape::Triangle),
        ("initial-peak-sawtooth", _) => Ok(Shape::InitialPeakSawtooth),
        ("terminal-peak-sawtooth", _) => Ok(Shape::TerminalPeakSawtooth),
        ("rectangle", _) => Ok(Shape::Rectangle),
        ("trapezoid", _) => Ok(Shape::Trapezoid { ramp: RAMP }),
        (_, Some(("trapezoid", ramp))) => Ok(Shape::Trapezoid { ramp: number(ramp)? }),
        _ => Err(format!(
            "'{}' is no shape; there are half-sine, haversine, triangle, initial-peak-sawtooth, \
             terminal-peak-sawtooth, rectangle, trapezoid and trapezoid:RAMP",
            visible(text)
        )),
    }
}

/// The name of a shape, as it is given.
pub(crate) fn shape_name(shape: Shape) -> String {
    match shape {
        Shape::HalfSine => "half-sine".to_owned(),
        Shape::Haversine => "haversine".to_owned(),
        Shape::Triangle => "triangle".to_owned(),
        Shape::InitialPeakSawtooth => "initial-peak-sawtooth".to_owned(),
        Shape::TerminalPeakSawtooth => "terminal-peak-sawtooth".to_owned(),
        Shape::Rectangle => "rectangle".to_owned(),
        Shape::Trapezoid { ramp } => format!("trapezoid:{ramp:?}"),
    }
}

pub(crate) fn pulse(text: &str) -> Result<PulseArg, String> {
    let mut parts = text.split(',');
    let (Some(name), Some(amplitude), Some(duration)) = (parts.next(), parts.next(), parts.next()) else {
        return Err("a pulse is SHAPE,AMPLITUDE_M_S2,DURATION_S,START_S, such as half-sine,5000,0.0005,0".to_owned());
    };
    let (shape, amplitude, duration) = (shape(name)?, number(amplitude)?, number(duration)?);
    let mut starts = parts.map(number).collect::<Result<Vec<_>, _>>()?;
    if starts.is_empty() {
        starts.push(0.0);
    }
    let pulses = starts.into_iter().map(|start| Pulse { shape, amplitude, duration, start });
    pulses.map(checked).collect::<Result<_, _>>().map(PulseArg)
}

/// Validates a pulse.
pub(crate) fn checked(pulse: Pulse) -> Result<Pulse, String> {
    within("duration", pulse.duration)?;
    within("amplitude", pulse.amplitude.abs())?;
    within("start", pulse.start.abs())?;
    Pulses::new(&[pulse]).map(|_| pulse).map_err(|error| message(&error))
}

pub(crate) fn shock(text: &str) -> Result<VelocityShock, String> {
    let Some((delta_v, time)) = text.split_once(',') else {
        return Err("a velocity shock is DELTA_V_M_S,TIME_S, such as 2.5,0".to_owned());
    };
    let shock = VelocityShock { delta_v: number(delta_v)?, time: number(time)? };
    clatter_shock::VelocityShocks::new(vec![shock]).map_err(|error| message(&error))?;
    Ok(shock)
}

pub(crate) fn frequencies(text: &str) -> Result<Frequencies, String> {
    for value in text.split([',', ':']).filter_map(|part| part.parse().ok()) {
        within("frequency", value)?;
    }
    let made = if text.contains(':') {
        let [low, high, per_octave] = text.split(':').collect::<Vec<_>>()[..] else {
            return Err("frequencies are HZ,HZ,… or LO:HI:PER_OCTAVE, such as 10:10000:12".to_owned());
        };
        Frequencies::per_octave(number(low)?, number(high)?, number(per_octave)?)
    } else {
        Frequencies::list(text.split(',').map(number).collect::<Result<_, _>>()?)
    };
    made.map_err(|error| error.to_string())
}

/// A limit, and the one value that it has if it is level.
#[derive(Debug, Clone)]
pub(crate) struct LimitArg {
    pub(crate) curve: LimitCurve,
    pub(crate) level: Option<f64>,
}

pub(crate) fn limit(text: &str) -> Result<LimitArg, String> {
    if !text.contains(':') {
        let level = number(text)?;
        let curve = LimitCurve::constant(level).map_err(|error| error.to_string())?;
        return Ok(LimitArg { curve, level: Some(level) });
    }
    let point = |pair: &str| {
        let (hz, allowed) = pair.split_once(':').ok_or("a limit is one value, or points HZ:VALUE,HZ:VALUE,…")?;
        Ok::<_, String>((number(hz)?, number(allowed)?))
    };
    let points = text.split(',').map(point).collect::<Result<Vec<_>, _>>()?;
    let curve = LimitCurve::new(points).map_err(|error| error.to_string())?;
    Ok(LimitArg { curve, level: None })
}

pub(crate) fn units(text: &str) -> Result<Units, String> {
    let (time, acceleration) = text.split_once(',').ok_or("two units are needed, TIME,ACCELERATION, such as ms,g")?;
    Units::named(time, acceleration).map_err(|error| error.to_string())
}

/// What a shock table can do, in ms, g and m/s.
pub(crate) fn shock_table(text: &str) -> Result<ShockTable, String> {
    let form =
        "a shock table is SHORTEST:LONGEST,ACCELERATION,VELOCITY_CHANGE in ms, g and m/s, such as 0.2:20,5000,20";
    let [durations, acceleration, velocity_change] = text.split(',').collect::<Vec<_>>()[..] else {
        return Err(form.to_owned());
    };
    let (shortest, longest) = durations.split_once(':').ok_or(form)?;
    let positive = |name: &str, text: &str| {
        let value = number(text)?;
        if value > 0.0 && value.is_finite() {
            Ok(value)
        } else {
            Err(format!("{name} = {value:?} is not finite and > 0"))
        }
    };
    let table = ShockTable {
        shortest: 1e-3 * positive("shortest half-sine in ms", shortest)?,
        longest: 1e-3 * positive("longest half-sine in ms", longest)?,
        acceleration: STANDARD_GRAVITY_M_S2 * positive("acceleration in g", acceleration)?,
        velocity_change: positive("velocity change in m/s", velocity_change)?,
    };
    if table.shortest > table.longest {
        return Err(format!("the shortest half-sine, {shortest} ms, is longer than the longest, {longest} ms"));
    }
    Ok(table)
}
