//! The trade between speed and accuracy: errors that must fall, fronts, and how many strikes are worth keeping.

use clatter::End;
use clatter::flight::{Body, Scene};
use clatter_scene::plan::{BarRung, ComponentRung, Pair, Quantity, Setup};
use clatter_scene::tradeoff::{TOLERANCES, Tradeoff, bar, bars};
use clatter_scene::{EXAMPLE, LimitKind, ProductFile};
use clatter_shock::{DampingRatio, Suspension};

/// A bar of evenly spread mass, 140 mm long, and a part of 200 Hz at its end b.
fn setup(e: f64, speed_m_s: f64, tilt_deg: f64, contact_s: Option<f64>) -> Setup {
    of_inertia(0.5, e, speed_m_s, tilt_deg, contact_s)
}

/// The same with another inertia ratio.
fn of_inertia(q: f64, e: f64, speed_m_s: f64, tilt_deg: f64, contact_s: Option<f64>) -> Setup {
    let body = Body::new(0.14, 0.07 * ((1.0 - q) / (1.0 + q)).sqrt()).expect("a bar");
    let scene = Scene::new(body, e, speed_m_s, tilt_deg, 9.81).expect("a drop");
    let part = Suspension::from_hz(200.0, DampingRatio::new(0.05).expect("a damping ratio")).expect("a part");
    Setup::new(scene, contact_s, 1.0, part).expect("a setup")
}

fn measure(setup: &Setup, quantity: Quantity) -> Tradeoff {
    Tradeoff::measure(setup, quantity).expect("a scene that the models take")
}

fn error(trade: &Tradeoff, bar: BarRung, component: ComponentRung) -> f64 {
    trade.pairs.iter().find(|p| p.pair() == Pair { bar, component }).expect("a pair that says something").error
}

/// Slow and steep, so that gravity and lever arms count, with contacts of a microsecond, which do not. (At q = 1/2 the
/// lever arm of the first strike does to end b as much by turning as by lifting, in opposite directions; at q = 0.2 it
/// does not.)
#[test]
fn errors_fall_along_the_ladder_of_the_bar() {
    let trade = measure(&of_inertia(0.2, 0.3, 1.0, 12.0, Some(1e-6)), Quantity::VelocityShock);
    let of = |bar| error(&trade, bar, ComponentRung::LargestShock);
    let rungs = BarRung::ALL.map(of);
    // The closed form is the map.
    assert!((rungs[0] - rungs[1]).abs() < 1e-12, "{rungs:?}");
    assert!(rungs[1] > 2.0 * rungs[2] && rungs[2] > 10.0 * rungs[3] && rungs[3] > rungs[4], "{rungs:?}");
    // A lone contact of a microsecond does what an impulse does, but for the weight that the ground carries meanwhile,
    // g τ = 1e-5 m/s.
    assert!(rungs[3] < 1e-4 && rungs[4] < 1e-4, "{rungs:?}");
}

/// Pulses of ωτ = 1.3 are no impulses, and one shock is no train.
#[test]
fn errors_fall_along_the_ladder_of_the_component() {
    let trade = measure(&setup(0.3, 4.43, 8.0, Some(1e-3)), Quantity::PeakAcceleration);
    let of = |component| error(&trade, BarRung::FiniteTilt, component);
    let [net, largest, impulses, pulses] = ComponentRung::ALL.map(of);
    assert!(net > largest && largest > impulses && impulses > 1.5 * pulses, "{net} {largest} {impulses} {pulses}");
}

#[test]
fn the_reference_is_the_highest_rung_there_is() {
    let trade = measure(&setup(0.3, 4.43, 5.0, Some(2e-4)), Quantity::PeakAcceleration);
    assert_eq!((trade.reference.bar, trade.reference.component), (BarRung::Compliant, ComponentRung::PulseTrain));
    assert!(trade.reference.lacks.is_none());
    // 16 times as many pieces of area in the reference: it is known better than the models are stated to be, 2e-4.
    let highest = error(&trade, BarRung::Compliant, ComponentRung::PulseTrain);
    assert!(trade.reference.within < 1e-5 && highest < 2e-4, "{} {highest}", trade.reference.within);
    // No contact time, and no fit of the contact below e = 0.01.
    for (e, contact_s, component, why) in [
        (0.3, None, ComponentRung::ImpulseTrain, "contact time"),
        (0.0, Some(2e-4), ComponentRung::PulseTrain, "restitution e = 0.0"),
    ] {
        let trade = measure(&setup(e, 4.43, 5.0, contact_s), Quantity::RattleSpace);
        assert_eq!((trade.reference.bar, trade.reference.component), (BarRung::FiniteTilt, component));
        assert!(trade.reference.lacks.as_ref().is_some_and(|said| said.contains(why)), "{:?}", trade.reference.lacks);
        assert!(trade.pairs.iter().all(|p| p.bar < BarRung::Compliant && p.component <= component));
        // Nothing is finer about it but the pieces of pulses.
        let own = error(&trade, BarRung::FiniteTilt, component);
        assert!(own <= if contact_s.is_some() { 2e-4 } else { 0.0 }, "{own}");
    }
}

