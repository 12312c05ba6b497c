//! Areas of placed meshes, added up in the cells that they lie in.

use std::ops::RangeInclusive;

use super::height_table::HeightTable;
use super::shape::ScaledAreas;
use crate::components::{Lean, Placement};
use crate::queries::cell_grid::{CellGrid, Elsewhere};
use crate::queries::surfaces::{
    FlatPatch, GroundHeights, MaterialTree, PatchPiece, PlacedBox, PlacementTransform,
};
use crate::statistics::Sums;

/// Grid and ground that areas are counted by.
#[derive(Clone, Copy, Debug)]
pub(super) struct CountingSpace<'a> {
    pub(super) grid: &'a CellGrid,
    /// Ground that heights are counted from; `None` if they are absolute.
    pub(super) ground: Option<&'a GroundHeights<'a>>,
}

/// Surfaces of one class of a mesh with their areas under a scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaledTree<'a> {
    pub(super) surfaces: &'a MaterialTree<'a>,
    pub(super) areas: &'a ScaledAreas,
    /// Table of areas by height, for upright instances.
    pub(super) table: Option<&'a HeightTable>,
}

/// Adds the areas of an instance to sums.
pub(super) struct Collector<'a, 'b> {
    space: CountingSpace<'a>,
    scaled: ScaledTree<'a>,
    placement: Placement,
    transform: PlacementTransform,
    /// Factor of the areas.
    factor: f64,
    sums: &'b mut Sums,
}

/// Columns, rows and layers that a box touches; the layers are unknown over uneven ground and holes.
struct TouchedCells {
    columns: RangeInclusive<i64>,
    rows: RangeInclusive<i64>,
    layers: Option<RangeInclusive<i64>>,
}

fn single(range: &RangeInclusive<i64>) -> Option<i64> {
    (range.start() == range.end()).then_some(*range.start())
}

impl CountingSpace<'_> {
    /// Height that layers are counted from, m, if it is the same everywhere.
    pub(super) fn level(&self) -> Option<f64> {
        self.ground.map_or(Some(0.0), GroundHeights::level)
    }

    fn touched(&self, PlacedBox { low, high }: &PlacedBox) -> TouchedCells {
        let ground = match self.ground {
            None => Some((0.0, 0.0)),
            Some(ground) => ground.range(low.truncate(), high.truncate()),
        };
        TouchedCells {
            columns: self.grid.touched(0, low.x, high.x),
            rows: self.grid.touched(1, low.y, high.y),
            layers: ground.map(|(lowest, highest)| {
                self.grid.layers_touched(low.z - highest, high.z - lowest)
            }),
        }
    }
}

impl<'a, 'b> Collector<'a, 'b> {
    pub(super) fn new(
        space: CountingSpace<'a>,
        scaled: ScaledTree<'a>,
        placement: Placement,
        sums: &'b mut Sums,
    ) -> Self {
        let transform = PlacementTransform::new(&placement);
        let factor = f64::from(placement.scale.horizontal).powi(2);
        Self { space, scaled, placement, transform, factor, sums }
    }

    /// Adds all surfaces of the tree.
    pub(super) fn collect(&mut self) {
        let ScaledTree { surfaces, areas, .. } = self.scaled;
        let grid = self.space.grid;
        // Depth of the tree: it is halved until few surfaces are left.
        let mut stack = Vec::with_capacity(64);
        stack.push(0_u32);
        while let Some(index) = stack.pop() {
            let node = surfaces.tree.nodes()[index as usize];
            let bounds = self.transform.bounds(node.middle_and_half());
            let touched = self.space.touched(&bounds);
            let area = areas.nodes[index as usize];
            if grid.is_outside([&touched.columns, &touched.rows]) {
                self.add(grid.elsewhere(Elsewhere::Outside), area);
                continue;
            }
            let ground_cell = single(&touched.columns).zip(single(&touched.rows));
            if let Some((column, row)) = ground_cell {
                let cell = grid.ground_cell(column, row);
                // A single column that is not inside is outside, which was looked at.
                let Some(cell) = cell else { continue };
                match &touched.layers {
                    Some(layers) if let Some(layer) = single(layers) => {
                        self.add(grid.slot(cell, layer), area);
                        continue;
                    }
                    Some(layers)
                        if index == 0 && self.scaled.table.is_some() && self.is_upright() =>
                    {
                        self.add_layers(cell, layers.clone());
                        continue;
                    }
                    _ => {}
                }
            }
            match node.children(index) {
                Some(children) => stack.extend(children),
                None => node.places().for_each(|place| self.add_surface(place)),
            }
        }
    }

