//! Relief that is lawful and most likely not meant: seams of periodic scenes, steps, heights in another
//! unit.

use glam::DVec2;

use super::Spawner;
use crate::document::{Area, Diagnostic, Terrain};
use crate::geometry::{Polygon, Rectangle, place_text};
use crate::terrain::{Cells, Ground};

/// Steps along a seam that are lower may be meant, m.
const SEAM: f64 = 1.0;

/// Places along a side of the ground where both sides are compared.
const PLACES: usize = 512;

/// Slope of which a quarter of the ground is no natural ground: 75 degrees.
const STEEP: f64 = 3.73;

/// A step from a cell to the next that is lower may be a cliff, m.
const CLIFF: f64 = 50.0;

/// Slope of a step that is no cliff.
const WALL: f64 = 10.0;

/// Steps between neighbouring cells.
#[derive(Clone, Copy, Debug, Default)]
struct Steps {
    count: usize,
    /// How many are steeper than [`STEEP`].
    steep: usize,
    /// The highest step that is steeper than [`WALL`], m, and the cell where it is.
    highest: f64,
    at: usize,
}

impl Spawner<'_> {
    /// Warns of a periodic ground whose opposite sides differ in height.
    pub(super) fn doubt_seams(&mut self, ground: &Ground) {
        let path = match &self.scene.terrain {
            Terrain::Plane { .. } => return,
            Terrain::Raster { .. } => "terrain.file",
            Terrain::Mesh { .. } => "terrain.mesh",
        };
        if !self.is_periodic() {
            return;
        }
        let step = |axis: usize| {
            let (corner, size) = (ground.corner(), ground.size());
            (0..=PLACES)
                .filter_map(|place| {
                    let along = place as f64 / PLACES as f64;
                    let at = |side: f64| {
                        let mut at = DVec2::splat(along);
                        at[axis] = side;
                        ground.height(corner + at * size)
                    };
                    Some((at(1.0)? - at(0.0)?).abs())
                })
                .fold(0.0, f64::max)
        };
        let (east, north) = (step(0), step(1));
        if east.max(north) <= SEAM {
            return;
        }
        let message = format!(
            "the ground is repeated, but its opposite sides differ: walls of up to {east:.1} m stand \
             between east and west, of up to {north:.1} m between north and south"
        );
        let help = "they shade and are seen as ground; write `boundary: Isolated`, or take heights whose \
                    sides meet (a level plot, or one without its mean slope)";
        self.problems.push(Diagnostic::warning(path, message).help(help));
    }

    /// Warns of an area that lies beside the terrain.
    pub(super) fn doubt_area(
        &mut self,
        area: &Area,
        polygons: &[Polygon],
        terrain: Rectangle,
        path: &str,
    ) {
        let corners = || polygons.iter().flat_map(|polygon| &polygon.rings).flatten().copied();
        let low = corners().fold(DVec2::INFINITY, DVec2::min);
        let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max);
        let Rectangle { min, max } = terrain;
        if low.cmplt(max).all() && high.cmpgt(min).all() {
            return;
        }
        let message = "the area lies beside the terrain and has no effect";
        let help = format!(
            "it reaches from {} to {} m, the terrain from {} to {} m, local frame: {}",
            place_text(low),
            place_text(high),
            place_text(min),
            place_text(max),
            self.area_advice(area, polygons, terrain)
        );
        self.problems.push(Diagnostic::warning(path, message).help(help));
    }

    /// Warns of heights that are in another unit or hold values for no data, by their steps.
    pub(super) fn doubt_steepness(&mut self, heights: &Cells<f64>) {
        let steps = steps(heights);
        if steps.count > 0 && 4 * steps.steep > steps.count {
            let percent = 100 * steps.steep / steps.count;
            let message = format!("{percent} % of the ground is steeper than 75 degrees");
            let help = "heights may be in another unit than metres: write `height_unit_m: 0.01` for \
                        centimetres, 0.1 for decimetres, 0.3048 for feet";
            self.problems.push(Diagnostic::warning("terrain.file", message).help(help));
        } else if steps.highest > CLIFF {
            let message = format!(
                "the ground rises or falls by {:.1} m from the cell at {} to the next",
                steps.highest,
                place_text(heights.center(steps.at))
            );
            let help = "a cell without data may hold a height that the file does not name as such: name it \
                        (`gdal_edit.py -a_nodata 0`) and write `no_data: Neighbours`";
            self.problems.push(Diagnostic::warning("terrain.file", message).help(help));
        }
    }
}

fn steps(heights: &Cells<f64>) -> Steps {
    let (columns, cell) = (heights.columns, heights.cell());
    let mut steps = Steps::default();
    let mut add = |from: usize, to: usize, distance: f64| {
        let step = (heights.values[from] - heights.values[to]).abs();
        if step.is_nan() {
            return;
        }
        steps.count += 1;
        steps.steep += usize::from(step > STEEP * distance);
        if step > WALL * distance && step > steps.highest {
            (steps.highest, steps.at) = (step, from);
        }
    };
    for index in 0..heights.values.len() {
        if index % columns + 1 < columns {
            add(index, index + 1, cell.x);
        }
        if index + columns < heights.values.len() {
            add(index, index + columns, cell.y);
        }
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_counted_by_their_slope() {
        let values = vec![0.0, 1.0, 100.0, f64::NAN, 1.0, 1.0];
        let size = DVec2::new(3.0, 2.0);
        let heights = Cells { columns: 3, rows: 2, values, corner: DVec2::ZERO, size };
        let steps = steps(&heights);
        // Five pairs have heights; those of 99 m to the west and to the south are walls.
        assert_eq!((steps.count, steps.steep, steps.at), (5, 2, 1));
        assert!((steps.highest - 99.0).abs() < 1e-12);
    }
}
