//! What the train of a plate amounts to.

use std::cmp::Ordering;

use super::{Corner, Plate, PlateImpact, PlateShocks, PlateStart};

/// How many impacts a plate has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlateCount {
    /// Exactly so many.
    Finite(u64),
    /// Proven without end: two corners alternate for ever.
    Endless,
    /// More than were followed.
    MoreThan(u64),
}

/// The largest velocity shock of a train.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlatePeak {
    /// Largest shock of a corner in its own strike, (1 + e)|v_j|.
    pub corner: f64,
    /// The impact that holds it, from 1; the first if several tie.
    pub impact: u64,
    /// The corner that strikes then.
    pub struck: Corner,
    /// Largest shock of the center of mass, (1 + e)|v_j|/w_j(j).
    pub center: f64,
    /// What no later strike exceeds, where the train was not followed to its end: (1 + e) √w_j(j) times the root of twice
    /// the kinetic energy that is left, per mass. 0 after the last strike.
    pub later: f64,
}

/// A train of a plate without the list of its impacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateSummary {
    /// Number of impacts.
    pub count: PlateCount,
    /// Time of the last impact followed, or the limit it tends to where the train is endless.
    pub duration: f64,
    /// Largest shocks.
    pub peak: PlatePeak,
    /// Velocities of the corners after the last impact, or the limit they tend to; `None` where the train was not
    /// followed to its end.
    pub final_velocity: Option<[f64; 4]>,
    /// Largest shocks of every corner in its own strikes.
    struck: [f64; 4],
}

/// Strikes after which a train is first asked whether it is endless; then at every power of two.
const FIRST_ASKED: u64 = 8;
/// Velocities and intervals of time that decide it must differ by this share of themselves.
const CLEAR: f64 = 1e-9;

impl Plate {
    /// Count, peaks, final velocities and duration, following at most so many impacts.
    ///
    /// # Method
    /// The train is followed. Where two corners alternate, their velocities obey the recurrence of an off-center bar,
    /// a_{n+1} = T a_n − e a_{n−1} with T = −(1 + e) w_i(j)/√(w_i(i) w_j(j)) in units of √w. If that stays negative for
    /// ever, and no other corner reaches the ground before the time that their strikes tend to even if it fell as fast
    /// as it ever may, the train is endless, and its limits follow.
    ///
    /// # Examples
    /// The diagonal of a uniform plate is a bar with q = 5/7, endless from e = 0.17657 down:
    /// ```
    /// use clatter::{Plate, PlateCount, PlateStart};
    /// let count = |e: f64| Ok::<_, clatter::Error>(Plate::uniform(e)?.summary(&PlateStart::default(), 1000).count);
    /// assert_eq!(count(0.176)?, PlateCount::Endless);
    /// assert_eq!(count(0.3)?, PlateCount::Finite(5));
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn summary(&self, start: &PlateStart, most: u64) -> PlateSummary {
        let mut train = self.train(start);
        let mut struck = [0.0_f64; 4];
        let mut peak = PlatePeak { corner: 0.0, impact: 0, struck: Corner::A, center: 0.0, later: 0.0 };
        let (mut before, mut number, mut duration, mut ask) = ([None; 2], 0, 0.0, FIRST_ASKED);
        while number < most {
            let Some(PlateImpact { corner, approach, time, .. }) = train.next() else {
                if train.undecided() {
                    break;
                }
                let (count, final_velocity) = (PlateCount::Finite(number), Some(train.velocities()));
                return PlateSummary { count, duration, peak, final_velocity, struck };
            };
            (number, duration) = (number + 1, time);
            let (shock, j) = ((-1.0 - self.e) * approach, corner as usize);
            struck[j] = struck[j].max(shock);
            peak.center = peak.center.max(shock / self.weight[j]);
            if shock > peak.corner {
                (peak.corner, peak.impact, peak.struck) = (shock, number, corner);
            }
            if number == ask {
                ask *= 2;
                if let [Some(first), Some(partner)] = before
                    && first == corner
                    && let pair = [partner, corner]
                    && let mirrored = self.is_mirrored(start, pair, &struck)
                    && let Some(limit) = self.endless_pair(pair, mirrored, &train.velocities(), &train.intercepts())
                {
                    let held = struck[partner as usize] >= limit.later[0] && struck[j] >= limit.later[1];
                    if held || ask > most {
                        let duration = if start.is_flat() { 0.0 } else { limit.time };
                        peak.later = limit.later[0].max(limit.later[1]);
                        let (count, final_velocity) = (PlateCount::Endless, Some(limit.velocity));
                        return PlateSummary { count, duration, peak, final_velocity, struck };
                    }
                }
            }
            before = [before[1], Some(corner)];
        }
        peak.later = self.later(&train.velocities());
        PlateSummary { count: PlateCount::MoreThan(number), duration, peak, final_velocity: None, struck }
    }

    /// The largest shocks of one drop everywhere on the plate, of at most so many impacts.
    #[must_use]
    pub fn shocks(&self, start: &PlateStart, most: u64) -> PlateShocks {
        let summary = self.summary(start, most);
        PlateShocks::new(*self, summary.struck, summary.peak.later)
    }

    /// What no strike exceeds after these velocities.
    pub(super) fn later(&self, velocities: &[f64; 4]) -> f64 {
        let weight = self.weight.iter().fold(0.0, |most: f64, w| most.max(*w));
        (1.0 + self.e) * weight.sqrt() * self.norm(*velocities)
    }

    /// Whether a plate that is its own mirror image across the diagonal from a to c has landed on these two corners
    /// alone. The other two then share one height, half the sum of those of a and c, and never touch before them.
    fn is_mirrored(&self, start: &PlateStart, pair: [Corner; 2], struck: &[f64; 4]) -> bool {
        let [a, b, c, d] = Corner::ALL;
        let diagonal = pair == [a, c] || pair == [c, a];
        let alone = struck[b as usize] == 0.0 && struck[d as usize] == 0.0;
        let ([_, vb, vd], [hx, hy]) = (start.velocity, start.ordering_gaps());
        diagonal && alone && vb.to_bits() == vd.to_bits() && hx.to_bits() == hy.to_bits() && {
            let coupling = self.exact_coupling();
            [a, c].iter().all(|j| {
                let [at_b, at_d] = [b, d].map(|i| coupling[*j as usize][i as usize].clone());
                at_b.sub(&at_d).sign() == Ordering::Equal
            })
        }
    }

    /// Whether corners i and j, of which j has just struck and i is next, alternate for ever.
    fn endless_pair(&self, [i, j]: [Corner; 2], mirrored: bool, v: &[f64; 4], p: &[f64; 4]) -> Option<Limit> {
        let ([i, j], e) = ([i as usize, j as usize], self.e);
        // By the square roots of their weights both corners obey one recurrence.
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
        // With e = 0 all is over at the instant at which i strikes.
        let time = -of_p / fast;
        let now = if v[j] > 0.0 { -p[j] / v[j] } else { time };
        // What both give in all, each a multiple of its jumps, so that both come to rest.
        let total = |x: &[f64; 4]| {
            let (m, by_j, by_i) = (1.0 + e, self.jump[j][i], self.jump[i][j]);
            let d = m * m - by_j * by_i;
            [(m * x[i] - by_j * x[j]) / d, (m * x[j] - by_i * x[i]) / d]
        };
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
        let later = root.map(|root| (1.0 + e) * root * most);
        Some(Limit { time, velocity, later })
    }
}

/// What an endless train tends to.
struct Limit {
    time: f64,
    velocity: [f64; 4],
    /// What no later shock of the two exceeds.
    later: [f64; 2],
}
