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

use std::cmp::Ordering;

use super::number::{Ball, Number, Strikes, sooner};
use super::{Corner, Plate, PlateStart};
use crate::dd::Dd;
use crate::exact::Dyadic;

/// One impact of a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateImpact {
    /// From 1.
    pub number: u64,
    /// The corner that strikes.
    pub corner: Corner,
    /// Since the first contact, in gaps over velocities.
    pub time: f64,
    /// Velocity of the corner just before, negative.
    pub approach: f64,
    /// Jumps of the velocities of corners a, b, c and d.
    pub delta_v: [f64; 4],
    /// Whether another corner comes down at the very same instant. The order is then that of a tilt that differs by next
    /// to nothing: h_d larger, or from h_b = 0 on h_b larger.
    pub tie: bool,
}

impl PlateImpact {
    /// Velocity shock at the place (x, y) in [−1, 1]²: the plane through the jumps of the corners.
    #[must_use]
    pub fn delta_v_at(&self, [x, y]: [f64; 2]) -> f64 {
        let [a, b, c, d] = self.delta_v;
        0.25 * ((1.0 - y) * ((1.0 - x) * a + (1.0 + x) * b) + (1.0 + y) * ((1.0 - x) * d + (1.0 + x) * c))
    }
}

/// Iterator over the impacts of a plate; without end where the train is endless. Made by [`Plate::train`].
#[derive(Debug, Clone)]
pub struct PlateTrain {
    plate: Plate,
    start: PlateStart,
    number: u64,
    steps: Steps,
    later: Option<Box<Later>>,
    undecided: bool,
}

/// The state in plain floats, and which corner is next.
#[derive(Debug, Clone)]
struct Steps {
    v: [f64; 4],
    p: [f64; 4],
    next: Next,
    /// Of the next strike, and of the latest.
    time: f64,
    latest: f64,
    tie: bool,
    /// Strikes so far.
    strikes: f64,
    spread: Spread,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Next {
    Corner(usize),
    End,
    Doubt,
}

/// Bounds of what the values of corners are off by after some strikes.
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
        let [kx, ky] = plate.gyration;
        let weight = plate.weight.iter().fold(0.0, |most: f64, w| most.max(*w));
        let norms = [v, p].map(|x| plate.norm(x));
        Self {
            base: 2.0 * libm::hypot(1.0, libm::hypot(kx, ky)) + 1.0,
            unit: norms.map(|norm| 8.0 * rounding * weight * norm),
            time: norms[1] / norms[0],
        }
    }
    #[inline]
    fn after(&self, strikes: f64) -> [f64; 2] {
        let grown = strikes * (strikes + self.base);
        self.unit.map(|unit| unit * grown)
    }
}

/// A time that may be off by more than this of itself, or of the drop's own, is worked out with more digits.
const TIME: f64 = 1e-10;
/// Strikes that whole numbers follow: their digits grow by some 270 bits a strike.
const EXACT: usize = 2000;

impl Steps {
    #[inline]
    fn strike(&mut self, plate: &Plate, j: usize) {
        let (jump, u, s) = (&plate.jump[j], self.v[j], self.p[j]);
        for i in 0..4 {
            self.v[i] -= jump[i] * u;
            self.p[i] -= jump[i] * s;
        }
        (self.v[j], self.p[j]) = (-plate.e * u, -plate.e * s);
        self.latest = self.time;
        self.strikes += 1.0;
        self.choose(j);
    }

    #[inline]
    fn choose(&mut self, last: usize) {
        let [dv, dp] = self.spread.after(self.strikes);
        let (mut times, mut off, mut sure) = ([f64::INFINITY; 4], [0.0; 4], true);
        for i in 0..4 {
            let inverse = -1.0 / self.v[i];
            let time = self.p[i] * inverse;
            sure &= self.v[i].abs() > 2.0 * dv || i == last;
            let falls = self.v[i] < 0.0;
            times[i] = if falls { time } else { f64::INFINITY };
            off[i] = if falls { 2.0 * (dp + time * dv) * inverse } else { 0.0 };
        }
        let earlier = |i: usize, j: usize| if times[j] < times[i] { j } else { i };
        let best = earlier(earlier(0, 1), earlier(2, 3));
        let latest = times[best] + off[best];
        for i in 0..4 {
            sure &= times[i] - off[i] > latest || i == best || times[i].is_infinite();
        }
        sure &= off[best] <= TIME * times[best].max(self.spread.time);
        self.next = match (sure, times[best] < f64::INFINITY) {
            (false, _) => Next::Doubt,
            (true, true) => Next::Corner(best),
            (true, false) => Next::End,
        };
        self.time = if times[best] < f64::INFINITY { times[best].max(self.time) } else { self.time };
    }
}

