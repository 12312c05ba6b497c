//! Leaf area by cells and layers against brute force, and against the gap fractions of the same scene.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::{DVec2, DVec3};
use rayon::ThreadPoolBuilder;
use sunfleck::components::{Instance, Mesh, PartMaterials, SceneId, TerrainPatch};
use sunfleck::queries::{
    CellCount, CellGrid, CountedSurfaces, HeightReference, LayerCount, LeafAreaGrid,
    LeafAreaRequest, leaf_area,
};
use sunfleck::run::SceneWorld;
use sunfleck_tests::{Estimate, SceneText, product};

const REQUEST: LeafAreaRequest = LeafAreaRequest {
    cells: CellCount::Counts { columns: 3, rows: 4 },
    layers: LayerCount::Thickness(0.7),
    heights: HeightReference::Ground,
    surfaces: CountedSurfaces::All,
    by_material: true,
    is_periodic: true,
    memory: 1 << 30,
};

/// Uniform numbers from 0 to 1 of a linear congruential generator.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Discs and triangles in three materials, tilted, turned, unequally scaled, over the sides of the rectangle.
fn scene(terrain: &str, boundary: &str) -> SceneText {
    let mut numbers = Numbers(1);
    let (mut discs, mut obj, mut stems) = (
        String::new(),
        String::new(),
        String::from("x_m,y_m,z_m,yaw_deg,scale,scale_vertical,tilt_deg,tilt_azimuth_deg\n"),
    );
    let mut line = |text: &mut String, columns: usize, scales: &[f64]| {
        let values: Vec<String> = (0..columns)
            .map(|column| {
                let scale = scales[column % scales.len()];
                if scale < 0.0 {
                    (-scale * (2.0 * numbers.next() - 1.0)).to_string()
                } else {
                    (scale * (0.2 + 0.8 * numbers.next())).to_string()
                }
            })
            .collect();
        values.join(",").chars().for_each(|letter| text.push(letter));
    };
    for _ in 0..25 {
        line(&mut discs, 7, &[0.4, -0.8, -0.8, 2.5, -1.0, -1.0, -1.0]);
        discs.push('\n');
    }
    // A horizontal, a vertical and an oblique disc along the axes.
    discs.push_str("0.3,0,0,1,0,0,1\n0.3,0.1,0,1.5,1,0,0\n0.3,0,0.1,2,0,0.6,0.8\n");
    for corner in 0..60 {
        if corner % 3 == 0 {
            writeln!(obj, "g {}", if corner < 30 { "green" } else { "wood" }).expect("memory");
        }
        let mut row = String::new();
        line(&mut row, 3, &[-0.7, -0.7, 3.0]);
        writeln!(obj, "v {}", row.replace(',', " ")).expect("memory");
        if corner % 3 == 2 {
            writeln!(obj, "f {} {} {}", corner - 1, corner, corner + 1).expect("memory");
        }
    }
    for stem in 0..24 {
        let tilt = if stem % 2 == 0 { 0.0 } else { 25.0 };
        let mut row = String::new();
        line(&mut row, 8, &[6.0, 5.0, 0.3, 360.0, 1.2, 1.5, 1.0, 360.0]);
        let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
        for (cell, corner) in cells.iter_mut().zip([100.0, -20.0, 3.0]) {
            let place: f64 = cell.parse().expect("a number");
            *cell = (place + corner).to_string();
        }
        cells[6] = tilt.to_string();
        if stem % 3 == 0 {
            let scale = cells[4].clone();
            cells[5] = scale;
        }
        writeln!(stems, "{}", cells.join(",")).expect("memory");
    }
    SceneText::bare(0.2, "size_m: (6.0, 5.0)")
        .with("terrain", terrain)
        .with_leaf(0.1, 0.1)
        .with_more("materials", r#""red leaf": Leaf(reflectance: Constant(0.3), transmittance: Constant(0.1)), "bark": Lambertian(reflectance: Constant(0.2))"#)
        .with_discs("discs", "leaf", &discs)
        .with_more("meshes", r#""faces": Obj(file: "faces.obj", up: Z, unit_m: 1.0, parts: { "green": "red leaf", "wood": "bark" })"#)
        .with_file("faces.obj", &obj)
        .with("instances", r#"Table(file: "stems.csv", of: "discs"), Table(file: "stems.csv", of: "faces")"#)
        .with_file("stems.csv", &stems)
        .with("boundary", boundary)
}

const LEVEL: &str =
    r#"Plane(size_m: (6.0, 5.0), corner_m: (100.0, -20.0), height_m: 3.0, material: "soil")"#;

fn counted(world: &SceneWorld, request: &LeafAreaRequest) -> LeafAreaGrid {
    leaf_area(&world.world, request, &|_| ()).expect("it has leaves")
}

/// Triangles of all surfaces with their material, at their places; discs are fans of triangles of nearly their area.
struct PlacedTriangles {
    all: Vec<([DVec3; 3], u32)>,
    /// Exact area by material, m².
    areas: BTreeMap<u32, f64>,
    /// Area that the fans lack, m².
    lacking: f64,
}

/// Triangles of a fan.
const FAN: usize = 1000;

fn placed(world: &SceneWorld) -> PlacedTriangles {
    let world = &world.world;
    let mut placed = PlacedTriangles { all: Vec::new(), areas: BTreeMap::new(), lacking: 0.0 };
    let mut query = world.query::<(&SceneId, &Mesh, &PartMaterials)>();
    let meshes: BTreeMap<u32, (&Mesh, &PartMaterials)> =
        query.iter().map(|(id, mesh, materials)| (id.0, (mesh, materials))).collect();
    for Instance { placement, .. } in Instance::in_order(world) {
        let (mesh, materials) = meshes[&placement.prototype.0];
        let linear = placement.world_from_object();
        for (part, material) in mesh.parts.iter().zip(&materials.0) {
            let mut area = 0.0;
            for triangle in part.triangles.clone() {
                let corners = mesh.corners(triangle as usize);
                let corners = corners.map(|corner| linear * corner.as_dvec3() + placement.position);
                area += area_of(&corners);
                placed.all.push((corners, material.0));
            }
            for disc in &mesh.discs[part.discs.start as usize..part.discs.end as usize] {
                let normal = disc.normal.as_dvec3().normalize_or(DVec3::Z);
                let u = normal.any_orthonormal_vector();
                let (u, v) = (linear * u, linear * normal.cross(u));
                let [center, u, v] = [linear * disc.center.as_dvec3() + placement.position, u, v];
                let (u, v) = (u * f64::from(disc.radius), v * f64::from(disc.radius));
                let exact = std::f64::consts::PI * u.cross(v).length();
                let edge = |step: usize| {
                    let (sin, cos) = (std::f64::consts::TAU * step as f64 / FAN as f64).sin_cos();
                    center + u * cos + v * sin
                };
                let fan = (0..FAN).map(|step| [center, edge(step), edge(step + 1)]);
                placed.lacking += exact - fan.clone().map(|corners| area_of(&corners)).sum::<f64>();
                placed.all.extend(fan.map(|corners| (corners, material.0)));
                area += exact;
            }
            *placed.areas.entry(material.0).or_default() += area;
        }
    }
    placed
}

fn area_of([a, b, c]: &[DVec3; 3]) -> f64 {
    0.5 * (*b - *a).cross(*c - *a).length()
}

/// Areas of brute force by cell, and what they may be wrong by.
#[derive(Default)]
struct Brute {
    /// Area by column, row, layer and material.
    areas: BTreeMap<(i64, i64, i64, u32), f64>,
    uncertain: BTreeMap<(i64, i64, i64, u32), f64>,
}

impl Brute {
    /// Adds a triangle: it is quartered until each part lies in one cell, or is very small.
    fn add(&mut self, grid: &CellGrid, corners: [DVec3; 3], material: u32, depth: u32) {
        let cells = corners.map(|corner| cell(grid, corner));
        if cells[0] == cells[1] && cells[1] == cells[2] {
            let (column, row, layer) = wrapped(grid, cells[0]);
            *self.areas.entry((column, row, layer, material)).or_default() += area_of(&corners);
            return;
        }
        if depth == 0 {
            let [a, b, c] = corners;
            let (column, row, layer) = wrapped(grid, cell(grid, (a + b + c) / 3.0));
            *self.areas.entry((column, row, layer, material)).or_default() += area_of(&corners);
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            for corner in 0..8_u32 {
                let choose =
                    |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
                let near = DVec3::new(choose(0), choose(1), choose(2));
                let (column, row, layer) = wrapped(grid, cell(grid, near));
                *self.uncertain.entry((column, row, layer, material)).or_default() +=
                    area_of(&corners);
            }
            return;
        }
        let [a, b, c] = corners;
        let [ab, bc, ca] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
        for part in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            self.add(grid, part, material, depth - 1);
        }
    }
}

fn cell(grid: &CellGrid, place: DVec3) -> (i64, i64, i64) {
    let counts = DVec2::new(grid.columns as f64, grid.rows as f64);
    let ground = ((place.truncate() - grid.corner) / grid.size * counts).floor();
    let layer = ((place.z - 3.0 - grid.bottom) / grid.thickness).floor();
    (ground.x as i64, ground.y as i64, layer.min(grid.layers as f64 - 1.0) as i64)
}

fn wrapped(grid: &CellGrid, (column, row, layer): (i64, i64, i64)) -> (i64, i64, i64) {
    if grid.is_periodic {
        return (column.rem_euclid(grid.columns as i64), row.rem_euclid(grid.rows as i64), layer);
    }
    let is_in = (0..grid.columns as i64).contains(&column) && (0..grid.rows as i64).contains(&row);
    if is_in { (column, row, layer) } else { (-1, -1, 0) }
}

/// *Scene*: 48 instances of discs and triangles under all transforms. *Expected*: the area of each material is the sum
/// over its triangles and discs, whatever the cells.
#[test]
fn all_cells_together_hold_the_area_of_all_surfaces() {
    for boundary in ["Periodic", "Isolated"] {
        let world = scene(LEVEL, boundary).world();
        let exact = placed(&world).areas;
        let cells = [
            (CellCount::Counts { columns: 1, rows: 1 }, LayerCount::Count(1)),
            (CellCount::Counts { columns: 3, rows: 4 }, LayerCount::Thickness(0.7)),
            (CellCount::Side(0.11), LayerCount::Thickness(0.13)),
            (CellCount::Automatic, LayerCount::Automatic),
        ];
        for (cells, layers) in cells {
            let is_periodic = boundary == "Periodic";
            let found = counted(&world, &LeafAreaRequest { cells, layers, is_periodic, ..REQUEST });
            assert_eq!(found.classes, ["leaf", "red leaf", "bark"]);
            for (class, area) in exact.values().enumerate() {
                let elsewhere = found.outside[class] + found.below[class] + found.over_holes[class];
                let all = found.total(class) + elsewhere;
                assert!((all / area - 1.0).abs() < 1e-9, "{boundary} {cells:?}: {all} for {area}");
                assert_eq!(is_periodic, found.outside[class] == 0.0);
                let columns: f64 = found.columns_total().iter().skip(class).step_by(3).sum();
                let layers: f64 = found.layers_total().iter().skip(class).step_by(3).sum();
                let sum = found.total(class);
                assert!((columns / sum - 1.0).abs() < 1e-9 && (layers / sum - 1.0).abs() < 1e-9);
            }
            let of_leaves = counted(
                &world,
                &LeafAreaRequest {
                    cells,
                    layers,
                    is_periodic,
                    surfaces: CountedSurfaces::Leaves,
                    by_material: false,
                    ..REQUEST
                },
            );
            assert_eq!(of_leaves.classes, ["leaf"]);
            let leaves = found.total(0)
                + found.total(1)
                + found.outside[0]
                + found.outside[1]
                + found.below[0]
                + found.below[1];
            let all = of_leaves.total(0) + of_leaves.outside[0] + of_leaves.below[0];
            assert!((all / leaves - 1.0).abs() < 1e-9, "{all} for {leaves}");
        }
    }
}

/// *Scene*: as above. *Expected*: each cell holds what brute force finds, which quarters all triangles until they lie in
/// one cell, and says how much area it could not decide on.
#[test]
fn each_cell_holds_what_brute_force_finds() {
    for boundary in ["Periodic", "Isolated"] {
        let world = scene(LEVEL, boundary).world();
        let found =
            counted(&world, &LeafAreaRequest { is_periodic: boundary == "Periodic", ..REQUEST });
        let (grid, placed) = (&found.grid, placed(&world));
        let mut brute = Brute::default();
        for (corners, material) in placed.all {
            let depth = if area_of(&corners) > 1e-2 { 12 } else { 6 };
            brute.add(grid, corners, material, depth);
        }
        // Materials in the order of the scene, behind the soil.
        let mut compared = 0;
        for layer in 0..grid.layers {
            for (row, column) in
                (0..grid.rows).flat_map(|row| (0..grid.columns).map(move |column| (row, column)))
            {
                for class in 0..3 {
                    let key = (column as i64, row as i64, layer as i64, class as u32 + 1);
                    let expected = brute.areas.get(&key).copied().unwrap_or(0.0);
                    let room =
                        brute.uncertain.get(&key).copied().unwrap_or(0.0) + placed.lacking + 1e-12;
                    let index = ((layer * grid.rows + row) * grid.columns + column) * 3 + class;
                    let value = found.areas[index];
                    assert!(
                        (value - expected).abs() <= room,
                        "{key:?}: {value} for {expected} ± {room}"
                    );
                    compared += usize::from(expected > 100.0 * room);
                }
            }
        }
        assert!(compared > 60, "{compared} cells are known to 1 %");
    }
}

/// *Scene*: upright instances of one scale, many of which lie above one cell, so that layers come from a table.
/// *Expected*: the same as of the instances one by one, which are cut.
#[test]
fn layers_from_a_table_are_those_of_cut_surfaces() {
    let at = |count: usize| {
        let places = (0..count).map(|place| {
            format!("({}, {}, {})", 102.0 + 0.01 * place as f64, -17.0, 3.0 + 0.137 * place as f64)
        });
        let places: Vec<String> = places.collect();
        format!(
            r#"List(of: "discs", at_m: [{0}]), List(of: "faces", at_m: [{0}])"#,
            places.join(", ")
        )
    };
    let request = LeafAreaRequest {
        cells: CellCount::Counts { columns: 1, rows: 1 },
        layers: LayerCount::Thickness(0.31),
        ..REQUEST
    };
    let of_count = |count: usize| {
        let world = scene(LEVEL, "Periodic").with("instances", at(count)).world();
        counted(&world, &request).layers_total()
    };
    // Sixteen and more get a table, fewer none.
    let layers = |count: usize| {
        let mut all = of_count(count);
        all.resize(100 * 3, 0.0);
        all
    };
    let with_table = layers(20);
    let single = |place: usize| {
        let text = at(20);
        let lists: Vec<String> = text
            .split("List")
            .skip(1)
            .map(|list| {
                let places =
                    list.split_once('[').expect("a list").1.split_once(']').expect("a list").0;
                let one = places
                    .split("), ")
                    .nth(place)
                    .expect("a place")
                    .trim_end_matches(')')
                    .to_owned();
                let mesh = if list.contains("discs") { "discs" } else { "faces" };
                format!(r#"List(of: "{mesh}", at_m: [{one})])"#)
            })
            .collect();
        let world = scene(LEVEL, "Periodic").with("instances", lists.join(", ")).world();
        let mut all = counted(&world, &request).layers_total();
        all.resize(100 * 3, 0.0);
        all
    };
    let mut sum = vec![0.0; 300];
    for place in 0..20 {
        sum.iter_mut().zip(single(place)).for_each(|(sum, area)| *sum += area);
    }
    let whole: f64 = sum.iter().sum();
    assert!(whole > 100.0);
    for (one, other) in with_table.iter().zip(&sum) {
        assert!((one - other).abs() < 1e-12 * whole, "{one} for {other}");
    }
}

/// *Scene*: a leaning forest on a slope. *Expected*: the same bits with one thread and with three.
#[test]
fn results_do_not_depend_on_threads() {
    let world = scene(LEVEL, "Periodic").world();
    let count = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| counted(&world, &REQUEST))
    };
    let (one, three) = (count(1), count(3));
    let bits =
        |grid: &LeafAreaGrid| grid.areas.iter().map(|area| area.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&one), bits(&three));
}

