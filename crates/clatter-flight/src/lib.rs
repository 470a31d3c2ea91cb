//! The clatter in time: gravity, real tilt, an off-center mass, contact that takes time.
//!
//! Four models of one drop, each the cheapest that keeps its physics. [`Scene::fly`] follows a drop by any of them, and all answer
//! with a [`Motion`], so that they can be compared strike by strike:
//!
//! | model | between strikes | a strike |
//! |---|---|---|
//! | [`Model::Map`] | straight lines, small tilt, no gravity | impulse |
//! | [`Model::Ballistic`] | parabolas, small tilt | impulse |
//! | [`Model::FiniteTilt`] | parabola of the center, uniform rotation, any angle | impulse, lever arm L cos φ, of corners where the body has a thickness |
//! | [`Model::Contacts`] | as `FiniteTilt` | contacts that take time, by one of two [laws](ContactLaw) |
//!
//! A [`Plate`] at small tilt goes by [`PlateScene::impacts_until`], which is `Ballistic`, and by [`PlateScene::contacts_until`].
//! [`Train`] follows a [`Drop`] of any body so, impact by impact.
//!
//! # The picture
//!
//! A body with ends `a` and `b` at distances `L_a`, `L_b` from its center of mass and radius of gyration `ρ`
//! falls on hard, frictionless, level ground. The tilt φ is positive where `b` is the higher end:
//! `h_a = y − L_a sin φ`, `h_b = y + L_b sin φ`. End `a` touches first, at time 0. Everything is in SI;
//! heights and velocities are vertical, upward positive, and forces and energies are per unit mass.
//!
//! # How a motion ends
//!
//! [`Stop`] is a result, never a tolerance on height or speed. A body has bounced clear when nothing can bring
//! it back (no gravity). It is at rest when its energy proves that all that is left takes less than an ulp of the
//! time and gives shocks below [`SHARE`] of the largest; both bounds are given. Everything else stops at a limit
//! and says so.
//!
//! ```
//! use clatter_flight::{Profile, Model, Scene, Stop};
//! // A uniform bar with e = 0 and no tilt: both ends strike in turn at one instant, T = q = ½ each, until all is still.
//! let body = Profile::new(0.14, 0.07 / 3.0_f64.sqrt())?;
//! let motion = Scene::new(body, 0.0, 1.0, 0.0, 9.81)?.fly(Model::Ballistic)?;
//! assert_eq!(motion.strikes[0].approach_m_s, -1.0);
//! assert!((motion.strikes[1].approach_m_s + 1.5).abs() < 1e-15); // v_b − q v0
//! assert!((motion.strikes[2].approach_m_s + 0.75).abs() < 1e-15);
//! assert!(matches!(motion.stop, Stop::AtRest { time_s: 0.0, .. }));
//! # Ok::<(), clatter_flight::Error>(())
//! ```

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")
)]

mod block;
mod body;
mod contact;
mod drop;
mod error;
mod excitation;
mod flight;
mod fly;
pub mod history;
mod motion;
mod own_contacts;
mod place;
mod plate;
mod profile;
mod rigid;
mod roots;
mod scene;
mod train;

pub use block::{Block, BlockDrop, BlockFlight, BlockStep, BlockStrike, LEAST_OF_BLOCKS};
pub use body::{Body, Feet, Side, THIN};
pub use contact::{Contact, ContactLaw, Press, Sample};
pub use drop::{Drop, Levers, turned_off};
pub use error::Error;
pub use flight::{LiftOff, Model, Pivot, SHARE, Stop, Strike};
pub use fly::{Followed, PRECISION, Until};
pub use motion::{Ahead, FeetMotion, Motion, PlateMotion};
pub use own_contacts::{OwnContact, OwnContacts, PLACES};
pub use place::{Axis, Place};
pub use plate::{Plate, PlateScene};
pub use profile::Profile;
pub use scene::Scene;
pub use train::{BoxEnd, Impact, Train};
