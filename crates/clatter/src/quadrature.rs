//! Adaptive integration of a function of one variable.

/// An integral and a bound on the error of the quadrature.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Integral {
    /// The value.
    pub value: f64,
    /// Sum of the differences between the Kronrod and the Gauss rule, a generous bound.
    pub error: f64,
}

/// Nodes and weights of Gauss–Kronrod 7/15 on [−1, 1], positive half: node, Kronrod weight, Gauss weight
/// (QUADPACK, `qk15`).
const RULE: [(f64, f64, f64); 8] = [
    (0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0),
    (0.949_107_912_342_758_5, 0.063_092_092_629_978_55, 0.129_484_966_168_869_68),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0),
    (0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_64),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9),
    (0.207_784_955_007_898_47, 0.204_432_940_075_298_89, 0.0),
    (0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4),
];

/// Integrates `f` over the intervals between ascending `breaks`, halving each until the two rules agree within
/// `tolerance` per interval of the size of all, or to rounding, or until 10 000 intervals are spent.
///
/// ```
/// let third = clatter::quadrature::integrate(|x| x * x, &[0.0, 1.0], 1e-12);
/// assert!((third.value - 1.0 / 3.0).abs() < 1e-15);
/// ```
pub fn integrate(f: impl Fn(f64) -> f64, breaks: &[f64], tolerance: f64) -> Integral {
    let mut total = Integral { value: 0.0, error: 0.0 };
    let mut spent = 0;
    let length = breaks.last().zip(breaks.first()).map_or(0.0, |(b, a)| b - a);
    for pair in breaks.windows(2) {
        let mut open = vec![(pair[0], pair[1])];
        while let Some((a, b)) = open.pop() {
            spent += 1;
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            let (mut kronrod, mut gauss) = (0.0, 0.0);
            for (node, wk, wg) in RULE {
                let mut y = f(middle + half * node);
                if node > 0.0 {
                    y += f(middle - half * node);
                }
                (kronrod, gauss) = (kronrod + wk * y, gauss + wg * y);
            }
            let error = half * (kronrod - gauss).abs();
            let allowed = (tolerance * (b - a) / length).max(16.0 * f64::EPSILON * half * kronrod.abs());
            if error > allowed && spent < 10_000 {
                open.extend([(middle, b), (a, middle)]);
            } else {
                total = Integral { value: total.value + half * kronrod, error: total.error + error };
            }
        }
    }
    total
}

#[cfg(test)]
mod tests {
    use super::integrate;

    #[test]
    fn polynomials_of_degree_22_are_exact() {
        let cases = [(0, 1.0), (1, 0.5), (13, 1.0 / 14.0), (22, 1.0 / 23.0)];
        for (degree, want) in cases {
            let got = integrate(|x| x.powi(degree), &[0.0, 1.0], 1.0);
            assert!((got.value - want).abs() < 4.0 * f64::EPSILON, "x^{degree}: {got:?}");
        }
    }

    #[test]
    fn a_kink_and_a_root_are_found_within_the_stated_error() {
        let cases = [(f64::sqrt as fn(f64) -> f64, 2.0 / 3.0), (|x| (x - 0.3).abs(), 0.29)];
        for (f, want) in cases {
            let got = integrate(f, &[0.0, 1.0], 1e-11);
            assert!((got.value - want).abs() <= got.error + 1e-15, "{got:?}, not {want}");
            assert!(got.error < 1e-10, "{got:?}");
        }
    }
}
