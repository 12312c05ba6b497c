//! Exported scenes, read by other programs, against sums over all triangles and discs of the world.
//!
//! Needs a Python with `numpy`, `trimesh`, `plyfile`, `laspy`, `lazrs` and `pyproj` (`python3`, or the one that
//! `SUNFLECK_PYTHON` names), and for the validation of glTF `node` with the package `gltf-validator` (`NODE_PATH`). Without
//! them the comparison is skipped, and says so.

#![allow(clippy::print_stderr, reason = "a skipped test says why")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use glam::{DMat3, DVec3};
use serde_json::Value;
use sunfleck::components::{Instance, Mesh, MeshPart, PrototypeId, SceneId, TerrainPatch};
use sunfleck::export::{ExportError, ExportFormat, ExportSettings, export};
use sunfleck::run::{LoadedScene, Options, Unwatched};
use tempfile::TempDir;

/// Exit code of a script where a module is missing.
const MISSING: i32 = 77;

/// Crowns of discs and slabs, turned, leaning and squeezed, on relief, far from the origin of the map.
const SCENE: &str = r#"Scene(
    format: 1,
    title: "Plot & <two> plates",
    frame: (origin_m: (400000.0, 5600000.0, 0.0), crs: "EPSG:32633"),
    bands: [(name: "red", center_nm: 660.0)],
    materials: {
        "soil": Lambertian(reflectance: Constant(0.2)),
        "leaf": Leaf(reflectance: Points([(400.0, 0.05), (550.0, 0.2), (800.0, 0.1)]), transmittance: Constant(0.05)),
        "bark": Lambertian(reflectance: Constant(0.15)),
    },
    meshes: {
        "crown": Crown(shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 1.0, leaf_area_m2: 1.0,
            leaf: Disc(radius_m: 0.05), leaf_material: "leaf", trunk: Some((height_m: 2.0, diameter_m: 0.2)), wood_material: "bark"),
        "slab": Faces(faces_m: [[(-2.0, -1.0, 3.0), (2.0, -1.0, 3.0), (2.0, 1.0, 3.5), (-2.0, 1.0, 3.5)]], material: "leaf"),
    },
    terrain: Raster(file: "dem.asc", material: "soil"),
    instances: [
        Table(file: "stand.csv", of: "crown", on_terrain: true),
        List(of: "slab", at_m: [(4.0, 5.0, 101.0), (15.0, 12.0, 103.0)], yaw_deg: [30.0, 200.0], scale: [1.5, 0.5]),
    ],
    sun: (zenith_deg: 45.0, azimuth_deg: 90.0),
    sensors: { "top": Orthographic(size_px: (10, 10), extent_m: (10.0, 10.0), center_m: (10.0, 10.0)) },
)"#;

const DEM: &str = "ncols 5\nnrows 4\nxllcorner 400000\nyllcorner 5600000\ncellsize 4\nNODATA_value -9999\n\
    100 101 103 104 104\n100 102 104 105 104\n100 101 102 103 103\n100 100 101 101 102\n";

const STAND: &str = "x_m,y_m,z_m,yaw_deg,tilt_deg,tilt_azimuth_deg,scale,scale_vertical\n\
    3,3,0,0,0,0,1,1\n10,8,0,75,20,130,1.3,0.8\n16,4,0,-40,5,300,0.7,1.4\n";

fn load(edits: &[(&str, &str)]) -> (TempDir, LoadedScene) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut text = SCENE.to_owned();
    for (old, new) in edits {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    let file = folder.path().join("plot.ron");
    for (name, text) in [("plot.ron", &*text), ("dem.asc", DEM), ("stand.csv", STAND)] {
        fs::write(folder.path().join(name), text).expect("a file");
    }
    let loaded = LoadedScene::from_file(&file, &Options::default(), &Unwatched);
    let loaded = loaded.unwrap_or_else(|failure| panic!("{failure}"));
    (folder, loaded)
}

/// Sums over triangles and discs.
#[derive(Debug, Default)]
struct Sums {
    /// Triangles, with discs as polygons of eight sides.
    triangles: u64,
    area: f64,
    /// Sum of areas times places.
    moment: DVec3,
    /// Twice the sum of the vectors of area.
    normal: DVec3,
    low: DVec3,
    high: DVec3,
}

