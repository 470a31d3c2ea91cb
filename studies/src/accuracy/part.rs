//! The suspended part at its extremes, compared with the exponential of its own equation of motion in 512 bits.
//!
//! ```text
//! x = ωz, y = z′, τ = ωt:   x′ = y,  y′ = −x − 2ζ y − a/ω
//! ```
//!
//! A pulse or the line between two samples joins the state, so that every case is one matrix exponential: no roots of
//! the characteristic equation, hence nothing that is special at ζ = 1 or at resonance.

use clatter_shock::accuracy::{FREE, PULSE, RECORD, TRAIN};
use clatter_shock::{
    DampingRatio, Frequencies, Pulse, Pulses, Quantity, Shape, SpectrumFilter, State, Suspension, respond,
};
use libm::{cos, exp, sin, sqrt};
use std::f64::consts::{PI, TAU};

use super::big::{Big, exponential, image, off};
use crate::Error;

/// One number at an extreme: the allowed error, that of this library, and that of a plain formula.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    pub(super) allowed: f64,
    pub(super) ours: f64,
    pub(super) plain: Option<f64>,
}

/// A damping ratio and its cells; none where the motion is below the range of floats.
#[derive(Debug, Clone)]
pub(super) struct Line {
    pub(super) zeta: &'static str,
    pub(super) cells: Vec<Option<Cell>>,
}

/// Damping ratios with their names.
pub(super) const ZETAS: [(&str, f64); 6] = [
    ("0", 0.0),
    ("0.05", 0.05),
    ("1 − 2⁻⁵³", 1.0 - f64::EPSILON / 2.0),
    ("1", 1.0),
    ("1 + 2⁻⁵²", 1.0 + f64::EPSILON),
    ("50", 50.0),
];
/// ω and t of free motion, and the approximate product; the product of the late ones is no float.
pub(super) const FREE_AT: [(&str, f64, f64); 6] = [
    ("10⁻¹²", 1.1e-6, 0.9e-6),
    ("10⁻⁴", 1.1e-2, 0.9e-2),
    ("1", 1.1, 0.9),
    ("10²", 110.0, 0.9),
    ("10⁶", 1e3 + 0.1, 1e3 - 0.3),
    ("10¹²", 1e6 + 0.1, 1e6 - 0.3),
];
/// ω of a half-sine of length 1.
pub(super) const PULSE_AT: [(&str, f64); 6] = [
    ("10⁻⁹", 1e-9),
    ("10⁻³", 1e-3),
    ("π(1 − 10⁻⁹)", PI * (1.0 - 1e-9)),
    ("π", PI),
    ("π(1 + 10⁻⁶)", PI * (1.0 + 1e-6)),
    ("200", 200.0),
];
/// f/fs of a record.
pub(super) const RECORD_AT: [(&str, f64); 5] =
    [("10⁻⁹", 1e-9), ("10⁻⁷", 1e-7), ("10⁻⁵", 1e-5), ("10⁻⁴", 1e-4), ("10⁻³", 1e-3)];
/// Damping ratios of records.
pub(super) const RECORD_ZETAS: [(&str, f64); 3] = [("0", 0.0), ("0.05", 0.05), ("1", 1.0)];

/// ωz, z′ at the start of free motion, z being the first over ω.
pub(super) const START: State = State { displacement: 0.3, velocity: -1.7 };

pub(super) fn mount(omega: f64, zeta: f64) -> Result<Suspension, Error> {
    Ok(Suspension::new(omega, DampingRatio::new(zeta)?)?)
}

/// Returns (x, y) after free motion, exactly, and the decay of the slower mode.
pub(super) fn free_exact(zeta: f64, omega: f64, t: f64) -> ([Big; 2], Big) {
    let (z, tau) = (Big::from(zeta), &Big::from(omega) * &Big::from(t));
    let motion = exponential(&[[Big::zero(), tau.clone()], [-&tau, -&(&z.scale(1) * &tau)]]);
    let start = [&Big::from(omega) * &Big::from(START.displacement), Big::from(START.velocity)];
    let one = Big::from(1.0);
    let slow = if zeta <= 1.0 { z } else { &one / &(&z + &(&(&z * &z) - &one).sqrt()) };
    let [[decay]] = exponential(&[[-&(&slow * &tau)]]);
    (image(&motion, &start), decay)
}

