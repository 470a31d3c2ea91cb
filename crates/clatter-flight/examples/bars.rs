//! Our side of `peers/run.py`: the four bars of Table 1 and a map of a million points. Scenes as JSON from standard
//! input, impacts, largest shock at an end and time, by three models, as JSON to standard output.
//!
//! Each time is the best of at least five batches and 0.3 s on one thread, from the numbers of the scene to the answer.

use clatter::{Axis, Bar, Count, Map, Quantity, Start};
use clatter_flight::{Body, Model, Scene};
use serde_json::{Value, json};
use std::error::Error;
use std::hint::black_box;
use std::io::Write as _;
use std::time::{Duration, Instant};

/// The answer and the least time of one run in ms.
fn best<T>(batch: u32, mut run: impl FnMut() -> T) -> (T, f64) {
    let (begin, mut least, mut batches, mut answer) = (Instant::now(), Duration::MAX, 0, run());
    while batches < 5 || begin.elapsed().as_secs_f64() < 0.3 {
        let start = Instant::now();
        for _ in 0..batch {
            answer = black_box(run());
        }
        least = least.min(start.elapsed());
        batches += 1;
    }
    (answer, 1e3 * least.as_secs_f64() / f64::from(batch))
}

/// The impacts and the largest velocity shock at an end, and what they cost.
fn row(answer: Result<(u64, f64), clatter::Error>, ms: f64) -> Result<Value, clatter::Error> {
    answer.map(|(impacts, largest)| json!({ "impacts": impacts, "largest_m_s": largest, "ms": ms }))
}

fn main() -> Result<(), Box<dyn Error>> {
    let input: Value = serde_json::from_reader(std::io::stdin())?;
    let number = |v: &Value, key: &str| v[key].as_f64().ok_or_else(|| format!("no number \"{key}\" in the scene"));
    let of_scene = |key| number(&input, key);
    let (half, tilt) = (of_scene("half_length_m")?, of_scene("tilt_deg")?);
    let (speed, gap) = (of_scene("speed_m_s")?, of_scene("height_gap_m")?);
    let [mut closed, mut train, mut finite] = [const { Vec::new() }; 3];
    for bar in input["bars"].as_array().ok_or("no list \"bars\" in the scene")? {
        let (q, e, gyration) = (number(bar, "q")?, number(bar, "e")?, number(bar, "gyration_m")?);
        let (answer, ms) = best(1000, || {
            let [q, e, speed, gap] = black_box([q, e, speed, gap]);
            let summary = Bar::new(q, e)?.summary(&Start::new([-speed; 2], gap)?);
            // Endless trains have no count: 0, which is none of the four bars' own.
            Ok((if let Count::Finite(n) = summary.count { n } else { 0 }, summary.peak.end))
        });
        closed.push(row(answer, ms)?);
        let mut list = Vec::new();
        let (answer, ms) = best(1000, || {
            let [q, e, speed, gap] = black_box([q, e, speed, gap]);
            list.clear();
            Bar::new(q, e)?.train(&Start::new([-speed; 2], gap)?).for_each(|impact| list.push(impact));
            let largest = list.iter().flat_map(|i| i.delta_v).fold(0.0_f64, |m, v| m.max(v.abs()));
            Ok((list.len() as u64, largest))
        });
        train.push(row(answer, ms)?);
        let (answer, ms) = best(100, || {
            let [half, gyration, e, speed, tilt] = black_box([half, gyration, e, speed, tilt]);
            let flight = Scene::new(Body::new(2.0 * half, gyration)?, e, speed, tilt, 0.0)?.simulate(Model::FiniteTilt);
            let shocks = flight.strikes.iter().flat_map(|s| s.delta_v_m_s);
            Ok((flight.strikes.len() as u64, shocks.fold(0.0_f64, |m, v| m.max(v.abs()))))
        });
        finite.push(row(answer, ms)?);
    }
    let axis = |of: fn(f64, f64, usize) -> Result<Axis, clatter::Error>| of(0.0, 1.0, 1000);
    let (q, e) = (axis(Axis::q)?, axis(Axis::e)?);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let (map, ms) = one.install(|| best(1, || Map::compute(Quantity::PeakEnd, q, e)));
    map?;
    let output = json!({ "closed": closed, "train": train, "finite": finite, "map_ms": ms });
    writeln!(std::io::stdout().lock(), "{output}")?;
    Ok(())
}
