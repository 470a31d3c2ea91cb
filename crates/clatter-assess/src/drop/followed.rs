//! A drop as far as it was followed.

use clatter_flight::{Ahead, Model as Physics, Stop};

use super::{Model, SingleDrop};
use crate::course::{BlockMotion, Course};
use crate::engine::Spot;
use crate::{Error, Feet};

/// A drop as far as it was followed.
#[derive(Debug, Clone)]
pub(crate) struct Followed {
    pub(crate) drop: SingleDrop,
    pub(crate) motion: Course,
    pub(crate) precision: f64,
    /// Whether it was left while shocks that count may come.
    early: bool,
    /// Largest velocity shock of an end.
    pub(crate) largest_m_s: f64,
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
pub(crate) const PRECISION: f64 = 0.1;
/// How far a drop is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Until {
    /// Until it comes down after its clatter.
    Lands,
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
    /// A drop of a plate as one of a box of this thickness, at real tilt, followed until a time.
    ///
    /// # Errors
    /// [`Error::Contact`], and [`Error::Flight`] and [`Error::Bar`] for a box that is not followed so.
    pub(crate) fn as_block(drop: &SingleDrop, thickness_m: f64, until_s: f64) -> Result<Self, Error> {
        let Some(across) = &drop.across else { return Err(Error::Contact) };
        let block = drop.block_drop(across, thickness_m)?.with_time_limit_s(until_s)?;
        let motion = Course::Block(BlockMotion::new(&block, &drop.contacts_of_block()?)?);
        let largest_m_s = motion.largest_m_s();
        Ok(Self { drop: *drop, motion, precision: 0.0, early: false, largest_m_s })
    }

    /// Refuses corners of a plate that sink in deeper than the thickness of its file: those of its top, which are not followed, would touch as
    /// well.
    ///
    /// # Errors
    /// [`Error::Flight`].
    pub(crate) fn check_depth(&self) -> Result<(), Error> {
        let (Course::Block(motion), Some(across)) = (&self.motion, &self.drop.across) else { return Ok(()) };
        let (deepest_m, value) =
            (motion.deepest_m(), self.drop.contact_times_s().map_or(0.0, |[_, longest_s]| longest_s));
        let Some(most_m) = across.width.thickness_m.filter(|most_m| deepest_m > *most_m) else { return Ok(()) };
        let (bound, reason) = (value * most_m / deepest_m, "so that corners sink in by the thickness at most");
        Err(clatter_flight::Error::Bound { name: "contact time", value, bound, most: true, unit: "s", reason }.into())
    }

    /// The same motion as that of another drop, of which more may come.
    pub(crate) fn left_early(self, drop: &SingleDrop) -> Self {
        Self { drop: *drop, early: true, ..self }
    }

    /// Follows one drop until nothing later counts: until the energy that is left allows no velocity shock above `tolerance` of the
    /// largest times the restitution.
    ///
    /// # Errors
    /// [`Error::Contact`] for contacts whose time is not known; [`Error::Flight`] and [`Error::Bar`] for a drop that the model
    /// does not take.
    pub(crate) fn new(drop: &SingleDrop, model: Model, tolerance: f64) -> Result<Self, Error> {
        Self::until(drop, model, tolerance, Until::Over)
    }

    /// The same, left at a moment.
    ///
    /// # Errors
    /// As [`new`](Self::new); [`Error::Edge`] where an edge beyond feet comes down in the clatter of instant impacts.
    pub(crate) fn until(drop: &SingleDrop, model: Model, tolerance: f64, until: Until) -> Result<Self, Error> {
        let followed = Self::at_most(drop, model, tolerance, until, f64::INFINITY)?;
        match followed.edge_comes_down_s()? {
            Some(edge_s) => Self::at_most(drop, model, tolerance, until, edge_s),
            None => Ok(followed),
        }
    }