/// The state with more digits, from the first strike on.
#[derive(Debug, Clone)]
struct Later {
    word: Vec<u8>,
    strikes: Strikes<Ball<Dd>>,
    v: [Ball<Dd>; 4],
    p: [Ball<Dd>; 4],
    spread: Spread,
    /// Strikes since `spread` was made.
    since: f64,
    exact: Option<Box<Exact>>,
}

/// The state in whole numbers: velocities and intercepts over `scale`, and how intercepts change with the tilt that
/// settles ties.
#[derive(Debug, Clone)]
struct Exact {
    strikes: Strikes<Dyadic>,
    v: [Dyadic; 4],
    p: [Dyadic; 4],
    nudge: [Dyadic; 4],
    scale: Dyadic,
    done: usize,
}

/// Where the corners are at the latest strike, and by how much that may be off.
pub(super) struct Heights {
    pub(super) time: f64,
    pub(super) heights: [f64; 4],
    pub(super) off: f64,
}

/// What comes next, as far as it is known: none where the train has ended.
struct Found {
    corner: Option<usize>,
    tie: bool,
}

/// Corner values of a start, with c from the plane of the others.
fn corners<T: Number>([a, b, d]: [f64; 3]) -> [T; 4] {
    let [a, b, d] = [a, b, d].map(T::exactly);
    let c = b.plus(&d).minus(&a);
    [a, b, c, d]
}

impl Exact {
    fn new(plate: &Plate, start: &PlateStart) -> Self {
        let heights = |[hx, hy]: [f64; 2]| corners([0.0, hx, hy]);
        Self {
            strikes: Dyadic::strikes(plate),
            v: corners(start.velocity),
            p: heights(start.ordering_gaps()),
            nudge: heights(start.nudge()),
            scale: Dyadic::exactly(1.0),
            done: 0,
        }
    }

    /// On to the end of a word.
    fn follow(&mut self, word: &[u8]) {
        for &j in &word[self.done..] {
            let j = usize::from(j);
            for x in [&mut self.v, &mut self.p, &mut self.nudge] {
                *x = self.strikes.strike(x, j);
            }
            if let Some(factor) = self.strikes.factor(j) {
                self.scale = self.scale.mul(factor);
            }
        }
        self.done = word.len();
    }

    fn next(&self, last: Option<usize>) -> Found {
        let falling = (0..4).filter(|i| Some(*i) != last && self.v[*i].sign() == Ordering::Less);
        let mut found = Found { corner: None, tie: false };
        for i in falling {
            let Some(best) = found.corner else {
                found.corner = Some(i);
                continue;
            };
            // Most times differ in the digits of a double-double.
            let times = [i, best].map(|k| self.p[k].over(&self.v[k]));
            let apart = (times[1] - times[0]).hi;
            let order = if apart.abs() > 1e-28 * times[0].hi.abs().max(times[1].hi.abs()) {
                apart.total_cmp(&0.0)
            } else {
                sooner(&self.v, &self.p, i, best).unwrap_or(Ordering::Equal)
            };
            match order {
                Ordering::Less => found = Found { corner: Some(i), tie: false },
                Ordering::Equal => {
                    let nudged = sooner(&self.v, &self.nudge, i, best);
                    found = Found { corner: Some(if nudged == Some(Ordering::Less) { i } else { best }), tie: true };
                }
                Ordering::Greater => {}
            }
        }
        found
    }

    /// The values of corners, each to the digits of a double-double.
    fn rounded(&self, x: &[Dyadic; 4]) -> [Ball<Dd>; 4] {
        std::array::from_fn(|i| {
            let middle = x[i].over(&self.scale);
            Ball { middle, off: 1e-30 * middle.hi.abs() }
        })
    }
}

