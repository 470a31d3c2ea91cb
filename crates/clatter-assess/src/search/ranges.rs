//! The ranges of a product's drops, and where in them a drop is.

use std::f64::consts::TAU;

use clatter::End;

use crate::drop::{Model, SingleDrop};
use crate::search::{Candidate, Task};
use crate::{Component, ContactLaw, Drop, Mount, Product, Spread, WorstCase};

/// Where in the ranges a drop and a part are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    pub(crate) first: End,
    /// Whether both ends land as one.
    pub(crate) flat: bool,
    pub(crate) position_m: f64,
    /// From 0 to 1 along each range: of the [axes](AXES).
    pub(crate) shares: [f64; AXES],
}

/// Square root of the tilt, speed, restitution, contact time, natural frequency, damping ratio, radius of gyration.
pub(super) const AXES: usize = 7;
pub(super) const TILT: usize = 0;
pub(super) const RESTITUTION: usize = 2;
/// Those of the part.
pub(super) const FREQUENCY: usize = 4;
pub(super) const DAMPING: usize = 5;
pub(super) const GYRATION: usize = 6;

/// The ranges of a product's drops, and how they are followed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ranges<'a> {
    pub(crate) product: &'a Product,
    pub(crate) drop: &'a Drop,
    pub(crate) model: Model,
    pub(crate) law: ContactLaw,
    pub(crate) tolerance: f64,
    /// Instant impacts closer than this are one.
    pub(crate) merge_s: f64,
}

impl Ranges<'_> {
    /// The drop at a place.
    pub(crate) fn single(&self, place: &Place) -> SingleDrop {
        let [slow, fast] = self.drop.speeds_m_s();
        let tilt = &self.drop.tilt_rad;
        let [lo, hi] = [tilt.lo().sqrt(), tilt.hi().sqrt()];
        let [share, speed, restitution, contact, ..] = place.shares;
        let root = lo + share * (hi - lo);
        SingleDrop {
            body: self.product.body_at(place.shares[GYRATION]),
            first: place.first,
            tilt_rad: if place.flat { 0.0 } else { (root * root).clamp(tilt.lo(), tilt.hi()) },
            flat: place.flat,
            speed_m_s: (slow + speed * (fast - slow)).clamp(slow, fast),
            restitution: self.product.restitution.at(restitution),
            gravity_m_s2: self.drop.gravity_m_s2,
            contact_time_s: self.product.contact_time_s.map(|time| time.at(contact)),
            contact_law: self.law,
        }
    }

    /// Where in the ranges a worst case is.
    pub(crate) fn place_of(&self, component: &Component, worst: &WorstCase) -> Place {
        let share = |[lo, hi]: [f64; 2], x: f64| if hi > lo { ((x - lo) / (hi - lo)).clamp(0.0, 1.0) } else { 0.0 };
        let of = |spread: &Spread, x: f64| share([spread.lo(), spread.hi()], x);
        let drop = &worst.drop;
        let contact = self.product.contact_time_s.zip(drop.contact_time_s).map_or(0.0, |(time, t)| of(&time, t));
        let tilt = [self.drop.tilt_rad.lo(), self.drop.tilt_rad.hi()].map(f64::sqrt);
        let part = match (component.mount, worst.part.suspension) {
            (Mount::Suspended { frequency_hz, damping }, Some(part)) => {
                [of(&frequency_hz, part.omega() / TAU), share(damping.ratios(), part.damping().get())]
            }
            _ => [0.0; 2],
        };
        let shares = [
            share(tilt, drop.tilt_rad.sqrt()),
            share(self.drop.speeds_m_s(), drop.speed_m_s),
            of(&self.product.restitution, drop.restitution),
            contact,
            part[0],
            part[1],
            worst.gyration_m().map_or(0.0, |rho| of(&self.product.gyration_m, rho)),
        ];
        Place { first: drop.first, flat: drop.flat, position_m: worst.part.position_m, shares }
    }

    /// The middle of all ranges.
    pub(crate) fn middle(&self, component: &Component) -> Place {
        let position_m = 0.5 * (component.position_m.lo() + component.position_m.hi());
        Place { first: self.drop.first_ends()[0], flat: false, position_m, shares: [0.5; AXES] }
    }

    /// Whether the drops with the least tilt land as one: without a contact time, strikes closer than any contact lasts are not
    /// apart.
    pub(crate) fn hold_flat(&self) -> bool {
        let [_, fast] = self.drop.speeds_m_s();
        let gap_m = self.product.body.length_m() * libm::sin(self.drop.tilt_rad.lo());
        self.product.contact_time_s.is_none() && gap_m < self.merge_s * fast
    }

    /// Whether a flat drop is one of the ranges.
    pub(crate) fn hold(&self, flat: &Candidate) -> bool {
        if flat.place.flat { self.hold_flat() } else { self.drop.tilt_rad.lo() == 0.0 }
    }

    /// Which axes have a range at a place: a flat drop has no tilt.
    pub(super) fn free_at(&self, task: &Task<'_>, place: &Place) -> [bool; AXES] {
        let mut free = self.free(task);
        free[TILT] &= !place.flat;
        free
    }

    /// Which axes have a range.
    pub(super) fn free(&self, task: &Task<'_>) -> [bool; AXES] {
        let [slow, fast] = self.drop.speeds_m_s();
        let contact = self.product.contact_time_s.is_some_and(|time| !time.is_value());
        let [frequency, damping] = match task.component.mount {
            Mount::Suspended { frequency_hz, damping } if task.limit.is_response() => {
                let [least, most] = damping.ratios();
                [!frequency_hz.is_value(), least < most]
            }
            _ => [false; 2],
        };
        let varies = |spread: &Spread| !spread.is_value();
        let [tilt, restitution, gyration] =
            [&self.drop.tilt_rad, &self.product.restitution, &self.product.gyration_m].map(varies);
        [tilt, slow < fast, restitution, contact, frequency, damping, gyration]
    }

    /// Of a symmetric product one end first is the other one turned around.
    pub(crate) fn turns(&self) -> bool {
        let [a, b] = self.product.body.arms_m();
        a.to_bits() == b.to_bits() && self.drop.first_ends().len() > 1
    }

    /// The ends that are let touch first.
    pub(crate) fn firsts(&self) -> &'static [End] {
        if self.turns() { &self.drop.first_ends()[..1] } else { self.drop.first_ends() }
    }
}

impl Place {
    /// Landing flat: as one, or with the tilt at the least of its range.
    pub(crate) fn flattened(mut self, as_one: bool) -> Self {
        self.flat = as_one;
        self.shares[TILT] = 0.0;
        self
    }
    pub(super) fn with(mut self, axis: usize, share: f64) -> Self {
        self.shares[axis] = share;
        self
    }
}
