//! The scatter of a product.

#![cfg(test)]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use std::fmt::Write as _;

use clatter_assess::scatter::{Sampler, Settings};
use clatter_product::ProductFile;

const LAPTOP: &str = include_str!("laptop.toml");

fn golden(name: &str, text: &str) {
    insta::with_settings!(
        { snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true },
        { insta::assert_snapshot!(name, text) }
    );
}

/// Counts of failures are the same on any machine: the generator counts in integers, and sines come from `libm`.
#[test]
fn scatter_of_a_laptop() {
    let file = ProductFile::read(LAPTOP, "laptop.toml").unwrap();
    let settings = Settings { samples: 20_000, seed: 1, confidence: 0.95, merge_s: 1e-3 };
    let scatter = Sampler::new(&file, settings).unwrap().run::<()>(false, &|| true, |_| Ok(())).unwrap();
    let mut text = String::new();
    for part in scatter.components {
        let p = part.survival;
        let estimate = p.estimate.expect("samples are answered");
        let _ = writeln!(text, "{}: {} of 20000 fail", part.name, part.failures);
        let _ = writeln!(text, "  survives {:.5} in [{:.5}, {:.5}], at least {:.5}", estimate, p.lo, p.hi, p.at_least);
        let _ = writeln!(text, "  utilization {:.5} ± {:.5}", part.mean_utilization, part.utilization_deviation);
        for driver in part.drivers {
            let share = driver.share;
            let _ = writeln!(text, "  {:<18} {:.3} {:+.3}", driver.input.name(), share.variance, share.trend);
        }
    }
    golden("scatter-of-a-laptop", &text);
}
