//! Single changes that make a part hold, by the drops of the pictures.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use super::drops::{Drops, Places, Tilt, View, along, parts};
use super::scale::Scale;
use super::zone::zone;
use super::{Changes, MARGIN};
use crate::design::{Bounds, Case, Change, Lever};
use crate::drop::Until;
use crate::search::{Ranges, rough_to_rad_s};
use crate::{Accuracy, Component, ComponentAssessment, ContactLaw, Limit, ProductFile};

/// Values of a lever from bound to bound, and halvings of the step in which a part begins to hold.
const STEPS: u32 = 16;
const HALVINGS: u32 = 4;

/// What all parts share.
pub(super) struct Shared<'a> {
    pub(super) file: &'a ProductFile,
    pub(super) accuracy: Accuracy,
    pub(super) bounds: &'a Bounds,
    /// Of each drop of the file.
    pub(super) tilts: &'a [Vec<Tilt>],
    pub(super) until: Until,
    /// Contact laws that count, each with places all over the product in its drops as it is.
    pub(super) laws: &'a [ContactLaw],
    pub(super) grids: &'a [Places<'a>],
    /// The drops of the product with one thing changed, by the bits of the value: followed once for all parts.
    pub(super) changed: [BTreeMap<u64, OnceLock<Option<Vec<Drops>>>>; 3],
}

/// A part that does not hold.
pub(super) struct Failing<'a> {
    pub(super) component: &'a Component,
    pub(super) assessed: &'a ComponentAssessment,
    /// Of each limit, by each law.
    pub(super) scales: &'a [Vec<Scale>],
    /// What its own ends feel in the drops as they are, by each law.
    pub(super) ends: &'a [Places<'a>],
}

/// What is changed of the product and not of the part.
const OF_PRODUCT: [Lever; 3] = [Lever::InertiaRatio, Lever::Restitution, Lever::ContactTime];

impl Shared<'_> {
    fn case<'b>(&'b self, component: &'b Component) -> Case<'b> {
        Case {
            file: self.file,
            component,
            accuracy: self.accuracy,
            bounds: self.bounds,
            margin: MARGIN,
            go_on: &|| true,
        }
    }

    /// Makes room for the drops of the product with other values of the levers that are not of a part.
    pub(super) fn with_room(mut self) -> Self {
        if let Some(component) = self.file.components.first() {
            let values = OF_PRODUCT.map(|lever| {
                let case = self.case(component);
                let all = steps(&case, lever).into_iter().flatten();
                all.map(|x| (x.to_bits(), OnceLock::new())).collect()
            });
            self.changed = values;
        }
        self
    }

    /// What would make a part hold with the margin, each change alone.
    pub(super) fn changes(&self, of: &Failing<'_>) -> Changes {
        let case = self.case(of.component);
        let levers = Lever::of(&self.file.product, of.component).into_iter();
        // Its zone is along the length alone.
        let levers = levers.filter(|lever| case.matters(*lever) && *lever != Lever::Across);
        let mut changes = Changes::default();
        for lever in levers {
            match self.smallest(&case, of, lever) {
                Some(x) => changes.enough.push(case.change(lever, x)),
                None => changes.not.push((lever, case.reach(lever).map(|x| case.shown(lever, x)))),
            }
        }
        let same = |change: &Change| change.from.map(f64::to_bits) == change.to.map(f64::to_bits);
        changes.enough.retain(|change| !same(change));
        changes
    }

    fn smallest(&self, case: &Case<'_>, of: &Failing<'_>, lever: Lever) -> Option<f64> {
        match lever {
            Lever::Limit(_) => Self::limit(case, of, lever),
            Lever::Position => self.place(case, of),
            Lever::Across => None,
            Lever::Frequency | Lever::Damping => {
                let mut views: Vec<_> = of.ends.iter().map(|ends| ends.drops.counted()).collect();
                let enough = |x: f64| {
                    case.changed(&[(lever, x)]).is_some_and(|file| holds(of, &file.components[0], of.ends, &mut views))
                };
                search(case, lever, HALVINGS, enough)
            }
            Lever::InertiaRatio | Lever::Restitution | Lever::ContactTime => {
                search(case, lever, 0, |x| self.product_holds(case, of, (lever, x)))
            }
        }
    }

    /// A limit so high that the demand leaves the margin, where all others are kept.
    fn limit(case: &Case<'_>, of: &Failing<'_>, lever: Lever) -> Option<f64> {
        let needs = |scales: &Vec<Scale>| scales.iter().map(|scale| scale.needs(MARGIN)).fold(0.0, f64::max);
        let (mut factor, mut others) = (1.0, true);
        for (limit, scales) in Limit::of(of.component).iter().zip(of.scales) {
            if lever == Lever::Limit(limit.kind) { factor = needs(scales) } else { others &= needs(scales) <= 1.0 }
        }
        let [_, most] = case.reach(lever);
        let [before, _] = case.change(lever, 0.0).from;
        // Rounded to the nearest that can be specified, it may fall short.
        let mut tries = (0..16).map(|k| libm::log(factor) + 0.01 * f64::from(k)).filter(|x| *x <= most);
        tries.find(|x| others && case.value(lever, *x)[0] >= factor * before)
    }

    /// The nearest place of the zone that leaves the margin.
    fn place(&self, case: &Case<'_>, of: &Failing<'_>) -> Option<f64> {
        let [lo, hi] = zone(self.grids, of.component, of.assessed, of.scales, MARGIN)?;
        let wide = of.component.position_m.hi() - of.component.position_m.lo();
        let (middle, edge) = (0.5 * (lo + hi - wide), of.component.position_m.lo().clamp(lo, (hi - wide).max(lo)));
        let inside = |x: &f64| {
            let [from, to] = case.value(Lever::Position, *x);
            lo <= from && to <= hi
        };
        (0..=16).map(|k| edge + f64::from(k) / 16.0 * (middle - edge)).find(inside)
    }

    /// Whether the part holds in the drops of the product with this value.
    fn product_holds(&self, case: &Case<'_>, of: &Failing<'_>, (lever, x): (Lever, f64)) -> bool {
        let followed = || {
            let file = case.changed(&[(lever, x)])?;
            let listed = file.listed();
            let of = |&law: &ContactLaw| {
                let ranges =
                    listed.iter().map(|one| Ranges { law, ..file.ranges_of(&one.drop, one.posture, &self.accuracy) });
                Drops::of_all(ranges, self.tilts, self.until)
            };
            self.laws.iter().map(of).collect()
        };
        let Some(kept) = OF_PRODUCT.iter().position(|l| *l == lever).map(|n| &self.changed[n]) else { return false };
        let Some(drops) = kept.get(&x.to_bits()).and_then(|drops| drops.get_or_init(followed).as_ref()) else {
            return false;
        };
        let fastest = rough_to_rad_s(of.component);
        let ends: Vec<_> = drops.iter().map(|drops| Places::new(drops, along(of.component), fastest)).collect();
        let mut views: Vec<_> = drops.iter().map(Drops::counted).collect();
        holds(of, of.component, &ends, &mut views)
    }
}

