//! Sun and sky.

use std::borrow::Cow;

use super::super::decode::{Decode, Fields, Reader, Variant, example_of_keys};
use super::super::encode::{Encode, Text, differs};
use super::super::syntax::Node;
use super::Spectrum;

record! {
    /// The sun.
    pub struct Sun ("the sun") {
        /// Angle from the vertical, degrees, below 90.
        zenith_deg: f64 => "30.0",
        /// Where the sun is, clockwise from north, degrees.
        azimuth_deg: f64 = 0.0,
        /// Irradiance on a plane perpendicular to the beam, W m⁻² nm⁻¹; with `sky: Fraction(..)`
        /// that of sun and sky together.
        irradiance: Spectrum = Spectrum::Constant(1.0),
    }
}

choice! {
    /// The sky.
    pub enum Sky ("a sky") {
        /// Black.
        None,
        /// Isotropic; the share of the total irradiance that is diffuse, band by band
        /// (`SKY_TO_TOTAL`): the sun keeps `irradiance (1 - s)`, the sky gives the horizontal plane
        /// `irradiance s cos(sun zenith)`.
        Fraction(Vec<f64> => "[0.1, 0.05]"),
        /// Isotropic, of its own irradiance.
        Isotropic {
            /// Irradiance on the horizontal plane, W m⁻² nm⁻¹.
            irradiance: Spectrum => "Constant(0.2)",
        },
    }
}
