//! Which computed strikes the measured ones are.
//!
//! The plain explanation comes first: every measured strike is a computed one, and none is missing. Only where that is no explanation are
//! others tried, and these pay for every strike that they drop or invent ([`Score`]).

use super::criterion::{Faults, SIMILAR, Score, chi_square};
use super::drop::{DIFFERENCE, Drop, GAP_TIME, GYRATION, OFFSET, RESTITUTION, SPEED};
use super::first_strikes::meeting;
use super::report::missing;
use super::solve::Minimum;
use super::starts::{TAKEN, misfit, starts};
use super::student;
use super::{Error, MeasuredStrike, Set, Which};
use std::cmp::Ordering;

use clatter::End;

/// Restitutions among which starts are sought: between two of them the time of the next strike is mostly nearly a straight line. And
/// where the plain explanation was not found among so few.
const RESTITUTIONS: usize = 48;
const MORE_RESTITUTIONS: usize = 96;
/// So many drops go on there.
const MORE_TAKEN: usize = 48;
/// The first strikes are met there as they were measured and as they may be: by two standard deviations or, where none is given, a
/// hundredth of the time between them, which is as well as clatter is timed at least.
const DEVIATIONS: f64 = 2.0;
const UNTOLD: f64 = 0.01;
/// More strikes than these can tell both ends apart and that they do.
const ENOUGH_FOR_BOTH: usize = 6;
/// Strikes may be missing before so many of the first measured ones.
const PLACES: usize = 16;
/// Data that scatter by more than this share of the mean time between strikes are not explained: with so much, nothing is told.
pub(super) const SUSPECT: f64 = 0.05;
/// Nor are data that scatter by more than is given, or of which one is further off than the others explain, where chance does that
/// less often: so many sound records are taken for odd ones.
pub(super) const CHANCE: f64 = 1e-4;

/// Minima are the same whose unknowns differ by no more.
const SAME: f64 = 1e-3;

/// What is taken for granted of a drop and its record.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
struct Premise {
    /// Measured strikes, from 0, before each of which a computed one is missing.
    missing: Vec<usize>,
    /// A measured strike that is left out, and whether it is one at a wrong time; else it is none at all.
    left_out: Option<(usize, bool)>,
    /// An unknown that is free although the product file or a simpler product has it otherwise.
    freed: Option<usize>,
    /// In how many ways that many strikes may be dropped or invented.
    ways: usize,
}

impl Premise {
    fn faults(&self) -> Faults {
        #[expect(clippy::cast_precision_loss, reason = "some hundred")]
        let ln_ways = (self.ways.max(1) as f64).ln();
        Faults { count: self.missing.len() + usize::from(self.left_out.is_some()), ln_ways }
    }

    /// Of each measured strike the computed one that it is: in the order of its end where all ends are known, else in that of all.
    fn index(&self, strikes: &[MeasuredStrike]) -> Vec<Option<Which>> {
        let ends_known = strikes.iter().all(|strike| strike.end.is_some());
        let mut next = [0; 2];
        let one = |(k, strike): (usize, &MeasuredStrike)| {
            let end = strike.end.filter(|_| ends_known);
            let count = &mut next[usize::from(end == Some(End::B))];
            *count += self.missing.iter().filter(|place| **place == k).count();
            let is_out = self.left_out.filter(|(out, _)| *out == k);
            let now = *count;
            *count += is_out.map_or(1, |(_, is_strike)| usize::from(is_strike));
            is_out.is_none().then(|| end.map_or(Which::Of(now), |end| Which::OfEnd(end, now)))
        };
        strikes.iter().enumerate().map(one).collect()
    }
}

/// A fit to one record of strikes, alone.
struct Candidate {
    premise: Premise,
    index: Vec<Option<Which>>,
    /// Strikes of the other end than measured, and those that are missing without being among the premises.
    wrong: usize,
    minimum: Minimum,
    free: Vec<usize>,
    /// Number of data less that of unknowns.
    degrees: usize,
    score: Score,
}

