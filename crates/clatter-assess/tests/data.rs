//! Data of a product that is built in code: what no product file may say is refused by its name and its value, never answered.

use std::panic::{AssertUnwindSafe, catch_unwind};

use clatter::End;
use clatter_assess::{
    Accuracy, Part, answer,
    design::{Bounds, Plane},
    respond, scatter,
};
use clatter_flight::Body;
use clatter_product::{
    Component, Damping, DataFault, Drop, DropRanges, EXAMPLE, Error, Fall, First, Law, Limit, LimitKind, Limits, Model,
    Mount, Product, ProductFile, RecordFile, Spread,
};
use clatter_shock::{DampingRatio, Suspension};
use proptest::prelude::*;

fn value(x: f64) -> Spread {
    Spread::value(x).expect("a finite number")
}

/// Two parts with every limit, one of them suspended.
fn phone() -> ProductFile {
    let body = Body::new(0.15, 0.045).unwrap();
    let mut product = Product::new("phone", body, value(0.3));
    product.contact_time_s = Some(value(0.4e-3));
    product.mass_kg = Some(0.19);
    let drop = DropRanges::new(Fall::HeightM(value(1.0)), Spread::new(0.0, 0.1, Law::Range).unwrap());
    let limits = Limits::default()
        .with(LimitKind::Acceleration, value(9e3))
        .with(LimitKind::VelocityChange, value(12.0))
        .with(LimitKind::AngularVelocityChange, value(90.0))
        .with_damage_boundary(value(9.0), value(5e3));
    let hard = Component::new("display", value(-0.02), Mount::Hard, limits);
    let mount = Mount::Suspended { frequency_hz: value(180.0), damping: Damping::Ratio(value(0.05)) };
    let limits = limits.with(LimitKind::RattleSpace, value(2e-3));
    let board = Component { extent_m: 0.01, ..Component::new("board", value(0.05), mount, limits) };
    ProductFile::new(product, drop, vec![hard, board]).expect("it is sound")
}

fn limit(file: &mut ProductFile, component: usize, kind: LimitKind, x: f64) -> Result<(), Error> {
    let limits = &mut file.components[component].limits;
    *limits = limits.with(kind, Spread::value(x)?);
    Ok(())
}

/// Of a field its key, the SI unit, how it is set, values that are allowed and values that are not.
struct Field {
    key: &'static str,
    set: fn(&mut ProductFile, f64) -> Result<(), Error>,
    allowed: &'static [f64],
    refused: &'static [f64],
}

/// What sets a range to one value.
macro_rules! spread {
    ($file:ident, $x:ident => $($place:tt)+) => {
        |$file, $x| { $($place)+ = Spread::value($x)?.into(); Ok(()) }
    };
}
macro_rules! number {
    ($file:ident, $x:ident => $($place:tt)+) => {
        |$file, $x| { $($place)+ = $x.into(); Ok(()) }
    };
}

