use hecs::World;

use super::checkpoint::Keeper;
use super::growth::{Ending, Measurement, Paced, Plan, grow, is_ledger};
use super::photons::PhotonRun;
use super::{Failure, Options, Progress};
use crate::components::{
    Directions, ImageMeasure, ImageSensor, Name, Photons, SceneId, Sensor, Stop, System,
};
use crate::extract::Stage;
use crate::products::{self, Context, Extent, Product, SensorReport};
use crate::sampling::Key;
use crate::transport::{
    Camera, ComponentsFilm, DirectionsFilm, DirectionsSettings, ImageFilm, ImageTiles,
    LightSettings, LightSource, RANDOMISATIONS, ReferencePlane, Schedule, image_components_film,
};

/// All sensors in document order.
pub(super) fn in_order(world: &World) -> Vec<(String, Sensor)> {
    let mut query = world.query::<(&SceneId, &Name, &Sensor)>();
    let mut sensors: Vec<_> = query.iter().collect();
    sensors.sort_unstable_by_key(|&(id, ..)| *id);
    sensors.into_iter().map(|(_, name, sensor)| (name.0.clone(), sensor.clone())).collect()
}

/// A measurement before its first sample, and how far it goes.
pub(super) type Begun<'a> = (Box<dyn Measurement + 'a>, Plan);

pub(super) fn begin<'a>(
    name: &str,
    sensor: &'a Sensor,
    (stage, context): (&'a Stage, &'a Context),
    quality: f64,
) -> Begun<'a> {
    let key = Key::new(stage.rules.seed).path("sensors").path(name);
    match sensor {
        Sensor::Image(sensor) => image(sensor, (stage, context), (key, quality)),
        Sensor::Directions(sensor) => directions(sensor, (stage, context), (key, quality)),
        Sensor::Photons(sensor) => photons(sensor, (stage, context), (key, quality)),
    }
}

/// Measures one sensor.
pub(super) fn measure(
    name: &str,
    sensor: &Sensor,
    scene: (&Stage, &Context),
    options: &Options,
    keeper: &mut Keeper,
    progress: &dyn Progress,
) -> Result<SensorReport, Failure> {
    let (mut measurement, plan) = begin(name, sensor, scene, options.quality);
    let ending = grow(name, measurement.as_mut(), &plan, keeper, (progress, options.forecast))?;
    let films = measurement.films();
    let sum = |of: &dyn Fn(&Paced<'_>) -> u64| films.iter().map(of).sum();
    let samples = sum(&|paced| paced.film.samples());
    let noun = if matches!(sensor, Sensor::Photons(_)) { "packets" } else { "samples" };
    Ok(SensorReport {
        name: name.to_owned(),
        seconds: ending.seconds,
        rays: sum(&|paced| paced.film.rays()),
        samples,
        ended_by: ended_by(&ending, &format!("{samples} {noun}")),
        energy_imbalance: films.iter().filter_map(|paced| paced.film.imbalance()).reduce(f64::max),
        forecast: ending.forecast,
        products: ending.products,
    })
}

/// What ended a measurement, for a person.
fn ended_by(ending: &Ending, samples: &str) -> String {
    let shown = |(name, error): &(String, f64), limit: f64| {
        format!("{name}: median relative standard error {error:.2e} at most {limit:.2e}")
    };
    match &ending.stop {
        Stop::RelError(limit) => {
            let asked = ending.errors.iter().filter(|(name, _)| !is_ledger(name));
            let worst = asked.max_by(|a, b| a.1.total_cmp(&b.1));
            worst.map_or_else(|| samples.to_owned(), |worst| shown(worst, *limit))
        }
        Stop::RelErrors(limits) => {
            let of = |(name, limit): &(String, f64)| {
                let found = ending.errors.iter().find(|(known, _)| known == name);
                found.map(|found| shown(found, *limit))
            };
            let texts: Vec<String> = limits.iter().filter_map(of).collect();
            if texts.is_empty() { samples.to_owned() } else { texts.join("; ") }
        }
        Stop::Seconds(limit) => format!("{limit} s: {samples}"),
        Stop::Samples(_) => samples.to_owned(),
    }
}

/// Conditions under another number of samples.
fn at_quality(until: &[Stop], quality: f64) -> Vec<Stop> {
    let error = |limit: f64| limit / quality.sqrt();
    let stop = |stop: &Stop| match stop {
        Stop::RelError(limit) => Stop::RelError(error(*limit)),
        Stop::RelErrors(limits) => {
            let limits = limits.iter().map(|(name, limit)| (name.clone(), error(*limit)));
            Stop::RelErrors(limits.collect())
        }
        Stop::Seconds(limit) => Stop::Seconds(limit * quality),
        Stop::Samples(limit) => Stop::Samples((*limit as f64 * quality).ceil() as u64),
    };
    until.iter().map(stop).collect()
}

/// Samples of each randomisation that make up so many.
fn each_of(samples: u64) -> u64 {
    samples.div_ceil(RANDOMISATIONS.into()).max(1)
}

/// Samples that a pixel may have.
pub(super) const MOST_SAMPLES: f64 = 16_777_216.0;

/// Pixels of an image from which on the median of their errors is one from eight samples on.
const MANY_PIXELS: u64 = 256;

struct ImageRun<'a> {
    sensor: &'a ImageSensor,
    scene: (&'a Stage, &'a Context),
    reflected: Option<ImageFilm<'a>>,
    emitted: Option<ImageFilm<'a>>,
    components: Option<ImageTiles<'a>>,
    /// Samples of a pixel for each of the measurement.
    pace: (u64, u64),
}

