//! What a place of the body feels: velocity shocks, and accelerations that are straight lines and sinusoids in time.
//!
//! Of impacts that take no time that is a velocity shock at each strike; at real tilt also what the turning of
//! the body does to the height of the place between them, `−ω² × height over the center of mass`. Of contacts it is a sum of
//! the modes of each phase.

use clatter::{Excitation, Section, Sine};

use crate::flight::Model;
use crate::motion::Motion;
use crate::scene::Scene;

/// Turn of a free flight, in rad, from which on a body tumbles: a part turns with it, so that what turning does to the height
/// of its place is nothing that it feels along its axis.
const TUMBLES: f64 = 0.5 * std::f64::consts::PI;

/// What turning at a spin does in a free flight of this length to a place at x, z on the body, from this tilt on: what is felt of it,
/// nothing where the body [tumbles](TUMBLES), and what it changes the velocity by in either case.
pub(crate) fn turning([x, z]: [f64; 2], tilt: f64, spin: f64, length_s: f64) -> (Sine, f64) {
    // −ω² (x sin φ + z cos φ) = −ω² r sin(φ + ψ)
    let (square, phase) = (spin * spin, tilt + libm::atan2(z, x));
    let side = if spin < 0.0 { -1.0 } else { 1.0 };
    let sine = Sine { amplitude: -side * square * libm::hypot(x, z), rate: spin.abs(), phase: side * phase };
    let change = Section { sines: &[sine], ..Section::shock(0.0, length_s, 0.0) }.velocity_after(length_s);
    (if spin.abs() * length_s > TUMBLES { Sine::default() } else { sine }, change)
}

impl Motion {
    /// What position `s` of a bar feels of instant impacts.
    pub(crate) fn felt_of_impacts(&self, scene: &Scene, s: f64) -> Excitation {
        let g = self.gravity_m_s2();
        let real = self.model == Model::FiniteTilt;
        let place = scene.body().place(s);
        let at = |[a, b]: [f64; 2]| 0.5 * ((1.0 - s) * a + (1.0 + s) * b);
        let end_s = self.stop.time_s();
        let mut felt = Excitation::with_capacity(self.strikes.len());
        for (k, strike) in self.strikes.iter().enumerate() {
            let next = self.strikes.get(k + 1);
            let until = next.map_or(end_s, |next| next.time_s).max(strike.time_s);
            let mut section = Section::shock(strike.time_s, until - strike.time_s, strike.delta_v_at(s));
            let mut turns = Sine::default();
            if real && next.is_some() {
                turns = turning(place, strike.tilt_rad, strike.spin_rad_s, section.length).0;
            }
            let first = self.pivots.partition_point(|p| p.from_s < strike.time_s);
            let pivots = self.pivots[first..].iter().take_while(|p| p.from_s < until);
            let mut velocity = at(strike.velocity_m_s);
            for pivot in pivots {
                let other = |v: f64| at(if pivot.point == 0 { [0.0, v] } else { [v, 0.0] });
                let flown = pivot.from_s - section.from;
                section.length = flown;
                let sines = [turns];
                let flying = Section { sines: &sines, ..section };
                velocity += flying.velocity_after(flown) - flying.delta_v - g * flown;
                felt.push(flying);
                let whole = pivot.until_s - pivot.from_s;
                let begin = other(pivot.velocity_m_s);
                let end = match (pivot.lift_off, next) {
                    (Some(off), _) => other(off.velocity_m_s),
                    (None, Some(next)) => other(next.approach_m_s),
                    (None, None) => begin,
                };
                let mean = if whole > 0.0 { (end - begin) / whole + g } else { 0.0 };
                let shock = Section::shock(pivot.from_s, whole, begin - velocity);
                felt.push(Section { acceleration: [mean; 2], ..shock });
                velocity = end;
                section = Section::shock(pivot.until_s, until - pivot.until_s, 0.0);
                turns = Sine::default();
                if let (true, Some(off)) = (real, pivot.lift_off) {
                    turns = turning(place, off.tilt_rad, off.spin_rad_s, section.length).0;
                }
            }
            felt.push(Section { sines: &[turns], ..section });
        }
        felt
    }

    /// How instant impacts turn the body: each as a shock.
    pub(crate) fn turned_by_impacts(&self, scene: &Scene) -> Excitation {
        let [a, b] = scene.body().arms_m();
        let real = self.model == Model::FiniteTilt;
        let (mut before, mut turned) = (scene.spin_rad_s(), Excitation::with_capacity(self.strikes.len()));
        for strike in &self.strikes {
            let cos = if real { libm::cos(strike.tilt_rad).abs() } else { 1.0 };
            // Next to upright the velocities of both ends say little of the turn; in flight the spin stays.
            let [da, db] = strike.delta_v_m_s;
            let turn = if cos > 0.1 { (db - da) / ((a + b) * cos) } else { strike.spin_rad_s - before };
            before = strike.spin_rad_s;
            turned.push(Section::shock(strike.time_s, 0.0, turn));
        }
        turned
    }
}
