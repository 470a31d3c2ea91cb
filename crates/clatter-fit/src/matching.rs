//! This module finds which computed strikes the measured ones are.
//!
//! The plain explanation comes first: every measured strike is a computed one, and none is missing. Only where that is no explanation are
//! others tried, and these pay for every strike that they drop or invent ([`Score`]).

use super::criterion::{ALPHA, Faults, SIMILAR, Score, chi_square};
use super::drop::{Drop, GAP_TIME, GYRATION, OFFSET, RESTITUTION, SPEED};
use super::first_strikes::meeting;
use super::premise::Premise;
use super::records::missing;
use super::solve::{Minimum, Problem};
use super::starts::{FINE_GRID, ROUGH_GRID, TAKEN, misfit, on_grid, starts};
use super::student;
use super::{Error, MeasuredStrike, Set, Which};
use std::cmp::Ordering;

/// Restitutions among which starts are sought: between two of them the time of the next strike is mostly nearly a straight line.
const RESTITUTIONS: usize = 48;
/// Drops are sought that meet so many of the first strikes.
const MEETING: usize = 4;
/// So many drops go on at most where the plain explanation was not found among few.
const WIDELY_TAKEN: usize = 48;
/// Patience and precision of a search that only tells where to go on.
const QUICK_PATIENCE: usize = 12;
const QUICK_PRECISION: f64 = 1e-4;
/// So many of the first strikes are looked at over a grid, and of a rough and of a fine one so many drops go on.
const GRIDDED: usize = 8;
const OF_GRID: [usize; 2] = [160, 320];
/// That search takes this part of the flights that are left.
const WIDE_SHARE: usize = 3;
/// The first strikes are met there as they were measured and as they may be: by two standard deviations or, where none is given, a
/// hundredth of the time between them, which is as well as clatter is timed at least.
const DEVIATIONS: f64 = 2.0;
const UNTOLD: f64 = 0.01;
/// Data that scatter by more than this share of the mean time between strikes are not explained: with so much, nothing is determined.
pub(super) const SUSPECT: f64 = 0.05;
/// Nor are data that scatter by more than is given, or of which one is further off than the others explain, where chance does that
/// less often: so many sound records are taken for odd ones.
pub(super) const CHANCE: f64 = 1e-4;
/// A remainder that chance leaves more seldom than this calls for another search.
const UNLIKELY: f64 = 0.02;
/// Half a range of the speed, as a share, from which on searches begin at its ends too.
const WIDE: f64 = 0.02;
/// So many of the best minima are gone on from with central differences where they do not explain the record.
const POLISHED: usize = 3;
/// A strike that alone tells an unknown is met whatever its time: where its leverage is less than this from 1, roundings are all that
/// is left of its residual.
const LEAST_ROOM: f64 = 1e-4;

/// Minima are the same whose unknowns differ by no more.
const SAME: f64 = 1e-3;

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
    /// Returns whether it is the same minimum, found from another start.
    fn is_same(&self, other: &Self) -> bool {
        let is_near = |unknown: &usize| (self.minimum.x[*unknown] - other.minimum.x[*unknown]).abs() < SAME;
        self.free.iter().all(is_near)
    }
}

/// The assignment of the strikes of a record to computed ones.
#[derive(Debug, Clone)]
pub(super) struct Matched {
    pub(super) index: Vec<Option<Which>>,
    /// Unknowns that explain it.
    pub(super) x: Vec<f64>,
    /// The strikes that are dropped and invented.
    pub(super) faults: Faults,
    /// The unknown that is free in addition to those that such records determine at least.
    pub(super) freed: Option<usize>,
    /// True where nothing is odd.
    pub(super) is_plain: bool,
}

