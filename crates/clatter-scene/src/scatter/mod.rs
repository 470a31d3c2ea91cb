//! Scatter: how likely each part survives when the drop, the casing and the parts are not known to the last digit.
//!
//! # Model
//! The gravity-free rung: a fall without spin, small tilt, the train of the map, for a center of mass anywhere. A part
//! on a suspension answers to velocity shocks, or, where an impact is not short beside its period, to half-sines of the
//! contact time; a hard-mounted one to the half-sine itself, π Δv/(2τ). Gravity, which lets slow impacts come sooner
//! and again, is left out: an assessment tells which parts need it.
//!
//! # Samples
//! Sample k draws its inputs from the counter (k, input) of Philox4x32-10 under the seed: it is the same alone, in any
//! run, on any number of threads and on any machine. Sums are made in blocks of fixed size, merged in order, so that
//! the answer is the same as well, and memory does not grow with the number of samples.

mod binomial;
mod clatter;
mod draw;
mod drivers;
mod philox;

use std::f64::consts::{FRAC_PI_2, TAU};

use ::clatter::End;
use ::clatter::flight::Body;
use clatter_shock::{DampingRatio, Extreme, Peaked, Pulse, Pulses, Shape, Suspension, VelocityShock, VelocityShocks};
use rayon::prelude::*;

use crate::models::{INSTANT_PULSE, lacks_contact_time};
use crate::{Boundary, Component, Fall, First, LimitKind, Mount, Product, ProductFile, Spread};
use clatter::{Clatter, Falling, LARGEST_DAMPING, Peaks, Swing};
use draw::Quantile;
use drivers::Sums;
use philox::Stream;

pub use binomial::{Probability, clopper_pearson};
pub use drivers::Share;

/// Why nothing can be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The product or a part.
    #[error(transparent)]
    Scene(#[from] crate::Error),
    /// A number of samples or a confidence that makes no sense.
    #[error("{name} = {value} is not {allowed}")]
    Setting {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A normal distribution whose range lies where it has no values.
    #[error(
        "{quantity}: less than 1 in 1e200 values of its normal distribution lie in its range: give a range around the mean"
    )]
    Tail {
        /// The quantity.
        quantity: String,
    },
    /// All mass in the center: the ends strike for ever without slowing down.
    #[error("with a radius of gyration of 0 the ends strike for ever; scatter needs one above 0")]
    Massless,
}

/// How to draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// How many drops.
    pub samples: u64,
    /// Another seed, other drops.
    pub seed: u64,
    /// Of all intervals, in (0, 1).
    pub confidence: f64,
}

/// What varies from sample to sample.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Input {
    /// Which end touches first: either is as likely.
    First,
    /// Height of the drop.
    Height,
    /// Speed at the first touch.
    Speed,
    /// Tilt at the first touch.
    Tilt,
    /// Coefficient of restitution.
    Restitution,
    /// Natural frequency of a component, by its index.
    Frequency(usize),
}

impl Input {
    /// `first`, `height`, `speed`, `tilt`, `restitution` or `natural-frequency`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Height => "height",
            Self::Speed => "speed",
            Self::Tilt => "tilt",
            Self::Restitution => "restitution",
            Self::Frequency(_) => "natural-frequency",
        }
    }
}

/// What came of all samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Scatter {
    /// How they were drawn.
    pub settings: Settings,
    /// The inputs that vary; without any, all samples are one.
    pub inputs: Vec<Input>,
    /// Inputs given as a range with no distribution, taken as equally likely all over it.
    pub assumed_even: Vec<Input>,
    /// Probability that every component survives.
    pub survival: Probability,
    /// In the order of the file.
    pub components: Vec<ComponentScatter>,
}

/// What came of one component.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentScatter {
    /// Its name.
    pub name: String,
    /// Samples in which a limit did not hold.
    pub failures: u64,
    /// Probability that all of its limits hold.
    pub survival: Probability,
    /// Failures by limit: one sample may count at several.
    pub limits: Vec<(LimitKind, u64)>,
    /// Mean of the utilization, the largest demand over allowed.
    pub mean_utilization: f64,
    /// Its standard deviation.
    pub utilization_deviation: f64,
    /// The largest seen.
    pub largest_utilization: f64,
    /// The sample it was seen in, from 0.
    pub worst_sample: u64,
    /// What drives the utilization, the strongest first; empty where it does not vary or too few samples were drawn to
    /// tell.
    pub drivers: Vec<Driver>,
}

