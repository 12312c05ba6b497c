//! Text of the USGS spectral library version 7: a title, then one value a line; the wavelengths of each spectrometer
//! stand in a file of their own, which is alike.
//!
//! Values are reflectances as fractions; deleted channels are -1.23e34. Source: Kokaly et al. (2017), USGS Data Series
//! 1035, `ASCIIdata`.

use std::path::{Path, PathBuf};

use super::super::AssetError;
use super::super::text::{TextLines, number};
use super::points::PointList;
use super::units::{settled_unit, wavelength_unit};
use super::{SpectrumColumns, SpectrumFormat, SpectrumProblem, SpectrumTable};
use crate::document::ValueUnit;

/// Most values of a file: the library's spectra have some thousands.
const MOST_VALUES: usize = 1 << 20;

/// A title and the numbers below it, each with its line.
struct OneColumn {
    title: String,
    numbers: Vec<(usize, f64)>,
}

impl OneColumn {
    fn read(path: &Path) -> Result<Self, AssetError> {
        let mut lines = TextLines::open(path)?;
        let title = lines.next()?.map_or_else(String::new, |(_, text)| text.to_owned());
        let mut numbers = Vec::new();
        while let Some((line, text)) = lines.next()? {
            if numbers.len() == MOST_VALUES {
                let (what, most) = ("values", MOST_VALUES);
                return Err(AssetError::TooMany { file: path.to_owned(), what, most });
            }
            numbers.push((line, number(text, "the value", path, line)?));
        }
        Ok(Self { title, numbers })
    }

    fn holds_wavelengths(&self) -> bool {
        ["wavelength", "waves"].iter().any(|word| self.title.to_lowercase().contains(word))
    }

    /// Name of the spectrum: what follows the number of the record.
    fn name(&self) -> &str {
        self.title.split_once(": ").map_or(self.title.as_str(), |(_, name)| name.trim())
    }
}

/// Reads a spectrum from its values and the file of their wavelengths.
pub(super) fn read(
    path: &Path,
    columns: &SpectrumColumns<'_>,
) -> Result<SpectrumTable, AssetError> {
    let format = SpectrumFormat::Usgs;
    for (asked, key) in [(columns.wavelength, "wavelength"), (columns.value, "value")] {
        if let Some(name) = asked {
            return Err(SpectrumProblem::NoColumns { format, name: name.to_owned(), key }.of(path));
        }
    }
    let values = OneColumn::read(path)?;
    if values.holds_wavelengths() {
        return Err(SpectrumProblem::WavelengthsAlone.of(path));
    }
    let Some(other) = columns.wavelengths_file else {
        return Err(SpectrumProblem::NoWavelengths { example: likely_wavelengths(path) }.of(path));
    };
    let wavelengths = OneColumn::read(other)?;
    let (found, known) = (values.numbers.len(), wavelengths.numbers.len());
    if found != known {
        let other = other.to_owned();
        let problem = SpectrumProblem::UnlikeLengths { values: found, wavelengths: known, other };
        return Err(problem.of(path));
    }
    let name = other.file_name().map_or_else(String::new, |name| name.to_string_lossy().into());
    let named = wavelength_unit(&wavelengths.title).or_else(|| wavelength_unit(&name));
    let shown = || format!("{:?}", wavelengths.title);
    let unit = settled_unit(columns, named, format, other, shown)?;
    let mut points = PointList::new(path, unit, columns.unit.is_some());
    for (&(line, value), &(_, wavelength)) in values.numbers.iter().zip(&wavelengths.numbers) {
        points.push(wavelength, value, line)?;
    }
    Ok(SpectrumTable {
        format,
        points: points.finish()?,
        value: values.name().to_owned(),
        others: Vec::new(),
        unit: Some(ValueUnit::Fraction),
    })
}

/// Name of a file of wavelengths in the folder of a spectrum or in the one above it, else how the library names one.
fn likely_wavelengths(path: &Path) -> String {
    let folder = path.parent().unwrap_or(Path::new(""));
    let above = folder.join("..");
    let named =
        [(folder, ""), (above.as_path(), "../")].into_iter().find_map(|(folder, prefix)| {
            let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
            let entries = std::fs::read_dir(folder).ok()?;
            let mut names: Vec<String> = entries
                .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
                .filter(|name| name.starts_with("splib") && name.contains("Wavelengths"))
                .collect();
            names.sort();
            let known = path.file_name()?.to_string_lossy().into_owned();
            // The spectrometer stands in both names: BECK, ASD, NIC4, AVIRIS.
            let is_alike = |name: &&String| {
                let spectrometer = name.split('_').nth(2).unwrap_or_default();
                !spectrometer.is_empty() && known.contains(spectrometer)
            };
            let best = names.iter().find(is_alike).or(names.first())?;
            Some(format!("{prefix}{best}"))
        });
    let beside = |name: String| {
        let file = PathBuf::from(name);
        file.display().to_string()
    };
    named.map_or_else(|| "splib07a_Wavelengths_ASD_0.35-2.5_microns_2151_ch.txt".to_owned(), beside)
}
