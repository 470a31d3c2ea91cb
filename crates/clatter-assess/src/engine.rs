//! The one way from a drop to an answer.
//!
//! [`answer`] follows a drop by a model, takes the acceleration at the place of the part, and gives the largest value of one limited
//! quantity. Commands that need many answers of one drop keep the drop between them; nothing else is different.

mod later;

use std::f64::consts::FRAC_PI_2;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use clatter::{Bar, End, EndPeaks, Excitation, Start};
use clatter_flight::{Drop, Followed, PRECISION, Place, Until};
use clatter_shock::{Extreme, Hit, Moment, Peaked, Pulses, Response, State, Stop, Suspension};

use crate::AtStop;
use crate::history::{SHORT, pulses};
use crate::model::{check_drop, follow};
use crate::shock::{Shock, crest_at, largest_at, largest_turn, samples, shocks_at};
use clatter_product::{DataFault, Error, Limit, Model, ResponsePeak, Source, Unit};
pub(crate) use later::in_swings;

/// A part at one place of the product.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// The place of the part, and the axis along which it moves.
    pub place: Place,
    /// The suspension; none where it is mounted rigidly.
    pub suspension: Option<Suspension>,
}

impl Part {
    /// Returns a part of a bar, so far from its middle towards end b.
    #[must_use]
    pub fn new(position_m: f64, suspension: Option<Suspension>) -> Self {
        Self::at(Place::flat([position_m, 0.0]), suspension)
    }
    /// Returns a part at a place.
    #[must_use]
    pub fn at(place: Place, suspension: Option<Suspension>) -> Self {
        Self { place, suspension }
    }
    /// Returns its place, along and across the product.
    pub(crate) fn at_m(&self) -> [f64; 2] {
        self.place.plan_m()
    }
}

/// The demand of a drop on a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// The largest value of the quantity; of a damage boundary the velocity change or the acceleration, whichever leaves more
    /// room.
    pub value: f64,
    /// The allowed value of the quantity.
    pub allowed: f64,
    /// Their unit.
    pub unit: Unit,
    /// The time since the first touch.
    pub time_s: f64,
    /// The strike that does it, or that the peak follows; from 1.
    pub impact: u64,
    /// The error bound of the value for the part of its own motion that the model leaves out, in the unit of the value: what lever arms
    /// kept through a phase get wrong, and what later strikes could still do. It says nothing of the physics that the model lacks.
    pub off_by: f64,
}

impl Answer {
    /// Returns the value over the allowed one: beyond 1 the limit is exceeded.
    #[must_use]
    pub fn utilization(&self) -> f64 {
        self.value / self.allowed
    }
    /// Returns how far off the value may be, as a share of it; infinite where the value is 0 and may be off.
    #[must_use]
    pub fn error(&self) -> f64 {
        if self.off_by > 0.0 { self.off_by / self.value } else { 0.0 }
    }
}

/// Returns the demand of one drop for one limit of a part: the largest value of the quantity over the whole motion.
///
/// `tolerance` is how exact the answer is for its model: how long a phase may keep its lever arms, how finely damped
/// vibrations are cut, and when nothing later can count.
///
/// # Validity
/// The part is light and linear; the product is rigid. Instant impacts act on a suspended part as velocity shocks, and the acceleration of
/// a part mounted rigidly is that of half-sines of the contact time. From when the product lies still, the weight of a part on it acts on
/// the part.
///
/// # Accuracy
/// The error is bounded by [`Answer::off_by`]; it is within `tolerance` of independent integrations until the product lands again (tests).
/// The error of each strike is then multiplied by the next ones, and the error is the difference to a drop followed ten times as exactly.
///
/// # Errors
/// [`Error::Tolerance`]; [`Error::Contact`] where the contact time is needed and not known; [`Error::Flight`], [`Error::Bar`] and
/// [`Error::Shock`] for what a model does not take; [`Error::Data`] for a limit that a part mounted rigidly does not have;
/// [`Error::Setting`] for a place outside of the product, a contact time that is none, and a limit that is not positive;
/// [`Error::Unfinished`] for a motion that was given up before nothing later counts.
///
/// # Examples
/// The end of the paper's reference bar (q = ½, e = 0.3) has a velocity change of 2.145 v₀ at most, by instant impacts without gravity:
/// ```
/// use clatter_assess::{Part, answer};
/// use clatter_product::{Body, Drop, Limit, LimitKind, Model};
/// let drop = Drop { gravity_m_s2: 0.0, ..Drop::new(Body::new(0.15, 0.15 / 12_f64.sqrt())?, 4.0, 0.05, 0.3) };
/// let part = Part::new(0.075, None);
/// let asked = answer(&drop, &part, &Limit::new(LimitKind::VelocityChange, 9.0), Model::Map, 0.01)?;
/// assert!((asked.value - 4.0 * 2.145).abs() < 1e-12 && asked.impact == 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn answer(drop: &Drop, part: &Part, limit: &Limit, model: Model, tolerance: f64) -> Result<Answer, Error> {
    if !(1e-6..=0.5).contains(&tolerance) {
        return Err(Error::Tolerance(tolerance));
    }
    check_drop(drop, &part.place)?;
    limit.check()?;
    if part.suspension.is_none() && limit.kind.needs_suspension() {
        return Err(DataFault::Hard { field: limit.kind.key() }.into());
    }
    if drop.body.is_wide() && model != Model::Compliant {
        return Err(Error::PlateModel(model));
    }
    if model != Model::Compliant && !drop.own_contacts.is_none() {
        return Err(Error::OwnContacts(model));
    }
    if model < Model::Map {
        return closed_form(drop, part, limit, model);
    }
    Ok(once(drop, part, limit, model, tolerance)?.with_what_strikes_multiply(drop, part, limit, model, tolerance))
}

