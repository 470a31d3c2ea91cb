//! This module computes shock response spectra of records, pulses and velocity shocks, and compares them with limits and required spectra.
//!
//! ```
//! use clatter_answer::spectrum::{self, Excitation};
//! use clatter_shock::{DampingRatio, Frequencies, LimitCurve, Pulse, Shape};
//! // A half-sine of 1000 m/s² and 0.5 ms, for a part of 100 Hz that stands 100 m/s².
//! let pulse = Pulse { shape: Shape::HalfSine, amplitude: 1000.0, duration: 5e-4, start: 0.0 };
//! let mut question = spectrum::Question::new(Excitation::Pulses(vec![pulse]), DampingRatio::new(0.05)?);
//! question.frequencies = Some(Frequencies::list(vec![100.0])?);
//! question.limit = Some(LimitCurve::constant(100.0)?);
//! let answer = spectrum::answer(&question)?;
//! assert!(answer.parts[0].exceeds());
//! # Ok::<(), clatter_answer::Error>(())
//! ```

pub mod boundary;
mod json;

use clatter_product::units::Unit;
use clatter_record::{Between, Channel, Record, TimeAxis};
use clatter_shock::{
    DampingRatio, Deviation, EnvelopingPulse, Frequencies, LimitCurve, Margin, Pulse, Pulses, Quantity,
    RequiredSpectrum, Search, Shape, Spectrum, Stop, Summary, VelocityShocks, find_shocks,
};

use crate::error::within_periods;
use crate::numbers::figures;
use crate::record::LOWEST_HZ;
use crate::{Error, visible};
use boundary::Boundary;

/// The source of the shocks on the parts.
#[derive(Debug, Clone)]
pub enum Excitation {
    /// Records: a spectrum for each channel.
    Records(Vec<Measured>),
    /// Pulses, which may overlap.
    Pulses(Vec<Pulse>),
    /// Velocity shocks.
    Shocks(VelocityShocks),
}

/// A record, made ready.
#[derive(Debug, Clone)]
pub struct Measured {
    /// Its file, as the answer has it.
    pub file: String,
    /// The name that distinguishes its spectra from those of other records.
    pub name: Option<String>,
    /// The record.
    pub record: Record,
    /// The name of the shock, where the record is split into its shocks.
    pub shock: Option<String>,
}

/// The largest number of shocks of one record that have spectra.
const MOST: usize = 100;

impl Measured {
    /// Splits a record into its shocks, found on the channel with the largest one: of all channels, from half the quiet time before a
    /// shock to the next one.
    ///
    /// # Errors
    /// Uneven times, or no shocks, or more than 100.
    pub fn apart(&self, search: &Search) -> Result<Vec<Self>, Error> {
        let Some(channel) = self.record.channels().iter().max_by(|a, b| largest(a).total_cmp(&largest(b))) else {
            return Ok(Vec::new());
        };
        let times = channel.times();
        let found = find_shocks(&channel.values, times.even("a search for shocks")?, search)
            .map_err(clatter_record::Error::from)?;
        let count = found.shocks.len() + found.omitted;
        if count == 0 || count > MOST {
            return Err(Error::Shocks { count, threshold_m_s2: found.threshold_m_s2, most: MOST });
        }
        let starts: Vec<f64> =
            found.shocks.iter().map(|shock| times.start_s() + shock.start_s - 0.5 * search.quiet_s).collect();
        let ends = starts.iter().copied().skip(1).chain([f64::INFINITY]);
        let one = |(n, (from_s, to_s)): (usize, (f64, f64))| {
            let at = figures(times.start_s() + found.shocks[n].peak_time_s);
            let shock = Some(format!("shock {} at {at} s", n + 1));
            Ok(Self { record: self.record.clone().window(from_s, to_s)?, shock, ..self.clone() })
        };
        starts.iter().copied().zip(ends).enumerate().map(one).collect()
    }
}

