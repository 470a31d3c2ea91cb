//! Trains of a plate that never end, and their limits.
//!
//! # A word that repeats itself
//! Let M be the product of the matrices of one round of a word of three or four corners, with eigenvalues λ₁ > λ₂ > |λ₃| and
//! eigenvectors E_k. With velocities v = Σ ξ_k E_k and heights h = Σ η_k E_k at one strike, all corners come together after
//! the time t* = −η₁/ξ₁, and s = h + t* v has no part of E₁. Corner j reaches the ground before corner i if
//!
//! ```text
//! s_j v_i − s_i v_j > 0
//! ```
//!
//! After n more rounds the term ξ₁ σ₂ of this form is (λ₁ λ₂)ⁿ times what it is now, and each other term is less than that
//! times its own. So if the first is positive and larger than all others together, for each strike of one round, the
//! word repeats itself for ever. The same holds for v_j < 0 with the term ξ₁.

use std::cmp::Ordering;

use nalgebra::{Matrix3, Vector3};

use super::train::Heights;
use super::{Plate, PlateStart, PlateTrain};

/// The limit of an endless train.
pub(super) struct Limit {
    pub(super) time: f64,
    pub(super) velocity: [f64; 4],
    /// Bound on the later shocks of each corner; 0 for one that strikes no more.
    pub(super) later: [f64; 4],
    /// Bound on the shocks after the limit: 0 unless a corner still comes down then.
    pub(super) after: f64,
}

/// The least relative difference of velocities and intervals of time that decides.
const CLEAR: f64 = 1e-9;
/// The longest word whose repetition is tested.
const LONGEST: usize = 32;

impl Plate {
    /// Returns the limit of a train, if it is proven endless after this word.
    pub(super) fn limit(&self, start: &PlateStart, word: &[usize], train: &PlateTrain<'_>) -> Option<Limit> {
        let n = word.len();
        let repeats = |period: usize| word[n - 3 * period..].windows(period + 1).all(|w| w[0] == w[period]);
        let period = (2..=LONGEST.min(n / 3)).find(|period| repeats(*period))?;
        if period == 2 {
            let mirrored = self.is_mirrored(start, word);
            return self.endless_pair([word[n - 2], word[n - 1]], mirrored, &train.velocities(), &train.intercepts());
        }
        self.endless_word(&word[n - period..], &train.velocities(), &train.heights())
    }

    /// Returns whether the plate is its own mirror image across the diagonal from a to c and has struck on these two
    /// corners alone. The other two then share one height, half the sum of those of a and c, and never touch before
    /// them.
    fn is_mirrored(&self, start: &PlateStart, word: &[usize]) -> bool {
        let diagonal = word.iter().all(|j| *j == 0 || *j == 2);
        let ([_, vb, vd], [hx, hy]) = (start.velocity, start.ordering_gaps());
        diagonal && vb.to_bits() == vd.to_bits() && hx.to_bits() == hy.to_bits() && {
            let coupling = self.exact_coupling();
            [0, 2].iter().all(|j| coupling[*j][1].sub(&coupling[*j][3]).sign() == Ordering::Equal)
        }
    }

    /// Returns the limit if corners i and j alternate for ever, where j has just struck and i is next.
    ///
    /// In units of √w both obey the recurrence of an off-center bar, a_{n+1} = T a_n − e a_{n−1} with T = −(1 + e)
    /// w_i(j)/√(w_i(i) w_j(j)). It must stay negative for ever, and no other corner may reach the ground before the time
    /// that the strikes tend to, even if it fell as fast as it ever may.
    fn endless_pair(&self, [i, j]: [usize; 2], mirrored: bool, v: &[f64; 4], p: &[f64; 4]) -> Option<Limit> {
        let e = self.e;
        // In units of the square roots of their weights both corners obey one recurrence.
        let root = [self.weight[i].sqrt(), self.weight[j].sqrt()];
        let t = -self.jump[i][j] * root[0] / root[1];
        let square = t * t - 4.0 * e;
        if t <= 0.0 || square < CLEAR * t * t || v[i] >= 0.0 {
            return None;
        }
        let slow = 2.0 * e / (t + square.sqrt());
        let terms = |x: &[f64; 4]| [x[i] / root[0], (x[j] - self.jump[i][j] * x[i]) / root[1]];
        let ([v0, v1], [p0, p1]) = (terms(v), terms(p));
        // The part of the larger root, which stays: the smaller one's dies out.
        let (fast, of_p) = (v1 - slow * v0, p1 - slow * p0);
        if fast > CLEAR * v0 {
            return None;
        }
        // With e = 0 all is over at the instant of the strike of i.
        let time = -of_p / fast;
        let now = if v[j] > 0.0 { -p[j] / v[j] } else { time };
        // The sums of all strikes of both, each a multiple of its jumps, bring both to rest.
        let (m, by_j, by_i) = (1.0 + e, self.jump[j][i], self.jump[i][j]);
        let d = m * m - by_j * by_i;
        if d < CLEAR * m * m && !mirrored {
            return None; // of so little mass away from the middle that floats do not tell what the others get
        }
        let total = |x: &[f64; 4]| [(m * x[i] - by_j * x[j]) / d, (m * x[j] - by_i * x[i]) / d];
        let of_v = total(v);
        let mut velocity = [0.0; 4];
        for k in (0..4).filter(|k| !mirrored && *k != i && *k != j) {
            let changes = [-self.jump[i][k] * of_v[0], -self.jump[j][k] * of_v[1]];
            velocity[k] = v[k] + changes[0] + changes[1];
            let least = v[k] + changes[0].min(0.0) + changes[1].min(0.0);
            let height = p[k] + v[k] * now;
            if height + least.min(0.0) * (time - now) <= CLEAR * (p[k].abs() + (v[k] * now).abs()) {
                return None;
            }
        }
        // |a_n| is a sum of two decays: at most the first term, or the larger decay alone where the other is against it.
        let most = (-v0).max(-fast / square.sqrt());
        let mut later = [0.0; 4];
        (later[i], later[j]) = ((1.0 + e) * root[0] * most, (1.0 + e) * root[1] * most);
        let after = if velocity.iter().any(|v| *v < 0.0) { self.later(&velocity) } else { 0.0 };
        Some(Limit { time, velocity, later, after })
    }

