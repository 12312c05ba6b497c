//! Materials: surface models with their spectra.

use super::{FilePath, Map, Param, Spectrum, Temperature};

choice! {
    /// A surface.
    pub enum Material ("a material") {
        /// Reflects diffusely on both sides; opaque.
        Lambertian(..Lambertian),
        /// Reflects and transmits diffusely.
        Leaf(..Leaf),
        /// Reflects by the model of Rahman, Pinty and Verstraete, on both sides; opaque. For soil, snow, or
        /// vegetation seen from afar.
        ///
        /// Source: Rahman, Pinty & Verstraete (1993), J. Geophys. Res. 98 (D11), 20791–20801.
        Rpv(..Rpv),
        /// Reflects by the SOILSPECT model, on both sides; opaque.
        ///
        /// Source: Jacquemoud, Baret & Hanocq (1992), Remote Sens. Environ. 41, 123–132.
        Soilspect(..Soilspect),
        /// Reflects diffusely on both sides, in each cell of a raster as much as its values say; opaque. For the
        /// terrain alone.
        ReflectanceMap(..ReflectanceMap),
    }
}

record! {
    /// Opaque surface that reflects diffusely.
    pub struct Lambertian ("a Lambertian surface") {
        /// Reflectance of the front side, and of the back unless that is given.
        reflectance: Spectrum => "Constant(0.3)",
        /// Reflectance of the back side.
        back_reflectance: Option<Spectrum> = None,
        /// Temperature; needed where a sensor measures its emission.
        temperature: Option<Temperature> = None,
    }
}

record! {
    /// Surface that reflects and transmits diffusely.
    pub struct Leaf ("a leaf surface") {
        /// Reflectance of the front side, and of the back unless that is given.
        reflectance: Spectrum => "Constant(0.3)",
        /// Transmittance, the same in both directions.
        transmittance: Spectrum => "Constant(0.2)",
        /// Reflectance of the back side.
        back_reflectance: Option<Spectrum> = None,
        /// Specular coating of both sides. Reflectance and transmittance are then those of the body beneath it.
        coating: Option<Coating> = None,
        /// Temperature; needed where a sensor measures its emission.
        temperature: Option<Temperature> = None,
    }
}

record! {
    /// Rough dielectric coating of a leaf, with the specular lobe of Cook & Torrance (1982).
    pub struct Coating ("a coating") {
        /// Real refractive index, 1.1 to 2.
        refractive_index: f64 = 1.45,
        /// Root mean square slope of the surface, 0.05 to 1: about 0.1 for glossy leaves, 0.5 for dull ones.
        roughness: f64 = 0.3,
    }
}

record! {
    /// Surface of the RPV model. Beyond a zenith angle of 85° its bowl shape is that of 85°.
    pub struct Rpv ("an RPV surface") {
        /// Amplitude ρ0.
        rho0: Spectrum => "Constant(0.1)",
        /// Bowl shape k: below 1, reflectance rises towards the horizon.
        k: Spectrum => "Constant(0.8)",
        /// Asymmetry Θ, -1 to 1: below 0, more is reflected back towards the light.
        asymmetry: Spectrum => "Constant(-0.1)",
        /// Hot spot ρc: the smaller, the higher the hot spot; ρ0 if absent.
        rho_c: Option<Spectrum> = None,
        /// Temperature; needed where a sensor measures its emission.
        temperature: Option<Temperature> = None,
    }
}

record! {
    /// Surface of the SOILSPECT model.
    pub struct Soilspect ("a SOILSPECT surface") {
        /// Single-scattering albedo ω, 0 to 1.
        albedo: Spectrum => "Constant(0.4)",
        /// Roughness h: the larger, the wider the hot spot.
        roughness: Spectrum => "Constant(0.2)",
        /// Amplitude of the hot spot, 1 in the paper.
        hot_spot: Spectrum = Spectrum::Constant(1.0),
        /// First Legendre coefficient of the phase angle, b.
        b: Spectrum = Spectrum::Constant(0.0),
        /// Second Legendre coefficient of the phase angle, c.
        c: Spectrum = Spectrum::Constant(0.0),
        /// First Legendre coefficient of the angle to the mirror direction, b'.
        b_prime: Spectrum = Spectrum::Constant(0.0),
        /// Second Legendre coefficient of the angle to the mirror direction, c'.
        c_prime: Spectrum = Spectrum::Constant(0.0),
        /// Temperature; needed where a sensor measures its emission.
        temperature: Option<Temperature> = None,
    }
}

record! {
    /// Ground whose reflectance comes from a raster, cell by cell: a place has the reflectance of the cell that it lies
    /// in, without interpolation. The raster lies where its file says, less the frame's origin.
    pub struct ReflectanceMap ("a map of reflectance") {
        /// Raster: `GeoTIFF`, ENVI, Esri's `.bil` and `.flt`, or an ESRI ASCII grid; relative to the scene file.
        file: FilePath => r#""albedo.tif""#,
        /// Bands of the raster that the bands of the scene have their reflectance from.
        bands: RasterBands => "All(1)",
        /// Factor that makes fractions of the numbers in the file, in place of the file's own: 1.0 for fractions,
        /// 0.01 for percent, 0.0001 for reflectances that are kept as 0 to 10000. A file that says neither scale
        /// nor offset is refused without it.
        scale: Option<f64> => "0.0001" = None,
        /// Number that is added to `scale` times the number in the file: -0.1 for products of Sentinel-2 since 2022.
        offset: f64 = 0.0,
        /// Reflectance of cells without data and of ground beside the raster; both are errors without it.
        elsewhere: Option<Spectrum> = None,
        /// Temperature; needed where a sensor measures its emission.
        temperature: Option<Temperature> = None,
    }
}