impl Candidate {
    /// The better one is less. Of one premise all have as many unknowns.
    fn order(&self, other: &Self) -> Ordering {
        self.wrong.cmp(&other.wrong).then(self.minimum.sum().total_cmp(&other.minimum.sum()))
    }
    /// Whether it is the same minimum, found from another start.
    fn is_same(&self, other: &Self) -> bool {
        let is_near = |unknown: &usize| (self.minimum.x[*unknown] - other.minimum.x[*unknown]).abs() < SAME;
        self.free.iter().all(is_near)
    }
}

/// What the strikes of a record are taken to be.
#[derive(Debug, Clone)]
pub(super) struct Matched {
    pub(super) index: Vec<Option<Which>>,
    /// Unknowns that explain it.
    pub(super) x: Vec<f64>,
    /// What is dropped and invented.
    pub(super) faults: Faults,
    /// What is free beside the unknowns that such records tell at least.
    pub(super) freed: Option<usize>,
    /// Whether nothing is odd.
    pub(super) is_plain: bool,
}

/// Finds what the strikes of a record may be: the best explanation, and those that are about as good. `known`: whether the deviation was
/// given.
pub(super) fn find(drop: &Drop<'_>, set: usize, known: bool) -> Result<Vec<Matched>, Error> {
    let Set::Strikes { strikes, .. } = drop.sets[set] else { return Ok(Vec::new()) };
    let mut alone = Drop { sets: vec![drop.sets[set].clone()], is_rough: true, ..drop.clone() };
    alone.ranged = [SPEED].into_iter().filter(|&unknown| alone.range(unknown).is_some()).collect();
    let ranged = alone.ranged.clone();
    Search { drop: alone, strikes, known, ranged, reach: 0 }.found()
}

/// The search in one record.
struct Search<'d> {
    /// With this record alone.
    drop: Drop<'d>,
    strikes: &'d [MeasuredStrike],
    known: bool,
    /// Unknowns that the file gives in a range, if no premise frees them.
    ranged: Vec<usize>,
    /// With so many of the first strikes the plain explanation is none any more.
    reach: usize,
}

impl<'d> Search<'d> {
    /// Takes measured strikes for these computed ones.
    fn take(&mut self, of_strikes: &[Option<Which>]) {
        if let Set::Strikes { index, .. } = &mut self.drop.sets[0] {
            index.clear();
            index.extend_from_slice(of_strikes);
        }
    }

    fn found(mut self) -> Result<Vec<Matched>, Error> {
        let premise = Premise::default();
        let mut plain = self.staged(&premise);
        if !self.is_met(&plain[0]) {
            plain.extend(self.thorough(&premise));
            plain.sort_by(Candidate::order);
        }
        self.drop.is_rough = false;
        self.settle(&mut plain[0]);
        let outlier = self.outlier(&plain[0]);
        let is_plain = self.is_met(&plain[0]) && outlier.is_none();
        let mut all = plain;
        if !is_plain {
            let near: Vec<Vec<f64>> = all.iter().map(|fit| fit.minimum.x.clone()).collect();
            all.truncate(1);
            for round in self.rounds(outlier) {
                for premise in &round {
                    if self.drop.left.get() > 0 && self.is_supported(premise) {
                        let others = match premise.freed {
                            Some(_) => self.from(premise, &near),
                            None => self.staged(premise),
                        };
                        all.extend(others.into_iter().filter(|other| self.counts(other)));
                    }
                }
                // Two strikes are missing only where one is not enough.
                if all.len() > 1 {
                    break;
                }
            }
            // What does not explain the record is no explanation beside one that does.
            if all.len() > 1 && !self.is_met(&all[0]) {
                all.remove(0);
            }
        }
        if all[0].wrong > 0 {
            return Err(Error::NoDrop("strikes"));
        }
        all.sort_by(|a, b| a.score.above(&b.score).total_cmp(&0.0));
        let best = all[0].score;
        all.retain(|other| other.wrong == 0 && other.score.above(&best) <= SIMILAR);
        let matched = |of: Candidate| Matched {
            index: of.index,
            x: of.minimum.x,
            faults: of.premise.faults(),
            freed: of.premise.freed,
            is_plain,
        };
        Ok(all.into_iter().map(matched).collect())
    }

