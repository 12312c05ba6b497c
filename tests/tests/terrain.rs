//! Ground that is not level: slopes, seams, classes and holes.

use std::fs;
use std::path::Path;

use glam::{DVec2, DVec3};
use sunfleck::products::Report;
use sunfleck::run::{Options, check_file, stage_file};
use sunfleck_tests::{Estimate, measure, product, shared};
use tempfile::TempDir;

/// An ESRI ASCII grid of cells of 2 m with its south-west corner at (1000, 500).
fn grid(columns: usize, rows: usize, height: impl Fn(f64, f64) -> f64) -> String {
    let mut text = format!(
        "ncols {columns}\nnrows {rows}\nxllcorner 1000\nyllcorner 500\ncellsize 2\nNODATA_value -9\n"
    );
    for row in (0..rows).rev() {
        let at = |i: usize| 2.0 * i as f64 + 1.0;
        let line: Vec<_> = (0..columns).map(|x| height(at(x), at(row)).to_string()).collect();
        text += &line.join(" ");
        text.push('\n');
    }
    text
}

fn scene(terrain: &str, boundary: &str, sensors: &str) -> String {
    format!(
        r#"Scene(
    format: 1,
    bands: [(name: "a", center_nm: 660.0)],
    materials: {{
        "soil": Lambertian(reflectance: Constant(0.2)), "snow": Lambertian(reflectance: Constant(1.0)),
        "leaf": Leaf(reflectance: Constant(0.4), transmittance: Constant(0.3)),
    }},
    meshes: {{ "crown": Crown(shape: Ellipsoid(diameter_m: 5.0, height_m: 6.0), base_m: 0.0,
        leaf_area_m2: 60.0, leaf: Disc(radius_m: 0.1), leaf_material: "leaf") }},
    frame: (origin_m: (1000.0, 500.0, 0.0)),
    terrain: {terrain},
    sun: (zenith_deg: 40.0, azimuth_deg: 250.0, irradiance: Constant(1.0)),
    boundary: {boundary},
    sensors: {{ {sensors} }},
)"#
    )
}

fn run(folder: &Path, text: &str) -> Report {
    measure(text, folder, &Options::default())
}

/// What is written when a scene is checked: its errors, or its warnings.
fn check(folder: &Path, text: &str) -> String {
    let path = folder.join("scene.ron");
    fs::write(&path, text).expect("a file");
    match check_file(&path, &Options::default()) {
        Ok(warnings) => warnings.join("\n"),
        Err(failure) => failure.to_string(),
    }
}

const NADIR: &str = r#""image": Orthographic(size_px: (4, 4), extent_m: (20.0, 20.0), samples_per_px: 4, measure: [Brf])"#;

/// *Scene*: a plane tilted by 20° towards azimuth 270°, isolated.
/// *Expected*: `E = E_0 cos i` with `cos i = cos θ cos β + sin θ sin β cos Δφ`
/// (REFERENCES.md, C.1): from above `BRF = ρ cos i / cos θ`, and the ground, larger than its
/// rectangle by `1 / cos β`, absorbs `(1 - ρ) cos i / (cos β cos θ)` of what falls on the rectangle.
#[test]
fn a_slope_is_lit_by_the_cosine_of_its_own_angle() {
    let folder = TempDir::new().expect("a folder");
    let slope = 20_f64.to_radians();
    fs::write(folder.path().join("dem.asc"), grid(20, 15, |x, _| 300.0 + x * slope.tan()))
        .expect("a file");
    let photons = r#""photons": Photons(per_m2: 200.0, measure: [Albedo, Fapar(layer_m: 5.0)])"#;
    let terrain = r#"Raster(file: "dem.asc", material: "soil")"#;
    let report = run(folder.path(), &scene(terrain, "Isolated", &format!("{NADIR}, {photons}")));
    let (sun, relative) = (40_f64.to_radians(), 20_f64.to_radians());
    let cosine = sun.cos() * slope.cos() + sun.sin() * slope.sin() * relative.cos();
    let expected = 0.2 * cosine / sun.cos();
    let brf = product(&report, "image", "brf").image.as_ref().expect("an image");
    for value in &brf.load().expect("pixels can be read").values {
        assert!((f64::from(*value) / expected - 1.0).abs() < 1e-5, "{value} for {expected}");
    }
    let absorbed = Estimate::of(product(&report, "photons", "fapar_material"), 0);
    let expected = 0.8 * cosine / (slope.cos() * sun.cos());
    assert!(absorbed.z(expected).abs() < 4.0, "{absorbed:?} for {expected}");
}

