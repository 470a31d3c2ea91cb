//! What an assessment says.

use clatter::End;
use serde::{Serialize, Serializer};

use crate::Accuracy;

/// Whether every limit holds in the worst case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// It does.
    Safe,
    /// It does not.
    Unsafe,
}

impl Verdict {
    pub(crate) fn of(safe: bool) -> Self {
        if safe { Self::Safe } else { Self::Unsafe }
    }
}

/// The verdict on a product.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Assessment {
    /// Name of the product.
    pub product: String,
    /// Safe where every component is.
    pub verdict: Verdict,
    /// In the order of the file.
    pub components: Vec<ComponentAssessment>,
    /// What it was worked out to.
    #[serde(skip)]
    pub accuracy: Accuracy,
}

/// The verdict on one component.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComponentAssessment {
    /// Its name.
    pub name: String,
    /// Where its middle is, from the middle of the product towards end b.
    pub position_m: f64,
    /// Safe where every limit holds.
    pub verdict: Verdict,
    /// One for each limit of the file.
    pub limits: Vec<LimitAssessment>,
    /// The drop behind the smallest margin.
    pub worst_case: WorstCase,
    /// The models behind the smallest margin, and why these.
    pub model: ModelChoice,
}

impl ComponentAssessment {
    /// The limit with the smallest margin.
    #[must_use]
    pub fn tightest(&self) -> &LimitAssessment {
        let tightest = self.limits.iter().min_by(|a, b| a.margin.total_cmp(&b.margin));
        tightest.unwrap_or_else(|| unreachable!("a component has a limit"))
    }
}

/// What is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LimitKind {
    /// Peak absolute acceleration of the part.
    Acceleration,
    /// Peak displacement relative to the bar.
    RattleSpace,
    /// Largest single velocity shock at the part.
    VelocityChange,
    /// Largest single change of angular velocity.
    AngularVelocityChange,
    /// Critical velocity change and acceleration: whichever leaves more room.
    DamageBoundary,
}

/// One limit and what is asked of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimitAssessment {
    /// Which one.
    pub limit: LimitKind,
    /// Unit of `allowed` and `demand`.
    pub unit: Unit,
    /// What the file allows.
    pub allowed: f64,
    /// What no drop of the stated ranges exceeds (where `guaranteed`), or the most that the search found.
    pub demand: f64,
    /// What the worst case reaches: at most `demand`.
    pub attained: f64,
    /// allowed/demand − 1.
    #[serde(serialize_with = "number")]
    pub margin: f64,
    /// What one clatter-free impact at the largest speed and restitution would ask, (1 + e) v0 at every place at once;
    /// with a contact time τ as a half-sine of that length. Over a range of frequencies f that is the largest of three:
    /// at both ends and where f·τ is nearest to 0.8, about the crest of the acceleration of an undamped part; for the
    /// acceleration of a damped part it is approximate.
    #[serde(serialize_with = "number")]
    pub clatter_free: f64,
    /// What no drop of the ranges exceeds without gravity, at small tilt and for instant impacts, whichever model the
    /// demand is of; null where that model says nothing of the limit.
    pub proven: Option<f64>,
    /// Whether bounds over the whole ranges prove the demand, in the model named.
    pub guaranteed: bool,
    /// Where `guaranteed`, `demand` is at most this share above `attained`; that gravity, real tilt and contact time
    /// ask for no more is known to the tolerance of the assessment ([`Accuracy`]), unless `warning` says otherwise. Of
    /// a search, no drop of the ranges asks for more than this share above `demand`, about: what its models may get
    /// wrong, and what the last refinement of the grid still gained.
    #[serde(serialize_with = "number")]
    pub tolerance: f64,
    /// The drop that does it.
    pub worst_case: WorstCase,
    /// The models, and why these.
    pub model: ModelChoice,
    /// Why the demand may not hold to that, or on which condition it does.
    pub warning: Option<String>,
}