/// What loses nothing never rests.
#[test]
fn a_reference_that_is_cut_says_so() {
    for (e, cut) in [(0.3, false), (1.0, true)] {
        let trade = measure(&setup(e, 4.43, 5.0, None), Quantity::PeakAcceleration);
        assert_eq!((trade.reference.cut, trade.reference.strikes == 2000), (cut, cut), "{:?}", trade.reference);
    }
}

#[test]
fn fronts_are_fronts_and_choices_are_among_the_pairs() {
    for bar in &bars().expect("the bars of Table 1") {
        let trade = measure(bar, Quantity::PeakAcceleration);
        assert_eq!(trade.pairs.len(), 18);
        let known = |error: f64| error.max(trade.reference.within);
        for p in &trade.pairs {
            assert!(p.seconds > 0.0 && p.seconds.is_finite(), "{p:?}");
            let better = trade.pairs.iter().any(|o| {
                o.seconds <= p.seconds
                    && known(o.error) <= known(p.error)
                    && (o.seconds < p.seconds || known(o.error) < known(p.error))
            });
            assert_eq!(p.front, !better, "{p:?}");
        }
        let cheapest = trade.pairs.iter().min_by(|a, b| a.seconds.total_cmp(&b.seconds)).expect("pairs");
        let closest = trade.pairs.iter().min_by(|a, b| a.error.total_cmp(&b.error)).expect("pairs");
        assert!(cheapest.front && closest.front, "{:?}", trade.pairs);
        for (choice, tolerance) in trade.choices.iter().zip(TOLERANCES) {
            assert!(choice.tolerance.to_bits() == tolerance.to_bits() && !choice.reason.is_empty());
            let chosen: Vec<_> = trade.pairs.iter().filter(|p| p.chosen_at.contains(&tolerance)).collect();
            assert_eq!(chosen.len(), 1, "one pair at {tolerance}");
            assert_eq!((chosen[0].bar, chosen[0].component), (choice.bar, choice.component));
            // The plan's promise, on scenes without a warning.
            assert!(choice.warning.is_none() && choice.error <= tolerance, "{choice:?}");
        }
    }
}

/// Times differ from run to run, nothing else does.
#[test]
fn errors_are_the_same_from_run_to_run() {
    let [_, bar, ..] = bars().expect("the bars of Table 1");
    let [a, b] = [(), ()].map(|()| measure(&bar, Quantity::RattleSpace));
    for (a, b) in a.pairs.iter().zip(&b.pairs) {
        assert_eq!((a.value.to_bits(), a.error.to_bits()), (b.value.to_bits(), b.error.to_bits()), "{a:?}");
        assert_eq!((a.estimate.to_bits(), a.strikes, a.pieces), (b.estimate.to_bits(), b.strikes, b.pieces), "{a:?}");
    }
    assert_eq!((a.reference.value.to_bits(), a.kept), (b.reference.value.to_bits(), b.kept));
}

/// At end b of q = 1/2, e = 0.3 (T = 0.65), strikes in v0: −q(1 + e) from the first, (1 + e)(1 + T) from the second,
/// all others less.
#[test]
fn strikes_worth_keeping_by_hand() {
    let trade = measure(&setup(0.3, 4.43, 5.0, None), Quantity::VelocityShock);
    let [map, tilted] = &trade.kept[..] else { panic!("{:?}", trade.kept) };
    assert_eq!((map.bar, tilted.bar), (BarRung::Map, BarRung::FiniteTilt));
    assert!((map.errors[0] - (1.0 - 0.5 / 1.65)).abs() < 1e-12, "{map:?}");
    assert!(map.errors[1..].iter().all(|error| *error < 1e-15), "{map:?}");
    assert_eq!((map.strikes, map.stop, &map.least[..]), (4, "bounced-clear", &[Some(2); 3][..]));
    // Gravity brings it back until it rests.
    assert!(tilted.strikes > 100 && tilted.stop == "at-rest" && tilted.least == map.least, "{tilted:?}");
}

