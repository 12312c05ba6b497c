//! Every choice of LESS's window: projects that hold it are imported, checked and run.
//!
//! The projects are made up here, from what is documented of their format. Choices are combined in
//! pairs: every two values of two different choices are together in at least one project.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::{Map, Value, json};
use tempfile::{TempDir, tempdir};

/// A choice, and its values by name.
const CHOICES: [(&str, &[&str]); 10] = [
    (
        "sensor",
        &[
            "orthographic",
            "oblique",
            "cover",
            "perspective",
            "default camera",
            "CircularFisheye",
            "PhotonTracing",
            "absent",
        ],
    ),
    ("products", &["none", "brf", "updown", "fpar", "all", "bare fpar"]),
    ("plane", &["absent", "whole", "beyond", "false"]),
    ("terrain", &["PLANE", "RASTER", "MESH", "RASTER without file", "absent"]),
    ("ground", &["Lambertian", "Soilspect", "bare Soilspect", "landalbedo", "landcover", "absent"]),
    ("thermal", &["false", "true", "absent"]),
    ("sky", &["zero", "some", "short", "manual", "manual sky", "absent"]),
    ("optics", &["object", "text", "prospect", "one-sided"]),
    ("objects", &["absent", "trees", "spaces", "no components"]),
    ("depth", &["-1", "200", "2", "5", "absent"]),
];

/// A value for each choice.
type Case = [usize; CHOICES.len()];

/// Cases that hold every pair of values of two choices.
fn pairs() -> Vec<Case> {
    let count = |choice: usize| CHOICES[choice].1.len();
    let mut open: Vec<[(usize, usize); 2]> = Vec::new();
    for a in 0..CHOICES.len() {
        for b in a + 1..CHOICES.len() {
            for i in 0..count(a) {
                open.extend((0..count(b)).map(|j| [(a, i), (b, j)]));
            }
        }
    }
    let mut cases = Vec::new();
    while let Some(&[(a, i), (b, j)]) = open.first() {
        // Greedy: each other choice takes the value that closes most pairs with those made so far.
        let mut case: [Option<usize>; CHOICES.len()] = [None; CHOICES.len()];
        (case[a], case[b]) = (Some(i), Some(j));
        for choice in 0..CHOICES.len() {
            if case[choice].is_some() {
                continue;
            }
            let closes = |value: usize| {
                let is_closed = |&&[(a, i), (b, j)]: &&[(usize, usize); 2]| {
                    (a == choice && i == value && case[b] == Some(j))
                        || (b == choice && j == value && case[a] == Some(i))
                };
                open.iter().filter(is_closed).count()
            };
            case[choice] = (0..count(choice)).max_by_key(|&value| closes(value));
        }
        let case: Case = case.map(Option::unwrap);
        open.retain(|&[(a, i), (b, j)]| case[a] != i || case[b] != j);
        cases.push(case);
    }
    cases
}

fn set(object: &mut Value, key: &str, value: Value) {
    object.as_object_mut().unwrap().insert(key.to_owned(), value);
}

fn remove(object: &mut Value, key: &str) {
    object.as_object_mut().unwrap().remove(key);
}

/// Settings of a project as LESS's window writes them, numbers mostly as texts.
fn settings(value: impl Fn(&str) -> &'static str) -> Value {
    let mut conf = json!({
        "Advanced": { "minimum_iteration": 5, "network_sim": false, "number_of_cores": 2 },
        "illumination": {
            "sun_calculator": false,
            "sun": { "sun_zenith": "35", "sun_azimuth": "100" },
            "atmosphere": { "ats_type": "SKY_TO_TOTAL" }
        },
        "observation": {},
        "sensor": {
            "image_width": "4", "image_height": "3", "bands": "660:10,865:20",
            "film_type": "spectrum", "NoDataValue": "-1", "RepetitiveScene": "0"
        },
        "scene": {
            "optical_properties": {},
            "temperature_properties": { "T300": "300:5", "T270": "270" },
            "terrain": { "extent_width": "20", "extent_height": "10", "optical": "loam" },
            "forest": { "tree_pos_file": "instances.txt", "objects_file": "objects.txt" }
        }
    });
    sensor(&mut conf, value("sensor"));
    products(&mut conf["sensor"], value("products"));
    plane(&mut conf["sensor"], value("plane"));
    thermal(&mut conf, value("thermal"));
    light(&mut conf["illumination"], value("sky"));
    optics(&mut conf["scene"]["optical_properties"], value("optics"));
    ground(&mut conf["scene"]["terrain"], value("terrain"), value("ground"));
    if value("depth") != "absent" {
        let depth: i32 = value("depth").parse().unwrap();
        set(&mut conf["sensor"], "record_only_direct", json!(depth));
    }
    conf
}

