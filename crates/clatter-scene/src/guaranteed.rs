//! The worst case without gravity, with a guarantee: branch and bound over all stated ranges at once.
//!
//! By scaling, the response depends on Ω = ω h0/v0 and e alone, up to a factor:
//!
//! ```text
//! |A| = ω v0 · R_A(Ω, e),   |z| = (v0/ω) · R_z(Ω, e),   Ω = ω h0/v0,   h0 = length · sin(tilt)
//! ```
//!
//! so tilt, speed and frequency are one axis: for each Ω the largest factor over the drops that have it is known in
//! closed form ([`Ranges::factor`]). Cells of the plane (Ω, e) are bounded by [`peak_bounds`] over [`LooseTrain`]; the
//! cell with the highest bound is halved until no bound is more than the tolerance above what some drop attains. The
//! end that strikes first and both ends of the part are cells beside each other in one queue, so that effort goes to
//! the worst of them alone.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap};
use std::rc::Rc;

use clatter::End;
use clatter_shock::{DampingRatio, LooseShock, PeakBounds, Peaked, peak_bounds};

use crate::loose_train::{Clattering, LooseStrike, LooseTrain};
use crate::{Drop, Product};

/// How far the demand may lie above what is attained.
pub(crate) const TOLERANCE: f64 = 0.005;
/// Cells that are bounded for one demand, at most: what is left then is told as the tolerance.
const MOST_CELLS: usize = 40_000;
/// One side of a cell is at most so many times longer than the other, both over the whole range.
const MOST_LEAN: f64 = 256.0;
/// Roundings of a bound, relative.
const ROUNDINGS: f64 = 1e-9;

/// What is asked at which places.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Asked {
    /// Peak of a suspended part.
    Response(DampingRatio, Peaked),
    /// Largest single velocity shock, or change of angular velocity.
    Shock,
}

/// One end first, and the shares that a place gets of each strike.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Variant {
    pub(crate) first: End,
    pub(crate) position_m: f64,
    pub(crate) shares: [f64; 2],
}

/// The stated ranges of everything else.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ranges {
    /// v0 in m/s.
    pub(crate) speed: [f64; 2],
    /// h0 in m.
    pub(crate) gap: [f64; 2],
    pub(crate) restitution: [f64; 2],
    /// ω in rad/s; [0, 0] where none is asked.
    pub(crate) omega: [f64; 2],
}

/// The worst case: what is proven, what is attained, and by which drop.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Worst {
    /// No drop of the ranges passes it.
    pub(crate) demand: f64,
    /// What the drop attains.
    pub(crate) attained: f64,
    pub(crate) variant: Variant,
    pub(crate) speed: f64,
    pub(crate) gap: f64,
    pub(crate) restitution: f64,
    pub(crate) omega: f64,
    /// Cells that were bounded.
    pub(crate) cells: usize,
}

