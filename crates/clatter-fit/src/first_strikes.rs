//! This module finds where searches begin in the strikes of one record: drops that meet the first of them exactly.
//!
//! Each strike multiplies what is off before it, so that the sum of squares over all strikes has a valley that is long and
//! narrow. Its floor is found first: for any restitution the times of the second and third strike tell the gap over the speed and the
//! radius of gyration. Along the floor the next strike tells which restitutions there are.

use super::drop::{Drop, GAP_TIME, GYRATION, OFFSET, RESTITUTION, SPEED};
use super::starts::by_strikes;
use super::{Set, Which};

/// Radii of gyration from which the one is sought that fits the first strikes, over that of the product file.
const GYRATIONS: [f64; 7] = [1.0, 0.85, 1.2, 0.7, 1.4, 0.5, 2.0];
/// Steps of a search at most.
const STEPS: usize = 10;
/// So many times the space between two restitutions is halved, for the next strike and for those after it: one that is late since the
/// end that strikes hardly moves needs more.
const HALVED: [usize; 2] = [6, 30];
/// Strikes after the first ones that are met one by one in a wide search.
const LATER: usize = 4;
/// Strikes are met that are off by this share of the mean time between them: far below what tells restitutions apart.
const MET: f64 = 1e-6;
/// A step of an unknown for its derivative, and the longest one of a search; both as shares.
const SMALL: f64 = 1e-6;
const LONGEST: f64 = 0.5;

/// Finds drops that meet the first strikes, for a speed as a logarithm and among so many restitutions. The second and third strike are met
/// later by `late_s`, which noise may be.
pub(super) fn meeting(
    drop: &Drop<'_>,
    free: &[usize],
    ln_speed: f64,
    restitutions: usize,
    late_s: [f64; 2],
    wide: bool,
) -> Vec<Vec<f64>> {
    let mut rigid = Drop { is_rough: false, ..drop.clone() };
    (rigid.contacts, rigid.ranged) = (false, Vec::new());
    let solved: Vec<usize> = [GAP_TIME, GYRATION].into_iter().filter(|unknown| free.contains(unknown)).collect();
    let floor = Floor {
        drop: rigid.first(solved.len() + 1),
        next: rigid.first(solved.len() + 1 + if wide { LATER } else { 1 }),
        solved,
        late_s,
    };
    let mut given = drop.given();
    given[SPEED] = ln_speed;
    let along = if free.contains(&RESTITUTION) {
        floor.along(&given, restitutions)
    } else {
        vec![floor.at(given[RESTITUTION], None, &given)]
    };
    let mut met = if free.contains(&RESTITUTION) { floor.met(&along, &given) } else { Vec::new() };
    if wide || met.is_empty() {
        met.extend(along.into_iter().flatten().map(|(x, _)| x));
    }
    met
}

/// A drop that meets the first strikes, and how far each later one is off.
type On = (Vec<f64>, Vec<f64>);

/// The drops that meet the first strikes.
struct Floor<'a> {
    /// With these strikes alone, and with the next one.
    drop: Drop<'a>,
    next: Drop<'a>,
    solved: Vec<usize>,
    late_s: [f64; 2],
}