fn sensor(conf: &mut Value, value: &str) {
    let samples = json!({ "sample_per_square_meter": "2" });
    let camera = json!({ "obs_o_x": "10", "obs_o_y": "5", "obs_o_z": "9", "obs_t_x": "8",
                         "obs_t_y": "5", "obs_t_z": "0", "relative_height": "true" });
    let own = match value {
        "absent" => return,
        "orthographic" | "oblique" | "cover" => json!({ "sample_per_square_meter": 2,
            "sub_region_width": "20", "sub_region_height": "10",
            "cover_whole_scene": value == "cover" }),
        "perspective" | "default camera" => json!({ "sample_per_square_meter": "2",
            "fovx": "40", "fovy": "30", "fovAxis": "diagonal" }),
        "CircularFisheye" => json!({ "sample_per_square_meter": "2", "angular_fov": "165",
            "projection_type": "equisolid" }),
        _ => samples,
    };
    let kind = match value {
        "oblique" | "cover" => "orthographic",
        "default camera" => "perspective",
        other => other,
    };
    set(&mut conf["sensor"], "sensor_type", json!(kind));
    set(&mut conf["sensor"], kind, own);
    conf["observation"] = match value {
        "orthographic" => json!({ "obs_zenith": "0", "obs_azimuth": "180", "obs_R": "3000" }),
        "oblique" | "cover" => json!({ "obs_zenith": "35", "obs_azimuth": "-80", "obs_R": "" }),
        // What the window starts with: a camera on the ground.
        "default camera" => json!({ "obs_o_x": "0", "obs_o_y": "10", "obs_o_z": "0",
            "obs_t_x": "0", "obs_t_y": "0", "obs_t_z": "0", "relative_height": true }),
        _ => camera,
    };
    if value == "orthographic" {
        set(&mut conf["sensor"], "hasFourComponentProduct", json!("true"));
        set(&mut conf["sensor"], "RepetitiveScene", json!("100"));
    }
}

fn products(sensor: &mut Value, value: &str) {
    let is = |names: &[&str]| names.contains(&value);
    let mut own = json!({
        "sunRayResolution": "1",
        "BRFProduct": is(&["brf", "all"]),
        "UpDownProduct": is(&["updown", "all"]),
        "fPARProduct": is(&["fpar", "bare fpar", "all"]),
    });
    if is(&["brf", "all"]) {
        set(&mut own, "NumberOfDirections", json!("20"));
        set(&mut own, "virtualDirections", json!(if value == "brf" { "" } else { "0:0;60:350" }));
        let cones = if value == "brf" { "10,20;0,180;5" } else { "80,90,30" };
        set(&mut own, "virtualDetectorDirections", json!(cones));
    }
    if is(&["fpar", "all"]) {
        set(&mut own, "LayerDefinition", json!(if value == "all" { "10" } else { "0:2:5" }));
    }
    set(sensor, "PhotonTracing", own);
}

fn plane(sensor: &mut Value, value: &str) {
    let size = match value {
        "absent" => return,
        "false" => return set(sensor, "virtualPlane", json!(false)),
        "whole" => "20",
        _ => "30",
    };
    let plane = json!({ "vx": "10", "vy": "5", "vz": "MAX", "sizex": size, "sizey": "10" });
    set(sensor, "virtualPlane", plane);
}

fn thermal(conf: &mut Value, value: &str) {
    if value != "absent" {
        set(&mut conf["sensor"], "thermal_radiation", json!(value == "true"));
    }
    if value == "true" {
        set(&mut conf["sensor"], "bands", json!("10000:100,11000:100"));
        set(&mut conf["illumination"]["atmosphere"], "AtsTemperature", json!("T270"));
    }
}

fn light(illumination: &mut Value, value: &str) {
    if value.starts_with("manual") {
        set(&mut illumination["sun"], "sun_spectrum", json!("1.32,1.06"));
    }
    let (key, list) = match value {
        "zero" => ("percentage", "0.0,0.0"),
        "some" => ("percentage", "0.2,0.1"),
        "short" => ("percentage", "0.2"),
        "manual sky" => ("sky_spectrum", "0.2,0.1"),
        "manual" => ("sky_spectrum", "0,0"),
        _ => return remove(illumination, "atmosphere"),
    };
    set(&mut illumination["atmosphere"], key, json!(list));
}

fn optics(properties: &mut Value, value: &str) {
    let texts = [
        ("loam", "0.1,0.2;0.1,0.2;0,0"),
        ("bark", if value == "one-sided" { "0.15,0.3;0,0;0,0" } else { "0.15,0.3;0.15,0.3;0,0" }),
        ("leaf", "0.05,0.45;0.07,0.44;0.04,0.4"),
    ];
    for (name, text) in texts {
        let property = match value {
            "text" => json!(text),
            "prospect" => json!({ "value": text, "Type": 2, "ProspectDParams": { "N": 1.5 } }),
            _ => json!({ "value": text, "Type": 0 }),
        };
        set(properties, name, property);
    }
}

