//! This module finds what the data determine: which unknowns are left free, and how far they may be off.

use super::criterion::{ALPHA, Faults, SIMILAR, Score, chi_square};
use super::drop::{CONTACT, DIFFERENCE, Drop, GAP_TIME, GYRATION, OFFSET, RESTITUTION, SPEED, SPIN};
use super::matching::CHANCE as ODD;
use super::region::Region;
use super::solve::{Minimum, Problem};
use super::starts::{TAKEN, starts};
use super::student;
use super::{Error, Set};

/// The data determine a direction where the interval of 95 % along it is within these half-widths: a restitution to a quarter of all there
/// is, both ends apart to 0.02, a length or a time to a factor of √2, the speed to a fifth. More would not be of use in a product file.
fn half_width(unknown: usize) -> f64 {
    match unknown {
        RESTITUTION => 0.25,
        DIFFERENCE => 0.01,
        SPEED | SPIN => 0.2,
        GYRATION | GAP_TIME | CONTACT => 0.35,
        _ => 1.0,
    }
}

/// Returns the name of an unknown.
fn name(unknown: usize) -> &'static str {
    match unknown {
        GYRATION => "the radius of gyration",
        RESTITUTION => "the restitution",
        DIFFERENCE => "the difference of the ends",
        GAP_TIME => "the gap over the speed",
        SPEED => "the speed",
        SPIN => "the spin",
        CONTACT => "the contact time",
        _ => "the moment of the first touch",
    }
}

/// Part of a direction above which an unknown counts as part of it.
const PART: f64 = 0.3;
/// An unknown is freed, although the data do not tell it well, where they contradict the value at which it is held: chance explains
/// them less often than this. So many sound records get a restitution for each end. At a tenth of it, of records whose ends differ
/// by up to 0.1 only 42 of 100 would get two, not 66.
const CHANCE: f64 = 1e-2;

/// The fit with all that the data tell left free.
#[derive(Debug, Clone)]
pub(super) struct DeterminedFit {
    pub(super) minimum: Minimum,
    pub(super) free: Vec<usize>,
    /// Unknowns that are held, or within the range of the product file, and why.
    pub(super) held: Vec<(usize, String)>,
    pub(super) degrees: usize,
    /// Standard deviation of a residual, and the degrees of freedom that tell it; none where nothing does.
    pub(super) scatter: Option<(f64, Option<f64>)>,
    /// Residuals scatter more than the deviations given, by this factor: the drop does not explain the data.
    pub(super) excess: Option<f64>,
    /// The score by which it is compared with others.
    pub(super) score: Score,
    /// Strikes that are dropped or invented.
    pub(super) faults: usize,
}

/// Finds it. `known`: whether the deviations of all records are given; `begin`: unknowns that explain the data already, and the one that
/// is free in addition to those that such records determine at least; `faults`: the strikes that were dropped or invented.
pub(super) fn find(
    drop: &mut Drop<'_>,
    known: bool,
    begin: Option<(Vec<f64>, Option<usize>)>,
    faults: Faults,
) -> Result<DeterminedFit, Error> {
    let count: usize = drop.sets.iter().map(Set::len).sum();
    let (begins, freed) = if let Some((x, freed)) = begin {
        (vec![x], freed)
    } else {
        // The flights for a start do not count as a search.
        let left = drop.left.get();
        let begins = starts(drop, TAKEN);
        drop.left.set(left);
        (begins, None)
    };
    drop.is_rough = true;
    let mut search = Search { drop, known, count, faults };
    let mut told = search.base(&begins, freed)?;
    search.drop.is_rough = false;
    for again in [true, false] {
        // Records of several kinds count by how well each is explained.
        if search.drop.sets.len() > 1 && !known {
            search.drop.weigh(&told.minimum.x);
        }
        told.minimum = search.drop.settle(&told.minimum.x, &told.free, known);
        if again {
            search.hold_untold(&mut told);
            search.free_more(&mut told);
        }
        search.judge(&mut told);
    }
    Ok(told)
}

