//! Scatter against known probabilities, drops that are answered one by one, and itself on other threads.

use crate::random::Random;
use clatter_assess::{
    Answer, Part, answer,
    scatter::{Column, Probability, Progress, Sampler, Scatter, Settings, Varied, clopper_pearson, extremes},
};
use clatter_product::{Drop, Input, Limit, LimitKind, Model, Mount, ProductFile, STANDARD_GRAVITY_M_S2};

fn product(product: &str, drop: &str, parts: &str) -> ProductFile {
    let text = format!(
        "[product]\nname = \"test\"\nlength = \"140 mm\"\n{product}\n[drop]\n{drop}\n[[component]]\nname = \"part\"\n{parts}\n"
    );
    ProductFile::read(&text, "test.toml").unwrap_or_else(|faults| panic!("{faults}"))
}

fn settings(samples: u64, seed: u64) -> Settings {
    // Tilts here may be tiny: no two strikes are one.
    Settings { samples, seed, confidence: 0.95, merge_s: 1e-12 }
}

fn draw(file: &ProductFile, settings: Settings) -> Scatter {
    Sampler::new(file, settings).unwrap().run::<()>(false, &|| true, |_| Ok(())).unwrap()
}

fn values(file: &ProductFile, settings: Settings) -> (Vec<Column>, Vec<f64>) {
    let sampler = Sampler::new(file, settings).unwrap();
    let mut all = Vec::new();
    let keep = |progress: &Progress<'_>| {
        all.extend_from_slice(progress.values);
        Ok::<_, ()>(())
    };
    sampler.run(true, &|| true, keep).unwrap();
    (sampler.columns(), all)
}

/// Without gravity, so that the closed forms of a bar in free fall are the truth.
const FREE: &str = "gravity = \"0 gn\"\nfirst = \"a\"";
/// Its strikes leave the other end alone: q = 0.
const DUMBBELL: &str = "radius_of_gyration = \"70 mm\"\nrestitution = 0.25";

/// A part at end b of a product that always lands on end a survives while v0 times the largest shock there stays below its limit: of
/// speeds spread evenly over 3 to 5 m/s exactly those up to limit/peak.
fn known() -> (ProductFile, f64) {
    let drop = format!("speed = {{ uniform = [\"3 m/s\", \"5 m/s\"] }}\ntilt = [\"0.01 deg\", \"0.05 deg\"]\n{FREE}");
    let body = "radius_of_gyration = \"38 mm\"\nrestitution = 0.3";
    let file = product(body, &drop, "position = \"70 mm\"\nmount = \"hard\"\nvelocity_change_limit = \"8.5 m/s\"");
    let bar = clatter::Bar::new(file.product.inertia_ratio(), 0.3).unwrap();
    let largest = bar.train(&clatter::Start::default()).map(|impact| impact.delta_v_at(1.0).abs()).fold(0.0, f64::max);
    (file, (8.5 / largest - 3.0) / 2.0)
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
        (survival.estimate.unwrap() - truth).abs() < 4.0 * (truth * (1.0 - truth) / 2e5).sqrt(),
        "{survival:?}, not {truth}"
    );
}

#[test]
fn without_a_failure_the_bound_is_one_sided() {
    let drop = format!("speed = \"4 m/s\"\ntilt = [\"1 deg\", \"5 deg\"]\n{FREE}");
    let file = product(DUMBBELL, &drop, "position = \"0 mm\"\nmount = \"hard\"\nvelocity_change_limit = \"100 m/s\"");
    let part = &draw(&file, settings(3000, 1)).components[0];
    assert_eq!((part.failures, part.survival.estimate, part.survival.hi), (0, Some(1.0), 1.0));
    assert!((part.survival.at_least - 0.05f64.powf(1.0 / 3000.0)).abs() < 1e-15);
}

#[test]
fn what_drives_a_part_is_found() {
    let (file, _) = known();
    let part = &draw(&file, settings(7000, 1)).components[0];
    let driver = &part.drivers[0];
    assert_eq!(driver.input, Varied::Drop(Input::Speed, None));
    // bins of 1/32 lose 0.1 %
    assert!(driver.share.variance > 0.995 && driver.share.trend > 0.99, "{driver:?}");
    assert!(part.drivers[1..].iter().all(|other| other.share.variance < 0.01), "{:?}", part.drivers);
}

