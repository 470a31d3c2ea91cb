//! The worked products: one component of each recomputed by hand, as their comments do, and all held against brute
//! force.

use clatter::End;
use clatter_scene::{
    Assessment, BarModel, Base, Component, LimitAssessment, LimitKind, Mount, ProductFile, SingleDrop,
};
use clatter_shock::Suspension;

const PHONE: &str = include_str!("../../../reports/examples/phone.toml");
const TERMINAL: &str = include_str!("../../../reports/examples/handheld-terminal.toml");
const LAPTOP: &str = include_str!("../../../reports/examples/laptop.toml");

fn read(text: &str) -> ProductFile {
    ProductFile::read(text, "example").unwrap_or_else(|faults| panic!("{faults}"))
}

fn limit<'a>(assessment: &'a Assessment, component: &str, kind: LimitKind) -> &'a LimitAssessment {
    let found = assessment.components.iter().find(|c| c.name == component).expect("a component of the file");
    found.limits.iter().find(|l| l.limit == kind).expect("a limit of the component")
}

/// The proven demand is what the comments find by hand, and by at most half a percent more.
fn is(limit: &LimitAssessment, by_hand: f64) {
    let proven = limit.proven.expect("a proven demand");
    assert!(proven >= by_hand * (1.0 - 2e-4) && proven <= by_hand * 1.005, "{proven}, by hand {by_hand}");
    assert!(limit.demand >= proven, "the larger demand counts");
}

#[test]
fn phone_by_hand() {
    let assessment = read(PHONE).assess().unwrap();
    is(limit(&assessment, "crystal oscillator", LimitKind::VelocityChange), 6.416);
}

#[test]
fn handheld_terminal_by_hand() {
    let file = read(TERMINAL);
    let [a, b] = file.product.body.arms_m();
    assert!((a - 0.101_071).abs() < 1e-6 && (b - 0.118_929).abs() < 1e-6, "{a} {b}");
    assert!((file.product.body.gyration_m() - 0.065_385).abs() < 2e-6, "{}", file.product.body.gyration_m());
    let assessment = file.assess().unwrap();
    let turn = limit(&assessment, "gyroscope", LimitKind::AngularVelocityChange);
    is(turn, 73.02);
    // Of 0.25 at most, impacts in no time leave less energy than such a change takes; what the display gets is less
    // clear.
    assert_eq!(turn.warning, None);
    let warning = limit(&assessment, "display", LimitKind::Acceleration).warning.as_deref();
    assert!(warning.is_some_and(|warning| warning.contains("rebounds are not ruled out")), "{warning:?}");
}

#[test]
fn laptop_by_hand() {
    let assessment = read(LAPTOP).assess().unwrap();
    is(limit(&assessment, "hinge sensor", LimitKind::DamageBoundary), 2.766);
}

/// What a drop does to a limit, by another way than the assessment takes: no shared grid, no shares, no scaling.
fn reached(base: &Base, component: &Component, kind: LimitKind, position: f64, frequency: f64, pulses: bool) -> f64 {
    match (kind, component.mount) {
        (LimitKind::AngularVelocityChange, _) => base.largest_turn().0,
        (LimitKind::VelocityChange | LimitKind::DamageBoundary, _) => base.largest_shock(position).0,
        (_, Mount::Hard) => base.largest_acceleration(position).expect("a contact time").0,
        (kind, Mount::Suspended { damping, .. }) => {
            let response = base
                .respond(position, &Suspension::from_hz(frequency, damping).expect("a frequency"), pulses)
                .expect("a response");
            match kind {
                LimitKind::Acceleration => response.absolute_acceleration.magnitude(),
                _ => response.relative_displacement.magnitude(),
            }
        }
    }
}

/// No drop of a grid much denser than that of the search, by the highest rung there is, is worse by more than 1 %.
#[test]
fn brute_force_finds_nothing_worse() {
    for text in [PHONE, TERMINAL, LAPTOP] {
        let file = read(text);
        let assessment = file.assess().unwrap();
        let model = if file.product.contact_time_s.is_some() { BarModel::Compliant } else { BarModel::FiniteTilt };
        let [slow, fast] = file.drop.speeds_m_s();
        let mut worst: Vec<Vec<f64>> = file.components.iter().map(|_| vec![0.0; 2]).collect();
        for first in [End::A, End::B] {
            for tilt in 0..=60_u32 {
                // The ends of the ranges of speed and restitution, and their middles.
                for (speed, e) in [(1.0, 1.0), (1.0, 0.5), (1.0, 0.0), (0.5, 1.0), (0.0, 1.0)] {
                    let drop = SingleDrop {
                        first,
                        tilt_rad: file.drop.tilt_rad.at(f64::from(tilt) / 60.0),
                        speed_m_s: slow + speed * (fast - slow),
                        restitution: file.product.restitution.at(e),
                        gravity_m_s2: file.drop.gravity_m_s2,
                    };
                    let base = Base::new(&file.product, &drop, model).unwrap();
                    for ((component, assessed), worst) in
                        file.components.iter().zip(&assessment.components).zip(&mut worst)
                    {
                        let frequencies = match component.mount {
                            Mount::Hard => vec![0.0],
                            Mount::Suspended { frequency_hz, .. } => {
                                [0.0, 0.5, 1.0].map(|f| frequency_hz.at(f)).to_vec()
                            }
                        };
                        for (limit, worst) in assessed.limits.iter().zip(worst) {
                            for (position, &f) in
                                component.ends_m().iter().flat_map(|p| frequencies.iter().map(move |f| (*p, f)))
                            {
                                *worst = worst.max(reached(&base, component, limit.limit, position, f, true));
                            }
                        }
                    }
                }
            }
        }
        for (assessed, worst) in assessment.components.iter().zip(worst) {
            for (limit, worst) in assessed.limits.iter().zip(worst) {
                // A damage boundary may be told as an acceleration.
                if limit.limit.unit() == limit.unit {
                    assert!(worst <= 1.01 * limit.demand, "{} {:?}: {worst} found", assessed.name, limit);
                    assert!(worst >= 0.9 * limit.demand, "{} {:?}: only {worst} found", assessed.name, limit);
                }
            }
        }
    }
}
