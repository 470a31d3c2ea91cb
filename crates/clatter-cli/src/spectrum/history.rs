//! This module shows the response of one component over time.

use std::io::Write;

use clatter_answer::spectrum::Measured;
use clatter_record::Channel;
use clatter_shock::{Frequencies, Suspension};

use super::Args;
use crate::numbers::digits;
use crate::output::{self, Target, buffered};
use crate::{Failure, text};

/// The number of periods of the component that are shown after the end of the record.
const PERIODS_AFTER: f64 = 5.0;
/// The number of points in each of them.
const POINTS: u32 = 16;

impl Args {
    /// Writes for each channel and damping ratio what the component feels at the samples and, with its base at rest, for five
    /// periods after the last one.
    pub(super) fn write_history(
        &self,
        records: &[Measured],
        frequencies: &Frequencies,
        target: &Target,
    ) -> Result<(), Failure> {
        let &[hz] = frequencies.hz() else {
            return Err(Failure::Usage("--history is of one component: give one --frequency"));
        };
        let [quantity, _] = self.quantity.name();
        let show = self.written();
        let name = format!("{}_{}", quantity.replace('-', "_"), show.name().replace('/', "_"));
        let dampings = self.damping.ratios()?;
        output::replace(&target.path, |file| {
            buffered(file, |out| {
                writeln!(out, "record,channel,q_factor,time_s,base_acceleration_m_s2,{name}")?;
                for damping in &dampings {
                    let part = Suspension::from_hz(hz, *damping).map_err(std::io::Error::other)?;
                    for Measured { file, record, .. } in records {
                        for channel in record.channels() {
                            let points = self.points(channel, hz);
                            let felt =
                                part.history(&points, self.quantity.quantity()).map_err(std::io::Error::other)?;
                            let of = format!(
                                "{},{},{}",
                                text::field(&text::path(file.as_ref())),
                                text::field(&channel.name),
                                digits(0.5 / damping.get())
                            );
                            for ((time_s, base), felt) in points.iter().zip(&felt) {
                                let row = [channel.times().start_s() + time_s, *base, show.value(*felt)];
                                writeln!(out, "{of},{}", row.map(digits).join(","))?;
                            }
                        }
                    }
                }
                Ok(())
            })
        })
    }

    /// Returns the points of the history of a channel, then of rest.
    fn points(&self, channel: &Channel, hz: f64) -> Vec<(f64, f64)> {
        let mut points = channel.history(self.interpolation.into());
        if let Some(&(end_s, _)) = points.last() {
            points.push((end_s, 0.0));
            let after = PERIODS_AFTER / hz / f64::from(POINTS);
            points.extend((1..=POINTS).map(|k| (end_s + f64::from(k) * after, 0.0)));
        }
        points
    }
}
