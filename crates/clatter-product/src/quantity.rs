//! This module defines the limited quantities, their units, and the limits of a component as numbers.

use std::f64::consts::{FRAC_PI_2, TAU};

use clatter::Section;
use clatter_shock::{DampingRatio, Moment, Peaked, Pulse, Pulses, Shape, State, Stop, Suspension};
use serde::Serialize;

use crate::{Component, DataFault, Error, Mount, Product, units};

/// The kind of a limit. A new kind stands last: which random numbers are drawn for a limit follows from its place.
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
    /// Largest speed at which the part reaches its stop, relative to the product.
    StopSpeed,
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

impl Unit {
    /// Returns the unit that engineers use for it: gn, mm, m/s and rad/s.
    #[must_use]
    pub fn customary(self) -> &'static units::Unit {
        let (dimension, name) = match self {
            Self::MeterPerSecondSquared => (&units::ACCELERATION, "gn"),
            Self::Meter => (&units::LENGTH, "mm"),
            Self::MeterPerSecond => (&units::SPEED, "m/s"),
            Self::RadianPerSecond => (&units::ANGULAR_VELOCITY, "rad/s"),
        };
        dimension.unit(name).unwrap_or_else(|| unreachable!("{name} is no unit of {}", dimension.name))
    }
}

/// The source from which a limited quantity is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// The response of a suspended part; of one that is mounted rigidly the acceleration of its place.
    Response(ResponsePeak),
    /// Velocity shocks of the place.
    Shock,
    /// Changes of the angular velocity of the product, the same everywhere.
    Turn,
    /// Velocity change and acceleration of a shock, of which the one counts that leaves more room.
    Boundary,
}

/// A peak of the response of a part, times a power of its natural frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResponsePeak {
    /// The peak as a velocity.
    pub peaked: Peaked,
    power: i32,
}

impl ResponsePeak {
    /// Returns the quantity of a peak that is given as a velocity, of a part with this natural frequency.
    #[must_use]
    pub fn of_velocity(self, velocity: f64, omega: f64) -> f64 {
        if self.power < 0 { velocity / omega.powi(-self.power) } else { velocity * omega.powi(self.power) }
    }
    /// Returns the value for a state of the part.
    #[must_use]
    pub fn of_state(self, part: &Suspension, state: State) -> f64 {
        let omega = part.omega();
        let velocity = match self.peaked {
            Peaked::AccelerationOverOmega => part.absolute_acceleration(state) / omega,
            Peaked::PseudoVelocity => omega * state.displacement,
            Peaked::StopSpeed => state.velocity,
        };
        self.of_velocity(velocity, omega)
    }
    /// Returns the value at one moment of a part with stops.
    #[must_use]
    pub fn of_moment(self, part: &Suspension, moment: &Moment) -> f64 {
        match self.peaked {
            Peaked::AccelerationOverOmega => self.of_velocity(moment.acceleration / part.omega(), part.omega()),
            Peaked::PseudoVelocity | Peaked::StopSpeed => self.of_state(part, moment.state),
        }
    }
    /// Returns whether it is the absolute acceleration of the part, which one that is mounted rigidly has too.
    #[must_use]
    pub fn is_acceleration(self) -> bool {
        self.peaked == Peaked::AccelerationOverOmega && self.power == 1
    }
    /// Returns whether stiffer parts have a larger demand as a rule.
    #[must_use]
    pub fn grows_with_frequency(self) -> bool {
        self.power > 0
    }
    /// Returns the most, as a velocity, of a part with stops in a swing whose energy is that of this speed v. Beyond the gap g it is shared
    /// with a stop: ω² (g + d)² + ω₁² d² = v², d the depth.
    fn on_stop(self, part: &Suspension, stop: &Stop, speed: f64) -> f64 {
        let (omega, reach) = (part.omega(), part.omega() * stop.gap());
        let of_damper = 2.0 * part.damping().get() * speed;
        let arrives = if speed > reach { ((speed - reach) * (speed + reach)).sqrt() } else { 0.0 };
        // In units of ω: the stiffness of the stop, and its depth.
        let stiff = FRAC_PI_2 * (1.0 + stop.restitution()) / stop.contact_time() / omega;
        let all = 1.0 + stiff * stiff;
        let depth = arrives * arrives / (reach + (reach * reach + all * arrives * arrives).sqrt());
        let swings = if arrives > 0.0 { reach + depth } else { speed };
        match self.peaked {
            Peaked::AccelerationOverOmega => libm::hypot(swings + stiff * stiff * depth, of_damper),
            Peaked::PseudoVelocity => swings,
            Peaked::StopSpeed => arrives,
        }
    }
    /// Returns the largest peak after a velocity shock, as a velocity, from rest; of a part with stops at most.
    #[must_use]
    pub fn after_shock(self, part: &Suspension, shock: f64) -> f64 {
        part.stop().map_or_else(|| self.after_impulse(part.damping()) * shock, |stop| self.on_stop(part, &stop, shock))
    }
    /// Returns the peak after a velocity shock of 1, from rest, of a part without stops.
    #[must_use]
    pub fn after_impulse(self, damping: DampingRatio) -> f64 {
        let factors = damping.impulse_factors();
        match self.peaked {
            Peaked::AccelerationOverOmega => factors.acceleration,
            Peaked::PseudoVelocity => factors.displacement,
            // Without stops it reaches none.
            Peaked::StopSpeed => 0.0,
        }
    }
    /// Returns the most of the quantity, as a velocity, in a swing of this amplitude: of an acceleration with the forces of damper and stop.
    #[must_use]
    pub fn in_swing(self, part: &Suspension, amplitude: f64) -> f64 {
        match (part.stop(), self.peaked) {
            (Some(stop), _) => self.on_stop(part, &stop, amplitude),
            (None, Peaked::AccelerationOverOmega) => amplitude * libm::hypot(2.0 * part.damping().get(), 1.0),
            (None, Peaked::PseudoVelocity | Peaked::StopSpeed) => amplitude,
        }
    }
}

