//! What `scatter`, the ladder of models and `design` say of boxes.

use crate::boxes::{HANDHELD, on};
use crate::plates::file;
use clatter_assess::{
    Part, Verdict, answer,
    design::{Bounds, Lever, Outcome},
    ladder::Rung,
    scatter::{Column, Progress, Sampler, Scatter, Settings, Varied},
};
use clatter_product::{Attitude, Drop, DropName, Input, Law, Limit, LimitKind, Model, Mount, ProductFile, Spread};
use clatter_shock::{DampingRatio, Suspension};

fn settings(samples: u64) -> Settings {
    Settings { samples, seed: 1, confidence: 0.95, merge_s: 1e-3 }
}

fn run(file: &ProductFile, samples: u64) -> Scatter {
    Sampler::new(file, settings(samples)).unwrap().run::<()>(false, &|| true, |_| Ok(())).unwrap()
}

/// What every sample consists of.
fn rows(file: &ProductFile, samples: u64) -> (Vec<Column>, Vec<Vec<f64>>) {
    let sampler = Sampler::new(file, settings(samples)).unwrap();
    let (columns, mut rows) = (sampler.columns(), Vec::new());
    let keep = |progress: &Progress<'_>| {
        rows.extend(progress.values.chunks(columns.len()).map(<[f64]>::to_vec));
        Ok::<_, ()>(())
    };
    sampler.run(true, &|| true, keep).unwrap();
    (columns, rows)
}

/// A product whose ranges leave much to chance, in the 26 drops.
fn varied() -> String {
    HANDHELD
        .replace("restitution = 0.4", "restitution = [0.3, 0.5]")
        .replace("\"0.4 ms\"", "{ uniform = [\"0.35 ms\", \"0.45 ms\"] }")
        .replace("\"120 Hz\"", "{ normal = [\"120 Hz\", \"6 Hz\"], range = [\"100 Hz\", \"140 Hz\"] }")
        .replace("5000 gn", "2200 gn")
}

/// A drop of a box that is turned off a face by hand, from the middle of its axes.
fn single(file: &ProductFile, base: [f64; 3], [speed_m_s, tilt_rad, direction_rad, e, contact_s]: [f64; 5]) -> Drop {
    Drop {
        is_level: false,
        base,
        direction_rad,
        gravity_m_s2: file.drop.gravity_m_s2,
        contact_time_s: Some(contact_s),
        contact_law: file.product.law(),
        ..Drop::new(file.product.body, speed_m_s, tilt_rad, e)
    }
}

/// The tolerance of samples.
const OF_SAMPLES: f64 = 0.005;

/// What a drop asks of the display and of the battery, each by its limit.
fn asked(file: &ProductFile, drop: &Drop, hz: f64) -> [f64; 2] {
    [0, 1].map(|i| {
        let component = &file.components[i];
        let suspension = match component.mount {
            Mount::Suspended { damping, .. } => {
                Some(Suspension::from_hz(hz, DampingRatio::new(damping.ratios()[0]).unwrap()).unwrap())
            }
            Mount::Hard => None,
        };
        let used = |at_m: [f64; 2]| {
            let part = Part::at(component.inside.place(at_m), suspension);
            answer(drop, &part, &Limit::of(component)[0], Model::Compliant, OF_SAMPLES).unwrap().utilization()
        };
        component.ends_m().into_iter().map(used).fold(0.0, f64::max)
    })
}

