use glam::{DVec2, UVec2};

use super::{
    Camera, Counter, Part, PartCounter, Path, Projection, RANDOMISATIONS, ReferencePlane, Source,
    ThermalPath, Traced, ViewCounter, Walk, Watch, blocks, spectra, trace_photons,
};
use crate::extract::Stage;
use crate::film::{Spread, Sums, ratio};
use crate::sampling::{Key, Sampler};

/// What an image measurement found.
#[derive(Clone, Debug)]
pub struct ImageOutcome {
    /// Radiance of each pixel in the unit of its [`Source`], shape `[rows, columns, spectra, bands]` (the whole and, if asked
    /// for, its parts): the mean over the samples that met the scene; NaN where none did.
    pub pixels: Vec<f32>,
    /// Its standard error.
    pub errors: Vec<f32>,
    /// Share of each pixel's samples that met the scene, shape `[rows, columns]`.
    pub coverage: Vec<f32>,
    /// The same over all samples that met the scene, shape `[spectra, bands]`.
    pub mean: Vec<f64>,
    /// Its standard error.
    pub mean_error: Vec<f64>,
    /// What a walk sums over the whole image alone, shape `[randomisations, zones]`.
    pub zones: Sums,
    /// Paths traced.
    pub samples: u64,
    /// Rays traced.
    pub rays: u64,
    /// Of photon packets, the largest share of the incident energy that is not accounted for.
    pub imbalance: Option<f64>,
}

/// Side of the square of pixels that one block traces.
const TILE: u32 = 16;

/// Randomisations of `samples` a pixel and samples in each: as many randomisations as divide the
/// samples evenly, from 16 to 32; samples are rounded up where none does.
fn split(samples: u32) -> (u32, u32) {
    if samples <= RANDOMISATIONS {
        return (samples.max(2), 1);
    }
    let even =
        (RANDOMISATIONS / 2..=RANDOMISATIONS).rev().find(|count| samples.is_multiple_of(*count));
    let count = even.unwrap_or(RANDOMISATIONS);
    (count, samples.div_ceil(count))
}

/// Index of a pixel along the Z-order curve: pixels that are close have close indices, so that the
/// points of one low-discrepancy sequence are even within each pixel and over the whole image.
///
/// Source: Ahmed and Wonka (2020), "Screen-space blue-noise diffusion of Monte Carlo sampling error
/// via hierarchical ordering of pixels".
fn morton(at: UVec2) -> u64 {
    let spread = |x: u32| {
        let mut x = u64::from(x);
        x = (x | (x << 16)) & 0x0000_ffff_0000_ffff;
        x = (x | (x << 8)) & 0x00ff_00ff_00ff_00ff;
        x = (x | (x << 4)) & 0x0f0f_0f0f_0f0f_0f0f;
        x = (x | (x << 2)) & 0x3333_3333_3333_3333;
        (x | (x << 1)) & 0x5555_5555_5555_5555
    };
    spread(at.x) | (spread(at.y) << 1)
}

/// One block of pixels, and the sums of all its samples by randomisation.
struct Tile {
    /// Per pixel: sum over hits and number of hits of each randomisation.
    pixels: Vec<f32>,
    errors: Vec<f32>,
    coverage: Vec<f32>,
    sums: Sums,
    zones: Sums,
    hits: Vec<f64>,
    rays: u64,
}

/// Traces `samples` paths a pixel from the sensor.
#[must_use]
pub fn measure_image(
    stage: &Stage,
    camera: &Camera,
    (samples, source, orders): (u32, Source, bool),
    key: Key,
    watch: Watch<'_>,
) -> ImageOutcome {
    let setting = (camera, samples);
    match source {
        Source::Reflected => {
            let path = || Path::of_orders(stage.lanes(), orders);
            walk_pixels(stage, setting, key, watch, stage.bands * spectra(orders), path)
        }
        Source::Emitted => {
            let path = || ThermalPath::new(stage);
            walk_pixels(stage, setting, key, watch, stage.bands, path)
        }
    }
}

