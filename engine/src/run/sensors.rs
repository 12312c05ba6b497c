use std::io;

use hecs::{Entity, World};

use super::check::check;
use super::checkpoint::CheckpointStore;
use super::convergence::{Convergence, Measurement, PacedFilm, add_replicate, is_energy_balance};
use super::photons::PhotonRun;
use super::rounds::measure_until;
use super::{Failure, Options, Progress, images};
use crate::components::{
    DirectionSensor, ImageMeasure, Name, PhotonSensor, ResolvedSensor, SceneId, StopCriterion,
    System,
};
use crate::extract::Stage;
use crate::products::{self, Context, MeasuredLight, Product, ProductSize, SensorReport};
use crate::sampling::Key;
use crate::scratch::ScratchSpace;
use crate::transport::{
    DirectionsFilm, DirectionsSettings, FirstSurfaceFilm, LightSettings, LightSource,
    RANDOMISATIONS, Randomisations, ReferencePlane, Schedule,
};

/// Scene that sensors measure, and the data that products are made with.
#[derive(Clone, Copy)]
pub(super) struct MeasureContext<'a> {
    pub(super) stage: &'a Stage,
    pub(super) context: &'a Context,
    /// Place of sums of an image that take too much memory.
    pub(super) scratch: &'a ScratchSpace,
}

/// A sensor of the world.
pub(super) struct SensorEntity {
    pub(super) entity: Entity,
    pub(super) name: String,
    pub(super) sensor: ResolvedSensor,
}

/// Sensors in document order.
pub(super) fn in_order(world: &World) -> Vec<SensorEntity> {
    let mut query = world.query::<(Entity, &SceneId, &Name, &ResolvedSensor)>();
    let mut sensors: Vec<_> = query.iter().collect();
    sensors.sort_unstable_by_key(|&(_, id, ..)| *id);
    let owned = |(entity, _, name, sensor): (Entity, &SceneId, &Name, &ResolvedSensor)| {
        SensorEntity { entity, name: name.0.clone(), sensor: sensor.clone() }
    };
    sensors.into_iter().map(owned).collect()
}

/// Place of the sums of images, which share its memory: results of one stay until all sensors are measured.
pub(super) fn scratch(sensors: &[SensorEntity], options: &Options) -> ScratchSpace {
    let images = sensors.iter().filter(|one| matches!(one.sensor, ResolvedSensor::Image(_)));
    options.scratch.share(images.count())
}

/// Measures sensors in document order; returns a warning if the checkpoint could not be saved. Writes [`SensorReport`].
pub(super) fn measure_sensors(
    world: &mut World,
    sensors: &[SensorEntity],
    measured: MeasureContext<'_>,
    options: &Options,
    store: &mut CheckpointStore,
    progress: &dyn Progress,
) -> Result<Option<String>, Failure> {
    check(sensors, measured, options, store)?;
    for one in sensors {
        // Whatever is absent already need not be removed.
        drop(world.remove_one::<SensorReport>(one.entity));
    }
    for one in sensors {
        let report = measure(one, measured, options, store, progress)?;
        world.insert_one(one.entity, report).expect("sensors exist");
    }
    store.finish()
}

/// Returns whether light is traced on its way from the sun for some of what a sensor measures.
pub(super) fn is_traced_from_sun(sensor: &ResolvedSensor) -> bool {
    let is_from_sun = |system| matches!(system, System::Forward | System::Analog);
    match sensor {
        ResolvedSensor::Image(image) => is_from_sun(image.system),
        ResolvedSensor::Directions(directions) => [LightSource::Reflected, LightSource::Emitted]
            .into_iter()
            .any(|source| is_from_sun(system_of(directions, source))),
        ResolvedSensor::Photons(_) => true,
    }
}

/// Moves the reports of all sensors out of the world, in document order.
pub(super) fn take_reports(world: &mut World) -> Vec<SensorReport> {
    let sensors = in_order(world).into_iter();
    sensors.filter_map(|one| world.remove_one::<SensorReport>(one.entity).ok()).collect()
}

/// Measurement before its first sample, and what ends it.
pub(super) struct Begun<'a> {
    pub(super) measurement: Box<dyn Measurement + 'a>,
    pub(super) convergence: Convergence,
}

/// Begins the measurement of a sensor; `quality` is the factor on its numbers of samples.
pub(super) fn begin<'a>(
    name: &str,
    sensor: &'a ResolvedSensor,
    measured: MeasureContext<'a>,
    quality: f64,
) -> Begun<'a> {
    let key = Key::new(measured.stage.rules.seed).path("sensors").path(name);
    match sensor {
        ResolvedSensor::Image(sensor) => images::image(sensor, measured, key, quality),
        ResolvedSensor::Directions(sensor) => directions(sensor, measured, key, quality),
        ResolvedSensor::Photons(sensor) => photons(sensor, measured, key, quality),
    }
}

