//! Bounds on the response to velocity shocks whose times and sizes are known to within ranges only.
//!
//! Two unknowns ξ₁, ξ₂ in [−1, 1] move phases and velocity changes; what they do not do to first order is bounded. The
//! state m = (x, y) of the component, x = ωz, y = z′, is carried as
//!
//! ```text
//! m = c + g₁ ξ₁ + g₂ ξ₂ + (anything of size up to r)        in the energy norm |m|² = x² + y²
//! ```
//!
//! Free motion P(ψ) never makes the norm larger, and with m′ = M m, M = [[0, 1], [−1, −2ζ]], |M| = μ = ζ + √(1 + ζ²),
//!
//! ```text
//! P(ψ₀ + δ) m = P(ψ₀) m + δ M P(ψ₀) m + (up to ½ δ² |M² P(ψ_lo) m|)             for ψ₀, ψ₀ + δ ≥ ψ_lo
//! |q_k(m)| ≤ max over ξ = ±1 of |q_k(c + g₁ξ₁ + g₂ξ₂)| + G_k r,    G = 1 for ωz, √(1 + 4ζ²) for A/ω
//! ```
//!
//! because q_k is linear. What is left in doubt thus shrinks like the square of the ranges. Where a phase is too
//! uncertain for this, either the state is anything of its size, or the shock is: by superposition it adds at most its
//! own response, whenever it comes. The middle of all ranges is followed exactly: its peak is attained, so each call
//! bounds from below and from above.

use crate::suspension::{Modes, Motion, Phase, Propagator};
use crate::{DampingRatio, peaks::Range};

/// A velocity shock known to within ranges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LooseShock {
    /// Phase ω(t − t′) since the shock before, in the middle of all ranges. Phases of the first shock are not used.
    pub phase: f64,
    /// What the two unknowns do to it at most, to first order, each with its sign for +1.
    pub phase_by: [f64; 2],
    /// How far it may be from that, each unknown's part: for both together, the sum.
    pub phase_rest: [f64; 2],
    /// It is at least this.
    pub least_phase: f64,
    /// It is at most this; may be infinite.
    pub most_phase: f64,
    /// Velocity change in the middle.
    pub delta_v: f64,
    /// What the second unknown does to it.
    pub delta_v_by: f64,
    /// How far it may be from that.
    pub delta_v_rest: f64,
    /// Its absolute value is at most this.
    pub most_delta_v: f64,
}

impl LooseShock {
    /// A shock that is known.
    #[must_use]
    pub fn known(phase: f64, delta_v: f64) -> Self {
        Self {
            phase,
            phase_by: [0.0; 2],
            phase_rest: [0.0; 2],
            least_phase: phase,
            most_phase: phase,
            delta_v,
            delta_v_by: 0.0,
            delta_v_rest: 0.0,
            most_delta_v: delta_v.abs(),
        }
    }
}

/// Which peak is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Peaked {
    /// ω|z|.
    PseudoVelocity,
    /// |A|/ω.
    AccelerationOverOmega,
}

impl Peaked {
    pub(crate) fn row(self) -> usize {
        match self {
            Self::PseudoVelocity => Modes::DISPLACEMENT,
            Self::AccelerationOverOmega => Modes::ACCELERATION,
        }
    }
}

/// A peak from below and from above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeakBounds {
    /// The peak in the middle of all ranges: attained.
    pub middle: f64,
    /// No choice within the ranges passes it.
    pub upper: f64,
    /// A measure of what each unknown leaves in doubt, for choosing the range to be halved.
    pub doubt: [f64; 2],
}

