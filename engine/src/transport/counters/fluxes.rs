use glam::{DVec3, UVec2};

use super::{Counter, Event, Share, Tally};
use crate::extract::Stage;
use crate::transport::ReferencePlane;

/// A surface on which flux is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FluxLevel {
    /// The ground itself.
    Terrain,
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

    fn count<'a>(&self, stage: &'a Stage, event: &Event<'_, 'a>, tally: &mut Tally<'a>) -> u64 {
        for (index, &level) in self.levels.iter().enumerate() {
            let mut add = |point, is_up, share| {
                for cell in self.cells_at(point, index, is_up).into_iter().flatten() {
                    tally.add(cell, share, 1.0);
                }
            };
            match (level, event) {
                (FluxLevel::Terrain, Event::Arrival { hit, wo, reflected, .. })
                    if stage.is_ground(hit) && hit.normal.dot(*wo) > 0.0 =>
                {
                    add(hit.point, false, Share::Whole);
                    add(hit.point, true, Share::Of(reflected));
                }
                (FluxLevel::Terrain, Event::Emission { hit, .. }) if stage.is_ground(hit) => {
                    add(hit.point, true, Share::Whole);
                }
                // Nothing is above the top: light comes down through it once and goes up once.
                (FluxLevel::Top, Event::Start { ray }) => {
                    let along = (stage.top() - ray.origin.z) / ray.direction.z;
                    let point = ray.origin + ray.direction * along;
                    add(point, false, Share::Whole);
                }
                (FluxLevel::Top, Event::Escape { ray, order: 1.., .. })
                    if ray.direction.z > 0.0 =>
                {
                    let along = (stage.top() - ray.origin.z).max(0.0) / ray.direction.z;
                    let point = ray.origin + ray.direction * along;
                    add(point, true, Share::Whole);
                }
                (FluxLevel::Height(height), Event::Flight { ray, distance }) => {
                    let along = (height - ray.origin.z) / ray.direction.z;
                    if along > 0.0 && along <= *distance {
                        let point = ray.origin + ray.direction * along;
                        add(point, ray.direction.z > 0.0, Share::Whole);
                    }
                }
                _ => {}
            }
        }
        0
    }
}
