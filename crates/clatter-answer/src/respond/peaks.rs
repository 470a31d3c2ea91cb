//! This module holds the common content of all answers about a part: peaks, single shocks for comparison, the equivalent pulse.

use clatter_assess::Answer;
use clatter_product::Unit;
use clatter_shock::{
    DampingRatio, EquivalentPulse, Hit, ImpulseFactors, Response, STANDARD_GRAVITY_M_S2, ShockTable, Suspension,
    covering_condition,
};
use serde::Serialize;

use crate::{Error, Json};

/// A part on its suspension and its peaks, as velocities: W z of the displacement z relative to its base, A/W of the absolute
/// acceleration A.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Peaks {
    /// Natural angular frequency W.
    pub omega: Json,
    /// Damping ratio.
    pub damping: Json,
    /// Largest W z.
    pub omega_peak_relative_displacement: Json,
    /// Largest A/W.
    pub peak_absolute_acceleration_over_omega: Json,
    /// The time of the largest absolute acceleration; the other times are in `peaks`.
    pub time_of_peak: Json,
    /// The peaks of either sign.
    pub peaks: AllPeaks,
}

/// The peaks of a part.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct AllPeaks {
    /// The extremes of W z.
    pub omega_relative_displacement: Extremes,
    /// The extremes of z′.
    pub relative_velocity: Extremes,
    /// The extremes of A/W.
    pub absolute_acceleration_over_omega: Extremes,
}

/// The largest values of either sign.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Extremes {
    /// The largest.
    pub positive: Extreme,
    /// The smallest.
    pub negative: Extreme,
    /// The larger in size, the earlier where they tie.
    #[serde(skip)]
    pub peak: Extreme,
}

/// A value and when it is reached.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Extreme {
    /// The value.
    pub value: Json,
    /// The time at which it is reached.
    pub time: Json,
    /// Number of the impact, shock or start of a pulse that it follows, where that is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub after_impact: Option<usize>,
}

impl Peaks {
    /// Makes the peaks; `number` is that of the shock that an extreme follows, where it is known.
    pub(super) fn new(
        part: &Suspension,
        response: &Response,
        number: impl Fn(clatter_shock::Extreme) -> Option<usize>,
    ) -> Self {
        let extreme =
            |e: clatter_shock::Extreme| Extreme { value: Json(e.value), time: Json(e.time), after_impact: number(e) };
        let all = |all: clatter_shock::Extremes| {
            let [positive, negative, peak] = [all.positive, all.negative, all.peak()].map(extreme);
            Extremes { positive, negative, peak }
        };
        let (displacement, acceleration) = (response.pseudo_velocity(), response.acceleration_over_omega());
        Self {
            omega: Json(part.omega()),
            damping: Json(part.damping().get()),
            omega_peak_relative_displacement: Json(displacement.magnitude()),
            peak_absolute_acceleration_over_omega: Json(acceleration.magnitude()),
            time_of_peak: Json(acceleration.peak().time),
            peaks: AllPeaks {
                omega_relative_displacement: all(displacement),
                relative_velocity: all(response.relative_velocity),
                absolute_acceleration_over_omega: all(acceleration),
            },
        }
    }

    /// Returns the peak acceleration over that of a single shock.
    pub(super) fn gain(&self, shock: &Factors) -> Json {
        Json(self.peak_absolute_acceleration_over_omega.0 / shock.peak_absolute_acceleration_over_omega.0)
    }
}

/// The hits of the stops of a part.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct AtStop {
    /// The largest speed at which the part reaches a stop, relative to its base; 0 where it reaches none.
    pub largest_hit_m_s: Json,
    /// All hits, in order of time.
    pub hits: Vec<HitStop>,
}

/// A hit of a stop.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct HitStop {
    /// The time at which the stop is reached.
    pub time_s: Json,
    /// The speed of the part relative to its base.
    pub speed_m_s: Json,
}

impl AtStop {
    pub(super) fn of(hits: &[Hit]) -> Self {
        let largest = hits.iter().map(|hit| hit.speed).fold(0.0, f64::max);
        let hits = hits.iter().map(|hit| HitStop { time_s: Json(hit.time), speed_m_s: Json(hit.speed) }).collect();
        Self { largest_hit_m_s: Json(largest), hits }
    }
}

/// The response of a part to one velocity shock, as velocities.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Factors {
    /// The shock.
    #[serde(skip)]
    pub shock: f64,
    /// Largest W z.
    pub omega_peak_relative_displacement: Json,
    /// Largest A/W.
    pub peak_absolute_acceleration_over_omega: Json,
}

impl Factors {
    /// Computes the response of a part with this damping to a shock.
    #[must_use]
    pub fn new(damping: DampingRatio, shock: f64) -> Self {
        Self::of(shock, damping.impulse_factors().times(shock))
    }

    pub(super) fn of(shock: f64, factors: ImpulseFactors) -> Self {
        Self {
            shock,
            omega_peak_relative_displacement: Json(factors.displacement),
            peak_absolute_acceleration_over_omega: Json(factors.acceleration),
        }
    }

