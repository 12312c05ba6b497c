//! Every file is read back with somebody else's reader. This file holds the reports that they write.

mod folder;
mod images;
mod summary;
mod tables;

use std::fs;

use super::*;
use crate::document::FileFormat;
use crate::products::{
    AxisPoints, Forecast, Georeference, Image, PixelRows, ProductAxis, Rendering, SensorReport,
};

fn axis(name: &str, points: &[f64]) -> ProductAxis {
    ProductAxis { name: name.to_owned(), points: AxisPoints::Numbers(points.to_vec()) }
}

fn labels(name: &str, points: &[&str]) -> ProductAxis {
    let points = points.iter().map(|&point| point.to_owned()).collect();
    ProductAxis { name: name.to_owned(), points: AxisPoints::Labels(points) }
}

/// BRF of three views in two bands, one of them without data.
pub(in crate::output) fn views() -> Product {
    Product {
        name: "brf".to_owned(),
        unit: "1".to_owned(),
        dimensions: vec![
            vec![axis("zenith_deg", &[-5.0, 0.0, 5.0]), axis("azimuth_deg", &[90.0, 0.0, 270.0])],
            vec![labels("band", &["red", "nir, wide"])],
        ],
        values: vec![0.1, 1.0 / 3.0, 1e-300, f64::NAN, 0.05, 0.1 + 0.2],
        standard_error: vec![0.001, 0.002, f64::NAN, f64::NAN, 1e-9, 0.0],
        image: None,
        faces: None,
        replicates: Vec::new(),
    }
}

/// 3 by 2 pixels in two bands; the last pixel saw nothing.
pub(in crate::output) fn image() -> Product {
    let mut values: Vec<f32> = (0_u8..12).map(|index| f32::from(index) / 16.0).collect();
    values[10..].fill(f32::NAN);
    let standard_error = values.iter().map(|value| value / 8.0).collect();
    let coverage = vec![1.0, 1.0, 1.0, 1.0, 0.5, 0.0];
    let pixels = PixelRows { width: 3, values, standard_error, coverage };
    Product {
        name: "brf".to_owned(),
        unit: "1".to_owned(),
        dimensions: vec![vec![labels("band", &["red", "nir, wide"])]],
        values: vec![0.25, 0.3125],
        standard_error: vec![0.001, 0.002],
        image: Some(Image {
            width: 3,
            height: 2,
            bands: vec!["red".to_owned(), "nir, wide".to_owned()],
            pixels: pixels.into(),
            has_errors: true,
            rendering: Rendering::Quicklook,
            georeference: Some(Georeference {
                west: 679_000.5,
                north: 5_150_000.25,
                pixel_width: 0.5,
                pixel_height: 0.25,
            }),
        }),
        faces: None,
        replicates: Vec::new(),
    }
}

pub(in crate::output) fn sensor(name: &str, product: Product) -> SensorReport {
    SensorReport {
        name: name.to_owned(),
        products: vec![product],
        seconds: 0.1,
        rays: 1 << 40,
        samples: 64,
        ended_by: "samples 64".to_owned(),
        energy_imbalance: None,
        forecast: Forecast { seconds: 0.1, memory: 1 << 20, files: 1 << 10 },
    }
}

pub(in crate::output) fn report(sensors: Vec<SensorReport>) -> Report {
    Report {
        projection: None,
        scene: "Birch\n# stand \u{df}".to_owned(),
        formats: FileFormat::DEFAULT.to_vec(),
        hash: "c0ffee".to_owned(),
        version: "0.1.0".to_owned(),
        seed: u64::MAX,
        seconds: 1.0 / 7.0,
        rays: 3,
        bands: vec!["red".to_owned(), "nir, wide".to_owned()],
        wavelengths: vec![660.0, 865.5],
        bandwidths: vec![10.0, 20.0],
        stages: vec![("z first".to_owned(), 0.5), ("a second".to_owned(), 0.25)],
        skipped: vec!["mesh \"bush\"".to_owned()],
        notes: vec!["the sun is that of ASTM G173".to_owned()],
        warnings: Vec::new(),
        sensors,
        params: vec![("sza".to_owned(), 30.0.into())],
        irradiance: vec![1.0; 2],
        responses: Vec::new(),
        sun_azimuth_deg: Some(250.0),
        sun_zenith_deg: Some(30.0),
        source: None,
        coefficients: None,
        recipe: None,
    }
}

/// Folder with the files of one image and one list of views.
fn written() -> (tempfile::TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().unwrap();
    let report = report(vec![sensor("nadir", image()), sensor("plane", views())]);
    let paths = write(&report, &folder.path().join("deep/er")).unwrap();
    (folder, paths)
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}
