//! The train of a plate, impact by impact.
//!
//! Plain floats choose the next corner where bounds of their roundings leave no doubt; then double-double numbers that
//! carry their own error; at last whole numbers, in which a tie is a tie. As no strike makes velocities or intercepts
//! larger, neither grow their errors: after n strikes those of corners are at most
//!
//! ```text
//! 8 u w n (2K + n + 1) times the norm of the start,   K² = 1 + k_x² + k_y², w = max w_j(j)
//! ```
//!
//! with u the rounding of one operation: each of n steps adds 7 u √w of the norm to the value of a corner, of which up to
//! 2K goes into the motion of a plane and the rest, which is none, kicks that motion once a strike.

mod later;
#[cfg(test)]
mod tests;

use super::number::Number;
use super::{Corner, Plate, PlateStart};
use crate::dd::Dd;
use later::{Found, Later};

/// One impact of a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlateImpact {
    /// Number of the impact, from 1.
    pub number: u64,
    /// The corner that strikes.
    pub corner: Corner,
    /// Time since the first contact, in gaps over velocities.
    pub time: f64,
    /// Velocity of the corner just before, negative.
    pub approach: f64,
    /// Jumps of the velocities of corners a, b, c and d.
    pub delta_v: [f64; 4],
    /// True if another corner comes down at the very same instant. The order is then that of a tilt that differs by
    /// next to nothing: h_d larger, or from h_b = 0 on h_b larger.
    pub tie: bool,
}

impl PlateImpact {
    /// Returns the velocity shock at the place (x, y) in [−1, 1]²: the plane through the jumps of the corners.
    #[must_use]
    pub fn delta_v_at(&self, [x, y]: [f64; 2]) -> f64 {
        let [a, b, c, d] = self.delta_v;
        0.25 * ((1.0 - y) * ((1.0 - x) * a + (1.0 + x) * b) + (1.0 + y) * ((1.0 - x) * d + (1.0 + x) * c))
    }
}

/// Iterator over the impacts of a plate; without end where the train is endless. Made by [`Plate::train`].
#[derive(Debug, Clone)]
pub struct PlateTrain<'a> {
    plate: &'a Plate,
    start: PlateStart,
    number: u64,
    steps: Steps,
    later: Option<Box<Later>>,
    undecided: bool,
}

