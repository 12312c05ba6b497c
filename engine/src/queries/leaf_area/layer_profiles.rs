//! Areas of columns of an upright mesh below any height, without a look at most of their surfaces.

use std::ops::Range;

use glam::{DVec2, Vec2};

use crate::components::Placement;
use crate::geometry::round_up;
use crate::queries::cell_grid::{CellFinder, CellGrid, CellNumbers};
use crate::queries::surfaces::{CoordinateSpan, FlatPatch, SurfaceTree, TreeNode};

/// Areas by height of the nodes of a tree.
///
/// A node of many surfaces is divided into slices of equal height. In a slice that lies between two corners of a
/// triangle, the area of the triangle below a height is a polynomial of second degree, so that one polynomial holds for
/// all of these triangles together. The few surfaces that have a corner in a slice are looked at one by one, and so are
/// all discs in it. Nodes of few surfaces have no table: their surfaces are looked at.
#[derive(Debug)]
pub(super) struct LayerProfiles {
    /// Surfaces in the order of the tree.
    surfaces: Vec<SurfaceSpan>,
    /// Table of each node, or [`NONE`].
    table_of_node: Vec<u32>,
    tables: Vec<HeightTable>,
    slices: Vec<HeightSlice>,
    /// Places of surfaces that are looked at one by one, slice by slice.
    entries: Vec<u32>,
}

/// Layers around an upright instance above level ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct UprightLayers<'a> {
    grid: &'a CellGrid,
    finder: CellFinder,
    /// Height above the ground of a height `z` in object space is `scale · z + base`, m.
    scale: f64,
    base: f64,
}

/// Heights of a surface in object space, and its area, m².
#[derive(Clone, Copy, Debug)]
struct SurfaceSpan {
    heights: CoordinateSpan,
    area: f64,
    footprint: Footprint,
}

/// Rectangle around a surface seen from above, m, object space: its middle and half its extent.
#[derive(Clone, Copy, Debug)]
struct Footprint {
    middle: Vec2,
    half: Vec2,
}

/// Slices of a node.
#[derive(Clone, Copy, Debug)]
struct HeightTable {
    low: f64,
    high: f64,
    slices_per_m: f64,
    first_slice: usize,
    slices: usize,
    area: f64,
}

/// A slice of a table: the area below a height is `constant + linear t + quadratic t²` and what entries add, m², where
/// `t` goes from 0 at the bottom to 1 at the top.
#[derive(Clone, Copy, Debug, Default)]
struct HeightSlice {
    constant: f64,
    linear: f64,
    quadratic: f64,
    /// Its first entry.
    entries: u32,
}

/// Part of a surface in a slice that it reaches into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SlicePart {
    /// It is looked at for itself.
    Entry,
    /// A triangle whose middle corner is higher.
    LowerHalf,
    /// A triangle whose middle corner is lower.
    UpperHalf,
}

const NONE: u32 = u32::MAX;

/// Surfaces from which a node has a table.
const TABLE_FROM: usize = 48;

/// Surfaces of a node for each slice.
const PER_SLICE: usize = 2;

/// Slices that a triangle reaches into, on average at most.
const MOST_SLICES: f64 = 64.0;

/// Slices that a disc reaches into, on average at most.
const MOST_SLICES_OF_DISC: f64 = 2.0;

impl<'a> UprightLayers<'a> {
    /// Layers around an instance.
    ///
    /// - `level`: height of the ground, m
    pub(super) fn new(
        grid: &'a CellGrid,
        finder: CellFinder,
        placement: &Placement,
        level: f64,
    ) -> Self {
        let base = placement.position.z - level;
        Self { grid, finder, scale: placement.scale.vertical.into(), base }
    }

    /// Layers that a range of heights in object space touches.
    fn touched(&self, (low, high): (f64, f64)) -> CellNumbers {
        self.finder.layers(low * self.scale + self.base, high * self.scale + self.base)
    }

    /// Height of the upper side of a layer in object space, m.
    fn top(&self, layer: i64) -> f64 {
        (self.grid.layer_side(layer + 1) - self.base) / self.scale
    }
}

impl SurfaceSpan {
    fn new(patch: &FlatPatch, area: f64) -> Self {
        let (low, high) = patch.bounds();
        let middle = (0.5 * (low + high)).as_vec3().truncate();
        // Rounding must not make it smaller.
        let reach = (high - middle.extend(0.0).as_dvec3()).max(middle.extend(0.0).as_dvec3() - low);
        let half = Vec2::new(round_up(reach.x), round_up(reach.y));
        let heights = CoordinateSpan::new(patch, 2);
        Self { heights, area, footprint: Footprint { middle, half } }
    }

