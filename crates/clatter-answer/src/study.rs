//! This module runs studies that are larger than one machine: a plan, its rows in shards that anybody may draw, and the answer of all of
//! them.
//!
//! A plan names a product file and, over a grid, products that differ from it. Its rows are the drops of each of them in turn, or of a
//! search the products themselves. A row depends on the plan and its number alone. [`Study::write`] makes those of a shard, [`Parts`]
//! holds what shards say of themselves against each other, and [`Merge`] takes all rows in order: so the answer is the same to the last
//! bit, whatever the shards were.
//!
//! ```
//! use clatter_answer::study::{Merge, Shard, Study};
//! use clatter_product::{EXAMPLE, Plan};
//! let plan = Plan::read("product = \"example.toml\"\nsamples = 100", "plan.toml")?;
//! let study = Study::new(plan, EXAMPLE, "example.toml")?;
//! let mut merge = Merge::new(&study, 0.95)?;
//! for index in 1..=3 {
//!     let rows = study.rows_of(Shard { index, of: 3 })?;
//!     study.write(rows, &|_| (), |group| {
//!         let counted: Vec<&[f64]> = study.counted().into_iter().map(|i| group[i]).collect();
//!         merge.take(&counted).map_err(std::io::Error::other)
//!     })?;
//! }
//! let answer = merge.finish()?;
//! assert_eq!(answer.members.len(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod answer;
mod merge;
mod parts;

use std::io;
use std::ops::Range;

use clatter_assess::{
    Accuracy, Assessment, Verdict,
    scatter::{Column, PartRow, Sampler, Settings},
};
use clatter_product::{Component, DropName, Family, Faults, Input, LimitKind, Plan, ProductFile, Stops};
use clatter_record::{Field, FieldKind};

pub use answer::{Answer, Member, Outcome, SearchedLimit};
pub use merge::Merge;
pub use parts::{Parts, Shard};

/// The reason why there is no study, or no answer of its shards.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The faults of the plan or of its product.
    #[error(transparent)]
    Faults(#[from] Faults),
    /// A product of which nothing is drawn, or that is not assessed.
    #[error(transparent)]
    Assess(#[from] clatter_product::Error),
    /// Boxes of one grid that do not go through the same drops.
    #[error(
        "product {0} of the grid goes through other drops than the first; allowed: the same list for all, as the columns tell them"
    )]
    Drops(u64),
    /// A text that is no product file at all, none of whose lines is told.
    #[error("{0} is no product file: it has no [product]")]
    NoProduct(String),
    /// A shard that there is not.
    #[error("shard {index}/{of} is none: the plan has {rows} rows, in shards from 1/N to N/N with N from 1 to {rows}")]
    Shard {
        /// The number of the shard.
        index: u64,
        /// The number of shards.
        of: u64,
        /// Rows of the plan.
        rows: u64,
    },
    /// Files that are not the shards of one plan, each once.
    #[error("{0}")]
    Parts(String),
}

/// A plan with its products.
#[derive(Debug)]
pub struct Study {
    plan: Plan,
    family: Family,
    /// The columns that differ from row to row where rows are drawn.
    drawn: Vec<Column>,
    /// The parts of all products.
    components: Vec<Component>,
    /// The names of the drops that each product goes through in sequence; empty where products fall once, and for a search.
    drop_names: Vec<DropName>,
}

/// The number of rows in a group of the file: 1 MiB of each column.
const GROUP: usize = 1 << 17;
/// A confidence where rows are drawn, which have no interval.
const NO_INTERVAL: f64 = 0.5;

impl Study {
    /// Checks a plan and all of its products before anything is drawn; `product` is the text of its product file, `origin` the name of
    /// that.
    ///
    /// # Errors
    /// [`Error`].
    pub fn new(plan: Plan, product: &str, origin: &str) -> Result<Self, Error> {
        let begins = |line: &str| line.trim_start_matches(['[', '"', '\'', ' ', '\t']).starts_with("product");
        if !product.lines().any(begins) {
            return Err(Error::NoProduct(origin.to_owned()));
        }
        let family = plan.family(product, origin)?;
        let first = family.member(0)?;
        let (drawn, drop_names, components) = (Vec::new(), Vec::new(), first.components.clone());
        let mut study = Self { plan, family, drawn, components, drop_names };
        if study.plan.search {
            return Ok(study);
        }
        let sampler = study.sampler(&first, NO_INTERVAL)?;
        study.drop_names = sampler.drop_names().to_vec();
        let quantities = sampler.quantities();
        let values = sampler.drawn(0, &quantities);
        let mut differs: Vec<bool> = quantities.iter().map(|column| sampler.varies(*column)).collect();
        for i in 1..study.family.members() {
            let sampler = study.sampler(&study.family.member(i)?, NO_INTERVAL)?;
            if sampler.drop_names() != study.drop_names {
                return Err(Error::Drops(i + 1));
            }
            for (k, (value, other)) in sampler.drawn(0, &quantities).iter().zip(&values).enumerate() {
                differs[k] |= sampler.varies(quantities[k]) || value.to_bits() != other.to_bits();
            }
        }
        study.drawn = quantities.into_iter().zip(differs).filter(|(_, differs)| *differs).map(|(c, _)| c).collect();
        Ok(study)
    }

