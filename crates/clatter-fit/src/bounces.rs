//! One point that bounces: the restitution by the ratio of flight times.

use clatter::End;

use super::region::{Function, Region};
use super::solve::{PRECISION, Problem};
use super::student;
use super::{Error, Estimate, Fit, MOST_STRIKES, MeasuredStrike, Quantity, RecordFit, StrikeFit};
use clatter_product::Model;

/// Unknowns: first touch over the first flight time, ln of the first flight time, restitution.
const FREE: [usize; 3] = [0, 1, 2];

/// Fits the restitution from the times at which a body that lands flat, or one point of it alone, bounces.
///
/// # Formula
/// A flight after an approach of v takes 2 e v/g, and the next approach is e v: flight times are f, e f, e² f, … So the n-th bounce
/// is at t₀ + f (1 + e + … + eⁿ⁻²). The three unknowns by least squares; intervals as those of [`fit`](super::fit). The height of the
/// drop, if the body was let go at rest, is (g f/e)²/(8 g).
///
/// # Validity
/// One restitution at any speed; contacts short compared with flights; no air; gravity in m/s².
///
/// # Errors
/// [`Error`] unless 3 to 4096 finite times rise, and gravity is in [0, 1000] m/s².
///
/// # Examples
/// Flights of 0.4, 0.2 and 0.1 s:
/// ```
/// use clatter_fit::bounces;
/// let found = bounces(&[1.0, 1.4, 1.6, 1.7], 9.81, Some(1e-4))?;
/// assert!((found.estimates[0].value - 0.5).abs() < 1e-9);
/// # Ok::<(), clatter_fit::Error>(())
/// ```
pub fn bounces(times_s: &[f64], gravity_m_s2: f64, deviation_s: Option<f64>) -> Result<Fit, Error> {
    check(times_s, deviation_s)?;
    if !(0.0..=1e3).contains(&gravity_m_s2) {
        return Err(Error::Known { name: "gravity in m/s2", value: gravity_m_s2, allowed: "in [0, 1000]" });
    }
    let flights: Vec<f64> = times_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let unit_s = flights[0];
    let deviation = deviation_s.unwrap_or(1e-3 * unit_s);
    let computed = |x: &[f64]| {
        let mut flight = libm::exp(x[1]);
        let mut time = x[0] * unit_s;
        let mut at = Vec::with_capacity(times_s.len());
        for _ in times_s {
            at.push(time);
            time += flight;
            flight *= x[2];
        }
        at
    };
    let residuals = |x: &[f64]| {
        times_s.iter().zip(computed(x)).map(|(measured, computed)| (measured - computed) / deviation).collect()
    };
    let bounds = vec![[f64::NEG_INFINITY, f64::INFINITY], [f64::NEG_INFINITY, 30.0], [0.0, 1.0]];
    let problem = Problem {
        residuals: Box::new(residuals),
        bounds,
        step: 1e-6,
        one_sided: false,
        patience: 100,
        precision: PRECISION,
    };
    let start = [times_s[0] / unit_s, libm::log(unit_s), (flights[1] / flights[0]).clamp(0.01, 0.99)];
    let minimum = problem.minimize(&start, &FREE);
    let degrees = times_s.len() - FREE.len();
    #[expect(clippy::cast_precision_loss, reason = "at most 4096")]
    let degrees_count = degrees as f64;
    let scatter = match deviation_s {
        Some(_) => Some(1.0),
        None => (degrees > 0).then(|| (minimum.sum() / degrees_count).sqrt()),
    };
    let t = student::two_sided(0.05, deviation_s.is_none().then_some(degrees_count));
    let region = scatter.and_then(|scatter| Region::new(&problem, &minimum, &FREE, t * scatter));
    let interval = |of: &Function<'_>| region.as_ref().map(|region| region.ends(of).map(|end| of(&end)));
    let e = minimum.x[2];
    let range = interval(&|x| x[2]).map(|[lo, hi]| [lo.max(0.0), hi.min(1.0)]);
    let mut estimates = vec![Estimate { quantity: Quantity::Restitution, value: e, interval: range, note: None }];
    if gravity_m_s2 > 0.0 && e > 0.0 {
        // The interval is that of the logarithm, which scatters more evenly than the height.
        let ln_height = |x: &[f64]| libm::log(0.125 * gravity_m_s2) + 2.0 * (x[1] - libm::log(x[2]));
        let value = libm::exp(ln_height(&minimum.x));
        let interval = interval(&ln_height).map(|ends| ends.map(libm::exp));
        let note = Some("if it was let go at rest".to_owned());
        estimates.push(Estimate { quantity: Quantity::DropHeight, value, interval, note });
    }
    let first_touch_s = minimum.x[0] * unit_s;
    let at = computed(&minimum.x);
    let strikes: Vec<StrikeFit> = times_s
        .iter()
        .zip(&at)
        .enumerate()
        .map(|(k, (&time_s, computed))| StrikeFit {
            measured: MeasuredStrike { time_s, end: None },
            number: Some(k + 1),
            residual_s: Some(time_s - computed),
        })
        .collect();
    #[expect(clippy::cast_precision_loss, reason = "at most 4096")]
    let rms = deviation * (minimum.sum() / times_s.len() as f64).sqrt();
    let record = RecordFit { first_touch_s, scatter: rms, strikes, missing: Vec::new(), curves: Vec::new() };
    let notes = if scatter.is_none() {
        vec!["there are as many unknowns as data, and nothing tells their scatter: no intervals".to_owned()]
    } else {
        Vec::new()
    };
    Ok(Fit {
        model: Model::Ballistic,
        first: End::A,
        estimates,
        untold: Vec::new(),
        correlations: Vec::new(),
        degrees_of_freedom: degrees,
        others: Vec::new(),
        records: vec![record],
        computed: at.iter().map(|time_s| (time_s - first_touch_s, End::A)).collect(),
        notes,
    })
}

