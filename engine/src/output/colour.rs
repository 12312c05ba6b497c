//! Colours: spectra to what a person would see.

use std::io;

use super::picture_input::PictureInput;
use crate::products::Channels;
use crate::spectral::observer::{daylight, transfer};
use crate::statistics::values_at_ranks;

/// Share of the pixels that an automatic exposure leaves below full brightness.
const BELOW: f64 = 0.99;

/// Linear sRGB of a pixel as a sum over its bands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mixture {
    /// Red, green and blue of one unit of each band, shape `[bands]`.
    weights: Vec<[f64; 3]>,
}

impl Mixture {
    /// The mixture in which the image of a white surface, shape `[bands]`, is white.
    pub(super) fn new(channels: Channels, wavelengths: &[f64], white: &[f64]) -> Self {
        let mut weights = match channels {
            Channels::Cie => daylight(wavelengths),
            Channels::Bands(chosen) => {
                let mut weights = vec![[0.0; 3]; wavelengths.len()];
                for (channel, band) in chosen.into_iter().enumerate() {
                    if let Some(weight) = weights.get_mut(band) {
                        weight[channel] = 1.0;
                    }
                }
                weights
            }
        };
        for (weight, &white) in weights.iter_mut().zip(white) {
            // A band without light shows nothing.
            let scale = if white > 0.0 { white.recip() } else { 0.0 };
            *weight = weight.map(|one| one * scale);
        }
        Self { weights }
    }

    /// Bands that take part; others may be without data.
    pub(super) fn bands(&self) -> Vec<usize> {
        let counts = |band: &usize| self.weights[*band].iter().any(|&one| one.abs() > 0.0);
        (0..self.weights.len()).filter(counts).collect()
    }

    /// Linear sRGB of a pixel that holds the values of its bands.
    fn linear(&self, pixel: impl Iterator<Item = (usize, f32)>) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (band, value) in pixel {
            for (sum, weight) in sum.iter_mut().zip(self.weights[band]) {
                *sum += weight * f64::from(value);
            }
        }
        sum
    }

    /// The gain at which nearly all pixels are below full brightness.
    pub(super) fn automatic(&self, input: &PictureInput<'_>) -> io::Result<f64> {
        let bands = self.bands();
        let rank = |count| [(BELOW * (count - 1) as f64).round() as u64];
        let brightest = values_at_ranks(rank, |each| {
            for rows in input.image.blocks() {
                let count = rows.len() * input.image.width;
                let values: Vec<Vec<f32>> = bands
                    .iter()
                    .map(|&band| input.band(band, rows.clone()))
                    .collect::<io::Result<_>>()?;
                let pixel = |at: usize| bands.iter().zip(&values).map(move |(&b, v)| (b, v[at]));
                (0..count)
                    .map(|at| self.linear(pixel(at)).into_iter().fold(0.0, f64::max))
                    .filter(|value| value.is_finite() && *value > 0.0)
                    .for_each(&mut *each);
            }
            io::Result::Ok(())
        })?;
        Ok(brightest.map_or(1.0, |[value]| value.recip()))
    }

    /// Red, green and blue of a pixel; `None` without data.
    pub(super) fn rgb(
        &self,
        pixel: impl Iterator<Item = (usize, f32)>,
        gain: f64,
    ) -> Option<[u8; 3]> {
        let byte = |fraction: f64| (255.0 * fraction.clamp(0.0, 1.0)).round() as u8;
        let linear = self.linear(pixel);
        let is_known = linear.iter().all(|value| value.is_finite());
        is_known.then(|| linear.map(|value| byte(transfer(gain * value))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::picture_input::tests::{image, input};

    fn wavelengths() -> Vec<f64> {
        (0..21).map(|step| 380.0 + 20.0 * f64::from(step)).collect()
    }

    fn linear(mixture: &Mixture, pixel: &[f32]) -> [f64; 3] {
        mixture.linear(mixture.bands().into_iter().map(|band| (band, pixel[band])))
    }

    fn rgb(mixture: &Mixture, pixel: &[f32], gain: f64) -> Option<[u8; 3]> {
        mixture.rgb(mixture.bands().into_iter().map(|band| (band, pixel[band])), gain)
    }

    #[test]
    fn white_is_white_at_any_irradiance_and_a_stop_doubles() {
        let wavelengths = wavelengths();
        let white: Vec<f64> = wavelengths.iter().map(|w| w / 500.0).collect();
        let mixture = Mixture::new(Channels::Cie, &wavelengths, &white);
        let full: Vec<f32> = white.iter().map(|&w| w as f32).collect();
        let linear = linear(&mixture, &full);
        assert!(linear.iter().all(|value| (value - 1.0).abs() < 1e-4), "{linear:?}");
        let half: Vec<f32> = full.iter().map(|w| 0.5 * w).collect();
        assert_eq!(rgb(&mixture, &half, 1.0), Some([188; 3]));
        assert_eq!(rgb(&mixture, &half, 1_f64.exp2()), Some([255; 3]));
        let image = image(&[""; 21], half);
        let gain = mixture.automatic(&input(&image, &wavelengths)).expect("pixels");
        assert!((gain - 2.0).abs() < 1e-3);
    }

    #[test]
    fn narrow_lights_have_their_colours() {
        let wavelengths = wavelengths();
        let mixture = Mixture::new(Channels::Cie, &wavelengths, &[1.0; 21]);
        let strongest = |nm: f64| {
            let pixel: Vec<f32> =
                wavelengths.iter().map(|w| f32::from(u8::from((w - nm).abs() < 1.0))).collect();
            let linear = linear(&mixture, &pixel);
            (0..3).max_by(|&a, &b| linear[a].total_cmp(&linear[b]))
        };
        assert_eq!([440.0, 540.0, 640.0].map(strongest), [Some(2), Some(1), Some(0)]);
    }

    #[test]
    fn chosen_bands_are_the_channels_and_no_data_is_transparent() {
        let mixture = Mixture::new(Channels::Bands([2, 0, 1]), &[0.0; 4], &[1.0, 2.0, 4.0, 0.0]);
        let linear = linear(&mixture, &[0.5, 0.5, 1.0, f32::NAN]);
        let off = linear.iter().zip([0.25, 0.5, 0.25]).map(|(found, known)| (found - known).abs());
        assert!(off.sum::<f64>() < 1e-12, "{linear:?}");
        assert_eq!(rgb(&mixture, &[1.0, 0.0, 4.0, 0.0], 1.0), Some([255, 255, 0]));
        assert_eq!(rgb(&mixture, &[f32::NAN, 0.0, 0.0, 0.0], 1.0), None);
    }
}
