//! Our side of `peers/spectra.py`: reads pulses, frequencies and sampling rates as JSON from standard input, writes
//! spectra and times.
//!
//! Each time is the best of at least five runs and 0.3 s on one thread, setting up included.

use clatter_shock::{DampingRatio, Frequencies, Pulse, Pulses, Quantity, Shape, SpectrumFilter};
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::time::{Duration, Instant};

/// Returns the answer and the least time.
fn smallest_time<T>(mut run: impl FnMut() -> T) -> (T, Duration) {
    let (begin, mut least, mut runs, mut answer) = (Instant::now(), Duration::MAX, 0, run());
    while runs < 5 || begin.elapsed().as_secs_f64() < 0.3 {
        let start = Instant::now();
        answer = run();
        least = least.min(start.elapsed());
        runs += 1;
    }
    (answer, least)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text)?;
    let input: Value = serde_json::from_str(&text)?;
    let numbers = |v: &Value| -> Vec<f64> { v.as_array().into_iter().flatten().filter_map(Value::as_f64).collect() };
    let frequencies = Frequencies::list(numbers(&input["frequency_hz"]))?;
    let damping = DampingRatio::from_quality_factor(input["q_factor"].as_f64().ok_or("q_factor")?)?;
    let quantity = Quantity::AbsoluteAcceleration;
    let mut pulses = Vec::new();
    for p in input["pulses"].as_array().into_iter().flatten() {
        if let [amplitude, duration, start] = numbers(p)[..] {
            pulses.push(Pulse { shape: Shape::HalfSine, amplitude, duration, start });
        }
    }
    let (exact, time) = smallest_time(|| Pulses::new(&pulses).map(|p| p.spectrum(&frequencies, damping, quantity)));
    let mut output = vec![json!({"what": "exact", "ms": time.as_secs_f64() * 1e3, "maximax": exact?.maximax})];
    for record in input["records"].as_array().into_iter().flatten() {
        let (samples, dt) = (numbers(&record["samples"]), record["dt"].as_f64().ok_or("dt")?);
        let (spectrum, time) = smallest_time(|| {
            let mut filter = SpectrumFilter::new(frequencies.clone(), damping, quantity, dt)?;
            filter.push(&samples);
            filter.finish()
        });
        output.push(json!({"what": "filter", "ms": time.as_secs_f64() * 1e3, "maximax": spectrum?.maximax}));
    }
    writeln!(std::io::stdout().lock(), "{}", Value::from(output))?;
    Ok(())
}
