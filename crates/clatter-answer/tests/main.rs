//! Questions that no drop answers are refused with the value, and answers serialize to what programs read.

use clatter::{Axis, Bar, Plate, PlateStart, Quantity, Start};
use clatter_answer::respond::{self, Excitation};
use clatter_answer::{atlas, fit, impacts, map, simulate, spectrum, zone};
use clatter_fit::Measured;
use clatter_flight::{Block, BlockDrop, PlateScene};
use clatter_product::{Body, Drop, Model, Place, ProductFile};
use clatter_record::{Options, Record};
use clatter_shock::{DampingRatio, Pulse, Search, Shape, Suspension};
use serde_json::{Value, json};

mod answers;
mod study;

/// The same input gives the same bytes on every machine. `answers.rs` says how they are written anew; the gate runs this test natively
/// and as WebAssembly.
#[test]
fn answers_are_the_same_to_the_last_byte() {
    let (got, want) = (answers::answers().expect("answers"), include_str!("data/answers.jsonl"));
    for (n, (got, want)) in got.lines().zip(want.lines()).enumerate() {
        assert!(got == want, "line {}:\n{got}\nnot\n{want}", n + 1);
    }
    assert_eq!(got.lines().count(), want.lines().count());
}

fn bar() -> Bar {
    Bar::new(0.5, 0.3).expect("a bar")
}

fn plate() -> Plate {
    Plate::uniform(0.3).expect("a plate")
}

fn fall() -> Drop {
    Drop::new(Body::new(0.14, 0.0404).expect("a body"), 4.43, 5_f64.to_radians(), 0.3)
}

fn plate_fall() -> Drop {
    let phone = clatter_flight::Plate::new([0.075, 0.075, 0.035, 0.035], [0.0433, 0.0202]).expect("a plate");
    Drop::of_plate(&PlateScene::new(phone, 4.43, [2e-3, 1e-3], 9.806_65).expect("a drop"), 0.3).expect("a drop")
}

#[test]
fn places_off_the_body_are_refused() {
    for s in [1.5, f64::NAN, f64::INFINITY] {
        let says = |error: String| assert!(error.contains(&format!("position = {s:?}")), "{error}");
        let mut question = impacts::Question::new(bar(), Start::default());
        question.at = vec![0.0, s];
        says(impacts::answer(&question).expect_err("off the bar").to_string());
        let mut question = impacts::plate::Question::new(plate(), PlateStart::level([1.0; 2]).expect("a start"));
        question.at = vec![[0.0, s]];
        says(impacts::plate::answer(&question).expect_err("off the plate").to_string());
        for drop in [fall(), plate_fall()] {
            let mut question = simulate::Question::new(drop, Model::Map);
            question.at = vec![[s, 0.0, 0.0]];
            says(simulate::answer(&question).expect_err("off the body").to_string());
        }
    }
}

