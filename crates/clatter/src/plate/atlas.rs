//! The atlas: the words that every direction of tilt leads to, from pure translation.
//!
//! Let r = h_d/(h_b + h_d) be the direction, 0 where a and d land together, 1 where a and b do, ½ on the diagonal. After
//! a word of corners the velocities are numbers that do not depend on r, and the intercepts are linear in it. So the time
//! −p_i(r)/v_i of each falling corner is a straight line, the corner that comes next is the lowest line, and the
//! directions that lead to one word are an interval whose ends are where two lines meet. Followed word by word, all
//! directions are covered by finitely many words, as long as these end. The largest shock of all directions is the
//! largest of the list: proven, not searched.
//!
//! Signs are those of numbers that carry their error, in plain floats, then double-double, at last in whole numbers.

use std::cmp::Ordering;

use super::number::{Ball, Number, Strikes};
use super::{Corner, Plate, PlateShocks};
use crate::Error;
use crate::dd::Dd;
use crate::exact::Dyadic;

/// The directions of tilt that lead to one word of corners.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Word {
    /// Begin of the interval of directions r = h_d/(h_b + h_d).
    pub from: f64,
    /// End of the interval, and begin of that of the next word.
    pub to: f64,
    /// The corners in the order in which they strike.
    pub corners: Vec<Corner>,
    /// True if the plate has bounced clear after them; else the train was followed no further.
    pub ended: bool,
    /// Largest shocks of corners a, b, c and d in their own strikes; 0 for a corner that does not strike.
    pub struck: [f64; 4],
    /// Largest shock of the center of mass.
    pub center: f64,
    /// Bound on the shock of a corner in strikes after the word; 0 where it has ended.
    pub later: f64,
}

impl Word {
    /// Returns the largest shock of a corner in its own strikes.
    #[must_use]
    pub fn peak(&self) -> f64 {
        self.struck.into_iter().fold(0.0, f64::max)
    }
}

/// Largest shocks over all directions of tilt.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AtlasPeak {
    /// Largest shock of a corner in its own strikes.
    pub corner: f64,
    /// Largest shock of the center of mass.
    pub center: f64,
    /// Bound on the shock of a corner in strikes that were not followed. Where it is not above `corner`, the worst case
    /// is proven.
    pub later: f64,
}

/// All words over the directions of tilt, corner a first. Made by [`Plate::atlas`].
#[derive(Debug, Clone, PartialEq)]
pub struct Atlas {
    plate: Plate,
    words: Vec<Word>,
}

/// The largest number of words; intervals beyond are followed no further.
const WORDS: usize = 1 << 16;

impl Atlas {
    /// Returns the words in the order of their directions, from r = 0 to r = 1.
    #[must_use]
    pub fn words(&self) -> &[Word] {
        &self.words
    }

    /// Returns the largest shocks over all directions. For a centered plate they are those of any first corner, because
    /// each corner is the mirror image of a.
    #[must_use]
    pub fn peak(&self) -> AtlasPeak {
        let most = |of: fn(&Word) -> f64| self.words.iter().map(of).fold(0.0, f64::max);
        AtlasPeak { corner: most(Word::peak), center: most(|word| word.center), later: most(|word| word.later) }
    }

    /// Returns the largest shocks of every corner in its own strikes over all directions, corner a first.
    #[must_use]
    pub fn shocks(&self) -> PlateShocks {
        let struck = std::array::from_fn(|j| self.words.iter().map(|word| word.struck[j]).fold(0.0, f64::max));
        PlateShocks::new(&self.plate, struck, self.peak().later)
    }
}

