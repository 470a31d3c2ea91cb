//! Findings tell what is odd about a record, which is used all the same.

use crate::error::Bad;
use clatter_shock::samples::float;
use std::f64::consts::TAU;
use std::ops::Range;

/// Something about a record that its owner should know.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Finding {
    /// Columns that nothing is made of.
    LeftOut(Vec<String>),
    /// A note of the reader on the file.
    Note(String),
    /// Something about channels of one time, where others have another.
    Of {
        /// Names of the channels.
        channels: String,
        /// The finding.
        finding: Box<Self>,
    },
    /// Lines that were left out, as they cannot be used.
    Skipped(Bad),
    /// Lines of text below the numbers.
    Below(Bad),
    /// A rate that is told, and times that say another one.
    Rate {
        /// Who tells it.
        what: String,
        /// The rate that is told, in Hz.
        told_hz: f64,
        /// The rate of the times, in Hz.
        times_hz: f64,
    },
    /// Steps in time that lack samples: longer than the usual ones by more than these differ. At most ten are listed.
    Gaps {
        /// Where each ends, and its length in seconds.
        first: Vec<(At, f64)>,
        /// How many there are.
        count: usize,
        /// The usual step in seconds.
        usual_s: f64,
    },
    /// Two samples at one time each: taken as jumps. At most ten are listed.
    Jumps {
        /// The second sample of each.
        first: Vec<At>,
        /// How many there are.
        count: usize,
    },
    /// The record begins within a shock, or away from zero.
    Begins {
        /// Name of the channel.
        channel: String,
        /// Its first value over its largest.
        share: f64,
    },
    /// The record ends within a shock, or away from zero.
    Ends {
        /// Name of the channel.
        channel: String,
        /// Its last value over its largest.
        share: f64,
    },
    /// The level before the shock is not zero, by so much that the spectrum shows it.
    Offset {
        /// Name of the channel.
        channel: String,
        /// From where to where the level was taken.
        from: At,
        /// Its end.
        to: At,
        /// The level in m/s².
        level_m_s2: f64,
        /// The share of the spectrum that it may change at the lowest frequency.
        share: f64,
        /// That frequency in Hz.
        hz: f64,
    },
    /// The level strays from that before the shock, over a quarter of the record or at its end, by so much that the spectrum shows it.
    Drift {
        /// Name of the channel.
        channel: String,
        /// From where the level was taken.
        from: At,
        /// Its end.
        to: At,
        /// The level there less that before the shock, in m/s².
        change_m_s2: f64,
        /// The share of the spectrum that it may change at the lowest frequency.
        share: f64,
        /// That frequency in Hz.
        hz: f64,
    },
    /// A value, of one sample or of several, is far beyond all others: it may stand for no value.
    Outlier {
        /// Name of the channel.
        channel: String,
        /// The first sample that has it.
        at: At,
        /// The value in m/s².
        value_m_s2: f64,
        /// How many times the largest of all others it is.
        times: f64,
    },
    /// Samples in a row have the very largest value: the amplifier or the converter may have been at its end.
    Clipped {
        /// Name of the channel.
        channel: String,
        /// The first of them.
        at: At,
        /// How many.
        samples: usize,
        /// Their value in m/s².
        value_m_s2: f64,
    },
}

/// A place in a file: a line of a text, else the number of a sample; both from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum At {
    /// A line.
    Line(usize),
    /// A sample.
    Sample(usize),
}

impl std::fmt::Display for At {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Sample(sample) => write!(f, "sample {sample}"),
        }
    }
}

