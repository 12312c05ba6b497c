use glam::{DVec2, DVec3};

use crate::accel::Ray;
use crate::components::CountingPlane;
use crate::extract::Stage;

/// The horizontal rectangle that a measurement refers to: reflected light counts if it leaves through
/// it, and powers are divided by its area.
///
/// - An isolated scene's own plane is the terrain's rectangle at the mean height of the ground. Light
///   counts if the *line* of its last flight passes through it, wherever on that line it comes from:
///   a BRF is then the mean of an orthographic image that shows just this rectangle, and trees on the ground
///   hide none of it.
/// - A periodic scene's own plane is at its highest point. All light that goes up crosses a copy of it.
/// - A virtual plane is crossed upwards by the last flight. Light from above it does not count.
///
/// `scenes/ISOLATED.md` draws all three.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferencePlane {
    /// South-west corner, m.
    pub corner: DVec2,
    /// Extent to the east and to the north, m.
    pub size: DVec2,
    /// Height, m.
    pub height: f64,
    /// Power that falls on the scene's rectangle over the power that falls on this one: the factor from fractions
    /// of the first to fractions of the second.
    pub gain: f64,
    /// Extent of the tile, where the scene is periodic.
    tile: Option<DVec2>,
    /// True if it is the scene's whole rectangle.
    is_whole: bool,
    /// Highest point that lies below it, m: infinite where it lies above everything.
    ceiling: f64,
}

impl ReferencePlane {
    /// A virtual plane or, without one, the scene's own.
    #[must_use]
    pub fn new(plane: Option<&CountingPlane>, stage: &Stage) -> Self {
        let scene = Self {
            corner: stage.corner,
            size: stage.size,
            height: if stage.periodic { stage.top() } else { stage.mean_ground },
            gain: 1.0,
            tile: stage.periodic.then_some(stage.size),
            is_whole: true,
            ceiling: f64::INFINITY,
        };
        let Some(plane) = plane else { return scene };
        let height = plane.height.unwrap_or_else(|| stage.top());
        let (low, high) = stage.geometry.bounds();
        // Surfaces at the plane's own height lie below it, however their points are rounded.
        let rounding = low.abs().max(high.abs()).max_element() * (-36_f64).exp2();
        let ceiling = if height < stage.top() { height + rounding } else { f64::INFINITY };
        let corner = plane.center - 0.5 * plane.size;
        let is_same = |a: DVec2, b: DVec2| (a - b).abs().cmple(1e-9 * stage.size).all();
        if is_same(corner, scene.corner) && is_same(plane.size, scene.size) {
            return Self { height, ceiling, ..scene };
        }
        let gain = stage.area() / (plane.size.x * plane.size.y);
        Self { corner, size: plane.size, height, gain, is_whole: false, ceiling, ..scene }
    }

    /// Returns whether it shows every point of a periodic scene exactly once, from whichever side.
    #[must_use]
    pub const fn covers_tile(&self) -> bool {
        self.is_whole && self.tile.is_some()
    }

    /// Returns whether something of the scene may lie above it.
    #[must_use]
    pub const fn is_low(&self) -> bool {
        self.ceiling < f64::INFINITY
    }

    /// Returns whether a flight from `point` without further obstacle leaves through it.
    #[must_use]
    pub fn is_left_by(&self, point: DVec3, direction: DVec3) -> bool {
        if direction.z <= 0.0 || point.z > self.ceiling {
            return false;
        }
        self.covers_tile() || {
            // Negative where the point lies above the plane of an isolated scene.
            let along = (self.height - point.z) / direction.z;
            self.within((point + direction * along).truncate()).is_some()
        }
    }

    /// Returns whether a ray against the light crosses it.
    #[must_use]
    pub fn is_crossed_by(&self, ray: &Ray) -> bool {
        let along = (self.height - ray.origin.z) / ray.direction.z;
        self.covers_tile() || self.within((ray.origin + ray.direction * along).truncate()).is_some()
    }

    /// For a ray that comes down from above everything: the length above a plane that something may
    /// lie above, m: what is met there has not left through the plane.
    #[must_use]
    pub fn clearance(&self, ray: &Ray) -> Option<f64> {
        self.is_low().then(|| (self.ceiling - ray.origin.z) / ray.direction.z)
    }

    /// Returns whether a point lies in the column below the plane. That of the scene's own extent holds what
    /// stands out over its edges too.
    #[must_use]
    pub fn is_above(&self, point: DVec3) -> bool {
        point.z <= self.ceiling && (self.is_whole || self.within(point.truncate()).is_some())
    }

    /// Position within the rectangle, or one of its copies, in units of its extent: each in [0, 1).
    #[must_use]
    pub fn within(&self, point: DVec2) -> Option<DVec2> {
        let mut at = point - self.corner;
        if let Some(tile) = self.tile {
            at -= (at / tile).floor() * tile;
            // The rest of a division may round up to the divisor.
            at = DVec2::select(at.cmpge(tile), DVec2::ZERO, at);
        }
        let at = at / self.size;
        (at.cmpge(DVec2::ZERO).all() && at.cmplt(DVec2::ONE).all()).then_some(at)
    }
}
