//! Text files of a project, with bounds on what they may cost.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::Path;

use anyhow::{Context as _, Result, bail};

/// Longest line, bytes: what a file without line ends may cost in memory.
const LONGEST_LINE: u64 = 1 << 20;

/// A regular file, open for reading.
fn open(path: &Path) -> Result<File> {
    let cannot = || format!("cannot read {}", path.display());
    // Checked before it is opened: opening a pipe would wait for its writer.
    if !fs::metadata(path).with_context(cannot)?.is_file() {
        bail!("{} is not a file", path.display());
    }
    File::open(path).with_context(cannot)
}

/// All of a file of at most `limit` bytes.
fn bytes(path: &Path, limit: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        bail!("{} holds more than {limit} bytes", path.display());
    }
    Ok(bytes)
}

/// The text of a file of at most `limit` bytes, with letters of unknown encodings replaced.
pub(super) fn whole_lossy(path: &Path, limit: u64) -> Result<String> {
    Ok(String::from_utf8_lossy(&bytes(path, limit)?).into_owned())
}

/// The text of a file of at most `limit` bytes.
pub(super) fn whole(path: &Path, limit: u64) -> Result<String> {
    let bytes = bytes(path, limit)?;
    String::from_utf8(bytes)
        .ok()
        .with_context(|| format!("{} is not UTF-8 text: {SAVE_AS}", path.display()))
}

/// Advice for files of other encodings, such as GBK.
const SAVE_AS: &str = "open it in an editor and save it with the encoding UTF-8";

/// Calls `each` with every line that is not blank, and puts `file:line` before its errors.
pub(super) fn lines(path: &Path, mut each: impl FnMut(&str) -> Result<()>) -> Result<()> {
    raw_lines(path, |bytes, number| {
        let line = str::from_utf8(bytes)
            .ok()
            .with_context(|| format!("the line is not UTF-8 text: {SAVE_AS}"))?;
        // Editors of Windows put a mark before the first line.
        let line = if number == 1 { line.trim_start_matches('\u{feff}') } else { line }.trim();
        if line.is_empty() { Ok(()) } else { each(line) }
    })
}

/// The same, with letters of unknown encodings replaced: comments and names may hold any.
pub(super) fn lossy_lines(path: &Path, mut each: impl FnMut(&str) -> Result<()>) -> Result<()> {
    raw_lines(path, |bytes, _| each(String::from_utf8_lossy(bytes).trim()))
}

fn raw_lines(path: &Path, mut each: impl FnMut(&[u8], u64) -> Result<()>) -> Result<()> {
    let mut reader = BufReader::new(open(path)?);
    let mut bytes = Vec::new();
    for number in 1_u64.. {
        bytes.clear();
        let read = reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes)?;
        let place = || format!("{}:{number}", path.display());
        if read as u64 == LONGEST_LINE {
            bail!("{}: the line is longer than {LONGEST_LINE} bytes", place());
        }
        if read == 0 {
            break;
        }
        each(&bytes, number).with_context(place)?;
    }
    Ok(())
}

/// The start of a text, without what would break a line.
pub(super) fn excerpt(text: &str) -> String {
    let mut short: String =
        text.chars().take(60).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}

/// A name for a file, made of letters that every system takes.
pub(super) fn file_name(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || "_-".contains(c) { c } else { '_' };
    name.chars().take(100).map(safe).collect()
}

/// Text in quotes, as RON reads it; what starts with `=` stays text.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for (index, letter) in text.chars().enumerate() {
        match letter {
            '"' | '\\' => out.extend(['\\', letter]),
            '=' if index == 0 => out.push_str("\\u{3D}"),
            _ if letter.is_control() => {
                // Writing to a string cannot fail.
                let _infallible = write!(out, "\\u{{{:X}}}", u32::from(letter));
            }
            _ => out.push(letter),
        }
    }
    out.push('"');
    out
}

/// A list of numbers, as RON reads it.
pub(super) fn list(numbers: &[f64]) -> String {
    format!("{numbers:?}")
}
