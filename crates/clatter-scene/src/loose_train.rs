//! The train of impacts over a range of restitution: what each strike can be, at least and at most.
//!
//! For an off-center bar κ^(n odd) times the approach speeds α_n obey the recurrence of a symmetric bar with q = ±√(q_a
//! q_b), and the height gap is κ h0, κ = √((L_a² + ρ²)/(L_b² + ρ²)). In units of v0 and h0, from pure translation,
//!
//! ```text
//! α_0 = 1,  α_1 = T + κ,  α_{n+1} = T α_n − e α_{n−1},  T = q(1 + e)
//! time from strike n+1 to n+2 = κ eⁿ / (α_n α_{n+1})          (the Casoratian of the recurrence)
//! ```
//!
//! # Bounds over e₀ ± d
//! α_n(e) is a polynomial. Its first derivative is carried along at e₀; the second is bounded over the whole range.
//! With P = 1/(1 − T x + e x²), the generating function of the fundamental solution p_n, α_n = p_n + κ p_{n−1} and
//!
//! ```text
//! P″ = 2 (q x − x²)² P³        (derivative along e, T′ = q)
//! ```
//!
//! and every |p_n| in the range is at most the p_n of T̂ = max(|T|, 2√e) at its upper and e at its lower end, whose
//! roots are real: complex roots of modulus √e give at most (n+1) e^(n/2), which is p_n at T = 2√e; for real roots p_n
//! is a sum of positive terms, rising in T and falling in e. So the coefficients of P³ are at most those of the same
//! cube.

use clatter::End;
use clatter::flight::Body;

/// One strike: speeds in v0, times in h0/v0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LooseStrike {
    /// The end that strikes.
    pub(crate) end: End,
    /// Jump (1 + e) of its approach speed.
    pub(crate) jump: Loose,
    /// Time since the strike before.
    pub(crate) gap: Loose,
}

/// A quantity over a range of e.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Loose {
    /// At the middle e.
    pub(crate) middle: f64,
    /// Half the width of the range times the derivative there.
    pub(crate) slope: f64,
    /// How far it may be from the straight line.
    pub(crate) rest: f64,
    /// Bounds, whatever the straight line.
    pub(crate) least: f64,
    pub(crate) most: f64,
}

/// The strikes that all restitutions of a range have.
#[derive(Debug, Clone)]
pub(crate) struct LooseTrain {
    pub(crate) strikes: Vec<LooseStrike>,
    /// Bound on the sum of the jumps of all strikes that are not listed; infinite where there is none.
    pub(crate) omitted: f64,
}

/// A product as its clatter sees it, with one end first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clattering {
    /// The symmetric bar's q.
    q: f64,
    kappa: f64,
    /// Inertia ratios for strikes at end a and end b.
    ratios: [f64; 2],
    length_m: f64,
}

/// Strikes that are followed, at most.
const MOST: usize = 2048;
/// Sum of jumps that may be left out, in v0.
const NEGLIGIBLE: f64 = 1e-4;

impl Clattering {
    /// The product with end a first, or turned around so that what was end b is end a.
    pub(crate) fn new(body: &Body, first: End) -> Self {
        let ([arm_a, arm_b], [qa, qb]) = (body.arms_m(), body.inertia_ratios());
        let rho2 = body.gyration_m() * body.gyration_m();
        let kappa = ((arm_a * arm_a + rho2) / (arm_b * arm_b + rho2)).sqrt();
        let (kappa, ratios) = if first == End::A { (kappa, [qa, qb]) } else { (kappa.recip(), [qb, qa]) };
        Self { q: (qa * qb).sqrt().copysign(qa), kappa, ratios, length_m: body.length_m() }
    }
    /// What a jump of 1 at the striking end gives to a position s, −1 the end that strikes first: shares for strikes at
    /// end a and b.
    pub(crate) fn shares(&self, s: f64) -> [f64; 2] {
        let (near_a, near_b) = (0.5 * (1.0 - s), 0.5 * (1.0 + s));
        [near_a - self.ratios[0] * near_b, near_b - self.ratios[1] * near_a]
    }
    /// The same for the angular velocity, end b upward.
    pub(crate) fn turns(&self) -> [f64; 2] {
        [-(1.0 + self.ratios[0]) / self.length_m, (1.0 + self.ratios[1]) / self.length_m]
    }

