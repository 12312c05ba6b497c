//! Many bands on one path: each is what it would be alone.

use sunfleck::run::Options;
use sunfleck_tests::{Estimate, measure, product};

const BANDS: usize = 301;

/// One number a band, as the scene language writes it.
fn spectrum(of: impl Fn(usize) -> f64) -> String {
    let values: Vec<String> = (0..BANDS).map(|band| format!("{:.4}", of(band))).collect();
    format!("Bands([{}])", values.join(", "))
}

/// *Scene*: two horizontal sheets of leaf (r, t) over soil s, wider than the tile, in 301 bands of which
/// neighbours differ as much as can be: what is decided for all at once looks at groups of them.
/// *Expected*: in each band the albedo by adding layers, `R₁₂ = R₁ + T₁² R₂ / (1 - R₁ R₂)`.
#[test]
fn each_of_many_bands_is_what_sheets_add_up_to() {
    let r = |band: usize| [0.0, 0.9, 0.05, 0.5][band % 4];
    let t = |band: usize| f64::min([0.0, 0.05, 0.9, 0.45][(band / 4) % 4], 0.98 - r(band));
    let s = |band: usize| (80 * band / BANDS) as f64 / 100.0;
    let names: Vec<String> = (0..BANDS)
        .map(|band| format!(r#"(name: "b{band}", center_nm: {}.0)"#, 400 + band))
        .collect();
    let dir = tempfile::tempdir().expect("a temporary folder");
    let sheet = "g sheet\nv -10 -10 0\nv 10 -10 0\nv 10 10 0\nv -10 10 0\nf 1 2 3 4\n";
    std::fs::write(dir.path().join("sheet.obj"), sheet).expect("a file");
    let scene = format!(
        r#"Scene(
    format: 1,
    bands: [{}],
    materials: {{
        "soil": Lambertian(reflectance: {}),
        "leaf": Leaf(reflectance: {}, transmittance: {}),
    }},
    meshes: {{ "sheet": Obj(file: "sheet.obj", up: Z, unit_m: 1.0, material: Some("leaf")) }},
    terrain: Plane(size_m: (8.0, 8.0), material: "soil"),
    instances: [List(of: "sheet", at_m: [(4.0, 4.0, 1.0), (4.0, 4.0, 2.0)])],
    sun: (zenith_deg: 35.0, azimuth_deg: 10.0),
    boundary: Periodic,
    sensors: {{
        "albedo": Photons(per_m2: 4000.0, measure: [Albedo]),
        "paths": Directions(system: Backward, views: List([(20.0, 90.0)]), until: Samples(200000)),
        "packets": Directions(system: Forward, views: List([(20.0, 90.0)]), until: Samples(200000)),
        "image": Orthographic(size_px: (20, 20), cover: WholeScene, samples_per_px: 300, measure: [Brf]),
    }},
)"#,
        names.join(", "),
        spectrum(s),
        spectrum(r),
        spectrum(t),
    );
    let report = measure(&scene, dir.path(), &Options::default());
    for (sensor, name) in
        [("albedo", "albedo"), ("paths", "brf"), ("packets", "brf"), ("image", "brf")]
    {
        for band in 0..BANDS {
            let (r, t, s) = (r(band), t(band), s(band));
            let below = r + t * t * s / (1.0 - r * s);
            let both = r + t * t * below / (1.0 - r * below);
            let one = Estimate::of(product(&report, sensor, name), band);
            // Where nothing is transmitted, all that is left is the rounding of f32. Of 1204 values, of which
            // those of a sensor share their paths, one in 100 such runs goes beyond 4.5.
            let off = (one.value - both).abs();
            let limit = (4.5 * one.error).max(1e-6 * both);
            assert!(off <= limit, "{sensor}, band {band}: {one:?} for {both}");
            assert!(one.error < 0.01 * both.max(0.02), "{sensor}, band {band}: {one:?}");
        }
    }
}
