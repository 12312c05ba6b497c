//! Checks of sensors before anything is traced.

use std::io;

use super::checkpoint::CheckpointStore;
use super::convergence::{Measurement, is_energy_balance};
use super::cost::{self, CostEstimate};
use super::sensors::{Begun, MOST_SAMPLES, MeasureContext, SensorEntity, begin};
use super::{Failure, Options};
use crate::components::{ImageSamples, ResolvedSensor, StopCriterion};
use crate::document::{Diagnostic, ScenePath, suggestion, unknown_name};
use crate::extract::Stage;
use crate::products::Product;
use crate::transport::{Camera, Partition, RANDOMISATIONS};

/// Refuses sensors that cannot be measured.
///
/// # Errors
/// If all sensors together take more memory than is free, or one of them cannot measure its quantities.
pub(super) fn check(
    sensors: &[SensorEntity],
    measured: MeasureContext<'_>,
    options: &Options,
    store: &CheckpointStore,
) -> Result<(), Failure> {
    check_memory(sensors, measured, options, store)?;
    let check =
        |one: &SensorEntity| problems_of(&one.name, &one.sensor, measured, options.quality, store);
    let problems: Vec<Diagnostic> = sensors.iter().flat_map(check).collect();
    if problems.is_empty() { Ok(()) } else { Err(Failure::Problems(problems)) }
}

/// Errors of a sensor.
fn problems_of(
    name: &str,
    sensor: &ResolvedSensor,
    measured: MeasureContext<'_>,
    quality: f64,
    store: &CheckpointStore,
) -> Vec<Diagnostic> {
    let Begun { mut measurement, convergence } = begin(name, sensor, measured, quality);
    let path = ScenePath::from("sensors").name(name).key("until");
    let mut problems = Vec::new();
    problems.extend(too_many_samples(name, sensor, measured.stage, quality));
    let films = measurement.films();
    let fixed = films.iter().find_map(|paced| paced.film.can_grow().err());
    if let Some(bytes) = fixed.filter(|_| !convergence.is_fixed()) {
        let gib = bytes as f64 / f64::from(1 << 30);
        let message = format!(
            "the sums of {RANDOMISATIONS} randomisations take {gib:.1} GiB: too many to grow until they are good enough"
        );
        let help = "write `until: Samples(n)`, or measure fewer cells, pixels or bands";
        problems.push(Diagnostic::error(&path, message).help(help));
    }
    if let Some(bytes) = fixed.filter(|_| store.is_enabled()) {
        let gib = bytes as f64 / f64::from(1 << 30);
        let message = format!(
            "the sums of {RANDOMISATIONS} randomisations take {gib:.1} GiB: too many for a checkpoint"
        );
        let help = "measure fewer cells, pixels or bands, or run it without `--checkpoint`";
        problems.push(Diagnostic::error(ScenePath::from("sensors").name(name), message).help(help));
    }
    if store.share() != Partition::ALL && !convergence.is_fixed() {
        let message = "a part of a run cannot tell when the whole is good enough";
        let help = "write `until: Samples(n)` alone: all parts then end at the same place";
        problems.push(Diagnostic::error(&path, message).help(help));
    }
    let named = convergence.until.iter().enumerate().filter_map(|(index, stop)| match stop {
        StopCriterion::RelErrors(limits) => Some((index, limits)),
        _ => None,
    });
    let mut known: Option<Vec<Product>> = None;
    for (index, limits) in named {
        let at = if convergence.until.len() == 1 { path.clone() } else { path.index(index) };
        let known = match &mut known {
            Some(known) => known,
            None => match products_without_samples(measurement.as_mut()) {
                Ok(products) => known.insert(products),
                Err(error) => {
                    problems.push(Diagnostic::error(&at, Failure::Pixels(error).to_string()));
                    break;
                }
            },
        };
        for (product, _) in limits {
            if !known.iter().any(|one| one.name == *product) {
                let names = known.iter().map(|one| one.name.as_str());
                let problem = unknown_name(&at, "product", product, names.clone());
                let list: Vec<&str> = names.filter(|name| !is_energy_balance(name)).collect();
                let help = suggestion(product, &list, "this sensor reports");
                problems.push(problem.help(help));
            }
        }
    }
    problems
}

/// Products of a measurement that has no samples yet, which tell their names.
fn products_without_samples(measurement: &mut dyn Measurement) -> io::Result<Vec<Product>> {
    measurement.films().into_iter().try_for_each(|paced| paced.film.trace(0, &|_| ()))?;
    measurement.products()
}

/// Returns an error if a density makes more samples in a pixel than it may have.
fn too_many_samples(
    name: &str,
    sensor: &ResolvedSensor,
    stage: &Stage,
    quality: f64,
) -> Option<Diagnostic> {
    let ResolvedSensor::Image(image) = sensor else { return None };
    let ImageSamples::PerArea(density) = image.samples else { return None };
    let samples = Camera::new(image, stage).samples(image.samples) * quality;
    // The density that makes as many as there may be, with three digits.
    let most = 0.995 * density * MOST_SAMPLES / samples;
    (image.until.is_empty() && samples > MOST_SAMPLES).then(|| {
        let message = format!("{density:e} samples per m² make {samples:.2e} samples in a pixel");
        let help = format!("a pixel may have {MOST_SAMPLES}: write at most {most:.2e}");
        let path = ScenePath::from("sensors").name(name).key("samples_per_m2");
        Diagnostic::error(path, message).help(help)
    })
}

/// Memory of all products and the largest films, bytes: by their shapes alone, the same for any number of threads.
pub(super) fn joined_memory(
    sensors: &[SensorEntity],
    measured: MeasureContext<'_>,
    options: &Options,
) -> u64 {
    let store = CheckpointStore::disabled();
    let costs = sensors.iter().map(|one| {
        let Begun { mut measurement, .. } =
            begin(&one.name, &one.sensor, measured, options.quality);
        CostEstimate::new(measurement.as_mut(), &store, &measured.context.formats)
    });
    cost::shapes(costs)
}

/// Checks the memory of all sensors, and the disk for their temporary files.
///
/// # Errors
/// If all together take more than is free.
fn check_memory(
    sensors: &[SensorEntity],
    measured: MeasureContext<'_>,
    options: &Options,
    store: &CheckpointStore,
) -> Result<(), Failure> {
    let cost = |name: &str, sensor: &ResolvedSensor| {
        let Begun { mut measurement, .. } = begin(name, sensor, measured, options.quality);
        CostEstimate::new(measurement.as_mut(), store, &measured.context.formats)
    };
    let problem = cost::check_memory(sensors, options.free_memory(), cost)
        .or_else(|| cost::check_disk(sensors, &options.scratch, cost));
    problem.map_or(Ok(()), |problem| Err(Failure::Problems(vec![problem])))
}
