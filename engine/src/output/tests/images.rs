//! Files of images: EXR, ENVI, PNG.

use super::*;

#[test]
fn exr_holds_every_channel_bit_for_bit() {
    let (_folder, paths) = written();
    let read = ::exr::prelude::read_all_flat_layers_from_file(&paths[0]).unwrap();
    let layer = &read.layer_data[0];
    let channels: Vec<(String, Vec<u32>)> = layer
        .channel_data
        .list
        .iter()
        .map(|channel| {
            let bits = channel.sample_data.values_as_f32().map(f32::to_bits).collect();
            (channel.name.to_string(), bits)
        })
        .collect();
    let image = image().image.unwrap().load().unwrap();
    let of = |values: &[f32], band: usize| -> Vec<u32> {
        values.iter().skip(band).step_by(2).map(|value| value.to_bits()).collect()
    };
    let expected = [
        ("coverage", image.coverage.iter().map(|value| value.to_bits()).collect()),
        ("nir, wide", of(&image.values, 1)),
        ("nir, wide.se", of(&image.standard_error, 1)),
        ("red", of(&image.values, 0)),
        ("red.se", of(&image.standard_error, 0)),
    ];
    assert_eq!(channels, expected.map(|(name, values)| (name.to_owned(), values)));
    let comments = layer.attributes.comments.clone().unwrap();
    let text: serde_json::Value = serde_json::from_slice(comments.bytes()).unwrap();
    let seed = u64::MAX.to_string();
    let expected = [
        ("unit", "1"),
        ("hash", "c0ffee"),
        ("seed", &seed),
        ("version", "0.1.0"),
        ("scene", "Birch # stand \u{df}"),
        ("params", "sza=30"),
    ];
    for (key, value) in expected {
        assert_eq!(text[key], value, "{key}");
    }
    // More than one attribute of our own would be written in an order that differs from run to run.
    assert!(layer.attributes.other.is_empty() && read.attributes.other.is_empty());
}

/// Value of a key in an ENVI header.
fn field<'a>(header: &'a str, key: &str) -> &'a str {
    let line = header.lines().find(|line| line.split(" = ").next() == Some(key));
    line.and_then(|line| line.split_once(" = ")).unwrap_or_else(|| panic!("no {key}")).1
}

#[test]
fn a_second_envi_raster_holds_errors_and_coverage() {
    let (_folder, paths) = written();
    let header = fs::read_to_string(&paths[4]).unwrap();
    assert_eq!(field(&header, "band names"), "{red_se, nir_ wide_se, coverage}");
    assert_eq!(field(&header, "bands"), "3");
    assert!(field(&header, "map info").contains("679000.5, 5150000.25, 0.5, 0.25"));
    assert!(!header.contains("wavelength"), "the coverage has none");
    let bytes = fs::read(&paths[3]).unwrap();
    let found: Vec<f32> = bytes
        .chunks_exact(4)
        .map(|number| f32::from_le_bytes(number.try_into().unwrap()))
        .collect();
    let image = image().image.unwrap().load().unwrap();
    let band = |band: usize| image.standard_error.iter().skip(band).step_by(2).copied();
    let expected: Vec<f32> = band(0)
        .chain(band(1))
        .map(|error| if error.is_nan() { -9999.0 } else { error })
        .chain(image.coverage.iter().copied())
        .collect();
    assert_eq!(found, expected);
}

#[test]
fn envi_header_describes_the_pixels() {
    let (_folder, paths) = written();
    let header = fs::read_to_string(&paths[2]).unwrap();
    assert!(header.starts_with("ENVI\n"));
    let field = |key: &str| field(&header, key);
    let count = |key: &str| field(key).parse::<usize>().unwrap();
    let (samples, lines, bands) = (count("samples"), count("lines"), count("bands"));
    let bytes = fs::read(&paths[1]).unwrap();
    assert_eq!((samples, lines, bands), (3, 2, 2));
    assert_eq!((field("data type"), field("interleave"), field("byte order")), ("4", "bsq", "0"));
    assert_eq!(bytes.len(), samples * lines * bands * 4 + count("header offset"));
    let list = |key: &str| -> Vec<String> {
        let inner = field(key).trim_start_matches('{').trim_end_matches('}');
        inner.split(',').map(|item| item.trim().to_owned()).collect()
    };
    assert_eq!(list("band names"), ["red", "nir_ wide"], "no comma within a name");
    assert_eq!(list("wavelength"), ["660", "865.5"]);
    let place = list("map info");
    assert_eq!(place[1..7], ["1", "1", "679000.5", "5150000.25", "0.5", "0.25"]);
    assert_eq!(place[0], "Arbitrary");
    let no_data: f32 = field("data ignore value").parse().unwrap();
    let image = image().image.unwrap().load().unwrap();
    for band in 0..bands {
        for pixel in 0..samples * lines {
            let at = 4 * (band * samples * lines + pixel);
            let read = f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
            let value = image.values[pixel * bands + band];
            let expected = if value.is_nan() { no_data } else { value };
            assert_eq!(read.to_bits(), expected.to_bits(), "band {band}, pixel {pixel}");
        }
    }
}

#[test]
fn quicklook_is_a_png_with_transparency_and_provenance() {
    let (_folder, paths) = written();
    let file = io::BufReader::new(fs::File::open(&paths[6]).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (3, 2));
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgba, png::BitDepth::Eight));
    let opacity: Vec<u8> = pixels.iter().skip(3).step_by(4).copied().collect();
    assert_eq!(opacity, [255, 255, 255, 255, 128, 0]);
    assert_eq!(pixels[..3], [0; 3], "darkest pixel");
    assert_eq!(pixels[16..19], [255; 3], "brightest pixel");
    let texts: Vec<_> = reader.info().utf8_text.iter().map(|text| text.keyword.as_str()).collect();
    assert!(texts.contains(&"hash") && texts.contains(&"seed"), "{texts:?}");
}
