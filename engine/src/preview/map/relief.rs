//! Ground of a map: hillshade, and contours where there is relief.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::drawing::{DrawnItem, Ink, Paint, PixelLayer};
use super::page::{PageProjection, round_step};
use crate::geometry::Rectangle;
use crate::terrain::Ground;

/// Points along the longer side of the grid of heights.
const POINTS: usize = 500;

/// Contours that relief is cut into at most, and pieces of all lines.
const MOST_LEVELS: f64 = 10.0;
const MOST_PIECES: usize = 20_000;

/// Brightness of level ground, and colour of holes.
const LEVEL: f64 = 0.94;
const HOLE: [u8; 4] = [205, 205, 215, 255];

/// Heights of the ground on an even grid over its rectangle, northernmost row first; NaN in holes.
#[derive(Clone, Debug)]
pub(super) struct ReliefGrid {
    rectangle: Rectangle,
    columns: usize,
    rows: usize,
    heights: Vec<f64>,
    /// Fraction of the light from the north-west that the ground reflects, NaN in holes.
    shades: Vec<f64>,
    /// Lowest and highest ground, m.
    pub(super) range: Option<[f64; 2]>,
}

/// Relief as items of a drawing.
pub(super) struct DrawnRelief {
    /// Hillshade.
    pub(super) ground: DrawnItem,
    /// Contours.
    pub(super) contours: Option<DrawnItem>,
    /// Difference in height between contours, m; `None` without contours.
    pub(super) interval: Option<f64>,
    pub(super) has_holes: bool,
}

impl ReliefGrid {
    pub(super) fn new(ground: &Ground, rectangle: Rectangle) -> Self {
        let size = rectangle.size();
        let counts = (size / size.max_element() * POINTS as f64).ceil().max(DVec2::splat(2.0));
        let (columns, rows) = (counts.x as usize, counts.y as usize);
        let at = |index: usize| {
            let (column, row) = (index % columns, index / columns);
            let part = DVec2::new(column as f64 + 0.5, row as f64 + 0.5) / counts;
            DVec2::new(rectangle.min.x + part.x * size.x, rectangle.max.y - part.y * size.y)
        };
        let light = DVec3::new(-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2);
        let points = (0..columns * rows).into_par_iter().map(|index| {
            let place = at(index);
            let height = ground.height(place).unwrap_or(f64::NAN);
            let shade = ground.normal(place).map_or(f64::NAN, |normal| normal.dot(light).max(0.0));
            (height, shade)
        });
        let (heights, shades): (Vec<f64>, Vec<f64>) = points.unzip();
        let known = || heights.iter().copied().filter(|height| height.is_finite());
        let range = known().reduce(f64::min).zip(known().reduce(f64::max));
        Self { rectangle, columns, rows, heights, shades, range: range.map(|(l, h)| [l, h]) }
    }

    /// Returns whether the ground has less relief than a map can show.
    fn is_level(&self) -> bool {
        self.relief() < 1e-3 * self.rectangle.size().max_element()
    }

    /// Difference between the highest and the lowest ground, m.
    fn relief(&self) -> f64 {
        self.range.map_or(0.0, |[low, high]| high - low)
    }

    pub(super) fn draw(&self, projection: &PageProjection) -> DrawnRelief {
        let has_holes = self.heights.iter().any(|height| height.is_nan());
        let ground = DrawnItem::Pixels(self.hillshade(projection));
        if self.is_level() {
            return DrawnRelief { ground, contours: None, interval: None, has_holes };
        }
        let mut interval = round_step(self.relief() / MOST_LEVELS);
        let mut lines = self.contours(interval, projection);
        while lines.len() > MOST_PIECES {
            interval = round_step(2.0 * interval);
            lines = self.contours(interval, projection);
        }
        let ink = Ink::with_opacity([120, 90, 50], 0.55);
        let contours = DrawnItem::Path { lines, is_closed: false, paint: Paint::line(ink, 0.8) };
        DrawnRelief { ground, contours: Some(contours), interval: Some(interval), has_holes }
    }

    fn hillshade(&self, projection: &PageProjection) -> PixelLayer {
        let is_level = self.is_level();
        let colour = |&shade: &f64| {
            if shade.is_nan() {
                return HOLE;
            }
            let brightness = if is_level { LEVEL } else { 0.55 + 0.4 * shade };
            // A little warm, so that it is no grey of a legend.
            let [r, g, b] =
                [1.0, 0.985, 0.95].map(|tint| (255.0 * brightness * tint).round() as u8);
            [r, g, b, 255]
        };
        let rgba: Vec<u8> = self.shades.iter().flat_map(colour).collect();
        let Rectangle { min, max } = self.rectangle;
        let corner = projection.page(DVec2::new(min.x, max.y));
        let extent = projection.page(DVec2::new(max.x, min.y)) - corner;
        PixelLayer { corner, extent, columns: self.columns, rows: self.rows, rgba, is_smooth: true }
    }

    /// Pieces of the lines of equal height, by marching squares; one piece in each cell that a line crosses.
    fn contours(&self, interval: f64, projection: &PageProjection) -> Vec<Vec<DVec2>> {
        let Some([low, high]) = self.range else { return Vec::new() };
        let first = (low / interval).ceil() as i64;
        let last = (high / interval).floor() as i64;
        let cells = (self.rows - 1) * (self.columns - 1);
        let mut pieces = Vec::new();
        for level in (first..=last).map(|level| level as f64 * interval) {
            for cell in 0..cells {
                let (row, column) = (cell / (self.columns - 1), cell % (self.columns - 1));
                self.cross(row, column, level, projection, &mut pieces);
            }
        }
        pieces
    }

    /// Adds the pieces of a line in a cell.
    fn cross(
        &self,
        row: usize,
        column: usize,
        level: f64,
        projection: &PageProjection,
        pieces: &mut Vec<Vec<DVec2>>,
    ) {
        let corners = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(r, c)| (row + r, column + c));
        let heights = corners.map(|(r, c)| self.heights[r * self.columns + c]);
        if heights.iter().any(|height| height.is_nan()) {
            return;
        }
        let mut crossings = Vec::new();
        for side in 0..4 {
            let (from, to) = (side, (side + 1) % 4);
            if (heights[from] < level) != (heights[to] < level) {
                let part = (level - heights[from]) / (heights[to] - heights[from]);
                let [a, b] = [corners[from], corners[to]]
                    .map(|(r, c)| DVec2::new(c as f64 + 0.5, r as f64 + 0.5));
                crossings.push(self.page(a.lerp(b, part), projection));
            }
        }
        pieces.extend(crossings.chunks_exact(2).map(<[DVec2]>::to_vec));
    }

    /// Place on the page of grid coordinates.
    fn page(&self, at: DVec2, projection: &PageProjection) -> DVec2 {
        let size = self.rectangle.size();
        let part = at / DVec2::new(self.columns as f64, self.rows as f64);
        let Rectangle { min, max } = self.rectangle;
        projection.page(DVec2::new(min.x + part.x * size.x, max.y - part.y * size.y))
    }
}
