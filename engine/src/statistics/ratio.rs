/// Mean over samples whose number is itself random, with its standard error: `Σ sums / Σ counts`.
///
/// - `sums`: sums of each randomisation, shape `[randomisations, bands]`
/// - `counts`: samples that count in each randomisation, shape `[randomisations]`
/// - returns: mean and standard error, shape `[bands]`; NaN where nothing counts, and a standard error of
///   NaN for fewer than two randomisations
///
/// With equal counts this is the mean of means and its standard error.
///
/// Source: Cochran (1977), "Sampling techniques", eq. 2.40: the linearised error of a ratio.
#[must_use]
pub fn ratio(sums: &[f64], counts: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let bands = sums.len() / counts.len().max(1);
    let n = counts.len() as f64;
    let total: f64 = counts.iter().sum();
    let mean: Vec<f64> =
        (0..bands).map(|band| sums.iter().skip(band).step_by(bands).sum::<f64>() / total).collect();
    let error = (0..bands).map(|band| {
        let sums_of_band = sums.iter().skip(band).step_by(bands);
        let squares: f64 =
            sums_of_band.zip(counts).map(|(sum, count)| (sum - mean[band] * count).powi(2)).sum();
        (squares / (n * (n - 1.0))).sqrt() / (total / n)
    });
    let error = error.collect();
    (mean, error)
}

#[cfg(test)]
mod tests {
    use super::ratio;
    use crate::statistics::Spread;

    #[test]
    fn with_equal_counts_a_ratio_is_a_mean_of_means() {
        let (mean, error) = ratio(&[2.0, 20.0, 4.0, 60.0, 9.0, 10.0], &[2.0, 2.0, 2.0]);
        let rows = [[1.0, 10.0], [2.0, 30.0], [4.5, 5.0]];
        let spread = Spread::from_rows(2, rows.iter().map(<[f64; 2]>::as_slice));
        for band in 0..2 {
            assert!((mean[band] - spread.mean()[band]).abs() < 1e-12);
            assert!((error[band] - spread.standard_error()[band]).abs() < 1e-12);
        }
    }

    #[test]
    fn where_nothing_counts_there_is_no_mean() {
        assert!(ratio(&[0.0, 0.0], &[0.0, 0.0]).0[0].is_nan());
    }
}
