use glam::DVec2;

use super::directions::in_parts;
use super::forward::photon_film;
use super::walk::{Party, Traced};
use super::{
    Camera, FirstOrder, Grain, Path, Projection, ReferencePlane, Roulette, Rows, Source,
    ThermalPath, Tiles, ViewCounter, spectra,
};
use crate::components::System;
use crate::extract::Stage;
use crate::film::{Spread, Sums};
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
    /// What a walk sums over the whole image alone, shape `[randomisations, zones]`.
    pub zones: Sums,
}

/// An image of the light of a [`Source`].
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub enum ImageFilm<'a> {
    /// Paths from the sensor.
    Paths(Tiles<'a>),
    /// Photon packets. Nothing tells here which pixels lie beside the scene or its virtual plane: they
    /// are black.
    Packets(Rows<'a>, &'a Stage, ViewCounter),
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
                let counter =
                    ViewCounter::new(vec![projection.clone()]).playing(stage, source, key);
                let counters = in_parts(counter.clone(), orders);
                let plane = ReferencePlane::of(None, stage);
                let of = (source, Grain::Packet(Roulette::Firm), plane);
                let rows = photon_film(stage, of, counters, key);
                Self::Packets(rows, stage, counter)
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
            Self::Packets(rows, stage, counter) => {
                of_packets(rows, stage, &counter.projections()[0])
            }
        }
    }
}

fn of_packets(rows: &Rows<'_>, stage: &Stage, projection: &Projection) -> ImageOutcome {
    let pixels = projection.pixels();
    let per_count = projection.radiance_of_count(stage);
    // The first sums are those of the energy.
    let spreads: Vec<Spread> = (1..rows.count()).map(|spectrum| rows.spread(spectrum)).collect();
    let means: Vec<&[f64]> = spreads.iter().map(Spread::mean).collect();
    let errors: Vec<Vec<f64>> = spreads.iter().map(Spread::standard_error).collect();
    let errors: Vec<&[f64]> = errors.iter().map(Vec::as_slice).collect();
    // Pixel by pixel the whole and its parts; behind the pixels stand totals.
    let of_pixels = |spectra: &[&[f64]]| -> Vec<f32> {
        let mut all = Vec::with_capacity(pixels * spectra.len() * stage.bands);
        for pixel in 0..pixels {
            for values in spectra {
                let values = &values[pixel * stage.bands..(pixel + 1) * stage.bands];
                all.extend(values.iter().map(|value| (value * per_count) as f32));
            }
        }
        all
    };
    // The total counts what all pixels together see.
    let of_total = |spectra: &[&[f64]]| -> Vec<f64> {
        let scale = per_count / pixels as f64;
        let totals = spectra.iter().flat_map(|values| &values[values.len() - stage.bands..]);
        totals.map(|value| value * scale).collect()
    };
    ImageOutcome {
        pixels: of_pixels(&means),
        errors: of_pixels(&errors),
        coverage: vec![1.0; pixels],
        mean: of_total(&means),
        mean_error: of_total(&errors),
        zones: Sums::new(0, 0),
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