impl Ranges {
    pub(crate) fn new(product: &Product, drop: &Drop) -> Self {
        let length = product.body.length_m();
        Self {
            speed: drop.speeds_m_s(),
            gap: [drop.tilt_rad.lo(), drop.tilt_rad.hi()].map(|tilt| length * tilt.sin()),
            restitution: [product.restitution.lo(), product.restitution.hi()],
            omega: [0.0; 2],
        }
    }
    /// Ω from least to most.
    fn scaled(&self) -> [f64; 2] {
        let ([vl, vh], [hl, hh], [wl, wh]) = (self.speed, self.gap, self.omega);
        [wl * hl / vh, wh * hh / vl]
    }
    /// The drop (v0, h0, ω) with this Ω and the largest factor: ω v0 for accelerations, v0/ω for displacements.
    ///
    /// Accelerations: ω and v0 are both largest where h0 = Ω v0/ω then is in its range; below it h0 is least and ω
    /// gives way, above it h0 is largest and v0 does. Displacements: v0 is largest and ω least, or h0 is largest and
    /// v0/ω = h0/Ω.
    fn drop(&self, asked: Asked, scaled: f64) -> [f64; 3] {
        let ([vl, vh], [hl, hh], [wl, wh]) = (self.speed, self.gap, self.omega);
        let within = |x: f64, [lo, hi]: [f64; 2]| x.max(lo).min(hi);
        match asked {
            Asked::Shock => [vh, hl, 0.0],
            Asked::Response(_, Peaked::AccelerationOverOmega) => {
                let gap = scaled * vh / wh;
                if gap < hl {
                    let omega = within(scaled * vh / hl, self.omega);
                    [vh, hl, omega]
                } else if gap > hh {
                    [within(wh * hh / scaled, self.speed), hh, wh]
                } else {
                    [vh, gap, wh]
                }
            }
            Asked::Response(_, Peaked::PseudoVelocity) => {
                let gap = scaled * vh / wl;
                if gap < hl {
                    [vh, hl, within(scaled * vh / hl, self.omega)]
                } else if gap <= hh {
                    [vh, gap, wl]
                } else {
                    // v0/ω = hh/Ω: the speed gives way first, then ω rises.
                    let speed = within(wl * hh / scaled, [vl, vh]);
                    [speed, hh, within(scaled * speed / hh, self.omega)]
                }
            }
        }
    }
    fn factor(&self, asked: Asked, scaled: f64) -> f64 {
        let [v, _, w] = self.drop(asked, scaled);
        match asked {
            Asked::Shock => v,
            Asked::Response(_, Peaked::AccelerationOverOmega) => w * v,
            Asked::Response(_, Peaked::PseudoVelocity) => v / w,
        }
    }
    /// The largest factor over a range of Ω: it rises to a plateau and falls from it.
    fn largest_factor(&self, asked: Asked, [lo, hi]: [f64; 2]) -> f64 {
        let omega =
            if matches!(asked, Asked::Response(_, Peaked::PseudoVelocity)) { self.omega[0] } else { self.omega[1] };
        let plateau = [omega * self.gap[0] / self.speed[1], omega * self.gap[1] / self.speed[1]];
        let nearest = if hi < plateau[0] { hi } else { lo.max(plateau[0]) };
        self.factor(asked, nearest)
    }
}

/// A part of the plane for one variant.
#[derive(Debug, Clone, Copy)]
struct Cell {
    variant: usize,
    scaled: [f64; 2],
    restitution: [f64; 2],
    upper: f64,
    /// Whether the next halving goes along Ω.
    along_scaled: bool,
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Cell {}
impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        self.upper.total_cmp(&other.upper)
    }
}

/// Trains of ranges of e, kept: the parts of a product ask for the same ones.
#[derive(Debug)]
pub(crate) struct Trains {
    clattering: [Clattering; 2],
    kept: HashMap<(bool, u64, u64), Rc<LooseTrain>>,
}

impl Trains {
    pub(crate) fn new(product: &Product) -> Self {
        let clattering = [End::A, End::B].map(|first| Clattering::new(&product.body, first));
        Self { clattering, kept: HashMap::new() }
    }
    /// The product with this end first.
    pub(crate) fn clattering(&self, first: End) -> &Clattering {
        &self.clattering[usize::from(first == End::B)]
    }
    fn train(&mut self, first: End, [lo, hi]: [f64; 2]) -> Rc<LooseTrain> {
        let clattering = self.clattering[usize::from(first == End::B)];
        let key = (first == End::B, lo.to_bits(), hi.to_bits());
        Rc::clone(self.kept.entry(key).or_insert_with(|| Rc::new(clattering.train(lo, hi))))
    }
}

/// The search for one demand.
struct Search<'a> {
    trains: &'a mut Trains,
    asked: Asked,
    variants: &'a [Variant],
    ranges: &'a Ranges,
    shocks: Vec<LooseShock>,
    worst: Worst,
}

/// The worst case of one demand over all variants and ranges; variants are not empty.
pub(crate) fn worst(trains: &mut Trains, asked: Asked, variants: &[Variant], ranges: &Ranges) -> Worst {
    let worst = Worst {
        demand: 0.0,
        attained: 0.0,
        variant: variants[0],
        speed: ranges.speed[1],
        gap: ranges.gap[0],
        restitution: ranges.restitution[1],
        omega: ranges.omega[1],
        cells: 0,
    };
    let mut search = Search { trains, asked, variants, ranges, shocks: Vec::new(), worst };
    search.run();
    search.worst
}

