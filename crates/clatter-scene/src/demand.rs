//! What one limit of one component asks of a drop.

use clatter::End;
use clatter_shock::{DampingRatio, Peaked, Response, Shape, Suspension};

use crate::base::Base;
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
    /// The limits of a component, in a fixed order.
    pub(crate) fn of(component: &Component) -> Vec<Self> {
        let suspended = match component.mount {
            Mount::Hard => None,
            Mount::Suspended { frequency_hz, damping } => Some((frequency_hz, damping)),
        };
        let limits = &component.limits;
        let demand = |kind, allowed, suspended| Self { kind, allowed, acceleration: None, suspended };
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
    /// What one drop does to it, at the worse end of the component.
    pub(crate) fn reached(
        &self,
        base: &Base,
        component: &Component,
        frequency_hz: f64,
        heard: &mut Heard,
    ) -> Result<Reached, Error> {
        let mut worst: Option<Reached> = None;
        for position_m in component.ends_m() {
            let mut respond = |suspension: &Suspension| heard.response(base, position_m, suspension);
            let reached = self.reached_at(base, position_m, frequency_hz, &mut respond)?;
            if worst.is_none_or(|worst| reached.value > worst.value) {
                worst = Some(reached);
            }
        }
        Ok(worst.unwrap_or_else(|| unreachable!("a component has an end")))
    }
    /// What one drop does to it at a place.
    pub(crate) fn reached_at(
        &self,
        base: &Base,
        position_m: f64,
        frequency_hz: f64,
        respond: &mut dyn FnMut(&Suspension) -> Result<Response, Error>,
    ) -> Result<Reached, Error> {
        let (value, strike, time_s) = match (self.kind, self.suspension(frequency_hz)?) {
            (LimitKind::AngularVelocityChange, _) => base.largest_turn(),
            (LimitKind::VelocityChange | LimitKind::DamageBoundary, _) => base.largest_shock(position_m),
            (kind, Some(suspension)) => {
                let response = respond(&suspension)?;
                let peak = match kind {
                    LimitKind::Acceleration => response.absolute_acceleration.peak(),
                    _ => response.relative_displacement.peak(),
                };
                (peak.value.abs(), base.contact_before(peak.time), peak.time)
            }
            (_, None) => base.largest_acceleration(position_m).unwrap_or_default(),
        };
        let frequency_hz = self.suspended.map(|_| frequency_hz);
        Ok(Reached { value, strike, time_s, position_m, frequency_hz })
    }
    /// Allowed and demand for a demand found: of a damage boundary, velocity change or acceleration, whichever leaves more room.
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
    /// What one clatter-free impact, (1 + e) v0 at every place at once, would do.
    pub(crate) fn clatter_free(&self, speed_m_s: f64, restitution: f64, contact_time_s: Option<f64>) -> f64 {
        let delta_v = (1.0 + restitution) * speed_m_s;
        match (self.kind, self.suspended) {
            (LimitKind::AngularVelocityChange, _) => 0.0,
            (LimitKind::VelocityChange | LimitKind::DamageBoundary, _) => delta_v,
            (LimitKind::Acceleration, Some((f, damping))) => {
                delta_v * std::f64::consts::TAU * f.hi() * damping.impulse_factors().acceleration
            }
            (_, Some((f, damping))) => {
                delta_v / (std::f64::consts::TAU * f.lo()) * damping.impulse_factors().displacement
            }
            (_, None) => contact_time_s.map_or(f64::INFINITY, |t| delta_v / (Shape::HalfSine.area() * t)),
        }
    }
}

/// Responses to one drop that were worked out already: the limits of one part ask for the same ones.
#[derive(Debug)]
pub(crate) struct Heard {
    pulses: bool,
    responses: Vec<(f64, Suspension, Response)>,
}

impl Heard {
    pub(crate) fn new(pulses: bool) -> Self {
        Self { pulses, responses: Vec::new() }
    }
    fn response(&mut self, base: &Base, position_m: f64, suspension: &Suspension) -> Result<Response, Error> {
        let same = |(place, other, _): &&(f64, Suspension, Response)| {
            place.to_bits() == position_m.to_bits() && other == suspension
        };
        if let Some((_, _, response)) = self.responses.iter().find(same) {
            return Ok(*response);
        }
        let response = base.respond(position_m, suspension, self.pulses)?;
        self.responses.push((position_m, *suspension, response));
        Ok(response)
    }
}

/// What is compared with what.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Settled {
    pub(crate) allowed: f64,
    /// From the demand's own unit.
    pub(crate) factor: f64,
    pub(crate) unit: crate::Unit,
}
