//! This module finds the data of a product from a measured drop.
//!
//! ```
//! use clatter_answer::fit::{self, Data, Record};
//! use clatter_product::ProductFile;
//! use clatter_fit::Quantity;
//! let file = ProductFile::read(clatter_product::EXAMPLE, "example.toml")?;
//! // Each flight of what bounces flat is 0.4 of the one before.
//! let bounces = Record { name: "bounces.csv".to_owned(), data: Data::Bounces(vec![0.0, 0.5, 0.7, 0.78, 0.812]) };
//! let question = fit::Question::new(&file, vec![bounces]);
//! let answer = fit::answer(&question)?;
//! let e = answer.fit.estimates.iter().find(|estimate| estimate.quantity == Quantity::Restitution);
//! assert!(e.is_some_and(|e| (e.value - 0.4).abs() < 1e-6));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod list;

use clatter::End;
use clatter_fit as fit;
use clatter_fit::{
    Estimate, Explanation, Fit, Known, MOST_SAMPLES, Measured, MeasuredDrop, RecordFit, StrikeFit, Undetermined,
    Written,
};
use clatter_product::{ProductFile, optional_inputs};
use serde::{Serialize, Serializer};

pub use list::{List, options, refusal};

use crate::{Error, Json, VERSION, letter};

/// A record of a drop.
#[derive(Debug, Clone)]
pub struct Record {
    /// The name of the record in the answer, which is that of its file.
    pub name: String,
    /// The measured data.
    pub data: Data,
}

/// The measured data of a record.
#[derive(Debug, Clone)]
pub enum Data {
    /// Strikes, heights or an acceleration.
    Measured(Measured),
    /// Times at which a flat product, or one point of it, bounces.
    Bounces(Vec<f64>),
}

impl Data {
    /// Takes an acceleration of one channel over even times, measured at a place from the middle of the product towards end b.
    ///
    /// # Errors
    /// More channels than one, uneven times, more samples than a fit takes.
    pub fn acceleration(record: &clatter_record::Record, position_m: f64) -> Result<Self, Error> {
        let [channel] = record.channels() else { return Err(Error::Channels(record.channels().len())) };
        let (times, samples) = (channel.times(), channel.values.len());
        let step_s = times.even("a fit")?;
        if samples > MOST_SAMPLES {
            return Err(Error::Samples(samples));
        }
        let values_m_s2 = channel.values.clone();
        Ok(Self::Measured(Measured::Acceleration { position_m, start_s: times.start_s(), step_s, values_m_s2 }))
    }

    /// Returns `bounces`, `strikes`, `heights` or `acceleration`.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Bounces(_) => "bounces",
            Self::Measured(Measured::Strikes { .. }) => "strikes",
            Self::Measured(Measured::Heights { .. }) => "heights",
            Self::Measured(Measured::Acceleration { .. }) => "acceleration",
        }
    }
}

/// A product and records of one of its drops.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question<'a> {
    /// The product.
    pub file: &'a ProductFile,
    /// The records; bounces are of another drop, and stand alone.
    pub records: Vec<Record>,
    /// Standard deviation of the times of bounces; unless given, it is found from their scatter about the fit.
    pub timing_s: Option<f64>,
    /// True where the radius of gyration of the product is known.
    pub gyration_known: bool,
}

impl<'a> Question<'a> {
    /// Makes a question with the radius of gyration to be found.
    #[must_use]
    pub fn new(file: &'a ProductFile, records: Vec<Record>) -> Self {
        Self { file, records, timing_s: None, gyration_known: false }
    }
}

/// The drop that is nearest to the records.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer<'a> {
    /// The question.
    pub question: &'a Question<'a>,
    /// The drop.
    pub fit: Fit,
}

/// The first line of a product file that a fit was written into.
const MADE_BY: &str = "# Fitted by clatter ";