/// Bounds on the peak of a component over all shocks within their ranges, ring-down included.
///
/// `omitted` bounds the sum of all |Δv| after the last shock of the list, wherever they come.
///
/// # Accuracy
/// The bounds hold for exact arithmetic; roundings are below 1e−12 of the sum of all |Δv|.
///
/// # Examples
/// One shock of 2 ± 0.1, and perhaps others of up to 0.3 in all, at any time:
/// ```
/// use clatter_shock::{DampingRatio, LooseShock, Peaked, peak_bounds};
/// let first = LooseShock { delta_v_rest: 0.1, most_delta_v: 2.1, ..LooseShock::known(0.0, 2.0) };
/// let zeta = DampingRatio::new(0.0)?;
/// let bounds = peak_bounds(zeta, Peaked::PseudoVelocity, &[first], 0.3);
/// assert!((bounds.middle - 2.0).abs() < 1e-15 && (bounds.upper - 2.4).abs() < 1e-15);
/// # Ok::<(), clatter_shock::Error>(())
/// ```
#[must_use]
pub fn peak_bounds(damping: DampingRatio, peaked: Peaked, shocks: &[LooseShock], omitted: f64) -> PeakBounds {
    let modes = Modes::new(damping);
    let row = peaked.row();
    let gain = match peaked {
        Peaked::PseudoVelocity => 1.0,
        Peaked::AccelerationOverOmega => (2.0 * modes.zeta).hypot(1.0),
    };
    let mut loose = Loose {
        row,
        gain,
        center: Motion::default(),
        by: [Motion::default(); 2],
        rest: 0.0,
        late: 0.0,
        doubt: [0.0; 2],
    };
    let (mut middle, mut attained) = (Motion::default(), Range::default());
    let (mut upper, mut worst_doubt) = (0.0, [0.0; 2]);
    // Since the state was last brought up to date, shocks may have been left to the rest.
    let mut pending = Gap::default();
    for (i, shock) in shocks.iter().enumerate() {
        if i > 0 {
            attained.note_free(&modes, row, middle, shock.phase, 0);
            middle = modes.propagator(Phase::product(1.0, shock.phase)).apply(modes.p, middle);
            attained.note(0, 0.0, modes.quantity(row, middle));
            pending.add(shock);
            loose.swing(&modes, pending.most, &mut upper, &mut worst_doubt);
            if !loose.advance(&modes, &pending, shock) {
                // The shock as an addition to what there is, whenever it comes.
                loose.late += shock.most_delta_v;
                loose.blame(&pending, shock.most_delta_v);
                middle.w -= shock.delta_v;
                continue;
            }
            pending = Gap::default();
            // What the motion is when this shock comes.
            loose.note(&modes, &mut upper, &mut worst_doubt);
        }
        middle.w -= shock.delta_v;
        loose.center.w -= shock.delta_v;
        loose.by[1].w -= shock.delta_v_by;
        loose.rest += shock.delta_v_rest;
        loose.doubt[1] += shock.delta_v_rest;
        loose.note(&modes, &mut upper, &mut worst_doubt);
    }
    loose.rest += omitted;
    loose.swing(&modes, f64::INFINITY, &mut upper, &mut worst_doubt);
    attained.note_free(&modes, row, middle, f64::INFINITY, 0);
    PeakBounds { middle: attained.high.value.max(-attained.low.value), upper, doubt: worst_doubt }
}

/// Phase since the state was last brought up to date.
#[derive(Debug, Clone, Copy, Default)]
struct Gap {
    middle: f64,
    by: [f64; 2],
    rest: [f64; 2],
    least: f64,
    most: f64,
}

impl Gap {
    fn add(&mut self, shock: &LooseShock) {
        self.middle += shock.phase;
        for i in 0..2 {
            self.by[i] += shock.phase_by[i];
            self.rest[i] += shock.phase_rest[i];
        }
        self.least += shock.least_phase;
        self.most += shock.most_phase;
    }
    /// What each unknown moves the phase by.
    fn reach(&self) -> [f64; 2] {
        [0, 1].map(|i: usize| self.by[i].abs() + self.rest[i])
    }
}

