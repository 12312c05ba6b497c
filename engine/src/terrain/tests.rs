use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3, Vec3};

use super::*;
use crate::accel;
use crate::assets::{Raster, read_raster};
use crate::components::{MaterialId, TerrainPatch};
use crate::sampling::Key;

fn soil() -> Parts {
    vec![("soil".to_owned(), MaterialId(0))]
}

fn cells(columns: usize, rows: usize, height: impl Fn(f64, f64) -> f64) -> Cells<f64> {
    let values = (0..rows)
        .rev()
        .flat_map(|y| (0..columns).map(move |x| (x as f64 + 0.5, y as f64 + 0.5)))
        .map(|(x, y)| height(x, y))
        .collect();
    let size = DVec2::new(columns as f64, rows as f64);
    Cells { columns, rows, values, corner: DVec2::new(300.0, -40.0), size }
}

/// Hills of several sizes, without any two alike.
fn hills(x: f64, y: f64) -> f64 {
    let wave = |k: f64| (k * x + 1.3 * k * y).sin() * (0.7 * k * y - 0.4 * k * x).cos() / k;
    5.0 * (wave(0.031) + wave(0.11) + wave(0.47) + wave(1.7))
}

fn dems() -> Vec<PathBuf> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/dem"));
    let Ok(files) = std::fs::read_dir(folder) else {
        eprintln!("skipped: needs the folder `shared` beside the project");
        return Vec::new();
    };
    let paths = files.map(|file| file.expect("a folder").path());
    let mut paths: Vec<_> = paths.filter(|p| p.extension().is_some_and(|e| e == "asc")).collect();
    paths.sort();
    paths
}

/// The largest distance of the ground from the height at a cell's centre, m; every cell has ground
/// exactly where it has data.
fn largest_error(heights: &Cells<f64>, patch: &TerrainPatch) -> f64 {
    let ground = Ground::of(patch);
    let cell = heights.size / DVec2::new(heights.columns as f64, heights.rows as f64);
    let mut largest = 0.0_f64;
    for (index, &height) in heights.values.iter().enumerate() {
        let (x, y) = (index % heights.columns, heights.rows - 1 - index / heights.columns);
        let at = heights.corner + cell * DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        match ground.height(at) {
            Some(found) => largest = largest.max((found - height).abs()),
            None => assert!(height.is_nan(), "no ground at {at}"),
        }
        assert!(!height.is_nan() || ground.height(at).is_none(), "ground in the hole at {at}");
    }
    largest
}

#[test]
fn the_ground_is_within_the_tolerance_of_every_cell_of_every_dem() {
    for path in dems() {
        let Raster { columns, rows, values, place, .. } =
            read_raster(&path, None).unwrap_or_else(|error| panic!("{error}"));
        let place = place.expect("ESRI ASCII grids have a place");
        // In metres, whatever the file says: it is the geometry that counts.
        let cell = if place.cell.x < 0.05 { place.cell * 1e5 } else { place.cell };
        let size = cell * DVec2::new(columns as f64, rows as f64);
        let heights = Cells { columns, rows, values, corner: place.corner, size };
        let known = || heights.values.iter().filter(|h| !h.is_nan());
        let (low, high) = known().fold((f64::MAX, f64::MIN), |(l, h), &z| (l.min(z), h.max(z)));
        // f32 keeps heights above the lowest one in units of the extent.
        let rounding = 4.0 * f64::from(f32::EPSILON) * (high - low).max(size.max_element());
        let mut last = usize::MAX;
        for tolerance in [0.0, 0.1, 1.0, 10.0] {
            let patch = raster(&heights, tolerance, None, soil(), false).expect("data");
            let error = largest_error(&heights, &patch);
            let triangles = patch.first_cut as usize;
            let name = path.file_name().unwrap_or_default().display();
            println!("{name}, {tolerance} m: {error:.5} m with {triangles} triangles");
            assert!(error <= tolerance + rounding, "{name}: {error} for {tolerance}");
            assert!(triangles <= last, "{name}: more triangles for a larger tolerance");
            last = triangles;
        }
    }
}

#[test]
fn a_plane_of_a_million_cells_needs_two_triangles() {
    for slope in [0.0, 0.3] {
        let heights = cells(1000, 1000, |x, y| 120.0 + slope * x - 0.5 * slope * y);
        let patch = raster(&heights, 0.0, None, soil(), false).expect("data");
        assert_eq!(patch.first_cut, 2);
        assert!(largest_error(&heights, &patch) < 1e-3);
    }
}

