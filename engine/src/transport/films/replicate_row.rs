use std::borrow::Cow;

use rayon::prelude::*;

use crate::scattering::SurfaceModels;
use crate::statistics::Sums;
use crate::transport::coefficients::Coefficients;

/// Sums of a block of samples or of a randomisation, and terms of them that are still to be evaluated.
#[derive(Clone, Debug, Default)]
pub(in crate::transport) struct ReplicateRow {
    pub(in crate::transport) sums: Vec<Sums>,
    /// Terms; `None` if there are none.
    pub(in crate::transport) coefficients: Option<Coefficients>,
}

impl ReplicateRow {
    /// Terms are evaluated beyond this many.
    const MOST_TERMS: usize = 1 << 16;

    /// Terms are evaluated beyond this many products.
    pub(in crate::transport) const MOST_PRODUCTS: usize = 1 << 13;

    /// Fraction of the largest combination below which terms are not evaluated: a thousandth of what a balance may be off
    /// by.
    const ROUNDING: f64 = 1e-12;

    /// Adds the sums of a block.
    pub(super) fn merge(&mut self, part: &Self, models: Option<&SurfaceModels>) {
        for (total, part) in self.sums.iter_mut().zip(&part.sums) {
            total.merge(part);
        }
        let Some(part) = part.coefficients.as_ref().filter(|terms| !terms.is_empty()) else {
            return;
        };
        let terms = self.coefficients.get_or_insert_with(|| Coefficients::like(part));
        terms.absorb(part);
        if terms.exceeds(Self::MOST_TERMS, Self::MOST_PRODUCTS) {
            self.evaluate(models);
        }
    }

    /// Returns whether something was added to the sums beside the terms.
    pub(super) fn has_sums(&self) -> bool {
        self.sums.iter().any(Sums::has_values)
    }

    /// Adds the values of all terms to the sums.
    pub(super) fn evaluate(&mut self, models: Option<&SurfaceModels>) {
        if let (Some(terms), Some(models)) = (&mut self.coefficients, models) {
            terms.flush(models, 0..models.spectra.bands(), &mut self.sums);
        }
    }

    /// One of the sums of each row, all of its terms evaluated. Products that rows share are evaluated once a thread.
    pub(super) fn evaluated<'r>(
        rows: &[&'r Self],
        index: usize,
        models: Option<&SurfaceModels>,
    ) -> Vec<Cow<'r, Sums>> {
        let each = rows.len().div_ceil(rayon::current_num_threads()).max(1);
        let evaluated = |rows: &[&'r Self]| -> Vec<Cow<'r, Sums>> {
            let mut sums: Vec<_> = rows.iter().map(|row| Cow::Borrowed(&row.sums[index])).collect();
            let Some(models) = models else { return sums };
            let all = rows.iter().map(|row| row.coefficients.as_ref());
            let terms = Coefficients::combined(all, index, |cell| [(cell, 1.0)]);
            if !terms.is_empty() {
                let mut into: Vec<_> = sums.iter_mut().map(|sums| Some(sums.to_mut())).collect();
                terms.add_to(models, 0..models.spectra.bands(), &mut into);
            }
            sums
        };
        rows.par_chunks(each).flat_map_iter(evaluated).collect()
    }

    /// Combinations of the cells of one of the sums of each row, all of its terms evaluated: each cell is added to some of
    /// the `count` combinations with the weights that a function returns for it. Of terms that cancel but for
    /// [`Self::ROUNDING`], a bound is added, away from zero.
    pub(in crate::transport) fn combined<W: IntoIterator<Item = (usize, f64)>>(
        rows: &[&Self],
        index: usize,
        models: Option<&SurfaceModels>,
        count: usize,
        weights: impl Fn(usize) -> W,
    ) -> Vec<Sums> {
        let combined = |row: &&Self| {
            let sums = &row.sums[index];
            let (ordered, mut buffer) = (sums.ordered(), Vec::new());
            let mut combined = Sums::new(count, sums.bands());
            for cell in 0..sums.cells() {
                let values = ordered.values(cell..cell + 1, &mut buffer);
                for (into, weight) in weights(cell) {
                    let into = combined.cell_mut(into).iter_mut().zip(values);
                    into.for_each(|(sum, value)| *sum += value * weight);
                }
            }
            combined
        };
        let mut combined: Vec<Sums> = rows.iter().map(combined).collect();
        let all = rows.iter().map(|row| row.coefficients.as_ref());
        let mut terms = Coefficients::combined(all, index, weights);
        if let Some(models) = models.filter(|_| !terms.is_empty()) {
            let bounds = terms.without_negligible(combined.len(), count, Self::ROUNDING);
            for (combined, bounds) in combined.iter_mut().zip(bounds.chunks(count)) {
                for (cell, bound) in bounds.iter().enumerate() {
                    let values = combined.cell_mut(cell).iter_mut();
                    values.for_each(|value| *value += bound.copysign(*value));
                }
            }
            let mut into: Vec<_> = combined.iter_mut().map(Some).collect();
            terms.add_to(models, 0..models.spectra.bands(), &mut into);
        }
        combined
    }
}
