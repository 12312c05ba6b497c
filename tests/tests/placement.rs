//! Stands by rule, from the text of a scene to its instances.

use std::fs;
use std::path::Path;

use glam::DVec2;
use sunfleck::components::{Instance, Placement};
use sunfleck::document::{ReadOptions, read_text};
use sunfleck::run::SceneWorld;

/// A periodic scene of 200 m x 100 m at a UTM position, with meshes of four sizes.
fn scene(instances: &str) -> String {
    let crown = |name: &str, height: f64| {
        format!(
            r#""{name}": Crown(shape: Cylinder(diameter_m: 2.0, height_m: {height:?}), base_m: 1.0,
                leaf_area_m2: 5.0, leaf: Disc(radius_m: 0.1), leaf_material: "leaf"),"#
        )
    };
    format!(
        r#"Scene(
    format: 1,
    frame: (origin_m: (500000.0, 5500000.0, 0.0)),
    bands: [(name: "nir", center_nm: 865.0)],
    materials: {{
        "soil": Lambertian(reflectance: Constant(0.2)),
        "leaf": Leaf(reflectance: Constant(0.5), transmittance: Constant(0.4)),
    }},
    meshes: {{ {} {} {} {} }},
    terrain: Plane(size_m: (200.0, 100.0), material: "soil", height_m: 12.0),
    {instances}
    sun: (zenith_deg: 30.0, irradiance: Constant(1.0)),
    boundary: Periodic,
    sensors: {{ "albedo": Photons }},
)"#,
        crown("oak", 4.0),
        crown("birch", 9.0),
        crown("fir", 14.0),
        crown("shrub", 1.0),
    )
}

/// The instances of a scene in document order, with the names of their meshes, or all that is wrong.
fn instances(text: &str, folder: &Path) -> Result<Vec<(String, Placement)>, String> {
    let reading =
        read_text("stand.ron", text, &ReadOptions::default()).map_err(|e| e.to_string())?;
    assert!(reading.diagnostics.is_empty(), "{}", reading.render());
    let built =
        SceneWorld::from_scene(&reading.scene, folder).map_err(|p| reading.source.render(&p))?;
    let all = Instance::in_order(&built.world);
    let name = |p: &Placement| {
        reading.scene.meshes.get_index(p.prototype.0 as usize).expect("a mesh").0.clone()
    };
    Ok(all.iter().map(|one| (name(&one.placement), one.placement)).collect())
}

fn placed(list: &str) -> Vec<(String, Placement)> {
    match instances(&scene(list), Path::new(".")) {
        Ok(placed) => placed,
        Err(problems) => panic!("{problems}"),
    }
}

fn wrong(list: &str, folder: &Path) -> String {
    instances(&scene(list), folder).expect_err("something is wrong")
}

