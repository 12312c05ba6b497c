use std::sync::Arc;
use std::time::Instant;

use hecs::World;

use crate::components::{
    Directions, ImageMeasure, ImageSensor, Name, PhotonMeasure, Photons, SceneId, Sensor, Stop,
    System,
};
use crate::extract::{Inventory, Stage};
use crate::film::Spread;
use crate::products::{self, BandSources, Context, Product, SensorReport};
use crate::sampling::Key;
use crate::transport::{
    AbsorbedCounter, AlbedoCounter, Camera, CellCounter, ConeCounter, Counter, FluxCounter,
    FluxLevel, Hemisphere, LayerCounter, Part, PartCounter, PhotonOutcome, Projection,
    ReferencePlane, Source, ViewCounter, Watch, measure_directions, measure_directions_components,
    measure_image, measure_image_components, measure_image_forward, trace_photons,
};

/// All sensors in document order.
pub(super) fn in_order(world: &World) -> Vec<(String, Sensor)> {
    let mut query = world.query::<(&SceneId, &Name, &Sensor)>();
    let mut sensors: Vec<_> = query.iter().collect();
    sensors.sort_unstable_by_key(|&(id, ..)| *id);
    sensors.into_iter().map(|(_, name, sensor)| (name.0.clone(), sensor.clone())).collect()
}

/// What a measurement gives.
#[derive(Default)]
struct Measured {
    products: Vec<Product>,
    rays: u64,
    samples: u64,
    ended_by: String,
    imbalance: Option<f64>,
}

impl Measured {
    fn count(&mut self, rays: u64, samples: u64) {
        self.rays += rays;
        self.samples += samples;
    }

    fn balance(&mut self, imbalance: Option<f64>) {
        let most = |off: f64| off.max(self.imbalance.unwrap_or(0.0));
        self.imbalance = imbalance.map(most).or(self.imbalance);
    }
}

/// Measures one sensor.
pub(super) fn measure(
    name: &str,
    sensor: &Sensor,
    stage: &Stage,
    context: &Context,
    quality: f64,
    watch: Watch<'_>,
) -> SensorReport {
    let start = Instant::now();
    let key = Key::new(stage.rules.seed).path("sensors").path(name);
    let measured = match sensor {
        Sensor::Image(sensor) => image(sensor, stage, context, (key, quality), watch),
        Sensor::Directions(sensor) => directions(sensor, stage, context, (key, quality), watch),
        Sensor::Photons(sensor) => photons(sensor, stage, context, (key, quality), watch),
    };
    SensorReport {
        name: name.to_owned(),
        products: measured.products,
        seconds: start.elapsed().as_secs_f64(),
        rays: measured.rays,
        samples: measured.samples,
        ended_by: measured.ended_by,
        energy_imbalance: measured.imbalance,
    }
}

/// Samples that a pixel may have.
const MOST_SAMPLES: f64 = 16_777_216.0;

fn image(
    sensor: &ImageSensor,
    stage: &Stage,
    context: &Context,
    (key, quality): (Key, f64),
    watch: Watch<'_>,
) -> Measured {
    let camera = Camera::of(sensor, stage);
    let samples = camera.samples(sensor.samples) * quality;
    // Areas are rounded: what is a whole number but for that is one.
    let samples = (samples * (1.0 - 1e-12)).ceil().clamp(2.0, MOST_SAMPLES) as u32;
    let mut measured = Measured::default();
    let orders = sensor.measure.contains(&ImageMeasure::Orders);
    let measure = |source, orders, key| match (sensor.system, &camera) {
        (System::Forward, Camera::Orthographic(projection)) => {
            measure_image_forward(stage, projection, (samples, source, orders), key, watch)
        }
        _ => measure_image(stage, &camera, (samples, source, orders), key, watch),
    };
    let reflected =
        needs_reflection(&sensor.measure, context).then(|| measure(Source::Reflected, orders, key));
    let emitted = needs_emission(&sensor.measure, context)
        .then(|| measure(Source::Emitted, false, key.path("emission")));
    for outcome in reflected.iter().chain(&emitted) {
        measured.balance(outcome.imbalance);
        measured.count(outcome.rays, outcome.samples);
    }
    let setting = (stage, context);
    measured.products = products::of_image(sensor, reflected.as_ref(), emitted.as_ref(), setting);
    if !sensor.measure.iter().all(|measure| measure.is_light()) {
        let key = key.path("components");
        let outcome = measure_image_components(stage, &camera, samples, key, watch);
        for &measure in &sensor.measure {
            let products =
                products::components_of_image(measure, sensor, &outcome, (stage, context));
            measured.products.extend(products);
        }
        measured.count(outcome.rays, outcome.samples);
    }
    measured.ended_by = format!("{} samples", measured.samples);
    measured
}

