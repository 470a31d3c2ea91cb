//! The omitted rest of endless trains near q = 1, against trains carried on until their gaps are below 10⁻²⁵⁰.

use clatter::{Bar, Start};
use clatter_shock::{DampingRatio, Suspension, VelocityShock, VelocityShocks, respond, shocks_at};

fn mount(omega: f64, zeta: f64) -> Suspension {
    Suspension::new(omega, DampingRatio::new(zeta).expect("damping")).expect("mount")
}

/// At q = 1 each impact turns the bar about its center. Once a million of them were followed there, and what was left
/// out was infinite.
#[test]
fn nothing_is_left_out_where_nothing_is_felt() {
    for e in [0.0, 0.3, 0.9, 1.0] {
        let bar = Bar::new(1.0, e).expect("bar");
        for (omega, zeta) in [(1e-6, 0.0), (1.0, 0.05), (1e9, 3.0)] {
            let got = respond(&bar, &Start::default(), 0.0, &mount(omega, zeta)).expect("response");
            assert!(got.omitted <= 0.0, "e {e}, omega {omega}");
            assert!(got.response.pseudo_velocity().magnitude() <= 0.0, "e {e}, omega {omega}");
            assert!(got.response.absolute_acceleration.magnitude() <= 0.0, "e {e}, omega {omega}");
            assert_eq!(got.shocks.as_slice().len(), 1, "e {e}: no train is followed");
        }
    }
}

/// Returns the shocks that a position gets, and the gaps after them, in units of the start: approach speeds from uₙ₊₁ =
/// q(1 + e)uₙ − e uₙ₋₁, heights of the free end from hₙ₊₁ = e uₙ hₙ/uₙ₊₁.
fn train(q: f64, e: f64, position: f64, impacts: usize) -> Vec<(f64, f64)> {
    let turn = q * (1.0 + e);
    let (mut u, mut next, mut height, mut list) = (1.0, turn + 1.0, 1.0, Vec::new());
    for n in 0..impacts {
        let toward = if n % 2 == 0 { -position } else { position };
        list.push((0.5 * (1.0 + e) * u * ((1.0 - q) + (1.0 + q) * toward), height / next));
        height *= e * u / next;
        (u, next) = (next, turn * next - e * u);
    }
    list
}

#[test]
fn what_is_left_out_stays_within_its_bound() {
    let mut sharpest = 0.0_f64;
    for (q, e) in
        [(0.95, 0.2), (1.0 - 1e-3, 0.3), (1.0 - 1e-6, 0.5), (1.0 - 1e-9, 0.1), (1.0 - 1e-12, 0.7), (1.0 - 1e-15, 0.4)]
    {
        let bar = Bar::new(q, e).expect("bar");
        for position in [-1.0, -0.5, 0.0, 0.3, 1.0] {
            let whole = train(q, e, position, 2000);
            for omega in [0.1, 1.0, 1e3, 1e9, 1e12, 1e14] {
                for zeta in [0.0, 0.05, 0.7, 2.0] {
                    let mount = mount(omega, zeta);
                    let got = respond(&bar, &Start::default(), position, &mount).expect("response");
                    let followed = got.shocks.as_slice();
                    let n = followed.len() - 1;
                    // From the last shock of the train on, the sum stands for all later shocks; times count from there,
                    // where they have digits.
                    let (last, rest) = (followed[n - 1].time, &whole[n - 1..]);
                    let mut list: Vec<VelocityShock> =
                        followed[..n].iter().map(|s| VelocityShock { time: s.time - last, ..*s }).collect();
                    let mut time = 0.0;
                    for pair in rest.windows(2) {
                        time += pair[0].1;
                        list.push(VelocityShock { time, delta_v: pair[1].0 });
                    }
                    // The bar is at rest in the end: the later shocks, v0 in all, fall on one instant.
                    let net: f64 = list.iter().map(|s| s.delta_v).sum();
                    list.push(VelocityShock { time, delta_v: 1.0 - net });
                    let sum: f64 = list.iter().map(|s| s.delta_v.abs()).sum();
                    let want = VelocityShocks::new(list).expect("shocks").respond(&mount);
                    let name = format!("q 1 - {:e}, e {e} at {position}, omega {omega:e}, damping {zeta}", 1.0 - q);
                    for (got_peak, want, share) in [
                        (got.response.pseudo_velocity(), want.pseudo_velocity(), 1.0),
                        (got.response.acceleration_over_omega(), want.acceleration_over_omega(), (2.0 * zeta).max(1.0)),
                    ] {
                        let off = (got_peak.magnitude() - want.magnitude()).abs() / share;
                        // The stated rounding, 8 ε n of their sum, of the first hundred: the others come at one
                        // instant.
                        let rounding = 8.0 * f64::EPSILON * sum.min(100.0) * 100.0;
                        assert!(off <= got.omitted + rounding, "{name}: off by {off:e}, not {:e}", got.omitted);
                        if got.omitted > 1e3 * rounding {
                            sharpest = sharpest.max(off / got.omitted);
                        }
                    }
                }
            }
        }
    }
    assert!(sharpest > 0.01, "a bound that is {sharpest:e} of itself bounds nothing");
}

/// An endless train near q = 1 ends in one instant, by ever smaller strikes: what they do together is no shock. The largest at the
/// center of this bar is that of the second strike, ((1 − q)/2)(1 + e)(1 + T) v0, T = q (1 + e).
#[test]
fn what_ends_an_endless_train_is_no_shock() {
    let (q, e) = (0.95, 0.05);
    let bar = Bar::new(q, e).unwrap();
    let (shocks, _) = shocks_at(&bar, &Start::default(), 0.0, 1.0).unwrap();
    let second = 0.5 * (1.0 - q) * (1.0 + e) * (1.0 + q * (1.0 + e));
    assert!((shocks.largest() / second - 1.0).abs() < 1e-12, "{}, not {second}", shocks.largest());
    assert_eq!(shocks.single().len() + 1, shocks.as_slice().len());
    // All together stop the center.
    assert!((shocks.net() - 1.0).abs() < 1e-9, "{}", shocks.net());
}

/// The bar is so elastic that a million impacts do not end its train. At the center all shocks have one sign and bring
/// it to rest, v0 in all: the omitted part is the difference to the sum of the followed ones.
#[test]
fn what_a_million_impacts_leave_out_is_what_the_center_still_lacks() {
    let bar = Bar::new(1.0 - 1e-12, 1.0 - 1e-5).unwrap();
    let (shocks, omitted) = shocks_at(&bar, &Start::default(), 0.0, 1.0).unwrap();
    let missing = 1.0 - shocks.net();
    assert!(missing > 0.5, "{missing}");
    // By then they shrink by one factor; q is known to 1e-4 of 1 - q.
    assert!((omitted / missing - 1.0).abs() < 3e-3, "{omitted}, {missing}");
}
