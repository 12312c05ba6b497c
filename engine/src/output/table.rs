//! A run's results as a short table for a person.

use super::length;
use super::rows::indices;
use crate::products::{AxisPoints, Product, ProductAxis, Report};

/// Rows of one product: points, named points (terms of a ledger), and bands at each.
const POINTS: usize = 5;
const NAMES: usize = 12;
const BANDS: usize = 6;

/// Sensor, product, band and value ± standard error, in aligned columns. Long products are
/// condensed to a few points and bands, evenly spaced, and the number of the others.
#[must_use]
pub fn table(report: &Report) -> String {
    let mut rows = vec![Row::titles()];
    for sensor in &report.sensors {
        let mut name = sensor.name.as_str();
        for product in &sensor.products {
            let first = rows.len();
            product_rows(product, &mut rows);
            if let Some(row) = rows.get_mut(first) {
                name.clone_into(&mut row.sensor);
                name = "";
            }
        }
    }
    lay_out(&rows)
}

#[derive(Debug, Default)]
struct Row {
    sensor: String,
    product: String,
    point: String,
    band: String,
    value: String,
    error: String,
}

impl Row {
    fn titles() -> Self {
        let [sensor, product, point, band, value, error] =
            ["sensor", "product", "at", "band", "value", "standard error"].map(str::to_owned);
        Self { sensor, product, point, band, value, error }
    }

    fn cells(&self) -> [&str; 6] {
        [&self.sensor, &self.product, &self.point, &self.band, &self.value, &self.error]
    }
}

fn product_rows(product: &Product, rows: &mut Vec<Row>) {
    let (across, down) = match product.dimensions.split_last() {
        Some((last, others)) => (last.as_slice(), others),
        None => (&[][..], &[][..]),
    };
    let bands = length(across);
    if bands == 0 || product.values.is_empty() {
        return;
    }
    let points = product.values.len() / bands;
    let named = down.iter().flatten().all(|axis| matches!(axis.points, AxisPoints::Labels(_)));
    let shown = spread(points, if named { NAMES } else { POINTS });
    let mut title = match product.unit.as_str() {
        "" | "1" => product.name.clone(),
        unit => format!("{} [{unit}]", product.name),
    };
    for &point in &shown {
        let mut place = match &product.image {
            Some(image) => format!("mean of {} x {} px", image.width, image.height),
            None => place(down, point),
        };
        for band in spread(bands, BANDS) {
            let index = point * bands + band;
            let error = product.standard_error.get(index).copied().unwrap_or(f64::NAN);
            let (value, error) = number(product.values[index], error);
            rows.push(Row {
                sensor: String::new(),
                product: std::mem::take(&mut title),
                point: std::mem::take(&mut place),
                band: across.first().map_or_else(String::new, |axis| label(axis, band)),
                value,
                error,
            });
        }
        let hidden = bands - spread(bands, BANDS).len();
        if hidden > 0 {
            rows.push(Row { band: format!("({hidden} more)"), ..Row::default() });
        }
    }
    let hidden = points - shown.len();
    if hidden > 0 {
        rows.push(Row { point: format!("({hidden} more)"), ..Row::default() });
    }
}

/// At most `most` of `0..count`, evenly spaced, both ends included.
fn spread(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    (0..most).map(|k| (k * (count - 1) + (most - 1) / 2) / (most - 1)).collect()
}

fn place(dimensions: &[Vec<ProductAxis>], point: usize) -> String {
    let lengths: Vec<usize> = dimensions.iter().map(|dimension| length(dimension)).collect();
    let indices = indices(&lengths, point);
    let axes = dimensions.iter().zip(indices).flat_map(|(axes, index)| {
        axes.iter().map(move |axis| match &axis.points {
            AxisPoints::Labels(_) => label(axis, index),
            AxisPoints::Numbers(_) => match axis.name.rsplit_once('_') {
                Some((name, "deg")) => format!("{name} {}°", label(axis, index)),
                Some((name, unit @ ("m" | "nm" | "s"))) => {
                    format!("{name} {} {unit}", label(axis, index))
                }
                _ => format!("{} {}", axis.name, label(axis, index)),
            },
        })
    });
    axes.collect::<Vec<_>>().join(", ")
}

fn label(axis: &ProductAxis, index: usize) -> String {
    match &axis.points {
        AxisPoints::Labels(labels) => labels.get(index).cloned().unwrap_or_default(),
        AxisPoints::Numbers(numbers) => {
            let number = numbers.get(index).copied().unwrap_or(f64::NAN);
            // Three decimals are enough for a person; `+ 0.0` makes -0 a 0.
            let rounded = (number * 1e3).round() / 1e3 + 0.0;
            rounded.to_string()
        }
    }
}

/// Value and "± error", both to the second significant digit of the error.
fn number(value: f64, error: f64) -> (String, String) {
    if !value.is_finite() {
        return ("no data".to_owned(), String::new());
    }
    let size = value.abs().max(if error.is_finite() { error } else { 0.0 });
    if size == 0.0 {
        return ("0".to_owned(), String::new());
    }
    // Very large and very small numbers share one power of ten.
    let exponent = size.log10().floor() as i32;
    let shift = if (-4..6).contains(&exponent) { 0 } else { exponent };
    let scale = 10_f64.powi(-shift);
    let suffix = if shift == 0 { String::new() } else { format!("e{shift}") };
    let known = error.is_finite() && error > 0.0;
    let digits = if known {
        1 - (error * scale).log10().floor() as i32
    } else {
        5 - (size * scale).log10().floor() as i32
    };
    let digits = usize::try_from(digits).unwrap_or(0).min(12);
    let text = |number: f64| format!("{:.digits$}{suffix}", number * scale);
    (text(value), if known { format!("± {}", text(error)) } else { String::new() })
}

fn lay_out(rows: &[Row]) -> String {
    let width = |text: &str| text.chars().count();
    let mut widths = [0; 6];
    for row in rows {
        for (widest, cell) in widths.iter_mut().zip(row.cells()) {
            *widest = width(cell).max(*widest);
        }
    }
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, (cell, widest)) in row.cells().into_iter().zip(widths).enumerate() {
            let padding = " ".repeat(widest - width(cell));
            // Numbers end at the same place.
            let (before, after) =
                if column == 4 { (padding.as_str(), "") } else { ("", padding.as_str()) };
            for part in [before, cell, after, "  "] {
                line.push_str(part);
            }
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_rounded_to_their_standard_error() {
        let text = |value, error| {
            let (value, error) = number(value, error);
            format!("{value} {error}").trim_end().to_owned()
        };
        assert_eq!(text(0.412_345, 0.001_23), "0.4123 ± 0.0012");
        assert_eq!(text(0.412_345, f64::NAN), "0.412345");
        assert_eq!(text(0.412_345, 0.0), "0.412345");
        assert_eq!(text(123.4, 56.0), "123 ± 56");
        assert_eq!(text(1.234_6e-7, 1.2e-9), "1.235e-7 ± 0.012e-7");
        assert_eq!(text(f64::NAN, f64::NAN), "no data");
        assert_eq!(text(0.0, 0.0), "0");
        assert_eq!(text(0.0, 1e-3), "0.0000 ± 0.0010");
    }

    #[test]
    fn condensed_points_keep_both_ends_and_the_middle() {
        assert_eq!(spread(31, 5), [0, 8, 15, 23, 30]);
        assert_eq!(spread(5, 5), [0, 1, 2, 3, 4]);
        assert_eq!(spread(0, 5), [0; 0]);
    }
}
