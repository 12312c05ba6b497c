//! Areas of placed meshes, added up in the cells that they lie in.

use std::ops::Range;

use super::areas::ScaledAreas;
use super::layer_profiles::{LayerProfiles, UprightLayers};
use super::window::{CellExtent, CellPlace, InstanceAreas};
use crate::components::{Lean, Placement};
use crate::queries::cell_grid::{CellFinder, CellGrid};
use crate::queries::surfaces::{
    CoordinateSpan, FlatPatch, GroundHeights, PatchPiece, PlacedBox, PlacementTransform,
    SurfaceTree,
};
use crate::statistics::Sums;
use crate::terrain::{GroundPlane, Relief};

/// Surfaces of a node from which the ground below it is looked up; smaller ones have that of their parent.
const SMALL: usize = 8;

/// Grid and ground that areas are counted by.
#[derive(Clone, Copy, Debug)]
pub(super) struct CountingSpace<'a> {
    pub(super) grid: &'a CellGrid,
    pub(super) finder: CellFinder,
    /// Ground that heights are counted from; `None` if they are absolute.
    pub(super) ground: Option<&'a GroundHeights<'a>>,
}

/// Surfaces of one class of a mesh with their areas under a scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaledTree<'a> {
    pub(super) tree: &'a SurfaceTree<'a>,
    pub(super) class: usize,
    pub(super) areas: &'a ScaledAreas,
    /// Areas by height, if the tree is one of columns for upright instances.
    pub(super) profiles: Option<&'a LayerProfiles>,
}

/// Sums that areas are added to.
#[derive(Debug)]
pub(super) struct AreaSums {
    pub(super) sums: Sums,
    window: InstanceAreas,
}

/// Adds the areas of an instance to sums.
pub(super) struct Collector<'a, 'b> {
    space: CountingSpace<'a>,
    scaled: ScaledTree<'a>,
    transform: PlacementTransform,
    /// Tables by height with the layers around an upright instance.
    profiles: Option<(&'a LayerProfiles, UprightLayers<'a>)>,
    /// Factor of the areas.
    factor: f64,
    to: &'b mut AreaSums,
}

/// A surface that is added.
struct AddedSurface {
    patch: FlatPatch,
    /// Area before the factor of the instance, m².
    area: f64,
    /// Height of the ground below its middle, m; `None` over a hole.
    ground: Option<f64>,
    extent: CellExtent,
}

impl CountingSpace<'_> {
    /// Height that layers are counted from, m, if it is the same everywhere.
    pub(super) fn level(&self) -> Option<f64> {
        self.ground.map_or(Some(0.0), GroundHeights::level)
    }
}

impl AreaSums {
    pub(super) fn new(sums: Sums) -> Self {
        Self { sums, window: InstanceAreas::new() }
    }
}

/// Returns whether heights of the object are heights of the world but for scale and offset.
pub(super) fn is_upright(placement: &Placement) -> bool {
    placement.lean.tilt == Lean::UPRIGHT.tilt && placement.scale.vertical > 0.0
}

impl<'a, 'b> Collector<'a, 'b> {
    pub(super) fn new(
        space: CountingSpace<'a>,
        scaled: ScaledTree<'a>,
        placement: &Placement,
        to: &'b mut AreaSums,
    ) -> Self {
        let transform = PlacementTransform::new(placement);
        let factor = f64::from(placement.scale.horizontal).powi(2);
        let level = space.level().filter(|_| is_upright(placement));
        let CountingSpace { grid, finder, .. } = space;
        let layers = level.map(|level| UprightLayers::new(grid, finder, placement, level));
        let profiles = scaled.profiles.zip(layers);
        Self { space, scaled, transform, profiles, factor, to }
    }

