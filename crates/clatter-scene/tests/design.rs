//! The smallest change, against closed forms and dense scans.

#![cfg(test)]

use clatter::End;
use clatter::design::{Goal, largest_restitution};
use clatter_scene::design::{Border, Bounds, Lever, Outcome, Plane};
use clatter_scene::scatter::{Sampler, Settings};
use clatter_scene::{Accuracy, BarModel, Drop, Fall, First, Mount, ProductFile, Spread, Verdict};
use clatter_shock::DampingRatio;

fn product(parts: &str) -> ProductFile {
    let text = format!(
        "[product]\nname = \"test\"\nlength = \"300 mm\"\nradius_of_gyration = \"90 mm\"\nrestitution = [0.25, 0.4]\n\
         [drop]\nheight = \"0.8 m\"\ntilt = [\"0.5 deg\", \"1.5 deg\"]\nfirst = \"either\"\n{parts}"
    );
    ProductFile::read(&text, "test.toml").unwrap_or_else(|faults| panic!("{faults}"))
}

const PANEL: &str = "[[component]]\nname = \"panel\"\nposition = \"20 mm\"\nextent = \"20 mm\"\nmount = \"hard\"\n\
    velocity_change_limit = \"3.2 m/s\"\n";
const DRIVE: &str = "[[component]]\nname = \"drive\"\nposition = \"60 mm\"\nnatural_frequency = \"40 Hz\"\n\
    damping_ratio = 0.1\nacceleration_limit = \"100 gn\"\n";

fn outcome(file: &ProductFile, bounds: &Bounds, lever: Lever) -> Outcome {
    let assessment = file.assess().unwrap();
    assert_eq!(assessment.verdict, Verdict::Unsafe);
    let remedies = file.remedies(&assessment, bounds).unwrap();
    assert_eq!(remedies.len(), 1);
    remedies[0].levers.iter().find(|remedy| remedy.lever == lever).unwrap().outcome.clone()
}

fn change(file: &ProductFile, lever: Lever) -> [[f64; 2]; 2] {
    match outcome(file, &Bounds::default(), lever) {
        Outcome::Change { from, to, after } => {
            assert_eq!(after.verdict, Verdict::Safe, "assessed again");
            [from, to]
        }
        other => panic!("{lever:?}: {other:?}"),
    }
}

/// Velocity shocks of a hard part have closed forms.
#[test]
fn the_smallest_changes_of_a_hard_part_are_those_of_the_closed_forms() {
    let file = product(PANEL);
    let (q, v0) = (file.product.inertia_ratio(), file.drop.speeds_m_s()[1]);
    let x = 3.2 / v0;
    // place: s = (2x/peak + q − 1)/(1 + q) at the largest e, for the far edge of the part
    let bar = clatter::Bar::new(q, 0.4).unwrap();
    let edge = bar.safe_zone(&clatter::Start::default(), x).s * 0.15;
    let [from, to] = change(&file, Lever::Position);
    // The assessment bounds demands to half a per cent above; a step is 0.29 m/96, bisected twelve times.
    let slack = 0.005 * x / (bar.peak(&clatter::Start::default()).end * (1.0 + q)) * 2.0 * 0.15 + 1e-6;
    assert!(
        (from[0] - 0.02).abs() < 1e-15 && to[0] < edge - 0.01 + 1e-9 && to[0] > edge - 0.01 - slack,
        "{to:?}, {edge}"
    );
    // restitution: the whole range below the border of the plane
    let goal = Goal::zone(x, 0.03 / 0.15).unwrap();
    let most = largest_restitution(&[goal], q).unwrap();
    let [from, to] = change(&file, Lever::Restitution);
    assert!((from[0] - 0.25).abs() < 1e-15 && (from[1] - 0.4).abs() < 1e-15, "{from:?}");
    assert!(to[1] < most + 1e-9 && to[1] > most - 0.01, "{to:?}, {most}");
    assert!((to[1] - to[0] - 0.15).abs() < 1e-12, "the range moves as a whole");
    assert_eq!(outcome(&file, &Bounds::default(), Lever::Frequency), Outcome::NoEffect);
    assert_eq!(outcome(&file, &Bounds::default(), Lever::Damping), Outcome::NoEffect);
}

#[test]
fn the_border_of_a_hard_part_is_exact() {
    let file = product(PANEL);
    let plane = Plane::of(&file, &Bounds::default()).unwrap();
    let Border::Exact(pieces) = &plane.components[0].border else { panic!("{:?}", plane.components[0]) };
    let v0 = file.drop.speeds_m_s()[1];
    for p in pieces.iter().flatten().filter(|p| p.q < 1.0 && p.e > 1e-9 && p.e < 1.0) {
        let bar = clatter::Bar::new(p.q, p.e).unwrap();
        let peak = bar.peak_at(&clatter::Start::default(), 0.2) * v0;
        assert!((peak - 3.2).abs() < 1e-12, "{peak} at {p:?}");
    }
}