/// Differences are reported so many times as large as they are: the factor of the grid convergence index (Roache 1994) for three runs
/// and more.
const SAFETY: f64 = 1.25;
/// A box that differs a little is followed so far past the peak.
const PAST_PEAK: f64 = 1.25;
/// A drop is followed again by so much more exactly.
const FINER: f64 = 0.1;
/// Tilts are below this.
const UPRIGHT: f64 = FRAC_PI_2 * (1.0 - 1e-9);

impl Answer {
    /// Each strike multiplies what the ones before it got wrong, by more than a bound could cover. A drop whose peak comes after the
    /// second is followed again: more exactly, and with a tilt or with shocks that differ by what lever arms may get wrong. The
    /// largest difference is reported.
    pub(crate) fn with_what_strikes_multiply(
        self,
        drop: &Drop,
        part: &Part,
        limit: &Limit,
        model: Model,
        tolerance: f64,
    ) -> Self {
        // So does each hit of a stop.
        let hits = limit.is_response() && part.suspension.is_some_and(|part| part.stop().is_some());
        if model != Model::Compliant || self.impact <= 2 && !hits {
            return self;
        }
        // Where a drop next to this one is not answered, nothing tells how far off this one is.
        let off = |other: &Drop, tolerance: f64| {
            // The next landing of a box is another question: the energy that is left answers it.
            let until = if drop.is_solid() { Until::Past(PAST_PEAK * self.time_s) } else { Until::Over };
            let other = follow(other, model, tolerance, until).and_then(|other| of_followed(&other, part, limit));
            // The values are shares of the allowed one: of a damage boundary one may be a change of velocity, the other an acceleration.
            other.map_or(f64::INFINITY, |other| (other.utilization() - self.utilization()).abs() * self.allowed)
        };
        // A box is followed as exactly for any tolerance.
        let mut most = if drop.is_solid() { 0.0 } else { off(drop, FINER * tolerance) };
        for off_by in [-KEPT_ARMS, KEPT_ARMS].map(|arms| arms * PRECISION * tolerance) {
            let bounces = drop.with_restitutions(|e| (e + off_by * (1.0 + e)).clamp(0.0, 1.0));
            most = most.max(off(&bounces, tolerance));
            let tilt_rad = (drop.tilt_rad * (1.0 + off_by)).min(UPRIGHT);
            if tilt_rad.to_bits() != drop.tilt_rad.to_bits() {
                most = most.max(off(&Drop { tilt_rad, ..*drop }, tolerance));
            }
        }
        Self { off_by: self.off_by.max(SAFETY * most), ..self }
    }
}

/// Returns the answer of a drop that is followed once, whose error leaves out that strikes multiply those before them.
pub(crate) fn once(drop: &Drop, part: &Part, limit: &Limit, model: Model, tolerance: f64) -> Result<Answer, Error> {
    of_followed(&follow(drop, model, tolerance, Until::Over)?, part, limit)
}

