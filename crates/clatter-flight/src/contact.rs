//! Contacts that take time: a body whose points press into the ground by a law that is linear in pieces.
//!
//! Between two events (a point touches, is at its lowest, parts, presses again) all forces are linear in the motion, so that
//! a [phase] is a sum of known functions, evaluated and not stepped. Events are first zeros: in closed form where one point
//! presses without damping, else found by [`roots`](crate::roots), by bounds of the derivatives that hold from any moment on.
//!
//! # Lever arms
//! A phase has constant lever arms, and a constant acceleration by turning: those of the mean angle, weighed by its
//! forces. At its end the pose follows in exact geometry. The error of this is estimated in each phase, from the turn
//! of the body and the impulses on it; phases are cut where it would exceed the wanted precision, or where the effect of a
//! force would change by some times as much: accelerations follow lever arms of one moment. The unexplained
//! changes of the energy of the body are summed in [`Motion::energy_error`]; a flight ends where that sum is no longer
//! small, and one phase with as large a change is an error.
//!
//! # Soft contacts
//! However long contacts are, that alone is no error: points may sink in by half of the length of the body, or by its
//! thickness if that is more. A point that goes deeper ends the flight, and the longest contact time that is answered is
//! found by trying others.
//!
//! # A point in its dent
//! A hysteretic contact that parts below the ground leaves the ground of that contact where it was. It touches there again, as a
//! new press with the lever arm that it then has, until it has been above the ground.
//!
//! A point that alone presses and rings on its line of unloading by less than its weight, or more slowly than the
//! precision times the largest approach, is laid down: it stays where it is until its force falls to zero or another
//! point strikes. With e = 0 the line of unloading is upright, and every point lies at its largest depth.
//!
//! # Rest
//! The flight is at rest where the remaining energy allows no point to be faster than the precision times the largest
//! approach, or no more force than some times the weight. [`Stop::AtRest`](crate::Stop::AtRest) bounds the later
//! ringing.

mod eigen;
mod excitation;
mod law;
mod level;
mod mode;
mod phase;
mod planar;
mod pose;
mod rest;
mod run;
mod touch;

pub use law::{Contact, ContactLaw};

use crate::Error;
use crate::flight::Log;
use crate::motion::{Ahead, Course, Motion};
use crate::scene::{Scene, within};
use phase::Phase;

pub(crate) use eigen::eigen;
pub(crate) use level::Level;
pub(crate) use planar::Planar;
pub(crate) use pose::{Pose, solve};
pub(crate) use run::Run;

/// The times of contact of a strike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Press {
    /// Time of touching.
    pub from_s: f64,
    /// Time of parting; infinite where the point still presses at the end of the flight.
    pub until_s: f64,
}

/// The motion of a body with contacts that take time, between its strikes.
#[derive(Debug, Clone)]
pub(crate) struct Phases<const N: usize, P: Pose<N>> {
    precision: f64,
    /// Contact of each point.
    pub(crate) contacts: [Contact; N],
    /// End of the motion, and whether it is at rest.
    end_s: f64,
    rests: bool,
    list: Vec<(f64, Phase<P, N>)>,
    /// The body just before the end of the motion, and at its end, at rest without the rest of its motion.
    last: P,
    pub(crate) end: P,
    /// The forces on it if it is at rest.
    resting: [f64; N],
}

/// The body at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample<const N: usize = 2> {
    /// Heights of all contact points; negative where one is pressed in.
    pub height_m: [f64; N],
    /// Vertical velocities of all points.
    pub velocity_m_s: [f64; N],
    /// Vertical accelerations of all points, gravity included.
    pub acceleration_m_s2: [f64; N],
    /// Forces of the ground on all points over the mass of the body.
    pub force_per_mass_m_s2: [f64; N],
    /// Tilt, in (−π, π] at each touch; it goes on from there where the body turns.
    pub tilt_rad: f64,
    /// Angular velocity.
    pub spin_rad_s: f64,
}

