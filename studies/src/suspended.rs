//! Suspended parts if either end may strike first: gains over the single-impact estimate, the impact that holds the
//! peak, and the safe zone.
//!
//! The end of the product that strikes first is unknown. At a distance s from the center a part sits at −s or at s of
//! the bar of [`respond`], and the worse of the two counts. For each instant the response is linear in the position, so
//! that the peak is a convex function of it, largest at one of the ends: a part that survives at an end survives
//! everywhere, and the positions where it survives are one interval about the center.

pub use maps::{GainMap, Holders, SuspendedZones};

mod maps;

use clatter::{Bar, Start};
use clatter_shock::{
    DamageBoundary, DampingRatio, Error, Frequencies, ImpulseFactors, Limit, Pulse, Pulses, Quantity, Rule, RulePoint,
    Shape, Suspension, VelocityShock, respond, shocks_at, three_way_rule,
};
use std::f64::consts::TAU;

/// Returns the [`three_way_rule`] at a distance of 0 to 1 half-lengths from the center, with the worse end first; the
/// bar falls without spin.
///
/// # Errors
/// The errors of [`three_way_rule`].
///
/// ```
/// # use clatter::{Bar, Start};
/// # use clatter_shock::{DampingRatio, three_way_rule};
/// # use clatter_studies::suspended::rule_either_end;
/// let (bar, damping) = (Bar::new(0.5, 0.3)?, DampingRatio::new(0.05)?);
/// let either = rule_either_end(&bar, 1.0, damping, &[3.0])?.points[0].acceleration;
/// let [a, b] = [-1.0, 1.0].map(|s| three_way_rule(&bar, &Start::default(), s, damping, &[3.0]).unwrap());
/// assert_eq!(either, a.points[0].acceleration.max(b.points[0].acceleration));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn rule_either_end(bar: &Bar, distance: f64, damping: DampingRatio, omegas: &[f64]) -> Result<Rule, Error> {
    let at = |position| three_way_rule(bar, &Start::default(), position, damping, omegas);
    let (a, b) = (at(-distance)?, at(distance)?);
    let larger = |a: &RulePoint, b: &RulePoint| RulePoint {
        omega: a.omega,
        displacement: a.displacement.max(b.displacement),
        acceleration: a.acceleration.max(b.acceleration),
        gain: a.gain.max(b.gain),
    };
    Ok(Rule {
        points: a.points.iter().zip(&b.points).map(|(a, b)| larger(a, b)).collect(),
        soft: larger_factors(a.soft, b.soft),
        stiff: a.stiff.zip(b.stiff).map(|(a, b)| larger_factors(a, b)),
        standard: a.standard,
        omitted: a.omitted.max(b.omitted),
    })
}

/// Returns the larger of each factor.
fn larger_factors(a: ImpulseFactors, b: ImpulseFactors) -> ImpulseFactors {
    ImpulseFactors {
        displacement: a.displacement.max(b.displacement),
        acceleration: a.acceleration.max(b.acceleration),
    }
}

/// The worst effect of a bar on any part of a damping ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Peak |A|/(ω v0).
    pub acceleration: f64,
    /// Peak over that of one shock of 2 v0, the estimate of drop standards.
    pub gain: f64,
    /// Peak over that of one shock of (1 + e) v0, the same impact without clatter.
    pub gain_over_flat: f64,
    /// Ω = ω h0/v0 of the worst part.
    pub omega: f64,
}

/// The range of Ω that [`worst`] searches: from parts that respond to the net change alone to parts a thousand times
/// stiffer than 1.
pub const OMEGAS: [f64; 2] = [1e-2, 1e3];

/// Returns values in equal ratios over [`OMEGAS`], at least `per_octave` to an octave, both ends included; for 0 the
/// ends alone.
#[must_use]
pub fn omegas(per_octave: u16) -> Vec<f64> {
    let [low, high] = OMEGAS;
    let steps = (libm::log2(high / low) * f64::from(per_octave)).ceil().max(1.0);
    let mut list = Vec::new();
    let mut i = 0.0;
    while i <= steps {
        list.push(low * libm::pow(high / low, i / steps));
        i += 1.0;
    }
    list
}

