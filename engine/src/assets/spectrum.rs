//! Spectra from columns of a table.

use std::path::Path;

use super::AssetError;
use super::table::{Column, Table, missing};

/// Points (wavelength, value) of a spectrum in order of wavelength, in the table's units.
///
/// `wavelength` and `value` are the headers of their columns; without `value` it is the second
/// column. Other columns may hold anything, and titles may stand before the header. Rows may fall in wavelength instead of rising.
///
/// # Errors
/// A file that cannot be read, is not text, has no header or not these columns; a number that is
/// not finite; wavelengths out of order, repeated or not above 0; fewer than two rows.
pub fn read_spectrum(
    path: &Path,
    wavelength: &str,
    value: Option<&str>,
) -> Result<Vec<(f64, f64)>, AssetError> {
    let mut table = Table::open(path)?;
    let columns = columns(&mut table, wavelength, value)?;
    let mut points: Vec<(f64, f64)> = Vec::new();
    let mut row = [0.0; 2];
    let mut rising = true;
    while let Some(line) = table.read_row(&columns, &mut row)? {
        let [wavelength, value] = row;
        let file = || path.to_owned();
        if wavelength <= 0.0 {
            let what = "the wavelength".to_owned();
            return Err(AssetError::NotPositive { file: file(), line, what, value: wavelength });
        }
        if let Some(&(previous, _)) = points.last() {
            if points.len() == 1 {
                rising = wavelength > previous;
            }
            let in_order = if rising { wavelength > previous } else { wavelength < previous };
            if !in_order {
                return Err(AssetError::WavelengthOrder {
                    file: file(),
                    line,
                    previous,
                    wavelength,
                });
            }
        }
        points.push((wavelength, value));
    }
    match points.len() {
        0 => return Err(AssetError::NoRows { file: path.to_owned() }),
        1 => return Err(AssetError::ShortSpectrum { file: path.to_owned() }),
        _ => {}
    }
    if !rising {
        points.reverse();
    }
    Ok(points)
}

fn columns(
    table: &mut Table,
    wavelength: &str,
    value: Option<&str>,
) -> Result<Vec<Column>, AssetError> {
    if table.has_header() {
        table.seek_header(wavelength)?;
    }
    let (file, line) = (table.file().to_owned(), table.first_line);
    if !table.has_header() {
        let wanted = format!("`{wavelength},{}`", value.unwrap_or("value"));
        return Err(AssetError::NoHeader { file, line, wanted });
    }
    let names = &table.first;
    let find = |name: &str| {
        let mut places = names.iter().enumerate().filter(|(_, n)| *n == name);
        let place = places.next().ok_or_else(|| missing(name, names, &file, line))?.0;
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
    let abscissa = find(wavelength)?;
    let ordinate = match value {
        Some(name) => find(name)?,
        None if names.len() > 1 => 1,
        None => return Err(missing("value", names, &file, line)),
    };
    if abscissa == ordinate {
        let name = names[ordinate].clone();
        return Err(AssetError::RepeatedColumn { file, line, first: name.clone(), second: name });
    }
    let slot = |place| match place {
        _ if place == abscissa => Some(0),
        _ if place == ordinate => Some(1),
        _ => None,
    };
    let columns = names.iter().enumerate();
    let columns = columns.map(|(place, name)| Column { name: name.clone(), slot: slot(place) });
    let columns = columns.collect();
    table.skip_header()?;
    Ok(columns)
}
