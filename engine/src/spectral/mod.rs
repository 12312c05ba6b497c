//! Spectra as functions of wavelength (nm), and what a band sees of them.

mod band;
mod planck;
pub mod prospect;
mod solar;

pub use band::{BandWindow, OutsideSpectrum, band_mean};
pub use planck::{brightness_temperature, planck, planck_mean, planck_mean_slope};
pub use solar::{ASTM_G173_END_NM, solar_irradiance};