/// The source of the shocks, and the parts that it acts on.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The source of the shocks.
    pub excitation: Excitation,
    /// Their natural frequencies; else 12 to the octave, from 10 Hz to 10 kHz, of records up to a third of the sampling rate.
    pub frequencies: Option<Frequencies>,
    /// A spectrum for each.
    pub dampings: Vec<DampingRatio>,
    /// The stops of all parts; records are then straight lines between their samples.
    pub stop: Option<Stop>,
    /// The requested quantity of the response.
    pub quantity: Quantity,
    /// The course of a record between its samples.
    pub between: Between,
    /// The limit that the parts survive.
    pub limit: Option<LimitCurve>,
    /// The spectrum that a test had to reach.
    pub required: Option<RequiredSpectrum>,
    /// The shape of the pulse that is found to envelop each spectrum.
    pub enveloping: Option<Shape>,
    /// True where the root of the sum of squares of all channels of a record is given as well.
    pub resultant: bool,
    /// True where the largest value of all channels of all records is given as well.
    pub envelope: bool,
    /// True where the mean of all channels of all records, plus 3 dB, is given as well.
    pub mean_3db: bool,
    /// The unit in which the quantity is serialized; SI where there is none.
    pub unit: Option<&'static Unit>,
}

impl Question {
    /// Requests the absolute acceleration, with records taken as band-limited, and nothing else.
    #[must_use]
    pub fn new(excitation: Excitation, damping: DampingRatio) -> Self {
        Self {
            excitation,
            frequencies: None,
            dampings: vec![damping],
            stop: None,
            quantity: Quantity::AbsoluteAcceleration,
            between: Between::BandLimited,
            limit: None,
            required: None,
            enveloping: None,
            resultant: false,
            envelope: false,
            mean_3db: false,
            unit: None,
        }
    }

    /// Returns the records, if they are the source of the shocks.
    #[must_use]
    pub fn records(&self) -> &[Measured] {
        if let Excitation::Records(records) = &self.excitation { records } else { &[] }
    }

    /// Returns the natural frequencies.
    ///
    /// # Errors
    /// Records whose samples are so far apart that there are none.
    pub fn frequencies(&self) -> Result<Frequencies, Error> {
        if let Some(frequencies) = &self.frequencies {
            return Ok(frequencies.clone());
        }
        let times = self.records().iter().flat_map(|measured| measured.record.times());
        let third = |times: &TimeAxis| times.step_s().map(|step_s| (3.0 * step_s).recip());
        let high = times.filter_map(third).fold(HIGHEST_HZ, f64::min);
        // The range is three decades where the samples are few.
        let low = LOWEST_HZ.min(high * LOWEST_HZ / HIGHEST_HZ);
        Ok(Frequencies::per_octave(low, high, PER_OCTAVE)?)
    }
}

/// The highest natural frequency unless others are requested, and how many there are to the octave.
const HIGHEST_HZ: f64 = 10_000.0;
const PER_OCTAVE: f64 = 12.0;

/// The spectra of one excitation and all that goes with them.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer<'a> {
    /// The question.
    pub question: &'a Question,
    /// The natural frequencies.
    pub frequencies: Frequencies,
    /// The spectra: one for each channel and damping ratio, and those made of several; at least one.
    pub parts: Vec<Part>,
    /// The damage boundary that is shown with the spectra.
    pub boundary: Option<Boundary>,
}

/// A spectrum, and what is held against it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Part {
    /// The name of the record or channel, where there are several.
    pub name: Option<String>,
    /// The spectrum.
    pub spectrum: Spectrum,
    /// The margins to the limit.
    pub margins: Option<Vec<Option<Margin>>>,
    /// The deviations from the required spectrum.
    pub deviations: Option<Vec<Option<Deviation>>>,
    /// The pulse that envelops it.
    pub enveloping: Option<EnvelopingPulse>,
}

impl Part {
    fn new(question: &Question, name: Option<String>, spectrum: Spectrum) -> Result<Self, Error> {
        let enveloping = question.enveloping.map(|shape| EnvelopingPulse::of(&spectrum, shape)).transpose()?;
        Ok(Self {
            name,
            margins: question.limit.as_ref().map(|limit| limit.margins(&spectrum)),
            deviations: question.required.as_ref().map(|required| required.deviations(&spectrum)),
            enveloping: enveloping.flatten(),
            spectrum,
        })
    }

