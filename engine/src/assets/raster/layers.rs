//! Bands of large rasters, read in strips: the values of a few bands or of sums of bands, cell by cell.

use std::path::{Path, PathBuf};

use super::geotiff::TiffReader;
use super::metadata::{BandMetadata, Scaling};
use super::window::CellWindow;
use super::{
    Assumed, Raster, RasterError, RasterExtent, RasterFormat, RasterGeoreference, ascii, envi,
    esri, sidecar,
};
use crate::assets::AssetError;
use crate::memory;

/// Numbers that are read at once, unless a row of tiles of the file holds more.
const STRIP: usize = 1 << 22;

/// Most numbers that are read at once, unless one band of a row of tiles has more: 256 MiB.
const MOST_NUMBERS: usize = 1 << 25;

/// Most cells of a raster: they are counted in 32 bits.
const MOST: u64 = 1 << 31;

/// A raster of one or more bands whose values are still to be read.
#[expect(missing_debug_implementations, reason = "a decoder of TIFF has no Debug")]
pub struct RasterFile {
    path: PathBuf,
    source: RasterSamples,
}

/// A band of a raster, as the file describes it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BandDescription {
    /// Its name, if the file has one.
    pub name: Option<String>,
    /// Centre wavelength, nm, if the file says it.
    pub wavelength_nm: Option<f64>,
    pub(super) metadata: BandMetadata,
}

impl BandDescription {
    /// Returns whether the file says what its numbers are to be multiplied with, or what is to be added to them.
    #[must_use]
    pub fn has_scaling(&self) -> bool {
        let BandMetadata { scale, offset, .. } = &self.metadata;
        let is_other = |value: &Option<f64>, plain: f64| {
            value.is_some_and(|one| one.to_bits() != plain.to_bits())
        };
        is_other(scale, 1.0) || is_other(offset, 0.0)
    }
}

/// Summand of a layer: a factor times the values of a band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerTerm {
    /// Layer, from 0.
    pub layer: usize,
    /// Band of the file, from 0.
    pub band: usize,
    /// Factor on the values of the band.
    pub factor: f64,
}

/// Values of cells in several layers.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterLayers {
    /// The cells, without values.
    pub grid: Raster,
    /// Values, shape `[cells, layers]`, row 0 in the north; NaN where there is no data.
    pub values: Vec<f32>,
}

/// Cells of a file, and their place.
#[derive(Clone, Copy)]
pub(super) struct FileLayout<'a> {
    pub(super) columns: u64,
    pub(super) rows: u64,
    pub(super) place: Option<&'a RasterGeoreference>,
}

/// Source of the numbers in a file, by bands.
pub(super) trait SampleReader {
    /// The cells of the file.
    fn layout(&self) -> FileLayout<'_>;

    /// The bands of the file, in its order.
    fn bands(&self) -> &[BandDescription];

    /// Number of rows that lie together in the file.
    fn rows_at_once(&self) -> usize;

    /// Reads some bands of the cells of a strip, shape `[bands, cells]`; NaN where a mask is 0.
    fn read(
        &mut self,
        strip: &CellWindow,
        bands: &[usize],
        values: &mut [Vec<f64>],
    ) -> Result<(), RasterError>;
}

enum RasterSamples {
    Strips(Box<dyn SampleReader>),
    /// Text of one band, which is read as a whole.
    Ascii(BandDescription),
}

impl RasterFile {
    /// Opens a raster and reads the descriptions of its bands; the format follows from the content.
    ///
    /// # Errors
    /// A file that cannot be read, lacks something, or says something wrongly.
    pub fn open(path: &Path) -> Result<Self, AssetError> {
        let wrong = |problem| AssetError::Raster { file: path.to_owned(), problem };
        let reader: Box<dyn SampleReader> = match RasterFormat::of_file(path)? {
            RasterFormat::Tiff => Box::new(TiffReader::new(path).map_err(wrong)?),
            RasterFormat::Envi(header) => Box::new(envi::reader(path, &header).map_err(wrong)?),
            RasterFormat::Esri(header) => Box::new(esri::reader(path, &header).map_err(wrong)?),
            RasterFormat::Ascii => {
                let (metadata, _) = sidecar::auxiliary(path, 0).map_err(wrong)?;
                let band = BandDescription { metadata, ..BandDescription::default() };
                return Ok(Self { path: path.to_owned(), source: RasterSamples::Ascii(band) });
            }
        };
        Ok(Self { path: path.to_owned(), source: RasterSamples::Strips(reader) })
    }

    /// Bands of the file, in its order.
    #[must_use]
    pub fn bands(&self) -> &[BandDescription] {
        match &self.source {
            RasterSamples::Strips(reader) => reader.bands(),
            RasterSamples::Ascii(band) => std::slice::from_ref(band),
        }
    }

    /// Reads the cells that an extent reaches, all of them without an extent. A layer is the sum of its terms; a cell
    /// without data in one of its bands has none in any layer. The scaling takes the place of that of the file.
    ///
    /// # Errors
    /// A file that lacks something or says it wrongly, and one with more cells than there is memory for.
    ///
    /// # Panics
    /// If there is no such band, or no term for a layer.
    pub fn read(
        &mut self,
        extent: Option<&RasterExtent>,
        terms: &[LayerTerm],
        scaling: Option<Scaling>,
    ) -> Result<RasterLayers, AssetError> {
        let layers = terms.iter().map(|term| term.layer + 1).max().expect("there is a layer");
        let file = self.path.clone();
        let wrong = |problem| AssetError::Raster { file: file.clone(), problem };
        match &mut self.source {
            RasterSamples::Strips(reader) => {
                let mut builder =
                    LayerBuilder::new(reader.layout(), extent, layers).map_err(wrong)?;
                builder.read(&mut **reader, terms, scaling).map_err(wrong)?;
                Ok(builder.layers)
            }
            RasterSamples::Ascii(_) => {
                let mut grid = ascii::read(&self.path, extent, scaling)?;
                let values = std::mem::take(&mut grid.values);
                check_memory(&grid, layers).map_err(wrong)?;
                let mut layered = RasterLayers { values: vec![0.0; values.len() * layers], grid };
                layered.add(0, layers, terms, &[0], &[values]).map_err(wrong)?;
                Ok(layered)
            }
        }
    }
}

