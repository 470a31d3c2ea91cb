//! Scatter: how likely each part survives when the drop, the casing and the parts are not known to the last digit.
//!
//! # Model
//! A sample is answered as any other drop is: by the model with the most physics that the data allow, contacts that take time
//! where their time is known, else instant impacts at real tilt with gravity. Where many samples are drawn, a [`Pilot`] measures
//! on some of them what the closed form gets wrong: instant impacts, small tilt, no gravity. It is taken only where its worst error
//! is at most 5 %, and then only for parts whose utilization is farther than that error from 1. The others are answered by the
//! fuller model as well.
//!
//! # Intervals
//! An interval holds the probability by the model with the most physics with the stated confidence. Three things widen it:
//! - the number of samples, by the interval of Clopper and Pearson;
//! - what answers may be off by. A sample whose utilization is so near 1 that the error told by the model decides it counts as a
//!   failure for the lower end and as none for the upper. A sample that is not answered is treated alike;
//! - where the closed form is taken, the share of drops that may be off by more than all drops of the pilot were, on both sides. The
//!   pilot and the samples each may be misled with half of the probability that the confidence leaves.
//!
//! Where a body lands after it has bounced clear is sensitive to every input. What such a landing asks in one sample may differ from
//! one tolerance to another; how many samples fail does not.
//!
//! # Samples
//! Input i of sample k is the counter (k, i) of Philox4x32-10 under the seed: it is the same alone, in any run, on any number of
//! threads and on any machine. Sums are made in blocks of fixed size, merged in order, so that the answer is the same as well,
//! and memory does not grow with the number of samples.

mod binomial;
mod closed;
mod draw;
mod drivers;
mod extremes;
mod full;
mod philox;
mod pilot;
mod sample;
mod swing;
mod tally;

use rayon::prelude::*;

use crate::{Component, LimitKind, Model, ProductFile};
use closed::Closed;
use full::Followings;
use sample::Inputs;
use tally::{Count, Tally};

pub use binomial::{Probability, clopper_pearson};
pub use drivers::Share;
pub use extremes::{Extremes, extremes};
pub use pilot::Pilot;
pub use sample::Input;

/// Why nothing can be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The product or a part.
    #[error(transparent)]
    Product(#[from] crate::Error),
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

/// What came of all samples.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Scatter {
    /// How they were drawn.
    pub settings: Settings,
    /// The model that answered them: [`Model::Map`] is the closed form.
    pub model: Model,
    /// Samples that the fuller model answered as well, being near a limit by the closed form.
    pub refined: u64,
    /// What the closed form gets wrong; none where it was not tried: for few samples, and for damping ratios from 0.95 on.
    pub pilot: Option<Pilot>,
    /// The inputs that vary; without any, all samples are one.
    pub inputs: Vec<Input>,
    /// Inputs given as a range with no distribution, taken as equally likely all over it.
    pub assumed_even: Vec<Input>,
    /// Probability that every component survives; `at_least` is what a target is held against.
    pub survival: Probability,
    /// Samples in which a component was not answered. They count as failures, except for the upper ends of intervals.
    pub unanswered: u64,
    /// Why the first of them was not.
    pub reason: Option<crate::Error>,
    /// In the order of the file.
    pub components: Vec<ComponentScatter>,
}

/// What came of one component.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ComponentScatter {
    /// Its name.
    pub name: String,
    /// Samples in which a limit did not hold.
    pub failures: u64,
    /// Samples, failures or not, whose utilization is so near 1 that what it may be off by decides.
    pub open: u64,
    /// Samples that the model does not answer.
    pub unanswered: u64,
    /// Probability that all of its limits hold.
    pub survival: Probability,
    /// Failures by limit: one sample may count at several.
    pub limits: Vec<(LimitKind, u64)>,
    /// Mean of the utilization, the largest demand over allowed, of the samples that were answered; NaN where none was.
    pub mean_utilization: f64,
    /// Its standard deviation.
    pub utilization_deviation: f64,
    /// The largest seen.
    pub largest_utilization: f64,
    /// The sample it was seen in, from 0; none where none was answered.
    pub worst_sample: Option<u64>,
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

/// Values of some samples, and how far the sampling has come.
#[derive(Debug)]
pub struct Progress<'a> {
    /// Samples drawn so far.
    pub done: u64,
    /// One after the other, those since the last call: for each, the values of [`Sampler::columns`].
    pub values: &'a [f64],
}

