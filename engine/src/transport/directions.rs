use std::cell::Cell;
use std::ops::Range;

use super::forward::{Ledger, trace_packets};
use super::{
    Counter, EnergyCounter, Part, PartCounter, Path, Projection, RANDOMISATIONS, ReferencePlane,
    Source, ThermalPath, ViewCounter, Walk, Watch, blocks, spectra,
};
use crate::components::{Stop, System, View};
use crate::extract::Stage;
use crate::film::{Spread, Sums, ratio};
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
    /// Paths a view, photon packets, or lines along which some start.
    pub samples: u64,
    /// Rays traced.
    pub rays: u64,
    /// What ended it.
    pub ended_by: Stop,
    /// Of photon packets, the largest share of the incident energy that is not accounted for.
    pub imbalance: Option<f64>,
}

/// Means over what each view met of the scene, shape `[views, columns]`.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewsOutcome {
    /// The means; NaN where a view meets nothing.
    pub mean: Vec<f64>,
    /// Their standard errors.
    pub error: Vec<f64>,
    /// Samples a view.
    pub samples: u64,
    /// Rays traced.
    pub rays: u64,
    /// What ended it.
    pub ended_by: Stop,
}

/// Means and standard errors of what was met, shape `[views, columns]`.
pub(super) struct Means {
    mean: Vec<f64>,
    error: Vec<f64>,
}

impl Means {
    /// Of sums whose last column counts what was met.
    pub(super) fn of_met(rows: &[Sums]) -> Self {
        let columns = rows.first().map_or(0, Sums::bands);
        let values = rows.first().map_or(0, |row| row.values().len());
        let mut means = Self { mean: Vec::new(), error: Vec::new() };
        for start in (0..values).step_by(columns.max(1)) {
            let of_view = |row: &Sums| row.values()[start..start + columns - 1].to_vec();
            let sums: Vec<f64> = rows.iter().flat_map(of_view).collect();
            let met: Vec<f64> = rows.iter().map(|row| row.values()[start + columns - 1]).collect();
            let (mean, error) = ratio(&sums, &met);
            means.mean.extend(mean);
            means.error.extend(error);
        }
        means
    }

    /// Median of the relative errors of all means other than 0.
    pub(super) fn median_relative_error(&self) -> f64 {
        let pairs = self.mean.iter().zip(&self.error);
        let mut relative: Vec<f64> = pairs
            .filter(|(mean, _)| mean.abs() > 0.0)
            .map(|(mean, error)| error / mean.abs())
            .collect();
        if relative.is_empty() {
            return 0.0;
        }
        let middle = relative.len() / 2;
        *relative.select_nth_unstable_by(middle, f64::total_cmp).1
    }
}

/// Samples of each randomisation in the first round.
const FIRST_ROUND: u64 = 16;

/// Measures until one of the conditions holds; `elapsed` tells the seconds since the start.
///
/// # Panics
/// If there is no condition.
#[must_use]
pub fn measure_directions(
    stage: &Stage,
    (views, plane): (&[View], &ReferencePlane),
    (system, source, orders): (System, Source, bool),
    until: &[Stop],
    key: Key,
    elapsed: &dyn Fn() -> f64,
    watch: Watch<'_>,
) -> DirectionsOutcome {
    let projections = projections(stage, views, plane);
    let imbalance = Cell::new(None);
    let rounds = Rounds::measure(
        (views.len(), stage.bands * spectra(orders)),
        until,
        (elapsed, watch),
        |range, rows| match (system, source) {
            (System::Backward, Source::Reflected) => {
                let path = || Path::of_orders(stage.lanes(), orders);
                walk_views(stage, &projections, range, key, rows, path)
            }
            (System::Backward, Source::Emitted) => {
                walk_views(stage, &projections, range, key, rows, || ThermalPath::new(stage))
            }
            (System::Forward, _) => {
                let to = (projections.as_slice(), plane);
                let ledger = trace_photons_to(stage, to, range, (key, source, orders), rows);
                let before = imbalance.get().unwrap_or(0.0);
                imbalance.set(Some(ledger.imbalance.max(before)));
                ledger.rays
            }
        },
        |rows, each| spread(rows, each, 0..stage.bands).median_relative_error(),
    );
    let of = |spectrum: usize| {
        let columns = spectrum * stage.bands..(spectrum + 1) * stage.bands;
        spread(&rounds.rows, rounds.each, columns)
    };
    DirectionsOutcome {
        spread: of(0),
        parts: (1..spectra(orders)).map(of).collect(),
        samples: rounds.samples(),
        rays: rounds.rays,
        ended_by: rounds.ended_by,
        imbalance: imbalance.get(),
    }
}

/// The reference plane seen from each view.
pub(super) fn projections(
    stage: &Stage,
    views: &[View],
    plane: &ReferencePlane,
) -> Vec<Projection> {
    views.iter().map(|&view| Projection::of_plane(view, plane, stage)).collect()
}

/// Rounds of samples until a measurement is good enough.
pub(super) struct Rounds {
    /// Sums of each randomisation, shape `[views, columns]`.
    rows: Vec<Sums>,
    /// Samples of each randomisation, a view.
    each: u64,
    rays: u64,
    ended_by: Stop,
}

