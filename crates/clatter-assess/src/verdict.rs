//! This module holds the result of an assessment.

use std::f64::consts::TAU;

use clatter::End;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use crate::Case;
use crate::Part;
use crate::reason::{Doubt, Note, Reason, as_sentence, as_text, as_texts, joined};
use clatter_product::{
    Axis, Component, Drop, DropName, DropRanges, INPUTS, Input, Landing, LimitKind, MERGE_S, Model, Optional, Product,
    ProductFile, Reliability, Row, Unit, optional_inputs,
};

/// The answer to the question whether every limit holds in the worst drop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// It does, with room for what the answer may be off by.
    Safe,
    /// No search decides it; of products that were drawn none exceeded it, and they are enough for a stated [`Reliability`].
    Reliable,
    /// The drops that were found do not decide it.
    Undecided,
    /// A drop of the ranges exceeds a limit.
    Unsafe,
}

impl Verdict {
    /// Returns the name: `safe`, `reliable`, `undecided` or `unsafe`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Safe => "safe",
            Self::Reliable => "reliable",
            Self::Undecided => "undecided",
            Self::Unsafe => "unsafe",
        }
    }
    /// Returns the verdict of several parts: the worst of unsafe, undecided, reliable and safe.
    pub(crate) fn of(all: impl IntoIterator<Item = Self>) -> Self {
        all.into_iter().max().unwrap_or(Self::Safe)
    }
}

/// The verdict on a product.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Assessment {
    /// Name of the product.
    pub product: String,
    /// The worst of the components: unsafe, undecided, reliable, safe.
    pub verdict: Verdict,
    /// Inputs that the file does not state.
    pub assumed: Vec<Assumed>,
    /// The components, in the order of the file.
    pub components: Vec<ComponentAssessment>,
    /// The results of each drop of a box; empty of a product that lands as its file says.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub landings: Vec<LandingAssessment>,
    /// The accuracy to which it was worked out.
    #[serde(skip)]
    pub accuracy: Accuracy,
}

impl Assessment {
    /// Checks that it has the components, limits and drops of this product.
    ///
    /// # Errors
    /// [`Error::OtherProduct`](clatter_product::Error::OtherProduct) with the first component that differs,
    /// [`Error::OtherDrops`](clatter_product::Error::OtherDrops).
    pub(crate) fn is_of(&self, file: &ProductFile) -> Result<(), clatter_product::Error> {
        let differs = |(component, assessed): (&Component, &ComponentAssessment)| {
            let limits = assessed.limits.iter().map(|limit| limit.limit);
            component.name != assessed.name || !component.limits.kinds().into_iter().eq(limits)
        };
        let known = file.components.len().min(self.components.len());
        let mut both = file.components.iter().zip(&self.components);
        let other = both.position(differs).or((file.components.len() != self.components.len()).then_some(known));
        let Some(k) = other else { return self.drops_are_of(file) };
        let assessed = self.components.get(k).map(|component| &component.name);
        let name = assessed.or(file.components.get(k).map(|component| &component.name));
        Err(clatter_product::Error::OtherProduct(name.cloned().unwrap_or_default()))
    }
    /// Checks that its worst drops are among those of this product.
    fn drops_are_of(&self, file: &ProductFile) -> Result<(), clatter_product::Error> {
        let (names, limits) = (file.drop_names(), self.components.iter().flat_map(|component| &component.limits));
        let mut worst = limits.filter_map(|limit| limit.worst_case.as_ref());
        let is_of =
            |worst: &WorstCase| worst.listed < names.len().max(1) && worst.landing == names.get(worst.listed).copied();
        if worst.all(is_of) { Ok(()) } else { Err(clatter_product::Error::OtherDrops) }
    }
}

/// An input that the file does not state, and what is taken for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Assumed {
    /// A product without a width is a bar.
    Bar,
    /// Contacts that take time follow one law or the other where none is named.
    EitherLaw,
    /// A box may slide on any usual floor.
    Friction,
    /// A thin box that lands on its broad face, with parts along its thickness, slides freely.
    NoFriction,
}

