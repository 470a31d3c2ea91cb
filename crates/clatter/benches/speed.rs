//! Wall times, each beside a plain way to the same answer in the same run: `cargo bench -p clatter --bench speed`.
//!
//! Ours and the plain way take turns, so that a machine that slows down slows both; the table gives the least time of
//! each and the median of the ratios round by round. The bench `instructions` counts instructions, which repeat
//! exactly.
#![expect(clippy::print_stdout, clippy::cast_precision_loss, reason = "a table of counts and times is what is wanted")]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use clatter::{Axis, Bar, Count, Impact, Map, Plate, PlateStart, Quantity, Start};
use std::hint::black_box;
use std::time::Instant;

/// Rounds of each pair.
const ROUNDS: usize = 41;

/// Runs the loop anyone would write: count, peak, duration, final velocities in f64, cut off at 1000 impacts.
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

/// Times both, in turns, and prints a line; one call of each does `items`.
fn row<A, B>(name: &str, items: usize, allowed: &str, mut ours: impl FnMut() -> A, mut plain: impl FnMut() -> B) {
    let time = |f: &mut dyn FnMut()| {
        let start = Instant::now();
        f();
        start.elapsed().as_nanos() as f64 / items as f64
    };
    let mut rounds: Vec<(f64, f64)> =
        (0..ROUNDS).map(|_| (time(&mut || drop(black_box(ours()))), time(&mut || drop(black_box(plain()))))).collect();
    let least = |f: fn(&(f64, f64)) -> f64| rounds.iter().map(f).fold(f64::INFINITY, f64::min);
    let (a, b) = (least(|r| r.0), least(|r| r.1));
    rounds.sort_by(|x, y| (x.0 / x.1).total_cmp(&(y.0 / y.1)));
    let (x, y) = rounds[ROUNDS / 2];
    println!("{name:44} {a:10.2} {b:10.2} {:7.2}   {allowed}", x / y);
}

/// Returns a bar whose q and e are known to be in range.
fn bar(q: f64, e: f64) -> Bar {
    Bar::new(q, e).expect("q and e in range")
}

/// Runs the plain loop. Its result stays in place, as ours does: no copy of it is timed.
fn naive(q: f64, e: f64) {
    black_box(&plain(black_box(q), black_box(e)));
}

/// Returns numbers in [0, 1), always the same.
fn random() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Returns points of the unit square, evenly at random, so many that no branch predictor knows the counts by heart,
/// round after round.
fn square() -> Vec<(f64, f64)> {
    let mut random = random();
    (0..300_000).map(|_| (random(), random())).collect()
}

/// Summaries of bars made on the spot.
fn summaries() {
    let start = Start::default();
    let square = square();
    let finite =
        |most: u64| move |&&(q, e): &&(f64, f64)| matches!(bar(q, e).count(&start), Count::Finite(n) if n <= most);
    for (name, points, allowed) in [
        ("summary, unit square (plain: 1000 at most)", square.clone(), "40 ns"),
        ("summary, where finite", square.iter().filter(finite(u64::MAX)).copied().collect(), ""),
        ("summary, up to 4 impacts", square.iter().filter(finite(4)).copied().collect(), "1.5 times"),
    ] {
        let ours = || {
            for &(q, e) in &points {
                black_box(&bar(black_box(q), black_box(e)).summary(black_box(&start)));
            }
        };
        row(name, points.len(), allowed, ours, || points.iter().for_each(|&(q, e)| naive(q, e)));
    }
}