impl Plate {
    /// Returns the atlas of this plate, from pure translation at unit speed with corner a first. Each word is followed
    /// for at most `limit` strikes.
    ///
    /// # Accuracy
    /// The list of words is exact; ends of intervals are rounded to a few ε of 1, shocks to 1e−12 of the largest.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the limit is in [1, 100].
    ///
    /// # Examples
    /// A uniform plate at e = 0.5 has seven words. In the middle third of the directions it rocks along its diagonal,
    /// and the hardest shocks are there:
    /// ```
    /// let atlas = clatter::Plate::uniform(0.5)?.atlas(40)?;
    /// assert_eq!(atlas.words().len(), 7);
    /// let middle = atlas.words().iter().find(|word| word.to > 0.5).unwrap();
    /// let word: String = middle.corners.iter().map(|corner| corner.letter()).collect();
    /// assert_eq!(word, "acaca");
    /// assert_eq!(middle.peak(), atlas.peak().corner);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn atlas(&self, limit: usize) -> Result<Atlas, Error> {
        if !(1..=100).contains(&limit) {
            #[expect(clippy::cast_precision_loss, reason = "told in a message")]
            let value = limit as f64;
            return Err(Error::Quantity { name: "limit of strikes", value, allowed: "in [1, 100]" });
        }
        let words = Survey::<Ball<f64>>::words(self, limit)
            .or_else(|| Survey::<Ball<Dd>>::words(self, limit))
            .or_else(|| Survey::<Dyadic>::words(self, limit));
        // Whole numbers leave no doubt.
        Ok(Atlas { plate: *self, words: words.unwrap_or_default() })
    }

    /// Returns the largest shocks over all directions of tilt and whichever corner strikes first, from pure
    /// translation. Each word is followed for at most `limit` strikes.
    ///
    /// # Errors
    /// Those of [`Plate::atlas`].
    pub fn worst(&self, limit: usize) -> Result<PlateShocks, Error> {
        let first = self.atlas(limit)?.shocks();
        if self.is_centered() {
            let most = first.struck().into_iter().fold(0.0, f64::max);
            return Ok(PlateShocks::new(self, [most; 4], first.later()));
        }
        // In a mirror another corner is a.
        let (x, y) = (self.mirrored_x(), self.mirrored_y());
        let (mut struck, mut later) = (first.struck(), first.later());
        for (plate, names) in [(x, [1, 0, 3, 2]), (y, [3, 2, 1, 0]), (x.mirrored_y(), [2, 3, 0, 1])] {
            let shocks = plate.atlas(limit)?.shocks();
            for (own, shock) in names.into_iter().zip(shocks.struck()) {
                struck[own] = shock.max(struck[own]);
            }
            later = shocks.later().max(later);
        }
        Ok(PlateShocks::new(self, struck, later))
    }
}

/// A direction n/d with d > 0.
#[derive(Debug, Clone)]
struct Direction<T> {
    n: T,
    d: T,
}

impl<T: Number> Direction<T> {
    /// Returns the sign of r − s.
    fn compare(&self, o: &Self) -> Option<Ordering> {
        self.n.times(&o.d).minus(&o.n.times(&self.d)).sign()
    }
    fn value(&self) -> f64 {
        self.n.over(&self.d).hi
    }
}

/// A linear form a + b r.
struct Line<T> {
    a: T,
    b: T,
}

impl<T: Number> Line<T> {
    fn sign(&self, r: &Direction<T>) -> Option<Ordering> {
        self.a.times(&r.d).plus(&self.b.times(&r.n)).sign()
    }
}

/// The state after a word: velocities, and intercepts a + b r, over `scale`.
#[derive(Debug, Clone)]
struct State<T> {
    v: [T; 4],
    a: [T; 4],
    b: [T; 4],
    scale: T,
    struck: [f64; 4],
}

impl<T: Number> State<T> {
    /// Returns t_i − t_j up to a positive factor, as a linear form in r.
    fn difference(&self, i: usize, j: usize) -> Line<T> {
        let of = |p: &[T; 4]| p[j].times(&self.v[i]).minus(&p[i].times(&self.v[j]));
        Line { a: of(&self.a), b: of(&self.b) }
    }
    fn velocities(&self) -> [f64; 4] {
        std::array::from_fn(|i| self.v[i].over(&self.scale).hi)
    }
}

/// The words found so far, and the one that is being followed.
struct Survey<'a, T> {
    plate: &'a Plate,
    strikes: Strikes<T>,
    limit: usize,
    word: Vec<Corner>,
    words: Vec<Word>,
}

impl<'a, T: Number> Survey<'a, T> {
    /// Returns all words; `None` where these numbers have too few digits.
    fn words(plate: &'a Plate, limit: usize) -> Option<Vec<Word>> {
        let corners = |x: [f64; 4]| x.map(T::exactly);
        let start = State {
            v: corners([-1.0; 4]),
            a: corners([0.0, 1.0, 1.0, 0.0]),
            b: corners([0.0, -1.0, 0.0, 1.0]),
            scale: T::exactly(1.0),
            struck: [0.0; 4],
        };
        let mut survey =
            Self { plate, strikes: T::strikes(plate), limit, word: Vec::with_capacity(limit), words: Vec::new() };
        let [lo, hi] = [0.0, 1.0].map(|n| Direction { n: T::exactly(n), d: T::exactly(1.0) });
        survey.strike(&start, 0, &lo, &hi)?;
        Some(survey.words)
    }