impl Assumed {
    pub(crate) fn of(file: &ProductFile, accuracy: &Accuracy) -> Vec<Self> {
        let Product { body, contact_time_s, contact_law, friction, is_friction_assumed, .. } = &file.product;
        let is_friction_assumed = *is_friction_assumed;
        let takes_time = contact_time_s.is_some() && accuracy.model.is_none_or(|model| model == Model::Compliant);
        let rows = [
            (!body.is_wide(), Self::Bar),
            (takes_time && contact_law.is_none(), Self::EitherLaw),
            (is_friction_assumed && friction.is_some(), Self::Friction),
            (is_friction_assumed && friction.is_none(), Self::NoFriction),
        ];
        rows.into_iter().filter_map(|(is, row)| is.then_some(row)).collect()
    }
    /// Returns the input, the value assumed for it, and the question that this leaves open.
    #[must_use]
    pub fn told(self) -> [&'static str; 3] {
        match self {
            // Plates of products that are given as bars had a demand 18 to 30 % larger.
            Self::Bar => ["body", "bar", "if it is wider than a quarter of its length, give `width`: up to 30 % more"],
            Self::EitherLaw => ["law", "hysteretic or dashpot", "a limit is safe where it holds by both"],
            Self::Friction => [
                "friction",
                "0 to 0.6",
                "that of plastics, glass and steel on wood and concrete; give `friction` for another",
            ],
            Self::NoFriction => {
                let why = "along the thickness of a thin product near level it changes the demand by -11 to +2 %; `friction` follows it";
                ["friction", "none", why]
            }
        }
    }
}

impl Serialize for Assumed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Row {
            input: &'static str,
            taken: &'static str,
            why: &'static str,
        }
        let [input, taken, why] = self.told();
        Row { input, taken, why }.serialize(serializer)
    }
}

/// The result of one of several drops for every limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LandingAssessment {
    /// The name of the drop.
    pub landing: DropName,
    /// The standard that demands it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<&'static str>,
    /// The angle by which a box may be turned off its attitude.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance_deg: Option<f64>,
    /// The range of the tilt of a bar or of a plate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tilt_deg: Option<[f64; 2]>,
    /// The range of speeds at the first touch.
    pub speed_m_s: [f64; 2],
    /// The ranges of inputs there that a file may leave out, where it does not.
    #[serde(flatten, serialize_with = "by_column")]
    pub optional: Vec<(Input, [f64; 2])>,
    /// The worst of the limits: unsafe, undecided, reliable, safe.
    pub verdict: Verdict,
    /// One for each limit of each component, in the order of the file.
    pub limits: Vec<LandingLimit>,
}

/// The result of one of several drops for one limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LandingLimit {
    /// Name of the component.
    pub component: String,
    /// The kind of the limit.
    pub limit: LimitKind,
    /// The demand, as of [`LimitAssessment`].
    pub demand: Option<f64>,
    /// The margin, as of [`LimitAssessment`].
    #[serde(serialize_with = "number_or_null")]
    pub margin: Option<f64>,
    /// The verdict on the limit in this drop.
    pub verdict: Verdict,
}

impl LandingAssessment {
    pub(crate) fn new(name: DropName, landing: &Landing, product: &Product) -> Self {
        let DropRanges { tilt_rad, .. } = &landing.drop;
        let tilt_deg = [tilt_rad.lo(), tilt_rad.hi()].map(f64::to_degrees);
        let is_of_box = landing.attitude.is_some();
        let there = optional_inputs().map(|(row, _)| row.input).filter(|input| input.is_there(product, &landing.drop));
        let optional = there.filter_map(|input| Some((input, input.range(product, &landing.drop)?))).collect();
        Self {
            landing: name,
            source: landing.source,
            tolerance_deg: is_of_box.then_some(tilt_deg[1]),
            tilt_deg: (!is_of_box).then_some(tilt_deg),
            speed_m_s: landing.drop.speeds_m_s(),
            optional,
            verdict: Verdict::Safe,
            limits: Vec::new(),
        }
    }
    pub(crate) fn take(&mut self, component: &Component, limit: &LimitAssessment) {
        let LimitAssessment { limit, demand, margin, verdict, .. } = *limit;
        self.verdict = self.verdict.max(verdict);
        self.limits.push(LandingLimit { component: component.name.clone(), limit, demand, margin, verdict });
    }
    /// Returns the limit with the smallest margin; none of an assessment of no component.
    #[must_use]
    pub fn tightest(&self) -> Option<&LandingLimit> {
        let room = |limit: &LandingLimit| limit.margin.unwrap_or(f64::INFINITY);
        self.limits.iter().min_by(|a, b| room(a).total_cmp(&room(b)))
    }
}

/// The accuracy to which an assessment is worked out, and its model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// The tolerance of the answer to each drop for its model, as a share of it; in [1e-4, 0.5].
    pub tolerance: f64,
    /// The model by which drops are followed; that with the most physics that the data allow if none is named.
    pub model: Option<Model>,
    /// Instant impacts that are closer than this are one: where the ranges hold a tilt whose gap is shorter, the flat drop is one of
    /// the drops. Of a product whose contact time is known the contacts decide that.
    pub merge_s: f64,
}

