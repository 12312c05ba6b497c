use std::ops::Range;

use glam::DVec2;

use super::forward::photon_film;
use super::rows::{Rows, Tracer};
use super::walk::{Party, Walk, show_each};
use super::{
    Counter, FirstOrder, Grain, Part, PartCounter, Path, Projection, ReferencePlane, Roulette,
    Source, ThermalPath, ViewCounter, spectra,
};
use crate::components::{System, View};
use crate::extract::Stage;
use crate::film::{Replicates, Spread, Sums, ratio};
use crate::sampling::{Key, Sampler};

/// What a measurement of directions found.
#[derive(Clone, Debug)]
pub struct DirectionsOutcome {
    /// Radiance towards each view in the unit of its [`Source`], shape `[views, bands]`, with its
    /// standard error: the mean over the scene's rectangle, of which what misses an isolated scene
    /// is dark.
    pub spread: Spread,
    /// The same of each [`Part`], if asked for.
    pub parts: Vec<Spread>,
}

/// Means over what each view met of the scene, shape `[views, columns]`.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewsOutcome {
    /// The means; NaN where a view meets nothing.
    pub mean: Vec<f64>,
    /// Their standard errors.
    pub error: Vec<f64>,
    /// Sums of all columns, that of what was met the last, shape `[views, columns + 1]`.
    pub sums: Replicates,
}

impl ViewsOutcome {
    /// Of sums whose last column counts what was met.
    pub(super) fn of_met(film: &Rows<'_>) -> Self {
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
    /// The samples: paths of each view, or photon packets.
    pub film: Rows<'a>,
    /// Where the values of each view stand in each spectrum and what turns them into radiance.
    places: Vec<(Range<usize>, f64)>,
    /// Whether spectra are sums of their own; in a row if not.
    apart: bool,
    spectra: usize,
}

impl<'a> DirectionsFilm<'a> {
    /// No sample yet.
    #[must_use]
    pub fn new(
        stage: &'a Stage,
        (views, plane): (&[View], &ReferencePlane),
        (system, source, orders): (System, Source, bool),
        key: Key,
    ) -> Self {
        let projections = projections(stage, views, plane);
        let bands = stage.bands;
        let spectra = match system {
            System::FirstOrder => FirstOrder::spectra(orders),
            _ => spectra(orders),
        };
        let columns = bands * spectra;
        let each = |view: usize| (view * columns..view * columns + bands, 1.0);
        let places = (0..views.len()).map(each).collect();
        let film = match (system, source) {
            (System::Backward, Source::Reflected) => {
                let path = move || Path::new(stage.bands, orders);
                view_film((stage, projections), columns, key, path)
            }
            (System::Backward, Source::Emitted) => {
                view_film((stage, projections), columns, key, || ThermalPath::new(stage))
            }
            (System::FirstOrder, _) => {
                let path = move || FirstOrder::new(orders);
                view_film((stage, projections), columns, key, path)
            }
            (System::Forward | System::Analog, _) => {
                let counter = ViewCounter::new(projections).with_roulette(source, key);
                let place = |(projection, cell): (&Projection, &usize)| {
                    (cell * bands..(cell + 1) * bands, projection.radiance_of_count(stage))
                };
                let cells = counter.projections().iter().zip(counter.first_cells());
                let places = cells.map(place).collect();
                let counters = in_parts(counter, orders);
                let of = (source, Grain::Packet(Roulette::Firm), plane.clone());
                let film = photon_film(stage, of, counters, key);
                return Self { film, places, apart: true, spectra };
            }
        };
        Self { film, places, apart: false, spectra }
    }

    /// What was found so far.
    #[must_use]
    pub fn outcome(&self) -> DirectionsOutcome {
        let of = |spectrum: usize| {
            // The first sums of packets are those of their energy.
            let (sums, start) = if self.apart { (1 + spectrum, 0) } else { (0, spectrum) };
            let places = self.places.iter().flat_map(|(place, scale)| {
                let shift = start * place.len();
                place.clone().map(move |value| (value + shift, *scale))
            });
            self.film.spread(sums).select(places)
        };
        DirectionsOutcome { spread: of(0), parts: (1..self.spectra).map(of).collect() }
    }
}

/// A counter and, with `orders`, the same for each part of the light.
pub(super) fn in_parts(
    counter: ViewCounter,
    orders: bool,
) -> impl Iterator<Item = Box<dyn Counter>> {
    let parts: &[Part] = if orders { &Part::ALL } else { &[] };
    let of_part = {
        let counter = counter.clone();
        move |&part: &Part| -> Box<dyn Counter> {
            Box::new(PartCounter { counter: Box::new(counter.clone()), part })
        }
    };
    let whole: Box<dyn Counter> = Box::new(counter);
    std::iter::once(whole).chain(parts.iter().map(of_part))
}

/// The reference plane seen from each view.
pub(super) fn projections(
    stage: &Stage,
    views: &[View],
    plane: &ReferencePlane,
) -> Vec<Projection> {
    views.iter().map(|&view| Projection::of_plane(view, plane, stage)).collect()
}

/// What walks from each view find, shape `[views, columns]`.
pub(super) fn view_film<'a, W: Walk<'a>>(
    (stage, projections): (&'a Stage, Vec<Projection>),
    columns: usize,
    key: Key,
    walk: impl Fn() -> W + Sync + 'a,
) -> Rows<'a> {
    Rows::new(Views { stage, projections, columns, key, walk })
}

struct Views<'a, F> {
    stage: &'a Stage,
    projections: Vec<Projection>,
    columns: usize,
    key: Key,
    walk: F,
}

impl<'a, W: Walk<'a>, F: Fn() -> W + Sync> Tracer for Views<'a, F> {
    fn shapes(&self) -> Vec<(usize, usize)> {
        vec![(self.projections.len(), self.columns)]
    }

    fn block_bytes(&self, _: u64) -> u64 {
        Sums::bytes(self.projections.len(), self.columns)
    }

    fn trace(&self, randomisation: u64, samples: Range<u64>) -> (Vec<Sums>, u64) {
        // All views share their points: differences between them have less noise.
        let stream = self.key.index(randomisation);
        let mut party = Party::new(&self.walk);
        let mut sums = Sums::new(self.projections.len(), self.columns);
        let mut rays = 0;
        for (view, projection) in self.projections.iter().enumerate() {
            let starts = samples.clone().filter_map(|index| {
                let mut sampler = Sampler::new(stream, index);
                let [u, v, ..] = sampler.next_event();
                let ray = projection.ray(DVec2::new(u, v));
                let is_admitted = projection.admits(&ray, self.stage, &mut rays);
                is_admitted.then_some(((), ray, sampler))
            });
            party.follow(self.stage, starts, |_, walks| {
                let cell = sums.cell_mut(view);
                let met = walks.iter().filter(|walk| walk.has_met());
                show_each(
                    &met,
                    cell.len(),
                    #[inline(always)]
                    |_, columns, found| {
                        for (sum, found) in cell[columns].iter_mut().zip(found) {
                            *sum += found;
                        }
                    },
                );
            });
        }
        (vec![sums], rays + party.rays())
    }
}
