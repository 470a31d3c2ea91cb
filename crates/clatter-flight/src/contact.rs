//! Contacts that take time: a body whose points press into the ground by a law that is linear in pieces.
//!
//! Between two events (a point touches, is at its lowest, parts, presses again) all forces are linear in the motion, so that
//! a [phase] is a sum of known functions, evaluated and not stepped. Events are first zeros: in closed form where one point
//! presses without damping, else found by [`roots`](crate::roots), by bounds of the derivatives that hold from any moment on.
//!
//! # Lever arms
//! A phase has constant lever arms, and a constant acceleration by turning: those of the mean angle, weighed by its
//! forces. At its end the pose follows in exact geometry. The error of this is estimated in each phase, from the turn
//! of the body and the impulses on it; phases are cut where it would exceed the wanted precision. The unexplained
//! changes of the energy of the body are summed in [`Motion::energy_error`]; a flight ends where that sum is no longer
//! small, and one phase with as large a change is an error.
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
    /// the length (light ends would whirl it through large angles while they touch), and the contact time is so short that points sink
    /// in by a small part of the length, at most 0.1 length over the speed and 0.1 √(length/gravity), and so long that
    /// they sink in at all, 1e−10 length over the speed; [`Error::Energy`] where the motion does not keep its energy.
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
        enough: impl FnMut(&Ahead<N>) -> bool,
    ) -> Result<Motion<N>, Error> {
        within("precision", precision, 1e-8, 0.1, "in [1e-8, 0.1]")?;
        alike(contacts)?;
        // The first contact that is refused gives the error.
        contacts.iter().try_for_each(|contact| self.check(contact))?;
        let log = Log::new(self.time_limit_s(), self.impact_limit());
        Run::new(Planar::start(self), log, contacts, precision).run(enough)
    }

    fn check(&self, contact: &Contact) -> Result<(), Error> {
        let reach = self.body().reach();
        let (length, gyration) = (self.body().length_m().max(reach), self.body().gyration_m());
        // The bound itself is allowed.
        if gyration * (1.0 + 1e-12) < 0.05 * length {
            let (name, reason) = ("radius of gyration", "0.05 of the length for contacts that take time");
            let (value, bound) = (gyration, 0.05 * length);
            return Err(Error::Bound { name, value, bound, most: false, unit: "m", reason });
        }
        let of_speed = 0.1 * length / (self.speed_m_s() + reach * self.spin_rad_s().abs());
        let most = [of_speed, 0.1 * (length / self.gravity_m_s2()).sqrt()];
        let reasons = [
            "a tenth of length/speed, so that the ends sink in little",
            "a tenth of sqrt(length/gravity), so that the ends sink in little",
            "1e-10 length/speed, so that the ends sink in at all",
        ];
        check_time(contact.time_s(), most, 1e-10 * length / self.speed_m_s(), reasons)
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

/// Refuses a contact time above the bounds of speed and gravity, or below the shortest, for these reasons.
pub(crate) fn check_time(
    value: f64,
    [of_speed, of_gravity]: [f64; 2],
    shortest: f64,
    [by_speed, by_gravity, by_depth]: [&'static str; 3],
) -> Result<(), Error> {
    let refused =
        |bound, most, reason| Err(Error::Bound { name: "contact time", value, bound, most, unit: "s", reason });
    // The bound itself is allowed.
    let (longest, beyond) = (of_speed.min(of_gravity), 1.0 + 1e-12);
    if value > longest * beyond {
        return refused(longest, true, if of_speed < of_gravity { by_speed } else { by_gravity });
    }
    if value * beyond < shortest { refused(shortest, false, by_depth) } else { Ok(()) }
}
