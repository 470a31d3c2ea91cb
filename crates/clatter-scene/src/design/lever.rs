//! The smallest single change that makes a part safe.

use clatter::flight::Body;
use clatter_shock::DampingRatio;
use rayon::prelude::*;

use crate::demand::Demand;
use crate::plan::Pair;
use crate::search::{self, Field, Place, Task};
use crate::{Assessment, Component, ComponentAssessment, Error, Law, Mount, Product, ProductFile, Spread, Verdict};

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

impl Bounds {
    /// A part with the highest frequency and damping that it can be given.
    fn stiffest(&self, component: &Component) -> Option<Component> {
        let Mount::Suspended { frequency_hz, damping } = component.mount else { return None };
        let highest = frequency_hz.hi() * self.frequency_factor.max(1.0);
        let frequency_hz = Spread::new(highest, highest, Law::Value).ok()?;
        let damping = DampingRatio::new(self.damping[1].max(damping.get())).ok()?;
        Some(Component { mount: Mount::Suspended { frequency_hz, damping }, ..component.clone() })
    }
}

/// What one lever can do for one part.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// The smallest change that makes it safe: low and high end of the value before and after (the same where it is one
    /// value), and what the assessment then says of the part.
    Change {
        /// Before.
        from: [f64; 2],
        /// After.
        to: [f64; 2],
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

/// What would make one failing part safe.
#[derive(Debug, Clone, PartialEq)]
pub struct Remedies {
    /// Index of the component in the file.
    pub component: usize,
    /// Each lever alone, in the order of [`Lever::ALL`].
    pub levers: Vec<Remedy>,
}

/// Steps from bound to bound in which safe values are looked for; an island of safety narrower than one may be missed.
pub const STEPS: u32 = 96;
/// Bisections of the step in which safety begins: its place is then known to 1/2¹² of a step.
const BISECTIONS: u32 = 12;
/// Shares of what is left of the step, at which an answer on the border is tried.
const BEYOND: [f64; 6] = [0.0, 1e-4, 1e-3, 0.01, 0.1, 1.0];

impl ProductFile {
    /// For every component that fails, and every lever alone, the smallest change that makes it safe.
    ///
    /// # Method
    /// Values are tried outward from the present one, in steps of 1/96 of the bounds (frequencies: of their logarithm);
    /// the step in which safety begins is bisected twelve times, and the safe end of what is left is the answer:
    /// [`assess_to`](Self::assess_to) finds the part safe there, of the file with that value, to the accuracy of the
    /// assessment. A value is passed over at once where a drop that broke the part before still does.
    ///
    /// # Limitation
    /// A safe stretch narrower than a step may be missed, and where a model of [`assess`](Self::assess) is searched and
    /// not bounded, so may an unsafe one within.
    ///
    /// # Errors
    /// As [`assess`](Self::assess), for the product as it is.
    pub fn remedies(&self, assessment: &Assessment, bounds: &Bounds) -> Result<Vec<Remedies>, Error> {
        let failing = assessment.components.iter().enumerate().filter(|(_, c)| c.verdict == Verdict::Unsafe);
        let tasks: Vec<_> = failing.flat_map(|(i, found)| Lever::ALL.map(|lever| (i, found, lever))).collect();
        let stiffest: Vec<_> = self.components.iter().filter_map(|component| bounds.stiffest(component)).collect();
        let field = Field::new(&self.product, &self.drop, &stiffest, assessment.accuracy);
        let outcomes: Vec<Outcome> = tasks
            .par_iter()
            .map(|&(i, found, lever)| {
                let Some(component) = self.components.get(i) else { return Ok(Outcome::NoEffect) };
                let case = Case { file: self, field: &field, component, lever, bounds };
                Ok(case.solve(found))
            })
            .collect::<Result<_, Error>>()?;
        let mut list: Vec<Remedies> = Vec::new();
        for ((component, _, lever), outcome) in tasks.into_iter().zip(outcomes) {
            if list.last().is_none_or(|last| last.component != component) {
                list.push(Remedies { component, levers: Vec::new() });
            }
            if let Some(last) = list.last_mut() {
                last.levers.push(Remedy { lever, outcome });
            }
        }
        Ok(list)
    }
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

/// One lever of one part.
struct Case<'a> {
    file: &'a ProductFile,
    /// The product as it is.
    field: &'a Field<'a>,
    component: &'a Component,
    lever: Lever,
    bounds: &'a Bounds,
}

/// A drop that broke the part, in terms that outlast a change of the levers.
#[derive(Debug, Clone, Copy)]
struct Breaker {
    place: Place,
    /// The models of a proof; what was searched is planned anew.
    proven: Option<Pair>,
}

impl Case<'_> {
    fn solve(&self, found: &ComponentAssessment) -> Outcome {
        let limits = &self.component.limits;
        let suspended = matches!(self.component.mount, Mount::Suspended { .. });
        let responds = suspended && (limits.acceleration_m_s2.is_some() || limits.rattle_space_m.is_some());
        if matches!(self.lever, Lever::Frequency | Lever::Damping) && !responds {
            return Outcome::NoEffect;
        }
        let only_turns = limits.angular_velocity_change_rad_s.is_some()
            && limits.velocity_change_m_s.is_none()
            && limits.damage_boundary.is_none()
            && limits.acceleration_m_s2.is_none()
            && limits.rattle_space_m.is_none();
        if self.lever == Lever::Position && only_turns {
            return Outcome::NoEffect;
        }
        let (here, [lo, hi]) = (self.here(), self.reach());
        // Where the present value is beyond the bounds, from the bound that is next to it.
        let start = here.clamp(lo, hi);
        let mut breakers = Vec::new();
        remember(found, &mut breakers, self.field, self.component);
        let step = (hi - lo) / f64::from(STEPS);
        let mut best: Option<(f64, Box<ComponentAssessment>)> = None;
        for k in 1..=STEPS {
            for side in [-1.0, 1.0] {
                let outer = (start + side * f64::from(k) * step).clamp(lo, hi);
                let inner = (start + side * f64::from(k - 1) * step).clamp(lo, hi);
                // beyond the bound nothing is left to try but the bound itself
                if (outer - inner).abs() <= 0.0 && k > 1 {
                    continue;
                }
                if !self.is_safe_at(outer, &mut breakers) {
                    continue;
                }
                let x = self.begin(inner, outer, &mut breakers);
                let Some(begin) = self.confirmed(x, outer) else { continue };
                if best.as_ref().is_none_or(|(x, _)| (begin.0 - here).abs() < (x - here).abs()) {
                    best = Some(begin);
                }
            }
            if let Some((x, after)) = best {
                return Outcome::Change { from: self.value(here), to: self.value(x), after };
            }
        }
        Outcome::Nowhere { bounds: [self.shown(lo), self.shown(hi)] }
    }

    /// The safe value nearest to `unsafe_side`, from a safe one.
    fn begin(&self, mut unsafe_side: f64, mut safe_side: f64, breakers: &mut Vec<Breaker>) -> f64 {
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (unsafe_side + safe_side);
            if self.is_safe_at(middle, breakers) {
                safe_side = middle;
            } else {
                unsafe_side = middle;
            }
        }
        safe_side
    }

    /// The first value from `x` to `outer` that is safe as the file with it is assessed, whose pulses may have other
    /// pieces.
    fn confirmed(&self, x: f64, outer: f64) -> Option<(f64, Box<ComponentAssessment>)> {
        BEYOND.iter().find_map(|share| {
            let x = x + share * (outer - x);
            let found = self.changed(x)?.assess_to(&self.field.accuracy).ok()?.components.into_iter().next()?;
            (found.verdict == Verdict::Safe).then(|| (x, Box::new(found)))
        })
    }

    /// Whether the part is safe at a value of the lever, as the field has it. What cannot be assessed is not known to
    /// be safe.
    fn is_safe_at(&self, x: f64, breakers: &mut Vec<Breaker>) -> bool {
        let Some(file) = self.changed(x) else { return false };
        let Some(component) = file.components.first() else { return false };
        // Of the product as it is, drops stay as they were followed.
        let anew;
        let field = match self.lever {
            Lever::InertiaRatio | Lever::Restitution => {
                anew = Field::new(&file.product, &file.drop, &file.components, self.field.accuracy);
                &anew
            }
            Lever::Position | Lever::Frequency | Lever::Damping => self.field,
        };
        if breakers.iter().rev().any(|breaker| breaks(field, component, breaker)) {
            return false;
        }
        let found = file.assess_in(field).ok().and_then(|assessment| assessment.components.into_iter().next());
        if let Some(found) = found.as_ref().filter(|found| found.verdict != Verdict::Safe) {
            remember(found, breakers, field, component);
        }
        found.is_some_and(|found| found.verdict == Verdict::Safe)
    }

    /// The present value, as the lever counts: a range by its low end, a frequency by the logarithm of its factor.
    fn here(&self) -> f64 {
        match self.lever {
            Lever::InertiaRatio => self.file.product.inertia_ratio(),
            Lever::Restitution => self.file.product.restitution.lo(),
            Lever::Position => self.component.position_m,
            Lever::Frequency => 0.0,
            Lever::Damping => match self.component.mount {
                Mount::Suspended { damping, .. } => damping.get(),
                Mount::Hard => 0.0,
            },
        }
    }

    /// The bounds, as the lever counts.
    fn reach(&self) -> [f64; 2] {
        match self.lever {
            Lever::InertiaRatio => self.bounds.q,
            // the range as a whole: until its high end is at the low bound, its low end at the high bound
            Lever::Restitution => {
                let wide = self.file.product.restitution.hi() - self.file.product.restitution.lo();
                [self.bounds.e[0] - wide, self.bounds.e[1]]
            }
            Lever::Position => {
                let most = 0.5 * (self.file.product.body.length_m() - self.component.extent_m).max(0.0);
                [-most, most]
            }
            Lever::Frequency => {
                let most = self.bounds.frequency_factor.ln();
                [-most, most]
            }
            Lever::Damping => self.bounds.damping,
        }
    }

    /// A bound as it is shown.
    fn shown(&self, x: f64) -> f64 {
        match self.lever {
            Lever::Restitution => x.clamp(self.bounds.e[0], self.bounds.e[1]),
            Lever::Frequency => self.value(x)[usize::from(x > 0.0)],
            _ => x,
        }
    }

    /// What a value of the lever means, low and high end.
    fn value(&self, x: f64) -> [f64; 2] {
        match (self.lever, &self.component.mount) {
            (Lever::Restitution, _) => {
                let range = &self.file.product.restitution;
                let here = range.lo();
                // what there is stays as it is, even beyond the bounds
                if (x - here).abs() <= 0.0 {
                    return [range.lo(), range.hi()];
                }
                [x, x + (range.hi() - here)].map(|e| e.clamp(self.bounds.e[0], self.bounds.e[1]))
            }
            (Lever::Frequency, Mount::Suspended { frequency_hz, .. }) => {
                [frequency_hz.lo(), frequency_hz.hi()].map(|f| f * x.exp())
            }
            _ => [x, x],
        }
    }

    /// The product with that value, and the part alone.
    fn changed(&self, x: f64) -> Option<ProductFile> {
        let mut component = self.component.clone();
        let mut product = self.file.product.clone();
        let [lo, hi] = self.value(x);
        let range = |lo, hi| Spread::new(lo, hi, if lo < hi { Law::Range } else { Law::Value }).ok();
        match (self.lever, &mut component.mount) {
            (Lever::InertiaRatio, _) => product = product.with_inertia_ratio(x).ok()?,
            (Lever::Restitution, _) => product.restitution = range(lo, hi)?,
            (Lever::Position, _) => component.position_m = x,
            (Lever::Frequency, Mount::Suspended { frequency_hz, .. }) => *frequency_hz = range(lo, hi)?,
            (Lever::Damping, Mount::Suspended { damping, .. }) => *damping = DampingRatio::new(x).ok()?,
            (Lever::Frequency | Lever::Damping, Mount::Hard) => return None,
        }
        Some(ProductFile { product, drop: self.file.drop, components: vec![component] })
    }
}

/// Keeps the drops that broke a part.
fn remember(found: &ComponentAssessment, breakers: &mut Vec<Breaker>, field: &Field<'_>, component: &Component) {
    let frequencies = match component.mount {
        Mount::Suspended { frequency_hz, .. } => Some(frequency_hz),
        Mount::Hard => None,
    };
    breakers.extend(found.limits.iter().filter(|limit| !limit.is_safe()).map(|limit| Breaker {
        place: field.place_of(&limit.worst_case, frequencies),
        proven: limit.guaranteed.then(|| search::pair_of(&limit.model)),
    }));
}

/// Whether a drop breaks a part.
fn breaks(field: &Field<'_>, component: &Component, breaker: &Breaker) -> bool {
    Demand::of(component).into_iter().any(|demand| {
        let places = component.ends_m().into_iter().map(|position_m| Place { position_m, ..breaker.place });
        let most = field.most(&Task { component, demand, proven: None }, breaker.proven, places, demand.allowed);
        most.is_ok_and(|most| {
            most.is_some_and(|most| {
                let settled = demand.settle(most.value, field.product.contact_time_s);
                settled.factor * most.value > settled.allowed
            })
        })
    })
}
