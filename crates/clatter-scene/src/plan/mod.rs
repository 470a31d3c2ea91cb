//! The cheapest models that are good enough for a scene, before anything is simulated.
//!
//! Two ladders: how the bar moves ([`BarRung`]) and how the component answers ([`ComponentRung`]). [`Setup::forecast`]
//! estimates what each rung gets wrong in the quantity asked, as a share of it; [`Forecast::plan`] takes the cheapest
//! [`Pair`] whose estimate is within a tolerance, and says which group of the scene decided. [`Setup::plan_from`] does
//! both from no more strikes than the choice needs, [`Setup::plan`] by a first look at two of them, in less than a
//! microsecond. [`Setup::demand`] runs a pair.
//!
//! # What the error is against
//! The compliant bar with the exact response to its pulses, from the first touch until rest and through the ring-down:
//! every force of the ground counts, the strikes of later rebounds too, and the weight that the ground carries in the
//! end. The component falls freely before: its spring is not loaded. A velocity shock is there the largest change of
//! velocity within one contact time, which is the jump of a strike where contacts do not overlap. Where
//! [`Scene::simulate_compliant`] refuses (ends that sink in by more than a tenth of the length over their speed, light
//! ends, e < 0.01) there is nothing to compare with, and the plan says so by a [`Warning`] where it needs that rung.
//!
//! # How
//! The first strikes, [`STRIKES`] at most ([`FIRST_STRIKES`] by a first look), are followed in four lanes: with
//! contacts that delay what they do by the centroid of their pulse (a lone contact moves the bar as one impulse at that
//! moment does, exactly), with real tilt, and, where that serves, as parabolas and as the map. What the lanes differ
//! by, each the delay, the lever arm or the parabola of one group, is carried as a perturbation of the component's
//! motion, turned and damped with it. Beside it stand
//!
//! - pulses in place of impulses: `½ σ² ω²` of a peak inside the swing (σ² the variance of the pulse), the slope over
//!   its mean age for a peak on the jump of the dashpot;
//! - overlapping contacts: what a kick through the bar does to a contact that has not done all it would, exactly for a
//!   linear one;
//! - an end that lies on the ground while the other lands: both contacts at once, whose motion hangs on inertia ratio
//!   and restitution alone, from a table that the model of contacts fills; against the closed form of all impacts of
//!   that instant;
//! - everything later: by energy, no end can be faster than E allows; where that cannot raise the response above the
//!   peak so far, the following stops, and [`Forecast::until_s`] says until when any model needs to be followed. Where
//!   strikes are in doubt, that bound takes their place.
//!
//! # Bounds and estimates
//! The last is a bound for velocity shocks. The rest is first order in the groups, with five fitted constants, for
//! contacts that part together, for ends that come up from below the ground, for those that lie down, for large tilt
//! and for later strikes: an estimate, held by a study of random scenes (`examples/plan_study.rs`).
//! [`Estimate::is_bound`] says which it is.
//!
//! ```
//! use clatter::flight::{Body, Scene};
//! use clatter_scene::plan::{BarRung, ComponentRung, Quantity, STRIKES, Setup};
//! use clatter_shock::{DampingRatio, Suspension};
//!
//! // A phone lands at 5° from 1 m; contacts take 0.1 ms; a part at 180 Hz, Q = 10, sits near its end.
//! let body = Body::new(0.14, 0.14 / 12.0_f64.sqrt())?;
//! let scene = Scene::from_height(body, 0.3, 1.0, 5.0, 9.81)?;
//! let part = Suspension::from_hz(180.0, DampingRatio::from_quality_factor(10.0)?)?;
//! let setup = Setup::new(scene, Some(1e-4), 0.9, part)?;
//! let plan = setup.plan_from(Quantity::PeakAcceleration, 0.01, STRIKES);
//! assert!(plan.estimate.error <= 0.01 && plan.warning.is_none());
//! let demand = setup.demand(plan.pair, Quantity::PeakAcceleration, plan.until_s)?;
//! let whole = setup.demand(clatter_scene::plan::Pair::HIGHEST, Quantity::PeakAcceleration, f64::INFINITY)?;
//! assert!((demand / whole - 1.0).abs() <= 0.01);
//! # Ok::<(), clatter_scene::Error>(())
//! ```
//!
//! [`Scene::simulate_compliant`]: clatter::flight::Scene::simulate_compliant

mod both;
mod bounds;
mod choice;
mod coarse;
mod coupling;
pub(crate) mod demand;
mod ends;
mod floats;
mod forecast;
pub(crate) mod history;
mod lag;
mod lane;
mod names;
pub(crate) mod pulse;
mod quick;
pub(crate) mod settle;
mod swing;
pub(crate) mod trail;
mod walk;
mod walked;

pub(crate) use choice::Share;
pub use choice::{Plan, Reason, Warning};
pub use demand::Answer;
pub use forecast::{DOUBT, FIRST_STRIKES, Forecast, Groups, STRIKES};

