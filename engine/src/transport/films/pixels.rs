//! Pixels of an image, some rows at a time.

use std::ops::Range;
use std::sync::Arc;
use std::{fmt, io};

use rayon::prelude::*;

/// Rows of an image.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelRows {
    /// Pixels in a row.
    pub width: usize,
    /// Values, shape `[rows, width, columns]`; NaN where nothing was seen.
    pub values: Vec<f32>,
    /// Standard errors, same shape; NaN where there is none.
    pub standard_error: Vec<f32>,
    /// Fraction of each pixel that shows the scene, shape `[rows, width]`.
    pub coverage: Vec<f32>,
}

impl PixelRows {
    /// Number of values of a pixel.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.values.len() / self.coverage.len().max(1)
    }

    /// Some of the rows and columns.
    #[must_use]
    pub fn select(&self, rows: Range<usize>, columns: Range<usize>) -> Self {
        let pixels = rows.start * self.width..rows.end * self.width;
        let values = pixels.start * self.columns()..pixels.end * self.columns();
        Self {
            width: self.width,
            values: select(&self.values[values.clone()], self.columns(), &columns),
            standard_error: select(&self.standard_error[values], self.columns(), &columns),
            coverage: self.coverage[pixels].to_vec(),
        }
    }

    /// Some of the columns.
    #[must_use]
    pub fn select_columns(self, columns: Range<usize>) -> Self {
        let all = self.columns();
        if columns == (0..all) {
            return self;
        }
        Self {
            values: select(&self.values, all, &columns),
            standard_error: select(&self.standard_error, all, &columns),
            ..self
        }
    }

    /// Replaces values and errors alike by functions of them; `f` maps `[.., columns]` in f64 to the same shape.
    #[must_use]
    pub fn scaled(mut self, f: impl Fn(&[f64]) -> Vec<f64> + Sync) -> Self {
        let row = (self.width * self.columns()).max(1);
        for values in [&mut self.values, &mut self.standard_error] {
            values.par_chunks_mut(row).for_each(|values| {
                let wide: Vec<f64> = values.iter().map(|&value| value.into()).collect();
                for (value, scaled) in values.iter_mut().zip(f(&wide)) {
                    *value = scaled as f32;
                }
            });
        }
        self
    }
}

/// Some columns of values of shape `[.., all columns]`.
fn select(values: &[f32], all: usize, columns: &Range<usize>) -> Vec<f32> {
    if *columns == (0..all) {
        return values.to_vec();
    }
    let mut selected = vec![0.0; values.len() / all.max(1) * columns.len()];
    let pixels = selected.par_chunks_exact_mut(columns.len().max(1));
    let pixels = pixels.zip(values.par_chunks_exact(all.max(1))).with_min_len(256);
    pixels.for_each(|(to, from)| to.copy_from_slice(&from[columns.clone()]));
    selected
}

/// All pixels of an image, in memory or as a function from rows to what they hold.
#[derive(Clone)]
pub struct Pixels(Source);

#[derive(Clone)]
enum Source {
    Arrays(Arc<PixelRows>),
    Function(Arc<dyn Fn(Range<usize>) -> io::Result<PixelRows> + Send + Sync>),
}

impl Pixels {
    /// Pixels that a function computes or reads.
    pub fn new(
        rows: impl Fn(Range<usize>) -> io::Result<PixelRows> + Send + Sync + 'static,
    ) -> Self {
        Self(Source::Function(Arc::new(rows)))
    }

    /// Some of the rows.
    ///
    /// # Errors
    /// If a temporary file that holds them cannot be read.
    pub fn rows(&self, rows: Range<usize>) -> io::Result<PixelRows> {
        match &self.0 {
            Source::Arrays(all) => Ok(all.select(rows, 0..all.columns())),
            Source::Function(function) => function(rows),
        }
    }

    /// Pixels whose rows are made from these.
    #[must_use]
    pub fn map(&self, f: impl Fn(PixelRows) -> PixelRows + Send + Sync + 'static) -> Self {
        let pixels = self.clone();
        Self::new(move |rows| pixels.rows(rows).map(&f))
    }

    /// Pixels with some of the columns.
    #[must_use]
    pub fn select_columns(&self, columns: Range<usize>) -> Self {
        match self.0.clone() {
            Source::Arrays(all) => Self::new(move |rows| Ok(all.select(rows, columns.clone()))),
            Source::Function(_) => self.map(move |pixels| pixels.select_columns(columns.clone())),
        }
    }
}

impl From<PixelRows> for Pixels {
    /// All rows, which stay in memory.
    fn from(all: PixelRows) -> Self {
        Self(Source::Arrays(Arc::new(all)))
    }
}

impl fmt::Debug for Pixels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Pixels")
    }
}
