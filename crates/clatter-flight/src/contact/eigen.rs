//! Eigenvalues and eigenvectors of a small symmetric matrix.

/// Returns eigenvalues and eigenvectors (columns), by Jacobi's rotations.
pub(crate) fn eigen<const N: usize>(mut a: [[f64; N]; N]) -> ([f64; N], [[f64; N]; N]) {
    let mut v = [[0.0; N]; N];
    for (i, row) in v.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    // Each sweep squares the off-diagonal rest; two points need one.
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..N {
            for q in p + 1..N {
                if a[p][q].abs() <= f64::EPSILON * f64::EPSILON * (a[p][p].abs() + a[q][q].abs()) {
                    continue;
                }
                rotated = true;
                rotate(&mut a, &mut v, p, q);
            }
        }
        if !rotated {
            break;
        }
    }
    (std::array::from_fn(|i| a[i][i]), v)
}

/// Makes the element p, q of the matrix 0.
fn rotate<const N: usize>(a: &mut [[f64; N]; N], v: &mut [[f64; N]; N], p: usize, q: usize) {
    let off = a[p][q];
    let half = 0.5 * (a[q][q] - a[p][p]) / off;
    let t = 1.0_f64.copysign(half) / (half.abs() + (1.0 + half * half).sqrt());
    let c = (1.0 + t * t).sqrt().recip();
    let s = t * c;
    a[p][p] -= t * off;
    a[q][q] += t * off;
    (a[p][q], a[q][p]) = (0.0, 0.0);
    for k in (0..N).filter(|&k| k != p && k != q) {
        let (x, y) = (a[k][p], a[k][q]);
        (a[k][p], a[k][q]) = (c * x - s * y, s * x + c * y);
        (a[p][k], a[q][k]) = (a[k][p], a[k][q]);
    }
    for row in v {
        (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
    }
}

/// The most sweeps: eight points settle in six.
const SWEEPS: usize = 12;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

        /// The columns are orthogonal, and the matrix follows from them.
        #[test]
        fn the_matrix_is_what_its_eigenvectors_make(raw in prop::array::uniform4(prop::array::uniform4(-1.0..1.0_f64)), scale in prop::array::uniform4(-6.0..6.0_f64)) {
            let scale = scale.map(|s| 10f64.powf(s));
            let a: [[f64; 4]; 4] = std::array::from_fn(|i| std::array::from_fn(|j| (raw[i][j] + raw[j][i]) * scale[i] * scale[j]));
            let (lambda, v) = eigen(a);
            let size = lambda.iter().fold(0.0_f64, |m, l| m.max(l.abs()));
            for i in 0..4 {
                for j in 0..4 {
                    let again: f64 = (0..4).map(|k| v[i][k] * lambda[k] * v[j][k]).sum();
                    prop_assert!((again - a[i][j]).abs() <= 1e-14 * size, "{again} {}", a[i][j]);
                    let both: f64 = (0..4).map(|k| v[k][i] * v[k][j]).sum();
                    prop_assert!((both - f64::from(u8::from(i == j))).abs() < 1e-14, "{both}");
                }
            }
        }
    }
}