    /// Calls `add` with the layers that the surface lies in, and its area in each.
    fn add(&self, layers: &UprightLayers<'_>, add: &mut impl FnMut(i64, f64)) {
        let Self { heights, area, .. } = self;
        let touched = layers.touched(heights.range());
        let mut counted = 0.0;
        for layer in touched.range() {
            let is_last = layer == touched.last;
            let up_to = if is_last { 1.0 } else { heights.fraction_below(layers.top(layer)) };
            add(layer, area * (up_to - counted));
            counted = up_to;
        }
    }
}

/// Memory for each surface, bytes, about.
const BYTES: usize = 256;

impl LayerProfiles {
    /// Memory that the tables of some surfaces take, bytes.
    pub(super) const fn bytes(surfaces: usize) -> u64 {
        surfaces as u64 * BYTES as u64
    }

    /// Areas by height of a tree of columns.
    ///
    /// - `areas`: of each surface, m², in the order of the tree
    pub(super) fn new(tree: &SurfaceTree<'_>, areas: &[f64]) -> Self {
        let span = |(place, &area): (usize, &f64)| SurfaceSpan::new(&tree.patch(place), area);
        let mut profiles = Self {
            surfaces: areas.iter().enumerate().map(span).collect(),
            table_of_node: vec![NONE; tree.nodes().len()],
            tables: Vec::new(),
            slices: Vec::new(),
            entries: Vec::new(),
        };
        // A node whose parent has a table has none: its children do.
        let mut stack = vec![(0_u32, true)];
        while let Some((index, has_table)) = stack.pop() {
            let node = &tree.nodes()[index as usize];
            if node.places().len() < TABLE_FROM {
                continue;
            }
            if has_table {
                profiles.table_of_node[index as usize] = profiles.tables.len() as u32;
                profiles.add_table(node.places());
            }
            stack.extend(
                node.children(index).into_iter().flatten().map(|child| (child, !has_table)),
            );
        }
        profiles
    }

    /// Returns whether [`Self::add_node`] takes a node: its children are to be taken otherwise.
    pub(super) fn has_node(&self, node: &TreeNode, index: u32) -> bool {
        self.table_of_node[index as usize] < NONE || node.places().len() < TABLE_FROM
    }

    /// Calls `add` with the layers that a node of an upright instance lies in, and its area in each.
    pub(super) fn add_node(
        &self,
        node: &TreeNode,
        index: u32,
        layers: &UprightLayers<'_>,
        mut add: impl FnMut(i64, f64),
    ) {
        let table = self.tables.get(self.table_of_node[index as usize] as usize);
        let Some(table) = table else {
            for surface in &self.surfaces[node.places()] {
                surface.add(layers, &mut add);
            }
            return;
        };
        let touched = layers.touched((table.low, table.high));
        let mut counted = 0.0_f64;
        for layer in touched.range() {
            let is_last = layer == touched.last;
            let up_to =
                if is_last { table.area } else { self.area_below(table, layers.top(layer)) };
            // Rounding must not make an area negative.
            add(layer, (up_to - counted).max(0.0));
            counted = counted.max(up_to);
        }
    }

    /// Calls `add` with the layers that a surface of an upright instance lies in, and its area in each.
    pub(super) fn add_surface(
        &self,
        place: usize,
        layers: &UprightLayers<'_>,
        mut add: impl FnMut(i64, f64),
    ) {
        self.surfaces[place].add(layers, &mut add);
    }

    /// Rectangle around a surface seen from above, m, object space: its middle and half its extent.
    pub(super) fn footprint(&self, place: usize) -> (DVec2, DVec2) {
        let Footprint { middle, half } = self.surfaces[place].footprint;
        (middle.as_dvec2(), half.as_dvec2())
    }

    /// Area of a table's node below a height of object space, m².
    fn area_below(&self, table: &HeightTable, height: f64) -> f64 {
        if height <= table.low {
            return 0.0;
        }
        if height >= table.high {
            return table.area;
        }
        let at = (height - table.low) * table.slices_per_m;
        let number = (at as usize).min(table.slices - 1);
        let t = at - number as f64;
        let [slice, next] = [0, 1].map(|offset| self.slices[table.first_slice + number + offset]);
        let cut =
            self.entries[slice.entries as usize..next.entries as usize].iter().map(|&place| {
                let SurfaceSpan { heights, area, .. } = &self.surfaces[place as usize];
                area * heights.fraction_below(height)
            });
        slice.constant + t * (slice.linear + t * slice.quadratic) + cut.sum::<f64>()
    }

