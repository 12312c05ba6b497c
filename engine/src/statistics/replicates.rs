//! Sums with the deviations from which the standard error of any function of them follows.

/// Sums, and independent deviations from them that vary and covary as the errors of the sums do.
///
/// With `δ_k` the `k`-th row of deviations, the variance of a linear function of the sums is the mean of its
/// squares at `δ_k`; for any other function, this holds of its differential (the delta method).
///
/// Source: Wolter (2007), "Introduction to variance estimation", chapters 3 (half-samples) and 6 (linearised
/// estimators).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Replicates {
    /// Sums, shape `[values]`.
    pub sums: Vec<f64>,
    /// Deviations, shape `[replicates, values]`; empty if the error is unknown.
    pub deviations: Vec<f64>,
}

impl Replicates {
    /// Replicates of independent randomisations of the same sums: the deviations of these from their mean.
    #[must_use]
    pub fn from_randomisations(rows: &[&[f64]]) -> Self {
        let values = rows.first().map_or(0, |row| row.len());
        let sums: Vec<f64> =
            (0..values).map(|value| rows.iter().map(|row| row[value]).sum()).collect();
        let n = rows.len() as f64;
        if rows.len() < 2 {
            return Self { sums, deviations: Vec::new() };
        }
        let scale = n / (n - 1.0).sqrt();
        let deviation = |(value, sum): (&f64, &f64)| scale * (value - sum / n);
        let deviations = rows.iter().flat_map(|row| row.iter().zip(&sums).map(deviation));
        Self { deviations: deviations.collect(), sums }
    }

    /// Replicates of half-samples. Each stratum is sampled by two independent nets; each replicate takes one net of
    /// every stratum, drawn at random.
    ///
    /// - `nets`: sums over all strata by net, shape `[2][values]`
    /// - `halves`: sums over the strata from which a replicate takes this net, shape `[replicates][2][values]`
    /// - `samples`: number of samples of each stratum by net
    ///
    /// Source: `McCarthy` (1969), "Pseudo-replication: half samples", Rev. Int. Stat. Inst. 37, 239-264.
    #[must_use]
    pub fn from_half_samples(nets: [&[f64]; 2], halves: &[[&[f64]; 2]], samples: [f64; 2]) -> Self {
        let [a, b] = samples;
        let sums: Vec<f64> = nets[0].iter().zip(nets[1]).map(|(a, b)| a + b).collect();
        if a <= 0.0 || b <= 0.0 {
            return Self { sums, deviations: Vec::new() };
        }
        // Half of the difference between the nets' means varies as the mean of both; with unequal numbers of
        // samples, that of all of them varies less.
        let scale = 2.0 * (a * b).sqrt();
        let deviation = |half: &[&[f64]; 2], value: usize| {
            let of_net = |net: usize| (half[net][value] - 0.5 * nets[net][value]) / samples[net];
            scale * (of_net(0) + of_net(1))
        };
        let deviations = halves
            .iter()
            .flat_map(|half| (0..sums.len()).map(move |value| deviation(half, value)))
            .collect();
        Self { sums, deviations }
    }

    /// Standard error of a function of the sums from its differential: index and partial derivative for each sum that
    /// it depends on; NaN if the error is unknown.
    #[must_use]
    pub fn standard_error(&self, slopes: &[(usize, f64)]) -> f64 {
        let values = self.sums.len().max(1);
        let rows = self.deviations.chunks_exact(values);
        let count = rows.len() as f64;
        let change =
            |row: &[f64]| slopes.iter().map(|&(index, slope)| slope * row[index]).sum::<f64>();
        (rows.map(|row| change(row).powi(2)).sum::<f64>() / count).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn randomisations_that_go_together_or_apart_show_in_sums_and_differences() {
        let rows: [&[f64]; 3] = [&[1.0, 2.0], &[3.0, 4.0], &[5.0, 6.0]];
        let replicates = Replicates::from_randomisations(&rows);
        assert_eq!(replicates.sums, [9.0, 12.0]);
        // Three times the error of the mean of 1, 3 and 5, `√(8 / (3 · 2))`.
        let one = 3.0 * (8.0_f64 / 6.0).sqrt();
        assert!((replicates.standard_error(&[(0, 1.0)]) - one).abs() < 1e-12);
        assert!((replicates.standard_error(&[(0, 1.0), (1, 1.0)]) - 2.0 * one).abs() < 1e-12);
        assert!(replicates.standard_error(&[(0, 1.0), (1, -1.0)]) < 1e-12);
    }

    /// Two strata whose nets differ by 2 and by 4: the variance of the sum of all is 2² + 4², whatever the
    /// strata themselves differ by.
    #[test]
    fn half_samples_leave_out_what_strata_differ_by() {
        let strata = [[10.0, 12.0], [100.0, 104.0]];
        let nets: [Vec<f64>; 2] = [0, 1].map(|net| vec![strata[0][net] + strata[1][net]]);
        // All four choices, so that cross terms cancel.
        let halves: Vec<[Vec<f64>; 2]> = (0..4)
            .map(|choice| {
                let of = |net: usize| {
                    (0..2).filter(|at| choice >> at & 1 == net).map(|at| strata[at][net]).sum()
                };
                [vec![of(0)], vec![of(1)]]
            })
            .collect();
        let halves: Vec<[&[f64]; 2]> = halves.iter().map(|[a, b]| [&a[..], &b[..]]).collect();
        let replicates = Replicates::from_half_samples([&nets[0], &nets[1]], &halves, [1.0, 1.0]);
        assert_eq!(replicates.sums, [226.0]);
        assert!((replicates.standard_error(&[(0, 1.0)]) - 20.0_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn of_one_net_nothing_is_known() {
        let one = Replicates::from_half_samples([&[3.0], &[0.0]], &[], [1.0, 0.0]);
        assert!(one.standard_error(&[(0, 1.0)]).is_nan());
    }
}
