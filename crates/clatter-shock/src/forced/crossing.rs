//! The first time at which a quantity leaves a band, isolated by bounds on its derivatives and never sampled.

use super::{CANCELLED, STRONG_DAMPING, Sample, Segment};
use crate::peaks::Range;
use crate::suspension::{Modes, Phase};
use std::f64::consts::TAU;

/// Where a quantity leaves its band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Exit {
    /// Phase from the begin of the segment.
    pub(crate) tau: f64,
    /// True if it leaves upward.
    pub(crate) upward: bool,
}

/// What bounds tell of one panel.
enum Panel {
    Inside,
    Leaves { upward: bool },
    Unknown,
}

/// Decay 60 leaves 10⁻²⁶ of the swing, far below its rounding.
const DECAYED: f64 = 60.0;
/// The most steps of an iteration for one root: bisection alone takes some sixty.
const STEPS: usize = 120;

impl Modes {
    /// Returns a phase within which free motion about a constant leaves a band, if it ever does: one swing, or until
    /// it has decayed.
    pub(crate) fn settling(&self) -> f64 {
        let swing = if self.beta > 0.0 { TAU / self.beta } else { f64::INFINITY };
        swing.min(DECAYED / self.sigma)
    }
}

impl Segment<'_> {
    /// Returns where quantity `k` first leaves the band from `low` to `high` before `end`. It starts within the band or
    /// on its edge; if it starts beyond, it leaves at once.
    ///
    /// Panels are visited in order of time. One holds no exit where bounds on q″ or the envelope of the swing keep it
    /// within the band; where bounds on q‴ show that q rises or falls all along, its end tells; any other is halved.
    /// `panels` counts down the panels that may still be looked at: at 0 the answer is not known.
    pub(crate) fn first_exit(&self, k: usize, band: [f64; 2], end: &Sample, panels: &mut u32) -> Option<Exit> {
        let ([low, high], modes) = (band, self.modes);
        // √(x² + y²) grows by no more than |f|.
        let row = modes.rows[k][0].abs() + modes.rows[k][1].abs() * modes.tilt;
        if row * (modes.energy(self.start) + end.tau * self.bound[0]) <= high.min(-low) {
            return None;
        }
        if !(end.m.x.is_finite() && end.m.w.is_finite()) {
            *panels = 0;
            return None;
        }
        let mut a = self.begin_sample();
        let (start, slack) = (self.value(k, &a), self.slack(k, &a, &a));
        if start > high + slack || start < low - slack {
            return Some(Exit { tau: 0.0, upward: start > high });
        }
        let mut ends = vec![*end];
        if self.sines.is_empty() && self.slope == 0.0 && end.tau > modes.settling() {
            let mut range = Range::outside(low, high);
            self.extremes(k, end, 0, &mut range);
            if range.high.value <= high && range.low.value >= low {
                return None;
            }
            ends[0] = self.sample(Phase::product(1.0, modes.settling()));
        }
        let steady = self.steady_bounds(k);
        while let Some(&b) = ends.last() {
            if *panels == 0 {
                return None;
            }
            *panels -= 1;
            let upward = match self.look(k, band, steady, &a, &b) {
                Panel::Inside => {
                    a = b;
                    ends.pop();
                    continue;
                }
                Panel::Leaves { upward } => upward,
                Panel::Unknown => {
                    let middle = a.tau + 0.5 * (b.tau - a.tau);
                    if middle > a.tau && middle < b.tau {
                        ends.push(self.sample(Phase::product(1.0, middle)));
                        continue;
                    }
                    // Nothing is left to halve.
                    let value = self.value(k, &b);
                    if value <= high && value >= low {
                        a = b;
                        ends.pop();
                        continue;
                    }
                    value > high
                }
            };
            return Some(Exit { tau: self.root(k, band[usize::from(upward)], upward, &a, &b), upward });
        }
        None
    }
    /// Returns how far rounding may carry quantity `k` over an edge.
    fn slack(&self, k: usize, a: &Sample, b: &Sample) -> f64 {
        8.0 * f64::EPSILON * self.modes.size(k, a.m).max(self.modes.size(k, b.m))
    }
    /// Tells from bounds whether quantity `k` leaves the band between `a`, where it is inside, and `b`.
    fn look(&self, k: usize, [low, high]: [f64; 2], steady: [f64; 2], a: &Sample, b: &Sample) -> Panel {
        let (modes, h) = (self.modes, b.tau - a.tau);
        let slack = self.slack(k, a, b);
        let inside = |least: f64, most: f64| least >= low - slack && most <= high + slack;
        let (qa, qb) = (self.value(k, a), self.value(k, b));
        let (least, most) = (qa.min(qb), qa.max(qb));
        let mut bounds = [f64::INFINITY; 2];
        let forcing = self.forcing_bounds(a, h);
        if modes.zeta < STRONG_DAMPING || forcing[0] < CANCELLED * self.bound[0] {
            bounds = self.energy_bounds(k, a, h, forcing);
            let bump = 0.125 * bounds[0] * h * h;
            if inside(least - bump, most + bump) {
                return Panel::Inside;
            }
        }
        let rest = self.rest(a);
        let reach = modes.reach(k, rest);
        let around = 0.125 * steady[0] * h * h + reach;
        let (steady_a, steady_b) = (modes.quantity(k, a.steady), modes.quantity(k, b.steady));
        if inside(steady_a.min(steady_b) - around, steady_a.max(steady_b) + around) {
            return Panel::Inside;
        }
        let other = self.steady_bounds_with(k, steady, rest, reach, h);
        let [m2, m3] = [bounds[0].min(other[0]), bounds[1].min(other[1])];
        let bump = 0.125 * m2 * h * h;
        if inside(least - bump, most + bump) {
            return Panel::Inside;
        }
        let (sa, sb) = (self.slope(k, a), self.slope(k, b));
        let (ba, bb) = (self.bend(k, a), self.bend(k, b));
        let (mut rises, mut falls) = (sa > 0.0 && sb > 0.0, sa < 0.0 && sb < 0.0);
        if (ba > 0.0) == (bb > 0.0) && ba.abs().min(bb.abs()) > 0.5 * m3 * h {
            // The bend keeps its sign: between the ends the slope is between those there, and a quantity that turns
            // does so no further out than the crossing of the tangents.
            (rises, falls) = (sa >= 0.0 && sb >= 0.0, sa <= 0.0 && sb <= 0.0);
            if !rises && !falls {
                let turn = qa + sa * ((qb - qa - sb * h) / (sa - sb));
                let (least, most) = if ba > 0.0 { (turn.min(least), most) } else { (least, turn.max(most)) };
                return if inside(least, most) { Panel::Inside } else { Panel::Unknown };
            }
        } else if sa.abs().min(sb.abs()) <= 0.125 * m3 * h * h {
            return Panel::Unknown;
        }
        if rises || falls {
            let leaves = if rises { qb > high + slack } else { qb < low - slack };
            return if leaves { Panel::Leaves { upward: rises } } else { Panel::Inside };
        }
        Panel::Unknown
    }
    /// Returns the phase at which quantity `k`, which rises (or falls) from `a` to `b`, passes `level`: Newton's iteration
    /// kept between the two, to rounding.
    fn root(&self, k: usize, level: f64, upward: bool, a: &Sample, b: &Sample) -> f64 {
        let sign = if upward { 1.0 } else { -1.0 };
        let beyond = |s: &Sample| sign * (self.value(k, s) - level);
        let (mut low, mut high) = (a.tau, b.tau);
        let (from, to) = (beyond(a), beyond(b));
        if from >= 0.0 {
            return low;
        }
        let h = high - low;
        let slopes = [h * sign * self.slope(k, a), h * sign * self.slope(k, b)];
        let mut tau = low + h * guess([from, to], slopes);
        for _ in 0..STEPS {
            if !(tau > low && tau < high) {
                tau = low + 0.5 * (high - low);
                if !(tau > low && tau < high) {
                    return high;
                }
            }
            let s = self.sample(Phase::product(1.0, tau));
            let off = beyond(&s);
            if off > 0.0 {
                high = tau;
            } else {
                low = tau;
            }
            let slope = sign * self.slope(k, &s);
            let next = tau - off / slope;
            // Each step leaves the error of a parabola, which shrinks to its square.
            let left = (next - tau) * (next - tau) * (self.bend(k, &s) / slope).abs();
            if off == 0.0 || (left <= f64::EPSILON * tau && next > a.tau && next < b.tau) {
                return if off == 0.0 { tau } else { next };
            }
            tau = next;
        }
        tau
    }
}

/// Returns the zero, as a share of the way from one end to the other, of the cubic with these values and slopes: two of
/// Newton's steps from the chord, or the chord where they lead out.
fn guess([from, to]: [f64; 2], [out, into]: [f64; 2]) -> f64 {
    let (third, second) = (out + into - 2.0 * (to - from), 3.0 * (to - from) - 2.0 * out - into);
    let chord = -from / (to - from);
    let mut t = chord;
    for _ in 0..2 {
        t -= (from + t * (out + t * (second + t * third))) / (out + t * (2.0 * second + 3.0 * t * third));
    }
    if t > 0.0 && t < 1.0 { t } else { chord }
}