/// Finds what the strikes of a record may be: the best explanation, and those that are about as good. `known`: whether the deviation was
/// given. `hints`: what explains the record with the other end.
pub(super) fn find(drop: &Drop<'_>, set: usize, known: bool, hints: &[Vec<f64>]) -> Result<Vec<Matched>, Error> {
    let Set::Strikes { strikes, .. } = drop.sets[set] else { return Ok(Vec::new()) };
    let mut alone = Drop { sets: vec![drop.sets[set].clone()], is_rough: true, ..drop.clone() };
    alone.ranged = [SPEED].into_iter().filter(|&unknown| alone.range(unknown).is_some()).collect();
    let ranged = alone.ranged.clone();
    Search { drop: alone, strikes, known, ranged, reach: 0, begins: Vec::new() }.found(hints)
}

/// The data on which the drops that meet the first strikes depend: which strikes these are, what is free, and the speed.
#[derive(PartialEq)]
struct Of {
    first: Vec<(usize, Option<Which>)>,
    free: Vec<usize>,
    ln_speed: f64,
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
    /// Drops that meet the first strikes, as they were found.
    begins: Vec<(Of, Vec<Vec<f64>>)>,
}

impl<'d> Search<'d> {
    /// Takes measured strikes for these computed ones.
    fn take(&mut self, of_strikes: &[Option<Which>]) {
        if let Set::Strikes { index, .. } = &mut self.drop.sets[0] {
            index.clear();
            index.extend_from_slice(of_strikes);
        }
    }

    fn found(mut self, hints: &[Vec<f64>]) -> Result<Vec<Matched>, Error> {
        let premise = Premise::default();
        let mut plain = self.staged(&premise, false);
        plain.extend(self.from(&premise, hints));
        plain.sort_by(Candidate::order);
        for (grid, taken) in [ROUGH_GRID, FINE_GRID].into_iter().zip(OF_GRID) {
            if grid == FINE_GRID && self.is_likely(&plain[0]) {
                break;
            }
            plain.extend(self.gridded(&premise, grid, taken));
            plain.sort_by(Candidate::order);
        }
        plain.dedup_by(|a, b| a.is_same(b));
        let mut all = Vec::new();
        if !self.is_likely(&plain[0]) {
            // With more freedom strikes are met more easily, the plain explanation often with them.
            let freed = if self.drop.contacts { Vec::new() } else { Premise::freed(self.strikes.len()) };
            all = self.met(&freed);
            if all.is_empty() {
                // A part of the flights has to do, so that some are left for strikes that are odd.
                let left = self.drop.left.get();
                self.drop.left.set(left / WIDE_SHARE);
                plain.extend(self.staged(&premise, true));
                self.drop.left.set(left - left / WIDE_SHARE + self.drop.left.get());
                plain.sort_by(Candidate::order);
            }
        }
        self.drop.is_rough = false;
        self.settle(&mut plain[0]);
        let outlier = self.outlier(&plain[0]);
        let is_plain = self.is_met(&plain[0]) && outlier.is_none();
        if !is_plain {
            // Two strikes are missing only where one is not enough.
            let count = self.strikes.len();
            // Flights with contacts take too long for more than one wrong time.
            let rounds = if self.drop.contacts {
                [outlier.map(|k| Premise::wrong(count, k)).into_iter().collect(), Vec::new()]
            } else {
                Premise::rounds(count, self.reach, outlier)
            };
            for round in rounds {
                all.extend(self.met(&round));
                if !all.is_empty() {
                    break;
                }
            }
        }
        // A drop that does not explain the record does not count next to one that does.
        if is_plain {
            all.extend(plain);
        } else if all.is_empty() || self.is_met(&plain[0]) {
            all.push(plain.swap_remove(0));
        }
        all.retain(|one| one.wrong == 0);
        if all.is_empty() {
            return Err(Error::NoDrop("strikes"));
        }
        all.sort_by(|a, b| a.score.above(&b.score).total_cmp(&0.0));
        let best = all[0].score;
        let least = (all[0].premise.clone(), all[0].minimum.sum(), all[0].degrees);
        // An explanation that needs values beyond the ranges of the file does not displace one that needs none.
        let beyond = self.drop.beyond(&all[0].minimum.x);
        all.retain(|other| {
            let is_within = self.is_met(other) && self.drop.beyond(&other.minimum.x) < beyond;
            other.score.above(&best) <= SIMILAR || self.is_within(&least, other) || is_within
        });
        // Of those that are about as good, the one comes first that drops and invents least.
        all.sort_by_key(|other| other.premise.faults().count);
        let matched = |of: Candidate| Matched {
            index: of.index,
            x: of.minimum.x,
            faults: of.premise.faults(),
            freed: of.premise.freed,
            is_plain,
        };
        Ok(all.into_iter().map(matched).collect())
    }