fn ground(terrain: &mut Value, kind: &str, value: &str) {
    match kind {
        "absent" => {}
        "RASTER" => {
            set(terrain, "terrain_type", json!("RASTER"));
            set(terrain, "terr_file", json!("D:\\Daten\\地形 1"));
        }
        "MESH" => {
            set(terrain, "terrain_type", json!("MESH"));
            set(terrain, "terr_file", json!("Ground Mesh.OBJ"));
        }
        "PLANE" => set(terrain, "terrain_type", json!("PLANE")),
        _ => {
            set(terrain, "terrain_type", json!("RASTER"));
            set(terrain, "terr_file", json!(""));
        }
    }
    match value {
        "absent" => {}
        "landcover" => {
            set(terrain, "landcover", json!("分类 1"));
            set(terrain, "terrBRDFType", json!("Lambertian"));
        }
        "bare Soilspect" => set(terrain, "terrBRDFType", json!("Soilspect")),
        "landalbedo" => {
            set(terrain, "terrBRDFType", json!("Land Albedo Map"));
            set(terrain, "landalbedo", json!("albedo"));
        }
        _ => set(terrain, "terrBRDFType", json!(value)),
    }
    if value == "Soilspect" {
        let parameters = json!({ "albedo": "0.45,0.6", "c1": "1.492", "c2": "0.56",
            "c3": "0.238", "c4": "-0.06", "h1": "1", "h2": "0.114" });
        set(terrain, "soilSpectParams", parameters);
    }
}

/// Writes the files beside `input.conf`.
fn files(parameters: &Path, objects: &str) {
    let write = |file: &str, text: &[u8]| fs::write(parameters.join(file), text).unwrap();
    let header = |samples: u32, data_type: u32| {
        format!(
            "ENVI\nsamples = {samples}\nlines = 1\nbands = 1\nheader offset = 0\n\
             data type = {data_type}\ninterleave = bsq\nbyte order = 0\n"
        )
    };
    let heights: Vec<u8> = [3.0_f32, 4.0].iter().flat_map(|height| height.to_le_bytes()).collect();
    write("地形 1", &heights);
    write("地形 1.hdr", header(2, 4).as_bytes());
    write("分类 1", &[1, 2]);
    write("分类 1.hdr", header(2, 1).as_bytes());
    write("landcover.txt", b"1 loam\r\n2 bark\r\n");
    write(
        "ground mesh.obj",
        b"# \xb5\xd8\nv 10 0 -5\nv -10 1 -5\nv -10 1 5\nv 10 0 5\nf 1 4 3\nf 1 3 2\n",
    );
    let crown =
        b"# \xc1\xd6\r\nv 0 2 -1\r\nv 1 4 -1\r\nv 1 4 1\r\nv 0 2 1\r\nf 1 2 3\r\nf 1 3 4\r\n";
    match objects {
        "trees" => {
            write("pine_crown.obj", crown);
            write("objects.txt", b"\xef\xbb\xbfpine pine_crown.obj leaf T300 0x00ff00\r\n");
            write("instances.txt", b"pine 5 2 0\r\npine 15 8 0 90\r\npine 10 5 0 3 8\r\n");
            write("hide_object.txt", b"gone\r\n");
        }
        "spaces" => {
            write("红 松_树 冠.obj", crown);
            write("objects.txt", "红 松 红 松_树 冠.obj leaf\n".as_bytes());
            write("instances.txt", "红 松 5 2 0\n".as_bytes());
            write("hide_object.txt", "红 松\n".as_bytes());
        }
        "no components" => {
            write("objects.txt", b"pine\n");
            write("instances.txt", b"pine 5 2 0\n");
        }
        _ => {}
    }
}

/// A folder with a project.
fn project(conf: &Value, objects: &str) -> TempDir {
    let folder = tempdir().unwrap();
    let parameters = folder.path().join("工程 1/Parameters");
    fs::create_dir_all(&parameters).unwrap();
    fs::write(parameters.join("input.conf"), format!("{conf:#}")).unwrap();
    files(&parameters, objects);
    folder
}

/// Exit code, stdout and stderr of a command.
struct Outcome {
    code: Option<i32>,
    printed: String,
    errors: String,
}

fn outcome(folder: &Path, arguments: &[&str]) -> Outcome {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let output = command.current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Outcome {
        code: output.status.code(),
        printed: text(output.stdout),
        errors: text(output.stderr),
    }
}

const SCENE: &str = "imported/工程 1/scene.ron";

