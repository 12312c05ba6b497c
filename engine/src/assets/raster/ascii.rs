//! ESRI ASCII grids: a few keys, then the values row by row from the north.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use glam::DVec2;

use super::super::AssetError;
use super::super::crs::Crs;
use super::super::error::excerpt;
use super::super::text::open;
use super::metadata::{BandMetadata, Scaling};
use super::window::CellWindow;
use super::{
    MOST_CELLS, Raster, RasterError, RasterExtent, RasterGeoreference, length, parse_no_data,
    sidecar,
};

/// Stands for no data where a grid does not say what does. Source: Esri, "ESRI ASCII raster format".
const DEFAULT_NO_DATA: f64 = -9999.0;

/// Longest word, bytes: a number has far fewer.
const LONGEST_WORD: usize = 64;

/// Words of a text, wherever its lines end.
struct WordReader<R> {
    reader: R,
    line: usize,
    word: Vec<u8>,
}

impl<R: BufRead> WordReader<R> {
    /// The next word and its line.
    fn next(&mut self) -> std::io::Result<Option<(usize, &str)>> {
        self.word.clear();
        loop {
            let bytes = self.reader.fill_buf()?;
            let Some(&byte) = bytes.first() else { break };
            let is_space = byte.is_ascii_whitespace() || byte == b',' && self.word.is_empty();
            if is_space && !self.word.is_empty() {
                break;
            }
            self.reader.consume(1);
            if byte == b'\n' {
                self.line += 1;
            } else if !is_space && self.word.len() < LONGEST_WORD {
                self.word.push(byte);
            }
        }
        if self.word.is_empty() {
            return Ok(None);
        }
        let text = std::str::from_utf8(&self.word).unwrap_or("?");
        // The mark that some editors write before UTF-8 text.
        Ok(Some((self.line, text.trim_start_matches('\u{feff}'))))
    }
}

/// Values of the header.
#[derive(Default)]
struct AsciiHeader {
    numbers: [Option<f64>; KEYS.len()],
}

/// Keys, and what their values are.
const KEYS: [(&str, &str); 10] = [
    ("ncols", "a whole number above 0"),
    ("nrows", "a whole number above 0"),
    ("xllcorner", "a number"),
    ("yllcorner", "a number"),
    ("xllcenter", "a number"),
    ("yllcenter", "a number"),
    ("cellsize", "a number above 0"),
    ("dx", "a number above 0"),
    ("dy", "a number above 0"),
    ("nodata_value", "a number"),
];

impl AsciiHeader {
    fn get(&self, key: &str) -> Option<f64> {
        KEYS.iter().position(|(name, _)| *name == key).and_then(|index| self.numbers[index])
    }

    fn set(&mut self, line: usize, key: &str, value: &str) -> Result<(), RasterError> {
        let name = key.to_ascii_lowercase().replace("centre", "center");
        let Some(index) = KEYS.iter().position(|(known, _)| *known == name) else {
            return Err(RasterError::AsciiKey { line, found: excerpt(key) });
        };
        let number = if name == "nodata_value" { parse_no_data(value) } else { value.parse().ok() };
        let number = number.filter(|&number: &f64| match KEYS[index].1 {
            "a whole number above 0" => number >= 1.0 && number.fract() == 0.0 && number < 1e15,
            "a number above 0" => number > 0.0 && number.is_finite(),
            // No data may be NaN.
            _ => number.is_finite() || name == "nodata_value",
        });
        let Some(number) = number else {
            let (found, wanted) = (excerpt(value), KEYS[index].1);
            return Err(RasterError::AsciiValue { line, key: key.to_owned(), found, wanted });
        };
        if self.numbers[index].replace(number).is_some() {
            return Err(RasterError::Repeated { line, key: key.to_owned() });
        }
        Ok(())
    }

    fn needed(&self, key: &'static str, example: &'static str) -> Result<f64, RasterError> {
        self.get(key).ok_or(RasterError::AsciiMissing { key, example })
    }

    /// Width and height of a cell.
    fn cell(&self) -> Result<DVec2, RasterError> {
        match (self.get("cellsize"), self.get("dx"), self.get("dy")) {
            (None, Some(width), Some(height)) => Ok(DVec2::new(width, height)),
            (size, ..) => size
                .map(DVec2::splat)
                .ok_or(RasterError::AsciiMissing { key: "cellsize", example: "cellsize 10" }),
        }
    }

    /// One coordinate of the corner, from that of the corner or of the centre of the first cell.
    fn corner(&self, axis: usize, cell: f64) -> Result<f64, RasterError> {
        let (corner, center) = [("xllcorner", "xllcenter"), ("yllcorner", "yllcenter")][axis];
        match (self.get(corner), self.get(center)) {
            (None, Some(center)) => Ok(center - 0.5 * cell),
            _ => self.needed(corner, ["xllcorner 0", "yllcorner 0"][axis]),
        }
    }
}

