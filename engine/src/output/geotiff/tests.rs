#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::io::{Cursor, Read as _};

use flate2::read::ZlibDecoder;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::{CompressionMethod, Predictor, Tag};

use super::super::band_rows::BandRows;
use super::super::envi;
use super::super::file_size;
use super::super::provenance::RecipeTexts;
use super::super::tests::{image, report, sensor};
use super::*;
use crate::components::Projection;
use crate::document::FileFormat;
use crate::products::{PixelRows, ProductSize, Rendering, Report};

/// 600 by 300 pixels in two bands, with a hole in noise.
fn large() -> crate::products::Product {
    let mut product = image();
    let (width, height) = (600, 300);
    let value = |index: usize| {
        let mix = |x: u32| (x ^ (x >> 16)).wrapping_mul(0x045d_9f3b);
        (mix(mix(mix(index as u32 + 1))) >> 8) as f32 / 16_777_216.0 - 0.1
    };
    let is_hole = |pixel: usize| pixel % width < 5 && pixel / width < 3;
    let all = (0..2 * width * height)
        .map(|index| if is_hole(index / 2) { f32::NAN } else { value(index) });
    let values: Vec<f32> = all.collect();
    let standard_error = values.iter().map(|value| value.abs() / 8.0).collect();
    let coverage = (0..width * height).map(|pixel| f32::from(u8::from(!is_hole(pixel)))).collect();
    let pixels = PixelRows { width, values, standard_error, coverage }.into();
    let place = product.image.unwrap();
    product.image = Some(Image { width, height, pixels, ..place });
    product
}

/// A report of one product.
fn report_of(product: crate::products::Product) -> Report {
    Report {
        projection: Some(Projection {
            name: "UTM".to_owned(),
            rest: "33, North, WGS-84".to_owned(),
            epsg: Some(32_633),
            wkt: None,
        }),
        ..report(vec![sensor("nadir", product)])
    }
}

/// A `GeoTIFF` of a report of one product.
fn written(report: &Report, raster: ImageRaster, big_from: u64) -> Vec<u8> {
    let product = &report.sensors[0].products[0];
    let image = product.image.as_ref().unwrap();
    let mut pixels = tempfile::tempfile().unwrap();
    for rows in image.blocks() {
        let block = BandRows::new(image, rows.clone(), image.pixels.rows(rows).unwrap());
        envi::write_rows(image, raster, &block, &mut pixels).unwrap();
    }
    let recipe = &RecipeTexts::default();
    let source = Source { report, sensor: "nadir", product, recipe };
    let writer = Writer { source: &source, image, raster, big_from };
    let mut file = Cursor::new(Vec::new());
    writer.write(pixels, &|| tempfile::tempfile(), &mut file).unwrap();
    assert_eq!(file.position(), file.get_ref().len() as u64);
    file.into_inner()
}

/// Values of a band of the directory that a decoder is at.
fn band(decoder: &mut Decoder<Cursor<&[u8]>>, band: usize) -> Vec<f32> {
    let (width, height) = decoder.dimensions().unwrap();
    let (width, height) = (width as usize, height as usize);
    let (across, down) = (width.div_ceil(TILE), height.div_ceil(TILE));
    let mut values = vec![0.0; width * height];
    for tile in 0..across * down {
        let chunk = (band * across * down + tile) as u32;
        let (columns, rows) = decoder.chunk_data_dimensions(chunk);
        let DecodingResult::F32(found) = decoder.read_chunk(chunk).unwrap() else {
            panic!("{tile}")
        };
        // The decoder does not cut the lowest tiles of bands but the first.
        let rows = (rows as usize).min(height - tile / across * TILE);
        for row in 0..rows {
            let from = &found[row * columns as usize..][..columns as usize];
            let place = (tile / across * TILE + row) * width + tile % across * TILE;
            values[place..place + columns as usize].copy_from_slice(from);
        }
    }
    values
}

