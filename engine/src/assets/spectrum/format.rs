//! Formats of spectra and how they are told.

use std::fmt;
use std::io::Read as _;
use std::path::Path;

use super::super::text;
use super::super::{AssetError, raster};
use super::asd;

/// Number of bytes at the start of a file that tell its format.
const HEAD: u64 = 4096;

/// Format of a file of spectra.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpectrumFormat {
    /// Columns of text under a header: CSV, text of ASD's `ViewSpec` Pro, exports of SPECCHIO.
    Table,
    /// Text of the ECOSTRESS and ASTER libraries: lines of `Key: value` above two columns.
    Ecostress,
    /// Text of the USGS library version 7: a title above one column.
    Usgs,
    /// ENVI spectral library: binary values beside a header.
    EnviLibrary,
    /// Binary file of an ASD spectrometer.
    Asd,
}

impl SpectrumFormat {
    /// Format of a file by its first bytes and the header beside it.
    pub(super) fn of_file(path: &Path) -> Result<Self, AssetError> {
        let mut head = Vec::new();
        let unreadable = |cause| AssetError::Unreadable { file: path.to_owned(), cause };
        text::open(path)?.take(HEAD).read_to_end(&mut head).map_err(unreadable)?;
        if asd::is_asd(&head) {
            return Ok(Self::Asd);
        }
        let is_named_library =
            path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("sli"));
        let is_binary =
            head.contains(&0) || str::from_utf8(&head).is_err_and(|e| e.error_len().is_some());
        if (is_named_library && is_binary) || raster::is_spectral_library(path, &head) {
            return Ok(Self::EnviLibrary);
        }
        let head = String::from_utf8_lossy(&head);
        Ok(Self::of_text(head.trim_start_matches('\u{feff}')))
    }

    fn of_text(head: &str) -> Self {
        let mut lines = head.lines().map(str::trim).filter(|line| !line.is_empty());
        let first = lines.clone().next().unwrap_or_default().to_lowercase();
        if first.starts_with("splib") && first.contains("record=") {
            return Self::Usgs;
        }
        let names_x = lines.clone().any(|line| line.to_lowercase().starts_with("x units:"));
        // A header of columns below the lines of keys makes it a table.
        let is_row = |line: &str| line.split_ascii_whitespace().all(|f| f.parse::<f64>().is_ok());
        let before = lines.by_ref().take_while(|line| !is_row(line)).last().unwrap_or_default();
        if names_x && before.contains(':') { Self::Ecostress } else { Self::Table }
    }

    /// Returns whether places in the file are lines.
    #[must_use]
    pub const fn has_lines(self) -> bool {
        matches!(self, Self::Table | Self::Ecostress | Self::Usgs)
    }
}

impl fmt::Display for SpectrumFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Table => "a text table",
            Self::Ecostress => "a spectrum of the ECOSTRESS library",
            Self::Usgs => "a spectrum of the USGS library",
            Self::EnviLibrary => "an ENVI spectral library",
            Self::Asd => "a file of an ASD spectrometer",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_told_by_their_first_lines() {
        let keys =
            "Name: leaf\nX Units: Wavelength (micrometers)\nAdditional Information: none\n\n";
        for (text, format) in [
            ("wavelength_nm,value\n400,0.1\n".to_owned(), SpectrumFormat::Table),
            (format!("{keys} 0.4\t5.2\n"), SpectrumFormat::Ecostress),
            (format!("{keys}wavelength_um\treflectance\n 0.4\t5.2\n"), SpectrumFormat::Table),
            (" splib07a Record=1: Leaf ASDFRa AREF\n 0.1\n".to_owned(), SpectrumFormat::Usgs),
            ("Name: leaf\n400 0.1\n".to_owned(), SpectrumFormat::Table),
        ] {
            assert_eq!(SpectrumFormat::of_text(&text), format, "{text}");
        }
    }
}
