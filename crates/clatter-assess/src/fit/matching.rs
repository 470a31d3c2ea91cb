//! Which computed strikes the measured ones are.

use super::drop::{DIFFERENCE, Drop, GAP_TIME, GYRATION, OFFSET, RESTITUTION};
use super::solve::Minimum;
use super::starts::{TAKEN, starts};
use super::student;
use super::{Error, MeasuredStrike, Set, Which};
use std::cmp::Ordering;

use clatter::End;

/// Starts that go on where fewer have not led to a fit.
const MORE_TAKEN: usize = 24;
/// Starts that go on for each thing that may be wrong.
const TRIED: usize = 3;
/// More strikes than these can tell both ends apart and that they do.
const ENOUGH_FOR_BOTH: usize = 6;
/// Strikes may be missing before so many of the first measured ones.
const PLACES: usize = 16;
/// A fit is tried again where its scatter passes this share of the mean time between strikes: with so much, nothing is told.
pub(super) const SUSPECT: f64 = 0.05;
/// A fit with strikes missing or left out counts where chance makes the scatter of the plain one so much larger with this
/// probability, over all that was tried.
const CHANCE: f64 = 1e-3;
/// The same of one time that is wrong, where nothing else is odd: so many sound records lose a time.
const WRONG: f64 = 1e-3;

/// What is wrong with a record.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Faults {
    /// Measured strikes, from 0, before each of which a computed one is missing.
    missing: Vec<usize>,
    /// A measured strike that is left out, and whether it is one at a wrong time; else it is none at all.
    left_out: Option<(usize, bool)>,
}

impl Faults {
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
    index: Vec<Option<Which>>,
    /// Strikes of the other end than measured.
    wrong_ends: usize,
    minimum: Minimum,
    free: usize,
}

impl Candidate {
    /// The better one is less: by ends, then by the scatter for the degrees of freedom, so that nothing is gained by leaving out a
    /// strike alone.
    fn order(&self, other: &Self) -> Ordering {
        let key = |fit: &Self| {
            #[expect(clippy::cast_precision_loss, reason = "a count of strikes")]
            let scatter = if fit.degrees() > 0 { fit.minimum.sum() / fit.degrees() as f64 } else { f64::INFINITY };
            [scatter, fit.minimum.sum()]
        };
        let [[a, c], [b, d]] = [key(self), key(other)];
        self.wrong_ends.cmp(&other.wrong_ends).then(a.total_cmp(&b)).then(c.total_cmp(&d))
    }
    fn degrees(&self) -> usize {
        self.minimum.residuals.len().saturating_sub(self.free)
    }
}

/// What the strikes of a record are found to be.
pub(super) struct Found {
    index: Vec<Option<Which>>,
    /// Unknowns that explain it.
    pub(super) x: Vec<f64>,
    /// Whether nothing is odd.
    pub(super) is_plain: bool,
}

/// Finds what the strikes of a record are, and writes it into the set. `known`: whether the deviation was given.
pub(super) fn find(drop: &mut Drop<'_>, set: usize, known: bool) -> Result<Found, Error> {
    let Set::Strikes { strikes, .. } = drop.sets[set] else {
        return Ok(Found { index: Vec::new(), x: drop.given(), is_plain: true });
    };
    let alone = Drop { sets: vec![drop.sets[set].clone()], is_rough: true, ..drop.clone() };
    let found = Search { drop: alone, strikes, known, ends_differ: false }.found()?;
    if let Set::Strikes { index: of_set, .. } = &mut drop.sets[set] {
        of_set.clone_from(&found.index);
    }
    Ok(found)
}

/// The search in one record.
struct Search<'d> {
    /// With this record alone.
    drop: Drop<'d>,
    strikes: &'d [MeasuredStrike],
    known: bool,
    /// Whether each end has a restitution of its own.
    ends_differ: bool,
}

