//! The excitation of a place on the body in a flight with contacts.

use clatter::{Excitation, Section, Sine};

use super::mode::{Mode, Motion};
use super::phase::Phase;
use super::{Level, Phases, Planar, Pose};
use crate::motion::{Course, FeetMotion, PlateMotion};

/// Share of a contact time below which a phase is too short to spread an error over it.
const SHORT: f64 = 0.1;
/// The most straight lines for one phase.
const MOST_LINES: f64 = 1e5;

/// Accuracy of straight lines through damped vibrations.
struct Lines {
    /// Largest error of each line, over `most`.
    straight: f64,
    /// Largest acceleration so far.
    most: f64,
}

impl<const N: usize, P: Pose<N>> Phases<N, P> {
    /// Returns the excitation of a place, in m from the center of mass: for a body seen from the side x and z, for a
    /// plate x and y.
    pub(crate) fn felt(&self, place: [f64; 2]) -> Excitation {
        let velocity = |pose: &P| pose.velocity_of(place);
        self.sections(velocity, self.end.gravity(), |phase, span, lines, excitation| {
            let section = Section::shock(span[0], span[1], 0.0);
            if phase.is_free() {
                let (turns, changed) = phase.start.flying_excitation(place, section.length);
                excitation.push(Section { sines: &[turns], free: true, ..section });
                return changed;
            }
            let of = phase.start.couplings_of(&phase.arms, place);
            let steady = phase.start.turning(&phase.arms, place) + phase.steady(&of);
            phase.sum_of_modes(&phase.by_modes(&of), steady, section, lines, excitation)
        })
    }
    /// Returns the angular acceleration, in rad where [`felt`](Self::felt) has m, from the effect on it of a force of 1
    /// over the mass at each point.
    fn turned_by(&self, spin: impl Fn(&P) -> f64, of: impl Fn(&Phase<P, N>) -> [f64; N]) -> Excitation {
        self.sections(spin, 0.0, |phase, span, lines, turned| {
            let section = Section::shock(span[0], span[1], 0.0);
            if phase.is_free() {
                turned.push(Section { free: true, ..section });
                return 0.0;
            }
            let of = of(phase);
            phase.sum_of_modes(&phase.by_modes(&of), phase.steady(&of), section, lines, turned)
        })
    }
    /// Returns the sections that `add` appends for every phase; `add` returns their change of `velocity`, gravity
    /// aside. The difference to the motion is spread over the phase, or over the next one that is not far shorter than
    /// a contact.
    fn sections(
        &self,
        velocity: impl Fn(&P) -> f64,
        gravity: f64,
        add: impl Fn(&Phase<P, N>, [f64; 2], &mut Lines, &mut Excitation) -> f64,
    ) -> Excitation {
        let mut sections = Excitation::with_capacity(self.list.len() + 1);
        let (until, mut lines, mut short) = (self.end_s, Lines { straight: self.precision, most: 0.0 }, 0.0);
        for (k, (from_s, phase)) in self.list.iter().enumerate() {
            let (next, first) = (self.list.get(k + 1), sections.sections().len());
            let length_s = (next.map_or(until, |(from, _)| *from) - from_s).max(0.0);
            let then = next.map_or(&self.last, |(_, next)| &next.start);
            let changed = velocity(then) - velocity(&phase.start) + gravity * length_s;
            short += changed - add(phase, [*from_s, length_s], &mut lines, &mut sections);
            if length_s > SHORT * self.contact_s(phase) {
                sections.lift(first, short / length_s);
                short = 0.0;
            }
        }
        sections.push(Section::shock(until, 0.0, short + velocity(&self.end) - velocity(&self.last)));
        sections
    }
}

impl<const N: usize> Phases<N, Planar<N>> {
    /// Returns the angular acceleration of the body, in rad where [`felt`](Self::felt) has m.
    pub(crate) fn turned(&self) -> Excitation {
        self.turned_by(|pose| pose.spin, |phase| phase.start.turned_by(&phase.arms))
    }
}

impl<const N: usize> Phases<N, Level<N>> {
    /// Returns the acceleration of the slope along a direction.
    fn turned_in(&self, direction: [f64; 2]) -> Excitation {
        self.turned_by(|pose| pose.rate_along(direction), |phase| phase.start.slope_by(direction))
    }
}

impl<const N: usize> crate::Motion<N> {
    /// Returns the excitation of a place x, z by contacts that take time, in m from the center of mass in axes of the
    /// body: its acceleration above free fall. `None` for instant impacts.
    #[must_use]
    pub fn felt_at(&self, place: [f64; 2]) -> Option<Excitation> {
        self.phases().map(|phases| phases.felt(place))
    }
    /// Returns the angular acceleration of the body, in rad where [`felt_at`](Self::felt_at) has m. `None` for instant
    /// impacts.
    #[must_use]
    pub fn turned_by_contacts(&self) -> Option<Excitation> {
        self.phases().map(Phases::turned)
    }
}