impl Later {
    fn new(plate: &Plate, start: &PlateStart) -> Self {
        let [hx, hy] = start.ordering_gaps();
        let (v, p): ([Ball<Dd>; 4], [Ball<Dd>; 4]) = (corners(start.velocity), corners([0.0, hx, hy]));
        let spread = Self::spread(plate, &v, &p);
        Self { word: Vec::new(), strikes: Ball::strikes(plate), v, p, spread, since: 1.0, exact: None }
    }

    fn spread(plate: &Plate, v: &[Ball<Dd>; 4], p: &[Ball<Dd>; 4]) -> Spread {
        let [v, p] = [v, p].map(|x| x.map(|ball| ball.middle.hi));
        Spread::new(plate, v, p, 7.9e-31)
    }

    fn last(&self) -> Option<usize> {
        self.word.last().map(|j| usize::from(*j))
    }

    /// The next corner without a doubt; `None` where double-double numbers leave one.
    fn clear(&self) -> Option<Found> {
        let (mut found, last) = (Found { corner: None, tie: false }, self.last());
        for i in (0..4).filter(|i| Some(*i) != last) {
            if self.v[i].sign()? == Ordering::Less {
                let first = match found.corner {
                    Some(best) => sooner(&self.v, &self.p, i, best)? == Ordering::Less,
                    None => true,
                };
                found.corner = if first { Some(i) } else { found.corner };
            }
        }
        if let Some(j) = found.corner {
            let (time, [v, p]) = (self.time(j), [self.v[j], self.p[j]]);
            let off = 2.0 * (p.off + time * v.off) / v.middle.hi.abs();
            if off > 1e-2 * TIME * time.max(self.spread.time) {
                return None;
            }
        }
        Some(found)
    }

    fn time(&self, j: usize) -> f64 {
        -self.p[j].over(&self.v[j]).hi
    }

    /// The next corner, at last by whole numbers; `None` where these are too long.
    fn next(&mut self, plate: &Plate, start: &PlateStart) -> Option<Found> {
        if self.word.is_empty() {
            return Some(Found { corner: Some(0), tie: false });
        }
        if let Some(found) = self.clear() {
            return Some(found);
        }
        if self.word.len() > EXACT {
            return None;
        }
        let exact = self.exact.get_or_insert_with(|| Box::new(Exact::new(plate, start)));
        exact.follow(&self.word);
        // From here on with all digits again.
        (self.v, self.p) = (exact.rounded(&exact.v), exact.rounded(&exact.p));
        let last = self.word.last().map(|j| usize::from(*j));
        let found = exact.next(last);
        (self.spread, self.since) = (Self::spread(plate, &self.v, &self.p), 1.0);
        Some(found)
    }

    fn strike(&mut self, j: usize) {
        self.since += 1.0;
        let off = self.spread.after(self.since);
        for (x, most) in [&mut self.v, &mut self.p].into_iter().zip(off) {
            *x = self.strikes.strike(x, j).map(|ball| Ball { off: ball.off.min(most), ..ball });
        }
        #[expect(clippy::cast_possible_truncation, reason = "one of four corners")]
        self.word.push(j as u8);
    }

    /// How many corners may come down, the one that has just struck left out.
    fn falling(&self) -> usize {
        (0..4).filter(|i| Some(*i) != self.last() && self.v[*i].middle.hi < 0.0).count()
    }
}

impl PlateTrain {
    /// Whether the train was given up: more than 2000 strikes, and a doubt about the next corner that double-double
    /// numbers leave.
    #[must_use]
    pub fn undecided(&self) -> bool {
        self.undecided
    }

    /// Velocities of the corners after the impacts so far.
    #[must_use]
    pub fn velocities(&self) -> [f64; 4] {
        self.later.as_ref().map_or(self.steps.v, |later| later.v.map(|ball| ball.middle.hi))
    }

    /// Heights at time 0 of the lines along which the corners now move.
    pub(super) fn intercepts(&self) -> [f64; 4] {
        self.later.as_ref().map_or(self.steps.p, |later| later.p.map(|ball| ball.middle.hi))
    }

