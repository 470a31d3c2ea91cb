//! One drop on the gravity-free rung, fast: its train, and the peaks of a suspended part, no more.
//!
//! The same answers as `clatter::Bar::train` and `clatter_shock::respond` for a fall without spin, to 1e−9 of the peak,
//! for damping ratios below [`LARGEST_DAMPING`] and a center of mass anywhere; only `libm`, so that a sample gives the
//! same digits on any machine.

use clatter::End;
use clatter::flight::Body;

/// Beyond, a part hardly swings and the exact response is asked.
pub(super) const LARGEST_DAMPING: f64 = 0.95;
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

    /// The shocks at a position: when and by how much.
    pub(super) fn shocks_at(&self, s: f64) -> impl Iterator<Item = (f64, f64)> {
        let mut time_s = 0.0;
        self.shocks.iter().map(move |shock| {
            time_s += shock.gap_s;
            (time_s, at(shock, s))
        })
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

/// Largest relative displacement and absolute acceleration of a part.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Peaks {
    pub(super) displacement: f64,
    pub(super) acceleration: f64,
}

impl Peaks {
    pub(super) fn raise(&mut self, other: &Self) {
        self.displacement = self.displacement.max(other.displacement);
        self.acceleration = self.acceleration.max(other.acceleration);
    }
    fn scaled(self, omega: f64) -> Self {
        Self { displacement: self.displacement / omega, acceleration: self.acceleration * omega }
    }
}

/// x = ωz and w = z′ + ζωz, both velocities.
#[derive(Debug, Clone, Copy)]
struct Motion {
    x: f64,
    w: f64,
}

/// A quantity of free motion, `of_x x + of_w w`.
#[derive(Debug, Clone, Copy)]
struct Row {
    of_x: f64,
    of_w: f64,
}

impl Row {
    fn of(self, m: Motion) -> f64 {
        self.of_x * m.x + self.of_w * m.w
    }
}

/// Free motion of a part with damping ratio ζ < 1: z = e^(−ζτ)(x cos βτ + w sin(βτ)/β)/ω, β = √(1 − ζ²).
#[derive(Debug, Clone, Copy)]
pub(super) struct Swing {
    zeta: f64,
    beta: f64,
    /// β².
    p: f64,
    /// Derivatives by τ of x and of A/ω.
    slopes: [Row; 2],
    /// A/ω.
    acceleration: Row,
    /// Power series of e^(−ζτ) cos βτ and e^(−ζτ) sin(βτ)/β, from the highest power down.
    series: [[f64; TERMS]; 2],
}

const TERMS: usize = 13;
/// Up to this phase the series leaves less than 0.5¹³/13! = 2e−14.
const SMALL_PHASE: f64 = 0.5;

impl Swing {
    pub(super) fn new(zeta: f64) -> Self {
        let p = (1.0 - zeta) * (1.0 + zeta);
        // (−ζ + iβ)^k/k!, by real and imaginary part over β
        let (mut series, mut power, mut factorial) = ([[0.0; TERMS]; 2], [1.0, 0.0], 1.0);
        for k in 0..TERMS {
            for (part, value) in series.iter_mut().zip(power) {
                part[TERMS - 1 - k] = value / factorial;
            }
            power = [-zeta * power[0] - p * power[1], power[0] - zeta * power[1]];
            #[expect(clippy::cast_precision_loss, reason = "a small whole number")]
            let next = (k + 1) as f64;
            factorial *= next;
        }
        let square = zeta * zeta;
        Self {
            zeta,
            beta: p.sqrt(),
            p,
            slopes: [
                Row { of_x: -zeta, of_w: 1.0 },
                Row { of_x: zeta * (3.0 - 4.0 * square), of_w: 4.0 * square - 1.0 },
            ],
            acceleration: Row { of_x: 2.0 * square - 1.0, of_w: -2.0 * zeta },
            series,
        }
    }

    fn acceleration(&self, m: Motion) -> f64 {
        self.acceleration.of(m)
    }

    /// What x, A/ω and z′ are at their turning points, but for the decay.
    fn amplitude(&self, m: Motion) -> f64 {
        (m.w * m.w + self.p * m.x * m.x).sqrt()
    }

    #[inline]
    fn after(&self, m: Motion, phase: f64) -> Motion {
        let [c, s] = if phase < SMALL_PHASE {
            self.series.map(|terms| terms.iter().fold(0.0, |sum, term| sum * phase + term))
        } else {
            let (sin, cos) = libm::sincos(self.beta * phase);
            let decay = libm::exp(-self.zeta * phase);
            [decay * cos, decay * sin / self.beta]
        };
        Motion { x: c * m.x + s * m.w, w: c * m.w - self.p * s * m.x }
    }

    /// Takes in the values between two shocks.
    #[inline]
    fn note_between(&self, start: Motion, end: Motion, phase: f64, peaks: &mut Peaks) {
        let amplitude = self.amplitude(start);
        let swings = self.beta * phase >= std::f64::consts::PI;
        for (slope, peak) in self.slopes.iter().zip([&mut peaks.displacement, &mut peaks.acceleration]) {
            if amplitude > *peak && (swings || slope.of(start) * slope.of(end) < 0.0) {
                let tau = self.turn(*slope, start);
                if tau < phase {
                    *peak = peak.max(amplitude * libm::exp(-self.zeta * tau));
                }
            }
        }
        peaks.displacement = peaks.displacement.max(end.x.abs());
        peaks.acceleration = peaks.acceleration.max(self.acceleration(end).abs());
    }

    fn note_ring_down(&self, m: Motion, peaks: &mut Peaks) {
        let amplitude = self.amplitude(m);
        for (slope, peak) in self.slopes.iter().zip([&mut peaks.displacement, &mut peaks.acceleration]) {
            if amplitude > *peak {
                *peak = peak.max(amplitude * libm::exp(-self.zeta * self.turn(*slope, m)));
            }
        }
    }

    /// When a slope vanishes first: it is e^(−ζτ)(r cos βτ + b sin(βτ)/β) with b = r′ + ζr.
    fn turn(&self, slope: Row, m: Motion) -> f64 {
        let r = slope.of(m);
        let bend = slope.of_x * m.w - slope.of_w * self.p * m.x;
        let angle = if r == 0.0 { std::f64::consts::PI } else { libm::atan2(self.beta * r.abs(), -bend * r.signum()) };
        angle / self.beta
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
    }
}
