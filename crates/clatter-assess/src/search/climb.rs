//! This module climbs from drops with a large demand to those with the largest.

use super::budgets::{
    AS_BLOCK, BEYOND_PEAK, BOX_REACH, BOX_TRIES, CLIMB_HALVINGS, CLIMBS, CLOSER, DIRECTION_STEP, EDGES_REACH,
    EDGES_TRIES, FACE_TRIES, LATE_REACH, LATE_TRIES, LATER, NEAR, NEXT,
};
use super::grid::halton;
use super::ranges::{AXES, Coordinates, DAMPING, DIRECTION, FREQUENCY, Ranges, STOPS, TILT};
use rayon::prelude::*;

use super::{Candidate, Task, Work, fastest_rad_s, rough_to_rad_s};
use crate::engine::{PlaceHistory, of_followed};
use clatter_flight::{Drop, Followed, Until};
use clatter_product::{Error, MOST_FRICTION, Mount};

impl Ranges<'_> {
    /// Returns whether the demand changes by edges or steps where contacts meet.
    pub(super) fn has_edges(&self, task: &Task<'_>) -> bool {
        let stiff = |longest_s: f64| fastest_rad_s(task.component) * longest_s > 1.0;
        let times = self.product.contact_times_s().filter(|_| self.base.is_none());
        times.is_some_and(|[_, longest_s]| task.component.mount == Mount::Hard || stiff(longest_s))
    }

    /// Climbs from a place as its body and the time of its peak require.
    pub(super) fn climb_from(&self, task: &Task<'_>, start: Candidate, tilt_step: f64, work: &Work<'_>) -> Candidate {
        if self.base.is_some() {
            let tries = if self.faces() < 3 && !start.late { FACE_TRIES } else { BOX_TRIES };
            return self.climb_around(task, start, (BOX_REACH, tries), work);
        }
        if start.late {
            return self.climb_around(task, start, (LATE_REACH, LATE_TRIES[self.by_impacts()]), work);
        }
        let climbed = self.climb(task, start, tilt_step, work);
        // Touches of a stop come and go as contacts do.
        let by_steps = self.has_edges(task) || task.hits_stops();
        if by_steps { self.climb_around(task, climbed, (EDGES_REACH, EDGES_TRIES), work) } else { climbed }
    }

    /// Climbs from a place in all ranges, one after the other, each step half as long as the last.
    fn climb(&self, task: &Task<'_>, start: Candidate, tilt_step: f64, work: &Work<'_>) -> Candidate {
        let (until, fastest) = (Until::Lands, rough_to_rad_s(task.component));
        let free = self.free_at(task, &start.place);
        let frequency_step = 0.5 / f64::from(Self::frequencies(task, &self.single(&start.place)).max(4));
        let mut steps = [0.25; AXES];
        (steps[TILT], steps[DIRECTION]) = (tilt_step, DIRECTION_STEP);
        (steps[FREQUENCY], steps[DAMPING]) = (frequency_step, 0.5);
        let mut shrink = [0.5; AXES];
        shrink[DIRECTION] = self.shrinking(&start.place);
        let mut best = start;
        let Ok(mut here) = self.follow(&best.place, until) else { return best };
        for _ in 0..CLIMB_HALVINGS {
            for axis in [FREQUENCY].into_iter().chain(STOPS).filter(|axis| free[*axis]) {
                best = Self::at_ends(task, axis, best, &here, fastest);
            }
            for axis in (0..AXES).filter(|&axis| free[axis]) {
                if work.go_on(0).is_err() {
                    return best;
                }
                for sign in [-1.0, 1.0] {
                    let share = (best.place.shares[axis] + sign * steps[axis]).clamp(0.0, 1.0);
                    if (share - best.place.shares[axis]).abs() < 1e-12 {
                        continue;
                    }
                    let place = best.place.with(axis, share);
                    let same = axis == FREQUENCY || axis == DAMPING || STOPS.contains(&axis);
                    let moved = if same { None } else { self.follow(&place, until).ok() };
                    if !same && moved.is_none() {
                        continue;
                    }
                    let followed = moved.as_ref().unwrap_or(&here);
                    let Ok(felt) = PlaceHistory::rough(followed, task.place(place.at_m), fastest) else { continue };
                    if let Ok(Some(next)) = Self::in_drop(task, &place, &felt, best.answer.utilization()) {
                        best = Candidate { late: best.late, ..next };
                        here = moved.unwrap_or(here);
                        break;
                    }
                }
            }
            steps = std::array::from_fn(|axis| shrink[axis] * steps[axis]);
        }
        best
    }

    /// Returns the factor on the steps in the direction of a climb, so that the last moves the touch of no corner by more than a part
    /// of a contact: next to a landing on an edge, and where two corners come down in turn, the demand changes with that.
    fn shrinking(&self, place: &Coordinates) -> f64 {
        libm::pow(self.turn_in_contact(place) / DIRECTION_STEP, f64::from(CLIMB_HALVINGS - 1).recip()).clamp(0.25, 0.5)
    }

    /// Returns the part at both ends of a range of its own in the same drop, where its demand is larger: strikes that come in step with it,
    /// or just before it reaches its stop, have their crests far from one another, which no step of a climb goes over.
    fn at_ends(task: &Task<'_>, axis: usize, best: Candidate, here: &Followed, fastest_rad_s: f64) -> Candidate {
        let Ok(felt) = PlaceHistory::rough(here, task.place(best.place.at_m), fastest_rad_s) else { return best };
        [0.0, 1.0].into_iter().fold(best, |best, share| {
            let place = best.place.with(axis, share);
            let next = Self::in_drop(task, &place, &felt, best.answer.utilization());
            next.ok().flatten().map_or(best, |next| Candidate { late: best.late, ..next })
        })
    }

    /// Climbs in all ranges at once. After rebounds all ranges together decide in which phase a part is struck again, and the demand on
    /// stiff and rigidly mounted parts has edges where contacts meet.
    fn climb_around(&self, task: &Task<'_>, start: Candidate, how: (f64, u32), work: &Work<'_>) -> Candidate {
        let (free, fastest) = (self.free_at(task, &start.place), rough_to_rad_s(task.component));
        // A climb is after the peak that it began with, not after those that elastic products have for minutes.
        let until = if start.late { Until::Past(LATER * start.answer.time_s) } else { Until::Lands };
        let mut best = start;
        around(start.place, free, how, work, |place| {
            let Ok(followed) = self.follow(place, until) else { return false };
            let Ok(felt) = PlaceHistory::rough(&followed, task.place(place.at_m), fastest) else { return false };
            let next = Self::in_drop(task, place, &felt, best.answer.utilization()).ok().flatten();
            best = next.map_or(best, |next| Candidate { late: start.late, ..next });
            next.is_some()
        });
        best
    }

    /// Finds a box next to one that leans so far which falls over an edge of what it landed on; none where none is found.
    pub(super) fn fallen_over(
        &self,
        task: &Task<'_>,
        start: Coordinates,
        mut lean: f64,
        work: &Work<'_>,
    ) -> Option<Coordinates> {
        let mut fallen = None;
        around(start, self.free_at(task, &start), (BOX_REACH, FACE_TRIES), work, |place| {
            if fallen.is_some() {
                return false;
            }
            let leans = self.follow(place, Until::Rebounded).map_or(0.0, |followed| followed.lean());
            fallen = Some(*place).filter(|_| leans > 1.0);
            let rises = leans > lean;
            lean = lean.max(leans);
            rises
        });
        fallen
    }
}