    /// Adds the table of a node with some surfaces.
    fn add_table(&mut self, places: Range<usize>) {
        let surfaces = &self.surfaces[places.clone()];
        let (mut low, mut high, mut all, mut most) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0.0);
        for SurfaceSpan { heights, .. } in surfaces {
            let (bottom, top) = heights.range();
            (low, high) = (low.min(bottom), high.max(top));
            all += top - bottom;
            most += match heights {
                CoordinateSpan::Triangle(_) => MOST_SLICES,
                CoordinateSpan::Ellipse(..) => MOST_SLICES_OF_DISC,
            };
        }
        let height = high - low;
        // Horizontal surfaces have no height.
        let count = if all > 0.0 { most * height / all } else { f64::INFINITY };
        let count = count.min((surfaces.len() / PER_SLICE) as f64).max(1.0).floor();
        let table = HeightTable {
            low,
            high,
            slices_per_m: if height > 0.0 { count / height } else { 0.0 },
            first_slice: self.slices.len(),
            slices: count as usize,
            area: surfaces.iter().map(|surface| surface.area).sum(),
        };
        self.tables.push(table);
        let (slices, entries) = table.filled(surfaces, places.start as u32, self.entries.len());
        self.slices.extend(slices);
        self.entries.extend(entries);
    }
}

impl HeightTable {
    /// Slices of the table and one behind them, and the entries of all.
    ///
    /// - `first`: place of the first surface
    /// - `start`: number of the first entry
    fn filled(
        &self,
        surfaces: &[SurfaceSpan],
        first: u32,
        start: usize,
    ) -> (Vec<HeightSlice>, Vec<u32>) {
        let mut slices = vec![HeightSlice::default(); self.slices + 1];
        for surface in surfaces {
            self.for_each_slice(&surface.heights, |slice, part| {
                if part == SlicePart::Entry {
                    slices[slice].entries += 1;
                } else {
                    let is_lower = part == SlicePart::LowerHalf;
                    let bottom = self.low + slice as f64 / self.slices_per_m;
                    slices[slice].add(surface, is_lower, bottom, 1.0 / self.slices_per_m);
                }
            });
        }
        // A surface that ends in a slice lies below all slices that follow; polynomials hold in theirs alone.
        let mut ended = vec![0.0; self.slices + 1];
        for surface in surfaces {
            ended[self.slice(surface.heights.range().1) + 1] += surface.area;
        }
        let (mut below, mut next) = (0.0, start as u32);
        for (slice, ended) in slices.iter_mut().zip(&ended) {
            below += ended;
            slice.constant += below;
            let count = slice.entries;
            slice.entries = next;
            next += count;
        }
        let mut entries = vec![0; next as usize - start];
        let mut free: Vec<u32> = slices.iter().map(|slice| slice.entries).collect();
        for (place, surface) in (first..).zip(surfaces) {
            self.for_each_slice(&surface.heights, |slice, part| {
                if part == SlicePart::Entry {
                    entries[free[slice] as usize - start] = place;
                    free[slice] += 1;
                }
            });
        }
        (slices, entries)
    }

    fn slice(&self, height: f64) -> usize {
        // The highest point lies in the last slice.
        (((height - self.low) * self.slices_per_m).max(0.0) as usize).min(self.slices - 1)
    }

    /// Calls `f` with all slices that a surface reaches into.
    fn for_each_slice(&self, heights: &CoordinateSpan, mut f: impl FnMut(usize, SlicePart)) {
        let (low, high) = heights.range();
        let (first, last) = (self.slice(low), self.slice(high));
        let middle = match *heights {
            CoordinateSpan::Triangle([_, middle, _]) => Some(self.slice(middle)),
            CoordinateSpan::Ellipse(..) => None,
        };
        for slice in first..=last {
            let part = match middle {
                Some(middle) if slice > first && slice < middle => SlicePart::LowerHalf,
                Some(middle) if slice > middle && slice < last => SlicePart::UpperHalf,
                _ => SlicePart::Entry,
            };
            f(slice, part);
        }
    }
}

impl HeightSlice {
    /// Adds a triangle that has no corner in the slice.
    ///
    /// - `is_lower`: true if the slice lies below the middle corner
    /// - `bottom`: height of the slice's bottom, m
    /// - `thickness`: its height, m
    fn add(&mut self, surface: &SurfaceSpan, is_lower: bool, bottom: f64, thickness: f64) {
        let CoordinateSpan::Triangle([low, middle, high]) = surface.heights else { return };
        if is_lower {
            let factor = surface.area / ((middle - low) * (high - low));
            let from = bottom - low;
            self.constant += factor * from * from;
            self.linear += 2.0 * factor * from * thickness;
            self.quadratic += factor * thickness * thickness;
        } else {
            let factor = surface.area / ((high - middle) * (high - low));
            let from = high - bottom;
            self.constant += surface.area - factor * from * from;
            self.linear += 2.0 * factor * from * thickness;
            self.quadratic -= factor * thickness * thickness;
        }
    }
}
