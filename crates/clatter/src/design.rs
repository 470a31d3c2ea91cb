//! The paper's design method: the (q, e) that give the wanted safe zones, and the front of the largest zone.
//!
//! Everything is about pure translation in the design plane 0 ≤ q ≤ 1, 0 ≤ e ≤ 1. At fixed q the peak at the ends grows
//! with e (the claims of `clatter-studies` measure it), so that every goal is met up to some e(q) and no further: the
//! designs that meet all goals lie below one curve, which is solved and not traced on a grid.

use crate::contour::{Point, falling_root, refine};
use crate::{Bar, Error, Start};

/// The (q, e) of the paper's Table 1: the reference, then the three suggested designs.
pub const DESIGNS: [[f64; 2]; 4] = [[0.5, 0.3], [0.73, 0.2], [0.67, 0.15], [0.57, 0.1]];

/// Steps of the search along q for places where a curve leaves the square; a piece shorter in q is missed.
const SCAN: u32 = 512;

/// A requirement on a design. Velocities are in v0, angular velocities in v0/L.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Goal {
    /// Within `s` half-lengths from the center no velocity shock exceeds `threshold` (Eq. 5: s(threshold) ≥ s).
    Zone {
        /// Velocity shock that is allowed there, in v0.
        threshold: f64,
        /// Half-width of the zone over the half-length, in [0, 1].
        s: f64,
    },
    /// No change of the angular velocity exceeds `limit` (Eq. 4).
    Turn {
        /// The limit, in v0/L.
        limit: f64,
    },
}

impl Goal {
    /// Creates the goal of a safe zone of half-width s in which no shock exceeds the threshold.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the threshold is in [1e−150, 1e150] and s in [0, 1].
    pub fn zone(threshold: f64, s: f64) -> Result<Self, Error> {
        let threshold = size("threshold", threshold)?;
        if (0.0..=1.0).contains(&s) {
            Ok(Self::Zone { threshold, s })
        } else {
            Err(Error::Quantity { name: "safe zone s", value: s, allowed: "in [0, 1], in half-lengths" })
        }
    }

    /// Creates the goal of a limit on changes of the angular velocity.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the limit is in [1e−150, 1e150].
    pub fn turn(limit: f64) -> Result<Self, Error> {
        Ok(Self::Turn { limit: size("limit of angular velocity change", limit)? })
    }

    /// Returns 1/peak at the ends where the goal is just met.
    fn needed(self, q: f64) -> f64 {
        match self {
            Self::Zone { threshold, s } => (s * (1.0 + q) + (1.0 - q)) / (2.0 * threshold),
            Self::Turn { limit } => (1.0 + q) / (2.0 * limit),
        }
    }

    /// Returns the largest restitution in [0, 1] that meets the goal at this q in [0, 1]; `None` where even e = 0 does
    /// not.
    ///
    /// # Accuracy
    /// 1e−14; the answer itself meets the goal but for the rounding of a peak.
    ///
    /// # Examples
    /// The whole bar stays within 2 v0 where (1 + e)(1 + q (1 + e)) ≤ 2, at q = ½ up to e = √5 − 2:
    /// ```
    /// use clatter::design::Goal;
    /// let e = Goal::zone(2.0, 1.0)?.largest_restitution(0.5).unwrap();
    /// assert!((e - (5f64.sqrt() - 2.0)).abs() < 1e-13);
    /// // at q = 0 no more than v0/2 even at the center takes (1 + e)/2 ≤ ½: a dead casing
    /// assert_eq!(Goal::zone(0.5, 0.0)?.largest_restitution(0.0), Some(0.0));
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn largest_restitution(self, q: f64) -> Option<f64> {
        let wanted = self.needed(q);
        let excess = |e| inverse_peak(q, e) - wanted;
        let (low, high) = (excess(0.0), excess(1.0));
        if high >= 0.0 {
            Some(1.0)
        } else if low >= 0.0 {
            Some(falling_root(excess, low, high))
        } else {
            None
        }
    }

    /// Returns the margin to the goal: the allowed peak at the ends over the actual one, less 1; negative where the bar
    /// misses the goal. NaN where q and e are of no bar.
    #[must_use]
    pub fn margin(self, q: f64, e: f64) -> f64 {
        let peak = Bar::new(q, e).map_or(f64::NAN, |bar| bar.peak(&Start::default()).end);
        1.0 / (self.needed(q) * peak) - 1.0
    }
}

fn size(name: &'static str, value: f64) -> Result<f64, Error> {
    let allowed = "in [1e-150, 1e150]";
    if (1e-150..=1e150).contains(&value) { Ok(value) } else { Err(Error::Quantity { name, value, allowed }) }
}

