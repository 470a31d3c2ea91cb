//! Least squares over some of the unknowns, the others held: Levenberg–Marquardt of the crate `levenberg-marquardt` (MINPACK).

use std::cell::OnceCell;

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::{DMatrix, DVector, Dyn, Owned};

/// Measured less computed over a standard deviation, as a function of all unknowns.
type Residuals<'a> = Box<dyn Fn(&[f64]) -> Vec<f64> + 'a>;

/// Residuals as a function of all unknowns, and where these may lie.
pub(super) struct Problem<'a> {
    /// The residuals, as many for any unknowns within the bounds.
    pub(super) residuals: Residuals<'a>,
    pub(super) bounds: Vec<[f64; 2]>,
    /// Half the step of a central difference.
    pub(super) step: f64,
    /// True where a search takes differences to one side, which cost half as much.
    pub(super) one_sided: bool,
    /// Residuals are computed so many times, at most, for each free unknown and one more.
    pub(super) patience: usize,
    /// A step is the last one where it changes sum or unknowns by no more than this share.
    pub(super) precision: f64,
}

/// The point at which a minimization ends.
#[derive(Debug, Clone)]
pub(super) struct Minimum {
    pub(super) x: Vec<f64>,
    pub(super) residuals: Vec<f64>,
}

impl Minimum {
    /// Returns the sum of the squares of the residuals.
    pub(super) fn sum(&self) -> f64 {
        self.residuals.iter().map(|r| r * r).sum()
    }
}

/// Searches one after the other, each as long as it takes this share off the sum.
const RESTARTS: usize = 5;
const GAIN: f64 = 0.01;
/// A precision far below what data tell, and far above roundings.
pub(super) const PRECISION: f64 = 1e-9;

impl Problem<'_> {
    /// Finds the minimum next to `x` over the free unknowns. Where one comes to lie on its bound the others go on, and then all again: it
    /// may be let go there.
    pub(super) fn minimize(&self, x: &[f64], free: &[usize]) -> Minimum {
        let mut x: Vec<f64> = x.iter().zip(&self.bounds).map(|(x, [lo, hi])| x.clamp(*lo, *hi)).collect();
        let mut before = f64::INFINITY;
        for _ in 0..RESTARTS {
            let mut still = free.to_vec();
            let mut sum = 0.0;
            while !still.is_empty() {
                let count = still.len();
                (x, sum) = self.descend(x, &still);
                still.retain(|&i| self.bounds[i][0] < x[i] && x[i] < self.bounds[i][1]);
                if still.len() == count {
                    break;
                }
            }
            if still.len() == free.len() || sum >= (1.0 - GAIN) * before {
                break;
            }
            before = sum;
        }
        Minimum { residuals: (self.residuals)(&x), x }
    }

    /// Goes as far down as searches one after the other lead: in a narrow valley one ends early, and a new one goes on with steps of
    /// another size.
    pub(super) fn descend(&self, x: Vec<f64>, free: &[usize]) -> (Vec<f64>, f64) {
        let mut at = At { problem: self, x, free: free.to_vec(), residuals: OnceCell::new() };
        let mut before = f64::INFINITY;
        for _ in 0..RESTARTS {
            let search = LevenbergMarquardt::new().with_tol(self.precision).with_patience(self.patience);
            let (next, report) = search.minimize(at);
            at = next;
            let is_last = report.objective_function >= (1.0 - GAIN) * before;
            before = report.objective_function;
            if is_last || report.termination == TerminationReason::LostPatience {
                break;
            }
        }
        (at.x, before)
    }

    /// Derivatives of the residuals by these unknowns, one column each: central differences, one-sided at a bound.
    pub(super) fn jacobian(&self, x: &[f64], columns: &[usize]) -> DMatrix<f64> {
        let of = |i: usize, to: f64| {
            let mut x = x.to_vec();
            x[i] = to;
            (self.residuals)(&x)
        };
        let columns: Vec<DVector<f64>> = columns
            .iter()
            .map(|&i| {
                let [lo, hi] =
                    [x[i] - self.step, x[i] + self.step].map(|to| to.clamp(self.bounds[i][0], self.bounds[i][1]));
                let (below, above) = (of(i, lo), of(i, hi));
                let length = if hi > lo { hi - lo } else { f64::INFINITY };
                DVector::from_iterator(
                    below.len(),
                    below.iter().zip(&above).map(|(below, above)| (above - below) / length),
                )
            })
            .collect();
        DMatrix::from_columns(&columns)
    }
}

