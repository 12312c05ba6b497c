//! Discs that are small enough to be a turbid medium, against an adding-doubling solution.

use std::path::Path;

use sunfleck::run::Options;
use sunfleck_tests::{measure, product, shared};

/// *Scene*: `HOM03_TUR_UNI_NIR_20`: LAI 3 of spherical leaves in a periodic layer of 2 m, as discs of
/// radius 0.01 m. *Expected*: the row of `turbid_flux.csv`, within 0.5 %.
#[test]
fn small_discs_reproduce_the_turbid_layer() {
    let Some(shared) = shared() else { return };
    let table = std::fs::read_to_string(shared.join("reference/turbid_flux.csv")).expect("a table");
    let row: Vec<&str> = table
        .lines()
        .find(|line| line.starts_with("HOM03_TUR_UNI_NIR_20,"))
        .expect("the case")
        .split(',')
        .collect();
    let reference = |column: usize| row[column].parse::<f64>().expect("a number");
    let (albedo, absorbed, transmitted) = (reference(8), reference(9), reference(10));
    let report = measure(
        r#"Scene(
    format: 1,
    bands: [(name: "nir", center_nm: 865.0)],
    materials: {
        "soil": Lambertian(reflectance: Constant(0.159)),
        "leaf": Leaf(reflectance: Constant(0.4957), transmittance: Constant(0.4409)),
    },
    meshes: { "layer": Crown(
        shape: Box(size_m: (4.0, 4.0, 1.98)), base_m: 0.01, leaf_area_m2: 48.0,
        leaf_angle: Spherical, leaf: Disc(radius_m: 0.01), leaf_material: "leaf",
    ) },
    terrain: Plane(size_m: (4.0, 4.0), material: "soil"),
    instances: [List(of: "layer", at_m: [(2.0, 2.0, 0.0)])],
    sun: (zenith_deg: 20.0, azimuth_deg: 30.0),
    boundary: Periodic,
    sensors: { "photons": Photons(per_m2: 60000.0, measure: [Albedo, Fluxes(pixel_m: 1.0)]) },
)"#,
        Path::new("."),
        &Options::default(),
    );
    let energy = product(&report, "photons", "energy");
    // Terms: incident, reflected, lost, roulette, soil, leaf.
    let incident = 20_f64.to_radians().cos();
    let measured = [
        ("albedo", product(&report, "photons", "albedo").values[0], albedo),
        ("absorption", energy.values[5], absorbed),
        (
            "transmission",
            product(&report, "photons", "downwelling_terrain").values[0] / incident,
            transmitted,
        ),
    ];
    for (name, value, expected) in measured {
        assert!((value / expected - 1.0).abs() < 0.005, "{name}: {value}, expected {expected}");
    }
}