/// Without ranges all samples are one, and it says what an assessment says.
#[test]
fn a_flat_landing_without_ranges_survives_as_it_is_assessed() {
    // Each part feels the fall along its own axis.
    for (face, axis) in [("bottom", "z"), ("end-a", "x")] {
        for (acceleration, rattle, verdicts) in [
            ("1000 gn", "3 mm", [Verdict::Unsafe, Verdict::Unsafe]),
            ("30000 gn", "60 mm", [Verdict::Safe, Verdict::Safe]),
            ("1000 gn", "60 mm", [Verdict::Unsafe, Verdict::Safe]),
        ] {
            let text =
                on("face", face).replace("2 deg", "0 deg").replace("axis = \"x\"\n", "").replace("axis = \"z\"\n", "");
            let along = format!("axis = \"{axis}\"\nmount =");
            let text = text
                .replace("mount =", &along)
                .replace("natural_frequency", &format!("axis = \"{axis}\"\nnatural_frequency"));
            let file = file(&text.replace("5000 gn", acceleration).replace("9 mm\"", &format!("{rattle}\"")));
            let (assessment, scatter) = (clatter_assess::assess(&file).unwrap(), run(&file, 3));
            assert!(scatter.inputs.is_empty() && scatter.unanswered == 0);
            assert_eq!(assessment.components.iter().map(|c| c.verdict).collect::<Vec<_>>(), verdicts);
            for (verdict, part) in verdicts.into_iter().zip(&scatter.components) {
                let survives = if verdict == Verdict::Safe { 1.0 } else { 0.0 };
                assert!(
                    (part.survival.estimate.unwrap() - survives).abs() < 1e-12 && part.open == 0,
                    "{face}: {part:?}"
                );
            }
        }
    }
}

/// A sample survives its drops if it survives each: no more survive the sequence than any one of them.
#[test]
fn a_sequence_is_all_of_its_drops() {
    let file = file(&varied());
    let (columns, rows) = rows(&file, 40);
    let scatter = run(&file, 40);
    assert_eq!(scatter.landings.len(), 26);
    let mut failed_in_some = [0; 2];
    for row in &rows {
        let of = |column| row[columns.iter().position(|c| *c == column).unwrap()];
        for (i, failed) in failed_in_some.iter_mut().enumerate() {
            let most = (0..26).map(|n| of(Column::LandingUtilization(n, i))).fold(0.0, f64::max);
            assert_eq!(most.to_bits(), of(Column::Utilization(i)).to_bits());
            *failed += u64::from(most > 1.0);
        }
    }
    for (i, component) in scatter.components.iter().enumerate() {
        assert_eq!(component.failures, failed_in_some[i]);
        for landing in &scatter.landings {
            let alone = &landing.components[i];
            assert!(component.failures >= alone.failures && component.survival.hi <= alone.survival.hi);
            assert!(scatter.survival.estimate <= landing.survival.estimate);
            assert!(alone.largest_utilization <= Some(component.largest_utilization));
        }
    }
    assert!(scatter.components[0].failures > 0 && scatter.survival.estimate < Some(1.0));
    // It takes several drops to fail as often.
    let most = scatter.landings.iter().map(|landing| landing.components[0].failures).max().unwrap();
    assert!(scatter.components[0].failures > most, "{} and {most}", scatter.components[0].failures);
}

/// Every drop of every sample once more, alone, by the engine of one drop: the product is the same in all of them.
#[test]
fn samples_of_boxes_are_single_drops() {
    let file = file(&varied());
    let (columns, rows) = rows(&file, 3);
    let (a, b) = (75e-3, 35e-3);
    let thick = 7e-3;
    let (mut count, mut same) = (0, 0);
    for row in &rows {
        let of = |column| row[columns.iter().position(|c| *c == column).unwrap()];
        for (n, landing) in file.landings.iter().enumerate() {
            // The center of mass is in the middle, over what is landed on.
            let name = landing.attitude.expect("a box").to_string();
            let down =
                [("end-a", "end-b", a), ("front", "back", b), ("bottom", "top", thick)].map(|(low, high, side)| {
                    f64::from(i8::from(name.contains(high)) - i8::from(name.contains(low))) * side
                });
            let size = down.iter().map(|x| x * x).sum::<f64>().sqrt();
            let given = [
                of(Column::Drop(Input::Speed, Some(n))),
                of(Column::Drop(Input::Tilt, Some(n))),
                of(Column::Drop(Input::Direction, Some(n))),
                of(Column::Drop(Input::Restitution, None)),
                of(Column::Drop(Input::ContactTime, None)),
            ];
            assert!((given[0] - (2.0 * 9.806_65 * 1.22_f64).sqrt()).abs() < 1e-12);
            assert!(given[1] <= landing.tolerance_rad() * (1.0 + 1e-12));
            let drop = single(&file, down.map(|x| -x / size + 0.0), given);
            for (i, one) in asked(&file, &drop, of(Column::FrequencyHz(1))).into_iter().enumerate() {
                let used = of(Column::LandingUtilization(n, i));
                count += 1;
                // Left where the energy allows no more than the limit, it asks for no more than followed until it lies; where that decides
                // it is followed on.
                assert!(used <= one * (1.0 + 1e-6) && (used > 1.0) == (one > 1.0), "{name}, {i}: {used}, not {one}");
                same += usize::from((used / one - 1.0).abs() < 1e-9);
            }
        }
    }
    assert_eq!(count, 3 * 26 * 2);
    assert!(same * 2 > count, "{same} of {count} are the same");
}

