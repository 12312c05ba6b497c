use super::MappedReflectance;

/// Parameters of the surface model of a material.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceOptics {
    /// Diffuse reflection and transmission.
    BiLambertian(LambertianOptics),
    /// A leaf with a specular coating.
    GlossyLeaf(GlossyOptics),
    /// RPV.
    Rpv(DirectionalOptics<RpvParameters>),
    /// SOILSPECT.
    Soilspect(DirectionalOptics<SoilspectParameters>),
    /// Diffuse reflection of the ground, by cells.
    Mapped(MappedReflectance),
}

/// Parameters of an opaque model whose reflection depends on both directions, and the light that it reflects in
/// all; built by [`DirectionalOptics::new`] in `scattering`, which integrates it once for all stages of a world.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectionalOptics<B> {
    /// Shape `[bands]`.
    pub(crate) bands: Vec<B>,
    /// Directional-hemispherical reflectance, shape `[bands, nodes]` of `scattering/directional.rs`.
    pub(crate) dhr: Vec<Vec<f32>>,
}

impl SurfaceOptics {
    /// Appends the bands of the same surface in another scene.
    ///
    /// # Panics
    /// If the two are of different models, or of coatings that differ.
    pub fn join(&mut self, next: &Self) {
        match (self, next) {
            (Self::BiLambertian(optics), Self::BiLambertian(next)) => optics.join(next),
            (Self::GlossyLeaf(optics), Self::GlossyLeaf(next)) => {
                assert!(optics.coating == next.coating, "coatings differ by nothing but bands");
                optics.body.join(&next.body);
            }
            (Self::Rpv(optics), Self::Rpv(next)) => optics.join(next),
            (Self::Soilspect(optics), Self::Soilspect(next)) => optics.join(next),
            (Self::Mapped(optics), Self::Mapped(next)) => optics.join(next),
            (
                Self::BiLambertian(_)
                | Self::GlossyLeaf(_)
                | Self::Rpv(_)
                | Self::Soilspect(_)
                | Self::Mapped(_),
                _,
            ) => {
                panic!("surfaces that are joined have the same model")
            }
        }
    }

    /// Lambertian part of the model, if it has one.
    #[must_use]
    pub const fn lambertian(&self) -> Option<&LambertianOptics> {
        match self {
            Self::BiLambertian(optics) => Some(optics),
            Self::GlossyLeaf(optics) => Some(&optics.body),
            Self::Rpv(_) | Self::Soilspect(_) | Self::Mapped(_) => None,
        }
    }
}

impl<B: Clone> DirectionalOptics<B> {
    fn join(&mut self, next: &Self) {
        self.bands.extend_from_slice(&next.bands);
        self.dhr.extend_from_slice(&next.dhr);
    }
}

/// RPV model in one band; its formula is in `scattering/rpv.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RpvParameters {
    /// Amplitude ρ0, a reflectance factor.
    pub rho0: f32,
    /// Bowl shape k: below 1, reflectance rises towards the horizon.
    pub k: f32,
    /// Asymmetry Θ, -1 to 1: below 0, more is reflected back towards the light.
    pub asymmetry: f32,
    /// Hot spot parameter ρc, dimensionless: the smaller, the higher the hot spot.
    pub hot_spot: f32,
}

/// SOILSPECT model in one band; its formula is in `scattering/soilspect.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoilspectParameters {
    /// Single-scattering albedo ω.
    pub albedo: f32,
    /// Roughness h, dimensionless: the width of the hot spot.
    pub roughness: f32,
    /// Amplitude of the hot spot, dimensionless; 1 in the paper.
    pub hot_spot: f32,
    /// Legendre coefficients b, c of the phase angle.
    pub backward: [f32; 2],
    /// Legendre coefficients b', c' of the angle to the mirror direction.
    pub forward: [f32; 2],
}

/// A leaf: a diffuse body under a rough dielectric coating.
#[derive(Clone, Debug, PartialEq)]
pub struct GlossyOptics {
    /// Light that has passed the coating is reflected and transmitted by the body.
    pub body: LambertianOptics,
    /// Coating on both sides.
    pub coating: LeafCoating,
}

