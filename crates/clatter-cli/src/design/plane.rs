//! This module writes the plane of a product, as a picture or as points.

use std::io::{self, Write};
use std::path::Path;

use clatter_assess::design::{Border, Plane};
use clatter_figures::{DesignBorder, DesignPlane};

use crate::Failure;
use crate::numbers::digits;
use crate::text::field;

/// Writes the plane: a picture to a file that ends in .svg, else its borders.
pub(super) fn write(path: &Path, plane: &Plane) -> Result<(), Failure> {
    super::write(path, || clatter_figures::design_plane(&drawing(plane)), |out| csv(plane, out))
}

fn drawing(plane: &Plane) -> DesignPlane {
    let border = |border: &Border| match border {
        Border::Exact(pieces) => DesignBorder::Exact(pieces.clone()),
        Border::Grid(margins) => DesignBorder::Grid { side: plane.side, margins: margins.clone() },
    };
    DesignPlane {
        borders: plane.components.iter().map(|c| (c.name.clone(), border(&c.border))).collect(),
        product: Some((plane.q, plane.e)),
        model: format!("by the model {}:", plane.model.name()),
        reach: Some([plane.bounds.q, plane.bounds.e]),
        designs: Vec::new(),
    }
}

/// Writes exact borders as points of curves, searched ones as margins on their grid; without a number where none is known.
fn csv(plane: &Plane, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "component,piece,q,e,margin")?;
    for component in &plane.components {
        let name = field(&component.name);
        match &component.border {
            Border::Exact(pieces) => {
                for (i, piece) in pieces.iter().enumerate() {
                    for p in piece {
                        writeln!(out, "{name},{},{},{},0.0", i + 1, digits(p.q), digits(p.e))?;
                    }
                }
            }
            Border::Grid(margins) => {
                for (k, margin) in margins.iter().enumerate() {
                    let [q, e] = [k / plane.side, k % plane.side].map(|k| digits(plane.value(k)));
                    writeln!(out, "{name},,{q},{e},{}", margin.map(digits).unwrap_or_default())?;
                }
            }
        }
    }
    Ok(())
}