/// A problem at some unknowns.
struct At<'p, 'a> {
    problem: &'p Problem<'a>,
    x: Vec<f64>,
    free: Vec<usize>,
    /// The residuals at these unknowns, once they are computed.
    residuals: OnceCell<Vec<f64>>,
}

impl At<'_, '_> {
    fn of(&self) -> &[f64] {
        self.residuals.get_or_init(|| (self.problem.residuals)(&self.x))
    }

    /// Derivatives of the residuals by an unknown: upward, or downward at the upper bound.
    fn slope(&self, i: usize) -> DVector<f64> {
        let upward = self.x[i] + self.problem.step;
        let to = if upward <= self.problem.bounds[i][1] { upward } else { self.x[i] - self.problem.step };
        let mut x = self.x.clone();
        x[i] = to;
        let (there, step) = ((self.problem.residuals)(&x), to - self.x[i]);
        DVector::from_iterator(there.len(), there.iter().zip(self.of()).map(|(there, here)| (there - here) / step))
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for At<'_, '_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, free: &DVector<f64>) {
        for (&i, x) in self.free.iter().zip(free) {
            let [lo, hi] = self.problem.bounds[i];
            self.x[i] = if x.is_nan() { lo } else { x.clamp(lo, hi) };
        }
        self.residuals = OnceCell::new();
    }
    fn params(&self) -> DVector<f64> {
        DVector::from_iterator(self.free.len(), self.free.iter().map(|&i| self.x[i]))
    }
    fn residuals(&self) -> Option<DVector<f64>> {
        Some(DVector::from_column_slice(self.of()))
    }
    fn jacobian(&self) -> Option<DMatrix<f64>> {
        if !self.problem.one_sided {
            return Some(self.problem.jacobian(&self.x, &self.free));
        }
        let columns: Vec<DVector<f64>> = self.free.iter().map(|&i| self.slope(i)).collect();
        Some(DMatrix::from_columns(&columns))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight line, with a minimum that everybody can work out: slope 2, intercept 1, residuals ±1/10.
    #[test]
    fn a_straight_line_has_the_minimum_of_its_normal_equations() {
        let residuals =
            |x: &[f64]| [0.9, 3.2, 4.9].iter().zip([0.0, 1.0, 2.0]).map(|(y, t)| y - x[0] - x[1] * t).collect();
        let bounds = [[-10.0, 10.0], [-10.0, 10.0]];
        let problem = Problem {
            residuals: Box::new(residuals),
            bounds: bounds.to_vec(),
            step: 1e-4,
            one_sided: true,
            patience: 50,
            precision: PRECISION,
        };
        let found = problem.minimize(&[5.0, -5.0], &[0, 1]);
        assert!((found.x[0] - 1.0).abs() < 1e-9 && (found.x[1] - 2.0).abs() < 1e-9, "{:?}", found.x);
        // With the slope at most 1, the intercept is the mean of what is left: 3 − 1.
        let bounds = [[-10.0, 10.0], [-10.0, 1.0]];
        let problem = Problem {
            residuals: Box::new(residuals),
            bounds: bounds.to_vec(),
            step: 1e-4,
            one_sided: true,
            patience: 50,
            precision: PRECISION,
        };
        let found = problem.minimize(&[5.0, -5.0], &[0, 1]);
        assert!((found.x[0] - 2.0).abs() < 1e-9 && (found.x[1] - 1.0).abs() < 1e-15, "{:?}", found.x);
    }
}
