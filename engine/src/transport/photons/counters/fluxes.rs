use glam::{DVec3, UVec2};

use super::{Counter, Event, Recorder, Visited, WeightFactor};
use crate::accel::{Hit, Ray};
use crate::extract::Stage;
use crate::transport::ReferencePlane;

/// A surface on which flux is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FluxLevel {
    /// The ground, per m² of horizontal area.
    Terrain,
    /// The ground, per m² of its own inclined surface. A pixel holds the mean over its horizontal area.
    TerrainSurface,
    /// The top of the scene.
    Top,
    /// A horizontal plane at this height, m.
    Height(f64),
}

/// Power down and up through levels, by square pixels; cells `[levels, down and up, rows, columns]`
/// with row 0 in the north, each raster followed by one cell for its total.
#[derive(Clone, Debug)]
pub struct FluxCounter {
    /// Levels.
    pub levels: Vec<FluxLevel>,
    /// Columns and rows.
    pub size: UVec2,
    /// The rectangle that the rasters cover.
    pub plane: ReferencePlane,
}

impl FluxCounter {
    /// Pixels of about this side, m, so that a whole number of them covers the rectangle.
    #[must_use]
    pub fn new(plane: ReferencePlane, pixel: f64, levels: Vec<FluxLevel>) -> Self {
        let size = (plane.size / pixel).round().as_uvec2().max(UVec2::ONE);
        Self { levels, size, plane }
    }

    /// Pixels of a raster.
    #[must_use]
    pub const fn pixels(&self) -> usize {
        self.size.x as usize * self.size.y as usize
    }

    /// First cell of the raster of a level.
    #[must_use]
    pub const fn first_cell(&self, level: usize, is_up: bool) -> usize {
        (2 * level + is_up as usize) * (self.pixels() + 1)
    }

    /// Cells that a crossing of a level counts in, if the point lies within the rectangle.
    fn cells_at(&self, point: DVec3, level: usize, is_up: bool) -> Option<[usize; 2]> {
        let at = self.plane.within(point.truncate())?;
        let at = (at * self.size.as_dvec2()).as_uvec2().min(self.size - 1);
        let pixel = (self.size.y - 1 - at.y) * self.size.x + at.x;
        let first = self.first_cell(level, is_up);
        Some([first + pixel as usize, first + self.pixels()])
    }
}

impl Counter for FluxCounter {
    fn cells(&self) -> usize {
        self.levels.len() * 2 * (self.pixels() + 1)
    }

    fn count(&self, stage: &Stage, event: &Event<'_>, recorder: &mut Recorder<'_>) {
        for (index, &level) in self.levels.iter().enumerate() {
            let mut add = |point, is_up, factor, scale| {
                for cell in self.cells_at(point, index, is_up).into_iter().flatten() {
                    recorder.add(cell, factor, scale);
                }
            };
            match (level, event) {
                (
                    FluxLevel::Terrain | FluxLevel::TerrainSurface,
                    Event::Arrival { hit, surface, reflected, .. },
                ) if stage.is_ground(hit) && hit.normal.dot(surface.wo()) > 0.0 => {
                    let scale = level.per_area(hit);
                    add(hit.point, false, WeightFactor::One, scale);
                    add(hit.point, true, WeightFactor::Lobe(*reflected), scale);
                }
                (
                    FluxLevel::Terrain | FluxLevel::TerrainSurface,
                    Event::Emission { hit, emitted, .. },
                ) if stage.is_ground(hit) => {
                    add(hit.point, true, WeightFactor::Lobe(*emitted), level.per_area(hit));
                }
                // Nothing is above the top: light comes down through it once and goes up once.
                (FluxLevel::Top, Event::Start { ray }) => {
                    add(at_height(ray, stage.top()), false, WeightFactor::One, 1.0);
                }
                (FluxLevel::Top, Event::Escape { ray, visited: Visited { order: 1.., .. } })
                    if ray.direction.z > 0.0 =>
                {
                    add(at_height(ray, stage.top()), true, WeightFactor::One, 1.0);
                }
                // Light from outside is the same above all of the scene. Packets start at its top, and
                // those that would cross a higher rectangle alone never start.
                (FluxLevel::Height(height), Event::Start { ray }) if height >= stage.top() => {
                    add(at_height(ray, stage.top()), false, WeightFactor::One, 1.0);
                }
                (FluxLevel::Height(height), Event::Flight { ray, distance }) => {
                    let is_up = ray.direction.z > 0.0;
                    let along = (height - ray.origin.z) / ray.direction.z;
                    if along > 0.0 && along <= *distance && (is_up || height < stage.top()) {
                        add(ray.origin + ray.direction * along, is_up, WeightFactor::One, 1.0);
                    }
                }
                _ => {}
            }
        }
    }
}

impl FluxLevel {
    /// Factor from power per horizontal area to power per area of this surface.
    fn per_area(self, hit: &Hit) -> f64 {
        if self == Self::TerrainSurface { hit.normal.z.abs() } else { 1.0 }
    }
}

/// Point at which the line of a ray crosses a height.
fn at_height(ray: &Ray, height: f64) -> DVec3 {
    ray.origin + ray.direction * ((height - ray.origin.z) / ray.direction.z)
}