/// *Scene*: the same crowns over a plane and over a level raster with the same corner.
/// *Expected*: the same BRF, albedo and fAPAR within 4 standard errors.
#[test]
fn a_level_raster_is_a_plane() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("dem.asc"), grid(10, 10, |_, _| 7.0)).expect("a file");
    let sensors = r#"
        "brf": Directions(system: Backward, views: CrossPlane(max_deg: 60.0, step_deg: 30.0), until: Samples(4096)),
        "photons": Photons(per_m2: 500.0, measure: [Albedo, Fapar(layer_m: 5.0)])"#;
    let of = |terrain: &str| {
        let stand =
            r#"instances: [List(of: "crown", at_m: [(4.0, 5.0, 8.0), (13.0, 12.0, 9.0)])], sun:"#;
        run(folder.path(), &scene(terrain, "Periodic", sensors).replace("sun:", stand))
    };
    let plane = of(r#"Plane(size_m: (20.0, 20.0), height_m: 7.0, material: "soil")"#);
    let raster = of(r#"Raster(file: "dem.asc", material: "soil")"#);
    for (sensor, name) in [("brf", "brf"), ("photons", "albedo"), ("photons", "fapar_material")] {
        let (a, b) = (product(&plane, sensor, name), product(&raster, sensor, name));
        assert_eq!(a.values.len(), b.values.len());
        for index in 0..a.values.len() {
            let (a, b) = (Estimate::of(a, index), Estimate::of(b, index));
            let same = (a.value - b.value).abs() <= 4.0 * a.error.hypot(b.error);
            assert!(same, "{name}[{index}]: {a:?} {b:?}");
        }
    }
}

/// *Scene*: a periodic ground that reflects everything and whose sides do not match, by up to 9 m.
/// *Expected*: albedo 1: light that got under the ground would be lost.
#[test]
fn no_light_is_lost_at_seams_that_do_not_match() {
    let folder = TempDir::new().expect("a folder");
    let heights = grid(12, 10, |x, y| 0.3 * x + 2.0 * (0.4 * x + 0.7 * y).sin() + 0.1 * y);
    fs::write(folder.path().join("dem.asc"), heights).expect("a file");
    let sensors = r#""photons": Photons(per_m2: 200.0, measure: [Albedo])"#;
    for terrain in [
        r#"Raster(file: "dem.asc", material: "snow")"#,
        r#"Raster(file: "dem.asc", material: "snow", tolerance_m: 1.0)"#,
    ] {
        let report = run(folder.path(), &scene(terrain, "Periodic", sensors));
        let albedo = Estimate::of(product(&report, "photons", "albedo"), 0);
        // What loses nothing is never played for: each packet brings all back, to the rounding of its weight.
        assert!((albedo.value - 1.0).abs() < 1e-6 && albedo.error < 1e-6, "{albedo:?}");
    }
}

/// *Scene*: a raster with three classes; the camera looks straight down.
/// *Expected*: each pixel within a class has that class' reflectance, right up to the border.
#[test]
fn a_land_cover_gives_each_cell_its_material() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path();
    fs::write(path.join("dem.asc"), grid(10, 10, |_, _| 0.0)).expect("a file");
    fs::write(
        path.join("cover.asc"),
        grid(10, 10, |x, y| if x < 6.0 || y > 14.0 { 1.0 } else { 4.0 }),
    )
    .expect("a file");
    let image = r#""image": Orthographic(size_px: (10, 10), extent_m: (20.0, 20.0), samples_per_px: 16, measure: [Brf])"#;
    let terrain = |classes: &str| {
        format!(r#"Raster(file: "dem.asc", land_cover: (file: "cover.asc", classes: {classes}))"#)
    };
    let text = scene(&terrain(r#"{ "1": "soil", "4": "snow" }"#), "Isolated", image);
    let report = run(path, &text);
    let brf = product(&report, "image", "brf").image.as_ref().expect("an image");
    for (pixel, value) in brf.load().expect("pixels can be read").values.iter().enumerate() {
        let (column, row) = (pixel % 10, pixel / 10);
        let expected = if column < 3 || row < 3 { 0.2 } else { 1.0 };
        assert!((f64::from(*value) / expected - 1.0).abs() < 1e-5, "{column}, {row}: {value}");
    }
    let missing = check(path, &scene(&terrain(r#"{ "1": "soil" }"#), "Isolated", image));
    assert!(missing.contains("class 4 has no material"), "{missing}");
    assert!(missing.contains(r#"add `"4": ".."#), "{missing}");
    let named =
        check(path, &scene(&terrain(r#"{ "1": "soil", "grass": "snow" }"#), "Isolated", image));
    assert!(named.contains("no class `grass`"), "{named}");
}

#[test]
fn cells_without_data_are_refused_filled_or_left_out() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path();
    let heights = grid(10, 10, |x, y| if x > 8.0 && x < 12.0 && y < 4.0 { -9.0 } else { 50.0 });
    fs::write(path.join("dem.asc"), heights).expect("a file");
    let terrain = |rest: &str| format!(r#"Raster(file: "dem.asc", material: "soil"{rest})"#);
    let refused = check(path, &scene(&terrain(""), "Isolated", NADIR));
    assert!(refused.contains("4 of its 100 cells have no data"), "{refused}");
    assert!(refused.contains("no_data: Neighbours"), "{refused}");
    let stage = |rest: &str| {
        fs::write(path.join("scene.ron"), scene(&terrain(rest), "Isolated", NADIR))
            .expect("a file");
        stage_file(&path.join("scene.ron"), &Options::default())
            .unwrap_or_else(|failure| panic!("{failure}"))
            .stage
    };
    let at = DVec2::new(10.0, 2.0);
    let filled = stage(", no_data: Neighbours").ground_at(at);
    assert!((filled - 50.0).abs() < 1e-9, "{filled}");
    assert!((stage(", no_data: Height(20.0)").ground_at(at) - 20.0).abs() < 1e-5);
    let hole = stage(", no_data: Hole");
    let down =
        sunfleck::accel::Ray { origin: at.extend(99.0), direction: DVec3::NEG_Z, from: None };
    assert!(hole.geometry.closest(&down).is_none());
    let beside = hole.ground_at(at + DVec2::new(3.0, 0.0));
    assert!((beside - 50.0).abs() < 1e-9, "{beside}");
}

#[test]
fn heights_above_the_ground_are_those_of_the_slope_below() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path();
    fs::write(path.join("dem.asc"), grid(20, 10, |x, y| 100.0 + 0.5 * x - 0.25 * y))
        .expect("a file");
    for (terrain, base) in [
        (r#"Raster(file: "dem.asc", material: "soil")"#, 100.0),
        (r#"Raster(file: "dem.asc", material: "soil", lowest_m: 0.0)"#, 4.25),
    ] {
        fs::write(path.join("scene.ron"), scene(terrain, "Isolated", NADIR)).expect("a file");
        let ready = stage_file(&path.join("scene.ron"), &Options::default());
        let stage = ready.unwrap_or_else(|failure| panic!("{failure}")).stage;
        for at in [DVec2::new(3.0, 4.0), DVec2::new(39.5, 0.5), DVec2::new(20.0, 19.9)] {
            let expected = base + 0.5 * at.x - 0.25 * at.y;
            let found = stage.ground_at(at);
            assert!((found - expected).abs() < 1e-4, "{at}: {found} for {expected}");
        }
    }
}

#[test]
fn degrees_are_refused_with_an_explanation_unless_they_are_said_to_be() {
    let Some(shared) = shared() else { return };
    let folder = TempDir::new().expect("a folder");
    let path = folder.path();
    let dem = "SRTMGL3_colorado_3arcsec.asc";
    fs::copy(shared.join("data/dem").join(dem), path.join(dem)).expect("a file");
    let terrain = |rest: &str| {
        format!(r#"Raster(file: "{dem}", material: "soil", no_data: Neighbours{rest})"#)
    };
    let refused = check(path, &scene(&terrain(""), "Isolated", NADIR));
    assert!(refused.contains("its coordinates are degrees"), "{refused}");
    assert!(refused.contains("gdalwarp -t_srs EPSG:32613"), "{refused}");
    let text = scene(&terrain(", coordinates: Degrees, tolerance_m: 5.0"), "Isolated", NADIR);
    fs::write(path.join("scene.ron"), text).expect("a file");
    let ready = stage_file(&path.join("scene.ron"), &Options::default());
    let stage = ready.unwrap_or_else(|failure| panic!("{failure}")).stage;
    // 0.12° at 40.15° north: 111.037 km and 85.22 km a degree.
    let expected = DVec2::new(10_226.0, 13_324.0);
    assert!((stage.size - expected).length() < 10.0, "{}", stage.size);
}

#[test]
fn trees_far_above_or_below_the_ground_are_told() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path();
    fs::write(path.join("dem.asc"), grid(10, 10, |x, _| 100.0 + x)).expect("a file");
    let stand = r#"instances: [List(of: "crown", at_m: [(5.0, 5.0, 0.0), (8.0, 8.0, 0.0),
        (5.0, 9.0, 130.0), (12.0, 9.0, 112.0)])], sun:"#;
    let text = scene(r#"Raster(file: "dem.asc", material: "soil")"#, "Isolated", NADIR);
    let found = check(path, &text.replace("sun:", stand));
    assert!(found.contains("2 of `crown` are sunken into the ground"), "{found}");
    assert!(found.contains("1 of `crown` float above the ground"), "{found}");
}

/// *Scene*: heights of an ENVI raster in UTM. *Expected*: so is the image from above, unless the
/// scene lays the raster elsewhere.
#[test]
fn an_image_from_above_has_the_projection_of_the_ground() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path();
    fs::write(path.join("dem.img"), [0; 4]).expect("a file");
    let header = "ENVI\nsamples = 2\nlines = 2\ndata type = 1\nmap info = {UTM, 1, 1, 500000, \
                  4000020, 10, 10, 33, North, WGS-84, units=Meters}\n";
    fs::write(path.join("dem.hdr"), header).expect("a file");
    let image = r#""image": Orthographic(size_px: (4, 4), cover: WholeScene, samples_per_px: 16, azimuth_deg: 180.0, measure: [Brf])"#;
    let map_info = |rest: &str| {
        let terrain = format!(r#"Raster(file: "dem.img", material: "soil"{rest})"#);
        let text = scene(&terrain, "Isolated", image);
        let text = text.replace("(1000.0, 500.0, 0.0)", "(499000.0, 4000000.0, 0.0)");
        let out = path.join("out");
        let files = sunfleck::output::write(&run(path, &text), &out).expect("files");
        let header = files.iter().find(|file| file.extension().is_some_and(|e| e == "hdr"));
        let text = fs::read_to_string(header.expect("a header")).expect("a text");
        text.lines().find(|line| line.starts_with("map info")).expect("a place").to_owned()
    };
    assert_eq!(
        map_info(""),
        "map info = {UTM, 1, 1, 500000, 4000020, 5, 5, 33, North, WGS-84, units=Meters}"
    );
    assert_eq!(
        map_info(", corner_m: (0.0, 0.0)"),
        "map info = {Arbitrary, 1, 1, 499000, 4000020, 5, 5, 0, North, units=Meters}"
    );
}
