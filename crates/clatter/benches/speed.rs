//! Wall times, each beside a plain way to the same answer in the same run: `cargo bench -p clatter --bench speed`.
//!
//! Ours and the plain way take turns, so that a machine that slows down slows both; the table gives the least time of
//! each and the median of the ratios round by round. `tests/instructions.rs` counts instructions, which repeat exactly.
#![expect(clippy::print_stdout, clippy::cast_precision_loss, reason = "a table of counts and times is what is wanted")]

use clatter::{Axis, Bar, Count, Map, Quantity, Start};
use std::hint::black_box;
use std::time::Instant;

/// Rounds of each pair.
const ROUNDS: usize = 41;

/// The loop anyone would write: count, peak, duration, final velocities in f64, cut off at 1000 impacts.
fn plain(q: f64, e: f64) -> (f64, f64, f64, [f64; 2]) {
    let t = q * (1.0 + e);
    let (mut a, mut next, mut b, mut b_next, mut n, mut peak) = (-1.0, -t - 1.0, 0.0, 1.0, 1.0, 1.0_f64);
    while next < 0.0 && n < 1000.0 {
        (a, next) = (next, t * next - e * a);
        (b, b_next) = (b_next, t * b_next - e * b);
        n += 1.0;
        peak = peak.max(-a);
    }
    (n, (1.0 + e) * peak, b / -a, [-e * a, next])
}

struct Table;

impl Table {
    fn new() -> Self {
        println!("{:44} {:>10} {:>10} {:>7}   allowed", "", "ours [ns]", "plain [ns]", "ratio");
        Self
    }
    /// `items` are done by one call of each.
    fn row<A, B>(
        &self,
        name: &str,
        items: usize,
        allowed: &str,
        mut ours: impl FnMut() -> A,
        mut plain: impl FnMut() -> B,
    ) {
        let time = |f: &mut dyn FnMut()| {
            let start = Instant::now();
            f();
            start.elapsed().as_nanos() as f64 / items as f64
        };
        let mut rounds: Vec<(f64, f64)> = (0..ROUNDS)
            .map(|_| (time(&mut || drop(black_box(ours()))), time(&mut || drop(black_box(plain())))))
            .collect();
        let least = |f: fn(&(f64, f64)) -> f64| rounds.iter().map(f).fold(f64::INFINITY, f64::min);
        let (a, b) = (least(|r| r.0), least(|r| r.1));
        rounds.sort_by(|x, y| (x.0 / x.1).total_cmp(&(y.0 / y.1)));
        let (x, y) = rounds[ROUNDS / 2];
        println!("{name:44} {a:10.2} {b:10.2} {:7.2}   {allowed}", x / y);
    }
}

