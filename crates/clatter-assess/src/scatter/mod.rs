//! Scatter: how likely each part survives when the drop, the casing and the parts are not known to the last digit.
//!
//! # Model
//! A sample is answered as any other drop is: by the model with the most physics that the data allow, contacts that take time
//! where their time is known, else instant impacts at real tilt with gravity.
//!
//! # Intervals
//! All numbers are counted on the same samples, so that all parts together survive no more often than each, and a sequence of drops no
//! more often than each of them. An interval holds the probability with the stated confidence: that of Clopper and Pearson. A sample
//! whose utilization is so near 1 that the error bound of the model decides it counts as a failure for the lower end and as none for the
//! upper. A sample that is not answered is treated alike.
//!
//! Where a body lands after it has bounced clear is sensitive to every input. The demand of such a landing in one sample may differ from
//! one tolerance to another; how many samples fail does not.
//!
//! # Plates
//! A drop of a plate is followed as one of the box that it is, with full rotation. A file that tells no thickness has one of a twentieth of
//! the length. On feet no plate is followed as a box: real tilt is left out ([`PlateAs`]).
//!
//! # Boxes
//! A sample of a box is one product that goes through all of its drops, and survives if it survives each. What \[product\] and
//! \[\[component\]\] give is drawn once for it and is the same in all drops: masses, restitution and contact time, places, frequencies,
//! limits. The inputs of a drop are drawn for each: its height or speed, and its attitude, of which all within the tolerance are equally
//! likely. No drop wears a part: each is held against the same limits.
//!
//! A drop of a box is followed through its first landing, and on through what follows, for 4 v/g at most, where the energy left may decide
//! whether a limit holds. Where in the end it still may, the sample counts as a failure for the lower end and as none for the upper:
//! it is open. Utilizations are those of what was followed.
//!
//! # Samples
//! Input i of sample k is the counter (k, i) of Philox4x32-10 under the seed: it is the same alone, in any run, on any number of
//! threads and on any machine. Sums are made in blocks of fixed size, merged in order, so that the answer is the same as well,
//! and memory does not grow with the number of samples.

mod binomial;
mod cheap;
mod draw;
mod drivers;
mod extremes;
mod full;
mod in_a_row;
mod landing;
mod philox;
mod rows;
mod sample;
mod tally;

use rayon::prelude::*;

use crate::search::Landings;
use clatter_product::{Component, DropName, Error, Input, LimitKind, Model, ProductFile};
use landing::sequence;
use sample::{Inputs, Sample};
use tally::Block;

pub use binomial::{Probability, clopper_pearson};
pub use drivers::Share;
pub use extremes::{Extremes, extremes};
pub(crate) use in_a_row::{ByLaw, DrawnLimit, Shown, draw};
pub use landing::{LandingComponent, LandingScatter};
pub use rows::{PartRow, Recount};
pub use sample::Varied;

/// The settings of the draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// The number of drops; where several are listed the number of products, each of which goes through all of them.
    pub samples: u64,
    /// Another seed, other drops.
    pub seed: u64,
    /// The confidence of all intervals, in (0, 1).
    pub confidence: f64,
    /// Instant impacts that are closer than this are one, as of an [assessment](crate::Accuracy): a sample whose ends land so closely
    /// lands flat.
    pub merge_s: f64,
}

impl Settings {
    /// Samples unless said otherwise: 100 000 drops; where several are listed 1000 products: of a box 26 drops of each take from some 6 s
    /// to three minutes, by how often more than the first landing decides.
    #[must_use]
    pub fn samples_of(file: &ProductFile) -> u64 {
        if file.landings.is_empty() { 100_000 } else { 1000 }
    }
}

/// The result of all samples.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Scatter {
    /// The settings by which they were drawn; where that was stopped before the end, as many samples as were drawn.
    pub settings: Settings,
    /// The model with the most physics, which the probabilities are those of.
    pub model: Model,
    /// The way in which a plate is followed; none of a bar, and of a box that lands on anything.
    pub plate: Option<PlateAs>,
    /// The inputs that vary; without any, all samples are one.
    pub inputs: Vec<Varied>,
    /// Inputs given as a range with no distribution, taken as equally likely all over it.
    pub assumed_even: Vec<Varied>,
    /// Probability that every component survives; `at_least` is what a target is held against.
    pub survival: Probability,
    /// Samples in which a component was not answered. They count as failures, except for the upper ends of intervals.
    pub unanswered: u64,
    /// The reason why the first of them was not.
    pub reason: Option<Error>,
    /// Samples in which what an answer may be off by decides whether all survive, as of [`ComponentScatter`].
    pub open: u64,
    /// The components, in the order of the file.
    pub components: Vec<ComponentScatter>,
    /// The result of each of several drops, in the order of the file; else empty.
    pub landings: Vec<LandingScatter>,
}

/// The way in which drops of a plate are followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlateAs {
    /// As the box that it is, with full rotation.
    Box {
        /// Its thickness.
        thickness_m: f64,
        /// True where that is taken as a twentieth of the length, because the file does not give it.
        assumed: bool,
    },
    /// At small tilt: one on feet is not followed as a box, and what real tilt does is left out.
    Level,
}