impl At {
    /// The place of a sample, from 0, by the samples that do not follow on the one before.
    pub(crate) fn of(numbering: &[(usize, Self)], sample: usize) -> Self {
        let run = numbering.partition_point(|(first, _)| *first <= sample).checked_sub(1).map(|run| numbering[run]);
        run.map_or(Self::Sample(sample + 1), |(first, at)| at.after(sample - first))
    }
    /// So many places on.
    pub(crate) fn after(self, count: usize) -> Self {
        match self {
            Self::Line(line) => Self::Line(line + count),
            Self::Sample(sample) => Self::Sample(sample + count),
        }
    }
    /// Of the line, or of the sample.
    pub(crate) fn number(self) -> usize {
        let (Self::Line(number) | Self::Sample(number)) = self;
        number
    }
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let percent = |share: f64| three(100.0 * share);
        match self {
            Self::Note(note) => f.write_str(note),
            Self::Of { channels, finding } => write!(f, "{channels}: {finding}"),
            Self::LeftOut(columns) => write!(f, "nothing is made of column {}", columns.join(", ")),
            Self::Skipped(bad) => {
                write!(f, "left out: {}", crate::Error::Lines(bad.clone()).to_string().replace('\n', "; "))
            }
            Self::Below(bad) => {
                let first = bad.first.first().map(|(at, what)| format!(": {at}: {what}")).unwrap_or_default();
                write!(f, "text below the numbers{first}")
            }
            Self::Rate { what, told_hz, times_hz } => {
                write!(f, "{what}, {} Hz, is not that of the times, {} Hz", three(*told_hz), three(*times_hz))
            }
            Self::Gaps { first, count, usual_s } => {
                let listed: Vec<_> = first.iter().map(|(at, gap_s)| format!("{at}: {} s", three(*gap_s))).collect();
                write!(
                    f,
                    "samples are missing: usual are {} s from one to the next; {}",
                    three(*usual_s),
                    listed.join("; ")
                )?;
                if *count > first.len() { write!(f, "; and {} more", count - first.len()) } else { Ok(()) }
            }
            Self::Jumps { first, count } => {
                let listed: Vec<_> = first.iter().map(At::to_string).collect();
                write!(f, "two samples at one time are a jump: {}", listed.join(", "))?;
                if *count > first.len() { write!(f, " and {} more", count - first.len()) } else { Ok(()) }
            }
            Self::Begins { channel, share } | Self::Ends { channel, share } => {
                let [does, what] = match self {
                    Self::Begins { .. } => ["begins", "begins before the record"],
                    _ => ["ends", "is cut off"],
                };
                let share = percent(*share);
                write!(f, "{channel} {does} at {share} % of its largest value: the shock {what}, or there is an offset")
            }
            Self::Offset { channel, from, to, level_m_s2: level, share, hz }
            | Self::Drift { channel, from, to, change_m_s2: level, share, hz } => {
                let what =
                    if let Self::Drift { .. } = self { "from the level before the shock" } else { "before the shock" };
                let [level, share, hz] = [three(*level), percent(*share), three(*hz)];
                write!(f, "{channel}, {from} to {to}: {level} m/s2 {what}, up to {share} % of the spectrum at {hz} Hz")
            }
            Self::Outlier { channel, at, value_m_s2, times } => {
                let [value, times] = [*value_m_s2, *times].map(three);
                write!(
                    f,
                    "{channel}, {at}: {value} m/s2 is {times} times as large as all other values: it may stand for no value"
                )
            }
            Self::Clipped { channel, at, samples, value_m_s2 } => write!(
                f,
                "{channel}, from {at} on: {samples} samples at {} m/s2, the largest of all: it may be clipped",
                three(*value_m_s2)
            ),
        }
    }
}

/// Three significant digits.
fn three(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    #[expect(clippy::cast_possible_truncation, reason = "a float has at most 308 digits")]
    let place = libm::log10(value.abs()).floor() as i32;
    if (-3..6).contains(&place) {
        let text = format!("{value:.*}", usize::try_from(2 - place).unwrap_or(0));
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        format!("{value:.2e}")
    }
}

