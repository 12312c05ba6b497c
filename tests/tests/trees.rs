//! Trees from public generators, with other people's axes, units and part names.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use sunfleck::run::Options;
use sunfleck_tests::{measure, product, shared};

/// All models of a folder, in the order of their names.
fn models(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|found| found == extension))
        .collect();
    found.sort();
    found
}

/// *Scene*: each model stands alone on grey ground and is seen from 60° in the south.
/// *Expected*: it covers a plausible part of the image: what is seen differs from bare ground in
/// between 2 % and 60 % of the pixels of a frame that is 1.5 times as wide as the model is high.
#[test]
fn every_public_tree_stands_in_its_picture() {
    let Some(shared) = shared() else { return };
    let folder = shared.join("data/trees");
    // Height of the tallest model of each collection, m, with the length of its unit.
    let collections = [
        ("eztree", "obj", "Obj", 0.2, 20.0),
        ("tree3d", "obj", "Obj", 8.0, 9.0),
        ("kenney_glb", "glb", "Gltf", 3.0, 4.0),
    ];
    for (name, extension, reader, unit_m, highest) in collections {
        let models = models(&folder.join(name), extension);
        assert!(!models.is_empty(), "{name} holds models");
        for model in models {
            let file = model.display().to_string();
            let text = scene(&file, reader, unit_m, highest);
            let report = measure(&text, Path::new("/"), &Options::default());
            let image = product(&report, "view", "brf").image.as_ref().expect("an image");
            let image = image.load().expect("pixels can be read");
            let (ground, seen) = (0.5, image.values.len());
            let other = image.values.iter().filter(|&&value| (value - ground).abs() > 0.02).count();
            let share = other as f64 / seen as f64;
            assert!((0.02..0.6).contains(&share), "{file}: {share:.3} of the picture");
        }
    }
}

fn scene(file: &str, reader: &str, unit_m: f64, highest: f64) -> String {
    let mut text = String::new();
    let (ground, frame) = (20.0 * highest, 1.5 * highest);
    write!(
        text,
        r#"Scene(
    format: 1,
    bands: [(name: "grey", center_nm: 660.0)],
    materials: {{
        "soil": Lambertian(reflectance: Constant(0.5)),
        "plant": Leaf(reflectance: Constant(0.1), transmittance: Constant(0.05)),
    }},
    meshes: {{ "tree": {reader}(file: {file:?}, up: Y, unit_m: {unit_m}, material: Some("plant"), origin: BaseCenter) }},
    terrain: Plane(size_m: ({ground:?}, {ground:?}), material: "soil"),
    instances: [List(of: "tree", at_m: [({0:?}, {0:?}, 0.0)])],
    sun: (zenith_deg: 30.0, azimuth_deg: 180.0, irradiance: Constant(1.0)),
    sensors: {{ "view": Orthographic(size_px: (64, 64), extent_m: ({frame:?}, {frame:?}), zenith_deg: 60.0, azimuth_deg: 180.0, samples_per_px: 16) }},
)"#,
        ground / 2.0
    )
    .expect("writing to a String never fails");
    text
}