    /// Returns whether the spectrum exceeds the limit.
    #[must_use]
    pub fn exceeds(&self) -> bool {
        self.margins.iter().flatten().flatten().any(|margin| !margin.is_safe())
    }

    /// Returns whether the spectrum reaches a required one; none where a part of the required one is not covered and the rest is reached.
    #[must_use]
    pub fn reaches(&self, required: &RequiredSpectrum) -> Option<bool> {
        let mut told = self.deviations.iter().flatten().flatten().peekable();
        told.peek()?;
        let is_reached = told.all(Deviation::is_reached);
        if is_reached && beyond(required, &self.spectrum.frequency_hz).is_some() { None } else { Some(is_reached) }
    }
}

/// Returns the range of a required spectrum and that of the frequencies, where these do not cover it.
#[must_use]
pub fn beyond(required: &RequiredSpectrum, hz: &[f64]) -> Option<[f64; 4]> {
    let [from, to] = required.curve().range_hz()?;
    let (low, high) = hz.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), hz| (low.min(*hz), high.max(*hz)));
    (from < low || to > high).then_some([from, to, low, high])
}

/// Returns the lowest and the highest of the deviations, with their places.
#[must_use]
pub fn outermost(deviations: &[Option<Deviation>]) -> Option<[(usize, Deviation); 2]> {
    let told = || deviations.iter().enumerate().filter_map(|(i, of)| Some((i, (*of)?)));
    let share = |of: &Deviation| of.reached / of.required;
    let low = told().min_by(|a, b| share(&a.1).total_cmp(&share(&b.1)))?;
    let high = told().max_by(|a, b| share(&a.1).total_cmp(&share(&b.1)))?;
    Some([low, high])
}

/// Returns the name of a quantity, and its unit.
#[must_use]
pub fn name(quantity: Quantity) -> [&'static str; 2] {
    match quantity {
        Quantity::AbsoluteAcceleration => ["acceleration", "m/s2"],
        Quantity::RelativeDisplacement => ["relative-displacement", "m"],
        Quantity::RelativeVelocity => ["relative-velocity", "m/s"],
        Quantity::PseudoVelocity => ["pseudo-velocity", "m/s"],
        Quantity::EquivalentStaticAcceleration => ["equivalent-static-acceleration", "m/s2"],
    }
}

/// Returns the largest acceleration of a channel, in size.
#[must_use]
pub fn largest(channel: &Channel) -> f64 {
    channel.values.iter().fold(0.0_f64, |most, a| most.max(a.abs()))
}

/// Works out all spectra.
///
/// # Errors
/// Fails for frequencies that a record does not cover, records whose channels have no one time for a resultant, pulses that are none or
/// that last too long.
pub fn answer(question: &Question) -> Result<Answer<'_>, Error> {
    counted(question, |_| ())
}

/// Works out all spectra as [`answer`] does, and counts the samples of records that are done, of each damping ratio.
///
/// # Errors
/// As [`answer`].
pub fn counted(question: &Question, mut progress: impl FnMut(u64)) -> Result<Answer<'_>, Error> {
    let Question { dampings, quantity, .. } = question;
    let list = question.frequencies()?;
    let alone = |spectrum: &dyn Fn(DampingRatio) -> Spectrum| dampings.iter().map(|of| (None, spectrum(*of))).collect();
    let spectra: Vec<(Option<String>, Spectrum)> = match &question.excitation {
        Excitation::Records(records) => of_records(question, records, &list, &mut progress)?,
        Excitation::Shocks(shocks) => alone(&|damping| match question.stop {
            Some(stop) => shocks.pulses().spectrum_with_stop(&list, damping, *quantity, stop),
            None => shocks.spectrum(&list, damping, *quantity),
        }),
        Excitation::Pulses(pulses) => {
            within_periods(pulses, list.hz())?;
            let pulses = Pulses::new(pulses)?;
            alone(&|damping| match question.stop {
                Some(stop) => pulses.spectrum_with_stop(&list, damping, *quantity, stop),
                None => pulses.spectrum(&list, damping, *quantity),
            })
        }
    };
    let parts =
        spectra.into_iter().map(|(name, spectrum)| Part::new(question, name, spectrum)).collect::<Result<_, _>>()?;
    Ok(Answer { question, frequencies: list, parts, boundary: None })
}

