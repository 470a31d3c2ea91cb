//! This module finds the (q, e) that make the parts safe, over the design plane of the paper.

use std::ops::Range;

use clatter::contour::Point;
use clatter::design::{Goal, region};

use super::lever::Bounds;
use crate::scatter::extremes;
use clatter_product::{Component, Error, First, Limit, Model, ProductFile, Source};

/// The design plane 0 ≤ q ≤ 1, 0 ≤ e ≤ 1 of a product.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Plane {
    /// Inertia ratio of the product.
    pub q: f64,
    /// Its coefficients of restitution.
    pub e: [f64; 2],
    /// The bounds of products that can be built.
    pub bounds: Bounds,
    /// The model that answered: [`Model::Map`] is the closed form.
    pub model: Model,
    /// The largest error of the closed form, in some drops all over the plane; infinite where it or the fullest model has no answer.
    pub closed_form_error: f64,
    /// Values of q, and of e, of a grid.
    pub side: usize,
    /// The components, in the order of the file.
    pub components: Vec<PlaneComponent>,
}

/// The region in which one component is safe.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneComponent {
    /// Its name.
    pub name: String,
    /// The border between safe and unsafe.
    pub border: Border,
}

/// The form in which the border is known.
#[derive(Debug, Clone, PartialEq)]
pub enum Border {
    /// The border as curves e(q), below which the component is safe; without any it is nowhere. By the closed form, for limits on velocity
    /// shocks and turning of products whose center of mass is in the middle and that may touch with either end first.
    Exact(Vec<Vec<Point>>),
    /// Margins allowed/demand − 1 on a grid of [`Plane::side`] values of q and of e from 0 to 1, e fastest; none where the model has
    /// no answer and beyond what can be built. The drops are those of [`extremes`].
    Grid(Vec<Option<f64>>),
}

/// The true border stays within about this of the chords of exact curves.
const FLATNESS: f64 = 2e-4;
/// Stands for q = 1, whose massless ends would strike for ever.
const LARGEST_Q: f64 = 0.999;

impl Plane {
    /// Values of q, and of e, of a grid.
    pub const SIDE: usize = 41;
    /// The same of a product with a contact time, whose drops cost ten times as much to follow: the plane still takes some seconds.
    pub const SIDE_OF_CONTACTS: usize = 21;

    /// Finds the border of every component within the bounds of products that can be built. Limits are at their least values, and all
    /// ranges but that of the restitution are those of the file.
    ///
    /// # Errors
    /// As [`extremes`] and [`Bounds::check`].
    ///
    /// # Examples
    /// ```
    /// use clatter_product::ProductFile;
    /// use clatter_assess::design::{Bounds, Plane};
    /// let bounds = Bounds { q: [0.5, 0.55], e: [0.3, 0.35], ..Bounds::default() };
    /// let bar = r#"
    /// product = { name = "bar", length = "140 mm", radius_of_gyration = "38 mm", restitution = 0.3, contact_time = "0.4 ms" }
    /// drop = { height = "1 m", tilt = ["1 deg", "5 deg"] }
    /// component = [{ name = "camera", position = "55 mm", mount = "hard", acceleration_limit = "9000 gn" }]
    /// "#;
    /// let plane = Plane::of(&ProductFile::read(bar, "bar.toml")?, &bounds)?;
    /// assert_eq!(plane.side, Plane::SIDE_OF_CONTACTS);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(file: &ProductFile, bounds: &Bounds) -> Result<Self, Error> {
        file.check()?;
        file.check_bar("the plane of q and e")?;
        file.check_alike("the plane of q and e")?;
        bounds.check()?;
        let side = if file.product.contact_time_s.is_some() { Self::SIDE_OF_CONTACTS } else { Self::SIDE };
        let [qs, es] = [bounds.q, bounds.e].map(|range| within(range, side));
        let mut points = Vec::with_capacity(qs.len() * es.len());
        for i in qs.clone() {
            let body = file.product.with_inertia_ratio(value(i, side).min(LARGEST_Q))?.body;
            points.extend(es.clone().map(|j| (body, value(j, side))));
        }
        let found = extremes(file, &points)?;
        let margins = |component: usize| {
            let mut margins = vec![None; side * side];
            for (k, used) in found.worst.iter().enumerate() {
                let (i, j) = (qs.start + k / es.len(), es.start + k % es.len());
                margins[i * side + j] = used[component].map(|used| 1.0 / used - 1.0);
            }
            margins
        };
        let border = |(i, component): (usize, &Component)| PlaneComponent {
            name: component.name.clone(),
            border: match goals(file, component).filter(|_| found.model == Model::Map) {
                Some(goals) => Border::Exact(region(&goals, FLATNESS)),
                None => Border::Grid(margins(i)),
            },
        };
        let restitution = &file.product.restitution;
        Ok(Self {
            q: file.product.inertia_ratio(),
            e: [restitution.lo(), restitution.hi()],
            bounds: *bounds,
            model: found.model,
            closed_form_error: found.closed_form_error,
            side,
            components: file.components.iter().enumerate().map(border).collect(),
        })
    }

    /// Returns value k of q, or of e, of the grid.
    #[must_use]
    pub fn value(&self, k: usize) -> f64 {
        value(k, self.side)
    }
}

fn value(k: usize, side: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "small counts")]
    let share = k as f64 / (side - 1) as f64;
    share
}

/// Returns the values of a grid that a range within [0, 1] lies between; two at least, for a cell.
fn within([lo, hi]: [f64; 2], side: usize) -> Range<usize> {
    #[expect(clippy::cast_precision_loss, reason = "a small count")]
    let steps = (side - 1) as f64;
    // A bound is a value of the grid but for roundings, or lies well between two.
    let [lo, hi] = [(steps * lo + 1e-9).floor(), (steps * hi - 1e-9).ceil()];
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let [lo, hi] = [lo.clamp(0.0, steps - 1.0), hi.clamp(1.0, steps)].map(|k| k as usize);
    lo..hi.max(lo + 1) + 1
}

/// Returns the limits of a component as goals in the plane; `None` where they are none.
fn goals(file: &ProductFile, component: &Component) -> Option<Vec<Goal>> {
    let body = &file.product.body;
    let [a, b] = body.arms_m();
    let middle = (a - b).abs() <= 1e-12 * (a + b); // roundings of what was given
    let drops = file.drops();
    if !middle || drops.iter().any(|drop| drop.first != First::Either) {
        return None;
    }
    let fastest = drops.iter().map(|drop| drop.speeds_m_s()[1]).fold(0.0, f64::max);
    let s = component.ends_m().iter().fold(0.0_f64, |most, [x, _]| most.max(file.product.relative(*x).abs())).min(1.0);
    let goal = |limit: Limit| match limit.kind.source() {
        Source::Shock => Goal::zone(limit.allowed / fastest, s).ok(),
        Source::Turn => Goal::turn(limit.allowed * 0.5 * body.length_m() / fastest).ok(),
        Source::Boundary | Source::Response(_) => None,
    };
    Limit::of(component).into_iter().map(goal).collect()
}