/// Tries all around a place, ever closer, and around each that rises; a step that went up is taken once more.
fn around(
    mut best: Coordinates,
    free: [bool; AXES],
    (reach, tries): (f64, u32),
    work: &Work<'_>,
    mut rises: impl FnMut(&Coordinates) -> bool,
) {
    let mut again = None;
    for k in 1..=tries {
        if work.go_on(0).is_err() {
            break;
        }
        let reach = reach * libm::pow(CLOSER, f64::from(k) / f64::from(tries));
        let around =
            || std::array::from_fn(|axis| if free[axis] { reach * (2.0 * halton(axis, k) - 1.0) } else { 0.0 });
        let step: [f64; AXES] = again.take().unwrap_or_else(around);
        let mut place = best;
        for (share, step) in place.shares.iter_mut().zip(step) {
            *share = (*share + step).clamp(0.0, 1.0);
        }
        if rises(&place) {
            best = place;
            again = Some(step);
        }
    }
}

impl Ranges<'_> {
    /// Returns the largest utilization of a box of this thickness with full rotation, without friction and with the most that is assumed: in
    /// the worst drop of a plate or of a bar, in other drops from which the search climbed, and in drops next to each, which real tilt shifts.
    ///
    /// # Errors
    /// That of the worst drop, of a box that is not followed so.
    pub(crate) fn as_block(&self, task: &Task<'_>, worst: &Candidate, others: &[Candidate]) -> Result<f64, Error> {
        let mut most = self.as_block_next_to(task, worst, AS_BLOCK)?;
        for other in others {
            most = most.max(self.as_block_next_to(task, other, AS_BLOCK / 3)?);
        }
        Ok(most)
    }

    fn as_block_next_to(&self, task: &Task<'_>, at: &Candidate, count: u32) -> Result<f64, Error> {
        let of = |place: &Coordinates, friction: f64| -> Result<f64, Error> {
            let drop = Drop { friction, ..self.single(place) };
            let until_s = (BEYOND_PEAK * at.answer.time_s).max(drop.clatter_s());
            let followed = Followed::as_block(&drop, until_s)?;
            if self.product.body.is_wide() {
                followed.check_depth()?;
            }
            let part = Candidate { place: *place, ..*at }.part_there(task.component);
            Ok(of_followed(&followed, &part, &task.limit)?.utilization())
        };
        let free = self.free_at(task, &at.place);
        let next = |k: u32| {
            let mut place = at.place;
            for axis in [TILT, DIRECTION].into_iter().filter(|axis| free[*axis]) {
                let step = NEXT * (2.0 * halton(axis, k) - 1.0);
                place.shares[axis] = (place.shares[axis] + step).clamp(0.0, 1.0);
            }
            place
        };
        let both = |place: &Coordinates| [0.0, MOST_FRICTION].map(|friction| of(place, friction));
        let [smooth, rough] = both(&at.place);
        let here = smooth?.max(rough?);
        let beside = |k: u32| both(&next(k)).into_iter().flatten().fold(0.0, f64::max);
        Ok((1..=count).into_par_iter().map(beside).reduce(|| here, f64::max))
    }
}