/// What a column of [`Progress::values`] holds; parts by their index in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Column {
    /// 0: end a touches first; 1: end b.
    First,
    /// Speed at the first touch, in m/s.
    SpeedMS,
    /// Tilt in degrees.
    TiltDeg,
    /// Coefficient of restitution.
    Restitution,
    /// Contact time in s, of a product that has one.
    ContactTimeS,
    /// Natural frequency of a part on a suspension, in Hz.
    FrequencyHz(usize),
    /// Damping ratio of a part, where it varies.
    DampingRatio(usize),
    /// Where the middle of a part is, in m, where it varies.
    PositionM(usize),
    /// A limit of a part in the unit of its kind, where it varies.
    Limit(usize, LimitKind),
    /// The critical acceleration of the damage boundary of a part in m/s², where it varies.
    CriticalAccelerationMS2(usize),
    /// Utilization of a part: the largest demand over allowed. It survives up to 1. NaN where the model has no answer.
    Utilization(usize),
}

/// What a sample asks of a part.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Asked {
    /// The largest demand over allowed of its limits.
    utilization: f64,
    /// What that is at least and at most, by what it may be off by.
    within: [f64; 2],
    /// Which of its limits do not hold.
    fails: [bool; 5],
}

impl Asked {
    /// Takes in what one limit is asked, which may be off by a share.
    fn raise(&mut self, limit: usize, used: f64, error: f64) {
        self.utilization = self.utilization.max(used);
        self.within[0] = self.within[0].max(used / (1.0 + error));
        self.within[1] = self.within[1].max(used * (1.0 + error));
        self.fails[limit] |= used > 1.0;
    }
    /// Whether what it may be off by decides if it survives.
    fn is_open(&self) -> bool {
        self.within[0] <= 1.0 && self.within[1] > 1.0
    }
    /// The same, of an answer that may be off by this share.
    fn off_by(self, error: f64) -> Self {
        Self { within: [self.utilization / (1.0 + error), self.utilization * (1.0 + error)], ..self }
    }
}

/// Samples of one block; sums are made within blocks and then over blocks, in order.
const BLOCK: u64 = 1024;
/// Samples at most.
const MOST_SAMPLES: u64 = 1_000_000_000_000;

