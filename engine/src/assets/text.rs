//! Text files line by line, each line with its number.

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use super::AssetError;
use super::error::excerpt;
use crate::files;

/// Longest line, bytes: what a file without line ends may cost in memory.
const LONGEST_LINE: usize = 1 << 20;

/// The lines of a text file that are neither blank nor comments (`#`).
pub(super) struct Lines {
    reader: BufReader<File>,
    file: PathBuf,
    bytes: Vec<u8>,
    number: usize,
    held: bool,
}

/// A regular file, open for reading.
pub(super) fn open(path: &Path) -> Result<File, AssetError> {
    let unreadable = |cause| AssetError::Unreadable { file: path.to_owned(), cause };
    // Asked before it is opened: opening a pipe would wait for its writer.
    if !fs::metadata(path).map_err(unreadable)?.is_file() {
        return Err(AssetError::NotAFile { file: path.to_owned() });
    }
    files::open(path).map_err(unreadable)
}

/// Bytes of a file.
pub(super) fn size(path: &Path) -> Result<u64, AssetError> {
    let unreadable = |cause| AssetError::Unreadable { file: path.to_owned(), cause };
    Ok(fs::metadata(path).map_err(unreadable)?.len())
}

/// The whole content of a regular file.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, AssetError> {
    let mut bytes = Vec::new();
    open(path)?
        .read_to_end(&mut bytes)
        .map_err(|cause| AssetError::Unreadable { file: path.to_owned(), cause })?;
    Ok(bytes)
}

/// A finite number.
pub(super) fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

/// The finite number that a text says, or the error that it says none.
pub(super) fn number(text: &str, what: &str, file: &Path, line: usize) -> Result<f64, AssetError> {
    finite(text).ok_or_else(|| AssetError::BadNumber {
        file: file.to_owned(),
        line,
        what: what.to_owned(),
        found: excerpt(text),
    })
}

impl Lines {
    pub(super) fn open(path: &Path) -> Result<Self, AssetError> {
        Ok(Self {
            reader: BufReader::with_capacity(1 << 16, open(path)?),
            file: path.to_owned(),
            bytes: Vec::new(),
            number: 0,
            held: false,
        })
    }

    pub(super) fn file(&self) -> &Path {
        &self.file
    }

    /// Makes the line that was read last the next one again.
    pub(super) fn hold(&mut self) {
        self.held = true;
    }

    /// The next line without the white space around it, and its number from 1.
    pub(super) fn next(&mut self) -> Result<Option<(usize, &str)>, AssetError> {
        while !self.held {
            if !self.fill()? {
                return Ok(None);
            }
            let first = self.bytes.iter().find(|byte| !byte.is_ascii_whitespace());
            // Comments may be in any encoding: nothing is made of them.
            self.held = !matches!(first, None | Some(b'#'));
        }
        self.held = false;
        let number = self.number;
        self.text().map(|text| Some((number, text)))
    }

    /// The line right after the last one, be it blank or a comment; empty at the end of the file.
    pub(super) fn continuation(&mut self) -> Result<&str, AssetError> {
        if !self.fill()? {
            self.bytes.clear();
        }
        self.text()
    }

    fn fill(&mut self) -> Result<bool, AssetError> {
        self.bytes.clear();
        let mut limited = self.reader.by_ref().take(LONGEST_LINE as u64 + 1);
        let count = limited
            .read_until(b'\n', &mut self.bytes)
            .map_err(|cause| AssetError::Unreadable { file: self.file.clone(), cause })?;
        self.number += usize::from(count > 0);
        // The mark that some editors write before UTF-8 text.
        if self.number == 1 && self.bytes.starts_with(b"\xef\xbb\xbf") {
            self.bytes.drain(..3);
        }
        if count > LONGEST_LINE {
            let most = LONGEST_LINE;
            return Err(AssetError::LineTooLong {
                file: self.file.clone(),
                line: self.number,
                most,
            });
        }
        Ok(count > 0)
    }

    fn text(&self) -> Result<&str, AssetError> {
        let not_text = || AssetError::NotText { file: self.file.clone(), line: self.number };
        // A zero byte is lawful UTF-8, but what it tells is UTF-16 or a binary file.
        if self.bytes.contains(&0) {
            return Err(not_text());
        }
        let text = std::str::from_utf8(&self.bytes).map_err(|_invalid| not_text())?;
        Ok(text.trim())
    }
}
