//! Columns of tables that hold several products, one column per axis.

use super::rows::{columns, indices, point};
use crate::products::{Product, ProductAxis, Report};

/// Columns of a table for the axes of several products. Each axis occurs once; bands have a column of their own.
#[derive(Clone, Debug)]
pub struct AxisColumns<'a> {
    names: Vec<String>,
    report: &'a Report,
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

    /// Cells of the value `row` of a product.
    #[must_use]
    pub fn place(&self, product: &Product, row: usize) -> AxisCells {
        let mut place =
            AxisCells { cells: vec![String::new(); self.names.len()], band: String::new() };
        let places = indices(&product.dimensions, row);
        for (dimension, index) in Self::along(product, self.report).iter().zip(places) {
            for axis in dimension {
                let text = point(axis, index);
                if axis.name == BAND {
                    place.band = text;
                } else if let Some(at) = self.names.iter().position(|name| *name == axis.name) {
                    place.cells[at] = text;
                }
            }
        }
        place
    }

    fn along(product: &Product, report: &Report) -> Vec<Vec<ProductAxis>> {
        product.dimensions.iter().map(|dimension| columns(dimension, report)).collect()
    }
}