/// Half of the samples survive where the median of the one input that varies just does.
fn half_survives(body: &str, drop: &str, part: &str, by: Varied) {
    let file = product(body, drop, part);
    let scatter = draw(&file, settings(4000, 3));
    let found = &scatter.components[0];
    // four standard deviations
    assert!(
        (found.survival.estimate.unwrap() - 0.5).abs() < 4.0 * (0.25 / 4000.0_f64).sqrt(),
        "{part}: {:?}",
        found.survival
    );
    assert_eq!((found.drivers[0].input, found.unanswered), (by, 0), "{part}");
}

/// With q = 0 each end is struck once, with (1 + e) v0 = 5 m/s, and place s feels (1 ± s)/2 of that.
#[test]
fn what_a_part_stands_where_it_is_and_how_it_is_damped_may_vary() {
    let drop = format!("speed = \"4 m/s\"\ntilt = \"0.05 deg\"\n{FREE}");
    let half = |part: &str, by| half_survives(DUMBBELL, &drop, part, by);
    let limit = |kind| Varied::Limit(0, kind);
    let hard = "position = \"-70 mm\"\nmount = \"hard\"\n";
    let even = "{ uniform = [\"2.5 m/s\", \"7.5 m/s\"] }";
    half(&format!("{hard}velocity_change_limit = {even}"), limit(LimitKind::VelocityChange));
    // Δv/(2L) each
    let turn = 5.0 / 0.14;
    let range = format!("{{ uniform = [\"{} rad/s\", \"{} rad/s\"] }}", 0.5 * turn, 1.5 * turn);
    half(&format!("{hard}angular_velocity_change_limit = {range}"), limit(LimitKind::AngularVelocityChange));
    let boundary = format!("damage_boundary = {{ velocity_change = {even}, acceleration = \"1 gn\" }}");
    half(&format!("{hard}{boundary}"), limit(LimitKind::DamageBoundary));
    // (1 + |s|)/2 of 5 m/s stays below 3.75 m/s for |s| < 1/2.
    let anywhere =
        "position = { uniform = [\"-70 mm\", \"70 mm\"] }\nmount = \"hard\"\nvelocity_change_limit = \"3.75 m/s\"";
    half(anywhere, Varied::Position(0));
    // One velocity shock at end a: ωz = Δv e^(−ζ acos(ζ)/√(1−ζ²)), below the limit where ζ is above its median, 0.2.
    let omega = std::f64::consts::TAU * 100.0;
    let peak = |zeta: f64| 5.0 / omega * (-zeta / (1.0 - zeta * zeta).sqrt() * zeta.acos()).exp();
    let soft = "position = \"-70 mm\"\nnatural_frequency = \"100 Hz\"\n";
    let space = format!("rattle_space = \"{} m\"", peak(0.2));
    half(&format!("{soft}damping_ratio = {{ uniform = [0.1, 0.3] }}\n{space}"), Varied::Damping(0));
    // In between quality factors of 2 and 4, 3 is the median.
    let space = format!("rattle_space = \"{} m\"", peak(1.0 / 6.0));
    half(&format!("{soft}quality_factor = {{ uniform = [2, 4] }}\n{space}"), Varied::Damping(0));
    let range = format!("{{ uniform = [\"{} m\", \"{} m\"] }}", 0.5 * peak(0.2), 1.5 * peak(0.2));
    half(&format!("{soft}damping_ratio = 0.2\nrattle_space = {range}"), limit(LimitKind::RattleSpace));
}

