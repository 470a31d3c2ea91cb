//! A part with stops: closed forms, energy, limits, and histories that do not reach them.

use crate::stop_steps::{Own, any_part, any_section, history};
use clatter::Section;
use clatter_shock::{
    DamageBoundary, DampingRatio, Error, HistoryBoundary, Limit, Peaked, Pulse, Pulses, Quantity, Shape, Stop,
    Suspension, VelocityShock, VelocityShocks, respond,
};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

fn part(omega: f64, zeta: f64) -> Suspension {
    Suspension::new(omega, DampingRatio::new(zeta).expect("damping")).expect("a part")
}

fn stopped(omega: f64, zeta: f64, [gap, contact, e]: [f64; 3]) -> Suspension {
    part(omega, zeta).with_stop(Stop::new(gap, contact, e).expect("a stop"))
}

/// A velocity shock of −v and then nothing for so long.
fn kick(v: f64, length: f64) -> Pulses {
    Pulses::of_sections([Section::shock(0.0, length, -v)]).expect("a shock")
}

/// The velocity shocks of sections, 0.3 apart.
fn shocks_of(list: &[Own]) -> Vec<VelocityShock> {
    let times = (0_u32..).map(|i| 0.3 * f64::from(i));
    list.iter().zip(times).map(|(own, time)| VelocityShock { time, delta_v: own.delta_v }).collect()
}

/// Without spring the law gives: d_max = v/ω₁, a largest force ω₁ v, a press of τ, a speed ev afterward, and a dent of
/// (1 − e²) v/ω₁. A spring of 1e-7 rad/s pulls for some
/// ten seconds, and changes speeds of 0.03 by some 1e-12.
#[test]
fn a_free_part_presses_and_leaves_as_the_law_says() {
    for e in [0.01, 0.1, 0.4, 0.9, 1.0] {
        let (v, gap, tau) = (3.0, 0.5, 0.02);
        let mount = stopped(1e-7, 0.0, [gap, tau, e]);
        let omega1 = FRAC_PI_2 * (1.0 + e) / tau;
        let touch = gap / v;
        let close = |got: f64, want: f64, what: &str| {
            assert!((got / want - 1.0).abs() < 1e-8, "{what} at e = {e}: {got}, not {want}");
        };
        let within = kick(v, touch + tau + 0.01).respond_within(&mount);
        close(-within.absolute_acceleration.negative.value, omega1 * v, "force");
        close(within.relative_displacement.positive.value, gap + v / omega1, "depth");
        close(within.relative_displacement.positive.time, touch + tau / (1.0 + e), "crest");
        close(-within.relative_velocity.negative.value, e * v, "speed after");
        // Half-way between parting and the other stop.
        let state = kick(v, touch + tau + 0.5 * gap / (e * v)).state_at_end(&mount);
        let dent = (1.0 - e * e) * v / omega1;
        close(state.velocity, -e * v, "velocity");
        assert!((state.displacement - (0.5 * gap + dent)).abs() < 1e-8, "{state:?} at e = {e}");
        // It reaches the other one at the gap itself.
        let hits = kick(v, touch + tau + (2.5 * gap + dent) / (e * v)).hits(&mount).expect("hits");
        close(hits[1].time, touch + tau + (2.0 * gap + dent) / (e * v), "second touch");
        close(hits[1].speed, e * v, "second speed");
        assert_eq!([hits[0].side, hits[1].side], [1, -1], "sides at e = {e}");
    }
}

/// Without loss and damping the stop is a second spring: the crest is where v² = ω² z² + ω₁² (z − gap)².
#[test]
fn a_stop_without_loss_is_a_spring_of_two_slopes() {
    for omega1 in [1e-3, 0.3, 1.0, 20.0, 1e6] {
        let (omega, v, gap) = (1.7, 2.0, 0.4);
        let mount = stopped(omega, 0.0, [gap, PI / omega1, 1.0]);
        let response = kick(v, 0.0).respond(&mount);
        let (k, k1) = (omega * omega, omega1 * omega1);
        let crest = (k1 * gap + (k1 * k1 * gap * gap + (k + k1) * (v * v - k1 * gap * gap)).sqrt()) / (k + k1);
        let force = k * crest + k1 * (crest - gap);
        let got = response.relative_displacement.positive.value;
        // The crest is a difference, in the formula here: k₁ gap² may be far above v².
        let allowed = 1e-14 * (1.0 + k1 * gap * gap / (v * v));
        assert!((got / crest - 1.0).abs() < allowed, "crest at {omega1}: {got}, not {crest}");
        let got = -response.absolute_acceleration.negative.value;
        assert!((got / force - 1.0).abs() < 4.0 * allowed.max(1e-13), "force at {omega1}: {got}, not {force}");
        // Nothing is lost: eight touches of one speed.
        let hits = kick(v, 0.0).hits(&mount).expect("hits");
        let speed = (v * v - k * gap * gap).sqrt();
        assert_eq!(hits.len(), 8, "hits at {omega1}");
        for hit in hits {
            assert!((hit.speed / speed - 1.0).abs() < 1e-12, "{hit:?} at {omega1}, not {speed}");
        }
    }
}

