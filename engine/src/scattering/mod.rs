//! Surface models: BSDF value, sampling, density, and the fractions of light that are scattered and absorbed,
//! one file a model.
//!
//! `wo` points to where a path came from and `wi` to where it continues; both are unit vectors that point
//! away from the surface. Every `f` here returns `π f`, a reflectance factor, without the cosine. A path carries all bands: values are [`Lobe`]s,
//! which are evaluated in blocks of lanes: bands, padded with zeros to whole groups of [`LANES`].

mod bilambertian;
mod directional;
mod glossy_leaf;
mod lanes;
mod lobe;
mod mapped;
mod path_spectra;
mod representatives;
mod rpv;
mod soilspect;
mod spectrum;

use std::ops::Range;

use glam::{DVec2, DVec3};

pub use bilambertian::BiLambertian;
pub use directional::{BandModel, Directional, ModelFault};
pub use glossy_leaf::GlossyLeaf;
pub(crate) use lanes::{add_lit, add_seen, dot, largest, largest_product, multiply, with_simd};
pub use lobe::{Angles, Lobe, LobeSpectrum, SurfaceId};
pub use mapped::{CellFraction, MappedLambertian};
pub use path_spectra::{PathMisfit, PathSpectra};
pub use representatives::RepresentativeBands;
pub use spectrum::{SceneSpectra, SpectrumId};

use crate::components::{RpvParameters, SoilspectParameters, SurfaceOptics};

/// Bands are padded to multiples of this, so that loops over them need no remainder.
pub const LANES: usize = 8;

/// A surface model.
#[derive(Clone, Debug, PartialEq)]
pub enum Bsdf {
    /// Diffuse reflection and transmission.
    BiLambertian(BiLambertian),
    /// A leaf with a specular lobe over a diffuse body.
    GlossyLeaf(GlossyLeaf),
    /// Rahman, Pinty and Verstraete's reflection of rough soil and vegetation.
    Rpv(Directional<RpvParameters>),
    /// Jacquemoud, Baret and Hanocq's reflection of soil.
    Soilspect(Directional<SoilspectParameters>),
    /// Diffuse reflection of the ground, by cells.
    Mapped(MappedLambertian),
}

/// Surface models of a scene, by the ids that hits carry, and the spectra that they refer to.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceModels {
    /// Spectra of surfaces and of light.
    pub spectra: SceneSpectra,
    bsdfs: Vec<Bsdf>,
}

/// A point of a surface that is seen from the direction `wo`.
#[derive(Clone, Copy, Debug)]
pub struct Interaction<'m> {
    models: &'m SurfaceModels,
    surface: SurfaceId,
    normal: DVec3,
    wo: DVec3,
    /// Horizontal position, m, which maps depend on.
    place: DVec2,
}

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Direction in which the path continues.
    pub wi: DVec3,
    /// Weight of the sample, `f |cos θ| / pdf` with `f` itself, not `π f`.
    pub weight: Lobe,
}

/// Bands by whose power a lobe of a surface is chosen.
#[derive(Clone, Copy, Debug)]
pub enum Importance<'t> {
    /// All, by the throughput of a path in the representative bands.
    Representatives(&'t [f32]),
    /// One alone.
    Band(usize),
}

impl SurfaceModels {
    /// No surfaces yet, and no spectra but 0 and 1.
    #[must_use]
    pub fn new(bands: usize) -> Self {
        Self { spectra: SceneSpectra::new(bands), bsdfs: Vec::new() }
    }

    /// Adds a surface; ids count from 0.
    pub fn add(&mut self, optics: &SurfaceOptics) -> SurfaceId {
        let spectra = &mut self.spectra;
        self.bsdfs.push(match optics {
            SurfaceOptics::BiLambertian(optics) => {
                Bsdf::BiLambertian(BiLambertian::new(optics, spectra))
            }
            SurfaceOptics::GlossyLeaf(optics) => Bsdf::GlossyLeaf(GlossyLeaf::new(optics, spectra)),
            SurfaceOptics::Rpv(optics) => Bsdf::Rpv(Directional::new(optics, spectra)),
            SurfaceOptics::Soilspect(optics) => Bsdf::Soilspect(Directional::new(optics, spectra)),
            SurfaceOptics::Mapped(optics) => Bsdf::Mapped(MappedLambertian::new(optics, spectra)),
        });
        SurfaceId(self.bsdfs.len() as u32 - 1)
    }

