//! The smallest change that makes a part safe with a margin: of one lever, or of two where one is not enough.

use std::sync::atomic::{AtomicUsize, Ordering};

use clatter_flight::Body;
use rayon::prelude::*;

use crate::search::{Place, Ranges, Task, Watch};
use crate::{
    Accuracy, Assessment, Component, ComponentAssessment, Damping, Error, Law, Limit, LimitKind, Mount, Product,
    ProductFile, Spread, Verdict,
};

/// One thing that a designer can change while all else stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lever {
    /// The product's inertia ratio q, by moving mass.
    InertiaRatio,
    /// Its coefficient of restitution e, by the casing; a range moves as a whole, cut at the bounds.
    Restitution,
    /// Where the part is.
    Position,
    /// The part's natural frequency; a range is multiplied as a whole.
    Frequency,
    /// The part's damping ratio.
    Damping,
}

impl Lever {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::InertiaRatio, Self::Restitution, Self::Position, Self::Frequency, Self::Damping];

    /// `inertia-ratio`, `restitution`, `position`, `natural-frequency`, `damping-ratio`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::InertiaRatio => "inertia-ratio",
            Self::Restitution => "restitution",
            Self::Position => "position",
            Self::Frequency => "natural-frequency",
            Self::Damping => "damping-ratio",
        }
    }
    /// Unit of its values: empty, `m` or `Hz`.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::InertiaRatio | Self::Restitution | Self::Damping => "",
            Self::Position => "m",
            Self::Frequency => "Hz",
        }
    }
}

/// How far a designer can go. A place is bounded by the product itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Inertia ratios that can be built.
    pub q: [f64; 2],
    /// Coefficients of restitution that can be had.
    pub e: [f64; 2],
    /// Largest factor on the natural frequency, up or down.
    pub frequency_factor: f64,
    /// Damping ratios that can be had.
    pub damping: [f64; 2],
}

impl Default for Bounds {
    /// 0 ≤ q ≤ 0.9 and 0.05 ≤ e ≤ 0.9 (neither all mass in the center nor very dead or very bouncy casings can be
    /// built: section 6 of the paper), frequencies a factor of 4 either way, damping ratios up to 0.5.
    fn default() -> Self {
        Self { q: [0.0, 0.9], e: [0.05, 0.9], frequency_factor: 4.0, damping: [0.0, 0.5] }
    }
}

/// A change of one lever: low and high end of its value before and after, the same where it is one value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Which.
    pub lever: Lever,
    /// Before.
    pub from: [f64; 2],
    /// After, to four significant digits (of the inertia ratio: of the radius of gyration in mm that has it).
    pub to: [f64; 2],
}

/// What one lever can do for one part.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// The smallest change that makes it safe with the margin, and what the assessment of the file with these very values says.
    Change {
        /// The change.
        change: Change,
        /// The part, assessed again with the change.
        after: Box<ComponentAssessment>,
    },
    /// No value between these, tried in steps of their distance over [`STEPS`], makes it safe.
    Nowhere {
        /// The bounds.
        bounds: [f64; 2],
    },
    /// No limit of the part depends on it.
    NoEffect,
}

/// One lever and what it can do.
#[derive(Debug, Clone, PartialEq)]
pub struct Remedy {
    /// Which.
    pub lever: Lever,
    /// What it can do.
    pub outcome: Outcome,
}

/// Changes together, and what the assessment then says.
#[derive(Debug, Clone, PartialEq)]
pub struct Together {
    /// One or two changes.
    pub changes: Vec<Change>,
    /// The part, assessed again with them.
    pub after: Box<ComponentAssessment>,
}

/// What would make one failing part safe.
#[derive(Debug, Clone, PartialEq)]
pub struct Remedies {
    /// Index of the component in the file.
    pub component: usize,
    /// Each lever alone, in the order of [`Lever::ALL`].
    pub levers: Vec<Remedy>,
    /// Where no lever alone is enough, the two that are with the smallest changes.
    pub pair: Option<Together>,
    /// Where no two are enough either, how near one gets.
    pub nearest: Option<Together>,
}

/// Steps from bound to bound in which safe values are looked for; an island of safety narrower than one may be missed.
pub const STEPS: u32 = 48;
/// Bisections of the step in which safety begins: its place is then known to 1/2⁸ of a step.
const BISECTIONS: u32 = 8;
/// Values of a lever from which the best one is taken where none is enough.
const TRIES: u32 = 8;
/// Steps from the present values to the best ones of two levers together.
const SHARES: u32 = 16;

