use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec2;
use proptest::prelude::*;
use tempfile::TempDir;
use tiff::encoder::{TiffEncoder, colortype};
use tiff::tags::Tag;

use super::super::{Axes, Raster, read_raster};
use super::{file, message};

fn ascii(text: &str) -> Result<Raster, String> {
    read_raster(file(text).path(), None).map_err(|error| message(&error))
}

/// Writes a header and values side by side; the path of the values.
fn envi(folder: &TempDir, header: &str, values: &[u8]) -> PathBuf {
    fs::write(folder.path().join("dem.hdr"), header).unwrap();
    let path = folder.path().join("dem.img");
    fs::write(&path, values).unwrap();
    path
}

fn read(path: &Path) -> Result<Raster, String> {
    read_raster(path, None).map_err(|error| {
        let text = error.to_string();
        text.rsplit_once('/').map_or(text.clone(), |(_, rest)| rest.to_owned())
    })
}

#[test]
fn ascii_grids_are_read_whatever_their_keys_look_like() {
    let corner = "ncols 2\nNROWS 2\nxllcorner 10.\nyllcorner 20\ncellsize 5\nNODATA_value -9999\n\
                  1 2.\n3e0 -9999\n";
    let raster = ascii(corner).unwrap();
    assert_eq!((raster.columns, raster.rows), (2, 2));
    assert_eq!(raster.values[..3], [1.0, 2.0, 3.0]);
    assert!(raster.values[3].is_nan());
    let place = raster.place.unwrap();
    assert_eq!((place.corner, place.cell), (DVec2::new(10.0, 20.0), DVec2::splat(5.0)));
    assert_eq!(place.crs.axes, Axes::Unknown);
    // By the centre of the first cell, other sizes each way, all values in one line.
    let center = "nrows 2 ncols 2 xllcenter 12.5 yllcentre 21\r\ndx 5\r\ndy 2\r\n1 2 3 4";
    let raster = ascii(center).unwrap();
    assert_eq!(raster.values, [1.0, 2.0, 3.0, 4.0]);
    let place = raster.place.unwrap();
    assert_eq!((place.corner, place.cell), (DVec2::new(10.0, 20.0), DVec2::new(5.0, 2.0)));
    // The largest f32 as programs round it.
    let rounded = "ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n\
                   nodata_value -3.40282e+38\n-3.4028234663852886e+38";
    assert!(ascii(rounded).unwrap().values[0].is_nan());
}

#[test]
fn a_broken_ascii_grid_is_one_clear_error() {
    let head = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
    let cases = [
        ("", "has no ncols; write it above the values, as in `ncols 100`"),
        ("columns 3\n", "line 1: \"columns\" is no key of an ESRI ASCII grid"),
        ("ncols -5\n", "line 1: ncols is \"-5\"; write a whole number above 0"),
        ("ncols 2.5\n", "line 1: ncols is \"2.5\"; write a whole number above 0"),
        ("ncols 2\nncols 2\n", "line 2: a second ncols; keep one"),
        ("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\n1 2 3 4", "has no cellsize"),
        (
            "ncols 50000\nnrows 40000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3",
            "has 50000 x 40000 cells, more than 67108864",
        ),
        (
            "ncols 8000\nnrows 8000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3",
            "says 8000 x 8000 cells, which take 127999999 bytes, but the file has 62",
        ),
    ];
    for (text, expected) in cases {
        let error = ascii(text).unwrap_err();
        assert!(error.contains(expected), "{error}\nfor {text:?}");
    }
    let values = [
        ("1 2 3", "says 2 x 2 cells, but holds only 3 values"),
        ("1 2 3 4\n5", "line 7: values go on after the 2 x 2 cells of its header"),
        ("1 2 3 x", "line 6: the value \"x\" is not a number"),
        ("1 2 3 inf", "cell 1, 1 (from 0 in the north-west) is infinite"),
    ];
    for (values, expected) in values {
        let error = ascii(&format!("{head}{values}")).unwrap_err();
        assert!(error.contains(expected), "{error}\nfor {values:?}");
    }
}

