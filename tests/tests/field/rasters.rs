//! Elevation, canopy height, density and land-cover rasters.
