//! What a sensor sees first: sunlit or shaded, ground or canopy.

use glam::DVec3;

use super::directions::{Rounds, projections, walk_views};
use super::image::walk_pixels;
use super::{Camera, ImageOutcome, Walk, Watch};
use crate::accel::Ray;
use crate::components::{Stop, View};
use crate::extract::Stage;
use crate::film::{Sums, ratio};
use crate::sampling::{Key, Sampler};

/// Columns of what is counted: the four components in the order of their numbers (1 sunlit ground,
/// 2 sunlit canopy, 3 shaded ground, 4 shaded canopy), gaps, and all that was met.
pub const COMPONENT_COLUMNS: usize = 6;

/// Column of gaps: all ground, and the sky where a camera sees it.
pub const GAP_COLUMN: usize = 4;

/// Column of all that was met.
const MET_COLUMN: usize = 5;

/// What the views of a list see first.
#[derive(Clone, Debug, PartialEq)]
pub struct ComponentsOutcome {
    /// Share of each column in what each view sees of the scene, shape
    /// `[views, COMPONENT_COLUMNS]`; NaN where it sees nothing.
    pub share: Vec<f64>,
    /// Its standard error.
    pub error: Vec<f64>,
    /// Rays from the sensor, a view.
    pub samples: u64,
    /// Rays traced.
    pub rays: u64,
    /// What ended it.
    pub ended_by: Stop,
}

/// Shares of what each pixel sees first, as columns in place of bands.
///
/// A point is sunlit if the sun is visible from the side of its surface that is seen: a leaf seen
/// from below is shaded although the sun shines on its upper side. Without a sun all is shaded.
#[must_use]
pub fn measure_image_components(
    stage: &Stage,
    camera: &Camera,
    samples: u32,
    key: Key,
    watch: Watch<'_>,
) -> ImageOutcome {
    walk_pixels(stage, (camera, samples), key, watch, COMPONENT_COLUMNS, FirstHit::default)
}

/// Shares of what each view sees first, see [`measure_image_components`]; `elapsed` tells the
/// seconds since the start.
///
/// # Panics
/// If there is no condition to end.
#[must_use]
pub fn measure_directions_components(
    stage: &Stage,
    views: &[View],
    until: &[Stop],
    key: Key,
    elapsed: &dyn Fn() -> f64,
    watch: Watch<'_>,
) -> ComponentsOutcome {
    let projections = projections(stage, views);
    let rounds = Rounds::measure(
        (views.len(), COMPONENT_COLUMNS),
        until,
        (elapsed, watch),
        |range, rows| walk_views(stage, &projections, range, key, rows, FirstHit::default),
        |rows, _| median_relative_error(&shares(rows, views.len())),
    );
    let (share, error) = shares(&rounds.rows, views.len());
    ComponentsOutcome {
        share,
        error,
        samples: rounds.samples(),
        rays: rounds.rays,
        ended_by: rounds.ended_by,
    }
}

/// Shares among all that was met, with their standard errors, shape `[views, COMPONENT_COLUMNS]`.
fn shares(rows: &[Sums], views: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut shares, mut errors) = (Vec::new(), Vec::new());
    for view in 0..views {
        let of_view = |row: &Sums| -> Vec<f64> {
            row.values()[view * COMPONENT_COLUMNS..][..COMPONENT_COLUMNS].to_vec()
        };
        let sums: Vec<f64> = rows.iter().flat_map(of_view).collect();
        let met: Vec<f64> =
            sums.iter().skip(MET_COLUMN).step_by(COMPONENT_COLUMNS).copied().collect();
        let (share, error) = ratio(&sums, &met);
        shares.extend(share);
        errors.extend(error);
    }
    (shares, errors)
}

/// Median of the relative errors of those shares that are above 0 and not all.
fn median_relative_error((shares, errors): &(Vec<f64>, Vec<f64>)) -> f64 {
    let mut relative: Vec<f64> = shares
        .iter()
        .zip(errors)
        .enumerate()
        .filter(|(index, (share, _))| index % COMPONENT_COLUMNS != MET_COLUMN && **share > 0.0)
        .map(|(_, (share, error))| error / share)
        .collect();
    if relative.is_empty() {
        return 0.0;
    }
    let middle = relative.len() / 2;
    *relative.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// A ray to the first surface and one from there to the sun.
#[derive(Clone, Debug, Default)]
struct FirstHit {
    columns: [f32; COMPONENT_COLUMNS],
    rays: u64,
}

impl Walk for FirstHit {
    fn trace(&mut self, stage: &Stage, ray: Ray, sampler: &mut Sampler) -> bool {
        self.rays += 1;
        let Some(hit) = stage.geometry.closest(&ray) else { return false };
        let is_sunlit = stage.light.sun.as_ref().is_some_and(|sun| {
            let sun = sun.towards(sampler);
            let seen_side_faces_it =
                (hit.normal.dot(ray.direction) < 0.0) == (hit.normal.dot(sun) > 0.0);
            seen_side_faces_it && {
                self.rays += 1;
                !stage.geometry.occluded(&hit.leave(sun))
            }
        });
        let is_ground = stage.is_ground(&hit);
        self.columns = [0.0; COMPONENT_COLUMNS];
        self.columns[2 * usize::from(!is_sunlit) + usize::from(!is_ground)] = 1.0;
        self.columns[GAP_COLUMN] = f32::from(is_ground);
        self.columns[MET_COLUMN] = 1.0;
        true
    }

    fn see_sky(&mut self, _: &Stage, direction: DVec3) -> bool {
        self.columns = [0.0; COMPONENT_COLUMNS];
        self.columns[GAP_COLUMN] = 1.0;
        self.columns[MET_COLUMN] = 1.0;
        direction.z > 0.0
    }

    fn values(&self) -> &[f32] {
        &self.columns
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}
