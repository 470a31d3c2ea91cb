//! From a product to its verdict.

use std::f64::consts::TAU;

use clatter::End;

use crate::bound::bound;
use crate::drop::{Model, SingleDrop};
use crate::engine::{Part, answer};
use crate::quantity::lacks_contact_time;
use crate::search::{Asked, Ranges, Task, Watch, Worst};
use crate::{
    Accuracy, Assessment, Component, ComponentAssessment, ContactLaw, Error, Limit, LimitAssessment, LimitKind,
    ModelChoice, Mount, ProductFile, Unit, Verdict, WorstCase,
};

/// What the search may miss of a worst case, as a share of it: tests hold single drops of the same ranges to this.
pub(crate) const COVERAGE: f64 = 0.02;
/// From this phase ωτ on a part feels the shape of a pulse.
const FEELS_SHAPE: f64 = 1.0;

impl ProductFile {
    /// The worst drop of every component over all stated ranges, and whether it stands it: [`assess_to`](Self::assess_to) 1 %.
    ///
    /// # Errors
    /// As [`assess_to`](Self::assess_to).
    ///
    /// # Examples
    /// ```
    /// use clatter_assess::{EXAMPLE, ProductFile};
    /// let assessment = ProductFile::read(EXAMPLE, "example.toml")?.assess()?;
    /// for limit in assessment.components.iter().flat_map(|c| &c.limits) {
    ///     assert!(limit.bound.is_none_or(|bound| limit.demand <= bound));
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn assess(&self) -> Result<Assessment, Error> {
        self.assess_to(&Accuracy::default())
    }

    /// The same to a tolerance, or by a named model.
    ///
    /// # Method
    /// Drops of the ranges are followed by the model with the most physics that the data allow: contacts that take time where
    /// their time is known, else instant impacts at real tilt with gravity. The worst one is searched as the module of
    /// the search says.
    ///
    /// A limit is *unsafe* where a drop was found that exceeds it. It is *safe* where the energy of the drops allows no more than
    /// it, or where every drop of the search was answered and the worst leaves room for what its answer may be off by, for what
    /// the search may miss, 2 %, and for what rebounds may ask by their energy. Else it is *undecided*, and the reason is told.
    /// The acceleration of a part that exceeds its rattle space is undecided: it hits its stop.
    ///
    /// # Errors
    /// [`Error::Tolerance`] for a tolerance outside [1e-4, 0.5]; [`Error::ContactTime`] for a stiff or hard-mounted
    /// part of a product without contact time, [`Error::Contact`] for the compliant model of one.
    pub fn assess_to(&self, accuracy: &Accuracy) -> Result<Assessment, Error> {
        self.assess_watched(accuracy, &|_, _| true)
    }

    /// The same, watched. Where `watch` says to stop, no more drops are followed: what was found by then is answered, unsafe
    /// limits as ever, and the others are undecided unless energy alone says that they are safe.
    ///
    /// # Errors
    /// As [`assess_to`](Self::assess_to).
    pub fn assess_watched(&self, accuracy: &Accuracy, watch: Watch<'_>) -> Result<Assessment, Error> {
        accuracy.check()?;
        if accuracy.model == Some(Model::Compliant) && self.product.contact_time_s.is_none() {
            return Err(Error::Contact);
        }
        for component in &self.components {
            if let Some(reason) = lacks_contact_time(&self.product, component) {
                return Err(Error::ContactTime { component: component.name.clone(), reason });
            }
        }
        let ranges = self.ranges(accuracy);
        let of_one = |component| Limit::of(component).into_iter().map(move |limit| Task { component, limit });
        let tasks: Vec<Task<'_>> = self.components.iter().flat_map(of_one).collect();
        let worst = ranges.worst(&tasks, watch);
        let mut all = tasks.iter().zip(worst);
        let mut components = Vec::with_capacity(self.components.len());
        for component in &self.components {
            let count = component.limits.kinds().len();
            let limits: Result<Vec<_>, Error> =
                all.by_ref().take(count).map(|(task, worst)| self.limit(&ranges, task, &worst)).collect();
            components.push(verdict(component, limits?));
        }
        let verdict = Verdict::of(components.iter().map(|c| c.verdict));
        Ok(Assessment { product: self.product.name.clone(), verdict, components, accuracy: *accuracy })
    }