/// Measures one sensor.
pub(super) fn measure(
    SensorEntity { name, sensor, .. }: &SensorEntity,
    measured: MeasureContext<'_>,
    options: &Options,
    store: &mut CheckpointStore,
    progress: &dyn Progress,
) -> Result<SensorReport, Failure> {
    let Begun { mut measurement, convergence } = begin(name, sensor, measured, options.quality);
    let measurement = measurement.as_mut();
    let formats = &measured.context.formats;
    let end =
        measure_until(name, measurement, formats, &convergence, store, progress, options.forecast)?;
    let mut products = end.products;
    let keeps_replicates = options.keeps_replicates && !products.is_empty();
    if keeps_replicates && measurement.films().iter().all(|one| one.film.can_grow().is_ok()) {
        measurement.add_replicates(&mut products).map_err(Failure::Pixels)?;
    }
    let films = measurement.films();
    let sum = |of: &dyn Fn(&PacedFilm<'_>) -> u64| films.iter().map(of).sum();
    let samples = sum(&|paced| paced.film.samples());
    let noun = if matches!(sensor, ResolvedSensor::Photons(_)) { "packets" } else { "samples" };
    let ended_by = ended_by(&end.criterion, &end.errors, &format!("{samples} {noun}"));
    Ok(SensorReport {
        name: name.clone(),
        seconds: end.seconds,
        rays: sum(&|paced| paced.film.rays()),
        samples,
        ended_by,
        energy_imbalance: films.iter().filter_map(|paced| paced.film.imbalance()).reduce(f64::max),
        forecast: end.forecast,
        products,
    })
}

/// Text that says which criterion ended a measurement, with the largest error of all scenes.
fn ended_by(criterion: &StopCriterion, errors: &[(String, f64)], samples: &str) -> String {
    let text = |(name, error): &(String, f64), limit: f64| {
        format!("{name}: median relative standard error {error:.2e} at most {limit:.2e}")
    };
    match criterion {
        StopCriterion::RelError(limit) => {
            let asked = errors.iter().filter(|(name, _)| !is_energy_balance(name));
            let worst = asked.max_by(|a, b| a.1.total_cmp(&b.1));
            worst.map_or_else(|| samples.to_owned(), |worst| text(worst, *limit))
        }
        StopCriterion::RelErrors(limits) => {
            let of = |(name, limit): (&String, &f64)| {
                let of_name = errors.iter().filter(|(known, _)| known == name);
                let worst = of_name.max_by(|a, b| a.1.total_cmp(&b.1));
                worst.map(|worst| text(worst, *limit))
            };
            let texts: Vec<String> = limits.iter().filter_map(of).collect();
            if texts.is_empty() { samples.to_owned() } else { texts.join("; ") }
        }
        StopCriterion::Seconds(limit) => format!("{limit} s: {samples}"),
        StopCriterion::Samples(_) => samples.to_owned(),
    }
}

/// Stop criteria for `quality` times the number of samples.
pub(super) fn at_quality(until: &[StopCriterion], quality: f64) -> Vec<StopCriterion> {
    let error = |limit: f64| limit / quality.sqrt();
    let scaled = |criterion: &StopCriterion| match criterion {
        StopCriterion::RelError(limit) => StopCriterion::RelError(error(*limit)),
        StopCriterion::RelErrors(limits) => {
            let limits = limits.iter().map(|(name, limit)| (name.clone(), error(*limit)));
            StopCriterion::RelErrors(limits.collect())
        }
        StopCriterion::Seconds(limit) => StopCriterion::Seconds(limit * quality),
        StopCriterion::Samples(limit) => {
            StopCriterion::Samples((*limit as f64 * quality).ceil() as u64)
        }
    };
    until.iter().map(scaled).collect()
}

/// Samples of each randomisation that make up a total.
pub(super) fn each_of(samples: u64) -> u64 {
    samples.div_ceil(RANDOMISATIONS.into()).max(1)
}

/// Largest number of samples per pixel.
pub(super) const MOST_SAMPLES: f64 = 16_777_216.0;

struct DirectionsRun<'a> {
    sensor: &'a DirectionSensor,
    measured: MeasureContext<'a>,
    reflected: Option<DirectionsFilm<'a>>,
    emitted: Option<DirectionsFilm<'a>>,
    components: Option<FirstSurfaceFilm<'a>>,
}

fn directions<'a>(
    sensor: &'a DirectionSensor,
    measured: MeasureContext<'a>,
    key: Key,
    quality: f64,
) -> Begun<'a> {
    let MeasureContext { stage, context, .. } = measured;
    let views = sensor.views.as_slice();
    let plane = &ReferencePlane::new(sensor.plane.as_ref(), stage);
    let orders = sensor.measure.contains(&ImageMeasure::Orders);
    let film = |source, orders, key| {
        let system = system_of(sensor, source);
        let light = LightSettings { system, source, separates_orders: orders };
        DirectionsFilm::new(stage, DirectionsSettings { views, plane, light }, key)
    };
    let reflected = needs_reflection(&sensor.measure, context)
        .then(|| film(LightSource::Reflected, orders, key));
    let emitted = needs_emission(&sensor.measure, context)
        .then(|| film(LightSource::Emitted, false, key.path("emission")));
    let components = (!sensor.measure.iter().all(ImageMeasure::is_light))
        .then(|| FirstSurfaceFilm::new(stage, views, plane, key.path("components")));
    let until = at_quality(&sensor.until, quality);
    let convergence = Convergence { until, schedule: Schedule::Blocks, each: Box::new(each_of) };
    let measurement = Box::new(DirectionsRun { sensor, measured, reflected, emitted, components });
    Begun { measurement, convergence }
}