impl Search<'_> {
    fn run(&mut self) {
        let scaled = if matches!(self.asked, Asked::Shock) { [0.0; 2] } else { self.ranges.scaled() };
        self.sow(scaled);
        let mut cells = BinaryHeap::new();
        for variant in 0..self.variants.len() {
            let cell = Cell { variant, scaled, restitution: self.ranges.restitution, upper: 0.0, along_scaled: true };
            cells.push(self.bound(cell));
        }
        while let Some(cell) = cells.pop() {
            let sole = cell.scaled[0] >= cell.scaled[1] && cell.restitution[0] >= cell.restitution[1];
            let close = cell.upper <= (1.0 + TOLERANCE) * self.worst.attained;
            if close || sole || self.worst.cells >= MOST_CELLS {
                self.worst.demand = cell.upper.max(self.worst.attained) * (1.0 + ROUNDINGS);
                return;
            }
            let halves = |[lo, hi]: [f64; 2]| {
                let middle = 0.5 * (lo + hi);
                [[lo, middle], [middle, hi]]
            };
            let parts = if cell.along_scaled {
                halves(cell.scaled).map(|scaled| Cell { scaled, ..cell })
            } else {
                halves(cell.restitution).map(|restitution| Cell { restitution, ..cell })
            };
            for part in parts {
                let part = self.bound(part);
                // Cells that cannot exceed the best found are dropped.
                if part.upper > self.worst.attained {
                    cells.push(part);
                }
            }
        }
        self.worst.demand = self.worst.attained * (1.0 + ROUNDINGS);
    }

    /// Single drops to begin with: corners and a coarse grid, where the worst often is.
    fn sow(&mut self, [lo, hi]: [f64; 2]) {
        let e = self.ranges.restitution;
        for variant in 0..self.variants.len() {
            for i in 0..=8_u32 {
                // Even in the square root: the peak is sharper at small Ω.
                let share = (f64::from(i) / 8.0).powi(2);
                let scaled = (lo + share * (hi - lo)).min(hi);
                for restitution in e {
                    let cell = Cell {
                        variant,
                        scaled: [scaled; 2],
                        restitution: [restitution; 2],
                        upper: 0.0,
                        along_scaled: true,
                    };
                    self.bound(cell);
                }
                if hi <= lo {
                    break;
                }
            }
        }
    }

    /// The cell with its bound; takes its middle as a candidate.
    fn bound(&mut self, mut cell: Cell) -> Cell {
        self.worst.cells += 1;
        let variant = self.variants[cell.variant];
        let train = self.trains.train(variant.first, cell.restitution);
        let middle = 0.5 * (cell.scaled[0] + cell.scaled[1]);
        let (attained, upper) = match self.asked {
            Asked::Shock => shock(&train, &variant),
            Asked::Response(damping, peaked) => {
                self.scale(&train, &variant, cell.scaled);
                let share = variant.shares[0].abs().max(variant.shares[1].abs());
                let bounds = peak_bounds(damping, peaked, &self.shocks, share * train.omitted);
                cell.along_scaled = self.along_scaled(&cell, &bounds);
                (bounds.middle, bounds.upper)
            }
        };
        if matches!(self.asked, Asked::Shock) || cell.scaled[0] >= cell.scaled[1] {
            cell.along_scaled = false;
        } else if cell.restitution[0] >= cell.restitution[1] {
            cell.along_scaled = true;
        }
        cell.upper = upper * self.ranges.largest_factor(self.asked, cell.scaled);
        let attained = attained * self.ranges.factor(self.asked, middle);
        if attained > self.worst.attained {
            let [speed, gap, omega] = self.ranges.drop(self.asked, middle);
            let restitution = 0.5 * (cell.restitution[0] + cell.restitution[1]);
            self.worst = Worst { attained, variant, speed, gap, restitution, omega, ..self.worst };
        }
        cell
    }

    /// Shocks at the place, with phases: the first unknown is Ω, the second e.
    fn scale(&mut self, train: &LooseTrain, variant: &Variant, [lo, hi]: [f64; 2]) {
        let (middle, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
        // Of a flat drop all strikes fall on one instant, whatever the gaps.
        let phase = |scaled: f64, gap: f64| if scaled == 0.0 { 0.0 } else { scaled * gap };
        self.shocks.clear();
        self.shocks.extend(train.strikes.iter().map(|LooseStrike { end, jump, gap }| {
            let share = variant.shares[usize::from(*end == End::B)];
            LooseShock {
                phase: phase(middle, gap.middle),
                phase_by: [phase(half, gap.middle), phase(middle, gap.slope)],
                // What only both do counts half for each.
                phase_rest: [0.0, phase(hi, gap.rest)].map(|own| own + 0.5 * phase(half, gap.slope.abs())),
                least_phase: phase(lo, gap.least),
                most_phase: phase(hi, gap.most),
                delta_v: share * jump.middle,
                delta_v_by: share * jump.slope,
                delta_v_rest: share.abs() * jump.rest,
                most_delta_v: share.abs() * jump.most,
            }
        }));
    }

    /// Whether Ω rather than e is what leaves most in doubt.
    fn along_scaled(&self, cell: &Cell, bounds: &PeakBounds) -> bool {
        let [lo, hi] = cell.scaled;
        // However doubt is shared out, neither range is cut much finer than the other.
        let width = |[lo, hi]: [f64; 2], [least, most]: [f64; 2]| (hi - lo) / (most - least);
        let lean = width(cell.scaled, self.ranges.scaled()) / width(cell.restitution, self.ranges.restitution);
        if !(1.0 / MOST_LEAN..=MOST_LEAN).contains(&lean) {
            return lean > 1.0;
        }
        let middle = self.ranges.factor(self.asked, 0.5 * (lo + hi));
        let factor = self.ranges.largest_factor(self.asked, cell.scaled) / middle - 1.0;
        bounds.upper.is_finite() && bounds.doubt[0] + factor * bounds.upper >= bounds.doubt[1]
    }
}

