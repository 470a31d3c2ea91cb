//! This module bounds the effect of strikes that may come after a motion was left, by the energy that is left.

use std::f64::consts::FRAC_PI_2;

use clatter_flight::{Followed, Stop};
use clatter_shock::{State, Suspension};

use super::{PlaceHistory, kept_arms};
use crate::bound::box_acceleration;
use clatter_product::{Limit, ResponsePeak, Source};

/// The bounds on strikes at a place after a motion was left, by the energy left.
pub(super) struct Later {
    /// The bounds for a motion that was given up, with many strikes to come.
    pub(super) given_up: Option<GivenUp>,
    /// The weight that will act on the place for ever in the end.
    pub(super) weight_m_s2: f64,
    /// The shock of one strike, and of strikes that overlap.
    pub(super) shock_m_s: f64,
    pub(super) turned_m_s: f64,
    pub(super) turn_rad_s: f64,
    /// All energy in the springs of both ends, or in that of one, at any tilt.
    pub(super) acceleration_m_s2: f64,
}

impl Later {
    /// Returns the velocity shock that does as much to a part: on one that is fast next to a contact no more than a pulse twice as high
    /// acts, and a weight that comes on at once moves it by no more than twice its static deflection.
    pub(super) fn shock_of(&self, part: &Suspension) -> f64 {
        let one = self.shock_m_s.min(2.0 * self.acceleration_m_s2 / part.omega());
        let all = self.given_up.as_ref().map_or(0.0, |left| left.shock_of(part, one));
        all.max(CHATTER * one) + 2.0 * self.weight_m_s2 / part.omega()
    }
}

/// The bounds on many strikes that are all in step with a part.
pub(super) struct GivenUp {
    /// Ends that bounce one at a time do e times as much at each strike: so many times the first in all, of both.
    pub(super) in_turn: f64,
    /// The velocity change that an impulse gives to the place over that of the center of mass, at most.
    pub(super) lever: f64,
    /// Change of velocity of the center of mass, at most.
    pub(super) center_m_s: f64,
    pub(super) gravity_m_s2: f64,
}

impl GivenUp {
    /// Returns the bound by momentum: within a time t the ground gives the center of mass no more than what turns it around and g t. A part
    /// forgets at its rate of decay, so that of g t the weight over that rate counts.
    fn shock_of(&self, part: &Suspension, one_m_s: f64) -> f64 {
        let momentum = self.lever * (self.center_m_s + self.gravity_m_s2 / (slowest(part) * part.omega()));
        momentum.min(self.in_turn * one_m_s)
    }
}

/// Returns the amplitude of a part in this state as a velocity, with what its stop holds: at most ½ k₁ d² at a depth d.
pub(super) fn swing(part: &Suspension, state: State) -> f64 {
    let free = libm::hypot(part.omega() * state.displacement, state.velocity);
    let pressed = |stop: clatter_shock::Stop| {
        let rate = FRAC_PI_2 * (1.0 + stop.restitution()) / stop.contact_time();
        rate * (state.displacement.abs() - stop.gap()).max(0.0)
    };
    libm::hypot(free, part.stop().map_or(0.0, pressed))
}

/// Returns the utilization that swings of parts have together: a sum that is one already, or, of parts with stops, of amplitudes.
pub(crate) fn in_swings<'p>(limit: &Limit, parts: impl IntoIterator<Item = &'p Suspension>, sum: f64) -> f64 {
    let Source::Response(peak) = limit.kind.source() else { return sum };
    let of = |part: &Suspension| {
        let at_stop = || peak.of_velocity(peak.in_swing(part, sum), part.omega()) / limit.allowed;
        part.stop().map_or(sum, |_| at_stop())
    };
    parts.into_iter().map(of).reduce(f64::max).unwrap_or(sum)
}

/// Returns the rate at which the free motion of a part decays, over ω.
pub(super) fn slowest(part: &Suspension) -> f64 {
    let zeta = part.damping().get();
    if zeta < 1.0 { zeta } else { 1.0 / (zeta + (zeta * zeta - 1.0).sqrt()) }
}

/// Strikes of both ends in step do this many times what one does that has all the energy, at most: of the drops of random
/// products without damping, one in a thousand exceeds it.
const CHATTER: f64 = 1.5;