/// First values of the first tile of the directory that a decoder is at, which holds bytes.
fn bytes_of_tile(decoder: &mut Decoder<Cursor<&[u8]>>, file: &[u8]) -> Vec<u8> {
    let mut place = |tag| decoder.get_tag_u32_vec(tag).unwrap()[0] as usize;
    let (offset, length) = (place(Tag::TileOffsets), place(Tag::TileByteCounts));
    let mut bytes = Vec::new();
    ZlibDecoder::new(&file[offset..offset + length]).read_to_end(&mut bytes).unwrap();
    assert_eq!(bytes.len(), TILE * TILE);
    bytes
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// *Expected*: every bit of the pixels by the crate `tiff`, in tiles, with offsets of either width.
#[test]
fn another_reader_finds_the_pixels_bit_for_bit() {
    let report = report_of(large());
    let pixels = report.sensors[0].products[0].image.as_ref().unwrap().load().unwrap();
    for (big_from, magic) in [(BIG, 42), (0, 43)] {
        for raster in [ImageRaster::Values, ImageRaster::Errors] {
            let bytes = written(&report, raster, big_from);
            assert_eq!(bytes[2], magic);
            let mut decoder = Decoder::new(Cursor::new(&bytes[..])).unwrap();
            assert_eq!(decoder.dimensions().unwrap(), (600, 300));
            assert_eq!(decoder.chunk_dimensions(), (256, 256));
            let mut number = |tag| decoder.get_tag_u32(tag).unwrap();
            assert_eq!(number(Tag::Compression), u32::from(CompressionMethod::Deflate.to_u16()));
            assert_eq!(number(Tag::Predictor), u32::from(Predictor::FloatingPoint.to_u16()));
            let all = match raster {
                ImageRaster::Values => &pixels.values,
                ImageRaster::Errors => &pixels.standard_error,
            };
            for number in 0..2 {
                let expected: Vec<f32> = all.iter().skip(number).step_by(2).copied().collect();
                assert_eq!(bits(&band(&mut decoder, number)), bits(&expected), "{raster:?}");
            }
            if raster == ImageRaster::Errors {
                assert_eq!(bits(&band(&mut decoder, 2)), bits(&pixels.coverage));
            }
        }
    }
}

/// *Expected*: means of what is known of four pixels, in half the width and height, until one tile holds all; the
/// directory in front of all pixels, and those of the smallest overview first.
#[test]
fn overviews_are_means_and_come_first() {
    let report = report_of(large());
    let bytes = written(&report, ImageRaster::Values, BIG);
    assert_eq!(bytes[4..8], [8, 0, 0, 0], "the first directory follows the header");
    let mut decoder = Decoder::new(Cursor::new(&bytes[..])).unwrap();
    let (mut below, mut first) = (band(&mut decoder, 1), u32::MAX);
    for (width, height) in [(300_usize, 150_usize), (150, 75)] {
        let offset = decoder.get_tag_u32_vec(Tag::TileOffsets).unwrap()[0];
        assert!(offset < first, "{offset} after {first}");
        first = offset;
        decoder.next_image().unwrap();
        assert_eq!(decoder.dimensions().unwrap(), (width as u32, height as u32));
        assert_eq!(decoder.get_tag_u32(Tag::NewSubfileType).unwrap(), 1);
        let found = band(&mut decoder, 1);
        for (pixel, &value) in found.iter().enumerate() {
            let (column, row) = (2 * (pixel % width), 2 * (pixel / width));
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| (column + x, row + y));
            let known = four.map(|(x, y)| {
                if y < 2 * height && x < 2 * width {
                    below.get(y * 2 * width + x).copied()
                } else {
                    None
                }
            });
            let known: Vec<f64> =
                known.into_iter().flatten().filter(|v| v.is_finite()).map(f64::from).collect();
            let mean = (known.iter().sum::<f64>() / known.len() as f64) as f32;
            let is_same = value.to_bits() == mean.to_bits() || value.is_nan() && mean.is_nan();
            assert!(is_same, "{pixel}: {value} {mean}");
        }
        below = found;
    }
    assert!(!decoder.more_images());
    assert!(decoder.get_tag_u32_vec(Tag::TileOffsets).unwrap()[0] < first);
}

/// *Expected*: the size that is estimated for noise, within a factor of two: one band of five, the coverage, takes nothing.
#[test]
fn size_of_noise_is_estimated() {
    let report = report_of(large());
    let files = [ImageRaster::Values, ImageRaster::Errors]
        .map(|raster| written(&report, raster, BIG).len());
    let size = ProductSize::Image {
        width: 600,
        pixels: 180_000,
        bands: 2,
        is_kept: false,
        is_denoised: false,
    };
    let found = files.iter().sum::<usize>() as f64 / file_size(size, &[FileFormat::GeoTiff]) as f64;
    assert!(found < 1.0 && found > 0.5, "{found}");
}