/// A shock begins and ends where the acceleration passes this share of the largest: the 10 % of the standards.
pub(crate) const EDGE: f64 = 0.1;
/// A value so many times all others is no acceleration of the same shock.
const OUTLIER: f64 = 100.0;
/// Offsets that change a spectrum by less are not told.
const TOLD: f64 = 0.02;
/// A level is told from noise where it is so many times its standard error, of the means of so many parts: one in two hundred
/// by chance.
const SURE: f64 = 4.0;
const PARTS: usize = 8;
const SIXTEENTHS: usize = 16;
/// Samples that a level needs.
const LEAST: usize = 16;
/// So many samples of the very largest value are no accident, where the steps beside them are so many times the smallest step that
/// there is, or the values beside them come so many times less often in a row. A crest in coarse steps has at most 4.9 times as
/// many samples as the values beside it: √2/(√4 − √2), twice, where steps are cut.
const FLAT: usize = 3;
const ABRUPT: f64 = 8.0;
const LONGER: usize = 6;
/// Places that are listed, of one kind.
pub(crate) const LISTED: usize = 10;
/// Steps are whole numbers of the usual one where they are off them by no more than this share of it.
const WHOLE: f64 = 0.05;
/// Where more than one step in so many is long, the record is uneven, and nothing is missing.
const MOST_GAPS: usize = 6;
/// A step is a gap where it is longer than the usual one by half of it, and by so many times what nine of ten differ by: beyond
/// what a normal distribution gives once in a million.
const GAP: (f64, f64) = (0.5, 3.0);

/// The usual step, and by how much nine steps of ten differ from it at most. `since_s` is in order.
fn usual(steps: &[f64]) -> [f64; 2] {
    let share = |mut values: Vec<f64>, share: usize| {
        let nth = (values.len() - 1) * share / 10;
        *values.select_nth_unstable_by(nth, f64::total_cmp).1
    };
    let usual_s = share(steps.to_vec(), 5);
    // Where all steps are whole numbers of the usual one, and few are more than one, the long ones lack samples.
    let off = |step: &f64| step / usual_s - (step / usual_s).round();
    let is_whole = usual_s > 0.0 && steps.iter().all(|step| off(step).abs() < WHOLE);
    if is_whole && MOST_GAPS * steps.iter().filter(|step| **step > 1.5 * usual_s).count() <= steps.len() {
        return [usual_s, WHOLE * usual_s];
    }
    [usual_s, share(steps.iter().map(|step| (step - usual_s).abs()).collect(), 9)]
}

/// Returns whether samples are of events: their steps differ by more than they are long, and none of them is missing.
pub(crate) fn is_of_events(since_s: &[f64]) -> bool {
    let steps: Vec<f64> = since_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let [usual_s, spread] = usual(&steps);
    spread > usual_s
}

/// Steps that lack samples. `since_s` is in order.
pub(crate) fn gaps(since_s: &[f64], at: &dyn Fn(usize) -> At) -> Option<Finding> {
    let steps: Vec<f64> = since_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.len() < 4 || is_of_events(since_s) {
        return None;
    }
    let [usual_s, spread] = usual(&steps);
    let longest = usual_s + (GAP.0 * usual_s).max(GAP.1 * spread);
    // Between usual steps: where long ones follow one another the record is that of events.
    let is_long = |i: usize| steps.get(i).is_some_and(|step| *step > longest);
    let found: Vec<usize> =
        (0..steps.len()).filter(|i| is_long(*i) && !is_long(i + 1) && !(*i > 0 && is_long(i - 1))).collect();
    let count = if MOST_GAPS * found.len() > steps.len() { 0 } else { found.len() };
    let first = found.iter().take(LISTED).map(|i| (at(i + 1), steps[*i])).collect();
    (count > 0).then_some(Finding::Gaps { first, count, usual_s })
}

/// A level over some samples, if it is sure that it is not zero: the mean is far beyond what the means of its parts differ by, and
/// what both halves differ by is less than half of it.
fn level(values: &[f64]) -> Option<f64> {
    if values.len() < LEAST {
        return None;
    }
    let means: Vec<f64> = values.chunks_exact(values.len() / PARTS).take(PARTS).map(mean).collect();
    let (all, error) = with_error(&means);
    let (first, second) = means.split_at(PARTS / 2);
    let ((first, of_first), (second, of_second)) = (with_error(first), with_error(second));
    let flat = (second - first).abs() < 0.5 * all.abs() + 2.0 * libm::hypot(of_first, of_second);
    (flat && all.abs() > SURE * error).then_some(all)
}