impl PlaceHistory<'_> {
    /// Returns the utilization that strikes after the motion was left may reach, by the energy that is left and what a part still rings
    /// with; 0 where that is not above `above`. Of the parts given, or of a limit that is no response.
    pub(crate) fn later_most<'p>(
        &self,
        limit: &Limit,
        parts: impl IntoIterator<Item = &'p Suspension>,
        above: f64,
    ) -> f64 {
        if !self.followed.is_early() {
            return 0.0;
        }
        let later = self.later();
        let most = match limit.kind.source() {
            Source::Response(peak) => {
                let of = |part: &Suspension| self.rings_most(peak, limit.allowed, part, later.shock_of(part), above);
                let most = parts.into_iter().map(of).reduce(f64::max);
                most.unwrap_or(later.acceleration_m_s2 / limit.allowed)
            }
            Source::Turn => later.turn_rad_s / limit.allowed,
            Source::Shock => later.turned_m_s / limit.allowed,
            // A damage boundary takes both: it is used up by the lesser share.
            Source::Boundary => {
                let acceleration = later.acceleration_m_s2 / limit.critical_acceleration_m_s2;
                (later.turned_m_s / limit.allowed).min(acceleration)
            }
        };
        if most > above { most } else { 0.0 }
    }
    /// Returns the utilization to which parts still ring as the motion is left, with the weight that is to come in the end; of parts with stops
    /// the amplitude as a velocity, to be added to [others](in_swings); 0 of a limit that is no response.
    pub(crate) fn rings<'p>(&self, limit: &Limit, parts: impl IntoIterator<Item = &'p Suspension>) -> f64 {
        let Source::Response(peak) = limit.kind.source() else { return 0.0 };
        let of = |part: &Suspension| {
            let (omega, rest) = (part.omega(), self.end_of(part));
            let rings = swing(part, rest) + 2.0 * self.followed.weight_to_come_m_s2() / omega;
            if part.stop().is_some() {
                return rings;
            }
            let per_velocity = peak.of_velocity(peak.after_impulse(part.damping()), omega) / limit.allowed;
            per_velocity * rings
        };
        parts.into_iter().map(of).fold(0.0, f64::max)
    }
    /// Returns the bounds on strikes here after the motion was left.
    pub(super) fn later(&self) -> Later {
        let drop = &self.followed.drop;
        let (points, here) = drop.in_radii(&self.place);
        let dot = |[x, y]: [f64; 2], [x2, y2]: [f64; 2]| x * x2 + y * y2;
        let mass = |p: [f64; 2]| (1.0 + dot(p, p)).sqrt();
        let farthest = points.iter().fold(0.0_f64, |most, &p| most.max(dot(p, p)));
        // All energy in the motion of the center of mass, over all of it in what moves the farthest point fastest.
        let is_box = self.is_box();
        let fastest = if is_box { 1.0 } else { (1.0 + farthest).sqrt() };
        let center = self.followed.later_m_s() / fastest;
        let pressed = points.iter().fold(0.0, |all, &p| libm::hypot(all, (1.0 + dot(here, p)) / mass(p)));
        // A strike gives back the restitution's share of what it takes; several that overlap may turn all of the motion around.
        let [_, most_e] = drop.restitutions();
        let turned = 2.0 / (1.0 + most_e);
        let given_up = self.followed.is_given_up().then(|| GivenUp {
            in_turn: points.iter().map(|_| 1.0).sum::<f64>() / (1.0 - most_e),
            lever: 1.0 + dot(here, here).sqrt() * farthest.sqrt(),
            center_m_s: center * turned,
            gravity_m_s2: drop.gravity_m_s2,
        });
        Later {
            given_up,
            weight_m_s2: self.followed.weight_to_come_m_s2(),
            shock_m_s: center * mass(here),
            turned_m_s: center * mass(here) * turned,
            turn_rad_s: center / drop.least_gyration_m() * turned,
            // Nothing where nothing is left, also where a strike has no largest force.
            acceleration_m_s2: if center > 0.0 {
                if is_box {
                    let longest_s = drop.contact_times_s().map_or(0.0, |[_, longest]| longest);
                    let speed = 0.5 * center * turned;
                    box_acceleration(drop, &self.place, speed, center * self.peak_per_change(), longest_s)
                } else {
                    center * pressed.max(mass(here)) * self.peak_per_change()
                }
            } else {
                0.0
            },
        }
    }
    /// Returns the utilization to which a shock of this size brings a part that still rings as the motion was left; 0 where it was below
    /// `above` as the last contact ended, has decayed since, and stays below.
    fn rings_most(&self, peak: ResponsePeak, allowed: f64, part: &Suspension, shock: f64, above: f64) -> f64 {
        let omega = part.omega();
        if part.stop().is_some() {
            // What reaches a stop is not in proportion.
            let most = peak.after_shock(part, swing(part, self.end_of(part)) + shock);
            return peak.of_velocity(most, omega) / allowed;
        }
        let per_velocity = peak.of_velocity(peak.after_impulse(part.damping()), omega) / allowed;
        if shock * per_velocity <= above * -libm::expm1(-slowest(part) * omega * self.followed.quiet_s()) {
            return 0.0;
        }
        let rest = self.end_of(part);
        per_velocity * (swing(part, rest) + shock)
    }
    /// Returns the error bound of a shock of this size: the share of the largest shock that lever arms get wrong, and the amount by which
    /// later ones could exceed it.
    pub(super) fn off_by(&self, value: f64, of_box: impl Fn(&Later) -> f64) -> f64 {
        let Followed { largest_m_s, .. } = self.followed;
        // No later strike changes the velocity of a point of a bar or of a plate by more, between its ends or corners; of a box, that of
        // its center of mass. A part may be beyond feet, whose instant impacts are those of the feet.
        let later = if self.leaves_later {
            0.0
        } else if self.is_box() || self.followed.drop.body.feet.is_some() {
            of_box(&self.later())
        } else {
            self.followed.later_m_s()
        };
        kept_arms(self.followed) * largest_m_s + (later - value).max(0.0)
    }
    /// Returns what a shock may be off by that lasts until the body is said to lie: it is stopped at once, where it would ring by its weight.
    pub(super) fn stopped_m_s(&self, [_, end_s]: [f64; 2]) -> f64 {
        match self.followed.stop() {
            Stop::AtRest { time_s, .. } if end_s >= time_s && !self.followed.is_early() => self.followed.later_m_s(),
            _ => 0.0,
        }
    }
    fn is_box(&self) -> bool {
        self.followed.drop.is_solid()
    }
    /// Returns the possible demand of later strikes where none that was followed has any demand, in the unit of the limit.
    pub(super) fn later_of(&self, limit: &Limit, suspension: Option<&Suspension>) -> f64 {
        let later = self.later();
        match (limit.kind.source(), suspension) {
            (Source::Turn, _) => later.turn_rad_s,
            (Source::Shock | Source::Boundary, _) => later.turned_m_s,
            (Source::Response(peak), Some(part)) => self.rings_most(peak, 1.0, part, later.shock_of(part), 0.0),
            (Source::Response(_), None) => later.acceleration_m_s2,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_flight::{Axis, Body, Drop, Place, Side, Until};

    use crate::model::follow;
    use clatter_product::Model;

    /// Returns a box of 120 mm × 80 mm × 20 mm with these radii of gyration of its mass along length and width, that lands flat at 2 m/s.
    fn lying([along, gyration_m]: [f64; 2], restitution: f64) -> Drop {
        let width = Side { ends_m: [0.04; 2], gyration_m };
        let body = Body::new(0.12, along).unwrap().with_width(width).with_thickness(Side::even(0.02));
        Drop {
            is_level: false,
            gravity_m_s2: 9.81,
            contact_time_s: Some(2e-4),
            ..Drop::new(body, 2.0, 0.0, restitution)
        }
    }

    /// Returns a bar of 150 mm that lands flat, with contacts of 0.2 ms.
    fn bar(speed_m_s: f64, restitution: f64) -> Drop {
        Drop {
            gravity_m_s2: 9.81,
            contact_time_s: Some(2e-4),
            ..Drop::new(Body::new(0.15, 0.045).unwrap(), speed_m_s, 0.0, restitution)
        }
    }

    /// Mass near the edges, landing flat: it lands again with e times its speed, all four corners along one line of their springs. Its
    /// center has a velocity change of (1 + e) e v, and √(4/μ) times the peak of a lone contact, 13 % more than one of its own.
    #[test]
    fn a_box_that_lands_again_stays_within_its_bounds() {
        let (e, v, time_s) = (0.6, 2.0, 2e-4);
        let drop = lying([0.058, 0.039], e);
        let followed = follow(&drop, Model::Compliant, 0.01, Until::Lands).unwrap();
        let later = PlaceHistory::new(&followed, Place::default()).unwrap().later();
        // Gravity works during the contact, by a thousandth.
        let lands = 0.995 * e * v;
        assert!(later.shock_m_s >= (1.0 + e) * lands && later.turned_m_s >= (1.0 + e) * lands, "{}", later.shock_m_s);
        let thick = 0.02_f64.powi(2) / 12.0;
        let own = 1.0 + 0.06_f64.powi(2) / (0.058_f64.powi(2) + thick) + 0.04_f64.powi(2) / (0.039_f64.powi(2) + thick);
        let peak = lands * FRAC_PI_2 * (1.0 + e) / time_s * (4.0 / own).sqrt();
        assert!(later.acceleration_m_s2 >= peak, "{} below {peak}", later.acceleration_m_s2);
        // All of it in a turn about the axis of least inertia.
        let least = (0.039_f64.powi(2) + thick).sqrt();
        assert!(later.turn_rad_s >= (1.0 + e) * lands / least, "{}", later.turn_rad_s);
    }

    /// All energy moves an end of a bar by √(1 + (a/ρ)²) of what it would move the center of mass by: so much more a strike may do there.
    #[test]
    fn what_may_come_is_more_at_an_end_than_in_the_middle() {
        let followed = follow(&bar(2.0, 0.6), Model::Compliant, 0.01, Until::Lands).unwrap();
        let at = |x: f64| PlaceHistory::new(&followed, Place::flat([x, 0.0])).unwrap().later();
        let (end, middle) = (at(-0.075), at(0.0));
        let more = 1.0_f64.hypot(0.075 / 0.045);
        assert!(middle.shock_m_s > 0.0 && (end.shock_m_s / middle.shock_m_s / more - 1.0).abs() < 1e-12);
        assert!((end.turned_m_s / middle.turned_m_s / more - 1.0).abs() < 1e-12);
    }

    /// No acceleration acts along a box that lands flat, until it lands otherwise: that is bounded.
    #[test]
    fn where_nothing_is_felt_what_may_come_is_bounded() {
        let drop = lying([0.04, 0.025], 0.5);
        let up = follow(&drop, Model::Compliant, 0.01, Until::Lands).unwrap();
        let place = PlaceHistory::new(&up, Place { axis: Axis::X, ..Place::default() }).unwrap();
        let limit = Limit::new(clatter_product::LimitKind::RattleSpace, 1e-3);
        let part = Suspension::from_hz(40.0, clatter_shock::DampingRatio::new(0.05).unwrap()).unwrap();
        let asked = place.answer_or_nothing(&limit, Some(&part)).unwrap();
        // It comes down with e v = 1 m/s: on its end that would be one blow of (1 + e) e v, by which the part swings v/ω, less e^(−ζ π/2).
        let swing = 1.5 * 0.995 / part.omega() * (-0.05 * FRAC_PI_2).exp();
        assert!(asked.value.abs() < 1e-12 && (swing..4.0 * swing).contains(&asked.off_by), "{asked:?}, {swing}");
    }

    /// A part without damping rings on until the product lands again, in step with it or against it: followed on, it never has a demand of
    /// more than was said as the product was up.
    #[test]
    fn what_rings_on_adds_to_what_comes() {
        let drop = bar(1.0, 0.9);
        let up = follow(&drop, Model::Compliant, 0.01, Until::Lands).unwrap();
        let on = follow(&drop, Model::Compliant, 0.01, Until::Past(0.3)).unwrap();
        let [up, on] = [&up, &on].map(|followed| PlaceHistory::new(followed, Place::default()).unwrap());
        let limit = Limit::new(clatter_product::LimitKind::RattleSpace, 1e-3);
        let mut tightest = 0.0_f64;
        for n in 0..60 {
            let hz = 20.0 + 0.5 * f64::from(n);
            let damped = Suspension::from_hz(hz, clatter_shock::DampingRatio::new(0.02).unwrap()).unwrap();
            // A later peak that does not exceed the peak so far need not be reported.
            let reached = up.answer(&limit, Some(&damped), 0.0).unwrap().unwrap().utilization();
            let said = up.later_most(&limit, [&damped], reached).max(reached);
            let asked = on.answer(&limit, Some(&damped), 0.0).unwrap().unwrap().utilization();
            assert!(asked <= said * (1.0 + 1e-9), "{hz} Hz, damped: {asked}, not {said} above {reached}");
            let part = Suspension::from_hz(hz, clatter_shock::DampingRatio::new(0.0).unwrap()).unwrap();
            let said = up.later_most(&limit, [&part], 0.0);
            let asked = on.answer(&limit, Some(&part), 0.0).unwrap().unwrap().utilization();
            assert!(asked <= said, "{hz} Hz: {asked}, not {said}");
            tightest = tightest.max(asked / said);
        }
        assert!(tightest > 0.7, "{tightest}: none is in step");
    }

    /// A part so soft that its weight counts for more than the fall: it rings by twice what it hangs through, which is reported while the
    /// product is still up and acts only from when it lies.
    #[test]
    fn a_weight_that_comes_is_among_what_may_come() {
        let drop = bar(0.3, 0.6);
        let part = Suspension::from_hz(1.0, clatter_shock::DampingRatio::new(0.0).unwrap()).unwrap();
        let hangs = drop.gravity_m_s2 / (part.omega() * part.omega());
        let limit = Limit::new(clatter_product::LimitKind::RattleSpace, hangs);
        let up = follow(&drop, Model::Compliant, 0.01, Until::Lands).unwrap();
        let weights = (up.carried_m_s2(&Place::default()), up.weight_to_come_m_s2());
        assert!(up.is_early() && weights == (0.0, 9.81), "{} {weights:?} {:?}", up.is_early(), up.stop());
        let up = PlaceHistory::new(&up, Place::default()).unwrap();
        let said = up.later_most(&limit, [&part], 0.0);
        let still = follow(&drop, Model::Compliant, 0.01, Until::Over).unwrap();
        assert_eq!((still.carried_m_s2(&Place::default()), still.weight_to_come_m_s2()), (9.81, 0.0));
        let still = PlaceHistory::new(&still, Place::default()).unwrap();
        let asked = still.answer(&limit, Some(&part), 0.0).unwrap().unwrap().utilization();
        // 1 + √(1 + x²) with what the fall alone moves it by, x = v ω/g = 0.19; bounces bring both about within a tenth of a period.
        assert!((asked - 2.0).abs() < 0.1, "{asked}");
        assert!(said >= asked && said < 1.5 * asked, "{said} of {asked}");
    }

    /// Bounces that lose a hundredth are given up: what is left are geometric series, of both ends of a bar and of four corners of a plate.
    #[test]
    fn bounces_that_were_given_up_are_those_of_all_points() {
        let bar = Body::new(0.15, 0.045).unwrap();
        let plate = bar.with_width(Side { ends_m: [0.04; 2], gyration_m: 0.023 });
        for (body, direction_rad, points) in [(bar, 0.0, 2.0), (plate, 0.3, 4.0)] {
            let drop = Drop {
                direction_rad,
                gravity_m_s2: 9.81,
                contact_time_s: Some(2e-4),
                ..Drop::new(body, 3.0, 0.02, 0.99)
            };
            let followed = follow(&drop, Model::Compliant, 0.01, Until::Over).unwrap();
            assert!(followed.is_given_up(), "{:?}", followed.stop());
            let later = PlaceHistory::new(&followed, Place::default()).unwrap().later();
            let series: f64 = (0..5000).map(|n| 0.99_f64.powi(n)).sum();
            let in_turn = later.given_up.expect("given up").in_turn;
            assert!((in_turn / (points * series) - 1.0).abs() < 1e-9, "{in_turn}");
        }
    }

    /// A part that is stiffer than the contact follows its force: of the half-sine with which both ends of a bar land flat again, lasting
    /// √(μ/2) times as long as a lone contact, an undamped part has no larger demand than is reported.
    #[test]
    fn a_stiff_part_is_asked_for_no_more_than_said_as_it_lands_again() {
        let (e, v, time_s) = (0.6, 2.0, 2e-4);
        let drop = bar(v, e);
        let followed = follow(&drop, Model::Compliant, 0.01, Until::Lands).unwrap();
        let later = PlaceHistory::new(&followed, Place::default()).unwrap().later();
        let duration = time_s * (0.5 * (1.0 + (0.075_f64 / 0.045).powi(2))).sqrt();
        let amplitude = (1.0 + e) * e * v * FRAC_PI_2 / duration;
        let shape = clatter_shock::Shape::HalfSine;
        let blow =
            clatter_shock::Pulses::new(&[clatter_shock::Pulse { shape, amplitude, duration, start: 0.0 }]).unwrap();
        let mut tightest = 0.0_f64;
        for hz in [100.0, 1000.0, 2500.0, 4000.0, 8000.0, 20_000.0] {
            let part = Suspension::from_hz(hz, clatter_shock::DampingRatio::new(0.0).unwrap()).unwrap();
            let (asked, said) = (blow.respond(&part).pseudo_velocity().magnitude(), later.shock_of(&part));
            assert!(asked <= said, "{hz} Hz: {asked}, not {said}");
            tightest = tightest.max(asked / said);
        }
        assert!(tightest > 0.4, "{tightest}");
    }
}
