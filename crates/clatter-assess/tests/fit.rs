//! Fits to synthetic drops whose truth is known. The strikes come from the plain recursion of the paper's Eqs. 1 to 3, which shares
//! nothing with the flights that the fit computes.

use clatter::End;
use clatter_assess::First;
use clatter_assess::fit::{Estimate, Fit, Known, Measured, MeasuredStrike, Quantity, fit};
use clatter_flight::{Body, ContactLaw};

/// Numbers in (0, 1), and of the standard normal distribution: `SplitMix64`, and Box and Muller.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let bits = ((z ^ (z >> 31)) >> 11) as f64;
        (bits + 0.5) / 9_007_199_254_740_992.0
    }
    fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.uniform()
    }
    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// A drop of a symmetric bar at small tilt, without gravity.
#[derive(Debug, Clone, Copy)]
struct Truth {
    q: f64,
    e: [f64; 2],
    /// Gap over speed.
    gap_s: f64,
}

impl Truth {
    /// Times and ends of at most so many strikes, by Eqs. 1 to 3: the end that strikes leaves with −e u, the other gets −q (1 + e) u
    /// downward; between strikes straight lines.
    fn strikes(&self, most: usize) -> Vec<(f64, End)> {
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

const LENGTH_M: f64 = 0.2;
const SPEED_M_S: f64 = 4.0;

/// The radius of gyration of a bar with this inertia ratio.
fn gyration_m(q: f64) -> f64 {
    0.5 * LENGTH_M * ((1.0 - q) / (1.0 + q)).sqrt()
}

/// What a product file would say of it, which is wrong by a tenth in the radius of gyration.
fn known(q: f64) -> Known {
    Known {
        body: Body::new(LENGTH_M, 1.1 * gyration_m(q)).unwrap(),
        first: First::Either,
        gravity_m_s2: 0.0,
        restitution: [0.1, 0.9],
        speed_m_s: [3.5, 4.5],
        tilt_rad: [0.0, 0.1],
        contact_time_s: None,
        contact_law: ContactLaw::Hysteretic,
    }
}

fn strikes(list: &[(f64, End)]) -> Vec<MeasuredStrike> {
    list.iter().map(|&(time_s, end)| MeasuredStrike { time_s, end: Some(end) }).collect()
}

fn of(found: &Fit, quantity: Quantity) -> &Estimate {
    found.estimates.iter().find(|estimate| estimate.quantity == quantity).unwrap_or_else(|| panic!("{quantity:?} in {found:#?}"))
}

#[test]
fn exact_strikes_give_the_truth() {
    for (q, e) in [(0.5, 0.3), (0.73, 0.2), (0.85, 0.6), (0.6, 0.45)] {
        let truth = Truth { q, e: [e; 2], gap_s: 2e-3 };
        let list: Vec<_> = truth.strikes(8).into_iter().map(|(t, end)| (t + 0.37, end)).collect();
        let found = fit(&known(q), &[Measured::Strikes { strikes: strikes(&list), deviation_s: Some(1e-8) }]).unwrap();
        eprintln!("{q} {e}: n {} {:#?} {:?}", list.len(), found.estimates, found.untold);
    }
}

#[test]
fn coverage() {
    let mut random = Random(1);
    let mut rows: std::collections::BTreeMap<Quantity, (usize, usize, f64)> = Default::default();
    let begin = std::time::Instant::now();
    let mut all = 0;
    while all < 300 {
        let q = random.within(0.4, 0.9);
        let e = random.within(0.1, 0.8);
        let truth = Truth { q, e: [e; 2], gap_s: random.within(1e-3, 5e-3) };
        let list = truth.strikes(10);
        if list.len() < 6 { continue; }
        all += 1;
        let noisy: Vec<_> = {
            let mut l: Vec<_> = list.iter().map(|(t, end)| (t + 0.1 + 1e-5 * random.normal(), *end)).collect();
            l.sort_by(|a, b| a.0.total_cmp(&b.0));
            l
        };
        let found = match fit(&known(q), &[Measured::Strikes { strikes: strikes(&noisy), deviation_s: None }]) {
            Ok(f) => f,
            Err(error) => { eprintln!("{q} {e} {}: {error}", list.len()); continue; }
        };
        if !found.notes.is_empty() { eprintln!("{q} {e} {} {:?}", list.len(), found.notes); }
        for (quantity, true_value) in [(Quantity::Restitution, e), (Quantity::RestitutionA, e), (Quantity::RestitutionB, e), (Quantity::GapOverSpeed, truth.gap_s), (Quantity::InertiaRatio, q)] {
            if let Some(x) = found.estimates.iter().find(|x| x.quantity == quantity) {
                let row = rows.entry(quantity).or_default();
                let [lo, hi] = x.interval.unwrap();
                row.0 += 1;
                row.1 += usize::from(lo <= true_value && true_value <= hi);
                row.2 += 0.5 * (hi - lo);
            }
        }
    }
    for (q, (n, k, w)) in rows {
        eprintln!("{q:?}: {k} of {n}: {:.3}, mean half-width {:e}", k as f64 / n as f64, w / n as f64);
    }
    eprintln!("{:?}", begin.elapsed());
}