const FIELDS: &[Field] = &[
    Field {
        key: "restitution",
        set: spread!(file, x => file.product.restitution),
        allowed: &[0.0, 0.5, 1.0],
        refused: &[-1e-12, 1.0 + 1e-12, 1.7, -0.3],
    },
    Field {
        key: "contact_time",
        set: spread!(file, x => file.product.contact_time_s),
        allowed: &[0.2e-3, 1e-3],
        refused: &[0.0, -4e-4, 0.9e-6, 0.11, 1e300],
    },
    Field {
        key: "mass",
        set: number!(file, x => file.product.mass_kg),
        allowed: &[1e-6, 0.2, 1000.0],
        refused: &[0.0, -0.2, 1001.0, f64::NAN, f64::INFINITY],
    },
    Field {
        key: "height",
        set: |file, x| {
            file.drop.fall = Fall::HeightM(Spread::value(x)?);
            Ok(())
        },
        allowed: &[0.01, 2.0],
        refused: &[0.0, -1.0, 1001.0, 1e-5],
    },
    Field {
        key: "speed",
        set: |file, x| {
            file.drop.fall = Fall::SpeedMS(Spread::value(x)?);
            Ok(())
        },
        allowed: &[0.1, 6.0],
        refused: &[0.0, -4.0, 101.0, 1e-4],
    },
    Field {
        key: "tilt",
        set: spread!(file, x => file.drop.tilt_rad),
        allowed: &[0.0, 0.05, std::f64::consts::FRAC_PI_6],
        refused: &[-1e-9, 0.524, 0.7, 1.6, 30.0],
    },
    Field {
        key: "gravity",
        set: number!(file, x => file.drop.gravity_m_s2),
        allowed: &[1.62, 9.81],
        refused: &[-9.81, 981.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY],
    },
    Field {
        key: "position",
        set: spread!(file, x => file.components[1].position_m),
        allowed: &[-0.07, 0.0, 0.07],
        refused: &[101.0, -1e9],
    },
    Field {
        key: "extent",
        set: number!(file, x => file.components[1].extent_m),
        allowed: &[0.0, 0.05],
        refused: &[-0.02, 101.0, f64::NAN, f64::INFINITY],
    },
    Field {
        key: "natural_frequency",
        set: |file, x| {
            let damping = Damping::Ratio(value(0.05));
            file.components[1].mount = Mount::Suspended { frequency_hz: Spread::value(x)?, damping };
            Ok(())
        },
        allowed: &[20.0, 400.0],
        refused: &[0.0, -180.0, 0.09, 1.1e6],
    },
    Field {
        key: "damping_ratio",
        set: |file, x| {
            let damping = Damping::Ratio(Spread::value(x)?);
            file.components[1].mount = Mount::Suspended { frequency_hz: value(180.0), damping };
            Ok(())
        },
        allowed: &[0.0, 0.1, 1.0, 2.0],
        refused: &[-1e-12, -0.1, 101.0],
    },
    Field {
        key: "quality_factor",
        set: |file, x| {
            let damping = Damping::Quality(Spread::value(x)?);
            file.components[1].mount = Mount::Suspended { frequency_hz: value(180.0), damping };
            Ok(())
        },
        allowed: &[0.5, 10.0],
        refused: &[0.0, -10.0, 0.004, 1.1e9],
    },
    Field {
        key: "acceleration_limit",
        set: |file, x| limit(file, 0, LimitKind::Acceleration, x),
        allowed: &[100.0, 1e6],
        refused: &[0.0, -100.0, 9e-3, 1e9],
    },
    Field {
        key: "rattle_space",
        set: |file, x| limit(file, 1, LimitKind::RattleSpace, x),
        allowed: &[1e-4, 0.1],
        refused: &[0.0, -1e-3, 101.0],
    },
    Field {
        key: "velocity_change_limit",
        set: |file, x| limit(file, 0, LimitKind::VelocityChange, x),
        allowed: &[0.1, 100.0],
        refused: &[0.0, -1.0, 1001.0],
    },
    Field {
        key: "angular_velocity_change_limit",
        set: |file, x| limit(file, 0, LimitKind::AngularVelocityChange, x),
        allowed: &[0.1, 1e3],
        refused: &[0.0, -1.0, 1.1e6],
    },
    Field {
        key: "velocity_change",
        set: |file, x| {
            let limits = &mut file.components[0].limits;
            *limits = limits.with_damage_boundary(Spread::value(x)?, value(5e3));
            Ok(())
        },
        allowed: &[0.1, 100.0],
        refused: &[0.0, -1.0, 1001.0],
    },
    Field {
        key: "acceleration",
        set: |file, x| {
            let limits = &mut file.components[0].limits;
            *limits = limits.with_damage_boundary(value(9.0), Spread::value(x)?);
            Ok(())
        },
        allowed: &[100.0, 1e6],
        refused: &[0.0, -1.0, 1e9],
    },
    Field {
        key: "position",
        set: |file, x| record(file, |record| record.position_m = Some(x)),
        allowed: &[-0.075, 0.02],
        refused: &[101.0, f64::NAN],
    },
    Field {
        key: "sample_rate",
        set: |file, x| record(file, |record| record.sample_rate_hz = Some(x)),
        allowed: &[1e4],
        refused: &[0.0, -1e4, f64::NAN, f64::INFINITY],
    },
    Field {
        key: "timing",
        set: |file, x| record(file, |record| record.timing_s = Some(x)),
        allowed: &[1e-5],
        refused: &[0.0, -1e-5, f64::NAN, 2.0],
    },
];

