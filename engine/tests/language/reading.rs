//! Reading, and what is read of every way to write it.

use std::io::Write as _;

use sunfleck::document::{
    Boundary, Diagnostic, Lambertian, Map, Material, Photons, Prototype, ReadError, ReadOptions,
    Reading, Scene, ScenePath, Sensor, Sky, Spectrum, Sun, TabulatedSpectrum, check, nearest,
    read_file, read_text, unknown_name,
};

const DESIGN: &str = include_str!("design.ron");

/// As little as a scene can say; `RED` and `MORE` stand for a reflectance and for more keys.
const SMALL: &str = r#"Scene(
    format: 1,
    bands: [(name: "red", center_nm: 660.0)],
    materials: { "soil": Lambertian(reflectance: Constant(RED)) },
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
    sun: (zenith_deg: 30.0),
    sensors: { "albedo": Photons },
    MORE
)"#;

fn read_with(text: &str, options: &ReadOptions) -> Reading {
    read_text("scene.ron", text, options).unwrap_or_else(|error| panic!("{error}"))
}

fn read(text: &str) -> Reading {
    read_with(text, &ReadOptions::default())
}

fn sound(text: &str) -> Scene {
    let reading = read(text);
    assert!(reading.is_sound(), "{}", reading.render());
    reading.scene
}

fn small(red: &str, more: &str) -> String {
    SMALL.replace("RED", red).replace("MORE", more)
}

/// What the scene says the soil reflects.
fn red(scene: &Scene) -> f64 {
    match &scene.materials["soil"] {
        Material::Lambertian(Lambertian { reflectance: Spectrum::Constant(value), .. }) => *value,
        other => panic!("{other:?}"),
    }
}

fn options(set: &[(&str, f64)], variant: Option<&str>) -> ReadOptions {
    let set = set.iter().map(|&(name, value)| (name.to_owned(), value.into())).collect();
    ReadOptions { set, variant: variant.map(str::to_owned), ..ReadOptions::default() }
}

fn messages(found: &[Diagnostic]) -> Vec<String> {
    found.iter().map(|one| format!("{}: {}", one.path, one.message)).collect()
}

#[test]
fn the_example_of_the_design_reads_as_written() {
    let scene = sound(DESIGN);
    assert_eq!(scene.title, "Birch stand");
    assert_eq!(scene.bands[1].name, "nir");
    let reflectance = Spectrum::Named("soil".into());
    assert_eq!(
        scene.materials["soil"],
        Material::Lambertian(Lambertian { reflectance, back_reflectance: None, temperature: None })
    );
    let irradiance = Spectrum::Bands(vec![1.0, 1.0]);
    let sun = Sun {
        zenith_deg: Some(30.0),
        azimuth_deg: 270.0,
        position: None,
        disc_deg: 0.0,
        irradiance,
    };
    assert_eq!(scene.sun, Some(sun));
    assert_eq!(scene.sky, Sky::Fraction(vec![0.1, 0.05]));
    assert_eq!(scene.boundary, Boundary::Periodic);
    let names: Vec<_> = scene.sensors.keys().collect();
    assert_eq!(names, ["nadir", "brf", "flux"]);
    assert!(matches!(scene.sensors["flux"], Sensor::Photons(Photons { per_m2: 2500.0, .. })));
    assert_eq!(scene.variants["winter"]["lai_scale"], 0.2.into());
}

#[test]
fn keys_that_are_left_out_have_their_defaults() {
    let scene = sound(&small("0.2", ""));
    let irradiance = Spectrum::AstmG173;
    let sun =
        Sun { zenith_deg: Some(30.0), azimuth_deg: 0.0, position: None, disc_deg: 0.0, irradiance };
    assert_eq!(scene.sun, Some(sun));
    assert_eq!(scene.transport.roulette.after_order, 5);
    assert!(matches!(scene.sensors["albedo"], Sensor::Photons(Photons { per_m2: 1000.0, .. })));
}

#[test]
fn one_value_may_be_written_in_many_ways() {
    let same = sound(&small("0.25", ""));
    let ways = [
        "2.5e-1",
        ".25",
        "0.25_0",
        "+0.25",
        "25E-2",
        "/* a /* nested */ one */ 0.25 // and this\n",
        "\"=1/4\"",
        "r\"=0.25\"",
        "r#\"=0.5^2\"#",
        "\"= 0.25\"",
    ];
    for way in ways {
        assert_eq!(sound(&small(way, "")), same, "{way}");
    }
    let text = small("0.25", "");
    assert_eq!(sound(text.trim_start_matches("Scene")), same, "the scene's name may be left out");
    assert_eq!(sound(&format!("\u{feff}#![enable(implicit_some)]\n{text}")), same);
    assert_eq!(sound(&text.replace('\n', "\r\n")), same);
    assert_eq!(
        sound(&text.replace("sun: (zenith_deg: 30.0)", "sun: Some(Sun(zenith_deg: 30))")),
        same
    );
    assert_eq!(sound(&text.replace("Photons", "Photons()")), same);
    assert_eq!(sound(&small("0.25", "sky: None")), same);
}

