//! Scatter against known probabilities, the exact models, and itself on other threads.

#![cfg(test)]

use clatter_scene::scatter::{Column, Input, Progress, Sampler, Scatter, Settings};
use clatter_scene::{BarModel, Base, ProductFile, SingleDrop};
use clatter_shock::{Pulse, Pulses, Shape, VelocityShock};

fn product(drop: &str, parts: &str) -> ProductFile {
    with_contact("", drop, parts)
}

fn with_contact(contact: &str, drop: &str, parts: &str) -> ProductFile {
    let text = format!(
        "[product]\nname = \"test\"\nlength = \"140 mm\"\nradius_of_gyration = \"38 mm\"\nrestitution = 0.3\n{contact}\n\
         [drop]\n{drop}\n[[component]]\nname = \"part\"\n{parts}\n"
    );
    ProductFile::read(&text, "test.toml").unwrap_or_else(|faults| panic!("{faults}"))
}

fn settings(samples: u64, seed: u64) -> Settings {
    Settings { samples, seed, confidence: 0.95 }
}

fn draw(file: &ProductFile, settings: Settings) -> Scatter {
    Sampler::new(file, settings).unwrap().run::<()>(false, |_| Ok(())).unwrap()
}

/// A hard part at end b of a product that always lands on end a survives while v0 times the largest shock there stays
/// below its limit: of heights spread evenly over 0.5 to 1.5 m exactly those up to h = (limit/peak)²/(2g).
fn known() -> (ProductFile, f64) {
    let drop = "height = { uniform = [\"0.5 m\", \"1.5 m\"] }\ntilt = [\"1 deg\", \"5 deg\"]\nfirst = \"a\"";
    let file = product(drop, "position = \"70 mm\"\nmount = \"hard\"\nvelocity_change_limit = \"9 m/s\"");
    let q = file.product.inertia_ratio();
    let bar = clatter::Bar::new(q, 0.3).unwrap();
    let largest = bar.train(&clatter::Start::default()).map(|impact| impact.delta_v_at(1.0).abs()).fold(0.0, f64::max);
    let height = (9.0 / largest).powi(2) / (2.0 * file.drop.gravity_m_s2);
    (file, height - 0.5)
}

#[test]
fn a_known_probability_lies_in_its_interval_as_often_as_promised() {
    let (file, truth) = known();
    assert!((0.2..0.8).contains(&truth), "{truth}");
    let seeds = 200;
    let within = (0..seeds)
        .filter(|seed| {
            let survival = draw(&file, settings(1000, *seed)).components[0].survival;
            survival.lo <= truth && truth <= survival.hi
        })
        .count();
    // 95 % of 200 is 190; four standard deviations of the binomial are 12. The interval is exact, so it may hold more
    // often.
    assert!(within >= 178, "{within} of {seeds}");
    let survival = draw(&file, settings(200_000, 1)).components[0].survival;
    assert!(
        (survival.estimate - truth).abs() < 4.0 * (truth * (1.0 - truth) / 2e5).sqrt(),
        "{survival:?}, not {truth}"
    );
}

#[test]
fn without_a_failure_the_bound_is_one_sided() {
    let drop = "height = \"1 m\"\ntilt = [\"1 deg\", \"5 deg\"]\nfirst = \"a\"";
    let file = product(drop, "position = \"0 mm\"\nmount = \"hard\"\nvelocity_change_limit = \"100 m/s\"");
    let part = &draw(&file, settings(3000, 1)).components[0];
    assert_eq!((part.failures, part.survival.estimate, part.survival.hi), (0, 1.0, 1.0));
    assert!((part.survival.at_least - 0.05f64.powf(1.0 / 3000.0)).abs() < 1e-15);
    assert!(part.drivers.is_empty(), "nothing varies: no tilt reaches a velocity shock");
}

#[test]
fn what_drives_a_part_is_found() {
    let (file, _) = known();
    let part = &draw(&file, settings(20_000, 1)).components[0];
    let driver = &part.drivers[0];
    assert_eq!(driver.input, Input::Height);
    // v = √(2gh) is all but linear in h; bins of 1/32 lose 0.1 %
    assert!(driver.share.variance > 0.995 && driver.share.trend > 0.99, "{driver:?}");
    assert!(part.drivers[1..].iter().all(|other| other.share.variance < 0.01), "{:?}", part.drivers);
}