    /// Returns the plan.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the products of the study.
    #[must_use]
    pub fn family(&self) -> &Family {
        &self.family
    }

    /// Returns the number of all rows: drops of each product, or of a search the products.
    #[must_use]
    pub fn rows(&self) -> u64 {
        self.family.members() * self.rows_a_member()
    }

    fn rows_a_member(&self) -> u64 {
        if self.plan.search { 1 } else { self.plan.samples }
    }

    /// Returns the rows of a shard: as many in each as in any other, or one less.
    ///
    /// # Errors
    /// [`Error::Shard`] where there is no such shard.
    pub fn rows_of(&self, Shard { index, of }: Shard) -> Result<Range<u64>, Error> {
        let rows = self.rows();
        if !(1..=rows).contains(&of) || !(1..=of).contains(&index) {
            return Err(Error::Shard { index, of, rows });
        }
        let at = |i: u64| u64::try_from(u128::from(rows) * u128::from(i) / u128::from(of)).unwrap_or(rows);
        Ok(at(index - 1)..at(index))
    }

    /// Returns how many columns give the place of a row.
    fn numbers(&self) -> usize {
        self.place(0).count()
    }

    /// Returns the number of the product, where there are several, and that of the sample in it, where there are any.
    fn place(&self, row: u64) -> impl Iterator<Item = f64> {
        let each = self.rows_a_member();
        let several = self.plan.search || !self.plan.grid.is_empty();
        let place = [several.then_some(row / each), (!self.plan.search).then_some(row % each)];
        place.into_iter().flatten().map(float)
    }

    fn sampler(&self, file: &ProductFile, confidence: f64) -> Result<Sampler, Error> {
        let Plan { samples, seed, .. } = self.plan;
        Ok(Sampler::new(file, Settings { samples, seed, confidence, merge_s: Accuracy::default().merge_s })?)
    }

    /// Returns the fields of a row.
    #[must_use]
    pub fn fields(&self) -> Vec<Field> {
        let field = |name: &str, unit: &str, kind| Field { name: name.to_owned(), unit: unit.to_owned(), kind };
        let mut fields = Vec::new();
        if !self.plan.grid.is_empty() || self.plan.search {
            fields.push(field("member", "", FieldKind::Whole));
        }
        if self.plan.search {
            fields.extend(self.limits().flat_map(|(component, kind)| searched(component, kind)));
            return fields;
        }
        fields.push(field("sample", "", FieldKind::Whole));
        fields.extend(self.drawn.iter().map(|column| self.drawn_field(*column)));
        for (component, on) in self.asked() {
            let of = |what: &str| {
                let what = format!("{what} of {}", component.name);
                on.map_or(what.clone(), |n| self.on(&what, n))
            };
            fields.push(field(&of("utilization"), "1", FieldKind::FloatOrNone));
            fields.push(field(&of("open"), "", FieldKind::Flag));
            let exceeded = |kind: LimitKind| field(&of(&format!("exceeds {}", kind.name())), "", FieldKind::Flag);
            fields.extend(component.limits.kinds().into_iter().map(exceeded));
        }
        fields
    }

    /// Returns the parts that a row has values of: each through all of its drops, and where there are several drops also in each of them,
    /// by its number from 0.
    fn asked(&self) -> impl Iterator<Item = (&Component, Option<usize>)> {
        let drops = std::iter::once(None).chain((0..self.drop_names.len()).map(Some));
        drops.flat_map(|on| self.components.iter().map(move |component| (component, on)))
    }

    /// Returns the places in [`fields`](Self::fields) of the columns that [`Merge`] counts.
    #[must_use]
    pub fn counted(&self) -> Vec<usize> {
        let drawn = self.numbers()..self.numbers() + self.drawn.len();
        (0..self.fields().len()).filter(|i| !drawn.contains(i)).collect()
    }

