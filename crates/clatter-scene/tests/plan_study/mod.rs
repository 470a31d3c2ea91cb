//! Random scenes over wide ranges: what plans choose, what that gets wrong and what it costs.
//!
//! Log-uniform: tilt 0.1 to 30°, drop 1 cm to 3 m, e 0.01 to 0.95, length 5 to 40 cm, frequency 5 Hz to 20 kHz, contact
//! 0.05 to 2 ms. Uniform: q in [−0.3, 0.95], position in [−1, 1]. Damping ratio: uniform in [0, 2] for half of the
//! scenes, log-uniform in [10⁻³, 2] for the other half. Scenes that the compliant model refuses are counted and left
//! out: there is no truth to compare with.

use std::hint::black_box;
use std::time::Instant;

use clatter::flight::{Body, Scene};
use clatter_scene::plan::{BarRung, FIRST_STRIKES, Pair, Plan, Quantity, STRIKES, Setup};
use clatter_shock::{DampingRatio, Suspension};

pub(crate) const QUANTITIES: [Quantity; 3] =
    [Quantity::PeakAcceleration, Quantity::RattleSpace, Quantity::VelocityShock];
pub(crate) const TOLERANCES: [f64; 3] = [0.1, 0.01, 0.001];
/// Pieces of a pulse in what is held to be true: eleven times as many as the closest plans have.
const TRUE_CELLS: usize = 384;
/// Pieces of a pulse where the highest pair is always used.
const CELLS: usize = 34;

/// How many times what choosing takes is measured, one pass over all scenes after the other.
const SWEEPS: usize = 5;

/// A seeded sequence (SplitMix64).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// In [0, 1).
    #[expect(clippy::cast_precision_loss, reason = "53 bits")]
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 * 0.5_f64.powi(53)
    }
    fn even(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }
    fn log(&mut self, lo: f64, hi: f64) -> f64 {
        lo * (hi / lo).powf(self.unit())
    }
    /// A scene with a component.
    pub(crate) fn setup(&mut self) -> Setup {
        let (tilt, height, e) = (self.log(0.1, 30.0), self.log(0.01, 3.0), self.log(0.01, 0.95));
        let (q, length, position) = (self.even(-0.3, 0.95), self.log(0.05, 0.4), self.even(-1.0, 1.0));
        let (frequency, contact) = (self.log(5.0, 20e3), self.log(5e-5, 2e-3));
        let zeta = if self.unit() < 0.5 { self.even(0.0, 2.0) } else { self.log(1e-3, 2.0) };
        let body = Body::new(length, 0.5 * length * ((1.0 - q) / (1.0_f64 + q)).sqrt()).expect("a body");
        let scene = Scene::from_height(body, e, height, tilt, 9.81).expect("a drop");
        let damping = DampingRatio::new(zeta).expect("a damping ratio");
        let part = Suspension::from_hz(frequency, damping).expect("a suspension");
        Setup::new(scene, Some(contact), position, part).expect("a setup")
    }
}

/// One pair in one scene.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Run {
    pub(crate) pair: Pair,
    pub(crate) estimate: f64,
    /// For each tolerance.
    pub(crate) with: [Ran; 3],
}

/// What a run gave.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ran {
    /// Against the truth.
    pub(crate) error: f64,
    /// Taken here.
    pub(crate) seconds: f64,
    /// Of the documented model.
    pub(crate) modeled_ns: f64,
}

/// What a plan took.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Choosing {
    /// By a first look, and whether that left it open.
    pub(crate) first_seconds: f64,
    pub(crate) open: bool,
    /// From as many strikes as it hangs on.
    pub(crate) seconds: f64,
}

impl Choosing {
    /// The least times so far, and of this moment.
    fn again(&mut self, setup: &Setup, quantity: Quantity, tolerance: f64) {
        // One is too short for the clock.
        const BATCH: u32 = 16;
        let many = |most: usize| {
            let plan = || black_box(setup).plan_from(quantity, tolerance, most);
            let run = || (0..BATCH).map(|_| black_box(plan()).until_s).fold(0.0, f64::max);
            timed(run).1 / f64::from(BATCH)
        };
        self.first_seconds = self.first_seconds.min(many(FIRST_STRIKES));
        self.seconds = self.seconds.min(many(STRIKES));
    }
}

/// One quantity in one scene.
pub(crate) struct Outcome {
    pub(crate) scene: usize,
    pub(crate) setup: Setup,
    pub(crate) quantity: Quantity,
    /// Of the highest pair until rest, in fine pieces.
    pub(crate) truth: f64,
    pub(crate) plans: [Plan; 3],
    /// What choosing them took.
    pub(crate) choosing: [Choosing; 3],
    pub(crate) runs: Vec<Run>,
    /// The highest pair until rest.
    pub(crate) highest_seconds: f64,
}

impl Outcome {
    pub(crate) fn run(&self, pair: Pair) -> &Run {
        self.runs.iter().find(|r| r.pair == pair).expect("a planned pair")
    }
    /// The cheapest pair within a tolerance, by time taken.
    pub(crate) fn oracle(&self, k: usize) -> &Run {
        let within = self.runs.iter().filter(|r| r.with[k].error <= TOLERANCES[k]);
        within.min_by(|a, b| a.with[k].seconds.total_cmp(&b.with[k].seconds)).unwrap_or(self.run(Pair::HIGHEST))
    }
    /// The pair that is planned for a tolerance, as it ran.
    pub(crate) fn planned(&self, k: usize) -> &Ran {
        &self.run(self.plans[k].pair).with[k]
    }
}