/// Two bands of 3 x 2 cells; the first one holds 1 to 6.
#[test]
fn envi_files_of_every_interleave_order_and_type_are_the_same_raster() {
    let bands: [[i32; 6]; 2] = [[1, 2, 3, 4, 5, 6], [-1, -2, -3, -4, -5, -6]];
    let at = |band: usize, row: usize, column: usize| bands[band][row * 3 + column];
    let orders: [(&str, Vec<i32>); 3] = [
        ("bsq", bands.concat()),
        ("bil", (0..12).map(|i| at(i / 3 % 2, i / 6, i % 3)).collect()),
        ("bip", (0..12).map(|i| at(i % 2, i / 6, i / 2 % 3)).collect()),
    ];
    for (interleave, values) in orders {
        for data_type in [2, 3, 4, 5, 14] {
            for big in [false, true] {
                let mut bytes = b"skip".to_vec();
                for &value in &values {
                    let mut number = match data_type {
                        2 => (value as i16).to_le_bytes().to_vec(),
                        3 => value.to_le_bytes().to_vec(),
                        4 => (value as f32).to_le_bytes().to_vec(),
                        5 => f64::from(value).to_le_bytes().to_vec(),
                        _ => i64::from(value).to_le_bytes().to_vec(),
                    };
                    if big {
                        number.reverse();
                    }
                    bytes.extend(number);
                }
                let header = format!(
                    "ENVI\ndescription = {{two\n lines}}\nsamples = 3\nlines   = 2\nbands = 2\n\
                     header offset = 4\ndata type = {data_type}\ninterleave = {interleave}\n\
                     byte order = {}\ndata ignore value = 6\n\
                     map info = {{UTM, 1.5, 1.5, 500005, 4000095, 10, 10, 33, North, WGS-84, \
                     units=Meters}}\n",
                    u8::from(big)
                );
                let folder = TempDir::new().unwrap();
                let path = envi(&folder, &header, &bytes);
                let raster = read(&path).unwrap();
                assert_eq!(raster.values[..5], [1.0, 2.0, 3.0, 4.0, 5.0], "{header}");
                assert!(raster.values[5].is_nan());
                let place = raster.place.clone().unwrap();
                assert_eq!(place.corner, DVec2::new(500_000.0, 4_000_080.0));
                assert_eq!(
                    (place.cell, place.crs.axes.clone()),
                    (DVec2::splat(10.0), Axes::Metres)
                );
                let projection = place.projection.unwrap();
                let text = (projection.name.as_str(), projection.rest.as_str());
                assert_eq!(text, ("UTM", "33, North, WGS-84"));
                assert_eq!(
                    read(&path.with_extension("hdr")).unwrap().values[..5],
                    raster.values[..5]
                );
            }
        }
    }
}

#[test]
fn a_broken_envi_header_is_one_clear_error() {
    let cases = [
        ("samples = 3\n", "its header \"dem.hdr\" has no `lines`; add a line `lines = 100`"),
        ("samples = -3\n", "says `samples = -3`; write a whole number"),
        ("samples = 1\nlines = 1\ndata type = 6\n", "says `data type = 6`; use 1 to 5 or 12 to 15"),
        (
            "samples = 20000\nlines = 3000\ndata type = 4\n",
            "says 20000 x 3000 cells, which take 240000000 bytes, but the file has 8",
        ),
        ("samples = 20000\nlines = 30000\ndata type = 4\n", "more than 67108864"),
        ("samples = 99999999999\nlines = 99999999999\ndata type = 4\n", "more than 67108864"),
        ("samples = 0\nlines = 4\ndata type = 4\n", "has 0 x 4 cells"),
        (
            "samples = 1\nlines = 1\ndata type = 4\nbands = 99999999999999\n",
            "but the file has 8; it is cut off",
        ),
        ("samples = 1\nlines = 1\ndata type = 4\ninterleave = bsp\n", "write bsq, bil or bip"),
        ("samples = 1\nlines = 1\ndata type = 4\nbyte order = 2\n", "write 0 or 1"),
        ("samples = 1\nlines = 1\ndata type = 4\nmap info = {UTM, 1}\n", "six numbers"),
        (
            "samples = 1\nlines = 1\ndata type = 4\nmap info = {UTM, 1, 1, 0, 0, 1, -1, 33}\n",
            "cells are 1 x -1; write sizes above 0",
        ),
        (
            "samples = 1\nlines = 1\ndata type = 4\n\
             map info = {UTM, 1, 1, 0, 0, 1, 1, 33, rotation=30}\n",
            "is rotated",
        ),
    ];
    for (header, expected) in cases {
        let folder = TempDir::new().unwrap();
        let error = read(&envi(&folder, &format!("ENVI\n{header}"), &[0; 8])).unwrap_err();
        assert!(error.contains(expected), "{error}\nfor {header:?}");
    }
}

