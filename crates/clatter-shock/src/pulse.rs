//! Pulses of finite length: shapes, trains, and the exact response to them.

mod overlap;
mod stopped;

use crate::forced::{Sample, Segment};
use crate::peaks::{Extreme, Range, Response};
use crate::suspension::{Modes, Motion};
use crate::{Error, Hit, Peaked, State, Stop, Suspension, VelocityShock};
use clatter::{Section, Sine};
use num_complex::Complex64;
use std::cmp::Ordering;
use std::f64::consts::PI;
pub use stopped::Moment;
use stopped::{Stopped, Systems, Wanted, most_hits};

/// The classical pulse shapes, of amplitude a and duration D.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Shape {
    /// a sin(πt/D); area 2aD/π.
    HalfSine,
    /// a (1 − cos(2πt/D))/2; area aD/2.
    Haversine,
    /// Rise to a at D/2 and fall; area aD/2.
    Triangle,
    /// Fall from a to 0; area aD/2.
    InitialPeakSawtooth,
    /// Rise from 0 to a; area aD/2.
    TerminalPeakSawtooth,
    /// Constant a; area aD.
    Rectangle,
    /// Rise to a within `ramp` D, constant, and fall within `ramp` D; area aD(1 − ramp).
    Trapezoid {
        /// Length of each ramp over that of the pulse, in (0, ½].
        ramp: f64,
    },
}

impl Shape {
    /// Returns the velocity change over a D.
    ///
    /// ```
    /// # use clatter_shock::Shape;
    /// assert_eq!(Shape::Triangle.area(), 0.5);
    /// assert_eq!(Shape::Trapezoid { ramp: 0.1 }.area(), 0.9);
    /// ```
    #[must_use]
    pub fn area(self) -> f64 {
        match self {
            Self::HalfSine => 2.0 / PI,
            Self::Haversine | Self::Triangle | Self::InitialPeakSawtooth | Self::TerminalPeakSawtooth => 0.5,
            Self::Rectangle => 1.0,
            Self::Trapezoid { ramp } => 1.0 - ramp,
        }
    }
}

/// One pulse of base acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pulse {
    /// Its shape.
    pub shape: Shape,
    /// Largest acceleration, with its sign.
    pub amplitude: f64,
    /// Length D > 0.
    pub duration: f64,
    /// Time of its begin.
    pub start: f64,
}

impl Pulse {
    /// Returns the velocity change, the area of the pulse.
    #[must_use]
    pub fn velocity_change(&self) -> f64 {
        self.shape.area() * self.amplitude * self.duration
    }
}

/// A checked history of base acceleration: pulses that may overlap, a piecewise linear history, or sections with velocity
/// shocks, straight lines and sinusoids. Zero before, and after unless it is [carried](Self::carried).
#[derive(Debug, Clone, PartialEq)]
pub struct Pulses {
    pieces: Vec<Piece>,
    sines: Vec<SinePiece>,
    end: Instant,
    /// Acceleration from the end on.
    carried: f64,
}

/// An instant as the unevaluated sum of two doubles: a short pulse late in time keeps its length.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
struct Instant {
    hi: f64,
    lo: f64,
}

impl Instant {
    fn at(t: f64) -> Self {
        Self { hi: t, lo: 0.0 }
    }
    /// Returns `t` + `fraction` · `duration`, the product rounded once.
    fn after(t: f64, duration: f64) -> Self {
        let hi = t + duration;
        let back = hi - t;
        Self { hi, lo: (t - (hi - back)) + (duration - back) }
    }
    fn since(self, earlier: Self) -> f64 {
        (self.hi - earlier.hi) + (self.lo - earlier.lo)
    }
    fn order(&self, other: &Self) -> Ordering {
        self.hi.total_cmp(&other.hi).then(self.lo.total_cmp(&other.lo))
    }
}

/// The forcing between two breakpoints.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    start: Instant,
    length: f64,
    /// Velocity shock at the begin.
    shock: f64,
    /// Linear part at both ends.
    from: f64,
    to: f64,
    /// Sinusoids, a range of `sines`.
    sines: (usize, usize),
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct SinePiece {
    amplitude: f64,
    rate: f64,
    /// e^(iφ) at the begin, and e^(i rate length).
    phase: Complex64,
    turned: Complex64,
}

const PULSES: &str = "pulses";
const POINTS: &str = "history";

