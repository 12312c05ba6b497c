//! Unit conversion at the boundary, and physical constants with their source.

/// Nanometres in a metre.
pub const NM_PER_M: f64 = 1e9;

/// Planck constant, J s. Source: SI (2019), exact.
pub const PLANCK: f64 = 6.626_070_15e-34;

/// Speed of light in vacuum, m s⁻¹. Source: SI (2019), exact.
pub const LIGHT_SPEED: f64 = 299_792_458.0;

/// Boltzmann constant, J K⁻¹. Source: SI (2019), exact.
pub const BOLTZMANN: f64 = 1.380_649e-23;
