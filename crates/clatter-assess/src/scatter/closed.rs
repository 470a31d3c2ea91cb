//! A sample in closed form: instant impacts, small tilt, no gravity.
//!
//! The same answers as `clatter::Bar::train` and `clatter_shock::respond` for a fall without spin, to 1e−9 of the peak,
//! for damping ratios below [`LARGEST_DAMPING`] and a center of mass anywhere; only `libm`, so that a sample gives the
//! same digits on any machine. Of a contact time only the acceleration of an impact comes, π Δv/(2τ).

use std::f64::consts::FRAC_PI_2;

use clatter::End;
use clatter_flight::Body;

use super::Asked;
use super::sample::{PartSample, Sample};
use super::swing::{LARGEST_DAMPING, Motion, Peaks, Swing};
use crate::{Limit, LimitKind, Mount, ProductFile};

/// What is left of a train counts no more below this share of its largest shock.
const NEGLIGIBLE: f64 = 1e-11;
/// What is left of an endless train counts as one instant below this phase of the fastest part.
const INSTANT: f64 = 1e-10;
/// How near the ratio of neighboring approach speeds is to its limit then, as a share of it.
const SETTLED: f64 = 1e-7;
/// Strikes followed at most: an elastic body whose mass is all in the middle might strike longer than anyone waits.
const MOST: usize = 1 << 16;

/// A bar with e at hand; end 0 strikes first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Falling {
    /// Inertia ratios for strikes at end 0 and 1.
    ratio: [f64; 2],
    /// √((L_a² + ρ²)/(L_b² + ρ²)), by which velocities of end 1 count in the symmetric bar with the same clatter.
    kappa: f64,
    q: f64,
    length_m: f64,
}

impl Falling {
    pub(super) fn new(body: &Body, first: End) -> Self {
        let swap = |[a, b]: [f64; 2]| if first == End::A { [a, b] } else { [b, a] };
        let (ratio, arm) = (swap(body.inertia_ratios()), swap(body.arms_m()));
        let inertia = arm.map(|arm| arm * arm + body.gyration_m() * body.gyration_m());
        let q = (ratio[0] * ratio[1]).sqrt().copysign(ratio[0]);
        Self { ratio, kappa: (inertia[0] / inertia[1]).sqrt(), q, length_m: body.length_m() }
    }
}

/// A jump of the velocities of both ends.
#[derive(Debug, Clone, Copy)]
struct Shock {
    /// Since the shock before.
    gap_s: f64,
    delta_v: [f64; 2],
    /// Bound on the sum of all later shocks at any place.
    left: f64,
}

/// The shocks of one drop; kept from drop to drop for its memory.
#[derive(Debug, Default)]
pub(super) struct Clatter {
    shocks: Vec<Shock>,
    /// How many of them are single strikes: the last may stand for many at one instant.
    strikes: usize,
}

