//! Pulses of finite length: shapes, trains, and the exact response to them.

use crate::forced::Segment;
use crate::peaks::{Range, Response};
use crate::suspension::{Modes, Motion, Phase};
use crate::{Error, State, Suspension};
use std::cmp::Ordering;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The classical pulse shapes, of amplitude a and duration D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// a sin(πt/D); area 2aD/π.
    HalfSine,
    /// a (1 − cos(2πt/D))/2; area aD/2.
    Haversine,
    /// Up to a at D/2 and down; area aD/2.
    Triangle,
    /// From a down to 0; area aD/2.
    InitialPeakSawtooth,
    /// From 0 up to a; area aD/2.
    TerminalPeakSawtooth,
    /// a; area aD.
    Rectangle,
    /// Up to a within `ramp` D, constant, and down within `ramp` D; area aD(1 − ramp).
    Trapezoid {
        /// Length of each ramp over that of the pulse, in (0, ½].
        ramp: f64,
    },
}

impl Shape {
    /// Velocity change over a D.
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
pub struct Pulse {
    /// Its shape.
    pub shape: Shape,
    /// Largest acceleration, with its sign.
    pub amplitude: f64,
    /// Length D > 0.
    pub duration: f64,
    /// When it begins.
    pub start: f64,
}

impl Pulse {
    /// Velocity change, the area of the pulse.
    #[must_use]
    pub fn velocity_change(&self) -> f64 {
        self.shape.area() * self.amplitude * self.duration
    }
}

/// A checked history of base acceleration: pulses that may overlap, or a piecewise linear history. Zero before and after.
#[derive(Debug, Clone, PartialEq)]
pub struct Pulses {
    pieces: Vec<Piece>,
    sines: Vec<SinePiece>,
    end: Instant,
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
    /// `t` + `fraction` · `duration`, the product rounded once.
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

/// What acts between two breakpoints.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    start: Instant,
    length: f64,
    /// Linear part at both ends.
    from: f64,
    to: f64,
    /// Sinusoids, a range of `sines`.
    sines: (usize, usize),
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct SinePiece {
    amplitude: f64,
    phase: f64,
    rate: f64,
}

#[derive(Debug, Clone, Copy)]
struct Term {
    start: Instant,
    end: Instant,
    law: Law,
}

#[derive(Debug, Clone, Copy)]
enum Law {
    Linear { from: f64, to: f64 },
    Sine { amplitude: f64, phase: f64, rate: f64 },
}

const PULSES: &str = "pulses";
const POINTS: &str = "history";

impl Pulses {
    /// A train of pulses, in any order; where they overlap they add up.
    ///
    /// # Errors
    ///
    /// [`Error::Empty`]; [`Error::ZeroDuration`] for a pulse of no length; [`Error::Entry`] for a value that is not finite, a
    /// negative duration or a ramp outside (0, ½].
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
            add_terms(p, &mut terms);
        }
        Ok(Self::from_terms(terms))
    }
    /// A piecewise linear history of (time, acceleration); two points at one time are a jump.
    ///
    /// # Errors
    ///
    /// [`Error::Empty`] below two points, [`Error::Entry`] for a value that is not finite, [`Error::TimeOrder`] where times run
    /// back, [`Error::ZeroDuration`] if all happens at one instant.
    pub fn piecewise_linear(points: &[(f64, f64)]) -> Result<Self, Error> {
        if points.len() < 2 {
            return Err(Error::Empty("a history of at least two points"));
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
    /// A piecewise linear history of points already checked: finite, in order of time.
    pub(crate) fn from_sorted(points: &[(f64, f64)]) -> Self {
        let pieces: Vec<Piece> = points
            .windows(2)
            .filter(|w| w[1].0 > w[0].0)
            .map(|w| Piece {
                start: Instant::at(w[0].0),
                length: w[1].0 - w[0].0,
                from: w[0].1,
                to: w[1].1,
                sines: (0, 0),
            })
            .collect();
        Self { pieces, sines: Vec::new(), end: Instant::at(points.last().map_or(0.0, |p| p.0)) }
    }
    /// Cuts time at every begin and end and sums what acts between.
    fn from_terms(mut terms: Vec<Term>) -> Self {
        terms.sort_by(|a, b| a.start.order(&b.start));
        let mut cuts: Vec<Instant> = terms.iter().flat_map(|t| [t.start, t.end]).collect();
        cuts.sort_by(Instant::order);
        cuts.dedup();
        let (mut pieces, mut sines) = (Vec::with_capacity(cuts.len()), Vec::new());
        let mut coming = terms.into_iter().peekable();
        let mut active: Vec<Term> = Vec::new();
        for cut in cuts.windows(2) {
            let (start, end) = (cut[0], cut[1]);
            active.retain(|t| t.end.order(&start) == Ordering::Greater);
            while let Some(term) = coming.next_if(|t| t.start.order(&start) != Ordering::Greater) {
                active.push(term);
            }
            let first_sine = sines.len();
            let (mut from, mut to) = (0.0, 0.0);
            for t in &active {
                match t.law {
                    Law::Linear { from: a, to: b } => {
                        let length = t.end.since(t.start);
                        let at = |instant: Instant| a + (b - a) * (instant.since(t.start) / length);
                        from += if t.start == start { a } else { at(start) };
                        to += if t.end == end { b } else { at(end) };
                    }
                    Law::Sine { amplitude, phase, rate } => {
                        sines.push(SinePiece { amplitude, phase: phase + rate * start.since(t.start), rate });
                    }
                }
            }
            pieces.push(Piece { start, length: end.since(start), from, to, sines: (first_sine, sines.len()) });
        }
        let end = cuts.last().copied().unwrap_or(Instant::at(0.0));
        Self { pieces, sines, end }
    }
    /// Peaks of the component's response, ring-down included. Interval i begins at the i-th begin or end of a part of a
    /// pulse.
    ///
    /// # Accuracy
    ///
    /// Within a few tens of roundings per pulse of the largest response, also at resonance with ζ = 0 and for pulses much
    /// shorter or longer than the period; peaks inside pulses are isolated by bounds on derivatives, never sampled.
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
        let mut ranges = [Range::default(); 3];
        let modes = Modes::new(suspension.damping());
        let omega = suspension.omega();
        let last = self.drive(&modes, omega, &[0, 1, 2], &mut ranges);
        for (k, range) in ranges.iter_mut().enumerate() {
            range.note_free(&modes, k, last, f64::INFINITY, self.pieces.len());
        }
        Response::from_ranges(omega, &ranges, |i| self.pieces.get(i).map_or(self.end.hi, |p| p.start.hi))
    }
    /// Motion relative to the base at the end of the last pulse.
    #[must_use]
    pub fn state_at_end(&self, suspension: &Suspension) -> State {
        let modes = Modes::new(suspension.damping());
        let omega = suspension.omega();
        let m = self.drive(&modes, omega, &[], &mut []);
        State { displacement: m.x / omega, velocity: modes.quantity(Modes::VELOCITY, m) }
    }
    /// The motion at the end of the last pulse; extremes until then of the quantities asked go into `ranges`.
    pub(crate) fn drive(&self, modes: &Modes, omega: f64, quantities: &[usize], ranges: &mut [Range]) -> Motion {
        let mut m = Motion::default();
        let mut segment = Segment::new(modes);
        for (i, piece) in self.pieces.iter().enumerate() {
            let span = Phase::product(omega, piece.length);
            segment.begin(m, -piece.from / omega, -(piece.to - piece.from) / (omega * span.hi), span.hi);
            for sine in &self.sines[piece.sines.0..piece.sines.1] {
                segment.add_sine(-sine.amplitude / omega, sine.phase, sine.rate / omega);
            }
            let end = segment.sample(span);
            for (&k, range) in quantities.iter().zip(ranges.iter_mut()) {
                segment.extremes(k, &end, i, range);
            }
            m = end.m;
        }
        m
    }
}

/// The parts of one pulse. Sinusoids are cut so that each part turns by half a circle at most.
fn add_terms(p: &Pulse, terms: &mut Vec<Term>) {
    let (a, d) = (p.amplitude, p.duration);
    let instant = |fraction: f64| Instant::after(p.start, fraction * d);
    let mut add = |from: f64, to: f64, law: Law| {
        let (start, end) = (instant(from), instant(to));
        if start.order(&end) == Ordering::Less {
            terms.push(Term { start, end, law });
        }
    };
    let line = |from, to| Law::Linear { from, to };
    match p.shape {
        Shape::HalfSine => add(0.0, 1.0, Law::Sine { amplitude: a, phase: 0.0, rate: PI / d }),
        Shape::Haversine => {
            add(0.0, 1.0, line(0.5 * a, 0.5 * a));
            add(0.0, 0.5, Law::Sine { amplitude: -0.5 * a, phase: FRAC_PI_2, rate: TAU / d });
            add(0.5, 1.0, Law::Sine { amplitude: -0.5 * a, phase: PI + FRAC_PI_2, rate: TAU / d });
        }
        Shape::Triangle => {
            add(0.0, 0.5, line(0.0, a));
            add(0.5, 1.0, line(a, 0.0));
        }
        Shape::InitialPeakSawtooth => add(0.0, 1.0, line(a, 0.0)),
        Shape::TerminalPeakSawtooth => add(0.0, 1.0, line(0.0, a)),
        Shape::Rectangle => add(0.0, 1.0, line(a, a)),
        Shape::Trapezoid { ramp } => {
            add(0.0, ramp, line(0.0, a));
            add(ramp, 1.0 - ramp, line(a, a));
            add(1.0 - ramp, 1.0, line(a, 0.0));
        }
    }
}
