//! What `scatter`, the ladder of models and `design` say of plates.

use crate::plates::file;
use clatter_assess::{
    Part, Verdict, answer,
    design::{Bounds, Lever, Outcome},
    ladder::{Ladder, Rung},
    scatter::{Column, PlateAs, Progress, Sampler, Scatter, Settings, Varied},
};
use clatter_product::{Body, Drop, Input, Law, Limit, LimitKind, Model, Place, ProductFile, Side, Spread};

/// A board in a terminal whose place across it is not known well.
const BOARD: &str = r#"
[product]
name = "terminal"
length = "150 mm"
width = "70 mm"
radius_of_gyration = ["43 mm", "20 mm"]
center_of_mass = ["6 mm", "-4 mm"]
restitution = 0.4
contact_time = "0.4 ms"
contact_law = "hysteretic"

[drop]
speed = "3 m/s"
tilt = { uniform = ["0.5 deg", "4 deg"] }

[[component]]
name = "board"
position = ["-20 mm", { uniform = ["-10 mm", "15 mm"] }]
extent = ["30 mm", "20 mm"]
mount = "hard"
velocity_change_limit = "5.5 m/s"
acceleration_limit = "1400 gn"
"#;

fn settings(samples: u64) -> Settings {
    Settings { samples, seed: 1, confidence: 0.95, merge_s: 1e-3 }
}

fn values(file: &ProductFile, samples: u64) -> (Vec<Column>, Vec<Vec<f64>>) {
    let sampler = Sampler::new(file, settings(samples)).unwrap();
    let (columns, mut rows) = (sampler.columns(), Vec::new());
    let keep = |progress: &Progress<'_>| {
        rows.extend(progress.values.chunks(columns.len()).map(<[f64]>::to_vec));
        Ok::<_, ()>(())
    };
    sampler.run(true, &|| true, keep).unwrap();
    (columns, rows)
}

fn draw(file: &ProductFile, samples: u64) -> Scatter {
    Sampler::new(file, settings(samples)).unwrap().run::<()>(false, &|| true, |_| Ok(())).unwrap()
}

/// The same drop of the box that a plate is.
fn boxed(drop: &Drop, thickness_m: f64) -> Drop {
    Drop { is_level: false, body: drop.body.with_thickness(Side::even(thickness_m)), ..*drop }
}

/// A drop of the terminal, of which no thickness is known, and what it asks of its board, by the engine of one drop alone.
fn asked(file: &ProductFile, direction_deg: f64, tilt_deg: f64, across_m: f64) -> f64 {
    let drop = boxed(&one(file, tilt_deg, direction_deg).0, 0.05 * 0.15);
    let board = &file.components[0];
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    let part = |[x, y]: [f64; 2]| {
        let (position_m, across_m) = (-0.02 + x * board.extent_m, across_m + y * board.extent_across_m);
        Part::at(Place::flat([position_m, across_m]), None)
    };
    let parts: Vec<_> = if board.extent_m > 0.0 { corners.map(part).into() } else { vec![part([0.0; 2])] };
    let limits = Limit::of(board);
    let each = parts.iter().flat_map(|part| limits.iter().map(move |limit| (part, limit)));
    let used = each.map(|(part, limit)| answer(&drop, part, limit, Model::fullest(&drop), 0.01).unwrap().utilization());
    used.fold(0.0, f64::max)
}

/// Every sample of a plate once more, as one drop of the box that it is: direction and place across are those of the row.
#[test]
fn samples_of_plates_are_single_drops() {
    let file = file(BOARD);
    let (columns, rows) = values(&file, 60);
    let inputs = [Input::Direction, Input::Speed, Input::Tilt, Input::Restitution, Input::ContactTime];
    let inputs = inputs.map(|input| Column::Drop(input, None));
    assert_eq!(columns, [&inputs[..], &[Column::AcrossM(0), Column::Utilization(0)]].concat());
    for row in rows {
        let one = asked(&file, row[0].to_degrees(), row[2].to_degrees(), row[5]);
        // Places between the corners may ask for more of a change of velocity.
        assert!(row[6] >= one * 0.995 && row[6] <= one * 1.03, "{}, not {one}: {row:?}", row[6]);
    }
}

