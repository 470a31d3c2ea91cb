//! Changes that make a part safe: each one put into the file as it is printed and assessed again, against closed forms and
//! against scans of what is nearer.

use clatter_assess::{
    Accuracy, ComponentAssessment, Verdict,
    design::{Bounds, Change, Lever, Outcome, Remedies, Together},
};
use clatter_product::{Damping, EXAMPLE, Law, LimitKind, Model, Mount, ProductFile, Spread};

/// A number without the digits that a conversion adds.
fn neat(x: f64) -> f64 {
    format!("{x:.12e}").parse().expect("a number")
}

/// The step of two digits of a size.
fn step(size: f64) -> f64 {
    10_f64.powf(size.abs().log10().floor() - 1.0)
}

/// Whether it is so many steps, but for roundings.
fn is_multiple(x: f64, step: f64) -> bool {
    (x / step - (x / step).round()).abs() < 1e-6
}

/// A product with one part, as lines of its file.
#[derive(Clone)]
struct Text {
    length_mm: f64,
    center_mm: f64,
    gyration: String,
    restitution: String,
    contact: String,
    drop: &'static str,
    position: String,
    extent_mm: f64,
    /// Frequency and damping of a suspended part.
    mount: Option<[String; 2]>,
    limits: String,
}

impl Text {
    fn read(&self) -> ProductFile {
        let mount = match &self.mount {
            Some([frequency, damping]) => format!("natural_frequency = {frequency}\ndamping_ratio = {damping}"),
            None => "mount = \"hard\"".to_owned(),
        };
        let text = format!(
            "[product]\nname = \"test\"\nlength = \"{} mm\"\ncenter_of_mass = \"{} mm\"\nradius_of_gyration = {}\n\
             restitution = {}\n{}\n[drop]\n{}\n[[component]]\nname = \"part\"\nposition = {}\nextent = \"{} mm\"\n{mount}\n{}\n",
            self.length_mm,
            self.center_mm,
            self.gyration,
            self.restitution,
            self.contact,
            self.drop,
            self.position,
            self.extent_mm,
            self.limits,
        );
        ProductFile::read(&text, "test.toml").unwrap_or_else(|faults| panic!("{faults}\n{text}"))
    }
    /// With a change as it is printed, in mm, ms, gn and Hz; of an inertia ratio the radius of gyration.
    fn with(&self, change: &Change) -> Self {
        let list = |[lo, hi]: [f64; 2], unit: &str| {
            let [lo, hi] = [lo, hi].map(|x| format!("\"{}{unit}\"", neat(x)));
            if lo == hi { lo } else { format!("[{lo}, {hi}]") }
        };
        let mut text = self.clone();
        match (change.lever, &mut text.mount) {
            (Lever::InertiaRatio, _) => {
                let product = self.read().product.with_inertia_ratio(change.to[0]).expect("a ratio");
                text.gyration = list([1e3 * product.body.gyration_m(); 2], " mm");
            }
            (Lever::Restitution, _) => text.restitution = list(change.to, "").replace('"', ""),
            (Lever::Position, _) => text.position = list(change.to.map(|x| 1e3 * x), " mm"),
            (Lever::Frequency, Some([frequency, _])) => *frequency = list(change.to, " Hz"),
            (Lever::Damping, Some([_, damping])) => *damping = list(change.to, "").replace('"', ""),
            (Lever::ContactTime, _) => {
                let law = text.contact.find("\ncontact_law").map_or("", |at| &text.contact[at..]);
                text.contact = format!("contact_time = {}{law}", list(change.to.map(|s| 1e3 * s), " ms"));
            }
            (Lever::Limit(kind), _) => {
                let (key, to) = match kind {
                    LimitKind::Acceleration => ("acceleration_limit", list(change.to.map(|a| a / 9.806_65), " gn")),
                    LimitKind::RattleSpace => ("rattle_space", list(change.to.map(|x| 1e3 * x), " mm")),
                    LimitKind::VelocityChange => ("velocity_change_limit", list(change.to, " m/s")),
                    kind => panic!("no part has the limit {kind:?}"),
                };
                let other = |line: &&str| !line.starts_with(key);
                let lines: Vec<_> = self.limits.lines().filter(other).map(str::to_owned).collect();
                text.limits = [lines, vec![format!("{key} = {to}")]].concat().join("\n");
            }
            (lever, _) => panic!("{lever:?} of a bar, or of a part that is mounted rigidly"),
        }
        text
    }
    fn remedies(&self, bounds: &Bounds, margin: f64) -> Remedies {
        let file = self.read();
        let assessment = clatter_assess::assess(&file).expect("an assessment");
        let mut remedies = clatter_assess::remedies(&file, &assessment, bounds, margin).expect("remedies");
        assert_eq!(remedies.len(), 1, "{assessment:?}");
        remedies.remove(0)
    }
    fn assessed(&self, accuracy: &Accuracy) -> ComponentAssessment {
        clatter_assess::assess_to(&self.read(), accuracy).expect("an assessment").components.remove(0)
    }
    /// The part, assessed in the file with these changes, is what is told of it.
    fn is_told(&self, changes: &[Change], after: &ComponentAssessment, accuracy: &Accuracy) -> ComponentAssessment {
        let again = changes.iter().fold(self.clone(), |text, change| text.with(change)).assessed(accuracy);
        let file = self.read();
        let (now, told) = (clatter_assess::least_margin(&file, &again), clatter_assess::least_margin(&file, after));
        // The same drops, of a file that has been written and read: but for roundings the same answers.
        assert!((now - told).abs() < 1e-9, "{changes:?}: {now}, told {told}");
        assert_eq!(again.verdict, after.verdict, "{changes:?}");
        again
    }
}