/// A contact of its own asks π (1 + e) v0/(2τ) of a part mounted rigidly at that end.
#[test]
fn the_contact_time_may_vary() {
    let drop = format!("speed = \"4 m/s\"\ntilt = \"10 deg\"\n{FREE}");
    let file = |contact: &str, part: &str| {
        let body = format!("{DUMBBELL}\ncontact_time = {contact}");
        (body, format!("position = \"-70 mm\"\nmount = \"hard\"\n{part}"))
    };
    let at = |tau: f64| std::f64::consts::FRAC_PI_2 * 5.0 / tau;
    let contact = "{ uniform = [\"0.2 ms\", \"0.4 ms\"] }";
    let (body, part) = file(contact, &format!("acceleration_limit = \"{} m/s2\"", at(0.3e-3)));
    half_survives(&body, &drop, &part, Varied::Drop(Input::ContactTime, None));
    let range =
        format!("acceleration_limit = {{ uniform = [\"{} m/s2\", \"{} m/s2\"] }}", 0.5 * at(0.3e-3), 1.5 * at(0.3e-3));
    let (body, part) = file("\"0.3 ms\"", &range);
    half_survives(&body, &drop, &part, Varied::Limit(0, LimitKind::Acceleration));
    let critical = format!("{{ uniform = [\"{} m/s2\", \"{} m/s2\"] }}", 0.5 * at(0.3e-3), 1.5 * at(0.3e-3));
    let (body, part) = file(
        "\"0.3 ms\"",
        &format!("damage_boundary = {{ velocity_change = \"0.1 m/s\", acceleration = {critical} }}"),
    );
    half_survives(&body, &drop, &part, Varied::CriticalAcceleration(0));
}

/// Without gravity the second strike asks most of the middle, (1 − q)/2 (1 + e)(1 + q (1 + e)) v0: the more, the larger the radius
/// of gyration is.
#[test]
fn the_radius_of_gyration_may_vary() {
    let at = |rho: f64| {
        let q = (70.0 * 70.0 - rho * rho) / (70.0 * 70.0 + rho * rho);
        0.5 * (1.0 - q) * 1.25 * (1.0 + q * 1.25) * 4.0
    };
    let body = "radius_of_gyration = { uniform = [\"25 mm\", \"50 mm\"] }\nrestitution = 0.25";
    let drop = format!("speed = \"4 m/s\"\ntilt = \"0.05 deg\"\n{FREE}");
    let part = format!("position = \"0 mm\"\nmount = \"hard\"\nvelocity_change_limit = \"{} m/s\"", at(37.5));
    half_survives(body, &drop, &part, Varied::Drop(Input::Gyration, None));
}

const SPREAD: &str = "height = { normal = [\"1 m\", \"0.2 m\"], range = [\"0.5 m\", \"1.5 m\"] }\n\
    tilt = { triangular = [\"1 deg\", \"2 deg\", \"4 deg\"] }\nfirst = \"either\"";
const BODY: &str = "radius_of_gyration = \"38 mm\"\nrestitution = 0.3";
const SOFT: &str = "position = \"40 mm\"\nnatural_frequency = { uniform = [\"80 Hz\", \"120 Hz\"] }\n\
    damping_ratio = 0.05\nacceleration_limit = \"400 gn\"\nrattle_space = \"9 mm\"";

/// A part whose contacts overlap.
fn overlapping() -> ProductFile {
    let drop = "height = \"1 m\"\ntilt = { uniform = [\"0 deg\", \"0.5 deg\"] }\nfirst = \"either\"";
    let part =
        "position = \"60 mm\"\nnatural_frequency = \"200 Hz\"\ndamping_ratio = 0.05\nacceleration_limit = \"700 gn\"";
    product(&format!("{BODY}\ncontact_time = \"0.4 ms\""), drop, part)
}

#[test]
fn answers_are_the_same_on_any_number_of_threads() {
    for (file, samples) in [(product(BODY, SPREAD, SOFT), 30_000), (overlapping(), 5000)] {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| draw(&file, settings(samples, 5)))
        };
        let one = on(1);
        for threads in [2, 7] {
            assert_eq!(on(threads), one, "{threads} threads");
        }
    }
}

#[test]
fn a_sample_is_the_same_whatever_the_number_of_samples() {
    let file = overlapping();
    let (columns, many) = values(&file, settings(2000, 5));
    let (_, few) = values(&file, settings(10, 5));
    assert_eq!(few, many[..10 * columns.len()]);
    let (_, other) = values(&file, settings(10, 6));
    assert_ne!(few, other, "another seed");
}

