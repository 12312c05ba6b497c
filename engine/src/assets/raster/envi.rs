//! ENVI rasters: raw values beside a text header.

use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::super::error::excerpt;
use super::{Place, Projection, Raster, RasterError, Unit, cells, is_no_data, length};

/// Longest header, bytes.
const LONGEST_HEADER: u64 = 1 << 20;

/// The header of an ENVI raster, which may be the named file itself.
pub(super) fn header_of(path: &Path, start: &[u8]) -> Option<PathBuf> {
    if start.starts_with(b"ENVI") {
        return Some(path.to_owned());
    }
    let mut appended = path.as_os_str().to_owned();
    appended.push(".hdr");
    [PathBuf::from(appended), path.with_extension("hdr")]
        .into_iter()
        .find(|header| header.is_file() && header != path && is_header(header))
}

fn is_header(path: &Path) -> bool {
    let mut start = [0; 4];
    File::open(path).and_then(|mut file| file.read_exact(&mut start)).is_ok() && start == *b"ENVI"
}

/// The values that belong to a header which was named itself.
fn values_of(header: &Path) -> Result<PathBuf, RasterError> {
    let bare = header.with_extension("");
    let mut tried = vec![bare.clone()];
    tried.extend(["img", "dat", "raw", "bsq", "bil", "bip", "bin"].map(|e| bare.with_extension(e)));
    let found = tried.iter().find(|path| path.is_file() && *path != header).cloned();
    found.ok_or_else(|| {
        let names = tried.iter().filter_map(|path| path.file_name()).map(|n| n.to_string_lossy());
        RasterError::NoValues(names.collect::<Vec<_>>().join(", "))
    })
}

/// `key = value` entries of a header; values in braces may go over several lines.
struct Header {
    name: String,
    entries: Vec<(String, String)>,
}

impl Header {
    fn read(path: &Path) -> Result<Self, RasterError> {
        let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        let mut bytes = Vec::new();
        let read = File::open(path).and_then(|f| f.take(LONGEST_HEADER).read_to_end(&mut bytes));
        read.map_err(|_unreadable| RasterError::NoHeader(name.clone()))?;
        let text = String::from_utf8_lossy(&bytes);
        let mut entries = Vec::new();
        let mut lines = text.lines().skip(1);
        while let Some(line) = lines.next() {
            let Some((key, value)) = line.split_once('=') else { continue };
            let mut value = value.trim().to_owned();
            let mut is_open = value.starts_with('{') && !value.contains('}');
            while is_open {
                let Some(more) = lines.next() else { break };
                is_open = !more.contains('}');
                value.push(' ');
                value.push_str(more.trim());
            }
            let value = value.trim_start_matches('{').split('}').next().unwrap_or_default();
            let key = key.split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase();
            entries.push((key, value.trim().to_owned()));
        }
        Ok(Self { name, entries })
    }