fn image<'a>(
    sensor: &'a ImageSensor,
    (stage, context): (&'a Stage, &'a Context),
    (key, quality): (Key, f64),
) -> Begun<'a> {
    let camera = Camera::new(sensor, stage);
    let until = if sensor.until.is_empty() {
        let samples = camera.samples(sensor.samples) * quality;
        // Areas are rounded: what is a whole number but for that is one.
        let samples = (samples * (1.0 - 1e-12)).ceil().clamp(2.0, MOST_SAMPLES);
        vec![Stop::Samples(samples as u64)]
    } else {
        at_quality(&sensor.until, quality)
    };
    let orders = sensor.measure.contains(&ImageMeasure::Orders);
    let film = |source, orders, key| {
        let light = LightSettings { system: sensor.system, source, separates_orders: orders };
        ImageFilm::new(stage, &camera, light, key)
    };
    let reflected = needs_reflection(&sensor.measure, context)
        .then(|| film(LightSource::Reflected, orders, key));
    let emitted = needs_emission(&sensor.measure, context)
        .then(|| film(LightSource::Emitted, false, key.path("emission")));
    let components = (!sensor.measure.iter().all(|measure| measure.is_light()))
        .then(|| image_components_film(stage, &camera, key.path("components")));
    let pixels = u64::from(sensor.size.x) * u64::from(sensor.size.y);
    let scene = (stage, context);
    let run = |pace| ImageRun { sensor, scene, reflected, emitted, components, pace };
    if sensor.system == System::Forward {
        let each = move |samples: u64| each_of(samples.saturating_mul(pixels));
        let plan = Plan { until, schedule: Schedule::Blocks, each: Box::new(each) };
        return (Box::new(run((RANDOMISATIONS.into(), pixels))), plan);
    }
    let first = if pixels < MANY_PIXELS { u64::from(RANDOMISATIONS) } else { 8 };
    let each = |samples: u64| samples.max(2);
    let plan = Plan { until, schedule: Schedule::Samples(first), each: Box::new(each) };
    (Box::new(run((1, 1))), plan)
}

impl Measurement for ImageRun<'_> {
    fn films(&mut self) -> Vec<Paced<'_>> {
        let pace = self.pace;
        let light = [&mut self.reflected, &mut self.emitted].into_iter().flatten();
        let mut films: Vec<Paced<'_>> = light
            .map(|image| match image {
                ImageFilm::Packets(packets) => Paced::evenly(&mut packets.sums),
                ImageFilm::Paths(tiles) => Paced { film: tiles, pace },
            })
            .collect();
        films.extend(self.components.iter_mut().map(|film| -> Paced<'_> { Paced { film, pace } }));
        films
    }

    fn extents(&self) -> Vec<Extent> {
        let zones = self.components.as_ref().is_some_and(ImageTiles::has_image_sums);
        let found = (self.reflected.is_some(), self.emitted.is_some(), zones);
        products::extents_of_image(self.sensor, found, self.scene.1)
    }

    fn products(&self) -> Vec<Product> {
        let reflected = self.reflected.as_ref().map(ImageFilm::outcome);
        let emitted = self.emitted.as_ref().map(ImageFilm::outcome);
        let mut products =
            products::of_image(self.sensor, reflected.as_ref(), emitted.as_ref(), self.scene);
        if let Some(components) = &self.components {
            let outcome = components.outcome();
            for &measure in &self.sensor.measure {
                let of = products::components_of_image(measure, self.sensor, &outcome, self.scene);
                products.extend(of);
            }
        }
        products
    }
}

