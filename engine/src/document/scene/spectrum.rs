//! Spectra and the materials that have them.

use std::borrow::Cow;

use super::super::decode::{Decode, Reader, Variant, example_of_keys};
use super::super::encode::{Encode, Text, differs};
use super::super::syntax::Node;
use super::Temperature;

choice! {
    /// A quantity as a function of wavelength, or given band by band.
    pub enum Spectrum ("a spectrum") {
        /// The same at every wavelength.
        Constant(f64 => "0.3"),
        /// One value for each band of this scene.
        Bands(Vec<f64> => "[0.1, 0.2]"),
        /// Points (wavelength nm, value), joined by straight lines and averaged over each band.
        Points(Vec<(f64, f64)> => "[(400.0, 0.05), (800.0, 0.3)]"),
        /// Such points from two columns of a CSV file.
        Table {
            /// Path, relative to the scene file.
            file: String => r#""spectra/soil.csv""#,
            /// Header of the column of wavelengths, nm.
            wavelength: String = "wavelength_nm".to_owned(),
            /// Header of the column of values; if absent, the second column of the file.
            value: Option<String> = None,
        },
        /// One of the scene's `spectra`.
        Named(String => r#""soil""#),
        /// Leaf reflectance or transmittance (whichever the key asks for) by PROSPECT-PRO.
        Prospect {
            /// Leaf structure parameter N, 1 to 3.
            n: f64 = 1.5,
            /// Chlorophyll a + b, µg cm⁻².
            chlorophyll_ug_cm2: f64 = 40.0,
            /// Carotenoids, µg cm⁻².
            carotenoid_ug_cm2: f64 = 8.0,
            /// Anthocyanins, µg cm⁻².
            anthocyanin_ug_cm2: f64 = 0.0,
            /// Brown pigments, arbitrary units.
            brown: f64 = 0.0,
            /// Equivalent water thickness, cm.
            water_cm: f64 = 0.01,
            /// Dry matter, g cm⁻²; 0 where proteins and other carbon are given instead.
            dry_matter_g_cm2: f64 = 0.009,
            /// Proteins, g cm⁻².
            protein_g_cm2: f64 = 0.0,
            /// Carbon-based constituents other than proteins, g cm⁻².
            carbon_g_cm2: f64 = 0.0,
        },
    }
}

choice! {
    /// A surface.
    pub enum Material ("a material") {
        /// Reflects diffusely on both sides; opaque.
        Lambertian {
            /// Reflectance of the front side, and of the back unless that is given.
            reflectance: Spectrum => "Constant(0.3)",
            /// Reflectance of the back side.
            back_reflectance: Option<Spectrum> = None,
            /// How warm it is; needed where a sensor measures what it emits.
            temperature: Option<Temperature> = None,
        },
        /// Reflects and transmits diffusely.
        Leaf {
            /// Reflectance of the front side, and of the back unless that is given.
            reflectance: Spectrum => "Constant(0.3)",
            /// Transmittance, the same in both directions.
            transmittance: Spectrum => "Constant(0.2)",
            /// Reflectance of the back side.
            back_reflectance: Option<Spectrum> = None,
            /// How warm it is; needed where a sensor measures what it emits.
            temperature: Option<Temperature> = None,
        },
    }
}
