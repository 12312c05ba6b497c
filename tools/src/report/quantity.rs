//! A product with the points of its axes.

use anyhow::bail;

use super::summary::Points;
use super::words::short;

/// Name of the axis of bands.
const BAND: &str = "band";

/// A product of a sensor, the last dimension fastest.
#[derive(Clone, Debug)]
pub(super) struct Quantity {
    pub(super) sensor: String,
    pub(super) name: String,
    pub(super) unit: String,
    /// Parallel axes of each dimension, with their names.
    pub(super) dimensions: Vec<Vec<(String, Points)>>,
    /// NaN without data.
    pub(super) values: Vec<f64>,
    /// Standard errors; NaN where they are unknown.
    pub(super) errors: Vec<f64>,
    /// Names of its files.
    pub(super) files: Vec<String>,
}

impl Quantity {
    /// Checks that there are as many values as the axes say.
    pub(super) fn new(quantity: Self) -> anyhow::Result<Self> {
        let Self { sensor, name, .. } = &quantity;
        for axes in &quantity.dimensions {
            let length = axes.first().map_or(0, |(_, points)| points.len());
            if let Some((axis, _)) = axes.iter().find(|(_, points)| points.len() != length) {
                bail!(
                    "sensors.{}.{}: {axis} has another length than its axis",
                    short(sensor),
                    short(name)
                );
            }
        }
        let expected =
            quantity.lengths().iter().try_fold(1_usize, |all, one| all.checked_mul(*one));
        for found in [quantity.values.len(), quantity.errors.len()] {
            if Some(found) != expected {
                bail!(
                    "sensors.{}.{} has {found} values or errors, and other numbers of points on its axes",
                    short(sensor),
                    short(name)
                );
            }
        }
        Ok(quantity)
    }

    /// Number of points along each dimension.
    pub(super) fn lengths(&self) -> Vec<usize> {
        self.dimensions
            .iter()
            .map(|axes| axes.first().map_or(1, |(_, points)| points.len()))
            .collect()
    }

    /// Points of an axis of the first dimension that holds numbers.
    pub(super) fn numbers(&self, axis: &str) -> Option<&[f64]> {
        match &self.dimensions.first()?.iter().find(|(name, _)| name == axis)?.1 {
            Points::Numbers(numbers) => Some(numbers),
            Points::Labels(_) => None,
        }
    }

    /// Names of the bands, if the last dimension is that of bands.
    pub(super) fn bands(&self) -> Option<&[String]> {
        match self.dimensions.last()?.first()? {
            (name, Points::Labels(bands)) if name == BAND => Some(bands),
            _ => None,
        }
    }

    /// Dimensions without that of bands.
    pub(super) fn places(&self) -> &[Vec<(String, Points)>] {
        let without = usize::from(self.bands().is_some());
        &self.dimensions[..self.dimensions.len() - without]
    }

    /// Number of combinations of points of all dimensions but that of bands.
    pub(super) fn place_count(&self) -> usize {
        self.values.len() / self.band_count().max(1)
    }

    /// Number of bands; 1 of a product without bands.
    pub(super) fn band_count(&self) -> usize {
        self.bands().map_or(1, <[String]>::len)
    }

    /// Value and standard error at a place in a band.
    pub(super) fn at(&self, place: usize, band: usize) -> (f64, f64) {
        let index = place * self.band_count() + band;
        (self.values[index], self.errors[index])
    }

    /// Texts of a place, one for each axis but bands.
    pub(super) fn place_texts(&self, place: usize) -> Vec<String> {
        let mut rest = place;
        let mut texts: Vec<Vec<String>> = Vec::new();
        for axes in self.places().iter().rev() {
            let length = axes.first().map_or(1, |(_, points)| points.len()).max(1);
            texts.push(axes.iter().map(|(_, points)| points.text(rest % length)).collect());
            rest /= length;
        }
        texts.into_iter().rev().flatten().collect()
    }

    /// The table with its values, if there is one.
    pub(super) fn table_file(&self) -> Option<&str> {
        let table = |name: &&String| has_ending(name, "csv") || has_ending(name, "ply");
        self.files.iter().find(table).map(String::as_str)
    }

    /// Picture with a legend, if it is an image.
    pub(super) fn picture_file(&self) -> Option<&str> {
        let is_picture = |name: &&String| has_ending(name, "png") && !name.ends_with(".pixels.png");
        self.files.iter().find(is_picture).map(String::as_str)
    }

    /// Returns true if it is an image, whose mean its values are.
    pub(super) fn is_image(&self) -> bool {
        let raster =
            |name: &String| [".img", ".exr", ".tif", ".png"].iter().any(|end| name.ends_with(end));
        self.files.iter().any(raster)
    }

    /// Median of standard error over value; `None` without errors.
    pub(super) fn relative_error(&self) -> Option<f64> {
        let pairs = self.values.iter().zip(&self.errors);
        let mut all: Vec<f64> = pairs
            .filter(|(value, error)| value.is_finite() && **value != 0.0 && error.is_finite())
            .map(|(value, error)| (error / value).abs())
            .collect();
        let middle = all.len() / 2;
        (!all.is_empty()).then(|| *all.select_nth_unstable_by(middle, f64::total_cmp).1)
    }
}

/// Returns true of a file with this ending, which sunfleck writes in small letters.
pub(super) fn has_ending(file: &str, ending: &str) -> bool {
    file.rsplit_once('.').is_some_and(|(_, found)| found == ending)
}

impl Points {
    pub(super) const fn len(&self) -> usize {
        match self {
            Self::Numbers(numbers) => numbers.len(),
            Self::Labels(labels) => labels.len(),
        }
    }

    /// Text of a point.
    pub(super) fn text(&self, index: usize) -> String {
        match self {
            Self::Numbers(numbers) => sunfleck::output::tick(numbers[index]),
            Self::Labels(labels) => labels[index].clone(),
        }
    }
}

/// At most `most` of `0..count`, evenly spaced, both ends included.
pub(super) fn thinned(count: usize, most: usize) -> Vec<usize> {
    if count <= most || most < 2 {
        return (0..count.min(most.max(1))).collect();
    }
    (0..most).map(|at| (at * (count - 1) + (most - 1) / 2) / (most - 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinned_points_hold_both_ends() {
        assert_eq!(thinned(3, 5), [0, 1, 2]);
        assert_eq!(thinned(101, 3), [0, 50, 100]);
        assert_eq!(thinned(9, 1), [0]);
        assert_eq!(thinned(0, 4), [0; 0]);
    }
}