/// *Scene*: 500 stems/ha inside a square of a GeoJSON file in UTM, but for its hole and a table's
/// triangle. *Expected*: as many as the exact area says, all inside, the holes empty.
#[test]
fn stems_stand_inside_the_stand_and_outside_of_its_holes() {
    let folder = tempfile::tempdir().expect("a folder");
    let stand = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32633"}},
        "features":[{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[
        [[500010,5500010],[500090,5500010],[500090,5500090],[500010,5500090],[500010,5500010]],
        [[500020,5500020],[500040,5500020],[500040,5500040],[500020,5500040],[500020,5500020]]]}}]}"#;
    fs::write(folder.path().join("stand.geojson"), stand).expect("written");
    fs::write(folder.path().join("road.csv"), "x_m,y_m\n60,10\n80,10\n60,90\n").expect("written");
    for (rule, least) in [("Uniform", 0.0), ("PoissonDisc(min_distance_m: 2.0)", 2.0)] {
        let list = format!(
            r#"instances: [Scatter(of: {{ "oak": 1.0, "birch": 2.0 }}, rule: {rule}, stems: PerHectare(500.0),
                inside: [GeoJson(file: "stand.geojson")], outside: [Table(file: "road.csv")],
                height_m: Normal(mean: 20.0, sd: 3.0, min: 10.0), sink_m: 0.1)],"#
        );
        let trees = instances(&scene(&list), folder.path()).expect("a stand");
        // 6400 - 400 - 800 m².
        assert_eq!(trees.len(), 260);
        let mut distance = f64::INFINITY;
        for (index, (name, tree)) in trees.iter().enumerate() {
            let DVec2 { x, y } = tree.position.truncate();
            let within =
                |low: f64, high: f64| (low..=high).contains(&x) && (low..=high).contains(&y);
            assert!(within(10.0, 90.0) && !within(20.0, 40.0), "({x}, {y})");
            assert!(x <= 60.0 || (x - 60.0) / 20.0 + (y - 10.0) / 80.0 >= 1.0, "({x}, {y})");
            assert!((tree.position.z - 11.9).abs() < 1e-12);
            let height = f64::from(tree.scale.vertical) * if name == "oak" { 5.0 } else { 10.0 };
            assert!((9.9..40.0).contains(&height), "{name} of {height} m");
            assert_eq!(tree.scale.horizontal.to_bits(), tree.scale.vertical.to_bits());
            for (_, other) in &trees[..index] {
                distance = distance.min((tree.position - other.position).length());
            }
        }
        assert!(distance >= least, "{distance}");
    }
}

const OAKS: &str = r#"Scatter(name: "oaks", of: { "oak": 1.0 }, rule: PoissonDisc(min_distance_m: 4.0),
    scale: LogNormal(median: 1.0, sd_ln: 0.2, max: 2.0))"#;
const MIXED: &str = r#"Scatter(name: "mixed", of: { "birch": 1.0, "fir": 1.0 }, rule: Uniform,
    stems: Count(300), tilt_deg: Normal(mean: 0.0, sd: 3.0, min: 0.0, max: 20.0))"#;

#[test]
fn the_same_seed_is_the_same_forest_whatever_else_stands_there() {
    let oaks = placed(&format!("instances: [{OAKS}],"));
    assert_eq!(oaks, placed(&format!("instances: [{OAKS}],")));
    let both = placed(&format!("instances: [{MIXED}, {OAKS}],"));
    assert_eq!(both[300..], oaks);
    // One more species takes some stems and moves none.
    let more = MIXED.replace("\"fir\": 1.0", "\"fir\": 1.0, \"shrub\": 0.5");
    let with_shrubs = placed(&format!("instances: [{more}, {OAKS}],"));
    assert_eq!(with_shrubs[300..], oaks);
    let mut shrubs = 0;
    for ((name, tree), (before, place)) in with_shrubs.iter().zip(&both) {
        assert_eq!(tree.position, place.position);
        shrubs += usize::from(name == "shrub");
        assert!(name == before || name == "shrub");
    }
    assert!((30..90).contains(&shrubs), "{shrubs} of 300 expected to be near 60");
    let seed = OAKS.replace("name", "seed: 2, name");
    assert_ne!(oaks[0], placed(&format!("instances: [{seed}],"))[0]);
}

