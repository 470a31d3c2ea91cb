//! The worst drop of each limit by sampling and climbing.

use crate::flight::{Drop, Flight, Until, flat, follow};
use crate::part::{INSTANT, Motion, Peak, Response, Stop, Suspension, largest, largest_acceleration, respond, shocks};
use crate::product::{Kind, Part, Product, Sample};
use crate::random::Random;

/// End of the drops during the search; the worst one is followed again.
const ROUGH: Until = Until { time: 0.6, quiet: 1e-2 };
/// End of the worst drop.
const WHOLE: Until = Until { time: 0.6, quiet: 1e-4 };
/// Without a contact time, the ends of a tilt that land within this time also land together.
const MERGE: f64 = 1e-3;
/// Parts drawn for each drop that is followed.
const DRAWS: usize = 4;
/// Samples from which the search climbs.
const STARTS: usize = 8;

/// The worst drop of one limit.
#[derive(Debug, Clone)]
pub struct Worst {
    /// Name of the part.
    pub part: String,
    /// Kind of the limit.
    pub kind: Kind,
    /// Its largest value; for a damage boundary as a share of the allowed one.
    pub peak: Peak,
    /// Number of the touch before it; micro-touches are not counted.
    pub impact: usize,
    /// The value without the effect of the turning of the bar in free flight.
    pub still: f64,
    /// True for a flat landing of instant impacts.
    pub flat: bool,
    /// The drop.
    pub drop: Drop,
    /// Place from the center of mass.
    pub place: f64,
    /// What holds the part.
    pub suspension: Option<Suspension>,
}

/// Returns the values of limits of one part in one flight.
#[must_use]
pub fn values(kinds: &[Kind], flight: &Flight, place: f64, suspension: Option<Suspension>) -> Vec<Peak> {
    let response = suspension.map(|suspension| respond(flight, place, &suspension, None));
    let value = |kind: &Kind| match (*kind, &response) {
        (Kind::Acceleration, None) => largest_acceleration(flight, place),
        (Kind::Acceleration, Some(response)) => response.acceleration,
        (Kind::RattleSpace, response) => response.as_ref().map_or_else(Peak::default, |response| response.displacement),
        (Kind::StopSpeed, response) => response.as_ref().map_or_else(Peak::default, Response::hardest),
        (Kind::VelocityChange, _) => largest(&shocks(flight, place, Motion::Velocity)),
        (Kind::AngularVelocityChange, _) => largest(&shocks(flight, place, Motion::Turning)),
        (Kind::DamageBoundary(velocity, acceleration), _) => {
            let mut list = shocks(flight, place, Motion::Velocity);
            for shock in &mut list {
                shock.change = (shock.change.abs() / velocity).min(shock.acceleration / acceleration);
            }
            largest(&list)
        }
    };
    kinds.iter().map(value).collect()
}

/// Returns the flights of a drop: its own and, without a contact time and nearly flat, the flat one; that alone where
/// strikes are so close that the motion does not resolve them.
fn flights(drop: &Drop, until: Until) -> Vec<(Flight, bool)> {
    let gap = drop.length * drop.tilt.sin() / drop.speed;
    let mut list = Vec::with_capacity(2);
    if drop.contact.is_some() || gap > 100.0 * INSTANT {
        list.push((follow(drop, until), false));
    }
    if drop.contact.is_none() && gap < MERGE {
        list.push((flat(drop, until), true));
    }
    list
}

/// Returns the highest value of a sample.
fn high(part: &Part, kind: Kind, product: &Product, sample: &Sample) -> f64 {
    let (place, suspension) = part.at(sample);
    let value = |(flight, _): &(Flight, bool)| values(&[kind], flight, place, suspension)[0].value;
    flights(&product.drop(sample), ROUGH).iter().map(value).fold(0.0, f64::max)
}

/// Follows a sample to its full end.
fn evaluate(part: &Part, kind: Kind, product: &Product, sample: &Sample) -> Worst {
    let drop = product.drop(sample);
    let (place, suspension) = part.at(sample);
    let (mut flight, flat, peak) = flights(&drop, WHOLE)
        .into_iter()
        .map(|(flight, flat)| {
            let peak = values(&[kind], &flight, place, suspension)[0];
            (flight, flat, peak)
        })
        .max_by(|a, b| a.2.value.total_cmp(&b.2.value))
        .expect("a drop has a flight");
    let counts = |touch: &&crate::flight::Touch| touch.time <= peak.time && touch.velocity.abs() > 1e-3 * drop.speed;
    let impact = flight.touches.iter().filter(counts).count();
    flight.steps.retain(|step| !step.flying);
    let still = values(&[kind], &flight, place, suspension)[0].value;
    Worst { part: part.name.clone(), kind, peak, impact, still, flat, drop, place, suspension }
}