/// The header and the first value, if there is any.
fn read_header(
    words: &mut WordReader<BufReader<File>>,
    path: &Path,
) -> Result<(AsciiHeader, Option<String>), AssetError> {
    let unreadable = |cause| AssetError::Unreadable { file: path.to_owned(), cause };
    let wrong = |problem| AssetError::Raster { file: path.to_owned(), problem };
    let mut header = AsciiHeader::default();
    while let Some((line, word)) = words.next().map_err(unreadable)? {
        if is_number(word) {
            return Ok((header, Some(word.to_owned())));
        }
        let key = word.to_owned();
        if !key.bytes().all(|byte| byte.is_ascii_alphabetic() || byte == b'_') {
            let found = excerpt(&key);
            return Err(wrong(match key.as_bytes() {
                [b'0'..=b'9' | b'-' | b'.', ..] => RasterError::AsciiNumber { line, found },
                _ => RasterError::AsciiKey { line, found },
            }));
        }
        let value = words.next().map_err(unreadable)?.map_or_else(String::new, |w| w.1.to_owned());
        header.set(line, &key, &value).map_err(wrong)?;
    }
    Ok((header, None))
}

fn is_number(word: &str) -> bool {
    word.parse::<f64>().is_ok() || word.contains('#') && parse_no_data(word).is_some()
}

/// Reads the values of a grid of this number of columns and rows; returns those in the window. `first` is the first of
/// them, if the header's end was only seen by it.
fn read_values(
    words: &mut WordReader<impl BufRead>,
    first: Option<String>,
    (columns, rows): (usize, usize),
    window: &CellWindow,
    path: &Path,
) -> Result<Vec<f64>, AssetError> {
    let wrong = |problem| AssetError::Raster { file: path.to_owned(), problem };
    let mut values = Vec::with_capacity(window.len());
    let mut read = 0;
    let mut take = |line: usize, word: &str| {
        let value = if word.contains('#') { parse_no_data(word) } else { word.parse().ok() };
        let value: f64 =
            value.ok_or_else(|| wrong(RasterError::AsciiNumber { line, found: excerpt(word) }))?;
        if read == columns * rows {
            return Err(wrong(RasterError::Long { line, columns, rows }));
        }
        if window.columns.contains(&(read % columns)) && window.rows.contains(&(read / columns)) {
            values.push(value);
        }
        read += 1;
        Ok(())
    };
    if let Some(first) = first {
        take(words.line, &first)?;
    }
    let unreadable = |cause| AssetError::Unreadable { file: path.to_owned(), cause };
    while let Some((line, word)) = words.next().map_err(unreadable)? {
        take(line, word)?;
    }
    if read < columns * rows {
        return Err(wrong(RasterError::Short { columns, rows, found: read }));
    }
    Ok(values)
}

/// Reads an ESRI ASCII grid, or the part of it that an extent reaches; with a scaling in place of that of the file beside it.
pub(super) fn read(
    path: &Path,
    extent: Option<&RasterExtent>,
    scaling: Option<Scaling>,
) -> Result<Raster, AssetError> {
    let file = open(path)?;
    let bytes = length(&file);
    let mut words =
        WordReader { reader: BufReader::with_capacity(1 << 16, file), line: 1, word: Vec::new() };
    let wrong = |problem| AssetError::Raster { file: path.to_owned(), problem };
    let (header, first) = read_header(&mut words, path)?;
    let columns = header.needed("ncols", "ncols 100").map_err(wrong)? as u64;
    let rows = header.needed("nrows", "nrows 100").map_err(wrong)? as u64;
    let cell = header.cell().map_err(wrong)?;
    let corner = |axis| header.corner(axis, cell[axis]);
    let corner = DVec2::new(corner(0).map_err(wrong)?, corner(1).map_err(wrong)?);
    let (auxiliary, of_auxiliary) = sidecar::auxiliary(path, 0).map_err(wrong)?;
    let crs = sidecar::projection(path).map_err(wrong)?.or(of_auxiliary);
    let crs = crs.unwrap_or_else(|| Crs::named(""));
    let place = RasterGeoreference { corner, cell, crs, projection: None };
    let (window, place) = CellWindow::new(columns, rows, Some(&place), extent).map_err(wrong)?;
    let count = columns.saturating_mul(rows);
    if count > MOST_CELLS * MOST_CELLS {
        return Err(wrong(RasterError::TooMany { columns, rows, most: MOST_CELLS }));
    }
    // A value takes a digit and a space; the last one needs no space.
    let needed = 2 * count - 1;
    if bytes < needed {
        let problem = RasterError::TooShort { columns, rows, needed, found: bytes };
        return Err(wrong(problem));
    }
    let no_data = header.get("nodata_value");
    let band = BandMetadata { no_data, ..BandMetadata::default() }.or(auxiliary);
    let no_data = band.no_data.or(Some(DEFAULT_NO_DATA));
    let band = BandMetadata { no_data, ..band }.scaled(scaling);
    let size = (columns as usize, rows as usize);
    let mut values = read_values(&mut words, first, size, &window, path)?;
    let assumed = band.apply(&mut values);
    let of_crs = place.as_ref().and_then(|place| place.crs.heights.as_ref());
    let heights = band.heights(of_crs).map_err(wrong)?;
    let (columns, rows) = (window.columns.len(), window.rows.len());
    Raster { columns, rows, values, place, class_names: Vec::new(), heights, assumed }
        .checked()
        .map_err(wrong)
}
