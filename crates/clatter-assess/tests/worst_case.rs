//! The worst drop of random products against thousands of single drops of the same ranges, by the same engine.
//!
//! For a long run: `PRODUCTS=200 SINGLES=4000 SEED=2 cargo test --release -p clatter-assess --test all worst_case:: -- --nocapture`.

#![expect(clippy::print_stdout, reason = "a long run tells what it found")]

use std::f64::consts::TAU;
use std::fmt::Write as _;

use crate::random::Random;
use clatter::End;
use clatter_assess::{LimitAssessment, Part, Verdict, answer};
use clatter_product::{Component, Drop, Limit, Model, Mount, Place, ProductFile, Side};
use clatter_shock::{DampingRatio, Suspension};
use rayon::prelude::*;

fn one_of<T: Copy>(r: &mut Random, list: &[T]) -> T {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "few")]
    let n = (r.unit() * list.len() as f64) as usize;
    list[n.min(list.len() - 1)]
}

/// A bar of 60 to 400 mm, contacts of 0.1 to 1.5 ms, tilts of 0 to 15°; a hard part and two suspended ones, of one natural
/// frequency or up to a decade, with a damping ratio from 0.003.
fn bar(r: &mut Random) -> ProductFile {
    product(r, false)
}

/// The same of a plate, from a third as wide as it is long to a square.
fn plate(r: &mut Random) -> ProductFile {
    product(r, true)
}

fn product(r: &mut Random, is_plate: bool) -> ProductFile {
    let length = r.decades(60.0, 400.0);
    let width = if is_plate { r.even(0.33, 1.0) * length } else { 0.0 };
    let q = r.even(-0.2, 0.8);
    let gyration = 0.5 * length * ((1.0 - q) / (1.0 + q)).sqrt();
    let center = if r.unit() < 0.5 { 0.0 } else { r.even(-0.07, 0.07) * length };
    // No masses within the body have a larger one.
    let gyration = gyration.min((0.25 * length * length - center * center).sqrt());
    let across = is_plate.then(|| {
        let center = if r.unit() < 0.5 { 0.0 } else { r.even(-0.07, 0.07) * width };
        let turned = r.unit() < 0.3;
        (r.even(0.2, 0.4) * width, center, turned.then(|| [r.even(0.0, 360.0), r.even(0.0, 360.0)]))
    });
    let e = r.even(0.02, 0.7);
    let e = [e, (e + r.even(0.0, 0.25)).min(0.9)];
    let contact = r.decades(0.1, 1.5);
    let contact = [contact, (contact * r.even(0.0, 2.0).max(1.0)).min(1.5)];
    let mut tilt = [r.even(0.0, 15.0), r.even(0.0, 15.0)];
    tilt.sort_by(f64::total_cmp);
    let height = r.decades(0.2, 2.0);
    let height = [height, height * r.even(1.0, 1.5)];
    let first = one_of(r, &["a", "b", "either"]);
    let list = |[lo, hi]: [f64; 2], unit: &str| format!("[\"{lo:.9} {unit}\", \"{hi:.9} {unit}\"]");
    let body = match across {
        Some((gyration_across, center_across, _)) => format!(
            "width = \"{width:.9} mm\"\nradius_of_gyration = {}\ncenter_of_mass = {}",
            list([gyration, gyration_across], "mm"),
            list([center, center_across], "mm")
        ),
        None => format!("radius_of_gyration = \"{gyration:.9} mm\"\ncenter_of_mass = \"{center:.9} mm\""),
    };
    let start = match across {
        Some((.., Some([a, b]))) => format!("direction = {}", list([a.min(b), a.max(b)], "deg")),
        Some((.., None)) => String::new(),
        None => format!("first = \"{first}\""),
    };
    let mut text = format!(
        "[product]\nname = \"random\"\nlength = \"{length:.9} mm\"\n{body}\nrestitution = [{:.9}, {:.9}]\ncontact_time = {}\n\
         [drop]\nheight = {}\ntilt = {}\n{start}\n",
        e[0],
        e[1],
        list(contact, "ms"),
        list(height, "m"),
        list(tilt, "deg"),
    );
    let speed = (2.0 * 9.8 * height[1]).sqrt();
    let mut part = |r: &mut Random, name: &str, lines: &str| {
        let mut place = |size: f64| (r.even(-0.45, 0.45) * size, r.even(-0.1, 0.1).max(0.0) * size);
        let (position, extent) = place(length);
        let (position, extent) = if is_plate {
            let (across, extent_across) = place(width);
            (list([position, across], "mm"), list([extent, extent_across], "mm"))
        } else {
            (format!("\"{position:.9} mm\""), format!("\"{extent:.9} mm\""))
        };
        let _ = write!(text, "[[component]]\nname = \"{name}\"\nposition = {position}\nextent = {extent}\n{lines}\n");
    };
    let stands = r.decades(0.5, 2.0) * speed;
    let hard = [
        format!("velocity_change_limit = \"{stands:.6} m/s\""),
        format!("acceleration_limit = \"{:.6} m/s2\"", stands * 1570.0 / contact[0]),
        format!("angular_velocity_change_limit = \"{:.6} rad/s\"", 2000.0 * stands / length),
    ];
    let hard = format!("mount = \"hard\"\n{}", one_of(r, &[0, 1, 2].map(|n| hard[n].as_str())));
    part(r, "hard", &hard);
    for name in ["soft", "stiff"] {
        let frequency = r.decades(10.0, 3000.0);
        let frequency = [frequency, frequency * one_of(r, &[1.0, 1.2, 10.0])];
        let stands = r.decades(0.5, 2.0) * speed;
        let limit = if r.unit() < 0.5 {
            format!("acceleration_limit = \"{:.6} m/s2\"", TAU * frequency[1] * stands)
        } else {
            format!("rattle_space = \"{:.6} mm\"", 1e3 * stands / (TAU * frequency[0]))
        };
        let lines = format!(
            "natural_frequency = {}\ndamping_ratio = {:.9}\n{limit}",
            list(frequency, "Hz"),
            r.decades(0.003, 0.5)
        );
        part(r, name, &lines);
    }
    ProductFile::read(&text, "random").unwrap_or_else(|faults| panic!("{faults}\n{text}"))
}