    /// Chooses the representative bands, when all surfaces and all light are there.
    pub fn choose_representatives(&mut self) {
        let shapes = self.bsdfs.iter().flat_map(|bsdf| match bsdf {
            Bsdf::BiLambertian(_) | Bsdf::GlossyLeaf(_) => Vec::new(),
            Bsdf::Rpv(model) => model.shapes(),
            Bsdf::Soilspect(model) => model.shapes(),
            Bsdf::Mapped(model) => model.shapes(),
        });
        self.spectra.choose_representatives(&shapes.collect::<Vec<_>>());
        for bsdf in &mut self.bsdfs {
            match bsdf {
                Bsdf::BiLambertian(_) | Bsdf::GlossyLeaf(_) => {}
                Bsdf::Rpv(model) => model.choose_representatives(&self.spectra),
                Bsdf::Soilspect(model) => model.choose_representatives(&self.spectra),
                Bsdf::Mapped(model) => model.choose_representatives(&self.spectra),
            }
        }
    }

    /// Returns whether all surfaces are diffuse and alike everywhere: paths are then multiplied by spectra of the table
    /// alone.
    #[must_use]
    pub fn are_diffuse(&self) -> bool {
        self.bsdfs.iter().all(|bsdf| match bsdf {
            Bsdf::BiLambertian(_) => true,
            Bsdf::GlossyLeaf(_) | Bsdf::Rpv(_) | Bsdf::Soilspect(_) | Bsdf::Mapped(_) => false,
        })
    }

    /// Number of surfaces.
    #[must_use]
    pub const fn surface_count(&self) -> usize {
        self.bsdfs.len()
    }

    fn bsdf(&self, surface: SurfaceId) -> &Bsdf {
        &self.bsdfs[surface.0 as usize]
    }

    /// A point of a surface with a unit normal, seen from the direction `wo`.
    #[must_use]
    pub const fn at(&self, surface: SurfaceId, normal: DVec3, wo: DVec3) -> Interaction<'_> {
        Interaction { models: self, surface, normal, wo, place: DVec2::ZERO }
    }

    fn map(&self, surface: SurfaceId) -> &MappedLambertian {
        match self.bsdf(surface) {
            Bsdf::Mapped(map) => map,
            _ => unreachable!("lobes of cells are those of maps"),
        }
    }

    /// Power of a spectrum of the scene in the bands that importance names.
    #[inline(always)]
    fn spectrum_power(&self, spectrum: SpectrumId, importance: Importance<'_>) -> f32 {
        match importance {
            Importance::Representatives(throughput) => {
                dot(throughput, self.spectra.representatives(spectrum))
            }
            Importance::Band(band) => self.spectra.lanes(spectrum)[band],
        }
    }

    /// Power of a lobe in the bands that importance names.
    #[inline(always)]
    fn power(&self, lobe: &Lobe, importance: Importance<'_>) -> f32 {
        match importance {
            Importance::Representatives(throughput) => {
                let dot = |lobe: &[f32]| dot(throughput, lobe);
                self.with_representatives(&lobe.spectrum, dot) * lobe.scale
            }
            Importance::Band(band) => self.value(lobe, band),
        }
    }
}

impl<'m> Interaction<'m> {
    /// The point at a horizontal position, m: without it, maps are taken at the origin.
    #[must_use]
    pub const fn at_place(self, place: DVec2) -> Self {
        Self { place, ..self }
    }

