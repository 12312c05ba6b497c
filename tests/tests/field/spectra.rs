//! Spectra and leaf optics.