/// Of the box at real tilt, over its length.
const THICKNESS: f64 = 0.05;

/// Shares of the ranges of tilt, speed, restitution, contact time, frequency, position and direction, and the end that is first.
type Shares = ([f64; 7], f64);

/// Anywhere in the ranges, at their ends as often as not; some close to the worst that was found.
fn shares(r: &mut Random, near: Option<&Shares>) -> Shares {
    let ends = r.unit() < 0.5;
    let each = std::array::from_fn(|i| {
        let any = match r.unit() {
            x if ends && x < 0.25 => 0.0,
            x if ends && x < 0.5 => 1.0,
            _ => r.unit(),
        };
        near.map_or(any, |(near, _)| if i == 5 { near[i] } else { (near[i] + 0.05 * (any - 0.5)).clamp(0.0, 1.0) })
    });
    (each, near.map_or_else(|| r.unit(), |(_, first)| *first))
}

/// What a single drop asks of a limit, as a utilization; those that no model takes ask nothing.
fn single(
    file: &ProductFile,
    component: &Component,
    limit: &Limit,
    at_real_tilt: bool,
    (shares, first): &Shares,
) -> (f64, String) {
    let ends = file.drop.first_ends();
    let [slow, fast] = file.drop.speeds_m_s();
    let [from, to] = file.drop.direction_rad.map_or([0.0, TAU], |direction| [direction.lo(), direction.hi()]);
    let first = if ends.len() > 1 && *first < 0.5 { End::B } else { ends[0] };
    let body = file.product.body;
    let drop = Drop {
        is_level: !at_real_tilt,
        direction_rad: if body.is_wide() { from + shares[6] * (to - from) } else { Drop::towards(first) },
        gravity_m_s2: file.drop.gravity_m_s2,
        contact_time_s: file.product.contact_time_s.map(|time| time.at(shares[3])),
        contact_law: file.product.law(),
        ..Drop::new(
            body.with_thickness(Side::even(THICKNESS * body.length_m())),
            slow + shares[1] * (fast - slow),
            file.drop.tilt_rad.at(shares[0]),
            file.product.restitution.at(shares[2]),
        )
    };
    let suspension = match component.mount {
        Mount::Suspended { frequency_hz, damping } => {
            let ratio = DampingRatio::new(damping.ratios()[0]).expect("a ratio");
            Some(Suspension::from_hz(frequency_hz.at(shares[4]), ratio).expect("a part"))
        }
        Mount::Hard => None,
    };
    let places = component.ends_m();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "few")]
    let at_m = places[((shares[5] * places.len() as f64) as usize).min(places.len() - 1)];
    let asked = answer(&drop, &Part::at(Place::flat(at_m), suspension), limit, Model::Compliant, 0.01);
    match asked {
        Ok(asked) => (asked.utilization(), format!("{drop:?}, at {at_m:?} m, {suspension:?}: {asked:?}")),
        Err(_) => (0.0, String::new()),
    }
}