impl Clatter {
    /// Follows the drop, for parts of angular frequencies up to `fastest`.
    ///
    /// # Formulas
    /// Approach speeds y_n by `y_{n+1} = T y_n − e y_{n−1}`, T = q(1 + e), y_0 = v0, y_1 = (T + κ) v0; gaps in time,
    /// without cancellation, as `κ h0 e^(n−1) y_0/(y_n y_{n−1})` (the Casoratian of the recurrence).
    pub(super) fn follow(&mut self, bar: &Falling, e: f64, speed: f64, tilt_rad: f64, fastest: f64) {
        let Falling { ratio, kappa, q, length_m } = *bar;
        let t = q * (1.0 + e);
        let over = t * t - 4.0 * e;
        let root = 0.5 * (t + over.max(0.0).sqrt());
        let gap = kappa * length_m * libm::sin(tilt_rad);
        // the limit that the times of an endless train tend to
        let end_s = gap / (speed * (root + kappa));
        let farthest = (1.0 + e) * ratio[0].abs().max(ratio[1].abs()).max(1.0) * (1.0 / kappa).max(1.0);
        self.shocks.clear();
        let mut y = speed;
        let mut next = t * y + kappa * speed;
        let (mut gap_s, mut time_s, mut scale, mut largest) = (0.0, 0.0, gap * speed, 0.0_f64);
        let mut closing = 0;
        let left = loop {
            let n = self.shocks.len();
            self.strikes = n + 1;
            let i = n % 2;
            let u = if i == 0 { y } else { y / kappa };
            let hit = (1.0 + e) * u;
            let mut delta_v = [hit; 2];
            delta_v[1 - i] = -ratio[i] * hit;
            self.shocks.push(Shock { gap_s, delta_v, left: 0.0 });
            largest = largest.max(y);
            if next <= 0.0 || n == MOST {
                break 0.0;
            }
            let fall = next / y;
            let rest = if fall < 1.0 { farthest * y * fall / (1.0 - fall) } else { f64::INFINITY };
            if rest <= NEGLIGIBLE * largest {
                break rest;
            }
            // The states between strikes alternate in a constant ratio by then, so that the first of each kind is the
            // largest.
            let settled = (fall - root).abs() <= SETTLED * root;
            if over >= 0.0
                && settled
                && (end_s - time_s).max(0.0) <= (INSTANT / fastest).max(8.0 * f64::EPSILON * end_s)
            {
                closing += 1;
                if closing == 3 {
                    // Two strikes have shown both states that alternate; what follows, at this instant, ends at rest.
                    let mut velocity = [-e * u; 2];
                    velocity[i] = e * u;
                    velocity[1 - i] = if i == 0 { -next / kappa } else { -next };
                    self.shocks.push(Shock { gap_s: 0.0, delta_v: velocity.map(|v| -v), left: 0.0 });
                    break 0.0;
                }
            }
            let before = y;
            (y, next) = (next, t * next - e * y);
            gap_s = scale / (y * before);
            time_s += gap_s;
            scale *= e;
        };
        let mut sum = left;
        for shock in self.shocks.iter_mut().rev() {
            shock.left = sum;
            sum += shock.delta_v[0].abs().max(shock.delta_v[1].abs());
        }
    }

    /// Largest single velocity shock at position s in [−1, 1], where −1 is the end that strikes first.
    pub(super) fn largest_shock(&self, s: f64) -> f64 {
        self.shocks[..self.strikes].iter().fold(0.0_f64, |most, shock| most.max(at(shock, s).abs()))
    }

    /// Largest single change of the angular velocity.
    pub(super) fn largest_turn(&self, length_m: f64) -> f64 {
        let turn = |shock: &Shock| (shock.delta_v[1] - shock.delta_v[0]).abs();
        self.shocks[..self.strikes].iter().fold(0.0_f64, |most, shock| most.max(turn(shock))) / length_m
    }

    /// Peaks of a part at position s with angular frequency `omega`.
    pub(super) fn peaks(&self, s: f64, omega: f64, swing: &Swing) -> Peaks {
        let mut peaks = Peaks::default();
        let mut m = Motion { x: 0.0, w: 0.0 };
        for shock in &self.shocks {
            let phase = omega * shock.gap_s;
            if phase > 0.0 {
                let start = m;
                m = swing.after(m, phase);
                swing.note_between(start, m, phase, &mut peaks);
            }
            m.w -= at(shock, s);
            peaks.acceleration = peaks.acceleration.max(swing.acceleration(m).abs());
            // No quantity passes N/β, and N grows by no more than the shocks to come.
            let bound = swing.amplitude(m) + shock.left;
            if bound <= swing.beta * peaks.displacement.min(peaks.acceleration) {
                return peaks.scaled(omega);
            }
        }
        swing.note_ring_down(m, &mut peaks);
        peaks.scaled(omega)
    }
}

fn at(shock: &Shock, s: f64) -> f64 {
    0.5 * ((1.0 - s) * shock.delta_v[0] + (1.0 + s) * shock.delta_v[1])
}