impl Default for Accuracy {
    /// Returns 1 %, by the model with the most physics, 1 ms.
    fn default() -> Self {
        Self { tolerance: 0.01, model: None, merge_s: MERGE_S }
    }
}

impl Accuracy {
    /// Checks that the tolerance and the time within which impacts are one are in range.
    ///
    /// # Errors
    /// [`Error::Tolerance`](clatter_product::Error::Tolerance) outside [1e-4, 0.5], [`Error::Merge`](clatter_product::Error::Merge) unless finite and not
    /// negative.
    ///
    /// ```
    /// use clatter_assess::Accuracy;
    /// assert!(Accuracy::default().check().is_ok());
    /// assert!(Accuracy { tolerance: 0.0, ..Accuracy::default() }.check().is_err());
    /// ```
    pub fn check(&self) -> Result<(), clatter_product::Error> {
        if !(1e-4..=0.5).contains(&self.tolerance) {
            return Err(clatter_product::Error::Tolerance(self.tolerance));
        }
        merge(self.merge_s)
    }
}

/// Checks that this is a valid time within which impacts count as one, in seconds.
pub(crate) fn merge(time_s: f64) -> Result<(), clatter_product::Error> {
    if time_s >= 0.0 && time_s.is_finite() { Ok(()) } else { Err(clatter_product::Error::Merge(time_s)) }
}

/// The verdict on one component.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComponentAssessment {
    /// Its name.
    pub name: String,
    /// The place of its middle, from the middle of the product towards end b; of a range, its middle.
    pub position_m: Sides,
    /// The verdict of its limits together.
    pub verdict: Verdict,
    /// The reliability where that is `reliable`.
    #[serde(flatten)]
    pub reliability: Option<Reliability>,
    /// One for each limit of the file.
    pub limits: Vec<LimitAssessment>,
    /// The drop behind the smallest margin; null where no drop was answered.
    pub worst_case: Option<WorstCase>,
    /// The model by which that drop was followed, and the reason.
    pub model: ModelChoice,
}

impl ComponentAssessment {
    /// Returns the limit with the smallest margin.
    ///
    /// # Panics
    /// Without limits, which no assessment leaves out.
    #[must_use]
    pub fn tightest(&self) -> &LimitAssessment {
        let tightest = self.limits.iter().min_by(|a, b| a.room().total_cmp(&b.room()));
        tightest.unwrap_or_else(|| unreachable!("a component has a limit"))
    }
}

impl LimitAssessment {
    /// Returns how sure the limit holds where products were drawn for that: "R99 C95, 299 products, none exceeded it".
    #[must_use]
    pub fn why_reliable(&self) -> Option<String> {
        self.reliability.map(|by| format!("{by}, {} products, none exceeded it", by.samples()))
    }
    /// Returns why the limit is undecided, in a sentence, and by which drop where that is not the one with the largest demand.
    #[must_use]
    pub fn why_undecided(&self) -> Option<String> {
        let by = self.governs.map_or_else(String::new, |other| format!("by {other}, "));
        joined(&self.undecided).map(|why| by + &why)
    }
    /// Returns the margin to order limits by: infinite where no drop was answered.
    #[must_use]
    pub fn room(&self) -> f64 {
        self.margin.unwrap_or(f64::INFINITY)
    }
}

/// One limit and its demand.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimitAssessment {
    /// The kind of the limit.
    pub limit: LimitKind,
    /// Unit of `allowed`, `demand`, `bound`, `clatter_free` and `other_law`; of a damage boundary that of the one that leaves more room.
    pub unit: Unit,
    /// The allowed value, from the file.
    pub allowed: f64,
    /// The demand of the worst drop that was found: it is `worst_case`, and can be repeated. Null where no drop was answered.
    pub demand: Option<f64>,
    /// allowed/demand − 1.
    #[serde(serialize_with = "number_or_null")]
    pub margin: Option<f64>,
    /// The verdict on the limit.
    pub verdict: Verdict,
    /// The reliability where that is `reliable`.
    #[serde(flatten)]
    pub reliability: Option<Reliability>,
    /// The bound that no drop of the ranges exceeds, by the energy that the body has; null for the response of a suspended part.
    pub bound: Option<f64>,
    /// The largest excess of drops of the ranges over the demand, as a share of it: what the answer may be off by and what
    /// the search may miss.
    #[serde(serialize_with = "number")]
    pub uncertainty: f64,
    /// The demand of the worst drop if it landed flat: with both ends at once, and contacts where their time is known.
    pub clatter_free: Option<f64>,
    /// The demand of the worst drop over the ranges by the other contact law, where contacts take time; else null. Where the file names its
    /// law, the other one is not searched: that of the same worst drop by it.
    pub other_law: Option<f64>,
    /// The drop that does it; null where no drop was answered.
    pub worst_case: Option<WorstCase>,
    /// Of a rattle space that is exceeded, where the file says nothing of the stop: how the part reaches it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_stop: Option<AtStop>,
    /// The drop that decides the verdict, where several are listed and it is another than the one with the largest demand.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub governs: Option<DropName>,
    /// The model by which it was followed, and the reason.
    pub model: ModelChoice,
    /// The reasons why the limit is undecided; else empty.
    #[serde(serialize_with = "as_sentence")]
    pub undecided: Vec<Doubt>,
    /// The command or the change that would decide the limit, in words; none where it is decided or nothing is known to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decided_by: Option<String>,
    /// Further facts to be known, each with its size; may be empty.
    #[serde(serialize_with = "as_texts")]
    pub notes: Vec<Note>,
}

