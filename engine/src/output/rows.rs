//! CSV of a product that is no image: provenance as comment lines, then one row a point.

use std::io::{self, Write};

use super::names::Distinct;
use super::provenance::RecipeForm;
use super::{Source, length};
use crate::products::{AxisPoints, ProductAxis, Report};

/// Writes a column an axis and, for each point of the last dimension, its value and standard error.
pub(super) fn write(source: &Source<'_>, file: &mut impl Write) -> io::Result<()> {
    for (key, value) in source.provenance(RecipeForm::Packed) {
        writeln!(file, "# {key}: {}", harmless_line(&value))?;
    }
    let product = source.product;
    let (across, down) = match product.dimensions.split_last() {
        Some((last, others)) => (last.as_slice(), others),
        None => (&[][..], &[][..]),
    };
    let down: Vec<Vec<ProductAxis>> =
        down.iter().map(|dimension| columns(dimension, source.report)).collect();
    let mut names = Distinct::default();
    let mut header: Vec<String> =
        down.iter().flatten().map(|axis| names.take(&harmless(&axis.name))).collect();
    for column in 0..length(across) {
        let name = across.first().map_or_else(|| "value".to_owned(), |axis| heading(axis, column));
        let name = names.take(&harmless(&name));
        header.push(name.clone());
        header.push(names.take(&format!("{name}_se")));
    }
    let mut writer = csv::WriterBuilder::new().comment(Some(b'#')).from_writer(&mut *file);
    writer.write_record(&header)?;
    let columns = length(across);
    if columns == 0 {
        return writer.flush();
    }
    let lengths: Vec<usize> = down.iter().map(|dimension| length(dimension)).collect();
    let rows =
        product.values.chunks_exact(columns).zip(product.standard_error.chunks_exact(columns));
    for (row, (values, errors)) in rows.enumerate() {
        let mut record: Vec<String> = Vec::with_capacity(header.len());
        for (dimension, index) in down.iter().zip(indices(&lengths, row)) {
            record.extend(dimension.iter().map(|axis| harmless(&point(axis, index))));
        }
        for (value, error) in values.iter().zip(errors) {
            record.extend([number(*value), number(*error)]);
        }
        writer.write_record(&record)?;
    }
    writer.flush()
}

/// Axes of a dimension as columns: of directions, the zenith angle with a sign too, as a plot through
/// the nadir needs it. It is positive within 90° of the sun's azimuth (of north, without a sun) and
/// 90° clockwise of it, negative on the other side.
pub(super) fn columns(dimension: &[ProductAxis], report: &Report) -> Vec<ProductAxis> {
    let mut columns = dimension.to_vec();
    let numbers = |name: &str| {
        let axis = dimension.iter().position(|axis| axis.name == name)?;
        match &dimension[axis].points {
            AxisPoints::Numbers(numbers) => Some((axis, numbers)),
            AxisPoints::Labels(_) => None,
        }
    };
    if let (Some((_, zenith)), Some((place, azimuth))) =
        (numbers("zenith_deg"), numbers("azimuth_deg"))
    {
        let sun = report.sun_azimuth_deg.unwrap_or(0.0);
        let sign = |azimuth: f64| {
            // From -90 (excluded) to 90 is the sun's side; degrees are rounded to 1e-9.
            let beside = (azimuth - sun + 90.0).rem_euclid(360.0);
            if beside > 1e-6 && beside < 180.0 + 1e-6 { 1.0 } else { -1.0 }
        };
        let signed = |(&zenith, &azimuth)| if zenith == 0.0 { 0.0 } else { zenith * sign(azimuth) };
        let points = AxisPoints::Numbers(zenith.iter().zip(azimuth).map(signed).collect());
        columns.insert(place + 1, ProductAxis { name: "signed_zenith_deg".to_owned(), points });
    }
    columns
}

/// A text as a cell that no spreadsheet takes for a formula: one that begins with `=`, `+`, `-`, `@`, a
/// tab or a line end and is no number gets an apostrophe in front of it.
#[must_use]
pub fn harmless(text: &str) -> String {
    if text.starts_with(['=', '+', '-', '@', '\t', '\r', '\n']) && text.parse::<f64>().is_err() {
        format!("'{text}")
    } else {
        text.to_owned()
    }
}

/// Makes a comment line harmless, which a spreadsheet splits into cells.
fn harmless_line(text: &str) -> String {
    let cells = text.split_inclusive([',', ';', '\t']);
    let cell = |cell: &str| {
        let start = cell.trim_start();
        let (space, rest) = cell.split_at(cell.len() - start.len());
        format!("{space}{}", harmless(rest))
    };
    cells.map(cell).collect()
}

/// Index along each dimension, of these lengths, of the `row`-th point; the last dimension is the fastest.
pub(super) fn indices(lengths: &[usize], row: usize) -> Vec<usize> {
    let mut rest = row;
    let mut indices: Vec<_> = lengths
        .iter()
        .rev()
        .map(|&points| {
            let index = rest % points.max(1);
            rest /= points.max(1);
            index
        })
        .collect();
    indices.reverse();
    indices
}

fn heading(axis: &ProductAxis, index: usize) -> String {
    match &axis.points {
        AxisPoints::Labels(labels) => labels[index].clone(),
        AxisPoints::Numbers(_) => format!("{}={}", axis.name, point(axis, index)),
    }
}

pub(super) fn point(axis: &ProductAxis, index: usize) -> String {
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
