//! A drop as far as it is followed, by the engine that it needs.

mod edges;
mod solid;

use clatter::{End, Excitation};

use crate::drop::{Drop, Engine};
use crate::motion::{Ahead, FeetMotion, Motion, PlateMotion};
use crate::{Contact, Error, Feet, Model, Place, Stop};
use solid::{BlockMotion, axes};

/// A drop as far as it was followed.
#[derive(Debug, Clone)]
pub struct Followed {
    /// The drop.
    pub drop: Drop,
    /// The precision of its flight, as a share.
    pub precision: f64,
    /// Largest velocity shock of a point that touches.
    pub largest_m_s: f64,
    motion: Course,
    is_early: bool,
}

/// The motion by one of the engines.
#[derive(Debug, Clone)]
enum Course {
    Bar(Motion),
    /// A bar on two feet, which are its first points; the edges beyond them are the others.
    BarOnFeet(Motion<4>),
    Plate(Box<PlateMotion>),
    PlateOnFeet(Box<FeetMotion>),
    Solid(BlockMotion),
}

/// The same of motions whose strikes have points, and of a box.
macro_rules! of_each {
    ($course:expr, $motion:ident => $what:expr, $block:ident => $other:expr) => {
        match $course {
            Course::Bar($motion) => $what,
            Course::BarOnFeet($motion) => $what,
            Course::Plate($motion) => $what,
            Course::PlateOnFeet($motion) => $what,
            Course::Solid($block) => $other,
        }
    };
}

/// A hysteretic contact that is pushed again unloads and reloads along a line that is stiffer by 1/e²: the force of a slow shock
/// is larger by 1/e. Drops are followed so much longer, down to this restitution.
const LEAST_SHARE: f64 = 0.02;
/// Drops are left after rebounds once the energy allows no later shock above this share of the largest.
const LATE: f64 = 0.25;
/// Strikes followed at most.
const MOST_STRIKES: usize = 1024;
/// Of a box, which lies still after some tens as a rule, and rocks some hundred times before it falls over.
const PRESSES_OF_BOX: usize = 512;

/// Precision of a flight, as a share of the tolerance of its answer.
pub const PRECISION: f64 = 0.1;

/// How far a drop is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Until {
    /// Until it comes down after its clatter.
    Lands,
    /// Until it comes down after a time in s.
    LandsAfter(f64),
    /// Until the energy allows no shock above a quarter of the largest.
    Rebounded,
    /// The same, or until it comes down after a time in s.
    Past(f64),
    /// Until nothing later counts.
    Over,
}

/// Asked while a motion is followed whether it is over: by the time, what may come later, the largest shock so far, and whether it lands.
fn leaves<const N: usize>(
    is_over: &impl Fn(f64, f64, f64, bool) -> bool,
    given_back: f64,
) -> impl FnMut(&Ahead<N>) -> bool {
    move |ahead| is_over(ahead.time_s, given_back * ahead.most_m_s, ahead.largest_m_s, ahead.lands)
}

impl Followed {
    /// Follows a drop by a model until nothing later counts, or is left before.
    ///
    /// The engine follows from the drop: a bar is seen from the side, a body near level is a plate of small tilt, and every other body
    /// a box. Until [`Until::Over`] the energy that is left allows no velocity shock above `tolerance` of the largest times the
    /// restitution.
    ///
    /// # Errors
    /// [`Error::Instant`] for a plate or a box by instant impacts; [`Error::ContactTime`] for contacts whose time is not known;
    /// [`Error::Edge`] where an edge beyond feet comes down in the clatter of instant impacts; others for a drop that the model does not
    /// take.
    pub fn new(drop: &Drop, model: Model, tolerance: f64, until: Until) -> Result<Self, Error> {
        let followed = Self::at_most(drop, model, tolerance, until, f64::INFINITY)?;
        match followed.edge_comes_down_s()? {
            Some(edge_s) => Self::at_most(drop, model, tolerance, until, edge_s),
            None => Ok(followed),
        }
    }