    /// The strikes of all e in [lo, hi].
    pub(crate) fn train(&self, lo: f64, hi: f64) -> LooseTrain {
        let (q, kappa) = (self.q, self.kappa);
        let (e, d) = (0.5 * (lo + hi), 0.5 * (hi - lo));
        let t = q * (1.0 + e);
        let mut majorant = Majorant::new(q, lo, hi);
        let mut strikes: Vec<LooseStrike> = Vec::new();
        // α and its derivative at strikes n − 1 and n.
        let (mut before, mut now) = ([0.0, 0.0], [1.0, 0.0]);
        let mut previous: Option<Approach> = None;
        let (mut powers, mut doubt) = ([1.0; 3], 0.0);
        for n in 0..MOST {
            let bend = majorant.bend(q, kappa);
            let approach = Approach::new(now, bend, d);
            if approach.hi <= 0.0 {
                return LooseTrain { strikes, omitted: 0.0 };
            }
            let omitted =
                approach.tail(previous.as_ref()).min(majorant.tail(kappa)) * (1.0 + hi) * kappa.max(kappa.recip());
            // What does not happen everywhere is left to the bound: it is small, or the range too wide to say anything.
            if n > 0 && (approach.lo <= 0.0 || omitted <= NEGLIGIBLE.max(0.05 * doubt)) {
                return LooseTrain { strikes, omitted };
            }
            let end = if n % 2 == 0 { End::A } else { End::B };
            let scale = if n % 2 == 0 { 1.0 } else { kappa.recip() };
            // (1 + e) α_n, with its slope and the bound of its bend.
            let slope = (now[0] + (1.0 + e) * now[1]) * d;
            let curve = 2.0 * (now[1].abs() + bend * d) + (1.0 + hi) * bend;
            let (middle, rest) = ((1.0 + e) * now[0], 0.5 * curve * d * d);
            let reach = slope.abs() + rest;
            let jump = Loose {
                middle: scale * middle,
                slope: scale * slope,
                rest: scale * rest,
                least: scale * (middle - reach).max(0.0),
                most: scale * (middle + reach),
            };
            doubt += rest;
            let gap =
                previous.as_ref().map_or(Loose::default(), |p| p.gap(&approach, kappa, powers, n - 1, [lo, e, hi]));
            strikes.push(LooseStrike { end, jump, gap });
            let next = if n == 0 {
                [t + kappa, q]
            } else {
                [t * now[0] - e * before[0], q * now[0] + t * now[1] - before[0] - e * before[1]]
            };
            (before, now, previous) = (now, next, Some(approach));
            if n > 0 {
                powers = [powers[0] * lo, powers[1] * e, powers[2] * hi];
            }
            majorant.step();
        }
        LooseTrain { strikes, omitted: f64::INFINITY }
    }
}

/// An approach speed over the range.
#[derive(Debug, Clone, Copy)]
struct Approach {
    middle: f64,
    lo: f64,
    hi: f64,
    middle_slope: f64,
    /// Of its derivative.
    slope: [f64; 2],
    /// Bound on its second derivative.
    bend: f64,
    /// Half the width of the range.
    d: f64,
}