impl Sample<4> {
    /// Returns the sample of a body with these points alone; `None` for one with others.
    fn with_points<const N: usize>(&self) -> Option<Sample<N>> {
        let of = |all: &[f64; 4]| all[..].try_into().ok();
        Some(Sample {
            height_m: of(&self.height_m)?,
            velocity_m_s: of(&self.velocity_m_s)?,
            acceleration_m_s2: of(&self.acceleration_m_s2)?,
            force_per_mass_m_s2: of(&self.force_per_mass_m_s2)?,
            tilt_rad: self.tilt_rad,
            spin_rad_s: self.spin_rad_s,
        })
    }
}

impl<const N: usize, P: Pose<N>> Phases<N, P> {
    /// Returns the duration of the longest lone contact.
    pub(crate) fn longest_s(&self) -> f64 {
        self.contacts.iter().fold(0.0, |longest, contact| longest.max(contact.time_s()))
    }
    /// Returns the duration of the shortest lone contact that presses in a phase; in flight that of the longest of all.
    fn contact_s(&self, phase: &Phase<P, N>) -> f64 {
        let pressing = (0..N).filter(|&i| phase.presses(i)).map(|i| self.contacts[i].time_s());
        pressing.reduce(f64::min).unwrap_or_else(|| self.longest_s())
    }
    pub(crate) fn sample(&self, time_s: f64) -> Sample<N> {
        if self.rests && time_s >= self.end_s {
            return Sample {
                height_m: self.end.points().0,
                velocity_m_s: [0.0; N],
                acceleration_m_s2: [0.0; N],
                force_per_mass_m_s2: self.resting,
                tilt_rad: self.end.angles()[0],
                spin_rad_s: 0.0,
            };
        }
        let n = self.list.partition_point(|(from, _)| *from <= time_s).saturating_sub(1);
        let (from, phase) = &self.list[n];
        phase.sample((time_s - from).max(0.0))
    }
}

impl<const N: usize, P: Pose<N>> Motion<N, P> {
    /// Returns the body at a time since the first touch; beyond the end of the motion it stays at rest, or goes on as
    /// it was. `None` for instant impacts of a bar.
    #[must_use]
    pub fn sample(&self, time_s: f64) -> Option<Sample<N>> {
        match &self.course {
            Course::Impacts(impacts) => P::sample_of(impacts, time_s),
            Course::Contacts(phases) => Some(phases.sample(time_s)),
        }
    }
    /// Returns the begin of each phase of contacts that take time, in order from 0. Within a phase every force is
    /// smooth.
    pub fn phases_s(&self) -> impl Iterator<Item = f64> + '_ {
        self.phases().into_iter().flat_map(|phases| phases.list.iter().map(|(from, _)| *from))
    }
    pub(crate) fn phases(&self) -> Option<&Phases<N, P>> {
        if let Course::Contacts(phases) = &self.course { Some(phases) } else { None }
    }
}

impl<const N: usize> Scene<N> {
    /// Returns the motion of a body with any number of contact points, all of which take time; that of a bar is
    /// [`fly_until`](Scene::fly_until). `enough` is called before each event at which no point loads, and ends the
    /// motion there.
    ///
    /// # Accuracy
    /// Relative to the largest approach, each contact of a point leaves the body with velocities that are wrong by less
    /// than `precision`, and motions slower than `precision` are laid down.
    ///
    /// # Errors
    /// [`Error::Given`] unless the precision is in [1e−8, 0.1]; [`Error::Restitution`] unless the contact has the restitution of the
    /// drop; [`Error::Bound`] unless the radius of gyration is at least 0.05 of
    /// the length (light ends would whirl it through large angles while they touch), and the contact time is so short that no point sinks
    /// in by more than half of the length, or than the thickness if that is more, at most 0.1 √(length/gravity), and so long that they
    /// sink in at all, 1e−10 length over the speed; [`Error::Energy`] where the motion does not keep its energy.
    pub fn contacts_until(
        &self,
        contact: &Contact,
        precision: f64,
        enough: impl FnMut(&Ahead<N>) -> bool,
    ) -> Result<Motion<N>, Error> {
        let (of_contact, scene) = (contact.restitution(), self.e());
        within("precision", precision, 1e-8, 0.1, "in [1e-8, 0.1]")?;
        if of_contact.to_bits() != scene.to_bits() {
            return Err(Error::Restitution { contact: of_contact, scene });
        }
        self.own_contacts_until(&[*contact; N], precision, enough)
    }