    /// The same, left at `most_s` by instant impacts where it is not over by then.
    fn at_most(drop: &Drop, model: Model, tolerance: f64, until: Until, most_s: f64) -> Result<Self, Error> {
        let precision = PRECISION * tolerance;
        // Without restitution the strikes of one instant add up, and end by themselves.
        let [least_e, most_e] = drop.restitutions();
        let share = if most_e == 0.0 { 0.0 } else { tolerance * least_e.max(LEAST_SHARE) };
        let clatter_s = drop.clatter_s();
        // A strike gives back the restitution's share of what it takes.
        let given_back = 0.5 * (1.0 + most_e);
        let is_over = |time_s: f64, later: f64, largest: f64, lands: bool| {
            later <= share * largest
                || match until {
                    Until::Lands => lands && time_s > clatter_s,
                    Until::LandsAfter(most_s) => lands && time_s > most_s,
                    Until::Rebounded => lands && time_s > clatter_s && later <= LATE * largest,
                    Until::Past(most_s) => lands && time_s > clatter_s && (later <= LATE * largest || time_s > most_s),
                    Until::Over => false,
                }
        };
        let takes_time = matches!(model, Model::Contacts(_));
        let (motion, precision) = match (drop.engine(), drop.body.feet, &drop.body.width) {
            (Engine::Level | Engine::Solid, ..) if !takes_time => return Err(Error::Instant),
            (Engine::Solid, ..) => {
                let lands_s = match until {
                    Until::Lands => Some(clatter_s),
                    Until::LandsAfter(time_s) => Some(time_s),
                    Until::Past(time_s) => Some(time_s.max(clatter_s)),
                    Until::Rebounded | Until::Over => None,
                };
                let block = drop.block_drop()?.with_impact_limit(PRESSES_OF_BOX);
                let block = match lands_s {
                    Some(lands_s) => block.with_time_limit_s(drop.settled_s())?.until_it_lands_after_s(lands_s),
                    None => block.with_time_limit_s(drop.settled_s())?,
                };
                let block = if until == Until::Rebounded { block.with_enough(LATE) } else { block };
                (Course::Solid(BlockMotion::new(&block, &drop.contacts_of_block()?)?), 0.0)
            }
            (Engine::Level, feet, Some(width)) => {
                let scene = drop.plate_scene(width)?.with_impact_limit(MOST_STRIKES);
                let motion = if let Some(Feet { inset_m, height_m }) = feet {
                    let enough = leaves(&is_over, given_back);
                    let motion = scene.on_feet_until(inset_m, height_m, &drop.contacts()?, precision, enough)?;
                    Course::PlateOnFeet(Box::new(motion.giving_back(given_back)))
                } else {
                    let enough = leaves(&is_over, given_back);
                    let motion = scene.own_contacts_until(&drop.contacts()?, precision, enough)?;
                    Course::Plate(Box::new(motion.giving_back(given_back)))
                };
                (motion, precision)
            }
            (_, Some(feet), _) if takes_time => {
                let scene = drop.scene_on(&feet)?.with_impact_limit(MOST_STRIKES)?;
                let enough = leaves(&is_over, given_back);
                (Course::BarOnFeet(scene.fly_on_contacts(&drop.contacts()?, precision, enough)?), precision)
            }
            _ => {
                let scene = drop.scene()?.with_impact_limit(MOST_STRIKES)?.with_time_limit_s(most_s)?;
                let enough = leaves(&is_over, given_back);
                if drop.is_flat {
                    (Course::Bar(scene.fly_flat(share)), 0.0)
                } else if drop.own_contacts.is_none() {
                    (Course::Bar(scene.fly_until(model, precision, enough)?), precision)
                } else {
                    (Course::Bar(scene.fly_on_contacts(&drop.contacts()?, precision, enough)?), precision)
                }
            }
        };
        let mut followed = Self { drop: *drop, motion, precision, is_early: false, largest_m_s: 0.0 };
        followed.largest_m_s =
            of_each!(&followed.motion, motion => motion.largest_m_s(), block => block.flight.largest_m_s());
        followed.is_early =
            followed.later_m_s() > share * followed.largest_m_s && !matches!(followed.stop(), Stop::AtRest { .. });
        Ok(followed)
    }

