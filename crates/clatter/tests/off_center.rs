//! The off-center bar against its own matrices, impulses on a rigid body, the symmetric bar, and a search along the bar.
use clatter::{Bar, Count, End, Error, Extent, Impact, Mass, Start};
use nalgebra::{Matrix2, Vector2};
use proptest::prelude::*;

/// Eqs. 1 and 2 with q_a and q_b in the two matrices, times from the heights: the plain way, strike by strike.
fn plain(arms: [f64; 2], rho: f64, e: f64, start: &Start, most: usize) -> Vec<Impact> {
    let [a, b] = arms;
    let product = a * b - rho * rho;
    let [qa, qb] = [product / (a * a + rho * rho), product / (b * b + rho * rho)];
    let strike = [Matrix2::new(-e, 0.0, qa * (1.0 + e), 1.0), Matrix2::new(1.0, qb * (1.0 + e), 0.0, -e)];
    let mut v = Vector2::from(start.velocity());
    let mut h = Vector2::new(0.0, start.height_gap());
    let (mut list, mut time) = (Vec::new(), 0.0);
    while list.len() < most {
        let i = list.len() % 2;
        if v[i] >= 0.0 {
            break;
        }
        let fall = h[i] / -v[i];
        (h, time) = (h + v * fall, time + fall);
        h[i] = 0.0;
        let after = strike[i] * v;
        let jump = after - v;
        let (number, end) = (list.len() as u64 + 1, if i == 0 { End::A } else { End::B });
        list.push(Impact { number, end, time, approach: v[i], delta_v: [jump.x, jump.y] });
        v = after;
    }
    list
}

/// Returns the impacts of a rigid body of unit mass that falls with velocity v and turns with ω. An impulse p at
/// distance x from its center of mass changes v and ω by p and p x/ρ²; it reverses the approach velocity to −e times it.
fn by_impulses([a, b]: [f64; 2], rho: f64, e: f64, motion: [f64; 2], gap: f64, most: usize) -> Vec<Impact> {
    let ends = [-a, b];
    let at = |[v, w]: [f64; 2]| ends.map(|x| v + w * x);
    // Heights of the center of mass, and the tilt.
    let (mut motion, mut height, mut tilt) = (motion, gap * a / (a + b), gap / (a + b));
    let (mut list, mut time) = (Vec::new(), 0.0);
    while list.len() < most {
        let i = list.len() % 2;
        let before = at(motion);
        if before[i] >= 0.0 {
            break;
        }
        let fall = (height + tilt * ends[i]) / -before[i];
        let fall = if list.is_empty() { 0.0 } else { fall };
        (height, tilt, time) = (height + motion[0] * fall, tilt + motion[1] * fall, time + fall);
        let impulse = -(1.0 + e) * before[i] / (1.0 + ends[i] * ends[i] / (rho * rho));
        motion = [motion[0] + impulse, motion[1] + impulse * ends[i] / (rho * rho)];
        let after = at(motion);
        let (number, end) = (list.len() as u64 + 1, if i == 0 { End::A } else { End::B });
        let delta_v = [0, 1].map(|end| after[end] - before[end]);
        list.push(Impact { number, end, time, approach: before[i], delta_v });
    }
    list
}

fn any_bar() -> impl Strategy<Value = ([f64; 2], f64, f64)> {
    (0.2..3.0_f64, 0.2..3.0_f64, 0.05..2.0_f64, 0.02..1.0_f64).prop_map(|(a, b, rho, e)| ([a, b], rho, e))
}

