//! What is limited: five quantities, their units, and the limits of a component as numbers.

use std::f64::consts::TAU;

use clatter_shock::{Pulse, Pulses, Shape, Suspension};
use serde::Serialize;

use crate::{Component, Error, Mount, Product};

/// What is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LimitKind {
    /// Peak absolute acceleration of the part.
    Acceleration,
    /// Peak displacement relative to the bar.
    RattleSpace,
    /// Largest single velocity shock at the part; of contacts that overlap, the largest change of velocity within one contact
    /// time.
    VelocityChange,
    /// Largest single change of angular velocity, likewise.
    AngularVelocityChange,
    /// Critical velocity change and acceleration: a shock does damage beyond both, and whichever leaves more room counts.
    DamageBoundary,
}

/// SI unit of a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Unit {
    /// m/s²
    #[serde(rename = "m/s2")]
    MeterPerSecondSquared,
    /// m
    #[serde(rename = "m")]
    Meter,
    /// m/s
    #[serde(rename = "m/s")]
    MeterPerSecond,
    /// rad/s
    #[serde(rename = "rad/s")]
    RadianPerSecond,
}

impl LimitKind {
    /// `acceleration`, `rattle-space`, …
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Acceleration => "acceleration",
            Self::RattleSpace => "rattle-space",
            Self::VelocityChange => "velocity-change",
            Self::AngularVelocityChange => "angular-velocity-change",
            Self::DamageBoundary => "damage-boundary",
        }
    }
    /// Whether the worst place of an extended part may lie between its ends.
    pub(crate) fn is_largest_between(self) -> bool {
        match self {
            Self::VelocityChange | Self::DamageBoundary => true,
            Self::Acceleration | Self::RattleSpace | Self::AngularVelocityChange => false,
        }
    }
    /// The unit of the limit; of a damage boundary that of its velocity change.
    #[must_use]
    pub fn unit(self) -> Unit {
        match self {
            Self::Acceleration => Unit::MeterPerSecondSquared,
            Self::RattleSpace => Unit::Meter,
            Self::VelocityChange | Self::DamageBoundary => Unit::MeterPerSecond,
            Self::AngularVelocityChange => Unit::RadianPerSecond,
        }
    }
}

impl Unit {
    /// `m/s2`, `m`, …
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::MeterPerSecondSquared => "m/s2",
            Self::Meter => "m",
            Self::MeterPerSecond => "m/s",
            Self::RadianPerSecond => "rad/s",
        }
    }
}

/// One limit of a component, as numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// What is limited.
    pub kind: LimitKind,
    /// What is allowed; of a damage boundary the critical velocity change.
    pub allowed: f64,
    /// Of a damage boundary, the critical acceleration.
    pub critical_acceleration_m_s2: f64,
}

impl Limit {
    /// A limit of one number.
    #[must_use]
    pub fn new(kind: LimitKind, allowed: f64) -> Self {
        Self { kind, allowed, critical_acceleration_m_s2: f64::INFINITY }
    }
    /// The limits of a component at their least values, in a fixed order.
    #[must_use]
    pub fn of(component: &Component) -> Vec<Self> {
        Self::at(component, crate::Spread::lo)
    }
    /// The same at other values of their ranges.
    pub(crate) fn at(component: &Component, mut value: impl FnMut(&crate::Spread) -> f64) -> Vec<Self> {
        let limits = &component.limits;
        let mut list = Vec::new();
        let mut add = |kind, spread: &Option<crate::Spread>| {
            list.extend(spread.as_ref().map(|spread| Self::new(kind, value(spread))));
        };
        add(LimitKind::Acceleration, &limits.acceleration_m_s2);
        add(LimitKind::RattleSpace, &limits.rattle_space_m);
        add(LimitKind::VelocityChange, &limits.velocity_change_m_s);
        add(LimitKind::AngularVelocityChange, &limits.angular_velocity_change_rad_s);
        list.extend(limits.damage_boundary.as_ref().map(|boundary| Self {
            kind: LimitKind::DamageBoundary,
            allowed: value(&boundary.velocity_change_m_s),
            critical_acceleration_m_s2: value(&boundary.acceleration_m_s2),
        }));
        list
    }
    /// Checks that what is allowed is positive; infinity is no limit.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let all = [("what a limit allows", self.allowed), ("critical acceleration", self.critical_acceleration_m_s2)];
        let wrong = all.into_iter().find(|(_, value)| value.is_nan() || *value <= 0.0);
        wrong.map_or(Ok(()), |(name, value)| Err(Error::Setting { name, value, allowed: "positive" }))
    }
    /// Whether it is on the response of a suspended part.
    #[must_use]
    pub fn is_response(&self) -> bool {
        matches!(self.kind, LimitKind::Acceleration | LimitKind::RattleSpace)
    }
    /// What one impact without clatter, (1 + e) v0 at every place at once, would ask, and of what is allowed; with a contact time
    /// as a half-sine of that length.
    ///
    /// # Errors
    /// [`Error::Shock`] for a suspension out of range.
    pub(crate) fn clatter_free(
        &self,
        delta_v_m_s: f64,
        contact_time_s: Option<f64>,
        suspension: Option<&Suspension>,
    ) -> Result<f64, Error> {
        let amplitude = |duration: f64| delta_v_m_s / (Shape::HalfSine.area() * duration);
        let acceleration = self.kind == LimitKind::Acceleration;
        Ok(match (self.kind, suspension, contact_time_s) {
            (LimitKind::AngularVelocityChange, ..) => 0.0,
            (LimitKind::VelocityChange | LimitKind::DamageBoundary, ..) => delta_v_m_s,
            (_, None, time) => time.map_or(f64::INFINITY, amplitude),
            (_, Some(part), None) => {
                let factors = part.damping().impulse_factors();
                if acceleration {
                    delta_v_m_s * part.omega() * factors.acceleration
                } else {
                    delta_v_m_s / part.omega() * factors.displacement
                }
            }
            (_, Some(part), Some(duration)) => {
                let pulse = Pulse { shape: Shape::HalfSine, amplitude: amplitude(duration), duration, start: 0.0 };
                let response = Pulses::new(&[pulse])?.respond(part);
                let peak = if acceleration { response.absolute_acceleration } else { response.relative_displacement };
                peak.magnitude()
            }
        })
    }
}

/// The longest contact that is supposed where the file gives none: hard cases strike for 0.3 to 0.5 ms.
const SUPPOSED_CONTACT_S: f64 = 0.5e-3;
/// Up to this phase ωτ a part may be assessed without knowing the contact: a half-sine of ωτ = 1 does 2.3 % less to an
/// undamped part than an impulse of the same area, 1 − cos(ωτ/2)/(1 − (ωτ/π)²).
const SHORT_PULSE: f64 = 1.0;

/// Why a component cannot be assessed without the product's contact time; `None` where it can.
pub(crate) fn lacks_contact_time(product: &Product, component: &Component) -> Option<String> {
    let limits = &component.limits;
    if product.contact_time_s.is_some() || (limits.acceleration_m_s2.is_none() && limits.rattle_space_m.is_none()) {
        return None;
    }
    match component.mount {
        Mount::Hard => Some("the acceleration of a hard-mounted part is that of the impact itself".to_owned()),
        Mount::Suspended { frequency_hz, .. } => {
            let phase = TAU * frequency_hz.hi() * SUPPOSED_CONTACT_S;
            (phase > SHORT_PULSE).then(|| {
                let highest = SHORT_PULSE / (TAU * SUPPOSED_CONTACT_S);
                format!("above {highest:.0} Hz an impact may not be short beside the period")
            })
        }
    }
}