    /// Follows a drop of a plate as one of the box that it is at real tilt, until a time. The corners of its bottom alone land, however far
    /// they sink in. For a bar stands a square box that does not turn about its length, two of whose corners share the contact of an end.
    ///
    /// # Errors
    /// [`Error::ContactTime`], and others for a box that is not followed so.
    pub fn as_block(drop: &Drop, until_s: f64) -> Result<Self, Error> {
        let (wide, is_bar) = (drop.widened(), !drop.body.is_wide());
        let block = wide.block_drop()?.with_time_limit_s(until_s)?;
        let contacts = wide.contacts_of_block()?.map(|contact| if is_bar { contact.half() } else { contact });
        let motion = BlockMotion::new(&block, &contacts)?;
        let largest_m_s = motion.flight.largest_m_s();
        Ok(Self { drop: wide, motion: Course::Solid(motion), precision: 0.0, is_early: false, largest_m_s })
    }

    /// Refuses corners of a plate that sink in deeper than it is known to be thick: those of its top, which are not followed, would touch as
    /// well.
    ///
    /// # Errors
    /// [`Error::Bound`].
    pub fn check_depth(&self) -> Result<(), Error> {
        let Course::Solid(motion) = &self.motion else { return Ok(()) };
        let (deepest_m, value) =
            (motion.deepest_m(), self.drop.contact_times_s().map_or(0.0, |[_, longest_s]| longest_s));
        let thickness_m = self.drop.body.thickness.map(|thickness| thickness.m());
        let Some(most_m) = thickness_m.filter(|most_m| deepest_m > *most_m) else { return Ok(()) };
        let (bound, reason) = (value * most_m / deepest_m, "so that corners sink in by the thickness at most");
        Err(Error::Bound { name: "contact time", value, bound, most: true, unit: "s", reason })
    }

    /// The same motion as that of another drop, of which more may come.
    #[must_use]
    pub fn left_early(self, drop: &Drop) -> Self {
        Self { drop: *drop, is_early: true, ..self }
    }

