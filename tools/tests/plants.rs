//! What the commands say of the plants of a scene: `lai`, `chm` and `stats`.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::{TempDir, tempdir};

/// Corners of the leaves of a shrub, m.
const LEAVES: [[[f64; 3]; 3]; 4] = [
    [[0.0, 0.0, 0.5], [0.75, 0.0, 1.0], [0.0, 0.5, 1.25]],
    [[0.0, 0.0, 1.0], [-0.5, 0.25, 1.0], [-0.25, -0.5, 1.0]],
    [[0.125, 0.0, 0.25], [0.125, 0.5, 0.25], [0.125, 0.25, 2.0]],
    [[-0.5, -0.5, 0.75], [0.5, -0.25, 1.5], [0.25, 0.5, 1.75]],
];

/// Corners of its only piece of bark, m.
const BARK: [[f64; 3]; 3] = [[-0.125, 0.0, 0.0], [0.125, 0.0, 0.0], [0.0, 0.0, 1.5]];

/// A round leaf: its radius, centre and normal, m.
const DISC: (f64, [f64; 3], [f64; 3]) = (0.25, [0.0, 0.25, 1.5], [0.6, 0.0, 0.8]);

/// An instance, as a row of the table of stems.
struct Stem {
    place: [f64; 3],
    yaw_deg: f64,
    scale: f64,
    scale_vertical: f64,
    tilt_deg: f64,
    tilt_azimuth_deg: f64,
}

/// Stems over and beside the border, some of them leaning and unequally scaled.
const STEMS: [Stem; 4] = [
    stem([1.5, 2.0, 0.0], 0.0, [1.0, 1.0], [0.0, 0.0]),
    stem([3.875, 0.25, 0.25], 130.0, [1.5, 0.75], [0.0, 0.0]),
    stem([0.125, 2.75, 0.0], 250.0, [0.75, 2.0], [20.0, 70.0]),
    stem([2.5, 1.0, 0.5], 75.0, [1.25, 1.25], [50.0, 200.0]),
];

const fn stem(
    place: [f64; 3],
    yaw_deg: f64,
    [scale, scale_vertical]: [f64; 2],
    [tilt_deg, tilt_azimuth_deg]: [f64; 2],
) -> Stem {
    Stem { place, yaw_deg, scale, scale_vertical, tilt_deg, tilt_azimuth_deg }
}

const SCENE: &str = r#"Scene(
    format: 1,
    title: "Four shrubs",
    frame: (origin_m: (500000.0, 5400000.0, 300.0)),
    bands: [(name: "red", center_nm: 660.0)],
    materials: {
        "soil": Lambertian(reflectance: Constant(0.2)),
        "leaf": Leaf(reflectance: Constant(0.1), transmittance: Constant(0.05)),
        "bark": Lambertian(reflectance: Constant(0.2)),
    },
    meshes: {
        "shrub": Obj(file: "shrub.obj", up: Z, unit_m: 1.0, parts: { "leaf": "leaf", "trunk": "bark" }),
        "disc": Discs(file: "disc.csv", material: "leaf"),
    },
    terrain: Plane(size_m: (4.0, 3.0), material: "soil"),
    instances: [Table(file: "stems.csv", of: "shrub"), Table(file: "stems.csv", of: "disc")],
    sun: (zenith_deg: 30.0),
    boundary: Isolated,
    sensors: { "view": Directions(views: List([(0.0, 0.0)])) },
)"#;

