//! Rasters of several bands: images of ENVI, `GeoTIFF` and EXR.

use std::path::Path;

use exr::prelude::{FlatSamples, ReadChannels as _, ReadLayers as _, read};

use super::{RasterError, RasterGeoreference, cells, envi, geotiff, is_tiff, start_of};
use crate::assets::AssetError;
use crate::assets::text::open;

/// All bands of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct BandRaster {
    /// Number of pixels in a row.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Bands, in the order of the file; channels of an EXR by their names.
    pub bands: Vec<RasterBand>,
    /// Text about the file that it holds itself: sunfleck writes its provenance there.
    pub description: String,
    /// Georeference, if the file has one.
    pub place: Option<RasterGeoreference>,
}

/// A band of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterBand {
    /// Its name, or its number if the file has no names.
    pub name: String,
    /// Centre wavelength, nm, if the file says it.
    pub wavelength_nm: Option<f64>,
    /// Values, shape `[rows, columns]`, row 0 at the top; NaN where there is no data.
    pub values: Vec<f32>,
}

/// Reads all bands of an image; the format follows from the content.
///
/// # Errors
/// A file of another format, or one that lacks something or says it wrongly.
pub fn read_bands(path: &Path) -> Result<BandRaster, AssetError> {
    let start = start_of(path)?;
    let raster = if is_tiff(&start) {
        geotiff::read_bands(open(path)?)
    } else if start.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        read_exr(path)
    } else if let Some(header) = envi::header_of(path, &start) {
        envi::read_bands(path, &header)
    } else {
        Err(RasterError::NoImage)
    };
    raster.map_err(|problem| AssetError::Raster { file: path.to_owned(), problem })
}

fn read_exr(path: &Path) -> Result<BandRaster, RasterError> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map_err(|error| RasterError::Unreadable(error.to_string()))?;
    let layer = image.layer_data;
    let (columns, rows) = (layer.size.width(), layer.size.height());
    cells(columns as u64, rows as u64)?;
    let band = |channel: exr::prelude::AnyChannel<FlatSamples>| RasterBand {
        name: channel.name.to_string(),
        wavelength_nm: None,
        values: match channel.sample_data {
            FlatSamples::F32(values) => values,
            FlatSamples::F16(values) => values.into_iter().map(f32::from).collect(),
            FlatSamples::U32(values) => values.into_iter().map(|value| value as f32).collect(),
        },
    };
    let bands = layer.channel_data.list.into_iter().map(band).collect();
    let description = layer.attributes.comments.map(|text| text.to_string()).unwrap_or_default();
    Ok(BandRaster { columns, rows, bands, description, place: None })
}