    fn limits(&self) -> impl Iterator<Item = (&Component, LimitKind)> {
        self.components.iter().flat_map(|part| part.limits.kinds().into_iter().map(move |kind| (part, kind)))
    }

    /// Names a quantity of one of several drops, by its number from 0.
    fn on(&self, what: &str, n: usize) -> String {
        match self.drop_names.get(n) {
            Some(DropName::On(attitude)) => format!("{what} on drop {}, {attitude}", n + 1),
            Some(name) => format!("{what} in {name}"),
            None => what.to_owned(),
        }
    }

    fn drawn_field(&self, column: Column) -> Field {
        let part = |i: usize| self.components.get(i).map_or("", |component| &component.name);
        let of = |what: &str, i: usize| format!("{what} of {}", part(i));
        let (name, unit) = match column {
            Column::Drop(input, None) => (input.row().column.to_owned(), input.row().unit),
            Column::Drop(input, Some(n)) => (self.on(input.row().column, n), input.row().unit),
            Column::FrequencyHz(i) => (of("frequency_hz", i), "Hz"),
            Column::DampingRatio(i) => (of("damping_ratio", i), "1"),
            Column::Stop(i, n) => (of(Stops::INPUTS[n].column, i), Stops::INPUTS[n].unit),
            Column::PositionM(i) => (of("position_m", i), "m"),
            Column::AcrossM(i) => (of("position_across_m", i), "m"),
            Column::Limit(i, kind) => (of(&in_unit(kind, "limit"), i), kind.unit().name()),
            Column::CriticalAccelerationMS2(i) => (of("critical_acceleration_m_s2", i), "m/s2"),
            other => (format!("{other:?}"), ""),
        };
        let is_first = matches!(column, Column::Drop(Input::First, _));
        let kind = if is_first { FieldKind::Flag } else { FieldKind::Float };
        Field { name, unit: unit.to_owned(), kind }
    }

    /// Makes rows in order and hands them to `write` column by column, in groups of equal size except the last; `done` receives the
    /// number of new rows, from any thread.
    ///
    /// # Errors
    /// Those of `write`.
    pub fn write(
        &self,
        rows: Range<u64>,
        done: &(dyn Fn(u64) + Sync),
        mut write: impl FnMut(&[&[f64]]) -> io::Result<()>,
    ) -> io::Result<()> {
        let mut group: Vec<Vec<f64>> = vec![Vec::new(); self.fields().len()];
        let mut flush = |group: &mut Vec<Vec<f64>>| {
            write(&group.iter().map(Vec::as_slice).collect::<Vec<_>>())?;
            group.iter_mut().for_each(Vec::clear);
            Ok::<_, io::Error>(())
        };
        let each = self.rows_a_member();
        let mut next = rows.start;
        while next < rows.end {
            let member = next / each;
            let file = self.family.member(member).map_err(io::Error::other)?;
            let until = rows.end.min((member + 1) * each);
            if self.plan.search {
                let assessed = crate::assess::answer(&file, &Accuracy::default()).map_err(io::Error::other)?;
                push(&mut group, self.place(next).chain(found(&assessed.assessment)));
                done(1);
                next = until;
            } else {
                let sampler = self.sampler(&file, NO_INTERVAL).map_err(io::Error::other)?;
                while next < until {
                    let room = (GROUP - group[0].len()) as u64;
                    let to = until.min(next + room);
                    self.draw(&sampler, next..to, done, &mut group);
                    next = to;
                    if group[0].len() == GROUP {
                        flush(&mut group)?;
                    }
                }
            }
        }
        if group[0].is_empty() { Ok(()) } else { flush(&mut group) }
    }

    /// Returns the rows of a shard that are drawn again as it is merged: its first, its last and one between, of a search the very first.
    #[must_use]
    pub fn again(&self, rows: &Range<u64>) -> Vec<u64> {
        let count = rows.end - rows.start;
        if self.plan.search || count == 0 {
            return if rows.start == 0 && count > 0 { vec![0] } else { Vec::new() };
        }
        // Another one in each shard: by Fibonacci hashing, Knuth, The Art of Computer Programming 3, 6.4.
        let between = rows.start + rows.end.wrapping_mul(0x9e37_79b9_7f4a_7c15) % count;
        let mut again = vec![rows.start, between, rows.end - 1];
        again.sort_unstable();
        again.dedup();
        again
    }