/// A kind of limit: everything that differs from kind to kind.
#[derive(Debug)]
struct Row {
    kind: LimitKind,
    name: &'static str,
    /// Its key in product files.
    key: &'static str,
    /// Its name among what can be changed.
    lever: &'static str,
    words: &'static str,
    /// The name of the quantity that is measured against it.
    measured: &'static str,
    /// The name of the allowed value.
    allowed: &'static str,
    unit: Unit,
    source: Source,
}

const ROWS: [Row; 6] = [
    Row {
        kind: LimitKind::Acceleration,
        name: "acceleration",
        key: "acceleration_limit",
        lever: "acceleration-limit",
        words: "acceleration",
        measured: "acceleration",
        allowed: "acceleration limit",
        unit: Unit::MeterPerSecondSquared,
        source: Source::Response(ResponsePeak { peaked: Peaked::AccelerationOverOmega, power: 1 }),
    },
    Row {
        kind: LimitKind::RattleSpace,
        name: "rattle-space",
        key: "rattle_space",
        lever: "rattle-space",
        words: "rattle space",
        measured: "displacement",
        allowed: "rattle space",
        unit: Unit::Meter,
        source: Source::Response(ResponsePeak { peaked: Peaked::PseudoVelocity, power: -1 }),
    },
    Row {
        kind: LimitKind::VelocityChange,
        name: "velocity-change",
        key: "velocity_change_limit",
        lever: "velocity-change-limit",
        words: "velocity change",
        measured: "velocity change",
        allowed: "velocity change limit",
        unit: Unit::MeterPerSecond,
        source: Source::Shock,
    },
    Row {
        kind: LimitKind::AngularVelocityChange,
        name: "angular-velocity-change",
        key: "angular_velocity_change_limit",
        lever: "angular-velocity-change-limit",
        words: "angular velocity change",
        measured: "angular velocity change",
        allowed: "angular velocity change limit",
        unit: Unit::RadianPerSecond,
        source: Source::Turn,
    },
    Row {
        kind: LimitKind::DamageBoundary,
        name: "damage-boundary",
        key: "damage_boundary",
        lever: "damage-boundary",
        words: "damage boundary",
        measured: "velocity change",
        allowed: "critical velocity change",
        unit: Unit::MeterPerSecond,
        source: Source::Boundary,
    },
    Row {
        kind: LimitKind::StopSpeed,
        name: "stop-speed",
        key: "stop_speed_limit",
        lever: "stop-speed-limit",
        words: "stop speed",
        measured: "speed at the stop",
        allowed: "stop speed limit",
        unit: Unit::MeterPerSecond,
        source: Source::Response(ResponsePeak { peaked: Peaked::StopSpeed, power: 0 }),
    },
];

