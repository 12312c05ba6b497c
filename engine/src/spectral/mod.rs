//! Spectra as functions of wavelength (nm), and what a band sees of them.

mod band;
pub mod prospect;

pub use band::{BandWindow, OutsideSpectrum, band_mean};
