//! The study that holds the error estimates: `cargo run --release --example plan_study -- [SCENES] [SEED] [FILE]`.
//!
//! Without a seed it takes one from the clock, and prints it. The file gets what the accuracy report shows of it, as
//! JSON.

#[path = "../tests/plan_study/mod.rs"]
mod plan_study;

use std::time::{SystemTime, UNIX_EPOCH};

use clatter_scene::plan::{BarRung, ComponentRung, Pair, Quantity};
use clatter_scene::tradeoff::Machine;
use plan_study::{Outcome, QUANTITIES, TOLERANCES, study, worth};
use serde::Serialize;

/// What the page shows: of all quantities together, then pair by pair. Shares are in [0, 1].
#[derive(Serialize)]
struct Record {
    seed: u64,
    scenes: u64,
    refused: usize,
    /// Where times were taken.
    machine: Machine,
    worth: Vec<Row>,
    pairs: Vec<PairRow>,
}

/// Plans at one tolerance.
#[derive(Serialize)]
struct Row {
    quantity: Option<Quantity>,
    tolerance: f64,
    within: f64,
    /// Scenes and quantities beyond three times the tolerance without a warning, and the largest error without one,
    /// over the tolerance.
    beyond: usize,
    worst: f64,
    over_cheapest: f64,
    highest_over: f64,
    needs: f64,
    gets: f64,
    /// Mean and longest time of a first look, in µs, the shares that take more than 1 µs and that it leaves open.
    first_us: f64,
    longest_first_us: f64,
    above: f64,
    open: f64,
    /// Mean and longest time of choosing in all.
    choosing_us: f64,
    longest_us: f64,
}

/// One pair in one quantity.
#[derive(Serialize)]
struct PairRow {
    quantity: Quantity,
    bar: BarRung,
    component: ComponentRung,
    /// Shares that get it, and for which it is the cheapest that serves, at each tolerance.
    gets: [f64; 3],
    needs: [f64; 3],
    /// How often the estimate, below 30 %, is less than the error, and by what factor at most; both above 3e-4.
    below: f64,
    below_by: f64,
    /// Median of estimate over error where the estimate is below 10 %.
    median: f64,
    /// Mean time at 1 %, and what the documented model makes of it, in µs.
    us: f64,
    modeled_us: f64,
}

fn count(n: usize) -> f64 {
    f64::from(u32::try_from(n).expect("fits"))
}

impl Row {
    fn new(outcomes: &[Outcome], quantity: Option<Quantity>, k: usize) -> Self {
        let of = || outcomes.iter().filter(|o| quantity.is_none_or(|q| o.quantity == q));
        let (w, tolerance) = (worth(of(), k), TOLERANCES[k]);
        let beyond = |o: &&Outcome| o.plans[k].warning.is_none() && o.planned(k).error > 3.0 * tolerance;
        Self {
            quantity,
            tolerance,
            within: w.within,
            beyond: of().filter(beyond).count(),
            worst: w.worst,
            over_cheapest: w.over_oracle,
            highest_over: w.of_highest.recip(),
            needs: w.needed,
            gets: w.given,
            first_us: 1e6 * w.first_s,
            longest_first_us: 1e6 * w.longest_first_s,
            above: w.above,
            open: w.open,
            choosing_us: 1e6 * w.choosing_s,
            longest_us: 1e6 * w.longest_s,
        }
    }
}

impl PairRow {
    fn new(outcomes: &[Outcome], quantity: Quantity, pair: Pair) -> Self {
        let of: Vec<&Outcome> = outcomes.iter().filter(|o| o.quantity == quantity).collect();
        let n = count(of.len());
        let share = |chosen: &dyn Fn(&Outcome) -> Pair| count(of.iter().filter(|o| chosen(o) == pair).count()) / n;
        let runs = || of.iter().map(|o| o.run(pair));
        // In the finest pieces: estimates are of models.
        let low = |r: &&plan_study::Run| r.estimate < 0.3 && r.with[2].error > r.estimate.max(3e-4);
        let mut ratios: Vec<f64> =
            runs().filter(|r| r.estimate < 0.1).map(|r| r.estimate / r.with[2].error.max(1e-6)).collect();
        ratios.sort_by(f64::total_cmp);
        Self {
            quantity,
            bar: pair.bar,
            component: pair.component,
            gets: std::array::from_fn(|k| share(&|o| o.plans[k].pair)),
            needs: std::array::from_fn(|k| share(&|o| o.oracle(k).pair)),
            below: count(runs().filter(low).count()) / n,
            below_by: runs().filter(low).map(|r| r.with[2].error / r.estimate.max(3e-4)).fold(0.0, f64::max),
            median: ratios.get(ratios.len() / 2).copied().unwrap_or(0.0),
            us: runs().map(|r| 1e6 * r.with[1].seconds).sum::<f64>() / n,
            modeled_us: runs().map(|r| 1e-3 * r.with[1].modeled_ns).sum::<f64>() / n,
        }
    }
}