fn directions(
    sensor: &Directions,
    stage: &Stage,
    context: &Context,
    (key, quality): (Key, f64),
    watch: Watch<'_>,
) -> Measured {
    let until: Vec<Stop> = sensor
        .until
        .iter()
        .map(|stop| match *stop {
            Stop::RelError(limit) => Stop::RelError(limit / quality.sqrt()),
            Stop::Seconds(limit) => Stop::Seconds(limit * quality),
            Stop::Samples(limit) => Stop::Samples((limit as f64 * quality).ceil() as u64),
        })
        .collect();
    let views = sensor.views.as_slice();
    let plane = &ReferencePlane::of(sensor.plane.as_ref(), stage);
    let mut measured = Measured::default();
    let orders = sensor.measure.contains(&ImageMeasure::Orders);
    let measure = |source, orders, key| {
        let start = Instant::now();
        let elapsed = || start.elapsed().as_secs_f64();
        let system = (sensor.system, source, orders);
        measure_directions(stage, (views, plane), system, &until, key, &elapsed, watch)
    };
    let reflected =
        needs_reflection(&sensor.measure, context).then(|| measure(Source::Reflected, orders, key));
    let emitted = needs_emission(&sensor.measure, context)
        .then(|| measure(Source::Emitted, false, key.path("emission")));
    for outcome in reflected.iter().chain(&emitted) {
        measured.balance(outcome.imbalance);
        let error = outcome.spread.median_relative_error();
        if measured.ended_by.is_empty() {
            measured.ended_by = match outcome.ended_by {
                Stop::RelError(limit) => {
                    format!("median relative standard error {error:.2e} at most {limit:.2e}")
                }
                other => ending(other, outcome.samples),
            };
        }
        measured.count(outcome.rays, outcome.samples);
    }
    let (relative, absolute) = (reflected.as_ref(), emitted.as_ref());
    measured.products =
        products::of_directions(views, &sensor.measure, relative, absolute, context);
    if !sensor.measure.iter().all(|measure| measure.is_light()) {
        let key = key.path("components");
        let start = Instant::now();
        let elapsed = || start.elapsed().as_secs_f64();
        let views_of = (views, plane);
        let outcome = measure_directions_components(stage, views_of, &until, key, &elapsed, watch);
        for &measure in &sensor.measure {
            let products = products::components_of_directions(measure, views, &outcome);
            measured.products.extend(products);
        }
        measured.count(outcome.rays, outcome.samples);
        if measured.ended_by.is_empty() {
            measured.ended_by = ending(outcome.ended_by, outcome.samples);
        }
    }
    measured
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

/// What ended a measurement, for a person.
fn ending(stop: Stop, samples: u64) -> String {
    match stop {
        Stop::RelError(limit) => format!("median relative standard error at most {limit:.2e}"),
        Stop::Seconds(limit) => format!("{limit} s"),
        Stop::Samples(_) => format!("{samples} samples"),
    }
}

fn photons(
    sensor: &Photons,
    stage: &Stage,
    context: &Context,
    (key, quality): (Key, f64),
    watch: Watch<'_>,
) -> Measured {
    let plane = ReferencePlane::of(sensor.plane.as_ref(), stage);
    let kinds: Vec<(&PhotonMeasure, Kind)> = sensor
        .measure
        .iter()
        .filter_map(|measure| Some((measure, Kind::of(measure, &plane, stage)?)))
        .collect();
    let parts: &[Part] =
        if sensor.measure.contains(&PhotonMeasure::Orders) { &Part::ALL } else { &[] };
    let packets = (sensor.per_area * stage.area() * quality).ceil() as u64;
    let trace = |source, asked: Vec<(usize, Option<Part>)>, key| {
        (!asked.is_empty()).then(|| {
            let counters = asked.iter().map(|&(index, part)| -> Box<dyn Counter + '_> {
                let counter = kinds[index].1.counter();
                match part {
                    None => counter,
                    Some(part) => Box::new(PartCounter { counter, part }),
                }
            });
            let counters: Vec<_> = counters.collect();
            let plane = (source, plane.clone());
            let outcome = trace_photons(stage, plane, &counters, packets, key, watch);
            Counted { asked, outcome }
        })
    };
    let holds = |of: fn(&BandSources) -> bool| context.sources.iter().any(of);
    let (reflects, emits) = (holds(|source| source.reflects), holds(|source| source.emits));
    let numbered = || kinds.iter().enumerate();
    let wholes = numbered().filter(|(_, (measure, _))| reflects || !measure.is_absolute());
    let split =
        numbered().filter(|(_, (measure, kind))| !measure.is_absolute() && kind.is_of_reflection());
    let asked = wholes
        .map(|(index, _)| (index, None))
        .chain(split.flat_map(|(index, _)| parts.iter().map(move |&part| (index, Some(part)))));
    let reflected = trace(Source::Reflected, asked.collect(), key);
    let asked = numbered().filter(|(_, (measure, _))| emits && measure.is_absolute());
    let asked = asked.map(|(index, _)| (index, None)).collect();
    let emitted = trace(Source::Emitted, asked, key.path("emission"));

    let mut measured = Measured::default();
    let unit = context.of_unit_irradiance();
    for (index, (measure, kind)) in numbered() {
        let of = |counted: &Option<Counted>, part, context: &Context| -> Vec<Product> {
            let spread = counted.as_ref().and_then(|counted| counted.spread(index, part));
            spread.map_or_else(Vec::new, |spread| kind.products(spread, stage, context))
        };
        if !measure.is_absolute() {
            measured.products.extend(of(&reflected, None, context));
            for &part in parts {
                let products = of(&reflected, Some(part), context).into_iter();
                measured.products.extend(products.map(|product| Product {
                    name: format!("{}_{}", product.name, part.suffix()),
                    ..product
                }));
            }
            continue;
        }
        let (mut reflected, mut emitted) =
            (of(&reflected, None, &unit).into_iter(), of(&emitted, None, &unit).into_iter());
        for _ in 0..reflected.len().max(emitted.len()) {
            let product =
                products::of_sources(reflected.next().as_ref(), emitted.next().as_ref(), context);
            let kelvin = sensor.measure.contains(&PhotonMeasure::BrightnessTemperature);
            let kelvin = kelvin.then(|| products::brightness_of(&product, context)).flatten();
            measured.products.extend(std::iter::once(product).chain(kelvin));
        }
    }
    for (counted, context, name) in
        [(&reflected, context, "energy"), (&emitted, &unit, "emitted_energy")]
    {
        let Some(Counted { outcome, .. }) = counted else { continue };
        let energy = products::energy(&outcome.energy, stage, context);
        let unit = if name == "energy" { energy.unit.clone() } else { "W m-2 nm-1".to_owned() };
        measured.products.push(Product { name: name.to_owned(), unit, ..energy });
        measured.count(outcome.rays, outcome.packets);
        measured.balance(Some(outcome.imbalance));
    }
    measured.ended_by = format!("{} packets", measured.samples);
    measured
}

