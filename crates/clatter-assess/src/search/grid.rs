//! Which drops of the ranges are followed.

use std::f64::consts::{SQRT_2, TAU};

use super::Task;
use super::ranges::{Place, Ranges};
use crate::{Mount, Spread};

/// Tilts of the grid at least and at most.
const TILTS: [f64; 2] = [12.0, 128.0];
/// Phase by which the stiffest part turns between the first strikes of neighboring tilts, in rad.
const PHASE: f64 = 0.8;
const SQRT_3: f64 = 1.732_050_807_568_877;
const SQRT_5: f64 = 2.236_067_977_499_79;
const SQRT_7: f64 = 2.645_751_311_064_59;
/// Tilts in a contact time, and contact times over which tilts lie so closely: where contacts overlap, velocity shocks change by steps.
const OVERLAPS: [f64; 2] = [12.0, 4.0];
/// Where along a range the drops of the grid are.
enum Level {
    At(f64),
    /// Evenly all over it, by the multiples of an irrational number.
    Spread(f64),
}

impl Level {
    pub(super) fn of(&self, k: usize) -> f64 {
        match self {
            Self::At(share) => *share,
            #[expect(clippy::cast_precision_loss, reason = "thousands")]
            Self::Spread(by) => (by * k as f64).fract(),
        }
    }
}

impl Ranges<'_> {
    /// Steps of the tilt: as many as the stiffest of the parts asks.
    pub(super) fn tilt_steps(&self, tasks: &[Task<'_>]) -> f64 {
        let [_, fast] = self.drop.speeds_m_s();
        let gap =
            self.product.body.length_m() * (libm::sin(self.drop.tilt_rad.hi()) - libm::sin(self.drop.tilt_rad.lo()));
        let highest = tasks.iter().filter_map(|task| match task.component.mount {
            // Beyond some swings a contact, pulses are felt one by one.
            Mount::Suspended { frequency_hz, .. } => Some(frequency_hz.hi()),
            // Its crest is where contacts meet.
            Mount::Hard => self.product.contact_time_s.map(|time| 0.5 / time.lo()),
        });
        let stiff = self.product.contact_time_s.map_or(f64::INFINITY, |time| 1.0 / time.lo());
        let highest = highest.fold(0.0_f64, f64::max).min(stiff);
        (TAU * highest * gap / fast / PHASE).clamp(TILTS[0], TILTS[1]).ceil()
    }

    /// The drops of the grid; places of parts are left open.
    pub(super) fn grid(&self, steps: f64) -> Vec<Place> {
        let [slow, fast] = self.drop.speeds_m_s();
        let is_range = |range: Option<&Spread>| range.is_some_and(|range| !range.is_value());
        let even = |steps: f64, free: bool| {
            let steps = if free { steps } else { 0.0 };
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 128")]
            let count = steps as u32;
            (0..=count).map(move |k| if count == 0 { 0.0 } else { f64::from(k) / f64::from(count) })
        };
        let tilted = !self.drop.tilt_rad.is_value();
        let levels =
            |range: Option<&Spread>, levels: &'static [Level]| if is_range(range) { levels } else { &levels[..1] };
        let mut grid = Vec::new();
        for &first in self.firsts() {
            for restitution in
                levels(Some(&self.product.restitution), &[Level::At(1.0), Level::At(0.0), Level::Spread(SQRT_2)])
            {
                for contact in levels(
                    self.product.contact_time_s.as_ref(),
                    &[Level::At(0.0), Level::At(1.0), Level::Spread(SQRT_3)],
                ) {
                    for gyration in
                        levels(Some(&self.product.gyration_m), &[Level::At(0.0), Level::At(1.0), Level::Spread(SQRT_5)])
                    {
                        let mut add = |tilt: f64, speed: f64| {
                            let k = grid.len();
                            let shares = [tilt, speed, restitution.of(k), contact.of(k), 0.0, 0.0, gyration.of(k)];
                            grid.push(Place { first, flat: false, position_m: 0.0, shares });
                        };
                        even(steps, tilted).for_each(|tilt| add(tilt, 1.0));
                        // Slower drops seldom do more; fewer of them are followed.
                        even((steps / 4.0).ceil(), tilted).filter(|_| slow < fast).for_each(|tilt| add(tilt, 0.0));
                        // In which phase a soft part is struck again depends on the speed: at others too.
                        let between = even((steps / 4.0).ceil(), tilted).filter(|_| slow < fast);
                        (1_u32..).zip(between).for_each(|(k, tilt)| add(tilt, (SQRT_7 * f64::from(k)).fract()));
                    }
                }
            }
        }
        if self.hold_flat() {
            let first = self.firsts()[0];
            let levels = [Level::At(1.0), Level::At(0.0), Level::Spread(SQRT_2)];
            let speeds = if slow < fast { &[1.0, 0.0, 0.5][..] } else { &[1.0] };
            for (restitution, &speed) in levels.iter().flat_map(|e| speeds.iter().map(move |speed| (e, speed))) {
                let shares = [0.0, speed, restitution.of(grid.len()), 0.0, 0.0, 0.0, 0.0];
                grid.push(Place { first, flat: true, position_m: 0.0, shares });
            }
        }
        grid
    }

    /// Drops whose first two contacts overlap or nearly do.
    pub(super) fn overlaps(&self) -> Vec<(u32, Place)> {
        let Some(contact) = self.product.contact_time_s.filter(|_| !self.drop.tilt_rad.is_value()) else {
            return Vec::new();
        };
        let [lo, hi] = [self.drop.tilt_rad.lo(), self.drop.tilt_rad.hi()];
        let [_, fast] = self.drop.speeds_m_s();
        let [often, far] = OVERLAPS;
        let of_one = fast * contact.hi() / self.product.body.length_m();
        let step = of_one / often;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 48")]
        let count = (((far * of_one).min(hi) - lo) / step).clamp(0.0, often * far) as u32;
        let share = |tilt: f64| (tilt.sqrt() - lo.sqrt()) / (hi.sqrt() - lo.sqrt());
        let spread = |k: u32, by: f64| (by * f64::from(k)).fract();
        let drops = |k: u32| {
            self.firsts().iter().flat_map(move |&first| {
                [1.0, spread(k, SQRT_2)].map(|restitution| {
                    let shares = [
                        share(lo + f64::from(k) * step),
                        1.0,
                        restitution,
                        spread(k, SQRT_3),
                        0.0,
                        0.0,
                        spread(k, SQRT_5),
                    ];
                    (k, Place { first, flat: false, position_m: 0.0, shares })
                })
            })
        };
        (0..=count).flat_map(drops).collect()
    }

    /// Drop k of a sequence that spreads evenly over the ranges (Halton's).
    pub(super) fn spread_out(&self, k: u32) -> Place {
        let firsts = self.firsts();
        let first = firsts[k as usize % firsts.len()];
        Place { first, flat: false, position_m: 0.0, shares: std::array::from_fn(|axis| halton(axis, k)) }
    }
}

/// Number k of Halton's sequence along an axis.
pub(super) fn halton(axis: usize, mut k: u32) -> f64 {
    let base = [2, 3, 5, 7, 11, 13, 17][axis];
    let (mut share, mut digit) = (0.0, 1.0);
    while k > 0 {
        digit /= f64::from(base);
        share += digit * f64::from(k % base);
        k /= base;
    }
    share
}