/// Parts that fail, by contacts of both laws and by instant impacts, hard and suspended, in the middle and off it.
fn failing() -> [Text; 5] {
    let text = |s: &str| s.to_owned();
    let panel = Text {
        length_mm: 300.0,
        center_mm: 0.0,
        gyration: text("\"90 mm\""),
        restitution: text("[0.25, 0.4]"),
        contact: String::new(),
        drop: "height = \"0.8 m\"\ntilt = [\"0.5 deg\", \"1.5 deg\"]",
        position: text("\"20 mm\""),
        extent_mm: 20.0,
        mount: None,
        limits: text("velocity_change_limit = \"3.2 m/s\""),
    };
    let drive = Text {
        position: text("\"60 mm\""),
        extent_mm: 0.0,
        mount: Some([text("\"40 Hz\""), text("0.1")]),
        limits: text("acceleration_limit = \"100 gn\""),
        ..panel.clone()
    };
    let board = Text {
        length_mm: 150.0,
        center_mm: 6.0,
        gyration: text("\"41 mm\""),
        restitution: text("[0.3, 0.4]"),
        contact: text("contact_time = \"0.4 ms\""),
        drop: "height = [\"0.8 m\", \"1.2 m\"]\ntilt = [\"0.5 deg\", \"10 deg\"]",
        position: text("[\"13 mm\", \"17 mm\"]"),
        extent_mm: 50.0,
        mount: Some([text("[\"200 Hz\", \"240 Hz\"]"), text("0.05")]),
        limits: text("acceleration_limit = \"1100 gn\"\nrattle_space = \"12 mm\""),
    };
    let stiff = Text {
        center_mm: -10.0,
        contact: text("contact_time = [\"0.8 ms\", \"1 ms\"]\ncontact_law = \"dashpot\""),
        drop: "speed = \"4 m/s\"\ntilt = \"3 deg\"\nfirst = \"a\"",
        position: text("\"50 mm\""),
        mount: Some([text("[\"900 Hz\", \"1100 Hz\"]"), text("[0.1, 0.2]")]),
        limits: text("acceleration_limit = \"900 gn\""),
        ..board.clone()
    };
    let hard = Text {
        contact: text("contact_time = \"0.4 ms\"\ncontact_law = \"hysteretic\""),
        mount: None,
        limits: text("acceleration_limit = \"900 gn\""),
        ..board.clone()
    };
    [panel, drive, board, stiff, hard]
}