use clatter::flight::Scene;
use clatter_shock::Suspension;

use crate::Error;

/// What is asked of the component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Peak absolute acceleration.
    PeakAcceleration,
    /// Peak displacement relative to the bar.
    RattleSpace,
    /// Largest velocity shock of the bar at the component's place; the suspension does not matter.
    VelocityShock,
}

/// How the bar moves, from the cheapest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum BarRung {
    /// Small tilt, no gravity: sums and extremes at once.
    ClosedForm,
    /// The same, strike by strike.
    Map,
    /// With gravity, until rest.
    Ballistic,
    /// With exact geometry.
    FiniteTilt,
    /// With contact that takes time.
    Compliant,
}

/// How the component answers, from the cheapest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ComponentRung {
    /// To the sum of all shocks, as one.
    NetChange,
    /// To the largest shock alone.
    LargestShock,
    /// To every shock as an impulse.
    ImpulseTrain,
    /// To every shock as a pulse of the contact.
    PulseTrain,
}

/// One rung of each ladder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pair {
    /// How the bar moves.
    pub bar: BarRung,
    /// How the component answers.
    pub component: ComponentRung,
}

impl Pair {
    /// The pair that all others are held against.
    pub const HIGHEST: Self = Self { bar: BarRung::Compliant, component: ComponentRung::PulseTrain };
    /// The pairs that a plan chooses from: each either cheaper than the ones after it or closer.
    ///
    /// The others cost as much as one of these and know less.
    #[must_use]
    pub fn planned(quantity: Quantity) -> &'static [Self] {
        use BarRung::{Ballistic, ClosedForm, FiniteTilt, Map};
        use ComponentRung::{ImpulseTrain, LargestShock, NetChange, PulseTrain};
        const fn pair(bar: BarRung, component: ComponentRung) -> Pair {
            Pair { bar, component }
        }
        match quantity {
            Quantity::VelocityShock => {
                const {
                    &[
                        pair(ClosedForm, LargestShock),
                        pair(Ballistic, LargestShock),
                        pair(FiniteTilt, LargestShock),
                        Self::HIGHEST,
                    ]
                }
            }
            Quantity::PeakAcceleration | Quantity::RattleSpace => {
                const {
                    &[
                        pair(ClosedForm, NetChange),
                        pair(ClosedForm, LargestShock),
                        pair(Map, ImpulseTrain),
                        pair(Ballistic, ImpulseTrain),
                        pair(FiniteTilt, ImpulseTrain),
                        pair(Map, PulseTrain),
                        pair(Ballistic, PulseTrain),
                        pair(FiniteTilt, PulseTrain),
                        Self::HIGHEST,
                    ]
                }
            }
        }
    }
}

/// The error of a rung in the quantity asked, as a share of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// At most, or about so much; infinite where the rung cannot be used.
    pub error: f64,
    /// Whether it is proven, or an estimate that a study of random scenes holds.
    pub is_bound: bool,
}

/// One drop, and one component in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    scene: Scene,
    contact_time_s: Option<f64>,
    position: f64,
    suspension: Suspension,
}

impl Setup {
    /// A scene, the time that a lone contact takes where it is known, the position of the component in [−1, 1] (−1 is
    /// the end that touches first) and its suspension.
    ///
    /// # Errors
    /// [`Error::Shock`] for a position outside [−1, 1], [`Error::Bar`] for a contact time outside [1e−12, 1e3] s.
    pub fn new(
        scene: Scene,
        contact_time_s: Option<f64>,
        position: f64,
        suspension: Suspension,
    ) -> Result<Self, Error> {
        if !(-1.0..=1.0).contains(&position) {
            let allowed = "in [-1, 1]; -1 is the end that touches first";
            return Err(clatter_shock::Error::Quantity { name: "position", value: position, allowed }.into());
        }
        if let Some(value) = contact_time_s.filter(|t| !(1e-12..=1e3).contains(t)) {
            return Err(
                clatter::Error::Quantity { name: "contact time in s", value, allowed: "in [1e-12, 1000]" }.into()
            );
        }
        Ok(Self { scene, contact_time_s, position, suspension })
    }
    /// The same with what was checked before, and a position that may lie beyond the ends.
    pub(crate) fn anywhere(scene: Scene, contact_time_s: Option<f64>, position: f64, suspension: Suspension) -> Self {
        Self { scene, contact_time_s, position, suspension }
    }
    /// The drop.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
    /// The time of a lone contact.
    #[must_use]
    pub fn contact_time_s(&self) -> Option<f64> {
        self.contact_time_s
    }
    /// Where the component is, in [−1, 1]; −1 is the end that touches first.
    #[must_use]
    pub fn position(&self) -> f64 {
        self.position
    }
    /// The component.
    #[must_use]
    pub fn suspension(&self) -> &Suspension {
        &self.suspension
    }
}
