//! Values of a product with their standard errors, and how large these are.

use std::io;

use super::{Product, SensorReport};
use crate::statistics::values_at_ranks;

impl SensorReport {
    /// Bits of all values and errors, to compare runs.
    ///
    /// # Errors
    /// If a temporary file that holds pixels cannot be read.
    pub fn bits(&self) -> io::Result<Vec<u64>> {
        let mut bits = Vec::new();
        for product in &self.products {
            let numbers = product.values.iter().chain(&product.standard_error);
            bits.extend(numbers.map(|value| value.to_bits()));
            if let Some(image) = &product.image {
                let pixels = image.load()?;
                let numbers = pixels.values.iter().chain(&pixels.standard_error);
                bits.extend(numbers.map(|value| u64::from(value.to_bits())));
            }
        }
        Ok(bits)
    }
}

impl Product {
    /// Visits the finite values with their standard errors, those of the pixels for an image, until `each` returns false.
    fn visit_estimates(&self, mut each: impl FnMut(f64, f64) -> bool) -> io::Result<()> {
        let mut goes_on = |value: f64, error: f64| !value.is_finite() || each(value, error);
        let Some(image) = &self.image else {
            let mut pairs = self.values.iter().zip(&self.standard_error);
            pairs.all(|(&value, &error)| goes_on(value, error));
            return Ok(());
        };
        for rows in image.blocks() {
            let pixels = image.pixels.rows(rows)?;
            let mut pairs = pixels.values.iter().zip(&pixels.standard_error);
            if !pairs.all(|(&value, &error)| goes_on(value.into(), error.into())) {
                break;
            }
        }
        Ok(())
    }

    /// Returns true if it has values, and all of them are 0.
    ///
    /// # Errors
    /// If a temporary file that holds pixels cannot be read.
    pub fn is_black(&self) -> io::Result<bool> {
        let (mut has_values, mut is_black) = (false, true);
        self.visit_estimates(|value, _| {
            has_values = true;
            is_black = value == 0.0;
            is_black
        })?;
        Ok(has_values && is_black)
    }

    /// Median over all values other than 0, of an image over those of its pixels, of
    /// `standard error / |value|`; `None` if no value has an error.
    ///
    /// # Errors
    /// If a temporary file that holds pixels cannot be read.
    pub fn median_relative_error(&self) -> io::Result<Option<f64>> {
        let mut has_error = false;
        let median = values_at_ranks(
            |count| [count / 2],
            |each| {
                self.visit_estimates(|value, error| {
                    let error = error / value.abs();
                    if value != 0.0 {
                        has_error |= !error.is_nan();
                        // A value without an error among others with one is of too few samples.
                        each(if error.is_nan() { f64::INFINITY } else { error });
                    }
                    true
                })
            },
        )?;
        Ok(median.map(|[median]| median).filter(|_| has_error))
    }
}
