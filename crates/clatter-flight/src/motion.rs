//! What became of a drop: the one way from a scene to its motion, whatever the model.

use clatter::{Error as Given, Excitation, Restitution};

use crate::Error;
use crate::contact::{Contact, Phases, Planar, Pose, Press};
use crate::flight::{Flight, Model, Pivot, Stop, Strike};
use crate::rigid;
use crate::scene::Scene;

/// The motion of a body from its first touch on.
#[derive(Debug, Clone)]
pub struct Motion<const N: usize = 2, P: Pose<N> = Planar<N>> {
    /// The strikes in order of time; at one instant, in the order in which a vanishing tilt makes them happen. With contacts that take
    /// time a strike is one press, from touch to parting; its time is that of the touch, its Δv what the force of that contact does in
    /// all, its velocities are those as it parts.
    pub strikes: Vec<Strike<N>>,
    /// The times in which one end of a bar lay on the ground; none of a plate, nor with contacts that take time.
    pub pivots: Vec<Pivot>,
    /// Beginning and end of each strike's contact; none of instant impacts.
    pub presses: Vec<Press>,
    /// Why it ends.
    pub stop: Stop,
    /// No strike after the motion changes the velocity of a contact point by more: by the energy that is left, its weight apart;
    /// infinite where that is not bounded.
    pub later_m_s: f64,
    /// What the energy of the body has changed by without reason, summed without regard to sign, over that of the body at the first
    /// touch: at most 1 %, where [`Stop::EnergyLimit`] ends the motion. 0 of instant impacts.
    pub energy_error: f64,
    pub(crate) model: Model,
    pub(crate) course: Course<N, P>,
}

/// A motion of a plate, by instant impacts at its four corners or with contacts that take time.
pub type PlateMotion = Motion<4, crate::contact::Level>;

/// A motion of a plate on feet, with contacts that take time: the feet are its first four points, the corners beyond them the others.
pub type FeetMotion = Motion<8, crate::contact::Level<8>>;

/// What is between the strikes.
#[derive(Debug, Clone)]
pub(crate) enum Course<const N: usize, P: Pose<N>> {
    Impacts(P::Impacts),
    Contacts(Phases<N, P>),
}

/// What is known and what may still come, as asked while a motion is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ahead<const N: usize = 2> {
    /// Now; of instant impacts the last strike.
    pub time_s: f64,
    /// Strikes of each contact point so far.
    pub struck: [usize; N],
    /// Largest velocity shock of a contact point so far.
    pub largest_m_s: f64,
    /// No later strike that presses alone changes the velocity of a contact point by more, by the energy that is left, its weight
    /// apart; and none approaches at more than half of it.
    pub most_m_s: f64,
    /// Whether a strike is about to begin; else one ends.
    pub lands: bool,
}

/// Precision of contacts that nobody asks for.
const PRECISION: f64 = 1e-4;

impl<const N: usize> Scene<N> {
    /// The motion with a contact of its own at each point, as far as it is needed: as
    /// [`own_contacts_until`](Self::own_contacts_until), where no strike after the motion gives back more than the liveliest contact.
    ///
    /// # Errors
    /// As [`own_contacts_until`](Self::own_contacts_until).
    pub fn fly_on_contacts(
        &self,
        contacts: &[Contact; N],
        precision: f64,
        enough: impl FnMut(&Ahead<N>) -> bool,
    ) -> Result<Motion<N>, Error> {
        let most_e = contacts.iter().fold(0.0_f64, |most, contact| most.max(contact.restitution()));
        Ok(self.own_contacts_until(contacts, precision, enough)?.giving_back(0.5 * (1.0 + most_e)))
    }
}

impl Scene {
    /// The motion by a model, until nothing more happens or a limit of the scene, contacts that take time to a precision of 1e−4.
    ///
    /// # Errors
    /// As [`fly_until`](Self::fly_until).
    pub fn fly(&self, model: Model) -> Result<Motion, Error> {
        self.fly_until(model, PRECISION, |_| false)
    }

