//! Scenes of Eradiate, RAMI and Helios as scenes of sunfleck. The files are made up, from what is documented of the formats.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::{TempDir, tempdir};

/// A triangle of 0.5 m² as PLY.
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 0 1\n3 0 1 2\n";

/// A canopy of a tree of two meshes, placed twice, and of a cloud of leaves.
///
/// Source: Eradiate's documentation, "Canopy scene loader"; both ways to write the unit of wavelengths stand there.
const SCENARIO: &str = r#"{
  "surface": {
    "type": "lambertian",
    "reflectance": {
      "type": "interpolated", "quantity": "reflectance", "wavelengths": [442.95, 865.6],
      "wavelengths_units": "nanometer", "values": [0.88, 0.85]
    }
  },
  "atmosphere": {"type": "homogeneous"},
  "canopy": {
    "type": "discrete_canopy",
    "size": [20.0, 10.0, 5.0],
    "instanced_canopy_elements": [
      {
        "canopy_element": {
          "type": "mesh_tree", "id": "PIMO1",
          "mesh_tree_elements": [
            {"id": "Wood", "mesh_filename": "trees/Wood.ply", "reflectance": 0.3},
            {
              "id": "Needles", "mesh_filename": "trees/Needles.ply", "mesh_units": "centimeter",
              "reflectance": {
                "type": "interpolated",
                "wavelengths": {"values": [0.44295, 0.8656], "units": "micrometer"}, "values": [0.07, 0.45]
              },
              "transmittance": {"type": "uniform", "value": 0.1}
            }
          ]
        },
        "instance_positions": [
          [[0.0, -1.0, 0.0, 5.0], [1.0, 0.0, 0.0, 2.5], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
          [[2.0, 0.0, 0.0, 15.0], [0.0, 2.0, 0.0, 7.5], [0.0, 0.0, 2.0, 0.1], [0.0, 0.0, 0.0, 1.0]],
          [[1.0, 0.5, 0.0, 9.0], [0.0, 1.0, 0.0, 9.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
        ]
      },
      {
        "canopy_element": {"type": "leaf_cloud", "id": "shrub", "filename": "shrub.txt", "leaf_reflectance": 0.4},
        "instance_positions": [[10.0, 5.0, 0.0]]
      },
      {"canopy_element": {"type": "abstract_tree", "id": "pole"}, "instance_positions": [[1.0, 1.0, 0.0]]}
    ]
  }
}"#;

/// Exit code, stdout and stderr.
fn outcome(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let output = command.current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// Imports with these arguments, checks the scene, and returns what was printed and the scene without blanks.
fn imported(folder: &Path, arguments: &[&str]) -> (String, String) {
    let arguments = [&["import"], arguments, &["--out", "out"]].concat();
    let (code, printed, errors) = outcome(folder, &arguments);
    assert_eq!((code, errors.as_str()), (0, ""), "{printed}");
    let (code, _, errors) = outcome(folder, &["check", "out/scene.ron"]);
    assert_eq!(code, 0, "{errors}");
    let scene = fs::read_to_string(folder.join("out/scene.ron")).unwrap();
    let plain = scene.lines().filter(|line| !line.starts_with("//")).collect::<String>();
    (printed, plain.split_whitespace().collect::<String>())
}

/// The error of an import that fails, and leaves nothing behind.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let arguments = [&["import"], arguments, &["--out", "out"]].concat();
    let (code, printed, errors) = outcome(folder, &arguments);
    assert_ne!(code, 0, "{printed}");
    let left: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| !name.to_string_lossy().contains("out")), "{left:?}");
    errors
}

fn scenario() -> TempDir {
    let folder = tempdir().unwrap();
    fs::create_dir_all(folder.path().join("plot/trees")).unwrap();
    for (file, text) in [
        ("scenario.json", SCENARIO),
        ("trees/Wood.ply", PLY),
        ("trees/Needles.ply", PLY),
        ("shrub.txt", "0.05 0 0 0.5 0 0 1\n0.05 0.2 0 0.6 1 0 0\n"),
    ] {
        fs::write(folder.path().join("plot").join(file), text).unwrap();
    }
    folder
}