    /// Adds all surfaces of the tree.
    pub(super) fn collect(&mut self) {
        let ScaledTree { tree, areas, class, .. } = self.scaled;
        let grid = self.space.grid;
        let ground = self.space.level().map(|level| Relief::Plane(GroundPlane::level(level)));
        let bounds = self.bounds(0);
        let all = CellExtent::below(&self.space.finder, &bounds);
        self.to.window.open(all, grid, tree.len());
        if self.profiles.is_some_and(|(profiles, _)| profiles.has_node(&tree.nodes()[0], 0)) {
            let middle = 0.5 * (bounds.low + bounds.high);
            let finder = &self.space.finder;
            let (column, row) = (finder.along(0, middle.x), finder.along(1, middle.y));
            self.to.window.leave_out(CellPlace { column, row, layer: 0 }, &all);
        }
        // Depth of the tree: it is halved until few surfaces are left.
        let mut stack = Vec::with_capacity(64);
        stack.push((0_u32, ground));
        while let Some((index, mut ground)) = stack.pop() {
            let node = &tree.nodes()[index as usize];
            let extent = self.extent(index, &mut ground);
            let area = areas.nodes[index as usize];
            if extent.is_outside(grid) {
                self.to.window.add_outside(area);
                continue;
            }
            if extent.is_one_column() {
                let CellPlace { column, row, .. } = extent.first();
                if self.to.window.is_left_out(column, row) {
                    continue;
                }
                if extent.layers.is_one() {
                    self.add(extent.first(), area);
                    continue;
                }
                if let Some((profiles, layers)) = self.profiles
                    && profiles.has_node(node, index)
                {
                    let first = extent.first();
                    profiles.add_node(node, index, &layers, |layer, area| {
                        self.add(CellPlace { layer, ..first }, area);
                    });
                    continue;
                }
            }
            match node.children(index) {
                Some([left, right]) => stack.extend([(left, ground), (right, ground)]),
                None => self.add_surfaces(node.places(), ground),
            }
        }
        if let Some((profiles, layers)) = self.profiles {
            let root = &tree.nodes()[0];
            self.to.window.add_rest(|add| profiles.add_node(root, 0, &layers, add));
        }
        self.to.window.close(grid, class, self.factor, &mut self.to.sums);
    }

    /// Box around a node in the world.
    fn bounds(&self, index: u32) -> PlacedBox {
        self.transform.bounds(self.scaled.tree.nodes()[index as usize].middle_and_half())
    }

    /// Cells that a node touches; all layers if its height above the ground is unknown.
    ///
    /// - `ground`: ground below the node's parent; becomes that below the node
    fn extent(&self, index: u32, ground: &mut Option<Relief>) -> CellExtent {
        let bounds = self.bounds(index);
        let finder = &self.space.finder;
        let mut extent = CellExtent::below(finder, &bounds);
        let (low, high) = (bounds.low.truncate(), bounds.high.truncate());
        // Ranges of small nodes are hardly wider than those of their parts.
        let is_small = || self.scaled.tree.nodes()[index as usize].places().len() <= SMALL;
        let is_known = match ground {
            Some(Relief::Plane(_)) => true,
            Some(Relief::Range { .. }) => is_small(),
            None => false,
        };
        if !is_known {
            *ground = self.space.ground.and_then(|ground| ground.relief(low, high));
        }
        let (lowest, highest) = match ground {
            None => return extent,
            Some(Relief::Range { lowest, highest }) => (*lowest, *highest),
            Some(Relief::Plane(plane)) => plane.range(low, high),
        };
        extent.layers = finder.layers(bounds.low.z - highest, bounds.high.z - lowest);
        extent
    }

    /// Adds area to a cell.
    fn add(&mut self, place: CellPlace, area: f64) {
        if self.to.window.has_cells() {
            self.to.window.add(place, area);
            return;
        }
        let grid = self.space.grid;
        match grid.ground_cell(place.column, place.row) {
            None => self.to.window.add_outside(area),
            Some(cell) => {
                let slot = grid.slot(cell, place.layer);
                self.to.sums.add_at(slot, self.scaled.class, area * self.factor);
            }
        }
    }