/// q = 0.9, e = 0.3: the map never ends, and each strike is λ₊ = (T + √(T² − 4e))/2, T = 1.17, of the one before in the
/// end.
#[test]
fn an_endless_train_is_worth_a_few_strikes() {
    let gyration_m = 0.07 * (0.1_f64 / 1.9).sqrt();
    let scene = Scene::new(Body::new(0.14, gyration_m).expect("a bar"), 0.3, 4.43, 5.0, 0.0).expect("a drop");
    // So soft that it sees the sum of all shocks: what is left out of it falls by λ₊ a strike.
    let soft = Suspension::from_hz(0.01, DampingRatio::new(0.0).expect("none")).expect("a part");
    let setup = Setup::new(scene, None, 0.0, soft).expect("a setup");
    let trade = measure(&setup, Quantity::RattleSpace);
    let map = &trade.kept[0];
    let root = 0.5 * (1.17 + (1.17_f64 * 1.17 - 1.2).sqrt());
    for n in 20..map.errors.len().min(40) {
        let ratio = map.errors[n] / map.errors[n - 1];
        assert!((ratio - root).abs() < 2e-3, "strike {n}: {ratio}, not {root}");
    }
    let least: Vec<usize> = map.least.iter().map(|n| n.expect("few enough")).collect();
    // ln 10/ln(1/λ₊) more for each digit.
    let more = 10.0_f64.ln() / -root.ln();
    for pair in least.windows(2) {
        let strikes = f64::from(u32::try_from(pair[1] - pair[0]).expect("a few"));
        assert!((strikes - more).abs() <= 1.5, "{least:?}, {more} for each digit");
    }
    assert!(map.errors.last().is_some_and(|e| *e <= 1e-6) && map.errors.len() < map.strikes, "{map:?}");
}

#[test]
fn parts_without_a_quantity_are_left_out_by_name() {
    let file = ProductFile::read(EXAMPLE, "example.toml").expect("the example");
    let answer = file.tradeoff(&file.assess().expect("assessed")).expect("measured");
    let left: Vec<_> = answer.left_out.iter().map(|left| (left.component.as_str(), left.limit)).collect();
    assert_eq!(left, [("camera", LimitKind::AngularVelocityChange)]);
    let asked: Vec<_> = answer.trades.iter().map(|t| (t.component.as_str(), t.limit, t.trade.quantity)).collect();
    let wanted = [
        ("display", LimitKind::Acceleration, Quantity::PeakAcceleration),
        ("display", LimitKind::RattleSpace, Quantity::RattleSpace),
        ("camera", LimitKind::Acceleration, Quantity::PeakAcceleration),
        ("crystal", LimitKind::DamageBoundary, Quantity::VelocityShock),
    ];
    assert_eq!(asked, wanted);
    assert!(!answer.machine.processor.is_empty() && answer.machine.processors >= 1);
}

/// The scene is the worst drop of the assessment, turned so that the end that touches first is end a.
#[test]
fn a_part_is_dropped_as_the_assessment_found_worst() {
    let file = ProductFile::read(EXAMPLE, "example.toml").expect("the example");
    let assessment = file.assess().expect("assessed");
    let answer = file.tradeoff(&assessment).expect("measured");
    let mut ends = Vec::new();
    for part in &answer.trades {
        let assessed = assessment.components.iter().find(|c| c.name == part.component).expect("assessed");
        let limit = assessed.limits.iter().find(|l| l.limit == part.limit).expect("of this limit");
        let (worst, scene) = (&assessed.worst_case, &part.trade.scene);
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs();
        assert!(same(scene.tilt_deg, worst.tilt_deg) && same(scene.speed_m_s, worst.speed_m_s), "{scene:?}");
        assert!(same(scene.restitution, worst.restitution) && part.first == worst.first, "{scene:?}");
        let s = limit.worst_case.position_m / 0.07;
        assert!(same(scene.position, if part.first == End::A { s } else { -s }), "{scene:?} {s}");
        match (scene.frequency_hz, limit.worst_case.frequency_hz) {
            (Some(of_scene), Some(of_limit)) => assert!(same(of_scene, of_limit), "{scene:?}"),
            (of_scene, of_limit) => assert_eq!(of_scene, of_limit),
        }
        ends.push(part.first);
        // What the reference says of the tightest limit is about what the assessment found, by models of its own.
        if limit.limit == assessed.tightest().limit && part.limit != LimitKind::DamageBoundary {
            let ratio = part.trade.reference.value / limit.attained;
            assert!((ratio - 1.0).abs() < 0.05, "{}: {ratio}", part.component);
        }
    }
    assert!(ends.contains(&End::A) && ends.contains(&End::B), "both ways around: {ends:?}");
}

#[test]
fn what_is_no_bar_is_refused_with_its_value() {
    for (q, e, said) in [(0.5, 1.5, "1.5"), (-1.0, 0.3, "inf"), (1.1, 0.3, "NaN"), (f64::NAN, 0.3, "NaN")] {
        let text = bar(q, e).expect_err("no bar").to_string();
        assert!(text.contains(said), "q = {q}, e = {e}: {text}");
    }
}
