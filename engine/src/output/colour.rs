//! Colours: spectra to what a person would see.

use std::io;

use super::picture_input::PictureInput;
use crate::products::Channels;
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

/// Linear sRGB of a reflectance factor of 1 in each band, lit by D65; all bands together are white.
///
/// Spectra are straight between the bands' centres, and constant beyond the outermost. Only bands
/// from 380 to 780 nm count.
fn daylight(wavelengths: &[f64]) -> Vec<[f64; 3]> {
    let mut order: Vec<usize> =
        (0..wavelengths.len()).filter(|&i| (380.0..=780.0).contains(&wavelengths[i])).collect();
    order.sort_by(|&a, &b| wavelengths[a].total_cmp(&wavelengths[b]));
    let mut tristimulus = vec![[0.0; 3]; wavelengths.len()];
    let (Some(&shortest), Some(&longest)) = (order.first(), order.last()) else {
        return tristimulus;
    };
    for step in 0..=80 {
        let wavelength = 380.0 + 5.0 * f64::from(step);
        let light = matching(wavelength).map(|value| value * d65(wavelength));
        let mut add = |band: usize, share: f64| {
            for (sum, value) in tristimulus[band].iter_mut().zip(light) {
                *sum += share * value;
            }
        };
        let next = order.partition_point(|&band| wavelengths[band] <= wavelength);
        if next == 0 {
            add(shortest, 1.0);
        } else if next == order.len() {
            add(longest, 1.0);
        } else {
            let (below, above) = (order[next - 1], order[next]);
            let (low, high) = (wavelengths[below], wavelengths[above]);
            let share = (wavelength - low) / (high - low);
            add(below, 1.0 - share);
            add(above, share);
        }
    }
    // The fit's white is that of D65 to 1 %: the rest is taken out.
    let sum = |axis: usize| tristimulus.iter().map(|xyz| xyz[axis]).sum::<f64>();
    let scale = [0, 1, 2].map(|axis| WHITE[axis] / sum(axis));
    tristimulus
        .iter()
        .map(|xyz| {
            let [x, y, z] = [0, 1, 2].map(|axis| xyz[axis] * scale[axis]);
            SRGB_FROM_XYZ.map(|row| row[0] * x + row[1] * y + row[2] * z)
        })
        .collect()
}

/// Tristimulus values of D65 with Y = 1.
const WHITE: [f64; 3] = [0.950_47, 1.0, 1.088_83];

/// Linear sRGB from CIE XYZ. Source: IEC 61966-2-1, its primaries inverted.
const SRGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.240_454_2, -1.537_138_5, -0.498_531_4],
    [-0.969_266_0, 1.876_010_8, 0.041_556_0],
    [0.055_643_4, -0.204_025_9, 1.057_225_2],
];

/// sRGB from its linear form. Source: IEC 61966-2-1.
fn transfer(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Colour matching functions x̄, ȳ, z̄ of the CIE 1931 standard observer (2°), at a wavelength in nm.
///
/// Source: Wyman, Sloan and Shirley (2013), J. Comput. Graph. Tech. 2(2), 1-11: the fit of several
/// lobes.
fn matching(wavelength: f64) -> [f64; 3] {
    let lobe = |middle: f64, below: f64, above: f64| {
        let t = (wavelength - middle) / if wavelength < middle { below } else { above };
        (-0.5 * t * t).exp()
    };
    [
        1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7)
            - 0.065 * lobe(501.1, 20.4, 26.2),
        0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
        1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8),
    ]
}

/// Relative power of the standard illuminant D65 at a wavelength from 380 to 780 nm.
///
/// Source: CIE 15:2004, table T.1, every 10 nm.
fn d65(wavelength: f64) -> f64 {
    const TABLE: [f64; 41] = [
        49.9755, 54.6482, 82.7549, 91.486, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861,
        115.923, 108.811, 109.354, 107.802, 104.79, 107.689, 104.405, 104.046, 100.0, 96.3342,
        95.788, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778,
        78.2842, 69.7213, 71.6091, 74.349, 61.604, 69.8856, 75.087, 63.5927, 46.4182, 66.8054,
        63.3828,
    ];
    let place = ((wavelength - 380.0) / 10.0).clamp(0.0, 40.0);
    let low = (place as usize).min(39);
    let share = place - low as f64;
    TABLE[low] * (1.0 - share) + TABLE[low + 1] * share
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
    fn the_observer_sees_d65_where_the_standard_has_it() {
        let mut xyz = [0.0; 3];
        for step in 0..=80 {
            let wavelength = 380.0 + 5.0 * f64::from(step);
            for (sum, value) in xyz.iter_mut().zip(matching(wavelength)) {
                *sum += value * d65(wavelength);
            }
        }
        let sum: f64 = xyz.iter().sum();
        // CIE 15:2004: x = 0.31272, y = 0.32903. The fit's authors state errors of about 1 %.
        assert!((xyz[0] / sum / 0.312_72 - 1.0).abs() < 0.01, "{xyz:?}");
        assert!((xyz[1] / sum / 0.329_03 - 1.0).abs() < 0.01, "{xyz:?}");
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
