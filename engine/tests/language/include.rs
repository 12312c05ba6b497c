//! Files that include others: what their definitions are called, whose value counts, and what a
//! person reads where it goes wrong.

#![allow(clippy::float_cmp, reason = "these numbers come from the same decimals")]

use std::path::Path;

use sunfleck::document::{
    Include, Instances, Lambertian, Leaf, Map, Material, MeshFile, Param, ReadOptions, Reading,
    Ref, Scene, Sensor, Spectrum, TabulatedSpectrum, Terrain, TerrainPlane, read_file,
};

/// A species as one keeps it in a library.
const BIRCH: &str = r#"Library(
    params: { "lai": 3.0, "radius": "=lai / 100" },
    spectra: { "bark": Table(file: "../spectra/bark.csv") },
    materials: {
        "leaf": Leaf(reflectance: Constant("=lai / 10"), transmittance: Constant(0.1)),
        "bark": Lambertian(reflectance: Named("bark")),
    },
    meshes: {
        "tree": Obj(file: "birch.obj", up: Z, unit_m: 1.0, parts: { "trunk": "bark" }, material: "leaf"),
        "crown": Crown(
            shape: Cone(diameter_m: 1.0, height_m: 1.0), base_m: 1.0, leaf_area_m2: "=lai",
            leaf: Disc(radius_m: "=radius"), leaf_material: "leaf",
        ),
    },
    instances: [List(of: "tree", at_m: [(1.0, 1.0, 0.0)])],
    sensors: { "up": Directions(views: CrossPlane) },
    variants: { "winter": { "lai": 0.5 } },
)"#;

const SITE: &str = r#"(
    format: 1,
    bands: [(name: "red", center_nm: 660.0)],
    params: { "sza": 10.0 },
    materials: { "soil": Lambertian(reflectance: Constant(0.2)) },
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
    sun: (zenith_deg: "=sza"),
)"#;

const STAND: &str = r#"Scene(
    format: 1,
    params: { "lai": 5.0 },
    include: {
        "site": "site.ron",
        "birch": (file: "species/birch.ron", params: { "lai": "=lai - 1" }),
        "bare": (file: "species/birch.ron", variant: "winter"),
    },
    instances: [List(of: "birch.crown", at_m: [(2.0, 2.0, 0.0)])],
    sensors: { "albedo": Photons },
)"#;

struct Folder(tempfile::TempDir);

impl Folder {
    fn with(files: &[(&str, &str)]) -> Self {
        let folder = Self(tempfile::tempdir().expect("a folder"));
        for (name, text) in files {
            let path = folder.0.path().join(name);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            std::fs::write(path, text).expect("a file");
        }
        folder
    }

    fn read(&self, options: &ReadOptions) -> Reading {
        read_file(&self.0.path().join("stand.ron"), options).expect("a text")
    }

    fn sound(&self, options: &ReadOptions) -> Scene {
        let reading = self.read(options);
        assert!(reading.is_sound(), "{}", reading.render());
        reading.scene
    }

    /// What a person reads, without the folder's name.
    fn shown(&self) -> String {
        let root = format!("{}/", self.0.path().display());
        let text = match read_file(&self.0.path().join("stand.ron"), &ReadOptions::default()) {
            Ok(reading) => reading.render(),
            Err(error) => format!("error: {error}\n"),
        };
        text.replace(&root, "")
    }
}

fn library() -> Folder {
    Folder::with(&[("stand.ron", STAND), ("site.ron", SITE), ("species/birch.ron", BIRCH)])
}

fn set(name: &str, value: f64) -> (String, Param) {
    (name.to_owned(), value.into())
}

