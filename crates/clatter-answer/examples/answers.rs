//! Answers to one question of every kind, a line each. The tests hold them to the last byte, on every machine:
//!
//! ```text
//! cargo run --release -p clatter-answer --example answers > crates/clatter-answer/tests/data/answers.jsonl
//! ```

use std::error::Error;
use std::io::Write;

use clatter::{Axis, Bar, Plate, PlateStart, Quantity, Start};
use clatter_answer::{atlas, impacts, map, simulate, zone};
use clatter_assess::design::Bounds;
use clatter_assess::scatter::{Sampler, Settings};
use clatter_flight::{Block, BlockDrop, Body, Contact, ContactLaw, Model, PlateScene, Scene};
use clatter_shock::{DampingRatio, Frequencies, Pulse, Pulses, Shape, SpectrumFilter, UnevenFilter};

/// The answers.
pub(crate) fn answers() -> Result<String, Box<dyn Error>> {
    let mut lines = Vec::new();
    without_time(&mut lines)?;
    in_time(&mut lines)?;
    of_parts(&mut lines)?;
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
    let body = Body::off_center(0.08, 0.06, 0.041)?.with_thickness(0.012)?;
    let scene = Scene::new(body, 0.6, 4.43, 17.0, 9.806_65)?.with_impact_limit(100)?;
    let contact = |law| Contact::new(law, 0.6, 4e-4);
    let [hysteretic, dashpot] = [contact(ContactLaw::Hysteretic)?, contact(ContactLaw::Dashpot)?];
    for model in
        [Model::Map, Model::Ballistic, Model::FiniteTilt, Model::Contacts(hysteretic), Model::Contacts(dashpot)]
    {
        let mut question = simulate::Question::new(scene, model);
        question.at = vec![0.3];
        lines.push(serde_json::to_string(&simulate::answer(&question)?)?);
    }
    let phone = clatter_flight::Plate::new([0.08, 0.07, 0.035, 0.035], [0.0433, 0.0202])?;
    let scene = PlateScene::new(phone, 4.43, [2e-3, 1e-3], 9.806_65)?;
    for model in [simulate::plate::Model::Map { e: 0.6 }, simulate::plate::Model::Contacts(hysteretic)] {
        lines.push(serde_json::to_string(&simulate::plate::answer(&simulate::plate::Question::new(scene, model))?)?);
    }
    let handheld = Block::new([0.15, 0.07, 0.015], [0.002, 0.0, 0.001], [0.0207, 0.0435, 0.0478])?;
    let drop = BlockDrop::tilted(handheld, 0.7, 0.4, 4.43, 9.806_65)?;
    lines.push(serde_json::to_string(&simulate::block::answer(&simulate::block::Question::new(drop, dashpot))?)?);
    Ok(())
}

fn of_parts(lines: &mut Vec<String>) -> Result<(), Box<dyn Error>> {
    let file = clatter_assess::ProductFile::read(clatter_assess::EXAMPLE, "example.toml")?;
    let assessment = file.assess()?;
    lines.push(serde_json::to_string(&assessment)?);
    lines.push(format!("{:?}", file.remedies(&assessment, &Bounds::default(), 0.1)?));
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

#[allow(dead_code, reason = "the tests take the answers alone")]
fn main() -> Result<(), Box<dyn Error>> {
    Ok(std::io::stdout().write_all(answers()?.as_bytes())?)
}
