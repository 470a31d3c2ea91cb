//! How far functions of the unknowns may be off.

use nalgebra::{DMatrix, DVector};

use super::drop::{Drop, OFFSET};
use super::solve::{Minimum, Problem};
use super::student;
use super::told::{ALPHA, Told};

/// The unknowns that explain the data about as well as those of the minimum: the sum of squares is larger by `rise`² at most.
pub(super) struct Region<'a> {
    problem: &'a Problem<'a>,
    minimum: &'a Minimum,
    free: &'a [usize],
    /// Covariance of the free unknowns times the square of the quantile, by the derivatives at the minimum.
    covariance: DMatrix<f64>,
    inverse: DMatrix<f64>,
    rise: f64,
}

const STRENGTH: f64 = 10.0;
const POINTS: usize = 20;
const SHARE: f64 = 0.01;

impl<'a> Region<'a> {
    pub(super) fn new(problem: &'a Problem<'a>, minimum: &'a Minimum, free: &'a [usize], rise: f64) -> Option<Self> {
        let inverse = problem.jacobian(&minimum.x, free).pseudo_inverse(0.0).ok()?;
        let covariance = &inverse * inverse.transpose() * (rise * rise);
        Some(Self { problem, minimum, free, covariance, inverse, rise })
    }

    /// What the free unknowns change by for a change of one that is held.
    pub(super) fn shift(&self, unknown: usize) -> DVector<f64> {
        let column = self.problem.jacobian(&self.minimum.x, &[unknown]);
        (-(&self.inverse * column)).column(0).into_owned()
    }

    /// Gradient over the free unknowns.
    pub(super) fn gradient(&self, of: &dyn Fn(&[f64]) -> f64) -> DVector<f64> {
        let mut x = self.minimum.x.clone();
        let step = self.problem.step;
        let one = |&i: &usize| {
            let at = x[i];
            x[i] = at + step;
            let above = of(&x);
            x[i] = at - step;
            let below = of(&x);
            x[i] = at;
            (above - below) / (2.0 * step)
        };
        DVector::from_iterator(self.free.len(), self.free.iter().map(one))
    }

    /// Half-width by the derivatives.
    pub(super) fn half(&self, of: &dyn Fn(&[f64]) -> f64) -> f64 {
        let g = self.gradient(of);
        (g.transpose() * &self.covariance * &g)[0].sqrt()
    }

    /// How far below and above the minimum a function goes in the region.
    pub(super) fn reach(&self, of: &dyn Fn(&[f64]) -> f64) -> [f64; 2] {
        let half = self.half(of);
        [-1.0, 1.0].map(|side| self.end(of, half, side))
    }

    fn end(&self, of: &dyn Fn(&[f64]) -> f64, half: f64, side: f64) -> f64 {
        let (least, middle) = (self.minimum.sum(), of(&self.minimum.x));
        if !(half > 0.0 && half.is_finite() && self.rise > 0.0) {
            return half;
        }
        let weight = STRENGTH * self.rise / half;
        let (mut inside, mut outside) = ([0.0, 0.0], None::<[f64; 2]>);
        let mut x = self.minimum.x.clone();
        let mut ask = half;
        for _ in 0..POINTS {
            let residuals = |x: &[f64]| {
                let mut all = (self.problem.residuals)(x);
                all.push(weight * (side * (of(x) - middle) - ask));
                all
            };
            let problem = Problem { residuals: &residuals, ..*self.problem };
            let found = problem.minimize(&x, self.free);
            let reached = side * (of(&found.x) - middle);
            let last = found.residuals.last().copied().unwrap_or(0.0);
            let root = (found.sum() - last * last - least).max(0.0).sqrt();
            if std::env::var("TRACE").is_ok() { println!("   side {side} half {half:.4e} ask {ask:.4e} reached {reached:.4e} root {root:.4e} of {:.4e}", self.rise); }
            if (root - self.rise).abs() <= SHARE * self.rise {
                return reached;
            }
            if root < self.rise {
                // On a bound: it goes no further.
                if reached <= inside[0] || reached < 0.5 * ask {
                    return reached.max(inside[0]);
                }
                inside = [reached, root];
                x = found.x;
            } else {
                outside = Some([reached, root]);
            }
            ask = match outside {
                Some([far, above]) => {
                    if far - inside[0] <= SHARE * far {
                        return far;
                    }
                    let line = inside[0] + (far - inside[0]) * (self.rise - inside[1]) / (above - inside[1]);
                    line.clamp(inside[0] + 0.1 * (far - inside[0]), far - 0.1 * (far - inside[0]))
                }
                None => inside[0] * (self.rise / inside[1]).min(3.0),
            };
        }
        outside.map_or(inside[0], |far| far[0])
    }
}

/// How far functions of the unknowns may be off.
pub(super) struct Spreads {
    /// Covariance of the free unknowns, from the data.
    covariance: DMatrix<f64>,
    /// Half-ranges of what is held, and what the free unknowns change by for each.
    held: Vec<(usize, f64, DVector<f64>)>,
    free: Vec<usize>,
}

impl Told {
    /// Covariances; none where nothing tells the scatter. And how far each function may go.
    pub(super) fn spreads(&self, drop: &Drop<'_>, known: bool, functions: &[&dyn Fn(&[f64]) -> f64]) -> Option<(Spreads, Vec<[f64; 2]>)> {
        let scatter = self.scatter?;
        let (bounds, residuals) = (drop.bounds(), |x: &[f64]| drop.residuals(x));
        let problem = Problem { residuals: &residuals, bounds: &bounds, step: drop.step(), patience: 60 };
        let normal = known && self.excess.is_none();
        let t = student::two_sided(ALPHA, (!normal).then_some(self.degrees.max(1)));
        let region = Region::new(&problem, &self.minimum, &self.free, t * scatter)?;
        let ranges = (0..OFFSET).filter(|unknown| !self.free.contains(unknown));
        let ranges = ranges.map(|unknown| (unknown, drop.half_range(unknown))).filter(|(_, range)| *range > 0.0);
        let held = ranges.map(|(unknown, range)| (unknown, range, region.shift(unknown))).collect();
        let reaches = functions.iter().map(|of| if drop.contacts || std::env::var("LINEAR").is_ok() { [region.half(of); 2] } else { region.reach(of) }).collect();
        Some((Spreads { covariance: region.covariance, held, free: self.free.clone() }, reaches))
    }
}

impl Spreads {
    /// Covariance of two functions with these gradients over all unknowns, times the square of the quantile: the half-width of an
    /// interval is the root of a function's own.
    pub(super) fn of(&self, one: &[f64], other: &[f64]) -> f64 {
        let free = |gradient: &[f64]| DVector::from_iterator(self.free.len(), self.free.iter().map(|&i| gradient[i]));
        let (g, h) = (free(one), free(other));
        (g.transpose() * &self.covariance * &h)[0] + self.of_held(one, other)
    }
    pub(super) fn of_held(&self, one: &[f64], other: &[f64]) -> f64 {
        let free = |gradient: &[f64]| DVector::from_iterator(self.free.len(), self.free.iter().map(|&i| gradient[i]));
        let (g, h) = (free(one), free(other));
        let held = self
            .held
            .iter()
            .map(|(i, range, shift)| range * range * (one[*i] + g.dot(shift)) * (other[*i] + h.dot(shift)));
        held.sum::<f64>()
    }
}