/// The drop and the part of a row, and what it asks of each limit.
fn answers(file: &ProductFile, columns: &[Column], row: &[f64]) -> Vec<(LimitKind, f64)> {
    let value = |column: Column| columns.iter().position(|other| *other == column).map(|i| row[i]);
    let drop = Drop {
        direction_rad: Drop::towards(if row[0] < 0.5 { clatter::End::A } else { clatter::End::B }),
        gravity_m_s2: STANDARD_GRAVITY_M_S2,
        contact_time_s: value(Column::Drop(Input::ContactTime, None)),
        ..Drop::new(
            file.product.body,
            value(Column::Drop(Input::Speed, None)).unwrap(),
            value(Column::Drop(Input::Tilt, None)).unwrap(),
            value(Column::Drop(Input::Restitution, None)).unwrap(),
        )
    };
    let component = &file.components[0];
    let ratio = match &component.mount {
        Mount::Hard => 0.0,
        Mount::Suspended { damping, .. } => value(Column::DampingRatio(0)).unwrap_or_else(|| damping.ratios()[0]),
    };
    let suspension = component.mount.suspension(value(Column::FrequencyHz(0)).unwrap_or(1.0), ratio).unwrap();
    let middle = value(Column::PositionM(0)).unwrap_or_else(|| component.position_m.lo());
    let one = |limit: &Limit| {
        let mut limit = *limit;
        limit.allowed = value(Column::Limit(0, limit.kind)).unwrap_or(limit.allowed);
        let critical = &mut limit.critical_acceleration_m_s2;
        *critical = value(Column::CriticalAccelerationMS2(0)).unwrap_or(*critical);
        let half = 0.5 * component.extent_m;
        let places = [middle - half, middle + half].map(|position_m| Part::new(position_m, suspension));
        let most = places.map(|part| answer(&drop, &part, &limit, Model::fullest(&drop), 0.01).unwrap().utilization());
        (limit.kind, most[0].max(most[1]))
    };
    Limit::of(component).iter().map(one).collect()
}

/// Every sample again, as one drop.
fn samples_are_drops(file: &ProductFile) {
    let (columns, all) = values(file, settings(300, 9));
    for row in all.chunks(columns.len()) {
        let known = answers(file, &columns, row).iter().map(|(_, used)| *used).fold(0.0, f64::max);
        let found = row[columns.len() - 1];
        assert!((found / known - 1.0).abs() < 0.005, "{found}, not {known}: {row:?}");
    }
}

#[test]
fn samples_are_those_of_single_drops() {
    let contact = format!("{BODY}\ncontact_time = {{ uniform = [\"0.2 ms\", \"0.9 ms\"] }}");
    let soft = "position = { uniform = [\"-40 mm\", \"40 mm\"] }\nextent = \"20 mm\"\n\
        natural_frequency = { uniform = [\"80 Hz\", \"220 Hz\"] }\nquality_factor = { uniform = [5, 20] }\n\
        acceleration_limit = { uniform = [\"300 gn\", \"500 gn\"] }\nrattle_space = { uniform = [\"5 mm\", \"9 mm\"] }";
    let hard = "position = \"40 mm\"\nmount = \"hard\"\nacceleration_limit = \"4000 gn\"\n\
        velocity_change_limit = { uniform = [\"5 m/s\", \"9 m/s\"] }\nangular_velocity_change_limit = \"90 rad/s\"\n\
        damage_boundary = { velocity_change = { uniform = [\"3 m/s\", \"6 m/s\"] }, \
        acceleration = { uniform = [\"500 gn\", \"4000 gn\"] } }";
    samples_are_drops(&product(BODY, SPREAD, soft));
    samples_are_drops(&product(&contact, SPREAD, soft));
    samples_are_drops(&product(&contact, SPREAD, hard));
    samples_are_drops(&overlapping());
    // Without a contact time a damage boundary is its velocity change.
    let hard = hard.replace("acceleration_limit = \"4000 gn\"\n", "");
    samples_are_drops(&product(BODY, SPREAD, &hard));
}

