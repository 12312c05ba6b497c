//! Tables of stems and trees that were meant otherwise.

use std::fs;

use sunfleck::components::Instance;
use sunfleck::document::{ReadOptions, read_file};
use sunfleck::run::SceneWorld;

use super::words::{FRAME, PLANE, RASTER, raster, scene, tell, told};

/// *Expected*: the header of a table of stems is told as a whole, and degrees are told as such wherever they stand.
#[test]
fn tables_of_stems_in_other_words_are_told_all_of_them() {
    let table = |file: &str| {
        format!("{RASTER} {FRAME} instances: [Table(file: \"{file}\", of: \"pole\")],")
    };
    let degrees = b"x_m,y_m\n-104.305,39.57\n-104.304,39.571\n";
    tell(
        &[
            ("east.csv", b"id,easting,northing\n1,432110,5412310\n"),
            ("half.csv", b"x_m,northing\n432110,5412310\n"),
            ("lon.csv", b"lon,lat\n-104.305,39.57\n"),
            ("long.csv", b"Longitude (deg),Latitude (deg)\n-104.305,39.57\n"),
            ("none.csv", b"id,height_m\n1,2\n"),
            ("degrees.csv", degrees),
        ],
        &[
            (
                &table("east.csv"),
                &[
                    "columns \"x_m\" and \"y_m\" are missing among [\"id\", \"easting\", \"northing\"]",
                    "if \"easting\" and \"northing\" are those in metres, write \"x_m\" and \"y_m\" in their place",
                ],
            ),
            (
                &table("half.csv"),
                &[
                    "column \"y_m\" is missing",
                    "if \"northing\" is that in metres, write \"y_m\" in its place",
                ],
            ),
            (&table("lon.csv"), &["a scene is in metres", "-oo X_POSSIBLE_NAMES=lon"]),
            (&table("long.csv"), &["a scene is in metres"]),
            (&table("none.csv"), &["add them, or list the names"]),
            (
                &table("degrees.csv"),
                &["no row lies on the terrain", "look like longitudes and latitudes", "ogr2ogr"],
            ),
        ],
    );
}

/// *Expected*: stems of a table without heights stand on the ground, with or without georeference, and beside it at height 0.
#[test]
fn stems_without_heights_stand_on_the_ground() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("dem.asc"), raster()).expect("a raster");
    fs::write(folder.path().join("s.csv"), "x_m,y_m\n432110.5,5412310.5\n431900,5412310\n")
        .expect("a table");
    let at = |height: f64, keys: &str| {
        let text = scene(&format!(
            "{RASTER} frame: (origin_m: (432100.0, 5412300.0, {height:?})), \
             instances: [Table(file: \"s.csv\", of: \"pole\", coordinates: Map{keys})],"
        ));
        let file = folder.path().join("scene.ron");
        fs::write(&file, text).expect("a scene");
        let reading = read_file(&file, &ReadOptions::default()).expect("a scene");
        SceneWorld::from_scene(&reading.scene, folder.path()).map(|built| {
            let instances = Instance::in_order(&built.world);
            instances.iter().map(|one| one.placement.position.z).collect::<Vec<_>>()
        })
    };
    assert_eq!(at(410.0, "").expect("a world"), [0.0, 0.0]);
    assert_eq!(at(100.0, "").expect("a world"), [310.0, 0.0]);
    // Where the scene asks for the ground, a place without it is an error.
    assert!(at(410.0, ", on_terrain: true").is_err());
}

#[test]
fn a_tree_that_lies_on_its_side_is_asked_for_its_axis() {
    let meshes = "{ \"tree\": Faces(faces_m: [[(-3.0, 0.0, -0.5), (9.0, 0.0, -0.5), (0.0, 0.0, 0.5)]], material: \"soil\") }";
    let lying =
        scene(&format!("{PLANE} instances: [List(of: \"tree\", at_m: [(5.0, 5.0, 0.0)])],"));
    let start = lying.find("{ \"pole\"").expect("a mesh");
    let end = start + lying[start..].find(" },").expect("its end") + 2;
    let folder = tempfile::tempdir().expect("a folder");
    let found = told(folder.path(), &format!("{}{meshes}{}", &lying[..start], &lying[end..]));
    for part in [
        "1 of `tree` are sunken",
        "reaches from -0.50 to 0.50 m about its origin: is its `up` right?",
    ] {
        assert!(found.contains(part), "{found}");
    }
}
