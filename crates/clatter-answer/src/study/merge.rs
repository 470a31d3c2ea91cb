//! This module takes in all rows of a study, in order, and makes its answer.

use clatter_assess::{
    Verdict,
    scatter::{PartRow, Recount},
};
use clatter_product::{Component, LimitKind, ProductFile};

use super::answer::{Answer, Member, Outcome, SearchedLimit};
use super::{Error, Study, in_si};

/// Takes in the rows of a study in order; its memory does not grow with the drops of a product.
#[derive(Debug)]
pub struct Merge<'a> {
    study: &'a Study,
    confidence: f64,
    next: u64,
    /// The product whose drops are being counted.
    counting: Option<(ProductFile, Recount)>,
    members: Vec<Member>,
}

impl<'a> Merge<'a> {
    /// Begins with the first row; the intervals are to hold with this confidence.
    ///
    /// # Errors
    /// [`Error::Assess`] for a confidence that makes no sense.
    pub fn new(study: &'a Study, confidence: f64) -> Result<Self, Error> {
        let mut merge = Self { study, confidence, next: 0, counting: None, members: Vec::new() };
        if !study.plan.search {
            merge.begin(0)?;
        }
        Ok(merge)
    }

    fn begin(&mut self, member: u64) -> Result<(), Error> {
        let file = self.study.family.member(member)?;
        let sampler = self.study.sampler(&file, self.confidence)?;
        self.counting = Some((file, Recount::new(sampler)));
        Ok(())
    }

    /// Takes in further rows, by their [counted](Study::counted) columns.
    ///
    /// # Errors
    /// [`Error::Parts`] where the rows are not the next ones.
    pub fn take(&mut self, columns: &[&[f64]]) -> Result<(), Error> {
        let rows = columns.first().map_or(0, |column| column.len());
        let numbers = self.study.numbers();
        let mut asked = Vec::with_capacity(self.study.components.len());
        for row in 0..rows {
            let told = columns.iter().take(numbers).map(|column| column[row].to_bits());
            if self.next >= self.study.rows() || !self.study.place(self.next).map(f64::to_bits).eq(told) {
                return Err(Error::Parts(format!("row {} is not where it should be", self.next)));
            }
            let mut cells = columns[numbers..].iter().map(|column| column[row]);
            if self.study.plan.search {
                self.searched(&mut cells)?;
            } else {
                asked.clear();
                for (component, _) in self.study.asked() {
                    let told = of_part(component, &mut cells);
                    asked.push(
                        told.map_err(|what| Error::Parts(format!("row {}: {what} of {}", self.next, component.name)))?,
                    );
                }
                self.counted(&asked)?;
            }
            self.next += 1;
        }
        Ok(())
    }

    fn counted(&mut self, asked: &[Option<PartRow>]) -> Result<(), Error> {
        let samples = self.study.plan.samples;
        if self.next > 0 && self.next.is_multiple_of(samples) {
            self.end();
            self.begin(self.next / samples)?;
        }
        if let Some((_, recount)) = &mut self.counting {
            recount.take(asked);
        }
        Ok(())
    }

    fn end(&mut self) {
        if let Some((file, recount)) = self.counting.take() {
            let values = self.values(self.members.len() as u64);
            self.members.push(Member { values, file, outcome: Outcome::Drawn(Box::new(recount.finish())) });
        }
    }

    fn searched(&mut self, cells: &mut impl Iterator<Item = f64>) -> Result<(), Error> {
        let mut limits = Vec::new();
        for (i, component) in self.study.components.iter().enumerate() {
            for kind in component.limits.kinds() {
                let mut cell = || cells.next().filter(|value| !value.is_nan());
                let [allowed, demand, bound] = [(); 3].map(|()| if in_si(kind) { cell() } else { None });
                let (margin, verdict) = (cell(), cell().unwrap_or(0.0));
                let verdict = match verdict {
                    1.0.. => Verdict::Safe,
                    ..0.0 => Verdict::Unsafe,
                    _ => Verdict::Undecided,
                };
                limits.push(SearchedLimit { component: i, limit: kind, allowed, demand, bound, margin, verdict });
            }
        }
        let file = self.study.family.member(self.next)?;
        let values = self.values(self.next);
        self.members.push(Member { values, file, outcome: Outcome::Searched(limits) });
        Ok(())
    }

    /// Returns the values of a product, without quotes.
    fn values(&self, member: u64) -> Vec<String> {
        let values = self.study.family.values(member);
        values.into_iter().map(|value| value.trim_matches(['"', '\'']).to_owned()).collect()
    }

    /// Returns the number of rows that were taken in.
    #[must_use]
    pub fn taken(&self) -> u64 {
        self.next
    }

    /// Returns the result of all rows.
    ///
    /// # Errors
    /// [`Error::Parts`] where rows are missing.
    pub fn finish(mut self) -> Result<Answer<'a>, Error> {
        let rows = self.study.rows();
        if self.next != rows {
            return Err(Error::Parts(format!("{} rows of {rows} are there", self.next)));
        }
        self.end();
        Ok(Answer { study: self.study, confidence: self.confidence, target: None, members: self.members })
    }
}

/// Reads the cells of a part from a row, or says what of them does not go together: a limit is exceeded where its utilization is above 1.
fn of_part(component: &Component, cells: &mut impl Iterator<Item = f64>) -> Result<Option<PartRow>, &'static str> {
    let mut cell = || cells.next().unwrap_or(f64::NAN);
    let flag =
        |value: f64| if value.to_bits() == 1.0_f64.to_bits() { Some(true) } else { (value == 0.0).then_some(false) };
    let utilization = cell();
    let open = flag(cell()).ok_or("a flag that is neither 0 nor 1")?;
    let mut exceeded = [false; LimitKind::ALL.len()];
    for exceeded in exceeded.iter_mut().take(component.limits.kinds().len()) {
        *exceeded = flag(cell()).ok_or("a flag that is neither 0 nor 1")?;
    }
    if utilization.is_nan() {
        return Ok(None);
    }
    if utilization < 0.0 || exceeded.contains(&true) != (utilization > 1.0) {
        return Err("a utilization that its exceeded limits contradict");
    }
    Ok(Some(PartRow { utilization, open, exceeded }))
}
