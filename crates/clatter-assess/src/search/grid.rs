//! This module chooses the drops of the ranges that are followed.

use std::f64::consts::{FRAC_PI_2, SQRT_2, TAU};

use super::budgets::{
    ALONG_EDGE, AROUND, AROUND_FACE, DROPS_OF_PLATE, LINES, LINES_A_QUARTER, OVERLAPS, OVERLAPS_A_QUARTER,
    PART_OF_CONTACT, PHASE, TILTS, TILTS_OF_FACE, TURNED_AT, TURNED_NEXT_TO_FLAT,
};
use super::ranges::{AXES, CONTACT, Coordinates, DAMPING, DIRECTION, FREQUENCY, RESTITUTION, Ranges, SPEED, TILT};
use clatter::End;

use super::{GOLDEN, Task};
use clatter_product::{Mount, Row, Search, searched};

const SQRT_3: f64 = 1.732_050_807_568_877;
const SQRT_7: f64 = 2.645_751_311_064_59;
const SQRT_11: f64 = 3.316_624_790_355_4;
/// The places of the drops of the grid along a range.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Level {
    At(f64),
    /// Evenly all over it, by the multiples of an irrational number.
    Spread(f64),
}

/// Levels along all axes.
type Line = [Level; AXES];

/// Finds where drop k of a line is along all axes.
fn shares(line: &Line, k: usize) -> [f64; AXES] {
    line.map(|level| level.of(k))
}

impl Level {
    fn of(&self, k: usize) -> f64 {
        match self {
            Self::At(share) => *share,
            #[expect(clippy::cast_precision_loss, reason = "thousands")]
            Self::Spread(by) => (by * k as f64).fract(),
        }
    }
}

