//! This module reads the notes in the shards of a study, and checks that the shards are those of one plan, each once.

use std::fmt;
use std::ops::Range;

use super::{Error, Study};

/// A part of a study: one of so many of about equal size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// The number of the shard, from 1.
    pub index: u64,
    /// The number of shards.
    pub of: u64,
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

impl std::str::FromStr for Shard {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, of)| Some((index.parse().ok()?, of.parse().ok()?)));
        let shard = numbers.map(|(index, of)| Self { index, of }).filter(|shard| (1..=shard.of).contains(&shard.index));
        shard.ok_or_else(|| "a shard is I/N, the I-th of N, from 1/N to N/N".to_owned())
    }
}

/// The version that draws and merges.
const VERSION: &str = env!("CARGO_PKG_VERSION");
const VERSION_NOTE: &str = "clatter.version";
const PLAN: &str = "clatter.plan";
const PRODUCT: &str = "clatter.product";
const SEED: &str = "clatter.seed";
const SHARD: &str = "clatter.shard";
const ROWS: &str = "clatter.rows";
const CHECK: &str = "clatter.check";

/// Returns a sum over all that a shard says of itself: FNV-1a of 64 bits, of each name and each note.
fn check(notes: &[(&str, &str)]) -> String {
    let bytes = notes.iter().flat_map(|(name, note)| name.bytes().chain([0]).chain(note.bytes()).chain([0]));
    let hash = bytes
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
    format!("{hash:016x}")
}

impl Study {
    /// Returns the notes in the file of a shard, by name: plan and product as they were read, the version, the seed, the shard and its
    /// rows, of which the last one is left out, and a sum over these.
    ///
    /// # Errors
    /// [`Error::Shard`] where there is no such shard.
    pub fn notes(&self, shard: Shard) -> Result<Vec<(&'static str, String)>, Error> {
        let Range { start, end } = self.rows_of(shard)?;
        let mut notes = vec![
            (VERSION_NOTE, VERSION.to_owned()),
            (PLAN, self.plan.text().to_owned()),
            (PRODUCT, self.family.product().to_owned()),
            (SEED, self.plan.seed.to_string()),
            (SHARD, shard.to_string()),
            (ROWS, format!("{start}:{end}")),
        ];
        let told: Vec<(&str, &str)> = notes.iter().map(|(name, note)| (*name, note.as_str())).collect();
        notes.push((CHECK, check(&told)));
        Ok(notes)
    }
}

/// Files that are to be the shards of one plan.
#[derive(Debug, Default)]
pub struct Parts {
    /// Name, plan and product of the first.
    first: Option<[String; 3]>,
    list: Vec<(String, Shard, Range<u64>)>,
}