/// Every remedy, put into the file to the digits that are printed, is safe with the margin; two together where none alone is,
/// and else it is told how near one gets.
#[test]
fn remedies_put_into_the_file_have_the_margin() {
    let (mut alone, mut pairs, mut nearest) = (0, 0, 0);
    let tight = Bounds {
        q: [0.3, 0.6],
        e: [0.25, 0.45],
        frequency_factor: 1.2,
        damping: [0.05, 0.12],
        contact_time_s: [0.3e-3, 0.5e-3],
        limit_factor: 1.1,
    };
    for text in failing() {
        for (bounds, margin) in [(Bounds::default(), 0.2), (tight, 0.1), (tight, 0.6)] {
            let remedies = text.remedies(&bounds, margin);
            let has = |changes: &[Change], after: &ComponentAssessment| {
                let again = text.is_told(changes, after, &Accuracy::default());
                assert_eq!(again.verdict, Verdict::Safe, "{changes:?}");
                let left = clatter_assess::least_margin(&text.read(), &again);
                assert!(left >= margin, "{changes:?}: {left} of {margin}");
            };
            let mut found = 0;
            for remedy in &remedies.levers {
                if let Outcome::Change { change, after } = &remedy.outcome {
                    has(&[*change], after);
                    can_be_specified(&text, change);
                    found += 1;
                }
            }
            alone += found;
            if let Some(Together { changes, after }) = &remedies.pair {
                assert!(found == 0 && changes.len() == 2, "{remedies:?}");
                has(changes, after);
                pairs += 1;
            }
            if let Some(Together { changes, after }) = &remedies.nearest {
                assert!(found == 0 && remedies.pair.is_none());
                let again = text.is_told(changes, after, &Accuracy::default());
                assert!(
                    again.verdict != Verdict::Safe || clatter_assess::least_margin(&text.read(), &again) < margin,
                    "{again:?}"
                );
                nearest += 1;
            }
            assert!(found > 0 || remedies.pair.is_some() || remedies.nearest.is_some(), "{remedies:?}");
        }
    }
    assert!(alone >= 8 && pairs > 0 && nearest > 0, "{alone} {pairs} {nearest}");
}

/// Two digits, places and radii to 1 mm of 150 mm and 300 mm, no mass outside of the body; a range covers the one that was moved.
fn can_be_specified(text: &Text, change: &Change) {
    let file = text.read();
    let (size, unit) = match change.lever {
        Lever::InertiaRatio => {
            let body = file.product.with_inertia_ratio(change.to[0]).expect("a ratio").body;
            let [a, b] = body.arms_m();
            assert!(body.gyration_m().powi(2) <= a * b * (1.0 + 1e-12), "{change:?}: mass outside of the body");
            assert!(is_multiple(1e3 * body.gyration_m(), 1.0), "{change:?}: {} m", body.gyration_m());
            return;
        }
        Lever::Position | Lever::Across => (Some(10.0), 1e3),
        Lever::ContactTime | Lever::StopGap | Lever::StopTime | Lever::Limit(LimitKind::RattleSpace) => (None, 1e3),
        Lever::Limit(LimitKind::Acceleration) => (None, 1.0 / 9.806_65),
        Lever::Limit(
            LimitKind::VelocityChange
            | LimitKind::AngularVelocityChange
            | LimitKind::DamageBoundary
            | LimitKind::StopSpeed,
        )
        | Lever::Restitution
        | Lever::Frequency
        | Lever::Damping => (None, 1.0),
    };
    for to in change.to.map(|x| unit * x).into_iter().filter(|to| *to != 0.0) {
        assert!(is_multiple(to, step(size.unwrap_or(to))), "{change:?}: {to}");
    }
    let (from, to) = (change.from[1] / change.from[0], change.to[1] / change.to[0]);
    match change.lever {
        Lever::Frequency | Lever::ContactTime => assert!(to >= from * (1.0 - 1e-9), "{change:?} is narrower"),
        _ => {}
    }
}