/// As many fail as in plain sampling by a sequence that has nothing in common with the draws.
#[test]
fn plates_fail_as_often_as_in_plain_sampling() {
    let file = file(&BOARD.replace("extent = [\"30 mm\", \"20 mm\"]\n", ""));
    let (many, drops) = (2000, 300_u32);
    let scatter = draw(&file, many);
    let part = &scatter.components[0];
    assert_eq!((scatter.settings.samples, part.unanswered), (many, 0));
    assert_eq!(
        scatter.inputs,
        [Varied::Drop(Input::Tilt, None), Varied::Drop(Input::Direction, None), Varied::Across(0)]
    );
    assert_eq!(scatter.assumed_even, []);
    // Multiples of the powers of a root of x⁴ = x + 1 fill the cube evenly.
    let shares = |k: u32| {
        [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3].map(|a| (a * f64::from(k)).fract())
    };
    let fails = (1..=drops).filter(|&k| {
        let [direction, tilt, across] = shares(k);
        asked(&file, 360.0 * direction, 0.5 + 3.5 * tilt, 0.001 * (-10.0 + 25.0 * across)) > 1.0
    });
    #[expect(clippy::cast_precision_loss, reason = "a small count")]
    let failed = fails.count() as f64 / f64::from(drops);
    let found = 1.0 - part.survival.estimate.unwrap();
    assert!((0.2..0.8).contains(&failed), "{failed}");
    // Four standard deviations of both.
    let most = 4.0 * (failed * (1.0 - failed) * (1.0 / 2000.0 + 1.0 / f64::from(drops))).sqrt();
    assert!((found - failed).abs() < most, "{found} beside {failed}");
    assert_eq!(part.drivers[0].input, Varied::Drop(Input::Direction, None));
}

/// Steep drops of a plate, and where they ask for what it is allowed: the thickness of the file, and a twentieth of the length without one.
fn steep(thickness: &str) -> ProductFile {
    let text = BOARD.replace("[\"0.5 deg\", \"4 deg\"]", "[\"12 deg\", \"25 deg\"]").replace("5.5 m/s", "2.7 m/s");
    file(&text.replace("extent = [\"30 mm\", \"20 mm\"]\n", "").replace("width = ", &format!("{thickness}width = ")))
}

/// A plate survives where the box survives that it is, sample by sample; where it is level, others do.
#[test]
fn a_plate_survives_where_its_box_does() {
    for (thickness, thickness_m, assumed) in [("thickness = \"12 mm\"\n", 0.012, false), ("", 0.0075, true)] {
        let file = steep(thickness);
        assert_eq!(draw(&file, 1).plate, Some(PlateAs::Box { thickness_m, assumed }));
        let sampler = Sampler::new(&file, settings(1)).unwrap();
        let columns = [Column::Drop(Input::Tilt, None), Column::Drop(Input::Direction, None), Column::AcrossM(0)];
        let (mut differ, mut decided) = (0, 0);
        for (drawn, asked) in sampler.rows(0..150, &columns, &|_| ()) {
            let (level, _) = one(&file, drawn[0].to_degrees(), drawn[1].to_degrees());
            let part = Part::at(Place::flat([-0.02, drawn[2]]), None);
            let survives = |drop: &Drop| {
                let of = |limit| answer(drop, &part, limit, Model::Compliant, 0.005).unwrap().utilization() <= 1.0;
                Limit::of(&file.components[0]).iter().all(of)
            };
            let (asked, as_box) = (asked[0].unwrap(), survives(&boxed(&level, thickness_m)));
            differ += u32::from(as_box != survives(&level));
            if !asked.open {
                decided += 1;
                assert_eq!(asked.utilization <= 1.0, as_box, "{drawn:?}: {asked:?}");
            }
        }
        assert!(differ >= 5 && decided >= 145, "{differ} differ, {decided} are decided");
    }
}

