//! The study that holds the error estimates: `cargo run --release --example plan_study -- [SCENES] [SEED]`.
//!
//! Without a seed it takes one from the clock, and prints it.

#[path = "../tests/plan_study/mod.rs"]
mod plan_study;

use std::time::{SystemTime, UNIX_EPOCH};

use clatter_scene::plan::Pair;
use plan_study::{Outcome, QUANTITIES, TOLERANCES, study, worth};

#[expect(clippy::print_stdout, reason = "the answer of an example")]
fn main() {
    let mut arguments = std::env::args().skip(1).map(|a| a.parse::<u64>().expect("a whole number"));
    let scenes = arguments.next().unwrap_or(1000);
    let clock =
        || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |t| t.as_secs() << 20 | u64::from(t.subsec_nanos()));
    let seed = arguments.next().unwrap_or_else(clock);
    let (outcomes, refused) = study(seed, usize::try_from(scenes).expect("fits"));
    println!("seed {seed}: {scenes} scenes, {refused} refused by the compliant model");
    println!("\nquantity          tolerance  within   worst/tol  cost/oracle  highest/cost  needs highest  gets it");
    for quantity in QUANTITIES {
        for (k, tolerance) in TOLERANCES.into_iter().enumerate() {
            let w = worth(outcomes.iter().filter(|o| o.quantity == quantity), k);
            println!(
                "{:17} {:8} {:8.2}% {:9.2} {:12.2} {:13.2} {:13.1}% {:8.1}%",
                format!("{quantity:?}"),
                tolerance,
                100.0 * w.within,
                w.worst,
                w.over_oracle,
                1.0 / w.of_highest,
                100.0 * w.needed,
                100.0 * w.given
            );
        }
    }
    for (k, tolerance) in TOLERANCES.into_iter().enumerate() {
        let w = worth(outcomes.iter(), k);
        println!(
            "all               {:8} {:8.2}% {:9.2} {:12.2} {:13.2} {:13.1}% {:8.1}%",
            tolerance,
            100.0 * w.within,
            w.worst,
            w.over_oracle,
            1.0 / w.of_highest,
            100.0 * w.needed,
            100.0 * w.given
        );
    }
    let above = outcomes.iter().filter(|o| o.truth > 1.01 * o.setup.forecast(o.quantity).at_most()).count();
    println!("\n{above} of {} reach more than the bound of a search, by more than 1 %", outcomes.len());
    for quantity in QUANTITIES {
        let of: Vec<&Outcome> = outcomes.iter().filter(|o| o.quantity == quantity).collect();
        let count = |n: usize| f64::from(u32::try_from(n).expect("fits"));
        let n = count(of.len());
        println!(
            "\n{quantity:?}: pair, share given at each tolerance, share that the oracle gives; estimate below the error, by most; median estimate/error where below 10 %; mean µs, modeled µs"
        );
        for &pair in Pair::planned(quantity) {
            let share = |k: usize| 100.0 * count(of.iter().filter(|o| o.plans[k].pair == pair).count()) / n;
            let oracle =
                |k: usize| 100.0 * count(of.iter().filter(|o| o.oracle(TOLERANCES[k]).pair == pair).count()) / n;
            let mut below = 0.0;
            let mut most = 0.0_f64;
            let mut ratios = Vec::new();
            let (mut us, mut model) = (0.0, 0.0);
            for o in &of {
                let r = o.run(pair);
                us += 1e6 * r.seconds / n;
                model += 1e-3 * r.modeled_ns / n;
                if r.estimate < 0.3 && r.error > r.estimate.max(3e-4) {
                    below += 100.0 / n;
                    most = most.max(r.error / r.estimate.max(3e-4));
                }
                if r.estimate < 0.1 {
                    ratios.push(r.estimate / r.error.max(1e-6));
                }
            }
            ratios.sort_by(f64::total_cmp);
            let median = ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN);
            println!(
                "{:26} given {:5.1} {:5.1} {:5.1}  oracle {:5.1} {:5.1} {:5.1}  below {below:5.2}% by {most:6.1}  median {median:7.1}  {us:7.1} {model:7.1}",
                format!("{:?} {:?}", pair.bar, pair.component),
                share(0),
                share(1),
                share(2),
                oracle(0),
                oracle(1),
                oracle(2)
            );
        }
    }
    println!("\nscenes beyond the tolerance:");
    for o in &outcomes {
        for (plan, tolerance) in o.plans.iter().zip(TOLERANCES) {
            let run = o.run(plan.pair);
            if run.error > tolerance {
                println!(
                    "{} {:?} {}: {:?} est {:.2e} err {:.2e} until {:.3e} warn {:?}\n    {:?}",
                    o.scene,
                    o.quantity,
                    tolerance,
                    run.pair,
                    run.estimate,
                    run.error,
                    plan.until_s,
                    plan.warning.is_some(),
                    o.setup
                );
            }
        }
    }
}