    /// The ranges as the search takes them.
    pub(crate) fn ranges(&self, accuracy: &Accuracy) -> Ranges<'_> {
        let fullest = if self.product.contact_time_s.is_some() { Model::Compliant } else { Model::FiniteTilt };
        let model = accuracy.model.unwrap_or(fullest);
        Ranges { product: &self.product, drop: &self.drop, model, tolerance: accuracy.tolerance }
    }

    fn limit(&self, ranges: &Ranges<'_>, task: &Task<'_>, worst: &Worst) -> Result<LimitAssessment, Error> {
        let bound = bound(&self.product, &self.drop, task.component, &task.limit);
        let Some(asked) = &worst.asked else { return Ok(unanswered(ranges, task, worst, bound)) };
        let drop = ranges.single(&asked.place);
        let Asked { answer: found, .. } = asked;
        let mut doubts = Vec::new();
        let mut notes = Vec::new();
        let part = asked.part;
        let place = Part { position_m: asked.place.position_m, suspension: part };
        let mut uncertainty = found.error.max(0.0) + COVERAGE;
        if found.error.is_infinite() {
            notes.push("how far off it is is not known: drops next to the worst are not answered".to_owned());
        } else if found.error > 10.0 * ranges.tolerance {
            let off = percent(found.error);
            notes
                .push(format!("it may be off by {off} %: later strikes add, and multiply what those before got wrong"));
        }
        if worst.later > found.utilization() * (1.0 + uncertainty) {
            uncertainty = worst.later / found.utilization() - 1.0;
            let most = if uncertainty.is_finite() {
                format!("by {} % at most", percent(uncertainty))
            } else {
                "how much more is not known".to_owned()
            };
            notes.push(format!(
                "rebounds may ask for more, {most} by their energy: how the product lands again is sensitive to every input"
            ));
        }
        if ranges.model < drop.fullest() {
            let full = answer(&drop, &place, &task.limit, drop.fullest(), ranges.tolerance)?;
            let off = full.utilization() / found.utilization() - 1.0;
            uncertainty += off.max(0.0);
            notes.push(format!(
                "{} was asked for; {} says {:+} % in this drop",
                ranges.model.name(),
                drop.fullest().name(),
                tenth(100.0 * off)
            ));
        }
        if let Some((count, error)) = &worst.refused {
            doubts.push(format!("{count} of {} drops that were tried are not answered: {error}", worst.drops));
        }
        if worst.stopped {
            doubts.push(format!("{} its end", Error::Stopped));
        }
        let utilization = found.utilization();
        let safe_by_energy = bound.is_some_and(|bound| bound <= task.limit.allowed);
        if utilization <= 1.0 && uncertainty.is_infinite() {
            doubts.push("how far other drops may exceed the worst one found is not known".to_owned());
        } else if utilization <= 1.0 && utilization * (1.0 + uncertainty) > 1.0 {
            doubts.push(format!(
                "the worst drop found is {} % below the limit, and others may exceed it by up to {} %",
                percent(1.0 / utilization - 1.0),
                percent(uncertainty)
            ));
        }
        let verdict = if utilization > 1.0 {
            Verdict::Unsafe
        } else if safe_by_energy || doubts.is_empty() {
            Verdict::Safe
        } else {
            Verdict::Undecided
        };
        let delta_v = (1.0 + drop.restitution) * drop.speed_m_s;
        let clatter_free =
            in_unit(&task.limit, found.unit).clatter_free(delta_v, drop.contact_time_s, part.as_ref())?;
        let other_law = other_law(ranges, &task.limit, found.unit, &drop, &place);
        Ok(LimitAssessment {
            limit: task.limit.kind,
            unit: found.unit,
            allowed: found.allowed,
            demand: found.value,
            margin: found.allowed / found.value - 1.0,
            verdict,
            bound: bound.filter(|_| found.unit == task.limit.kind.unit()),
            uncertainty,
            clatter_free,
            other_law,
            worst_case: worst_case(&drop, asked, ranges),
            model: model(ranges, task, accuracy_reason(ranges, &drop)),
            undecided: (verdict == Verdict::Undecided).then(|| doubts.join("; ")),
            notes,
        })
    }
}