/// A folder with the scene and its files.
fn folder() -> TempDir {
    let folder = tempdir().unwrap();
    let mut obj = String::new();
    for (part, triangles) in [("leaf", &LEAVES[..]), ("trunk", &[BARK])] {
        writeln!(obj, "g {part}").unwrap();
        for triangle in triangles {
            for [x, y, z] in triangle {
                writeln!(obj, "v {x} {y} {z}").unwrap();
            }
            writeln!(obj, "f -3 -2 -1").unwrap();
        }
    }
    let (radius, [x, y, z], [nx, ny, nz]) = DISC;
    let disc = format!("radius,x,y,z,nx,ny,nz\n{radius},{x},{y},{z},{nx},{ny},{nz}\n");
    let mut stems =
        String::from("x_m,y_m,z_m,yaw_deg,scale,scale_vertical,tilt_deg,tilt_azimuth_deg\n");
    for Stem { place: [x, y, z], yaw_deg, scale, scale_vertical, tilt_deg, tilt_azimuth_deg } in
        &STEMS
    {
        let row = [*x, *y, *z, *yaw_deg, *scale, *scale_vertical, *tilt_deg, *tilt_azimuth_deg];
        writeln!(stems, "{}", row.map(|number| number.to_string()).join(",")).unwrap();
    }
    let files =
        [("shrubs.ron", SCENE), ("shrub.obj", &obj), ("disc.csv", &disc), ("stems.csv", &stems)];
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Standard output of a command that succeeds without standard error, whose last line ends with a time that is left
/// out.
fn printed(folder: &Path, arguments: &[&str]) -> String {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let output = command.current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let (stdout, stderr) = (text(output.stdout), text(output.stderr));
    assert!(output.status.success(), "{stderr}");
    let all = format!("{stderr}{stdout}");
    match all.trim_end().rsplit_once(": ") {
        Some((before, time)) if time.ends_with(" s") => format!("{before}: TIME"),
        _ => all,
    }
}

type Vector = [f64; 3];

fn cross([ax, ay, az]: Vector, [bx, by, bz]: Vector) -> Vector {
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

fn difference(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn length(vector: Vector) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}

impl Stem {
    /// A vector of the shrub at its place: scaled, turned to the left, and leaning towards an azimuth.
    fn placed(&self, [x, y, z]: Vector) -> Vector {
        let (sin, cos) = self.yaw_deg.to_radians().sin_cos();
        let (x, y, z) = (x * self.scale, y * self.scale, z * self.scale_vertical);
        let (x, y) = (cos * x - sin * y, sin * x + cos * y);
        // Along the direction in which it leans, and across it.
        let (east, north) = self.tilt_azimuth_deg.to_radians().sin_cos();
        let (along, across) = (east * x + north * y, north * x - east * y);
        let (sin, cos) = self.tilt_deg.to_radians().sin_cos();
        let (along, z) = (cos * along + sin * z, cos * z - sin * along);
        [east * along + north * across, north * along - east * across, z]
    }

    fn area(&self, [a, b, c]: [Vector; 3]) -> f64 {
        let [a, b, c] = [a, b, c].map(|corner| self.placed(corner));
        0.5 * length(cross(difference(b, a), difference(c, a)))
    }

    /// Area of its leaves, m².
    fn leaf_area(&self) -> f64 {
        let (radius, _, normal) = DISC;
        // Two radii in the disc, perpendicular to each other.
        let u = [normal[2], 0.0, -normal[0]].map(|part| radius * part);
        let v = [0.0, radius, 0.0];
        let disc = std::f64::consts::PI * length(cross(self.placed(u), self.placed(v)));
        LEAVES.iter().map(|leaf| self.area(*leaf)).sum::<f64>() + disc
    }
}

/// Values of a column of a table, by the first column.
fn column(folder: &Path, file: &str, name: &str) -> Vec<(String, f64)> {
    let csv = fs::read_to_string(folder.join("out/shrubs_lai").join(file)).unwrap();
    let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let at = header.iter().position(|&other| other == name).unwrap();
    lines
        .map(|line| line.split(',').collect::<Vec<_>>())
        .map(|cells| (cells[0].to_owned(), cells[at].parse().unwrap()))
        .collect()
}

#[test]
fn leaf_area_is_that_of_all_triangles_and_discs() {
    let folder = folder();
    insta::assert_snapshot!(printed(folder.path(), &["lai", "shrubs.ron", "--cell", "1"]));
    let expected: f64 = STEMS.iter().map(Stem::leaf_area).sum();
    let areas = column(folder.path(), "lai_leaf_area.csv", "leaf");
    let all: f64 = areas.iter().map(|(_, area)| area).sum();
    assert!((all / expected - 1.0).abs() < 1e-6, "{all} for {expected}");
    assert!(areas[0].1 < 0.95 * expected, "some lies beside the rectangle: {areas:?}");
    let mut files: Vec<String> = fs::read_dir(folder.path().join("out/shrubs_lai"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    insta::assert_snapshot!("files_of_lai", files.join("\n"));
}

#[test]
fn all_surfaces_are_counted_by_material() {
    let folder = folder();
    let arguments = ["lai", "shrubs.ron", "--surfaces", "all", "--by-material", "--layers", "2"];
    insta::assert_snapshot!(printed(
        folder.path(),
        &[&arguments[..], &["--columns", "2"]].concat()
    ));
    let bark: f64 = STEMS.iter().map(|stem| stem.area(BARK)).sum();
    let areas = column(folder.path(), "lai_plant_area.csv", "bark");
    let sum: f64 = areas.iter().map(|(_, area)| area).sum();
    assert!((sum / bark - 1.0).abs() < 1e-6, "{sum} for {bark}");
}

#[test]
fn heights_are_mapped() {
    let folder = folder();
    insta::assert_snapshot!(printed(folder.path(), &["chm", "shrubs.ron", "--cell", "0.5"]));
}

#[test]
fn statistics_hold_the_area_of_unequally_scaled_plants() {
    let folder = folder();
    insta::assert_snapshot!(printed(folder.path(), &["stats", "shrubs.ron"]));
    let json = printed(folder.path(), &["stats", "shrubs.ron", "--json"]);
    let value: serde_json::Value = serde_json::from_str(&json).unwrap();
    let index = value["scene"]["leaf_area_index"].as_f64().unwrap();
    let expected: f64 = STEMS.iter().map(Stem::leaf_area).sum::<f64>() / 12.0;
    assert!((index / expected - 1.0).abs() < 1e-6, "{index} for {expected}");
}