impl Measurement for DirectionsRun<'_> {
    fn films(&mut self) -> Vec<PacedFilm<'_>> {
        let light = [&mut self.reflected, &mut self.emitted].into_iter().flatten();
        let films = light.map(|one| &mut one.film);
        films
            .chain(self.components.iter_mut().map(|one| &mut one.film))
            .map(|film| PacedFilm::evenly(film))
            .collect()
    }

    fn product_sizes(&self) -> Vec<ProductSize> {
        let DirectionSensor { views, measure, .. } = self.sensor;
        let light =
            MeasuredLight { reflected: self.reflected.is_some(), emitted: self.emitted.is_some() };
        let MeasureContext { stage, context, .. } = self.measured;
        products::direction_sizes(views.len(), measure, light, stage, context)
    }

    fn context(&self) -> &Context {
        self.measured.context
    }

    fn products(&self) -> io::Result<Vec<Product>> {
        let DirectionSensor { views, measure, .. } = self.sensor;
        let MeasureContext { stage, context, .. } = self.measured;
        let mut products = self.products_of_light(Randomisations::All);
        if let Some(components) = &self.components {
            let outcome = components.outcome();
            for &one in measure {
                products
                    .extend(products::direction_components(one, views, &outcome, stage, context));
            }
        }
        Ok(products)
    }

    fn add_replicates(&self, products: &mut [Product]) -> io::Result<()> {
        Randomisations::each().for_each(|of| add_replicate(products, &self.products_of_light(of)));
        Ok(())
    }
}

impl DirectionsRun<'_> {
    /// Products that are made of light, of some randomisations.
    fn products_of_light(&self, of: Randomisations) -> Vec<Product> {
        let DirectionSensor { views, measure, .. } = self.sensor;
        let [reflected, emitted] =
            [&self.reflected, &self.emitted].map(|film| film.as_ref().map(|film| film.outcome(of)));
        let (reflected, emitted) = (reflected.as_ref(), emitted.as_ref());
        products::direction_products(views, measure, reflected, emitted, self.measured.context)
    }
}

/// Transport system of a sensor: the one that it names, or the one that takes fewest rays for the same error.
///
/// Packets serve all views at once: for 31 views they take half of the rays of paths, for one view as many or more
/// (`transport/README.md`). Most packets miss a small plane, and emitted radiance is found directly by paths from the
/// sensor.
fn system_of(sensor: &DirectionSensor, source: LightSource) -> System {
    let best = match source {
        LightSource::Reflected if sensor.plane.is_none() && sensor.views.len() > 1 => {
            System::Forward
        }
        LightSource::Reflected | LightSource::Emitted => System::Backward,
    };
    sensor.system.unwrap_or(best)
}

/// Returns whether a measure takes reflected light of sun and sky.
pub(super) fn needs_reflection(measures: &[ImageMeasure], context: &Context) -> bool {
    measures.iter().any(|measure| match measure {
        ImageMeasure::Brf | ImageMeasure::Orders => true,
        ImageMeasure::Radiance => context.sources.iter().any(|source| source.reflects),
        ImageMeasure::BrightnessTemperature => {
            context.sources.iter().any(|source| source.emits && source.reflects)
        }
        ImageMeasure::FourComponents | ImageMeasure::GapFraction => false,
    })
}

/// Returns whether a measure takes emitted light of surfaces and sky.
pub(super) fn needs_emission(measures: &[ImageMeasure], context: &Context) -> bool {
    let takes = |measure: &ImageMeasure| {
        matches!(measure, ImageMeasure::Radiance | ImageMeasure::BrightnessTemperature)
    };
    measures.iter().any(takes) && context.sources.iter().any(|source| source.emits)
}

fn photons<'a>(
    sensor: &'a PhotonSensor,
    measured: MeasureContext<'a>,
    key: Key,
    quality: f64,
) -> Begun<'a> {
    let MeasureContext { stage, .. } = measured;
    let until = if sensor.until.is_empty() {
        vec![StopCriterion::Samples((sensor.per_area * stage.area() * quality).ceil() as u64)]
    } else {
        at_quality(&sensor.until, quality)
    };
    let measurement = Box::new(PhotonRun::new(sensor, measured, key));
    let convergence = Convergence { until, schedule: Schedule::Blocks, each: Box::new(each_of) };
    Begun { measurement, convergence }
}