#[expect(clippy::unnecessary_wraps, reason = "as fields are set")]
fn record(file: &mut ProductFile, set: impl FnOnce(&mut RecordFile)) -> Result<(), Error> {
    let [position_m, sample_rate_hz, timing_s] = [None; 3];
    let [drop, acceleration, units] = [const { None }; 3];
    let mut record =
        RecordFile { file: "a.csv".to_owned(), drop, position_m, acceleration, units, sample_rate_hz, timing_s };
    set(&mut record);
    file.records = vec![record];
    Ok(())
}

/// Everything that takes a product says the same of data that are not allowed.
fn refusal(file: &ProductFile) -> Error {
    let error = file.check().expect_err("it is refused");
    let same = |other: Result<(), Error>| assert_eq!(format!("{other:?}"), format!("{:?}", Err::<(), _>(&error)));
    same(clatter_assess::assess(file).map(drop));
    let sampler = scatter::Sampler::new(file, settings());
    same(sampler.map(drop));
    same(scatter::extremes(file, &[]).map(drop));
    same(Plane::of(file, &Bounds::default()).map(drop));
    let assessment = phone_assessed();
    same(clatter_assess::remedies(file, &assessment, &Bounds::default(), 0.0).map(drop));
    same(clatter_assess::ladders(file, &assessment, 0.1).map(drop));
    assert!(clatter_assess::portraits(file, &assessment).is_empty(), "nothing is drawn");
    error
}

fn settings() -> scatter::Settings {
    scatter::Settings { samples: 10, seed: 1, confidence: 0.95, merge_s: 1e-3 }
}

/// An assessment that was stopped at once.
fn phone_assessed() -> clatter_assess::Assessment {
    clatter_assess::assess_watched(&phone(), &Accuracy::default(), &|_, _| false).expect("an answer")
}

#[test]
fn every_field_is_refused_out_of_its_range() {
    for field in FIELDS {
        for &x in field.allowed {
            let mut file = phone();
            (field.set)(&mut file, x).expect("a number");
            assert_eq!(file.check(), Ok(()), "{} = {x}", field.key);
        }
        for &x in field.refused {
            let mut file = phone();
            (field.set)(&mut file, x).expect("a number that may be held");
            let error = refusal(&file);
            let Error::Data { fault: DataFault::Value { field: key, value, .. }, component } = &error else {
                panic!("{} = {x}: {error}", field.key)
            };
            assert_eq!((*key, value.to_bits()), (field.key, x.to_bits()));
            let said = error.to_string();
            assert!(said.contains(&format!("`{key}` = {x}")) && said.contains("; allowed: from "), "{said}");
            let of_part = !["display", "board"].iter().all(|name| !said.contains(name));
            assert_eq!(component.is_some(), of_part, "{said}");
        }
        // What is no number is none of a range either.
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut file = phone();
            if (field.set)(&mut file, x).is_ok() {
                refusal(&file);
            }
        }
    }
}

