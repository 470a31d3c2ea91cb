//! speed
use clatter_record::*;
use clatter_shock::*;
fn main() {
    let n = 1_000_000;
    let mut csv = String::from("t [ms],a [g]\n");
    for i in 0..n {
        csv.push_str(&format!(
            "{:.3},{:.6}\n",
            i as f64 * 0.01,
            50.0 * (i as f64 * 0.01).sin() * (-((i as f64 - 5e5) / 2e5).powi(2)).exp()
        ));
    }
    let r = Record::read(csv.as_bytes(), &Options::default(), |_| ()).unwrap();
    let f = Frequencies::list((0..200).map(|i| 10.0 * (1000_f64).powf(i as f64 / 199.0)).collect()).unwrap();
    for _ in 0..2 {
        for b in [Between::Linear, Between::BandLimited] {
            let t = std::time::Instant::now();
            let s = r
                .spectrum(
                    &r.channels()[0],
                    &f,
                    DampingRatio::new(0.05).unwrap(),
                    Quantity::AbsoluteAcceleration,
                    b,
                    |_| (),
                )
                .unwrap();
            println!("{b:?} {:?} {}", t.elapsed(), s.maximax[100]);
        }
    }
}
