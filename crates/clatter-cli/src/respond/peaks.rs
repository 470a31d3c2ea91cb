//! What every answer of `clatter respond` has in common: peaks, single shocks beside them, the equivalent pulse.

use std::io::{self, Write};

use clatter_shock::{
    EquivalentPulse, Extreme, Extremes, ImpulseFactors, Response, STANDARD_GRAVITY_M_S2, ShockTable, Suspension,
};
use serde::Serialize;

use crate::Failure;
use crate::numbers::{Json, figures};
use crate::quantities::Show;

/// Mismatch of the relative displacement that an equivalent pulse may have.
const EQUIVALENT: f64 = 0.01;

/// The half-sine that does the same, or why there is none.
pub(super) type Equivalent = Result<EquivalentPulse, String>;

/// The half-sine of a shock table that does the same to a component.
pub(super) fn equivalent(
    table: &ShockTable,
    suspension: &Suspension,
    response: &Response,
) -> Result<Equivalent, Failure> {
    if response.absolute_acceleration.magnitude() <= 0.0 {
        return Ok(Err("nothing is felt here, which no pulse does".to_owned()));
    }
    match table.equivalent_half_sine(suspension, response, EQUIVALENT) {
        Err(none @ clatter_shock::Error::NoEquivalent { .. }) => Ok(Err(none.to_string())),
        answer => Ok(Ok(answer?)),
    }
}

/// The equivalent pulse for people.
pub(super) fn equivalent_table(equivalent: &Equivalent, out: &mut dyn Write) -> io::Result<()> {
    let EquivalentPulse { pulse, displacement_mismatch } = match equivalent {
        Err(none) => return writeln!(out, "\nShock table: {none}"),
        Ok(found) => found,
    };
    let (g, ms) = (figures(pulse.amplitude / STANDARD_GRAVITY_M_S2), figures(1e3 * pulse.duration));
    let velocity = figures(pulse.velocity_change());
    let off = figures(100.0 * displacement_mismatch);
    writeln!(
        out,
        "\nShock table: a half-sine of {g} g and {ms} ms (velocity change {velocity} m/s) gives the component the\n\
         same acceleration, and a relative displacement that differs by {off} %"
    )
}

/// Single shocks at the position, each with what it does to the component.
pub(super) struct Shocks<'a> {
    pub(super) show: Show,
    pub(super) out: &'a mut dyn Write,
}

impl Shocks<'_> {
    pub(super) fn head(&mut self) -> io::Result<()> {
        let Self { show, out } = self;
        let unit = show.name();
        let (shock, wz, aw) = (format!("shock, {unit}"), format!("W z, {unit}"), format!("A/W, {unit}"));
        writeln!(out, "\n{:<34}{shock:>12} {wz:>13} {aw:>13}", "A shock at this position")
    }
    pub(super) fn row(&mut self, name: &str, shock: f64, peaks: Option<ImpulseFactors>) -> io::Result<()> {
        let show = |x: Option<f64>| x.map_or("-".to_owned(), |x| self.show.figures(x));
        let (z, a) = (show(peaks.map(|p| p.displacement)), show(peaks.map(|p| p.acceleration)));
        writeln!(self.out, "  {name:<32}{:>12} {z:>13} {a:>13}", self.show.figures(shock))
    }
}

/// A clatter without clatter: all of the bar rebounds at once, without spin; and what standards assume.
pub(super) fn at_once(restitution: f64, speed: f64) -> [f64; 2] {
    [(1.0 + restitution) * speed, 2.0 * speed]
}

#[derive(Serialize)]
pub(super) struct PeaksJson {
    omega_relative_displacement: ExtremesJson,
    relative_velocity: ExtremesJson,
    absolute_acceleration_over_omega: ExtremesJson,
}

#[derive(Serialize)]
struct ExtremesJson {
    positive: ExtremeJson,
    negative: ExtremeJson,
}

#[derive(Serialize)]
struct ExtremeJson {
    value: Json,
    time: Json,
    #[serde(skip_serializing_if = "Option::is_none")]
    after_impact: Option<usize>,
}

impl PeaksJson {
    /// `number` is that of the shock that an extreme follows, where it is known.
    pub(super) fn new(response: &Response, number: impl Fn(Extreme) -> Option<usize>) -> Self {
        let extreme = |e: Extreme| ExtremeJson { value: Json(e.value), time: Json(e.time), after_impact: number(e) };
        let both = |all: Extremes| ExtremesJson { positive: extreme(all.positive), negative: extreme(all.negative) };
        Self {
            omega_relative_displacement: both(response.pseudo_velocity()),
            relative_velocity: both(response.relative_velocity),
            absolute_acceleration_over_omega: both(response.acceleration_over_omega()),
        }
    }
}

/// The fields of the contract, and all peaks.
#[derive(Serialize)]
pub(super) struct ResponseJson {
    omega: Json,
    damping: Json,
    omega_peak_relative_displacement: Json,
    peak_absolute_acceleration_over_omega: Json,
    /// Of the absolute acceleration; the other times are below `peaks`.
    time_of_peak: Json,
    peaks: PeaksJson,
}

impl ResponseJson {
    pub(super) fn new(part: &Suspension, response: &Response, number: impl Fn(Extreme) -> Option<usize>) -> Self {
        let acceleration = response.acceleration_over_omega();
        Self {
            omega: Json(part.omega()),
            damping: Json(part.damping().get()),
            omega_peak_relative_displacement: Json(response.pseudo_velocity().magnitude()),
            peak_absolute_acceleration_over_omega: Json(acceleration.magnitude()),
            time_of_peak: Json(acceleration.peak().time),
            peaks: PeaksJson::new(response, number),
        }
    }
}

#[derive(Serialize)]
pub(super) struct FactorsJson {
    omega_peak_relative_displacement: Json,
    peak_absolute_acceleration_over_omega: Json,
}

impl From<ImpulseFactors> for FactorsJson {
    fn from(factors: ImpulseFactors) -> Self {
        Self {
            omega_peak_relative_displacement: Json(factors.displacement),
            peak_absolute_acceleration_over_omega: Json(factors.acceleration),
        }
    }
}

/// The equivalent pulse where it is asked for; null, with the reason, where there is none.
#[derive(Serialize)]
pub(super) struct EquivalentJson {
    equivalent_pulse: Option<HalfSineJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    no_equivalent_pulse: Option<String>,
}

#[derive(Serialize)]
struct HalfSineJson {
    shape: &'static str,
    acceleration_m_s2: Json,
    acceleration_g: Json,
    duration_s: Json,
    velocity_change_m_s: Json,
    /// Its relative displacement over that of the component, less 1.
    displacement_mismatch: Json,
}

impl From<&Equivalent> for EquivalentJson {
    fn from(equivalent: &Equivalent) -> Self {
        let half_sine = |EquivalentPulse { pulse, displacement_mismatch }: &EquivalentPulse| HalfSineJson {
            shape: "half-sine",
            acceleration_m_s2: Json(pulse.amplitude),
            acceleration_g: Json(pulse.amplitude / STANDARD_GRAVITY_M_S2),
            duration_s: Json(pulse.duration),
            velocity_change_m_s: Json(pulse.velocity_change()),
            displacement_mismatch: Json(*displacement_mismatch),
        };
        Self {
            equivalent_pulse: equivalent.as_ref().ok().map(half_sine),
            no_equivalent_pulse: equivalent.as_ref().err().cloned(),
        }
    }
}