/// A part that is slow beside the whole clatter swings while the box flies: by (1 + e) v e^(−ζφ/tan φ)/ω, tan φ = √(1 − ζ²)/ζ.
#[test]
fn a_slow_part_is_seen_to_swing() {
    let text = on("face", "end-a").replace("2 deg", "0 deg").replace("120 Hz", "12 Hz").replace("9 mm", "300 mm");
    let scatter = run(&file(&text), 1);
    let (omega, zeta, v) = (std::f64::consts::TAU * 12.0, 0.1_f64, (2.0 * 9.806_65 * 1.22_f64).sqrt());
    let phase = ((1.0 - zeta * zeta).sqrt() / zeta).atan();
    let swings = 1.4 * v / omega * (-zeta * phase / (1.0 - zeta * zeta).sqrt()).exp() / 0.3;
    let used = scatter.components[1].largest_utilization;
    // (ωτ)²/24 and less.
    assert!((used / swings - 1.0).abs() < 0.01, "{used}, not {swings}");
}

/// As many fail as in plain sampling by a sequence that has nothing in common with the draws: all attitudes within the tolerance are
/// equally likely.
#[test]
fn boxes_fail_as_often_as_in_plain_sampling() {
    let text = on("face", "bottom").replace("extent = [\"20 mm\", \"10 mm\"]\n", "").replace("5000 gn", "1500 gn");
    let file = file(&text.replace("restitution = 0.4", "restitution = { uniform = [0.2, 0.6] }"));
    let (many, drops) = (1500, 300_u32);
    let scatter = run(&file, many);
    let of = [Input::Tilt, Input::Direction].map(|of| Varied::Drop(of, Some(0)));
    assert_eq!(scatter.inputs, [of[0], Varied::Drop(Input::Restitution, None), of[1]]);
    assert_eq!(scatter.assumed_even, of[..1]);
    let shares = |k: u32| {
        [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3].map(|a| (a * f64::from(k)).fract())
    };
    let v = (2.0 * 9.806_65 * 1.22_f64).sqrt();
    let fails = (1..=drops).filter(|&k| {
        // A point of the disk of the slopes.
        let [r, turn, e] = shares(k);
        let drop = single(
            &file,
            [0.0, 0.0, 1.0],
            [v, (2.0 * r.sqrt()).to_radians(), std::f64::consts::TAU * turn, 0.2 + 0.4 * e, 4e-4],
        );
        asked(&file, &drop, 120.0)[0] > 1.0
    });
    #[expect(clippy::cast_precision_loss, reason = "a small count")]
    let failed = fails.count() as f64 / f64::from(drops);
    let found = 1.0 - scatter.components[0].survival.estimate.unwrap();
    assert!((0.2..0.8).contains(&failed), "{failed}");
    // Four standard deviations of both.
    let most = 4.0 * (failed * (1.0 - failed) * (1.0 / 1500.0 + 1.0 / f64::from(drops))).sqrt();
    assert!((found - failed).abs() < most, "{found} beside {failed}");
}