impl ProductFile {
    /// For every component that is not safe with a margin, and every lever alone, the smallest change that makes it so; where none
    /// does, the best pair of changes, or how near one gets.
    ///
    /// # Method
    /// Values are tried outward from the present one, in steps of 1/48 of the bounds (frequencies: of their logarithm); the
    /// step in which safety begins is bisected eight times. Every value is rounded to four digits before it is assessed:
    /// [`assess_to`](Self::assess_to) finds the part safe with the margin, of the file with the value as it is printed. A value is
    /// passed over at once where a drop that broke the part before still does. Two levers go from their present values to
    /// the best of each together.
    ///
    /// # Limitation
    /// A safe stretch narrower than a step may be missed. Of pairs only those on the way to the best value of each lever are
    /// looked at.
    ///
    /// # Errors
    /// As [`assess`](Self::assess), for the product as it is; [`Error::Number`] for a margin that is negative or not finite.
    pub fn remedies(&self, assessment: &Assessment, bounds: &Bounds, margin: f64) -> Result<Vec<Remedies>, Error> {
        self.remedies_watched(assessment, bounds, margin, &|_, _| true)
    }

    /// The same, watched.
    ///
    /// # Errors
    /// As [`remedies`](Self::remedies); [`Error::Stopped`] where `watch` says so.
    pub fn remedies_watched(
        &self,
        assessment: &Assessment,
        bounds: &Bounds,
        margin: f64,
        watch: Watch<'_>,
    ) -> Result<Vec<Remedies>, Error> {
        if !(margin >= 0.0 && margin.is_finite()) {
            return Err(Error::Number(margin));
        }
        let wanting = |c: &ComponentAssessment| !is_enough(c, margin);
        let failing = assessment.components.iter().enumerate().filter(|(_, found)| wanting(found));
        let tasks: Vec<_> = failing.flat_map(|(i, found)| Lever::ALL.map(|lever| (i, found, lever))).collect();
        let case = |i: usize| {
            let component = &self.components[i];
            Case { file: self, component, accuracy: assessment.accuracy, bounds, margin }
        };
        // One lever after the other of each component, then at most one pair of them, which takes as long as a lever.
        let all = tasks.len() + tasks.len() / Lever::ALL.len();
        let done = AtomicUsize::new(0);
        let go_on = || if watch(done.fetch_add(1, Ordering::Relaxed), all) { Ok(()) } else { Err(Error::Stopped) };
        let solve =
            |&(i, found, lever): &(usize, &ComponentAssessment, Lever)| go_on().map(|()| case(i).solve(lever, found));
        let outcomes = tasks.par_iter().map(solve).collect::<Result<Vec<Outcome>, Error>>()?;
        let mut list: Vec<Remedies> = Vec::new();
        for ((component, _, lever), outcome) in tasks.into_iter().zip(outcomes) {
            if list.last().is_none_or(|last| last.component != component) {
                list.push(Remedies { component, levers: Vec::new(), pair: None, nearest: None });
            }
            if let Some(last) = list.last_mut() {
                last.levers.push(Remedy { lever, outcome });
            }
        }
        for remedies in &mut list {
            go_on()?;
            if !remedies.levers.iter().any(|remedy| matches!(remedy.outcome, Outcome::Change { .. })) {
                (remedies.pair, remedies.nearest) = case(remedies.component).together(&remedies.levers);
            }
        }
        Ok(list)
    }
}

/// Whether a part is safe with a margin.
fn is_enough(found: &ComponentAssessment, margin: f64) -> bool {
    found.verdict == Verdict::Safe && found.tightest().room() >= margin
}