/// Times long and awkward trains, which take constant time; the plain loop gives up after 1000 impacts.
fn long_trains() {
    let start = Start::default();
    for (name, bar) in [
        ("N = 2·10^8, (1 − 2^-53, 1)", bar(1.0 - f64::EPSILON / 2.0, 1.0)),
        ("N = 2·10^8, one float below endless", bar(0.799_999_999_999_999_9, 0.25)),
        ("N = 2·10^9, k = 1e-9", Bar::from_gyration_ratio(1e-9, 1.0).expect("k in range")),
        ("N = 2221, (0.999999, 1)", bar(0.999_999, 1.0)),
        ("endless by one float, (0.8, 0.25)", bar(0.8, 0.25)),
        ("Table 1, 4 impacts", bar(0.5, 0.3)),
        ("Table 1, 16 impacts", bar(0.73, 0.2)),
        ("Table 1, 31 impacts", bar(0.67, 0.15)),
        ("Table 1, 24 impacts", bar(0.57, 0.1)),
    ] {
        let repeat = 500;
        let loops = || (0..repeat).for_each(|_| naive(bar.q(), bar.e()));
        let summary = || {
            (0..repeat).for_each(|_| {
                black_box(&black_box(&bar).summary(black_box(&start)));
            });
        };
        row(&format!("summary, {name}"), repeat, "600 ns", summary, loops);
        let count = || {
            (0..repeat).for_each(|_| {
                black_box(black_box(&bar).count(black_box(&start)));
            });
        };
        row(&format!("count, {name}"), repeat, "100 ns", count, loops);
    }
}

/// Counts and summaries of random bars beyond 32 impacts, each timed by itself: half of them anywhere or in the corner
/// (1, 1), half beside the endless curve.
fn singly() {
    const BARS: usize = 2000;
    let start = Start::default();
    let mut random = random();
    let mut times = Vec::with_capacity(BARS);
    while times.len() < BARS {
        let (kind, x, e) = (random(), random(), random());
        let curve = |e: f64| 2.0 * e.sqrt() / (1.0 + e);
        let (q, e) = match kind {
            _ if kind < 0.3 => (x, e),
            _ if kind < 0.5 => (1.0 - 10f64.powf(-16.0 * x), 1.0 - 10f64.powf(-16.0 * e)),
            _ if kind < 0.8 => (curve(e) * (1.0 - 10f64.powf(-17.0 * x)), e),
            _ => (curve(e) * (1.0 + f64::EPSILON * (4.0 * x - 2.0)), e),
        };
        let bar = bar(q.min(1.0), e);
        if matches!(bar.count(&start), Count::Finite(n) if n <= 32) {
            continue;
        }
        let least = |f: &dyn Fn()| {
            let time = |_| {
                let begin = Instant::now();
                (0..50).for_each(|_| f());
                begin.elapsed().as_nanos() as f64 / 50.0
            };
            (0..15).map(time).fold(f64::INFINITY, f64::min)
        };
        times.push([
            least(&|| {
                black_box(black_box(&bar).count(black_box(&start)));
            }),
            least(&|| {
                black_box(&black_box(&bar).summary(black_box(&start)));
            }),
        ]);
    }
    println!("\nof {BARS} random bars beyond 32 impacts  mean      99 %     worst   above what is allowed");
    for (k, (name, allowed)) in [("count", 100.0), ("summary", 600.0)].into_iter().enumerate() {
        times.sort_by(|a, b| a[k].total_cmp(&b[k]));
        let mean = times.iter().map(|t| t[k]).sum::<f64>() / BARS as f64;
        let above = 100.0 * times.iter().filter(|t| t[k] > allowed).count() as f64 / BARS as f64;
        let [most, worst] = [times[BARS * 99 / 100][k], times[BARS - 1][k]];
        println!("{name:30} {mean:10.2} {most:9.2} {worst:9.2}   {above:.1} % above {allowed} ns");
    }
    println!();
}

