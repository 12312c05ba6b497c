//! Messages that name what mends a scene: coordinates of the map and of the local frame, formats of files,
//! classes.

use std::fs;
use std::path::Path;

use sunfleck::document::{ReadOptions, read_file};
use sunfleck::run::SceneWorld;

/// Heights of 10 x 8 cells of 10 m, whose corner lies at (432100, 5412300), 410 m high.
pub(super) fn raster() -> String {
    let row = "410 ".repeat(10);
    let rows = format!("{row}\n").repeat(8);
    format!("ncols 10\nnrows 8\nxllcorner 432100\nyllcorner 5412300\ncellsize 10\n{rows}")
}

/// A scene with these entries and these keys.
pub(super) fn scene(entries: &str) -> String {
    format!(
        r#"Scene(
            format: 1,
            bands: [(name: "red", center_nm: 660.0, width_nm: 10.0)],
            materials: {{ "soil": Lambertian(reflectance: Constant(0.2)) }},
            meshes: {{ "pole": Faces(faces_m: [[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 9.0)]], material: "soil") }},
            sun: (zenith_deg: 30.0, azimuth_deg: 180.0),
            boundary: Isolated,
            sensors: {{ "view": Orthographic(size_px: (2, 2), extent_m: (2.0, 2.0)) }},
            {entries}
        )"#
    )
}

pub(super) const PLANE: &str = "terrain: Plane(size_m: (20.0, 20.0), material: \"soil\"),";
pub(super) const RASTER: &str = "terrain: Raster(file: \"dem.asc\", material: \"soil\"),";
pub(super) const FRAME: &str = "frame: (origin_m: (432100.0, 5412300.0, 410.0)),";

/// Errors, warnings and notes of a scene beside some files.
pub(super) fn told(folder: &Path, text: &str) -> String {
    let file = folder.join("scene.ron");
    fs::write(&file, text).expect("a scene");
    let reading =
        read_file(&file, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    if !reading.is_sound() {
        return reading.render();
    }
    match SceneWorld::from_scene(&reading.scene, folder) {
        Ok(built) => reading.source.render(&built.diagnostics()) + &notes(&built),
        Err(problems) => reading.source.render(&problems),
    }
}

fn notes(built: &SceneWorld) -> String {
    built.resources.messages.notes().cloned().collect::<Vec<_>>().join("\n")
}

/// Scenes in which each is told all of some texts.
pub(super) fn tell(files: &[(&str, &[u8])], cases: &[(&str, &[&str])]) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("dem.asc"), raster()).expect("a raster");
    for (name, content) in files {
        fs::write(folder.path().join(name), content).expect("a file");
    }
    for (entries, parts) in cases {
        let found = told(folder.path(), &scene(entries));
        for part in *parts {
            match part.strip_prefix('!') {
                Some(absent) => {
                    assert!(!found.contains(absent), "{entries} says {absent:?}:\n{found}");
                }
                None => assert!(found.contains(part), "{entries} does not say {part:?}:\n{found}"),
            }
        }
    }
}

#[test]
fn places_of_a_list_in_coordinates_of_the_map_are_told_as_local_ones() {
    let list = |at: &str| format!("instances: [List(of: \"pole\", at_m: [{at}])],");
    let map = list("(432110.0, 5412310.0, 412.0)");
    let local = list("(10.0, 10.0, 0.0)");
    let on_terrain =
        "instances: [List(of: \"pole\", at_m: [(432110.0, 5412310.0, 0.0)], on_terrain: true)],";
    tell(
        &[],
        &[
            (
                &format!("{PLANE} {map}"),
                &["origin_m: (432100.0, 5412300.0, 412.0)", "(10.0, 10.0, 0.0)", "at_m[0]"],
            ),
            (&format!("{PLANE} {FRAME} {map}"), &["write (10.0, 10.0, 2.0)", "`List` are local"]),
            (&format!("{RASTER} {FRAME} {map}"), &["write (10.0, 10.0, 2.0)"]),
            (
                &format!("{RASTER} {FRAME} {on_terrain}"),
                &["no terrain below", "write (10.0, 10.0, 0.0)"],
            ),
            // Followed, nothing is wrong.
            (&format!("{PLANE} {FRAME} {local}"), &["!error", "!warning"]),
            // The raster lies on the map, and nothing says so.
            (
                &format!("{RASTER} {local}"),
                &["write `frame: (origin_m: (432100.0, 5412300.0, 410.0))`"],
            ),
            (&format!("{RASTER} {FRAME} {local}"), &["!error", "!warning"]),
            (
                &format!("{RASTER} frame: (origin_m: (-432090.0, -5412290.0, 0.0)), {local}"),
                &["write `frame: (origin_m: (432100.0, 5412300.0, 410.0))`"],
            ),
        ],
    );
}