fn main() {
    let start = Start::default();
    let table = Table::new();
    let summary =
        |&(q, e): &(f64, f64)| black_box(Bar::new(black_box(q), black_box(e)).map(|bar| bar.summary(&start)).is_ok());
    let naive = |&(q, e): &(f64, f64)| {
        black_box(plain(black_box(q), black_box(e)));
    };

    // The unit square, evenly at random, always the same.
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let square: Vec<(f64, f64)> = (0..20_000).map(|_| (random(), random())).collect();
    let count = |&(q, e): &(f64, f64)| Bar::new(q, e).map(|bar| bar.count(&start));
    let few: Vec<_> = square.iter().copied().filter(|p| matches!(count(p), Ok(Count::Finite(..=4)))).collect();
    let finite: Vec<_> = square.iter().copied().filter(|p| matches!(count(p), Ok(Count::Finite(_)))).collect();
    let run = |points: &Vec<(f64, f64)>| points.iter().filter(|p| summary(p)).count();
    let loops = |points: &Vec<(f64, f64)>| points.iter().for_each(naive);
    table.row("summary, unit square (plain: 1000 at most)", square.len(), "40 ns", || run(&square), || loops(&square));
    table.row("summary, where finite", finite.len(), "", || run(&finite), || loops(&finite));
    table.row("summary, up to 4 impacts", few.len(), "1.5 times", || run(&few), || loops(&few));

    let corner = |k: f64| Bar::from_gyration_ratio(k, 1.0);
    let worst = [
        ("N = 2·10^8, (1 − 2^-53, 1)", Bar::new(1.0 - f64::EPSILON / 2.0, 1.0)),
        ("N = 2·10^8, one float below endless", Bar::new(0.799_999_999_999_999_9, 0.25)),
        ("N = 2·10^9, k = 1e-9", corner(1e-9)),
        ("N = 2221, (0.999999, 1)", Bar::new(0.999_999, 1.0)),
        ("endless by one float, (0.8, 0.25)", Bar::new(0.8, 0.25)),
        ("Table 1, 4 impacts", Bar::new(0.5, 0.3)),
        ("Table 1, 16 impacts", Bar::new(0.73, 0.2)),
        ("Table 1, 31 impacts", Bar::new(0.67, 0.15)),
        ("Table 1, 24 impacts", Bar::new(0.57, 0.1)),
    ];
    for (name, bar) in worst {
        let Ok(bar) = bar else { continue };
        let (q, e) = (bar.q(), bar.e());
        let repeat = 500;
        let loops = || (0..repeat).for_each(|_| naive(&(q, e)));
        let ours = || {
            (0..repeat).for_each(|_| {
                black_box(black_box(&bar).summary(black_box(&start)));
            })
        };
        table.row(&format!("summary, {name}"), repeat, "600 ns", ours, loops);
        let ours = || {
            (0..repeat).for_each(|_| {
                black_box(black_box(&bar).count(black_box(&start)));
            })
        };
        table.row(&format!("count, {name}"), repeat, "100 ns", ours, loops);
    }

    // Trains with times: the plain way is the recurrence, which drifts.
    let sum =
        |bar: &Bar, most: usize| bar.train(&start).take(most).map(|i| i.time + i.approach + i.delta_v[0]).sum::<f64>();
    let drifting = |bar: &Bar, most: usize| {
        let (t, e) = (bar.q() * (1.0 + bar.e()), bar.e());
        let (mut a, mut next, mut b, mut b_next, mut sum) = (-1.0, -t - 1.0, 0.0, 1.0, 0.0);
        for _ in 0..most {
            if a >= 0.0 {
                break;
            }
            sum += b / -a + a - (1.0 + e) * a;
            (a, next) = (next, t * next - e * a);
            (b, b_next) = (b_next, t * b_next - e * b);
        }
        sum
    };
    for (name, q, e, most) in [
        ("train of 4", 0.5, 0.3, 4),
        ("train of 16", 0.73, 0.2, 16),
        ("train of 31", 0.67, 0.15, 31),
        ("train of 2221", 0.999_999, 1.0, 2221),
        ("train of 2·10^8, its first 10^5", 1.0 - f64::EPSILON / 2.0, 1.0, 100_000),
        ("endless train, its first 1000", 0.9, 0.2, 1000),
    ] {
        let Ok(bar) = Bar::new(q, e) else { continue };
        let repeat = (20_000 / most).max(1);
        let ours = || (0..repeat).map(|_| sum(black_box(&bar), most)).sum::<f64>();
        let loops = || (0..repeat).map(|_| drifting(black_box(&bar), most)).sum::<f64>();
        table.row(&format!("{name}, an impact"), repeat * most, "2.5 ns", ours, loops);
    }

    // The map, one thread, against a copy of its result.
    let axes = (Axis::q(0.0, 1.0, 1000), Axis::e(0.0, 1.0, 1000));
    let (Ok(q), Ok(e)) = axes else { return };
    let Ok(one) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else { return };
    let Ok(map) = Map::compute(Quantity::PeakEnd, q, e) else { return };
    let mut copy = vec![0.0; map.values.len()];
    let points = map.values.len();
    table.row(
        "map of the peak, 1000 × 1000, a point",
        points,
        "3 times a copy",
        || one.install(|| Map::compute(Quantity::PeakEnd, q, e).is_ok()),
        || {
            copy.copy_from_slice(black_box(&map.values));
            copy[black_box(17)]
        },
    );
    table.row(
        "map of the count, 1000 × 1000, a point",
        points,
        "",
        || one.install(|| Map::compute(Quantity::Impacts, q, e).is_ok()),
        || {
            copy.copy_from_slice(black_box(&map.values));
            copy[black_box(17)]
        },
    );
}
