//! Answers to one question of every kind, a line each. They are held to the last byte, on every machine; where one is to change,
//!
//! ```text
//! cargo test --release -p clatter-answer --test all -- --ignored answers::are_written_anew
//! ```

use std::error::Error;
use std::fmt::Write as _;

use clatter::{Axis, Bar, Plate, PlateStart, Quantity, Start};
use clatter_answer::fit::Data;
use clatter_answer::respond::{self, Excitation};
use clatter_answer::{assess, atlas, fit, impacts, map, record, scatter, simulate, spectrum, zone};
use clatter_assess::{
    Accuracy,
    design::Bounds,
    scatter::{Sampler, Settings},
};
use clatter_fit::{Known, Measured, MeasuredStrike};
use clatter_flight::{Block, BlockDrop, ContactLaw, PlateScene};
use clatter_product::{Body, Drop, Model, Place, ProductFile, Side};
use clatter_record::{Options, Record};
use clatter_shock::{
    DampingRatio, Frequencies, LimitCurve, Pulse, Pulses, Search, Shape, ShockTable, SpectrumFilter, Suspension,
    UnevenFilter, VelocityShock, VelocityShocks,
};

/// The answers.
pub(crate) fn answers() -> Result<String, Box<dyn Error>> {
    let mut lines = Vec::new();
    without_time(&mut lines)?;
    in_time(&mut lines)?;
    of_parts(&mut lines)?;
    responses(&mut lines)?;
    of_products(&mut lines)?;
    of_records(&mut lines)?;
    Ok(lines.join("\n") + "\n")
}

fn without_time(lines: &mut Vec<String>) -> Result<(), Box<dyn Error>> {
    let (uniform, loaded) = (Bar::new(0.5, 0.3)?, Bar::from_center_of_mass(0.2, 0.6, 0.95)?);
    for bar in [uniform, loaded] {
        let mut question = impacts::Question::new(bar, Start::default());
        question.at = vec![0.3];
        lines.push(serde_json::to_string(&impacts::answer(&question)?)?);
        lines.push(serde_json::to_string(&zone::answer(&zone::Question::new(bar, vec![0.5, 1.0, 2.0]))?)?);
    }
    let plate = Plate::off_center([0.55, 0.6], [0.1, -0.2], 0.4)?;
    let question = impacts::plate::Question::new(plate, PlateStart::level([2.0, 1.0])?);
    lines.push(serde_json::to_string(&impacts::plate::answer(&question)?)?);
    lines.push(serde_json::to_string(&zone::plate::answer(&zone::plate::Question::new(plate, vec![0.5, 1.0]))?)?);
    lines.push(serde_json::to_string(&atlas::answer(&atlas::Question::new(plate))?)?);
    for quantity in
        [Quantity::Impacts, Quantity::PeakEnd, Quantity::PeakAngular, Quantity::Duration, Quantity::Zone(0.5)]
    {
        let question = map::Question::new(quantity, Axis::q(-0.5, 1.0, 7)?, Axis::e(0.0, 1.0, 7)?);
        lines.push(serde_json::to_string(&map::answer(&question)?)?);
    }
    Ok(())
}

fn in_time(lines: &mut Vec<String>) -> Result<(), Box<dyn Error>> {
    let body = Body { thickness: Some(Side::even(0.012)), ..Body::off_center(0.08, 0.06, 0.041)? };
    let bar = Drop { contact_time_s: Some(4e-4), ..Drop::new(body, 4.43, 17_f64.to_radians(), 0.6) };
    let dashpot = Drop { contact_law: ContactLaw::Dashpot, ..bar };
    let mut told = |drop: Drop, model, at: &[[f64; 3]], limit| {
        let mut question = simulate::Question::new(drop, model);
        (question.at, question.impact_limit) = (at.to_vec(), limit);
        lines.push(serde_json::to_string(&simulate::answer(&question)?)?);
        Ok::<_, Box<dyn Error>>(())
    };
    for model in [Model::Map, Model::Ballistic, Model::FiniteTilt, Model::Compliant] {
        told(bar, model, &[[0.3, 0.0, 0.0]], Some(100))?;
    }
    told(dashpot, Model::Compliant, &[[0.3, 0.0, 0.0]], Some(100))?;
    let phone = Drop { restitution: 0.6, ..plate()? };
    told(phone, Model::Map, &[], None)?;
    told(phone, Model::Ballistic, &[], Some(100))?;
    told(phone, Model::Compliant, &[], None)?;
    told(Drop { contact_law: ContactLaw::Dashpot, restitution: 0.6, ..handheld()? }, Model::Compliant, &[], None)
}