#[test]
fn strings_and_whole_numbers_may_be_written_in_many_ways() {
    let title = |literal: &str| sound(&small("0", &format!("title: {literal}"))).title;
    assert_eq!(title(r#""a \"b\" \\ \n \u{e9} \x41 \' /""#), "a \"b\" \\ \n é A ' /");
    assert_eq!(title("r#\"C:\\trees \"old\"\"#"), r#"C:\trees "old""#);
    assert_eq!(title("\"two\nlines\""), "two\nlines");
    assert_eq!(title("\"=not a formula\""), "=not a formula", "a title is what it says");
    let seed =
        |literal: &str| sound(&small("0", &format!("transport: (seed: {literal})"))).transport.seed;
    let ways = ["1_000", "0x3E8", "0b11_1110_1000", "0o1750", "+1000", "\"=10^3\"", "\"=4e3/4\""];
    for way in ways {
        assert_eq!(seed(way), 1000, "{way}");
    }
    assert_eq!(seed("18446744073709551615"), u64::MAX);
}

#[test]
fn params_are_those_of_the_file_then_of_the_variant_then_of_the_options() {
    let text = small(
        "\"=rho\"",
        "params: { \"base\": 0.1, \"rho\": \"=base * 2\", \"other\": 1 }, \
         variants: { \"wet\": { \"base\": 0.05 }, \"snow\": { \"rho\": 0.9 } }",
    );
    let red = |set: &[(&str, f64)], variant| {
        let reading = read_with(&text, &options(set, variant));
        assert!(reading.is_sound(), "{}", reading.render());
        red(&reading.scene)
    };
    assert_eq!(red(&[], None).to_bits(), 0.2_f64.to_bits());
    assert_eq!(red(&[], Some("wet")).to_bits(), 0.1_f64.to_bits(), "`rho` follows `base`");
    assert_eq!(red(&[], Some("snow")).to_bits(), 0.9_f64.to_bits());
    assert_eq!(red(&[("rho", 0.7)], Some("snow")).to_bits(), 0.7_f64.to_bits());
    assert_eq!(red(&[("base", 0.3)], Some("wet")).to_bits(), 0.6_f64.to_bits());
    assert_eq!(red(&[("rho", 0.7), ("rho", 0.4)], None).to_bits(), 0.4_f64.to_bits());
}

#[test]
fn unknown_params_and_variants_of_the_options_are_errors() {
    let text = small("\"=rho\"", "params: { \"rho\": 0.1 }, variants: { \"winter\": {} }");
    let reading = read_with(&text, &options(&[("roh", 0.2)], Some("wintr")));
    assert_eq!(
        messages(&reading.diagnostics),
        ["params: no parameter `roh` to set", "variants: no variant `wintr`"]
    );
    let help: Vec<_> = reading.diagnostics.iter().filter_map(|one| one.help.as_deref()).collect();
    assert_eq!(
        help,
        [
            "did you mean `rho`? this scene defines: rho",
            "did you mean `winter`? this scene defines: winter"
        ]
    );
    let reading = read_with(&text, &options(&[("rho", f64::NAN)], None));
    assert!(!reading.is_sound());
    let reading = read_with(&small("0.1", ""), &options(&[("rho", 0.2)], Some("winter")));
    let help: Vec<_> = reading.diagnostics.iter().filter_map(|one| one.help.as_deref()).collect();
    assert_eq!(help, ["this scene defines no variant", "this scene defines no parameter"]);
}

#[test]
fn a_path_leads_to_its_place_or_to_its_nearest_ancestor() {
    let text = DESIGN
        .replace("\"tree\": Obj", "\"birch\": Obj")
        .replace("\"crown\": Discs", "\"birch.crown\": Discs");
    let source = read(&text).source;
    let at = |path: ScenePath| {
        let place = source.place(&path).unwrap_or_else(|| panic!("{path} has no place"));
        &source.text()[place.span.range()]
    };
    let [sensors, instances, meshes, sky] =
        ["sensors", "instances", "meshes", "sky"].map(ScenePath::from);
    let nadir = sensors.name("nadir");
    let place = source.place(&nadir).expect("a place");
    assert_eq!((place.file.as_str(), place.line, place.column), ("scene.ron", 25, 18));
    assert_eq!(at(nadir.key("size_px")), "(256, 256)");
    assert_eq!(at(nadir.key("size_px").index(1)), "256");
    assert_eq!(at(instances.index(1).key("of")), "\"crown\"");
    assert_eq!(at(instances.index(1).key("at_m").index(0).index(2)), "4.0");
    assert_eq!(at(sky.clone()), "Fraction([0.1, 0.05])");
    assert_eq!(at(sky.index(1)), "0.05");
    let leaf = ScenePath::from("materials").name("leaf");
    assert_eq!(at(leaf.key("reflectance").index(0)), "0.0546");
    assert_eq!(at(sensors.name("flux").key("measure").index(2).key("layer_m")), "1.0");
    assert_eq!(at(meshes.name("birch.crown").key("material")), "\"leaf\"", "names may hold dots");
    assert_eq!(at(meshes.name("birch").key("origin")), "Obj", "not written: its owner");
    assert_eq!(at(instances.index(7).key("of")), "[");
    assert_eq!(at(["nowhere", "at", "all"].into()), "Scene");
    assert_eq!(at(ScenePath::root()), "Scene");
}

/// One definition cannot be read, all others have values that are wrong.
#[test]
fn each_error_is_at_its_own_definition_whatever_names_hold() {
    let names = ["a", "a.b", "a[0]", "a.reflectance", "b.a", "]"];
    for unreadable in names {
        let soils = names.map(|name| {
            let value = if name == unreadable { "Constat(0.1)" } else { "Constant(7.0)" };
            format!("\n{name:?}: Lambertian(reflectance: {value}),")
        });
        let materials = format!("materials: {{{}", soils.concat());
        let found = read(&small("0.1", "").replace("materials: {", &materials)).diagnostics;
        let line = |one: &Diagnostic| one.place.as_ref().expect("a place").line;
        let found: Vec<_> = found.into_iter().map(|one| (line(&one), one.path)).collect();
        let path = |name| ScenePath::from("materials").name(name).key("reflectance");
        let expected: Vec<_> = (5..).zip(names.map(path)).collect();
        assert_eq!(found, expected, "{unreadable}");
    }
}

#[test]
fn a_diagnostic_without_a_place_is_shown_where_its_path_leads() {
    let source = read(DESIGN).source;
    let found = [
        unknown_name(["terrain", "material"], "material", "sol", ["soil", "leaf"]),
        Diagnostic::warning(ScenePath::root(), "this is slow").help("use fewer samples"),
    ];
    insta::assert_snapshot!(source.render(&found), @r#"
    error: no material `sol`
      --> scene.ron:16:54 (terrain.material)
         |
      16 |     terrain: Plane(size_m: (100.0, 100.0), material: "soil"),
         |                                                      ^^^^^^
         = help: did you mean `soil`? this scene defines: soil, leaf

    warning: this is slow
      --> scene.ron
         = help: use fewer samples
    "#);
}

#[test]
fn a_scene_built_in_rust_is_checked_without_a_file() {
    let mut scene = sound(DESIGN);
    assert_eq!(check(&scene), []);
    scene.bands[0].center_nm = Some(f64::NAN);
    scene.frame.origin_m.2 = f64::INFINITY;
    if let Some(Prototype::Discs { material, .. }) = scene.meshes.get_mut("crown") {
        *material = "laef".into();
    }
    assert_eq!(
        messages(&check(&scene)),
        [
            "bands[0].center_nm: expected a number above 0, found NaN",
            "meshes.crown.material: no material `laef`",
            "frame.origin_m: expected a finite number, found inf",
        ]
    );
}

#[test]
fn what_could_not_be_read_is_not_checked_as_well() {
    let broken = DESIGN
        .replace("\"leaf\": Leaf(", "\"leaf\": Laef(")
        .replace("bands: [", "bands: 3, title: [")
        .replace("size_m: (100.0, 100.0)", "size_m: (\"wide\", 100.0)");
    let found = read(&broken).diagnostics;
    let paths: Vec<_> = found.iter().map(|one| one.path.to_string()).collect();
    assert_eq!(paths, ["bands", "title", "materials.leaf", "terrain.size_m[0]"]);
}

#[test]
fn files_that_hold_no_scene_are_errors_that_say_why() {
    let folder = tempfile::tempdir().expect("a folder");
    let error = |bytes: Option<&[u8]>| {
        let path = folder.path().join("scene.ron");
        if let Some(bytes) = bytes {
            std::fs::write(&path, bytes).expect("written");
        }
        let error = read_file(&path, &ReadOptions::default()).expect_err("no scene");
        error.to_string().replace(&folder.path().display().to_string(), "..")
    };
    assert_eq!(error(None), "there is no file ../scene.ron");
    assert_eq!(
        error(Some(b" \n")),
        "../scene.ron is empty: a scene starts with `Scene(` and ends with `)`"
    );
    assert_eq!(
        error(Some(b"\xff\xfeS\0c\0")),
        "../scene.ron is UTF-16 text, not UTF-8 text: save it as UTF-8"
    );
    assert_eq!(
        error(Some(b"S\0c\0e\0")),
        "../scene.ron is UTF-16 or binary, not UTF-8 text: save it as UTF-8"
    );
    assert_eq!(
        error(Some(b"Scene(\n title: \"Bl\xe4tter\")")),
        "../scene.ron is something else from line 2 on, not UTF-8 text: save it as UTF-8"
    );
    let error = read_file(folder.path(), &ReadOptions::default()).expect_err("no scene");
    assert!(matches!(error, ReadError::Folder { .. }), "{error}");
    let large = folder.path().join("large.ron");
    let file = std::fs::File::create(&large).expect("created");
    file.set_len(300 << 20).expect("a sparse file");
    let error = read_file(&large, &ReadOptions::default()).expect_err("no scene");
    assert!(matches!(error, ReadError::TooLarge { .. }), "{error}");
    let mut file = std::fs::File::create(&large).expect("created");
    file.write_all(small("0.2", "").as_bytes()).expect("written");
    drop(file);
    assert!(read_file(&large, &ReadOptions::default()).expect("a scene").is_sound());
}

#[test]
fn nearest_names_are_offered_to_other_stages_too() {
    assert_eq!(nearest("laef", ["bark", "leaf"]), Some("leaf"));
    assert_eq!(nearest("granite", ["bark", "leaf"]), None);
}

/// Texts in `params` stand for strings, in every way that parameters get their values.
#[test]
fn parameters_may_be_texts() {
    let text = r#"Scene(
        format: 1,
        params: { "soil": "dry.csv", "kind": "tree", "n": 2.0, "alias": "=soil" },
        bands: [(name: "red", center_nm: 660.0)],
        materials: { "soil": Lambertian(reflectance: Table(file: "=soil", value: "=alias")) },
        meshes: { "tree": Faces(faces_m: [[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]], material: "soil") },
        terrain: Plane(size_m: (9.0, 9.0), material: "soil"),
        instances: [List(of: "=kind", at_m: [("=n", 1.0, 0.0)])],
        sun: (zenith_deg: 30.0),
        sensors: { "v": Directions(views: PrincipalPlane) },
        variants: { "wet": { "soil": "wet.csv" } },
        sweep: Grid({ "soil": ["a.csv", "b.csv"], "n": [1.0, 2.0] }),
    )"#;
    let read = |options: &ReadOptions| read_text("scene.ron", text, options).expect("RON");
    let files = |options: &ReadOptions| {
        let reading = read(options);
        assert!(reading.is_sound(), "{}", reading.render());
        let Material::Lambertian(Lambertian {
            reflectance: Spectrum::Table(TabulatedSpectrum { source, .. }),
            ..
        }) = &reading.scene.materials["soil"]
        else {
            panic!("a table")
        };
        assert_eq!(reading.scene.instances[0].meshes(), ["tree"]);
        (source.file.clone(), source.value.clone())
    };
    let both = |name: &str| (name.into(), Some(name.to_owned()));
    assert_eq!(files(&ReadOptions::default()), both("dry.csv"));
    let wet = ReadOptions { variant: Some("wet".to_owned()), ..ReadOptions::default() };
    assert_eq!(files(&wet), both("wet.csv"));
    let set = |name: &str, value: &str| ReadOptions {
        set: vec![(name.to_owned(), value.into())],
        ..ReadOptions::default()
    };
    assert_eq!(files(&set("soil", "clay.csv")), both("clay.csv"));
    assert_eq!(files(&set("n", "3")), both("dry.csv"));
    let sweep = read(&ReadOptions::default()).scene.sweep.expect("a sweep");
    assert_eq!(sweep.point(2, &Map::new())[0], ("soil".to_owned(), "b.csv".into()));

    let wrong = |options: &ReadOptions| messages(&read(options).diagnostics);
    assert_eq!(wrong(&set("n", "many")), ["params: `n` cannot be \"many\": it is a number"]);
    let replaced = |from: &str, to: &str| {
        let text = text.replace(from, to);
        messages(&read_text("scene.ron", &text, &ReadOptions::default()).expect("RON").diagnostics)
    };
    assert_eq!(
        replaced("\"=kind\"", "\"=n\""),
        ["instances[0].of: expected a string, found a formula that gives 2.0"]
    );
    assert_eq!(
        replaced("zenith_deg: 30.0", "zenith_deg: \"=2 * soil\""),
        ["sun.zenith_deg: the parameter `soil` is the text \"dry.csv\""]
    );
    assert_eq!(
        replaced("{ \"soil\": \"wet.csv\" }", "{ \"soil\": 1.0 }"),
        ["variants.wet.soil: expected a text, as in `params`, found 1.0"]
    );
}
