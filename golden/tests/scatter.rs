//! What scatter says of a product.

#![cfg(test)]

use std::fmt::Write as _;

use clatter_assess::ProductFile;
use clatter_assess::scatter::{Sampler, Settings};

fn golden(name: &str, text: &str) {
    insta::with_settings!(
        { snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true },
        { insta::assert_snapshot!(name, text) }
    );
}

const LAPTOP: &str = r#"
[product]
name = "Laptop"
length = "300 mm"
radius_of_gyration = "90 mm"
restitution = { uniform = [0.25, 0.4] }
[drop]
height = { normal = ["0.8 m", "0.1 m"], range = ["0.5 m", "1 m"] }
tilt = { triangular = ["0.5 deg", "0.8 deg", "1.5 deg"] }
first = "either"
[[component]]
name = "panel"
position = "20 mm"
extent = "20 mm"
mount = "hard"
velocity_change_limit = "3.4 m/s"
[[component]]
name = "drive"
position = "60 mm"
natural_frequency = { uniform = ["36 Hz", "44 Hz"] }
damping_ratio = 0.1
acceleration_limit = "110 gn"
"#;

/// Counts of failures are the same on any machine: the generator counts in integers, and sines come from `libm`.
#[test]
fn scatter_of_a_laptop() {
    let file = ProductFile::read(LAPTOP, "laptop.toml").unwrap();
    let settings = Settings { samples: 20_000, seed: 1, confidence: 0.95 };
    let scatter = Sampler::new(&file, settings).unwrap().run::<()>(false, |_| Ok(())).unwrap();
    let mut text = String::new();
    for part in scatter.components {
        let p = part.survival;
        let _ = writeln!(text, "{}: {} of 20000 fail", part.name, part.failures);
        let _ =
            writeln!(text, "  survives {:.5} in [{:.5}, {:.5}], at least {:.5}", p.estimate, p.lo, p.hi, p.at_least);
        let _ = writeln!(text, "  utilization {:.5} ± {:.5}", part.mean_utilization, part.utilization_deviation);
        for driver in part.drivers {
            let share = driver.share;
            let _ = writeln!(text, "  {:<18} {:.3} {:+.3}", driver.input.name(), share.variance, share.trend);
        }
    }
    golden("scatter-of-a-laptop", &text);
}
