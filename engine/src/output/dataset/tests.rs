use std::sync::LazyLock;

use super::super::OfSensor;
use super::super::names::plan;
use super::super::provenance::RecipeTexts;
use super::super::tests::{image, report, sensor};
use super::*;
use crate::products::{AxisPoints, Product, ProductAxis, Report};

fn labels(name: &str, points: &[&str]) -> ProductAxis {
    let points = points.iter().map(|&point| point.to_owned()).collect();
    ProductAxis { name: name.to_owned(), points: AxisPoints::Labels(points) }
}

fn numbers(name: &str, points: &[f64]) -> ProductAxis {
    ProductAxis { name: name.to_owned(), points: AxisPoints::Numbers(points.to_vec()) }
}

/// A table over these dimensions.
fn table(name: &str, dimensions: Vec<Vec<ProductAxis>>) -> Product {
    let count: usize = dimensions.iter().map(|axes| axes[0].points.len()).product();
    let values: Vec<f64> = (0_u16..count as u16).map(f64::from).collect();
    Product {
        name: name.to_owned(),
        dimensions,
        standard_error: values.clone(),
        values,
        image: None,
        ..image()
    }
}

fn report_of(products: Vec<Product>) -> Report {
    let mut report = report(vec![sensor("a", image())]);
    report.sensors[0].products = products;
    report
}

/// The only sensor of a report.
fn of(report: &Report) -> OfSensor<'_> {
    static NONE: LazyLock<RecipeTexts> = LazyLock::new(RecipeTexts::default);
    OfSensor { report, sensor: &report.sensors[0], recipe: &NONE }
}

/// Each variable with its dimensions and the coordinates that it names.
fn shown(report: &Report) -> Vec<String> {
    let none: Vec<Option<ImageRasters>> = report.sensors[0].products.iter().map(|_| None).collect();
    let dataset = of_sensor(&of(report), &plan(report)[0], none).unwrap();
    let line = |variable: &Variable<'_>| {
        let dimensions = variable.dimensions.iter().map(|&place| &dataset.dimensions[place]);
        let dimensions: Vec<String> =
            dimensions.map(|one| format!("{}={}", one.name, one.length)).collect();
        let coordinates = variable.attributes.0.iter().find(|(name, _)| name == "coordinates");
        let coordinates = match coordinates {
            Some((_, Attribute::Text(text))) => format!(" at {text}"),
            _ => String::new(),
        };
        format!("{}({}){coordinates}", variable.name, dimensions.join(", "))
    };
    dataset.variables.iter().map(line).collect()
}

#[test]
fn equal_axes_are_one_dimension_and_different_ones_have_different_names() {
    let views = || vec![numbers("zenith_deg", &[0.0, 5.0]), numbers("azimuth_deg", &[0.0, 90.0])];
    let report = report_of(vec![
        table("brf", vec![views(), vec![labels("band", &["red", "nir, wide"])]]),
        table("radiance", vec![views(), vec![labels("band", &["red", "nir, wide"])]]),
        table("emitted", vec![views(), vec![labels("band", &["red"])]]),
        table("fapar", vec![vec![numbers("bottom_m", &[0.0]), numbers("top_m", &[1.0])]]),
        table("lai", Vec::new()),
    ]);
    let views = "zenith azimuth signed_zenith";
    let of_bands = format!(" at {views} wavelength bandwidth");
    let emitted = format!(" at {views} wavelength_emitted bandwidth_emitted");
    let expected = [
        "zenith(view=2)".to_owned(),
        "azimuth(view=2)".to_owned(),
        "signed_zenith(view=2)".to_owned(),
        "band(band=2)".to_owned(),
        "wavelength(band=2)".to_owned(),
        "bandwidth(band=2)".to_owned(),
        "band_emitted(band_emitted=1)".to_owned(),
        "wavelength_emitted(band_emitted=1)".to_owned(),
        "bandwidth_emitted(band_emitted=1)".to_owned(),
        "bottom(layer=1)".to_owned(),
        "top(layer=1)".to_owned(),
        format!("brf(view=2, band=2){of_bands}"),
        format!("brf_standard_error(view=2, band=2){of_bands}"),
        format!("radiance(view=2, band=2){of_bands}"),
        format!("radiance_standard_error(view=2, band=2){of_bands}"),
        format!("emitted(view=2, band_emitted=1){emitted}"),
        format!("emitted_standard_error(view=2, band_emitted=1){emitted}"),
        "fapar(layer=1) at bottom top".to_owned(),
        "fapar_standard_error(layer=1) at bottom top".to_owned(),
        "lai()".to_owned(),
        "lai_standard_error()".to_owned(),
    ];
    let mut found = shown(&report);
    found.sort();
    let mut expected = expected.to_vec();
    expected.sort();
    assert_eq!(found, expected);
}

/// Names that would collide with coordinates, with each other or with the rules of the conventions.
#[test]
fn names_are_distinct_and_begin_with_a_letter() {
    let bands = || vec![vec![labels("band", &["red"])]];
    let names = ["band", "brf", "brf_standard_error", "2 ways", "ö"];
    let report = report_of(names.map(|name| table(name, bands())).into());
    let none: Vec<Option<ImageRasters>> = names.iter().map(|_| None).collect();
    let dataset = of_sensor(&of(&report), &plan(&report)[0], none).unwrap();
    let mut names: Vec<&str> = dataset.variables.iter().map(|one| one.name.as_str()).collect();
    let is_lawful = |name: &&str| {
        name.starts_with(|letter: char| letter.is_ascii_alphabetic())
            && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
    };
    assert!(names.iter().all(is_lawful), "{names:?}");
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count, "{names:?}");
}
