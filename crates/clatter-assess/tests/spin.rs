//! Products that turn as they land, against the exact trains of `clatter`, mirror images, and laws.

use clatter::{Bar, End, Start};
use clatter_assess::{
    Part, Verdict, answer,
    scatter::{Column, Progress, Sampler, Settings},
};
use clatter_product::{Body, Drop, Error, Input, Limit, LimitKind, Model, Place, ProductFile, Side};

use crate::random::Random;

const ARMS: [f64; 2] = [0.08, 0.06];
const GYRATION: f64 = 0.04;
/// That of plates.
const WIDTH: Side = Side { ends_m: [0.03, 0.04], gyration_m: 0.02 };

fn bar(first: End, spin_rad_s: f64) -> Drop {
    Drop {
        direction_rad: Drop::towards(first),
        spin_rad_s,
        gravity_m_s2: 0.0,
        contact_time_s: Some(3e-4),
        ..Drop::new(Body::off_center(ARMS[0], ARMS[1], GYRATION).unwrap(), 3.0, 0.03, 0.4)
    }
}

fn asked(drop: &Drop, at_m: f64, kind: LimitKind, model: Model) -> f64 {
    answer(drop, &Part::new(at_m, None), &Limit::new(kind, 1.0), model, 1e-4).unwrap().value
}

/// Without gravity at small tilt a bar that turns is one whose ends come down at v ± ω L: shock by shock, and in closed form.
#[test]
fn a_bar_that_turns_is_one_whose_ends_come_down_unequally_fast() {
    for (first, spin) in [(End::A, 9.0), (End::A, -20.0), (End::B, 9.0), (End::B, -20.0), (End::B, 0.0)] {
        let drop = bar(first, spin);
        let exact = Bar::from_arms(ARMS, GYRATION, 0.4).unwrap();
        let (exact, [first_m, other_m]) =
            if first == End::A { (exact, ARMS) } else { (exact.exchanged(), [ARMS[1], ARMS[0]]) };
        let start = Start::new([-3.0 - spin * first_m, -3.0 + spin * other_m], 0.14 * 0.03_f64.sin()).unwrap();
        let train: Vec<_> = exact.train(&start).take(500).collect();
        for s in [-1.0, -0.3, 0.4, 1.0] {
            let at_m = if first == End::A { 0.07 * s } else { -0.07 * s };
            let most = train.iter().map(|strike| strike.delta_v_at(s).abs()).fold(0.0, f64::max);
            for model in [Model::Map, Model::LargestShock] {
                let told = asked(&drop, at_m, LimitKind::VelocityChange, model);
                assert!((told / most - 1.0).abs() < 1e-9, "{model:?} {first:?} {spin} at {s}: {told}, not {most}");
            }
            let net = train.iter().map(|strike| strike.delta_v_at(s)).sum::<f64>().abs();
            let told = asked(&drop, at_m, LimitKind::VelocityChange, Model::NetChange);
            assert!((told / net - 1.0).abs() < 1e-6, "{first:?} {spin} at {s}: {told}, not {net}");
        }
    }
}

/// The end that touches first comes down at v + ω L: nothing else has happened yet as it strikes, by any model.
#[test]
fn the_first_strike_is_that_of_an_end_that_comes_down_faster() {
    for spin in [-20.0, 12.0] {
        let drop = Drop { restitution: 0.0, tilt_rad: 0.1, gravity_m_s2: 9.81, ..bar(End::A, spin) };
        // Instant: its end is stopped, at the lever arm of its tilt.
        let arm = ARMS[0] * 0.1_f64.cos();
        for (model, arm) in [(Model::Map, ARMS[0]), (Model::Ballistic, ARMS[0]), (Model::FiniteTilt, arm)] {
            let told = asked(&drop, -0.07, LimitKind::VelocityChange, model);
            let first = 3.0 + spin * arm;
            // The far end strikes later, and may do more there.
            assert!(told >= first * (1.0 - 1e-9), "{model:?} {spin}: {told} below {first}");
            if spin > 0.0 {
                assert!((told / first - 1.0).abs() < 1e-9, "{model:?} {spin}: {told}, not {first}");
            }
        }
    }
}