/// An input and what it does.
#[derive(Debug, Clone, PartialEq)]
pub struct Driver {
    /// Which.
    pub input: Input,
    /// Its share of the variance and its trend.
    pub share: Share,
}

/// Samples of one block; sums are made within blocks and then over blocks, in order.
const BLOCK: u64 = 4096;
/// Samples at most.
const MOST_SAMPLES: u64 = 1_000_000_000_000;

/// Tilts of the search of [`Sampler::worst`].
const TILTS: u32 = 33;
/// Beyond what fast peaks are off by, 1e-9, by which bounds are taken as higher.
const SLACK: f64 = 1e-8;
/// Inputs that every product has: uniform numbers 0 to 3; those of the components' frequencies follow.
const SHARED: usize = 4;

/// The ends of a range and its median, as probabilities.
fn three(quantile: &Quantile) -> &'static [f64] {
    if quantile.is_value() { &[0.5] } else { &[0.0, 0.5, 1.0] }
}

/// A drop of the search of [`Sampler::worst`].
#[derive(Debug, Clone, Copy)]
struct Corner {
    bar: Falling,
    /// −1 where end b strikes first.
    mirror: f64,
    speed_m_s: f64,
    tilt_rad: f64,
}

/// Draws samples of a product.
#[derive(Debug)]
pub struct Sampler {
    settings: Settings,
    /// By the end that strikes first.
    bars: [Falling; 2],
    length_m: f64,
    /// The ends that may strike first.
    first: &'static [End],
    fall: Quantile,
    /// 2g where the fall is a height: v = √(2gh).
    twice_gravity: Option<f64>,
    tilt: Quantile,
    restitution: Quantile,
    parts: Vec<Part>,
    fastest: f64,
    inputs: Vec<Input>,
    assumed_even: Vec<Input>,
}

/// A component as it is sampled.
#[derive(Debug)]
struct Part {
    name: String,
    /// Signed positions of its ends, end a at −1.
    places: Vec<f64>,
    mount: Held,
    limits: Vec<(LimitKind, Allowed)>,
    /// Its own inputs among those that vary.
    inputs: Vec<Input>,
}

/// What a component stands, limit by limit, in the terms of the gravity-free rung.
pub(crate) fn limits(product: &Product, component: &Component) -> Vec<(LimitKind, Allowed)> {
    let limits = &component.limits;
    let hard = matches!(component.mount, Mount::Hard);
    // A half-sine of the contact time with the area Δv has the amplitude π Δv/(2τ).
    let as_shock = |acceleration: f64| acceleration * product.contact_time_s.unwrap_or(f64::INFINITY) / FRAC_PI_2;
    let acceleration = |a| if hard { Allowed::Shock(as_shock(a)) } else { Allowed::Acceleration(a) };
    // damage only beyond both
    let beyond = |b: Boundary| match product.contact_time_s {
        Some(_) => b.velocity_change_m_s.max(as_shock(b.acceleration_m_s2)),
        None => b.velocity_change_m_s,
    };
    let list = [
        (LimitKind::Acceleration, limits.acceleration_m_s2.map(acceleration)),
        (LimitKind::RattleSpace, limits.rattle_space_m.filter(|_| !hard).map(Allowed::Displacement)),
        (LimitKind::VelocityChange, limits.velocity_change_m_s.map(Allowed::Shock)),
        (LimitKind::AngularVelocityChange, limits.angular_velocity_change_rad_s.map(Allowed::Turn)),
        (LimitKind::DamageBoundary, limits.damage_boundary.map(|b| Allowed::Shock(beyond(b)))),
    ];
    list.into_iter().filter_map(|(kind, allowed)| Some((kind, allowed?))).collect()
}

/// How a part answers.
#[derive(Debug)]
enum Held {
    Hard,
    Soft(Box<Soft>),
}