impl Floor<'_> {
    /// Returns the drops with so many restitutions, and how far later strikes are off; none where the first strikes are not met.
    fn along(&self, given: &[f64], count: usize) -> Vec<Option<On>> {
        let mut all: Vec<Option<On>> = Vec::with_capacity(count);
        for k in 0..count {
            #[expect(clippy::cast_precision_loss, reason = "some dozen")]
            let restitution = (k as f64 + 0.5) / count as f64;
            let before = all.last().and_then(Option::as_ref);
            all.push(self.at(restitution, before.map(|(x, _)| &x[..]), given));
        }
        all
    }

    /// Finds where a later strike is met too, and about where it is nearly met: the noise of the first strikes may hide that it is.
    fn met(&self, all: &[Option<On>], given: &[f64]) -> Vec<Vec<f64>> {
        let later = all.iter().flatten().map(|(_, off)| off.len()).max().unwrap_or(0);
        (0..later).flat_map(|n| self.met_by(n, all, given)).collect()
    }

    /// Finds the same for the n-th later strike.
    fn met_by(&self, n: usize, all: &[Option<On>], given: &[f64]) -> Vec<Vec<f64>> {
        let of = |on: &Option<On>| on.as_ref().map(|(x, off)| (x.clone(), off[n]));
        let all: Vec<Option<(Vec<f64>, f64)>> = all.iter().map(of).collect();
        let met = all.windows(2).filter_map(|two| {
            let [below, above] = [two[0].as_ref()?, two[1].as_ref()?];
            (below.1.signum() != above.1.signum()).then(|| self.between(n, below.clone(), above.clone(), given))
        });
        let nearly = all.windows(3).filter_map(|three| {
            let [before, at, after] = [three[0].as_ref()?, three[1].as_ref()?, three[2].as_ref()?];
            let is_farther = |other: f64| at.1.signum() == other.signum() && at.1.abs() < other.abs();
            (n == 0 && is_farther(before.1) && is_farther(after.1)).then(|| [before, at, after].map(|(x, _)| x.clone()))
        });
        met.chain(nearly.flatten()).collect()
    }

    /// Finds the drop between two drops of which one is too early for the n-th later strike and one too late.
    fn between(&self, n: usize, mut below: (Vec<f64>, f64), mut above: (Vec<f64>, f64), given: &[f64]) -> Vec<f64> {
        for _ in 0..HALVED[n.min(1)] {
            let restitution = 0.5 * (below.0[RESTITUTION] + above.0[RESTITUTION]);
            let near = if below.1.is_finite() { &below.0 } else { &above.0 };
            let Some((x, off)) = self.at(restitution, Some(near), given) else { break };
            if off[n].signum() == below.1.signum() {
                below = (x, off[n]);
            } else {
                above = (x, off[n]);
            }
        }
        if below.1.is_finite() && below.1.abs() <= above.1.abs() { below.0 } else { above.0 }
    }

    /// Finds the drop with a restitution, and how far later strikes are off; near a known one where there is one.
    fn at(&self, restitution: f64, near: Option<&[f64]>, given: &[f64]) -> Option<On> {
        let from_given = || {
            let factors = if self.solved.contains(&GYRATION) { &GYRATIONS[..] } else { &GYRATIONS[..1] };
            factors.iter().find_map(|factor| {
                let mut x = given.to_vec();
                x[GYRATION] += libm::log(*factor);
                x[RESTITUTION] = restitution;
                let Set::Strikes { strikes, index, .. } = &self.drop.sets[0] else { return None };
                self.meet(by_strikes(&self.drop, 0, strikes, index, 2, x))
            })
        };
        let along = near.and_then(|near| {
            let mut x = near.to_vec();
            x[RESTITUTION] = restitution;
            self.meet(x)
        });
        let x = along.or_else(from_given)?;
        // One that never happens is infinitely late; where none was measured, nothing has to be met.
        let off = self.each_off(&self.next, &x)?.into_iter().skip(self.solved.len());
        let off: Vec<f64> = off.map(|off| off.unwrap_or(f64::NEG_INFINITY)).collect();
        Some((x, if off.is_empty() { vec![0.0] } else { off }))
    }

    /// Solves by Newton's method from unknowns near by.
    fn meet(&self, mut x: Vec<f64>) -> Option<Vec<f64>> {
        let count = self.solved.len();
        let bounds = self.drop.bounds();
        let mut least = f64::INFINITY;
        for k in 0..STEPS {
            let off = self.off(&self.drop, &x).filter(|off| off.len() == count)?;
            if off.iter().all(|off| off.abs() <= MET) {
                let Set::Strikes { deviation, .. } = &self.drop.sets[0] else { return None };
                x[OFFSET] += self.drop.residuals(&x)[0] * deviation / self.drop.unit_s;
                return Some(x);
            }
            let most = off.iter().fold(0.0_f64, |most, off| most.max(off.abs()));
            // From afar the first step may lead away.
            if k > 1 && most >= least {
                return None;
            }
            least = most;
            let mut slopes = nalgebra::DMatrix::zeros(count, count);
            for (column, &unknown) in self.solved.iter().enumerate() {
                let mut beside = x.clone();
                beside[unknown] += SMALL;
                let changed = self.off(&self.drop, &beside)?;
                for (row, (changed, off)) in changed.iter().zip(&off).enumerate() {
                    slopes[(row, column)] = (changed - off) / SMALL;
                }
            }
            let step = slopes.lu().solve(&nalgebra::DVector::from_vec(off))?;
            let shorten = (LONGEST / step.amax()).min(1.0);
            for (&unknown, step) in self.solved.iter().zip(&step) {
                x[unknown] -= shorten * step;
                if !(bounds[unknown][0]..=bounds[unknown][1]).contains(&x[unknown]) {
                    return None;
                }
            }
        }
        None
    }

    /// Returns how far strikes after the first are off from it, over the mean time between strikes; none where one does not happen.
    fn off(&self, drop: &Drop<'_>, x: &[f64]) -> Option<Vec<f64>> {
        self.each_off(drop, x)?.into_iter().collect()
    }

    /// Returns the same of each that happens.
    fn each_off(&self, drop: &Drop<'_>, x: &[f64]) -> Option<Vec<Option<f64>>> {
        let path = drop.path(x)?;
        let Set::Strikes { strikes, index, .. } = &drop.sets[0] else { return None };
        let time = |(measured, which): (&super::MeasuredStrike, &Option<Which>)| {
            let place = (*which)?.find(drop, &path.motion.strikes);
            Some(place.map(|place| measured.time_s - path.motion.strikes[place].time_s))
        };
        let all: Vec<Option<f64>> = strikes.iter().zip(index).filter_map(time).collect();
        let (first, later) = all.split_first()?;
        let first = (*first)?;
        let late = self.late_s.iter().take(self.solved.len()).chain(std::iter::repeat(&0.0));
        Some(later.iter().zip(late).map(|(off, late)| off.map(|off| (off - first + late) / drop.unit_s)).collect())
    }
}

impl Drop<'_> {
    /// Returns the same with so many of the first strikes that are used.
    pub(super) fn first(&self, count: usize) -> Self {
        let mut first = self.clone();
        if let Set::Strikes { index, .. } = &mut first.sets[0] {
            let used = index.iter().enumerate().filter(|(_, which)| which.is_some());
            let until = used.map(|(k, _)| k + 1).nth(count.saturating_sub(1)).unwrap_or(index.len());
            index[until..].fill(None);
        }
        first
    }
}
