//! Units that headers and titles name.

use std::path::Path;

use super::super::AssetError;
use super::{SpectrumColumns, SpectrumFormat, SpectrumProblem};
use crate::document::{ValueUnit, WavelengthUnit};

/// The unit of wavelengths that a header or a title names.
pub(super) fn wavelength_unit(name: &str) -> Option<WavelengthUnit> {
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

/// The unit of values that a header or a title names.
pub(super) fn value_unit(text: &str) -> Option<ValueUnit> {
    let lower = text.to_lowercase();
    let has_any = |words: &[&str]| words.iter().any(|word| lower.contains(word));
    if has_any(&["%", "percent", "per cent", "pct"]) {
        Some(ValueUnit::Percent)
    } else {
        lower.contains("fraction").then_some(ValueUnit::Fraction)
    }
}

/// Returns whether the name of a column says that it holds wavelengths.
pub(super) fn names_wavelengths(name: &str) -> bool {
    let lower = name.to_lowercase();
    let has_word = ["wav", "wl", "wvl", "lambda"].iter().any(|word| lower.contains(word));
    has_word || wavelength_unit(name).is_some()
}

/// Unit of the wavelengths of a file: that which the scene gives, else that which the file names.
///
/// # Errors
/// If neither does; `shown` is how the file begins.
pub(super) fn settled_unit(
    columns: &SpectrumColumns<'_>,
    named: Option<WavelengthUnit>,
    format: SpectrumFormat,
    file: &Path,
    shown: impl FnOnce() -> String,
) -> Result<WavelengthUnit, AssetError> {
    columns
        .unit
        .or(named)
        .ok_or_else(|| SpectrumProblem::NoWavelengthUnit { format, shown: shown() }.of(file))
}

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
            assert_eq!(wavelength_unit(name), unit, "{name}");
        }
        for (text, unit) in [
            ("Y Units: Reflectance (percentage)", Some(ValueUnit::Percent)),
            ("R [%]", Some(ValueUnit::Percent)),
            ("reflectance, fraction", Some(ValueUnit::Fraction)),
            ("reflectance", None),
        ] {
            assert_eq!(value_unit(text), unit, "{text}");
        }
    }
}
