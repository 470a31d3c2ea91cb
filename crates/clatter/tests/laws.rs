//! Laws that hold for every bar and start: physics, symmetry, scaling, and the agreement of all ways.
#![expect(clippy::float_cmp, reason = "exact answers are compared exactly")]

use clatter::accuracy::{APPROACH, FINAL, PEAK, TIME};
use clatter::{Axis, Bar, Count, End, Error, Impact, Map, Mass, PeakImpact, Quantity, Start, reference};
use proptest::prelude::*;

const ROUNDING: f64 = 0.5 * f64::EPSILON;

/// Impacts listed at most.
const SOME: usize = 60;

fn bars() -> impl Strategy<Value = Bar> {
    (-0.99..=1.0_f64, 0.0..=1.0_f64).prop_map(|(q, e)| Bar::new(q, e).expect("in range"))
}

fn starts() -> impl Strategy<Value = Start> {
    let spinning = (0.1..10.0_f64, -20.0..10.0_f64).prop_map(|(va, vb)| Start::new([-va, vb], 1.0).expect("in range"));
    prop_oneof![Just(Start::default()), spinning]
}

fn some(bar: &Bar, start: &Start) -> Vec<Impact> {
    bar.train(start).take(SOME).collect()
}

/// Returns the velocities of ends a and b before each impact and after the last: the start and the jumps added up.
fn velocities(start: &Start, impacts: &[Impact]) -> Vec<[f64; 2]> {
    let mut v = start.velocity();
    let after = impacts.iter().map(|i| {
        v = [v[0] + i.delta_v[0], v[1] + i.delta_v[1]];
        v
    });
    std::iter::once(start.velocity()).chain(after).collect()
}

/// Returns the largest velocity so far: what roundings and allowed errors are measured by.
fn size(start: &Start, impacts: &[Impact]) -> f64 {
    let [va, vb] = start.velocity();
    impacts.iter().flat_map(|i| i.delta_v).fold(va.abs().max(vb.abs()), |most, v| most.max(v.abs()))
}

/// Roundings and allowed errors that adding up n jumps collects.
fn sum_error(impacts: &[Impact], size: f64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "at most 60")]
    let n = impacts.len() as f64;
    (n + 1.0) * 2.0 * (APPROACH.error + 2.0 * ROUNDING) * size
}

