//! Grounds whose reflectance is a raster: cell by cell, by every system, from every format.

use std::fs;
use std::path::Path;

use sunfleck::document::{Diagnostic, ReadOptions, read_file};
use sunfleck::products::Report;
use sunfleck::run::{Options, SceneWorld, Unwatched, check_file, run_file};
use sunfleck_tests::scene_text::{LEAF_SHAPE, tree};
use sunfleck_tests::{Estimate, SceneText, product};
use tempfile::TempDir;

/// Files that GDAL 3 has written, of 6 x 4 cells of 10 m with the corner at (500000, 5600000) in EPSG:32633: bands B2, B4
/// and B8 hold `1000 b + 100 r + 10 c` in band b from 1, row r from 0 in the north and column c from 0. `scaled.tif` has
/// a scale of 0.0001 and no data in row 1, column 2; `alpha.tif` an opacity of 0 in row 3, column 5; `tiled.tif` one
/// plane a band in tiles and no names; the header of `bands.bil` has wavelengths and a scale factor of 10000.
const FILES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reflectance_files");

/// An ESRI ASCII grid with its corner at the origin, from text with a line for each row from the north.
fn grid(cell: f64, rows: &[&str]) -> String {
    let columns = rows[0].split_whitespace().count();
    let lines = rows.len();
    format!(
        "ncols {columns}\nnrows {lines}\nxllcorner 0\nyllcorner 0\ncellsize {cell}\nNODATA_value -9999\n{}\n",
        rows.join("\n")
    )
}

/// Pixels of an image.
fn pixels(report: &Report, sensor: &str, name: &str) -> Vec<f32> {
    let image = product(report, sensor, name).image.as_ref().expect("an image");
    image.load().expect("pixels can be read").values
}