    /// The same, left at `most_s` by instant impacts where it is not over by then.
    fn at_most(drop: &SingleDrop, model: Model, tolerance: f64, until: Until, most_s: f64) -> Result<Self, Error> {
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
                    Until::Rebounded => lands && time_s > clatter_s && later <= LATE * largest,
                    Until::Past(most_s) => lands && time_s > clatter_s && (later <= LATE * largest || time_s > most_s),
                    Until::Over => false,
                }
        };
        let posture = drop.across.and_then(|across| across.posture);
        let (motion, precision) = if let (Some(across), Some(posture)) = (&drop.across, posture) {
            let Physics::Contacts(_) = model.physics(drop)? else { return Err(Error::PlateModel(model)) };
            let until_s = match until {
                Until::Lands => clatter_s,
                Until::Past(time_s) => time_s.max(clatter_s),
                Until::Rebounded | Until::Over => drop.settled_s(),
            };
            let block = drop.block_drop(across, posture.thickness_m)?.with_time_limit_s(until_s)?;
            let block = block.with_impact_limit(PRESSES_OF_BOX);
            let block = if until == Until::Rebounded { block.with_enough(LATE) } else { block };
            (Course::Block(BlockMotion::new(&block, &drop.contacts_of_block()?)?), 0.0)
        } else if let Some(across) = &drop.across {
            let Physics::Contacts(_) = model.physics(drop)? else { return Err(Error::PlateModel(model)) };
            let scene = drop.plate_scene(across)?.with_impact_limit(MOST_STRIKES);
            let motion = if let Some(Feet { inset_m, height_m }) = drop.feet {
                let enough = leaves(&is_over, given_back);
                let motion = scene.on_feet_until(inset_m, height_m, &drop.contacts()?, precision, enough)?;
                Course::PlateOnFeet(Box::new(motion))
            } else {
                let enough = leaves(&is_over, given_back);
                Course::Plate(Box::new(scene.own_contacts_until(&drop.contacts()?, precision, enough)?))
            };
            (motion, precision)
        } else if let (Some(feet), Physics::Contacts(_)) = (&drop.feet, model.physics(drop)?) {
            let scene = drop.scene_on(feet)?.with_impact_limit(MOST_STRIKES)?;
            let enough = leaves(&is_over, given_back);
            (Course::BarOnFeet(scene.fly_on_contacts(&drop.contacts()?, precision, enough)?), precision)
        } else {
            let scene = drop.scene()?.with_impact_limit(MOST_STRIKES)?.with_time_limit_s(most_s)?;
            let (enough, physics) = (leaves(&is_over, given_back), model.physics(drop)?);
            if drop.flat {
                (Course::Bar(scene.fly_flat(share)), 0.0)
            } else if drop.own_contacts.is_none() {
                (Course::Bar(scene.fly_until(physics, precision, enough)?), precision)
            } else {
                (Course::Bar(scene.fly_on_contacts(&drop.contacts()?, precision, enough)?), precision)
            }
        };
        let largest_m_s = motion.largest_m_s();
        let early = motion.later_m_s() > share * largest_m_s && !matches!(motion.stop(), Stop::AtRest { .. });
        Ok(Self { drop: *drop, motion, precision, early, largest_m_s })
    }

    pub(crate) fn is_early(&self) -> bool {
        self.early
    }
    /// Whether what comes after the motion was left is not even bounded.
    pub(crate) fn is_cut(&self) -> bool {
        self.motion.later_m_s() == f64::INFINITY
    }
    /// Whether the motion was left at a limit, though strikes that count may follow.
    pub(crate) fn is_given_up(&self) -> bool {
        let stop = self.motion.stop();
        matches!(stop, Stop::ImpactLimit { .. } | Stop::TimeLimit { .. } | Stop::EnergyLimit { .. })
    }
    /// Whether the product lies still at the end, or nothing that is left counts: then it carries its weight, on the mean over what it
    /// still bounces.
    fn lies(&self) -> bool {
        matches!(self.motion.stop(), Stop::AtRest { .. } | Stop::Enough { .. }) && !self.early
    }
    /// What a place feels for ever after the motion.
    pub(crate) fn carried_m_s2(&self, spot: &Spot) -> f64 {
        match &self.motion {
            _ if !self.lies() => 0.0,
            Course::Block(motion) => motion.carried_m_s2(self.drop.place_in_box(spot), spot.inside.axis),
            Course::Bar(_) | Course::BarOnFeet(_) | Course::Plate(_) | Course::PlateOnFeet(_) => {
                self.motion.gravity_m_s2()
            }
        }
    }
    /// What a place will come to feel for ever, that is not among what it feels yet.
    pub(crate) fn weight_to_come_m_s2(&self) -> f64 {
        let flies = matches!(self.motion.stop(), Stop::BouncedClear { .. });
        if flies || self.lies() { 0.0 } else { self.motion.gravity_m_s2() }
    }
    /// How long nothing has pressed as the motion was left.
    pub(crate) fn quiet_s(&self) -> f64 {
        (self.motion.stop().time_s() - self.motion.parted_s()).max(0.0)
    }
    /// Number, from 1, of the last strike that began by a time; contacts do nothing as they begin.
    pub(crate) fn impact_at(&self, time_s: f64) -> u64 {
        let instant = !self.motion.has_contacts();
        let begun = |touch_s: f64| touch_s < time_s || instant && touch_s <= time_s;
        self.motion.struck_s().partition_point(|s| begun(*s)).max(1) as u64
    }
}