/// How a part reaches its stop, of which nothing is known: at most in 256 drops that spread evenly over the ranges.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AtStop {
    /// The speed at which it arrives for the first time in a drop, relative to the product.
    pub largest_hit_m_s: f64,
    /// The acceleration that stops with contacts of 1 ms and of 0.2 ms then give it, with a restitution of 0.5.
    pub asks_m_s2: [f64; 2],
}

/// A drop, and where in the component and when it does the worst.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorstCase {
    /// The drop.
    pub drop: Drop,
    /// The place in the component, and the suspension that it has in this drop; none where it does not matter.
    pub part: Part,
    /// The name of the drop in the file, where the file lists several.
    pub landing: Option<DropName>,
    /// Its place in that list, from 0.
    pub listed: usize,
    /// True where it is of a product that was drawn: a search does not find it again.
    pub drawn: bool,
    /// True where the file gives a range of radii of gyration, of which this drop has one.
    pub gyration_varies: bool,
    /// The impact that does it, or that the peak follows; from 1.
    pub impact: u64,
    /// The time since the first touch.
    pub time_s: f64,
    /// The model that answers the drop.
    pub model: Model,
    /// The tolerance of that answer.
    pub tolerance: f64,
}

impl WorstCase {
    /// Returns the angle to the ground at the first touch.
    #[must_use]
    pub fn tilt_deg(&self) -> f64 {
        self.drop.tilt_rad.to_degrees()
    }
    /// Returns the direction to which a plate rises from its lowest corner, in [0, 360): 0 along the length, towards end b, 90 along the
    /// width; none of a bar.
    #[must_use]
    pub fn direction_deg(&self) -> Option<f64> {
        self.drop.body.is_wide().then(|| self.drop.direction_rad.to_degrees().rem_euclid(360.0))
    }
    /// Inputs that a file may leave out, with their values where they count.
    pub fn optional(&self) -> impl Iterator<Item = (&'static Row, Optional, f64)> + '_ {
        let value = |(row, optional): (&'static Row, Optional)| Some((row, optional, row.input.value(&self.drop)?));
        optional_inputs().filter_map(value).filter(|(_, optional, value)| !optional.is_left_out(*value))
    }
    /// Returns along which axis of a box the part is shaken; none of a bar and of a plate.
    #[must_use]
    pub fn axis(&self) -> Option<Axis> {
        self.drop.is_solid().then_some(self.part.place.axis)
    }
    /// Radius of gyration; none where the file gives one value.
    #[must_use]
    pub fn gyration_m(&self) -> Option<f64> {
        self.gyration_varies.then(|| self.drop.body.gyration_m())
    }
    /// Returns the natural frequency of the part; none for a hard-mounted one and where it does not matter.
    #[must_use]
    pub fn frequency_hz(&self) -> Option<f64> {
        self.part.suspension.map(|part| part.omega() / TAU)
    }
    /// Its damping ratio, likewise.
    #[must_use]
    pub fn damping_ratio(&self) -> Option<f64> {
        self.part.suspension.map(|part| part.damping().get())
    }
}

impl Serialize for WorstCase {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let drop = &self.drop;
        let mut map = serializer.serialize_map(None)?;
        if let Some(landing) = self.landing {
            map.serialize_entry("landing", &landing)?;
        }
        if self.drawn {
            map.serialize_entry("drawn", &true)?;
        }
        map.serialize_entry("flat", &drop.is_flat)?;
        for row in INPUTS.iter().filter(|row| row.input.told() == row.input) {
            let title = row.input.title();
            match (row.input, row.input.value(drop)) {
                (Input::First, _) => map.serialize_entry(&title, if drop.first() == End::A { "a" } else { "b" })?,
                (Input::Direction, _) => self.direction_deg().map_or(Ok(()), |at| map.serialize_entry(&title, &at))?,
                (Input::Gyration, _) => map.serialize_entry(&title, &self.gyration_m())?,
                (_, Some(value)) if row.optional.is_some_and(|optional| optional.is_left_out(value)) => {}
                (input, Some(value)) if input.is_angle() => map.serialize_entry(&title, &value.to_degrees())?,
                (_, value) => map.serialize_entry(&title, &value)?,
            }
        }
        let contacts = ContactRow::of(drop);
        if !contacts.is_empty() {
            map.serialize_entry("contacts", &contacts)?;
        }
        map.serialize_entry("frequency_hz", &self.frequency_hz())?;
        map.serialize_entry("damping_ratio", &self.damping_ratio())?;
        map.serialize_entry("position_m", &Sides::of(&self.part, drop))?;
        if let Some(axis) = self.axis() {
            map.serialize_entry("axis", &axis)?;
        }
        map.serialize_entry("impact", &self.impact)?;
        map.serialize_entry("time_s", &self.time_s)?;
        map.serialize_entry("drop", &Case::of(self))?;
        map.serialize_entry("command", &self.command())?;
        map.end()
    }
}

/// Writes ranges of inputs by their columns.
fn by_column<S: Serializer>(inputs: &[(Input, [f64; 2])], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(inputs.iter().map(|(input, range)| (input.row().column, range)))
}

/// A contact of its own as the drop has it.
#[derive(Serialize)]
struct ContactRow {
    at: &'static str,
    restitution: f64,
    contact_time_s: Option<f64>,
}

impl ContactRow {
    fn of(drop: &Drop) -> Vec<Self> {
        let row = |(at, restitution, contact_time_s)| Self { at, restitution, contact_time_s };
        drop.own_contacts.told(drop.restitution, drop.contact_time_s).map(row).collect()
    }
}

/// A place: along a bar, or along and across a plate, whose program-readable form is a list of both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Sides {
    /// Along a bar, in m from its middle towards end b.
    Along(f64),
    /// Along and across a plate.
    Both([f64; 2]),
    /// Along, across and in the thickness of a box.
    All([f64; 3]),
}