/// The state over all ranges.
struct Loose {
    row: usize,
    gain: f64,
    center: Motion,
    by: [Motion; 2],
    rest: f64,
    /// What was left to the rest since the state was last brought up to date: it has had no time to decay.
    late: f64,
    /// Parts of the rest that each unknown is to blame for.
    doubt: [f64; 2],
}

impl Loose {
    /// Brings the state to the shock; false, and nothing done, where the shock is better left to the rest.
    fn advance(&mut self, modes: &Modes, gap: &Gap, shock: &LooseShock) -> bool {
        // What is in motion fades until the shock may come; the shock has not.
        let fade = modes.propagator(Phase::product(1.0, gap.least));
        let decay = modes.decay(gap.least, &fade);
        let faded = |m: Motion| fade.apply(modes.p, m);
        let center = faded(self.center);
        let [size, spread] = [modes.energy(center), self.by.iter().map(|by| modes.energy(faded(*by))).sum()];
        let moving = size + spread;
        let reach = gap.reach();
        let off = (reach[0] + reach[1]).min((gap.most - gap.middle).max(gap.middle - gap.least));
        let mu = modes.zeta + modes.zeta.hypot(1.0);
        if mu * off < 1.0 {
            let speed = modes.derivative(center);
            let bend = 0.5 * modes.energy(modes.derivative(speed));
            let speed = modes.energy(speed);
            let more = (gap.rest[0] + gap.rest[1]) * speed + mu * off * spread + off * off * bend;
            if more <= moving.min(shock.most_delta_v) {
                let step = modes.propagator(Phase::product(1.0, gap.middle));
                self.center = step.apply(modes.p, self.center);
                let now = modes.derivative(self.center);
                for (by, shift) in self.by.iter_mut().zip(gap.by) {
                    *by = step.apply(modes.p, *by);
                    by.x += shift * now.x;
                    by.w += shift * now.w;
                }
                self.rest = decay * self.rest + more + std::mem::take(&mut self.late);
                for ((doubt, reach), rest) in self.doubt.iter_mut().zip(reach).zip(gap.rest) {
                    // Crossed terms count for both.
                    *doubt = decay * *doubt + rest * speed + reach * (mu * spread + off * bend);
                }
                return true;
            }
        }
        if shock.most_delta_v <= moving {
            return false;
        }
        self.rest = decay * self.rest + moving + std::mem::take(&mut self.late);
        self.doubt = self.doubt.map(|doubt| decay * doubt);
        self.blame(gap, moving);
        (self.center, self.by) = (Motion::default(), [Motion::default(); 2]);
        true
    }
    /// Shares a part of the rest out by what each unknown does to the phase.
    fn blame(&mut self, gap: &Gap, rest: f64) {
        let reach = gap.reach();
        let all = reach[0] + reach[1];
        if all > 0.0 {
            for (doubt, reach) in self.doubt.iter_mut().zip(reach) {
                *doubt += rest * (reach / all).min(1.0);
            }
        }
    }
    /// The state at the corners of the unknowns.
    fn corners(&self) -> impl Iterator<Item = Motion> + use<> {
        let (c, [g, h]) = (self.center, self.by);
        let fixed = |m: Motion| m.x == 0.0 && m.w == 0.0;
        let signs = |m: Motion| if fixed(m) { [1.0, f64::NAN] } else { [1.0, -1.0] };
        let both = signs(h);
        signs(g).into_iter().filter(|s: &f64| !s.is_nan()).flat_map(move |s| {
            both.into_iter()
                .filter(|t: &f64| !t.is_nan())
                .map(move |t| Motion { x: c.x + s * g.x + t * h.x, w: c.w + s * g.w + t * h.w })
        })
    }
    /// Takes in the present state.
    fn note(&self, modes: &Modes, upper: &mut f64, doubt: &mut [f64; 2]) {
        let value = self.corners().fold(0.0_f64, |most, m| most.max(modes.quantity(self.row, m).abs()));
        self.raise(value, upper, doubt);
    }
    /// Takes in the free motion over `span`: its start and its turning points.
    fn swing(&self, modes: &Modes, span: f64, upper: &mut f64, doubt: &mut [f64; 2]) {
        let mut most = 0.0_f64;
        for corner in self.corners() {
            // Only what passes the bound so far counts.
            let seen = most.max(*upper - self.gain * (self.rest + self.late)).max(0.0);
            modes.free_extremes(self.row, corner, span, (-seen, seen), |_, value| most = most.max(value.abs()));
            most = most.max(modes.quantity(self.row, corner).abs());
        }
        self.raise(most, upper, doubt);
    }
    fn raise(&self, value: f64, upper: &mut f64, doubt: &mut [f64; 2]) {
        let bound = value + self.gain * (self.rest + self.late);
        if bound > *upper {
            (*upper, *doubt) = (bound, self.doubt);
        }
    }
}

