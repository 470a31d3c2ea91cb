//! A record made ready: a part of it, without its baseline, within a band.

use crate::record::Spacing;
use crate::{Baseline, Channel, Error, Pass, Record, Removed, butterworth, remove_baseline};

impl Record {
    /// The samples from one time to another, both on the time axis of the file, in seconds.
    ///
    /// # Errors
    /// [`Error::Window`] where fewer than two samples are left.
    pub fn window(mut self, from_s: f64, to_s: f64) -> Result<Self, Error> {
        let is_in = |since_s: f64| (from_s..=to_s).contains(&(self.start_s + since_s));
        let first = self.times_s().position(is_in).unwrap_or(self.samples);
        let count = self.times_s().skip(first).take_while(|since_s| is_in(*since_s)).count();
        if count < 2 {
            let end_s = self.start_s + self.duration_s();
            return Err(Error::Window { from_s, to_s, samples: count, start_s: self.start_s, end_s });
        }
        let begin_s = self.since_s(first);
        for channel in &mut self.channels {
            channel.values.truncate(first + count);
            channel.values.drain(..first);
        }
        if let Spacing::Uneven(since_s) = &mut self.spacing {
            since_s.truncate(first + count);
            since_s.drain(..first);
            for time in since_s {
                *time -= begin_s;
            }
        }
        let at = self.at(first);
        let numbering = self.numbering.iter().filter(|(sample, _)| (first + 1..first + count).contains(sample));
        let numbering = numbering.map(|(sample, at)| (sample - first, *at));
        self.numbering = std::iter::once((0, at)).chain(numbering).collect();
        self.start_s += begin_s;
        self.samples = count;
        Ok(self)
    }

    /// Takes the baseline out of every channel, and tells what was taken out; see [`remove_baseline`].
    ///
    /// # Errors
    /// [`Error::Uneven`], and those of [`remove_baseline`].
    pub fn without_baseline(&mut self, baseline: Baseline) -> Result<Vec<Removed>, Error> {
        let step_s = self.even("taking out a baseline")?;
        self.channels.iter_mut().map(|channel| remove_baseline(&mut channel.values, step_s, baseline)).collect()
    }

    /// Filters every channel; see [`butterworth`].
    ///
    /// # Errors
    /// [`Error::Uneven`], and those of [`butterworth`].
    pub fn filter(&mut self, pass: Pass, cutoff_hz: f64, order: u32) -> Result<(), Error> {
        let step_s = self.even("a filter")?;
        for Channel { values, .. } in &mut self.channels {
            *values = butterworth(values, step_s, pass, cutoff_hz, order)?;
        }
        Ok(())
    }

    /// The time between samples, for what goes with even samples alone.
    ///
    /// # Errors
    /// [`Error::Uneven`].
    pub fn even(&self, what: &'static str) -> Result<f64, Error> {
        self.step_s().ok_or(Error::Uneven(what))
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
        assert_eq!((part.samples(), part.start_s(), part.duration_s()), (3, 2.0, 2.0));
        assert_eq!(part.channels()[0].values, record.channels()[0].values[1..4]);
        assert_eq!([0, 1, 2].map(|sample| part.at(sample)), [3, 5, 6].map(At::Line));
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
        assert_eq!(part.times_s().collect::<Vec<_>>(), [0.0, 2.0, 2.5]);
    }
}
