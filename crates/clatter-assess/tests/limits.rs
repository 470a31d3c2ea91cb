//! Every kind of limit goes all the way: read, checked, assessed, drawn from, shown and repeated.

use clatter_assess::scatter::{Sampler, Settings};
use clatter_assess::{Accuracy, LimitKind, ProductFile, Unit, Verdict, repeat};

/// A product of which one part has a limit of each kind, weak or strong.
fn product(kind: LimitKind, factor: f64) -> String {
    let of = |unit: Unit| match unit {
        Unit::MeterPerSecondSquared => format!("{} m/s2", 2e3 * factor),
        Unit::Meter => format!("{} mm", 3.0 * factor),
        Unit::MeterPerSecond => format!("{} m/s", 5.0 * factor),
        Unit::RadianPerSecond => format!("{} rad/s", 100.0 * factor),
    };
    let limit = if kind == LimitKind::DamageBoundary {
        let [velocity, acceleration] = [Unit::MeterPerSecond, Unit::MeterPerSecondSquared].map(of);
        format!("{{ velocity_change = \"{velocity}\", acceleration = \"{acceleration}\" }}")
    } else {
        format!("\"{}\"", of(kind.unit()))
    };
    format!(
        r#"
product = {{ name = "Phone", length = "150 mm", radius_of_gyration = "43 mm", restitution = 0.4, contact_time = "0.4 ms", contact_law = "hysteretic" }}
drop = {{ height = "1 m", tilt = ["1 deg", "4 deg"] }}
component = [{{ name = "part", position = "40 mm", natural_frequency = "200 Hz", damping_ratio = 0.05, {} = {limit} }}]
"#,
        kind.key()
    )
}

/// A part with a limit of every kind is drawn as well, each counted for itself.
#[test]
fn a_part_may_have_every_kind() {
    let mut file = read(&product(LimitKind::DamageBoundary, 10.0));
    for kind in LimitKind::ALL {
        let limits = read(&product(kind, 10.0)).components[0].limits;
        let all = file.components[0].limits;
        file.components[0].limits = all.with(kind, *limits.get(kind).expect("its limit"));
    }
    let settings = Settings { samples: 200, seed: 1, confidence: 0.95, merge_s: 1e-12 };
    let scatter = Sampler::new(&file, settings).unwrap().run::<()>(false, &|| true, |_| Ok(())).unwrap();
    assert_eq!(scatter.components[0].limits, LimitKind::ALL.map(|kind| (kind, 0)));
}

fn read(text: &str) -> ProductFile {
    ProductFile::read(text, "product.toml").unwrap_or_else(|faults| panic!("{faults}\n{text}"))
}

#[test]
fn every_kind_is_read_assessed_and_drawn() {
    for kind in LimitKind::ALL {
        let demand = |factor: f64, expected: Verdict| {
            let file = read(&product(kind, factor));
            assert_eq!(file.components[0].limits.kinds(), [kind]);
            let assessment = file.assess().expect("an assessment");
            let limit = &assessment.components[0].limits[0];
            assert_eq!((limit.limit, limit.verdict), (kind, expected), "{limit:?}");
            let portrait = &file.portraits(&assessment)[0];
            assert!(portrait.history.iter().any(|point| point.1 != 0.0), "{kind:?} is not drawn");
            let settings = Settings { samples: 200, seed: 1, confidence: 0.95, merge_s: 1e-12 };
            let scatter = Sampler::new(&file, settings).unwrap().run::<()>(false, &|| true, |_| Ok(())).unwrap();
            let [(counted, failed)] = scatter.components[0].limits[..] else { panic!("{scatter:?}") };
            assert_eq!(counted, kind);
            assert_eq!(failed > 0, expected == Verdict::Unsafe, "{failed} of {kind:?}");
            limit.demand.expect("a demand") / limit.allowed
        };
        let (weak, strong) = (demand(0.1, Verdict::Unsafe), demand(10.0, Verdict::Safe));
        // What is asked does not depend on what is allowed.
        assert!((weak / strong / 100.0 - 1.0).abs() < 1e-6, "{kind:?}: {weak}, {strong}");
    }
}

/// Each is called by its own names, wherever it is named.
#[test]
fn every_kind_has_names_of_its_own() {
    type Name = fn(LimitKind) -> String;
    let names: [Name; 5] = [
        |kind| kind.name().to_owned(),
        |kind| kind.key().to_owned(),
        |kind| kind.words().to_owned(),
        |kind| kind.allowed().to_owned(),
        |kind| repeat("phone.toml", "part", kind, &Accuracy::default()).expect("a command"),
    ];
    for name in names {
        let mut all = LimitKind::ALL.map(name).to_vec();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), LimitKind::ALL.len(), "{all:?}");
    }
}
