//! Spectra.

use super::{FilePath, Ref};

choice! {
    /// A quantity as a function of wavelength, or given band by band.
    pub enum Spectrum ("a spectrum") {
        /// One value for all wavelengths.
        Constant(f64 => "0.3"),
        /// One value for each band of this scene.
        Bands(Vec<f64> => "[0.1, 0.2]"),
        /// Points (wavelength nm, value), joined by straight lines and averaged over each band.
        Points(Vec<(f64, f64)> => "[(400.0, 0.05), (800.0, 0.3)]"),
        /// Points of a spectrum in a file: a CSV file or a spectral library.
        Table(..TabulatedSpectrum),
        /// Irradiance of the sun and of the 2.9° around it on a plane that faces it, under a clear sky at
        /// air mass 1.5: 280 to 4000 nm.
        ///
        /// Source: ASTM G173-03, direct + circumsolar.
        AstmG173,
        /// Irradiance of the sun outside the atmosphere at its mean distance, on a plane that faces it: 119.5 nm to
        /// 1 mm.
        ///
        /// Source: ASTM E490-00a.
        AstmE490,
        /// Reflectance that comes with sunfleck, 400 to 2450 nm or more: `litter_douglas_fir`, `litter_ponderosa_pine`,
        /// `litter_lodgepole_pine`, `litter_subalpine_fir`, `litter_needles`, `litter_mixed`, `litter_cottonwood`,
        /// `litter_fern`, `grass_dead`, `grass_golden`, `bark_birch`, `bark_aspen`, `bark_spruce`, `bark_dead`, `twig_dead`,
        /// `wood_old`, `wood_stump`, `wood_bleached`, `soil_charred`, `bark_charred`, `ash` (measured; the Joint Fire
        /// Science Program by way of earthlib); `snow_fresh`, `snow_settled`, `snow_old`, `snow_wet` (computed for grains of 60,
        /// 20, 8 and 4 m² kg⁻¹; Kokhanovsky and Zege 2004).
        Library(String => r#""bark_birch""#),
        /// Reflectance of a soil, 400 to 2500 nm: a dry and a wet one, mixed.
        ///
        /// Source: the soils of PROSAIL (Jacquemoud et al. 2009).
        Soil(..SoilMixture),
        /// One of the scene's `spectra`.
        Named(Ref<Spectrum> => r#""soil""#),
        /// Leaf reflectance or transmittance (whichever the key asks for) by PROSPECT-PRO.
        Prospect(..Prospect),
    }
}

record! {
    /// A spectrum in a file: columns of a CSV file (also text that ASD's `ViewSpec` Pro and SPECCHIO export), an ENVI
    /// spectral library (`.sli` beside its `.hdr`), a text of the ECOSTRESS or of the USGS library (splib07), a binary
    /// file of an ASD spectrometer. The file tells which.
    pub struct SpectrumFile ("a file of a spectrum") {
        /// Path, relative to the scene file.
        file: FilePath => r#""spectra/soil.csv""#,
        /// Header of the column of wavelengths; if absent, `wavelength_nm`, or the first column whose name says that it
        /// holds wavelengths.
        wavelength: Option<String> = None,
        /// Header of the column of values, or name of the spectrum in a library; if absent, the second column of the
        /// file, or its only spectrum.
        value: Option<String> = None,
        /// Unit of the wavelengths; if absent, that which the file names. A file that names none is refused without it.
        wavelength_unit: Option<WavelengthUnit> = None,
        /// File of the wavelengths of a spectrum of the USGS library, whose own file has none.
        wavelengths: Option<FilePath> = None,
    }
}

record! {
    /// Spectrum from a file.
    pub struct TabulatedSpectrum ("a table of a spectrum") {
        /// File and its columns.
        source as keys: SpectrumFile,
        /// Unit of reflectances and transmittances; if absent, percent where the file says so, else fractions. A file
        /// with values that are none is refused without it.
        unit: Option<ValueUnit> = None,
        /// Factor on all values: 0.0001 for reflectances that are kept as 0 to 10000, 0.001 for an
        /// irradiance in W m⁻² µm⁻¹.
        scale: f64 = 1.0,
    }
}

record! {
    /// Soil between a dry and a wet one: `brightness (dryness ρ_dry + (1 - dryness) ρ_wet)`.
    pub struct SoilMixture ("a soil") {
        /// Share of the dry soil, 0 (wet) to 1 (dry).
        dryness: f64 = 1.0,
        /// Factor on the reflectance, 0 to 2.
        brightness: f64 = 1.0,
    }
}

record! {
    /// Leaf for PROSPECT-PRO.
    pub struct Prospect ("a leaf") {
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
    }
}

choice! {
    /// Unit of the wavelengths in a table.
    #[derive(Copy, Eq)]
    pub enum WavelengthUnit ("a unit of wavelengths") {
        /// nm.
        Nanometres,
        /// µm, 1000 nm.
        Micrometres,
        /// Å, 0.1 nm.
        Angstroms,
        /// Waves per cm: 10⁷ nm over their number is the wavelength.
        Wavenumbers,
    }
}

choice! {
    /// Unit of the reflectances or transmittances in a table.
    #[derive(Copy, Eq)]
    pub enum ValueUnit ("a unit of values") {
        /// Fractions from 0 to 1.
        Fraction,
        /// Percent from 0 to 100.
        Percent,
    }
}

impl WavelengthUnit {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::Nanometres, Self::Micrometres, Self::Angstroms, Self::Wavenumbers];

    /// Its name in the language.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nanometres => "Nanometres",
            Self::Micrometres => "Micrometres",
            Self::Angstroms => "Angstroms",
            Self::Wavenumbers => "Wavenumbers",
        }
    }

    /// Wavelength in nm of a number in this unit.
    #[must_use]
    pub fn nanometres(self, value: f64) -> f64 {
        match self {
            Self::Nanometres => value,
            Self::Micrometres => value * 1e3,
            Self::Angstroms => value / 10.0,
            Self::Wavenumbers => 1e7 / value,
        }
    }
}