    /// Returns the response where all of a product rebounds at one instant, without spin, as it would without clatter; and the one that
    /// standards assume.
    pub(super) fn at_once(damping: DampingRatio, e: f64, speed: f64) -> [Self; 2] {
        [(1.0 + e) * speed, 2.0 * speed].map(|shock| Self::new(damping, shock))
    }
}

/// The half-sine of a shock table that does the same to a part; null, with the reason, where there is none.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Equivalent {
    /// The half-sine.
    pub equivalent_pulse: Option<HalfSine>,
    /// The reason why there is no equivalent pulse.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub no_equivalent_pulse: Option<String>,
    /// The least service condition of JESD22-B110 that covers what the part goes through; null where none does.
    pub service_condition: Option<ServiceCondition>,
}

/// A service condition of a shock test, for comparison with the response of the part.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct ServiceCondition {
    /// Its name, as of `--pulse`.
    pub pulse: &'static str,
    /// Peak of its half-sine in standard gravities.
    pub acceleration_g: Json,
    /// The duration of the half-sine.
    pub duration_s: Json,
    /// The largest acceleration that it gives the part over that in the drop.
    pub acceleration_ratio: Json,
    /// The same of the relative displacement.
    pub displacement_ratio: Json,
}

impl From<clatter_shock::ServiceCondition> for ServiceCondition {
    fn from(found: clatter_shock::ServiceCondition) -> Self {
        Self {
            pulse: found.pulse.keyword,
            acceleration_g: Json(found.pulse.peak_g),
            duration_s: Json(1e-3 * found.pulse.duration_ms),
            acceleration_ratio: Json(found.acceleration),
            displacement_ratio: Json(found.displacement),
        }
    }
}

/// A half-sine that gives a part the same acceleration.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct HalfSine {
    /// The shape, which is `half-sine`.
    pub shape: &'static str,
    /// Its peak.
    pub acceleration_m_s2: Json,
    /// The same in standard gravities.
    pub acceleration_g: Json,
    /// Its length.
    pub duration_s: Json,
    /// Its area.
    pub velocity_change_m_s: Json,
    /// Its relative displacement over that of the part, less 1.
    pub displacement_mismatch: Json,
}

/// The reason why no pulse is equivalent to nothing.
pub const NOTHING_FELT: &str = "nothing is felt here, which no pulse does";

/// The mismatch of the relative displacement that an equivalent pulse may have.
const EQUIVALENT: f64 = 0.01;

impl Equivalent {
    pub(super) fn new(table: &ShockTable, suspension: &Suspension, response: &Response) -> Result<Self, Error> {
        let is_felt = response.absolute_acceleration.magnitude() > 0.0;
        let covering = is_felt.then(|| covering_condition(suspension, response)).flatten();
        let service_condition = covering.map(ServiceCondition::from);
        let none = |why: String| Self { equivalent_pulse: None, no_equivalent_pulse: Some(why), service_condition };
        if !is_felt {
            return Ok(none(NOTHING_FELT.to_owned()));
        }
        let EquivalentPulse { pulse, displacement_mismatch } =
            match table.equivalent_half_sine(suspension, response, EQUIVALENT) {
                Err(error @ clatter_shock::Error::NoEquivalent { .. }) => return Ok(none(error.to_string())),
                found => found?,
            };
        let half_sine = HalfSine {
            shape: "half-sine",
            acceleration_m_s2: Json(pulse.amplitude),
            acceleration_g: Json(pulse.amplitude / STANDARD_GRAVITY_M_S2),
            duration_s: Json(pulse.duration),
            velocity_change_m_s: Json(pulse.velocity_change()),
            displacement_mismatch: Json(displacement_mismatch),
        };
        Ok(Self { equivalent_pulse: Some(half_sine), no_equivalent_pulse: None, service_condition })
    }
}

/// The largest values of a drop at a place and of a part there; null where nothing acts, and of a part that is mounted rigidly.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct LargestValues {
    /// The largest change of velocity of the place.
    pub velocity_change: Option<Largest>,
    /// The largest acceleration of the place.
    pub acceleration: Option<Largest>,
    /// The largest change of angular velocity of the product.
    pub angular_velocity_change: Option<Largest>,
    /// The largest acceleration of the part.
    pub part_acceleration: Option<Largest>,
    /// The largest displacement of the part, relative to its place.
    pub part_displacement: Option<Largest>,
}

/// A largest value, when it comes and how far off it may be.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Largest {
    /// The value, in the unit.
    pub value: Json,
    /// The SI unit.
    pub unit: Unit,
    /// The time since the first touch.
    pub time_s: Json,
    /// Number of the impact.
    pub impact: u64,
    /// The largest error, as a share of the value.
    pub error: Json,
}

impl From<Answer> for Largest {
    fn from(answer: Answer) -> Self {
        Self {
            value: Json(answer.value),
            unit: answer.unit,
            time_s: Json(answer.time_s),
            impact: answer.impact,
            error: Json(answer.error()),
        }
    }
}
