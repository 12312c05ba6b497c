//! CSV of a product that is no image: provenance as comment lines, then one row a point.

use std::io::{self, Write};

use super::names::Distinct;
use super::{Source, length};
use crate::products::{Axis, AxisPoints};

/// Writes a column an axis and, for each point of the last dimension, its value and standard error.
pub(super) fn write(source: &Source<'_>, file: &mut impl Write) -> io::Result<()> {
    for (key, value) in source.provenance() {
        writeln!(file, "# {key}: {value}")?;
    }
    let product = source.product;
    let (across, down) = match product.dimensions.split_last() {
        Some((last, others)) => (last.as_slice(), others),
        None => (&[][..], &[][..]),
    };
    let mut names = Distinct::default();
    let mut header: Vec<String> =
        down.iter().flatten().map(|axis| names.take(&axis.name)).collect();
    for column in 0..length(across) {
        let name = across.first().map_or_else(|| "value".to_owned(), |axis| heading(axis, column));
        let name = names.take(&name);
        header.push(name.clone());
        header.push(names.take(&format!("{name}_se")));
    }
    let mut writer = csv::WriterBuilder::new().from_writer(&mut *file);
    writer.write_record(&header)?;
    let columns = length(across);
    if columns == 0 {
        return writer.flush();
    }
    let rows =
        product.values.chunks_exact(columns).zip(product.standard_error.chunks_exact(columns));
    for (row, (values, errors)) in rows.enumerate() {
        let mut record: Vec<String> = Vec::with_capacity(header.len());
        for (dimension, index) in down.iter().zip(indices(down, row)) {
            record.extend(dimension.iter().map(|axis| point(axis, index)));
        }
        for (value, error) in values.iter().zip(errors) {
            record.extend([number(*value), number(*error)]);
        }
        writer.write_record(&record)?;
    }
    writer.flush()
}

/// Index along each dimension of the `row`-th point, last dimension fastest.
pub(super) fn indices(dimensions: &[Vec<Axis>], row: usize) -> Vec<usize> {
    let mut rest = row;
    let mut indices: Vec<_> = dimensions
        .iter()
        .rev()
        .map(|dimension| {
            let points = length(dimension).max(1);
            let index = rest % points;
            rest /= points;
            index
        })
        .collect();
    indices.reverse();
    indices
}

fn heading(axis: &Axis, index: usize) -> String {
    match &axis.points {
        AxisPoints::Labels(labels) => labels[index].clone(),
        AxisPoints::Numbers(_) => format!("{}={}", axis.name, point(axis, index)),
    }
}

pub(super) fn point(axis: &Axis, index: usize) -> String {
    match &axis.points {
        AxisPoints::Labels(labels) => labels[index].clone(),
        AxisPoints::Numbers(numbers) => number(numbers[index]),
    }
}

/// The shortest text that reads back as the same number.
#[must_use]
pub fn number(value: f64) -> String {
    format!("{value:?}")
}