/// Returns the free motion from (x, y) over τ by the textbook's three formulas: sine and cosine, the double root, two
/// exponentials.
fn textbook(zeta: f64, [x, y]: [f64; 2], tau: f64) -> [f64; 2] {
    if zeta > 1.0 {
        let root = sqrt(zeta * zeta - 1.0);
        let [r, s] = [-zeta + root, -zeta - root];
        let [a, b] = [(y - s * x) / (r - s), (r * x - y) / (r - s)];
        return [a * exp(r * tau) + b * exp(s * tau), a * r * exp(r * tau) + b * s * exp(s * tau)];
    }
    let decay = exp(-zeta * tau);
    if zeta < 1.0 {
        let beta = sqrt(1.0 - zeta * zeta);
        let (c, s) = (cos(beta * tau), sin(beta * tau) / beta);
        return [decay * (x * c + (y + zeta * x) * s), decay * (y * c - (x + zeta * y) * s)];
    }
    [decay * (x + (y + x) * tau), decay * (y - (y + x) * tau)]
}

/// Returns ωz and z′ after free motion by the textbook.
pub(super) fn free_plain(zeta: f64, omega: f64, t: f64) -> [f64; 2] {
    textbook(zeta, [omega * START.displacement, START.velocity], omega * t)
}

fn free(zeta: f64, omega: f64, t: f64) -> Result<Option<Cell>, Error> {
    let ([x, y], decay) = free_exact(zeta, omega, t);
    if decay.to_f64() < 1e-290 {
        return Ok(None);
    }
    let tau = omega * t;
    let growth = if (zeta - 1.0).abs() < 0.2 { 1.0 + tau } else { 1.0 };
    let size = (omega * START.displacement).abs() + START.velocity.abs();
    let scale = &Big::from(size * growth) * &decay;
    let of = |[got_x, got_y]: [f64; 2]| off(got_x, &x, &scale).max(off(got_y, &y, &scale));
    let after = mount(omega, zeta)?.free(START, t);
    let exponent = if zeta > 1.0 { tau / zeta } else { 0.0 };
    Ok(Some(Cell {
        allowed: FREE.error + exponent * f64::EPSILON,
        ours: of([omega * after.displacement, after.velocity]),
        plain: Some(of(free_plain(zeta, omega, t))),
    }))
}

/// Returns (ωz, z′) at the end of a half-sine of amplitude and length 1: the sine and its cosine join the state.
pub(super) fn pulse_exact(zeta: f64, omega: f64) -> [Big; 2] {
    let (z, w, pi) = (Big::from(zeta), Big::from(omega), Big::pi());
    let zero = Big::zero;
    let [x, y, _, _] = image(
        &exponential(&[
            [zero(), w.clone(), zero(), zero()],
            [-&w, -&(&z.scale(1) * &w), Big::from(-1.0), zero()],
            [zero(), zero(), zero(), pi.clone()],
            [zero(), zero(), -&pi, zero()],
        ]),
        &[zero(), zero(), zero(), Big::from(1.0)],
    );
    [x, y]
}

/// Returns the sum of steady and free motion, as in a textbook.
pub(super) fn pulse_plain(zeta: f64, omega: f64) -> [f64; 2] {
    // z = Im(Z e^{iπt}), Z = −1/(ω² − π² + 2iζωπ)
    let (re, im) = (omega * omega - PI * PI, 2.0 * zeta * omega * PI);
    let size = re * re + im * im;
    let (re, im) = (-re / size, im / size);
    let steady = |t: f64| {
        let (s, c) = (sin(PI * t), cos(PI * t));
        [im * c + re * s, PI * (re * c - im * s)]
    };
    let [z0, v0] = steady(0.0).map(|v| -v);
    let [x, y] = textbook(zeta, [omega * z0, v0], omega);
    let [z1, v1] = steady(1.0);
    [omega * z1 + x, v1 + y]
}

/// Returns (ωz, z′) at its end by the library.
pub(super) fn pulse_ours(zeta: f64, omega: f64) -> Result<[f64; 2], Error> {
    let half_sine = Pulse { shape: Shape::HalfSine, amplitude: 1.0, duration: 1.0, start: 0.0 };
    let state = Pulses::new(&[half_sine])?.state_at_end(&mount(omega, zeta)?);
    Ok([omega * state.displacement, state.velocity])
}

fn pulse(zeta: f64, omega: f64) -> Result<Cell, Error> {
    let [x, y] = pulse_exact(zeta, omega);
    let both = (&(&x * &x) + &(&y * &y)).sqrt();
    let of_x = if omega <= 0.01 { x.abs() } else { both.clone() };
    let of = |[got_x, got_y]: [f64; 2]| off(got_x, &x, &of_x).max(off(got_y, &y, &both));
    Ok(Cell { allowed: PULSE.error, ours: of(pulse_ours(zeta, omega)?), plain: Some(of(pulse_plain(zeta, omega))) })
}