/// Returns twice the energy per mass, v² + (ρω)² with Lω = (`v_b` − `v_a`)/2 and (ρ/L)² = k².
fn energy(bar: &Bar, [a, b]: [f64; 2]) -> f64 {
    let (center, spin) = (0.5 * (a + b), 0.5 * (b - a));
    center * center + bar.percussion(End::A) * spin * spin
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// The speed a of the struck end carries the energy a² k²/(1 + k²) = a² (1 − q)/2, of which 1 − e² is lost.
    #[test]
    fn each_impact_loses_its_share_of_energy(bar in bars(), start in starts()) {
        let impacts = some(&bar, &start);
        let v = velocities(&start, &impacts);
        let size = size(&start, &impacts);
        for (pair, impact) in v.windows(2).zip(&impacts) {
            let lost = energy(&bar, pair[0]) - energy(&bar, pair[1]);
            let carried = 0.5 * (1.0 - bar.q()) * impact.approach.powi(2);
            let want = (1.0 - bar.e() * bar.e()) * carried;
            // Squares of velocities each as good as their sums, and a dozen roundings of the energy.
            let budget = (4.0 * sum_error(&impacts, size) + 12.0 * ROUNDING * size) * size * (1.0 + bar.percussion(End::A));
            prop_assert!((lost - want).abs() <= budget, "impact {}: {lost:e} not {want:e}", impact.number);
        }
    }

    /// The blow passes through the struck end, about which angular momentum is kept: L Δv_center = ∓ρ² Δω.
    #[test]
    fn each_impact_keeps_angular_momentum_about_the_struck_end(bar in bars(), start in starts()) {
        for impact in some(&bar, &start) {
            let [a, b] = impact.delta_v;
            let (center, spin) = (0.5 * (a + b), 0.5 * (b - a));
            let side = if impact.end == End::A { -1.0 } else { 1.0 };
            let budget = 12.0 * ROUNDING * (a.abs() + b.abs()) * (1.0 + bar.percussion(End::A));
            prop_assert!((center - side * bar.percussion(End::A) * spin).abs() <= budget, "{impact:?}");
        }
    }

    /// Checks Newton's law at the struck end, and that a blow never pulls.
    #[test]
    fn each_struck_end_departs_at_e_times_its_approach(bar in bars(), start in starts()) {
        let impacts = some(&bar, &start);
        let v = velocities(&start, &impacts);
        let error = sum_error(&impacts, size(&start, &impacts));
        for (pair, impact) in v.windows(2).zip(&impacts) {
            let end = usize::from(impact.end != End::A);
            prop_assert!(impact.approach <= 0.0, "it approaches: {impact:?}");
            prop_assert!((pair[0][end] - impact.approach).abs() <= error, "before: {impact:?}");
            prop_assert!((pair[1][end] + bar.e() * impact.approach).abs() <= error, "after: {impact:?}");
        }
    }

    /// The ends may change names: what is left after a strike at a is a train in which b strikes first.
    #[test]
    fn the_ends_may_be_exchanged(bar in bars(), start in starts(), threshold in 0.1..5.0_f64) {
        let impacts = some(&bar, &start);
        if let [first, second, ..] = impacts[..]
            && let Ok(rest) = Start::new([second.approach, -bar.e() * first.approach], 1.0)
        {
            let error = 2.0 * sum_error(&impacts, size(&start, &impacts));
            for (got, want) in some(&bar, &rest).iter().zip(&impacts[1..]) {
                prop_assert_eq!(got.end.other(), want.end, "order");
                prop_assert!((got.delta_v[0] - want.delta_v[1]).abs() <= error, "{got:?}, {want:?}");
                prop_assert!((got.delta_v[1] - want.delta_v[0]).abs() <= error, "{got:?}, {want:?}");
            }
        }
        let [a, b] = [End::A, End::B].map(|first| bar.shocks(&start, first).safe_interval(threshold));
        prop_assert_eq!(b, a.map(|[lo, hi]| [-hi, -lo]), "mirror image");
        for impact in impacts {
            // Eq. 3 seen from the other end.
            let mirrored = Impact { delta_v: [impact.delta_v[1], impact.delta_v[0]], ..impact };
            prop_assert_eq!(mirrored.delta_v_at(-0.3), impact.delta_v_at(0.3), "position");
        }
    }

    /// Velocities scale with v0, times with h0/v0: to the last digit by powers of two, else to the allowed errors.
    #[test]
    fn velocities_and_times_scale(bar in bars(), start in starts(), x in -60..60_i32, y in -60..60_i32, c in 0.3..3.0_f64) {
        let ([va, vb], one) = (start.velocity(), bar.summary(&start));
        let (v, h) = (2f64.powi(x), 2f64.powi(y));
        let scaled = Start::new([va * v, vb * v], h).unwrap();
        let s = bar.summary(&scaled);
        prop_assert_eq!((s.count, s.peak.impact), (one.count, one.peak.impact));
        prop_assert_eq!((s.peak.end, s.peak.center), (one.peak.end * v, one.peak.center * v));
        prop_assert_eq!(s.duration, one.duration * h / v);
        prop_assert_eq!(s.final_velocity, one.final_velocity.map(|[a, b]| [a * v, b * v]));
        for (got, want) in bar.train(&scaled).zip(bar.train(&start)).take(SOME) {
            let want = Impact { time: want.time * h / v, approach: want.approach * v, delta_v: want.delta_v.map(|d| d * v), ..want };
            prop_assert_eq!(got, want);
        }
        // c va and c vb are rounded: the ratio moves by two roundings, and a count may move with it next to a tie.
        let scaled = Start::new([va * c, vb * c], c).unwrap();
        let s = bar.summary(&scaled);
        if s.count == one.count {
            let error = PEAK.error + 8.0 * ROUNDING * (1.0 + (vb / va).abs());
            prop_assert!((s.peak.end - c * one.peak.end).abs() <= error * c * one.peak.end || one.peak.end.is_infinite(), "peak");
        }
    }

    /// Closed form, iteration and the matrices as printed are one.
    #[test]
    fn closed_form_train_and_matrices_agree(bar in bars(), start in starts(), s in -1.0..1.0_f64) {
        let impacts = some(&bar, &start);
        let [va, vb] = start.velocity();
        let size = size(&start, &impacts);
        for (impact, i) in impacts.iter().zip(1_u32..) {
            // A power of PA by squaring: some i roundings of the largest velocity, times 2 for each product of norms.
            let error = 2.0 * (APPROACH.error + f64::from(8 * i + 8) * ROUNDING) * size;
            let jump = reference::jumps(bar.q(), bar.e(), [va, vb].into(), i);
            prop_assert!((jump.x - impact.delta_v[0]).abs() <= error, "Eq. 2 at {impact:?}");
            prop_assert!((jump.y - impact.delta_v[1]).abs() <= error, "Eq. 2 at {impact:?}");
            prop_assert!((reference::shock_at(jump, s) - impact.delta_v_at(s)).abs() <= error, "Eq. 3 at {s}");
            let turn = 0.5 * (impact.delta_v[1] - impact.delta_v[0]);
            prop_assert!((reference::angular_change(jump) - turn).abs() <= error, "Eq. 3, angular");
        }
        let summary = bar.summary(&start);
        let listed = u32::try_from(impacts.len()).unwrap();
        if summary.count == Count::Finite(u64::from(listed)) && impacts.len() < SOME {
            // The summary's last velocities are Eq. 1's, and its peak the largest jump of a struck end.
            let (v, [a, b]) = (reference::velocities(bar.q(), bar.e(), [va, vb].into(), listed), summary.final_velocity.unwrap());
            let error = FINAL.error * a.abs().max(b.abs()) + f64::from(16 * listed + 16) * ROUNDING * size;
            prop_assert!((v.x - a).abs() <= error && (v.y - b).abs() <= error, "Eq. 1: {v} not [{a}, {b}]");
            let largest = impacts.iter().map(|i| -(1.0 + bar.e()) * i.approach).fold(0.0, f64::max);
            prop_assert!((summary.peak.end - largest).abs() <= (PEAK.error + 2.0 * APPROACH.error) * largest, "peak");
            let last = impacts[impacts.len() - 1];
            let error = (TIME.error + 1e-9) * last.time.max(1.0 / -va);
            prop_assert!((summary.duration - last.time).abs() <= error, "duration");
        }
    }

    /// Eq. 3 is linear along the bar, from one end's jump to the other's.
    #[test]
    fn shocks_are_linear_along_the_bar(bar in bars(), start in starts(), s in -1.0..1.0_f64) {
        for impact in some(&bar, &start) {
            let [a, b] = impact.delta_v;
            let error = 6.0 * ROUNDING * (a.abs() + b.abs());
            prop_assert_eq!([impact.delta_v_at(-1.0), impact.delta_v_at(1.0)], [a, b]);
            let (mean, here) = (impact.delta_v_at(0.0), impact.delta_v_at(s));
            prop_assert!((here + impact.delta_v_at(-s) - 2.0 * mean).abs() <= error, "odd about the center");
            prop_assert!((here - (mean + 0.5 * s * (b - a))).abs() <= error, "slope");
            let struck = if impact.end == End::A { a } else { b };
            prop_assert!((bar.share(impact.end, s) * struck - here).abs() <= 2.0 * error, "the share of the struck end");
        }
    }

    /// The sum of all jumps is the net change, and the start plus it what is left.
    #[test]
    fn all_jumps_add_up_to_the_net_change(bar in bars(), start in starts()) {
        let (s, impacts) = (bar.summary(&start), some(&bar, &start));
        if let (Some(net), true) = (s.net, impacts.len() < SOME) {
            let sum = impacts.iter().fold([0.0, 0.0], |sum, i| [sum[0] + i.delta_v[0], sum[1] + i.delta_v[1]]);
            let size = size(&start, &impacts);
            let error = sum_error(&impacts, size) + FINAL.error * size;
            prop_assert!((sum[0] - net.a).abs() <= error && (sum[1] - net.b).abs() <= error, "{sum:?} not {net:?}");
            prop_assert!((0.5 * (sum[0] + sum[1]) - net.center).abs() <= error, "center");
            prop_assert!((0.5 * (sum[1] - sum[0]) - net.angular).abs() <= error, "angular");
            let [a, b] = s.final_velocity.unwrap();
            prop_assert!(a >= 0.0 && b >= 0.0, "both ends leave: [{a}, {b}]");
        }
    }

    /// Inside a train times rise and ends alternate; approach speeds rise to the peak, then fall.
    #[test]
    fn trains_rise_to_their_peak_and_then_fall(bar in bars(), start in starts()) {
        let (peak, impacts) = (bar.peak(&start), some(&bar, &start));
        let highest = match peak.impact {
            PeakImpact::Number(n) => n,
            _ => u64::MAX,
        };
        for pair in impacts.windows(2) {
            let [before, after] = [pair[0], pair[1]];
            prop_assert_eq!((after.number, after.end), (before.number + 1, before.end.other()));
            let ([first, second], allowed) = ([-before.approach, -after.approach], 2.0 * APPROACH.error);
            let scale = allowed * first.max(-start.velocity()[0]);
            if after.number <= highest {
                prop_assert!(second > first - scale, "rises to {highest}: {before:?}, {after:?}");
            } else {
                prop_assert!(second < first + scale, "falls from {highest}: {before:?}, {after:?}");
            }
            // Late strikes crowd below the limit of the times, closer than the allowed error.
            let crowded = 2.0 * TIME.error * after.time.max(1.0 / -start.velocity()[0]);
            let rises = if before.number == 1 { after.time > 0.0 } else { after.time > before.time - crowded };
            prop_assert!(rises, "{pair:?}");
        }
    }

    /// The peak rises with q and with e, the count with q.
    #[test]
    fn peaks_rise_and_counts_fall_with_their_arguments(q in -0.99..=1.0_f64, e in 0.0..=1.0_f64, f in 0.0..1.0_f64) {
        let one = Start::default();
        let peak = |q, e| Bar::new(q, e).unwrap().peak(&one).end;
        let allowed = 1.0 - 2.0 * PEAK.error;
        let (more_e, more_q) = (e + f * (1.0 - e), q + f * (1.0 - q));
        prop_assert!(peak(q, more_e) >= peak(q, e) * allowed, "in e from {e} to {more_e} at q = {q}");
        prop_assert!(peak(more_q, e) >= peak(q, e) * allowed, "in q from {q} to {more_q} at e = {e}");
        let count = |q| match Bar::new(q, e).unwrap().count(&one) {
            Count::Finite(n) => n,
            Count::Huge(_) | Count::Endless => u64::MAX,
        };
        prop_assert!(count(more_q) >= count(q), "count in q from {q} to {more_q} at e = {e}");
    }

    /// Checks one bar that is given in four ways.
    #[test]
    fn the_ways_of_giving_the_inertia_agree(k in 0.01..20.0_f64, half in 0.01..10.0_f64, m in 0.01..100.0_f64, e in 0.0..=1.0_f64) {
        let rho = k * half;
        let bars = [
            Bar::new((1.0 - k * k) / (1.0 + k * k), e),
            Bar::from_gyration_ratio(k, e),
            Bar::from_gyration_radius(half, rho, e),
            Bar::from_moment_of_inertia(m, 2.0 * half, m * rho * rho, e),
            // Two equal masses at ±ρ.
            Bar::from_masses(2.0 * half, &[-rho, rho].map(|position_m| Mass::Point { mass_kg: 0.5 * m, position_m }), e),
            // A slab of radius of gyration ρ: of length √12 ρ.
            Bar::from_masses(2.0 * half, &[Mass::Slab { mass_kg: m, from_m: -3f64.sqrt() * rho, to_m: 3f64.sqrt() * rho }], e),
        ];
        for bar in bars {
            let bar = bar.unwrap();
            // A dozen roundings of k², which dq = −(1 − q²)/2 · dk²/k² does not amplify; those of 1 − q as given.
            prop_assert!((bar.q() - (1.0 - k * k) / (1.0 + k * k)).abs() <= 12.0 * ROUNDING, "{bar:?}");
            let given = 8.0 * ROUNDING * (1.0 + 1.0 / (k * k) + k * k);
            prop_assert!((bar.gyration_ratio() / k - 1.0).abs() <= given + 12.0 * ROUNDING, "{bar:?}");
            prop_assert!((bar.percussion(End::A) / (k * k) - 1.0).abs() <= 2.0 * given + 24.0 * ROUNDING, "{bar:?}");
        }
    }

    /// Mass mirrored about the middle is symmetric however it is rounded; no real offset is.
    #[test]
    fn mirrored_masses_are_symmetric(
        pieces in prop::collection::vec((0.01..1.0_f64, -0.07..0.07_f64, 0.0..0.05_f64), 1..8), off in 1e-9..0.5_f64,
    ) {
        let mut masses = Vec::new();
        for &(mass_kg, from, width) in &pieces {
            masses.push(Mass::Slab { mass_kg, from_m: from, to_m: from + width });
            masses.push(Mass::Slab { mass_kg, from_m: -(from + width), to_m: -from });
        }
        prop_assert!(Bar::from_masses(0.14, &masses, 0.3).unwrap().is_symmetric());
        let total: f64 = 2.0 * pieces.iter().map(|p| p.0).sum::<f64>();
        masses.push(Mass::Point { mass_kg: total, position_m: 2.0 * off * 0.07 });
        // Half the mass is at twice `off`.
        match Bar::from_masses(0.14, &masses, 0.3).unwrap().symmetric() {
            Err(Error::OffCenter { offset }) => prop_assert!((offset / off - 1.0).abs() < 1e-6, "{offset} not {off}"),
            other => prop_assert!(false, "{other:?}"),
        }
    }
}

