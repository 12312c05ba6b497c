//! Films of the first surface that a sensor sees.

use super::ViewsOutcome;
use super::directions::{ViewTracer, cameras};
use crate::components::View;
use crate::extract::Stage;
use crate::sampling::Key;
use crate::transport::films::{ImageTiles, ReplicateSums};
use crate::transport::paths::{ComponentColumns, FirstHitPath};
use crate::transport::{Camera, ReferencePlane};

/// Fractions of each pixel by the surface that is seen first, as columns in place of bands.
///
/// A point is sunlit if the sun is visible from the visible side of its surface: a leaf seen
/// from below is shaded although the sun shines on its upper side. Without a sun all is shaded.
///
/// For a fisheye that looks straight up or down, sums over the image hold gaps and samples by rings of 1° about
/// the vertical, shape `[90, 2]`.
#[must_use]
pub fn image_first_surface_film<'a>(stage: &'a Stage, camera: &Camera, key: Key) -> ImageTiles<'a> {
    let upright = match camera {
        Camera::Fisheye(camera) => camera.upright(),
        _ => None,
    };
    let path = move || FirstHitPath::new(stage, upright);
    ImageTiles::new(stage, camera.clone(), key, ComponentColumns::new(stage).count(), path)
}

/// Fractions of each view by the surface that is seen first, shape `[views, columns]`, see
/// [`image_first_surface_film`].
#[expect(missing_debug_implementations, reason = "its tracer has no Debug")]
pub struct FirstSurfaceFilm<'a> {
    /// The samples.
    pub film: ReplicateSums<'a>,
}

impl<'a> FirstSurfaceFilm<'a> {
    /// No samples yet.
    #[must_use]
    pub fn new(stage: &'a Stage, views: &[View], plane: &ReferencePlane, key: Key) -> Self {
        let columns = ComponentColumns::new(stage).count() + 1;
        let tracer = ViewTracer { stage, cameras: cameras(stage, views, plane), columns, key };
        Self { film: tracer.film(move || FirstHitPath::new(stage, None)) }
    }

    /// The outcome of the samples so far.
    #[must_use]
    pub fn outcome(&self) -> ViewsOutcome {
        ViewsOutcome::new(&self.film)
    }
}