    /// Finds the minima next to the best drops of a grid over the ranges, of strikes with instant impacts: of those that explain the first
    /// strikes.
    fn gridded(&mut self, premise: &Premise, grid: [u32; 3], taken: usize) -> Vec<Candidate> {
        if !self.drop.is_quick() {
            return Vec::new();
        }
        let (free, all) = self.assume(premise);
        let count = self.drop.sets[0].len().min(GRIDDED);
        let early = self.drop.first(count);
        // The grid counts its flights itself, and so many strikes are quickly followed.
        let left = self.drop.left.replace(usize::MAX);
        let problem = early.problem();
        let mut begins: Vec<Minimum> = Vec::new();
        for x in on_grid(&early, &free, grid, taken) {
            let minimum = problem.minimize(&x, &all);
            let is_same =
                |other: &Minimum| free.iter().all(|&unknown| (minimum.x[unknown] - other.x[unknown]).abs() < SAME);
            if self.explains(minimum.sum(), count.saturating_sub(free.len())) && !begins.iter().any(is_same) {
                begins.push(minimum);
            }
        }
        self.drop.left.set(left);
        let begins: Vec<Vec<f64>> = begins.into_iter().map(|minimum| minimum.x).collect();
        self.from(premise, &begins)
    }

    /// Finds the explanations that meet the record, of those that are supported.
    fn met(&mut self, premises: &[Premise]) -> Vec<Candidate> {
        let mut met = Vec::new();
        for premise in premises {
            if self.drop.left.get() > 0 && self.is_supported(premise) {
                let found = self.staged(premise, false);
                met.extend(found.into_iter().filter(|one| self.is_met(one)));
            }
        }
        met
    }

    /// Returns so many unknowns, the first that strikes determine.
    fn free(&self, premise: &Premise, used: usize) -> Vec<usize> {
        let all =
            [Some(OFFSET), Some(GAP_TIME), Some(RESTITUTION), (!self.drop.known.gyration_known).then_some(GYRATION)];
        let most = if self.known { used } else { used.saturating_sub(1) };
        all.into_iter().flatten().chain(premise.freed).take(most).collect()
    }

    /// Logarithms of the speed in the middle and at the ends of its range.
    fn ln_speeds(&self) -> Vec<f64> {
        let middle = self.drop.given()[SPEED];
        match self.drop.range(SPEED) {
            Some([_, half]) if half > WIDE => vec![middle, middle - half, middle + half],
            _ => vec![middle],
        }
    }

