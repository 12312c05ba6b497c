use std::io;
use std::sync::OnceLock;

use glam::DVec2;

use super::LightSettings;
use super::coverage::Coverage;
use super::directions::in_parts;
use crate::components::System;
use crate::extract::Stage;
use crate::sampling::{Key, Sampler};
use crate::scratch::ScratchSpace;
use crate::statistics::{Replicates, Spread};
use crate::transport::films::{ImageOutcome, ImageTiles, PixelRows, ReplicateSums};
use crate::transport::paths::{BackwardPath, FirstOrderPath, PathBatch, ThermalPath};
use crate::transport::photons::{PacketOptions, PhotonKind, ViewCounter, photon_film};
use crate::transport::ray_queue::TracedRay;
use crate::transport::reference::ReferencePath;
use crate::transport::scattering_order::spectrum_count;
use crate::transport::{
    Camera, LightSource, OrthographicCamera, Randomisations, ReferencePlane, RouletteThreshold,
};

/// An image of photon packets.
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub struct PacketImage<'a> {
    /// The packets.
    pub sums: ReplicateSums<'a>,
    stage: &'a Stage,
    camera: OrthographicCamera,
    key: Key,
    /// Traced with the first outcome, not when a run is planned.
    coverage: OnceLock<Coverage>,
}

impl<'a> PacketImage<'a> {
    fn new(stage: &'a Stage, camera: &OrthographicCamera, light: LightSettings, key: Key) -> Self {
        let LightSettings { source, separates_orders, .. } = light;
        let counter = ViewCounter::new(vec![camera.clone()]).with_roulette(source, key);
        let plane = ReferencePlane::new(None, stage);
        let kind = PhotonKind::Packet(RouletteThreshold::High);
        let options = PacketOptions { source, beam: 0, kind, plane };
        let sums = photon_film(stage, options, in_parts(counter, separates_orders), key);
        let (camera, coverage) = (camera.clone(), OnceLock::new());
        Self { sums, stage, camera, key: key.path("coverage"), coverage }
    }

    fn outcome(&self, of: Randomisations) -> ImageOutcome {
        let trace = || Coverage::from_rays(&self.camera, self.stage, self.key);
        let coverage = self.coverage.get_or_init(trace);
        // The first sums are those of the energy.
        let spreads = (1..self.sums.count()).map(|spectrum| self.sums.spread_of(spectrum, of));
        outcome_of_packets(&spreads.collect::<Vec<_>>(), self.stage, &self.camera, coverage)
    }
}

