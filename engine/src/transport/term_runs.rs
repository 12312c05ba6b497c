//! Evaluation of many terms in many bands.

use std::ops::Range;

use super::band_blocks::BLOCK;
use super::spectrum_products::ProductId;
use crate::statistics::Sums;

/// Products whose values in a block of bands stay in the second-level cache while all cells take what they need of them.
const PRODUCTS: usize = 1 << 10;

/// Values of a cell that stay in registers while terms are added to them.
const WIDTH: usize = 32;

/// Terms by groups of products and by cell: a cell is loaded and stored once for all of its terms of a group.
///
/// Each cell receives its terms in the order of their products, as it would one by one, and so the same sums bit for bit.
#[derive(Debug, Default)]
pub(super) struct TermRuns {
    runs: Vec<TermRun>,
    terms: Vec<RunTerm>,
}

/// Terms of a cell in a group of products.
#[derive(Debug)]
struct TermRun {
    sums: usize,
    /// First value of the cell.
    start: usize,
    terms: Range<usize>,
}

#[derive(Clone, Copy, Debug)]
struct RunTerm {
    product: ProductId,
    coefficient: f64,
}

/// A term, the sums that it is added to, and the first value of its cell in these.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedTerm {
    pub(super) product: ProductId,
    pub(super) coefficient: f64,
    pub(super) sums: usize,
    pub(super) start: usize,
}

impl TermRuns {
    /// Runs of terms that are in the order of their products.
    pub(super) fn new(mut placed: Vec<PlacedTerm>) -> Self {
        placed.sort_by_key(|term| (term.product / PRODUCTS, term.sums, term.start));
        let mut runs = Self::default();
        let is_run = |a: &PlacedTerm, b: &PlacedTerm| {
            (a.product / PRODUCTS, a.sums, a.start) == (b.product / PRODUCTS, b.sums, b.start)
        };
        for run in placed.chunk_by(is_run) {
            let first = runs.terms.len();
            let term = |term: &PlacedTerm| RunTerm {
                product: term.product,
                coefficient: term.coefficient,
            };
            runs.terms.extend(run.iter().map(term));
            let terms = first..runs.terms.len();
            runs.runs.push(TermRun { sums: run[0].sums, start: run[0].start, terms });
        }
        runs
    }

    /// Adds the values of all terms in a block of bands; `values` are those of the products, shape `[products, bands]`.
    #[inline(always)]
    pub(super) fn add_to(
        &self,
        block: &Range<usize>,
        values: &[f64],
        sums: &mut [Option<&mut Sums>],
    ) {
        let width = block.len();
        for TermRun { sums: index, start, terms } in &self.runs {
            let Some(sums) = &mut sums[*index] else { continue };
            let cell = &mut sums.values_mut()[start + block.start..start + block.end];
            let terms = &self.terms[terms.clone()];
            let row = |term: &RunTerm| &values[term.product * width..(term.product + 1) * width];
            let (groups, rest) = cell.as_chunks_mut::<WIDTH>();
            for (group, sums) in groups.iter_mut().enumerate() {
                let mut total = *sums;
                for term in terms {
                    let row = &row(term)[group * WIDTH..(group + 1) * WIDTH];
                    for (total, value) in total.iter_mut().zip(row) {
                        *total += value * term.coefficient;
                    }
                }
                *sums = total;
            }
            let first = width - rest.len();
            for term in terms {
                for (sum, value) in rest.iter_mut().zip(&row(term)[first..]) {
                    *sum += value * term.coefficient;
                }
            }
        }
    }
}

const _: () = assert!(BLOCK.is_multiple_of(WIDTH), "whole blocks have no rest");

#[cfg(test)]
mod tests {
    use super::*;

    /// Terms of thousands of products in cells of two sums. *Expected*: the same bits as term by term, in whole blocks and
    /// in a part of one.
    #[test]
    fn runs_add_what_single_terms_add() {
        let (products, cells, bands) = (3 * PRODUCTS + 5, 4, BLOCK + 41);
        let mut state = 1_u64;
        let mut random = |below: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as usize % below
        };
        let mut placed: Vec<PlacedTerm> = (0..20_000)
            .map(|_| PlacedTerm {
                product: random(products),
                coefficient: random(1000) as f64 / 7.0,
                sums: random(2),
                start: random(cells) * bands,
            })
            .collect();
        placed.sort_by_key(|term| term.product);
        let values: Vec<f64> =
            (0..products * BLOCK).map(|_| random(1000) as f64 / 1000.0).collect();
        let mut sums = [Sums::new(cells, bands), Sums::new(cells, bands)];
        let mut expected = sums.clone();
        for block in [0..BLOCK, BLOCK..bands] {
            for term in &placed {
                for (column, band) in block.clone().enumerate() {
                    let value = values[term.product * block.len() + column];
                    expected[term.sums].values_mut()[term.start + band] += value * term.coefficient;
                }
            }
            let runs = TermRuns::new(placed.clone());
            assert!(runs.runs.len() > 3 * 2 * cells, "several groups of products");
            let [a, b] = &mut sums;
            runs.add_to(&block, &values, &mut [Some(a), Some(b)]);
        }
        assert_eq!(sums, expected);
    }
}
