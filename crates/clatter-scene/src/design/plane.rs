//! Which (q, e) make the parts safe, over the design plane of the paper.

use clatter::contour::Point;
use clatter::design::{Goal, region};
use rayon::prelude::*;

use super::lever::Bounds;
use crate::scatter::{Error, Sampler, Settings};
use crate::{Component, First, Limits, Mount, ProductFile, scatter};

/// The design plane 0 ≤ q ≤ 1, 0 ≤ e ≤ 1 of a product, on the gravity-free rung.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Inertia ratio of the product.
    pub q: f64,
    /// Its coefficients of restitution.
    pub e: [f64; 2],
    /// What can be built.
    pub bounds: Bounds,
    /// In the order of the file.
    pub components: Vec<PlaneComponent>,
}

/// Where one component is safe.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneComponent {
    /// Its name.
    pub name: String,
    /// The border between safe and unsafe.
    pub border: Border,
}

/// How the border is known.
#[derive(Debug, Clone, PartialEq)]
pub enum Border {
    /// Exactly: below these curves e(q) the component is safe; without any it is nowhere. For limits on velocity shocks
    /// of parts of a product whose center of mass is in the middle and that may touch with either end first.
    Exact(Vec<Vec<Point>>),
    /// Margins allowed/demand − 1 on a grid of [`Plane::GRID`] values of q and of e from 0 to 1, e fastest, from drops
    /// all over the ranges (33 tilts, both ends, three speeds and frequencies).
    Grid(Vec<f64>),
}

/// The true border stays within about this of the chords of exact curves.
const FLATNESS: f64 = 2e-4;

impl Plane {
    /// Values of q, and of e, of a grid.
    pub const GRID: usize = 41;

    /// Solves or searches the border of every component.
    ///
    /// # Errors
    /// As [`Sampler::new`].
    pub fn of(file: &ProductFile, bounds: &Bounds) -> Result<Self, Error> {
        let settings = Settings { samples: 1, seed: 0, confidence: 0.5 };
        // Any mass layout does here: the plane brings its own.
        let product = file.product.with_inertia_ratio(0.5)?;
        let sampler = Sampler::new(&ProductFile { product, ..file.clone() }, settings)?;
        let goals: Vec<Option<Vec<Goal>>> = file.components.iter().map(|c| goals(file, c)).collect();
        let grids = goals.iter().any(Option::is_none).then(|| margins(file, &sampler)).transpose()?;
        let each = file.components.iter().zip(goals).enumerate();
        let components = each.map(|(i, (component, goals))| PlaneComponent {
            name: component.name.clone(),
            border: match (goals, &grids) {
                (Some(goals), _) => Border::Exact(region(&goals, FLATNESS)),
                (None, grids) => Border::Grid(grids.iter().flatten().map(|margins| margins[i]).collect()),
            },
        });
        let restitution = &file.product.restitution;
        let e = [restitution.lo(), restitution.hi()];
        Ok(Self { q: file.product.inertia_ratio(), e, bounds: *bounds, components: components.collect() })
    }
}

/// The limits of a component as goals in the plane; `None` where they are none.
fn goals(file: &ProductFile, component: &Component) -> Option<Vec<Goal>> {
    let [a, b] = file.product.body.arms_m();
    let middle = (a - b).abs() <= 1e-12 * (a + b); // roundings of what was given
    let Limits { acceleration_m_s2, rattle_space_m, .. } = component.limits;
    let responds = !matches!(component.mount, Mount::Hard) && (acceleration_m_s2.is_some() || rattle_space_m.is_some());
    if !middle || file.drop.first != First::Either || responds {
        return None;
    }
    let [_, fastest] = file.drop.speeds_m_s();
    let s = component.ends_m().iter().fold(0.0_f64, |most, x| most.max(file.product.relative(*x).abs())).min(1.0);
    let goal = |allowed: scatter::Allowed| match allowed {
        scatter::Allowed::Shock(v) => Goal::zone(v / fastest, s).ok(),
        scatter::Allowed::Turn(w) => Goal::turn(w * 0.5 * file.product.body.length_m() / fastest).ok(),
        scatter::Allowed::Displacement(_) | scatter::Allowed::Acceleration(_) => None,
    };
    scatter::limits(&file.product, component).into_iter().map(|(_, allowed)| goal(allowed)).collect()
}

/// Margins of all components at each point of the grid.
fn margins(file: &ProductFile, sampler: &Sampler) -> Result<Vec<Vec<f64>>, Error> {
    #[expect(clippy::cast_precision_loss, reason = "small counts")]
    let at = |i: usize| i as f64 / (Plane::GRID - 1) as f64;
    let points: Vec<(usize, usize)> = (0..Plane::GRID).flat_map(|i| (0..Plane::GRID).map(move |j| (i, j))).collect();
    points
        .into_par_iter()
        .map(|(i, j)| {
            // Massless ends would strike for ever; next to them is as good for a picture.
            let product = file.product.with_inertia_ratio(at(i).min(LARGEST_Q))?;
            Ok(sampler.worst(&product.body, at(j)).into_iter().map(|used| 1.0 / used - 1.0).collect())
        })
        .collect()
}

/// Stands for q = 1.
const LARGEST_Q: f64 = 0.999;
