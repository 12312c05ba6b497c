//! Spectral values of surface models as small values that are evaluated later, block by block of bands.

use std::ops::Range;

use glam::DVec3;

use super::{CellFraction, RepresentativeBands, SpectrumId, SurfaceModels};

/// Identifies a surface: the id that hits carry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SurfaceId(pub u32);

/// Factor by which a surface multiplies light in each band: `scale` times a spectrum.
///
/// A path remembers lobes and evaluates them at its end, so that no spectrum goes through memory from event
/// to event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    /// Part of the factor that differs by band.
    pub spectrum: LobeSpectrum,
    /// Part of the factor that all bands share.
    pub scale: f32,
}

/// Spectral part of a [`Lobe`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LobeSpectrum {
    /// A spectrum of the scene.
    Table(SpectrumId),
    /// `Σ c S` of two spectra of the scene.
    Sum([(SpectrumId, f32); 2]),
    /// `π f` of the model of a surface for a pair of directions; of models that `Bsdf::evaluate` knows alone.
    Model(SurfaceId, Angles),
    /// Fraction of the light on a surface that is reflected or absorbed in a cell of its map.
    Cell(SurfaceId, CellFraction),
}

impl Lobe {
    /// One in every band.
    pub const ONE: Self = Self { spectrum: LobeSpectrum::Table(SpectrumId::ONE), scale: 1.0 };
    /// Zero in every band.
    pub const ZERO: Self = Self { spectrum: LobeSpectrum::Table(SpectrumId::ZERO), scale: 1.0 };

    /// This lobe times a factor that all bands share.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self { scale: self.scale * factor, ..self }
    }
}

impl From<SpectrumId> for Lobe {
    fn from(spectrum: SpectrumId) -> Self {
        Self { spectrum: LobeSpectrum::Table(spectrum), scale: 1.0 }
    }
}

/// Angles between two directions and the normal of a surface: they determine the value of an isotropic surface
/// model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles {
    /// Cosine of the angle between `wi` and the normal, above 0.
    pub cos_i: f32,
    /// Cosine of the angle between `wo` and the normal, above 0.
    pub cos_o: f32,
    /// Tangent of half the phase angle, between `wi` and `wo`. Unlike the cosine it is accurate at the hot spot.
    pub tan_half_phase: f32,
}

impl Angles {
    /// Angles of two unit vectors on the same side of a surface.
    #[must_use]
    pub fn new(normal: DVec3, wo: DVec3, wi: DVec3) -> Self {
        let cosine = |w: DVec3| (normal.dot(w).abs() as f32).max(f32::MIN_POSITIVE);
        let tan_half_phase = (wi - wo).length() / (wi + wo).length().max(1e-9);
        let (cos_i, cos_o) = (cosine(wi), cosine(wo));
        Self { cos_i, cos_o, tan_half_phase: tan_half_phase as f32 }
    }

    /// Cosine of the phase angle.
    #[must_use]
    pub fn cos_phase(&self) -> f32 {
        1.0 - self.versine()
    }

    /// Cosine of the angle between `wo` and the mirror direction of `wi`.
    #[must_use]
    pub fn cos_mirror(&self) -> f32 {
        2.0 * self.cos_i * self.cos_o - self.cos_phase()
    }

    /// `√(tan²θi + tan²θo - 2 tan θi tan θo cos φ)`: distance between the points where the two directions meet
    /// a plane at unit height.
    #[must_use]
    pub fn hot_spot_distance(&self) -> f32 {
        let (i, o) = (1.0 / self.cos_i, 1.0 / self.cos_o);
        ((i - o) * (i - o) + 2.0 * self.versine() * i * o).sqrt()
    }

    /// 1 - cos g.
    fn versine(&self) -> f32 {
        let squared = self.tan_half_phase * self.tan_half_phase;
        2.0 * squared / (1.0 + squared)
    }
}

impl SurfaceModels {
    /// Spectral part of a lobe in a range of lanes; in `buffer` if it has to be computed.
    #[inline(always)]
    pub(crate) fn values<'v>(
        &'v self,
        spectrum: &LobeSpectrum,
        lanes: Range<usize>,
        buffer: &'v mut [f32],
    ) -> &'v [f32] {
        match *spectrum {
            LobeSpectrum::Table(id) => &self.spectra.lanes(id)[lanes],
            LobeSpectrum::Sum(terms) => {
                let buffer = &mut buffer[..lanes.len()];
                add(terms, |id| &self.spectra.lanes(id)[lanes.clone()], buffer);
                buffer
            }
            LobeSpectrum::Model(surface, angles) => {
                let buffer = &mut buffer[..lanes.len()];
                self.bsdf(surface).evaluate(&angles, lanes, buffer);
                buffer
            }
            LobeSpectrum::Cell(surface, cell) => {
                let buffer = &mut buffer[..lanes.len()];
                self.map(surface).evaluate(cell, lanes, buffer);
                buffer
            }
        }
    }

    /// Calls a function with the spectral part of a lobe in the representative bands.
    #[inline(always)]
    pub(crate) fn with_representatives<R>(
        &self,
        spectrum: &LobeSpectrum,
        function: impl FnOnce(&[f32]) -> R,
    ) -> R {
        if let LobeSpectrum::Table(id) = *spectrum {
            function(self.spectra.representatives(id))
        } else {
            let mut buffer = [0.0; RepresentativeBands::MOST];
            function(self.evaluate_representatives(spectrum, &mut buffer))
        }
    }

    #[inline(never)]
    fn evaluate_representatives<'b>(
        &self,
        spectrum: &LobeSpectrum,
        buffer: &'b mut [f32; RepresentativeBands::MOST],
    ) -> &'b [f32] {
        let buffer = &mut buffer[..self.spectra.representative_bands().lanes()];
        match *spectrum {
            LobeSpectrum::Table(id) => buffer.copy_from_slice(self.spectra.representatives(id)),
            LobeSpectrum::Sum(terms) => add(terms, |id| self.spectra.representatives(id), buffer),
            LobeSpectrum::Model(surface, angles) => {
                self.bsdf(surface).evaluate_representatives(&angles, buffer);
            }
            LobeSpectrum::Cell(surface, cell) => {
                self.map(surface).evaluate_representatives(cell, buffer);
            }
        }
        buffer
    }

    /// Largest value of the spectral part of a lobe if it is known at no cost; 1 if it is not.
    pub(crate) fn normalisation(&self, spectrum: &LobeSpectrum) -> f32 {
        match *spectrum {
            LobeSpectrum::Table(id) => self.spectra.largest(id),
            LobeSpectrum::Sum(_) | LobeSpectrum::Model(..) | LobeSpectrum::Cell(..) => 1.0,
        }
    }

    /// Value of a lobe in one band.
    #[must_use]
    pub fn value(&self, lobe: &Lobe, band: usize) -> f32 {
        self.values(&lobe.spectrum, band..band + 1, &mut [0.0])[0] * lobe.scale
    }
}

/// Writes the sum of two spectra, each times a factor.
fn add<'v>(
    [(a, of_a), (b, of_b)]: [(SpectrumId, f32); 2],
    values: impl Fn(SpectrumId) -> &'v [f32],
    sums: &mut [f32],
) {
    for ((sum, a), b) in sums.iter_mut().zip(values(a)).zip(values(b)) {
        *sum = a * of_a + b * of_b;
    }
}