/// What was asked for, kinds by number, and counted.
struct Counted {
    asked: Vec<(usize, Option<Part>)>,
    outcome: PhotonOutcome,
}

impl Counted {
    fn spread(&self, index: usize, part: Option<Part>) -> Option<&Spread> {
        let at = self.asked.iter().position(|asked| *asked == (index, part))?;
        self.outcome.spreads.get(at)
    }
}

/// A counter with what its product needs.
enum Kind {
    Albedo(AlbedoCounter),
    Cells(CellCounter),
    Cones(ConeCounter),
    Views(ViewCounter, Vec<crate::components::View>),
    Layers(LayerCounter),
    Absorbed(AbsorbedCounter, Arc<Inventory>),
    Fluxes(FluxCounter),
}

impl Kind {
    fn of(measure: &PhotonMeasure, plane: &ReferencePlane, stage: &Stage) -> Option<Self> {
        let plane = plane.clone();
        Some(match measure {
            PhotonMeasure::Orders | PhotonMeasure::BrightnessTemperature => return None,
            PhotonMeasure::BrfCones(cones) | PhotonMeasure::RadianceCones(cones) => {
                Self::Cones(ConeCounter::new(cones.clone(), plane))
            }
            PhotonMeasure::Albedo | PhotonMeasure::Exitance => {
                Self::Albedo(AlbedoCounter { plane })
            }
            PhotonMeasure::BrfCells(cells) | PhotonMeasure::RadianceCells(cells) => {
                Self::Cells(CellCounter { hemisphere: Hemisphere::new(*cells as usize), plane })
            }
            PhotonMeasure::BrfViews(views) | PhotonMeasure::RadianceViews(views) => {
                let projections =
                    views.iter().map(|&view| Projection::of_plane(view, &plane, stage)).collect();
                Self::Views(ViewCounter::new(projections), views.clone())
            }
            PhotonMeasure::Absorbed(per) => {
                let inventory = stage.inventory.clone()?;
                Self::Absorbed(AbsorbedCounter::of(&inventory, *per, plane), inventory)
            }
            PhotonMeasure::Fapar(layers) => Self::Layers(LayerCounter::of(stage, layers, plane)),
            PhotonMeasure::Fluxes { pixel, heights } => {
                let mut levels = vec![FluxLevel::Terrain, FluxLevel::Top];
                levels.extend(heights.iter().map(|&height| FluxLevel::Height(height)));
                Self::Fluxes(FluxCounter::new(plane, *pixel, levels))
            }
        })
    }