/// Shares of a record that are fitted before all of it.
const EARLY: [f64; 3] = [0.15, 0.3, 0.6];

impl Drop<'_> {
    /// Returns the same drop with the data measured up to a share of the time after the first touch; none of strikes alone.
    fn early(&self, x: &[f64], share: f64) -> Option<Self> {
        let mut early = self.clone();
        let mut cut = false;
        for (k, set) in early.sets.iter_mut().enumerate() {
            let touch_s = self.offset_s(x, k);
            match set {
                Set::Strikes { .. } => {}
                Set::Heights { samples, .. } => {
                    let end_s = samples.last()?.time_s;
                    let until_s = touch_s + share * (end_s - touch_s);
                    samples.truncate(samples.partition_point(|sample| sample.time_s <= until_s).max(4));
                    cut = true;
                }
                Set::Acceleration { start_s, step_s, values, .. } => {
                    #[expect(clippy::cast_precision_loss, reason = "at most 4096")]
                    let whole = values.len() as f64;
                    let touch = (touch_s - *start_s) / *step_s;
                    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
                    let count = (touch + share * (whole - touch)).clamp(8.0, whole.max(8.0)) as usize;
                    values.truncate(count);
                    cut = true;
                }
            }
        }
        cut.then_some(early)
    }

    /// Takes what the residuals of each record scatter by as its deviation.
    fn weigh(&mut self, x: &[f64]) {
        let residuals = self.residuals(x);
        let mut from = 0;
        for set in &mut self.sets {
            let own = &residuals[from..from + set.len()];
            from += own.len();
            #[expect(clippy::cast_precision_loss, reason = "a count of data")]
            let mean = own.iter().map(|r| r * r).sum::<f64>() / own.len() as f64;
            // A record that is met exactly shows nothing but that.
            if mean > 0.0 && mean.is_finite() {
                *set.deviation() *= mean.sqrt();
            }
        }
    }
}

struct Search<'s, 'd> {
    drop: &'s mut Drop<'d>,
    known: bool,
    count: usize,
    faults: Faults,
}

