//! What a sensor sees first: sunlit or shaded, ground or canopy.

use std::ops::Range;

use glam::DVec3;

use super::directions::{projections, view_film};
use super::history::Block;
use super::walk::{Answer, Asks, Walk};
use super::{Camera, ReferencePlane, Rows, Tiles, ViewsOutcome};
use crate::accel::Ray;
use crate::components::View;
use crate::extract::Stage;
use crate::film::Sums;
use crate::sampling::{Key, Sampler};

/// Columns of what is counted: the four components in the order of their numbers (1 sunlit ground,
/// 2 sunlit canopy, 3 shaded ground, 4 shaded canopy) and gaps.
pub const COMPONENT_COLUMNS: usize = 5;

/// Column of gaps: ground that is looked down on, and the sky where a camera sees it.
pub const GAP_COLUMN: usize = 4;

/// Rings of 1° about the vertical.
pub const GAP_RINGS: usize = 90;

/// Shares of what each pixel sees first, as columns in place of bands.
///
/// A point is sunlit if the sun is visible from the side of its surface that is seen: a leaf seen
/// from below is shaded although the sun shines on its upper side. Without a sun all is shaded.
///
/// Of a fisheye that looks straight up or down, `zones` hold gaps and samples by rings of 1° about the
/// vertical, shape `[90, 2]`.
#[must_use]
pub fn image_components_film<'a>(stage: &'a Stage, camera: &Camera, key: Key) -> Tiles<'a> {
    let upright = match camera {
        Camera::Fisheye(camera) => camera.upright(),
        _ => None,
    };
    let walk = move || FirstHit::new(upright);
    Tiles::new((stage, camera.clone()), key, COMPONENT_COLUMNS, walk)
}

/// Shares of what each view sees first, shape `[views, COMPONENT_COLUMNS]`, see
/// [`image_components_film`].
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub struct ComponentsFilm<'a> {
    /// The samples.
    pub film: Rows<'a>,
}

impl<'a> ComponentsFilm<'a> {
    /// No sample yet.
    #[must_use]
    pub fn new(stage: &'a Stage, (views, plane): (&[View], &ReferencePlane), key: Key) -> Self {
        let projections = projections(stage, views, plane);
        let walk = || FirstHit::new(None);
        let film = view_film((stage, projections), COMPONENT_COLUMNS + 1, key, walk);
        Self { film }
    }

    /// What was found so far.
    #[must_use]
    pub fn outcome(&self) -> ViewsOutcome {
        ViewsOutcome::of_met(&self.film)
    }
}

/// A ray to the first surface and one from there to the sun.
#[derive(Clone, Debug)]
struct FirstHit {
    /// The columns, and behind them a 1 for what was met.
    columns: [f32; COMPONENT_COLUMNS + 1],
    /// 1 to count gaps by zenith angle above, -1 to count them by nadir angle below.
    upright: Option<f64>,
    /// Cosine of that angle.
    cosine: f64,
    sampler: Sampler,
    direction: DVec3,
    /// Whether it waits for the sun, having met the ground or not.
    waits: Option<bool>,
    has_met: bool,
}

impl FirstHit {
    fn new(upright: Option<f64>) -> Self {
        Self {
            columns: [0.0; COMPONENT_COLUMNS + 1],
            upright,
            cosine: 0.0,
            sampler: Sampler::new(Key::new(0), 0),
            direction: DVec3::ZERO,
            waits: None,
            has_met: false,
        }
    }

    fn count(&mut self, is_sunlit: bool, is_ground: bool) {
        self.columns = [0.0; COMPONENT_COLUMNS + 1];
        self.columns[2 * usize::from(!is_sunlit) + usize::from(!is_ground)] = 1.0;
        self.columns[GAP_COLUMN] = f32::from(is_ground && self.direction.z < 0.0);
        self.columns[COMPONENT_COLUMNS] = 1.0;
    }
}

impl Walk<'_> for FirstHit {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        (self.sampler, self.direction) = (sampler, ray.direction);
        self.cosine = ray.direction.z * self.upright.unwrap_or(0.0);
        (self.waits, self.has_met) = (None, false);
    }

    fn go_on(&mut self, stage: &Stage, Answer { is_lit, hit }: Answer<'_>, asks: &mut Asks) {
        if let Some(is_ground) = self.waits {
            return self.count(is_lit, is_ground);
        }
        let Some(hit) = hit.filter(|hit| !stage.is_cut(hit)) else { return };
        self.has_met = true;
        let is_ground = stage.is_ground(hit);
        let towards = stage.light.sun.as_ref().map(|sun| sun.towards(&mut self.sampler));
        // The side that is seen must face it.
        let front = hit.normal.dot(self.direction) < 0.0;
        let Some(sun) = towards.filter(|sun| front == (hit.normal.dot(*sun) > 0.0)) else {
            return self.count(false, is_ground);
        };
        self.waits = Some(is_ground);
        asks.shadow(hit.leave(sun));
    }

    fn has_met(&self) -> bool {
        self.has_met
    }

    fn see_sky(&mut self, _: &Stage, direction: DVec3) -> bool {
        self.columns = [0.0; COMPONENT_COLUMNS + 1];
        self.columns[GAP_COLUMN] = 1.0;
        self.columns[COMPONENT_COLUMNS] = 1.0;
        direction.z > 0.0
    }

    fn show(&self, bands: Range<usize>, found: &mut [Block]) {
        for (found, column) in found.iter_mut().flatten().zip(&self.columns[bands]) {
            *found = f64::from(*column);
        }
    }

    fn zones(&self) -> usize {
        if self.upright.is_some() { 2 * GAP_RINGS } else { 0 }
    }

    fn add_to_zones(&self, sums: &mut Sums, cell: usize) {
        if self.cosine > 0.0 {
            let ring = (self.cosine.min(1.0).acos().to_degrees() as usize).min(GAP_RINGS - 1);
            sums.add_at(cell, 2 * ring, self.columns[GAP_COLUMN].into());
            sums.add_at(cell, 2 * ring + 1, 1.0);
        }
    }
}