#[test]
fn tables_that_were_meant_otherwise_are_told_the_key() {
    let stems = b"x_m,y_m\n432110.91,5412310.52\n432120.0,5412320.0\n";
    // With heights, which are those of the map.
    let high = b"x_m,y_m,z_m\n432110.91,5412310.52,0\n432120.0,5412320.0,0\n";
    let table = |keys: &str| format!("instances: [Table(file: \"s.csv\", of: \"pole\"{keys})],");
    tell(
        &[("s.csv", stems), ("high.csv", high)],
        &[
            (
                &format!(
                    "{RASTER} frame: (origin_m: (432100.0, 5412300.0, 0.0)), {}",
                    table("").replace("s.csv", "high.csv")
                ),
                &["2 of `pole` are sunken", "at (10.91, 10.52)", "write `on_terrain: true`"],
            ),
            (
                &format!("{RASTER} {FRAME} {}", table(", coordinates: Local, on_terrain: true")),
                &["2 of 2 places", "write `coordinates: Map`", "(432110.91, 5412310.52)"],
            ),
            (
                &format!("{RASTER} {FRAME} {}", table(", coordinates: Local")),
                &["write `coordinates: Map`"],
            ),
            // A tree that is too deep in the ground for `on_terrain` to help is not advised so.
            (
                &format!("{PLANE} instances: [List(of: \"pole\", at_m: [(5.0, 5.0, -30.0)])],"),
                &["sunken", "!on_terrain"],
            ),
        ],
    );
}

#[test]
fn areas_beside_the_terrain_are_told_what_puts_them_on_it() {
    let scatter = |area: &str| {
        format!(
            "instances: [Scatter(of: {{ \"pole\": 1.0 }}, rule: Uniform, stems: Count(3), inside: [{area}])],"
        )
    };
    let corners = "(432110.0, 5412310.0), (432150.0, 5412310.0), (432150.0, 5412350.0)";
    let polygon = scatter(&format!("Polygon(outline_m: [{corners}])"));
    let table = scatter("Table(file: \"corners.csv\")");
    let degrees = scatter("GeoJson(file: \"degrees.geojson\")");
    let zone = scatter("GeoJson(file: \"zone.geojson\")");
    let square = |x: f64, y: f64, size: f64, crs: &str| {
        let (east, north) = (x + size, y + size);
        format!(
            r#"{{"type": "Polygon", {crs}"coordinates": [[[{x}, {y}], [{east}, {y}], [{east}, {north}], [{x}, {y}]]]}}"#
        )
    };
    let crs = r#""crs": {"type": "name", "properties": {"name": "EPSG:32633"}}, "#;
    let frame = "frame: (origin_m: (432100.0, 5412300.0, 410.0), crs: \"EPSG:32632\"),";
    tell(
        &[
            ("corners.csv", b"x_m,y_m\n432110,5412310\n432150,5412310\n432150,5412350\n"),
            ("degrees.geojson", square(8.08, 48.86, 0.001, "").as_bytes()),
            ("south.geojson", square(-60.0, -3.0, 0.001, "").as_bytes()),
            ("zone.geojson", square(432_110.0, 5_412_310.0, 40.0, crs).as_bytes()),
        ],
        &[
            (
                &format!("{RASTER} {FRAME} {polygon}"),
                &["corners of a `Polygon` are local", "(10.0, 10.0)", "!georeferenced"],
            ),
            (&format!("{RASTER} {FRAME} {table}"), &["write `georeferenced: true`"]),
            (
                &format!("{RASTER} {frame} {degrees}"),
                &["EPSG:32632", "that of `frame.crs`", "!32633"],
            ),
            (&format!("{RASTER} {FRAME} {degrees}"), &["EPSG:32632", "UTM zone 32 north"]),
            (
                &format!("{RASTER} {FRAME} {}", scatter("GeoJson(file: \"south.geojson\")")),
                &["EPSG:32721"],
            ),
            (&format!("{RASTER} {frame} {zone}"), &["`ogr2ogr -a_srs EPSG:32632", "!gdal_edit"]),
        ],
    );
}

#[test]
fn files_of_other_formats_are_called_by_their_names() {
    let stems = |file: &str| format!("{PLANE} instances: [Table(file: \"{file}\", of: \"pole\")],");
    let area = |area: &str| {
        format!(
            "{PLANE} instances: [Scatter(of: {{ \"pole\": 1.0 }}, rule: Uniform, stems: Count(3), inside: [{area}])],"
        )
    };
    let raster = |file: &str| format!("terrain: Raster(file: \"{file}\", material: \"soil\"),");
    tell(
        &[
            ("plot.shp", b"\x00\x00\x27\x0a\0\0\0\0"),
            ("trees.xlsx", b"PK\x03\x04\x14\0\x06\0"),
            ("trees.dbf", b"\x03\x7a\x05\x01\x02\0\0\0"),
            (
                "plot.kml",
                b"<?xml version=\"1.0\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\">",
            ),
            ("plot.gpkg", b"SQLite format 3\0"),
            ("points.laz", b"LASF\0\0\0\0"),
            ("plot.csv", b"x_m,y_m\n1,1\n9,1\n9,9\n"),
        ],
        &[
            (
                &area("GeoJson(file: \"plot.shp\")"),
                &["an Esri shapefile", "ogr2ogr polygons.geojson plot.shp"],
            ),
            (&area("GeoJson(file: \"plot.kml\")"), &["a KML file", "ogr2ogr"]),
            (&area("Table(file: \"plot.gpkg\")"), &["GeoPackage", "ogr2ogr"]),
            (
                &area("GeoJson(file: \"plot.csv\")"),
                &["write `Table(file: ..)` in place of `GeoJson`"],
            ),
            (&stems("trees.xlsx"), &["an Excel workbook", "as CSV", "!UTF-16"]),
            (&stems("trees.dbf"), &["a dBASE table", "ogr2ogr -f CSV"]),
            (&stems("points.laz"), &["point cloud", "CSV"]),
            (&raster("points.laz"), &["point cloud", "make a raster"]),
            (&raster("plot.shp"), &["an Esri shapefile", "gdal_rasterize"]),
        ],
    );
}