impl Answer<'_> {
    /// Writes as [`fit::written`] does, below a line with the version of clatter; such a line of an earlier fit is replaced.
    ///
    /// # Errors
    /// As there.
    pub fn written(&self, text: &str) -> Result<Written, String> {
        let mut written = fit::written(text, &self.fit)?;
        let text = written.text.trim_start_matches('\u{feff}');
        let is_made = |line: &str| line.starts_with(MADE_BY);
        let rest = text.split_once('\n').filter(|(line, _)| is_made(line)).map_or(text, |(_, rest)| rest);
        written.text = format!("{MADE_BY}{VERSION}\n{rest}");
        Ok(written)
    }
}

/// Finds the nearest drop.
///
/// # Errors
/// Fails for a radius of gyration that is to be known and has a range; for a plate, a spin or several drops, except with flat bounces; for
/// contacts of their own; for bounces together with other records; and as [`fit::fit`] and [`fit::bounces`] do.
pub fn answer<'a>(question: &'a Question<'_>) -> Result<Answer<'a>, Error> {
    let Question { file, ref records, timing_s, gyration_known } = *question;
    let gyration = &file.product.gyration_m;
    if gyration_known && !gyration.is_value() {
        return Err(Error::GyrationRange([gyration.lo(), gyration.hi()]));
    }
    let bounces = matches!(&records[..], [Record { data: Data::Bounces(_), .. }]);
    if file.product.body.is_wide() && !bounces {
        return Err(clatter_product::Error::FitOfPlate.into());
    }
    if !file.product.own_contacts.is_none() {
        return Err(clatter_product::Error::AlikeContacts("a fit").into());
    }
    if !(file.landings.is_empty() || bounces) {
        return Err(clatter_product::Error::OneDrop("a fit of strikes, heights or accelerations").into());
    }
    let mut optional = optional_inputs().filter(|(row, _)| row.input.is_there(&file.product, &file.drop));
    if let Some((row, _)) = optional.next().filter(|_| !bounces) {
        return Err(clatter_product::Error::Without("a fit of strikes, heights or accelerations", row.name).into());
    }
    let known = Known { gyration_known, ..Known::from(file) };
    Ok(Answer { question, fit: nearest(&known, records, timing_s)? })
}

fn nearest(known: &Known, records: &[Record], timing_s: Option<f64>) -> Result<Fit, Error> {
    if let [Record { data: Data::Bounces(times_s), .. }] = records {
        return Ok(fit::bounces(times_s, known.gravity_m_s2, timing_s)?);
    }
    let measured = |record: &Record| match &record.data {
        Data::Measured(measured) => Ok(measured.clone()),
        Data::Bounces(_) => Err(Error::Bounces),
    };
    Ok(fit::fit(known, &records.iter().map(measured).collect::<Result<Vec<_>, _>>()?)?)
}

/// Records of one drop that stand next to an assessment.
#[derive(Debug, Clone)]
pub struct DropRecords {
    /// The name of the drop.
    pub name: String,
    /// Its records.
    pub records: Vec<Record>,
    /// Standard deviation of the times of bounces.
    pub timing_s: Option<f64>,
}

impl DropRecords {
    /// Finds the nearest drop. A result without any near drop is an answer as well.
    ///
    /// # Errors
    /// As [`answer`], where a record is not what a fit takes.
    pub fn fitted(self, known: &Known) -> Result<MeasuredDrop, Error> {
        let found = match nearest(known, &self.records, self.timing_s) {
            Ok(fit) => Ok(fit),
            Err(Error::Fit(error)) if error.is_no_drop() => Err(error.to_string()),
            Err(error) => return Err(error),
        };
        Ok(self.told(found))
    }

    /// Returns the measured drop with the fit that was found, or with the reason why there is none.
    #[must_use]
    pub fn told(self, found: Result<Fit, String>) -> MeasuredDrop {
        MeasuredDrop { name: self.name, files: self.records.into_iter().map(|record| record.name).collect(), found }
    }
}