    fn get(&self, key: &str) -> Option<&str> {
        self.entries.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    fn error(&self, problem: String) -> RasterError {
        RasterError::Envi { header: self.name.clone(), problem }
    }

    /// A whole number; the default where nothing is written.
    fn whole(&self, key: &str, default: Option<u64>) -> Result<u64, RasterError> {
        match (self.get(key), default) {
            (Some(text), _) => text.parse().map_err(|_invalid| {
                let found = excerpt(text);
                self.error(format!("says `{key} = {found}`; write a whole number"))
            }),
            (None, Some(default)) => Ok(default),
            (None, None) => Err(self.error(format!("has no `{key}`; add a line `{key} = 100`"))),
        }
    }

    fn place(&self, rows: u64) -> Result<Option<Place>, RasterError> {
        let Some(text) = self.get("map info") else { return Ok(None) };
        let items: Vec<&str> = text.split(',').map(str::trim).collect();
        let numbers: Vec<f64> =
            items.iter().skip(1).take(6).map_while(|item| item.parse().ok()).collect();
        let &[column, row, east, north, width, height] = numbers.as_slice() else {
            let problem = "has a `map info` without six numbers behind its name; write, for \
                           example, `map info = {Arbitrary, 1, 1, 500000, 4000000, 10, 10}`";
            return Err(self.error(problem.to_owned()));
        };
        let rest = &items[7..];
        let rotated = rest.iter().filter_map(|item| item.split_once('=')).any(|(key, value)| {
            key.trim() == "rotation" && value.trim().parse::<f64>().is_ok_and(|angle| angle != 0.0)
        });
        if rotated {
            return Err(RasterError::Rotated);
        }
        let unit = rest.iter().find_map(|item| item.split_once('=')).map(|(_, unit)| unit.trim());
        let is_geographic = items[0].to_lowercase().starts_with("geographic");
        let unit = match unit.map(str::to_lowercase).as_deref() {
            Some("degrees") => Unit::Degrees,
            _ if is_geographic => Unit::Degrees,
            Some("meters" | "metres") => Unit::Metres,
            Some(other) => Unit::Other(other.to_owned()),
            None if items[0] == "UTM" => Unit::Metres,
            None => Unit::Unknown,
        };
        let named = rest.iter().take_while(|item| !item.contains('='));
        let projection = (!is_geographic && items[0] != "Arbitrary").then(|| Projection {
            name: items[0].to_owned(),
            rest: named.copied().collect::<Vec<_>>().join(", "),
        });
        // Pixel (1, 1) is the outer corner of the first pixel, (1.5, 1.5) its centre.
        let corner = DVec2::new(
            east - (column - 1.0) * width,
            north + (row - 1.0) * height - rows as f64 * height,
        );
        Ok(Some(Place { corner, cell: DVec2::new(width, height), unit, projection }))
    }
}

pub(super) fn read(named: &Path, header_path: &Path) -> Result<Raster, RasterError> {
    let header = Header::read(header_path)?;
    let file = if named == header_path { values_of(header_path)? } else { named.to_owned() };
    let columns = header.whole("samples", None)?;
    let rows = header.whole("lines", None)?;
    let bands = header.whole("bands", Some(1))?.max(1);
    let offset = header.whole("header offset", Some(0))?;
    let data_type = header.whole("data type", None)?;
    let size: u64 = match data_type {
        1 => 1,
        2 | 12 => 2,
        3 | 4 | 13 => 4,
        5 | 14 | 15 => 8,
        other => {
            return Err(header.error(format!(
                "says `data type = {other}`; use 1 to 5 or 12 to 15, whole or real numbers"
            )));
        }
    };
    let is_big = match header.whole("byte order", Some(0))? {
        0 => false,
        1 => true,
        other => return Err(header.error(format!("says `byte order = {other}`; write 0 or 1"))),
    };
    let count = cells(columns, rows)? as u64;
    let needed = count
        .checked_mul(size)
        .and_then(|bytes| bytes.checked_mul(bands))
        .and_then(|bytes| bytes.checked_add(offset));
    let mut values_file = File::open(&file)
        .map_err(|_unreadable| RasterError::NoValues(file.display().to_string()))?;
    let found = length(&values_file);
    if needed.is_none_or(|needed| needed > found) {
        let needed = needed.unwrap_or(u64::MAX);
        return Err(RasterError::TooShort { columns, rows, needed, found });
    }
    // Of each row (or the whole), the first band stands first; how far it is to the next piece?
    let (piece, stride) = match header.get("interleave").unwrap_or("bsq").to_lowercase().as_str() {
        "bsq" => (count, count),
        "bil" => (columns, columns * bands),
        "bip" => (1, bands),
        other => {
            let found = excerpt(other);
            let problem = format!("says `interleave = {found}`; write bsq, bil or bip");
            return Err(header.error(problem));
        }
    };
    let no_data = match header.get("data ignore value") {
        None => None,
        Some(text) => Some(text.parse::<f64>().map_err(|_invalid| {
            let found = excerpt(text);
            header.error(format!("says `data ignore value = {found}`; write a number"))
        })?),
    };
    let unreadable = |cause: std::io::Error| header.error(format!("is fine, but: {cause}"));
    values_file.seek(SeekFrom::Start(offset)).map_err(unreadable)?;
    // Up to the last value of the first band.
    let mut bytes = vec![0; (((count / piece - 1) * stride + piece) * size) as usize];
    values_file.read_exact(&mut bytes).map_err(unreadable)?;
    let values = bytes
        .chunks((stride * size) as usize)
        .flat_map(|chunk| chunk[..(piece * size) as usize].chunks_exact(size as usize))
        .map(|raw| number(raw, data_type, is_big))
        .map(|value| if is_no_data(value, no_data) { f64::NAN } else { value })
        .collect();
    let class_names = header.get("class names").map_or_else(Vec::new, |names| {
        names.split(',').map(|name| name.trim().to_owned()).collect()
    });
    let place = header.place(rows)?;
    Ok(Raster { columns: columns as usize, rows: rows as usize, values, place, class_names })
}

fn number(raw: &[u8], data_type: u64, is_big: bool) -> f64 {
    // The bytes in little-endian order, the least first.
    let mut bytes = [0; 8];
    for (index, &byte) in raw.iter().enumerate() {
        bytes[if is_big { raw.len() - 1 - index } else { index }] = byte;
    }
    let whole = u64::from_le_bytes(bytes);
    match data_type {
        2 => f64::from(whole as u16 as i16),
        3 => f64::from(whole as u32 as i32),
        4 => f64::from(f32::from_bits(whole as u32)),
        5 => f64::from_bits(whole),
        14 => whole as i64 as f64,
        _ => whole as f64,
    }
}

/// Whether a path is the header of an ENVI raster or has one; for lists of the files of a scene.
#[must_use]
pub(crate) fn companion(path: &Path) -> Option<PathBuf> {
    if is_header(path) {
        return values_of(path).ok();
    }
    fs::metadata(path).ok()?;
    header_of(path, b"")
}