/// A plate whose corners sink in too far for so thin a box lands on the bottom of one that goes on upward, with the same mass below. One on
/// feet stays level.
#[test]
fn a_plate_too_soft_for_its_thickness_lands_on_its_bottom() {
    let text =
        BOARD.replace("width = ", "thickness = \"0.5 mm\"\nwidth = ").replace("restitution = 0.4", "restitution = 0.2");
    let file = file(&text.replace("extent = [\"30 mm\", \"20 mm\"]\n", ""));
    let (thin_m, high_m) = (0.0005, 0.0405);
    let columns = [Column::Drop(Input::Tilt, None), Column::Drop(Input::Direction, None), Column::AcrossM(0)];
    let limits = Limit::of(&file.components[0]);
    for (drawn, asked) in Sampler::new(&file, settings(1)).unwrap().rows(0..12, &columns, &|_| ()) {
        let drop = Drop { restitution: 0.2, ..one(&file, drawn[0].to_degrees(), drawn[1].to_degrees()).0 };
        let part = Part::at(Place::flat([-0.02, drawn[2]]), None);
        let refused = answer(&boxed(&drop, thin_m), &part, &limits[0], Model::Compliant, 0.01).unwrap_err();
        assert!(refused.to_string().contains("sink in by the smallest size"), "{refused}");
        let below_m = 0.5 * (thin_m - high_m);
        let ends_m = [0.5 * high_m + below_m, 0.5 * high_m - below_m];
        let thickness = Side { ends_m, gyration_m: thin_m / 12_f64.sqrt() };
        let high = Drop { is_level: false, body: drop.body.with_thickness(thickness), ..drop };
        let part = Part::at(Place::new([-0.02, drawn[2], below_m]), None);
        let of = |limit| answer(&high, &part, limit, Model::Compliant, 0.01).unwrap().utilization();
        let (found, known) = (asked[0].unwrap().utilization, limits.iter().map(of).fold(0.0, f64::max));
        assert!((found / known - 1.0).abs() < 1e-4, "{found}, not {known}");
    }
    // It is not followed on: where what is left may add to what a part still rings with, it is open.
    let (rigid, _) = text.split_once("mount").unwrap();
    let rings = "natural_frequency = \"60 Hz\"\ndamping_ratio = 0.01\nrattle_space = \"9 mm\"\n";
    let scatter = draw(&crate::plates::file(&format!("{}{rings}", rigid.replace("0.4 ms", "0.8 ms"))), 20);
    assert!(scatter.open > 5, "{scatter:?}");
    let on_feet = BOARD.replace("width = ", "feet_inset = [\"10 mm\", \"8 mm\"]\nfeet_height = \"20 mm\"\nwidth = ");
    assert_eq!(draw(&crate::plates::file(&on_feet), 1).plate, Some(PlateAs::Level));
}

/// A direction of the file is drawn by its distribution, and no other.
#[test]
fn a_direction_of_the_file_is_drawn() {
    let text = BOARD.replace("tilt = {", "direction = { uniform = [\"100 deg\", \"120 deg\"] }\ntilt = {");
    let (columns, rows) = values(&file(&text), 20);
    assert_eq!(columns[0], Column::Drop(Input::Direction, None));
    assert!(rows.iter().all(|row| (100.0..=120.0).contains(&row[0].to_degrees())), "{rows:?}");
    let fixed = text.replace("{ uniform = [\"100 deg\", \"120 deg\"] }", "\"100 deg\"");
    let (_, fixed) = values(&file(&fixed), 20);
    assert!(fixed.iter().all(|row| (row[0].to_degrees() - 100.0).abs() < 1e-12));
    // What else is drawn is the same.
    assert!(fixed.iter().zip(&rows).all(|(a, b)| a[2].to_bits() == b[2].to_bits() && a[5].to_bits() == b[5].to_bits()));
}

/// A drop of the terminal and the middle of its board.
fn one(file: &ProductFile, tilt_deg: f64, direction_deg: f64) -> (Drop, Part) {
    let drop = Drop {
        direction_rad: direction_deg.to_radians(),
        gravity_m_s2: file.drop.gravity_m_s2,
        contact_time_s: Some(4e-4),
        contact_law: file.product.law(),
        ..Drop::new(file.product.body, 3.0, tilt_deg.to_radians(), 0.4)
    };
    (drop, Part::at(Place::flat([0.05, 0.02]), None))
}

