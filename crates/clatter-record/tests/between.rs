//! Band-limited records: what is between the samples, against histories that are known everywhere.
#![expect(clippy::cast_precision_loss, reason = "counts of samples")]

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use clatter_record::{BAND, Between, Options, Record};
use clatter_shock::{DampingRatio, Frequencies, Quantity, Spectrum, SpectrumFilter};

/// Points a sample of the reference: lines between them lose (π BAND/64)²/3 = 1.3e-4 at most.
const FINE: usize = 64;
/// The share that is stated.
const STATED: f64 = 1e-3;

const QUANTITIES: [Quantity; 4] = [
    Quantity::AbsoluteAcceleration,
    Quantity::RelativeDisplacement,
    Quantity::RelativeVelocity,
    Quantity::PseudoVelocity,
];

/// A record of samples a second apart.
fn record(values: impl Iterator<Item = f64>) -> Record {
    let mut csv = "t [s],a [m/s2]\n".to_owned();
    for (i, value) in values.enumerate() {
        writeln!(csv, "{i},{value:?}").expect("a string");
    }
    Record::read(csv.as_bytes(), &Options::default(), |_| ()).expect("a record")
}

fn of(
    record: &Record,
    frequencies: &Frequencies,
    damping: DampingRatio,
    quantity: Quantity,
    between: Between,
) -> Spectrum {
    record.channels()[0].spectrum(frequencies, damping, quantity, between, |_| ()).expect("a spectrum")
}

/// The largest error of a spectrum, over all quantities, damping ratios and natural frequencies up to `highest` of the sampling
/// rate, where `fine` is the history at [`FINE`] points a sample.
fn largest_error(fine: &[f64], highest: f64, between: Between) -> f64 {
    let record = record(fine.iter().step_by(FINE).copied());
    let frequencies = Frequencies::per_octave(1e-3, highest, 6.0).expect("frequencies");
    let mut largest = 0.0_f64;
    for zeta in [0.0, 0.05, 0.5, 1.5] {
        let damping = DampingRatio::new(zeta).expect("a ratio");
        for quantity in QUANTITIES {
            let mut filter =
                SpectrumFilter::new(frequencies.clone(), damping, quantity, 1.0 / FINE as f64).expect("a filter");
            filter.push(&fine[..=(record.channels()[0].values.len() - 1) * FINE]);
            let exact = filter.finish().expect("a spectrum");
            let got = of(&record, &frequencies, damping, quantity, between);
            for (got, exact) in got.maximax.iter().zip(&exact.maximax) {
                largest = largest.max((got / exact - 1.0).abs());
            }
        }
    }
    largest
}

/// A tone under a Gaussian bell, so many samples a cycle: without content beyond 0.4 of the rate but for 1e-6.
#[test]
fn tones() {
    for samples_a_cycle in [20.0, 10.0, 5.0, 4.0, 3.0, 2.7] {
        let f = 1.0 / samples_a_cycle;
        let fine: Vec<f64> = (0..600 * FINE)
            .map(|i| {
                let t = i as f64 / FINE as f64 - 300.0;
                (-(t / 60.0).powi(2)).exp() * (TAU * f * t + 0.3).sin()
            })
            .collect();
        let [band, linear] = [Between::BandLimited, Between::Linear].map(|between| largest_error(&fine, BAND, between));
        assert!(band < STATED, "{samples_a_cycle}: {band}");
        // Lines keep sinc² of a tone, and the test would see it.
        let kept = ((PI * f).sin() / (PI * f)).powi(2);
        assert!(linear > 0.8 * (1.0 - kept), "{samples_a_cycle}: {linear}");
    }
}

/// Two hundred tones of any phase up to 0.4 of the rate, under a bell.
#[test]
fn noise() {
    let mut state = 7_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..3 {
        let tones: Vec<[f64; 2]> = (0..200).map(|_| [0.385 * random(), TAU * random()]).collect();
        let fine: Vec<f64> = (0..400 * FINE)
            .map(|i| {
                let t = i as f64 / FINE as f64 - 200.0;
                (-(t / 40.0).powi(2)).exp() * tones.iter().map(|[f, phase]| (TAU * f * t + phase).sin()).sum::<f64>()
            })
            .collect();
        let error = largest_error(&fine, BAND, Between::BandLimited);
        assert!(error < STATED, "{error}");
    }
}

/// Half-sines cut at 0.7 of their height, without what they have above 0.4 of the rate.
#[test]
fn clipped_pulses() {
    const PERIOD: usize = 256;
    for duration in [3.3, 6.0, 11.7, 25.0] {
        let pulse = |t: f64| if (0.0..duration).contains(&t) { (PI * t / duration).sin().min(0.7) } else { 0.0 };
        // The Fourier series of a train of them, each with quiet before and after, and its sum up to the band.
        let points = PERIOD * FINE;
        let at = |i: usize| i as f64 / FINE as f64;
        let waves: Vec<[f64; 2]> = (0..PERIOD)
            .take_while(|k| *k as f64 <= BAND * PERIOD as f64)
            .map(|k| {
                let turn = TAU * k as f64 / PERIOD as f64;
                let sum =
                    |wave: fn(f64) -> f64| (0..points).map(|i| pulse(at(i) - 100.0) * wave(turn * at(i))).sum::<f64>();
                let norm = if k == 0 { 1.0 } else { 2.0 } / points as f64;
                [norm * sum(f64::cos), norm * sum(f64::sin)]
            })
            .collect();
        let fine: Vec<f64> = (0..points)
            .map(|i| {
                let sum = |(k, [c, s]): (usize, &[f64; 2])| {
                    let angle = TAU * k as f64 / PERIOD as f64 * at(i);
                    c * angle.cos() + s * angle.sin()
                };
                waves.iter().enumerate().map(sum).sum()
            })
            .collect();
        let error = largest_error(&fine, BAND, Between::BandLimited);
        assert!(error < STATED, "{duration}: {error}");
    }
}

/// Times of peaks are those of the record, whenever its clock begins, evenly sampled or not.
#[test]
fn peaks_are_at_the_times_of_the_record() {
    let frequencies = Frequencies::per_octave(0.01, 0.2, 2.0).expect("frequencies");
    let damping = DampingRatio::new(0.05).expect("a ratio");
    // A pulse about the twentieth sample; one of the last samples, where nothing is any more, may come late.
    for (last, between) in [(40.0, Between::BandLimited), (40.0, Between::Linear), (40.5, Between::Linear)] {
        let times = |start: f64| {
            let mut csv = "t [s],a [m/s2]\n".to_owned();
            for i in 0..=40_i32 {
                let time = start + if i == 40 { last } else { f64::from(i) };
                writeln!(csv, "{time:?},{:?}", (-(f64::from(i - 20) / 3.0).powi(2)).exp()).expect("a string");
            }
            let record = Record::read(csv.as_bytes(), &Options::default(), |_| ()).expect("a record");
            assert_eq!(record.channels()[0].times().step_s().is_some(), last < 40.25, "{last}");
            of(&record, &frequencies, damping, Quantity::AbsoluteAcceleration, between).time_of_peak_s
        };
        let (own, later) = (times(0.0), times(500.0));
        assert!(own.iter().all(|time| *time > 15.0), "{own:?}");
        for (own, later) in own.iter().zip(later) {
            assert!((later - own - 500.0).abs() < 1e-6, "{own} and {later}");
        }
    }
}