#[test]
fn rules_between_fields_hold_in_code() {
    type Change = fn(&mut ProductFile);
    let changes: &[(Change, &str)] = &[
        (|file| file.components.clear(), "`component` has 0 entries; expected 1 to 1000"),
        (
            |file| file.components[1].limits = Limits::default(),
            "component \"board\": it has no limit; give at least one of ALL OF THEM",
        ),
        (
            |file| file.components[1].limits = Limits::default().with(LimitKind::DamageBoundary, value(3.0)),
            "component \"board\": its damage boundary has a velocity change alone; give its acceleration too",
        ),
        (
            |file| limit(file, 0, LimitKind::RattleSpace, 1e-3).unwrap(),
            "component \"display\": a hard-mounted part has no `rattle_space`; leave one of both out",
        ),
        (
            |file| file.components[1].position_m = value(0.071),
            "component \"board\": the component with its extent reaches 76 mm from the middle along the length; allowed: up to 75 mm, half \
             of the product's length: it lies within the body",
        ),
        (
            |file| file.components[1].name = " display ".to_owned(),
            "two components are named \" display \"; give each component a name of its own",
        ),
        (|file| file.components[1].name = " ".to_owned(), "component \" \": `name` is empty; expected a name"),
        (|file| file.product.name.clear(), "`name` is empty; expected a name"),
        (
            |file| file.drop.gravity_m_s2 = 0.0,
            "without gravity nothing falls from a `height`; give the `speed` at the first touch instead",
        ),
        (
            |file| file.product.contact_time_s = None,
            "component \"display\" needs the contact time of the product: the acceleration of a hard-mounted part is that of the \
             impact itself",
        ),
        (
            |file| file.product.gyration_m = value(0.046),
            "the radius of gyration of the body is 45 mm; allowed: 46 mm, the middle of the range that the product gives",
        ),
        (
            |file| file.product.gyration_m = Spread::new(0.04, 0.4, Law::Range).unwrap(),
            "the radius of gyration of the mass along the length is 400 mm; allowed: from 7.5 to 75 mm; masses within the body have no \
             larger one",
        ),
        (
            |file| file.product.body = Body::off_center(0.149, 0.001, 0.045).unwrap(),
            "the center of mass is 74 mm from the middle of a length of 150 mm; allowed: within 0.45 of it from the middle",
        ),
        (
            |file| drop(record(file, |record| record.position_m = Some(0.08))),
            "the sensor reaches 80 mm from the middle along the length; allowed: up to 75 mm, half of the product's length: it lies \
             within the body",
        ),
        (
            |file| {
                let law = Law::Normal { mean: 1.2, deviation: 0.1 };
                file.product.restitution = Spread::new(0.2, 0.9, law).unwrap();
            },
            "`restitution` = 1.2 is out of its range; allowed: from 0 to 1",
        ),
        (
            |file| {
                file.product.body = Body::new(1e-4, 2e-5).unwrap();
                file.product.gyration_m = value(2e-5);
            },
            "`length` = 0.0001 m is out of its range; allowed: from 1 mm to 100 m",
        ),
    ];
    for (change, message) in changes {
        let mut file = phone();
        change(&mut file);
        let keys = LimitKind::ALL.map(LimitKind::key).join(", ");
        assert_eq!(refusal(&file).to_string(), message.replace("ALL OF THEM", &keys));
    }
    let mut file = phone();
    file.components = vec![file.components[0].clone(); 1001];
    assert!(matches!(refusal(&file), Error::Data { fault: DataFault::Components(1001), component: None }));
}

/// A file says the same of the same value, where it stands.
#[test]
fn files_and_code_use_the_same_words() {
    let text = "product = { name = \"p\", length = \"150 mm\", radius_of_gyration = \"45 mm\", restitution = 1.7 }\n\
                drop = { speed = \"4 m/s\", tilt = \"3 deg\" }\n\
                component = [{ name = \"c\", position = \"76 mm\", mount = \"hard\", velocity_change_limit = \"9 m/s\" }]\n";
    let said = |text: &str| {
        let faults = ProductFile::read(text, "file").unwrap_err();
        let [fault] = faults.list() else { panic!("{faults}") };
        assert!(!fault.span.is_empty(), "{fault:?} stands nowhere");
        [fault.message.clone(), fault.label.clone(), fault.help.clone()]
    };
    let mut file = phone();
    file.product.restitution = value(1.7);
    let Error::Data { fault, .. } = file.check().unwrap_err() else { panic!("another error") };
    let ([message, allowed], [told, label, _]) = (fault.told(), said(text));
    assert_eq!((message, allowed), (told, label));

    let mut file = phone();
    file.components[1].position_m = value(0.071);
    let Error::Data { fault, .. } = file.check().unwrap_err() else { panic!("another error") };
    let [told, _, help] = said(&text.replace("1.7", "0.3"));
    assert_eq!(fault.told(), [told, help]);
}

#[test]
fn masses_together_are_a_mass() {
    let piece = |place: i32| format!("{{ mass = \"600 kg\", position = \"{place} mm\" }}");
    let text = format!(
        "product = {{ name = \"p\", length = \"150 mm\", masses = [{}, {}], restitution = 0.3 }}\n\
         drop = {{ speed = \"4 m/s\", tilt = \"3 deg\" }}\n\
         component = [{{ name = \"c\", position = \"0 mm\", mount = \"hard\", velocity_change_limit = \"9 m/s\" }}]\n",
        piece(-40),
        piece(40)
    );
    let faults = ProductFile::read(&text, "file").unwrap_err();
    assert_eq!(faults.list()[0].message, "`mass` = 1200 kg is out of its range");
    assert!(ProductFile::read(&text.replace("600", "500"), "file").is_ok());
}

#[test]
fn a_range_is_no_value() {
    assert_eq!(Spread::new(0.2, 0.4, Law::Value), Err(Error::Law(Law::Value)));
    assert!(Spread::new(0.2, 0.2, Law::Value).is_ok());
}

