//! What plans save on the worked products: `cargo run --release --example worked_products -- [TOLERANCE] [RUNS]`.
//!
//! Each limit is assessed alone, by plans and by the highest rung that the product has, on one thread; the shortest of a few runs counts.

use std::time::{Duration, Instant};

use clatter_scene::plan::BarRung;
use clatter_scene::{Accuracy, BarModel, Component, LimitKind, Limits, ProductFile};

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
    println!("tolerance {tolerance}: limit, share of the drops whose plan is the highest rung, times in ms, ratio\n");
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