    /// Returns whether heights of the object are heights of the world but for scale and offset.
    fn is_upright(&self) -> bool {
        self.placement.lean.tilt == Lean::UPRIGHT.tilt
            && self.placement.scale.vertical > 0.0
            && self.space.level().is_some()
    }

    fn add(&mut self, slot: usize, area: f64) {
        self.sums.add_at(slot, self.scaled.surfaces.class, area * self.factor);
    }

    /// Adds the whole tree, which stands upright above one cell of the ground, layer by layer.
    fn add_layers(&mut self, cell: usize, layers: RangeInclusive<i64>) {
        let (Some(table), Some(level)) = (self.scaled.table, self.space.level()) else { return };
        let ScaledAreas { surfaces, below, nodes } = self.scaled.areas;
        let grid = self.space.grid;
        let base = level - self.placement.position.z;
        let mut counted = 0.0;
        for layer in layers.clone() {
            let up_to = if layer == *layers.end() {
                nodes[0]
            } else {
                let top = grid.layer_side(layer + 1) + base;
                let height = top / f64::from(self.placement.scale.vertical);
                table.area_below(height, surfaces, below)
            };
            self.add(grid.slot(cell, layer), up_to - counted);
            counted = up_to;
        }
    }

    /// Adds one surface, cut into cells.
    fn add_surface(&mut self, place: usize) {
        let patch = self.transform.patch(&self.scaled.surfaces.tree.patch(place));
        let area = self.scaled.areas.surfaces[place];
        let (low, high) = patch.bounds();
        let grid = self.space.grid;
        let ground = self.space.ground.map_or(Some(0.0), |ground| {
            ground.level().or_else(|| ground.below(patch.middle().truncate()))
        });
        let layers = ground.map(|ground| grid.layers_touched(low.z - ground, high.z - ground));
        let columns = grid.touched(0, low.x, high.x);
        let rows = grid.touched(1, low.y, high.y);
        let cut = CutSurface { patch, area, ground: ground.unwrap_or(0.0), layers };
        let is_one = single(&columns).and(single(&rows)).is_some()
            && cut.layers.as_ref().is_none_or(|layers| single(layers).is_some());
        if is_one {
            self.add_piece(&cut, None, *columns.start(), *rows.start());
            return;
        }
        let by_column = patch.slices(patch.whole(), 0, columns, |column| grid.side(0, column));
        for (column, piece) in by_column {
            let by_row = patch.slices(piece, 1, rows.clone(), |row| grid.side(1, row));
            for (row, piece) in by_row {
                self.add_piece(&cut, Some(piece), column, row);
            }
        }
    }

    /// Adds the part of a surface above a cell of the ground; the whole surface if there is no piece.
    fn add_piece(&mut self, cut: &CutSurface, piece: Option<PatchPiece>, column: i64, row: i64) {
        let grid = self.space.grid;
        let area =
            |piece: Option<PatchPiece>| cut.area * piece.map_or(1.0, |piece| piece.fraction());
        let Some(cell) = grid.ground_cell(column, row) else {
            self.add(grid.elsewhere(Elsewhere::Outside), area(piece));
            return;
        };
        let Some(layers) = cut.layers.clone() else {
            self.add(grid.elsewhere(Elsewhere::OverHole), area(piece));
            return;
        };
        let Some(piece) = piece else {
            self.add(grid.slot(cell, *layers.start()), area(None));
            return;
        };
        let side = |layer| grid.layer_side(layer) + cut.ground;
        for (layer, piece) in cut.patch.slices(piece, 2, layers, side) {
            self.add(grid.slot(cell, layer), area(Some(piece)));
        }
    }
}

/// A surface that is being cut into cells.
struct CutSurface {
    patch: FlatPatch,
    /// Area before the factor of the instance, m².
    area: f64,
    /// Height of the ground below its middle, m.
    ground: f64,
    /// Layers that it touches; `None` over a hole.
    layers: Option<RangeInclusive<i64>>,
}