    /// Models and spectra of the scene.
    pub(crate) const fn models(&self) -> &'m SurfaceModels {
        self.models
    }

    /// Unit vector to where the path came from.
    pub(crate) const fn wo(&self) -> DVec3 {
        self.wo
    }

    fn bsdf(&self) -> &Bsdf {
        self.models.bsdf(self.surface)
    }

    /// `π f(wi, wo)`; `None` where it is zero in every band, so that no shadow ray is traced for it.
    #[inline(always)]
    #[must_use]
    pub fn f(&self, wi: DVec3) -> Option<Lobe> {
        match self.bsdf() {
            Bsdf::BiLambertian(model) => model.f(self, wi),
            Bsdf::GlossyLeaf(model) => model.f(self, wi),
            Bsdf::Rpv(_) | Bsdf::Soilspect(_) => directional::f(self, wi),
            Bsdf::Mapped(model) => model.f(self, wi),
        }
    }

    /// A direction in which a path continues, from three uniform numbers; `None` where everything is absorbed.
    /// Lobes are chosen in proportion to the power that each would carry.
    #[inline(always)]
    #[must_use]
    pub fn sample_f(&self, importance: Importance<'_>, u: [f64; 3]) -> Option<BsdfSample> {
        match self.bsdf() {
            Bsdf::BiLambertian(model) => model.sample_f(self, importance, u),
            Bsdf::GlossyLeaf(model) => model.sample_f(self, importance, u),
            Bsdf::Rpv(_) | Bsdf::Soilspect(_) => directional::sample_f(self, u),
            Bsdf::Mapped(model) => model.sample_f(self, importance, u),
        }
    }

    /// Density of [`Self::sample_f`], sr⁻¹. Tests hold it against the samples; no estimator needs it, as none combines
    /// two ways to sample a direction.
    #[must_use]
    pub fn pdf(&self, importance: Importance<'_>, wi: DVec3) -> f64 {
        match self.bsdf() {
            Bsdf::BiLambertian(model) => model.pdf(self, importance, wi),
            Bsdf::GlossyLeaf(model) => model.pdf(self, importance, wi),
            Bsdf::Rpv(_) | Bsdf::Soilspect(_) => directional::pdf(self, wi),
            Bsdf::Mapped(model) => model.pdf(self, wi),
        }
    }

    /// Fraction of the light from `wo` that is scattered, `DHR + DHT`.
    #[must_use]
    pub fn scattered_fraction(&self) -> Lobe {
        match self.bsdf() {
            Bsdf::BiLambertian(model) => model.scattered(self).into(),
            Bsdf::GlossyLeaf(model) => model.scattered_fraction(self),
            Bsdf::Rpv(model) => model.scattered_fraction(self),
            Bsdf::Soilspect(model) => model.scattered_fraction(self),
            Bsdf::Mapped(model) => model.reflected_fraction(self),
        }
    }

    /// Fraction of the light from `wo` that is absorbed, `1 - DHR - DHT`.
    #[must_use]
    pub fn absorbed_fraction(&self) -> Lobe {
        match self.bsdf() {
            Bsdf::BiLambertian(model) => model.absorbed_fraction(self),
            Bsdf::GlossyLeaf(model) => model.absorbed_fraction(self),
            Bsdf::Rpv(model) => model.absorbed_fraction(self),
            Bsdf::Soilspect(model) => model.absorbed_fraction(self),
            Bsdf::Mapped(model) => model.absorbed_fraction(self),
        }
    }

    /// Fraction of the light from `wo` that is scattered back to its side, DHR.
    #[must_use]
    pub fn reflected_fraction(&self) -> Lobe {
        match self.bsdf() {
            Bsdf::BiLambertian(model) => model.reflected(self).into(),
            Bsdf::GlossyLeaf(model) => model.reflected_fraction(self),
            Bsdf::Rpv(model) => model.scattered_fraction(self),
            Bsdf::Soilspect(model) => model.scattered_fraction(self),
            Bsdf::Mapped(model) => model.reflected_fraction(self),
        }
    }

    /// Returns whether `f` and the fractions depend on directions by their sides of the surface alone.
    #[must_use]
    pub fn is_diffuse(&self) -> bool {
        match self.bsdf() {
            Bsdf::BiLambertian(_) | Bsdf::Mapped(_) => true,
            Bsdf::GlossyLeaf(_) | Bsdf::Rpv(_) | Bsdf::Soilspect(_) => false,
        }
    }

    /// Returns whether a direction lies on the side of the surface that `wo` lies on.
    #[must_use]
    pub fn is_same_side(&self, w: DVec3) -> bool {
        self.is_front() == (self.normal.dot(w) >= 0.0)
    }

    /// Returns whether `wo` lies on the side that the normal points to.
    fn is_front(&self) -> bool {
        self.normal.dot(self.wo) >= 0.0
    }

    /// Cosine of the angle between `wo` and the surface's normal.
    fn cos_o(&self) -> f64 {
        self.normal.dot(self.wo).abs()
    }
}

impl Bsdf {
    /// Writes `π f` of a model that depends on both directions, in a range of lanes.
    fn evaluate(&self, angles: &Angles, lanes: Range<usize>, values: &mut [f32]) {
        match self {
            Self::Rpv(model) => model.evaluate(angles, lanes, values),
            Self::Soilspect(model) => model.evaluate(angles, lanes, values),
            Self::BiLambertian(_) | Self::GlossyLeaf(_) | Self::Mapped(_) => {
                unreachable!("{NO_MODEL_LOBE}")
            }
        }
    }

    /// Writes `π f` of a model that depends on both directions, in the representative bands.
    fn evaluate_representatives(&self, angles: &Angles, values: &mut [f32]) {
        match self {
            Self::Rpv(model) => model.evaluate_representatives(angles, values),
            Self::Soilspect(model) => model.evaluate_representatives(angles, values),
            Self::BiLambertian(_) | Self::GlossyLeaf(_) | Self::Mapped(_) => {
                unreachable!("{NO_MODEL_LOBE}")
            }
        }
    }
}

const NO_MODEL_LOBE: &str = "lobes of these models are spectra of the table, sums of two, or cells";

/// A spectrum padded with zeros to whole groups of [`LANES`].
#[must_use]
pub fn padded(spectrum: impl IntoIterator<Item = f32>) -> Box<[f32]> {
    let mut lanes: Vec<f32> = spectrum.into_iter().collect();
    lanes.resize(lanes.len().next_multiple_of(LANES), 0.0);
    lanes.into()
}
