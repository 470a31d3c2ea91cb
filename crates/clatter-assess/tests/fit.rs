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

const LENGTH_M: f64 = 2000.0;
const SPEED_M_S: f64 = 4.0;

/// The radius of gyration of a bar with this inertia ratio.
fn gyration_m(q: f64) -> f64 {
    0.5 * LENGTH_M * ((1.0 - q) / (1.0 + q)).sqrt()
}

/// What a product file would say of it, which is wrong by a tenth in the radius of gyration.
fn known(q: f64) -> Known {
    Known {
        body: Body::new(LENGTH_M, 1.1 * gyration_m(q)).unwrap(),
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

fn strikes(list: &[(f64, End)]) -> Vec<MeasuredStrike> {
    list.iter().map(|&(time_s, end)| MeasuredStrike { time_s, end: Some(end) }).collect()
}

fn of(found: &Fit, quantity: Quantity) -> &Estimate {
    found
        .estimates
        .iter()
        .find(|estimate| estimate.quantity == quantity)
        .unwrap_or_else(|| panic!("{quantity:?} in {found:#?}"))
}

/// A record of a drop with noise: strikes up to the first that come within ten standard deviations, which no sensor tells apart.
fn noisy(truth: &Truth, most: usize, deviation_s: f64, random: &mut Random) -> Vec<(f64, End)> {
    let mut list = truth.strikes(most);
    if let Some(k) = list.windows(2).position(|pair| pair[1].0 - pair[0].0 < 10.0 * deviation_s) {
        list.truncate(k + 1);
    }
    list.iter().map(|(time_s, end)| (time_s + 0.1 + deviation_s * random.normal(), *end)).collect()
}

/// How often intervals hold the truth.
#[derive(Debug, Default)]
struct Coverage {
    of: usize,
    held: usize,
    width: f64,
    error: f64,
}

fn cover(
    name: &str,
    drops: usize,
    deviation_s: f64,
    given: bool,
    gyration_known: bool,
    least: usize,
    gaps_s: [f64; 2],
) {
    let mut random = Random(7);
    let mut rows: std::collections::BTreeMap<Quantity, Coverage> = std::collections::BTreeMap::default();
    let (mut all, mut untold) = (0, 0);
    let begin = std::time::Instant::now();
    while all < drops {
        let (q, e) = (random.within(0.4, 0.9), random.within(0.1, 0.8));
        let truth = Truth { q, e: [e; 2], gap_s: random.within(gaps_s[0], gaps_s[1]) };
        let list = noisy(&truth, 10, deviation_s, &mut random);
        if list.len() < least {
            continue;
        }
        all += 1;
        let mut known = Known { gyration_known, ..known(q) };
        if gyration_known {
            known.body = Body::new(LENGTH_M, gyration_m(q)).unwrap();
        }
        let found =
            fit(&known, &[Measured::Strikes { strikes: strikes(&list), deviation_s: given.then_some(deviation_s) }])
                .unwrap();
        if found.records[0].strikes.iter().any(|s| s.number.is_none())
            || !found.records[0].missing.is_empty()
            || found.records[0].scatter > 5.0 * deviation_s
        {
            eprintln!("{q} {e} {} {:?} {:e}", list.len(), found.notes, found.records[0].scatter);
        }
        untold += usize::from(found.untold.iter().any(|u| u.quantity == Quantity::RadiusOfGyration));
        let of =
            |quantity, truth| found.estimates.iter().find(|x| x.quantity == quantity).map(|x| (quantity, x, truth));
        for (quantity, x, truth) in [
            of(Quantity::Restitution, e),
            of(Quantity::RestitutionA, e),
            of(Quantity::RestitutionB, e),
            of(Quantity::InertiaRatio, q),
            of(Quantity::GapOverSpeed, truth.gap_s),
        ]
        .into_iter()
        .flatten()
        {
            let row = rows.entry(quantity).or_default();
            let [lo, hi] = x.interval.unwrap();
            row.of += 1;
            row.held += usize::from(lo <= truth && truth <= hi);
            row.width += 0.5 * (hi - lo);
            row.error += (x.value - truth).powi(2);
            if (quantity == Quantity::Restitution || quantity == Quantity::RestitutionA)
                && !(lo <= truth && truth <= hi)
            {
                eprintln!(
                    "MISS {name} q {q:.3} e {e:.3} gap {:.4} n {} est {:.4} [{lo:.4} {hi:.4}] scatter {:e} q est {:?} dof {}",
                    found.estimates.iter().find(|x| x.quantity == Quantity::GapOverSpeed).unwrap().value,
                    list.len(),
                    x.value,
                    found.records[0].scatter,
                    found.estimates.iter().find(|x| x.quantity == Quantity::InertiaRatio).map(|x| x.value),
                    found.degrees_of_freedom
                );
            }
        }
    }
    eprintln!("{name}: gyration untold {untold}, {:?}", begin.elapsed());
    for (quantity, row) in &rows {
        let n = row.of as f64;
        eprintln!(
            "  {quantity:?}: {} of {} = {:.3}, half-width {:.2e}, rms error {:.2e}",
            row.held,
            row.of,
            row.held as f64 / n,
            row.width / n,
            (row.error / n).sqrt()
        );
    }
}

#[test]
fn coverage() {
    cover("known gyration, unknown deviation, 10 us", 1000, 1e-5, false, true, 5, [2e-3, 8e-3]);
    cover("known gyration, known deviation, 10 us, 4+", 1000, 1e-5, true, true, 4, [2e-3, 8e-3]);
    cover("free gyration, unknown deviation, 2 us", 1000, 2e-6, false, false, 6, [2e-3, 8e-3]);
    cover("free gyration, known deviation, 10 us", 1000, 1e-5, true, false, 5, [2e-3, 8e-3]);
}

#[test]
fn debug_contacts() {
    let file = clatter_assess::ProductFile::read(clatter_assess::EXAMPLE, "").unwrap();
    let base = Known::from(&file);
    for (e, tilt, n) in [(0.35, 4.0, 7), (0.3, 2.0, 6), (0.3, 8.0, 8)] {
        let body = Body::new(0.14, 0.038).unwrap();
        let scene = clatter_flight::Scene::from_height(body, e, 1.2, tilt, 9.81).unwrap().with_impact_limit(n).unwrap();
        let contact = clatter_flight::Contact::new(ContactLaw::Hysteretic, e, 0.4e-3).unwrap();
        let flight = scene.contacts_until(&contact, 1e-7, |_| false).unwrap().flight;
        let list: Vec<_> =
            flight.strikes.iter().map(|s| (s.time_s + 0.5, if s.point == 0 { End::A } else { End::B })).collect();
        for known in [base.clone(), Known { gyration_known: true, ..base.clone() }] {
            for noise in [1e-6] {
                let mut random = Random(3);
                let list: Vec<_> = list.iter().map(|(t, e)| (t + noise * random.normal(), *e)).collect();
                let begin = std::time::Instant::now();
                let found =
                    fit(&known, &[Measured::Strikes { strikes: strikes(&list), deviation_s: Some(noise) }]).unwrap();
                eprintln!(
                    "{e} {tilt} {n} {:?}: {:?} scatter {:e} {:?}",
                    begin.elapsed(),
                    found.estimates.iter().map(|x| (x.quantity, x.value, x.interval)).collect::<Vec<_>>(),
                    found.records[0].scatter,
                    found.notes
                );
            }
        }
    }
}

#[test]
fn debug_heights() {
    let file = clatter_assess::ProductFile::read(clatter_assess::EXAMPLE, "").unwrap();
    for (spin, first) in [(0.0, End::A), (3.0, End::A), (-2.0, End::B)] {
        let known = Known { contact_time_s: None, ..Known::from(&file) };
        let body = Body::new(0.14, 0.0365).unwrap();
        let scene = clatter_flight::Scene::new(body, 0.33, 4.2, 5.0, 9.80665).unwrap().with_spin(spin).unwrap();
        let flight = scene.simulate(clatter_flight::Model::FiniteTilt);
        let mut random = Random(3);
        let samples: Vec<_> = (0..150)
            .map(|k| {
                let time_s = 1e-3 * k as f64;
                let t = time_s - 0.02034;
                let mut h = if t >= 0.0 {
                    scene.heights_m(clatter_flight::Model::FiniteTilt, &flight, t)
                } else {
                    let y = 0.07 * 5f64.to_radians().sin() - t * (4.2 + 0.5 * 9.80665 * t);
                    let phi = 5f64.to_radians() + spin * t;
                    [y - 0.07 * phi.sin(), y + 0.07 * phi.sin()]
                };
                if first == End::B {
                    h.swap(0, 1);
                }
                clatter_assess::fit::MeasuredHeights { time_s, height_m: h.map(|h| h + 2e-4 * random.normal()) }
            })
            .collect();
        let begin = std::time::Instant::now();
        let found = fit(&known, &[Measured::Heights { samples, deviation_m: None }]).unwrap();
        eprintln!(
            "{:?}: first {:?} {:?} {:?} scatter {:e} {:?}",
            begin.elapsed(),
            found.first,
            found.estimates.iter().map(|x| (x.quantity, x.value, x.interval)).collect::<Vec<_>>(),
            found.untold,
            found.records[0].scatter,
            found.notes
        );
    }
}

#[test]
fn debug_acceleration() {
    let file = clatter_assess::ProductFile::read(clatter_assess::EXAMPLE, "").unwrap();
    for (place, noise) in [(0.03, 5.0), (-0.06, 20.0)] {
        let known = Known::from(&file);
        let body = Body::new(0.14, 0.0365).unwrap();
        let scene = clatter_flight::Scene::new(body, 0.33, 4.7, 5.0, 9.80665).unwrap();
        let contact = clatter_flight::Contact::new(ContactLaw::Hysteretic, 0.33, 0.45e-3).unwrap();
        let flight = scene.contacts(&contact).unwrap();
        let mut random = Random(3);
        let values: Vec<f64> = (0..600)
            .map(|k| {
                let t = 2e-5 * k as f64 - 0.00204;
                let a = if t < 0.0 {
                    0.0
                } else {
                    let a = flight.sample(t).acceleration_m_s2;
                    let s = place / 0.07;
                    0.5 * ((1.0 - s) * a[0] + (1.0 + s) * a[1]) + 9.80665
                };
                a + noise * random.normal()
            })
            .collect();
        let begin = std::time::Instant::now();
        let found = fit(
            &known,
            &[Measured::Acceleration { position_m: place, start_s: 0.0, step_s: 2e-5, values_m_s2: values }],
        )
        .unwrap();
        eprintln!(
            "{:?}: first {:?} {:?} {:?} scatter {:e} {:?}",
            begin.elapsed(),
            found.first,
            found.estimates.iter().map(|x| (x.quantity, x.value, x.interval)).collect::<Vec<_>>(),
            found.untold,
            found.records[0].scatter,
            found.notes
        );
    }
}
