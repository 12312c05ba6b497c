//! ENVI spectral libraries: spectra as rows of a binary array beside a text header.
//!
//! Source: ENVI header fields (NV5 Geospatial documentation): `samples` channels, `lines` spectra, `wavelength`,
//! `wavelength units`, `spectra names`, `reflectance scale factor`, `bbl`, `data ignore value`.

use crate::counts::counted;
use std::path::Path;

use super::super::AssetError;
use super::super::raster::EnviLibrary;
use super::super::table::nearest;
use super::error::list;
use super::points::PointList;
use super::units::{settled_unit, value_unit, wavelength_unit};
use super::{SpectrumColumns, SpectrumFormat, SpectrumProblem, SpectrumTable};

/// Reads one spectrum of a library.
pub(super) fn read(
    path: &Path,
    columns: &SpectrumColumns<'_>,
) -> Result<SpectrumTable, AssetError> {
    let format = SpectrumFormat::EnviLibrary;
    if let Some(name) = columns.wavelength {
        let (name, key) = (name.to_owned(), "wavelength");
        return Err(SpectrumProblem::NoColumns { format, name, key }.of(path));
    }
    let raster = |problem| AssetError::Raster { file: path.to_owned(), problem };
    let library = EnviLibrary::open(path).map_err(raster)?;
    let wrong = |problem: String| {
        let header = library.header_name().to_owned();
        SpectrumProblem::Library { header, problem }.of(path)
    };
    let names = names(&library);
    let row = chosen(&names, columns.value).map_err(|problem| problem.of(path))?;
    let channels = library.channels();
    let numbers = |key: &str| -> Result<Option<Vec<f64>>, AssetError> {
        let Some(text) = library.get(key) else { return Ok(None) };
        let read: Option<Vec<f64>> = text.split(',').map(|item| item.trim().parse().ok()).collect();
        match read {
            Some(numbers) if numbers.len() == channels => Ok(Some(numbers)),
            Some(numbers) => Err(wrong(format!(
                "lists {} as `{key}` for {}; list one for each",
                counted(numbers.len(), "number"),
                counted(channels, "channel")
            ))),
            None => {
                Err(wrong(format!("has something else than numbers in `{key}`; write numbers")))
            }
        }
    };
    let wavelengths = numbers("wavelength")?.ok_or_else(|| {
        wrong("has no `wavelength`; add a line `wavelength = {400.0, 410.0, ..}`".to_owned())
    })?;
    let is_good = numbers("bbl")?;
    let named = library.get("wavelength units").and_then(wavelength_unit);
    let said = library.get("wavelength units").unwrap_or_default();
    let first: Vec<String> = wavelengths.iter().take(3).map(f64::to_string).collect();
    let shown =
        || format!("`wavelength units = {said}`, `wavelength = {{{}, ..}}`", first.join(", "));
    let unit = settled_unit(columns, named, format, path, shown)?;
    let number = |key: &str| library.get(key).and_then(|text| text.parse::<f64>().ok());
    let factor = number("reflectance scale factor").filter(|&factor| factor > 0.0).unwrap_or(1.0);
    let ignored = number("data ignore value");
    let mut points = PointList::new(path, unit, columns.unit.is_some());
    for (channel, value) in library.spectrum(row).map_err(raster)?.into_iter().enumerate() {
        let is_bad = is_good.as_ref().is_some_and(|good| good[channel] == 0.0);
        let value = if is_bad || ignored == Some(value) { f64::NAN } else { value / factor };
        points.push(wavelengths[channel], value, channel + 1)?;
    }
    let titles = ["y plot title", "z plot titles", "data units"].map(|key| library.get(key));
    Ok(SpectrumTable {
        format,
        points: points.finish()?,
        value: names[row].clone(),
        others: Vec::new(),
        unit: titles.into_iter().flatten().find_map(value_unit),
    })
}

/// Names of all spectra; numbers where the header names none.
fn names(library: &EnviLibrary) -> Vec<String> {
    let written: Vec<&str> =
        library.get("spectra names").map_or_else(Vec::new, |text| text.split(',').collect());
    (0..library.spectra())
        .map(|row| match written.get(row).map(|name| name.trim()) {
            Some(name) if !name.is_empty() && written.len() == library.spectra() => name.to_owned(),
            _ => (row + 1).to_string(),
        })
        .collect()
}

/// Row of the spectrum with a name, or of the only one.
fn chosen(names: &[String], name: Option<&str>) -> Result<usize, SpectrumProblem> {
    match name {
        None if names.len() == 1 => Ok(0),
        None => Err(SpectrumProblem::ManySpectra {
            count: names.len(),
            example: names.first().cloned().unwrap_or_default(),
            names: list(names),
        }),
        Some(name) => names.iter().position(|known| known == name).ok_or_else(|| {
            let known: Vec<&str> = names.iter().map(String::as_str).collect();
            SpectrumProblem::UnknownSpectrum {
                name: name.to_owned(),
                nearest: nearest(name, &known),
                names: list(names),
            }
        }),
    }
}
