//! Stores are read back here by the rules of the format, and in `tests/readers/datasets.py` by other programs.

use std::io::Read as _;

use flate2::read::ZlibDecoder;
use proptest::prelude::*;

use super::super::dataset::{Attributes, Dimension, Values};
use super::super::rows::indices;
use super::*;

fn dataset(shape: &[usize], is_raster: bool) -> Dataset<'static> {
    let count: usize = shape.iter().product();
    let values: Vec<f64> = (0..count).map(|value| value as f64).collect();
    let dimension =
        |(place, &length): (usize, &usize)| Dimension { name: format!("d{place}"), length };
    Dataset {
        dimensions: shape.iter().enumerate().map(dimension).collect(),
        attributes: Attributes::default(),
        variables: vec![Variable {
            name: "v".to_owned(),
            dimensions: (0..shape.len()).collect(),
            attributes: Attributes::default(),
            values: Values::Doubles(values.into()),
            has_fill: true,
            is_raster,
        }],
    }
}

/// Reads all values of an array of f64 chunk by chunk, as a reader does that knows its documents alone.
fn read(folder: &Path) -> Vec<f64> {
    let text = fs::read_to_string(folder.join("v/.zarray")).unwrap();
    let array: serde_json::Value = serde_json::from_str(&text).unwrap();
    let list = |name: &str| -> Vec<usize> { serde_json::from_value(array[name].clone()).unwrap() };
    let (shape, chunk) = (list("shape"), list("chunks"));
    let counts: Vec<usize> =
        shape.iter().zip(&chunk).map(|(all, one)| all.div_ceil(*one)).collect();
    let mut values = vec![f64::NAN; shape.iter().product()];
    for number in 0..counts.iter().product() {
        let place = indices(&counts, number);
        let name: Vec<String> = place.iter().map(usize::to_string).collect();
        let name = if name.is_empty() { "0".to_owned() } else { name.join(".") };
        let mut bytes = Vec::new();
        let file = File::open(folder.join("v").join(name)).unwrap();
        ZlibDecoder::new(file).read_to_end(&mut bytes).unwrap();
        assert_eq!(bytes.len(), 8 * chunk.iter().product::<usize>(), "all chunks are of one size");
        for (within, value) in bytes.as_chunks().0.iter().enumerate() {
            let within = indices(&chunk, within);
            let place: Vec<usize> =
                place.iter().zip(&chunk).zip(within).map(|((p, c), w)| p * c + w).collect();
            if place.iter().zip(&shape).all(|(place, length)| place < length) {
                let flat = place.iter().zip(&shape).fold(0, |flat, (p, length)| flat * length + p);
                values[flat] = f64::from_le_bytes(*value);
            }
        }
    }
    values
}

fn assert_is_read(shape: &[usize], is_raster: bool) {
    let folder = tempfile::tempdir().unwrap();
    let size = write(&dataset(shape, is_raster), folder.path()).unwrap();
    let values = read(folder.path());
    assert!(
        values.iter().enumerate().all(|(place, value)| value.to_bits() == (place as f64).to_bits()),
        "{shape:?}"
    );
    let files = |folder: &Path| -> u64 {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().metadata().unwrap());
        entries.filter(fs::Metadata::is_file).map(|metadata| metadata.len()).sum()
    };
    assert_eq!(size, files(folder.path()) + files(&folder.path().join("v")));
}

#[test]
fn arrays_of_every_shape_are_read_back() {
    for shape in [
        &[][..],
        &[1],
        &[300_000],
        &[3, 100_000],
        &[2, 3, 50_000],
        &[2, 200_000],
        &[7, 40, 1000],
        &[2, 1, 140_000],
    ] {
        assert_is_read(shape, false);
    }
    for shape in [&[1, 1][..], &[2, 600, 700], &[1, 1, 1300], &[3, 520, 9], &[512, 1024], &[9, 513]]
    {
        assert_is_read(shape, true);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn rasters_of_any_size_are_read_back(bands in 1_usize..3, rows in 1_usize..1100, columns in 1_usize..1100) {
        assert_is_read(&[bands, rows, columns], true);
    }
}
