//! Small systems of linear equations.

/// Inverse of a symmetric positive definite matrix by Cholesky's decomposition `M = L Lᵀ`; `None` if it is not positive
/// definite.
pub(super) fn inverse<const N: usize>(matrix: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let mut lower = [[0.0; N]; N];
    for row in 0..N {
        for column in 0..=row {
            let known: f64 = (0..column).map(|at| lower[row][at] * lower[column][at]).sum();
            let rest = matrix[row][column] - known;
            lower[row][column] = if row == column {
                if !(rest > 0.0 && rest.is_finite()) {
                    return None;
                }
                rest.sqrt()
            } else {
                rest / lower[column][column]
            };
        }
    }
    // Columns of the inverse are its rows.
    Some(std::array::from_fn(|column| {
        // `L y = e`, then `Lᵀ x = y`.
        let mut x = [0.0; N];
        for row in 0..N {
            let known: f64 = (0..row).map(|at| lower[row][at] * x[at]).sum();
            x[row] = (f64::from(u8::from(row == column)) - known) / lower[row][row];
        }
        for row in (0..N).rev() {
            let known: f64 = (row + 1..N).map(|at| lower[at][row] * x[at]).sum();
            x[row] = (x[row] - known) / lower[row][row];
        }
        x
    }))
}

#[cfg(test)]
mod tests {
    use super::inverse;

    #[test]
    fn a_matrix_times_its_inverse_is_one() {
        let matrix = [[4.0, 1.0, 0.5], [1.0, 3.0, -1.0], [0.5, -1.0, 2.0]];
        let inverse = inverse(&matrix).expect("positive definite");
        for (row, values) in matrix.iter().enumerate() {
            let products: [f64; 3] = std::array::from_fn(|column| {
                values.iter().zip(&inverse).map(|(value, row)| value * row[column]).sum()
            });
            for (column, product) in products.into_iter().enumerate() {
                let expected = f64::from(u8::from(row == column));
                assert!((product - expected).abs() < 1e-14, "{row} {column}: {product}");
            }
        }
        assert!(super::inverse(&[[1.0, 2.0], [2.0, 1.0]]).is_none());
        assert!(super::inverse(&[[f64::NAN]]).is_none());
    }
}