/// Where a bouncy body lands again is sensitive to every input, so that one drop to two tolerances may be two drops. How many fail is
/// the same.
#[test]
fn a_bouncy_body_fails_as_often_as_single_drops_do() {
    let body = BODY.replace("0.3", "0.8");
    let contact = format!("{body}\ncontact_time = \"0.4 ms\"");
    let soft = "position = \"-40 mm\"\nnatural_frequency = { uniform = [\"80 Hz\", \"220 Hz\"] }\ndamping_ratio = 0.01\n\
        acceleration_limit = \"550 gn\"";
    for body in [body, contact] {
        let file = product(&body, SPREAD, soft);
        let (columns, rows) = values(&file, settings(600, 77));
        let survives = |row: &&[f64]| answers(&file, &columns, row)[0].1 <= 1.0;
        let survivors = rows.chunks(columns.len()).filter(survives).count();
        let known = clopper_pearson(survivors as u64, 600, 0.999);
        let found = draw(&file, settings(5000, 1)).survival;
        assert!(known.lo > 0.1 && known.hi < 0.9, "{known:?}");
        assert!((known.lo..=known.hi).contains(&found.estimate.unwrap()), "{found:?}, not {known:?}");
    }
}

/// Numbers of no relation to those of the sampler.
struct Other(u64);

impl Other {
    fn even(&mut self, lo: f64, hi: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let share = ((z ^ (z >> 31)) >> 11) as f64 * 0.5_f64.powi(53);
        lo + share * (hi - lo)
    }
}

#[test]
fn a_part_whose_contacts_overlap_fails_as_often_as_single_drops_do() {
    let file = overlapping();
    let mut other = Other(1);
    let fails = |drop: &Drop| {
        let suspension = file.components[0].mount.suspension(200.0, 0.05).unwrap();
        let limit = Limit::of(&file.components[0])[0];
        let asked: Answer = answer(drop, &Part::new(0.06, suspension), &limit, Model::Compliant, 0.01).unwrap();
        asked.utilization() > 1.0
    };
    let drops = 2000;
    let survivors = (0..drops).filter(|_| {
        let drop = Drop {
            direction_rad: Drop::towards(if other.even(0.0, 1.0) < 0.5 { clatter::End::A } else { clatter::End::B }),
            gravity_m_s2: STANDARD_GRAVITY_M_S2,
            contact_time_s: Some(4e-4),
            ..Drop::new(file.product.body, (2.0 * STANDARD_GRAVITY_M_S2).sqrt(), other.even(0.0, 0.5).to_radians(), 0.3)
        };
        !fails(&drop)
    });
    let known = clopper_pearson(survivors.count() as u64, drops, 0.999);
    let survival = draw(&file, settings(20_000, 1)).survival;
    let estimate = survival.estimate.unwrap();
    assert!(known.lo <= estimate && estimate <= known.hi, "{survival:?}, not {known:?}");
    assert!(survival.hi - survival.lo < 0.03 && survival.lo < survival.hi, "{survival:?}");
}

/// What all parts survive together each of them survives, and what they survive in all drops they survive in each: the estimate, both ends
/// of the interval and the one-sided bound.
fn all_survive_no_more_often_than_each(text: &str, samples: u64) -> Scatter {
    let file = ProductFile::read(text, "test.toml").unwrap_or_else(|faults| panic!("{faults}\n{text}"));
    let scatter = draw(&file, settings(samples, 1));
    let told = |of: &Probability| [of.estimate.unwrap_or(0.0), of.lo, of.hi, of.at_least];
    let least = |all: &Probability, each: &Probability| {
        assert!(told(all).iter().zip(told(each)).all(|(all, each)| *all <= each), "{all:?}, {each:?}: {text}");
    };
    for (i, component) in scatter.components.iter().enumerate() {
        least(&scatter.survival, &component.survival);
        for landing in &scatter.landings {
            least(&scatter.survival, &landing.survival);
            least(&component.survival, &landing.components[i].survival);
            least(&landing.survival, &landing.components[i].survival);
        }
    }
    scatter
}