/// Returns the largest peak acceleration over all parts: at the worse end of the bar, over Ω within [`OMEGAS`].
///
/// # Accuracy
///
/// The result is the best of `per_octave` values of Ω, refined by golden section between its neighbors. A peak narrower
/// than the steps could be missed; those of a train of n impacts are about 1/(n Ω) octaves wide or 1.4 ζ, whichever is
/// more.
///
/// # Errors
/// The errors of [`three_way_rule`].
///
/// ```
/// # use clatter::Bar;
/// # use clatter_shock::DampingRatio;
/// # use clatter_studies::suspended::worst;
/// // The second design of the paper's table: like one shock of 3.44 v0, where the largest that comes is 2.25 v0.
/// let worst = worst(&Bar::new(0.73, 0.2)?, DampingRatio::new(0.05)?, 24)?;
/// assert!((worst.gain - 1.72).abs() < 0.01 && (40.0..45.0).contains(&worst.omega));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn worst(bar: &Bar, damping: DampingRatio, per_octave: u16) -> Result<Worst, Error> {
    let grid = Frequencies::list(omegas(per_octave).into_iter().map(|omega| omega / TAU).collect())?;
    let shocks = |s| shocks_at(bar, &Start::default(), s, OMEGAS[1]).map(|(shocks, _)| shocks);
    let ends = [shocks(-1.0)?, shocks(1.0)?];
    let (mut best, mut at, mut end) = (0.0, 0, 0);
    for (k, shocks) in ends.iter().enumerate() {
        let spectrum = shocks.spectrum(&grid, damping, Quantity::AbsoluteAcceleration);
        for (i, (hz, acceleration)) in grid.hz().iter().zip(spectrum.maximax).enumerate() {
            if acceleration / (TAU * hz) > best {
                (best, at, end) = (acceleration / (TAU * hz), i, k);
            }
        }
    }
    let peak = |hz: f64| {
        let suspension = Suspension::from_hz(hz, damping)?;
        Ok::<_, Error>(ends[end].respond(&suspension).acceleration_over_omega().magnitude())
    };
    let hz = grid.hz();
    let mut top = hz[at];
    let (mut low, mut high) = (hz[at.saturating_sub(1)], hz[(at + 1).min(hz.len() - 1)]);
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    let (mut x, mut y) = (high - golden * (high - low), low + golden * (high - low));
    let (mut px, mut py) = (peak(x)?, peak(y)?);
    for _ in 0..30 {
        for (at, value) in [(x, px), (y, py)] {
            if value > best {
                (best, top) = (value, at);
            }
        }
        if px < py {
            (low, x, px) = (x, y, py);
            y = low + golden * (high - low);
            py = peak(y)?;
        } else {
            (high, y, py) = (y, x, px);
            x = high - golden * (high - low);
            px = peak(x)?;
        }
    }
    let omega = TAU * top;
    let factor = damping.impulse_factors().acceleration;
    Ok(Worst {
        acceleration: best,
        gain: best / (2.0 * factor),
        gain_over_flat: best / ((1.0 + bar.e()) * factor),
        omega,
    })
}

/// Returns the safe zone of a suspended part: the distance from the center, in half-lengths up to 1, within which no
/// part gets a larger peak acceleration than by one velocity shock of `threshold` v0, whichever end strikes first;
/// `None` if not even the center is safe. `suspension` has its ω in v0/h0.
///
/// For ζΩ → ∞ this is the safe zone of the paper (Eq. 5, [`clatter::Shocks::safe_zone`]), for Ω → 0 the positions whose net change
/// of velocity is within the threshold.
///
/// # Errors
/// The errors of [`respond`]; [`Error::Quantity`] for a threshold that is not finite and positive.
///
/// ```
/// # use clatter::{Bar, Start};
/// # use clatter_shock::{DampingRatio, Suspension};
/// # use clatter_studies::suspended::suspended_zone;
/// let (bar, damping) = (Bar::new(0.73, 0.2)?, DampingRatio::new(0.05)?);
/// let zone = |omega| suspended_zone(&bar, &Suspension::new(omega, damping).unwrap(), 0.5).unwrap();
/// let paper = bar.shocks_either(&Start::default()).safe_zone(0.5).s;
/// assert!((zone(1e4).unwrap() - paper).abs() < 1e-6);
/// assert_eq!(zone(1e-2), None); // soft: the net change is v0, although no shock in the zone exceeds v0/2
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn suspended_zone(bar: &Bar, suspension: &Suspension, threshold: f64) -> Result<Option<f64>, Error> {
    let allowed = suspension.damping().impulse_factors().acceleration * positive("threshold", threshold)?;
    let safe = |distance: f64| {
        for position in [-distance, distance] {
            let (shocks, _) = shocks_at(bar, &Start::default(), position, suspension.omega())?;
            let peak = shocks.respond(suspension).acceleration_over_omega().magnitude();
            // The margin is a few roundings, so that a threshold equal to the peak itself is safe.
            if peak > allowed * (1.0 + 8.0 * f64::EPSILON) {
                return Ok(false);
            }
        }
        Ok::<_, Error>(true)
    };
    if safe(1.0)? {
        return Ok(Some(1.0));
    }
    if !safe(0.0)? {
        return Ok(None);
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if safe(middle)? { low = middle } else { high = middle }
    }
    Ok(Some(low))
}