/// Seen from behind, end b first is end a first of the bar the other way around, by every model; a plate that rises to the other side is
/// the plate the other way around.
#[test]
fn a_mirrored_drop_asks_the_same() {
    let (one, body) = (bar(End::B, 7.0), Body::off_center(ARMS[1], ARMS[0], GYRATION).unwrap());
    let other = Drop { direction_rad: Drop::towards(End::A), body, ..one };
    for model in Model::ALL {
        for kind in [LimitKind::VelocityChange, LimitKind::AngularVelocityChange] {
            let [a, b] = [(&one, 0.05), (&other, -0.05)].map(|(drop, at_m)| asked(drop, at_m, kind, model));
            assert!((a / b - 1.0).abs() < 1e-9, "{model:?} {kind:?}: {a}, {b}");
        }
    }
    let plate = |bar: Body, xy: f64, direction_rad: f64| {
        let body = Body { products_m2: [xy, 0.0, 0.0], ..bar.with_width(WIDTH) };
        Drop { body, direction_rad, ..one }
    };
    let (one, other) = (plate(one.body, 2e-4, 2.5), plate(body, -2e-4, std::f64::consts::PI - 2.5));
    assert_eq!([one.first(), other.first()], [End::B, End::A]);
    let [a, b] = [(&one, 0.05), (&other, -0.05)].map(|(drop, x)| {
        let part = Part::at(Place::flat([x, 0.02]), None);
        answer(drop, &part, &Limit::new(LimitKind::Acceleration, 1.0), Model::Compliant, 1e-3).unwrap().value
    });
    assert!((a / b - 1.0).abs() < 1e-6, "{a}, {b}");
}

/// Level, it does not matter from which corner one looks: turning up towards one side is turning down towards the other.
#[test]
fn a_level_plate_turns_one_way_or_the_other() {
    let of = |direction_rad: f64, spin_rad_s: f64| {
        let bar = bar(End::A, spin_rad_s);
        let drop = Drop { body: bar.body.with_width(WIDTH), direction_rad, tilt_rad: 0.0, ..bar };
        let part = Part::at(Place::flat([0.05, 0.02]), None);
        answer(&drop, &part, &Limit::new(LimitKind::Acceleration, 1.0), Model::Compliant, 1e-3).unwrap().value
    };
    let still = of(0.7, 0.0);
    for spin in [4.0, 25.0] {
        let [one, other] = [of(0.7, spin), of(0.7 + std::f64::consts::PI, -spin)];
        assert!((one / other - 1.0).abs() < 1e-6 && (one / still - 1.0).abs() > 1e-3, "{one}, {other}, {still}");
    }
}

/// A box turns towards the attitude that it would have a little later: off a face, an edge or a corner to any side, and at a tilt.
#[test]
fn a_box_turns_as_its_tilt_grows() {
    let bar = bar(End::A, 4.0);
    let width = Side { ends_m: [0.03; 2], gyration_m: 0.02 };
    let mut body = bar.body.with_width(width).with_thickness(Side::even(0.02));
    body.products_m2[0] = 1e-4;
    let tilted = |tilt: f64, direction: f64| [tilt.sin() * direction.cos(), tilt.sin() * direction.sin(), tilt.cos()];
    let of = |base, spin_axis, direction_rad, tilt_rad| {
        Drop { body, is_level: false, base, spin_axis, direction_rad, tilt_rad, ..bar }.of_box().unwrap().unwrap()
    };
    let step = 1e-6;
    for direction in [0.0, 0.8, 2.9, 4.4] {
        let pairs = [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.5, -0.5, 0.5_f64.sqrt()]]
            .map(|upward| (of(upward, None, direction, 0.05), of(upward, None, direction, 0.05 + step)));
        let about = Some([direction.sin(), -direction.cos(), 0.0]);
        let at = |tilt| of(tilted(tilt, direction), about, 1.0, 0.0);
        for (now, then) in pairs.into_iter().chain([(at(0.4), at(0.4 + step))]) {
            let ([x, y, z], [a, b, c]) = (now.upward(), now.spin_rad_s());
            let rises = [y * c - z * b, z * a - x * c, x * b - y * a];
            for i in 0..3 {
                let want = 4.0 * (then.upward()[i] - now.upward()[i]) / step;
                assert!((rises[i] - want).abs() < 1e-4, "{direction}: {rises:?}, not {want} along {i}");
            }
        }
    }
}

