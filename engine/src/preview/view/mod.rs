//! Shaded perspective of a scene: sunlight with shadows and light of the sky, some rays per pixel.
//!
//! | file | subject |
//! |---|---|
//! | `viewpoint` | position of the camera |
//! | `shading` | colour of a hit, and of the sky |
//! | `passes` | rays of a pass, tile by tile |

mod passes;
mod shading;
mod viewpoint;

use glam::{DVec3, UVec2};

use crate::components::{SunLight, View};
use crate::extract::Stage;
use crate::output::png_bytes;
use crate::run::LoadedScene;
use crate::transport::PerspectiveCamera;

use self::passes::Accumulator;
use self::shading::Shading;
use self::viewpoint::viewpoint;

/// Longer side of a view, pixels, unless another is asked for.
pub const VIEW_SIZE: u32 = 900;

/// Samples per pixel of a view, unless another number is asked for.
pub const VIEW_SAMPLES: u32 = 4;

/// Sun of scenes without one: zenith angle and azimuth, degrees.
const ASSUMED_SUN: View = View::from_degrees(40.0, 150.0);

/// Settings of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSettings {
    /// Number of columns; there are five rows per eight columns.
    pub width: u32,
    /// Samples per pixel.
    pub samples: u32,
    /// Direction towards the camera; chosen by the sun if absent.
    pub towards: Option<View>,
}

impl Default for ViewSettings {
    fn default() -> Self {
        Self { width: VIEW_SIZE, samples: VIEW_SAMPLES, towards: None }
    }
}

/// View of a scene, ready to be traced.
#[derive(Debug)]
pub struct SceneView<'a> {
    stage: &'a Stage,
    shading: Shading,
    camera: PerspectiveCamera,
    settings: ViewSettings,
    /// What the view shows, a line each.
    pub contents: Vec<String>,
}

impl<'a> SceneView<'a> {
    /// View of a scene whose stage is isolated ([`LoadedScene::isolated_stage`]).
    #[must_use]
    pub fn new(loaded: &LoadedScene, stage: &'a Stage, settings: ViewSettings) -> Self {
        let mut suns = loaded.world.world.query::<&SunLight>();
        let found = suns.iter().next().map(|sun| sun.direction);
        let sun: DVec3 = found.unwrap_or_else(|| ASSUMED_SUN.direction());
        let size = UVec2::new(settings.width, (settings.width * 5).div_ceil(8));
        let view = settings.towards.unwrap_or_else(|| viewpoint::automatic(sun));
        let placed = viewpoint::placed_box(&loaded.world.world);
        let camera = viewpoint(stage, placed, view, size);
        let shading = Shading::new(loaded, stage, sun);
        let mut contents = vec![format!(
            "view from {:.0}° above the horizon, azimuth {:.0}°",
            90.0 - view.zenith.to_degrees(),
            view.azimuth.to_degrees().rem_euclid(360.0)
        )];
        if found.is_none() {
            contents.push(
                "lit by a sun 40° from the zenith in the south-south-east: the scene has none"
                    .to_owned(),
            );
        }
        if loaded.world.resources.is_periodic() {
            contents.push("one tile of the periodic scene".to_owned());
        }
        contents.extend(shading.told_colours());
        Self { stage, shading, camera, settings, contents }
    }

    /// Traces the view in passes, from coarse to fine, and calls `show` with each picture as PNG; the last is complete.
    ///
    /// # Errors
    /// The error of `show`, which ends the passes.
    pub fn trace<E>(&self, mut show: impl FnMut(Vec<u8>) -> Result<(), E>) -> Result<(), E> {
        let UVec2 { x: width, y: height } = self.camera.size;
        let samples = self.settings.samples.max(1);
        let mut picture = Accumulator::new(self.camera.size);
        let png =
            |picture: &Accumulator| png_bytes(width as usize, height as usize, &picture.rgb());
        picture.add_coarse(self.stage, &self.camera, &self.shading);
        show(png(&picture))?;
        for pass in 0..samples {
            picture.add(pass, self.stage, &self.camera, &self.shading);
            // Each picture takes the time to write it.
            if pass == 0 || pass + 1 == samples {
                show(png(&picture))?;
            }
        }
        Ok(())
    }
}