/// Searches the worst drop of each limit among some thousand.
#[must_use]
pub fn hunt(product: &Product, drops: usize, seed: u64) -> Vec<Worst> {
    let mut random = Random::new(seed);
    let limits: Vec<(&Part, Kind)> =
        product.parts.iter().flat_map(|part| part.limits.iter().map(move |&kind| (part, kind))).collect();
    let varied = Varied { spins: product.spins(), stops: product.has_stops() };
    let draws = if product.parts.iter().any(Part::varies) { DRAWS } else { 1 };
    let mut best: Vec<Vec<(f64, Sample)>> = vec![Vec::new(); limits.len()];
    for _ in 0..drops.div_ceil(2).max(1) {
        let base = draw(&mut random, varied);
        let flights = flights(&product.drop(&base), ROUGH);
        for _ in 0..draws {
            let mut sample = draw(&mut random, varied);
            sample[..5].copy_from_slice(&base[..5]);
            sample[8] = base[8];
            let mut best = best.iter_mut();
            for part in &product.parts {
                let (place, suspension) = part.at(&sample);
                let found = flights.iter().map(|(flight, _)| values(&part.limits, flight, place, suspension));
                let highest =
                    found.reduce(|a, b| a.iter().zip(b).map(|(&a, b)| if b.value > a.value { b } else { a }).collect());
                for (peak, best) in highest.unwrap_or_default().iter().zip(&mut best) {
                    best.push((peak.value, sample));
                    if best.len() > 4 * STARTS {
                        best.sort_by(|a, b| b.0.total_cmp(&a.0));
                        best.truncate(STARTS);
                    }
                }
            }
        }
    }
    let tries = drops / 2 / (limits.len().max(1) * STARTS);
    let climbed = limits.iter().zip(best).map(|(&(part, kind), mut starts)| {
        starts.sort_by(|a, b| b.0.total_cmp(&a.0));
        starts.truncate(STARTS);
        let mut tops: Vec<(f64, Sample)> = starts
            .into_iter()
            .map(|start| climb(start, tries, varied, &mut random, |sample| high(part, kind, product, sample)))
            .collect();
        tops.sort_by(|a, b| b.0.total_cmp(&a.0));
        let top = climb(tops[0], 2 * tries, varied, &mut random, |sample| high(part, kind, product, sample));
        evaluate(part, kind, product, &top.1)
    });
    climbed.collect()
}

/// The inputs that vary beside those of every product.
#[derive(Debug, Clone, Copy)]
struct Varied {
    spins: bool,
    stops: bool,
}

/// Draws a sample: uniform, some inputs at an end of their range, those of stops as often as not, tilts rather small.
fn draw(random: &mut Random, Varied { spins, stops }: Varied) -> Sample {
    let corners = random.chance(0.5);
    let mut one = || match random.unit() {
        u if corners && u < 0.4 => f64::from(u < 0.2),
        _ => random.unit(),
    };
    let [a, b, c, d, e, f, g, h] = [0.0; 8].map(|_: f64| one());
    let mut sample = [a, b, c, d, e, f, g, h, if spins { one() } else { 0.0 }, 0.0, 0.0, 0.0];
    if random.chance(0.3) {
        sample[3] = sample[3].powi(4);
    }
    if stops {
        sample[9..].fill_with(|| match random.unit() {
            u if u < 0.5 => f64::from(u < 0.25),
            _ => random.unit(),
        });
    }
    sample
}

/// Makes random steps that shrink where they find nothing higher.
fn climb(
    start: (f64, Sample),
    tries: usize,
    Varied { spins, stops }: Varied,
    random: &mut Random,
    value: impl Fn(&Sample) -> f64,
) -> (f64, Sample) {
    let (mut top, mut reach) = (start, 0.1);
    for _ in 0..tries {
        let few = random.chance(0.5);
        let mut sample = top.1;
        for (i, x) in sample.iter_mut().enumerate() {
            let varies = i < 8 && i != 4 || i == 8 && spins || i > 8 && stops;
            if varies && !(few && random.chance(0.6)) {
                *x = (*x + reach * random.normal()).clamp(0.0, 1.0);
            }
        }
        let found = value(&sample);
        if found > top.0 {
            top = (found, sample);
            reach = (reach * 1.5_f64).min(0.3);
        } else {
            reach = (reach * 0.85_f64).max(1e-5);
        }
    }
    top
}

impl std::fmt::Display for Worst {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { part, kind, peak, impact, still: _, flat, drop, place, suspension } = self;
        write!(
            f,
            "{part} {}: {:.6e} after touch {impact} at {:.3} ms; {}{} first, tilt {:.6} deg, {:.5} m/s, e {:.5}",
            kind.name(),
            peak.value,
            peak.time * 1e3,
            if *flat { "flat, " } else { "" },
            if drop.b_first { 'b' } else { 'a' },
            drop.tilt.to_degrees(),
            drop.speed,
            drop.e
        )?;
        if let Some((_, time)) = drop.contact {
            write!(f, ", contact {:.5} ms", time * 1e3)?;
        }
        write!(f, ", at {:.3} mm", (place + drop.center) * 1e3)?;
        if let Some(Suspension { omega, zeta, stop }) = suspension {
            write!(f, ", {:.3} Hz, damping {zeta:.4}", omega / std::f64::consts::TAU)?;
            if let Some(Stop { gap, time, e }) = stop {
                write!(f, ", stops at {:.5} mm of {:.5} ms, e {e:.4}", gap * 1e3, time * 1e3)?;
            }
        }
        Ok(())
    }
}