    /// Returns by how much later the second and third of the strikes may have been than they were measured.
    fn late_s(&self) -> [[f64; 2]; 4] {
        let used: Vec<f64> = self.drop.sets[0].measured();
        let late = |k: usize| match (&self.drop.sets[0], used.get(k).zip(used.get(k + 1))) {
            (Set::Strikes { deviation, .. }, _) if self.known => DEVIATIONS * deviation,
            (_, Some((before, after))) => UNTOLD * (after - before),
            _ => 0.0,
        };
        let [second, third] = [0, 1].map(late);
        [[second, 0.0], [-second, 0.0], [0.0, third], [0.0, -third]]
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
    /// of them, as long as they are explained. `wide`: from those as well that meet the first strikes as they may be within their noise
    /// and at other speeds of the range, and from drops that meet none exactly.
    fn staged(&mut self, premise: &Premise, wide: bool) -> Vec<Candidate> {
        let (free, all) = self.assume(premise);
        let is_plain = *premise == Premise::default();
        let speeds = if is_plain { self.ln_speeds() } else { self.ln_speeds()[..1].to_vec() };
        let late_s = self.late_s();
        let late_s = if wide { &late_s[..] } else { &[] };
        let ways =
            speeds.iter().map(|speed| (*speed, [0.0; 2])).chain(late_s.iter().map(|late_s| (speeds[0], *late_s)));
        let mut begins: Vec<(f64, Vec<f64>)> = Vec::new();
        for (ln_speed, late_s) in ways {
            let met = self.meeting(&free, ln_speed, late_s, wide);
            begins.extend(met.into_iter().map(|x| (misfit(&self.drop, &x), x)));
        }
        begins.sort_by(|a, b| a.0.total_cmp(&b.0));
        begins.truncate(if wide { WIDELY_TAKEN } else { TAKEN });
        if begins.is_empty() {
            begins.extend(starts(&self.drop, 1).into_iter().map(|x| (0.0, x)));
        }
        let mut direct = Vec::new();
        if wide {
            let best: Vec<Vec<f64>> = begins.iter().take(2 * TAKEN).map(|(_, x)| x.clone()).collect();
            direct = self.from(premise, &best);
            if self.is_likely(&direct[0]) {
                return direct;
            }
            self.assume(premise);
        }
        let used = self.drop.sets[0].len();
        let stages = self.stages(used, free.len());
        let (mut whole, mut furthest) = (Vec::new(), (0, Vec::new(), f64::INFINITY));
        for (k, (_, x)) in begins.iter().enumerate() {
            if k > 0 && self.drop.left.get() == 0 {
                break;
            }
            let (count, x, sum) = self.through(&stages, x, &all, free.len());
            if count == used {
                whole.push(x);
            } else if count > furthest.0 || count == furthest.0 && sum < furthest.2 {
                furthest = (count, x, sum);
            }
        }
        if is_plain && !wide {
            self.reach = if whole.is_empty() { furthest.0 } else { used };
        }
        if whole.is_empty() {
            whole.push(furthest.1);
        }
        if wide && self.drop.left.get() > 0 {
            let through = |x| stages.iter().fold(x, |x: Vec<f64>, (_, stage)| stage.problem().minimize(&x, &all).x);
            whole.extend(starts(&self.drop, TAKEN).into_iter().map(through));
        }
        let mut found = self.from(premise, &whole);
        found.extend(direct);
        found.sort_by(Candidate::order);
        found
    }

    /// Finds drops that meet the first strikes. Premises that are odd after these have the same ones.
    fn meeting(&mut self, free: &[usize], ln_speed: f64, late_s: [f64; 2], wide: bool) -> Vec<Vec<f64>> {
        let Set::Strikes { index, .. } = &self.drop.sets[0] else { return Vec::new() };
        let used = index.iter().enumerate().filter(|(_, which)| which.is_some());
        let of =
            Of { first: used.map(|(k, which)| (k, *which)).take(MEETING).collect(), free: free.to_vec(), ln_speed };
        if wide {
            return meeting(&self.drop, free, ln_speed, RESTITUTIONS, late_s, true);
        }
        if let Some((_, known)) = self.begins.iter().find(|(known, _)| *known == of) {
            return known.clone();
        }
        let found = meeting(&self.drop, free, ln_speed, RESTITUTIONS, late_s, false);
        self.begins.push((of, found.clone()));
        found
    }

    /// Finds the same from these unknowns.
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
        // Where a strike is late since the end that strikes hardly moves, differences to one side are too coarse.
        let central = Problem { one_sided: false, ..self.drop.problem() };
        for one in found.iter_mut().take(POLISHED).take_while(|one| one.wrong == 0) {
            if !self.is_likely(one) && self.drop.left.get() > 0 {
                *one = self.rated(premise, &index, &free, central.minimize(&one.minimum.x, &all));
            }
        }
        found.sort_by(Candidate::order);
        found.dedup_by(|a, b| a.is_same(b));
        found
    }