    /// Draws a row again and holds it against what a file has, to the last bit.
    ///
    /// # Errors
    /// [`Error::Parts`] where it has another row: another program made it, or it is damaged.
    pub fn check(&self, row: u64, told: &[f64]) -> Result<(), Error> {
        let mut drawn: Vec<Vec<f64>> = vec![Vec::new(); self.fields().len()];
        let file = self.family.member(row / self.rows_a_member())?;
        if self.plan.search {
            let assessed = crate::assess::answer(&file, &Accuracy::default())?;
            push(&mut drawn, self.place(row).chain(found(&assessed.assessment)));
        } else {
            self.draw(&self.sampler(&file, NO_INTERVAL)?, row..row + 1, &|_| (), &mut drawn);
        }
        let same = |(drawn, told): (&Vec<f64>, &f64)| {
            drawn[0].to_bits() == told.to_bits() || drawn[0].is_nan() && told.is_nan()
        };
        if drawn.len() == told.len() && drawn.iter().zip(told).all(same) {
            return Ok(());
        }
        Err(Error::Parts(format!("row {row} is not what is drawn here: it was changed, or another program made it")))
    }

    /// Draws rows of one product.
    fn draw(&self, sampler: &Sampler, rows: Range<u64>, done: &(dyn Fn(u64) + Sync), group: &mut [Vec<f64>]) {
        let before = rows.start / self.rows_a_member() * self.rows_a_member();
        let drawn = sampler.rows(rows.start - before..rows.end - before, &self.drawn, done);
        for (row, (drawn, asked)) in rows.zip(drawn) {
            let each = asked.iter().zip(self.asked());
            let told = each.flat_map(|(asked, (component, _))| {
                let kinds = component.limits.kinds().len();
                let flag = |is: bool| f64::from(u8::from(is));
                let PartRow { utilization, open, exceeded } = asked.unwrap_or(UNANSWERED);
                [utilization, flag(open)].into_iter().chain(exceeded.into_iter().take(kinds).map(flag))
            });
            push(group, self.place(row).chain(drawn).chain(told));
        }
    }
}

/// The entry of a row for a part without an answer.
const UNANSWERED: PartRow = PartRow { utilization: f64::NAN, open: false, exceeded: [false; LimitKind::ALL.len()] };

fn push(group: &mut [Vec<f64>], row: impl Iterator<Item = f64>) {
    group.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
}

#[expect(clippy::cast_precision_loss, reason = "below 2^53")]
fn float(count: u64) -> f64 {
    count as f64
}

/// Makes a name such as `acceleration_demand_m_s2`.
fn in_unit(kind: LimitKind, what: &str) -> String {
    format!("{}_{what}_{}", kind.name(), kind.unit().name()).replace(['-', '/'], "_")
}

/// Returns whether a limit of a search has SI values: a damage boundary has none, as that one of its two quantities counts that leaves
/// more room.
fn in_si(kind: LimitKind) -> bool {
    kind != LimitKind::DamageBoundary
}

/// Returns the columns of a limit of a search.
fn searched(component: &Component, kind: LimitKind) -> Vec<Field> {
    let name = kind.name().replace('-', "_");
    let field = |what: String, unit: &str, kind| Field {
        name: format!("{what} of {}", component.name),
        unit: unit.to_owned(),
        kind,
    };
    let si = |what| field(in_unit(kind, what), kind.unit().name(), FieldKind::FloatOrNone);
    let mut fields = if in_si(kind) { vec![si("allowed"), si("demand"), si("bound")] } else { Vec::new() };
    fields.push(field(format!("{name}_margin"), "1", FieldKind::FloatOrNone));
    // The verdict is 1 for safe, 0 for undecided and -1 for unsafe.
    fields.push(field(format!("{name}_verdict"), "", FieldKind::Whole));
    fields
}

/// Returns the results of each limit, in the order of [`searched`].
fn found(assessment: &Assessment) -> impl Iterator<Item = f64> {
    let limits = assessment.components.iter().flat_map(|component| &component.limits);
    limits.flat_map(|limit| {
        let or_none = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let si = [limit.allowed, or_none(limit.demand), or_none(limit.bound)];
        let verdict = match limit.verdict {
            Verdict::Safe => 1.0,
            // A study searches, and draws nothing for what that leaves open.
            Verdict::Reliable | Verdict::Undecided => 0.0,
            Verdict::Unsafe => -1.0,
        };
        si.into_iter().take(if in_si(limit.limit) { 3 } else { 0 }).chain([or_none(limit.margin), verdict])
    })
}