/// Returns the same of a drop that is followed already.
pub(crate) fn of_followed(followed: &Followed, part: &Part, limit: &Limit) -> Result<Answer, Error> {
    PlaceHistory::new(followed, part.place)?.answer_or_nothing(limit, part.suspension.as_ref())
}

/// Returns an answer from the largest shock or the net change of velocity alone, without following a strike.
fn closed_form(drop: &Drop, part: &Part, limit: &Limit, model: Model) -> Result<Answer, Error> {
    let [a, b] = drop.body.arms_m();
    let flat_m_s = (1.0 + drop.restitution) * drop.speed_m_s;
    let bar = Bar::from_arms([a, b], drop.body.gyration_m(), drop.restitution)?;
    let start = Start::new(drop.approaches_m_s(), drop.body.length_m() * libm::sin(drop.tilt_rad))?;
    let s = 2.0 * part.place.at_m[0] / drop.body.length_m();
    let of_turn = 2.0 / drop.body.length_m();
    let (shock, turn) = if drop.is_flat {
        (flat_m_s, 0.0)
    } else if model == Model::LargestShock {
        let EndPeaks { a, b } = bar.shocks(&start, drop.first()).struck();
        let [qa, qb] = bar.inertia_ratios();
        let turn = 0.5 * of_turn * (a * (1.0 + qa)).max(b * (1.0 + qb));
        (bar.shocks(&start, drop.first()).at(s), turn)
    } else {
        let (bar, s) = if drop.first() == End::A { (bar, s) } else { (bar.exchanged(), -s) };
        let net = bar.summary(&start).net.ok_or(Error::Unfinished)?;
        (0.5 * ((1.0 - s) * net.a + (1.0 + s) * net.b).abs(), 0.5 * of_turn * (net.b - net.a).abs())
    };
    let (unit, source) = (limit.kind.unit(), limit.kind.source());
    let value = match source {
        Source::Turn => turn,
        Source::Response(_) => limit.clatter_free(shock, None, part.suspension.as_ref())?,
        Source::Shock | Source::Boundary => shock,
    };
    let value = if value.is_finite() {
        value
    } else {
        // A part mounted rigidly: the half-sine of the contact time.
        shock * FRAC_PI_2 / drop.contact_time_s.ok_or(Error::Contact)?
    };
    let acceleration = drop.contact_time_s.map(|time| shock * FRAC_PI_2 / time);
    let by_acceleration = acceleration.filter(|_| source == Source::Boundary);
    let answer = Answer { value, allowed: limit.allowed, unit, time_s: 0.0, impact: 1, off_by: 0.0 };
    Ok(match by_acceleration {
        Some(value) if value / limit.critical_acceleration_m_s2 < answer.utilization() => {
            Answer { value, allowed: limit.critical_acceleration_m_s2, unit: Unit::MeterPerSecondSquared, ..answer }
        }
        _ => answer,
    })
}

/// Computes the response of a suspension at the place of a part in one drop, with all its peaks, and the hits of its stops.
///
/// # Errors
/// As [`answer`].
pub fn respond(
    drop: &Drop,
    place: &Part,
    suspension: &Suspension,
    model: Model,
    tolerance: f64,
) -> Result<(Response, Vec<Hit>), Error> {
    check_drop(drop, &place.place)?;
    let followed = follow(drop, model, tolerance, Until::Over)?;
    let pulses = PlaceHistory::new(&followed, place.place)?.pulses;
    // The motion after one that was left early is no ring-down.
    let (response, until_s) = if followed.is_early() {
        (pulses.respond_within(suspension), followed.stop().time_s())
    } else {
        (pulses.respond(suspension), f64::INFINITY)
    };
    let mut hits = pulses.hits(suspension)?;
    hits.retain(|hit| hit.time <= until_s);
    Ok((response, hits))
}

/// The history of the acceleration at one place of a followed drop.
#[derive(Debug)]
pub(crate) struct PlaceHistory<'a> {
    followed: &'a Followed,
    history: Excitation,
    pulses: Pulses,
    place: Place,
    fastest_rad_s: f64,
    /// Its velocity shocks, made when they are first requested.
    shocks: OnceLock<Vec<Shock>>,
    /// The largest of them, and the largest acceleration in any, made when they are first requested.
    largest: OnceLock<Shock>,
    crest: OnceLock<Option<(f64, f64)>>,
    /// The motion of parts as it ends, of those that were requested.
    ends: Mutex<Vec<(Suspension, State)>>,
    /// The same until earlier, of which all answers are known.
    known: Option<&'a PlaceHistory<'a>>,
    /// Whether what may come after the motion was left is told apart from its answers.
    leaves_later: bool,
}

