//! Files that results are written to.

choice! {
    /// File format of images; the last two hold tables too.
    #[derive(Copy, Eq)]
    pub enum FileFormat ("a file format") {
        /// `OpenEXR`: a float32 channel per band, its standard error and the coverage.
        Exr,
        /// ENVI rasters of float32 with text headers, `.img` and `.img.hdr`; standard errors and coverage in a second
        /// one, `_se.img`.
        Envi,
        /// Cloud-optimised `GeoTIFF` of float32, a band per spectral band; standard errors and coverage in a second one,
        /// `_se.tif`.
        GeoTiff,
        /// Pictures for the eye, with a legend and without.
        Png,
        /// Zarr store of all that a sensor measures, `<sensor>.zarr`: version 2 of the format, CF conventions.
        Zarr,
        /// `NetCDF` file of all that a sensor measures, `<sensor>.nc`: classic format, CF conventions.
        NetCdf,
    }
}

impl FileFormat {
    /// All formats.
    pub const ALL: [Self; 6] =
        [Self::Exr, Self::Envi, Self::GeoTiff, Self::Png, Self::Zarr, Self::NetCdf];

    /// Formats of a scene that names none.
    pub const DEFAULT: [Self; 3] = [Self::Exr, Self::Envi, Self::Png];

    /// Name in scenes and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exr => "Exr",
            Self::Envi => "Envi",
            Self::GeoTiff => "GeoTiff",
            Self::Png => "Png",
            Self::Zarr => "Zarr",
            Self::NetCdf => "NetCdf",
        }
    }
}