/// Levers on limits and on a bumper: what a part has to stand is its demand and what the search may miss, with a margin of 0; a bumper
/// for a hard part halves the largest acceleration where it takes twice as long.
#[test]
fn a_stronger_part_more_room_and_a_bumper_are_changes() {
    let [panel, _, board, _, hard] = failing();
    for (text, kind) in [(&panel, LimitKind::VelocityChange), (&hard, LimitKind::Acceleration)] {
        let before = text.assessed(&Accuracy::default()).limits.remove(0);
        let remedies = text.remedies(&Bounds::default(), 0.0);
        let remedy = remedies.levers.iter().find(|remedy| remedy.lever == Lever::Limit(kind)).expect("its limit");
        let Outcome::Change { change, .. } = &remedy.outcome else { panic!("{remedy:?}") };
        let searched = before.demand.unwrap() * (1.0 + before.uncertainty);
        let needed = before.bound.map_or(searched, |bound| bound.min(searched));
        let unit = if kind == LimitKind::Acceleration { 9.806_65 } else { 1.0 };
        let most = needed + step(needed / unit) * unit;
        // A hair: a range of drops is not searched alike where its limit is another.
        assert!(change.to[0] > 0.995 * needed && change.to[0] < 1.005 * most, "{change:?}, needed {needed}");
    }
    let remedies = hard.remedies(&Bounds::default(), 0.0);
    let bumper = remedies.levers.iter().find(|remedy| remedy.lever == Lever::ContactTime).expect("contacts");
    let Outcome::Change { change, after } = &bumper.outcome else { panic!("{bumper:?}") };
    let before = hard.assessed(&Accuracy::default()).limits.remove(0).demand;
    let (longer, less) = (change.to[0] / change.from[0], after.limits[0].demand.unwrap() / before.unwrap());
    assert!(longer > 1.0 && (0.8..1.25).contains(&(longer * less)), "{longer} times as long, {less} of the demand");
    // More room alone: with twice the acceleration limit, and a rattle space that is too small.
    let limits = "acceleration_limit = \"2200 gn\"\nrattle_space = \"5 mm\"".to_owned();
    let rattling = Text { limits, ..board };
    let remedies = rattling.remedies(&Bounds::default(), 0.0);
    let room = remedies.levers.iter().find(|remedy| remedy.lever == Lever::Limit(LimitKind::RattleSpace));
    let Outcome::Change { change, after } = &room.expect("its room").outcome else { panic!("{room:?}") };
    assert!(change.to[0] > change.from[0] && after.verdict == Verdict::Safe, "{room:?}");
}

/// Where bounds ask for mass outside of the body, it stays inside.
#[test]
fn no_mass_is_put_outside_of_the_body() {
    let [_, drive, board, ..] = failing();
    for text in [drive, board] {
        let bounds = Bounds { q: [-0.9, 0.9], ..Bounds::default() };
        for remedy in &text.remedies(&bounds, 0.3).levers {
            match &remedy.outcome {
                Outcome::Change { change, .. } => can_be_specified(&text, change),
                Outcome::Nowhere { bounds: [lo, _] } if remedy.lever == Lever::InertiaRatio => {
                    assert!(*lo >= 0.0, "{remedy:?}");
                }
                _ => {}
            }
        }
    }
}

/// Velocity shocks of a hard part without gravity have a closed form: with the change they leave the room that a verdict asks
/// for, 2 % for what the search may miss and what the model with the most physics says more, and with a step less they do not.
#[test]
fn the_smallest_changes_of_a_hard_part_are_those_of_the_closed_form() {
    let [panel, ..] = failing();
    let accuracy = Accuracy { model: Some(Model::Map), merge_s: 1e-12, ..Accuracy::default() };
    let (file, bounds) = (panel.read(), Bounds::default());
    let v0 = file.drop.speeds_m_s()[1];
    let demand = |q: f64, e: f64, place_mm: f64| {
        let bar = clatter::Bar::new(q, e).expect("a bar");
        v0 * bar.shocks_either(&clatter::Start::default()).at(((place_mm.abs() + 10.0) / 150.0).min(1.0))
    };
    let assessment = clatter_assess::assess_to(&file, &accuracy).expect("an assessment");
    let remedies = clatter_assess::remedies(&file, &assessment, &bounds, 0.0).expect("remedies").remove(0);
    for remedy in &remedies.levers {
        let [q, e] = [file.product.inertia_ratio(), 0.4];
        let (change, after) = match (&remedy.outcome, remedy.lever) {
            (_, Lever::Limit(_)) => continue,
            (Outcome::Change { change, after }, _) => (change, after),
            (Outcome::Nowhere { bounds: [lo, hi] }, Lever::InertiaRatio) => {
                let least = (0..=48).map(|k| demand(lo + f64::from(k) / 48.0 * (hi - lo), e, 20.0)).reduce(f64::min);
                assert!(least.expect("some") * 1.02 > 3.2, "{least:?}");
                continue;
            }
            (outcome, lever) => {
                assert!(matches!(lever, Lever::Frequency | Lever::Damping), "{remedy:?}");
                assert_eq!(*outcome, Outcome::NoEffect);
                continue;
            }
        };
        // So many steps of two digits, or of 1 mm, short of the change, by its high end: that of e is the worse one.
        let step = if remedy.lever == Lever::Position { 1e-3 } else { 1e-2 };
        let short_by = |steps: f64| {
            let back = (change.from[1] - change.to[1]).signum() * step * steps;
            let x = change.to[1] + back;
            match remedy.lever {
                Lever::InertiaRatio => demand(x, e, 20.0),
                Lever::Restitution => demand(q, x, 20.0),
                _ => demand(q, e, 1e3 * x),
            }
        };
        let limit = &after.limits[0];
        assert!((limit.demand.unwrap() / short_by(0.0) - 1.0).abs() < 1e-9, "{remedy:?}: {}", short_by(0.0));
        let room = 1.0 + limit.uncertainty;
        assert!((1.02..1.03).contains(&room), "{remedy:?}");
        let short = short_by(1.0) * room;
        assert!(short_by(0.0) * room <= 3.2 && short > 3.2, "{remedy:?}: {short}");
        let wide = change.to.map(|x| x - change.to[0])[1] - (change.from[1] - change.from[0]);
        assert!(
            (-1e-9..2.0 * step).contains(&wide),
            "a range moves as a whole, and widens by roundings alone: {change:?}"
        );
    }
}

