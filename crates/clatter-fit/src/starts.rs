//! This module finds where searches begin: unknowns that explain the data roughly.

use clatter::{Bar, End, Start};

use super::drop::{CONTACT, Drop, GAP_TIME, GYRATION, OFFSET, RESTITUTION, SPEED, SPIN};
use super::{MeasuredHeights, MeasuredStrike, Set, Which};

/// Restitutions that are tried.
const RESTITUTIONS: [f64; 12] = [0.02, 0.08, 0.15, 0.22, 0.3, 0.38, 0.46, 0.55, 0.65, 0.75, 0.85, 0.95];
/// Radii of gyration that are tried, over that of the product file.
const GYRATIONS: [f64; 7] = [1.0, 0.7, 0.8, 0.9, 1.1, 1.25, 1.5];
/// The number of the best starts that go on.
pub(super) const TAKEN: usize = 8;
/// Strikes and pulses that a start is found from, at most.
const MOST: usize = 32;
/// The numbers of strikes that a start uses: the first few, which gravity and contacts hardly change, or all.
const EARLY: [usize; 3] = [2, 3, MOST];

/// Finds the best of a grid of unknowns, so many, the best first.
pub(super) fn starts(drop: &Drop<'_>, taken: usize) -> Vec<Vec<f64>> {
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    let given = drop.given();
    for &factor in if drop.known.gyration_known { &GYRATIONS[..1] } else { &GYRATIONS[..] } {
        for restitution in RESTITUTIONS {
            let mut x = given.clone();
            x[GYRATION] += libm::log(factor);
            x[RESTITUTION] = restitution;
            for x in at(drop, &x) {
                found.push((misfit(drop, &x), x));
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().take(taken).map(|(_, x)| x).collect()
}

/// Steps of a grid over the restitution, over the radius of gyration and over a range of the speed: of one that looks for other
/// explanations, and of one that looks for any.
pub(super) const ROUGH_GRID: [u32; 3] = [60, 48, 4];
pub(super) const FINE_GRID: [u32; 3] = [72, 60, 8];
/// Half a range of the speed, as a share, over which three of them are enough.
const NARROW: f64 = 0.03;
/// Radii of gyration of the grid, over half the length.
const RADII: [f64; 2] = [0.15, 0.98];
/// Flights that bring the second strike to its time, which is nearly proportional to the gap.
const TO_SECOND: usize = 3;

/// Finds the best drops of a grid over the restitution, the radius of gyration and the range of the speed, so many, the best first: each
/// with the gap that the second strike gives. Where ends are known, drops come first whose ends strike in the order that was measured.
pub(super) fn on_grid(drop: &Drop<'_>, free: &[usize], grid: [u32; 3], taken: usize) -> Vec<Vec<f64>> {
    let Set::Strikes { strikes, .. } = &drop.sets[0] else { return Vec::new() };
    let along = |[lo, hi]: [f64; 2], k: u32, of: u32| lo + (hi - lo) * f64::from(k) / f64::from(of.max(1));
    let given = drop.given();
    let counts = [RESTITUTION, GYRATION].map(|unknown| free.contains(&unknown));
    let [restitutions, radii] = [0, 1].map(|i| if counts[i] { grid[i] } else { 0 });
    let speeds = drop.range(SPEED).map_or(0, |[_, half]| if half < NARROW { 2 } else { grid[2] });
    let mut found: Vec<(usize, f64, Vec<f64>)> = Vec::new();
    for e in 0..=restitutions {
        for speed in 0..=speeds {
            let mut x = given.clone();
            if restitutions > 0 {
                x[RESTITUTION] = along([0.0, 1.0], e, restitutions);
            }
            if let Some([middle, half]) = drop.range(SPEED) {
                x[SPEED] = along([middle - half, middle + half], speed, speeds);
            }
            for radius in 0..=radii {
                if radii > 0 {
                    x[GYRATION] = libm::log(along(RADII, radius, radii));
                }
                if let Some((wrong, off_s)) = meets_second(drop, strikes, &mut x) {
                    found.push((wrong, off_s, x.clone()));
                }
            }
        }
    }
    found.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    found.into_iter().take(taken).map(|(_, _, x)| x).collect()
}

/// Brings the second strike to its time by the gap; how many ends differ from those measured, and by how much times do, squared.
fn meets_second(drop: &Drop<'_>, strikes: &[MeasuredStrike], x: &mut [f64]) -> Option<(usize, f64)> {
    let [first_s, second_s] = [strikes.first()?.time_s, strikes.get(1)?.time_s];
    let [lo, hi] = drop.bounds()[GAP_TIME];
    for _ in 0..TO_SECOND {
        let path = drop.path(x)?;
        let [first, second] = path.motion.strikes.get(..2)? else { return None };
        x[GAP_TIME] += libm::log((second_s - first_s) / (second.time_s - first.time_s));
        x[GAP_TIME] = x[GAP_TIME].clamp(lo, hi);
    }
    let computed = drop.path(x)?.motion.strikes;
    let computed = computed.get(..strikes.len())?;
    x[OFFSET] = (first_s - computed[0].time_s) / drop.unit_s;
    let pairs = || strikes.iter().zip(computed);
    let wrong = pairs().filter(|(one, other)| one.end.is_some_and(|end| end != drop.end(other.point))).count();
    let off = |(one, other): (&MeasuredStrike, &clatter_flight::Strike)| {
        (one.time_s - first_s) - (other.time_s - computed[0].time_s)
    };
    Some((wrong, pairs().map(|pair| off(pair).powi(2)).sum()))
}

/// Returns how far a start is off: of each datum the logarithm, so that a start counts for what it explains, not for what it does not.
pub(super) fn misfit(drop: &Drop<'_>, x: &[f64]) -> f64 {
    let residuals = drop.residuals(x);
    let mut from = 0;
    let mut sum = 0.0;
    for set in &drop.sets {
        let own = &residuals[from..from + set.len()];
        from += own.len();
        // A tenth of what such data vary by.
        let scale = 0.1 * set.variation(drop.unit_s);
        sum += own.iter().map(|r| libm::log(1.0 + (r / scale).powi(2))).sum::<f64>();
    }
    sum
}

fn is_acceleration(set: &Set<'_>) -> bool {
    matches!(set, Set::Acceleration { .. })
}

/// Returns how the product fell, by each record that can tell, for a restitution and a radius of gyration.
fn at(drop: &Drop<'_>, x: &[f64]) -> Vec<Vec<f64>> {
    let mut all = vec![x.to_vec()];
    // Heights tell most of how it fell, strikes when.
    for (k, set) in drop.sets.iter().enumerate() {
        if let Set::Heights { samples, .. } = set {
            for x in &mut all {
                by_heights(drop, k, samples, x);
            }
        }
    }
    for (k, set) in drop.sets.iter().enumerate() {
        if let Set::Strikes { strikes, index, .. } = set {
            let of = |x: &Vec<f64>| EARLY.map(|early| by_strikes(drop, k, strikes, index, early, x.clone()));
            all = all.iter().flat_map(of).collect();
        }
    }
    for (k, set) in drop.sets.iter().enumerate() {
        if let Set::Acceleration { start_s, step_s, values, .. } = set {
            let alone = drop.sets.iter().all(is_acceleration);
            all = all.iter().flat_map(|x| by_acceleration(drop, k, [*start_s, *step_s], values, alone, x)).collect();
        }
    }
    all
}

/// Finds gap over speed and first touch by linear regression on the train without gravity, over so many strikes.
pub(super) fn by_strikes(
    drop: &Drop<'_>,
    set: usize,
    strikes: &[MeasuredStrike],
    index: &[Option<Which>],
    early: usize,
    mut x: Vec<f64>,
) -> Vec<f64> {
    let [a, b] = drop.known.body.arms_m();
    let arms = if drop.first == End::A { [a, b] } else { [b, a] };
    let gyration = 0.5 * (a + b) * libm::exp(x[GYRATION]);
    let Ok(bar) = Bar::from_arms(arms, gyration, x[RESTITUTION]) else { return x };
    let train: Vec<f64> = bar.train(&Start::default()).take(MOST).map(|impact| impact.time).collect();
    // Without gravity the ends strike in turn.
    let place = |which: Which| match which {
        Which::Of(n) => n,
        Which::OfEnd(end, n) => 2 * n + usize::from(end != drop.first),
    };
    let pairs: Vec<[f64; 2]> = strikes
        .iter()
        .zip(index)
        .filter_map(|(strike, which)| Some([*train.get(which.map(place)?)?, strike.time_s]))
        .take(early)
        .collect();
    #[expect(clippy::cast_precision_loss, reason = "at most 32")]
    let n = pairs.len() as f64;
    let [mean_x, mean_y] = [0, 1].map(|i| pairs.iter().map(|pair| pair[i]).sum::<f64>() / n);
    let across: f64 = pairs.iter().map(|[x, y]| (x - mean_x) * (y - mean_y)).sum();
    let along: f64 = pairs.iter().map(|[x, _]| (x - mean_x) * (x - mean_x)).sum();
    let first = strikes.first().map_or(0.0, |strike| strike.time_s);
    let slope = across / along;
    if slope > 0.0 && slope.is_finite() {
        x[GAP_TIME] = libm::log(slope);
        x[OFFSET + set] = (mean_y - slope * mean_x) / drop.unit_s;
    } else {
        x[OFFSET + set] = first / drop.unit_s;
    }
    x
}

/// Sets the fall before the first touch, which is where the lower end first turns upward near the ground.
fn by_heights(drop: &Drop<'_>, set: usize, samples: &[MeasuredHeights], x: &mut [f64]) {
    let first = usize::from(drop.first == End::B);
    let low = |sample: &MeasuredHeights| sample.height_m[first];
    let turns = (1..samples.len().saturating_sub(1))
        .find(|&i| low(&samples[i]) <= low(&samples[i - 1]) && low(&samples[i]) < low(&samples[i + 1]))
        .unwrap_or(0);
    // The last fall before the touch: two samples at least half a dozen apart where there are so many.
    let (from, to) = (turns.saturating_sub(7), turns.saturating_sub(1));
    let (a, b) = (&samples[from], &samples[to]);
    let span = b.time_s - a.time_s;
    let rate = |i: usize| if span > 0.0 { (b.height_m[i] - a.height_m[i]) / span } else { 0.0 };
    let [first_rate, second_rate] = [rate(first), rate(1 - first)];
    let middle = 0.5 * (a.time_s + b.time_s);
    let speed = libm::exp(x[SPEED]);
    let falls = -0.5 * (first_rate + second_rate);
    let speed = if falls > 0.0 { falls } else { speed };
    let touch = b.time_s + (low(b) / speed).max(0.0);
    let at_touch = speed + drop.known.gravity_m_s2 * (touch - middle);
    let spin = (second_rate - first_rate) / drop.known.body.length_m();
    let gap = samples[turns].height_m[1 - first] - samples[turns].height_m[first];
    let gap = gap.max(1e-3 * drop.known.body.length_m());
    x[SPEED] = libm::log(at_touch);
    x[GAP_TIME] = libm::log(gap / at_touch);
    x[SPIN] = spin * 0.5 * drop.known.body.length_m() / at_touch;
    x[OFFSET + set] = touch / drop.unit_s;
}

/// Gaps from a quarter of a pulse to all of a record of accelerations.
const GAPS: u32 = 16;
/// Share of the largest value at which a pulse begins.
pub(super) const ONSET: f64 = 0.05;

/// Finds when pulses begin and how long the first takes; the gap from the time between the first two where nothing else tells it.
fn by_acceleration(
    drop: &Drop<'_>,
    set: usize,
    [start_s, step_s]: [f64; 2],
    values: &[f64],
    alone: bool,
    x: &[f64],
) -> Vec<Vec<f64>> {
    let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let pulses: Vec<(usize, usize)> = {
        let is_high = |value: &f64| value.abs() > ONSET * largest;
        let mut pulses = Vec::new();
        let mut at = 0;
        while let Some(from) = values[at..].iter().position(is_high).map(|k| at + k) {
            at = values[from..].iter().position(|value| !is_high(value)).map_or(values.len(), |k| from + k);
            pulses.push((from, at));
            if pulses.len() == MOST {
                break;
            }
        }
        pulses
    };
    #[expect(clippy::cast_precision_loss, reason = "at most a million")]
    let time = |k: usize| k as f64 * step_s;
    let Some(&(from, to)) = pulses.first() else { return vec![x.to_vec()] };
    let mut x = x.to_vec();
    x[OFFSET + set] = (start_s + time(from)) / drop.unit_s;
    let width = time(to - from).max(2.0 * step_s);
    let measured_width = Vec::from([{
        let mut x = x.clone();
        x[CONTACT] = libm::log(width);
        x
    }]);
    let mut all = measured_width;
    all.extend(drop.known.contact_time_s.is_some().then_some(x));
    if alone {
        // The next pulses, one of which is the other end's, gaps over all of the record, as where pulses overlap, and the tilt of the
        // product file.
        let next = pulses.iter().skip(1).take(3).map(|(next, _)| time(next - from));
        let whole = time(values.len().saturating_sub(from)).max(2.0 * width);
        let apart = |k: u32| 0.25 * width * libm::pow(4.0 * whole / width, f64::from(k) / f64::from(GAPS));
        let gaps: Vec<f64> = next.chain((0..GAPS).map(apart)).collect();
        let q = |x: &[f64]| {
            let k = libm::exp(x[GYRATION]);
            (1.0 - k * k) / (1.0 + k * k)
        };
        let more: Vec<Vec<f64>> = all
            .iter()
            .flat_map(|x| {
                gaps.iter().map(|gap| {
                    let mut x = x.clone();
                    x[GAP_TIME] = libm::log(gap * (1.0 + q(&x) * (1.0 + x[RESTITUTION])).max(0.1));
                    x
                })
            })
            .collect();
        all.extend(more);
    }
    all
}
