//! A record made ready: a part of it, without its baseline, within a band.

use std::sync::Arc;

use crate::{Baseline, Channel, Error, Pass, Record, Removed, TimeAxis, butterworth, remove_baseline};

impl Record {
    /// The samples of each channel from one time to another, both on the time axis of the file, in seconds.
    ///
    /// # Errors
    /// [`Error::Window`] where fewer than two samples are left.
    pub fn window(mut self, from_s: f64, to_s: f64) -> Result<Self, Error> {
        let mut cut: Vec<(Arc<TimeAxis>, usize, Arc<TimeAxis>)> = Vec::new();
        for channel in &mut self.channels {
            let known = cut.iter().find(|(whole, ..)| Arc::ptr_eq(whole, &channel.times));
            let (first, part) = if let Some((_, first, part)) = known {
                (*first, Arc::clone(part))
            } else {
                let (first, part) = channel.times.window(from_s, to_s)?;
                let part = Arc::new(part);
                cut.push((Arc::clone(&channel.times), first, Arc::clone(&part)));
                (first, part)
            };
            channel.values.truncate(first + part.samples);
            channel.values.drain(..first);
            channel.times = part;
        }
        Ok(self)
    }

    /// Takes the baseline out of every channel, and tells what was taken out; see [`remove_baseline`].
    ///
    /// # Errors
    /// [`Error::Uneven`], and those of [`remove_baseline`].
    pub fn without_baseline(&mut self, baseline: Baseline) -> Result<Vec<Removed>, Error> {
        let remove = |Channel { values, times, .. }: &mut Channel| {
            remove_baseline(values, times.even("taking out a baseline")?, baseline)
        };
        self.channels.iter_mut().map(remove).collect()
    }

    /// Filters every channel; see [`butterworth`].
    ///
    /// # Errors
    /// [`Error::Uneven`], and those of [`butterworth`].
    pub fn filter(&mut self, pass: Pass, cutoff_hz: f64, order: u32) -> Result<(), Error> {
        for Channel { values, times, .. } in &mut self.channels {
            *values = butterworth(values, times.even("a filter")?, pass, cutoff_hz, order)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{At, Options};

    #[test]
    fn a_window_keeps_times_and_lines() {
        let text = "t [s],a [g]\n1,0\n2,1\n\n3,2\n4,3\n5,4\n";
        let record = Record::read(text.as_bytes(), &Options::default(), |_| ()).expect("a record");
        let part = record.clone().window(1.5, 4.0).expect("three samples");
        let times = part.channels()[0].times();
        assert_eq!((times.samples(), times.start_s(), times.duration_s()), (3, 2.0, 2.0));
        assert_eq!(part.channels()[0].values, record.channels()[0].values[1..4]);
        assert_eq!([0, 1, 2].map(|sample| times.at(sample)), [3, 5, 6].map(At::Line));
        let error = record.window(4.5, 9.0).expect_err("one sample").to_string();
        assert_eq!(
            error,
            "the window from 4.5 s to 9 s has 1 samples; it needs two at least, and the record goes from 1 s to 5 s"
        );
    }

    #[test]
    fn uneven_records_are_not_filtered() {
        let text = "t [s],a [g]\n0,0\n1,1\n3,2\n3.5,2\n";
        let mut record = Record::read(text.as_bytes(), &Options::default(), |_| ()).expect("a record");
        assert!(matches!(record.filter(Pass::Low, 0.1, 2), Err(Error::Uneven(_))));
        let part = record.window(1.0, 3.5).expect("a window");
        assert_eq!(part.channels()[0].times().times_s().collect::<Vec<_>>(), [0.0, 2.0, 2.5]);
    }
}