/// Values short of the change do not do: at a dozen of them all the way, some between the steps of the search.
#[test]
fn no_smaller_change_is_enough() {
    let [_, drive, board, ..] = failing();
    let margin = 0.1;
    let (mut scanned, accuracy) = (0, Accuracy::default());
    for text in [drive, board] {
        for remedy in &text.remedies(&Bounds::default(), margin).levers {
            let (change, ends) = match &remedy.outcome {
                // Up to two of the steps that it is rounded to.
                Outcome::Change { change, .. } => {
                    let back = match change.lever {
                        Lever::InertiaRatio => 0.05,
                        Lever::Position => 2e-3,
                        Lever::Limit(LimitKind::Acceleration) => 2.0 * 9.806_65 * step(change.to[0] / 9.806_65),
                        _ => 2.0 * step(change.to[1]),
                    };
                    (*change, 1.0 - back / (change.to[0] - change.from[0]).abs())
                }
                Outcome::Nowhere { bounds: [_, hi] }
                    if matches!(remedy.lever, Lever::Damping | Lever::InertiaRatio) =>
                {
                    let from = if remedy.lever == Lever::Damping { 0.05 } else { text.read().product.inertia_ratio() };
                    (Change { lever: remedy.lever, from: [from; 2], to: [*hi; 2] }, 1.0)
                }
                _ => continue,
            };
            for k in 1..=12 {
                let share = ends * f64::from(k) / 12.0;
                let to = std::array::from_fn(|n| change.from[n] + share * (change.to[n] - change.from[n]));
                let tried = text.with(&Change { to, ..change });
                let after = tried.assessed(&accuracy);
                let enough =
                    after.verdict == Verdict::Safe && clatter_assess::least_margin(&tried.read(), &after) >= margin;
                assert!(!enough, "{to:?} is short of {change:?}");
                scanned += 1;
            }
        }
    }
    assert!(scanned >= 48, "{scanned}");
}

/// Where the present value is beyond the bounds, all of them is looked at, from the bound next to it.
#[test]
fn changes_are_found_from_beyond_the_bounds() {
    let [_, drive, ..] = failing();
    let damped = |zeta: f64| Text { mount: Some(["\"40 Hz\"".to_owned(), format!("{zeta}")]), ..drive.clone() };
    // Too little damping and too much ask for more than some in between.
    let demand = |zeta| damped(zeta).assessed(&Accuracy::default()).limits[0].demand.unwrap() / 9.806_65;
    let [some, much] = [0.25, 0.5].map(demand);
    assert!(much > 1.1 * some, "{some} {much}");
    // So that 0.25 is enough and 0.5 is not.
    let margin = 100.0 / (0.5 * (some + much)) - 1.0;
    let limit_gn = format!("acceleration_limit = \"{} gn\"", if margin > 0.0 { 100 } else { 300 });
    let margin = if margin > 0.0 { margin } else { 3.0 * (1.0 + margin) - 1.0 };
    let damping = |zeta| {
        let text = Text { limits: limit_gn.clone(), ..damped(zeta) };
        let remedies = text.remedies(&Bounds::default(), margin);
        match &remedies.levers.iter().find(|remedy| remedy.lever == Lever::Damping).expect("the damping").outcome {
            Outcome::Change { change, .. } => change.to[0],
            other => panic!("{zeta}: {other:?}"),
        }
    };
    let (within, beyond) = (damping(0.5), damping(1.0));
    assert!((within - beyond).abs() < 0.011, "one step of two digits: {within} {beyond}");
}

