//! The clatter of a flat body after a tilted drop.
//!
//! A rigid bar falls almost level, lands on one end, then the other, in a rapid train of impacts: the
//! clatter. This crate computes that train and what follows from it.
//!
//! # The picture
//!
//! The bar has ends `a` and `b`; end `a` strikes first. Velocities are those of the ends, **upward
//! positive**, so a falling bar starts from `[-1, -1]` in units of the drop speed `v0`. Times are in units
//! of `h0/v0`, where `h0` is the height of end `b` at the moment end `a` touches. A position `s` on the
//! bar runs from −1 (end `a`) through 0 (the center) to 1 (end `b`).
//!
//! Two numbers decide everything: the coefficient of restitution `e` and the inertia ratio
//! `q = (L² − ρ²)/(L² + ρ²)` of half-length `L` and radius of gyration `ρ`.
//!
//! A product that is no bar is a [`Plate`], which lands on its four corners; the bar is its limit of large inertia across.
//!
//! Features: `parallel`, on unless switched off, fills maps on several threads. `serde` writes and reads inputs and
//! answers, and repeats the checks of construction.

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")
)]

pub mod accuracy;
mod bar;
pub mod contour;
mod dd;
pub mod design;
mod error;
mod exact;
mod excitation;
#[cfg(feature = "serde")]
mod fields;
mod map;
mod mass;
mod motion;
mod plate;
pub mod quadrature;
pub mod reference;
mod start;
mod summary;
mod symmetric;
mod train;
mod zone;

pub use bar::{Bar, Restitution};
pub use error::Error;
pub use excitation::{Excitation, Section, Sine};
pub use map::{Axis, Map, Quantity, Variable};
pub use mass::{Mass, center_and_gyration};
pub use plate::{
    Atlas, AtlasPeak, Corner, Plate, PlateCount, PlateImpact, PlatePeak, PlateShocks, PlateStart, PlateSummary,
    PlateTrain, PlateZone, Word,
};
pub use quadrature::Integral;
pub use start::{End, Start};
pub use summary::{Count, Net, Peak, PeakImpact, Summary};
pub use train::{Impact, Train};
pub use zone::{EndPeaks, Extent, Safest, Shocks, Zone};