impl Product {
    /// The product with another inertia ratio: the radius of gyration that has it, the arms as they are.
    ///
    /// # Formula
    /// q² (L_a² + ρ²)(L_b² + ρ²) = (L_a L_b − ρ²)², a quadratic in ρ², whose smaller root has q > 0.
    ///
    /// # Errors
    /// [`Error::Bar`] unless −1 < q ≤ 1.
    pub fn with_inertia_ratio(&self, q: f64) -> Result<Self, Error> {
        clatter::Bar::new(q, 0.0)?;
        let [a, b] = self.body.arms_m();
        let (product, squares) = (a * b, a * a + b * b);
        let less = (1.0 - q) * (1.0 + q);
        let half = product + 0.5 * q * q * squares;
        // half² − (1 − q²)² P², without cancellation for small q
        let root = (0.5 * q * q * squares + product * q * q).max(0.0).sqrt() * (half + product * less).max(0.0).sqrt();
        let larger = half + root;
        let square = if q > 0.0 { product * product * less / larger } else { larger / less };
        Ok(Self { body: Body::off_center(a, b, square.sqrt())?, ..self.clone() })
    }
}

/// Four significant digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// One part that is to be made safe.
#[derive(Clone, Copy)]
struct Case<'a> {
    file: &'a ProductFile,
    component: &'a Component,
    accuracy: Accuracy,
    bounds: &'a Bounds,
    margin: f64,
}

