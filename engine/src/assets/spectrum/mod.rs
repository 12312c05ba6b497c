//! Spectra from files: one reader for each format, behind a function that tells the format.

mod asd;
mod ecostress;
mod envi_library;
mod error;
mod format;
mod points;
mod table;
mod units;
mod usgs;

use std::path::Path;

use super::AssetError;
use crate::document::{ValueUnit, WavelengthUnit};

pub use error::SpectrumProblem;
pub use format::SpectrumFormat;

/// Columns of a spectrum that a scene names.
#[derive(Clone, Copy, Debug, Default)]
pub struct SpectrumColumns<'a> {
    /// Header of the column of wavelengths; if absent, `wavelength_nm` or the column whose name says that it holds
    /// wavelengths.
    pub wavelength: Option<&'a str>,
    /// Header of the column of values, or name of the spectrum in a library; if absent, the second column or the only
    /// spectrum.
    pub value: Option<&'a str>,
    /// Unit of the wavelengths; that which the file names if absent.
    pub unit: Option<WavelengthUnit>,
    /// File of the wavelengths, if the values stand alone.
    pub wavelengths_file: Option<&'a Path>,
}

/// One point of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectrumPoint {
    /// Wavelength, nm.
    pub wavelength: f64,
    /// Value in the file's unit; NaN where the file says that there is none.
    pub value: f64,
    /// Line of the file, or number of the channel where a file has no lines.
    pub line: usize,
}

/// A spectrum as a file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumTable {
    /// Format of the file.
    pub format: SpectrumFormat,
    /// Points in order of wavelength; two or more.
    pub points: Vec<SpectrumPoint>,
    /// Header of the column of values, or name of the spectrum.
    pub value: String,
    /// Headers of the columns that may hold values too, if none was asked for by name.
    pub others: Vec<String>,
    /// Unit of the values, if the file says so.
    pub unit: Option<ValueUnit>,
}

/// Reads a spectrum in order of wavelength.
///
/// In a table, other columns may hold anything, and titles may stand before the header. Wavelengths may fall instead
/// of rising.
///
/// # Errors
/// A file that cannot be read or is no spectrum; columns or names that it does not have; wavelengths that are out of
/// order, repeated or not above 0, or whose unit nothing says or cannot be the one that is said; fewer than two points.
pub fn read_spectrum(
    path: &Path,
    columns: &SpectrumColumns<'_>,
) -> Result<SpectrumTable, AssetError> {
    let format = SpectrumFormat::of_file(path)?;
    if let Some(other) = columns.wavelengths_file.filter(|_| format != SpectrumFormat::Usgs) {
        let problem = SpectrumProblem::NeedlessWavelengths { format, other: other.to_owned() };
        return Err(problem.of(path));
    }
    match format {
        SpectrumFormat::Table => table::read(path, columns),
        SpectrumFormat::Ecostress => ecostress::read(path, columns),
        SpectrumFormat::Usgs => usgs::read(path, columns),
        SpectrumFormat::EnviLibrary => envi_library::read(path, columns),
        SpectrumFormat::Asd => asd::read(path, columns),
    }
}
