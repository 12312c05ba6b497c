//! Spectra as functions of wavelength (nm), and what a band sees of them.

mod band;
mod library;
pub mod observer;
mod planck;
pub mod prospect;
mod response;
mod sensors;
mod solar;

/// Shortest wavelength of spectra and responses, nm: far ultraviolet.
pub const SHORTEST_NM: f64 = 100.0;

/// Longest wavelength of spectra and responses, nm: microwaves of 1 mm.
pub const LONGEST_NM: f64 = 1e6;

pub use band::{BandWindow, OutsideSpectrum, band_mean};
pub use library::{library_names, library_spectrum, soil_reflectance};
pub use planck::{brightness_temperature, planck, planck_mean, planck_mean_slope};
pub use response::{BandResponse, InvalidResponse, ResponseCurve, ResponseRecord};
pub use sensors::{SensorBand, sensor_bands, sensor_names};
pub use solar::{ASTM_E490, ASTM_G173, SolarSpectrum};
