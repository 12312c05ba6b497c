//! Text of the ECOSTRESS spectral library and of ASTER's before it: lines `Key: value`, then two columns.
//!
//! Source: the files' own keys, as the library's page at speclib.jpl.nasa.gov describes them: `X Units`, `Y Units`, `First
//! Column`, `Second Column`.

use std::path::Path;

use super::super::AssetError;
use super::super::text::{TextLines, number};
use super::points::PointList;
use super::units::{settled_unit, value_unit, wavelength_unit};
use super::{SpectrumColumns, SpectrumFormat, SpectrumProblem, SpectrumTable};

/// Lines above the columns, `Key: value`.
struct Keys(Vec<(String, String)>);

impl Keys {
    fn get(&self, key: &str) -> Option<&str> {
        let mut keys = self.0.iter();
        keys.find(|(name, _)| name.eq_ignore_ascii_case(key)).map(|(_, value)| value.as_str())
    }
}

/// Reads a spectrum; rows without a value hold a no-data mark.
pub(super) fn read(
    path: &Path,
    columns: &SpectrumColumns<'_>,
) -> Result<SpectrumTable, AssetError> {
    let mut lines = TextLines::open(path)?;
    let mut keys = Keys(Vec::new());
    while let Some((_, text)) = lines.next()? {
        let Some((key, value)) = text.split_once(':') else { break };
        keys.0.push((key.trim().to_owned(), value.trim().to_owned()));
    }
    lines.hold();
    let format = SpectrumFormat::Ecostress;
    let names = [("wavelength", "First Column", "X"), ("value", "Second Column", "Y")];
    let asked = [columns.wavelength, columns.value];
    for ((key, said, usual), asked) in names.into_iter().zip(asked) {
        if let Some(name) = asked.filter(|name| *name != keys.get(said).unwrap_or(usual)) {
            return Err(SpectrumProblem::NoColumns { format, name: name.to_owned(), key }.of(path));
        }
    }
    let [x, y] = ["X Units", "Y Units"].map(|key| keys.get(key).unwrap_or_default());
    let shown = || format!("`X Units: {x}`, `Y Units: {y}`");
    let unit = settled_unit(columns, wavelength_unit(x), format, path, shown)?;
    let mut points = PointList::new(path, unit, columns.unit.is_some());
    while let Some((line, text)) = lines.next()? {
        let mut fields = text.split([' ', '\t', ',']).filter(|field| !field.is_empty());
        let (Some(wavelength), Some(value), None) = (fields.next(), fields.next(), fields.next())
        else {
            let (found, file) = (text.split_whitespace().count(), path.to_owned());
            let advice = "";
            return Err(AssetError::WrongFieldCount { file, line, found, wanted: 2, advice });
        };
        let wavelength = number(wavelength, "the wavelength", path, line)?;
        points.push(wavelength, number(value, "the value", path, line)?, line)?;
    }
    Ok(SpectrumTable {
        format,
        points: points.finish()?,
        value: keys.get("Name").unwrap_or("Y").to_owned(),
        others: Vec::new(),
        unit: value_unit(y),
    })
}
