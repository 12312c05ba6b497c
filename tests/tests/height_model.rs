//! Heights of the canopy and of the surface against many points of each surface.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::{DVec2, DVec3};
use rayon::ThreadPoolBuilder;
use sunfleck::components::{Instance, Mesh, SceneId};
use sunfleck::queries::{CellCount, HeightModel, height_model};
use sunfleck::run::SceneWorld;
use sunfleck_tests::SceneText;

/// Steps between points along a surface.
const STEPS: i32 = 400;

const CELLS: CellCount = CellCount::Counts { columns: 14, rows: 9 };

/// Tilted discs and triangles under leaning, unequally scaled instances over the sides of a rectangle of 7 m x 6 m.
fn scene(boundary: &str) -> SceneText {
    let mut state = 5_u64;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (mut discs, mut obj) = (String::new(), String::new());
    for number in 0..12 {
        let mut center = || format!("{},{},{}", next() - 0.5, next() - 0.5, 2.0 * next());
        let (center, normal) = (center(), center());
        writeln!(discs, "{},{center},{normal}", 0.1 + 0.02 * f64::from(number)).expect("memory");
    }
    for corner in 0..30 {
        writeln!(obj, "v {} {} {}", next() - 0.5, next() - 0.5, 3.0 * next()).expect("memory");
        if corner % 3 == 2 {
            writeln!(obj, "f {} {} {}", corner - 1, corner, corner + 1).expect("memory");
        }
    }
    let mut stems =
        String::from("x_m,y_m,z_m,yaw_deg,scale,scale_vertical,tilt_deg,tilt_azimuth_deg\n");
    for stem in 0..9 {
        let (x, y, yaw) = (10.0 + 7.0 * next(), 6.0 * next(), 360.0 * next());
        let (across, up) = (0.5 + next(), 0.5 + next());
        writeln!(
            stems,
            "{x},{y},{},{yaw},{across},{up},{},{}",
            -1.0 + 0.2 * next(),
            8 * (stem % 4),
            40 * stem
        )
        .expect("memory");
    }
    SceneText::bare(0.2, "size_m: (7.0, 6.0), corner_m: (10.0, 0.0), height_m: -1.0")
        .with_leaf(0.1, 0.1)
        .with_discs("discs", "leaf", &discs)
        .with_obj("faces", "leaf", &obj)
        .with(
            "instances",
            r#"Table(file: "stems.csv", of: "discs"), Table(file: "stems.csv", of: "faces")"#,
        )
        .with_file("stems.csv", &stems)
        .with("boundary", boundary)
}

fn model(world: &SceneWorld, is_periodic: bool) -> HeightModel {
    height_model(&world.world, CELLS, is_periodic, u64::MAX, &|_| ()).expect("it is small")
}

/// Highest of many points of all surfaces above each cell.
fn points(world: &SceneWorld, is_periodic: bool) -> BTreeMap<(i64, i64), f64> {
    let mut query = world.world.query::<(&SceneId, &Mesh)>();
    let meshes: BTreeMap<u32, &Mesh> = query.iter().map(|(id, mesh)| (id.0, mesh)).collect();
    let mut highest: BTreeMap<(i64, i64), f64> = BTreeMap::new();
    let mut add = |point: DVec3| {
        let cell = ((point.truncate() - DVec2::new(10.0, 0.0)) / DVec2::new(7.0, 6.0)
            * DVec2::new(14.0, 9.0))
        .floor();
        let (mut column, mut row) = (cell.x as i64, cell.y as i64);
        if is_periodic {
            (column, row) = (column.rem_euclid(14), row.rem_euclid(9));
        }
        let height = highest.entry((column, row)).or_insert(f64::NEG_INFINITY);
        *height = height.max(point.z);
    };
    for Instance { placement, .. } in Instance::in_order(&world.world) {
        let (mesh, linear) = (meshes[&placement.prototype.0], placement.world_from_object());
        let place = |point: DVec3| linear * point + placement.position;
        for triangle in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(triangle).map(|corner| place(corner.as_dvec3()));
            for (i, j) in (0..=STEPS).flat_map(|i| (0..=STEPS - i).map(move |j| (i, j))) {
                let [s, t] = [i, j].map(|step| f64::from(step) / f64::from(STEPS));
                add(a + (b - a) * s + (c - a) * t);
            }
        }
        for disc in &mesh.discs {
            let normal = disc.normal.as_dvec3().normalize_or(DVec3::Z);
            let u = normal.any_orthonormal_vector();
            let v = normal.cross(u);
            for (ring, step) in
                (0..=STEPS / 4).flat_map(|ring| (0..4 * STEPS).map(move |step| (ring, step)))
            {
                let (sin, cos) =
                    (std::f64::consts::TAU * f64::from(step) / f64::from(4 * STEPS)).sin_cos();
                let radius = f64::from(disc.radius) * f64::from(ring) / f64::from(STEPS / 4);
                add(place(disc.center.as_dvec3() + (u * cos + v * sin) * radius));
            }
        }
    }
    highest
}

