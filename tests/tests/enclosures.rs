//! Exchange of emitted light between surfaces: view factors and cavities, against closed forms.

use std::f64::consts::PI;
use std::fmt::Write as _;

use sunfleck::products::Report;
use sunfleck::spectral::planck;
use sunfleck_tests::{Estimate, SceneText, product};

/// Wavelengths of the bands, nm.
const BANDS: [f64; 3] = [10_000.0, 10_500.0, 11_000.0];

/// A scene of three bands on a black, cold terrain, above it the meshes written as OBJ text or as lines of discs.
fn run(
    terrain: &str,
    materials: &str,
    meshes: &[(&str, &str, &str)],
    instances: &str,
    sensors: &str,
) -> Report {
    let [a, b, c] = BANDS;
    let mut scene = SceneText::default()
        .with("bands", format!(r#"(name: "a", center_nm: {a:?}), (name: "b", center_nm: {b:?}), (name: "c", center_nm: {c:?})"#))
        .with("materials", format!(r#"
        "cold": Lambertian(reflectance: Constant(0.0), temperature: Uniform(0.0)),
        "hot": Lambertian(reflectance: Constant(0.0), temperature: Uniform(300.0)),
        {materials}"#))
        .with("terrain", format!(r#"Plane({terrain}, material: "cold")"#))
        .with("instances", instances)
        .with("sensors", sensors);
    for (name, material, text) in meshes {
        let add = if text.starts_with('g') { SceneText::with_obj } else { SceneText::with_discs };
        scene = add(scene, name, material, text);
    }
    scene.measure()
}

const UNIT: &str = "g a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
const WALL: &str = "g a\nv 0 0 0\nv 0 1 0\nv 0 1 1\nv 0 0 1\nf 1 2 3 4\n";
const HALF: &str = "g a\nv 0 0 0\nv 1 0 0\nv 1 0.5 0\nv 0 0.5 0\nf 1 2 3 4\n";

/// *Scene*: a hot black surface below a cold plate that sends all it receives from below upwards, as a
/// Lambertian one does. *Expected*: from above the plate has the radiance `F₁₂ A₁ B / A`, with `F₁₂` the
/// share of what the hot surface emits that falls on the plate, and `A` the area that is seen.
///
/// Source of the factors: J. R. Howell, "A catalog of radiation configuration factors", C-11, C-14, C-41.
#[test]
fn plates_and_discs_exchange_by_their_view_factors() {
    let small = "0.2,0.5,0.5,0,0,0,1\n";
    let large = "0.5,0.5,0.5,0,0,0,1\n";
    let square = "size_m: (1.0, 1.0)";
    for (name, terrain, one, two, height, share, factor) in [
        ("parallel squares", square, UNIT, UNIT, 1.0, 1.0, 0.199_824_9),
        ("squares with a common edge", square, WALL, UNIT, 1.0, 1.0, 0.200_043_8),
        // 1 by 2 at a distance of 0.5, at half the size.
        ("parallel rectangles", "size_m: (1.0, 0.5)", HALF, HALF, 0.25, 1.0, 0.508_988_7),
        // The factor of the small disc, which is A₂ F₂₁ / A₁; beside it the large one is seen itself.
        (
            "coaxial discs",
            "size_m: (0.4, 0.4), corner_m: (0.3, 0.3)",
            large,
            small,
            0.5,
            0.25 * PI,
            0.480_031_9,
        ),
    ] {
        let black = planck(10_000.0, 300.0);
        let exchanged = factor * share * black;
        let truth = exchanged + (1.0 - share) * black;
        let wanted = 0.00099 * exchanged / truth;
        let report = run(
            terrain,
            "\"glass\": Leaf(reflectance: Constant(0.0), transmittance: Constant(1.0), temperature: Uniform(0.0)),",
            &[("one", "hot", one), ("two", "glass", two)],
            &format!(
                "List(of: \"one\", at_m: [(0.0, 0.0, 0.1)]), \
                 List(of: \"two\", at_m: [(0.0, 0.0, {:?})])",
                0.1 + height
            ),
            &format!(
                "\"nadir\": Directions(system: Backward, views: List([(0.0, 0.0)]), until: RelError({wanted:?}), measure: [Radiance])"
            ),
        );
        let found = Estimate::of(product(&report, "nadir", "radiance"), 0);
        assert!(found.z(truth).abs() < 4.0, "{name}: {found:?} for {truth}");
        assert!(found.error < 1e-3 * exchanged, "{name}: {found:?} for {truth}");
    }
}

/// *Scene*: a closed box of six walls at 300 K, with emissivities from 0.05 to 0.95 in three bands.
/// *Expected*: every pixel of a camera in it is a black body of 300 K.
#[test]
fn an_isothermal_cavity_is_black_whatever_its_walls() {
    let materials: String = [
        ("a", "0.05, 0.9, 0.8"),
        ("b", "0.5, 0.1, 0.8"),
        ("c", "0.95, 0.3, 0.8"),
    ]
    .map(|(name, rho)| {
        format!("\"{name}\": Lambertian(reflectance: Bands([{rho}]), temperature: Uniform(300.0)),")
    })
    .concat();
    let pair = |axis: usize| {
        let mut text = "g a\n".to_owned();
        for at in ["0", "1"] {
            for (u, v) in [("0", "0"), ("1", "0"), ("1", "1"), ("0", "1")] {
                let mut corner = vec![u, v];
                corner.insert(axis, at);
                writeln!(text, "v {}", corner.join(" ")).expect("a string");
            }
        }
        text + "f 1 2 3 4\nf 5 6 7 8\n"
    };
    let [x, y, z] = [0, 1, 2].map(pair);
    let box_at = "at_m: [(0.0, 0.0, 0.5)]";
    let report = run(
        "size_m: (1.0, 1.0)",
        &materials,
        &[("x", "a", &x), ("y", "b", &y), ("z", "c", &z)],
        &format!("List(of: \"x\", {box_at}), List(of: \"y\", {box_at}), List(of: \"z\", {box_at})"),
        "\"all\": Fisheye(size_px: (8, 8), position_m: (0.3, 0.4, 0.8), fov_deg: 340.0, samples_per_px: 4096, measure: [Radiance, BrightnessTemperature])",
    );
    for (band, nm) in BANDS.into_iter().enumerate() {
        let truth = planck(nm, 300.0);
        let mean = Estimate::of(product(&report, "all", "radiance"), band);
        let off = (mean.value - truth).abs();
        assert!(off < 4.0 * mean.error + 1e-6 * truth, "{nm}: {mean:?} for {truth}");
        assert!(mean.error < 1e-3 * truth, "{nm}: {mean:?} for {truth}");
    }
    let image = product(&report, "all", "brightness_temperature").image.as_ref().expect("pixels");
    let image = image.load().expect("pixels can be read");
    for (kelvin, error) in image.values.iter().zip(&image.standard_error) {
        // 52 pixels in three bands with 31 degrees of freedom: one in 300 such images has |t| > 5.
        let is_black = (kelvin - 300.0).abs() < 5.0 * error + 1e-3;
        assert!(kelvin.is_nan() || is_black, "{kelvin} +- {error}");
    }
}