/// A limit of which no drop was answered.
fn unanswered(ranges: &Ranges<'_>, task: &Task<'_>, worst: &Worst, bound: Option<f64>) -> LimitAssessment {
    let free = bound.is_some_and(|bound| bound <= task.limit.allowed);
    let why = match &worst.refused {
        Some((_, error)) => error.to_string(),
        None if worst.stopped => format!("{} its end", Error::Stopped),
        None => Error::Unfinished.to_string(),
    };
    let place = ranges.middle(task.component);
    let drop = ranges.single(&place);
    LimitAssessment {
        limit: task.limit.kind,
        unit: task.limit.kind.unit(),
        allowed: task.limit.allowed,
        demand: 0.0,
        margin: f64::INFINITY,
        verdict: if free { Verdict::Safe } else { Verdict::Undecided },
        bound,
        uncertainty: f64::INFINITY,
        clatter_free: 0.0,
        other_law: None,
        worst_case: WorstCase {
            first: drop.first,
            tilt_deg: drop.tilt_rad.to_degrees(),
            speed_m_s: drop.speed_m_s,
            restitution: drop.restitution,
            contact_time_s: drop.contact_time_s,
            frequency_hz: None,
            damping_ratio: None,
            position_m: task.component.ends_m()[0],
            impact: 1,
            time_s: 0.0,
            command: String::new(),
        },
        model: model(ranges, task, accuracy_reason(ranges, &drop)),
        undecided: (!free).then(|| format!("no drop of the ranges is answered: {why}")),
        notes: Vec::new(),
    }
}

/// What the worst drop asks by the other contact law, in the unit of the demand: of a place, and of a part that feels the shape of
/// a pulse.
fn other_law(ranges: &Ranges<'_>, limit: &Limit, unit: Unit, drop: &SingleDrop, place: &Part) -> Option<f64> {
    let time = drop.contact_time_s.filter(|_| ranges.model == Model::Compliant)?;
    // A place feels how contacts overlap, which depends on the law.
    let feels = place.suspension.is_none_or(|part| part.omega() * time >= FEELS_SHAPE);
    let contact_law = match drop.contact_law {
        ContactLaw::Hysteretic => ContactLaw::Dashpot,
        ContactLaw::Dashpot => ContactLaw::Hysteretic,
    };
    let other = SingleDrop { contact_law, ..*drop };
    let ask = |limit: &Limit| answer(&other, place, limit, Model::Compliant, ranges.tolerance).ok();
    let asked = feels.then(|| ask(limit))??;
    let asked = if asked.unit == unit { asked } else { ask(&in_unit(limit, unit))? };
    Some(asked.value)
}

/// The limit whose demand has this unit: of a damage boundary the velocity change or the acceleration.
fn in_unit(limit: &Limit, unit: Unit) -> Limit {
    match (limit.kind, unit) {
        (LimitKind::DamageBoundary, Unit::MeterPerSecondSquared) => {
            Limit::new(LimitKind::Acceleration, limit.critical_acceleration_m_s2)
        }
        (LimitKind::DamageBoundary, _) => Limit::new(LimitKind::VelocityChange, limit.allowed),
        _ => *limit,
    }
}

/// A share of a hundred to one decimal, for messages.
fn percent(share: f64) -> f64 {
    tenth(100.0 * share)
}

fn tenth(x: f64) -> f64 {
    (10.0 * x).round() / 10.0
}

fn accuracy_reason(ranges: &Ranges<'_>, drop: &SingleDrop) -> String {
    match (ranges.model, drop.fullest()) {
        (Model::Compliant, _) => "contacts that take time: how long is known".to_owned(),
        (model, fullest) if model < fullest => format!("{} was asked for", model.name()),
        _ => "instant impacts at real tilt, with gravity: the contact time is not known".to_owned(),
    }
}