    /// Whether it was left while shocks that count may come.
    #[must_use]
    pub fn is_early(&self) -> bool {
        self.is_early
    }
    /// Whether what comes after the motion was left is not even bounded.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        self.later_m_s() == f64::INFINITY
    }
    /// Whether the motion was left at a limit, though strikes that count may follow.
    #[must_use]
    pub fn is_given_up(&self) -> bool {
        matches!(self.stop(), Stop::ImpactLimit { .. } | Stop::TimeLimit { .. } | Stop::EnergyLimit { .. })
    }
    /// Whether the product lies still at the end, or nothing that is left counts: then it carries its weight, on the mean over what it
    /// still bounces.
    fn lies(&self) -> bool {
        matches!(self.stop(), Stop::AtRest { .. } | Stop::Enough { .. }) && !self.is_early
    }
    /// Why the motion ends.
    #[must_use]
    pub fn stop(&self) -> Stop {
        of_each!(&self.motion, motion => motion.stop, block => block.stop)
    }
    /// No later strike changes the velocity of a point of a bar or of a plate by more, by the energy that is left; of a box that of its
    /// center of mass.
    #[must_use]
    pub fn later_m_s(&self) -> f64 {
        of_each!(&self.motion, motion => motion.later_m_s, block => block.center_m_s)
    }
    /// Energy over the mass as it was left: of a box counted from where the center of mass lies on the ground, of other bodies from where
    /// they lie; infinite where that is not bounded.
    #[must_use]
    pub fn energy_m2_s2(&self) -> f64 {
        if let Course::Solid(motion) = &self.motion {
            return motion.flight.energy_m2_s2;
        }
        // All of it in what moves the farthest point fastest, which the ground turns around.
        let [_, most_e] = self.drop.restitutions();
        let (points, _) = self.drop.in_radii(&Place::default());
        // Instant impacts of a bar on feet know these alone, which come first.
        let points = if self.has_contacts() { &points[..] } else { &points[..2] };
        let coupling = points.iter().fold(1.0_f64, |most, [x, y]| most.max(1.0 + x * x + y * y));
        0.5 * (self.later_m_s() / (1.0 + most_e)).powi(2) / coupling
    }
    /// How far a box has leaned at most from the face that it landed over: 1 balanced over an edge, more where it has fallen over.
    #[must_use]
    pub fn lean(&self) -> f64 {
        of_each!(&self.motion, _motion => 0.0, block => block.lean)
    }
    /// Gravity as the model knows it.
    #[must_use]
    pub fn gravity_m_s2(&self) -> f64 {
        of_each!(&self.motion, motion => motion.gravity_m_s2(), block => block.gravity_m_s2)
    }
    /// Whether contacts take time.
    #[must_use]
    pub fn has_contacts(&self) -> bool {
        of_each!(&self.motion, motion => motion.contact().is_some(), _block => true)
    }
    /// Largest acceleration in a lone contact over its change of velocity, of all contacts; none of instant impacts.
    #[must_use]
    pub fn peak_per_change(&self) -> Option<f64> {
        let most = |of: &[Contact]| of.iter().fold(0.0_f64, |most, contact| most.max(contact.peak_per_change()));
        of_each!(&self.motion, motion => motion.contacts().map(|of| most(&of)), block => Some(most(&block.contacts)))
    }
    /// When the last contact parted.
    #[must_use]
    pub fn parted_s(&self) -> f64 {
        of_each!(&self.motion, motion => motion.parted_s(), block => block.parted_s())
    }
    /// How long nothing has pressed as the motion was left.
    #[must_use]
    pub fn quiet_s(&self) -> f64 {
        (self.stop().time_s() - self.parted_s()).max(0.0)
    }
    /// When strikes begin, in order.
    #[must_use]
    pub fn struck_s(&self) -> Vec<f64> {
        of_each!(
            &self.motion,
            motion => motion.strikes.iter().map(|strike| strike.time_s).collect(),
            block => block.presses().map(|press| press.1[0]).collect()
        )
    }
    /// Of each strike of contacts that take time, the point, and when it touches and parts.
    #[must_use]
    pub fn presses(&self) -> Vec<(usize, [f64; 2])> {
        of_each!(&self.motion, motion => {
            let pressed = motion.strikes.iter().zip(&motion.presses);
            pressed.map(|(strike, press)| (strike.point, [press.from_s, press.until_s])).collect()
        }, block => block.presses().collect())
    }
    /// Number, from 1, of the last strike that began by a time; contacts do nothing as they begin.
    #[must_use]
    pub fn impact_at(&self, time_s: f64) -> u64 {
        let instant = !self.has_contacts();
        let begun = |touch_s: f64| touch_s < time_s || instant && touch_s <= time_s;
        self.struck_s().partition_point(|s| begun(*s)).max(1) as u64
    }
    /// Strikes of the corners of a plate near level, in order: which of them as seen from above, from a (−, −) to d (−, +), when it touches,
    /// and what its force does to its velocity.
    #[must_use]
    pub fn strikes_of_corners(&self) -> Vec<(usize, f64, f64)> {
        let all: Vec<(usize, f64, f64)> = match &self.motion {
            Course::Plate(motion) => {
                let of = motion.strikes.iter();
                of.map(|strike| (strike.point, strike.time_s, strike.delta_v_m_s[strike.point])).collect()
            }
            // Beyond the feet are the corners, in their order.
            Course::PlateOnFeet(motion) => {
                let of = motion.strikes.iter();
                of.map(|strike| (strike.point % 4, strike.time_s, strike.delta_v_m_s[strike.point])).collect()
            }
            Course::Bar(_) | Course::BarOnFeet(_) | Course::Solid(_) => Vec::new(),
        };
        let [x, y] = self.drop.signs().map(|sign| sign < 0.0);
        let corner = |point: usize| {
            let (right, back) = ((point == 1 || point == 2) ^ x, (point >= 2) ^ y);
            if back { 3 - usize::from(right) } else { usize::from(right) }
        };
        all.into_iter().map(|(point, time_s, change)| (corner(point), time_s, change)).collect()
    }
}

