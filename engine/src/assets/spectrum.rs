//! Spectra from columns of a table.

use std::path::Path;

use super::AssetError;
use super::table::{Column, ColumnContent, Table, missing, nearest};
use crate::document::WavelengthUnit;

/// Columns of a spectrum, and what their header and the titles above it say of their units.
#[derive(Clone, Copy, Debug)]
pub struct SpectrumColumns<'a> {
    /// Header of the column of wavelengths.
    pub wavelength: &'a str,
    /// Header of the column of values; the second column if absent.
    pub value: Option<&'a str>,
    /// Unit of the wavelengths; nanometres if absent, unless the file says otherwise.
    pub unit: Option<WavelengthUnit>,
}

/// One row of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectrumPoint {
    /// Wavelength, nm.
    pub wavelength: f64,
    /// Value in the file's unit; NaN where the file says that there is none.
    pub value: f64,
    /// Line of the file.
    pub line: usize,
}

/// A spectrum as a file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumTable {
    /// Points in order of wavelength; two or more.
    pub points: Vec<SpectrumPoint>,
    /// Header of the column of values.
    pub value: String,
    /// Headers of the columns that may hold values too, if none was asked for by name.
    pub others: Vec<String>,
    /// Text of the header or of a title that says that the values are percent.
    pub percent: Option<String>,
}

/// The rows of a spectrum in order of wavelength.
///
/// Other columns may hold anything, and titles may stand before the header. Rows may fall in
/// wavelength instead of rising.
///
/// # Errors
/// A file that cannot be read, is not text, has no header or not these columns; wavelengths that are
/// out of order, repeated or not above 0, or whose unit cannot be the one that is taken; fewer than
/// two rows.
pub fn read_spectrum(
    path: &Path,
    columns: &SpectrumColumns<'_>,
) -> Result<SpectrumTable, AssetError> {
    let mut table = Table::open(path)?;
    let wanted: Vec<&str> = std::iter::once(columns.wavelength).chain(columns.value).collect();
    let titles = table.seek_header(&wanted)?;
    let (fields, value) = find_columns(&table, columns)?;
    let hints = || titles.iter().filter(|title| title.to_lowercase().contains("units"));
    let named_unit = || {
        let own = unit_of_name(columns.wavelength).map(|unit| (unit, columns.wavelength));
        own.or_else(|| hints().find_map(|title| Some((unit_of_name(title)?, title.as_str()))))
    };
    let unit = match (columns.unit, named_unit()) {
        (Some(unit), _) => unit,
        (None, Some((unit, said))) if unit != WavelengthUnit::Nanometres => {
            let (file, line, said) = (path.to_owned(), table.first_line, said.to_owned());
            return Err(AssetError::WavelengthUnit { file, line, said, unit: unit.name() });
        }
        (None, _) => WavelengthUnit::Nanometres,
    };
    let percent = std::iter::once(&value)
        .chain(hints())
        .find(|text| says_percent(text))
        .map(|text| text.trim().to_owned());
    let mut others = columns_of_values(&table.first, columns.wavelength);
    others.retain(|name| columns.value.is_none() && *name != value);
    let points = read_points(&mut table, &fields, unit, columns.unit.is_some())?;
    Ok(SpectrumTable { points, value, others, percent })
}

fn read_points(
    table: &mut Table,
    columns: &[Column],
    unit: WavelengthUnit,
    is_unit_given: bool,
) -> Result<Vec<SpectrumPoint>, AssetError> {
    let path = table.file().to_owned();
    let file = || path.clone();
    let mut points: Vec<SpectrumPoint> = Vec::new();
    let mut row = [0.0; 2];
    let mut rising = true;
    let mut before = f64::NAN;
    while let Some(line) = table.read_row(columns, &mut row)? {
        let [written, value] = row;
        if written <= 0.0 {
            let what = "the wavelength".to_owned();
            return Err(AssetError::NotPositive { file: file(), line, what, value: written });
        }
        let wavelength = unit.nanometres(written);
        if let Some(&SpectrumPoint { wavelength: previous, .. }) = points.last() {
            if points.len() == 1 {
                rising = wavelength > previous;
            }
            let in_order = if rising { wavelength > previous } else { wavelength < previous };
            if !in_order {
                let (previous, wavelength) = (before, written);
                let file = file();
                return Err(AssetError::WavelengthOrder { file, line, previous, wavelength });
            }
        }
        if !(SHORTEST_NM..=LONGEST_NM).contains(&wavelength) {
            let (file, unit) = (file(), unit.name());
            return Err(AssetError::NoLight { file, line, written, unit, is_unit_given });
        }
        before = written;
        points.push(SpectrumPoint { wavelength, value, line });
    }
    match points.len() {
        0 => return Err(AssetError::NoRows { file: file() }),
        1 => return Err(AssetError::ShortSpectrum { file: file() }),
        _ => {}
    }
    if !rising {
        points.reverse();
    }
    Ok(points)
}

/// Wavelengths of spectra, nm: from the far ultraviolet to microwaves of 1 mm.
const SHORTEST_NM: f64 = 100.0;
const LONGEST_NM: f64 = 1e6;

