//! Records of drops whose truth is known, and what a fit says of them.

use clatter::End;
use clatter_fit::{Estimate, Fit, Known, MeasuredStrike, Quantity};
use clatter_flight::{Body, ContactLaw};
use clatter_product::First;

/// Numbers in (0, 1), and of the standard normal distribution: `SplitMix64`, and Box and Muller.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let bits = ((z ^ (z >> 31)) >> 11) as f64;
        (bits + 0.5) / 9_007_199_254_740_992.0
    }
    pub(crate) fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.uniform()
    }
    pub(crate) fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// A drop of a symmetric bar at small tilt, without gravity.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Truth {
    pub(crate) q: f64,
    pub(crate) e: [f64; 2],
    /// Gap over speed.
    pub(crate) gap_s: f64,
}

impl Truth {
    /// Times and ends of at most so many strikes, by Eqs. 1 to 3: the end that strikes leaves with −e u, the other gets −q (1 + e) u
    /// downward; between strikes straight lines.
    pub(crate) fn strikes(&self, most: usize) -> Vec<(f64, End)> {
        let (mut height, mut velocity, mut time) = ([0.0, self.gap_s], [-1.0, -1.0], 0.0);
        let mut strikes = Vec::new();
        let mut end = 0;
        while strikes.len() < most {
            strikes.push((time, if end == 0 { End::A } else { End::B }));
            let (u, e) = (velocity[end], self.e[end]);
            velocity[end] = -e * u;
            velocity[1 - end] += self.q * (1.0 + e) * u;
            height[end] = 0.0;
            end = 1 - end;
            if velocity[end] >= 0.0 {
                break;
            }
            let wait = height[end] / -velocity[end];
            height[1 - end] += velocity[1 - end] * wait;
            time += wait;
        }
        strikes
    }
}

/// So long that the gap is a vanishing tilt.
pub(crate) const LENGTH_M: f64 = 2000.0;

/// The radius of gyration of a bar with this inertia ratio.
pub(crate) fn gyration_m(q: f64) -> f64 {
    0.5 * LENGTH_M * ((1.0 - q) / (1.0 + q)).sqrt()
}

/// What a product file would say of it, which is wrong by a tenth in the radius of gyration.
pub(crate) fn known(q: f64) -> Known {
    Known {
        body: Body::new(LENGTH_M, 1.1 * gyration_m(q)).expect("as the test has it"),
        gyration_m: [1.1 * gyration_m(q); 2],
        gyration_known: false,
        first: First::Either,
        gravity_m_s2: 0.0,
        restitution: [0.1, 0.9],
        speed_m_s: [3.5, 4.5],
        tilt_rad: [0.0, 1e-5],
        contact_time_s: None,
        contact_law: ContactLaw::Hysteretic,
    }
}

pub(crate) fn strikes(list: &[(f64, End)]) -> Vec<MeasuredStrike> {
    list.iter().map(|&(time_s, end)| MeasuredStrike { time_s, end: Some(end) }).collect()
}

pub(crate) fn of(found: &Fit, quantity: Quantity) -> &Estimate {
    found
        .estimates
        .iter()
        .find(|estimate| estimate.quantity == quantity)
        .unwrap_or_else(|| panic!("{quantity:?} in {found:#?}"))
}

/// A record of a drop with noise: strikes up to the first that come within ten standard deviations, which no sensor tells apart.
pub(crate) fn noisy(truth: &Truth, most: usize, deviation_s: f64, random: &mut Random) -> Vec<(f64, End)> {
    let mut list = truth.strikes(most);
    if let Some(k) = list.windows(2).position(|pair| pair[1].0 - pair[0].0 < 10.0 * deviation_s) {
        list.truncate(k + 1);
    }
    list.iter().map(|(time_s, end)| (time_s + 0.1 + deviation_s * random.normal(), *end)).collect()
}

/// The estimate of the restitution that end a has, alone or with end b.
pub(crate) fn restitution_of_a(found: &Fit) -> &Estimate {
    restitution_told(found).unwrap_or_else(|| panic!("a restitution in {found:#?}"))
}

pub(crate) fn restitution_told(found: &Fit) -> Option<&Estimate> {
    let is = |x: &&Estimate| matches!(x.quantity, Quantity::Restitution | Quantity::RestitutionA);
    found.estimates.iter().find(is)
}

pub(crate) fn holds(estimate: &Estimate, truth: f64) -> bool {
    let [lo, hi] = estimate.interval.expect("as the test has it");
    (lo..=hi).contains(&truth)
}