/// The mean over some samples less a level, if it is sure that it is not that.
fn changed(values: &[f64], base: f64) -> Option<f64> {
    let means: Vec<f64> = values.chunks_exact(values.len() / PARTS).take(PARTS).map(|part| mean(part) - base).collect();
    let (all, error) = with_error(&means);
    (all.abs() > SURE * error).then_some(all)
}

/// The mean of some numbers and its standard error.
fn with_error(values: &[f64]) -> (f64, f64) {
    let all = mean(values);
    let square: f64 = values.iter().map(|part| (part - all).powi(2)).sum();
    let count = float(values.len());
    (all, (square / (count * (count - 1.0))).sqrt())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / float(values.len())
}

/// A channel that is inspected, its duration and the lowest frequency that matters.
pub(crate) struct Inspection<'a> {
    pub(crate) channel: &'a str,
    pub(crate) values: &'a [f64],
    pub(crate) duration_s: f64,
    /// Levels are means over time only where samples are even.
    pub(crate) is_even: bool,
    pub(crate) lowest_hz: f64,
    pub(crate) at: &'a dyn Fn(usize) -> At,
}

impl Inspection<'_> {
    /// Adds what is odd.
    pub(crate) fn add_to(&self, findings: &mut Vec<Finding>) {
        let values = self.values;
        let largest = values.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
        let (Some(first), Some(last)) = (values.first(), values.last()) else { return };
        if largest == 0.0 {
            return;
        }
        let channel = || self.channel.to_owned();
        let inside = |a: f64| a.abs() > EDGE * largest;
        if inside(*first) {
            findings.push(Finding::Begins { channel: channel(), share: first.abs() / largest });
        }
        if inside(*last) {
            findings.push(Finding::Ends { channel: channel(), share: last.abs() / largest });
        }
        let others = values.iter().map(|a| a.abs()).filter(|a| *a < largest).fold(0.0, f64::max);
        if others > 0.0 && largest > OUTLIER * others {
            let at = values.iter().position(|a| a.abs() >= largest).unwrap_or(0);
            let (at, value_m_s2, times) = ((self.at)(at), values[at], largest / others);
            findings.push(Finding::Outlier { channel: channel(), at, value_m_s2, times });
        }
        self.clipped(largest, findings);
        if self.is_even {
            self.levels(largest, findings);
        }
    }

    /// Offset and drift.
    fn levels(&self, largest: f64, findings: &mut Vec<Finding>) {
        let values = self.values;
        let channel = || self.channel.to_owned();
        let inside = |a: f64| a.abs() > EDGE * largest;
        let begin = values.iter().position(|a| inside(*a)).unwrap_or(0);
        let end = values.iter().rposition(|a| inside(*a)).map_or(values.len(), |last| last + 1);
        // The first half of what is before the shock, and the last half of what is after it: its feet and its ringing are not in.
        let before = level(&values[..begin / 2]);
        let base = before.unwrap_or(0.0);
        let swing = self.velocity_swing(base);
        let share = |level: f64| {
            let turn = TAU * self.lowest_hz;
            let [offset, shock] = [(2.0 * level.abs(), level.abs() * self.duration_s), (2.0 * largest, swing)]
                .map(|(at_most, velocity)| at_most.min(turn * velocity));
            offset / shock
        };
        let hz = self.lowest_hz;
        if let Some(level_m_s2) = before.filter(|level| share(*level) > TOLD) {
            let (from, to) = ((self.at)(0), (self.at)(begin / 2 - 1));
            findings.push(Finding::Offset { channel: channel(), from, to, level_m_s2, share: share(level_m_s2), hz });
        }
        for (from, to, change_m_s2) in self.strays(base, begin..end) {
            if share(change_m_s2) > TOLD {
                let (from, to, share) = ((self.at)(from), (self.at)(to - 1), share(change_m_s2));
                findings.push(Finding::Drift { channel: channel(), from, to, change_m_s2, share, hz });
            }
        }
    }

    /// Where the level strays from that before the shock, in sixteenths of the record: to one side over a quarter of it or more, or
    /// at the end. Parts of the shock are none of a level. From, to, and by how much.
    fn strays(&self, base: f64, shock: Range<usize>) -> Vec<(usize, usize, f64)> {
        let (values, length) = (self.values, self.values.len() / SIXTEENTHS);
        if length < LEAST {
            return Vec::new();
        }
        let bound = |k: usize| if k == SIXTEENTHS { values.len() } else { k * length };
        let parts: Vec<f64> = (0..SIXTEENTHS)
            .map(|k| {
                let part = bound(k)..bound(k + 1);
                let is_shock = part.start < shock.end && shock.start < part.end;
                let sure = if is_shock { None } else { changed(&values[part.clone()], base) };
                sure.unwrap_or(0.0)
            })
            .collect();
        let mut found = Vec::new();
        let mut end = 0;
        for run in parts.chunk_by(|a, b| a * b > 0.0) {
            let begin = end;
            end += run.len();
            if run[0] != 0.0 && (4 * run.len() >= SIXTEENTHS || end == SIXTEENTHS) {
                found.push((bound(begin), bound(end), mean(run)));
            }
        }
        found
    }

    /// How far the velocity goes, from its least to its most, without what a level adds: in m/s.
    fn velocity_swing(&self, level: f64) -> f64 {
        let step_s = self.duration_s / float((self.values.len() - 1).max(1));
        let (mut velocity, mut least, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
        for a in self.values {
            velocity += (a - level) * step_s;
            (least, most) = (least.min(velocity), most.max(velocity));
        }
        most - least
    }

    fn clipped(&self, largest: f64, findings: &mut Vec<Finding>) {
        let values = self.values;
        let smallest = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0);
        let smallest = smallest.fold(f64::INFINITY, f64::min);
        let runs: Vec<&[f64]> = values.chunk_by(|a, b| a.to_bits() == b.to_bits()).collect();
        let mut end = 0;
        for (i, run) in runs.iter().enumerate() {
            let begin = end;
            end += run.len();
            if run.len() < FLAT || run[0].abs() < largest {
                continue;
            }
            let beside = || [i.checked_sub(1), Some(i + 1)].into_iter().flatten().filter_map(|k| runs.get(k));
            let least = beside().map(|other| (other[0] - run[0]).abs()).fold(f64::INFINITY, f64::min);
            let longest = beside().map(|other| other.len()).max().unwrap_or(1);
            if least > ABRUPT * smallest || run.len() >= LONGER * longest {
                let (at, samples, value_m_s2) = ((self.at)(begin), run.len(), run[0]);
                findings.push(Finding::Clipped { channel: self.channel.to_owned(), at, samples, value_m_s2 });
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means of parts at 1 + d and 1 − d in turn: their mean is 1 within d/√7, the deviation d √(8/7) of eight over √8. It is told from
    /// four times that on: up to d = √7/4 = 0.661.
    #[test]
    fn a_level_is_told_from_four_standard_errors_on() {
        let of = |d: f64| {
            let values: Vec<f64> =
                (0..8 * LEAST).map(|i| if (i / LEAST).is_multiple_of(2) { 1.0 + d } else { 1.0 - d }).collect();
            (with_error(&values.chunks(LEAST).map(mean).collect::<Vec<_>>()), level(&values))
        };
        let ((all, error), _) = of(0.5);
        assert!((all - 1.0).abs() < 1e-15 && (error - 0.5 / 7_f64.sqrt()).abs() < 1e-15, "{all}, {error}");
        assert!(of(0.65).1.is_some_and(|level| (level - 1.0).abs() < 1e-12) && of(0.67).1.is_none());
    }
}