/// A plate, and a box, that fall.
fn plate() -> Result<Drop, Box<dyn Error>> {
    let phone = clatter_flight::Plate::new([0.08, 0.07, 0.035, 0.035], [0.0433, 0.0202])?;
    let scene = PlateScene::new(phone, 4.43, [2e-3, 1e-3], 9.806_65)?;
    Ok(Drop { contact_time_s: Some(4e-4), ..Drop::of_plate(&scene, 0.4)? })
}

fn handheld() -> Result<Drop, Box<dyn Error>> {
    let handheld = Block::new([0.15, 0.07, 0.015], [0.002, 0.0, 0.001], [0.0207, 0.0435, 0.0478])?;
    let drop = BlockDrop::tilted(handheld, 0.7, 0.4, 4.43, 9.806_65)?;
    Ok(Drop { contact_time_s: Some(4e-4), ..Drop::of_block(&drop, 0.4) })
}

fn of_parts(lines: &mut Vec<String>) -> Result<(), Box<dyn Error>> {
    let file = ProductFile::read(include_str!("../../../tests/cases/bar-handheld.toml"), "bar.toml")?;
    let assessment = clatter_assess::assess(&file)?;
    lines.push(serde_json::to_string(&assessment)?);
    lines.push(format!("{:?}", clatter_assess::remedies(&file, &assessment, &Bounds::default(), 0.1)?));
    let sampler = Sampler::new(&file, Settings { samples: 2000, seed: 1, confidence: 0.95, merge_s: 1e-3 })?;
    lines.push(format!("{:?}", sampler.run(false, &|| true, |_| Ok::<_, std::fmt::Error>(()))?));
    let (half_sine, damping) =
        (Pulse { shape: Shape::HalfSine, amplitude: 1000.0, duration: 5e-4, start: 0.0 }, DampingRatio::new(0.05)?);
    let frequencies = Frequencies::per_octave(20.0, 5000.0, 2.0)?;
    let spectrum =
        Pulses::new(&[half_sine])?.spectrum(&frequencies, damping, clatter_shock::Quantity::AbsoluteAcceleration);
    lines.push(format!("{:?}", spectrum.maximax));
    let times: Vec<f64> = (0..200).map(|i| 1e-4 * f64::from(i)).collect();
    let values: Vec<f64> = (0..200).map(|i| f64::from((i * 37) % 101) - 50.0).collect();
    let mut filter =
        SpectrumFilter::new(frequencies.clone(), damping, clatter_shock::Quantity::RelativeDisplacement, 1e-4)?;
    (0..40).for_each(|_| filter.push(&values));
    lines.push(format!("{:?}", filter.finish()?.maximax));
    let mut filter = UnevenFilter::new(frequencies, damping, clatter_shock::Quantity::AbsoluteAcceleration);
    filter.push(&times, &values)?;
    lines.push(format!("{:?}", filter.finish()?.maximax));
    Ok(())
}

fn responses(lines: &mut Vec<String>) -> Result<(), Box<dyn Error>> {
    let damping = DampingRatio::new(0.05)?;
    let (board, soft) = (Suspension::new(1131.0, damping)?, Suspension::new(3.0, damping)?);
    let table = ShockTable { shortest: 2e-4, longest: 0.02, acceleration: 5e4, velocity_change: 20.0 };
    let shocks = [(0.0, 2.5), (4e-3, -1.0)].map(|(time, delta_v)| VelocityShock { time, delta_v });
    let pulses = [(Shape::HalfSine, 5000.0, 5e-4, 0.0), (Shape::Haversine, -2000.0, 1e-3, 4e-3)];
    let pulses = pulses.map(|(shape, amplitude, duration, start)| Pulse { shape, amplitude, duration, start });
    let (bar, start) = (Bar::new(0.73, 0.2)?, Start::default());
    lines.push(serde_json::to_string(&respond::rule::answer(&bar, &start, 1.0, &soft)?)?);
    for (excitation, part) in [
        (Excitation::Bar { bar, start, at: 1.0 }, soft),
        (Excitation::Shocks(VelocityShocks::new(shocks.to_vec())?), board),
        (Excitation::Pulses(pulses.to_vec()), board),
    ] {
        let mut question = respond::Question::new(excitation, part);
        question.shock_table = Some(table);
        lines.push(serde_json::to_string(&respond::answer(&question)?)?);
    }
    let bar = Drop::new(Body::off_center(0.08, 0.06, 0.041)?, 4.43, 4_f64.to_radians(), 0.4);
    let bar = Drop { contact_time_s: Some(4e-4), ..bar };
    for (drop, model, place, suspension) in [
        (bar, Model::Map, [0.042, 0.0, 0.0], None),
        (bar, Model::FiniteTilt, [0.042, 0.0, 0.0], Some(board)),
        (bar, Model::Compliant, [0.042, 0.0, 0.0], Some(board)),
        (plate()?, Model::Compliant, [0.0225, 0.007, 0.0], Some(board)),
        (handheld()?, Model::Compliant, [0.01, 0.02, 0.0], Some(board)),
    ] {
        let mut question = respond::drop::Question::new(drop, model, Place::new(place));
        question.suspension = suspension;
        lines.push(serde_json::to_string(&respond::drop::answer(&question)?)?);
    }
    Ok(())
}

