//! Published files that lie beside the repository.

use std::path::{Path, PathBuf};

use super::*;
use crate::assets::{SpectrumColumns, read_gltf, read_instances, read_obj, read_spectrum};
use crate::document::WavelengthUnit;

fn data(place: &str) -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data")).join(place);
    if path.exists() {
        return Some(path);
    }
    #[allow(clippy::print_stderr, reason = "a test that cannot be made says so")]
    {
        eprintln!("skipped: {} is not there", path.display());
    }
    None
}

/// Every model stands on the ground at a height that its kind can have.
#[test]
fn every_tree_of_the_collection_loads_at_a_plausible_size() {
    for (folder, unit_m, heights, names) in [
        ("trees/eztree", 0.2, 0.5..20.0, &["branches", "leaves"][..]),
        ("trees/tree3d", 10.0, 5.0..15.0, &["diffuse_0"]),
        ("trees/kenney_glb", 1.0, 0.05..3.0, &["colormap"]),
    ] {
        let Some(folder) = data(folder) else { return };
        let import = Import { up: Axis::Y, unit_m, origin: Origin::BaseCenter };
        let mut count = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let loaded = match path.extension().and_then(|extension| extension.to_str()) {
                Some("obj") => read_obj(&path, &import, &PartsBy::Group).unwrap(),
                Some("glb") => read_gltf(&path, &import).unwrap(),
                _ => continue,
            };
            count += 1;
            let mesh = loaded.value;
            assert_lawful(&mesh);
            assert_eq!(part_names(&mesh), names, "{}", path.display());
            let (low, high) = mesh.bounds().unwrap();
            assert_eq!(low.z, 0.0, "{}", path.display());
            assert!(heights.contains(&high.z), "{}: {high}", path.display());
            assert!((high + low).truncate().abs().max_element() < 1e-5 * high.z.max(1.0));
            assert!(high.x > 0.05 * high.z && high.y > 0.05 * high.z, "{}: {high}", path.display());
        }
        assert!(count >= 3, "the folder holds models");
    }
}

/// The standard solar spectrum has a title before its header.
#[test]
fn the_standard_solar_spectrum_is_read_as_it_is_published() {
    let Some(path) = data("solar/ASTMG173.csv") else { return };
    let columns = SpectrumColumns {
        wavelength: Some("wavelength"),
        value: Some("direct"),
        unit: Some(WavelengthUnit::Nanometres),
        ..SpectrumColumns::default()
    };
    let points = read_spectrum(&path, &columns).unwrap().points;
    assert_eq!((points[0].wavelength, points[0].value), (280.0, 2.5361e-26));
    assert_eq!(points.len(), 2002);
}

#[test]
fn the_stand_loads_whole() {
    let Some(folder) = data("stand") else { return };
    let loaded = read_obj(&folder.join("tree.obj"), &AS_IS, &PartsBy::Group).unwrap();
    assert_lawful(&loaded.value);
    assert_eq!(loaded.warnings, [""; 0]);
    assert_eq!(part_names(&loaded.value), ["leaf", "trunk"]);
    assert_eq!(loaded.value.triangles.len(), 50_024);
    let names = ["x_m", "y_m", "yaw_rad"].map(str::to_owned);
    let rows = read_instances(&folder.join("instances.txt"), Some(&names)).unwrap().rows;
    assert_eq!(rows.len(), 700);
    assert_eq!(rows[0].yaw, 0.081_970_516);
}
