//! This module finds how far a fit may be off: all unknowns with which the computed drop is nearly as near to the data as the nearest one.

use nalgebra::{DMatrix, DVector};

use super::solve::{Minimum, Problem};

/// A function of the unknowns.
pub(super) type Function<'a> = dyn Fn(&[f64]) -> f64 + 'a;

/// A requested value counts so many times as much as the data: the search then ends within a percent of it.
const STRICT: f64 = 10.0;
/// The root of the rise is nearly a straight line: within this share of where it is to be, the line gives the rest.
const NEAR: f64 = 0.02;
/// Searches for an end at most: two or three are enough unless the sum jumps, where a strike changes places with another.
const SEARCHES: usize = 12;

/// Columns of derivatives, each of length 1, are dependent where their least singular value is below this, which is what roundings leave
/// of a column that is nil.
const SINGULAR: f64 = 1e-12;

/// All unknowns whose sum of squares is larger than the least one by at most `rise`².
pub(super) struct Region<'a> {
    problem: &'a Problem<'a>,
    minimum: &'a Minimum,
    free: &'a [usize],
    rise: f64,
    /// The covariance over all unknowns: g·covariance·g is the square of how far a function with the gradient g goes in the region, as the
    /// derivatives at the minimum have it.
    covariance: DMatrix<f64>,
}

impl<'a> Region<'a> {
    /// Returns the region about a minimum over free unknowns.
    pub(super) fn new(problem: &'a Problem<'a>, minimum: &'a Minimum, free: &'a [usize], rise: f64) -> Option<Self> {
        let count = minimum.x.len();
        let jacobian = problem.jacobian(&minimum.x, free);
        let mut even = jacobian.clone();
        even.column_iter_mut().for_each(|mut column| column /= column.norm().max(f64::MIN_POSITIVE));
        let least = even.singular_values().min();
        // A direction that the data do not tell has no end.
        if least.is_nan() || least < SINGULAR {
            return None;
        }
        let inverse = jacobian.pseudo_inverse(0.0).ok()?;
        let over_all = |own: DVector<f64>| {
            let mut all = DVector::zeros(count);
            free.iter().zip(own.iter()).for_each(|(&unknown, value)| all[unknown] = *value);
            all
        };
        let columns: Vec<DVector<f64>> = inverse.column_iter().map(|column| over_all(column.into_owned())).collect();
        let data = DMatrix::from_columns(&columns) * rise;
        Some(Self { problem, minimum, free, rise, covariance: &data * data.transpose() })
    }

    /// Derivatives of a function at the minimum.
    fn gradient(&self, of: &Function<'_>) -> DVector<f64> {
        let mut x = self.minimum.x.clone();
        let step = 1e-6;
        let one = |i: usize| {
            let at = x[i];
            x[i] = at + step;
            let above = of(&x);
            x[i] = at - step;
            let below = of(&x);
            x[i] = at;
            (above - below) / (2.0 * step)
        };
        DVector::from_iterator(self.minimum.x.len(), (0..self.minimum.x.len()).map(one))
    }

