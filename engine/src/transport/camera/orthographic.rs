use glam::{DMat2, DMat3, DVec2, DVec3, UVec2};

use crate::accel::Ray;
use crate::components::{Footprint, OrthographicOptics, View};
use crate::extract::Stage;
use crate::geometry::PixelGrid;
use crate::transport::ReferencePlane;

/// A parallel projection: a parallelogram in space, and the light that passes it in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct OrthographicCamera {
    /// Unit vector towards the sensor.
    pub towards: DVec3,
    /// Columns and rows.
    pub size: UVec2,
    corner: DVec3,
    right: DVec3,
    down: DVec3,
    /// Coordinates (along right, along down, along towards) of a displacement from the corner.
    film_from_world: DMat3,
    /// True if it shows every point of a periodic scene exactly once.
    covers_tile: bool,
    /// Plane through which light must leave to be seen, beyond crossing the parallelogram.
    plane: Option<ReferencePlane>,
}

impl OrthographicCamera {
    /// The image of an orthographic sensor: its middle looks at the ground point `center`.
    ///
    /// Up in the image is away from the sensor's side, so that a nadir view with the default azimuth
    /// of 180° has north up and oblique views show what stands upright as upright.
    #[must_use]
    pub fn from_sensor(sensor: &OrthographicOptics, size: UVec2, stage: &Stage) -> Self {
        let towards = sensor.view.direction();
        let (right, down) = view_axes(sensor.view);
        let (middle, extent) = footprint(sensor, stage);
        let right = right * extent.x;
        let down = down * extent.y;
        let corner = beyond(middle, towards, stage) - 0.5 * (right + down);
        let plane = sensor.plane.as_ref().map(|plane| ReferencePlane::new(Some(plane), stage));
        Self { plane, ..Self::new(towards, corner, right, down, size, false) }
    }

    /// The middle half of the scene's rectangle, each way, seen straight down.
    #[must_use]
    pub fn from_middle(stage: &Stage) -> Self {
        let corner = stage.corner + stage.size * DVec2::new(0.25, 0.75);
        let corner = beyond(corner.extend(stage.top()), DVec3::Z, stage);
        let (right, down) = (DVec3::X * stage.size.x * 0.5, -DVec3::Y * stage.size.y * 0.5);
        Self::new(DVec3::Z, corner, right, down, UVec2::ONE, false)
    }

    /// A reference plane seen in one direction.
    #[must_use]
    pub fn from_plane(view: View, plane: &ReferencePlane, stage: &Stage) -> Self {
        let north_west = DVec3::new(plane.corner.x, plane.corner.y + plane.size.y, plane.height);
        let right = DVec3::X * plane.size.x;
        let down = -DVec3::Y * plane.size.y;
        let towards = view.direction();
        let corner = beyond(north_west, towards, stage);
        let gate = plane.is_low().then(|| plane.clone());
        let whole = plane.covers_tile();
        Self { plane: gate, ..Self::new(towards, corner, right, down, UVec2::ONE, whole) }
    }

    fn new(
        towards: DVec3,
        corner: DVec3,
        right: DVec3,
        down: DVec3,
        size: UVec2,
        covers_tile: bool,
    ) -> Self {
        let film_from_world = DMat3::from_cols(right, down, towards).inverse();
        Self { towards, size, corner, right, down, film_from_world, covers_tile, plane: None }
    }

    /// Point of the parallelogram, m, local frame, from `(0, 0)` top left to `(1, 1)` bottom right.
    #[must_use]
    pub fn point(&self, at: DVec2) -> DVec3 {
        self.corner + self.right * at.x + self.down * at.y
    }

    /// The ray that ends up at a point of the parallelogram.
    #[must_use]
    pub fn ray(&self, at: DVec2) -> Ray {
        Ray { origin: self.point(at), direction: -self.towards, from: None }
    }

    /// Returns whether light that arrives against this ray can have left through the plane; adds the number of
    /// rays that it traced.
    pub fn admits(&self, ray: &Ray, stage: &Stage, rays: &mut u64) -> bool {
        let Some(plane) = &self.plane else { return true };
        plane.is_crossed_by(ray)
            && plane.clearance(ray).is_none_or(|above| {
                *rays += 1;
                !stage.geometry.occluded_within(ray, above)
            })
    }

    /// Returns whether light must leave through a plane to be seen.
    #[must_use]
    pub const fn has_plane(&self) -> bool {
        self.plane.is_some()
    }

    /// Number of pixels.
    #[must_use]
    pub const fn pixels(&self) -> usize {
        self.size.x as usize * self.size.y as usize
    }