/// On a suspension.
#[derive(Debug)]
struct Soft {
    frequency_hz: Quantile,
    zeta: f64,
    /// Where it swings.
    swing: Option<Swing>,
    /// Length of a pulse, where it counts.
    pulse_s: Option<f64>,
    /// The quantities that have limits.
    asked: Vec<Peaked>,
}

/// A limit, as what a demand is divided by.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Allowed {
    /// On the response of a suspended part.
    Displacement(f64),
    Acceleration(f64),
    /// On the largest velocity shock at the place, in m/s; a limit on the acceleration of an impact's pulse is one.
    Shock(f64),
    /// On the largest change of angular velocity.
    Turn(f64),
}

/// Names and values of one block of samples, and how far the sampling has come.
#[derive(Debug)]
pub struct Progress<'a> {
    /// Samples drawn so far.
    pub done: u64,
    /// One after the other, those since the last call: for each, the values of [`Sampler::columns`].
    pub values: &'a [f64],
}

/// What a column of [`Progress::values`] holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// 0: end a touches first; 1: end b.
    First,
    /// Speed at the first touch, in m/s.
    SpeedMS,
    /// Tilt in degrees.
    TiltDeg,
    /// Coefficient of restitution.
    Restitution,
    /// Natural frequency of a component, by its index, in Hz; only for those on a suspension.
    FrequencyHz(usize),
    /// Utilization of a component, by its index: the largest demand over allowed. It survives up to 1.
    Utilization(usize),
}

impl Sampler {
    /// Checks everything before anything is drawn.
    ///
    /// # Errors
    /// [`Error`].
    pub fn new(file: &ProductFile, settings: Settings) -> Result<Self, Error> {
        let Settings { samples, confidence, .. } = settings;
        if !(1..=MOST_SAMPLES).contains(&samples) {
            #[expect(clippy::cast_precision_loss, reason = "only shown in a message")]
            let value = samples as f64;
            return Err(Error::Setting { name: "samples", value, allowed: "in 1 ..= 1e12" });
        }
        if !(confidence > 0.0 && confidence < 1.0) {
            return Err(Error::Setting { name: "confidence", value: confidence, allowed: "in (0, 1)" });
        }
        let (product, drop) = (&file.product, &file.drop);
        if product.body.gyration_m() <= 0.0 {
            return Err(Error::Massless);
        }
        let mut varied = Varied::default();
        if drop.first == First::Either {
            varied.inputs.push(Input::First);
        }
        let (fall, twice_gravity) = match &drop.fall {
            Fall::HeightM(height) => (varied.quantile(Input::Height, height, "height")?, Some(2.0 * drop.gravity_m_s2)),
            Fall::SpeedMS(speed) => (varied.quantile(Input::Speed, speed, "speed")?, None),
        };
        let tilt = varied.quantile(Input::Tilt, &drop.tilt_rad, "tilt")?;
        let restitution = varied.quantile(Input::Restitution, &product.restitution, "restitution")?;
        let shared = varied.inputs.clone();
        let mut parts = Vec::new();
        let mut fastest = 1.0_f64;
        for (i, component) in file.components.iter().enumerate() {
            if let Some(reason) = lacks_contact_time(product, component) {
                return Err(crate::Error::ContactTime { component: component.name.clone(), reason }.into());
            }
            if let Mount::Suspended { frequency_hz, .. } = component.mount {
                fastest = fastest.max(TAU * frequency_hz.hi());
            }
            parts.push(Part::new(file, i, component, &shared, &mut varied)?);
        }
        Ok(Self {
            settings,
            bars: [Falling::new(&product.body, End::A), Falling::new(&product.body, End::B)],
            length_m: product.body.length_m(),
            first: drop.first_ends(),
            fall,
            twice_gravity,
            tilt,
            restitution,
            parts,
            fastest,
            inputs: varied.inputs,
            assumed_even: varied.assumed_even,
        })
    }