impl LimitKind {
    /// Every kind, in the order in which limits of a part are reported.
    pub const ALL: [Self; ROWS.len()] = {
        let mut all = [Self::Acceleration; ROWS.len()];
        let mut k = 0;
        while k < ROWS.len() {
            assert!(ROWS[k].kind as usize == k, "a row stands where its kind does");
            all[k] = ROWS[k].kind;
            k += 1;
        }
        all
    };
    fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }
    /// Returns the name: `acceleration`, `rattle-space`, …
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().name
    }
    /// Its key in product files: `acceleration_limit`, `rattle_space`, …
    #[must_use]
    pub fn key(self) -> &'static str {
        self.row().key
    }
    /// Returns what a design changes to raise it, in words.
    #[must_use]
    pub fn lever(self) -> &'static str {
        self.row().lever
    }
    /// Returns the name in running text: `acceleration`, `rattle space`, …
    #[must_use]
    pub fn words(self) -> &'static str {
        self.row().words
    }
    /// Returns the name of the quantity measured against it, in running text: `acceleration`, `displacement`, …; of a damage boundary by
    /// the unit.
    #[must_use]
    pub fn measured(self, unit: Unit) -> &'static str {
        if unit == self.unit() { self.row().measured } else { LimitKind::Acceleration.row().measured }
    }
    /// Returns the name of the allowed value, in running text: `acceleration limit`, `rattle space`, …; of a damage boundary its critical
    /// velocity change.
    #[must_use]
    pub fn allowed(self) -> &'static str {
        self.row().allowed
    }
    /// Returns the unit of the limit; of a damage boundary that of its velocity change.
    #[must_use]
    pub fn unit(self) -> Unit {
        self.row().unit
    }
    /// Returns what the limited quantity is worked out from.
    #[must_use]
    pub fn source(self) -> Source {
        self.row().source
    }
    /// Returns whether a part that is mounted rigidly has no such limit: it does not move by itself.
    #[must_use]
    pub fn needs_suspension(self) -> bool {
        matches!(self.source(), Source::Response(peak) if !peak.is_acceleration())
    }
    /// Returns whether it is on the response of a suspended part.
    #[must_use]
    pub fn is_response(self) -> bool {
        matches!(self.source(), Source::Response(_))
    }
    /// Returns whether the limit changes where the part hits a stop at the end of its rattle space.
    #[must_use]
    pub fn is_changed_by_stop(self) -> bool {
        self.is_response() && self != Self::RattleSpace
    }
    /// Returns whether the worst place of an extended part may lie between its ends.
    #[must_use]
    pub fn is_largest_between(self) -> bool {
        matches!(self.source(), Source::Shock | Source::Boundary)
    }
}

impl Unit {
    /// Returns the name: `m/s2`, `m`, …
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
    /// The limited quantity.
    pub kind: LimitKind,
    /// The allowed value; of a damage boundary the critical velocity change.
    pub allowed: f64,
    /// The critical acceleration of a damage boundary.
    pub critical_acceleration_m_s2: f64,
}