    /// Returns the same motion of a body with a contact of its own at each point: their restitutions count in place of
    /// that of the scene.
    ///
    /// # Accuracy
    /// It is that of [`contacts_until`](Self::contacts_until), except that the largest approach may be that of another
    /// point: softer contacts are as exact as the stiffest.
    ///
    /// # Errors
    /// As [`contacts_until`](Self::contacts_until), by each of the contacts; [`Error::Laws`] unless all are hysteretic, where they differ.
    ///
    /// # Examples
    /// Without gravity end a, which touches first, leaves with its own restitution while end b is up.
    /// ```
    /// use clatter_flight::{Profile, Contact, ContactLaw, Scene};
    /// let scene = Scene::new(Profile::new(0.14, 0.05)?, 0.5, 2.0, 20.0, 0.0)?;
    /// let [soft, hard] = [(0.1, 1e-3), (0.5, 2e-4)].map(|(e, time_s)| Contact::new(ContactLaw::Hysteretic, e, time_s));
    /// let motion = scene.own_contacts_until(&[soft?, hard?], 1e-6, |_| false)?;
    /// let first = motion.strikes[0];
    /// assert!((first.velocity_m_s[0] + 0.1 * first.approach_m_s).abs() < 1e-2 * 2.0);
    /// # Ok::<(), clatter_flight::Error>(())
    /// ```
    pub fn own_contacts_until(
        &self,
        contacts: &[Contact; N],
        precision: f64,
        mut enough: impl FnMut(&Ahead<N>) -> bool,
    ) -> Result<Motion<N>, Error> {
        within("precision", precision, 1e-8, 0.1, "in [1e-8, 0.1]")?;
        alike(contacts)?;
        // The first contact that is refused gives the error.
        contacts.iter().try_for_each(|contact| self.check(contact))?;
        let reasons = [
            "so that ends sink in by half of the length at most",
            "so that ends sink in by the thickness at most",
            "a tenth of sqrt(length/gravity), so that the ends sink in little by the weight alone",
        ];
        let body = self.body();
        let allowed = Allowed::new(body.length_m().max(body.reach()), body.height_m(), self.gravity_m_s2(), reasons);
        allowed.followed(contacts, |contacts, deepest_m| {
            let log = Log::new(self.time_limit_s(), self.impact_limit());
            Run::new(Planar::start(self), log, contacts, precision, deepest_m).run(&mut enough)
        })
    }

    fn check(&self, contact: &Contact) -> Result<(), Error> {
        let (length, gyration) = (self.body().length_m().max(self.body().reach()), self.body().gyration_m());
        // The bound itself is allowed.
        if gyration * (1.0 + 1e-12) < 0.05 * length {
            let (name, reason) = ("radius of gyration", "0.05 of the length for contacts that take time");
            let (value, bound) = (gyration, 0.05 * length);
            return Err(Error::Bound { name, value, bound, most: false, unit: "m", reason });
        }
        let reason = "1e-10 length/speed, so that the ends sink in at all";
        check_shortest(contact.time_s(), 1e-10 * length / self.speed_m_s(), reason)
    }
}

/// Refuses contacts that differ, unless all are hysteretic: dashpots with different delays couple the modes of a phase,
/// which is then no sum of known functions.
pub(crate) fn alike(contacts: &[Contact]) -> Result<(), Error> {
    let hysteretic = |contact: &Contact| contact.law().leaves_a_dent();
    if contacts.iter().all(hysteretic) || contacts.windows(2).all(|two| two[0] == two[1]) {
        Ok(())
    } else {
        Err(Error::Laws)
    }
}

/// The longest contact time over √(length/gravity). Up to there what a body at rest may still ring with, four times the energy of its weight
/// suddenly applied, is some percent of that of a fall from half of its length.
const WEIGHS: f64 = 0.1;

/// Refuses a contact time so short that nothing sinks in.
pub(crate) fn check_shortest(value: f64, bound: f64, reason: &'static str) -> Result<(), Error> {
    // The bound itself is allowed.
    if value * (1.0 + 1e-12) < bound {
        return Err(Error::Bound { name: "contact time", value, bound, most: false, unit: "s", reason });
    }
    Ok(())
}

/// A motion that is not answered.
#[derive(Debug)]
pub(crate) enum Refused {
    /// A point sinks in too deep.
    Deep(Depth),
    /// Another error.
    Other(Error),
}