/// Trains with times, written into a list: the plain way is the recurrence, which drifts.
fn trains() {
    let start = Start::default();
    let put = |row: &mut [f64; 3], impact: Impact| *row = [impact.time, impact.approach, impact.delta_v[0]];
    let one_by_one = |bar: &Bar, list: &mut [[f64; 3]]| {
        list.iter_mut().zip(bar.train(&start)).for_each(|(row, impact)| put(row, impact));
    };
    let whole = |bar: &Bar, list: &mut [[f64; 3]]| {
        bar.train(&start).fold(0, |n, impact| {
            list.get_mut(n).into_iter().for_each(|row| put(row, impact));
            n + 1
        });
    };
    let drifting = |bar: &Bar, list: &mut [[f64; 3]]| {
        let (t, e, q) = (bar.q() * (1.0 + bar.e()), bar.e(), bar.q());
        let (mut a, mut next, mut b, mut b_next) = (-1.0, -t - 1.0, 0.0, 1.0);
        for (n, row) in list.iter_mut().enumerate() {
            if a >= 0.0 {
                break;
            }
            let hit = -(1.0 + e) * a;
            *row = [b / -a, a, if n % 2 == 0 { hit } else { -q * hit }];
            (a, next) = (next, t * next - e * a);
            (b, b_next) = (b_next, t * b_next - e * b);
        }
    };
    for (name, q, e, most) in [
        ("train of 4", 0.5, 0.3, 4),
        ("train of 16", 0.73, 0.2, 16),
        ("train of 31", 0.67, 0.15, 31),
        ("train of 47", 0.9978, 1.0, 47),
        ("train of 200", 0.99988, 1.0, 203),
        ("train of 2221", 0.999_999, 1.0, 2221),
        ("train of 2·10^8, its first 10^5", 1.0 - f64::EPSILON / 2.0, 1.0, 100_000),
        ("endless train, its first 1000", 0.9, 0.2, 1000),
    ] {
        let (bar, repeat) = (bar(q, e), (20_000 / most).max(1));
        let (mut one, mut other) = (vec![[0.0; 3]; most], vec![[0.0; 3]; most]);
        let mut loops = || (0..repeat).for_each(|_| drifting(black_box(&bar), black_box(&mut other)));
        let ours = || (0..repeat).for_each(|_| one_by_one(black_box(&bar), black_box(&mut one)));
        row(&format!("{name}, one by one, an impact"), repeat * most, "", ours, &mut loops);
        if bar.count(&start) == Count::Finite(most as u64) {
            // A second place that takes impacts one by one: a call for each would show here.
            let mut impacts: Vec<Impact> = Vec::with_capacity(most);
            let collect = || {
                (0..repeat).for_each(|_| {
                    impacts.clear();
                    impacts.extend(black_box(&bar).train(&start));
                    black_box(&impacts);
                });
            };
            row(&format!("{name}, collected, an impact"), repeat * most, "", collect, &mut loops);
            let ours = || (0..repeat).for_each(|_| whole(black_box(&bar), black_box(&mut one)));
            row(&format!("{name}, as a whole, an impact"), repeat * most, "2.5 ns", ours, &mut loops);
            let sums = || {
                (0..repeat).for_each(|_| {
                    black_box(black_box(&bar).train(&start).map(|impact| impact.time + impact.delta_v[0]).sum::<f64>());
                });
            };
            row(&format!("{name}, summed, an impact"), repeat * most, "2.5 ns", sums, &mut loops);
        }
    }
}

/// Maps on one thread, against a copy of their result.
fn maps() {
    let (q, e) = (Axis::q(0.0, 1.0, 1000).expect("an axis"), Axis::e(0.0, 1.0, 1000).expect("an axis"));
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    for (name, quantity, allowed) in [("peak", Quantity::PeakEnd, "3 times a copy"), ("count", Quantity::Impacts, "")] {
        let map = Map::compute(quantity, q, e).expect("8 MB");
        let compute = || one.install(|| Map::compute(quantity, q, e));
        row(&format!("map of the {name}, 1000 × 1000, a point"), 1_000_000, allowed, compute, || map.values.clone());
    }
}