    /// Area of one pixel perpendicular to the view, m².
    #[must_use]
    pub fn pixel_area(&self) -> f64 {
        let whole = self.right.cross(self.down).dot(self.towards).abs();
        whole / f64::from(self.size.x) / f64::from(self.size.y)
    }

    /// `L / E` of a pixel, sr⁻¹, over what a virtual photon count gives for it: `I = c E A` leaves
    /// the scene's rectangle `A` towards the sensor, and `L` is `I` over the pixel's area.
    #[must_use]
    pub fn radiance_per_count(&self, stage: &Stage) -> f64 {
        stage.area() / self.pixel_area()
    }

    /// Calls `f` with each pixel (row by row from the top left) that shows `point` or, where the
    /// scene is periodic, one of its copies.
    pub fn for_each_pixel(&self, point: DVec3, stage: &Stage, mut f: impl FnMut(usize)) {
        if self.plane.as_ref().is_some_and(|plane| !plane.is_left_by(point, self.towards)) {
            return;
        }
        if self.covers_tile {
            return f(0);
        }
        let at = (self.film_from_world * (point - self.corner)).truncate();
        if !stage.periodic {
            if let Some(pixel) = self.pixel(at) {
                f(pixel);
            }
            return;
        }
        let step_x = (self.film_from_world * DVec3::X).truncate() * stage.size.x;
        let step_y = (self.film_from_world * DVec3::Y).truncate() * stage.size.y;
        // The copies whose film coordinates lie in the unit square: bound their numbers by the
        // square's corners seen in units of the two steps.
        let tiles_from_film = DMat2::from_cols(step_x, step_y).inverse();
        let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE]
            .map(|corner| tiles_from_film * (corner - at));
        let low = corners.into_iter().reduce(DVec2::min).unwrap_or(DVec2::ZERO).floor();
        let high = corners.into_iter().reduce(DVec2::max).unwrap_or(DVec2::ZERO).ceil();
        for i in low.x as i64..=high.x as i64 {
            for j in low.y as i64..=high.y as i64 {
                if let Some(pixel) = self.pixel(at + step_x * i as f64 + step_y * j as f64) {
                    f(pixel);
                }
            }
        }
    }

    /// Pixel at film coordinates, if they lie on the film.
    fn pixel(&self, at: DVec2) -> Option<usize> {
        let on_film = at.cmpge(DVec2::ZERO).all() && at.cmplt(DVec2::ONE).all();
        on_film.then(|| {
            let cell = (at * self.size.as_dvec2()).as_uvec2().min(self.size - 1);
            (cell.y * self.size.x + cell.x) as usize
        })
    }
}

/// Right and down in the image, unit vectors: right is horizontal, to the right of somebody who
/// looks from the sensor's side.
#[must_use]
pub fn view_axes(view: View) -> (DVec3, DVec3) {
    let (sin, cos) = view.azimuth.sin_cos();
    let right = DVec3::new(-cos, sin, 0.0);
    (right, right.cross(view.direction()))
}

/// The point in the middle of an orthographic image, and the image's width and height, m.
#[must_use]
pub fn footprint(sensor: &OrthographicOptics, stage: &Stage) -> (DVec3, DVec2) {
    let (middle, extent) = wanted_footprint(sensor, stage);
    (middle, sensor.pixel.map_or(extent, |side| PixelGrid::covering(extent, side).extent))
}

/// The footprint before it grows to whole pixels.
#[must_use]
pub fn wanted_footprint(sensor: &OrthographicOptics, stage: &Stage) -> (DVec3, DVec2) {
    match sensor.footprint {
        Footprint::Rectangle { extent, center } => (center.extend(stage.ground_at(center)), extent),
        Footprint::WholeScene => {
            let bottom = stage.geometry.bottom().min(stage.ground);
            let size = stage.size.extend(stage.top() - bottom);
            // A box is symmetric about its middle, and so is its outline from any side.
            // An axis along a side of the box must not pick up the others by rounding.
            let clean = |axis: DVec3| {
                DVec3::select(axis.abs().cmplt(DVec3::splat(1e-12)), DVec3::ZERO, axis)
            };
            let (right, down) = view_axes(sensor.view);
            let (right, down) = (clean(right), clean(down));
            let extent = DVec2::new(right.abs().dot(size), down.abs().dot(size));
            (stage.corner.extend(bottom) + 0.5 * size, extent)
        }
    }
}

/// The point moved towards the sensor, beyond everything that the scene holds.
fn beyond(point: DVec3, towards: DVec3, stage: &Stage) -> DVec3 {
    let (low, high) = stage.geometry.bounds();
    let reach = (high - low).length() + (point - low).length() + (point - high).length();
    point + towards * reach
}
