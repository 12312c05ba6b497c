//! Columns of tables that hold several products, one column per axis.

use super::length;
use super::rows::{columns, indices, point};
use crate::products::{Product, ProductAxis, Report};

/// Columns of a table for the axes of several products. Each axis occurs once; bands have a column of their own.
#[derive(Clone, Debug)]
pub struct AxisColumns<'a> {
    names: Vec<String>,
    report: &'a Report,
}

/// Cells of the values of one product.
#[derive(Clone, Debug)]
pub struct ProductCells {
    columns: usize,
    /// Length of each dimension.
    lengths: Vec<usize>,
    along: Vec<Vec<AxisTexts>>,
}

/// Texts of the points of an axis.
#[derive(Clone, Debug)]
struct AxisTexts {
    /// Column of the axis, if it has one.
    column: Option<usize>,
    is_band: bool,
    texts: Vec<String>,
}

/// Position of a value in its product, as cells of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisCells {
    /// One cell per axis, empty for an axis that the product does not have.
    pub cells: Vec<String>,
    /// Name of the band; empty without bands.
    pub band: String,
}

const BAND: &str = "band";

impl<'a> AxisColumns<'a> {
    /// Collects the axes of products of a report, in the order in which they occur.
    #[must_use]
    pub fn new<'p>(products: impl IntoIterator<Item = &'p Product>, report: &'a Report) -> Self {
        let mut names: Vec<String> = Vec::new();
        for axis in products.into_iter().flat_map(|product| Self::along(product, report)).flatten()
        {
            if axis.name != BAND && !names.contains(&axis.name) {
                names.push(axis.name);
            }
        }
        Self { names, report }
    }

    /// Names of the axes.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }

    /// Cells of the values of a product.
    #[must_use]
    pub fn cells(&self, product: &Product) -> ProductCells {
        let along = Self::along(product, self.report);
        let column = |axis: &ProductAxis| {
            let column = self.names.iter().position(|name| *name == axis.name);
            let texts = (0..axis.points.len()).map(|index| point(axis, index)).collect();
            AxisTexts { column, is_band: axis.name == BAND, texts }
        };
        ProductCells {
            columns: self.names.len(),
            lengths: along.iter().map(|dimension| length(dimension)).collect(),
            along: along.iter().map(|axes| axes.iter().map(column).collect()).collect(),
        }
    }

    fn along(product: &Product, report: &Report) -> Vec<Vec<ProductAxis>> {
        product.dimensions.iter().map(|dimension| columns(dimension, report)).collect()
    }
}

impl ProductCells {
    /// Number of columns of axes.
    #[must_use]
    pub const fn columns(&self) -> usize {
        self.columns
    }

    /// Cells of the value `row`, the last dimension fastest.
    #[must_use]
    pub fn row(&self, row: usize) -> AxisCells {
        let mut found = AxisCells { cells: vec![String::new(); self.columns], band: String::new() };
        for (axes, index) in self.along.iter().zip(indices(&self.lengths, row)) {
            for AxisTexts { column, is_band, texts } in axes {
                match column {
                    _ if *is_band => found.band.clone_from(&texts[index]),
                    Some(column) => found.cells[*column].clone_from(&texts[index]),
                    None => {}
                }
            }
        }
        found
    }
}
