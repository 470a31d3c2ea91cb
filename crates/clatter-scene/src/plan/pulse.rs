//! The pulse of a lone contact: spring and dashpot with restitution e, in units of its duration and velocity change.
//!
//! Approached with velocity −1, an end has the velocity `−e^(−σt) (cos νt − (σ/ν) sin νt)` (cosh, sinh beyond critical
//! damping) until it leaves with e; the share `(v + e)/(1 + e)` of the velocity change, v the speed still downward, is
//! then to come.

use std::sync::OnceLock;

use clatter::flight::Contact;

use super::floats::{greater, lesser};
use super::quick;

/// The pulse of one restitution.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pulse {
    pub(super) e: f64,
    /// Natural frequency times duration, and damping ratio, of the contact.
    frequency: f64,
    damping: f64,
    /// When half of the moment has acted: the mean time of the velocity change.
    pub(crate) centroid: f64,
    /// Its variance about the mean.
    pub(crate) variance: f64,
    /// Share of a steady load over the contact time that the contact takes up beside its shock: `1 − s(1)`, with s the
    /// motion after a unit of velocity, since at the parting no force is left.
    pub(crate) carried: f64,
}

/// The table has nodes where e is 1 to 100 times the least, 128 in each doubling and evenly spaced there, so that the
/// leading bits of that number say which.
const LEAST: f64 = 0.01;
const CELL_BITS: u32 = 45;
/// 2⁻⁴⁵
const OF_CELL: f64 = 1.0 / 35_184_372_088_832.0;
const CELLS: usize = 840;

/// A fit takes some 30 µs; a table is read in 10 ns and is within 1e-4. It is filled where it is read.
static TABLE: [OnceLock<Pulse>; CELLS + 1] = [const { OnceLock::new() }; CELLS + 1];

/// The restitution of node k.
fn node(k: usize) -> f64 {
    (LEAST * f64::from_bits(1.0_f64.to_bits() + ((k as u64) << CELL_BITS))).clamp(LEAST, 1.0)
}

#[expect(clippy::cast_precision_loss, reason = "a few hundred")]
fn index(k: usize) -> f64 {
    k as f64
}

