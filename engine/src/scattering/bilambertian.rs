use std::f64::consts::PI;

use glam::DVec3;

use super::{BsdfSample, Importance, Interaction, Lobe, SceneSpectra, SpectrumId};
use crate::components::LambertianOptics;
use crate::sampling::cosine_direction;

/// Lambertian reflection of each side and Lambertian transmission: `f = ρ/π` where `wi` and `wo`
/// lie on the same side and `τ/π` where they do not.
#[derive(Clone, Debug, PartialEq)]
pub struct BiLambertian {
    front: Side,
    back: Side,
    transmitted: SpectrumId,
    is_opaque: bool,
}

/// Fractions of the light that arrives on one side.
#[derive(Clone, Debug, PartialEq)]
struct Side {
    /// ρ.
    reflected: SpectrumId,
    /// True if ρ is 0 in every band.
    is_black: bool,
    /// ρ + τ.
    scattered: SpectrumId,
    /// 1 - ρ - τ.
    absorbed: SpectrumId,
}

impl BiLambertian {
    /// The model of these optics.
    #[must_use]
    pub fn new(optics: &LambertianOptics, spectra: &mut SceneSpectra) -> Self {
        let tau = optics.transmittance();
        let mut side = |rho: &[f32]| {
            // ρ + τ = 1 may round to an ulp above 1, which would absorb less than nothing.
            let scattered = rho.iter().zip(tau).map(|(r, t)| (r + t).min(1.0));
            let reflected = spectra.add(rho.iter().copied());
            Side {
                reflected,
                is_black: spectra.is_zero(reflected),
                absorbed: spectra.add_counted(scattered.clone().map(|scattered| 1.0 - scattered)),
                scattered: spectra.add_counted(scattered),
            }
        };
        let front = side(optics.front());
        // Sides that are alike share their spectra, and so do the packets that meet either.
        let is_alike = optics.back() == optics.front();
        let back = if is_alike { front.clone() } else { side(optics.back()) };
        let transmitted = spectra.add(tau.iter().copied());
        Self { front, back, transmitted, is_opaque: spectra.is_zero(transmitted) }
    }

    /// Spectra of reflection from the front and from the back, and of transmission.
    pub(super) const fn scattering_spectra(&self) -> [SpectrumId; 3] {
        [self.front.reflected, self.back.reflected, self.transmitted]
    }

    const fn side(&self, is_front: bool) -> &Side {
        if is_front { &self.front } else { &self.back }
    }

    /// `π f` as a spectrum.
    pub(super) fn spectrum(&self, at: &Interaction<'_>, wi: DVec3) -> SpectrumId {
        if at.is_same_side(wi) { self.reflected(at) } else { self.transmitted }
    }

    /// Lobes of reflection and transmission.
    pub(super) fn lobes(&self, at: &Interaction<'_>) -> [Lobe; 2] {
        [self.reflected(at).into(), self.transmitted.into()]
    }

    #[inline(always)]
    pub(super) fn f(&self, at: &Interaction<'_>, wi: DVec3) -> Option<Lobe> {
        let (spectrum, is_zero) = if at.is_same_side(wi) {
            let side = self.side(at.is_front());
            (side.reflected, side.is_black)
        } else {
            (self.transmitted, self.is_opaque)
        };
        (!is_zero).then(|| spectrum.into())
    }

    /// ρ + τ.
    pub(super) fn scattered(&self, at: &Interaction<'_>) -> SpectrumId {
        self.side(at.is_front()).scattered
    }

    /// ρ.
    pub(super) fn reflected(&self, at: &Interaction<'_>) -> SpectrumId {
        self.side(at.is_front()).reflected
    }

    pub(super) fn absorbed_fraction(&self, at: &Interaction<'_>) -> Lobe {
        self.side(at.is_front()).absorbed.into()
    }

    /// Power of reflection and of transmission.
    #[inline(always)]
    fn powers(&self, at: &Interaction<'_>, importance: Importance<'_>) -> [f64; 2] {
        let side = self.side(at.is_front());
        let power = |spectrum| f64::from(at.models.spectrum_power(spectrum, importance));
        [
            if side.is_black { 0.0 } else { power(side.reflected) },
            if self.is_opaque { 0.0 } else { power(self.transmitted) },
        ]
    }

    #[inline(always)]
    pub(super) fn sample_f(
        &self,
        at: &Interaction<'_>,
        importance: Importance<'_>,
        [lobe, u, v]: [f64; 3],
    ) -> Option<BsdfSample> {
        let [reflected, transmitted] = self.powers(at, importance);
        let total = reflected + transmitted;
        if total <= 0.0 {
            return None;
        }
        let is_reflected = lobe * total < reflected;
        let (spectrum, probability) = if is_reflected {
            (self.reflected(at), reflected / total)
        } else {
            (self.transmitted, transmitted / total)
        };
        let outward = if at.is_front() == is_reflected { at.normal } else { -at.normal };
        let weight = Lobe::from(spectrum).scaled((1.0 / probability) as f32);
        Some(BsdfSample { wi: cosine_direction(outward, u, v), weight })
    }

    /// `P(lobe) |cos θ| / π`.
    pub(super) fn pdf(&self, at: &Interaction<'_>, importance: Importance<'_>, wi: DVec3) -> f64 {
        let [reflected, transmitted] = self.powers(at, importance);
        let chosen = if at.is_same_side(wi) { reflected } else { transmitted };
        let cosine = at.normal.dot(wi).abs();
        if chosen == 0.0 { 0.0 } else { chosen / (reflected + transmitted) * cosine / PI }
    }
}