impl<'a> PlaceHistory<'a> {
    pub(crate) fn new(followed: &'a Followed, place: Place) -> Result<Self, Error> {
        Self::rough(followed, place, f64::INFINITY)
    }

    /// Returns the same for responses of parts up to a natural frequency, to about 1 %: pulses that are short compared with the period of
    /// the fastest part are taken as velocity shocks of the same impulse at the mean time.
    pub(crate) fn rough(followed: &'a Followed, place: Place, fastest_rad_s: f64) -> Result<Self, Error> {
        if followed.is_cut() {
            return Err(Error::Unfinished);
        }
        let history = followed.felt(&place);
        let pulses = pulses(&history, SHORT / fastest_rad_s, followed.carried_m_s2(&place))?;
        let (shocks, largest, crest, ends) = (OnceLock::new(), OnceLock::new(), OnceLock::new(), Mutex::default());
        let (known, leaves_later) = (None, false);
        Ok(Self { followed, history, pulses, place, fastest_rad_s, shocks, largest, crest, ends, known, leaves_later })
    }

    /// Returns the same whose answers leave out what may come after the motion was left, where that is one landing after the other.
    pub(crate) fn leaving_later(self) -> Self {
        Self { leaves_later: self.followed.is_early() && !self.followed.is_given_up(), ..self }
    }

    /// Returns the same place in the same drop, followed for longer.
    pub(crate) fn longer(&'a self, followed: &'a Followed) -> Result<Self, Error> {
        Ok(Self { known: Some(self), ..Self::rough(followed, self.place, self.fastest_rad_s)? })
    }

    /// Returns the answer for one limit, if its utilization passes `above`.
    pub(crate) fn answer(
        &self,
        limit: &Limit,
        suspension: Option<&Suspension>,
        above: f64,
    ) -> Result<Option<Answer>, Error> {
        if self.known.is_some_and(|known| known.later_most(limit, suspension, above) <= above) {
            return Ok(None);
        }
        let (value, time_s, off_by) = match (limit.kind.source(), suspension) {
            (Source::Response(peak), Some(part)) => {
                let Some(found) = self.peak(peak, part, above * limit.allowed) else { return Ok(None) };
                if found.0.is_infinite() {
                    // It hits its stops for ever.
                    self.pulses.hits(part)?;
                }
                found
            }
            (Source::Response(_), None) => {
                let contact_s = self.contact_s()?;
                let Some((value, time_s)) = self.largest_acceleration(contact_s) else { return Ok(None) };
                let per_change = self.peak_per_change();
                (
                    value,
                    time_s,
                    self.off_by(value / per_change, |later| later.acceleration_m_s2 / per_change) * per_change,
                )
            }
            (Source::Shock, _) => {
                let Shock { change, time_s, span_s, .. } =
                    *self.largest.get_or_init(|| largest_at(self.followed, &self.place, &self.history));
                (change, time_s, self.off_by(change, |later| later.turned_m_s) + self.stopped_m_s(span_s))
            }
            (Source::Turn, _) => {
                let Some(Shock { change, time_s, span_s, .. }) = largest_turn(self.followed, above * limit.allowed)
                else {
                    return Ok(None);
                };
                let drop = &self.followed.drop;
                let arm = if drop.body.is_wide() { drop.least_gyration_m() } else { 0.5 * drop.body.length_m() };
                let off = self.off_by(change * arm, |later| later.turn_rad_s * arm) + self.stopped_m_s(span_s);
                (change, time_s, off / arm)
            }
            (Source::Boundary, _) => return Ok(self.boundary(limit, above)),
        };
        let impact = self.followed.impact_at(time_s);
        let answer = Answer { value, allowed: limit.allowed, unit: limit.kind.unit(), time_s, impact, off_by };
        Ok(Some(answer).filter(|answer| answer.utilization() > above))
    }