impl Limit {
    /// Returns a limit of one number; a damage boundary needs its critical acceleration too.
    #[must_use]
    pub fn new(kind: LimitKind, allowed: f64) -> Self {
        Self { kind, allowed, critical_acceleration_m_s2: f64::INFINITY }
    }
    /// Returns the limits of a component at their least values, in a fixed order.
    #[must_use]
    pub fn of(component: &Component) -> Vec<Self> {
        Self::at(component, crate::Spread::lo)
    }
    /// Returns the same at other values of their ranges.
    pub(crate) fn at(component: &Component, mut value: impl FnMut(&crate::Spread) -> f64) -> Vec<Self> {
        let mut of = |kind| {
            let allowed = value(component.limits.get(kind)?);
            let critical = component.limits.critical_acceleration_m_s2().filter(|_| kind == LimitKind::DamageBoundary);
            Some(Self { kind, allowed, critical_acceleration_m_s2: critical.map_or(f64::INFINITY, &mut value) })
        };
        LimitKind::ALL.into_iter().filter_map(&mut of).collect()
    }
    /// Checks that what is allowed is positive, infinity being no limit; and that a damage boundary has both of its numbers, as one alone
    /// would never be exceeded.
    ///
    /// # Errors
    /// [`Error::Setting`], [`DataFault::NoAcceleration`].
    pub fn check(&self) -> Result<(), Error> {
        let all = [("what a limit allows", self.allowed), ("critical acceleration", self.critical_acceleration_m_s2)];
        if let Some((name, value)) = all.into_iter().find(|(_, value)| value.is_nan() || *value <= 0.0) {
            return Err(Error::Setting { name, value, allowed: "positive" });
        }
        if self.kind.source() == Source::Boundary && self.critical_acceleration_m_s2 == f64::INFINITY {
            return Err(DataFault::NoAcceleration.into());
        }
        Ok(())
    }
    /// Returns whether it is on the response of a suspended part.
    #[must_use]
    pub fn is_response(&self) -> bool {
        self.kind.is_response()
    }
    /// Returns the demand of one impact without clatter, (1 + e) v0 at every place at once, in the quantity that the limit allows; with a
    /// contact time as a half-sine of that length.
    ///
    /// # Errors
    /// [`Error::Shock`] for a suspension out of range.
    pub fn clatter_free(
        &self,
        delta_v_m_s: f64,
        contact_time_s: Option<f64>,
        suspension: Option<&Suspension>,
    ) -> Result<f64, Error> {
        let amplitude = |duration: f64| delta_v_m_s / (Shape::HalfSine.area() * duration);
        Ok(match (self.kind.source(), suspension, contact_time_s) {
            (Source::Turn, ..) => 0.0,
            (Source::Shock | Source::Boundary, ..) => delta_v_m_s,
            (Source::Response(_), None, time) => time.map_or(f64::INFINITY, amplitude),
            (Source::Response(peak), Some(part), None) if part.stop().is_none() => {
                peak.of_velocity(delta_v_m_s, part.omega()) * peak.after_impulse(part.damping())
            }
            (Source::Response(peak), Some(part), time) => {
                let half_sine =
                    |duration| Pulse { shape: Shape::HalfSine, amplitude: amplitude(duration), duration, start: 0.0 };
                let pulses = match time {
                    Some(duration) => Pulses::new(&[half_sine(duration)])?,
                    None => Pulses::of_sections([Section::shock(0.0, 0.0, delta_v_m_s)])?,
                };
                let most = pulses.peak_above(part, peak.peaked, 0.0).map_or(0.0, |most| most.value.abs());
                peak.of_velocity(most, part.omega())
            }
        })
    }
}

/// The longest contact that is supposed where the file gives none: hard cases strike for 0.3 to 0.5 ms.
const SUPPOSED_CONTACT_S: f64 = 0.5e-3;
/// Up to this phase ωτ a part may be assessed without knowing the contact: a half-sine of ωτ = 1 does 2.3 % less to an
/// undamped part than an impulse of the same area, 1 − cos(ωτ/2)/(1 − (ωτ/π)²).
const SHORT_PULSE: f64 = 1.0;

/// Returns why a component cannot be assessed without the product's contact time; `None` where it can.
pub(crate) fn lacks_contact_time(product: &Product, component: &Component) -> Option<String> {
    let responds = component.limits.kinds().into_iter().any(LimitKind::is_response);
    if product.contact_time_s.is_some() || !responds {
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
