//! Wall times of the responses, each beside a plain way to the same answer in the same run:
//! `cargo bench -p clatter-shock --bench spectra`.
//!
//! Ours and the plain way take turns, so that a machine that slows down slows both; the table gives the least time of
//! each and the ratio of the two.
#![expect(clippy::print_stdout, clippy::cast_precision_loss, reason = "a table of times is what is wanted")]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use clatter_shock::{
    DampingRatio, Frequencies, Pulse, Pulses, Quantity, Shape, SpectrumFilter, Suspension, UnevenFilter, VelocityShock,
    VelocityShocks,
};
use std::f64::consts::{PI, TAU};
use std::hint::black_box;
use std::time::Instant;

/// Times both in turns and prints a line; one call of each does `items`.
fn row<A, B>(
    name: &str,
    unit: &str,
    rounds: usize,
    items: f64,
    mut ours: impl FnMut() -> A,
    mut plain: impl FnMut() -> B,
) {
    let time = |f: &mut dyn FnMut()| {
        let start = Instant::now();
        f();
        start.elapsed().as_nanos() as f64 / items
    };
    let (mut a, mut b) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..rounds {
        a = a.min(time(&mut || drop(black_box(ours()))));
        b = b.min(time(&mut || drop(black_box(plain()))));
    }
    println!("{name:52} {a:12.2} {b:12.2} {:8.3}   {unit}", a / b);
}

fn damping(zeta: f64) -> DampingRatio {
    DampingRatio::new(zeta).expect("damping")
}

/// Returns 200 frequencies from 10 Hz to 10 kHz.
fn frequencies() -> Frequencies {
    Frequencies::list((0..200).map(|i| 10.0 * 1000_f64.powf(f64::from(i) / 199.0)).collect()).expect("frequencies")
}

/// Returns thirty shocks of alternating sign that fade, 1 to 3 ms apart.
fn shocks() -> VelocityShocks {
    let (mut time, mut size) = (0.0, 1.0);
    let list = (0_u32..30).map(|i| {
        time += 0.001 + 0.002 * f64::from(i * 7 % 11) / 11.0;
        size *= 0.98;
        VelocityShock { time, delta_v: size * if i % 2 == 0 { 2.0 } else { -1.0 } }
    });
    VelocityShocks::new(list.collect()).expect("shocks")
}

/// Returns eight half-sines of 0.3 ms within 100 ms: a drop.
fn drop_pulses() -> Vec<Pulse> {
    (0..8)
        .map(|i| Pulse {
            shape: Shape::HalfSine,
            amplitude: if i % 2 == 0 { 1000.0 } else { -700.0 },
            duration: 3e-4,
            start: 0.002 + 0.0113 * f64::from(i),
        })
        .collect()
}

fn sampled(pulses: &[Pulse], dt: f64) -> Vec<f64> {
    (0..1_000_000_u32)
        .map(|i| f64::from(i) * dt)
        .take_while(|&t| t < 0.1 - 0.5 * dt)
        .map(|t| {
            pulses
                .iter()
                .filter(|p| (0.0..p.duration).contains(&(t - p.start)))
                .map(|p| p.amplitude * (PI * (t - p.start) / p.duration).sin())
                .sum()
        })
        .collect()
}

/// Applies the filter as textbooks have it, one frequency at a time: samples alone, no peak between them, no ring-down.
fn plain_filter(samples: &[f64], dt: f64, hz: f64, zeta: f64) -> f64 {
    let omega = TAU * hz;
    let (beta, theta) = ((1.0 - zeta * zeta).sqrt() * omega * dt, zeta * omega * dt);
    let (e, c) = ((-theta).exp(), (-theta).exp() * beta.cos());
    let s = (-theta).exp() * beta.sin() / beta;
    let b = [1.0 - s, 2.0 * (s - c), e * e - s];
    let (mut x1, mut x2, mut y1, mut y2, mut peak) = (0.0, 0.0, 0.0, 0.0, 0.0_f64);
    for &x in samples {
        let y = b[0] * x + b[1] * x1 + b[2] * x2 + 2.0 * c * y1 - e * e * y2;
        (x2, x1, y2, y1) = (x1, x, y1, y);
        peak = peak.max(y.abs());
    }
    peak
}