fn check_memory(grid: &Raster, layers: usize) -> Result<(), RasterError> {
    let Raster { columns, rows, .. } = *grid;
    let count = columns as f64 * rows as f64 * layers as f64;
    match memory::lacking(count, 4) {
        Some(lack) => Err(RasterError::Memory { columns, rows, layers, lack }),
        None => Ok(()),
    }
}

/// Layers that are being read.
struct LayerBuilder {
    window: CellWindow,
    layer_count: usize,
    layers: RasterLayers,
}

impl LayerBuilder {
    fn new(
        FileLayout { columns, rows, place }: FileLayout<'_>,
        extent: Option<&RasterExtent>,
        layer_count: usize,
    ) -> Result<Self, RasterError> {
        if columns == 0 || rows == 0 {
            return Err(RasterError::Empty { columns, rows });
        }
        let (window, place) = CellWindow::of_any_size(columns, rows, place, extent)?;
        if window.columns.len() as u64 * window.rows.len() as u64 > MOST {
            return Err(RasterError::TooMany { columns, rows, most: MOST });
        }
        let grid = Raster {
            columns: window.columns.len(),
            rows: window.rows.len(),
            values: Vec::new(),
            place,
            class_names: Vec::new(),
            heights: None,
            assumed: None,
        };
        check_memory(&grid, layer_count)?;
        let values = vec![0.0; window.len() * layer_count];
        let layers = RasterLayers { grid: grid.checked()?, values };
        Ok(Self { window, layer_count, layers })
    }

    fn read(
        &mut self,
        reader: &mut dyn SampleReader,
        terms: &[LayerTerm],
        scaling: Option<Scaling>,
    ) -> Result<(), RasterError> {
        let mut bands: Vec<usize> = terms.iter().map(|term| term.band).collect();
        bands.sort_unstable();
        bands.dedup();
        let scaled = |band: &BandDescription| band.metadata.clone().scaled(scaling);
        let metadata: Vec<BandMetadata> = reader.bands().iter().map(scaled).collect();
        // A cell lacks data in many bands, and is one cell.
        let mut assumed = vec![None; metadata.len()];
        let (columns, at_once) = (self.window.columns.len(), reader.rows_at_once().max(1));
        // A few bands at a time where the rows of a tile of all of them would take much memory.
        let bands_at_once = (MOST_NUMBERS / (columns * at_once)).clamp(1, bands.len());
        let rows = (STRIP / (columns * bands_at_once)).max(1).next_multiple_of(at_once);
        let mut values = vec![Vec::new(); bands_at_once];
        let mut start = self.window.rows.start;
        while start < self.window.rows.end {
            // Strips end where tiles do, so that each is decoded once.
            let end = (start / at_once * at_once + rows).min(self.window.rows.end);
            let strip = CellWindow { columns: self.window.columns.clone(), rows: start..end };
            let first = (start - self.window.rows.start) * columns;
            for bands in bands.chunks(bands_at_once) {
                let values = &mut values[..bands.len()];
                reader.read(&strip, bands, values)?;
                for (&band, values) in bands.iter().zip(&mut *values) {
                    let next = metadata[band].apply(values);
                    assumed[band] = counted(assumed[band], next);
                }
                self.layers.add(first, self.layer_count, terms, bands, values)?;
            }
            start = end;
        }
        self.layers.grid.assumed = assumed.into_iter().flatten().max_by_key(|one| one.count);
        Ok(())
    }
}

/// Cells of the value for no data that was found first, those of another strip included.
fn counted(known: Option<Assumed>, next: Option<Assumed>) -> Option<Assumed> {
    match (known, next) {
        (Some(Assumed { value, count }), Some(next)) if value.to_bits() == next.value.to_bits() => {
            Some(Assumed { value, count: count + next.count })
        }
        (known, next) => known.or(next),
    }
}

impl RasterLayers {
    /// Adds the terms of a strip of cells, whose values have the shape `[bands, cells]`.
    fn add(
        &mut self,
        first: usize,
        layers: usize,
        terms: &[LayerTerm],
        bands: &[usize],
        values: &[Vec<f64>],
    ) -> Result<(), RasterError> {
        for (band, values) in bands.iter().zip(values) {
            let of_band: Vec<&LayerTerm> = terms.iter().filter(|term| term.band == *band).collect();
            for (index, &value) in values.iter().enumerate() {
                if value.is_infinite() {
                    let cell = first + index;
                    let (column, row) = (cell % self.grid.columns, cell / self.grid.columns);
                    return Err(RasterError::Infinite { column, row });
                }
                let cell = &mut self.values[(first + index) * layers..][..layers];
                if value.is_nan() {
                    cell.fill(f32::NAN);
                    continue;
                }
                for term in &of_band {
                    cell[term.layer] += (term.factor * value) as f32;
                }
            }
        }
        Ok(())
    }
}
