//! An assessed product with its parts.

use clatter_assess::{Assessment, ComponentAssessment, Portrait};
use clatter_product::{Component, ProductFile};

use crate::{Area, FigureError, Place, plan, product};

/// Draws the product as a printed report shows it: a plate or a box from above, a bar from the side with the safe zone
/// of each part, which `portraits` hold; other portraits may be left out.
///
/// ```
/// use clatter_product::{EXAMPLE, ProductFile};
/// let file = ProductFile::read(EXAMPLE, "example.toml")?;
/// let assessment = clatter_assess::assess(&file)?;
/// let drawn = clatter_figures::assessed(&file, &assessment, &clatter_assess::portraits(&file, &assessment))?;
/// assert!(drawn.contains(">display<"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn assessed(file: &ProductFile, assessment: &Assessment, portraits: &[Portrait]) -> Result<String, FigureError> {
    let margin = |assessed: &ComponentAssessment| match assessed.tightest().margin {
        None => "?".to_owned(),
        Some(margin) if margin.is_infinite() => "–".to_owned(),
        Some(margin) => format!("{:+.1} %", 100.0 * margin).replace('-', "−"),
    };
    let words: Vec<String> = assessment.components.iter().map(margin).collect();
    let parts = file.components.iter().zip(&assessment.components).zip(&words).enumerate();
    if let Some(plate) = file.product.plate() {
        let area = parts.map(|(i, ((component, assessed), word))| Area {
            number: i + 1,
            name: &component.name,
            reach_m: reach_m(component),
            verdict: assessed.verdict,
            word,
        });
        return plan(&plate, file.product.sides_m(), &area.collect::<Vec<_>>());
    }
    let place = parts.map(|(i, ((component, assessed), word))| Place {
        name: &component.name,
        from_m: component.position_m.lo() - 0.5 * component.extent_m,
        to_m: component.position_m.hi() + 0.5 * component.extent_m,
        verdict: assessed.verdict,
        word,
        zone_m: portraits.get(i).and_then(|portrait| portrait.zone_m),
    });
    let body = &file.product.body;
    let beyond_m = file.product.body.feet.map_or(0.0, |feet| feet.inset_m[0]);
    product(body.arms_m(), body.gyration_m(), beyond_m, &place.collect::<Vec<_>>())
}

/// Returns the range of a part along a plate and across it, in m from the middle.
#[must_use]
pub fn reach_m(component: &Component) -> [[f64; 2]; 2] {
    let ends = component.ends_m();
    let of = |side: usize| {
        let all = ends.iter().map(|end| end[side]);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[from, to], x| [from.min(x), to.max(x)])
    };
    [of(0), of(1)]
}