/// What an assessment with a named model finds unsafe is made safe by that model.
#[test]
fn changes_are_of_the_model_that_was_asked_for() {
    let [_, drive, ..] = failing();
    let (file, accuracy) = (drive.read(), Accuracy { tolerance: 0.05, model: Some(Model::Map), ..Accuracy::default() });
    let assessment = clatter_assess::assess_to(&file, &accuracy).expect("an assessment");
    let remedies = clatter_assess::remedies(&file, &assessment, &Bounds::default(), 0.1).expect("remedies").remove(0);
    let mut changes = 0;
    for remedy in &remedies.levers {
        if let Outcome::Change { change, after } = &remedy.outcome {
            assert_eq!(after.model.bar, Model::Map);
            drive.is_told(&[*change], after, &accuracy);
            changes += 1;
        }
    }
    assert!(changes > 0, "{remedies:?}");
}

#[test]
fn an_inertia_ratio_gives_the_radius_of_gyration_that_has_it() {
    for arms in [[0.07, 0.07], [0.05, 0.09]] {
        let [panel, ..] = failing();
        let mut product = panel.read().product;
        product.body = clatter_flight::Body::off_center(arms[0], arms[1], 0.03).expect("a body");
        for q in [-0.9, -0.3, 0.0, 1e-9, 0.3, 0.5, 0.9, 0.999_999, 1.0] {
            let found = product.with_inertia_ratio(q).expect("a ratio").inertia_ratio();
            assert!((found - q).abs() < 1e-14, "{found}, not {q}, for arms {arms:?}");
        }
        assert!(product.with_inertia_ratio(-1.0).is_err() && product.with_inertia_ratio(f64::NAN).is_err());
    }
}

/// A range of contact times is multiplied as a whole: down to where its least is at the lower bound, up to where its most is at the upper.
#[test]
fn a_range_of_contact_times_stays_within_its_bounds() {
    let text = r#"
product = { name = "bar", length = "150 mm", radius_of_gyration = "43 mm", restitution = 0.3, contact_time = ["0.3 ms", "0.5 ms"], contact_law = "hysteretic" }
drop = { speed = "4 m/s", tilt = "3 deg" }
component = [{ name = "part", position = "30 mm", mount = "hard", velocity_change_limit = "0.1 m/s" }]
"#;
    let file = ProductFile::read(text, "bar.toml").unwrap_or_else(|faults| panic!("{faults}"));
    let remedies = clatter_assess::remedies(&file, &clatter_assess::assess(&file).unwrap(), &Bounds::default(), 0.1)
        .unwrap()
        .remove(0);
    let bumper = remedies.levers.iter().find(|remedy| remedy.lever == Lever::ContactTime).expect("contacts");
    let Outcome::Nowhere { bounds } = bumper.outcome else { panic!("{bumper:?}") };
    for (bound, want) in bounds.into_iter().zip([0.2e-3, 2e-3]) {
        assert!((bound / want - 1.0).abs() < 1e-9, "{bounds:?}");
    }
}

/// The product with a change of one of its parts.
fn changed(file: &ProductFile, part: usize, change: &Change) -> ProductFile {
    let mut file = file.clone();
    let [lo, hi] = change.to;
    let to = Spread::new(lo, hi, if lo < hi { Law::Range } else { Law::Value }).unwrap();
    let component = &mut file.components[part];
    match (change.lever, &mut component.mount) {
        (Lever::InertiaRatio, _) => file.product = file.product.with_inertia_ratio(lo).unwrap(),
        (Lever::Restitution, _) => file.product.restitution = to,
        (Lever::ContactTime, _) => file.product.contact_time_s = Some(to),
        (Lever::Position, _) => component.position_m = to,
        (Lever::Across, _) => component.across_m = to,
        (Lever::Frequency, Mount::Suspended { frequency_hz, .. }) => *frequency_hz = to,
        (Lever::Damping, Mount::Suspended { damping, .. }) => *damping = Damping::Ratio(to),
        (Lever::StopGap, _) => component.stops.as_mut().unwrap().gap_m = to,
        (Lever::StopTime, _) => component.stops.as_mut().unwrap().contact_time_s = to,
        (Lever::Limit(kind), _) => component.limits = component.limits.with(kind, to),
        (lever, mount) => panic!("{lever:?} of {mount:?}"),
    }
    file
}