/// The unit that a header or a title names.
fn unit_of_name(name: &str) -> Option<WavelengthUnit> {
    let lower = name.to_lowercase();
    let has_word =
        |word: &str| lower.split(|c: char| !c.is_alphanumeric()).any(|part| part == word);
    let has_any = |parts: &[&str]| parts.iter().any(|part| lower.contains(part));
    if has_any(&["wavenumber", "wave number", "cm-1", "cm^-1", "cm⁻¹", "1/cm"]) {
        Some(WavelengthUnit::Wavenumbers)
    } else if has_any(&["micromet", "micron", "µm", "μm"]) || has_word("um") {
        Some(WavelengthUnit::Micrometres)
    } else if lower.contains("angstrom") || name.contains(['Å', 'Å']) {
        Some(WavelengthUnit::Angstroms)
    } else {
        (lower.contains("nanomet") || has_word("nm")).then_some(WavelengthUnit::Nanometres)
    }
}

fn says_percent(text: &str) -> bool {
    let lower = text.to_lowercase();
    ["%", "percent", "per cent", "pct"].iter().any(|word| lower.contains(word))
}

/// Returns the content of each column, and the header of the values.
fn find_columns(
    table: &Table,
    columns: &SpectrumColumns<'_>,
) -> Result<(Vec<Column>, String), AssetError> {
    let (file, line) = (table.file().to_owned(), table.first_line);
    let is_header_missing = match table.below_titles {
        Some((_, fields)) => fields != table.first.len(),
        None => !table.has_header(),
    };
    if is_header_missing {
        let line = table.below_titles.map_or(line, |(line, _)| line);
        let wanted = format!("`{},{}`", columns.wavelength, columns.value.unwrap_or("value"));
        return Err(AssetError::NoHeader { file, line, wanted });
    }
    let names = &table.first;
    let find = |name: &str, key: &'static str| {
        let mut places = names.iter().enumerate().filter(|(_, n)| *n == name);
        let unknown = || {
            let nearest = nearest_column(names, columns, name, key);
            let (file, column) = (file.clone(), name.to_owned());
            AssetError::NoSuchColumn { file, line, column, found: names.clone(), key, nearest }
        };
        let place = places.next().ok_or_else(unknown)?.0;
        match places.next() {
            None => Ok(place),
            Some(_) => Err(AssetError::RepeatedColumn {
                file: file.clone(),
                line,
                first: name.to_owned(),
                second: name.to_owned(),
            }),
        }
    };
    let abscissa = find(columns.wavelength, "wavelength")?;
    let ordinate = match columns.value {
        Some(name) => find(name, "value")?,
        None if names.len() > 1 => 1,
        None => return Err(missing("value", names, &file, line)),
    };
    if abscissa == ordinate {
        let name = names[ordinate].clone();
        return Err(AssetError::RepeatedColumn { file, line, first: name.clone(), second: name });
    }
    let content = |place| match place {
        _ if place == abscissa => ColumnContent::Number(0),
        _ if place == ordinate => ColumnContent::NumberOrMissing(1),
        _ => ColumnContent::Ignored,
    };
    let column =
        |(place, name): (usize, &String)| Column { name: name.clone(), content: content(place) };
    Ok((names.iter().enumerate().map(column).collect(), names[ordinate].clone()))
}

/// Column that was most likely meant by a name that no column has.
fn nearest_column(
    names: &[String],
    columns: &SpectrumColumns<'_>,
    name: &str,
    key: &str,
) -> String {
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    let is_abscissa = |name: &&&str| {
        let lower = name.to_lowercase();
        let has_word = ["wav", "wl", "wvl", "lambda"].iter().any(|word| lower.contains(word));
        has_word || unit_of_name(name).is_some()
    };
    let abscissa = known.iter().find(is_abscissa).filter(|_| key == "wavelength");
    // The column of wavelengths is no column of values.
    let others: Vec<&str> = match key {
        "value" => known.iter().copied().filter(|n| *n != columns.wavelength).collect(),
        _ => known.clone(),
    };
    abscissa.map_or_else(|| nearest(name, &others), |&abscissa| abscissa.to_owned())
}

/// Names of the columns that may hold values, in the order of the file.
fn columns_of_values(names: &[String], wavelength: &str) -> Vec<String> {
    let is_value = |name: &&String| {
        let lower = name.to_lowercase();
        let mut words = lower.split(|c: char| !c.is_alphanumeric());
        *name != wavelength && !words.any(|word| BESIDE.contains(&word)) && !lower.trim().is_empty()
    };
    names.iter().filter(is_value).cloned().collect()
}

/// Words in the names of columns that stand beside values: spreads, numbers and notes.
const BESIDE: [&str; 22] = [
    "sd",
    "std",
    "stdev",
    "stddev",
    "se",
    "sem",
    "stderr",
    "err",
    "error",
    "errors",
    "unc",
    "uncertainty",
    "var",
    "variance",
    "n",
    "count",
    "samples",
    "note",
    "notes",
    "flag",
    "quality",
    "comment",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_by_their_names() {
        for (name, unit) in [
            ("wavelength_nm", Some(WavelengthUnit::Nanometres)),
            ("Wvlgth nm", Some(WavelengthUnit::Nanometres)),
            ("Wavelength", None),
            ("number", None),
            ("wavenumber", Some(WavelengthUnit::Wavenumbers)),
            ("wavelength (um)", Some(WavelengthUnit::Micrometres)),
            ("X Units: Wavelength (micrometers)", Some(WavelengthUnit::Micrometres)),
            ("lambda [Å]", Some(WavelengthUnit::Angstroms)),
        ] {
            assert_eq!(unit_of_name(name), unit, "{name}");
        }
    }
}