/// What the leaves of an included birch reflect.
fn leaf(scene: &Scene, name: &str) -> f64 {
    match &scene.materials[name] {
        Material::Leaf(Leaf { reflectance: Spectrum::Constant(value), .. }) => *value,
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_is_included_has_names_of_its_own_and_paths_of_the_scene() {
    let scene = library().sound(&ReadOptions::default());
    assert!(scene.include.is_empty());
    let materials: Vec<_> = scene.materials.keys().map(String::as_str).collect();
    assert_eq!(materials, ["site.soil", "birch.leaf", "birch.bark", "bare.leaf", "bare.bark"]);
    let Some(MeshFile { file, parts, material, .. }) = scene.meshes["birch.tree"].mesh_file()
    else {
        panic!()
    };
    assert_eq!(file, "species/birch.obj");
    assert_eq!(parts["trunk"], "birch.bark");
    assert_eq!(material.map(Ref::as_str), Some("birch.leaf"));
    assert!(
        matches!(&scene.spectra["bare.bark"], Spectrum::Table(TabulatedSpectrum { source, .. })
        if source.file == "species/../spectra/bark.csv")
    );
    assert!(
        matches!(&scene.materials["birch.bark"], Material::Lambertian(Lambertian { reflectance, .. })
        if *reflectance == Spectrum::Named("birch.bark".into()))
    );
    assert!(
        matches!(&scene.terrain, Terrain::Plane(TerrainPlane { material, .. }) if material == "site.soil")
    );
    let of: Vec<&str> = scene.instances.iter().flat_map(Instances::meshes).collect();
    assert_eq!(of, ["birch.crown", "birch.tree", "bare.tree"], "the scene's own first");
    assert!(matches!(scene.sensors["birch.up"], Sensor::Directions(_)));
}

/// File, variant of the include, parameters of the include, variant of the scene, point, `--set`.
#[test]
fn parameters_are_taken_from_the_nearest() {
    let folder = library();
    let leaves = |options: &ReadOptions| {
        let scene = folder.sound(options);
        [leaf(&scene, "birch.leaf"), leaf(&scene, "bare.leaf")]
    };
    let mut options = ReadOptions::default();
    assert_eq!(leaves(&options), [0.4, 0.05], "passed as a formula; the variant of the file");
    options.variant = Some("bare.winter".to_owned());
    assert_eq!(leaves(&options), [0.4, 0.05]);
    options.variant = Some("birch.winter".to_owned());
    assert_eq!(leaves(&options), [0.05, 0.05], "a variant of the scene goes before what is passed");
    options.point = vec![set("birch.lai", 2.0)];
    assert_eq!(leaves(&options), [0.2, 0.05]);
    options.set = vec![set("birch.lai", 1.0), set("bare.lai", 6.0)];
    assert_eq!(leaves(&options), [0.1, 0.6]);
    let scene = folder.sound(&ReadOptions { set: vec![set("lai", 3.0)], ..ReadOptions::default() });
    assert_eq!(leaf(&scene, "birch.leaf"), 0.2, "what is passed follows the scene's own parameter");
    assert_eq!(
        scene.params["birch.radius"],
        Param::Number(0.02),
        "and the file's formulas follow what is passed"
    );
}

#[test]
fn what_stands_closer_to_the_scene_goes_first() {
    let inner = r#"(
        materials: { "soil": Lambertian(reflectance: Constant(0.1)) },
        boundary: Periodic,
        sky: Fraction([0.5]),
    )"#;
    let site =
        SITE.replace("format: 1,", r#"include: { "deep": "inner.ron" }, boundary: Isolated,"#);
    let stand = r#"(
        format: 1,
        include: { "site": "site.ron" },
        materials: { "site.deep.soil": Lambertian(reflectance: Constant(0.9)) },
        sensors: { "albedo": Photons },
    )"#;
    let folder = Folder::with(&[("stand.ron", stand), ("site.ron", &site), ("inner.ron", inner)]);
    let scene = folder.sound(&ReadOptions::default());
    let Material::Lambertian(Lambertian { reflectance, .. }) = &scene.materials["site.deep.soil"]
    else {
        panic!()
    };
    assert_eq!(*reflectance, Spectrum::Constant(0.9));
    assert_eq!(scene.boundary, sunfleck::document::Boundary::Isolated);
    assert_eq!(scene.sky, sunfleck::document::Sky::Fraction(vec![0.5]));
}

#[test]
fn a_scene_built_in_rust_includes_files_as_well() {
    let folder = library();
    let path = folder.0.path().join("stand.ron");
    let mut built = read_file(&path, &ReadOptions::default()).expect("a scene").scene;
    let include = |params: Map<Param>| Include {
        file: "species/birch.ron".to_owned(),
        params,
        variant: None,
    };
    built.include.insert("oak".to_owned(), include(Map::from([set("lai", 7.0)])));
    std::fs::write(&path, built.to_ron()).expect("a file");
    let scene = folder.sound(&ReadOptions::default());
    assert_eq!(leaf(&scene, "oak.leaf"), 0.7);
    assert_eq!(leaf(&scene, "birch.leaf"), 0.4);
}

/// What is wrong in an included file is shown there.
#[test]
fn errors_stand_in_their_own_files() {
    let birch = BIRCH
        .replace("\"=lai / 10\"", "\"=lay / 10\"")
        .replace("parts: { \"trunk\": \"bark\" }", "parts: { \"trunk\": \"barc\" }")
        .replace("height_m: 1.0", "height_m: -1.0")
        .replace("instances:", "instanzes:");
    let folder =
        Folder::with(&[("stand.ron", STAND), ("site.ron", SITE), ("species/birch.ron", &birch)]);
    insta::assert_snapshot!("errors_in_an_included_file", folder.shown());
}

macro_rules! wrong {
    ($($name:ident: $files:expr;)*) => {
        $(#[test]
        fn $name() {
            let shown = Folder::with(&$files).shown();
            insta::assert_snapshot!(stringify!($name), shown);
        })*
    };
}

wrong! {
    include_of_itself: [
        ("stand.ron", r#"(format: 1, include: { "me": "stand.ron" })"#),
    ];
    include_in_a_circle: [
        ("stand.ron", r#"(format: 1, include: { "a": "x/a.ron" })"#),
        ("x/a.ron", r#"(include: { "b": "../b.ron" })"#),
        ("b.ron", "(\n  include: {\n    \"c\": \"./x/../x/a.ron\",\n  },\n)"),
    ];
    include_of_what_is_not_there: [
        ("stand.ron", r#"(format: 1, include: {
            "a": "a.ron", "folder": "x", "utf16": "utf16.ron", "cut": "cut.ron", "empty": "empty.ron",
            "list": "list.ron", "1a": "cut.ron", "b": 3, "c": (path: "a.ron"), "d": "x/deep.ron",
        })"#),
        ("x/deep.ron", "(include: { \"gone\": \"gone.ron\" })"),
        ("utf16.ron", "\0S\0c\0e\0n\0e"),
        ("cut.ron", "Library(\n    materials: {\n        \"leaf\": Leaf(reflect"),
        ("empty.ron", " \n"),
        ("list.ron", "[1, 2]"),
    ];
    include_with_what_the_file_has_not: [
        ("stand.ron", &STAND.replace("{ \"lai\": \"=lai - 1\" }", "{ \"lay\": \"=lai - one\" }")
            .replace("winter", "wintr")),
        ("site.ron", SITE),
        ("species/birch.ron", BIRCH),
    ];
    included_keys_twice: [
        ("stand.ron", r#"(format: 1, include: { "a": "site.ron", "b": "site.ron" }, sensors: { "x": Photons })"#),
        ("site.ron", SITE),
    ];
    included_names_that_are_wrong: [
        ("stand.ron", &STAND.replace("birch.crown", "birch.crwon").replace("=lai - 1", "=birch.lay")),
        ("site.ron", &SITE.replace("format: 1", "format: 2")),
        ("species/birch.ron", BIRCH),
    ];
}

#[test]
fn files_that_include_ever_more_files_come_to_an_end() {
    // Each file includes the next one twice: a million files, were there no limit.
    let mut files = vec![("stand.ron".to_owned(), "f0.ron".to_owned())];
    files.extend((0..20).map(|index| (format!("f{index}.ron"), format!("f{}.ron", index + 1))));
    let texts: Vec<_> = files
        .iter()
        .map(|(name, next)| {
            (name.as_str(), format!(r#"(include: {{ "a": "{next}", "b": "{next}" }})"#))
        })
        .chain([("f20.ron", "()".to_owned())])
        .collect();
    let texts: Vec<_> = texts.iter().map(|(name, text)| (*name, text.as_str())).collect();
    let shown = Folder::with(&texts).shown();
    assert!(shown.starts_with("error: more than 1000 files are included"), "{shown}");
    assert_eq!(shown.matches("error:").count(), 1, "{shown}");

    let chain: Vec<_> = (0..40)
        .map(|index| {
            (format!("f{index}.ron"), format!(r#"(include: {{ "a": "f{}.ron" }})"#, index + 1))
        })
        .collect();
    let mut texts = vec![("stand.ron", r#"(include: { "a": "f0.ron" })"#)];
    texts.extend(chain.iter().map(|(name, text)| (name.as_str(), text.as_str())));
    let shown = Folder::with(&texts).shown();
    assert!(shown.starts_with("error: files include others more than 32 deep here"), "{shown}");
}

#[test]
fn a_device_that_never_ends_is_no_file() {
    if !Path::new("/dev/zero").exists() {
        return;
    }
    let shown = Folder::with(&[("stand.ron", r#"(include: { "a": "/dev/zero" })"#)]).shown();
    assert!(shown.starts_with("error: /dev/zero is neither a file nor a folder"), "{shown}");
    let error = read_file(Path::new("/dev/zero"), &ReadOptions::default()).expect_err("no scene");
    assert!(error.to_string().contains("more than the"), "{error}");
}

#[test]
fn patterns_of_an_included_file_are_of_its_own_names() {
    let plot = r#"Library(
        materials: { "leaf": Lambertian(reflectance: Constant(0.2)) },
        meshes: { "oak": Obj(file: "oak.obj", up: Z, unit_m: 1.0, material: "leaf") },
        terrain: Mesh(mesh: "oak"),
        instances: [List(of: "oak", at_m: [(1.0, 1.0, 0.0)], name: "row")],
        hide: ["oak", "row*/o*"],
    )"#;
    let stand = r#"Scene(
        format: 1, include: { "plot": "plot.ron" },
        bands: [(name: "red", center_nm: 660.0)], sun: (zenith_deg: 30.0), sensors: { "albedo": Photons },
    )"#;
    let folder = Folder::with(&[("plot.ron", plot), ("stand.ron", stand)]);
    let scene = folder.sound(&ReadOptions::default());
    assert_eq!(scene.hide, ["plot.oak", "plot.row*/plot.o*"]);
    assert!(matches!(&scene.terrain, Terrain::Mesh { mesh, .. } if mesh == "plot.oak"));
}

/// The second `include` is refused at its place, and what is read is a scene that can be written.
#[test]
fn files_are_included_by_one_key() {
    let folder = Folder::with(&[("lib.ron", BIRCH)]);
    let twice = SITE.replace(
        "params: {",
        "include: { \"a\": \"lib.ron\" }, include: { \"\": (params: {}) }, params: {",
    );
    std::fs::write(folder.0.path().join("stand.ron"), twice).expect("a file");
    let reading = folder.read(&ReadOptions::default());
    let shown = reading.render();
    assert!(shown.contains("the key `include` is given twice"), "{shown}");
    assert!(shown.contains("stand.ron:4:"), "{shown}");
    assert!(reading.scene.include.is_empty() && reading.scene.materials.contains_key("a.leaf"));
    let again = sunfleck::document::read_text(
        "again.ron",
        &reading.scene.to_ron(),
        &ReadOptions::default(),
    );
    assert_eq!(again.expect("RON").scene, reading.scene);
}

/// A text that is passed stands for a string of the file that uses it: its names and paths are its own.
#[test]
fn texts_are_qualified_by_the_file_that_uses_them() {
    let library = r#"Library(
        params: { "spectrum": "dry.csv", "of": "oak" },
        materials: {
            "leaf": Lambertian(reflectance: Table(file: "=spectrum")),
            "bark": Lambertian(reflectance: Named("=of")),
        },
        spectra: { "oak": Constant(0.2), "birch": Constant(0.3) },
        meshes: { "tree": Faces(faces_m: [[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]], material: "leaf") },
        instances: [List(of: "tree", at_m: [(1.0, 1.0, 0.0)])],
    )"#;
    let scene = r#"Scene(
        format: 1,
        params: { "chosen": "birch" },
        include: { "a": (file: "species/a.ron", params: { "spectrum": "../wet.csv", "of": "=chosen" }) },
        bands: [(name: "red", center_nm: 660.0)],
        terrain: Plane(size_m: (9.0, 9.0), material: "a.leaf"),
        sun: (zenith_deg: 30.0),
        sensors: { "v": Directions(views: PrincipalPlane) },
    )"#;
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("species")).expect("a folder");
    std::fs::write(folder.path().join("species/a.ron"), library).expect("a file");
    std::fs::write(folder.path().join("scene.ron"), scene).expect("a file");
    let reading =
        read_file(&folder.path().join("scene.ron"), &ReadOptions::default()).expect("a scene");
    assert!(reading.is_sound(), "{}", reading.render());
    let reflectance = |name: &str| match &reading.scene.materials[name] {
        Material::Lambertian(Lambertian { reflectance, .. }) => reflectance.clone(),
        other => panic!("{other:?}"),
    };
    let Spectrum::Table(TabulatedSpectrum { source, .. }) = reflectance("a.leaf") else {
        panic!("a table")
    };
    assert_eq!(source.file, "species/../wet.csv");
    assert_eq!(reflectance("a.bark"), Spectrum::Named("a.birch".into()));
}