    /// What each sample of [`Progress::values`] consists of.
    #[must_use]
    pub fn columns(&self) -> Vec<Column> {
        let soft = |part: &Part| matches!(part.mount, Held::Soft(_));
        let frequencies =
            self.parts.iter().enumerate().filter(|(_, part)| soft(part)).map(|(i, _)| Column::FrequencyHz(i));
        let shared = [Column::First, Column::SpeedMS, Column::TiltDeg, Column::Restitution];
        shared.into_iter().chain(frequencies).chain((0..self.parts.len()).map(Column::Utilization)).collect()
    }

    /// Draws all samples on the threads of the current pool. `watch` is called in order, on this thread, with all
    /// samples where `keep` asks for them; where it fails, no more are drawn.
    ///
    /// # Errors
    /// Those of `watch`.
    pub fn run<E>(&self, keep: bool, mut watch: impl FnMut(&Progress<'_>) -> Result<(), E>) -> Result<Scatter, E> {
        let Settings { samples, .. } = self.settings;
        // y of the first sample: the others are counted from there
        let near = self.block(0, 1, true, &vec![0.0; self.parts.len()]).values;
        let near = &near[near.len() - self.parts.len()..];
        let near: Vec<f64> = near.iter().map(|y| if y.is_finite() { *y } else { 0.0 }).collect();
        let blocks = samples.div_ceil(BLOCK);
        let together = 4 * rayon::current_num_threads() as u64;
        let mut total: Option<Vec<Tally>> = None;
        let mut survived = 0;
        let mut next = 0;
        while next < blocks {
            let until = blocks.min(next + together);
            let drawn: Vec<Block> = (next..until)
                .into_par_iter()
                .map(|b| self.block(b * BLOCK, samples.min((b + 1) * BLOCK), keep, &near))
                .collect();
            for (block, b) in drawn.into_iter().zip(next..) {
                survived += block.survived;
                match &mut total {
                    Some(total) => total.iter_mut().zip(&block.tallies).for_each(|(sum, later)| sum.merge(later)),
                    None => total = Some(block.tallies),
                }
                watch(&Progress { done: samples.min((b + 1) * BLOCK), values: &block.values })?;
            }
            next = until;
        }
        let confidence = self.settings.confidence;
        let components = self.parts.iter().zip(total.unwrap_or_default());
        Ok(Scatter {
            settings: self.settings,
            inputs: self.inputs.clone(),
            assumed_even: self.assumed_even.clone(),
            survival: clopper_pearson(survived, samples, confidence),
            components: components.map(|(part, tally)| part.summary(&tally, self.settings)).collect(),
        })
    }

    /// The largest utilization of each part over all ranges but that of e, by drops at [`TILTS`] tilts and the ends and
    /// medians of the other ranges.
    ///
    /// Pulses of one shape and length do a mean, over that length, of what impulses do, and never more: only drops
    /// whose impulses pass the worst so far are followed with pulses.
    pub(crate) fn worst(&self, body: &Body, e: f64) -> Vec<f64> {
        let corners = self.corners(body);
        let follow = |clatter: &mut Clatter, corner: &Corner| {
            clatter.follow(&corner.bar, e, corner.speed_m_s, corner.tilt_rad, self.fastest);
        };
        let (mut clatter, mut bounds) = (Clatter::default(), vec![Vec::new(); self.parts.len()]);
        for corner in &corners {
            follow(&mut clatter, corner);
            for (part, bounds) in self.parts.iter().zip(&mut bounds) {
                bounds.extend(part.mount.corners().iter().map(|&own| {
                    let at_most = |peaks: &mut Peaks, s| part.mount.raise_to_bound(peaks, &clatter, s, own);
                    (part.utilization(&clatter, corner.mirror, self.length_m, at_most, |_| ()), corner, own)
                }));
            }
        }
        let mut worst = vec![0.0_f64; self.parts.len()];
        for ((part, worst), mut bounds) in self.parts.iter().zip(&mut worst).zip(bounds) {
            bounds.sort_by(|(a, ..), (b, ..)| b.total_cmp(a));
            for (bound, corner, own) in bounds {
                if bound * (1.0 + SLACK) <= *worst {
                    break;
                }
                follow(&mut clatter, corner);
                let peaks = |peaks: &mut Peaks, s| part.mount.raise(peaks, &clatter, s, own);
                *worst = worst.max(part.utilization(&clatter, corner.mirror, self.length_m, peaks, |_| ()));
            }
        }
        worst
    }

    /// Drops at [`TILTS`] tilts and the ends and medians of the speeds.
    fn corners(&self, body: &Body) -> Vec<Corner> {
        let tilts = if self.tilt.is_value() { 1 } else { TILTS };
        let mut corners = Vec::new();
        for &end in self.first {
            let (bar, mirror) = (Falling::new(body, end), if end == End::A { 1.0 } else { -1.0 });
            for &u in three(&self.fall) {
                let speed_m_s = self.speed(u);
                corners.extend((0..tilts).map(|i| {
                    let tilt_rad = self.tilt.at(f64::from(i) / f64::from(TILTS - 1));
                    Corner { bar, mirror, speed_m_s, tilt_rad }
                }));
            }
        }
        corners
    }

    fn speed(&self, u: f64) -> f64 {
        let fall = self.fall.at(u);
        self.twice_gravity.map_or(fall, |twice| (twice * fall).sqrt())
    }

    /// Samples `from` .. `to`.
    fn block(&self, from: u64, to: u64, keep: bool, near: &[f64]) -> Block {
        let mut tallies: Vec<Tally> = self.parts.iter().zip(near).map(|(part, y)| Tally::new(part, *y)).collect();
        let (mut survived, mut values) = (0, Vec::new());
        let mut uniforms = vec![0.0; SHARED + self.parts.len()];
        let mut utilizations = vec![0.0; self.parts.len()];
        let mut clatter = Clatter::default();
        for sample in from..to {
            Stream::new(self.settings.seed, sample).fill(&mut uniforms);
            let first = match *self.first {
                [end] => end,
                _ if uniforms[0] < 0.5 => End::A,
                _ => End::B,
            };
            let speed = self.speed(uniforms[1]);
            let (tilt, e) = (self.tilt.at(uniforms[2]), self.restitution.at(uniforms[3]));
            let (bar, mirror) = if first == End::A { (&self.bars[0], 1.0) } else { (&self.bars[1], -1.0) };
            clatter.follow(bar, e, speed, tilt, self.fastest);
            let mut all = true;
            for (i, part) in self.parts.iter().enumerate() {
                let own = uniforms[SHARED + i];
                let peaks = |peaks: &mut Peaks, s| part.mount.raise(peaks, &clatter, s, own);
                let failures = &mut tallies[i].limits;
                let utilization = part.utilization(&clatter, mirror, self.length_m, peaks, |k| failures[k] += 1);
                tallies[i].add(sample, utilization, part.ranks(&uniforms, own));
                all &= utilization <= 1.0;
                utilizations[i] = utilization;
            }
            survived += u64::from(all);
            if keep {
                values.extend([if first == End::A { 0.0 } else { 1.0 }, speed, tilt.to_degrees(), e]);
                values.extend(self.parts.iter().zip(&uniforms[SHARED..]).filter_map(|(part, u)| part.frequency_hz(*u)));
                values.extend(&utilizations);
            }
        }
        Block { tallies, survived, values }
    }
}

/// The inputs that vary, as they are found.
#[derive(Debug, Default)]
struct Varied {
    inputs: Vec<Input>,
    assumed_even: Vec<Input>,
}

impl Varied {
    fn quantile(&mut self, input: Input, spread: &Spread, quantity: &str) -> Result<Quantile, Error> {
        if spread.law() == crate::Law::Range {
            self.assumed_even.push(input.clone());
        }
        if !spread.is_value() {
            self.inputs.push(input);
        }
        Quantile::new(spread).ok_or_else(|| Error::Tail { quantity: quantity.to_owned() })
    }
}

impl Part {
    fn new(
        file: &ProductFile,
        index: usize,
        component: &Component,
        shared: &[Input],
        varied: &mut Varied,
    ) -> Result<Self, Error> {
        let contact_s = file.product.contact_time_s;
        let mut inputs = shared.to_vec();
        let mount = match component.mount {
            Mount::Hard => Held::Hard,
            Mount::Suspended { frequency_hz, damping } => {
                if !frequency_hz.is_value() {
                    inputs.push(Input::Frequency(index));
                }
                let quantity = format!("natural frequency of {:?}", component.name);
                let long = |contact: &f64| TAU * frequency_hz.hi() * contact > INSTANT_PULSE;
                let zeta = damping.get();
                let suspension = Suspension::from_hz(frequency_hz.hi(), damping).map_err(crate::Error::from)?;
                Held::Soft(Box::new(Soft {
                    frequency_hz: varied.quantile(Input::Frequency(index), &frequency_hz, &quantity)?,
                    zeta,
                    swing: (zeta < LARGEST_DAMPING).then(|| Swing::new(suspension.damping().get())),
                    pulse_s: contact_s.filter(long),
                    asked: [
                        component.limits.acceleration_m_s2.map(|_| Peaked::AccelerationOverOmega),
                        component.limits.rattle_space_m.map(|_| Peaked::PseudoVelocity),
                    ]
                    .into_iter()
                    .flatten()
                    .collect(),
                }))
            }
        };
        Ok(Self {
            name: component.name.clone(),
            places: component.ends_m().iter().map(|x| file.product.relative(*x)).collect(),
            mount,
            limits: limits(&file.product, component),
            inputs,
        })
    }