impl Pulse {
    fn fitted(e: f64) -> Self {
        let Ok(contact) = Contact::new(e, 1.0) else { unreachable!("e is in [0.01, 1]") };
        let (frequency, damping) = (contact.frequency_rad_s(), contact.damping_ratio());
        let mut pulse = Self { e, frequency, damping, centroid: 0.0, variance: 0.0, carried: 0.0 };
        // ∫ s dt and ∫ 2 t s dt of the share s to come are the first two moments; by Simpson.
        let n = 512;
        for k in 0..=n {
            let weight = if k == 0 || k == n {
                1.0
            } else if k % 2 == 1 {
                4.0
            } else {
                2.0
            };
            let t = index(k) / index(n);
            let s = weight / (3.0 * index(n)) * pulse.left(pulse.motion(t));
            pulse.centroid += s;
            pulse.variance += 2.0 * t * s;
        }
        pulse.variance -= pulse.centroid * pulse.centroid;
        pulse.carried = 1.0 - pulse.motion(1.0).1;
        pulse
    }
    /// The pulse for restitution e; below 0.01 the one of 0.01.
    pub(crate) fn new(e: f64) -> Self {
        let e = greater(e, LEAST);
        let bits = (e / LEAST).to_bits().saturating_sub(1.0_f64.to_bits());
        let k = ((bits >> CELL_BITS) as usize).min(CELLS - 1);
        #[expect(clippy::cast_precision_loss, reason = "45 bits")]
        let share = (bits - ((k as u64) << CELL_BITS)) as f64 * OF_CELL;
        let [a, b] = [k, k + 1].map(|k| TABLE[k].get_or_init(|| Self::fitted(node(k))));
        let mix = |a: f64, b: f64| a + share * (b - a);
        Self {
            e,
            frequency: mix(a.frequency, b.frequency),
            damping: mix(a.damping, b.damping),
            centroid: mix(a.centroid, b.centroid),
            variance: mix(a.variance, b.variance),
            carried: mix(a.carried, b.carried),
        }
    }
    /// Cosine-like and sine-like part of the motion after the time t, damped.
    fn motion(&self, t: f64) -> (f64, f64) {
        self.motion_by(t, |y| libm::exp(-y), libm::sincos)
    }
    /// The same by these functions e^(−y) and (sin, cos).
    #[inline]
    fn motion_by(&self, t: f64, decay: fn(f64) -> f64, sin_cos: fn(f64) -> (f64, f64)) -> (f64, f64) {
        let sigma = self.damping * self.frequency;
        let gap = (1.0 - self.damping) * (1.0 + self.damping) * self.frequency * self.frequency;
        let nu = gap.abs().sqrt();
        if gap > 1e-6 {
            let (decay, (sin, cos)) = (decay(sigma * t), sin_cos(nu * t));
            (decay * cos, decay * sin / nu)
        } else if gap < -1e-6 {
            let (slow, fast) = (decay((sigma - nu) * t), decay((nu + sigma) * t));
            (0.5 * (slow + fast), 0.5 * (slow - fast) / nu)
        } else {
            let decay = decay(sigma * t);
            (decay, decay * t)
        }
    }
    /// Share of the velocity change that is still to come at such a motion.
    #[inline]
    fn left(&self, (c, s): (f64, f64)) -> f64 {
        greater(lesser((c - self.damping * self.frequency * s + self.e) / (1.0 + self.e), 1.0), 0.0)
    }
    /// The same at the time t in [0, 1], for estimates.
    pub(super) fn remaining(&self, t: f64) -> f64 {
        self.left(self.motion_by(t, quick::decay, quick::sin_cos))
    }
    /// What its dashpot holds back, over its speed: at the parting the end is below the ground by this and the rebound.
    pub(super) fn delay(&self) -> f64 {
        2.0 * self.damping / self.frequency
    }
    /// The fastest rate of change of the pulse.
    pub(super) fn rate(&self) -> f64 {
        let over = ((self.damping - 1.0) * (self.damping + 1.0)).max(0.0).sqrt();
        self.frequency * (self.damping + over).max(1.0)
    }
    /// Its acceleration as it begins, over velocity change and duration: what the dashpot does at once.
    fn onset(&self) -> f64 {
        2.0 * self.damping * self.frequency / (1.0 + self.e)
    }
    /// Whether it never pushes harder than as it begins.
    pub(super) fn begins_hardest(&self) -> bool {
        self.onset() > SMOOTH
    }
    /// Its largest acceleration, about.
    pub(crate) fn crest(&self) -> f64 {
        self.onset().max(SMOOTH)
    }
    /// The pulse in straight pieces, about `cells` of them, denser where it begins steeply: when each begins and ends,
    /// and the accelerations there, for the velocity change 1. Each piece has the pulse's own change of velocity and
    /// path, so that its effect on a component is off by the fourth power of its length.
    pub(super) fn pieces(&self, cells: usize) -> Vec<[(f64, f64); 2]> {
        let sigma = self.damping * self.frequency;
        // Height and velocity of the contact.
        let at = |t: f64| {
            let (c, s) = self.motion(t);
            (-s, sigma * s - c)
        };
        let (begin, end) = (at(0.0), at(1.0));
        let whole = end.1 - begin.1;
        let nodes = graded(1.0, self.rate(), cells);
        let mut from = (0.0, begin);
        let pieces = nodes[1..].iter().map(|&t| {
            let to = (t, at(t));
            let [a, b] = straight(to.0 - from.0, from.1, to.1).map(|a| a / whole);
            let piece = [(from.0, a), (to.0, b)];
            from = to;
            piece
        });
        pieces.collect()
    }
}

/// The accelerations at the begin and the end of a straight piece of this length that leads from one (height, velocity)
/// to another.
pub(super) fn straight(h: f64, start: (f64, f64), end: (f64, f64)) -> [f64; 2] {
    let change = (end.1 - start.1) / h;
    // ∫∫ a over the piece, twice over h².
    let path = 2.0 * ((end.0 - start.0) / h - start.1) / h;
    [3.0 * path - 2.0 * change, 4.0 * change - 3.0 * path]
}

