use std::ops::Range;

use glam::DVec2;

use crate::components::{System, View};
use crate::extract::Stage;
use crate::sampling::{Key, Sampler};
use crate::statistics::{Replicates, Spread, Sums, ratio};
use crate::transport::films::{ReplicateRow, ReplicateSums, SampleTracer};
use crate::transport::paths::{
    BackwardPath, FirstOrderPath, PathBatch, PathTracer, ThermalPath, write_each,
};
use crate::transport::photons::{
    Counter, OrderCounter, PacketOptions, PhotonKind, ViewCounter, photon_film,
};
use crate::transport::reference::ReferencePath;
use crate::transport::{
    LightSource, OrthographicCamera, Randomisations, ReferencePlane, RouletteThreshold,
    ScatteringOrder, spectrum_count,
};

/// System that measures the light of a source, with or without its parts by order of scattering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightSettings {
    /// Transport system.
    pub system: System,
    /// Origin of the light.
    pub source: LightSource,
    /// True if each [`ScatteringOrder`] is kept apart.
    pub separates_orders: bool,
}

/// Views of a measurement of directions, and its light.
#[derive(Clone, Copy, Debug)]
pub struct DirectionsSettings<'s> {
    /// Directions towards the sensor.
    pub views: &'s [View],
    /// Plane through which light leaves the scene.
    pub plane: &'s ReferencePlane,
    /// Light that is measured.
    pub light: LightSettings,
}

/// Outcome of a measurement of directions.
#[derive(Clone, Debug)]
pub struct DirectionsOutcome {
    /// Radiance towards each view in the unit of its [`LightSource`], shape `[views, bands]`, with its
    /// standard error: the mean over the scene's rectangle, where rays that miss an isolated scene count as dark.
    pub spread: Spread,
    /// Radiance of each [`ScatteringOrder`], on request.
    pub parts: Vec<Spread>,
}

/// Means over the rays of each view that met the scene, shape `[views, columns]`.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewsOutcome {
    /// Means of the views in the unit of their source; NaN where a view meets nothing.
    pub mean: Vec<f64>,
    /// Their standard errors.
    pub error: Vec<f64>,
    /// Sums of all columns, the number of rays that met the scene last; shape `[views, columns + 1]`.
    pub sums: Replicates,
}

impl ViewsOutcome {
    /// Outcome of sums whose last column counts the rays that met the scene.
    pub(super) fn new(film: &ReplicateSums<'_>) -> Self {
        let columns = film.rows(0).next().map_or(0, Sums::bands);
        let values = film.rows(0).next().map_or(0, |row| row.values().len());
        let rows: Vec<&[f64]> = film.rows(0).map(Sums::values).collect();
        let sums = Replicates::from_randomisations(&rows);
        let mut means = Self { mean: Vec::new(), error: Vec::new(), sums };
        for start in (0..values).step_by(columns.max(1)) {
            let of_view = |row: &Sums| row.values()[start..start + columns - 1].to_vec();
            let sums: Vec<f64> = film.rows(0).flat_map(of_view).collect();
            let last = start + columns - 1;
            let met: Vec<f64> = film.rows(0).map(|row| row.values()[last]).collect();
            let (mean, error) = ratio(&sums, &met);
            means.mean.extend(mean);
            means.error.extend(error);
        }
        means
    }
}

/// Radiance towards each of several views.
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub struct DirectionsFilm<'a> {
    /// Samples: paths of each view, or photon packets.
    pub film: ReplicateSums<'a>,
    /// Range of the values of each view in each spectrum, and the factor to radiance.
    places: Vec<(Range<usize>, f64)>,
    /// True if spectra are sums of their own; false if they follow each other in each cell.
    has_sums_per_spectrum: bool,
    spectra: usize,
}

impl<'a> DirectionsFilm<'a> {
    /// No samples yet.
    #[must_use]
    pub fn new(stage: &'a Stage, settings: DirectionsSettings<'_>, key: Key) -> Self {
        let DirectionsSettings { views, plane, light } = settings;
        let LightSettings { system, source, separates_orders } = light;
        if matches!(system, System::Forward | System::Analog) {
            return Self::of_packets(stage, settings, key);
        }
        let spectra = match system {
            System::FirstOrder => FirstOrderPath::spectrum_count(separates_orders),
            System::Backward | System::Forward | System::Analog | System::Reference => {
                spectrum_count(separates_orders)
            }
        };
        let bands = stage.bands;
        let columns = bands * spectra;
        let place = |view: usize| (view * columns..view * columns + bands, 1.0);
        let places = (0..views.len()).map(place).collect();
        let view_tracer = ViewTracer { stage, cameras: cameras(stage, views, plane), columns, key };
        let film = match (system, source) {
            (System::FirstOrder, _) => {
                view_tracer.film(move || FirstOrderPath::new(separates_orders))
            }
            (System::Reference, _) => view_tracer.film(ReferencePath::new),
            // Packets have a film of their own, above.
            (System::Backward | System::Forward | System::Analog, LightSource::Reflected) => {
                view_tracer.film(move || BackwardPath::new(stage, separates_orders))
            }
            (System::Backward | System::Forward | System::Analog, LightSource::Emitted) => {
                view_tracer.film(move || ThermalPath::new(stage))
            }
        };
        Self { film, places, has_sums_per_spectrum: false, spectra }
    }