impl Case<'_> {
    fn solve(&self, lever: Lever, found: &ComponentAssessment) -> Outcome {
        if !self.matters(lever) {
            return Outcome::NoEffect;
        }
        let (here, [lo, hi]) = (self.here(lever), self.reach(lever));
        // Where the present value is beyond the bounds, from the bound that is next to it.
        let start = here.clamp(lo, hi);
        let ranges = self.ranges(self.file);
        let mut breakers: Vec<Place> =
            found.worst_case.iter().map(|worst| ranges.place_of(self.component, worst)).collect();
        let step = (hi - lo) / f64::from(STEPS);
        for k in 1..=STEPS {
            let mut best: Option<(f64, Box<ComponentAssessment>)> = None;
            for side in [-1.0, 1.0] {
                let outer = (start + side * f64::from(k) * step).clamp(lo, hi);
                let inner = (start + side * f64::from(k - 1) * step).clamp(lo, hi);
                // beyond the bound nothing is left to try but the bound itself
                if (outer - inner).abs() <= 0.0 && k > 1 {
                    continue;
                }
                let Some(after) = self.enough(&[(lever, outer)], &mut breakers) else { continue };
                let begin = self.begin(lever, inner, (outer, Box::new(after)), &mut breakers);
                if best.as_ref().is_none_or(|(x, _)| (begin.0 - here).abs() < (x - here).abs()) {
                    best = Some(begin);
                }
            }
            if let Some((x, after)) = best {
                return Outcome::Change { change: self.change(lever, x), after };
            }
        }
        Outcome::Nowhere { bounds: [self.shown(lever, lo), self.shown(lever, hi)] }
    }

    /// The enough value nearest to `short`, which is not, from one that is.
    fn begin(
        &self,
        lever: Lever,
        mut short: f64,
        mut enough: (f64, Box<ComponentAssessment>),
        breakers: &mut Vec<Place>,
    ) -> (f64, Box<ComponentAssessment>) {
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (short + enough.0);
            match self.enough(&[(lever, middle)], breakers) {
                Some(after) => enough = (middle, Box::new(after)),
                None => short = middle,
            }
        }
        enough
    }

    /// The best pair that is enough, and else how near one gets.
    fn together(&self, levers: &[Remedy]) -> (Option<Together>, Option<Together>) {
        let useful = levers.iter().filter(|remedy| remedy.outcome != Outcome::NoEffect).map(|remedy| remedy.lever);
        let best: Vec<_> = useful.filter_map(|lever| self.best_of(lever)).collect();
        let mut nearest: Option<Together> = None;
        let mut near = |changes: Vec<Change>, after: ComponentAssessment| {
            // Of a limit without an answer nobody knows how near it is.
            if after.limits.iter().any(|limit| limit.verdict == Verdict::Undecided && limit.uncertainty.is_infinite()) {
                return;
            }
            let closer = |last: &Together| after.tightest().room() > last.after.tightest().room();
            if nearest.as_ref().is_none_or(closer) {
                nearest = Some(Together { changes, after: Box::new(after) });
            }
        };
        let mut pair: Option<(u32, Together)> = None;
        for (i, (one, x, after)) in best.iter().enumerate() {
            near(vec![self.change(*one, *x)], after.clone());
            for (two, y, _) in &best[i + 1..] {
                let at = |k: u32| {
                    let share = f64::from(k) / f64::from(SHARES);
                    let along = |lever: Lever, to: f64| {
                        let here = self.here(lever);
                        (lever, here + share * (to - here))
                    };
                    [along(*one, *x), along(*two, *y)]
                };
                let Some(all) = self.assessed(&at(SHARES)) else { continue };
                let changes = |k: u32| at(k).iter().map(|&(lever, x)| self.change(lever, x)).collect::<Vec<_>>();
                if !is_enough(&all, self.margin) {
                    near(changes(SHARES), all);
                    continue;
                }
                let (mut short, mut enough, mut after) = (0, SHARES, all);
                while enough - short > 1 {
                    let middle = u32::midpoint(short, enough);
                    match self.assessed(&at(middle)).filter(|found| is_enough(found, self.margin)) {
                        Some(found) => (enough, after) = (middle, found),
                        None => short = middle,
                    }
                }
                if pair.as_ref().is_none_or(|(least, _)| enough < *least) {
                    pair = Some((enough, Together { changes: changes(enough), after: Box::new(after) }));
                }
            }
        }
        match pair {
            Some((_, pair)) => (Some(pair), None),
            None => (None, nearest),
        }
    }

    /// The value of a lever, among some from bound to bound, that leaves the largest margin.
    fn best_of(&self, lever: Lever) -> Option<(Lever, f64, ComponentAssessment)> {
        let [lo, hi] = self.reach(lever);
        let tries = (0..=TRIES).filter_map(|k| {
            let x = lo + f64::from(k) / f64::from(TRIES) * (hi - lo);
            Some((lever, x, self.assessed(&[(lever, x)])?))
        });
        tries.max_by(|a, b| a.2.tightest().room().total_cmp(&b.2.tightest().room()))
    }

    /// Whether a limit of the part depends on a lever.
    fn matters(&self, lever: Lever) -> bool {
        let kinds = self.component.limits.kinds();
        let suspended = matches!(self.component.mount, Mount::Suspended { .. });
        let responds = kinds.iter().any(|kind| matches!(kind, LimitKind::Acceleration | LimitKind::RattleSpace));
        match lever {
            Lever::Frequency | Lever::Damping => suspended && responds,
            Lever::Position => kinds.iter().any(|kind| *kind != LimitKind::AngularVelocityChange),
            Lever::InertiaRatio | Lever::Restitution => true,
        }
    }

    fn ranges<'b>(&self, file: &'b ProductFile) -> Ranges<'b> {
        file.ranges(&self.accuracy)
    }

    /// The part with these values, if it is safe with the margin. What cannot be assessed is not known to be safe.
    fn enough(&self, values: &[(Lever, f64)], breakers: &mut Vec<Place>) -> Option<ComponentAssessment> {
        let file = self.changed(values)?;
        let (ranges, component) = (self.ranges(&file), file.components.first()?);
        let breaks = |place: &Place| {
            Limit::of(component)
                .into_iter()
                .any(|limit| ranges.in_one(&Task { component, limit }, place) * (1.0 + self.margin) > 1.0)
        };
        if breakers.iter().rev().any(breaks) {
            return None;
        }
        let found = self.assess(&file)?;
        if is_enough(&found, self.margin) {
            return Some(found);
        }
        breakers.extend(found.worst_case.iter().map(|worst| ranges.place_of(component, worst)));
        None
    }

    fn assessed(&self, values: &[(Lever, f64)]) -> Option<ComponentAssessment> {
        self.assess(&self.changed(values)?)
    }

    fn assess(&self, file: &ProductFile) -> Option<ComponentAssessment> {
        file.assess_to(&self.accuracy).ok()?.components.into_iter().next()
    }

    /// The present value, as the lever counts: a range by its low end, a frequency by the logarithm of its factor.
    fn here(&self, lever: Lever) -> f64 {
        match (lever, self.component.mount) {
            (Lever::InertiaRatio, _) => self.file.product.inertia_ratio(),
            (Lever::Restitution, _) => self.file.product.restitution.lo(),
            (Lever::Position, _) => self.component.position_m.lo(),
            (Lever::Frequency, _) | (Lever::Damping, Mount::Hard) => 0.0,
            (Lever::Damping, Mount::Suspended { damping, .. }) => damping.ratios()[0],
        }
    }

    /// The bounds, as the lever counts.
    fn reach(&self, lever: Lever) -> [f64; 2] {
        match lever {
            Lever::InertiaRatio => self.bounds.q,
            // the range as a whole: until its high end is at the low bound, its low end at the high bound
            Lever::Restitution => {
                let wide = self.file.product.restitution.hi() - self.file.product.restitution.lo();
                [self.bounds.e[0] - wide, self.bounds.e[1]]
            }
            Lever::Position => {
                let wide = self.component.position_m.hi() - self.component.position_m.lo();
                let most = 0.5 * (self.file.product.body.length_m() - self.component.extent_m).max(0.0);
                [-most, (most - wide).max(-most)]
            }
            Lever::Frequency => {
                let most = self.bounds.frequency_factor.ln();
                [-most, most]
            }
            Lever::Damping => self.bounds.damping,
        }
    }

    /// A bound as it is shown.
    fn shown(&self, lever: Lever, x: f64) -> f64 {
        match lever {
            Lever::Restitution => x.clamp(self.bounds.e[0], self.bounds.e[1]),
            Lever::Frequency => self.value(lever, x)[usize::from(x > 0.0)],
            _ => x,
        }
    }

    fn change(&self, lever: Lever, x: f64) -> Change {
        let from = match (lever, self.component.mount) {
            (Lever::Damping, Mount::Suspended { damping, .. }) => damping.ratios(),
            (Lever::Frequency, Mount::Suspended { frequency_hz, .. }) => [frequency_hz.lo(), frequency_hz.hi()],
            (Lever::Restitution, _) => [self.file.product.restitution.lo(), self.file.product.restitution.hi()],
            (Lever::Position, _) => [self.component.position_m.lo(), self.component.position_m.hi()],
            _ => [self.here(lever); 2],
        };
        Change { lever, from, to: self.value(lever, x) }
    }

    /// What a value of the lever means, low and high end, as it is printed.
    fn value(&self, lever: Lever, x: f64) -> [f64; 2] {
        match (lever, &self.component.mount) {
            (Lever::Restitution, _) => {
                let range = &self.file.product.restitution;
                let moved = [x, x + (range.hi() - range.lo())];
                moved.map(|e| rounded(e.clamp(self.bounds.e[0], self.bounds.e[1])))
            }
            (Lever::Frequency, Mount::Suspended { frequency_hz, .. }) => {
                [frequency_hz.lo(), frequency_hz.hi()].map(|f| rounded(f * x.exp()))
            }
            (Lever::Position, _) => {
                let wide = self.component.position_m.hi() - self.component.position_m.lo();
                [x, x + wide].map(|place| 1e-3 * rounded(1e3 * place))
            }
            (Lever::InertiaRatio, _) => {
                let gyration = self.with_ratio(x).map(|product| product.inertia_ratio());
                [gyration.unwrap_or(x); 2]
            }
            _ => [rounded(x); 2],
        }
    }

    /// The product with about this inertia ratio, its radius of gyration in mm of four digits.
    fn with_ratio(&self, q: f64) -> Option<Product> {
        let product = self.file.product.with_inertia_ratio(q).ok()?;
        let [a, b] = product.body.arms_m();
        let gyration = 1e-3 * rounded(1e3 * product.body.gyration_m());
        Some(Product { body: Body::off_center(a, b, gyration).ok()?, ..product })
    }

    /// The product with these values, and the part alone.
    fn changed(&self, values: &[(Lever, f64)]) -> Option<ProductFile> {
        let mut component = self.component.clone();
        let mut product = self.file.product.clone();
        for &(lever, x) in values {
            let [lo, hi] = self.value(lever, x);
            let range = Spread::new(lo, hi, if lo < hi { Law::Range } else { Law::Value }).ok()?;
            match (lever, &mut component.mount) {
                (Lever::InertiaRatio, _) => product = Product { body: self.with_ratio(x)?.body, ..product },
                (Lever::Restitution, _) => product.restitution = range,
                (Lever::Position, _) => component.position_m = range,
                (Lever::Frequency, Mount::Suspended { frequency_hz, .. }) => *frequency_hz = range,
                (Lever::Damping, Mount::Suspended { damping, .. }) => *damping = Damping::Ratio(range),
                (Lever::Frequency | Lever::Damping, Mount::Hard) => return None,
            }
        }
        Some(ProductFile { product, drop: self.file.drop, components: vec![component], records: Vec::new() })
    }
}