    /// What else may be, in the order in which it is tried: all strikes with more freedom, or one that is missing or wrong; then two
    /// that are missing. Flights with contacts take too long for more than one wrong time.
    fn rounds(&self, outlier: Option<usize>) -> Vec<Vec<Premise>> {
        let count = self.strikes.len();
        if self.drop.contacts {
            let wrong = |k| Premise { left_out: Some((k, true)), ways: count, ..Premise::default() };
            return vec![outlier.map(wrong).into_iter().collect()];
        }
        let freed = [SPEED, DIFFERENCE].into_iter().filter(|&unknown| unknown != DIFFERENCE || count > ENOUGH_FOR_BOTH);
        let freed = freed.map(|unknown| Premise { freed: Some(unknown), ..Premise::default() });
        // What is odd is among the strikes that do not go together; where a single time is off, it is that one.
        let all = count.min(PLACES);
        let places = all.min(self.reach.max(1));
        let wrong = (0..places)
            .flat_map(|k| [true, false].map(|is_strike| (k, is_strike)))
            .filter(|wrong| *wrong != (count - 1, false))
            .chain(outlier.filter(|k| *k >= places).map(|k| (k, true)));
        let wrong = wrong.map(|left_out| Premise { left_out: Some(left_out), ways: 2 * all, ..Premise::default() });
        let one = (0..places).map(|k| Premise { missing: vec![k], ways: all, ..Premise::default() });
        let pairs = (0..places).flat_map(|k| (k..all).map(move |j| vec![k, j]));
        let ways = all * (all + 1) / 2;
        let two = pairs.map(|missing| Premise { missing, ways, ..Premise::default() });
        vec![freed.chain(wrong).chain(one).collect(), two.collect()]
    }

    /// So many unknowns, the first that strikes tell.
    fn free(&self, premise: &Premise, used: usize) -> Vec<usize> {
        let all =
            [Some(OFFSET), Some(GAP_TIME), Some(RESTITUTION), (!self.drop.known.gyration_known).then_some(GYRATION)];
        let most = if self.known { used } else { used.saturating_sub(1) };
        all.into_iter().flatten().chain(premise.freed).take(most).collect()
    }

    /// Logarithms of the speed in the middle and at the ends of its range.
    fn ln_speeds(&self) -> [f64; 3] {
        let middle = self.drop.given()[SPEED];
        let [_, half] = self.drop.range(SPEED).unwrap_or_default();
        [middle, middle - half, middle + half]
    }

    /// By how much later the second and third of the strikes may have been than they were measured.
    fn late_s(&self) -> [[f64; 2]; 5] {
        let used: Vec<f64> = self.drop.sets[0].measured();
        let late = |k: usize| match (&self.drop.sets[0], used.get(k).zip(used.get(k + 1))) {
            (Set::Strikes { deviation, .. }, _) if self.known => DEVIATIONS * deviation,
            (_, Some((before, after))) => UNTOLD * (after - before),
            _ => 0.0,
        };
        let [second, third] = [0, 1].map(late);
        [[0.0, 0.0], [second, 0.0], [-second, 0.0], [0.0, third], [0.0, -third]]
    }

    /// Takes a premise: free unknowns, and those with the ones that the file gives in a range.
    fn assume(&mut self, premise: &Premise) -> (Vec<usize>, Vec<usize>) {
        let index = premise.index(self.strikes);
        self.take(&index);
        self.drop.ranged = self.ranged.iter().copied().filter(|unknown| premise.freed != Some(*unknown)).collect();
        let free = self.free(premise, index.iter().flatten().count());
        let all = self.drop.with_ranged(&free);
        (free, all)
    }

    /// Fits under a premise: the minima that differ, the best first. From the drops that meet the first strikes, through more and more
    /// of them, as long as they are explained.
    fn staged(&mut self, premise: &Premise) -> Vec<Candidate> {
        let (free, all) = self.assume(premise);
        let mut begins = meeting(&self.drop, &free, self.drop.given()[SPEED], RESTITUTIONS, [0.0; 2]).met;
        if begins.is_empty() {
            begins = starts(&self.drop, 1);
        }
        let used = self.drop.sets[0].len();
        let stages = self.stages(used, free.len());
        let (mut whole, mut furthest) = (Vec::new(), (0, Vec::new(), f64::INFINITY));
        for x in begins.iter().take(TAKEN) {
            let (count, x, sum) = self.through(&stages, x, &all, free.len());
            if count == used {
                whole.push(x);
            } else if count > furthest.0 || count == furthest.0 && sum < furthest.2 {
                furthest = (count, x, sum);
            }
        }
        if *premise == Premise::default() {
            self.reach = if whole.is_empty() { furthest.0 } else { used };
        }
        if whole.is_empty() {
            whole.push(furthest.1);
        }
        self.from(premise, &whole)
    }