#[expect(clippy::print_stdout, reason = "the answer of an example")]
fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize| arguments.get(i).map(|a| a.parse::<u64>().expect("a whole number"));
    let clock =
        || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |t| t.as_secs() << 20 | u64::from(t.subsec_nanos()));
    let (scenes, seed) = (number(0).unwrap_or(1000), number(1).unwrap_or_else(clock));
    let (outcomes, refused) = study(seed, usize::try_from(scenes).expect("fits"));
    let of = QUANTITIES.map(Some).into_iter().chain([None]);
    let worth = of.flat_map(|quantity| [0, 1, 2].map(|k| Row::new(&outcomes, quantity, k))).collect();
    let pairs = QUANTITIES.into_iter().flat_map(|q| Pair::planned(q).iter().map(move |&pair| (q, pair)));
    let pairs = pairs.map(|(quantity, pair)| PairRow::new(&outcomes, quantity, pair)).collect();
    let record = Record { seed, scenes, refused, machine: Machine::here(), worth, pairs };

    println!("seed {seed}: {scenes} scenes, {refused} refused by the compliant model");
    println!(
        "\nquantity          tolerance  within  beyond  worst/tol  cost/cheapest  highest/cost  needs highest  gets it  first, us  longest  above 1    open  in all, us  longest"
    );
    for r in &record.worth {
        println!(
            "{:17} {:9} {:6.2}% {:7} {:10.2} {:14.2} {:13.2} {:13.1}% {:7.1}% {:10.2} {:8.2} {:7.2}% {:6.1}% {:11.2} {:8.2}",
            r.quantity.map_or("all", Quantity::name),
            r.tolerance,
            100.0 * r.within,
            r.beyond,
            r.worst,
            r.over_cheapest,
            r.highest_over,
            100.0 * r.needs,
            100.0 * r.gets,
            r.first_us,
            r.longest_first_us,
            100.0 * r.above,
            100.0 * r.open,
            r.choosing_us,
            r.longest_us
        );
    }
    let above = outcomes.iter().filter(|o| o.truth > 1.01 * o.setup.forecast(o.quantity).at_most()).count();
    println!("\n{above} of {} reach more than the bound of a search, by more than 1 %", outcomes.len());
    println!(
        "\nquantity          pair                         gets it, %         cheapest, %        below, by most  median      µs modeled"
    );
    for r in &record.pairs {
        let [gets, needs] = [r.gets, r.needs].map(|shares| shares.map(|v| format!("{:5.1}", 100.0 * v)).join(" "));
        println!(
            "{:17} {:27} {gets}  {needs}  {:5.2}% {:7.1}  {:6.1} {:7.1} {:7.1}",
            r.quantity.name(),
            format!("{} {}", r.bar.name(), r.component.name()),
            100.0 * r.below,
            r.below_by,
            r.median,
            r.us,
            r.modeled_us
        );
    }
    println!("\nscenes beyond the tolerance:");
    for o in &outcomes {
        for (k, (plan, tolerance)) in o.plans.iter().zip(TOLERANCES).enumerate() {
            let (pair, run) = (o.run(plan.pair), o.planned(k));
            if run.error > tolerance {
                println!(
                    "{} {:?} {}: {:?} est {:.2e} err {:.2e} until {:.3e} warn {:?}\n    {:?}",
                    o.scene,
                    o.quantity,
                    tolerance,
                    pair.pair,
                    pair.estimate,
                    run.error,
                    plan.until_s,
                    plan.warning.is_some(),
                    o.setup
                );
            }
        }
    }
    if let Some(path) = arguments.get(2) {
        let text = serde_json::to_string_pretty(&record).expect("numbers") + "\n";
        std::fs::write(path, text).expect("a file that can be written");
    }
}