fn main() {
    let quantity = Quantity::AbsoluteAcceleration;
    let frequencies = frequencies();
    println!("{:52} {:>12} {:>12} {:>8}", "", "ours", "plain", "ratio");

    // Plain: one component at a time, all its quantities and times.
    let train = shocks();
    for zeta in [0.0, 0.05, 0.3, 1.0, 5.0] {
        let items = train.as_slice().len() as f64 * frequencies.hz().len() as f64;
        let plain = || {
            for &hz in frequencies.hz() {
                black_box(train.respond(&Suspension::from_hz(hz, damping(zeta)).expect("mount")));
            }
        };
        let ours = || train.spectrum(&frequencies, damping(zeta), quantity);
        row(
            &format!("train of shocks, damping {zeta} (plain: one by one)"),
            "ns a shock and frequency",
            201,
            items,
            ours,
            plain,
        );
    }

    // Plain: the same pulses as a record of 1 MHz, its samples alone.
    let list = drop_pulses();
    let pulses = Pulses::new(&list).expect("pulses");
    let fine = sampled(&list, 1e-6);
    let each = |samples: &[f64], dt: f64| {
        frequencies.hz().iter().map(|&hz| plain_filter(samples, dt, hz, 0.05)).fold(0.0, f64::max)
    };
    let ours = || pulses.spectrum(&frequencies, damping(0.05), quantity);
    row("eight half-sines, Q = 10 (plain: sampled at 1 MHz)", "µs", 15, 1e3, ours, || each(&fine, 1e-6));

    // Plain: the recursive filter of the same record, one frequency at a time.
    for dt in [5e-5, 1e-5, 2e-6] {
        let samples = sampled(&list, dt);
        let ours = || {
            let mut filter = SpectrumFilter::new(frequencies.clone(), damping(0.05), quantity, dt).expect("filter");
            filter.push(black_box(&samples));
            filter.finish().expect("spectrum")
        };
        let name = format!("record of {} samples, Q = 10 (plain: textbook)", samples.len());
        row(&name, "µs", 41, 1e3, ours, || each(&samples, dt));
    }

    // Plain: the filter of even records, of as many samples.
    for (name, noise) in [("quiet", 1.0), ("noisy", 300.0)] {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 32) as f64 / f64::from(u32::MAX) - 0.5
        };
        let mut samples = sampled(&list, 1e-5);
        samples.resize(100_000, 0.0);
        let mut time = 0.0;
        let times: Vec<f64> = samples
            .iter_mut()
            .map(|a| {
                *a += noise * random();
                time += 1e-5 * (1.0 + 0.4 * random());
                time
            })
            .collect();
        let ours = || {
            let mut filter = UnevenFilter::new(frequencies.clone(), damping(0.05), Quantity::AbsoluteAcceleration);
            filter.push(black_box(&times), black_box(&samples)).expect("samples");
            filter.finish().expect("spectrum")
        };
        let even = || {
            let mut filter =
                SpectrumFilter::new(frequencies.clone(), damping(0.05), Quantity::AbsoluteAcceleration, 1e-5)
                    .expect("filter");
            filter.push(black_box(&samples));
            filter.finish().expect("spectrum")
        };
        row(&format!("{name} record of 100 000 uneven samples (plain: even)"), "µs", 21, 1e3, ours, even);
    }

    // Plain: a pulse of one period, a thousandth as long; two pulses, a thousandth as many.
    let unit = Suspension::new(1.0, damping(0.0)).expect("mount");
    for shape in [Shape::HalfSine, Shape::Haversine, Shape::Triangle, Shape::InitialPeakSawtooth] {
        let one = |duration| Pulses::new(&[Pulse { shape, amplitude: 1.0, duration, start: 0.0 }]).expect("pulse");
        let (long, short) = (one(1e4), one(10.0));
        let name = format!("{shape:?} of 1600 periods, undamped (plain: of 1.6)");
        row(&name, "µs", 15, 1e3, || long.respond(&unit), || short.respond(&unit));
    }
    let heap = |n: u32| -> Vec<Pulse> {
        let start = |i| 0.5 * f64::from(i) / f64::from(n);
        (0..n).map(|i| Pulse { shape: Shape::HalfSine, amplitude: 1.0, duration: 1.0, start: start(i) }).collect()
    };
    let (many, few) = (heap(20_000), heap(20));
    row("20 000 equal pulses in a heap (plain: 20)", "µs", 7, 1e3, || Pulses::new(&many), || Pulses::new(&few));
}