#[test]
fn what_is_hidden_or_not_selected_is_left_out_and_the_others_stay() {
    let all = placed(&format!("instances: [{MIXED}, {OAKS}],"));
    let kept = |keep: &str, rule: &dyn Fn(usize, &str) -> bool| {
        let found = placed(&format!("instances: [{MIXED}, {OAKS}], {keep}"));
        let expected: Vec<_> = all
            .iter()
            .enumerate()
            .filter(|(index, (name, _))| rule(*index, name))
            .map(|(_, tree)| tree.clone())
            .collect();
        assert!(!expected.is_empty() && expected.len() < all.len());
        assert_eq!(found, expected, "{keep}");
    };
    kept(r#"hide: ["fir"],"#, &|_, name| name != "fir");
    kept(r#"hide: ["oaks/*"],"#, &|index, _| index < 300);
    kept(r#"select: ["mixed/b*"],"#, &|_, name| name == "birch");
    kept(r#"select: ["mixed/*"], hide: ["birch"],"#, &|_, name| name == "fir");
}

#[test]
fn heights_of_lists_and_tables_may_count_from_the_terrain() {
    let list =
        |key: &str| format!(r#"instances: [List(of: "oak", at_m: [(5.0, 5.0, 1.0)]{key})],"#);
    let height = |key: &str| placed(&list(key))[0].1.position.z;
    assert!((height("") - 1.0).abs() < 1e-12);
    assert!((height(", on_terrain: true") - 13.0).abs() < 1e-12);
    let beside = list(", on_terrain: true").replace("(5.0, 5.0", "(-5.0, 5.0");
    let message = wrong(&beside, Path::new("."));
    assert!(message.contains("1 of 1 place has no terrain below"), "{message}");
    assert!(message.contains("(-5, 5) is one: move it, or take out `on_terrain`"), "{message}");
}

#[test]
fn what_cannot_be_placed_says_why() {
    let folder = tempfile::tempdir().expect("a folder");
    let degrees =
        r#"{"type":"Polygon","coordinates":[[[7.1,51.2],[7.11,51.2],[7.11,51.21],[7.1,51.2]]]}"#;
    fs::write(folder.path().join("degrees.geojson"), degrees).expect("written");
    let far = r#"{"type":"Polygon","coordinates":[[[10,10],[90,10],[90,90],[10,10]]]}"#;
    fs::write(folder.path().join("local.geojson"), far).expect("written");
    let scatter = |keys: &str| {
        format!(
            r#"instances: [Scatter(of: {{ "oak": 1.0 }}, rule: PoissonDisc(min_distance_m: 5.0), {keys})],"#
        )
    };
    for (keys, expected) in [
        (
            "stems: PerHectare(1000.0)",
            &["of 2000 stems stand 5 m apart, then no place is left: at random about 557 find a \
               place here, and in the tightest order (rows of equilateral triangles) 923"][..],
        ),
        (
            "inside: [Polygon(outline_m: [(10.0, 10.0), (50.0, 50.0), (50.0, 10.0), (10.0, 50.0)])]",
            &[
                "crosses itself or another ring at (30.000, 30.000)",
                "(instances[0].inside[0])",
                "list the corners of each ring in the order of its outline",
            ],
        ),
        (
            r#"inside: [GeoJson(file: "degrees.geojson")]"#,
            &["is in degrees", "ogr2ogr -t_srs", "(instances[0].inside[0].file)"],
        ),
        (
            r#"inside: [GeoJson(file: "local.geojson")]"#,
            &[
                "no ground of the terrain is left where a stem may stand",
                "if they are local, write `georeferenced: false`",
            ],
        ),
        (
            "outside: [Polygon(outline_m: [(-10.0, -10.0), (500.0, -10.0), (500.0, 500.0), (-10.0, 500.0)])]",
            &["no ground of the terrain is left where a stem may stand"],
        ),
        (
            r#"inside: [GeoJson(file: "nowhere.geojson")]"#,
            &["nowhere.geojson", "(instances[0].inside[0].file)"],
        ),
    ] {
        let message = wrong(&scatter(keys), folder.path());
        for part in expected {
            assert!(message.contains(part), "{message}\nlacks {part}");
        }
    }
    let near = scatter("").replace("5.0), ", "120.0), ");
    let message = wrong(&near, folder.path());
    assert!(message.contains("its own image across the border of the periodic scene"), "{message}");
    let hidden = format!("instances: [{MIXED}, {OAKS}], hide: [\"oka\"],");
    let message = wrong(&hidden, folder.path());
    assert!(message.contains("nothing stands there by the name `oka`"), "{message}");
    assert!(message.contains("did you mean `oak`?"), "{message}");
}
