//! Colour composites: bands of an image as red, green and blue, stretched between percentiles.

use std::io;

use super::legend::{Bar, Entries, PictureLegend};
use super::picture_input::PictureInput;
use crate::statistics::values_at_ranks;

/// Percentiles that become black and full brightness, as fractions.
const STRETCH: [f64; 2] = [0.01, 0.99];
/// Minimum full brightness of a false colour, relative to that of the brightest.
const FAINTEST: f32 = 0.5;
/// Wavelengths that red, green and blue stand for where the image reaches the near infrared, nm:
/// the classic false colours, in which leaves are red.
const FALSE_COLOUR: [f64; 3] = [865.0, 660.0, 560.0];
/// Wavelengths of natural colours, nm.
const NATURAL: [f64; 3] = [650.0, 550.0, 450.0];

/// Bands that are red, green and blue, `None` without data.
#[derive(Debug)]
pub(super) struct Composite {
    pub(super) bands: [Option<usize>; 3],
    /// True if the three have the same stretch, which keeps the hues.
    pub(super) is_natural: bool,
}

impl Composite {
    /// Chooses among the bands that have data.
    pub(super) fn new(wavelengths: &[f64], has_data: &[bool]) -> Self {
        let at = |band: usize| wavelengths.get(band).copied().unwrap_or(f64::NAN);
        // Bands of unknown wavelength are taken in their order.
        let mut order: Vec<usize> = (0..has_data.len()).filter(|&band| has_data[band]).collect();
        if order.iter().all(|&band| at(band).is_finite()) {
            order.sort_by(|&a, &b| at(a).total_cmp(&at(b)));
        }
        let (Some(&shortest), Some(&longest)) = (order.first(), order.last()) else {
            return Self { bands: [None; 3], is_natural: true };
        };
        let three = |bands: [usize; 3], is_natural| Self { bands: bands.map(Some), is_natural };
        if order.len() < 3 {
            return three([longest, shortest, shortest], false);
        }
        let near_infrared = order.iter().any(|&band| (740.0..1400.0).contains(&at(band)));
        let wanted = if near_infrared { FALSE_COLOUR } else { NATURAL };
        let nearest = |wavelength: f64| {
            let distance = |band: usize| (at(band) - wavelength).abs();
            order.iter().copied().min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        };
        match wanted.map(nearest) {
            [Some(r), Some(g), Some(b)] if r != g && g != b && r != b => {
                three([r, g, b], !near_infrared)
            }
            _ => three([longest, order[order.len() / 2], shortest], false),
        }
    }

    pub(super) fn stretches(&self, input: &PictureInput<'_>) -> io::Result<[Stretch; 3]> {
        let [r, g, b] = self.bands.map(|band| {
            band.map_or(Ok(Stretch::NONE), |band| Stretch::between_percentiles(input, band))
        });
        let [r, g, b] = [r?, g?, b?];
        let shown = [r, g, b].into_iter().zip(self.bands).filter(|(_, band)| band.is_some());
        let shown: Vec<Stretch> = shown.map(|(stretch, _)| stretch).collect();
        if shown.is_empty() {
            return Ok([r, g, b]);
        }
        let low = shown.iter().map(|one| one.low).fold(f32::INFINITY, f32::min);
        let high = shown.iter().map(|one| one.high).fold(f32::NEG_INFINITY, f32::max);
        if self.is_natural {
            return Ok([r, g, b].map(|one| Stretch { low, high, ..one }));
        }
        // A dim band stretched in full would drown the others: bare soil in cyan.
        Ok([r, g, b].map(|one| Stretch { high: one.high.max(FAINTEST * high), ..one }))
    }