fn check(times_s: &[f64], deviation_s: Option<f64>) -> Result<(), Error> {
    if !(3..=MOST_STRIKES).contains(&times_s.len()) {
        return Err(Error::Count { record: 1, count: times_s.len(), name: "bounces", allowed: "3 to 4096" });
    }
    for pair in times_s.windows(2) {
        if !(pair[0].abs() < 1e9 && pair[1].abs() < 1e9 && pair[0] < pair[1]) {
            let allowed = "after the one before it and below 1e9";
            return Err(Error::Value { record: 1, name: "time of a bounce in s", value: pair[1], allowed });
        }
    }
    match deviation_s {
        Some(value) if !(value > 0.0 && value < 1e9) => {
            let allowed = "positive and below 1e9";
            Err(Error::Value { record: 1, name: "standard deviation in s", value, allowed })
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first touch, the first flight and the restitution are three unknowns: three bounces tell them and no scatter.
    #[test]
    fn what_is_more_than_three_bounces_tells_the_scatter() {
        let times = [0.0, 0.1, 0.1503, 0.1749, 0.1875, 0.194];
        for (count, spare) in [(3, 0), (4, 1), (6, 3)] {
            let fit = bounces(&times[..count], 9.81, None).unwrap();
            assert_eq!(fit.degrees_of_freedom, spare);
            assert_eq!(fit.estimates[0].interval.is_some(), spare > 0, "{fit:?}");
        }
    }

    /// Let go at rest from 0.8 m, with e = 0.7: it touches at v₀ = √(2 g h) and is up for 2 eⁿ v₀/g.
    #[test]
    fn a_ball_that_was_let_go_tells_its_height() {
        let (g, height, e) = (9.81_f64, 0.8, 0.7_f64);
        let speed = (2.0 * g * height).sqrt();
        let mut times = vec![0.4];
        (1..6).for_each(|n| times.push(times[times.len() - 1] + 2.0 * e.powi(n) * speed / g));
        let fit = bounces(&times, g, Some(1e-5)).unwrap();
        for (estimate, want) in fit.estimates.iter().zip([e, height]) {
            let [lo, hi] = estimate.interval.expect("an interval");
            assert!((estimate.value / want - 1.0).abs() < 1e-6 && lo < want && want < hi, "{estimate:?}, not {want}");
            assert!(hi - lo < 1e-3 * want, "{estimate:?}");
        }
    }
}