/// Returns the largest restitution that meets all goals at this q in [0, 1]; `None` where none does.
#[must_use]
pub fn largest_restitution(goals: &[Goal], q: f64) -> Option<f64> {
    goals.iter().try_fold(1.0_f64, |least, goal| goal.largest_restitution(q).map(|e| least.min(e)))
}

/// Returns the upper border e(q) of the designs that meet all goals, in connected pieces with q ascending: below each
/// piece, down to e = 0, all of them do. The true border stays within about `flatness` of the chords.
///
/// Goals that are met nowhere leave no piece.
///
/// ```
/// use clatter::design::{Goal, region};
/// // the paper's example: v0/2 in the middle tenth of the bar, 2 v0 in 85 % of it
/// let goals = [Goal::zone(0.5, 0.1)?, Goal::zone(2.0, 0.85)?];
/// let pieces = region(&goals, 1e-3);
/// assert_eq!(pieces.len(), 1);
/// let (first, last) = (pieces[0][0], pieces[0][pieces[0].len() - 1]);
/// assert!(first.q > 0.3 && last.q == 1.0 && pieces[0].iter().all(|p| p.e < 0.25));
/// # Ok::<(), clatter::Error>(())
/// ```
#[must_use]
pub fn region(goals: &[Goal], flatness: f64) -> Vec<Vec<Point>> {
    let at = |q| Point { q, e: largest_restitution(goals, q).unwrap_or(0.0) };
    let pieces = intervals(|q| largest_restitution(goals, q).is_some());
    let piece = |[a, b]: [f64; 2]| {
        let (start, end) = (at(a), at(b));
        let mut piece = vec![start];
        refine(&at, start, end, flatness, &mut piece);
        piece
    };
    pieces.into_iter().map(piece).collect()
}

/// A design of a front.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FrontPoint {
    /// Inertia ratio.
    pub q: f64,
    /// Safe zone that it gives, in half-lengths, not clipped.
    pub s: f64,
}

/// The front of the largest safe zone against q at one restitution: designs than which no other has both a larger zone
/// and a smaller q, which is easier to build.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Front {
    /// Restitution.
    pub e: f64,
    /// The front in pieces, q and s ascending; it jumps between them. Empty where no q meets the goals.
    pub pieces: Vec<Vec<FrontPoint>>,
}

impl Front {
    /// Returns the end of the front: the largest zone that the goals leave, at the smallest q that has it.
    #[must_use]
    pub fn largest(&self) -> Option<FrontPoint> {
        self.pieces.last().and_then(|piece| piece.last()).copied()
    }
}

/// Returns the front of the largest zone for `threshold` (in v0) against q in [0, 1], at restitution `e`, among the
/// designs that have a zone (s ≥ 0) and meet all `goals`.
///
/// A piece that a goal ends is exact to a rounding of q, one where the zone turns to a rounding of s; between them
/// `steps` values of q a unit lie on the front exactly. A stretch of q shorter than 1/512, or a second top between
/// neighboring values, may be missed.
///
/// # Errors
/// [`Error::Quantity`] for a threshold outside [1e−150, 1e150], [`Error::Restitution`] unless 0 ≤ e ≤ 1.
///
/// # Examples
/// Without another goal the front ends at all mass in the center, at e = 0 with a quarter of the bar: the free optimum,
/// which cannot be built.
/// ```
/// let largest = clatter::design::front(0.5, &[], 0.0, 64)?.largest().unwrap();
/// assert_eq!((largest.q, largest.s), (1.0, 0.25)); // the peak is 2 v0 there, and s = ½ · ½
/// # Ok::<(), clatter::Error>(())
/// ```
pub fn front(threshold: f64, goals: &[Goal], e: f64, steps: u32) -> Result<Front, Error> {
    let here = Goal::zone(threshold, 0.0)?;
    Bar::new(0.0, e)?;
    let good = |q| goals.iter().chain([&here]).all(|goal| goal.margin(q, e) >= 0.0);
    let zone = |q| zone(threshold, q, e);
    let mut pieces: Vec<Vec<FrontPoint>> = Vec::new();
    let mut largest = f64::NEG_INFINITY;
    for [a, b] in intervals(good) {
        let inside = (0..=steps).map(|i| f64::from(i) / f64::from(steps.max(1))).filter(|q| *q > a && *q < b);
        let mut open: Option<Vec<FrontPoint>> = None;
        let samples: Vec<f64> = [a].into_iter().chain(inside).chain((b > a).then_some(b)).collect();
        for (i, &q) in samples.iter().enumerate() {
            let (s, last) = (zone(q), i + 1 == samples.len());
            if s > largest {
                open.get_or_insert_default().push(FrontPoint { q, s });
                largest = s;
            }
            // Where the zone has turned, or might have since the last value, the front ends at the top.
            if s < largest || last {
                let Some(mut piece) = open.take() else { continue };
                let top = highest(zone, samples[i.saturating_sub(2)], q);
                if top.s > largest {
                    largest = top.s;
                    piece.retain(|p| p.q < top.q);
                    piece.push(top);
                }
                pieces.push(piece);
            }
        }
    }
    Ok(Front { e, pieces })
}