/// Walks `samples` times a pixel from the sensor and averages what the walks that met the scene
/// found; of their values the first `columns` count.
pub(super) fn walk_pixels<W: Walk>(
    stage: &Stage,
    (camera, samples): (&Camera, u32),
    key: Key,
    watch: Watch<'_>,
    columns: usize,
    walk: impl Fn() -> W + Sync,
) -> ImageOutcome {
    let size = camera.size();
    let (randomisations, each) = split(samples);
    let tiles = UVec2::new(size.x.div_ceil(TILE), size.y.div_ceil(TILE));
    let count = (tiles.x * tiles.y) as usize;
    let area = |tile: usize| {
        let tile = tile as u32;
        let low = UVec2::new(tile % tiles.x, tile / tiles.x) * TILE;
        (low, (low + TILE).min(size))
    };
    let all = (size.x * size.y) as usize;
    let bands = columns;
    let mut outcome = ImageOutcome {
        pixels: vec![f32::NAN; all * bands],
        errors: vec![f32::NAN; all * bands],
        coverage: vec![0.0; all],
        mean: Vec::new(),
        mean_error: Vec::new(),
        zones: Sums::new(randomisations as usize, walk().zones()),
        samples: all as u64 * u64::from(randomisations * each),
        rays: 0,
        imbalance: None,
    };
    let mut sums = Sums::new(randomisations as usize, bands);
    let mut hits = vec![0.0; randomisations as usize];
    blocks::in_order(
        count,
        256,
        |tile| {
            let (low, high) = area(tile);
            trace_tile((stage, camera), (low, high), (randomisations, each), key, columns, walk())
        },
        |tile, result| {
            let (low, high) = area(tile);
            let mut pixel = 0;
            for row in low.y..high.y {
                for column in low.x..high.x {
                    let to = (row * size.x + column) as usize;
                    let from = pixel * bands..(pixel + 1) * bands;
                    outcome.pixels[to * bands..(to + 1) * bands]
                        .copy_from_slice(&result.pixels[from.clone()]);
                    outcome.errors[to * bands..(to + 1) * bands]
                        .copy_from_slice(&result.errors[from]);
                    outcome.coverage[to] = result.coverage[pixel];
                    pixel += 1;
                }
            }
            sums.merge(&result.sums);
            outcome.zones.merge(&result.zones);
            for (total, part) in hits.iter_mut().zip(&result.hits) {
                *total += part;
            }
            outcome.rays += result.rays;
            watch((tile + 1) as f64 / count as f64);
        },
    );
    (outcome.mean, outcome.mean_error) = ratio(sums.values(), &hits);
    outcome
}

/// Sends `samples` photon packets a pixel into the scene and sees where their light goes.
///
/// Nothing tells here which pixels lie beside the scene or its virtual plane: they are black.
#[must_use]
pub fn measure_image_forward(
    stage: &Stage,
    projection: &Projection,
    (samples, source, orders): (u32, Source, bool),
    key: Key,
    watch: Watch<'_>,
) -> ImageOutcome {
    let pixels = projection.pixels();
    let counter = ViewCounter::new(vec![projection.clone()]);
    let mut counters: Vec<Box<dyn Counter + '_>> = vec![Box::new(counter.clone())];
    if orders {
        counters.extend(Part::ALL.map(|part| -> Box<dyn Counter + '_> {
            Box::new(PartCounter { counter: Box::new(counter.clone()), part })
        }));
    }
    let packets = pixels as u64 * u64::from(samples);
    let plane = ReferencePlane::of(None, stage);
    let outcome = trace_photons(stage, (source, plane), &counters, packets, key, watch);
    let per_count = projection.radiance_of_count(stage);
    let means: Vec<&[f64]> = outcome.spreads.iter().map(Spread::mean).collect();
    let errors: Vec<Vec<f64>> = outcome.spreads.iter().map(Spread::standard_error).collect();
    let errors: Vec<&[f64]> = errors.iter().map(Vec::as_slice).collect();
    // Pixel by pixel the whole and its parts; behind the pixels stand totals.
    let of_pixels = |spectra: &[&[f64]]| -> Vec<f32> {
        (0..pixels)
            .flat_map(|pixel| spectra.iter().map(move |values| (pixel, values)))
            .flat_map(|(pixel, values)| &values[pixel * stage.bands..(pixel + 1) * stage.bands])
            .map(|value| (value * per_count) as f32)
            .collect()
    };
    // The total counts what all pixels together see.
    let of_total = |spectra: &[&[f64]]| -> Vec<f64> {
        let scale = per_count / pixels as f64;
        let totals = spectra.iter().flat_map(|values| &values[pixels * stage.bands..]);
        totals.map(|value| value * scale).collect()
    };
    ImageOutcome {
        pixels: of_pixels(&means),
        errors: of_pixels(&errors),
        coverage: vec![1.0; pixels],
        mean: of_total(&means),
        mean_error: of_total(&errors),
        zones: Sums::new(0, 0),
        samples: outcome.packets,
        rays: outcome.rays,
        imbalance: Some(outcome.imbalance),
    }
}

