//! tries files
use clatter_record::{Options, Record};
fn main() {
    let units = std::env::var("UNITS").ok().map(|u| u.parse().unwrap());
    for path in std::env::args().skip(1) {
        let options = Options {
            units: units.clone(),
            skip_bad: std::env::var("SKIP").is_ok(),
            sample_rate_hz: std::env::var("RATE").ok().map(|r| r.parse().unwrap()),
            ..Options::default()
        };
        let begin = std::time::Instant::now();
        match Record::read(std::fs::File::open(&path).unwrap(), &options, |_| ()) {
            Ok(r) => {
                println!(
                    "{path}: {} samples, start {:?}, step {:?} {:?}",
                    r.samples(),
                    r.start_s(),
                    r.step_s(),
                    begin.elapsed()
                );
                for c in r.channels() {
                    println!(
                        "    {} [{}] largest {}",
                        c.name,
                        c.unit,
                        c.values.iter().fold(0.0_f64, |m, a| m.max(a.abs()))
                    );
                }
                for f in r.findings(10.0) {
                    println!("    ! {f}");
                }
            }
            Err(e) => println!("{path}: ERROR {e}"),
        }
    }
}