    /// The same from more drops that meet some of the first strikes or nearly so, over the range of the speed too, and through all
    /// strikes at once: where the noise of few strikes leads away from the minimum of all.
    fn thorough(&mut self, premise: &Premise) -> Vec<Candidate> {
        let (free, all) = self.assume(premise);
        let mut begins: Vec<(f64, Vec<f64>)> = Vec::new();
        for ln_speed in self.ln_speeds() {
            for late_s in self.late_s() {
                let near = meeting(&self.drop, &free, ln_speed, MORE_RESTITUTIONS, late_s).near;
                begins.extend(near.into_iter().map(|x| (misfit(&self.drop, &x), x)));
            }
        }
        begins.sort_by(|a, b| a.0.total_cmp(&b.0));
        begins.truncate(MORE_TAKEN);
        // Most lead nowhere: a few steps tell which.
        let quick = self.drop.quick_problem();
        let mut near: Vec<Minimum> = begins.iter().map(|(_, x)| quick.minimize(x, &all)).collect();
        drop(quick);
        near.sort_by(|a, b| a.sum().total_cmp(&b.sum()));
        near.truncate(begins.len().div_ceil(3));
        let mut begins: Vec<Vec<f64>> = near.into_iter().map(|minimum| minimum.x).collect();
        // And from unknowns that meet none exactly, through more and more of the strikes, whether these are explained or not.
        let stages = self.stages(self.drop.sets[0].len(), free.len());
        let through = |x| stages.iter().fold(x, |x: Vec<f64>, (_, stage)| stage.problem().minimize(&x, &all).x);
        begins.extend(starts(&self.drop, TAKEN).into_iter().map(through));
        self.from(premise, &begins)
    }

    /// The same from these.
    fn from(&mut self, premise: &Premise, begins: &[Vec<f64>]) -> Vec<Candidate> {
        let (free, all) = self.assume(premise);
        let index = premise.index(self.strikes);
        let problem = self.drop.problem();
        // Where the time is over, the first one has to do.
        let has_time = |(k, _): &(usize, &Vec<f64>)| *k == 0 || self.drop.left.get() > 0;
        let begins = begins.iter().enumerate().take_while(has_time);
        let mut found: Vec<Candidate> =
            begins.map(|(_, x)| self.rated(premise, &index, &free, problem.minimize(x, &all))).collect();
        found.sort_by(Candidate::order);
        found.dedup_by(|a, b| a.is_same(b));
        found
    }

    /// The drop with its first strikes alone, as many as unknowns and then a third more each time, up to all that are used.
    fn stages(&self, used: usize, free: usize) -> Vec<(usize, Drop<'d>)> {
        let mut stages = Vec::new();
        let mut count = free;
        while count < used {
            stages.push((count, self.drop.first(count)));
            count += (count / 4).max(1);
        }
        stages.push((used, self.drop.clone()));
        stages
    }

