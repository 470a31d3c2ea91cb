//! The state of a plate with more digits: double-double numbers that carry their error, and whole numbers.

use std::cmp::Ordering;

use super::{Spread, TIME};
use crate::dd::Dd;
use crate::exact::Dyadic;
use crate::plate::number::{Ball, Number, Strikes, sooner};
use crate::plate::{Plate, PlateStart};

/// Binary digits of whole numbers at most: some 270 a strike are added, for about 1000 strikes, in less than a second.
const DIGITS: u64 = 300_000;

/// The state with more digits, from the first strike on.
#[derive(Debug, Clone)]
pub(super) struct Later {
    pub(super) word: Vec<u8>,
    strikes: Strikes<Ball<Dd>>,
    pub(super) v: [Ball<Dd>; 4],
    pub(super) p: [Ball<Dd>; 4],
    spread: Spread,
    /// Strikes since `spread` was made.
    since: f64,
    exact: Option<Box<Exact>>,
}

/// The state in whole numbers: velocities and intercepts over `scale`, and how intercepts change with the tilt that
/// settles ties.
#[derive(Debug, Clone)]
pub(super) struct Exact {
    strikes: Strikes<Dyadic>,
    v: [Dyadic; 4],
    p: [Dyadic; 4],
    nudge: [Dyadic; 4],
    scale: Dyadic,
    done: usize,
}

/// The next strike, as far as it is known: no corner where the train has ended.
pub(super) struct Found {
    pub(super) corner: Option<usize>,
    pub(super) tie: bool,
}

/// Returns the corner values of a start, with c from the plane of the others.
fn corners<T: Number>([a, b, d]: [f64; 3]) -> [T; 4] {
    let [a, b, d] = [a, b, d].map(T::exactly);
    let c = b.plus(&d).minus(&a);
    [a, b, c, d]
}

impl Exact {
    pub(super) fn new(plate: &Plate, start: &PlateStart) -> Self {
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

    /// Follows the strikes up to the end of a word, and returns whether that took no more digits than are allowed.
    pub(super) fn follow(&mut self, word: &[u8]) -> bool {
        for &j in &word[self.done..] {
            if self.v.iter().any(|v| v.bits() > DIGITS) {
                return false;
            }
            let j = usize::from(j);
            for x in [&mut self.v, &mut self.p, &mut self.nudge] {
                *x = self.strikes.strike(x, j);
            }
            if let Some(factor) = self.strikes.factor(j) {
                self.scale = self.scale.mul(factor);
            }
            self.done += 1;
        }
        true
    }

    pub(super) fn next(&self, last: Option<usize>) -> Found {
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

    /// Returns the values of corners, each to the digits of a double-double.
    fn rounded(&self, x: &[Dyadic; 4]) -> [Ball<Dd>; 4] {
        std::array::from_fn(|i| {
            let middle = x[i].over(&self.scale);
            Ball { middle, off: 1e-30 * middle.hi.abs() }
        })
    }
}

impl Later {
    pub(super) fn new(plate: &Plate, start: &PlateStart) -> Self {
        let [hx, hy] = start.ordering_gaps();
        let (v, p): ([Ball<Dd>; 4], [Ball<Dd>; 4]) = (corners(start.velocity), corners([0.0, hx, hy]));
        let spread = Self::spread(plate, &v, &p);
        Self { word: Vec::new(), strikes: Ball::strikes(plate), v, p, spread, since: 1.0, exact: None }
    }

    fn spread(plate: &Plate, v: &[Ball<Dd>; 4], p: &[Ball<Dd>; 4]) -> Spread {
        let [v, p] = [v, p].map(|x| x.map(|ball| ball.middle.hi));
        Spread::new(plate, v, p, 7.9e-31)
    }

    pub(super) fn last(&self) -> Option<usize> {
        self.word.last().map(|j| usize::from(*j))
    }

    /// Returns the next corner if double-double numbers leave no doubt, else `None`.
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
            if off > 1e-5 * TIME * time.max(self.spread.time) {
                return None;
            }
        }
        Some(found)
    }

    pub(super) fn time(&self, j: usize) -> f64 {
        -self.p[j].over(&self.v[j]).hi
    }

    /// Returns the next corner, if need be by whole numbers; `None` where these are too long.
    pub(super) fn next(&mut self, plate: &Plate, start: &PlateStart) -> Option<Found> {
        if self.word.is_empty() {
            return Some(Found { corner: Some(0), tie: false });
        }
        if let Some(found) = self.clear() {
            return Some(found);
        }
        let exact = self.exact.get_or_insert_with(|| Box::new(Exact::new(plate, start)));
        if !exact.follow(&self.word) {
            return None;
        }
        // The double-double numbers begin again from all digits.
        (self.v, self.p) = (exact.rounded(&exact.v), exact.rounded(&exact.p));
        let last = self.word.last().map(|j| usize::from(*j));
        let found = exact.next(last);
        (self.spread, self.since) = (Self::spread(plate, &self.v, &self.p), 1.0);
        Some(found)
    }

    pub(super) fn strike(&mut self, j: usize) {
        self.since += 1.0;
        let off = self.spread.after(self.since);
        for (x, most) in [&mut self.v, &mut self.p].into_iter().zip(off) {
            *x = self.strikes.strike(x, j).map(|ball| Ball { off: ball.off.min(most), ..ball });
        }
        #[expect(clippy::cast_possible_truncation, reason = "one of four corners")]
        self.word.push(j as u8);
    }

    /// Returns whether whole numbers were needed.
    #[cfg(test)]
    pub(super) fn is_exact(&self) -> bool {
        self.exact.is_some()
    }

    /// Returns the number of corners that may come down, without the one that has just struck.
    pub(super) fn falling(&self) -> usize {
        (0..4).filter(|i| Some(*i) != self.last() && self.v[*i].middle.hi < 0.0).count()
    }
}