    /// Follows a strike of corner j, the next one between these directions.
    fn strike(&mut self, state: &State<T>, j: usize, lo: &Direction<T>, hi: &Direction<T>) -> Option<()> {
        let shock = (-1.0 - self.plate.e) * state.v[j].over(&state.scale).hi;
        let mut struck = state.struck;
        struck[j] = struck[j].max(shock);
        let [v, a, b] = [&state.v, &state.a, &state.b].map(|x| self.strikes.strike(x, j));
        let scale = self.strikes.factor(j).map_or_else(|| state.scale.clone(), |factor| state.scale.times(factor));
        self.word.push(Corner::ALL[j]);
        let done = self.follow(&State { v, a, b, scale, struck }, j, lo, hi);
        self.word.pop();
        done
    }

    /// Follows the strikes that may come after the word between these directions.
    fn follow(&mut self, state: &State<T>, last: usize, lo: &Direction<T>, hi: &Direction<T>) -> Option<()> {
        let (mut falling, mut n) = ([0; 3], 0);
        for i in (0..4).filter(|i| *i != last) {
            if state.v[i].sign()? == Ordering::Less {
                falling[n] = i;
                n += 1;
            }
        }
        let falling = &falling[..n];
        if falling.is_empty() || self.word.len() == self.limit || self.words.len() >= WORDS {
            self.put(state, falling.is_empty(), lo, hi);
            return Some(());
        }
        let mut next = Self::soonest(state, falling, lo)?;
        let mut from = lo.clone();
        while let Some((meet, after)) = Self::overtaken(state, falling, next, hi)? {
            self.strike(state, next, &from, &meet)?;
            (from, next) = (meet, after);
        }
        self.strike(state, next, &from, hi)
    }

    /// Returns the corner whose line is lowest just above a direction.
    fn soonest(state: &State<T>, falling: &[usize], r: &Direction<T>) -> Option<usize> {
        let mut best = falling[0];
        for &i in &falling[1..] {
            let line = state.difference(i, best);
            let sooner = match line.sign(r)? {
                Ordering::Equal => line.b.sign()? == Ordering::Less,
                order => order == Ordering::Less,
            };
            best = if sooner { i } else { best };
        }
        Some(best)
    }

    /// Returns the direction where the lowest line meets the next one before `hi`, and the corner of that. A line that
    /// is lower at `hi` and was not before meets it on the way.
    #[expect(clippy::option_option, reason = "a doubt, none, or where and which")]
    fn overtaken(
        state: &State<T>,
        falling: &[usize],
        lowest: usize,
        hi: &Direction<T>,
    ) -> Option<Option<(Direction<T>, usize)>> {
        let mut first: Option<(Direction<T>, usize)> = None;
        for &i in falling.iter().filter(|i| **i != lowest) {
            let line = state.difference(i, lowest);
            if line.sign(hi)? != Ordering::Less {
                continue;
            }
            let meet = Direction { n: line.a, d: T::exactly(0.0).minus(&line.b) };
            let order = first.as_ref().map_or(Some(Ordering::Less), |(known, _)| meet.compare(known))?;
            let sooner = match (order, &first) {
                // Three lines in one point: the one that is lower after it.
                (Ordering::Equal, Some((_, other))) => state.difference(i, *other).b.sign()? == Ordering::Less,
                _ => order == Ordering::Less,
            };
            first = if sooner { Some((meet, i)) } else { first };
        }
        Some(first)
    }

    fn put(&mut self, state: &State<T>, ended: bool, lo: &Direction<T>, hi: &Direction<T>) {
        let struck = state.struck;
        let center = (0..4).map(|j| struck[j] / self.plate.weight[j]).fold(0.0, f64::max);
        let later = if ended { 0.0 } else { self.plate.later(&state.velocities()) };
        let (from, to, corners) = (lo.value(), hi.value(), self.word.clone());
        self.words.push(Word { from, to, corners, ended, struck, center, later });
    }
}