impl Parts {
    /// Takes in a file by what it says of itself.
    ///
    /// # Errors
    /// [`Error::Parts`] where it is no shard, or one of another version or plan than the first.
    pub fn add<'a>(&mut self, name: &str, note: impl Fn(&str) -> Option<&'a str>) -> Result<(), Error> {
        let no_part = |what| Error::Parts(format!("{name} is no part of a study: {what}"));
        let told = |key: &'static str| note(key).ok_or_else(|| no_part(format!("it has no {key}")));
        let version = told(VERSION_NOTE)?;
        if version != VERSION {
            let again = "merge it by that version, or make it again";
            return Err(Error::Parts(format!(
                "{name} is of clatter {version}, and this is clatter {VERSION}: {again}"
            )));
        }
        let names = [VERSION_NOTE, PLAN, PRODUCT, SEED, SHARD, ROWS];
        let all = names.into_iter().map(|key| Ok((key, told(key)?))).collect::<Result<Vec<_>, Error>>()?;
        if told(CHECK)? != check(&all) {
            return Err(Error::Parts(format!("{name} is damaged: what it says of itself is not as it was written")));
        }
        let (plan, product) = (told(PLAN)?, told(PRODUCT)?);
        let (shard, rows) = (told(SHARD)?.parse(), told(ROWS)?.split_once(':'));
        let rows = rows.and_then(|(start, end)| Some(start.parse().ok()?..end.parse().ok()?));
        let (Ok(shard), Some(rows)) = (shard, rows) else { return Err(no_part("its rows are none".to_owned())) };
        let [first, its_plan, its_product] = self.first.get_or_insert_with(|| [name, plan, product].map(str::to_owned));
        for (what, own, other) in [("plan", plan, &*its_plan), ("product", product, its_product)] {
            if own != other {
                let [there, here] = difference(other, own);
                let message =
                    format!("{name} is of another study than {first}: its {what} has {here} where that has {there}");
                return Err(Error::Parts(message));
            }
        }
        self.list.push((name.to_owned(), shard, rows));
        Ok(())
    }

    /// Returns the plan and the product of all shards.
    #[must_use]
    pub fn plan_and_product(&self) -> Option<(&str, &str)> {
        self.first.as_ref().map(|[_, plan, product]| (plan.as_str(), product.as_str()))
    }

    /// Returns the files in the order of their rows, by their place in the list, with their rows.
    ///
    /// # Errors
    /// [`Error::Parts`] where they are not all rows of the study, each once.
    pub fn in_order(&self, study: &Study) -> Result<Vec<(usize, Range<u64>)>, Error> {
        let mut order: Vec<usize> = (0..self.list.len()).collect();
        order.sort_by_key(|i| (self.list[*i].2.start, self.list[*i].2.end));
        let (mut next, mut last) = (0, None);
        let mut missing = Vec::new();
        for &i in &order {
            let (name, shard, rows) = &self.list[i];
            if study.rows_of(*shard).ok().as_ref() != Some(rows) {
                return Err(Error::Parts(format!("{name} is damaged: shard {shard} has other rows than {rows:?}")));
            }
            if let (true, Some(last)) = (rows.start < next, last) {
                let other: &(String, Shard, Range<u64>) = &self.list[last];
                let message = match &other.0 {
                    other if other == name => format!("{name} is there twice: merge each part once"),
                    other => format!("{name} has rows that {other} has too: merge each part once"),
                };
                return Err(Error::Parts(message));
            }
            if rows.start > next {
                missing.push(next..rows.start);
            }
            (next, last) = (rows.end, Some(i));
        }
        if next < study.rows() {
            missing.push(next..study.rows());
        }
        if !missing.is_empty() {
            const SHOWN: usize = 8;
            let mut all: Vec<String> = missing.iter().take(SHOWN).map(|rows| self.lacks(study, rows)).collect();
            all.extend((missing.len() > SHOWN).then(|| format!("and {} more gaps", missing.len() - SHOWN)));
            return Err(Error::Parts(all.join("; ")));
        }
        Ok(order.into_iter().map(|i| (i, self.list[i].2.clone())).collect())
    }

    /// Names what is missing: the rows, and the shards that have them where all shards are of one size.
    fn lacks(&self, study: &Study, rows: &Range<u64>) -> String {
        let all = study.rows();
        let mut of = self.list.iter().map(|(_, shard, _)| shard.of);
        let one = of.next().filter(|first| of.all(|other| other == *first));
        let at = |of: u64, row: u64| {
            let before = (u128::from(row) * u128::from(of)).div_ceil(u128::from(all));
            u64::try_from(before).ok().filter(|before| {
                let shard = Shard { index: before + 1, of };
                row == all || study.rows_of(shard).is_ok_and(|found| found.start == row)
            })
        };
        let again = |of: u64| {
            let (first, last) = (at(of, rows.start)? + 1, at(of, rows.end)?);
            Some(if first == last {
                format!(": make shard {first}/{of}")
            } else {
                format!(": make shards {first}/{of} to {last}/{of}")
            })
        };
        let again = one.and_then(again).unwrap_or_default();
        format!("no part has rows {} to {} of {all}{again}", rows.start, rows.end - 1)
    }
}

/// Returns the first line in which two texts differ, from each of them.
fn difference(a: &str, b: &str) -> [String; 2] {
    let (mut a, mut b) = (a.lines(), b.lines());
    loop {
        match (a.next(), b.next()) {
            (Some(a), Some(b)) if a == b => {}
            (None, None) => return [(); 2].map(|()| "other ends of lines".to_owned()),
            (a, b) => return [a, b].map(|line| line.map_or("no more".to_owned(), |line| format!("`{}`", line.trim()))),
        }
    }
}
