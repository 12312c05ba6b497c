//! What the validation tests share: scenes as text, numbers out of reports, z-scores.

pub mod field;
pub mod fuzz;

use std::path::{Path, PathBuf};

use sunfleck::document;
use sunfleck::products::{Product, Report};
use sunfleck::run::{Options, Unwatched, run};

/// The folder of shared data beside the project; `None`, with a note on stderr, where it is absent.
#[must_use]
#[expect(clippy::print_stderr, reason = "a test that skips says so")]
pub fn shared() -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared"));
    if path.is_dir() {
        return Some(path.to_owned());
    }
    eprintln!("skipped: needs the folder `shared` beside the project");
    None
}

/// Runs a scene given as text; paths in it are relative to `folder`.
///
/// # Panics
/// If the scene is wrong: the message is what its author would read.
#[must_use]
pub fn measure(text: &str, folder: &Path, options: &Options) -> Report {
    let reading = match document::read_text("test.ron", text, &options.document) {
        Ok(reading) => reading,
        Err(error) => panic!("{error}"),
    };
    let problems = reading.source.render(&reading.diagnostics);
    assert!(problems.is_empty(), "{problems}");
    match run(&reading.scene, folder, options, &Unwatched) {
        Ok(report) => report,
        Err(failure) => panic!("{}", failure.with_source(&reading.source)),
    }
}

/// Scene text of two leafy trees on a square of 5 m, one of them over its edge, in two bands under sun
/// and sky; `sensors` are those that look at them.
#[must_use]
pub fn two_trees(boundary: &str, sensors: &str) -> String {
    format!(
        r#"Scene(
    format: 1,
    bands: [(name: "a", center_nm: 660.0), (name: "b", center_nm: 865.0)],
    materials: {{
        "soil": Lambertian(reflectance: Bands([0.1, 0.3])),
        "leaf": Leaf(reflectance: Bands([0.05, 0.5]), transmittance: Bands([0.03, 0.45])),
    }},
    meshes: {{ "tree": Crown(
        shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 0.5, leaf_area_m2: 12.0,
        leaf: Square(side_m: 0.1), leaf_material: "leaf",
    ) }},
    terrain: Plane(size_m: (5.0, 5.0), material: "soil"),
    instances: [List(of: "tree", at_m: [(0.2, 2.0, 0.0), (3.0, 4.9, 0.0)])],
    sun: (zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Constant(1.0)),
    sky: Fraction([0.3, 0.1]),
    boundary: {boundary},
    sensors: {{ {sensors} }},
)"#
    )
}

/// What a sheet of leaf over soil does with light in a band: reflectance `r` and transmittance `t` of the leaf,
/// reflectance `s` of the soil.
pub type SheetOptics = (f64, f64, f64);

/// Scene text of horizontal sheets of leaf at these heights over soil, wider than the tile that repeats, in one
/// band for each of these optics; `keys` are the sensors and what else it holds.
#[must_use]
pub fn sheets(optics: &[SheetOptics], heights_m: &[f64], keys: &str) -> String {
    let bands: Vec<_> = (0..optics.len())
        .map(|band| format!(r#"(name: "b{band}", center_nm: {}.0)"#, 400 + band))
        .collect();
    let bands = bands.join(", ");
    let spectrum = |of: fn(&SheetOptics) -> f64| optics.iter().map(of).collect::<Vec<_>>();
    let [r, t, s] = [spectrum(|one| one.0), spectrum(|one| one.1), spectrum(|one| one.2)];
    let at: Vec<_> = heights_m.iter().map(|height| (4.0, 4.0, *height)).collect();
    format!(
        r#"Scene(
    format: 1,
    bands: [{bands}],
    materials: {{
        "soil": Lambertian(reflectance: Bands({s:?})),
        "leaf": Leaf(reflectance: Bands({r:?}), transmittance: Bands({t:?})),
    }},
    meshes: {{ "sheet": Faces(
        faces_m: [[(-10.0, -10.0, 0.0), (10.0, -10.0, 0.0), (10.0, 10.0, 0.0), (-10.0, 10.0, 0.0)]], material: "leaf",
    ) }},
    terrain: Plane(size_m: (8.0, 8.0), material: "soil"),
    instances: [List(of: "sheet", at_m: {at:?})],
    sun: (zenith_deg: 35.0, azimuth_deg: 10.0, irradiance: Constant(1.0)),
    boundary: Periodic,
    {keys}
)"#
    )
}

/// Albedo of so many of these sheets by adding them one by one: `r + t² R / (1 - r R)` over a reflectance `R`.
#[must_use]
pub fn albedo_of_sheets((r, t, s): SheetOptics, count: u32) -> f64 {
    (0..count).fold(s, |below, _| r + t * t * below / (1.0 - r * below))
}

/// A product of a sensor.
///
/// # Panics
/// If the report has none of that name.
#[must_use]
pub fn product<'a>(report: &'a Report, sensor: &str, product: &str) -> &'a Product {
    let sensor = report.sensors.iter().find(|report| report.name == sensor).expect("a sensor");
    sensor.products.iter().find(|p| p.name == product).expect("a product")
}

/// An estimate with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Value.
    pub value: f64,
    /// Standard error.
    pub error: f64,
}

impl Estimate {
    /// Entry of a product's values.
    #[must_use]
    pub fn of(product: &Product, index: usize) -> Self {
        Self { value: product.values[index], error: product.standard_error[index] }
    }

    /// Deviation from a known value in standard errors.
    #[must_use]
    pub fn z(self, truth: f64) -> f64 {
        (self.value - truth) / self.error
    }

    /// Deviation from an independent estimate in standard errors of the difference.
    #[must_use]
    pub fn z_against(self, other: Self) -> f64 {
        (self.value - other.value) / self.error.hypot(other.error)
    }
}
