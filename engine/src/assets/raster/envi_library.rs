//! Arrays of spectra beside an ENVI header.

use std::path::{Path, PathBuf};

use super::envi::{EnviHeader, header_of, values_of};
use super::raw::SampleLayout;
use super::window::CellWindow;
use super::{RasterError, cells};

/// A spectral library: spectra are the rows of its array, channels the columns.
pub(in crate::assets) struct EnviLibrary {
    header: EnviHeader,
    layout: SampleLayout,
    file: PathBuf,
}

/// Returns whether a file, or the header beside it, says that it is a spectral library; `head` is its beginning.
pub(in crate::assets) fn is_spectral_library(path: &Path, head: &[u8]) -> bool {
    let header = header_of(path, head).and_then(|header| EnviHeader::read(&header).ok());
    let kind = header.as_ref().and_then(|header| header.get("file type"));
    kind.is_some_and(|kind| kind.to_lowercase().contains("spectral library"))
}

impl EnviLibrary {
    /// Opens a library by the name of its values or of its header.
    pub(in crate::assets) fn open(path: &Path) -> Result<Self, RasterError> {
        let is_header = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("hdr"));
        let no_header = || {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            RasterError::NoHeader(format!("{name}.hdr, {stem}.hdr"))
        };
        let (header, file) = if is_header {
            (path.to_owned(), values_of(path)?)
        } else {
            (header_of(path, b"").ok_or_else(no_header)?, path.to_owned())
        };
        let header = EnviHeader::read(&header)?;
        let layout = header.layout()?;
        cells(layout.columns, layout.rows)?;
        layout.open(&file)?;
        Ok(Self { header, layout, file })
    }

    /// Name of the header.
    pub(in crate::assets) fn header_name(&self) -> &str {
        self.header.name()
    }

    /// Entry of the header.
    pub(in crate::assets) fn get(&self, key: &str) -> Option<&str> {
        self.header.get(key)
    }

    /// Number of spectra.
    pub(in crate::assets) fn spectra(&self) -> usize {
        self.layout.rows as usize
    }

    /// Number of channels.
    pub(in crate::assets) fn channels(&self) -> usize {
        self.layout.columns as usize
    }

    /// Values of a spectrum, shape `[channels]`.
    pub(in crate::assets) fn spectrum(&self, row: usize) -> Result<Vec<f64>, RasterError> {
        let window = CellWindow { columns: 0..self.channels(), rows: row..row + 1 };
        self.layout.read(&self.file, &window, 0)
    }
}