#[test]
fn a_scenario_of_eradiate_keeps_trees_materials_and_places() {
    let folder = scenario();
    let (printed, scene) = imported(folder.path(), &["plot"]);
    for part in [
        "title:\"plot\"",
        "(name:\"b1_443nm\",center_nm:442.95)",
        "\"ground\":Lambertian(reflectance:Points([(442.95,0.88),(865.6,0.85)]))",
        "\"PIMO1_Wood\":Lambertian(reflectance:Constant(0.3))",
        "\"PIMO1_Needles\":Leaf(",
        "transmittance:Constant(0.1)",
        "(865.6,0.45)",
        "\"shrub\":Lambertian(reflectance:Constant(0.4))",
        "Ply(file:\"assets/PIMO1_Needles.ply\",up:Z,unit_m:0.01,material:\"PIMO1_Needles\"",
        "\"shrub\":Discs(file:\"assets/shrub.def\",material:\"shrub\")",
        "Plane(size_m:(20.0,10.0),material:\"ground\")",
        "boundary:Periodic",
    ] {
        assert!(scene.contains(part), "{part}\n{scene}");
    }
    let places =
        fs::read_to_string(folder.path().join("out/assets/places_places_PIMO1.csv")).unwrap();
    assert_eq!(
        places,
        "x_m,y_m,z_m,yaw_deg,scale,scale_vertical\n5,2.5,0,90,1,1\n15,7.5,0.1,0,2,2\n"
    );
    for (name, why) in [
        ("atmosphere", "has no counterpart"),
        ("canopy.instanced_canopy_elements[2].canopy_element.type", "only `mesh_tree`"),
        ("canopy.instanced_canopy_elements[0].instance_positions", "shear"),
        ("sun", "zenith 30°"),
    ] {
        let is_told =
            printed.lines().any(|line| line.trim().starts_with(name) && line.contains(why));
        assert!(is_told, "{name}: {why}\n{printed}");
    }
    // The file itself means the same as its folder.
    fs::remove_dir_all(folder.path().join("out")).unwrap();
    assert_eq!(imported(folder.path(), &["plot/scenario.json"]).1, scene);
}

#[test]
fn what_is_wrong_with_a_scenario_is_told_with_its_place() {
    let folder = scenario();
    let file = folder.path().join("plot/scenario.json");
    let with = |from: &str, to: &str| {
        assert!(SCENARIO.contains(from), "{from}");
        fs::write(&file, SCENARIO.replace(from, to)).unwrap();
        refused(folder.path(), &["plot"])
    };
    for (from, to, expected) in [
        ("\"size\": [20.0, 10.0, 5.0]", "\"size\": [20.0]", "canopy.size: expected three lengths"),
        ("trees/Wood.ply", "trees/None.ply", "mesh_tree_elements[0]: there is no file"),
        ("trees/Wood.ply", "trees/Wood.stl", "neither a PLY nor an OBJ file"),
        ("[0.88, 0.85]", "[0.88]", "surface.reflectance: 2 wavelengths and 1 value"),
        ("\"nanometer\"", "\"inch\"", "\"inch\" is no unit of wavelengths"),
        ("\"lambertian\"", "\"checkerboard\"", "\"checkerboard\", which has no counterpart"),
        ("\"centimeter\"", "\"inch\"", "write m, cm, mm or km"),
        ("[0.0, -1.0, 0.0, 5.0]", "[0.0, -1.0, 5.0]", "expected four numbers in a row"),
        ("{\n  \"surface\"", "{\n  surface", "is no JSON"),
        ("[0.88, 0.85]", "[1.88, 0.85]", "not sound"),
    ] {
        let errors = with(from, to);
        assert!(errors.contains(expected), "{from}: {errors}");
    }
}

#[test]
fn lists_of_rami_are_discs_at_places() {
    let folder = tempdir().unwrap();
    let lists = folder.path().join("rami");
    fs::create_dir(&lists).unwrap();
    fs::write(lists.join("HET_sphere_leaves.def"), "0.1 0 0 1 0 0 1\n0.1 0.5 0 2 1 0 0\n").unwrap();
    fs::write(lists.join("HET_sphere_centres.def"), "-24.5 11.5 3\n40 -30 4\n").unwrap();
    let errors = refused(folder.path(), &["rami"]);
    assert!(errors.contains("write it, in m: `--size-m 100,100`"), "{errors}");
    let (printed, scene) = imported(folder.path(), &["rami", "--size-m", "100,100"]);
    let mesh =
        "\"HET_sphere_leaves\":Discs(file:\"assets/HET_sphere_leaves.def\",material:\"leaf\")";
    assert!(scene.contains(mesh), "{scene}");
    let places = fs::read_to_string(folder.path().join("out/assets/places_HET_sphere_leaves.csv"));
    assert_eq!(places.unwrap(), "x_m,y_m,z_m\n25.5,61.5,3\n90,20,4\n");
    assert!(printed.contains("RAMI-3's abstract canopies in the near infrared"), "{printed}");
    fs::remove_dir_all(folder.path().join("out")).unwrap();
    fs::write(lists.join("HET_sphere_centres.def"), "1 2 3 4 5\n").unwrap();
    let errors = refused(folder.path(), &["rami", "--size-m", "100,100"]);
    assert!(
        errors.contains("HET_sphere_centres.def:1") && errors.contains("a row of 5 numbers"),
        "{errors}"
    );
}

