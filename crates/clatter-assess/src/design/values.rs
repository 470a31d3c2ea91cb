//! Values of levers: where they are, how far they go, and as what they can be specified.

use super::lever::{Change, Lever};
use super::remedies::Case;
use clatter_product::{Damping, Law, LimitKind, Mount, Product, ProductFile, Spread};

impl Case<'_> {
    /// Returns the present value, low and high end.
    fn present(&self, lever: Lever) -> [f64; 2] {
        let of = |spread: &Spread| [spread.lo(), spread.hi()];
        let (product, component) = (&self.file.product, self.component);
        match (lever, &component.mount) {
            (Lever::InertiaRatio, _) => [product.inertia_ratio(); 2],
            (Lever::Restitution, _) => of(&product.restitution),
            (Lever::Position, _) => of(&component.position_m),
            (Lever::Across, _) => of(&component.across_m),
            (Lever::Frequency, Mount::Suspended { frequency_hz, .. }) => of(frequency_hz),
            (Lever::Damping, Mount::Suspended { damping, .. }) => damping.ratios(),
            (Lever::Frequency | Lever::Damping, Mount::Hard) => [0.0; 2],
            (Lever::ContactTime, _) => product.contact_time_s.as_ref().map_or([0.0; 2], of),
            (Lever::StopGap, _) => component.stops.map_or([0.0; 2], |stops| of(&stops.gap_m)),
            (Lever::StopTime, _) => component.stops.map_or([0.0; 2], |stops| of(&stops.contact_time_s)),
            (Lever::Limit(kind), _) => component.limits.get(kind).map_or([0.0; 2], of),
        }
    }

    /// Returns the present value as the lever counts: a range by its low end, a multiple by the logarithm of its factor.
    pub(super) fn here(&self, lever: Lever) -> f64 {
        if multiplied(lever) { 0.0 } else { self.present(lever)[0] }
    }

    /// Returns the bounds, as the lever counts.
    pub(super) fn reach(&self, lever: Lever) -> [f64; 2] {
        let [lo, hi] = self.present(lever);
        match lever {
            // With mass inside the body alone.
            Lever::InertiaRatio => self.bounds.q.map(|q| q.max(0.0)),
            // the range as a whole: until its high end is at the low bound, its low end at the high bound
            Lever::Restitution => [self.bounds.e[0] - (hi - lo), self.bounds.e[1]],
            Lever::Position => within(self.side_m(lever) - self.component.extent_m, hi - lo),
            Lever::Across => within(self.side_m(lever) - self.component.extent_across_m, hi - lo),
            Lever::Frequency => [-1.0, 1.0].map(|side| side * libm::log(self.bounds.frequency_factor)),
            Lever::Damping => self.bounds.damping,
            Lever::ContactTime => {
                let [least, most] = self.bounds.contact_time_s;
                let (down, up) = (libm::log(least / lo), libm::log(most / hi));
                [down.min(up), up.max(down)]
            }
            Lever::StopGap => {
                let most = libm::log(self.bounds.limit_factor);
                let space = self.component.limits.get(LimitKind::RattleSpace);
                [-most, space.map_or(most, |space| libm::log(space.hi() / hi).clamp(0.0, most))]
            }
            Lever::StopTime => {
                let period_s = match self.component.mount {
                    Mount::Suspended { frequency_hz, .. } => frequency_hz.lo().recip(),
                    Mount::Hard => hi,
                };
                [libm::log(self.bounds.contact_time_s[0] / lo).min(0.0), libm::log(period_s / hi).max(0.0)]
            }
            Lever::Limit(_) => [0.0, libm::log(self.bounds.limit_factor)],
        }
    }

    /// Returns a bound as it is shown.
    pub(super) fn shown(&self, lever: Lever, x: f64) -> f64 {
        match lever {
            Lever::Restitution => x.clamp(self.bounds.e[0], self.bounds.e[1]),
            _ if multiplied(lever) => self.value(lever, x)[usize::from(x > 0.0)],
            _ => x,
        }
    }

    pub(super) fn change(&self, lever: Lever, x: f64) -> Change {
        Change { lever, from: self.present(lever), to: self.value(lever, x) }
    }

    /// Returns the quantity that a value of the lever means, low and high end, as it can be specified.
    pub(super) fn value(&self, lever: Lever, x: f64) -> [f64; 2] {
        let [lo, hi] = self.present(lever);
        let [lo, hi] = match lever {
            Lever::InertiaRatio => return [self.with_ratio(x).map_or(x, |product| product.inertia_ratio()); 2],
            Lever::Restitution => [x, x + (hi - lo)].map(|e| e.clamp(self.bounds.e[0], self.bounds.e[1])),
            Lever::Position | Lever::Across => [x, x + (hi - lo)],
            Lever::Damping => [x; 2],
            _ => [lo, hi].map(|value| value * libm::exp(x)),
        };
        let rounded = if lo < hi {
            [self.specified(lever, lo, f64::floor), self.specified(lever, hi, f64::ceil)]
        } else {
            [self.specified(lever, lo, f64::round); 2]
        };
        if lever == Lever::Restitution { rounded.map(|e| e.clamp(self.bounds.e[0], self.bounds.e[1])) } else { rounded }
    }

    /// Returns the side of the product along which a place is.
    fn side_m(&self, lever: Lever) -> f64 {
        let [along, across] = self.file.product.sides_m();
        if lever == Lever::Across { across } else { along }
    }

    /// Rounds to two digits in the unit of the file; a place to a hundredth of the decade of the side along it.
    fn specified(&self, lever: Lever, si: f64, way: fn(f64) -> f64) -> f64 {
        let unit = lever.written_in(&self.file.product, self.component);
        let of_si = |x: f64| unit.map_or(x, |unit| unit.of_si(x));
        let is_place = matches!(lever, Lever::Position | Lever::Across);
        let size = if is_place { 0.1 * self.side_m(lever) } else { si };
        let rounded = to_digits(of_si(si), of_si(size), way);
        unit.map_or(rounded, |unit| unit.to_si(rounded))
    }

    /// Returns the product with about this inertia ratio, its radius of gyration in mm as it can be specified, and within the body.
    fn with_ratio(&self, q: f64) -> Option<Product> {
        let product = self.file.product.with_inertia_ratio(q).ok()?;
        let [a, b] = product.body.arms_m();
        let specified = |way| 1e-3 * to_digits(1e3 * product.body.gyration_m(), 100.0 * (a + b), way);
        let nearest = specified(f64::round);
        let gyration = if nearest * nearest > a * b { specified(f64::floor) } else { nearest };
        let gyration_m = Spread::value(gyration).ok()?;
        Some(Product { body: product.body_with(gyration).ok()?, gyration_m, ..product })
    }

    /// Returns the file with these values; without its records, which a verdict is not made from.
    pub(super) fn changed(&self, values: &[(Lever, f64)]) -> Option<ProductFile> {
        let mut component = self.component.clone();
        let mut product = self.file.product.clone();
        for &(lever, x) in values {
            let [lo, hi] = self.value(lever, x);
            let unit = lever.written_in(&self.file.product, self.component);
            let range = Spread::new(lo, hi, if lo < hi { Law::Range } else { Law::Value }).ok()?.written_in(unit);
            match (lever, &mut component.mount) {
                (Lever::InertiaRatio, _) => {
                    let Product { body, gyration_m, .. } = self.with_ratio(x)?;
                    product = Product { body, gyration_m, ..product };
                }
                (Lever::Restitution, _) => product.restitution = range,
                (Lever::Position, _) => component.position_m = range,
                (Lever::Across, _) => component.across_m = range,
                (Lever::Frequency, Mount::Suspended { frequency_hz, .. }) => *frequency_hz = range,
                (Lever::Damping, Mount::Suspended { damping, .. }) => *damping = Damping::Ratio(range),
                (Lever::Frequency | Lever::Damping, Mount::Hard) => return None,
                (Lever::ContactTime, _) => product.contact_time_s = Some(range),
                (Lever::StopGap, _) => component.stops.as_mut()?.gap_m = range,
                (Lever::StopTime, _) => component.stops.as_mut()?.contact_time_s = range,
                (Lever::Limit(kind), _) => *component.limits.get_mut(kind)? = range,
            }
        }
        // Rounded outward it may reach beyond the ends.
        let most = [Lever::Position, Lever::Across].map(|lever| 0.5 * self.side_m(lever) * (1.0 + 1e-9));
        if component.ends_m().iter().any(|end| end[0].abs() > most[0] || end[1].abs() > most[1]) {
            return None;
        }
        let (drop, landings, mut components) =
            (self.file.drop, self.file.landings.clone(), self.file.components.clone());
        components[self.number] = component;
        Some(ProductFile {
            product,
            drop,
            landings,
            components,
            records: Vec::new(),
            reliability: self.file.reliability,
        })
    }
}

/// Returns the low ends of a range of places whose part of this room stays within.
fn within(room_m: f64, range_m: f64) -> [f64; 2] {
    let most = 0.5 * room_m.max(0.0);
    [-most, (most - range_m).max(-most)]
}

/// Returns whether a lever multiplies the present value.
fn multiplied(lever: Lever) -> bool {
    use Lever::{ContactTime, Frequency, Limit, StopGap, StopTime};
    matches!(lever, Frequency | ContactTime | StopGap | StopTime | Limit(_))
}

/// Rounds a value to the second digit of a size.
fn to_digits(value: f64, size: f64, way: fn(f64) -> f64) -> f64 {
    if size == 0.0 {
        return value;
    }
    #[expect(clippy::cast_possible_truncation, reason = "a small exponent")]
    let step = 10_f64.powi(libm::log10(size.abs()).floor() as i32 - 1);
    let count = value / step;
    // A value that is a multiple but for roundings counts as one.
    let nearest = count.round();
    let count = if (count - nearest).abs() < 1e-9 * nearest.abs().max(1.0) { nearest } else { way(count) };
    format!("{:.12e}", count * step).parse().unwrap_or(value) + 0.0
}