impl Search<'_> {
    /// Takes measured strikes for these computed ones.
    fn take(&mut self, of_strikes: &[Option<Which>]) {
        if let Set::Strikes { index, .. } = &mut self.drop.sets[0] {
            index.clear();
            index.extend_from_slice(of_strikes);
        }
    }

    fn found(mut self) -> Result<Found, Error> {
        let count = self.strikes.len();
        let mut best = self.candidate(&Faults::default(), TAKEN);
        if self.is_suspect(&best) {
            best = self.candidate(&Faults::default(), if self.drop.contacts { MORE_TAKEN / 3 } else { MORE_TAKEN });
        }
        let one_missing = (0..count.min(PLACES)).map(|k| Faults { missing: vec![k], left_out: None });
        let one_wrong = (0..count.min(PLACES)).flat_map(|k| {
            [true, false].map(|is_strike| Faults { missing: Vec::new(), left_out: Some((k, is_strike)) })
        });
        let two_missing = (0..count.min(PLACES))
            .flat_map(|k| (k..count.min(PLACES)).map(move |j| Faults { missing: vec![k, j], left_out: None }));
        let rounds: [Vec<Faults>; 2] = [one_missing.chain(one_wrong).collect(), two_missing.collect()];
        // Flights with contacts take too long for hundreds of fits.
        let rounds = if self.drop.contacts { &[][..] } else { &rounds[..] };
        if self.is_suspect(&best) && !self.drop.contacts && count > ENOUGH_FOR_BOTH {
            self.ends_differ = true;
            let apart = self.candidate(&Faults::default(), MORE_TAKEN);
            self.ends_differ = !self.is_suspect(&apart) && self.is_better(&best, &apart, 1);
            if self.ends_differ {
                best = apart;
            }
        }
        let is_plain = !self.is_suspect(&best);
        for round in rounds {
            if !self.is_suspect(&best) || self.drop.left.get() == 0 {
                break;
            }
            let mut other: Option<Candidate> = None;
            for faults in round {
                let next = self.candidate(faults, TRIED);
                if other.as_ref().is_none_or(|other| next.order(other) == Ordering::Less) {
                    other = Some(next);
                }
                if self.drop.left.get() == 0 {
                    break;
                }
            }
            if let Some(other) = other
                && self.is_better(&best, &other, round.len())
            {
                best = other;
            }
        }
        if best.wrong_ends > 0 {
            return Err(Error::NoDrop("strikes"));
        }
        if self.drop.contacts {
            self.drop.is_rough = false;
            self.take(&best.index);
            best.minimum = self.drop.problem().minimize(&best.minimum.x, &self.free(best.free));
        }
        let is_whole = best.index.iter().all(Option::is_some);
        if is_whole && let Some(k) = self.outlier(&best) {
            let left_out = best.index.iter().enumerate().map(|(i, index)| if i == k { None } else { *index });
            return Ok(Found { index: left_out.collect(), x: best.minimum.x, is_plain });
        }
        Ok(Found { index: best.index, x: best.minimum.x, is_plain })
    }

    /// So many unknowns, the first that strikes tell.
    fn free(&self, most: usize) -> Vec<usize> {
        let all = [
            Some(OFFSET),
            Some(GAP_TIME),
            Some(RESTITUTION),
            (!self.drop.known.gyration_known).then_some(GYRATION),
            self.ends_differ.then_some(DIFFERENCE),
        ];
        all.into_iter().flatten().take(most).collect()
    }

    /// The drop with its first strikes alone, as many as unknowns and then a third more each time.
    fn stages(&self, index: &[Option<Which>], free: usize) -> Vec<Drop<'_>> {
        let mut stages = Vec::new();
        let mut count = free.max(3);
        while count < index.len() {
            let mut stage = self.drop.clone();
            if let Set::Strikes { index: of_stage, .. } = &mut stage.sets[0] {
                of_stage[count..].fill(None);
            }
            stages.push(stage);
            count += (count / 3).max(1);
        }
        stages
    }

    /// The best fit for what may be wrong with the record.
    fn candidate(&mut self, faults: &Faults, taken: usize) -> Candidate {
        let strikes = self.strikes;
        let index = faults.index(strikes);
        let used = index.iter().flatten().count();
        self.take(&index);
        let free = self.free(if self.known { used } else { used.saturating_sub(1) });
        // Each strike multiplies what is off before it: the first ones come first, then more and more.
        let stages: Vec<Drop<'_>> = self.stages(&index, free.len());
        let minimum = |x: Vec<f64>| {
            let x = stages.iter().fold(x, |x, stage| stage.problem().minimize(&x, &free).x);
            let minimum = self.drop.problem().minimize(&x, &free);
            let path = self.drop.path(&minimum.x);
            let computed = path.as_ref().map_or(&[][..], |path| path.strikes());
            let is_wrong = |(strike, index): (&MeasuredStrike, &Option<Which>)| {
                let computed = index.and_then(|which| which.find(&self.drop, computed)).map(|k| computed[k]);
                computed.is_some_and(|computed| strike.end.is_some_and(|end| end != self.drop.end(computed.point)))
            };
            let wrong_ends = strikes.iter().zip(&index).filter(|pair| is_wrong(*pair)).count();
            Candidate { index: index.clone(), wrong_ends, minimum, free: free.len() }
        };
        // One at least.
        let starts = starts(&self.drop, taken).into_iter().enumerate();
        let candidates = starts.take_while(|(k, _)| *k == 0 || self.drop.left.get() > 0).map(|(_, x)| minimum(x));
        let best = candidates.min_by(Candidate::order);
        // The grid has hundreds of starts.
        best.unwrap_or_else(|| minimum(self.drop.given()))
    }

    /// Whether the scatter is more than clatter data have, or ends are wrong.
    fn is_suspect(&self, fit: &Candidate) -> bool {
        let degrees = fit.degrees();
        #[expect(clippy::cast_precision_loss, reason = "a count of strikes")]
        let (count, sum) = (degrees as f64, fit.minimum.sum());
        if fit.wrong_ends > 0 {
            return true;
        }
        if degrees == 0 {
            return false;
        }
        if self.known && !self.drop.contacts {
            // Five standard deviations of χ².
            return sum > count + 5.0 * (2.0 * count).sqrt();
        }
        (sum / count).sqrt() * self.deviation_s() > SUSPECT * self.drop.unit_s
    }

    fn deviation_s(&self) -> f64 {
        if let Set::Strikes { deviation, .. } = &self.drop.sets[0] { *deviation } else { 1.0 }
    }

    /// Whether chance does not explain that the other fit is so much better, out of so many.
    fn is_better(&self, plain: &Candidate, other: &Candidate, tried: usize) -> bool {
        if other.wrong_ends != plain.wrong_ends {
            return other.wrong_ends < plain.wrong_ends;
        }
        // As many unknowns as data explain anything.
        if other.degrees() == 0 {
            return false;
        }
        #[expect(clippy::cast_precision_loss, reason = "some hundred")]
        let alpha = CHANCE / tried as f64;
        let (before, after) = (plain.minimum.sum(), other.minimum.sum());
        if self.known {
            // What an unknown more takes off χ² is the square of a normal number.
            return before - after > student::two_sided(alpha, None).powi(2);
        }
        let degrees = plain.degrees().min(other.degrees());
        if degrees == 0 {
            return false;
        }
        // The ratio F of two equal scatters is t distributed as (√F − 1/√F) √ν/2 (Cacoullos 1965).
        #[expect(clippy::cast_precision_loss, reason = "a count of strikes")]
        let (n, m, ratio) = (degrees as f64, other.degrees() as f64, before / plain.degrees() as f64 / after);
        let root = (ratio * m).sqrt();
        0.5 * n.sqrt() * (root - 1.0 / root) > student::two_sided(2.0 * alpha, Some(degrees))
    }

    /// A time that is further off than chance explains: the externally studentized residual t_i = r_i/(s_(i) √(1 − h_i)) with the
    /// leverage h_i, the scatter s_(i) without it, and all strikes tried.
    fn outlier(&mut self, fit: &Candidate) -> Option<usize> {
        let spare = fit.degrees().checked_sub(usize::from(!self.known)).filter(|spare| *spare > 0)?;
        self.take(&fit.index);
        let free = self.free(fit.free);
        let q = self.drop.problem().jacobian(&fit.minimum.x, &free).qr().q();
        let sum = fit.minimum.sum();
        #[expect(clippy::cast_precision_loss, reason = "a count of strikes")]
        let (spare_count, count) = (spare as f64, fit.minimum.residuals.len() as f64);
        let studentized = fit.minimum.residuals.iter().enumerate().map(|(i, r)| {
            let room = (1.0 - q.row(i).norm_squared()).max(f64::EPSILON);
            let variance = if self.known { 1.0 } else { (sum - r * r / room).max(0.0) / spare_count };
            (i, r.abs() / (variance * room).sqrt())
        });
        let (worst, t) = studentized.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let degrees = if self.known { None } else { Some(spare) };
        let is_wrong = t > student::two_sided(WRONG / count, degrees);
        // Of the strikes that are used.
        is_wrong
            .then(|| fit.index.iter().enumerate().filter(|(_, index)| index.is_some()).nth(worst).map(|(k, _)| k))?
    }
}
