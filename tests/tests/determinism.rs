//! Results depend on the scene and its seed and on nothing else.

use std::path::Path;

use sunfleck::products::Report;
use sunfleck::run::Options;
use sunfleck_tests::measure;

const SCENE: &str = r#"Scene(
    format: 1,
    bands: [(name: "a", center_nm: 660.0), (name: "b", center_nm: 865.0)],
    materials: {
        "soil": Lambertian(reflectance: Bands([0.1, 0.3])),
        "leaf": Leaf(reflectance: Bands([0.05, 0.5]), transmittance: Bands([0.03, 0.45])),
    },
    meshes: { "tree": Crown(
        shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 0.5, leaf_area_m2: 12.0,
        leaf: Rhombus(length_m: 0.1, width_m: 0.07), leaf_material: "leaf",
    ) },
    terrain: Plane(size_m: (5.0, 5.0), material: "soil"),
    instances: [List(of: "tree", at_m: [(0.2, 2.0, 0.0), (3.0, 4.9, 0.0)], yaw_deg: [10.0, 77.0])],
    sun: (zenith_deg: 50.0, azimuth_deg: 10.0),
    sky: Fraction([0.3, 0.1]),
    boundary: Periodic,
    sensors: {
        "image": Orthographic(size_px: (40, 33), extent_m: (5.0, 5.0), zenith_deg: 20.0, samples_per_px: 17),
        "back": Directions(system: Backward, views: PrincipalPlane(max_deg: 60.0, step_deg: 20.0), until: RelError(0.02)),
        "forth": Directions(views: PrincipalPlane(max_deg: 60.0, step_deg: 20.0), until: RelError(0.02), system: Forward),
        "photons": Photons(per_m2: 5000.0, measure: [Albedo, BrfCells(40), Fapar(layer_m: 0.7), Fluxes(pixel_m: 0.5)]),
        "whole": Photons(per_m2: 500.0, measure: [Albedo, BrfCells(40), Absorbed(per: Triangle)], system: Analog),
        "once": Orthographic(size_px: (40, 33), extent_m: (5.0, 5.0), samples_per_px: 17, measure: [Orders], system: FirstOrder),
    },
)"#;

/// All numbers of a report, as bits.
fn bits(report: &Report) -> Vec<u64> {
    let products = report.sensors.iter().flat_map(|sensor| &sensor.products);
    products
        .flat_map(|product| {
            let numbers = product.values.iter().chain(&product.standard_error);
            let pixels = product.image.iter().flat_map(|image| {
                image.values.iter().chain(&image.standard_error).map(|v| u64::from(v.to_bits()))
            });
            numbers.map(|v| v.to_bits()).chain(pixels).collect::<Vec<_>>()
        })
        .collect()
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        bits(&pool.install(|| measure(SCENE, Path::new("."), &Options::default())))
    };
    let one = with(1);
    assert!(one.len() > 1000);
    assert!(one == with(2), "2 threads differ from 1");
    assert!(one == with(7), "7 threads differ from 1");
}

#[test]
fn another_seed_is_another_estimate() {
    let other = SCENE.replace("sensors: {", "transport: (seed: 2), sensors: {");
    let one = bits(&measure(SCENE, Path::new("."), &Options::default()));
    assert!(one != bits(&measure(&other, Path::new("."), &Options::default())));
}

/// *Scene*: the same with the anchor at a UTM position. *Expected*: the same bits.
#[test]
fn the_anchor_changes_no_result() {
    let anchored =
        SCENE.replace("bands: [", "frame: (origin_m: (500000.0, 5500000.0, 300.0)), bands: [");
    let one = bits(&measure(SCENE, Path::new("."), &Options::default()));
    assert!(one == bits(&measure(&anchored, Path::new("."), &Options::default())));
}

/// *Scene*: the same with one more sensor and one more definition before all others.
/// *Expected*: the other sensors give the same bits, because streams are keyed by name.
#[test]
fn another_sensor_changes_no_result() {
    let more = SCENE
        .replace("sensors: {", "sensors: { \"first\": Photons(per_m2: 10.0, measure: [Albedo]),");
    let one = bits(&measure(SCENE, Path::new("."), &Options::default()));
    let report = measure(&more, Path::new("."), &Options::default());
    let others = Report { sensors: report.sensors[1..].to_vec(), ..report };
    assert!(one == bits(&others));
}
