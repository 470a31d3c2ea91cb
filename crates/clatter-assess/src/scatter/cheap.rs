//! A drop in closed form: the bar without gravity at small tilt, whose strikes are velocity shocks.
//!
//! The train is that of `clatter`, the response that of `clatter-shock`. Of a contact time only the acceleration of a part mounted
//! rigidly comes, as the half-sine of the shock. The error of that is measured ([`super::extremes`]), so that a train may be left
//! where little comes.

use std::f64::consts::FRAC_PI_2;

use clatter::{Bar, End, Impact, Start};
use clatter_shock::{VelocityShock, VelocityShocks};

use super::sample::{PartSample, Sample};
use clatter_product::{Drop, Error, Source};

/// A train is left where a strike is this share of the first, or after so many.
const SMALL: f64 = 1e-3;
const MOST_STRIKES: usize = 256;

/// Writes the utilization of every part; 0 where the train has no answer.
pub(super) fn answer(sample: &Sample, asked: &mut Vec<f64>) {
    let drop = &sample.drops[0];
    let train = strikes(drop).unwrap_or_default();
    asked.clear();
    asked.extend(sample.parts.iter().map(|part| of_part(drop, &train, part).unwrap_or_default()));
}

/// Returns the strikes of a drop; end a of the train is the one that touches first.
fn strikes(drop: &Drop) -> Result<Vec<Impact>, Error> {
    if drop.is_flat {
        let (approach, delta_v) = (-drop.speed_m_s, [(1.0 + drop.restitution) * drop.speed_m_s; 2]);
        return Ok(vec![Impact { number: 1, end: End::A, time: 0.0, approach, delta_v }]);
    }
    let bar = Bar::from_arms(drop.body.arms_m(), drop.body.gyration_m(), drop.restitution)?;
    let bar = if drop.first() == End::A { bar } else { bar.exchanged() };
    let start = Start::new(drop.approaches_m_s(), drop.body.length_m() * libm::sin(drop.tilt_rad))?;
    let counts = |strike: &Impact| -strike.approach > SMALL * drop.speed_m_s;
    Ok(bar.train(&start).take(MOST_STRIKES).take_while(counts).collect())
}

fn of_part(drop: &Drop, train: &[Impact], part: &PartSample) -> Result<f64, Error> {
    let mut asked = 0.0_f64;
    // For instant impacts all is linear in the place, but for what stops do.
    let stops = part.suspension.is_some_and(|part| part.stop().is_some());
    let spots = || part.spots().iter().map(|spot| spot.at_m[0]).collect();
    for place in if stops { spots() } else { part.ends().to_vec() } {
        let s = drop.relative(place);
        let shock = |strike: &Impact| VelocityShock { time: strike.time, delta_v: strike.delta_v_at(s) };
        let shocks = VelocityShocks::new(train.iter().map(shock).collect())?;
        let half_sine = shocks.largest() * FRAC_PI_2 / drop.contact_time_s.unwrap_or(f64::INFINITY);
        for limit in &part.limits {
            // A value below this is not the largest.
            let above = asked * limit.allowed;
            let value = match (limit.kind.source(), &part.suspension) {
                (Source::Response(of), Some(part)) => {
                    let unit = of.of_velocity(1.0, part.omega());
                    let peak = shocks.peak_above(part, of.peaked, above / unit);
                    let value = unit * peak.map_or(0.0, |peak| peak.value.abs());
                    if value.is_infinite() {
                        // It hits its stops for ever.
                        shocks.pulses().hits(part)?;
                    }
                    value
                }
                (Source::Response(_), None) => half_sine,
                (Source::Turn, _) => {
                    let turn = |strike: &Impact| (strike.delta_v[1] - strike.delta_v[0]).abs();
                    train.iter().map(turn).fold(0.0, f64::max) / drop.body.length_m()
                }
                // Damage only beyond both; without a contact time the velocity change alone counts.
                (Source::Boundary, _) if drop.contact_time_s.is_some() => {
                    shocks.largest().min(half_sine / limit.critical_acceleration_m_s2 * limit.allowed)
                }
                (Source::Shock | Source::Boundary, _) => shocks.largest(),
            };
            asked = asked.max(value / limit.allowed);
        }
    }
    Ok(asked)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Part;
    use clatter_flight::Body;
    use clatter_product::{Inside, Limit, LimitKind, Model};
    use clatter_shock::{DampingRatio, Suspension};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 500, ..ProptestConfig::default() })]
        /// Every limit, with either end first, as the engine answers it by the same model.
        #[test]
        fn it_is_the_map_of_the_engine(
            center in -0.3..0.3_f64, gyration in 0.2..0.6_f64, e in 0.0..0.7_f64, first_a in any::<bool>(),
            tilt_rad in 1e-3..0.3_f64, ends in (-0.07..0.07_f64, 0.0..0.03_f64), hz in 10.0..500.0_f64,
            zeta in 0.01..2.0_f64, contact in proptest::option::of(1e-4..1e-3_f64), hard in any::<bool>(),
        ) {
            let length = 0.14;
            let body = Body::off_center(0.5 * length * (1.0 + center), 0.5 * length * (1.0 - center), gyration * length).unwrap();
            let first = if first_a { End::A } else { End::B };
            let drop = Drop {
                direction_rad: Drop::towards(first), gravity_m_s2: 0.0, contact_time_s: contact, ..Drop::new(body, 3.0, tilt_rad, e)
            };
            let ends_m = [ends.0, (ends.0 + ends.1).min(0.07)];
            let suspension = (!hard).then(|| Suspension::from_hz(hz, DampingRatio::new(zeta).unwrap()).unwrap());
            let boundary = Limit { critical_acceleration_m_s2: 2e4, ..Limit::new(LimitKind::DamageBoundary, 4.0) };
            let mut limits =
                vec![Limit::new(LimitKind::VelocityChange, 4.0), Limit::new(LimitKind::AngularVelocityChange, 80.0), boundary];
            if !hard {
                limits.push(Limit::new(LimitKind::RattleSpace, 0.01));
            }
            if !hard || contact.is_some() {
                limits.push(Limit::new(LimitKind::Acceleration, 3000.0));
            }
            for limit in limits {
                let (at_m, inside) = ([ends_m[0], 0.0], Inside::default());
                let reaches_m = [ends_m, [0.0; 2]];
                let part = PartSample { number: 0, skipped: 0, at_m, reaches_m, inside, suspension, limits: vec![limit] };
                let known = part.ends().iter().map(|x| {
                    let part = Part::new(*x, suspension);
                    crate::answer(&drop, &part, &limit, Model::Map, 1e-6).unwrap().utilization()
                });
                let known = known.fold(0.0, f64::max);
                let sample = Sample { uniforms: Vec::new(), drops: vec![drop], parts: vec![part] };
                let mut asked = Vec::new();
                answer(&sample, &mut asked);
                let found = asked[0];
                prop_assert!((found - known).abs() <= 0.01 * known.max(0.1), "{:?}: {found}, not {known}", limit.kind);
            }
        }
    }
}