#[test]
fn a_hill_on_a_plain_costs_triangles_where_it_is() {
    let heights = cells(1000, 1000, |x, y| {
        let r = DVec2::new(x - 400.0, y - 600.0).length() / 30.0;
        20.0 * (-r * r).exp()
    });
    let patch = raster(&heights, 0.1, None, soil(), false).expect("data");
    assert!(largest_error(&heights, &patch) <= 0.1 + 1e-3);
    assert!(patch.first_cut < 2000, "{}", patch.first_cut);
}

#[test]
fn triangles_end_exactly_at_the_borders_of_classes_and_holes() {
    let mut heights = cells(60, 40, hills);
    for (index, value) in heights.values.iter_mut().enumerate() {
        let (x, y) = (index % 60, 39 - index / 60);
        if (10..14).contains(&x) && (5..20).contains(&y) || x < 2 && y < 2 {
            *value = f64::NAN;
        }
    }
    // Classes in cells of another size, beyond the rectangle on all sides.
    let random = Key::new(1).path("classes");
    let values = (0..12 * 9).map(|i| (random.bits(i) % 3) as u16).collect();
    let corner = heights.corner - DVec2::new(3.0, 2.5);
    let size = DVec2::new(12.0 * 5.5, 9.0 * 5.25);
    let cover = Cells { columns: 12, rows: 9, values, corner, size };
    let class = |at: DVec2| {
        let cell = ((at - corner) / DVec2::new(5.5, 5.25)).floor();
        cover.values[(8 - cell.y as usize) * 12 + cell.x as usize]
    };
    let parts: Parts = (0..3).map(|i| (format!("{i}"), MaterialId(i))).collect();
    let patch = raster(&heights, 0.2, Some(&cover), parts, false).expect("data");
    assert!(largest_error(&heights, &patch) <= 0.2 + 1e-4);
    // Every triangle lies in cells of its own class alone: so do points just inside its corners.
    let mut area = [0.0; 3];
    for (part, sum) in patch.mesh.parts.iter().zip(&mut area) {
        for triangle in part.triangles.clone() {
            let corners = patch.mesh.corners(triangle as usize);
            let world = corners.map(|v| heights.corner + v.truncate().as_dvec2() * heights.size);
            let middle = (world[0] + world[1] + world[2]) / 3.0;
            for corner in world.iter().chain([&middle]) {
                let at = *corner + (middle - *corner) * 1e-3;
                assert_eq!(class(at).to_string(), part.name, "{at}");
                let cell = (at - heights.corner).floor();
                let height = heights.values[(39 - cell.y as usize) * 60 + cell.x as usize];
                assert!(!height.is_nan(), "{at} is in a hole");
            }
            *sum += 0.5 * (world[1] - world[0]).perp_dot(world[2] - world[0]);
        }
    }
    let whole = 60.0 * 40.0 - 4.0 * 15.0 - 4.0;
    assert!((area.iter().sum::<f64>() - whole).abs() < 1e-3, "{area:?}");
}

/// The highest distance between neighbouring heights of a border's two sides and its own surface.
#[test]
fn a_border_over_a_hill_follows_it() {
    let heights = cells(200, 50, |x, _| 10.0 * (x / 20.0).sin());
    let values = (0..50).flat_map(|row| [u16::from(row < 25); 200]).collect();
    let cover = heights.with(values);
    let parts: Parts = (0..2).map(|i| (format!("{i}"), MaterialId(i))).collect();
    let patch = raster(&heights, 0.1, Some(&cover), parts, false).expect("data");
    let ground = Ground::of(&patch);
    for x in 1..199 {
        let x = f64::from(x);
        let found = ground.height(heights.corner + DVec2::new(x, 25.0)).expect("ground");
        let truth = 10.0 * (x / 20.0).sin();
        // Half way between centres the bilinear surface is a little below an arc.
        assert!((found - truth).abs() < 0.1 + 0.01, "{x}: {found} for {truth}");
    }
}

#[test]
fn opposite_sides_that_differ_get_walls_and_others_do_not() {
    let walls = |height: fn(f64, f64) -> f64| {
        let heights = cells(20, 20, height);
        let patch = raster(&heights, 0.0, None, soil(), true).expect("data");
        assert_eq!(patch.first_cut as usize, patch.mesh.triangles.len(), "walls are ground");
        let vertical = |t: &usize| {
            let [a, b, c] = patch.mesh.corners(*t);
            (b - a).cross(c - a).z == 0.0
        };
        (0..patch.mesh.triangles.len()).filter(vertical).count()
    };
    assert_eq!(walls(|_, _| 3.0), 0);
    // A slope to the east: its eastern side is high, and the western one lies at the bottom.
    assert_eq!(walls(|x, _| x), 2);
    assert_eq!(walls(|x, y| x + y), 8 - 2);
    assert_eq!(walls(|_, y| (y - 10.0).abs()), 0);
}