impl Search<'_, '_> {
    /// Fits from the best of the starts, with the unknowns that such records tell at least.
    fn base(&mut self, starts: &[Vec<f64>], freed: Option<usize>) -> Result<DeterminedFit, Error> {
        let has = |is: fn(&Set<'_>) -> bool| self.drop.sets.iter().any(is);
        let heights = has(|set| matches!(set, Set::Heights { .. }));
        let acceleration = has(|set| matches!(set, Set::Acceleration { .. }));
        let mut free: Vec<usize> = (OFFSET..OFFSET + self.drop.sets.len()).chain([GAP_TIME, RESTITUTION]).collect();
        if heights || acceleration {
            free.push(SPEED);
        }
        if acceleration {
            free.push(CONTACT);
        }
        if heights {
            free.push(SPIN);
        }
        if self.count > free.len() + usize::from(!self.known) && !self.drop.known.gyration_known {
            free.push(GYRATION);
        }
        free.extend(freed.filter(|unknown| !free.contains(unknown)));
        free.truncate(self.count);
        let ranged = [RESTITUTION, SPEED, CONTACT, GYRATION].into_iter().filter(|unknown| !free.contains(unknown));
        self.drop.ranged = ranged.filter(|&unknown| unknown != CONTACT || self.drop.contacts).collect();
        let drop = &*self.drop;
        self.drop.ranged = drop.ranged.iter().copied().filter(|&unknown| drop.range(unknown).is_some()).collect();
        let all = self.drop.with_ranged(&free);
        // Each strike multiplies what is off before it: the early part of a record comes first.
        let staged = |x: &Vec<f64>| {
            let x = EARLY.iter().fold(x.clone(), |x, share| match self.drop.early(&x, *share) {
                Some(early) => early.problem().minimize(&x, &all).x,
                None => x,
            });
            self.drop.problem().minimize(&x, &all)
        };
        let minimum = starts.iter().map(staged).min_by(|a, b| a.sum().total_cmp(&b.sum()));
        let minimum = minimum.filter(|minimum| self.drop.path(&minimum.x).is_some()).ok_or(Error::NoDrop("data"))?;
        let score = Score::new(0.0, 1, 0, Faults::default(), true);
        let mut told = DeterminedFit {
            minimum,
            free,
            held: Vec::new(),
            degrees: 0,
            scatter: None,
            excess: None,
            score,
            faults: self.faults.count,
        };
        self.judge(&mut told);
        Ok(told)
    }

    /// Degrees of freedom, scatter, and what it is worth.
    fn judge(&self, told: &mut DeterminedFit) {
        told.degrees = (self.count + self.drop.ranged.len()).saturating_sub(self.drop.with_ranged(&told.free).len());
        #[expect(clippy::cast_precision_loss, reason = "a count of data")]
        let (count, sum) = (self.count as f64, told.minimum.sum());
        told.scatter = self.scatter(&told.minimum, &told.free);
        // As many unknowns as data meet them, unless the search was left on the way.
        let degrees = told.degrees.max(1);
        let is_odd = self.known && sum > chi_square(ODD, degrees);
        #[expect(clippy::cast_precision_loss, reason = "a count of data")]
        let excess = || (sum / degrees as f64).sqrt();
        told.excess = is_odd.then(excess);
        let sum = sum.max(count * self.drop.least_scatter().powi(2));
        let dropped = self.drop.sets.iter().map(Set::left_out).sum::<usize>();
        told.score = Score::new(sum, self.count + dropped, told.free.len(), self.faults, self.known);
    }

    /// Leaves unknowns free, one by one, as long as the data tell them.
    fn free_more(&mut self, told: &mut DeterminedFit) {
        for unknown in [RESTITUTION, GYRATION, SPEED, CONTACT, SPIN, DIFFERENCE] {
            let is_held = told.held.iter().any(|(held, _)| *held == unknown);
            if told.free.contains(&unknown) || is_held || unknown == CONTACT && !self.drop.contacts {
                continue;
            }
            if let Err(reason) = self.free_one(told, unknown) {
                told.held.push((unknown, reason));
            }
        }
    }

    /// Leaves one more free, or says why not.
    fn free_one(&mut self, told: &mut DeterminedFit, unknown: usize) -> Result<(), String> {
        if unknown == GYRATION && self.drop.known.gyration_known {
            return Err("it was given as known".to_owned());
        }
        if unknown == DIFFERENCE && self.drop.contacts {
            return Err("contacts that take time are computed with one".to_owned());
        }
        // One datum more than unknowns: a second drop that explains the same would not be noticed without.
        // Where the timing is not given, neither is one that a range would explain.
        let ranged = if self.known { 0 } else { self.drop.ranged.iter().filter(|other| **other != unknown).count() };
        if told.free.len() + ranged + 2 > self.count {
            let few = format!("{} data are too few to check {} unknowns", self.count, told.free.len() + 1);
            return Err(if unknown == SPEED { self.reason(SPEED, &[], few) } else { few });
        }
        let mut more = told.free.clone();
        more.push(unknown);
        let ranged = self.drop.ranged.clone();
        self.drop.ranged.retain(|other| *other != unknown);
        let mut minimum = self.drop.problem().minimize(&told.minimum.x, &self.drop.with_ranged(&more));
        // The data may determine it less at the new minimum than at the old one. At the old one the scatter is not that of chance alone if
        // the value that is held is wrong.
        let untold = || {
            let before = self.untold(&told.minimum, &more, Some(unknown));
            before.or_else(|| self.untold(&minimum, &more, Some(unknown)))
        };
        let is_kept = unknown == SPEED && ranged.contains(&SPEED);
        if (is_kept || !self.contradicts(&told.minimum, &minimum, &more, CHANCE))
            && let Some((_, reason)) = untold()
        {
            self.drop.ranged = ranged;
            return Err(reason);
        }
        // The range of the speed stays a datum: of few strikes other speeds explain by chance what the true one does.
        if is_kept {
            self.drop.ranged = ranged;
            minimum = self.drop.settle(&told.minimum.x, &more, self.known);
        }
        (told.minimum, told.free) = (minimum, more);
        Ok(())
    }

    /// Holds the unknowns that turn out not to be determined after all, unless the data contradict the product file.
    fn hold_untold(&mut self, told: &mut DeterminedFit) {
        while let Some((unknown, reason)) = self.untold(&told.minimum, &told.free, None) {
            // The file has no range of the radius of gyration that the others could be widened by: where the intervals can be as
            // wide as the data leave them, it stays free.
            if unknown == GYRATION && self.drop.is_quick() {
                break;
            }
            let mut x = told.minimum.x.clone();
            x[unknown] = self.drop.given()[unknown];
            let free: Vec<usize> = told.free.iter().copied().filter(|free| *free != unknown).collect();
            let ranged = self.drop.ranged.clone();
            self.drop.ranged.extend(self.drop.range(unknown).map(|_| unknown));
            let minimum = self.drop.settle(&x, &free, self.known);
            if self.contradicts(&minimum, &told.minimum, &told.free, ALPHA) {
                self.drop.ranged = ranged;
                break;
            }
            (told.minimum, told.free) = (minimum, free);
            told.held.push((unknown, reason));
        }
    }

    /// Returns whether the data contradict the value at which an unknown is held: so much larger than with all of `free` the
    /// sum of squares is by chance less often than `alpha` (the F test of one unknown, where F is the square of Student's t).
    fn contradicts(&self, held: &Minimum, minimum: &Minimum, free: &[usize], alpha: f64) -> bool {
        let Some((scatter, degrees)) = self.scatter(minimum, free) else { return false };
        held.sum() - minimum.sum() > (student::two_sided(alpha, degrees) * scatter).powi(2)
    }

    /// Returns the standard deviation of a residual, and the degrees of freedom that tell it where it is not given; none where nothing
    /// tells it.
    fn scatter(&self, minimum: &Minimum, free: &[usize]) -> Option<(f64, Option<f64>)> {
        if self.known {
            return Some((1.0, None));
        }
        self.drop.scattered(minimum, free).map(|(scatter, degrees)| (scatter, Some(degrees)))
    }

    /// Returns an unknown that the data do not determine next to the others, and why; `last` is the one to name if it is part of it.
    fn untold(&self, minimum: &Minimum, free: &[usize], last: Option<usize>) -> Option<(usize, String)> {
        let (scatter, degrees) = self.scatter(minimum, free)?;
        let t = student::two_sided(ALPHA, degrees);
        let mut jacobian = self.drop.problem().jacobian(&minimum.x, free);
        for (mut column, unknown) in jacobian.column_iter_mut().zip(free) {
            column *= self.half_width(*unknown);
        }
        let svd = jacobian.svd(false, true);
        let directions = svd.v_t?;
        let least = svd.singular_values.imin();
        if svd.singular_values[least] >= scatter * t {
            return None;
        }
        let part = |k: usize| directions[(least, k)].abs();
        // Any record determines the time and the duration, or else it determines nothing.
        let can_be_held = |k: &usize| free[*k] < OFFSET && free[*k] != GAP_TIME;
        // Of those that undo each other, the one that was left free last is held.
        let largest = (0..free.len()).filter(can_be_held).rfind(|&k| part(k) > PART)?;
        let k = last.and_then(|last| free.iter().position(|f| *f == last)).unwrap_or(largest);
        let others: Vec<&str> = (0..free.len()).filter(|&i| i != k && part(i) > PART).map(|i| name(free[i])).collect();
        let little = format!("{} changes the data by too little", name(free[k]));
        Some((free[k], self.reason(free[k], &others, little)))
    }

    /// Returns how well an unknown has to be known to be of use: strikes are to tell it better than the product file.
    fn half_width(&self, unknown: usize) -> f64 {
        let is_given = matches!(unknown, SPEED | CONTACT) && self.drop.sets.iter().all(Set::is_strikes);
        let given = if is_given { self.drop.range(unknown).map_or(0.0, |[_, half]| half) } else { f64::INFINITY };
        half_width(unknown).min(given)
    }

    /// Returns the reason why an unknown is not determined: the unknowns that undo it, or else the given text.
    fn reason(&self, unknown: usize, others: &[&str], alone: String) -> String {
        let strikes = self.drop.sets.iter().all(Set::is_strikes);
        match (unknown, others) {
            (SPEED, _) if strikes => {
                "strike times alone tell the gap over the speed, not the gap and the speed".to_owned()
            }
            (_, []) => alone,
            (_, others) => {
                format!("what {} changes in the data, {} can change as well", name(unknown), others.join(" and "))
            }
        }
    }
}

impl DeterminedFit {
    /// Returns whether it is about as good as the best one: by the criterion, or within its interval where the strikes are taken for the
    /// same.
    pub(super) fn is_about_as_good(&self, best: &Self) -> bool {
        let (scatter, degrees) = best.scatter.unwrap_or((1.0, None));
        let rise = (scatter * student::two_sided(ALPHA, degrees)).powi(2);
        let is_within = self.faults == best.faults && self.minimum.sum() - best.minimum.sum() <= rise;
        self.excess.is_none() && (is_within || self.score.above(&best.score) <= SIMILAR)
    }

