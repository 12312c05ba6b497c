//! Ground where stems may stand: a rectangle, only inside some polygons, outside others.

use glam::DVec2;

use super::PlacementError;
use super::locator::Locator;
use super::triangulation::{Triangles, triangulate};
use crate::geometry::{Polygon, Rectangle};

/// Part of the ground, as triangles that do not overlap.
///
/// Its area, whether a point lies in it, and uniform points in it are exact but for the rounding of numbers.
#[derive(Clone, Debug)]
pub struct Region {
    /// Corners of each triangle, counter-clockwise, m.
    triangles: Vec<[DVec2; 3]>,
    /// Sum of the areas of the triangles up to and including each, m².
    cumulative_areas: Vec<f64>,
    bounds: Rectangle,
    /// True without polygons: then the points of [`Region::sample`] need no triangles.
    is_rectangle: bool,
    locator: Locator,
}

impl Region {
    /// Creates the region of the points of a rectangle that lie in any polygon of `inside`, or all of them if
    /// there is none, and in no polygon of `outside`.
    ///
    /// # Errors
    /// A polygon that crosses itself (numbered through `inside`, then `outside`); an empty region; polygons
    /// too intricate.
    pub fn new(
        rectangle: Rectangle,
        inside: &[Polygon],
        outside: &[Polygon],
    ) -> Result<Self, PlacementError> {
        let Triangles { corners: mut triangles, outline } =
            triangulate(rectangle, inside, outside)?;
        let area = |&[a, b, c]: &[DVec2; 3]| 0.5 * (b - a).perp_dot(c - a);
        triangles.retain(|triangle| area(triangle) > 0.0);
        let mut sum = 0.0;
        let cumulative_areas = triangles.iter().map(|triangle| {
            sum += area(triangle);
            sum
        });
        let cumulative_areas = cumulative_areas.collect();
        let bounds = Rectangle::around(triangles.iter().flatten().copied());
        let bounds = bounds.ok_or(PlacementError::NoGround)?;
        let locator = Locator::new(bounds, &triangles, &outline);
        let is_rectangle = inside.is_empty() && outside.is_empty();
        Ok(Self { triangles, cumulative_areas, bounds, is_rectangle, locator })
    }

    /// Area, m².
    #[must_use]
    pub fn area(&self) -> f64 {
        self.cumulative_areas.last().copied().unwrap_or(0.0)
    }

    /// Smallest rectangle around the region.
    #[must_use]
    pub fn bounds(&self) -> Rectangle {
        self.bounds
    }

    /// Returns whether a point lies in the region.
    ///
    /// Points on the outline belong to it where the region lies right above them: of two regions with a
    /// horizontal side in common, one holds its points.
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        self.locator.contains(point, &self.triangles)
    }

    /// Returns false only if the region shares no points with a rectangle.
    #[must_use]
    pub fn may_overlap(&self, rectangle: Rectangle) -> bool {
        self.locator.may_overlap(rectangle, &self.triangles)
    }

    /// Returns a point, m, local frame, that is uniform in the region if `u` and `v` are uniform in (0, 1).
    #[must_use]
    pub fn sample(&self, u: f64, v: f64) -> DVec2 {
        if self.is_rectangle {
            return self.bounds.at(v, u);
        }
        let target = u * self.area();
        let last = self.triangles.len() - 1;
        let index = self.cumulative_areas.partition_point(|&area| area <= target).min(last);
        let below = if index == 0 { 0.0 } else { self.cumulative_areas[index - 1] };
        let fraction = (target - below) / (self.cumulative_areas[index] - below);
        // The area within a fraction r of the way from a to the opposite side grows with r².
        let distance = fraction.clamp(0.0, 1.0).sqrt();
        let [a, b, c] = self.triangles[index];
        a + distance * ((b - a) + v * (c - b))
    }
}