/// A part that a steady acceleration pushes onto its stop bounces there from dent to dent and comes to rest by its damping;
/// one that is pushed less keeps off it at last. Weights are those of 1 g on parts of 60 Hz with stops of 300 Hz and more.
#[test]
fn a_part_at_rest_on_its_stop_is_followed_to_its_end() {
    for (gap, contact, e, zeta) in
        [(1e-5, 1e-3, 0.3, 0.05), (1e-5, 1e-3, 1.0, 0.05), (1e-5, 1e-4, 0.0, 2.0), (2e-4, 1e-3, 0.5, 0.01)]
    {
        let mount = stopped(2.0 * PI * 60.0, zeta, [gap, contact, e]);
        let fall = Pulses::of_sections([Section::shock(0.0, 0.0, 1.0)]).expect("a shock").carried(9.81).expect("1 g");
        let hits = fall.hits(&mount).expect("hits");
        assert!(!hits.is_empty() && hits.iter().all(|hit| hit.time.is_finite()), "{hits:?}");
        let response = fall.respond(&mount);
        // Two seconds of it, as one piece, hold no larger value.
        let piece = Section { length: 2.0, acceleration: [9.81; 2], ..Section::shock(0.0, 0.0, 1.0) };
        let long = Pulses::of_sections([piece]).expect("a piece").respond_within(&mount);
        for (a, b) in [
            (response.relative_velocity, long.relative_velocity),
            (response.absolute_acceleration, long.absolute_acceleration),
        ] {
            assert!((a.magnitude() / b.magnitude() - 1.0).abs() < 1e-12, "{a:?}, in one piece {b:?}");
        }
    }
}

#[test]
fn values_of_no_sense_are_refused() {
    for [gap, contact, e] in [
        [0.0, 1.0, 0.5],
        [-1.0, 1.0, 0.5],
        [f64::NAN, 1.0, 0.5],
        [f64::INFINITY, 1.0, 0.5],
        [1.0, 0.0, 0.5],
        [1.0, f64::NAN, 0.5],
        [1.0, f64::INFINITY, 0.5],
        [1.0, 1.0, -0.1],
        [1.0, 1.0, 1.1],
        [1.0, 1.0, f64::NAN],
    ] {
        assert!(matches!(Stop::new(gap, contact, e), Err(Error::Quantity { .. })), "{gap} {contact} {e}");
    }
    assert!(Stop::new(1.0, 1.0, 0.0).is_ok() && Stop::new(1.0, 1.0, 1.0).is_ok());
    let refused = Stop::new(1e-3, 1e-3, 1.5).expect_err("restitution").to_string();
    assert_eq!(refused, "restitution of the stop = 1.5 is not in [0, 1]");
}

/// Dead stops are those of e = 0.01.
#[test]
fn a_dead_stop_is_a_hundredth() {
    let [dead, least] = [0.0, 0.01].map(|e| kick(2.0, 1.0).respond(&stopped(3.0, 0.1, [0.1, 0.05, e])));
    assert_eq!(dead, least);
}

#[test]
fn what_scales_a_linear_response_takes_no_stop() {
    let mount = stopped(300.0, 0.05, [1e-3, 1e-3, 0.5]);
    let limit = Limit::Acceleration(500.0);
    let points = [(0.0, 1.0), (1.0, 2.0)];
    let bar = clatter::Bar::new(0.5, 0.3).expect("a bar");
    let is_stop = |error: Error| {
        assert!(matches!(error, Error::Stop(_)) && error.to_string().contains("takes no stop"), "{error}");
    };
    is_stop(mount.history(&points, Quantity::PseudoVelocity).expect_err("history"));
    is_stop(DamageBoundary::new(mount, limit, Shape::HalfSine).expect_err("boundary"));
    is_stop(HistoryBoundary::new(mount, limit, &points).expect_err("boundary of a history"));
    is_stop(respond(&bar, &clatter::Start::default(), 1.0, &mount).expect_err("train"));
    let table = clatter_shock::ShockTable { shortest: 2e-4, longest: 2e-2, acceleration: 5e4, velocity_change: 20.0 };
    is_stop(table.equivalent_half_sine(&mount, &kick(1.0, 0.0).respond(&mount), 0.1).expect_err("table"));
}

