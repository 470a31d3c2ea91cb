//! This module holds drop standards: the drops that they demand, from how high and within which tolerance.
//!
//! Only what was read in the text itself, or agrees in several sources, is here.

use crate::{Attitude, DataFault};

/// The faces, edges and corners that are landed on, each with its drop height in m.
pub(crate) type Drops = Vec<(Attitude, f64)>;

/// A standard that lists drops.
#[derive(Debug)]
pub(crate) struct Standard {
    /// The name in product files.
    pub(crate) keyword: &'static str,
    /// Clause and title.
    pub(crate) source: &'static str,
    drops: fn(Item) -> Result<Drops, DataFault>,
}

/// The data on which the drops of a standard depend.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Item {
    pub(crate) mass_kg: Option<f64>,
    /// Its largest side.
    pub(crate) largest_m: f64,
}

/// Returns the tolerance of ASTM D5276: flat within 2°, on edges and corners within 5°; a box tilted by hand too.
pub(crate) fn tolerance_rad(attitude: Attitude) -> f64 {
    if attitude.faces() == 1 { 2_f64.to_radians() } else { 5_f64.to_radians() }
}

pub(crate) static STANDARDS: &[Standard] = &[Standard {
    keyword: "MIL-STD-810H/516.8-IV",
    source: "MIL-STD-810H, method 516.8, procedure IV, table 516.8-IX: transit drop",
    drops: transit_drop,
}];

/// Lists the drops by mass. Up to 45.4 kg: 26 drops, from 122 cm, of an item of 91 cm and longer from 76 cm. Up to 90.8 kg: 8 corner drops
/// from 76 cm, of a longer item from 61 cm.
fn transit_drop(item: Item) -> Result<Drops, DataFault> {
    let mass_kg = item.mass_kg.ok_or(DataFault::StandardNeedsMass)?;
    let is_long = item.largest_m >= 0.91;
    let (most_kg, heaviest_kg) = (45.4, 90.8);
    if mass_kg > heaviest_kg {
        return Err(DataFault::StandardMass { mass_kg, most_kg: heaviest_kg });
    }
    let (faces, height_m) = match (mass_kg <= most_kg, is_long) {
        (true, false) => (1..=3, 1.22),
        (true, true) => (1..=3, 0.76),
        (false, false) => (3..=3, 0.76),
        (false, true) => (3..=3, 0.61),
    };
    Ok(faces.flat_map(Attitude::all).map(|attitude| (attitude, height_m)).collect())
}

/// Returns the drops of a standard, each with its height in m, and its clause.
pub(crate) fn drops(keyword: &str, item: Item) -> Result<(Drops, &'static str), DataFault> {
    let standard = STANDARDS.iter().find(|standard| standard.keyword == keyword);
    let Standard { source, drops, .. } = standard.ok_or_else(|| DataFault::Standard(keyword.to_owned()))?;
    Ok((drops(item)?, source))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_land_flatter_than_edges_and_corners() {
        let degrees = |faces| Attitude::all(faces).into_iter().map(|attitude| tolerance_rad(attitude).to_degrees());
        for (faces, most) in [(1, 2.0), (2, 5.0), (3, 5.0)] {
            assert!(degrees(faces).all(|degrees| (degrees - most).abs() < 1e-12), "{faces} faces");
        }
    }

    #[test]
    fn a_transit_drop_goes_by_mass_and_size() {
        let of = |mass_kg, largest_m| drops("MIL-STD-810H/516.8-IV", Item { mass_kg: Some(mass_kg), largest_m });
        let counted = |mass_kg, largest_m| of(mass_kg, largest_m).map(|(drops, _)| (drops.len(), drops[0].1));
        assert_eq!(counted(0.4, 0.2), Ok((26, 1.22)));
        assert_eq!(counted(45.4, 0.91), Ok((26, 0.76)));
        assert_eq!(counted(50.0, 0.5), Ok((8, 0.76)));
        assert_eq!(counted(90.0, 1.5), Ok((8, 0.61)));
        assert_eq!(counted(91.0, 1.5), Err(DataFault::StandardMass { mass_kg: 91.0, most_kg: 90.8 }));
        let unknown = drops("IEC 60068-2-31", Item { mass_kg: Some(1.0), largest_m: 0.1 });
        assert_eq!(unknown, Err(DataFault::Standard("IEC 60068-2-31".to_owned())));
    }
}