/// Imports a project, checks and runs the scene, and returns what the import printed.
fn imported(folder: &TempDir, case: &str) -> String {
    let import = outcome(folder.path(), &["import-less", "工程 1"]);
    assert_eq!((import.code, import.errors.as_str()), (Some(0), ""), "{case}");
    let check = outcome(folder.path(), &["check", SCENE]);
    assert_eq!(check.code, Some(0), "{case}: {}", check.errors);
    let run = outcome(folder.path(), &["run", SCENE, "--out", "out", "--threads", "1"]);
    assert_eq!(run.code, Some(0), "{case}: {}", run.errors);
    import.printed
}

#[test]
fn every_pair_of_choices_is_imported_checked_and_run() {
    let cases = pairs();
    assert!(cases.len() >= 40, "{} cases hold every pair", cases.len());
    for case in cases {
        let index = |name: &str| CHOICES.iter().position(|(choice, _)| *choice == name).unwrap();
        let value = |name: &str| CHOICES[index(name)].1[case[index(name)]];
        let shown: Vec<_> =
            CHOICES.iter().map(|(name, _)| format!("{name} {}", value(name))).collect();
        let shown = shown.join(", ");
        let folder = project(&settings(value), value("objects"));
        let printed = imported(&folder, &shown);
        // A surface that stands in for another is never silent.
        let is_covered = value("ground") == "landcover" && value("terrain") != "MESH";
        let stands_in = value("ground") == "landalbedo";
        assert_eq!(printed.contains("STAND-IN"), stands_in && !is_covered, "{shown}: {printed}");
    }
}

/// Paths of all values in a JSON document.
fn paths(value: &Value, path: &mut Vec<String>, found: &mut Vec<Vec<String>>) {
    if let Some(entries) = value.as_object() {
        for (key, value) in entries {
            path.push(key.clone());
            found.push(path.clone());
            paths(value, path, found);
            path.pop();
        }
    }
}

fn parent<'a>(conf: &'a mut Value, path: &[String]) -> &'a mut Map<String, Value> {
    let (_, above) = path.split_last().unwrap();
    let node = above.iter().fold(conf, |node, key| &mut node[key.as_str()]);
    node.as_object_mut().unwrap()
}

/// *Projects*: a key deleted, null, empty, -1, of another type, or beyond reason, one at a time.
/// *Expected*: a scene that `check` accepts, or one error that names the file and the key.
#[test]
fn a_key_that_is_not_as_expected_is_noted_or_one_error() {
    let wrong = [
        Value::Null,
        json!(""),
        json!(-1),
        json!("many"),
        json!(true),
        json!([]),
        json!({ "a": 1 }),
        json!(1e300),
    ];
    let mut faults = Vec::new();
    for (sensor, plane) in [("perspective", "absent"), ("PhotonTracing", "whole")] {
        let value = |name: &str| match name {
            "sensor" => sensor,
            "plane" => plane,
            "products" => "all",
            "terrain" => "RASTER",
            "ground" => "Soilspect",
            "sky" => "some",
            "depth" => "5",
            "objects" => "trees",
            _ => "true",
        };
        let conf = settings(value);
        let mut all = Vec::new();
        paths(&conf, &mut Vec::new(), &mut all);
        assert!(all.len() > 50, "{} keys", all.len());
        // The second project differs from the first in its sensor alone.
        all.retain(|path| sensor == "perspective" || path[0] == "sensor");
        for path in all {
            let key = path.last().unwrap();
            let shown = path.join(".");
            let mut deleted = conf.clone();
            parent(&mut deleted, &path).remove(key);
            faults.extend(mutant(&deleted, &format!("{shown} deleted"), &shown));
            for value in &wrong {
                let mut changed = conf.clone();
                parent(&mut changed, &path).insert(key.clone(), value.clone());
                faults.extend(mutant(&changed, &format!("{shown}: {value}"), &shown));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The reason why the import of a project is not as it should be.
fn mutant(conf: &Value, case: &str, path: &str) -> Option<String> {
    let folder = project(conf, "trees");
    let Outcome { code, errors, .. } = outcome(folder.path(), &["import-less", "工程 1"]);
    let is_there = folder.path().join("imported/工程 1").exists();
    if code == Some(0) {
        let is_sound = folder.path().join(SCENE).exists() && errors.is_empty();
        return (!is_sound).then(|| format!("{case}: success with {errors}"));
    }
    // The key that is wrong, or the one that refers to it.
    let names = [path, path.rsplit('.').next().unwrap()];
    let fault = if code != Some(1) {
        format!("exit code {code:?}")
    } else if is_there {
        "a half import is left".to_owned()
    } else if errors.matches("error").count() != 1 {
        "not one error".to_owned()
    } else if !errors.contains("工程 1/Parameters/") {
        "no file is named".to_owned()
    } else if !names.iter().any(|name| errors.contains(name)) {
        "no key is named".to_owned()
    } else {
        return None;
    };
    Some(format!("{case}: {fault}: {errors}"))
}
