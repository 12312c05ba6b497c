//! Spectra from files that a scene names.

use crate::assets::{SpectrumColumns, SpectrumTable, read_spectrum};
use crate::document::{Diagnostic, ScenePath, SpectrumFile, TabulatedSpectrum};
use crate::systems::Resources;

/// Points of a file that a spectrum or a response names.
pub(in crate::systems) fn read_columns(
    source: &SpectrumFile,
    path: &ScenePath,
    resources: &mut Resources,
) -> Result<SpectrumTable, Box<Diagnostic>> {
    let SpectrumFile { file, wavelength, value, wavelength_unit, wavelengths } = source;
    let wavelengths = wavelengths.as_ref().map(|file| resources.file(file));
    let columns = SpectrumColumns {
        wavelength: wavelength.as_deref(),
        value: value.as_deref(),
        unit: *wavelength_unit,
        wavelengths_file: wavelengths.as_deref(),
    };
    read_spectrum(&resources.file(file), &columns)
        .map_err(|error| Box::new(Diagnostic::error(path, error.to_string())))
}

/// Points (wavelength nm, value) of a table, without marks for no data; `None` if it cannot be read.
pub(super) fn table_points(
    spectrum: &TabulatedSpectrum,
    resources: &mut Resources,
) -> Option<Vec<(f64, f64)>> {
    let path = ScenePath::from("sun").key("irradiance").key("file");
    let table = read_columns(&spectrum.source, &path, resources).ok()?;
    let points = table.points.iter().map(|point| (point.wavelength, point.value * spectrum.scale));
    Some(points.filter(|(_, value)| value.is_finite() && *value >= 0.0).collect())
}