/// The largest acceleration of a pulse that grows first, over velocity change and duration: it is 1.47 to 1.87, and
/// falls from the start where that is more.
const SMOOTH: f64 = 1.87;

/// Nodes over a time, about `cells` of them: steps of `3/cells` of the time constant at the beginning, each longer than
/// the one before, up to 1/cells of the time.
fn graded(time: f64, rate: f64, cells: usize) -> Vec<f64> {
    let n = index(cells);
    let longest = time / n;
    let mut step = (3.0 / (n * rate)).min(longest);
    let mut nodes = vec![0.0];
    let mut t = 0.0;
    while t + 1.5 * step < time {
        t += step;
        nodes.push(t);
        step = (step * (1.0 + 4.0 / n)).min(longest);
    }
    nodes.push(time);
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_within_1e_4_of_the_fit() {
        for k in 0..400_i32 {
            let e = 0.01_f64.powf((f64::from(k) + 0.37) / 400.0);
            let (read, fitted) = (Pulse::new(e), Pulse::fitted(e));
            for (a, b) in [
                (read.frequency, fitted.frequency),
                (read.damping, fitted.damping),
                (read.centroid, fitted.centroid),
                (read.variance, fitted.variance),
                (read.carried, fitted.carried),
            ] {
                assert!((a - b).abs() < 1e-4 * b.max(0.1), "e {e}: {a} {b}");
            }
        }
    }

    /// Nothing is above the crest, by more than fine pieces have over the pulse; where it begins hardest, nothing is
    /// above the begin.
    #[test]
    fn no_pulse_passes_its_crest() {
        for k in 0..200 {
            let pulse = Pulse::new(0.01_f64.powf(f64::from(k) / 200.0));
            let pieces = pulse.pieces(400);
            let most = pieces.iter().flatten().fold(0.0_f64, |m, p| m.max(p.1));
            assert!(most <= 1.001 * pulse.crest(), "{pulse:?}: {most}");
            assert!(!pulse.begins_hardest() || most <= 1.001 * pieces[0][0].1, "{pulse:?}: {most}");
        }
        assert!(Pulse::new(0.1).begins_hardest() && !Pulse::new(0.5).begins_hardest());
    }

    /// An elastic contact is half a sine: mean ½, variance ¼ − 2/π².
    #[test]
    fn an_elastic_pulse_is_half_a_sine() {
        let pulse = Pulse::new(1.0);
        assert!((pulse.centroid - 0.5).abs() < 1e-12, "{}", pulse.centroid);
        let variance = 0.25 - 2.0 / std::f64::consts::PI.powi(2);
        assert!((pulse.variance - variance).abs() < 1e-9, "{}", pulse.variance);
        // Up to each node it has given what half a sine has.
        let mut given = 0.0;
        for [(t, a), (u, b)] in pulse.pieces(32) {
            given += 0.5 * (a + b) * (u - t);
            let half_sine = 0.5 * (1.0 - (std::f64::consts::PI * u).cos());
            assert!((given - half_sine).abs() < 1e-12, "{u}: {given} {half_sine}");
        }
        for e in [0.01, 0.05, 0.135, 0.3, 0.9] {
            let pulse = Pulse::new(e);
            assert!((pulse.remaining(0.0) - 1.0).abs() < 1e-12);
            assert!(pulse.remaining(1.0).abs() < 2e-4, "e {e}: {}", pulse.remaining(1.0));
            // The pieces have the pulse's own mean, however few they are.
            for cells in [2, 8, 64] {
                let mean: f64 = pulse
                    .pieces(cells)
                    .iter()
                    .map(|[(t, a), (u, b)]| (u - t) * (a * (2.0 * t + u) + b * (t + 2.0 * u)) / 6.0)
                    .sum();
                assert!((mean / pulse.centroid - 1.0).abs() < 5e-4, "e {e}: {mean} {}", pulse.centroid);
            }
        }
    }
}
