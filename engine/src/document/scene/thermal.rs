//! Emission of surfaces and of the sky.

use super::{Band, ImageMeasure, PhotonMeasure, Scene, Spectrum};

/// Beyond this wavelength surfaces on Earth radiate more than they reflect of the sun, nm.
pub(crate) const THERMAL_NM: f64 = 3000.0;

choice! {
    /// Sources of the radiance in a band.
    pub enum BandSource ("a source of a band's radiance") {
        /// Sun and sky up to 3000 nm, `Emission` where the centre lies beyond.
        Auto,
        /// Reflected light of sun and sky alone.
        Sunlight,
        /// Emission of surfaces and of `thermal_sky`, with its reflections, alone.
        Emission,
        /// Their sum; for 3 to 5 µm by day.
        Both,
    }
}

choice! {
    /// A temperature, K.
    pub enum Temperature ("a temperature") {
        /// One temperature everywhere.
        Uniform(f64 => "300.0"),
        /// One where the sun's disc is visible from the point, on whichever side of the surface, and one where
        /// it is not: both sides of a sunlit leaf have its sunlit temperature. In the penumbra each counts by
        /// the visible fraction of the disc. `FourComponents` count by the side that is seen.
        SunlitShaded {
            /// Temperature where the sun is visible from either side, K.
            sunlit_k: f64 => "305.0",
            /// Temperature where it is visible from neither, K.
            shaded_k: f64 => "295.0",
        },
        /// Sunlit `mean_k + delta_k / 2`, shaded `mean_k - delta_k / 2`.
        MeanDelta {
            /// Mean of the two, K.
            mean_k: f64 => "300.0",
            /// Sunlit less shaded, K.
            delta_k: f64 => "10.0",
        },
    }
}

choice! {
    /// Emission of the sky.
    pub enum ThermalSky ("a thermal sky") {
        /// Nothing.
        None,
        /// Isotropic, like a black body of this temperature, K.
        BlackBody(f64 => "250.0"),
        /// Isotropic, of this radiance, W m⁻² sr⁻¹ nm⁻¹; π times that falls on the horizontal plane.
        Radiance(Spectrum => "Constant(0.004)"),
    }
}

impl Temperature {
    /// Temperatures where the sun is visible and where it is not, K.
    #[must_use]
    pub fn sunlit_and_shaded(&self) -> (f64, f64) {
        match *self {
            Self::Uniform(kelvin) => (kelvin, kelvin),
            Self::SunlitShaded { sunlit_k, shaded_k } => (sunlit_k, shaded_k),
            Self::MeanDelta { mean_k, delta_k } => (mean_k + 0.5 * delta_k, mean_k - 0.5 * delta_k),
        }
    }

    /// Returns whether sunlit and shaded temperatures differ, so that a sun is needed.
    #[must_use]
    pub fn needs_sun(&self) -> bool {
        let (sunlit, shaded) = self.sunlit_and_shaded();
        sunlit.total_cmp(&shaded).is_ne()
    }
}

impl Band {
    /// Returns whether its radiance includes emission.
    #[must_use]
    pub fn emits(&self) -> bool {
        match self.source {
            BandSource::Auto => self.nominal_nm().is_some_and(|center| center > THERMAL_NM),
            BandSource::Sunlight => false,
            BandSource::Emission | BandSource::Both => true,
        }
    }

    /// Returns whether its radiance includes reflected light of sun and sky.
    #[must_use]
    pub fn reflects(&self) -> bool {
        matches!(self.source, BandSource::Both) || !self.emits()
    }
}

impl Scene {
    /// Returns whether any sensor measures emitted radiance.
    #[must_use]
    pub fn measures_emission(&self) -> bool {
        self.bands.iter().any(Band::emits)
            && self.sensors.values().any(|sensor| {
                sensor.any_measure(ImageMeasure::is_radiance, PhotonMeasure::is_absolute)
            })
    }
}

impl ImageMeasure {
    /// Returns whether it needs the radiance of the band's own sources.
    #[must_use]
    pub const fn is_radiance(&self) -> bool {
        match self {
            Self::Radiance | Self::BrightnessTemperature => true,
            Self::Brf | Self::Orders | Self::FourComponents | Self::GapFraction => false,
        }
    }
}

impl PhotonMeasure {
    /// Returns whether it is a radiance.
    #[must_use]
    pub const fn is_radiance(&self) -> bool {
        match self {
            Self::RadianceCells(_) | Self::RadianceViews(_) | Self::RadianceCones(_) => true,
            Self::BrfCells(_)
            | Self::BrfViews(_)
            | Self::BrfCones(_)
            | Self::Albedo
            | Self::Exitance
            | Self::BrightnessTemperature
            | Self::Orders
            | Self::Fapar { .. }
            | Self::Absorbed { .. }
            | Self::Fluxes { .. } => false,
        }
    }

    /// Returns whether it is in absolute units, from the band's own sources.
    #[must_use]
    pub const fn is_absolute(&self) -> bool {
        match self {
            Self::RadianceCells(_)
            | Self::RadianceViews(_)
            | Self::RadianceCones(_)
            | Self::Exitance
            | Self::Fluxes { .. } => true,
            Self::BrfCells(_)
            | Self::BrfViews(_)
            | Self::BrfCones(_)
            | Self::Albedo
            | Self::BrightnessTemperature
            | Self::Orders
            | Self::Fapar { .. }
            | Self::Absorbed { .. } => false,
        }
    }
}
