//! Text files line by line, each line with its number.

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read as _};
use std::path::{Path, PathBuf};

use super::AssetError;
use super::error::excerpt;
use crate::files;

/// Longest line, bytes: what a file without line ends may cost in memory.
const LONGEST_LINE: usize = 1 << 20;

/// Reader of the lines of a text file that are neither blank nor comments (`#`).
pub(super) struct TextLines {
    reader: BufReader<File>,
    file: PathBuf,
    bytes: Vec<u8>,
    number: usize,
    held: bool,
    /// True if the last line ended in `\r`, which a `\n` may follow.
    is_after_return: bool,
}

/// Opens a regular file.
pub(super) fn open(path: &Path) -> Result<File, AssetError> {
    let unreadable = |cause| AssetError::Unreadable { file: path.to_owned(), cause };
    // Asked before it is opened: opening a pipe would wait for its writer.
    if !fs::metadata(path).map_err(unreadable)?.is_file() {
        return Err(AssetError::NotAFile { file: path.to_owned() });
    }
    files::open(path).map_err(unreadable)
}

/// Size of a file, bytes.
pub(super) fn size(path: &Path) -> Result<u64, AssetError> {
    let unreadable = |cause| AssetError::Unreadable { file: path.to_owned(), cause };
    Ok(fs::metadata(path).map_err(unreadable)?.len())
}

/// Reads a whole regular file.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, AssetError> {
    let mut bytes = Vec::new();
    open(path)?
        .read_to_end(&mut bytes)
        .map_err(|cause| AssetError::Unreadable { file: path.to_owned(), cause })?;
    Ok(bytes)
}

/// Returns the finite number that a text is.
pub(super) fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

/// Returns the finite number that a text is, or an error that names the quantity `what`.
pub(super) fn number(text: &str, what: &str, file: &Path, line: usize) -> Result<f64, AssetError> {
    finite(text).ok_or_else(|| AssetError::BadNumber {
        file: file.to_owned(),
        line,
        what: what.to_owned(),
        found: excerpt(text),
    })
}

impl TextLines {
    pub(super) fn open(path: &Path) -> Result<Self, AssetError> {
        Ok(Self {
            reader: BufReader::with_capacity(1 << 16, open(path)?),
            file: path.to_owned(),
            bytes: Vec::new(),
            number: 0,
            held: false,
            is_after_return: false,
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
        if !self.advance()? {
            return Ok(None);
        }
        let number = self.number;
        decode(self.bytes.trim_ascii(), &self.file, number).map(|text| Some((number, text.trim())))
    }

    /// The next line as [`TextLines::next`] returns it, in whatever encoding it is.
    pub(super) fn next_bytes(&mut self) -> Result<Option<(usize, &[u8])>, AssetError> {
        Ok(if self.advance()? { Some((self.number, self.bytes.trim_ascii())) } else { None })
    }

    /// The line right after the last one, be it blank or a comment; empty at the end of the file.
    pub(super) fn continuation(&mut self) -> Result<&[u8], AssetError> {
        if !self.fill()? {
            self.bytes.clear();
        }
        Ok(self.bytes.trim_ascii())
    }

    /// Goes on to the next line that is neither blank nor a comment.
    fn advance(&mut self) -> Result<bool, AssetError> {
        while !self.held {
            if !self.fill()? {
                return Ok(false);
            }
            let first = self.bytes.iter().find(|byte| !byte.is_ascii_whitespace());
            // Comments may be in any encoding: nothing is made of them.
            self.held = !matches!(first, None | Some(b'#'));
        }
        self.held = false;
        Ok(true)
    }

    /// Reads the next line without its end, which is `\n`, `\r\n` or `\r`.
    fn fill(&mut self) -> Result<bool, AssetError> {
        self.bytes.clear();
        let unreadable = |cause| AssetError::Unreadable { file: self.file.clone(), cause };
        let mut is_after_return = std::mem::take(&mut self.is_after_return);
        let mut is_line = false;
        loop {
            let available = self.reader.fill_buf().map_err(unreadable)?;
            if is_after_return && available.first() == Some(&b'\n') {
                is_after_return = false;
                self.reader.consume(1);
                continue;
            }
            is_after_return = false;
            if available.is_empty() {
                break;
            }
            is_line = true;
            let end = available.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            self.bytes.extend_from_slice(&available[..end.unwrap_or(available.len())]);
            self.is_after_return = end.is_some_and(|end| available[end] == b'\r');
            let used = end.map_or(available.len(), |end| end + 1);
            self.reader.consume(used);
            if end.is_some() || self.bytes.len() > LONGEST_LINE {
                break;
            }
        }
        self.number += usize::from(is_line);
        // The mark that some editors write before UTF-8 text.
        if self.number == 1 && self.bytes.starts_with(b"\xef\xbb\xbf") {
            self.bytes.drain(..3);
        }
        if self.bytes.len() > LONGEST_LINE {
            let (file, line) = (self.file.clone(), self.number);
            return Err(AssetError::LineTooLong { file, line, most: LONGEST_LINE });
        }
        Ok(is_line)
    }
}

/// Decodes bytes as UTF-8.
pub(super) fn decode<'b>(bytes: &'b [u8], file: &Path, line: usize) -> Result<&'b str, AssetError> {
    let not_text =
        || AssetError::NotText { file: file.to_owned(), line, guess: guess_encoding(bytes) };
    // A zero byte is lawful UTF-8, but what it tells is UTF-16 or a binary file.
    if bytes.contains(&0) {
        return Err(not_text());
    }
    std::str::from_utf8(bytes).map_err(|_invalid| not_text())
}

/// Returns the likely encoding of bytes that are not UTF-8, and a command that converts it.
fn guess_encoding(bytes: &[u8]) -> &'static str {
    if bytes.contains(&0) || bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return "a binary file, or UTF-16: `iconv -f UTF-16 -t UTF-8`";
    }
    // Lengths of the stretches beyond ASCII: letters of European words stand alone, those of Chinese are two
    // bytes each (GBK keeps both above 0xA0 for common characters).
    let stretches = bytes.split(u8::is_ascii).filter(|stretch| !stretch.is_empty());
    let mut lengths = stretches.map(<[u8]>::len);
    if lengths.clone().all(|length| length == 1) {
        "Latin-1 or Windows-1252, it seems: `iconv -f WINDOWS-1252 -t UTF-8`"
    } else if lengths.all(|length| length % 2 == 0) {
        "GBK, it seems: `iconv -f GBK -t UTF-8`"
    } else {
        "GBK, Big5, Shift-JIS or another encoding: `iconv -f GBK -t UTF-8`, for example"
    }
}
