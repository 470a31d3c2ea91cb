//! What one limit of one component asks of a drop.

use clatter::End;
use clatter_shock::{DampingRatio, ImpulseFactors, Peaked, Pulse, Pulses, Shape, Suspension};

use crate::base::{Base, PeakAsked};
use crate::guaranteed::{Asked, Trains, Variant};
use crate::plan::Quantity;
use crate::{Component, Drop, Error, LimitKind, Mount, Product, Spread};

/// One limit of a component.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Demand {
    pub(crate) kind: LimitKind,
    pub(crate) allowed: f64,
    /// Critical acceleration of a damage boundary.
    acceleration: Option<f64>,
    /// The suspension, where the limit is on its response.
    suspended: Option<(Spread, DampingRatio)>,
    /// Its impulse factor.
    factor: f64,
}

/// What a single drop does to a limit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reached {
    pub(crate) value: f64,
    /// From 0.
    pub(crate) strike: usize,
    pub(crate) time_s: f64,
    pub(crate) position_m: f64,
    pub(crate) frequency_hz: Option<f64>,
}

impl Demand {
    /// What every drop passes.
    pub(crate) const ANY: f64 = -1.0;
    /// The limits of a component, in a fixed order.
    pub(crate) fn of(component: &Component) -> Vec<Self> {
        let suspended = match component.mount {
            Mount::Hard => None,
            Mount::Suspended { frequency_hz, damping } => Some((frequency_hz, damping)),
        };
        let limits = &component.limits;
        let factors = suspended.map(|(_, damping)| damping.impulse_factors());
        let demand = |kind, allowed, suspended| {
            let factor =
                |of: ImpulseFactors| if kind == LimitKind::Acceleration { of.acceleration } else { of.displacement };
            Self { kind, allowed, acceleration: None, suspended, factor: factors.map_or(0.0, factor) }
        };
        let mut demands = Vec::new();
        demands.extend(limits.acceleration_m_s2.map(|a| demand(LimitKind::Acceleration, a, suspended)));
        demands.extend(limits.rattle_space_m.map(|z| demand(LimitKind::RattleSpace, z, suspended)));
        demands.extend(limits.velocity_change_m_s.map(|v| demand(LimitKind::VelocityChange, v, None)));
        demands.extend(limits.angular_velocity_change_rad_s.map(|w| demand(LimitKind::AngularVelocityChange, w, None)));
        demands.extend(limits.damage_boundary.map(|b| Self {
            acceleration: Some(b.acceleration_m_s2),
            ..demand(LimitKind::DamageBoundary, b.velocity_change_m_s, None)
        }));
        demands
    }
    /// Whether it is about the response of a suspended part.
    pub(crate) fn frequencies(&self) -> Option<Spread> {
        self.suspended.map(|(frequency, _)| frequency)
    }
    /// What the gravity-free search is asked; `None` where it says nothing of it.
    pub(crate) fn asked(&self) -> Option<Asked> {
        match (self.kind, self.suspended) {
            (LimitKind::Acceleration, Some((_, damping))) => {
                Some(Asked::Response(damping, Peaked::AccelerationOverOmega))
            }
            (LimitKind::RattleSpace, Some((_, damping))) => Some(Asked::Response(damping, Peaked::PseudoVelocity)),
            (LimitKind::Acceleration | LimitKind::RattleSpace, None) => None,
            _ => Some(Asked::Shock),
        }
    }
    /// Places and first ends to look at.
    pub(crate) fn variants(
        &self,
        trains: &Trains,
        product: &Product,
        drop: &Drop,
        component: &Component,
    ) -> Vec<Variant> {
        let mut variants = Vec::new();
        for &first in drop.first_ends() {
            let clattering = trains.clattering(first);
            if self.kind == LimitKind::AngularVelocityChange {
                variants.push(Variant { first, position_m: component.position_m, shares: clattering.turns() });
                continue;
            }
            for position_m in component.ends_m() {
                let s = product.relative(position_m);
                let s = if first == End::A { s } else { -s };
                variants.push(Variant { first, position_m, shares: clattering.shares(s) });
            }
        }
        variants
    }
    /// What is asked of a plan; `None` for a turn of the bar and for the pulses of a hard-mounted part.
    pub(crate) fn quantity(&self) -> Option<Quantity> {
        match (self.kind, self.suspended) {
            (LimitKind::Acceleration, Some(_)) => Some(Quantity::PeakAcceleration),
            (LimitKind::RattleSpace, Some(_)) => Some(Quantity::RattleSpace),
            (LimitKind::VelocityChange | LimitKind::DamageBoundary, _) => Some(Quantity::VelocityShock),
            _ => None,
        }
    }
    /// The suspension at a frequency, where the limit is on its response.
    pub(crate) fn suspension(&self, frequency_hz: f64) -> Result<Option<Suspension>, Error> {
        let suspension = self.suspended.map(|(_, damping)| Suspension::from_hz(frequency_hz, damping));
        Ok(suspension.transpose()?)
    }
    /// The peak that it is about, where it is on the response of a suspended part, to be found if it passes `above`.
    pub(crate) fn asked_of(&self, position_m: f64, frequency_hz: f64, above: f64) -> Result<Option<PeakAsked>, Error> {
        let acceleration = self.kind == LimitKind::Acceleration;
        let peaked = if acceleration { Peaked::AccelerationOverOmega } else { Peaked::PseudoVelocity };
        let asked = |suspension| PeakAsked { position_m, suspension, peaked, above };
        Ok(self.suspension(frequency_hz)?.map(asked))
    }
    /// What a velocity shock of 1 m/s does to the part, where the limit is on its response.
    pub(crate) fn of_unit_shock(&self, frequency_hz: f64) -> f64 {
        let omega = std::f64::consts::TAU * frequency_hz;
        if self.kind == LimitKind::Acceleration { omega * self.factor } else { self.factor / omega }
    }
    /// What one drop does to it by velocity shocks, at the worse end of the component.
    pub(crate) fn reached(&self, base: &Base, component: &Component, frequency_hz: f64) -> Result<Reached, Error> {
        let mut worst: Option<Reached> = None;
        for position_m in component.ends_m() {
            let above = worst.map_or(Self::ANY, |worst| worst.value);
            worst = self.reached_at(base, position_m, frequency_hz, false, f64::INFINITY, above)?.or(worst);
        }
        Ok(worst.unwrap_or_else(|| unreachable!("a component has an end")))
    }
    /// What one drop does to it at a place until a time, if that passes `above`.
    pub(crate) fn reached_at(
        &self,
        base: &Base,
        position_m: f64,
        frequency_hz: f64,
        pulses: bool,
        until_s: f64,
        above: f64,
    ) -> Result<Option<Reached>, Error> {
        let (value, strike, time_s) = match (self.kind, self.asked_of(position_m, frequency_hz, above)?) {
            (LimitKind::AngularVelocityChange, _) => base.largest_turn(),
            (LimitKind::VelocityChange | LimitKind::DamageBoundary, _) => base.largest_shock(position_m),
            (_, Some(asked)) => base
                .peak_until(until_s, &asked, pulses)?
                .map_or((0.0, 0, 0.0), |peak| (peak.value, base.contact_before(peak.time), peak.time)),
            (_, None) => base.largest_acceleration(position_m).unwrap_or_default(),
        };
        let frequency_hz = self.suspended.map(|_| frequency_hz);
        Ok(Some(Reached { value, strike, time_s, position_m, frequency_hz }).filter(|reached| reached.value > above))
    }
    /// Allowed and demand for a demand found: of a damage boundary, velocity change or acceleration, whichever leaves
    /// more room.
    pub(crate) fn settle(&self, demand: f64, contact_time_s: Option<f64>) -> Settled {
        let by_velocity = Settled { allowed: self.allowed, factor: 1.0, unit: self.kind.unit() };
        let Some((critical, time)) = self.acceleration.zip(contact_time_s) else { return by_velocity };
        // A half-sine of this velocity change.
        let factor = 1.0 / (Shape::HalfSine.area() * time);
        if critical / (factor * demand) > self.allowed / demand {
            Settled { allowed: critical, factor, unit: crate::Unit::MeterPerSecondSquared }
        } else {
            by_velocity
        }
    }
    /// What one clatter-free impact, (1 + e) v0 at every place at once, would do; where the contact time is known as a
    /// half-sine of that length, else at once.
    pub(crate) fn clatter_free(
        &self,
        speed_m_s: f64,
        restitution: f64,
        contact_time_s: Option<f64>,
    ) -> Result<f64, Error> {
        let delta_v = (1.0 + restitution) * speed_m_s;
        let amplitude = |duration: f64| delta_v / (Shape::HalfSine.area() * duration);
        let (acceleration, Some((f, damping))) = (self.kind == LimitKind::Acceleration, self.suspended) else {
            return Ok(match self.kind {
                LimitKind::AngularVelocityChange => 0.0,
                LimitKind::VelocityChange | LimitKind::DamageBoundary => delta_v,
                LimitKind::Acceleration | LimitKind::RattleSpace => contact_time_s.map_or(f64::INFINITY, amplitude),
            });
        };
        let Some(duration) = contact_time_s else {
            return Ok(delta_v * self.of_unit_shock(if acceleration { f.hi() } else { f.lo() }));
        };
        let pulses =
            Pulses::new(&[Pulse { shape: Shape::HalfSine, amplitude: amplitude(duration), duration, start: 0.0 }])?;
        let crest = (CREST / duration).clamp(f.lo(), f.hi());
        [f.lo(), crest, f.hi()].into_iter().try_fold(0.0, |most, f| {
            let response = pulses.respond(&Suspension::from_hz(f, damping)?);
            let peak = if acceleration { response.absolute_acceleration } else { response.relative_displacement };
            Ok(peak.magnitude().max(most))
        })
    }
}

/// Where the shock spectrum of a half-sine is highest, about: natural frequency times duration, without damping.
const CREST: f64 = 0.8;

/// What is compared with what.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Settled {
    pub(crate) allowed: f64,
    /// From the demand's own unit.
    pub(crate) factor: f64,
    pub(crate) unit: crate::Unit,
}
