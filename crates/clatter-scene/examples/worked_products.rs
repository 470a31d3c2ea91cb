//! What plans save on the worked products: `cargo run --release --example worked_products -- [TOLERANCE] [RUNS]`.
//!
//! Drop by drop, where the plan is not the highest rung: the time to plan and to run the plan; that of the highest rung
//! until nothing later counts, which without contact time the plan has to tell it; and until rest. Then limit by limit:
//! each is assessed alone, by plans and by the highest rung that the product has, on one thread; the shortest of a few
//! runs counts. An assessment looks at all drops, but follows only those that may be the worst, so that both ways share
//! most of it.

use std::time::{Duration, Instant};

use clatter::End;
use clatter::flight::{Body, Scene};
use clatter_scene::plan::{BarRung, ComponentRung, Pair, Quantity, STRIKES, Setup};
use clatter_scene::{Accuracy, BarModel, Component, LimitKind, Limits, Mount, ProductFile};
use clatter_shock::{DampingRatio, Suspension};

/// Pieces of a pulse, as many as models take by themselves.
const PIECES: usize = 96;

const PRODUCTS: [&str; 3] = [
    include_str!("../../../reports/examples/phone.toml"),
    include_str!("../../../reports/examples/handheld-terminal.toml"),
    include_str!("../../../reports/examples/laptop.toml"),
];

#[expect(clippy::print_stdout, reason = "the answer of an example")]
fn main() {
    let mut arguments = std::env::args().skip(1).map(|a| a.parse::<f64>().expect("a number"));
    let tolerance = arguments.next().unwrap_or(0.01);
    let runs = arguments.next().unwrap_or(5.0);
    println!("tolerance {tolerance}: drops of which the plan is not the highest rung, times in us, ratios\n");
    for text in PRODUCTS {
        let file = ProductFile::read(text, "worked product").unwrap_or_else(|faults| panic!("{faults}"));
        let (cheaper, all, [planned, stopped, whole]) = by_drops(&file, tolerance);
        println!(
            "{:56} {cheaper:5} of {all:5} {planned:8.2} {stopped:8.2} {whole:8.2} {:7.1} {:7.1}",
            file.product.name,
            stopped / planned,
            whole / planned
        );
    }
    println!("\ntolerance {tolerance}: limit, share of the drops whose plan is the highest rung, times in ms, ratio\n");
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    one.install(|| {
        for text in PRODUCTS {
            let file = ProductFile::read(text, "worked product").unwrap_or_else(|faults| panic!("{faults}"));
            let (rung, highest) = match file.product.contact_time_s {
                Some(_) => (BarRung::Compliant, BarModel::Compliant),
                None => (BarRung::FiniteTilt, BarModel::FiniteTilt),
            };
            let time = |file: &ProductFile, model| {
                let accuracy = Accuracy { tolerance, model };
                let run = |_| {
                    let start = Instant::now();
                    file.assess_to(&accuracy).expect("a worked product");
                    start.elapsed()
                };
                let mut least = Duration::MAX;
                let mut n = 0.0;
                while n < runs {
                    least = least.min(run(n));
                    n += 1.0;
                }
                1e3 * least.as_secs_f64()
            };
            let row = |what: &str, share: f64, file: &ProductFile| {
                let (planned, whole) = (time(file, None), time(file, Some(highest)));
                println!("{what:56} {:6.1}% {planned:8.2} {whole:8.2} {:7.1}", 100.0 * share, whole / planned);
            };
            let explanation = file.explain(tolerance).expect("a worked product");
            let (mut all, mut of) = (0.0, 0.0);
            for (component, explained) in file.components.iter().zip(&explanation.components) {
                for limit in &explained.limits {
                    let of_highest = limit.shares.iter().filter(|pair| pair.bar == rung.name()).map(|pair| pair.share);
                    let share = of_highest.sum::<f64>();
                    (all, of) = (all + share, of + 1.0);
                    let alone = ProductFile { components: vec![only(component, limit.limit)], ..file.clone() };
                    row(&format!("{}: {}, {}", file.product.name, component.name, limit.limit.name()), share, &alone);
                }
            }
            row(&format!("{}: all", file.product.name), all / of, &file);
        }
    });
}