/// A limit of a random product: how it was told, and by how much the worst of the single drops passes it.
struct Claimed {
    limit: LimitAssessment,
    over: f64,
    by: String,
}

fn told(file: &ProductFile, r: &mut Random, singles: usize, at_real_tilt: bool) -> (f64, Vec<Claimed>) {
    let begun = std::time::Instant::now();
    let assessment = clatter_assess::assess(file).expect("an assessment");
    let took_s = begun.elapsed().as_secs_f64();
    let mut told = Vec::new();
    for (component, assessed) in file.components.iter().zip(assessment.components) {
        for (limit, assessed) in Limit::of(component).into_iter().zip(assessed.limits) {
            let list: Vec<Shares> = (0..singles).map(|_| shares(r, None)).collect();
            let worst = |list: &[Shares]| {
                let all = list.par_iter().map(|at| (single(file, component, &limit, at_real_tilt, at), *at));
                all.reduce_with(|a, b| if b.0.0 > a.0.0 { b } else { a }).expect("single drops")
            };
            let far = worst(&list);
            let near: Vec<Shares> = (0..singles / 4).map(|_| shares(r, Some(&far.1))).collect();
            let ((most, by), _) =
                [far, worst(&near)].into_iter().reduce(|a, b| if b.0.0 > a.0.0 { b } else { a }).expect("two");
            let over = most / (assessed.demand.expect("an answer") / assessed.allowed) - 1.0;
            told.push(Claimed { limit: assessed, over, by });
        }
    }
    (took_s, told)
}

fn setting(name: &str, default: usize) -> usize {
    std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

/// No single drop passes the demand by more than what is told, 2 % as a rule; where rebounds ask most it is told that they
/// may do more. Few limits are undecided.
#[test]
fn no_single_drop_is_worse() {
    none_is_worse(bar, [10, 200], 10, false);
}

#[test]
fn no_single_drop_of_a_plate_is_worse() {
    // What rebounds may ask by their energy is more: it turns about two axes.
    none_is_worse(plate, [2, 50], 4, false);
}

/// The same at real tilt: of a box of small thickness with full rotation, by another integration.
#[test]
fn no_single_drop_of_a_box_at_real_tilt_is_worse() {
    none_is_worse(plate, [2, 30], 4, true);
}

/// Of so many limits at most one is undecided.
fn none_is_worse(
    product: fn(&mut Random) -> ProductFile,
    [products, singles]: [usize; 2],
    one_of: usize,
    at_real_tilt: bool,
) {
    let (products, singles, seed) = (setting("PRODUCTS", products), setting("SINGLES", singles), setting("SEED", 1));
    let (mut limits, mut passed, mut passed_more, mut undecided) = (0, 0, 0, 0);
    let (mut slowest, mut all) = (0.0_f64, 0.0);
    for n in 0..products {
        let mut r = Random(((seed as u64) << 32) + n as u64);
        let file = product(&mut r);
        let (took_s, told) = told(&file, &mut r, singles, at_real_tilt);
        (slowest, all) = (slowest.max(took_s), all + took_s);
        for Claimed { limit, over, by } in told {
            limits += 1;
            undecided += usize::from(limit.verdict == Verdict::Undecided);
            passed += usize::from(over > 0.02);
            passed_more += usize::from(over > limit.uncertainty);
            if over > 0.02 {
                let LimitAssessment { limit: kind, uncertainty, worst_case, .. } = &limit;
                println!(
                    "product {n}, {kind:?}: passed by {over:.3}, told {uncertainty:.3}, by {by}, found {worst_case:?}"
                );
            }
        }
    }
    println!(
        "{limits} limits: {passed} passed by more than 2 %, {passed_more} by more than was told; {undecided} undecided"
    );
    println!(
        "an assessment took {:.0} ms, the slowest {:.0} ms",
        1e3 * all / f64::from(u32::try_from(products).expect("a few")),
        1e3 * slowest
    );
    assert!(passed_more == 0, "{passed_more} of {limits} passed by more than was told");
    // What real tilt adds is told, and may be more.
    assert!(at_real_tilt || passed * 20 <= limits, "{passed} of {limits} passed by more than 2 %");
    assert!(undecided * one_of <= limits, "{undecided} of {limits} undecided");
}