/// What shakes a part, and how fast it may swing, is checked before it is followed.
#[test]
fn parts_that_no_drop_answers_are_refused() {
    let says = |error: clatter_answer::Error, what: &str| assert!(error.to_string().contains(what), "{error}");
    let part = |omega| Suspension::new(omega, DampingRatio::new(0.1).expect("damping")).expect("a part");
    let bar = |at| Excitation::Bar { bar: Bar::new(0.5, 0.3).expect("a bar"), start: Start::default(), at };
    says(respond::answer(&respond::Question::new(bar(1.5), part(1.0))).expect_err("off the bar"), "position = 1.5");
    let pulse = Pulse { shape: Shape::HalfSine, amplitude: 1.0, duration: 1.0, start: 0.0 };
    for (omega, what) in [(1e6, "a pulse of 1.0 s"), (1e120, "natural angular frequency in rad/s = 1e120")] {
        let question = respond::Question::new(Excitation::Pulses(vec![pulse]), part(omega));
        says(respond::answer(&question).expect_err("too fast"), what);
    }
    let flat = Start::new([-1.0; 2], 0.0).expect("a start");
    let rule = respond::rule::answer(&Bar::new(0.5, 0.3).expect("a bar"), &flat, 1.0, &part(1.0));
    says(rule.expect_err("no rule"), "height gap = 0.0");
    let ask = |drop, model, place| respond::drop::Question::new(drop, model, place);
    let mut question = ask(fall(), Model::FiniteTilt, Place::flat([0.035, 0.0]));
    question.suspension = Some(part(1e13));
    says(respond::drop::answer(&question).expect_err("too fast"), "natural frequency in rad/s = 10000000000000.0");
    (question.suspension, question.places) = (None, Vec::new());
    says(respond::drop::answer(&question).expect_err("no place"), "places is empty");
    let plate = Drop { contact_time_s: Some(4e-4), ..plate_fall() };
    let mut question = ask(plate, Model::Compliant, Place::flat([0.0, 0.0525]));
    says(respond::drop::answer(&question).expect_err("off the plate"), "across the product in m is 0.0525");
    (question.places, question.suspension) = (vec![Place::flat([0.0; 2])], Some(part(1e-13)));
    says(respond::drop::answer(&question).expect_err("too slow"), "natural frequency in rad/s = 1e-13");
    let drop = Drop { spin_axis: Some([1.0, 0.0, 0.0]), spin_rad_s: 3.0, ..plate };
    let question = ask(drop, Model::Compliant, Place::flat([0.0; 2]));
    says(respond::drop::answer(&question).expect_err("no tilt of it"), "spin across the tilt in rad/s is 3.0");
    let block = Block::new([0.15, 0.07, 0.015], [0.0; 3], [0.0207, 0.0435, 0.0478]).expect("a box");
    let drop = Drop::of_block(&BlockDrop::tilted(block, 0.5, 0.0, 1.0, 9.806_65).expect("a drop"), 0.3);
    let drop = Drop { contact_time_s: Some(4e-4), ..drop };
    let mut question = ask(drop, Model::Compliant, Place { at_m: [0.0, 0.04, 0.0], axis: clatter_product::Axis::Any });
    says(respond::drop::answer(&question).expect_err("beyond the box"), "in m is 0.04");
    (question.places[0].at_m, question.suspension) = ([0.0; 3], Some(part(100.0)));
    says(respond::drop::answer(&question).expect_err("no axis"), "100.0");
}

/// Records that no fit takes, and shocks that are too few for spectra, are refused with what there is.
#[test]
fn records_that_answer_nothing_are_refused() {
    let says = |error: clatter_answer::Error, what: &str| assert!(error.to_string().contains(what), "{error}");
    let text = "time [s],x [m/s2],y [m/s2]\n0,0,0\n0.001,5,1\n0.002,0,0\n0.003,0,0\n";
    let record = Record::read(text.as_bytes(), &Options::default(), |_| ()).expect("a record");
    says(fit::Data::acceleration(&record, 0.0).expect_err("two channels"), "2 channels");
    let whole = spectrum::Measured { file: "x.csv".to_owned(), name: None, record, shock: None };
    let search = Search { threshold_m_s2: Some(100.0), quiet_s: 0.1 };
    says(whole.apart(&search).expect_err("no shock"), "0 shocks beyond 100.0 m/s2");
    let file =
        ProductFile::read(include_str!("../../../tests/cases/bar-handheld.toml"), "bar.toml").expect("a product");
    let one = |data| fit::Record { name: "x.csv".to_owned(), data };
    let [bounces, strikes] = [
        fit::Data::Bounces(vec![0.0, 0.4, 0.6]),
        fit::Data::Measured(Measured::Strikes { strikes: Vec::new(), deviation_s: None }),
    ]
    .map(one);
    let question = fit::Question::new(&file, vec![bounces, strikes]);
    says(fit::answer(&question).expect_err("two drops"), "of another drop");
    let mut range = file.clone();
    range.product.gyration_m = clatter_product::Spread::new(0.05, 0.06, clatter_product::Law::Range).expect("a range");
    let mut question = fit::Question::new(&range, Vec::new());
    question.gyration_known = true;
    says(fit::answer(&question).expect_err("not known"), "0.05 to 0.06 m");
    // A plate lands on corners; flat it bounces as any body does.
    let mut plate = file.clone();
    let width = clatter_product::Side { ends_m: [0.035; 2], gyration_m: 0.02 };
    plate.product.body = plate.product.body.with_width(width);
    let strikes = fit::Data::Measured(Measured::Strikes { strikes: Vec::new(), deviation_s: None });
    let question = fit::Question::new(&plate, vec![one(strikes)]);
    says(
        fit::answer(&question).expect_err("a plate"),
        "on one of its edges, so that it moves as one, and give it without `width`",
    );
    let question = fit::Question::new(&plate, vec![one(fit::Data::Bounces(vec![0.0, 0.4, 0.6, 0.7]))]);
    assert!(fit::answer(&question).is_ok());
}