impl Sums {
    fn new() -> Self {
        Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY, ..Self::default() }
    }

    fn mean(&self) -> DVec3 {
        self.moment / self.area
    }

    fn add(&mut self, middle: DVec3, normal: DVec3) {
        let area = 0.5 * normal.length();
        self.area += area;
        self.moment += area * middle;
        self.normal += normal;
    }

    fn see(&mut self, point: DVec3) {
        self.low = self.low.min(point);
        self.high = self.high.max(point);
    }

    fn add_part(&mut self, mesh: &Mesh, part: &MeshPart, linear: DMat3, origin: DVec3) {
        for triangle in part.triangles.clone() {
            let [a, b, c] =
                mesh.corners(triangle as usize).map(|at| origin + linear * at.as_dvec3());
            self.add((a + b + c) / 3.0, (b - a).cross(c - a));
            for corner in [a, b, c] {
                self.see(corner);
            }
            self.triangles += 1;
        }
        for disc in &mesh.discs[part.discs.start as usize..part.discs.end as usize] {
            let normal = disc.normal.as_dvec3();
            let cofactor = linear.determinant() * linear.inverse().transpose();
            let area = std::f64::consts::PI * f64::from(disc.radius).powi(2);
            let center = origin + linear * disc.center.as_dvec3();
            self.add(center, 2.0 * area * (cofactor * normal));
            self.see(center);
            self.triangles += 6;
        }
    }
}

/// Sums over the whole scene, or over its leaves alone.
fn sums(loaded: &LoadedScene, are_leaves: bool) -> Sums {
    let world = &loaded.world.world;
    let mut sums = Sums::new();
    let mut meshes = world.query::<(&SceneId, &Mesh)>();
    let meshes: Vec<(u32, &Mesh)> = meshes.iter().map(|(id, mesh)| (id.0, mesh)).collect();
    for Instance { placement, .. } in Instance::in_order(world) {
        let PrototypeId(prototype) = placement.prototype;
        let mesh = meshes.iter().find(|(id, _)| *id == prototype).expect("its mesh").1;
        for part in &mesh.parts {
            if !are_leaves || part.name != "wood" {
                sums.add_part(mesh, part, placement.world_from_object(), placement.position);
            }
        }
    }
    let mut terrains = world.query::<&TerrainPatch>();
    let patch = terrains.iter().next().expect("a terrain");
    if !are_leaves {
        let linear = DMat3::from_diagonal(patch.size.extend(patch.unit));
        let ground = MeshPart { name: String::new(), triangles: 0..patch.first_cut, discs: 0..0 };
        sums.add_part(&patch.mesh, &ground, linear, patch.origin());
    }
    sums
}

/// JSON that a script prints about a file; `None` if it, or a module, is not there.
fn read(program: &str, variable: Option<&str>, arguments: &[&str], file: &Path) -> Option<Value> {
    let program = variable.and_then(std::env::var_os).unwrap_or_else(|| program.into());
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("readers");
    let mut command = Command::new(&program);
    command.arg(folder.join(arguments[0])).args(&arguments[1..]).arg(file);
    let Ok(run) = command.output() else {
        eprintln!("skipped: there is no {}", program.to_string_lossy());
        return None;
    };
    let [said, wrong] = [&run.stdout, &run.stderr].map(|text| String::from_utf8_lossy(text));
    if run.status.code() == Some(MISSING) {
        eprintln!("skipped: {said}");
        return None;
    }
    assert!(run.status.success(), "{}: {said}{wrong}", file.display());
    Some(serde_json::from_str(&said).unwrap_or_else(|error| panic!("{error}: {said}")))
}

fn python(kind: &str, file: &Path) -> Option<Value> {
    read("python3", Some("SUNFLECK_PYTHON"), &["export.py", kind], file)
}

fn vector(value: &Value) -> DVec3 {
    let number = |axis: usize| value[axis].as_f64().expect("a number");
    DVec3::new(number(0), number(1), number(2))
}