/// Where β = 1 + α the plate that lands on its edge is the bar along its length, and the bar is told to be enough; on a corner it is not.
#[test]
fn the_bar_is_the_cheapest_where_the_width_does_nothing() {
    let alpha = (75.0_f64 / 43.0).powi(2);
    let text = BOARD
        .replace("\"20 mm\"]\ncenter", &format!("\"{} mm\"]\ncenter", 35.0 / (1.0 + alpha).sqrt()))
        .replace("[\"6 mm\", \"-4 mm\"]", "[\"0 mm\", \"0 mm\"]");
    let file = file(&text);
    let limit = Limit::new(LimitKind::VelocityChange, 5.0);
    let (drop, part) = one(&file, 0.25, 0.0);
    let edge = Ladder::measure(&drop, &part, &limit, 0.01).unwrap();
    let rungs: Vec<_> = edge.models.iter().map(|m| m.model).collect();
    assert_eq!(rungs, [Rung::Bar, Rung::Plate, Rung::Block]);
    assert_eq!((edge.cheapest, edge.reference.model), (Rung::Bar, Rung::Block));
    assert!(edge.models.iter().all(|m| m.error < 0.01 && m.strikes > 1), "{edge:?}");
    assert!(
        edge.reason.starts_with("its width does nothing here: h_y/h_x = 0.00e0; bar is off by 0."),
        "{}",
        edge.reason
    );

    let (drop, part) = one(&file, 1.0, 40.0);
    let corner = Ladder::measure(&drop, &part, &limit, 0.05).unwrap();
    let [bar, plate, block] = &corner.models[..] else { panic!("{corner:?}") };
    assert!(bar.error > 0.05 && plate.error < 0.05 && block.error < 1e-12, "{corner:?}");
    assert_eq!(corner.cheapest, Rung::Plate);
    assert!(
        corner.reason.starts_with("it turns about its length too, as no bar does: h_y/h_x = 3.92e-1; bar is off by"),
        "{}",
        corner.reason
    );
    // The bar has the tilt that the length has.
    let (body, tilt_rad) =
        (Body { width: None, ..drop.body }, (drop.tilt_rad.sin() * 40_f64.to_radians().cos()).asin());
    let along = Drop { body, direction_rad: 0.0, tilt_rad, ..drop };
    let own = answer(&along, &Part::new(0.05, None), &limit, Model::Compliant, 0.05).unwrap();
    assert!((bar.value / own.value - 1.0).abs() < 0.01, "{} beside {}", bar.value, own.value);
    // A plate of steep tilt is not what its box is.
    let (steep, part) = one(&file, 20.0, 40.0);
    let steep = Ladder::measure(&steep, &part, &limit, 0.01).unwrap();
    assert!(
        steep.cheapest == Rung::Block && steep.reason.starts_with("real tilt counts: φ² = 1.22e-1; plate"),
        "{steep:?}"
    );
}

/// Every limit of a product has its three rungs, also where masses lie askew.
#[test]
fn products_with_a_width_have_ladders() {
    let text = BOARD.replace("tilt = {", "direction = [\"20 deg\", \"40 deg\"]\ntilt = {");
    let of = |text: &str| {
        let file = file(text);
        clatter_assess::ladders(&file, &clatter_assess::assess(&file).unwrap(), 0.05).unwrap()
    };
    let masses = r#"masses = [
    { mass = "100 g", from = ["-75 mm", "-35 mm"], to = ["75 mm", "35 mm"] },
    { mass = "60 g", position = ["40 mm", "20 mm"] },
]"#;
    let given = "radius_of_gyration = [\"43 mm\", \"20 mm\"]\ncenter_of_mass = [\"6 mm\", \"-4 mm\"]";
    for text in [&text, &text.replace(given, masses)] {
        let ladders = of(text);
        assert_eq!((ladders.limits.len(), ladders.left_out.len()), (2, 0));
        for limit in &ladders.limits {
            assert!(limit.ladder.groups.across.is_some());
            assert_eq!((limit.ladder.models.len(), limit.ladder.reference.model), (3, Rung::Block));
        }
    }
}

