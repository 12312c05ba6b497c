//! Names and units after the CF conventions.

use super::super::names::Distinct;
use super::Attributes;

/// Names of quantities in the CF standard name table (version 85), by the name of the product or the coordinate.
const STANDARD_NAMES: [(&str, &str); 10] = [
    ("albedo", "surface_albedo"),
    ("azimuth", "sensor_azimuth_angle"),
    ("brf", "surface_bidirectional_reflectance"),
    ("brightness_temperature", "brightness_temperature"),
    ("lai", "leaf_area_index"),
    ("lai_2000", "leaf_area_index"),
    ("wavelength", "radiation_wavelength"),
    ("x", "projection_x_coordinate"),
    ("y", "projection_y_coordinate"),
    ("zenith", "sensor_zenith_angle"),
];

/// Endings of names of axes, and their units as UDUNITS spells them.
const UNITS: [(&str, &str); 7] = [
    ("_deg", "degree"),
    ("_h", "h"),
    ("_k", "K"),
    ("_m", "m"),
    ("_nm", "nm"),
    ("_s", "s"),
    ("_sr", "sr"),
];

/// Standard name of a quantity, empty if there is none.
pub(super) fn standard_name(name: &str) -> &'static str {
    STANDARD_NAMES.iter().find(|(known, _)| *known == name).map_or("", |(_, standard)| *standard)
}

/// Adds the names and the unit of a quantity.
pub(super) fn describe(attributes: &mut Attributes, name: &str, long_name: &str, unit: &str) {
    attributes.text("standard_name", standard_name(name));
    attributes.text("long_name", long_name);
    attributes.text("units", unit);
}

/// A name without `_`.
pub(super) fn in_words(name: &str) -> String {
    name.replace('_', " ")
}

/// Name of an axis without its unit, and the unit, `1` if it has none.
pub(super) fn name_and_unit(axis: &str) -> (&str, &'static str) {
    let unit = UNITS.iter().find_map(|(ending, unit)| Some((axis.strip_suffix(ending)?, *unit)));
    unit.filter(|(name, _)| !name.is_empty()).unwrap_or((axis, "1"))
}

/// Names of variables and dimensions, each of which is given once.
#[derive(Debug, Default)]
pub(super) struct VariableNames(Distinct);

impl VariableNames {
    /// Returns true if no variable has this name.
    pub(super) fn is_free(&self, name: &str) -> bool {
        self.0.is_free(name)
    }

    /// A name of letters, digits and underscores that begins with a letter.
    pub(super) fn take(&mut self, name: &str) -> String {
        let safe = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
        let mut safe: String = name.chars().map(safe).take(LONGEST).collect();
        if !safe.starts_with(|letter: char| letter.is_ascii_alphabetic()) {
            safe.insert(0, 'v');
        }
        self.0.take(&safe)
    }
}

/// Longest name, letters: netCDF has room for 256.
const LONGEST: usize = 120;
