use std::sync::OnceLock;

use glam::DVec2;

use super::coverage::Coverage;
use super::directions::in_parts;
use super::forward::photon_film;
use super::walk::{Party, Traced};
use super::{
    Camera, FirstOrder, Grain, Path, Projection, ReferencePlane, Roulette, Rows, Source,
    ThermalPath, Tiles, ViewCounter, spectra,
};
use crate::components::System;
use crate::extract::Stage;
use crate::film::{Replicates, Spread};
use crate::sampling::{Key, Sampler};

/// What an image measurement found.
#[derive(Clone, Debug)]
pub struct ImageOutcome {
    /// Radiance of each pixel in the unit of its [`Source`], shape `[rows, columns, spectra, bands]` (the whole and, if asked
    /// for, its parts): the mean over the samples that met the scene; NaN where none did.
    pub pixels: Vec<f32>,
    /// Its standard error, from its own samples and, where those are few, from those of the tile of 16 × 16
    /// pixels around it; NaN of one sample a pixel.
    pub errors: Vec<f32>,
    /// Share of each pixel's samples that met the scene, shape `[rows, columns]`.
    pub coverage: Vec<f32>,
    /// The same over all samples that met the scene, shape `[spectra, bands]`.
    pub mean: Vec<f64>,
    /// Its standard error.
    pub mean_error: Vec<f64>,
    /// What a walk sums over the whole image alone, shape `[zones]`.
    pub zones: Replicates,
}

/// An image that photon packets make.
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub struct PacketImage<'a> {
    /// The packets.
    pub rows: Rows<'a>,
    stage: &'a Stage,
    projection: Projection,
    key: Key,
    /// Traced when an outcome is asked for, and not when a run is planned.
    coverage: OnceLock<Coverage>,
}

impl<'a> PacketImage<'a> {
    fn new(
        (stage, projection): (&'a Stage, &Projection),
        (source, orders): (Source, bool),
        key: Key,
    ) -> Self {
        let counter = ViewCounter::new(vec![projection.clone()]).with_roulette(source, key);
        let plane = ReferencePlane::of(None, stage);
        let of = (source, Grain::Packet(Roulette::Firm), plane);
        let rows = photon_film(stage, of, in_parts(counter, orders), key);
        let (projection, coverage) = (projection.clone(), OnceLock::new());
        Self { rows, stage, projection, key: key.path("coverage"), coverage }
    }

    fn outcome(&self) -> ImageOutcome {
        let trace = || Coverage::of(&self.projection, self.stage, self.key);
        of_packets(&self.rows, self.stage, &self.projection, self.coverage.get_or_init(trace))
    }
}

/// An image of the light of a [`Source`].
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub enum ImageFilm<'a> {
    /// Paths from the sensor.
    Paths(Tiles<'a>),
    /// Photon packets, and rays that find which parts of the pixels show the scene.
    Packets(Box<PacketImage<'a>>),
}

impl<'a> ImageFilm<'a> {
    /// No sample yet. Photon packets draw parallel projections alone.
    #[must_use]
    pub fn new(
        (stage, camera): (&'a Stage, &Camera),
        (system, source, orders): (System, Source, bool),
        key: Key,
    ) -> Self {
        match (system, camera, source) {
            (System::Forward, Camera::Orthographic(projection), _) => {
                let scene = (stage, projection);
                Self::Packets(Box::new(PacketImage::new(scene, (source, orders), key)))
            }
            (System::FirstOrder, _, _) => {
                let path = move || FirstOrder::new(orders);
                let columns = stage.bands * FirstOrder::spectra(orders);
                Self::Paths(Tiles::new((stage, camera.clone()), key, columns, path))
            }
            (_, _, Source::Reflected) => {
                let path = move || Path::new(stage.bands, orders);
                let columns = stage.bands * spectra(orders);
                Self::Paths(Tiles::new((stage, camera.clone()), key, columns, path))
            }
            (_, _, Source::Emitted) => {
                let path = || ThermalPath::new(stage);
                Self::Paths(Tiles::new((stage, camera.clone()), key, stage.bands, path))
            }
        }
    }

    /// What was found so far.
    #[must_use]
    pub fn outcome(&self) -> ImageOutcome {
        match self {
            Self::Paths(tiles) => tiles.outcome(),
            Self::Packets(packets) => packets.outcome(),
        }
    }
}

fn of_packets(
    rows: &Rows<'_>,
    stage: &Stage,
    projection: &Projection,
    coverage: &Coverage,
) -> ImageOutcome {
    let (pixels, bands) = (projection.pixels(), stage.bands);
    let per_count = projection.radiance_of_count(stage);
    // The first sums are those of the energy.
    let spreads: Vec<Spread> = (1..rows.count()).map(|spectrum| rows.spread(spectrum)).collect();
    let errors: Vec<Vec<f64>> = spreads.iter().map(Spread::standard_error).collect();
    let spectra: Vec<(&[f64], &[f64])> =
        spreads.iter().zip(&errors).map(|(spread, error)| (spread.mean(), &**error)).collect();
    let columns = spectra.len() * bands;
    let space = || Vec::with_capacity(pixels * columns);
    let (mut values, mut value_errors) = (space(), space());
    // Pixel by pixel the whole and its parts; behind the pixels stand totals.
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
    // The total counts what all pixels together see.
    let (fraction, error) = coverage.mean();
    let shown = Shown { fraction, error };
    let scale = per_count / pixels as f64;
    let totals = spectra.iter().flat_map(|(mean, error)| {
        let totals = mean.len() - bands..mean.len();
        mean[totals.clone()].iter().zip(&error[totals])
    });
    let (mean, mean_error) =
        totals.map(|(mean, error)| shown.radiance(mean * scale, error * scale)).unzip();
    ImageOutcome {
        pixels: values,
        errors: value_errors,
        coverage: coverage.fractions.clone(),
        mean,
        mean_error,
        zones: Replicates::default(),
    }
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

/// All rays of `paths` paths through the image, in the order in which a run traces them: what a
/// benchmark of the ray engine should be fed with.
#[must_use]
pub fn path_rays(stage: &Stage, projection: &Projection, paths: u64, key: Key) -> Vec<Traced> {
    let mut party = Party::logged(|| Path::new(stage.bands, false));
    let starts = (0..paths).map(|index| {
        let mut sampler = Sampler::new(key, index);
        let [u, v, ..] = sampler.next_event();
        ((), projection.ray(DVec2::new(u, v)), sampler)
    });
    party.follow(stage, starts, |_, _| {});
    party.into_log()
}
