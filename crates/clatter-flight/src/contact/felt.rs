//! What a place of the body feels in a flight with contacts.

use super::level::Level;
use super::mode::{Mode, Motion};
use super::phase::Phase;
use super::pose::Pose;
use super::{ContactFlight, PlateFlight};
use crate::excitation::{Stretch, Wave};

/// Over a contact, what is so short that nothing is spread over it.
const SHORT: f64 = 0.1;
/// Straight lines for one phase at most.
const MOST_LINES: f64 = 1e5;

/// How closely straight lines follow damped vibrations.
struct Lines {
    /// What each may miss, over `most`.
    straight: f64,
    /// Largest acceleration so far.
    most: f64,
}

impl<const N: usize, P: Pose<N>> ContactFlight<N, P> {
    /// What a place feels, in m from the center of mass: of a body seen from the side x and z ([`Body::place`](crate::Body::place)
    /// is a position on a bar), of a plate x and y.
    ///
    /// `straight` is by how much straight lines may miss a damped vibration (of [`Dashpot`](crate::ContactLaw::Dashpot)
    /// contacts), over the largest acceleration so far.
    ///
    /// # Accuracy
    /// It adds up to the motion of the flight: what lever arms kept through a phase leave out is spread over it, and what is left of
    /// the motion as the flight ends at rest is a velocity shock then. Where the body turns by more than a right angle in one
    /// flight, nothing is felt of that turn: the axis of a part has turned with it.
    #[must_use]
    pub fn felt(&self, place: [f64; 2], straight: f64) -> Vec<Stretch<N>> {
        let velocity = |pose: &P| pose.velocity_of(place);
        self.sections(straight, velocity, self.end.gravity(), |phase, span, lines, felt| {
            let mut stretch = Stretch::shock(span[0], span[1], 0.0);
            if phase.is_free() {
                let changed = phase.start.flying_felt(place, &mut stretch);
                stretch.free = true;
                felt.push(stretch);
                return changed;
            }
            let of = phase.start.couplings_of(&phase.arms, place);
            let steady = phase.start.turning(&phase.arms, place) + phase.steady(&of);
            phase.sum_of_modes(&phase.felt_by(&of), steady, stretch, lines, felt)
        })
    }
    /// What an angular velocity goes through, in rad where [`felt`](Self::felt) has m, by what a force of 1 over the mass at each
    /// point does to it.
    pub(super) fn turned_by(
        &self,
        straight: f64,
        spin: impl Fn(&P) -> f64,
        of: impl Fn(&Phase<P, N>) -> [f64; N],
    ) -> Vec<Stretch<N>> {
        self.sections(straight, spin, 0.0, |phase, span, lines, turned| {
            let stretch = Stretch::shock(span[0], span[1], 0.0);
            if phase.is_free() {
                turned.push(Stretch { free: true, ..stretch });
                return 0.0;
            }
            let of = of(phase);
            phase.sum_of_modes(&phase.felt_by(&of), phase.steady(&of), stretch, lines, turned)
        })
    }
    /// Of every phase what `add` appends, which returns what that changes `velocity` by, besides gravity. What is missing to the
    /// motion is spread over the phase, or over the next one that is not far shorter than a contact.
    fn sections(
        &self,
        straight: f64,
        velocity: impl Fn(&P) -> f64,
        gravity: f64,
        add: impl Fn(&Phase<P, N>, [f64; 2], &mut Lines, &mut Vec<Stretch<N>>) -> f64,
    ) -> Vec<Stretch<N>> {
        let mut sections: Vec<Stretch<N>> = Vec::with_capacity(self.phases.len() + 1);
        let (until, mut lines, mut short) = (self.flight.stop.time_s(), Lines { straight, most: 0.0 }, 0.0);
        for (k, (from_s, phase)) in self.phases.iter().enumerate() {
            let (next, first) = (self.phases.get(k + 1), sections.len());
            let length_s = (next.map_or(until, |(from, _)| *from) - from_s).max(0.0);
            let then = next.map_or(&self.last, |(_, next)| &next.start);
            let changed = velocity(then) - velocity(&phase.start) + gravity * length_s;
            short += changed - add(phase, [*from_s, length_s], &mut lines, &mut sections);
            if length_s > SHORT * self.contact_s {
                let spread = short / length_s;
                sections[first..].iter_mut().flat_map(|s| &mut s.acceleration_m_s2).for_each(|a| *a += spread);
                short = 0.0;
            }
        }
        sections.push(Stretch::shock(until, 0.0, short + velocity(&self.end) - velocity(&self.last)));
        sections
    }
}