/// Returns the number of the impact that the peak acceleration follows, from 1, for a part at a signed position (−1 is
/// the end that strikes first), and the number of impacts of the train, as far as it was followed.
///
/// # Errors
/// The errors of [`respond`].
///
/// ```
/// # use clatter::Bar;
/// # use clatter_shock::{DampingRatio, Suspension};
/// # use clatter_studies::suspended::impact_of_peak;
/// let bar = Bar::new(0.5, 0.3)?;
/// let stiff = Suspension::new(1e4, DampingRatio::new(0.05)?)?;
/// assert_eq!(impact_of_peak(&bar, -1.0, &stiff)?, (1, 4)); // 1.3 v0 at the end that strikes first
/// assert_eq!(impact_of_peak(&bar, 1.0, &stiff)?, (2, 4)); // 2.145 v0 at the other
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn impact_of_peak(bar: &Bar, position: f64, suspension: &Suspension) -> Result<(usize, usize), Error> {
    let train = respond(bar, &Start::default(), position, suspension)?;
    Ok((train.response.absolute_acceleration.peak().interval + 1, train.shocks.as_slice().len()))
}

/// The largest effects of a pulse of a shape: the numbers of its damage boundary, free of units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeFigures {
    /// The shape.
    pub shape: Shape,
    /// Largest |A| over the amplitude of the pulse, over all durations.
    pub amplification: f64,
    /// Natural frequency times the shortest duration that has it; infinite if the amplification only tends to it.
    pub frequency_duration: f64,
    /// Velocity change at the knee of the damage boundary over the critical one.
    pub knee: f64,
}

impl ShapeFigures {
    /// Computes the numbers for a damping ratio.
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Shape};
    /// # use clatter_studies::suspended::ShapeFigures;
    /// let rectangle = ShapeFigures::new(Shape::Rectangle, DampingRatio::new(0.0)?)?;
    /// assert!((rectangle.amplification - 2.0).abs() < 1e-14 && (rectangle.frequency_duration - 0.5).abs() < 1e-14);
    /// assert!((rectangle.knee - std::f64::consts::FRAC_PI_2).abs() < 1e-14);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    /// # Errors
    /// The errors of [`DamageBoundary::new`].
    pub fn new(shape: Shape, damping: DampingRatio) -> Result<Self, Error> {
        let boundary = DamageBoundary::new(Suspension::new(TAU, damping)?, Limit::Acceleration(1.0), shape)?;
        let knee = boundary.knee_velocity_change();
        Ok(Self {
            shape,
            amplification: boundary.critical_acceleration().recip(),
            frequency_duration: knee / (shape.area() * boundary.critical_acceleration()),
            knee: knee / boundary.critical_velocity_change(),
        })
    }
}

/// Returns the largest |A| over the amplitude of one pulse, at natural frequency times duration `frequency_duration`.
///
/// # Errors
/// The errors of [`Pulses::new`].
///
/// ```
/// # use clatter_shock::{DampingRatio, Shape};
/// # use clatter_studies::suspended::amplification;
/// let undamped = DampingRatio::new(0.0)?;
/// assert!((amplification(Shape::HalfSine, undamped, 0.80994)? - 1.768458).abs() < 1e-6);
/// # Ok::<(), clatter_shock::Error>(())
/// ```
pub fn amplification(shape: Shape, damping: DampingRatio, frequency_duration: f64) -> Result<f64, Error> {
    let pulse = Pulse { shape, amplitude: 1.0, duration: frequency_duration, start: 0.0 };
    let suspension = Suspension::from_hz(1.0, damping)?;
    Ok(Pulses::new(&[pulse])?.respond(&suspension).absolute_acceleration.magnitude())
}

/// Returns the clatter as a train of half-sines of one contact time at a position: each impact gives the area of its
/// velocity shock, beginning at the strike. Speeds and heights are those of `start`, in m/s and m. Longer contacts
/// overlap.
///
/// # Errors
/// The errors of [`respond`] and [`Pulses::new`].
///
/// ```
/// # use clatter::{Bar, Start};
/// # use clatter_studies::suspended::half_sine_train;
/// let start = Start::new([-4.85, -4.85], 5e-3)?;
/// let pulses = half_sine_train(&Bar::new(0.5, 0.3)?, &start, 1.0, 4e-4)?;
/// assert_eq!(pulses.len(), 4);
/// assert!((pulses[1].velocity_change() - 2.145 * 4.85).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn half_sine_train(bar: &Bar, start: &Start, position: f64, contact_s: f64) -> Result<Vec<Pulse>, Error> {
    positive("contact time (s)", contact_s)?;
    let (shocks, _) = shocks_at(bar, start, position, contact_s.recip())?;
    let pulse = |delta_v: f64| delta_v / (Shape::HalfSine.area() * contact_s);
    let of = |s: &VelocityShock| Pulse {
        shape: Shape::HalfSine,
        amplitude: pulse(s.delta_v),
        duration: contact_s,
        start: s.time,
    };
    Ok(shocks.as_slice().iter().map(of).collect())
}

/// Returns `value` if it is finite and greater than zero.
fn positive(name: &'static str, value: f64) -> Result<f64, Error> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(Error::Quantity { name, value, allowed: "finite and > 0" })
    }
}