    fn frequency_hz(&self, own: f64) -> Option<f64> {
        match &self.mount {
            Held::Hard => None,
            Held::Soft(soft) => Some(soft.frequency_hz.at(own)),
        }
    }

    /// Ranks of this part's inputs.
    fn ranks<'a>(&'a self, uniforms: &'a [f64], own: f64) -> impl Iterator<Item = f64> + 'a {
        self.inputs.iter().map(move |input| match input {
            Input::First => uniforms[0],
            Input::Height | Input::Speed => uniforms[1],
            Input::Tilt => uniforms[2],
            Input::Restitution => uniforms[3],
            Input::Frequency(_) => own,
        })
    }

    /// The largest demand over allowed, by what raises peaks to those at a position; told which limits do not hold.
    fn utilization(
        &self,
        clatter: &Clatter,
        mirror: f64,
        length_m: f64,
        raise: impl Fn(&mut Peaks, f64),
        mut fails: impl FnMut(usize),
    ) -> f64 {
        let mut shock = 0.0_f64;
        let mut peaks = Peaks::default();
        let shaken = self.limits.iter().any(|(_, allowed)| matches!(allowed, Allowed::Shock(_)));
        for place in &self.places {
            let s = mirror * place;
            if shaken {
                shock = shock.max(clatter.largest_shock(s));
            }
            raise(&mut peaks, s);
        }
        let mut most = 0.0_f64;
        for (k, (_, allowed)) in self.limits.iter().enumerate() {
            let used = match *allowed {
                Allowed::Displacement(z) => peaks.displacement / z,
                Allowed::Acceleration(a) => peaks.acceleration / a,
                Allowed::Shock(v) => shock / v,
                Allowed::Turn(w) => clatter.largest_turn(length_m) / w,
            };
            if used > 1.0 {
                fails(k);
            }
            most = most.max(used);
        }
        most
    }