/// Margins of the grid are those of the worst of its drops, each by itself: of pulses, though few are followed with
/// them.
#[test]
fn the_grid_has_the_worst_of_all_its_drops() {
    let text = "[product]\nname = \"p\"\nlength = \"150 mm\"\nradius_of_gyration = \"41 mm\"\nrestitution = 0.3\n\
         contact_time = \"0.4 ms\"\n[drop]\nspeed = [\"3 m/s\", \"4 m/s\"]\ntilt = [\"1 deg\", \"9 deg\"]\n[[component]]\n\
         name = \"board\"\nposition = \"30 mm\"\nextent = \"20 mm\"\nnatural_frequency = \"1500 Hz\"\ndamping_ratio = 0.05\n\
         acceleration_limit = \"1000 gn\"\nrattle_space = \"1 mm\"\n";
    let file = ProductFile::read(text, "p").unwrap();
    let plane = Plane::of(&file, &Bounds::default()).unwrap();
    let Border::Grid(margins) = &plane.components[0].border else { panic!("a suspended part has a grid") };
    for (i, j) in [(0, 0), (8, 37), (20, 10), (29, 29), (36, 4)] {
        let [q, e] = [i, j].map(|n: u32| f64::from(n) / 40.0);
        let mut product = file.product.with_inertia_ratio(q).unwrap();
        product.restitution = Spread::value(e).unwrap();
        let mut worst = 0.0_f64;
        for first in [First::End(End::A), First::End(End::B)] {
            for speed_m_s in [3.0, 3.5, 4.0] {
                for k in 0..33 {
                    let tilt_rad = Spread::value((1.0 + f64::from(k) / 4.0).to_radians()).unwrap();
                    let fall = Fall::SpeedMS(Spread::value(speed_m_s).unwrap());
                    let drop = Drop { first, fall, tilt_rad, ..file.drop };
                    let one = ProductFile { product: product.clone(), drop, ..file.clone() };
                    let settings = Settings { samples: 1, seed: 0, confidence: 0.5 };
                    let scatter = Sampler::new(&one, settings).unwrap().run(false, |_| Ok::<(), ()>(())).unwrap();
                    worst = worst.max(scatter.components[0].largest_utilization);
                }
            }
        }
        let found = 1.0 / (1.0 + margins[(i * 41 + j) as usize]);
        assert!((found / worst - 1.0).abs() < 1e-9, "q {q}, e {e}: {found} {worst}");
    }
}

/// A dense scan of each lever finds nothing safe nearer than the answer.
#[test]
fn no_smaller_change_makes_a_suspended_part_safe() {
    let file = product(DRIVE);
    for lever in [Lever::Position, Lever::Frequency, Lever::Damping, Lever::InertiaRatio] {
        let bounds = Bounds::default();
        let (from, to) = match outcome(&file, &bounds, lever) {
            Outcome::Change { from, to, .. } => (from[0], to[0]),
            Outcome::Nowhere { bounds } => (bounds[0], bounds[1]),
            Outcome::NoEffect => panic!("{lever:?}"),
        };
        let nowhere = matches!(outcome(&file, &bounds, lever), Outcome::Nowhere { .. });
        for i in 1..40 {
            // short of the answer, or all over the bounds
            let share = f64::from(i) / 40.0 * if nowhere { 1.0 } else { 0.999 };
            let x = from + share * (to - from);
            let mut tried = file.clone();
            match (lever, &mut tried.components[0].mount) {
                (Lever::Position, _) => tried.components[0].position_m = x,
                (Lever::Frequency, Mount::Suspended { frequency_hz, .. }) => {
                    *frequency_hz = Spread::value(x).unwrap();
                }
                (Lever::Damping, Mount::Suspended { damping, .. }) => {
                    *damping = DampingRatio::new(x).unwrap();
                }
                _ => tried.product = file.product.with_inertia_ratio(x).unwrap(),
            }
            assert_eq!(tried.assess().unwrap().verdict, Verdict::Unsafe, "{lever:?} = {x}, short of {to}");
        }
    }
}

