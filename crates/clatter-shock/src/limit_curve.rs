//! A limit over frequency, and the margin of a spectrum to it.

use crate::{Error, Margin, Spectrum};

/// The limit of a component or a specification over natural frequency: one value, or straight lines between points on
/// log-log paper.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitCurve(Law);

#[derive(Debug, Clone, PartialEq)]
enum Law {
    Level(f64),
    Points(Vec<(f64, f64)>),
}

const LIST: &str = "limit curve";

/// Returns log₂(b/a), also where the quotient is out of range.
fn octaves(a: f64, b: f64) -> f64 {
    let ratio = b / a;
    if ratio.is_normal() { libm::log2(ratio) } else { libm::log2(b) - libm::log2(a) }
}

impl LimitCurve {
    /// Creates a limit that is the same at every frequency.
    /// # Errors
    /// [`Error::Quantity`] unless it is finite and positive.
    pub fn constant(allowed: f64) -> Result<Self, Error> {
        Ok(Self(Law::Level(crate::error::positive("limit", allowed)?)))
    }
    /// Creates a limit through points (Hz, allowed) in order of frequency, by powers of the frequency between
    /// neighbors; there is no limit outside.
    ///
    /// ```
    /// # use clatter_shock::LimitCurve;
    /// // 6 dB an octave up to 1 kHz, then level
    /// let curve = LimitCurve::new(vec![(10.0, 100.0), (1000.0, 10_000.0), (10_000.0, 10_000.0)])?;
    /// assert!((curve.at(100.0).unwrap() - 1000.0).abs() < 1e-10);
    /// assert_eq!(curve.at(5000.0), Some(10_000.0));
    /// assert_eq!(curve.at(5.0), None);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    /// # Errors
    /// [`Error::Points`] below two points; [`Error::Entry`] for a value that is not finite and positive, or a frequency
    /// not above the one before.
    pub fn new(points: Vec<(f64, f64)>) -> Result<Self, Error> {
        if points.len() < 2 {
            return Err(Error::Points("the limit curve", points.len()));
        }
        let mut previous = 0.0;
        for (i, &(hz, allowed)) in points.iter().enumerate() {
            let entry = |name, value, allowed| Error::Entry { list: LIST, entry: i + 1, name, value, allowed };
            if !(hz > previous && hz.is_finite()) {
                return Err(entry("frequency (Hz)", hz, "finite and above the one before it"));
            }
            if !(allowed > 0.0 && allowed.is_finite()) {
                return Err(entry("limit", allowed, "finite and > 0"));
            }
            previous = hz;
        }
        Ok(Self(Law::Points(points)))
    }
    /// Returns the limit at a frequency; `None` outside of the curve.
    #[must_use]
    pub fn at(&self, hz: f64) -> Option<f64> {
        match &self.0 {
            Law::Level(allowed) => Some(*allowed),
            Law::Points(points) => points.windows(2).find_map(|w| {
                let [(f, a), (g, b)] = [w[0], w[1]];
                (f <= hz && hz <= g).then(|| {
                    let (share, ratio) = (octaves(f, hz) / octaves(f, g), b / a);
                    if ratio.is_normal() {
                        a * libm::pow(ratio, share)
                    } else {
                        libm::exp2(libm::log2(a) + share * octaves(a, b))
                    }
                })
            }),
        }
    }
    /// Returns the curve with all its levels times a factor.
    /// # Errors
    /// Those of [`new`](Self::new), where a level leaves the floats.
    pub fn times(&self, factor: f64) -> Result<Self, Error> {
        match &self.0 {
            Law::Level(allowed) => Self::constant(factor * allowed),
            Law::Points(points) => Self::new(points.iter().map(|&(hz, allowed)| (hz, factor * allowed)).collect()),
        }
    }
    /// Returns its first and last frequency; `None` for a limit that is the same at every frequency.
    #[must_use]
    pub fn range_hz(&self) -> Option<[f64; 2]> {
        match &self.0 {
            Law::Level(_) => None,
            Law::Points(points) => Some([points.first()?.0, points.last()?.0]),
        }
    }
    /// Returns the corners of the curve from one frequency to another, and its points at both; it is straight on
    /// log-log paper in between.
    #[must_use]
    pub fn corners(&self, low_hz: f64, high_hz: f64) -> Vec<(f64, f64)> {
        let corners = if let Law::Points(points) = &self.0 { &points[..] } else { &[] };
        let end = |hz| self.at(hz).map(|allowed| (hz, allowed));
        let between = corners.iter().copied().filter(|(hz, _)| low_hz < *hz && *hz < high_hz);
        end(low_hz).into_iter().chain(between).chain(end(high_hz)).collect()
    }
    /// Returns the margin of the maximax at each frequency of a spectrum.
    ///
    /// The limit is in the unit of the spectrum.
    #[must_use]
    pub fn margins(&self, spectrum: &Spectrum) -> Vec<Option<Margin>> {
        let reached = spectrum.frequency_hz.iter().zip(&spectrum.maximax);
        reached.map(|(&hz, &demand)| Some(Margin { allowed: self.at(hz)?, demand })).collect()
    }
    /// Returns the index of the smallest margin; `None` if the curve covers no frequency of the spectrum.
    #[must_use]
    pub fn worst(margins: &[Option<Margin>]) -> Option<usize> {
        let ratio = |i: &usize| margins[*i].map_or(f64::INFINITY, |m| m.allowed / m.demand);
        let covered = (0..margins.len()).filter(|&i| margins[i].is_some());
        covered.min_by(|a, b| ratio(a).total_cmp(&ratio(b)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corners_between_two_frequencies_come_with_both_ends() {
        let level = LimitCurve::constant(3.0).expect("a limit");
        assert_eq!(level.corners(10.0, 50.0), [(10.0, 3.0), (50.0, 3.0)]);
        let curve = LimitCurve::new(vec![(10.0, 100.0), (1000.0, 10_000.0), (5000.0, 10_000.0)]).expect("a curve");
        let near = curve.corners(100.0, 1001.0);
        assert!(near.len() == 3 && near[1] == (1000.0, 10_000.0), "{near:?}");
        let corners = curve.corners(100.0, 1e5);
        assert_eq!(corners.len(), 3, "{corners:?}: nothing is allowed or not beyond its end");
        assert!((corners[0].1 - 1000.0).abs() < 1e-9 && corners[1..] == [(1000.0, 10_000.0), (5000.0, 10_000.0)]);
    }

    #[test]
    fn curves_over_the_whole_range_of_numbers_are_straight() {
        let curve = LimitCurve::new(vec![(5e-324, 1e308), (1e308, 5e-324)]).expect("as the test has it");
        let mut before = f64::INFINITY;
        for hz in [5e-324, 1e-300, 1e-100, 1.0, 1e100, 1e300, 1e308] {
            let allowed = curve.at(hz).expect("within the curve");
            assert!((0.0..=1.01e308).contains(&allowed) && allowed <= before, "{hz}: {allowed}");
            before = allowed;
        }
        // This frequency is in the middle of both logarithms.
        let middle = 5e-324_f64.log2().midpoint(1e308_f64.log2());
        let allowed = curve.at(middle.exp2()).expect("within the curve");
        assert!((allowed.log2() - middle).abs() < 1e-9, "{allowed}");
    }

    #[test]
    fn a_corner_at_an_end_is_told_once() {
        let points = vec![(10.0, 100.0), (1000.0, 10_000.0), (5000.0, 10_000.0)];
        let curve = LimitCurve::new(points).expect("a curve");
        for (ends, count) in [([10.0, 5000.0], 3), ([1000.0, 5000.0], 2), ([10.0, 1000.0], 2), ([500.0, 2000.0], 3)] {
            let corners = curve.corners(ends[0], ends[1]);
            assert_eq!(corners.len(), count, "{corners:?}");
            assert!(corners.windows(2).all(|w| w[0].0 < w[1].0), "{corners:?}");
        }
    }
}