fn model(ranges: &Ranges<'_>, task: &Task<'_>, reason: String) -> ModelChoice {
    let contacts = ranges.model == Model::Compliant;
    let component = match (task.limit.is_response(), task.component.mount) {
        (false, _) => "largest-shock",
        (true, Mount::Hard) => "base",
        (true, _) if contacts => "pulse-train",
        (true, _) => "impulse-train",
    };
    ModelChoice { bar: ranges.model, component, reason }
}

fn worst_case(drop: &SingleDrop, asked: &Asked, ranges: &Ranges<'_>) -> WorstCase {
    WorstCase {
        first: drop.first,
        tilt_deg: drop.tilt_rad.to_degrees(),
        speed_m_s: drop.speed_m_s,
        restitution: drop.restitution,
        contact_time_s: drop.contact_time_s,
        frequency_hz: asked.part.map(|part| part.omega() / TAU),
        damping_ratio: asked.part.map(|part| part.damping().get()),
        position_m: asked.place.position_m,
        impact: asked.answer.impact,
        time_s: asked.answer.time_s,
        command: command(drop, asked, ranges),
    }
}

/// The command that answers a drop once more.
fn command(drop: &SingleDrop, asked: &Asked, ranges: &Ranges<'_>) -> String {
    let [a, b] = drop.body.arms_m();
    let side = if drop.first == End::A { 1.0 } else { -1.0 };
    let length = a + b;
    let mut command = format!("clatter respond --model={} --length-m={length:?}", ranges.model.name());
    let mut add = |flag: &str, value: f64| command.extend([" --", flag, "=", &format!("{value:?}")]);
    add("gyration-m", drop.body.gyration_m());
    let center = side * (a - b) / length;
    if center != 0.0 {
        add("center-of-mass", center);
    }
    add("e", drop.restitution);
    add("speed-m-s", drop.speed_m_s);
    add("tilt-deg", drop.tilt_rad.to_degrees());
    add("gravity-m-s2", drop.gravity_m_s2);
    add("at", drop.relative(asked.place.position_m) + 0.0);
    if let Some((hz, ratio)) = asked.part.map(|part| (part.omega() / TAU, part.damping().get())) {
        add("omega", TAU * hz);
        add("damping", ratio);
    }
    add("tolerance", ranges.tolerance);
    let contacts = ranges.model == Model::Compliant;
    // The acceleration of a part that is mounted rigidly is that of the contact time, by any model.
    if let Some(time) = drop.contact_time_s.filter(|_| contacts || asked.part.is_none()) {
        add("contact-time-s", time);
        if contacts && drop.contact_law == ContactLaw::Dashpot {
            command.push_str(" --contact-law=dashpot");
        }
    }
    command
}

fn verdict(component: &Component, mut limits: Vec<LimitAssessment>) -> ComponentAssessment {
    // A part that exceeds its rattle space hits its stop, whatever the linear suspension says of its acceleration.
    let stop = limits.iter().find(|l| l.limit == LimitKind::RattleSpace && l.verdict != Verdict::Safe);
    if let Some(stop) = stop.map(|l| (l.verdict, l.margin)) {
        for limit in limits.iter_mut().filter(|l| l.limit == LimitKind::Acceleration) {
            let (hits, more) = if stop.0 == Verdict::Unsafe { ("hits", "exceeds") } else { ("may hit", "may exceed") };
            let margin = if stop.1.is_finite() { format!(" (margin {:+} %)", percent(stop.1)) } else { String::new() };
            limit.verdict = Verdict::Undecided;
            limit.undecided = Some(format!(
                "the part {hits} its stop: its displacement {more} the rattle space{margin}, and what the stop does is not known; \
                 more room or a stiffer mount decides it"
            ));
        }
    }
    let tightest = limits.iter().min_by(|a, b| a.margin.total_cmp(&b.margin));
    let Some(tightest) = tightest else { unreachable!("a component has a limit") };
    let (worst_case, model) = (tightest.worst_case.clone(), tightest.model.clone());
    ComponentAssessment {
        name: component.name.clone(),
        position_m: component.position_m.at(0.5),
        verdict: Verdict::of(limits.iter().map(|l| l.verdict)),
        limits,
        worst_case,
        model,
    }
}
