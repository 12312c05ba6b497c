//! Data sets: named arrays with dimensions, coordinates and attributes after the CF conventions 1.10.
//!
//! Pure functions make a [`Dataset`] of what a sensor measured ([`sensor`]) or of a sweep ([`sweep`]); [`super::zarr`] and
//! [`super::netcdf`] write it, and know neither sensors nor products. Values of images stay in files and are read in
//! parts.

mod axes;
mod grid_mapping;
mod names;
mod pixels;
mod sensor;
mod sweep;
mod values;

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests;

pub(super) use pixels::{ImageFiles, ImageRasters, PixelArrays};
pub(super) use sensor::of_sensor;
pub(super) use sweep::{SweptProduct, of_sweep};
pub(super) use values::{ByteOrder, ValueType, Values};

/// Named arrays over common dimensions.
#[derive(Debug)]
pub(super) struct Dataset<'a> {
    pub(super) dimensions: Vec<Dimension>,
    pub(super) attributes: Attributes,
    pub(super) variables: Vec<Variable<'a>>,
}

/// A dimension that variables share by its place in [`Dataset::dimensions`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Dimension {
    pub(super) name: String,
    /// Number of points, at least 1.
    pub(super) length: usize,
}

/// An array.
#[derive(Debug)]
pub(super) struct Variable<'a> {
    pub(super) name: String,
    /// Places of its dimensions, slowest first; none of a scalar.
    pub(super) dimensions: Vec<usize>,
    pub(super) attributes: Attributes,
    pub(super) values: Values<'a>,
    /// True if NaN says that there are no data; coordinates have none.
    pub(super) has_fill: bool,
    /// True if its last two dimensions are rows and columns of an image.
    pub(super) is_raster: bool,
}

impl Variable<'_> {
    /// Lengths of its dimensions.
    pub(super) fn shape(&self, dimensions: &[Dimension]) -> Vec<usize> {
        self.dimensions.iter().map(|&place| dimensions[place].length).collect()
    }
}

/// Attributes in order, each name once.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Attributes(pub(super) Vec<(String, Attribute)>);

/// Value of an attribute.
#[derive(Clone, Debug, PartialEq)]
pub enum Attribute {
    /// Text.
    Text(String),
    /// Numbers.
    Numbers(Vec<f64>),
    /// Numbers of the type of a variable of pixels.
    Floats(Vec<f32>),
}

impl Attributes {
    /// Appends a text; an empty one is left out.
    pub(super) fn text(&mut self, name: &str, text: impl Into<String>) {
        let text = text.into();
        if !text.is_empty() {
            self.0.push((name.to_owned(), Attribute::Text(text)));
        }
    }

    /// Appends a number.
    pub(super) fn number(&mut self, name: &str, number: f64) {
        self.numbers(name, vec![number]);
    }

    /// Appends numbers.
    pub(super) fn numbers(&mut self, name: &str, numbers: Vec<f64>) {
        self.0.push((name.to_owned(), Attribute::Numbers(numbers)));
    }
}