#[test]
fn masses_that_make_no_bar_are_refused_with_a_reason() {
    let point = |mass_kg, position_m| Mass::Point { mass_kg, position_m };
    let slab = |mass_kg, from_m, to_m| Mass::Slab { mass_kg, from_m, to_m };
    let message = |masses: &[Mass]| Bar::from_masses(0.14, masses, 0.3).unwrap_err().to_string();
    assert_eq!(message(&[]), "no mass is given");
    let off = Bar::from_masses(0.14, &[slab(0.1, -0.07, 0.07), point(0.1, 0.035)], 0.3).unwrap();
    let off = off.symmetric().unwrap_err().to_string();
    assert_eq!(off, "the center of mass lies 0.25 of a half-length off the middle; this bar must be symmetric");
    for (masses, parts) in [
        (vec![point(f64::NAN, 0.0)], ["mass (kg) = NaN", "1e-25"]),
        (vec![point(-0.1, 0.0)], ["mass (kg) = -0.1", "1e-25"]),
        (vec![point(0.0, 0.0)], ["mass (kg) = 0.0", "1e-25"]),
        (vec![point(f64::INFINITY, 0.0)], ["mass (kg) = inf", "1e25"]),
        (vec![point(0.1, f64::NAN)], ["position (m) = NaN", "1e25"]),
        (vec![slab(0.1, f64::NEG_INFINITY, 0.0)], ["position (m) = -inf", "1e25"]),
        (vec![slab(0.1, 0.07, -0.07)], ["end of slab (m) = -0.07", "where the slab begins"]),
    ] {
        let text = message(&masses);
        assert!(parts.iter().all(|part| text.contains(part)), "{masses:?}: {text}");
    }
    for length in [0.0, -0.14, f64::NAN, f64::INFINITY] {
        let text = Bar::from_masses(length, &[point(0.1, 0.0)], 0.3).unwrap_err().to_string();
        assert!(text.starts_with(&format!("length (m) = {length:?}")), "{text}");
    }
    let text = Bar::from_masses(0.14, &[point(0.1, 0.0)], 1.5).unwrap_err().to_string();
    assert_eq!(text, "restitution e = 1.5 is not in [0, 1]");
}

