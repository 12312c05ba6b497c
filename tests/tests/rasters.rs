//! Stands from rasters, on the ground of a raster: from files to instances.

use std::f64::consts::SQRT_2;
use std::fs;
use std::path::Path;

use glam::DVec2;
use sunfleck::components::{Instance, Placement};
use sunfleck::document::{ReadOptions, read_text};
use sunfleck::run::SceneWorld;
use sunfleck::sampling::Key;
use tempfile::TempDir;

const ORIGIN: DVec2 = DVec2::new(400_000.0, 5_600_000.0);

/// Writes an ESRI ASCII grid with its corner at the scene's origin plus a shift.
fn write(
    folder: &Path,
    name: &str,
    (columns, rows): (usize, usize),
    cell: f64,
    shift: DVec2,
    value: impl Fn(DVec2) -> f64,
) {
    let corner = ORIGIN + shift;
    let mut text = format!(
        "ncols {columns}\nnrows {rows}\nxllcorner {}\nyllcorner {}\ncellsize {cell}\nNODATA_value -9999\n",
        corner.x, corner.y
    );
    for row in (0..rows).rev() {
        let line = (0..columns).map(|column| {
            let value = value(shift + cell * (DVec2::new(column as f64, row as f64) + 0.5));
            let value = if value.is_nan() { -9999.0 } else { value };
            value.to_string()
        });
        text += &line.collect::<Vec<_>>().join(" ");
        text.push('\n');
    }
    fs::write(folder.join(name), text).expect("a file");
}

/// A bowl, m: a triangle between its points at most `cell` apart lies above it, by
/// `cell² (1/100 + 1/150) / 8` at most.
fn bowl(place: DVec2) -> f64 {
    300.0 + place.x * place.x / 200.0 + place.y * place.y / 300.0
}

const SAG: f64 = 4.0 * (0.01 + 1.0 / 150.0) / 8.0;

/// 120 m x 80 m of ground in cells of 2 m; crowns of 5 m, 10 m and 15 m, 2 m to 4 m wide.
fn scene(terrain: &str, instances: &str) -> String {
    let crown = |name: &str, diameter: f64, height: f64| {
        format!(
            r#""{name}": Crown(shape: Cylinder(diameter_m: {diameter:?}, height_m: {height:?}), base_m: 1.0,
                leaf_area_m2: 60.0, leaf: Disc(radius_m: 0.05), leaf_material: "leaf"),"#
        )
    };
    format!(
        r#"Scene(
    format: 1,
    frame: (origin_m: (400000.0, 5600000.0, 0.0)),
    bands: [(name: "nir", center_nm: 865.0)],
    materials: {{
        "soil": Lambertian(reflectance: Constant(0.2)),
        "leaf": Leaf(reflectance: Constant(0.5), transmittance: Constant(0.4)),
    }},
    meshes: {{ {} {} {} }},
    terrain: Raster(file: "dem.asc", material: "soil"{terrain}),
    instances: [{instances}],
    sun: (zenith_deg: 30.0, irradiance: Constant(1.0)),
    sensors: {{ "albedo": Photons }},
)"#,
        crown("shrub", 3.0, 4.0),
        crown("oak", 4.0, 9.0),
        crown("fir", 2.0, 14.0),
    )
}

/// Instances with the heights and widths of their meshes, and the warnings; or what is wrong.
fn stand(folder: &Path, text: &str) -> Result<(Vec<(Placement, DVec2)>, String), String> {
    let reading =
        read_text("stand.ron", text, &ReadOptions::default()).map_err(|e| e.to_string())?;
    assert!(reading.diagnostics.is_empty(), "{}", reading.render());
    let built =
        SceneWorld::from_scene(&reading.scene, folder).map_err(|p| reading.source.render(&p))?;
    let all = Instance::in_order(&built.world).into_iter().map(|one| one.placement);
    let sizes = [DVec2::new(3.0, 5.0), DVec2::new(4.0, 10.0), DVec2::new(2.0, 15.0)];
    let all = all.map(|p| (p, sizes[p.prototype.0 as usize])).collect();
    Ok((all, reading.source.render(&built.diagnostics())))
}

fn folder() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    write(folder.path(), "dem.asc", (60, 40), 2.0, DVec2::ZERO, bowl);
    folder
}