/// Runs the loop anyone would write for a plate: heights and velocities in f64, from strike to strike, without a look
/// at roundings.
fn plain_plate(jump: &[[f64; 4]; 4], e: f64, [hx, hy]: [f64; 2], list: &mut [[f64; 3]]) -> usize {
    let (mut h, mut v) = ([0.0, hx, hx + hy, hy], [-1.0_f64; 4]);
    let (mut j, mut time) = (0, 0.0);
    for (n, row) in list.iter_mut().enumerate() {
        let u = v[j];
        *row = [time, u, -jump[j][0] * u];
        (0..4).for_each(|i| v[i] -= jump[j][i] * u);
        v[j] = -e * u;
        let mut wait = f64::INFINITY;
        for i in 0..4 {
            if v[i] < 0.0 && -h[i] / v[i] < wait {
                (wait, j) = (-h[i] / v[i], i);
            }
        }
        if wait.is_infinite() {
            return n + 1;
        }
        (0..4).for_each(|i| h[i] += v[i] * wait);
        (h[j], time) = (0.0, time + wait);
    }
    list.len()
}

/// Trains of plates, an impact, and atlases against one plain train in each of their words.
fn plates() {
    let mut random = random();
    for (name, k, e) in [
        ("uniform, e = 0.3", [(1.0_f64 / 3.0).sqrt(); 2], 0.3),
        ("uniform, e = 0.5", [(1.0_f64 / 3.0).sqrt(); 2], 0.5),
        ("mass in the middle, e = 0.8", [0.1, 0.15], 0.8),
    ] {
        let plate = Plate::new(k, e).expect("gyration ratios in range");
        let one = PlateStart::default();
        let own = |j: usize| plate.train(&one).find(|impact| impact.corner as usize == j);
        let [alpha, beta] = k.map(|k| 1.0 / k / k);
        let share = |x: f64, y: f64| (1.0 + e) * (1.0 + x * alpha + y * beta) / (1.0 + alpha + beta);
        let jump: [[f64; 4]; 4] = std::array::from_fn(|j| {
            let side = |i: usize| [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]][i];
            std::array::from_fn(|i| share(side(i)[0] * side(j)[0], side(i)[1] * side(j)[1]))
        });
        assert!(own(0).is_some_and(|first| (first.delta_v[2] - jump[0][2]).abs() < 1e-14), "the same plate");
        let gaps: Vec<[f64; 2]> = (0..2000).map(|_| [random(), random()]).collect();
        let starts: Vec<PlateStart> = gaps.iter().map(|gaps| PlateStart::level(*gaps).expect("gaps")).collect();
        let mut list = vec![[0.0; 3]; 400];
        let impacts = starts.iter().map(|start| plate.train(start).take(400).count()).sum();
        let ours = || {
            for start in &starts {
                for (row, impact) in list.iter_mut().zip(black_box(&plate).train(start)) {
                    *row = [impact.time, impact.approach, impact.delta_v[0]];
                }
            }
            black_box(&list);
        };
        let mut other = vec![[0.0; 3]; 400];
        let naive = || {
            for gaps in &gaps {
                black_box(plain_plate(black_box(&jump), e, *gaps, &mut other));
            }
        };
        row(&format!("plate, {name}, an impact"), impacts, "25 ns", ours, naive);
        let words = plate.atlas(40).expect("a limit in range").words().to_vec();
        let repeat = 20;
        let ours = || (0..repeat).for_each(|_| drop(black_box(black_box(&plate).atlas(40))));
        let mut other = vec![[0.0; 3]; 400];
        let naive = || {
            for word in (0..repeat).flat_map(|_| &words) {
                let r = 0.5 * (word.from + word.to);
                black_box(plain_plate(black_box(&jump), e, [1.0 - r, r], &mut other));
            }
        };
        let allowed = if (e - 0.3).abs() < 1e-9 { "20 µs" } else { "" };
        row(&format!("atlas, {name}, {} words", words.len()), repeat, allowed, ours, naive);
    }
}

fn main() {
    println!("{:44} {:>10} {:>10} {:>7}   allowed", "", "ours [ns]", "plain [ns]", "ratio");
    summaries();
    long_trains();
    singly();
    trains();
    plates();
    maps();
}