/// Answers samples of one body.
#[derive(Debug)]
pub(super) struct Closed {
    /// By the end that touches first.
    bars: [Falling; 2],
    length_m: f64,
    clatter: Clatter,
}

impl Closed {
    /// Whether it has an answer for every sample of a product.
    pub(super) fn takes(file: &ProductFile) -> bool {
        let swings = |mount: &Mount| match mount {
            Mount::Hard => true,
            Mount::Suspended { damping, .. } => damping.ratios()[1] < LARGEST_DAMPING,
        };
        file.product.body.gyration_m() > 0.0 && file.components.iter().all(|component| swings(&component.mount))
    }

    pub(super) fn new(body: &Body) -> Self {
        let bars = [End::A, End::B].map(|first| Falling::new(body, first));
        Self { bars, length_m: body.length_m(), clatter: Clatter::default() }
    }

    /// What a sample asks of every part.
    pub(super) fn answer(&mut self, sample: &Sample, asked: &mut Vec<Asked>) {
        let drop = &sample.drop;
        let fastest = sample.parts.iter().filter_map(|part| Some(part.suspension?.omega())).fold(1.0, f64::max);
        let (bar, side) = if drop.first == End::A { (&self.bars[0], 1.0) } else { (&self.bars[1], -1.0) };
        self.clatter.follow(bar, drop.restitution, drop.speed_m_s, drop.tilt_rad, fastest);
        asked.clear();
        asked.extend(sample.parts.iter().map(|part| self.of_part(part, side, drop.contact_time_s)));
    }