    /// A film of photon packets, which serve all views at once.
    fn of_packets(stage: &'a Stage, settings: DirectionsSettings<'_>, key: Key) -> Self {
        let DirectionsSettings { views, plane, light } = settings;
        let LightSettings { source, separates_orders, .. } = light;
        let counter = ViewCounter::new(cameras(stage, views, plane)).with_roulette(source, key);
        let bands = stage.bands;
        let place = |(camera, cell): (&OrthographicCamera, &usize)| {
            (cell * bands..(cell + 1) * bands, camera.radiance_per_count(stage))
        };
        let places = counter.cameras().iter().zip(counter.first_cells()).map(place).collect();
        let kind = PhotonKind::Packet(RouletteThreshold::High);
        let options = PacketOptions { source, beam: 0, kind, plane: plane.clone() };
        let film = photon_film(stage, options, in_parts(counter, separates_orders), key);
        let spectra = spectrum_count(separates_orders);
        Self { film, places, has_sums_per_spectrum: true, spectra }
    }

    /// The outcome of the samples of some randomisations so far.
    #[must_use]
    pub fn outcome(&self, of: Randomisations) -> DirectionsOutcome {
        let spread = |spectrum: usize| {
            // The first sums of packets are those of their energy.
            let (sums, start) =
                if self.has_sums_per_spectrum { (1 + spectrum, 0) } else { (0, spectrum) };
            let places = self.places.iter().flat_map(|(place, scale)| {
                let shift = start * place.len();
                place.clone().map(move |value| (value + shift, *scale))
            });
            self.film.spread_of(sums, of).select(places)
        };
        DirectionsOutcome { spread: spread(0), parts: (1..self.spectra).map(spread).collect() }
    }
}

/// A counter and, on request, one for each part of the light.
pub(super) fn in_parts(
    counter: ViewCounter,
    separates_orders: bool,
) -> impl Iterator<Item = Box<dyn Counter>> {
    let parts: &[ScatteringOrder] = if separates_orders { &ScatteringOrder::ALL } else { &[] };
    let of_part = {
        let counter = counter.clone();
        move |&part: &ScatteringOrder| -> Box<dyn Counter> {
            Box::new(OrderCounter { counter: Box::new(counter.clone()), part })
        }
    };
    let whole: Box<dyn Counter> = Box::new(counter);
    std::iter::once(whole).chain(parts.iter().map(of_part))
}

/// Cameras that see the reference plane from each view.
pub(super) fn cameras(
    stage: &Stage,
    views: &[View],
    plane: &ReferencePlane,
) -> Vec<OrthographicCamera> {
    views.iter().map(|&view| OrthographicCamera::from_plane(view, plane, stage)).collect()
}

/// Traces paths from each of several views.
pub(super) struct ViewTracer<'a> {
    pub(super) stage: &'a Stage,
    pub(super) cameras: Vec<OrthographicCamera>,
    pub(super) columns: usize,
    pub(super) key: Key,
}

impl<'a> ViewTracer<'a> {
    /// A film of paths from each view, shape `[views, columns]`.
    pub(super) fn film<P: PathTracer>(self, path: impl Fn() -> P + Sync + 'a) -> ReplicateSums<'a> {
        ReplicateSums::new(PathsOfViews { tracer: self, path })
    }
}

struct PathsOfViews<'a, F> {
    tracer: ViewTracer<'a>,
    path: F,
}

impl<P: PathTracer, F: Fn() -> P + Sync> SampleTracer for PathsOfViews<'_, F> {
    fn shapes(&self) -> Vec<(usize, usize)> {
        vec![(self.tracer.cameras.len(), self.tracer.columns)]
    }

    fn block_bytes(&self, _: u64) -> u64 {
        Sums::bytes(self.tracer.cameras.len(), self.tracer.columns)
    }

    fn trace(&self, randomisation: u64, samples: Range<u64>) -> (ReplicateRow, u64) {
        let ViewTracer { stage, cameras, columns, key } = &self.tracer;
        // All views share their points: differences between them have less noise.
        let stream = key.index(randomisation);
        let mut batch = PathBatch::new(&self.path);
        let mut sums = Sums::new(cameras.len(), *columns);
        let mut rays = 0;
        for (view, camera) in cameras.iter().enumerate() {
            let starts = samples.clone().filter_map(|index| {
                let mut sampler = Sampler::new(stream, index);
                let [u, v, ..] = sampler.next_4d();
                let ray = camera.ray(DVec2::new(u, v));
                let is_admitted = camera.admits(&ray, stage, &mut rays);
                is_admitted.then_some(((), ray, sampler))
            });
            batch.trace(stage, starts, |_, paths| {
                let cell = sums.cell_mut(view);
                let valid = paths.iter().filter(|path| path.has_hit());
                write_each(
                    stage,
                    &valid,
                    cell.len(),
                    #[inline(always)]
                    |_, columns, values| {
                        for (sum, value) in cell[columns].iter_mut().zip(values) {
                            *sum += value;
                        }
                    },
                );
            });
        }
        (ReplicateRow { sums: vec![sums], coefficients: None }, rays + batch.rays())
    }
}