    /// Whether it counts light that leaves the scene, and nothing else.
    const fn is_of_reflection(&self) -> bool {
        match self {
            Self::Albedo(_) | Self::Cells(_) | Self::Cones(_) | Self::Views(..) => true,
            Self::Layers(_) | Self::Absorbed(..) | Self::Fluxes(_) => false,
        }
    }

    /// What its spread tells.
    fn products(&self, spread: &Spread, stage: &Stage, context: &Context) -> Vec<Product> {
        match self {
            Self::Albedo(albedo) => vec![products::albedo(spread, albedo, context)],
            Self::Cells(cells) => {
                vec![products::brf_cells(spread, (&cells.hemisphere, cells.plane.gain), context)]
            }
            Self::Cones(cones) => vec![products::brf_cones(spread, cones, context)],
            Self::Views(counter, views) => {
                vec![products::brf_views(spread, counter, views, stage, context)]
            }
            Self::Layers(layers) => products::fapar(spread, layers, stage, context),
            Self::Absorbed(counter, inventory) => {
                products::absorbed(spread, counter, (inventory, stage), context)
            }
            Self::Fluxes(fluxes) => products::fluxes(spread, fluxes, context),
        }
    }

    fn counter(&self) -> Box<dyn Counter + '_> {
        match self {
            Self::Albedo(counter) => Box::new(counter.clone()),
            Self::Cells(counter) => Box::new(counter.clone()),
            Self::Views(counter, _) => Box::new(counter.clone()),
            Self::Layers(counter) => Box::new(counter.clone()),
            Self::Cones(counter) => Box::new(counter.clone()),
            Self::Absorbed(counter, _) => Box::new(counter.clone()),
            Self::Fluxes(counter) => Box::new(counter.clone()),
        }
    }
}