const SPREAD: &str = "height = { normal = [\"1 m\", \"0.3 m\"], range = [\"0.4 m\", \"1.6 m\"] }\n\
    tilt = { triangular = [\"0 deg\", \"2 deg\", \"8 deg\"] }\nfirst = \"either\"";
const SOFT: &str = "position = \"40 mm\"\nextent = \"20 mm\"\nnatural_frequency = { uniform = [\"80 Hz\", \"120 Hz\"] }\n\
    damping_ratio = 0.05\nacceleration_limit = \"400 gn\"\nrattle_space = \"9 mm\"";

#[test]
fn answers_are_the_same_on_any_number_of_threads() {
    let file = product(SPREAD, SOFT);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| draw(&file, settings(30_000, 5)))
    };
    let one = on(1);
    for threads in [2, 3, 7] {
        assert_eq!(on(threads), one, "{threads} threads");
    }
}

fn values(file: &ProductFile, settings: Settings) -> (Vec<Column>, Vec<f64>) {
    let sampler = Sampler::new(file, settings).unwrap();
    let mut all = Vec::new();
    let keep = |progress: &Progress<'_>| {
        all.extend_from_slice(progress.values);
        Ok::<(), ()>(())
    };
    sampler.run(true, keep).unwrap();
    (sampler.columns(), all)
}

#[test]
fn a_sample_is_the_same_whatever_the_number_of_samples() {
    let file = product(SPREAD, SOFT);
    let (columns, many) = values(&file, settings(9000, 5));
    let (_, few) = values(&file, settings(10, 5));
    assert_eq!(few, many[..10 * columns.len()]);
    let (_, other) = values(&file, settings(10, 6));
    assert_ne!(few, other, "another seed");
}

/// Every sample again by the map and the exact response, to half-sines where the contact time is known.
fn samples_agree(parts: &str, contact: &str) {
    let file = with_contact(contact, SPREAD, parts);
    let (columns, all) = values(&file, settings(300, 9));
    assert_eq!(columns.len(), 4 + usize::from(parts.contains("frequency")) + 1);
    let component = &file.components[0];
    let contact = file.product.contact_time_s;
    for row in all.chunks(columns.len()) {
        let drop = SingleDrop {
            first: if row[0] < 0.5 { clatter::End::A } else { clatter::End::B },
            speed_m_s: row[1],
            tilt_rad: row[2].to_radians(),
            restitution: row[3],
            gravity_m_s2: 0.0,
        };
        let base = Base::new(&file.product, &drop, BarModel::Map).unwrap();
        let used = component.ends_m().into_iter().map(|x| {
            let limits = &component.limits;
            let shocks = base.shocks_at(x).unwrap();
            let amplitude = |delta_v: f64, duration: f64| delta_v / (Shape::HalfSine.area() * duration);
            let Some(suspension) = component.mount.suspension(row[4]).unwrap() else {
                let acceleration = contact.map_or(0.0, |time| amplitude(shocks.largest(), time).abs());
                return acceleration / limits.acceleration_m_s2.unwrap_or(f64::INFINITY);
            };
            let response = contact.map_or_else(
                || shocks.respond(&suspension),
                |duration| {
                    let pulse = |s: &VelocityShock| Pulse {
                        shape: Shape::HalfSine,
                        amplitude: amplitude(s.delta_v, duration),
                        duration,
                        start: s.time,
                    };
                    let pulses: Vec<_> = shocks.as_slice().iter().map(pulse).collect();
                    Pulses::new(&pulses).unwrap().respond(&suspension)
                },
            );
            let [a, z] = [&response.absolute_acceleration, &response.relative_displacement]
                .map(clatter_shock::Extremes::magnitude);
            (a / limits.acceleration_m_s2.unwrap()).max(z / limits.rattle_space_m.unwrap())
        });
        let (known, found) = (used.fold(0.0, f64::max), row[columns.len() - 1]);
        // 1e-9 of the peak at the ends, of which the part gets at least a tenth here
        assert!((found - known).abs() < 1e-8 * known, "{found}, not {known}: {drop:?}");
    }
}

#[test]
fn samples_are_those_of_the_exact_models() {
    samples_agree(SOFT, "");
    samples_agree(SOFT, "contact_time = \"0.9 ms\"");
    samples_agree(&SOFT.replace("damping_ratio = 0.05", "damping_ratio = 1.5"), "");
    samples_agree(
        "position = \"40 mm\"\nmount = \"hard\"\nacceleration_limit = \"2000 gn\"\n",
        "contact_time = \"0.4 ms\"",
    );
}
