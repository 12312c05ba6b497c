//! `GeoTIFF`: TIFF with where it lies. Source: OGC `GeoTIFF` 1.1 (OGC 19-008r4).

use std::fs::File;
use std::io::{BufReader, Seek};

use glam::DVec2;
use tiff::TiffError;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::{
    MOST_CELLS, Place, Projection, Raster, RasterError, Unit, cells, directory, is_no_data, length,
};

type Tiff = Decoder<BufReader<File>>;

/// `GeoKeys`, by their numbers.
const MODEL_TYPE: u16 = 1024;
const RASTER_TYPE: u16 = 1025;
const PROJECTED_CRS: u16 = 3072;
const LINEAR_UNIT: u16 = 3076;

#[expect(clippy::needless_pass_by_value, reason = "it is what `map_err` hands over")]
fn wrong(error: TiffError) -> RasterError {
    RasterError::Tiff(error.to_string())
}

pub(super) fn read(file: File) -> Result<Raster, RasterError> {
    let bytes = length(&file);
    let mut file = BufReader::new(file);
    directory::check(&mut file, bytes)?;
    file.rewind().map_err(|cause| RasterError::Tiff(cause.to_string()))?;
    let mut limits = Limits::default();
    limits.decoding_buffer_size = 8 * MOST_CELLS as usize;
    let mut tiff = Tiff::new(file).map_err(wrong)?.with_limits(limits);
    let (columns, rows) = tiff.dimensions().map_err(wrong)?;
    let (columns, rows) = (u64::from(columns), u64::from(rows));
    let count = cells(columns, rows)?;
    let samples = tiff.find_tag_unsigned::<u16>(Tag::SamplesPerPixel).map_err(wrong)?.unwrap_or(1);
    if samples != 1 {
        return Err(RasterError::Bands(samples));
    }
    let bits = tiff.find_tag_unsigned::<u16>(Tag::BitsPerSample).map_err(wrong)?.unwrap_or(1);
    if bits < 8 {
        return Err(RasterError::Bits(bits));
    }
    claimed_bytes(&mut tiff, columns, rows, bytes)?;
    let place = place(&mut tiff, columns as f64, rows as f64)?;
    let no_data = tiff
        .find_tag(Tag::GdalNodata)
        .map_err(wrong)?
        .and_then(|value| value.into_string().ok())
        .and_then(|text| text.trim_matches(['\0', ' ']).parse::<f64>().ok());
    let values = numbers(tiff.read_image().map_err(wrong)?);
    if values.len() < count {
        let (columns, rows) = (columns as usize, rows as usize);
        return Err(RasterError::Short { columns, rows, found: values.len() });
    }
    let values = values
        .into_iter()
        .map(|value| if is_no_data(value, no_data) { f64::NAN } else { value })
        .collect();
    let (columns, rows) = (columns as usize, rows as usize);
    Ok(Raster { columns, rows, values, place, class_names: Vec::new() })
}

/// Refuses a file that is shorter than its own strips or tiles before any memory is asked for.
fn claimed_bytes(tiff: &mut Tiff, columns: u64, rows: u64, found: u64) -> Result<(), RasterError> {
    for tag in [Tag::StripByteCounts, Tag::TileByteCounts] {
        let Some(counts) = tiff.find_tag_unsigned_vec::<u64>(tag).map_err(wrong)? else { continue };
        if counts.contains(&0) {
            return Err(RasterError::Tiff(
                "it leaves out empty tiles or strips; write it whole (gdal_translate -co \
                 SPARSE_OK=FALSE)"
                    .to_owned(),
            ));
        }
        let needed = counts.iter().fold(0_u64, |sum, &count| sum.saturating_add(count));
        if needed > found {
            return Err(RasterError::TooShort { columns, rows, needed, found });
        }
    }
    Ok(())
}