impl Modes {
    /// The rate at which free motion changes the state.
    fn derivative(&self, m: Motion) -> Motion {
        Motion { x: m.w - self.sigma * m.x, w: -self.p * m.x - self.rho * m.w }
    }
    /// The norm of free motion over at least the phase `psi`, in the energy norm.
    fn decay(&self, psi: f64, step: &Propagator) -> f64 {
        if self.zeta * psi < 1e-2 {
            return 1.0; // within 2 % of it
        }
        // From (x, w) to (x, y), w = y + σx.
        let (xx, xy) = (step.c + self.sigma * step.s, step.s);
        let (yx, yy) = (self.sigma * step.k - self.p * step.s - self.sigma * xx, step.k - self.sigma * xy);
        let square = xx * xx + xy * xy + yx * yx + yy * yy;
        let det = xx * yy - xy * yx;
        (0.5 * (square + (square * square - 4.0 * det * det).max(0.0).sqrt())).sqrt().min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Suspension, VelocityShock, VelocityShocks};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        /// Any choice within the ranges stays below the upper bound; the middle is attained; the doubt shrinks like the
        /// square.
        #[test]
        fn no_choice_passes_the_bound(
            zeta in prop_oneof![0.0..0.3_f64, 0.3..3.0_f64],
            shocks in prop::collection::vec((0.0..20.0_f64, [-1.0..1.0_f64, -1.0..1.0_f64], -2.0..2.0_f64, -0.4..0.4_f64), 1..6),
            picks in [-1.0..=1.0_f64, -1.0..=1.0_f64],
            rests in prop::collection::vec((-1.0..=1.0_f64, -1.0..=1.0_f64), 6),
            narrow in prop_oneof![Just(0.0), Just(1e-4), Just(1e-2), Just(0.1), Just(1.0)],
            rest in prop_oneof![Just(0.0), Just(1.0)],
            acceleration in any::<bool>(),
        ) {
            let damping = DampingRatio::new(zeta).unwrap();
            let peaked = if acceleration { Peaked::AccelerationOverOmega } else { Peaked::PseudoVelocity };
            let loose: Vec<_> = shocks.iter().map(|&(gap, by, delta_v, delta_v_by)| {
                let (phase_by, phase_rest) = (by.map(|by| narrow * by), [0.3 * narrow * narrow * rest, 0.7 * narrow * narrow * rest]);
                let (delta_v_by, delta_v_rest) = (narrow * delta_v_by, 0.1 * narrow * narrow * rest);
                let reach = phase_by.iter().chain(&phase_rest).map(|by| by.abs()).sum::<f64>();
                LooseShock {
                    phase: gap + reach,
                    phase_by,
                    phase_rest,
                    least_phase: gap,
                    most_phase: gap + 2.0 * reach,
                    delta_v,
                    delta_v_by,
                    delta_v_rest,
                    most_delta_v: delta_v.abs() + delta_v_by.abs() + delta_v_rest,
                }
            }).collect();
            let bounds = peak_bounds(damping, peaked, &loose, 0.0);
            let peak = |[one, two]: [f64; 2], rests: &[(f64, f64)]| {
                let mut time = 0.0;
                let list = loose.iter().zip(rests).map(|(s, &(at, off))| {
                    time += s.phase + one * s.phase_by[0] + two * s.phase_by[1] + at * (s.phase_rest[0] + s.phase_rest[1]);
                    VelocityShock { time, delta_v: s.delta_v + two * s.delta_v_by + off * s.delta_v_rest }
                });
                let response = VelocityShocks::new(list.collect()).unwrap().respond(&Suspension::unit(damping));
                if acceleration { response.absolute_acceleration.magnitude() } else { response.relative_displacement.magnitude() }
            };
            let rounding = 6e-12 * (1.0 + zeta);
            let middle = peak([0.0; 2], &[(0.0, 0.0); 6]);
            prop_assert!((bounds.middle - middle).abs() <= rounding, "middle {} not {middle}", bounds.middle);
            for picks in [picks, [1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
                let some = peak(picks, &rests);
                prop_assert!(some <= bounds.upper + rounding, "{some} passes {}", bounds.upper);
            }
            // First order: all that the unknowns do. Second order: 5 shocks, each with μ² δ² of all that is in motion.
            let most = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]
                .map(|picks| peak(picks, &[(0.0, 0.0); 6])).into_iter().fold(middle, f64::max);
            let total: f64 = loose.iter().map(|s| s.most_delta_v).sum();
            let mu = zeta + zeta.hypot(1.0);
            let square = 100.0 * mu.powi(3) * (total + rest) * narrow * narrow;
            prop_assert!(bounds.upper - most <= square + rounding, "{} above {most} at {narrow}", bounds.upper);
        }
    }

    /// A long gap, however long exactly: what rang before it has faded, and the next shock stands alone.
    #[test]
    fn what_has_faded_adds_nothing_to_the_next_shock() {
        let damping = DampingRatio::new(1.0).unwrap();
        let second =
            LooseShock { phase_by: [1.0, 0.0], least_phase: 24.0, most_phase: 26.0, ..LooseShock::known(25.0, 0.4) };
        let upper = |first: f64| {
            peak_bounds(damping, Peaked::PseudoVelocity, &[LooseShock::known(0.0, first), second], 0.0).upper
        };
        // One shock swings out to its share 1/e.
        for first in [1.0, 0.2] {
            let alone = f64::max(first, 0.4) / std::f64::consts::E;
            assert!((upper(first) / alone - 1.0).abs() < 1e-8, "{} of {alone}", upper(first));
        }
    }

    /// A shock left to the rest, then a long gap closed: the rest once decayed over the whole gap, as if it had come at
    /// its beginning.
    #[test]
    fn what_is_left_to_the_rest_decays_from_when_it_comes() {
        let damping = DampingRatio::new(1.03).unwrap();
        let shock = |gap: f64, by: f64, delta_v: f64, delta_v_by: f64| LooseShock {
            phase: gap + by,
            phase_by: [0.0, by],
            least_phase: gap,
            most_phase: gap + 2.0 * by,
            delta_v_by,
            most_delta_v: delta_v + delta_v_by,
            ..LooseShock::known(gap, delta_v)
        };
        let loose = [shock(0.0, 0.0, 1.4, 0.03), shock(15.6, 0.1, 0.0, 0.02), shock(3.1, 0.0, 1.6, 0.0)];
        let upper = peak_bounds(damping, Peaked::PseudoVelocity, &loose, 0.0).upper;
        let mut time = 0.0;
        let list = loose.iter().map(|s| {
            time += s.phase + s.phase_by[1];
            VelocityShock { time, delta_v: s.delta_v + s.delta_v_by }
        });
        let response = VelocityShocks::new(list.collect()).unwrap().respond(&Suspension::unit(damping));
        let peak = response.relative_displacement.magnitude();
        assert!(peak <= upper, "{peak} passes {upper}");
    }
}