/// The least of what is allowed over what is asked, less 1, by each contact law that the verdict counts with.
fn least_margin(file: &ProductFile, of: &ComponentAssessment) -> f64 {
    let by_both = file.product.contact_law.is_none();
    let asked = of.limits.iter().flat_map(|limit| {
        let other = limit.other_law.filter(|_| by_both);
        limit.demand.into_iter().chain(other).map(|asked| limit.allowed / asked - 1.0)
    });
    asked.fold(f64::INFINITY, f64::min)
}

/// Products as they are handed out, one of them with a contact law that is named; a plate and a list of drops. Boxes
/// have a test of their own.
fn worked() -> Vec<(&'static str, String)> {
    let plate = r#"
product = { name = "plate", length = "150 mm", width = "70 mm", radius_of_gyration = ["43 mm", "20 mm"], restitution = 0.3, contact_time = "0.5 ms" }
drop = { speed = "4 m/s", tilt = "5 deg", direction = "60 deg" }
component = [{ name = "part", position = ["30 mm", "0 mm"], natural_frequency = "200 Hz", damping_ratio = 0.05, acceleration_limit = "400 gn" }]
"#;
    let list = r#"
product = { name = "list", length = "150 mm", radius_of_gyration = "43 mm", restitution = 0.3, contact_time = "0.5 ms" }
drop = [{ speed = "4 m/s", tilt = "3 deg" }, { speed = "2 m/s", tilt = ["10 deg", "20 deg"], first = "b" }]
component = [{ name = "part", position = "30 mm", natural_frequency = "200 Hz", damping_ratio = 0.05, acceleration_limit = "400 gn" }]
"#;
    let terminal = include_str!("../../../reports/examples/handheld-terminal.toml");
    // Its disk drive, which needs two changes together.
    let laptop = include_str!("../../../reports/examples/laptop.toml");
    let laptop = &laptop[..laptop.match_indices("[[component]]").nth(1).expect("a second part").0];
    let named = terminal.replace("contact_time = ", "contact_law = \"dashpot\"\ncontact_time = ");
    vec![
        ("example", EXAMPLE.to_owned()),
        ("named", named),
        ("laptop", laptop.to_owned()),
        ("plate", plate.to_owned()),
        ("list", list.to_owned()),
    ]
}

/// A change that is told is what an assessment of the whole file with it says: safe, with the margin that is told, which counts both
/// contact laws where the file names none.
#[test]
fn a_told_change_is_what_an_assessment_of_the_changed_file_says() {
    let margin = 0.1;
    let mut two_laws = 0;
    for (name, text) in worked() {
        let file = ProductFile::read(&text, name).unwrap_or_else(|faults| panic!("{faults}"));
        let assessment = clatter_assess::assess(&file).unwrap();
        let all = clatter_assess::remedies(&file, &assessment, &Bounds::default(), margin).unwrap();
        let mut count = 0;
        for remedies in &all {
            let part = remedies.component;
            let alone = remedies.levers.iter().filter_map(|remedy| match &remedy.outcome {
                Outcome::Change { change, after } => Some((vec![*change], after)),
                _ => None,
            });
            let pair = remedies.pair.iter().map(|pair| (pair.changes.clone(), &pair.after));
            for (changes, told) in alone.chain(pair) {
                let changed = changes.iter().fold(file.clone(), |file, change| changed(&file, part, change));
                let after = clatter_assess::assess(&changed).unwrap().components.remove(part);
                let (now, said) = (least_margin(&changed, &after), clatter_assess::least_margin(&file, told));
                assert_eq!(after.verdict, Verdict::Safe, "{name}: {changes:?}");
                // The same drops of a file that was written and read: but for roundings the same answers.
                assert!((now - said).abs() < 1e-9, "{name}: {changes:?}: {now}, told {said}");
                assert!(said >= margin, "{name}: {changes:?}: {said}");
                two_laws += usize::from(after.tightest().margin.unwrap() > now + 1e-3);
                count += 1;
            }
        }
        assert!(count > 0 || all.is_empty(), "{name}");
    }
    assert!(two_laws > 0, "of no change the other law asks more");
}
