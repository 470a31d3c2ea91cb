//! The filter of uneven records against the exact response piece by piece, and against an integration that shares
//! nothing with it.

use clatter_shock::accuracy::RECORD;
use clatter_shock::{DampingRatio, Error, Frequencies, Pulses, Quantity, Spectrum, UnevenFilter};
use proptest::prelude::*;
use std::f64::consts::TAU;

const QUANTITIES: [Quantity; 5] = [
    Quantity::AbsoluteAcceleration,
    Quantity::RelativeDisplacement,
    Quantity::RelativeVelocity,
    Quantity::PseudoVelocity,
    Quantity::EquivalentStaticAcceleration,
];

fn damping(zeta: f64) -> DampingRatio {
    DampingRatio::new(zeta).expect("damping")
}

fn filtered(points: &[(f64, f64)], hz: &[f64], zeta: f64, quantity: Quantity) -> Spectrum {
    let frequencies = Frequencies::list(hz.to_vec()).expect("frequencies");
    let mut filter = UnevenFilter::new(frequencies, damping(zeta), quantity);
    let (times, values): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    // Pieces of any size give the same.
    for ends in [0..points.len() / 3, points.len() / 3..points.len() / 3 + 1, points.len() / 3 + 1..points.len()] {
        filter.push(&times[ends.clone()], &values[ends]).expect("samples");
    }
    filter.finish().expect("spectrum")
}

/// Returns all values of two spectra beside one another: name, values, those wanted.
fn columns<'a>(got: &'a Spectrum, want: &'a Spectrum) -> [(&'static str, &'a [f64], &'a [f64]); 8] {
    [
        ("primary", &got.primary, &want.primary),
        ("residual", &got.residual, &want.residual),
        ("positive", &got.positive, &want.positive),
        ("negative", &got.negative, &want.negative),
        ("primary positive", &got.primary_positive, &want.primary_positive),
        ("primary negative", &got.primary_negative, &want.primary_negative),
        ("residual positive", &got.residual_positive, &want.residual_positive),
        ("residual negative", &got.residual_negative, &want.residual_negative),
    ]
}

fn compare(points: &[(f64, f64)], hz: &[f64], zeta: f64) {
    let history = Pulses::piecewise_linear(points).expect("history");
    for quantity in QUANTITIES {
        let frequencies = Frequencies::list(hz.to_vec()).expect("frequencies");
        let want = history.spectrum(&frequencies, damping(zeta), quantity);
        let got = filtered(points, hz, zeta, quantity);
        for (name, got, of) in columns(&got, &want) {
            for (i, f) in hz.iter().enumerate() {
                let scale = if name == "primary" { of[i] } else { want.maximax[i] };
                assert!(
                    (got[i] - of[i]).abs() <= RECORD.error * scale,
                    "{quantity:?}, {name} at {f:e} Hz, damping {zeta}: {:?}, not {:?}",
                    got[i],
                    of[i]
                );
            }
        }
    }
}

/// Returns a burst with steps that grow and shrink.
fn burst(n: u32) -> Vec<(f64, f64)> {
    let mut time = 0.0;
    (0..n)
        .map(|i| {
            let t = f64::from(i) / f64::from(n);
            time += 0.4 + 0.2 * f64::from(i * 7919 % 13);
            (time, (40.0 * t).sin() * (-8.0 * t).exp() * 100.0 + 3.0 * t)
        })
        .collect()
}

#[test]
fn filter_is_the_exact_response_at_every_frequency_and_damping() {
    let hz: Vec<f64> = (-36..=5).map(|i| 10_f64.powf(f64::from(i) / 4.0)).collect();
    for zeta in [0.0, 1e-3, 0.05, 0.7, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.3, 10.0, 1e4] {
        // Steps of about 1 s, so that hz is f·dt from 1e-9 to beyond 10.
        compare(&burst(300), &hz, zeta);
    }
}

/// Pieces of one sample, of a few and all at once give the very same numbers.
#[test]
fn pieces_of_any_size_give_the_same() {
    let (times, values): (Vec<f64>, Vec<f64>) = burst(2000).into_iter().unzip();
    let of = |size: usize| {
        let frequencies = Frequencies::per_octave(1e-4, 1.0, 3.0).expect("frequencies");
        let mut filter = UnevenFilter::new(frequencies, damping(0.05), Quantity::AbsoluteAcceleration);
        for (times, values) in times.chunks(size).zip(values.chunks(size)) {
            filter.push(times, values).expect("samples");
        }
        filter.finish().expect("spectrum")
    };
    let all = of(2000);
    for size in [1, 7, 513] {
        assert_eq!(of(size), all, "pieces of {size}");
    }
}

