//! This module compares the measured values with those that the product file states.

use super::{Estimate, Fit, Known, Quantity};
use clatter_product::ProductFile;

/// A drop of the product that was measured, and the computed drop that is nearest.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredDrop {
    /// Its name, or that of its file.
    pub name: String,
    /// Files of its records, in the order of those of the fit.
    pub files: Vec<String>,
    /// The fit, or why there is none.
    pub found: Result<Fit, String>,
}

/// An estimate together with the range that the product file states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison<'a> {
    /// The measured value.
    pub estimate: &'a Estimate,
    /// The value that the file states, as a range; of the drop it is the range over which the worst case is searched.
    pub stated: Option<[f64; 2]>,
    /// True where they agree: the interval has a part of the range in it, and the estimate is within the range where that is more than
    /// one value. None where that cannot be decided.
    pub agrees: Option<bool>,
}

impl Fit {
    /// Returns each estimate with the range that a product file states.
    #[must_use]
    pub fn beside(&self, file: &ProductFile) -> Vec<Comparison<'_>> {
        let known = Known::from(file);
        let beside = self.estimates.iter().map(|estimate| {
            let stated = match estimate.quantity {
                Quantity::RadiusOfGyration => Some([file.product.gyration_m.lo(), file.product.gyration_m.hi()]),
                // The larger the radius, the smaller the ratio.
                Quantity::InertiaRatio => Some([1.0, 0.0].map(|share| file.product.inertia_ratio_at(share))),
                quantity => known.stated(quantity),
            };
            Comparison { estimate, stated, agrees: stated.and_then(|stated| estimate.agrees(stated)) }
        });
        beside.collect()
    }

    /// Returns the measured values of the product, not of how it fell, that differ from the file: the verdict is for the values of the
    /// file.
    #[must_use]
    pub fn differs(&self, file: &ProductFile) -> Vec<Comparison<'_>> {
        let of_product = |beside: &Comparison<'_>| beside.estimate.quantity.is_of_product();
        self.beside(file).into_iter().filter(|beside| of_product(beside) && beside.agrees == Some(false)).collect()
    }
}

impl Known {
    /// Returns the range that a file states of a quantity, the inertia apart.
    pub(super) fn stated(&self, quantity: Quantity) -> Option<[f64; 2]> {
        let height = |speed: f64| (self.gravity_m_s2 > 0.0).then(|| 0.5 * speed * speed / self.gravity_m_s2);
        Some(match quantity {
            Quantity::Restitution | Quantity::RestitutionA | Quantity::RestitutionB => self.restitution,
            Quantity::ContactTime => self.contact_time_s?,
            Quantity::Speed => self.speed_m_s,
            Quantity::DropHeight => [height(self.speed_m_s[0])?, height(self.speed_m_s[1])?],
            Quantity::Tilt => self.tilt_rad,
            // A single value is where the search begins.
            Quantity::RadiusOfGyration if self.gyration_m[1] > self.gyration_m[0] => self.gyration_m,
            Quantity::RadiusOfGyration | Quantity::InertiaRatio | Quantity::Spin | Quantity::GapOverSpeed => {
                return None;
            }
        })
    }
}

impl Estimate {
    pub(super) fn agrees(&self, [lo, hi]: [f64; 2]) -> Option<bool> {
        let is_value = lo >= hi;
        if !is_value && !(lo..=hi).contains(&self.value) {
            return Some(false);
        }
        match self.interval {
            Some([from, to]) => Some(from <= hi && lo <= to),
            None => (!is_value).then_some(true),
        }
    }
}

impl Quantity {
    /// Returns whether it is of the product, and not of how it fell.
    #[must_use]
    pub fn is_of_product(self) -> bool {
        match self {
            Self::Restitution
            | Self::RestitutionA
            | Self::RestitutionB
            | Self::RadiusOfGyration
            | Self::InertiaRatio
            | Self::ContactTime => true,
            Self::GapOverSpeed | Self::Speed | Self::DropHeight | Self::Tilt | Self::Spin => false,
        }
    }

    /// Returns its name in a text, the number of units that engineers use for it in one SI unit, and that unit.
    #[must_use]
    pub fn said(self) -> (&'static str, f64, &'static str) {
        match self {
            Self::Restitution => ("restitution", 1.0, ""),
            Self::RestitutionA => ("restitution of end a", 1.0, ""),
            Self::RestitutionB => ("restitution of end b", 1.0, ""),
            Self::RadiusOfGyration => ("radius of gyration", 1e3, "mm"),
            Self::InertiaRatio => ("inertia ratio q", 1.0, ""),
            Self::GapOverSpeed => ("gap over speed", 1e3, "ms"),
            Self::Speed => ("speed", 1.0, "m/s"),
            Self::DropHeight => ("drop height", 1e3, "mm"),
            Self::Tilt => ("tilt", 180.0 / std::f64::consts::PI, "deg"),
            Self::Spin => ("spin", 1.0, "rad/s"),
            Self::ContactTime => ("contact time", 1e3, "ms"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_estimate_agrees_with_what_it_holds() {
        let of = |value, interval| Estimate { quantity: Quantity::Restitution, value, interval, note: None };
        for (value, interval, stated, agrees) in [
            (0.3, Some([0.2, 0.5]), [0.25, 0.4], Some(true)),
            // The range may hold it, and does not hold what is most likely.
            (0.45, Some([0.35, 0.55]), [0.25, 0.4], Some(false)),
            (0.6, Some([0.55, 0.65]), [0.25, 0.4], Some(false)),
            (0.6, None, [0.25, 0.4], Some(false)),
            (0.3, None, [0.25, 0.4], Some(true)),
            (0.3, Some([0.29, 0.32]), [0.31, 0.31], Some(true)),
            (0.3, Some([0.29, 0.305]), [0.31, 0.31], Some(false)),
            (0.3, None, [0.31, 0.31], None),
        ] {
            assert_eq!(of(value, interval).agrees(stated), agrees, "{value} {interval:?} in {stated:?}");
        }
    }

    /// The larger ρ, the smaller q = (L² − ρ²)/(L² + ρ²): a range of radii is one of ratios, from the least.
    #[test]
    fn a_range_of_radii_is_one_of_ratios() {
        let text = r#"
product = { name = "bar", length = "200 mm", radius_of_gyration = ["50 mm", "60 mm"], restitution = 0.3 }
drop = { height = "1 m", tilt = "1 deg" }
component = [{ name = "part", position = "0 mm", mount = "hard", velocity_change_limit = "9 m/s" }]
"#;
        let file = ProductFile::read(text, "bar.toml").unwrap_or_else(|faults| panic!("{faults}"));
        let mut fit = crate::bounces(&[0.0, 0.1, 0.15, 0.175], 9.81, None).unwrap();
        let [least, most] = [60.0_f64, 50.0].map(|rho| (1e4 - rho * rho) / (1e4 + rho * rho));
        for (value, agrees) in [(0.5, true), (0.7, false), (0.4, false)] {
            let interval = Some([value - 0.01, value + 0.01]);
            fit.estimates = vec![Estimate { quantity: Quantity::InertiaRatio, value, interval, note: None }];
            let beside = fit.beside(&file)[0];
            let [from, to] = beside.stated.unwrap();
            assert!((from - least).abs() < 1e-12 && (to - most).abs() < 1e-12, "{from} to {to}");
            assert_eq!(beside.agrees, Some(agrees), "{value}");
        }
    }
}