/// Compares what a reader found with sums over the scene: areas to the rounding of `f32`, corners of discs to what their
/// polygons reach beyond their centres.
fn compare(found: &Value, known: &Sums, place: DVec3, what: &str) {
    assert_eq!(found["count"].as_u64(), Some(known.triangles), "{what}: triangles");
    let area = found["area"].as_f64().expect("an area");
    assert!((area / known.area - 1.0).abs() < 1e-5, "{what}: area {area}, known {}", known.area);
    let mean = vector(&found["mean"]) + place;
    assert!(mean.distance(known.mean()) < 1e-4, "{what}: mean {mean}, known {}", known.mean());
    let normal = vector(&found["normal"]);
    assert!(
        normal.distance(known.normal) < 1e-3,
        "{what}: fronts {normal}, known {}",
        known.normal
    );
    let (low, high) = (vector(&found["low"]) + place, vector(&found["high"]) + place);
    assert!((low - known.low).abs().max_element() < 0.1, "{what}: from {low}, known {}", known.low);
    assert!(
        (high - known.high).abs().max_element() < 0.1,
        "{what}: to {high}, known {}",
        known.high
    );
}

fn written(loaded: &LoadedScene, file: &Path, settings: ExportSettings) -> PathBuf {
    let exported =
        export(loaded, file, &settings, &Unwatched).unwrap_or_else(|error| panic!("{error}"));
    exported.files[0].clone()
}

/// *Expected*: numbers of triangles, areas, middles, fronts and bounds are those of the scene, for instances by the extension
/// as by nodes, in one file as in two; the validator of Khronos finds neither errors nor warnings.
#[test]
fn gltf_holds_the_scene() {
    let (folder, loaded) = load(&[]);
    let known = sums(&loaded, false);
    for (name, format, is_flat) in [
        ("a.glb", ExportFormat::Glb, false),
        ("b.glb", ExportFormat::Glb, true),
        ("c.gltf", ExportFormat::Gltf, false),
        ("d.gltf", ExportFormat::Gltf, true),
    ] {
        let settings = ExportSettings { format, is_flat, ..ExportSettings::default() };
        let file = written(&loaded, &folder.path().join(name), settings);
        if let Some(found) = python("gltf", &file) {
            compare(&found, &known, DVec3::ZERO, name);
            assert_eq!(vector(&found["origin"]), DVec3::new(400_000.0, 5_600_000.0, 0.0));
            if is_flat {
                compare(&found["trimesh"], &known, DVec3::ZERO, "trimesh");
            }
        }
        let validated = read("node", None, &["gltf_validator.js"], &file);
        if let Some(report) = validated {
            assert_eq!(report["issues"]["numErrors"], 0, "{report}");
        }
    }
}

/// *Expected*: as of glTF, read by plyfile and trimesh; materials by their numbers.
#[test]
fn ply_holds_all_triangles() {
    let (folder, loaded) = load(&[]);
    let known = sums(&loaded, false);
    let settings = ExportSettings { format: ExportFormat::Ply, ..ExportSettings::default() };
    let file = written(&loaded, &folder.path().join("a.ply"), settings);
    let Some(found) = python("ply", &file) else { return };
    compare(&found, &known, DVec3::ZERO, "plyfile");
    compare(&found["trimesh"], &known, DVec3::ZERO, "trimesh");
    let materials: Vec<u64> = serde_json::from_value(found["materials"].clone()).expect("numbers");
    assert_eq!(materials.iter().sum::<u64>(), known.triangles);
    assert_eq!(materials[1], sums(&loaded, true).triangles, "leaves");
    let comments = found["comments"].to_string();
    assert!(comments.contains("origin_m: 400000.0 5600000.0 0.0"), "{comments}");
}