/// What is drawn for one sample is the same however many there are, and so is all that is told on any number of threads.
#[test]
fn boxes_are_the_same_on_any_number_of_threads() {
    let file = file(&varied());
    let on = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| run(&file, 23));
    let (one, seven) = (on(1), on(7));
    assert_eq!(format!("{one:?}"), format!("{seven:?}"));
    let (_, few) = rows(&file, 2);
    let (_, more) = rows(&file, 12);
    assert_eq!(format!("{few:?}"), format!("{:?}", &more[..2]));
}

/// A lively box on its bottom may land on its end later, which moves a part along it by more than its room: where no drop tells, the sample is
/// open, and its interval holds both verdicts.
#[test]
fn what_rebounds_may_decide_is_open() {
    let text = on("face", "bottom").replace("restitution = 0.4", "restitution = 0.95");
    let scatter = run(&file(&text), 20);
    let [display, battery] = [0, 1].map(|n| &scatter.components[n]);
    assert!(battery.open > 0 && battery.failures == 0 && display.open == 0, "{battery:?}, {display:?}");
    let decided = clatter_assess::scatter::clopper_pearson(20, 20, 0.95).lo;
    assert!(battery.survival.lo < decided, "{battery:?}, not {decided}");
    // With less energy left it is followed to where that decides nothing.
    let calm = run(&file(&on("face", "bottom").replace("9 mm", "60 mm")), 20);
    assert!(calm.open == 0 && calm.components[0].survival.lo > 0.8, "{calm:?}");
}

/// Ranges as wide as files may have them end with an answer, or with one message.
#[test]
fn hostile_boxes_are_answered_or_refused() {
    let corner = on("corner", "top back end-a").replace("5 deg", "15 deg");
    let face = on("face", "end-b").replace("2 deg", "15 deg");
    let wide = |text: &str| text.replace("restitution = 0.4", "restitution = [0, 1]");
    let weightless = face.replace("height = \"1.22 m\"", "speed = [\"0.01 m/s\", \"5 m/s\"]\ngravity = \"0 m/s^2\"");
    let slow = face.replace("\"0.4 ms\"", "[\"1 us\", \"40 ms\"]");
    let cases =
        [wide(&corner), face.replace("= 0.4", "= 1"), wide(&weightless), wide(&slow), face.replace("= 0.4", "= 0")];
    for text in cases {
        let read = ProductFile::read(&text, "box.toml").unwrap_or_else(|faults| panic!("{faults}"));
        let scatter = run(&read, 6);
        let [sums, least] = [scatter.survival.lo + scatter.survival.hi, scatter.survival.lo];
        assert!(sums.is_finite() && least >= 0.0, "{scatter:?}");
        assert_eq!(scatter.unanswered > 0, scatter.reason.is_some(), "{scatter:?}");
    }
}

/// The axes of an attitude are those of the file: a box that is turned about its end feels it there.
#[test]
fn the_drops_of_a_list_have_their_names() {
    let scatter = run(&file(HANDHELD), 2);
    let names: Vec<_> = scatter.landings.iter().map(|landing| landing.landing).collect();
    assert_eq!(names, [1, 2, 3].into_iter().flat_map(Attitude::all).map(DropName::On).collect::<Vec<_>>());
    // The battery slides along the length: on the ends most, flat on its back next to nothing.
    let battery = |name: &str| {
        let on = DropName::On(Attitude::on(name).unwrap());
        scatter.landings.iter().find(|landing| landing.landing == on).unwrap().components[1]
            .largest_utilization
            .unwrap()
    };
    assert!(battery("end-a") > 4.0 * battery("bottom") && battery("end-b") > 4.0 * battery("top"));
}