    /// Returns how far the unknowns, `all` that are free or within a range, may be off together; none where nothing tells the scatter, or
    /// where the drop does not explain the data.
    pub(super) fn region<'a>(&'a self, problem: &'a Problem<'a>, all: &'a [usize]) -> Option<Region<'a>> {
        if self.excess.is_some() {
            return None;
        }
        let (scatter, degrees) = self.scatter?;
        Region::new(problem, &self.minimum, all, scatter * student::two_sided(ALPHA, degrees))
    }
}

#[cfg(test)]
mod tests {
    use super::super::solve::PRECISION;
    use super::*;

    /// A straight line through five data, 0.9, 3.2, 4.9, 7.1 and 8.9 at 0, 1, 2, 3 and 4: the slope is 1.99, the residuals square to
    /// 0.079 over 3 degrees of freedom. Textbooks have it within t σ/√Σ(x − x̄)², with t = 3.182446, σ = √(0.079/3) and 10 for the sum;
    /// where σ is known, within 1.959964 σ/√10.
    #[test]
    fn an_interval_is_that_of_textbooks_where_all_is_linear() {
        let data = [0.9, 3.2, 4.9, 7.1, 8.9];
        let line = |x: &[f64]| data.iter().zip(0..).map(|(y, t)| y - x[0] - x[1] * f64::from(t)).collect();
        let problem = Problem {
            residuals: Box::new(line),
            bounds: vec![[-100.0, 100.0]; 2],
            step: 1e-4,
            one_sided: false,
            patience: 100,
            precision: PRECISION,
        };
        let minimum = problem.minimize(&[0.0; 2], &[0, 1]);
        assert!((minimum.x[1] - 1.99).abs() < 1e-9 && (minimum.sum() - 0.079).abs() < 1e-9, "{minimum:?}");
        let sigma = (minimum.sum() / 3.0).sqrt();
        for (scatter, t) in [((sigma, Some(3.0)), 3.182_446_305), ((0.4, None), 1.959_963_985)] {
            let score = Score::new(0.0, 1, 0, Faults::default(), true);
            let told = DeterminedFit {
                minimum: minimum.clone(),
                free: vec![0, 1],
                held: Vec::new(),
                degrees: 3,
                scatter: Some(scatter),
                excess: None,
                score,
                faults: 0,
            };
            let half = t * scatter.0 / 10_f64.sqrt();
            let region = told.region(&problem, &[0, 1]).unwrap();
            let [below, above] = region.ends(&|x| x[1]).map(|end| end[1] - 1.99);
            // Ends are searched to within 2 % and then carried on along a straight line, which here they are on.
            assert!(
                (below / -half - 1.0).abs() < 1e-6 && (above / half - 1.0).abs() < 1e-6,
                "{below}, {above}: {half}"
            );
        }
    }
}
