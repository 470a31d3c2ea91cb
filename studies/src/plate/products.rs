//! The worked products as bars, as plates in any direction of tilt, and as boxes that land on their bottom.

use clatter_assess::Verdict;
use clatter_flight::ContactLaw;
use clatter_product::{Attitude, Landing, Law, LimitKind, ProductFile, Side, Spread};
use serde_json::{Value, json};

use crate::Error;
use crate::files::decimals;

/// A worked product with its data as a plate and as a box.
struct Product {
    text: &'static str,
    width_m: f64,
    thickness_m: f64,
    /// Contact time of a product whose file gives none.
    contact_s: f64,
}

const PRODUCTS: [Product; 3] = [
    Product {
        text: include_str!("../../../tests/cases/bar-phone.toml"),
        width_m: 0.072,
        thickness_m: 0.008,
        contact_s: 4e-4,
    },
    Product {
        text: include_str!("../../../tests/cases/bar-terminal.toml"),
        width_m: 0.085,
        thickness_m: 0.035,
        contact_s: 1e-3,
    },
    Product {
        text: include_str!("../../../tests/cases/bar-laptop.toml"),
        width_m: 0.23,
        thickness_m: 0.018,
        contact_s: 1e-3,
    },
];

/// A limit of a part: its demand as a bar, as a plate and as a box over the limit, with the uncertainties.
pub(crate) struct Row {
    product: String,
    part: String,
    limit: LimitKind,
    demands: [f64; 3],
    uncertainties: [f64; 3],
    verdicts: [Verdict; 3],
}

impl Row {
    /// Returns the row in percent.
    pub(crate) fn json(&self) -> Value {
        json!({
            "product": self.product,
            "part": self.part,
            "limit": self.limit.name().replace('-', " "),
            "demands": self.demands.map(|share| decimals(100.0 * share, 0)),
            "uncertainties": self.uncertainties.map(|share| decimals(100.0 * share, 0)),
            "verdicts": self.verdicts.map(Verdict::name),
        })
    }
}

/// Returns the largest difference of the demand of a bar from that of the plate, for limits that are not about turning.
pub(crate) fn most_off(rows: &[Row]) -> f64 {
    let moves = rows.iter().filter(|row| row.limit != LimitKind::AngularVelocityChange);
    moves.map(|row| (row.demands[1] / row.demands[0] - 1.0).abs()).fold(0.0, f64::max)
}

/// Returns every limit of every product.
pub(crate) fn rows() -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for product in &PRODUCTS {
        let files = product.files()?;
        let [bar, plate, lying] = [
            clatter_assess::assess(&files[0])?,
            clatter_assess::assess(&files[1])?,
            clatter_assess::assess(&files[2])?,
        ];
        for ((bar, plate), lying) in bar.components.iter().zip(&plate.components).zip(&lying.components) {
            for ((one, two), three) in bar.limits.iter().zip(&plate.limits).zip(&lying.limits) {
                let limits = [one, two, three];
                rows.push(Row {
                    product: files[0].product.name.clone(),
                    part: bar.name.clone(),
                    limit: one.limit,
                    demands: limits.map(|limit| limit.demand.map_or(f64::NAN, |demand| demand / limit.allowed)),
                    uncertainties: limits.map(|limit| limit.uncertainty),
                    verdicts: limits.map(|limit| limit.verdict),
                });
            }
        }
    }
    Ok(rows)
}

impl Product {
    /// Returns the same ranges as a bar, a plate and a box: from flat up to the largest tilt of the file.
    fn files(&self) -> Result<[ProductFile; 3], Error> {
        let mut bar =
            ProductFile::read(self.text, "a worked product").map_err(|faults| Error::Data(faults.to_string()))?;
        bar.product.contact_time_s.get_or_insert(Spread::value(self.contact_s)?);
        bar.product.contact_law = Some(ContactLaw::Hysteretic);
        let most = bar.drop.tilt_rad.hi();
        bar.drop.tilt_rad = Spread::new(0.0, most, Law::Range)?;
        let mut plate = bar.clone();
        let (body, half_m) = (bar.product.body, 0.5 * self.width_m);
        // The mass is spread over the width as over the length.
        let gyration_m = self.width_m * body.gyration_m() / body.length_m();
        let width = Side { ends_m: [half_m; 2], gyration_m };
        plate.product.body = body.with_width(width).with_thickness(Side::even(self.thickness_m));
        let mut lying = plate.clone();
        let attitude = Attitude::on("bottom").unwrap_or_else(|| unreachable!("a face"));
        lying.landings = vec![Landing { drop: bar.drop, attitude: Some(attitude), source: None }];
        lying.drop.tilt_rad = Spread::value(0.0)?;
        Ok([bar, plate, lying])
    }
}
