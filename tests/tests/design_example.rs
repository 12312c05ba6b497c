//! The example scene that the language was designed around, run from text to numbers.

use std::fs;

use sunfleck::run::Options;
use sunfleck_tests::{Estimate, measure, product};

const SCENE: &str = r#"Scene(
    format: 1,
    title: "Birch stand",
    params: { "sza": 30.0 },
    bands: [(name: "red", center_nm: 660.0, width_nm: 10.0), (name: "nir", center_nm: 865.0, width_nm: 20.0)],
    spectra: { "soil": Table(file: "spectra/soil.csv") },
    materials: {
        "soil": Lambertian(reflectance: Named("soil")),
        "leaf": Leaf(reflectance: Bands([0.0546, 0.4957]), transmittance: Bands([0.0149, 0.4409])),
        "bark": Lambertian(reflectance: Bands([0.14, 0.24])),
    },
    meshes: {
        "tree": Obj(file: "assets/tree.obj", up: Z, unit_m: 1.0, parts: { "leaf": "leaf", "trunk": "bark" }),
        "crown": Discs(file: "assets/crown.csv", material: "leaf"),
    },
    terrain: Plane(size_m: (100.0, 100.0), material: "soil"),
    instances: [
        Table(file: "stand.csv", of: "tree"),
        List(of: "crown", at_m: [(20.0, 30.0, 4.0)]),
    ],
    sun: (zenith_deg: "=sza", azimuth_deg: 270.0, irradiance: Bands([1.0, 1.0])),
    sky: Fraction([0.1, 0.05]),
    boundary: Periodic,
    sensors: {
        "nadir": Orthographic(size_px: (64, 64), extent_m: (50.0, 50.0), center_m: (50.0, 50.0), zenith_deg: 0.0, azimuth_deg: 180.0, samples_per_px: 64, measure: [Radiance, Brf]),
        "brf": Directions(views: PrincipalPlane(max_deg: 75.0, step_deg: 5.0), until: RelError(0.005)),
        "flux": Photons(per_m2: 25.0, measure: [BrfCells(150), Albedo, Fapar(layer_m: 1.0), Fluxes(pixel_m: 1.0)]),
    },
    transport: (seed: 1, roulette: (after_order: 5, kill: 0.05), first_order_only: false),
)"#;

/// *Scene*: the example, with a few trees of one leaf and one trunk each.
/// *Expected*: every product that it asks for, with a standard error for every value, and what can be
/// known without tracing: 31 views, 150 cells, the flux that falls on the top.
#[test]
fn the_example_of_the_design_gives_every_product_that_it_asks_for() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| dir.path().join(name);
    fs::create_dir_all(path("assets")).expect("a folder");
    fs::create_dir_all(path("spectra")).expect("a folder");
    fs::write(path("spectra/soil.csv"), "wavelength_nm,value\n400,0.1\n900,0.3\n").expect("a file");
    fs::write(
        path("assets/tree.obj"),
        "g leaf\nv -2 -2 5\nv 2 -2 5\nv 2 2 6\nv -2 2 6\nf 1 2 3 4\n\
         g trunk\nv -.2 0 0\nv .2 0 0\nv .2 0 5\nv -.2 0 5\nf 5 6 7 8\n",
    )
    .expect("a file");
    fs::write(
        path("assets/crown.csv"),
        "radius,x,y,z,nx,ny,nz\n1.5,0,0,0,0,0,1\n0.5,1,0,1,1,0,1\n",
    )
    .expect("a file");
    fs::write(path("stand.csv"), "x_m,y_m,yaw_deg\n10,10,0\n50,52,30\n99.5,0.2,75\n")
        .expect("a file");
    let report = measure(SCENE, dir.path(), &Options::default());

    let expected = [
        ("nadir", "radiance", 2),
        ("nadir", "hdrf", 2),
        ("brf", "hdrf", 31 * 2),
        ("flux", "hdrf_cells", 150 * 2),
        ("flux", "albedo", 2),
        ("flux", "fapar", 6 * 3 * 2),
        ("flux", "downwelling_top", 2),
        ("flux", "upwelling_top", 2),
        ("flux", "downwelling_terrain", 2),
        ("flux", "upwelling_terrain", 2),
        ("flux", "energy", 9 * 2),
    ];
    for (sensor, name, values) in expected {
        let product = product(&report, sensor, name);
        assert_eq!(product.values.len(), values, "{sensor}.{name}");
        assert!(product.values.iter().all(|value| value.is_finite()), "{sensor}.{name}");
        assert!(product.standard_error.iter().all(|error| *error >= 0.0), "{sensor}.{name}");
    }
    let brf = product(&report, "brf", "hdrf");
    let relative = |index| Estimate::of(brf, index).error / Estimate::of(brf, index).value;
    let mut errors: Vec<f64> = (0..brf.values.len()).map(relative).collect();
    errors.sort_by(f64::total_cmp);
    assert!(errors[errors.len() / 2] <= 0.005, "the accuracy that was asked for");
    // SKY_TO_TOTAL divides the irradiance; it does not change its sum on the horizontal plane.
    for band in 0..2 {
        let down = Estimate::of(product(&report, "flux", "downwelling_top"), band);
        let irradiance = 30_f64.to_radians().cos();
        assert!((down.value - irradiance).abs() < 4.0 * down.error, "{down:?}");
    }
    assert_eq!(report.skipped, Vec::<String>::new());
}
