//! Small tilt without gravity: the train of the map in SI, for a center of mass anywhere.
//!
//! With `κ = √((L_a² + ρ²)/(L_b² + ρ²))` the approach velocities `a_n` (n even) and `κ a_n` (n odd) obey the recurrence
//! of a symmetric bar with `q = ±√(q_a q_b)` (sign of `q_a`), started from `(v_a, κ v_b)` with the height gap κ h0.

use clatter::{Bar, Count, End, Start};

use crate::flight::{After, Flight, Log, SHARE, State, Stop};
use crate::scene::Scene;

impl Scene {
    /// Returns the symmetric bar and start with the train of this scene at small tilt without gravity, and κ:
    /// velocities of end b are κ times those of the scene, times are the same.
    #[must_use]
    pub fn symmetric_bar(&self) -> (Bar, Start, f64) {
        let body = self.body();
        let [a, b] = body.arms_m();
        let ratios = body.inertia_ratios();
        let kappa = (body.inertia(a) / body.inertia(b)).sqrt();
        let [va, vb] = self.level_velocities();
        let bar = if a - b == 0.0 {
            Bar::from_gyration_ratio(body.gyration_m() / a, self.e())
        } else {
            // The root of two ratios next to 1 may round above it.
            Bar::new((ratios[0] * ratios[1]).sqrt().min(1.0).copysign(ratios[0]), self.e())
        };
        let (Ok(bar), Ok(start)) = (bar, Start::new([va, kappa * vb], kappa * self.height_gap_m())) else {
            unreachable!("the bounds of a scene are within those of a bar and its start");
        };
        (bar, start, kappa)
    }
}

pub(super) fn simulate(scene: &Scene, mut enough: impl FnMut(&Log<2>) -> bool) -> Flight {
    let mut log = Log::new(scene.time_limit_s(), scene.impact_limit());
    let e = scene.e();
    let body = scene.body();
    let ratios = body.inertia_ratios();
    let (gap, [va, vb]) = (scene.height_gap_m(), scene.level_velocities());
    let (bar, start, kappa) = scene.symmetric_bar();
    let summary = bar.summary(&start);
    let endless = summary.count == Count::Endless;
    let settles = endless && summary.final_velocity.is_some();
    log.bounced_clear();
    let mut far = vb;
    for impact in bar.train(&start) {
        let i = usize::from(impact.end == End::B);
        let j = 1 - i;
        let u = if i == 0 { impact.approach } else { impact.approach / kappa };
        let jump = -(1.0 + e) * u;
        let mut delta_v = [0.0; 2];
        (delta_v[i], delta_v[j]) = (jump, -ratios[i] * jump);
        // The end that struck last has risen to h0 eⁿ |v_a|/|a_n|, in the symmetric bar's terms (the Casoratian).
        let n = i32::try_from(impact.number - 1).unwrap_or(i32::MAX);
        let symmetric = kappa * gap * e.powi(n) * va / impact.approach;
        let height = if j == 0 { symmetric } else { symmetric / kappa };
        let mut state = State { h: [0.0; 2], v: [0.0; 2] };
        state.h[j] = height;
        (state.v[i], state.v[j]) = (-e * u, far + delta_v[j]);
        far = -e * u;
        if !log.strike(i, impact.time, u, delta_v, &After::small(&state, body.length_m()), &mut enough) {
            return log.flight;
        }
        // The approach speeds of an endless train rise to one peak and fall for ever: later ones are slower.
        let left_s = summary.duration - impact.time;
        if settles && jump <= SHARE * log.largest_m_s && left_s <= f64::EPSILON * summary.duration {
            let time_s = summary.duration.max(impact.time); // to a rounding the same
            log.flight.stop = Stop::AtRest { time_s, time_bound_s: left_s.abs(), shock_bound_m_s: jump };
            return log.flight;
        }
    }
    log.bounced_clear();
    log.flight
}