/// Strikes of the paper's reference bar with e = 0.3 and a gap of 2 ms times the speed, by Eqs. 1 to 3.
const STRIKES_S: [f64; 4] = [0.25, 0.251_212_121_21, 0.251_682_847_9, 0.284_385_965_91];
/// That bar.
const BAR: &str = r#"[product]
name = "Bar"
length = "200 mm"
radius_of_gyration = "57.735 mm"
restitution = [0.1, 0.9]
[drop]
speed = "0.1 m/s"
tilt = ["0 deg", "1 deg"]
gravity = "0 gn"
[[component]]
name = "part"
position = "0 mm"
mount = "hard"
velocity_change_limit = "1 m/s"
"#;

fn of_products(lines: &mut Vec<String>) -> Result<(), Box<dyn Error>> {
    let file = ProductFile::read(BAR, "bar.toml")?;
    let strikes = STRIKES_S.map(|time_s| MeasuredStrike { time_s, end: None }).to_vec();
    let strikes = Data::Measured(Measured::Strikes { strikes, deviation_s: Some(1e-6) });
    for data in [strikes, Data::Bounces(vec![0.0, 0.4, 0.6, 0.7, 0.75])] {
        let record = fit::Record { name: "drop.csv".to_owned(), data };
        let mut question = fit::Question::new(&file, vec![record.clone()]);
        question.gyration_known = true;
        lines.push(serde_json::to_string(&fit::answer(&question)?)?);
        let mut answer = assess::answer(&file, &Accuracy::default())?;
        let drop = fit::DropRecords { name: "a drop".to_owned(), records: vec![record], timing_s: None };
        answer.measured.push(drop.fitted(&Known::from(&file))?);
        lines.push(serde_json::to_string(&answer)?);
    }
    let settings = Settings { samples: 500, seed: 7, confidence: 0.9, merge_s: 1e-3 };
    lines.push(serde_json::to_string(&scatter::answer(&file, settings)?)?);
    Ok(())
}

fn of_records(lines: &mut Vec<String>) -> Result<(), Box<dyn Error>> {
    let mut text = "time [ms],ax [g],az [g]\n".to_owned();
    for i in 0..1500 {
        let time_ms = 0.02 * f64::from(i);
        let half_sine = |peak: f64, from_ms: f64, length_ms: f64| {
            let at = (time_ms - from_ms) / length_ms;
            if (0.0..=1.0).contains(&at) { peak * libm::sin(std::f64::consts::PI * at) } else { 0.0 }
        };
        let [x, z] = [half_sine(50.0, 5.0, 2.0) - half_sine(20.0, 20.0, 1.0), half_sine(80.0, 5.2, 1.5)];
        writeln!(text, "{time_ms:.3},{x:.6},{:.6}", z + 0.05 * libm::sin(5.0 * time_ms))?;
    }
    let record = Record::read(text.as_bytes(), &Options::default(), |_| ())?;
    let mut question = record::Question::new(&record);
    question.find = Some(Search { threshold_m_s2: None, quiet_s: 5e-3 });
    (question.fit_pulse, question.integrate) = (true, true);
    lines.push(serde_json::to_string(&record::answer(&question)?)?);
    let measured = spectrum::Measured { file: "drop.csv".to_owned(), name: None, record, shock: None };
    let mut question = spectrum::Question::new(spectrum::Excitation::Records(vec![measured]), DampingRatio::new(0.05)?);
    question.frequencies = Some(Frequencies::per_octave(50.0, 1000.0, 1.0)?);
    question.limit = Some(LimitCurve::constant(900.0)?);
    question.enveloping = Some(Shape::Haversine);
    (question.resultant, question.envelope, question.mean_3db) = (true, true, true);
    lines.push(serde_json::to_string(&spectrum::answer(&question)?)?);
    Ok(())
}

/// Each as it is now.
#[test]
#[ignore = "it writes what the others are held to"]
fn are_written_anew() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/answers.jsonl");
    std::fs::write(path, answers().expect("answers")).expect("written");
}