proptest! {
    #[test]
    fn impacts_are_those_of_the_matrices((arms, rho, e) in any_bar(), vb in -2.0..1.0_f64, gap in 0.1..3.0_f64) {
        let bar = Bar::from_arms(arms, rho, e).unwrap();
        let start = Start::new([-1.0, vb], gap).unwrap();
        let want = plain(arms, rho, e, &start, 12);
        // A velocity that nearly cancels may have either sign.
        let doubtful = want.iter().any(|impact| impact.approach.abs() < 1e-10);
        let got: Vec<_> = bar.train(&start).take(12).collect();
        prop_assert!(doubtful || got.len() == want.len(), "{} impacts, not {}", got.len(), want.len());
        // A rounding at one strike grows until the last as a velocity of its energy can: of a bar that is hard to push
        // and easy to turn, the ends are fast.
        let growth = (1.0 + arms[0].max(arms[1]).powi(2) / (rho * rho)).sqrt();
        let speeds = |i: &Impact| i.approach.abs().max(i.delta_v[0].abs()).max(i.delta_v[1].abs());
        let fastest = want.iter().map(speeds).fold(vb.abs(), f64::max);
        // Twelve strikes of six roundings each.
        let budget = 12.0 * 6.0 * 0.5 * f64::EPSILON * growth * fastest;
        for (got, want) in got.iter().zip(&want) {
            prop_assert_eq!((got.number, got.end), (want.number, want.end));
            prop_assert!((got.approach - want.approach).abs() <= budget, "{got:?} not {want:?}");
            prop_assert!((0..2).all(|i| (got.delta_v[i] - want.delta_v[i]).abs() <= 2.0 * budget), "{got:?} not {want:?}");
            // Times divide by the velocity.
            let slack = 2.0 * budget * (1.0 + want.time) / want.approach.abs();
            prop_assert!((got.time - want.time).abs() <= slack * gap.max(1.0), "{got:?} not {want:?}");
        }
    }

    /// A drop at 2 m/s that turns, followed to its end.
    #[test]
    fn impacts_are_those_of_impulses((arms, rho, e) in any_bar(), tilt in 0.1..10.0_f64, spin in -0.2..0.3_f64) {
        let [a, b] = arms;
        let gap = (a + b) * tilt.to_radians().sin();
        let bar = Bar::from_arms(arms, rho, e).unwrap();
        let start = Start::new([-2.0 - a * spin, -2.0 + b * spin], gap).unwrap();
        let want = by_impulses(arms, rho, e, [-2.0, spin], gap, 200);
        let got: Vec<_> = bar.train(&start).take(200).collect();
        // A velocity that nearly cancels may have either sign.
        let doubtful = want.iter().any(|impact| impact.approach.abs() < 1e-10);
        prop_assert!(doubtful || got.len() == want.len(), "{} impacts, not {}", got.len(), want.len());
        for (got, want) in got.iter().zip(&want) {
            prop_assert_eq!((got.number, got.end), (want.number, want.end));
            let near = |x: f64, y: f64, scale: f64| (x - y).abs() <= 1e-11 * scale;
            prop_assert!(near(got.approach, want.approach, 20.0), "{got:?} not {want:?}");
            prop_assert!((0..2).all(|i| near(got.delta_v[i], want.delta_v[i], 40.0)), "{got:?} not {want:?}");
            prop_assert!(near(got.time, want.time, 10.0 * want.time.max(1.0) / want.approach.abs().min(1.0)), "{got:?} not {want:?}");
        }
    }

    #[test]
    fn the_summary_is_what_the_impacts_amount_to((arms, rho, e) in any_bar(), vb in -2.0..1.0_f64) {
        let bar = Bar::from_arms(arms, rho, e).unwrap();
        let start = Start::new([-1.0, vb], 1.0).unwrap();
        let summary = bar.summary(&start);
        let list: Vec<_> = bar.train(&start).take(2000).collect();
        let sum = |i: usize| list.iter().map(|impact| impact.delta_v[i]).sum::<f64>();
        let struck = |impact: &Impact| impact.delta_v[usize::from(impact.end == End::B)];
        let hardest = list.iter().map(struck).fold(0.0, f64::max);
        prop_assert!((summary.peak.end - hardest).abs() <= 1e-12 * hardest);
        if let clatter::PeakImpact::Number(n) = summary.peak.impact {
            let held = struck(&list[usize::try_from(n).unwrap() - 1]);
            prop_assert!((held - hardest).abs() <= 1e-12 * hardest, "impact {n} holds {held}");
        }
        // The center of mass at distance L_a from end a; one unit of angular velocity is v0 over half the length.
        let length = arms[0] + arms[1];
        let center = |v: [f64; 2]| (arms[1] * v[0] + arms[0] * v[1]) / length;
        let most = |f: &dyn Fn([f64; 2]) -> f64| list.iter().map(|i| f(i.delta_v).abs()).fold(0.0, f64::max);
        prop_assert!((summary.peak.center - most(&center)).abs() <= 1e-12 * hardest);
        prop_assert!((summary.peak.angular - most(&|[a, b]| 0.5 * (b - a))).abs() <= 1e-12 * hardest);
        if let (Some(net), Count::Finite(..=2000) | Count::Endless) = (summary.net, summary.count) {
            // An endless train has no shocks worth a sum left after 2000 impacts, unless it is next to elastic.
            let left = list.last().map_or(0.0, |impact| impact.approach.abs());
            if left < 1e-12 || summary.count != Count::Endless {
                prop_assert!((net.a - sum(0)).abs() <= 1e-9 * hardest, "{} {}", net.a, sum(0));
                prop_assert!((net.b - sum(1)).abs() <= 1e-9 * hardest, "{} {}", net.b, sum(1));
                prop_assert!((net.center - center([sum(0), sum(1)])).abs() <= 1e-9 * hardest);
            }
        }
    }

    #[test]
    fn exchanging_the_ends_is_a_mirror((arms, rho, e) in any_bar(), vb in -2.0..0.5_f64, s in -1.0..1.0_f64) {
        let [a, b] = arms;
        let (bar, start) = (Bar::from_arms(arms, rho, e).unwrap(), Start::new([-1.0, vb], 1.0).unwrap());
        let mirror = Bar::from_arms([b, a], rho, e).unwrap();
        for (first, second) in [(End::A, End::B), (End::B, End::A)] {
            let (here, there) = (bar.shocks(&start, first), mirror.shocks(&start, second));
            let scale = 1e-12 * (here.struck().a + here.struck().b);
            prop_assert!((here.at(s) - there.at(-s)).abs() <= scale, "{} {}", here.at(s), there.at(-s));
            prop_assert!((here.safest().s + there.safest().s).abs() <= 1e-11);
        }
        let (list, other): (Vec<_>, Vec<_>) = (bar.exchanged().train(&start).take(9).collect(), mirror.train(&start).take(9).collect());
        for (x, y) in list.iter().zip(&other) {
            prop_assert!((x.approach - y.approach).abs() <= 1e-12 * (1.0 + bar.kappa() + 1.0 / bar.kappa()), "{x:?} {y:?}");
        }
    }

    #[test]
    fn equal_arms_are_the_symmetric_bar(l in 0.1..10.0_f64, rho in 0.0..12.0_f64, e in 0.0..=1.0_f64, vb in -2.0..1.0_f64, x in 0.1..4.0_f64) {
        let (bar, start) = (Bar::from_gyration_radius(l, rho, e).unwrap(), Start::new([-1.0, vb], 1.0).unwrap());
        prop_assert_eq!(bar, Bar::from_arms([l, l], rho, e).unwrap());
        // Eq. 5; and the bar with hardly another center of mass, which takes another way through all of it.
        let (zone, peak) = (bar.shocks_either(&start).safe_zone(x), bar.peak(&start).end);
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs().max(1.0);
        prop_assert!(near(zone.s, (2.0 * x / peak + bar.q() - 1.0) / (1.0 + bar.q())), "{zone:?}");
        let beside = Bar::from_center_of_mass(1e-17, rho / l, e).unwrap();
        prop_assert!(!beside.is_symmetric() && near(beside.peak(&start).end, peak), "{beside:?}");
        prop_assert!(near(beside.shocks_either(&start).safe_zone(x).s, zone.s), "{beside:?}");
        let edges = |bar: &Bar, first| bar.shocks(&start, first).safe_interval(x);
        for first in [End::A, End::B] {
            if let (Some(a), Some(b)) = (edges(&bar, first), edges(&beside, first)) {
                prop_assert!(near(a[0], b[0]) && near(a[1], b[1]), "{a:?} {b:?}");
            }
        }
    }

    /// The comparison is with every impact, at any position and on a grid.
    #[test]
    fn shocks_zones_and_the_safest_place_are_those_of_the_impacts((arms, rho, e) in any_bar(), vb in -2.0..0.5_f64, s in -1.0..1.0_f64, threshold in 0.1..4.0_f64) {
        let bar = Bar::from_arms(arms, rho, e).unwrap();
        let start = Start::new([-1.0, vb], 1.0).unwrap();
        let list = |bar: &Bar| bar.train(&start).take(300).collect::<Vec<_>>();
        let (forth, back) = (list(&bar), list(&bar.exchanged()));
        let worst = |list: &[Impact], s: f64| list.iter().map(|i| i.delta_v_at(s).abs()).fold(0.0, f64::max);
        let cases = [
            (bar.shocks(&start, End::A), Box::new(|s: f64| worst(&forth, s)) as Box<dyn Fn(f64) -> f64>),
            (bar.shocks(&start, End::B), Box::new(|s: f64| worst(&back, -s))),
            (bar.shocks_either(&start), Box::new(|s: f64| worst(&forth, s).max(worst(&back, -s)))),
        ];
        for (shocks, worst) in cases {
            let budget = 1e-12 * (shocks.struck().a + shocks.struck().b);
            prop_assert!((shocks.at(s) - worst(s)).abs() <= budget, "{} not {}", shocks.at(s), worst(s));
            let safest = shocks.safest();
            prop_assert!((safest.shock - worst(safest.s)).abs() <= budget);
            for k in 0..=200 {
                let there = worst(-1.0 + 0.01 * f64::from(k));
                prop_assert!(there >= safest.shock - budget, "{} is safer", -1.0 + 0.01 * f64::from(k));
            }
            let zone = shocks.safe_zone(threshold);
            match shocks.safe_interval(threshold) {
                Some([lo, hi]) => {
                    prop_assert!(worst(lo).max(worst(hi)) <= threshold + budget);
                    for beyond in [lo - 1e-9, hi + 1e-9] {
                        prop_assert!(beyond.abs() > 1.0 || worst(beyond) > threshold - budget, "{beyond} sees no more");
                    }
                    prop_assert_eq!(zone.extent == Extent::Whole, lo <= -1.0 && hi >= 1.0);
                    prop_assert!(zone.s >= 0.5 * (hi - lo));
                }
                None => prop_assert!(zone.extent == Extent::None && worst(s) > threshold - budget),
            }
        }
    }
}

