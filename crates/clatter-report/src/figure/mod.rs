//! The figures: each a pure function of the data it draws.

pub(crate) mod heat;
pub(crate) mod plane;
pub(crate) mod scheme;
pub(crate) mod surface;
