//! Error control of a measurement: the criteria that end it, and the errors of its products.

use std::io;

use crate::components::StopCriterion;
use crate::products::{Context, Product, ProductSize};
use crate::transport::{Film, Schedule};

/// Measurement of a sensor.
pub(super) trait Measurement {
    /// Films that are traced for it.
    fn films(&mut self) -> Vec<PacedFilm<'_>>;

    /// Products of the samples so far, of the bands of all scenes.
    ///
    /// # Errors
    /// If a temporary file cannot be read.
    fn products(&self) -> io::Result<Vec<Product>>;

    /// Adds the values of each randomisation to the products of the samples so far, as far as these are made of light.
    ///
    /// # Errors
    /// If a temporary file cannot be read.
    fn add_replicates(&self, products: &mut [Product]) -> io::Result<()>;

    /// Data that its products are made with.
    fn context(&self) -> &Context;

    /// Extents of its products, except for a few single numbers.
    fn product_sizes(&self) -> Vec<ProductSize>;

    /// Returns whether its products are computed from its films when they are written.
    fn keeps_films(&self) -> bool {
        false
    }

    /// Index of the sensor's measure that counts in most cells, if measures differ in that.
    fn largest(&self) -> usize {
        0
    }
}

/// A film, and the number of its samples for each sample of the measurement as a fraction.
pub(super) struct PacedFilm<'a> {
    pub(super) film: &'a mut dyn Film,
    pub(super) pace: (u64, u64),
}

impl<'a> PacedFilm<'a> {
    /// Film with one sample for each sample of the measurement.
    pub(super) fn evenly(film: &'a mut dyn Film) -> Self {
        Self { film, pace: (1, 1) }
    }

    /// Number of samples of the film that belong to `n` samples of the measurement.
    pub(super) fn samples(&self, n: u64) -> u64 {
        let (times, over) = self.pace;
        (u128::from(n) * u128::from(times) / u128::from(over)).try_into().unwrap_or(u64::MAX)
    }
}

/// Adds the values of products of one randomisation to the products of all; those without a counterpart, behind the
/// others, have none.
pub(super) fn add_replicate(products: &mut [Product], one: &[Product]) {
    products.iter_mut().zip(one).for_each(|(product, one)| product.add_replicate(one));
}

/// Errors of products after a number of samples.
pub(super) struct ErrorCheck {
    /// Samples of each randomisation.
    pub(super) samples: u64,
    /// Relative errors of products by name.
    pub(super) errors: Vec<(String, f64)>,
}

/// Criteria that end a measurement.
pub(super) struct Convergence {
    /// Criteria, of which the first that holds ends the measurement.
    pub(super) until: Vec<StopCriterion>,
    pub(super) schedule: Schedule,
    /// Function from the samples of [`StopCriterion::Samples`] to samples of each randomisation.
    pub(super) each: Box<dyn Fn(u64) -> u64 + Sync>,
}

/// Samples of a measurement from which on a product that is 0 throughout counts as exactly 0: with fewer samples, it may
/// come from a rare event.
const BLACK: u64 = 1 << 17;

impl Convergence {
    /// Samples of each randomisation that end the measurement.
    pub(super) fn limit(&self) -> u64 {
        let limits = self.until.iter().filter_map(|criterion| match criterion {
            StopCriterion::Samples(limit) => Some((self.each)(*limit)),
            _ => None,
        });
        limits.min().unwrap_or(u64::MAX)
    }

    pub(super) fn needs_errors(&self) -> bool {
        let needs_errors = |criterion: &StopCriterion| {
            matches!(criterion, StopCriterion::RelError(_) | StopCriterion::RelErrors(_))
        };
        self.until.iter().any(needs_errors)
    }

    /// Returns whether a number of samples ends the measurement, and nothing else can.
    pub(super) fn is_fixed(&self) -> bool {
        self.until.iter().all(|criterion| matches!(criterion, StopCriterion::Samples(_)))
    }

    /// Fraction of the way to a criterion; it holds from 1 on. Errors count as unknown without `errors`.
    pub(super) fn fraction(
        &self,
        criterion: &StopCriterion,
        samples: u64,
        seconds: f64,
        errors: Option<&[(String, f64)]>,
    ) -> f64 {
        // The error falls at least as slowly as the inverse root of the number of samples.
        let of_error =
            |error: f64, limit: f64| if error <= limit { 1.0 } else { (limit / error).powi(2) };
        match (criterion, errors) {
            (StopCriterion::Seconds(limit), _) => seconds / limit,
            (StopCriterion::Samples(limit), _) => samples as f64 / (self.each)(*limit) as f64,
            (StopCriterion::RelError(_) | StopCriterion::RelErrors(_), None) => 0.0,
            (StopCriterion::RelError(limit), Some(errors)) => {
                let asked = errors.iter().filter(|(name, _)| !is_energy_balance(name));
                asked.map(|(_, error)| of_error(*error, *limit)).fold(1.0, f64::min)
            }
            (StopCriterion::RelErrors(limits), Some(errors)) => {
                let of_name = |(name, limit): (&String, &f64)| {
                    let products = errors.iter().filter(|(known, _)| known == name);
                    products.map(|(_, error)| of_error(*error, *limit)).fold(1.0, f64::min)
                };
                limits.iter().map(of_name).fold(1.0, f64::min)
            }
        }
    }

    /// Samples at which one of the criteria will hold at a constant pace from where the run started, with errors from
    /// their last check on; infinite if nothing is known.
    pub(super) fn expected_end(&self, start: &Start, pace: f64, check: Option<&ErrorCheck>) -> f64 {
        let end = |criterion: &StopCriterion| match (criterion, check) {
            (StopCriterion::Seconds(limit), _) => {
                start.samples as f64 + pace * (limit - start.seconds)
            }
            (StopCriterion::Samples(limit), _) => (self.each)(*limit) as f64,
            (_, Some(ErrorCheck { samples, errors })) => {
                *samples as f64 / self.fraction(criterion, *samples, 0.0, Some(errors))
            }
            (_, None) => f64::INFINITY,
        };
        self.until.iter().map(end).fold(f64::INFINITY, f64::min)
    }
}

/// Samples and seconds of a measurement before this run.
#[derive(Clone, Copy)]
pub(super) struct Start {
    /// Samples of each randomisation.
    pub(super) samples: u64,
    pub(super) seconds: f64,
}

/// Median relative standard error of each product of each scene, by name. It is infinite if the product is black while
/// samples are few.
///
/// # Errors
/// If a temporary file that holds pixels cannot be read.
pub(super) fn relative_errors(measurement: &mut dyn Measurement) -> io::Result<Vec<(String, f64)>> {
    let samples: u64 = measurement.films().iter().map(|paced| paced.film.samples()).sum();
    let mut errors = Vec::new();
    let mut add = |product: &Product| -> io::Result<()> {
        let black = if samples < BLACK { f64::INFINITY } else { 0.0 };
        let error =
            if product.is_black()? { Some(black) } else { product.median_relative_error()? };
        errors.extend(error.map(|error| (product.name.clone(), error)));
        Ok(())
    };
    let scenes = measurement.context().scenes;
    for product in &measurement.products()? {
        match scenes {
            1 => add(product)?,
            _ => (0..scenes).try_for_each(|scene| add(&product.of_scene(scene, scenes)))?,
        }
    }
    Ok(errors)
}

/// Returns whether a product is an energy balance, to whose accuracy no criterion applies: the loss by roulette is 0 but
/// for noise.
pub(super) fn is_energy_balance(product: &str) -> bool {
    matches!(product, "energy" | "emitted_energy")
}