#[test]
fn the_safest_place_moves_with_the_mass() {
    let start = Start::default();
    // α = A/I_a and β = B/I_b by hand: e = 0 and q = 0 (ρ² = L_a L_b) give one strike at each end, of v0 each.
    let bar = Bar::from_arms([4.0, 1.0], 2.0, 0.0).unwrap();
    let shocks = bar.shocks_either(&start);
    assert_eq!((shocks.struck().a, shocks.struck().b), (1.0, 1.0));
    let (alpha, beta) = (1.0 / 20.0, 1.0 / 5.0);
    let x = 4.0 * (alpha - beta) / (alpha * 4.0 + beta * 1.0); // −1.5, from a center of mass 1.5 off the middle
    assert!((shocks.safest().s - (1.5 + x) / 2.5).abs() < 1e-15, "{:?}: the middle after all", shocks.safest());
    assert!((shocks.safest().shock - alpha * beta * 4.0 * 5.0 / 0.4).abs() < 1e-15);
    // Elsewhere it is neither the middle nor the center of mass.
    let bar = Bar::from_center_of_mass(0.4, 0.5, 0.3).unwrap();
    let safest = bar.shocks_either(&start).safest();
    assert!(safest.s > 0.25 && safest.s < 0.35, "{safest:?}");
    // Where end b never strikes, the center of percussion gets no shock at all.
    let spun = Start::new([-1.0, 2.5], 1.0).unwrap();
    let shocks = bar.shocks(&spun, End::A);
    assert_eq!(bar.count(&spun), Count::Finite(1));
    assert!(shocks.struck().b <= 0.0, "end b never strikes");
    assert!(shocks.safest().shock < 1e-15);
    // Mass far beyond the ends pushes the crossing off the bar: then an end is safest.
    let flail = Bar::from_center_of_mass(-0.5, 2.0, 0.3).unwrap();
    assert!(flail.shocks(&start, End::A).safest().s.abs() >= 1.0, "the end itself");
}