    /// A bar for each band that is shown, in the colours that it has where the others are dark.
    pub(super) fn legend(
        &self,
        input: &PictureInput<'_>,
        stretches: &[Stretch; 3],
    ) -> PictureLegend {
        let PictureInput { image, wavelengths, lit, .. } = input;
        let mut bars: Vec<Bar> = Vec::new();
        let mut shown: Vec<usize> = Vec::new();
        for (channel, (band, stretch)) in self.bands.into_iter().zip(stretches).enumerate() {
            let Some(band) = band else { continue };
            if let Some(at) = shown.iter().position(|&other| other == band) {
                bars[at].channels[channel] = true;
                continue;
            }
            let mut channels = [false; 3];
            channels[channel] = true;
            let wavelength = wavelengths.get(band).copied().filter(|nm| nm.is_finite());
            let name = image.bands[band].clone();
            bars.push(Bar { wavelength, channels, ..stretch.bar(name) });
            shown.push(band);
        }
        let dark = image.bands.iter().zip(lit.dark()).filter(|(_, is_dark)| *is_dark);
        let dark = dark.map(|(name, _)| name.clone()).collect();
        PictureLegend { entries: Entries::Bars(bars), dark, zero: None }
    }
}

/// Values that become black and full brightness.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    low: f32,
    high: f32,
    /// Smallest and largest value.
    extremes: [f32; 2],
}

impl Stretch {
    /// Stretch of a channel that shows nothing.
    const NONE: Self = Self { low: 0.0, high: 1.0, extremes: [0.0, 1.0] };

    fn between_percentiles(input: &PictureInput<'_>, band: usize) -> io::Result<Self> {
        let ranks = |count| {
            let [low, high] = STRETCH.map(|share| (share * (count - 1) as f64).round() as u64);
            [0, low, high, count - 1]
        };
        let found = values_at_ranks(ranks, |each| input.visit_band(band, each))?;
        let Some([least, low, high, largest]) = found.map(|all| all.map(|value| value as f32))
        else {
            return Ok(Self::NONE);
        };
        let extremes = [least, largest];
        // Differences in the last digits are no picture.
        let is_plain = high - low <= 1e-5 * high.abs();
        Ok(if is_plain {
            Self { extremes, ..Self::plain(high) }
        } else {
            Self { low, high, extremes }
        })
    }

    /// Range of all values of a band.
    ///
    /// - `has_zero`: true if the range begins at 0, however large the values are
    pub(super) fn over_all(
        input: &PictureInput<'_>,
        band: usize,
        has_zero: bool,
    ) -> io::Result<Self> {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        input.visit_band(band, &mut |value| {
            (low, high) = (low.min(value), high.max(value));
        })?;
        if has_zero {
            low = low.min(0.0);
        }
        Ok(if high > low {
            let (low, high) = (low as f32, high as f32);
            Self { low, high, extremes: [low, high] }
        } else if high.is_finite() {
            Self::plain(high as f32)
        } else {
            Self::NONE
        })
    }

    /// Stretch of a plain image, which is neither black nor white.
    fn plain(value: f32) -> Self {
        let high = (2.0 * value).max(f32::MIN_POSITIVE);
        Self { low: 0.0, high, extremes: [value; 2] }
    }

    /// Grey bar of a legend for a band with this name.
    pub(super) fn bar(self, name: String) -> Bar {
        let Self { low, high, extremes: [least, largest] } = self;
        let is_clipped = [least < low, largest > high];
        Bar { name, wavelength: None, channels: [true; 3], low, high, is_clipped }
    }

    /// `value` in [0, 1].
    pub(super) fn apply(self, value: f32) -> f32 {
        ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bands_of(wavelengths: &[f64]) -> [usize; 3] {
        Composite::new(wavelengths, &vec![true; wavelengths.len()])
            .bands
            .map(Option::unwrap_or_default)
    }

    #[test]
    fn colours_follow_the_wavelengths() {
        assert_eq!(bands_of(&[660.0]), [0, 0, 0], "grey");
        assert_eq!(bands_of(&[865.0, 660.0]), [0, 1, 1], "near infrared is red");
        assert_eq!(bands_of(&[660.0, 865.0]), [1, 0, 0]);
        assert_eq!(bands_of(&[450.0, 550.0, 650.0]), [2, 1, 0], "natural");
        assert_eq!(bands_of(&[490.0, 560.0, 665.0, 842.0]), [3, 2, 1], "false colours");
        assert_eq!(bands_of(&[8000.0, 10_000.0, 12_000.0]), [2, 1, 0], "longest is red");
        assert_eq!(bands_of(&[f64::NAN; 4]), [3, 2, 0], "unknown");
    }
}
