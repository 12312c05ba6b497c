//! The numbers of two runs, and how near they are.

use anyhow::Context as _;
use sunfleck::products::{AxisPoints, Product, Report};

/// The bands that every scene has.
const BANDS: [&str; 2] = ["red", "nir"];

/// What a run found in the bands that every scene has, with its standard errors.
pub(crate) struct Numbers {
    pub(crate) values: Vec<f64>,
    pub(crate) errors: Vec<f64>,
}

impl Numbers {
    /// Of these products, all if none is named; an HDRF counts as a BRF.
    pub(crate) fn of(report: &Report, products: &[&str]) -> Self {
        let mut numbers = Self { values: Vec::new(), errors: Vec::new() };
        for product in report.sensors.iter().flat_map(|sensor| &sensor.products) {
            let name = product.name.replace("hdrf", "brf");
            if products.is_empty() || products.contains(&name.as_str()) {
                numbers.take(product);
            }
        }
        numbers
    }

    fn take(&mut self, product: &Product) {
        let last = product.dimensions.last().and_then(|axes| axes.first());
        let Some(AxisPoints::Labels(bands)) = last.map(|axis| &axis.points) else { return };
        for (index, (value, error)) in
            product.values.iter().zip(&product.standard_error).enumerate()
        {
            if BANDS.contains(&bands[index % bands.len()].as_str()) {
                self.values.push(*value);
                self.errors.push(*error);
            }
        }
    }

    pub(crate) fn are_the_bits_of(&self, other: &Self) -> bool {
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        bits(&self.values) == bits(&other.values) && bits(&self.errors) == bits(&other.errors)
    }

    /// Largest difference in standard errors of it.
    fn most_errors(&self, other: &Self) -> f64 {
        self.pairs(other).map(|(a, b, error)| (a - b).abs() / error).fold(0.0, f64::max)
    }

    /// Largest difference as a share of the value.
    fn most_relative(&self, other: &Self) -> f64 {
        self.pairs(other).map(|(a, b, _)| (a / b - 1.0).abs()).fold(0.0, f64::max)
    }

    fn pairs(&self, other: &Self) -> impl Iterator<Item = (f64, f64, f64)> {
        let errors = self.errors.iter().zip(&other.errors).map(|(a, b)| a.hypot(*b));
        let values = self.values.iter().zip(&other.values).map(|(a, b)| (*a, *b));
        values.zip(errors).map(|((a, b), error)| (a, b, error))
    }

    pub(crate) fn to_text(&self) -> String {
        let pairs = self.values.iter().zip(&self.errors);
        let lines: Vec<_> =
            pairs.map(|(v, e)| format!("{} {}", v.to_bits(), e.to_bits())).collect();
        lines.join("\n")
    }

    pub(crate) fn from_text(text: &str) -> anyhow::Result<Self> {
        let mut numbers = Self { values: Vec::new(), errors: Vec::new() };
        for line in text.lines() {
            let (value, error) = line.split_once(' ').context("a value without its error")?;
            numbers.values.push(f64::from_bits(value.parse()?));
            numbers.errors.push(f64::from_bits(error.parse()?));
        }
        Ok(numbers)
    }
}

/// What a skip does to the results.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Same {
    /// Nothing.
    Bits,
    /// Other random numbers; at most so many standard errors of the difference.
    Errors(f64),
}

impl Same {
    pub(crate) fn holds(self, one: &Numbers, other: &Numbers) -> bool {
        one.values.len() == other.values.len()
            && match self {
                Self::Bits => one.are_the_bits_of(other),
                Self::Errors(most) => one.most_errors(other) <= most,
            }
    }

    /// What the table says.
    pub(crate) fn verdict(self, one: &Numbers, other: &Numbers) -> String {
        match self {
            _ if !self.holds(one, other) => {
                format!("**differ** by up to {:.1e}", one.most_relative(other))
            }
            Self::Bits => "same bits".to_owned(),
            Self::Errors(_) => {
                let (z, off) = (one.most_errors(other), one.most_relative(other));
                format!("differ by up to {:.1} %, {z:.1} standard errors", 100.0 * off)
            }
        }
    }
}
