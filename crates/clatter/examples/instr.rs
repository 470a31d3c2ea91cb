use clatter::*;
use std::hint::black_box;
fn main() {
    let which = std::env::args().nth(1).unwrap();
    let s = Start::default();
    let pts: Vec<(f64, f64)> = (0..1000).map(|i| (0.1 + 0.5 * ((i * 37) % 1000) as f64 / 1000.0, 0.4 + 0.5 * ((i * 91) % 1000) as f64 / 1000.0)).collect();
    for _ in 0..10 {
        for &(q, e) in &pts {
            match which.as_str() {
                "summary" => { black_box(Bar::new(black_box(q), black_box(e)).unwrap().summary(black_box(&s))); }
                "new" => { black_box(Bar::new(black_box(q), black_box(e)).unwrap()); }
                "none" => { black_box((black_box(q), black_box(e))); }
                "plain" => {
    let t = q * (1.0 + e);
    let (mut a, mut next, mut b, mut bn, mut n, mut big) = (-1.0, -t - 1.0, 0.0, 1.0, 1.0, 1.0f64);
    while next < 0.0 && n < 1000.0 {
        (a, next) = (next, t * next - e * a);
        (b, bn) = (bn, t * bn - e * b);
        n += 1.0;
        big = big.max(-a);
    }
    black_box((n, (1.0 + e) * big, next, b / -a));
                }
                _ => {}
            }
        }
    }
}