#[test]
fn all_classes_without_a_material_are_one_error() {
    let heights = raster().replacen("410 410", "410.52899169921875 411.25", 1);
    let mut classes = raster().replace("410", "1");
    for class in 2..20 {
        classes = classes.replacen(" 1 ", &format!(" {class} "), 1);
    }
    let land = |file: &str| {
        format!(
            "terrain: Raster(file: \"dem.asc\", land_cover: (file: \"{file}\", classes: {{ \"1\": \"soil\" }})),"
        )
    };
    let folder: &[(&str, &[u8])] =
        &[("heights.asc", heights.as_bytes()), ("classes.asc", classes.as_bytes())];
    tell(
        folder,
        &[
            (
                &land("heights.asc"),
                &["classes have no material: 410, 410.529", "a raster of heights"],
            ),
            (
                &land("classes.asc"),
                &[
                    "18 classes have no material: 2, 3, 4, 5, 6, 7, 8, 9 and 10 more",
                    "\"2\": \"..\"",
                ],
            ),
        ],
    );
}

#[test]
fn a_wrong_column_is_not_mended_by_that_of_the_wavelengths() {
    let spectrum = b"wl,R\n400,0.1\n900,0.2\n";
    let scene = scene(PLANE).replace(
        "Constant(0.2)",
        "Table(file: \"s.csv\", wavelength: \"wl\", wavelength_unit: Nanometres, value: \"Q\")",
    );
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("s.csv"), spectrum).expect("a table");
    let found = told(folder.path(), &scene);
    assert!(found.contains("write `value: \"R\"`"), "{found}");
}

/// *Expected*: the reference of a sweep over leaf area is bare ground, and a name in a key that is none is
/// underlined at the key.
#[test]
fn a_crown_without_leaves_and_names_in_keys() {
    let crown = |area: &str, of: &str| {
        scene(&format!(
            "{PLANE} instances: [Scatter(of: {{ \"{of}\": 1.0 }}, rule: Uniform, stems: Count(3))],"
        ))
        .replace(
            "meshes: {",
            &format!(
                "meshes: {{ \"crown\": Crown(shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 1.0, \
                 leaf_area_m2: {area}, leaf: Disc(radius_m: 0.1), leaf_material: \"soil\"),"
            ),
        )
    };
    let folder = tempfile::tempdir().expect("a folder");
    let found = told(folder.path(), &crown("0.0", "crown"));
    assert!(!found.contains("error"), "{found}");
    assert!(told(folder.path(), &crown("-1.0", "crown")).contains("at least 0"));
    for (name, advice) in [("crowm", "did you mean `crown`"), ("=crown", "is no formula here")] {
        let found = told(folder.path(), &crown("1.0", name));
        assert!(found.contains(advice), "{found}");
        let lines: Vec<&str> = found.lines().collect();
        let line = lines.iter().position(|line| line.contains("Scatter(")).expect("the line");
        let (before, _) = lines[line].split_once(&format!("\"{name}\"")).expect("the key");
        let (blank, _) = lines[line + 1].split_once('^').expect("a caret");
        assert_eq!(blank.chars().count(), before.chars().count(), "{found}");
    }
}

#[test]
fn a_thermal_sky_that_emits_nothing_is_noted() {
    let warm = scene(PLANE)
        .replace("center_nm: 660.0", "center_nm: 10500.0")
        .replace("Constant(0.2))", "Constant(0.2), temperature: Uniform(300.0))")
        .replace(
            "sensors: { \"view\": Orthographic(size_px: (2, 2), extent_m: (2.0, 2.0)) }",
            "sensors: { \"t\": Orthographic(size_px: (2, 2), extent_m: (2.0, 2.0), measure: [BrightnessTemperature]) }",
        );
    let folder = tempfile::tempdir().expect("a folder");
    let found = told(folder.path(), &warm);
    assert!(found.contains("the sky emits nothing in band `red`"), "{found}");
    let sky = warm.replace("format: 1,", "format: 1, thermal_sky: BlackBody(250.0),");
    let found = told(folder.path(), &sky);
    assert!(!found.contains("emits nothing"), "{found}");
}