impl Pulses {
    /// Creates a train of pulses, in any order; where they overlap they add up.
    ///
    /// # Errors
    ///
    /// [`Error::Empty`]; [`Error::ZeroDuration`] for a pulse of no length; [`Error::Entry`] for a value that is not
    /// finite, a negative duration or a ramp outside (0, ½]; [`Error::Overlap`] where too many sinusoids of different
    /// lengths overlap.
    ///
    /// # Cost
    ///
    /// n pulses take n log n steps, however they overlap, and responses to them n steps more for each frequency:
    /// sinusoids of one length add up to one. Where pulses of m different lengths overlap, both take m times as many,
    /// and the memory for it is bounded: beyond four million sinusoids (2000 half-sines of 2000 lengths that all
    /// overlap) it is refused.
    pub fn new(pulses: &[Pulse]) -> Result<Self, Error> {
        if pulses.is_empty() {
            return Err(Error::Empty(PULSES));
        }
        let mut terms = Vec::with_capacity(2 * pulses.len());
        for (i, p) in pulses.iter().enumerate() {
            let entry = |name, value, allowed| Error::Entry { list: PULSES, entry: i + 1, name, value, allowed };
            for (name, value) in [("amplitude", p.amplitude), ("start", p.start), ("end", p.start + p.duration)] {
                if !value.is_finite() {
                    return Err(entry(name, value, "finite"));
                }
            }
            if p.duration == 0.0 {
                return Err(Error::ZeroDuration);
            }
            if p.duration < f64::MIN_POSITIVE {
                return Err(entry("duration", p.duration, "at least 2.3e-308"));
            }
            if let Shape::Trapezoid { ramp } = p.shape
                && !(ramp > 0.0 && ramp <= 0.5)
            {
                return Err(entry("ramp over duration", ramp, "in (0, 0.5]; without ramps it is a rectangle"));
            }
            overlap::add_terms(p, &mut terms);
        }
        let (pieces, sines, end) = overlap::pieces(terms)?;
        Ok(Self { pieces, sines, end, carried: 0.0 })
    }
    /// Returns a piecewise linear history of (time, acceleration); two points at one time are a jump.
    ///
    /// # Errors
    ///
    /// [`Error::Points`] below two points, [`Error::Entry`] for a value that is not finite, [`Error::TimeOrder`] where
    /// times run back, [`Error::ZeroDuration`] if all happens at one instant.
    pub fn piecewise_linear(points: &[(f64, f64)]) -> Result<Self, Error> {
        if points.len() < 2 {
            return Err(Error::Points("the history", points.len()));
        }
        let mut previous = f64::NEG_INFINITY;
        for (i, &(time, a)) in points.iter().enumerate() {
            for (name, value) in [("time", time), ("acceleration", a)] {
                if !value.is_finite() {
                    return Err(Error::Entry { list: POINTS, entry: i + 1, name, value, allowed: "finite" });
                }
            }
            if time < previous {
                return Err(Error::TimeOrder { list: POINTS, entry: i + 1, time, previous });
            }
            previous = time;
        }
        let history = Self::from_sorted(points);
        if history.pieces.is_empty() { Err(Error::ZeroDuration) } else { Ok(history) }
    }
    /// Creates a history of sections, one after the other from the begin of the first.
    ///
    /// # Errors
    ///
    /// [`Error::Empty`]; [`Error::Entry`] for a value that is not finite, a negative length, or a rate that is not positive.
    ///
    /// # Examples
    ///
    /// A velocity shock of 2 as a section of no length:
    ///
    /// ```
    /// use clatter::Section;
    /// use clatter_shock::{DampingRatio, Pulses, Suspension};
    /// let shock = Section::shock(0.0, 0.0, 2.0);
    /// let mount = Suspension::new(100.0, DampingRatio::new(0.0)?)?;
    /// let peak = Pulses::of_sections([shock])?.respond(&mount).absolute_acceleration.peak();
    /// assert!((peak.value - 200.0).abs() < 1e-12);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    pub fn of_sections<'a>(sections: impl IntoIterator<Item = Section<'a>>) -> Result<Self, Error> {
        let mut sections = sections.into_iter().peekable();
        let many = sections.size_hint().0;
        let (mut pieces, mut sines) = (Vec::with_capacity(many), Vec::with_capacity(2 * many));
        let mut at = Instant::at(sections.peek().map_or(0.0, |section| section.from));
        for (i, section) in sections.enumerate() {
            let entry = |name, value, allowed| Error::Entry { list: "sections", entry: i + 1, name, value, allowed };
            let Section { length, delta_v, acceleration: [from, to], .. } = section;
            for (name, value) in [("start", at.hi), ("delta v", delta_v), ("acceleration", from), ("acceleration", to)]
            {
                if !value.is_finite() {
                    return Err(entry(name, value, "finite"));
                }
            }
            if !(0.0..f64::INFINITY).contains(&length) {
                return Err(entry("length", length, "finite and at least 0"));
            }
            let first = sines.len();
            for sine in section.sines {
                let Sine { amplitude, rate, phase } = *sine;
                if !(rate > 0.0 && rate.is_finite() && amplitude.is_finite() && phase.is_finite()) {
                    return Err(entry("rate", rate, "positive, and all of a sinusoid finite"));
                }
                let turned = Complex64::cis(rate * length);
                sines.push(SinePiece { amplitude, rate, phase: Complex64::cis(phase), turned });
            }
            pieces.push(Piece { start: at, length, shock: delta_v, from, to, sines: (first, sines.len()) });
            at = Instant::after(at.hi, length + at.lo);
        }
        if pieces.is_empty() {
            Err(Error::Empty("sections"))
        } else {
            Ok(Self { pieces, sines, end: at, carried: 0.0 })
        }
    }
    /// Returns the same history with a constant acceleration from its end on, for ever: the weight of a body that has
    /// come to rest.
    ///
    /// # Errors
    ///
    /// [`Error::Entry`] unless it is finite.
    ///
    /// # Examples
    ///
    /// A weight that is applied at once has twice the effect of a weight at rest:
    ///
    /// ```
    /// # use clatter::Section;
    /// # use clatter_shock::{DampingRatio, Pulses, Suspension};
    /// let fall = Section::shock(0.0, 0.1, 0.0);
    /// let mount = Suspension::new(20.0, DampingRatio::new(0.0)?)?;
    /// let response = Pulses::of_sections([fall])?.carried(9.8)?.respond(&mount);
    /// assert!((response.absolute_acceleration.peak().value - 2.0 * 9.8).abs() < 1e-12);
    /// assert!((response.relative_displacement.peak().value + 2.0 * 9.8 / 400.0).abs() < 1e-12);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    pub fn carried(self, acceleration: f64) -> Result<Self, Error> {
        if !acceleration.is_finite() {
            let (name, allowed) = ("acceleration after the end", "finite");
            return Err(Error::Entry {
                list: "sections",
                entry: self.pieces.len() + 1,
                name,
                value: acceleration,
                allowed,
            });
        }
        Ok(Self { carried: acceleration, ..self })
    }
    /// Creates a piecewise linear history of points already checked: finite, in order of time.
    pub(crate) fn from_sorted(points: &[(f64, f64)]) -> Self {
        let mut pieces = Vec::with_capacity(points.len());
        pieces.extend(points.windows(2).filter(|w| w[1].0 > w[0].0).map(|w| Piece {
            start: Instant::at(w[0].0),
            length: w[1].0 - w[0].0,
            shock: 0.0,
            from: w[0].1,
            to: w[1].1,
            sines: (0, 0),
        }));
        Self { pieces, sines: Vec::new(), end: Instant::at(points.last().map_or(0.0, |p| p.0)), carried: 0.0 }
    }
    /// Creates a history of velocity shocks already checked: an interval for each.
    pub(crate) fn of_shocks(shocks: &[VelocityShock]) -> Self {
        let piece = |start: f64, end: f64, shock: f64| Piece {
            start: Instant::at(start),
            length: end - start,
            shock,
            from: 0.0,
            to: 0.0,
            sines: (0, 0),
        };
        let ends = shocks.iter().skip(1).chain(shocks.last());
        let pieces: Vec<_> = shocks.iter().zip(ends).map(|(s, next)| piece(s.time, next.time, s.delta_v)).collect();
        let end = Instant::at(shocks.last().map_or(0.0, |shock| shock.time));
        Self { pieces, sines: Vec::new(), end, carried: 0.0 }
    }
    /// Returns the peaks of the component's response, ring-down included. Interval i begins at the i-th begin or end of
    /// a part of a pulse.
    ///
    /// # Stops
    ///
    /// With a [`Stop`] the response is that between the stops, phase by phase in closed form; the acceleration is that
    /// of spring, damper and stop. The ring-down is followed until no stop can be reached, or until seven touches in
    /// a row are no faster than one before them: none later is. A component that touches its stops more than 4096
    /// times, or more often than the history has sections, is not followed further: its peaks are then infinite, and [`hits`](Self::hits) returns [`Error::Hits`].
    ///
    /// # Accuracy
    ///
    /// Within a few tens of roundings per pulse of the largest response, also at resonance with ζ = 0 and for pulses
    /// much shorter or longer than the period; peaks inside pulses are isolated by bounds on derivatives, never
    /// sampled.
    ///
    /// # Cost
    ///
    /// A pulse of many periods costs little more than one of a few: the search halves it, and leaves out what the
    /// envelope of the swing cannot lift above the largest value yet. A stop that is not reached costs little, and each
    /// touch as much as a few pulses.
    ///
    /// # Examples
    ///
    /// A rectangle of half a period doubles its acceleration:
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Pulse, Pulses, Shape, Suspension};
    /// let pulses = Pulses::new(&[Pulse { shape: Shape::Rectangle, amplitude: 50.0, duration: 0.005, start: 0.0 }])?;
    /// let mount = Suspension::from_hz(100.0, DampingRatio::new(0.0)?)?;
    /// assert!((pulses.respond(&mount).absolute_acceleration.peak().value - 100.0).abs() < 1e-12);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn respond(&self, suspension: &Suspension) -> Response {
        self.response(suspension, true)
    }
    /// Returns the peaks until the end of the history, without the ring-down after it, as
    /// [`peak_within`](Self::peak_within).
    #[must_use]
    pub fn respond_within(&self, suspension: &Suspension) -> Response {
        self.response(suspension, false)
    }
    fn response(&self, suspension: &Suspension, rings_down: bool) -> Response {
        let mut ranges = [Range::default(); 3];
        let omega = suspension.omega();
        if let Some(stop) = suspension.stop() {
            self.drive_stopped(suspension, stop, Wanted { quantities: &[0, 1, 2], ranges: &mut ranges }, rings_down);
            return Response::from_ranges(omega, &ranges, |i| self.begin(i));
        }
        let modes = Modes::new(suspension.damping());
        let last = self.drive(&modes, omega, &[0, 1, 2], &mut ranges);
        if rings_down {
            for (k, range) in ranges.iter_mut().enumerate() {
                range.note_carried(&modes, k, last, -self.carried / omega, self.pieces.len());
            }
        }
        Response::from_ranges(omega, &ranges, |i| self.begin(i))
    }
    /// Returns the peak of one quantity, ωz or A/ω with its sign, if it passes `above` ≥ 0 either way, or the hardest
    /// touch of a stop if it is faster than that. A search for the
    /// largest of many peaks passes the largest so far as `above`, and pays little for the smaller ones.
    ///
    /// # Accuracy
    ///
    /// The accuracy is that of [`respond`](Self::respond).
    ///
    /// # Examples
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Peaked, Pulse, Pulses, Shape, Suspension};
    /// let pulses = Pulses::new(&[Pulse { shape: Shape::HalfSine, amplitude: 50.0, duration: 0.005, start: 0.0 }])?;
    /// let mount = Suspension::from_hz(100.0, DampingRatio::new(0.05)?)?;
    /// let peak = pulses.respond(&mount).relative_displacement.peak();
    /// let alone = pulses.peak_above(&mount, Peaked::PseudoVelocity, 0.0).unwrap();
    /// assert!((alone.value - mount.omega() * peak.value).abs() < 1e-15);
    /// assert_eq!(pulses.peak_above(&mount, Peaked::PseudoVelocity, 1.0), None);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn peak_above(&self, suspension: &Suspension, peaked: Peaked, above: f64) -> Option<Extreme> {
        self.peak_and_end(suspension, peaked, above, true).0
    }
    /// Returns the same peak until the end of the history, without the ring-down after it, for a history that is known
    /// only so far.
    #[must_use]
    pub fn peak_within(&self, suspension: &Suspension, peaked: Peaked, above: f64) -> Option<Extreme> {
        self.peak_and_end(suspension, peaked, above, false).0
    }
    /// Returns the peak with or without the ring-down, as `rings_down` says, and the [state at the
    /// end](Self::state_at_end), which takes no longer.
    #[must_use]
    pub fn peak_and_end(
        &self,
        suspension: &Suspension,
        peaked: Peaked,
        above: f64,
        rings_down: bool,
    ) -> (Option<Extreme>, State) {
        if let Some(stop) = suspension.stop() {
            return self.stopped_peak_and_end(suspension, stop, peaked, above, rings_down);
        }
        let Some(row) = peaked.row() else { return (None, self.state_at_end(suspension)) };
        let modes = Modes::new(suspension.damping());
        let omega = suspension.omega();
        let mut range = [Range::beyond(above)];
        let last = self.drive(&modes, omega, &[row], &mut range);
        let [mut range] = range;
        if rings_down {
            range.note_carried(&modes, row, last, -self.carried / omega, self.pieces.len());
        }
        (range.peak_above(above, omega, |i| self.begin(i)), modes.state(omega, last))
    }
    /// Returns every touch of a stop, in order of time: the moments at which z reaches the surface of a stop from within.
    /// Without a stop there is none. The ring-down is followed as in [`respond`](Self::respond).
    ///
    /// # Errors
    ///
    /// [`Error::Hits`] beyond 4096 touches and one for each section.
    ///
    /// # Examples
    ///
    /// A part that moves freely at 1 m/s between stops 2 mm apart loses half of its speed at each:
    ///
    /// ```
    /// # use clatter::Section;
    /// # use clatter_shock::{DampingRatio, Pulses, Stop, Suspension};
    /// let part = Suspension::new(1e-3, DampingRatio::new(0.0)?)?.with_stop(Stop::new(1e-3, 1e-6, 0.5)?);
    /// let hits = Pulses::of_sections([Section::shock(0.0, 8e-3, -1.0)])?.hits(&part)?;
    /// for (hit, (time, speed, side)) in hits.iter().zip([(1e-3, 1.0, 1), (5e-3, 0.5, -1)]) {
    ///     assert!((hit.time - time).abs() < 1e-5 && (hit.speed - speed).abs() < 1e-8 && hit.side == side);
    /// }
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    pub fn hits(&self, suspension: &Suspension) -> Result<Vec<Hit>, Error> {
        let Some(stop) = suspension.stop() else { return Ok(Vec::new()) };
        let systems = Systems::new(suspension, stop);
        let mut part = Stopped::new(self, &systems, Wanted { quantities: &[], ranges: &mut [] });
        part.drive();
        part.ring_down();
        match part.gave_up() {
            None => Ok(part.touches.iter().map(|touch| touch.hit).collect()),
            Some(_) => Err(Error::Hits(most_hits(self))),
        }
    }
    /// Returns the motion of a component with a stop until the end of the history, at times no further apart than `step`, for a picture:
    /// both ends of every phase are among them. None without a stop.
    ///
    /// # Errors
    ///
    /// [`Error::Quantity`] unless the step is positive and finite, [`Error::Hits`] beyond 4096 touches and one for each section.
    ///
    /// # Examples
    ///
    /// ```
    /// # use clatter::Section;
    /// # use clatter_shock::{DampingRatio, Pulses, Stop, Suspension};
    /// let part = Suspension::new(1e-3, DampingRatio::new(0.0)?)?.with_stop(Stop::new(1e-3, 1e-4, 1.0)?);
    /// let curve = Pulses::of_sections([Section::shock(0.0, 3e-3, -1.0)])?.motion(&part, 1e-5)?;
    /// // It presses with (π/2)(1 + e) v/τ at most.
    /// let most = curve.iter().map(|moment| moment.acceleration.abs()).fold(0.0, f64::max);
    /// assert!((most / (std::f64::consts::PI / 1e-4) - 1.0).abs() < 0.02);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    pub fn motion(&self, suspension: &Suspension, step: f64) -> Result<Vec<Moment>, Error> {
        let step = crate::error::positive("step of the curve", step)?;
        let Some(stop) = suspension.stop() else { return Ok(Vec::new()) };
        let systems = Systems::new(suspension, stop);
        let mut part = Stopped::new(self, &systems, Wanted { quantities: &[], ranges: &mut [] });
        part.curve = Some((step, Vec::new()));
        part.drive();
        if part.gave_up().is_some() {
            return Err(Error::Hits(most_hits(self)));
        }
        Ok(part.curve.map_or_else(Vec::new, |(_, curve)| curve))
    }
    /// Returns the extremes of quantity `k` of a component with a stop during the history and after it; all are infinite if it gives up.
    pub(crate) fn stopped_ranges(&self, suspension: &Suspension, stop: Stop, k: usize) -> [Range; 2] {
        let systems = Systems::new(suspension, stop);
        let mut ranges = [Range::default(); 2];
        let ([during, after], quantities) = (&mut ranges, [k]);
        let wanted = Wanted { quantities: &quantities, ranges: std::slice::from_mut(during) };
        let mut part = Stopped::new(self, &systems, wanted);
        part.drive();
        let mut part = part.noting(std::slice::from_mut(after));
        part.ring_down();
        part.finish();
        ranges
    }
    /// Notes the extremes of a component with a stop; all are infinite if it gives up.
    fn drive_stopped(&self, suspension: &Suspension, stop: Stop, wanted: Wanted, rings_down: bool) {
        let systems = Systems::new(suspension, stop);
        let mut part = Stopped::new(self, &systems, wanted);
        part.drive();
        if rings_down {
            part.ring_down();
        }
        part.finish();
    }
    fn stopped_peak_and_end(
        &self,
        suspension: &Suspension,
        stop: Stop,
        peaked: Peaked,
        above: f64,
        rings_down: bool,
    ) -> (Option<Extreme>, State) {
        let systems = Systems::new(suspension, stop);
        let (row, mut range) = (peaked.row(), [Range::beyond(above)]);
        let wanted = Wanted { quantities: row.as_slice(), ranges: &mut range };
        let mut part = Stopped::new(self, &systems, wanted);
        part.drive();
        let end = part.state();
        if rings_down {
            part.ring_down();
        }
        if let Some((interval, time)) = part.gave_up() {
            return (Some(Extreme { value: f64::INFINITY, time, interval }), end);
        }
        let hardest = part.hardest_touch(above);
        let peak = row.map_or(hardest, |_| range[0].peak_above(above, suspension.omega(), |i| self.begin(i)));
        (peak, end)
    }
    /// Returns the number of the interval after the last pulse.
    pub(crate) fn end_interval(&self) -> usize {
        self.pieces.len()
    }
    /// Returns the begin of interval `i`.
    pub(crate) fn begin(&self, i: usize) -> f64 {
        self.pieces.get(i).map_or(self.end.hi, |p| p.start.hi)
    }
    /// Returns the motion relative to the base at the end of the last pulse. It tells z and z′ alone, not what a component
    /// then presses; both are infinite for one that touches its stops that often.
    #[must_use]
    pub fn state_at_end(&self, suspension: &Suspension) -> State {
        if let Some(stop) = suspension.stop() {
            let systems = Systems::new(suspension, stop);
            let mut part = Stopped::new(self, &systems, Wanted { quantities: &[], ranges: &mut [] });
            part.drive();
            return part.state();
        }
        let modes = Modes::new(suspension.damping());
        let omega = suspension.omega();
        modes.state(omega, self.drive(&modes, omega, &[], &mut []))
    }
    /// Returns the motion at the end of the last pulse, and notes the extremes of the given quantities until then in
    /// `ranges`.
    pub(crate) fn drive(&self, modes: &Modes, omega: f64, quantities: &[usize], ranges: &mut [Range]) -> Motion {
        self.drive_on(Motion::default(), modes, omega, quantities, ranges)
    }
    /// Does the same from a motion under way.
    pub(crate) fn drive_on(
        &self,
        mut m: Motion,
        modes: &Modes,
        omega: f64,
        quantities: &[usize],
        ranges: &mut [Range],
    ) -> Motion {
        let mut segment = Segment::new(modes);
        for (i, piece) in self.pieces.iter().enumerate() {
            if piece.shock != 0.0 {
                m.w -= piece.shock;
                for (&k, range) in quantities.iter().zip(ranges.iter_mut()) {
                    range.note(i, 0.0, modes.quantity(k, m));
                }
            }
            if piece.length == 0.0 {
                continue;
            }
            let end = self.begin_piece(&mut segment, m, omega, piece);
            for (&k, range) in quantities.iter().zip(ranges.iter_mut()) {
                segment.extremes(k, &end, i, range);
            }
            m = end.m;
        }
        m
    }
    /// Begins the segment of a piece and returns its end.
    fn begin_piece(&self, segment: &mut Segment, m: Motion, omega: f64, piece: &Piece) -> Sample {
        let span = segment.begin_line(m, omega, piece.length, piece.from, piece.to);
        let sines = &self.sines[piece.sines.0..piece.sines.1];
        for sine in sines {
            segment.add_sine(-sine.amplitude / omega, sine.phase, sine.rate / omega);
        }
        segment.sample_end(span, |i| sines[i].turned)
    }
}
