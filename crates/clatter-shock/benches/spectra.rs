//! Speed of the exact responses: time for each shock and frequency, for the pulses of a drop, for a record.

use clatter_shock::{
    DampingRatio, Frequencies, Pulse, Pulses, Quantity, Shape, SpectrumFilter, VelocityShock, VelocityShocks,
};
use divan::{Bencher, black_box, counter::ItemsCount};

fn main() {
    divan::main();
}

fn q10() -> DampingRatio {
    DampingRatio::from_quality_factor(10.0).expect("Q = 10")
}

fn frequencies(n: u32) -> Frequencies {
    Frequencies::list((0..n).map(|i| 10.0 * 1000_f64.powf(f64::from(i) / f64::from(n - 1))).collect())
        .expect("frequencies")
}

/// Shocks of alternating sign that fade, 1 to 3 ms apart.
fn shocks(n: u32) -> VelocityShocks {
    let mut time = 0.0;
    let list = (0..n).map(|i| {
        time += 0.001 + 0.002 * f64::from(i * 7 % 11) / 11.0;
        VelocityShock {
            time,
            delta_v: 0.98_f64.powi(i32::try_from(i).unwrap_or(0)) * if i % 2 == 0 { 2.0 } else { -1.0 },
        }
    });
    VelocityShocks::new(list.collect()).expect("shocks")
}

/// Items are shocks × frequencies.
#[divan::bench(args = [0.0, 0.05, 0.3, 1.0, 5.0])]
fn train_of_shocks(bencher: Bencher, zeta: f64) {
    let (train, frequencies) = (shocks(30), frequencies(200));
    let damping = DampingRatio::new(zeta).expect("damping");
    bencher
        .counter(ItemsCount::new(30_usize * 200))
        .bench(|| black_box(&train).spectrum(&frequencies, damping, Quantity::AbsoluteAcceleration));
}

/// Eight half-sines of 0.3 ms within 100 ms, 200 frequencies from 10 Hz to 10 kHz, Q = 10.
#[divan::bench]
fn eight_pulses(bencher: Bencher) {
    let list: Vec<Pulse> = (0..8)
        .map(|i| Pulse {
            shape: Shape::HalfSine,
            amplitude: if i % 2 == 0 { 1000.0 } else { -700.0 },
            duration: 3e-4,
            start: 0.002 + 0.0113 * f64::from(i),
        })
        .collect();
    let (pulses, frequencies) = (Pulses::new(&list).expect("pulses"), frequencies(200));
    bencher.bench(|| black_box(&pulses).spectrum(&frequencies, q10(), Quantity::AbsoluteAcceleration));
}

/// A record of 10⁴ samples at 100 kHz, the same eight half-sines, the same frequencies.
#[divan::bench]
fn record_of_10_000_samples(bencher: Bencher) {
    let samples: Vec<f64> = (0..10_000_u32)
        .map(|i| f64::from(i) * 1e-5)
        .map(|t| {
            (0..8)
                .map(|i| (t - 0.002 - 0.0113 * f64::from(i), if i % 2 == 0 { 1000.0 } else { -700.0 }))
                .filter(|(s, _)| (0.0..3e-4).contains(s))
                .map(|(s, a)| a * (std::f64::consts::PI * s / 3e-4).sin())
                .sum()
        })
        .collect();
    let frequencies = frequencies(200);
    bencher.bench(|| {
        let mut filter =
            SpectrumFilter::new(frequencies.clone(), q10(), Quantity::AbsoluteAcceleration, 1e-5).expect("filter");
        filter.push(black_box(&samples));
        filter.finish().expect("spectrum")
    });
}