fn numbers(image: DecodingResult) -> Vec<f64> {
    fn of<T: Into<f64>>(values: Vec<T>) -> Vec<f64> {
        values.into_iter().map(Into::into).collect()
    }
    match image {
        DecodingResult::U8(values) => of(values),
        DecodingResult::U16(values) => of(values),
        DecodingResult::U32(values) => of(values),
        DecodingResult::U64(values) => values.into_iter().map(|value| value as f64).collect(),
        DecodingResult::I8(values) => of(values),
        DecodingResult::I16(values) => of(values),
        DecodingResult::I32(values) => of(values),
        DecodingResult::I64(values) => values.into_iter().map(|value| value as f64).collect(),
        DecodingResult::F16(values) => values.into_iter().map(f64::from).collect(),
        DecodingResult::F32(values) => of(values),
        DecodingResult::F64(values) => values,
    }
}

fn reals(tiff: &mut Tiff, tag: Tag) -> Result<Option<Vec<f64>>, RasterError> {
    let value = tiff.find_tag(tag).map_err(wrong)?;
    value.map(|value| value.into_f64_vec().map_err(wrong)).transpose()
}

fn place(tiff: &mut Tiff, columns: f64, rows: f64) -> Result<Option<Place>, RasterError> {
    let scale = reals(tiff, Tag::ModelPixelScaleTag)?;
    let tie = reals(tiff, Tag::ModelTiepointTag)?;
    let map = reals(tiff, Tag::ModelTransformationTag)?;
    // World coordinates of the raster's point (0, 0), and the size of a cell.
    let (origin, cell) = match (scale.as_deref(), tie.as_deref(), map.as_deref()) {
        (Some(&[width, height, ..]), Some(&[column, row, _, x, y, ..]), _) => {
            let cell = DVec2::new(width, height);
            (DVec2::new(x - column * width, y + row * height), cell)
        }
        (_, _, Some(&[width, a, _, x, b, height, _, y, ..])) => {
            if a != 0.0 || b != 0.0 || height >= 0.0 {
                return Err(RasterError::Rotated);
            }
            (DVec2::new(x, y), DVec2::new(width, -height))
        }
        _ => return Ok(None),
    };
    let keys: Vec<u16> =
        tiff.find_tag_unsigned_vec(Tag::GeoKeyDirectoryTag).map_err(wrong)?.unwrap_or_default();
    // Four numbers a key: its number, 0 for a value that stands right there, 1, the value.
    let key = |number: u16| {
        let entries = keys.chunks_exact(4).skip(1);
        entries.filter(|entry| entry[0] == number && entry[1] == 0).map(|entry| entry[3]).next()
    };
    // A raster of points has its origin in the middle of the first cell.
    let shift = if key(RASTER_TYPE) == Some(2) { 0.5 } else { 0.0 };
    let north_west = origin + DVec2::new(-shift, shift) * cell;
    let corner = DVec2::new(north_west.x, north_west.y - rows * cell.y);
    if !(columns * cell.x).is_finite() {
        return Err(RasterError::BadCell { width: cell.x, height: cell.y });
    }
    let unit = match (key(MODEL_TYPE), key(LINEAR_UNIT)) {
        (Some(2), _) => Unit::Degrees,
        (Some(1), None | Some(9001)) => Unit::Metres,
        (Some(1), Some(9002 | 9003)) => Unit::Other("feet".to_owned()),
        (Some(1), Some(other)) => Unit::Other(format!("EPSG unit {other}")),
        _ => Unit::Unknown,
    };
    // EPSG numbers the zones of UTM on WGS 84 from 32601 in the north and 32701 in the south.
    let projection = key(PROJECTED_CRS).and_then(|code| {
        let (zone, half) = match code {
            32601..=32660 => (code - 32600, "North"),
            32701..=32760 => (code - 32700, "South"),
            _ => return None,
        };
        Some(Projection { name: "UTM".to_owned(), rest: format!("{zone}, {half}, WGS-84") })
    });
    Ok(Some(Place { corner, cell, unit, projection }))
}