/// The component with one of its limits.
fn only(component: &Component, kind: LimitKind) -> Component {
    let all = &component.limits;
    let limits = Limits {
        acceleration_m_s2: all.acceleration_m_s2.filter(|_| kind == LimitKind::Acceleration),
        rattle_space_m: all.rattle_space_m.filter(|_| kind == LimitKind::RattleSpace),
        velocity_change_m_s: all.velocity_change_m_s.filter(|_| kind == LimitKind::VelocityChange),
        angular_velocity_change_rad_s: all
            .angular_velocity_change_rad_s
            .filter(|_| kind == LimitKind::AngularVelocityChange),
        damage_boundary: all.damage_boundary.filter(|_| kind == LimitKind::DamageBoundary),
    };
    Component { limits, ..component.clone() }
}

/// Drops whose plan is not the highest rung, all drops, and the mean times in us over the former to plan and run the
/// plan, and to run the highest rung until nothing later counts and until rest: 17 tilts, 3 restitutions, either end
/// first, the ends of each component and 3 of its frequencies.
fn by_drops(file: &ProductFile, tolerance: f64) -> (u32, u32, [f64; 3]) {
    let highest = match file.product.contact_time_s {
        Some(_) => Pair::HIGHEST,
        None => Pair { bar: BarRung::FiniteTilt, component: ComponentRung::ImpulseTrain },
    };
    let (mut cheaper, mut all, mut times) = (0, 0, [0.0; 3]);
    for (setup, quantity) in setups(file) {
        all += 1;
        let plan = |setup: &Setup| setup.plan_from(quantity, tolerance, STRIKES);
        if plan(&setup).pair != highest {
            cheaper += 1;
            let until_s = if highest == Pair::HIGHEST { f64::INFINITY } else { setup.forecast(quantity).until_s };
            times[0] += least_us(|| plan(&setup).run(&setup).expect("a planned pair"));
            times[1] += least_us(|| setup.demand(highest, quantity, until_s).expect("the highest rung"));
            let whole = || setup.demand_fine(highest, quantity, f64::INFINITY, PIECES).expect("the highest rung");
            times[2] += least_us(whole);
        }
    }
    (cheaper, all, times.map(|sum| sum / f64::from(cheaper.max(1))))
}

/// The least time of three, in us.
fn least_us(mut run: impl FnMut() -> f64) -> f64 {
    let mut least = Duration::MAX;
    for _ in 0..3 {
        let start = Instant::now();
        std::hint::black_box(run());
        least = least.min(start.elapsed());
    }
    1e6 * least.as_secs_f64()
}

fn setups(file: &ProductFile) -> Vec<(Setup, Quantity)> {
    let (product, drop) = (&file.product, &file.drop);
    let [a, b] = product.body.arms_m();
    let mut setups = Vec::new();
    for &first in drop.first_ends() {
        let arms = if first == End::A { [a, b] } else { [b, a] };
        let body = Body::off_center(arms[0], arms[1], product.body.gyration_m()).expect("as the product");
        for tilt in 0..=16 {
            let [lo, hi] = [drop.tilt_rad.lo().sqrt(), drop.tilt_rad.hi().sqrt()];
            let root = lo + f64::from(tilt) / 16.0 * (hi - lo);
            for restitution in [0.0, 0.5, 1.0] {
                let (e, tilt_deg) = (product.restitution.at(restitution), (root * root).to_degrees());
                let scene = Scene::new(body, e, drop.speeds_m_s()[1], tilt_deg, drop.gravity_m_s2).expect("a drop");
                for component in &file.components {
                    for position_m in component.ends_m() {
                        let s = product.relative(position_m);
                        let position = if first == End::A { s } else { -s };
                        for (quantity, part) in asked(component) {
                            let setup = Setup::new(scene, product.contact_time_s, position, part).expect("a part");
                            setups.push((setup, quantity));
                        }
                    }
                }
            }
        }
    }
    setups
}

/// The quantities that the limits of a component are on, with the suspension.
fn asked(component: &Component) -> Vec<(Quantity, Suspension)> {
    let limits = &component.limits;
    let any = Suspension::from_hz(100.0, DampingRatio::new(0.1).expect("in range")).expect("in range");
    let mut asked = Vec::new();
    if let Mount::Suspended { frequency_hz, damping } = component.mount {
        for share in [0.0, 0.5, 1.0] {
            let part = Suspension::from_hz(frequency_hz.at(share), damping).expect("as the product");
            asked.extend(limits.acceleration_m_s2.map(|_| (Quantity::PeakAcceleration, part)));
            asked.extend(limits.rattle_space_m.map(|_| (Quantity::RattleSpace, part)));
        }
    }
    let shocks = limits.velocity_change_m_s.is_some() || limits.damage_boundary.is_some();
    asked.extend(shocks.then_some((Quantity::VelocityShock, any)));
    asked
}