choice! {
    /// Bands of a raster that the bands of the scene have their values from.
    pub enum RasterBands ("bands of a raster") {
        /// One band for all bands of the scene, by its number from 1 or its name.
        All(Param => "1"),
        /// A band for each band of the scene, by its number from 1 or its name.
        Each(Map<Param> => r#"{ "red": 3, "nir": "B8" }"#),
        /// All bands, by the wavelengths that the file gives them: joined by straight lines and averaged over each band
        /// of the scene.
        Wavelengths,
    }
}

impl Material {
    /// Returns whether it is a leaf: its area counts as leaf area.
    #[must_use]
    pub const fn is_leaf(&self) -> bool {
        match self {
            Self::Leaf(_) => true,
            Self::Lambertian(_) | Self::Rpv(_) | Self::Soilspect(_) | Self::ReflectanceMap(_) => {
                false
            }
        }
    }

    /// A surface of the same model without values by band or temperature: paths along surfaces that are equal in that
    /// can be shared.
    #[must_use]
    pub fn without_values(&self) -> Self {
        let zero = || Spectrum::Constant(0.0);
        match self {
            Self::Lambertian(_) => Self::Lambertian(Lambertian::new(zero())),
            Self::Leaf(leaf) => {
                Self::Leaf(Leaf { coating: leaf.coating.clone(), ..Leaf::new(zero(), zero()) })
            }
            Self::Rpv(_) => Self::Rpv(Rpv::new(zero(), zero(), zero())),
            Self::Soilspect(_) => Self::Soilspect(Soilspect::new(zero(), zero())),
            // Its values are read from a file once for all paths that are shared.
            Self::ReflectanceMap(map) => {
                Self::ReflectanceMap(ReflectanceMap { temperature: None, ..map.clone() })
            }
        }
    }

    /// Its temperature, if it was given.
    #[must_use]
    pub const fn temperature(&self) -> Option<&Temperature> {
        match self {
            Self::Lambertian(surface) => surface.temperature.as_ref(),
            Self::Leaf(leaf) => leaf.temperature.as_ref(),
            Self::Rpv(surface) => surface.temperature.as_ref(),
            Self::Soilspect(soil) => soil.temperature.as_ref(),
            Self::ReflectanceMap(map) => map.temperature.as_ref(),
        }
    }

    /// All spectra, each with its key and the quantity that it holds.
    #[must_use]
    pub fn spectra(&self) -> Vec<(&'static str, &Spectrum, SurfaceQuantity)> {
        use SurfaceQuantity::{Fraction, Parameter};
        let signed = Parameter { least: -1e3, most: 1e3 };
        let positive = Parameter { least: 0.0, most: 1e3 };
        match self {
            Self::Lambertian(Lambertian { reflectance, back_reflectance, .. }) => {
                let back = back_reflectance.as_ref();
                let back = back.map(|back| ("back_reflectance", back, Fraction));
                [("reflectance", reflectance, Fraction)].into_iter().chain(back).collect()
            }
            Self::Leaf(Leaf { reflectance, transmittance, back_reflectance, .. }) => {
                let back = back_reflectance.as_ref();
                let back = back.map(|back| ("back_reflectance", back, Fraction));
                let sides = [
                    ("reflectance", reflectance, Fraction),
                    ("transmittance", transmittance, Fraction),
                ];
                sides.into_iter().chain(back).collect()
            }
            Self::Rpv(Rpv { rho0, k, asymmetry, rho_c, .. }) => {
                let rho_c = rho_c.as_ref().map(|rho_c| ("rho_c", rho_c, positive));
                let parameters = [
                    ("rho0", rho0, positive),
                    ("k", k, positive),
                    ("asymmetry", asymmetry, Parameter { least: -0.99, most: 0.99 }),
                ];
                parameters.into_iter().chain(rho_c).collect()
            }
            Self::Soilspect(soil) => vec![
                ("albedo", &soil.albedo, Fraction),
                ("roughness", &soil.roughness, Parameter { least: 1e-3, most: 1e3 }),
                ("hot_spot", &soil.hot_spot, positive),
                ("b", &soil.b, signed),
                ("c", &soil.c, signed),
                ("b_prime", &soil.b_prime, signed),
                ("c_prime", &soil.c_prime, signed),
            ],
            Self::ReflectanceMap(map) => {
                map.elsewhere.iter().map(|spectrum| ("elsewhere", spectrum, Fraction)).collect()
            }
        }
    }
}

/// Quantity of a spectrum of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SurfaceQuantity {
    /// Reflectance, transmittance or albedo, 0 to 1.
    Fraction,
    /// Parameter of a surface model within these bounds.
    Parameter {
        /// Minimum.
        least: f64,
        /// Maximum.
        most: f64,
    },
}
