//! Sun and sky.

use super::Spectrum;

record! {
    /// The sun.
    pub struct Sun ("the sun") {
        /// Angle from the vertical, degrees, below 90.
        zenith_deg: Option<f64> => "30.0" = None,
        /// Azimuth of the sun, clockwise from north, degrees.
        azimuth_deg: f64 = 0.0,
        /// Place and time that say where the sun is, in place of both angles. Below the horizon it gives no light:
        /// an error, or in a sweep a row without data, unless a sky of its own or emission is left.
        position: Option<SunPosition> = None,
        /// Angular diameter of the disc, degrees, of even radiance; 0 is a parallel beam, and the real
        /// sun has 0.533.
        disc_deg: f64 = 0.0,
        /// Irradiance on a plane perpendicular to the beam, W m⁻² nm⁻¹; with `sky: Fraction(..)`
        /// that of sun and sky together.
        irradiance: Spectrum = Spectrum::AstmG173,
    }
}

choice! {
    /// Source of the sun's position.
    pub enum SunPosition ("a position of the sun") {
        /// Position from place and time by the Solar Position Algorithm, accurate to 0.0003°.
        ///
        /// Source: Reda and Andreas (2004), Solar Energy 76, 577-589.
        Spa(..Spa),
    }
}

record! {
    /// Place and time for the Solar Position Algorithm.
    pub struct Spa ("a place and a time") {
        /// Year, month and day.
        date: (u32, u32, u32) => "(2026, 6, 21)",
        /// Hour, minute and second, each with a fraction if need be: `(12.5, 0, 0)`.
        time: (f64, f64, f64) => "(12, 0, 0)",
        /// Hours that the clock is ahead of UTC: 1 in Berlin in winter, -7 in Denver.
        utc_offset_h: f64 = 0.0,
        /// North is positive, degrees.
        latitude_deg: f64 => "52.5",
        /// East is positive, degrees.
        longitude_deg: f64 => "13.4",
        /// Above sea level, m.
        altitude_m: f64 = 0.0,
        /// Air pressure of the refraction, hPa; 0 leaves refraction out.
        pressure_hpa: f64 = 1013.25,
        /// Air temperature of the refraction, °C.
        temperature_c: f64 = 15.0,
        /// Terrestrial time less universal time, s; estimated from the date if absent.
        delta_t_s: Option<f64> = None,
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
