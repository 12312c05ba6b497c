//! Spectra from columns of a text table: CSV, text that ASD's `ViewSpec` Pro exports, exports of SPECCHIO.

use std::path::Path;

use super::super::AssetError;
use super::super::table::{Column, ColumnContent, Table, missing, nearest};
use super::points::PointList;
use super::units::{names_wavelengths, settled_unit, value_unit, wavelength_unit};
use super::{SpectrumColumns, SpectrumFormat, SpectrumPoint, SpectrumTable};
use crate::document::WavelengthUnit;

/// Header of the column of wavelengths that is taken where a table has it.
const USUAL: &str = "wavelength_nm";

/// Reads the rows of two columns.
pub(super) fn read(
    path: &Path,
    columns: &SpectrumColumns<'_>,
) -> Result<SpectrumTable, AssetError> {
    let format = SpectrumFormat::Table;
    let mut table = Table::open(path)?;
    let wavelength = columns.wavelength.unwrap_or(USUAL);
    let wanted: Vec<&str> = std::iter::once(wavelength).chain(columns.value).collect();
    let titles = table.seek_header(&wanted)?;
    let found = find_columns(&table, columns)?;
    let hints = || titles.iter().filter(|title| title.to_lowercase().contains("units"));
    let named = wavelength_unit(&found.wavelength)
        .or_else(|| hints().find_map(|title| wavelength_unit(title)))
        .or_else(|| is_of_view_spec(&table.first).then_some(WavelengthUnit::Nanometres));
    let shown = || format!("`{}`", table.first.join(","));
    let unit = settled_unit(columns, named, format, path, shown)?;
    let of_values = std::iter::once(&found.value).chain(hints()).find_map(|text| value_unit(text));
    let mut others = columns_of_values(&table.first, &found.wavelength);
    others.retain(|name| columns.value.is_none() && *name != found.value);
    let mut points = PointList::new(path, unit, columns.unit.is_some());
    let mut row = [0.0; 2];
    while let Some(line) = table.read_row(&found.columns, &mut row)? {
        points.push(row[0], row[1], line)?;
    }
    let points: Vec<SpectrumPoint> = points.finish()?;
    Ok(SpectrumTable { format, points, value: found.value, others, unit: of_values })
}

/// Returns whether these are the columns that ASD's `ViewSpec` Pro exports, whose wavelengths are in nm: `Wavelength` and
/// names of its files.
fn is_of_view_spec(names: &[String]) -> bool {
    let is_file = |name: &String| {
        let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_lowercase();
        let is_number = ending.len() == 3 && ending.bytes().all(|byte| byte.is_ascii_digit());
        is_number || ["asd", "mn", "md", "ref", "rts", "rad"].contains(&ending.as_str())
    };
    names.len() > 1 && names[0] == "Wavelength" && names[1..].iter().all(is_file)
}

/// Name of the column of wavelengths: that which the scene gives, `wavelength_nm`, or the first that says so.
fn wavelength_column(names: &[String], columns: &SpectrumColumns<'_>) -> String {
    let usual = || names.iter().find(|name| *name == USUAL);
    let likely = || names.iter().find(|name| names_wavelengths(name));
    let found = || usual().or_else(likely).map_or(USUAL, String::as_str);
    columns.wavelength.unwrap_or_else(found).to_owned()
}

/// Columns of a table, and the names of the two that are read.
struct FoundColumns {
    columns: Vec<Column>,
    wavelength: String,
    value: String,
}

/// Returns the content of each column, and the headers of the two that are read.
fn find_columns(table: &Table, columns: &SpectrumColumns<'_>) -> Result<FoundColumns, AssetError> {
    let (file, line) = (table.file().to_owned(), table.first_line);
    let is_header_missing = match table.below_titles {
        Some((_, fields)) => fields != table.first.len(),
        None => !table.has_header(),
    };
    if is_header_missing {
        let line = table.below_titles.map_or(line, |(line, _)| line);
        let wavelength = columns.wavelength.unwrap_or(USUAL);
        let wanted = format!("`{wavelength},{}`", columns.value.unwrap_or("value"));
        return Err(AssetError::NoHeader { file, line, wanted });
    }
    let names = &table.first;
    let abscissa_name = wavelength_column(names, columns);
    let find = |name: &str, key: &'static str| {
        let mut places = names.iter().enumerate().filter(|(_, n)| *n == name);
        let unknown = || {
            let nearest = nearest_column(names, &abscissa_name, name, key);
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
    let abscissa = find(&abscissa_name, "wavelength")?;
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
    let value = names[ordinate].clone();
    let columns = names.iter().enumerate().map(column).collect();
    Ok(FoundColumns { columns, wavelength: abscissa_name, value })
}

/// Column that was most likely meant by a name that no column has.
fn nearest_column(names: &[String], wavelength: &str, name: &str, key: &str) -> String {
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    let abscissa = known.iter().find(|name| names_wavelengths(name));
    let abscissa = abscissa.filter(|_| key == "wavelength");
    // The column of wavelengths is no column of values.
    let others: Vec<&str> = match key {
        "value" => known.iter().copied().filter(|n| *n != wavelength).collect(),
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