impl From<Error> for Refused {
    fn from(error: Error) -> Self {
        Self::Other(error)
    }
}

/// How deep a point sinks in, over what is allowed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Depth {
    point: usize,
    over_allowed: f64,
}

/// The share of its length by which a body may sink in, whose thickness is not known or less. No body is thicker than it is long, and
/// its center of mass is half of the thickness above the bottom: deeper, it would be in the ground whatever the body is.
const DEEPEST: f64 = 0.5;
/// The largest contact time that is answered is told to this share, after so many flights at most.
const TOLD: f64 = 5e-3;
const TRIED: usize = 40;

/// How deep the points of a body may sink in, and how long contacts may take by its weight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Allowed {
    deepest_m: f64,
    by_depth: &'static str,
    longest_s: f64,
    by_weight: &'static str,
}

impl Allowed {
    /// Returns the depth allowed to a body: half of its length, or all of its thickness if that is more; and the longest contact. The
    /// reasons say so.
    pub(crate) fn new(
        length_m: f64,
        thickness_m: f64,
        gravity_m_s2: f64,
        [by_length, by_thickness, by_weight]: [&'static str; 3],
    ) -> Self {
        let half_m = DEEPEST * length_m;
        let by_depth = if thickness_m > half_m { by_thickness } else { by_length };
        let longest_s = WEIGHS * (length_m / gravity_m_s2).sqrt();
        Self { deepest_m: half_m.max(thickness_m), by_depth, longest_s, by_weight }
    }

    /// Returns the motion by these contacts.
    ///
    /// # Errors
    /// [`Error::Bound`] with the largest contact time that is answered, of those contacts that take as long as that of the point which sinks
    /// in too deep, or as the longest by the weight.
    pub(crate) fn followed<const N: usize, T>(
        &self,
        contacts: &[Contact; N],
        mut fly: impl FnMut(&[Contact; N], f64) -> Result<T, Refused>,
    ) -> Result<T, Error> {
        let refused =
            |value, bound, reason| Error::Bound { name: "contact time", value, bound, most: true, unit: "s", reason };
        // The bound itself is allowed.
        let too_long = contacts.iter().map(Contact::time_s).find(|time_s| *time_s > self.longest_s * (1.0 + 1e-12));
        let light = contacts.map(|contact| {
            let is_longer = too_long.is_some() && contact.time_s() > self.longest_s;
            if is_longer { contact.lasting(self.longest_s) } else { contact }
        });
        let depth = match (fly(&light, self.deepest_m), too_long) {
            (Err(Refused::Deep(depth)), _) => depth,
            (Err(Refused::Other(error)), None) => return Err(error),
            (Ok(motion), None) => return Ok(motion),
            (_, Some(value)) => return Err(refused(value, self.longest_s, self.by_weight)),
        };
        let (value, from_s) = (contacts[depth.point].time_s(), light[depth.point].time_s());
        Err(refused(value, self.longest_answered(&light, from_s, depth.over_allowed, fly), self.by_depth))
    }

    /// Returns the longest that those contacts may take which take so long, where one sinks in by so much over what is allowed.
    fn longest_answered<const N: usize, T>(
        &self,
        contacts: &[Contact; N],
        from_s: f64,
        mut over: f64,
        mut fly: impl FnMut(&[Contact; N], f64) -> Result<T, Refused>,
    ) -> f64 {
        let (mut answered, mut refused) = (0.0, from_s);
        for _ in 0..TRIED {
            if refused <= answered * (1.0 + TOLD) {
                break;
            }
            // Until one is answered the depth is taken to be in proportion to the contact time.
            let next =
                if answered > 0.0 { (answered * refused).sqrt() } else { refused * (0.99 / over).clamp(1e-6, 0.9) };
            let last = |contact: Contact| {
                if contact.time_s().to_bits() == from_s.to_bits() { contact.lasting(next) } else { contact }
            };
            match fly(&contacts.map(last), self.deepest_m) {
                Ok(_) => answered = next,
                Err(Refused::Deep(depth)) => (refused, over) = (next, depth.over_allowed),
                Err(Refused::Other(_)) => refused = next,
            }
        }
        if answered > 0.0 { answered } else { refused }
    }
}