/// Returns a record that rises from 0 to 100 along a cosine: the absolute acceleration of a soft part then rises to its
/// end.
pub(super) fn record() -> Vec<f64> {
    (0..100_u8).map(|k| 50.0 * (1.0 - cos(PI * f64::from(k) / 99.0))).collect()
}

/// Returns the absolute acceleration over ω at each sample but the first, exactly; the sample and its slope join the
/// state.
fn record_path(zeta: f64, share: f64, samples: &[f64]) -> Vec<Big> {
    let (z, theta) = (Big::from(zeta), (&Big::pi() * &Big::from(share)).scale(1));
    let zero = Big::zero;
    // Over one step of length 1 the state is x, y, the acceleration over ω, and its rise.
    let step = exponential(&[
        [zero(), theta.clone(), zero(), zero()],
        [-&theta, -&(&z.scale(1) * &theta), -&theta, zero()],
        [zero(), zero(), zero(), Big::from(1.0)],
        [zero(), zero(), zero(), zero()],
    ]);
    let over = |a: f64| &Big::from(a) / &theta;
    let (mut x, mut y) = (zero(), zero());
    let after = |pair: &[f64]| {
        let from = over(pair[0]);
        let rise = &over(pair[1]) - &from;
        [x, y, ..] = image(&step, &[x.clone(), y.clone(), from, rise]);
        -&(&x + &(&z.scale(1) * &y))
    };
    samples.windows(2).map(after).collect()
}

/// Returns its largest value, the last.
pub(super) fn record_exact(zeta: f64, share: f64, samples: &[f64]) -> Big {
    record_path(zeta, share, samples).pop().unwrap_or_else(Big::zero)
}

/// Returns the peak by the filter of ISO 18431-4, with its coefficients as printed.
pub(super) fn record_plain(zeta: f64, share: f64, samples: &[f64]) -> f64 {
    let omega = TAU * share;
    let e = exp(-zeta * omega);
    let k = omega * sqrt(1.0 - zeta * zeta);
    let (c, s) = (e * cos(k), e * sin(k) / k);
    let (b, a) = ([1.0 - s, 2.0 * (s - c), e * e - s], [-2.0 * c, e * e]);
    let (mut x, mut y, mut peak) = ([0.0; 2], [0.0; 2], 0.0_f64);
    for &sample in samples {
        let next = b[0] * sample + b[1] * x[0] + b[2] * x[1] - a[0] * y[0] - a[1] * y[1];
        (x, y) = ([sample, x[0]], [next, y[0]]);
        peak = if next.is_nan() { f64::NAN } else { peak.max(next.abs()) };
    }
    peak / omega
}

/// Returns the primary acceleration over ω by the library.
pub(super) fn record_ours(zeta: f64, share: f64, samples: &[f64]) -> Result<f64, Error> {
    let frequencies = Frequencies::list(vec![share])?;
    let mut filter = SpectrumFilter::new(frequencies, DampingRatio::new(zeta)?, Quantity::AbsoluteAcceleration, 1.0)?;
    filter.push(samples);
    Ok(filter.finish()?.primary[0] / (TAU * share))
}

fn sampled(zeta: f64, share: f64, samples: &[f64]) -> Result<Cell, Error> {
    let want = record_exact(zeta, share, samples);
    Ok(Cell {
        allowed: RECORD.error,
        ours: off(record_ours(zeta, share, samples)?, &want, &want),
        plain: Some(off(record_plain(zeta, share, samples), &want, &want)),
    })
}

/// Returns the largest error of the peaks of 75 parts in a clatter, against 50 digits.
fn clatters() -> Result<(f64, usize), Error> {
    let bad = || Error::Data("the reference of the clatters".into());
    let data: serde_json::Value =
        serde_json::from_str(include_str!("../../../crates/clatter-shock/tests/data/response.json"))
            .map_err(|error| Error::Data(error.to_string()))?;
    let cases = data["cases"].as_array().ok_or_else(bad)?;
    let number =
        |v: &serde_json::Value| v.as_f64().or_else(|| v.as_str().and_then(|text| text.parse().ok())).ok_or_else(bad);
    let mut worst = 0.0_f64;
    for c in cases {
        let bar = clatter::Bar::new(number(&c["q"])?, number(&c["e"])?)?;
        let part = mount(number(&c["omega"])?, number(&c["damping"])?)?;
        let got = respond(&bar, &clatter::Start::default(), number(&c["position"])?, &part)?.response;
        let displacement = got.pseudo_velocity().magnitude() / number(&c["omega_peak_relative_displacement"])?;
        let acceleration =
            got.acceleration_over_omega().magnitude() / number(&c["peak_absolute_acceleration_over_omega"])?;
        worst = worst.max((displacement - 1.0).abs()).max((acceleration - 1.0).abs());
    }
    Ok((worst, cases.len()))
}

