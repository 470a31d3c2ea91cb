//! The ranges of a product's drops, and where in them a drop is.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use clatter::End;

use crate::WorstCase;
use crate::search::{Candidate, Task};
use clatter_flight::Drop;
pub(crate) use clatter_product::AXES;
use clatter_product::{Base, Component, ContactLaw, DropRanges, Model, Mount, Product, Spread, Stops, searched};

/// The place of a drop and a part in the ranges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Coordinates {
    pub(crate) first: End,
    /// True where both ends land as one.
    pub(crate) flat: bool,
    /// Sides that are exchanged, of a plate whose drops stand for those of its mirror images.
    pub(crate) mirrored: [bool; 2],
    pub(crate) at_m: [f64; 2],
    /// The shares from 0 to 1 along each range: of the [axes](AXES).
    pub(crate) shares: [f64; AXES],
}

pub(super) const TILT: usize = 0;
pub(super) const SPEED: usize = 1;
pub(super) const RESTITUTION: usize = 2;
pub(super) const CONTACT: usize = 3;
/// The axes of the part.
pub(crate) const FREQUENCY: usize = 4;
pub(crate) const DAMPING: usize = 5;
pub(crate) const DIRECTION: usize = 7;
/// The gap of the stops of a part, their contact time and their restitution.
pub(crate) const STOPS: [usize; 3] = [10, 11, 12];

/// The ranges of a product's drops, and how they are followed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ranges<'a> {
    pub(crate) product: &'a Product,
    pub(crate) drop: &'a DropRanges,
    pub(crate) model: Model,
    /// The posture of a box as it lands, but for its tolerance.
    pub(crate) base: Option<Base>,
    /// The number of drops that the product goes through.
    pub(crate) listed: usize,
    pub(crate) law: ContactLaw,
    pub(crate) tolerance: f64,
    /// Instant impacts closer than this are one.
    pub(crate) merge_s: f64,
}