/// Neighbors in a group of eight may be as far apart as they like.
#[test]
fn frequencies_in_any_order() {
    let hz: Vec<f64> = (0..41).map(|i| 10_f64.powf(f64::from(i * 17 % 41) / 4.0 - 9.0)).collect();
    for zeta in [0.0, 0.3, 1.0, 4.0] {
        compare(&burst(150), &hz, zeta);
    }
}

/// Bursts in a long record with noise between and a long gap: whole blocks are passed by in leaps where nothing new can
/// be in them.
#[test]
fn long_records_with_quiet_stretches() {
    let mut state = 1_u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(state >> 32).expect("32 bits")) / f64::from(u32::MAX) - 0.5
    };
    for (bursts, floor) in [(1_u32, 0.0), (4, 0.1), (3, 3.0)] {
        let mut time = 1000.0;
        let mut points: Vec<(f64, f64)> = (0..2600)
            .map(|i| {
                time += 1.0 + 0.7 * noise() + if i == 1300 { 500.0 } else { 0.0 };
                (time, floor * noise())
            })
            .collect();
        for b in 0..bursts {
            for i in 0..40 {
                let size = 100.0 * (1.0 - 0.2 * f64::from(b)) * (std::f64::consts::PI * f64::from(i) / 40.0).sin();
                points[(150 + b * 610 + i) as usize].1 += if b % 2 == 0 { size } else { -size };
            }
        }
        let hz = [1e-7, 1e-5, 4e-4, 3e-3, 0.011, 0.013, 0.05, 0.11, 0.2, 0.45, 1.7];
        for zeta in [0.0, 1e-3, 0.05, 0.7, 1.0, 3.0] {
            compare(&points, &hz, zeta);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn filter_is_exact_for_any_record(
        samples in prop::collection::vec((-4.0..0.0_f64, -100.0..100.0_f64), 2..300),
        zeta in 0.0..2.0_f64,
        exponent in -5.0..2.0_f64,
    ) {
        let mut time = -3.0;
        let points: Vec<(f64, f64)> = samples
            .iter()
            .map(|&(gap, a)| {
                time += 10_f64.powf(gap);
                (time, a)
            })
            .collect();
        compare(&points, &[10_f64.powf(exponent)], zeta);
    }
}

/// z, z′ and A of a part, with the base's acceleration from straight lines between samples.
struct Integration {
    omega: f64,
    zeta: f64,
    time: f64,
    state: [f64; 2],
    /// Largest and smallest A and their times.
    most: [(f64, f64); 2],
}

impl Integration {
    fn rate(&self, [z, v]: [f64; 2], base: f64) -> [f64; 2] {
        [v, -base - 2.0 * self.zeta * self.omega * v - self.omega * self.omega * z]
    }
    /// Makes one step of Runge and Kutta's fourth order, with the base's acceleration at its begin, middle and end.
    fn step(&mut self, h: f64, base: [f64; 3]) {
        let moved = |[z, v]: [f64; 2], [a, b]: [f64; 2], h: f64| [z + h * a, v + h * b];
        let k1 = self.rate(self.state, base[0]);
        let k2 = self.rate(moved(self.state, k1, 0.5 * h), base[1]);
        let k3 = self.rate(moved(self.state, k2, 0.5 * h), base[1]);
        let k4 = self.rate(moved(self.state, k3, h), base[2]);
        let mean = |i: usize| (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0;
        self.state = moved(self.state, [mean(0), mean(1)], h);
        self.time += h;
        self.note();
    }
    fn note(&mut self) {
        let a = -(2.0 * self.zeta * self.omega * self.state[1] + self.omega * self.omega * self.state[0]);
        if a > self.most[0].0 {
            self.most[0] = (a, self.time);
        }
        if a < self.most[1].0 {
            self.most[1] = (a, self.time);
        }
    }
}

#[test]
fn values_and_times_are_those_of_an_integration() {
    let points: Vec<(f64, f64)> = burst(60).iter().map(|(t, a)| (5.0 + 1e-4 * t, *a)).collect();
    let end = points[59].0;
    for (hz, zeta) in [(20.0, 0.05), (150.0, 0.0), (700.0, 0.2), (2500.0, 0.05), (400.0, 1.5)] {
        let omega = TAU * hz;
        let mut part = Integration { omega, zeta, time: points[0].0, state: [0.0; 2], most: [(0.0, 0.0); 2] };
        for pair in points.windows(2) {
            let ((t, from), (end, to)) = (pair[0], pair[1]);
            for i in 0..2000_u32 {
                let base = [0.0, 0.5, 1.0].map(|half| from + (to - from) * (f64::from(i) + half) / 2000.0);
                part.step((end - t) / 2000.0, base);
            }
        }
        let during = part.most;
        part.most = [(0.0, 0.0); 2];
        part.note();
        for _ in 0..40_000 {
            part.step(1.0 / (hz * 20_000.0), [0.0; 3]);
        }
        let got = filtered(&points, &[hz], zeta, Quantity::AbsoluteAcceleration);
        let largest = got.maximax[0];
        // 2000 steps a sample: errors of the fourth order are far below 1e-8, and a peak between two steps is missed by
        // less than ω²h²/8.
        let (h, slack) = (4e-4 / 2000.0_f64, 1e-8);
        let allowed = (slack + omega * omega * h * h) * largest;
        for (name, got, want) in [
            ("primary, positive", got.primary_positive[0], during[0].0),
            ("primary, negative", got.primary_negative[0], -during[1].0),
            ("residual, positive", got.residual_positive[0], part.most[0].0),
            ("residual, negative", got.residual_negative[0], -part.most[1].0),
        ] {
            assert!((got - want).abs() <= allowed, "{hz} Hz, damping {zeta}, {name}: {got}, not {want}");
        }
        let all = [during[0], during[1], part.most[0], part.most[1]];
        let (_, time) =
            all.into_iter().fold((0.0, 0.0), |best, (a, t)| if a.abs() > best.0 { (a.abs(), t) } else { best });
        // Two steps of the integration.
        let off = (got.time_of_peak_s[0] - time).abs();
        assert!(
            off <= 2.0 * h.max(1.0 / (hz * 20_000.0)),
            "{hz} Hz, damping {zeta}: off by {off:e} s; the record ends at {end}"
        );
    }
}

#[test]
fn a_jump_is_two_samples_at_one_time() {
    // A rectangle from 1 to 2 s.
    let points = [(0.0, 0.0), (1.0, 0.0), (1.0, 3.0), (2.0, 3.0), (2.0, 0.0), (4.0, 0.0)];
    let got = filtered(&points, &[0.5], 0.0, Quantity::AbsoluteAcceleration);
    // Half a period doubles it, at its end.
    assert!((got.maximax[0] - 6.0).abs() < 1e-12, "{got:?}");
    assert!((got.time_of_peak_s[0] - 2.0).abs() < 1e-7, "{got:?}");
    compare(&points, &[1e-3, 0.3, 0.5, 4.0], 0.1);
}

#[test]
fn samples_that_are_none_are_refused_and_leave_nothing() {
    let mut filter = UnevenFilter::new(
        Frequencies::list(vec![1.0]).expect("frequency"),
        damping(0.05),
        Quantity::AbsoluteAcceleration,
    );
    filter.push(&[0.0, 1.0], &[0.0, 1.0]).expect("samples");
    for (times, values, message) in [
        (&[2.0, 1.5][..], &[0.0, 0.0][..], "record, entry 4: time 1.5 is before 2.0, the one above it"),
        (&[0.5], &[0.0], "record, entry 3: time 0.5 is before 1.0, the one above it"),
        (&[2.0, f64::NAN], &[0.0, 0.0], "record, entry 4: time = NaN is not finite"),
        (&[2.0], &[f64::INFINITY], "record, entry 3: acceleration = inf is not finite"),
        (&[2.0, 3.0], &[0.0], "there are 2 times and 1 values; each value needs its time"),
    ] {
        assert_eq!(filter.push(times, values).expect_err(message).to_string(), message);
    }
    let alone = filtered(&[(0.0, 0.0), (1.0, 1.0)], &[1.0], 0.05, Quantity::AbsoluteAcceleration);
    assert_eq!(filter.finish().expect("spectrum"), alone);
    let none = UnevenFilter::new(
        Frequencies::list(vec![1.0]).expect("frequency"),
        damping(0.05),
        Quantity::AbsoluteAcceleration,
    );
    assert_eq!(none.finish().expect_err("nothing came"), Error::Empty("record"));
}

/// Where the compared values overflow, there is an answer all the same.
#[test]
fn huge_samples_are_answered_like_small_ones() {
    let spectrum = |scale: f64, quantity| {
        let points = [0.0, scale, -scale, 0.0, 0.1 * scale];
        let points: Vec<(f64, f64)> = (0_u32..).map(|i| 1.1 * f64::from(i)).zip(points).collect();
        filtered(&points, &[1e-9, 1e-3], 0.1, quantity).maximax
    };
    for quantity in QUANTITIES {
        let (huge, small) = (spectrum(1e100, quantity), spectrum(1.0, quantity));
        for i in 0..2 {
            assert!((huge[i] / 1e100 / small[i] - 1.0).abs() < 1e-12, "{quantity:?}: {:e}, {:e}", huge[i], small[i]);
        }
        assert_eq!(spectrum(1e305, quantity).len(), 2);
    }
}