/// *Expected*: the number of points is density times leaf area; their mean place is that of the leaves within four standard
/// errors of independent points; all else as LAS 1.4 says.
#[test]
fn points_lie_on_leaves_by_area() {
    const DENSITY: f64 = 1000.0;
    let (folder, loaded) = load(&[]);
    let known = sums(&loaded, true);
    for (name, format) in [("a.laz", ExportFormat::Laz), ("b.las", ExportFormat::Las)] {
        let settings =
            ExportSettings { format, points_per_m2: DENSITY, ..ExportSettings::default() };
        let file = written(&loaded, &folder.path().join(name), settings);
        let Some(found) = python("las", &file) else { return };
        let count = (DENSITY * known.area).round();
        assert_eq!(found["count"].as_f64(), Some(count), "{name}: area {}", known.area);
        assert_eq!((&found["version"], &found["format"]), (&"1.4".into(), &7.into()));
        assert_eq!(found["epsg"], 32_633);
        assert_eq!(found["kinds"].to_string(), format!("{{\"1\":{count}}}"));
        let origin = DVec3::new(400_000.0, 5_600_000.0, 0.0);
        let off = (vector(&found["mean"]) - origin - known.mean()).abs();
        let spread = (known.high - known.low) / count.sqrt();
        assert!(off.cmple(4.0 * spread.max(DVec3::splat(1e-3))).all(), "{off} of {spread}");
        for (one, other) in [("low", "header_low"), ("high", "header_high")] {
            assert!(vector(&found[one]).distance(vector(&found[other])) < 2e-3, "{one}");
        }
        assert!((vector(&found["low"]) - origin).cmpge(known.low - 0.1).all());
        assert!((vector(&found["high"]) - origin).cmple(known.high + 0.1).all());
    }
}

/// *Expected*: with all surfaces, points on the ground have class 2 and lie on it, and there are as many as its area says.
#[test]
fn all_surfaces_have_points() {
    let (folder, loaded) = load(&[]);
    let (all, leaves) = (sums(&loaded, false), sums(&loaded, true));
    let settings = ExportSettings {
        format: ExportFormat::Laz,
        points_per_m2: 10.0,
        has_all_surfaces: true,
        ..ExportSettings::default()
    };
    let file = written(&loaded, &folder.path().join("a.laz"), settings);
    let Some(found) = python("las", &file) else { return };
    assert_eq!(found["count"].as_f64(), Some((10.0 * all.area).round()));
    let kind = |kind: &str| found["kinds"][kind].as_f64().expect("a number");
    assert_eq!(found["classes"]["2"].as_f64(), Some(kind("0")), "ground");
    assert!((kind("1") - 10.0 * leaves.area).abs() <= 6.0, "leaves: {}", kind("1"));
    assert!(kind("2") > 0.0, "trunks");
}

/// *Expected*: the same bytes for one thread as for all.
#[test]
fn files_do_not_depend_on_threads() {
    let bytes = |format: ExportFormat, ending: &str| {
        let (folder, loaded) = load(&[]);
        let file = folder.path().join(format!("a.{ending}"));
        let settings = ExportSettings { format, ..ExportSettings::default() };
        // The hash of the scene is that of its files, which are the same.
        fs::read(written(&loaded, &file, settings)).expect("a file")
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    for (format, ending) in
        [(ExportFormat::Glb, "glb"), (ExportFormat::Ply, "ply"), (ExportFormat::Laz, "laz")]
    {
        assert!(pool.install(|| bytes(format, ending)) == bytes(format, ending), "{ending}");
    }
}

/// *Expected*: what is too large is refused with its size and what to do, and leaves nothing behind.
#[test]
fn files_that_are_too_large_are_refused() {
    let (folder, loaded) = load(&[]);
    for (format, ending, help) in [
        (ExportFormat::Ply, "ply", "`--format glb`"),
        (ExportFormat::Laz, "laz", "`--points-per-m2`"),
        (ExportFormat::Glb, "glb", "`--disc-sides`"),
    ] {
        let file = folder.path().join("out").with_extension(ending);
        let settings = ExportSettings { format, limit: 1000, ..ExportSettings::default() };
        let error =
            export(&loaded, &file, &settings, &Unwatched).expect_err("a limit of 1000 bytes");
        assert!(matches!(error, ExportError::TooLarge { .. }), "{error}");
        assert!(error.to_string().contains(help), "{error}");
        assert!(!file.exists());
    }
    let bare =
        [("of: \"slab\"", "of: \"crown\""), ("leaf_material: \"leaf\"", "leaf_material: \"bark\"")];
    let (folder, loaded) = load(&bare);
    let settings = ExportSettings { format: ExportFormat::Laz, ..ExportSettings::default() };
    let error = export(&loaded, &folder.path().join("a.laz"), &settings, &Unwatched)
        .expect_err("no leaves");
    assert!(matches!(error, ExportError::NoLeaves), "{error}");
}