#[test]
fn no_digit_is_lost_where_the_ends_weigh_almost_nothing() {
    for rho in [1e-3, 1e-5, 1e-7, 1e-9] {
        let bar = Bar::from_arms([1.3, 0.7], rho, 1.0).unwrap();
        // Elastic: q = cos θ with tan(θ/2) = k = ρ ℓ/(√(I_a I_b) + P) = ρ/(L_a L_b) (1 + O(ρ²)), and the last strike is
        // the first at or beyond (π − φ)/θ. With κ = 13/7 φ = atan2(sin θ, cos θ + κ) is θ/(1 + κ) but for O(θ³).
        let theta = 2.0 * rho / 0.91;
        let count = std::f64::consts::PI / theta - 7.0 / 20.0;
        let Count::Finite(n) = bar.count(&Start::default()) else { panic!("{:?}", bar.count(&Start::default())) };
        #[expect(clippy::cast_precision_loss, reason = "far below 2^53")]
        let n = n as f64;
        // Rounding up, and ρ² of the count left out.
        assert!((n - count - 0.5).abs() <= 0.51 + 2.0 * rho * rho * count, "{n} for {count} at {rho:e}");
    }
    // Where q is next to −1 the other way to form it holds.
    let bar = Bar::from_arms([1.3, 0.7], 1e5, 0.5).unwrap();
    let want = (1.69_f64 / 1e10 + 1.0).sqrt() / (0.49_f64 / 1e10 + 1.0).sqrt();
    assert!((bar.kappa() - want).abs() < 4.0 * f64::EPSILON);
    // 1 + q = P/√(I_a I_b) + 1 = ρ²ℓ²/(I_a I_b)/(1 − q) ≈ 2/ρ²; the gyration ratio of the symmetric bar is
    // √((1−q)/(1+q)) ≈ ρ.
    assert!((1.0 + bar.q() - 2e-10).abs() < 2.0 * f64::EPSILON, "{}", bar.q());
}

