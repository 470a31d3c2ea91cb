//! The figures: each a pure function of the data it draws.

pub(crate) mod axes;
pub(crate) mod component;
pub(crate) mod design;
pub(crate) mod drop;
pub(crate) mod heat;
mod labels;
pub(crate) mod ladder;
pub(crate) mod orders;
pub(crate) mod peers;
pub(crate) mod plane;
pub(crate) mod product;
pub(crate) mod rules;
pub(crate) mod scheme;
pub(crate) mod shock;
pub(crate) mod surface;
