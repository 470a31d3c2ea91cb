use clatter::*;
use std::hint::black_box;
use std::time::Instant;
fn plain(q: f64, e: f64) -> (f64, f64, f64, f64) {
    let t = q * (1.0 + e);
    let (mut a, mut next, mut b, mut bn, mut n, mut big) = (-1.0, -t - 1.0, 0.0, 1.0, 1.0, 1.0f64);
    while next < 0.0 && n < 1000.0 {
        (a, next) = (next, t * next - e * a);
        (b, bn) = (bn, t * bn - e * b);
        n += 1.0;
        big = big.max(-a);
    }
    (n, (1.0 + e) * big, next, b / -a)
}
fn time(name: &str, n: usize, mut f: impl FnMut()) {
    let mut best = f64::INFINITY;
    for _ in 0..15 {
        let t = Instant::now();
        f();
        best = best.min(t.elapsed().as_nanos() as f64 / n as f64);
    }
    println!("{name:40} {best:8.2} ns");
}
fn main() {
    let n = 100_000;
    let mut r = 12345u64;
    let mut rnd = || { r = r.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (r >> 11) as f64 / (1u64 << 53) as f64 };
    let pts: Vec<(f64, f64)> = (0..n).map(|_| (rnd(), rnd())).collect();
    let s = Start::default();
    time("summary unit square", n, || for &(q, e) in &pts { black_box(Bar::new(black_box(q), black_box(e)).unwrap().summary(black_box(&s))); });
    time("count unit square", n, || for &(q, e) in &pts { black_box(Bar::new(black_box(q), black_box(e)).unwrap().count(black_box(&s))); });
    time("peak unit square", n, || for &(q, e) in &pts { black_box(Bar::new(black_box(q), black_box(e)).unwrap().peak(black_box(&s))); });
    time("plain unit square", n, || for &(q, e) in &pts { black_box(plain(black_box(q), black_box(e))); });
    let few: Vec<(f64, f64)> = pts.iter().copied().filter(|&(q, e)| matches!(Bar::new(q, e).unwrap().count(&s), Count::Finite(n) if n <= 4)).collect();
    time("summary N<=4", few.len(), || for &(q, e) in &few { black_box(Bar::new(black_box(q), black_box(e)).unwrap().summary(black_box(&s))); });
    time("plain N<=4", few.len(), || for &(q, e) in &few { black_box(plain(black_box(q), black_box(e))); });
    let end: Vec<(f64, f64)> = pts.iter().copied().filter(|&(q, e)| matches!(Bar::new(q, e).unwrap().count(&s), Count::Endless)).collect();
    time("summary endless", end.len(), || for &(q, e) in &end { black_box(Bar::new(black_box(q), black_box(e)).unwrap().summary(black_box(&s))); });
    let long: Vec<(f64, f64)> = pts.iter().copied().filter(|&(q, e)| matches!(Bar::new(q, e).unwrap().count(&s), Count::Finite(n) if n > 16)).collect();
    println!("{} few {} endless {} long", few.len(), end.len(), long.len());
    time("summary long", long.len(), || for &(q, e) in &long { black_box(Bar::new(black_box(q), black_box(e)).unwrap().summary(black_box(&s))); });
    for (q, e) in [(0.9999999999999999, 1.0), (0.7999999999999999, 0.25), (0.9999999999999999, 0.99999999), (0.999999, 1.0), (0.8, 0.25), (1.0, 0.3), (0.5,0.3),(0.73,0.2),(0.57,0.1)] {
        let b = Bar::new(q, e).unwrap();
        time(&format!("summary {q} {e}"), 1000, || for _ in 0..1000 { black_box(black_box(b).summary(black_box(&s))); });
        time(&format!("count {q} {e}"), 1000, || for _ in 0..1000 { black_box(black_box(b).count(black_box(&s))); });
    }
}