/// Draws samples of a product.
#[derive(Debug)]
pub struct Sampler {
    settings: Settings,
    inputs: Inputs,
    components: Vec<Component>,
    body: clatter_flight::Body,
    fullest: Model,
    /// Whether the closed form has an answer for every sample.
    takes_closed: bool,
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
        let inputs = Inputs::new(file)?;
        let fullest = inputs.blank().drop.fullest();
        Ok(Self {
            settings,
            inputs,
            components: file.components.clone(),
            body: file.product.body,
            fullest,
            takes_closed: Closed::takes(file),
        })
    }

    /// What each sample of [`Progress::values`] consists of.
    #[must_use]
    pub fn columns(&self) -> Vec<Column> {
        self.inputs.columns()
    }

    /// Draws all samples on the threads of the current pool, after the pilot where one is worth while. `watch` is called in
    /// order, on this thread, with all samples where `keep` asks for them. Where it says `false` no more are drawn: the answer is
    /// that of the samples so far, as many as its settings say.
    ///
    /// # Errors
    /// Those of `watch`.
    pub fn run<E>(&self, keep: bool, mut watch: impl FnMut(&Progress<'_>) -> Result<bool, E>) -> Result<Scatter, E> {
        let Settings { samples, confidence, .. } = self.settings;
        let pilot = self.pilot();
        let taken = pilot.filter(|pilot| pilot.taken);
        let near = self.near(taken.as_ref());
        let blocks = samples.div_ceil(BLOCK);
        let together = 4 * rayon::current_num_threads() as u64;
        let mut total = self.tallies(&near);
        let (mut all, mut refined, mut reason) = (Count::default(), 0, None);
        let (mut next, mut drawn_so_far) = (0, 0);
        'drawing: while next < blocks {
            let until = blocks.min(next + together);
            let drawn: Vec<Block> = (next..until)
                .into_par_iter()
                .map(|b| self.block([b * BLOCK, samples.min((b + 1) * BLOCK)], taken.as_ref(), keep, &near))
                .collect();
            for (block, b) in drawn.into_iter().zip(next..) {
                all.merge(&block.all);
                refined += block.refined;
                reason = reason.or(block.reason);
                total.iter_mut().zip(&block.tallies).for_each(|(sum, later)| sum.merge(later));
                drawn_so_far = samples.min((b + 1) * BLOCK);
                if !watch(&Progress { done: drawn_so_far, values: &block.values })? {
                    break 'drawing;
                }
            }
            next = until;
        }
        let settings = Settings { samples: drawn_so_far, ..self.settings };
        let [confidence, share] = taken.map_or([confidence, 0.0], |pilot| [pilot.confidence, pilot.share]);
        let each = self.components.iter().zip(total.iter().zip(&self.inputs.of_part));
        let summary = |(component, (tally, own)): (&Component, (&Tally, &Vec<usize>))| {
            tally.summary(component, &self.inputs, own, &settings, [confidence, share])
        };
        Ok(Scatter {
            settings,
            model: if taken.is_some() { Model::Map } else { self.fullest },
            refined,
            pilot,
            inputs: self.inputs.varied.clone(),
            assumed_even: self.inputs.assumed_even.clone(),
            survival: all.survival(settings.samples, confidence, share),
            unanswered: all.unanswered,
            reason,
            components: each.map(summary).collect(),
        })
    }

    /// The closed form beside the fullest model, on the first samples; none where few are asked for or it takes none.
    fn pilot(&self) -> Option<Pilot> {
        let Settings { samples, seed, confidence } = self.settings;
        let tried = self.takes_closed && samples >= pilot::LEAST_SAMPLES;
        let error = |k| {
            let mut sample = self.inputs.blank();
            if self.inputs.draw(seed, k, &mut sample).is_err() {
                return f64::INFINITY;
            }
            let (mut cheap, mut full) = (Vec::new(), Vec::new());
            Closed::new(&self.body).answer(&sample, &mut cheap);
            full::answer(&sample, &mut full);
            pilot::error(&cheap, &full)
        };
        // Half of the doubt is left to the samples.
        tried.then(|| Pilot::of(samples, 0.5 * (1.0 + confidence), error))
    }

    fn tallies(&self, near: &[f64]) -> Vec<Tally> {
        let each = self.components.iter().zip(&self.inputs.of_part).zip(near);
        each.map(|((component, own), near)| Tally::new(component, own.len(), *near)).collect()
    }

    /// The utilizations of the first sample: sums count from there.
    fn near(&self, closed: Option<&Pilot>) -> Vec<f64> {
        let none = vec![0.0; self.components.len()];
        let values = self.block([0, 1], closed, true, &none).values;
        let utilizations = &values[values.len() - none.len()..];
        utilizations.iter().map(|y| if y.is_finite() { *y } else { 0.0 }).collect()
    }

    /// Samples from .. to, in closed form where a pilot allows it.
    fn block(&self, [from, to]: [u64; 2], closed: Option<&Pilot>, keep: bool, near: &[f64]) -> Block {
        let tallies = self.tallies(near);
        let mut block = Block { tallies, all: Count::default(), refined: 0, reason: None, values: Vec::new() };
        let columns = if keep { self.columns() } else { Vec::new() };
        let (mut sample, mut form) = (self.inputs.blank(), Closed::new(&self.body));
        let (mut cheap, mut asked) = (Vec::new(), Vec::new());
        for k in from..to {
            if let Err(error) = self.inputs.draw(self.settings.seed, k, &mut sample) {
                asked.clear();
                asked.resize(self.components.len(), Err(error));
            } else if let Some(pilot) = closed {
                form.answer(&sample, &mut cheap);
                let near = |asked: &Asked| asked.off_by(pilot.worst_error).is_open();
                block.refined += u64::from(cheap.iter().any(near));
                let mut fuller = Followings::of(&sample.drop);
                asked.clear();
                let each = cheap.iter().zip(&sample.parts);
                asked.extend(each.map(|(asked, part)| if near(asked) { fuller.answer(part) } else { Ok(*asked) }));
            } else {
                full::answer(&sample, &mut asked);
            }
            block.take(k, &asked, &self.inputs, &sample.uniforms);
            block.values.extend(columns.iter().map(|column| match column {
                Column::Utilization(i) => asked[*i].as_ref().map_or(f64::NAN, |asked| asked.utilization),
                other => sample.value(*other),
            }));
        }
        block
    }
}

/// What came of one block.
#[derive(Debug)]
struct Block {
    tallies: Vec<Tally>,
    all: Count,
    refined: u64,
    reason: Option<crate::Error>,
    values: Vec<f64>,
}

impl Block {
    fn take(&mut self, k: u64, asked: &[Result<Asked, crate::Error>], inputs: &Inputs, uniforms: &[f64]) {
        let mut most = Some(Asked::default());
        for ((asked, tally), own) in asked.iter().zip(&mut self.tallies).zip(&inputs.of_part) {
            if let (Err(error), None) = (asked, &self.reason) {
                self.reason = Some(error.clone());
            }
            let asked = asked.as_ref().ok();
            tally.add(k, asked, own.iter().map(|input| uniforms[*input]));
            most = most.zip(asked).map(|(most, asked)| Asked {
                utilization: most.utilization.max(asked.utilization),
                within: [0, 1].map(|end| most.within[end].max(asked.within[end])),
                ..most
            });
        }
        self.all.add(most.as_ref());
    }
}
