//! Figures as SVG, drawn by plotters on a page of our own: each a pure function of the data it shows.
//!
//! Charts, axes, meshes, color maps and the view of surfaces are those of plotters. Its page is SVG in hundredths of a point, with
//! the typeface of the printed reports and a title for readers that cannot see. Series are cut at the frame before they are drawn.
//! The crate reads no file and starts nothing; it runs in a browser as well.

#![expect(clippy::missing_errors_doc, reason = "of every figure: what plotters says, which no input brings about")]
#![allow(clippy::disallowed_methods, reason = "what is shown has few digits")]

mod assessed;
mod axis;
mod chart;
mod component;
mod design;
mod drop;
mod fit;
mod grid;
mod heat;
mod labels;
mod ladder;
mod page;
mod paper;
mod plane;
mod plate;
mod product;
mod record;
mod ring;
mod shock;
mod style;
mod surface;

pub use assessed::{assessed, reach_m};
pub use axis::{raised, three, tick};
pub use component::{Share, history, is_drawn, over_direction, over_tilt, shares};
pub use design::{DesignBorder, DesignFronts, DesignPlane, fronts, plane as design_plane};
pub use drop::{Drop, drop};
pub use fit::fit;
pub use heat::map;
pub use ladder::{Panel as LadderPanel, panels as ladders, words as model_words};
pub use plate::{Area, HeatMap, Landing, Strike, heat_map, landing, plan};
pub use product::{Place, product};
pub use record::{Trace, record};
pub use ring::ring;
pub use shock::{Against, Critical, boundary, damage_boundary, rule, spectra, spectrum, spectrum_compared, two};
pub use surface::{Sheet, Surface, surface};

/// The tools of figures: a page in points, charts on it, and the style of lines and words.
pub mod draw {
    pub use crate::axis::{Axis, step_up};
    pub use crate::chart::{Axes, Chart};
    pub use crate::paper::{Paper, SMALL};
    pub use crate::plane::{percent, plane_axes};
    pub use crate::shock::GUIDE;
    pub use crate::style::{Anchor, BLUES, GRAY, INK, Ink, LABEL, Label, Pt, RUST, SAND, width};
}

/// The error of plotters that kept a figure from being drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FigureError(pub(crate) String);

impl std::fmt::Display for FigureError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the figure could not be drawn: {}", self.0)
    }
}

impl std::error::Error for FigureError {}

impl From<FigureError> for std::io::Error {
    fn from(error: FigureError) -> Self {
        Self::other(error)
    }
}