/// All rays of `paths` paths through the image, in the order in which a run traces them: what a
/// benchmark of the ray engine should be fed with.
#[must_use]
pub fn path_rays(stage: &Stage, projection: &Projection, paths: u64, key: Key) -> Vec<Traced> {
    let mut path = Path::logged(stage.lanes());
    for index in 0..paths {
        let mut sampler = Sampler::new(key, index);
        let [u, v, ..] = sampler.next_event();
        path.trace(stage, projection.ray(DVec2::new(u, v)), &mut sampler);
    }
    path.into_log()
}

fn trace_tile(
    (stage, camera): (&Stage, &Camera),
    (low, high): (UVec2, UVec2),
    (randomisations, each): (u32, u32),
    key: Key,
    bands: usize,
    mut walk: impl Walk,
) -> Tile {
    let mut tile = Tile {
        pixels: Vec::new(),
        errors: Vec::new(),
        coverage: Vec::new(),
        sums: Sums::new(randomisations as usize, bands),
        zones: Sums::new(randomisations as usize, walk.zones()),
        hits: vec![0.0; randomisations as usize],
        rays: 0,
    };
    let scale = camera.size().as_dvec2().recip();
    for row in low.y..high.y {
        for column in low.x..high.x {
            let at = UVec2::new(column, row);
            let mut sums = Sums::new(randomisations as usize, bands);
            let mut hits = vec![0.0; randomisations as usize];
            for randomisation in 0..randomisations {
                let stream = key.index(randomisation.into());
                for sample in 0..each {
                    let index = morton(at) * u64::from(each) + u64::from(sample);
                    let mut sampler = Sampler::new(stream, index);
                    let [u, v, ..] = sampler.next_event();
                    let on_film = (at.as_dvec2() + DVec2::new(u, v)) * scale;
                    let Some(ray) = camera.ray(on_film) else { continue };
                    if !camera.admits(&ray, stage, &mut tile.rays) {
                        continue;
                    }
                    let is_seen = walk.trace(stage, ray, &mut sampler)
                        || camera.sees_sky() && walk.see_sky(stage, ray.direction);
                    if is_seen {
                        hits[randomisation as usize] += 1.0;
                        walk.add_to(&mut sums, randomisation as usize);
                        walk.add_to_zones(&mut tile.zones, randomisation as usize);
                    }
                }
            }
            let (mean, error) = ratio(sums.values(), &hits);
            tile.pixels.extend(mean.iter().map(|&value| value as f32));
            tile.errors.extend(error.iter().map(|&value| value as f32));
            let met: f64 = hits.iter().sum();
            tile.coverage.push((met / f64::from(randomisations * each)) as f32);
            tile.sums.merge(&sums);
            for (total, part) in tile.hits.iter_mut().zip(&hits) {
                *total += part;
            }
        }
    }
    tile.rays += walk.rays();
    tile
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::{morton, split};

    #[test]
    fn samples_are_split_evenly_where_they_can_be() {
        assert_eq!(split(16), (16, 1));
        assert_eq!(split(64), (32, 2));
        assert_eq!(split(50), (25, 2));
        assert_eq!(split(37), (32, 2));
        assert_eq!(split(1), (2, 1));
    }

    #[test]
    fn pixels_of_a_square_are_consecutive_along_the_curve() {
        let mut seen: Vec<u64> =
            (0..16).map(|i| morton(UVec2::new(4 + i % 4, 8 + i / 4))).collect();
        seen.sort_unstable();
        assert!(seen.windows(2).all(|pair| pair[1] == pair[0] + 1), "{seen:?}");
    }
}
