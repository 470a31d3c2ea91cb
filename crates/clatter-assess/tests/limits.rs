//! Every kind of limit goes all the way: read, checked, assessed, drawn from, shown and repeated.

use clatter::End;
use clatter_assess::{
    Accuracy, Part, Verdict, answer,
    ladder::{Groups, Ladder},
    repeat,
    scatter::{Sampler, Settings},
};
use clatter_product::{Body, Damping, Drop, Law, Limit, LimitKind, Model, Place, ProductFile, Spread, Stops, Unit};
use clatter_shock::{DampingRatio, Suspension};

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
    let stop = "stop = { gap = \"0.5 mm\", contact_time = \"0.5 ms\", restitution = 0.4 }, ";
    let stop = if kind == LimitKind::StopSpeed { stop } else { "" };
    format!(
        r#"
product = {{ name = "Phone", length = "150 mm", radius_of_gyration = "43 mm", restitution = 0.4, contact_time = "0.4 ms", contact_law = "hysteretic" }}
drop = {{ height = "1 m", tilt = ["1 deg", "4 deg"] }}
component = [{{ name = "part", position = "40 mm", natural_frequency = "200 Hz", damping_ratio = 0.05, {stop}{} = {limit} }}]
"#,
        kind.key()
    )
}

/// A part with a limit of every kind is drawn as well, each counted for itself.
#[test]
fn a_part_may_have_every_kind() {
    let mut file = read(&product(LimitKind::DamageBoundary, 10.0));
    for kind in LimitKind::ALL {
        let of_kind = read(&product(kind, 10.0)).components.remove(0);
        let (limits, all) = (of_kind.limits, file.components[0].limits);
        // Out of reach, where they change nothing else.
        let gap_m = Spread::value(0.03).unwrap();
        file.components[0].stops = of_kind.stops.map(|stops| Stops { gap_m, ..stops });
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
            let assessment = clatter_assess::assess(&file).expect("an assessment");
            let limit = &assessment.components[0].limits[0];
            assert_eq!((limit.limit, limit.verdict), (kind, expected), "{limit:?}");
            let portrait = &clatter_assess::portraits(&file, &assessment)[0];
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

/// The closed form of the largest shock is that of the train that is followed strike by strike: of velocity and of turning, off center,
/// with either end first.
#[test]
fn the_largest_shock_is_the_largest_of_the_train() {
    for (first, e) in [(End::A, 0.1), (End::B, 0.1), (End::A, 0.4), (End::B, 0.4)] {
        let drop = Drop {
            direction_rad: Drop::towards(first),
            gravity_m_s2: 0.0,
            ..Drop::new(Body::off_center(0.09, 0.06, 0.045).expect("a body"), 3.0, 0.02, e)
        };
        for kind in [LimitKind::VelocityChange, LimitKind::AngularVelocityChange] {
            let of =
                |model| answer(&drop, &Part::new(-0.05, None), &Limit::new(kind, 1.0), model, 0.01).expect("an answer");
            let [form, train] = [Model::LargestShock, Model::Map].map(|model| of(model).value);
            assert!((form / train - 1.0).abs() < 1e-9, "{first:?}, e = {e}, {kind:?}: {form}, not {train}");
        }
    }
}

/// Damage needs both: a shock uses up as much of a damage boundary as of the limit that it uses less of, and is told in its unit.
#[test]
fn a_damage_boundary_is_used_up_by_the_lesser_share() {
    let drop = Drop {
        gravity_m_s2: 0.0,
        contact_time_s: Some(2e-4),
        ..Drop::new(Body::new(0.15, 0.045).expect("a body"), 3.0, 0.0, 0.3)
    };
    let of = |limit: &Limit| answer(&drop, &Part::new(0.0, None), limit, Model::Compliant, 0.01).expect("an answer");
    for (change, acceleration, unit) in [(1.0, 1e5, Unit::MeterPerSecondSquared), (10.0, 1e3, Unit::MeterPerSecond)] {
        let each = [(LimitKind::VelocityChange, change), (LimitKind::Acceleration, acceleration)];
        let [by_change, by_acceleration] = each.map(|(kind, allowed)| of(&Limit::new(kind, allowed)).utilization());
        let boundary =
            Limit { critical_acceleration_m_s2: acceleration, ..Limit::new(LimitKind::DamageBoundary, change) };
        let found = of(&boundary);
        let least = by_change.min(by_acceleration);
        assert!((found.utilization() / least - 1.0).abs() < 1e-9, "{found:?}: {by_change}, {by_acceleration}");
        assert_eq!(found.unit, unit);
        // It is off by as much as the limit whose unit it is told in.
        let of_kind = if unit == Unit::MeterPerSecond { each[0] } else { each[1] };
        let alone = of(&Limit::new(of_kind.0, of_kind.1));
        assert!(alone.off_by > 0.0 && (found.off_by / alone.off_by - 1.0).abs() < 1e-9, "{found:?}, not {alone:?}");
    }
}

/// Where a drop and those next to it use up the two limits of a damage boundary about alike, the one by its change of velocity and the other
/// by its acceleration, shares are compared and not a velocity with an acceleration.
#[test]
fn a_damage_boundary_is_as_exact_as_its_shares() {
    let laptop = read(include_str!("../../../reports/examples/laptop.toml")).product;
    assert!(laptop.body.is_wide(), "a plate");
    let drop = Drop {
        direction_rad: 84.98_f64.to_radians(),
        contact_time_s: Some(1e-3),
        ..Drop::new(laptop.body, 3.861, 7.01_f64.to_radians(), 0.35)
    };
    let part = Part::at(Place::flat([0.0165, 0.104]), None);
    let ask = |limit: &Limit| answer(&drop, &part, limit, Model::Compliant, 0.01).expect("an answer");
    let [change, acceleration] =
        [LimitKind::VelocityChange, LimitKind::Acceleration].map(|kind| ask(&Limit::new(kind, 1.0)));
    assert!(change.impact > 2, "{change:?}");
    let boundary = Limit {
        critical_acceleration_m_s2: acceleration.value / 3.0,
        ..Limit::new(LimitKind::DamageBoundary, change.value / 3.0)
    };
    let asked = ask(&boundary);
    assert!((asked.utilization() - 3.0).abs() < 1e-9 && asked.error() < 0.05, "{asked:?}");
}

/// A quality factor from 5 to 10 is a damping ratio from 1/20 to 1/10.
#[test]
fn quality_factors_are_damping_ratios_from_the_least() {
    let quality = Damping::Quality(Spread::new(5.0, 10.0, Law::Range).unwrap());
    let given = [10.0, 5.0].map(|given| quality.ratio(given).unwrap().get());
    for (found, want) in quality.ratios().into_iter().chain(given).zip([0.05, 0.1, 0.05, 0.1]) {
        assert!((found - want).abs() < 1e-15, "{found}, not {want}");
    }
}

/// What a part forgets between two strikes, ζ ω Δt, is its damping ratio times ω τ over τ/Δt.
#[test]
fn the_groups_of_a_drop_belong_together() {
    let drop = Drop {
        gravity_m_s2: 9.81,
        contact_time_s: Some(2e-4),
        ..Drop::new(Body::new(0.15, 0.045).expect("a body"), 3.0, 0.05, 0.3)
    };
    let ratio = DampingRatio::new(0.07).expect("a ratio");
    let part = Part::new(0.0, Some(Suspension::from_hz(120.0, ratio).expect("a part")));
    let limit = Limit::new(LimitKind::RattleSpace, 1e-3);
    let Groups { overlap, pulse, damping, .. } = Ladder::measure(&drop, &part, &limit, 0.05).expect("a ladder").groups;
    let (overlap, pulse, damping) = (overlap.expect("a time"), pulse.expect("a part"), damping.expect("a part"));
    assert!((pulse - 120.0 * std::f64::consts::TAU * 2e-4).abs() < 1e-12, "{pulse}");
    assert!((damping - 0.07 * pulse / overlap).abs() < 1e-12, "{damping}");
}
