//! Cloud-optimised `GeoTIFF`: float32 tiles, overviews, band names, and the place on the ground.
//!
//! The crate `tiff`, which reads rasters, writes strips and puts a directory behind its pixels. Cloud-optimised files have
//! tiles, and all directories in front: so their tags are written here. No crate that writes such files streams them
//! without five or more further crates.

mod directory;
mod geo_keys;
mod metadata;
mod pyramid;
mod tiles;

#[cfg(test)]
mod tests;

use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};

use self::directory::{OffsetWidth, TagDirectory, TagValue, encode, tag};
pub(crate) use self::metadata::escaped;
use self::pyramid::{Level, Pyramid};
pub(super) use self::tiles::TILE;
use self::tiles::{TileIndex, write_tiles};
use super::Source;
use super::classification::classes_of;
use super::envi::ImageRaster;
use crate::products::{Class, Image};

/// Size of all uncompressed tiles from which a file has offsets of 64 bits, bytes. Tiles that do not compress grow by less
/// than what it lacks to 4 GiB.
const BIG: u64 = 4_000_000_000;

/// Writes a raster of an image.
///
/// - `pixels`: the raster as ENVI pixels, without a header
/// - `new_scratch`: makes a temporary file
pub(super) fn write(
    source: &Source<'_>,
    image: &Image,
    raster: ImageRaster,
    pixels: File,
    new_scratch: &dyn Fn() -> io::Result<File>,
    file: &mut (impl Write + Seek),
) -> io::Result<()> {
    let writer = Writer { source, image, raster, big_from: BIG };
    writer.write(pixels, new_scratch, file)
}

/// Writer of one raster.
struct Writer<'a> {
    source: &'a Source<'a>,
    image: &'a Image,
    raster: ImageRaster,
    /// See [`BIG`].
    big_from: u64,
}

impl Writer<'_> {
    fn write(
        &self,
        pixels: File,
        new_scratch: &dyn Fn() -> io::Result<File>,
        file: &mut (impl Write + Seek),
    ) -> io::Result<()> {
        let classes = classes_of(self.image).filter(|_| self.raster == ImageRaster::Values);
        let bands = match self.raster {
            ImageRaster::Values => self.image.bands.len(),
            ImageRaster::Errors => self.image.bands.len() + 1,
        };
        let base = Level {
            file: pixels,
            width: self.image.width,
            height: self.image.height,
            is_of_classes: classes.is_some(),
            is_of_bytes: classes.is_some(),
        };
        let Pyramid { levels } = Pyramid::new(base, bands, new_scratch)?;
        let size: u64 = levels.iter().map(|level| level.bytes_of_tiles(bands)).sum();
        let kind = if size >= self.big_from { OffsetWidth::Big } else { OffsetWidth::Classic };
        let mut directories = levels
            .iter()
            .enumerate()
            .map(|(number, level)| self.directory(level, number, bands, classes))
            .collect::<io::Result<Vec<_>>>()?;
        let head = encode(&directories, kind)?;
        file.write_all(&head)?;
        // Readers find the smallest overview first, and the pixels last.
        let mut place = head.len() as u64;
        for (level, directory) in levels.iter().zip(&mut directories).rev() {
            let index = write_tiles(level, bands, &mut place, file)?;
            directory.insert(tag::TILE_OFFSETS, TagValue::Places(index.offsets));
            directory.insert(tag::TILE_BYTE_COUNTS, TagValue::Places(index.lengths));
        }
        file.seek(SeekFrom::Start(0))?;
        file.write_all(&encode(&directories, kind)?)?;
        file.seek(SeekFrom::Start(place)).map(drop)
    }

    /// Directory of a level, without the places of its tiles.
    fn directory(
        &self,
        level: &Level,
        number: usize,
        bands: usize,
        classes: Option<&[Class]>,
    ) -> io::Result<TagDirectory> {
        let too_large = |_| io::Error::other("a TIFF has at most 65535 bands");
        let count = u16::try_from(bands).map_err(too_large)?;
        let short = |value: u16| TagValue::Shorts(vec![value]);
        let long = |value: usize| TagValue::Longs(vec![value as u32]);
        let (bits, format) = if classes.is_some() { (8, 1) } else { (32, 3) };
        let mut directory = TagDirectory::default();
        let mut insert = |tag, field| directory.insert(tag, field);
        insert(tag::NEW_SUBFILE_TYPE, long(usize::from(number > 0)));
        insert(tag::IMAGE_WIDTH, long(level.width));
        insert(tag::IMAGE_LENGTH, long(level.height));
        insert(tag::BITS_PER_SAMPLE, TagValue::Shorts(vec![bits; bands]));
        insert(tag::COMPRESSION, short(8));
        insert(tag::PHOTOMETRIC, short(if classes.is_some() { 3 } else { 1 }));
        insert(tag::SAMPLES_PER_PIXEL, short(count));
        insert(tag::PLANAR_CONFIGURATION, short(if bands == 1 { 1 } else { 2 }));
        insert(tag::PREDICTOR, short(if classes.is_some() { 1 } else { 3 }));
        insert(tag::TILE_WIDTH, long(TILE));
        insert(tag::TILE_LENGTH, long(TILE));
        insert(tag::SAMPLE_FORMAT, TagValue::Shorts(vec![format; bands]));
        if bands > 1 {
            insert(tag::EXTRA_SAMPLES, TagValue::Shorts(vec![0; bands - 1]));
        }
        if let Some(classes) = classes {
            insert(tag::COLOR_MAP, TagValue::Shorts(metadata::colour_map(classes)));
        }
        insert(
            tag::GDAL_NODATA,
            TagValue::Ascii(if classes.is_some() { "0" } else { "nan" }.into()),
        );
        let TileIndex { offsets, lengths } = TileIndex::unknown(level, bands);
        insert(tag::TILE_OFFSETS, TagValue::Places(offsets));
        insert(tag::TILE_BYTE_COUNTS, TagValue::Places(lengths));
        if number == 0 {
            let description = metadata::description(self.source, self.raster);
            insert(tag::IMAGE_DESCRIPTION, TagValue::Ascii(description));
            insert(tag::SOFTWARE, TagValue::Ascii(metadata::software(self.source)));
            let metadata = metadata::gdal(self.source, self.image, self.raster, classes);
            insert(tag::GDAL_METADATA, TagValue::Ascii(metadata));
            if let Some(place) = self.image.georeference {
                geo_keys::insert(place, self.source.report.projection.as_ref(), &mut directory);
            }
        }
        Ok(directory)
    }
}
