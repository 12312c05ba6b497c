//! A file that is being written for a folder of results.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::PathBuf;

use super::OutputError;

/// File that is being written for a folder.
#[derive(Debug)]
pub(super) struct StagedFile {
    pub(super) writer: BufWriter<File>,
    /// Path that it will have.
    pub(super) shown: PathBuf,
}

impl StagedFile {
    /// Writes to it.
    pub(super) fn write(
        &mut self,
        fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        let path = &self.shown;
        fill(&mut self.writer).map_err(|source| OutputError::Write { path: path.clone(), source })
    }

    /// Ends it; returns its size in bytes.
    pub(super) fn finish(mut self) -> Result<u64, OutputError> {
        let mut finish = || {
            self.writer.flush()?;
            // Some file systems report a full disk only here.
            self.writer.get_ref().sync_all()?;
            Ok(self.writer.get_ref().metadata()?.len())
        };
        finish().map_err(|source: io::Error| OutputError::Write { path: self.shown, source })
    }

    /// File to read what it holds so far; both share a place in the file, so that nothing is written to it after that.
    pub(super) fn reader(&mut self) -> Result<File, OutputError> {
        let file = self.writer.flush().and_then(|()| self.writer.get_ref().try_clone());
        file.map_err(|source| OutputError::Read { path: self.shown.clone(), source })
    }
}