/// Seen from the end that strikes second, a drop is the same: places and ends change their names alone.
#[test]
fn the_end_that_strikes_first_only_names_the_ends() {
    let of = |first, at_m| {
        let drop = Drop { direction_rad: Drop::towards(first), ..fall() };
        let question = respond::drop::Question::new(drop, Model::FiniteTilt, Place::flat([at_m, 0.0]));
        let answer = respond::drop::answer(&question).expect("an answer");
        (answer.drop.drop.lowest(), answer.place.velocity_change_m_s.0)
    };
    let (a, b) = (of(clatter::End::A, 0.049), of(clatter::End::B, -0.049));
    assert_eq!((a.0, b.0, a.1), ("a", "b", b.1));
}

#[test]
fn thresholds_that_are_no_velocity_are_refused() {
    for x in [0.0, -1.0, f64::NAN, 1e151] {
        let says =
            |error: clatter::Error| assert!(error.to_string().contains(&format!("threshold = {x:?}")), "{error}");
        says(zone::answer(&zone::Question::new(bar(), vec![1.0, x])).expect_err("no threshold"));
        says(zone::plate::answer(&zone::plate::Question::new(plate(), vec![x])).expect_err("no threshold"));
        let (q, e) = (Axis::q(0.0, 1.0, 2).expect("an axis"), Axis::e(0.0, 1.0, 2).expect("an axis"));
        says(map::answer(&map::Question::new(Quantity::Zone(x), q, e)).expect_err("no threshold"));
    }
}

#[test]
fn other_bad_questions_are_refused() {
    let mut question = atlas::Question::new(plate());
    question.limit = 101;
    assert!(atlas::answer(&question).expect_err("too many").to_string().contains("101"));
    for drop in [fall(), plate_fall()] {
        let question = simulate::Question::new(Drop { restitution: 1.5, ..drop }, Model::Map);
        assert!(simulate::answer(&question).expect_err("no restitution").to_string().contains("1.5"));
    }
    let question = simulate::Question::new(plate_fall(), Model::FiniteTilt);
    assert!(simulate::answer(&question).expect_err("no such model").to_string().contains("finite-tilt follows bars"));
}

/// By hand: the first strike of a uniform bar with e = 0.3 changes the velocities of its ends by 1.3 and −0.65.
#[test]
fn an_answer_is_what_programs_read() {
    let question = impacts::Question::new(bar(), Start::default());
    let got = serde_json::to_value(impacts::answer(&question).expect("an answer")).expect("JSON");
    assert_eq!(
        (&got["count"], &got["q"], &got["impacts"][0]["delta_v"]),
        (&json!(4), &json!(0.5), &json!([1.3, -0.65]))
    );
    assert!(got.get("center_of_mass").is_none(), "a bar whose center of mass is the middle tells none");
}

/// What a body at rest leaves out is told, and null where nothing bounds it; a contact that a limit cuts off has no shock.
#[test]
fn what_is_not_known_is_null() {
    let of = |time_limit_s| {
        let drop = Drop { contact_time_s: Some(1e-3), ..fall() };
        let mut question = simulate::Question::new(drop, Model::Compliant);
        question.time_limit_s = time_limit_s;
        serde_json::to_value(simulate::answer(&question).expect("an answer")).expect("JSON")
    };
    let rests = of(None);
    assert_eq!((&rests["stop"]["reason"], &rests["stop"]["time_bound_s"]), (&json!("at-rest"), &Value::Null));
    assert!(rests["stop"]["shock_bound_m_s"].is_number());
    let cut = of(Some(5e-4));
    let last = &cut["impacts"][0];
    assert_eq!((&last["unfinished"], &last["delta_v_m_s"]), (&json!(true), &json!([null, null])), "{cut}");
}

/// The rows of a motion follow the answer, and begin at the first touch.
#[test]
fn the_history_follows_the_answer() {
    let answer = simulate::answer(&simulate::Question::new(fall(), Model::FiniteTilt)).expect("an answer");
    let (alone, whole) = (serde_json::to_value(&answer), serde_json::to_value(answer.with_history().expect("a bar")));
    let (alone, mut whole) = (alone.expect("JSON"), whole.expect("JSON"));
    let rows = whole.as_object_mut().and_then(|whole| whole.remove("history")).expect("rows");
    assert_eq!(whole, alone);
    assert_eq!((&rows[0]["time_s"], &rows[0]["velocity_m_s"]), (&json!(0.0), &json!([-4.43, -4.43])));
}
