//! Spectral values of surface models as small values that are evaluated later, block by block of bands.

use std::ops::Range;

use glam::DVec3;

use super::{SpectrumId, SpectrumTable, SurfaceModels};

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
    /// `π f` of the model of a surface for a pair of directions.
    Model(SurfaceId, Angles),
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

/// Angles between two directions and the normal of a surface, as surface models take them.
///
/// What cancels near the hot spot is computed in f64, from differences of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles {
    /// Cosine of the angle between `wi` and the normal, at least 0.
    pub cos_i: f32,
    /// Cosine of the angle between `wo` and the normal, at least 0.
    pub cos_o: f32,
    /// Cosine of the phase angle, between `wi` and `wo`.
    pub cos_phase: f32,
    /// Cosine of the angle between `wo` and the mirror direction of `wi`.
    pub cos_mirror: f32,
    /// Tangent of half the phase angle.
    pub tan_half_phase: f32,
    /// `√(tan²θi + tan²θo - 2 tan θi tan θo cos φ)`: distance between the points where the two directions meet
    /// a plane at unit height.
    pub hot_spot_distance: f32,
}

impl Angles {
    /// Angles of two unit vectors on the same side of a surface.
    #[must_use]
    pub fn new(normal: DVec3, wo: DVec3, wi: DVec3) -> Self {
        let (signed_o, signed_i) = (normal.dot(wo), normal.dot(wi));
        let cos_phase = wo.dot(wi);
        let on_plane = |w: DVec3, cosine: f64| w / cosine.abs().max(f64::MIN_POSITIVE);
        Self {
            cos_i: signed_i.abs() as f32,
            cos_o: signed_o.abs() as f32,
            cos_phase: cos_phase as f32,
            cos_mirror: (2.0 * signed_i * signed_o - cos_phase) as f32,
            tan_half_phase: ((wi - wo).length() / (wi + wo).length()) as f32,
            hot_spot_distance: on_plane(wi, signed_i).distance(on_plane(wo, signed_o)) as f32,
        }
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
                let lanes_of = |id| &self.spectra.lanes(id)[lanes.clone()];
                sum(terms, lanes_of, &mut buffer[..lanes.len()])
            }
            LobeSpectrum::Model(surface, angles) => {
                let buffer = &mut buffer[..lanes.len()];
                self.bsdf(surface).evaluate(&angles, lanes, buffer);
                buffer
            }
        }
    }

    /// Spectral part of a lobe in the representative bands; in `buffer` if it has to be computed.
    #[inline(always)]
    pub(crate) fn representatives<'v>(
        &'v self,
        spectrum: &LobeSpectrum,
        buffer: &'v mut [f32; SpectrumTable::REPRESENTATIVES],
    ) -> &'v [f32] {
        let count = SpectrumTable::representatives_len(self.spectra.bands());
        match *spectrum {
            LobeSpectrum::Table(id) => self.spectra.representatives(id),
            LobeSpectrum::Sum(terms) => {
                sum(terms, |id| self.spectra.representatives(id), &mut buffer[..count])
            }
            LobeSpectrum::Model(surface, angles) => {
                let buffer = &mut buffer[..count];
                self.bsdf(surface).evaluate_representatives(&angles, buffer);
                buffer
            }
        }
    }

    /// Largest value of the spectral part of a lobe if it is known at no cost; 1 if it is not.
    pub(crate) fn normalisation(&self, spectrum: &LobeSpectrum) -> f32 {
        match *spectrum {
            LobeSpectrum::Table(id) => self.spectra.largest(id),
            LobeSpectrum::Sum(_) | LobeSpectrum::Model(..) => 1.0,
        }
    }

    /// Value of a lobe in one band.
    #[must_use]
    pub fn value(&self, lobe: &Lobe, band: usize) -> f32 {
        self.values(&lobe.spectrum, band..band + 1, &mut [0.0])[0] * lobe.scale
    }
}

fn sum<'v>(
    [(a, of_a), (b, of_b)]: [(SpectrumId, f32); 2],
    values: impl Fn(SpectrumId) -> &'v [f32],
    buffer: &'v mut [f32],
) -> &'v [f32] {
    for ((sum, a), b) in buffer.iter_mut().zip(values(a)).zip(values(b)) {
        *sum = a * of_a + b * of_b;
    }
    buffer
}