#[test]
fn a_mesh_is_turned_up_and_keeps_its_parts() {
    let vertices = [(0.0, 0.0), (8.0, 0.0), (8.0, 4.0), (0.0, 4.0), (4.0, 4.0), (4.0, 0.0)];
    let part = |name: &str, triangles| crate::components::MeshPart {
        name: name.to_owned(),
        triangles,
        discs: 0..0,
    };
    let source = crate::components::Mesh {
        vertices: vertices.map(|(x, y)| Vec3::new(x, y, 0.5 * x)).to_vec(),
        // The first of them faces down.
        triangles: vec![[0, 4, 5], [0, 4, 3], [5, 1, 2], [5, 2, 4]],
        discs: Vec::new(),
        parts: vec![part("west", 0..2), part("east", 2..4)],
    };
    let parts = vec![("west".to_owned(), MaterialId(1)), ("east".to_owned(), MaterialId(2))];
    let patch = mesh(&source, DVec3::new(10.0, 20.0, 30.0), parts, false).expect("an extent");
    assert_eq!((patch.corner, patch.size), (DVec2::new(10.0, 20.0), DVec2::new(8.0, 4.0)));
    assert_eq!((patch.base, patch.first_cut), (30.0, 4));
    for triangle in 0..4 {
        let [a, b, c] = patch.mesh.corners(triangle);
        assert!((b - a).cross(c - a).z > 0.0, "{triangle}");
    }
    let ground = Ground::of(&patch);
    let height = ground.height(DVec2::new(16.0, 21.0)).expect("ground");
    assert!((height - 33.0).abs() < 1e-5, "{height}");
}

/// Rays that start above a periodic ground whose sides do not match, and go on from where they hit
/// it: all come down on it from the air. `RAYS` in the environment asks for more of them.
#[test]
fn no_ray_gets_under_a_periodic_ground() {
    let wanted = std::env::var("RAYS").ok().and_then(|rays| rays.parse().ok());
    let wanted: u64 = wanted.unwrap_or(200_000);
    let heights = cells(24, 16, |x, y| hills(3.0 * x, 3.0 * y) + 0.4 * x - 0.7 * y);
    let patch = raster(&heights, 0.3, None, soil(), true).expect("data");
    let domain =
        accel::Domain { min: patch.corner, max: patch.corner + patch.size, is_periodic: true };
    let input = accel::MeshInput { mesh: &patch.mesh, surfaces: &[0] };
    let instance = accel::InstanceInput {
        mesh: 0,
        linear: patch.world_from_object(),
        translation: patch.origin(),
    };
    let scene =
        accel::TwoLevelBvh::build(&[input], rayon::iter::once(instance), domain).expect("a scene");
    let key = Key::new(7).path("rays");
    let (mut rays, mut walls, mut start) = (0, 0, 0);
    while rays < wanted {
        let random = key.index(start);
        start += 1;
        // Every fourth starts right over a side or a corner.
        let side = |draw: u64| {
            let at = random.uniform(draw);
            if random.bits(draw + 2).is_multiple_of(4) { at.round() } else { at }
        };
        let plan = patch.corner + patch.size * DVec2::new(side(0), side(1));
        let (azimuth, down) = (random.uniform(4) * std::f64::consts::TAU, random.uniform(5));
        let level = (1.0 - down * down).sqrt();
        let direction = DVec3::new(level * azimuth.cos(), level * azimuth.sin(), -down - 1e-6);
        let mut ray = accel::Ray { origin: plan.extend(scene.top() + 1.0), direction, from: None };
        for bounce in 1.. {
            rays += 1;
            let Some(hit) = scene.closest(&ray) else {
                assert!(ray.direction.z > 0.0, "ray {start}.{bounce} fell through: {ray:?}");
                break;
            };
            let facing = hit.normal.dot(ray.direction);
            assert!(facing <= 1e-6, "ray {start}.{bounce} met the underside: {hit:?}");
            walls += u64::from(hit.normal.z == 0.0);
            if bounce == 6 {
                break;
            }
            let (tangent, other) = crate::geometry::basis(hit.normal);
            let draw = |i: u64| random.uniform(6 + 2 * bounce + i);
            let (azimuth, up) = (draw(0) * std::f64::consts::TAU, draw(1).sqrt());
            let level = (1.0 - up * up).sqrt();
            ray = hit
                .leave((tangent * azimuth.cos() + other * azimuth.sin()) * level + hit.normal * up);
        }
    }
    println!("{rays} rays, {walls} of them met a wall");
    assert!(walls > rays / 100);
}