    /// Correlations of functions, by the derivatives at the minimum.
    pub(super) fn correlations(&self, functions: &[&Function<'_>]) -> Vec<Vec<f64>> {
        let gradients: Vec<DVector<f64>> = functions.iter().map(|of| self.gradient(of)).collect();
        let of = |i: usize, j: usize| gradients[i].dot(&(&self.covariance * &gradients[j]));
        let correlation = |i: usize, j: usize| {
            let product = (of(i, i) * of(j, j)).sqrt();
            if i == j {
                1.0
            } else if product > 0.0 {
                (of(i, j) / product).clamp(-1.0, 1.0)
            } else {
                0.0
            }
        };
        (0..gradients.len()).map(|i| (0..gradients.len()).map(|j| correlation(i, j)).collect()).collect()
    }

    /// Finds where a function is least and largest in the region, as the derivatives at the minimum have it.
    pub(super) fn straight_ends(&self, of: &Function<'_>) -> [Vec<f64>; 2] {
        let g = self.gradient(of);
        let toward = &self.covariance * &g;
        let half = g.dot(&toward).sqrt();
        [-1.0, 1.0].map(|side| {
            let share = if half > 0.0 { side / half } else { 0.0 };
            self.minimum.x.iter().zip(toward.iter()).map(|(x, toward)| x + share * toward).collect()
        })
    }

    /// Finds where a function is least and largest in the region: its profile.
    pub(super) fn ends(&self, of: &Function<'_>) -> [Vec<f64>; 2] {
        let [below, above] = self.straight_ends(of);
        [self.end(of, -1.0, below), self.end(of, 1.0, above)]
    }

    /// Returns the end on one side; `straight` is where the derivatives have it.
    fn end(&self, of: &Function<'_>, side: f64, straight: Vec<f64>) -> Vec<f64> {
        let (least, middle) = (self.minimum.sum(), of(&self.minimum.x));
        let mut asked = side * (of(&straight) - middle);
        if !(asked > 0.0 && asked.is_finite() && self.rise > 0.0) {
            return straight;
        }
        let weight = STRICT * self.rise / asked;
        let mut begin = straight;
        let (mut inside, mut outside) = ((self.minimum.x.clone(), 0.0, 0.0), None::<(Vec<f64>, f64, f64)>);
        for _ in 0..SEARCHES {
            // The least sum of squares with the function near a value. Where the search ends, it is the least one with the value
            // that the function has there, whether that is the requested one or not.
            let residuals = move |x: &[f64]| {
                let mut all = (self.problem.residuals)(x);
                all.push(weight * (side * (of(x) - middle) - asked));
                all
            };
            let problem =
                Problem { residuals: Box::new(residuals), bounds: self.problem.bounds.clone(), ..*self.problem };
            let found = problem.minimize(&begin, self.free);
            let reached = side * (of(&found.x) - middle);
            let own = found.residuals.last().map_or(0.0, |last| last * last);
            let root = (found.sum() - own - least).max(0.0).sqrt();
            if (root / self.rise - 1.0).abs() <= NEAR {
                let along = |(x, middle): (&f64, &f64)| middle + (x - middle) * self.rise / root;
                return found.x.iter().zip(&self.minimum.x).map(along).collect();
            }
            if root > self.rise {
                outside = Some((found.x, reached, root));
            } else if reached <= inside.1 || reached < 0.5 * asked {
                // An unknown is on its bound: the function goes no further.
                return if reached > inside.1 { found.x } else { inside.0 };
            } else {
                inside = (found.x, reached, root);
            }
            asked = match &outside {
                Some((x, far, _)) if far - inside.1 <= NEAR * far => return x.clone(),
                Some((_, far, above)) => {
                    let share = (self.rise - inside.2) / (above - inside.2);
                    inside.1 + (far - inside.1) * share.clamp(0.1, 0.9)
                }
                // No more than three times as far at once: further than that nothing is a straight line.
                None => inside.1 * (self.rise / inside.2).min(3.0),
            };
            begin.clone_from(&inside.0);
        }
        outside.map_or(inside.0, |outside| outside.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::PRECISION;

    /// An unknown that changes no datum has no end, and nothing is reported of the others.
    #[test]
    fn a_singular_jacobian_gives_no_region() {
        let problem = Problem {
            residuals: Box::new(|x| vec![x[0], 2.0 * x[0]]),
            bounds: vec![[-10.0, 10.0]; 2],
            step: 1e-6,
            one_sided: false,
            patience: 50,
            precision: PRECISION,
        };
        let minimum = Minimum { x: vec![0.0; 2], residuals: vec![0.0; 2] };
        assert!(Region::new(&problem, &minimum, &[0, 1], 1.0).is_none());
        assert!(Region::new(&problem, &minimum, &[0], 1.0).is_some());
    }

    /// Two unknowns x and y, and the data exp x = 1 and exp x + y = 1, both to 1/2: with y made up for, the sum of squares is
    /// 4 (exp x − 1)², so that x reaches from ln(1/2) to ln(3/2) where it rises by 1. The derivatives have it from −1/2 to 1/2.
    #[test]
    fn ends_are_where_the_sum_of_squares_has_risen() {
        let residuals = |x: &[f64]| vec![2.0 * (libm::exp(x[0]) - 1.0), 2.0 * (libm::exp(x[0]) + x[1] - 1.0)];
        let problem = |least: f64| Problem {
            residuals: Box::new(residuals),
            bounds: vec![[least, 10.0], [-10.0, 10.0]],
            step: 1e-6,
            one_sided: false,
            patience: 50,
            precision: PRECISION,
        };
        let minimum = Minimum { x: vec![0.0, 0.0], residuals: vec![0.0, 0.0] };
        let ends = |problem: &Problem<'_>| {
            let region = Region::new(problem, &minimum, &[0, 1], 1.0).expect("the test has derivatives");
            let straight = region.straight_ends(&|x| x[0]).map(|end| end[0]);
            assert!((straight[0] + 0.5).abs() < 1e-6 && (straight[1] - 0.5).abs() < 1e-6, "{straight:?}");
            region.ends(&|x| x[0]).map(|end| end[0])
        };
        // The ends are as near as `NEAR` lets them be.
        let [least, most] = ends(&problem(-10.0));
        assert!(
            (least / 0.5_f64.ln() - 1.0).abs() < 0.01 && (most / 1.5_f64.ln() - 1.0).abs() < 0.01,
            "{least} {most}"
        );
        // A bound that comes before is the end.
        for bound in [-0.3, -0.1] {
            let [least, _] = ends(&problem(bound));
            assert!((least - bound).abs() < 1e-12, "{least}");
        }
    }
}