/// A part that never comes to rest touches its stops for ever: more than 4096 times, peaks are infinite and the list of
/// touches is an error. Without the long flight it has eight.
#[test]
fn it_gives_up_in_the_open() {
    let mount = stopped(1.0, 0.0, [0.1, 1e-3, 1.0]);
    let long = kick(10.0, 1e5);
    assert_eq!(long.hits(&mount), Err(Error::Hits(4096)));
    assert!(long.respond(&mount).absolute_acceleration.magnitude().is_infinite());
    let peak = long.peak_above(&mount, Peaked::PseudoVelocity, 0.0).expect("a peak");
    assert!(peak.value.is_infinite() && peak.time < 1e5, "{peak:?}");
    assert!(long.state_at_end(&mount).displacement.is_infinite());
    assert_eq!(kick(10.0, 0.0).hits(&mount).expect("few").len(), 8);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Where no stop is reached the answer is that of the part without them, to the last digit; where the answer with stops
    /// has no touch, none is reached.
    #[test]
    fn a_stop_out_of_reach_changes_no_digit(
        list in prop::collection::vec(any_section(), 1..6),
        mount in any_part(),
        decade in -11.0..-1.0_f64,
        beyond in any::<bool>(),
        carried in prop_oneof![Just(0.0), -1.0..1.0_f64],
    ) {
        let plain = Suspension::new(mount.omega(), mount.damping()).expect("a part");
        let pulses = history(&list).carried(carried).expect("finite");
        let linear = pulses.respond(&plain);
        let reach = linear.relative_displacement.magnitude();
        prop_assume!(reach > 0.0);
        // From one part in ten to one in 10¹¹.
        let times = if beyond { 1.0 + 10f64.powf(decade) } else { 1.0 - 10f64.powf(decade) };
        let stop = mount.stop().expect("a stop");
        let mount = plain.with_stop(Stop::new(times * reach, stop.contact_time(), stop.restitution()).expect("a stop"));
        let hits = pulses.hits(&mount).expect("few");
        prop_assert_eq!(hits.is_empty(), times > 1.0);
        let train = shocks_of(&list);
        let train = VelocityShocks::new(train).expect("shocks");
        let reach = train.respond(&plain).relative_displacement.magnitude();
        if times > 1.0 {
            prop_assert_eq!(pulses.respond(&mount), linear);
            prop_assert_eq!(pulses.respond_within(&mount), pulses.respond_within(&plain));
            prop_assert_eq!(pulses.state_at_end(&mount), pulses.state_at_end(&plain));
            for peaked in [Peaked::PseudoVelocity, Peaked::AccelerationOverOmega] {
                prop_assert_eq!(pulses.peak_above(&mount, peaked, 0.0), pulses.peak_above(&plain, peaked, 0.0));
                prop_assert_eq!(pulses.peak_within(&mount, peaked, 0.0), pulses.peak_within(&plain, peaked, 0.0));
            }
            prop_assert_eq!(pulses.peak_above(&mount, Peaked::StopSpeed, 0.0), None);
            if reach > 0.0 {
                let mount = plain.with_stop(Stop::new(times * reach, 0.1, 0.5).expect("a stop"));
                prop_assert_eq!(train.respond(&mount), train.respond(&plain));
                for peaked in [Peaked::PseudoVelocity, Peaked::AccelerationOverOmega, Peaked::StopSpeed] {
                    prop_assert_eq!(train.peak_above(&mount, peaked, 0.0), train.peak_above(&plain, peaked, 0.0));
                }
            }
        }
    }

    /// The ring-down is that of a long section without forcing, whose touches go on; shocks and sections agree.
    #[test]
    fn the_ring_down_is_a_long_piece_of_free_motion(
        list in prop::collection::vec(any_section(), 1..5),
        mount in any_part(),
        carried in prop_oneof![Just(0.0), -0.05..0.05_f64],
    ) {
        let ringing = history(&list).carried(carried).expect("finite");
        // Peaks of z may creep from dent to dent where the push passes the gap.
        prop_assume!(carried.abs() < 0.9 * mount.omega().powi(2) * mount.stop().expect("a stop").gap());
        let tail = Own { length: 40.0 / mount.omega(), delta_v: 0.0, acceleration: [carried; 2], sines: vec![] };
        let long = history(&[list.clone(), vec![tail]].concat());
        let [all, some] = [ringing.respond(&mount), long.respond_within(&mount)];
        for (a, b) in [
            (all.relative_displacement, some.relative_displacement),
            (all.relative_velocity, some.relative_velocity),
            (all.absolute_acceleration, some.absolute_acceleration),
        ] {
            // Damping so strong that 40 rad are no swing leaves the last of it to the ring-down.
            let slow = if mount.damping().get() > 1.0 { 0.01 } else { 1e-11 };
            prop_assert!((a.magnitude() - b.magnitude()).abs() <= slow * a.magnitude(), "{a:?}, in one piece {b:?}");
        }
        let speeds = [ringing.peak_above(&mount, Peaked::StopSpeed, 0.0), long.peak_within(&mount, Peaked::StopSpeed, 0.0)];
        let [a, b] = speeds.map(|peak| peak.map_or(0.0, |peak| peak.value));
        prop_assert!((a - b).abs() <= 1e-11 * all.relative_velocity.magnitude(), "{a}, in one piece {b}");
        let train = shocks_of(&list);
        let sections: Vec<_> = train.iter().enumerate().map(|(i, shock)| {
            let next = train.get(i + 1).map_or(shock.time, |next| next.time);
            Own { length: next - shock.time, delta_v: shock.delta_v, acceleration: [0.0; 2], sines: vec![] }
        }).collect();
        let (shocks, sections) = (VelocityShocks::new(train).expect("shocks").respond(&mount), history(&sections).respond(&mount));
        prop_assert!((shocks.absolute_acceleration.magnitude() - sections.absolute_acceleration.magnitude()).abs()
            <= 1e-9 * sections.absolute_acceleration.magnitude());
        prop_assert!(shocks.absolute_acceleration.peak().interval < list.len());
    }

    /// Without forcing no touch has more energy than one before: v²/2 + ω² z²/2 at the touch, of parts in flight and in
    /// their dents. Some roundings a touch.
    #[test]
    fn energy_never_grows(mount in any_part(), v in 0.1..3.0_f64, swings in 1.0..10.0_f64) {
        let (omega, gap) = (mount.omega(), mount.stop().expect("a stop").gap());
        let hits = kick(v, swings / omega).hits(&mount).expect("few");
        let mut before = v * v;
        for hit in hits {
            // The surface is at the gap or, in a dent, beyond.
            let energy = hit.speed * hit.speed + omega * omega * gap * gap;
            prop_assert!(energy <= before * (1.0 + 1e-12), "{hit:?}: {energy} after {before}");
            before = energy;
        }
    }

}