/// *Scene*: trees at random on a bowl, 0.3 m deep in the ground. *Expected*: each stands at the
/// height of the bowl less that, within the sag of triangles, which is one-sided.
#[test]
fn trees_stand_on_the_ground_of_a_raster() {
    let folder = folder();
    let trees = r#"Scatter(of: { "oak": 1.0, "fir": 1.0 }, rule: Uniform, stems: Count(4000), sink_m: 0.3)"#;
    let (trees, _) = stand(folder.path(), &scene("", trees)).expect("a stand");
    assert_eq!(trees.len(), 4000);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for (tree, _) in &trees {
        let place = tree.position.truncate();
        // Half a cell from the sides the ground goes on straight.
        let inner = place.cmpgt(DVec2::ONE).all() && place.cmplt(DVec2::new(119.0, 79.0)).all();
        if inner {
            let above = tree.position.z - (bowl(place) - 0.3);
            (least, most) = (least.min(above), most.max(above));
        }
    }
    // Heights are f32 over a range of 93 m.
    assert!(least > -1e-4 && most < SAG + 1e-4, "{least} {most}");
    assert!(most > 0.9 * SAG, "{most}");
}

/// *Scene*: a lake without heights. *Expected*: no tree in it, and all others stand where they stood
/// without the lake.
#[test]
fn no_tree_stands_in_a_hole() {
    let folder = folder();
    let trees = r#"Scatter(of: { "oak": 1.0 }, rule: Uniform, stems: Count(3000))"#;
    let (before, _) = stand(folder.path(), &scene("", trees)).expect("a stand");
    let is_lake = |p: DVec2| p.x > 40.0 && p.x < 80.0 && p.y > 20.0 && p.y < 50.0;
    let lake = |place: DVec2| if is_lake(place) { f64::NAN } else { bowl(place) };
    write(folder.path(), "dem.asc", (60, 40), 2.0, DVec2::ZERO, lake);
    let (after, warnings) =
        stand(folder.path(), &scene(", no_data: Hole", trees)).expect("a stand");
    let places = |trees: &[(Placement, DVec2)]| -> Vec<DVec2> {
        trees.iter().map(|(tree, _)| tree.position.truncate()).collect()
    };
    let expected: Vec<DVec2> = places(&before).into_iter().filter(|&p| !is_lake(p)).collect();
    assert_eq!(places(&after), expected);
    let drowned = before.len() - after.len();
    assert!(drowned > 300, "{drowned}");
    let expected = format!("{drowned} of 3000 stems fell on holes of the terrain");
    assert!(warnings.contains(&expected), "{warnings}");
}

/// Trees of a canopy: place, height and crown diameter, m. No two crowns overlap.
fn drawn_trees() -> Vec<(DVec2, f64, f64)> {
    let key = Key::new(11);
    (0..96)
        .map(|number| {
            let cell = DVec2::new((number % 12) as f64, (number / 12) as f64);
            let own = key.index(number);
            let place = 10.0 * cell + 4.0 + 2.0 * DVec2::new(own.uniform(0), own.uniform(1));
            (place, 6.0 + 20.0 * own.uniform(2), 3.0 + 4.5 * own.uniform(3))
        })
        .collect()
}

/// *Scene*: a canopy height model in cells of 0.25 m of 96 trees from 6 m to 26 m on a bowl.
/// *Expected*: as many trees; each within 0.25 m of its place, its top within 5 % of its height above
/// the ground, its crown as wide as it is but for a cell's diagonal: the cells whose centres a disc covers lie
/// within half of that around it, and hold the disc that is narrower by as much.
#[test]
fn a_canopy_height_model_becomes_its_trees() {
    let folder = folder();
    let drawn = drawn_trees();
    let canopy = |place: DVec2| {
        let of = |&(at, height, diameter): &(DVec2, f64, f64)| {
            let r = place.distance(at) / (0.5 * diameter);
            if r < 1.0 { height * (1.0 - 0.45 * r * r) } else { 0.0 }
        };
        drawn.iter().map(of).fold(0.0, f64::max)
    };
    write(folder.path(), "chm.asc", (480, 320), 0.25, DVec2::ZERO, canopy);
    let trees = r#"CanopyHeights(file: "chm.asc", of: ["shrub", "oak", "fir"], sink_m: 0.2)"#;
    let (trees, _) = stand(folder.path(), &scene("", trees)).expect("a stand");
    assert_eq!(trees.len(), drawn.len());
    let mut worst = 0.0_f64;
    let mut used = [0; 3];
    for (place, height, diameter) in drawn {
        let distance = |tree: &Placement| tree.position.truncate().distance(place);
        let (tree, size) =
            trees.iter().min_by(|a, b| distance(&a.0).total_cmp(&distance(&b.0))).expect("a tree");
        assert!(distance(tree) < 0.25, "{} m off {place}", distance(tree));
        let ground = bowl(tree.position.truncate());
        assert!((tree.position.z - ground + 0.2).abs() < SAG + 1e-3, "{}", tree.position);
        let top = tree.position.z + f64::from(tree.scale.vertical) * size.y - ground;
        worst = worst.max((top / height - 1.0).abs());
        let width = f64::from(tree.scale.horizontal) * size.x;
        assert!((width - diameter).abs() < SQRT_2 * 0.25, "{width} for {diameter}");
        used[tree.prototype.0 as usize] += 1;
    }
    assert!(worst < 0.05, "{worst}");
    assert!(used.iter().all(|&count| count > 0), "{used:?}");
}