/// How late the last corner may come, by hand: the diagonal of a face and the length of an edge over the speed.
#[test]
fn a_tolerance_leaves_open_whether_a_box_clatters() {
    let file = file(&HANDHELD.replace("extent = [\"20 mm\", \"10 mm\"]\n", ""));
    let ladders = clatter_assess::ladders(&file, &clatter_assess::assess(&file).unwrap(), 0.05).unwrap();
    assert_eq!(ladders.landings.len(), 26);
    let v = (2.0 * 9.806_65 * 1.22_f64).sqrt();
    let of = |name: &str| {
        let on = DropName::On(Attitude::on(name).unwrap());
        ladders.landings.iter().find(|landing| landing.landing == on).unwrap()
    };
    for (name, corners, reach_m, degrees) in [
        ("bottom", 4, 0.15_f64.hypot(0.07), 2.0_f64),
        ("end-b", 4, 0.07_f64.hypot(0.014), 2.0),
        ("front end-a", 2, 0.014, 5.0),
        ("top back", 2, 0.15, 5.0),
        ("top back end-b", 1, 0.0, 5.0),
    ] {
        let landing = of(name);
        let latest = reach_m * degrees.to_radians().sin() / v;
        assert_eq!((landing.corners, landing.contact_time_s), (corners, [4e-4; 2]), "{name}");
        assert!((landing.last_corner_s[1] - latest).abs() < 1e-12 && landing.last_corner_s[0] == 0.0, "{landing:?}");
        // Within the contact of the first it is one landing.
        assert_eq!(landing.may_clatter(), latest > 4e-4, "{landing:?}");
        if let Some(as_one) = landing.as_one_to_deg {
            assert!((reach_m * as_one.to_radians().sin() / v - 4e-4).abs() < 1e-12, "{landing:?}");
        }
        assert!(landing.tightest.as_ref().is_some_and(|limit| limit.margin.is_some()));
    }
    assert!(of("bottom").may_clatter() && of("top back").may_clatter() && !of("front end-a").may_clatter());
    // Of a range of contact times the shortest is over first.
    let range = self::file(
        &on("face", "bottom").replace("contact_time = \"0.4 ms\"", "contact_time = [\"0.2 ms\", \"0.4 ms\"]"),
    );
    let all = clatter_assess::ladders(&range, &clatter_assess::assess(&range).unwrap(), 0.05).unwrap().landings;
    let as_one = all[0].as_one_to_deg.unwrap().to_radians().sin() * 0.15_f64.hypot(0.07) / v;
    assert!((as_one - 2e-4).abs() < 1e-12, "{all:?}");

    // Turned up, its farthest corner comes down the slower, and the last may come later.
    let spun = self::file(&on("face", "bottom").replace("[drop]", "[drop]\nspin = [\"-4 rad/s\", \"2 rad/s\"]"));
    let all = clatter_assess::ladders(&spun, &clatter_assess::assess(&spun).unwrap(), 0.05).unwrap().landings;
    let far_m = (0.075_f64.powi(2) + 0.035_f64.powi(2) + 0.007_f64.powi(2)).sqrt();
    let latest = 0.15_f64.hypot(0.07) * 2.0_f64.to_radians().sin() / (v - 4.0 * far_m);
    assert!((all[0].last_corner_s[1] - latest).abs() < 1e-12, "{all:?}");

    // The worst drop of each part is on a face across which it moves: the plate that this face is says nearly as much where the box is
    // low over it.
    for (limit, most) in ladders.limits.iter().zip([0.02, 0.1]) {
        let rungs: Vec<_> = limit.ladder.models.iter().map(|m| m.model).collect();
        assert_eq!(rungs, [Rung::Bar, Rung::Plate, Rung::Block], "{limit:?}");
        let [_, plate, block] = &limit.ladder.models[..] else { unreachable!() };
        assert!(plate.error < most && block.error < 1e-9 && limit.ladder.reference.model == Rung::Block, "{limit:?}");
    }
    let faces: Vec<_> = ladders.limits.iter().map(|limit| limit.worst_case.landing.unwrap().to_string()).collect();
    assert!(["face bottom", "face top"].contains(&faces[0].as_str()) && faces[1].starts_with("face end"), "{faces:?}");
}