proptest! {
    // Motions that are given up take up to a second.
    #![proptest_config(ProptestConfig { cases: 20, failure_persistence: None, ..ProptestConfig::default() })]

    /// Magnitudes of all kinds end, without a panic, in values that are no NaN.
    #[test]
    fn extremes_of_magnitude_end(
        [omega, gap, contact, size, length] in [-250.0..250.0_f64, -250.0..250.0_f64, -300.0..250.0_f64, -250.0..250.0_f64, -12.0..12.0_f64],
        zeta in prop_oneof![Just(0.0), Just(1.0), (-60.0..60.0_f64).prop_map(|x| 10f64.powf(x))],
        e in prop_oneof![Just(0.0), Just(1.0), 0.0..1.0_f64],
        near in any::<bool>(),
        carried in any::<bool>(),
    ) {
        let omega = 10f64.powf(omega);
        // Half of the cases near one another: there the stops are reached.
        let [gap, contact, size] = [gap, contact, size].map(|x| 10f64.powf(if near { x / 60.0 } else { x }));
        let omega = if near { omega.powf(1.0 / 60.0) } else { omega };
        let length = 10f64.powf(length) / omega;
        prop_assume!(length > 1e-300 && length < 1e300);
        let mount = stopped(omega, zeta, [gap, contact, e]);
        let pulse = Pulse { shape: Shape::HalfSine, amplitude: size, duration: length, start: 0.0 };
        let later = Pulse { shape: Shape::TerminalPeakSawtooth, amplitude: -size, duration: length, start: 2.0 * length };
        for pulses in [
            Pulses::new(&[pulse]).expect("a pulse"),
            Pulses::new(&[pulse, later]).expect("pulses"),
            Pulses::of_sections([Section::shock(0.0, length, size), Section::shock(0.0, length, -2.0 * size)]).expect("shocks"),
        ] {
            let pulses = if carried { pulses.carried(size).expect("finite") } else { pulses };
            let response = pulses.respond(&mount);
            if near && zeta < 1e6 {
                prop_assert!(!response.absolute_acceleration.magnitude().is_nan());
                prop_assert!(!response.relative_displacement.magnitude().is_nan());
            }
        }
    }
}
