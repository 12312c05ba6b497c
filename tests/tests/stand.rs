//! The benchmark stand: 700 instances of a tree of 50 024 triangles on 100 m x 100 m.

use sunfleck::run::Options;
use sunfleck_tests::{Estimate, measure, product, shared};

/// Nadir view of the central 50 m x 50 m, isolated, sun at zenith 30° in the west.
fn scene(system: &str, samples: u32) -> String {
    format!(
        r#"Scene(
    format: 1,
    title: "benchmark stand",
    bands: [(name: "nir", center_nm: 865.0, width_nm: 20.0)],
    materials: {{
        "leaf": Leaf(reflectance: Constant(0.4957), transmittance: Constant(0.4409)),
        "bark": Lambertian(reflectance: Constant(0.24)),
        "soil": Lambertian(reflectance: Constant(0.159)),
    }},
    meshes: {{
        "tree": Obj(file: "tree.obj", up: Z, unit_m: 1.0, parts: {{ "leaf": "leaf", "trunk": "bark" }}),
    }},
    terrain: Plane(size_m: (100.0, 100.0), material: "soil"),
    instances: [Table(file: "instances.txt", of: "tree", columns: ["x_m", "y_m", "yaw_rad"])],
    sun: (zenith_deg: 30.0, azimuth_deg: 270.0, irradiance: Constant(1.0)),
    boundary: Isolated,
    sensors: {{
        "nadir": Orthographic(size_px: (128, 128), extent_m: (50.0, 50.0), center_m: (50.0, 50.0),
            samples_per_px: {samples}, system: {system}),
    }},
)"#
    )
}

/// *Scene*: the stand as above. *Expected*: 0.3516, which two independent programs give as 0.35164
/// and (cut at order 16) 0.35146; forward and backward agree.
#[test]
fn both_systems_find_the_nadir_brf_of_the_benchmark_stand() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("data/stand");
    let estimate = |system, samples| {
        let report = measure(&scene(system, samples), &folder, &Options::default());
        Estimate::of(product(&report, "nadir", "brf"), 0)
    };
    let (backward, forward) = (estimate("Backward", 64), estimate("Forward", 64));
    for one in [backward, forward] {
        assert!(one.error > 0.0 && one.error < 0.002, "{one:?}");
        assert!((one.value - 0.3516).abs() < 4.0 * one.error + 0.0002, "{one:?}");
    }
    let z = backward.z_against(forward);
    assert!(z.abs() < 4.0, "backward {backward:?}, forward {forward:?}, z = {z:.2}");
}