impl FeetMotion {
    /// Returns the excitation of a place x, y, in m from the center of mass: its acceleration above free fall.
    ///
    /// # Panics
    /// It never panics: the motion is one of contacts that take time.
    #[must_use]
    pub fn felt(&self, place: [f64; 2]) -> Excitation {
        self.by_contacts().felt(place)
    }
    /// Returns the acceleration of the slope along a direction x, y, in rad where [`felt`](Self::felt) has m.
    ///
    /// # Panics
    /// It never panics: the motion is one of contacts that take time.
    #[must_use]
    pub fn turned(&self, direction: [f64; 2]) -> Excitation {
        self.by_contacts().turned_in(direction)
    }
    fn by_contacts(&self) -> &Phases<8, Level<8>> {
        self.phases().unwrap_or_else(|| unreachable!("feet have contacts that take time"))
    }
}

impl PlateMotion {
    /// Returns the excitation of a place x, y, in m from the center of mass: its acceleration above free fall, as
    /// [`Motion::felt`](crate::Motion::felt). For instant impacts it is exact, corners that lie included.
    #[must_use]
    pub fn felt(&self, place: [f64; 2]) -> Excitation {
        match &self.course {
            Course::Impacts(falls) => falls.excitation(self, falls.place(place), self.gravity_m_s2()),
            Course::Contacts(phases) => phases.felt(place),
        }
    }
    /// Returns the acceleration of the slope along a direction x, y, in rad where [`felt`](Self::felt) has m.
    #[must_use]
    pub fn turned(&self, direction: [f64; 2]) -> Excitation {
        match &self.course {
            Course::Impacts(falls) => falls.excitation(self, falls.slope(direction), 0.0),
            Course::Contacts(phases) => phases.turned_in(direction),
        }
    }
}

impl<P: Pose<N>, const N: usize> Phase<P, N> {
    /// Appends a steady part and the part of each mode, and returns their integral.
    fn sum_of_modes(
        &self,
        by_mode: &[f64; N],
        mut steady: f64,
        section: Section<'_>,
        lines: &mut Lines,
        excitation: &mut Excitation,
    ) -> f64 {
        if self.delay > 0.0 && !self.modes().is_empty() {
            return self.straight_lines(by_mode, steady, section, lines, excitation);
        }
        let mut sines = [Sine::default(); N];
        for (m, mode) in self.modes().iter().enumerate() {
            steady += by_mode[m] * mode.rest();
            let [amplitude, rate, phase] = mode.wave();
            sines[m] = Sine { amplitude: by_mode[m] * amplitude, rate, phase };
        }
        let section = Section { acceleration: [steady; 2], sines: &sines, ..section };
        excitation.push(section);
        section.velocity_after(section.length)
    }
    /// Appends a damped vibration as straight lines, and returns their integral.
    fn straight_lines(
        &self,
        by_mode: &[f64; N],
        steady: f64,
        whole: Section<'_>,
        lines: &mut Lines,
        excitation: &mut Excitation,
    ) -> f64 {
        let at = |motions: &[Motion; N]| {
            let press = self.modes().iter().zip(motions).zip(by_mode).map(|((mode, m), by)| by * mode.press(m));
            steady + press.sum::<f64>()
        };
        // This bounds the bend from a motion on.
        let bends = |motions: &[Motion; N]| {
            let one = |((mode, motion), by): ((&Mode, &Motion), &f64)| {
                let ([_, second, _, fourth], root) = (mode.bounds_from(motion), mode.lambda().sqrt());
                by.abs() * (second + self.delay * fourth / root)
            };
            self.modes().iter().zip(motions).zip(by_mode).map(one).sum::<f64>()
        };
        let three = [0.0, 0.5, 1.0].map(|share| self.motions(share * whole.length));
        lines.most = three.iter().map(|motions| at(motions).abs()).fold(lines.most, f64::max);
        let ([mut motions, _, last], mut t, mut sum) = (three, 0.0, 0.0);
        let (mut bend, mut begin) = (bends(&motions), at(&motions));
        let least = whole.length / MOST_LINES;
        while t < whole.length || t == 0.0 {
            // The error of a straight line over h is h²/8 of the bend; the bend is 0 where both sides press alike.
            let most = (8.0 * lines.straight * lines.most / bend).sqrt().max(least);
            let step = if bend > 0.0 { most } else { whole.length };
            let then = if t + step < whole.length { t + step } else { whole.length };
            motions = if then < whole.length { self.motions(then) } else { last };
            let end = at(&motions);
            let line = Section::shock(whole.from + t, then - t, 0.0);
            excitation.push(Section { acceleration: [begin, end], ..line });
            sum += 0.5 * (begin + end) * (then - t);
            if then >= whole.length {
                break;
            }
            (t, begin, bend) = (then, end, bends(&motions));
        }
        sum
    }
}
