//! Figures of the studies as SVG, drawn with the tools of `clatter-figures`.

#![expect(clippy::missing_errors_doc, reason = "of every figure: what plotters says, which no input brings about")]

mod bar;
mod cube;
mod friction;
mod orders;
mod peers;
mod plane;
pub(crate) mod plates;
pub mod rules;

pub use bar::scheme;
pub use cube::{OverTime, tosses};
pub(crate) use friction::friction;
pub use orders::{Panel as OrderPanel, orders};
pub use peers::{Dot, Tool, tools};
pub use plane::{Impacts, Zones, impacts, zones};