/// On an edge no plate lands, and across a face none moves a part along it.
#[test]
fn a_box_alone_answers_what_no_plate_does() {
    for (key, faces) in [("edge", "bottom end-a"), ("corner", "bottom back end-a")] {
        let file = file(&on(key, faces));
        let ladders = clatter_assess::ladders(&file, &clatter_assess::assess(&file).unwrap(), 0.05).unwrap();
        for limit in &ladders.limits {
            assert_eq!((limit.ladder.models.len(), limit.ladder.cheapest), (1, Rung::Block), "{limit:?}");
            assert!(limit.ladder.reason.contains("no plate lands so"), "{}", limit.ladder.reason);
        }
    }
}

/// What each lever recommends holds when the box with these values is assessed as a whole, in all of its drops.
#[test]
fn changes_of_boxes_hold_when_assessed() {
    let text =
        on("face", "bottom").replace("axis = \"x\"\n", "").replace("= 0.4", "= 0.3").replace("5000 gn", "2700 gn");
    let text = text.replace("\"14 mm\"", "\"40 mm\"").replace("extent = [\"20 mm\", \"10 mm\"]\n", "");
    let text = text.replace("\"10 mm\", \"5 mm\"]", "\"30 mm\", \"15 mm\"]").replace("9 mm\"", "5.2 mm\"");
    // So damped that its rebounds seldom count, which drops would be followed for longer for.
    let text = text.replace("damping_ratio = 0.1", "damping_ratio = 0.35");
    let file = file(&text);
    let before = clatter_assess::assess(&file).unwrap();
    assert!(before.components.iter().all(|component| component.verdict != Verdict::Safe), "{before:?}");
    let margin = 0.05;
    let found = clatter_assess::remedies(&file, &before, &Bounds::default(), margin).unwrap();
    assert_eq!(found.len(), 2);
    let mut held = Vec::new();
    for part in &found {
        for remedy in &part.levers {
            let Outcome::Change { change, .. } = &remedy.outcome else { continue };
            let [lo, hi] = change.to;
            let to = Spread::new(lo, hi, if lo < hi { Law::Range } else { Law::Value }).unwrap();
            let mut changed = file.clone();
            let component = &mut changed.components[part.component];
            match (remedy.lever, &mut component.mount) {
                (Lever::Restitution, _) => changed.product.restitution = to,
                (Lever::Position, _) => component.position_m = to,
                (Lever::Across, _) => component.across_m = to,
                (Lever::ContactTime, _) => changed.product.contact_time_s = Some(to),
                (Lever::Limit(kind), _) => component.limits = component.limits.with(kind, to),
                (Lever::Frequency, Mount::Suspended { frequency_hz, .. }) => *frequency_hz = to,
                (Lever::Damping, Mount::Suspended { damping, .. }) => *damping = clatter_product::Damping::Ratio(to),
                other => panic!("{other:?}"),
            }
            let after = clatter_assess::assess(&changed).unwrap();
            let after = &after.components[part.component];
            let room = after.limits[0].margin.unwrap();
            assert!(after.verdict == Verdict::Safe && room >= margin, "{change:?}: {after:?}");
            held.push((part.component, remedy.lever));
        }
    }
    // No place is enough: friction may turn so thick a box.
    for lever in [Lever::ContactTime, Lever::Limit(LimitKind::Acceleration)] {
        assert!(held.contains(&(0, lever)), "{lever:?} is not among {held:?}");
    }
    assert!(held.contains(&(1, Lever::Frequency)), "{held:?}");
}

/// A part along the ground feels next to nothing of a flat landing, and much more where the ground holds the box.
#[test]
fn samples_slide_and_stick() {
    let used = |friction: &str| -> f64 {
        let text = on("face", "bottom").replacen("axis = \"z\"", "axis = \"x\"", 1);
        let file = file(&text.replacen("friction = 0\n", &format!("friction = {friction}\n"), 1));
        let rows = Sampler::new(&file, settings(20)).unwrap().rows(0..20, &[], &|_| ());
        rows.iter().map(|(_, asked)| asked[0].as_ref().unwrap().utilization).sum()
    };
    let [none, some, more] = ["0", "0.2", "0.5"].map(used);
    assert!(some > 2.0 * none && more > some, "{none}, {some}, {more}");
}