impl Sides {
    pub(crate) fn new([along, across]: [f64; 2], is_plate: bool) -> Self {
        if is_plate { Self::Both([along, across]) } else { Self::Along(along) }
    }
    fn of(part: &Part, drop: &Drop) -> Self {
        if drop.is_solid() { Self::All(part.place.at_m) } else { Self::new(part.at_m(), drop.body.is_wide()) }
    }
    /// Returns the place along and across; 0 across a bar.
    #[must_use]
    pub fn m(&self) -> [f64; 2] {
        match *self {
            Self::Along(x) => [x, 0.0],
            Self::Both(at) => at,
            Self::All([x, y, _]) => [x, y],
        }
    }
}

/// The model behind a demand.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelChoice {
    /// The model of the motion of the product.
    pub bar: Model,
    /// The loading of the component: `largest-shock` (the product's own shocks), `impulse-train`, `pulse-train`, or `base` (the pulses of
    /// the product at a hard-mounted part).
    pub component: &'static str,
    /// The reason for these models.
    #[serde(serialize_with = "as_text")]
    pub reason: Reason,
}

/// Infinity is a string: JSON has no number for it.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature serde asks for")]
pub(crate) fn number<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if value.is_infinite() { serializer.serialize_str("infinite") } else { serializer.serialize_f64(*value) }
}

#[expect(clippy::ref_option, reason = "the signature serde asks for")]
pub(crate) fn number_or_null<S: Serializer>(value: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    match value {
        Some(value) => number(value, serializer),
        None => serializer.serialize_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_product::EXAMPLE;

    /// A landing takes the worst verdict of its limits, whichever limit comes last.
    #[test]
    fn a_landing_is_as_its_worst_limit() {
        let file = ProductFile::read(EXAMPLE, "example.toml").unwrap();
        let mut limit = crate::assess(&file).unwrap().components[0].limits[0].clone();
        let mut landing = LandingAssessment::new(DropName::Number(1), &Landing::tilted(file.drop), &file.product);
        for (own, all) in [
            (Verdict::Safe, Verdict::Safe),
            (Verdict::Unsafe, Verdict::Unsafe),
            (Verdict::Undecided, Verdict::Unsafe),
            (Verdict::Safe, Verdict::Unsafe),
        ] {
            limit.verdict = own;
            landing.take(&file.components[0], &limit);
            assert_eq!(landing.verdict, all);
        }
    }
}