    fn of_part(&self, part: &PartSample, side: f64, contact_time_s: Option<f64>) -> Asked {
        let swing =
            part.suspension.as_ref().map(|suspension| (suspension.omega(), Swing::new(suspension.damping().get())));
        let responds = part.limits.iter().any(Limit::is_response);
        let swing = swing.filter(|_| responds);
        let (mut peaks, mut shock) = (Peaks::default(), 0.0_f64);
        for place in part.places() {
            let s = side * 2.0 * place / self.length_m;
            shock = shock.max(self.clatter.largest_shock(s));
            if let Some((omega, swing)) = &swing {
                peaks.raise(&self.clatter.peaks(s, *omega, swing));
            }
        }
        // The half-sine of a velocity change within the contact time.
        let acceleration = shock * FRAC_PI_2 / contact_time_s.unwrap_or(0.0);
        let mut asked = Asked::default();
        for (k, limit) in part.limits.iter().enumerate() {
            let used = match (limit.kind, &swing) {
                (LimitKind::Acceleration, Some(_)) => peaks.acceleration / limit.allowed,
                (LimitKind::RattleSpace, Some(_)) => peaks.displacement / limit.allowed,
                (LimitKind::Acceleration | LimitKind::RattleSpace, None) => acceleration / limit.allowed,
                (LimitKind::VelocityChange, _) => shock / limit.allowed,
                (LimitKind::AngularVelocityChange, _) => self.clatter.largest_turn(self.length_m) / limit.allowed,
                (LimitKind::DamageBoundary, _) => {
                    let by_change = shock / limit.allowed;
                    let by_acceleration = acceleration / limit.critical_acceleration_m_s2;
                    // Damage only beyond both; without a contact time the velocity change alone counts.
                    if contact_time_s.is_some() { by_change.min(by_acceleration) } else { by_change }
                }
            };
            asked.raise(k, used, 0.0);
        }
        asked
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Limit, SingleDrop};
    use clatter::{Bar, Start};
    use clatter_shock::{DampingRatio, Suspension, respond};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]
        /// Peaks and shocks against the exact train and response.
        #[test]
        fn peaks_are_those_of_the_exact_response(
            q in -0.6..0.98_f64, e in 0.0..0.97_f64, s in -1.0..=1.0_f64, log_omega in -4.0..6.0_f64,
            zeta in prop_oneof![Just(0.0), 0.0..0.9_f64], tilt in prop_oneof![Just(0.0), 1e-4..0.3_f64],
        ) {
            let half = 0.07;
            let body = Body::new(2.0 * half, half * ((1.0 - q) / (1.0 + q)).sqrt()).unwrap();
            let omega = 10f64.powf(log_omega);
            let mut clatter = Clatter::default();
            clatter.follow(&Falling::new(&body, End::A), e, 3.0, tilt, omega);
            let found = clatter.peaks(s, omega, &Swing::new(zeta));
            let (bar, start) = (Bar::new(q, e).unwrap(), Start::new([-3.0; 2], 2.0 * half * tilt.sin()).unwrap());
            let exact = respond(&bar, &start, s, &Suspension::new(omega, DampingRatio::new(zeta).unwrap()).unwrap()).unwrap();
            let known = exact.response;
            // A part near a center of percussion answers to what is left of large shocks.
            let slack = 1e-9 * bar.peak(&start).end;
            let off = (found.displacement - known.relative_displacement.magnitude()).abs() * omega;
            prop_assert!(off <= slack, "displacement {} not {}", found.displacement, known.relative_displacement.magnitude());
            let off = (found.acceleration - known.absolute_acceleration.magnitude()).abs() / omega;
            prop_assert!(off <= slack, "acceleration {} not {}", found.acceleration, known.absolute_acceleration.magnitude());
            let largest = bar.train(&start).take(400).map(|impact| impact.delta_v_at(s).abs()).fold(0.0, f64::max);
            let shock = clatter.largest_shock(s);
            prop_assert!((shock - largest).abs() <= slack, "shock {shock} not {largest}");
            prop_assert!((clatter.largest_turn(2.0 * half) * half - bar.peak(&start).angular).abs() <= slack, "turning");
        }

        /// Every limit of every part against the map and the exact response, with either end first.
        #[test]
        fn samples_are_those_of_the_map(
            center in -0.3..0.3_f64, gyration in 0.2..0.6_f64, e in 0.0..0.9_f64, first_a in any::<bool>(),
            tilt_rad in 1e-3..0.3_f64, ends in (-0.07..0.07_f64, 0.0..0.03_f64), hz in 10.0..500.0_f64,
            zeta in 0.01..0.6_f64, contact in proptest::option::of(1e-4..1e-3_f64), hard in any::<bool>(),
        ) {
            let length = 0.14;
            let body = Body::off_center(0.5 * length * (1.0 + center), 0.5 * length * (1.0 - center), gyration * length).unwrap();
            let drop = SingleDrop {
                body, first: if first_a { End::A } else { End::B }, tilt_rad, flat: false, speed_m_s: 3.0, restitution: e,
                gravity_m_s2: 0.0, contact_time_s: contact, contact_law: crate::ContactLaw::Hysteretic,
            };
            let ends_m = [ends.0, (ends.0 + ends.1).min(0.07)];
            let damping = DampingRatio::new(zeta).unwrap();
            let suspension = (!hard).then(|| Suspension::from_hz(hz, damping).unwrap());
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
                let part = PartSample { position_m: ends_m[0], ends_m, suspension, limits: vec![limit] };
                let known = part.places().iter().map(|x| {
                    let part = crate::Part { position_m: *x, suspension };
                    crate::answer(&drop, &part, &limit, crate::Model::Map, 1e-6).unwrap().utilization()
                });
                let known = known.fold(0.0, f64::max);
                let sample = Sample { uniforms: Vec::new(), drop, parts: vec![part] };
                let mut asked = Vec::new();
                Closed::new(&body).answer(&sample, &mut asked);
                // The map of the engine leaves strikes out that cannot count.
                let found = asked[0].utilization;
                prop_assert!((found - known).abs() <= 1e-5 * known.max(0.1), "{:?}: {found}, not {known}", limit.kind);
            }
        }
    }
}
