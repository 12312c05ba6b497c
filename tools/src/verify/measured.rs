//! Scenes as text, and numbers out of their reports.

use std::path::Path;

use anyhow::{Context as _, bail};
use sunfleck::products::{Product, Report, SensorReport};
use sunfleck::{document, run};

/// Bands of scenes whose surfaces are the same in all.
pub(super) const RED_AND_NIR: &str =
    r#"bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0)],"#;

/// Three thermal bands, and their wavelengths, nm.
pub(super) const THERMAL: &str = r#"bands: [
    (name: "a", center_nm: 10000.0), (name: "b", center_nm: 10500.0), (name: "c", center_nm: 11000.0),
],"#;
pub(super) const THERMAL_NM: [f64; 3] = [10_000.0, 10_500.0, 11_000.0];

/// Runs a scene of these keys, which may name no file.
pub(super) fn measure(keys: &str) -> anyhow::Result<Report> {
    let text = format!("Scene(\nformat: 1,\n{keys}\n)");
    let reading = document::read_text("verify.ron", &text, &document::ReadOptions::default())?;
    if !reading.is_sound() {
        bail!(reading.render());
    }
    run(&reading.scene, Path::new(""), &run::Options::default(), &run::Unwatched)
        .map_err(|failure| failure.with_source(&reading.source).into())
}

/// A value with its standard error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    pub(super) value: f64,
    pub(super) error: f64,
}

impl Estimate {
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { value: factor * self.value, error: factor * self.error }
    }

    /// The ratio to an independent one.
    pub(super) fn over(self, other: Self) -> Self {
        let value = self.value / other.value;
        let relative = (self.error / self.value).hypot(other.error / other.value);
        Self { value, error: value * relative }
    }

    /// Mean of independent values of one quantity.
    pub(super) fn from_repeats(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let value = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|one| (one - value).powi(2)).sum();
        Self { value, error: (squares / (count - 1.0) / count).sqrt() }
    }
}

/// A product of a sensor.
pub(super) fn product<'a>(
    report: &'a Report,
    sensor: &str,
    name: &str,
) -> anyhow::Result<&'a Product> {
    let found = report.sensors.iter().find(|one| one.name == sensor);
    let products = &found.with_context(|| format!("no sensor `{sensor}`"))?.products;
    products.iter().find(|one| one.name == name).with_context(|| format!("no product `{name}`"))
}

/// One of its values.
pub(super) fn value(
    report: &Report,
    sensor: &str,
    name: &str,
    index: usize,
) -> anyhow::Result<Estimate> {
    let product = product(report, sensor, name)?;
    let value = product.values.get(index).copied();
    let value = value.with_context(|| format!("`{name}` has no value {index}"))?;
    Ok(Estimate { value, error: product.standard_error[index] })
}

/// All numbers of a report, as bits.
pub(super) fn bits(report: &Report) -> std::io::Result<Vec<u64>> {
    let all: std::io::Result<Vec<_>> = report.sensors.iter().map(SensorReport::bits).collect();
    all.map(|all| all.concat())
}

/// Number of values that differ between two reports.
pub(super) fn differing(one: &[u64], other: &[u64]) -> f64 {
    let differ = one.iter().zip(other).filter(|(a, b)| a != b).count();
    (differ + one.len().abs_diff(other.len())) as f64
}

/// A small forest that uses most of what a scene can have; `place` is where its corner is, m.
pub(super) fn forest(place: (f64, f64), sensors: &str) -> String {
    let (x, y) = place;
    format!(
        r#"{RED_AND_NIR}
        materials: {{
            "soil": Lambertian(reflectance: Bands([0.1, 0.3])),
            "bark": Lambertian(reflectance: Bands([0.2, 0.4])),
            "leaf": Leaf(reflectance: Bands([0.05, 0.5]), transmittance: Bands([0.03, 0.45])),
        }},
        meshes: {{
            "oak": Crown(
                shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 0.7, leaf_area_m2: 9.0,
                leaf: Rhombus(length_m: 0.12, width_m: 0.08), leaf_material: "leaf",
                trunk: (height_m: 3.0, diameter_m: 0.3), wood_material: "bark",
            ),
            "bush": Crown(
                shape: HalfEllipsoid(diameter_m: 1.5, height_m: 1.0), base_m: 0.1, leaf_area_m2: 3.0,
                leaf: Disc(radius_m: 0.05), leaf_angle: Planophile, leaf_material: "leaf",
            ),
            "wall": Faces(
                faces_m: [[(0.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.5, 2.0, 1.5), (0.5, 0.0, 1.5)]],
                material: "bark",
            ),
        }},
        terrain: Plane(size_m: (5.0, 4.0), corner_m: ({x:?}, {y:?}), material: "soil"),
        instances: [
            List(of: "oak", at_m: [({:?}, {:?}, 0.0), ({:?}, {:?}, 0.0)], yaw_deg: [10.0, 77.0]),
            List(of: "bush", at_m: [({:?}, {:?}, 0.0)], scale: [1.25]),
            List(of: "wall", at_m: [({:?}, {:?}, 0.0)]),
        ],
        boundary: Periodic,
        {sensors}"#,
        x + 0.25,
        y + 2.0,
        x + 3.0,
        y + 3.75,
        x + 1.5,
        y + 0.5,
        x + 4.0,
        y + 1.0,
    )
}