    /// Returns how a part reaches stops like these, which are as far away; none where it reaches none.
    pub(crate) fn at_stops(&self, part: &Suspension, stops: [Stop; 2]) -> Option<AtStop> {
        let [soft, hard] = stops.map(|stop| part.with_stop(stop));
        let omega_gap = part.omega() * stops[0].gap();
        self.pulses.peak_within(part, Peaked::PseudoVelocity, omega_gap)?;
        let largest_hit_m_s = self.pulses.hits(&soft).ok()?.first()?.speed;
        let asks = |part: &Suspension| {
            let most = self.pulses.peak_within(part, Peaked::AccelerationOverOmega, 0.0)?;
            Some(part.omega() * most.value.abs()).filter(|most| most.is_finite())
        };
        Some(AtStop { largest_hit_m_s, asks_m_s2: [asks(&soft)?, asks(&hard)?] })
    }

    /// Returns the answer for one limit; 0 where it has no demand.
    pub(crate) fn answer_or_nothing(&self, limit: &Limit, suspension: Option<&Suspension>) -> Result<Answer, Error> {
        let (allowed, unit) = (limit.allowed, limit.kind.unit());
        let nothing = || {
            let off_by = if self.leaves_later { 0.0 } else { self.later_of(limit, suspension) };
            Answer { value: 0.0, allowed, unit, time_s: 0.0, impact: 1, off_by }
        };
        Ok(self.answer(limit, suspension, 0.0)?.unwrap_or_else(nothing))
    }