/// The result of one component.
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
    /// The inputs that drive the utilization, the strongest first; empty where it does not vary or too few samples were drawn to
    /// tell.
    pub drivers: Vec<Driver>,
}

/// An input and what it does.
#[derive(Debug, Clone, PartialEq)]
pub struct Driver {
    /// The input.
    pub input: Varied,
    /// Its share of the variance and its trend.
    pub share: Share,
}

/// Values of some samples, and how far the sampling has come.
#[derive(Debug)]
pub struct Progress<'a> {
    /// Samples drawn so far, as a part of those requested.
    pub done: u64,
    /// One after the other, those since the last call: for each, the values of [`Sampler::columns`].
    pub values: &'a [f64],
}

/// The quantity in a column of [`Progress::values`]; parts are given by their index in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Column {
    /// An input of the drop in SI, an end that touches first as 0 for a and 1 for b; where each of several drops has its own, that of this
    /// one by its order in the file.
    Drop(Input, Option<usize>),
    /// Natural frequency of a part on a suspension, in Hz.
    FrequencyHz(usize),
    /// Damping ratio of a part, where it varies.
    DampingRatio(usize),
    /// A number of the stops of a part in SI, by its index in [`Stops::INPUTS`](clatter_product::Stops::INPUTS), where it varies.
    Stop(usize, usize),
    /// The place of the middle of a part, in m, where it varies.
    PositionM(usize),
    /// The place of the middle of a part across a plate, in m, where it varies.
    AcrossM(usize),
    /// A limit of a part in the unit of its kind, where it varies.
    Limit(usize, LimitKind),
    /// The critical acceleration of the damage boundary of a part in m/s², where it varies.
    CriticalAccelerationMS2(usize),
    /// Utilization of a part: the largest demand over allowed. It survives up to 1. NaN where the model has no answer.
    Utilization(usize),
    /// The utilization of a part in one of several drops.
    LandingUtilization(usize, usize),
}

/// The demand of a sample on a part.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct SampleDemand {
    /// The largest demand over allowed of its limits.
    utilization: f64,
    /// The least and the largest value that the demand may have, by its error bound.
    within: [f64; 2],
    /// The limits that do not hold.
    fails: [bool; LimitKind::ALL.len()],
}

impl SampleDemand {
    /// Takes in the demand of one limit, and its least and largest value.
    fn raise(&mut self, limit: usize, used: f64, within: [f64; 2]) {
        self.utilization = self.utilization.max(used);
        self.within = [0, 1].map(|end| self.within[end].max(within[end]));
        self.fails[limit] |= used > 1.0;
    }
    /// Returns the larger of both, limit by limit.
    fn largest(self, other: &Self) -> Self {
        Self {
            utilization: self.utilization.max(other.utilization),
            within: [0, 1].map(|end| self.within[end].max(other.within[end])),
            fails: std::array::from_fn(|limit| self.fails[limit] || other.fails[limit]),
        }
    }
    /// Returns whether the error bound decides if the part survives.
    fn is_open(&self) -> bool {
        self.within[0] <= 1.0 && self.within[1] > 1.0
    }
}

/// The demand of a sample on every part.
#[derive(Debug, Default)]
struct Answers {
    /// The demands in all drops together.
    parts: Vec<OfPart>,
    /// The demands in each of several drops.
    landings: Vec<Vec<OfPart>>,
}

/// The demand on a part, or the reason why it is not answered.
type OfPart = Result<SampleDemand, Error>;

/// Samples of one block; sums are made within blocks and then over blocks, in order.
const BLOCK: u64 = 1024;
/// Drops in a block of products that go through several, which take longer.
const BLOCK_OF_LISTS: u64 = 128;
/// Samples at most.
const MOST_SAMPLES: u64 = 1_000_000_000_000;