fn read(drop: &str, product: &str) -> Result<ProductFile, String> {
    let text = format!(
        "product = {{ name = \"bar\", length = \"150 mm\", radius_of_gyration = \"43 mm\", restitution = 0.3{product} }}\n\
         drop = {{ {drop} }}\n\
         component = [{{ name = \"end\", position = \"70 mm\", mount = \"hard\", velocity_change_limit = \"30 m/s\" }}]\n"
    );
    ProductFile::read(&text, "bar.toml").map_err(|faults| faults.to_string())
}

/// The search finds the end of the range of the spin at which the first strike is hardest, and energy allows what it asks; one value
/// less than nothing is another drop than none.
#[test]
fn the_search_finds_an_end_of_the_spin() {
    let file = read(
        "speed = \"3 m/s\", tilt = [\"2 deg\", \"6 deg\"], first = \"b\", spin = [\"-300 deg/s\", \"20 rad/s\"]",
        ", contact_time = \"0.3 ms\"",
    );
    let found = &clatter_assess::assess(&file.unwrap()).unwrap().components[0].limits[0];
    let worst = found.worst_case.unwrap();
    assert_eq!(worst.drop.spin_rad_s.to_bits(), 20.0_f64.to_bits(), "{worst:?}");
    // 1.3 (v + ω L) of a lone strike.
    let lone = 1.3 * (3.0 + 20.0 * 0.075 * worst.drop.tilt_rad.cos());
    assert!(found.demand.unwrap() > 0.9 * lone && found.demand < found.bound, "{found:?}, {lone}");
    assert!(worst.command().contains("\"spin_rad_s\":20.0,"), "{}", worst.command());
    let still =
        read("speed = \"3 m/s\", tilt = [\"2 deg\", \"6 deg\"], first = \"b\"", ", contact_time = \"0.3 ms\"").unwrap();
    let still = &clatter_assess::assess(&still).unwrap().components[0].limits[0];
    assert!(still.demand.unwrap() < 0.8 * found.demand.unwrap(), "{still:?}");
}

/// Energy allows every drop: of bars and plates that turn at any rate, 2 √(v² + ω²ρ²) at the center of mass.
#[test]
fn energy_allows_every_drop_that_turns() {
    let r = &mut Random(5);
    let mut tightest = 0.0_f64;
    for n in 0..4 {
        let width = if n % 2 == 0 { ", width = \"90 mm\"" } else { "" };
        let radius = if n % 2 == 0 { "[\"40 mm\", \"28 mm\"]" } else { "\"40 mm\"" };
        let at = if n % 2 == 0 { "[\"0 mm\", \"0 mm\"]" } else { "\"0 mm\"" };
        // At most 0.85 of what turns a corner up.
        let [lo, hi] = [r.even(-20.0, 0.0), r.even(0.0, 90.0)];
        let text = format!(
            "product = {{ name = \"p\", length = \"150 mm\"{width}, radius_of_gyration = {radius}, restitution = 0.5, contact_time = \"0.3 ms\" }}\n\
             drop = {{ speed = \"2.1 m/s\", tilt = [\"0 deg\", \"4 deg\"], spin = [\"{lo} rad/s\", \"{hi} rad/s\"], gravity = \"0 gn\" }}\n\
             component = [{{ name = \"part\", position = {at}, mount = \"hard\", velocity_change_limit = \"1 m/s\", angular_velocity_change_limit = \"1 rad/s\", acceleration_limit = \"1 gn\" }}]\n"
        );
        let file = ProductFile::read(&text, "p.toml").unwrap_or_else(|faults| panic!("{faults}"));
        for limit in &clatter_assess::assess(&file).unwrap().components[0].limits {
            let (demand, bound) = (limit.demand.unwrap(), limit.bound.unwrap());
            assert!(demand <= bound && limit.verdict == Verdict::Unsafe, "{n}: {limit:?}");
            tightest = tightest.max(demand / bound);
        }
    }
    assert!(tightest > 0.3, "{tightest}: far from what is allowed nothing would be seen");
}