/// A `GeoTIFF` of 3 x 2 cells of 10 m whose north-west corner (or first centre) is the tie point.
fn geotiff(path: &Path, raster_type: u16, model_type: u16) {
    let mut file = fs::File::create(path).unwrap();
    let mut tiff = TiffEncoder::new(&mut file).unwrap();
    let mut image = tiff.new_image::<colortype::Gray32Float>(3, 2).unwrap();
    let tags = image.encoder();
    tags.write_tag(Tag::ModelPixelScaleTag, &[10.0, 10.0, 0.0][..]).unwrap();
    let tie = [0.0, 0.0, 0.0, 500_000.0, 4_000_000.0, 0.0];
    tags.write_tag(Tag::ModelTiepointTag, &tie[..]).unwrap();
    let keys: [u16; 16] =
        [1, 1, 0, 3, 1024, 0, 1, model_type, 1025, 0, 1, raster_type, 3072, 0, 1, 32733];
    tags.write_tag(Tag::GeoKeyDirectoryTag, &keys[..]).unwrap();
    tags.write_tag(Tag::GdalNodata, "-1").unwrap();
    image.write_data(&[1.0, 2.0, 3.0, 4.0, 5.0, -1.0]).unwrap();
}

#[test]
fn geotiffs_lie_where_their_tags_say() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("dem.tif");
    geotiff(&path, 1, 1);
    let raster = read(&path).unwrap();
    assert_eq!(raster.values[..5], [1.0, 2.0, 3.0, 4.0, 5.0]);
    assert!(raster.values[5].is_nan());
    let place = raster.place.unwrap();
    assert_eq!(place.corner, DVec2::new(500_000.0, 3_999_980.0));
    assert_eq!(place.crs.axes, Axes::Metres);
    let zone = place.crs.utm.unwrap();
    assert_eq!((zone.number, zone.is_south), (33, true));
    geotiff(&path, 2, 2);
    let place = read(&path).unwrap().place.unwrap();
    assert_eq!(place.corner, DVec2::new(499_995.0, 3_999_985.0), "a raster of points");
    assert_eq!(place.crs.axes, Axes::Degrees);
    // Cut anywhere, it is an error.
    let whole = fs::read(&path).unwrap();
    for length in 4..whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        assert!(read(&path).is_err() || length > whole.len() - 8, "{length}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever stands in a header, reading ends, with a raster that is lawful or an error.
    #[test]
    fn no_header_crashes_the_reader(
        kind in 0..3_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..12),
        number in prop::sample::select(vec!["", "-1", "0", "NaN", "inf", "1e308", "2147483647",
            "18446744073709551615", "99999999999999999999", "0.000001", "{", "}", "="]),
        line in any::<prop::sample::Index>(),
    ) {
        let folder = TempDir::new().unwrap();
        let text = [
            "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 5\nNODATA_value 6\n1 2 3\n4 5 6\n",
            "ENVI\nsamples = 3\nlines = 2\nbands = 1\nheader offset = 0\ndata type = 1\n\
             interleave = bil\nbyte order = 0\nmap info = {UTM, 1, 1, 5, 5, 1, 1, 33}\n",
            "",
        ][kind];
        let mut bytes = if kind == 2 {
            let path = folder.path().join("whole.tif");
            geotiff(&path, 1, 1);
            fs::read(path).unwrap()
        } else {
            // One value replaced by a number that means trouble.
            let lines: Vec<&str> = text.lines().collect();
            let chosen = line.index(lines.len());
            let replaced = lines.iter().enumerate().map(|(index, line)| {
                let cut = line.rfind(' ').filter(|_| index == chosen);
                cut.map_or_else(|| (*line).to_owned(), |at| format!("{} {number}", &line[..at]))
            });
            replaced.collect::<Vec<_>>().join("\n").into_bytes()
        };
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        let path = folder.path().join(["a.asc", "a.hdr", "a.tif"][kind]);
        fs::write(&path, bytes).unwrap();
        fs::write(folder.path().join("a.img"), [1, 2, 3, 4, 5, 6]).unwrap();
        if let Ok(raster) = read_raster(&path, None) {
            prop_assert_eq!(raster.values.len(), raster.columns * raster.rows);
            prop_assert!(raster.values.iter().all(|value| !value.is_infinite()));
            if let Some(place) = raster.place {
                prop_assert!(place.cell.min_element() > 0.0 && place.corner.is_finite());
            }
        }
    }
}