/// Largest single shock of a train: attained in the middle, and at most.
fn shock(train: &LooseTrain, variant: &Variant) -> (f64, f64) {
    let share = |end: End| variant.shares[usize::from(end == End::B)].abs();
    let mut attained = 0.0_f64;
    let mut upper = train.omitted * variant.shares[0].abs().max(variant.shares[1].abs());
    for s in &train.strikes {
        attained = attained.max(share(s.end) * s.jump.middle);
        upper = upper.max(share(s.end) * s.jump.most);
    }
    (attained, upper)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Law, Spread};
    use clatter::flight::Body;

    /// The effort behind a proof: cells that had to be bounded, each about half a microsecond.
    #[test]
    fn few_cells_prove_a_demand() {
        for (q, restitution, omega, zeta, s, most) in [
            // A uniform bar, soft and stiff parts.
            (0.5, [0.2, 0.4], [60.0, 60.0], 0.05, 0.8, 100),
            (0.5, [0.2, 0.4], [1400.0, 1400.0], 0.05, 0.3, 150),
            (0.5, [0.2, 0.4], [500.0, 900.0], 0.05, -0.5, 200),
            // Long trains, some endless.
            (0.73, [0.1, 0.3], [300.0, 300.0], 0.1, 0.9, 700),
            // What rang has faded before the next strike: many gaps are about as bad.
            (0.72, [0.1, 0.2], [1450.0, 1650.0], 1.01, -0.3, 800),
            (0.28, [0.2, 0.5], [1000.0, 1000.0], 1.9, -0.65, 900),
        ] {
            let k = ((1.0_f64 - q) / (1.0 + q)).sqrt();
            let product = Product {
                name: String::new(),
                body: Body::new(0.15, 0.075 * k).unwrap(),
                mass_kg: None,
                restitution: Spread::new(restitution[0], restitution[1], Law::Range).unwrap(),
                contact_time_s: None,
            };
            let mut trains = Trains::new(&product);
            let variants = [End::A, End::B].map(|first| {
                let toward = if first == End::A { s } else { -s };
                Variant { first, position_m: 0.075 * s, shares: trains.clattering(first).shares(toward) }
            });
            // A drop from 1.2 m at 0.5° to 10°.
            let gap = [0.5_f64, 10.0].map(|tilt| 0.15 * tilt.to_radians().sin());
            let ranges = Ranges { speed: [4.85, 4.85], gap, restitution, omega };
            for peaked in [Peaked::AccelerationOverOmega, Peaked::PseudoVelocity] {
                let asked = Asked::Response(DampingRatio::new(zeta).unwrap(), peaked);
                let worst = worst(&mut trains, asked, &variants, &ranges);
                assert!(worst.demand <= worst.attained * (1.0 + TOLERANCE) * (1.0 + 2.0 * ROUNDINGS), "{q} {worst:?}");
                assert!(worst.cells <= most, "{q} {omega:?}: {} cells", worst.cells);
            }
        }
    }
}