    /// Changes of velocity at the place in steps of time, each in its middle, up to a time: what a curve is drawn from.
    pub(crate) fn slices(&self, step_s: f64, end_s: f64) -> Vec<(f64, f64)> {
        let mut slices = Vec::new();
        for section in self.history.sections().take_while(|section| section.from < end_s) {
            if section.delta_v != 0.0 {
                slices.push((section.from, section.delta_v));
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
            let steps = (section.length / step_s).ceil().clamp(1.0, 1e4) as u32;
            let h = section.length / f64::from(steps);
            let mut before = section.delta_v;
            for k in 1..=steps {
                let now = section.velocity_after(f64::from(k) * h);
                if now - before != 0.0 {
                    slices.push((section.from + (f64::from(k) - 0.5) * h, now - before));
                }
                before = now;
            }
        }
        slices
    }
    /// Returns times and values of a part with stops up to a time, to be joined by straight lines.
    pub(crate) fn with_stop(
        &self,
        part: &Suspension,
        peak: ResponsePeak,
        step_s: f64,
        end_s: f64,
    ) -> Result<Vec<(f64, f64)>, Error> {
        let curve = self.pulses.motion(part, step_s.max(MOST_FINE * end_s))?;
        let value = |moment: &Moment| peak.of_moment(part, moment);
        Ok(curve.iter().take_while(|moment| moment.time <= end_s).map(|moment| (moment.time, value(moment))).collect())
    }
    /// Times and accelerations of the place, to be joined by straight lines.
    pub(crate) fn acceleration(&self) -> Vec<(f64, f64)> {
        let mut all = Vec::new();
        for section in self.history.sections() {
            let steps = samples(&section);
            all.extend((0..=steps).map(|k| {
                let t = f64::from(k) / f64::from(steps) * section.length;
                (section.from + t, section.acceleration_at(t))
            }));
        }
        all
    }
    /// Returns the velocity shocks.
    pub(crate) fn shocks(&self) -> &[Shock] {
        self.shocks.get_or_init(|| shocks_at(self.followed, &self.place, &self.history))
    }
    /// Returns the peak of a suspended part where it passes `above`: value, time and error bound.
    fn peak(&self, of: ResponsePeak, part: &Suspension, above: f64) -> Option<(f64, f64, f64)> {
        let (omega, peaked) = (part.omega(), of.peaked);
        let unit = of.of_velocity(1.0, omega);
        // The motion after one that was left early is no ring-down.
        let (peak, end) = self.pulses.peak_and_end(part, peaked, above / unit, !self.followed.is_early());
        self.ends().push((*part, end));
        // No touch of a stop is a speed of nothing.
        let none = Extreme { value: 0.0, time: 0.0, interval: 0 };
        let peak = peak.or((peaked == Peaked::StopSpeed && above < 0.0).then_some(none))?;
        let velocity = peak.value.abs();
        // The vibration that rings on as the motion is left, and the later shocks, are taken as if all came at its crest.
        let comes = self.followed.later_m_s() > 0.0 || self.followed.weight_to_come_m_s2() > 0.0;
        let doubt = if comes && !self.leaves_later {
            let most = later::swing(part, end) + self.later().shock_of(part);
            of.in_swing(part, most) - velocity
        } else {
            0.0
        };
        // A part that is fast compared with a contact follows its force and not its velocity.
        let follows = (omega / self.peak_per_change()).max(1.0);
        let off = kept_arms(self.followed) * self.followed.largest_m_s / follows;
        Some((unit * velocity, peak.time, unit * (off + doubt.max(0.0))))
    }

    /// Returns the amplitude to which a part without stops swings in all, as a velocity: that of one shock with its largest displacement.
    pub(crate) fn amplitude(&self, part: &Suspension) -> f64 {
        let most = self.pulses.peak_within(part, Peaked::PseudoVelocity, 0.0).map_or(0.0, |peak| peak.value.abs());
        most / part.damping().impulse_factors().displacement
    }

    /// Returns how a part moves as the history ends.
    fn end_of(&self, part: &Suspension) -> State {
        let known = self.ends().iter().find(|(other, _)| other == part).map(|(_, end)| *end);
        known.unwrap_or_else(|| {
            let end = self.pulses.state_at_end(part);
            self.ends().push((*part, end));
            end
        })
    }
    fn ends(&self) -> MutexGuard<'_, Vec<(Suspension, State)>> {
        self.ends.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the largest acceleration in a lone contact over its change of velocity; infinite where no contact time is known.
    fn peak_per_change(&self) -> f64 {
        let half_sine = || self.followed.drop.contact_time_s.map_or(f64::INFINITY, |time| FRAC_PI_2 / time);
        self.followed.peak_per_change().unwrap_or_else(half_sine)
    }

    fn contact_s(&self) -> Result<f64, Error> {
        self.followed.drop.contact_time_s.ok_or(Error::Contact)
    }

    /// Returns the largest acceleration of the product at the place, and when. Instant impacts are half-sines of the contact time: their
    /// largest value is that of hysteretic contacts as well.
    fn largest_acceleration(&self, contact_s: f64) -> Option<(f64, f64)> {
        if self.followed.has_contacts() {
            return *self.crest.get_or_init(|| crest_at(self.followed, &self.place, &self.history));
        }
        let all = self.shocks().iter().map(|shock| (shock.change * FRAC_PI_2 / contact_s, shock.time_s));
        all.reduce(|most, one| if one.0 > most.0 { one } else { most })
    }

    /// Returns the shock that leaves least room, each by velocity change or acceleration, whichever leaves more.
    fn boundary(&self, limit: &Limit, above: f64) -> Option<Answer> {
        let contact_s = self.followed.drop.contact_time_s;
        let mut worst: Option<Answer> = None;
        for &Shock { change, peak, time_s, span_s } in self.shocks() {
            if change / limit.allowed <= worst.map_or(above, |worst| worst.utilization()) {
                continue;
            }
            let impact = self.followed.impact_at(time_s);
            let off_by = self.off_by(change, |later| later.turned_m_s) + self.stopped_m_s(span_s);
            let (unit, allowed) = (Unit::MeterPerSecond, limit.allowed);
            let mut answer = Answer { value: change, allowed, unit, time_s, impact, off_by };
            if let Some(contact_s) = contact_s {
                let value = if peak.is_finite() { peak } else { change * FRAC_PI_2 / contact_s };
                let (unit, allowed) = (Unit::MeterPerSecondSquared, limit.critical_acceleration_m_s2);
                if value / allowed < answer.utilization() {
                    answer = Answer { value, allowed, unit, off_by: off_by * self.peak_per_change(), ..answer };
                }
            }
            if worst.is_none_or(|worst| answer.utilization() > worst.utilization()) {
                worst = Some(answer);
            }
        }
        worst.filter(|worst| worst.utilization() > above)
    }
}

/// The least step of a curve, over its length.
const MOST_FINE: f64 = 1e-4;
/// The error of a shock from lever arms kept through a phase, at most, in precisions of the flight (clatter-flight).
const KEPT_ARMS: f64 = 4.0;

/// Returns the share of the largest shock that lever arms kept through a phase may get wrong.
fn kept_arms(followed: &Followed) -> f64 {
    if followed.has_contacts() { KEPT_ARMS * followed.precision } else { 0.0 }
}
