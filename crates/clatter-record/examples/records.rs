//! Our side of `peers/records.py`: reads records of text and makes spectra of them, both timed, one thread.
//!
//!     records FILE LOW_HZ HIGH_HZ COUNT ROUNDS

use clatter_record::{Between, Options, Record};
use clatter_shock::{DampingRatio, Frequencies, Quantity};
use serde_json::json;
use std::io::Write;
use std::time::{Duration, Instant};

/// The answer and the least time.
fn smallest_time<T>(rounds: u32, mut run: impl FnMut() -> T) -> (T, Duration) {
    let mut one = || {
        let begin = Instant::now();
        let answer = run();
        (answer, begin.elapsed())
    };
    let mut best = one();
    for _ in 1..rounds {
        let next = one();
        best = if next.1 < best.1 { next } else { best };
    }
    best
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let [file, low, high, count, rounds] = &given[..] else { return Err("FILE LOW_HZ HIGH_HZ COUNT ROUNDS".into()) };
    let (low, high, count, rounds): (f64, f64, u32, u32) =
        (low.parse()?, high.parse()?, count.parse()?, rounds.parse()?);
    let share = |i: u32| f64::from(i) / f64::from((count - 1).max(1));
    let frequencies = Frequencies::list((0..count).map(|i| low * libm::pow(high / low, share(i))).collect())?;
    let read = || Record::read(std::fs::File::open(file)?, &Options::default(), |_| ()).map_err(std::io::Error::other);
    let (record, reading) = smallest_time(rounds, read);
    let record = record?;
    let damping = DampingRatio::from_quality_factor(10.0)?;
    let mut answer = json!({ "samples": record.channels()[0].values.len(), "reading_ms": reading.as_secs_f64() * 1e3 });
    for (name, between) in [("linear", Between::Linear), ("band_limited", Between::BandLimited)] {
        let spectrum = || {
            let channel = &record.channels()[0];
            channel.spectrum(&frequencies, damping, Quantity::AbsoluteAcceleration, between, |_| ())
        };
        let (spectrum, time) = smallest_time(rounds, spectrum);
        answer[name] = json!({ "ms": time.as_secs_f64() * 1e3, "maximax": spectrum?.maximax });
    }
    writeln!(std::io::stdout().lock(), "{answer}")?;
    Ok(())
}