    /// Returns the drop with its first strikes alone, as many as unknowns and then a third more each time, up to all that are used.
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
            let problem = stage.problem();
            let quick =
                Problem { patience: problem.patience.min(QUICK_PATIENCE), precision: QUICK_PRECISION, ..problem };
            let minimum = quick.minimize(&at.1, all);
            at = (*count, minimum.x.clone(), minimum.sum());
            if !self.explains(at.2, count.saturating_sub(free)) {
                break;
            }
        }
        at
    }

    /// Returns a minimum and its score.
    fn rated(&self, premise: &Premise, index: &[Option<Which>], free: &[usize], minimum: Minimum) -> Candidate {
        let path = self.drop.path(&minimum.x);
        let computed = path.as_ref().map_or(&[][..], |path| &path.motion.strikes[..]);
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

    /// Returns whether no more is left than clatter data have, and ends are right.
    fn is_met(&self, fit: &Candidate) -> bool {
        fit.wrong == 0 && self.explains(fit.minimum.sum(), fit.degrees)
    }

    /// Returns whether another minimum of the same premise is within the interval of the best one.
    fn is_within(&self, (premise, sum, degrees): &(Premise, f64, usize), other: &Candidate) -> bool {
        #[expect(clippy::cast_precision_loss, reason = "a count of strikes")]
        let degrees = *degrees as f64;
        let variance = if self.known { 1.0 } else { sum / degrees };
        let t = student::two_sided(ALPHA, (!self.known).then_some(degrees));
        other.premise == *premise && degrees > 0.0 && other.minimum.sum() - sum <= variance * t * t
    }

    /// Returns the same where less is left than chance leaves in one of many records: else there may be a better minimum.
    fn is_likely(&self, fit: &Candidate) -> bool {
        let is_known = self.known && !self.drop.contacts;
        self.is_met(fit) && !(is_known && fit.degrees > 0 && fit.minimum.sum() > chi_square(UNLIKELY, fit.degrees))
    }

    /// Returns whether a sum of squares is no more than clatter data leave.
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

    /// Returns whether there are data enough for a premise: with as many unknowns as data anything is explained.
    fn is_supported(&self, premise: &Premise) -> bool {
        let used = self.strikes.len() - usize::from(premise.left_out.is_some());
        let free = self.free(premise, used).len();
        free < used && Score::new(1.0, self.strikes.len(), free, premise.faults(), self.known).is_supported()
    }

    /// Finds a time that is further off than chance explains: the externally studentized residual t_i = r_i/(s_(i) √(1 − h_i)) with the
    /// leverage h_i, the scatter s_(i) without it, and all strikes tried.
    fn outlier(&mut self, fit: &Candidate) -> Option<usize> {
        let spare = fit.degrees.checked_sub(usize::from(!self.known)).filter(|spare| *spare > 0)?;
        self.take(&fit.index);
        let all = self.drop.with_ranged(&fit.free);
        let q = self.drop.problem().jacobian(&fit.minimum.x, &all).qr().q();
        let sum = fit.minimum.sum();
        #[expect(clippy::cast_precision_loss, reason = "a count of strikes")]
        let (spare_count, count) = (spare as f64, fit.index.len() as f64);
        let studentized = fit.minimum.residuals.iter().take(fit.index.len()).enumerate().filter_map(|(i, r)| {
            let room = 1.0 - q.row(i).norm_squared();
            if room < LEAST_ROOM {
                return None;
            }
            let found = ((sum - r * r / room).max(0.0) / spare_count).max(self.drop.least_scatter().powi(2));
            let variance = if self.known { 1.0 } else { found };
            Some((i, r.abs() / (variance * room).sqrt()))
        });
        let (worst, t) = studentized.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (t > student::two_sided(CHANCE / count, (!self.known).then_some(spare_count))).then_some(worst)
    }
}