/// What a place goes through.
impl Followed {
    /// The acceleration that a place feels along its axis: above free fall.
    #[must_use]
    pub fn felt(&self, place: &Place) -> Excitation {
        let drop = &self.drop;
        match &self.motion {
            Course::Plate(motion) => motion.felt(drop.in_scene(place)),
            Course::PlateOnFeet(motion) => motion.felt(drop.in_scene(place)),
            Course::Solid(motion) => motion.felt(self.in_box(place), place.axis),
            Course::Bar(motion) => motion.felt(drop.relative(place.at_m[0])),
            Course::BarOnFeet(motion) => {
                let [x, ..] = drop.body.from_center(place.at_m);
                motion.felt_at([if drop.first() == End::A { x } else { -x }, 0.0]).unwrap_or_default()
            }
        }
    }
    /// A place from the center of mass of a box. In a plate that is followed as one it is as high as the center of mass.
    fn in_box(&self, place: &Place) -> [f64; 3] {
        let [x, y, z] = self.drop.body.from_center(place.at_m);
        [x, y, if self.drop.is_solid() { z } else { 0.0 }]
    }
    /// When instant impacts change the velocity of a place, and by how much; none where contacts take time.
    #[must_use]
    pub fn jumps(&self, place: &Place) -> Option<Vec<(f64, f64)>> {
        let Course::Bar(motion) = &self.motion else { return None };
        let s = self.drop.relative(place.at_m[0]);
        let jumps = motion.strikes.iter().map(|strike| (strike.time_s, strike.delta_v_at(s)));
        motion.contact().is_none().then(|| jumps.collect())
    }
    /// The accelerations of a place of a box along its axis, or along all three: what it feels but for the share of gravity there, which
    /// follows the attitude. None of other bodies, of which that share is all of gravity.
    #[must_use]
    pub fn accelerations(&self, place: &Place) -> Option<Vec<Excitation>> {
        let Course::Solid(motion) = &self.motion else { return None };
        Some(motion.moved(self.in_box(place), place.axis))
    }
    /// The acceleration that a place feels for ever after the motion.
    #[must_use]
    pub fn carried_m_s2(&self, place: &Place) -> f64 {
        match &self.motion {
            _ if !self.lies() => 0.0,
            Course::Solid(motion) => motion.carried_m_s2(self.in_box(place), place.axis),
            Course::Bar(_) | Course::BarOnFeet(_) | Course::Plate(_) | Course::PlateOnFeet(_) => self.gravity_m_s2(),
        }
    }
    /// The acceleration that a place will come to feel for ever, that is not among what it feels yet.
    #[must_use]
    pub fn weight_to_come_m_s2(&self) -> f64 {
        let flies = matches!(self.stop(), Stop::BouncedClear { .. });
        if flies || self.lies() { 0.0 } else { self.gravity_m_s2() }
    }
}

/// Directions along a plate, between which the change of its angular velocity is at most half a percent more than along one of them.
const DIRECTIONS: u32 = 16;
/// Below this share of the largest no shock in a direction half a right angle off is the largest between.
const NEAR_LARGEST: f64 = 0.85;
/// The same of no direction at all, where what is asked for is that much.
const NEAR_AT_ALL: f64 = 0.7;

