//! Files of an image: all rasters in one pass over its pixels, then pictures from these.

use std::io;

use super::band_rows::BandRows;
use super::envi::Raster;
use super::figure::{Caption, Figure};
use super::picture::Picture;
use super::picture_input::{LitBands, PictureInput};
use super::staging::{StagedFile, Staging};
use super::{OutputError, Source, envi, exr, names};
use crate::products::Image;

/// Writes the files of an image; returns their size in bytes.
pub(super) fn put(
    source: &Source<'_>,
    image: &Image,
    names: &names::ProductNames,
    staging: &mut Staging,
) -> Result<u64, OutputError> {
    let mut exr = staging.begin(&names.exr())?;
    let mut size = 0;
    let mut begin = |name: String, raster| -> Result<StagedFile, OutputError> {
        let file = staging.begin(&name)?;
        let header = names::header(&name);
        size += staging.file(&header, |file| envi::write_header(source, image, raster, file))?;
        Ok(file)
    };
    let mut rasters = Rasters {
        values: begin(names.img(), Raster::Values)?,
        errors: begin(names.errors(), Raster::Errors)?,
        lit: LitBands::new(image.bands.len()),
    };
    let mut failure = None;
    let blocks = image.blocks().map(|rows| {
        let block = BandRows::read(source, image, rows);
        let written = block.and_then(|block| rasters.write(image, &block).map(|()| block));
        written.map_err(|error| {
            failure = Some(error);
            io::Error::other("the block failed")
        })
    });
    let written = exr.write(|file| exr::write(source, image, blocks, file));
    if let Some(error) = failure {
        return Err(error);
    }
    written?;
    let Rasters { mut values, mut errors, lit } = rasters;
    let input = PictureInput {
        image,
        wavelengths: source.wavelengths(image),
        lit,
        values: values.reader()?,
        errors: errors.reader()?,
    };
    size += exr.finish()? + values.finish()? + errors.finish()?;
    Ok(size + put_pictures(source, &input, [&names.png(), &names.bare()], staging)?)
}

/// ENVI rasters that are being written.
struct Rasters {
    values: StagedFile,
    errors: StagedFile,
    lit: LitBands,
}

impl Rasters {
    fn write(&mut self, image: &Image, block: &BandRows) -> Result<(), OutputError> {
        self.lit.add(block);
        let Self { values, errors, .. } = self;
        values.write(|file| envi::write_rows(image, Raster::Values, block, file))?;
        errors.write(|file| envi::write_rows(image, Raster::Errors, block, file))
    }
}

/// Writes the pictures of an image with and without a legend; returns their size in bytes.
fn put_pictures(
    source: &Source<'_>,
    input: &PictureInput<'_>,
    [framed, bare]: [&str; 2],
    staging: &mut Staging,
) -> Result<u64, OutputError> {
    let picture = Picture::new(input).map_err(OutputError::pixels(source))?;
    let mut figure_file = staging.begin(framed)?;
    let mut shown = None;
    let size = staging.file(bare, |file| {
        shown = Some(picture.encode(&source.provenance(), file)?);
        Ok(())
    })?;
    let shown = shown.expect("the file was written");
    let caption = Caption {
        title: format!("{}: {}", source.sensor, source.product.name.replace('_', " ")),
        scene: &source.report.scene,
        unit: &source.product.unit,
    };
    let figure = Figure::new(&picture, shown, input.image.georeference, &caption);
    figure_file.write(|file| figure.encode(&source.provenance(), file))?;
    Ok(size + figure_file.finish()?)
}