/// What cannot be followed is refused with the value, where it stands and what is allowed.
#[test]
fn a_spin_that_nothing_answers_is_refused() {
    let timed = ", contact_time = \"0.3 ms\"";
    for (drop, product, words) in [
        (
            "speed = \"3 m/s\", tilt = \"5 deg\", spin = \"-41 rad/s\"",
            timed,
            vec!["bar.toml:2", "-41 rad/s", "above -39.96 rad/s"],
        ),
        (
            "speed = \"3 m/s\", tilt = \"5 deg\", spin = \"2000 rad/s\"",
            timed,
            vec!["`spin`", "from -1000 rad/s to 1000 rad/s"],
        ),
        ("speed = \"3 m/s\", tilt = [\"0 deg\", \"5 deg\"], spin = \"2 rad/s\"", "", vec!["contact_time", "1 ms"]),
        ("speed = \"3 m/s\", tilt = \"5 deg\", spin = \"2 m/s\"", timed, vec!["`spin`", "rad/s"]),
    ] {
        let said = read(drop, product).unwrap_err();
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    }
    assert!(read("speed = \"3 m/s\", tilt = \"9 deg\", spin = \"-39.9 rad/s\"", timed).is_ok());
    // Without contact time where no strikes are one, by real tilt.
    let apart = read("speed = \"3 m/s\", tilt = \"9 deg\", spin = [\"-9 rad/s\", \"9 rad/s\"]", "").unwrap();
    assert_eq!(clatter_assess::assess(&apart).unwrap().components[0].limits[0].model.bar, Model::FiniteTilt);
    let flat = Drop { is_flat: true, contact_time_s: None, ..bar(End::A, 1.0) };
    let said =
        answer(&flat, &Part::new(0.0, None), &Limit::new(LimitKind::VelocityChange, 1.0), Model::FiniteTilt, 0.01);
    assert!(matches!(said, Err(Error::Setting { name: "spin in rad/s", .. })), "{said:?}");
}

/// Samples draw the spin from its range, evenly, and all else as without one.
#[test]
fn samples_draw_the_spin() {
    let rows = |spin: &str| {
        let file = read(
            &format!("speed = [\"2 m/s\", \"3 m/s\"], tilt = [\"1 deg\", \"6 deg\"]{spin}"),
            ", contact_time = \"0.3 ms\"",
        );
        let settings = Settings { samples: 400, seed: 3, confidence: 0.95, merge_s: 1e-3 };
        let sampler = Sampler::new(&file.unwrap(), settings).unwrap();
        let (columns, mut all) = (sampler.columns(), Vec::new());
        let keep = |progress: &Progress<'_>| {
            all.extend_from_slice(progress.values);
            Ok::<_, ()>(())
        };
        sampler.run(true, &|| true, keep).unwrap();
        let column = |of: Column| {
            let n = columns.iter().position(|column| *column == of);
            n.map(|n| all.chunks(columns.len()).map(|row| row[n]).collect::<Vec<f64>>())
        };
        [Column::Drop(Input::Spin, None), Column::Drop(Input::Speed, None), Column::Drop(Input::Tilt, None)].map(column)
    };
    let [[none, speed, tilt], [spin, same_speed, same_tilt]] =
        ["", ", spin = { uniform = [\"-5 rad/s\", \"15 rad/s\"] }"].map(rows);
    assert!(none.is_none() && speed == same_speed && tilt == same_tilt);
    let spin = spin.unwrap();
    let mean = spin.iter().sum::<f64>() / 400.0;
    // Of 400 the mean is off by 20/√12/20 = 0.29, four times which is seen once in ten thousand seeds.
    assert!(spin.iter().all(|w| (-5.0..=15.0).contains(w)) && (mean - 5.0).abs() < 1.2, "{mean}");
}
