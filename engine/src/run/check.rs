//! What is refused before anything is traced.

use super::checkpoint::Keeper;
use super::forecast::{self, Size};
use super::growth::is_ledger;
use super::sensors::{MOST_SAMPLES, begin};
use super::{Failure, Options};
use crate::components::{ImageSamples, Sensor, Stop};
use crate::document::{Diagnostic, suggestion, unknown_name};
use crate::extract::Stage;
use crate::products::{Context, Product};
use crate::transport::{Camera, Partition, RANDOMISATIONS};

/// Refuses what cannot be measured, before anything is traced.
///
/// # Errors
/// If all sensors together take more memory than there is, or any is asked for what it cannot do.
pub(super) fn check(
    sensors: &[(String, Sensor)],
    scene: (&Stage, &Context),
    options: &Options,
    keeper: &Keeper,
) -> Result<(), Failure> {
    check_memory(sensors, scene, options, keeper)?;
    let check = |(name, sensor): &(String, Sensor)| {
        problems_of(name, sensor, scene, options.quality, keeper)
    };
    let problems: Vec<Diagnostic> = sensors.iter().flat_map(check).collect();
    if problems.is_empty() { Ok(()) } else { Err(Failure::Problems(problems)) }
}

/// What a sensor cannot do.
fn problems_of(
    name: &str,
    sensor: &Sensor,
    scene: (&Stage, &Context),
    quality: f64,
    keeper: &Keeper,
) -> Vec<Diagnostic> {
    let (mut measurement, plan) = begin(name, sensor, scene, quality);
    let path = format!("sensors.{name}.until");
    let mut problems = Vec::new();
    problems.extend(too_many_samples(name, sensor, scene.0, quality));
    let films = measurement.films();
    let fixed = films.iter().find_map(|paced| paced.film.can_grow().err());
    if let Some(bytes) = fixed.filter(|_| !plan.is_fixed()) {
        let gib = bytes as f64 / f64::from(1 << 30);
        let message = format!(
            "the sums of {RANDOMISATIONS} randomisations take {gib:.1} GiB: too many to grow until they are good enough"
        );
        let help = "write `until: Samples(n)`, or measure fewer cells, pixels or bands";
        problems.push(Diagnostic::error(&path, message).help(help));
    }
    if let Some(bytes) = fixed.filter(|_| keeper.keeps()) {
        let gib = bytes as f64 / f64::from(1 << 30);
        let message = format!(
            "the sums of {RANDOMISATIONS} randomisations take {gib:.1} GiB: too many for a checkpoint"
        );
        let help = "measure fewer cells, pixels or bands, or run it without `--checkpoint`";
        problems.push(Diagnostic::error(format!("sensors.{name}"), message).help(help));
    }
    if keeper.share() != Partition::ALL && !plan.is_fixed() {
        let message = "a part of a run cannot tell when the whole is good enough";
        let help = "write `until: Samples(n)` alone: all parts then end at the same place";
        problems.push(Diagnostic::error(&path, message).help(help));
    }
    let named = plan.until.iter().enumerate().filter_map(|(index, stop)| match stop {
        Stop::RelErrors(limits) => Some((index, limits)),
        _ => None,
    });
    let mut known: Option<Vec<Product>> = None;
    for (index, limits) in named {
        let at = if plan.until.len() == 1 { path.clone() } else { format!("{path}[{index}]") };
        let known = known.get_or_insert_with(|| {
            // Without a single sample.
            measurement.films().into_iter().for_each(|paced| paced.film.trace(0, &|_| ()));
            measurement.products()
        });
        for (product, _) in limits {
            if !known.iter().any(|one| one.name == *product) {
                let names = known.iter().map(|one| one.name.as_str());
                let problem = unknown_name(&at, "product", product, names.clone());
                let list: Vec<&str> = names.filter(|name| !is_ledger(name)).collect();
                let help = suggestion(product, &list, "this sensor reports");
                problems.push(problem.help(help));
            }
        }
    }
    problems
}

/// A problem if a density makes more samples in a pixel than it may have.
fn too_many_samples(
    name: &str,
    sensor: &Sensor,
    stage: &Stage,
    quality: f64,
) -> Option<Diagnostic> {
    let Sensor::Image(image) = sensor else { return None };
    let ImageSamples::PerArea(density) = image.samples else { return None };
    let samples = Camera::new(image, stage).samples(image.samples) * quality;
    // The density that makes as many as there may be, with three digits.
    let most = 0.995 * density * MOST_SAMPLES / samples;
    (image.until.is_empty() && samples > MOST_SAMPLES).then(|| {
        let message = format!("{density:e} samples per m² make {samples:.2e} samples in a pixel");
        let help = format!("a pixel may have {MOST_SAMPLES}: write at most {most:.2e}");
        Diagnostic::error(format!("sensors.{name}.samples_per_m2"), message).help(help)
    })
}

/// What each sensor will take.
///
/// # Errors
/// If all together take more memory than there is.
fn check_memory(
    sensors: &[(String, Sensor)],
    scene: (&Stage, &Context),
    options: &Options,
    keeper: &Keeper,
) -> Result<(), Failure> {
    let size = |name: &str, sensor: &Sensor| {
        let (mut measurement, _) = begin(name, sensor, scene, options.quality);
        Size::of(measurement.as_mut(), keeper)
    };
    let sizes = sensors.iter().map(|(name, sensor)| size(name, sensor)).collect();
    match forecast::check(sensors, sizes, options.free_memory(), size) {
        Some(problem) => Err(Failure::Problems(vec![problem])),
        None => Ok(()),
    }
}