impl Ranges<'_> {
    /// Steps of the tilt, and of the direction of a plate over all of its range: as many as the stiffest of the parts needs.
    pub(super) fn steps(&self, tasks: &[Task<'_>]) -> [f64; 2] {
        // A spin that opens the tilt leaves parts more time to swing.
        let [_, slowly] = self.closing_m_s();
        let [low, high] =
            [self.drop.tilt_rad.lo(), self.drop.tilt_rad.hi()].map(|tilt| self.reach_m() * libm::sin(tilt));
        let highest = tasks.iter().filter_map(|task| match task.component.mount {
            // Beyond some swings a contact, pulses act one by one.
            Mount::Suspended { frequency_hz, .. } => Some(frequency_hz.hi()),
            // Its crest is where contacts meet.
            Mount::Hard => self.product.contact_times_s().map(|[shortest, _]| 0.5 / shortest),
        });
        let stiff = self.product.contact_times_s().map_or(f64::INFINITY, |[shortest, _]| 1.0 / shortest);
        let highest = highest.fold(0.0_f64, f64::max).min(stiff);
        let [least, most] = TILTS;
        let of = |gap: f64| (TAU * highest * gap / slowly / PHASE).clamp(least, most).ceil();
        [of(high - low), of(high) * f64::from(self.quarters())]
    }

    /// Quarters of a turn that the directions of a plate take, rounded up; 0 of one direction.
    fn quarters(&self) -> u32 {
        let [from, to] = self.directions();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 4")]
        let quarters = ((to - from) / FRAC_PI_2).ceil() as u32;
        quarters
    }

    /// Returns the drops of the grid; places of parts are left open.
    pub(super) fn grid(&self, steps: f64, turn_steps: f64) -> Vec<Coordinates> {
        if self.base.is_some() {
            return self.around();
        }
        let [slow, fast] = self.drop.speeds_m_s();
        let even = |steps: f64, free: bool| {
            let steps = if free { steps } else { 0.0 };
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 512")]
            let count = steps as u32;
            (0..=count).map(move |k| if count == 0 { 0.0 } else { f64::from(k) / f64::from(count) })
        };
        let tilted = !self.drop.tilt_rad.is_value();
        let mut grid = Vec::new();
        let of = |first, [tilt, speed]: [f64; 2], line: &Line, direction: f64, k: usize| {
            let mut shares = shares(line, k);
            (shares[TILT], shares[SPEED], shares[DIRECTION]) = (tilt, speed, direction);
            Coordinates { first, flat: false, mirrored: [false; 2], at_m: [0.0; 2], shares }
        };
        for &first in self.firsts() {
            for (line, direction) in &self.lines() {
                let mut add = |tilt: f64, speed: f64| {
                    let k = grid.len();
                    grid.push(of(first, [tilt, speed], line, *direction, k));
                };
                even(steps, tilted).for_each(|tilt| add(tilt, 1.0));
                // Slower drops seldom do more; fewer of them are followed.
                even((steps / 4.0).ceil(), tilted).filter(|_| slow < fast).for_each(|tilt| add(tilt, 0.0));
                // The phase in which a soft part is struck again depends on the speed: other speeds are followed too.
                let between = even((steps / 4.0).ceil(), tilted).filter(|_| slow < fast);
                (1_u32..).zip(between).for_each(|(k, tilt)| add(tilt, (SQRT_7 * f64::from(k)).fract()));
            }
            // Next to a landing on an edge the demand changes as fast as two contacts come apart.
            for (line, direction) in self.lines().iter().take(self.on_edges().len()) {
                for (tilt, side) in even((steps / 4.0).ceil(), tilted).flat_map(|tilt| [(tilt, -1.0), (tilt, 1.0)]) {
                    let on_edge = of(first, [tilt, 1.0], line, *direction, grid.len());
                    let next = direction + side * self.turn_in_contact(&on_edge);
                    grid.extend(Some(on_edge.with(DIRECTION, next)).filter(|_| (0.0..=1.0).contains(&next)));
                }
            }
            let turned = match (self.quarters(), tilted) {
                (0, _) => &[],
                (_, false) => &TURNED_AT[..1],
                (_, true) => &TURNED_AT[..],
            };
            let least = if self.drop.tilt_rad.lo() > 0.0 { 0.0 } else { TURNED_NEXT_TO_FLAT };
            for (tilt, line) in turned.iter().map(|tilt| tilt.max(least)).zip(self.levels().into_iter().cycle()) {
                for direction in even(turn_steps, true) {
                    let k = grid.len();
                    grid.push(of(first, [tilt, 1.0], &line, direction, k));
                }
            }
        }
        // For a plate with soft parts the order in which its corners come down tells more than the phase of the parts.
        let of_plate = if self.quarters() > 0 { DROPS_OF_PLATE.saturating_sub(grid.len()) } else { 0 };
        let evenly = |k: u32| if tilted { self.spread_out(k).with(TILT, halton(TILT, k)) } else { self.spread_out(k) };
        grid.extend((1..).map(evenly).take(of_plate));
        if self.hold_flat() {
            let first = self.firsts()[0];
            let levels = [Level::At(1.0), Level::At(0.0), Level::Spread(SQRT_2)];
            let speeds = if slow < fast { &[1.0, 0.0, 0.5][..] } else { &[1.0] };
            for (restitution, &speed) in levels.iter().flat_map(|e| speeds.iter().map(move |speed| (e, speed))) {
                let mut shares = [0.0; AXES];
                (shares[SPEED], shares[RESTITUTION]) = (speed, restitution.of(grid.len()));
                grid.push(Coordinates { first, flat: true, mirrored: [false; 2], at_m: [0.0; 2], shares });
            }
        }
        grid
    }

    /// Returns drops of a box all around its posture: as it should land, and turned off that by all of its tolerance and by less, the ends
    /// of the other ranges in turn, all of it at each end of the ranges of the inputs that a file may leave out and over them. Off a face
    /// they are closer; off an edge along it, where its corners land one after the other.
    fn around(&self) -> Vec<Coordinates> {
        let levels = self.levels();
        let optional = searched().filter(|(row, _)| row.optional.is_some());
        let turns: usize = optional.map(|(row, search)| self.levels_of(row, search).len()).product();
        let of_turn = levels.len() / turns;
        let count = self.faces();
        let (around, tilts) = if count == 1 { (AROUND_FACE, &TILTS_OF_FACE[..]) } else { (AROUND, &[1.0, 0.7][..]) };
        let share = |k: u32, of: u32| f64::from(k) / f64::from(of);
        let off = (0..around).flat_map(|k| tilts.iter().map(move |tilt| (*tilt, share(k, around))));
        let along = if count == 2 { ALONG_EDGE } else { 0 };
        let off = off.chain((1..=along).flat_map(|k| [0.0, 0.5].map(|direction| (share(k, along), direction))));
        let all = [(0.0, 0.0)].into_iter().chain(off).enumerate();
        let of = |turn: usize, k: usize, (tilt, direction): (f64, f64)| {
            // Each direction begins with the next level, as else every level would have tilts of its own.
            let level = levels[turn * of_turn + (k + k / tilts.len()) % of_turn];
            let mut shares = shares(&level, k);
            let speed = if k % 4 == 3 { (SQRT_7 * f64::from(u32::try_from(k).unwrap_or(0))).fract() } else { 1.0 };
            (shares[TILT], shares[SPEED], shares[DIRECTION]) = (tilt, speed, direction);
            Coordinates { first: End::A, flat: false, mirrored: [false; 2], at_m: [0.0; 2], shares }
        };
        let all: Vec<_> = all.collect();
        (0..turns)
            .flat_map(|turn| all.iter().map(move |(k, at)| (turn, *k, *at)))
            .map(|(n, k, at)| of(n, k, at))
            .collect()
    }

    /// Returns the ends of the range of an input, the one that lines begin with first, and values all over it. Of an input that a file may
    /// leave out the end that is farther from the value without comes first.
    fn levels_of(&self, row: &Row, Search { axis, line, .. }: Search) -> Vec<Level> {
        let Some((first, by)) = line else { return vec![Level::At(0.0)] };
        let first = match (row.optional, row.input.range(self.product, self.drop)) {
            (Some(optional), Some([lo, hi])) if lo < hi => {
                if hi - optional.without > optional.without - lo {
                    1.0
                } else {
                    0.0
                }
            }
            (Some(_), _) => 0.0,
            (None, _) => first,
        };
        if self.free_in_drops()[axis] {
            vec![Level::At(first), Level::At(1.0 - first), Level::Spread(by)]
        } else {
            vec![Level::At(first)]
        }
    }

    /// Lines of drops: each input at both ends of its range and spread over it, each with each; those that bounce most and press shortest
    /// first. Inputs that a file may leave out take turns last.
    fn levels(&self) -> Vec<Line> {
        let mut all: Vec<Line> = vec![[Level::At(0.0); AXES]];
        let (optional, others): (Vec<_>, Vec<_>) =
            searched().filter(|(_, search)| search.line.is_some()).partition(|(row, _)| row.optional.is_some());
        for (row, search) in optional.into_iter().chain(others) {
            let (axis, levels) = (search.axis, self.levels_of(row, search));
            let with = |line: &Line| {
                let line = *line;
                levels.clone().into_iter().map(move |level| {
                    let mut with = line;
                    with[axis] = level;
                    with
                })
            };
            all = all.iter().flat_map(with).collect();
        }
        all
    }

    /// Returns the directions of a plate in which it lands on an edge, and the ends of those that it rises to.
    fn on_edges(&self) -> Vec<f64> {
        if self.quarters() == 0 {
            return Vec::new();
        }
        let [from, to] = self.directions();
        let first = (from / FRAC_PI_2).ceil();
        let edges = (0..=4).map(|k| ((first + f64::from(k)) * FRAC_PI_2 - from) / (to - from));
        let mut all: Vec<f64> = [0.0].into_iter().chain(edges.filter(|share| *share < 1.0)).chain([1.0]).collect();
        all.dedup();
        all
    }

    /// Returns how far a plate is turned, as a share of its directions, so that some corner comes later by a part of a contact.
    pub(super) fn turn_in_contact(&self, place: &Coordinates) -> f64 {
        let (drop, [from, to]) = (self.single(place), self.directions());
        let turned_m = self.reach_m() * libm::sin(drop.tilt_rad) * (to - from);
        drop.contact_times_s().map_or(0.0, |[shortest, _]| PART_OF_CONTACT * shortest * drop.speed_m_s / turned_m)
    }

    /// Lines of drops over the tilt: of a bar one at each of these levels; of a plate at directions that spread evenly, its edges among
    /// them, and at the levels in turn.
    fn lines(&self) -> Vec<(Line, f64)> {
        let levels = self.levels();
        if self.quarters() == 0 {
            return levels.into_iter().map(|line| (line, 0.0)).collect();
        }
        let quarters = self.quarters();
        let edges = self.on_edges().into_iter();
        let between = (1..=LINES + LINES_A_QUARTER * quarters).map(|k| (GOLDEN * f64::from(k)).fract());
        // The ends of all ranges, and one that spreads over them.
        let is_end = |line: &&Line| line.iter().all(|level| matches!(level, Level::At(_)));
        let lines: Vec<_> = levels.iter().filter(is_end).chain(levels.last().filter(|line| !is_end(line))).collect();
        edges.chain(between).zip(lines.iter().cycle()).map(|(direction, line)| (**line, direction)).collect()
    }

    /// Returns drops whose first two contacts overlap or nearly do.
    pub(super) fn overlaps(&self) -> Vec<(u32, Coordinates)> {
        let is_searched = !self.drop.tilt_rad.is_value() && self.base.is_none();
        let times = self.product.longest_contacts_s();
        let one_by_one = times.into_iter().filter(|_| is_searched).flat_map(|time_s| self.overlaps_within(time_s));
        one_by_one.collect()
    }

    /// Returns the same of contacts that last so long.
    fn overlaps_within(&self, contact_s: f64) -> Vec<(u32, Coordinates)> {
        let [lo, hi] = [self.drop.tilt_rad.lo(), self.drop.tilt_rad.hi()];
        // A spin that closes the tilt lets contacts overlap at larger ones.
        let [fastest, _] = self.closing_m_s();
        let [often, far] = OVERLAPS;
        let of_one = fastest * contact_s / self.reach_m();
        let step = of_one / often;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 48")]
        let count = (((far * of_one).min(hi) - lo) / step).clamp(0.0, often * far) as u32;
        let share = |tilt: f64| (tilt.sqrt() - lo.sqrt()) / (hi.sqrt() - lo.sqrt());
        let spread = |k: u32, by: f64| (by * f64::from(k)).fract();
        let free = self.free_in_drops();
        let of = |first, k: u32, [restitution, n]: [f64; 2]| {
            let direction = (spread(k, SQRT_11) + n).fract();
            let contact = (spread(k, SQRT_3) + GOLDEN * n).fract();
            let mut shares = [0.0; AXES];
            for (row, search) in searched() {
                let at = search.line.map_or(0.0, |(_, by)| spread(k, by));
                // No two places differ by an input that is left out.
                shares[search.axis] = match row.optional {
                    Some(_) if free[search.axis] => (at + GOLDEN * n).fract(),
                    Some(_) => 0.0,
                    None => at,
                };
            }
            (shares[TILT], shares[SPEED], shares[DIRECTION]) = (share(lo + f64::from(k) * step), 1.0, direction);
            (shares[RESTITUTION], shares[CONTACT]) = (restitution, contact);
            (k, Coordinates { first, flat: false, mirrored: [false; 2], at_m: [0.0; 2], shares })
        };
        let directions = (OVERLAPS_A_QUARTER * self.quarters()).max(1);
        let drops = |k: u32| {
            let each = (0..directions).map(|n| f64::from(n) / f64::from(directions));
            let each: Vec<[f64; 2]> = each.map(|n| [1.0, n]).chain([[spread(k, SQRT_2), 0.0]]).collect();
            self.firsts().iter().flat_map(move |&first| each.clone().into_iter().map(move |at| of(first, k, at)))
        };
        (0..=count).flat_map(drops).collect()
    }

    /// Returns drop k of a sequence that spreads evenly over the ranges (Halton's), half of it at an end of each, where worst cases lie as
    /// a rule.
    pub(super) fn spread_out(&self, k: u32) -> Coordinates {
        let firsts = self.firsts();
        // Not by its last digit, which tells the half of the tilts.
        let first = firsts[k.count_ones() as usize % firsts.len()];
        let mut shares = [0.0; AXES];
        let free = self.free_in_drops();
        // Axes over which the demand changes most get few digits.
        let others = searched().map(|(_, search)| search.axis).filter(|axis| *axis != TILT && *axis != SPEED);
        let order = [TILT, DIRECTION, SPEED].into_iter().chain(others).chain([DAMPING, FREQUENCY]);
        for (n, axis) in order.filter(|axis| free[*axis]).enumerate() {
            let share = radical_inverse(PRIMES[n], k);
            // Directions have no ends, and a box that is turned off nothing balances for long.
            let has_ends = axis != DIRECTION && (axis != TILT || self.base.is_none());
            shares[axis] = if has_ends { (2.0 * share - 0.5).clamp(0.0, 1.0) } else { share };
        }
        Coordinates { first, flat: false, mirrored: [false; 2], at_m: [0.0; 2], shares }
    }
}

/// Bases of Halton's sequence.
const PRIMES: [u32; 13] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41];
const _: () = assert!(AXES <= PRIMES.len(), "each axis has its base");

/// Returns number k of Halton's sequence along an axis.
pub(super) fn halton(axis: usize, k: u32) -> f64 {
    radical_inverse(PRIMES[axis], k)
}

/// Returns the digits of k in a base, mirrored at the point.
fn radical_inverse(base: u32, mut k: u32) -> f64 {
    let (mut share, mut digit) = (0.0, 1.0);
    while k > 0 {
        digit /= f64::from(base);
        share += digit * f64::from(k % base);
        k /= base;
    }
    share
}
