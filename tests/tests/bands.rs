//! Many bands on one path: each is what it would be alone.

use sunfleck_tests::{Estimate, SceneText, SheetOptics, albedo_of_sheets, product};

const BANDS: usize = 301;

/// *Scene*: two horizontal sheets of leaf (r, t) over soil s, wider than the tile, in 301 bands of which
/// neighbours differ as much as can be: what is decided for all at once looks at groups of them.
/// *Expected*: in each band the albedo by adding layers, `R₁₂ = R₁ + T₁² R₂ / (1 - R₁ R₂)`.
#[test]
fn each_of_many_bands_is_what_sheets_add_up_to() {
    let r = |band: usize| [0.0, 0.9, 0.05, 0.5][band % 4];
    let t = |band: usize| f64::min([0.0, 0.05, 0.9, 0.45][(band / 4) % 4], 0.98 - r(band));
    let s = |band: usize| (80 * band / BANDS) as f64 / 100.0;
    let optics: Vec<SheetOptics> = (0..BANDS).map(|band| (r(band), t(band), s(band))).collect();
    let sensors = r#"
        "albedo": Photons(per_m2: 4000.0, measure: [Albedo]),
        "paths": Directions(system: Backward, views: List([(20.0, 90.0)]), until: Samples(200000)),
        "packets": Directions(system: Forward, views: List([(20.0, 90.0)]), until: Samples(200000)),
        "image": Orthographic(size_px: (20, 20), cover: WholeScene, samples_per_px: 300, measure: [Brf]),
    "#;
    let report = SceneText::sheets(&optics, &[1.0, 2.0]).with("sensors", sensors).measure();
    for (sensor, name) in
        [("albedo", "albedo"), ("paths", "brf"), ("packets", "brf"), ("image", "brf")]
    {
        for (band, &optics) in optics.iter().enumerate() {
            let both = albedo_of_sheets(optics, 2);
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