    /// Each strike multiplies what is off before it: the first ones come first, then more and more, as long as they are explained. How
    /// many that were, the unknowns, and the sum of squares.
    fn through(&self, stages: &[(usize, Drop<'d>)], x: &[f64], all: &[usize], free: usize) -> (usize, Vec<f64>, f64) {
        let mut at = (0, x.to_vec(), f64::INFINITY);
        for (count, stage) in stages {
            let minimum = stage.quick_problem().minimize(&at.1, all);
            at = (*count, minimum.x.clone(), minimum.sum());
            if !self.explains(at.2, count.saturating_sub(free)) {
                break;
            }
        }
        at
    }

    /// A minimum and what it is worth.
    fn rated(&self, premise: &Premise, index: &[Option<Which>], free: &[usize], minimum: Minimum) -> Candidate {
        let path = self.drop.path(&minimum.x);
        let computed = path.as_ref().map_or(&[][..], |path| path.strikes());
        let places: Vec<Option<usize>> =
            index.iter().map(|which| which.and_then(|which| which.find(&self.drop, computed))).collect();
        let is_wrong = |(strike, place): &(&MeasuredStrike, &Option<usize>)| {
            let computed = place.map(|place| self.drop.end(computed[place].point));
            strike.end.is_some_and(|end| computed.is_some_and(|computed| end != computed))
        };
        let wrong_ends = self.strikes.iter().zip(&places).filter(is_wrong).count();
        let invented = if self.drop.contacts { 0 } else { missing(&places).len() };
        let degrees = index.iter().flatten().count().saturating_sub(free.len());
        let floor = self.drop.least_scatter().powi(2);
        let data = self.strikes.len();
        #[expect(clippy::cast_precision_loss, reason = "a count of strikes")]
        let sum = minimum.sum().max(floor * data as f64);
        let score = Score::new(sum, data, free.len(), premise.faults(), self.known);
        Candidate {
            premise: premise.clone(),
            index: index.to_vec(),
            wrong: wrong_ends + invented.saturating_sub(premise.missing.len()),
            minimum,
            free: free.to_vec(),
            degrees,
            score,
        }
    }

    /// Goes on from where a fit is until its scatter and the range of the speed count as much as they should.
    fn settle(&mut self, fit: &mut Candidate) {
        self.take(&fit.index);
        let minimum = self.drop.settle(&fit.minimum.x, &fit.free, self.known);
        *fit = self.rated(&fit.premise, &fit.index, &fit.free, minimum);
    }

    /// Whether no more is left than clatter data have, and ends are right.
    fn is_met(&self, fit: &Candidate) -> bool {
        fit.wrong == 0 && self.explains(fit.minimum.sum(), fit.degrees)
    }

    /// Whether a sum of squares is no more than clatter data leave.
    fn explains(&self, sum: f64, degrees: usize) -> bool {
        if degrees == 0 {
            return true;
        }
        if self.known && !self.drop.contacts {
            return sum <= chi_square(CHANCE, degrees);
        }
        #[expect(clippy::cast_precision_loss, reason = "a count of strikes")]
        let scatter = (sum / degrees as f64).sqrt();
        scatter <= SUSPECT * self.drop.sets[0].variation(self.drop.unit_s)
    }

    /// Whether there are data enough for a premise.
    fn is_supported(&self, premise: &Premise) -> bool {
        let used = self.strikes.len() - usize::from(premise.left_out.is_some());
        let free = self.free(premise, used).len();
        free < used && Score::new(1.0, self.strikes.len(), free, premise.faults(), self.known).is_supported()
    }

    /// Whether an explanation other than the plain one is one: with as many unknowns as data anything is.
    fn counts(&self, fit: &Candidate) -> bool {
        fit.degrees > 0 && self.is_met(fit)
    }

    /// A time that is further off than chance explains: the externally studentized residual t_i = r_i/(s_(i) √(1 − h_i)) with the
    /// leverage h_i, the scatter s_(i) without it, and all strikes tried.
    fn outlier(&mut self, fit: &Candidate) -> Option<usize> {
        let spare = fit.degrees.checked_sub(usize::from(!self.known)).filter(|spare| *spare > 0)?;
        self.take(&fit.index);
        let all = self.drop.with_ranged(&fit.free);
        let q = self.drop.problem().jacobian(&fit.minimum.x, &all).qr().q();
        let sum = fit.minimum.sum();
        #[expect(clippy::cast_precision_loss, reason = "a count of strikes")]
        let (spare_count, count) = (spare as f64, fit.index.len() as f64);
        let studentized = fit.minimum.residuals.iter().take(fit.index.len()).enumerate().map(|(i, r)| {
            let room = (1.0 - q.row(i).norm_squared()).max(f64::EPSILON);
            let found = ((sum - r * r / room).max(0.0) / spare_count).max(self.drop.least_scatter().powi(2));
            let variance = if self.known { 1.0 } else { found };
            (i, r.abs() / (variance * room).sqrt())
        });
        let (worst, t) = studentized.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (t > student::two_sided(CHANCE / count, (!self.known).then_some(spare_count))).then_some(worst)
    }
}