/// One of the directions all over half a turn.
fn direction(k: u32) -> [f64; 2] {
    let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(k) / f64::from(DIRECTIONS));
    [cos, sin]
}

/// How the body turns.
impl Followed {
    /// The angular acceleration of a plate in one of its directions, in rad where what a place feels has m; none of other bodies.
    fn turned_in(&self, k: u32) -> Option<Excitation> {
        match &self.motion {
            Course::Plate(motion) => Some(motion.turned(direction(k))),
            Course::PlateOnFeet(motion) => Some(motion.turned(direction(k))),
            Course::Bar(_) | Course::BarOnFeet(_) | Course::Solid(_) => None,
        }
    }
    /// The angular acceleration, in rad where what a place feels has m: of a plate and of a box about several axes, one after the other.
    #[must_use]
    pub fn turned(&self) -> Box<dyn Iterator<Item = Excitation> + '_> {
        match &self.motion {
            Course::Bar(motion) => Box::new(std::iter::once_with(|| motion.turned())),
            Course::BarOnFeet(motion) => Box::new(motion.turned_by_contacts().into_iter()),
            Course::Plate(_) | Course::PlateOnFeet(_) => Box::new((0..DIRECTIONS).filter_map(|k| self.turned_in(k))),
            Course::Solid(motion) => Box::new(axes().map(|about| motion.turned_about(about))),
        }
    }
    /// The shocks about the axis that has the largest of all, where its `change` passes `above`; `shocks` takes them from an angular
    /// acceleration.
    pub fn hardest_turn<T>(
        &self,
        above: f64,
        shocks: impl Fn(&Excitation) -> T,
        change: impl Fn(&T) -> f64,
    ) -> Option<T> {
        let larger = |most: T, one: T| if change(&one) > change(&most) { one } else { most };
        match &self.motion {
            Course::Solid(motion) => {
                let mut found = None;
                let mut most = above;
                for (swing, about) in motion.swings() {
                    // Sums of the same terms, but for roundings.
                    if swing * (1.0 + 1e-9) < most {
                        break;
                    }
                    let about = shocks(&motion.turned_about(about));
                    if change(&about) > most {
                        most = change(&about);
                        found = Some(about);
                    }
                }
                found
            }
            // Directions half a right angle apart are looked at first: each shock is within cos 22.5° = 0.92 of what it is in one of
            // them. Others follow next to those that come near the largest.
            Course::Plate(_) | Course::PlateOnFeet(_) => {
                let in_direction = |k: u32| self.turned_in(k).map(|turned| shocks(&turned));
                let apart = DIRECTIONS / 4;
                let first: Vec<T> = (0..4).filter_map(|n| in_direction(n * apart)).collect();
                let changes: Vec<f64> = first.iter().map(&change).collect();
                let most = first.into_iter().reduce(larger)?;
                if change(&most) < NEAR_AT_ALL * above {
                    return None;
                }
                let largest = change(&most);
                let is_near = |n: usize| changes[n % 4] > NEAR_LARGEST * largest;
                let between = (0..DIRECTIONS).filter(|k| k % apart != 0);
                let near = between.filter(|k| [k / apart, k / apart + 1].into_iter().any(|n| is_near(n as usize)));
                Some(near.filter_map(in_direction).fold(most, larger)).filter(|most| change(most) > above)
            }
            Course::Bar(_) | Course::BarOnFeet(_) => {
                self.turned().map(|turned| shocks(&turned)).reduce(larger).filter(|most| change(most) > above)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DIRECTIONS, direction};

    /// Whatever a plate turns about, one of its directions is near it.
    #[test]
    fn directions_of_turning_lie_all_over() {
        for k in 0..720 {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 720.0).sin_cos();
            let along = (0..DIRECTIONS).map(direction).map(|[x, y]| (cos * x + sin * y).abs()).fold(0.0, f64::max);
            assert!(along > 0.995, "{k}: {along}");
        }
    }
}