    fn summary(&self, tally: &Tally, settings: Settings) -> ComponentScatter {
        let Settings { samples, confidence, .. } = settings;
        let shares = tally.sums.shares().unwrap_or_default();
        let mut drivers: Vec<Driver> =
            self.inputs.iter().zip(shares).map(|(input, share)| Driver { input: input.clone(), share }).collect();
        drivers.sort_by(|a, b| b.share.variance.total_cmp(&a.share.variance));
        ComponentScatter {
            name: self.name.clone(),
            failures: tally.failures,
            survival: clopper_pearson(samples - tally.failures, samples, confidence),
            limits: self.limits.iter().zip(&tally.limits).map(|((kind, _), failures)| (*kind, *failures)).collect(),
            mean_utilization: tally.sums.mean(),
            utilization_deviation: tally.sums.deviation(),
            largest_utilization: tally.largest,
            worst_sample: tally.worst,
            drivers,
        }
    }
}

impl Held {
    /// The ends and the median of its frequencies.
    fn corners(&self) -> &'static [f64] {
        match self {
            Self::Hard => &[0.5],
            Self::Soft(soft) => three(&soft.frequency_hz),
        }
    }

    /// Raises peaks to those at a position, in the quantities that have limits.
    fn raise(&self, peaks: &mut Peaks, clatter: &Clatter, s: f64, own: f64) {
        match self {
            Self::Soft(soft) if soft.pulse_s.is_some() => soft.raise(peaks, clatter, s, own),
            _ => self.raise_to_bound(peaks, clatter, s, own),
        }
    }