/// *Scene*: one horizontal sheet that lies 2 m above each of four ramps of a slope. *Expected*: heights above the ground
/// put all of it into the layer from 1.9 to 2.1 m, absolute ones spread it.
#[test]
fn heights_follow_the_ground() {
    let mut dem = String::from("ncols 12\nnrows 12\nxllcorner 0\nyllcorner 0\ncellsize 1\n");
    for row in 0..12 {
        let heights: Vec<String> = (0..12)
            .map(|column| (0.5 * f64::from(column) + 0.1 * f64::from(row)).to_string())
            .collect();
        writeln!(dem, "{}", heights.join(" ")).expect("memory");
    }
    let mut numbers = Numbers(7);
    let leaves: Vec<String> = (0..200)
        .map(|_| {
            let (x, y) = (1.0 + 10.0 * numbers.next(), 1.0 + 10.0 * numbers.next());
            // The plane through the middles of cells; rows run from north to south.
            let z = 0.5 * (x - 0.5) + 0.1 * (11.5 - y);
            format!("({x}, {y}, {})", z + 2.0)
        })
        .collect();
    let world = SceneText::bare(0.2, "size_m: (1.0, 1.0)")
        .with("terrain", r#"Raster(file: "dem.asc", material: Some("soil"))"#)
        .with_file("dem.asc", &dem)
        .with_leaf(0.1, 0.1)
        .with_discs("leaf", "leaf", "0.05,0,0,0,0,0,1")
        .with("instances", format!(r#"List(of: "leaf", at_m: [{}])"#, leaves.join(", ")))
        .with("boundary", "Isolated")
        .world();
    let patch_heights: Vec<f64> =
        world.world.query::<&TerrainPatch>().iter().map(TerrainPatch::highest).collect();
    assert!(patch_heights[0] > 5.0);
    let request =
        LeafAreaRequest { layers: LayerCount::Thickness(0.2), is_periodic: false, ..REQUEST };
    let in_layers = |heights: HeightReference| {
        let found = counted(&world, &LeafAreaRequest { heights, ..request });
        let layers = found.layers_total();
        layers.iter().filter(|&&area| area > 0.0).count()
    };
    assert!(in_layers(HeightReference::Absolute) > 15);
    assert!(in_layers(HeightReference::Ground) <= 2, "one layer, or two beside its side");
}

/// *Scene*: 3000 small discs of all directions, at random in a periodic tile; 24 such scenes. *Expected*: gap fractions
/// obey Beer's law, `exp(-G LAI / cos θ)` with `G = 0.5`, with the leaf area index that is counted.
#[test]
fn gap_fractions_obey_beers_law_with_the_counted_index() {
    const SCENES: u64 = 24;
    let zeniths: [f64; 3] = [0.0, 30.0, 57.5];
    let mut ratios: Vec<Vec<f64>> = vec![Vec::new(); zeniths.len()];
    for seed in 0..SCENES {
        let mut numbers = Numbers(1000 + seed);
        let mut discs = String::new();
        for _ in 0..3000 {
            let (x, y, z) =
                (8.0 * numbers.next(), 8.0 * numbers.next(), 0.5 + 6.0 * numbers.next());
            let (cos, azimuth) =
                (2.0 * numbers.next() - 1.0, std::f64::consts::TAU * numbers.next());
            let sin = (1.0_f64 - cos * cos).sqrt();
            writeln!(
                discs,
                "0.08,{x},{y},{z},{},{},{cos}",
                sin * azimuth.cos(),
                sin * azimuth.sin()
            )
            .expect("memory");
        }
        let views: Vec<String> =
            zeniths.iter().map(|zenith| format!("({zenith:?}, 33.0)")).collect();
        let scene = SceneText::bare(0.2, "size_m: (8.0, 8.0)")
            .with_leaf(0.1, 0.1)
            .with_discs("cloud", "leaf", &discs)
            .with("instances", r#"List(of: "cloud", at_m: [(0.0, 0.0, 0.0)])"#)
            .with("boundary", "Periodic")
            .with("sun", "zenith_deg: 30.0")
            .with("sensors", format!(r#""gaps": Directions(views: List([{}]), until: Samples(20000), measure: [GapFraction])"#, views.join(", ")));
        let found = counted(
            &scene.world(),
            &LeafAreaRequest { surfaces: CountedSurfaces::Leaves, ..REQUEST },
        );
        let lai = found.total(0) / 64.0;
        assert!((lai - 3000.0 * 0.0064 * std::f64::consts::PI / 64.0).abs() < 1e-6);
        let report = scene.measure();
        let gaps = product(&report, "gaps", "gap_fraction");
        for (view, zenith) in zeniths.iter().enumerate() {
            let expected = (-0.5 * lai / zenith.to_radians().cos()).exp();
            ratios[view].push(Estimate::of(gaps, view).value / expected);
        }
    }
    for (ratios, zenith) in ratios.iter().zip(zeniths) {
        let count = ratios.len() as f64;
        let mean = ratios.iter().sum::<f64>() / count;
        let variance =
            ratios.iter().map(|ratio| (ratio - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let z = (mean - 1.0) / (variance / count).sqrt();
        // 24 scenes: 4.5 standard errors happen once in 6000 by Student's distribution.
        assert!(z.abs() < 4.5 && (mean - 1.0).abs() < 0.05, "{zenith}°: {mean}, z = {z}");
    }
}