#[test]
fn settings_are_checked() {
    let file = phone();
    for merge_s in [f64::NAN, f64::INFINITY, -1e-3] {
        let accuracy = Accuracy { merge_s, ..Accuracy::default() };
        assert!(matches!(clatter_assess::assess_to(&file, &accuracy), Err(Error::Merge(_))), "{merge_s}");
        let settings = scatter::Settings { merge_s, ..settings() };
        let error = scatter::Sampler::new(&file, settings).expect_err("no time");
        assert!(matches!(error, Error::Merge(_)), "{error}");
    }
    for tolerance in [f64::NAN, 0.0, -0.1, 0.6, f64::INFINITY] {
        let accuracy = Accuracy { tolerance, ..Accuracy::default() };
        assert!(matches!(clatter_assess::assess_to(&file, &accuracy), Err(Error::Tolerance(_))), "{tolerance}");
    }
    let e = scatter::extremes(&file, &[(file.product.body, 1.7)]);
    assert!(matches!(e, Err(Error::Bar(_))), "{e:?}");
}

#[test]
fn bounds_of_a_design_are_checked() {
    let all = Bounds::default();
    let wrong = [
        Bounds { q: [0.9, 0.0], ..all },
        Bounds { q: [f64::NAN, 0.9], ..all },
        Bounds { e: [0.1, 1.2], ..all },
        Bounds { e: [0.1, f64::NAN], ..all },
        Bounds { frequency_factor: 0.0, ..all },
        Bounds { frequency_factor: f64::INFINITY, ..all },
        Bounds { damping: [-0.1, 0.5], ..all },
        Bounds { contact_time_s: [0.0, 1e-3], ..all },
        Bounds { contact_time_s: [2e-3, 1e-3], ..all },
        Bounds { limit_factor: 0.5, ..all },
    ];
    let (file, assessment) = (phone(), phone_assessed());
    for bounds in wrong {
        let error = clatter_assess::remedies(&file, &assessment, &bounds, 0.0).expect_err("no bounds");
        assert!(matches!(error, Error::Setting { .. }), "{error}");
        assert!(matches!(Plane::of(&file, &bounds), Err(Error::Setting { .. })), "{bounds:?}");
    }
}

/// An assessment of another product, and a component of none.
#[test]
fn an_assessment_belongs_to_its_product() {
    let (file, assessment) = (phone(), phone_assessed());
    let mut others = vec![file.clone(); 3];
    others[0].components.remove(1);
    others[1].components[1].name = "battery".to_owned();
    others[2].components[1].limits = file.components[1].limits.without(LimitKind::RattleSpace);
    for other in others {
        let error =
            clatter_assess::remedies(&other, &assessment, &Bounds::default(), 0.0).expect_err("another product");
        assert_eq!(error, Error::OtherProduct("board".to_owned()));
        assert_eq!(clatter_assess::ladders(&other, &assessment, 0.1).map(drop), Err(error));
        assert!(clatter_assess::portraits(&other, &assessment).is_empty());
    }
    let stranger = Component { name: "stranger".to_owned(), ..file.components[0].clone() };
    let error = clatter_assess::assess_one(&file, &stranger, &Accuracy::default(), &|_, _| false).map(drop);
    assert_eq!(error, Err(Error::OtherProduct("stranger".to_owned())));
    let bare = Component { limits: Limits::default(), ..file.components[0].clone() };
    assert!(clatter_assess::assess_one(&file, &bare, &Accuracy::default(), &|_, _| false).is_err());
}

