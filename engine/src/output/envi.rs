//! ENVI rasters: float32, band sequential, little-endian, with a text header beside the pixels.

use std::fs::File;
use std::io::{self, Read as _, Seek, SeekFrom, Write};
use std::ops::Range;

use super::Source;
use super::band_rows::BandRows;
use super::classification::{self, classes_of};
use super::provenance::RecipeForm;
use crate::components::Projection;
use crate::products::Image;

/// Stands for "nothing was seen". Readers disagree on NaN; no product of light is negative.
pub(super) const NO_DATA: f32 = -9999.0;

/// Size of a value, bytes.
const VALUE: usize = size_of::<f32>();

/// One of the rasters of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ImageRaster {
    /// A band each.
    Values,
    /// The standard error of each band, and the coverage, which is of all bands.
    Errors,
}

/// Columns and rows of a raster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RasterSize {
    pub(super) width: usize,
    pub(super) height: usize,
}

impl From<&Image> for RasterSize {
    fn from(image: &Image) -> Self {
        Self { width: image.width, height: image.height }
    }
}

/// Writes rows of all bands to their places; the file has shape `[bands, rows, columns]`.
pub(super) fn write_rows(
    image: &Image,
    raster: ImageRaster,
    block: &BandRows,
    file: &mut (impl Write + Seek),
) -> io::Result<()> {
    if raster == ImageRaster::Values && classes_of(image).is_some() {
        return file.write_all(&classification::bytes(block));
    }
    let mut bytes = Vec::with_capacity(block.coverage.len() * VALUE);
    let mut write = |band: usize, values: &[f32]| {
        bytes.clear();
        let shown = |&value: &f32| if value.is_finite() { value } else { NO_DATA };
        bytes.extend(values.iter().flat_map(|value| shown(value).to_le_bytes()));
        let place = (band * image.height + block.rows.start) * image.width * VALUE;
        file.seek(SeekFrom::Start(place as u64))?;
        file.write_all(&bytes)
    };
    for band in 0..block.bands() {
        let values = match raster {
            ImageRaster::Values => block.values(band),
            ImageRaster::Errors => block.standard_error(band),
        };
        write(band, values)?;
    }
    match raster {
        ImageRaster::Values => Ok(()),
        ImageRaster::Errors => write(block.bands(), &block.coverage),
    }
}

/// Reads rows of a band of a raster without classes back; NaN where there are no data.
pub(super) fn read_rows(
    size: RasterSize,
    band: usize,
    rows: Range<usize>,
    mut file: &File,
) -> io::Result<Vec<f32>> {
    let mut bytes = vec![0; rows.len() * size.width * VALUE];
    let place = (band * size.height + rows.start) * size.width * VALUE;
    file.seek(SeekFrom::Start(place as u64))?;
    file.read_exact(&mut bytes)?;
    let values = bytes.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes));
    let known = |value: f32| if value.to_bits() == NO_DATA.to_bits() { f32::NAN } else { value };
    Ok(values.map(known).collect())
}

/// Writes the header that goes with [`write_rows`].
pub(super) fn write_header(
    source: &Source<'_>,
    image: &Image,
    raster: ImageRaster,
    file: &mut impl Write,
) -> io::Result<()> {
    let provenance = source.provenance(RecipeForm::Packed);
    let provenance = provenance.into_iter().map(|(key, value)| format!("{key}: {}", item(&value)));
    let mut description = provenance.collect::<Vec<_>>().join("; ");
    let mut names: Vec<_> = image.bands.iter().map(|name| item(name)).collect();
    if raster == ImageRaster::Errors {
        description.insert_str(0, "standard errors and coverage; ");
        for name in &mut names {
            name.push_str("_se");
        }
        names.push("coverage".to_owned());
    }
    writeln!(file, "ENVI")?;
    writeln!(file, "description = {{{description}}}")?;
    writeln!(file, "samples = {}", image.width)?;
    writeln!(file, "lines = {}", image.height)?;
    writeln!(file, "bands = {}", names.len())?;
    writeln!(file, "header offset = 0")?;
    let classes = classes_of(image).filter(|_| raster == ImageRaster::Values);
    let (kind, data_type) =
        if classes.is_some() { ("ENVI Classification", 1) } else { ("ENVI Standard", 4) };
    writeln!(file, "file type = {kind}")?;
    writeln!(file, "data type = {data_type}")?;
    writeln!(file, "interleave = bsq")?;
    writeln!(file, "byte order = 0")?;
    match classes {
        Some(classes) => file.write_all(classification::header_lines(classes).as_bytes())?,
        None => writeln!(file, "data ignore value = {NO_DATA}")?,
    }
    writeln!(file, "band names = {{{}}}", names.join(", "))?;
    let wavelengths = source.wavelengths(image);
    // The coverage has none, and a list must name as many as there are bands.
    if raster == ImageRaster::Values && wavelengths.iter().all(|wavelength| wavelength.is_finite())
    {
        let numbers: Vec<_> = wavelengths.iter().map(f64::to_string).collect();
        writeln!(file, "wavelength units = Nanometers")?;
        writeln!(file, "wavelength = {{{}}}", numbers.join(", "))?;
    }
    if let Some(place) = image.georeference {
        let (name, rest) = match &source.report.projection {
            Some(Projection { name, rest, .. }) => {
                (item(name), rest.split(',').map(item).collect::<Vec<_>>().join(", "))
            }
            None => ("Arbitrary".to_owned(), "0, North".to_owned()),
        };
        // Pixel (1, 1) is the outer corner of the first pixel.
        writeln!(
            file,
            "map info = {{{name}, 1, 1, {}, {}, {}, {}, {rest}, units=Meters}}",
            place.west, place.north, place.pixel_width, place.pixel_height
        )?;
        let text = source.report.projection.as_ref().and_then(|projection| projection.wkt.as_ref());
        if let Some(text) = text {
            writeln!(file, "coordinate system string = {{{}}}", braceless(text))?;
        }
    }
    Ok(())
}

/// `text` in one line and without braces, which would end a value in a header.
fn braceless(text: &str) -> String {
    let words: Vec<_> = text.split_whitespace().collect();
    words.join(" ").replace(['{', '}'], "_")
}

/// `text` without the letters that end an item or a list in a header.
fn item(text: &str) -> String {
    let plain = |letter| if matches!(letter, ',' | '{' | '}') { '_' } else { letter };
    text.split_whitespace().collect::<Vec<_>>().join(" ").chars().map(plain).collect()
}
