//! Areas by cell from brute force.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use sunfleck::components::{Instance, Mesh, PartMaterials, SceneId};
use sunfleck::queries::CellGrid;
use sunfleck::run::SceneWorld;
use sunfleck::terrain::Ground;

/// A triangle of a surface at its place.
#[derive(Clone, Copy)]
pub(crate) struct PlacedTriangle {
    pub(crate) corners: [DVec3; 3],
    pub(crate) material: u32,
    /// Height of the ground below the middle of the surface, m.
    ground: f64,
}

/// Triangles of all surfaces with their material, at their places; discs are fans of triangles of nearly their area.
pub(crate) struct PlacedTriangles {
    pub(crate) all: Vec<PlacedTriangle>,
    /// Exact area by material, m².
    pub(crate) areas: BTreeMap<u32, f64>,
    /// Area that the fans lack, m².
    pub(crate) lacking: f64,
}

/// Triangles of a fan.
const FAN: usize = 1000;

/// Surfaces of a world.
///
/// - `is_periodic`: true if its ground repeats without end; else it goes on level beside its rectangle
pub(crate) fn placed(world: &SceneWorld, is_periodic: bool) -> PlacedTriangles {
    let world = &world.world;
    let mut terrains = world.query::<&Ground>();
    let ground = terrains.iter().next().expect("a terrain");
    let height = |middle: DVec3| {
        let (place, corner, size) = (middle.truncate(), ground.corner(), ground.size());
        let wrapped = place - ((place - corner) / size).floor() * size;
        let place = if is_periodic { wrapped } else { place };
        ground.height(place.clamp(corner, corner + size)).expect("it has no holes")
    };
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
                let ground = height(corners.into_iter().sum::<DVec3>() / 3.0);
                placed.all.push(PlacedTriangle { corners, material: material.0, ground });
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
                let ground = height(center);
                let triangle = |corners| PlacedTriangle { corners, material: material.0, ground };
                placed.all.extend(fan.map(triangle));
                area += exact;
            }
            *placed.areas.entry(material.0).or_default() += area;
        }
    }
    placed
}

pub(crate) fn area_of([a, b, c]: &[DVec3; 3]) -> f64 {
    0.5 * (*b - *a).cross(*c - *a).length()
}

/// Areas of brute force by cell, and what they may be wrong by.
#[derive(Default)]
pub(crate) struct Brute {
    /// Area by column, row, layer and material.
    pub(crate) areas: BTreeMap<(i64, i64, i64, u32), f64>,
    pub(crate) uncertain: BTreeMap<(i64, i64, i64, u32), f64>,
}

impl Brute {
    /// Adds a triangle: it is quartered until each part lies in one cell, or is very small.
    pub(crate) fn add(&mut self, grid: &CellGrid, triangle: PlacedTriangle, depth: u32) {
        let PlacedTriangle { corners, material, ground } = triangle;
        let cells = corners.map(|corner| cell(grid, corner, ground));
        let key = |place: DVec3| {
            let (column, row, layer) = wrapped(grid, cell(grid, place, ground));
            (column, row, layer, material)
        };
        let [a, b, c] = corners;
        if depth == 0 || cells[0] == cells[1] && cells[1] == cells[2] {
            *self.areas.entry(key((a + b + c) / 3.0)).or_default() += area_of(&corners);
            if cells[0] == cells[1] && cells[1] == cells[2] {
                return;
            }
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            for corner in 0..8_u32 {
                let choose =
                    |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
                let near = DVec3::new(choose(0), choose(1), choose(2));
                *self.uncertain.entry(key(near)).or_default() += area_of(&corners);
            }
            return;
        }
        let [ab, bc, ca] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
        for corners in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            self.add(grid, PlacedTriangle { corners, ..triangle }, depth - 1);
        }
    }
}

fn cell(grid: &CellGrid, place: DVec3, height: f64) -> (i64, i64, i64) {
    let counts = DVec2::new(grid.columns as f64, grid.rows as f64);
    let ground = ((place.truncate() - grid.corner) / grid.size * counts).floor();
    let layer = ((place.z - height - grid.bottom) / grid.thickness).floor();
    (ground.x as i64, ground.y as i64, layer.clamp(-1.0, grid.layers as f64 - 1.0) as i64)
}

fn wrapped(grid: &CellGrid, (column, row, layer): (i64, i64, i64)) -> (i64, i64, i64) {
    if grid.is_periodic {
        return (column.rem_euclid(grid.columns as i64), row.rem_euclid(grid.rows as i64), layer);
    }
    let is_in = (0..grid.columns as i64).contains(&column) && (0..grid.rows as i64).contains(&row);
    if is_in { (column, row, layer) } else { (-1, -1, 0) }
}