impl<const N: usize> ContactFlight<N> {
    /// The angular acceleration of the body, in rad where [`felt`](Self::felt) has m.
    #[must_use]
    pub fn turned(&self, straight: f64) -> Vec<Stretch<N>> {
        self.turned_by(straight, |pose| pose.spin, |phase| phase.start.turned_by(&phase.arms))
    }
}

impl PlateFlight {
    /// The acceleration of the slope along a direction x, y, in rad where [`felt`](Self::felt) has m.
    #[must_use]
    pub fn turned(&self, direction: [f64; 2], straight: f64) -> Vec<Stretch<4>> {
        let by = |phase: &Phase<Level, 4>| phase.start.slope_by(direction);
        self.turned_by(straight, |pose| pose.rate_along(direction), by)
    }
}

impl<P: Pose<N>, const N: usize> Phase<P, N> {
    /// Appends a steady part and what each mode's press adds to it; returns its integral.
    fn sum_of_modes(
        &self,
        by_mode: &[f64; N],
        mut steady: f64,
        mut stretch: Stretch<N>,
        lines: &mut Lines,
        felt: &mut Vec<Stretch<N>>,
    ) -> f64 {
        if self.delay > 0.0 && !self.modes().is_empty() {
            return self.straight_lines(by_mode, steady, stretch, lines, felt);
        }
        for (m, mode) in self.modes().iter().enumerate() {
            steady += by_mode[m] * mode.rest();
            let [amplitude, rate_rad_s, phase_rad] = mode.wave();
            stretch.waves[m] = Wave { amplitude_m_s2: by_mode[m] * amplitude, rate_rad_s, phase_rad };
        }
        stretch.acceleration_m_s2 = [steady; 2];
        felt.push(stretch);
        stretch.velocity_after(stretch.length_s)
    }
    /// A damped vibration as straight lines.
    fn straight_lines(
        &self,
        by_mode: &[f64; N],
        steady: f64,
        whole: Stretch<N>,
        lines: &mut Lines,
        felt: &mut Vec<Stretch<N>>,
    ) -> f64 {
        let at = |motions: &[Motion; N]| {
            let press = self.modes().iter().zip(motions).zip(by_mode).map(|((mode, m), by)| by * mode.press(m));
            steady + press.sum::<f64>()
        };
        // A bound of the bend from a motion on.
        let bends = |motions: &[Motion; N]| {
            let one = |((mode, motion), by): ((&Mode, &Motion), &f64)| {
                let ([_, second, _, fourth], root) = (mode.bounds_from(motion), mode.lambda().sqrt());
                by.abs() * (second + self.delay * fourth / root)
            };
            self.modes().iter().zip(motions).zip(by_mode).map(one).sum::<f64>()
        };
        let three = [0.0, 0.5, 1.0].map(|share| at(&self.motions(share * whole.length_s)).abs());
        lines.most = three.into_iter().fold(lines.most, f64::max);
        let (mut t, mut motions, mut sum) = (0.0, self.motions(0.0), 0.0);
        let (mut bend, mut begin) = (bends(&motions), at(&motions));
        let least = whole.length_s / MOST_LINES;
        while t < whole.length_s || t == 0.0 {
            // A straight line over h misses h²/8 of the bend; nothing bends where both sides press alike.
            let most = (8.0 * lines.straight * lines.most / bend).sqrt().max(least);
            let step = if bend > 0.0 { most } else { whole.length_s };
            let then = if t + step < whole.length_s { t + step } else { whole.length_s };
            motions = self.motions(then);
            let end = at(&motions);
            let line = Stretch::shock(whole.from_s + t, then - t, 0.0);
            felt.push(Stretch { acceleration_m_s2: [begin, end], ..line });
            sum += 0.5 * (begin + end) * (then - t);
            if then >= whole.length_s {
                break;
            }
            (t, begin, bend) = (then, end, bends(&motions));
        }
        sum
    }
}