/// Rough dielectric surface, and the light that it reflects; built by [`LeafCoating::new`] in `scattering`, which
/// integrates it once for all stages of a world.
#[derive(Clone, Debug, PartialEq)]
pub struct LeafCoating {
    /// Real refractive index.
    pub(crate) refractive_index: f64,
    /// Root mean square slope of the facets, Beckmann's m.
    pub(crate) roughness: f64,
    /// Fraction of the light that it reflects, by cosine in even intervals.
    pub(crate) reflected: Vec<f64>,
}

/// Lambertian reflectance of both sides and transmittance, as fractions of the incident flux; shape `[bands]`.
///
/// Front is the side that the geometric normal points to. Holds only bands in which every fraction
/// is lawful and no side sends out more than it receives; build it with [`LambertianOptics::new`].
#[derive(Clone, Debug, PartialEq)]
pub struct LambertianOptics {
    front: Vec<f32>,
    back: Vec<f32>,
    transmittance: Vec<f32>,
}

/// A band in which a surface would send out more light than it receives, or less than zero.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "band {band}: reflectance {reflectance} and transmittance {transmittance} must each be at \
     least 0 and sum to at most 1"
)]
pub struct EnergyGain {
    /// Band, from 0.
    pub band: usize,
    /// Reflectance of the worse side.
    pub reflectance: f64,
    /// Diffuse transmittance.
    pub transmittance: f64,
}

impl LambertianOptics {
    /// Lambertian reflection on both sides, Lambertian transmission alike in both directions.
    ///
    /// Written in decimals, ρ + τ = 1 may come out an ulp above 1: such a sum is taken as 1.
    ///
    /// # Errors
    /// The first band that breaks `ρ ≥ 0`, `τ ≥ 0`, `ρ + τ ≤ 1` on either side, NaN included.
    ///
    /// # Panics
    /// If the three do not have the same number of bands.
    pub fn new(front: &[f64], back: &[f64], transmittance: &[f64]) -> Result<Self, EnergyGain> {
        assert!(front.len() == back.len() && back.len() == transmittance.len(), "one value a band");
        let rounding = 4.0 * f64::EPSILON;
        let lawful = |r: f64, t: f64| r >= 0.0 && t >= 0.0 && r + t <= 1.0 + rounding;
        for (band, ((&f, &b), &t)) in front.iter().zip(back).zip(transmittance).enumerate() {
            let reflectance = if lawful(f, t) { b } else { f };
            if !lawful(reflectance, t) {
                return Err(EnergyGain { band, reflectance, transmittance: t });
            }
        }
        let narrow = |values: &[f64]| values.iter().map(|&v| v as f32).collect();
        Ok(Self { front: narrow(front), back: narrow(back), transmittance: narrow(transmittance) })
    }

    fn join(&mut self, next: &Self) {
        self.front.extend_from_slice(&next.front);
        self.back.extend_from_slice(&next.back);
        self.transmittance.extend_from_slice(&next.transmittance);
    }

    /// Reflectance of the front side, shape `[bands]`.
    #[must_use]
    pub fn front(&self) -> &[f32] {
        &self.front
    }

    /// Reflectance of the back side, shape `[bands]`.
    #[must_use]
    pub fn back(&self) -> &[f32] {
        &self.back
    }

    /// Transmittance, from either side to the other, shape `[bands]`.
    #[must_use]
    pub fn transmittance(&self) -> &[f32] {
        &self.transmittance
    }
}

#[cfg(test)]
mod tests {
    use super::LambertianOptics;

    #[test]
    fn a_surface_exists_exactly_when_neither_side_gains_energy() {
        let new = |f: f64, b: f64, t: f64| LambertianOptics::new(&[f], &[b], &[t]);
        assert!(new(0.5, 0.5, 0.5).is_ok());
        assert!(new(0.1, 0.7, 0.3).is_ok());
        assert!(new(0.7, 0.1, 0.300_000_1).is_err());
        assert!(new(0.1, 0.71, 0.3).is_err());
        assert!(new(-0.1, 0.0, 0.0).is_err());
        assert!(new(f64::NAN, 0.0, 0.0).is_err());
        assert!(new(0.0, 0.0, f64::NAN).is_err());
    }
}