impl Rounds {
    /// - `shape`: views and columns
    /// - `trace`: adds these samples of every randomisation to the sums; returns the rays traced
    /// - `error`: relative error of the sums of so many samples
    ///
    /// # Panics
    /// If there is no condition.
    pub(super) fn measure(
        (views, columns): (usize, usize),
        until: &[Stop],
        (elapsed, watch): (&dyn Fn() -> f64, Watch<'_>),
        trace: impl Fn(Range<u64>, &mut [Sums]) -> u64,
        error: impl Fn(&[Sums], u64) -> f64,
    ) -> Self {
        assert!(!until.is_empty(), "a measurement ends");
        let mut rows = vec![Sums::new(views, columns); RANDOMISATIONS as usize];
        let mut rays = 0;
        let mut done = 0;
        let mut next = first_round(until);
        loop {
            rays += trace(done..next, &mut rows);
            done = next;
            let samples = done * u64::from(RANDOMISATIONS);
            let error = error(&rows, done);
            let seconds = elapsed();
            let progress = |stop: &Stop| match *stop {
                // The error falls as the root of the number of samples at the slowest.
                Stop::RelError(target) => (target / error).powi(2),
                Stop::Seconds(limit) => seconds / limit,
                Stop::Samples(limit) => samples as f64 / limit as f64,
            };
            let furthest = until
                .iter()
                .max_by(|a, b| progress(a).total_cmp(&progress(b)))
                .expect("there is a condition");
            let part = progress(furthest);
            watch(part.min(1.0));
            if part >= 1.0 {
                return Self { rows, each: done, rays, ended_by: *furthest };
            }
            // Aim a little past what the slowest law asks for, but never far beyond what was seen.
            let aim = (done as f64 * (1.05 / part.max(0.1))).ceil() as u64;
            next = match furthest {
                Stop::Samples(limit) => limit.div_ceil(RANDOMISATIONS.into()),
                _ => aim.clamp(done + done / 4 + 1, done * 4),
            };
            next = next.min(done + ROUND_LIMIT);
        }
    }

    /// Means over what was met; the last column counts that.
    pub(super) fn of_met(self) -> ViewsOutcome {
        let Means { mean, error } = Means::of_met(&self.rows);
        let samples = self.samples();
        ViewsOutcome { mean, error, samples, rays: self.rays, ended_by: self.ended_by }
    }

    /// Samples a view.
    fn samples(&self) -> u64 {
        self.each * u64::from(RANDOMISATIONS)
    }
}

/// Samples of each randomisation between two looks at clock and error.
const ROUND_LIMIT: u64 = 1 << 14;

fn first_round(until: &[Stop]) -> u64 {
    let limits = until.iter().filter_map(|stop| match *stop {
        Stop::Samples(limit) => Some(limit.div_ceil(RANDOMISATIONS.into())),
        _ => None,
    });
    limits.fold(FIRST_ROUND, u64::min).max(1)
}

/// Of these columns: their means over all samples, those that met nothing included.
fn spread(rows: &[Sums], samples: u64, columns: Range<usize>) -> Spread {
    let means: Vec<Vec<f64>> = rows
        .iter()
        .map(|row| {
            row.values()
                .chunks_exact(row.bands())
                .flat_map(|view| &view[columns.clone()])
                .map(|sum| sum / samples as f64)
                .collect()
        })
        .collect();
    Spread::of(means[0].len(), means.iter().map(Vec::as_slice))
}

/// Walks `range` of each randomisation from each view.
pub(super) fn walk_views<W: Walk>(
    stage: &Stage,
    projections: &[Projection],
    range: Range<u64>,
    key: Key,
    rows: &mut [Sums],
    walk: impl Fn() -> W + Sync,
) -> u64 {
    let columns = rows.first().map_or(0, Sums::bands);
    let mut rays = 0;
    let views = projections.len();
    blocks::in_order(
        views * rows.len(),
        256,
        |block| {
            let (view, randomisation) = (block % views, block / views);
            let projection = &projections[view];
            // All views share their points: differences between them have less noise.
            let stream = key.index(randomisation as u64);
            let mut walk = walk();
            let mut sums = Sums::new(1, columns);
            let mut rays = 0;
            for index in range.clone() {
                let mut sampler = Sampler::new(stream, index);
                let [u, v, ..] = sampler.next_event();
                let ray = projection.ray(glam::DVec2::new(u, v));
                if projection.admits(&ray, stage, &mut rays) && walk.trace(stage, ray, &mut sampler)
                {
                    walk.add_to(&mut sums, 0);
                }
            }
            (sums, rays + walk.rays())
        },
        |block, (sums, traced)| {
            rows[block / views].add_cell(block % views, sums.values());
            rays += traced;
        },
    );
    rays
}

/// Traces packets `range` of each randomisation and counts their virtual photons.
fn trace_photons_to(
    stage: &Stage,
    (projections, plane): (&[Projection], &ReferencePlane),
    range: Range<u64>,
    (key, source, orders): (Key, Source, bool),
    rows: &mut [Sums],
) -> Ledger {
    let energy = EnergyCounter { surfaces: stage.surfaces.len(), plane: plane.clone() };
    let counter = ViewCounter::new(projections.to_vec());
    let cells = counter.first_cells().to_vec();
    let mut counters: Vec<Box<dyn Counter + '_>> = vec![Box::new(counter.clone())];
    if orders {
        counters.extend(Part::ALL.map(|part| -> Box<dyn Counter + '_> {
            Box::new(PartCounter { counter: Box::new(counter.clone()), part })
        }));
    }
    let counters = (&energy, counters.as_slice());
    trace_packets(stage, source, counters, range, key, &|_| {}, |randomisation, _, sums| {
        for (view, (projection, cell)) in projections.iter().zip(&cells).enumerate() {
            let per_count = projection.radiance_of_count(stage);
            let bands = cell * stage.bands..(cell + 1) * stage.bands;
            let radiance: Vec<f64> = sums
                .iter()
                .flat_map(|sums| &sums.values()[bands.clone()])
                .map(|sum| sum * per_count)
                .collect();
            rows[randomisation].add_cell(view, &radiance);
        }
    })
}