/// The least time of three.
fn timed(mut f: impl FnMut() -> f64) -> (f64, f64) {
    let mut least = f64::INFINITY;
    let mut value = 0.0;
    for _ in 0..3 {
        let start = Instant::now();
        value = f();
        least = least.min(start.elapsed().as_secs_f64());
    }
    (value, least)
}

/// Draws scenes and runs every planned pair on each; returns them with the number of scenes refused.
pub(crate) fn study(seed: u64, scenes: usize) -> (Vec<Outcome>, usize) {
    let mut random = Random(seed);
    let (mut outcomes, mut refused) = (Vec::new(), 0);
    for scene in 0..scenes {
        let setup = random.setup();
        let contact = setup.contact_time_s().expect("a contact time");
        if setup.scene().simulate_compliant(contact).is_err() {
            refused += 1;
            continue;
        }
        for quantity in QUANTITIES {
            let forecast = setup.forecast(quantity);
            let highest = |cells| setup.demand_fine(Pair::HIGHEST, quantity, f64::INFINITY, cells).expect("accepted");
            let until_s = forecast.until_s;
            let truth = highest(TRUE_CELLS);
            let (_, highest_seconds) = timed(|| highest(CELLS));
            let plans = TOLERANCES.map(|tolerance| setup.plan_from(quantity, tolerance, STRIKES));
            let choosing = TOLERANCES.map(|tolerance| Choosing {
                first_seconds: f64::INFINITY,
                open: setup.plan(quantity, tolerance).is_open(),
                seconds: f64::INFINITY,
            });
            let run = |pair: Pair, plan: &Plan| {
                let plan = Plan { pair, until_s, ..*plan };
                let (value, seconds) = timed(|| plan.run(&setup).expect("a planned pair"));
                Ran { error: (value / truth - 1.0).abs(), seconds, modeled_ns: forecast.cost_ns(pair, plan.pieces()) }
            };
            let runs = Pair::planned(quantity).iter().map(|&pair| {
                // Each by its own pieces of pulses, and as far as its tolerance asks.
                let with = plans.each_ref().map(|plan| run(pair, plan));
                Run { pair, estimate: forecast.pair(pair).error, with }
            });
            let runs = runs.collect();
            outcomes.push(Outcome { scene, setup, quantity, truth, plans, choosing, runs, highest_seconds });
        }
    }
    // What else the machine does now and then takes as long: not all of these times fall into that.
    for _ in 0..SWEEPS {
        for o in &mut outcomes {
            for (choosing, tolerance) in o.choosing.iter_mut().zip(TOLERANCES) {
                choosing.again(&o.setup, o.quantity, tolerance);
            }
        }
    }
    (outcomes, refused)
}

/// What plans are worth at one tolerance.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Worth {
    pub(crate) scenes: usize,
    /// Share within the tolerance.
    pub(crate) within: f64,
    /// Largest error without a warning, over the tolerance.
    pub(crate) worst: f64,
    /// Mean cost over that of the oracle choice, and over that of the highest pair until rest.
    pub(crate) over_oracle: f64,
    pub(crate) of_highest: f64,
    /// Mean time of a first look, the longest, the share that take more than 1 µs, and that are left open.
    pub(crate) first_s: f64,
    pub(crate) longest_first_s: f64,
    pub(crate) above: f64,
    pub(crate) open: f64,
    /// Mean time of choosing in all, and the longest.
    pub(crate) choosing_s: f64,
    pub(crate) longest_s: f64,
    /// Share of scenes that need the highest pair, and that get it.
    pub(crate) needed: f64,
    pub(crate) given: f64,
}

#[expect(clippy::cast_precision_loss, reason = "counts of scenes")]
pub(crate) fn worth<'a>(outcomes: impl Iterator<Item = &'a Outcome>, k: usize) -> Worth {
    let mut w = Worth::default();
    let (mut cost, mut oracle, mut highest) = (0.0, 0.0, 0.0);
    for o in outcomes {
        let (plan, tolerance, run) = (&o.plans[k], TOLERANCES[k], o.planned(k));
        w.scenes += 1;
        w.within += f64::from(u8::from(run.error <= tolerance));
        if plan.warning.is_none() {
            w.worst = w.worst.max(run.error / tolerance);
        }
        cost += run.seconds;
        oracle += o.oracle(k).with[k].seconds;
        highest += o.highest_seconds;
        let choosing = o.choosing[k];
        w.first_s += choosing.first_seconds;
        w.longest_first_s = w.longest_first_s.max(choosing.first_seconds);
        w.above += f64::from(u8::from(choosing.first_seconds > 1e-6));
        w.open += f64::from(u8::from(choosing.open));
        w.choosing_s += choosing.seconds;
        w.longest_s = w.longest_s.max(choosing.seconds);
        w.given += f64::from(u8::from(plan.pair.bar == BarRung::Compliant));
        w.needed += f64::from(u8::from(o.oracle(k).pair.bar == BarRung::Compliant));
    }
    let n = w.scenes as f64;
    Worth {
        within: w.within / n,
        over_oracle: cost / oracle,
        of_highest: cost / highest,
        first_s: w.first_s / n,
        above: w.above / n,
        open: w.open / n,
        choosing_s: w.choosing_s / n,
        needed: w.needed / n,
        given: w.given / n,
        ..w
    }
}
