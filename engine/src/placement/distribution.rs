//! Random numbers with the distributions of a document.

use std::f64::consts::TAU;
use std::hint::black_box;

use crate::document::Distribution;
use crate::sampling::Key;

/// Draws a number from a distribution that `document::check` accepts.
pub(super) fn draw(distribution: &Distribution, stream: Key) -> f64 {
    match *distribution {
        Distribution::Fixed(value) => value,
        Distribution::Uniform((low, high)) => low + (high - low) * stream.uniform(0),
        Distribution::Normal { mean, sd, min, max } => {
            let (min, max) = (min.unwrap_or(f64::NEG_INFINITY), max.unwrap_or(f64::INFINITY));
            truncated_normal(mean, sd, min, max, stream)
        }
        Distribution::LogNormal { median, sd_ln, min, max } => {
            let min = min.filter(|&min| min > 0.0).map_or(f64::NEG_INFINITY, f64::ln);
            let max = max.map_or(f64::INFINITY, f64::ln);
            truncated_normal(median.ln(), sd_ln, min, max, stream).exp()
        }
    }
}

/// Draws a Gaussian number between limits on both sides of its mean, by rejection.
///
/// Narrow limits are proposed uniformly, others from the Gaussian: both ways at least four
/// proposals in ten are accepted, for all limits.
fn truncated_normal(mean: f64, sd: f64, min: f64, max: f64, stream: Key) -> f64 {
    if sd <= 0.0 || min >= max {
        return mean;
    }
    let (low, high) = ((min - mean) / sd, (max - mean) / sd);
    let is_narrow = high - low < 2.5;
    // All trials fail with a chance of 0.6⁴⁰⁹⁶, which is 0.
    for trial in 0..4096 {
        // Else the compiler computes sixteen trials before it looks at the first.
        let trial = black_box(trial);
        let (u, v) = (stream.uniform(2 * trial), stream.uniform(2 * trial + 1));
        let z = if is_narrow {
            let z = low + (high - low) * u;
            if v < (-0.5 * z * z).exp() { z } else { continue }
        } else {
            (-2.0 * u.ln()).sqrt() * (TAU * v).cos()
        };
        if (low..=high).contains(&z) {
            return (mean + sd * z).clamp(min, max);
        }
    }
    mean
}
