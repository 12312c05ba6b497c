//! How surfaces scatter light: evaluation, sampling and absorption of each surface model, one file
//! a model.
//!
//! `wo` points to where the path came from and `wi` to where it goes on; both are unit and point
//! away from the surface. Values exclude the cosine. All bands ride on one path, so spectra are
//! slices over lanes: bands, padded with zeros to whole groups of [`LANES`].

mod bilambertian;
mod lanes;
mod spectrum;

use glam::DVec3;

pub use bilambertian::BiLambertian;
pub(crate) use lanes::{add_lit, add_seen, dot, largest, largest_product, multiply, widely};
pub use spectrum::Spectrum;

/// Bands are padded to multiples of this, so that loops over them need no remainder.
pub const LANES: usize = 8;

/// A surface model.
#[derive(Clone, Debug, PartialEq)]
pub enum Bsdf {
    /// Diffuse reflection and transmission.
    BiLambertian(BiLambertian),
}

/// A sampled direction with its weight `f |cos θ| / pdf = spectrum · scale`, per lane.
#[derive(Clone, Copy, Debug)]
pub struct Scattered<'a> {
    /// Where the path goes on.
    pub direction: DVec3,
    /// Spectral part of the weight.
    pub spectrum: &'a Spectrum,
    /// Part of the weight that all bands share.
    pub scale: f32,
}

impl Bsdf {
    /// `π f(wi, wo)`; `None` where it is zero in every band, so that nobody traces
    /// a shadow ray for it.
    #[must_use]
    pub fn eval(&self, normal: DVec3, wo: DVec3, wi: DVec3) -> Option<&Spectrum> {
        match self {
            Self::BiLambertian(model) => model.eval(normal, wo, wi),
        }
    }

    /// A direction for a path; `None` where all is absorbed. Lobes are chosen in proportion to the
    /// `power` that each would carry on.
    #[must_use]
    pub fn sample(
        &self,
        normal: DVec3,
        wo: DVec3,
        power: impl Fn(&Spectrum) -> f32,
        u: [f64; 3],
    ) -> Option<Scattered<'_>> {
        match self {
            Self::BiLambertian(model) => model.sample(normal, wo, power, u),
        }
    }

    /// Share of the light from `wo` that is scattered at all, `DHR + DHT`.
    #[must_use]
    pub fn scattered(&self, normal: DVec3, wo: DVec3) -> &Spectrum {
        match self {
            Self::BiLambertian(model) => model.scattered(normal, wo),
        }
    }

    /// Share of it that is not scattered, `1 - DHR - DHT`.
    #[must_use]
    pub fn absorbed(&self, normal: DVec3, wo: DVec3) -> &Spectrum {
        match self {
            Self::BiLambertian(model) => model.absorbed(normal, wo),
        }
    }

    /// Share of the light from `wo` that is scattered back to its side.
    #[must_use]
    pub fn reflected(&self, normal: DVec3, wo: DVec3) -> &Spectrum {
        match self {
            Self::BiLambertian(model) => model.reflected(normal, wo),
        }
    }
}

/// A spectrum padded with zeros to whole groups of [`LANES`].
#[must_use]
pub fn padded(spectrum: impl IntoIterator<Item = f32>) -> Box<[f32]> {
    let mut lanes: Vec<f32> = spectrum.into_iter().collect();
    lanes.resize(lanes.len().next_multiple_of(LANES), 0.0);
    lanes.into()
}
