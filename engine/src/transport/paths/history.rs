//! Record of a path's events, evaluated for all bands at its end.

use std::ops::Range;

use crate::scattering::{
    LANES, Lobe, LobeSpectrum, SpectrumId, SurfaceModels, add_lit, add_seen, multiply,
};
use crate::transport::band_blocks::{BLOCK, Block};

/// Spectral factors along a path, in order. Radiance is computed from them at the path's end, block by block
/// of bands: no spectrum is carried from event to event.
///
/// With the throughput `T`, 1 at the start: `L = Σ T f S` over all light that the path gathers.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    steps: Vec<Step>,
}

/// An event of a path; `c` is a factor that all bands share.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// `T ← T f c`.
    Scattering(LobeSpectrum, f32),
    /// `L ← L + T f S c` of a source `S`, in some bands.
    Lit(LobeSpectrum, SpectrumId, f32, LitBands),
    /// `L ← L + T S c`: the source itself is visible.
    Seen(SpectrumId, f32),
}

/// Bands that a source lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LitBands {
    first: u32,
    end: u32,
}

impl LitBands {
    /// All bands.
    pub(super) const ALL: Self = Self { first: 0, end: u32::MAX };

    /// Those of a block that are lit, by their places in the block.
    fn within(self, block: &Range<usize>) -> Range<usize> {
        let place = |band: u32| (band as usize).clamp(block.start, block.end) - block.start;
        place(self.first)..place(self.end)
    }
}

impl From<&Range<usize>> for LitBands {
    fn from(bands: &Range<usize>) -> Self {
        Self { first: bands.start as u32, end: bands.end as u32 }
    }
}

impl History {
    /// Removes all events.
    pub(super) fn clear(&mut self) {
        self.steps.clear();
    }

    /// Number of events.
    pub(super) const fn len(&self) -> usize {
        self.steps.len()
    }

    /// Records that the path is scattered with this weight.
    pub(super) fn scatter(&mut self, weight: Lobe) {
        self.steps.push(Step::Scattering(weight.spectrum, weight.scale));
    }

    /// Records that a surface sends light of a source along the path in some bands, `f S c`.
    pub(super) fn light(&mut self, f: Lobe, source: SpectrumId, c: f32, bands: LitBands) {
        self.steps.push(Step::Lit(f.spectrum, source, f.scale * c, bands));
    }

    /// Records that the path sees a source, `S c`.
    pub(super) fn see(&mut self, source: SpectrumId, c: f32) {
        self.steps.push(Step::Seen(source, c));
    }

    /// Radiance of the first `steps` events in at most [`BLOCK`] bands.
    #[inline(always)]
    pub(super) fn radiance(
        &self,
        models: &SurfaceModels,
        steps: usize,
        bands: Range<usize>,
        radiance: &mut Block,
    ) {
        // Spectra are padded to whole groups of lanes.
        let lanes = bands.start..bands.start + bands.len().next_multiple_of(LANES);
        let (mut throughput, mut sum, mut buffer) = ([1.0; BLOCK], [0.0; BLOCK], [0.0; BLOCK]);
        for step in &self.steps[..steps] {
            match *step {
                Step::Scattering(f, c) => {
                    let f = models.values(&f, lanes.clone(), &mut buffer);
                    multiply(&mut throughput, f, c);
                }
                Step::Lit(f, source, c, lit) => {
                    let lit = lit.within(&bands);
                    if lit.len() == bands.len() {
                        let f = models.values(&f, lanes.clone(), &mut buffer);
                        let source = &models.spectra.lanes(source)[lanes.clone()];
                        add_lit(&mut sum, &throughput, f, source, c);
                    } else if !lit.is_empty() {
                        // Models are evaluated in whole groups of lanes.
                        let first = lit.start / LANES * LANES;
                        let groups =
                            lanes.start + first..lanes.start + lit.end.next_multiple_of(LANES);
                        let f = models.values(&f, groups.clone(), &mut buffer);
                        let source = &models.spectra.lanes(source)[groups];
                        for band in lit {
                            let (f, source) = (f[band - first], source[band - first]);
                            sum[band] += throughput[band] * source * f * c;
                        }
                    }
                }
                Step::Seen(source, c) => {
                    let source = &models.spectra.lanes(source)[lanes.clone()];
                    add_seen(&mut sum, &throughput, source, c);
                }
            }
        }
        for (radiance, sum) in radiance[..lanes.len()].iter_mut().zip(&sum) {
            *radiance = f64::from(*sum);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::band_blocks::blocks;

    /// Radiance in every block of bands is the sum of the events' terms, band by band.
    #[test]
    fn blocks_of_bands_hold_the_light_of_all_events() {
        for bands in [1, 8, 63, 64, 65, 200_usize] {
            let mut models = SurfaceModels::new(bands);
            let [a, b, source, black] = [1, 2, 3, 4].map(|seed: usize| {
                let value = move |band: usize| ((band * 31 + seed * 17) % 7) as f32 / 7.0;
                models.spectra.add((0..bands).map(value))
            });
            let mut history = History::default();
            history.light(a.into(), source, 0.5, LitBands::ALL);
            history.scatter(Lobe::from(a).scaled(2.0));
            history.light(black.into(), b, 1.0, LitBands::ALL);
            // Some bands have a source of their own.
            let some = bands / 3..bands.div_ceil(2);
            history.light(black.into(), a, 2.0, LitBands::from(&some));
            history.scatter(Lobe::from(b).scaled(0.25));
            history.see(source, 3.0);
            let mut seen = 0;
            for block in blocks(0..bands) {
                let mut radiance = [f64::NAN; BLOCK];
                history.radiance(&models, history.len(), block.clone(), &mut radiance);
                for (band, radiance) in block.zip(radiance) {
                    let value = |id| f64::from(models.spectra.lanes(id)[band]);
                    let [a, b, s, black] = [a, b, source, black].map(value);
                    let some = if some.contains(&band) { 2.0 * black * a } else { 0.0 };
                    let expected = a * s * 0.5 + 2.0 * a * (b * black + some + 0.25 * b * s * 3.0);
                    assert!((radiance - expected).abs() < 1e-6, "{bands}, {band}");
                    seen += 1;
                }
            }
            assert_eq!(seen, bands);
        }
    }
}