    /// The same as far as it is needed. `enough` ends it: asked before each strike but the first where impacts are instant, before each
    /// event at which no point loads where contacts take time. `precision` is that of contacts: instant impacts know none.
    ///
    /// # Errors
    /// Of contacts as [`contacts_until`](Self::contacts_until), which has their accuracy too; of instant impacts none.
    ///
    /// # Examples
    /// ```
    /// use clatter_flight::{Profile, Model, Scene};
    /// let scene = Scene::new(Profile::new(0.14, 0.05)?, 0.5, 2.0, 5.0, 9.81)?;
    /// let three = scene.fly_until(Model::FiniteTilt, 1e-4, |ahead| ahead.struck == [2, 1])?;
    /// assert_eq!(three.strikes, scene.with_impact_limit(3)?.fly(Model::FiniteTilt)?.strikes);
    /// # Ok::<(), clatter_flight::Error>(())
    /// ```
    pub fn fly_until(&self, model: Model, precision: f64, enough: impl FnMut(&Ahead) -> bool) -> Result<Motion, Error> {
        let Model::Contacts(contact) = model else {
            return Ok(self.after(model, rigid::strikes(self, model, None, enough)));
        };
        Ok(self.contacts_until(&contact, precision, enough)?.giving_back(self.given_back()))
    }

    /// The same by instant impacts at any tilt, of a body whose ends rebound differently: `restitution` of ends a and b counts in place
    /// of that of the scene. Beyond the time limit of the scene no strike is looked for: the motion ends with [`Stop::TimeLimit`] also
    /// where none would follow.
    ///
    /// # Errors
    /// [`Error::Restitution`](Given::Restitution) unless both are in [0, 1].
    pub fn fly_by_ends(&self, restitution: [f64; 2], enough: impl FnMut(&Ahead) -> bool) -> Result<Motion, Given> {
        for e in restitution {
            Restitution::new(e)?;
        }
        let model = Model::FiniteTilt;
        Ok(self.after(model, rigid::strikes(self, model, Some(restitution), enough)))
    }

    /// The motion of a body whose ends land as one, whatever the tilt, and bounce so: each strike changes the velocity of every place
    /// by 1 + e times its approach. It ends at rest once all that follows is below `share` of the first.
    #[must_use]
    pub fn fly_flat(&self, share: f64) -> Motion {
        let (e, speed, g) = (self.e(), self.speed_m_s(), self.gravity_m_s2());
        let (mut strikes, mut time_s, mut approach) = (Vec::new(), 0.0, speed);
        while approach > share * speed && strikes.len() < self.impact_limit() {
            strikes.push(Strike {
                number: strikes.len() as u64 + 1,
                point: 0,
                time_s,
                approach_m_s: -approach,
                delta_v_m_s: [(1.0 + e) * approach; 2],
                height_m: [0.0; 2],
                velocity_m_s: [e * approach; 2],
                tilt_rad: 0.0,
                spin_rad_s: 0.0,
            });
            approach *= e;
            time_s += 2.0 * approach / g;
            if g == 0.0 {
                break;
            }
        }
        let later_m_s = if g == 0.0 { 0.0 } else { (1.0 + e) * approach };
        let stop = match strikes.last() {
            Some(last) if g == 0.0 => Stop::BouncedClear { time_s: last.time_s },
            _ if strikes.len() == self.impact_limit() => Stop::ImpactLimit { time_s },
            // All that are left together, each e times as long as the one before.
            _ => Stop::AtRest {
                time_s: time_s + 2.0 * e * approach / (g * (1.0 - e)),
                time_bound_s: 0.0,
                shock_bound_m_s: later_m_s,
            },
        };
        Motion { later_m_s, ..self.after(Model::Ballistic, Flight { strikes, pivots: Vec::new(), stop }) }
    }

    /// What a strike changes a velocity by over twice its approach.
    fn given_back(&self) -> f64 {
        0.5 * (1.0 + self.e())
    }

