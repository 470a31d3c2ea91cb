//! Studies with clatter: science about the product, and no part of it.
//!
//! [`orders`] and [`residues`] measure how the models of a drop tend to one another; [`suspended`] is what a clatter does to
//! suspended parts of any frequency, anywhere on a bar. [`figures`] draws what they find.

pub mod figures;
mod orders;
pub mod suspended;

pub use orders::{Order, Residue, orders, residues};