/// An image of the light of a [`LightSource`].
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub enum ImageFilm<'a> {
    /// Paths from the sensor.
    Paths(Box<ImageTiles<'a>>),
    /// Photon packets, and rays that find which parts of the pixels show the scene.
    Packets(Box<PacketImage<'a>>),
}

impl<'a> ImageFilm<'a> {
    /// No samples yet. Photon packets support parallel projections only.
    #[must_use]
    pub fn new(stage: &'a Stage, camera: &Camera, light: LightSettings, key: Key) -> Self {
        let LightSettings { system, source, separates_orders } = light;
        let bands = stage.bands;
        let image = camera.clone();
        let tiles = match (system, camera, source) {
            (System::Forward, Camera::Orthographic(camera), _) => {
                return Self::Packets(Box::new(PacketImage::new(stage, camera, light, key)));
            }
            (System::FirstOrder, _, _) => {
                let columns = bands * FirstOrderPath::spectrum_count(separates_orders);
                let path = move || FirstOrderPath::new(separates_orders);
                ImageTiles::new(stage, image, key, columns, path)
            }
            (System::Reference, _, _) => {
                ImageTiles::new(stage, image, key, bands, ReferencePath::new)
            }
            // `document::check` refuses photons for cameras and `Analog` for images.
            (System::Backward | System::Forward | System::Analog, _, LightSource::Reflected) => {
                let columns = bands * spectrum_count(separates_orders);
                let path = move || BackwardPath::new(stage, separates_orders);
                ImageTiles::new(stage, image, key, columns, path)
            }
            (System::Backward | System::Forward | System::Analog, _, LightSource::Emitted) => {
                ImageTiles::new(stage, image, key, bands, move || ThermalPath::new(stage))
            }
        };
        Self::Paths(Box::new(tiles))
    }

    /// Sets the place of sums of paths that take too much memory, before it is traced.
    #[must_use]
    pub fn kept_in(mut self, scratch: &ScratchSpace) -> Self {
        if let Self::Paths(tiles) = &mut self {
            tiles.keep_in(scratch.clone());
        }
        self
    }

    /// The outcome of the samples so far.
    ///
    /// # Errors
    /// If a temporary file cannot be read.
    pub fn outcome(&self) -> io::Result<ImageOutcome> {
        match self {
            Self::Paths(tiles) => tiles.outcome(),
            Self::Packets(packets) => Ok(packets.outcome(Randomisations::All)),
        }
    }

    /// The outcome of each randomisation. That of paths has means alone.
    ///
    /// # Errors
    /// If a temporary file cannot be read.
    pub fn replicates(&self) -> io::Result<Vec<ImageOutcome>> {
        match self {
            Self::Paths(tiles) => tiles.replicates(),
            Self::Packets(packets) => {
                Ok(Randomisations::each().map(|of| packets.outcome(of)).collect())
            }
        }
    }
}

fn outcome_of_packets(
    spreads: &[Spread],
    stage: &Stage,
    camera: &OrthographicCamera,
    coverage: &Coverage,
) -> ImageOutcome {
    let (pixels, bands) = (camera.pixels(), stage.bands);
    let per_count = camera.radiance_per_count(stage);
    let errors: Vec<Vec<f64>> = spreads.iter().map(Spread::standard_error).collect();
    let spectra: Vec<(&[f64], &[f64])> =
        spreads.iter().zip(&errors).map(|(spread, error)| (spread.mean(), &**error)).collect();
    let columns = spectra.len() * bands;
    let space = || Vec::with_capacity(pixels * columns);
    let (mut values, mut value_errors) = (space(), space());
    // Pixel by pixel the whole and its parts; totals follow the pixels.
    for (pixel, &fraction) in coverage.fractions.iter().enumerate() {
        let fraction = f64::from(fraction);
        let shown = Shown { fraction, error: Coverage::error(fraction) };
        for (mean, error) in &spectra {
            for at in pixel * bands..(pixel + 1) * bands {
                let (value, error) = shown.radiance(mean[at] * per_count, error[at] * per_count);
                values.push(value as f32);
                value_errors.push(error as f32);
            }
        }
    }
    // Totals are over all pixels.
    let (fraction, error) = coverage.mean();
    let shown = Shown { fraction, error };
    let scale = per_count / pixels as f64;
    let totals = spectra.iter().flat_map(|(mean, error)| {
        let totals = mean.len() - bands..mean.len();
        mean[totals.clone()].iter().zip(&error[totals])
    });
    let (mean, mean_error) =
        totals.map(|(mean, error)| shown.radiance(mean * scale, error * scale)).unzip();
    let pixels = PixelRows {
        width: camera.size.x as usize,
        values,
        standard_error: value_errors,
        coverage: coverage.fractions.clone(),
    };
    ImageOutcome { pixels: pixels.into(), mean, mean_error, image_sums: Replicates::default() }
}

/// Fraction of an area that shows the scene.
struct Shown {
    fraction: f64,
    error: f64,
}

impl Shown {
    /// Mean radiance of what is shown, with its standard error, from the mean over the whole area; NaN
    /// where nothing is.
    fn radiance(&self, mean: f64, error: f64) -> (f64, f64) {
        if self.fraction == 0.0 {
            return (f64::NAN, f64::NAN);
        }
        let value = mean / self.fraction;
        (value, (error / self.fraction).hypot(value * self.error / self.fraction))
    }
}

/// All rays of `paths` backward paths through the image, in the order in which a run traces them: input of
/// benchmarks of the ray engine.
#[must_use]
pub fn path_rays(
    stage: &Stage,
    camera: &OrthographicCamera,
    paths: u64,
    key: Key,
) -> Vec<TracedRay> {
    let mut batch = PathBatch::logged(|| BackwardPath::new(stage, false));
    let starts = (0..paths).map(|index| {
        let mut sampler = Sampler::new(key, index);
        let [u, v, ..] = sampler.next_4d();
        ((), camera.ray(DVec2::new(u, v)), sampler)
    });
    batch.trace(stage, starts, |_, _| {});
    batch.into_log()
}