#[test]
fn tags_hold_place_system_names_and_provenance() {
    let report = report_of(large());
    let bytes = written(&report, ImageRaster::Errors, BIG);
    let mut decoder = Decoder::new(Cursor::new(&bytes[..])).unwrap();
    let mut doubles = |tag| decoder.get_tag_f64_vec(tag).unwrap();
    assert_eq!(doubles(Tag::ModelPixelScaleTag), [0.5, 0.25, 0.0]);
    assert_eq!(doubles(Tag::ModelTiepointTag), [0.0, 0.0, 0.0, 679_000.5, 5_150_000.25, 0.0]);
    let keys = decoder.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap();
    assert!(keys.chunks(4).any(|key| key == [3072, 0, 1, 32_633]), "{keys:?}");
    let mut text = |tag| decoder.get_tag_ascii_string(tag).unwrap();
    assert_eq!(text(Tag::GdalNodata), "nan");
    let description = text(Tag::ImageDescription);
    for part in ["standard errors and coverage", "hash: c0ffee", "seed: 18446744073709551615"] {
        assert!(description.contains(part), "{description}");
    }
    let metadata = text(Tag::Unknown(tag::GDAL_METADATA));
    for part in [
        "<Item name=\"DESCRIPTION\" sample=\"1\" role=\"description\">nir, wide_se</Item>",
        "<Item name=\"DESCRIPTION\" sample=\"2\" role=\"description\">coverage</Item>",
        "<Item name=\"wavelength\" sample=\"1\">865.5</Item>",
        "<Item name=\"CENTRAL_WAVELENGTH_UM\" sample=\"0\" domain=\"IMAGERY\">0.66</Item>",
        "<Item name=\"sunfleck_params\">sza=30</Item>",
    ] {
        assert!(metadata.contains(part), "{metadata}");
    }
}

/// *Expected*: bytes with a palette, 0 where there is no class, and the most frequent class in overviews.
#[test]
fn classes_are_bytes_with_colours() {
    let mut product = large();
    let (width, height) = (300, 4);
    let number = |pixel: usize| match (pixel % width, pixel / width) {
        (0, 0) => f32::NAN,
        (column, _) if column % 2 == 0 => 1.0,
        (_, row) => {
            if row == 3 {
                1.0
            } else {
                2.0
            }
        }
    };
    let values: Vec<f32> = (0..width * height).map(number).collect();
    let standard_error = vec![0.0; values.len()];
    let coverage = values.iter().map(|value| f32::from(u8::from(!value.is_nan()))).collect();
    let pixels = PixelRows { width, values, standard_error, coverage }.into();
    let class = |name: &str, colour| Class { name: name.to_owned(), colour };
    let rendering =
        Rendering::Classes(vec![class("sunlit <ground>", [255, 0, 1]), class("shade", [0, 9, 0])]);
    let bands = vec!["class".to_owned()];
    let image = product.image.unwrap();
    product.image = Some(Image { width, height, bands, pixels, rendering, ..image });
    let report = report_of(product);
    let bytes = written(&report, ImageRaster::Values, BIG);
    let mut decoder = Decoder::new(Cursor::new(&bytes[..])).unwrap();
    assert_eq!(bytes_of_tile(&mut decoder, &bytes)[..4], [0, 2, 1, 2]);
    let colours = decoder.get_tag_u16_vec(Tag::ColorMap).unwrap();
    assert_eq!([colours[1], colours[257], colours[513], colours[258]], [65_535, 0, 257, 9 * 257]);
    let metadata = decoder.get_tag_ascii_string(Tag::Unknown(tag::GDAL_METADATA)).unwrap();
    assert!(metadata.contains("\"class_1\">sunlit &amp;lt;ground&amp;gt;<"), "{metadata}");
    decoder.next_image().unwrap();
    let overview = bytes_of_tile(&mut decoder, &bytes);
    assert_eq!(overview[..2], [2, 1], "two of three that are known; the first of two and two");
    assert_eq!(overview[TILE..TILE + 2], [1, 1], "three of four");
    assert_eq!(overview[2 * TILE..2 * TILE + 2], [0, 0], "below the image");
}
