//! Keys that all images share, and images by parallel projection.

use super::{Band, Ends, Scene, System, VirtualPlane};

record! {
    /// Keys that all images have.
    pub struct ImageOptions ("options of an image") {
        /// Criteria that end the measurement; the number of samples then is no limit.
        until: Option<Ends> = None,
        /// Quantities to report.
        measure: Vec<ImageMeasure> = vec![ImageMeasure::Radiance],
        /// True if each image of light has a denoised one beside it, such as `brf_denoised`: `D = y + Σ a (G y - y)` with
        /// Gaussian filters `G` of four widths, whose weights `a` minimise Stein's (1981) unbiased estimate of the squared
        /// error around each pixel. Its standard errors include the bias of the filter.
        denoised: bool = false,
        /// Colours of its PNG.
        picture: Picture = Picture::Quicklook,
        /// Transport system that estimates it.
        system: System = System::Backward,
    }
}

record! {
    /// Parallel-projection image.
    pub struct Orthographic ("an orthographic image") {
        /// Columns and rows; either this or `pixel_m` is required.
        size_px: Option<(u32, u32)> => "(256, 256)" = None,
        /// Side of a square pixel in the plane perpendicular to the view, m, in place of `size_px`. A
        /// footprint that is no whole number of pixels grows around its middle to the next one.
        pixel_m: Option<f64> = None,
        /// Width and height of the footprint in the plane perpendicular to the view, m.
        extent_m: Option<(f64, f64)> = None,
        /// `WholeScene`, in place of `extent_m` and `center_m`.
        cover: Option<Cover> = None,
        /// Point on the ground in the middle of the image, m; the terrain's middle if absent.
        center_m: Option<(f64, f64)> = None,
        /// Zenith angle of the sensor, degrees.
        zenith_deg: f64 = 0.0,
        /// Azimuth of the sensor, clockwise from north, degrees. A nadir image has north up at 180.
        azimuth_deg: f64 = 180.0,
        /// Samples per pixel; 64 if neither this nor `samples_per_m2` is written.
        samples_per_px: Option<u32> = None,
        /// Samples per m² of the footprint, in place of `samples_per_px`.
        samples_per_m2: Option<f64> = None,
        /// Only light that leaves through it is seen.
        virtual_plane: Option<VirtualPlane> = None,
        /// Keys of all images; this one measures BRF by default.
        image as keys: ImageOptions =
            ImageOptions { measure: vec![ImageMeasure::Brf], ..ImageOptions::default() },
    }
}

choice! {
    /// Area that an orthographic image covers, in place of a rectangle.
    pub enum Cover ("what an image covers") {
        /// Everything that stands on the terrain's rectangle, from whichever side.
        WholeScene,
    }
}

choice! {
    /// Quantity of an image or of a list of directions.
    #[derive(Copy, Eq)]
    pub enum ImageMeasure ("a measure of an image") {
        /// Radiance, W m⁻² sr⁻¹ nm⁻¹, from the sources that the band names.
        Radiance,
        /// Bidirectional reflectance factor; under a sky it is the HDRF and is named so.
        Brf,
        /// The BRF, split as RAMI does: `brf_uc` (scattered once, by the ground), `brf_co_sgl`
        /// (once, by anything else) and `brf_mlt` (more often).
        Orders,
        /// Temperature of the black body of this radiance, K, in bands that hold emission.
        BrightnessTemperature,
        /// Shares of sunlit ground, sunlit canopy, shaded ground and shaded canopy in what is seen;
        /// of an image the dominant one too. Sunlit is where the sun is visible from the side that
        /// is seen, so a leaf that is lit from above is shaded from below; temperatures of `SunlitShaded`
        /// count both sides of it as sunlit. Ground is the terrain.
        FourComponents,
        /// Share of the ground in what is seen, or of the sky in a camera that looks up; of directions,
        /// and of a fisheye that looks straight up or down, the leaf area index that it implies too.
        GapFraction,
    }
}

impl ImageMeasure {
    /// Returns whether it is a function of radiance, rather than of the first surface along each ray.
    #[must_use]
    pub const fn is_light(&self) -> bool {
        match self {
            Self::Radiance | Self::Brf | Self::Orders | Self::BrightnessTemperature => true,
            Self::FourComponents | Self::GapFraction => false,
        }
    }

    /// Returns whether a transport system estimates it in a scene. `FirstOrder` and `Reference` measure reflected
    /// light, `FirstOrder` that of all orders only where no more than one counts; the surface that is seen first is
    /// measured backwards.
    #[must_use]
    pub fn is_measured_by(&self, system: System, scene: &Scene) -> bool {
        let is_single = scene.transport.most_orders() == 1;
        let (has_all_orders, has_parts, has_emission) = match system {
            System::Backward | System::Forward | System::Analog => (true, true, true),
            System::FirstOrder => (is_single, true, false),
            System::Reference => (true, false, false),
        };
        match self {
            Self::Orders => has_parts,
            Self::Brf => has_all_orders,
            Self::Radiance => {
                has_all_orders && (has_emission || !scene.bands.iter().any(Band::emits))
            }
            Self::BrightnessTemperature => has_emission,
            Self::FourComponents | Self::GapFraction => system == System::Backward,
        }
    }
}

choice! {
    /// Colours of the PNG of an image. The numbers are in the other files.
    pub enum Picture ("a picture") {
        /// Quick look: bands chosen by wavelength, each stretched.
        Quicklook,
        /// Three bands.
        Bands {
            /// Band that is shown as red.
            red: String => "\"nir\"",
            /// Band that is shown as green.
            green: String => "\"red\"",
            /// Band that is shown as blue.
            blue: String => "\"green\"",
            /// Stops over the exposure that shows a white surface on the horizontal as white;
            /// automatic if absent.
            exposure_stops: Option<f64> = None,
        },
        /// Colours as the eye sees them in daylight, from ten bands or more between 380 and 780 nm.
        Cie {
            /// Stops over the exposure that shows a white surface on the horizontal as white;
            /// automatic if absent.
            exposure_stops: Option<f64> = None,
        },
    }
}