#[derive(Serialize)]
struct AnswerJson<'a> {
    product: &'a str,
    model: &'static str,
    first: &'static str,
    degrees_of_freedom: usize,
    estimates: Vec<EstimateJson<'a>>,
    untold: Vec<UndeterminedJson<'a>>,
    correlations: Vec<Vec<Json>>,
    records: Vec<RecordJson<'a>>,
    others: Vec<OtherJson<'a>>,
    computed: Vec<ComputedJson>,
    notes: &'a [String],
}

#[derive(Serialize)]
struct EstimateJson<'a> {
    quantity: &'static str,
    unit: &'static str,
    value: Json,
    interval: Option<[Json; 2]>,
    note: Option<&'a str>,
}

#[derive(Serialize)]
struct UndeterminedJson<'a> {
    quantity: &'static str,
    unit: &'static str,
    held_at: Json,
    reason: &'a str,
}

#[derive(Serialize)]
struct RecordJson<'a> {
    file: &'a str,
    kind: &'static str,
    first_touch_s: Json,
    scatter: Json,
    strikes: Vec<StrikeJson>,
    missing: &'a [usize],
}

#[derive(Serialize)]
struct StrikeJson {
    time_s: Json,
    end: Option<&'static str>,
    number: Option<usize>,
    residual_s: Option<Json>,
}

#[derive(Serialize)]
struct OtherJson<'a> {
    first: &'static str,
    missing: &'a [Vec<usize>],
    left_out_s: Vec<Vec<Json>>,
    estimates: Vec<EstimateJson<'a>>,
}

#[derive(Serialize)]
struct ComputedJson {
    time_s: Json,
    end: &'static str,
}

impl Serialize for Answer<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.json().serialize(serializer)
    }
}

impl<'a> Answer<'a> {
    fn json(&'a self) -> AnswerJson<'a> {
        let Self { question, fit } = self;
        let estimate = |estimate: &'a Estimate| EstimateJson {
            quantity: estimate.quantity.name(),
            unit: estimate.quantity.unit(),
            value: Json(estimate.value),
            interval: estimate.interval.map(|interval| interval.map(Json)),
            note: estimate.note.as_deref(),
        };
        let other = |other: &'a Explanation| OtherJson {
            first: letter(other.first),
            missing: &other.missing,
            left_out_s: other.left_out_s.iter().map(|all| all.iter().copied().map(Json).collect()).collect(),
            estimates: other.estimates.iter().map(estimate).collect(),
        };
        let untold = |untold: &'a Undetermined| UndeterminedJson {
            quantity: untold.quantity.name(),
            unit: untold.quantity.unit(),
            held_at: Json(untold.held_at),
            reason: &untold.reason,
        };
        let strike = |strike: &StrikeFit| StrikeJson {
            time_s: Json(strike.measured.time_s),
            end: strike.measured.end.map(letter),
            number: strike.number,
            residual_s: strike.residual_s.map(Json),
        };
        let record = |(record, found): (&'a Record, &'a RecordFit)| RecordJson {
            file: &record.name,
            kind: record.data.kind(),
            first_touch_s: Json(found.first_touch_s),
            scatter: Json(found.scatter),
            strikes: found.strikes.iter().map(strike).collect(),
            missing: &found.missing,
        };
        let computed = |&(time_s, end): &(f64, End)| ComputedJson { time_s: Json(time_s), end: letter(end) };
        AnswerJson {
            product: &question.file.product.name,
            model: fit.model.name(),
            first: letter(fit.first),
            degrees_of_freedom: fit.degrees_of_freedom,
            estimates: fit.estimates.iter().map(estimate).collect(),
            untold: fit.untold.iter().map(untold).collect(),
            correlations: fit.correlations.iter().map(|row| row.iter().copied().map(Json).collect()).collect(),
            records: question.records.iter().zip(&fit.records).map(record).collect(),
            others: fit.others.iter().map(other).collect(),
            computed: fit.computed.iter().map(computed).collect(),
            notes: &fit.notes,
        }
    }
}
