//! Drops with gravity, at real tilt, of bars whose mass is off the center: an own simulation with instant impacts.

use clatter::End;
use clatter_fit::Known;
use clatter_flight::{Body, ContactLaw};
use clatter_product::First;

use super::synthetic::Random;

pub(crate) const G: f64 = 9.806_65;

/// A bar that falls, end a first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Falling {
    /// From the center of mass to ends a and b, in m.
    pub(crate) arms: [f64; 2],
    /// Radius of gyration, in m.
    pub(crate) rho: f64,
    pub(crate) e: f64,
    /// At the first touch, in m/s and rad.
    pub(crate) speed: f64,
    pub(crate) tilt: f64,
}

impl Falling {
    /// A hand-held product in some drop.
    pub(crate) fn random(random: &mut Random) -> Self {
        let (length, off) = (random.within(0.1, 0.25), random.within(-0.05, 0.05));
        let half = 0.5 * length;
        Self {
            arms: [half * (1.0 + off), half * (1.0 - off)],
            rho: half * random.within(0.4, 0.65),
            e: random.within(0.25, 0.6),
            speed: random.within(2.5, 5.0),
            tilt: random.within(0.5, 5.0_f64).to_radians(),
        }
    }

    /// Times and ends of so many strikes; fewer where the motion has no more of them that can be told apart.
    ///
    /// The height of an end is y + x sin φ, with y a parabola and φ a straight line, so that it curves by no more than g + |x| ω².
    /// From a height h and a rate u it thus takes at least (u + √(u² + 2 c h))/c to come down: steps of that never miss a
    /// touch, and close in on the first one.
    pub(crate) fn strikes(&self, most: usize) -> Vec<(f64, End)> {
        let x = [-self.arms[0], self.arms[1]];
        let (mut y, mut v, mut phi, mut w) = (self.arms[0] * self.tilt.sin(), -self.speed, self.tilt, 0.0_f64);
        let (mut now, mut strikes) = (0.0, Vec::new());
        let mut end = 0;
        while strikes.len() < most {
            strikes.push((now, if end == 0 { End::A } else { End::B }));
            // The impulse that turns the rate of the end, u, to −e u.
            let lever = x[end] * phi.cos();
            let impulse = -(1.0 + self.e) * (v + lever * w) / (1.0 + (lever / self.rho).powi(2));
            v += impulse;
            w += impulse * lever / self.rho.powi(2);
            let touch = |i: usize| {
                let curve = G + x[i].abs() * w * w;
                let mut t = 0.0;
                for _ in 0..200 {
                    let (sin, cos) = (phi + w * t).sin_cos();
                    // The end that struck is on the ground.
                    let height = if t == 0.0 && i == end { 0.0 } else { y + (v - 0.5 * G * t) * t + x[i] * sin };
                    let rate = v - G * t + x[i] * cos * w;
                    let step = (rate + (rate * rate + 2.0 * curve * height.max(0.0)).sqrt()) / curve;
                    t += step;
                    if step < 1e-15 {
                        break;
                    }
                }
                t
            };
            let waits = [touch(0), touch(1)];
            end = usize::from(waits[1] < waits[0]);
            let wait = waits[end];
            if wait < 1e-5 {
                break;
            }
            now += wait;
            y += (v - 0.5 * G * wait) * wait;
            v -= G * wait;
            phi += w * wait;
        }
        strikes
    }

    /// What a product file says of it: the radius of gyration is a tenth off, the speed within a share of the truth.
    pub(crate) fn known(&self, share: f64, random: &mut Random) -> Known {
        let middle = self.speed / (1.0 + share * random.within(-1.0, 1.0));
        Known {
            body: Body::off_center(self.arms[0], self.arms[1], 1.1 * self.rho).expect("as the test has it"),
            gyration_m: [1.1 * self.rho; 2],
            gyration_known: false,
            first: First::Either,
            gravity_m_s2: G,
            restitution: [0.2, 0.7],
            speed_m_s: [middle * (1.0 - share), middle * (1.0 + share)],
            tilt_rad: [0.0, 0.2],
            contact_time_s: None,
            contact_law: ContactLaw::Hysteretic,
        }
    }
}