/// The state in plain floats, and the next corner.
#[derive(Debug, Clone)]
struct Steps {
    v: [f64; 4],
    p: [f64; 4],
    next: Next,
    /// Times of the next strike and of the latest one.
    time: f64,
    latest: f64,
    tie: bool,
    /// Number of strikes so far.
    strikes: f64,
    spread: Spread,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Next {
    Corner(usize),
    End,
    Doubt,
}

/// Bounds of the errors of corner values after some strikes.
#[derive(Debug, Clone, Copy)]
struct Spread {
    /// 2K + 1.
    base: f64,
    /// 8 u w times the norm, of velocities and intercepts.
    unit: [f64; 2],
    /// A time that matters: norm of heights over norm of velocities.
    time: f64,
}

impl Spread {
    fn new(plate: &Plate, v: [f64; 4], p: [f64; 4], rounding: f64) -> Self {
        let norms = [v, p].map(|x| plate.norm(x));
        Self {
            base: plate.spread,
            unit: norms.map(|norm| 8.0 * rounding * plate.heaviest * norm),
            time: norms[1] / norms[0],
        }
    }
    #[inline]
    fn after(&self, strikes: f64) -> [f64; 2] {
        let grown = strikes * (strikes + self.base);
        self.unit.map(|unit| unit * grown)
    }
}

/// A time whose bound of error is above this share of itself, or of the time scale of the drop, is computed with more
/// digits. Roundings hardly ever add up to their bound: times that pass are off by less than 1e−10.
const TIME: f64 = 1e-8;

/// Returns the larger of two numbers, neither of them NaN.
#[inline]
fn most(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

/// Factors of the old velocities, by the corner that strikes: 0 for that corner, 1 for the others.
const KEEP: [[f64; 4]; 4] = [[0.0, 1.0, 1.0, 1.0], [1.0, 0.0, 1.0, 1.0], [1.0, 1.0, 0.0, 1.0], [1.0, 1.0, 1.0, 0.0]];

impl Steps {
    /// Applies a strike at corner j, chooses the next corner, and returns the jumps of all corners.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "as `next`")]
    fn strike(&mut self, plate: &Plate, j: usize) -> [f64; 4] {
        let (jump, u, s) = (&plate.jump[j], self.v[j], self.p[j]);
        let delta_v = jump.map(|jump| -jump * u);
        // All four at a time: x_j goes to 0 x_j − e x_j.
        let (keep, change) = (&KEEP[j], &plate.change[j]);
        self.v = std::array::from_fn(|i| keep[i] * self.v[i] - change[i] * u);
        self.p = std::array::from_fn(|i| keep[i] * self.p[i] - change[i] * s);
        self.latest = self.time;
        self.strikes += 1.0;
        self.choose(j);
        delta_v
    }

    /// Chooses the next corner after a strike at `last`, or a doubt where another may come before it. The choice is a
    /// branch, so that the processor goes on with the likely one while roundings are checked.
    #[inline(always)]
    #[expect(clippy::needless_bitwise_bool, reason = "each is cheaper than a branch")]
    #[expect(clippy::inline_always, reason = "as `next`")]
    fn choose(&mut self, last: usize) {
        let (v, p, [dv, dp]) = (&self.v, &self.p, self.spread.after(self.strikes).map(|off| 2.0 * off));
        let (mut time, mut next) = (f64::INFINITY, 4);
        for i in 0..4 {
            if v[i] < 0.0 {
                let own = -p[i] / v[i];
                if own < time {
                    (time, next) = (own, i);
                }
            }
        }
        // A corner that moves by no more than its roundings may fall or not.
        let stands = (0..4).fold(false, |stands, i| stands | ((v[i].abs() <= dv) & (i != last)));
        let off = |i: usize, time: f64| (dp + time * dv) / v[i].abs();
        if next == 4 {
            self.next = if stands { Next::Doubt } else { Next::End };
            return;
        }
        let end = time + off(next, time);
        // At that time no other corner is at the ground or below, even with all roundings.
        let clear =
            (0..4).fold(true, |clear, i| clear & ((p[i] + end * v[i] > dp + end * dv) | (i == next) | (i == last)));
        let exact = end - time <= TIME * most(time, self.spread.time);
        self.next = if clear & exact & !stands { Next::Corner(next) } else { Next::Doubt };
        self.time = most(time, self.latest);
    }
}

/// Heights of the corners at the latest strike, and a bound on their error.
pub(super) struct Heights {
    pub(super) time: f64,
    pub(super) corners: [f64; 4],
    pub(super) off: f64,
}

impl PlateTrain<'_> {
    /// Returns whether the train was given up: double-double numbers leave a doubt about the next corner, and whole
    /// ones have got too long, after some 1000 strikes.
    #[must_use]
    pub fn undecided(&self) -> bool {
        self.undecided
    }

    /// Returns the velocities of the corners after the impacts so far.
    #[must_use]
    pub fn velocities(&self) -> [f64; 4] {
        self.later.as_ref().map_or(self.steps.v, |later| later.v.map(|ball| ball.middle.hi))
    }

    /// Returns the heights, extrapolated to time 0, of the lines along which the corners now move.
    pub(super) fn intercepts(&self) -> [f64; 4] {
        self.later.as_ref().map_or(self.steps.p, |later| later.p.map(|ball| ball.middle.hi))
    }

    /// Returns the heights at the latest strike.
    pub(super) fn heights(&self) -> Heights {
        let largest = |p: &[f64; 4]| p.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        let Some(later) = &self.later else {
            let Steps { v, p, latest, .. } = &self.steps;
            let heights = std::array::from_fn(|i| p[i] + v[i] * latest);
            return Heights { time: *latest, corners: heights, off: 1e-14 * largest(p) };
        };
        let (p, j) = (later.p.map(|ball| ball.middle), later.last().unwrap_or(0));
        let time = if later.v[j].middle.hi > 0.0 {
            Dd::ZERO - later.p[j].over(&later.v[j])
        } else {
            Dd::from(self.steps.latest)
        };
        let heights = std::array::from_fn(|i| (p[i] + later.v[i].middle * time).hi);
        Heights { time: time.hi, corners: heights, off: 1e-27 * largest(&p.map(|p| p.hi)) }
    }

    /// Returns whether the plate has bounced clear: no impact is left.
    pub(super) fn ended(&self) -> bool {
        let mut ahead = self.clone();
        ahead.next().is_none() && !ahead.undecided
    }

    #[cold]
    fn begin_later(&mut self) {
        let (plate, start) = (self.plate, self.start);
        let mut later = Box::new(Later::new(plate, &start));
        for _ in 0..self.number {
            if let Some(Found { corner: Some(j), .. }) = later.next(plate, &start) {
                later.strike(j);
            }
        }
        self.later = Some(later);
    }

    #[cold]
    fn later_next(&mut self) -> Option<PlateImpact> {
        let later = self.later.as_mut()?;
        let Some(found) = later.next(self.plate, &self.start) else {
            self.undecided = true;
            return None;
        };
        let j = found.corner?;
        let approach = later.v[j].middle.hi;
        let flat = self.start.is_flat();
        let time = if flat { 0.0 } else { later.time(j).max(self.steps.latest) };
        let tie = if flat { later.falling() > 1 } else { found.tie || (self.number == 0 && self.steps.tie) };
        later.strike(j);
        self.steps.latest = time;
        let delta_v = self.plate.jump[j].map(|jump| -jump * approach);
        Some(self.impact(j, time, approach, delta_v, tie))
    }

    #[inline]
    fn impact(&mut self, j: usize, time: f64, approach: f64, delta_v: [f64; 4], tie: bool) -> PlateImpact {
        self.number += 1;
        PlateImpact { number: self.number, corner: Corner::ALL[j], time, approach, delta_v, tie }
    }
}

impl Iterator for PlateTrain<'_> {
    type Item = PlateImpact;

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "through memory, an impact takes longer")]
    fn next(&mut self) -> Option<PlateImpact> {
        if self.later.is_none() {
            match self.steps.next {
                Next::Corner(j) => {
                    let (time, approach) = (self.steps.time, self.steps.v[j]);
                    let tie = self.number == 0 && self.steps.tie;
                    let delta_v = self.steps.strike(self.plate, j);
                    return Some(self.impact(j, time, approach, delta_v, tie));
                }
                Next::End => return None,
                Next::Doubt => self.begin_later(),
            }
        }
        self.later_next()
    }
}