#[test]
fn single_drops_are_checked() {
    let sound = Drop { gravity_m_s2: 9.81, ..Drop::new(Body::new(0.15, 0.045).unwrap(), 4.0, 0.05, 0.3) };
    let part = Part::new(0.0, None);
    let limit = Limit::new(LimitKind::VelocityChange, 9.0);
    let suspension = Suspension::from_hz(200.0, DampingRatio::new(0.05).unwrap()).unwrap();
    for model in Model::ALL.into_iter().filter(|model| *model != Model::Compliant) {
        assert!(answer(&sound, &part, &limit, model, 0.01).is_ok(), "{model:?}");
        // A part that does not move by itself, and a boundary of one number, which nothing would exceed.
        for (kind, said) in [
            (LimitKind::RattleSpace, "a hard-mounted part has no `rattle_space`"),
            (LimitKind::DamageBoundary, "its damage boundary has a velocity change alone"),
        ] {
            let error = answer(&sound, &part, &Limit::new(kind, 9.0), model, 0.01).unwrap_err().to_string();
            assert!(error.starts_with(said), "{error}");
        }
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0] {
            let drops = [
                Drop { tilt_rad: x, ..sound },
                Drop { speed_m_s: x, ..sound },
                Drop { restitution: x, ..sound },
                Drop { contact_time_s: Some(x), ..sound },
            ];
            for drop in drops.iter().chain(&[Drop { is_flat: true, ..drops[1] }]) {
                assert!(answer(drop, &part, &limit, model, 0.01).is_err(), "{model:?} {drop:?}");
            }
            if model >= Model::Map {
                let falls = Drop { gravity_m_s2: x, ..sound };
                assert!(answer(&falls, &part, &limit, model, 0.01).is_err(), "{model:?} {x}");
                assert!(respond(&falls, &part, &suspension, model, 0.01).is_err());
            }
            let away = Part::new(x, None);
            assert!(respond(&sound, &away, &suspension, model, 0.01).is_err() || model < Model::Map);
            assert!(answer(&sound, &away, &limit, model, 0.01).is_err(), "{model:?} {x}");
        }
        for x in [f64::NAN, 0.0, -1.0] {
            let limits = [
                Limit { allowed: x, ..limit },
                Limit { kind: LimitKind::DamageBoundary, critical_acceleration_m_s2: x, ..limit },
            ];
            for limit in limits {
                assert!(answer(&sound, &part, &limit, model, 0.01).is_err(), "{model:?} {limit:?}");
            }
        }
    }
}

/// For a long run: `PROPTEST_CASES=100000 cargo test --release -p clatter-assess --test all data::`.
fn cases(default: u32) -> ProptestConfig {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(default);
    ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases) }
}

proptest! {
    #![proptest_config(cases(200))]
    /// Of fields that are drawn from what is allowed and what is not, a product is answered where all are allowed, and refused
    /// else. Nothing panics; as many drops are followed as a small budget allows.
    #[test]
    fn wild_products_are_answered_or_refused(
        picks in prop::collection::vec((0..FIELDS.len(), any::<prop::sample::Index>(), 0..8_u8), 1..10),
        first in prop::sample::select(vec![First::Either, First::End(End::A), First::End(End::B)]),
        budget in 0..30_usize,
    ) {
        let mut file = phone();
        file.drop.first = first;
        let mut sound = [true; FIELDS.len()];
        for (k, index, coin) in picks {
            let field = &FIELDS[k];
            let is_wild = coin == 0;
            let values = if is_wild { field.refused } else { field.allowed };
            (field.set)(&mut file, values[index.index(values.len())]).expect("a number");
            // Fields that set the same place undo each other.
            for (other, sound) in FIELDS.iter().zip(&mut sound) {
                let place = |key: &str| match key {
                    "height" | "speed" => "fall".to_owned(),
                    "natural_frequency" | "damping_ratio" | "quality_factor" => "mount".to_owned(),
                    "velocity_change" | "acceleration" => "boundary".to_owned(),
                    other => other.to_owned(),
                };
                *sound |= place(other.key) == place(field.key);
            }
            sound[k] = !is_wild;
        }
        // A record's place and the part's have one key, and records replace one another.
        file.records.clear();
        let records = FIELDS.len() - 3;
        let sound = sound[..records].iter().all(|sound| *sound);
        // Whether the part is within the product is a rule of its own.
        let within = file.components[1].position_m.hi().abs() + 0.5 * file.components[1].extent_m <= 0.075 * (1.0 + 1e-9);
        let assessed = catch_unwind(AssertUnwindSafe(|| {
            clatter_assess::assess_watched(&file, &Accuracy { tolerance: 0.1, ..Accuracy::default() }, &|done, _| done < budget)
        }));
        let Ok(assessed) = assessed else { return Err(TestCaseError::fail(format!("a panic of {file:?}"))) };
        prop_assert_eq!(assessed.is_ok(), sound && within, "{:?}: {:?}", file, assessed);
    }
}

/// The example is sound as it is read and as it is built again from its parts.
#[test]
fn what_is_read_is_sound() {
    let file = ProductFile::read(EXAMPLE, "example.toml").unwrap();
    let again = ProductFile::new(file.product.clone(), file.drop, file.components.clone()).unwrap();
    assert_eq!(again, file);
}