    /// The same by impulses, whose peaks those of pulses do not pass.
    fn raise_to_bound(&self, peaks: &mut Peaks, clatter: &Clatter, s: f64, own: f64) {
        let Self::Soft(soft) = self else { return };
        match &soft.swing {
            _ if soft.asked.is_empty() => {}
            Some(swing) => peaks.raise(&clatter.peaks(s, TAU * soft.frequency_hz.at(own), swing)),
            None => soft.raise(peaks, clatter, s, own),
        }
    }
}

impl Soft {
    /// By the exact response, of a part that hardly swings or for which an impact takes its time.
    fn raise(&self, peaks: &mut Peaks, clatter: &Clatter, s: f64, own: f64) {
        let omega = TAU * self.frequency_hz.at(own);
        let Ok(suspension) = DampingRatio::new(self.zeta).and_then(|zeta| Suspension::new(omega, zeta)) else {
            unreachable!("the frequency and the damping were accepted before")
        };
        let shocks = clatter.shocks_at(s);
        let raised = match self.pulse_s {
            Some(duration) => {
                let pulse = |(start, delta_v): (f64, f64)| Pulse {
                    shape: Shape::HalfSine,
                    amplitude: FRAC_PI_2 * delta_v / duration,
                    duration,
                    start,
                };
                Pulses::new(&shocks.map(pulse).collect::<Vec<_>>())
                    .map(|pulses| self.raise_by(peaks, omega, |of, above| pulses.peak_above(&suspension, of, above)))
            }
            None => VelocityShocks::new(shocks.map(|(time, delta_v)| VelocityShock { time, delta_v }).collect())
                .map(|shocks| self.raise_by(peaks, omega, |of, above| shocks.peak_above(&suspension, of, above))),
        };
        let Ok(()) = raised else { unreachable!("shocks of a train are finite and in order") };
    }

    /// Raises peaks to those of a response that passes them.
    fn raise_by(&self, peaks: &mut Peaks, omega: f64, peak_above: impl Fn(Peaked, f64) -> Option<Extreme>) {
        for &asked in &self.asked {
            let (peak, unit) = match asked {
                Peaked::PseudoVelocity => (&mut peaks.displacement, 1.0 / omega),
                Peaked::AccelerationOverOmega => (&mut peaks.acceleration, omega),
            };
            if let Some(higher) = peak_above(asked, *peak / unit) {
                *peak = unit * higher.value.abs();
            }
        }
    }
}

/// What came of one block.
#[derive(Debug)]
struct Block {
    tallies: Vec<Tally>,
    survived: u64,
    values: Vec<f64>,
}

/// What came of one component, so far.
#[derive(Debug)]
struct Tally {
    failures: u64,
    limits: Vec<u64>,
    sums: Sums,
    largest: f64,
    worst: u64,
}

impl Tally {
    fn new(part: &Part, near: f64) -> Self {
        let sums = Sums::new(near, part.inputs.len());
        Self { failures: 0, limits: vec![0; part.limits.len()], sums, largest: -1.0, worst: 0 }
    }

    fn add(&mut self, sample: u64, utilization: f64, ranks: impl Iterator<Item = f64>) {
        self.failures += u64::from(utilization > 1.0);
        self.sums.add(utilization, ranks);
        if utilization > self.largest {
            (self.largest, self.worst) = (utilization, sample);
        }
    }

    fn merge(&mut self, later: &Self) {
        self.failures += later.failures;
        self.limits.iter_mut().zip(&later.limits).for_each(|(sum, later)| *sum += later);
        self.sums.merge(&later.sums);
        if later.largest > self.largest {
            (self.largest, self.worst) = (later.largest, later.worst);
        }
    }
}