struct DirectionsRun<'a> {
    sensor: &'a Directions,
    context: &'a Context,
    reflected: Option<DirectionsFilm<'a>>,
    emitted: Option<DirectionsFilm<'a>>,
    components: Option<ComponentsFilm<'a>>,
}

fn directions<'a>(
    sensor: &'a Directions,
    (stage, context): (&'a Stage, &'a Context),
    (key, quality): (Key, f64),
) -> Begun<'a> {
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
    let components = (!sensor.measure.iter().all(|measure| measure.is_light()))
        .then(|| ComponentsFilm::new(stage, views, plane, key.path("components")));
    let until = at_quality(&sensor.until, quality);
    let plan = Plan { until, schedule: Schedule::Blocks, each: Box::new(each_of) };
    (Box::new(DirectionsRun { sensor, context, reflected, emitted, components }), plan)
}

impl Measurement for DirectionsRun<'_> {
    fn films(&mut self) -> Vec<Paced<'_>> {
        let light = [&mut self.reflected, &mut self.emitted].into_iter().flatten();
        let films = light.map(|one| &mut one.film);
        films
            .chain(self.components.iter_mut().map(|one| &mut one.film))
            .map(|film| Paced::evenly(film))
            .collect()
    }

    fn extents(&self) -> Vec<Extent> {
        let Directions { views, measure, .. } = self.sensor;
        let found = (self.reflected.is_some(), self.emitted.is_some());
        products::extents_of_directions(views.len(), measure, found, self.context)
    }

    fn products(&self) -> Vec<Product> {
        let Directions { views, measure, .. } = self.sensor;
        let reflected = self.reflected.as_ref().map(DirectionsFilm::outcome);
        let emitted = self.emitted.as_ref().map(DirectionsFilm::outcome);
        let (reflected, emitted) = (reflected.as_ref(), emitted.as_ref());
        let mut products =
            products::of_directions(views, measure, reflected, emitted, self.context);
        if let Some(components) = &self.components {
            let outcome = components.outcome();
            for &one in measure {
                products.extend(products::components_of_directions(one, views, &outcome));
            }
        }
        products
    }
}

/// The system that finds what directions see with the fewest rays, unless the sensor names one.
///
/// Packets serve all views at once: of 31 views they take half of the rays of paths for the same error,
/// of one view as many or more (`transport/README.md`). But most packets miss a small plane, and what
/// surfaces emit is seen at once from the sensor's side.
fn system_of(sensor: &Directions, source: LightSource) -> System {
    let best = match source {
        LightSource::Reflected if sensor.plane.is_none() && sensor.views.len() > 1 => {
            System::Forward
        }
        LightSource::Reflected | LightSource::Emitted => System::Backward,
    };
    sensor.system.unwrap_or(best)
}

/// Whether a measure takes what is reflected of sun and sky.
fn needs_reflection(measures: &[ImageMeasure], context: &Context) -> bool {
    measures.iter().any(|measure| match measure {
        ImageMeasure::Brf | ImageMeasure::Orders => true,
        ImageMeasure::Radiance => context.sources.iter().any(|source| source.reflects),
        ImageMeasure::BrightnessTemperature => {
            context.sources.iter().any(|source| source.emits && source.reflects)
        }
        ImageMeasure::FourComponents | ImageMeasure::GapFraction => false,
    })
}

/// Whether a measure takes what surfaces and the sky emit.
fn needs_emission(measures: &[ImageMeasure], context: &Context) -> bool {
    let takes = |measure: &ImageMeasure| {
        matches!(measure, ImageMeasure::Radiance | ImageMeasure::BrightnessTemperature)
    };
    measures.iter().any(takes) && context.sources.iter().any(|source| source.emits)
}

fn photons<'a>(
    sensor: &'a Photons,
    (stage, context): (&'a Stage, &'a Context),
    (key, quality): (Key, f64),
) -> Begun<'a> {
    let until = if sensor.until.is_empty() {
        vec![Stop::Samples((sensor.per_area * stage.area() * quality).ceil() as u64)]
    } else {
        at_quality(&sensor.until, quality)
    };
    let run = PhotonRun::new(sensor, (stage, context), key);
    (Box::new(run), Plan { until, schedule: Schedule::Blocks, each: Box::new(each_of) })
}