/// All data about the part.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) free: Vec<Line>,
    pub(super) pulse: Vec<Line>,
    pub(super) record: Vec<Line>,
    pub(super) clatters: Cell,
    pub(super) parts: usize,
}

impl Part {
    pub(super) fn compute() -> Result<Self, Error> {
        let samples = record();
        let lines = |zetas: &[(&'static str, f64)], of: &dyn Fn(f64) -> Result<Vec<Option<Cell>>, Error>| {
            zetas
                .iter()
                .map(|&(name, zeta)| Ok(Line { zeta: name, cells: of(zeta)? }))
                .collect::<Result<Vec<_>, Error>>()
        };
        let (worst, parts) = clatters()?;
        Ok(Self {
            free: lines(&ZETAS, &|zeta| FREE_AT.iter().map(|&(_, omega, t)| free(zeta, omega, t)).collect())?,
            pulse: lines(&ZETAS, &|zeta| PULSE_AT.iter().map(|&(_, omega)| pulse(zeta, omega).map(Some)).collect())?,
            record: lines(&RECORD_ZETAS, &|zeta| {
                RECORD_AT.iter().map(|&(_, share)| sampled(zeta, share, &samples).map(Some)).collect()
            })?,
            clatters: Cell { allowed: TRAIN.error, ours: worst, plain: None },
            parts,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    /// The reference itself is checked: the exponential against the closed forms in 100 digits of mpmath.
    #[test]
    fn exact_motions_are_those_of_a_hundred_digits() {
        let data: Value =
            serde_json::from_str(include_str!("../../../crates/clatter-shock/tests/data/extremes.json")).unwrap();
        let number = |v: &Value| v.as_f64().unwrap_or_else(|| v.as_str().unwrap().parse().unwrap());
        let close = |got: &Big, want: &Value, scale: f64| (got.to_f64() - number(want)).abs() <= f64::EPSILON * scale;
        let mut compared = 0;
        for c in data["free"].as_array().unwrap() {
            let (zeta, omega, t) = (number(&c["zeta"]), number(&c["omega"]), number(&c["t"]));
            assert!((number(&c["displacement"]) - START.displacement).abs() < 1e-16, "another start");
            let ([x, y], decay) = free_exact(zeta, omega, t);
            let scale = number(&c["x"]).hypot(number(&c["y"]));
            assert!(close(&x, &c["x"], scale) && close(&y, &c["y"], scale), "free: ζ = {zeta}, ωt = {:e}", omega * t);
            let slow = number(&c["slow_decay"]);
            assert!((decay.to_f64() - slow).abs() <= 2.0 * f64::EPSILON * slow, "decay: ζ = {zeta}");
            compared += 1;
        }
        for c in data["half_sine_end"].as_array().unwrap() {
            let (zeta, omega) = (number(&c["zeta"]), number(&c["omega"]));
            let [x, y] = pulse_exact(zeta, omega);
            let scale = number(&c["x"]).hypot(number(&c["y"]));
            assert!(close(&x, &c["x"], scale) && close(&y, &c["y"], scale), "half-sine: ζ = {zeta}, ω = {omega}");
            compared += 1;
        }
        assert_eq!(compared, 117 + 96, "the data is whole");
    }

    /// The acceleration of a soft part rises to the end of the record, so that no peak lies between its samples.
    #[test]
    fn peaks_of_the_record_are_at_its_end() {
        let samples = record();
        for (_, zeta) in RECORD_ZETAS {
            for (_, share) in RECORD_AT {
                let path = record_path(zeta, share, &samples);
                assert!(!path[0].is_negative(), "ζ = {zeta}, f/fs = {share}: the first");
                for (n, pair) in path.windows(2).enumerate() {
                    assert!((&pair[0] - &pair[1]).is_negative(), "ζ = {zeta}, f/fs = {share}: sample {n}");
                }
            }
        }
    }
}