/// *Scene*: level bare ground of a map under the sun alone, periodic and isolated. *Expected*: each pixel of the BRF is the
/// reflectance of its cell in both bands; the albedo is their mean.
#[test]
fn bare_ground_has_the_reflectance_of_its_cells() {
    let rows = ["0.1 0.5 0.25 0.7", "0.3 0 1 0.05", "0.9 0.2 0.6 0.15"];
    let cells: Vec<f64> = rows
        .iter()
        .flat_map(|row| row.split(' '))
        .map(|one| one.parse().expect("a number"))
        .collect();
    let mean = cells.iter().sum::<f64>() / 12.0;
    for boundary in ["Periodic", "Isolated"] {
        let sensors = r#""image": Orthographic(size_px: (4, 3), extent_m: (20.0, 15.0), samples_per_px: 16, measure: [Brf]),
            "photons": Photons(per_m2: 4000.0, measure: [Albedo, BrfCells(20)])"#;
        let report = SceneText::default()
            .with("bands", r#"(name: "a", center_nm: 660.0), (name: "b", center_nm: 865.0)"#)
            .with(
                "materials",
                r#""soil": ReflectanceMap(file: "map.asc", bands: All(1), scale: 1.0)"#,
            )
            .with("terrain", r#"Plane(size_m: (20.0, 15.0), material: "soil")"#)
            .with("sun", "zenith_deg: 40.0, azimuth_deg: 200.0, irradiance: Constant(1.0)")
            .with("boundary", boundary)
            .with("sensors", sensors)
            .with_file("map.asc", &grid(5.0, &rows))
            .measure();
        for (index, value) in pixels(&report, "image", "brf").into_iter().enumerate() {
            let expected = cells[index / 2 % 12];
            assert!((f64::from(value) - expected).abs() < 1e-6, "{index}: {value} for {expected}");
        }
        let albedo = product(&report, "photons", "albedo");
        for band in 0..2 {
            let albedo = Estimate::of(albedo, band);
            assert!(albedo.z(mean).abs() < 4.0 && albedo.error < 1e-3, "{albedo:?} for {mean}");
        }
        let run = report.sensors.iter().find(|one| one.name == "photons").expect("a sensor");
        assert!(run.energy_imbalance.is_some_and(|part| part < 1e-9), "{run:?}");
    }
}

/// Trees over a ground of two reflectances, in two bands and one of emission; `ground` has the keys of its terrain.
fn stand(ground: &str, boundary: &str, sensors: &str) -> SceneText {
    let heights = grid(1.0, &["0 0 0 0 0"; 5]);
    let classes = ["1 1 2 2 2", "2 1 1 2 2", "2 2 1 1 2", "2 2 2 1 1", "1 2 2 2 1"];
    let band = |dark: &str, bright: &str| {
        let rows = classes.map(|row| row.replace('1', "d").replace('2', "b"));
        let rows = rows.map(|row| row.replace('d', dark).replace('b', bright));
        grid(1.0, &rows.each_ref().map(String::as_str))
    };
    SceneText::default()
        .with("bands", r#"(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0), (name: "tir", center_nm: 10000.0)"#)
        .with(
            "materials",
            r#""leaf": Leaf(reflectance: Bands([0.05, 0.5, 0.02]), transmittance: Bands([0.03, 0.45, 0.0]), temperature: Uniform(295.0)),
            "map": ReflectanceMap(file: "map.asc", bands: All(1), scale: 0.01, temperature: Uniform(300.0)),
            "dark": Lambertian(reflectance: Constant(0.05), temperature: Uniform(300.0)),
            "bright": Lambertian(reflectance: Constant(0.45), temperature: Uniform(300.0))"#,
        )
        .with("meshes", tree(LEAF_SHAPE))
        .with("terrain", format!(r#"Raster(file: "dem.asc", {ground})"#))
        .with("instances", r#"List(of: "tree", at_m: [(0.2, 2.0, 0.0), (3.0, 4.4, 0.0)])"#)
        .with("sun", "zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Bands([1.0, 1.0, 0.0])")
        .with("sky", "Isotropic(irradiance: Bands([0.3, 0.1, 0.0]))")
        .with("boundary", boundary)
        .with("sensors", sensors)
        .with_file("dem.asc", &heights)
        .with_file("map.asc", &band("5", "45"))
        .with_file("classes.asc", &grid(1.0, &classes))
}

const MAP: &str = r#"material: "map""#;
const CLASSES: &str =
    r#"land_cover: (file: "classes.asc", classes: { "1": "dark", "2": "bright" })"#;

/// Compares all values with errors of two products in the first `bands` of three.
fn compare(a: (&Report, &str, &str), b: (&Report, &str, &str), bands: usize) -> usize {
    let what = format!("{} {}, {} {}", a.1, a.2, b.1, b.2);
    let (a, b) = (product(a.0, a.1, a.2), product(b.0, b.1, b.2));
    assert_eq!(a.values.len(), b.values.len(), "{what}");
    let mut compared = 0;
    for index in (0..a.values.len()).filter(|index| index % 3 < bands) {
        let (a, b) = (Estimate::of(a, index), Estimate::of(b, index));
        if a.error < 0.2 * a.value && b.error < 0.2 * b.value {
            let difference = (a.value - b.value).abs();
            let error = a.error.hypot(b.error).max(1e-6 * a.value);
            assert!(difference < 4.5 * error, "{what}[{index}]: {a:?} and {b:?}");
            compared += 1;
        }
    }
    compared
}

/// *Scene*: trees over a ground of two reflectances, sun and sky, periodic and isolated. *Expected*: backward paths, packets,
/// photons as quanta and the reference integrator agree; energy closes; the same classes with two materials give the same.
#[test]
fn systems_agree_on_a_map_and_with_classes_of_the_same_materials() {
    for boundary in ["Periodic", "Isolated"] {
        let views = "views: List([(0.0, 0.0), (45.0, 15.0), (60.0, 190.0)]), until: Samples(12000)";
        let measures = "measure: [Albedo, Fapar(layer_m: 1.0), Fluxes(pixel_m: 1.0)]";
        let sensors = format!(
            r#""back": Directions({views}, system: Backward), "forth": Directions({views}, system: Forward),
            "plain": Directions({views}, system: Reference),
            "packets": Photons(per_m2: 1500.0, {measures}),
            "photons": Photons(per_m2: 1e4, system: Analog, {measures})"#
        );
        let map = stand(MAP, boundary, &sensors).measure();
        let classes = stand(CLASSES, boundary, &sensors).measure();
        let mut compared = compare((&map, "back", "hdrf"), (&map, "forth", "hdrf"), 2);
        compared += compare((&map, "back", "hdrf"), (&map, "plain", "hdrf"), 2);
        for name in ["albedo", "fapar_vegetation", "ftran"] {
            compared += compare((&map, "packets", name), (&map, "photons", name), 2);
            compared += compare((&map, "packets", name), (&classes, "packets", name), 2);
        }
        for sensor in ["back", "forth", "plain"] {
            compared += compare((&map, sensor, "hdrf"), (&classes, sensor, "hdrf"), 2);
        }
        assert!(compared >= 40, "{boundary}: {compared} values");
        for sensor in ["packets", "photons", "forth"] {
            let run = map.sensors.iter().find(|one| one.name == sensor).expect("a sensor");
            assert!(run.energy_imbalance.is_some_and(|part| part < 1e-9), "{sensor}: {run:?}");
        }
    }
}

/// *Scene*: the same ground without trees, seen from above. *Expected*: its emissivity is 1 less its reflectance: two
/// radiances whose ratio is that of the emissivities, by paths and by packets alike.
#[test]
fn ground_emits_by_the_emissivity_of_its_cells() {
    let sensors = r#""image": Orthographic(size_px: (5, 5), extent_m: (5.0, 5.0), samples_per_px: 4, measure: [Radiance]),
        "forth": Directions(views: List([(0.0, 0.0)]), measure: [Radiance], until: Samples(20000), system: Forward),
        "back": Directions(views: List([(0.0, 0.0)]), measure: [Radiance], until: Samples(20000), system: Backward)"#;
    let report = stand(MAP, "Periodic", sensors).with("instances", "").measure();
    let radiance: Vec<f64> = pixels(&report, "image", "radiance")
        .into_iter()
        .skip(2)
        .step_by(3)
        .map(f64::from)
        .collect();
    let (least, most) =
        radiance.iter().fold((f64::MAX, 0.0_f64), |(a, b), r| (a.min(*r), b.max(*r)));
    assert!((most / least - 0.95 / 0.55).abs() < 1e-4, "{least} {most}");
    let of = |sensor| Estimate::of(product(&report, sensor, "radiance"), 2);
    let (forth, back) = (of("forth"), of("back"));
    assert!(forth.z_against(back).abs() < 4.0, "{forth:?} {back:?}");
}

/// *Expected*: bit by bit the same results with one thread and with three.
#[test]
fn results_do_not_depend_on_threads() {
    let sensors = r#""back": Directions(views: List([(45.0, 15.0)]), until: Samples(4096)),
        "packets": Photons(per_m2: 500.0, measure: [Albedo, Fapar(layer_m: 1.0)])"#;
    let numbers = |threads| {
        let options = Options { threads: Some(threads), ..Options::default() };
        let report = stand(MAP, "Periodic", sensors).measure_with(&options);
        let products = report.sensors.iter().flat_map(|sensor| &sensor.products);
        products.flat_map(|one| one.values.iter().map(|value| value.to_bits())).collect::<Vec<_>>()
    };
    assert_eq!(numbers(1), numbers(3));
}

/// Level ground under files of the folder, in these bands; `map` has the keys of the map.
fn on_files(bands: &str, map: &str) -> SceneText {
    SceneText::default()
        .with("frame", "origin_m: (500000.0, 5600000.0, 0.0)")
        .with("bands", bands)
        .with("materials", format!(r#""soil": ReflectanceMap({map})"#))
        .with("terrain", r#"Plane(size_m: (60.0, 40.0), material: "soil")"#)
        .with("sun", "zenith_deg: 40.0, azimuth_deg: 200.0, irradiance: Constant(1.0)")
        .with("sensors", r#""image": Orthographic(size_px: (6, 4), extent_m: (60.0, 40.0), samples_per_px: 2, measure: [Brf])"#)
}

/// Runs a scene in a folder with the files, without those that GDAL writes beside them.
fn with_files(scene: &SceneText) -> (TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for entry in fs::read_dir(FILES).expect("the files").flatten() {
        fs::copy(entry.path(), folder.path().join(entry.file_name())).expect("a copy");
    }
    let file = folder.path().join("scene.ron");
    fs::write(&file, scene.to_string()).expect("a file");
    (folder, file)
}

/// Reflectance in a band of the files, from 0.
fn stored(band: usize, row: usize, column: usize) -> f64 {
    1e-4 * (1000 * (band + 1) + 100 * row + 10 * column) as f64
}

/// *Expected*: every pixel has the value of its cell in every band, whatever the format and however bands are named.
#[test]
fn formats_and_names_of_bands_give_the_same_values() {
    let bands = r#"(name: "nir", center_nm: 842.0), (name: "red", center_nm: 665.0)"#;
    let by_number = r#"bands: Each({ "red": 2, "nir": 3 })"#;
    let by_name = r#"bands: Each({ "red": "B4", "nir": "B8" })"#;
    let maps = [
        format!(r#"file: "scaled.tif", {by_name}, elsewhere: Bands([0.9, 0.8])"#),
        format!(r#"file: "scaled.tif", {by_number}, elsewhere: Bands([0.9, 0.8])"#),
        format!(r#"file: "alpha.tif", {by_number}, scale: 0.0001, elsewhere: Constant(0.7)"#),
        format!(r#"file: "tiled.tif", {by_number}, scale: 0.0001"#),
        format!(r#"file: "bands.bil", {by_name}"#),
        r#"file: "bands.hdr", bands: Wavelengths"#.to_owned(),
    ];
    for map in maps {
        let (_folder, file) = with_files(&on_files(bands, &map));
        let report = run_file(&file, &Options::default(), &Unwatched)
            .unwrap_or_else(|failure| panic!("{map}: {failure}"));
        for (index, value) in pixels(&report, "image", "brf").into_iter().enumerate() {
            let (band, column, row) = (index % 2, index / 2 % 6, index / 12);
            let expected = match (row, column) {
                (1, 2) if map.contains("scaled") => [0.9, 0.8][band],
                (3, 5) if map.contains("alpha") => 0.7,
                _ => stored([2, 1][band], row, column),
            };
            assert!((f64::from(value) - expected).abs() < 1e-6, "{map} {index}: {value}");
        }
    }
}

/// *Expected*: a narrow band between two wavelengths has the value of the straight line there, a wide one its mean; an
/// offset is added after the scale.
#[test]
fn bands_by_wavelength_lie_on_straight_lines_between_those_of_the_file() {
    let bands =
        r#"(name: "narrow", center_nm: 560.0), (name: "wide", center_nm: 665.0, width_nm: 100.0)"#;
    let map = r#"file: "bands.hdr", bands: Wavelengths, scale: 0.0002, offset: -0.1"#;
    let (_folder, file) = with_files(&on_files(bands, map));
    let report = run_file(&file, &Options::default(), &Unwatched).expect("a run");
    for (index, value) in pixels(&report, "image", "brf").into_iter().enumerate() {
        let (band, column, row) = (index % 2, index / 2 % 6, index / 12);
        let at = |band| 2.0 * stored(band, row, column) - 0.1;
        let (blue, red, nir) = (at(0), at(1), at(2));
        let slopes = ((red - blue) / 175.0, (nir - red) / 177.0);
        // Triangles of 50 nm on both sides of the middle.
        let expected = [blue + 70.0 * slopes.0, red + 0.25 * 50.0 * (slopes.1 - slopes.0)][band];
        assert!((f64::from(value) - expected).abs() < 1e-6, "{index}: {value} for {expected}");
    }
}

/// Text that is written when a scene with the files is checked.
fn problem(scene: &SceneText) -> String {
    let (folder, file) = with_files(scene);
    fs::write(folder.path().join("wrong.asc"), grid(20.0, &["0.1 1.5 0.3", "0.2 -0.5 0.4"]))
        .expect("a file");
    fs::write(folder.path().join("percent.asc"), grid(20.0, &["10 20 30", "40 50 60"]))
        .expect("a file");
    check(&file).replace(&folder.path().display().to_string(), "")
}

fn check(file: &Path) -> String {
    match check_file(file, &Options::default()) {
        Ok(warnings) => warnings.join("\n"),
        Err(failure) => failure.to_string(),
    }
}

/// *Expected*: each mistake has one message with what to write instead.
#[test]
fn mistakes_are_told_with_what_to_write_instead() {
    let bands = r#"(name: "red", center_nm: 665.0), (name: "nir", center_nm: 842.0)"#;
    let on = |map: &str| on_files(bands, map);
    let local = |map: &str| on(map).with("frame", "origin_m: (0.0, 0.0, 0.0)");
    let mut all = String::new();
    let mut tell = |name: &str, scene: SceneText| {
        all.extend(["## ", name, "\n", problem(&scene).trim_end(), "\n"]);
    };
    tell("no data", on(r#"file: "scaled.tif", bands: All(1)"#));
    tell("no unit", on(r#"file: "tiled.tif", bands: All(1)"#));
    tell("unknown name", on(r#"file: "scaled.tif", bands: Each({ "red": "B4", "nir": "B9" })"#));
    tell("no names", on(r#"file: "tiled.tif", bands: All("B4"), scale: 0.0001"#));
    tell("no such number", on(r#"file: "scaled.tif", bands: All(4)"#));
    tell("no wavelengths", on(r#"file: "scaled.tif", bands: Wavelengths"#));
    let far = on(r#"file: "bands.hdr", bands: Wavelengths"#);
    tell("beyond the wavelengths", far.with("bands", r#"(name: "swir", center_nm: 1610.0)"#));
    tell("values", local(r#"file: "wrong.asc", bands: All(1), scale: 1.0"#));
    tell("percent", local(r#"file: "percent.asc", bands: All(1), scale: 1.0"#));
    let wide = r#"Plane(size_m: (70.0, 40.0), material: "soil")"#;
    tell("not covered", on(r#"file: "bands.hdr", bands: All(1)"#).with("terrain", wide));
    tell("beside the raster", local(r#"file: "bands.hdr", bands: All(1)"#));
    let crs = r#"origin_m: (500000.0, 5600000.0, 0.0), crs: Some("EPSG:32632")"#;
    tell("another system", on(r#"file: "bands.hdr", bands: All(1)"#).with("frame", crs));
    let tree = tree(LEAF_SHAPE).replace("\"leaf\")", "\"soil\")");
    let trees = on(r#"file: "bands.hdr", bands: All(1)"#).with("meshes", tree);
    tell("on a mesh", trees.with("instances", r#"List(of: "tree", at_m: [(30.0, 20.0, 0.0)])"#));
    tell("no file", on(r#"file: "albedo.tif", bands: All(1)"#));
    let both =
        r#"file: "scaled.tif", bands: Each({ "red": 0, "blue": 1 }), scale: 0.0, offset: 1.0"#;
    tell("keys", on(both));
    tell("offset alone", on(r#"file: "scaled.tif", bands: All(1.5), offset: -0.1"#));
    insta::assert_snapshot!(all);
}

/// *Scene*: ground and a mesh of the same map; the mesh stands nowhere at first. *Expected*: a changed scene in which it
/// stands is refused as a scene read anew is, and the scene before is sound again. Without bands there is no panic.
#[test]
fn a_mesh_that_comes_to_wear_the_map_is_refused() {
    let scene = |bands: &str, places: &str| {
        SceneText::default()
            .with("bands", bands)
            .with("materials", r#""soil": ReflectanceMap(file: "map.asc", bands: All(1), scale: 1.0)"#)
            .with("meshes", r#""slab": Faces(faces_m: [[(0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (0.0, 1.0, 1.0)]], material: "soil")"#)
            .with("terrain", r#"Plane(size_m: (4.0, 4.0), material: "soil")"#)
            .with("instances", format!(r#"List(of: "slab", at_m: [{places}])"#))
            .with("sun", "zenith_deg: 40.0, azimuth_deg: 200.0")
            .with("sensors", r#""photons": Photons(per_m2: 10.0)"#)
    };
    let read = |scene: &SceneText| {
        let (folder, file) = with_files(scene);
        let reading = read_file(&file, &ReadOptions::default()).expect("a scene");
        (folder, reading.scene)
    };
    let one = r#"(name: "a", center_nm: 660.0)"#;
    let ((folder, bare), (_, worn)) = (read(&scene(one, "")), read(&scene(one, "(1.0, 1.0, 0.0)")));
    fs::write(folder.path().join("map.asc"), grid(2.0, &["0.1 0.2", "0.3 0.4"])).expect("a file");
    let mut world = SceneWorld::from_scene(&bare, folder.path()).expect("a world");
    let problems = world.set(&worn).expect_err("a mesh wears the map");
    let is_told = |one: &Diagnostic| one.message.contains("the mesh `slab` has it as a material");
    assert!(problems.iter().any(is_told), "{problems:?}");
    world.set(&bare).expect("a world");
    SceneWorld::from_scene(&read(&scene("", "")).1, folder.path()).expect("a world without bands");
}

/// *File*: ENVI, two bands whose first cell holds -9999, which the header does not name. *Expected*: one cell of six is told.
#[test]
fn a_cell_without_data_in_all_bands_is_counted_once() {
    let values = |band: i16| (0..6).map(move |cell| if cell == 0 { -9999 } else { band + cell });
    let bytes: Vec<u8> = values(100).chain(values(200)).flat_map(i16::to_le_bytes).collect();
    let header = "ENVI\nsamples = 3\nlines = 2\nbands = 2\ndata type = 2\ninterleave = bsq\nbyte order = 0\n";
    let scene = SceneText::default()
        .with("bands", r#"(name: "a", center_nm: 660.0), (name: "b", center_nm: 865.0)"#)
        .with(
            "materials",
            r#""soil": ReflectanceMap(file: "two", bands: Each({ "a": 1, "b": 2 }), scale: 0.001, elsewhere: Constant(0.2))"#,
        )
        .with("terrain", r#"Plane(size_m: (3.0, 2.0), material: "soil")"#)
        .with("sun", "zenith_deg: 40.0, azimuth_deg: 200.0")
        .with("sensors", r#""photons": Photons(per_m2: 10.0)"#);
    let (folder, file) = with_files(&scene);
    fs::write(folder.path().join("two.hdr"), header).expect("a file");
    fs::write(folder.path().join("two"), bytes).expect("a file");
    let told = check(&file);
    assert!(told.contains("1 of its 6 cells holds -9999"), "{told}");
}