impl Plate {
    /// Returns the impacts of one drop, corner a first, by themselves.
    ///
    /// # Method
    /// As the module says, no corner counts as the next while roundings leave a doubt. Ties are reported, and settled
    /// by the limit of a tilt that differs by next to nothing; a flat drop is the limit of a vanishing tilt along the
    /// diagonal, strike by strike at time 0.
    ///
    /// # Accuracy
    /// The order is exact. Velocities are exact to 1e−11 of the largest at the start, times to 1e−10 of the larger of
    /// themselves and the time in which the gaps close (1e−8 proven).
    ///
    /// # Examples
    /// A uniform plate strikes with b twice as high as d:
    /// ```
    /// use clatter::{Plate, PlateStart};
    /// let plate = Plate::uniform(0.5)?;
    /// let train = plate.train(&PlateStart::level([2.0, 1.0])?);
    /// let word: String = train.map(|impact| impact.corner.letter()).collect();
    /// assert_eq!(word, "adcabc");
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn train(&self, start: &PlateStart) -> PlateTrain<'_> {
        let v = start.velocities();
        let [hx, hy] = start.ordering_gaps();
        let p = [0.0, hx, hx + hy, hy];
        let at_once = [(hx, v[1]), (hx + hy, v[2]), (hy, v[3])];
        let tie = start.is_flat() || at_once.iter().any(|(gap, v)| *gap == 0.0 && *v < 0.0);
        let next = if start.is_flat() { Next::Doubt } else { Next::Corner(0) };
        let spread = Spread::new(self, v, p, f64::EPSILON / 2.0);
        let steps = Steps { v, p, next, time: 0.0, latest: 0.0, tie, strikes: 1.0, spread };
        PlateTrain { plate: self, start: *start, number: 0, steps, later: None, undecided: false }
    }
}