    /// Adds surfaces of a node that has no children.
    fn add_surfaces(&mut self, places: Range<usize>, ground: Option<Relief>) {
        let plane = match ground {
            Some(Relief::Plane(plane)) => Some(plane),
            _ => None,
        };
        for place in places {
            if let Some((profiles, layers)) = self.profiles {
                let finder = &self.space.finder;
                let footprint = self.transform.footprint(profiles.footprint(place));
                let first = CellExtent::below(finder, &footprint);
                if first.is_one_column() {
                    let first = first.first();
                    if self.to.window.is_left_out(first.column, first.row) {
                        continue;
                    }
                    profiles.add_surface(place, &layers, |layer, area| {
                        self.add(CellPlace { layer, ..first }, area);
                    });
                    continue;
                }
            }
            self.add_surface(place, plane);
        }
    }

    /// Adds one surface, cut into cells.
    fn add_surface(&mut self, place: usize, plane: Option<GroundPlane>) {
        let patch = self.transform.patch(&self.scaled.tree.patch(place));
        let area = self.scaled.areas.surfaces[place];
        let (low, high) = patch.bounds();
        let middle = patch.middle().truncate();
        let ground = match (plane, self.space.ground) {
            (Some(plane), _) => Some(plane.at(middle)),
            (None, Some(ground)) => ground.below(middle),
            (None, None) => Some(0.0),
        };
        let finder = &self.space.finder;
        let layers = |ground: f64| finder.layers(low.z - ground, high.z - ground);
        let extent = CellExtent {
            columns: finder.touched(0, low.x, high.x),
            rows: finder.touched(1, low.y, high.y),
            // Over a hole there are no layers.
            layers: ground.map_or_else(|| finder.layers(0.0, 0.0), layers),
        };
        let surface = AddedSurface { patch, area, ground, extent };
        let CellExtent { columns, rows, layers } = extent;
        match (columns.is_one(), rows.is_one(), layers.is_one()) {
            (true, true, true) => self.add_part(&surface, extent.first(), area),
            (false, true, true) => self.add_slices(&surface, 0),
            (true, false, true) => self.add_slices(&surface, 1),
            (true, true, false) => self.add_slices(&surface, 2),
            _ => self.add_pieces(&surface),
        }
    }

    /// Adds a surface that lies in several cells along one axis.
    fn add_slices(&mut self, surface: &AddedSurface, axis: usize) {
        let AddedSurface { patch, area, ground, extent } = surface;
        let grid = self.space.grid;
        let span = CoordinateSpan::new(patch, axis);
        let numbers = [extent.columns, extent.rows, extent.layers][axis];
        let mut below = 0.0;
        for number in numbers.range() {
            let up_to = match axis {
                _ if number == numbers.last => 1.0,
                2 => span.fraction_below(grid.layer_side(number + 1) + ground.unwrap_or(0.0)),
                _ => span.fraction_below(grid.side(axis, number + 1)),
            };
            let mut place = extent.first();
            match axis {
                0 => place.column = number,
                1 => place.row = number,
                _ => place.layer = number,
            }
            self.add_part(surface, place, area * (up_to - below));
            below = up_to;
        }
    }

    /// Adds a surface that lies in several cells along more than one axis.
    fn add_pieces(&mut self, surface: &AddedSurface) {
        let AddedSurface { patch, area, ground, extent } = surface;
        let grid = self.space.grid;
        let CellExtent { columns, rows, layers } = extent;
        let by_column =
            patch.slices(patch.whole(), 0, columns.range(), |column| grid.side(0, column));
        for (column, piece) in by_column {
            let by_row = patch.slices(piece, 1, rows.range(), |row| grid.side(1, row));
            for (row, piece) in by_row {
                let side = |layer| grid.layer_side(layer) + ground.unwrap_or(0.0);
                let by_layer = patch.slices(piece, 2, layers.range(), side);
                for (layer, piece) in by_layer {
                    let area = area * PatchPiece::fraction(&piece);
                    self.add_part(surface, CellPlace { column, row, layer }, area);
                }
            }
        }
    }

    /// Adds a part of a surface to a cell, or to what lies over holes.
    fn add_part(&mut self, surface: &AddedSurface, place: CellPlace, area: f64) {
        let is_inside = || self.space.grid.ground_cell(place.column, place.row).is_some();
        if surface.ground.is_none() && is_inside() {
            self.to.window.add_over_hole(area);
        } else {
            self.add(place, area);
        }
    }
}