impl Ranges<'_> {
    /// Returns the drop at a place.
    pub(crate) fn single(&self, place: &Coordinates) -> Drop {
        let direction_rad = if self.product.body.is_wide() {
            let [from, to] = self.directions();
            image(from + place.shares[DIRECTION] * (to - from), place.mirrored)
        } else {
            Drop::towards(place.first)
        };
        let unset = self.product.unset(self.drop, self.base);
        let mut drop = Drop { direction_rad, is_flat: place.flat, contact_law: self.law, ..unset };
        for (row, search) in searched() {
            if let (Some(range), Some(set)) = (row.input.range(self.product, self.drop), row.set) {
                set(&mut drop, search.at(range, place.shares[search.axis]));
            }
        }
        if place.flat {
            (drop.tilt_rad, drop.spin_rad_s) = (0.0, 0.0);
        }
        drop
    }

    /// Finds where in the ranges a worst case is.
    pub(crate) fn place_of(&self, component: &Component, worst: &WorstCase) -> Coordinates {
        let share = |[lo, hi]: [f64; 2], x: f64| if hi > lo { ((x - lo) / (hi - lo)).clamp(0.0, 1.0) } else { 0.0 };
        let of = |spread: &Spread, x: f64| share([spread.lo(), spread.hi()], x);
        let drop = &worst.drop;
        let part = match (component.mount, worst.part.suspension) {
            (Mount::Suspended { frequency_hz, damping }, Some(part)) => {
                [of(&frequency_hz, part.omega() / TAU), share(damping.ratios(), part.damping().get())]
            }
            _ => [0.0; 2],
        };
        let images = self.mirrors().iter().filter(|_| drop.body.is_wide()).filter_map(|&mirrored| {
            let [lo, hi] = self.directions();
            let direction = image(drop.direction_rad, mirrored);
            // The turn that is in the range, or next to it by roundings.
            let off = |x: f64| (lo - x).max(x - hi).max(0.0);
            let turned = [direction - TAU, direction, direction + TAU];
            turned.into_iter().map(|x| (off(x), share([lo, hi], x), mirrored)).min_by(|a, b| a.0.total_cmp(&b.0))
        });
        let (_, direction, mirrored) = images.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
        let mut shares = [0.0; AXES];
        for (row, search) in searched() {
            if let (Some(range), Some(x)) = (row.input.range(self.product, self.drop), row.input.value(drop)) {
                shares[search.axis] = search.share(range, x);
            }
        }
        [shares[FREQUENCY], shares[DAMPING]] = part;
        if let (Some(stops), Some(stop)) = (&component.stops, worst.part.suspension.and_then(|part| part.stop())) {
            for ((axis, range), x) in STOPS.into_iter().zip(stops.ranges()).zip(Stops::numbers(&stop)) {
                shares[axis] = of(range, x);
            }
        }
        shares[DIRECTION] = direction;
        Coordinates { first: drop.first(), flat: drop.is_flat, mirrored, at_m: worst.part.at_m(), shares }
    }

    /// Returns the middle of all ranges.
    pub(crate) fn middle(&self, component: &Component) -> Coordinates {
        let at_m = [component.position_m, component.across_m].map(|place| 0.5 * (place.lo() + place.hi()));
        let (first, mirrored) = (self.drop.first_ends()[0], [false; 2]);
        Coordinates { first, flat: false, mirrored, at_m, shares: [0.5; AXES] }
    }

    /// Returns whether the drops with the least tilt land as one: without a contact time, strikes closer than any contact lasts are not
    /// apart.
    pub(crate) fn hold_flat(&self) -> bool {
        let [_, fast] = self.drop.speeds_m_s();
        let gap_m = self.reach_m() * libm::sin(self.drop.tilt_rad.lo());
        // With spin they do not; a file in which they may is refused.
        self.product.contact_time_s.is_none() && !self.drop.may_spin() && gap_m < self.merge_s * fast
    }

    /// Returns whether a flat drop is one of the ranges.
    pub(crate) fn hold(&self, flat: &Candidate) -> bool {
        if flat.place.flat { self.hold_flat() } else { self.drop.tilt_rad.lo() == 0.0 && !self.drop.may_spin() }
    }

    /// Returns which axes have a range at a place: a flat drop has no tilt.
    pub(super) fn free_at(&self, task: &Task<'_>, place: &Coordinates) -> [bool; AXES] {
        let mut free = self.free(task);
        free[TILT] &= !place.flat;
        free
    }

    /// Returns which axes of a drop have a range, and those of a part, which any may have.
    pub(super) fn free_in_drops(&self) -> [bool; AXES] {
        let mut free = [false; AXES];
        for (row, search) in searched() {
            free[search.axis] = row.input.range(self.product, self.drop).is_some_and(|[lo, hi]| lo < hi);
        }
        let [from, to] = self.directions();
        (free[FREQUENCY], free[DAMPING], free[DIRECTION]) = (true, true, from < to);
        free
    }

    /// Returns which axes have a range.
    pub(super) fn free(&self, task: &Task<'_>) -> [bool; AXES] {
        let mut free = self.free_in_drops();
        [free[FREQUENCY], free[DAMPING]] = match task.component.mount {
            Mount::Suspended { frequency_hz, damping } if task.limit.is_response() => {
                let [least, most] = damping.ratios();
                [!frequency_hz.is_value(), least < most]
            }
            _ => [false; 2],
        };
        if let Some(stops) = task.component.stops.as_ref().filter(|_| task.limit.is_response()) {
            for (axis, range) in STOPS.into_iter().zip(stops.ranges()) {
                free[axis] = !range.is_value();
            }
        }
        free
    }

    /// Returns the directions that drops are followed in: of a plate that may rise to any, those of which the others are mirror images.
    pub(super) fn directions(&self) -> [f64; 2] {
        match (&self.product.body.width, &self.drop.direction_rad) {
            (None, _) => [0.0; 2],
            (_, Some(given)) => [given.lo(), given.hi()],
            (_, None) if self.base.is_some() => [0.0, TAU],
            (_, None) => match self.symmetries() {
                [true, true] => [0.0, FRAC_PI_2],
                [true, false] => [-FRAC_PI_2, FRAC_PI_2],
                [false, true] => [0.0, PI],
                [false, false] => [0.0, TAU],
            },
        }
    }
    /// Returns whether exchanging its ends, and its long edges, leaves a plate as it is.
    fn symmetries(&self) -> [bool; 2] {
        let Some(width) = &self.product.body.width else { return [false; 2] };
        let even = |[lo, hi]: [f64; 2]| lo.to_bits() == hi.to_bits() && self.product.body.products_m2[0] == 0.0;
        let own = |sides: [bool; 2]| self.product.own_contacts.is_even(sides);
        [even(self.product.body.arms_m()) && own([true, false]), even(width.ends_m) && own([false, true])]
    }
    /// Images of a drop that are drops of the ranges as well, itself first: which sides are exchanged.
    pub(super) fn mirrors(&self) -> &'static [[bool; 2]] {
        if !self.product.body.is_wide() {
            return if self.turns() { &[[false, false], [true, false]] } else { &[[false, false]] };
        }
        match self.symmetries() {
            _ if self.drop.direction_rad.is_some() || self.base.is_some() => &[[false, false]],
            [true, true] => &[[false, false], [true, false], [false, true], [true, true]],
            [true, false] => &[[false, false], [true, false]],
            [false, true] => &[[false, false], [false, true]],
            [false, false] => &[[false, false]],
        }
    }
    /// Returns on how many faces at once a box lands at least, turned off its posture by all of its tolerance: 1 a face, 2 an edge, 3 a
    /// corner; 0 of a bar or a plate.
    pub(super) fn faces(&self) -> usize {
        // The tolerance levels a side by so much.
        let level = libm::sin(self.drop.tilt_rad.hi());
        self.base.map_or(0, |base| base.up.iter().filter(|side| side.abs() > level).count())
    }
    /// Returns the longest way from the lowest point to the highest, along the body.
    pub(super) fn reach_m(&self) -> f64 {
        libm::hypot(self.product.body.length_m(), self.product.body.width_m())
    }
    /// Returns how fast the raised end or corner comes down as the other touches, at most and at least over the spins of the fastest drop,
    /// before that strikes; at least a tenth of the speed, as the strike turns it down.
    pub(super) fn closing_m_s(&self) -> [f64; 2] {
        let ([_, fast], reach_m) = (self.drop.speeds_m_s(), self.reach_m());
        let [closes, opens] =
            [-self.drop.spin_rad_s.lo(), self.drop.spin_rad_s.hi()].map(|spin| reach_m * spin.max(0.0));
        [fast + closes, (fast - opens).max(0.1 * fast)]
    }
    /// Returns whether one end first is the other one turned around, as of a symmetric product.
    pub(crate) fn turns(&self) -> bool {
        let [a, b] = self.product.body.arms_m();
        let is_even = a.to_bits() == b.to_bits() && self.product.own_contacts.is_even([true, false]);
        is_even && self.drop.first_ends().len() > 1 && !self.product.body.is_wide()
    }

    /// Returns the ends that are let touch first.
    pub(crate) fn firsts(&self) -> &'static [End] {
        if self.turns() || self.product.body.is_wide() { &self.drop.first_ends()[..1] } else { self.drop.first_ends() }
    }
}