    /// Heights at the latest strike.
    pub(super) fn heights(&self) -> Heights {
        let largest = |p: &[f64; 4]| p.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        let Some(later) = &self.later else {
            let Steps { v, p, latest, .. } = &self.steps;
            let heights = std::array::from_fn(|i| p[i] + v[i] * latest);
            return Heights { time: *latest, heights, off: 1e-14 * largest(p) };
        };
        let (p, j) = (later.p.map(|ball| ball.middle), later.last().unwrap_or(0));
        let time = if later.v[j].middle.hi > 0.0 {
            Dd::ZERO - later.p[j].over(&later.v[j])
        } else {
            Dd::from(self.steps.latest)
        };
        let heights = std::array::from_fn(|i| (p[i] + later.v[i].middle * time).hi);
        Heights { time: time.hi, heights, off: 1e-27 * largest(&p.map(|p| p.hi)) }
    }

    /// Whether the plate has bounced clear: no impact is left.
    pub(super) fn ended(&self) -> bool {
        let mut ahead = self.clone();
        ahead.next().is_none() && !ahead.undecided
    }

    #[cold]
    fn begin_later(&mut self) {
        let (plate, start) = (self.plate, self.start);
        let mut later = Box::new(Later::new(&plate, &start));
        for _ in 0..self.number {
            if let Some(Found { corner: Some(j), .. }) = later.next(&plate, &start) {
                later.strike(j);
            }
        }
        self.later = Some(later);
    }

    fn later_next(&mut self) -> Option<PlateImpact> {
        let later = self.later.as_mut()?;
        let Some(found) = later.next(&self.plate, &self.start) else {
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
        Some(self.impact(j, time, approach, tie))
    }

    #[inline]
    fn impact(&mut self, j: usize, time: f64, approach: f64, tie: bool) -> PlateImpact {
        self.number += 1;
        let delta_v = self.plate.jump[j].map(|jump| -jump * approach);
        PlateImpact { number: self.number, corner: Corner::ALL[j], time, approach, delta_v, tie }
    }
}

impl Iterator for PlateTrain {
    type Item = PlateImpact;

    #[inline]
    fn next(&mut self) -> Option<PlateImpact> {
        if self.later.is_none() {
            match self.steps.next {
                Next::Corner(j) => {
                    let (time, approach) = (self.steps.time, self.steps.v[j]);
                    let tie = self.number == 0 && self.steps.tie;
                    self.steps.strike(&self.plate, j);
                    return Some(self.impact(j, time, approach, tie));
                }
                Next::End => return None,
                Next::Doubt => self.begin_later(),
            }
        }
        self.later_next()
    }
}

impl Plate {
    /// The impacts of one drop, corner a first, by themselves.
    ///
    /// # Method
    /// See the module: no corner is taken to be next while roundings leave a doubt. Ties are told and settled by the
    /// limit of a tilt that differs by next to nothing; a flat drop is the limit of a vanishing tilt along the diagonal,
    /// strike by strike at time 0.
    ///
    /// # Accuracy
    /// The order is exact. Velocities to 1e−11 of the largest at the start, times to 1e−10 of the larger of themselves
    /// and the time in which the gaps close.
    ///
    /// # Examples
    /// A uniform plate that lands with b twice as high as d:
    /// ```
    /// use clatter::{Plate, PlateStart};
    /// let train = Plate::uniform(0.5)?.train(&PlateStart::level([2.0, 1.0])?);
    /// let word: String = train.map(|impact| impact.corner.letter()).collect();
    /// assert_eq!(word, "adcbad");
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn train(&self, start: &PlateStart) -> PlateTrain {
        let v = start.velocities();
        let [hx, hy] = start.ordering_gaps();
        let p = [0.0, hx, hx + hy, hy];
        let at_once = [(hx, v[1]), (hx + hy, v[2]), (hy, v[3])];
        let tie = start.is_flat() || at_once.iter().any(|(gap, v)| *gap == 0.0 && *v < 0.0);
        let next = if start.is_flat() { Next::Doubt } else { Next::Corner(0) };
        let spread = Spread::new(self, v, p, f64::EPSILON / 2.0);
        let steps = Steps { v, p, next, time: 0.0, latest: 0.0, tie, strikes: 1.0, spread };
        PlateTrain { plate: *self, start: *start, number: 0, steps, later: None, undecided: false }
    }
}
