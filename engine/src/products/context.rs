use super::{AxisPoints, Product, ProductAxis};
use crate::document::FileFormat;
use crate::spectral::BandResponse;

/// Bands and light that all products of a run have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Context {
    /// Number of scenes whose bands ride on the same paths: `bands` holds those of the first, then those of the next,
    /// and so on.
    pub scenes: usize,
    /// Names of the bands.
    pub bands: Vec<String>,
    /// Total irradiance on the horizontal plane, W m⁻² nm⁻¹, shape `[bands]`.
    pub irradiance: Vec<f64>,
    /// True if there is light of the sky: factors are then hemispherical-directional.
    pub has_sky: bool,
    /// Anchor of the local frame: easting and northing of its origin, m.
    pub origin: (f64, f64),
    /// File formats of images.
    pub formats: Vec<FileFormat>,
    /// Sources of the radiance, shape `[bands]`.
    pub sources: Vec<BandSources>,
}

/// Wavelengths of a band, and sources of its radiance.
#[derive(Clone, Debug, PartialEq)]
pub struct BandSources {
    /// Centre wavelength, nm.
    pub center_nm: f64,
    /// Response to the wavelengths.
    pub response: BandResponse,
    /// True if the band holds the emission of surfaces and sky.
    pub emits: bool,
    /// True if the band holds reflected light of sun and sky.
    pub reflects: bool,
}

impl Context {
    /// The bands of all of these contexts, which are alike otherwise, one behind the other.
    ///
    /// # Panics
    /// If there is none.
    #[must_use]
    pub fn joined(all: &[&Self]) -> Self {
        let mut joined = (*all.first().expect("a context")).clone();
        for &next in &all[1..] {
            joined.scenes += next.scenes;
            joined.bands.extend_from_slice(&next.bands);
            joined.irradiance.extend_from_slice(&next.irradiance);
            joined.sources.extend_from_slice(&next.sources);
            joined.has_sky |= next.has_sky;
        }
        joined
    }

    /// Names of the bands that hold emission.
    #[must_use]
    pub fn emitting(&self) -> Vec<String> {
        let pairs = self.bands.iter().zip(&self.sources);
        pairs.filter(|(_, source)| source.emits).map(|(name, _)| name.clone()).collect()
    }

    /// Replaces the irradiance by 1 in each band.
    #[must_use]
    pub fn with_unit_irradiance(&self) -> Self {
        Self { irradiance: vec![1.0; self.bands.len()], ..self.clone() }
    }

    /// Name of the reflectance factor that this light allows.
    #[must_use]
    pub const fn factor(&self) -> &'static str {
        if self.has_sky { "hdrf" } else { "brf" }
    }

    /// A product over these dimensions and the bands, its error scaled as its values are.
    pub(super) fn product(
        &self,
        (name, unit): (impl Into<String>, &str),
        dimensions: Vec<Vec<ProductAxis>>,
        (values, standard_error): (&[f64], &[f64]),
        scale: impl Fn(&[f64], &[f64]) -> Vec<f64>,
    ) -> Product {
        let mut dimensions = dimensions;
        dimensions.push(vec![labels("band", &self.bands)]);
        Product {
            name: name.into(),
            unit: unit.to_owned(),
            dimensions,
            values: scale(values, &self.irradiance),
            standard_error: scale(standard_error, &self.irradiance),
            image: None,
            faces: None,
            replicates: Vec::new(),
        }
    }
}

pub(super) fn labels(name: &str, labels: &[String]) -> ProductAxis {
    ProductAxis { name: name.to_owned(), points: AxisPoints::Labels(labels.to_vec()) }
}

pub(super) fn numbers(name: &str, values: impl IntoIterator<Item = f64>) -> ProductAxis {
    ProductAxis { name: name.to_owned(), points: AxisPoints::Numbers(values.into_iter().collect()) }
}