impl Coordinates {
    /// Returns the drop landing flat: as one, or with the tilt at the least of its range.
    pub(crate) fn flattened(mut self, as_one: bool) -> Self {
        self.flat = as_one;
        self.shares[TILT] = 0.0;
        self
    }
    /// Returns the same with the nearest stops that press shortest and throw back most.
    pub(super) fn at_hardest_stops(mut self) -> Self {
        for (axis, share) in STOPS.into_iter().zip(Stops::HARDEST) {
            self.shares[axis] = share;
        }
        self
    }
    pub(super) fn with(mut self, axis: usize, share: f64) -> Self {
        self.shares[axis] = share;
        self
    }
}

/// Returns the direction of a mirror image.
fn image(direction_rad: f64, [along, across]: [bool; 2]) -> f64 {
    let turned = if along { PI - direction_rad } else { direction_rad };
    if across { -turned } else { turned }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Accuracy;
    use crate::assess::ranges;
    use crate::engine::Part;
    use clatter_product::{Input, Model, ProductFile};
    use clatter_shock::{DampingRatio, Suspension};

    /// No two inputs, and none of those of a part, are searched along one axis.
    #[test]
    fn every_axis_is_searched_once() {
        let mut axes: Vec<usize> = searched().map(|(_, search)| search.axis).collect();
        axes.extend([FREQUENCY, DAMPING, DIRECTION].into_iter().chain(STOPS));
        axes.sort_unstable();
        assert_eq!(axes, (0..AXES).collect::<Vec<_>>());
    }

    /// A drop of the ranges is found in them where it was taken from, each range from its least to its most.
    #[test]
    fn a_drop_is_where_it_was_taken_from() {
        let text = r#"
product = { name = "bar", length = "150 mm", radius_of_gyration = ["40 mm", "45 mm"], restitution = [0.2, 0.4], contact_time = ["0.3 ms", "0.5 ms"] }
drop = { speed = ["2 m/s", "4 m/s"], tilt = ["1 deg", "9 deg"], spin = ["-2 rad/s", "3 rad/s"] }
component = [{ name = "part", position = "30 mm", natural_frequency = ["80 Hz", "120 Hz"], damping_ratio = [0.02, 0.1], rattle_space = "9 mm" }]
"#;
        let file = ProductFile::read(text, "bar.toml").unwrap_or_else(|faults| panic!("{faults}"));
        let (ranges, component) = (ranges(&file, &Accuracy::default()), &file.components[0]);
        let mut shares = [0.0; AXES];
        let of = |input| searched().find(|(row, _)| row.input == input).unwrap().1.axis;
        let part = [(FREQUENCY, 0.6), (DAMPING, 0.4)];
        let drop = [
            (TILT, 0.3),
            (SPEED, 0.2),
            (RESTITUTION, 0.7),
            (CONTACT, 0.1),
            (of(Input::Gyration), 0.9),
            (of(Input::Spin), 0.8),
        ];
        for (axis, share) in part.into_iter().chain(drop) {
            shares[axis] = share;
        }
        let place = Coordinates { first: End::B, flat: false, mirrored: [false; 2], at_m: [0.03, 0.0], shares };
        let drop = ranges.single(&place);
        let near = |got: f64, want: f64| assert!((got / want - 1.0).abs() < 1e-9, "{got}, not {want}");
        near(drop.tilt_rad.to_degrees(), (1.0 + 0.3 * 2.0_f64).powi(2));
        near(drop.speed_m_s, 2.4);
        near(drop.spin_rad_s, 2.0);
        near(drop.restitution, 0.34);
        near(drop.contact_time_s.unwrap(), 0.32e-3);
        near(drop.body.gyration_m(), 0.0445);
        let part = Suspension::from_hz(104.0, DampingRatio::new(0.052).unwrap()).unwrap();
        let worst = WorstCase {
            drop,
            part: Part::new(0.03, Some(part)),
            drawn: false,
            gyration_varies: true,
            landing: None,
            listed: 0,
            impact: 1,
            time_s: 0.0,
            model: Model::Compliant,
            tolerance: 0.01,
        };
        let found = ranges.place_of(component, &worst);
        let same_place = found.at_m.map(f64::to_bits) == place.at_m.map(f64::to_bits);
        assert!(found.first == End::B && same_place && !found.flat, "{found:?}");
        for (got, want) in found.shares.iter().zip(place.shares) {
            assert!((got - want).abs() < 1e-9, "{found:?}");
        }
    }
}