#[test]
fn all_parts_survive_no_more_often_than_one_of_them() {
    const PHONE: &str = r#"
product = { name = "Phone", length = "160 mm", radius_of_gyration = "44 mm", restitution = [0.3, 0.4], contact_time = "0.45 ms" }
drop = { height = "1.2 m", tilt = ["0 deg", "15 deg"] }
component = [
    { name = "display", position = "0 mm", extent = "140 mm", natural_frequency = "300 Hz", quality_factor = 4, acceleration_limit = "2000 gn" },
    { name = "camera", position = "62 mm", natural_frequency = "800 Hz", damping_ratio = 0.1, acceleration_limit = "5000 gn" },
    { name = "battery", position = "-12 mm", extent = "75 mm", mount = "hard", acceleration_limit = "4000 gn" },
]
"#;
    let scatter = all_survive_no_more_often_than_each(PHONE, 9000);
    let survival = [scatter.components[0].survival, scatter.components[1].survival];
    assert!(scatter.components[0].failures > 0 && scatter.components[1].failures == 0, "{survival:?}");
    // Parts that never fail are as certain as so many samples make them.
    assert!((survival[1].at_least - 0.05f64.powf(1.0 / 9000.0)).abs() < 1e-15, "{survival:?}");
}

/// A bar, a plate or a box with two parts, that falls once or twice; some are so soft that no model answers them.
fn any_product(n: usize, random: &mut Random) -> String {
    let (body, list) = (["bar", "plate", "box"][n % 3], ["[drop]", "[[drop]]"][n % 2]);
    let mut between = |lo: f64, hi: f64| random.even(lo, hi);
    let (width, thickness, e) = (between(50.0, 80.0), between(10.0, 30.0), between(0.1, 0.8));
    let contact_ms = 0.1 * 200.0_f64.powf(between(0.0, 1.0));
    let mut text = vec![format!(
        "[product]\nname = \"p\"\nlength = \"140 mm\"\nrestitution = [{e}, {}]\ncontact_time = \"{contact_ms} ms\"",
        e + 0.05
    )];
    text.push(match body {
        "bar" => "radius_of_gyration = \"38 mm\"".to_owned(),
        _ => format!("width = \"{width} mm\"\nradius_of_gyration = [\"38 mm\", \"{} mm\"]", 0.29 * width),
    });
    text.extend((body == "box").then(|| format!("thickness = \"{thickness} mm\"")));
    for _ in 0..=n % 2 {
        let tilted = if body == "box" {
            "face = \"bottom\"\nattitude_tolerance = \"4 deg\""
        } else {
            "tilt = [\"0 deg\", \"10 deg\"]"
        };
        text.push(format!("{list}\nheight = [\"{} m\", \"1.5 m\"]\n{tilted}", between(0.5, 1.4)));
    }
    for part in ["one", "other"] {
        let [x, y] = [between(-60.0, 60.0), between(-0.4, 0.4) * width];
        let position = if body == "bar" { format!("\"{x} mm\"") } else { format!("[\"{x} mm\", \"{y} mm\"]") };
        let mount = match between(0.0, 1.0) {
            ..0.4 => format!("mount = \"hard\"\nvelocity_change_limit = \"{} m/s\"", between(4.0, 9.0)),
            ..0.7 => format!("mount = \"hard\"\nacceleration_limit = \"{} gn\"", between(300.0, 1800.0) / contact_ms),
            _ => format!(
                "natural_frequency = \"{} Hz\"\ndamping_ratio = 0.1\nrattle_space = \"9 mm\"",
                between(50.0, 200.0)
            ),
        };
        text.push(format!("[[component]]\nname = \"{part}\"\nposition = {position}\n{mount}"));
    }
    text.join("\n")
}

#[test]
fn all_parts_of_any_product_survive_no_more_often_than_each() {
    let mut random = Random(11);
    let (mut failed, mut unanswered, mut open) = (0, 0, 0);
    for n in 0..90 {
        let scatter = all_survive_no_more_often_than_each(&any_product(n, &mut random), 24);
        failed += usize::from(scatter.components.iter().any(|part| (1..24).contains(&part.failures)));
        unanswered += usize::from(scatter.unanswered > 0);
        open += usize::from(scatter.open > 0);
    }
    assert!(failed > 20 && unanswered > 3 && open > 3, "{failed}, {unanswered}, {open}");
}