    /// Returns the corner values after a strike at corner j.
    fn struck_once(&self, x: [f64; 4], j: usize) -> [f64; 4] {
        let mut after = std::array::from_fn(|i| x[i] - self.jump[j][i] * x[j]);
        after[j] = -self.e * x[j];
        after
    }

    /// Returns the limit if this word of three or four corners, which has just ended, repeats itself for ever (see the
    /// module).
    fn endless_word(&self, word: &[usize], v: &[f64; 4], now: &Heights) -> Option<Limit> {
        let corners = |[a, b, d]: [f64; 3]| [a, b, b + d - a, d];
        let plane = |x: &[f64; 4]| Vector3::new(x[0], x[1], x[3]);
        let round = |x: [f64; 3]| plane(&word.iter().fold(corners(x), |x, j| self.struck_once(x, *j)));
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(round);
        let matrix = Matrix3::from_columns(&columns);
        let mut values = matrix.eigenvalues()?;
        values.as_mut_slice().sort_by(|x, y| y.abs().total_cmp(&x.abs()));
        let shrinks = |more: f64, less: f64| more > 0.0 && less.abs() < more * (1.0 - CLEAR);
        if !(shrinks(1.0, values[0]) && shrinks(values[0], values[1]) && shrinks(values[1], values[2])) {
            return None;
        }
        let vectors = [0, 1, 2].map(|k| null_vector(&(matrix - Matrix3::identity() * values[k])));
        let inverse = Matrix3::from_columns(&vectors).try_inverse()?;
        let (xi, eta) = (inverse * plane(v), inverse * plane(&now.corners));
        let wait = -eta[0] / xi[0];
        let sigma = [0.0, eta[1] + wait * xi[1], eta[2] + wait * xi[2]];
        // Heights must exceed their roundings.
        if !(wait > 0.0 && sigma[1].abs() > 1e4 * now.off) {
            return None;
        }
        let mut own = vectors.map(|vector| corners([vector[0], vector[1], vector[2]]));
        for (at, &j) in word.iter().enumerate() {
            let last = word[(at + word.len() - 1) % word.len()];
            let falls = clearly_positive(-xi[0] * own[0][j], &[xi[1] * own[1][j], xi[2] * own[2][j]]);
            let first = (0..4).filter(|i| *i != j && *i != last).all(|i| {
                let term = |a: usize, b: usize| sigma[a] * xi[b] * (own[a][j] * own[b][i] - own[a][i] * own[b][j]);
                clearly_positive(term(1, 0), &[term(1, 2), term(2, 0), term(2, 1)])
            });
            if !(falls && first) {
                return None;
            }
            own = own.map(|x| self.struck_once(x, j));
        }
        let later = self.later(v);
        let later = std::array::from_fn(|j| if word.contains(&j) { later } else { 0.0 });
        Some(Limit { time: now.time + wait, velocity: [0.0; 4], later, after: 0.0 })
    }
}

/// Returns whether a term is positive and larger than all others together, with a margin for roundings.
fn clearly_positive(term: f64, others: &[f64]) -> bool {
    term > others.iter().map(|x| x.abs()).sum::<f64>() * (1.0 + 1e-6)
}

/// Returns a vector of length 1 that a singular matrix takes to 0: it is perpendicular to its rows.
fn null_vector(matrix: &Matrix3<f64>) -> Vector3<f64> {
    let row = |i: usize| matrix.row(i % 3).transpose();
    let across = [0, 1, 2].map(|i| row(i).cross(&row(i + 1)));
    let longest = across.into_iter().max_by(|x, y| x.norm().total_cmp(&y.norm())).unwrap_or_default();
    longest.normalize()
}