impl Approach {
    fn new([middle, slope]: [f64; 2], bend: f64, d: f64) -> Self {
        let radius = slope.abs() * d + 0.5 * bend * d * d;
        let (lo, hi) = (middle - radius, middle + radius);
        Self { middle, lo, hi, middle_slope: slope, slope: [slope - bend * d, slope + bend * d], bend, d }
    }
    /// Sum of this and all later approach speeds: the ratio of neighbors only falls along a train.
    fn tail(&self, before: Option<&Self>) -> f64 {
        let ratio = before.filter(|b| b.lo > 0.0).map_or(f64::INFINITY, |b| self.hi / b.lo);
        if ratio < 1.0 { self.hi / (1.0 - ratio) } else { f64::INFINITY }
    }
    /// Time from this strike to `next`, κ eⁿ/(α_n α_{n+1}), from the values and from the logarithm, whose derivative is
    /// n/e − α_n′/α_n − α_{n+1}′/α_{n+1}.
    fn gap(&self, next: &Self, kappa: f64, powers: [f64; 3], n: usize, e: [f64; 3]) -> Loose {
        let time =
            |power: f64, a: f64, b: f64| if a > 0.0 && b > 0.0 { kappa * power / (a * b) } else { f64::INFINITY };
        let middle = time(powers[1], self.middle, next.middle);
        let least = time(powers[0], self.hi, next.hi).min(middle);
        let most = time(powers[2], self.lo, next.lo).max(middle);
        let unknown = Loose { middle, slope: 0.0, rest: (most - middle).max(middle - least), least, most };
        if !most.is_finite() || (n > 0 && e[0] <= 0.0) {
            return unknown;
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of strikes")]
        let n = n as f64;
        let by_power = |at: f64, power: i32| if n > 0.0 { n / at.powi(power) } else { 0.0 };
        let slope = self.d * (by_power(e[1], 1) - self.relative_slope() - next.relative_slope());
        let bend = 0.5 * self.d * self.d * (by_power(e[0], 2) + self.relative_bend() + next.relative_bend());
        // e^x is 1 + x and at most ½ x² e^|x| more.
        let reach = slope.abs() + bend;
        let rest = middle * (bend + 0.5 * reach * reach * reach.exp());
        let factor = reach.exp();
        let (least, most) = (least.max(middle / factor), most.min(middle * factor));
        if rest < (most - middle).max(middle - least) {
            Loose { middle, slope: middle * slope, rest, least, most }
        } else {
            Loose { rest: (most - middle).max(middle - least), least, most, ..unknown }
        }
    }
    /// α′/α at the middle.
    fn relative_slope(&self) -> f64 {
        self.middle_slope / self.middle
    }
    /// Bound on the derivative of α′/α, |α″|/α + (α′/α)².
    fn relative_bend(&self) -> f64 {
        let steepest = self.slope[0].abs().max(self.slope[1].abs()) / self.lo;
        self.bend / self.lo + steepest * steepest
    }
}

/// p_n of T̂ and e_lo, and the coefficients of the square and the cube of its generating function, at the last few n.
#[derive(Debug)]
struct Majorant {
    t: f64,
    e: f64,
    /// p_n, p_{n−1}
    p: [f64; 2],
    square: [f64; 2],
    /// From n down to n − 5.
    cube: [f64; 6],
}

impl Majorant {
    fn new(q: f64, lo: f64, hi: f64) -> Self {
        let t = (q.abs() * (1.0 + hi)).max(2.0 * hi.sqrt());
        Self { t, e: lo, p: [1.0, 0.0], square: [1.0, 0.0], cube: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0] }
    }
    fn step(&mut self) {
        let next = |of: [f64; 2], input: f64| [self.t * of[0] - self.e * of[1] + input, of[0]];
        self.p = next(self.p, 0.0);
        self.square = next(self.square, self.p[0]);
        let cube = next([self.cube[0], self.cube[1]], self.square[0])[0];
        self.cube.rotate_right(1);
        self.cube[0] = cube;
    }
    /// Bound on |α_n″|.
    fn bend(&self, q: f64, kappa: f64) -> f64 {
        let c = &self.cube;
        let at = |i: usize| 2.0 * (q * q * c[i] + 2.0 * q.abs() * c[i + 1] + c[i + 2]);
        at(2) + kappa * at(3)
    }
    /// Bound on the sum of this and all later approach speeds: Σ_{k≥n} p_k = (p_n − e p_{n−1})/(1 − T + e).
    fn tail(&self, kappa: f64) -> f64 {
        let below_one = 1.0 - self.t + self.e;
        if below_one <= 0.0 || self.t >= 2.0 {
            return f64::INFINITY;
        }
        let [p, before] = self.p;
        // α_k ≤ p_k + κ p_{k−1}: the second sum begins one term earlier.
        let sum = (p - self.e * before) / below_one;
        sum + kappa * (sum + before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter::flight::{Model, Scene};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        /// The strikes of any restitution of the range are within their bounds, whatever the bar.
        #[test]
        fn every_train_of_the_range_is_enclosed(
            gyration in 0.05..1.5_f64, center in -0.4..0.4_f64, symmetric in any::<bool>(),
            e in 0.0..=1.0_f64, width in prop_oneof![Just(0.0), 0.0..0.02_f64, 0.0..0.5_f64], at in 0.0..=1.0_f64,
            first in prop_oneof![Just(End::A), Just(End::B)],
        ) {
            let center = if symmetric { 0.0 } else { center };
            let (arm_a, arm_b) = (0.5 + center, 0.5 - center);
            let body = Body::off_center(arm_a, arm_b, gyration).unwrap();
            let (lo, hi) = (e * (1.0 - width), (e * (1.0 - width) + width).min(1.0));
            let loose = Clattering::new(&body, first).train(lo, hi);
            // One end first is the other one first of the body turned around.
            let turned = if first == End::A { body } else { Body::off_center(arm_b, arm_a, gyration).unwrap() };
            // Half a degree makes h0 = sin(0.5°) of the length 1.
            let scene = Scene::new(turned, lo + at * (hi - lo), 1.0, 0.5, 0.0).unwrap().with_impact_limit(3000).unwrap();
            let flight = scene.simulate(Model::Map);
            let h0 = scene.height_gap_m();
            let mut last = 0.0;
            let mut rest = 0.0;
            for (n, strike) in flight.strikes.iter().enumerate() {
                let i = usize::from(strike.end == End::B);
                let jump = strike.delta_v_m_s[i];
                let gap = (strike.time_s - last) / h0;
                last = strike.time_s;
                let Some(bound) = loose.strikes.get(n) else {
                    rest += jump;
                    continue;
                };
                prop_assert_eq!(bound.end, strike.end);
                // Where in the range e is, from −1 to 1.
                let xi = 2.0 * at - 1.0;
                let slack = 1e-9 * (1.0 + jump);
                prop_assert!(jump >= bound.jump.least - slack && jump <= bound.jump.most + slack, "strike {n}: {jump} not {bound:?}");
                let line = bound.jump.middle + xi * bound.jump.slope;
                prop_assert!((jump - line).abs() <= bound.jump.rest + slack, "strike {n}: {jump} off the line {bound:?}");
                let slack = 1e-6 * (1.0 + gap);
                prop_assert!(gap >= bound.gap.least - slack && gap <= bound.gap.most + slack, "strike {n}: gap {gap} not {bound:?}");
                if bound.gap.rest.is_finite() {
                    let line = bound.gap.middle + xi * bound.gap.slope;
                    prop_assert!((gap - line).abs() <= bound.gap.rest + slack, "strike {n}: {gap} off the line {bound:?}");
                }
            }
            prop_assert!(rest <= loose.omitted * (1.0 + 1e-9) + 1e-9, "{rest} left out, {} at most", loose.omitted);
            let sure = loose.strikes.len();
            prop_assert!(sure <= flight.strikes.len(), "{sure} are sure, {} happen", flight.strikes.len());
        }
    }

    #[test]
    fn a_range_of_no_width_leaves_no_doubt() {
        let body = Body::new(1.0, 0.5 / 3.0_f64.sqrt()).unwrap();
        let train = Clattering::new(&body, End::A).train(0.3, 0.3);
        assert_eq!(train.strikes.len(), 4, "the paper's reference bar");
        assert!(train.strikes.iter().all(|s| s.jump.rest == 0.0 && s.gap.rest == 0.0));
        assert!((train.strikes[1].jump.middle - 2.145).abs() < 1e-14);
        assert!((train.strikes[1].gap.middle - 1.0 / 1.65).abs() < 1e-15);
    }
}