/// Returns the highest point of a function that rises to it and falls from it between `a` and `b`, by golden section,
/// to a rounding of its height.
fn highest(zone: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> FrontPoint {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let mut best = FrontPoint { q: a, s: zone(a) };
    for _ in 0..80 {
        let (left, right) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
        let (low, high) = (zone(left), zone(right));
        for (q, s) in [(left, low), (right, high)] {
            if s > best.s {
                best = FrontPoint { q, s };
            }
        }
        if low < high { a = left } else { b = right }
    }
    best
}

/// Returns the intervals of [0, 1] where `good` holds, each end good and within a rounding of the border; one shorter
/// than a step of the scan may be missed.
fn intervals(good: impl Fn(f64) -> bool) -> Vec<[f64; 2]> {
    // from a good value towards a bad one
    let border = |mut inside: f64, mut outside: f64| {
        loop {
            let middle = 0.5 * (inside + outside);
            if !(inside.min(outside) < middle && middle < inside.max(outside)) {
                return inside;
            }
            *(if good(middle) { &mut inside } else { &mut outside }) = middle;
        }
    };
    let at = |i: u32| f64::from(i) / f64::from(SCAN);
    let mut found: Vec<[f64; 2]> = Vec::new();
    let mut before = false;
    for i in 0..=SCAN {
        let now = good(at(i));
        match (before, now) {
            (false, true) => found.push([if i == 0 { 0.0 } else { border(at(i), at(i - 1)) }, 1.0]),
            (true, false) => {
                if let Some(last) = found.last_mut() {
                    last[1] = border(at(i - 1), at(i));
                }
            }
            _ => {}
        }
        before = now;
    }
    found
}

/// Returns the safe zone s of a threshold, whichever end strikes first (Eq. 5).
fn zone(threshold: f64, q: f64, e: f64) -> f64 {
    let peak = Bar::new(q, e).map_or(f64::NAN, |bar| bar.peak(&Start::default()).end);
    (2.0 * threshold / peak - (1.0 - q)) / (1.0 + q)
}

/// Returns 1/peak at the ends, which is finite at (1, 1) too.
fn inverse_peak(q: f64, e: f64) -> f64 {
    Bar::new(q, e).map_or(f64::NAN, |bar| 1.0 / bar.summary(&Start::default()).peak.end)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn paper(level: f64) -> [Goal; 2] {
        [Goal::zone(0.5, 0.1).unwrap(), Goal::zone(2.0, level).unwrap()]
    }

    #[test]
    fn only_the_paper_s_first_suggestion_has_the_zone_it_asks_for() {
        let met = |[q, e]: [f64; 2], s| largest_restitution(&[Goal::zone(0.5, s).unwrap()], q).is_some_and(|m| e <= m);
        let [reference, suggested @ ..] = DESIGNS;
        assert!(!met(reference, 0.0), "the reference has no zone at all");
        assert_eq!(suggested.map(|design| met(design, 0.1)), [true, false, false], "10 %");
        assert_eq!(suggested.map(|design| met(design, 0.08)), [true; 3], "8 %: roughly 10 %, as the table says");
    }

    #[test]
    fn the_whole_bar_within_2_v0_has_its_closed_form() {
        // peak = (1 + e)(1 + T) wherever the second impact holds it
        let whole = Goal::zone(2.0, 1.0).unwrap();
        for i in 1..=20 {
            let q = f64::from(i) / 20.0;
            // q x² + x = 2 with x = 1 + e
            let e = ((1.0 + 8.0 * q).sqrt() - 1.0) / (2.0 * q) - 1.0;
            let found = whole.largest_restitution(q).unwrap();
            assert!((found - e).abs() < 1e-13, "{found} not {e} at q = {q}");
        }
        assert_eq!(whole.largest_restitution(0.0), Some(1.0), "ends that do not feel each other");
    }

    #[test]
    fn the_border_is_flat_and_ends_where_the_goals_do() {
        let pieces = region(&paper(0.85), 1e-4);
        assert_eq!(pieces.len(), 1, "one region");
        let border = &pieces[0];
        let lowest = border[0];
        // at e = 0 the peak is 1 + q, and 1/(1 + q) = 1.1 − 0.9 q
        assert!((0.9 * lowest.q * lowest.q - 0.2 * lowest.q - 0.1).abs() < 1e-12 && lowest.e < 1e-12, "{lowest:?}");
        for w in border.windows(2) {
            let q = 0.3 * w[0].q + 0.7 * w[1].q;
            let chord = 0.3 * w[0].e + 0.7 * w[1].e;
            let off = largest_restitution(&paper(0.85), q).unwrap() - chord;
            let (dq, de) = (w[1].q - w[0].q, w[1].e - w[0].e);
            assert!((off * dq).abs() / dq.hypot(de) < 2e-4, "{off} off at q = {q}");
        }
        assert!(region(&[Goal::zone(0.2, 0.5).unwrap()], 1e-3).is_empty(), "nothing gives half the bar 0.2 v0");
        assert!(region(&[], 1e-3)[0].iter().all(|p| p.e >= 1.0), "no goal, no border");
    }

    #[test]
    fn a_front_that_turns_ends_at_the_top() {
        // next to all mass in the center the peak comes late and the zone shrinks again
        let top = |steps| front(0.5, &[], 0.05, steps).unwrap().largest().unwrap();
        let (coarse, fine) = (top(100), top(3700));
        assert!((coarse.s - fine.s).abs() < 1e-12 && fine.q < 1.0, "{coarse:?}, {fine:?}");
        let zone = |q| zone(0.5, q, 0.05);
        for i in 0..=2000 {
            assert!(zone(0.9 + f64::from(i) / 20_000.0) <= fine.s, "q = {}", 0.9 + f64::from(i) / 20_000.0);
        }
    }

    #[test]
    fn a_front_ends_where_the_second_goal_does() {
        let second = Goal::zone(2.0, 0.85).unwrap();
        for e in [0.05, 0.1, 0.15, 0.2] {
            let front = front(0.5, &[second], e, 100).unwrap();
            let end = front.largest().unwrap();
            let free = super::front(0.5, &[], e, 100).unwrap().largest().unwrap();
            if second.margin(1.0, e) >= 0.0 {
                assert_eq!(end, free, "e = {e}: nothing in the way");
            } else {
                assert!(second.margin(end.q, e).abs() < 1e-12 && end.s < free.s, "e = {e}: {end:?}");
            }
            assert!((zone(0.5, end.q, e) - end.s).abs() < 1e-15, "e = {e}");
        }
        assert!(front(0.5, &[second], 0.9, 100).unwrap().largest().is_none(), "a bouncy casing has no such zone");
    }

    proptest! {
        /// No bar of a dense line beats its front: a bar that meets the goals has no larger zone than the front at its
        /// q.
        #[test]
        fn nothing_beats_the_front(threshold in 0.3..1.5_f64, level in 0.2..1.0_f64, e in 0.0..0.6_f64, q in 0.0..=1.0_f64) {
            let goal = Goal::zone(2.0, level).unwrap();
            let front = front(threshold, &[goal], e, 2000).unwrap();
            let s = zone(threshold, q, e);
            prop_assume!(s >= 0.0 && goal.margin(q, e) >= 0.0);
            let best = front.pieces.iter().flatten().filter(|p| p.q <= q).map(|p| p.s).fold(f64::NEG_INFINITY, f64::max);
            // A step of 1/2000 in q changes s by at most 2/2000 on the smooth part; a narrow stretch may be missed.
            prop_assert!(s <= best + 2e-3, "{s} at q = {q} beats {best}");
        }

        /// A goal holds below its largest restitution and not above.
        #[test]
        fn a_goal_holds_up_to_its_restitution(q in 0.0..=1.0_f64, size in 0.2..3.0_f64, s in 0.0..=1.0_f64, turn: bool) {
            let goal = if turn { Goal::turn(size) } else { Goal::zone(size, s) }.unwrap();
            let margin = |e: f64| goal.margin(q, e.clamp(0.0, 1.0));
            match goal.largest_restitution(q) {
                Some(e) => {
                    prop_assert!(margin(e) >= -1e-12, "{} at its own restitution", margin(e));
                    prop_assert!(margin(e - 1e-9) >= -1e-12, "below");
                    prop_assert!(e >= 1.0 || margin(e + 1e-9) < 1e-12, "above");
                }
                None => prop_assert!(margin(0.0) < 0.0, "even dead"),
            }
        }
    }
}
