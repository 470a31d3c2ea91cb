//! Samples one by one: kept elsewhere, and counted again from what was kept.
//!
//! A sample depends on the seed and its number alone, so that samples may be drawn anywhere and in any order. Counted in order, they
//! give what [`Sampler::run`] gives, to the last bit.

use std::ops::Range;

use rayon::prelude::*;

use super::sample::Sample;
use super::tally::Block;
use super::{Answers, Column, OfPart, SampleDemand, Sampler, Scatter};
use clatter_product::LimitKind;

/// The demand of a sample on a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartRow {
    /// The largest demand over allowed of its limits.
    pub utilization: f64,
    /// True where the error bound decides if the part survives.
    pub open: bool,
    /// The limits that do not hold, in the order of its [limits](clatter_product::Limits::kinds).
    pub exceeded: [bool; LimitKind::ALL.len()],
}

impl PartRow {
    fn new(asked: &SampleDemand) -> Self {
        Self { utilization: asked.utilization, open: asked.is_open(), exceeded: asked.fails }
    }

    /// Returns the data that a count needs: on which side of 1 the utilization and its ends are.
    fn demand(&self) -> SampleDemand {
        let within = if self.open { [0.0, f64::INFINITY] } else { [self.utilization; 2] };
        SampleDemand { utilization: self.utilization, within, fails: self.exceeded }
    }
}

/// Samples that one thread draws in one go.
const PIECE: u64 = 256;

impl Sampler {
    /// Returns the quantities that may describe a sample of the product: all that the product has, whether it varies or not.
    #[must_use]
    pub fn quantities(&self) -> Vec<Column> {
        self.inputs.quantities()
    }

    /// Returns whether it differs from sample to sample.
    #[must_use]
    pub fn varies(&self, column: Column) -> bool {
        self.inputs.varied.iter().any(|input| input.column() == column)
    }

    /// Returns these quantities of a sample in SI, angles in rad too.
    #[must_use]
    pub fn drawn(&self, sample: u64, columns: &[Column]) -> Vec<f64> {
        let mut drawn = self.inputs.blank();
        let _ = self.inputs.draw(self.settings.seed, sample, &mut drawn); // what it may not draw has no value
        columns.iter().map(|column| drawn.value(*column)).collect()
    }

    /// Draws samples on the threads of the current pool, and gives these quantities of each in SI, angles in rad too,
    /// and its demand on each part, of a box through all of its drops and then of each part in each of them; none where it has no answer.
    /// `done` is called with so many more, by any thread.
    #[must_use]
    pub fn rows(
        &self,
        samples: Range<u64>,
        columns: &[Column],
        done: &(dyn Fn(u64) + Sync),
    ) -> Vec<(Vec<f64>, Vec<Option<PartRow>>)> {
        let pieces = (samples.end - samples.start).div_ceil(PIECE);
        let piece = |i: u64| {
            let from = samples.start + i * PIECE;
            let until = samples.end.min(from + PIECE);
            let (mut sample, mut answers) = (self.inputs.blank(), Answers::default());
            let row = |k| {
                self.answer(k, &mut sample, &mut answers);
                if answers.parts.iter().all(Result::is_err) {
                    // A sample that could not be drawn must not keep the values of the sample before.
                    sample = self.inputs.blank();
                    let _ = self.inputs.draw(self.settings.seed, k, &mut sample);
                }
                let values = columns.iter().map(|column| sample.value(*column)).collect();
                let asked = answers.parts.iter().chain(answers.landings.iter().flatten());
                (values, asked.map(|asked| asked.as_ref().ok().map(PartRow::new)).collect())
            };
            let rows: Vec<_> = (from..until).map(row).collect();
            done(until - from);
            rows
        };
        (0..pieces).into_par_iter().flat_map_iter(piece).collect()
    }
}

/// Counts samples that were drawn before, in order.
#[derive(Debug)]
pub struct Recount {
    sampler: Sampler,
    sample: Sample,
    near: Vec<f64>,
    total: Block,
    block: Block,
    next: u64,
}

impl Recount {
    /// Returns the rows of samples of this sampler, from its first one on.
    #[must_use]
    pub fn new(sampler: Sampler) -> Self {
        let near = sampler.near();
        let block = || Block::new(&sampler.components, &sampler.inputs, &near);
        Self { sample: sampler.inputs.blank(), total: block(), block: block(), near, next: 0, sampler }
    }

    /// Takes in the demand of the next sample on each part, of a box in each of its drops too, as [`Sampler::rows`] has it.
    pub fn take(&mut self, asked: &[Option<PartRow>]) {
        let (sampler, k) = (&self.sampler, self.next);
        let _ = sampler.inputs.draw(sampler.settings.seed, k, &mut self.sample); // its numbers stand, whatever is refused
        let mut again = Answers::default();
        let known = self.total.reason.as_ref().or(self.block.reason.as_ref());
        if known.is_none() && asked.iter().any(Option::is_none) {
            // The reason why it has no answer was not kept, and is found once more.
            sampler.answer(k, &mut self.sample, &mut again);
        }
        let count = sampler.components.len();
        let reason = |i: usize| {
            let asked: Option<&OfPart> = again.parts.iter().chain(again.landings.iter().flatten()).nth(i);
            asked
                .and_then(|asked| asked.as_ref().err())
                .or(known)
                .cloned()
                .unwrap_or(clatter_product::Error::Unfinished)
        };
        let each = asked.iter().enumerate();
        let mut parts: Vec<OfPart> =
            each.map(|(i, asked)| asked.map(|asked| asked.demand()).ok_or_else(|| reason(i))).collect();
        let of_drops = parts.split_off(count.min(parts.len()));
        let landings = of_drops.chunks(count.max(1)).map(<[_]>::to_vec).collect();
        let answers = Answers { parts, landings };
        self.block.take(k, &answers, &sampler.inputs, &self.sample.uniforms);
        self.next += 1;
        if self.next.is_multiple_of(sampler.block_size()) {
            self.total.merge(&self.block);
            self.block = Block::new(&sampler.components, &sampler.inputs, &self.near);
        }
    }

    /// Returns the result of the samples.
    #[must_use]
    pub fn finish(mut self) -> Scatter {
        self.total.merge(&self.block);
        self.sampler.summary(self.total)
    }
}