/// What each lever recommends holds when the product with these values is assessed as a whole; the place across is one of them.
#[test]
fn changes_of_plates_hold_when_assessed() {
    let text = BOARD
        .replace(
            "tilt = { uniform = [\"0.5 deg\", \"4 deg\"] }",
            "direction = \"35 deg\"\ntilt = [\"1.5 deg\", \"2 deg\"]",
        )
        .replace("[\"-20 mm\", { uniform = [\"-10 mm\", \"15 mm\"] }]", "[\"10 mm\", [\"18 mm\", \"20 mm\"]]")
        .replace("acceleration_limit = \"1400 gn\"\n", "")
        .replace("5.5 m/s", "4.5 m/s");
    let file = file(&text);
    let before = clatter_assess::assess(&file).unwrap();
    assert_eq!(before.verdict, Verdict::Unsafe);
    let margin = 0.05;
    let found = clatter_assess::remedies(&file, &before, &Bounds::default(), margin).unwrap();
    let levers: Vec<_> = found[0].levers.iter().map(|remedy| remedy.lever).collect();
    let limit = Lever::Limit(LimitKind::VelocityChange);
    let known = [
        Lever::Restitution,
        Lever::Position,
        Lever::Across,
        Lever::Frequency,
        Lever::Damping,
        Lever::ContactTime,
        limit,
    ];
    assert_eq!(levers, known);
    let mut held = Vec::new();
    for remedy in &found[0].levers {
        let Outcome::Change { change, .. } = &remedy.outcome else { continue };
        let [lo, hi] = change.to;
        let to = Spread::new(lo, hi, if lo < hi { Law::Range } else { Law::Value }).unwrap();
        let mut changed = file.clone();
        let part = &mut changed.components[0];
        match remedy.lever {
            Lever::Restitution => changed.product.restitution = to,
            Lever::Position => part.position_m = to,
            Lever::Across => part.across_m = to,
            Lever::ContactTime => changed.product.contact_time_s = Some(to),
            Lever::Limit(kind) => part.limits = part.limits.with(kind, to),
            other => panic!("{other:?} of a part that is mounted rigidly"),
        }
        let after = clatter_assess::assess(&changed).unwrap();
        let room = after.components[0].limits[0].margin.unwrap();
        assert!(after.verdict == Verdict::Safe && room >= margin, "{change:?}: {room}");
        held.push(remedy.lever);
    }
    assert!(held.contains(&Lever::Across) && held.contains(&limit), "{held:?}");
    // Towards the middle and as wide as it was, both ends rounded to a tenth of a millimeter.
    let across = found[0].levers.iter().find(|remedy| remedy.lever == Lever::Across).unwrap();
    let Outcome::Change { change, .. } = &across.outcome else { panic!("{across:?}") };
    assert!(change.to[1] < 0.02 && (change.to[1] - change.to[0] - 0.002).abs() < 1.01e-4, "{change:?}");
}

/// Where no place is good enough, each lever tells from where to where it was tried: as far as the part fits on the plate along its own
/// side, by its own extent along it, its range with it.
#[test]
fn a_part_is_tried_as_far_as_it_fits_on_the_plate() {
    let text = BOARD
        .replace(
            "tilt = { uniform = [\"0.5 deg\", \"4 deg\"] }",
            "direction = \"35 deg\"\ntilt = [\"1 deg\", \"2 deg\"]",
        )
        .replace(
            "[\"-20 mm\", { uniform = [\"-10 mm\", \"15 mm\"] }]",
            "[[\"10 mm\", \"13 mm\"], [\"18 mm\", \"20 mm\"]]",
        )
        .replace("acceleration_limit = \"1400 gn\"\n", "")
        // Every place changes its velocity by more: the product turns back.
        .replace("5.5 m/s", "1 m/s");
    let file = file(&text);
    let found =
        clatter_assess::remedies(&file, &clatter_assess::assess(&file).unwrap(), &Bounds::default(), 0.0).unwrap();
    // Half of 150 mm less 30 mm, and of 70 mm less 20 mm; the range as a whole within it.
    for (lever, want) in [(Lever::Position, [-0.060, 0.057]), (Lever::Across, [-0.025, 0.023])] {
        let remedy = found[0].levers.iter().find(|remedy| remedy.lever == lever).unwrap();
        let Outcome::Nowhere { bounds } = remedy.outcome else { panic!("{remedy:?}") };
        for (bound, want) in bounds.into_iter().zip(want) {
            assert!((bound - want).abs() < 1e-12, "{lever:?}: {bounds:?}, not {want}");
        }
    }
}