/// Draws samples of a product.
#[derive(Debug)]
pub struct Sampler {
    settings: Settings,
    inputs: Inputs,
    components: Vec<Component>,
    /// The names of several drops in sequence.
    drop_names: Vec<DropName>,
    fullest: Model,
    /// What a box may ask for as it lands again.
    later: Option<Landings>,
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
        let inputs = Inputs::new(file, settings.merge_s)?;
        let fullest = Model::fullest(&inputs.blank().drops[0]);
        let (components, drop_names, later) = (file.components.clone(), file.drop_names(), Landings::of(file));
        Ok(Self { settings, inputs, components, drop_names, fullest, later })
    }

    /// Returns the columns of each sample of [`Progress::values`].
    #[must_use]
    pub fn columns(&self) -> Vec<Column> {
        self.inputs.columns()
    }

    /// Draws all samples on the threads of the current pool. `watch` is called in order, on this thread, with all samples where `keep`
    /// needs them. Where `go_on`, which any thread may call, says `false`, no more are drawn than the first: the answer is that of the
    /// samples so far, as many as its settings say.
    ///
    /// # Errors
    /// Those of `watch`.
    pub fn run<E>(
        &self,
        keep: bool,
        go_on: &(dyn Fn() -> bool + Sync),
        mut watch: impl FnMut(&Progress<'_>) -> Result<(), E>,
    ) -> Result<Scatter, E> {
        let samples = self.settings.samples;
        let near = self.near();
        let block = self.block_size();
        let blocks = samples.div_ceil(block);
        let together = 4 * rayon::current_num_threads() as u64;
        let mut total = Block::new(&self.components, &self.inputs, &near);
        let mut next = 0;
        'drawing: while next < blocks {
            let until = blocks.min(next + together);
            let drawn: Vec<Block> = (next..until)
                .into_par_iter()
                .map(|b| self.block([b * block, samples.min((b + 1) * block)], keep, &near, go_on))
                .collect();
            for drawn in drawn {
                total.merge(&drawn);
                watch(&Progress { done: total.all.samples, values: &drawn.values })?;
                next += 1;
                if total.all.samples < samples.min(next * block) {
                    break 'drawing;
                }
            }
        }
        Ok(self.summary(total))
    }

    /// Samples of one block.
    fn block_size(&self) -> u64 {
        BLOCK_OF_LISTS.checked_div(self.inputs.landings() as u64).map_or(BLOCK, |samples| samples.max(1))
    }

    /// Returns the names of the drops of a sequence, in order; none of a product that falls once.
    #[must_use]
    pub fn drop_names(&self) -> &[DropName] {
        &self.drop_names
    }

    /// Returns the result of all blocks.
    fn summary(&self, total: Block) -> Scatter {
        let Block { tallies, landings, all, unanswered, reason, .. } = total;
        let settings = Settings { samples: all.samples, ..self.settings };
        let confidence = settings.confidence;
        let each = self.components.iter().zip(tallies.iter().zip(&self.inputs.of_part));
        let components: Vec<_> =
            each.map(|(component, (tally, own))| tally.summary(component, &self.inputs, own, confidence)).collect();
        let [_, open, _] = all.counts();
        let landings = self.drop_names.iter().zip(&landings).map(|(name, tally)| tally.summary(*name, confidence));
        Scatter {
            settings,
            model: self.fullest,
            plate: self.inputs.plate,
            inputs: self.inputs.varied.clone(),
            assumed_even: self.inputs.assumed_even.clone(),
            survival: all.survival(confidence),
            unanswered,
            reason,
            open,
            components,
            landings: landings.collect(),
        }
    }

    /// Returns the utilizations of the first sample: sums count from there.
    fn near(&self) -> Vec<f64> {
        let (mut sample, mut asked) = (self.inputs.blank(), Answers::default());
        self.answer(0, &mut sample, &mut asked);
        let utilization = |asked: &OfPart| asked.as_ref().map_or(0.0, |asked| asked.utilization);
        asked.parts.iter().map(utilization).map(|used| if used.is_finite() { used } else { 0.0 }).collect()
    }

    /// Draws a sample, and finds its demand.
    fn answer(&self, k: u64, sample: &mut Sample, asked: &mut Answers) {
        let Answers { parts, landings } = asked;
        parts.clear();
        landings.clear();
        match self.inputs.draw(self.settings.seed, k, sample) {
            Ok(()) if self.inputs.landings() > 0 => {
                landings.resize_with(sample.drops.len(), Vec::new);
                let each = sample.drops.iter().zip(landings.iter_mut());
                each.for_each(|(drop, asked)| full::answer(drop, &sample.parts, self.later.as_ref(), asked));
                parts.extend((0..sample.parts.len()).map(|i| sequence(landings.iter().map(|landing| &landing[i]))));
            }
            Ok(()) => full::answer(&sample.drops[0], &sample.parts, self.later.as_ref(), parts),
            Err(error) => {
                parts.resize(self.components.len(), Err(error));
                landings.resize(self.inputs.landings(), parts.clone());
            }
        }
    }

    /// Samples from .. to, as long as it may go on; the first of all is drawn in any case.
    fn block(&self, [from, to]: [u64; 2], keep: bool, near: &[f64], go_on: &(dyn Fn() -> bool + Sync)) -> Block {
        let mut block = Block::new(&self.components, &self.inputs, near);
        let columns = if keep { self.columns() } else { Vec::new() };
        let (mut sample, mut asked) = (self.inputs.blank(), Answers::default());
        for k in from..to {
            if k > 0 && !go_on() {
                break;
            }
            self.answer(k, &mut sample, &mut asked);
            block.take(k, &asked, &self.inputs, &sample.uniforms);
            let used = |asked: &OfPart| asked.as_ref().map_or(f64::NAN, |asked| asked.utilization);
            block.values.extend(columns.iter().map(|column| match column {
                Column::Utilization(i) => used(&asked.parts[*i]),
                Column::LandingUtilization(n, i) => used(&asked.landings[*n][*i]),
                other => sample.value(*other),
            }));
        }
        block
    }
}
