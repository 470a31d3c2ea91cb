//! This module draws the error and the cost of every model.

use clatter_assess::ladder::{LimitLadder, ProductLadder};
use clatter_figures::{FigureError, LadderPanel as Panel, ladders as panels, three};

use crate::words;

/// Draws a panel for each limit.
pub(crate) fn of_product(product: &ProductLadder) -> Result<String, FigureError> {
    panels(&product.limits.iter().map(|limit| of_limit(limit, product.tolerance)).collect::<Vec<_>>())
}

fn of_limit(limit: &LimitLadder, tolerance: f64) -> Panel<'_> {
    let LimitLadder { component, limit: kind, worst_case: worst, ladder } = limit;
    Panel {
        title: format!("{}: {}", words::name(component), kind.words()),
        drop: format!(
            "{} at {} m/s, {}°, e = {}",
            match worst.direction_deg() {
                Some(direction) => format!("a plate that rises to {}°", three(direction)),
                None => format!("end {} first", words::end(worst.drop.first())),
            },
            three(worst.drop.speed_m_s),
            three(worst.tilt_deg()),
            three(worst.drop.restitution)
        ),
        ladder,
        reason: words::reason(&ladder.reason),
        tolerance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::stay_within_their_frame;
    use clatter_assess::{Part, ladder::Ladder};
    use clatter_flight::Body;
    use clatter_product::{Drop, Limit, LimitKind};
    use clatter_shock::{DampingRatio, Suspension};

    /// A flat drop, a dead one and a lively one: errors beyond all scales, times that differ little.
    #[test]
    fn extremes_stay_in_the_frame() {
        let part = Suspension::from_hz(100.0, DampingRatio::new(0.0).unwrap()).unwrap();
        for (gyration_m, e, tilt_rad, contact_time_s) in
            [(0.01, 0.5, 0.1, None), (0.04, 0.0, 0.0, Some(1e-3)), (0.04, 0.6, 0.0, None)]
        {
            let drop = Drop {
                gravity_m_s2: 9.81,
                contact_time_s,
                ..Drop::new(Body::new(0.14, gyration_m).unwrap(), 1.0, tilt_rad, e)
            };
            for kind in [LimitKind::Acceleration, LimitKind::VelocityChange] {
                let place = Part::new(0.02, Some(part));
                let mut ladder = Ladder::measure(&drop, &place, &Limit::new(kind, 1.0), 0.01).unwrap();
                ladder.models[0].error = f64::INFINITY;
                let of = Panel {
                    title: "an *extreme* <one>".to_owned(),
                    drop: String::new(),
                    ladder: &ladder,
                    reason: String::new(),
                    tolerance: 0.01,
                };
                let svg = panels(&[of]).unwrap();
                assert!(svg.contains("off the scale") && svg.contains("&lt;one&gt;"), "{svg}");
                stay_within_their_frame(&[("extreme.svg", svg)]);
            }
        }
    }
}