#[test]
fn any_masses_between_the_ends_make_a_bar() {
    let board = Mass::Slab { mass_kg: 0.1, from_m: -0.07, to_m: 0.07 };
    let battery = |position_m: f64| Mass::Point { mass_kg: 0.05, position_m };
    let bar = Bar::from_masses(0.14, &[board, battery(0.035)], 0.3).unwrap();
    // Steiner gives, in half-lengths: c = 1/6, ρ² = (2/3)(1/3 + c²) + (1/3)(1/2 − c)².
    let rho2: f64 = 2.0 / 3.0 * (1.0 / 3.0 + 1.0 / 36.0) + 1.0 / 27.0;
    assert!((bar.center_of_mass() - 1.0 / 6.0).abs() < 1e-15);
    assert!((bar.gyration_ratio() - rho2.sqrt()).abs() < 1e-14);
    let middle = Bar::from_masses(0.14, &[board, battery(0.0)], 0.3).unwrap();
    // ρ² = (2/3)(1/3), q = 7/11.
    assert!(middle.is_symmetric() && (middle.q() - 7.0 / 11.0).abs() < 1e-15, "{middle:?}");
    // A single point off the middle: massless ends, and no digits of a spread that is none.
    let point = Bar::from_masses(2.0, &[battery(0.3), battery(0.3), battery(0.3)], 0.3).unwrap();
    assert_eq!((point.q(), point.gyration_ratio()), (1.0, 0.0));
    for (masses, value) in [(vec![battery(0.07)], 1.0), (vec![battery(-0.2)], -0.2 / 0.07)] {
        let error = Bar::from_masses(0.14, &masses, 0.3).unwrap_err();
        assert_eq!(error, Error::Quantity { name: "center of mass", value, allowed: "in (-1, 1), between the ends" });
    }
    assert_eq!(Bar::from_masses(0.14, &[], 0.3), Err(Error::NoMass));
}

#[test]
fn extremes_stay_numbers_and_nonsense_is_refused() {
    for [a, b] in [[1e-6, 1.0], [1.0, 1e-6], [1e25, 1e20]] {
        let half = 0.5 * (a + b);
        for rho in [0.0, 1e-11 * half, half, 0.9e6 * half].map(|rho: f64| rho.min(1e25)) {
            for (e, velocity, gap) in
                [(0.0, [-1.0, -1.0], 0.0), (0.5, [-1e150, 1e150], 1e150), (1.0, [-1e-150, -1e150], 1e-150)]
            {
                let (bar, start) = (Bar::from_arms([a, b], rho, e).unwrap(), Start::new(velocity, gap).unwrap());
                let summary = bar.summary(&start);
                assert!(
                    !summary.duration.is_nan() && !summary.peak.end.is_nan() && !summary.peak.center.is_nan(),
                    "{bar:?} {summary:?}"
                );
                assert!(!summary.peak.angular.is_nan(), "{bar:?} {summary:?}");
                for first in [End::A, End::B] {
                    let safest = bar.shocks(&start, first).safest();
                    assert!((-1.0..=1.0).contains(&safest.s) && !safest.shock.is_nan(), "{bar:?} {safest:?}");
                }
                assert!(bar.train(&start).take(20).all(|i| i.approach <= 0.0 && !i.time.is_nan()), "{bar:?}");
            }
        }
    }
    for (arms, rho, e) in [
        ([0.0, 1.0], 0.5, 0.5),
        ([1.0, -1.0], 0.5, 0.5),
        ([f64::NAN, 1.0], 0.5, 0.5),
        ([1.0, f64::INFINITY], 0.5, 0.5),
        ([1.0, 1.1e-6], -0.5, 0.5),
        ([1.0, 1e-7], 0.5, 0.5),
        ([1.0, 2.0], f64::NAN, 0.5),
        ([1.0, 2.0], 1e-13, 0.5),
        ([1.0, 2.0], 2e6, 0.5),
        ([1.0, 2.0], 1.0, 1.1),
        ([1.0, 2.0], 1.0, f64::NAN),
    ] {
        assert!(Bar::from_arms(arms, rho, e).is_err(), "{arms:?} {rho} {e}");
    }
}
