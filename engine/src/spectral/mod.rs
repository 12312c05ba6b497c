//! Spectra as functions of wavelength (nm), and what a band sees of them.

mod band;
mod library;
pub mod observer;
mod planck;
pub mod prospect;
mod response;
mod sensors;
mod solar;

pub use band::{BandWindow, OutsideSpectrum, band_mean};
pub use library::{library_names, library_spectrum, soil_reflectance};
pub use planck::{brightness_temperature, planck, planck_mean, planck_mean_slope};
pub use response::{BandResponse, InvalidResponse, ResponseCurve, ResponseRecord};
pub use sensors::{SensorBand, sensor_bands, sensor_names};
pub use solar::{ASTM_E490, ASTM_G173, SolarSpectrum};