/// Returns the places to climb from: the highest, some way from one another.
pub(super) fn starts(found: &mut [Candidate]) -> Vec<Candidate> {
    found.sort_by(|a, b| b.answer.utilization().total_cmp(&a.answer.utilization()));
    let most = found.first().map_or(0.0, |asked| asked.answer.utilization());
    let mut starts: Vec<Candidate> = Vec::new();
    for asked in found.iter().take_while(|asked| asked.answer.utilization() >= NEAR * most) {
        let next = |other: &Candidate| {
            let close = |axis: usize| {
                let reach = match axis {
                    TILT => 0.1,
                    // Half of the first step of a climb.
                    DIRECTION => 0.5 * DIRECTION_STEP,
                    _ => 0.3,
                };
                (other.place.shares[axis] - asked.place.shares[axis]).abs() < reach
            };
            other.late == asked.late
                && other.place.flat == asked.place.flat
                && other.place.first == asked.place.first
                && other.place.at_m.map(f64::to_bits) == asked.place.at_m.map(f64::to_bits)
                && other.place.mirrored == asked.place.mirrored
                && (0..AXES).all(close)
        };
        let such = starts.iter().filter(|other| other.late == asked.late).count();
        if such < CLIMBS && !starts.iter().any(next) {
            starts.push(*asked);
        }
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::super::ranges::Coordinates;
    use super::*;
    use crate::Accuracy;
    use crate::assess::ranges;
    use crate::engine::Answer;
    use clatter::End;
    use clatter_product::{Limit, ProductFile, Unit};

    /// Real tilt shifts the demand on a plate: the box of the same product is followed in drops next to the worst one too, and next to the
    /// other drops from which the search climbed.
    #[test]
    fn real_tilt_is_asked_next_to_the_worst_drop_and_to_the_others() {
        let text = r#"
product = { name = "plate", length = "150 mm", width = "70 mm", thickness = "7 mm", radius_of_gyration = ["43 mm", "20 mm"], restitution = 0.3, contact_time = "0.3 ms" }
drop = { speed = "3 m/s", tilt = ["2 deg", "14 deg"], direction = "20 deg" }
component = [{ name = "part", position = ["70 mm", "30 mm"], mount = "hard", velocity_change_limit = "9 m/s" }]
"#;
        let file = ProductFile::read(text, "plate.toml").unwrap_or_else(|faults| panic!("{faults}"));
        let (ranges, component) = (ranges(&file, &Accuracy::default()), &file.components[0]);
        let task = Task { component, limit: Limit::of(component)[0] };
        let at = |tilt: f64| {
            let mut shares = [0.0; AXES];
            shares[TILT] = tilt;
            let place = Coordinates { first: End::A, flat: false, mirrored: [false; 2], at_m: [0.07, 0.03], shares };
            let unit = Unit::MeterPerSecond;
            let answer = Answer { value: 0.0, allowed: 9.0, unit, time_s: 5e-3, impact: 1, off_by: 0.0 };
            Candidate { place, part: None, answer, late: false }
        };
        let alone = |tilt: f64| ranges.as_block_next_to(&task, &at(tilt), 0).unwrap();
        let beside = |tilt: f64| alone(tilt - 0.03).max(alone(tilt + 0.03));
        let rises = |tilt: &f64| beside(*tilt) > 1.001 * alone(*tilt);
        let tilt = [0.2, 0.4, 0.6, 0.8].into_iter().find(rises).expect("it is no plain");
        let most = ranges.as_block(&task, &at(tilt), &[]).unwrap();
        assert!(most >= beside(tilt), "{most} below {}", beside(tilt));
        let mut tilts = [0.1, 0.3, 0.5, 0.7, 0.9];
        tilts.sort_by(|a, b| alone(*a).total_cmp(&alone(*b)));
        let [low, .., high] = tilts;
        let most = ranges.as_block(&task, &at(low), &[at(high)]).unwrap();
        assert!(most >= alone(high) && alone(high) > 1.01 * alone(low), "{most}, {}, {}", alone(high), alone(low));
    }

    /// Where the ground holds its corners a tilted plate is seldom asked for more, and then by its next strike, which comes at another time:
    /// the box beside it is followed with friction too.
    #[test]
    fn the_box_beside_a_plate_rubs_on_the_ground() {
        let text = r#"
product = { name = "plate", length = "150 mm", width = "70 mm", thickness = "60 mm", radius_of_gyration = ["43 mm", "20 mm"], restitution = 0.3, contact_time = "0.3 ms" }
drop = { speed = "3 m/s", tilt = "14 deg", direction = "20 deg" }
component = [{ name = "part", position = ["70 mm", "30 mm"], natural_frequency = "100 Hz", damping_ratio = 0.05, rattle_space = "9 mm" }]
"#;
        let file = ProductFile::read(text, "plate.toml").unwrap_or_else(|faults| panic!("{faults}"));
        let (ranges, component) = (ranges(&file, &Accuracy::default()), &file.components[0]);
        let task = Task { component, limit: Limit::of(component)[0] };
        let place = Coordinates { at_m: [0.07, 0.03], ..ranges.middle(component) };
        let answer = Answer { value: 0.0, allowed: 9e-3, unit: Unit::Meter, time_s: 6e-2, impact: 1, off_by: 0.0 };
        let mut holds = 0;
        for hz in [20.0, 40.0, 80.0, 160.0, 320.0] {
            let part = clatter_shock::Suspension::from_hz(hz, clatter_shock::DampingRatio::new(0.05).unwrap()).unwrap();
            let at = Candidate { place, part: Some(part), answer, late: false };
            let [smooth, rough] = [0.0, MOST_FRICTION].map(|friction| {
                let drop = Drop { friction, ..ranges.single(&place) };
                let followed = Followed::as_block(&drop, (BEYOND_PEAK * answer.time_s).max(drop.clatter_s())).unwrap();
                of_followed(&followed, &at.part_there(component), &task.limit).unwrap().utilization()
            });
            holds += u32::from(rough > 1.01 * smooth);
            let most = ranges.as_block_next_to(&task, &at, 0).unwrap();
            assert_eq!(most.to_bits(), smooth.max(rough).to_bits(), "{hz}: {most}, {smooth}, {rough}");
        }
        assert!(holds > 0, "friction asks nowhere for more");
    }

    /// The box that stands for a bar turns as the bar does, at any tilt: with a thickness, with its center of mass off its middle and with an end
    /// of its own, whose contacts its corners share. On ground with friction it turns otherwise.
    #[test]
    fn a_box_turns_as_the_bar_that_it_stands_for() {
        use crate::{Part, answer};
        use clatter_flight::{Body, OwnContact, OwnContacts, Side};
        use clatter_product::{ContactLaw, LimitKind, Model};
        let soft = OwnContact { restitution: Some(0.2), contact_time_s: Some(8e-4) };
        let (part, limit) = (Part::new(0.0, None), Limit::new(LimitKind::AngularVelocityChange, 1.0));
        let (mut off, mut rubs) = (0.0_f64, 0.0_f64);
        for n in 0_u32..24 {
            let x = |k: u32| (0.618_033_988_749_895 * f64::from(n * 37 + k * 101) + 0.1 * f64::from(k)).fract();
            let body = Body::off_center(0.1, 0.06 + 0.06 * x(1), 0.04 + 0.015 * x(2)).unwrap();
            let body = if n % 3 == 0 { body.with_thickness(Side::even(0.01)) } else { body };
            let own = if n % 4 == 0 { soft } else { OwnContact::NONE };
            let bar = Drop {
                contact_time_s: Some(3e-4 + 5e-4 * x(3)),
                own_contacts: OwnContacts([own, OwnContact::NONE, OwnContact::NONE, OwnContact::NONE]),
                direction_rad: Drop::towards(if n % 2 == 0 { End::A } else { End::B }),
                contact_law: if n % 4 == 1 { ContactLaw::Dashpot } else { ContactLaw::Hysteretic },
                ..Drop::new(body, 3.0, 0.02 + 0.8 * x(4), 0.2 + 0.5 * x(5))
            };
            let followed = answer(&bar, &part, &limit, Model::Compliant, 1e-3).unwrap();
            let [smooth, rough] = [0.0, MOST_FRICTION].map(|friction| {
                let drop = Drop { friction, ..bar };
                let block = Followed::as_block(&drop, 1.2 * followed.time_s + 5e-3).unwrap();
                of_followed(&block, &part, &limit).unwrap().value
            });
            // Of the axes about which turns of a box are looked at, the next one is 5.5° off that of a bar.
            off = off.max((smooth / (0.9954 * followed.value) - 1.0).abs());
            rubs = rubs.max((rough / smooth - 1.0).abs());
        }
        assert!(off < 1e-3 && rubs > 0.03, "{off}, {rubs}");
    }
}
