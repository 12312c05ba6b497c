//! Measurement of an image.

use std::io;

use super::convergence::{Convergence, Measurement, PacedFilm, add_replicate};
use super::sensors::{
    Begun, MOST_SAMPLES, MeasureContext, at_quality, each_of, needs_emission, needs_reflection,
};
use crate::components::{ImageMeasure, ImageSensor, StopCriterion, System};
use crate::products::{self, Context, MeasuredLight, Product, ProductSize};
use crate::sampling::Key;
use crate::transport::{
    Camera, ImageFilm, ImageTiles, LightSettings, LightSource, RANDOMISATIONS, Schedule,
    image_first_surface_film,
};

/// Number of pixels from which on eight samples per pixel are enough for a first check of errors.
const MANY_PIXELS: u64 = 256;

struct ImageRun<'a> {
    sensor: &'a ImageSensor,
    measured: MeasureContext<'a>,
    reflected: Option<ImageFilm<'a>>,
    emitted: Option<ImageFilm<'a>>,
    components: Option<ImageTiles<'a>>,
    /// Samples of a pixel for each sample of the measurement.
    pace: (u64, u64),
}

/// Begins the measurement of an image.
pub(super) fn image<'a>(
    sensor: &'a ImageSensor,
    measured: MeasureContext<'a>,
    key: Key,
    quality: f64,
) -> Begun<'a> {
    let MeasureContext { stage, context, scratch } = measured;
    let camera = Camera::new(sensor, stage);
    let until = if sensor.until.is_empty() {
        let samples = camera.samples(sensor.samples) * quality;
        // Areas are rounded: what is a whole number but for that is one.
        let samples = (samples * (1.0 - 1e-12)).ceil().clamp(2.0, MOST_SAMPLES);
        vec![StopCriterion::Samples(samples as u64)]
    } else {
        at_quality(&sensor.until, quality)
    };
    let orders = sensor.measure.contains(&ImageMeasure::Orders);
    let film = |source, orders, key| {
        let light = LightSettings { system: sensor.system, source, separates_orders: orders };
        ImageFilm::new(stage, &camera, light, key)
    };
    let needs = [
        needs_reflection(&sensor.measure, context),
        needs_emission(&sensor.measure, context),
        !sensor.measure.iter().all(ImageMeasure::is_light),
    ];
    let scratch = scratch.share(needs.into_iter().filter(|needs| *needs).count());
    let [reflects, emits, has_components] = needs;
    let reflected = reflects.then(|| film(LightSource::Reflected, orders, key).kept_in(&scratch));
    let emitted =
        emits.then(|| film(LightSource::Emitted, false, key.path("emission")).kept_in(&scratch));
    let components = has_components.then(|| {
        let mut film = image_first_surface_film(stage, &camera, key.path("components"));
        film.keep_in(scratch.clone());
        film
    });
    let pixels = u64::from(sensor.size.x) * u64::from(sensor.size.y);
    let run = |pace| ImageRun { sensor, measured, reflected, emitted, components, pace };
    if sensor.system == System::Forward {
        let each = move |samples: u64| each_of(samples.saturating_mul(pixels));
        let convergence = Convergence { until, schedule: Schedule::Blocks, each: Box::new(each) };
        let measurement = Box::new(run((RANDOMISATIONS.into(), pixels)));
        return Begun { measurement, convergence };
    }
    let first = if pixels < MANY_PIXELS { u64::from(RANDOMISATIONS) } else { 8 };
    let each = |samples: u64| samples.max(2);
    let schedule = Schedule::Samples(first);
    let convergence = Convergence { until, schedule, each: Box::new(each) };
    Begun { measurement: Box::new(run((1, 1))), convergence }
}

impl Measurement for ImageRun<'_> {
    fn films(&mut self) -> Vec<PacedFilm<'_>> {
        let pace = self.pace;
        let light = [&mut self.reflected, &mut self.emitted].into_iter().flatten();
        let mut films: Vec<PacedFilm<'_>> = light
            .map(|image| match image {
                ImageFilm::Packets(packets) => PacedFilm::evenly(&mut packets.sums),
                ImageFilm::Paths(tiles) => PacedFilm { film: &mut **tiles, pace },
            })
            .collect();
        films.extend(
            self.components.iter_mut().map(|film| -> PacedFilm<'_> { PacedFilm { film, pace } }),
        );
        films
    }

    fn product_sizes(&self) -> Vec<ProductSize> {
        let has_zones = self.components.as_ref().is_some_and(ImageTiles::has_image_sums);
        let light =
            MeasuredLight { reflected: self.reflected.is_some(), emitted: self.emitted.is_some() };
        let MeasureContext { stage, context, .. } = self.measured;
        products::image_sizes(self.sensor, light, has_zones, stage, context)
    }

    fn context(&self) -> &Context {
        self.measured.context
    }

    fn keeps_films(&self) -> bool {
        self.sensor.system != System::Forward
    }

    fn products(&self) -> io::Result<Vec<Product>> {
        let reflected = self.reflected.as_ref().map(ImageFilm::outcome).transpose()?;
        let emitted = self.emitted.as_ref().map(ImageFilm::outcome).transpose()?;
        let MeasureContext { stage, context, .. } = self.measured;
        let (sensor, emitted) = (self.sensor, emitted.as_ref());
        let mut products =
            products::image_products(sensor, reflected.as_ref(), emitted, stage, context);
        if let Some(components) = &self.components {
            let outcome = components.outcome()?;
            for &measure in &sensor.measure {
                products
                    .extend(products::image_components(measure, sensor, &outcome, stage, context));
            }
        }
        if context.scenes > 1 {
            // Each scene takes its bands out of all: they are computed once.
            for image in products.iter_mut().filter_map(|product| product.image.as_mut()) {
                image.pixels = image.load()?.into();
            }
        }
        Ok(products)
    }

    fn add_replicates(&self, products: &mut [Product]) -> io::Result<()> {
        let MeasureContext { stage, context, .. } = self.measured;
        let reflected = self.reflected.as_ref().map(ImageFilm::replicates).transpose()?;
        let emitted = self.emitted.as_ref().map(ImageFilm::replicates).transpose()?;
        let count = reflected.as_ref().or(emitted.as_ref()).map_or(0, Vec::len);
        for index in 0..count {
            let [reflected, emitted] =
                [&reflected, &emitted].map(|all| all.as_ref().map(|outcomes| &outcomes[index]));
            let one = products::image_products(self.sensor, reflected, emitted, stage, context);
            add_replicate(products, &one);
        }
        Ok(())
    }
}