/// *Scene*: as above on level ground at -1 m. *Expected*: each cell is at least as high as the highest of millions of
/// points of all surfaces, and higher by no more than they are apart on the steepest surface; the canopy is 1 m higher
/// above the ground; cells without plants have 0 m of them.
#[test]
fn cells_are_as_high_as_the_highest_point_above_them() {
    for boundary in ["Periodic", "Isolated"] {
        let is_periodic = boundary == "Periodic";
        let world = scene(boundary).world();
        let (model, points) = (model(&world, is_periodic), points(&world, is_periodic));
        let (mut covered, mut near) = (0, 0);
        for (row, column) in (0..9).flat_map(|row| (0..14).map(move |column| (row, column))) {
            let index = row * 14 + column;
            let (surface, canopy) = (model.surface[index], model.canopy[index]);
            match points.get(&(column as i64, row as i64)) {
                Some(&height) => {
                    covered += 1;
                    let height = height.max(-1.0);
                    assert!(surface >= height - 1e-9, "{column} {row}: {surface} below {height}");
                    // A sliver of a surface in the corner of a cell may lie between points.
                    near += usize::from(surface - height < 0.03);
                    assert!((canopy - (surface + 1.0)).abs() < 1e-9, "{canopy} {surface}");
                }
                None if canopy > 0.0 => near += 0,
                None => assert!(
                    canopy.abs() < 1e-12 && (surface + 1.0).abs() < 1e-12,
                    "{canopy} {surface}"
                ),
            }
        }
        assert!(covered > 60 && near > covered - 4, "{near} of {covered}");
    }
}

#[test]
fn heights_do_not_depend_on_threads() {
    let world = scene("Periodic").world();
    let of_threads = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| model(&world, true))
    };
    assert_eq!(of_threads(1), of_threads(3));
}

/// *Scene*: a post of 2 m on a slope of 45°. *Expected*: it is 2 m high wherever it stands, and cells without it show
/// the highest ground in them.
#[test]
fn plants_on_a_slope_are_as_high_as_above_level_ground() {
    let mut dem = String::from("ncols 8\nnrows 8\nxllcorner 0\nyllcorner 0\ncellsize 1\n");
    for _ in 0..8 {
        dem.push_str("0.5 1.5 2.5 3.5 4.5 5.5 6.5 7.5\n");
    }
    let world = SceneText::bare(0.2, "size_m: (1.0, 1.0)")
        .with("terrain", r#"Raster(file: "dem.asc", material: Some("soil"))"#)
        .with_file("dem.asc", &dem)
        .with_leaf(0.1, 0.1)
        .with_discs("leaf", "leaf", "0.001,0,0,2,0,0,1")
        .with("instances", r#"List(of: "leaf", at_m: [(2.25, 3.5, 2.25), (5.5, 6.5, 5.5)])"#)
        .with("boundary", "Isolated")
        .world();
    let cells = CellCount::Counts { columns: 8, rows: 8 };
    let model = height_model(&world.world, cells, false, u64::MAX, &|_| ()).expect("it is small");
    for (index, (surface, canopy)) in model.surface.iter().zip(&model.canopy).enumerate() {
        let (row, column) = (index / 8, index % 8);
        let expected = match (column, row) {
            (2, 3) => (4.25, 2.0),
            (5, 6) => (7.5, 2.0),
            _ => (column as f64 + 1.0, 0.0),
        };
        // The leaf is horizontal: where it is cut off, the ground below is up to its radius lower.
        let is_right = (surface - expected.0).abs() < 1e-6 && (canopy - expected.1).abs() < 2e-3;
        assert!(is_right, "{column} {row}: {surface} {canopy} for {expected:?}");
    }
}

#[test]
fn more_cells_than_memory_holds_are_refused() {
    let world = scene("Periodic").world();
    let error = height_model(&world.world, CellCount::Side(1e-6), true, 1 << 30, &|_| ())
        .expect_err("too many");
    assert!(
        error.to_string().starts_with("7000000 columns and 6000000 rows of heights take"),
        "{error}"
    );
}