/// Whether no drop asks a part for more than leaves the margin, of any limit.
fn holds(of: &Failing<'_>, component: &Component, ends: &[Places<'_>], views: &mut [Vec<View>]) -> bool {
    let same = component.mount == of.component.mount;
    let mut limits = Limit::of(component).into_iter().zip(&of.assessed.limits).zip(of.scales);
    limits.all(|((limit, found), scales)| {
        let parts = parts(component, &limit, found.worst_case.as_ref().filter(|_| same));
        let mut laws = ends.iter().zip(views.iter_mut()).zip(scales);
        laws.all(|((ends, views), scale)| {
            let at: Vec<usize> = (0..ends.positions_m.len()).collect();
            !ends.exceeds(views, &at, &limit, &parts, scale.most(MARGIN))
        })
    })
}

/// Values of a lever outward from the present one, on both sides.
fn steps(case: &Case<'_>, lever: Lever) -> Vec<[f64; 2]> {
    let [lo, hi] = case.reach(lever);
    let start = case.here(lever).clamp(lo, hi);
    let step = (hi - lo) / f64::from(STEPS);
    (1..=STEPS).map(|k| [-1.0, 1.0].map(|side| (start + side * f64::from(k) * step).clamp(lo, hi))).collect()
}

/// The value nearest to the present one that is enough.
fn search(case: &Case<'_>, lever: Lever, halvings: u32, mut enough: impl FnMut(f64) -> bool) -> Option<f64> {
    let here = case.here(lever);
    let mut before = [here; 2];
    for at in steps(case, lever) {
        let mut found: Vec<f64> = Vec::new();
        for side in 0..2 {
            if at[side].to_bits() == before[side].to_bits() || !enough(at[side]) {
                continue;
            }
            let (mut short, mut held) = (before[side], at[side]);
            for _ in 0..halvings {
                let middle = 0.5 * (short + held);
                if enough(middle) { held = middle } else { short = middle }
            }
            found.push(held);
        }
        found.sort_by(|a, b| (a - here).abs().total_cmp(&(b - here).abs()));
        if let Some(x) = found.first() {
            return Some(*x);
        }
        before = at;
    }
    None
}