const RESULTANT: &str = "resultant";

/// Computes a spectrum for each channel and damping ratio, then those made of several.
fn of_records(
    question: &Question,
    records: &[Measured],
    list: &Frequencies,
    progress: &mut dyn FnMut(u64),
) -> Result<Vec<(Option<String>, Spectrum)>, Error> {
    let bad = |measured: &Measured| {
        let file = measured.file.clone();
        move |reason| Error::OfRecord { file, reason }
    };
    if question.resultant {
        for measured in records {
            measured.record.one_time("a resultant").map_err(bad(measured))?;
        }
    }
    let count: usize = records.iter().map(|measured| measured.record.channels().len()).sum();
    let mut done = 0;
    let mut found = Vec::new();
    for damping in &question.dampings {
        let mut of_channels: Vec<Spectrum> = Vec::with_capacity(count);
        let mut resultants = Vec::new();
        let mut names = Vec::new();
        for measured in records {
            let first = of_channels.len();
            for channel in measured.record.channels() {
                let progress = |samples| progress(done + samples);
                let spectrum = match question.stop {
                    Some(stop) => with_stop(channel, list, *damping, question.quantity, stop),
                    None => channel.spectrum(list, *damping, question.quantity, question.between, progress),
                };
                of_channels.push(spectrum.map_err(bad(measured))?);
                done += channel.values.len() as u64;
                names.push((count > 1).then(|| measured.called(&visible(&channel.name))));
            }
            if question.resultant {
                let of_channels = measured.record.channels().iter().zip(&of_channels[first..]);
                let axes: Vec<&Spectrum> =
                    of_channels.filter(|(channel, _)| !channel.is_resultant()).map(|(_, spectrum)| spectrum).collect();
                let resultant = Spectrum::summary(&axes, Summary::RootSumSquare);
                resultants.extend(resultant.map(|spectrum| (Some(measured.called(RESULTANT)), spectrum)));
            }
        }
        let every: Vec<&Spectrum> = of_channels.iter().collect();
        let summaries = [
            (question.envelope, Summary::Envelope, "envelope"),
            (question.mean_3db, Summary::MeanPlus3Db, "mean + 3 dB"),
        ];
        let summaries: Vec<_> = summaries
            .into_iter()
            .filter(|(asked, ..)| *asked)
            .filter_map(|(_, summary, name)| Some((Some(name.to_owned()), Spectrum::summary(&every, summary)?)))
            .collect();
        found.extend(names.into_iter().zip(of_channels));
        found.extend(resultants);
        found.extend(summaries);
    }
    Ok(found)
}

/// Computes the spectrum of parts with stops, of a record that is straight between its samples.
fn with_stop(
    channel: &Channel,
    list: &Frequencies,
    damping: DampingRatio,
    quantity: Quantity,
    stop: Stop,
) -> Result<Spectrum, clatter_record::Error> {
    let points: Vec<(f64, f64)> = channel.times().times_s().zip(channel.values.iter().copied()).collect();
    Ok(Pulses::piecewise_linear(&points)?.spectrum_with_stop(list, damping, quantity, stop))
}

impl Measured {
    /// Names a channel by its record where there are several records, by its own name where there are several channels or no other name,
    /// and by the shock.
    fn called(&self, channel: &str) -> String {
        let several = self.record.channels().len() > 1 || channel == RESULTANT;
        let named = several || self.name.is_none() && self.shock.is_none();
        let parts = [self.name.clone(), named.then(|| channel.to_owned())];
        let name = parts.into_iter().flatten().collect::<Vec<_>>().join(": ");
        let shock = self.shock.clone().into_iter();
        Some(name).filter(|name| !name.is_empty()).into_iter().chain(shock).collect::<Vec<_>>().join(", ")
    }
}
