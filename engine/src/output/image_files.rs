//! Files of an image: all rasters in one pass over its pixels, then pictures and `GeoTIFF` from these.

use std::fs::File;
use std::io;

use super::band_rows::BandRows;
use super::dataset::ImageFiles;
use super::envi::ImageRaster;
use super::figure::{Caption, Figure};
use super::picture::PicturePainter;
use super::picture_input::{BandsWithData, PictureInput};
use super::provenance::RecipeForm;
use super::staged_file::StagedFile;
use super::staging::Staging;
use super::titles::product_title;
use super::{OutputError, Source, envi, exr, geotiff, names};
use crate::document::FileFormat;
use crate::products::Image;

/// Writes the files of an image; returns their size in bytes, and the rasters, if data sets are made of them.
pub(super) fn put(
    source: &Source<'_>,
    image: &Image,
    names: &names::ProductNames,
    staging: &mut Staging,
) -> Result<(u64, Option<ImageFiles>), OutputError> {
    let has = |format| source.report.formats.contains(&format);
    let mut exr = has(FileFormat::Exr).then(|| staging.begin(&names.exr())).transpose()?;
    let mut rasters = None;
    let mut size = 0;
    if has(FileFormat::Envi) {
        let (files, headers) = Rasters::begin(source, image, names, staging)?;
        (rasters, size) = (Some(files), headers);
    } else if [FileFormat::Png, FileFormat::GeoTiff, FileFormat::Zarr, FileFormat::NetCdf]
        .map(has)
        .contains(&true)
    {
        rasters = Some(Rasters::without_names(image, staging)?);
    }
    write_blocks(source, image, exr.as_mut(), rasters.as_mut())?;
    if let Some(exr) = exr {
        size += exr.finish()?;
    }
    let Some(Rasters { mut values, mut errors, lit }) = rasters else { return Ok((size, None)) };
    let readers = [values.reader()?, errors.reader()?];
    if has(FileFormat::Envi) {
        size += values.finish()?;
        if image.has_errors {
            size += errors.finish()?;
        }
    }
    let [values, errors] = readers;
    if has(FileFormat::GeoTiff) {
        let rasters = [(ImageRaster::Values, &values), (ImageRaster::Errors, &errors)];
        for ((raster, pixels), name) in rasters.into_iter().zip(names.geotiffs()) {
            let mut file = staging.begin(&name)?;
            let scratch = || staging.scratch();
            let fill = |file: &mut _| {
                geotiff::write(source, image, raster, pixels.try_clone()?, &scratch, file)
            };
            file.write(fill)?;
            size += file.finish()?;
        }
    }
    let mut kept = None;
    if has(FileFormat::Zarr) || has(FileFormat::NetCdf) {
        let again = |file: &File| {
            file.try_clone()
                .map_err(|source| OutputError::Read { path: staging.shown(&names.img()), source })
        };
        kept = Some(ImageFiles { values: again(&values)?, errors: again(&errors)? });
    }
    if has(FileFormat::Png) {
        let wavelengths = source.wavelengths(image);
        let input = PictureInput { image, wavelengths, lit, values, errors };
        size += put_pictures(source, &input, [&names.png(), &names.bare()], staging)?;
    }
    Ok((size, kept))
}

/// Writes all pixels, block by block, to the files that there are.
fn write_blocks(
    source: &Source<'_>,
    image: &Image,
    exr: Option<&mut StagedFile>,
    mut rasters: Option<&mut Rasters>,
) -> Result<(), OutputError> {
    let mut failure = None;
    let mut blocks = image.blocks().map(|rows| {
        let block = BandRows::read(source, image, rows).and_then(|block| {
            rasters.as_mut().map_or(Ok(()), |rasters| rasters.write(image, &block))?;
            Ok(block)
        });
        block.map_err(|error| {
            failure = Some(error);
            io::Error::other("the block failed")
        })
    });
    let written = if let Some(exr) = exr {
        exr.write(|file| exr::write(source, image, blocks, file))
    } else {
        // The failure tells why one fails.
        blocks.find_map(Result::err);
        Ok(())
    };
    failure.map_or(written, Err)
}

/// ENVI rasters that are being written.
struct Rasters {
    values: StagedFile,
    errors: StagedFile,
    lit: BandsWithData,
}

impl Rasters {
    /// Rasters that are results, whose headers have been written, and the size of these in bytes.
    fn begin(
        source: &Source<'_>,
        image: &Image,
        names: &names::ProductNames,
        staging: &mut Staging,
    ) -> Result<(Self, u64), OutputError> {
        let mut size = 0;
        let mut begin = |name: String, raster| -> Result<StagedFile, OutputError> {
            let file = staging.begin(&name)?;
            let header = names::header(&name);
            size +=
                staging.file(&header, |file| envi::write_header(source, image, raster, file))?;
            Ok(file)
        };
        let values = begin(names.img(), ImageRaster::Values)?;
        let errors = match names.errors() {
            Some(name) => begin(name, ImageRaster::Errors)?,
            // Pictures are made of the coverage that it holds.
            None => staging.begin_unnamed()?,
        };
        Ok((Self { values, errors, lit: BandsWithData::new(image.bands.len()) }, size))
    }

    /// Rasters from which other files are made, and which are gone then.
    fn without_names(image: &Image, staging: &Staging) -> Result<Self, OutputError> {
        let [values, errors] = [staging.begin_unnamed()?, staging.begin_unnamed()?];
        Ok(Self { values, errors, lit: BandsWithData::new(image.bands.len()) })
    }

    fn write(&mut self, image: &Image, block: &BandRows) -> Result<(), OutputError> {
        self.lit.add(block);
        let Self { values, errors, .. } = self;
        values.write(|file| envi::write_rows(image, ImageRaster::Values, block, file))?;
        errors.write(|file| envi::write_rows(image, ImageRaster::Errors, block, file))
    }
}

/// Writes the pictures of an image with and without a legend; returns their size in bytes.
fn put_pictures(
    source: &Source<'_>,
    input: &PictureInput<'_>,
    [framed, bare]: [&str; 2],
    staging: &mut Staging,
) -> Result<u64, OutputError> {
    let picture = PicturePainter::new(input).map_err(OutputError::pixels(source))?;
    let mut figure_file = staging.begin(framed)?;
    let mut shown = None;
    let size = staging.file(bare, |file| {
        shown = Some(picture.encode(&source.provenance(RecipeForm::Readable), file)?);
        Ok(())
    })?;
    let shown = shown.expect("the file was written");
    let caption = Caption {
        title: format!("{}: {}", source.sensor, product_title(&source.product.name)),
        scene: &source.report.scene,
        unit: &source.product.unit,
    };
    let figure = Figure::new(&picture, shown, input.image.georeference, &caption);
    figure_file.write(|file| figure.encode(&source.provenance(RecipeForm::Readable), file))?;
    Ok(size + figure_file.finish()?)
}