#[test]
fn samples_without_an_answer_are_told_and_are_no_survivors() {
    // Contacts so long that the ends would sink in far.
    let body = "radius_of_gyration = \"38 mm\"\nrestitution = 0.5\ncontact_time = \"50 ms\"";
    let hard = "position = \"70 mm\"\nmount = \"hard\"\nvelocity_change_limit = \"1000 m/s\"";
    let file = product(body, SPREAD, hard);
    let found = draw(&file, settings(50, 1));
    let part = &found.components[0];
    assert_eq!((found.unanswered, part.unanswered, part.failures), (50, 50, 0));
    assert!(found.reason.is_some() && part.worst_sample.is_none(), "{:?}", found.reason);
    for survival in [found.survival, part.survival] {
        assert_eq!((survival.estimate, survival.at_least, survival.lo, survival.hi), (None, 0.0, 0.0, 1.0));
    }
    let (columns, all) = values(&file, settings(3, 1));
    assert!(all.chunks(columns.len()).all(|row| row[columns.len() - 1].is_nan()), "{all:?}");
}

#[test]
fn settings_that_make_no_sense_are_refused() {
    let (file, _) = known();
    for wrong in [
        Settings { samples: 0, ..settings(1, 1) },
        Settings { confidence: 1.0, ..settings(1, 1) },
        Settings { confidence: f64::NAN, ..settings(1, 1) },
    ] {
        assert!(Sampler::new(&file, wrong).is_err(), "{wrong:?}");
    }
    let far = SPREAD
        .replace("[\"1 m\", \"0.2 m\"]", "[\"1 m\", \"0.001 m\"]")
        .replace("[\"0.5 m\", \"1.5 m\"]", "[\"2 m\", \"3 m\"]");
    let error = Sampler::new(&product(BODY, &far, SOFT), settings(1, 1)).unwrap_err();
    assert!(error.to_string().starts_with("height:"), "{error}");
}

/// The worst drops of a design plane against the search of an assessment, which looks closer.
#[test]
fn extremes_are_next_to_the_worst_of_an_assessment() {
    let soft = SOFT.replace("{ uniform = [\"80 Hz\", \"120 Hz\"] }", "[\"80 Hz\", \"120 Hz\"]");
    for body in
        [BODY.to_owned(), format!("{BODY}\ncontact_time = \"0.4 ms\""), format!("{BODY}\ncenter_of_mass = \"5 mm\"")]
    {
        let file = product(&body, SPREAD, &soft);
        let found = extremes(&file, &[(file.product.body, 0.3)]).unwrap();
        let contacts = body.contains("contact");
        assert_eq!(found.model, if contacts { Model::Compliant } else { Model::Map }, "{}", found.closed_form_error);
        let worst = found.worst[0][0].unwrap();
        let limits = &clatter_assess::assess(&file).unwrap().components[0].limits;
        let known = limits.iter().map(|limit| limit.demand.unwrap() / limit.allowed).fold(0.0, f64::max);
        assert!(worst < 1.02 * known && worst > 0.97 * known, "{worst}, not {known}: {body}");
    }
}

/// Where either end may touch first the worst is that of the worse end, alone; a part off the middle tells both apart.
#[test]
fn extremes_of_either_end_are_those_of_the_worse_end() {
    let of = |position: &str, first: &str| {
        let part = SOFT.replace("40 mm", position).replace("{ uniform = [\"80 Hz\", \"120 Hz\"] }", "\"100 Hz\"");
        // Steep enough that no two ends land as one.
        let drop = format!("height = \"1 m\"\ntilt = [\"3 deg\", \"6 deg\"]\nfirst = \"{first}\"");
        let file = product(BODY, &drop, &part);
        extremes(&file, &[(file.product.body, 0.3)]).unwrap().worst[0][0].unwrap()
    };
    for position in ["40 mm", "-55 mm"] {
        let [a, b, either] = ["a", "b", "either"].map(|first| of(position, first));
        assert!((a / b - 1.0).abs() > 0.01, "{position}: {a} and {b}");
        assert!((either / a.max(b) - 1.0).abs() < 1e-9, "{position}: {either}, not {}", a.max(b));
    }
}