/// *Scene*: a density in cells of 5 m that grows to the east, in halves of its unit, on the ground's
/// eastern half alone. *Expected*: strips within counting error, nothing beside the raster, a warning.
#[test]
fn a_density_raster_is_met_where_it_lies() {
    let folder = folder();
    let density = |place: DVec2| 20.0 * (place.x - 40.0);
    write(folder.path(), "density.asc", (12, 16), 5.0, DVec2::new(60.0, 0.0), density);
    for (rule, least) in [("Uniform", 0.0), ("PoissonDisc(min_distance_m: 0.8)", 0.8)] {
        let trees = format!(
            r#"Scatter(of: {{ "fir": 1.0 }}, rule: {rule}, stems: Raster(file: "density.asc", factor: 2.0))"#
        );
        let (trees, warnings) = stand(folder.path(), &scene("", &trees)).expect("a stand");
        let mut strips = [0.0; 4];
        for (index, (tree, _)) in trees.iter().enumerate() {
            let place = tree.position.truncate();
            assert!(place.x >= 60.0, "{place}");
            strips[((place.x - 60.0) / 15.0) as usize] += 1.0;
            for (other, _) in &trees[..index] {
                assert!(place.distance(other.position.truncate()) >= least);
            }
        }
        for (strip, count) in strips.iter().enumerate() {
            let middle = 67.5 + 15.0 * strip as f64;
            let expected = 2.0 * density(DVec2::new(middle, 0.0)) * 1200.0 / 1e4;
            let z = (count - expected) / f64::sqrt(expected);
            assert!(z.abs() < 4.0, "{rule}, strip {strip}: {count} of {expected}");
        }
        assert!(
            warnings.contains(
                "it reaches from (60, 0) to (120, 80) m, but stems may stand from (0, 0) to (120, 80) m"
            ),
            "{warnings}"
        );
    }
}

#[test]
fn placement_does_not_depend_on_the_number_of_threads() {
    let folder = folder();
    write(folder.path(), "density.asc", (24, 16), 5.0, DVec2::ZERO, |p| 10.0 * p.x);
    let noise = Key::new(2);
    let heights = |p: DVec2| 25.0 * noise.uniform((p.x as u64) + 1000 * (p.y as u64));
    write(folder.path(), "chm.asc", (120, 80), 1.0, DVec2::ZERO, heights);
    let list = r#"
        CanopyHeights(file: "chm.asc", of: ["oak", "fir"]),
        Scatter(of: { "fir": 1.0, "oak": 2.0 }, rule: Uniform, stems: Raster(file: "density.asc")),
        Scatter(of: { "oak": 1.0 }, rule: PoissonDisc(min_distance_m: 1.5), stems: Raster(file: "density.asc")),
        Scatter(of: { "shrub": 1.0 }, rule: PoissonDisc(min_distance_m: 2.0), name: "below")"#;
    let placed = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| stand(folder.path(), &scene("", list)).expect("a stand").0)
    };
    let one = placed(1);
    assert!(one.len() > 2000, "{}", one.len());
    assert!(one == placed(2) && one == placed(5), "alike for 1, 2 and 5 threads");
}

#[test]
fn what_is_wrong_with_a_raster_of_trees_is_told() {
    let folder = folder();
    let path = folder.path();
    write(path, "beside.asc", (4, 4), 5.0, DVec2::new(500.0, 0.0), |_| 5.0);
    write(path, "negative.asc", (24, 16), 5.0, DVec2::ZERO, |p| p.x - 30.0);
    write(path, "low.asc", (24, 16), 5.0, DVec2::ZERO, |_| 1.5);
    write(path, "no_heights.asc", (24, 16), 5.0, DVec2::ZERO, |_| 4000.0);
    let degrees = "ncols 2\nnrows 2\nxllcorner 7.1\nyllcorner 51.2\ncellsize 0.001\n1 2\n3 4\n";
    fs::write(path.join("degrees.asc"), degrees).expect("a file");
    let density = |file: &str| {
        format!(r#"Scatter(of: {{ "fir": 1.0 }}, rule: Uniform, stems: Raster(file: "{file}"))"#)
    };
    let canopy = |file: &str| format!(r#"CanopyHeights(file: "{file}", of: ["fir"])"#);
    let told: Vec<String> = [
        density("beside.asc"),
        density("degrees.asc"),
        density("negative.asc"),
        canopy("beside.asc"),
        canopy("degrees.asc"),
        canopy("low.asc"),
        canopy("no_heights.asc"),
    ]
    .iter()
    .map(|instances| stand(path, &scene("", instances)).expect_err("something is wrong"))
    .collect();
    insta::assert_snapshot!(told.join("\n"));
}