/// 0.14 − 0.07 is not 0.07 in floats: a bar that is symmetric but for that is symmetric.
#[test]
fn a_rounding_off_center_is_no_offset() {
    let to_m = 0.14 - 0.069_999_999_999_999_99;
    let slab = Mass::Slab { mass_kg: 0.1, from_m: -0.07, to_m };
    assert!(to_m > 0.07, "rounded");
    let bar = Bar::from_masses(0.14, &[slab], 0.3).unwrap();
    assert!(bar.is_symmetric() && (bar.q() - 0.5).abs() < 1e-15, "a uniform bar");
    let point = Mass::Point { mass_kg: 0.1, position_m: 0.1 + 0.2 - 0.3 };
    assert!(
        Bar::from_masses(0.14, &[point], 0.3).is_ok_and(|bar| bar.is_symmetric() && bar.q() > 1.0 - 1e-15),
        "at the center"
    );
}

/// At e = 0 the second strike is the largest, 1 + q; a map of more rows than one thread takes at once has each in its place.
#[test]
fn rows_of_a_long_map_are_in_their_places() {
    let q = Axis::q(0.0, 1.0, 10_001).unwrap();
    let map = Map::compute(Quantity::PeakEnd, q, Axis::e(0.0, 0.5, 2).unwrap()).unwrap();
    for (i, row) in (0_u32..).zip(map.values.chunks(2)) {
        let want = 1.0 + 1e-4 * f64::from(i);
        assert!((row[0] - want).abs() < 1e-12, "row {i}: {}, not {want}", row[0]);
    }
}