    fn after(&self, model: Model, flight: Flight) -> Motion {
        let Flight { strikes, pivots, stop } = flight;
        let last = || strikes.last().map(|strike| self.given_back() * self.most_m_s(model, strike));
        let later_m_s = match stop {
            Stop::AtRest { shock_bound_m_s, .. } => shock_bound_m_s,
            Stop::BouncedClear { .. } => 0.0,
            Stop::TurnedOver { .. } => f64::INFINITY,
            _ => last().unwrap_or(f64::INFINITY),
        };
        let course = Course::Impacts(*self);
        Motion { strikes, pivots, presses: Vec::new(), stop, later_m_s, energy_error: 0.0, model, course }
    }
}

impl<const N: usize, P: Pose<N>> Motion<N, P> {
    /// The model that it is by.
    #[must_use]
    pub fn model(&self) -> Model {
        self.model
    }
    /// The contacts, where they take time: that of the first point, where each has its own.
    #[must_use]
    pub fn contact(&self) -> Option<Contact> {
        if let Model::Contacts(contact) = self.model { Some(contact) } else { None }
    }
    /// That of each point, where they take time.
    #[must_use]
    pub fn contacts(&self) -> Option<[Contact; N]> {
        if let Course::Contacts(phases) = &self.course { Some(phases.contacts) } else { None }
    }
    /// Largest velocity shock of a contact point.
    #[must_use]
    pub fn largest_m_s(&self) -> f64 {
        self.strikes.iter().flat_map(|s| s.delta_v_m_s).fold(0.0, |most, v| most.max(v.abs()))
    }
    /// Gravity as the model knows it: none by the map.
    #[must_use]
    pub fn gravity_m_s2(&self) -> f64 {
        match &self.course {
            Course::Impacts(_) if self.model == Model::Map => 0.0,
            Course::Impacts(impacts) => P::gravity_of(impacts),
            Course::Contacts(phases) => phases.end.gravity(),
        }
    }
    /// When the last strike ended; infinite where it presses still.
    #[must_use]
    pub fn parted_s(&self) -> f64 {
        let struck = self.strikes.last().filter(|_| self.presses.is_empty()).map_or(0.0, |strike| strike.time_s);
        self.presses.iter().fold(struck, |last, press| last.max(press.until_s))
    }
}

impl<const N: usize, P: Pose<N>> Motion<N, P> {
    /// Where no strike after the motion gives back more than this share of what it may take.
    pub(crate) fn giving_back(self, share: f64) -> Self {
        let bounded = matches!(self.stop, Stop::AtRest { .. } | Stop::BouncedClear { .. });
        let later_m_s = if bounded { self.later_m_s } else { share * self.later_m_s };
        Self { later_m_s, ..self }
    }
}

impl Motion {
    /// What position `s` in [−1, 1] of a bar (−1 is end a) feels: its acceleration above free fall.
    ///
    /// # Accuracy
    /// Of instant impacts exact for strikes and free flight; while the bar turns about an end that lies, the mean acceleration. Of
    /// contacts it adds up to the motion: what lever arms kept through a phase leave out is spread over it, damped vibrations are
    /// straight lines that miss them by the precision of the motion over the largest acceleration so far, and what is left of the
    /// motion as it ends at rest is a velocity shock then. Where the bar turns by more than a right angle in one flight, nothing is felt of
    /// that turn: the axis of a part has turned with it.
    ///
    /// # Examples
    /// ```
    /// use clatter_flight::{Profile, Model, Scene};
    /// let motion = Scene::new(Profile::new(0.14, 0.04)?, 0.3, 4.43, 5.0, 9.81)?.fly(Model::FiniteTilt)?;
    /// assert_eq!(motion.felt(0.5).section(0).delta_v, motion.strikes[0].delta_v_at(0.5));
    /// # Ok::<(), clatter_flight::Error>(())
    /// ```
    #[must_use]
    pub fn felt(&self, s: f64) -> Excitation {
        match &self.course {
            Course::Impacts(scene) => self.felt_of_impacts(scene, s),
            Course::Contacts(phases) => phases.felt(phases.end.body.place(s)),
        }
    }
    /// The angular acceleration of the bar, in rad where [`felt`](Self::felt) has m; of instant impacts a shock at each strike.
    #[must_use]
    pub fn turned(&self) -> Excitation {
        match &self.course {
            Course::Impacts(scene) => self.turned_by_impacts(scene),
            Course::Contacts(phases) => phases.turned(),
        }
    }
}