#[test]
fn an_inertia_ratio_gives_the_radius_of_gyration_that_has_it() {
    for arms in [[0.07, 0.07], [0.05, 0.09]] {
        let mut product = product(PANEL).product;
        product.body = clatter::flight::Body::off_center(arms[0], arms[1], 0.03).unwrap();
        for q in [-0.9, -0.3, 0.0, 1e-9, 0.3, 0.5, 0.9, 0.999_999, 1.0] {
            let found = product.with_inertia_ratio(q).unwrap().inertia_ratio();
            assert!((found - q).abs() < 1e-14, "{found}, not {q}, for arms {arms:?}");
        }
        assert!(product.with_inertia_ratio(-1.0).is_err() && product.with_inertia_ratio(f64::NAN).is_err());
    }
}

/// The answer, put into the file to the last digit, is safe: also where other pulses are cut for a part that may be
/// four times as stiff.
#[test]
fn a_change_is_safe_as_the_file_with_it_is_assessed() {
    let file = ProductFile::read(
        "[product]\nname = \"p\"\nlength = \"200 mm\"\nradius_of_gyration = \"55 mm\"\nrestitution = [0.3, 0.4]\n\
         contact_time = \"1 ms\"\n[drop]\nspeed = \"4 m/s\"\ntilt = \"3 deg\"\n[[component]]\nname = \"part\"\n\
         position = \"50 mm\"\nnatural_frequency = [\"200 Hz\", \"300 Hz\"]\ndamping_ratio = 0.1\nacceleration_limit = \"850 gn\"\n",
        "p",
    )
    .unwrap();
    let Outcome::Change { to: [damping, _], .. } = outcome(&file, &Bounds::default(), Lever::Damping) else {
        panic!("more damping makes it safe");
    };
    let mut changed = file.clone();
    let Mount::Suspended { damping: of_part, .. } = &mut changed.components[0].mount else { panic!("suspended") };
    *of_part = DampingRatio::new(damping).unwrap();
    assert_eq!(changed.assess().unwrap().verdict, Verdict::Safe, "{damping}");
}

/// A drop that broke the part is followed by the models that it needs where the lever has moved.
#[test]
fn a_value_is_not_passed_over_by_models_that_it_does_not_need() {
    let file = ProductFile::read(
        "[product]\nname = \"p\"\nlength = \"200 mm\"\nradius_of_gyration = \"85.79744730644437 mm\"\n\
         restitution = 0.44000863290075376\n[drop]\nspeed = \"2 m/s\"\ntilt = [\"1 deg\", \"10 deg\"]\n[[component]]\n\
         name = \"part\"\nposition = \"-78.96461760892606 mm\"\nextent = \"15 mm\"\nmount = \"hard\"\n\
         velocity_change_limit = \"2.8988749879286 m/s\"\n",
        "p",
    )
    .unwrap();
    let [_, [q, _]] = change(&file, Lever::InertiaRatio);
    assert!((0.0..0.02).contains(&q), "{q}");
}

/// Where the present value is beyond the bounds, all of them is looked at, from the bound next to it.
#[test]
fn changes_are_found_from_beyond_the_bounds() {
    let damped = |zeta: f64, limit_gn: f64| {
        let drive = DRIVE.replace("damping_ratio = 0.1", &format!("damping_ratio = {zeta}"));
        product(&drive.replace("100 gn", &format!("{limit_gn} gn")))
    };
    // Too little damping and too much ask for more than some in between.
    let demand = |zeta| damped(zeta, 1e3).assess().unwrap().components[0].limits[0].demand / 9.806_65;
    let [some, much] = [0.25, 0.5].map(demand);
    assert!(much > 1.02 * some, "{some} {much}");
    let limit_gn = 0.5 * (some + much);
    let bounds = Bounds::default();
    let damping = |zeta| match outcome(&damped(zeta, limit_gn), &bounds, Lever::Damping) {
        Outcome::Change { to: [to, _], .. } => to,
        other => panic!("{zeta}: {other:?}"),
    };
    let (within, beyond) = (damping(0.5), damping(1.0));
    assert!((within - beyond).abs() < 1e-3, "{within} {beyond}");
}

/// What an assessment with a named model finds unsafe is made safe by that model.
#[test]
fn changes_are_of_the_model_that_was_asked_for() {
    let file = product(DRIVE);
    let accuracy = Accuracy { tolerance: 0.05, model: Some(BarModel::FiniteTilt) };
    let assessment = file.assess_to(&accuracy).unwrap();
    let remedies = file.remedies(&assessment, &Bounds::default()).unwrap();
    let mut changes = 0;
    for remedy in &remedies[0].levers {
        if let Outcome::Change { after, .. } = &remedy.outcome {
            let reason = &after.limits[0].model.reason;
            assert!(reason.contains("finite-tilt was asked for"), "{reason}");
            changes += 1;
        }
    }
    assert!(changes > 0, "{remedies:?}");
}