/// *Scene*: a patch of 2 m x 1 m that stands on its edge, and a triangle of 0.5 m² in the plane z = 3.
#[test]
fn geometry_of_helios_keeps_corners_and_properties() {
    let folder = tempdir().unwrap();
    let xml = r#"<?xml version="1.0"?>
<helios>
   <date><day>1</day></date>
   <patch>
	<UUID>0</UUID><objID>7</objID>
	<data_float label="reflectivity_PAR">0.1</data_float>
	<data_float label="transmissivity_PAR">0.05</data_float>
	<data_float label="temperature">300</data_float>
	<transform>2 0 0 1 0 0 0 2 0 1 0 3 0 0 0 1 </transform>
   </patch>
   <triangle><UUID>1</UUID><transform>1 0 0 0 0 1 0 0 0 0 1 3 0 0 0 1</transform></triangle>
   <voxel><UUID>2</UUID></voxel>
   <tile><objID>7</objID></tile>
   <sphere><objID>9</objID></sphere>
</helios>
"#;
    fs::write(folder.path().join("canopy.xml"), xml).unwrap();
    let (printed, scene) = imported(folder.path(), &["canopy.xml"]);
    let obj = fs::read_to_string(folder.path().join("out/assets/geometry.obj")).unwrap();
    assert_eq!(
        obj,
        "g surface_1\nv 0 2 2.5\nv 2 2 2.5\nv 2 2 3.5\nv 0 2 3.5\nf 1 2 3 4\n\
         g surface_2\nv 0 0 3\nv 0 1 3\nv 1 1 3\nf 5 6 7\n"
    );
    for part in [
        "\"surface_1\":Leaf(reflectance:Bands([0.1]),transmittance:Bands([0.05]))",
        "\"surface_2\":Lambertian(reflectance:Bands([0.0]))",
        "(name:\"PAR\",center_nm:550.0,width_nm:300.0)",
        "boundary:Isolated",
    ] {
        assert!(scene.contains(part), "{part}\n{scene}");
    }
    for (name, why) in [
        ("voxel", "only patches and triangles"),
        ("sphere", "only patches and triangles"),
        ("tile", "stand in the file"),
        ("data", "temperature"),
        ("primitives without properties", "black"),
    ] {
        let is_told =
            printed.lines().any(|line| line.trim().starts_with(name) && line.contains(why));
        assert!(is_told, "{name}: {why}\n{printed}");
    }
    fs::remove_dir_all(folder.path().join("out")).unwrap();
    let whole = xml.len();
    for (text, expected) in [
        (xml.replace("0.05<", "5<"), "transmissivity_PAR is \"5\""),
        (xml.replace("3 0 0 0 1 </tr", "3 0 0 0 </tr"), "has not 16 numbers"),
        (xml[..whole / 2].to_owned(), "byte"),
        ("<helios></helios>".to_owned(), "holds no patch and no triangle"),
    ] {
        fs::write(folder.path().join("canopy.xml"), text).unwrap();
        let errors = refused(folder.path(), &["canopy.xml"]);
        assert!(errors.contains(expected), "{expected}: {errors}");
    }
}

#[test]
fn what_a_path_is_decides_who_reads_it() {
    let folder = scenario();
    fs::write(folder.path().join("plot/leaves.def"), "0.1 0 0 1 0 0 1\n").unwrap();
    let errors = refused(folder.path(), &["plot"]);
    assert!(errors.contains("write `--from eradiate` or `--from rami`"), "{errors}");
    imported(folder.path(), &["plot", "--from", "eradiate"]);
    fs::remove_dir_all(folder.path().join("out")).unwrap();
    fs::write(folder.path().join("notes.txt"), "no scene").unwrap();
    for (path, expected) in
        [("notes.txt", "is no scene that can be imported"), ("none", "cannot read none")]
    {
        let errors = refused(folder.path(), &[path]);
        assert!(errors.contains(expected), "{errors}");
    }
}