impl LimitAssessment {
    /// Whether the limit holds.
    #[must_use]
    pub fn is_safe(&self) -> bool {
        self.demand <= self.allowed
    }
}

/// SI unit of a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Unit {
    /// m/s²
    #[serde(rename = "m/s2")]
    MeterPerSecondSquared,
    /// m
    #[serde(rename = "m")]
    Meter,
    /// m/s
    #[serde(rename = "m/s")]
    MeterPerSecond,
    /// rad/s
    #[serde(rename = "rad/s")]
    RadianPerSecond,
}

/// A drop, and where in the component and when it does the worst.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WorstCase {
    /// The end that touches first.
    #[serde(serialize_with = "letter")]
    pub first: End,
    /// Angle to the ground at the first touch.
    pub tilt_deg: f64,
    /// Speed at the first touch.
    pub speed_m_s: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Natural frequency of the part; null for a hard-mounted one and where it does not matter.
    pub frequency_hz: Option<f64>,
    /// Where in the part.
    pub position_m: f64,
    /// The impact that does it, or that the peak follows; from 1.
    pub impact: u64,
    /// When, since the first touch.
    pub time_s: f64,
}

/// The models behind a demand.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelChoice {
    /// How the bar moves.
    pub bar: BarModel,
    /// How the component answers.
    pub component: ComponentModel,
    /// Why these, in a sentence.
    pub reason: String,
}

/// How the bar moves: the ladder from the cheapest to the one with most physics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BarModel {
    /// Small tilt, no gravity.
    Map,
    /// With gravity.
    Ballistic,
    /// With gravity and exact geometry.
    FiniteTilt,
    /// With contact that takes time.
    Compliant,
}

/// How the component answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ComponentModel {
    /// None: what the bar does at its place, shock by shock.
    LargestShock,
    /// Exact response to velocity shocks.
    ImpulseTrain,
    /// Exact response to pulses of the contact time.
    PulseTrain,
    /// The pulses of the bar itself: a hard-mounted part.
    Base,
}

impl LimitKind {
    /// `acceleration`, `rattle-space`, …
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Acceleration => "acceleration",
            Self::RattleSpace => "rattle-space",
            Self::VelocityChange => "velocity-change",
            Self::AngularVelocityChange => "angular-velocity-change",
            Self::DamageBoundary => "damage-boundary",
        }
    }
    /// The unit of the limit; of a damage boundary that of its velocity change.
    #[must_use]
    pub fn unit(self) -> Unit {
        match self {
            Self::Acceleration => Unit::MeterPerSecondSquared,
            Self::RattleSpace => Unit::Meter,
            Self::VelocityChange | Self::DamageBoundary => Unit::MeterPerSecond,
            Self::AngularVelocityChange => Unit::RadianPerSecond,
        }
    }
}

impl Unit {
    /// `m/s2`, `m`, …
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::MeterPerSecondSquared => "m/s2",
            Self::Meter => "m",
            Self::MeterPerSecond => "m/s",
            Self::RadianPerSecond => "rad/s",
        }
    }
}

impl BarModel {
    /// As `clatter simulate --model` has it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::Ballistic => "ballistic",
            Self::FiniteTilt => "finite-tilt",
            Self::Compliant => "compliant",
        }
    }
}

impl ComponentModel {
    /// `largest-shock`, `impulse-train`, `pulse-train`, `base`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::LargestShock => "largest-shock",
            Self::ImpulseTrain => "impulse-train",
            Self::PulseTrain => "pulse-train",
            Self::Base => "base",
        }
    }
}

/// Infinity is a string: JSON has no number for it.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature serde asks for")]
pub(crate) fn number<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if value.is_infinite() { serializer.serialize_str("infinite") } else { serializer.serialize_f64(*value) }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature serde asks for")]
pub(crate) fn letter<S: Serializer>(end: &End, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(match end {
        End::A => "a",
        End::B => "b",
    })
}
